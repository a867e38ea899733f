//! One strand, and the step that moves it, in numbers of any kind.

use glam::{DQuat, DVec3, Vec3};

use super::common::Common;
use super::contact::{Touch, kept_from};
use crate::body::Surface;
use crate::dynamics::Dynamics;
use crate::dynamics::air::Air;
use crate::dynamics::free::ROUNDS;
use crate::dynamics::free::grid::Crowd;
use crate::dynamics::free::pulls::{self, At, joints};
use crate::dynamics::free::segment::{FreeSegment, free_segments};
use crate::error::SettingError;
use crate::free_form::FreeMotion;
use crate::scalar::{Scalar, Turn, Vector};

/// A strand at some frame.
#[derive(Clone, Debug)]
pub(in crate::dynamics) struct Strand<S> {
    segments: Vec<Segment<S>>,
    /// Root first (head space, cm).
    positions: Vec<Vector<S>>,
    /// For each body, what every point is kept out of, and how far from it (cm).
    kept_from: Vec<Vec<(Surface, f64)>>,
}

/// One segment: its direction d at frame n and its increment w (rad a frame), normal to d; both in head space.
#[derive(Clone, Debug)]
struct Segment<S> {
    moved_by: FreeSegment,
    /// K of the joint at its beginning.
    stiffness: S,
    /// What is left of an increment after a frame.
    decay: S,
    direction: Vector<S>,
    increment: Vector<S>,
}

/// Factors on the settings that may be unknown.
pub(in crate::dynamics) struct Springs<S> {
    /// Of the stiffness.
    pub stiffness: S,
    /// Of the frames in which a swing settles.
    pub settle: S,
}

impl<S: Scalar> Default for Springs<S> {
    /// The settings as they are.
    fn default() -> Self {
        Self { stiffness: S::from(1.0), settle: S::from(1.0) }
    }
}

impl<S: Scalar> Segment<S> {
    fn new(moved_by: FreeSegment, springs: &Springs<S>) -> Self {
        let FreeSegment { rest, stiffness, decay, .. } = moved_by;
        // What settles a factor slower has left, in a frame, what was left before to the power of 1 / factor.
        let as_it_was = springs.settle == S::from(1.0) || decay == 0.0 || decay == 1.0;
        let decay = if as_it_was { S::from(decay) } else { (S::from(decay.ln()) / springs.settle).exp() };
        let (stiffness, increment) = (springs.stiffness.times(stiffness), Vector::zero());
        Self { moved_by, stiffness, decay, direction: rest.into(), increment }
    }

    /// What is left of the head's turn is felt as lag.
    fn lag_behind(&mut self, axis: DVec3, angle: f64) {
        let lag = Turn::from(DQuat::from_axis_angle(axis, -self.moved_by.lag * angle));
        self.direction = lag.of(self.direction);
        self.increment = lag.of(self.increment);
    }

    /// What that has moved its direction by.
    fn lagged(&self, turn: Option<(DVec3, f64)>) -> Vector<S> {
        let Some((axis, angle)) = turn else { return Vector::zero() };
        let before = Turn::from(DQuat::from_axis_angle(axis, self.moved_by.lag * angle));
        self.direction - before.of(self.direction)
    }

    /// The moment of the joint at its beginning: what turns d toward where the segment before it carries its rest
    /// direction, and that one back. `carried`: that direction, R_(i-1) r_i.
    #[inline(always)]
    fn moment(&self, carried: Vector<S>) -> Vector<S> {
        joints::moment(self.stiffness, carried, self.direction)
    }

    /// w(n+1), before it turns d. `f`: all forces; `moment`: of both of its joints.
    #[inline(always)]
    fn drive(&mut self, f: Vector<S>, moment: Vector<S>) {
        let d = self.direction;
        let across = (f - d * f.dot(d)) + d.cross(moment);
        self.increment = (self.increment + across.times(self.moved_by.shape.gain)) * self.decay;
    }

    /// d + w, brought back to length 1, and w as it is carried along that way: its length stays. What rests keeps its bits.
    #[inline(always)]
    fn moved(&self) -> (Vector<S>, Vector<S>) {
        let (d, w) = (self.direction, self.increment);
        if w == Vector::zero() {
            return (d, w);
        }
        let length = (d + w).length();
        ((d + w) / length, (w - d * w.length_squared()) / length)
    }
}

impl<S: Scalar> Strand<S> {
    /// Strand number `s` at rest.
    ///
    /// # Errors
    /// As [`free_segments`].
    pub fn new(
        dynamics: &Dynamics,
        free: &FreeMotion,
        springs: &Springs<S>,
        strand: &[Vec3],
        s: usize,
    ) -> Result<Self, SettingError> {
        let segments = free_segments(dynamics, &free.form, strand, s)?;
        let segments = segments.into_iter().map(|moved_by| Segment::new(moved_by, springs)).collect();
        let positions = strand.iter().map(|p| p.as_dvec3().into()).collect();
        let mut strand = Self { segments, positions, kept_from: Vec::new() };
        strand.place();
        let at_rest: Vec<DVec3> = strand.positions.iter().map(|p| p.value()).collect();
        strand.kept_from = free.bodies.iter().map(|body| kept_from(body, &free.rest_pose, &at_rest)).collect();
        Ok(strand)
    }

    /// A strand that stands where another does, of which all numbers are known: nothing changes them.
    pub fn of_known(known: &Strand<f64>) -> Self {
        let segment = |segment: &Segment<f64>| Segment {
            moved_by: segment.moved_by,
            stiffness: S::from(segment.stiffness),
            decay: S::from(segment.decay),
            direction: segment.direction.value().into(),
            increment: segment.increment.value().into(),
        };
        Self {
            segments: known.segments.iter().map(segment).collect(),
            positions: known.positions.iter().map(|p| p.value().into()).collect(),
            kept_from: known.kept_from.clone(),
        }
    }

    /// Root first (head space, cm).
    pub fn positions(&self) -> &[Vector<S>] {
        &self.positions
    }

    /// What the increments alone move every point by in a frame (cm).
    pub fn velocities(&self) -> impl Iterator<Item = DVec3> {
        let moved = self.segments.iter().scan(DVec3::ZERO, |velocity, segment| {
            *velocity += segment.moved_by.shape.length * segment.increment.value();
            Some(*velocity)
        });
        std::iter::once(DVec3::ZERO).chain(moved)
    }

    /// Moves it by one frame, from its root to its tip. `crowd`: what its neighbours left in the frame before.
    #[inline(always)]
    pub fn step(&mut self, common: &Common, air: &impl Air<S>, crowd: Option<&Crowd>) {
        let Common { gamma, head, rest_weight, bodies } = common;
        if let Some((axis, angle)) = head.turn {
            self.segments.iter_mut().for_each(|segment| segment.lag_behind(axis, angle));
            self.place();
        }
        let Self { segments, positions, kept_from } = self;
        // R_(i-1), which has carried the segments before this one from their rest to where they are.
        let mut frame = Turn::from(DQuat::IDENTITY);
        let mut velocity = Vector::zero();
        let mut carried = frame.of_known(segments[0].moved_by.rest);
        let mut moment = segments[0].moment(carried);
        for i in 0..segments.len() {
            let (from, end) = (positions[i], positions[i + 1]);
            let field = air.force(end);
            let segment = &segments[i];
            let shape = segment.moved_by.shape;
            velocity += segment.increment.times(shape.length);
            let weakened = gamma.contains(end.value(), field.value().as_vec3());
            let eps = if weakened { shape.eps() } else { 1.0 };
            let at = At {
                segment: &segment.moved_by,
                direction: segment.direction,
                end,
                velocity,
                frame,
                head,
                rest_weight: *rest_weight,
                crowd,
            };
            let f = pulls::sum(field.times(eps), &at);
            frame = Turn::smallest(carried, segment.direction).after(frame);
            let next = match segments.get(i + 1) {
                Some(next) => {
                    carried = frame.of_known(next.moved_by.rest);
                    next.moment(carried)
                }
                None => Vector::zero(),
            };
            let segment = &mut segments[i];
            segment.drive(f, moment - next);
            moment = next;
            let was = segment.direction;
            let lagged = segment.lagged(head.turn);
            let (mut direction, mut increment) = segment.moved();
            // What is held goes with the head, whatever passes.
            let bodies = if shape.gain == 0.0 { &[][..] } else { bodies };
            let touched = |b: usize| {
                let (surface, clearance) = kept_from[b][i + 1];
                Touch { from, length: shape.length, clearance, was, lagged, surface }
            };
            let mut stopped = false;
            for (b, body) in bodies.iter().enumerate() {
                if let Some(there) = body.stop(direction, increment, &touched(b)) {
                    ((direction, increment), stopped) = (there, true);
                }
            }
            // What one body has turned may be in another: a corner is left by turns.
            let mut rounds = if bodies.len() > 1 { ROUNDS } else { 0 };
            while stopped && rounds > 0 {
                stopped = false;
                for (b, body) in bodies.iter().enumerate() {
                    if let Some(there) = body.part(direction, increment, &touched(b)) {
                        ((direction, increment), stopped) = (there, true);
                    }
                }
                rounds -= 1;
            }
            (segment.direction, segment.increment) = (direction, increment);
            positions[i + 1] = from + direction.times(shape.length);
        }
    }

    /// Puts the strand together from its root outward.
    fn place(&mut self) {
        let mut p = self.positions[0];
        for (segment, position) in self.segments.iter().zip(&mut self.positions[1..]) {
            p += segment.direction.times(segment.moved_by.shape.length);
            *position = p;
        }
    }
}

#[cfg(test)]
impl Strand<f64> {
    /// Stands as segments of these directions and increments do.
    pub fn stand(&mut self, segments: impl IntoIterator<Item = [DVec3; 2]>) {
        for (segment, [direction, increment]) in self.segments.iter_mut().zip(segments) {
            (segment.direction, segment.increment) = (direction.into(), increment.into());
        }
        self.place();
    }
}
