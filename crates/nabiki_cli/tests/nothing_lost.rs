//! No command takes what it reads for a place to write, nor drops what it could keep, without a word.

use std::fs;
use std::process::{Command, Output};

use tempfile::TempDir;

const GUST: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/gust.toml");

/// Runs in `folder`; `words` are parted by spaces.
fn nabiki(folder: &TempDir, words: &str) -> Output {
    Command::new(env!("CARGO_BIN_EXE_nabiki")).args(words.split(' ')).current_dir(folder.path()).output().unwrap()
}

fn succeed(folder: &TempDir, words: &str) -> String {
    let output = nabiki(folder, words);
    assert!(output.status.success(), "{words}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

fn refuse(folder: &TempDir, words: &str) -> String {
    let output = nabiki(folder, words);
    let line = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{words}: {line}");
    assert_eq!(line.trim_end().lines().count(), 1, "{words}: {line}");
    line
}

/// A folder with the gust as `scene.toml` and 40 of its strands in `hair.hair`.
fn folder() -> TempDir {
    let folder = TempDir::new().unwrap();
    fs::copy(GUST, folder.path().join("scene.toml")).unwrap();
    succeed(&folder, "groom scene.toml --strands 40 -o hair.hair");
    folder
}

fn bytes(folder: &TempDir, name: &str) -> Vec<u8> {
    fs::read(folder.path().join(name)).unwrap()
}

const FEW: &str = "--strands 40 --frames 3 --set output.sheet=[0]";

#[test]
fn a_result_that_is_also_an_input_is_refused() {
    let folder = folder();
    let scene = bytes(&folder, "scene.toml");
    #[cfg(unix)]
    for (link, to) in [("link.nabiki", "scene.toml"), ("link.usdc", "hair.hair")] {
        std::os::unix::fs::symlink(to, folder.path().join(link)).unwrap();
    }
    let imported = "hair.file=\"hair.hair\"";
    fs::write(
        folder.path().join("own.toml"),
        format!("{}\n[[force]]\nthrough = 3\nvector = [0, -1, 0]\n", imported.replace("hair.file", "hair.file ")),
    )
    .unwrap();
    let all = [
        "groom own.toml -o hair.hair".to_owned(),
        "groom own.toml -o ./hair.hair".to_owned(),
        "convert hair.hair hair.hair".to_owned(),
        #[cfg(unix)]
        format!("simulate scene.toml -o link.nabiki {FEW}"),
        #[cfg(unix)]
        "run own.toml --export link.usdc --frames 3".to_owned(),
    ];
    let hair = bytes(&folder, "hair.hair");
    for words in all {
        let line = refuse(&folder, &words);
        assert!(line.contains("this is read to make the result"), "{words}: {line}");
        assert!(bytes(&folder, "scene.toml") == scene && bytes(&folder, "hair.hair") == hair, "{words}");
    }
}

#[test]
fn simulate_writes_what_its_name_says() {
    let folder = folder();
    let said = succeed(&folder, &format!("simulate scene.toml -o moving.usdc {FEW}"));
    assert!(said.contains("moving.usdc"), "{said}");
    assert!(bytes(&folder, "moving.usdc").starts_with(b"PXR-USDC"));
    let info = succeed(&folder, "info moving.usdc");
    assert!(info.contains("frames: 4 at 24"), "{info}");
    let line = refuse(&folder, &format!("simulate scene.toml -o moving.hair {FEW}"));
    assert!(line.contains("a motion cache ends in .nabiki"), "{line}");
}

#[test]
fn names_of_results_are_refused_before_anything_is_built() {
    let folder = folder();
    // A head that is not there would be missed while building.
    let no_head = "--set head.mesh=\"nowhere.obj\"";
    for (words, why) in [
        ("run scene.toml --export moving.fbx", "moving hair is written as"),
        ("run scene.toml --export moving.abc --export-layer /Hair", "Alembic has no layers"),
        ("groom scene.toml -o hair.fbx", "is not a hair format"),
        ("simulate scene.toml -o motion.bin", "a motion cache ends in .nabiki"),
        ("simulate scene.toml -o a.usdc --export ./a.usdc", "asked for twice"),
    ] {
        let line = refuse(&folder, &format!("{words} {no_head}"));
        assert!(line.contains(why), "{words}: {line}");
    }
}

#[test]
fn segments_beyond_what_a_strand_may_have_are_refused() {
    let folder = folder();
    for (segments, words) in [
        ("1000000000", "convert hair.hair out.hair --segments"),
        ("65536", "convert hair.hair out.usdc --unit cm --segments"),
    ] {
        let line = refuse(&folder, &format!("{words} {segments}"));
        assert!(line.contains("--segments") && line.contains("must lie in 1..65535"), "{line}");
    }
    let line = refuse(&folder, "groom scene.toml -o out.hair --set hair.segments=1000000");
    assert!(line.contains("hair.segments") && line.contains("must lie in 1..65535"), "{line}");
}

#[test]
fn a_frame_that_is_not_there_is_refused() {
    let folder = folder();
    succeed(&folder, &format!("simulate scene.toml -o m.nabiki {FEW} --export m.usdc"));
    for (words, has) in [
        ("convert hair.hair out.tfx --frame 9999", "this file holds one frame, 0"),
        ("convert m.nabiki out.tfx --frame 9999", "the frames 0 to 3"),
        ("convert m.usdc out.tfx --frame 4", "the frames 0 to 3"),
    ] {
        let line = refuse(&folder, words);
        assert!(line.contains(has), "{words}: {line}");
    }
    succeed(&folder, "convert hair.hair out.tfx --frame 0 --segments 8");
}

#[test]
fn the_pose_of_a_moving_head_is_not_dropped_without_a_word() {
    let folder = folder();
    let track = "t_s,px_m,py_m,pz_m,qx,qy,qz,qw\n0,0,1.6,0,0,0,0,1\n9,0.5,1.6,0,0,0,0,1\n";
    fs::write(folder.path().join("head.csv"), track).unwrap();
    let motion = "--set head.motion={file=\"head.csv\",up=\"+y\",facing=\"+x\"}";
    succeed(&folder, &format!("simulate scene.toml -o m.nabiki {FEW} {motion}"));
    let said = succeed(&folder, "convert m.nabiki out.hair --frame 2");
    assert!(said.contains("the head's pose"), "{said}");
    let still = succeed(&folder, &format!("simulate scene.toml -o s.nabiki {FEW}"));
    assert!(!still.contains("pose"), "{still}");
}

#[test]
fn moving_hair_goes_on_moving_in_every_format_that_can_hold_it() {
    let folder = folder();
    succeed(&folder, &format!("simulate scene.toml -o a.usdc {FEW}"));
    for words in ["convert a.usdc b.abc", "convert b.abc c.usda --unit cm", "convert c.usda d.usdc"] {
        let said = succeed(&folder, words);
        assert!(said.contains("4 frames of 40 strands") && !said.contains("motion"), "{words}: {said}");
    }
    let still = succeed(&folder, "convert a.usdc e.hair");
    assert!(still.contains("cannot hold motion: it is frame 0 of the 4"), "{still}");
    for frame in [0, 3] {
        for name in ["a.usdc", "d.usdc"] {
            succeed(&folder, &format!("convert {name} {name}.hair --frame {frame}"));
        }
        assert!(bytes(&folder, "a.usdc.hair") == bytes(&folder, "d.usdc.hair"), "frame {frame}");
    }
}

#[test]
fn frames_beyond_any_film_are_refused_at_once() {
    let folder = folder();
    for command in ["run scene.toml", "preview scene.toml", "simulate scene.toml -o m.nabiki"] {
        let line = refuse(&folder, &format!("{command} --frames 1000000000"));
        assert!(line.contains("motion.frames = 1000000000: must lie in 1..10000000"), "{command}: {line}");
    }
}

#[test]
fn a_layer_over_what_is_not_the_groom_is_refused_with_the_paths_that_are() {
    let folder = folder();
    succeed(&folder, "groom scene.toml --strands 40 -o groom.usdc");
    let scene = "[hair]\nfile = \"groom.usdc\"\njoin_within = 0.0\n[motion]\nframes = 2\n[[force]]\nthrough = 2\n\
                 vector = [0, -1, 0]\n";
    fs::write(folder.path().join("own.toml"), scene).unwrap();
    let prim = |line: &str| line[line.find("at /").unwrap() + 3..line.find(" (").unwrap()].to_owned();
    let line = refuse(&folder, "simulate own.toml -o m.nabiki --export l.usda --export-layer /nowhere");
    assert!(line.contains("--export-layer /nowhere: its curves are at /"), "{line}");
    succeed(&folder, &format!("simulate own.toml -o m.nabiki --export l.usda --export-layer {}", prim(&line)));
}

#[test]
fn any_number_of_strands_is_the_beginning_of_the_whole() {
    let folder = folder();
    let count = |name: &str| nabiki_io::hair::read(&folder.path().join(name)).unwrap().strands;
    for strands in [1, 7] {
        succeed(&folder, &format!("groom scene.toml --strands {strands} -o few.hair"));
        let (few, more) = (count("few.hair"), count("hair.hair"));
        assert_eq!(few.len(), strands);
        assert!(few.iter().eq(more.iter().take(strands)), "the first {strands}, to the bit");
    }
    let line = refuse(&folder, "groom scene.toml --strands 100000 -o few.hair");
    assert!(line.contains("the scene has 19330") && line.contains("hair.strands = 100000"), "{line}");
}

#[test]
fn a_preview_writes_the_motion_that_it_shows() {
    let folder = folder();
    let small = "--frames 3 --set output.sheet=[0] --set picture.size=[96,64]";
    succeed(&folder, &format!("preview scene.toml --strands 20 --cache p.nabiki {small}"));
    succeed(&folder, "simulate scene.toml --strands 20 --frames 3 --set output.sheet=[0] -o s.nabiki");
    assert!(bytes(&folder, "p.nabiki") == bytes(&folder, "s.nabiki"));
}

#[test]
fn the_summary_says_the_worst_frame() {
    let folder = folder();
    let said = succeed(&folder, "simulate scene.toml --strands 200 -o m.nabiki");
    assert!(said.contains("at worst") && said.contains("the deepest"), "{said}");
}

#[test]
fn what_no_disk_holds_is_refused_at_once() {
    let folder = folder();
    let line = refuse(&folder, "simulate scene.toml -o m.nabiki --frames 9000000 --set output.sheet=[0]");
    assert!(line.contains("TiB at least, and the disk has"), "{line}");
    assert!(!folder.path().join("m.nabiki").exists());
}
