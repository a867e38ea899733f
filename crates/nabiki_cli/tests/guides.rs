//! Every command in docs/guides runs, in the order of its guide, on the files that the guide has its reader write, and leaves the files
//! that the guide names.
//!
//! A block ```` ```sh ```` holds commands. Any other block is for the file that the line before it names last in backticks: tables and
//! layers are that file, and a part of a scene replaces what the scene has of it. A block after a line that names no file is only shown.

use std::fs;
use std::path::Path;
use std::process::Command;

use tempfile::TempDir;

const GUIDES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/guides");

/// What a guide has its reader do.
enum Step {
    /// The words of a command, without `nabiki`.
    Run(Vec<String>),
    /// A file to write.
    Write(String, String),
    /// A part of a scene, for its file.
    Edit(String, String),
}

/// The steps of a guide.
fn steps(text: &str) -> Vec<Step> {
    let (mut steps, mut before) = (Vec::new(), "");
    let mut lines = text.lines();
    while let Some(line) = lines.next() {
        let Some(language) = line.strip_prefix("```") else {
            before = if line.is_empty() { before } else { line };
            continue;
        };
        let block: String = lines.by_ref().take_while(|line| *line != "```").flat_map(|line| [line, "\n"]).collect();
        match (language, files(before).pop()) {
            ("sh", _) => steps.extend(block.replace("\\\n", "").lines().map(command)),
            ("toml fragment", Some(file)) => steps.push(Step::Edit(file, block)),
            ("csv" | "usda", Some(file)) => steps.push(Step::Write(file, block)),
            ("rust", _) => {}
            _ => panic!("```{language} after {before:?}"),
        }
        before = "";
    }
    steps
}

/// The command of a line, which may hold words in single quotes.
fn command(line: &str) -> Step {
    let mut words = vec![String::new()];
    for (i, part) in line.split('\'').enumerate() {
        if i % 2 == 1 {
            words.last_mut().unwrap().push_str(part);
            continue;
        }
        for (n, word) in part.split(' ').enumerate() {
            if n > 0 {
                words.push(String::new());
            }
            words.last_mut().unwrap().push_str(word);
        }
    }
    words.retain(|word| !word.is_empty());
    assert_eq!(words[0], "nabiki", "{line}");
    Step::Run(words.split_off(1))
}

/// The files that a text names in backticks: those that commands and readers of guides write.
fn files(text: &str) -> Vec<String> {
    let is_file = |name: &&str| {
        let (stem, ending) = name.rsplit_once('.').unwrap_or_default();
        let endings = ["toml", "csv", "usda", "usdc", "abc", "nabiki", "png", "mp4"];
        !stem.is_empty() && !stem.contains([' ', '{', '"']) && endings.contains(&ending)
    };
    text.split('`').skip(1).step_by(2).filter(is_file).map(str::to_owned).collect()
}

/// Puts the settings of `part` in the place of those that `scene` has.
fn replace(scene: &mut toml::Table, part: toml::Table) {
    for (key, value) in part {
        let replaced = match (scene.remove(&key), value) {
            (Some(toml::Value::Table(mut old)), toml::Value::Table(new)) => {
                replace(&mut old, new);
                toml::Value::Table(old)
            }
            (_, value) => value,
        };
        scene.insert(key, replaced);
    }
}

/// Runs a command: of a few frames, and of little hair where it is grown for pictures alone.
fn run(folder: &Path, words: &[String]) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_nabiki"));
    command.args(words).current_dir(folder);
    let has = |option: &str| words.iter().any(|word| word == option);
    let (draws, simulates) = (matches!(&*words[0], "preview" | "render" | "run"), words[0] == "simulate");
    if draws {
        command.args(["--set", "hair.strands=60"]);
    }
    if (draws || simulates) && !has("--frame") {
        command.args(["--set", "output.sheet=[0]"]);
        if !has("--frames") {
            command.args(["--frames", "2"]);
        }
    }
    let output = command.output().unwrap();
    assert!(output.status.success(), "{}: {}", words.join(" "), String::from_utf8_lossy(&output.stderr));
}

/// Does what a guide says in an empty folder.
fn follow(guide: &str) {
    let text = fs::read_to_string(Path::new(GUIDES).join(guide)).unwrap();
    let folder = TempDir::new().unwrap();
    for step in steps(&text) {
        match step {
            Step::Run(words) => run(folder.path(), &words),
            Step::Write(file, text) => fs::write(folder.path().join(file), text).unwrap(),
            Step::Edit(file, part) => {
                let path = folder.path().join(file);
                let mut scene: toml::Table = toml::from_str(&fs::read_to_string(&path).unwrap()).unwrap();
                replace(&mut scene, toml::from_str(&part).unwrap());
                fs::write(&path, toml::to_string(&scene).unwrap()).unwrap();
            }
        }
    }
    let prose: String = text.split("\n```").step_by(2).collect();
    for file in files(&prose) {
        assert!(folder.path().join(&file).is_file(), "{guide} names {file}, which no command wrote");
    }
}

#[test]
fn a_first_wind_blows() {
    follow("first-wind.md");
}

#[test]
fn a_groom_becomes_a_shot() {
    follow("groom-to-shot.md");
}

#[test]
fn every_guide_is_followed() {
    let names = fs::read_dir(GUIDES).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let mut names: Vec<String> = names.collect();
    names.sort();
    // That of games holds programs alone, which nabiki_scene/tests/docs.rs compares with examples.
    assert_eq!(names, ["first-wind.md", "game.md", "groom-to-shot.md"]);
}
