//! Scene files: what is read, and the exact line for everything that is refused.

use std::path::Path;
use std::sync::Arc;

use glam::Vec3;
use nabiki::Hair;
use nabiki::dynamics::Form;
use nabiki_scene::told::SwingTable;
use nabiki_scene::{
    BuiltScene, Scene, Shown,
    scene::{EllipsoidChoice, GrownHair, HairSource, HeadSource, Problem, SceneError},
};

const GUST: &str = "\
[hair]
strands = 100

[motion]
frames = 100
time_step = 0.1
linear_density = 0.05

[[force]]
through = 50
vector = [-100, 0, 0]
[[force]]
through = 100
vector = [-15, -150, 0]
";

fn parse(text: &str, overrides: &[(&str, &str)]) -> Result<Scene, SceneError> {
    let overrides: Vec<(String, String)> = overrides.iter().map(|&(k, v)| (k.to_owned(), v.to_owned())).collect();
    Scene::parse(text, Path::new("scenes/gust.toml"), &overrides)
}

/// The error line for the gust with one line added to, or changed in, its text.
fn refused(from: &str, to: &str) -> String {
    assert!(GUST.contains(from), "the sample has no {from:?}");
    parse(&GUST.replacen(from, to, 1), &[]).unwrap_err().to_string()
}

fn refused_override(key: &str, value: &str) -> String {
    parse(GUST, &[(key, value)]).unwrap_err().to_string()
}

#[test]
fn what_a_scene_leaves_out_is_the_papers() {
    let scene = parse("[[force]]\nthrough = 50\nvector = [-100, 0, 0]\n", &[]).unwrap();
    assert_eq!((scene.motion.frames, scene.motion.time_step, scene.motion.linear_density), (100, 0.1, 0.05));
    assert_eq!((scene.pseudo_force.alpha, scene.head.shell), (-0.75, 1.25));
    let GrownHair { strands, segments, .. } = scene.hair.grown().unwrap();
    assert_eq!((*segments, scene.hair.segment_length, *strands), (18, 1.0, 19_330));
    assert!(scene.head.source == HeadSource::Builtin && scene.disturbance.is_none());
    assert_eq!(scene.motion.frame_rate, 24.0);
    assert_eq!(scene.output.sheet_frames(100), [0, 30, 60, 90]);
    assert_eq!(scene.name(), "gust");
}

#[test]
fn overrides_are_put_in_before_anything_is_read() {
    let overrides = [
        ("motion.time_step", "0.05"),
        ("force.1.vector", "[0, -100, 0]"),
        ("force.2.through", "120"),
        ("force[2].vector", "[1, 2.5, 3]"),
        ("head.ellipsoid", "{ center = [0, 1, 0], half_axes = [9, 11, 8] }"),
        ("picture.size", "[320, 200]"),
        ("disturbance.every", "7"),
        ("hair.file", "some/hair.tfx"),
    ];
    let scene = parse(GUST, &overrides).unwrap();
    assert_eq!((scene.motion.time_step, scene.picture.size), (0.05, [320, 200]));
    assert_eq!(scene.field.force[1].vector, Vec3::new(0.0, -100.0, 0.0));
    assert_eq!((scene.field.force[2].through, scene.field.force[2].vector), (120, Vec3::new(1.0, 2.5, 3.0)));
    assert!(matches!(scene.head.ellipsoid, EllipsoidChoice::Given(e) if e.half_axes.y == 11.0));
    assert_eq!(scene.disturbance.unwrap().every, 7);
    let HairSource::Imported(hair) = &scene.hair.source else { panic!("hair.file is given") };
    assert_eq!(hair.file, Path::new("some/hair.tfx"), "a bare word is a string");
}

#[test]
fn an_entry_of_a_list_that_the_file_does_not_give_is_that_of_the_default() {
    let default = Scene::default();
    let scene = parse(GUST, &[("picture.lights.1.strength", "9"), ("free.stiffness[0]", "300")]).unwrap();
    let mut lights = default.picture.lights.clone();
    lights[1].strength = 9.0;
    assert_eq!(scene.picture.lights, lights);
    let mut stiffness = default.free.stiffness.values().to_vec();
    stiffness[0] = 300.0.into();
    assert_eq!(scene.free.stiffness.values(), stiffness);
    assert_eq!(parse(GUST, &[("pseudo_force.coefficients.0", "0.01")]).unwrap().pseudo_force, default.pseudo_force);
    let beyond = parse(GUST, &[("picture.lights.9.strength", "1")]).unwrap_err().to_string();
    assert!(beyond.contains("picture.lights is a list of 4: name an entry by a number from 0 to 4"), "{beyond}");
}

#[test]
fn a_value_meant_as_toml_and_none_of_it_is_refused() {
    for value in [".1", "1.", "-.5", "[160,120", "{ a = 1", "\"open"] {
        let line = parse(GUST, &[("motion.time_step", value)]).unwrap_err().to_string();
        assert!(line.contains(&format!("{value} is not a TOML value: write 0.5, not .5")), "{line}");
    }
    assert!(parse(GUST, &[("force[1.through", "4")]).unwrap_err().to_string().contains("write a key as"));
    let scene = parse(GUST, &[("hair.file", "1993.05/hair.tfx")]).unwrap();
    assert!(matches!(&scene.hair.source, HairSource::Imported(hair) if hair.file == Path::new("1993.05/hair.tfx")));
}

#[test]
fn paths_are_relative_to_the_scene_file() {
    let scene = parse(GUST, &[]).unwrap();
    assert_eq!(scene.resolve("hair/a.tfx".as_ref()), Path::new("scenes/hair/a.tfx"));
    assert_eq!(scene.resolve("/data/a.tfx".as_ref()), Path::new("/data/a.tfx"));
}

#[test]
fn an_unknown_key_is_refused_with_the_nearest_known_one() {
    assert_eq!(
        refused("time_step", "time_stpe"),
        "scenes/gust.toml:6: motion.time_stpe: unknown key; did you mean motion.time_step?"
    );
    assert_eq!(refused("[motion]", "[moton]"), "scenes/gust.toml:4: moton: unknown key; did you mean motion?");
    assert_eq!(
        refused("vector", "vectr"),
        "scenes/gust.toml:11: force[0].vectr: unknown key; did you mean force[0].vector?"
    );
    let nothing_near = refused("time_step", "quality");
    let beginning =
        "scenes/gust.toml:6: motion.quality: unknown key; the keys here are form, frames, frame_rate, time_step";
    assert!(nothing_near.starts_with(beginning), "{nothing_near}");
    let deep = refused("strands = 100", "style.comb.swep = [1, 0, 0]");
    assert_eq!(deep, "scenes/gust.toml:2: hair.style.comb.swep: unknown key; did you mean hair.style.comb.sweep?");
}

#[test]
fn fewer_strands_than_the_scene_has_are_the_first_of_them() {
    let build = |shown| parse(GUST, &[]).unwrap().build(shown);
    let whole = build(Shown::All).unwrap();
    let first: Vec<usize> = (0..30).collect();
    for shown in [Shown::First(30), Shown::AtMost(30)] {
        let some = build(shown).unwrap();
        assert_eq!((some.groom.of_scene, some.groom.hair.clone()), (100, whole.groom.hair.select(&first)));
    }
    assert_eq!(build(Shown::AtMost(200)).unwrap().groom.hair, whole.groom.hair);
    assert!(build(Shown::First(200)).unwrap_err().to_string().contains("the scene has 100"));
}

#[test]
fn where_no_hair_can_grow_the_ellipsoid_that_is_given_is_named() {
    let small = [("head.ellipsoid", "{ center = [0, 0, 0], half_axes = [1, 1, 1] }")];
    let refused = parse(GUST, &small).unwrap().build(Shown::First(2)).unwrap_err().to_string();
    assert!(
        refused.contains("hair.hairline leaves almost no scalp for hair: ")
            && refused.contains("or correct head.ellipsoid"),
        "{refused}"
    );
}

#[test]
fn errors_are_values() {
    let error = |from: &str, to: &str| parse(&GUST.replacen(from, to, 1), &[]).unwrap_err();
    let range = error("time_step = 0.1", "time_step = -0.1");
    assert_eq!((range.file.as_path(), range.line), (Path::new("scenes/gust.toml"), Some(6)));
    assert_eq!((range.key.to_string().as_str(), range.value()), ("motion.time_step", Some("-0.1")));
    assert_eq!(range.remedy(), "must be a finite number above 0");
    let kind = error("frames = 100", "frames = \"many\"");
    assert_eq!((kind.key.to_string().as_str(), kind.value(), kind.line), ("motion.frames", Some("\"many\""), Some(5)));
    assert_eq!(kind.remedy(), "must be a whole number of at least 0");
    let unknown = error("time_step", "time_stpe");
    assert!(matches!(*unknown.problem, Problem::UnknownKey { near: Some(ref near), .. } if near == "motion.time_step"));
    let set = parse(GUST, &[("motion.time_step", "-1")]).unwrap_err();
    assert_eq!((set.line, set.set.as_deref()), (None, Some("motion.time_step=-1")));
}

#[test]
fn wrong_types_say_what_was_found_and_what_must_be() {
    assert_eq!(
        refused("frames = 100", "frames = \"many\""),
        "scenes/gust.toml:5: motion.frames: found \"many\", must be a whole number of at least 0"
    );
    assert_eq!(
        refused("frames = 100", "frames = -3"),
        "scenes/gust.toml:5: motion.frames: found -3, must be a whole number of at least 0"
    );
    assert_eq!(
        refused("frames = 100", "frames = 2.5"),
        "scenes/gust.toml:5: motion.frames: found 2.5, must be a whole number of at least 0"
    );
    assert_eq!(
        refused("frames = 100", "frames = 99999999999"),
        "scenes/gust.toml:5: motion.frames: found 99999999999, must be a whole number of at most 4294967295"
    );
    assert_eq!(
        refused("time_step = 0.1", "time_step = true"),
        "scenes/gust.toml:6: motion.time_step: found true, must be a number"
    );
    let short = refused("[-100, 0, 0]", "[-100, 0]");
    assert_eq!(short, "scenes/gust.toml:11: force[0].vector: has 2 entries, must be three numbers, [x, y, z]");
    let long = refused("[-100, 0, 0]", "[-100, 0, 0, 7]");
    assert_eq!(long, "scenes/gust.toml:11: force[0].vector: has 4 entries, must have 3");
    let inside = refused("[-100, 0, 0]", "[-100, \"a\", 0]");
    assert_eq!(inside, "scenes/gust.toml:11: force[0].vector[1]: found \"a\", must be a number");
    assert_eq!(
        refused("vector = [-100, 0, 0]\n", ""),
        "scenes/gust.toml:9: force[0].vector: is missing: write vector = ..."
    );
    assert_eq!(
        refused("[motion]", "[head]\nunit = \"mile\"\nmesh = \"a.obj\"\n[motion]"),
        "scenes/gust.toml:5: head.unit: \"mile\" is not a unit: write \"mm\", \"cm\", \"dm\", \"m\", \"in\", \"ft\" or \
         a number of centimetres"
    );
    assert_eq!(
        refused("[motion]", "[head]\nup = \"+w\"\nmesh = \"a.obj\"\n[motion]"),
        "scenes/gust.toml:5: head.up: found \"+w\", must be one of \"+x\", \"x\", \"-x\", \"+y\", \"y\", \"-y\", \"+z\", \
         \"z\", \"-z\"; did you mean \"+x\"?"
    );
    assert_eq!(
        refused("[motion]", "[[motion]]"),
        "scenes/gust.toml:4: motion: found a list of tables, must be a table; in a file, write [motion] instead of [[motion]]"
    );
    assert_eq!(
        parse("[force]\nthrough = 50\n", &[]).unwrap_err().to_string(),
        "scenes/gust.toml:1: force: found a table, must be a list in brackets, even of one entry; in a file, write [[force]] above each table of a list"
    );
    let table = refused("[-100, 0, 0]", "{ x = 1, y = 0, z = 0 }");
    assert_eq!(table, "scenes/gust.toml:11: force[0].vector: found a table, must be three numbers, [x, y, z]");
}

#[test]
fn a_choice_says_all_that_it_may_be() {
    let shading = refused_override("picture.hair.shading", "3");
    assert!(shading.ends_with("shading: found 3, must be one of \"fibre\", \"kajiya-kay\""), "{shading}");
    for (value, found) in
        [("\"rgb\"", "\"rgb\" alone"), ("\"melanin\"", "\"melanin\" alone"), ("[0.5, 0.5, 0.1]", "a list")]
    {
        let said = refused_override("picture.hair.colour", value);
        let colour = format!("picture.hair.colour: found {found}, must be a name, as \"brown\", or {{ melanin = ");
        assert!(said.contains(&colour) && said.ends_with("or { rgb = [r, g, b] }"), "{said}");
    }
}

#[test]
fn a_number_too_large_for_what_keeps_it_is_said_as_it_was_given() {
    for key in ["motion.time_step", "free.settle", "head.shell", "force.0.vector[1]"] {
        let said = refused_override(key, "-1e300");
        assert!(said.contains(" = -1e300: must lie in -3.4e38..3.4e38"), "{said}");
    }
}

#[test]
fn values_out_of_range_are_refused_by_their_owners_with_the_line() {
    assert_eq!(
        refused("time_step = 0.1", "time_step = -0.1"),
        "scenes/gust.toml:6: motion.time_step = -0.1: must be a finite number above 0"
    );
    assert_eq!(
        refused("linear_density = 0.05", "linear_density = 0"),
        "scenes/gust.toml:7: motion.linear_density = 0: must be a finite number above 0"
    );
    assert_eq!(
        refused("strands = 100", "strands = 0"),
        "scenes/gust.toml:2: hair.strands = 0: must lie in 1..800000000"
    );
    assert_eq!(
        refused("strands = 100", "strands = 800000001"),
        "scenes/gust.toml:2: hair.strands = 800000001: must lie in 1..800000000"
    );
    assert_eq!(
        refused("[motion]", "[pseudo_force]\nalpha = 1.5\n[motion]"),
        "scenes/gust.toml:5: pseudo_force.alpha = 1.5: must lie in -1..1"
    );
    assert_eq!(
        refused("[motion]", "[pseudo_force]\ncoefficients = [0.5,\n  0]\n[motion]"),
        "scenes/gust.toml:6: pseudo_force.coefficients[1] = 0: must lie above 0 and not above 1"
    );
    assert_eq!(
        refused("through = 100", "through = 50"),
        "scenes/gust.toml:13: force[1].through = 50: must come after frame 50, where the interval before it ends"
    );
    assert_eq!(
        refused("vector = [-15, -150, 0]", "vector = [-15, nan, 0]"),
        "scenes/gust.toml:14: force[1].vector = [-15, NaN, 0]: each component must be a finite number"
    );
    assert_eq!(
        parse("[motion]\nframes = 3\n", &[]).unwrap_err().to_string(),
        "scenes/gust.toml: force is missing: give at least one [[force]] with through and vector, or another field"
    );
    assert_eq!(
        refused("[motion]", "[head]\nshell = 1\n[motion]"),
        "scenes/gust.toml:5: head.shell = 1: must be a finite number above 1"
    );
    assert_eq!(
        refused("[motion]", "[output]\nsheet = [0, 101]\n[motion]"),
        "scenes/gust.toml:5: output.sheet[1] = 101: the last frame is motion.frames = 100; take it out of the sheet"
    );
}

#[test]
fn keys_without_effect_are_refused() {
    assert_eq!(
        refused("strands = 100", "file = \"a.tfx\"\nseed = 7"),
        "scenes/gust.toml:3: hair.seed: has no effect on hair that hair.file imports: remove one of them"
    );
    assert_eq!(
        refused("strands = 100", "join_within = 0.1"),
        "scenes/gust.toml:2: hair.join_within: has an effect only on hair that hair.file imports: give that or remove this"
    );
    assert_eq!(
        refused("[motion]", "[head]\nunit = \"m\"\n[motion]"),
        "scenes/gust.toml:5: head.unit: has no effect on the built-in head: remove it, or give head.mesh a file"
    );
    assert_eq!(
        refused("[motion]", "[head]\nmesh = \"builtin:head\"\n[motion]"),
        "scenes/gust.toml:5: head.mesh = \"builtin:head\": there is one built-in head, \"builtin:bust\""
    );
    assert_eq!(
        refused("strands = 100", "file = \"a.tfx\"\nunti = \"m\""),
        "scenes/gust.toml:3: hair.unti: unknown key; did you mean hair.unit?"
    );
}

#[test]
fn a_wrong_override_is_named_instead_of_a_line() {
    assert_eq!(
        refused_override("motion.time_stpe", "1"),
        "scenes/gust.toml: --set motion.time_stpe=1: motion.time_stpe: unknown key; did you mean motion.time_step?"
    );
    assert_eq!(
        refused_override("motion.time_step", "slow"),
        "scenes/gust.toml: --set motion.time_step=slow: motion.time_step: found \"slow\", must be a number"
    );
    assert_eq!(
        refused_override("motion.time_step", "-1"),
        "scenes/gust.toml: --set motion.time_step=-1: motion.time_step = -1: must be a finite number above 0"
    );
    assert_eq!(
        refused_override("force.7.vector", "[0,0,0]"),
        "scenes/gust.toml: --set force.7.vector=[0,0,0]: force is a list of 2: name an entry by a number from 0 to 2"
    );
    assert_eq!(
        refused_override("motion.frames.x", "1"),
        "scenes/gust.toml: --set motion.frames.x=1: motion.frames is integer 100, which has no keys"
    );
    assert_eq!(
        refused_override("motion..frames", "1"),
        "scenes/gust.toml: --set motion..frames=1: write a key as motion.time_step or force.0.vector"
    );
    assert_eq!(
        refused_override("force.0.vector", "[1,2"),
        "scenes/gust.toml: --set force.0.vector=[1,2: [1,2 is not a TOML value: write 0.5, not .5, and close each bracket and quote"
    );
    let large = refused_override("hair.seed", "9223372036854775808");
    assert!(large.contains("9223372036854775808 is outside TOML's whole numbers"), "{large}");
}

#[test]
fn what_is_no_toml_is_refused_with_its_line() {
    let error = refused("time_step = 0.1", "time_step = = 0.1");
    assert!(error.starts_with("scenes/gust.toml:6: not TOML: "), "{error}");
    let twice = refused("time_step = 0.1", "time_step = 0.1\ntime_step = 0.2");
    assert!(twice.starts_with("scenes/gust.toml:7: not TOML: duplicate key time_step: "), "{twice}");
    let error = Scene::load("no/such/scene.toml".as_ref(), &[]).unwrap_err().to_string();
    assert_eq!(error, "no/such/scene.toml: there is no such file or folder");
}

#[test]
fn the_identity_is_that_of_the_motion_and_not_of_the_spelling() {
    let build = |overrides: &[(&str, &str)]| parse(GUST, overrides).unwrap().build(Shown::All).unwrap();
    let gust = build(&[]);
    let identity = gust.identity().unwrap();
    let defaults_written_out = [("motion.time_step", "0.10"), ("pseudo_force.alpha", "-0.75"), ("hair.segments", "18")];
    assert_eq!(build(&defaults_written_out).identity().unwrap(), identity);

    let same = |what: &str, change: &dyn Fn(&mut BuiltScene)| {
        let mut stage = gust.clone();
        change(&mut stage);
        assert_eq!(stage.identity().unwrap(), identity, "{what}");
    };
    same("the same motion, less of it", &|stage| stage.dynamics.motion.frames = 60);
    same("the same motion, drawn otherwise", &|stage| stage.scene.picture.size = [64, 64]);

    let other = |what: &str, change: &dyn Fn(&mut BuiltScene)| {
        let mut stage = gust.clone();
        change(&mut stage);
        assert_ne!(stage.identity().unwrap(), identity, "{what}");
    };
    other("time step", &|stage| stage.dynamics.motion.time_step = 0.11);
    other("linear density", &|stage| stage.dynamics.motion.linear_density = 0.06);
    other("alpha", &|stage| stage.dynamics.pseudo_force.alpha = -0.5);
    other("shell", &|stage| stage.dynamics.shell = 1.3);
    other("ellipsoid", &|stage| stage.dynamics.ellipsoid.half_axes.x += 0.1);
    other("disturbance", &|stage| stage.dynamics.disturbance = Some(Default::default()));
    fn hair(stage: &mut BuiltScene) -> &mut Hair {
        &mut Arc::make_mut(&mut stage.groom).hair
    }
    other("a point", &|stage| hair(stage).strands.points_mut()[7].x += 1e-5);
    other("fewer strands", &|stage| *hair(stage) = stage.groom.hair.select(&[0, 1, 2]));
}

#[test]
fn the_identity_is_also_that_of_the_files_that_move_the_head() {
    let folder = tempfile::tempdir().unwrap();
    let identity_at = |fps: &str, last_x: f32| {
        let columns = "t_s,px_m,py_m,pz_m,qx,qy,qz,qw";
        let table = format!("{columns}\n0,0,1.6,0,0,0,0,1\n1,0.5,1.6,0,0,0,0,1\n9,{last_x},1.6,0,0,0,0,1\n");
        std::fs::write(folder.path().join("run.csv"), table).unwrap();
        let over =
            [("head.motion", "{ file = \"run.csv\", up = \"+y\", facing = \"+x\" }"), ("motion.frame_rate", fps)];
        let over = over.map(|(key, value)| (key.to_owned(), value.to_owned()));
        let path = folder.path().join("scene.toml");
        Scene::parse(GUST, &path, &over).unwrap().build(Shown::All).unwrap().identity().unwrap()
    };
    let one = identity_at("24", 2.0);
    assert_eq!(identity_at("24", 2.0), one);
    assert_ne!(identity_at("24", 3.0), one);
    assert_ne!(identity_at("30", 2.0), one, "the head is elsewhere in each frame");
}

#[test]
fn every_scene_of_the_gallery_is_read() {
    let gallery = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes"));
    let mut read = 0;
    for entry in std::fs::read_dir(gallery).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|ending| ending == "toml") {
            Scene::load(&path, &[]).unwrap();
            read += 1;
        }
    }
    assert!(read >= 3, "{read} scenes in {}", gallery.display());
}

#[test]
fn imported_hair_is_cut_into_the_segments_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("two.obj");
    std::fs::write(&path, "v 0 10 0\nv 0 12 0\nv 0 12 1\nv 5 10 0\nv 9 10 0\nl 1 2 3\nl 4 5\n").unwrap();
    let built = |segments: &str| {
        let text = format!(
            "[hair]\nfile = \"{}\"\n{segments}\n[[force]]\nthrough = 1\nvector = [0, -1, 0]\n[motion]\nframes = 1\n",
            path.display()
        );
        Scene::parse(&text, std::path::Path::new("two.toml"), &[])?.build(Shown::All)
    };
    let as_in_file = built("").unwrap().strands().clone();
    let cut = built("segments = 6").unwrap().strands().clone();
    assert_eq!(as_in_file.iter().map(<[_]>::len).collect::<Vec<_>>(), [3, 2]);
    for (cut, whole) in cut.iter().zip(as_in_file.iter()) {
        assert_eq!((cut.len(), cut[0], cut[6]), (7, whole[0], whole[whole.len() - 1]));
    }
    // 3 cm around a corner in halves of a centimetre: the corner is the fifth point.
    let corner = as_in_file.iter().next().unwrap()[1];
    assert!(cut.iter().next().unwrap()[4].distance(corner) < 1e-5);
    let refused = built(&format!("segments = {}", usize::MAX / 2)).unwrap_err().to_string();
    assert!(refused.contains("hair.segments") && refused.contains("must lie in 1..65535"), "{refused}");
}

#[test]
fn a_file_keeps_the_ends_of_its_lines() {
    let text = "[motion]\n# as long as the wind\nframes = 9\n\n[[force]]\nthrough = 9\nvector = [-1, 0, 0]\n";
    for text in [text.to_owned(), text.replace('\n', "\r\n")] {
        let mut scene = Scene::parse(&text, Path::new("a.toml"), &[]).unwrap();
        scene.motion.frames = 12;
        assert_eq!(scene.to_toml().unwrap(), text.replace("frames = 9", "frames = 12"));
    }
}

#[test]
fn what_is_tied_swings_as_hair_of_the_length_behind_its_tie() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/ponytail.toml");
    let few = [("hair.strands".to_owned(), "40".to_owned())];
    let built = Scene::load(&path, &few).unwrap().build(Shown::All).unwrap();
    let table = SwingTable::of(&built);
    let Form::Free(free) = &built.dynamics.form else { panic!("the ponytail is of the free form") };
    let tie = free.form.tie.expect("it is tied");
    let mut behind: Vec<f32> = built
        .groom
        .hair
        .strands
        .iter()
        .map(|strand| strand[tie.held(strand)..].windows(2).map(|w| w[0].distance(w[1])).sum())
        .collect();
    behind.sort_by(f32::total_cmp);
    let line = format!("cm beyond its tie; a frame is {} steps", free.form.steps());
    assert!(table.tied && table.to_string().contains(&line), "{table}");
    assert_eq!(table.length, behind[behind.len() / 2]);
}

#[test]
fn a_setting_whose_first_table_was_forgotten_is_found() {
    for (key, line) in [
        ("hair.smooth", "hair.smooth: unknown key; did you mean picture.hair.smooth?"),
        ("hair.width", "hair.width: unknown key; did you mean picture.hair.width?"),
        ("camera.azimuth", "camera: unknown key; did you mean picture.camera?"),
        ("parting.wobble", "parting: unknown key; did you mean hair.style.parting?"),
    ] {
        let sets = [(key.to_owned(), "1".to_owned())];
        let refused = Scene::parse(GUST, Path::new("scenes/gust.toml"), &sets).unwrap_err().to_string();
        assert!(refused.ends_with(line), "{refused}");
    }
}

#[test]
fn a_path_of_windows_in_double_quotes_is_refused_with_what_helps() {
    for text in [r#"mesh = "C:\hair\new.obj""#, r#"mesh = "C:\Users\me\new.obj""#] {
        let refused = Scene::parse(&format!("[head]\n{text}\n"), Path::new("a.toml"), &[]).unwrap_err().to_string();
        assert!(refused.starts_with("a.toml:2: not TOML: "), "{refused}");
        assert!(refused.ends_with(r"; in a path, write / or single quotes: 'C:\hair\new.obj'"), "{refused}");
    }
    const FORCE: &str = "[[force]]\nthrough = 100\nvector = [0, 0, 0]\n";
    // This one is TOML, with a tab and a line break.
    let scene = Scene::parse(&format!("[head]\nmesh = \"C:\\temp\\new.obj\"\n{FORCE}"), Path::new("a.toml"), &[]);
    let refused = scene.unwrap().load_head().unwrap_err().to_string();
    assert!(refused.contains("has a control character: in a path, write / or single quotes"), "{refused}");
}
