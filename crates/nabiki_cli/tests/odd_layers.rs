//! Layers that are not as most are: what is done with them is said, and what is refused has a way out.

mod common;

use std::fs;

use tempfile::TempDir;

use common::{refuse, succeed};

/// A folder with `text` as `groom.usda` and a scene about it.
fn folder(text: &str) -> TempDir {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("groom.usda"), format!("#usda 1.0\n{text}")).unwrap();
    let scene = "[hair]\nfile = \"groom.usda\"\njoin_within = 0\n[motion]\nframes = 2\n[[force]]\nthrough = 2\nvector = [0, -1, 0]\n";
    fs::write(folder.path().join("scene.toml"), scene).unwrap();
    folder
}

fn curves(more: &str) -> String {
    format!("def BasisCurves \"h\" {{ uniform token type = \"linear\"\n {more} }}\n")
}

#[test]
fn hair_whose_strands_come_and_go_is_refused_with_the_frame_in_which_they_do() {
    let hair = curves(
        "int[] curveVertexCounts.timeSamples = { 1: [2, 2], 2: [2] }\n point3f[] points.timeSamples = {\n\
         1: [(9, 1, 0), (12, 1, 0), (9, 2, 0), (12, 2, 0)], 2: [(9, 1, 0), (12, 1, 0)] }",
    );
    let folder = folder(&hair);
    let line = refuse(&folder, "convert groom.usda out.usdc");
    let said = "nabiki: groom.usda: frame 1 has 2 points of 1 strands, frame 0 4 points of 2 strands: the number of strands must not change:";
    assert!(line.starts_with(said) && line.contains("--frame N"), "{line}");
    succeed(&folder, "convert groom.usda out.usdc --frame 1");
}

#[test]
fn a_layer_does_not_lie_over_curves_of_which_some_are_no_strands() {
    let hair = curves("int[] curveVertexCounts = [1, 2]\n point3f[] points = [(9, 3, 0), (9, 1, 0), (12, 1, 0)]");
    let folder = folder(&hair);
    let said = succeed(&folder, "simulate scene.toml -o m.nabiki");
    assert!(said.contains("  ignored in groom.usda: 1 curves with fewer than two points\n"), "{said}");
    for words in ["convert m.nabiki l.usda", "simulate scene.toml -o n.nabiki --export l.usda"] {
        let line = refuse(&folder, &format!("{words} --export-layer /h"));
        assert!(line.contains("l.usda: a layer would not fit the groom: 2 of its 3 points are used"), "{line}");
    }
    // Those without points take no place in a layer.
    let none = curves("int[] curveVertexCounts = [0, 2]\n point3f[] points = [(9, 1, 0), (12, 1, 0)]");
    fs::write(folder.path().join("groom.usda"), format!("#usda 1.0\n{none}")).unwrap();
    succeed(&folder, "simulate scene.toml -o n.nabiki --export l.usda --export-layer /h");
}

#[test]
fn a_shot_that_only_refers_to_others_says_so() {
    for (text, what) in [
        ("def \"a\" ( references = @r.usda@ ) { }\n", "references of /a"),
        ("def \"a\" ( payload = @r.usda@ ) { }\n", "payload of /a"),
        ("( subLayers = [ @s.usda@ ] )\ndef Xform \"a\" { }\n", "subLayers of the layer"),
    ] {
        let folder = folder(text);
        let said = succeed(&folder, "info groom.usda");
        let line = format!("not read: what comes by {what}: flatten it first (usdcat --flatten IN -o OUT)");
        assert_eq!(said.matches(&line).count(), 1, "{said}");
        let said = succeed(&folder, "info groom.usda --json");
        assert!(said.contains("\"unread\"") && said.contains(what), "{said}");
    }
}

#[test]
fn hair_that_begins_between_frames_says_where_it_goes() {
    let hair = curves(
        "int[] curveVertexCounts = [2]\n point3f[] points.timeSamples = {\n\
         1001.5: [(9, 1, 0), (12, 1, 0)], 1002.5: [(9, 1, 0), (12, 2, 0)], 1003.5: [(9, 1, 0), (12, 3, 0)] }",
    );
    let folder = folder(&hair);
    let said = succeed(&folder, "convert groom.usda out.usda");
    let line = "  ignored in groom.usda: the time of its samples between frames: 1001.500 is written as frame 1002\n";
    assert!(said.contains(line), "{said}");
}

#[test]
fn files_of_other_programs_are_refused_with_what_these_write() {
    let folder = folder("");
    for (name, way_out) in [
        ("a.usdz", "it is a package: give the layer inside"),
        ("a.bgeo", "Houdini reads and writes USD and Alembic"),
        ("a.bgeo.sc", "Houdini reads and writes USD and Alembic"),
        ("a.mb", "Maya reads and writes Alembic and USD"),
    ] {
        fs::write(folder.path().join(name), "?").unwrap();
        for words in ["new n.toml --hair", "new n.toml --head", "info"] {
            let line = refuse(&folder, &format!("{words} {name}"));
            assert!(line.contains(".usd, .usda, .usdc or .abc") || words == "info", "{line}");
            assert!(line.trim_end().ends_with(way_out), "{words} {name}: {line}");
        }
    }
}

/// One frame of a shot is on its time line where the shot has it, whatever it is written as.
#[test]
fn one_frame_keeps_its_number() {
    let samples = |n: i32| format!("{n}: [(9, 1, 0), (12, {}, 0)]", n - 1000);
    let points: Vec<String> = (1001..=1005).map(samples).collect();
    let widths =
        "float[] widths.timeSamples = { 1001: [1, 1], 1003: [3, 3], 1004: [4, 4] } ( interpolation = \"vertex\" )";
    let hair = curves(&format!(
        "int[] curveVertexCounts = [2]\n {widths}\n point3f[] points.timeSamples = {{ {} }}",
        points.join(", ")
    ));
    let folder = folder(&format!("( timeCodesPerSecond = 30 )\n{hair}"));
    let number = |name: &str| {
        let text = fs::read_to_string(folder.path().join(name)).unwrap();
        let one = |key: &str| text.lines().find_map(|line| line.trim().strip_prefix(key)?.trim().parse::<f64>().ok());
        let [start, end, rate] = ["startTimeCode =", "endTimeCode =", "timeCodesPerSecond ="].map(one);
        assert_eq!(start, end, "{name}");
        (start.unwrap(), rate.unwrap(), text)
    };
    let said = succeed(&folder, "convert groom.usda pose.usda --frame 2");
    assert!(said.contains("motion of widths: its value in frame 2 is kept"), "{said}");
    let (start, rate, text) = number("pose.usda");
    assert_eq!((start, rate), (1003.0, 30.0));
    assert!(text.contains("1003: [(9, 1, 0), (12, 3, 0)]") && text.contains("widths = [3, 3]"), "{text}");
    // By way of binary layers and archives, which have nothing else to say it by.
    succeed(&folder, "convert groom.usda pose.usdc --frame 2");
    succeed(&folder, "convert pose.usdc binary.usda");
    assert_eq!(number("binary.usda").0, 1003.0);
    succeed(&folder, "convert groom.usda pose.abc --frame 2");
    succeed(&folder, "convert pose.abc archive.usda --unit cm");
    let (start, rate, _) = number("archive.usda");
    assert_eq!((start, rate), (1003.0, 30.0));
    // Another number, and none where nothing has any.
    succeed(&folder, "convert groom.usda other.usda --frame 2 --first-frame -7");
    assert_eq!(number("other.usda").0, -7.0);
    succeed(&folder, "convert groom.usda pose.hair --frame 2");
    succeed(&folder, "convert pose.hair plain.usda --unit cm");
    assert_eq!(number("plain.usda").0, 0.0);
    let line = refuse(&folder, "convert groom.usda x.hair --frame 2 --first-frame 5");
    assert!(line.contains("x.hair: --first-frame 5: this file has no time line"), "{line}");
}
