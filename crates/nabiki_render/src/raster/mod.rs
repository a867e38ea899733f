//! From nodes on the picture to pixels: sorting pieces of hair into tiles, and drawing each tile.

use std::ops::Range;

use crate::lens::Spread;

pub mod bins;
pub mod coverage;
pub mod oversample;

/// Side of a tile (pixels).
pub const TILE: usize = 16;

/// Hair this little (cm) behind the skin is still drawn: roots lie on it.
pub const BURIED: f32 = 0.06;

/// Cells along each side of a pixel, and in all of it.
pub const SIDE: usize = 4;
pub const CELLS: usize = SIDE * SIDE;

/// Centre of a cell from its pixel's upper left corner (pixels).
#[inline(always)]
pub fn cell_offset(cell: usize) -> [f32; 2] {
    [(cell % SIDE) as f32, (cell / SIDE) as f32].map(|c| (c + 0.5) / SIDE as f32)
}

/// A node of a curve as the picture sees it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Node {
    /// Place (pixels, right and down).
    pub at: [f32; 2],
    /// Depth (cm).
    pub depth: f32,
    /// Half of the hair's thickness (pixels).
    pub radius: f32,
    /// Light toward the eye (linear red, green, blue).
    pub light: [f32; 3],
    /// Unit direction on the picture, or zero where the hair points at the eye.
    pub direction: [f32; 2],
    /// Movement while the shutter is open (pixels), and growth of its depth (cm).
    pub motion: [f32; 2],
    pub recession: f32,
    /// Which strand it belongs to; pieces join neighbours of the same strand.
    pub strand: u32,
    /// False where it is too near to the eye, or behind it.
    pub drawable: bool,
    /// The first or last of its strand.
    pub end: bool,
    /// Known to lie behind the head or beside the picture.
    pub hidden: bool,
}

/// A straight piece between two nodes, prepared for drawing.
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
}

/// One end of a piece: of its node, what drawing needs.
#[derive(Clone, Copy, Debug)]
pub struct End {
    pub at: [f32; 2],
    pub depth: f32,
    pub radius: f32,
    pub light: [f32; 3],
    /// Movement while the shutter is open (pixels), and growth of its depth (cm).
    pub motion: [f32; 2],
    pub recession: f32,
    /// Half the width to which a lens spreads it (pixels).
    pub spread: f32,
    /// Whether the strand begins or stops here.
    pub last: bool,
}

impl Piece {
    /// Between node `number` and the next; none where that has no length on the picture.
    #[inline]
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
        let end = |n: &Node| End {
            at: n.at,
            depth: n.depth,
            radius: n.radius,
            light: n.light,
            motion: n.motion,
            recession: n.recession,
            spread: spread.at(n.depth),
            last: n.end,
        };
        Some(Self { a: end(a), b: end(b), cut: [border(a), border(b)], unit, per_length, number })
    }

    /// Distance of a point from the piece's line (pixels).
    #[inline]
    pub fn distance(&self, point: [f32; 2]) -> f32 {
        let from_a = [point[0] - self.a.at[0], point[1] - self.a.at[1]];
        (from_a[0] * self.unit[1] - from_a[1] * self.unit[0]).abs()
    }

    /// Whether the piece reaches some lines of a tile, counted from the tile's `corner` (pixels) along the axis that the piece follows
    /// more.
    #[inline]
    pub fn reaches(&self, corner: [f32; 2], lines: &Range<usize>) -> bool {
        let major = self.major();
        let [start, end] = [self.a.at[major], self.b.at[major]].map(|c| c - corner[major]);
        // As far as drawing reaches beyond the ends.
        let overhang = self.thickest() + 0.2;
        start.max(end) + overhang >= lines.start as f32 && start.min(end) - overhang <= lines.end as f32
    }

    /// Where on the piece (0..1) a line lies, counted likewise; at its nearer end if it lies beyond.
    #[inline]
    pub fn along(&self, corner: [f32; 2], line: f32) -> f32 {
        let major = self.major();
        ((line - (self.a.at[major] - corner[major])) * self.per_length / self.unit[major]).clamp(0.0, 1.0)
    }

    /// The axis that the piece follows more, 0 for x.
    #[inline]
    fn major(&self) -> usize {
        usize::from(self.unit[1].abs() > self.unit[0].abs())
    }

    /// Half of its width at its thicker end, as far as a lens spreads it (pixels).
    #[inline]
    fn thickest(&self) -> f32 {
        self.a.radius.max(self.b.radius).max(self.a.spread).max(self.b.spread)
    }

    /// How far from its line the piece reaches (pixels), moving hair included.
    #[inline]
    pub fn reach(&self) -> f32 {
        let moved = |n: &End| n.motion[0].abs().max(n.motion[1].abs());
        1.42 * self.thickest() + moved(&self.a).max(moved(&self.b))
    }
}
