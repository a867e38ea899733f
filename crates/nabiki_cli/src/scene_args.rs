//! From the command line to a scene: the file, with what the command line changes in it.

use std::path::Path;

use nabiki_io::input::{MOST_SCENE_BYTES, read_text};
use nabiki_scene::{Error, Result, Scene};

use crate::args::SceneArgs;

impl SceneArgs {
    /// The scene with its overrides.
    pub fn load(&self) -> Result<Scene> {
        Ok(Scene::load(&self.scene, &self.overrides()?)?)
    }

    /// What is changed in the scene: keys and values.
    fn overrides(&self) -> Result<Vec<(String, String)>> {
        let mut overrides = Vec::new();
        for set in &self.sets {
            let (key, value) = set.split_once('=').ok_or_else(|| {
                Error::refused(format!("--set {set}: write KEY=VALUE, as in --set motion.time_step=0.05"))
            })?;
            // Spaces about dots are TOML's.
            let key: Vec<&str> = key.split('.').map(str::trim).collect();
            overrides.push((key.join("."), value.trim().to_owned()));
        }
        if let Some(frames) = self.frames {
            if let Some((key, value)) = overrides.iter().find(|(key, _)| key == "motion.frames") {
                let line = format!("--frames {frames} and --set {key}={value}: give one of them");
                return Err(Error::refused(line));
            }
            overrides.push(("motion.frames".to_owned(), frames.to_string()));
        }
        let of_sheet = |key: &str| key == "output" || key.starts_with("output.sheet");
        let frames = overrides.iter().rfind(|(key, _)| key == "motion.frames").map(|(_, frames)| frames.parse());
        if let Some(Ok(frames)) = frames
            && !overrides.iter().any(|(key, _)| of_sheet(key))
        {
            overrides.extend(shorter_sheet(&self.scene, frames));
        }
        Ok(overrides)
    }

    /// The same as values of `--set`.
    pub fn as_sets(&self) -> Result<Vec<String>> {
        Ok(self.overrides()?.into_iter().map(|(key, value)| format!("{key}={value}")).collect())
    }
}

/// The contact sheet of the scene without the frames that a shorter try does not reach. A file that cannot be read
/// is left for the scene's own reader to refuse.
fn shorter_sheet(scene: &Path, frames: u32) -> Option<(String, String)> {
    let table: toml::Table = read_text(scene, MOST_SCENE_BYTES).ok()?.parse().ok()?;
    let sheet = table.get("output")?.get("sheet")?.as_array()?;
    let reached: Vec<String> = sheet
        .iter()
        .filter(|frame| frame.as_integer().is_none_or(|n| n <= frames.into()))
        .map(ToString::to_string)
        .collect();
    Some(("output.sheet".to_owned(), format!("[{}]", reached.join(", "))))
}
