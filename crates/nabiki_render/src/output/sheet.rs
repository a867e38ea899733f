//! Contact sheets: chosen frames side by side, each with its number and the force that drives it.

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

/// A force at a point, to be drawn as an arrow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForceArrow {
    /// Where it begins (cm).
    pub point: Vec3,
    /// The force.
    pub force: Vec3,
}

/// Pictures gathered for a sheet, as Figure 6 of the paper shows them: only the small ones are kept.
pub struct ContactSheet {
    columns: usize,
    pictures: Vec<Canvas>,
}

impl ContactSheet {
    /// A sheet with `columns` pictures in a row (at least 1).
    pub fn new(columns: usize) -> Self {
        Self { columns: columns.max(1), pictures: Vec::new() }
    }

    /// Adds a frame with its number; with `force` (head space) as an arrow beside it, drawn as `view` sees it.
    ///
    /// A force seen end on is a dot; its three numbers stand below the arrow.
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

    /// Adds a frame with its number and arrows of a force that differs from place to place: each begins at its point, as
    /// `view` sees it, and the largest is a tenth of the picture long. Its size stands below.
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

    /// Whether nothing was added yet.
    pub fn is_empty(&self) -> bool {
        self.pictures.is_empty()
    }

    /// The sheet as it stands.
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
