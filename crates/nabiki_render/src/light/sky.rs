//! Light from all around, and how much of it hair, head and bodies take away.
//!
//! Space is cut into cells that know how much fibre and how much skin they hold. Along fourteen lattice directions the light is
//! carried from cell to cell, losing what each cell takes. What arrives in a cell is kept as the eye's fibres need it: what comes from
//! the eye's side is sent back by a fibre, what comes from behind passes through it; each from the upper and from the lower half
//! of the sky.

mod arriving;
mod directions;
mod exchange;
mod on_skin;
mod outside;
mod skin_cells;

use std::sync::atomic::AtomicBool;

use glam::{IVec3, UVec3, Vec3};
use nabiki::Mesh;
use rayon::prelude::*;

pub use self::arriving::{
    AT_ONCE, BEHIND_ABOVE, BEHIND_BARE, BEHIND_BELOW, BEHIND_GLOW, FRONT_ABOVE, FRONT_BARE, FRONT_BELOW, FRONT_GLOW,
    Places, TOWARD_LAMPS,
};
pub use self::on_skin::OnSkin;
pub use self::skin_cells::SkinCell;

use self::arriving::Numbers;
use self::directions::{Carry, Direction, LENGTHS};
use self::exchange::Exchange;
use self::outside::Outside;
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
/// Most cells in a box about all skin.
const MOST_ABOUT_SKIN: f32 = 20_000_000.0;
/// Most steps in which a piece of hair is laid into cells.
const MOST_STEPS: i32 = 8;

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
    /// The same of skin alone, as if there were no hair.
    skin_depth: Vec<f32>,
    through_skin: [Vec<f32>; 2],
    bare: Vec<Vec<f32>>,
    /// Of each cell so many `parts`, each numbers that are read at once.
    arriving: Vec<Numbers>,
    parts: usize,
    /// Which stretches of cells that are summed together anybody reads from, line after line.
    read: Vec<AtomicBool>,
    /// The cells that the head's skin passes through, their edge, and the first and the last of the box about them.
    head: Vec<SkinCell>,
    head_of: Option<f32>,
    about_head: [IVec3; 2],
    /// What the head's and the bodies' cells send to each other; of which of them light is asked for, since they are among the hair or are
    /// seen by others, and the mean light that falls onto each.
    exchange: Exchange,
    /// And what those outside the box do to the light that comes into it, by their number in the exchange.
    outside: Outside,
    numbers: Vec<u32>,
    skin: Vec<SkinCell>,
    lit: Vec<f32>,
    glow: Vec<Vec<f32>>,
}

impl SkyMap {
    /// Lays out the cells about hair (its box, and how thick it is, cm) and finds the skin in them and about them, the head's and that of the
    /// `bodies`, and what sends light from there to hair and to the places on skin that are `seen`. `zenith` is above (unit).
    pub fn lay_out(
        &mut self,
        [mut low, mut high]: [Vec3; 2],
        width: f32,
        (head, bodies): (&Mesh, &[Mesh]),
        zenith: Vec3,
        seen: impl IndexedParallelIterator<Item = Vec3>,
    ) {
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
            let of_all = |f: fn(IVec3, IVec3) -> IVec3| self.head.iter().map(|skin| skin.cell).reduce(f);
            self.about_head = [of_all(IVec3::min), of_all(IVec3::max)].map(Option::unwrap_or_default);
        }
        let [first, last] = self.about_head;
        // Skin far from the hair counts as well, unless there is too much room for it.
        let has_room = (last - first).as_vec3().element_product() < MOST_ABOUT_SKIN;
        let among_hair = |skin: &SkinCell| self.index_of(skin).is_some();
        let near = |skin: &SkinCell| has_room && skin.cell.cmpge(first).all() && skin.cell.cmple(last).all();
        let of_bodies = (1..).zip(bodies).flat_map(|(i, body)| skin_cells(body, self.cell, i));
        let all = self.head.iter().copied().chain(of_bodies);
        let all: Vec<SkinCell> = all.filter(|skin| near(skin) || among_hair(skin)).collect();
        self.exchange.lay_out(&all, self.cell);
        self.exchange.ask(seen);
        self.directions.clear();
        self.directions.extend(Direction::all(zenith));
        let origin = self.origin();
        let (within, outside): (Vec<_>, Vec<_>) = (0..)
            .zip(&all)
            .map(|(i, skin)| (i, skin.cell - origin, *skin))
            .partition(|(_, cell, _)| cell.cmpge(IVec3::ZERO).all() && cell.cmplt(self.size.as_ivec3()).all());
        self.outside.lay_out(&outside, &self.directions, self.size);
        let mut needed = self.exchange.sends().to_vec();
        within.iter().for_each(|&(i, ..)| needed[i as usize] = true);
        self.outside.senders().for_each(|i| needed[i as usize] = true);
        self.numbers = (0..all.len() as u32).filter(|&i| needed[i as usize]).collect();
        self.skin = self.numbers.iter().map(|&i| all[i as usize]).collect();
    }

    /// Forgets which places on skin are seen.
    pub fn forget_seen(&mut self) {
        self.exchange.forget_asked();
    }

    /// The skin of which light is asked for.
    pub fn skin(&self) -> &[SkinCell] {
        &self.skin
    }

    /// Carries the sky's light through the hair (half thicknesses `radius`, cm) and past the skin.
    pub fn fill(&mut self, nodes: &[CurveNode], radius: &[f32]) {
        // What skin sends out is not known yet, and not that of the frame before.
        self.glow.iter_mut().for_each(Vec::clear);
        self.taken.clear();
        self.taken.resize(self.size.element_product() as usize, 0.0);
        self.lay_hair(nodes, radius);
        self.hair.clone_from(&self.taken);
        self.skin_depth.clear();
        self.skin_depth.resize(self.taken.len(), 0.0);
        for i in 0..self.skin.len() {
            if let Some(at) = self.index_of(&self.skin[i]) {
                self.taken[at] += self.skin[i].depth;
                self.skin_depth[at] += self.skin[i].depth;
            }
        }
        self.carry();
    }

    /// Sums what arrives about those of the nodes that are `asked` for, as the eye of a view and the lamps need it. `lit` is the light that
    /// falls onto the skin in each of its cells: skin sends it on as an even white surface would.
    pub fn gather(
        &mut self,
        (nodes, asked): (&[CurveNode], &[bool]),
        view: &View,
        lamps: &[Lamp],
        lit: impl Fn(&mut OnSkin, usize, &SkinCell) -> f32 + Sync,
    ) {
        let mut of_skin = std::mem::take(&mut self.lit);
        let this = &*self;
        (0..this.skin.len())
            .into_par_iter()
            .with_min_len(256)
            .map_init(|| OnSkin::new(this), |sky, i| lit(sky, i, &this.skin[i]))
            .collect_into_vec(&mut of_skin);
        let mut exchange = std::mem::take(&mut self.exchange);
        exchange.send(self.numbers.iter().copied().zip(of_skin.iter().copied()), |a, b| self.through_hair(a, b));
        self.exchange = exchange;
        self.lit = of_skin;
        self.carry_glow();
        self.mark(nodes, asked, view);
        self.sum(view, lamps);
    }

    /// Where skin is among the cells about the hair.
    fn index_of(&self, skin: &SkinCell) -> Option<usize> {
        let c = skin.cell - self.origin();
        let within = c.cmpge(IVec3::ZERO).all() && c.cmplt(self.size.as_ivec3()).all();
        within.then(|| self.index(c.as_uvec3()))
    }

    /// The first cell about the hair, on the lattice through the origin.
    fn origin(&self) -> IVec3 {
        (self.low / self.cell).round().as_ivec3()
    }

    /// What hair leaves of light between two places.
    fn through_hair(&self, from: Vec3, to: Vec3) -> f32 {
        let (from, to) = ((from - self.low) / self.cell, (to - self.low) / self.cell);
        let way = from.distance(to);
        let steps = (0.5 * way).ceil().max(1.0);
        let size = self.size.as_vec3();
        let (step, mut c, mut taken) = ((to - from) / steps, from + 0.5 * (to - from) / steps, 0.0);
        for _ in 0..steps as u32 {
            if c.cmpge(Vec3::ZERO).all() && c.cmplt(size).all() {
                taken += self.hair[self.index(c.as_uvec3())];
            }
            c += step;
        }
        exp_of_negative(-taken * way / steps)
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

    /// Carries light along the lattice directions, one after the other, slice by slice: past hair and skin, and past the skin alone.
    fn carry(&mut self) {
        let (size, directions, outside) = (self.size, &self.directions, &self.outside);
        let past = |taken: &[f32], all_through: &mut [Vec<f32>; 2], carried: &mut Vec<Vec<f32>>| {
            for (through, length) in all_through.iter_mut().zip(LENGTHS) {
                through.resize(taken.len(), 0.0);
                through.par_chunks_mut(8192).zip(taken.par_chunks(8192)).for_each(|(through, taken)| {
                    pulp::Arch::new().dispatch(Through { taken, length, through });
                });
            }
            carried.resize_with(directions.len(), Vec::new);
            let all_through = &*all_through;
            carried.par_iter_mut().zip(directions).enumerate().for_each(|(n, (light, d))| {
                light.clear();
                light.resize(taken.len(), 1.0);
                outside.take(n, light);
                let through = &all_through[d.length_index()];
                pulp::Arch::new().dispatch(Carry::<false> { direction: d, size, through, light });
            });
        };
        past(&self.taken, &mut self.through, &mut self.carried);
        past(&self.skin_depth, &mut self.through_skin, &mut self.bare);
    }

    /// Carries the light that skin sends out, likewise: it arrives in the skin's own cell and in the next, and goes on from there.
    fn carry_glow(&mut self) {
        self.glow.resize_with(self.directions.len(), Vec::new);
        // Where it starts, and how much of it: the cell's hair lies on its skin.
        let start = |(skin, lit): (&SkinCell, &f32)| {
            let at = self.index_of(skin)?;
            Some((skin.normal, at, lit * exp_of_negative(-self.hair[at]), skin.depth))
        };
        let starts: Vec<(Vec3, usize, f32, f32)> = self.skin.iter().zip(&self.lit).filter_map(start).collect();
        let (size, taken, through, outside) = (self.size, &self.taken, &self.through, &self.outside);
        let lit = self.exchange.lit();
        self.glow.par_iter_mut().zip(&self.directions).enumerate().for_each(|(n, (glow, d))| {
            let through = &through[d.length_index()];
            glow.clear();
            glow.resize(taken.len(), 0.0);
            outside.send(n, lit, glow);
            for &(normal, at, lit, depth) in &starts {
                // Only outward, away from where this direction's light comes from.
                if d.leaves(normal) {
                    let sent = lit * (1.0 - through[at]) * (depth / taken[at]).min(1.0);
                    glow[at] += sent;
                    let next = at as i32 + d.step[0] + size.x as i32 * (d.step[1] + size.y as i32 * d.step[2]);
                    if let Some(next) = usize::try_from(next).ok().and_then(|next| glow.get_mut(next)) {
                        *next += sent;
                    }
                }
            }
            pulp::Arch::new().dispatch(Carry::<true> { direction: d, size, through, light: glow });
        });
    }
}

/// What cells leave of light that goes so far in each (sides of a cell), compiled for each width of vectors that machines have; one is
/// chosen at run time.
struct Through<'a> {
    taken: &'a [f32],
    length: f32,
    through: &'a mut [f32],
}

impl pulp::NullaryFnOnce for Through<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        for (through, taken) in self.through.iter_mut().zip(self.taken) {
            *through = exp_of_negative(-taken * self.length);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::Camera;

    /// A square about a middle, with sides along two vectors; it faces along their cross product.
    pub(super) fn square(middle: Vec3, along: Vec3, across: Vec3) -> Mesh {
        let positions =
            [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[u, v]| middle + u * along + v * across).to_vec();
        Mesh { positions, triangles: vec![[0, 1, 2], [0, 2, 3]], corner_uvs: None }
    }

    /// Hairs that stand out from a ball of 1 cm, to 5.5 cm from its middle.
    fn ball() -> Vec<CurveNode> {
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
        nodes
    }

    #[test]
    fn hair_is_read_at_its_surface() {
        let nodes = ball();
        let mut sky = SkyMap::default();
        sky.lay_out(crate::curve::bounds(&nodes), 0.0, (&Mesh::default(), &[]), Vec3::Y, rayon::iter::empty());
        sky.fill(&nodes, &vec![0.05; nodes.len()]);
        sky.gather((&nodes, &vec![true; nodes.len()]), &view_from(0.0), &[], |_, _, _| 0.0);
        let open = |places: &arriving::Places<1>| sky.at(places, 0)[..FRONT_GLOW].iter().map(|of| of[0]).sum::<f32>();
        let one = |p: Vec3| p.to_array().map(|c| [c]);
        for (azimuth, elevation) in [(20.0, 10.0), (100.0, 50.0), (200.0, -30.0), (300.0, 80.0)] {
            let outward = crate::camera::direction(azimuth, elevation);
            let from = 5.0 * outward;
            let here = open(&sky.places(&one(from)));
            let farther = open(&sky.places(&one(from + 0.1 * outward)));
            let seen = open(&sky.places_seen(&one(from), &one(Vec3::ZERO)));
            // The cells' lattice bends what is outward by some degrees.
            let part = (seen - here) / (farther - here);
            assert!(farther > here && (0.9..1.2).contains(&part), "{azimuth}, {elevation}: {here} {farther} {seen}");
        }
    }

    #[test]
    fn the_sky_reaches_the_outside_of_a_ball_of_hair_and_not_its_middle() {
        let nodes = ball();
        let radius = vec![0.05; nodes.len()];
        let bounds = crate::curve::bounds(&nodes);
        let filled = |azimuth: f32| {
            let mut sky = SkyMap::default();
            sky.lay_out(bounds, 0.0, (&Mesh::default(), &[]), Vec3::Y, rayon::iter::empty());
            sky.fill(&nodes, &radius);
            let asked = [Vec3::ZERO, Vec3::new(0.0, 5.4, 0.0), Vec3::splat(100.0), Vec3::X * 5.4, Vec3::X * -5.4];
            sky.gather((&asked.map(at), &[true; 5]), &view_from(azimuth), &[lamp(Vec3::X)], |_, _, _| 0.0);
            sky
        };
        let sky = filled(0.0);
        let at = sky.at(&sky.places(&[[0.0, 0.0, 100.0], [0.0, 5.4, 100.0], [0.0, 0.0, 100.0]]), 0);
        let [middle, top, outside]: [[f32; TOWARD_LAMPS]; 3] =
            [0, 1, 2].map(|n| std::array::from_fn(|number| at[number][n]));
        let arrives = |at: [f32; TOWARD_LAMPS]| at[..FRONT_GLOW].iter().sum::<f32>();
        assert!(arrives(middle) < 0.05 && middle[FRONT_BARE] == 1.0 && middle[BEHIND_BARE] == 1.0, "{middle:?}");
        assert!(top[FRONT_ABOVE] > 0.35 && top[FRONT_ABOVE] > 2.0 * top[FRONT_BELOW], "{top:?}");
        assert!(arrives(outside) > 1.3, "{outside:?}");
        // Before the ball it is open toward the eye and closed behind; on its far side the other way round.
        let rims = [[5.4, -5.4], [0.0; 2], [0.0; 2]];
        let numbers = |sky: &SkyMap| -> [[f32; 2]; TOWARD_LAMPS + 1] {
            let places = sky.places(&rims);
            let at = [0, 1].map(|k| sky.at(&places, k)).concat();
            std::array::from_fn(|number| at[number])
        };
        let [near, far] = [0, 1].map(|n| numbers(&sky).map(|number| number[n]));
        let open =
            |at: [f32; TOWARD_LAMPS + 1]| (at[FRONT_ABOVE] + at[FRONT_BELOW], at[BEHIND_ABOVE] + at[BEHIND_BELOW]);
        assert!(open(near).0 > 0.6 && open(near).1 < 0.1, "{near:?}");
        assert!(open(far).0 < open(near).0 - 0.2 && open(far).1 > open(near).1 + 0.2, "{far:?}");
        // Toward a lamp at one side it is open there, and closed at the other.
        let (lit, shaded) = (near[TOWARD_LAMPS], far[TOWARD_LAMPS]);
        assert!(lit > 0.7 && shaded < 0.05, "{lit} {shaded}");
        // The other eye sees the same of the other side: the ball is the same to some hairs' places.
        let opposite = filled(180.0);
        let opposite = numbers(&opposite);
        for (number, (near, far)) in near.into_iter().zip(far).enumerate().take(TOWARD_LAMPS) {
            assert!((opposite[number][1] - near).abs() < 0.03 && (opposite[number][0] - far).abs() < 0.03);
        }
    }

    fn at(position: Vec3) -> CurveNode {
        CurveNode { position, ..CurveNode::default() }
    }

    fn lamp(toward: Vec3) -> Lamp {
        Lamp { toward, strength: [1.0; 3], spread: 0.0 }
    }

    fn view_from(azimuth: f32) -> View {
        let camera = Camera { azimuth, elevation: 0.0, ..Camera::default() };
        View::new(&camera, [64, 64], &crate::camera::Bounds::default())
    }

    #[test]
    fn what_reaches_a_surface_does_not_depend_on_what_was_asked_before() {
        let nodes: Vec<CurveNode> = (0..300_u32)
            .map(|i| {
                let (strand, k) = (i / 3, (i % 3) as f32);
                let position = crate::camera::direction(strand as f32 * 137.508, strand as f32 - 50.0) * (3.0 + k);
                CurveNode { position, strand, ..CurveNode::default() }
            })
            .collect();
        let mut sky = SkyMap::default();
        sky.lay_out(crate::curve::bounds(&nodes), 0.0, (&Mesh::default(), &[]), Vec3::Y, rayon::iter::empty());
        sky.fill(&nodes, &vec![0.1; nodes.len()]);
        sky.gather((&[], &[]), &view_from(0.0), &[], |_, _, _| 0.0);
        let mut one = OnSkin::new(&sky);
        for node in &nodes {
            let normal = node.position.normalize();
            assert_eq!(one.at(node.position, normal), OnSkin::new(&sky).at(node.position, normal));
        }
    }

    /// Skin far from the hair has the shade of the hair that is between it and the sky, and no more.
    #[test]
    fn what_reaches_a_surface_beyond_the_box_is_what_a_larger_box_would_bring_there() {
        let nodes = ball();
        let about_hair = crate::curve::bounds(&nodes);
        let filled = |bounds: [Vec3; 2]| {
            let mut sky = SkyMap::default();
            sky.lay_out(bounds, 0.0, (&Mesh::default(), &[]), Vec3::Y, rayon::iter::empty());
            sky.fill(&nodes, &vec![0.05; nodes.len()]);
            sky
        };
        let (small, large) = (filled(about_hair), filled([Vec3::splat(-22.0), Vec3::splat(22.0)]));
        let (mut small, mut large) = (OnSkin::new(&small), OnSkin::new(&large));
        let (mut shaded, mut off) = (0, 0.0_f32);
        for i in 0..2000 {
            let outward = crate::camera::direction(i as f32 * 137.508, 0.09 * i as f32 - 90.0);
            let place = (8.0 + 0.006 * i as f32) * outward;
            for normal in [-outward, Vec3::Y, Vec3::new(0.6, 0.0, -0.8)] {
                let [near, far] = [&mut small, &mut large].map(|sky| sky.at(place, normal));
                shaded += u32::from(far.iter().any(|open| *open < 0.8));
                off = (0..2).map(|half| (near[half] - far[half]).abs()).fold(off, f32::max);
            }
        }
        // Between the same cells, seen along the way and not about the place: of a ball's edge, four cells wide, up to half a cell.
        assert!(shaded > 200 && off < 0.125, "{off}, {shaded} shaded");
    }

    #[test]
    fn an_open_sky_arrives_whole_wherever_the_eye_is() {
        for zenith in [Vec3::Y, Vec3::new(0.36, -0.48, 0.8)] {
            let mut sky = SkyMap::default();
            let bounds = [Vec3::splat(-3.0), Vec3::splat(3.0)];
            sky.lay_out(bounds, 0.0, (&Mesh::default(), &[]), zenith, rayon::iter::empty());
            sky.fill(&[], &[]);
            // More lamps than have room beside the rest.
            let asked = [at(Vec3::new(0.3, -0.7, 1.1))];
            sky.gather((&asked, &[true]), &view_from(47.0), &[lamp(zenith); 4], |_, _, _| 0.0);
            let place = sky.places(&[[0.3], [-0.7], [1.1]]);
            let at = sky.at(&place, 0).map(|number| number[0]);
            // A dozen roundings of sums of 14 numbers.
            assert!((at[FRONT_ABOVE] + at[FRONT_BELOW] - 1.0).abs() < 1e-5, "{at:?}");
            assert!((at[BEHIND_ABOVE] + at[BEHIND_BELOW] - 1.0).abs() < 1e-5, "{at:?}");
            for number in TOWARD_LAMPS..TOWARD_LAMPS + 4 {
                let open = sky.at(&place, number / AT_ONCE)[number % AT_ONCE][0];
                assert!((open - 1.0).abs() < 1e-5, "{open}");
            }
            let above = OnSkin::new(&sky).at(Vec3::ZERO, Vec3::new(0.6, 0.0, 0.8));
            assert!(above.iter().all(|open| (open - 1.0).abs() < 1e-5), "{above:?}");
        }
    }
}
