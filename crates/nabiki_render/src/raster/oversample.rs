//! The paper's way to draw (section 4.4): opaque lines and the head's triangles against a depth buffer with several
//! points in each pixel, averaged.

use super::{BURIED, Piece, SIDE, TILE};
use crate::skin::SkinPixel;

/// The depth buffer of one tile.
pub struct OversampledTile {
    samples: usize,
    /// Depth and light of what is nearest at each point, row after row.
    depth: Vec<f32>,
    light: Vec<[f32; 4]>,
}

impl OversampledTile {
    /// With `samples` x `samples` points in each pixel.
    pub fn new(samples: usize) -> Self {
        let points = (TILE * samples).pow(2);
        Self { samples, depth: vec![f32::INFINITY; points], light: vec![[0.0; 4]; points] }
    }

    /// Draws what lies in a tile; skin without light hides hair all the same.
    pub fn draw<'a>(
        &mut self,
        tile: [usize; 2],
        pieces: impl Iterator<Item = &'a Piece>,
        skin: (&[SkinPixel], &[Option<[f32; 3]>]),
    ) {
        self.depth.fill(f32::INFINITY);
        self.light.fill([0.0; 4]);
        for (piece, light) in skin.0.iter().zip(skin.1) {
            self.skin(piece, light.map_or([0.0; 4], |[r, g, b]| [r, g, b, 1.0]));
        }
        for piece in pieces {
            self.piece(tile, piece);
        }
    }

    /// Light (premultiplied), alpha and nearest depth of a pixel of the tile.
    pub fn pixel(&self, i: usize) -> ([f32; 4], f32) {
        let (x, y, n) = (i % TILE, i / TILE, self.samples);
        let mut sum = [0.0; 4];
        let mut nearest = f32::INFINITY;
        for row in y * n..(y + 1) * n {
            for i in row * TILE * n + x * n..row * TILE * n + (x + 1) * n {
                nearest = nearest.min(self.depth[i]);
                sum = std::array::from_fn(|c| sum[c] + self.light[i][c]);
            }
        }
        (sum.map(|s| s / (n * n) as f32), nearest)
    }

    fn put(&mut self, x: usize, y: usize, depth: f32, light: impl FnOnce() -> [f32; 4]) {
        let i = y * TILE * self.samples + x;
        if depth < self.depth[i] {
            self.depth[i] = depth;
            self.light[i] = light();
        }
    }

    /// A point's coordinate in pixels of the picture is (its number + 1/2) / samples, from the tile's corner.
    fn place(&self, tile: usize, number: usize) -> f32 {
        (tile * TILE) as f32 + (number as f32 + 0.5) / self.samples as f32
    }

    /// Numbers of the points whose coordinate lies in `low..high` (pixels of the picture).
    fn numbers(&self, tile: usize, low: f32, high: f32) -> std::ops::Range<usize> {
        let n = self.samples as f32;
        let number = |x: f32| ((x - (tile * TILE) as f32) * n - 0.5).ceil().clamp(0.0, TILE as f32 * n) as usize;
        number(low)..number(high)
    }

    fn piece(&mut self, tile: [usize; 2], piece: &Piece) {
        let Piece { a, b, unit, per_length, cut, .. } = piece;
        // Walk along the axis that the piece follows more; across it the hair is a span.
        let (major, minor) = piece.axes();
        let (slope, widen) = (piece.slope, piece.per_unit.abs());
        let widest = a.radius.max(b.radius) * (1.0 + widen);
        let low = a.at[major].min(b.at[major]) - widest;
        let high = a.at[major].max(b.at[major]) + widest;
        for step in self.numbers(tile[major], low, high) {
            let m = self.place(tile[major], step);
            let centre = a.at[minor] + (m - a.at[major]) * slope;
            let t = ((m - a.at[major]) / (b.at[major] - a.at[major])).clamp(0.0, 1.0);
            let half = (a.radius + (b.radius - a.radius) * t) * widen;
            for number in self.numbers(tile[minor], centre - half, centre + half) {
                let s = self.place(tile[minor], number);
                let mut p = [0.0; 2];
                (p[major], p[minor]) = (m, s);
                let from_a = [p[0] - a.at[0], p[1] - a.at[1]];
                let from_b = [p[0] - b.at[0], p[1] - b.at[1]];
                let begun = from_a[0] * cut[0][0] + from_a[1] * cut[0][1] >= 0.0;
                let ended = from_b[0] * cut[1][0] + from_b[1] * cut[1][1] >= 0.0;
                if begun && !ended {
                    let t = ((from_a[0] * unit[0] + from_a[1] * unit[1]) * per_length).clamp(0.0, 1.0);
                    let mix = |x: f32, y: f32| x + (y - x) * t;
                    let (x, y) = if major == 0 { (step, number) } else { (number, step) };
                    self.put(x, y, mix(a.depth, b.depth), || {
                        let [r, g, b] = std::array::from_fn(|c| mix(a.light[c], b.light[c]));
                        [r, g, b, 1.0]
                    });
                }
            }
        }
    }

    /// The head's surface in one pixel. Its outline is known to a cell: finer points take that of the cell they lie in.
    fn skin(&mut self, piece: &SkinPixel, light: [f32; 4]) {
        let (x, y, n) = (usize::from(piece.pixel) % TILE, usize::from(piece.pixel) / TILE, self.samples);
        for dy in 0..n {
            for dx in 0..n {
                let p = [dx, dy].map(|d| (d as f32 + 0.5) / n as f32);
                let cell = (p[1] * SIDE as f32) as usize * SIDE + (p[0] * SIDE as f32) as usize;
                if piece.mask >> cell & 1 == 1 {
                    let depth = piece.depth + piece.slope[0] * (p[0] - 0.5) + piece.slope[1] * (p[1] - 0.5) + BURIED;
                    self.put(x * n + dx, y * n + dy, depth, || light);
                }
            }
        }
    }
}
