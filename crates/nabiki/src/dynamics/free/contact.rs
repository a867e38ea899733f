//! Bodies in one frame, as the fast step meets them: one node at a time, and only those that may touch.

use glam::{Affine3A, Vec3};

use crate::body::Body;
use crate::distance::SkinDistance;
use crate::dynamics::FrameInput;
use crate::pose::Pose;

/// Times that a segment is turned along the gradient before another way is tried.
pub(in crate::dynamics) const PUSHES: usize = 4;

/// How much deeper than its clearance a node may stay (cm): some roundings of a distance.
pub(in crate::dynamics) const TOLERANCE_CM: f32 = 1e-4;

/// Distances between nodes of the samples may come out too large by a twentieth, see [`SkinDistance::at`].
const SURE: f32 = 0.95;

/// A body in one frame.
#[derive(Clone, Debug)]
pub(super) struct Obstacle {
    static_friction: f32,
    friction: f32,
    margin: f32,
    body_from_head: Affine3A,
    /// Takes points of the body from where they are to where they were in the frame before, in head space.
    before_from_now: Affine3A,
    moves: bool,
}

/// The end of a segment on its way from one frame to the next (head space, cm).
#[derive(Clone, Copy, Debug)]
pub(super) struct Touch {
    /// p_(i-1), where it is now.
    pub from: Vec3,
    /// p_i, where it was.
    pub end_before: Vec3,
    pub length: f32,
    /// How far p_i is kept from the skin.
    pub clearance: f32,
}

/// Direction and increment of a segment.
#[derive(Clone, Copy, Debug)]
pub(super) struct Going {
    pub direction: Vec3,
    pub increment: Vec3,
}

/// How far a point is kept from the skin of a body (cm): its margin, or as far as it lies at rest where that is less.
pub(super) fn clearance(body: &Body, rest_pose: &Pose, p: Vec3) -> f32 {
    let body_from_head = body.head_from_body(0, rest_pose).inverse();
    let margin = body.contact.margin;
    body.distance.sample(body_from_head.transform_point3(p)).map_or(margin, |(distance, _)| distance.min(margin))
}

impl Obstacle {
    pub fn new(body: &Body, input: &FrameInput) -> Self {
        let now = body.head_from_body(input.frame, &input.pose);
        let before = body.head_from_body(input.frame - 1, &input.before[0]);
        Self {
            static_friction: body.contact.static_friction,
            friction: body.contact.friction,
            margin: body.contact.margin,
            body_from_head: now.inverse(),
            before_from_now: before * now.inverse(),
            moves: now != before,
        }
    }

    /// The farthest that a point of the body within `radius` of `center` (head space, cm) has moved in the frame.
    pub fn farthest_moved(&self, center: Vec3, radius: f32) -> f32 {
        if !self.moves {
            return 0.0;
        }
        // |(B - 1) (p - c)| is at most the Frobenius norm of B - 1 times the radius.
        let turn = self.before_from_now.matrix3 - glam::Mat3A::IDENTITY;
        let norm = (turn.x_axis.length_squared() + turn.y_axis.length_squared() + turn.z_axis.length_squared()).sqrt();
        (self.before_from_now.transform_point3(center) - center).length() + norm * radius
    }

    /// Keeps a segment out of the body, and says how far its end then is from touching it (cm, a lower bound).
    pub fn stop(&self, skin: &SkinDistance, going: Going, touch: &Touch) -> (Going, f32) {
        let &Touch { from, end_before, length, clearance } = touch;
        let end = from + length * going.direction;
        let (distance, normal) = match self.read(skin, end) {
            Ok(read) => read,
            Err(beyond) => return (going, beyond - self.margin),
        };
        if distance >= clearance {
            return (going, SURE * (distance - clearance));
        }
        let of_body = if self.moves { end - self.before_from_now.transform_point3(end) } else { Vec3::ZERO };
        let change = self.slowed((end - end_before) - of_body, normal);
        let direction = (end + change - from).normalize_or(normal);
        let increment = going.increment + change / length;
        let direction = self.pushed_out(skin, direction, touch);
        (Going { direction, increment: increment - increment.dot(direction) * direction }, 0.0)
    }

    /// What contact takes of a motion against the body: all of it that goes inward, and of the rest what friction takes.
    fn slowed(&self, moved: Vec3, normal: Vec3) -> Vec3 {
        let inward = -moved.dot(normal);
        if inward <= 0.0 {
            return Vec3::ZERO;
        }
        let along = moved + inward * normal;
        let speed = along.length();
        let held = speed <= self.static_friction * inward;
        let lost = if held { 1.0 } else { self.friction * inward / speed };
        inward * normal - lost * along
    }

    /// Turns a segment until its end keeps its clearance; along the gradient where no turn does that.
    fn pushed_out(&self, skin: &SkinDistance, mut direction: Vec3, touch: &Touch) -> Vec3 {
        let &Touch { from, length, clearance, .. } = touch;
        for _ in 0..PUSHES {
            let end = from + length * direction;
            let Ok((distance, normal)) = self.read(skin, end) else { return direction };
            if distance >= clearance - TOLERANCE_CM {
                return direction;
            }
            direction = (end + (clearance - distance) * normal - from).normalize_or(normal);
        }
        let depth = |direction: Vec3| self.read(skin, from + length * direction).map_or(f32::INFINITY, |(d, _)| d);
        match self.read(skin, from + length * direction) {
            Ok((distance, normal)) if distance < clearance - TOLERANCE_CM && depth(normal) > distance => normal,
            _ => direction,
        }
    }

    /// Distance and outward normal at a point of head space, or how far away at least it is where nothing was sampled.
    fn read(&self, skin: &SkinDistance, p: Vec3) -> Result<(f32, Vec3), f32> {
        let in_body = self.body_from_head.transform_point3(p);
        let (distance, gradient) = skin.sample(in_body).ok_or_else(|| skin.beyond_box(in_body))?;
        let normal = gradient.normalize_or(Vec3::Y);
        // The transpose turns back.
        Ok((distance, Vec3::from(self.body_from_head.matrix3.transpose() * glam::Vec3A::from(normal))))
    }
}
