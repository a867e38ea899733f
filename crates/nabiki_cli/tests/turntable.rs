//! `nabiki render --turntable N`: one frame from all around.

use std::path::Path;
use std::process::{Command, Output};

const GUST: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/gust.toml");

fn render(folder: &Path, arguments: &str) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_nabiki"));
    command.current_dir(folder).args(["--quiet", "render", GUST, "--strands", "40", "--out", "out"]);
    command.args(["--set", "hair.strands=900", "--set", "picture.size=[96,64]", "--set", "output.png_frames=true"]);
    command.args(arguments.split_whitespace()).output().unwrap()
}

#[test]
fn the_first_picture_is_the_frame_itself_and_half_a_turn_is_the_other_side() {
    let folder = tempfile::tempdir().unwrap();
    let still = |arguments: &str| {
        let output = render(folder.path(), arguments);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        std::fs::read(folder.path().join("out/gust_0003.png")).unwrap()
    };
    let front = still("--frame 3");
    let behind = still("--frame 3 --set picture.camera.azimuth=240");
    assert_ne!(front, behind);
    let output = render(folder.path(), "--frame 3 --turntable 4");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let of = |n: u32| std::fs::read(folder.path().join(format!("out/gust_0003_turntable_frames/000{n}.png"))).unwrap();
    assert_eq!(of(0), front);
    assert_eq!(of(2), behind);
    assert!(folder.path().join("out/gust_0003_turntable.mp4").exists());
    assert_eq!(std::fs::read_dir(folder.path().join("out/gust_0003_turntable_frames")).unwrap().count(), 4);
}

#[test]
fn a_shorter_turn_leaves_nothing_of_a_longer_one() {
    let folder = tempfile::tempdir().unwrap();
    for (pictures, removed) in [(5, false), (3, true)] {
        let arguments = format!("--turntable {pictures} --set output.movie=false --set hair.strands=900");
        let mut words: Vec<&str> = arguments.split(' ').collect();
        words.extend(["--set", "output.png_frames=true", "--set", "picture.size=[96,64]", "--strands", "40"]);
        let mut command = Command::new(env!("CARGO_BIN_EXE_nabiki"));
        let output = command.current_dir(folder.path()).args(["render", GUST]).args(words).output().unwrap();
        let said = String::from_utf8(output.stdout).unwrap();
        assert!(output.status.success());
        assert_eq!(said.contains("removed 2 files of frames after 2"), removed, "{said}");
        let stills = std::fs::read_dir(folder.path().join("out/gust_0000_turntable_frames")).unwrap();
        assert_eq!(stills.count(), pictures);
    }
}

#[test]
fn stills_alone_may_be_larger_than_a_movie_and_have_the_scenes_bits() {
    let folder = tempfile::tempdir().unwrap();
    let bits = |file: &str| std::fs::read(folder.path().join("out").join(file)).unwrap()[24];
    let large = "--set picture.size=[3848,8] --set output.png_bits=16";
    let movie = render(folder.path(), &format!("--turntable 2 {large}"));
    let said = String::from_utf8_lossy(&movie.stderr).into_owned();
    assert!(!movie.status.success() && said.contains("set output.movie = false"), "{said}");
    let stills = render(folder.path(), &format!("--turntable 2 {large} --set output.movie=false"));
    assert!(stills.status.success(), "{}", String::from_utf8_lossy(&stills.stderr));
    assert!(!folder.path().join("out/gust_0000_turntable.mp4").exists());
    assert_eq!(bits("gust_0000_turntable_frames/0001.png"), 16);
    assert!(render(folder.path(), "--frame 0 --set output.png_bits=16").status.success());
    assert_eq!(bits("gust_0000.png"), 16);
}

#[test]
fn what_cannot_be_turned_is_one_line() {
    let folder = tempfile::tempdir().unwrap();
    for (arguments, code, words) in [
        ("--turntable 1", 2, "1 is not in 2"),
        ("--turntable 8 --frames 1..2", 1, "a turntable shows one frame"),
        ("--turntable 8 --set output.png_frames=false --set output.movie=false", 1, "a turntable is a movie or stills"),
        ("--turntable 8 --frame 999", 1, "the last frame is motion.frames = 110"),
    ] {
        let output = render(folder.path(), arguments);
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{arguments}: {said}");
        assert!(said.contains(words), "{arguments}: {said}");
        assert!(!folder.path().join("out").exists(), "{arguments}");
    }
}
