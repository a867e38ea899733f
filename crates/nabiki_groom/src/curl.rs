//! Curls: a strand wound around the line in which it would hang without them.
//!
//! At the distance s along that line the strand is off it by q(s) = ramp(s) (a turning radius + the way to the middle of
//! the clump), in a frame that goes along the line without twisting (Bishop 1975). A segment of length d takes the line
//! on by h and the strand across by q(s + h) - q(s), where h^2 + |q(s + h) - q(s)|^2 = d^2: on a straight line every
//! node has its radius. What is across is given to the segment's direction, not to the node, so that segments keep their
//! lengths where the line bends.

use nabiki::glam::{DVec2, DVec3, Vec3};

use crate::cantilever::{carried, segments};
use crate::chance::{Chance, channel};
use crate::style::Curl;

/// h is settled to about this part of a segment, and found within so many rounds.
const SETTLED: f64 = 1e-9;
const MOST_ROUNDS: usize = 60;

/// How one strand curls (cm, rad).
#[derive(Clone, Copy, Debug)]
pub(crate) struct StrandCurl {
    /// Distance from the line.
    radius: f64,
    /// Radians a cm of the line, negative for a left hand.
    turn: f64,
    /// At the root.
    phase: f64,
    /// The second axis of the winding as a part of the first.
    round: f64,
    /// Distance from the root at which the curl is whole.
    set_in: f64,
    /// Way to the middle of the clump, across the line, in the frame's axes at the root.
    to_lock: DVec2,
    /// First axis of the frame at the root, normal to the line.
    side: DVec3,
}

/// Rises from 0 to 1 over 0..1, smoothly.
fn smooth(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// A clump: its middle, its chance, and the way out of the head there (unit vector).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Clump {
    pub middle: Vec3,
    pub chance: Chance,
    pub outward: DVec3,
}

impl StrandCurl {
    /// That of the strand of `length` (cm) which leaves `root` along `clamp`; none, if the style has no curls.
    pub fn new(curl: &Curl, length: f64, root: DVec3, clamp: DVec3, strand: Chance, clump: &Clump) -> Option<Self> {
        if curl.radius == 0.0 {
            return None;
        }
        let differs =
            |share: f32, chance: Chance, i: u64| f64::from(share) * (2.0 * chance.unit(channel::CURL + i) - 1.0);
        let radius = f64::from(curl.radius)
            * (1.0 + differs(curl.variation, clump.chance, 0))
            * (1.0 + differs(curl.frizz, strand, 0));
        let pitch = f64::from(curl.pitch) * (1.0 + differs(curl.variation, clump.chance, 1));
        let hand = if clump.chance.unit(channel::CURL + 3) < 0.5 { -1.0 } else { 1.0 };
        let turn = hand * std::f64::consts::TAU / pitch;

        // One direction for all of the clump, turned with the way its strands lean: neighbours have like frames.
        let out = clump.outward;
        let any = clump.chance.vector(channel::CURL);
        let side = (any - out * any.dot(out)).try_normalize().unwrap_or_else(|| out.any_orthonormal_vector());
        let side = carried(side, out, clamp);
        let to_middle = clump.middle.as_dvec3() - root;
        // What grows ahead of its clump's middle is ahead in the turn.
        let ahead = -to_middle.dot(clamp) * turn;
        let strays = std::f64::consts::PI * differs(curl.frizz, strand, 1);
        Some(Self {
            radius,
            turn,
            phase: std::f64::consts::TAU * clump.chance.unit(channel::CURL + 2) + ahead + strays,
            round: 1.0 - f64::from(curl.flatness),
            set_in: f64::from(curl.from) * length,
            to_lock: DVec2::new(to_middle.dot(side), to_middle.dot(clamp.cross(side))) * f64::from(curl.gather),
            side,
        })
    }

    /// How far the curl reaches from its line at the distance `s` along that (cm).
    pub fn reach(&self, s: f64) -> f64 {
        self.radius * smooth(s / self.set_in)
    }

    /// q(s): off the line, in the axes of the frame.
    fn off_line(&self, s: f64) -> DVec2 {
        let (sin, cos) = (self.phase + self.turn * s).sin_cos();
        (DVec2::new(cos, self.round * sin) * self.radius + self.to_lock) * smooth(s / self.set_in)
    }

    /// How far the segment of length `d` that starts at `s` goes along the line, and how far across it.
    fn step(&self, s: f64, d: f64) -> (f64, DVec2) {
        let from = self.off_line(s);
        let across = |h: f64| self.off_line(s + h) - from;
        // |h|^2 + |across(h)|^2 grows from 0 to d^2 or more.
        let (mut low, mut high) = (0.0, d);
        let mut h = d / (1.0 + across(d).length_squared() / (d * d)).sqrt();
        for _ in 0..MOST_ROUNDS {
            let q = across(h);
            let excess = h.hypot(q.length()) / d - 1.0;
            if excess.abs() < SETTLED {
                break;
            }
            *(if excess > 0.0 { &mut high } else { &mut low }) = h;
            // All but proportional: h and what is across grow alike.
            let next = h / (1.0 + excess);
            h = if low < next && next < high { next } else { 0.5 * (low + high) };
        }
        (h, across(h))
    }

    /// Length of the line that a strand of `length` takes, in segments no longer than `longest` (cm).
    pub fn line_length(&self, length: f64, longest: f64) -> f64 {
        let k = segments(length, longest);
        let d = length / k as f64;
        (0..k).fold(0.0, |s, _| s + self.step(s, d).0)
    }

    /// Length of the strand, no more than `most`, that takes the length `line`.
    pub fn length_along(&self, line: f64, most: f64, longest: f64) -> f64 {
        let k = segments(most, longest);
        let d = most / k as f64;
        let mut s = 0.0;
        for i in 0..k {
            let (h, _) = self.step(s, d);
            if s + h >= line {
                return (i as f64 + (line - s) / h) * d;
            }
            s += h;
        }
        most
    }

    /// The strand of `length` in segments no longer than `longest`, wound about a line whose segments are `between` long
    /// and have these directions: its own directions.
    pub fn wound<'a>(
        &'a self,
        length: f64,
        longest: f64,
        line: &'a [DVec3],
        between: f64,
    ) -> impl Iterator<Item = DVec3> + 'a {
        let k = segments(length, longest);
        let d = length / k as f64;
        let (mut s, mut along, mut side) = (0.0, line[0], self.side);
        (0..k).map(move |_| {
            let (h, across) = self.step(s, d);
            let here = direction_at(line, between, s + 0.5 * h);
            side = carried(side, along, here);
            along = here;
            s += h;
            (along * h + side * across.x + along.cross(side) * across.y).normalize()
        })
    }
}

/// The direction of a line at the distance `s`: its segments' own in their middles.
fn direction_at(line: &[DVec3], between: f64, s: f64) -> DVec3 {
    let place = (s / between - 0.5).clamp(0.0, (line.len() - 1) as f64);
    let before = place as usize;
    let after = (before + 1).min(line.len() - 1);
    line[before].lerp(line[after], place - before as f64).try_normalize().unwrap_or(line[before])
}
