//! `[output]`: what a run writes.

use nabiki::SettingError;
use serde::{Deserialize, Serialize};

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
                let remedy = format!("the last frame is motion.frames = {frames}; take it out of the sheet");
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
