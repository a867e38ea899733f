//! A guide as a chain of joints: where it goes in each frame.

use glam::{DQuat, DVec3, Vec3};
use nabiki::Strands;

/// A place along a strand: the segment, and the part of it before the place.
type Knot = (usize, f32);

/// A strand whose bones lead others. All points are in one space, on the head.
#[derive(Clone, Debug)]
pub(super) struct Guide {
    pub strand: usize,
    knots: Vec<Knot>,
    /// The joints at rest, root first, and the end of the last bone.
    pub rest: Vec<Vec3>,
    /// The length of hair up to each of them at rest.
    pub along: Vec<f32>,
    /// The same points in every frame, one frame after the other.
    points: Vec<Vec3>,
}

/// A bone in a frame: its turn from rest, and where its joint is.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bone {
    pub turn: DQuat,
    pub joint: DVec3,
    /// The joint at rest.
    pub rest: DVec3,
}

impl Bone {
    /// Where the bone takes a point at rest.
    pub fn takes(&self, p: DVec3) -> DVec3 {
        self.joint + self.turn * (p - self.rest)
    }
}

impl Guide {
    /// Strand number `strand` with these points at rest, as a chain of equally long bones.
    pub fn new(strand: usize, points: &[Vec3], joints: usize) -> Self {
        let ends = points.windows(2).scan(0.0, |along, ends| {
            *along += ends[0].distance(ends[1]);
            Some(*along)
        });
        let ends: Vec<f32> = ends.collect();
        let length = ends[ends.len() - 1];
        let along: Vec<f32> = (0..=joints).map(|k| length * k as f32 / joints as f32).collect();
        let knot = |&at: &f32| {
            let segment = ends.partition_point(|&end| end < at).min(ends.len() - 1);
            let begin = if segment > 0 { ends[segment - 1] } else { 0.0 };
            (segment, ((at - begin) / (ends[segment] - begin).max(f32::MIN_POSITIVE)).clamp(0.0, 1.0))
        };
        let knots: Vec<Knot> = along.iter().map(knot).collect();
        let rest = knots.iter().map(|&knot| at(points, knot)).collect();
        Self { strand, knots, rest, along, points: Vec::new() }
    }

    /// Adds a frame.
    pub fn push(&mut self, strands: &Strands) {
        let points = strands.strand(self.strand);
        self.points.extend(self.knots.iter().map(|&knot| at(points, knot)));
    }

    /// Its bones in a frame. Bones keep their lengths and turn as little as they can, one after the other from the root.
    pub fn bones(&self, frame: usize) -> Vec<Bone> {
        let count = self.rest.len();
        let now: Vec<DVec3> = self.points[frame * count..(frame + 1) * count].iter().map(|p| p.as_dvec3()).collect();
        let rest: Vec<DVec3> = self.rest.iter().map(|p| p.as_dvec3()).collect();
        let (mut turn, mut joint) = (DQuat::IDENTITY, now[0]);
        let mut bones = Vec::with_capacity(count - 1);
        for k in 0..count - 1 {
            let bone = rest[k + 1] - rest[k];
            // Toward where its end is, from where its joint has come to.
            if let (Some(from), Some(to)) = ((turn * bone).try_normalize(), (now[k + 1] - joint).try_normalize()) {
                turn = (DQuat::from_rotation_arc(from, to) * turn).normalize();
            }
            bones.push(Bone { turn, joint, rest: rest[k] });
            joint += turn * bone;
        }
        bones
    }
}

fn at(points: &[Vec3], (segment, part): Knot) -> Vec3 {
    points[segment].lerp(points[segment + 1], part)
}
