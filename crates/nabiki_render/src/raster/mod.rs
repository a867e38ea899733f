//! From nodes on the picture to pixels: sorting pieces of hair into tiles, and drawing each tile.

pub mod bins;
pub mod coverage;
pub mod oversample;
mod piece;

pub use piece::Piece;

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
