//! PNG files: sRGB with straight alpha, 8 or 16 bits.

use std::fs::File;
use std::io::{BufReader, Read, Write};
use std::path::Path;

use image::codecs::png::{CompressionType, FilterType, PngDecoder, PngEncoder};
use image::{ColorType, DynamicImage, ExtendedColorType, ImageDecoder, ImageEncoder, ImageResult};

use super::write_whole;
use crate::RenderError;
use crate::frame::Frame;
use crate::tone_mapping::ToneMapping;

/// Bits per channel of a PNG file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Depth {
    /// 8 bit.
    #[default]
    Eight,
    /// 16 bit.
    Sixteen,
}

/// A picture read from a PNG file: display values.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Still {
    /// Width and height (pixels).
    pub size: [u32; 2],
    /// Red, green, blue (sRGB, 0..65535), row after row from the top.
    pub rgb: Vec<[u16; 3]>,
}

/// The width and height (pixels) of a PNG file, without its pixels.
///
/// # Errors
/// If the file cannot be read or is not a PNG.
pub fn read_size(path: &Path) -> Result<[u32; 2], RenderError> {
    let (width, height) = decoder(path)?.dimensions();
    Ok([width, height])
}

/// The depth of a PNG file's channels.
///
/// # Errors
/// As for [`read_size`].
pub fn read_depth(path: &Path) -> Result<Depth, RenderError> {
    let of_sixteen =
        matches!(decoder(path)?.color_type(), ColorType::L16 | ColorType::La16 | ColorType::Rgb16 | ColorType::Rgba16);
    Ok(if of_sixteen { Depth::Sixteen } else { Depth::Eight })
}

/// Reads an opaque PNG file.
///
/// # Errors
/// If the file cannot be read, is not a PNG, or is not opaque.
pub fn read(path: &Path) -> Result<Still, RenderError> {
    let picture = DynamicImage::from_decoder(decoder(path)?).map_err(|e| RenderError::read(path, e))?;
    let size = [picture.width(), picture.height()];
    let rgba = picture.into_rgba16();
    if let Some(see_through) = rgba.pixels().position(|p| p.0[3] != u16::MAX) {
        let (x, y) = (see_through as u32 % size[0], see_through as u32 / size[0]);
        let what = format!("pixel ({x}, {y}) is transparent: only opaque pictures can be frames of a movie");
        return Err(RenderError::read(path, what));
    }
    let rgb = rgba.pixels().map(|p| [p.0[0], p.0[1], p.0[2]]).collect();
    Ok(Still { size, rgb })
}

/// Whether a file is a PNG written by this crate, according to the mark in it.
pub fn is_ours(path: &Path) -> bool {
    let mut begins = [0; BEFORE_MARK + MARK.len()];
    let read = open(path).is_ok_and(|mut file| file.read_exact(&mut begins).is_ok());
    read && begins.starts_with(b"\x89PNG\r\n\x1a\n") && begins[BEFORE_MARK..] == *MARK
}

/// Opens a file. A folder, a device and a pipe, which may never begin, are refused.
fn open(path: &Path) -> Result<File, RenderError> {
    let failed = |e| RenderError::read(path, e);
    // Asked before it is opened: opening a pipe waits for someone to write into it.
    let about = std::fs::metadata(path).map_err(failed)?;
    if !about.is_file() {
        let what = if about.is_dir() { "a folder" } else { "a device or a pipe" };
        return Err(RenderError::read(path, format!("is {what}, not a regular file: give a file")));
    }
    File::open(path).map_err(failed)
}

fn decoder(path: &Path) -> Result<PngDecoder<BufReader<File>>, RenderError> {
    let file = open(path)?;
    PngDecoder::new(BufReader::new(file)).map_err(|e| RenderError::read(path, e))
}

/// Writes a frame as a PNG file: sRGB, straight alpha (left out if the picture is opaque).
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

/// A frame as the bytes of an 8-bit PNG file, as written by [`write()`].
pub fn bytes(frame: &Frame, tone_mapping: &ToneMapping) -> Result<Vec<u8>, RenderError> {
    let rgba = tone_mapping.rgba8(frame);
    let mut file = Vec::new();
    let written = match frame.rgba.iter().all(|p| p[3] >= 1.0) {
        true => into(&mut file, frame.size, &without_alpha(&rgba), ExtendedColorType::Rgb8),
        false => into(&mut file, frame.size, &rgba, ExtendedColorType::Rgba8),
    };
    written.map_err(|e| RenderError::Geometry(e.to_string()))?;
    Ok(file)
}

/// Writes 8-bit sRGB pixels, three bytes each, as a PNG file.
pub fn write_rgb8(path: &Path, size: [u32; 2], rgb: &[u8]) -> Result<(), RenderError> {
    encode(path, size, rgb, ExtendedColorType::Rgb8)
}

fn without_alpha<T: Copy>(rgba: &[T]) -> Vec<T> {
    rgba.chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect()
}

fn encode(path: &Path, size: [u32; 2], bytes: &[u8], colour: ExtendedColorType) -> Result<(), RenderError> {
    write_whole(path, |file| into(file, size, bytes, colour).map_err(Into::into))
}

fn into(mut file: impl Write, size: [u32; 2], bytes: &[u8], colour: ExtendedColorType) -> ImageResult<()> {
    let mut whole = Vec::new();
    let encoder = PngEncoder::new_with_quality(&mut whole, CompressionType::Default, FilterType::Adaptive);
    encoder.write_image(bytes, size[0], size[1], colour)?;
    file.write_all(&whole[..BEFORE_MARK])?;
    file.write_all(MARK)?;
    file.write_all(&crc32fast::hash(&MARK[4..]).to_be_bytes())?;
    Ok(file.write_all(&whole[BEFORE_MARK..])?)
}

/// What says who has made the file, by which a later run knows which frames it may remove: a chunk of text, but for its sum.
const MARK: &[u8; 23] = b"\0\0\0\x0ftEXtSoftware\0Nabiki";

/// Bytes of a PNG file before it: the signature and the chunk IHDR, which must be the first.
const BEFORE_MARK: usize = 8 + 25;
