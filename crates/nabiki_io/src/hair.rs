//! Hair files of any format. The ending of the name decides.

use std::path::Path;

use nabiki::{Hair, SettingError, error::check_range, hair::Degenerate, strands::not_finite};
use nabiki_exchange::InPlace;
use nabiki_file::PartFile;
use serde::Serialize;

use crate::{
    error::{Error, Result},
    exchange,
    groom_file::GroomFile,
    hair_file,
    placement::Placement,
    tfx,
};

pub use crate::hair_format::Format;

/// The results of an import, before and after cleaning.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct ImportReport {
    /// Strands in the file.
    pub strands_in_file: usize,
    /// Points in the file.
    pub points_in_file: usize,
    /// Points that were joined, and strands that were dropped because nothing was left of them.
    pub degenerate: Degenerate,
    /// Strands dropped because they are shorter than [`Cleaning::drop_shorter_than`].
    pub dropped_short: usize,
    /// Remaining strands that the file stores tip first and that were reversed.
    pub tip_first: usize,
    /// Remaining strands whose tips are fixed in the file as well as their roots. The motion fixes only roots: these
    /// tips swing.
    pub held_at_both_ends: usize,
}

impl ImportReport {
    /// A line for the user about reversed strands, if there are any.
    pub fn turned(&self) -> Option<String> {
        let count = self.tip_first;
        (count > 0).then(|| format!("reversed {count} strands that run from tip to root in the file"))
    }

    /// A line for the user about data of the file that the motion ignores, if there is any.
    pub fn warning(&self) -> Option<String> {
        let count = self.held_at_both_ends;
        (count > 0).then(|| format!("{count} strands are held at both ends in the file; here their tips swing freely"))
    }
}

/// Strands whose tips are held, by TressFX's flag or weight, as well as their roots.
pub(crate) fn held_at_both_ends(hair: &Hair) -> usize {
    let Some(inverse_mass) = &hair.attributes.inverse_mass else { return 0 };
    let ranges = (0..hair.strands.len()).map(|s| hair.strands.range(s)).filter(|range| range.len() > 1);
    ranges.filter(|range| inverse_mass[range.start] == 0.0 && inverse_mass[range.end - 1] == 0.0).count()
}

/// Which parts of imported hair are removed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cleaning {
    /// Adjacent points of a strand at most this far apart are joined (cm, default 0.001). 0 joins only points at the
    /// same position, between which a strand has no direction.
    pub join_within: f32,
    /// Strands shorter than this are dropped (cm, default 0: none).
    pub drop_shorter_than: f32,
}

impl Default for Cleaning {
    fn default() -> Self {
        Self { join_within: 0.001, drop_shorter_than: 0.0 }
    }
}

impl Cleaning {
    /// Refuses negative and infinite lengths.
    pub fn check(&self) -> Result<(), SettingError> {
        check_range("hair.join_within", self.join_within, 0.0, f32::MAX)?;
        check_range("hair.drop_shorter_than", self.drop_shorter_than, 0.0, f32::MAX)
    }
}

/// Reads a file unchanged: all strands, in its unit and axes.
pub fn read(path: &Path) -> Result<Hair> {
    GroomFile::open(path)?.hair(0, None)
}

/// Reads a file into head space. Degenerate parts are removed and counted.
pub fn import(path: &Path, placement: &Placement, cleaning: &Cleaning) -> Result<(Hair, ImportReport)> {
    let named = |e: Error| e.in_file(path);
    placement.check("hair").map_err(|e| Error::from(e).in_file(path))?;
    cleaning.check().map_err(|e| Error::from(e).in_file(path))?;
    place_and_clean(GroomFile::open(path)?.hair_in_place(0, None)?, placement, cleaning).map_err(named)
}

/// Coordinates of hair beyond this are a wrong unit: ten thousand kilometres (cm).
const FARTHEST: f32 = 1e9;

/// Like [`import`], for hair that was read by this crate or another.
pub fn place_and_clean(read: InPlace, placement: &Placement, cleaning: &Cleaning) -> Result<(Hair, ImportReport)> {
    let strands = &read.hair.strands;
    let (strands_in_file, points_in_file) = (strands.len(), strands.points().len());
    let placed = read.through(&placement.head_from_file_in_doubles());
    if let Some(p) = not_finite(placed.strands.points()) {
        return Err(Error::new(format!("point {p} leaves the range of f32 when converted to cm: check hair.unit")));
    }
    if let Some(p) = placed.strands.points().iter().position(|p| p.abs().max_element() > FARTHEST) {
        let far = placed.strands.points()[p].abs().max_element();
        return Err(Error::new(format!("point {p} lies {far:e} cm away, more than {FARTHEST:e}: check hair.unit")));
    }
    let (mut hair, degenerate) = placed.without_degenerate(cleaning.join_within);
    let long_enough: Vec<usize> = match cleaning.drop_shorter_than {
        0.0 => (0..hair.strands.len()).collect(),
        least => (0..hair.strands.len()).filter(|&s| length(hair.strands.strand(s)) >= least).collect(),
    };
    let dropped_short = hair.strands.len() - long_enough.len();
    if dropped_short > 0 {
        hair = hair.select(&long_enough);
    }
    if hair.strands.is_empty() {
        return Err(Error::new(format!(
            "none of {strands_in_file} strands is left: {} have no length, {dropped_short} are shorter than {} cm; \
             check hair.unit, hair.join_within and hair.drop_shorter_than",
            degenerate.dropped_strands, cleaning.drop_shorter_than
        )));
    }
    let held_at_both_ends = held_at_both_ends(&hair);
    let report =
        ImportReport { strands_in_file, points_in_file, degenerate, dropped_short, tip_first: 0, held_at_both_ends };
    Ok((hair, report))
}

pub(crate) use nabiki::strands::length;

/// Phrases about the data of `hair` that the format of `path` cannot store.
pub fn losses(path: &Path, hair: &Hair) -> Result<Vec<String>> {
    match Format::of(path)? {
        Format::Hair => Ok(hair_file::losses(hair)),
        Format::Tfx => Ok(tfx::losses(hair)),
        Format::Usd | Format::Alembic => Ok(exchange::losses(path, hair)),
        Format::ObjLines => {
            Err(Error::new("cannot write hair as .obj: write .hair, .tfx, .usd, .usda, .usdc or .abc").in_file(path))
        }
    }
}

/// The least size (bytes) of `hair` in the format of `path`.
///
/// # Errors
/// An unknown ending.
pub fn least_bytes(path: &Path, hair: &Hair) -> Result<u64> {
    let a = &hair.attributes;
    let points = hair.strands.points().len() as u64;
    // Arrays of singles by point: three coordinates, in .tfx a weight too, and what the hair has of these.
    let arrays = match Format::of(path)? {
        Format::Usd | Format::Alembic => {
            return Ok(exchange::least_bytes(
                path,
                &exchange::still(hair, exchange::DeclaredSpace::default()),
                1,
                false,
            ));
        }
        Format::Tfx => 4 + 4 * u64::from(a.colour.is_some()) + 2 * u64::from(a.point_uv.is_some()),
        _ => {
            let [width, transparency] = [&a.width, &a.transparency].map(|values| u64::from(values.is_some()));
            3 + width + transparency + 3 * u64::from(a.colour.is_some())
        }
    };
    Ok(4 * points * arrays)
}

/// Writes `hair` in its unit and axes, and returns phrases about the data that the format cannot store. The file
/// appears when it is complete.
pub fn write(path: &Path, hair: &Hair) -> Result<Vec<String>> {
    hair.check_lengths().map_err(|e| Error::new(e.to_string()).in_file(path))?;
    let lost = losses(path, hair)?;
    if matches!(Format::of(path)?, Format::Usd | Format::Alembic) {
        exchange::write(path, hair, exchange::DeclaredSpace::default())?;
        return Ok(lost);
    }
    let on_disk = |e: std::io::Error| Error::from(e).in_file(path);
    let mut file = PartFile::create(path).map_err(on_disk)?;
    let written = match Format::of(path)? {
        Format::Tfx => tfx::to_writer(hair, &mut file),
        _ => hair_file::to_writer(hair, "Written by Nabiki", &mut file),
    };
    written.map_err(|e| e.in_file(path))?;
    file.finish().map_err(on_disk)?;
    Ok(lost)
}
