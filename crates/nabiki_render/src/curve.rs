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
const WIDEST: f32 = 32.0;
/// Largest height of a piece's arc over its chord (pixels).
const ROUNDEST: f32 = 0.2;
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

/// Decides into how many pieces each segment is cut (`cuts[i]` for the segment that ends at point i) and returns the
/// number of nodes. Segments without length vanish: 0 pieces.
fn count_cuts(points: &[Vec3], smooth: bool, view: &View, cuts: &mut [u8]) -> usize {
    if points.is_empty() {
        return 0;
    }
    let mut nodes = 1;
    let mut before = Vec3::ZERO;
    cuts[0] = 0;
    for i in 1..points.len() {
        let along = points[i] - points[i - 1];
        let length = along.length();
        if length < 1e-7 {
            cuts[i] = 0;
            continue;
        }
        let unit = along / length;
        let mut turn = 0.0_f32;
        if smooth {
            let turned = |other: Vec3| (1.0 - unit.dot(other)).max(0.0) * 2.0;
            if before != Vec3::ZERO {
                turn = turned(before);
            }
            if let Some(next) = points.get(i + 1).and_then(|n| (*n - points[i]).try_normalize()) {
                turn = turn.max(turned(next));
            }
            turn = turn.sqrt();
        }
        let depth = (0.5 * (points[i] + points[i - 1]) - view.eye).dot(view.forward).max(NEAR);
        let across = (length * length - along.dot(view.forward).powi(2)).max(0.0).sqrt();
        let pixels = across * view.pixels_per_cm(depth);
        // An arc of length l and turn t stands l t / 8 over its chord; both shrink with the number of pieces.
        let round = (pixels * turn / (8.0 * ROUNDEST)).sqrt();
        let wanted = (length / LONGEST).max(turn / SHARPEST).max(pixels / WIDEST).max(round);
        cuts[i] = wanted.ceil().clamp(1.0, MOST_CUTS) as u8;
        nodes += cuts[i] as usize;
        before = unit;
    }
    nodes
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
    let length: f32 = points.windows(2).map(|p| p[0].distance(p[1])).sum();
    let per_length = if length > 0.0 { 1.0 / length } else { 0.0 };
    let next_cut = |from: usize| (from..points.len()).find(|&i| cuts[i] > 0);
    // Slope of the curve at a point between two segments: that of the parabola through the three points.
    let slope = |before: Vec3, after: Vec3| {
        let (a, b) = (before.length(), after.length());
        (before * (b / a) + after * (a / b)) / (a + b)
    };
    let first = next_cut(1);
    let straight = |i: usize| points[i] - points[i - 1];
    let root_tangent = first.map_or(Vec3::Y, |i| straight(i).normalize());
    nodes[0] = CurveNode { position: points[0], along: 0.0, tangent: root_tangent, strand };
    if !moved.is_empty() {
        velocities[0] = moved[0];
    }
    let Some(mut i) = first else { return 1 };
    let mut at = 1;
    let mut along = 0.0;
    let mut from_slope = root_tangent;
    if smooth && let Some(after) = next_cut(i + 1) {
        // At the root the parabola goes on: its end slope mirrors the one at the next point.
        let chord = straight(i) / straight(i).length();
        from_slope = (2.0 * chord - slope(straight(i), straight(after))).normalize_or(chord);
    }
    nodes[0].tangent = from_slope.normalize_or(root_tangent);
    loop {
        let after = next_cut(i + 1);
        let d = straight(i);
        let step = d.length();
        let chord = d / step;
        let to_slope = match after {
            _ if !smooth => chord,
            Some(after) => slope(d, straight(after)),
            None => 2.0 * chord - from_slope,
        };
        let pieces = cuts[i] as usize;
        for piece in 1..=pieces {
            let t = piece as f32 / pieces as f32;
            let (position, tangent) = if smooth {
                let (u, v) = (1.0 - t, t);
                // Hermite: the chord, plus what the two slopes deviate from it.
                let (a, b) = ((from_slope - chord) * step, (to_slope - chord) * step);
                let position = points[i - 1] + d * t + a * (u * u * v) - b * (u * v * v);
                let tangent = d + a * (u * (u - 2.0 * v)) - b * (v * (2.0 * u - v));
                (if piece == pieces { points[i] } else { position }, tangent.normalize_or(chord))
            } else {
                (points[i - 1] + d * t, chord)
            };
            nodes[at] = CurveNode { position, along: (along + step * t) * per_length, tangent, strand };
            if !moved.is_empty() {
                velocities[at] = moved[i - 1].lerp(moved[i], t);
            }
            at += 1;
        }
        along += step;
        from_slope = to_slope;
        match after {
            Some(after) => i = after,
            None => return at,
        }
    }
}
