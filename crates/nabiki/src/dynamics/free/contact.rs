//! Bodies in one frame, for the fast step: one node at a time, and only nodes that may touch.

use glam::{Affine3A, Vec3, Vec3A};

use crate::body::{Body, Shape, Surface};
use crate::distance::{Places, SkinDistance};
use crate::dynamics::FrameInput;
use crate::dynamics::row::{LANES, PointRow};
use crate::obstacle::{Obstacle, Reading, beyond};

/// Most turns of a segment along the gradient before another way is tried.
pub(in crate::dynamics) const PUSHES: usize = 7;

/// Most turns of a segment out of all bodies, one after the other, if there are several.
pub(in crate::dynamics) const ROUNDS: usize = 24;

/// Directions tried from there to the gradient if no turn along it is found.
pub(in crate::dynamics) const FAN: usize = 4;

/// Cosine and sine of the largest of these turns (a tenth of a radian): a curved surface is not a plane far away.
pub(in crate::dynamics) const TURN: [f32; 2] = [0.995_004_2, 0.099_833_42];

/// How much deeper than its clearance a node may stay (cm): a few roundings of a distance.
pub(in crate::dynamics) const TOLERANCE_CM: f32 = 1e-4;

/// Cosine of the largest turn that a push may give a segment in a frame, if a smaller one suffices (half a radian).
pub(in crate::dynamics) const NEAR: f32 = 0.877_582_6;

/// Factor by which the remaining inward motion of a pressed node increases the push in the next step. Stiff joints hold
/// a node, so it yields less than if it were alone.
pub(in crate::dynamics) const ANSWER: f32 = 3.0;

/// Distances may come out too large by a twentieth, see [`Obstacle::read`], and between the coarse samples of a filled
/// surface, 2 cm apart from 4 cm on, by h^2 / 8 times the sum of its curvatures, 2 / 4 cm at most: a sixteenth of 4 cm.
const SURE: f32 = 0.95 * 0.9;

/// A body where it is at the end of a step.
#[derive(Clone, Debug)]
pub(super) struct PlacedBody {
    frame: u32,
    static_friction: f32,
    friction: f32,
    margin: f32,
    body_from_head: Affine3A,
    /// Whether that is the identity.
    with_head: bool,
    /// Transforms points of the body from their place at the end of the step to that at its beginning, in head space; and the inverse.
    before_from_now: Affine3A,
    now_from_before: Affine3A,
    moves: bool,
    /// The largest distance that any of its points moves in its own space in the step (cm).
    bends: f32,
    /// Of the frame, and the share of the frame that is over at its end.
    part: f32,
    until: f32,
    /// The largest distance that any part of it within reach of hair moves (cm).
    pub closer: f32,
}

/// The end of a segment that turns around its beginning (head space, cm).
#[derive(Clone, Copy, Debug)]
pub(super) struct Touch {
    /// The current p_(i-1).
    pub from: Vec3,
    pub length: f32,
    /// Clearance of p_i from the skin.
    pub clearance: f32,
    /// d at the beginning of the step, turned back by the share of the head's turn that it is left behind.
    pub was: Vec3,
    /// The other motion of p_i in the step: of the segments before this one, and what the head's turn leaves behind.
    pub carried: Vec3,
}

/// A node at the beginning of a step (head space, cm and frames).
#[derive(Clone, Copy, Debug)]
pub(super) struct Moving {
    pub at: Vec3,
    /// How far skin has taken it along in this step; 0 without skin that moves.
    pub ridden: Vec3,
    /// How far that and the head's turn have moved it in this step.
    pub shifted: Vec3,
    pub velocity: Vec3,
    pub acceleration: Vec3,
    /// How strongly a body pushed it outward in the step before, including what it still moved inward.
    pub pressed: f32,
}

/// The effect of a body on a node (cm and frames): its acceleration, the outward part of it, and the distance from touching.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Push {
    pub force: Vec3,
    pub outward: f32,
    pub clear: f32,
    /// A lower bound of its distance from touching, see [`gap`].
    pub gap: f32,
}

/// Direction of a segment, and its turn in a step (rad).
#[derive(Clone, Copy, Debug)]
pub(super) struct Going {
    pub direction: Vec3,
    pub increment: Vec3,
}

impl Going {
    /// Without the part of the increment along the direction.
    fn new(direction: Vec3, increment: Vec3) -> Self {
        Self { direction, increment: increment - increment.dot(direction) * direction }
    }
}

/// A lower bound of how far a point at a sampled distance is from touching; negative if it touches. The whole distance may be off, not
/// only its excess over the clearance. Inside, where samples of different fineness meet, nothing is certain.
#[inline(always)]
pub(super) fn gap(distance: f32, clearance: f32) -> f32 {
    let (inward, sure) = (distance - clearance, SURE * distance - clearance.max(0.0));
    if inward < 0.0 { inward } else { sure.max(0.0) }
}

/// A surface of a body, for which contact is compiled.
enum Skin<'a> {
    Mesh(&'a SkinDistance),
    Other(&'a dyn Obstacle),
}

#[inline(always)]
fn skin(body: &Body, surface: Surface) -> Skin<'_> {
    match (surface, &body.filled, &body.shape) {
        (Surface::Filled, Some(filled), _) => Skin::Mesh(filled),
        (_, _, Shape::Mesh(skin)) => Skin::Mesh(skin),
        (_, _, Shape::Other(shape)) => Skin::Other(&**shape),
    }
}

impl PlacedBody {
    /// Body number `b` at the end of a step of a frame; `step` gives the step's number, from 1 on, and their count.
    /// `reach`: a ball that hair does not leave (head space, cm), and the most that a strand multiplies the margin by.
    pub fn new(b: usize, body: &Body, input: &FrameInput, [step, steps]: [u32; 2], reach: (Vec3, f32, f32)) -> Self {
        let (center, radius, times) = reach;
        let [now, before] = input.head_from_body(b, body, [step, steps]);
        let part = 1.0 / steps as f32;
        let mut placed = Self {
            frame: input.frame,
            static_friction: body.contact.static_friction,
            friction: body.contact.friction,
            margin: body.contact.margin * times,
            body_from_head: now.inverse(),
            with_head: now == Affine3A::IDENTITY,
            before_from_now: before * now.inverse(),
            now_from_before: now * before.inverse(),
            moves: now != before,
            bends: body.shape.obstacle().farthest_moved(input.frame) * part,
            part,
            until: step as f32 / steps as f32,
            closer: 0.0,
        };
        placed.closer = placed.farthest_moved(center, radius);
        placed
    }

    /// The largest distance that a point of the body within `radius` of `center` (head space, cm) moves in the step.
    fn farthest_moved(&self, center: Vec3, radius: f32) -> f32 {
        if !self.moves {
            return self.bends;
        }
        // |(B - 1) (p - c)| is at most the Frobenius norm of B - 1 times the radius.
        let turn = self.before_from_now.matrix3 - glam::Mat3A::IDENTITY;
        let norm = (turn.x_axis.length_squared() + turn.y_axis.length_squared() + turn.z_axis.length_squared()).sqrt();
        (self.before_from_now.transform_point3(center) - center).length() + norm * radius + self.bends
    }

    /// The positions of sixteen points of head space among the samples of a body that moves with the head.
    #[inline(always)]
    pub fn places(&self, skin: &SkinDistance, [x, y, z]: &PointRow) -> Option<Places<LANES>> {
        if self.with_head { Some(skin.places([&x.0, &y.0, &z.0])) } else { None }
    }

    /// A lower bound of how far the end of a segment (head space, cm) is from touching the body; negative if it
    /// touches.
    pub fn gap(&self, body: &Body, surface: Surface, end: Vec3, clearance: f32) -> f32 {
        match skin(body, surface) {
            Skin::Mesh(skin) => self.gap_to(skin, end, clearance),
            Skin::Other(shape) => self.gap_to(shape, end, clearance),
        }
    }

    /// Keeps a segment out of the body and returns how far its end moved inward in the step (cm); `None` if it touches nothing.
    #[inline(always)]
    pub fn stop(&self, body: &Body, surface: Surface, going: Going, touch: &Touch) -> Option<(Going, f32)> {
        match skin(body, surface) {
            Skin::Mesh(skin) => self.stop_at(skin, going, touch),
            Skin::Other(shape) => self.stop_at(shape, going, touch),
        }
    }

    /// Turns a segment out of the body after another body has turned it in; `None` if none has.
    pub fn part(&self, body: &Body, surface: Surface, going: Going, touch: &Touch) -> Option<Going> {
        match skin(body, surface) {
            Skin::Mesh(skin) => self.part_from(skin, going, touch),
            Skin::Other(shape) => self.part_from(shape, going, touch),
        }
    }

    /// How far a node that moves with the body is from touching it at the end of the step; `None` far away.
    pub fn clear(&self, body: &Body, surface: Surface, clearance: f32, node: &Moving) -> Option<f32> {
        match skin(body, surface) {
            Skin::Mesh(skin) => self.clear_of(skin, clearance, node),
            Skin::Other(shape) => self.clear_of(shape, clearance, node),
        }
    }

    /// The push of the body on a node in the step: against the motion inward, against what pressed it in the step before, and friction.
    /// Also the outward pressing part (cm per frame^2), and the distance of the node from the body (cm).
    pub fn against(&self, body: &Body, surface: Surface, clearance: f32, node: &Moving) -> Option<Push> {
        match skin(body, surface) {
            Skin::Mesh(skin) => self.against_at(skin, clearance, node),
            Skin::Other(shape) => self.against_at(shape, clearance, node),
        }
    }

    fn clear_of(&self, skin: &(impl Obstacle + ?Sized), clearance: f32, node: &Moving) -> Option<f32> {
        let along = self.taken_along(skin, node.at - node.ridden);
        Some(self.read(skin, along)?.distance - clearance)
    }

    fn against_at(&self, skin: &(impl Obstacle + ?Sized), clearance: f32, node: &Moving) -> Option<Push> {
        let h = self.part;
        let start = node.at - node.ridden;
        let carried = self.taken_along(skin, start);
        let reading = self.read(skin, carried)?;
        let of_body = carried - start - node.ridden;
        let normal = self.normal(&reading);
        // A node that is already too deep is turned out, not thrown out.
        let sure = self::gap(reading.distance, clearance);
        let gap = (reading.distance - clearance).max(0.0);
        let leaves = (h * node.velocity - of_body).dot(normal) + gap;
        let pressed = node.pressed * (h * h) - leaves.max(0.0);
        let moved = h * node.velocity + h * h * node.acceleration - of_body;
        let inward = (-(moved.dot(normal) + gap)).max(pressed);
        if inward <= 0.0 {
            return Some(Push { clear: gap, gap: sure, ..Push::default() });
        }
        let along = moved + (node.shifted - node.ridden);
        let over = 1.0 / (h * h);
        let force = over * self.slowed(along, normal, along.dot(normal), inward);
        // Speed is stopped once; a pressing force continues.
        let presses = (inward - (-leaves).max(0.0)).max(0.0);
        Some(Push { force, outward: over * presses, clear: gap, gap: sure })
    }

    /// Whether it stays fixed in head space, as the head does.
    pub fn rests(&self) -> bool {
        !self.moves && self.bends == 0.0
    }

    /// Where the body takes a point that moves with it in the step.
    fn taken_along(&self, skin: &(impl Obstacle + ?Sized), p: Vec3) -> Vec3 {
        let p = if self.moves { self.now_from_before.transform_point3(p) } else { p };
        if self.bends > 0.0 { p + self.bent(skin, self.in_body(p)) } else { p }
    }

    /// The distance at a point of head space at the end of the step; `None` far away.
    #[inline(always)]
    fn read(&self, skin: &(impl Obstacle + ?Sized), p: Vec3) -> Option<Reading> {
        skin.read_during(self.in_body(p), self.frame, self.until)
    }

    /// The motion of a point by the bending of the body in the step, besides the motion of its space.
    fn bent(&self, skin: &(impl Obstacle + ?Sized), in_body: Vec3) -> Vec3 {
        let head_from_body = self.body_from_head.matrix3.transpose();
        Vec3::from(head_from_body * Vec3A::from(skin.moved(in_body, self.frame))) * self.part
    }

    fn gap_to(&self, skin: &(impl Obstacle + ?Sized), end: Vec3, clearance: f32) -> f32 {
        match self.read(skin, end) {
            Some(reading) => gap(reading.distance, clearance).min((skin.exact_within() - clearance).max(0.0)),
            None => beyond(skin.reach(), self.in_body(end)) - self.margin,
        }
    }

    #[inline(always)]
    fn stop_at(&self, skin: &(impl Obstacle + ?Sized), going: Going, touch: &Touch) -> Option<(Going, f32)> {
        let &Touch { from, length, clearance, carried, .. } = touch;
        let end = from + length * going.direction;
        let reading = self.read(skin, end)?;
        let depth = clearance - reading.distance;
        if depth <= 0.0 {
            return None;
        }
        let normal = self.normal(&reading);
        let mut of_body = if self.moves { end - self.before_from_now.transform_point3(end) } else { Vec3::ZERO };
        if self.bends > 0.0 {
            of_body += self.bent(skin, self.in_body(end));
        }
        let moved = length * going.increment + carried - of_body;
        // Outward motion loses nothing: for 0 everything below is 0.
        let inward = (-moved.dot(normal)).max(0.0);
        let change = self.slowed(moved, normal, -inward, inward);
        // Until it touched, it moved as before.
        let touching = if inward > depth { depth / inward } else { 1.0 };
        let direction = (length * going.direction + touching * change).normalize_or(normal);
        let increment = going.increment + change / length;
        Some((Going::new(self.pushed_out(skin, direction, touch), increment), inward))
    }

    fn part_from(&self, skin: &(impl Obstacle + ?Sized), going: Going, touch: &Touch) -> Option<Going> {
        let reading = self.read(skin, touch.from + touch.length * going.direction)?;
        if touch.clearance - reading.distance <= TOLERANCE_CM {
            return None;
        }
        let (direction, _) = self.pushed_from(skin, going.direction, touch);
        Some(Going::new(direction, going.increment))
    }

    /// The effect of contact on a motion against the body: `inward` of it is reversed, and friction takes its share of
    /// the motion along the skin. `outward`: all of the motion along the normal.
    #[inline(always)]
    fn slowed(&self, moved: Vec3, normal: Vec3, outward: f32, inward: f32) -> Vec3 {
        let along = moved - outward * normal;
        let speed = along.length();
        let held = speed <= self.static_friction * inward;
        let lost = if held { 1.0 } else { self.friction * inward / speed };
        inward * normal - lost * along
    }

    /// The direction nearest to the segment's own in which its end keeps its clearance. In a fold of the skin, behind an ear, that may be
    /// far off or not be found: then the one nearest to the segment's old direction, which was free.
    fn pushed_out(&self, skin: &(impl Obstacle + ?Sized), direction: Vec3, touch: &Touch) -> Vec3 {
        let (pushed, depth) = self.pushed_from(skin, direction, touch);
        if depth <= TOLERANCE_CM && pushed.dot(touch.was) > NEAR {
            return pushed;
        }
        let (stayed, depth_there) = self.pushed_from(skin, touch.was, touch);
        if depth_there <= TOLERANCE_CM {
            return stayed;
        }
        let (mut best, mut least) = if depth_there < depth { (stayed, depth_there) } else { (pushed, depth) };
        // If no turn is found this way, tries a fan of directions from there outward.
        let reading = self.read(skin, touch.from + touch.length * best);
        let normal = reading.map_or(best, |reading| self.normal(&reading));
        for step in 1..=FAN {
            if least <= TOLERANCE_CM {
                break;
            }
            let aside = best.lerp(normal, step as f32 / FAN as f32).normalize_or(normal);
            let (direction, depth) = self.pushed_from(skin, aside, touch);
            if depth < least {
                (best, least) = (direction, depth);
            }
        }
        best
    }

    /// Turns a segment out along the gradient until its end keeps its clearance, and returns its depth then.
    #[inline]
    fn pushed_from(&self, skin: &(impl Obstacle + ?Sized), mut direction: Vec3, touch: &Touch) -> (Vec3, f32) {
        let &Touch { from, length, clearance, .. } = touch;
        let mut pushes = 0;
        loop {
            let end = from + length * direction;
            let Some(reading) = self.read(skin, end) else { return (direction, 0.0) };
            let depth = clearance - reading.distance;
            if depth <= TOLERANCE_CM || pushes == PUSHES {
                return (direction, depth);
            }
            let normal = self.normal(&reading);
            direction = turned_out(direction, normal, depth / length);
            pushes += 1;
        }
    }

    #[inline(always)]
    fn in_body(&self, p: Vec3) -> Vec3 {
        if self.with_head { p } else { self.body_from_head.transform_point3(p) }
    }

    /// Outward, of length 1, in head space.
    #[inline(always)]
    fn normal(&self, reading: &Reading) -> Vec3 {
        let normal = reading.gradient.normalize_or(Vec3::Y);
        if self.with_head {
            return normal;
        }
        // The transpose turns back.
        Vec3::from(self.body_from_head.matrix3.transpose() * Vec3A::from(normal))
    }
}

/// Turned around its beginning, the shortest way, until its end is farther out along the normal by `rise` of its
/// length: all the way out of a plane, however steeply it points in. At most by [`TURN`].
#[inline]
fn turned_out(direction: Vec3, normal: Vec3, rise: f32) -> Vec3 {
    let along = direction.dot(normal);
    let [cos, sin] = TURN;
    let farthest = if along < cos { along * cos + (1.0 - along * along).max(0.0).sqrt() * sin } else { 1.0 };
    let outward = (along + rise).min(farthest);
    if outward >= 1.0 {
        return normal;
    }
    // For a segment that points straight in, all ways are alike.
    let aside = (direction - along * normal).try_normalize().unwrap_or_else(|| normal.any_orthonormal_vector());
    ((1.0 - outward * outward).max(0.0).sqrt() * aside + outward * normal).normalize_or(normal)
}
