//! A scene to begin with.

use std::io::Write;
use std::path::{Path, PathBuf};

use nabiki::Profile;
use nabiki::dynamics::{Form, check_field};
use nabiki_file::PartFile;

use crate::built::{BuiltScene, Shown};
use crate::error::{Error, Result};
use crate::place;
use crate::scene::Scene;
use crate::template::{STIFFNESS, stiffness_line, template};
use crate::told::Told;
use crate::watch::Watch;

/// How often the stiffness is halved before hair is left without.
const HALVINGS: i32 = 12;

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
/// A file that cannot be read, a head without a skull, a name that does not end in .toml, a place that is taken or cannot be written.
pub fn new(path: &Path, options: &NewOptions, watch: &mut dyn Watch) -> Result<()> {
    if !options.replace && std::fs::symlink_metadata(path).is_ok() {
        return Err(Error::refused(format!(
            "{}: is there already; choose another name, or replace it with --force",
            path.display()
        )));
    }
    place::scene(path)?;
    let inputs: Vec<PathBuf> = options.head.iter().chain(&options.hair).cloned().collect();
    place::not_inputs(&[path], &inputs)?;
    super::reading(inputs, watch);
    let mut template = template(path, options.head.as_deref(), &options.groups, options.hair.as_deref())?;
    // Of hair that is grown a few strands tell enough; in a file any may be the shortest.
    let tried = if options.hair.is_some() { Shown::All } else { Shown::AtMost(TRIED) };
    let built = Scene::parse(&template.text, path, &[])?.build(tried)?;
    let part = stable_part(&built);
    if part < 1.0 {
        let softer = STIFFNESS.map(|stiffness| part * stiffness);
        template.text = template.text.replacen(&stiffness_line(STIFFNESS), &stiffness_line(softer), 1);
        template.guesses.push(format!(
            "free.stiffness = {softer:?}, of {STIFFNESS:?}, which the shortest segments of this hair are too quick for"
        ));
        Scene::parse(&template.text, path, &[])?.build(tried)?.simulation()?;
    } else {
        built.simulation()?;
    }
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

/// The part of the scene's stiffness, by halves, with which its hair can be stepped; 0 where it may have none.
fn stable_part(built: &BuiltScene) -> f32 {
    let Form::Free(free) = &built.dynamics.form else { return 1.0 };
    let holds = |part: f32| {
        let mut softer = free.clone();
        softer.form.stiffness = Profile::RootToTip(free.form.stiffness.values().iter().map(|k| part * k).collect());
        let dynamics = nabiki::dynamics::Dynamics { form: Form::Free(softer), ..built.dynamics.clone() };
        check_field(&built.hair.strands, &dynamics, &*built.field).is_ok()
    };
    (0..HALVINGS).map(|n| 0.5_f32.powi(n)).find(|&part| holds(part)).unwrap_or(0.0)
}
