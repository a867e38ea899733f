//! `[output]`: the files that a run writes.

use nabiki::dynamics::Motion;
use nabiki::setting::{Place, refused};
use nabiki::{SettingError, settings};

settings! {
    /// What a run writes. The command line sets the folder.
    pub struct Output in "output" where has_bits {
        /// Whether to write a movie.
        pub movie: bool = true => "Movie";
        /// Whether to write each frame as a PNG.
        pub png_frames: bool = false => "PNG frames";
        /// Bits per channel of the PNG frames: 8 or 16.
        pub png_bits: u32 = 8 => "PNG bits", least 8.0, most 16.0;
        /// Whether to write each frame as an OpenEXR file with depth, hair direction and motion.
        pub exr_frames: bool = false => "OpenEXR frames";
        /// Whether to plot the force, projected on the yz and zx planes, as SVG and PNG. This is the paper's Figure 10.
        pub field: bool = false => "Field plot";
        /// Frames of the contact sheet. By default four frames at equal distances from frame 0 on, as in the paper's
        /// Figure 6.
        pub sheet: Option<Vec<u32>> = None => "Contact sheet", unit "frames", open "4, evenly spaced";
        /// Frame number of the shot for frame 0. Exports of moving hair (USD, Alembic) count from it; pictures keep the
        /// scene's numbers. By default it comes from the head's motion, if that is from USD or Alembic and plays at its
        /// own speed. Otherwise it comes from the hair's USD layer (`startTimeCode`) or Alembic archive, or is 0.
        pub first_frame: Option<i32> = None => "First frame", least -FARTHEST, most FARTHEST,
            open "as in the files";
    }
}

const FARTHEST: f64 = Motion::MOST_FRAMES as f64;

/// Refuses a number of frame 0 beyond the largest number of frames of a motion.
///
/// # Errors
/// The error contains the range.
pub fn check_first_frame(name: &str, first: i32) -> Result<(), SettingError> {
    let most = Motion::MOST_FRAMES;
    if first.unsigned_abs() <= most {
        return Ok(());
    }
    Err(SettingError::new(name, first, format!("must lie in -{most}..{most}")))
}

impl Output {
    fn has_bits(&self, at: &Place) -> Result<(), SettingError> {
        if matches!(self.png_bits, 8 | 16) {
            Ok(())
        } else {
            refused(&at.key("png_bits"), self.png_bits, "must be 8 or 16")
        }
    }

    /// Refuses frames of the sheet beyond the end of the motion.
    ///
    /// # Errors
    /// Names the first of them.
    pub fn check_frames(&self, frames: u32) -> Result<(), SettingError> {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sheet_shows_four_frames_evenly_from_rest_on_or_as_many_as_there_are() {
        let output = Output::default();
        assert_eq!(output.sheet_frames(100), [0, 30, 60, 90]);
        for frames in 4..=300 {
            let sheet = output.sheet_frames(frames);
            let steps: Vec<u32> = sheet.windows(2).map(|pair| pair[1] - pair[0]).collect();
            assert!(sheet[0] == 0 && sheet.len() == 4 && sheet[3] <= frames, "{frames}: {sheet:?}");
            assert!(steps.iter().max().unwrap() - steps.iter().min().unwrap() <= 1, "{frames}: {sheet:?}");
        }
        assert_eq!(output.sheet_frames(0), [0]);
        assert_eq!(Output { sheet: Some(vec![7, 3]), ..output }.sheet_frames(10), [7, 3]);
    }
}
