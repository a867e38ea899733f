//! The scene as a document: what is written is what is read, and what is not changed stays as it stands.

mod common;

use std::path::{Path, PathBuf};

use glam::{Vec2, Vec3};
use nabiki::Profile;
use nabiki::body::Contact;
use nabiki::disturbance::Disturbance;
use nabiki::field::{Ease, EnvelopeKey, Falloff, FalloffLaw, Fan, Flow, Gust, Keyframe, Point, Turbulence};
use nabiki::free_form::NeighbourForces;
use nabiki::groom::style::{Cut, Region};
use nabiki_io::Unit;
use nabiki_io::motion::{Axis, MotionSource};
use nabiki_render::settings::{CameraKey, HairColour, Light};
use nabiki_scene::Scene;
use nabiki_scene::scene::{
    BodySettings, EllipsoidChoice, FormChoice, FreeSettings, Gravity, GrownHair, HairSource, HeadSource, ImportedHair,
    ImportedHead, Problem,
};
use proptest::prelude::*;

use common::{changed_lines, lines, reread};

fn shipped() -> Vec<PathBuf> {
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes"));
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let scenes: Vec<PathBuf> = entries.filter(|path| path.extension().is_some_and(|e| e == "toml")).collect();
    assert!(!scenes.is_empty());
    scenes
}

fn keyframe(through: u32, vector: [f32; 3]) -> Keyframe {
    Keyframe { through, vector: Vec3::from(vector) }
}

fn keyframes(scene: &mut Scene) -> &mut Vec<Keyframe> {
    &mut scene.field.force
}

const TEXT: &str = "\
# A scene with words of its own.
[motion]   # how it moves
frames = 60      # two seconds and a half
time_step=0.1

# First back,
[[force]]
through = 30
vector = [-100, 0, 0]   # a gust
# then down.
[[force]]
through = 60
vector = [-15.5, -150, 0]

[picture]
camera = { azimuth = 50.0, distance = 90 } # from the side
";

fn sample() -> Scene {
    Scene::parse(TEXT, Path::new("sample.toml"), &[]).unwrap()
}

/// The lines that a change takes away and brings.
fn change(edit: impl FnOnce(&mut Scene)) -> (Vec<String>, Vec<String>) {
    let mut scene = sample();
    edit(&mut scene);
    let text = scene.to_toml().unwrap();
    assert_eq!(Scene::parse(&text, Path::new("again.toml"), &[]).unwrap(), scene, "{text}");
    changed_lines(TEXT, &text)
}

#[test]
fn a_shipped_scene_that_nobody_changed_keeps_its_bytes() {
    for path in shipped() {
        let text = std::fs::read_to_string(&path).unwrap();
        assert_eq!(Scene::load(&path, &[]).unwrap().to_toml().unwrap(), text, "{}", path.display());
    }
}

#[test]
fn one_changed_value_changes_one_line_of_any_shipped_scene() {
    for path in shipped() {
        let text = std::fs::read_to_string(&path).unwrap();
        let mut scene = Scene::load(&path, &[]).unwrap();
        scene.motion.inertia_length_floor += 0.125;
        let has_force = !scene.field.force.is_empty();
        if let Some(key) = scene.field.force.first_mut() {
            key.vector.x = -77.5;
        }
        let new = scene.to_toml().unwrap();
        let pairs: Vec<_> = text.lines().zip(new.lines()).filter(|(a, b)| a != b).collect();
        let changed = 1 + usize::from(has_force);
        assert_eq!((text.lines().count(), pairs.len()), (new.lines().count(), changed), "{}\n{new}", path.display());
        assert_eq!(reread(&scene), scene);
    }
}

#[test]
fn numbers_are_replaced_where_they_stand() {
    let (old, new) = change(|scene| keyframes(scene)[0].vector.x = -80.0);
    assert_eq!((old, new), (lines(&["vector = [-100, 0, 0]   # a gust"]), lines(&["vector = [-80, 0, 0]   # a gust"])));
    let (_, new) = change(|scene| keyframes(scene)[1].vector = Vec3::new(-15.5, 0.25, 1e-3));
    assert_eq!(new, lines(&["vector = [-15.5, 0.25, 0.001]"]));
    let (_, new) = change(|scene| scene.motion.time_step = 0.05);
    assert_eq!(new, lines(&["time_step=0.05"]));
    let (_, new) = change(|scene| scene.picture.camera.azimuth = -30.0);
    assert_eq!(new, lines(&["camera = { azimuth = -30.0, distance = 90 } # from the side"]));
    let (_, new) = change(|scene| scene.motion.frames = 61);
    assert_eq!(new, lines(&["frames = 61      # two seconds and a half"]));
}

#[test]
fn forces_come_and_go_with_their_comments() {
    let (old, new) = change(|scene| {
        keyframes(scene).remove(0);
    });
    assert_eq!(old, lines(&["", "# First back,", "[[force]]", "through = 30", "vector = [-100, 0, 0]   # a gust"]));
    assert!(new.is_empty(), "{new:?}");
    let (old, new) = change(|scene| keyframes(scene).insert(1, keyframe(40, [1.0, 2.5, 0.0])));
    assert!(old.is_empty(), "{old:?}");
    assert_eq!(
        new.iter().filter(|line| !line.is_empty()).cloned().collect::<Vec<_>>(),
        ["[[force]]", "through = 40", "vector = [1.0, 2.5, 0.0]"]
    );
    let (old, _) = change(|scene| keyframes(scene).push(keyframe(90, [0.0; 3])));
    assert!(old.is_empty(), "{old:?}");
}

#[test]
fn optional_settings_are_set_and_cleared() {
    let (old, new) = change(|scene| scene.picture.camera.distance = None);
    assert_eq!(old, lines(&["camera = { azimuth = 50.0, distance = 90 } # from the side"]));
    assert_eq!(new, lines(&["camera = { azimuth = 50.0 } # from the side"]));
    let (_, new) = change(|scene| scene.picture.camera.target = Some(Vec3::new(1.0, 2.0, 3.5)));
    assert_eq!(
        new,
        lines(&["camera = { azimuth = 50.0, distance = 90, target = [1.0, 2.0, 3.5] } # from the side"]),
        "the new key comes last"
    );
    let (old, new) = change(|scene| scene.disturbance = Some(Disturbance { seed: 7, ..Disturbance::default() }));
    assert!(old.is_empty());
    assert_eq!(new, lines(&["", "[disturbance]", "seed = 7"]));
    // Present with all its settings at their defaults is not absent.
    let (_, new) = change(|scene| scene.disturbance = Some(Disturbance::default()));
    assert_eq!(new, lines(&["", "[disturbance]"]));
    let (_, new) = change(|scene| scene.picture.camera.to = Some(CameraKey::default()));
    assert_eq!(new.len(), 1);
    let (_, new) = change(|scene| scene.output.sheet = Some(vec![0, 30]));
    assert_eq!(new, lines(&["", "[output]", "sheet = [0, 30]"]));
    let (_, new) = change(|scene| scene.picture.lights.clear());
    assert_eq!(new, lines(&["lights = []"]), "none is not the default");
}

#[test]
fn what_is_at_its_default_and_not_in_the_file_stays_out() {
    let (old, new) =
        change(|scene| scene.hair.source = HairSource::Grown(GrownHair { strands: 300, ..GrownHair::default() }));
    assert_eq!((old, new), (vec![], lines(&["", "[hair]", "strands = 300"])));
}

#[test]
fn the_source_of_head_and_hair_can_change() {
    let (old, new) = change(|scene| {
        scene.head.source = HeadSource::Imported(ImportedHead {
            file: "head.obj".into(),
            unit: Some(Unit { cm: 2.54 }),
            facing: Some(Axis::PlusZ),
            ..ImportedHead::default()
        });
        scene.hair.source = HairSource::Imported(ImportedHair { file: "hair.tfx".into(), ..ImportedHair::default() });
    });
    assert!(old.is_empty(), "{old:?}");
    assert_eq!(
        new,
        lines(&[
            "",
            "[head]",
            "mesh = \"head.obj\"",
            "unit = 2.54",
            "facing = \"+z\"",
            "",
            "[hair]",
            "file = \"hair.tfx\""
        ])
    );
    let imported = "[head]\nmesh = \"a.obj\"\nunit = \"m\"\nshell = 1.5\n[hair]\nfile = \"a.tfx\"\nunit = \"m\"\nsegments = 9\n\
                    [[force]]\nthrough = 1\nvector = [0, -1, 0]\n";
    let mut scene = Scene::parse(imported, Path::new("a.toml"), &[]).unwrap();
    scene.head.source = HeadSource::Builtin;
    scene.hair.source = HairSource::default();
    let text = scene.to_toml().unwrap();
    assert!(text.starts_with("[head]\nmesh = \"builtin:bust\"\nshell = 1.5\n[hair]\n"), "{text}");
    assert_eq!(reread(&scene), scene);
}

#[test]
fn a_scene_made_in_code_is_written_short() {
    let mut scene = Scene::default();
    scene.field.force = vec![keyframe(50, [-100.0, 0.0, 0.0]), keyframe(100, [-15.0, -150.0, 0.0])];
    scene.picture.hair.colour = HairColour::Rgb([0.3, 0.1, 0.05]);
    assert_eq!(
        scene.to_toml().unwrap(),
        "[[force]]\nthrough = 50\nvector = [-100.0, 0.0, 0.0]\n\n[[force]]\nthrough = 100\nvector = [-15.0, -150.0, 0.0]\n\n\
         [picture.hair]\ncolour = { rgb = [0.3, 0.1, 0.05] }\n"
    );
    assert_eq!(reread(&scene), scene);
}

#[test]
fn overrides_are_written_as_changes() {
    let over = ("motion.time_step".to_owned(), "0.07".to_owned());
    let scene = Scene::parse(TEXT, Path::new("sample.toml"), &[over]).unwrap();
    assert_eq!(changed_lines(TEXT, &scene.to_toml().unwrap()).1, lines(&["time_step=0.07"]));
}

#[test]
fn a_saved_scene_is_the_file_from_then_on() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("saved.toml");
    let mut scene = sample();
    scene.pseudo_force.alpha = 0.5;
    scene.save(&path).unwrap();
    assert_eq!(Scene::load(&path, &[]).unwrap(), scene);
    assert_eq!(scene.file(), path);
    // The line is that of the text now on disk.
    scene.pseudo_force.alpha = 7.0;
    let refused = scene.refusal(scene.check().unwrap_err());
    let written = std::fs::read_to_string(&path).unwrap();
    let line = 1 + written.lines().position(|line| line.starts_with("alpha")).unwrap();
    assert_eq!((refused.file, refused.line), (path, Some(line)));
    let error = sample().save(&folder.path().join("no/folder.toml")).unwrap_err();
    assert!(matches!(*error.problem, Problem::File { system: Some(std::io::ErrorKind::NotFound), .. }), "{error}");
}

#[test]
fn what_could_not_be_loaded_again_is_not_saved() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.toml");
    let refused = |change: &dyn Fn(&mut Scene), path: &Path| {
        let mut scene = sample();
        change(&mut scene);
        let line = scene.save(path).unwrap_err().to_string();
        assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 0, "{line}");
        line
    };
    // Each of the two is good by itself.
    let beyond = |scene: &mut Scene| {
        scene.motion.frames = 3;
        scene.output.sheet = Some(vec![0, 4]);
    };
    assert!(refused(&beyond, &path).contains("output.sheet[1] = 4: the last frame is motion.frames = 3"));
    assert!(refused(&|scene| scene.motion.time_step = f32::NAN, &path).contains("motion.time_step"));
    let long = |scene: &mut Scene| {
        scene.head.motion = Some(MotionSource { file: "m".repeat(17 << 20).into(), ..MotionSource::default() });
    };
    assert!(refused(&long, &path).contains("bytes long: a scene has at most 1048576"));
    for name in ["a.abc", "a.usdc", "a.hair", "a.nabiki", "a.png"] {
        assert!(refused(&|_| (), &folder.path().join(name)).contains("a scene ends in .toml"), "{name}");
    }
    sample().save(&path).unwrap();
    assert_eq!(Scene::load(&path, &[]).unwrap(), sample());
}

#[test]
fn what_toml_cannot_hold_is_refused() {
    let mut scene = sample();
    scene.disturbance = Some(Disturbance { seed: u64::MAX, ..Disturbance::default() });
    assert!(scene.to_toml().is_err());
}

fn number() -> impl Strategy<Value = f32> {
    prop_oneof![-200.0f32..200.0, (-100i16..100).prop_map(f32::from), Just(1e-20f32), Just(3.0e30f32)]
}

fn vector() -> impl Strategy<Value = Vec3> {
    [number(), number(), number()].prop_map(Vec3::from)
}

fn edited() -> impl Strategy<Value = Vec<Edit>> {
    prop::collection::vec(any_edit(), 1..8)
}

/// A change to a scene that leaves it in its ranges.
#[derive(Clone, Debug)]
enum Edit {
    Alpha(f32),
    Coefficients(Vec<f32>),
    Forces(Vec<Vec3>),
    Vector(usize, Vec3),
    Ease(bool),
    Gust(Option<(f32, u64)>),
    Flow(Option<f32>),
    Turbulence(Option<(f32, u32)>),
    Points(Vec<(Vec3, f32)>),
    Fans(Vec<(f32, u32)>),
    FrameRate(f64),
    Grown { strands: usize, seed: u64, away: f32, crown: Vec2, cuts: Vec<Option<bool>> },
    ImportedHair { unit: Option<f32>, strands: Option<usize>, origin: Option<Vec3> },
    BuiltinHead,
    ImportedHead { groups: Vec<String>, unit: Option<f32> },
    Ellipsoid(Option<Vec3>),
    HeadMotion(Option<f64>),
    Disturbance(Option<u32>),
    Target(Option<Vec3>),
    CameraTo(Option<f32>),
    Lights(usize, f32),
    Colour(bool, f32),
    Sheet(Option<Vec<u32>>),
    Form(bool),
    Free { stiffness: Profile, gravity: Option<f32>, lag: f32, pseudo_force: bool },
    Contact { margin: f32, friction: f32 },
    Bodies(Vec<BodySettings>),
    Neighbours(Option<u32>),
}

fn profile() -> impl Strategy<Value = Profile> {
    prop_oneof![
        (0.0f32..500.0).prop_map(Profile::Even),
        prop::collection::vec(0.0f32..500.0, 1..5).prop_map(Profile::RootToTip)
    ]
}

/// A body that goes with the head, moves on its own or stands still.
fn body() -> impl Strategy<Value = BodySettings> {
    (any::<Option<bool>>(), 0.0f32..5.0, prop::option::of(vector()), prop::option::of(0.01f32..99.0)).prop_map(
        |(worn, margin, origin, unit)| BodySettings {
            mesh: "body.obj".into(),
            unit: unit.map(|cm| Unit { cm }),
            origin,
            motion: (worn == Some(false)).then(|| MotionSource { file: "hand.csv".into(), ..MotionSource::default() }),
            with_head: worn == Some(true),
            margin,
            ..BodySettings::default()
        },
    )
}

fn any_edit() -> impl Strategy<Value = Edit> {
    let name = "[a-z \"#\\\\]{0,6}";
    prop_oneof![
        (-1.0f32..=1.0).prop_map(Edit::Alpha),
        prop::collection::vec(0.001f32..=1.0, 1..20).prop_map(Edit::Coefficients),
        prop::collection::vec(vector(), 1..5).prop_map(Edit::Forces),
        (0usize..5, vector()).prop_map(|(i, v)| Edit::Vector(i, v)),
        any::<bool>().prop_map(Edit::Ease),
        prop::option::of((0.0f32..1.0, 0u64..99)).prop_map(Edit::Gust),
        prop::option::of(0.0f32..3.0).prop_map(Edit::Flow),
        prop::option::of((0.0f32..99.0, 1u32..9)).prop_map(Edit::Turbulence),
        prop::collection::vec(
            (vector().prop_map(|place| place.clamp(Vec3::splat(-1e6), Vec3::splat(1e6))), number()),
            0..4
        )
        .prop_map(Edit::Points),
        prop::collection::vec((1.0f32..90.0, 1u32..50), 0..3).prop_map(Edit::Fans),
        (1.0f64..240.0).prop_map(Edit::FrameRate),
        (
            1usize..9999,
            0u64..99,
            0.0f32..9.0,
            (-9.0f32..9.0, -9.0f32..9.0),
            prop::collection::vec(any::<Option<bool>>(), 0..3)
        )
            .prop_map(|(strands, seed, away, (x, z), cuts)| Edit::Grown {
                strands,
                seed,
                away,
                crown: Vec2::new(x, z),
                cuts
            }),
        (prop::option::of(0.01f32..99.0), prop::option::of(1usize..99), prop::option::of(vector()))
            .prop_map(|(unit, strands, origin)| Edit::ImportedHair { unit, strands, origin }),
        Just(Edit::BuiltinHead),
        (prop::collection::vec(name, 0..3), prop::option::of(0.01f32..99.0))
            .prop_map(|(groups, unit)| Edit::ImportedHead { groups, unit }),
        prop::option::of([5.0f32..12.0, 5.0..12.0, 5.0..12.0].prop_map(Vec3::from)).prop_map(Edit::Ellipsoid),
        prop::option::of(0.1f64..99.0).prop_map(Edit::HeadMotion),
        prop::option::of(1u32..9).prop_map(Edit::Disturbance),
        prop::option::of([-9.0f32..9.0, -9.0..9.0, -9.0..9.0].prop_map(Vec3::from)).prop_map(Edit::Target),
        prop::option::of(-90.0f32..90.0).prop_map(Edit::CameraTo),
        (0usize..4, 0.1f32..3.0).prop_map(|(n, x)| Edit::Lights(n, x)),
        (any::<bool>(), 0.0f32..1.0).prop_map(|(named, x)| Edit::Colour(named, x)),
        prop::option::of(prop::collection::vec(0u32..10, 0..4)).prop_map(Edit::Sheet),
        any::<bool>().prop_map(Edit::Form),
        (profile(), prop::option::of(0.0f32..500.0), 0.0f32..8.0, any::<bool>())
            .prop_map(|(stiffness, gravity, lag, pseudo_force)| Edit::Free { stiffness, gravity, lag, pseudo_force }),
        (0.0f32..5.0, 0.0f32..1.0).prop_map(|(margin, friction)| Edit::Contact { margin, friction }),
        prop::collection::vec(body(), 0..3).prop_map(Edit::Bodies),
        prop::option::of(1u32..4096).prop_map(Edit::Neighbours),
    ]
}

fn apply(edit: &Edit, scene: &mut Scene) {
    match edit.clone() {
        Edit::Alpha(alpha) => scene.pseudo_force.alpha = alpha,
        Edit::Coefficients(coefficients) => scene.pseudo_force.coefficients = coefficients,
        Edit::Forces(vectors) => {
            let frames = (1..).map(|i| 7 * i);
            *keyframes(scene) = frames.zip(vectors).map(|(through, vector)| Keyframe { through, vector }).collect();
        }
        Edit::Vector(i, vector) => {
            let forces = keyframes(scene);
            let i = i % forces.len();
            forces[i].vector = vector;
        }
        Edit::Ease(smooth) => scene.field.wind.ease = if smooth { Ease::Smooth } else { Ease::Stepped },
        Edit::Gust(gust) => {
            scene.field.gust = gust.map(|(intensity, seed)| Gust { intensity, seed, ..Gust::default() })
        }
        Edit::Flow(flow) => scene.field.flow = flow.map(|thickness| Flow { thickness }),
        Edit::Turbulence(turbulence) => {
            let settings = |(strength, octaves)| Turbulence { strength, octaves, ..Turbulence::default() };
            scene.field.turbulence = turbulence.map(settings);
        }
        Edit::Points(points) => {
            let point = |(position, strength)| Point {
                position,
                strength,
                falloff: Falloff { law: FalloffLaw::InverseSquare, radius: 7.5 },
                envelope: Vec::new(),
            };
            scene.field.point = points.into_iter().map(point).collect();
        }
        Edit::Fans(fans) => {
            let fan = |(spread, frame)| Fan {
                position: Vec3::new(40.0, 0.5, 0.0),
                direction: Vec3::NEG_X,
                strength: 20.0,
                spread,
                falloff: Falloff::default(),
                envelope: vec![EnvelopeKey { frame, factor: 0.5 }, EnvelopeKey { frame: frame + 9, factor: 1.0 }],
            };
            scene.field.fan = fans.into_iter().map(fan).collect();
        }
        Edit::FrameRate(rate) => scene.motion.frame_rate = rate,
        Edit::Grown { strands, seed, away, crown, cuts } => {
            let mut hair = GrownHair { strands, seed, ..GrownHair::default() };
            hair.style.comb.away = away;
            hair.style.parting.crown = crown;
            let cut = |fringe: Option<bool>| Cut {
                point: Vec3::new(0.0, -1.5, 0.25),
                normal: Vec3::NEG_Y,
                region: fringe.map(|fringe| if fringe { Region::Fringe } else { Region::Top }),
                shortest: 2.5,
            };
            hair.style.cuts = cuts.into_iter().map(cut).collect();
            scene.hair.source = HairSource::Grown(hair);
        }
        Edit::ImportedHair { unit, strands, origin } => {
            let file = "hair.tfx".into();
            let unit = unit.map(|cm| Unit { cm });
            let hair = ImportedHair { file, unit, strands, origin, ..ImportedHair::default() };
            scene.hair.source = HairSource::Imported(hair);
        }
        Edit::BuiltinHead => scene.head.source = HeadSource::Builtin,
        Edit::ImportedHead { groups, unit } => {
            let unit = unit.map(|cm| Unit { cm });
            let head = ImportedHead { file: "head.obj".into(), groups, unit, ..ImportedHead::default() };
            scene.head.source = HeadSource::Imported(head);
        }
        Edit::Ellipsoid(half_axes) => {
            scene.head.ellipsoid = half_axes.map_or(EllipsoidChoice::Fit, |half_axes| {
                EllipsoidChoice::Given(nabiki::Ellipsoid { center: Vec3::Y, half_axes })
            });
        }
        Edit::HeadMotion(unit_cm) => {
            scene.head.motion = unit_cm.map(|unit_cm| MotionSource {
                file: "walk.bvh".into(),
                unit_cm: Some(unit_cm),
                ..MotionSource::default()
            });
        }
        Edit::Disturbance(every) => {
            scene.disturbance = every.map(|every| Disturbance { every, ..Disturbance::default() });
        }
        Edit::Target(target) => scene.picture.camera.target = target,
        Edit::CameraTo(azimuth) => {
            scene.picture.camera.to =
                azimuth.map(|azimuth| CameraKey { azimuth: Some(azimuth), ..CameraKey::default() });
        }
        Edit::Lights(count, strength) => {
            scene.picture.lights = Light::studio().into_iter().cycle().take(count).collect();
            if let Some(light) = scene.picture.lights.first_mut() {
                light.strength = strength;
            }
        }
        Edit::Colour(named, x) => {
            scene.picture.hair.colour =
                if named { HairColour::Grey } else { HairColour::Melanin { eumelanin: x, pheomelanin: 0.5 * x } };
        }
        Edit::Sheet(sheet) => scene.output.sheet = sheet,
        Edit::Form(free) => scene.form = if free { FormChoice::Free } else { FormChoice::Paper },
        Edit::Free { stiffness, gravity, lag, pseudo_force } => {
            let gravity = gravity.map_or(Gravity::Earth, Gravity::Strength);
            scene.free = FreeSettings { stiffness, gravity, lag, pseudo_force, ..FreeSettings::default() };
        }
        Edit::Contact { margin, friction } => {
            scene.contact = Contact { margin, friction, static_friction: friction + 0.25 };
        }
        Edit::Bodies(bodies) => scene.bodies = bodies,
        Edit::Neighbours(carriers) => {
            scene.neighbours = carriers.map(|carriers| NeighbourForces { carriers, ..NeighbourForces::default() });
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    /// Any changes, one after another, written each time or once at the end: what is read is what was meant, and no
    /// comment of the scene is lost but with the table it speaks of.
    #[test]
    fn what_is_written_is_what_is_read(edits in edited(), from_code: bool) {
        let mut scene = if from_code { Scene::default() } else { sample() };
        if from_code {
            scene.field.force = vec![keyframe(9, [1.0, 2.0, 3.0])];
        }
        let mut saved_each_time = scene.clone();
        for edit in &edits {
            apply(edit, &mut scene);
            prop_assert_eq!(scene.check(), Ok(()));
            let text = scene.to_toml().unwrap();
            prop_assert_eq!(&Scene::parse(&text, Path::new("again.toml"), &[]).unwrap(), &scene, "{}", text);
            apply(edit, &mut saved_each_time);
            let text = saved_each_time.to_toml().unwrap();
            saved_each_time = Scene::parse(&text, Path::new("again.toml"), &[]).unwrap();
            prop_assert_eq!(&saved_each_time, &scene, "{}", text);
        }
        let text = saved_each_time.to_toml().unwrap();
        for comment in ["# A scene with words of its own.", "# how it moves", "# two seconds and a half"] {
            prop_assert_eq!(text.contains(comment), !from_code, "{}", comment);
        }
    }
}
