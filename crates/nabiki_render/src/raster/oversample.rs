//! The paper's way to draw (section 4.4): opaque lines and the head's triangles against a depth buffer with several
//! points in each pixel, averaged.

use super::bins::Bins;
use super::{Node, Piece, TILE};

/// A corner of a triangle of the head, on the picture.
#[derive(Clone, Copy, Debug, Default)]
pub struct Corner {
    /// Place (pixels) and depth (cm).
    pub at: [f32; 2],
    pub depth: f32,
    pub light: [f32; 3],
}

/// The depth buffer of one tile.
pub struct OversampledTile {
    samples: usize,
    /// Depth and light of what is nearest at each point, row after row.
    depth: Vec<f32>,
    light: Vec<[f32; 3]>,
}

impl OversampledTile {
    /// With `samples` x `samples` points in each pixel.
    pub fn new(samples: usize) -> Self {
        let points = (TILE * samples).pow(2);
        Self { samples, depth: vec![f32::INFINITY; points], light: vec![[0.0; 3]; points] }
    }

    /// Draws what lies in a tile. Returns light (premultiplied), alpha and nearest depth of its pixels through `out`.
    pub fn draw(
        &mut self,
        tile: [usize; 2],
        triangles: impl Iterator<Item = [Corner; 3]>,
        pieces: (&[Node], &Bins),
        mut out: impl FnMut(usize, usize, [f32; 4], f32),
    ) {
        self.depth.fill(f32::INFINITY);
        for corners in triangles {
            self.triangle(tile, corners);
        }
        let (nodes, bins) = pieces;
        for &i in bins.tile(tile[1] * bins.tiles[0] + tile[0]) {
            if let Some(piece) = Piece::new(&nodes[i as usize], &nodes[i as usize + 1]) {
                self.piece(tile, &piece);
            }
        }
        let n = self.samples;
        let share = 1.0 / (n * n) as f32;
        for y in 0..TILE {
            for x in 0..TILE {
                let mut sum = [0.0; 4];
                let mut nearest = f32::INFINITY;
                for row in y * n..(y + 1) * n {
                    for i in row * TILE * n + x * n..row * TILE * n + (x + 1) * n {
                        if self.depth[i] < f32::INFINITY {
                            nearest = nearest.min(self.depth[i]);
                            let [r, g, b] = self.light[i];
                            sum = [sum[0] + r, sum[1] + g, sum[2] + b, sum[3] + 1.0];
                        }
                    }
                }
                out(x, y, sum.map(|s| s * share), nearest);
            }
        }
    }

    fn put(&mut self, x: usize, y: usize, depth: f32, light: impl FnOnce() -> [f32; 3]) {
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
        let Piece { a, b, unit, length, cut } = piece;
        // Walk along the axis that the piece follows more; across it the hair is a span.
        let major = usize::from(unit[1].abs() > unit[0].abs());
        let minor = 1 - major;
        let slope = unit[minor] / unit[major];
        let widen = 1.0 / unit[major].abs();
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
                    let t = ((from_a[0] * unit[0] + from_a[1] * unit[1]) / length).clamp(0.0, 1.0);
                    let mix = |x: f32, y: f32| x + (y - x) * t;
                    let (x, y) = if major == 0 { (step, number) } else { (number, step) };
                    self.put(x, y, mix(a.depth, b.depth), || std::array::from_fn(|c| mix(a.light[c], b.light[c])));
                }
            }
        }
    }

    fn triangle(&mut self, tile: [usize; 2], [a, b, c]: [Corner; 3]) {
        let area = cross(a.at, b.at, c.at);
        if area == 0.0 || !area.is_finite() {
            return;
        }
        let low = [0, 1].map(|i| a.at[i].min(b.at[i]).min(c.at[i]));
        let high = [0, 1].map(|i| a.at[i].max(b.at[i]).max(c.at[i]));
        let columns = self.numbers(tile[0], low[0], high[0] + 1.0 / self.samples as f32);
        for row in self.numbers(tile[1], low[1], high[1] + 1.0 / self.samples as f32) {
            for column in columns.clone() {
                let p = [self.place(tile[0], column), self.place(tile[1], row)];
                let w = [cross(b.at, c.at, p) / area, cross(c.at, a.at, p) / area, cross(a.at, b.at, p) / area];
                if w.iter().all(|w| *w >= 0.0) {
                    let mix = |x: f32, y: f32, z: f32| w[0] * x + w[1] * y + w[2] * z;
                    let depth = mix(a.depth, b.depth, c.depth);
                    self.put(column, row, depth, || std::array::from_fn(|i| mix(a.light[i], b.light[i], c.light[i])));
                }
            }
        }
    }
}

/// Twice the area of the triangle a, b, c; its sign is its turn.
fn cross(a: [f32; 2], b: [f32; 2], c: [f32; 2]) -> f32 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}
