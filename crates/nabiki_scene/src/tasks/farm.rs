//! A scene as a job for a render farm.

use std::path::{Path, PathBuf};

use nabiki_file::folder_of;

use crate::built::Shown;
use crate::error::{Error, Result};
use crate::farm::{Engine, Plan};
use crate::outputs;
use crate::place;
use crate::scene::Scene;
use crate::told::Told;
use crate::watch::Watch;

/// Strands with which a scene is tried first, for a quick refusal.
const TRIED: usize = 300;

/// Most strands in a shard, unless a number of shards is given.
const STRANDS_A_SHARD: usize = 100_000;

/// Options of [`farm`].
#[derive(Clone, Debug)]
pub struct FarmOptions {
    /// The engine that runs the job.
    pub engine: Engine,
    /// Number of shards of strands. By default such that each has at most 100,000 strands.
    pub shards: Option<u32>,
    /// Number of frames that one task draws.
    pub frames_a_task: u32,
    /// Number of strands to show; all by default.
    pub strands: Option<usize>,
    /// Overrides that make the scene file this scene, such as `motion.time_step=0.05`.
    pub sets: Vec<String>,
    /// The job: a template (.yaml) or a script (.sh).
    pub output: PathBuf,
    /// Folder for the results. By default next to the job, with the scene's name.
    pub results: Option<PathBuf>,
}

/// Writes a job that simulates a scene in shards, joins them, draws the frames and encodes the movie. It first builds
/// the scene for one shard, so that errors appear here and not on the farm.
///
/// # Errors
/// A scene that cannot be built or simulated, more shards than strands, or a place that cannot be written.
pub fn farm(scene: Scene, options: &FarmOptions, watch: &mut dyn Watch) -> Result<()> {
    let output = options.output.as_path();
    let (ending, what) = match options.engine {
        Engine::OpenJd => ("yaml", "a template of Open Job Description"),
        Engine::Slurm => ("sh", "a script for Slurm"),
    };
    if output.extension().is_none_or(|found| found != ending) {
        return Err(Error::refused(format!("{}: {what} ends in .{ending}; choose another name", output.display())));
    }
    place::file(output)?;
    place::not_inputs(&[output], &scene.inputs())?;
    check_movie(&scene)?;
    let plan = plan(scene, options, watch)?;
    let text = match options.engine {
        Engine::OpenJd => plan.template()?,
        Engine::Slurm => plan.script(),
    };
    nabiki_file::write(output, text.as_bytes()).map_err(|e| nabiki_io::Error::from(e).in_file(output))?;
    let holds = format!(
        "{} shards, {} frames in {} tasks, results into {}",
        plan.shards,
        plan.last + 1,
        plan.runs().count(),
        plan.results.display()
    );
    watch.told(Told::Wrote { file: output.to_owned(), holds: Some(holds) });
    Ok(())
}

/// Refuses pictures that cannot become a movie.
fn check_movie(scene: &Scene) -> Result<()> {
    if !scene.output.movie {
        return Ok(());
    }
    if scene.picture.background.transparent {
        let file = scene.file().display();
        return Err(Error::refused(format!(
            "{file}: picture.background.transparent = true: a movie cannot have alpha; give output.movie = false, or false"
        )));
    }
    outputs::check_movie(scene, &scene.picture)
}

fn plan(scene: Scene, options: &FarmOptions, watch: &mut dyn Watch) -> Result<Plan> {
    let folder = from_root(folder_of(&options.output))?;
    let name = scene.name();
    let results = match &options.results {
        Some(results) => from_root(results)?,
        None => folder.join(&name),
    };
    if results.exists() && !results.is_dir() {
        let line = "this is a file, not a folder; choose another folder with --out";
        return Err(Error::refused(format!("{}: {line}", results.display())));
    }
    let (last, movie, file) = (scene.motion.frames, scene.output.movie, from_root(scene.file())?);
    let built = super::build(scene, Shown::AtMost(options.strands.unwrap_or(TRIED).min(TRIED)), watch)?;
    // Refuses a scene that cannot be stepped.
    built.simulation()?;
    let strands = Shown::of(
        options.strands.map_or(Shown::All, Shown::First),
        built.groom.of_scene,
        built.scene.hair.grown().is_some(),
    )?;
    let shards = options.shards.unwrap_or(strands.div_ceil(STRANDS_A_SHARD) as u32);
    if shards as usize > strands {
        let line = format!("--shards {shards}: more shards than strands; use at most {strands}");
        return Err(Error::refused(line));
    }
    if strands > TRIED {
        // A short strand among the others tolerates less force.
        built.changed_to(built.scene.clone(), Shown::AtMost(strands.min(STRANDS_A_SHARD)))?.simulation()?;
    }
    super::present(&built, watch);
    Ok(Plan {
        name,
        scene: file,
        folder,
        results,
        sets: options.sets.clone(),
        strands: options.strands,
        shards,
        last,
        frames_a_task: options.frames_a_task,
        movie,
    })
}

/// A path in a form for every machine of a farm.
fn from_root(path: &Path) -> Result<PathBuf> {
    let path = std::path::absolute(path).map_err(|e| nabiki_io::Error::from(e).in_file(path))?;
    if path.to_str().is_none() {
        return Err(Error::refused(format!("{}: is not UTF-8 text, as a job must be; rename it", path.display())));
    }
    Ok(path)
}
