//! Hair by its share of each pixel: smooth for any width.
//!
//! A pixel has 4 x 4 cells. Pieces of hair come nearest first; each takes from every cell the part that it covers of what nothing
//! nearer has covered. Across the hair that part is exact for a cell, along the axis that the piece follows more, so that
//! a hair's brightness in any row of cells is its width there, however thin it is. Motion blur only widens
//! the cell over which the share is taken.

#![expect(clippy::needless_range_loop, reason = "cells side by side read as vector code")]

use super::{BURIED, CELLS, Node, Piece, SIDE, TILE, cell_offset};
use crate::skin::SkinPixel;

/// Less than this of a pixel left (0..1), and nothing behind counts: a fifth of a step of 8 bit sRGB for equal light.
const NOTHING: f32 = 1.0 / 1024.0;
const PIXELS: usize = TILE * TILE;

/// Working memory for one tile.
pub struct CoverageTile {
    /// Part of each cell that nothing has covered yet.
    open: Vec<[f32; CELLS]>,
    /// Mean of `open`, and the light gathered so far.
    left: Vec<f32>,
    light: Vec<[f32; 4]>,
    nearest: Vec<f32>,
    /// Depth of the skin in each cell, and its extremes in each pixel. A pixel that is full has its farthest at -infinity.
    skin: Vec<[f32; CELLS]>,
    skin_near: Vec<f32>,
    skin_far: Vec<f32>,
}

/// What a tile's pixels hold when it is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Drawn {
    /// Premultiplied light and alpha of hair and skin.
    pub light: [f32; 4],
    pub depth: f32,
}

/// Told of each share that a piece gets: pixel in the tile, share, place along the piece (0..1), first node.
pub trait Watch {
    fn hair(&mut self, pixel: usize, share: f32, along: f32, piece: u32);
}

impl Watch for () {
    #[inline(always)]
    fn hair(&mut self, _: usize, _: f32, _: f32, _: u32) {}
}

impl CoverageTile {
    pub fn new() -> Self {
        Self {
            open: vec![[1.0; CELLS]; PIXELS],
            left: vec![1.0; PIXELS],
            light: vec![[0.0; 4]; PIXELS],
            nearest: vec![f32::INFINITY; PIXELS],
            skin: vec![[f32::INFINITY; CELLS]; PIXELS],
            skin_near: vec![f32::INFINITY; PIXELS],
            skin_far: vec![f32::INFINITY; PIXELS],
        }
    }

    /// Draws the tile: pieces of hair, nearest first, before the skin's pieces with their light. Skin without light hides
    /// hair all the same.
    pub fn draw(
        &mut self,
        tile: [usize; 2],
        nodes: &[Node],
        pieces: &[u32],
        skin: (&[SkinPixel], Option<&[[f32; 3]]>),
        watch: &mut impl Watch,
    ) {
        self.clear(skin.0);
        pulp::Arch::new().dispatch(
            #[inline(always)]
            || self.draw_hair(tile, nodes, pieces, watch),
        );
        if let Some(light) = skin.1 {
            self.add_skin(skin.0, light);
        }
    }

    /// What pixel `i` of the tile holds.
    pub fn drawn(&self, i: usize) -> Drawn {
        Drawn { light: self.light[i], depth: self.nearest[i] }
    }

    fn clear(&mut self, skin: &[SkinPixel]) {
        self.open.fill([1.0; CELLS]);
        self.left.fill(1.0);
        self.light.fill([0.0; 4]);
        self.nearest.fill(f32::INFINITY);
        self.skin.fill([f32::INFINITY; CELLS]);
        self.skin_near.fill(f32::INFINITY);
        self.skin_far.fill(f32::INFINITY);
        for piece in skin {
            let i = usize::from(piece.pixel);
            for s in (0..CELLS).filter(|s| piece.mask >> s & 1 == 1) {
                let offset = cell_offset(s);
                let depth = piece.depth + piece.slope[0] * (offset[0] - 0.5) + piece.slope[1] * (offset[1] - 0.5);
                self.skin[i][s] = depth + BURIED;
                self.skin_near[i] = self.skin_near[i].min(depth + BURIED);
            }
            self.skin_far[i] = self.skin[i].iter().copied().fold(0.0, f32::max);
        }
    }

    fn add_skin(&mut self, skin: &[SkinPixel], light: &[[f32; 3]]) {
        for (piece, light) in skin.iter().zip(light) {
            let i = usize::from(piece.pixel);
            let cells = (0..CELLS).filter(|s| piece.mask >> s & 1 == 1);
            let share = cells.map(|s| self.open[i][s]).sum::<f32>() / CELLS as f32;
            if share > 0.0 {
                self.nearest[i] = self.nearest[i].min(piece.depth);
                let sum = &mut self.light[i];
                *sum =
                    [sum[0] + share * light[0], sum[1] + share * light[1], sum[2] + share * light[2], sum[3] + share];
            }
        }
    }

    #[inline(always)]
    fn draw_hair(&mut self, tile: [usize; 2], nodes: &[Node], pieces: &[u32], watch: &mut impl Watch) {
        let mut farthest = f32::INFINITY;
        for (n, &i) in pieces.iter().enumerate() {
            let (a, b) = (&nodes[i as usize], &nodes[i as usize + 1]);
            if n % 64 == 0 {
                farthest = self.skin_far.iter().copied().fold(f32::NEG_INFINITY, f32::max);
            }
            if a.depth.min(b.depth) > farthest {
                // Pieces are sorted by their middles: a later one may begin nearer, but not by much.
                if 0.5 * (a.depth + b.depth) > farthest + 1.0 || farthest == f32::NEG_INFINITY {
                    break;
                }
                continue;
            }
            if let Some(piece) = Piece::new(a, b) {
                self.piece(tile, &piece, i, watch);
            }
        }
    }

    #[inline(always)]
    fn piece(&mut self, tile: [usize; 2], piece: &Piece, number: u32, watch: &mut impl Watch) {
        let Piece { a, b, unit, length, cut } = piece;
        let corner = tile.map(|t| (t * TILE) as f32);
        // Walk along the axis that the piece follows more; across it, shares are taken along the other.
        let major = usize::from(unit[1].abs() > unit[0].abs());
        let minor = 1 - major;
        let slope = unit[minor] / unit[major];
        let widen = 1.0 / unit[major].abs();
        let start = [a.at[0] - corner[0], a.at[1] - corner[1]];
        let end = [b.at[0] - corner[0], b.at[1] - corner[1]];
        let per_major = 1.0 / (end[major] - start[major]);
        let sway = |n: &Node| (n.motion[minor] - n.motion[major] * slope).abs();
        let (cell_a, cell_b) = (1.0 / SIDE as f32 + sway(a), 1.0 / SIDE as f32 + sway(b));

        // Offsets of the cells: across the piece, and along the normals of its two ends (in cells).
        let mut across = [0.0; CELLS];
        let mut from_a = [0.0; CELLS];
        let mut from_b = [0.0; CELLS];
        for s in 0..CELLS {
            let o = cell_offset(s);
            across[s] = o[minor] - o[major] * slope;
            from_a[s] = (o[0] * cut[0][0] + o[1] * cut[0][1]) * SIDE as f32;
            from_b[s] = (o[0] * cut[1][0] + o[1] * cut[1][1]) * SIDE as f32;
        }

        let widest = a.radius.max(b.radius) * widen + 0.5 * cell_a.max(cell_b);
        let overhang = a.radius.max(b.radius) + 1.0;
        let low = start[major].min(end[major]) - overhang;
        let high = start[major].max(end[major]) + overhang;
        let (first, last) = (low.max(0.0) as usize, high.clamp(0.0, TILE as f32 - 0.001) as usize);
        if high < 0.0 || low >= TILE as f32 {
            return;
        }
        for m in first..=last {
            let step = m as f32 - start[major];
            let middle = start[minor] + (step + 0.5) * slope;
            let reach = widest + 0.5 * slope.abs();
            if middle + reach <= 0.0 || middle - reach >= TILE as f32 {
                continue;
            }
            let from = (middle - reach).max(0.0) as usize;
            let to = (middle + reach).clamp(0.0, TILE as f32 - 0.001) as usize;
            let t = ((step + 0.5) * per_major).clamp(0.0, 1.0);
            let depth = a.depth + (b.depth - a.depth) * t;
            let half = (a.radius + (b.radius - a.radius) * t) * widen;
            let cell = cell_a + (cell_b - cell_a) * t;
            let per_cell = 1.0 / cell;
            let top = (2.0 * half * per_cell).min(1.0);
            let rise = half * per_cell + 0.5;
            for q in from..=to {
                let (x, y) = if major == 0 { (m, q) } else { (q, m) };
                let pixel = y * TILE + x;
                if depth > self.skin_far[pixel] {
                    continue;
                }
                let off = q as f32 - start[minor] - step * slope;
                let mut share = [0.0; CELLS];
                for s in 0..CELLS {
                    share[s] = (rise - (off + across[s]).abs() * per_cell).max(0.0).min(top);
                }
                let corner = [x as f32, y as f32];
                let after_a = ((corner[0] - start[0]) * cut[0][0] + (corner[1] - start[1]) * cut[0][1]) * SIDE as f32;
                let after_b = ((corner[0] - end[0]) * cut[1][0] + (corner[1] - end[1]) * cut[1][1]) * SIDE as f32;
                // A pixel's cells lie within 1.42 of its corner, that is, within 6 cells.
                if after_a < 6.0 {
                    for s in 0..CELLS {
                        share[s] *= (after_a + from_a[s] + 0.5).clamp(0.0, 1.0);
                    }
                }
                if after_b > -6.0 {
                    for s in 0..CELLS {
                        share[s] *= (0.5 - after_b - from_b[s]).clamp(0.0, 1.0);
                    }
                }
                if depth > self.skin_near[pixel] {
                    for s in 0..CELLS {
                        share[s] = if depth > self.skin[pixel][s] { 0.0 } else { share[s] };
                    }
                }
                let open = &mut self.open[pixel];
                let mut sums = [0.0; CELLS];
                for s in 0..CELLS {
                    let taken = share[s] * open[s];
                    open[s] -= taken;
                    sums[s] = taken;
                }
                for width in [8, 4, 2, 1] {
                    for s in 0..width {
                        sums[s] += sums[s + width];
                    }
                }
                let sum = sums[0] * (1.0 / CELLS as f32);
                if sum > 0.0 {
                    let along = [(x as f32 + 0.5 - start[0]) * unit[0], (y as f32 + 0.5 - start[1]) * unit[1]];
                    let t = ((along[0] + along[1]) / length).clamp(0.0, 1.0);
                    let light = &mut self.light[pixel];
                    for c in 0..3 {
                        light[c] += sum * (a.light[c] + (b.light[c] - a.light[c]) * t);
                    }
                    light[3] += sum;
                    self.nearest[pixel] = self.nearest[pixel].min(depth);
                    watch.hair(pixel, sum, t, number);
                    self.left[pixel] -= sum;
                    if self.left[pixel] < NOTHING {
                        self.skin_far[pixel] = f32::NEG_INFINITY;
                    }
                }
            }
        }
    }
}
