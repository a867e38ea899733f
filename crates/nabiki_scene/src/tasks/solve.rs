//! Which wind makes the hair do this? Solves wishes for a scene.

use std::collections::{BTreeSet, HashMap};
use std::path::{Path, PathBuf};
use std::time::Instant;

use nabiki::SettingError;
use nabiki::solve::{Problem, Report, Search, Solver, Wish};

use crate::advice::Advice;
use crate::built::{BuiltScene, Shown};
use crate::error::{Error, Result};
use crate::place;
use crate::scene::{HairSource, Scene, given_as};
use crate::solve::{Solved, WishFile};
use crate::told::Told;
use crate::watch::Watch;

/// Options of [`solve`].
#[derive(Clone, Debug)]
pub struct SolveOptions {
    /// The wish file.
    pub wishes: PathBuf,
    /// The scene to write.
    pub output: PathBuf,
    /// Number of strands in which to look for locks. Increased if wishes name others.
    pub strands: usize,
}

/// Finds settings with which the hair meets the wishes, and writes the scene with them.
///
/// # Errors
/// A scene that cannot be built or simulated, wishes that do not fit it, a place that cannot be written, or cancelled
/// by `watch`.
pub fn solve(scene: Scene, options: &SolveOptions, watch: &mut dyn Watch) -> Result<()> {
    let file = WishFile::load(&options.wishes)?;
    let mut inputs = scene.inputs();
    inputs.push(options.wishes.clone());
    check_place(&options.output, &inputs, &scene)?;
    let (mut scene, solved) = find(scene, &file, options.strands, watch)?;
    scene.save(&options.output)?;
    watch.told(Told::Solved(Box::new(solved)));
    super::wrote(vec![options.output.clone()], watch);
    Ok(())
}

/// Like [`solve`], without files: returns the scene with the settings that were found, and how near they come.
/// `strands` is the number of strands in which to look for locks; it increases if wishes name others.
///
/// # Errors
/// As for [`solve`], except places.
pub fn find(mut scene: Scene, file: &WishFile, strands: usize, watch: &mut dyn Watch) -> Result<(Scene, Solved)> {
    let wishes = &file.wishes;
    let in_file = |refused: SettingError| Error::from(file.refusal(refused));
    let free = wishes.unknowns(scene.field.force.len());
    let given = scene.field.as_given();
    let (force, unknowns) = free.of(&given, scene.motion.frames).map_err(in_file)?;
    scene.field.force = given_as(&scene.field.force, &given, &force);
    let shown = shown(file, strands, &scene)?;
    let built = super::build(scene, shown, watch)?;
    super::present(&built, watch);
    let named = file.about(&built)?;
    let (names, list): (Vec<String>, Vec<Wish>) = named.into_iter().map(|named| (named.name, named.wish)).unzip();
    let last = list.iter().map(|wish| wish.frame).max().unwrap_or(0);
    let ease = built.scene.field.wind.ease;
    let (unknowns, held) = free.within_reach(built.forces.intervals(), ease, &unknowns, last).map_err(in_file)?;
    // Unknowns that are free by default were not requested.
    let said = held.into_iter().filter(|_| wishes.unknowns.is_some());
    super::advise(said.map(Advice::new), watch);
    let strands: BTreeSet<u32> = list.iter().flat_map(|wish| wish.nodes.iter().map(|node| node.strand)).collect();
    let search = wishes.search;
    let mut seconds = 0.0;
    let mut answer = |built: &BuiltScene, list: Vec<Wish>, watch: &mut dyn Watch| -> Result<(Scene, Report)> {
        let begun = Instant::now();
        let problem = Problem { prior: wishes.prior, ..built.problem(unknowns.clone(), list) };
        let refused = |refused: SettingError| match refused.thing.is_within(&"unknowns".into()) {
            true => in_file(refused),
            false => built.refusal(refused),
        };
        let report = searched(Solver::new(problem).map_err(refused)?, &search, watch)?;
        seconds += begun.elapsed().as_secs_f64();
        let mut scene = built.scene.clone();
        scene.accept(&report.answer, built);
        Ok((scene, report))
    };
    let (mut scene, mut report) = answer(&built, list.clone(), watch)?;
    // Hair that is not shown may tolerate less force.
    if built.groom.ids.len() < built.groom.of_scene {
        let whole = built.changed_to(scene.clone(), Shown::All)?;
        if whole.simulation().is_err() {
            let whole = whole.changed_to(built.scene.clone(), Shown::All)?;
            (scene, report) = answer(&whole, among(&whole, &built, list), watch)?;
        }
    }
    Ok((scene, Solved { report, names, unknowns, strands: strands.len(), seconds }))
}

/// Wishes for `some` of the strands of `whole`, converted to wishes for `whole`, where the same hair has other indices.
fn among(whole: &BuiltScene, some: &BuiltScene, mut wishes: Vec<Wish>) -> Vec<Wish> {
    let places: HashMap<u32, u32> = whole.groom.ids.iter().copied().zip(0..).collect();
    for node in wishes.iter_mut().flat_map(|wish| &mut wish.nodes) {
        node.strand = places[&some.groom.ids[node.strand as usize]];
    }
    wishes
}

/// The whole search, unless it is cancelled.
fn searched(mut solver: Solver, search: &Search, watch: &mut dyn Watch) -> Result<Report> {
    let mut cancelled = false;
    watch.begin("solving", (search.starts * search.iterations) as u64);
    let report = solver.solve_watched(search, &mut |_| {
        watch.step();
        cancelled = watch.cancelled();
        !cancelled
    });
    watch.end();
    if cancelled { Err(Error::Cancelled) } else { Ok(report) }
}

/// Refuses a place that cannot be written, or from which the scene's files would not be found.
fn check_place(output: &Path, inputs: &[PathBuf], scene: &Scene) -> Result<()> {
    place::scene(output)?;
    place::not_inputs(&[output], inputs)?;
    let folder = |path: &Path| std::fs::canonicalize(nabiki_file::folder_of(path)).ok();
    if scene.inputs().len() > 1 && folder(output) != folder(scene.file()) {
        return Err(Error::refused(format!(
            "{}: the scene names {} by its place beside {}; write the result into that folder",
            output.display(),
            scene.inputs()[1].display(),
            scene.file().display()
        )));
    }
    Ok(())
}

/// The strands to build: those in which locks are searched for, and those that are named.
fn shown(file: &WishFile, strands: usize, scene: &Scene) -> Result<Shown> {
    match (&scene.hair.source, file.wishes.largest_strand()) {
        (_, None) => Ok(Shown::AtMost(strands)),
        // Imported strands are numbered in the order of the file, and a preview may show any of them.
        (HairSource::Imported(_), Some(_)) => Ok(Shown::All),
        (HairSource::Grown(_), Some(largest)) => Ok(Shown::AtMost(strands.max(largest as usize + 1))),
    }
}
