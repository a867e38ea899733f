//! A small 8-bit picture for thumbnails, antialiased strokes and captions.

use std::path::Path;

use super::{font, png};
use crate::RenderError;

/// An opaque sRGB picture, three bytes per pixel. Coordinates run right and down in pixels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Canvas {
    size: [usize; 2],
    rgb: Vec<u8>,
}

impl Canvas {
    /// A canvas of one colour.
    pub fn new(size: [usize; 2], colour: [u8; 3]) -> Self {
        Self { size, rgb: colour.repeat(size[0] * size[1]) }
    }

    /// Width and height (pixels).
    pub fn size(&self) -> [usize; 2] {
        self.size
    }

    /// The pixels, three bytes each.
    pub fn rgb(&self) -> &[u8] {
        &self.rgb
    }

    /// Pastes an opaque picture with its upper left corner at `at`. It is clipped at the edges.
    pub fn paste(&mut self, picture: &Canvas, at: [usize; 2]) {
        let width = picture.size[0].min(self.size[0].saturating_sub(at[0]));
        let height = picture.size[1].min(self.size[1].saturating_sub(at[1]));
        for y in 0..height {
            let from = 3 * y * picture.size[0];
            let to = 3 * ((at[1] + y) * self.size[0] + at[0]);
            self.rgb[to..to + 3 * width].copy_from_slice(&picture.rgb[from..from + 3 * width]);
        }
    }

    /// Draws a polyline with round ends, `width` pixels thick.
    pub fn stroke(&mut self, line: &[[f32; 2]], width: f32, colour: [u8; 3]) {
        let radius = width / 2.0;
        let finite = line.iter().flatten().all(|c| c.is_finite());
        if line.is_empty() || !finite {
            return;
        }
        let reach = radius + 1.0;
        let size = self.size;
        let range = |axis: usize| {
            let low = line.iter().fold(f32::INFINITY, |m, p| m.min(p[axis])) - reach;
            let high = line.iter().fold(f32::NEG_INFINITY, |m, p| m.max(p[axis])) + reach;
            low.max(0.0) as usize..((high.max(0.0) as usize).saturating_add(1)).min(size[axis])
        };
        for y in range(1) {
            for x in range(0) {
                let p = [x as f32 + 0.5, y as f32 + 0.5];
                let last = line.len() - 1;
                let nearest = (0..last.max(1))
                    .map(|i| distance_to_segment(p, line[i], line[(i + 1).min(last)]))
                    .fold(f32::INFINITY, f32::min);
                let share = (radius + 0.5 - nearest).clamp(0.0, 1.0);
                self.blend(x, y, colour, share);
            }
        }
    }

    /// Fills a triangle.
    pub fn triangle(&mut self, corners: [[f32; 2]; 3], colour: [u8; 3]) {
        let [a, b, c] = corners;
        let turn =
            |p: [f32; 2], q: [f32; 2], r: [f32; 2]| (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
        let side = turn(a, b, c).signum();
        let [low, high] =
            [f32::min as fn(f32, f32) -> f32, f32::max].map(|f| [0, 1].map(|i| f(f(a[i], b[i]), c[i]).max(0.0)));
        for y in low[1] as usize..(high[1] as usize + 1).min(self.size[1]) {
            for x in low[0] as usize..(high[0] as usize + 1).min(self.size[0]) {
                let inside = (0..16)
                    .filter(|s| {
                        let p = [x as f32 + (s % 4) as f32 / 4.0 + 0.125, y as f32 + (s / 4) as f32 / 4.0 + 0.125];
                        [(a, b), (b, c), (c, a)].iter().all(|&(q, r)| turn(q, r, p) * side >= 0.0)
                    })
                    .count();
                self.blend(x, y, colour, inside as f32 / 16.0);
            }
        }
    }

    /// Draws an arrow from `from` to `to`, with a head in proportion to its thickness.
    pub fn arrow(&mut self, from: [f32; 2], to: [f32; 2], width: f32, colour: [u8; 3]) {
        let along = [to[0] - from[0], to[1] - from[1]];
        let length = along[0].hypot(along[1]);
        if length < 1e-3 {
            self.stroke(&[from], 2.0 * width, colour);
            return;
        }
        let along = [along[0] / length, along[1] / length];
        let head = (5.0 * width).min(length);
        let neck = [to[0] - along[0] * head, to[1] - along[1] * head];
        let half = 0.5 * head;
        self.stroke(&[from, neck], width, colour);
        let corners = [
            to,
            [neck[0] - along[1] * half, neck[1] + along[0] * half],
            [neck[0] + along[1] * half, neck[1] - along[0] * half],
        ];
        self.triangle(corners, colour);
    }

    /// Writes a caption with the left end of its baseline at `at` and capitals of `height` pixels. Supported are
    /// digits, small letters, F and common signs; other characters become spaces.
    pub fn caption(&mut self, text: &str, at: [f32; 2], height: f32, colour: [u8; 3]) {
        for stroke in font::strokes(text, at[0], at[1], height) {
            self.stroke(&stroke, thickness(height), colour);
        }
    }

    /// Like [`caption`](Self::caption), with an outline, so that it is readable on any picture.
    pub fn label(&mut self, text: &str, at: [f32; 2], height: f32, colour: [u8; 3], edge: [u8; 3]) {
        for stroke in font::strokes(text, at[0], at[1], height) {
            self.stroke(&stroke, 3.0 * thickness(height), edge);
        }
        self.caption(text, at, height, colour);
    }

    /// Width of a caption (pixels).
    pub fn caption_width(text: &str, height: f32) -> f32 {
        font::width(text, height)
    }

    /// Writes the canvas as a PNG file.
    pub fn write_png(&self, path: &Path) -> Result<(), RenderError> {
        png::write_rgb8(path, self.size.map(|s| s as u32), &self.rgb)
    }

    /// Makes a canvas by averaging blocks of display values of a larger picture.
    pub fn shrunk(size: [usize; 2], rgba: &[u8], by: usize) -> Self {
        let small = size.map(|s| (s / by).max(1));
        let mut canvas = Self::new(small, [0; 3]);
        for y in 0..small[1] {
            for x in 0..small[0] {
                for c in 0..3 {
                    let mut sum = 0;
                    let mut count = 0;
                    for sy in y * by..((y + 1) * by).min(size[1]) {
                        for sx in x * by..((x + 1) * by).min(size[0]) {
                            sum += u32::from(rgba[4 * (sy * size[0] + sx) + c]);
                            count += 1;
                        }
                    }
                    canvas.rgb[3 * (y * small[0] + x) + c] = ((sum + count / 2) / count) as u8;
                }
            }
        }
        canvas
    }

    fn blend(&mut self, x: usize, y: usize, colour: [u8; 3], share: f32) {
        let at = 3 * (y * self.size[0] + x);
        for (old, new) in self.rgb[at..at + 3].iter_mut().zip(colour) {
            let mixed = f32::from(*old) + (f32::from(new) - f32::from(*old)) * share;
            *old = (mixed + 0.5) as u8;
        }
    }
}

/// Thickness of the strokes of letters (pixels).
fn thickness(height: f32) -> f32 {
    (height / 7.0).max(1.0)
}

fn distance_to_segment(p: [f32; 2], a: [f32; 2], b: [f32; 2]) -> f32 {
    let (ab, ap) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let squared = ab[0] * ab[0] + ab[1] * ab[1];
    let t = if squared > 0.0 { ((ap[0] * ab[0] + ap[1] * ab[1]) / squared).clamp(0.0, 1.0) } else { 0.0 };
    (ap[0] - t * ab[0]).hypot(ap[1] - t * ab[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_label_can_be_read_on_its_own_colour_and_on_its_edges() {
        let (ink, edge) = ([235; 3], [24; 3]);
        for ground in [ink, edge] {
            let mut canvas = Canvas::new([80, 20], ground);
            canvas.label("frame 8", [6.0, 14.0], 8.0, ink, edge);
            let bright = canvas.rgb.chunks_exact(3).filter(|pixel| pixel[0] > 130).count();
            // Six letters of 8 pixels at the least, with edges as wide at either side.
            let most = 80 * 20 - 6 * 8;
            assert!((6 * 8..most - 6 * 8).contains(&bright), "{bright}");
        }
    }
}
