//! Distance and gradient in one reading, for collisions.

use glam::{UVec3, Vec3};

use super::{COARSE, EDGE, FINE, Samples, SkinDistance};

impl SkinDistance {
    /// Signed distance at `p` and its gradient there, that of the interpolation itself (of unit length but for the
    /// sampling; it jumps by that much from cell to cell). `None` beyond the sampled box.
    pub fn sample(&self, p: Vec3) -> Option<(f32, Vec3)> {
        let Samples { low, cell, nodes, mirrored, coarse, block_of, fine } = &self.samples;
        let flip = *mirrored && p.z < 0.0;
        let p = if *mirrored { p.with_z(p.z.abs()) } else { p };
        let q = (p - *low) / *cell;
        let cells = *nodes - 1;
        if !(q.cmpge(Vec3::ZERO).all() && q.cmplt(cells.as_vec3()).all()) {
            return None;
        }
        let c = q.as_uvec3();
        let t = q - c.as_vec3();
        let block = block_of[((c.z * cells.y + c.y) * cells.x + c.x) as usize];
        let (value, slope, edge) = if block == COARSE {
            let (nx, ny) = (nodes.x as usize, nodes.y as usize);
            let at = (c.z as usize * ny + c.y as usize) * nx + c.x as usize;
            let (value, slope) = trilinear(coarse, at, nx, nx * ny, t);
            (value, slope, *cell)
        } else {
            let t = t * FINE as f32;
            let f = t.as_uvec3().min(UVec3::splat(FINE as u32 - 1));
            let at = ((f.z as usize) * EDGE + f.y as usize) * EDGE + f.x as usize;
            let (value, slope) = trilinear(&fine[block as usize], at, EDGE, EDGE * EDGE, t - f.as_vec3());
            (value, slope, *cell / FINE as f32)
        };
        let gradient = slope / edge;
        Some((value, if flip { gradient.with_z(-gradient.z) } else { gradient }))
    }

    /// How far `p` lies beyond the sampled box (cm); 0 within. Where what was sampled lies `inset` within its box, the
    /// surface is at least that much farther away.
    pub fn beyond_box(&self, p: Vec3) -> f32 {
        let [low, high] = self.sampled_box();
        (low - p).max(p - high).max(Vec3::ZERO).length()
    }

    /// What was sampled coarsely, through the whole box: as good as the name of a surface.
    pub fn samples(&self) -> &[f32] {
        &self.samples.coarse
    }

    /// The corners of the box that was sampled.
    pub fn sampled_box(&self) -> [Vec3; 2] {
        let Samples { low, cell, nodes, mirrored, .. } = &self.samples;
        let high = *low + *cell * (*nodes - 1).as_vec3();
        [if *mirrored { low.with_z(-high.z) } else { *low }, high]
    }
}

/// The value between the eight samples of a cell whose first is `at`, and its slope for each edge of the cell; rows and
/// slices lie `row` and `slice` apart.
fn trilinear(samples: &[f32], at: usize, row: usize, slice: usize, t: Vec3) -> (f32, Vec3) {
    let along_x = |i: usize| (samples[i] + (samples[i + 1] - samples[i]) * t.x, samples[i + 1] - samples[i]);
    let along_y = |i: usize| {
        let ((a, ax), (b, bx)) = (along_x(i), along_x(i + row));
        (a + (b - a) * t.y, ax + (bx - ax) * t.y, b - a)
    };
    let ((a, ax, ay), (b, bx, by)) = (along_y(at), along_y(at + slice));
    (a + (b - a) * t.z, Vec3::new(ax + (bx - ax) * t.z, ay + (by - ay) * t.z, b - a))
}
