//! `[hair]`: grown here, or imported.

use std::path::PathBuf;

use glam::Vec3;
use nabiki::roots::{self, Hairline};
use nabiki::{SettingError, error::check_positive, groom::Style};
use nabiki_io::Axis;
use nabiki_io::Unit;
use nabiki_io::hair::Cleaning;
use serde::{Deserialize, Serialize};
use toml::Table;

use super::flat;
use super::head::check_placement;
use super::read::Refusal;
use super::tree::{Unwritable, table_of};

/// `[hair]`.
#[derive(Clone, Debug, PartialEq)]
pub struct HairSettings {
    /// Where the strands come from: those of a file where the table names a `file`.
    pub source: HairSource,
    /// d, which k and i of the paper are counted in, and the length of the segments grown (cm, default 1).
    pub segment_length: f32,
}

/// Where the strands come from.
#[derive(Clone, Debug, PartialEq)]
pub enum HairSource {
    /// Grown from the scalp.
    Grown(GrownHair),
    /// Read from a file.
    Imported(ImportedHair),
}

/// Hair grown from the scalp.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct GrownHair {
    /// Number of strands, 1..800,000,000 (default 19,330: Table 1).
    pub strands: usize,
    /// Most segments of a strand (default 18: the paper's k).
    pub segments: usize,
    /// Seed of the roots and of the differences between strands (default 1).
    pub seed: u64,
    /// Where hair grows.
    pub hairline: Hairline,
    /// How it lies.
    pub style: Style,
}

/// Hair read from a file.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct ImportedHair {
    /// A .hair, .tfx, .obj (polylines), USD layer or Alembic archive.
    pub file: PathBuf,
    /// Curves of a USD layer or Alembic archive to keep, by the name or path of their prim or of what it stands below (default: all).
    pub groups: Vec<String>,
    /// An even choice of so many strands (default: all of the file's).
    pub strands: Option<usize>,
    /// Cuts every strand anew into so many equally long segments (default: as the file has them).
    pub segments: Option<usize>,
    /// Unit of the file (default: what the file says, or that of the head's file, or cm).
    pub unit: Option<Unit>,
    /// Axis of the file that points up (default: what the file says, or that of the head's file, or +y).
    pub up: Option<Axis>,
    /// Axis of the file along which the face looks (default: that of the head's file, or +x).
    pub facing: Option<Axis>,
    /// Point of the file that becomes the origin of head space (file units; default: the same place as the head's).
    pub origin: Option<Vec3>,
    /// Which end of a strand is its root: "skin", the one that lies on the head's skin where the other does not, and else the first (default);
    /// "first"; or "last".
    pub root: RootEnd,
    /// Neighbouring points of a strand this close are joined (cm, default 0.001; 0 joins those alone that lie in one place, between which a
    /// strand has no direction to move in).
    pub join_within: f32,
    /// Strands shorter than this are dropped (cm, default 0: only those without any extent).
    pub drop_shorter_than: f32,
}

/// Which end of an imported strand is its root.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum RootEnd {
    /// The one that lies on the head's skin, where the other does not; otherwise the first.
    #[default]
    Skin,
    /// The first point of the file.
    First,
    /// The last point of the file.
    Last,
}

/// The keys of any hair.
#[derive(Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
struct AnyHair {
    segment_length: f32,
}

impl Default for AnyHair {
    fn default() -> Self {
        Self { segment_length: 1.0 }
    }
}

impl Default for GrownHair {
    fn default() -> Self {
        Self { strands: 19_330, segments: 18, seed: 1, hairline: Hairline::default(), style: Style::default() }
    }
}

impl Default for ImportedHair {
    fn default() -> Self {
        let Cleaning { join_within, drop_shorter_than } = Cleaning::default();
        Self {
            file: PathBuf::new(),
            groups: Vec::new(),
            strands: None,
            segments: None,
            unit: None,
            up: None,
            facing: None,
            origin: None,
            root: RootEnd::default(),
            join_within,
            drop_shorter_than,
        }
    }
}

impl Default for HairSource {
    fn default() -> Self {
        Self::Grown(GrownHair::default())
    }
}

impl Default for HairSettings {
    fn default() -> Self {
        Self { source: HairSource::default(), segment_length: AnyHair::default().segment_length }
    }
}

impl HairSettings {
    /// The most segments that a strand may have: what the .hair format can count.
    pub const MOST_SEGMENTS: usize = u16::MAX as usize;

    /// Refuses no segments, and more than any format holds. `name`: where the number was given.
    ///
    /// # Errors
    /// Says the range.
    pub fn check_segments(name: &str, segments: usize) -> Result<(), SettingError> {
        if (1..=Self::MOST_SEGMENTS).contains(&segments) {
            return Ok(());
        }
        Err(SettingError::new(name, segments, format!("must lie in 1..{}", Self::MOST_SEGMENTS)))
    }

    /// The settings of hair grown here, where it is.
    pub fn grown(&self) -> Option<&GrownHair> {
        match &self.source {
            HairSource::Grown(hair) => Some(hair),
            HairSource::Imported(_) => None,
        }
    }

    /// The settings of imported hair, where it is.
    pub fn imported(&self) -> Option<&ImportedHair> {
        match &self.source {
            HairSource::Grown(_) => None,
            HairSource::Imported(hair) => Some(hair),
        }
    }

    /// The table `[hair]`, read.
    pub(super) fn read(table: &Table) -> Result<Self, Refusal> {
        let (AnyHair { segment_length }, source) = if table.contains_key("file") {
            let why = "has no effect on hair that hair.file imports: remove one of them";
            let (any, hair) = flat::read(table, flat::keys::<GrownHair>(), why)?;
            (any, HairSource::Imported(hair))
        } else {
            let why = "has an effect only on hair that hair.file imports: give that or remove this";
            let (any, hair) = flat::read(table, flat::keys::<ImportedHair>(), why)?;
            (any, HairSource::Grown(hair))
        };
        Ok(Self { source, segment_length })
    }

    /// The table `[hair]`, to be written.
    pub(super) fn table(&self) -> Result<Table, Unwritable> {
        let mut table = match &self.source {
            HairSource::Grown(hair) => table_of(hair)?,
            HairSource::Imported(hair) => table_of(hair)?,
        };
        table.extend(table_of(&AnyHair { segment_length: self.segment_length })?);
        Ok(table)
    }

    /// The same source with all else at its default.
    pub(super) fn with_defaults(&self) -> Self {
        let source = match &self.source {
            HairSource::Grown(_) => HairSource::default(),
            // A file has no default: that of nowhere differs from any.
            HairSource::Imported(_) => HairSource::Imported(ImportedHair::default()),
        };
        Self { source, ..Self::default() }
    }

    /// Refuses what no hair can come from.
    ///
    /// # Errors
    /// Names the first such setting.
    pub fn check(&self) -> Result<(), SettingError> {
        match &self.source {
            HairSource::Grown(hair) => hair.check()?,
            HairSource::Imported(hair) => hair.check()?,
        }
        check_positive("hair.segment_length", self.segment_length)
    }
}

impl GrownHair {
    fn check(&self) -> Result<(), SettingError> {
        check_counts(Some(self.strands), Some(self.segments))?;
        roots::check_count(self.strands)?;
        let points = self.strands.checked_mul(self.segments.saturating_add(1));
        if points.is_none_or(|points| points > u32::MAX as usize) {
            return Err(SettingError::new("hair.strands", self.strands, "more than 2^32 points in all: grow less"));
        }
        self.hairline.check()?;
        self.style.check()
    }
}

impl ImportedHair {
    /// What the strands are cleaned of.
    pub fn cleaning(&self) -> Cleaning {
        Cleaning { join_within: self.join_within, drop_shorter_than: self.drop_shorter_than }
    }

    fn check(&self) -> Result<(), SettingError> {
        check_counts(self.strands, self.segments)?;
        check_placement("hair", self.unit, self.up, self.facing, self.origin)?;
        self.cleaning().check()
    }
}

fn check_counts(strands: Option<usize>, segments: Option<usize>) -> Result<(), SettingError> {
    if strands == Some(0) {
        return Err(SettingError::new("hair.strands", 0, "must be at least 1"));
    }
    segments.map_or(Ok(()), |segments| HairSettings::check_segments("hair.segments", segments))
}
