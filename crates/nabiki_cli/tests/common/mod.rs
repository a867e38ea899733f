//! The command, run by tests.

use std::path::Path;
use std::process::{Command, Output};

/// Runs it in `folder`; `words` are parted by spaces.
pub fn nabiki(folder: impl AsRef<Path>, words: &str) -> Output {
    Command::new(env!("CARGO_BIN_EXE_nabiki")).args(words.split(' ')).current_dir(folder).output().unwrap()
}

/// The report of what must succeed.
pub fn succeed(folder: impl AsRef<Path>, words: &str) -> String {
    let output = nabiki(folder, words);
    assert!(output.status.success(), "{words}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// The one line of a refusal.
pub fn refuse(folder: impl AsRef<Path>, words: &str) -> String {
    let output = nabiki(folder, words);
    let line = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{words}: {line}");
    assert_eq!(line.trim_end().lines().count(), 1, "{words}: {line}");
    line
}
