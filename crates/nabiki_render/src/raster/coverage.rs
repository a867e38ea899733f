//! Hair by its share of each pixel: smooth for any width.
//!
//! A pixel has 4 x 4 cells. Pieces of hair come nearest first; each takes from every cell the part that it covers of what nothing
//! nearer has covered. Across the hair that part is exact for a cell, along the axis that the piece follows more, so that
//! a hair's brightness in any row of cells is its width there, however thin it is. Motion blur
//! widens the hair and thins it out.

#![expect(clippy::needless_range_loop, reason = "cells side by side read as vector code")]

use pulp::{Simd, WithSimd};

use super::{BURIED, CELLS, Node, Piece, SIDE, TILE, cell_offset};
use crate::skin::SkinPixel;

/// Less than this of a pixel left (0..1), and nothing behind counts: a fifth of a step of 8 bit sRGB for equal light.
const NOTHING: f32 = 1.0 / 1024.0;
/// Pieces between one whose nodes are asked for and the one that is drawn.
const AHEAD: usize = 12;
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

/// The inner loops, compiled for each width of vectors that machines have; one is chosen at run time. There is no fused
/// multiplication, so all give the same bits.
struct DrawHair<'a, W> {
    work: &'a mut CoverageTile,
    tile: [usize; 2],
    nodes: &'a [Node],
    pieces: &'a [u32],
    watch: &'a mut W,
}

impl<W: Watch> WithSimd for DrawHair<'_, W> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        self.work.draw_hair(simd, self.tile, self.nodes, self.pieces, self.watch);
    }
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
        pulp::Arch::new().dispatch(DrawHair { work: self, tile, nodes, pieces, watch });
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
    fn draw_hair<S: Simd>(
        &mut self,
        simd: S,
        tile: [usize; 2],
        nodes: &[Node],
        pieces: &[u32],
        watch: &mut impl Watch,
    ) {
        let mut farthest = f32::INFINITY;
        for (n, &i) in pieces.iter().enumerate() {
            // Nodes come from all over memory: asking for those of later pieces now hides most of the wait.
            let ahead = pieces[(n + AHEAD).min(pieces.len() - 1)] as usize;
            std::hint::black_box((nodes[ahead].depth, nodes[ahead + 1].depth));
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
                self.piece(simd, tile, &piece, i, watch);
            }
        }
    }

    #[inline(always)]
    fn piece<S: Simd>(&mut self, simd: S, tile: [usize; 2], piece: &Piece, number: u32, watch: &mut impl Watch) {
        let Piece { a, b, unit, length, cut } = piece;
        let (zero, one) = (simd.splat_f32s(0.0), simd.splat_f32s(1.0));
        let corner = tile.map(|t| (t * TILE) as f32);
        // Walk along the axis that the piece follows more; across it, shares are taken along the other.
        let major = usize::from(unit[1].abs() > unit[0].abs());
        let minor = 1 - major;
        let slope = unit[minor] / unit[major];
        let widen = 1.0 / unit[major].abs();
        let start = [a.at[0] - corner[0], a.at[1] - corner[1]];
        let end = [b.at[0] - corner[0], b.at[1] - corner[1]];
        let per_major = 1.0 / (end[major] - start[major]);
        // A hair that moves is as wide as it moves far, and as much more transparent: half of its movement.
        let sway = |n: &Node| 0.5 * (n.motion[minor] - n.motion[major] * slope).abs();
        let (sway_a, sway_b) = (sway(a), sway(b));

        // Offsets of the cells: across the piece, and along the normals of its two ends.
        // At a strand's ends cells are shared in proportion; between two pieces each belongs to one of them, or their shares would
        // count as unrelated and leave gaps.
        let sharpness = |n: &Node| if n.end { SIDE as f32 } else { 4096.0 };
        let (sharp_a, sharp_b) = (sharpness(a), sharpness(b));
        let mut across = [0.0_f32; CELLS];
        let mut from_a = [0.0_f32; CELLS];
        let mut from_b = [0.0_f32; CELLS];
        for s in 0..CELLS {
            let o = cell_offset(s);
            across[s] = o[minor] - o[major] * slope;
            from_a[s] = (o[0] * cut[0][0] + o[1] * cut[0][1]) * sharp_a;
            from_b[s] = (o[0] * cut[1][0] + o[1] * cut[1][1]) * sharp_b;
        }

        let widest = a.radius.max(b.radius) * widen + sway_a.max(sway_b) + 0.5 / SIDE as f32;
        // Beyond its ends a piece reaches half a cell, and at a border aslant by at most its radius.
        let overhang = a.radius.max(b.radius) + 0.2;
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
            let spread = half.max(sway_a + (sway_b - sway_a) * t);
            let opacity = half / spread.max(f32::MIN_POSITIVE);
            let top = simd.splat_f32s(opacity * (2.0 * spread * SIDE as f32).min(1.0));
            let rise = simd.splat_f32s(opacity * (spread * SIDE as f32 + 0.5));
            let fall = simd.splat_f32s(opacity * SIDE as f32);
            for q in from..=to {
                let (x, y) = if major == 0 { (m, q) } else { (q, m) };
                let pixel = y * TILE + x;
                if depth > self.skin_far[pixel] {
                    continue;
                }
                let off = simd.splat_f32s(q as f32 - start[minor] - step * slope);
                let corner = [x as f32, y as f32];
                let after_a = ((corner[0] - start[0]) * cut[0][0] + (corner[1] - start[1]) * cut[0][1]) * sharp_a;
                let after_b = ((corner[0] - end[0]) * cut[1][0] + (corner[1] - end[1]) * cut[1][1]) * sharp_b;
                // A pixel's cells lie within 1.42 of its corner.
                let (at_a, at_b, at_skin) =
                    (after_a < 1.5 * sharp_a, after_b > -1.5 * sharp_b, depth > self.skin_near[pixel]);
                let (after_a, after_b) = (simd.splat_f32s(after_a + 0.5), simd.splat_f32s(0.5 - after_b));
                let across = S::as_simd_f32s(&across).0;
                let open = S::as_mut_simd_f32s(&mut self.open[pixel]).0;
                let mut taken = [0.0; CELLS];
                for (i, taken) in S::as_mut_simd_f32s(&mut taken).0.iter_mut().enumerate() {
                    let distance = simd.mul_f32s(simd.abs_f32s(simd.add_f32s(off, across[i])), fall);
                    let mut share = simd.min_f32s(simd.max_f32s(simd.sub_f32s(rise, distance), zero), top);
                    if at_a {
                        let within = simd.add_f32s(after_a, S::as_simd_f32s(&from_a).0[i]);
                        share = simd.mul_f32s(share, simd.min_f32s(simd.max_f32s(within, zero), one));
                    }
                    if at_b {
                        let within = simd.sub_f32s(after_b, S::as_simd_f32s(&from_b).0[i]);
                        share = simd.mul_f32s(share, simd.min_f32s(simd.max_f32s(within, zero), one));
                    }
                    if at_skin {
                        let before =
                            simd.less_than_f32s(simd.splat_f32s(depth), S::as_simd_f32s(&self.skin[pixel]).0[i]);
                        share = simd.select_f32s(before, share, zero);
                    }
                    *taken = simd.mul_f32s(share, open[i]);
                    open[i] = simd.sub_f32s(open[i], *taken);
                }
                // Always in this order, however wide the vectors.
                let quarter = |c: usize| (taken[c] + taken[c + 4]) + (taken[c + 8] + taken[c + 12]);
                let sum = ((quarter(0) + quarter(1)) + (quarter(2) + quarter(3))) * (1.0 / CELLS as f32);
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
