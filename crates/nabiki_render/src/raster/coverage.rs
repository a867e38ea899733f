//! Hair by its share of each pixel: smooth for any width.
//!
//! A pixel has 4 x 4 cells. Pieces of hair come nearest first; each takes from every cell the part that it covers of what nothing
//! nearer has covered. Across the hair that part is exact for a cell, along the axis that the piece follows more, so that
//! a hair's brightness in any row of cells is its width there, however thin it is. Motion blur
//! widens the hair and thins it out.

use std::ops::Range;

use pulp::{Simd, WithSimd};

use super::piece::{End, Piece};
use super::{BURIED, CELLS, SIDE, TILE, cell_offset};
use crate::skin::SkinPixel;

/// Once less than this of a pixel is left open it counts as full, and what it holds stands for the rest of it: before a white wall one step
/// of 8 bits.
const NOTHING: f32 = 1.0 / 512.0;
const PIXELS: usize = TILE * TILE;
/// Pieces that lie this much behind a full tile are no reason to look for nearer ones (cm): longer than half a piece, by
/// which one may come nearer than where it was sorted.
const SLACK: f32 = 1.0;

/// Working memory for one tile.
pub struct CoverageTile {
    /// Part of each cell that nothing has covered yet.
    open: Box<[[f32; CELLS]; PIXELS]>,
    /// Mean of `open`, and the light gathered so far.
    left: Box<[f32; PIXELS]>,
    light: Box<[[f32; 4]; PIXELS]>,
    nearest: Box<[f32; PIXELS]>,
    /// Depth of the skin in each cell, and its extremes in each pixel.
    skin: Box<[[f32; CELLS]; PIXELS]>,
    skin_near: Box<[f32; PIXELS]>,
    skin_far: Box<[f32; PIXELS]>,
    /// Farthest skin of the tile.
    farthest: f32,
    /// Half of the farthest that hair moves in depth while the shutter is open (cm).
    sway: f32,
    /// Which pixels are full, a bit each: row after row, and column after column.
    full: [[u16; TILE]; 2],
    filled: usize,
}

/// What a tile's pixels hold when it is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Drawn {
    /// Premultiplied light and alpha of hair and skin.
    pub light: [f32; 4],
    pub depth: f32,
}

/// Told of each share of a pixel of the tile.
pub trait Watch {
    /// A piece of hair got it: where along the piece (0..1), and its first node.
    fn hair(&mut self, pixel: usize, share: f32, along: f32, piece: u32);
    /// The shares of hair in it stand for all of it, which is so many times their sum.
    fn full(&mut self, pixel: usize, whole: f32);
    /// A piece of skin got it: which of the tile.
    fn skin(&mut self, pixel: usize, share: f32, piece: usize);
}

impl Watch for () {
    #[inline(always)]
    fn hair(&mut self, _: usize, _: f32, _: f32, _: u32) {}
    #[inline(always)]
    fn full(&mut self, _: usize, _: f32) {}
    #[inline(always)]
    fn skin(&mut self, _: usize, _: f32, _: usize) {}
}

/// The inner loops, compiled for each width of vectors that machines have; one is chosen at run time. There is no fused
/// multiplication, so all give the same bits.
struct DrawHair<'a, W, P> {
    work: &'a mut CoverageTile,
    tile: [usize; 2],
    pieces: P,
    watch: &'a mut W,
}

impl<'p, W: Watch, P: Iterator<Item = (&'p Piece, Range<usize>)>> WithSimd for DrawHair<'_, W, P> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        self.work.draw_hair(simd, self.tile, self.pieces, self.watch);
    }
}

impl CoverageTile {
    /// `recession`: the farthest that hair moves in depth while the shutter is open (cm), 0 where it is not.
    pub fn new(recession: f32) -> Self {
        let sway = 0.5 * recession;
        Self {
            open: Box::new([[1.0; CELLS]; PIXELS]),
            left: Box::new([1.0; PIXELS]),
            light: Box::new([[0.0; 4]; PIXELS]),
            nearest: Box::new([f32::INFINITY; PIXELS]),
            skin: Box::new([[f32::INFINITY; CELLS]; PIXELS]),
            skin_near: Box::new([f32::INFINITY; PIXELS]),
            skin_far: Box::new([f32::INFINITY; PIXELS]),
            farthest: f32::INFINITY,
            sway,
            full: [[0; TILE]; 2],
            filled: 0,
        }
    }

    /// Draws the tile: pieces of hair, nearest first, before the skin's pieces, whose light is asked for where they would show. Skin
    /// without light hides hair all the same.
    pub fn draw<'p>(
        &mut self,
        tile: [usize; 2],
        pieces: impl Iterator<Item = (&'p Piece, Range<usize>)>,
        skin: (&[SkinPixel], impl FnMut(usize) -> Option<[f32; 3]>),
        watch: &mut impl Watch,
    ) {
        self.clear(skin.0);
        pulp::Arch::new().dispatch(DrawHair { work: self, tile, pieces, watch: &mut *watch });
        self.add_skin(skin.0, skin.1, watch);
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
        self.full = [[0; TILE]; 2];
        self.filled = 0;
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
        self.farthest = self.skin_far.iter().copied().fold(0.0, f32::max);
    }

    fn add_skin(
        &mut self,
        skin: &[SkinPixel],
        mut light: impl FnMut(usize) -> Option<[f32; 3]>,
        watch: &mut impl Watch,
    ) {
        for (n, piece) in skin.iter().enumerate() {
            let i = usize::from(piece.pixel);
            if self.full[0][i / TILE] >> (i % TILE) & 1 == 1 {
                continue;
            }
            let cells = (0..CELLS).filter(|s| piece.mask >> s & 1 == 1);
            let share = cells.map(|s| self.open[i][s]).sum::<f32>() / CELLS as f32;
            if share > 0.0
                && let Some(light) = light(n)
            {
                watch.skin(i, share, n);
                self.nearest[i] = self.nearest[i].min(piece.depth);
                let sum = &mut self.light[i];
                *sum =
                    [sum[0] + share * light[0], sum[1] + share * light[1], sum[2] + share * light[2], sum[3] + share];
            }
        }
    }

    #[inline(always)]
    fn draw_hair<'p, S: Simd>(
        &mut self,
        simd: S,
        tile: [usize; 2],
        pieces: impl Iterator<Item = (&'p Piece, Range<usize>)>,
        watch: &mut impl Watch,
    ) {
        for (piece, among) in pieces {
            let nearest = piece.a.depth.min(piece.b.depth);
            let recession = 0.5 * piece.a.recession.abs().max(piece.b.recession.abs());
            if self.filled == PIXELS || nearest > self.farthest + SLACK + self.sway {
                break;
            }
            if nearest - recession <= self.farthest {
                self.piece(simd, tile, piece, &among, watch);
            }
        }
    }

    #[inline(always)]
    fn piece<S: Simd>(
        &mut self,
        simd: S,
        tile: [usize; 2],
        piece: &Piece,
        among: &Range<usize>,
        watch: &mut impl Watch,
    ) {
        let Piece { a, b, cut, unit, per_length, number, slope, .. } = piece;
        let (zero, one) = (simd.splat_f32s(0.0), simd.splat_f32s(1.0));
        let (major, minor) = piece.axes();
        let corner = tile.map(|t| (t * TILE) as f32);
        let [near, far] = piece.reach(corner, among.start as f32, among.end as f32 - 1.0);
        let within = between(near, far);
        if among.clone().all(|m| within & !u32::from(self.full[minor][m]) == 0) {
            return;
        }
        let lines = Lines::new(corner, piece);
        let Lines { start, end, .. } = lines;

        // Between two pieces each cell belongs to one of them, or their shares would count as unrelated and leave gaps; at a strand's
        // ends cells are shared in proportion.
        let sharpness = |n: &End| if n.last { SIDE as f32 } else { 4096.0 };
        let (sharp_a, sharp_b) = (sharpness(a), sharpness(b));
        // Of each pixel how far off the piece it is, how far its corner lies beyond the two ends, and its place along the piece: what is
        // there at the beginning of its line, and the growth from one pixel of a line to the next.
        let per_minor = [1.0, cut[0][minor] * sharp_a, -cut[1][minor] * sharp_b, unit[minor] * per_length];
        let per_major = [0.0, cut[0][major] * sharp_a, -cut[1][major] * sharp_b, unit[major] * per_length];
        let mut at_line = [[0.0_f32; 4]; TILE];

        // All pixels first, then their work: a loop of unknown length within another would be mispredicted at each line.
        let mut pixels = [0_u8; 2 * PIXELS];
        let mut count = 0;
        #[expect(clippy::needless_range_loop, reason = "a line is a number in several arrays and a place")]
        for m in lines.first.max(among.start)..(lines.last + 1).min(among.end) {
            let (from_start, from_end) = (m as f32 - start[major], m as f32 - end[major]);
            at_line[m] = [
                -lines.middle[m],
                from_start * per_major[1] - start[minor] * per_minor[1] + 0.5,
                from_end * per_major[2] - end[minor] * per_minor[2] + 0.5,
                (from_start + 0.5) * per_major[3] + (0.5 - start[minor]) * per_minor[3],
            ];
            let mut bits = lines.pixels[m] & !u32::from(self.full[minor][m]);
            for _ in 0..2 {
                pixels[count % (2 * PIXELS)] = (m * TILE) as u8 | bits.trailing_zeros() as u8 & 15;
                count += usize::from(bits != 0);
                bits &= bits.wrapping_sub(1);
            }
            while bits != 0 {
                pixels[count % (2 * PIXELS)] = (m * TILE) as u8 | bits.trailing_zeros() as u8;
                count += 1;
                bits &= bits - 1;
            }
        }
        if count == 0 {
            return;
        }

        // Offsets of the cells: across the piece, and along the normals of its two ends.
        let mut across = [0.0_f32; CELLS];
        let mut from_a = [0.0_f32; CELLS];
        let mut from_b = [0.0_f32; CELLS];
        for s in 0..CELLS {
            let o = cell_offset(s);
            across[s] = o[minor] - o[major] * *slope;
            from_a[s] = (o[0] * cut[0][0] + o[1] * cut[0][1]) * sharp_a;
            from_b[s] = (o[0] * cut[1][0] + o[1] * cut[1][1]) * sharp_b;
        }
        let light = |n: &End| [n.light[0], n.light[1], n.light[2], 1.0];
        let (light_a, light_b) = (light(a), light(b));

        for &place in &pixels[..count] {
            let (m, q) = (usize::from(place) / TILE, usize::from(place) % TILE);
            let (x, y) = if major == 0 { (m, q) } else { (q, m) };
            // Of eight bits, so that the compiler sees that it lies in the tile.
            let pixel = usize::from((y * TILE + x) as u8);
            let mut depth = lines.depth[m];
            if piece.recession != 0.0 {
                let aside = q as f32 + 0.5 - (lines.middle[m] + 0.5 * slope);
                depth += aside.max(-piece.sway).min(piece.sway) * piece.recession;
            }
            if depth > self.skin_far[pixel] {
                continue;
            }
            let mut at = at_line[m];
            for (at, per_minor) in at.iter_mut().zip(per_minor) {
                *at += q as f32 * per_minor;
            }
            let [off, after_a, after_b] = [at[0], at[1], at[2]].map(|at| simd.splat_f32s(at));
            let (top, rise, fall) = (lines.top[m], lines.rise[m], lines.fall[m]);
            let (top, rise, fall) = (simd.splat_f32s(top), simd.splat_f32s(rise), simd.splat_f32s(fall));
            let at_skin = depth > self.skin_near[pixel];
            let open = S::as_mut_simd_f32s(&mut self.open[pixel]).0;
            let mut taken = [0.0; CELLS];
            for (i, taken) in S::as_mut_simd_f32s(&mut taken).0.iter_mut().enumerate() {
                let distance = simd.mul_f32s(simd.abs_f32s(simd.add_f32s(off, S::as_simd_f32s(&across).0[i])), fall);
                let mut share = simd.min_f32s(simd.max_f32s(simd.sub_f32s(rise, distance), zero), top);
                let after = simd.add_f32s(after_a, S::as_simd_f32s(&from_a).0[i]);
                share = simd.mul_f32s(share, simd.min_f32s(simd.max_f32s(after, zero), one));
                let before = simd.sub_f32s(after_b, S::as_simd_f32s(&from_b).0[i]);
                share = simd.mul_f32s(share, simd.min_f32s(simd.max_f32s(before, zero), one));
                if at_skin {
                    let before = simd.less_than_f32s(simd.splat_f32s(depth), S::as_simd_f32s(&self.skin[pixel]).0[i]);
                    share = simd.select_f32s(before, share, zero);
                }
                *taken = simd.mul_f32s(share, open[i]);
                open[i] = simd.sub_f32s(open[i], *taken);
            }
            // Always in this order, however wide the vectors.
            let quarter = |c: usize| (taken[c] + taken[c + 4]) + (taken[c + 8] + taken[c + 12]);
            let sum = ((quarter(0) + quarter(1)) + (quarter(2) + quarter(3))) * (1.0 / CELLS as f32);
            let t = at[3].clamp(0.0, 1.0);
            let light = &mut self.light[pixel];
            *light = std::array::from_fn(|c| light[c] + sum * (light_a[c] + (light_b[c] - light_a[c]) * t));
            // Where it covers nothing it only goes on to do nothing: cheaper than to ask.
            let seen = if sum > 0.0 { depth } else { f32::INFINITY };
            self.nearest[pixel] = if seen < self.nearest[pixel] { seen } else { self.nearest[pixel] };
            watch.hair(pixel, sum, t, *number);
            self.left[pixel] -= sum;
            if self.left[pixel] < NOTHING {
                watch.full(pixel, self.fill(x, y));
            }
        }
    }

    /// Lets what a pixel holds stand for all of it, which is so many times that.
    #[inline(always)]
    fn fill(&mut self, x: usize, y: usize) -> f32 {
        self.full[0][y] |= 1 << x;
        self.full[1][x] |= 1 << y;
        self.filled += 1;
        let light = &mut self.light[y * TILE + x];
        let whole = 1.0 / light[3];
        *light = light.map(|l| l * whole);
        whole
    }
}

/// A piece line by line of the tile, sixteen lines side by side.
struct Lines {
    /// Ends, from the tile's corner (pixels).
    start: [f32; 2],
    end: [f32; 2],
    /// First and last line that it may touch, and in each the pixels within reach, a bit each.
    first: usize,
    last: usize,
    pixels: [u32; TILE],
    /// The piece's middle on the near edge of the line (pixels), and its depth (cm).
    middle: [f32; TILE],
    depth: [f32; TILE],
    /// A cell's share is `rise` less `fall` times its distance from the middle, and at most `top`.
    top: [f32; TILE],
    rise: [f32; TILE],
    fall: [f32; TILE],
}

impl Lines {
    #[inline(always)]
    fn new(corner: [f32; 2], piece: &Piece) -> Self {
        let &Piece { a, b, per_length, per_unit, slope, spreads, .. } = piece;
        let (major, minor) = piece.axes();
        let start = [a.at[0] - corner[0], a.at[1] - corner[1]];
        let end = [b.at[0] - corner[0], b.at[1] - corner[1]];
        let [low, high] = piece.lines(corner);
        let reach = piece.beside + 0.5 * slope.abs();
        let (widen, per_major) = (per_unit.abs(), per_length * per_unit);
        let blank = [0.0; TILE];
        let (mut middle, mut depth, mut pixels) = (blank, blank, [0; TILE]);
        let (mut top, mut rise, mut fall) = (blank, blank, blank);
        for m in 0..TILE {
            let line = m as f32;
            let step = line - start[major];
            middle[m] = start[minor] + step * slope;
            let t = ((step + 0.5) * per_major).clamp(0.0, 1.0);
            depth[m] = a.depth + (b.depth - a.depth) * t;
            let half = (a.radius + (b.radius - a.radius) * t) * widen;
            let spread = half.max(spreads[0] + (spreads[1] - spreads[0]) * t);
            let opacity = if spread > half { half / spread } else { 1.0 };
            top[m] = opacity * (2.0 * spread * SIDE as f32).min(1.0);
            rise[m] = opacity * (spread * SIDE as f32 + 0.5);
            fall[m] = opacity * SIDE as f32;

            let centre = middle[m] + 0.5 * slope;
            let (left, right) = (centre - reach, centre + reach);
            let within = line + 1.0 > low && line <= high && left < TILE as f32 && right > 0.0;
            pixels[m] = if within { between(left, right) } else { 0 };
        }
        let (first, last) = (whole(low) as usize, whole(high) as usize);
        Self { start, end, first, last, pixels, middle, depth, top, rise, fall }
    }
}

/// Pixels of a line of the tile from one coordinate to another, a bit each.
#[inline(always)]
fn between(from: f32, to: f32) -> u32 {
    u32::from(u16::MAX) << whole(from) & u32::from(u16::MAX) >> (15 - whole(to))
}

/// The pixel, 0 to 15, that a coordinate lies in; the one before it for a coordinate on the border. Without a conversion,
/// which would keep its loop from being vectorised.
#[inline(always)]
fn whole(x: f32) -> u32 {
    // Adding 1.5 * 2^23 leaves the nearest whole number in the low bits.
    const SHIFT: f32 = 12_582_912.0;
    ((x - 0.5).max(0.0).min(TILE as f32 - 1.0) + SHIFT).to_bits() & 15
}
