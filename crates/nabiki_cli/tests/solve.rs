//! `nabiki solve`: what it prints, and how it ends.

use std::path::Path;
use std::process::{Command, Output};

const SCENE: &str = "\
[hair]
strands = 40
[motion]
form = \"free\"
frames = 30
inertia_length_floor = 18.0
[[force]]
through = 30
vector = [-60, 0, 0]    # from the front
";

fn nabiki(folder: &Path, args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_nabiki")).current_dir(folder).args(args).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

#[test]
fn it_prints_what_was_left_what_is_and_the_new_numbers() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write("scene.toml", SCENE);
    write("wish.toml", "[unknowns]\nvectors = [0]\n[[wish]]\nframe = 30\nstrands = [1, 2]\nmean_moved = [0, 1, 1]\n");
    let done = nabiki(folder.path(), &["solve", "scene.toml", "--wish", "wish.toml", "-o", "solved.toml"]);
    let said = text(&done.stdout);
    assert!(done.status.success(), "{}", text(&done.stderr));
    for part in [
        "solved  rms 1.41 cm before, 0.0",
        " cm after: 3 numbers, ",
        " s\n",
        "force[0], frames 1 to 30: [",
        "wrote   solved.toml",
    ] {
        assert!(said.contains(part), "{said}");
    }
    let solved = std::fs::read_to_string(folder.path().join("solved.toml")).unwrap();
    assert!(solved.contains("]    # from the front") && !solved.contains("[-60, 0, 0]"), "{solved}");

    let quiet = nabiki(folder.path(), &["-q", "solve", "scene.toml", "--wish", "wish.toml", "-o", "again.toml"]);
    assert!(quiet.status.success() && quiet.stdout.is_empty());
    assert_eq!(std::fs::read_to_string(folder.path().join("again.toml")).unwrap(), solved, "the same, every time");

    let missing = nabiki(folder.path(), &["solve", "scene.toml", "--wish", "no.toml", "-o", "other.toml"]);
    let line = text(&missing.stderr);
    assert_eq!((missing.status.code(), line.lines().count()), (Some(1), 1), "{line}");
    assert!(line.starts_with("nabiki: no.toml: "), "{line}");
    assert!(!folder.path().join("other.toml").exists());
}
