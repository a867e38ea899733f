//! What a step reads and writes, and nothing else: the least that it can cost.

use rayon::prelude::*;

/// The bytes of a step without its work: for each segment 24 read and written, 4 `READ` read, 12 written.
pub struct Bytes<const READ: usize> {
    /// Of sixteen segments each.
    pub states: Vec<[[f32; 16]; 6]>,
    shapes: Vec<[[f32; 16]; READ]>,
    points: Vec<f32>,
    /// Of a strand.
    pub segments: usize,
}

impl<const READ: usize> Bytes<READ> {
    /// For so many strands of equal segments.
    pub fn new(strands: usize, segments: usize) -> Self {
        let rows = strands.div_ceil(16) * segments;
        let (states, shapes) = (vec![[[1e-3; 16]; 6]; rows], vec![[[1e-3; 16]; READ]; rows]);
        Self { states, shapes, points: vec![0.0; rows * 48], segments }
    }

    /// Once through all of them.
    pub fn pass(&mut self) {
        let rows = 8 * self.segments;
        let states = self.states.par_chunks_mut(rows).zip(self.shapes.par_chunks(rows));
        states.zip(self.points.par_chunks_mut(rows * 48)).for_each(|((states, shapes), points)| {
            for ((row, shape), out) in states.iter_mut().zip(shapes).zip(points.as_chunks_mut::<48>().0) {
                for (quantity, shape) in row.iter_mut().zip(shape.iter().cycle()) {
                    quantity.iter_mut().zip(shape).for_each(|(v, s)| *v = s - *v);
                }
                out[..16].copy_from_slice(&row[0]);
                out[16..32].copy_from_slice(&row[1]);
                out[32..].copy_from_slice(&row[2]);
            }
        });
    }
}
