//! The job as an Open Job Description template, jobtemplate-2023-09, in YAML.

use std::fmt::Write;
use std::fs;
use std::path::{Component, Path, PathBuf};

use nabiki_file::folder_of;
use nabiki_io::screen::{OneLine, is_unsafe};

use super::{Names, Plan, Step, Tasks, Word};
use crate::error::{Error, Result};

const NAMES: Names = Names {
    scene: "{{Param.Scene}}",
    results: "{{Param.Results}}",
    name: None,
    shard: "{{Task.Param.Shard}}",
    frames: "{{Task.Param.From}}..{{Task.Param.Through}}",
};

/// Longest name of a job (characters).
const LONGEST_NAME: usize = 128;

/// Longest default of a parameter (characters).
const LONGEST_DEFAULT: usize = 1024;

impl Plan {
    /// The template.
    ///
    /// # Errors
    /// Words that the format would take for its own.
    pub fn template(&self) -> Result<String> {
        let mut out = String::new();
        // A label without control characters, which the format does not allow.
        let name: String = OneLine(format!("Nabiki {}", self.name)).to_string().chars().take(LONGEST_NAME).collect();
        let scene = default_path(&self.scene, &self.folder);
        let results = default_path(&self.results, &self.folder);
        if let Some(why) = not_held(&self.name) {
            return Err(Error::refused(format!("{}: its name {why}; rename the scene", self.scene.display())));
        }
        let sets: Vec<String> = self.sets.iter().map(|set| spaced(set)).collect();
        if let Some((set, why)) = sets.iter().find_map(|set| Some((set, not_held(set)?))) {
            return Err(Error::refused(format!("{set}: {why}; leave it out, or write it into the scene")));
        }
        let held = Self { sets, ..self.clone() };
        let parameter = |name: &str, kind: &str, about: &str, default: Option<String>| {
            let default = default.map_or_else(String::new, |path| format!("    default: {}\n", text(&path)));
            format!("  - name: {name}\n    type: {kind}\n    description: {}\n{about}{default}", text(about_of(name)))
        };
        let _ = write!(
            out,
            "specificationVersion: jobtemplate-2023-09\nname: {}\nparameterDefinitions:\n{}{}{}steps:\n",
            text(&name),
            parameter("Scene", "PATH", "    objectType: FILE\n    dataFlow: IN\n", scene),
            parameter("Results", "PATH", "    objectType: DIRECTORY\n    dataFlow: INOUT\n", results),
            parameter("Nabiki", "STRING", "", Some("nabiki".to_owned())),
        );
        let mut before = None;
        for step in held.steps(&NAMES) {
            held.step(&mut out, &step, before);
            before = Some(step.name);
        }
        Ok(out)
    }

    fn step(&self, out: &mut String, Step { name, tasks, command }: &Step, before: Option<&str>) {
        let _ = writeln!(out, "  - name: {name}");
        if let Some(before) = before {
            let _ = writeln!(out, "    dependencies:\n      - dependsOn: {before}");
        }
        let parameter = |name: &str, range: String| {
            format!("        - name: {name}\n          type: INT\n          range: \"{range}\"\n")
        };
        let space = "    parameterSpace:\n      taskParameterDefinitions:\n";
        match tasks {
            Tasks::One => {}
            Tasks::Shards => {
                let _ = write!(out, "{space}{}", parameter("Shard", format!("1-{}", self.shards)));
            }
            Tasks::Frames => {
                let (from, through) = (self.ends(|run| *run.start()), self.ends(|run| *run.end()));
                let (from, through) = (parameter("From", from), parameter("Through", through));
                let _ = writeln!(out, "{space}{from}{through}      combination: \"(From, Through)\"");
            }
        }
        let args =
            "    script:\n      actions:\n        onRun:\n          command: \"{{Param.Nabiki}}\"\n          args:\n";
        out.push_str(args);
        for word in command {
            let (Word::Plain(word) | Word::Filled(word)) = word;
            let _ = writeln!(out, "            - {}", text(word));
        }
    }

    /// One end of each run, as a range of the format: all but the last are evenly spaced.
    fn ends(&self, end: impl Fn(&std::ops::RangeInclusive<u32>) -> u32) -> String {
        let ends: Vec<u32> = self.runs().map(|run| end(&run)).collect();
        match ends.as_slice() {
            [] => String::new(),
            [one] => one.to_string(),
            [one, other] => format!("{one},{other}"),
            [first, .., before, last] => format!("{first}-{before}:{},{last}", self.frames_a_task),
        }
    }
}

/// Why the format cannot store this in a command.
fn not_held(text: &str) -> Option<&'static str> {
    if text.contains("{{") || text.contains("}}") {
        Some("contains {{ or }}, which Open Job Description reads as a parameter")
    } else if text.contains(|c: char| c.is_control() && c != '\n') {
        Some("contains a control character, which Open Job Description does not allow")
    } else {
        None
    }
}

/// The same `KEY=VALUE` with spaces between braces and for tabs, if it means the same in TOML.
fn spaced(set: &str) -> String {
    let parsed = |set: &str| set.parse::<toml::Table>().ok();
    let mut other = set.replace('\t', " ");
    while other.contains("{{") || other.contains("}}") {
        other = other.replace("{{", "{ {").replace("}}", "} }");
    }
    if parsed(&other).is_some_and(|other| Some(other) == parsed(set)) { other } else { set.to_owned() }
}

fn about_of(parameter: &str) -> &'static str {
    match parameter {
        "Scene" => "The scene (TOML). Relative paths in it start from its folder.",
        "Results" => "Folder for shards, motion, frames and movie; created if missing.",
        _ => "The nabiki command on the worker machines.",
    }
}

/// A default of a path parameter: relative to the template's folder and inside it, as the format requires, or none.
fn default_path(path: &Path, folder: &Path) -> Option<String> {
    let below = |path: &Path, folder: &Path| {
        let inside = path.strip_prefix(folder).ok()?;
        let stays = inside.components().all(|part| part != Component::ParentDir);
        let inside = inside.to_str().filter(|inside| stays && !inside.is_empty())?;
        (inside.chars().count() <= LONGEST_DEFAULT).then(|| inside.to_owned())
    };
    // Only the disk knows where `..` leads behind a link. The file itself keeps its name even if it is a link: the
    // files that it names are beside that.
    let real = || -> Option<PathBuf> { Some(fs::canonicalize(folder_of(path)).ok()?.join(path.file_name()?)) };
    below(path, folder).or_else(|| below(&real()?, &fs::canonicalize(folder).ok()?))
}

/// A double-quoted scalar in YAML.
fn text(text: &str) -> String {
    let mut out = String::from('"');
    for c in text.chars() {
        match c {
            '"' | '\\' => out.extend(['\\', c]),
            // YAML folds some of these into spaces, and does not allow others.
            c if is_unsafe(c) || matches!(c, '\u{feff}' | '\u{fffe}' | '\u{ffff}') => {
                let _ = write!(out, "\\u{:04x}", u32::from(c));
            }
            c => out.push(c),
        }
    }
    out.push('"');
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quoted_text_is_one_line_of_yaml() {
        assert_eq!(
            text("a \"b\" \\ \n \u{85}\u{2028}\u{feff}\u{98a8}"),
            "\"a \\\"b\\\" \\\\ \\u000a \\u0085\\u2028\\ufeff\u{98a8}\""
        );
    }

    #[test]
    fn what_the_format_cannot_hold_is_written_in_other_words_or_refused() {
        assert_eq!(spaced("picture={camera={azimuth=\t1}}"), "picture={camera={azimuth= 1} }");
        assert_eq!(spaced("a=[{b={c={d=1}}}]"), "a=[{b={c={d=1} } }]");
        for kept in ["head.mesh=\"{{x}}.obj\"", "head.mesh=\"a\tb\"", "a = 1"] {
            assert_eq!(spaced(kept), kept);
        }
        for held in ["a\nb", "a}b{c", "\u{2028}"] {
            assert_eq!(not_held(held), None, "{held}");
        }
        for refused in ["{{", "a}}", "\t", "\u{1b}", "\u{9b}"] {
            assert!(not_held(refused).is_some(), "{refused}");
        }
    }

    #[test]
    fn a_default_that_is_too_long_is_left_out() {
        let deep = format!("/jobs/{}gust.toml", "scenes/".repeat(150));
        assert_eq!(default_path(deep.as_ref(), "/jobs".as_ref()), None);
    }

    #[test]
    fn a_default_path_stays_in_the_folder_of_the_template() {
        let inside = |path: &str| default_path(path.as_ref(), "/jobs/a".as_ref());
        assert_eq!(inside("/jobs/a/scenes/gust.toml").as_deref(), Some("scenes/gust.toml"));
        assert_eq!(inside("/jobs/gust.toml"), None);
        assert_eq!(inside("/jobs/a"), None);
        assert_eq!(inside("/jobs/a/../gust.toml"), None);
        assert_eq!(inside("/jobs/a/scenes/../../gust.toml"), None);
    }

    #[test]
    fn a_path_that_goes_out_and_comes_back_is_named_from_the_folder() {
        let jobs = tempfile::tempdir().unwrap();
        let jobs = jobs.path();
        fs::create_dir_all(jobs.join("a/scenes")).unwrap();
        let inside = |path: &str, folder: &str| default_path(&jobs.join(path), &jobs.join(folder));
        assert_eq!(inside("a/../gust.toml", "").as_deref(), Some("gust.toml"));
        assert_eq!(inside("a/scenes/../gust.toml", "a/scenes/..").as_deref(), Some("gust.toml"));
        assert_eq!(inside("a/scenes/../../a/gust.toml", "a").as_deref(), Some("gust.toml"));
        assert_eq!(inside("a/../gust.toml", "a"), None);
    }
}
