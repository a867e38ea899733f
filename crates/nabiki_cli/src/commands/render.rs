//! `nabiki render`: a scene's pictures, moved by its own simulation or by a motion cache.

use nabiki_io::cache::Reader;

use crate::args::Render;
use crate::failure::Failure;
use crate::film::{Cached, Film, Frames, Simulated};
use crate::opening::open;
use crate::place::{self, Folders};
use crate::reel::{self, Reel};
use crate::report::Report;

pub fn render(args: &Render, quiet: bool) -> Result<(), Failure> {
    let take = open(&args.scene, args.strands)?;
    let scene = &take.stage.scene;
    let mut folders = Folders::default();
    let source = || -> Result<Box<dyn Frames + '_>, Failure> {
        match &args.motion {
            Some(cache) => Ok(Box::new(Cached::new(matching(Reader::open(cache)?, args, &take)?))),
            None => Ok(Box::new(Simulated { take: &take, simulation: take.simulation()? })),
        }
    };
    let film = || Film::new(&take, &scene.picture, source()?.as_mut(), quiet);
    let written = match args.frame {
        None => {
            let mut reel = Reel::begin(&take, &scene.picture, &args.out, &scene.name(), &mut folders)?;
            film()?.shoot(source()?.as_mut(), &mut reel)?;
            reel.finish()?
        }
        Some(frame) if frame <= scene.motion.frames => {
            let path = args.out.join(format!("{}_{frame:04}.png", scene.name()));
            folders.make(&args.out, reel::WAY_OUT)?;
            place::free(&path, reel::WAY_OUT)?;
            film()?.still(frame, source()?.as_mut(), &path)?;
            vec![path]
        }
        Some(frame) => {
            let last = scene.motion.frames;
            return Err(Failure::new(format!("--frame {frame}: the last frame is motion.frames = {last}")));
        }
    };
    Report::new(&take, quiet).written(&written);
    Ok(())
}

/// Refuses a cache of another scene, or one that ends too soon.
fn matching(reader: Reader, args: &Render, take: &nabiki_scene::Take) -> Result<Reader, Failure> {
    let file = args.motion.as_deref().unwrap_or(&args.scene.scene).display();
    let scene = args.scene.scene.display();
    if reader.header().scene != take.stage.identity()? {
        return Err(Failure::new(format!(
            "{file}: its motion was not made from {scene} as it is now; make it again with nabiki simulate"
        )));
    }
    let (last, given) = (u64::from(take.stage.scene.motion.frames), reader.frame_count());
    if given <= last {
        return Err(Failure::new(format!(
            "{file}: holds {given} frames and {scene} has {}; draw fewer with --frames {}",
            last + 1,
            given.saturating_sub(1)
        )));
    }
    Ok(reader)
}
