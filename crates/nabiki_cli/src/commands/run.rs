//! `nabiki run`: groom, simulate, draw.

use crate::args::Run;
use crate::export::{Exported, Exports};
use crate::failure::Failure;
use crate::film::{Film, Frames, Simulated};
use crate::opening::{folder, open};
use crate::report::Report;

pub fn run(args: &Run, quiet: bool) -> Result<(), Failure> {
    let take = open(&args.scene, args.strands)?;
    folder(&args.out)?;
    let report = Report::new(&take, quiet);
    report.scene();
    report.swing();
    let simulation = take.simulation()?;
    let mut rehearsal = Simulated { take: &take, simulation: simulation.clone() };
    let mut exports = Exports::begin(&args.export, &take)?;
    let frames = Simulated { take: &take, simulation };
    let mut frames = Exported { frames, take: &take, exports: &mut exports };
    let scene = &take.stage.scene;
    let mut film = Film::new(&take, &scene.picture, &mut rehearsal, quiet)?;
    let mut written = film.shoot(&mut frames, &args.out, &scene.name())?;
    report.inside(frames.frame(scene.motion.frames)?);
    written.extend(exports.finish()?);
    report.written(&written);
    Ok(())
}
