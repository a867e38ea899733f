//! Head and bodies in the way of a lamp: the outline and depth of each as the lamp sees it.
//!
//! Hair reads a map that is blurred once, as the lamp is wide. Skin reads the sharp one, at places around its own, so that what
//! lies in its own tangent plane never hides it.

mod map;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use glam::Vec3;
use nabiki::Mesh;

use self::map::{Blocks, Blur, Draw};
use super::approx::smooth;
use super::lamps::Lamp;

/// Side of a cell (cm), unless the head is so large that this would make too many.
const CELL: f32 = 0.12;
const MOST_CELLS: f32 = 1500.0;
/// How far behind the head's surface (cm) its shadow begins, and over which depth it sets in.
const SOFT: f32 = 0.45;
/// Least blur (cm).
const BLUR: f32 = 0.4;
/// Places around a place on the skin, of which each is asked whether it sees the lamp: a few, and where they do not agree, as many as
/// leave no gaps as wide as a cell between them, which would show as teeth along a shadow's edge.
const FEW: usize = 24;
const MANY: usize = 96;
/// By how much the few may differ and still count as one.
const AGREE: f32 = 0.03;
/// How far light spreads under skin (cm; red, green, blue), as the radius of a disc: the red of a shadow's edge.
const UNDER_SKIN: [f32; 3] = [0.6, 0.42, 0.34];
/// The part of a lamp that may be left to what counts as dark.
pub const LEFT_IN_THE_DARK: f32 = 1e-4;
/// Cosine of the angle to a lamp from which on the angle itself is the shadow, not what else of the solid is in the way.
const TERMINATOR: f32 = -0.1;
/// How far above the skin (cm) the light's way is looked at there.
const ABOVE: f32 = 0.9;
/// How far before the tangent plane (cm) what hides the lamp must lie, more where the plane is steep on the map, and over which
/// depth it sets in.
const BEFORE: f32 = 0.1;
const SETS_IN: f32 = 0.25;

/// What a lamp sees of all that is solid, each by itself: what lies between two is in the shadow of one alone.
pub struct SolidShadows {
    toward: Vec3,
    /// The head's first.
    solids: Vec<Arc<SolidShadow>>,
}

impl SolidShadows {
    /// Draws the head and the bodies (head space, cm) as the lamp sees them.
    pub fn new(lamp: &Lamp, head: &Mesh, bodies: &[Mesh]) -> Self {
        Self::about(lamp, Arc::new(SolidShadow::new(lamp, head)), bodies)
    }

    /// The same lamp's of the same head, where the bodies are elsewhere.
    pub fn with_bodies(&self, lamp: &Lamp, bodies: &[Mesh]) -> Self {
        Self::about(lamp, self.solids[0].clone(), bodies)
    }

    fn about(lamp: &Lamp, head: Arc<SolidShadow>, bodies: &[Mesh]) -> Self {
        let of_bodies = bodies.iter().map(|body| Arc::new(SolidShadow::new(lamp, body)));
        Self { toward: lamp.toward, solids: std::iter::once(head).chain(of_bodies).collect() }
    }

    /// Part of the lamp (red, green, blue) that is left to a place on the skin of solid number `own`, with this unit normal, 0..1.
    /// Where it turns away from the lamp, what hides it is its own angle, and all that hides what lies above it.
    pub fn visible_from_skin(&self, own: u16, p: Vec3, normal: Vec3) -> [f32; 3] {
        let facing = normal.dot(self.toward);
        let sure = smooth((facing - TERMINATOR) / 0.3);
        let mut left = [1.0; 3];
        for (i, solid) in self.solids.iter().enumerate() {
            if i != usize::from(own) && -p.dot(self.toward) <= solid.nearest {
                continue;
            }
            let part = if i != usize::from(own) {
                // No skin of its own can be in the way: a plane across the light will do.
                solid.visible_from_skin(p, self.toward)
            } else if sure >= 1.0 {
                solid.visible_from_skin(p, normal)
            } else {
                // Past skin that curves away from it, and still in the shadow of what lies farther off.
                let above = solid.visible_from_skin(p + ABOVE * normal, self.toward);
                let here = if sure > 0.0 { solid.visible_from_skin(p, normal) } else { above };
                std::array::from_fn(|c| above[c] + sure * (here[c] - above[c]))
            };
            left = std::array::from_fn(|c| left[c] * part[c]);
        }
        left
    }

    /// Part of the lamp that is left to places (x, y and z of all of them), 0..1.
    #[inline(always)]
    pub fn visible<const N: usize>(&self, places: &[[f32; N]; 3]) -> [f32; N] {
        let mut left = [1.0; N];
        for solid in &self.solids {
            let part = solid.visible(places);
            for n in 0..N {
                left[n] *= part[n];
            }
        }
        left
    }

    /// Whether nothing of the lamp is left to a place, as [`visible`](Self::visible) has it, to [`LEFT_IN_THE_DARK`].
    #[inline(always)]
    pub fn is_dark(&self, p: Vec3) -> bool {
        self.solids.iter().any(|solid| solid.is_dark(p))
    }
}

/// What a lamp sees of the head or of a body.
struct SolidShadow {
    toward: Vec3,
    axes: [Vec3; 2],
    low: [f32; 2],
    cell: f32,
    size: [usize; 2],
    /// In each cell: the solid's distance (cm), infinite where there is none.
    distance: Vec<f32>,
    /// The least of them, and the least in each block of cells (as wide as `taps` reach) and in those beside it.
    nearest: f32,
    about: Blocks,
    /// Distance up to which it hides nothing (cm).
    clear: f32,
    /// The blurred map, in as fine cells as show in it: the part of its surroundings that the solid covers, and its mean
    /// distance there (cm).
    blurred: Vec<[f32; 2]>,
    blurred_cell: f32,
    blurred_size: [usize; 2],
    /// For each cell of the blurred map, between it and the next: the distance from which on all is dark (cm); infinite where it never is.
    dark_beyond: Vec<f32>,
    /// Where skin looks from, around a place.
    few: Spiral<FEW>,
    many: Spiral<MANY>,
}

impl SolidShadow {
    /// Draws a mesh (head space, cm) as the lamp sees it.
    fn new(lamp: &Lamp, solid: &Mesh) -> Self {
        let right = lamp.toward.any_orthonormal_vector();
        let axes = [right, lamp.toward.cross(right)];
        let seen: Vec<[f32; 3]> =
            solid.positions.iter().map(|p| [p.dot(axes[0]), p.dot(axes[1]), -p.dot(lamp.toward)]).collect();
        let blur = BLUR.max(2.5 * lamp.spread.tan());
        let limit = |i: usize, f: fn(f32, f32) -> f32, from: f32| seen.iter().map(|p| p[i]).fold(from, f);
        let low = [0, 1].map(|i| limit(i, f32::min, f32::INFINITY) - 2.0 * blur);
        let high = [0, 1].map(|i| limit(i, f32::max, f32::NEG_INFINITY) + 2.0 * blur);
        let extent = (high[0] - low[0]).max(high[1] - low[1]).max(0.0);
        let cell = CELL.max(extent / MOST_CELLS);
        let size = if seen.is_empty() { [0, 0] } else { [0, 1].map(|i| ((high[i] - low[i]) / cell) as usize + 2) };
        let mut distance = vec![f32::INFINITY; size[0] * size[1]];
        let on_map: Vec<[f32; 3]> =
            seen.iter().map(|p| [(p[0] - low[0]) / cell, (p[1] - low[1]) / cell, p[2]]).collect();
        pulp::Arch::new().dispatch(Draw {
            triangles: &solid.triangles,
            corners: &on_map,
            size,
            distance: &mut distance,
        });
        let nearest = distance.iter().copied().fold(f32::INFINITY, f32::min);
        // Covered part and distance times covered part: both can be averaged.
        let mut cells: Vec<[f32; 2]> =
            distance.iter().map(|&d| if d < f32::INFINITY { [1.0, d] } else { [0.0; 2] }).collect();
        let radius = (blur / cell).round() as usize;
        let mut before = cells.clone();
        for axis in [0, 1, 0, 1] {
            std::mem::swap(&mut cells, &mut before);
            pulp::Arch::new().dispatch(Blur { cells: &before, size, axis, radius, out: &mut cells });
        }
        // Half of the blur's radius apart, what is kept holds all that is to be seen of it.
        let step = radius.div_ceil(2).max(1);
        let kept = (0..size[1]).step_by(step).flat_map(|y| (0..size[0]).step_by(step).map(move |x| y * size[0] + x));
        let blurred: Vec<[f32; 2]> = kept.map(|i| [cells[i][0], cells[i][1] / cells[i][0].max(1e-6)]).collect();
        let (blurred_cell, blurred_size) = (cell * step as f32, size.map(|s| s.div_ceil(step)));
        let penumbra = 2.5 * lamp.spread.tan();
        let clear = blurred.iter().filter(|c| c[0] > 0.0).map(|c| c[1]).fold(f32::INFINITY, f32::min) + SOFT;
        let (few, many) = (Spiral::new(penumbra), Spiral::new(penumbra));
        let about = Blocks::new(&distance, size, (many.reach / cell) as usize + 2);
        let width = blurred_size[0];
        let dark_beyond = (0..blurred.len())
            .map(|i| {
                let corners = [i, i + 1, i + width, i + width + 1].map(|i| blurred.get(i).copied().unwrap_or_default());
                let beyond = |[covered, distance]: [f32; 2]| {
                    if covered > 1.0 - LEFT_IN_THE_DARK { distance + 2.0 * SOFT } else { f32::INFINITY }
                };
                corners.map(beyond).into_iter().fold(f32::NEG_INFINITY, f32::max)
            })
            .collect();
        Self {
            toward: lamp.toward,
            axes,
            low,
            cell,
            size,
            distance,
            nearest,
            about,
            clear,
            blurred,
            blurred_cell,
            blurred_size,
            dark_beyond,
            few,
            many,
        }
    }

    /// Part of the lamp (red, green, blue) that it leaves to a place on its own skin, or another's, with this unit normal, 0..1. Light that
    /// enters beside the place and reaches it under the skin counts, red from farthest.
    fn visible_from_skin(&self, p: Vec3, normal: Vec3) -> [f32; 3] {
        if self.distance.is_empty() {
            return [1.0; 3];
        }
        let facing = normal.dot(self.toward).max(0.12);
        // Growth of the tangent plane's distance from the lamp.
        let slope = self.axes.map(|a| normal.dot(a) / facing);
        let at = self.axes.map(|a| p.dot(a));
        let steps = self.cell * (slope[0].abs() + slope[1].abs());
        let distance = -p.dot(self.toward) - BEFORE - 0.7 * steps;
        let [x, y] = [0, 1].map(|i| (at[i] - self.low[i]) / self.cell);
        if distance + self.many.reach * slope[0].hypot(slope[1]) <= self.about.least(x, y) {
            return [1.0; 3];
        }
        let arch = pulp::Arch::new();
        let few = arch.dispatch(Taps { shadow: self, taps: &self.few, at, distance, slope });
        let (low, high) = few.iter().fold((1.0_f32, 0.0_f32), |(low, high), &open| (low.min(open), high.max(open)));
        if high - low <= AGREE {
            return self.few.mean(&few);
        }
        self.many.mean(&arch.dispatch(Taps { shadow: self, taps: &self.many, at, distance, slope }))
    }

    /// Whether it leaves nothing of the lamp to a place.
    #[inline(always)]
    fn is_dark(&self, p: Vec3) -> bool {
        let distance = -p.dot(self.toward);
        if distance <= self.clear {
            return false;
        }
        let [x, y] = [0, 1].map(|i| (p.dot(self.axes[i]) - self.low[i]) / self.blurred_cell);
        let [width, height] = self.blurred_size;
        x >= 0.0
            && y >= 0.0
            && x < width as f32
            && y < height as f32
            && distance >= self.dark_beyond[y as usize * width + x as usize]
    }

    /// Part of the lamp that it leaves visible from places (x, y and z of all of them), 0..1.
    #[inline(always)]
    fn visible<const N: usize>(&self, [px, py, pz]: &[[f32; N]; 3]) -> [f32; N] {
        let [width, height] = self.blurred_size;
        let per_cell = 1.0 / self.blurred_cell;
        let (most_x, most_y) = (width as f32 - 1.0, height as f32 - 1.0);
        let mut distance = [0.0_f32; N];
        let (mut x, mut y) = ([0.0_f32; N], [0.0_f32; N]);
        let (mut column, mut row) = ([0_i32; N], [0_i32; N]);
        let mut beside = [false; N];
        let (mut any_far, mut any_within) = (false, false);
        for n in 0..N {
            distance[n] = -(px[n] * self.toward.x + py[n] * self.toward.y + pz[n] * self.toward.z);
            let [across, down] = self.axes;
            x[n] = (px[n] * across.x + py[n] * across.y + pz[n] * across.z - self.low[0]) * per_cell;
            y[n] = (px[n] * down.x + py[n] * down.y + pz[n] * down.z - self.low[1]) * per_cell;
            let within = x[n] >= 0.0 && y[n] >= 0.0 && x[n] < most_x && y[n] < most_y;
            x[n] = if within { x[n] } else { 0.0 };
            y[n] = if within { y[n] } else { 0.0 };
            (column[n], row[n]) = (x[n] as i32, y[n] as i32);
            beside[n] = !within;
            any_far |= distance[n] > self.clear;
            any_within |= within;
        }
        if !any_far || !any_within {
            return [1.0; N];
        }
        // All that is read first, so that the waits for memory go on side by side.
        let mut corners = [[[0.0; N]; 2]; 4];
        for n in 0..N {
            let at = row[n] as usize * width + column[n] as usize;
            let (upper, lower) = (&self.blurred[at..at + 2], &self.blurred[at + width..at + width + 2]);
            for (corner, cell) in corners.iter_mut().zip([upper[0], upper[1], lower[0], lower[1]]) {
                corner[0][n] = cell[0];
                corner[1][n] = cell[1];
            }
        }
        let mut visible = [1.0; N];
        for n in 0..N {
            let mut hidden = [0.0_f32; 4];
            for (hidden, corner) in hidden.iter_mut().zip(&corners) {
                *hidden = corner[0][n] * ((distance[n] - corner[1][n]) * (1.0 / SOFT) - 1.0).clamp(0.0, 1.0);
            }
            let (u, v) = (x[n] - column[n] as f32, y[n] - row[n] as f32);
            let upper = hidden[0] * (1.0 - u) + hidden[1] * u;
            let lower = hidden[2] * (1.0 - u) + hidden[3] * u;
            let open = 1.0 - (upper + (lower - upper) * v);
            visible[n] = if beside[n] { 1.0 } else { open };
        }
        visible
    }
}

/// What is left of the lamp to each of the places about one, compiled for each width of vectors that machines have; one is chosen at run time.
struct Taps<'a, const N: usize> {
    shadow: &'a SolidShadow,
    taps: &'a Spiral<N>,
    /// Where on the map (cm).
    at: [f32; 2],
    /// The distance there, and its growth along both axes.
    distance: f32,
    slope: [f32; 2],
}

impl<const N: usize> pulp::NullaryFnOnce for Taps<'_, N> {
    type Output = [f32; N];

    #[inline(always)]
    fn call(self) -> [f32; N] {
        let Self { shadow, taps, at, distance, slope } = self;
        let [width, height] = shadow.size;
        let mut first = [0_i32; N];
        let (mut u, mut v) = ([0.0_f32; N], [0.0_f32; N]);
        let mut plane = [0.0_f32; N];
        for n in 0..N {
            let offset = [taps.right[n], taps.up[n]];
            let x = (at[0] + offset[0] - shadow.low[0]) / shadow.cell;
            let y = (at[1] + offset[1] - shadow.low[1]) / shadow.cell;
            let within = (x >= 0.0) & (y >= 0.0) & (x + 1.0 < width as f32) & (y + 1.0 < height as f32);
            let (x, y) = if within { (x, y) } else { (0.0, 0.0) };
            let (column, row) = (x as i32, y as i32);
            first[n] = row * width as i32 + column;
            (u[n], v[n]) = (x - column as f32, y - row as f32);
            let there = distance + slope[0] * offset[0] + slope[1] * offset[1];
            plane[n] = if within { there } else { f32::NEG_INFINITY };
        }
        // All that is read first, so that the waits for memory go on side by side.
        let mut corners = [[0.0_f32; N]; 4];
        for n in 0..N {
            let first = first[n] as usize;
            let (upper, lower) =
                (&shadow.distance[first..first + 2], &shadow.distance[first + width..first + width + 2]);
            (corners[0][n], corners[1][n], corners[2][n], corners[3][n]) = (upper[0], upper[1], lower[0], lower[1]);
        }
        let mut open = [0.0_f32; N];
        for n in 0..N {
            let hidden = [0, 1, 2, 3].map(|i| ((plane[n] - corners[i][n]) / SETS_IN).clamp(0.0, 1.0));
            let upper = hidden[0] * (1.0 - u[n]) + hidden[1] * u[n];
            let lower = hidden[2] * (1.0 - u[n]) + hidden[3] * u[n];
            open[n] = 1.0 - (upper + (lower - upper) * v[n]);
        }
        open
    }
}

/// A spiral of places over a disc, and what each gives to red, green and blue: the disc's outer part only to those that spread far under
/// skin, or as far as the lamp's own blur.
struct Spiral<const N: usize> {
    right: [f32; N],
    up: [f32; N],
    shares: [[f32; N]; 3],
    /// How far out they lie (cm).
    reach: f32,
}

impl<const N: usize> Spiral<N> {
    /// For a lamp that blurs its shadows so far (cm).
    fn new(penumbra: f32) -> Self {
        let reach = UNDER_SKIN.map(|u| u.hypot(penumbra));
        let widest = reach.into_iter().fold(0.0, f32::max);
        let radius = |i: usize| widest * ((i as f32 + 0.5) / N as f32).sqrt();
        // The golden angle spreads them evenly.
        let angle = |i: usize| 2.399_963 * i as f32;
        let shares = reach.map(|reach| {
            let share = |i: usize| (-2.0 * (radius(i) / reach).powi(2)).exp();
            let sum: f32 = (0..N).map(share).sum();
            std::array::from_fn(|i| share(i) / sum)
        });
        Self {
            right: std::array::from_fn(|i| radius(i) * angle(i).cos()),
            up: std::array::from_fn(|i| radius(i) * angle(i).sin()),
            shares,
            reach: widest,
        }
    }

    /// What is left of red, green and blue, of what is left to each place.
    fn mean(&self, open: &[f32; N]) -> [f32; 3] {
        self.shares.map(|shares| shares.iter().zip(open).map(|(share, open)| share * open).sum())
    }
}
