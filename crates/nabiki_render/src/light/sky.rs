//! Light from all around, and how much of it hair, head and bodies take away.
//!
//! Space is cut into cells that know how much fibre and how much skin they hold. Along fourteen lattice directions the light is
//! carried from cell to cell, losing what each cell takes. What arrives in a cell is kept as the eye's fibres need it: what comes from
//! the eye's side is sent back by a fibre, what comes from behind passes through it; each from the upper and from the lower half
//! of the sky.

use glam::{IVec3, UVec3, Vec3};
use nabiki::Mesh;
use rayon::prelude::*;

use super::approx::exp_of_negative;
use crate::camera::View;
use crate::curve::CurveNode;

/// Side of a cell (cm), unless the hair is so spread out that this would make too many.
const CELL: f32 = 0.55;
const MOST_CELLS: f32 = 1_000_000.0;
/// Most steps in which a piece of hair is laid into cells.
const MOST_STEPS: i32 = 8;
/// Optical depth of skin, for each full crossing of a cell.
const SKIN: f32 = 4.0;

/// Weights by which the sky is summed over lattice directions: along the axes and along the diagonals of a cube (Lebedev's rule
/// of 14 points, exact for polynomials of fifth degree).
const ALONG_AXIS: f32 = 1.0 / 15.0;
const ALONG_DIAGONAL: f32 = 3.0 / 40.0;

/// Means over the directions on the eye's side, and over those behind, of the light that arrives from above and from below: where all
/// is open the two of a side add up to 1.
pub const FRONT_ABOVE: usize = 0;
pub const FRONT_BELOW: usize = 1;
pub const BEHIND_ABOVE: usize = 2;
pub const BEHIND_BELOW: usize = 3;
type Arriving = [f32; 4];

/// A lattice direction in which light travels.
struct Direction {
    step: [i32; 3],
    /// Unit vector to where the light comes from.
    from: Vec3,
    weight: f32,
    /// The parts of its light that count as from above and as from below.
    halves: [f32; 2],
}

/// The share of the sky that arrives in each cell about hair and head.
#[derive(Default)]
pub struct SkyMap {
    low: Vec3,
    cell: f32,
    size: UVec3,
    taken: Vec<f32>,
    directions: Vec<Direction>,
    carried: Vec<Vec<f32>>,
    arriving: Vec<Arriving>,
    /// What the head's skin takes of the light in each cell, by the cell's place on the lattice through the origin.
    skin: Vec<(IVec3, f32)>,
    /// Edge of those cells.
    skin_of: Option<f32>,
}

impl SkyMap {
    /// Carries the sky's light through the hair (its box and half thicknesses `radius`, cm) and past the head and the `bodies`; `zenith`
    /// is above (unit), and the view has the eye.
    pub fn fill(
        &mut self,
        nodes: &[CurveNode],
        [mut low, mut high]: [Vec3; 2],
        radius: &[f32],
        (head, bodies): (&Mesh, &[Mesh]),
        zenith: Vec3,
        view: &View,
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
        self.gather(view);
    }

    /// What arrives at places (x, y and z of all of them), from the four quarters that the constants name; outside of the cells, what
    /// arrives at their border.
    #[inline(always)]
    pub fn at<const N: usize>(&self, places: &[[f32; N]; 3]) -> [[f32; N]; 4] {
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
        let mut corners = [[[0.0; N]; 4]; 8];
        for n in 0..N {
            let [x, y, z] = [0, 1, 2].map(|axis| base[axis][n] as usize);
            let at = x + row * y + slice * z;
            for (line, pair) in [0, row, slice, slice + row].into_iter().zip(corners.chunks_exact_mut(2)) {
                let cells = &self.arriving[at + line..at + line + 2];
                for (corner, cell) in pair.iter_mut().zip(cells) {
                    for quarter in 0..4 {
                        corner[quarter][n] = cell[quarter];
                    }
                }
            }
        }
        std::array::from_fn(|quarter| {
            std::array::from_fn(|n| {
                let [u, v, w] = [0, 1, 2].map(|axis| c[axis][n] - base[axis][n] as f32);
                let line = |i: usize| {
                    let (a, b) = (corners[i][quarter][n], corners[i + 1][quarter][n]);
                    a + (b - a) * u
                };
                let plane = |i: usize| line(i) + (line(i + 2) - line(i)) * v;
                plane(0) + (plane(4) - plane(0)) * w
            })
        })
    }

    /// The shares of the sky above and of that below, 0..1 each, that arrive at a place on a surface with this unit normal.
    pub fn on_surface(&self, place: Vec3, normal: Vec3) -> [f32; 2] {
        let last = (self.size.as_vec3() - 1.001).max(Vec3::ZERO);
        let c = ((place - self.low) / self.cell - 0.5).clamp(Vec3::ZERO, last);
        let base = c.as_uvec3();
        let f = c - base.as_vec3();
        let at = self.index(base);
        let (row, slice) = (self.size.x as usize, (self.size.x * self.size.y) as usize);
        let (mut arrives, mut all) = ([0.0_f32; 2], [1e-12_f32; 2]);
        for (direction, light) in self.directions.iter().zip(&self.carried) {
            let facing = direction.weight * normal.dot(direction.from);
            if facing <= 0.0 {
                continue;
            }
            let line = |i: usize| light[i] + (light[i + 1] - light[i]) * f.x;
            let plane = |i: usize| line(i) + (line(i + row) - line(i)) * f.y;
            let open = plane(at) + (plane(at + slice) - plane(at)) * f.z;
            for half in 0..2 {
                arrives[half] += facing * direction.halves[half] * open;
                all[half] += facing * direction.halves[half];
            }
        }
        [0, 1].map(|half| arrives[half] / all[half])
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
            let way = (pair[1].position - pair[0].position) / self.cell;
            let length = way.length();
            // In steps of a cell at most: hair that skipped cells would leave them bright.
            let steps = (length as i32).min(MOST_STEPS - 1) + 1;
            let part = 1.0 / steps as f32;
            let amount = 2.0 * radius[i] * length * self.cell * per_area * part;
            let start = (pair[0].position - self.low) / self.cell - 0.5;
            let (row, slice) = (self.size.x as usize, (self.size.x * self.size.y) as usize);
            for k in 0..steps {
                let c = start + way * ((k as f32 + 0.5) * part);
                // Toward zero is down: the border keeps it above.
                let base = c.as_uvec3();
                let f = c - base.as_vec3();
                let at = self.index(base);
                for (z, wz) in [(0, 1.0 - f.z), (slice, f.z)] {
                    for (y, wy) in [(0, 1.0 - f.y), (row, f.y)] {
                        let w = amount * wz * wy;
                        self.taken[at + z + y] += w * (1.0 - f.x);
                        self.taken[at + z + y + 1] += w * f.x;
                    }
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
        self.directions.clear();
        self.directions.extend((0..27_i32).map(|i| [i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1]).filter_map(|step| {
            let weight = match squared_length(step) {
                1 => ALONG_AXIS,
                3 => ALONG_DIAGONAL,
                _ => return None,
            };
            let from = -Vec3::from_array(step.map(|c| c as f32)).normalize();
            let above = above(from.dot(zenith));
            Some(Direction { step, from, weight, halves: [above, 1.0 - above] })
        }));
        let through = |length: f32| {
            let taken = self.taken.par_iter().with_min_len(8192);
            taken.map(move |t| exp_of_negative(-t * length)).collect::<Vec<f32>>()
        };
        let (straight, aslant) = rayon::join(|| through(1.0), || through(3.0_f32.sqrt()));
        self.carried.resize_with(self.directions.len(), Vec::new);
        let size = self.size;
        self.carried.par_iter_mut().zip(&self.directions).for_each(|(light, d)| {
            carry_along(d.step, size, if squared_length(d.step) == 1 { &straight } else { &aslant }, light);
        });
    }

    /// Sums what arrives in each cell over the directions, as its eye sees it.
    fn gather(&mut self, view: &View) {
        self.arriving.resize(self.taken.len(), Arriving::default());
        let (row, slice) = (self.size.x as usize, (self.size.x * self.size.y) as usize);
        let (low, cell, carried, taken, directions) =
            (self.low, self.cell, &self.carried, &self.taken, &self.directions);
        self.arriving.par_chunks_mut(row).enumerate().for_each(|(line, arriving)| {
            let first = line * row;
            let start = low + cell * (Vec3::new(0.0, (first % slice / row) as f32, (first / slice) as f32) + 0.5);
            let eye: Vec<Vec3> = (0..row).map(|x| view.toward_eye(start + Vec3::X * cell * x as f32)).collect();
            arriving.fill(Arriving::default());
            for (d, light) in directions.iter().zip(carried) {
                let [above, below] = d.halves.map(|half| d.weight * half);
                for ((a, &l), e) in arriving.iter_mut().zip(&light[first..]).zip(&eye) {
                    let aside = e.dot(d.from);
                    // Each of mean 1 over all directions. What passes through a fibre goes on nearly straight.
                    let away = (1.0 - aside) * (1.0 - aside);
                    let (front, behind) = (l * (1.0 + aside), l * away * away * (1.0 / 3.2));
                    a[FRONT_ABOVE] += above * front;
                    a[FRONT_BELOW] += below * front;
                    a[BEHIND_ABOVE] += above * behind;
                    a[BEHIND_BELOW] += below * behind;
                }
            }
            // What the eye sees of a cell lies on its near side: what comes from behind has to cross all of it.
            for (a, t) in arriving.iter_mut().zip(&taken[first..]) {
                let own = exp_of_negative(-t);
                a[BEHIND_ABOVE] *= own;
                a[BEHIND_BELOW] *= own;
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

/// The part of the light from a direction of this height (-1..1) that counts as from above. The halves of the sky meet at the horizon,
/// softly, so that a head that turns does not take its fourteen directions across it at once.
fn above(height: f32) -> f32 {
    0.5 + height * (0.75 - 0.25 * height * height)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::Camera;

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
        let bounds = crate::curve::bounds(&nodes);
        let filled = |azimuth: f32| {
            let mut sky = SkyMap::default();
            sky.fill(&nodes, bounds, &radius, (&Mesh::default(), &[]), Vec3::Y, &view_from(azimuth));
            sky
        };
        let sky = filled(0.0);
        let at = sky.at(&[[0.0, 0.0, 100.0], [0.0, 5.4, 100.0], [0.0, 0.0, 100.0]]);
        let [middle, top, outside] = [0, 1, 2].map(|n| at.map(|quarter| quarter[n]));
        assert!(middle.iter().all(|&light| light < 0.05), "{middle:?}");
        assert!(top[FRONT_ABOVE] > 0.35 && top[FRONT_ABOVE] > 2.0 * top[FRONT_BELOW], "{top:?}");
        assert!(outside.iter().sum::<f32>() > 1.3, "{outside:?}");
        // Before the ball it is open toward the eye and closed behind; on its far side the other way round.
        let rims = [[5.4, -5.4], [0.0; 2], [0.0; 2]];
        let [near, far] = [0, 1].map(|n| sky.at(&rims).map(|quarter| quarter[n]));
        let open = |at: [f32; 4]| (at[FRONT_ABOVE] + at[FRONT_BELOW], at[BEHIND_ABOVE] + at[BEHIND_BELOW]);
        assert!(open(near).0 > 0.6 && open(near).1 < 0.1, "{near:?}");
        assert!(open(far).0 < open(near).0 - 0.2 && open(far).1 > open(near).1 + 0.2, "{far:?}");
        // The other eye sees the same of the other side: the ball is the same to some hairs' places.
        let opposite = filled(180.0).at(&rims);
        for (quarter, (near, far)) in near.into_iter().zip(far).enumerate() {
            assert!((opposite[quarter][1] - near).abs() < 0.03 && (opposite[quarter][0] - far).abs() < 0.03);
        }
    }

    fn view_from(azimuth: f32) -> View {
        let camera = Camera { azimuth, elevation: 0.0, ..Camera::default() };
        View::new(&camera, [64, 64], &crate::camera::Bounds::default())
    }

    #[test]
    fn an_open_sky_arrives_whole_wherever_the_eye_is() {
        for zenith in [Vec3::Y, Vec3::new(0.36, -0.48, 0.8)] {
            let mut sky = SkyMap::default();
            let bounds = [Vec3::splat(-3.0), Vec3::splat(3.0)];
            sky.fill(&[], bounds, &[], (&Mesh::default(), &[]), zenith, &view_from(47.0));
            let at = sky.at(&[[0.3], [-0.7], [1.1]]).map(|quarter| quarter[0]);
            // A dozen roundings of sums of 14 numbers.
            assert!((at[FRONT_ABOVE] + at[FRONT_BELOW] - 1.0).abs() < 1e-5, "{at:?}");
            assert!((at[BEHIND_ABOVE] + at[BEHIND_BELOW] - 1.0).abs() < 1e-5, "{at:?}");
            let above = sky.on_surface(Vec3::ZERO, Vec3::new(0.6, 0.0, 0.8));
            assert!(above.iter().all(|open| (open - 1.0).abs() < 1e-5), "{above:?}");
        }
    }
}
