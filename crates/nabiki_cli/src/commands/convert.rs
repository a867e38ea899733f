//! `nabiki convert`: from one hair format to another, a frame out of a cache, or all of it for other tools.

use glam::Affine3A;
use nabiki::Hair;
use nabiki_io::Error;
use nabiki_io::cache::Reader;
use nabiki_io::exchange::{self, Coordinates};
use nabiki_io::hair;
use nabiki_io::motion::Axis;
use nabiki_io::placement::Placement;

use crate::args::Convert;
use crate::failure::Failure;
use crate::place;
use crate::progress;
use crate::say::say;

pub fn convert(args: &Convert, quiet: bool) -> Result<(), Failure> {
    place::file(&args.output)?;
    let to_tools = exchange::is_usd(&args.output) || exchange::is_alembic(&args.output);
    if is_cache(args) && args.frame.is_none() && to_tools {
        return all_frames(args, quiet);
    }
    if args.export_layer.is_some() {
        let line = "--export-layer is for all frames of a motion cache, into .usda or .usdc";
        return Err(Failure::new(format!("{}: {line}", args.input.display())));
    }
    let hair = read(args)?;
    let mut losses = if to_tools {
        exchange::write(&args.output, &hair, said(args)?)?;
        exchange::losses(&args.output, &hair)
    } else {
        hair::write(&args.output, &hair)?
    };
    losses.extend(unsaid(args)?);
    if !quiet {
        for loss in losses {
            say!("{} cannot hold {loss}", args.output.display());
        }
        say!("wrote {}: {} strands", args.output.display(), hair.strands.len());
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
        (true, Some(frame)) => {
            let mut cache = Reader::open(&args.input)?;
            let hair = cache.hair(frame.into())?;
            match placement(&cache) {
                Some(placement) => hair.transformed(&placement.file_from_head()),
                None => hair,
            }
        }
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

/// What the input says beside its hair and the output cannot: frames, unit and up axis.
fn unsaid(args: &Convert) -> Result<Vec<String>, Failure> {
    let mut lost = Vec::new();
    if exchange::is_usd(&args.input) || exchange::is_alembic(&args.input) {
        let frames = exchange::frames(&args.input)?;
        if frames > 1 {
            let kept = (args.frame.unwrap_or(0) as usize).min(frames - 1);
            lost.push(format!("motion: it is frame {kept} of the {frames} in {}", args.input.display()));
        }
    }
    let Coordinates { unit, up } = if is_cache(args) { said(args)? } else { exchange::coordinates(&args.input)? };
    if let Some(unit) = unit.filter(|unit| unit.cm != 1.0 && !exchange::is_usd(&args.output)) {
        lost.push(format!("its unit: give hair.unit = {} where it is read", unit.cm));
    }
    if let Some(up) = up.filter(|&up| up != Axis::PlusY && !exchange::is_usd(&args.output)) {
        lost.push(format!("its up axis: give hair.up = \"{up}\" where it is read"));
    }
    Ok(lost)
}

/// Unit and up axis of the input: as it says itself, or else as the command line does.
fn said(args: &Convert) -> Result<Coordinates, Failure> {
    if is_cache(args) {
        let Placement { unit, up, .. } = placement(&Reader::open(&args.input)?).unwrap_or_default();
        return Ok(Coordinates { unit: Some(unit), up: Some(up) });
    }
    let in_file = exchange::coordinates(&args.input)?;
    let said = Coordinates {
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

/// Where imported hair came from, and goes back to.
fn placement(cache: &Reader) -> Option<Placement> {
    cache.header().origin.map(|origin| origin.placement)
}

/// Every frame of a cache below the moving head, in the space of the file that the hair came from; hair that was grown
/// is in centimetres, y up.
fn all_frames(args: &Convert, quiet: bool) -> Result<(), Failure> {
    let mut cache = Reader::open(&args.input)?;
    let hair = cache.hair(0)?;
    let placement = placement(&cache);
    let export = exchange::export(&hair, cache.header().frame_rate, placement.as_ref());
    let layer = args.export_layer.as_deref();
    if layer.is_some() {
        let in_file = cache.header().origin.map(|origin| origin.points);
        exchange::check_layer(in_file, hair.strands.points().len()).map_err(|e| e.in_file(&args.output))?;
    }
    let failed = |e: std::io::Error| Error::from(e).in_file(&args.output);
    let mut sink = exchange::sink(&args.output, export, layer)?;
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
        for loss in exchange::losses(&args.output, &hair).into_iter().chain(unsaid(args)?) {
            say!("{} cannot hold {loss}", args.output.display());
        }
        say!("wrote {}: {frames} frames of {} strands", args.output.display(), hair.strands.len());
    }
    Ok(())
}
