//! Moving hair for other programs, in any format. The ending of the name decides.

use std::path::{Path, PathBuf};

use glam::DAffine3;
use nabiki::Hair;
use nabiki_alembic::HairArchive;
use nabiki_exchange::{Export, FrameSink};
use nabiki_usd::{HairStage, LayerKind};

use crate::error::{Error, Result};
use crate::exchange;
use crate::joint_chains::JointChains;
pub use crate::joint_chains::{ChainOptions, Springs};
use crate::kind::extension;
use crate::point_cache::{Kind, PointCache};
use crate::point_texture::{self, PointTexture};

/// The endings, for messages.
pub const ENDINGS: &str = ".usd, .usda, .usdc, .abc, .glb, .exr, .pc2 or .mdd";

/// A format of moving hair.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Usd,
    Alembic,
    /// Chains of joints, and hair bound to them.
    Gltf,
    /// A vertex-animation texture, and the mesh that it moves.
    Texture,
    Points(Kind),
}

impl Format {
    fn of(path: &Path) -> Option<Self> {
        match extension(path).as_str() {
            _ if exchange::is_usd(path) => Some(Self::Usd),
            _ if exchange::is_alembic(path) => Some(Self::Alembic),
            "glb" => Some(Self::Gltf),
            "exr" => Some(Self::Texture),
            _ => Kind::of(path).map(Self::Points),
        }
    }
}

/// Whether the ending is one of moving hair.
pub fn is_moving(path: &Path) -> bool {
    Format::of(path).is_some()
}

/// Whether the file holds hair that other programs, and this one, can read as hair: USD and Alembic.
pub fn holds_hair(path: &Path) -> bool {
    matches!(Format::of(path), Some(Format::Usd | Format::Alembic))
}

/// Whether strands of this format begin at their roots. In others they run as in the file that the hair came from.
pub fn is_root_first(path: &Path) -> bool {
    matches!(Format::of(path), Some(Format::Gltf | Format::Texture))
}

/// Whether the file has chains of joints.
pub fn has_chains(path: &Path) -> bool {
    Format::of(path) == Some(Format::Gltf)
}

/// Whether the file names its unit and up axis, or has those of glTF, so that these must be known.
pub fn states_space(path: &Path) -> bool {
    matches!(Format::of(path), Some(Format::Usd | Format::Gltf | Format::Texture))
}

/// The files that are written together with `path`, and what each is.
pub fn companions(path: &Path) -> Vec<(PathBuf, &'static str)> {
    match Format::of(path) {
        Some(Format::Texture) => vec![
            (point_texture::mesh_path(path), "the mesh that the texture moves"),
            (point_texture::text_path(path), "how to use both"),
        ],
        _ => Vec::new(),
    }
}

/// All files that are written for `path`: itself, and its companions.
pub fn files(path: &Path) -> impl Iterator<Item = PathBuf> {
    std::iter::once(path.to_owned()).chain(companions(path).into_iter().map(|(file, _)| file))
}

/// Starts a file for moving hair, frame by frame. `layer` is the prim path of a groom, for a layer with only samples;
/// `chains` is for .glb, and its `cards` for .exr.
///
/// # Errors
/// Another ending, a layer for a format that has none, or an error of the disk.
pub fn sink<'a>(
    path: &Path,
    export: Export<'a>,
    layer: Option<&str>,
    chains: ChainOptions,
) -> Result<Box<dyn FrameSink + 'a>> {
    let named = |e: std::io::Error| Error::from(e).in_file(path);
    let refused = |what: String| Err(Error::new(what).in_file(path));
    match (Format::of(path), layer) {
        (Some(Format::Usd), layer) => {
            let kind = layer.map_or(LayerKind::Stage, |prim| LayerKind::Layer(prim.to_owned()));
            Ok(Box::new(HairStage::create(path, export, kind).map_err(named)?))
        }
        (Some(_), Some(_)) => refused(no_layers(path)),
        (Some(Format::Alembic), None) => Ok(Box::new(HairArchive::create(path, export).map_err(named)?)),
        (Some(Format::Gltf), None) => Ok(Box::new(JointChains::create(path, export, chains).map_err(named)?)),
        (Some(Format::Texture), None) => {
            Ok(Box::new(PointTexture::create(path, export, chains.half_width()).map_err(named)?))
        }
        (Some(Format::Points(kind)), None) => Ok(Box::new(PointCache::create(path, kind, export).map_err(named)?)),
        (None, _) => refused(format!("moving hair is written as {ENDINGS}")),
    }
}

/// Writes hair that does not move, with these export settings, below a head at `world_from_head` (cm).
///
/// # Errors
/// Errors of the disk.
pub fn write_still(path: &Path, export: Export<'_>, world_from_head: &DAffine3, chains: ChainOptions) -> Result<()> {
    let hair = export.hair;
    let mut sink = sink(path, export, None, chains)?;
    let named = |e: std::io::Error| Error::from(e).in_file(path);
    sink.frame(&hair.strands, world_from_head).map_err(named)?;
    sink.finish().map_err(named)?;
    Ok(())
}

/// Why this format takes no layer.
pub fn no_layers(path: &Path) -> String {
    let format = if exchange::is_alembic(path) { "Alembic".to_owned() } else { format!(".{}", extension(path)) };
    format!("{format} has no layers: write .usd, .usda or .usdc")
}

/// The least size (bytes) of a file with as many frames as the export says. `layer` is whether it has only samples.
pub fn least_bytes(path: &Path, export: &Export<'_>, layer: bool) -> u64 {
    let (points, frames) = (export.hair.strands.points().len() as u64, u64::from(export.frames));
    match Format::of(path) {
        // A texture of hair at rest is compressed to almost nothing; its mesh is not.
        Some(Format::Gltf | Format::Texture) => 12 * points,
        Some(Format::Points(_)) => 12 * points * frames,
        _ => exchange::least_bytes(path, export, frames, layer),
    }
}

/// Memory (bytes) that a file takes until all its frames are there, beyond what every format needs.
pub fn held_bytes(path: &Path, export: &Export<'_>, chains: ChainOptions) -> u64 {
    match Format::of(path) {
        Some(Format::Texture) => point_texture::held_bytes(export, chains.half_width()),
        _ => 0,
    }
}

/// Phrases about the data of `hair` that the format of `path` cannot store.
pub fn losses(path: &Path, hair: &Hair) -> Vec<String> {
    if holds_hair(path) {
        return exchange::losses(path, hair);
    }
    let at = &hair.attributes;
    let carried = [
        (at.width.is_some(), "widths"),
        (at.colour.is_some(), "colours by strand or point"),
        (at.root_uv.is_some() || at.point_uv.is_some(), "texture coordinates"),
        (at.group.is_some(), "groups"),
        (!at.other.is_empty(), "attributes of its own"),
    ];
    carried.into_iter().filter(|&(is_there, _)| is_there).map(|(_, name)| name.to_owned()).collect()
}
