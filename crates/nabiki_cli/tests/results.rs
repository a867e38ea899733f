//! Results among what others write and have left: runs side by side, pipes and links where files are looked for, names of one file.

#![cfg(unix)]

mod common;

use std::fs;
use std::os::unix::fs::{PermissionsExt, symlink};
use std::path::Path;
use std::process::Command;

use tempfile::TempDir;

use common::{refuse, succeed};

const GUST: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/paper/gust.toml");
const FEW: &str = "--strands 10 --frames 2 --set output.sheet=[0] --set picture.size=[32,32]";

fn pipe(path: &Path) {
    assert!(Command::new("mkfifo").arg(path).status().unwrap().success());
}

#[test]
fn of_runs_side_by_side_to_one_file_none_fails() {
    let folder = TempDir::new().unwrap();
    succeed(&folder, &format!("simulate {GUST} {FEW} -o r.nabiki"));
    for _ in 0..6 {
        let start = |_| {
            let mut command = Command::new(env!("CARGO_BIN_EXE_nabiki"));
            command.args(["convert", "-q", "r.nabiki", "same.abc"]).current_dir(folder.path());
            command.stderr(std::process::Stdio::piped()).spawn().unwrap()
        };
        for run in (0..8).map(start).collect::<Vec<_>>() {
            let output = run.wait_with_output().unwrap();
            assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        }
    }
    let left: Vec<_> = fs::read_dir(folder.path()).unwrap().map(|there| there.unwrap().file_name()).collect();
    assert_eq!(left.len(), 2, "{left:?}");
}

#[test]
fn a_pipe_where_a_file_is_looked_for_is_not_waited_for() {
    let folder = TempDir::new().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::create_dir(at("stills")).unwrap();
    pipe(&at("stills/0000.png"));
    let line = refuse(&folder, "movie stills -o m.mp4");
    assert!(line.contains("stills/0000.png: is a device or a pipe, not a regular file"), "{line}");
    pipe(&at("scene.toml"));
    for words in ["run scene.toml", "preview scene.toml --frames 3", "simulate scene.toml -o m.nabiki --frames 3"] {
        let line = refuse(&folder, words);
        assert!(line.contains("scene.toml: is a device or a pipe"), "{words}: {line}");
    }
    for name in
        ["hair.usdc", "hair.abc", "hair.usda", "hair.hair", "hair.tfx", "hair.obj", "m.nabiki", "head.glb", "t.csv"]
    {
        pipe(&at(name));
        let line = refuse(&folder, &format!("info {name}"));
        assert!(line.contains(&format!("{name}: is a device or a pipe")), "{line}");
    }
    let line = refuse(&folder, &format!("simulate {GUST} {FEW} -o m.nabiki"));
    assert!(line.contains("m.nabiki: this is a device or a pipe"), "{line}");
    let line = refuse(&folder, &format!("solve {GUST} --wish t.csv -o s.toml"));
    assert!(line.contains("t.csv: is a device or a pipe"), "{line}");
}

#[test]
fn a_lock_that_is_no_file_is_named_and_left() {
    let folder = TempDir::new().unwrap();
    let stills = folder.path().join("out/gust_frames");
    fs::create_dir_all(&stills).unwrap();
    let lock = stills.join(".nabiki-lock");
    let run = format!("run {GUST} {FEW} --set output.png_frames=true");
    symlink(folder.path().join("elsewhere"), &lock).unwrap();
    let line = refuse(&folder, &run);
    assert!(line.contains(".nabiki-lock: this is not a regular file, as a lock must be; remove it"), "{line}");
    assert!(!folder.path().join("elsewhere").exists() && fs::symlink_metadata(&lock).is_ok());
    fs::remove_file(&lock).unwrap();
    pipe(&lock);
    assert!(refuse(&folder, &run).contains(".nabiki-lock: this is not a regular file"));
}

#[test]
fn two_names_of_one_file_are_not_two_results() {
    let folder = TempDir::new().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::create_dir(at("sub")).unwrap();
    symlink("real.usdc", at("link.usdc")).unwrap();
    symlink(".", at("here")).unwrap();
    fs::write(at("a.usdc"), "old").unwrap();
    fs::hard_link(at("a.usdc"), at("b.usdc")).unwrap();
    for [output, export] in [
        ["real.usdc", "link.usdc"],
        ["link.usdc", "real.usdc"],
        ["link.usdc", "./sub/../link.usdc"],
        ["x.usdc", "here/x.usdc"],
        ["x.usdc", "sub/..//x.usdc"],
        ["a.usdc", "b.usdc"],
    ] {
        let line = refuse(&folder, &format!("simulate {GUST} {FEW} -o {output} --export {export}"));
        assert!(line.contains(&format!("{export}: given twice")), "{line}");
    }
    // Where capitals count, these are two.
    succeed(&folder, &format!("simulate {GUST} {FEW} -o one.usdc --export ONE.abc"));
    // A picture's place is taken, too.
    symlink("out/gust.mp4", at("movie.usdc")).unwrap();
    fs::create_dir(at("out")).unwrap();
    let line = refuse(&folder, &format!("run {GUST} {FEW} --export movie.usdc"));
    assert!(line.contains("movie.usdc: given twice"), "{line}");
    symlink("out/gust_preview.mp4", at("movie.nabiki")).unwrap();
    let line = refuse(&folder, &format!("preview {GUST} {FEW} --cache movie.nabiki"));
    assert!(line.contains("movie.nabiki: given twice"), "{line}");
}

#[test]
fn a_hard_link_to_what_is_read_is_not_a_result() {
    let folder = TempDir::new().unwrap();
    succeed(&folder, &format!("groom {GUST} --strands 5 -o hair.usdc"));
    fs::hard_link(folder.path().join("hair.usdc"), folder.path().join("same.usdc")).unwrap();
    let line = refuse(&folder, "convert hair.usdc same.usdc");
    assert!(line.contains("same.usdc: this is an input of the result, which is hair.usdc"), "{line}");
}

#[test]
fn frames_that_nabiki_did_not_draw_are_left_and_said() {
    let folder = TempDir::new().unwrap();
    let stills = folder.path().join("out/gust_frames");
    let run = |frames: u32, kind: &str| {
        let sets = "--set output.movie=false --set output.sheet=[0] --set picture.size=[32,32]";
        succeed(&folder, &format!("run {GUST} --strands 5 --frames {frames} {sets} --set output.{kind}=true"))
    };
    run(3, "png_frames");
    run(3, "exr_frames");
    let theirs = b"\x89PNG\r\n\x1a\nof another program";
    for name in ["0003.png", "0007.png", "0003.exr"] {
        fs::write(stills.join(name), theirs).unwrap();
    }
    let said = run(1, "png_frames");
    assert!(said.contains("removed 1 files of frames after 1 from out/gust_frames"), "{said}");
    let left = "warning out/gust_frames contains 2 files of frames after 1 that nabiki did not write, 0003.png first";
    assert!(said.contains(left), "{said}");
    let said = run(1, "exr_frames");
    assert!(said.contains("removed 1 files of frames after 1 from out/gust_frames"), "{said}");
    assert!(said.contains("contains 1 file of frames after 1 that nabiki did not write, 0003.exr first"), "{said}");
    for name in ["0003.png", "0007.png", "0003.exr"] {
        assert_eq!(fs::read(stills.join(name)).unwrap(), theirs, "{name}");
    }
}

#[test]
fn what_is_replaced_keeps_its_permissions() {
    let folder = TempDir::new().unwrap();
    let mode = |name: &str| fs::metadata(folder.path().join(name)).unwrap().permissions().mode() & 0o777;
    let files = ["m.nabiki", "a.abc", "b.usdc"];
    let run = format!("simulate {GUST} {FEW} -o m.nabiki --export a.abc --export b.usdc");
    succeed(&folder, &run);
    for file in files {
        fs::set_permissions(folder.path().join(file), fs::Permissions::from_mode(0o600)).unwrap();
    }
    succeed(&folder, &run);
    assert_eq!(files.map(mode), [0o600; 3]);
}
