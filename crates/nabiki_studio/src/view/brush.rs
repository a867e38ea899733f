//! The brush: which strands it touches, and how much these then belong to a region.

use glam::{Vec2, Vec3};
use nabiki::Strands;
use nabiki::region::Region;
use nabiki_render::View;
use nabiki_render::camera::NEAR;

use super::pick::Skins;
use crate::tools::Stroke;

/// Painted points reach this many times as far as strands are apart, and fade over once that.
const REACH: f32 = 1.5;
/// Weights are evened out over the hair within this many times the distance of strands.
const EVENED: f32 = 2.2;
/// What is left of a weight that is too small to be seen is none.
const LEAST: f32 = 0.005;

/// How much each strand at hand belongs to a region.
#[derive(Clone, Debug, PartialEq)]
pub struct Weights {
    roots: Vec<Vec3>,
    of: Vec<f32>,
    /// How far strands are apart (cm).
    spacing: f32,
}

impl Weights {
    /// Those of the first `among` strands at rest in a region, by its place and what is painted. A region that has neither
    /// is not painted yet.
    pub fn new(strands: &Strands, among: usize, region: Option<&Region>) -> Self {
        let roots: Vec<Vec3> = strands.iter().take(among).map(|strand| strand[0]).collect();
        let region = region.filter(|region| region.near.is_some() || !region.painted.is_empty());
        let of = roots.iter().map(|&root| region.map_or(0.0, |region| region.weight(root) as f32)).collect();
        let spacing = spacing(&roots);
        Self { roots, of, spacing }
    }

    /// Whether they are of these strands.
    pub fn is_of(&self, strands: &Strands, among: usize) -> bool {
        self.roots.iter().eq(strands.iter().take(among).map(|strand| &strand[0]))
    }

    /// The weights.
    pub fn of(&self) -> &[f32] {
        &self.of
    }

    /// The weights after a stroke over those of before it. `covered`: how much of its strength the stroke gave each
    /// strand, 0..1.
    pub fn stroked(&self, stroke: Stroke, covered: &[f32]) -> Self {
        let of = self.of.iter().zip(covered).enumerate().map(|(s, (&weight, &covered))| match stroke {
            Stroke::Add | Stroke::Lasso => weight + covered * (1.0 - weight),
            Stroke::Erase => weight * (1.0 - covered),
            Stroke::Smooth if covered > 0.0 => weight + covered * (self.about(s) - weight),
            Stroke::Smooth => weight,
        });
        Self { of: of.collect(), ..self.clone() }
    }

    /// The mean weight of the hair about a strand.
    fn about(&self, strand: usize) -> f32 {
        let reach = EVENED * self.spacing;
        let near = self.roots.iter().zip(&self.of).filter(|(root, _)| root.distance(self.roots[strand]) <= reach);
        let (count, sum) = near.fold((0.0, 0.0), |(count, sum), (_, weight)| (count + 1.0, sum + weight));
        sum / count
    }

    /// The same on both sides of the head: each strand has what it was given, or what the one opposite was.
    pub fn mirrored(&self, covered: &[f32]) -> Vec<f32> {
        let reach = EVENED * self.spacing;
        let opposite = |root: &Vec3| {
            let there = Vec3::new(root.x, root.y, -root.z);
            let far = |a: &usize| self.roots[*a].distance(there);
            let near = (0..self.roots.len()).filter(|s| far(s) <= reach);
            near.min_by(|a, b| far(a).total_cmp(&far(b))).map_or(0.0, |s| covered[s])
        };
        self.roots.iter().zip(covered).map(|(root, &of)| of.max(opposite(root))).collect()
    }

    /// The region with these weights: its painted points, and in place of any other place.
    pub fn paint(&self, region: &mut Region) {
        let round = |x: f32, parts: f32| (x * parts).round() / parts;
        region.within = round((REACH * self.spacing).max(0.1), 10.0);
        region.soft = round(self.spacing.max(0.1), 10.0);
        let belongs = |s: &usize| self.of[*s] >= LEAST;
        let chosen: Vec<usize> = (0..self.of.len()).filter(belongs).collect();
        // With the hair about it that does not belong, which makes the border.
        let reach = region.within + region.soft;
        let counts = |s: &usize| chosen.iter().any(|&of| self.roots[of].distance(self.roots[*s]) <= reach);
        region.painted = (0..self.of.len())
            .filter(counts)
            .map(|s| {
                let [x, y, z] = self.roots[s].to_array().map(|x| round(x, 1000.0));
                [x, y, z, if belongs(&s) { round(self.of[s], 100.0).max(0.01) } else { 0.0 }]
            })
            .collect();
        (region.near, region.to) = (None, None);
    }
}

/// The median of how far each root is from the nearest other one (cm); a head's worth for one alone.
fn spacing(roots: &[Vec3]) -> f32 {
    const ALONE: f32 = 2.0;
    const MOST: usize = 300;
    let nearest = |i: usize| {
        let others = roots.iter().enumerate().filter(|&(j, _)| j != i);
        others.map(|(_, root)| root.distance_squared(roots[i])).fold(f32::INFINITY, f32::min).sqrt()
    };
    let step = roots.len().div_ceil(MOST).max(1);
    let mut apart: Vec<f32> = (0..roots.len()).step_by(step).map(nearest).filter(|far| far.is_finite()).collect();
    apart.sort_by(f32::total_cmp);
    apart.get(apart.len() / 2).copied().unwrap_or(ALONE)
}

/// The hair that a tool is used on: a frame of the first strands, as it is seen.
#[derive(Clone, Copy, Debug)]
pub struct Seen<'a> {
    /// In head space.
    pub view: &'a View,
    /// The points of the frame (head space, cm).
    pub points: &'a [Vec3],
    /// The strands.
    pub strands: &'a Strands,
    /// How many of them, from the first.
    pub among: usize,
    /// What hides hair.
    pub skins: &'a Skins<'a>,
}

impl Seen<'_> {
    /// How much a brush of this radius touches each strand on its way from one pixel to another: 1 in its middle, 0 at
    /// its edge and beyond, and on what is hidden.
    pub fn under(&self, [from, to]: [Vec2; 2], radius: f32) -> Vec<f32> {
        let before = self.skins.before(self.view, 0.5 * (from + to), radius + 0.5 * from.distance(to));
        let amount = |strand: usize| {
            let mut most = 0.0_f32;
            for pair in self.points[self.strands.range(strand)].windows(2) {
                let (a, b) = (self.view.project(pair[0]), self.view.project(pair[1]));
                if !(a.z >= NEAR && b.z >= NEAR) {
                    continue;
                }
                let (t, apart) = apart([a.truncate(), b.truncate()], [from, to]);
                let amount = fall(apart / radius);
                if amount > most && !self.skins.hide(self.view, &before, pair[0].lerp(pair[1], t)) {
                    most = amount;
                }
            }
            most
        };
        (0..self.strands.len().min(self.among)).map(amount).collect()
    }

    /// 1 for each strand of which half or more is seen within a closed line, 0 for the others.
    pub fn within(&self, line: &[Vec2]) -> Vec<f32> {
        let (low, high) = line.iter().fold((Vec2::INFINITY, Vec2::NEG_INFINITY), |(a, b), &p| (a.min(p), b.max(p)));
        if !low.cmple(high).all() {
            return vec![0.0; self.strands.len().min(self.among)];
        }
        let before = self.skins.before(self.view, 0.5 * (low + high), 0.5 * low.distance(high));
        let chosen = |strand: usize| {
            let of = &self.points[self.strands.range(strand)][1..];
            let inside: Vec<Vec3> = of.iter().copied().filter(|&place| self.is_within(line, place)).collect();
            // That of the middle is seen is enough: a strand is not hidden piece by piece.
            let is_seen = |place: &Vec3| !self.skins.hide(self.view, &before, *place);
            2 * inside.len() >= of.len() && inside.get(inside.len() / 2).is_some_and(is_seen)
        };
        (0..self.strands.len().min(self.among)).map(|strand| if chosen(strand) { 1.0 } else { 0.0 }).collect()
    }

    fn is_within(&self, line: &[Vec2], place: Vec3) -> bool {
        let seen = self.view.project(place);
        seen.z >= NEAR && encloses(line, seen.truncate())
    }
}

/// How much a brush does at a part of its radius.
pub fn fall(part: f32) -> f32 {
    (1.0 - part * part).max(0.0).powi(2)
}

/// Where along the first line it is nearest to the second, and how far they are apart there.
fn apart([a, b]: [Vec2; 2], [from, to]: [Vec2; 2]) -> (f32, f32) {
    let along = |[a, b]: [Vec2; 2], p: Vec2| ((p - a).dot(b - a) / (b - a).length_squared().max(1e-9)).clamp(0.0, 1.0);
    let of_first = |t: f32| {
        let p = a + (b - a) * t;
        (t, p.distance(from + (to - from) * along([from, to], p)))
    };
    // Lines that do not cross are nearest at an end of one of them.
    let cross = (b - a).perp_dot(to - from);
    let crossing = if cross.abs() > 1e-9 { (from - a).perp_dot(to - from) / cross } else { 0.0 };
    let ends = [0.0, 1.0, along([a, b], from), along([a, b], to), crossing.clamp(0.0, 1.0)];
    ends.into_iter().map(of_first).min_by(|x, y| x.1.total_cmp(&y.1)).unwrap_or((0.0, f32::INFINITY))
}

/// Whether a closed line goes around a point: whether a ray from it crosses the line an odd number of times.
fn encloses(line: &[Vec2], p: Vec2) -> bool {
    let next = line.iter().cycle().skip(1);
    let crosses =
        |(a, b): &(&Vec2, &Vec2)| (a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y);
    line.iter().zip(next).filter(crosses).count() % 2 == 1
}

#[cfg(test)]
#[path = "brush_tests.rs"]
mod tests;
