//! What is left when a command is told to end, or killed, while it writes.
#![cfg(unix)]

use std::fs;
use std::os::unix::process::ExitStatusExt;
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
    begun_by(&mut Command::new(env!("CARGO_BIN_EXE_nabiki")), cache)
}

fn begun_by(command: &mut Command, cache: &Path) -> Child {
    let mut child = command
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

fn send(signal: &str, child: &Child) {
    let sent = Command::new("sh").args(["-c", &format!("kill -{signal} {}", child.id())]).status().unwrap();
    assert!(sent.success());
}

/// The signals that these tests, and so what they start, were started to ignore: a bit each from signal 1 on.
fn ignored() -> u64 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.map_or(0, |mask| u64::from_str_radix(mask.trim(), 16).unwrap())
}

#[test]
fn a_command_told_to_end_removes_what_it_has_begun_and_ends_by_the_signal() {
    for (signal, number) in [("INT", 2), ("TERM", 15), ("HUP", 1)] {
        if ignored() >> (number - 1) & 1 == 1 {
            continue;
        }
        let folder = TempDir::new().unwrap();
        let mut child = begun(&folder.path().join("long.nabiki"));
        send(signal, &child);
        // Not by an exit code: a shell's loop ends only with what a signal ended.
        assert_eq!(child.wait().unwrap().signal(), Some(number), "{signal}");
        assert_eq!(names(folder.path()), Vec::<PathBuf>::new(), "{signal}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_command_under_nohup_goes_on_when_its_terminal_closes() {
    let folder = TempDir::new().unwrap();
    let mut child =
        begun_by(Command::new("nohup").arg(env!("CARGO_BIN_EXE_nabiki")), &folder.path().join("long.nabiki"));
    send("HUP", &child);
    std::thread::sleep(std::time::Duration::from_millis(300));
    assert!(child.try_wait().unwrap().is_none(), "it goes on");
    send("TERM", &child);
    assert_eq!(child.wait().unwrap().signal(), Some(15));
}

#[test]
fn a_file_that_may_not_grow_is_refused_like_a_full_disk() {
    let folder = TempDir::new().unwrap();
    let cache = folder.path().join("long.nabiki");
    // Of 512 or 1024 bytes each, as the shell has it.
    let limited = format!(
        "ulimit -f 100; exec {} simulate {GUST} --set hair.strands=900 --strands 300 --frames 40 -q -o {}",
        env!("CARGO_BIN_EXE_nabiki"),
        cache.display()
    );
    let ended = Command::new("sh").args(["-c", &limited]).output().unwrap();
    let said = String::from_utf8_lossy(&ended.stderr).into_owned();
    assert_eq!(ended.status.code(), Some(1), "{said}");
    assert!(said.starts_with("nabiki: ") && said.contains("long.nabiki") && said.lines().count() == 1, "{said}");
    assert_eq!(names(folder.path()), Vec::<PathBuf>::new());
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
