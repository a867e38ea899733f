//! A scene of a real head and its hair.

use std::path::{Path, PathBuf};

use nabiki_reference_tests::shared;
use nabiki_scene::template::template;
use nabiki_scene::{Scene, Shown};

#[test]
#[cfg_attr(not(shared_data), ignore = "needs the shared reference data beside the project")]
fn sintels_hair_lands_on_her_head() {
    let text = format!(
        "head = {{ mesh = \"{}\", unit = \"m\", facing = \"+z\" }}\n\
         hair = {{ file = \"{}\", strands = 500 }}\n\
         [[force]]\nthrough = 50\nvector = [-1, 0, 0]\n",
        shared("heads/sintel_bust.obj").display(),
        shared("hair/sintel_hair_16pts.tfx").display()
    );
    let stage = Scene::parse(&text, Path::new("sintel.toml"), &[]).unwrap().build(Shown::All).unwrap();
    assert_eq!(stage.strands().len(), 500);
    let report = stage.groom.imported.as_ref().unwrap().report;
    assert_eq!((report.strands_in_file, report.degenerate.dropped_strands), (11_400, 0));
    assert!(stage.model.head.ellipsoid.center.length() < 1e-3, "the origin is the centre of the fitted ellipsoid");
    // The README: root to surface 0.36 mm in the median, 6.1 mm at worst.
    let mut off: Vec<f32> = stage.strands().iter().map(|s| stage.model.head.distance(s[0]).abs()).collect();
    off.sort_by(f32::total_cmp);
    assert!(off[250] < 0.1 && off[499] < 0.9, "median {} cm, worst {} cm", off[250], off[499]);
    // The back of the head carries more hair than the face.
    let behind = stage.strands().iter().filter(|s| s[0].x < 0.0).count();
    assert!(behind > 300, "{behind} of 500 roots behind the centre");
    let placement = stage.groom.imported.as_ref().unwrap().placement;
    assert_eq!(placement, stage.model.placement, "the hair's file lies as the head's");
}

/// A new scene about a shared head and hair, and its guesses.
fn new_scene(head: Option<&str>, hair: Option<&str>) -> (Scene, Vec<String>) {
    let file = |name: &str| -> PathBuf { shared(name) };
    let (head, hair) = (head.map(file), hair.map(file));
    let new = template(Path::new("new.toml"), head.as_deref(), &[], hair.as_deref()).unwrap();
    (Scene::parse(&new.text, Path::new("new.toml"), &[]).unwrap(), new.guesses)
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs the shared reference data beside the project")]
fn a_new_scene_takes_what_is_stated_and_guesses_the_rest() {
    for (head, cm, guessed) in [
        ("heads/sintel_bust.obj", 100.0, Some("head.unit = \"m\", by the size of the head")),
        ("heads/sintel_collider.obj", 100.0, Some("head.unit = \"m\", by the size of the head")),
        ("heads/makehuman_base.obj", 10.0, Some("head.unit = \"dm\", by the size of the head")),
        // A head is about 4.5 of its units tall, which is no unit.
        ("heads/lps_head.obj", 5.0, Some("head.unit = 5 (cm): no named unit")),
        // No skulls of persons: a character of 0.91 m.
        ("hair/ratboy_body.tfxmesh", 100.0, Some("head.unit = \"m\", by how tall the mesh is")),
        ("heads/sintel_eyes.obj", 1.0, Some("head.unit = \"cm\": no unit gives it the height")),
        // glTF is in metres.
        ("heads/suzanne.glb", 100.0, None),
        ("motion/fox.glb", 100.0, None),
        ("motion/kaykit_rogue.glb", 100.0, None),
    ] {
        let (scene, guesses) = new_scene(Some(head), None);
        let said = guesses.iter().find(|guess| guess.starts_with("head.unit"));
        match guessed {
            Some(guess) => assert!(said.is_some_and(|said| said.starts_with(guess)), "{head}: {guesses:?}"),
            None => assert_eq!(said, None, "{head}"),
        }
        let built = scene.build(Shown::AtMost(20)).unwrap();
        assert_eq!(built.model.placement.unit.cm, cm, "{head}");
        assert_eq!(built.model.placement.up, nabiki_io::Axis::PlusY, "{head}");
        // None of them is open where hair grows.
        assert!(built.model.head.openings.iter().all(|opening| opening.missing.is_none()), "{head}");
    }
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs the shared reference data beside the project")]
fn a_new_scene_is_advised_no_further_and_hair_of_another_head_is_said() {
    let hairs = ["hair/sintel_hair_16pts.tfx", "hair/ratboy_mohawk.tfx", "hair/curly_swatch_frame00.obj"];
    for head in [None, Some("heads/sintel_bust.obj"), Some("heads/lps_head.obj")] {
        for hair in hairs {
            let (scene, guesses) = new_scene(head, Some(hair));
            let advice = scene.clone().build(Shown::All).unwrap().advice();
            let few = scene.build(Shown::AtMost(30)).unwrap().advice();
            assert_eq!(few, advice, "{head:?} {hair}: depends on what is shown");
            assert!(advice.iter().all(|advice| advice.fixes.is_empty()), "{head:?} {hair}: {guesses:?} {advice:?}");
            let own = head == Some("heads/sintel_bust.obj") && hair == hairs[0];
            assert!(!own || advice.is_empty(), "Sintel's own hair: {advice:?}");
            if head.is_none() && hair == hairs[0] {
                let [said] = &advice[..] else { panic!("{advice:?}") };
                assert!(said.seen.contains("inside the head at rest") && said.seen.contains("another head"), "{said}");
            }
        }
    }
}
