//! Head and hair out of one file have one unit, one place and one facing, however the hair lies.

use std::f32::consts::{PI, TAU};
use std::path::Path;

use glam::{DAffine3, Vec3};
use nabiki::{Hair, Mesh, Strands};
use nabiki_io::moving::{self, ChainOptions};
use nabiki_io::{Placement, exchange};
use nabiki_scene::template::template;
use nabiki_scene::{BuiltScene, Scene, Shown};

/// An egg as large as a head, with the nose along +x, and hair about its upper half of which so much is left about its middle.
fn egg(left: f32) -> (Mesh, Hair) {
    const RINGS: u32 = 24;
    const SIDES: u32 = 32;
    let on = |ring: u32, side: u32| {
        let (down, around) = (PI * ring as f32 / RINGS as f32, TAU * side as f32 / SIDES as f32);
        let way = Vec3::new(down.sin() * around.cos(), down.cos(), down.sin() * around.sin());
        let nose = if side == 0 && ring == RINGS * 6 / 10 { 2.0 } else { 0.0 };
        way * Vec3::new(9.5, 11.0, 7.8) + Vec3::X * nose
    };
    let mut mesh = Mesh { positions: vec![on(0, 1), on(RINGS, 1)], ..Mesh::default() };
    mesh.positions.extend((1..RINGS).flat_map(|ring| (0..SIDES).map(move |side| on(ring, side))));
    let at = |ring: u32, side: u32| match ring {
        0 => 0,
        RINGS => 1,
        ring => 2 + (ring - 1) * SIDES + side % SIDES,
    };
    for (ring, side) in (0..RINGS).flat_map(|ring| (0..SIDES).map(move |side| (ring, side))) {
        let [a, b, c, d] = [at(ring, side), at(ring, side + 1), at(ring + 1, side + 1), at(ring + 1, side)];
        mesh.triangles.extend([[a, b, c], [a, c, d]].into_iter().filter(|[x, y, z]| x != y && y != z && x != z));
    }
    let mut strands = Strands::default();
    for (ring, side) in (1..RINGS / 2).flat_map(|ring| (0..SIDES / 2).map(move |side| (ring, 2 * side))) {
        let root = on(ring, side);
        strands.push((0..9).map(|n| root * left * (1.0 + 0.02 * n as f32) + Vec3::NEG_Y * (0.02 * (n * n) as f32)));
    }
    (mesh, Hair::from(strands))
}

/// Both in one archive or layer, the hair moved by `by`.
fn one_file(file: &Path, left: f32, by: Vec3) {
    let (head, mut hair) = egg(left);
    hair.strands.points_mut().iter_mut().for_each(|p| *p += by);
    let mut export = exchange::export(&hair, 24.0, None);
    export.head = Some(&head);
    let mut sink = moving::sink(file, export, None, ChainOptions::default()).unwrap();
    sink.frame(&hair.strands, &DAffine3::IDENTITY).unwrap();
    sink.finish().unwrap();
}

fn built(text: &str, folder: &Path) -> BuiltScene {
    Scene::parse(text, &folder.join("scene.toml"), &[]).unwrap().build(Shown::All).unwrap()
}

/// How the file of the hair is placed.
fn of_hair(built: &BuiltScene) -> Placement {
    built.groom.imported.as_ref().unwrap().placement
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
            let hair = &new.text[new.text.find("[hair]").unwrap()..new.text.find("[motion]").unwrap()];
            for key in ["unit", "up", "facing", "origin"] {
                let given = hair.lines().any(|line| line.starts_with(&format!("{key} =")));
                assert!(!given, "{name}, {left}, {by}: {hair}");
            }
            let built = built(&new.text, folder.path());
            assert_eq!(of_hair(&built), built.model.placement, "{name}, {left}, {by}");
            let mended = built.advice().into_iter().flat_map(|advice| advice.fixes);
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
    assert_eq!(of_hair(&whole), whole.model.placement);
    let apart = built(&scene("unit = 2.7\norigin = [1, 2, 3]"), folder.path());
    assert_ne!(of_hair(&apart), apart.model.placement, "what is given is obeyed");
    // What is wrong with the head is said first, so as a person's head has it.
    let cm = scene("unit = 1.06\norigin = [0, 1, 0]").replace("\"in\"", "\"cm\"").replace("\"+z\"", "\"+x\"");
    let said: Vec<String> = built(&cm, folder.path()).advice().iter().map(ToString::to_string).collect();
    let line = "hair.unit and hair.origin: this moves the hair away from the head, which is also from ./both.usdc; leave it out";
    assert!(said.iter().any(|said| said == line), "{said:?}");
}
