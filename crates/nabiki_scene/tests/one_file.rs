//! Head and hair out of one file have one unit, one place and one facing, however the hair lies.

use std::path::Path;

use glam::{DAffine3, Vec3};
use nabiki::Hair;
use nabiki_io::exchange;
use nabiki_scene::template::template;
use nabiki_scene::{BuiltScene, Scene, Shown};

/// The built-in bust with hair of which so much is left about the middle of the head.
fn bust(left: f32) -> (nabiki::Head, Hair) {
    let text =
        "[hair]\nstrands = 120\nsegments = 8\nsegment_length = 2.5\n[[force]]\nthrough = 1\nvector = [0, -1, 0]\n";
    let built = Scene::parse(text, Path::new("bust.toml"), &[]).unwrap().build(Shown::All).unwrap();
    let mut strands = built.hair.strands;
    strands.points_mut().iter_mut().for_each(|p| *p *= left);
    (built.head, Hair { strands, ..Hair::default() })
}

/// Both in one archive or layer, the hair moved by `by`.
fn one_file(file: &Path, left: f32, by: Vec3) {
    let (head, mut hair) = bust(left);
    hair.strands.points_mut().iter_mut().for_each(|p| *p += by);
    let mut export = exchange::export(&hair, 24.0, None);
    export.head = Some(&head.mesh);
    let mut sink = exchange::sink(file, export, None).unwrap();
    sink.frame(&hair.strands, &DAffine3::IDENTITY).unwrap();
    sink.finish().unwrap();
}

fn built(text: &str, folder: &Path) -> BuiltScene {
    Scene::parse(text, &folder.join("scene.toml"), &[]).unwrap().build(Shown::All).unwrap()
}

#[test]
fn a_new_scene_leaves_hair_where_the_file_of_its_head_has_it() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["both.abc"] {
        let file = folder.path().join(name);
        // Deep in the head, and beside it.
        for (left, by) in [(0.8, Vec3::ZERO), (1.0, Vec3::new(0.0, 3.0, 40.0))] {
            one_file(&file, left, by);
            let new = template(&folder.path().join("scene.toml"), Some(&file), &[], Some(&file)).unwrap();
            let of_hair = &new.text[new.text.find("[hair]").unwrap()..new.text.find("[motion]").unwrap()];
            for key in ["unit", "up", "facing", "origin"] {
                let given = of_hair.lines().any(|line| line.starts_with(&format!("{key} =")));
                assert!(!given, "{name}, {left}, {by}: {of_hair}");
            }
            let built = built(&new.text, folder.path());
            assert_eq!(built.hair_placement, Some(built.placement), "{name}, {left}, {by}");
            let mended = built.advice().into_iter().flat_map(|advice| advice.settings);
            assert!(mended.into_iter().all(|setting| !setting.key.starts_with("hair.")), "{name}, {left}, {by}");
        }
    }
}

#[test]
fn hair_has_what_the_scene_says_of_its_head_s_file_and_another_place_is_said() {
    let folder = tempfile::tempdir().unwrap();
    one_file(&folder.path().join("both.usdc"), 1.0, Vec3::ZERO);
    let scene = |of_hair: &str| {
        format!(
            "[head]\nmesh = \"both.usdc\"\nunit = \"in\"\nfacing = \"+z\"\n[hair]\nfile = \"./both.usdc\"\n{of_hair}\n\
             [[force]]\nthrough = 1\nvector = [0, -1, 0]\n"
        )
    };
    // The layer says centimetres, and the scene inches.
    let whole = built(&scene(""), folder.path());
    assert_eq!(whole.hair_placement, Some(whole.placement));
    let apart = built(&scene("unit = 2.7\norigin = [1, 2, 3]"), folder.path());
    assert_ne!(apart.hair_placement, Some(apart.placement), "what is given is obeyed");
    // What is wrong with the head is said first, so as a person's head has it.
    let cm = scene("unit = 1.06\norigin = [0, 1, 0]").replace("\"in\"", "\"cm\"").replace("\"+z\"", "\"+x\"");
    let said: Vec<String> = built(&cm, folder.path()).advice().iter().map(ToString::to_string).collect();
    let line = "hair.unit and hair.origin: the hair is moved away from the head, which is from ./both.usdc, too; leave that out";
    assert!(said.iter().any(|said| said == line), "{said:?}");
}
