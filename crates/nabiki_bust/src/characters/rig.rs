//! Joints, how the skin hangs on them, and how they move.

use glam::{Quat, Vec3};

/// A joint of a character that stands as it was sculpted: all joints are unturned there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Joint {
    pub name: &'static str,
    /// The joint above it in the list; none for the first.
    pub above: Option<usize>,
    /// Where it turns (cm).
    pub place: Vec3,
}

/// What a joint does in a frame: it turns, and goes from its place (cm).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Move {
    pub turn: Quat,
    pub way: Vec3,
}

impl Move {
    pub const NONE: Self = Self { turn: Quat::IDENTITY, way: Vec3::ZERO };

    /// Turns by degrees: first about z, the ear's axis, up positive; then about x, the nose's; then about y, to her
    /// left positive.
    pub fn degrees(nod: f64, roll: f64, yaw: f64) -> Self {
        let about = |axis: Vec3, degrees: f64| {
            let (sin, cos) = (0.5 * degrees.to_radians()).sin_cos();
            Quat::from_xyzw(axis.x * sin as f32, axis.y * sin as f32, axis.z * sin as f32, cos as f32)
        };
        Self { turn: about(Vec3::Y, yaw) * about(Vec3::X, roll) * about(Vec3::Z, nod), way: Vec3::ZERO }
    }

    pub fn by(self, way: [f64; 3]) -> Self {
        Self { way: Vec3::from(way.map(|x| x as f32)), ..self }
    }
}

/// How much of a vertex hangs on which joints; of all that it names the four largest count.
#[derive(Clone, Debug, Default)]
pub(super) struct Shares(Vec<(usize, f32)>);

impl Shares {
    /// All of it on one joint.
    pub fn on(joint: usize) -> Self {
        Self(vec![(joint, 1.0)])
    }

    /// Takes `share` of all and hangs it on this joint.
    pub fn over(mut self, joint: usize, share: f32) -> Self {
        let share = share.clamp(0.0, 1.0);
        self.0.iter_mut().for_each(|(_, other)| *other *= 1.0 - share);
        match self.0.iter_mut().find(|(other, _)| *other == joint) {
            Some((_, there)) => *there += share,
            None => self.0.push((joint, share)),
        }
        self
    }

    /// The four largest in whole 255ths, which sum up to 255.
    pub fn bytes(mut self) -> ([u8; 4], [u8; 4]) {
        self.0.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
        self.0.truncate(4);
        let sum: f32 = self.0.iter().map(|(_, share)| share).sum();
        let (mut joints, mut shares) = ([0; 4], [0; 4]);
        for (i, &(joint, share)) in self.0.iter().enumerate() {
            shares[i] = (255.0 * share / sum).round() as u8;
            joints[i] = if shares[i] > 0 { joint as u8 } else { 0 };
        }
        let rest: u8 = shares[1..].iter().sum();
        shares[0] = 255 - rest;
        (joints, shares)
    }
}

/// 0 below `low`, 1 above `high`, smooth between.
pub(super) fn smooth(x: f32, low: f32, high: f32) -> f32 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// The same with an acceleration that does not jump either, as motion wants it.
pub(super) fn eased(x: f64, low: f64, high: f64) -> f64 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * t * (t * (6.0 * t - 15.0) + 10.0)
}

/// How far that has gone by `x`, if it is a speed.
pub(super) fn eased_way(x: f64, low: f64, high: f64) -> f64 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    (high - low) * t.powi(4) * (t * (t - 3.0) + 2.5) + (x - high).max(0.0)
}

/// A curve through keys (frame, value) that stands still at each: a rest, or a turning point.
pub(super) fn keyed(keys: &[(f64, f64)], frame: f64) -> f64 {
    keys.windows(2).fold(keys[0].1, |value, pair| value + (pair[1].1 - pair[0].1) * eased(frame, pair[0].0, pair[1].0))
}
