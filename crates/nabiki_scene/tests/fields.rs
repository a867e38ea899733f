//! Fields of a scene: read, refused, added up, told.

use std::path::Path;
use std::sync::Arc;

use glam::Vec3;
use nabiki::field::{Ease, Keyframe, KeyframedField};
use nabiki_scene::info::info;
use nabiki_scene::scene::{OwnField, Scene, SceneError};
use nabiki_scene::{BuiltScene, Shown};

const FIELDS: &str = "\
[hair]
strands = 20
seed = 1
[motion]
frames = 10
[[force]]
through = 10
vector = [-40, 0, 0]
[wind]
ease = \"smooth\"
[gust]
intensity = 0.2
[flow]
[turbulence]
strength = 12
[[point]]
position = [20, 0, 0]
[[vortex]]
position = [0, 0, 0]
strength = -20
[[fan]]
position = [40, 0, 0]
direction = [-1, 0, 0]
envelope = [{ frame = 2, factor = 0 }, { frame = 6, factor = 1 }]
";

fn parse(text: &str, overrides: &[(&str, &str)]) -> Result<Scene, SceneError> {
    let overrides: Vec<_> = overrides.iter().map(|&(key, value)| (key.to_owned(), value.to_owned())).collect();
    Scene::parse(text, Path::new("fields.toml"), &overrides)
}

fn built(text: &str, overrides: &[(&str, &str)]) -> BuiltScene {
    parse(text, overrides).unwrap().build(Shown::All).unwrap()
}

fn refused(text: &str) -> String {
    match parse(text, &[]) {
        Err(refused) => refused.to_string(),
        Ok(_) => panic!("{text}"),
    }
}

/// The scene without the lines from the one that begins with `from` to the one before `to`.
fn without(from: &str, to: &str) -> String {
    let (first, last) = (FIELDS.find(from).unwrap(), FIELDS.find(to).unwrap_or(FIELDS.len()));
    format!("{}{}", &FIELDS[..first], &FIELDS[last..])
}

#[test]
fn a_scene_of_every_field_is_read_and_stays_as_it_stands() {
    let scene = parse(FIELDS, &[]).unwrap();
    assert_eq!(scene.to_toml().unwrap(), FIELDS);
    assert_eq!(scene.field.wind.ease, Ease::Smooth);
    assert_eq!((scene.field.fan[0].spread, scene.field.fan[0].envelope[1].frame), (30.0, 6));
    let over =
        parse(FIELDS, &[("turbulence.strength", "3"), ("fan.0.strength", "7"), ("flow.thickness", "1")]).unwrap();
    let field = &over.field;
    let set =
        (field.turbulence.as_ref().unwrap().strength, field.fan[0].strength, field.flow.as_ref().unwrap().thickness);
    assert_eq!(set, (3.0, 7.0, 1.0));
    let one_more = parse(FIELDS, &[("point.1.position", "[1, 2, 3]")]).unwrap();
    assert_eq!(one_more.field.point[1].position, Vec3::new(1.0, 2.0, 3.0));
}

#[test]
fn any_field_alone_moves_the_hair_and_all_add_up() {
    let with = |tables: &str| format!("[hair]\nstrands = 20\nseed = 1\n[motion]\nframes = 10\n{tables}");
    let p = Vec3::new(17.0, 3.0, 5.0);
    let mut sum = Vec3::ZERO;
    for tables in [
        &FIELDS[FIELDS.find("[[force]]").unwrap()..FIELDS.find("[turbulence]").unwrap()],
        "[[point]]\nposition = [20, 0, 0]\n",
        "[[vortex]]\nposition = [0, 0, 0]\nstrength = -20\n",
        &FIELDS[FIELDS.find("[[fan]]").unwrap()..],
    ] {
        let built = built(&with(tables), &[]);
        let force = built.force_at(p, 5);
        assert!(force != Vec3::ZERO && force.length() <= built.forces.field.strongest(), "{tables}");
        built.simulation().unwrap();
        sum += force;
    }
    // Turbulence drifts with the wind of its scene.
    let all = built(FIELDS, &[]);
    let calm = built(&without("[turbulence]", "[[point]]"), &[]);
    let alone = built(&with("[turbulence]\nstrength = 12\ndrift = 0\n"), &[]);
    assert!((calm.force_at(p, 5) - sum).length() < 1e-4);
    assert_ne!(all.force_at(p, 5), calm.force_at(p, 5));
    assert!(alone.force_at(p, 5).length() <= alone.forces.field.strongest());
    assert_eq!(built(FIELDS, &[("turbulence.strength", "0")]).force_at(p, 5), calm.force_at(p, 5));
}

#[test]
fn the_papers_field_is_the_papers() {
    let built = built("[hair]\nstrands = 20\n[[force]]\nthrough = 5\nvector = [-1, 2, 3]\n", &[]);
    assert!(built.scene.field.is_the_papers());
    assert_eq!(built.forces.field.uniform(3), Some(Vec3::new(-1.0, 2.0, 3.0)));
}

#[test]
fn fields_without_anything_to_act_on_are_refused() {
    assert_eq!(
        refused(&without("[[force]]", "[wind]")),
        "fields.toml:7: wind.ease = smooth: there is no [[force]] to ease: add one, or remove this"
    );
    let bare = "[turbulence]\n";
    assert_eq!(
        refused(&format!("{bare}[gust]\n")),
        "fields.toml:2: gust = on: gusts change the strength of [[force]], but there is none: add one, or remove [gust]"
    );
    assert_eq!(
        refused(&format!("{bare}[flow]\n")),
        "fields.toml:2: flow = on: there is no [[force]] or [body_wind] to guide around the head: add one, or remove [flow]"
    );
    assert_eq!(
        refused(&format!("{bare}[body_wind]\n")),
        "fields.toml:2: body_wind = on: the head must move to make wind: set head.motion, or remove [body_wind]"
    );
}

#[test]
fn settings_out_of_range_are_refused_with_their_line() {
    let change = |from: &str, to: &str| refused(&FIELDS.replacen(from, to, 1));
    assert_eq!(
        change("intensity = 0.2", "intensity = -1"),
        "fields.toml:12: gust.intensity = -1: must be a finite number of at least 0"
    );
    assert_eq!(change("[flow]", "[flow]\nthickness = nan"), "fields.toml:14: flow.thickness = NaN: must lie in 0..100");
    assert_eq!(change("strength = 12", "octaves = 9"), "fields.toml:15: turbulence.octaves = 9: must lie in 1..8");
    assert_eq!(
        change("position = [20, 0, 0]", ""),
        "fields.toml:16: point[0].position: is missing: write position = ..."
    );
    assert_eq!(
        change("strength = -20", "axis = [0, 0, 0]"),
        "fields.toml:20: vortex[0].axis = [0, 0, 0]: must be a direction, not (0, 0, 0)"
    );
    assert_eq!(
        change("direction = [-1, 0, 0]", "direction = [-1, 0, 0]\nspread = 120"),
        "fields.toml:24: fan[0].spread = 120: must lie in 1..90"
    );
    assert_eq!(
        change("frame = 6", "frame = 1"),
        "fields.toml:24: fan[0].envelope[1].frame = 1: must come after frame 2, the frame of the key before it"
    );
    assert_eq!(
        change("\"smooth\"", "\"smoot\""),
        "fields.toml:10: wind.ease: found \"smoot\", must be one of \"stepped\", \"linear\", \"smooth\"; did you mean \"smooth\"?"
    );
    let law = change("[[vortex]]", "falloff = { law = \"cubic\" }\n[[vortex]]");
    assert!(law.starts_with("fields.toml:18: point[0].falloff.law: found \"cubic\", must be one of \"none\""), "{law}");
    let near = match parse(FIELDS, &[("turbulence.near_head", "30")]).unwrap().build(Shown::All) {
        Err(refused) => refused.to_string(),
        Ok(_) => panic!("wider than the head"),
    };
    assert!(
        near.starts_with("fields.toml: --set turbulence.near_head=30: turbulence.near_head = 30: must be at most"),
        "{near}"
    );
}

#[test]
fn a_field_too_strong_is_blamed_by_its_table() {
    for (key, thing) in
        [("turbulence.strength", "turbulence"), ("fan.0.strength", "fan[0]"), ("force.0.vector", "force[0]")]
    {
        let value = if key.ends_with("vector") { "[1e9, 0, 0]" } else { "1e9" };
        let refused = built(FIELDS, &[(key, value)]).simulation().err().unwrap().to_string();
        assert!(
            refused.contains(&format!("--set {key}={value}: {thing}")) && refused.contains("unstable"),
            "{refused}"
        );
    }
}

#[test]
fn what_an_override_is_wrong_about_is_the_override() {
    let said = |key: &str, value: &str| match parse(FIELDS, &[(key, value)]).map(|scene| scene.build(Shown::All)) {
        Err(refused) => refused.to_string(),
        Ok(Err(refused)) => refused.to_string(),
        Ok(Ok(_)) => panic!("{key}={value}"),
    };
    for (key, value, words) in [
        ("fan.0.envelope", "[{frame=2}]", "fan[0].envelope[0].factor: is missing"),
        ("force.0.vector", "[0, nan, 0]", "force[0].vector = [0, NaN, 0]"),
        ("force.1.vector", "[1, 0, 0]", "force[1].through: is missing"),
        ("free.stiffness", "[1, -1]", "free.stiffness[1] = -1"),
        ("body.0.margin", "0.2", "body[0].mesh is missing"),
    ] {
        let refused = said(key, value);
        assert!(refused.starts_with(&format!("fields.toml: --set {key}={value}: {words}")), "{refused}");
    }
}

#[test]
fn hair_that_flies_off_is_one_line_with_what_may_be_lowered() {
    let wild = |key, value| built(FIELDS, &[("free.stiffness", "0"), (key, value), ("motion.form", "free")]);
    let refused = wild("free.gravity", "1e9").simulation().err().unwrap().to_string();
    assert!(
        refused.contains("free.gravity = 1000000000: unstable: ") && refused.contains("keep gravity below"),
        "{refused}"
    );
    // Cohesion is air that goes with the hair: it is stepped implicitly, and may have any strength.
    let firm = wild("neighbours.cohesion", "1e12");
    let mut frames = nabiki_scene::frames::Simulated::new(&firm).unwrap();
    for n in 1..=8 {
        nabiki_scene::frames::FrameSource::frame(&mut frames, n).unwrap();
    }
    // Pressure has no bound. A segment turns by a radian in a step at the most, so that hair hops long before it is beyond all numbers.
    let flung = |value| {
        let built = wild("neighbours.pressure", value);
        let mut frames = nabiki_scene::frames::Simulated::new(&built).unwrap();
        let mut summary = nabiki_scene::motion_summary::MotionSummary::default();
        for n in 0..=8 {
            match nabiki_scene::frames::FrameSource::frame(&mut frames, n) {
                Ok(strands) => summary.add(&built, n, strands),
                Err(refused) => return refused.to_string(),
            }
        }
        summary.to_string()
    };
    let said = flung("1e36");
    assert!(said.contains("warning hair hops: ") && said.contains("lower neighbours.pressure = 1"), "{said}");
    let said = flung("3e38");
    assert!(said.starts_with("fields.toml: frame ") && said.contains("lower neighbours.pressure = 3"), "{said}");
}

#[test]
fn every_field_counts_in_the_identity() {
    let identity = |overrides: &[(&str, &str)]| built(FIELDS, overrides).identity().unwrap();
    let whole = identity(&[]);
    assert_eq!(identity(&[("vortex.0.axis", "[0, 1, 0]")]), whole, "the default written out");
    for change in [
        ("wind.ease", "linear"),
        ("gust.seed", "2"),
        ("flow.thickness", "1"),
        ("turbulence.octaves", "1"),
        ("point.0.strength", "3"),
        ("vortex.0.strength", "3"),
        ("fan.0.spread", "20"),
        ("motion.frame_rate", "25"),
    ] {
        assert_ne!(identity(&[change]), whole, "{change:?}");
    }
}

#[test]
fn info_tells_every_field_and_what_it_can_reach() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("fields.toml");
    std::fs::write(&path, FIELDS).unwrap();
    let said = info(&path).unwrap().to_string();
    for line in [
        "force: (-40, 0, 0) in frames 1 to 10",
        "wind: eased smoothly from one to the next",
        "gust: intensity 0.2, time scale ",
        "flow: thickness ",
        "turbulence: strength 12, swirl size 10 cm, ",
        "point[0]: position (20, 0, 0) cm, strength 50, falloff ",
        "vortex[0]: position (0, 0, 0) cm, axis (0, 1, 0), strength -20, ",
        "fan[0]: position (40, 0, 0) cm, direction (-1, 0, 0), strength 50, spread 30 degrees, ",
        "all fields: |F| at most ",
    ] {
        assert!(said.lines().any(|told| told.starts_with(line)), "{line}\n{said}");
    }
}

#[test]
fn the_wind_of_a_recorded_head_is_against_its_way() {
    let folder = tempfile::tempdir().unwrap();
    let table = "t_s,px_m,py_m,pz_m,qx,qy,qz,qw\n0,0,1.6,0,0,0,0,1\n1,2,1.6,0,0,0,0,1\n";
    std::fs::write(folder.path().join("run.csv"), table).unwrap();
    let text = "[hair]\nstrands = 20\n[motion]\nframes = 20\n[head.motion]\nfile = \"run.csv\"\nup = \"+y\"\n\
                facing = \"+x\"\n[body_wind]\n[flow]\n";
    let build = |space: &str, frame_rate: &str| {
        let over = [("motion.force_space", space), ("motion.frame_rate", frame_rate)]
            .map(|(key, value)| (key.to_owned(), value.to_owned()));
        Scene::parse(text, &folder.path().join("run.toml"), &over).unwrap().build(Shown::All).unwrap()
    };
    // 2 m a second along x; far from the head. The head looks along x, so head space is the world turned no way.
    for (space, frame_rate) in [("world", "24"), ("world", "60"), ("head", "24")] {
        let built = build(space, frame_rate);
        let force = built.force_at(Vec3::new(0.0, 5000.0, 0.0), 10);
        assert!((force - Vec3::new(-60.0, 0.0, 0.0)).length() < 0.01, "{space} {frame_rate}: {force}");
        built.simulation().unwrap();
    }
}

#[test]
fn gusts_go_by_the_seconds_of_a_scene_and_not_by_its_frames() {
    let text = "[hair]\nstrands = 20\n[motion]\nframes = 40\n[gust]\n[[force]]\nthrough = 40\nvector = [-40, 0, 0]\n";
    let [slow, fast] = ["24", "48"].map(|rate| built(text, &[("motion.frame_rate", rate)]));
    let x = |built: &BuiltScene, n: u32| built.force_at(Vec3::ZERO, n).x;
    for n in 1..=20 {
        // Half of a rate is the same digits.
        assert_eq!(x(&slow, n), x(&fast, 2 * n), "frame {n}");
    }
    assert_ne!(x(&slow, 20), x(&fast, 20));
}

#[test]
fn turbulence_is_carried_by_the_wind_of_its_scene() {
    let text = "[hair]\nstrands = 20\n[motion]\nframes = 10\n[[force]]\nthrough = 5\nvector = [-40, 10, 5]\n\
                [[force]]\nthrough = 10\nvector = [0, -30, 20]\n\
                [turbulence]\nstrength = 12\npulse_length = 0\nnear_head = 0\ndrift = 0.02\n";
    let built = built(text, &[]);
    for (frames, wind) in [(1..=5, Vec3::new(-40.0, 10.0, 5.0)), (6..=10, Vec3::new(0.0, -30.0, 20.0))] {
        let swirls = |place: Vec3, n: u32| built.force_at(place, n) - wind;
        for place in [Vec3::new(12.0, 3.0, -4.0), Vec3::new(-3.0, 14.0, 2.0), Vec3::new(1.0, -2.0, 13.0)] {
            let first = swirls(place, *frames.start());
            for n in frames.clone() {
                let there = swirls(place + 0.02 * wind * (n - frames.start()) as f32, n);
                // Places of 20 cm are rounded to 1e-6 of themselves, and a force of 40 likewise.
                assert!(there.distance(first) < 1e-3, "{n} {place}: {there}, not {first}");
            }
            assert!(swirls(place, *frames.end()).distance(first) > 0.1, "{place}");
        }
    }
}

/// About a head that walks and turns, the wind is led round the head where that is; in its own space it stands still.
#[test]
fn the_wind_is_led_round_the_head_wherever_that_is() {
    let folder = tempfile::tempdir().unwrap();
    let (s, c) = (0.1_f32.sin(), 0.1_f32.cos());
    let row = |n: u32| {
        // By a fifth of a radian about z each frame, as a quaternion of half of that.
        let half = glam::Quat::from_xyzw(0.0, 0.0, s, c);
        let turn = (0..n).fold(glam::Quat::IDENTITY, |turn, _| half * turn);
        format!("{},{},{},0,0,0,{},{}\n", f64::from(n) / 24.0, 16 * n, 4 * n, turn.z, turn.w)
    };
    let table = "t_s,px_cm,py_cm,pz_cm,qx,qy,qz,qw\n".to_owned() + &(0..=10).map(row).collect::<String>();
    std::fs::write(folder.path().join("walk.csv"), table).unwrap();
    let build = |wind: Vec3, more: &str| {
        let [x, y, z] = wind.to_array();
        let text = format!(
            "[hair]\nstrands = 20\n[motion]\nframes = 10\n[flow]\n[[force]]\nthrough = 10\nvector = [{x:?}, {y:?}, {z:?}]\n{more}"
        );
        Scene::parse(&text, &folder.path().join("walk.toml"), &[]).unwrap().build(Shown::All).unwrap()
    };
    let walking = "[head]\nmotion = { file = \"walk.csv\", up = \"+y\", facing = \"+x\" }\n";
    let wind = Vec3::new(-40.0, 10.0, 5.0);
    let in_world = build(wind, walking);
    let mut in_head = in_world.scene.clone();
    in_head.motion.force_space = nabiki::dynamics::ForceSpace::Head;
    let (in_head, still) = (in_head.build(Shown::All).unwrap(), build(wind, ""));
    for n in [1, 4, 10] {
        let pose = in_world.pose(n);
        let against = build(pose.rotation.inverse() * wind, "");
        for place in [Vec3::new(12.0, 3.0, -4.0), Vec3::new(-3.0, 14.0, 2.0), Vec3::new(1.0, -2.0, 13.0)] {
            let there = pose.world_from_head().transform_point3(place);
            let (found, wanted) = (in_world.force_at(there, n), pose.rotation * against.force_at(place, n));
            // Places of 200 cm are rounded to some 1e-5 of a head's size.
            assert!(found.distance(wanted) < 1e-3 * wind.length(), "{n} {place}: {found}, not {wanted}");
            assert!((wanted - wind).length() > 0.02 * wind.length(), "{n} {place}: it is led");
            assert_eq!(in_head.force_at(place, n), still.force_at(place, n));
        }
    }
}

/// A field of a program's own is one more: added up, kept by other settings, and not to be written anywhere.
#[test]
fn a_field_of_a_programs_own_is_added_and_cannot_be_written() {
    let vector = Vec3::new(3.0, -2.0, 1.0);
    let own = OwnField(Arc::new(KeyframedField::new(&[Keyframe { through: 10, vector }]).unwrap()));
    let mut scene = parse(FIELDS, &[]).unwrap();
    let place = Vec3::new(12.0, 3.0, -4.0);
    let without = scene.clone().build(Shown::First(5)).unwrap();
    scene.field.own = vec![own.clone(), own];
    let scene = scene.with_setting("motion.frames", Some(7.into())).unwrap();
    let with = scene.clone().build(Shown::First(5)).unwrap();
    for frame in 1..=7 {
        assert_eq!(with.force_at(place, frame), without.force_at(place, frame) + vector + vector);
    }
    assert!(with.forces.field.strongest() >= without.forces.field.strongest() + 2.0 * vector.length());
    let written = scene.to_toml().unwrap_err().to_string();
    assert!(written.contains("cannot hold a field from a program"), "{written}");
    let marked = with.identity().unwrap_err().to_string();
    assert!(marked.contains("export to .usd"), "{marked}");
    assert!(without.identity().is_ok());
}

/// In the paper's form there must be some field, and one of a program's own is some.
#[test]
fn a_field_of_a_programs_own_may_be_the_only_one() {
    let mut scene = Scene::default();
    assert!(scene.check().is_err());
    let force = [Keyframe { through: 10, vector: Vec3::X }];
    scene.field.own.push(OwnField(Arc::new(KeyframedField::new(&force).unwrap())));
    scene.check().unwrap();
    assert_ne!(scene, Scene::default());
    assert_eq!(scene.clone(), scene);
}
