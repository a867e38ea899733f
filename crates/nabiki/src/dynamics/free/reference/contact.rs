//! Contact in f64: bodies in one frame, and how a segment is kept out of them.

use glam::{DAffine3, DMat3, DVec3};

use crate::body::{Body, Contact, Surface};
use crate::dynamics::FrameInput;
use crate::dynamics::free::{FAN, NEAR, PUSHES, TOLERANCE_CM, TURN};
use crate::obstacle::Reading;
use crate::pose::Pose;
use crate::scalar::{Scalar, Vector};

/// The surface that each point is kept out of, and at what distance (cm). `times`: the strand's factor on the margin.
pub fn kept_from(body: &Body, rest_pose: &Pose, positions: &[DVec3], times: f64) -> Vec<(Surface, f64)> {
    let body_from_head = exact(body.head_from_body(0, rest_pose)).inverse();
    let kept = |p: &DVec3| {
        let (surface, clearance) = body.kept_from(body_from_head.transform_point3(*p).as_vec3(), times);
        (surface, f64::from(clearance))
    };
    positions.iter().map(kept).collect()
}

/// A body where it is at the end of a step.
pub struct PlacedBody<'a> {
    body: &'a Body,
    frame: u32,
    contact: Contact,
    body_from_head: DAffine3,
    /// Transforms points of the body from their place at the end of the step to that at its beginning, in head space; and the inverse.
    before_from_now: DAffine3,
    now_from_before: DAffine3,
    moves: bool,
    /// Of the frame, and the share of the frame that is over at its end.
    part: f64,
    until: f32,
}

/// A node at the beginning of a step (head space, cm and frames).
#[derive(Clone, Copy)]
pub struct Moving<S> {
    pub at: Vector<S>,
    /// How far skin has taken it along in this step; 0 without skin that moves.
    pub ridden: Vector<S>,
    /// How far that and the head's turn have moved it in this step.
    pub shifted: Vector<S>,
    pub velocity: Vector<S>,
    pub acceleration: Vector<S>,
    /// How strongly a body pushed it outward in the step before, including what it still moved inward.
    pub pressed: S,
}

/// The end of a segment that turns around its beginning (head space, cm).
pub struct Touch<S> {
    /// The current p_(i-1).
    pub from: Vector<S>,
    pub length: f64,
    /// Clearance of p_i from the skin.
    pub clearance: f64,
    /// d at the beginning of the step, turned back by the share of the head's turn that it is left behind.
    pub was: Vector<S>,
    /// The other motion of p_i in the step: of the segments before this one, and what the head's turn leaves behind.
    pub carried: Vector<S>,
    /// The surface that p_i is kept out of.
    pub surface: Surface,
}

impl<'a> PlacedBody<'a> {
    /// Body number `b` at the end of a step of a frame, given by the step's number, from 1 on, and their count.
    pub fn new(b: usize, body: &'a Body, input: &FrameInput, [step, steps]: [u32; 2]) -> Self {
        let [now, before] = input.head_from_body(b, body, [step, steps]).map(exact);
        Self {
            body,
            frame: input.frame,
            contact: body.contact,
            body_from_head: now.inverse(),
            before_from_now: before * now.inverse(),
            now_from_before: now * before.inverse(),
            moves: now != before,
            part: 1.0 / f64::from(steps),
            until: step as f32 / steps as f32,
        }
    }

    /// How far a node that moves with the body is from touching it at the end of the step; infinity far away.
    /// `(surface, clearance)`: what it is kept out of, and at what distance.
    pub fn clear<S: Scalar>(&self, (surface, clearance): (Surface, f64), node: &Moving<S>) -> f64 {
        let reading = self.reading(self.taken_along(node.at - node.ridden).value(), surface);
        reading.map_or(f64::INFINITY, |reading| f64::from(reading.distance) - clearance)
    }

    /// The push of the body on a node in the step: against the motion inward, against what pressed it in the step before, and friction.
    /// Also the outward pressing part (cm per frame^2), and the distance of the node from the body (cm).
    pub fn against<S: Scalar>(
        &self,
        (surface, clearance): (Surface, f64),
        node: &Moving<S>,
    ) -> Option<(Vector<S>, S, S)> {
        let h = self.part;
        let start = node.at - node.ridden;
        let carried = self.taken_along(start);
        let (distance, normal) = self.read(carried, surface)?;
        let of_body = carried - start - node.ridden;
        // A node that is already too deep is turned out, not thrown out.
        let gap = at_least_0(distance - S::from(clearance));
        let leaves = (node.velocity.times(h) - of_body).dot(normal) + gap;
        let pressed = node.pressed.times(h * h) - at_least_0(leaves);
        let moved = node.velocity.times(h) + node.acceleration.times(h * h) - of_body;
        let carries_in = -(moved.dot(normal) + gap);
        let inward = if carries_in.value() > pressed.value() { carries_in } else { pressed };
        if inward.value() <= 0.0 {
            return Some((Vector::zero(), S::from(0.0), gap));
        }
        let along = moved + (node.shifted - node.ridden);
        let over = 1.0 / (h * h);
        // Speed is stopped once; a pressing force continues.
        let presses = at_least_0(inward - at_least_0(-leaves));
        Some((self.slowed(along, normal, along.dot(normal), inward).times(over), presses.times(over), gap))
    }

    /// Where the body takes a point that moves with it in the step.
    fn taken_along<S: Scalar>(&self, p: Vector<S>) -> Vector<S> {
        let p = if self.moves { p.taken_by(&self.now_from_before) } else { p };
        self.bent(p.value()).map_or(p, |bent| p + bent.into())
    }

    /// Keeps a segment that would move along `direction`, with this `increment`, out of the body, and returns how far
    /// its end moved inward in the step (cm); `None` if it touches nothing.
    #[inline(always)]
    pub fn stop<S: Scalar>(
        &self,
        direction: Vector<S>,
        increment: Vector<S>,
        touch: &Touch<S>,
    ) -> Option<(Vector<S>, Vector<S>, S)> {
        (self.depth(direction, touch)? > 0.0).then(|| self.stopped(direction, increment, touch))
    }

    /// Turns a segment out of the body after another body has turned it in; `None` if none has.
    pub fn part<S: Scalar>(
        &self,
        direction: Vector<S>,
        increment: Vector<S>,
        touch: &Touch<S>,
    ) -> Option<(Vector<S>, Vector<S>)> {
        if self.depth(direction, touch)? <= f64::from(TOLERANCE_CM) {
            return None;
        }
        let (direction, _) = self.pushed_from(direction, touch);
        Some((direction, increment - direction * increment.dot(direction)))
    }

    /// How much deeper than its clearance the end of a segment is; `None` far away.
    #[inline(always)]
    fn depth<S: Scalar>(&self, direction: Vector<S>, touch: &Touch<S>) -> Option<f64> {
        let end = touch.from + direction.times(touch.length);
        Some(touch.clearance - f64::from(self.reading(end.value(), touch.surface)?.distance))
    }

    /// The same where the segment touches.
    #[inline(never)]
    fn stopped<S: Scalar>(
        &self,
        mut direction: Vector<S>,
        mut increment: Vector<S>,
        touch: &Touch<S>,
    ) -> (Vector<S>, Vector<S>, S) {
        let &Touch { from, length, clearance, surface, carried, .. } = touch;
        let end = from + direction.times(length);
        let Some((distance, normal)) = self.read(end, surface) else { return (direction, increment, S::from(0.0)) };
        let mut of_body = end - end.taken_by(&self.before_from_now);
        if let Some(bent) = self.bent(end.value()) {
            of_body += bent.into();
        }
        let moved = increment.times(length) + carried - of_body;
        let (depth, inward) = (S::from(clearance) - distance, -moved.dot(normal));
        if inward.value() > 0.0 {
            let change = self.slowed(moved, normal, -inward, inward);
            // Until it touched, it moved as before.
            let touching = if inward.value() > depth.value() { depth / inward } else { S::from(1.0) };
            direction = (direction.times(length) + change * touching).normalized_or(normal);
            increment += change / S::from(length);
        }
        direction = self.pushed_out(direction, touch);
        (direction, increment - direction * increment.dot(direction), at_least_0(inward))
    }

    /// The effect of contact on a motion against the body: `inward` of it is reversed, and friction takes its share of
    /// the motion along the skin. `outward`: all of the motion along the normal.
    fn slowed<S: Scalar>(&self, moved: Vector<S>, normal: Vector<S>, outward: S, inward: S) -> Vector<S> {
        let along = moved - normal * outward;
        let speed = along.length();
        let held = speed.value() <= f64::from(self.contact.static_friction) * inward.value();
        let lost = if held { S::from(1.0) } else { inward.times(f64::from(self.contact.friction)) / speed };
        normal * inward - along * lost
    }

    /// The direction nearest to the segment's own in which its end keeps its clearance. In a fold of the skin, behind an ear, that may be
    /// far off or not be found: then the one nearest to the segment's old direction, which was free.
    fn pushed_out<S: Scalar>(&self, direction: Vector<S>, touch: &Touch<S>) -> Vector<S> {
        let (pushed, depth) = self.pushed_from(direction, touch);
        if depth <= f64::from(TOLERANCE_CM) && pushed.dot(touch.was).value() > f64::from(NEAR) {
            return pushed;
        }
        let (stayed, depth_there) = self.pushed_from(touch.was, touch);
        if depth_there <= f64::from(TOLERANCE_CM) {
            return stayed;
        }
        let (mut best, mut least) = if depth_there < depth { (stayed, depth_there) } else { (pushed, depth) };
        // If no turn is found this way, tries a fan of directions from there outward.
        let normal = self.read(touch.from + best.times(touch.length), touch.surface).map_or(best, |(_, normal)| normal);
        for step in 1..=FAN {
            if least <= f64::from(TOLERANCE_CM) {
                break;
            }
            let aside = best.lerp(normal, step as f64 / FAN as f64).normalized_or(normal);
            let (direction, depth) = self.pushed_from(aside, touch);
            if depth < least {
                (best, least) = (direction, depth);
            }
        }
        best
    }

    /// Turns a segment out along the gradient until its end keeps its clearance, and returns its depth then.
    fn pushed_from<S: Scalar>(&self, mut direction: Vector<S>, touch: &Touch<S>) -> (Vector<S>, f64) {
        let &Touch { from, length, clearance, .. } = touch;
        let mut pushes = 0;
        loop {
            let end = from + direction.times(length);
            let Some((distance, normal)) = self.read(end, touch.surface) else { return (direction, 0.0) };
            let inside = S::from(clearance) - distance;
            if inside.value() <= f64::from(TOLERANCE_CM) || pushes == PUSHES {
                return (direction, inside.value());
            }
            direction = turned_out(direction, normal, inside / S::from(length));
            pushes += 1;
        }
    }

    /// Distance and outward normal at a point of head space; `None` far away.
    fn read<S: Scalar>(&self, p: Vector<S>, surface: Surface) -> Option<(S, Vector<S>)> {
        let reading = self.reading(p.value(), surface)?;
        let (gradient, head_from_body) = (reading.gradient.as_dvec3(), self.body_from_head.matrix3.transpose());
        let in_body = gradient.normalize_or(DVec3::Y);
        let curved = || {
            // The normal turns as far as the gradient changes across it.
            let across =
                DMat3::IDENTITY - DMat3::from_cols(in_body * in_body.x, in_body * in_body.y, in_body * in_body.z);
            let curvature = reading.hessian.as_dmat3() * gradient.length().recip();
            head_from_body * across * curvature * self.body_from_head.matrix3
        };
        let distance = S::known(f64::from(reading.distance), p, || head_from_body * gradient);
        Some((distance, S::known_vector(head_from_body * in_body, p, curved)))
    }

    /// The sample at a point of head space; `None` far away.
    fn reading(&self, p: DVec3, surface: Surface) -> Option<Reading> {
        self.body.surface(surface).read_during(
            self.body_from_head.transform_point3(p).as_vec3(),
            self.frame,
            self.until,
        )
    }

    /// The motion of a point at `p` by the bending of the body in a step, besides the motion of its space; without its derivatives.
    fn bent(&self, p: DVec3) -> Option<DVec3> {
        let obstacle = self.body.shape.obstacle();
        (obstacle.farthest_moved(self.frame) > 0.0).then(|| {
            let moved = obstacle.moved(self.body_from_head.transform_point3(p).as_vec3(), self.frame);
            self.body_from_head.matrix3.transpose() * moved.as_dvec3() * self.part
        })
    }
}

/// Turned around its beginning, the shortest way, until its end is farther out along the normal by `rise` of its
/// length: all the way out of a plane, however steeply it points in. At most by [`TURN`].
fn turned_out<S: Scalar>(direction: Vector<S>, normal: Vector<S>, rise: S) -> Vector<S> {
    let along = direction.dot(normal);
    let [cos, sin] = TURN.map(f64::from);
    let mut outward = along + rise;
    if along.value() < cos {
        // Not differentiable where the sine of the angle to the normal vanishes.
        let across = S::from(1.0) - along * along;
        let across = if across.value() > 0.0 { across.sqrt() } else { S::from(0.0) };
        let farthest = along.times(cos) + across.times(sin);
        outward = if farthest.value() < outward.value() { farthest } else { outward };
    }
    if outward.value() >= 1.0 {
        return normal;
    }
    // For a segment that points straight in, all ways are alike.
    let any = normal.value().any_orthonormal_vector().into();
    let aside = (direction - normal * along).normalized_or(any);
    (aside * (S::from(1.0) - outward * outward).sqrt() + normal * outward).normalized_or(normal)
}

fn at_least_0<S: Scalar>(x: S) -> S {
    if x.value() > 0.0 { x } else { S::from(0.0) }
}

fn exact(affine: glam::Affine3A) -> DAffine3 {
    DAffine3 { matrix3: affine.matrix3.as_dmat3(), translation: affine.translation.as_dvec3() }
}
