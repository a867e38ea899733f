//! `nabiki run`: groom, simulate, draw.

use crate::args::Run;
use crate::export::{Exported, Exports};
use crate::failure::Failure;
use crate::film::{Film, Frames, Simulated};
use crate::opening::open;
use crate::place::Folders;
use crate::reel::Reel;
use crate::report::Report;

pub fn run(args: &Run, quiet: bool) -> Result<(), Failure> {
    let take = open(&args.scene, args.strands)?;
    let scene = &take.stage.scene;
    let mut folders = Folders::default();
    let mut reel = Reel::begin(&take, &scene.picture, &args.out, &scene.name(), &mut folders)?;
    let mut exports = Exports::begin(&args.export, &[], &take)?;
    let report = Report::new(&take, quiet);
    report.scene();
    report.swing();
    let simulation = take.simulation()?;
    let mut rehearsal = Simulated { take: &take, simulation: simulation.clone() };
    let frames = Simulated { take: &take, simulation };
    let mut frames = Exported { frames, take: &take, exports: &mut exports };
    let mut film = Film::new(&take, &scene.picture, &mut rehearsal, quiet)?;
    film.shoot(&mut frames, &mut reel)?;
    report.inside(frames.frame(scene.motion.frames)?);
    let mut written = reel.finish()?;
    written.extend(exports.finish()?);
    report.written(&written);
    Ok(())
}
