//! A frame cut into blocks of tiles, which are drawn side by side.

use std::ops::Range;

use crate::frame::{Frame, Layer};
use crate::raster::TILE;

/// So many blocks for each thread: some take much longer than others, and all threads are to end together.
const BLOCKS: usize = 16;

/// Some tiles of a row beside each other, and the lines of pixels that they cover.
pub(super) struct Block<'a> {
    pub row: usize,
    pub columns: Range<usize>,
    lines: Vec<Line<'a>>,
}

struct Line<'a> {
    rgba: &'a mut [[f32; 4]],
    depth: &'a mut [f32],
    layers: &'a mut [Layer],
}

/// Cuts a frame into blocks: whole rows of tiles, or parts of rows where those would be too few for the threads.
pub(super) fn blocks_of_tiles(frame: &mut Frame) -> Vec<Block<'_>> {
    let wanted = BLOCKS * rayon::current_num_threads();
    let [tiles, rows] = frame.size.map(|s| (s as usize).div_ceil(TILE));
    let across = tiles.div_ceil(wanted.div_ceil(rows).min(tiles));
    cut(frame, across)
}

/// Cuts a frame into blocks of so many tiles.
fn cut(frame: &mut Frame, across: usize) -> Vec<Block<'_>> {
    let width = frame.size[0] as usize;
    let [tiles, rows] = frame.size.map(|s| (s as usize).div_ceil(TILE));
    let (in_row, pixels) = (tiles.div_ceil(across), across * TILE);
    let block = |row: usize, first: usize| Block {
        row,
        columns: first..(first + across).min(tiles),
        lines: Vec::with_capacity(TILE),
    };
    let firsts = || (0..tiles).step_by(across);
    let mut blocks: Vec<Block> = (0..rows).flat_map(|row| firsts().map(move |first| block(row, first))).collect();
    let mut layers = frame.layers.chunks_mut(width);
    let lines = frame.rgba.chunks_mut(width).zip(frame.depth.chunks_mut(width));
    for (y, (rgba, depth)) in lines.enumerate() {
        let mut layers = layers.next().unwrap_or_default().chunks_mut(pixels);
        let parts = rgba.chunks_mut(pixels).zip(depth.chunks_mut(pixels));
        for (block, (rgba, depth)) in blocks[y / TILE * in_row..].iter_mut().zip(parts) {
            block.lines.push(Line { rgba, depth, layers: layers.next().unwrap_or_default() });
        }
    }
    blocks
}

impl Block<'_> {
    /// Writes a tile's pixels, as far as they lie on the picture. `value` is given the pixel in the tile and its row.
    pub fn put(&mut self, column: usize, mut value: impl FnMut(usize, usize) -> ([f32; 4], f32, Option<Layer>)) {
        let first = (column - self.columns.start) * TILE;
        for (y, line) in self.lines.iter_mut().enumerate() {
            for x in 0..TILE.min(line.rgba.len() - first) {
                let (rgba, depth, layer) = value(y * TILE + x, y);
                line.rgba[first + x] = rgba;
                line.depth[first + x] = depth;
                if let Some(layer) = layer {
                    line.layers[first + x] = layer;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_cover_each_pixel_once_and_in_its_place() {
        for size in [[16, 16], [17, 40], [100, 33], [1, 1], [95, 16]] {
            for across in 1..8 {
                let pixels = (size[0] * size[1]) as usize;
                let layers = vec![Layer::default(); pixels];
                let mut frame = Frame { size, rgba: vec![[0.0; 4]; pixels], depth: vec![0.0; pixels], layers };
                for mut block in cut(&mut frame, across) {
                    let row = block.row;
                    assert!(!block.columns.is_empty() && block.columns.len() <= across);
                    for column in block.columns.clone() {
                        block.put(column, |i, y| {
                            let at = [(column * TILE + i % TILE) as f32, (row * TILE + y) as f32];
                            assert_eq!(i / TILE, y);
                            let layer = Layer { hair: at[1], ..Layer::default() };
                            ([at[0], at[1], 0.0, 1.0], at[0], Some(layer))
                        });
                    }
                }
                for i in 0..pixels {
                    let [x, y] = [i as u32 % size[0], i as u32 / size[0]].map(|c| c as f32);
                    assert_eq!(frame.rgba[i], [x, y, 0.0, 1.0], "{size:?} {across}");
                    assert_eq!((frame.depth[i], frame.layers[i].hair), (x, y), "{size:?} {across}");
                }
            }
        }
    }
}
