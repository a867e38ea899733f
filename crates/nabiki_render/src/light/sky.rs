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
#[cfg(test)]
mod tests;

use std::sync::atomic::AtomicBool;

use glam::{IVec3, UVec3, Vec3};
use nabiki::Mesh;
use rayon::prelude::*;

pub use self::arriving::{
    AT_ONCE, BEHIND_ABOVE, BEHIND_BARE, BEHIND_BELOW, BEHIND_GLOW, FRONT_ABOVE, FRONT_BARE, FRONT_BELOW, FRONT_GLOW,
    Places, TOWARD_LAMPS,
};
pub use self::directions::{Carry, Direction, LENGTHS};
pub use self::on_skin::OnSkin;
pub use self::skin_cells::SkinCell;

use self::arriving::Numbers;
use self::directions::halves;
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
/// The next size of cell, where there would be too many: so many times the one before. Hair that swings a little farther keeps its
/// cells, else its light would flicker, and what is worked out once for each size would be in each frame.
const COARSER: f32 = 1.25;
/// Most cells in a box about all skin.
const MOST_ABOUT_SKIN: f32 = 20_000_000.0;
/// Parts of a cell in which ways through them are counted.
const PARTS_BITS: i32 = 16;
const PARTS: f32 = (1 << PARTS_BITS) as f32;
/// Most steps in which a piece of hair is laid into cells.
const MOST_STEPS: i32 = 8;

/// The share of the sky that arrives in each cell about hair and head.
#[derive(Default)]
pub struct SkyMap {
    /// What the side of a cell (cm) is at least, in a draft; 0 elsewhere.
    least: f32,
    low: Vec3,
    cell: f32,
    size: UVec3,
    /// What hair takes of light that crosses a cell, and what all takes: optical depths.
    hair: Vec<f32>,
    taken: Vec<f32>,
    zenith: Vec3,
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
        let finest = CELL.max((WIDTHS * width).min(COARSE)).max(self.least);
        let least = (extent.x * extent.y * extent.z / MOST_CELLS).cbrt().max(extent.max_element() / 1000.0);
        self.cell = finest;
        while self.cell < least {
            self.cell *= COARSER;
        }
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
        self.zenith = zenith;
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

    /// Cuts space into cells of at least this side (cm), for a draft.
    pub fn coarsen(&mut self, least: f32) {
        self.least = least;
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
        let all_halves = |from: Vec3| halves(from.dot(self.zenith));
        exchange.open_sky(all_halves, |place, direction| self.through_hair_along(place, direction));
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
        self.through_hair_among((from - self.low) / self.cell, (to - self.low) / self.cell)
    }

    /// What hair leaves of light that comes along a direction (unit) to a place from afar.
    fn through_hair_along(&self, place: Vec3, direction: Vec3) -> f32 {
        let (from, size) = ((place - self.low) / self.cell, self.size.as_vec3());
        // Where it enters and leaves the box: after the last axis that lets it in, before the first that lets it out.
        let (a, b) = (-from / direction, (size - from) / direction);
        let (enters, leaves) = (a.min(b).max_element().max(0.0), a.max(b).min_element());
        if enters >= leaves {
            return 1.0;
        }
        self.through_hair_among(from + enters * direction, from + leaves * direction)
    }

    /// The same between two places in sides of a cell from the corner of the box on; outside there is none.
    fn through_hair_among(&self, from: Vec3, to: Vec3) -> f32 {
        let way = from.distance(to);
        let steps = (0.5 * way).ceil().max(1.0);
        // In parts of a cell: whole numbers go from step to step without a rounding of each.
        let part = |c: Vec3| (c * PARTS).as_ivec3();
        let step = (to - from) / steps;
        let (mut c, step) = (part(from + 0.5 * step), part(step));
        let mut taken = 0.0;
        for _ in 0..steps as u32 {
            // Below the box is far above it.
            let cell = UVec3::from_array(c.to_array().map(|c| (c >> PARTS_BITS) as u32));
            if cell.cmplt(self.size).all() {
                taken += self.hair[self.index(cell)];
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
