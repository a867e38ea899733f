//! What is left when a command is told to end, or killed, while it writes.
#![cfg(unix)]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

use tempfile::TempDir;

const GUST: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/gust.toml");

fn names(folder: &Path) -> Vec<PathBuf> {
    fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect()
}

/// A simulation into `cache` that goes on until it is stopped, and has begun to write. Carriers make it slow and not large, since
/// what a disk cannot hold is refused.
fn begun(cache: &Path) -> Child {
    let mut child = Command::new(env!("CARGO_BIN_EXE_nabiki"))
        .args(["simulate", GUST, "--strands", "2", "--frames", "20000", "--set", "neighbours.carriers=4096", "-o"])
        .arg(cache)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    while names(cache.parent().unwrap()).is_empty() {
        assert!(child.try_wait().unwrap().is_none(), "it runs until it is stopped");
        std::thread::yield_now();
    }
    child
}

#[test]
fn a_command_told_to_end_removes_what_it_has_begun() {
    for signal in ["INT", "TERM", "HUP"] {
        let folder = TempDir::new().unwrap();
        let mut child = begun(&folder.path().join("long.nabiki"));
        let sent = Command::new("sh").args(["-c", &format!("kill -{signal} {}", child.id())]).status().unwrap();
        assert!(sent.success());
        assert_eq!(child.wait().unwrap().code(), Some(130), "{signal}");
        assert_eq!(names(folder.path()), Vec::<PathBuf>::new(), "{signal}");
    }
}

#[test]
fn what_a_killed_command_left_goes_with_the_next_to_the_same_place() {
    let folder = TempDir::new().unwrap();
    let cache = folder.path().join("long.nabiki");
    let mut killed = begun(&cache);
    killed.kill().unwrap();
    killed.wait().unwrap();
    assert!(!cache.exists(), "nothing has its final name");
    assert_eq!(names(folder.path()).len(), 1, "a part file is left");
    let next = Command::new(env!("CARGO_BIN_EXE_nabiki"))
        .args(["simulate", GUST, "--strands", "50", "--frames", "2", "--set", "output.sheet=[0]", "-q", "-o"])
        .arg(&cache)
        .status()
        .unwrap();
    assert!(next.success());
    assert_eq!(names(folder.path()), [cache]);
}
