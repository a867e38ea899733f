//! Scenes of the free form: their tables as they are written, and one line for everything that is refused of them.

mod common;

use std::path::Path;

use glam::Vec3;
use nabiki::Profile;
use nabiki::dynamics::{Form, earth_gravity};
use nabiki::locks::Locks;
use nabiki_scene::scene::{Amount, FormChoice};
use nabiki_scene::{Scene, Shown};

use common::{changed_lines, lines, reread};

const FREE: &str = "\
[hair]
strands = 20
[motion]
form = \"free\"
frames = 3
[free]
stiffness = [120, 60]
gravity = 50
[contact]
margin = 0.1
[[body]]
mesh = \"solid.obj\"
[neighbours]
carriers = 8
[[force]]
through = 3
vector = [-40, 0, 0]
";

const WRITTEN: &str = "\
[motion]
form = \"free\"   # what new scenes use
frames = 30

[free]           # how it holds
stiffness = [120, 60.5, 10]
gravity = \"earth\"

[contact]
margin = 0.2     # cm

# A hand.
[[body]]
mesh = \"hand.obj\"
motion = { file = \"hand.csv\", up = \"+y\", facing = \"+x\" }
[[body]]         # a hat
mesh = \"hat.glb\"
with_head = true

[neighbours]
carriers = 64    # few

[[force]]
through = 30
vector = [-100, 0, 0]
";

#[test]
fn the_tables_of_the_free_form_are_changed_line_by_line() {
    let scene = Scene::parse(WRITTEN, Path::new("free.toml"), &[]).unwrap();
    assert_eq!(scene.to_toml().unwrap(), WRITTEN, "nobody changed it");
    let change = |edit: &dyn Fn(&mut Scene)| {
        let mut scene = scene.clone();
        edit(&mut scene);
        assert_eq!(reread(&scene), scene);
        changed_lines(WRITTEN, &scene.to_toml().unwrap())
    };
    let one =
        |edit: &dyn Fn(&mut Scene), old: &str, new: &str| assert_eq!(change(edit), (lines(&[old]), lines(&[new])));
    one(
        &|scene| scene.free.stiffness = Profile::RootToTip([120.0, 80.0, 10.0].map(Amount::Number).to_vec()),
        "stiffness = [120, 60.5, 10]",
        "stiffness = [120, 80.0, 10]",
    );
    one(
        &|scene| scene.free.stiffness = Profile::Even(Amount::Number(90.0)),
        "stiffness = [120, 60.5, 10]",
        "stiffness = 90.0",
    );
    one(&|scene| scene.free.gravity = Amount::Number(12.5), "gravity = \"earth\"", "gravity = 12.5");
    one(&|scene| scene.contact.margin = 0.3, "margin = 0.2     # cm", "margin = 0.3     # cm");
    one(
        &|scene| scene.form = FormChoice::Paper,
        "form = \"free\"   # what new scenes use",
        "form = \"paper\"   # what new scenes use",
    );
    one(&|scene| scene.bodies[1].mesh = "cap.glb".into(), "mesh = \"hat.glb\"", "mesh = \"cap.glb\"");
    let (old, new) = change(&|scene| scene.neighbours = None);
    assert_eq!(
        old.iter().filter(|line| !line.is_empty()).collect::<Vec<_>>(),
        ["[neighbours]", "carriers = 64    # few"]
    );
    assert!(new.is_empty(), "{new:?}");
    let (old, new) = change(&|scene| drop(scene.bodies.remove(0)));
    assert!(
        old.contains(&"mesh = \"hand.obj\"".to_owned()) && !old.contains(&"mesh = \"hat.glb\"".to_owned()),
        "{old:?}"
    );
    assert!(new.is_empty(), "{new:?}");
}

/// The line for a scene with one line changed, which names the scene and the changed line.
fn refused(from: &str, to: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    let files = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../nabiki_io/tests/files"));
    std::fs::copy(files.join("solid.obj"), folder.path().join("solid.obj")).unwrap();
    std::fs::write(folder.path().join("sheet.obj"), "v 0 0 0\nv 9 0 0\nv 9 9 0\nv 0 9 0\nf 1 2 3\nf 1 3 4\n").unwrap();
    let columns = "t_s,px_m,py_m,pz_m,qx,qy,qz,qw";
    let short = format!("{columns}\n0,0,1.6,0,0,0,0,1\n0.09,0.5,1.6,0,0,0,0,1\n");
    std::fs::write(folder.path().join("short.csv"), short).unwrap();
    // Less than a frame at 24 a second.
    let brief = format!("{columns}\n0,0,1.6,0,0,0,0,1\n0.0166,0.5,1.6,0,0,0,0,1\n");
    std::fs::write(folder.path().join("brief.csv"), brief).unwrap();
    assert_eq!(FREE.matches(from).count(), 1, "the sample has one {from:?}");
    let path = folder.path().join("free.toml");
    let built = Scene::parse(&FREE.replacen(from, to, 1), &path, &[]).map_err(nabiki_scene::Error::from);
    let refused = built.and_then(|scene| scene.build(Shown::All)).map(drop).unwrap_err();
    let said = refused.to_string();
    assert_eq!(said.lines().count(), 1, "{said}");
    said.replace(&format!("{}/", folder.path().display()), "")
}

#[test]
fn the_sample_itself_is_built() {
    let from = "strands = 20";
    assert_eq!(refused(from, "strands = 0"), "free.toml:2: hair.strands = 0: must lie in 1..800000000");
}

#[test]
fn keys_that_are_none_are_refused_with_the_nearest() {
    assert_eq!(refused("gravity", "gravty"), "free.toml:8: free.gravty: unknown key; did you mean free.gravity?");
    assert_eq!(refused("margin", "margn"), "free.toml:10: contact.margn: unknown key; did you mean contact.margin?");
    assert_eq!(refused("mesh = ", "msh = "), "free.toml:12: body[0].msh: unknown key; did you mean body[0].mesh?");
    assert_eq!(
        refused("carriers", "cariers"),
        "free.toml:14: neighbours.cariers: unknown key; did you mean neighbours.carriers?"
    );
    assert_eq!(
        refused("form = \"free\"", "form = \"fre\""),
        "free.toml:4: motion.form: found \"fre\", must be one of \"paper\", \"free\"; did you mean \"free\"?"
    );
}

#[test]
fn strengths_that_are_none_are_refused_where_they_stand() {
    let (finite, range) = ("must be a finite number of at least 0", "must lie in 0..1000000000");
    for (value, place) in
        [("-1", "free.stiffness = -1"), ("nan", "free.stiffness = NaN"), ("inf", "free.stiffness = inf")]
    {
        assert_eq!(
            refused("stiffness = [120, 60]", &format!("stiffness = {value}")),
            format!("free.toml:7: {place}: {range}")
        );
    }
    assert_eq!(refused("[120, 60]", "[120, -60]"), format!("free.toml:7: free.stiffness[1] = -60: {range}"));
    assert_eq!(refused("[120, 60]", "[nan, 60]"), format!("free.toml:7: free.stiffness[0] = NaN: {range}"));
    assert_eq!(
        refused("[120, 60]", "[]"),
        "free.toml:7: free.stiffness = a list of 0: give one number, or 2 to 64 from root to tip"
    );
    assert_eq!(
        refused("[120, 60]", &format!("{:?}", [1.0; 65])),
        "free.toml:7: free.stiffness = a list of 65: give one number, or 2 to 64 from root to tip"
    );
    assert_eq!(refused("gravity = 50", "gravity = -50"), format!("free.toml:8: free.gravity = -50: {range}"));
    assert_eq!(refused("gravity = 50", "gravity = nan"), format!("free.toml:8: free.gravity = NaN: {range}"));
    assert_eq!(
        refused("gravity = 50", "hold = \"hairspray\""),
        "free.toml:8: free.hold: found \"hairspray\", must be a number, or a part of the earth's gravity, \"0.3 g\""
    );
    assert_eq!(
        refused("gravity = 50", "gravity = \"moon\""),
        "free.toml:8: free.gravity: found \"moon\", must be a number, or a part of the earth's, \"1 g\", or \"earth\""
    );
    assert_eq!(refused("margin = 0.1", "margin = -1"), "free.toml:10: contact.margin = -1: must lie in 0..5");
    assert_eq!(refused("margin = 0.1", "friction = nan"), "free.toml:10: contact.friction = NaN: must lie in 0..10");
    assert_eq!(refused("carriers = 8", "pressure = -1"), format!("free.toml:14: neighbours.pressure = -1: {finite}"));
    assert_eq!(refused("carriers = 8", "carriers = 0"), "free.toml:14: neighbours.carriers = 0: must lie in 1..4096");
}

#[test]
fn bodies_that_are_none_are_refused() {
    assert_eq!(
        refused("mesh = \"solid.obj\"", "margin = 0.2"),
        "free.toml:11: body[0].mesh is missing: give the file of its mesh, or a capsule"
    );
    assert_eq!(
        refused("mesh = \"solid.obj\"", "mesh = \"solid.obj\"\nwith_head = true\nmotion = { file = \"short.csv\" }"),
        "free.toml:13: body[0].with_head = true: a body that moves with the head cannot have its own motion: remove one of the two"
    );
    assert_eq!(
        refused(
            "mesh = \"solid.obj\"",
            "mesh = \"solid.obj\"\nmotion = { file = \"short.csv\", up = \"+y\", facing = \"+x\" }"
        ),
        "free.toml:13: body[0].motion = 3 frames: ends before frame 3, the last (frames count from 0): lower motion.frames, or give a longer motion"
    );
    assert_eq!(
        refused(
            "mesh = \"solid.obj\"",
            "mesh = \"solid.obj\"\nmotion = { file = \"brief.csv\", up = \"+y\", facing = \"+x\" }"
        ),
        "free.toml:13: body[0].motion = 1 frame: ends before frame 3, the last (frames count from 0): lower motion.frames, or give a longer motion",
        "a motion of one pose is not a body that stands still"
    );
    let capsule = "capsule = { from = [0, 0, 0], radius = 1 }";
    assert_eq!(
        refused("mesh = \"solid.obj\"", &format!("mesh = \"solid.obj\"\n{capsule}")),
        "free.toml:12: body[0].mesh = solid.obj: a body is a mesh or a capsule: remove one of the two"
    );
    assert_eq!(
        refused("mesh = \"solid.obj\"", &format!("{capsule}\nunit = \"m\"")),
        "free.toml:13: body[0].unit is for a mesh, and this body is a capsule: remove it"
    );
    assert_eq!(
        refused("solid.obj", "sheet.obj"),
        "free.toml:12: body[0].mesh = 9 x 9 x 0 cm: a sheet encloses no space: make it thicker"
    );
    assert_eq!(
        refused("solid.obj", "no/hand.obj"),
        "free.toml:12: body[0].mesh = \"no/hand.obj\": there is no no/hand.obj; paths are relative to the scene's folder"
    );
    assert_eq!(
        refused("mesh = \"solid.obj\"", "mesh = \"solid.obj\"\nmotion = { file = \"none.csv\" }"),
        "free.toml:13: body[0].motion.file = \"none.csv\": there is no none.csv; paths are relative to the scene's folder"
    );
    assert_eq!(
        refused("mesh = \"solid.obj\"", "mesh = \"solid.obj\"\nunit = 0"),
        "free.toml:13: body[0].unit = 0: must be a finite number above 0"
    );
    assert_eq!(
        refused("mesh = \"solid.obj\"", "mesh = \"solid.obj\"\ncolour = [0.2, 1.5, 0]"),
        "free.toml:13: body[0].colour = [0.2, 1.5, 0.0]: each of red, green and blue must lie in 0..1"
    );
    assert_eq!(
        refused("mesh = \"solid.obj\"", "mesh = \"solid.obj\"\ncolour = \"grey\""),
        "free.toml:13: body[0].colour: found \"grey\", must be three numbers, [x, y, z]"
    );
    assert_eq!(
        refused(
            "mesh = \"solid.obj\"",
            "mesh = \"sheet.obj\"\nsolid = false\nmotion = { file = \"short.csv\", up = \"+y\", facing = \"+x\" }"
        ),
        "free.toml:14: body[0].motion = 3 frames: ends before frame 3, the last (frames count from 0): lower motion.frames, or give a longer motion",
        "a sheet will do for what is only drawn, a motion too short will not"
    );
    for (value, remedy) in [("smoothing = -1", "0..240"), ("speed = 0", "0.01..100"), ("speed = nan", "0.01..100")] {
        let motion = format!("mesh = \"solid.obj\"\nmotion = {{ file = \"short.csv\", {value} }}");
        let value = value.replace("nan", "NaN");
        assert_eq!(
            refused("mesh = \"solid.obj\"", &motion),
            format!("free.toml:13: body[0].motion.{value}: must lie in {remedy}")
        );
    }
}

/// What is of the free form is said to be without effect in the paper's, and what of the camera changes no picture; what has an effect
/// is not.
#[test]
fn settings_without_effect_are_said() {
    let said = |settings: &[(&str, &str)]| -> Vec<String> {
        let overrides: Vec<_> = settings.iter().map(|&(key, value)| (key.to_owned(), value.to_owned())).collect();
        let built = Scene::parse("[[force]]\nthrough = 3\nvector = [-40, 0, 0]", Path::new("s.toml"), &overrides)
            .unwrap()
            .build(Shown::First(20))
            .unwrap();
        built.advice().iter().map(ToString::to_string).collect()
    };
    let paper = [("free.settle", "9"), ("neighbours.cohesion", "40")];
    assert_eq!(
        said(&paper),
        ["hair does not feel [free], [neighbours] in the paper's form: give motion.form = \"free\""]
    );
    assert_eq!(said(&[paper[0], paper[1], ("motion.form", "\"free\"")]), [""; 0]);
    let unseen = |settings: &[(&str, &str)]| {
        said(settings).iter().map(|s| s.split(' ').next().unwrap().to_owned()).collect::<Vec<_>>()
    };
    let (focus, height) = (("picture.camera.focus_distance", "60"), ("picture.camera.height", "40"));
    assert_eq!(unseen(&[focus, height]), ["picture.camera.focus_distance", "picture.camera.height"]);
    let orthographic = ("picture.camera.projection", "\"orthographic\"");
    assert_eq!(unseen(&[height, orthographic]), [""; 0]);
    assert_eq!(unseen(&[focus, ("picture.camera.f_stop", "4")]), [""; 0]);
    const TAIL: &str = "{ at = [-11.4, 6.0, 0.0] }";
    let (still, three) = (("force.0.vector", "[0, 0, 0]"), ("motion.frames", "3"));
    let each = [
        ("gust.intensity", "0.2", still, "[gust]"),
        ("flow.thickness", "1", still, "[flow]"),
        ("turbulence.drift", "0.5", still, "turbulence.drift"),
        ("turbulence.envelope", "[{ frame = 0, factor = 0 }]", three, "[turbulence]"),
        ("point", "[{ position = [30, 0, 0], envelope = [{ frame = 9, factor = 0 }] }]", three, "point[0]"),
        ("hair.style.variation.cut", "0.5", three, "hair.style.variation.cut"),
        ("hair.style.ponytail", TAIL, ("hair.style.length", "{ top = 2, sides = 2, back = 2 }"), "hair.style.ponytail"),
        ("hair.style.cuts", "[{ point = [0, -21, 0], normal = [0, 1, 0] }]", three, "hair.style.cuts[0]"),
        ("free.regions", "[{ near = [0, 60, 0] }]", ("motion.form", "\"free\""), "free.regions[0]"),
        ("picture.camera.margin", "0.2", ("picture.camera.distance", "80"), "picture.camera.margin"),
        ("picture.camera.distance", "3", three, "picture.camera"),
        ("picture.samples", "8", three, "picture.samples"),
        ("picture.hair.scale_tilt", "2", ("picture.hair.shading", "\"kajiya-kay\""), "picture.hair.scale_tilt"),
        ("picture.hair.variation", "0.5", ("picture.hair.shading", "\"kajiya-kay\""), "picture.hair.variation"),
        ("picture.hair.tip", "0.2", ("picture.hair.taper", "0"), "picture.hair.tip"),
        ("picture.head.sheen", "0.6", ("picture.head.visible", "false"), "picture.head.sheen"),
        ("picture.head.stubble", "1", ("picture.head.visible", "false"), "picture.head.stubble"),
    ];
    for (key, value, beside, line) in each {
        assert_eq!(unseen(&[(key, value), beside]), [line], "{key} beside {beside:?}");
    }
    let has_effect = [
        ("gust.intensity", "0.2"),
        ("flow.thickness", "1"),
        ("turbulence.drift", "0.5"),
        ("picture.camera.margin", "0.2"),
        ("picture.hair.scale_tilt", "2"),
        ("picture.hair.variation", "0.5"),
        ("picture.hair.tip", "0.2"),
        ("picture.head.sheen", "0.6"),
        ("turbulence.envelope", "[{ frame = 3, factor = 0 }, { frame = 9, factor = 1 }]"),
        ("hair.style.variation.cut", "0.5"),
        ("hair.style.cuts", "[{ point = [0, -21, 0], normal = [0, -1, 0] }]"),
        ("hair.style.ponytail", TAIL),
    ];
    assert_eq!(unseen(&has_effect), [""; 0]);

    // A body that is shown is lit as the head is.
    let ball = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/ball.toml");
    let overrides = [("picture.head.sheen", "0.6"), ("picture.head.visible", "false")];
    let overrides = overrides.map(|(key, value)| (key.to_owned(), value.to_owned()));
    assert_eq!(Scene::load(&ball, &overrides).unwrap().build(Shown::First(20)).unwrap().advice(), []);
}

#[test]
fn what_comes_after_the_last_frame_is_said_unless_fewer_frames_are_tried() {
    let said = |through: u32, more: &str, overrides: &[(String, String)]| -> Vec<String> {
        let text = format!(
            "[motion]\nframes = 5\n[[force]]\nthrough = 5\nvector = [-40, 0, 0]\n[[force]]\nthrough = {through}\n\
             vector = [0, -40, 0]\n{more}"
        );
        let built = Scene::parse(&text, Path::new("s.toml"), overrides).unwrap().build(Shown::First(2)).unwrap();
        built.advice().iter().map(ToString::to_string).collect()
    };
    let after = "it is first felt in frame 6, but the last frame is motion.frames = 5";
    assert_eq!(said(9, "", &[]), [format!("force[1] changes nothing: {after}")]);
    let third = "[[force]]\nthrough = 12\nvector = [0, 0, 0]\n";
    assert_eq!(said(9, third, &[]), [format!("force[1] and what comes after it change nothing: {after}")]);
    // On its way from the middle of the first, frame 3, on.
    assert_eq!(said(9, "[wind]\nease = \"smooth\"\n", &[]), [""; 0]);
    // As a solver leaves it behind an interval of its own.
    assert_eq!(said(6, "", &[]), [""; 0]);
    let swirls = "[turbulence]\nenvelope = [{ frame = 5, factor = 0 }, { frame = 9, factor = 1 }]\n";
    assert_eq!(said(6, swirls, &[]), ["[turbulence] changes nothing: its envelope is 0 in all frames"]);
    let fewer = [("motion.frames".to_owned(), "2".to_owned())];
    assert_eq!(said(9, swirls, &fewer), [""; 0]);
}

/// Files have their strands in the order of place: the first of them would lie together.
#[test]
fn carriers_of_imported_hair_are_spread_over_all_of_it() {
    let folder = tempfile::tempdir().unwrap();
    let mut text = String::new();
    for s in 0..200 {
        let z = -8.0 + 0.08 * s as f32;
        for x in 8..12 {
            text += &format!("v {x} 5 {z}\n");
        }
        text += &format!("l {} {} {} {}\n", 4 * s + 1, 4 * s + 2, 4 * s + 3, 4 * s + 4);
    }
    std::fs::write(folder.path().join("sorted.obj"), text).unwrap();
    let scene = "[hair]\nfile = \"sorted.obj\"\nunit = \"cm\"\nup = \"+y\"\nfacing = \"+x\"\n[motion]\nform = \"free\"\nframes = 1\n[neighbours]\n\
                 carriers = 9\n";
    let built = Scene::parse(scene, &folder.path().join("scene.toml"), &[]).unwrap().build(Shown::First(20)).unwrap();
    let nabiki::dynamics::Form::Free(free) = &built.dynamics.form else { panic!("the free form") };
    let carriers = &free.neighbours.as_ref().unwrap().carriers;
    let mut roots: Vec<f32> = carriers.iter().map(|strand| strand[0].z).collect();
    roots.sort_by(f32::total_cmp);
    // The ends, the middle, the quarters and the eighths of the row.
    assert_eq!(roots.len(), 9);
    assert!(roots.windows(2).all(|pair| pair[1] - pair[0] < 2.1), "{roots:?}");
    assert!(roots[8] - roots[0] > 15.8, "{roots:?}");
}

#[test]
fn up_is_that_of_the_head_s_first_pose_and_gravity_that_of_the_earth_on_hair_of_the_mean_length() {
    let folder = tempfile::tempdir().unwrap();
    let row = |t: f64, angle: f32| format!("{t},0,1.6,0,0,0,{},{}\n", (0.5 * angle).sin(), (0.5 * angle).cos());
    // Tilted about z by 0.3 rad, and more later on.
    let rows = "t_s,px_m,py_m,pz_m,qx,qy,qz,qw\n".to_owned() + &row(0.0, 0.3) + &row(0.5, 1.0);
    std::fs::write(folder.path().join("tilt.csv"), rows).unwrap();
    let text = "[hair]\nstrands = 300\n[head.motion]\nfile = \"tilt.csv\"\n\
                up = \"+y\"\nfacing = \"+x\"\n[[force]]\nthrough = 12\nvector = [-10, 0, 0]\n";
    let build = |form: &str| {
        let gravity = if form == "free" { "gravity = \"earth\"\n" } else { "" };
        let text = format!("{text}[motion]\nform = \"{form}\"\nframes = 12\n[free]\n{gravity}");
        Scene::parse(&text, &folder.path().join("tilt.toml"), &[]).unwrap().build(Shown::All).unwrap()
    };
    for form in ["paper", "free"] {
        let up = build(form).dynamics.polar_axis;
        let wanted = Vec3::new(0.3_f32.sin(), 0.3_f32.cos(), 0.0);
        assert!(up.distance(wanted) < 1e-6, "{form}: {up}");
    }
    let built = build("free");
    let Form::Free(free) = &built.dynamics.form else { panic!("the free form") };
    let strands = built.strands();
    let mean = strands.lengths().map(f64::from).sum::<f64>() / strands.len() as f64;
    let wanted = earth_gravity(&built.dynamics, mean);
    // It is told by the first 256 of 300 strands, whose lengths differ by a few parts in a hundred.
    assert!((free.form.gravity / wanted - 1.0).abs() < 0.02, "{}, not {wanted}", free.form.gravity);
    assert_eq!(free.rest_pose, built.pose(0));
}

#[test]
fn clumps_of_the_groom_are_locks_unless_another_width_is_asked_for() {
    let locks = |set: &[(&str, &str)]| {
        let overrides: Vec<_> = set.iter().map(|&(key, value)| (key.to_owned(), value.to_owned())).collect();
        let text = "[motion]\nform = \"free\"\n[hair]\nstrands = 20\nseed = 7\nstyle = { clumps = { size = 2.5 } }\n\
                    [[force]]\nthrough = 3\nvector = [-40, 0, 0]";
        let built = Scene::parse(text, Path::new("s.toml"), &overrides).unwrap().build(Shown::All).unwrap();
        let Form::Free(free) = &built.dynamics.form else { panic!("it is of the free form") };
        free.locks
    };
    assert_eq!(locks(&[("free.variation", "{}")]), Locks { size: 2.5, seed: 7 });
    assert_eq!(locks(&[("free.variation", "{ size = 4.0 }")]), Locks { size: 4.0, seed: 7 });
}
