//! New scenes about files in any unit and axes, and advice where a scene has them wrong.

use std::fmt::Write;
use std::path::Path;

use glam::Vec3;
use nabiki::{Hair, Head};
use nabiki_io::motion::Axis;
use nabiki_io::placement::{Placement, Unit};
use nabiki_scene::advice::{Advice, advice};
use nabiki_scene::template::template;
use nabiki_scene::{BuiltScene, Scene, Shown};

const FORCE: &str = "[[force]]\nthrough = 1\nvector = [0, -1, 0]\n";

fn built(text: &str, path: &Path) -> BuiltScene {
    let few = [("hair.strands".to_owned(), "60".to_owned())];
    Scene::parse(text, path, &few)
        .unwrap_or_else(|e| panic!("{e}\n{text}"))
        .build(Shown::All)
        .unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn advised(stage: &BuiltScene) -> Vec<Advice> {
    advice(&stage.scene, &stage.head, &stage.placement, &stage.hair.strands, stage.hair_placement.as_ref())
}

/// The built-in head and some hair of it.
fn bust() -> BuiltScene {
    built(FORCE, Path::new("bust.toml"))
}

/// A mesh as the text of a .obj file that lies as `placement` says.
fn mesh_text(head: &Head, placement: &Placement) -> String {
    let place = placement.file_from_head();
    let mut text = String::new();
    for &p in &head.mesh.positions {
        let [x, y, z] = place.transform_point3(p).to_array();
        writeln!(text, "v {x} {y} {z}").unwrap();
    }
    for [a, b, c] in &head.mesh.triangles {
        writeln!(text, "f {} {} {}", a + 1, b + 1, c + 1).unwrap();
    }
    text
}

/// Strands as polylines of a .obj file.
fn hair_text(hair: &Hair, placement: &Placement) -> String {
    let place = placement.file_from_head();
    let (mut text, mut next) = (String::new(), 1);
    for strand in hair.strands.iter() {
        for &p in strand {
            let [x, y, z] = place.transform_point3(p).to_array();
            writeln!(text, "v {x} {y} {z}").unwrap();
        }
        let numbers: Vec<String> = (next..next + strand.len()).map(|i| i.to_string()).collect();
        writeln!(text, "l {}", numbers.join(" ")).unwrap();
        next += strand.len();
    }
    text
}

/// A person's height above the floor, in the file's unit and along its up axis.
fn standing(cm: f32, up: Axis, facing: Axis) -> Placement {
    Placement { unit: Unit { cm }, up, facing, origin: up.vector().as_vec3() * (160.0 / cm) }
}

#[test]
fn a_new_scene_finds_unit_and_axes_of_a_head_and_its_hair() {
    let folder = tempfile::tempdir().unwrap();
    let [scene, head, hair] = ["new.toml", "head.obj", "hair.obj"].map(|name| folder.path().join(name));
    let bust = bust();
    // Fitted as an imported head's is.
    let half_axes = Head::fit(&bust.head.mesh).unwrap().half_axes;
    let (y, z) = ((Axis::PlusY, Axis::PlusZ), (Axis::PlusZ, Axis::MinusY));
    for (unit, cm, (up, facing)) in [("m", 100.0, y), ("in", 2.54, z)] {
        let placement = standing(cm, up, facing);
        std::fs::write(&head, mesh_text(&bust.head, &placement)).unwrap();
        std::fs::write(&hair, hair_text(&bust.hair, &placement)).unwrap();
        let new = template(&scene, Some(&head), &[], Some(&hair)).unwrap();
        for guess in
            [format!("head.unit = \"{unit}\""), format!("head.up = \"{up}\""), format!("head.facing = \"{facing}\"")]
        {
            assert!(new.guesses.iter().any(|said| said.starts_with(&guess)), "{guess}: {:?}", new.guesses);
        }
        assert!(!new.guesses.iter().any(|said| said.starts_with("hair.")), "{:?}", new.guesses);
        let stage = built(&new.text, &scene);
        assert_eq!(advised(&stage), [], "{}", new.text);
        // The file's digits, and a fit that settles to 1e-4 of the size.
        let off = (stage.head.ellipsoid.half_axes - half_axes).abs().max_element();
        assert!(off < 1e-2, "half axes off by {off} cm in {unit}");
    }
}

#[test]
fn a_new_scene_without_files_runs() {
    let new = template(Path::new("new.toml"), None, &[], None).unwrap();
    assert_eq!((new.guesses.len(), advised(&built(&new.text, Path::new("new.toml")))), (0, vec![]));
}

#[test]
fn a_head_of_no_person_s_size_is_said_with_the_unit_that_mends_it() {
    let folder = tempfile::tempdir().unwrap();
    let (scene, head) = (folder.path().join("scene.toml"), folder.path().join("head.obj"));
    std::fs::write(&head, mesh_text(&bust().head, &standing(1.0, Axis::PlusY, Axis::PlusZ))).unwrap();
    let with = |unit: &str| {
        let text = format!(
            "[head]\nmesh = \"head.obj\"\nunit = {unit}\nfacing = \"+z\"\n[hair]\nfile = \"hair.obj\"\n{FORCE}"
        );
        advised(&built(&text, &scene))
    };
    // Hair that goes with the head is not spoken of beside it.
    std::fs::write(folder.path().join("hair.obj"), "v 0 170 0\nv 0 171 0\nl 1 2\n").unwrap();
    for wrong in ["\"m\"", "\"mm\"", "\"ft\""] {
        let [Advice { key: "head.unit", value: Some(unit), .. }] = &with(wrong)[..] else {
            panic!("{:?}", with(wrong))
        };
        assert_eq!(unit, "\"cm\"");
    }
    assert_eq!(with("\"cm\""), []);
}

#[test]
fn hair_beside_the_head_is_said_with_what_mends_it() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("scene.toml");
    let bust = bust();
    let with = |placement: &Placement, more: &str| {
        std::fs::write(folder.path().join("hair.obj"), hair_text(&bust.hair, placement)).unwrap();
        advised(&built(&format!("[hair]\nfile = \"hair.obj\"\n{more}\n{FORCE}"), &scene))
    };
    assert_eq!(with(&Placement::default(), ""), []);
    let inches = Placement { unit: Unit { cm: 2.54 }, ..Placement::default() };
    let [Advice { key: "hair.unit", value: Some(unit), .. }] = &with(&inches, "")[..] else { panic!("in inches") };
    assert_eq!(with(&inches, &format!("unit = {unit}")), [], "{unit}");
    let aside = Placement { origin: Vec3::new(0.0, 160.0, 30.0), ..Placement::default() };
    let [Advice { key: "hair.origin", value: Some(origin), .. }] = &with(&aside, "")[..] else { panic!("aside") };
    assert_eq!(with(&aside, &format!("origin = {origin}")), [], "{origin}");
}
