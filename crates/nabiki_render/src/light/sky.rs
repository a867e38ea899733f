//! Light from all around, and how much of it hair, head and bodies take away.
//!
//! Space is cut into cells that know how much fibre and how much skin they hold. Along fourteen lattice directions the light is
//! carried from cell to cell, losing what each cell takes; what arrives is kept as two numbers a cell: the light from the
//! upper and from the lower half of the sky.

use glam::{IVec3, UVec3, Vec3};
use nabiki::Mesh;
use rayon::prelude::*;

use super::approx::exp_of_negative;
use crate::curve::CurveNode;

/// Side of a cell (cm), unless the hair is so spread out that this would make too many.
const CELL: f32 = 0.55;
const MOST_CELLS: f32 = 1_000_000.0;
/// Optical depth of skin, for each full crossing of a cell.
const SKIN: f32 = 4.0;

/// Share of the sky that arrives: from above and from below, each 0..1 of its half.
#[derive(Clone, Copy, Default)]
struct Arriving {
    above: f32,
    below: f32,
}

/// The share of the sky that arrives in each cell about hair and head.
#[derive(Default)]
pub struct SkyMap {
    low: Vec3,
    cell: f32,
    size: UVec3,
    taken: Vec<f32>,
    carried: Vec<Vec<f32>>,
    arriving: Vec<Arriving>,
    /// What the head's skin takes of the light in each cell, by the cell's place on the lattice through the origin.
    skin: Vec<(IVec3, f32)>,
    /// Edge of those cells.
    skin_of: Option<f32>,
}

impl SkyMap {
    /// Carries the sky's light through the hair (its box and half thicknesses `radius`, cm) and past the head and the `bodies`; `zenith`
    /// is above (unit).
    pub fn fill(
        &mut self,
        nodes: &[CurveNode],
        [mut low, mut high]: [Vec3; 2],
        radius: &[f32],
        (head, bodies): (&Mesh, &[Mesh]),
        zenith: Vec3,
    ) {
        if !low.is_finite() {
            (low, high) = (Vec3::ZERO, Vec3::ZERO);
        }
        let extent = high - low;
        self.cell = CELL.max((extent.x * extent.y * extent.z / MOST_CELLS).cbrt()).max(extent.max_element() / 1000.0);
        // Whole cells from a fixed origin: a grid that moved with the hair would make the light flicker.
        let border = 2.0;
        self.low = ((low / self.cell).floor() - border) * self.cell;
        self.size = ((high - self.low) / self.cell).ceil().as_uvec3() + UVec3::splat(border as u32 + 1);
        self.taken.clear();
        self.taken.resize(self.size.element_product() as usize, 0.0);
        self.lay_hair(nodes, radius);
        self.lay_head(head);
        bodies.iter().for_each(|body| self.lay_skin(&skin_cells(body, self.cell)));
        self.carry(zenith);
    }

    /// What arrives at places (x, y and z of all of them) from above and from below; outside of the cells, what arrives at their
    /// border.
    #[inline(always)]
    pub fn at<const N: usize>(&self, places: &[[f32; N]; 3]) -> [[f32; N]; 2] {
        let last = (self.size.as_vec3() - 1.001).max(Vec3::ZERO);
        let per_cell = 1.0 / self.cell;
        let c: [[f32; N]; 3] = std::array::from_fn(|axis| {
            let (low, last) = (self.low[axis], last[axis]);
            places[axis].map(|p| ((p - low) * per_cell - 0.5).max(0.0).min(last))
        });
        // Toward zero is down: there is nothing below.
        let base = c.map(|c| c.map(|c| c as i32));
        let (row, slice) = (self.size.x as usize, (self.size.x * self.size.y) as usize);
        // All that is read first, so that the waits for memory go on side by side.
        let mut corners = [[[0.0; N]; 2]; 8];
        for n in 0..N {
            let [x, y, z] = [0, 1, 2].map(|axis| base[axis][n] as usize);
            let at = x + row * y + slice * z;
            for (line, pair) in [0, row, slice, slice + row].into_iter().zip(corners.chunks_exact_mut(2)) {
                let cells = &self.arriving[at + line..at + line + 2];
                for (corner, cell) in pair.iter_mut().zip(cells) {
                    corner[0][n] = cell.above;
                    corner[1][n] = cell.below;
                }
            }
        }
        std::array::from_fn(|half| {
            std::array::from_fn(|n| {
                let [u, v, w] = [0, 1, 2].map(|axis| c[axis][n] - base[axis][n] as f32);
                let line = |i: usize| {
                    let (a, b) = (corners[i][half][n], corners[i + 1][half][n]);
                    a + (b - a) * u
                };
                let plane = |i: usize| line(i) + (line(i + 2) - line(i)) * v;
                plane(0) + (plane(4) - plane(0)) * w
            })
        })
    }

    fn index(&self, c: UVec3) -> usize {
        (c.x + self.size.x * (c.y + self.size.y * c.z)) as usize
    }

    fn lay_hair(&mut self, nodes: &[CurveNode], radius: &[f32]) {
        // Optical depth per crossing: projected area over the cell's face, averaged over directions (pi / 4).
        let per_area = std::f32::consts::FRAC_PI_4 / (self.cell * self.cell);
        for (i, pair) in nodes.windows(2).enumerate() {
            if pair[0].strand != pair[1].strand {
                continue;
            }
            let length = pair[0].position.distance(pair[1].position);
            let c = (0.5 * (pair[0].position + pair[1].position) - self.low) / self.cell - 0.5;
            // Toward zero is down: the border keeps it above.
            let base = c.as_uvec3();
            let f = c - base.as_vec3();
            let at = self.index(base);
            let amount = 2.0 * radius[i] * length * per_area;
            let (row, slice) = (self.size.x as usize, (self.size.x * self.size.y) as usize);
            for (z, wz) in [(0, 1.0 - f.z), (slice, f.z)] {
                for (y, wy) in [(0, 1.0 - f.y), (row, f.y)] {
                    let w = amount * wz * wy;
                    self.taken[at + z + y] += w * (1.0 - f.x);
                    self.taken[at + z + y + 1] += w * f.x;
                }
            }
        }
    }

    /// Marks the cells that the head's skin passes through. It stands still: which they are is worked out once for each size
    /// of cell.
    fn lay_head(&mut self, head: &Mesh) {
        if self.skin_of != Some(self.cell) {
            self.skin = skin_cells(head, self.cell);
            self.skin_of = Some(self.cell);
        }
        let skin = std::mem::take(&mut self.skin);
        self.lay_skin(&skin);
        self.skin = skin;
    }

    fn lay_skin(&mut self, skin: &[(IVec3, f32)]) {
        let low = (self.low / self.cell).round().as_ivec3();
        for &(cell, depth) in skin {
            let c = cell - low;
            if c.cmpge(IVec3::ZERO).all() && c.cmplt(self.size.as_ivec3()).all() {
                let at = self.index(c.as_uvec3());
                self.taken[at] += depth;
            }
        }
    }

    /// Carries light along the lattice directions, one after the other, slice by slice.
    fn carry(&mut self, zenith: Vec3) {
        let directions: Vec<[i32; 3]> = (0..27_i32)
            .map(|i| [i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1])
            .filter(|d| matches!(squared_length(*d), 1 | 3))
            .collect();
        let through = |length: f32| {
            let taken = self.taken.par_iter().with_min_len(8192);
            taken.map(move |t| exp_of_negative(-t * length)).collect::<Vec<f32>>()
        };
        let (straight, aslant) = rayon::join(|| through(1.0), || through(3.0_f32.sqrt()));
        self.carried.resize_with(directions.len(), Vec::new);
        let size = self.size;
        self.carried.par_iter_mut().zip(&directions).for_each(|(light, &d)| {
            carry_along(d, size, if squared_length(d) == 1 { &straight } else { &aslant }, light);
        });
        let sum = |half: fn(f32) -> f32| directions.iter().map(|d| half(unit_height(*d, zenith))).sum::<f32>();
        let (all_above, all_below) = (sum(above), sum(below));
        self.arriving.resize(self.taken.len(), Arriving::default());
        let carried = &self.carried;
        self.arriving.par_chunks_mut(4096).enumerate().for_each(|(chunk, arriving)| {
            arriving.fill(Arriving::default());
            for (d, light) in directions.iter().zip(carried) {
                let (up, down) =
                    (above(unit_height(*d, zenith)) / all_above, below(unit_height(*d, zenith)) / all_below);
                for (a, &l) in arriving.iter_mut().zip(&light[chunk * 4096..]) {
                    a.above += up * l;
                    a.below += down * l;
                }
            }
        });
    }
}

/// Cells of edge `cell` that a surface passes through, each with the optical depth of what lies in it.
fn skin_cells(solid: &Mesh, cell: f32) -> Vec<(IVec3, f32)> {
    let mut shares: Vec<([i32; 3], f32)> = Vec::new();
    for triangle in &solid.triangles {
        let [a, b, c] = triangle.map(|v| solid.positions[v as usize]);
        let area = 0.5 * (b - a).cross(c - a).length();
        let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
        let steps = (2.0 * longest / cell).ceil().clamp(1.0, 64.0) as usize;
        let share = area / (steps * steps) as f32 / (cell * cell);
        for i in 0..steps {
            for j in 0..steps {
                // Points of a lattice on the unit square, folded onto the triangle.
                let (mut u, mut v) = ((i as f32 + 0.5) / steps as f32, (j as f32 + 0.5) / steps as f32);
                if u + v > 1.0 {
                    (u, v) = (1.0 - u, 1.0 - v);
                }
                let p = (a + (b - a) * u + (c - a) * v) / cell;
                shares.push((p.floor().as_ivec3().to_array(), share));
            }
        }
    }
    // Stable, so that the shares of a cell are always added in one order.
    shares.sort_by_key(|&(cell, _)| cell);
    let of_cells = shares.chunk_by(|a, b| a.0 == b.0);
    of_cells
        .map(|of_cell| {
            let marked: f32 = of_cell.iter().map(|(_, share)| share).sum();
            (IVec3::from(of_cell[0].0), SKIN * marked.min(1.5))
        })
        .collect()
}

/// Light that arrives in each cell from direction `-d`, before the cell takes its own part; `through` is what a cell
/// leaves of it.
fn carry_along(d: [i32; 3], size: UVec3, through: &[f32], light: &mut Vec<f32>) {
    let [nx, ny, nz] = [size.x, size.y, size.z].map(|n| n as i32);
    light.clear();
    light.resize(through.len(), 1.0);
    let order = |n: i32, step: i32| (0..n).map(move |i| if step < 0 { n - 1 - i } else { i });
    for z in order(nz, d[2]) {
        for y in order(ny, d[1]) {
            let (fy, fz) = (y - d[1], z - d[2]);
            if !(0..ny).contains(&fy) || !(0..nz).contains(&fz) {
                continue;
            }
            let width = nx as usize;
            let (here, from) = (width * (y + ny * z) as usize, width * (fy + ny * fz) as usize);
            if here == from {
                for x in order(nx, d[0]) {
                    let fx = x - d[0];
                    if (0..nx).contains(&fx) {
                        let i = from + fx as usize;
                        light[here + x as usize] = light[i] * through[i];
                    }
                }
                continue;
            }
            let (to, source) = if here > from {
                let (before, after) = light.split_at_mut(here);
                (&mut after[..width], &before[from..from + width])
            } else {
                let (before, after) = light.split_at_mut(from);
                (&mut before[here..here + width], &after[..width])
            };
            let (first, count) = (d[0].max(0) as usize, width - d[0].unsigned_abs() as usize);
            let from_x = (-d[0]).max(0) as usize;
            let through = &through[from + from_x..][..count];
            for ((to, &light), &through) in to[first..][..count].iter_mut().zip(&source[from_x..][..count]).zip(through)
            {
                *to = light * through;
            }
        }
    }
}

fn squared_length(d: [i32; 3]) -> i32 {
    d.iter().map(|c| c * c).sum()
}

/// Height of the place that light travelling along `d` comes from, on the unit sphere.
fn unit_height(d: [i32; 3], zenith: Vec3) -> f32 {
    -Vec3::from_array(d.map(|c| c as f32)).dot(zenith) / (squared_length(d) as f32).sqrt()
}

/// Weights of a direction in the two halves of the sky; they add up to 1 and meet at the horizon.
fn above(height: f32) -> f32 {
    0.5 + 0.5 * height
}

fn below(height: f32) -> f32 {
    0.5 - 0.5 * height
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sky_reaches_the_outside_of_a_ball_of_hair_and_not_its_middle() {
        let mut nodes = vec![];
        for s in 0..4000_u32 {
            let direction = crate::camera::direction(
                s as f32 * 137.508,
                (1.0 - 2.0 * (s as f32 + 0.5) / 4000.0).asin().to_degrees(),
            );
            for k in 0..10 {
                nodes.push(CurveNode {
                    position: direction * (1.0 + 0.5 * k as f32),
                    strand: s,
                    ..CurveNode::default()
                });
            }
        }
        let radius = vec![0.05; nodes.len()];
        let mut sky = SkyMap::default();
        sky.fill(&nodes, crate::curve::bounds(&nodes), &radius, (&Mesh::default(), &[]), Vec3::Y);
        let [above, below] = sky.at(&[[0.0, 0.0, 100.0], [0.0, 5.4, 100.0], [0.0, 0.0, 100.0]]);
        let [middle, top, outside] = [0, 1, 2].map(|n| (above[n], below[n]));
        assert!(middle.0 < 0.05 && middle.1 < 0.05, "{middle:?}");
        assert!(top.0 > 0.6 && top.0 > 2.0 * top.1, "{top:?}");
        assert!(outside.0 > 0.8 && outside.1 > 0.5, "{outside:?}");
    }
}
