//! `nabiki preview`: a few strands, at once, that move exactly as they will among all.

use nabiki_render::Picture;

use crate::args::Preview;
use crate::failure::Failure;
use crate::film::{Film, Simulated};
use crate::opening::open_first;
use crate::place::Folders;
use crate::reel::Reel;
use crate::report::Report;

/// Longer side of a preview's frames (pixels).
const LONGER_SIDE: u32 = 480;

pub fn preview(args: &Preview, quiet: bool) -> Result<(), Failure> {
    let take = open_first(&args.scene, args.strands)?;
    let (all, shown) = (take.stage.whole, take.stage.hair.strands.len());
    let scene = &take.stage.scene;
    let picture = small(&scene.picture, all as f32 / shown as f32);
    let mut folders = Folders::default();
    let mut reel = Reel::begin(&take, &picture, &args.out, &format!("{}_preview", scene.name()), &mut folders)?;
    let report = Report::new(&take, quiet);
    report.scene();
    report.swing();
    let simulation = take.simulation()?;
    let mut rehearsal = Simulated { take: &take, simulation: simulation.clone() };
    let mut film = Film::new(&take, &picture, &mut rehearsal, quiet)?;
    let mut frames = Simulated { take: &take, simulation };
    film.shoot(&mut frames, &mut reel)?;
    report.written(&reel.finish()?);
    Ok(())
}

/// A smaller picture of thicker hair: each strand stands for `share` of them, but is not drawn as thick as rope.
fn small(picture: &Picture, share: f32) -> Picture {
    let mut small = picture.clone();
    let factor = (LONGER_SIDE as f32 / picture.size[0].max(picture.size[1]) as f32).min(1.0);
    small.size = picture.size.map(|side| ((side as f32 * factor).round() as u32 & !1).max(16));
    small.hair.width *= share.sqrt().min(8.0);
    small
}
