//! `nabiki new`, as a user calls it.

use std::path::Path;
use std::process::{Command, Output};

fn nabiki(folder: &Path, args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_nabiki")).current_dir(folder).args(args).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

#[test]
fn a_new_scene_is_written_once_and_runs() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.toml");
    let first = nabiki(folder.path(), &["new", "mine.toml"]);
    assert!(first.status.success(), "{}", text(&first.stderr));
    assert_eq!(text(&first.stdout), "  wrote   mine.toml\n");
    let again = nabiki(folder.path(), &["new", "mine.toml"]);
    assert_eq!(again.status.code(), Some(1));
    assert_eq!(
        text(&again.stderr),
        "nabiki: mine.toml: is there already; choose another name, or replace it with --force\n"
    );
    std::fs::write(&path, "mine").unwrap();
    assert!(nabiki(folder.path(), &["new", "mine.toml", "--force"]).status.success());
    let scene = std::fs::read_to_string(&path).unwrap();
    assert!(scene.contains("[[force]]"), "{scene}");
    let run = nabiki(folder.path(), &["simulate", "mine.toml", "--strands", "40", "--frames", "2", "-o", "m.nabiki"]);
    assert!(run.status.success(), "{}", text(&run.stderr));
}

#[test]
fn a_scene_that_no_command_could_read_back_is_not_written() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["mine.txt", "mine"] {
        let refused = nabiki(folder.path(), &["new", name]);
        assert_eq!(refused.status.code(), Some(1));
        let line = format!("nabiki: {name}: a scene ends in .toml; choose another name\n");
        assert_eq!(text(&refused.stderr), line);
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn a_file_that_is_no_head_leaves_no_scene() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("head.obj"), "v 0 0 0\n").unwrap();
    for args in [&["new", "a.toml", "--head", "head.obj"][..], &["new", "a.toml", "--hair", "none.tfx"]] {
        let refused = nabiki(folder.path(), args);
        assert_eq!(refused.status.code(), Some(1));
        let line = text(&refused.stderr);
        assert!(line.lines().count() == 1 && line.contains(args[3]), "{line}");
        assert!(!folder.path().join("a.toml").exists());
    }
}

#[test]
fn a_new_scene_of_hair_with_short_segments_is_stepped_as_it_is() {
    let folder = tempfile::tempdir().unwrap();
    // 14 cm on the crown of the built-in head, in 50 segments.
    let points: Vec<String> = (0..=50).map(|i| format!("v 0 {} 0\n", 10.8 + 0.28 * f64::from(i))).collect();
    let line: Vec<String> = (1..=51).map(|i| i.to_string()).collect();
    std::fs::write(folder.path().join("hair.obj"), format!("{}l {}\n", points.concat(), line.join(" "))).unwrap();
    let new = nabiki(folder.path(), &["new", "mine.toml", "--hair", "hair.obj"]);
    assert!(new.status.success(), "{}", text(&new.stderr));
    assert!(!text(&new.stdout).contains("free.stiffness"), "{}", text(&new.stdout));
    let run = nabiki(folder.path(), &["simulate", "mine.toml", "--frames", "30", "-o", "m.nabiki"]);
    assert!(run.status.success() && !text(&run.stdout).contains("hops"), "{}{}", text(&run.stdout), text(&run.stderr));
}

#[test]
fn a_unit_that_a_file_names_wrongly_is_seen_to_be_wrong() {
    let folder = tempfile::tempdir().unwrap();
    let gust = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/gust.toml");
    assert!(nabiki(folder.path(), &["groom", gust, "--strands", "120", "-o", "cm.usda"]).status.success());
    let groom = std::fs::read_to_string(folder.path().join("cm.usda")).unwrap();
    let metres = groom.replace("metersPerUnit = 0.01", "metersPerUnit = 1");
    assert_ne!(groom, metres);
    std::fs::write(folder.path().join("m.usda"), metres).unwrap();
    let new = nabiki(folder.path(), &["new", "mine.toml", "--hair", "m.usda"]);
    assert!(new.status.success() && text(&new.stdout).contains("guessed hair.unit ="), "{}", text(&new.stdout));
    let words = ["simulate", "mine.toml", "--frames", "1", "-o", "m.nabiki"];
    let said = text(&nabiki(folder.path(), &words).stdout);
    assert!(said.contains("inside  0.") && !said.contains("made for another head"), "{said}");
}

#[test]
fn a_new_scene_is_as_long_as_the_shot_of_its_hair_and_draws_it_as_thick() {
    let folder = tempfile::tempdir().unwrap();
    let points = "[(0, 11, 0), (0, 12, 0), (0, 13, 0)]";
    let samples: Vec<String> = (1..=7).map(|frame| format!("{frame}: {points}")).collect();
    let layer = |points: &str| {
        format!(
            "#usda 1.0\n( metersPerUnit = 0.01\n upAxis = \"Y\"\n timeCodesPerSecond = 30 )\n\
             def BasisCurves \"hair\" {{ uniform token type = \"linear\"\n int[] curveVertexCounts = [3]\n{points}\n\
             float[] widths = [0.08, 0.05, 0.02] ( interpolation = \"vertex\" ) }}\n"
        )
    };
    let moving = layer(&format!("point3f[] points.timeSamples = {{ {} }}", samples.join(", ")));
    let still = layer(&format!("point3f[] points = {points}"));
    for (hair, frames) in [(moving, 6), (still, 100)] {
        std::fs::write(folder.path().join("hair.usda"), hair).unwrap();
        let new = nabiki(folder.path(), &["new", "mine.toml", "--hair", "hair.usda", "--force"]);
        assert!(new.status.success(), "{}", text(&new.stderr));
        let look = "hair = { width = 0.08, tip = 0.25, taper = 1.0 }";
        assert!(text(&new.stdout).contains(&format!("guessed picture.{look}")), "{}", text(&new.stdout));
        let scene = std::fs::read_to_string(folder.path().join("mine.toml")).unwrap();
        assert!(scene.contains(&format!("frames = {frames}\nframe_rate = 30\n")), "{scene}");
        assert!(scene.contains(look), "{scene}");
        let run = nabiki(folder.path(), &["simulate", "mine.toml", "-o", "m.nabiki", "--frames", "2"]);
        assert!(run.status.success(), "{}", text(&run.stderr));
    }
}

#[test]
fn a_head_that_moves_in_its_file_moves_in_the_new_scene_for_as_long() {
    let folder = tempfile::tempdir().unwrap();
    let bust = nabiki(folder.path(), &["new", "bust.toml"]);
    assert!(bust.status.success(), "{}", text(&bust.stderr));
    // The head of an exported stage, below a node that moves.
    let out = ["simulate", "bust.toml", "--strands", "30", "--frames", "1", "-o", "hair.usda", "--export-head"];
    assert!(nabiki(folder.path(), &out).status.success());
    let stage = std::fs::read_to_string(folder.path().join("hair.usda")).unwrap();
    let (header, prims) = stage.split_once("\ndef ").unwrap();
    let moves = "double3 xformOp:translate.timeSamples = { 0: (0, 0, 0), 30: (9, 0, 0) }\n\
                 uniform token[] xformOpOrder = [\"xformOp:translate\"]";
    let header = header.replace("defaultPrim", "doc").replace("PerSecond = 24", "PerSecond = 30");
    let moving = format!("{header}\ndef Xform \"body\" {{\n{moves}\ndef {prims}\n}}\n");
    std::fs::write(folder.path().join("moving.usda"), moving).unwrap();
    let new = nabiki(folder.path(), &["new", "mine.toml", "--head", "moving.usda"]);
    assert!(new.status.success(), "{}", text(&new.stderr));
    let said = text(&new.stdout);
    assert!(said.contains("guessed head.motion, /body, which moves the head in moving.usda"), "{said}");
    let scene = std::fs::read_to_string(folder.path().join("mine.toml")).unwrap();
    assert!(scene.contains("\nframes = 30\nframe_rate = 30\n"), "{scene}");
    let run = nabiki(folder.path(), &["simulate", "mine.toml", "--strands", "30", "-o", "m.nabiki"]);
    let said = text(&run.stdout);
    assert!(run.status.success() && said.contains("object /body, 31 samples"), "{said}");
    assert!(!said.contains("moves it there a second time"), "{said}");
}
