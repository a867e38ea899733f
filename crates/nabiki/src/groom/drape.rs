//! A strand on its head: free pieces hang as cantilevers, the others lie on the skin or on the hair below.
//!
//! The walk goes from the root. From the last node that touches, what is left of the strand is a free cantilever; as
//! long as its next node stays clear of the head, it is taken. A node that would fall inside is turned back about the
//! node before it until it lies where hair lies (method section 4), and the rest hangs from there.

use glam::DVec3;

use super::cantilever::{Beam, Hold, Workspace};
use super::course::Course;
use super::style::{LeverArms, Volume};
use crate::Head;

/// A free piece is settled to this (rad): a hundredth of a millimetre on 18 cm.
const SETTLED: f64 = 5e-5;

/// Times that the bends of a lying strand are rounded.
const ROUNDINGS: usize = 3;

/// Nodes of one strand, and what is needed to find them; kept from strand to strand.
#[derive(Debug, Default)]
pub(super) struct Draping {
    /// The nodes, root first (head space, cm).
    pub nodes: Vec<DVec3>,
    directions: Vec<DVec3>,
    loads: Vec<DVec3>,
    free: Vec<DVec3>,
    beam: Workspace,
}

/// What strands have in common.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ground<'a> {
    pub head: &'a Head,
    pub volume: Volume,
    pub lever_arms: LeverArms,
    pub wave_length: f64,
    /// Longest segment (cm).
    pub segment: f64,
}

impl Ground<'_> {
    /// Distance to the skin that hair keeps at arc length `s`: none at the pore, then the more the farther up the
    /// strand comes from, so that upper hair lies over lower hair.
    fn clearance(&self, course: &Course, s: f64) -> f64 {
        let layers = f64::from(self.volume.thickness) * course.depth;
        let gap = f64::from(self.volume.gap);
        gap + layers * (1.0 - (-s / f64::from(self.volume.reach)).exp())
    }

    /// What the end of the segment that ends at `s` keeps, and its middle.
    fn clearances(&self, course: &Course, s: f64, d: f64) -> (f64, f64) {
        let clearance = self.clearance(course, s);
        // The first segment starts on the skin.
        (clearance, if s < 1.5 * d { 0.0 } else { 0.7 * self.clearance(course, s - d).min(clearance) })
    }

    /// How much farther from the skin than it must be a segment `reach` from `p` stays, negative if it fails to.
    fn spare(&self, p: DVec3, reach: DVec3, clearance: f64, halfway: f64) -> f64 {
        (self.distance(p + reach) - clearance).min(self.distance(p + reach * 0.5) - halfway)
    }

    fn distance(&self, p: DVec3) -> f64 {
        f64::from(self.head.distance(p.as_vec3()))
    }

    /// Turns a segment from `p` along `t` toward or away from the skin until it just keeps `clearance` at its end,
    /// and `halfway` in its middle. If no angle does, the one that comes nearest.
    fn turned_onto(&self, p: DVec3, t: DVec3, d: f64, clearance: f64, halfway: f64) -> DVec3 {
        let outward = self.head.outward((p + t * d).as_vec3()).as_dvec3();
        let side = (outward - t * outward.dot(t)).try_normalize().unwrap_or_else(|| t.any_orthonormal_vector());
        let turned = |angle: f64| t * angle.cos() + side * angle.sin();
        let spare = |angle: f64| self.spare(p, turned(angle) * d, clearance, halfway);
        // Bracket the touch between an angle that is clear and one, below it, that is not.
        let first = spare(0.0);
        let (mut clear, mut inside, mut best) = (None, None, (first, 0.0));
        *(if first >= 0.0 { &mut clear } else { &mut inside }) = Some((0.0, first));
        let away = if first >= 0.0 { -1.0 } else { 1.0 };
        let mut step = (first.abs() / d).clamp(0.02, 0.5);
        let mut angle = 0.0;
        while clear.is_none() || inside.is_none() {
            angle += away * step;
            if angle.abs() > std::f64::consts::PI {
                return turned(best.1);
            }
            let now = spare(angle);
            if now > best.0 {
                best = (now, angle);
            }
            *(if now >= 0.0 { &mut clear } else { &mut inside }) = Some((angle, now));
            step = (1.5 * step).min(0.3);
        }
        let (Some(mut clear), Some(mut inside)) = (clear, inside) else { return turned(best.1) };
        for _ in 0..24 {
            if clear.1 < 1e-3 {
                break;
            }
            let share = (clear.1 / (clear.1 - inside.1)).clamp(0.1, 0.9);
            let angle = clear.0 + share * (inside.0 - clear.0);
            let now = spare(angle);
            *(if now >= 0.0 { &mut clear } else { &mut inside }) = (angle, now);
        }
        turned(clear.0)
    }

    /// Lays out a strand of `length` (cm) in equal segments: its nodes end up in `draping.nodes`.
    pub(super) fn drape(&self, course: &Course, length: f64, draping: &mut Draping) {
        let Draping { nodes, directions, loads, free, beam: workspace } = draping;
        let k = segments(length, self.segment);
        let d = length / k as f64;
        loads.clear();
        loads.extend((0..k).map(|j| course.load((j as f64 + 0.5) * d)));
        nodes.clear();
        nodes.push(course.root);
        directions.clear();

        let mut beam = Beam { stiffness: course.bend.powi(3), segment: d, clamp: course.clamp, hold: Hold::Clamped };
        // The free piece starts at this segment.
        let mut from = 0;
        self.hang(&beam, loads, false, free, workspace);
        let (mut p, mut lies, mut touched) = (course.root, false, false);
        for i in 0..k {
            let s = (i + 1) as f64 * d;
            let wave = wave_at(course, self.wave_length, s - 0.5 * d);
            let (clearance, halfway) = self.clearances(course, s, d);
            let hanging = (free[i - from] + wave).normalize();
            let taken = if self.spare(p, hanging * d, clearance, halfway) >= 0.0 {
                lies = false;
                hanging
            } else {
                // Lying hair carries about as much as hangs over one length of its stiffness: kappa = |w_perp| / bend.
                let along = if lies { beam.clamp + loads[i] * (d / course.bend) } else { free[i - from] };
                let along = (along.try_normalize().unwrap_or(beam.clamp) + wave).normalize();
                let along = self.turned_onto(p, along, d, clearance, halfway);
                lies = true;
                touched = true;
                beam.clamp = (along - wave).normalize();
                beam.hold = Hold::Continued;
                from = i + 1;
                if free.is_empty() {
                    along
                } else {
                    let old = i + 1 - (k - free.len());
                    free.drain(..old);
                    self.hang(&beam, &loads[from..], true, free, workspace);
                    along
                }
            };
            p += taken * d;
            nodes.push(p);
            directions.push(taken);
        }
        if touched {
            for _ in 0..ROUNDINGS {
                self.round(course, d, directions, nodes);
            }
        }
    }

    /// Rounds the bends of a strand that lies on something, as its own stiffness and the hair around it do: over an
    /// ear it lifts off above and comes down below. Nodes still keep their clearance.
    fn round(&self, course: &Course, d: f64, directions: &mut [DVec3], nodes: &mut [DVec3]) {
        let mut before = directions[0];
        for i in 1..directions.len() {
            let t = directions[i];
            let after = directions.get(i + 1).copied().unwrap_or(t);
            directions[i] = (before + 2.0 * t + after).try_normalize().unwrap_or(t);
            before = t;
        }
        for (i, t) in directions.iter_mut().enumerate().skip(1) {
            let (p, s) = (nodes[i], (i + 1) as f64 * d);
            let (clearance, halfway) = self.clearances(course, s, d);
            if self.spare(p, *t * d, clearance, halfway) < 0.0 {
                *t = self.turned_onto(p, *t, d, clearance, halfway);
            }
            nodes[i + 1] = p + *t * d;
        }
    }

    fn hang(&self, beam: &Beam, loads: &[DVec3], warm: bool, free: &mut Vec<DVec3>, workspace: &mut Workspace) {
        match self.lever_arms {
            LeverArms::Straight => beam.straight_arms(loads, free),
            LeverArms::Deformed => {
                beam.settle(loads, SETTLED, warm, free, workspace);
            }
        }
    }
}

/// Number of equal segments of a strand: as few as are not longer than `longest`.
pub(super) fn segments(length: f64, longest: f64) -> usize {
    // A ratio that only rounding carries beyond a whole number is that number.
    ((length / longest - 1e-5).ceil() as usize).max(1)
}

fn wave_at(course: &Course, wave_length: f64, s: f64) -> DVec3 {
    let turns = std::f64::consts::TAU * s / wave_length;
    course.wave * ((turns + course.wave_phase).cos() * (s / wave_length).min(1.0))
}
