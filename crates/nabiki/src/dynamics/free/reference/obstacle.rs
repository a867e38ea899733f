//! A body in one frame, as the f64 stepper meets it.

use glam::{DAffine3, DVec3};

use crate::body::{Body, Contact, Surface};
use crate::dynamics::FrameInput;
use crate::dynamics::free::{FAN, NEAR, PUSHES, TOLERANCE_CM};
use crate::pose::Pose;

/// What each point is kept out of, and how far from it (cm).
pub fn kept_from(body: &Body, rest_pose: &Pose, positions: &[DVec3]) -> Vec<(Surface, f64)> {
    let body_from_head = exact(body.head_from_body(0, rest_pose)).inverse();
    let kept = |p: &DVec3| {
        let (surface, clearance) = body.kept_from(body_from_head.transform_point3(*p).as_vec3());
        (surface, f64::from(clearance))
    };
    positions.iter().map(kept).collect()
}

/// A body in one frame.
pub struct Obstacle<'a> {
    body: &'a Body,
    contact: Contact,
    body_from_head: DAffine3,
    /// Takes points of the body from where they are to where they were in the frame before, in head space.
    before_from_now: DAffine3,
}

/// The end of a segment that turns about its beginning (head space, cm).
pub struct Touch {
    /// p_(i-1), where it is now.
    pub from: DVec3,
    pub length: f64,
    /// How far p_i is kept from the skin.
    pub clearance: f64,
    /// d at frame n.
    pub was: DVec3,
    /// What p_i is kept out of.
    pub surface: Surface,
}

impl<'a> Obstacle<'a> {
    pub fn new(body: &'a Body, input: &FrameInput) -> Self {
        let now = exact(body.head_from_body(input.frame, &input.pose));
        let before = exact(body.head_from_body(input.frame - 1, &input.before[0]));
        Self { body, contact: body.contact, body_from_head: now.inverse(), before_from_now: before * now.inverse() }
    }

    /// Keeps a segment that would go along `direction`, with this `increment`, out of the body.
    pub fn stop(&self, mut direction: DVec3, mut increment: DVec3, touch: &Touch) -> (DVec3, DVec3) {
        let &Touch { from, length, clearance, .. } = touch;
        let end = from + length * direction;
        let Some((distance, normal)) = self.read(end, touch.surface) else { return (direction, increment) };
        if distance >= clearance {
            return (direction, increment);
        }
        let of_body = end - self.before_from_now.transform_point3(end);
        let change = self.slowed(length * increment - of_body, normal);
        direction = (length * direction + change).normalize_or(normal);
        increment += change / length;
        direction = self.pushed_out(direction, touch);
        (direction, increment - increment.dot(direction) * direction)
    }

    /// What contact takes of a motion against the body: all of it that goes inward, and of the rest what friction takes.
    fn slowed(&self, moved: DVec3, normal: DVec3) -> DVec3 {
        let inward = -moved.dot(normal);
        if inward <= 0.0 {
            return DVec3::ZERO;
        }
        let along = moved + inward * normal;
        let speed = along.length();
        let held = speed <= f64::from(self.contact.static_friction) * inward;
        let lost = if held { 1.0 } else { f64::from(self.contact.friction) * inward / speed };
        inward * normal - lost * along
    }

    /// The direction nearest to where a segment would go in which its end keeps its clearance. In a fold of the skin, behind
    /// an ear, that may be far off or not be found: then the one nearest to where the segment was, for it was free there.
    fn pushed_out(&self, direction: DVec3, touch: &Touch) -> DVec3 {
        let (pushed, depth) = self.pushed_from(direction, touch);
        if depth <= f64::from(TOLERANCE_CM) && pushed.dot(touch.was) > f64::from(NEAR) {
            return pushed;
        }
        let (stayed, depth_there) = self.pushed_from(touch.was, touch);
        if depth_there <= f64::from(TOLERANCE_CM) {
            return stayed;
        }
        let (mut best, mut least) = if depth_there < depth { (stayed, depth_there) } else { (pushed, depth) };
        // Where no turn is found so, a fan of directions from there outward.
        let normal = self.read(touch.from + touch.length * best, touch.surface).map_or(best, |(_, normal)| normal);
        for step in 1..=FAN {
            if least <= f64::from(TOLERANCE_CM) {
                break;
            }
            let aside = best.lerp(normal, step as f64 / FAN as f64).normalize_or(normal);
            let (direction, depth) = self.pushed_from(aside, touch);
            if depth < least {
                (best, least) = (direction, depth);
            }
        }
        best
    }

    /// Turns a segment along the gradient until its end keeps its clearance; how deep it then is.
    fn pushed_from(&self, mut direction: DVec3, touch: &Touch) -> (DVec3, f64) {
        let &Touch { from, length, clearance, .. } = touch;
        let mut depth = 0.0;
        for _ in 0..=PUSHES {
            let end = from + length * direction;
            let Some((distance, normal)) = self.read(end, touch.surface) else { return (direction, 0.0) };
            depth = clearance - distance;
            if depth <= f64::from(TOLERANCE_CM) {
                return (direction, depth);
            }
            direction = (end + depth * normal - from).normalize_or(normal);
        }
        (direction, depth)
    }

    /// Distance and outward normal at a point of head space; `None` far away.
    fn read(&self, p: DVec3, surface: Surface) -> Option<(f64, DVec3)> {
        let in_body = self.body_from_head.transform_point3(p);
        let (distance, gradient) = self.body.surface(surface).sample(in_body.as_vec3())?;
        let normal = gradient.as_dvec3().normalize_or(DVec3::Y);
        Some((f64::from(distance), self.body_from_head.matrix3.transpose() * normal))
    }
}

fn exact(affine: glam::Affine3A) -> DAffine3 {
    DAffine3 { matrix3: affine.matrix3.as_dmat3(), translation: affine.translation.as_dvec3() }
}
