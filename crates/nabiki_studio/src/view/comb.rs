//! The comb: hair taken by its nodes and laid anew, each strand as long as it was.

use glam::{Quat, Vec2, Vec3};
use nabiki_render::camera::NEAR;

use super::brush::{Seen, fall};
use super::pick::Skins;

/// What the comb touches less than this it leaves alone.
const LEAST: f32 = 0.02;
/// Combed hair stays this far out of skin (cm).
const CLEAR_CM: f32 = 0.05;
/// Steps by which a strand reaches for where it is combed to; nearer than this it has arrived (cm).
const REACHES: usize = 24;
const ARRIVED_CM: f32 = 1e-3;

/// A strand that the comb holds by a node.
#[derive(Clone, Debug, PartialEq)]
struct Grab {
    strand: usize,
    node: usize,
    /// How far it goes along, 0..1.
    amount: f32,
    /// The strand as it was taken hold of.
    from: Vec<Vec3>,
}

/// Hair in a comb.
#[derive(Clone, Debug, PartialEq)]
pub struct Comb {
    grabs: Vec<Grab>,
    /// The strand that is held most firmly: the hand is at its node.
    pub hand: Vec3,
}

impl Comb {
    /// Takes hold of what is seen within a radius of a pixel; none if that is nothing.
    pub fn take(seen: &Seen<'_>, pixel: Vec2, radius: f32) -> Option<Self> {
        let before = seen.skins.before(seen.view, pixel, radius);
        let mut grabs = Vec::new();
        for strand in 0..seen.strands.len().min(seen.among) {
            let of = &seen.points[seen.strands.range(strand)];
            let mut best: Option<(usize, f32)> = None;
            // The root stays where it grows.
            for (node, &place) in of.iter().enumerate().skip(1) {
                let at = seen.view.project(place);
                let amount = if at.z >= NEAR { fall(at.truncate().distance(pixel) / radius) } else { 0.0 };
                let least = best.map_or(LEAST, |of| of.1);
                if amount > least && !seen.skins.hide(seen.view, &before, place) {
                    best = Some((node, amount));
                }
            }
            grabs.extend(best.map(|(node, amount)| Grab { strand, node, amount, from: of.to_vec() }));
        }
        let firmest = grabs.iter().max_by(|a, b| a.amount.total_cmp(&b.amount))?;
        let hand = firmest.from[firmest.node];
        Some(Self { grabs, hand })
    }

    /// The strands, each as it lies once the hand has gone this far (head space, cm).
    pub fn combed(&self, way: Vec3, skins: &Skins<'_>) -> Vec<(usize, Vec<Vec3>)> {
        let lay = |grab: &Grab| {
            let mut strand = reach(&grab.from, grab.node, grab.from[grab.node] + grab.amount * way);
            keep_out(&mut strand, &grab.from, skins);
            (grab.strand, strand)
        };
        self.grabs.iter().map(lay).collect()
    }
}

/// The strand with a node as near to a place as its length lets it, and what is beyond the node turned along: the ends
/// pull the chain by turns (Aristidou and Lasenby's FABRIK).
fn reach(strand: &[Vec3], node: usize, place: Vec3) -> Vec<Vec3> {
    let lengths: Vec<f32> = strand.windows(2).map(|ends| ends[0].distance(ends[1])).collect();
    let mut laid = strand.to_vec();
    let follow = |leader: Vec3, follower: Vec3, length: f32, or: Vec3| {
        leader + (follower - leader).try_normalize().unwrap_or(or) * length
    };
    let along = |i: usize| (strand[i + 1] - strand[i]).normalize_or(Vec3::Y);
    for _ in 0..REACHES {
        if laid[node].distance(place) < ARRIVED_CM {
            break;
        }
        laid[node] = place;
        for i in (1..node).rev() {
            laid[i] = follow(laid[i + 1], laid[i], lengths[i], -along(i));
        }
        for i in 0..node {
            laid[i + 1] = follow(laid[i], laid[i + 1], lengths[i], along(i));
        }
    }
    let turn = Quat::from_rotation_arc(along(node - 1), (laid[node] - laid[node - 1]).normalize_or(along(node - 1)));
    for i in node + 1..strand.len() {
        laid[i] = laid[node] + turn * (strand[i] - strand[node]);
    }
    laid
}

/// Moves nodes out of the skin that were out of it before, and keeps the lengths.
fn keep_out(laid: &mut [Vec3], before: &[Vec3], skins: &Skins<'_>) {
    const TIMES: usize = 6;
    let lengths: Vec<f32> = before.windows(2).map(|ends| ends[0].distance(ends[1])).collect();
    for _ in 0..TIMES {
        let mut moved = false;
        for i in 1..laid.len() {
            let out = skins.way_out(laid[i], CLEAR_CM.min(skins.clearance(before[i])));
            moved |= out != Vec3::ZERO;
            laid[i] += out;
        }
        for i in 1..laid.len() {
            let along = (laid[i] - laid[i - 1]).try_normalize().unwrap_or(Vec3::Y);
            laid[i] = laid[i - 1] + along * lengths[i - 1];
        }
        if !moved {
            break;
        }
    }
}

#[cfg(test)]
#[path = "comb_tests.rs"]
mod tests;
