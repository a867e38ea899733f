//! The tables of a scene that belong to no other crate: `[head]`, `[hair]`, `[output]`.

use std::path::PathBuf;

use glam::Vec3;
use nabiki::{Ellipsoid, SettingError, error::check_positive, groom::Style, roots::Hairline};
use serde::{Deserialize, Serialize};

use nabiki_io::{
    hair::Cleaning,
    motion::{Axis, MotionSource},
    placement::{Placement, Unit},
};

/// `[head]`: the mesh, and the ellipsoids of the paper's section 3.1.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct HeadSettings {
    /// `"builtin:bust"` (default), or a path to an .obj, .glb or .gltf.
    pub mesh: String,
    /// Groups, objects or nodes of the file to keep (default: all).
    pub groups: Vec<String>,
    /// Unit of the file (default cm).
    pub unit: Option<Unit>,
    /// Axis of the file that points up (default +y).
    pub up: Option<Axis>,
    /// Axis of the file along which the face looks (default +x).
    pub facing: Option<Axis>,
    /// Point of the file that becomes the origin of head space (file units). Default: the centre of the fitted
    /// ellipsoid; the file's own origin where the ellipsoid is given.
    pub origin: Option<Vec3>,
    /// E: `"fit"` (default), or its centre and half axes (head space, cm).
    pub ellipsoid: EllipsoidChoice,
    /// C is E scaled by this, above 1 (default 1.25).
    pub shell: f32,
    /// A file that moves the head (default: it stands still).
    pub motion: Option<MotionSource>,
}

/// How the head ellipsoid E is found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(untagged, expecting = "must be \"fit\" or { center = [x, y, z], half_axes = [x, y, z] }")]
pub enum EllipsoidChoice {
    /// Fitted to the part of the mesh where hair grows; the built-in bust brings its own.
    #[default]
    #[serde(with = "fit")]
    Fit,
    /// As given.
    Given(Ellipsoid),
}

/// The word "fit".
mod fit {
    use serde::{Deserialize, Deserializer, Serializer, de::Error};

    pub fn serialize<S: Serializer>(serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str("fit")
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<(), D::Error> {
        match String::deserialize(deserializer)?.as_str() {
            "fit" => Ok(()),
            other => Err(D::Error::custom(format!("found \"{other}\", must be \"fit\""))),
        }
    }
}

impl Default for HeadSettings {
    fn default() -> Self {
        Self {
            mesh: "builtin:bust".to_owned(),
            groups: Vec::new(),
            unit: None,
            up: None,
            facing: None,
            origin: None,
            ellipsoid: EllipsoidChoice::Fit,
            shell: 1.25,
            motion: None,
        }
    }
}

impl HeadSettings {
    /// Whether the head is the project's own.
    pub fn is_builtin(&self) -> bool {
        self.mesh == "builtin:bust"
    }

    /// How the file lies in head space, before an origin is found for it.
    pub fn placement(&self) -> Placement {
        let default = Placement::default();
        Placement {
            unit: self.unit.unwrap_or(default.unit),
            up: self.up.unwrap_or(default.up),
            facing: self.facing.unwrap_or(default.facing),
            origin: self.origin.unwrap_or(default.origin),
        }
    }

    /// Refuses what no head can be loaded from.
    pub fn check(&self) -> Result<(), SettingError> {
        if self.mesh.starts_with("builtin:") && !self.is_builtin() {
            let quoted = format!("\"{}\"", self.mesh);
            return Err(SettingError::new("head.mesh", quoted, "there is one built-in head, \"builtin:bust\""));
        }
        self.placement().check("head")?;
        if let EllipsoidChoice::Given(ellipsoid) = self.ellipsoid {
            if !ellipsoid.center.is_finite() {
                return Err(SettingError::new("head.ellipsoid.center", ellipsoid.center, "must be finite"));
            }
            for half_axis in ellipsoid.half_axes.to_array() {
                check_positive("head.ellipsoid.half_axes", half_axis)?;
            }
        }
        if !(self.shell.is_finite() && self.shell > 1.0) {
            return Err(SettingError::new("head.shell", self.shell, "must be a finite number above 1"));
        }
        Ok(())
    }
}

/// `[hair]`: grown here, or imported.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct HairSettings {
    /// Strands to grow (default 19330, the paper's), or to choose evenly from an imported file (default: all).
    pub strands: Option<usize>,
    /// Most segments of a strand grown here (default 18), or segments that each imported strand is cut into anew, equally
    /// long (default: as in its file).
    pub segments: Option<usize>,
    /// d: length of a segment grown here, and the length that the paper's k and i are counted in (cm, default 1).
    pub segment_length: f32,
    /// Seed of all that is random in growing (default 1).
    pub seed: u64,
    /// Where hair grows.
    pub hairline: Hairline,
    /// How it is styled.
    pub style: Style,
    /// A .hair, .tfx or .obj (polylines) file to import instead of growing.
    pub file: Option<PathBuf>,
    /// Unit of the file (default: that of the head's file, or cm).
    pub unit: Option<Unit>,
    /// Axis of the file that points up (default: that of the head's file, or +y).
    pub up: Option<Axis>,
    /// Axis of the file along which the face looks (default: that of the head's file, or +x).
    pub facing: Option<Axis>,
    /// Point of the file that becomes the origin of head space (file units; default: the same place as the head's).
    pub origin: Option<Vec3>,
    /// Neighbouring points of an imported strand this close are joined (cm, default 0.001).
    pub join_within: f32,
    /// Imported strands shorter than this are dropped (cm, default 0: only those without any extent).
    pub drop_shorter_than: f32,
}

/// Keys of `[hair]` that mean nothing beside `file`.
pub(super) const GROWN_ONLY: [&str; 3] = ["seed", "hairline", "style"];
/// Keys of `[hair]` that mean nothing without `file`.
pub(super) const IMPORTED_ONLY: [&str; 6] = ["unit", "up", "facing", "origin", "join_within", "drop_shorter_than"];
/// Keys of `[head]` that mean nothing for the built-in head.
pub(super) const MESH_FILE_ONLY: [&str; 5] = ["groups", "unit", "up", "facing", "origin"];

impl Default for HairSettings {
    fn default() -> Self {
        let cleaning = Cleaning::default();
        Self {
            strands: None,
            segments: None,
            segment_length: 1.0,
            seed: 1,
            hairline: Hairline::default(),
            style: Style::default(),
            file: None,
            unit: None,
            up: None,
            facing: None,
            origin: None,
            join_within: cleaning.join_within,
            drop_shorter_than: cleaning.drop_shorter_than,
        }
    }
}

impl HairSettings {
    /// The paper's number of strands (Table 1), grown unless the scene says otherwise.
    pub const STRANDS: usize = 19_330;
    /// The most segments of a strand grown, unless the scene says otherwise: the paper's k (Table 1).
    pub const SEGMENTS: usize = 18;

    /// What imported hair is cleaned of.
    pub fn cleaning(&self) -> Cleaning {
        Cleaning { join_within: self.join_within, drop_shorter_than: self.drop_shorter_than }
    }

    /// Refuses what no hair can come from.
    pub fn check(&self) -> Result<(), SettingError> {
        if self.strands == Some(0) {
            return Err(SettingError::new("hair.strands", 0, "must be at least 1"));
        }
        if self.segments == Some(0) {
            return Err(SettingError::new("hair.segments", 0, "must be at least 1"));
        }
        let points = self
            .strands
            .unwrap_or(Self::STRANDS)
            .checked_mul(self.segments.unwrap_or(Self::SEGMENTS).saturating_add(1));
        if self.file.is_none() && points.is_none_or(|points| points > u32::MAX as usize) {
            let strands = self.strands.unwrap_or(Self::STRANDS);
            return Err(SettingError::new("hair.strands", strands, "more than 2^32 points in all: grow less"));
        }
        check_positive("hair.segment_length", self.segment_length)?;
        self.hairline.check()?;
        self.style.check()?;
        self.cleaning().check()
    }
}

/// `[output]`: what a run writes. Where it goes is the command line's affair.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct Output {
    /// Whether a movie is written (default true).
    pub movie: bool,
    /// Whether every frame is written as a PNG (default false).
    pub png_frames: bool,
    /// Bits of each channel of those PNGs, 8 (default) or 16.
    pub png_bits: u32,
    /// Whether every frame is written as an OpenEXR file with depth, hair direction and motion (default false).
    pub exr_frames: bool,
    /// Whether the force's projections on the yz and zx planes are drawn, as SVG and PNG (default false; the paper's
    /// Figure 10).
    pub field: bool,
    /// Frames of the contact sheet (default: four, evenly from frame 0 on, as the paper's Figure 6 has them).
    pub sheet: Option<Vec<u32>>,
}

impl Default for Output {
    fn default() -> Self {
        Self { movie: true, png_frames: false, png_bits: 8, exr_frames: false, field: false, sheet: None }
    }
}

impl Output {
    /// Refuses frames that the motion does not reach.
    pub fn check(&self, frames: u32) -> Result<(), SettingError> {
        if !matches!(self.png_bits, 8 | 16) {
            return Err(SettingError::new("output.png_bits", self.png_bits, "must be 8 or 16"));
        }
        match self.sheet.iter().flatten().enumerate().find(|&(_, &frame)| frame > frames) {
            Some((i, frame)) => {
                let remedy = format!("the last frame is motion.frames = {frames}");
                Err(SettingError::new(format!("output.sheet[{i}]"), frame, remedy))
            }
            None => Ok(()),
        }
    }

    /// The frames of the contact sheet, for a motion of `frames` frames.
    pub fn sheet_frames(&self, frames: u32) -> Vec<u32> {
        match &self.sheet {
            Some(sheet) => sheet.clone(),
            // 0, 30, 60 and 90 of the paper's 100.
            None => {
                let mut four: Vec<u32> = (0..4).map(|i| (u64::from(frames) * 3 * i / 10) as u32).collect();
                four.dedup();
                four
            }
        }
    }
}
