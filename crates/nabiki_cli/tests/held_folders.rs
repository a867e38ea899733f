//! Frames of two commands at once: who may write beside whom into a folder, and what is left there in the end.

mod common;

use std::fs;
use std::path::Path;
use std::process::Command;

use nabiki_file::{HeldFolder, Hold};

use common::succeed;

const GUST: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/paper/gust.toml");
const STILLS: &str = "--strands 20 --set motion.frames=2 --set output.sheet=[0] --set picture.size=[48,32] \
                      --set output.png_frames=true --set output.movie=false";

/// A refusal because of another command that writes into the folder.
fn refuse(folder: &Path, words: &str) {
    let line = common::refuse(folder, words);
    let why = "another command is writing frames into this folder; wait until it is done, or choose another folder with --out\n";
    assert!(line.starts_with("nabiki: out/gust") && line.ends_with(why), "{words}: {line}");
}

/// The names in a folder, in order.
fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        fs::read_dir(folder).unwrap().map(|there| there.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn frames_of_one_command_are_not_taken_away_by_another() {
    let folder = tempfile::tempdir().unwrap();
    let (folder, frames) = (folder.path(), folder.path().join("out/gust_frames"));
    let [run, render, task] = ["run S W", "render S W", "render S W --frames 0..1"]
        .map(|words| words.replace('S', GUST).replace('W', STILLS) + " --out out");
    succeed(folder, &task);
    assert_eq!(names(&frames), ["0000.png", "0001.png"]);
    // What an earlier, longer run left would be removed.
    fs::copy(frames.join("0000.png"), frames.join("0009.png")).unwrap();

    let alone = HeldFolder::hold(&frames, Hold::Alone).unwrap().unwrap();
    [&run, &render, &task].into_iter().for_each(|words| refuse(folder, words));
    drop(alone);
    let task_of_another = HeldFolder::hold(&frames, Hold::BesideOthers).unwrap().unwrap();
    [&run, &render].into_iter().for_each(|words| refuse(folder, words));
    succeed(folder, &task);
    assert_eq!(names(&frames), [".nabiki-lock", "0000.png", "0001.png", "0009.png"]);
    // Numbered frames are all that a movie is made of.
    fs::remove_file(frames.join("0009.png")).unwrap();
    succeed(folder, "movie out/gust_frames -o gust.mp4");
    drop(task_of_another);

    // As a killed command leaves it.
    fs::write(frames.join(".nabiki-lock"), "").unwrap();
    succeed(folder, &run);
    assert_eq!(names(&frames), ["0000.png", "0001.png", "0002.png"]);
}

#[test]
fn a_turntable_holds_its_frames_too() {
    let folder = tempfile::tempdir().unwrap();
    let (folder, frames) = (folder.path(), folder.path().join("out/gust_0001_turntable_frames"));
    let turn = format!("render {GUST} {STILLS} --frame 1 --turntable 2 --out out");
    fs::create_dir_all(&frames).unwrap();
    let alone = HeldFolder::hold(&frames, Hold::BesideOthers).unwrap().unwrap();
    refuse(folder, &turn);
    drop(alone);
    succeed(folder, &turn);
    assert_eq!(names(&frames), ["0000.png", "0001.png"]);
}

#[cfg(unix)]
#[test]
fn a_command_told_to_end_lets_go_of_its_folder() {
    use std::os::unix::process::ExitStatusExt;

    let folder = tempfile::tempdir().unwrap();
    let frames = folder.path().join("out/gust_frames");
    let endless = format!("run {GUST} {STILLS} --set motion.frames=20000 --out out --quiet");
    let mut child =
        Command::new(env!("CARGO_BIN_EXE_nabiki")).args(endless.split(' ')).current_dir(folder.path()).spawn().unwrap();
    while !frames.join(".nabiki-lock").exists() {
        assert!(child.try_wait().unwrap().is_none(), "it runs until it is stopped");
        std::thread::yield_now();
    }
    let sent = Command::new("sh").args(["-c", &format!("kill -TERM {}", child.id())]).status().unwrap();
    assert!(sent.success());
    assert_eq!(child.wait().unwrap().signal(), Some(15));
    assert!(!frames.join(".nabiki-lock").exists());
}
