//! The chain: tensions that keep the segments' lengths, and the implicit step. Equations in docs/motion-forms.md.

use glam::{DQuat, DVec3};

use super::strand::Segment;
use crate::dynamics::free::pulls::{hold, joints, weight};
use crate::dynamics::free::segment::FreeSegment;
use crate::scalar::{Scalar, Turn, Vector};

/// The implicit step counts, in addition to the forces at its beginning, what Q answers to `AFTER` of the turn at its end
/// less `BEFORE` of that at its beginning. Segments go all of a step with the rate at its end, so their directions are
/// those in the middle between two rates: the step is exact to the second order whatever Q leaves out, but for
/// `AFTER - BEFORE`, which damps ripples. It is stable for any stiffness if 4 `AFTER` is at least 1 + 2 (`AFTER - BEFORE`).
/// With 0.2 for the difference, a shaken head moves its hair by a sixth too little.
pub const AFTER: f64 = 0.4;
pub const BEFORE: f64 = 0.25;

/// `AFTER` of a pressed strand, which has no `BEFORE`. Joints and a body throw it to and fro in every step, and such swings must
/// die at once: with the shares of free hair, a hand at the jaw whips strands across the face.
pub const AFTER_PRESSED: f64 = 0.6;

/// How strongly the joints of a bent strand, times the squared sine of the bend, resist a turn in the implicit step, in
/// addition to a straight one. Q does not contain the turns of segments that point in different directions.
pub const BENT: f64 = 4.0;

/// How often a pressed strand is solved again, each time with tensions that know how its joints answered before. With
/// 2, none of 3,000 strands of a new scene keeps hopping under the earth's gravity.
pub const ROUNDS_PRESSED: usize = 2;

/// The input of the segments of a strand, and working memory of the solve.
#[derive(Clone, Debug)]
pub struct Chain<S> {
    /// b_i: the acceleration of a node by all but the chain and the air (cm per frame^2).
    pub pushed: Vec<Vector<S>>,
    /// beta_i: the share of a node's speed that air and neighbours take (1 per frame).
    pub drag: Vec<S>,
    /// R_0, the skin's turn from rest; none on skin that does not move.
    pub from_rest: Option<Turn<S>>,
    /// R_(i-1), which has carried the segments before this one from rest to their current directions.
    pub frames: Vec<Turn<S>>,
    /// Velocities of the nodes (cm per frame), the root's first.
    pub velocities: Vec<Vector<S>>,
    /// R_(i-1) r_i.
    carried: Vec<Vector<S>>,
    /// The turn of a segment about itself in a step, and the share of it that the joint after it passes on.
    turns: Vec<Turn<S>>,
    handed: Vec<S>,
    bending: Vec<S>,
    moments: Vec<Vector<S>>,
    /// T_i.
    tensions: Vec<S>,
    upper: Vec<S>,
    /// The change of the joints' force on a segment during the step, if known; else 0.
    answers: Vec<Vector<S>>,
    /// s_i - T_i d_i, and the right side of the increments.
    forces: Vec<Vector<S>>,
    driven: Vec<Vector<S>>,
    bands: Vec<[S; 5]>,
}

impl<S: Scalar> Chain<S> {
    pub fn new(segments: usize) -> Self {
        let (zero, vector, none) = (S::from(0.0), Vector::zero(), Turn::from(DQuat::IDENTITY));
        Self {
            pushed: vec![vector; segments],
            from_rest: None,
            drag: vec![zero; segments],
            frames: vec![none; segments],
            velocities: vec![vector; segments + 1],
            carried: vec![vector; segments],
            turns: vec![none; segments],
            handed: vec![zero; segments],
            bending: vec![zero; segments + 1],
            moments: vec![vector; segments + 1],
            tensions: vec![zero; segments],
            upper: vec![zero; segments],
            answers: vec![vector; segments],
            forces: vec![vector; segments],
            driven: vec![vector; segments],
            bands: vec![[zero; 5]; segments],
        }
    }

    /// Frames along the strand, its joints' moments, and velocities of its nodes. Joints are twisted until no segment
    /// turns about itself: twist settles at once.
    #[inline(always)]
    pub fn bend(&mut self, segments: &mut [Segment<S>]) {
        self.answers.fill(Vector::zero());
        let mut frame = self.from_rest.unwrap_or_else(|| DQuat::IDENTITY.into());
        for (i, segment) in segments.iter().enumerate() {
            let (d, carried) = (segment.direction, frame.of_known(segment.moved_by.rest));
            (self.frames[i], self.carried[i], self.bending[i]) = (frame, carried, segment.bending);
            frame = Turn::about(d, segment.twist).after(Turn::smallest(carried, d)).after(frame);
            self.velocities[i + 1] = self.velocities[i] + segment.increment.times(segment.moved_by.shape.length);
        }
        self.untwist(segments);
        for (i, segment) in segments.iter_mut().enumerate() {
            let d = segment.direction;
            let carried = if i > 0 { self.turns[i - 1].of(self.carried[i]) } else { self.carried[i] };
            let along = (d + carried) / (S::from(1.0) + d.dot(carried));
            let twisted = along * (segment.twist * segment.bending).times(joints::TORSION);
            self.moments[i] = joints::moment(segment.bending, carried, d) - twisted;
        }
    }

    /// Twists the joints so that every segment is balanced about itself: a tridiagonal system.
    #[inline(always)]
    fn untwist(&mut self, segments: &mut [Segment<S>]) {
        let n = segments.len();
        let (zero, one) = (S::from(0.0), S::from(1.0));
        // For the joint before segment i, the share of a turn of the segment before it that it passes on: kappa_i.
        let handed = |i: usize, segments: &[Segment<S>], carried: &[Vector<S>]| {
            let (d, c, before) = (segments[i].direction, carried[i], segments[i - 1].direction);
            before.dot(d + c) / (one + d.dot(c))
        };
        let (mut above, mut turned) = (zero, zero);
        let mut kappa = zero;
        for i in 0..n {
            let stiff = segments[i].bending.times(joints::TORSION);
            let (mut middle, mut right) = (stiff, -(stiff * segments[i].twist));
            let next = if i + 1 < n { handed(i + 1, segments, &self.carried) } else { zero };
            let mut upper = zero;
            if i + 1 < n {
                let (d, c, bending) = (segments[i].direction, self.carried[i + 1], segments[i + 1].bending);
                let stiff = bending.times(joints::TORSION);
                middle += bending * d.cross(c).length_squared() + stiff * next * next;
                right += stiff * next * segments[i + 1].twist - bending * segments[i + 1].direction.cross(c).dot(d);
                upper = -(stiff * next);
            }
            let lower = if i > 0 { -(stiff * kappa) } else { zero };
            let middle = middle - lower * above;
            // A held segment does not turn.
            let over = if segments[i].moved_by.lightness > 0.0 && middle.value() > 0.0 { one / middle } else { zero };
            above = upper * over;
            turned = (right - lower * turned) * over;
            (self.upper[i], self.tensions[i]) = (above, turned);
            (self.handed[i], kappa) = (kappa, next);
        }
        for i in (0..n - 1).rev() {
            self.tensions[i] = self.tensions[i] - self.upper[i] * self.tensions[i + 1];
        }
        let mut before = zero;
        for (i, segment) in segments.iter_mut().enumerate() {
            let turned = self.tensions[i];
            segment.twist += turned - self.handed[i] * before;
            self.turns[i] = Turn::about(segment.direction, turned);
            before = turned;
        }
    }

    /// What drives the increments, except for the drag on them and the rounding error at rest: `l w' = l w + h (driven - ...)`.
    #[inline(always)]
    pub fn drive(&mut self, segments: &[Segment<S>]) -> &mut [Vector<S>] {
        let n = segments.len();
        // s_i, the shear of the joints' moments.
        for (i, segment) in segments.iter().enumerate() {
            let (FreeSegment { shape, hold, rest, up, supports, .. }, d) = (segment.moved_by, segment.direction);
            let [rest, up] = [rest, up].map(|v| self.turned_from_rest(v));
            let mut on_head = hold::moment(hold, rest, d) + weight::moment(up, supports, d);
            if let Some((toward, aimed)) = segment.aimed {
                on_head += hold::moment(aimed, toward, d);
            }
            let moment = self.moments[i] - self.moments[i + 1] + on_head;
            self.forces[i] = moment.cross(d).times(1.0 / shape.length);
        }
        // rho_i, without the drag on its own increment.
        let mut before = Vector::zero();
        for i in 0..n {
            let node = self.pushed[i] + self.across(i, segments);
            let differs = if i == 0 { self.drag[0] } else { self.drag[i] - self.drag[i - 1] };
            self.driven[i] = node - before - self.velocities[i] * differs;
            before = node;
        }
        self.pull_taut(segments);
        for (i, segment) in segments.iter().enumerate() {
            self.forces[i] = -(segment.direction * self.tensions[i]);
        }
        let mut before = Vector::zero();
        for (i, segment) in segments.iter().enumerate() {
            let node = self.across(i, segments);
            let (d, w) = (segment.direction, segment.increment);
            self.driven[i] =
                self.driven[i] + (node - before) + d * w.length_squared().times(segment.moved_by.shape.length);
            before = node;
        }
        &mut self.driven
    }

    /// Where the skin has turned a direction of the hair at rest.
    #[inline(always)]
    pub fn turned_from_rest(&self, v: DVec3) -> Vector<S> {
        self.from_rest.map_or_else(|| v.into(), |turn| turn.of_known(v))
    }

    /// The acceleration of a node by the forces on both sides of it.
    #[inline(always)]
    fn across(&self, i: usize, segments: &[Segment<S>]) -> Vector<S> {
        let beyond = if i + 1 < segments.len() { self.forces[i + 1] } else { Vector::zero() };
        (self.forces[i] - beyond).times(segments[i].moved_by.lightness)
    }

    /// The tensions that keep every segment's length: a tridiagonal system.
    #[inline(always)]
    fn pull_taut(&mut self, segments: &[Segment<S>]) {
        let n = segments.len();
        let (mut lightness, mut above, mut before) = (0.0, S::from(0.0), S::from(0.0));
        let mut answered_before = Vector::zero();
        for (i, segment) in segments.iter().enumerate() {
            let (d, w) = (segment.direction, segment.increment);
            let (length, up) = (segment.moved_by.shape.length, segment.moved_by.lightness);
            if up == 0.0 {
                continue;
            }
            let beyond = self.answers.get(i + 1).copied().unwrap_or(Vector::zero());
            let answered = (self.answers[i] - beyond).times(up);
            let driven = self.driven[i] + (answered - answered_before) - w * self.drag[i].times(length);
            let right = driven.dot(d) + w.length_squared().times(length);
            answered_before = answered;
            let lower =
                if lightness == 0.0 { S::from(0.0) } else { -d.dot(segments[i - 1].direction).times(lightness) };
            let middle = S::from(1.0) / (S::from(up + lightness) - lower * above);
            above = match segments.get(i + 1) {
                Some(next) => -(d.dot(next.direction).times(up) * middle),
                None => S::from(0.0),
            };
            before = (right - lower * before) * middle;
            (self.upper[i], self.tensions[i]) = (above, before);
            lightness = up;
        }
        for i in (0..n - 1).rev() {
            self.tensions[i] = self.tensions[i] - self.upper[i] * self.tensions[i + 1];
        }
    }

    /// Q, the forces' answer to a turn: for row i the entries before, on and after the diagonal.
    #[inline(always)]
    fn stiffness(&self, i: usize, segments: &[Segment<S>]) -> [S; 3] {
        let FreeSegment { shape, mut hold, .. } = segments[i].moved_by;
        hold += segments[i].aimed.map_or(0.0, |(_, aimed)| aimed);
        let tension = if self.tensions[i].value() > 0.0 { self.tensions[i] } else { S::from(0.0) };
        let [here, next] = [self.bending[i], self.bending[i + 1]];
        let bent = self.bent(i, segments) + self.bent(i + 1, segments);
        let over = 1.0 / shape.length;
        [-here.times(over), tension + (here + next + bent.times(BENT) + S::from(hold)).times(over), -next.times(over)]
    }

    /// B of the joint before segment i, times the squared sine of its bend; 0 for the first joint.
    #[inline(always)]
    fn bent(&self, i: usize, segments: &[Segment<S>]) -> S {
        match (i.checked_sub(1).map(|before| &segments[before]), segments.get(i)) {
            (Some(before), Some(segment)) if before.moved_by.lightness > 0.0 => {
                let along = before.direction.dot(segment.direction);
                self.bending[i] * (S::from(1.0) - along * along)
            }
            _ => S::from(0.0),
        }
    }

    /// (l (1 + h beta) + 0.4 h^2 P Q) w' = l w + h driven + 0.25 h^2 P Q w: a pentadiagonal system. What is driven becomes w'.
    /// Of a `pressed` strand, with 0.6 and 0.
    #[inline(always)]
    pub fn solve(&mut self, segments: &[Segment<S>], h: f64, pressed: bool) {
        let [implicit, explicit] =
            if pressed { [AFTER_PRESSED, 0.0] } else { [AFTER, BEFORE] }.map(|share| h * h * share);
        let n = segments.len();
        let zero = S::from(0.0);
        let mut before = [zero; 5];
        let mut here = self.stiffness(0, segments);
        for (i, segment) in segments.iter().enumerate() {
            let (length, lightness) = (segment.moved_by.shape.length, segment.moved_by.lightness);
            let next = if i + 1 < n { self.stiffness(i + 1, segments) } else { [zero; 3] };
            // The acceleration of the node by turns of the segments from i - 1 to i + 2.
            let node = [here[0], here[1] - next[0], here[2] - next[1], -next[2]].map(|x| x.times(lightness));
            let row = [-before[0], node[0] - before[1], node[1] - before[2], node[2] - before[3], node[3]];
            before = [node[0], node[1], node[2], node[3], zero];
            here = next;
            let mut turned = Vector::zero();
            for (k, x) in row.iter().enumerate() {
                if let Some(segment) = (i + k).checked_sub(2).and_then(|j| segments.get(j)) {
                    turned += segment.increment * *x;
                }
            }
            let mut band = row.map(|x| x.times(implicit));
            band[2] += (S::from(1.0) + self.drag[i].times(h)).times(length);
            self.bands[i] = band;
            self.driven[i] = segment.increment.times(length) + self.driven[i].times(h) + turned.times(explicit);
        }
        // Elimination without pivots: inertia is on the diagonal.
        for i in 0..n {
            let [_, _, middle, next, after] = self.bands[i];
            let inverse = S::from(1.0) / middle;
            for k in 1..=2.min(n - 1 - i) {
                let part = self.bands[i + k][2 - k] * inverse;
                let row = &mut self.bands[i + k];
                row[3 - k] = row[3 - k] - part * next;
                row[4 - k] = row[4 - k] - part * after;
                self.driven[i + k] = self.driven[i + k] - self.driven[i] * part;
            }
        }
        for i in (0..n).rev() {
            let [_, _, middle, next, after] = self.bands[i];
            let mut left = self.driven[i];
            if i + 1 < n {
                left = left - self.driven[i + 1] * next;
            }
            if i + 2 < n {
                left = left - self.driven[i + 2] * after;
            }
            self.driven[i] = left / middle;
        }
    }

    /// After a solve of a pressed strand: records how the joints answer the turns found, for the tensions of the next solve.
    #[inline(always)]
    pub fn answer(&mut self, segments: &[Segment<S>], h: f64) {
        for i in 0..segments.len() {
            let mut turned = Vector::zero();
            for (k, x) in self.stiffness(i, segments).into_iter().enumerate() {
                if let Some(after) = (i + k).checked_sub(1).and_then(|j| self.driven.get(j)) {
                    turned += *after * x;
                }
            }
            self.answers[i] = turned.times(-h * AFTER_PRESSED);
        }
    }

    /// w' of a segment, after [`solve`](Self::solve).
    pub fn solved(&self, i: usize) -> Vector<S> {
        self.driven[i]
    }
}
