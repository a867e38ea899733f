//! From the command line to a take: the scene, with what the command line changes in it, built.

use std::path::Path;

use nabiki_io::scene::Scene;
use nabiki_io::take::Take;

use crate::args::SceneArgs;
use crate::failure::Failure;

/// Reads and builds the scene. `strands` takes the place of `hair.strands`.
pub fn open(args: &SceneArgs, strands: Option<usize>) -> Result<Take, Failure> {
    Ok(Take::new(scene(args, strands)?.build()?)?)
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
    overrides.extend(args.frames.map(|n| ("motion.frames".to_owned(), n.to_string())));
    overrides.extend(strands.map(|n| ("hair.strands".to_owned(), n.to_string())));
    Ok(Scene::load(&args.scene, &overrides)?)
}

/// Makes the folder that results go into.
pub fn folder(path: &Path) -> Result<(), Failure> {
    std::fs::create_dir_all(path).map_err(|e| {
        Failure::new(format!("{}: cannot make this folder: {e}; choose another with --out", path.display()))
    })
}
