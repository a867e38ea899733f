//! Writes a scene to start from.

use std::ops::Range;
use std::path::{Path, PathBuf};

use glam::Vec3;
use nabiki::Hair;
use nabiki_io::motion::{self, ClipMover};
use nabiki_io::{exchange, mesh};
use nabiki_render::settings::{HairLook, Picture};

use crate::advice::Advice;
use crate::built::{BuiltScene, Shown};
use crate::error::{Error, Result};
use crate::place;
use crate::scene::{HeadSource, ImportedHead, Scene};
use crate::size::decimal;
use crate::template::{Template, template};
use crate::told::Told;
use crate::watch::Watch;

/// Number of strands that show whether a new scene can be built.
const TRIED: usize = 50;

/// Vertices inside the head ellipsoid, or outside it up to this value of its function, belong to the skull.
const SKULL: f32 = 0.3;

/// Most clips that are listed.
const MOST_NAMED: usize = 6;

/// Options of [`new`].
#[derive(Clone, Debug, Default)]
pub struct NewOptions {
    /// The head's mesh. By default the built-in bust.
    pub head: Option<PathBuf>,
    /// Groups of the head's file to keep. If empty, all.
    pub groups: Vec<String>,
    /// The hair's file. By default, hair is grown.
    pub hair: Option<PathBuf>,
    /// Whether to replace an existing scene.
    pub replace: bool,
}

/// Writes a commented scene that runs unchanged, and reports its guesses.
///
/// # Errors
/// A file that cannot be read, a head without a skull, a name that does not end in .toml, or a place that is taken or
/// cannot be written.
pub fn new(path: &Path, options: &NewOptions, watch: &mut dyn Watch) -> Result<()> {
    if !options.replace && std::fs::symlink_metadata(path).is_ok() {
        let what = "is there already; choose another name, or replace it with --force";
        return Err(Error::place(path, what, std::io::ErrorKind::AlreadyExists));
    }
    place::scene(path)?;
    let inputs: Vec<PathBuf> = options.head.iter().chain(&options.hair).cloned().collect();
    place::not_inputs(&[path], &inputs)?;
    super::reading(inputs, watch);
    let mut template = template(path, options.head.as_deref(), &options.groups, options.hair.as_deref())?;
    // For grown hair a few strands suffice; in a file any may be the shortest.
    let tried = if options.hair.is_some() { Shown::All } else { Shown::AtMost(TRIED) };
    let mut built = Scene::parse(&template.text, path, &[])?.build(tried)?;
    built.simulation()?;
    let mut still = None;
    if let Some(Mover { motion, how }) = mover(&built)? {
        match moving(&template, &built, &motion, path, tried) {
            Ok(moves) => {
                (template, built) = moves;
                template.guesses.push(format!("head.motion, {how}"));
            }
            Err(e) => {
                still = Some(Advice::new(format!("the head does not move here, because {how}, cannot be used: {e}")))
            }
        }
    }
    if let Some([root, tip]) = options.hair.as_ref().and_then(|_| thickness(&built.groom.hair)) {
        // Equally thick to the tip, or thinner along the whole strand.
        let thins =
            if tip < 0.95 { format!(", tip = {}, taper = 1.0", decimal(tip, 2)) } else { ", tip = 1.0".to_owned() };
        let look = format!("{{ width = {}{thins} }}", decimal(root, 2));
        template.text += &format!("hair = {look}   # as thick as in its file (cm)\n");
        template.guesses.push(format!("picture.hair = {look}, as thick as the hair of the file"));
    }
    nabiki_file::write(path, template.text.as_bytes()).map_err(|e| nabiki_io::Error::from(e).in_file(path))?;
    if let Some(file) = &options.hair {
        super::unread(file, &built.groom.hair.attributes.unread, watch);
    }
    if let Some(file) = &options.head {
        let of_hair = options.hair.as_ref().map(|_| &built.groom.hair.attributes.unread[..]).unwrap_or_default();
        let unread: Vec<String> = built.unread_of_head().into_iter().filter(|line| !of_hair.contains(line)).collect();
        super::unread(file, &unread, watch);
    }
    let turned = built.groom.imported.as_ref().and_then(|imported| imported.report.turned());
    template.guesses.extend(turned.map(|line| format!("hair.root, by the skin: {line}")));
    template.guesses.into_iter().for_each(|guess| watch.told(Told::Guessed(guess)));
    built.advice().into_iter().chain(still).for_each(|advice| watch.told(Told::Advice(advice)));
    super::wrote(vec![path.to_owned()], watch);
    Ok(())
}

/// What moves the head in its own file.
struct Mover {
    /// `head.motion`, in TOML.
    motion: String,
    /// How it was found.
    how: String,
}

fn mover(built: &BuiltScene) -> Result<Option<Mover>> {
    let HeadSource::Imported(head) = &built.scene.head.source else { return Ok(None) };
    let file = built.scene.resolve(&head.mesh);
    if mesh::is_gltf(&file) || mesh::is_fbx(&file) {
        return mover_of_clip(built, head, &file);
    }
    let Some(node) = exchange::mover_of_mesh(&file, &head.groups)? else { return Ok(None) };
    // An archive does not declare its unit.
    let unit = if exchange::is_alembic(&head.mesh) {
        format!(", unit_cm = {}", built.model.placement.unit.cm)
    } else {
        String::new()
    };
    let how = format!("{node}, which moves the head in {}", head.mesh.display());
    Ok(Some(Mover { motion: motion_of(built, head, &node, &unit), how }))
}

/// The same for a head in a glTF or FBX file: its skull may be carried by a joint of its skin.
fn mover_of_clip(built: &BuiltScene, head: &ImportedHead, file: &Path) -> Result<Option<Mover>> {
    let place = built.model.placement.head_from_file();
    let is_skull = |p: Vec3| built.model.head.ellipsoid.value(place.transform_point3(p)) <= SKULL;
    let Some(ClipMover { node, clip, clips }) = motion::clip_mover(file, &head.groups, &is_skull)? else {
        return Ok(None);
    };
    let of_clip = if clip.is_empty() { String::new() } else { format!(", clip = {}", word(&clip)) };
    let more = if clips.len() > MOST_NAMED { ", .." } else { "" };
    let named_clips = clips.iter().take(MOST_NAMED).cloned().collect::<Vec<_>>().join(", ");
    let others = match clips.len() {
        0 | 1 => String::new(),
        count => format!(" in {count} clips ({named_clips}{more})"),
    };
    let how = format!("{node}, which moves the head in {}{others}", head.mesh.display());
    Ok(Some(Mover { motion: motion_of(built, head, &node, &of_clip), how }))
}

/// The value of `head.motion` for a node of the head's own file, with `more` settings.
fn motion_of(built: &BuiltScene, head: &ImportedHead, node: &str, more: &str) -> String {
    let (file, facing) = (word(&head.mesh.display().to_string()), built.model.placement.facing);
    format!("{{ file = {file}, node = {}{more}, facing = \"{facing}\", bind_at_start = true }}", word(node))
}

fn word(text: &str) -> toml::Value {
    toml::Value::String(text.to_owned())
}

/// The scene with the head's motion, as long as that lasts. `still`: built without it.
fn moving(
    template: &Template,
    still: &BuiltScene,
    motion: &str,
    path: &Path,
    shown: Shown,
) -> Result<(Template, BuiltScene)> {
    let first = still.changed_to(Scene::parse(&template.moving(motion, 1).text, path, &[])?, shown)?;
    let template = template.moving(motion, first.way.poses.len().saturating_sub(1).max(1));
    let built = first.changed_to(Scene::parse(&template.text, path, &[])?, shown)?;
    built.simulation()?;
    Ok((template, built))
}

/// Typical width of a file's hair at the roots (cm), and at the tips as a part of that; none if the file has no widths,
/// or unusable ones.
fn thickness(hair: &Hair) -> Option<[f32; 2]> {
    let median = |mut all: Vec<f32>| {
        all.sort_unstable_by(f32::total_cmp);
        all.get(all.len() / 2).copied()
    };
    let attributes = &hair.attributes;
    let [root, tip] = match (&attributes.width, attributes.constant.width) {
        (Some(width), _) => {
            let ends = |end: fn(Range<usize>) -> usize| {
                median((0..hair.strands.len()).map(|s| width[end(hair.strands.range(s))]).collect())
            };
            [ends(|points| points.start)?, ends(|points| points.end - 1)?]
        }
        (None, constant) => [constant?; 2],
    };
    let hair = HairLook { width: root, ..HairLook::default() };
    Picture { hair, ..Picture::default() }.check().is_ok().then(|| [root, (tip / root).clamp(0.0, 1.0)])
}
