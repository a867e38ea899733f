//! A scene to begin with.

use std::io::Write;
use std::path::{Path, PathBuf};

use nabiki_file::PartFile;

use crate::built::Shown;
use crate::error::{Error, Result};
use crate::place;
use crate::scene::Scene;
use crate::template::template;
use crate::told::Told;
use crate::watch::Watch;

/// Strands that show that a new scene can be built.
const TRIED: usize = 50;

/// What a [`new`] scene is about.
#[derive(Clone, Debug, Default)]
pub struct NewOptions {
    /// The head's mesh; without it the built-in bust.
    pub head: Option<PathBuf>,
    /// Groups of the head's file to keep; all if empty.
    pub groups: Vec<String>,
    /// The hair's file; without it hair is grown.
    pub hair: Option<PathBuf>,
    /// Whether a scene that is there already is replaced.
    pub replace: bool,
}

/// Writes a commented scene that runs as it is, and says what it guessed.
///
/// # Errors
/// A file that cannot be read, a head without a skull, a place that is taken or cannot be written.
pub fn new(path: &Path, options: &NewOptions, watch: &mut dyn Watch) -> Result<()> {
    if !options.replace && std::fs::symlink_metadata(path).is_ok() {
        return Err(Error::refused(format!(
            "{}: is there already; choose another name, or replace it with --force",
            path.display()
        )));
    }
    place::file(path)?;
    let inputs: Vec<PathBuf> = options.head.iter().chain(&options.hair).cloned().collect();
    place::not_inputs(&[path], &inputs)?;
    super::reading(inputs, watch);
    let template = template(path, options.head.as_deref(), &options.groups, options.hair.as_deref())?;
    let built = Scene::parse(&template.text, path, &[])?.build(Shown::AtMost(TRIED))?;
    built.simulation()?;
    let write = || {
        let mut file = PartFile::create(path)?;
        file.write_all(template.text.as_bytes())?;
        file.finish()
    };
    write().map_err(|e| nabiki_io::Error::from(e).in_file(path))?;
    template.guesses.into_iter().for_each(|guess| watch.told(Told::Guessed(guess)));
    built.advice().into_iter().for_each(|advice| watch.told(Told::Advice(advice)));
    super::wrote(vec![path.to_owned()], watch);
    Ok(())
}
