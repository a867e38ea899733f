//! Light from all around, and how much of it hair, head and bodies take away.
//!
//! Space is cut into cells that know how much fibre and how much skin they hold. Along fourteen lattice directions the light is
//! carried from cell to cell, losing what each cell takes. What arrives in a cell is kept as the eye's fibres need it: what comes from
//! the eye's side is sent back by a fibre, what comes from behind passes through it; each from the upper and from the lower half
//! of the sky.

mod directions;
mod skin_cells;

use glam::{IVec3, UVec3, Vec3};
use nabiki::Mesh;
use rayon::prelude::*;

pub use self::skin_cells::SkinCell;

use self::directions::{Direction, carry_along};
use self::skin_cells::skin_cells;
use super::approx::exp_of_negative;
use super::lamps::Lamp;
use crate::camera::View;
use crate::curve::CurveNode;

/// Side of a cell (cm), unless the hair is so spread out that this would make too many.
const CELL: f32 = 0.55;
/// Few thick hairs stand for many in a preview: a cell is so many of them wide, and not wider than this (cm).
const WIDTHS: f32 = 8.0;
const COARSE: f32 = 0.9;
const MOST_CELLS: f32 = 1_000_000.0;
/// Most steps in which a piece of hair is laid into cells.
const MOST_STEPS: i32 = 8;

/// Means over the directions on the eye's side, and over those behind, of the light that arrives from above and from below: where all
/// is open the two of a side add up to 1.
pub const FRONT_ABOVE: usize = 0;
pub const FRONT_BELOW: usize = 1;
pub const BEHIND_ABOVE: usize = 2;
pub const BEHIND_BELOW: usize = 3;
/// The same of the light that skin sends back, in parts of what an even white surface under it would show.
pub const FRONT_GLOW: usize = 4;
pub const BEHIND_GLOW: usize = 5;
/// How many numbers a cell has.
pub const ARRIVING: usize = 6;
type Arriving = [f32; ARRIVING];

/// Where some places lie among the cells.
pub struct Places<const N: usize> {
    /// The cell below each along all axes.
    first: [usize; N],
    /// How far into the next, 0..1, along each axis.
    beyond: [[f32; N]; 3],
}

impl<const N: usize> Places<N> {
    /// Between the values at the eight cells about place `n`, in proportion.
    #[inline(always)]
    fn between(&self, n: usize, corner: impl Fn(usize) -> f32) -> f32 {
        let [u, v, w] = self.beyond.map(|beyond| beyond[n]);
        let line = |i: usize| corner(i) + (corner(i + 1) - corner(i)) * u;
        let plane = |i: usize| line(i) + (line(i + 2) - line(i)) * v;
        plane(0) + (plane(4) - plane(0)) * w
    }
}

/// The share of the sky that arrives in each cell about hair and head.
#[derive(Default)]
pub struct SkyMap {
    low: Vec3,
    cell: f32,
    size: UVec3,
    /// What hair takes of light that crosses a cell, and what all takes: optical depths.
    hair: Vec<f32>,
    taken: Vec<f32>,
    directions: Vec<Direction>,
    /// What each cell leaves of light that crosses it straight, and aslant.
    through: [Vec<f32>; 2],
    carried: Vec<Vec<f32>>,
    arriving: Vec<Arriving>,
    /// For each lamp, how open each cell is about its direction, 0..1.
    toward_lamps: Vec<Vec<f32>>,
    /// The cells that the head's skin passes through, and their edge.
    head: Vec<SkinCell>,
    head_of: Option<f32>,
    /// Those within the map, the head's and the bodies', and the mean light that falls onto each.
    skin: Vec<SkinCell>,
    lit: Vec<f32>,
    glow: Vec<Vec<f32>>,
}

impl SkyMap {
    /// Lays out the cells about hair (its box, and how thick it is, cm) and finds the skin in them, the head's and that of the `bodies`.
    pub fn lay_out(&mut self, [mut low, mut high]: [Vec3; 2], width: f32, (head, bodies): (&Mesh, &[Mesh])) {
        if !low.is_finite() {
            (low, high) = (Vec3::ZERO, Vec3::ZERO);
        }
        let extent = high - low;
        let finest = CELL.max((WIDTHS * width).min(COARSE));
        self.cell = finest.max((extent.x * extent.y * extent.z / MOST_CELLS).cbrt()).max(extent.max_element() / 1000.0);
        // Whole cells from a fixed origin: a grid that moved with the hair would make the light flicker.
        let border = 2.0;
        self.low = ((low / self.cell).floor() - border) * self.cell;
        self.size = ((high - self.low) / self.cell).ceil().as_uvec3() + UVec3::splat(border as u32 + 1);
        // The head stands still: where its skin is, is worked out once for each size of cell.
        if self.head_of != Some(self.cell) {
            self.head = skin_cells(head, self.cell, 0);
            self.head_of = Some(self.cell);
        }
        let (first, size) = ((self.low / self.cell).round().as_ivec3(), self.size.as_ivec3());
        let within = |skin: &SkinCell| {
            let c = skin.cell - first;
            c.cmpge(IVec3::ZERO).all() && c.cmplt(size).all()
        };
        self.skin.clear();
        self.skin.extend(self.head.iter().copied().filter(within));
        for (i, body) in bodies.iter().enumerate() {
            self.skin.extend(skin_cells(body, self.cell, i as u16 + 1).into_iter().filter(within));
        }
    }

    /// The skin in the cells.
    pub fn skin(&self) -> &[SkinCell] {
        &self.skin
    }

    /// Carries the sky's light through the hair (half thicknesses `radius`, cm) and past the skin; `zenith` is above (unit).
    pub fn fill(&mut self, nodes: &[CurveNode], radius: &[f32], zenith: Vec3) {
        // What skin sends out is not known yet, and not that of the frame before.
        self.glow.iter_mut().for_each(Vec::clear);
        self.taken.clear();
        self.taken.resize(self.size.element_product() as usize, 0.0);
        self.lay_hair(nodes, radius);
        self.hair.clone_from(&self.taken);
        for i in 0..self.skin.len() {
            let at = self.index_of(&self.skin[i]);
            self.taken[at] += self.skin[i].depth;
        }
        self.carry(zenith);
    }

    /// Finds how open each cell is about the directions of the lamps: light that hair scatters forward strays from the lamp's direction,
    /// and finds ways that are shorter than the straight one where that goes along the hair's surface.
    pub fn look_toward(&mut self, lamps: &[Lamp]) {
        self.toward_lamps.resize_with(lamps.len(), Vec::new);
        let (directions, carried, cells) = (&self.directions, &self.carried, self.taken.len());
        self.toward_lamps.par_iter_mut().zip(lamps).for_each(|(open, lamp)| {
            let shares = || directions.iter().map(|d| d.weight * d.from.dot(lamp.toward).max(0.0).powi(2));
            let all: f32 = shares().sum();
            open.clear();
            open.resize(cells, 0.0);
            for (share, light) in shares().zip(carried).filter(|(share, _)| *share > 0.0) {
                let share = share / all;
                open.iter_mut().zip(light).for_each(|(open, light)| *open += share * light);
            }
        });
    }

    /// Sums what arrives in each cell for the eye of a view. `lit` is the light that falls onto the skin in each of its cells: skin sends it
    /// on as an even white surface would.
    pub fn gather(&mut self, view: &View, lit: impl Fn(&Self, usize, &SkinCell) -> f32 + Sync) {
        let mut of_skin = std::mem::take(&mut self.lit);
        let this = &*self;
        (0..this.skin.len())
            .into_par_iter()
            .with_min_len(256)
            .map(|i| lit(this, i, &this.skin[i]))
            .collect_into_vec(&mut of_skin);
        self.lit = of_skin;
        self.carry_glow();
        self.sum(view);
    }

    /// What arrives at places, as the constants name it.
    #[inline(always)]
    pub fn at<const N: usize>(&self, places: &Places<N>) -> [[f32; N]; ARRIVING] {
        // All that is read first, so that the waits for memory go on side by side.
        let mut corners = [[[0.0; N]; ARRIVING]; 8];
        for n in 0..N {
            for (line, pair) in self.lines().into_iter().zip(corners.chunks_exact_mut(2)) {
                let at = places.first[n] + line;
                for (corner, cell) in pair.iter_mut().zip(&self.arriving[at..at + 2]) {
                    for quarter in 0..ARRIVING {
                        corner[quarter][n] = cell[quarter];
                    }
                }
            }
        }
        std::array::from_fn(|quarter| std::array::from_fn(|n| places.between(n, |i| corners[i][quarter][n])))
    }

    /// How open it is about the direction of lamp `l` at places, 0..1.
    #[inline(always)]
    pub fn toward_lamp<const N: usize>(&self, l: usize, places: &Places<N>) -> [f32; N] {
        let open = &self.toward_lamps[l];
        let mut corners = [[0.0; N]; 8];
        for n in 0..N {
            for (line, pair) in self.lines().into_iter().zip(corners.chunks_exact_mut(2)) {
                let at = places.first[n] + line;
                for (corner, open) in pair.iter_mut().zip(&open[at..at + 2]) {
                    corner[n] = *open;
                }
            }
        }
        std::array::from_fn(|n| places.between(n, |i| corners[i][n]))
    }

    /// Where places (x, y and z of all of them) lie among the cells; those outside at the border.
    #[inline(always)]
    pub fn places<const N: usize>(&self, places: &[[f32; N]; 3]) -> Places<N> {
        let last = (self.size.as_vec3() - 1.001).max(Vec3::ZERO);
        let per_cell = 1.0 / self.cell;
        let c: [[f32; N]; 3] = std::array::from_fn(|axis| {
            let (low, last) = (self.low[axis], last[axis]);
            places[axis].map(|p| ((p - low) * per_cell - 0.5).max(0.0).min(last))
        });
        // Toward zero is down: there is nothing below.
        let base = c.map(|c| c.map(|c| c as i32));
        let [_, row, slice, _] = self.lines();
        let first = std::array::from_fn(|n| {
            let [x, y, z] = [0, 1, 2].map(|axis| base[axis][n] as usize);
            x + row * y + slice * z
        });
        Places { first, beyond: std::array::from_fn(|i| std::array::from_fn(|n| c[i][n] - base[i][n] as f32)) }
    }

    /// From the first of the eight cells about a place to those that begin a pair along x.
    #[inline(always)]
    fn lines(&self) -> [usize; 4] {
        let (row, slice) = (self.size.x as usize, (self.size.x * self.size.y) as usize);
        [0, row, slice, slice + row]
    }

    /// The shares of the sky above and of that below, 0..1 each, that arrive at a place on a surface with this unit normal, and the
    /// light that other skin sends there.
    pub fn on_surface(&self, place: Vec3, normal: Vec3) -> [f32; 3] {
        let place = self.places(&place.to_array().map(|c| [c]));
        let lines = self.lines();
        let (mut arrives, mut all) = ([0.0_f32; 3], [1e-12_f32; 3]);
        for (n, (direction, light)) in self.directions.iter().zip(&self.carried).enumerate() {
            let facing = direction.weight * normal.dot(direction.from);
            if facing <= 0.0 {
                continue;
            }
            let between = |light: &[f32]| place.between(0, |i| light[place.first[0] + lines[i / 2] + i % 2]);
            let open = between(light);
            for half in 0..2 {
                arrives[half] += facing * direction.halves[half] * open;
                all[half] += facing * direction.halves[half];
            }
            // Skin to the side is mostly the same that curves away; what faces it counts.
            let facing = facing * facing;
            arrives[2] += facing * self.glow.get(n).filter(|glow| !glow.is_empty()).map_or(0.0, |glow| between(glow));
            all[2] += facing;
        }
        std::array::from_fn(|i| arrives[i] / all[i])
    }

    fn index_of(&self, skin: &SkinCell) -> usize {
        self.index((skin.cell - (self.low / self.cell).round().as_ivec3()).as_uvec3())
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

    /// Carries light along the lattice directions, one after the other, slice by slice.
    fn carry(&mut self, zenith: Vec3) {
        self.directions.clear();
        self.directions.extend(Direction::all(zenith));
        let through = |length: f32| {
            let taken = self.taken.par_iter().with_min_len(8192);
            taken.map(move |t| exp_of_negative(-t * length)).collect::<Vec<f32>>()
        };
        let (straight, aslant) = rayon::join(|| through(1.0), || through(3.0_f32.sqrt()));
        self.carried.resize_with(self.directions.len(), Vec::new);
        let size = self.size;
        self.carried.par_iter_mut().zip(&self.directions).for_each(|(light, d)| {
            light.clear();
            light.resize(straight.len(), 1.0);
            carry_along::<false>(d.step, size, if d.is_aslant() { &aslant } else { &straight }, light);
        });
        self.through = [straight, aslant];
    }

    /// Carries the light that skin sends out, likewise: it arrives in the skin's own cell and in the next, and goes on from there.
    fn carry_glow(&mut self) {
        self.glow.resize_with(self.directions.len(), Vec::new);
        let places: Vec<usize> = self.skin.iter().map(|skin| self.index_of(skin)).collect();
        let (size, skin, lit, taken, through) = (self.size, &self.skin, &self.lit, &self.taken, &self.through);
        let hair = &self.hair;
        self.glow.par_iter_mut().zip(&self.directions).for_each(|(glow, d)| {
            let through = &through[usize::from(d.is_aslant())];
            glow.clear();
            glow.resize(taken.len(), 0.0);
            for ((&at, skin), &lit) in places.iter().zip(skin).zip(lit) {
                // Only outward, away from where this direction's light comes from.
                if skin.normal.dot(d.from) < 0.0 {
                    let sent = lit * (1.0 - through[at]) * (skin.depth / taken[at]).min(1.0);
                    glow[at] += sent;
                    let next = at as i32 + d.step[0] + size.x as i32 * (d.step[1] + size.y as i32 * d.step[2]);
                    if let Some(next) = usize::try_from(next).ok().and_then(|next| glow.get_mut(next)) {
                        *next += sent * exp_of_negative(-0.5 * hair[at]);
                    }
                }
            }
            carry_along::<true>(d.step, size, through, glow);
        });
    }

    /// Sums what arrives in each cell over the directions, as its eye sees it.
    fn sum(&mut self, view: &View) {
        self.arriving.resize(self.taken.len(), Arriving::default());
        let (row, slice) = (self.size.x as usize, (self.size.x * self.size.y) as usize);
        let (low, cell, taken, directions) = (self.low, self.cell, &self.taken, &self.directions);
        let (carried, glow, hair) = (&self.carried, &self.glow, &self.hair);
        self.arriving.par_chunks_mut(row).enumerate().for_each(|(line, arriving)| {
            let first = line * row;
            let start = low + cell * (Vec3::new(0.0, (first % slice / row) as f32, (first / slice) as f32) + 0.5);
            let eye: Vec<Vec3> = (0..row).map(|x| view.toward_eye(start + Vec3::X * cell * x as f32)).collect();
            arriving.fill(Arriving::default());
            for ((d, light), glow) in directions.iter().zip(carried).zip(glow) {
                let [above, below] = d.halves.map(|half| d.weight * half);
                for (((a, &l), &g), e) in arriving.iter_mut().zip(&light[first..]).zip(&glow[first..]).zip(&eye) {
                    let aside = e.dot(d.from);
                    // Each of mean 1 over all directions. What passes through a fibre goes on nearly straight.
                    let away = (1.0 - aside) * (1.0 - aside);
                    let (before, after) = (1.0 + aside, away * away * (1.0 / 3.2));
                    let (front, behind) = (l * before, l * after);
                    a[FRONT_GLOW] += d.weight * g * before;
                    a[BEHIND_GLOW] += d.weight * g * after;
                    a[FRONT_ABOVE] += above * front;
                    a[FRONT_BELOW] += below * front;
                    a[BEHIND_ABOVE] += above * behind;
                    a[BEHIND_BELOW] += below * behind;
                }
            }
            // What the eye sees of a cell lies on its near side: what comes from behind has to cross all of it.
            for ((a, t), hair) in arriving.iter_mut().zip(&taken[first..]).zip(&hair[first..]) {
                a[BEHIND_GLOW] *= exp_of_negative(-hair);
                let own = exp_of_negative(-t);
                a[BEHIND_ABOVE] *= own;
                a[BEHIND_BELOW] *= own;
            }
        });
    }
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
            sky.lay_out(bounds, 0.0, (&Mesh::default(), &[]));
            sky.fill(&nodes, &radius, Vec3::Y);
            sky.gather(&view_from(azimuth), |_, _, _| 0.0);
            sky
        };
        let sky = filled(0.0);
        let at = sky.at(&sky.places(&[[0.0, 0.0, 100.0], [0.0, 5.4, 100.0], [0.0, 0.0, 100.0]]));
        let [middle, top, outside] = [0, 1, 2].map(|n| at.map(|quarter| quarter[n]));
        assert!(middle.iter().all(|&light| light < 0.05), "{middle:?}");
        assert!(top[FRONT_ABOVE] > 0.35 && top[FRONT_ABOVE] > 2.0 * top[FRONT_BELOW], "{top:?}");
        assert!(outside.iter().sum::<f32>() > 1.3, "{outside:?}");
        // Before the ball it is open toward the eye and closed behind; on its far side the other way round.
        let rims = [[5.4, -5.4], [0.0; 2], [0.0; 2]];
        let [near, far] = [0, 1].map(|n| sky.at(&sky.places(&rims)).map(|quarter| quarter[n]));
        let open = |at: [f32; ARRIVING]| (at[FRONT_ABOVE] + at[FRONT_BELOW], at[BEHIND_ABOVE] + at[BEHIND_BELOW]);
        assert!(open(near).0 > 0.6 && open(near).1 < 0.1, "{near:?}");
        assert!(open(far).0 < open(near).0 - 0.2 && open(far).1 > open(near).1 + 0.2, "{far:?}");
        // Toward a lamp at one side it is open there, and closed at the other.
        let mut sky = sky;
        sky.look_toward(&[lamp(Vec3::X)]);
        let [lit, shaded] = sky.toward_lamp(0, &sky.places(&rims));
        assert!(lit > 0.7 && shaded < 0.05, "{lit} {shaded}");
        // The other eye sees the same of the other side: the ball is the same to some hairs' places.
        let opposite = filled(180.0);
        let opposite = opposite.at(&opposite.places(&rims));
        for (quarter, (near, far)) in near.into_iter().zip(far).enumerate() {
            assert!((opposite[quarter][1] - near).abs() < 0.03 && (opposite[quarter][0] - far).abs() < 0.03);
        }
    }

    fn lamp(toward: Vec3) -> Lamp {
        Lamp { toward, strength: [1.0; 3], spread: 0.0 }
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
            sky.lay_out(bounds, 0.0, (&Mesh::default(), &[]));
            sky.fill(&[], &[], zenith);
            sky.gather(&view_from(47.0), |_, _, _| 0.0);
            let place = sky.places(&[[0.3], [-0.7], [1.1]]);
            let at = sky.at(&place).map(|quarter| quarter[0]);
            // A dozen roundings of sums of 14 numbers.
            assert!((at[FRONT_ABOVE] + at[FRONT_BELOW] - 1.0).abs() < 1e-5, "{at:?}");
            assert!((at[BEHIND_ABOVE] + at[BEHIND_BELOW] - 1.0).abs() < 1e-5, "{at:?}");
            sky.look_toward(&[lamp(zenith)]);
            assert!((sky.toward_lamp(0, &place)[0] - 1.0).abs() < 1e-5);
            let above = sky.on_surface(Vec3::ZERO, Vec3::new(0.6, 0.0, 0.8));
            assert!(above[..2].iter().all(|open| (open - 1.0).abs() < 1e-5) && above[2] == 0.0, "{above:?}");
        }
    }
}
