//! PNG files: sRGB with straight alpha, of 8 or 16 bit.

use std::path::Path;

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};

use super::write_whole;
use crate::RenderError;
use crate::frame::Frame;
use crate::tone_mapping::ToneMapping;

/// Bits of each channel of a PNG file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Depth {
    /// 8 bit.
    #[default]
    Eight,
    /// 16 bit.
    Sixteen,
}

/// Writes a frame as a PNG file: sRGB, straight alpha (left out where the whole picture is opaque).
pub fn write(path: &Path, frame: &Frame, tone_mapping: &ToneMapping, depth: Depth) -> Result<(), RenderError> {
    let opaque = frame.rgba.iter().all(|p| p[3] >= 1.0);
    match depth {
        Depth::Eight => {
            let rgba = tone_mapping.rgba8(frame);
            if opaque {
                encode(path, frame.size, &without_alpha(&rgba), ExtendedColorType::Rgb8)
            } else {
                encode(path, frame.size, &rgba, ExtendedColorType::Rgba8)
            }
        }
        Depth::Sixteen => {
            let rgba = tone_mapping.rgba16(frame);
            if opaque {
                encode(path, frame.size, bytemuck::cast_slice(&without_alpha(&rgba)), ExtendedColorType::Rgb16)
            } else {
                encode(path, frame.size, bytemuck::cast_slice(&rgba), ExtendedColorType::Rgba16)
            }
        }
    }
}

/// Writes 8 bit sRGB pixels, three bytes each, as a PNG file.
pub fn write_rgb8(path: &Path, size: [u32; 2], rgb: &[u8]) -> Result<(), RenderError> {
    encode(path, size, rgb, ExtendedColorType::Rgb8)
}

fn without_alpha<T: Copy>(rgba: &[T]) -> Vec<T> {
    rgba.chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect()
}

fn encode(path: &Path, size: [u32; 2], bytes: &[u8], colour: ExtendedColorType) -> Result<(), RenderError> {
    write_whole(path, |file| {
        PngEncoder::new_with_quality(file, CompressionType::Default, FilterType::Adaptive)
            .write_image(bytes, size[0], size[1], colour)
            .map_err(Into::into)
    })
}
