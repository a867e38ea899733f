//! Movies: H.264 in MP4, encoded in this process and streamed to disk.

#[cfg(feature = "video")]
mod codec;
#[cfg(not(feature = "video"))]
#[path = "video/no_codec.rs"]
mod codec;

use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::JoinHandle;

use nabiki_file::PartFile;
use rayon::prelude::*;

use self::codec::Codec;
use super::mp4::Track;
use super::png::Still;
use super::{create_part, write_whole};
use crate::RenderError;
use crate::colour::luminance;
use crate::frame::Frame;
use crate::settings::Picture;
use crate::tone_mapping::{ToneMapping, threshold};

/// A movie that is being written. The file gets its name in [`finish`](Self::finish).
///
/// Colour is Rec. 709, studio range, 4:2:0, from 16-bit display values. A movie made from 16-bit PNG files is therefore
/// the same, bit by bit, as one made from the original frames. An odd side loses its last row or column, because the
/// chroma of H.264 has half the resolution. A transparent frame is shown on black.
///
/// Frames are encoded on a separate thread, in order, while the next are drawn. At most one frame waits.
pub struct Movie {
    path: PathBuf,
    size: [usize; 2],
    planes: Option<SyncSender<Planes>>,
    coding: Option<JoinHandle<Result<Coder, RenderError>>>,
}

/// Luma and the two colour differences of a frame.
type Planes = [Vec<u8>; 3];

/// Frames that may wait for the one being coded.
const WAITING: usize = 1;

impl Movie {
    /// Checks picture and frame rate like [`create`](Self::create).
    ///
    /// # Errors
    /// An unsupported size or frame rate. In a build without the feature `video`, always.
    pub fn check(picture: &Picture, frame_rate: f64) -> Result<(), RenderError> {
        picture.check()?;
        if !codec::IS_BUILT_IN {
            let remedy =
                "this program was built without the movie codec: set it to false, and output.png_frames = true";
            return Err(nabiki::SettingError::new("output.movie", true, remedy).into());
        }
        if !(1.0..=240.0).contains(&frame_rate) {
            let remedy = "must be 1 to 240 for a movie: give picture.video.frame_rate, or set output.movie = false, \
                 and output.png_frames = true for frames as files";
            return Err(nabiki::SettingError::new("motion.frame_rate", frame_rate, remedy).into());
        }
        if !Self::takes(picture.size) {
            return Err(nabiki::SettingError::new(
                "picture.size",
                format!("{} x {}", picture.size[0], picture.size[1]),
                format!("{}: set output.movie = false, and output.png_frames = true for frames as files", Self::SIZES),
            )
            .into());
        }
        Ok(())
    }

    /// The sizes that [`takes`](Self::takes) accepts, in words.
    pub const SIZES: &str = "a movie's sides must lie between 16 and 3840 x 2160 pixels";

    /// Whether a movie can have this size (pixels), in either orientation.
    pub fn takes(size: [u32; 2]) -> bool {
        let size = size.map(|side| side & !1);
        size[0].max(size[1]) <= 3840 && (16..=2160).contains(&size[0].min(size[1]))
    }

    /// Starts a movie at `path` with the size and quality of `picture`, at `frame_rate` frames per second (1..240).
    ///
    /// # Errors
    /// An unsupported size or frame rate, or a place that cannot be written.
    pub fn create(path: &Path, picture: &Picture, frame_rate: f64) -> Result<Self, RenderError> {
        Self::check(picture, frame_rate)?;
        let size = picture.size.map(|s| s as usize & !1);
        // The encoder takes 12 (near lossless) to 51. A range of one value leaves its rate control nothing to decide.
        let quantiser = (44.0 - 32.0 * picture.video.quality).round() as u8;
        let codec = Codec::new(quantiser, frame_rate).map_err(|e| RenderError::write(path, e))?;
        let coder = Coder {
            path: path.to_owned(),
            size,
            codec,
            track: Track::new(size.map(|s| s as u16), frame_rate),
            coded: create_part(path)?,
            scratch: Vec::new(),
        };
        let (planes, waiting) = sync_channel(WAITING);
        let coding = std::thread::Builder::new()
            .name("movie".to_owned())
            .spawn(move || coder.code_all(&waiting))
            .map_err(|e| RenderError::write(path, e))?;
        Ok(Self { path: path.to_owned(), size, planes: Some(planes), coding: Some(coding) })
    }

    /// Appends a frame. It is encoded while the next is drawn, so a later call reports its errors.
    ///
    /// # Errors
    /// Errors of the encoder or the disk.
    ///
    /// # Panics
    /// If the size of the frame is not that of the movie.
    pub fn push(&mut self, frame: &Frame, tone_mapping: &ToneMapping) -> Result<(), RenderError> {
        let stride = frame.size[0] as usize;
        let pixel = |x: usize, y: usize| {
            let [r, g, b, _] = frame.rgba[y * stride + x];
            tone_mapping.values([r, g, b]).map(|value| (value * 65535.0 + 0.5) as u16)
        };
        self.push_pixels(frame.size, pixel)
    }

    /// Appends an existing picture.
    ///
    /// # Errors
    /// As for [`push`](Self::push).
    ///
    /// # Panics
    /// As for [`push`](Self::push).
    pub fn push_still(&mut self, still: &Still) -> Result<(), RenderError> {
        let stride = still.size[0] as usize;
        self.push_pixels(still.size, |x, y| still.rgb[y * stride + x])
    }

    /// `pixel`: display values, 0..65535.
    fn push_pixels(
        &mut self,
        size: [u32; 2],
        pixel: impl Fn(usize, usize) -> [u16; 3] + Sync,
    ) -> Result<(), RenderError> {
        assert_eq!(size.map(|s| s as usize & !1), self.size, "every frame has the movie's size");
        let planes = planes(self.size, pixel);
        match self.planes.as_ref().map(|waiting| waiting.send(planes)) {
            Some(Ok(())) => Ok(()),
            // It takes no more because it has failed.
            _ => self.join().map(drop),
        }
    }

    /// Encodes the remaining frames, writes the index and gives the file its name.
    ///
    /// # Errors
    /// Errors of the encoder or the disk.
    pub fn finish(mut self) -> Result<(), RenderError> {
        let mut coder = self.join()?;
        let Coder { path, track, coded, .. } = &mut coder;
        write_whole(path, |file| Ok(track.finish(coded, file)?))
    }

    /// Waits until all frames are coded.
    fn join(&mut self) -> Result<Coder, RenderError> {
        self.planes = None;
        let Some(coding) = self.coding.take() else {
            return Err(RenderError::write(&self.path, "the movie has already failed"));
        };
        coding.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
    }
}

impl Drop for Movie {
    fn drop(&mut self) {
        self.planes = None;
        if let Some(coding) = self.coding.take() {
            // What it says is of a movie that nobody wants any more.
            let _ = coding.join();
        }
    }
}

/// The thread that codes frames, in their order.
struct Coder {
    path: PathBuf,
    size: [usize; 2],
    codec: Codec,
    track: Track,
    coded: PartFile,
    scratch: Vec<u8>,
}

impl Coder {
    fn code_all(mut self, waiting: &Receiver<Planes>) -> Result<Self, RenderError> {
        for planes in waiting {
            self.code(&planes)?;
        }
        Ok(self)
    }

    fn code(&mut self, planes: &Planes) -> Result<(), RenderError> {
        self.scratch.clear();
        let coded = self.codec.code(self.size, planes, &mut self.scratch);
        coded.map_err(|e| RenderError::write(&self.path, e))?;
        self.track.append(&self.scratch, &mut self.coded).map_err(|e| RenderError::write(&self.path, e))
    }
}

/// Studio-range Rec. 709 planes: luma of full size, the two colour differences averaged over 2 x 2 pixels. What lies between two steps
/// becomes one or the other, as in pictures; where it does does not change from frame to frame, so that what stands still costs nothing.
fn planes([width, height]: [usize; 2], pixel: impl Fn(usize, usize) -> [u16; 3] + Sync) -> Planes {
    let mut luma = vec![0; width * height];
    let mut blue = vec![0; width * height / 4];
    let mut red = vec![0; width * height / 4];
    let rows = luma.par_chunks_mut(2 * width).zip(blue.par_chunks_mut(width / 2)).zip(red.par_chunks_mut(width / 2));
    rows.enumerate().for_each(|(pair, ((luma, blue), red))| {
        for x in (0..width).step_by(2) {
            let mut differences = [0.0; 2];
            for (dy, dx) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                let [r, g, b] = pixel(x + dx, 2 * pair + dy).map(|value| f32::from(value) / 65535.0);
                let y = luminance([r, g, b]);
                luma[dy * width + x + dx] = (16.0 + 219.0 * y + threshold(x + dx, 2 * pair + dy)) as u8;
                differences[0] += (b - y) / 1.8556;
                differences[1] += (r - y) / 1.5748;
            }
            let up_from = threshold(x / 2, pair);
            blue[x / 2] = (128.0 + 56.0 * differences[0] + up_from) as u8;
            red[x / 2] = (128.0 + 56.0 * differences[1] + up_from) as u8;
        }
    });
    [luma, blue, red]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gradient_finer_than_a_step_is_right_in_the_mean_and_has_no_bands() {
        let (width, height) = (128_usize, 256_usize);
        // Two steps of luma from top to bottom, and one and a half of each colour difference.
        let shown = |y: usize| {
            let t = (y as f32 + 0.5) / height as f32;
            [0.3 + 0.0169 * t, 0.3 + 0.0021 * t, 0.3 + 0.0551 * t]
        };
        let all = planes([width, height], |_, y| shown(y).map(|v| (v * 65535.0 + 0.5) as u16));
        let wanted = |y: usize| {
            let [r, g, b] = shown(y).map(f64::from);
            let luma = 0.2126 * r + 0.7152 * g + 0.0722 * b;
            [16.0 + 219.0 * luma, 128.0 + 224.0 * (b - luma) / 1.8556, 128.0 + 224.0 * (r - luma) / 1.5748]
        };
        for (n, plane) in all.iter().enumerate() {
            let (across, lines) = if n == 0 { (width, 16) } else { (width / 2, 8) };
            for (k, part) in plane.chunks(across * lines).enumerate() {
                let mean = part.iter().map(|&v| f64::from(v)).sum::<f64>() / part.len() as f64;
                let middle = (0..16).map(|y| wanted(16 * k + y)[n]).sum::<f64>() / 16.0;
                // The noise, kept to 0.96 of a step, is off by 0.02, and by 1 of 48 for its grain; values of 16 bits by 0.004.
                assert!((mean - middle).abs() < 0.045, "plane {n}, part {k}: {mean} for {middle}");
                let fraction = middle - middle.floor();
                let of_both = part.iter().any(|&v| v != part[0]);
                assert!(of_both || !(0.1..=0.9).contains(&fraction), "plane {n}, part {k}: one colour for {middle}");
            }
        }
    }
}
