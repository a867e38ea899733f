//! The specification of the free form: one segment at a time, in f64, as docs/motion-forms.md writes it.

mod obstacle;

use glam::{DQuat, DVec3};

use self::obstacle::{Obstacle, Touch};
use super::grid::Crowd;
use super::head_frame::{HeadFrame, weight};
use super::segment::{FreeSegment, free_segments};
use crate::body::Surface;
use crate::dynamics::gain::Stability;
use crate::dynamics::{Dynamics, ForceSpace, FrameInput, Stepper};
use crate::error::SettingError;
use crate::field::Field;
use crate::free_form::FreeMotion;
use crate::pseudo_force::Gamma;
use crate::strands::Strands;

/// The free form of [`Reference`](crate::dynamics::Reference).
pub(in crate::dynamics) struct Reference {
    hair: Hair,
    /// The carriers, and what they left in the frame before.
    crowd: Option<(Hair, Crowd)>,
    frame: u32,
}

/// Some strands, and what moves them.
struct Hair {
    dynamics: Dynamics,
    free: FreeMotion,
    gamma: Gamma,
    rest_weight: DVec3,
    segments: Vec<Segment>,
    /// For each body, what every point is kept out of, and how far from it (cm).
    kept_from: Vec<Vec<(Surface, f64)>>,
    positions: Vec<DVec3>,
    strands: Strands,
}

/// One segment: its direction d at frame n and its increment w (rad a frame), normal to d; both in head space.
struct Segment {
    moved_by: FreeSegment,
    direction: DVec3,
    increment: DVec3,
}

impl Segment {
    /// What is left of the head's turn is felt as lag.
    fn lag_behind(&mut self, axis: DVec3, angle: f64) {
        let lag = DQuat::from_axis_angle(axis, -self.moved_by.lag * angle);
        self.direction = lag * self.direction;
        self.increment = lag * self.increment;
    }

    /// The moment of the joint at its beginning: what turns d toward where the segment before it carries its rest
    /// direction, and that one back. `frame`: R_(i-1), which has carried the segments before this one from their rest to
    /// where they are.
    fn moment(&self, frame: DQuat) -> DVec3 {
        self.moved_by.stiffness * (frame * self.moved_by.rest).cross(self.direction)
    }

    /// w(n+1), before it turns d. `force`: all that does not come from the segment's shape; `moment`: of both of its
    /// joints.
    fn drive(&mut self, force: DVec3, moment: DVec3) {
        let FreeSegment { shape, rest, hold, decay, .. } = self.moved_by;
        let d = self.direction;
        let f = force + hold * (rest - d);
        let across = (f - f.dot(d) * d) + d.cross(moment);
        self.increment = decay * (self.increment + shape.gain * across);
    }

    /// d + w, brought back to length 1, and w as it is carried along that way: its length stays. What rests keeps its bits.
    fn turned(&self) -> (DVec3, DVec3) {
        let (d, w) = (self.direction, self.increment);
        if w == DVec3::ZERO {
            return (d, w);
        }
        let length = (d + w).length();
        ((d + w) / length, (w - w.length_squared() * d) / length)
    }
}

impl Reference {
    /// Hair at rest in the given shape, at frame 0, whose settings have been checked.
    ///
    /// # Errors
    /// Strands that cannot be moved, and a field too strong for the step.
    pub fn new(
        strands: &Strands,
        dynamics: &Dynamics,
        free: &FreeMotion,
        field: &dyn Field,
    ) -> Result<Self, SettingError> {
        let hair = Hair::new(strands, dynamics, free, field)?;
        let crowd = match &free.neighbours {
            None => None,
            Some(neighbours) => {
                let carriers = Hair::new(&neighbours.carriers, dynamics, free, field)?;
                let crowd = Crowd::new(neighbours, carriers.strands.points())?;
                Some((carriers, crowd))
            }
        };
        Ok(Self { hair, crowd, frame: 0 })
    }

    pub fn positions(&self) -> &[DVec3] {
        &self.hair.positions
    }
}

impl Stepper for Reference {
    fn step_frame(&mut self, input: &FrameInput) {
        match &mut self.crowd {
            None => self.hair.step(input, None),
            Some((carriers, crowd)) => {
                self.hair.step(input, Some(crowd));
                carriers.step(input, Some(crowd));
                crowd.fill(carriers.strands.points(), &carriers.velocities());
            }
        }
        self.frame = input.frame;
    }

    fn frame(&self) -> u32 {
        self.frame
    }

    fn strands(&self) -> &Strands {
        &self.hair.strands
    }
}

impl Hair {
    fn new(strands: &Strands, dynamics: &Dynamics, free: &FreeMotion, field: &dyn Field) -> Result<Self, SettingError> {
        Stability::of(strands, dynamics)?.check(field)?;
        let mut segments = Vec::with_capacity(strands.segment_count());
        for (s, strand) in strands.iter().enumerate() {
            for moved_by in free_segments(dynamics, &free.form, strand, s)? {
                segments.push(Segment { moved_by, direction: moved_by.rest, increment: DVec3::ZERO });
            }
        }
        let mut hair = Self {
            gamma: dynamics.gamma(),
            rest_weight: weight(&free.rest_pose, f64::from(free.form.gravity)),
            dynamics: dynamics.clone(),
            free: free.clone(),
            segments,
            kept_from: Vec::new(),
            positions: strands.points().iter().map(|p| p.as_dvec3()).collect(),
            strands: strands.clone(),
        };
        hair.place();
        hair.kept_from =
            free.bodies.iter().map(|body| obstacle::kept_from(body, &free.rest_pose, &hair.positions)).collect();
        Ok(hair)
    }

    fn step(&mut self, input: &FrameInput, crowd: Option<&Crowd>) {
        let gravity = f64::from(self.free.form.gravity);
        let head = HeadFrame::new(input, gravity, self.dynamics.motion.frame_rate);
        if let Some((axis, angle)) = head.turn {
            self.segments.iter_mut().for_each(|segment| segment.lag_behind(axis, angle));
            self.place();
        }
        let bodies = self.free.bodies.clone();
        let obstacles: Vec<Obstacle> = bodies.iter().map(|body| Obstacle::new(body, input)).collect();
        for s in 0..self.strands.len() {
            self.step_strand(s, input, &head, &obstacles, crowd);
        }
        self.publish();
    }

    /// Moves one strand from its root to its tip.
    fn step_strand(
        &mut self,
        s: usize,
        input: &FrameInput,
        head: &HeadFrame,
        obstacles: &[Obstacle],
        crowd: Option<&Crowd>,
    ) {
        let points = self.strands.range(s);
        let mut frame = DQuat::IDENTITY;
        let mut velocity = DVec3::ZERO;
        let mut moment = self.segments[points.start - s].moment(frame);
        for i in 0..points.len() - 1 {
            let (from, end) = (self.positions[points.start + i], self.positions[points.start + i + 1]);
            let (field, weakened) = self.field(end, input);
            let segment = &self.segments[points.start - s + i];
            let FreeSegment { shape, rest, .. } = segment.moved_by;
            velocity += shape.length * segment.increment;
            let eps = if weakened { shape.eps() } else { 1.0 };
            let felt = head.felt.map_or(DVec3::ZERO, |felt| felt.transform_point3(end));
            let others = crowd.map_or(DVec3::ZERO, |crowd| crowd.force(end, velocity));
            let weight = head.weight - frame * self.rest_weight;
            frame = smallest_turn(frame * rest, segment.direction) * frame;
            let last = i + 2 == points.len();
            let next = if last { DVec3::ZERO } else { self.segments[points.start - s + i + 1].moment(frame) };
            let segment = &mut self.segments[points.start - s + i];
            segment.drive(eps * field + felt + others + weight, moment - next);
            moment = next;
            let was = segment.direction;
            let (mut direction, mut increment) = segment.turned();
            for (obstacle, kept_from) in obstacles.iter().zip(&self.kept_from) {
                let (surface, clearance) = kept_from[points.start + i + 1];
                let touch = Touch { from, length: shape.length, clearance, was, surface };
                (direction, increment) = obstacle.stop(direction, increment, &touch);
            }
            (segment.direction, segment.increment) = (direction, increment);
            self.positions[points.start + i + 1] = from + shape.length * direction;
        }
    }

    /// F(n+1) at a point, both in head space, and whether it lies in Gamma.
    fn field(&self, point: DVec3, input: &FrameInput) -> (DVec3, bool) {
        let FrameInput { frame, pose, field, .. } = input;
        let force = match self.dynamics.motion.force_space {
            ForceSpace::Head => field.at(point.as_vec3(), *frame).as_dvec3(),
            ForceSpace::World => {
                let rotation = pose.rotation.as_dquat();
                let in_world = rotation * point + pose.position_cm.as_dvec3();
                rotation.inverse() * field.at(in_world.as_vec3(), *frame).as_dvec3()
            }
        };
        (force, self.gamma.contains(point, force.as_vec3()))
    }

    /// What the increments alone move every point by in a frame (cm).
    fn velocities(&self) -> Vec<glam::Vec3> {
        let mut velocities = vec![glam::Vec3::ZERO; self.positions.len()];
        for s in 0..self.strands.len() {
            let points = self.strands.range(s);
            let mut velocity = DVec3::ZERO;
            for i in 0..points.len() - 1 {
                let segment = &self.segments[points.start - s + i];
                velocity += segment.moved_by.shape.length * segment.increment;
                velocities[points.start + i + 1] = velocity.as_vec3();
            }
        }
        velocities
    }

    /// Puts the strands together from their roots outward.
    fn place(&mut self) {
        for s in 0..self.strands.len() {
            let points = self.strands.range(s);
            let mut p = self.positions[points.start];
            for (i, segment) in self.segments[points.start - s..points.end - s - 1].iter().enumerate() {
                p += segment.moved_by.shape.length * segment.direction;
                self.positions[points.start + i + 1] = p;
            }
        }
        self.publish();
    }

    fn publish(&mut self) {
        for (point, p) in self.strands.points_mut().iter_mut().zip(&self.positions) {
            *point = p.as_vec3();
        }
    }
}

/// The smallest rotation that takes one direction to another; none at all where they are opposite.
fn smallest_turn(from: DVec3, to: DVec3) -> DQuat {
    if from == to {
        return DQuat::IDENTITY;
    }
    let (cross, cosine) = (from.cross(to), 1.0 + from.dot(to));
    DQuat::from_xyzw(cross.x, cross.y, cross.z, cosine.max(1e-12)).normalize()
}
