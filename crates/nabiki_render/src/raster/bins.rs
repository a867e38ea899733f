//! Which pieces touch which tile, nearest first.

use rayon::prelude::*;

use super::{Node, TILE};

/// Bits of the depth by which pieces are sorted, in two passes.
const DIGIT: u32 = 11;
const DIGITS: usize = 1 << DIGIT;
/// Tile rows are shared out in so many bands, each filled by one task.
const BANDS: usize = 8;

/// The pieces of each tile, by the index of their first node.
#[derive(Default)]
pub struct Bins {
    /// Tiles across and down.
    pub tiles: [usize; 2],
    bands: Vec<Band>,
    rectangles: Vec<[u16; 4]>,
    keys: Vec<u32>,
    order: Vec<u32>,
    spare: Vec<u32>,
    spare_keys: Vec<u32>,
}

/// Some consecutive rows of tiles.
#[derive(Default)]
struct Band {
    rows: std::ops::Range<usize>,
    starts: Vec<u32>,
    places: Vec<u32>,
    pieces: Vec<u32>,
}

impl Bins {
    /// Sorts the pieces between neighbouring nodes of the same strand into the tiles of a picture.
    ///
    /// `margin`: how much farther than half its thickness a piece may leave traces (pixels).
    pub fn fill(&mut self, nodes: &[Node], size: [u32; 2], margin: f32) {
        let tiles = size.map(|s| (s as usize).div_ceil(TILE));
        self.tiles = tiles;
        self.sort(nodes, size, margin);
        self.order
            .par_iter()
            .map(|&piece| rectangle(nodes, piece, tiles, margin))
            .collect_into_vec(&mut self.rectangles);

        self.bands.resize_with(BANDS, Band::default);
        let (order, rectangles) = (&self.order, &self.rectangles);
        self.bands.par_iter_mut().enumerate().for_each(|(i, band)| {
            band.rows = i * tiles[1] / BANDS..(i + 1) * tiles[1] / BANDS;
            let rows = band.rows.clone();
            let each = |sink: &mut dyn FnMut(usize, u32)| {
                for (&piece, &[left, top, right, bottom]) in order.iter().zip(rectangles) {
                    let (top, bottom) = (usize::from(top).max(rows.start), (usize::from(bottom) + 1).min(rows.end));
                    let long = right > left + 1 && bottom > top + 2;
                    for y in top..bottom {
                        for x in usize::from(left)..=usize::from(right) {
                            if !long || near(nodes, piece, [x, y], margin) {
                                sink((y - rows.start) * tiles[0] + x, piece);
                            }
                        }
                    }
                }
            };
            band.places.clear();
            band.places.resize(rows.len() * tiles[0], 0);
            each(&mut |tile, _| band.places[tile] += 1);
            band.starts.clear();
            let mut sum = 0;
            for place in &mut band.places {
                band.starts.push(sum);
                sum += std::mem::replace(place, sum);
            }
            band.starts.push(sum);
            band.pieces.resize(sum as usize, 0);
            each(&mut |tile, piece| {
                band.pieces[band.places[tile] as usize] = piece;
                band.places[tile] += 1;
            });
        });
    }

    /// The pieces of a tile, nearest first.
    pub fn tile(&self, tile: usize) -> &[u32] {
        let row = tile / self.tiles[0];
        let band = self.bands.iter().find(|b| b.rows.contains(&row)).expect("bands cover all rows");
        let tile = tile - band.rows.start * self.tiles[0];
        &band.pieces[band.starts[tile] as usize..band.starts[tile + 1] as usize]
    }

    /// Lists what can be seen, sorted by depth with ties in the order of the nodes.
    fn sort(&mut self, nodes: &[Node], size: [u32; 2], margin: f32) {
        let bounds = [size[0] as f32, size[1] as f32];
        let ends = nodes.len().saturating_sub(1);
        let depth = |i: u32| nodes[i as usize].depth + nodes[i as usize + 1].depth;
        self.order.clear();
        self.order.par_extend(
            (0..ends as u32)
                .into_par_iter()
                .with_min_len(8192)
                .filter(|&i| visible(&nodes[i as usize], &nodes[i as usize + 1], bounds, margin)),
        );
        let (near, far) = self
            .order
            .par_iter()
            .with_min_len(8192)
            .fold(|| (f32::INFINITY, 0.0_f32), |(near, far), &i| (near.min(depth(i)), far.max(depth(i))))
            .reduce(|| (f32::INFINITY, 0.0_f32), |a, b| (a.0.min(b.0), a.1.max(b.1)));
        let scale = ((DIGITS * DIGITS - 1) as f32) / (far - near).max(1e-6);
        let key = |&i: &u32| ((depth(i) - near) * scale) as u32;
        self.order.par_iter().with_min_len(8192).map(key).collect_into_vec(&mut self.keys);
        self.spare.resize(self.order.len(), 0);
        self.spare_keys.resize(self.order.len(), 0);
        for shift in [0, DIGIT] {
            let mut places = [0_u32; DIGITS];
            for key in &self.keys {
                places[(key >> shift) as usize & (DIGITS - 1)] += 1;
            }
            let mut sum = 0;
            for place in &mut places {
                sum += std::mem::replace(place, sum);
            }
            for (&key, &piece) in self.keys.iter().zip(&self.order) {
                let place = &mut places[(key >> shift) as usize & (DIGITS - 1)];
                self.spare[*place as usize] = piece;
                self.spare_keys[*place as usize] = key;
                *place += 1;
            }
            std::mem::swap(&mut self.order, &mut self.spare);
            std::mem::swap(&mut self.keys, &mut self.spare_keys);
        }
    }
}

#[inline]
fn visible(a: &Node, b: &Node, bounds: [f32; 2], margin: f32) -> bool {
    let reach = 1.42 * a.radius.max(b.radius) + margin + moved(a).max(moved(b));
    a.strand == b.strand
        && !(a.hidden && b.hidden)
        && a.drawable
        && b.drawable
        && (0..2).all(|i| a.at[i].max(b.at[i]) + reach > 0.0 && a.at[i].min(b.at[i]) - reach < bounds[i])
}

#[inline]
fn moved(n: &Node) -> f32 {
    n.motion[0].abs().max(n.motion[1].abs())
}

/// First and last tiles (left, top, right, bottom) within reach of a piece.
#[inline]
fn rectangle(nodes: &[Node], piece: u32, tiles: [usize; 2], margin: f32) -> [u16; 4] {
    let (a, b) = (&nodes[piece as usize], &nodes[piece as usize + 1]);
    let reach = 1.42 * a.radius.max(b.radius) + margin + moved(a).max(moved(b));
    let tile = |x: f32, i: usize| (x / TILE as f32).floor().clamp(0.0, tiles[i] as f32 - 1.0) as u16;
    [
        tile(a.at[0].min(b.at[0]) - reach, 0),
        tile(a.at[1].min(b.at[1]) - reach, 1),
        tile(a.at[0].max(b.at[0]) + reach, 0),
        tile(a.at[1].max(b.at[1]) + reach, 1),
    ]
}

/// Whether the line of a piece comes within reach of a tile.
fn near(nodes: &[Node], piece: u32, tile: [usize; 2], margin: f32) -> bool {
    let (a, b) = (&nodes[piece as usize], &nodes[piece as usize + 1]);
    let reach = 1.42 * a.radius.max(b.radius) + margin + moved(a).max(moved(b));
    let along = [b.at[0] - a.at[0], b.at[1] - a.at[1]];
    let centre = tile.map(|t| (t as f32 + 0.5) * TILE as f32);
    let off = along[0] * (centre[1] - a.at[1]) - along[1] * (centre[0] - a.at[0]);
    // Half of a tile's diagonal, and a little for rounding.
    off.abs() <= (reach + TILE as f32 * 0.7072) * along[0].hypot(along[1])
}
