//! Light that skin sends to other skin: from the neck to the jaw, from a cheek to the side of the nose, between face and hand.
//!
//! A cell of skin looks along many directions for the skin that it sees there. That sends light as an even white surface would, and hair
//! between the two takes its part. Fourteen directions would do for what is as rough as hair; on skin each of them draws an edge.

use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};

use glam::{IVec3, UVec3, Vec3};
use rayon::prelude::*;

use super::skin_cells::{SKIN, SkinCell};

/// Directions all round; skin looks along about half of them.
const DIRECTIONS: u32 = 160;
/// The least cosine at which skin is seen: that of one cell is not quite flat, and would see itself.
const FACING: f32 = 0.1;
/// A look goes on by so much at once, and where no skin is near by so much (sides of a cell).
const STEP: f32 = 0.7;
const BLOCK: u32 = 4;
/// How far beyond the box of the head's cells skin of bodies counts (sides of a cell).
const BESIDE: i32 = 16;
const NOBODY: u32 = u32::MAX;
/// So far above the skin (cm) hair begins to keep the sky from it: what lies on it is hair's own business.
const ABOVE: f32 = 0.9;
/// How much skin near a place counts for the sky whichever way it faces.
const CREASED: f32 = 0.02;

/// What skin sees of other skin, and the light that comes from there.
#[derive(Default)]
pub struct Exchange {
    cells: Vec<SkinCell>,
    /// Side of a cell (cm).
    cell: f32,
    /// The first cell of a box about the head, its size, and the skin in each of its cells. Bodies do not change it: a frame would depend on those
    /// before it.
    low: IVec3,
    size: UVec3,
    at: Vec<u32>,
    /// The same box in blocks of cells: what lies in one or beside it.
    blocks: UVec3,
    near: Vec<Near>,
    /// Which skin it is asked about, and which sends light there; empty if that is not known yet.
    asked: Vec<AtomicBool>,
    sends: Vec<bool>,
    /// What skin of the head sees of the head, once it has looked: a part of `seen`. Along which directions skin sees the sky: that of the head past
    /// the head alone.
    looks: Vec<Option<[u32; 2]>>,
    seen: Vec<Seen>,
    open: Vec<Directions>,
    /// Skin of the bodies, which move: pairs of skin that see each other.
    pairs: Vec<Pair>,
    /// The light that falls onto each skin, as far as it is known, and what of it arrives at each that is asked about, with its normal.
    lit: Vec<f32>,
    light: Vec<(Vec3, Arriving)>,
}

/// Whether skin of the head is near, and whether that of a body is.
#[derive(Clone, Copy, Default)]
struct Near {
    head: bool,
    body: bool,
}

/// Some of the directions: a bit each.
type Directions = [u64; DIRECTIONS.div_ceil(64) as usize];

/// What arrives at a place on skin.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Arriving {
    /// The light that other skin sends.
    pub glow: f32,
    /// The shares of the sky above and below, 0..1 each, that no skin hides.
    pub open: [f32; 2],
    /// And what hair leaves of those, 0..1.
    pub through: [f32; 2],
}

/// Skin that other skin sees.
#[derive(Clone, Copy)]
struct Seen {
    skin: u32,
    /// The part of all that the other sees, 0..1, by the cosine to its normal.
    share: f32,
}

/// Skin that sees a part of other skin, and gets light from there.
struct Pair {
    skin: u32,
    seen: Seen,
}

impl Exchange {
    /// Has these cells of edge `cell` (cm), those of the head first.
    pub fn lay_out(&mut self, cells: &[SkinCell], cell: f32) {
        if self.cell == cell && self.cells == cells {
            return;
        }
        let of_head = |cells: &[SkinCell]| cells.partition_point(|skin| skin.solid == 0);
        let head = of_head(cells);
        // The head sees itself through bodies: what it sees stays while they move.
        if self.cell != cell || self.cells[..of_head(&self.cells)] != cells[..head] {
            self.looks.clear();
            self.looks.resize(head, None);
            self.seen.clear();
            self.open.clear();
        }
        self.open.resize(cells.len(), Directions::default());
        self.forget_asked();
        self.cell = cell;
        self.cells.clear();
        self.cells.extend_from_slice(cells);
        let of_head = || cells[..head].iter().map(|skin| skin.cell);
        self.low = of_head().reduce(IVec3::min).unwrap_or_default() - BESIDE;
        let high = of_head().reduce(IVec3::max).unwrap_or_default() + BESIDE;
        self.size = (high - self.low + 1).as_uvec3();
        self.at.clear();
        self.at.resize(count(self.size), NOBODY);
        self.blocks = self.size / BLOCK + 1;
        self.near.clear();
        self.near.resize(count(self.blocks), Near::default());
        for (i, skin) in cells.iter().enumerate() {
            if skin.cell.cmplt(self.low).any() || skin.cell.cmpgt(high).any() {
                continue;
            }
            let cell = (skin.cell - self.low).as_uvec3();
            let at = &mut self.at[index(cell, self.size)];
            if *at == NOBODY {
                *at = i as u32;
            }
            for n in 0..27 {
                let beside = cell / BLOCK + UVec3::new(n % 3, n / 3 % 3, n / 9);
                if beside.cmpge(UVec3::ONE).all() && beside.cmple(self.blocks).all() {
                    let near = &mut self.near[index(beside - 1, self.blocks)];
                    *near = Near { head: near.head || i < head, body: near.body || i >= head };
                }
            }
        }
    }

    /// Forgets at which places it was asked what arrives.
    pub fn forget_asked(&mut self) {
        self.asked.clear();
    }

    /// Says at which places on skin it will be asked what arrives, unless that is known.
    pub fn ask(&mut self, places: impl IndexedParallelIterator<Item = Vec3>) {
        if self.asked.is_empty() {
            self.asked.resize_with(self.cells.len(), AtomicBool::default);
            let this = &*self;
            places.with_min_len(2048).for_each(|place| {
                for (skin, _) in this.about(place).into_iter().flatten() {
                    // Most are asked already, and a line of memory that is only read is both cores'.
                    if !this.asked[skin].load(Ordering::Relaxed) {
                        this.asked[skin].store(true, Ordering::Relaxed);
                    }
                }
            });
            self.look_about();
        }
    }

    /// Which skin sends light to where it is asked about.
    pub fn sends(&self) -> &[bool] {
        &self.sends
    }

    fn look_about(&mut self) {
        let (head, all) = (self.looks.len(), self.cells.len());
        let directions: Vec<Vec3> = (0..DIRECTIONS).map(direction).collect();
        let new: Vec<usize> = (0..head).filter(|&i| self.is_asked(i) && self.looks[i].is_none()).collect();
        let look = |&i: &usize| self.look(i, &directions);
        let found: Vec<(Vec<Seen>, Directions)> = new.par_iter().with_min_len(64).map(look).collect();
        let bodies: Vec<usize> = (head..all).collect();
        let found_by_bodies: Vec<(Vec<Seen>, Directions)> = bodies.par_iter().with_min_len(16).map(look).collect();
        for (i, (seen, open)) in new.into_iter().zip(found) {
            let first = self.seen.len() as u32;
            self.seen.extend(seen);
            self.looks[i] = Some([first, self.seen.len() as u32]);
            self.open[i] = open;
        }
        self.pairs.clear();
        for (i, (seen, open)) in bodies.into_iter().zip(found_by_bodies) {
            self.open[i] = open;
            for seen in seen {
                let other = seen.skin as usize;
                if self.is_asked(i) {
                    self.pairs.push(Pair { skin: i as u32, seen });
                }
                // The head looks for no bodies: what a body sees of it sees the body, by the sizes of both.
                if other < head && self.is_asked(other) {
                    let share = seen.share * self.cells[i].depth / self.cells[other].depth.max(0.5 * SKIN);
                    self.pairs.push(Pair { skin: seen.skin, seen: Seen { skin: i as u32, share } });
                }
            }
        }
        self.sends.clear();
        self.sends.resize(all, false);
        for i in 0..head {
            if let Some([first, end]) = self.looks[i].filter(|_| self.is_asked(i)) {
                self.seen[first as usize..end as usize].iter().for_each(|seen| self.sends[seen.skin as usize] = true);
            }
        }
        self.pairs.iter().for_each(|pair| self.sends[pair.seen.skin as usize] = true);
    }

    fn is_asked(&self, i: usize) -> bool {
        self.asked[i].load(Ordering::Relaxed)
    }

    /// What skin `i` sees, skin of the head only that of the head, and along which directions it sees none.
    fn look(&self, i: usize, directions: &[Vec3]) -> (Vec<Seen>, Directions) {
        let mut seen: Vec<Seen> = Vec::new();
        let mut open = Directions::default();
        let mut all = 0.0;
        let others = if i < self.looks.len() { 0..self.looks.len() } else { 0..self.cells.len() };
        for (n, &direction) in directions.iter().enumerate() {
            let facing = direction.dot(self.cells[i].normal);
            if facing <= 0.0 {
                continue;
            }
            all += facing;
            match self.first_along(i, direction, &others) {
                Some(skin) => match seen.iter_mut().find(|seen| seen.skin == skin) {
                    Some(seen) => seen.share += facing,
                    None => seen.push(Seen { skin, share: facing }),
                },
                None => open[n / 64] |= 1 << (n % 64),
            }
        }
        seen.iter_mut().for_each(|seen| seen.share /= all);
        (seen, open)
    }

    /// The skin among `others` that faces skin `i` first along a direction.
    fn first_along(&self, i: usize, direction: Vec3, others: &Range<usize>) -> Option<u32> {
        let head = self.looks.len();
        let (of_head, of_bodies) = (others.start < head, others.end > head);
        let size = self.size.as_vec3();
        let mut place = self.among(self.cells[i].place);
        while place.cmpge(Vec3::ZERO).all() && place.cmplt(size).all() {
            let cell = place.as_uvec3();
            let skin = self.at[index(cell, self.size)];
            if skin != i as u32
                && others.contains(&(skin as usize))
                && self.cells[skin as usize].normal.dot(direction) < -FACING
            {
                return Some(skin);
            }
            let near = self.near[index(cell / BLOCK, self.blocks)];
            let is_near = (of_head && near.head) || (of_bodies && near.body);
            place += if is_near { STEP } else { BLOCK as f32 } * direction;
        }
        None
    }

    /// A place (cm) in sides of a cell from the corner of the box on.
    fn among(&self, place: Vec3) -> Vec3 {
        place / self.cell - self.low.as_vec3()
    }

    /// Sends the light that falls onto skin (by its number) on to what sees it and is asked about; `through` says what is left of it between two places.
    pub fn send(&mut self, sent: impl Iterator<Item = (u32, f32)>, through: impl Fn(Vec3, Vec3) -> f32 + Sync) {
        self.lit.clear();
        self.lit.resize(self.cells.len(), 0.0);
        sent.for_each(|(skin, light)| self.lit[skin as usize] = light);
        let mut light = std::mem::take(&mut self.light);
        let this = &*self;
        let sent = |i: usize, seen: &Seen| {
            let other = seen.skin as usize;
            let lit = seen.share * this.lit[other];
            if lit > 0.0 { lit * through(this.cells[i].place, this.cells[other].place) } else { 0.0 }
        };
        let arriving = |i: usize| match this.looks.get(i) {
            Some(&Some([first, end])) if this.is_asked(i) => {
                this.seen[first as usize..end as usize].iter().map(|seen| sent(i, seen)).sum()
            }
            _ => 0.0,
        };
        let arriving = |i: usize| (this.cells[i].normal, Arriving { glow: arriving(i), ..Arriving::default() });
        (0..this.cells.len()).into_par_iter().with_min_len(256).map(arriving).collect_into_vec(&mut light);
        let between: Vec<f32> =
            this.pairs.par_iter().with_min_len(1024).map(|pair| sent(pair.skin as usize, &pair.seen)).collect();
        for (pair, sent) in this.pairs.iter().zip(between) {
            light[pair.skin as usize].1.glow += sent;
        }
        self.light = light;
    }

    /// Lets the sky in to all skin that is asked about, after what other skin sends: `halves` says which parts of a direction's light count as
    /// from above and as from below, `through` what hair leaves of it on its way to a place.
    pub fn open_sky(&mut self, halves: impl Fn(Vec3) -> [f32; 2], through: impl Fn(Vec3, Vec3) -> f32 + Sync) {
        let directions: Vec<(Vec3, [f32; 2])> = (0..DIRECTIONS).map(direction).map(|d| (d, halves(d))).collect();
        let mut light = std::mem::take(&mut self.light);
        let this = &*self;
        let bodies = this.looks.len()..this.cells.len();
        light.par_iter_mut().enumerate().with_min_len(64).filter(|(i, _)| this.is_asked(*i)).for_each(|(i, light)| {
            let skin = &this.cells[i];
            // The head's own looks go past bodies, which move.
            let hidden = |d: Vec3| i < bodies.start && !bodies.is_empty() && this.first_along(i, d, &bodies).is_some();
            let [mut all, mut open, mut arriving] = [[1e-12_f32; 2]; 3];
            for (n, &(direction, halves)) in directions.iter().enumerate() {
                let facing = direction.dot(skin.normal);
                if facing <= 0.0 {
                    continue;
                }
                let parts = halves.map(|half| half * facing);
                add(&mut all, parts, 1.0);
                if this.open[i][n / 64] >> (n % 64) & 1 == 1 && !hidden(direction) {
                    add(&mut open, parts, 1.0);
                    add(&mut arriving, parts, through(skin.place + ABOVE * skin.normal, direction));
                }
            }
            light.1.open = [0, 1].map(|half| open[half] / all[half]);
            light.1.through = [0, 1].map(|half| arriving[half] / open[half]);
        });
        self.light = light;
    }

    /// The light that falls onto each skin, as it was sent last.
    pub fn lit(&self) -> &[f32] {
        &self.lit
    }

    /// What arrives at a place on a surface with this unit normal: between the skin about it, of such as faces where it does. None where no
    /// skin is known.
    pub fn at(&self, place: Vec3, normal: Vec3) -> Option<Arriving> {
        let (mut sum, mut all) = (Arriving::default(), 0.0);
        let mut all_alike = 1e-6;
        for (skin, near) in self.about(place).into_iter().flatten() {
            let (faces, arriving) = self.light[skin];
            let alike = faces.dot(normal).max(0.0);
            let weight = near * alike * alike;
            sum.glow += weight * arriving.glow;
            all_alike += weight;
            // In a crease no skin may face as a place does.
            let weight = weight + CREASED * near;
            add(&mut sum.open, arriving.open, weight);
            add(&mut sum.through, arriving.through, weight);
            all += weight;
        }
        (all > 0.0).then(|| Arriving {
            glow: sum.glow / all_alike,
            open: sum.open.map(|open| open / all),
            through: sum.through.map(|through| through / all),
        })
    }

    /// The skin in the eight cells about a place, and how near each is, 0..1.
    #[inline(always)]
    fn about(&self, place: Vec3) -> [Option<(usize, f32)>; 8] {
        // A cell lower, so that toward zero is down.
        let place = (self.among(place) + 0.5).clamp(Vec3::ZERO, self.size.as_vec3() + 1.0);
        let base = place.as_uvec3();
        let beyond = place - base.as_vec3();
        std::array::from_fn(|corner| {
            let c = UVec3::new(corner as u32 & 1, corner as u32 >> 1 & 1, corner as u32 >> 2);
            let cell = base + c;
            if cell.cmpeq(UVec3::ZERO).any() || cell.cmpgt(self.size).any() {
                return None;
            }
            let skin = self.at[index(cell - 1, self.size)];
            let near = Vec3::select(c.cmpeq(UVec3::ONE), beyond, 1.0 - beyond).element_product();
            (skin != NOBODY).then_some((skin as usize, near))
        })
    }
}

fn add(sum: &mut [f32; 2], parts: [f32; 2], times: f32) {
    sum.iter_mut().zip(parts).for_each(|(sum, part)| *sum += times * part);
}

/// Cells in a box of them.
fn count(size: UVec3) -> usize {
    size.to_array().into_iter().map(|n| n as usize).product()
}

fn index(cell: UVec3, size: UVec3) -> usize {
    (cell.x + size.x * (cell.y + size.y * cell.z)) as usize
}

/// One of the directions, which lie evenly all round (a spiral by the golden angle).
fn direction(n: u32) -> Vec3 {
    let up = 1.0 - (2 * n + 1) as f32 / DIRECTIONS as f32;
    crate::camera::direction(137.507_76 * n as f32, up.asin().to_degrees())
}

#[cfg(test)]
mod tests;
