//! Memory, threads and descriptors that are not to be had: one line, no panic, and nothing half-written.

#![cfg(target_os = "linux")]

use std::process::{Command, Output};

use tempfile::TempDir;

const GUST: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/paper/gust.toml");

/// Runs the command under a limit of the shell's.
fn limited(folder: &TempDir, limit: &str, words: &[&str]) -> Output {
    let script = format!("ulimit {limit} && exec \"$0\" \"$@\"");
    let nabiki = env!("CARGO_BIN_EXE_nabiki");
    Command::new("bash").args(["-c", &script, nabiki]).args(words).current_dir(folder.path()).output().unwrap()
}

/// The one line of a refusal, after which the folder is empty.
fn refused(folder: &TempDir, output: Output) -> String {
    let line = String::from_utf8(output.stderr).unwrap();
    assert_eq!((output.status.code(), line.lines().count()), (Some(1), 1), "{line}");
    let left: Vec<_> = std::fs::read_dir(folder.path()).unwrap().map(|there| there.unwrap().path()).collect();
    assert!(left.is_empty(), "{left:?}");
    line
}

const GIB: u64 = 1 << 20;

#[test]
fn work_that_takes_more_memory_than_there_is_is_refused_before_it_begins() {
    let folder = TempDir::new().unwrap();
    let simulate = |sets: &[&str]| {
        let sets = sets.iter().flat_map(|set| ["--set", set]);
        let words: Vec<&str> = ["simulate", GUST, "-o", "m.nabiki", "--threads", "2"].into_iter().chain(sets).collect();
        refused(&folder, limited(&folder, &format!("-v {}", 2 * GIB), &words))
    };
    // 380 bytes for each root, however few strands are shown.
    let line = simulate(&["hair.strands=800000000", "hair.segments=1", "hair.segment_length=18"]);
    assert!(
        line.contains("hair.strands = 800000000: spreading their roots needs at least 283.1 GiB of memory"),
        "{line}"
    );
    assert!(line.contains("GiB are available: grow fewer"), "{line}");
    // Roots fit, and what grows from them does not.
    let line = simulate(&["hair.strands=500000", "hair.segments=4000", "hair.segment_length=0.0045"]);
    assert!(line.contains("hair.strands = 500000: growing 500000 of them needs "), "{line}");
    let draw =
        ["render", GUST, "--frame", "0", "--strands", "20", "--threads", "2", "--set", "picture.size=[16384,16384]"];
    let line = refused(&folder, limited(&folder, &format!("-v {}", 2 * GIB), &draw));
    assert!(
        line.contains("picture.size = [16384, 16384]: a picture of 20 strands needs at least 5.0 GiB of memory"),
        "{line}"
    );
}

#[test]
fn what_fits_is_not_refused() {
    let folder = TempDir::new().unwrap();
    let words = ["simulate", GUST, "--strands", "2000", "--frames", "2", "-o", "m.nabiki", "--threads", "2"];
    let output = limited(&folder, &format!("-v {GIB}"), &words);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn threads_that_are_not_to_be_had() {
    let folder = TempDir::new().unwrap();
    let words = ["preview", GUST, "--frames", "1"];
    let of_environment = |count: &str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_nabiki"));
        command.args(words).env("RAYON_NUM_THREADS", count).current_dir(folder.path()).output().unwrap()
    };
    for count in ["10000", "513", "18446744073709551615"] {
        let line = refused(&folder, of_environment(count));
        assert!(line.contains(&format!("RAYON_NUM_THREADS={count}: at most 512 threads")), "{line}");
    }
    // Each takes two MiB of address space for its stack.
    let many = ["preview", GUST, "--frames", "1", "--threads", "512"];
    let line = refused(&folder, limited(&folder, "-v 500000", &many));
    assert!(
        line.contains("--threads 512: the system cannot start that many (") && line.contains("--threads N"),
        "{line}"
    );
}

#[test]
fn descriptors_that_run_out() {
    let folder = TempDir::new().unwrap();
    let out = ["--set", "output.png_frames=true", "--set", "output.exr_frames=true", "--set", "picture.size=[16,16]"];
    let words = [&["run", GUST, "--strands", "5", "--frames", "2", "--threads", "2"], &out[..]].concat();
    for descriptors in 3..20 {
        let output = limited(&folder, &format!("-n {descriptors}"), &words);
        let said = String::from_utf8(output.stderr).unwrap();
        match output.status.code() {
            Some(0) => assert_eq!(said, "", "{descriptors}"),
            // The system's own loader needs some.
            Some(127) => {}
            code => assert_eq!((code, said.lines().count()), (Some(1), 1), "{descriptors}: {said}"),
        }
        assert!(!said.contains("panicked"), "{descriptors}: {said}");
        let _ = std::fs::remove_dir_all(folder.path().join("out"));
    }
}
