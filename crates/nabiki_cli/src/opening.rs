//! From the command line to a take: the scene, with what the command line changes in it, built.

use std::path::Path;

use nabiki_scene::Take;
use nabiki_scene::scene::Scene;

use crate::args::SceneArgs;
use crate::failure::Failure;

/// Reads and builds the scene. `strands` takes the place of `hair.strands`.
pub fn open(args: &SceneArgs, strands: Option<usize>) -> Result<Take, Failure> {
    Ok(Take::new(scene(args, strands)?.build()?)?)
}

/// Reads the scene and builds it with `shown` of its strands, which move as they do in the whole.
pub fn open_first(args: &SceneArgs, shown: usize) -> Result<Take, Failure> {
    Ok(Take::new(scene(args, None)?.build_first(shown)?)?)
}

/// The scene with its overrides.
pub fn scene(args: &SceneArgs, strands: Option<usize>) -> Result<Scene, Failure> {
    let mut overrides = Vec::new();
    for set in &args.sets {
        let (key, value) = set
            .split_once('=')
            .ok_or_else(|| Failure::new(format!("--set {set}: write KEY=VALUE, as in --set motion.time_step=0.05")))?;
        overrides.push((key.trim().to_owned(), value.trim().to_owned()));
    }
    if let Some(frames) = args.frames {
        overrides.push(("motion.frames".to_owned(), frames.to_string()));
        if !overrides.iter().any(|(key, _)| key.starts_with("output.sheet")) {
            overrides.extend(shorter_sheet(&args.scene, frames));
        }
    }
    overrides.extend(strands.map(|n| ("hair.strands".to_owned(), n.to_string())));
    Ok(Scene::load(&args.scene, &overrides)?)
}

/// The contact sheet of the scene without the frames that a shorter try does not reach. A file that cannot be read
/// is left for the scene's own reader to refuse.
fn shorter_sheet(scene: &Path, frames: u32) -> Option<(String, String)> {
    let table: toml::Table = std::fs::read_to_string(scene).ok()?.parse().ok()?;
    let sheet = table.get("output")?.get("sheet")?.as_array()?;
    let reached: Vec<String> = sheet
        .iter()
        .filter(|frame| frame.as_integer().is_none_or(|n| n <= frames.into()))
        .map(ToString::to_string)
        .collect();
    Some(("output.sheet".to_owned(), format!("[{}]", reached.join(", "))))
}
