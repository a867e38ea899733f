//! What is said holds nothing that a terminal obeys, whatever files, keys and arguments hold; and commands that are said can be pasted.

use std::fs;
use std::process::{Command, Output};

use nabiki_io::cache::{Reader, Writer};
use nabiki_io::screen::is_unsafe;
use tempfile::TempDir;

const GUST: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/paper/gust.toml");

/// Clears a screen, names a window, begins a line, turns the order of letters, parts lines.
const ODD: &str = "a\u{1b}[2J\u{1b}]0;x\u{7}\u{9b}7m\u{7f}\u{202e}\u{2066}\u{2028}\rb";

/// Runs the command and holds all that it says against a terminal.
fn nabiki(folder: &TempDir, words: &[&str]) -> Output {
    let output = Command::new(env!("CARGO_BIN_EXE_nabiki")).args(words).current_dir(folder.path()).output().unwrap();
    for said in [&output.stdout, &output.stderr] {
        let said = String::from_utf8(said.clone()).unwrap();
        assert!(!said.contains(|c| c != '\n' && is_unsafe(c)), "{words:?}: {said:?}");
    }
    output
}

/// What it says where it must succeed.
fn said(folder: &TempDir, words: &[&str]) -> String {
    let output = nabiki(folder, words);
    assert!(output.status.success(), "{words:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// The one line of its refusal.
fn refused(folder: &TempDir, words: &[&str]) -> String {
    let output = nabiki(folder, words);
    let line = String::from_utf8(output.stderr).unwrap();
    assert_eq!((output.status.code(), line.lines().count()), (Some(1), 1), "{words:?}: {line}");
    line
}

fn bvh(joint: &str) -> String {
    let frames = "0 0 0 0 0 0\n".repeat(5);
    format!(
        "HIERARCHY\nROOT {joint}\n{{\nOFFSET 0 0 0\nCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n\
         End Site\n{{\nOFFSET 0 1 0\n}}\n}}\nMOTION\nFrames: 5\nFrame Time: 0.0333\n{frames}"
    )
}

#[test]
fn names_out_of_files() {
    let folder = TempDir::new().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    write("joint.bvh", &bvh(&ODD.replace(['\r', '\u{2028}'], "")));
    let info = said(&folder, &["info", "joint.bvh"]);
    assert!(info.contains(r"joints: a\x1b[2J\x1b]0;x\x07\x9b7m\x7f\u202e\u2066b"), "{info}");
    let json = said(&folder, &["info", "--json", "joint.bvh"]);
    let joints = &serde_json::from_str::<serde_json::Value>(&json).unwrap()["joints"];
    assert_eq!(joints[0], ODD.replace(['\r', '\u{2028}'], ""), "a program has the name as it is");
    let force = "[[force]]\nthrough = 10\nvector = [-5, -40, 0]\n[motion]\nframes = 3\n[hair]\nstrands = 20\n";
    let motion = |file: &str| {
        format!("{force}[head.motion]\nfile = \"{file}\"\nnode = \"Head\"\nunit_cm = 1\nup = \"+y\"\nfacing = \"+z\"\n")
    };
    write("joint.toml", &motion("joint.bvh"));
    assert!(refused(&folder, &["simulate", "joint.toml", "-o", "m.nabiki"]).contains(r"\x1b[2J"));
    write("cell.csv", &format!("t_s,px_m,py_m,pz_m,qx,qy,qz,qw\n{},0,0,0,0,0,0,1\n", ODD.replace('\r', "")));
    write("cell.toml", &motion("cell.csv").replace("node = \"Head\"\nunit_cm = 1\n", ""));
    assert!(refused(&folder, &["simulate", "cell.toml", "-o", "m.nabiki"]).contains(r"\x1b[2J"));
    // Strings of a layer that are said as they are; the name of a type makes a line of the report.
    write("names.usda", &format!("#usda 1.0\ndef \"a\" {{ rel x{ODD} = </b> }}\ndef Other{ODD} \"c{ODD}\" {{ }}\n"));
    nabiki(&folder, &["info", "names.usda"]);
    write("heads.obj", &format!("g {ODD}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
    nabiki(&folder, &["new", "o.toml", "--head", "heads.obj", "--group", "none"]);
}

#[cfg(unix)]
#[test]
fn names_of_files_keys_and_arguments() {
    let folder = TempDir::new().unwrap();
    let odd = format!("{ODD}\nnabiki: forged");
    for words in [["info", &format!("{odd}.hair")], ["run", &format!("{odd}.toml")]] {
        let line = refused(&folder, &words);
        assert!(line.contains(r"\x1b[2J") && line.contains(r"\nnabiki: forged"), "{line}");
    }
    // Of results and scenes that are there, too.
    let scene = format!("{odd}.toml");
    fs::copy(GUST, folder.path().join(&scene)).unwrap();
    let small = ["--strands", "5", "--frames", "1", "--set", "picture.size=[16,16]"];
    let report = said(&folder, &[&["run", &scene, "--out", "o\u{1b}\nut"], &small[..]].concat());
    assert!(report.contains(r"\nnabiki: forged") && report.contains(r"o\x1b\nut"), "{report}");
    assert!(!report.lines().any(|line| line.starts_with("nabiki: forged")), "{report}");
    said(&folder, &["info", &scene]);
    fs::write(folder.path().join("key.toml"), "[motion]\n\"a\\u001b[2J\\n\\u202e\" = 1\n").unwrap();
    refused(&folder, &["info", "key.toml"]);
    fs::write(
        folder.path().join("text.toml"),
        "[head]\nmesh = \"a\\u001b[2J\\n\\u202e.obj\"\n[[force]]\nthrough = 9\nvector = [0, -9, 0]\n",
    )
    .unwrap();
    said(&folder, &["info", "text.toml"]);
    let groups = "[motion]\nform = \"free\"\n[[free.regions]]\ngroups = [\"a\\u001b[2J\\n\"]\n";
    fs::write(folder.path().join("groups.toml"), groups).unwrap();
    refused(&folder, &["info", "groups.toml"]);
    refused(&folder, &["simulate", "text.toml", "-o", "m.nabiki"]);
    refused(&folder, &["run", GUST, "--set", "a\u{1b}[2J"]);
    for words in [["\u{1b}[2J", "x"], ["run", "--\u{1b}[2J\u{202e}"], ["simulate", "--threads=\u{9b}2"]] {
        assert_eq!(nabiki(&folder, &words).status.code(), Some(2));
    }
}

/// A shard whose command is another: any file may be a shard.
fn with_command(folder: &TempDir, name: &str, command: &str) {
    said(folder, &["simulate", GUST, "--strands", "6", "--frames", "1", "--shard", "1/2", "-o", name]);
    let path = folder.path().join(name);
    let mut reader = Reader::open(&path).unwrap();
    let mut header = reader.header().clone();
    header.piece.as_mut().unwrap().command = command.to_owned();
    let mut strands = header.strands();
    let other = folder.path().join("other.nabiki");
    let mut writer = Writer::create(&other, &header, reader.frame_count()).unwrap();
    for frame in 0..reader.frame_count() {
        let pose = reader.read(frame, &mut strands).unwrap();
        writer.push(&pose, strands.points()).unwrap();
    }
    writer.finish().unwrap();
    fs::rename(other, path).unwrap();
}

#[test]
fn a_command_out_of_a_file_does_nothing_but_what_it_seems_to() {
    let folder = TempDir::new().unwrap();
    with_command(&folder, "ours.nabiki", "nabiki simulate 'a b.toml' --strands 6");
    let line = refused(&folder, &["join", "ours.nabiki", "-o", "whole.nabiki"]);
    let said = "make it with nabiki simulate 'a b.toml' --strands 6 --shard 2/2 -o 2_of_2.nabiki";
    assert!(line.contains(said), "{line}");
    for command in [
        "rm -rf ~; nabiki simulate a.toml",
        "nabiki simulate $(rm x)",
        "nabiki simulate \u{1b}[2J",
        "nabiki simulate a\nrm x",
    ] {
        with_command(&folder, "theirs.nabiki", command);
        let line = refused(&folder, &["join", "theirs.nabiki", "-o", "whole.nabiki"]);
        assert!(line.contains("make it with nabiki simulate SCENE --shard 2/2"), "{command:?}: {line}");
        assert!(!line.contains("rm "), "{line}");
    }
}

/// The command of a refusal, pasted into a shell, makes the shard, be the names what they will.
#[cfg(unix)]
#[test]
fn a_command_that_is_said_can_be_pasted() {
    let folder = TempDir::new().unwrap();
    for name in ["-it's a \"$HOME\" `scene`", "\u{98a8}\u{1b}\u{202e}", "two\nlines\\", "=x", "~"] {
        let (scene, piece) = (format!("{name}.toml"), format!("{name}_1.nabiki"));
        fs::copy(GUST, folder.path().join(&scene)).unwrap();
        let [scene, piece] = [scene, piece].map(|file| format!("./{file}"));
        let simulate = ["simulate", &scene, "--strands", "6", "--frames", "1", "--shard", "1/2", "-o", &piece];
        said(&folder, &simulate);
        let other = format!("./{name}_2_of_2.nabiki");
        let line = refused(&folder, &["join", &piece, &other, "-o", "whole.nabiki"]);
        let command = line.split_once("make it with nabiki ").unwrap().1.trim_end();
        let script = format!("{} {command}", env!("CARGO_BIN_EXE_nabiki"));
        // What a hyphen begins, or what is written in octal, not every `sh` takes; bash does.
        let pasted = Command::new("bash").args(["-c", &script]).current_dir(folder.path()).output().unwrap();
        assert!(pasted.status.success(), "{script}: {}", String::from_utf8_lossy(&pasted.stderr));
        assert!(folder.path().join(&other).exists(), "{script}");
        fs::remove_file(folder.path().join(&other)).unwrap();
    }
}
