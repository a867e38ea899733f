//! One strand, and the step that moves it, over any scalar.

use glam::{DQuat, DVec3, Vec3};

use super::aimed::Aimed;
use super::chain::{Chain, ROUNDS_PRESSED};
use super::common::Common;
use super::contact::{Moving, PlacedBody, Touch, kept_from};
use crate::body::Surface;
use crate::dynamics::Dynamics;
use crate::dynamics::air::Air;
use crate::dynamics::free::grid::Crowd;
use crate::dynamics::free::pulls::{neighbours, weight};
use crate::dynamics::free::segment::{FreeSegment, free_segments};
use crate::dynamics::free::{ANSWER, ROUNDS};
use crate::dynamics::ride::Ride;
use crate::error::SettingError;
use crate::free_form::FreeMotion;
use crate::locks::Own;
use crate::region::FieldShares;
use crate::scalar::{Scalar, Turn, Vector};
use crate::skin::{SkinFrame, SkinPlace};

/// A strand at some frame.
#[derive(Clone, Debug)]
pub(in crate::dynamics) struct Strand<S> {
    segments: Vec<Segment<S>>,
    chain: Chain<S>,
    /// The acceleration of each node by field and neighbours in a frame (cm per frame^2).
    blown: Vec<Vector<S>>,
    /// For each segment, the rounding error that the solve leaves at rest.
    residual: Vec<Vector<S>>,
    /// Root first (head space, cm).
    positions: Vec<Vector<S>>,
    /// How far skin has taken each point along in a step, and how far in all that and the head's turn have moved it.
    ridden: Vec<Vector<S>>,
    shifted: Vec<Vector<S>>,
    /// The distance of each node from touching a body at the beginning of a step.
    clear: Vec<S>,
    /// For each body, the surface that every point is kept out of, and at what distance (cm).
    kept_from: Vec<Vec<(Surface, f64)>>,
    /// The node that the head carries: the root, or the last one that a tie holds.
    anchor: usize,
    /// How it differs from the settings.
    own: Own,
    /// Its shares in the fields.
    shares: FieldShares,
    /// The place of the skin that carries its root, and that point of it at rest.
    on_skin: Option<(SkinPlace, DVec3)>,
    /// The aims that lead it.
    aims: Aimed,
    /// How that place carries it in this frame.
    ride: Option<Ride>,
    /// Whether a step has shifted its points.
    is_shifted: bool,
}

/// One segment: its direction d at frame n and its increment w (rad a frame), normal to d; both in head space.
#[derive(Clone, Debug)]
pub(super) struct Segment<S> {
    pub moved_by: FreeSegment,
    /// B of the joint at its beginning.
    pub bending: S,
    /// The share of its end's speed that the air takes.
    air: S,
    pub direction: Vector<S>,
    pub increment: Vector<S>,
    /// Twist of the joint at its beginning (rad).
    pub twist: S,
    /// How strongly a body pushes its end outward (cm per frame^2).
    pressed: S,
    /// Where the aims of this step lead it, and their moment per radian; none if none acts.
    pub aimed: Option<(Vector<S>, f64)>,
}

/// Factors on the settings, which may be unknowns.
pub(in crate::dynamics) struct Springs<S> {
    /// Of the stiffness.
    pub stiffness: S,
    /// Of the frames in which a swing settles.
    pub settle: S,
}

impl<S: Scalar> Default for Springs<S> {
    /// The settings unchanged.
    fn default() -> Self {
        Self { stiffness: S::from(1.0), settle: S::from(1.0) }
    }
}

impl<S: Scalar> Segment<S> {
    fn new(moved_by: FreeSegment, springs: &Springs<S>) -> Self {
        let FreeSegment { rest, bending, air, .. } = moved_by;
        let (bending, air) = (springs.stiffness.times(bending), S::from(air) / springs.settle);
        Self {
            moved_by,
            bending,
            air,
            direction: rest.into(),
            increment: Vector::zero(),
            twist: S::from(0.0),
            pressed: S::from(0.0),
            aimed: None,
        }
    }

    /// Leaves it behind by `share` of the head's turn.
    fn stay_behind(&mut self, axis: DVec3, angle: f64, share: f64) {
        let back = Turn::from(DQuat::from_axis_angle(axis, -self.moved_by.drag * share * angle));
        self.direction = back.of(self.direction);
        self.increment = back.of(self.increment);
    }

    /// Moves it through a step of `h` frames with the increment w at the end: the new direction, and the increment carried there.
    #[inline(always)]
    fn moved(&self, w: Vector<S>, h: f64) -> (Vector<S>, Vector<S>) {
        let d = self.direction;
        // The rest that the lengths leave, and no more than about an eighth of a turn.
        let mut w = w - d * w.dot(d);
        let speed = w.length_squared().times(h * h);
        if speed.value() > 1.0 {
            w = w * (S::from(1.0) / speed.sqrt());
        }
        let way = w.times(h);
        if way == Vector::zero() {
            return (d, w);
        }
        let there = (d + way) / (d + way).length();
        (there, w - (d + there) * (w.dot(there) / (S::from(1.0) + d.dot(there))))
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
        let segments = free_segments(dynamics, free, strand, s)?;
        let aims = Aimed::of(free, strand, &segments, dynamics.skin.as_deref());
        let anchor = segments.iter().take_while(|segment| segment.lightness == 0.0).count();
        let segments: Vec<_> = segments.into_iter().map(|moved_by| Segment::new(moved_by, springs)).collect();
        let positions: Vec<Vector<S>> = strand.iter().map(|p| p.as_dvec3().into()).collect();
        let own = free.own(strand);
        let (none, shifted) = (vec![Vector::zero(); segments.len()], vec![Vector::zero(); strand.len()]);
        let chain = Chain::new(segments.len());
        let (clear, meets) = (vec![S::from(f64::INFINITY); segments.len()], Vec::new());
        let (blown, residual) = (none.clone(), none);
        let place = dynamics.skin.as_ref().map(|skin| skin.place(strand[0]));
        let mut strand = Self {
            segments,
            chain,
            blown,
            residual,
            positions,
            ridden: shifted.clone(),
            shifted,
            clear,
            kept_from: meets,
            anchor,
            own,
            shares: free.shares(strand[0]),
            on_skin: place.map(|place| (place, strand[anchor].as_dvec3())),
            aims,
            ride: None,
            is_shifted: false,
        };
        strand.place();
        let at_rest: Vec<DVec3> = strand.positions.iter().map(|p| p.value()).collect();
        strand.kept_from =
            free.bodies.iter().map(|body| kept_from(body, &free.rest_pose, &at_rest, own.margin)).collect();
        strand.take_rest(free);
        if let Some(skin) = &dynamics.skin {
            strand.rest_on(skin.at(0));
        }
        Ok(strand)
    }

    /// Stores the rounding error that the solve leaves at rest.
    fn take_rest(&mut self, free: &FreeMotion) {
        let Self { segments, chain, residual, own, .. } = self;
        let weight = Vector::from(own.weight * weight::on_head(&free.rest_pose, f64::from(free.form.gravity)));
        for (i, segment) in segments.iter().enumerate() {
            chain.pushed[i] = weight.times(segment.moved_by.push);
            chain.drag[i] = segment.air;
        }
        chain.bend(segments);
        residual.copy_from_slice(chain.drive(segments));
    }

    /// A strand in the state of another, with constants for all numbers.
    pub fn of_known(known: &Strand<f64>) -> Self {
        let segment = |segment: &Segment<f64>| Segment {
            moved_by: segment.moved_by,
            bending: S::from(segment.bending),
            air: S::from(segment.air),
            direction: segment.direction.value().into(),
            increment: segment.increment.value().into(),
            twist: S::from(segment.twist),
            pressed: S::from(segment.pressed),
            aimed: None,
        };
        let vectors = |of: &[Vector<f64>]| of.iter().map(|v| v.value().into()).collect::<Vec<Vector<S>>>();
        Self {
            segments: known.segments.iter().map(segment).collect(),
            chain: Chain::new(known.segments.len()),
            blown: vectors(&known.blown),
            residual: vectors(&known.residual),
            positions: vectors(&known.positions),
            ridden: vec![Vector::zero(); known.positions.len()],
            shifted: vec![Vector::zero(); known.positions.len()],
            clear: vec![S::from(f64::INFINITY); known.segments.len()],
            kept_from: known.kept_from.clone(),
            anchor: known.anchor,
            own: known.own,
            shares: known.shares.clone(),
            on_skin: known.on_skin,
            aims: known.aims.clone(),
            ride: None,
            is_shifted: false,
        }
    }

    /// Root first (head space, cm).
    pub fn positions(&self) -> &[Vector<S>] {
        &self.positions
    }

    /// The motion of every point by the increments alone in a frame (cm).
    pub fn velocities(&self) -> impl Iterator<Item = DVec3> {
        let moved = self.segments.iter().scan(DVec3::ZERO, |velocity, segment| {
            *velocity += segment.moved_by.shape.length * segment.increment.value();
            Some(*velocity)
        });
        std::iter::once(DVec3::ZERO).chain(moved)
    }

    /// Moves it by one frame. `crowd`: the neighbours' grid of the frame before.
    #[inline(always)]
    pub fn step(&mut self, common: &Common, air: &impl Air<S>, crowd: Option<&Crowd>) {
        let carrier = self.on_skin.as_ref().zip(common.skin.as_ref());
        let ride = carrier.map(|((place, anchor), skin)| skin.ride(place, *anchor));
        let (steps, turn) = (common.bodies.len() as u32, ride.map_or(common.head.turn, |ride| ride.turn));
        let share = 1.0 / f64::from(steps);
        self.ride = ride;
        for (n, bodies) in (1..).zip(&common.bodies) {
            self.is_shifted = ride.is_some() || turn.is_some();
            if let Some(ride) = ride.as_ref().filter(|_| n == 1) {
                // Where the skin was, which may have jumped.
                self.positions[0] = ride.at(0, steps).0.into();
                self.place();
            }
            if self.is_shifted {
                self.shifted.copy_from_slice(&self.positions);
            }
            if let Some(ride) = &ride {
                self.go_along(ride, n, steps);
            }
            if n == 1 {
                self.blow(common, air, crowd);
                self.calm(common.frame);
            }
            self.aim(common.frame);
            if let Some((axis, angle)) = turn {
                self.segments.iter_mut().for_each(|segment| segment.stay_behind(axis, angle, share));
                self.place();
            }
            if self.is_shifted {
                for (shifted, p) in self.shifted.iter_mut().zip(&self.positions) {
                    *shifted = *p - *shifted;
                }
            }
            self.chain.bend(&mut self.segments);
            self.push(common, bodies);
            self.solve(share, false);
            // Joints hold a pressed node, so it does not move as pushed: tensions need not take the other nodes there.
            if self.segments.iter().any(|segment| segment.pressed.value() > 0.0) {
                for _ in 0..ROUNDS_PRESSED {
                    self.chain.answer(&self.segments, share);
                    self.solve(share, true);
                }
            }
            self.go(bodies, share);
        }
    }

    /// Sets where the aims lead the segments.
    #[inline(always)]
    fn aim(&mut self, frame: u32) {
        let strength = self.aims.strength(frame);
        for (i, segment) in self.segments.iter_mut().enumerate() {
            segment.aimed = (strength > 0.0).then(|| {
                let toward = self.chain.turned_from_rest(self.aims.toward(i, frame));
                (toward, strength * segment.moved_by.lever)
            });
        }
    }

    /// Slows its nodes while aims lead it.
    #[inline(always)]
    fn calm(&mut self, frame: u32) {
        let calming = self.aims.calming(frame);
        if calming > 0.0 {
            self.chain.drag.iter_mut().for_each(|drag| *drag += S::from(calming));
        }
    }

    /// Takes it along with its skin in step `n` of the `steps` of the frame.
    #[inline(always)]
    fn go_along(&mut self, ride: &Ride, n: u32, steps: u32) {
        let (root, from_rest) = ride.at(n, steps);
        let carried = ride.carried(1.0 / f64::from(steps));
        self.chain.from_rest = Some(from_rest.into());
        for segment in &mut self.segments {
            if segment.moved_by.lightness == 0.0 {
                segment.direction = self.chain.turned_from_rest(segment.moved_by.rest);
            } else if carried != DQuat::IDENTITY {
                let carried = Turn::from(carried);
                segment.direction = carried.of(segment.direction);
                segment.increment = carried.of(segment.increment);
            }
        }
        self.ridden.copy_from_slice(&self.positions);
        self.positions[0] = root.into();
        self.place();
        for (ridden, p) in self.ridden.iter_mut().zip(&self.positions) {
            *ridden = *p - *ridden;
        }
    }

    /// Puts it to rest on skin of this shape.
    fn rest_on(&mut self, skin: &SkinFrame) {
        let Some((place, _)) = &self.on_skin else { return };
        let turn = place.turn(skin);
        self.positions[0] = place.root(skin).into();
        if turn != DQuat::IDENTITY {
            self.segments.iter_mut().for_each(|segment| segment.direction = (turn * segment.moved_by.rest).into());
        }
        self.place();
    }

    /// Finds the tensions, and the increments at the end of a step of `h` frames.
    #[inline(always)]
    fn solve(&mut self, h: f64, pressed: bool) {
        for (driven, residual) in self.chain.drive(&self.segments).iter_mut().zip(&self.residual) {
            *driven = *driven - *residual;
        }
        self.chain.solve(&self.segments, h, pressed);
    }

    /// Evaluates what acts once a frame: the field and the neighbours.
    #[inline(always)]
    fn blow(&mut self, common: &Common, air: &impl Air<S>, crowd: Option<&Crowd>) {
        let (times, turn) = self.own.wind(common.frame);
        for (i, segment) in self.segments.iter().enumerate() {
            let (end, FreeSegment { shape, push, .. }) = (self.positions[i + 1], segment.moved_by);
            let field = air.force(end, &self.shares);
            let weakened = common.gamma.contains(end.value(), field.value().as_vec3());
            let field = (field + Vector::from(turn).cross(field)).times(times);
            let mut force = field.times(if weakened { shape.eps() } else { 1.0 });
            self.chain.drag[i] = segment.air;
            if let Some(crowd) = crowd {
                let (pressed, held) = neighbours::force(crowd, end);
                force += pressed;
                self.chain.drag[i] += held.times(push);
            }
            self.blown[i] = force.times(push);
        }
    }

    /// All acceleration of the nodes except by the chain.
    #[inline(always)]
    fn push(&mut self, common: &Common, bodies: &[PlacedBody]) {
        let head = &common.head;
        let root = self.positions[self.anchor];
        let [velocity, acceleration] = match (&self.ride, &head.way) {
            (Some(ride), _) => [ride.velocity.into(), ride.acceleration.into()],
            (None, Some(way)) => [root.taken_by(&way.velocity), root.taken_by(&way.acceleration)],
            (None, None) => [Vector::zero(); 2],
        };
        for (i, segment) in self.segments.iter_mut().enumerate() {
            let FreeSegment { push, drag, lightness, .. } = segment.moved_by;
            let still_air = acceleration + velocity * segment.air;
            let other = self.blown[i] - still_air.times(drag);
            let weight = Vector::from(self.own.weight * head.weight).times(push);
            self.chain.pushed[i] = other + weight;
            self.clear[i] = S::from(f64::INFINITY);
            if bodies.is_empty() || lightness == 0.0 {
                continue;
            }
            // A body carries what the weight that balances the rest presses on it.
            let carried = self.chain.frames[i].of_known(self.own.weight * common.rest_weight).times(push);
            let speed = self.chain.velocities[i + 1];
            let net = other + (weight - carried) - speed * self.chain.drag[i];
            let (at, shifted) = (self.positions[i + 1], self.shifted[i + 1]);
            let shifted = if self.is_shifted { shifted } else { Vector::zero() };
            let none = S::from(0.0);
            let ridden = self.ridden[i + 1];
            let moving = Moving { at, ridden, shifted, velocity: speed, acceleration: net, pressed: none };
            let clear = |b: usize| bodies[b].clear(self.kept_from[b][i + 1], &moving);
            // The push of the step before belongs to the nearest body.
            let nearest = (1..bodies.len()).fold(0, |nearest, b| if clear(b) < clear(nearest) { b } else { nearest });
            let before = std::mem::replace(&mut segment.pressed, none);
            for (b, body) in bodies.iter().enumerate() {
                let pressed = if b == nearest { before } else { none };
                let push = body.against(self.kept_from[b][i + 1], &Moving { pressed, ..moving });
                if let Some((against, pushed, clear)) = push {
                    self.chain.pushed[i] += against;
                    if b == nearest {
                        (segment.pressed, self.clear[i]) = (pushed, clear);
                    }
                }
            }
        }
    }

    /// Turns the segments as the solve says, and out of bodies, from root to tip.
    #[inline(always)]
    fn go(&mut self, bodies: &[PlacedBody], h: f64) {
        let Self { segments, chain, positions, shifted, clear, kept_from, is_shifted, .. } = self;
        // Of p_(i-1).
        let mut velocity = Vector::zero();
        for (i, segment) in segments.iter_mut().enumerate() {
            let from = positions[i];
            let length = segment.moved_by.shape.length;
            let (mut direction, mut increment) = segment.moved(chain.solved(i), h);
            // Held segments move with the head in any case.
            let bodies = if segment.moved_by.lightness == 0.0 { &[][..] } else { bodies };
            if !bodies.is_empty() {
                let left_behind = if *is_shifted { shifted[i + 1] } else { Vector::zero() };
                let (was, carried) = (segment.direction, velocity.times(h) + left_behind);
                let touched = |b: usize| {
                    let (surface, clearance) = kept_from[b][i + 1];
                    Touch { from, length, clearance, was, carried, surface }
                };
                if let Some((there, turned, inward)) = kept_out(bodies, (direction, increment.times(h)), touched) {
                    (direction, increment) = (there, turned.times(1.0 / h));
                    // Only beyond the motion it had: the part that was stopped is not what presses it.
                    let beyond = inward - clear[i];
                    if beyond.value() > 0.0 {
                        segment.pressed += beyond.times(f64::from(ANSWER) / (h * h));
                    }
                }
            }
            velocity += increment.times(length);
            (segment.direction, segment.increment) = (direction, increment);
            positions[i + 1] = from + direction.times(length);
        }
    }

    /// Computes the points of the strand from its root outward.
    fn place(&mut self) {
        let mut p = self.positions[0];
        for (segment, position) in self.segments.iter().zip(&mut self.positions[1..]) {
            p += segment.direction.times(segment.moved_by.shape.length);
            *position = p;
        }
    }
}

/// Keeps a segment that would move along this direction, by this turn, out of all bodies, and returns how far its end moved inward (cm);
/// `None` if it touches none. A turn out of one body may lead into another: this alternates until the segment leaves the corner.
#[inline(always)]
fn kept_out<S: Scalar>(
    bodies: &[PlacedBody],
    (mut direction, mut turned): (Vector<S>, Vector<S>),
    touched: impl Fn(usize) -> Touch<S>,
) -> Option<(Vector<S>, Vector<S>, S)> {
    let (mut stopped, mut inward) = (false, S::from(0.0));
    for (b, body) in bodies.iter().enumerate() {
        if let Some((out, left, went)) = body.stop(direction, turned, &touched(b)) {
            ((direction, turned), stopped) = ((out, left), true);
            inward = if went.value() > inward.value() { went } else { inward };
        }
    }
    if !stopped {
        return None;
    }
    let mut rounds = if bodies.len() > 1 { ROUNDS } else { 0 };
    while stopped && rounds > 0 {
        stopped = false;
        for (b, body) in bodies.iter().enumerate() {
            if let Some(there) = body.part(direction, turned, &touched(b)) {
                ((direction, turned), stopped) = (there, true);
            }
        }
        rounds -= 1;
    }
    Some((direction, turned, inward))
}

#[cfg(test)]
impl Strand<f64> {
    /// Sets the directions, increments, twists and pushes of the segments.
    pub fn stand(&mut self, segments: impl IntoIterator<Item = (DVec3, DVec3, f64, f64)>) {
        for (segment, (direction, increment, twist, pressed)) in self.segments.iter_mut().zip(segments) {
            (segment.direction, segment.increment) = (direction.into(), increment.into());
            (segment.twist, segment.pressed) = (twist, pressed);
        }
        self.place();
    }
}
