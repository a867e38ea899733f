//! `[hair]`: grown or imported.

use std::path::PathBuf;

use glam::Vec3;
use nabiki::setting::{Key, Place};
use nabiki::{SettingError, settings, words};
use nabiki_groom::{Hairline, Style, roots};
use nabiki_io::Axis;
use nabiki_io::Unit;
use nabiki_io::hair::Cleaning;
use toml::Table;

use super::flat;
use super::head::{check_named, check_placement};
use super::read::Refusal;
use super::tree::{Unwritable, table_of};

/// `[hair]`.
#[derive(Clone, Debug, PartialEq)]
pub struct HairSettings {
    /// The source of the strands: a file if the table has `file`.
    pub source: HairSource,
    /// d: the length of grown segments (cm). Stiffness and the paper's k and i are counted in it.
    pub segment_length: f32,
}

/// The source of the strands.
#[derive(Clone, Debug, PartialEq)]
pub enum HairSource {
    /// Grown from the scalp.
    Grown(GrownHair),
    /// Read from a file.
    Imported(ImportedHair),
}

settings! {
    /// Hair that grows from the scalp.
    pub struct GrownHair in "hair" where is_not_too_much {
        /// Number of strands. The paper's Table 1 has 19,330.
        pub strands: usize = 19_330 => "Strands", least 1.0, most roots::MOST as f64;
        /// Largest number of segments of a strand. The paper uses k = 18.
        pub segments: usize = 18 => "Segments", least 1.0, most HairSettings::MOST_SEGMENTS as f64;
        /// Random seed of the roots and of the differences between strands.
        pub seed: u64 = 1 => "Seed";
        /// Where hair grows.
        pub hairline: Hairline = Hairline::default() => "Hairline";
        /// How the hair is styled.
        pub style: Style = Style::default() => "Style";
    }
}

settings! {
    /// Hair from a file.
    pub struct ImportedHair in "hair" where is_placed {
        /// The hair: a .hair, .tfx, .obj (polylines), USD layer or Alembic archive.
        pub file: PathBuf = PathBuf::new() => "File", must "\"hair.abc\"";
        /// Curves of a USD layer or Alembic archive to use, by the name or path of their prim or of one above it. Uses
        /// all if empty.
        pub groups: Vec<String> = Vec::new() => "Groups";
        /// Number of strands to use, spread evenly over the hair.
        pub strands: Option<usize> = None => "Strands", least 1.0, open "all";
        /// Resamples each strand to this number of segments of equal length.
        pub segments: Option<usize> = None => "Segments", least 1.0, most HairSettings::MOST_SEGMENTS as f64, open "as in the file";
        /// Length unit of the file. By default the unit in the file, or else that of the head's file, or else cm.
        pub unit: Option<Unit> = None => "Unit", above 0.0, open "what the file says";
        /// Axis of the file that points up. By default the axis in the file, or else that of the head's file, or else
        /// +y.
        pub up: Option<Axis> = None => "Up", open "what the file says";
        /// Axis of the file along which the face looks. By default that of the head's file, or else +x.
        pub facing: Option<Axis> = None => "Facing", open "the head's";
        /// Point of the file that becomes the origin of head space, in the file's unit.
        pub origin: Option<Vec3> = None => "Origin", open "the head's";
        /// Which end of a strand is its root.
        pub root: RootEnd = RootEnd::Skin => "Root";
        /// Joins neighbouring points of a strand that are at most this far apart. 0 joins only points in the same
        /// place, between which a strand has no direction.
        pub join_within: f32 = Cleaning::default().join_within => "Join within", unit "cm", least 0.0;
        /// Drops strands shorter than this. 0 drops only strands without any length.
        pub drop_shorter_than: f32 = Cleaning::default().drop_shorter_than => "Minimum length", unit "cm", least 0.0;
    }
}

words! {
    /// Which end of an imported strand is its root.
    pub enum RootEnd = Skin {
        /// The end that lies on the head's skin. If neither or both do, the first point.
        Skin = "skin",
        /// The first point in the file.
        First = "first",
        /// The last point in the file.
        Last = "last",
    }
}

settings! {
    /// The keys of any hair.
    pub(crate) struct AnyHair in "hair" {
        /// Length d of a grown segment. Stiffness and the paper's k and i are counted in this length.
        segment_length: f32 = 1.0 => "Segment length", unit "cm", above 0.0;
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
    /// Largest number of segments of a strand: the limit of the .hair format.
    pub const MOST_SEGMENTS: usize = u16::MAX as usize;

    /// Refuses 0 segments, and more than any format can store. `name` is the setting.
    ///
    /// # Errors
    /// The error contains the range.
    pub fn check_segments(name: &str, segments: usize) -> Result<(), SettingError> {
        if (1..=Self::MOST_SEGMENTS).contains(&segments) {
            return Ok(());
        }
        Err(SettingError::new(name, segments, format!("must lie in 1..{}", Self::MOST_SEGMENTS)))
    }

    /// The settings of grown hair, if it is grown.
    pub fn grown(&self) -> Option<&GrownHair> {
        match &self.source {
            HairSource::Grown(hair) => Some(hair),
            HairSource::Imported(_) => None,
        }
    }

    /// The settings of imported hair, if it is imported.
    pub fn imported(&self) -> Option<&ImportedHair> {
        match &self.source {
            HairSource::Grown(_) => None,
            HairSource::Imported(hair) => Some(hair),
        }
    }

    /// Reads the table `[hair]`.
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

    /// The table `[hair]`, for writing.
    pub(super) fn table(&self) -> Result<Table, Unwritable> {
        let mut table = match &self.source {
            HairSource::Grown(hair) => table_of(hair)?,
            HairSource::Imported(hair) => table_of(hair)?,
        };
        table.extend(table_of(&AnyHair { segment_length: self.segment_length })?);
        Ok(table)
    }

    /// The same source with everything else at its default.
    pub(super) fn with_defaults(&self) -> Self {
        let source = match &self.source {
            HairSource::Grown(_) => HairSource::default(),
            // A file has no default: an empty path differs from any.
            HairSource::Imported(_) => HairSource::Imported(ImportedHair::default()),
        };
        Self { source, ..Self::default() }
    }

    /// Refuses invalid settings.
    ///
    /// # Errors
    /// Names the first such setting.
    pub fn check(&self) -> Result<(), SettingError> {
        match &self.source {
            HairSource::Grown(hair) => hair.check()?,
            HairSource::Imported(hair) => hair.check()?,
        }
        AnyHair { segment_length: self.segment_length }.check()
    }
}

impl GrownHair {
    fn is_not_too_much(&self, _: &Place) -> Result<(), SettingError> {
        let points = self.strands.checked_mul(self.segments.saturating_add(1));
        if points.is_none_or(|points| points > u32::MAX as usize) {
            return Err(SettingError::new(
                "hair.strands",
                self.strands,
                "more than 2^32 points in total: reduce strands or segments",
            ));
        }
        Ok(())
    }
}

impl ImportedHair {
    /// The cleaning of imported strands.
    pub fn cleaning(&self) -> Cleaning {
        Cleaning { join_within: self.join_within, drop_shorter_than: self.drop_shorter_than }
    }

    fn is_placed(&self, at: &Place) -> Result<(), SettingError> {
        check_named(&at.key("file"), &self.file)?;
        check_placement(&Key::from(at).to_string(), self.unit, self.up, self.facing, self.origin)
    }
}
