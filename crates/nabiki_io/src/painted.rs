//! Painted maps: pictures over a surface, by its texture coordinates.

use std::io::Cursor;
use std::path::Path;
use std::time::SystemTime;

use glam::Vec2;
use image::{GenericImageView, ImageFormat, ImageReader};

use crate::error::{Error, Result};
use crate::input;

/// Most pixels along an edge.
const MOST_PIXELS: u32 = 4096;
/// Size limit of its file: that many pixels of four channels of 16 bits, not compressed (bytes).
const MOST_BYTES: u64 = 8 * (MOST_PIXELS as u64).pow(2);

/// A picture over a surface, in grey.
#[derive(Clone, Debug, PartialEq)]
pub struct PaintedMap {
    size: [u32; 2],
    /// Row by row from the top: 0 is black, the largest number white.
    grey: Vec<u16>,
}

impl PaintedMap {
    /// Reads a PNG of 8 or 16 bits. Colours become grey, and what is transparent black.
    ///
    /// # Errors
    /// A file that is no PNG, is damaged, or has more than 4096 pixels along an edge.
    pub fn read(path: &Path) -> Result<Self> {
        let bytes = input::read(path, MOST_BYTES)?;
        Self::of_png(&bytes).map_err(|refused| refused.in_file(path))
    }

    fn of_png(bytes: &[u8]) -> Result<Self> {
        if !bytes.starts_with(b"\x89PNG\r\n\x1a\n") {
            return Err(Error::new("is not a PNG: save the map as a PNG of 8 or 16 bits"));
        }
        let damaged = |e: image::ImageError| Error::new(format!("is a damaged PNG: {e}"));
        let reader = || ImageReader::with_format(Cursor::new(bytes), ImageFormat::Png);
        // A few bytes may claim any size.
        let (width, height) = reader().into_dimensions().map_err(damaged)?;
        if width.max(height) > MOST_PIXELS {
            let what = format!("has {width} x {height} pixels: a map may have at most {MOST_PIXELS} along an edge");
            return Err(Error::new(what));
        }
        let picture = reader().decode().map_err(damaged)?;
        let (width, height) = picture.dimensions();
        let picture = picture.into_luma_alpha16();
        let grey = picture.pixels().map(|pixel| {
            let [grey, alpha] = pixel.0.map(u32::from);
            (grey * alpha / u32::from(u16::MAX)) as u16
        });
        Ok(Self { size: [width, height], grey: grey.collect() })
    }

    /// Its size and pixels, for an identity.
    pub fn bytes(&self) -> Vec<u8> {
        let size = self.size.iter().flat_map(|count| count.to_le_bytes());
        size.chain(self.grey.iter().flat_map(|grey| grey.to_le_bytes())).collect()
    }

    /// Its value at texture coordinates, v upward: 0 is black, 1 white. Linear between the middles of four pixels; beyond
    /// 0..1 the map repeats.
    pub fn at(&self, uv: Vec2) -> f32 {
        let [width, height] = self.size;
        let within = |x: f32| x - x.floor();
        let place = |part: f32, count: u32| {
            let at = part * count as f32 - 0.5;
            let first = (at.floor() as i64).rem_euclid(i64::from(count)) as u32;
            (first, (first + 1) % count, at - at.floor())
        };
        let (left, right, across) = place(within(uv.x), width);
        let (top, bottom, down) = place(1.0 - within(uv.y), height);
        let value = |x: u32, y: u32| f32::from(self.grey[(y * width + x) as usize]) / f32::from(u16::MAX);
        let row = |y: u32| value(left, y) + (value(right, y) - value(left, y)) * across;
        row(top) + (row(bottom) - row(top)) * down
    }
}

/// When a file was last changed, and its size; `None` if the system does not say.
pub fn stamp(path: &Path) -> Option<(u64, SystemTime)> {
    let of = std::fs::metadata(path).ok()?;
    Some((of.len(), of.modified().ok()?))
}

#[cfg(test)]
mod tests {
    use image::{DynamicImage, GrayImage, Luma, Rgba, RgbaImage};

    use super::*;

    fn png(picture: impl Into<DynamicImage>) -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        picture.into().write_to(&mut bytes, ImageFormat::Png).unwrap();
        bytes.into_inner()
    }

    #[test]
    fn a_map_is_read_where_it_was_painted() {
        // 2 x 4 pixels, white at the bottom right.
        let mut picture = GrayImage::new(2, 4);
        picture.put_pixel(1, 3, Luma([255]));
        let map = PaintedMap::of_png(&png(picture)).unwrap();
        let at = |u, v| map.at(Vec2::new(u, v));
        // Middles of pixels.
        assert_eq!([at(0.75, 0.125), at(0.25, 0.125), at(0.75, 0.375), at(0.75, 0.875)], [1.0, 0.0, 0.0, 0.0]);
        // Half way between two and four of them, also across the edges.
        assert_eq!([at(0.5, 0.125), at(0.5, 0.25), at(0.0, 0.125), at(1.0, 0.0)], [0.5, 0.25, 0.5, 0.25]);
        // It repeats.
        assert_eq!([at(-0.25, 1.125), at(5.75, -2.875)], [1.0, 1.0]);
    }

    #[test]
    fn colours_are_grey_and_what_is_transparent_is_black() {
        let mut picture = RgbaImage::new(1, 1);
        let mut value = |rgba| {
            picture.put_pixel(0, 0, Rgba(rgba));
            PaintedMap::of_png(&png(picture.clone())).unwrap().at(Vec2::ZERO)
        };
        assert_eq!([value([255; 4]), value([255, 255, 255, 0]), value([0, 0, 0, 255])], [1.0, 0.0, 0.0]);
        assert!((value([255, 255, 255, 51]) - 0.2).abs() < 1e-4);
    }

    #[test]
    fn what_is_no_map_is_refused_by_one_line() {
        let line = |bytes: &[u8]| PaintedMap::of_png(bytes).unwrap_err().to_string();
        assert_eq!(line(b"GIF89a"), "is not a PNG: save the map as a PNG of 8 or 16 bits");
        let sound = png(GrayImage::new(30, 30));
        assert!(line(&sound[..sound.len() / 2]).starts_with("is a damaged PNG: "));
        let large = png(GrayImage::new(4097, 1));
        assert_eq!(line(&large), "has 4097 x 1 pixels: a map may have at most 4096 along an edge");
    }
}
