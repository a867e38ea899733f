//! The cantilever beam that shapes a strand (the paper's references 4 and 9; method section 4).
//!
//! A strand of k segments of length d hangs from a clamp under a load w_i per unit length. The bending moment of all
//! that hangs beyond node i-1, M_i, turns segment i away from its forerunner's direction a0: a0 d is displaced by
//! kappa_i d^2 toward the load, kappa_i = M_i / (E I), and scaled back to length d, so that
//!
//! ```text
//! tan(turn_i) = kappa_i d        (half of it for the first, clamped, segment)
//! ```
//!
//! [`Beam::straight_arms`] takes the lever arms of the straight strand, as reference 9 does: one walk from the root, right for
//! small loads. [`Beam::settle`] takes those of the deformed strand, repeating the pass until the shape stops moving:
//! the heavy elastica. Loads are forces per unit length in any unit, stiffness in that unit times length cubed; only
//! their ratio counts. Everything is in f64, without a transcendental function that could differ between platforms
//! save one logarithm in the choice of a step's length.

use nabiki::glam::DVec3;

/// Number of passes after which [`Beam::settle`] gives up. No strand of the tests needs 40.
pub const MOST_PASSES: usize = 400;

/// A turn at one joint that the starting shape does not exceed (cosine): the chord form has none of 90 degrees.
const STEEPEST_START: f64 = 0.5;

/// The support of a beam's near end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hold {
    /// A root: the first joint is half a segment from the clamp, so it turns by half its curvature.
    Clamped,
    /// An earlier segment of the same strand: a normal joint.
    Continued,
}

/// A strand's stiffness and its near end.
#[derive(Clone, Copy, Debug)]
pub struct Beam {
    /// Bending stiffness E I (load per unit length x cm^3).
    pub stiffness: f64,
    /// Length d of every segment (cm).
    pub segment: f64,
    /// a0 of the first segment: the direction of the root or of the segment before (unit vector).
    pub clamp: DVec3,
    /// The support of the near end.
    pub hold: Hold,
}

/// Scratch arrays of [`Beam::settle`], reused between strands to avoid allocations.
#[derive(Clone, Debug, Default)]
pub struct Workspace {
    pull: Vec<DVec3>,
    frame: Vec<[DVec3; 2]>,
    joint: Vec<f64>,
    pivot: Vec<f64>,
    turn: Vec<[f64; 2]>,
    trial: Vec<DVec3>,
}

impl Beam {
    /// E I / d at joint `i`, the moment per unit of tan(turn).
    fn joint(&self, i: usize) -> f64 {
        let whole = self.stiffness / self.segment;
        if i == 0 && self.hold == Hold::Clamped { 2.0 * whole } else { whole }
    }

    /// One walk from the root with straight lever arms: the directions (unit vectors) of segments 1..k.
    ///
    /// `loads` holds w_i, the load per unit length of each segment. For a uniform load the moment is the paper's
    /// M_i = |w_perp| d^2 (k - i + 1)^2 / 2.
    pub fn straight_arms(&self, loads: &[DVec3], directions: &mut Vec<DVec3>) {
        directions.clear();
        directions.resize(loads.len(), DVec3::ZERO);
        // First moment of the load about node i-1, per unit of a0: d^2 sum over j >= i of (j - i + 1/2) w_j.
        let (mut beyond, mut moment) = (DVec3::ZERO, DVec3::ZERO);
        for (direction, &w) in directions.iter_mut().zip(loads).rev() {
            moment += (beyond + 0.5 * w) * self.segment * self.segment;
            beyond += w;
            *direction = moment;
        }
        let mut a0 = self.clamp;
        for (i, direction) in directions.iter_mut().enumerate() {
            let across = *direction - a0 * direction.dot(a0);
            a0 = (a0 + across / self.joint(i)).normalize();
            *direction = a0;
        }
    }

    /// Repeats the pass with the lever arms of the deformed shape until no segment turns by more than `tolerance`
    /// (rad): `directions` (unit vectors) become those of the heavy elastica. Returns the number of passes taken.
    ///
    /// With `warm`, the search starts from `directions`; otherwise from a strand that gives way joint by joint.
    ///
    /// Repeating the bare pass diverges where w L^3 / EI is above about 8 (it overshoots by that factor over 7.84).
    /// Here each pass solves for all turns at once: M_i - M_(i+1) is the moment on segment i alone, about its own near
    /// end, of the load beyond, so the conditions couple neighbours only and their Newton step is a tridiagonal
    /// solve. They are the stationary points of the energy
    /// `-sum (EI/d) ln cos(turn_i) - sum g_i . s_i/d`, which every step lowers: the search cannot run away, and an
    /// upright strand that would buckle does.
    pub fn settle(
        &self,
        loads: &[DVec3],
        tolerance: f64,
        warm: bool,
        directions: &mut Vec<DVec3>,
        work: &mut Workspace,
    ) -> usize {
        let k = loads.len();
        work.load(self.segment, loads);
        let starts_well = warm && directions.len() == k && self.energy(directions, &work.pull).is_finite();
        if !starts_well {
            self.give_way(&work.pull, directions);
        }
        let mut energy = self.energy(directions, &work.pull);
        for pass in 1..=MOST_PASSES {
            self.newton_turns(directions, work);
            let largest = work.turn.iter().fold(0.0f64, |m, t| m.max(t[0].abs()).max(t[1].abs()));
            let (mut share, mut lowered) = (1.0, false);
            for _ in 0..40 {
                work.trial.clear();
                work.trial.extend(
                    directions
                        .iter()
                        .zip(&work.frame)
                        .zip(&work.turn)
                        .map(|((&t, [u, v]), [a, b])| (t + (*u * *a + *v * *b) * share).normalize()),
                );
                let after = self.energy(&work.trial, &work.pull);
                // Near the end the energy no longer resolves the step, which is then a good one.
                if after < energy || (largest < 1e-6 && after.is_finite()) {
                    energy = after;
                    lowered = true;
                    break;
                }
                share *= 0.5;
            }
            if lowered {
                std::mem::swap(directions, &mut work.trial);
            }
            if !lowered || largest <= tolerance {
                return pass;
            }
        }
        MOST_PASSES
    }

    /// Starting shape: every segment turns, from the root on, as the load beyond it wants, as if the joint beyond
    /// were loose; never by more than 60 degrees.
    fn give_way(&self, pull: &[DVec3], directions: &mut Vec<DVec3>) {
        directions.clear();
        let mut a0 = self.clamp;
        for (i, &g) in pull.iter().enumerate() {
            let wanted = a0 * self.joint(i) + g;
            let along = wanted.dot(a0);
            let mut across = wanted - a0 * along;
            if i == 0 && g.dot(a0) < 0.0 && across.length() < 1e-9 * g.length() {
                // Straight up: both sides are alike, and a strand that is long enough falls to one.
                across = a0.any_orthonormal_vector() * (1e-3 * g.length());
            }
            let size = along.hypot(across.length());
            a0 = if along < STEEPEST_START * size {
                let side = across.try_normalize().unwrap_or_else(|| a0.any_orthonormal_vector());
                a0 * STEEPEST_START + side * (1.0 - STEEPEST_START * STEEPEST_START).sqrt()
            } else {
                a0 * along + across
            };
            a0 = a0.try_normalize().unwrap_or(self.clamp);
            directions.push(a0);
        }
    }

    /// The energy of a shape (load per unit length x cm^2), infinite where a joint turns by 90 degrees or more.
    fn energy(&self, directions: &[DVec3], pull: &[DVec3]) -> f64 {
        let (mut a0, mut cosines, mut work) = (self.clamp, 1.0f64, 0.0);
        let mut exponent = 0.0;
        for (i, (&t, &g)) in directions.iter().zip(pull).enumerate() {
            let cosine = a0.dot(t);
            if cosine.is_nan() || cosine <= 1e-9 {
                return f64::INFINITY;
            }
            cosines *= if i == 0 && self.hold == Hold::Clamped { cosine * cosine } else { cosine };
            if cosines < 1e-200 {
                exponent += cosines.ln();
                cosines = 1.0;
            }
            work += g.dot(t);
            a0 = t;
        }
        -(self.stiffness / self.segment) * (exponent + cosines.ln()) - work
    }

    /// The Newton step from `directions`: the turns of each segment in its own frame, into `work.turn`.
    fn newton_turns(&self, directions: &[DVec3], work: &mut Workspace) {
        let k = directions.len();
        let Workspace { pull, frame, joint, pivot, turn, .. } = work;
        frame.clear();
        joint.clear();
        turn.clear();
        // Frames carried along without twist, so that neighbours' turns add component by component.
        let mut a0 = self.clamp;
        let mut u = self.clamp.any_orthonormal_vector();
        for (i, &t) in directions.iter().enumerate() {
            u = carried(u, a0, t);
            frame.push([u, t.cross(u)]);
            joint.push(self.joint(i) / a0.dot(t));
            a0 = t;
        }
        for i in 0..k {
            let before = if i == 0 { self.clamp } else { directions[i - 1] };
            let mut torque = pull[i] + before * joint[i];
            if i + 1 < k {
                torque += directions[i + 1] * joint[i + 1];
            }
            turn.push([torque.dot(frame[i][0]), torque.dot(frame[i][1])]);
        }
        // Stiffness of a joint against a further turn: d tan = (1 + tan^2) d turn.
        let mut a0 = self.clamp;
        for (joint, &t) in joint.iter_mut().zip(directions) {
            *joint /= a0.dot(t);
            a0 = t;
        }
        // Where the load pushes a segment up against it (upright hair) the true matrix may lose its definiteness:
        // then leave those terms out, which still lowers the energy.
        if !factorise(directions, pull, joint, pivot, false) {
            factorise(directions, pull, joint, pivot, true);
        }
        for i in 1..k {
            let part = joint[i] / pivot[i - 1];
            let [a, b] = turn[i - 1];
            turn[i][0] += part * a;
            turn[i][1] += part * b;
        }
        for i in (0..k).rev() {
            let [c, d] = if i + 1 < k { turn[i + 1].map(|x| x * joint[i + 1]) } else { [0.0; 2] };
            turn[i] = [(turn[i][0] + c) / pivot[i], (turn[i][1] + d) / pivot[i]];
        }
    }
}

impl Workspace {
    /// g_i = d^2 (w_i / 2 + sum over j > i of w_j): the load beyond, times the arm d.
    fn load(&mut self, segment: f64, loads: &[DVec3]) {
        self.pull.clear();
        self.pull.resize(loads.len(), DVec3::ZERO);
        let mut beyond = DVec3::ZERO;
        for (pull, &w) in self.pull.iter_mut().zip(loads).rev() {
            *pull = (beyond + 0.5 * w) * segment * segment;
            beyond += w;
        }
    }
}

/// `u`, normal to `from`, after the smallest turn that takes `from` to `to` (unit vectors, not opposite).
pub(crate) fn carried(u: DVec3, from: DVec3, to: DVec3) -> DVec3 {
    let u = u - (from + to) * (u.dot(to) / (1.0 + from.dot(to)));
    (u - to * u.dot(to)).normalize()
}

/// Pivots of the tridiagonal matrix of turns; false if it is not positive definite.
fn factorise(directions: &[DVec3], pull: &[DVec3], joint: &[f64], pivot: &mut Vec<f64>, held_only: bool) -> bool {
    pivot.clear();
    for i in 0..directions.len() {
        let beyond = joint.get(i + 1).copied().unwrap_or(0.0);
        let held = pull[i].dot(directions[i]);
        let mut p = joint[i] + beyond + if held_only { held.max(0.0) } else { held };
        if i > 0 {
            p -= joint[i] * joint[i] / pivot[i - 1];
        }
        if p.is_nan() || p <= 1e-9 * joint[i] {
            return false;
        }
        pivot.push(p);
    }
    true
}

/// Number of equal segments of a strand: as few as are not longer than `longest`.
pub(crate) fn segments(length: f64, longest: f64) -> usize {
    // A ratio that only rounding carries beyond a whole number is that number.
    ((length / longest - 1e-5).ceil() as usize).max(1)
}
