//! What is to be done in the order of distance from a lamp, in 16 bytes: all of it is moved about in memory, for each lamp.

use glam::Vec3;

/// A node or place that asks how many fibres are before it, or a part of a piece of hair whose fibre is laid down.
#[derive(Clone, Copy, Default)]
pub struct Item {
    /// Its place (cells right and down): of a part its middle.
    pub at: [f32; 2],
    /// The receiver, or a part's extent in steps of [`EXTENT`].
    extent: u32,
    /// A part's fibre when spread over one cell (fibres); of a receiver [`READS`].
    fibres: f32,
}

/// The fibre of a part of a piece, as the lamp sees it.
#[derive(Clone, Copy)]
pub struct Fibre {
    /// Its extent (cells), and how many fibres it is when spread over one cell.
    pub extent: [f32; 2],
    pub fibres: f32,
}

/// Fibres of what reads.
const READS: f32 = -1.0;
/// Steps of a part's extent for each cell: parts reach at most 32 cells.
const EXTENT: f32 = 1023.0;

impl Item {
    /// Receiver `i` at a place of the map.
    #[inline(always)]
    pub fn reads(at: Vec3, i: usize) -> Self {
        Self { at: [at.x, at.y], extent: i as u32, fibres: READS }
    }

    /// A part of hair with its middle at a place of the map.
    #[inline(always)]
    pub fn lays(at: Vec3, fibre: &Fibre) -> Self {
        let [x, y] = fibre.extent.map(|e| u32::from((e * EXTENT) as i16 as u16));
        Self { at: [at.x, at.y], extent: y << 16 | x, fibres: fibre.fibres }
    }

    /// Which receiver it is, if it reads.
    #[inline(always)]
    pub fn receiver(&self) -> Option<usize> {
        (self.fibres < 0.0).then_some(self.extent as usize)
    }

    /// The fibre that it lays down.
    #[inline(always)]
    pub fn fibre(&self) -> Fibre {
        let extent = [self.extent as i16, (self.extent >> 16) as i16].map(|e| f32::from(e) * (1.0 / EXTENT));
        Fibre { extent, fibres: self.fibres }
    }

    /// How far above and below its middle a part lays fibre, at the most (cells).
    #[inline(always)]
    pub fn half_height(&self) -> f32 {
        1.0 + 0.5 * self.fibre().extent[1].abs()
    }
}
