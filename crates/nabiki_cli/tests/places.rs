//! Where results cannot be written: each place is refused before a frame is made, and left as it was; and who does not listen.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use tempfile::TempDir;

const GUST: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/paper/gust.toml");

/// A scene that would be stepped and drawn for days: a refusal that came after its frames would never come.
const ENDLESS: [&str; 4] = ["--set", "motion.frames=4000000", "--set", "hair.strands=200"];

/// All that lies below `folder`, with the length of files.
fn everything(folder: &Path) -> Vec<(PathBuf, u64)> {
    let mut all = Vec::new();
    for entry in fs::read_dir(folder).unwrap().map(Result::unwrap) {
        let about = entry.metadata().unwrap();
        if about.is_dir() {
            all.extend(everything(&entry.path()));
        }
        all.push((entry.path(), if about.is_file() { about.len() } else { 0 }));
    }
    all.sort();
    all
}

/// The one line that refuses `arguments` on an endless scene; below `folder` all is as before.
fn refuse(arguments: &[&str], folder: &TempDir) -> String {
    let before = everything(folder.path());
    let output = Command::new(env!("CARGO_BIN_EXE_nabiki")).args(arguments).args(ENDLESS).output().unwrap();
    let line = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{arguments:?}: {line}");
    assert_eq!(line.lines().count(), 1, "{arguments:?}: {line}");
    assert_eq!(everything(folder.path()), before, "{arguments:?} leaves everything as it was");
    line
}

/// `name` in `folder`, as an argument.
fn at(folder: &TempDir, name: &str) -> String {
    folder.path().join(name).to_str().unwrap().to_owned()
}

/// Refuses to draw into `out` for the sake of `place` below it, in a line that says why and where else to write.
fn refuse_drawing(folder: &TempDir, place: &str, why: &str, sets: &[&str]) {
    let out = at(folder, "out");
    let sets: Vec<&str> = sets.iter().flat_map(|set| ["--set", set]).collect();
    let line = refuse(&[&["run", GUST, "--out", &out][..], &sets].concat(), folder);
    assert!(line.starts_with(&format!("nabiki: {}: ", at(folder, place))), "{line}");
    assert!(line.contains(why) && line.contains("--out"), "{line}");
}

#[test]
fn a_folder_in_the_place_of_a_picture_file() {
    let stills = ["output.png_frames=true", "output.exr_frames=true", "output.field=true"];
    for name in [
        "out/gust.mp4",
        "out/gust_sheet.png",
        "out/gust_field.svg",
        "out/gust_field.png",
        "out/gust_frames/0007.png",
        "out/gust_frames/3999999.exr",
    ] {
        let folder = TempDir::new().unwrap();
        fs::create_dir_all(at(&folder, name)).unwrap();
        refuse_drawing(&folder, name, "this is a folder, not a file", &stills);
    }
}

#[test]
fn a_folder_in_the_place_of_a_file_that_is_not_asked_for_does_not_matter() {
    let folder = TempDir::new().unwrap();
    for name in ["out/gust.mp4", "out/gust_frames/0002.png", "out/gust_frames/0001.exr", "out/gust_frames/1.png"] {
        fs::create_dir_all(at(&folder, name)).unwrap();
    }
    let (out, sets) = (at(&folder, "out"), ["picture.size=[32,32]", "output.movie=false", "output.png_frames=true"]);
    let sets = sets.iter().flat_map(|set| ["--set", set]);
    let run = ["run", GUST, "--out", &out, "--strands", "20", "--frames", "1"];
    let run = Command::new(env!("CARGO_BIN_EXE_nabiki")).args(run).args(sets).output().unwrap();
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    assert!(folder.path().join("out/gust_sheet.png").is_file());
}

#[test]
fn a_file_in_the_place_of_a_folder() {
    let folder = TempDir::new().unwrap();
    fs::write(at(&folder, "out"), "in the way").unwrap();
    refuse_drawing(&folder, "out", "this is a file, not a folder", &[]);
    let below = at(&folder, "out/below");
    let line = refuse(&["preview", GUST, "--out", &below], &folder);
    assert!(line.contains(&below) && line.contains("cannot make this folder"), "{line}");

    let folder = TempDir::new().unwrap();
    fs::create_dir(at(&folder, "out")).unwrap();
    fs::write(at(&folder, "out/gust_frames"), "in the way").unwrap();
    refuse_drawing(&folder, "out/gust_frames", "this is a file, not a folder", &["output.png_frames=true"]);
}

#[test]
fn the_pictures_of_a_preview_a_render_and_a_single_frame() {
    let folder = TempDir::new().unwrap();
    for name in ["out/gust_preview_sheet.png", "out/gust_sheet.png", "out/gust_0003.png"] {
        fs::create_dir_all(at(&folder, name)).unwrap();
    }
    let out = at(&folder, "out");
    for (arguments, name) in [
        (&["preview", GUST, "--out", &out][..], "gust_preview_sheet.png"),
        (&["render", GUST, "--out", &out], "gust_sheet.png"),
        (&["render", GUST, "--frame", "3", "--out", &out], "gust_0003.png"),
    ] {
        let line = refuse(arguments, &folder);
        assert!(line.contains(&format!("{name}: this is a folder")), "{line}");
    }
}

#[test]
fn files_beside_the_pictures() {
    let folder = TempDir::new().unwrap();
    fs::create_dir(at(&folder, "hair.usdc")).unwrap();
    fs::create_dir(at(&folder, "m.nabiki")).unwrap();
    let (export, cache, out) = (at(&folder, "hair.usdc"), at(&folder, "m.nabiki"), at(&folder, "new/out"));
    let (free, lost) = (at(&folder, "free.nabiki"), at(&folder, "none/hair.abc"));
    for (arguments, words) in [
        (&["run", GUST, "--out", &out, "--export", &export][..], "hair.usdc: this is a folder"),
        (&["run", GUST, "--out", &out, "--export", &lost], "hair.abc: there is no folder"),
        (&["simulate", GUST, "-o", &free, "--export", &export], "hair.usdc: this is a folder"),
        (&["simulate", GUST, "-o", &cache], "m.nabiki: this is a folder"),
        (&["groom", GUST, "-o", &export], "hair.usdc: this is a folder"),
    ] {
        let line = refuse(arguments, &folder);
        assert!(line.contains(words) && line.contains("choose another"), "{line}");
    }
}

#[test]
fn a_movie_too_large_for_its_codec() {
    let folder = TempDir::new().unwrap();
    let out = at(&folder, "new/out");
    let line = refuse(&["run", GUST, "--out", &out, "--set", "picture.size=[5000,3000]"], &folder);
    assert!(line.contains("picture.size = 5000 x 3000") && line.contains("set output.movie = false"), "{line}");
}

#[cfg(unix)]
#[test]
fn what_is_neither_file_nor_folder_is_not_replaced() {
    let folder = TempDir::new().unwrap();
    let socket = at(&folder, "m.nabiki");
    let _listener = std::os::unix::net::UnixListener::bind(&socket).unwrap();
    let line = refuse(&["simulate", GUST, "-o", &socket], &folder);
    assert!(line.contains("m.nabiki: this is a device or a pipe"), "{line}");
}

#[cfg(target_os = "linux")]
#[test]
fn a_folder_that_takes_no_files() {
    let folder = TempDir::new().unwrap();
    for (out, why) in [("/proc/none/out", "cannot make this folder"), ("/proc", "cannot write in this folder")] {
        let line = refuse(&["run", GUST, "--out", out, "--set", "output.movie=false"], &folder);
        assert!(line.starts_with(&format!("nabiki: {out}: {why}")) && line.contains("--out"), "{line}");
    }
}

#[test]
fn one_file_for_two_results() {
    let folder = TempDir::new().unwrap();
    fs::create_dir(folder.path().join("sub")).unwrap();
    let [cache, layer, archive] = ["m.nabiki", "a.usdc", "a.abc"].map(|name| at(&folder, name));
    let roundabout = at(&folder, "sub/../a.usdc");
    let simulate = ["simulate", GUST, "-o"];
    for exports in [[&layer, &roundabout], [&archive, &archive]] {
        let line =
            refuse(&[&simulate[..], &[&cache, "--export", exports[0], "--export", exports[1]]].concat(), &folder);
        assert!(line.contains(&format!("{}: given twice", exports[1])), "{line}");
    }
    let line = refuse(&[&simulate[..], &[&layer, "--export", &roundabout]].concat(), &folder);
    assert!(line.contains("given twice"), "{line}");
}

/// The command with a standard output that nobody reads any more.
#[cfg(unix)]
#[test]
fn a_reader_that_has_gone() {
    let folder = TempDir::new().unwrap();
    let groom = at(&folder, "groom.hair");
    for arguments in [&["groom", GUST, "--strands", "50", "-o", &groom][..], &["info", &groom]] {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let output = Command::new(env!("CARGO_BIN_EXE_nabiki")).args(arguments).stdout(writer).output().unwrap();
        assert!(output.status.success() && output.stderr.is_empty(), "{}", String::from_utf8_lossy(&output.stderr));
    }
    assert!(Path::new(&groom).exists());
}

#[cfg(unix)]
#[test]
fn a_link_into_a_folder_that_is_not_there_says_so_at_once() {
    let folder = TempDir::new().unwrap();
    for (name, to) in [("link.nabiki", "nowhere/m.nabiki"), ("link.usdc", "nowhere/m.usdc")] {
        std::os::unix::fs::symlink(to, folder.path().join(name)).unwrap();
        let link = at(&folder, name);
        let line = refuse(&["simulate", GUST, "-o", &link], &folder);
        let nowhere = at(&folder, "nowhere");
        let said = format!("{link}: is a link to {nowhere}/m.{}, and there is no folder {nowhere}; ", &name[5..]);
        assert!(line.contains(&said), "{line}");
    }
    std::os::unix::fs::symlink("nowhere/gust.mp4", folder.path().join("gust.mp4")).unwrap();
    let line = refuse(&["run", GUST, "--out", &at(&folder, "")], &folder);
    assert!(line.contains("gust.mp4: is a link to ") && line.contains("choose another folder with --out"), "{line}");
}
