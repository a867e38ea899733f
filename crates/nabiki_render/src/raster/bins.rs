//! Which pieces touch which tile, nearest first.
//!
//! Pieces are sorted one row of tiles at a time, right before it is drawn: what the row needs then lies close together and
//! stays in a core's own cache. Long hair that crosses other hair is before it at one end and behind it at the other: each piece is
//! divided along itself into parts, which go by their own depth. Parts begin at lines of the picture that differ from piece to piece, and
//! one that crosses the edge of a tile has the same depth on both sides, so no edge shows.

use std::ops::Range;

use rayon::prelude::*;

use super::{Node, Piece, TILE};
use crate::focus::Spread;
use crate::prefetch::prefetch;

/// Nodes whose pieces one task brings to their rows.
const CHUNK: usize = 32_768;
/// Pieces between one whose nodes are asked for and the one that is prepared.
const AHEAD: usize = 12;
/// The rectangle of a piece that cannot be seen.
const NOWHERE: [u16; 4] = [u16::MAX, u16::MAX, 0, 0];

/// The tiles that each piece may touch.
#[derive(Default)]
pub struct Bins {
    /// Tiles across and down.
    pub tiles: [usize; 2],
    spread: Spread,
    /// First and last tiles (left, top, right, bottom) of the piece that starts at each node.
    rectangles: Vec<[u16; 4]>,
    /// The pieces of each row of tiles, row after row, and where each row ends.
    listed: Vec<Listed>,
    ends: Vec<usize>,
}

/// A piece in a row of tiles: the index of its first node, and its first and last column there.
#[derive(Clone, Copy, Default)]
struct Listed {
    first: u32,
    columns: [u16; 2],
}

/// The pieces of one row of tiles, or of some columns of it; kept from row to row for its memory.
#[derive(Default)]
pub struct Row {
    pieces: Vec<(Piece, Parts)>,
    entries: Vec<(u16, u64)>,
    starts: Vec<u32>,
    /// For each tile, what touches it: depth (high half), place among `pieces`, and which part of the piece it is.
    order: Vec<u64>,
}

/// Parts are so many lines long where hair is thicker than this (pixels): the eye sees which is before which.
const THICK: [(f32, u8); 2] = [(0.2, 4), (0.8, 2)];
/// The same where it goes farther than this into depth over the length of a tile (cm).
const STEEP: [(f32, u8); 2] = [(0.4, 8), (0.8, 4)];
/// Bits for the number of a part within a tile: nine at most, since parts do not begin where the tile does.
const PART_BITS: u32 = 4;

impl Bins {
    /// Finds the tiles of all pieces between neighbouring nodes of the same strand.
    ///
    /// `margin`: how much farther than half its thickness a piece may leave traces (pixels), and `spread` by how much a lens widens it.
    pub fn fill(&mut self, nodes: &[Node], size: [u32; 2], margin: f32, spread: Spread) {
        let tiles = size.map(|s| (s as usize).div_ceil(TILE));
        let bounds = size.map(|s| s as f32);
        self.tiles = tiles;
        self.spread = spread;
        let count = nodes.len().saturating_sub(1);
        self.rectangles.resize(count, NOWHERE);
        let in_rows: Vec<Vec<usize>> = self
            .rectangles
            .par_chunks_mut(CHUNK)
            .enumerate()
            .map(|(chunk, rectangles)| {
                let mut in_rows = vec![0; tiles[1]];
                for (rectangle, pair) in rectangles.iter_mut().zip(nodes[chunk * CHUNK..].windows(2)) {
                    *rectangle = rectangle_of(&pair[0], &pair[1], bounds, tiles, (margin, &spread));
                    rows_of(rectangle).for_each(|row| in_rows[row] += 1);
                }
                in_rows
            })
            .collect();
        self.list(&in_rows);
    }

    /// Lists the pieces of each row in the order of their nodes; `in_rows` holds their number from each chunk in each row.
    fn list(&mut self, in_rows: &[Vec<usize>]) {
        self.ends.clear();
        let mut sum = 0;
        self.ends.extend((0..self.tiles[1]).map(|row| {
            sum += in_rows.iter().map(|in_rows| in_rows[row]).sum::<usize>();
            sum
        }));
        self.listed.resize(sum, Listed::default());
        // To each chunk its own part of every row.
        let mut rest = &mut self.listed[..];
        let mut parts: Vec<Vec<&mut [Listed]>> =
            in_rows.iter().map(|in_rows| Vec::with_capacity(in_rows.len())).collect();
        for row in 0..self.tiles[1] {
            for (parts, in_rows) in parts.iter_mut().zip(in_rows) {
                let (part, after) = std::mem::take(&mut rest).split_at_mut(in_rows[row]);
                parts.push(part);
                rest = after;
            }
        }
        parts.into_par_iter().zip(self.rectangles.par_chunks(CHUNK)).enumerate().for_each(
            |(chunk, (mut parts, rectangles))| {
                let mut filled = vec![0; parts.len()];
                for (i, rectangle) in rectangles.iter().enumerate() {
                    let [left, _, right, _] = *rectangle;
                    let listed = Listed { first: (chunk * CHUNK + i) as u32, columns: [left, right] };
                    for row in rows_of(rectangle) {
                        parts[row][filled[row]] = listed;
                        filled[row] += 1;
                    }
                }
            },
        );
    }

    /// Collects the pieces of some columns of a row of tiles. `in_parts`: whether thick hair is to be sorted part by part.
    pub fn row(&self, row: usize, columns: &Range<usize>, nodes: &[Node], in_parts: bool, out: &mut Row) {
        out.pieces.clear();
        out.entries.clear();
        out.starts.clear();
        out.starts.resize(self.tiles[0] + 1, 0);
        pulp::Arch::new().dispatch(Collect { bins: self, row, columns, nodes, in_parts, out: &mut *out });
        out.sort();
    }
}

/// What collects pieces of a row, compiled for each width of vectors that machines have; one is chosen at run time.
struct Collect<'a> {
    bins: &'a Bins,
    row: usize,
    columns: &'a Range<usize>,
    nodes: &'a [Node],
    in_parts: bool,
    out: &'a mut Row,
}

impl pulp::NullaryFnOnce for Collect<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { bins, row, columns, nodes, in_parts, out } = self;
        let (leftmost, rightmost) = (columns.start as u16, columns.end as u16 - 1);
        let listed = &bins.listed[row.checked_sub(1).map_or(0, |above| bins.ends[above])..bins.ends[row]];
        for (n, &Listed { first, columns: [left, right] }) in listed.iter().enumerate() {
            // Nodes come from all over memory: asking for those of later pieces now hides most of the wait.
            let later = listed[(n + AHEAD).min(listed.len() - 1)].first as usize;
            prefetch(&nodes[later]);
            prefetch(&nodes[later + 1]);
            let (left, right) = (left.max(leftmost), right.min(rightmost));
            if left > right {
                continue;
            }
            let Some(piece) = Piece::new(&nodes[first as usize], &nodes[first as usize + 1], first, &bins.spread)
            else {
                continue;
            };
            let place = out.pieces.len() as u64;
            let parts = if in_parts { parts(&piece) } else { Parts::WHOLE };
            for x in left..=right {
                let corner = [f32::from(x), row as f32].map(|c| c * TILE as f32);
                let depths = parts.depths(&piece, corner);
                let mut listed = if in_parts { parts.touching(&piece, corner) } else { 1 };
                out.starts[usize::from(x)] += listed.count_ones();
                while listed != 0 {
                    let part = listed.trailing_zeros();
                    let depth = depths[part as usize & (TILE - 1)].to_bits();
                    out.entries.push((x, u64::from(depth) << 32 | place << PART_BITS | u64::from(part)));
                    listed &= listed - 1;
                }
            }
            out.pieces.push((piece, parts));
        }
    }
}

impl Row {
    /// The pieces of a tile of the row, nearest first, and which lines of the tile are meant; ties in the order of the nodes.
    pub fn tile(&self, column: usize) -> impl Iterator<Item = (&Piece, Range<usize>)> {
        let order = &self.order[self.starts[column] as usize..self.starts[column + 1] as usize];
        let piece = |entry: u64| &self.pieces[entry as u32 as usize >> PART_BITS];
        order.iter().enumerate().map(move |(n, &entry)| {
            prefetch(piece(order[(n + AHEAD).min(order.len() - 1)]));
            let (piece, parts) = piece(entry);
            (piece, parts.lines(entry as usize & ((1 << PART_BITS) - 1)))
        })
    }

    /// Whether nothing touches a tile of the row.
    pub fn is_empty(&self, column: usize) -> bool {
        self.starts[column] == self.starts[column + 1]
    }

    /// Turns the counts in `starts` into places, brings the entries there and sorts those of each tile.
    fn sort(&mut self) {
        let mut sum = 0;
        for start in &mut self.starts {
            sum += std::mem::replace(start, sum);
        }
        self.order.clear();
        self.order.resize(self.entries.len(), 0);
        for &(tile, entry) in &self.entries {
            let place = &mut self.starts[usize::from(tile)];
            self.order[*place as usize] = entry;
            *place += 1;
        }
        // Each start has moved on to the end of its tile.
        self.starts.rotate_right(1);
        self.starts[0] = 0;
        for tile in self.starts.windows(2) {
            // Positive floats are in the order of their bits.
            self.order[tile[0] as usize..tile[1] as usize].sort_unstable();
        }
    }
}

/// How a piece is divided along the axis that it follows more: into parts of `length` lines of the picture, of which one begins
/// `offset` lines into every tile.
#[derive(Clone, Copy, Debug)]
struct Parts {
    length: u8,
    offset: u8,
}

impl Parts {
    /// A tile each.
    const WHOLE: Self = Self { length: TILE as u8, offset: 0 };

    /// How many of them lie in a tile, or reach into it.
    #[inline(always)]
    fn in_tile(self) -> usize {
        TILE / usize::from(self.length) + usize::from(self.offset > 0)
    }

    /// Where part `i` begins (lines from the tile's edge): the first before it, if it reaches in.
    #[inline(always)]
    fn start(self, i: usize) -> i32 {
        let before = if self.offset > 0 { i32::from(self.length) } else { 0 };
        i as i32 * i32::from(self.length) + i32::from(self.offset) - before
    }

    /// The lines of the tile that part `i` has.
    #[inline]
    fn lines(self, i: usize) -> Range<usize> {
        let start = self.start(i);
        start.max(0) as usize..((start + i32::from(self.length)) as usize).min(TILE)
    }

    /// Which parts may cover a cell of the tile with a `corner` (pixels), a bit each. Points of oversampling lie nearer to its edges.
    #[inline(always)]
    fn touching(self, piece: &Piece, corner: [f32; 2]) -> u32 {
        let [low, high] = piece.lines(corner);
        let (length, count) = (f32::from(self.length), self.in_tile());
        let mut touching = 0;
        for i in 0..TILE {
            let start = self.start(i) as f32;
            let [first, end] = [start.max(0.0), (start + length).min(TILE as f32)];
            let [near, far] = piece.reach(corner, first.max(low - 1.0), (end - 1.0).min(high));
            // A little for rounding.
            let touches = (first <= high) & (end > low) & (near < TILE as f32 + 1e-3) & (far > -1e-3);
            touching |= u32::from(touches & (i < count)) << i;
        }
        touching
    }

    /// How deep each part lies in its middle, in the tile with a `corner` or beside it (cm).
    #[inline(always)]
    fn depths(self, piece: &Piece, corner: [f32; 2]) -> [f32; TILE] {
        let growth = piece.b.depth - piece.a.depth;
        let mut depths = [0.0; TILE];
        for (i, depth) in depths.iter_mut().enumerate() {
            *depth = piece.a.depth + growth * piece.along(corner, self.middle(i));
        }
        depths
    }

    /// The middle of part `i`, within the tile or not (lines from its edge).
    #[inline(always)]
    fn middle(self, i: usize) -> f32 {
        self.start(i) as f32 + 0.5 * f32::from(self.length)
    }
}

/// Into what a piece is divided.
#[inline(always)]
fn parts(piece: &Piece) -> Parts {
    let thickness = 2.0 * piece.a.radius.max(piece.b.radius);
    let steepness = (piece.b.depth - piece.a.depth).abs() * piece.per_length * TILE as f32;
    let of = |value: f32, limits: [(f32, u8); 2]| {
        limits.iter().rev().find(|(limit, _)| value > *limit).map_or(TILE as u8, |&(_, length)| length)
    };
    let length = of(thickness, THICK).min(of(steepness, STEEP));
    // Lines at which all hair were taken up anew would show where locks pass through each other. Bits of the golden ratio spread them.
    let spread = (piece.number.wrapping_mul(0x9E37_79B1) >> 24) as u8;
    Parts { length, offset: spread % length }
}

/// The rows of tiles that a rectangle reaches; none of [`NOWHERE`].
#[inline]
fn rows_of(rectangle: &[u16; 4]) -> Range<usize> {
    usize::from(rectangle[1])..usize::from(rectangle[3]) + 1
}

/// The tiles within reach of the piece between two nodes.
#[inline]
fn rectangle_of(a: &Node, b: &Node, bounds: [f32; 2], tiles: [usize; 2], (margin, spread): (f32, &Spread)) -> [u16; 4] {
    let moved = |n: &Node| n.motion[0].abs().max(n.motion[1].abs());
    let thick = |n: &Node| n.radius.max(spread.at(n.depth));
    let reach = 1.42 * thick(a).max(thick(b)) + margin + moved(a).max(moved(b));
    let low = [0, 1].map(|i| a.at[i].min(b.at[i]) - reach);
    let high = [0, 1].map(|i| a.at[i].max(b.at[i]) + reach);
    let shows = a.strand == b.strand
        && !(a.hidden && b.hidden)
        && a.drawable
        && b.drawable
        && (0..2).all(|i| high[i] > 0.0 && low[i] < bounds[i]);
    if !shows {
        return NOWHERE;
    }
    let tile = |x: f32, i: usize| (x.max(0.0) * (1.0 / TILE as f32)).min(tiles[i] as f32 - 1.0) as u16;
    [tile(low[0], 0), tile(low[1], 1), tile(high[0], 0), tile(high[1], 1)]
}

#[cfg(test)]
mod tests {
    use super::super::SIDE;
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn parts_of_a_tile_make_a_whole_and_go_on_beyond_its_edge() {
        for length in [2, 4, 8, TILE as u8] {
            for offset in 0..length {
                let parts = Parts { length, offset };
                let lines: Vec<usize> = (0..parts.in_tile()).flat_map(|part| parts.lines(part)).collect();
                assert_eq!(lines, (0..TILE).collect::<Vec<_>>());
                let last = parts.in_tile() - 1;
                if offset > 0 {
                    assert_eq!(parts.middle(last), parts.middle(0) + TILE as f32);
                }
            }
        }
    }

    proptest! {
        // Few places lie so near to a tile's edge that only oversampling has points there.
        #![proptest_config(ProptestConfig::with_cases(4000))]

        #[test]
        fn every_cell_that_a_piece_passes_is_listed_in_its_tile(
            from in [-20.0_f32..120.0, -20.0_f32..120.0],
            to in [-20.0_f32..120.0, -20.0_f32..120.0],
            width in 0.01_f32..3.0,
            depths in [10.0_f32..20.0, 10.0_f32..20.0],
        ) {
            let node = |at, depth| Node { at, depth, radius: 0.5 * width, drawable: true, ..Node::default() };
            let nodes = [node(from, depths[0]), node(to, depths[1])];
            let mut bins = Bins::default();
            bins.fill(&nodes, [100, 100], 1.25, Spread::default());
            let mut row = Row::default();
            for i in 0..=100 {
                let t = i as f32 / 100.0;
                let at = [0, 1].map(|c| from[c] + (to[c] - from[c]) * t);
                if !at.iter().all(|c| (0.0..100.0).contains(c)) || from[0].hypot(from[1]) == to[0].hypot(to[1]) {
                    continue;
                }
                let tile = at.map(|c| c as usize / TILE);
                // Oversampling has points anywhere.
                bins.row(tile[1], &(0..bins.tiles[0]), &nodes, false, &mut row);
                prop_assert_eq!(row.tile(tile[0]).count(), 1, "{:?} in {:?}", at, tile);
                let major = usize::from((to[1] - from[1]).abs() > (to[0] - from[0]).abs());
                // Of a row of cells, what lies between its edge and its middle line is drawn if the middle is reached.
                let middle = ((at[major] * SIDE as f32).floor() + 0.5) / SIDE as f32;
                if middle < from[major].min(to[major]) || middle > from[major].max(to[major]) {
                    continue;
                }
                bins.row(tile[1], &(tile[0]..tile[0] + 1), &nodes, true, &mut row);
                let line = at[major] as usize % TILE;
                let listed = row.tile(tile[0]).filter(|(_, lines)| lines.contains(&line)).count();
                prop_assert_eq!(listed, 1, "{:?} in {:?}", at, tile);
            }
        }
    }
}
