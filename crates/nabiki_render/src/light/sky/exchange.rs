//! Light that skin sends to other skin: from the neck to the jaw, from a cheek to the side of the nose, between face and hand.
//!
//! A cell of skin looks along many directions for the skin that it sees there. That sends light as an even white surface would, and hair
//! between the two takes its part. Fourteen directions would do for what is as rough as hair; on skin each of them draws an edge.

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
    /// What skin of the head sees of the head, once it has looked: a part of `seen`.
    looks: Vec<Option<[u32; 2]>>,
    seen: Vec<Seen>,
    /// Skin of the bodies, which move: pairs of skin that see each other.
    pairs: Vec<Pair>,
    /// The light that falls onto each skin, as far as it is known, and what of it arrives at each that is asked about, with its normal.
    lit: Vec<f32>,
    light: Vec<(Vec3, f32)>,
}

/// Whether skin is near, and whether it is the head's.
#[derive(Clone, Copy, Default)]
struct Near {
    any: bool,
    head: bool,
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
        }
        self.forget_asked();
        self.cell = cell;
        self.cells.clear();
        self.cells.extend_from_slice(cells);
        let of_head = || cells[..head].iter().map(|skin| skin.cell);
        self.low = of_head().reduce(IVec3::min).unwrap_or_default() - BESIDE;
        let high = of_head().reduce(IVec3::max).unwrap_or_default() + BESIDE;
        self.size = (high - self.low + 1).as_uvec3();
        self.at.clear();
        self.at.resize(self.size.as_usizevec3().element_product(), NOBODY);
        self.blocks = self.size / BLOCK + 1;
        self.near.clear();
        self.near.resize(self.blocks.as_usizevec3().element_product(), Near::default());
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
                    *near = Near { any: true, head: near.head || i < head };
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
        let found: Vec<Vec<Seen>> = new.par_iter().with_min_len(64).map(look).collect();
        let bodies: Vec<usize> = (head..all).collect();
        let found_by_bodies: Vec<Vec<Seen>> = bodies.par_iter().with_min_len(16).map(look).collect();
        for (i, seen) in new.into_iter().zip(found) {
            let first = self.seen.len() as u32;
            self.seen.extend(seen);
            self.looks[i] = Some([first, self.seen.len() as u32]);
        }
        self.pairs.clear();
        for (i, seen) in bodies.into_iter().zip(found_by_bodies) {
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

    /// What skin `i` sees: skin of the head only that of the head.
    fn look(&self, i: usize, directions: &[Vec3]) -> Vec<Seen> {
        let mut seen: Vec<Seen> = Vec::new();
        let mut all = 0.0;
        for &direction in directions {
            let facing = direction.dot(self.cells[i].normal);
            if facing <= 0.0 {
                continue;
            }
            all += facing;
            if let Some(skin) = self.first_along(i, direction) {
                match seen.iter_mut().find(|seen| seen.skin == skin) {
                    Some(seen) => seen.share += facing,
                    None => seen.push(Seen { skin, share: facing }),
                }
            }
        }
        seen.iter_mut().for_each(|seen| seen.share /= all);
        seen
    }

    /// The skin that faces skin `i` first along a direction.
    fn first_along(&self, i: usize, direction: Vec3) -> Option<u32> {
        let of_head = i < self.looks.len();
        let (size, last) = (self.size.as_vec3(), if of_head { self.looks.len() } else { self.cells.len() });
        let mut place = self.among(self.cells[i].place);
        while place.cmpge(Vec3::ZERO).all() && place.cmplt(size).all() {
            let cell = place.as_uvec3();
            let skin = self.at[index(cell, self.size)];
            if (skin as usize) < last && skin != i as u32 && self.cells[skin as usize].normal.dot(direction) < -FACING {
                return Some(skin);
            }
            let near = self.near[index(cell / BLOCK, self.blocks)];
            let is_near = if of_head { near.head } else { near.any };
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
        let arriving = |i: usize| (this.cells[i].normal, arriving(i));
        (0..this.cells.len()).into_par_iter().with_min_len(256).map(arriving).collect_into_vec(&mut light);
        let between: Vec<f32> =
            this.pairs.par_iter().with_min_len(1024).map(|pair| sent(pair.skin as usize, &pair.seen)).collect();
        for (pair, sent) in this.pairs.iter().zip(between) {
            light[pair.skin as usize].1 += sent;
        }
        self.light = light;
    }

    /// The light that falls onto each skin, as it was sent last.
    pub fn lit(&self) -> &[f32] {
        &self.lit
    }

    /// What arrives at a place on a surface with this unit normal: between the skin about it, of such as faces where it does.
    pub fn at(&self, place: Vec3, normal: Vec3) -> f32 {
        let (mut light, mut all) = (0.0, 1e-6);
        for (skin, near) in self.about(place).into_iter().flatten() {
            let (faces, arriving) = self.light[skin];
            let alike = faces.dot(normal).max(0.0);
            let weight = near * alike * alike;
            light += weight * arriving;
            all += weight;
        }
        light / all
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

fn index(cell: UVec3, size: UVec3) -> usize {
    (cell.x + size.x * (cell.y + size.y * cell.z)) as usize
}

/// One of the directions, which lie evenly all round (a spiral by the golden angle).
fn direction(n: u32) -> Vec3 {
    let up = 1.0 - (2 * n + 1) as f32 / DIRECTIONS as f32;
    crate::camera::direction(137.507_76 * n as f32, up.asin().to_degrees())
}

#[cfg(test)]
mod tests {
    use nabiki::Mesh;

    use super::super::skin_cells::skin_cells;
    use super::super::tests::square;
    use super::*;

    const CELL: f32 = 0.5;

    fn ball(radius: f32) -> Mesh {
        let (rings, around) = (24_u32, 48_u32);
        let at = |i: u32, j: u32| {
            radius * crate::camera::direction(j as f32 * 360.0 / around as f32, i as f32 * 180.0 / rings as f32 - 90.0)
        };
        let positions = (0..=rings).flat_map(|i| (0..around).map(move |j| at(i, j))).collect();
        let v = |i: u32, j: u32| i * around + j % around;
        let squares = (0..rings).flat_map(|i| (0..around).map(move |j| (i, j)));
        let triangles = squares
            .flat_map(|(i, j)| [[v(i, j), v(i + 1, j), v(i, j + 1)], [v(i, j + 1), v(i + 1, j), v(i + 1, j + 1)]])
            .collect();
        outward(Mesh { positions, triangles, corner_uvs: None })
    }

    /// The same mesh, with its front where it faces away from the origin.
    fn outward(mut mesh: Mesh) -> Mesh {
        for t in &mut mesh.triangles {
            let [a, b, c] = t.map(|v| mesh.positions[v as usize]);
            if (b - a).cross(c - a).dot(a + b + c) < 0.0 {
                t.swap(1, 2);
            }
        }
        mesh
    }

    fn inside_out(mut mesh: Mesh) -> Mesh {
        mesh.triangles.iter_mut().for_each(|t| t.swap(1, 2));
        mesh
    }

    /// A level square of this half side at a height, that faces up or down.
    fn level(half: f32, height: f32, faces: f32) -> Mesh {
        square(height * Vec3::Y, half * Vec3::Z, faces * half * Vec3::X)
    }

    fn asked_about(cells: &[SkinCell]) -> Exchange {
        let mut exchange = Exchange::default();
        exchange.lay_out(cells, CELL);
        exchange.ask(cells.par_iter().map(|skin| skin.place));
        exchange
    }

    /// What arrives at each skin where the light that falls onto it is given.
    fn arriving(cells: &[SkinCell], lit: impl Fn(&SkinCell) -> f32) -> Vec<f32> {
        let mut exchange = asked_about(cells);
        exchange.send((0..).zip(cells.iter().map(lit)), |_, _| 1.0);
        exchange.light.into_iter().map(|(_, light)| light).collect()
    }

    fn mean(values: impl Iterator<Item = f32>) -> f32 {
        let (sum, count) = values.fold((0.0, 0.0), |(sum, count), v| (sum + v, count + 1.0));
        sum / count
    }

    #[test]
    fn a_ball_sees_nothing_of_itself() {
        let found = arriving(&skin_cells(&ball(5.0), CELL, 0), |_| 1.0);
        assert!(found.iter().all(|&light| light == 0.0));
    }

    /// In a hollow ball whose walls are lit evenly all light comes from walls: as much as is on them. A look may slip through between cells
    /// that it grazes, where the wall counts as seen from too much aside.
    #[test]
    fn in_a_hollow_ball_as_much_arrives_as_is_sent() {
        let found = arriving(&skin_cells(&inside_out(ball(5.0)), CELL, 0), |_| 1.0);
        assert!(found.iter().all(|&light| light <= 1.0 + 1e-5));
        let mean = mean(found.into_iter());
        // Looks with a cosine under FACING at the wall make up FACING^2 of all.
        assert!((1.0 - mean) < 2.0 * FACING * FACING, "{mean}");
    }

    /// Under a large lit square a small one gets of its light what the view factor says, whether both are the head's, or one is a body's.
    #[test]
    fn a_square_lights_another_by_its_view_factor() {
        let (half, height) = (6.0_f32, 4.0_f32);
        let view_factor = |height: f32| {
            let x = half / height;
            let root = (1.0 + x * x).sqrt();
            4.0 / std::f32::consts::TAU * 2.0 * x / root * (x / root).atan()
        };
        // The large one is as thick as a cell, and a small one looks in some 80 directions.
        let ray = 2.0 / DIRECTIONS as f32;
        let expected = view_factor(height) - ray..view_factor(height - CELL) + ray;
        for (below, above) in [(0, 0), (0, 1), (1, 0)] {
            let mut cells = skin_cells(&level(1.5, -2.1, 1.0), CELL, below);
            cells.extend(skin_cells(&level(half, -2.1 + height, -1.0), CELL, above));
            cells.sort_by_key(|skin| skin.solid);
            let found = arriving(&cells, |skin| if skin.normal.y < 0.0 { 1.0 } else { 0.0 });
            let of_middle = cells
                .iter()
                .zip(&found)
                .filter(|(skin, _)| skin.normal.y > 0.0 && skin.place.x.abs().max(skin.place.z.abs()) < 0.75);
            let found = mean(of_middle.map(|(_, &light)| light));
            assert!(expected.contains(&found), "{found} for {expected:?}, {below} {above}");
        }
    }

    #[test]
    fn what_arrives_does_not_depend_on_what_was_asked_before() {
        let cells = skin_cells(&inside_out(ball(3.0)), CELL, 0);
        let lit = |exchange: &mut Exchange| {
            exchange.send((0..).zip(cells.iter().map(|skin| 1.0 + skin.normal.y)), |a, b| 1.0 / (1.0 + a.distance(b)));
        };
        let mut whole = asked_about(&cells);
        lit(&mut whole);
        let mut later = Exchange::default();
        later.lay_out(&cells, CELL);
        for part in [&cells[..cells.len() / 3], &cells] {
            later.forget_asked();
            later.ask(part.par_iter().map(|skin| skin.place));
            lit(&mut later);
        }
        for skin in &cells {
            assert_eq!(later.at(skin.place, skin.normal), whole.at(skin.place, skin.normal));
        }
    }

    /// What a frame shows does not depend on where a body was in those before it, nor on whether they were drawn.
    #[test]
    fn what_arrives_does_not_depend_on_where_a_body_was() {
        // So large that looks go on in long steps through its middle.
        let head = skin_cells(&inside_out(ball(9.0)), CELL, 0);
        let with_body = |height: f32| {
            let mut cells = head.clone();
            cells.extend(skin_cells(&level(1.5, height, 1.0), CELL, 1));
            cells
        };
        let shown = |exchange: &mut Exchange, cells: &[SkinCell]| -> Vec<f32> {
            exchange.lay_out(cells, CELL);
            exchange.ask(cells.par_iter().map(|skin| skin.place));
            exchange.send((0..).zip(cells.iter().map(|skin| 1.0 + skin.normal.y)), |_, _| 1.0);
            cells.iter().map(|skin| exchange.at(skin.place, skin.normal)).collect()
        };
        let mut exchange = Exchange::default();
        for height in [-2.1, 1.3, 7.4, 40.0] {
            let cells = with_body(height);
            assert_eq!(shown(&mut exchange, &cells), shown(&mut Exchange::default(), &cells), "{height}");
        }
    }
}
