//! A body in one frame, as the f64 stepper meets it.

use glam::{DAffine3, DVec3};

use crate::body::{Body, Contact};
use crate::distance::SkinDistance;
use crate::dynamics::FrameInput;
use crate::dynamics::free::{PUSHES, TOLERANCE_CM};
use crate::pose::Pose;

/// How far each point is kept from the skin of a body (cm): its margin, or as far as it lies at rest where that is less.
pub fn clearances(body: &Body, rest_pose: &Pose, positions: &[DVec3]) -> Vec<f64> {
    let margin = f64::from(body.contact.margin);
    let body_from_head = exact(body.head_from_body(0, rest_pose)).inverse();
    let distance = |p: &DVec3| read(&body.distance, body_from_head.transform_point3(*p)).map_or(margin, |(d, _)| d);
    positions.iter().map(|p| distance(p).min(margin)).collect()
}

/// A body in one frame.
pub struct Obstacle<'a> {
    distance: &'a SkinDistance,
    contact: Contact,
    body_from_head: DAffine3,
    /// Takes points of the body from where they are to where they were in the frame before, in head space.
    before_from_now: DAffine3,
}

/// The end of a segment on its way from one frame to the next (head space, cm).
pub struct Touch {
    /// p_(i-1), where it is now.
    pub from: DVec3,
    /// p_i, where it was.
    pub end_before: DVec3,
    pub length: f64,
    /// How far p_i is kept from the skin.
    pub clearance: f64,
}

impl<'a> Obstacle<'a> {
    pub fn new(body: &'a Body, input: &FrameInput) -> Self {
        let now = exact(body.head_from_body(input.frame, &input.pose));
        let before = exact(body.head_from_body(input.frame - 1, &input.before[0]));
        Self {
            distance: &body.distance,
            contact: body.contact,
            body_from_head: now.inverse(),
            before_from_now: before * now.inverse(),
        }
    }

    /// Keeps a segment that would go along `direction`, with this `increment`, out of the body.
    pub fn stop(&self, mut direction: DVec3, mut increment: DVec3, touch: &Touch) -> (DVec3, DVec3) {
        let &Touch { from, end_before, length, clearance } = touch;
        let end = from + length * direction;
        let Some((distance, normal)) = self.read(end) else { return (direction, increment) };
        if distance >= clearance {
            return (direction, increment);
        }
        let of_body = end - self.before_from_now.transform_point3(end);
        let change = self.slowed((end - end_before) - of_body, normal);
        direction = (end + change - from).normalize_or(normal);
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

    /// Turns a segment until its end keeps its clearance; along the gradient where no turn does that.
    fn pushed_out(&self, mut direction: DVec3, touch: &Touch) -> DVec3 {
        let &Touch { from, length, clearance, .. } = touch;
        for _ in 0..PUSHES {
            let end = from + length * direction;
            let Some((distance, normal)) = self.read(end) else { return direction };
            if distance >= clearance - f64::from(TOLERANCE_CM) {
                return direction;
            }
            direction = (end + (clearance - distance) * normal - from).normalize_or(normal);
        }
        let depth = |direction: DVec3| self.read(from + length * direction).map_or(f64::INFINITY, |(d, _)| d);
        match self.read(from + length * direction) {
            Some((distance, normal)) if distance < clearance - f64::from(TOLERANCE_CM) && depth(normal) > distance => {
                normal
            }
            _ => direction,
        }
    }

    /// Distance and outward normal at a point of head space; `None` far away.
    fn read(&self, p: DVec3) -> Option<(f64, DVec3)> {
        let (distance, normal) = read(self.distance, self.body_from_head.transform_point3(p))?;
        Some((distance, self.body_from_head.matrix3.transpose() * normal))
    }
}

fn read(distance: &SkinDistance, p: DVec3) -> Option<(f64, DVec3)> {
    let (distance, gradient) = distance.sample(p.as_vec3())?;
    Some((f64::from(distance), gradient.as_dvec3().normalize_or(DVec3::Y)))
}

fn exact(affine: glam::Affine3A) -> DAffine3 {
    DAffine3 { matrix3: affine.matrix3.as_dmat3(), translation: affine.translation.as_dvec3() }
}
