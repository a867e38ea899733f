//! Contact sheets: chosen frames side by side, each with its number and force.

use std::path::Path;

use glam::Vec3;

use super::canvas::Canvas;
use crate::RenderError;
use crate::camera::{NEAR, View};
use crate::frame::Frame;
use crate::tone_mapping::ToneMapping;

/// Widest thumbnail (pixels); larger frames are shrunk by a whole number.
const WIDEST: usize = 960;
const GAP: usize = 12;
const PAPER: [u8; 3] = [24, 25, 28];
const INK: [u8; 3] = [235, 235, 230];
const ARROW: [u8; 3] = [255, 176, 64];

/// A force at a point, drawn as an arrow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForceArrow {
    /// Start of the arrow (cm).
    pub point: Vec3,
    /// The force.
    pub force: Vec3,
}

/// Pictures for a contact sheet like Figure 6 of the paper. Only thumbnails are kept.
pub struct ContactSheet {
    columns: usize,
    pictures: Vec<Canvas>,
}

impl ContactSheet {
    /// A sheet with `columns` pictures per row (at least 1).
    pub fn new(columns: usize) -> Self {
        Self { columns: columns.max(1), pictures: Vec::new() }
    }

    /// Adds a frame with its number, and `force` (head space) as an arrow next to it, as seen by `view`.
    ///
    /// A force along the line of sight is a dot. Its three numbers are below the arrow.
    pub fn add(&mut self, frame: &Frame, tone_mapping: &ToneMapping, number: u32, force: Option<Vec3>, view: &View) {
        let size = frame.size.map(|s| s as usize);
        let mut picture = Canvas::shrunk(size, &tone_mapping.rgba8(frame), size[0].div_ceil(WIDEST));
        let [width, height] = picture.size().map(|s| s as f32);
        let text = (height / 28.0).clamp(6.0, 18.0);
        picture.label(&format!("frame {number}"), [text, 2.0 * text], text, INK, PAPER);
        if let Some(force) = force {
            // Between two keys a force has more digits than anybody reads; and no -0.
            let [x, y, z] = force.to_array().map(|f| (100.0 * f).round() / 100.0 + 0.0);
            let caption = format!("F = ({x}, {y}, {z})");
            let at = [text, height - text];
            picture.label(&caption, at, 0.8 * text, INK, PAPER);
            let [x, y] = view.in_picture(force);
            let reach = 0.09 * width.min(height);
            let middle = [text + reach, height - 2.6 * text - reach];
            let half = [x * reach, y * reach];
            let (from, to) = ([middle[0] - half[0], middle[1] - half[1]], [middle[0] + half[0], middle[1] + half[1]]);
            if force != Vec3::ZERO {
                picture.arrow(from, to, (height / 160.0).max(1.5), ARROW);
            }
        }
        self.pictures.push(picture);
    }

    /// Adds a frame with its number and arrows of a force that varies in space. Each starts at its point, as seen by
    /// `view`. The largest is a tenth of the picture long; its strength is below.
    pub fn add_arrows(
        &mut self,
        frame: &Frame,
        tone_mapping: &ToneMapping,
        number: u32,
        arrows: &[ForceArrow],
        view: &View,
    ) {
        self.add(frame, tone_mapping, number, None, view);
        let Some(picture) = self.pictures.last_mut() else { return };
        let [width, height] = picture.size().map(|s| s as f32);
        let shrunk = width / view.size[0] as f32;
        let largest = arrows.iter().map(|arrow| arrow.force.length()).fold(0.0, f32::max);
        let reach = 0.1 * width.min(height) / largest.max(f32::MIN_POSITIVE);
        for ForceArrow { point, force } in arrows {
            let at = view.project(*point);
            if at.z > NEAR && *force != Vec3::ZERO {
                let from = [at.x * shrunk, at.y * shrunk];
                let to = [from[0] + reach * force.dot(view.right), from[1] - reach * force.dot(view.up)];
                picture.arrow(from, to, (height / 300.0).max(1.0), ARROW);
            }
        }
        let text = (height / 28.0).clamp(6.0, 18.0);
        picture.label(&format!("largest F = {largest:.1}"), [text, height - text], 0.8 * text, INK, PAPER);
    }

    /// Whether the sheet is empty.
    pub fn is_empty(&self) -> bool {
        self.pictures.is_empty()
    }

    /// The sheet so far.
    pub fn canvas(&self) -> Canvas {
        let cell = self.pictures.iter().fold([1, 1], |m, p| [m[0].max(p.size()[0]), m[1].max(p.size()[1])]);
        let columns = self.columns.min(self.pictures.len().max(1));
        let rows = self.pictures.len().div_ceil(columns).max(1);
        let mut sheet = Canvas::new([GAP + columns * (cell[0] + GAP), GAP + rows * (cell[1] + GAP)], PAPER);
        for (i, picture) in self.pictures.iter().enumerate() {
            let place = [i % columns, i / columns];
            sheet.paste(picture, [GAP + place[0] * (cell[0] + GAP), GAP + place[1] * (cell[1] + GAP)]);
        }
        sheet
    }

    /// Writes the sheet as a PNG file.
    pub fn write(&self, path: &Path) -> Result<(), RenderError> {
        self.canvas().write_png(path)
    }
}

#[cfg(test)]
mod tests {
    use glam::vec3;

    use super::*;
    use crate::settings::{Camera, Picture, Projection};

    /// A frame of one colour, wider than a thumbnail may be, and what is seen from before the face with +z on the left.
    fn plain(rgb: [f32; 3]) -> (Frame, View) {
        let size = [1000, 400];
        let rgba = vec![[rgb[0], rgb[1], rgb[2], 1.0]; 1000 * 400];
        let camera = Camera { azimuth: 0.0, elevation: 0.0, projection: Projection::Orthographic, ..Camera::default() };
        (Frame { size, rgba, depth: Vec::new(), layers: Vec::new() }, View::new(&camera, size, &Default::default()))
    }

    /// The pixels of an arrow's colour: their number, and the middle of them.
    fn of_arrows(canvas: &Canvas) -> (usize, [f32; 2]) {
        let width = canvas.size()[0];
        let found = canvas.rgb().chunks_exact(3).enumerate().filter(|(_, rgb)| rgb[0] > rgb[2].saturating_add(100));
        let places: Vec<[f32; 2]> = found.map(|(i, _)| [i % width, i / width].map(|c| c as f32 + 0.5)).collect();
        let mean = [0, 1].map(|c| places.iter().map(|p| p[c]).sum::<f32>() / places.len().max(1) as f32);
        (places.len(), mean)
    }

    #[test]
    fn pictures_are_read_row_by_row_each_with_its_number_and_half_as_wide() {
        let tone_mapping = ToneMapping::new(&Picture::default());
        let colours = [[0.3, 0.01, 0.05], [0.02, 0.2, 0.0], [0.0, 0.1, 0.4]];
        let mut sheet = ContactSheet::new(2);
        let mut wanted = Vec::new();
        for (number, rgb) in [0, 17, 100].into_iter().zip(colours) {
            let (frame, view) = plain(rgb);
            sheet.add(&frame, &tone_mapping, number, None, &view);
            let colour = tone_mapping.values(rgb).map(|v| (255.0 * v).round() as u8);
            let mut picture = Canvas::new([500, 200], colour);
            let text = 200.0 / 28.0;
            picture.label(&format!("frame {number}"), [text, 2.0 * text], text, INK, PAPER);
            wanted.push(picture);
        }
        let canvas = sheet.canvas();
        assert_eq!(canvas.size(), [12 + 2 * 512, 12 + 2 * 212]);
        for (picture, [left, top]) in wanted.iter().zip([[12, 12], [524, 12], [12, 224]]) {
            for (y, row) in picture.rgb().chunks_exact(3 * 500).enumerate() {
                let on_sheet = &canvas.rgb()[3 * ((top + y) * canvas.size()[0] + left)..][..3 * 500];
                // Between two steps a pixel is one or the other.
                let apart = on_sheet.iter().zip(row).map(|(a, b)| a.abs_diff(*b)).max();
                assert!(apart <= Some(1), "row {y} of the picture at {left}, {top}: {apart:?}");
            }
        }
    }

    #[test]
    fn arrows_point_where_their_forces_push_on_the_picture() {
        let tone_mapping = ToneMapping::new(&Picture::default());
        let (frame, view) = plain([0.1; 3]);
        // The half of an arrow with its head is the larger one.
        let toward = |sheet: &ContactSheet, middle: [f32; 2], way: [f32; 2]| {
            let (count, mean) = of_arrows(&sheet.pictures[0]);
            let off = [mean[0] - middle[0], mean[1] - middle[1]];
            let along = off[0] * way[0] + off[1] * way[1];
            assert!(count > 8 && along > 1.0 && along > 0.9 * off[0].hypot(off[1]), "{way:?}: {count} {off:?}");
        };
        for (force, way) in [
            (vec3(0.0, 5.0, 0.0), [0.0, -1.0]),
            (vec3(0.0, -5.0, 0.0), [0.0, 1.0]),
            (vec3(0.0, 0.0, 5.0), [-1.0, 0.0]),
            (vec3(0.0, 3.0, -3.0), [0.5_f32.sqrt(), -0.5_f32.sqrt()]),
        ] {
            let mut sheet = ContactSheet::new(1);
            sheet.add(&frame, &tone_mapping, 0, Some(force), &view);
            let (text, reach) = (200.0 / 28.0, 0.09 * 200.0);
            toward(&sheet, [text + reach, 200.0 - 2.6 * text - reach], way);
            // One of many begins at its place, on the picture made half as wide.
            let mut sheet = ContactSheet::new(1);
            let point = vec3(0.0, 4.0, 6.0);
            sheet.add_arrows(&frame, &tone_mapping, 0, &[ForceArrow { point, force }], &view);
            let at = view.project(point);
            toward(&sheet, [0.5 * at.x, 0.5 * at.y], way);
        }
    }
}
