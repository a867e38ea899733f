//! What of a scene is kept when it changes.

use std::path::Path;
use std::sync::Arc;

use super::{BuiltScene, Shown};
use crate::scene::Scene;

const TEXT: &str = "[head]\nmotion = { file = \"nod.csv\", up = \"+y\", facing = \"+x\" }\n[hair]\nstrands = 30\n[motion]\nform = \"free\"\nframes = 3\n\
                    [[force]]\nthrough = 3\nvector = [-50, 0, 0]\n\
                    [[body]]\nmesh = \"box.obj\"\nunit = \"cm\"\nup = \"+y\"\nfacing = \"+x\"\norigin = [30, 0, 0]\n";

fn write_files(folder: &Path) {
    let write = |name: &str, text: &str| std::fs::write(folder.join(name), text).unwrap();
    let rows: Vec<String> = (0..6).map(|n| format!("{},0,{},0,0,0,0,1\n", n as f32 / 24.0, n + 5)).collect();
    write("nod.csv", &format!("t_s,px_cm,py_cm,pz_cm,qx,qy,qz,qw\n{}", rows.concat()));
    write("box.obj", "v 0 0 0\nv 3 0 0\nv 0 3 0\nv 0 0 3\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    let points: Vec<String> = (0..5).map(|x| format!("v {x} 11 0\nv {x} 12 0\nv {x} 13 0\n")).collect();
    let lines: Vec<String> = (0..5).map(|s| format!("l {} {} {}\n", 3 * s + 1, 3 * s + 2, 3 * s + 3)).collect();
    write("lock.obj", &(points.concat() + &lines.concat()));
}

/// The stages that two scenes do not share.
fn made_anew(before: &BuiltScene, after: &BuiltScene) -> Vec<&'static str> {
    let roots = |built: &BuiltScene| built.groom.roots().map(Arc::as_ptr);
    let stages = [
        ("model", Arc::ptr_eq(&before.model, &after.model)),
        ("way", Arc::ptr_eq(&before.way, &after.way)),
        ("roots", roots(before) == roots(after)),
        ("groom", Arc::ptr_eq(&before.groom, &after.groom)),
        ("forces", Arc::ptr_eq(&before.forces, &after.forces)),
        ("bodies", before.bodies.iter().map(Arc::as_ptr).eq(after.bodies.iter().map(Arc::as_ptr))),
    ];
    stages.into_iter().filter(|(_, kept)| !kept).map(|(name, _)| name).collect()
}

fn with(scene: &Scene, key: &str, value: &str) -> Scene {
    let value = format!("x = {value}").parse::<toml::Table>().unwrap().remove("x");
    scene.with_setting(key, value).unwrap()
}

#[test]
fn a_stage_whose_inputs_are_the_same_is_the_very_same() {
    let folder = tempfile::tempdir().unwrap();
    write_files(folder.path());
    let scene = Scene::parse(TEXT, &folder.path().join("a.toml"), &[]).unwrap();
    let built = scene.clone().build(Shown::All).unwrap();
    let given = "{ center = [-1.0, 0.0, 0.0], half_axes = [10.0, 11.0, 8.0] }";
    let cases: [(&str, &str, &[&str]); 23] = [
        ("force[0].vector", "[50.0, 20.0, 5.0]", &["forces"]),
        ("turbulence", "{}", &["forces"]),
        ("motion.force_space", "\"head\"", &["forces"]),
        ("motion.frames", "2", &["forces"]),
        ("free.stiffness", "[200.0]", &[]),
        ("free.gravity", "\"earth\"", &[]),
        ("contact.margin", "0.5", &[]),
        ("pseudo_force.alpha", "0.5", &[]),
        ("head.shell", "1.5", &[]),
        ("picture.size", "[64, 48]", &[]),
        ("picture.hair.colour", "\"red\"", &["groom"]),
        ("hair.style.length.top", "16.0", &["groom"]),
        ("hair.segment_length", "2.0", &["groom"]),
        ("motion.straighten", "5.0", &["groom"]),
        ("neighbours", "{ carriers = 300 }", &["groom"]),
        ("hair.seed", "2", &["roots", "groom"]),
        ("hair.strands", "31", &["roots", "groom"]),
        ("head.ellipsoid", given, &["model", "roots", "groom", "forces"]),
        ("head.motion.start_at_origin", "true", &["way", "forces"]),
        ("motion.frame_rate", "30.0", &["way", "forces", "bodies"]),
        ("body[0].solid", "false", &[]),
        ("body[0].margin", "0.5", &[]),
        ("body[0].origin", "[31, 0, 0]", &["bodies"]),
    ];
    for (key, value, wanted) in cases {
        let changed = built.changed_to(with(&scene, key, value), Shown::All).unwrap();
        assert_eq!(made_anew(&built, &changed), wanted, "{key}");
    }
    let changed = |shown: Shown| built.changed_to(scene.clone(), shown).unwrap();
    assert!(made_anew(&built, &changed(Shown::AtMost(1000))).is_empty());
    assert_eq!(made_anew(&built, &changed(Shown::First(20))), ["groom"], "the free form asks of more roots");
    let elsewhere = Scene::parse(TEXT, &folder.path().join("b.toml"), &[]).unwrap();
    let of_files = ["model", "way", "roots", "groom", "bodies"];
    assert_eq!(made_anew(&built, &built.changed_to(elsewhere, Shown::All).unwrap()), of_files);
}

#[test]
fn no_file_is_read_again_whose_stage_is_kept() {
    let folder = tempfile::tempdir().unwrap();
    write_files(folder.path());
    let text = TEXT.replace("strands = 30", "file = \"lock.obj\"\nunit = \"cm\"\nup = \"+y\"\nfacing = \"+x\"");
    let scene = Scene::parse(&text, &folder.path().join("a.toml"), &[]).unwrap();
    let built = scene.clone().build(Shown::All).unwrap();
    for file in ["nod.csv", "box.obj", "lock.obj"] {
        std::fs::remove_file(folder.path().join(file)).unwrap();
    }
    for (key, value) in [("force[0].vector", "[1, 2, 3]"), ("hair.segment_length", "2.0"), ("body[0].solid", "false")] {
        assert!(built.changed_to(with(&scene, key, value), Shown::AtMost(9)).is_ok(), "{key}");
    }
    for (key, value) in [("hair.strands", "4"), ("motion.frame_rate", "30.0"), ("body[0].origin", "[31, 0, 0]")] {
        assert!(built.changed_to(with(&scene, key, value), Shown::All).is_err(), "{key}");
    }
    assert!(built.changed_to(scene, Shown::First(4)).is_err(), "others of a file's strands are read from it");
}
