//! From one hair format to another, a frame out of a cache, or all of it for other tools.

use std::path::{Path, PathBuf};

use nabiki::{Hair, Pose};
use nabiki_io::Axis;
use nabiki_io::cache::Reader;
use nabiki_io::exchange::{self, DeclaredSpace, MovingHair};
use nabiki_io::hair;
use nabiki_io::{Placement, Unit};

use crate::error::{Error, Result};
use crate::place;
use crate::scene::HairSettings;
use crate::told::Told;
use crate::watch::{Watch, each_frame};

/// What [`convert`] reads, writes, and what the input does not say itself.
#[derive(Clone, Debug, Default)]
pub struct ConvertOptions {
    /// A hair file or a motion cache.
    pub input: PathBuf,
    /// The file to write.
    pub output: PathBuf,
    /// This frame alone; without it all of a motion, or the one frame of a groom.
    pub frame: Option<u32>,
    /// Segments into which every strand is walked; without it as the file has them.
    pub segments: Option<usize>,
    /// Unit of the input, for a USD layer to name.
    pub unit: Option<Unit>,
    /// Whether z is up in the input, for a USD layer to name.
    pub z_up: bool,
    /// Prim path of the groom over which samples alone are laid.
    pub layer: Option<String>,
}

/// Reads hair of one format and writes it in another.
///
/// # Errors
/// An input that cannot be read, an output that cannot be written or would take the input's place.
pub fn convert(options: &ConvertOptions, watch: &mut dyn Watch) -> Result<()> {
    let output = options.output.as_path();
    place::file(output)?;
    place::not_inputs(&[output], std::slice::from_ref(&options.input))?;
    hair::losses(output, &Hair::default())?;
    if let Some(segments) = options.segments {
        HairSettings::check_segments("--segments", segments).map_err(|e| Error::refused(e.to_string()))?;
    }
    let to_tools = exchange::is_usd(output) || exchange::is_alembic(output);
    if is_cache(options) && options.frame.is_none() && to_tools {
        return cached_frames(options, watch);
    }
    if options.layer.is_some() {
        let line = "--export-layer is for all frames of a motion cache, into .usda or .usdc";
        return Err(Error::refused(format!("{}: {line}", options.input.display())));
    }
    if options.frame.is_none() && to_tools && exchange::frames(&options.input)? > 1 {
        return exchanged_frames(options, watch);
    }
    let (hair, pose) = read(options)?;
    let mut losses = if to_tools {
        exchange::write(output, &hair, said(options)?)?;
        exchange::losses(output, &hair)
    } else {
        hair::write(output, &hair)?
    };
    losses.extend(unsaid(options)?);
    if pose != Pose::STILL {
        let [x, y, z] = pose.position_cm.to_array();
        let (axis, angle) = pose.rotation.to_axis_angle();
        losses.push(format!(
            "the head's pose: the points are those of a head that stands still at the origin; in this frame it is at \
             ({x}, {y}, {z}) cm, turned by {:.2} degrees about ({:.3}, {:.3}, {:.3})",
            angle.to_degrees(),
            axis.x,
            axis.y,
            axis.z
        ));
    }
    finish(options, losses, format!("{} strands", hair.strands.len()), watch);
    Ok(())
}

fn finish(options: &ConvertOptions, losses: Vec<String>, holds: String, watch: &mut dyn Watch) {
    for what in losses {
        watch.told(Told::Lost { file: options.output.clone(), what });
    }
    watch.told(Told::Wrote { file: options.output.clone(), holds: Some(holds) });
}

fn is_cache(options: &ConvertOptions) -> bool {
    options.input.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("nabiki"))
}

/// Refuses a frame that the input does not reach.
fn check_frame(input: &Path, frame: u32, frames: u64) -> Result<()> {
    if u64::from(frame) < frames {
        return Ok(());
    }
    let has = match frames {
        1 => "this file holds one frame, 0".to_owned(),
        n => format!("this file holds the frames 0 to {}", n.saturating_sub(1)),
    };
    Err(Error::refused(format!("{}: --frame {frame}: {has}", input.display())))
}

/// The hair of one frame, and where the head is in it.
fn read(options: &ConvertOptions) -> Result<(Hair, Pose)> {
    let input = options.input.as_path();
    let (hair, pose) = if is_cache(options) {
        let Some(frame) = options.frame else {
            let line = "a motion cache holds many frames; say which with --frame N, or write .usdc, .usda or .abc";
            return Err(Error::refused(format!("{}: {line}", input.display())));
        };
        let mut cache = Reader::open(input)?;
        check_frame(input, frame, cache.frame_count())?;
        let pose = cache.read(frame.into(), &mut cache.header().strands())?;
        let hair = cache.hair(frame.into())?;
        let hair = match placement(&cache) {
            Some(placement) => hair.transformed(&placement.file_from_head()),
            None => hair,
        };
        (hair, pose)
    } else if exchange::is_usd(input) || exchange::is_alembic(input) {
        let frame = options.frame.unwrap_or(0);
        check_frame(input, frame, exchange::frames(input)? as u64)?;
        return Ok((exchange::hair(input, frame as usize, options.segments)?, Pose::STILL));
    } else {
        check_frame(input, options.frame.unwrap_or(0), 1)?;
        (hair::read(input)?, Pose::STILL)
    };
    let hair = match options.segments {
        Some(segments) => hair.resampled(segments + 1),
        None => hair,
    };
    Ok((hair, pose))
}

/// What the input says beside its hair and the output cannot: frames, unit and up axis.
fn unsaid(options: &ConvertOptions) -> Result<Vec<String>> {
    let input = options.input.as_path();
    let mut lost = Vec::new();
    let frames = exchange::frames(input)?;
    if frames > 1 {
        let kept = options.frame.unwrap_or(0);
        lost.push(format!("motion: it is frame {kept} of the {frames} in {}", input.display()));
    }
    let declared = if is_cache(options) { said(options)? } else { exchange::declared_space(input)? };
    lost.extend(unsaid_space(options, declared));
    Ok(lost)
}

/// Unit and up axis, where the output says nothing of them.
fn unsaid_space(options: &ConvertOptions, DeclaredSpace { unit, up }: DeclaredSpace) -> Vec<String> {
    if exchange::is_usd(&options.output) {
        return Vec::new();
    }
    let unit = unit.filter(|unit| unit.cm != 1.0);
    let up = up.filter(|&up| up != Axis::PlusY);
    let unit = unit.map(|unit| format!("its unit: give hair.unit = {} where it is read", unit.cm));
    unit.into_iter().chain(up.map(|up| format!("its up axis: give hair.up = \"{up}\" where it is read"))).collect()
}

/// Unit and up axis of the input: as it says itself, or else as the options do.
fn said(options: &ConvertOptions) -> Result<DeclaredSpace> {
    if is_cache(options) {
        let Placement { unit, up, .. } = placement(&Reader::open(&options.input)?).unwrap_or_default();
        return Ok(DeclaredSpace { unit: Some(unit), up: Some(up) });
    }
    let in_file = exchange::declared_space(&options.input)?;
    if let (Some(given), Some(stated)) = (options.unit, in_file.unit)
        && (given.cm - stated.cm).abs() > 1e-6 * stated.cm
    {
        return Err(Error::refused(format!(
            "{}: --unit {}: the file itself says {}; leave --unit out",
            options.input.display(),
            given.cm,
            stated.cm
        )));
    }
    let said = DeclaredSpace {
        unit: options.unit.or(in_file.unit),
        up: if options.z_up { Some(Axis::PlusZ) } else { in_file.up.or(Some(Axis::PlusY)) },
    };
    if said.unit.is_none() && exchange::is_usd(&options.output) {
        return Err(Error::refused(format!(
            "{}: its unit is not in the file and {} must name one: give --unit m, say",
            options.input.display(),
            options.output.display()
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
fn cached_frames(options: &ConvertOptions, watch: &mut dyn Watch) -> Result<()> {
    let output = options.output.as_path();
    let mut cache = Reader::open(&options.input)?;
    let hair = cache.hair(0)?;
    let placement = placement(&cache);
    let export = exchange::export(&hair, cache.header().frame_rate, placement.as_ref());
    let layer = options.layer.as_deref();
    if layer.is_some() {
        let in_file = cache.header().origin.map(|origin| origin.points);
        exchange::check_layer(in_file, hair.strands.points().len()).map_err(|e| e.in_file(output))?;
    }
    let failed = |e: std::io::Error| Error::from(nabiki_io::Error::from(e).in_file(output));
    let frames = cache.frame_count();
    place::room(output, frames * hair.strands.points().len() as u64 * 12, watch)?;
    let mut sink = exchange::sink(output, export, layer)?;
    let mut strands = cache.header().strands();
    // The header of a cache holds fewer frames than that.
    let last = u32::try_from(frames.saturating_sub(1)).unwrap_or(u32::MAX);
    each_frame(watch, "converting", 0..=last, |frame| {
        let pose = cache.read(frame.into(), &mut strands)?;
        sink.frame(&strands, &pose.world_from_head()).map_err(failed)
    })?;
    sink.finish().map_err(failed)?;
    let losses = exchange::losses(output, &hair).into_iter().chain(unsaid_space(options, said(options)?)).collect();
    finish(options, losses, format!("{frames} frames of {} strands", hair.strands.len()), watch);
    Ok(())
}

/// Every frame of a layer or archive as it is, in its own unit and axes.
fn exchanged_frames(options: &ConvertOptions, watch: &mut dyn Watch) -> Result<()> {
    let output = options.output.as_path();
    let mut moving = MovingHair::open(&options.input, options.segments)?;
    let (hair, declared) = (moving.hair().clone(), said(options)?);
    let mut export = moving.export(&hair);
    export.meters_per_unit = declared.unit.map_or(export.meters_per_unit, |unit| f64::from(unit.cm) / 100.0);
    export.z_up = declared.up == Some(Axis::PlusZ);
    let failed = |e: std::io::Error| Error::from(nabiki_io::Error::from(e).in_file(output));
    let frames = moving.frames() as u32;
    place::room(output, u64::from(frames) * hair.strands.points().len() as u64 * 12, watch)?;
    let mut sink = exchange::sink(output, export, None)?;
    each_frame(watch, "converting", 0..=frames - 1, |frame| {
        let (strands, world_from_hair) = moving.frame(frame as usize)?;
        sink.frame(&strands, &world_from_hair).map_err(failed)
    })?;
    sink.finish().map_err(failed)?;
    let losses = exchange::losses(output, &hair).into_iter().chain(unsaid_space(options, declared)).collect();
    finish(options, losses, format!("{frames} frames of {} strands", hair.strands.len()), watch);
    Ok(())
}
