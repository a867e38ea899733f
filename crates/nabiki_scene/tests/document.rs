//! The scene as a document: what is written is what is read, and what is not changed stays as it stands.

mod common;

use std::path::{Path, PathBuf};

use glam::Vec3;
use nabiki::disturbance::Disturbance;
use nabiki::field::Keyframe;
use nabiki_io::Unit;
use nabiki_io::motion::{Axis, MotionSource};
use nabiki_render::settings::{CameraKey, HairColour};
use nabiki_scene::Scene;
use nabiki_scene::scene::{ForceSettings, GrownHair, HairSource, HeadSource, ImportedHair, ImportedHead, Problem};

use common::{changed_lines, lines, reread};

fn shipped() -> Vec<PathBuf> {
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes"));
    let folders = [folder.to_owned(), folder.join("paper")];
    let entries =
        folders.iter().flat_map(|folder| std::fs::read_dir(folder).unwrap()).map(|entry| entry.unwrap().path());
    let scenes: Vec<PathBuf> = entries.filter(|path| path.extension().is_some_and(|e| e == "toml")).collect();
    assert!(!scenes.is_empty());
    scenes
}

fn keyframe(through: u32, vector: [f32; 3]) -> ForceSettings {
    Keyframe { through, vector: Vec3::from(vector) }.into()
}

fn keyframes(scene: &mut Scene) -> &mut Vec<ForceSettings> {
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

/// What is painted is many numbers, with a line for each point.
#[test]
fn painted_points_get_a_line_each() {
    let text = "[motion]\nform = \"free\"\n[[force]]\nthrough = 9\nvector = [1, 0, 0]\n";
    let mut scene = Scene::parse(text, Path::new("s.toml"), &[]).unwrap();
    let painted = (0..6).map(|i| [8.125, 0.3 * i as f32, -4.062, 0.1 * i as f32]).collect();
    scene.free.regions = vec![nabiki::region::Region { painted, ..Default::default() }];
    let text = scene.to_toml().unwrap();
    assert!(text.contains("painted = [\n    [8.125, 0.0, -4.062, 0.0],\n    [8.125, 0.3, -4.062, 0.1],\n"), "{text}");
    let mut again = Scene::parse(&text, Path::new("s.toml"), &[]).unwrap();
    assert_eq!(again, reread(&again));
    again.free.regions[0].painted[1][3] = 0.25;
    let (old, new) = changed_lines(&text, &again.to_toml().unwrap());
    assert_eq!((old, new), (lines(&["    [8.125, 0.3, -4.062, 0.1],"]), lines(&["    [8.125, 0.3, -4.062, 0.25],"])));
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
            mesh: "head.obj".into(),
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
    assert!(refused(&long, &path).contains("bytes: a scene may have at most 1048576"));
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
