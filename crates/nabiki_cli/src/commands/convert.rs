//! `nabiki convert`: from one hair format to another, a frame out of a cache, or all of it for other tools.

use glam::Affine3A;
use nabiki::Hair;
use nabiki::export::Export;
use nabiki_io::cache::Reader;
use nabiki_io::exchange::{self, Said};
use nabiki_io::hair;
use nabiki_io::motion::Axis;
use nabiki_io::placement::Unit;

use crate::args::Convert;
use crate::failure::Failure;
use crate::progress;

pub fn convert(args: &Convert, quiet: bool) -> Result<(), Failure> {
    let to_tools = exchange::is_usd(&args.output) || exchange::is_alembic(&args.output);
    if is_cache(args) && args.frame.is_none() && to_tools {
        return all_frames(args, quiet);
    }
    let hair = read(args)?;
    let losses = if to_tools {
        exchange::write(&args.output, &hair, said(args)?)?;
        exchange::losses(&hair)
    } else {
        hair::write(&args.output, &hair)?
    };
    if !quiet {
        for loss in losses {
            println!("{} cannot hold {loss}", args.output.display());
        }
        println!("wrote {}: {} strands", args.output.display(), hair.strands.len());
    }
    Ok(())
}

fn is_cache(args: &Convert) -> bool {
    args.input.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("nabiki"))
}

fn read(args: &Convert) -> Result<Hair, Failure> {
    let from_tools = exchange::is_usd(&args.input) || exchange::is_alembic(&args.input);
    let line = |text: &str| Failure::new(format!("{}: {text}", args.input.display()));
    let hair = match (is_cache(args), args.frame) {
        (true, Some(frame)) => Reader::open(&args.input)?.hair(frame.into())?,
        (true, None) => return Err(line("a motion cache holds many frames; say which with --frame N")),
        (false, frame) if from_tools => {
            return Ok(exchange::hair(&args.input, frame.unwrap_or(0) as usize, args.segments)?);
        }
        (false, None) => hair::read(&args.input)?,
        (false, Some(frame)) => {
            return Err(line(&format!("--frame {frame} is for moving hair; this file holds one frame")));
        }
    };
    Ok(match args.segments {
        Some(segments) => hair.resampled(segments + 1),
        None => hair,
    })
}

/// Unit and up axis of the input: as it says itself, or else as the command line does.
fn said(args: &Convert) -> Result<Said, Failure> {
    if is_cache(args) {
        return Ok(Said { unit: Some(Unit { cm: 1.0 }), up: Some(Axis::PlusY) });
    }
    let in_file = exchange::said(&args.input)?;
    let said = Said {
        unit: args.unit.or(in_file.unit),
        up: if args.z_up { Some(Axis::PlusZ) } else { in_file.up.or(Some(Axis::PlusY)) },
    };
    if said.unit.is_none() && exchange::is_usd(&args.output) {
        return Err(Failure::new(format!(
            "{}: its unit is not in the file and {} must name one: give --unit m, say",
            args.input.display(),
            args.output.display()
        )));
    }
    Ok(said)
}

/// Every frame of a cache, in centimetres and y up, below the moving head.
fn all_frames(args: &Convert, quiet: bool) -> Result<(), Failure> {
    let mut cache = Reader::open(&args.input)?;
    let hair = cache.hair(0)?;
    let failed = |e: std::io::Error| Failure::new(format!("{}: {e}", args.output.display()));
    let mut sink = exchange::sink(&args.output, Export::new(&hair, cache.header().frame_rate), None)?;
    let mut strands = cache.header().strands();
    let frames = cache.frame_count();
    let bar = progress::bar(frames, "converting", quiet);
    for frame in 0..frames {
        let pose = cache.read(frame, &mut strands)?;
        let world_from_head = Affine3A::from_rotation_translation(pose.rotation, pose.position_cm);
        sink.frame(&strands, &world_from_head).map_err(failed)?;
        bar.inc(1);
    }
    bar.finish_and_clear();
    sink.finish().map_err(failed)?;
    if !quiet {
        println!("wrote {}: {frames} frames of {} strands", args.output.display(), hair.strands.len());
    }
    Ok(())
}
