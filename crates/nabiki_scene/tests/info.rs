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
        "motion: free form, time step 0.13, density 0.05 per cm",
        "free: stiffness 12000 to 1000, hold 30, settle 16 frames, weight 100, drag 1, 2 steps per frame",
        "contact: margin 0.1 cm",
        "neighbours: cohesion 40, pressure 40",
        "body[0]: motion/hand.obj, moved by motion/sweep.csv, margin 0.2 cm",
        "all fields: |F| at most 0",
    ] {
        assert!(said.lines().any(|said| said.starts_with(line)), "{line}: {said}");
    }
    // The paper's settings are no part of it, and the other way round.
    assert!(!said.contains("alpha") && paper.to_string().contains(", alpha -0.75"), "{said}");
    assert!(!paper.to_string().contains("stiffness"));
}

#[test]
fn regions_are_told_with_their_place_and_factors() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("scene.toml");
    let text = "[motion]\nform = \"free\"\n[[free.regions]]\nname = \"fringe\"\nnear = [5.5, 8.6, -5]\nto = [5.5, 8.6, 5]\n\
                hold = 3\nwind = 0.5\n[[free.regions]]\nnear = [1, 2, 3]\nwithin = 1\n[[free.regions]]\n\
                groups = [\"top\", \"back\"]\nattribute = \"painted\"\ndrag = 2\ngravity = 0.5\n\
                fields = [{ field = \"fan[0]\", share = 0.3 }]\n[[fan]]\nposition = [30, 0, 0]\ndirection = [-1, 0, 0]\n";
    std::fs::write(&scene, text).unwrap();
    let said = info(&scene).unwrap().to_string();
    for line in [
        "free.regions[0]: fringe, roots within 4 to 6 cm of the line from (5.5, 8.6, -5) to (5.5, 8.6, 5): hold x 3, wind x 0.5",
        "free.regions[1]: roots within 1 to 3 cm of (1, 2, 3): no change",
        "free.regions[2]: groups top and back, attribute painted: drag x 2, gravity x 0.5, fan[0] x 0.3",
    ] {
        assert!(said.lines().any(|said| said == line), "{line}: {said}");
    }
}

#[test]
fn why_a_scene_does_not_move_is_told_beside_all_that_is_known_of_it() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("scene.toml");
    let of = |groups: &str| {
        std::fs::write(&scene, format!("[motion]\nform = \"free\"\n[[free.regions]]\ngroups = [\"{groups}\"]\n"))
            .unwrap();
        info(&scene).unwrap()
    };
    assert_eq!(of("top").problem(), None);
    let wrong = of("bangs");
    assert!(wrong.problem().unwrap().contains("free.regions[0].groups = \"bangs\": no group of the hair"), "{wrong}");
    assert!(wrong.to_string().contains("free.regions[0]: groups bangs: no change"), "{wrong}");
}

#[test]
fn what_moves_the_head_is_told() {
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/head_turn.toml");
    let said = info(&scene).unwrap();
    let line = "head: builtin:bust, moved by motion/turn.csv";
    assert!(said.to_string().lines().any(|said| said == line), "{said}");
    let value = toml::Value::try_from(said).unwrap();
    assert_eq!(value["head_motion"].as_str(), Some("motion/turn.csv"));
}

#[test]
fn files_that_are_missing_are_said_to_be_and_bodies_are_not_felt_in_the_papers_form() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("scene.toml");
    let text = "[hair]\nfile = \"nope.abc\"\n[[body]]\nmesh = \"ball.obj\"\nmotion = { file = \"way.csv\" }\n[[force]]\nthrough = 9\n\
                vector = [-9, 0, 0]\n";
    std::fs::write(&scene, text).unwrap();
    std::fs::write(folder.path().join("ball.obj"), "").unwrap();
    let said = info(&scene).unwrap().to_string();
    for line in
        ["hair: nope.abc (missing)", "body[0]: ball.obj, moved by way.csv (missing), no effect in the paper's form"]
    {
        assert!(said.lines().any(|said| said == line), "{line}: {said}");
    }
}

#[test]
fn what_changes_nothing_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    std::fs::write(&path, "[contact]\nmargin = 0.3\n\n[[force]]\nthrough = 9\nvector = [-9, 0, 0]\n").unwrap();
    let said = info(&path).unwrap().to_string();
    let line = "warning: hair does not feel [contact] in the paper's form: give motion.form = \"free\"";
    assert!(said.lines().any(|said| said == line), "{said}");
}

#[test]
fn what_is_no_scene_says_what_it_is() {
    let layer = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../nabiki_io/tests/files/groom.usdc"));
    let said = nabiki_scene::Scene::load(layer, &[]).unwrap_err().to_string();
    assert!(said.contains("is a USD layer (binary), not a scene (.toml)") && said.contains("hair.file ="), "{said}");
}

#[test]
fn wind_may_be_said_to_blow_to_the_last_frame_that_there_can_be() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("for_good.toml");
    let text = format!(
        "[[force]]\nthrough = 10\nvector = [-50, 0, 0]\n[[force]]\nthrough = {}\nvector = [1, 2, 3]\n",
        u32::MAX
    );
    std::fs::write(&scene, text).unwrap();
    let said = info(&scene).unwrap().to_string();
    assert!(said.contains("force: (1, 2, 3) in frames 11 to 4294967295"), "{said}");
}
