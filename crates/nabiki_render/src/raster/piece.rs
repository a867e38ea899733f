//! A straight piece of hair between two nodes, with all that every part of it is drawn by.

use super::{Node, SIDE};
use crate::focus::Spread;

/// Movement across (pixels, both ends together) below which hair is as deep as halfway through it.
const MOVES: f32 = 0.05;

/// A straight piece between two nodes, prepared for drawing. It is walked line by line of the picture: rows if it is steep, columns
/// if it is flat.
#[derive(Clone, Copy, Debug)]
pub struct Piece {
    pub a: End,
    pub b: End,
    /// Normals of the lines through a and b at which the neighbouring pieces take over.
    pub cut: [[f32; 2]; 2],
    /// Unit direction on the picture, and one over the length (pixels).
    pub unit: [f32; 2],
    pub per_length: f32,
    /// Index of its first node.
    pub number: u32,
    /// The axis that it follows more, 0 for x: lines are told apart along it, and cross the piece along the other.
    pub major: u32,
    /// One over its unit direction along that axis, and its growth along the other for one pixel of this.
    pub per_unit: f32,
    pub slope: f32,
    /// How far movement or a lens spreads its ends to each side along a line (pixels).
    pub spreads: [f32; 2],
    /// The farthest that it moves to each side along a line (pixels), and the growth of its depth for a pixel of that (cm).
    pub sway: f32,
    pub recession: f32,
    /// Where it may leave traces: how far from its middle along a line centres of cells may lie, and lines before and behind its node a (pixels).
    pub beside: f32,
    pub extent: [f32; 2],
}

/// One end of a piece: of its node, what drawing needs.
#[derive(Clone, Copy, Debug)]
pub struct End {
    pub at: [f32; 2],
    pub depth: f32,
    pub radius: f32,
    pub light: [f32; 3],
    /// How fast its depth grows while the shutter is open (cm).
    pub recession: f32,
    /// Whether the strand begins or stops here.
    pub last: bool,
}

impl Piece {
    /// Between node `number` and the next; none where that has no length on the picture.
    #[inline(always)]
    pub fn new(a: &Node, b: &Node, number: u32, spread: &Spread) -> Option<Self> {
        let along = [b.at[0] - a.at[0], b.at[1] - a.at[1]];
        let length = (along[0] * along[0] + along[1] * along[1]).sqrt();
        if length.is_nan() || length < 1e-4 {
            return None;
        }
        let per_length = 1.0 / length;
        let unit = [along[0] * per_length, along[1] * per_length];
        // Where the curve turns sharply on the picture its tangent is no sensible border between two pieces.
        let border = |n: &Node| {
            let turn = n.direction[0] * unit[0] + n.direction[1] * unit[1];
            if turn > 0.7 { n.direction } else { unit }
        };
        let cut = [border(a), border(b)];
        let end = |n: &Node| End {
            at: n.at,
            depth: n.depth,
            radius: n.radius,
            light: n.light,
            recession: n.recession,
            last: n.end,
        };

        let major = usize::from(unit[1].abs() > unit[0].abs());
        let minor = 1 - major;
        let per_unit = 1.0 / unit[major];
        let (widen, slope) = (per_unit.abs(), unit[minor] * per_unit);
        // A hair that moves is as wide as it moves far, and as much more transparent: half of its movement.
        let aside = |n: &Node| n.motion[minor] - n.motion[major] * slope;
        let sways = [a, b].map(|n| 0.5 * aside(n).abs());
        // A lens spreads it across itself to both sides; what is wider anyhow stays as wide.
        let spreads = [0, 1].map(|i| sways[i].max(spread.at([a, b][i].depth) * widen));
        // Where it is farthest aside it is at the shutter's opening or closing, and as deep as it is then.
        let per_line = (b.depth - a.depth) * per_length * per_unit;
        let deeper = |n: &Node| n.recession - n.motion[major] * per_line;
        let (across, in_depth) = (aside(a) + aside(b), deeper(a) + deeper(b));
        let recession = if across.abs() > MOVES { in_depth / across } else { 0.0 };
        let beside = a.radius.max(b.radius) * widen + spreads[0].max(spreads[1]) + 0.5 / SIDE as f32;
        // Beyond its ends it reaches as far as the border there goes aslant, and half a cell where the strand ends.
        let overhang = |n: &Node, cut: &[f32; 2]| {
            let turn = cut[0] * unit[0] + cut[1] * unit[1];
            let half = if n.end { 0.5 / SIDE as f32 } else { 0.0 };
            (half + cut[minor].abs() * beside) / (turn * widen) + 1e-3
        };
        let (before, after) = (overhang(a, &cut[0]), overhang(b, &cut[1]));
        // Centres of cells are half a cell within their pixel.
        let inner = 0.5 / SIDE as f32;
        let extent = if unit[major] > 0.0 {
            [inner - before, along[major] + after - inner]
        } else {
            [along[major] - after + inner, before - inner]
        };
        Some(Self {
            a: end(a),
            b: end(b),
            cut,
            unit,
            per_length,
            number,
            major: major as u32,
            per_unit,
            slope,
            spreads,
            sway: sways[0].max(sways[1]),
            recession,
            beside,
            extent,
        })
    }

    /// The axis along which lines are told apart, and the other.
    #[inline(always)]
    pub fn axes(&self) -> (usize, usize) {
        let major = usize::from(self.major > 0);
        (major, 1 - major)
    }

    /// Where it lies along a line of the picture, in the middle between its edges, counted as the lines are from a `corner` (pixels).
    #[inline(always)]
    pub fn middle(&self, corner: [f32; 2], line: f32) -> f32 {
        let (major, minor) = self.axes();
        (self.a.at[minor] - corner[minor]) + (line + 0.5 - (self.a.at[major] - corner[major])) * self.slope
    }

    /// The first and last place (pixels) along lines `first` to `last` that it may touch: edges of pixels lie half of a line's growth
    /// farther than centres of cells.
    #[inline(always)]
    pub fn reach(&self, corner: [f32; 2], first: f32, last: f32) -> [f32; 2] {
        let ends = [self.middle(corner, first), self.middle(corner, last)];
        let reach = self.beside + 0.5 * self.slope.abs();
        [ends[0].min(ends[1]) - reach, ends[0].max(ends[1]) + reach]
    }

    /// The lines that it may touch lie from the first to the second of these, each up to a line before.
    #[inline(always)]
    pub fn lines(&self, corner: [f32; 2]) -> [f32; 2] {
        let (major, _) = self.axes();
        self.extent.map(|line| line + (self.a.at[major] - corner[major]))
    }

    /// Where on the piece (0..1) a line lies, counted likewise; at its nearer end if it lies beyond.
    #[inline(always)]
    pub fn along(&self, corner: [f32; 2], line: f32) -> f32 {
        let (major, _) = self.axes();
        ((line - (self.a.at[major] - corner[major])) * (self.per_length * self.per_unit)).clamp(0.0, 1.0)
    }
}
