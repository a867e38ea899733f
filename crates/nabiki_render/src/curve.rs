//! Strands as curves: nodes close enough together to look smooth, to shade and to sort.

use glam::Vec3;
use nabiki::Strands;
use rayon::prelude::*;

use crate::RenderError;
use crate::camera::{NEAR, View};
use crate::settings::HairLook;

/// One node of a curve (head space, cm).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CurveNode {
    pub position: Vec3,
    /// Part of the strand's length from the root, 0..1.
    pub along: f32,
    /// Unit direction from root to tip.
    pub tangent: Vec3,
    pub strand: u32,
}

/// The nodes of all strands, strand after strand; neighbours of the same strand are joined.
#[derive(Default)]
pub struct Curves {
    pub nodes: Vec<CurveNode>,
    /// Movement of each node while the shutter is open (cm); empty without motion blur.
    pub velocities: Vec<Vec3>,
    cuts: Vec<u8>,
}

/// Longest piece (cm), turn (rad) and length on the picture (pixels) between neighbouring nodes.
const LONGEST: f32 = 1.25;
const SHARPEST: f32 = 0.3;
const WIDEST: f32 = 64.0;
/// Largest height of a piece's arc over its chord (pixels).
const ROUNDEST: f32 = 0.35;
/// Segments are joined where the points between stay this close to the chord (pixels), up to this length (cm).
const FLATTEST: f32 = 0.3;
const LONGEST_STRAIGHT: f32 = 2.1;
/// Length (pixels) times turn (rad) at the ends of joined segments, in units of `FLATTEST`: the curve stands a tenth of it
/// off the chord.
const BENT: f32 = 8.0;
/// Most pieces that one segment is cut into.
const MOST_CUTS: f32 = 64.0;

/// Whether a point can be drawn: finite, and near enough for single precision to mean something.
pub fn drawable(p: Vec3) -> bool {
    p.is_finite() && p.abs().max_element() <= 1e7
}

/// Strands handed to one task at a time.
const CHUNK: usize = 128;

impl Curves {
    /// Lays curves through the points of `strands`, which all must be finite. `moved` holds each point's movement
    /// while the shutter is open (cm), or nothing.
    pub fn build(
        &mut self,
        strands: &Strands,
        moved: &[Vec3],
        look: &HairLook,
        view: &View,
    ) -> Result<(), RenderError> {
        if let Some(bad) = strands.points().par_iter().position_first(|&p| !drawable(p)) {
            let strand = strands.starts().partition_point(|&s| s as usize <= bad) - 1;
            let point = bad - strands.range(strand).start;
            let p = strands.points()[bad];
            return Err(RenderError::Geometry(format!(
                "strand {strand}, point {point} lies at {p}: every coordinate must be a number within 1e7 cm"
            )));
        }
        self.cuts.resize(strands.points().len(), 0);
        let chunks = strands.len().div_ceil(CHUNK);
        let strands_of = |chunk: usize| chunk * CHUNK..((chunk + 1) * CHUNK).min(strands.len());
        let points_of = |chunk: usize| {
            let s = strands_of(chunk);
            strands.range(s.start).start..strands.range(s.end - 1).end
        };

        let mut cuts = split(&mut self.cuts, (0..chunks).map(|c| points_of(c).len()));
        let counts: Vec<usize> = cuts
            .par_iter_mut()
            .enumerate()
            .map(|(chunk, cuts)| {
                let first = points_of(chunk).start;
                strands_of(chunk)
                    .map(|s| {
                        let range = strands.range(s);
                        let cuts = &mut cuts[range.start - first..range.end - first];
                        count_cuts(strands.strand(s), look.smooth, view, cuts)
                    })
                    .sum()
            })
            .collect();

        let total = counts.iter().sum();
        self.nodes.resize(total, CurveNode::default());
        self.velocities.resize(if moved.is_empty() { 0 } else { total }, Vec3::ZERO);
        let nodes = split(&mut self.nodes, counts.iter().copied());
        let velocities = split(&mut self.velocities, counts.iter().map(|c| if moved.is_empty() { 0 } else { *c }));
        let cuts = &self.cuts;
        nodes.into_par_iter().zip(velocities).enumerate().for_each(|(chunk, (nodes, velocities))| {
            let mut at = 0;
            for s in strands_of(chunk) {
                let range = strands.range(s);
                let moved = if moved.is_empty() { &[][..] } else { &moved[range.clone()] };
                at += lay(s as u32, strands.strand(s), &cuts[range], moved, look.smooth, &mut nodes[at..], {
                    let from = at.min(velocities.len());
                    &mut velocities[from..]
                });
            }
        });
        Ok(())
    }
}

/// Lowest and highest corner of the box about all nodes (head space, cm): infinite, the lowest above the highest, without any.
pub fn bounds(nodes: &[CurveNode]) -> [Vec3; 2] {
    let none = [Vec3::INFINITY, Vec3::NEG_INFINITY];
    nodes
        .par_iter()
        .with_min_len(8192)
        .fold(|| none, |[low, high], n| [low.min(n.position), high.max(n.position)])
        .reduce(|| none, |a, b| [a[0].min(b[0]), a[1].max(b[1])])
}

/// Cuts a slice into consecutive parts of the given lengths.
fn split<T>(mut slice: &mut [T], lengths: impl Iterator<Item = usize>) -> Vec<&mut [T]> {
    lengths
        .map(|n| {
            let (head, rest) = std::mem::take(&mut slice).split_at_mut(n);
            slice = rest;
            head
        })
        .collect()
}

/// Joins segments into spans and decides into how many pieces each is cut: `cuts[i]` for the span that ends at point i, 0
/// where none ends, because the hair goes straight on or the segment has no length. Returns the number of nodes.
fn count_cuts(points: &[Vec3], smooth: bool, view: &View, cuts: &mut [u8]) -> usize {
    cuts.fill(0);
    let mut nodes = points.len().min(1);
    let mut before = Vec3::ZERO;
    let mut from = 0;
    while let Some(end) = span(points, from, before, smooth, view) {
        let along = points[end] - points[from];
        let length = along.length();
        let unit = along / length;
        let mut turn = 0.0_f32;
        if smooth {
            let turned = |other: Vec3| (1.0 - unit.dot(other)).max(0.0) * 2.0;
            if before != Vec3::ZERO {
                turn = turned(before);
            }
            if let Some(next) = points.get(end + 1).and_then(|n| (*n - points[end]).try_normalize()) {
                turn = turn.max(turned(next));
            }
            turn = turn.sqrt();
        }
        let pixels = on_picture(points[from], points[end], view);
        // An arc of length l and turn t stands l t / 8 over its chord; both shrink with the number of pieces.
        let round = (pixels * turn / (8.0 * ROUNDEST)).sqrt();
        let longest = if end == from + 1 { LONGEST } else { LONGEST_STRAIGHT };
        let wanted = (length / longest).max(turn / SHARPEST).max(pixels / WIDEST).max(round);
        cuts[end] = wanted.ceil().clamp(1.0, MOST_CUTS) as u8;
        nodes += cuts[end] as usize;
        before = unit;
        from = end;
    }
    nodes
}

/// Where the span that begins at a point, after one in direction `before` (unit, or zero), ends: at the end of the first
/// segment that has a length, or farther if what lies between stays close to the chord and its neighbours do not bend it.
fn span(points: &[Vec3], from: usize, before: Vec3, smooth: bool, view: &View) -> Option<usize> {
    let long = |i: &usize| points[*i].distance_squared(points[from]) >= 1e-14;
    let mut end = (from + 1..points.len()).find(long)?;
    if !smooth {
        return Some(end);
    }
    let per_cm = view.pixels_per_cm(depth(points[end], view));
    while let Some(&next) = points.get(end + 1) {
        let chord = next - points[from];
        let length = chord.length();
        let close = |p: Vec3| (p - points[from]).cross(chord).length() * per_cm <= FLATTEST * length;
        if length > LONGEST_STRAIGHT || length * per_cm > WIDEST || !points[from + 1..=end].iter().all(|&p| close(p)) {
            break;
        }
        let after = points.get(end + 2).map_or(Vec3::ZERO, |p| (*p - next).normalize_or_zero());
        if before.cross(chord).length().max(after.cross(chord).length()) * per_cm > BENT * FLATTEST {
            break;
        }
        // Hair that turns back on itself stays close to its chord as well.
        if (next - points[end]).dot(chord) <= 0.0 {
            break;
        }
        end += 1;
    }
    Some(end)
}

fn depth(p: Vec3, view: &View) -> f32 {
    (p - view.eye).dot(view.forward).max(NEAR)
}

/// Length on the picture (pixels).
fn on_picture(a: Vec3, b: Vec3, view: &View) -> f32 {
    let along = b - a;
    let across = (along.length_squared() - along.dot(view.forward).powi(2)).max(0.0).sqrt();
    across * view.pixels_per_cm(depth(0.5 * (a + b), view))
}

/// Lays the nodes of one strand and returns their number.
fn lay(
    strand: u32,
    points: &[Vec3],
    cuts: &[u8],
    moved: &[Vec3],
    smooth: bool,
    nodes: &mut [CurveNode],
    velocities: &mut [Vec3],
) -> usize {
    if points.is_empty() {
        return 0;
    }
    let next_end = |from: usize| (from + 1..points.len()).find(|&i| cuts[i] > 0);
    let length_between = |a: usize, b: usize| points[a..=b].windows(2).map(|p| p[0].distance(p[1])).sum::<f32>();
    let length = length_between(0, points.len() - 1);
    let per_length = if length > 0.0 { 1.0 / length } else { 0.0 };
    // Slope of the curve at a point between two spans: that of the parabola through the three points.
    let slope = |before: Vec3, after: Vec3| {
        let (a, b) = (before.length(), after.length());
        (before * (b / a) + after * (a / b)) / (a + b)
    };
    if !moved.is_empty() {
        velocities[0] = moved[0];
    }
    nodes[0] = CurveNode { position: points[0], along: 0.0, tangent: Vec3::Y, strand };
    let Some(mut end) = next_end(0) else { return 1 };
    let mut from = 0;
    let mut at = 1;
    let mut along = 0.0;
    let first = points[end] - points[0];
    let mut from_slope = first.normalize();
    if smooth && let Some(after) = next_end(end) {
        // At the root the parabola goes on: its end slope mirrors the one at the next point.
        from_slope = (2.0 * from_slope - slope(first, points[after] - points[end])).normalize_or(from_slope);
    }
    nodes[0].tangent = from_slope;
    loop {
        let after = next_end(end);
        let d = points[end] - points[from];
        let step = d.length();
        let chord = d / step;
        let to_slope = match after {
            _ if !smooth => chord,
            Some(after) => slope(d, points[after] - points[end]),
            None => 2.0 * chord - from_slope,
        };
        let arc = length_between(from, end);
        let pieces = cuts[end] as usize;
        for piece in 1..=pieces {
            let t = piece as f32 / pieces as f32;
            let (position, tangent) = if smooth {
                let (u, v) = (1.0 - t, t);
                // Hermite: the chord, plus what the two slopes deviate from it.
                let (a, b) = ((from_slope - chord) * step, (to_slope - chord) * step);
                let position = points[from] + d * t + a * (u * u * v) - b * (u * v * v);
                let tangent = d + a * (u * (u - 2.0 * v)) - b * (v * (2.0 * u - v));
                (if piece == pieces { points[end] } else { position }, tangent.normalize_or(chord))
            } else {
                (points[from] + d * t, chord)
            };
            nodes[at] = CurveNode { position, along: (along + arc * t) * per_length, tangent, strand };
            if !moved.is_empty() {
                velocities[at] = moved[from].lerp(moved[end], t);
            }
            at += 1;
        }
        along += arc;
        from_slope = to_slope;
        match after {
            Some(after) => (from, end) = (end, after),
            None => return at,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::Bounds;
    use crate::settings::Camera;
    use proptest::prelude::*;

    fn laid(points: &[Vec3], smooth: bool) -> (Vec<CurveNode>, View) {
        let mut strands = Strands::with_capacity(1, points.len());
        strands.push(points.iter().copied());
        let mut bounds = Bounds::default();
        bounds.include(Vec3::splat(-20.0));
        bounds.include(Vec3::splat(20.0));
        let view = View::new(&Camera::default(), [800, 800], &bounds);
        let mut curves = Curves::default();
        curves.build(&strands, &[], &HairLook { smooth, ..HairLook::default() }, &view).expect("finite");
        (curves.nodes, view)
    }

    /// Distance of a point from a polyline, both on the picture (pixels).
    fn distance(p: Vec3, nodes: &[CurveNode], view: &View) -> f32 {
        let at = |p: Vec3| view.project(p).truncate();
        nodes
            .windows(2)
            .map(|n| {
                let (a, b) = (at(n[0].position), at(n[1].position));
                let t = ((at(p) - a).dot(b - a) / (b - a).length_squared().max(1e-12)).clamp(0.0, 1.0);
                at(p).distance(a.lerp(b, t))
            })
            .fold(f32::INFINITY, f32::min)
    }

    #[test]
    fn straight_hair_needs_few_nodes() {
        let points: Vec<Vec3> = (0..=20).map(|i| Vec3::new(1.0, 10.0 - 0.5 * i as f32, 2.0)).collect();
        let (nodes, _) = laid(&points, true);
        // 10 cm in pieces of at most 2.1.
        assert!((6..=8).contains(&nodes.len()), "{}", nodes.len());
        let (nodes, _) = laid(&points, false);
        assert_eq!(nodes.len(), 21);
    }

    proptest! {
        #[test]
        fn every_point_of_a_strand_lies_on_its_curve(
            turns in prop::collection::vec((-0.4_f32..0.4, -0.4_f32..0.4), 2..24),
            length in 0.05_f32..1.5,
        ) {
            let mut points = vec![Vec3::new(0.0, 5.0, 0.0)];
            let mut heading = Vec3::NEG_Y;
            for (x, z) in turns {
                heading = (heading + Vec3::new(x, 0.0, z)).normalize();
                points.push(points[points.len() - 1] + heading * length);
            }
            let (nodes, view) = laid(&points, true);
            prop_assert_eq!(nodes[0].position, points[0]);
            prop_assert_eq!(nodes[nodes.len() - 1].position, points[points.len() - 1]);
            for p in &points {
                // A joined point may lie off the chord, the curve off it on the other side, and the pieces off the curve;
                // perspective changes the scale by less than a tenth over a span.
                let off = distance(*p, &nodes, &view);
                prop_assert!(off < 1.1 * (FLATTEST + 0.1 * BENT * FLATTEST + ROUNDEST), "{} pixels", off);
            }
            for n in nodes.windows(2) {
                prop_assert!(n[1].along > n[0].along && (n[0].tangent.length() - 1.0).abs() < 1e-5);
            }
            prop_assert!((nodes[nodes.len() - 1].along - 1.0).abs() < 1e-5);
        }
    }
}
