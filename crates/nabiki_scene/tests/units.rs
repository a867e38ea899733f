//! Of a head in the wrong unit no number is right: whatever is refused beside it, the size is named with the unit to give.

use std::fmt::Write;
use std::path::Path;

use nabiki_groom::bust;
use nabiki_scene::scene::SceneError;
use nabiki_scene::{Error, Scene, Shown};

/// The built-in bust as a mesh in units of so many cm, each of which is taken for a centimetre.
fn head_in(cm: f32, folder: &Path) {
    let mesh = bust().mesh;
    let mut text = String::new();
    for p in &mesh.positions {
        let [x, y, z] = (*p / cm).to_array();
        writeln!(text, "v {x} {y} {z}").unwrap();
    }
    for [a, b, c] in &mesh.triangles {
        writeln!(text, "f {} {} {}", a + 1, b + 1, c + 1).unwrap();
    }
    std::fs::write(folder.join("head.obj"), text).unwrap();
}

/// Why a scene with this head and these lines is refused.
fn refused(folder: &Path, unit: &str, lines: &str) -> String {
    let text = format!(
        "[head]\nmesh = \"head.obj\"\n{unit}up = \"+y\"\nfacing = \"+x\"\n[hair]\nstrands = 20\n{lines}\n\
         [[force]]\nthrough = 5\nvector = [-10, 0, 0]\n"
    );
    let scene = Scene::parse(&text, &folder.join("scene.toml"), &[]).unwrap();
    let built = scene.build(Shown::All).and_then(|built| built.simulation().map(drop));
    match built.unwrap_err() {
        Error::Scene(refused) => SceneError::to_string(&refused),
        other => panic!("{other}"),
    }
}

#[test]
fn what_is_refused_beside_a_head_in_another_unit_names_the_unit() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    head_in(100.0, folder);
    let swirls = "[turbulence]\nstrength = 5\nswirl_size = 4\nnear_head = 3";
    for (lines, why) in [
        (swirls, "turbulence.near_head = 3: must be at most 0.09"),
        ("[motion]\nform = \"free\"\n[free]\ngravity = 1e9", "free.gravity"),
    ] {
        let line = refused(folder, "", lines);
        assert!(line.contains(why), "{line}");
        assert_eq!(line.matches("check the size first: the head's half axes are 0.09").count(), 1, "{line}");
        assert!(line.contains("a person's head has about 9.5 x 11 x 7.8 cm: give head.unit = \"m\""), "{line}");
    }
    // With the unit the same number is right, and what is still refused is its own fault.
    let unit = "unit = \"m\"\n";
    let line = refused(folder, unit, &swirls.replace("near_head = 3", "near_head = 30"));
    assert!(line.contains("turbulence.near_head = 30: must be at most 9.") && !line.contains("size"), "{line}");
    // So is a file that is not there, in whatever unit.
    let line = refused(folder, "", "[head.motion]\nfile = \"nowhere.bvh\"\nnode = \"Head\"");
    assert!(line.contains("there is no ") && !line.contains("size"), "{line}");
}
