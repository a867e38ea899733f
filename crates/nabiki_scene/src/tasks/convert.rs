//! Conversion between hair formats, and of one frame or all frames of a motion cache.

use std::path::{Path, PathBuf};

use glam::DAffine3;
use nabiki::{Hair, Pose, SettingError, error::check_positive, strands::check_points};
use nabiki_io::Axis;
use nabiki_io::cache::{Origin, Reader};
use nabiki_io::exchange::{self, DeclaredSpace};
use nabiki_io::hair;
use nabiki_io::moving::{self, ChainOptions};
use nabiki_io::{CurvePrim, GroomFile, Placement, Unit};

use crate::advice::Advice;
use crate::error::{Error, Result};
use crate::exports;
use crate::place;
use crate::scene::{HairSettings, check_first_frame};
use crate::watch::{Watch, each_frame};

/// Options of [`convert`].
#[derive(Clone, Debug, Default)]
pub struct ConvertOptions {
    /// A hair file or a motion cache.
    pub input: PathBuf,
    /// The file to write.
    pub output: PathBuf,
    /// Only this frame. By default all frames of a motion, or the single frame of a groom.
    pub frame: Option<u32>,
    /// Number of segments of each strand. By default as in the file.
    pub segments: Option<usize>,
    /// Unit of the input, for the declaration in a USD layer. Refused if the input declares another.
    pub unit: Option<Unit>,
    /// Whether z is up in the input, for the declaration in a USD layer. Refused if the input declares otherwise.
    pub z_up: bool,
    /// Prim path of a groom, for a layer with only samples over it.
    pub layer: Option<String>,
    /// Number of the first frame on the output's timeline, instead of the input's.
    pub first_frame: Option<i32>,
    /// How hair is turned into chains of joints, for a .glb. Its cards are for an .exr, too.
    pub chains: ChainOptions,
}

/// Reads hair in one format and writes it in another.
///
/// # Errors
/// An input that cannot be read, or an output that cannot be written or would overwrite the input.
pub fn convert(options: &ConvertOptions, watch: &mut dyn Watch) -> Result<()> {
    check_output(options)?;
    let to_tools = moving::is_moving(&options.output);
    let moves = options.frame.is_none() && to_tools;
    let mut input = Input::open(&options.input)?;
    let frames = input.frames()?;
    if options.layer.is_some() && !(moves && matches!(input, Input::Cache(_))) {
        let line = "--export-layer is for all frames of a motion cache, into .usd, .usda or .usdc";
        return Err(Error::refused(format!("{}: {line}", options.input.display())));
    }
    if let (Input::Cache(_), Some(segments), true) = (&input, options.segments, moves) {
        let line = "--segments {}: all frames of a motion cache are written as they are stored; leave it out, or take one frame with --frame N";
        let line = line.replace("{}", &segments.to_string());
        return Err(Error::refused(format!("{}: {line}", options.input.display())));
    }
    if let (Some(first), false) = (options.first_frame, to_tools) {
        let line =
            format!("--first-frame {first}: this file has no time line; leave it out, or write {}", moving::ENDINGS);
        return Err(Error::refused(format!("{}: {line}", options.output.display())));
    }
    advise_space(options, watch);
    match input {
        Input::Cache(cache) if moves => cached_frames(options, *cache, watch),
        Input::Groom(groom) if moves && frames > 1 => exchanged_frames(options, groom, watch),
        input => one_frame(options, input, watch),
    }
}

/// Refuses outputs that cannot be written, or would overwrite something else, before the input is opened.
fn check_output(options: &ConvertOptions) -> Result<()> {
    let output = options.output.as_path();
    for file in moving::files(output) {
        place::file(&file)?;
        place::not_inputs(&[&file], std::slice::from_ref(&options.input))?;
    }
    if is_cache(output) {
        return Err(Error::refused(format!(
            "{}: a motion cache contains the simulated hair of a scene; to simulate hair of a file, name it in a scene as \
             hair.file and run nabiki simulate; to convert motion that the file already has, write .usd, .usda, .usdc or \
             .abc",
            output.display()
        )));
    }
    if !moving::is_moving(output) {
        hair::losses(output, &Hair::default())?;
    }
    options.chains.check().map_err(|why| Error::refused(format!("--export-chains, --export-cards: {why}")))?;
    check_space(options)?;
    if let Some(first) = options.first_frame {
        check_first_frame("--first-frame", first).map_err(|e| Error::refused(e.to_string()))?;
    }
    if let Some(segments) = options.segments {
        HairSettings::check_segments("--segments", segments).map_err(|e| Error::refused(e.to_string()))?;
    }
    Ok(())
}

/// Refuses an invalid unit, and a unit or axes for a cache, which declares its own.
fn check_space(options: &ConvertOptions) -> Result<()> {
    if let Some(unit) = options.unit {
        check_positive("--unit", unit.cm).map_err(|e| Error::refused(e.to_string()))?;
    }
    match given_space(options).next().filter(|_| is_cache(&options.input)) {
        None => Ok(()),
        Some(option) => {
            let (input, why) = (options.input.display(), "a motion cache knows its unit and axes");
            Err(Error::refused(format!("{input}: {option}: {why}; leave {option} out")))
        }
    }
}

/// The options for unit and axes.
fn given_space(options: &ConvertOptions) -> impl Iterator<Item = &'static str> {
    let all = [(options.unit.is_some(), "--unit"), (options.z_up, "--z-up")];
    all.into_iter().filter(|&(given, _)| given).map(|(_, option)| option)
}

/// Reports options without effect if the output cannot declare unit and axes.
fn advise_space(options: &ConvertOptions, watch: &mut dyn Watch) {
    if moving::states_space(&options.output) {
        return;
    }
    let output = options.output.display();
    let line = |option: &str| {
        format!("{option} changes nothing: {output} names neither unit nor axes, and no number is converted")
    };
    super::advise(given_space(options).map(|option| Advice::new(line(option))), watch);
}

fn is_cache(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("nabiki"))
}

/// The input, opened once.
enum Input {
    Cache(Box<Reader>),
    Groom(GroomFile),
}

impl Input {
    fn open(path: &Path) -> Result<Self> {
        Ok(if is_cache(path) {
            Self::Cache(Box::new(Reader::open(path)?))
        } else {
            Self::Groom(GroomFile::open(path)?)
        })
    }

    fn frames(&mut self) -> Result<u64> {
        match self {
            Self::Cache(cache) => Ok(cache.frame_count()),
            Self::Groom(groom) => Ok(groom.frames()? as u64),
        }
    }

    /// Unit and up axis of its points, as far as it declares them.
    fn declared_space(&mut self) -> Result<DeclaredSpace> {
        match self {
            Self::Cache(cache) => Ok(space_of(cache)),
            Self::Groom(groom) => Ok(groom.declared_space()?),
        }
    }

    /// The hair of one frame, and the pose of the head in it.
    fn read(&mut self, options: &ConvertOptions) -> Result<(Hair, Pose)> {
        let input = options.input.as_path();
        match self {
            Self::Cache(cache) => {
                let Some(frame) = options.frame else {
                    let line = format!(
                        "a motion cache has many frames; choose one with --frame N, or write {}",
                        moving::ENDINGS
                    );
                    return Err(Error::refused(format!("{}: {line}", input.display())));
                };
                check_frame(input, frame, cache.frame_count())?;
                let pose = cache.read(frame.into(), &mut cache.header().strands())?;
                let hair = cache.hair(frame.into())?.as_in_source();
                let hair = match placement(cache) {
                    Some(placement) => hair.transformed(&placement.file_from_head_in_doubles()),
                    None => hair,
                };
                let Some(segments) = options.segments else { return Ok((hair, pose)) };
                let refused = |e: SettingError| Error::refused(format!("{}: {e}", input.display()));
                check_points("--segments", segments, hair.strands.len()).map_err(refused)?;
                Ok((hair.resampled(segments + 1), pose))
            }
            Self::Groom(groom) => {
                let frame = options.frame.unwrap_or(0);
                check_frame(input, frame, groom.frames()? as u64)?;
                Ok((groom.hair(frame as usize, options.segments)?, Pose::STILL))
            }
        }
    }

    /// The number of the only frame written, on the timeline of the input, and the frame rate of that.
    fn number(&mut self, options: &ConvertOptions) -> Result<(i32, f64)> {
        let frame = options.frame.unwrap_or(0);
        let (first, rate) = match self {
            Self::Cache(cache) => (cache.header().first_frame, cache.header().frame_rate),
            Self::Groom(groom) => {
                let (start, rate) = (groom.start()?, groom.frame_rate()?);
                let first = start.map_or(0, |start| (start * rate).round() as i32);
                // Programs use an impossible number to say none.
                (if check_first_frame("", first).is_ok() { first } else { 0 }, rate)
            }
        };
        Ok((first.saturating_add_unsigned(frame), rate))
    }

    /// The transform of hair under `pose`, in the space of the file that it came from.
    fn world_from_hair(&self, pose: &Pose) -> DAffine3 {
        let Self::Cache(cache) = self else { return DAffine3::IDENTITY };
        let world_from_head = Origin::world_from_head(cache.header().origin.as_ref(), pose);
        let hair = Hair::default();
        let export = exchange::export(&hair, cache.header().frame_rate, placement(cache).as_ref());
        DAffine3::from_mat4(export.parent(&world_from_head))
    }

    /// Its motion, if only one frame of it is kept.
    fn lost_motion(&mut self, options: &ConvertOptions) -> Result<Option<String>> {
        let Self::Groom(groom) = self else { return Ok(None) };
        let (frames, kept) = (groom.frames()?, options.frame.unwrap_or(0));
        let input = options.input.display();
        Ok((frames > 1).then(|| format!("motion: only frame {kept} of the {frames} in {input} is kept")))
    }
}

/// Refuses a frame that the input does not have.
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

/// Hair that does not move, or one frame of it.
fn one_frame(options: &ConvertOptions, mut input: Input, watch: &mut dyn Watch) -> Result<()> {
    let output = options.output.as_path();
    let (hair, pose) = input.read(options)?;
    super::unread(&options.input, &hair.attributes.unread, watch);
    let to_tools = moving::is_moving(output);
    if !to_tools {
        place::room(output, hair::least_bytes(output, &hair)?, watch)?;
    }
    let declared = input.declared_space()?;
    let mut losses = if to_tools {
        let said = if let Input::Cache(_) = input { declared } else { said(options, declared)? };
        let (number, rate) = input.number(options)?;
        let mut export = exchange::still(&hair, said);
        (export.first_frame, export.frame_rate) = (options.first_frame.unwrap_or(number), rate);
        export.faces_x = matches!(&input, Input::Cache(cache) if placement(cache).is_none());
        place::room(output, moving::least_bytes(output, &export, false), watch)?;
        moving::write_still(output, export, &input.world_from_hair(&pose), options.chains)?;
        moving::losses(output, &hair)
    } else {
        hair::write(output, &hair)?
    };
    losses.extend(input.lost_motion(options)?);
    losses.extend(unsaid_space(options, declared));
    if pose != Pose::STILL && !to_tools {
        losses.push(lost_pose(&pose));
    }
    finish(options, losses, format!("{} strands", hair.strands.len()), watch);
    Ok(())
}

fn lost_pose(pose: &Pose) -> String {
    let [x, y, z] = pose.position_cm.to_array();
    let (axis, angle) = pose.rotation.to_axis_angle();
    format!(
        "the head's pose: the points are those of a head at the origin without rotation. In this frame it is at ({x}, {y}, \
         {z}) cm, turned by {:.2} degrees about ({:.3}, {:.3}, {:.3}). Use .usda, .usdc or .abc to keep the pose",
        angle.to_degrees(),
        axis.x,
        axis.y,
        axis.z
    )
}

fn finish(options: &ConvertOptions, losses: Vec<String>, holds: String, watch: &mut dyn Watch) {
    super::lost(&options.output, losses, watch);
    let companions = moving::companions(&options.output).into_iter().map(|(file, is)| (file, is.to_owned()));
    let written = std::iter::once((options.output.clone(), holds)).chain(companions);
    super::wrote_with(written.map(|(file, holds)| (file, Some(holds))), watch);
}

/// Unit and up axis, if the output cannot declare them.
fn unsaid_space(options: &ConvertOptions, DeclaredSpace { unit, up }: DeclaredSpace) -> Vec<String> {
    if moving::states_space(&options.output) {
        return Vec::new();
    }
    let unit = unit.filter(|unit| unit.cm != 1.0);
    let up = up.filter(|&up| up != Axis::PlusY);
    let unit = unit.map(|unit| format!("its unit: set hair.unit = {} when you read it", unit.cm));
    unit.into_iter().chain(up.map(|up| format!("its up axis: set hair.up = \"{up}\" when you read it"))).collect()
}

/// Unit and up axis of the input: as it declares, or else from the options.
fn said(options: &ConvertOptions, in_file: DeclaredSpace) -> Result<DeclaredSpace> {
    if let (Some(given), Some(stated)) = (options.unit, in_file.unit)
        && (given.cm - stated.cm).abs() > 1e-6 * stated.cm
    {
        return Err(Error::refused(format!(
            "{}: --unit {}: the file already has {stated}; leave out --unit",
            options.input.display(),
            // As typed: a name, or a bare number.
            given.to_string().trim_end_matches(" cm"),
        )));
    }
    // Alembic's unit is a convention, and not in the file.
    let stated_up = in_file.up.filter(|_| exchange::is_usd(&options.input));
    if let Some(up) = stated_up.filter(|&up| options.z_up && up != Axis::PlusZ) {
        let input = options.input.display();
        return Err(Error::refused(format!("{input}: --z-up: the file already has {up}; leave out --z-up")));
    }
    let said = DeclaredSpace {
        unit: options.unit.or(in_file.unit),
        up: if options.z_up { Some(Axis::PlusZ) } else { in_file.up.or(Some(Axis::PlusY)) },
    };
    if said.unit.is_none() && moving::states_space(&options.output) {
        return Err(Error::refused(format!(
            "{}: its unit is not in the file, but {} must name one: give --unit, for example --unit m",
            options.input.display(),
            options.output.display()
        )));
    }
    Ok(said)
}

/// The file of imported hair, to whose space it returns.
fn placement(cache: &Reader) -> Option<Placement> {
    cache.header().origin.as_ref().map(|origin| origin.placement)
}

/// The space of that file; for grown hair, centimetres, y up.
fn space_of(cache: &Reader) -> DeclaredSpace {
    let Placement { unit, up, .. } = placement(cache).unwrap_or_default();
    DeclaredSpace { unit: Some(unit), up: Some(up) }
}

/// The curves that a layer covers. Refuses a groom that is not known to be the one of the cache.
fn under_layer<'c>(options: &ConvertOptions, prim: &str, cache: &'c Reader) -> Result<&'c CurvePrim> {
    let header = cache.header();
    let points = header.starts.last().map_or(0, |&n| n as usize);
    let fits = |in_file| exchange::check_layer(in_file, points).map_err(|e| e.in_file(&options.output));
    let origin = header.origin.as_ref();
    fits(origin.map(|origin| origin.points))?;
    let Some(origin) = origin else { return Err(Error::refused("--export-layer: grown hair has no groom")) };
    let curves = origin.groom.under_layer(prim)?;
    // Curves of a single point are not read.
    fits(Some(curves.points))?;
    Ok(curves)
}

/// Every frame of a cache below the moving head, in the space of the hair's file; grown hair is in centimetres, y up.
fn cached_frames(options: &ConvertOptions, mut cache: Reader, watch: &mut dyn Watch) -> Result<()> {
    let output = options.output.as_path();
    let layer = options.layer.as_deref();
    let curves = layer.map(|prim| under_layer(options, prim, &cache).cloned()).transpose()?;
    let mut hair = cache.hair(0)?;
    let tip_first = hair.attributes.tip_first.clone().filter(|_| !moving::is_root_first(output));
    if tip_first.is_some() {
        hair = hair.as_in_source();
    }
    let origin = cache.header().origin.clone();
    let placement = placement(&cache);
    let mut export = exchange::export(&hair, cache.header().frame_rate, placement.as_ref());
    export.first_frame = options.first_frame.unwrap_or(cache.header().first_frame);
    if let Some(curves) = &curves {
        exchange::under_groom(&mut export, curves);
    }
    let failed = |e: std::io::Error| Error::from(nabiki_io::Error::from(e).in_file(output));
    let frames = cache.frame_count();
    export.frames = u32::try_from(frames).unwrap_or(u32::MAX);
    let mut sink = exports::sink(output, export, layer, options.chains, watch)?;
    let mut strands = cache.header().strands();
    // The header of a cache has fewer frames than that.
    let last = u32::try_from(frames.saturating_sub(1)).unwrap_or(u32::MAX);
    let mut head_moves = false;
    each_frame(watch, "converting", 0..=last, |frame| {
        let pose = cache.read(frame.into(), &mut strands)?;
        head_moves |= pose != Pose::STILL;
        strands.turn(tip_first.as_deref().unwrap_or_default());
        sink.frame(&strands, &Origin::world_from_head(origin.as_ref(), &pose)).map_err(failed)
    })?;
    let holds = sink.finish().map_err(failed)?;
    let mut losses: Vec<String> =
        moving::losses(output, &hair).into_iter().chain(unsaid_space(options, space_of(&cache))).collect();
    if let Some(curves) = &curves {
        losses.extend(exchange::layer_losses(curves, head_moves));
    }
    finish(
        options,
        losses,
        holds.unwrap_or_else(|| format!("{frames} frames of {} strands", hair.strands.len())),
        watch,
    );
    Ok(())
}

/// Every frame of a layer or archive unchanged, in its own unit and axes.
fn exchanged_frames(options: &ConvertOptions, mut groom: GroomFile, watch: &mut dyn Watch) -> Result<()> {
    let output = options.output.as_path();
    let in_file = groom.declared_space()?;
    let mut moving = groom.moving(options.segments)?;
    let hair = moving.hair().clone();
    super::unread(&options.input, &hair.attributes.unread, watch);
    let declared = said(options, in_file)?;
    let mut export = moving.export(&hair);
    export.first_frame = options.first_frame.unwrap_or(export.first_frame);
    export.meters_per_unit = declared.unit.map_or(export.meters_per_unit, Unit::metres);
    export.z_up = declared.up == Some(Axis::PlusZ);
    let failed = |e: std::io::Error| Error::from(nabiki_io::Error::from(e).in_file(output));
    let frames = moving.frames() as u32;
    export.frames = frames;
    let mut sink = exports::sink(output, export, None, options.chains, watch)?;
    each_frame(watch, "converting", 0..=frames - 1, |frame| {
        let (strands, world_from_hair) = moving.frame(frame as usize)?;
        if strands.starts() != hair.strands.starts() {
            let [now, first] =
                [&strands, &hair.strands].map(|s| format!("{} points of {} strands", s.points().len(), s.len()));
            let way_out = "the number of strands must not change: take one frame with --frame N, or export only strands that all frames have";
            let input = options.input.display();
            return Err(Error::refused(format!("{input}: frame {frame} has {now}, frame 0 {first}: {way_out}")));
        }
        sink.frame(&strands, &world_from_hair).map_err(failed)
    })?;
    let holds = sink.finish().map_err(failed)?;
    let losses = moving::losses(output, &hair).into_iter().chain(unsaid_space(options, declared)).collect();
    finish(
        options,
        losses,
        holds.unwrap_or_else(|| format!("{frames} frames of {} strands", hair.strands.len())),
        watch,
    );
    Ok(())
}
