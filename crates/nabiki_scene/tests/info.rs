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
fn what_is_no_scene_says_what_it_is() {
    let layer = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../nabiki_io/tests/files/groom.usdc"));
    let said = nabiki_scene::Scene::load(layer, &[]).unwrap_err().to_string();
    assert!(said.contains("is a USD layer (binary), not a scene (.toml)") && said.contains("hair.file ="), "{said}");
}
