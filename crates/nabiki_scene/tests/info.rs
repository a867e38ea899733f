//! What is said of a scene, for a program to read.

use std::path::Path;

use nabiki_scene::info::info;

#[test]
fn a_scene_has_its_kind_beside_its_fields() {
    let scene = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/paper/gust.toml"));
    let said = toml::Value::try_from(info(scene).unwrap()).unwrap();
    assert_eq!(said["kind"].as_str(), Some("scene"));
    assert_eq!((said["frames"].as_integer(), said["head"].as_str()), (Some(100), Some("builtin:bust")));
    let hair = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../nabiki_io/tests/files/groom.hair"));
    assert_eq!(toml::Value::try_from(info(hair).unwrap()).unwrap()["kind"].as_str(), Some("hair"));
}

#[test]
fn a_scene_of_the_free_form_tells_what_moves_its_hair() {
    let of = |name: &str| info(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes").join(name)).unwrap();
    let (free, paper) = (of("hand.toml"), of("paper/gust.toml"));
    let said = free.to_string();
    for line in [
        "motion: free form, time step ",
        "free: stiffness 12000 to 1000, hold 30, settles in 16 frames, gravity 100",
        "contact: 0.1 cm from the skin",
        "neighbours: cohesion 40, pressure 40",
        "body[0]: motion/hand.obj, moved by motion/sweep.csv, 0.1 cm from its skin",
        "all fields: |F| at most 0",
    ] {
        assert!(said.lines().any(|said| said.starts_with(line)), "{line}: {said}");
    }
    // The paper's settings are no part of it, and the other way round.
    assert!(!said.contains("alpha") && paper.to_string().contains(", alpha -0.75"), "{said}");
    assert!(!paper.to_string().contains("stiffness"));
}

#[test]
fn what_is_no_scene_says_what_it_is() {
    let layer = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../nabiki_io/tests/files/groom.usdc"));
    let said = nabiki_scene::Scene::load(layer, &[]).unwrap_err().to_string();
    assert!(said.contains("is a USD layer (binary), not a scene (.toml)") && said.contains("hair.file ="), "{said}");
}
