//! What a motion is like, frame by frame: hair inside the head and other bodies, kinks, jumps, calm.

use std::fmt;

use glam::{Affine3A, Vec3};
use nabiki::Strands;
use nabiki::body::Body;
use nabiki::dynamics::Form;
use rayon::prelude::*;

use crate::built::BuiltScene;

/// Cosine of the angle between two segments from which on their joint is called a kink: 60 degrees.
const KINK: f32 = 0.5;

/// What one frame is like.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrameSummary {
    /// The frame.
    pub frame: u32,
    /// Share of the nodes, but for the roots, that lie inside the head or another body, 0..1.
    pub inside: f64,
    /// How deep the deepest of them lies (cm); 0 where none is inside.
    pub depth: f32,
    /// Share of the joints at which neighbouring segments stand at more than 60 degrees, 0..1.
    pub kinks: f64,
    /// The farthest that a node has gone since the frame before (head space, cm); 0 in the first frame.
    pub jump: f32,
}

impl FrameSummary {
    /// Of the hair as it is in `frame`. `before`: its points in the frame before, or none.
    pub fn of(built: &BuiltScene, frame: u32, strands: &Strands, before: &[Vec3]) -> Self {
        let others = others(built, frame);
        let strand = |s: usize| {
            let points = strands.strand(s);
            let before = before.get(strands.range(s)).unwrap_or(&[]);
            let depths = points[1..].iter().map(|&p| depth(built, &others, p)).filter(|&depth| depth > 0.0);
            let (inside, depth) = depths.fold((0_u64, 0.0_f32), |(count, deepest), d| (count + 1, deepest.max(d)));
            let jump = points.iter().zip(before).map(|(a, b)| a.distance_squared(*b)).fold(0.0, f32::max);
            (inside, depth, kinks(points), jump)
        };
        let sum = |a: (u64, f32, u64, f32), b: (u64, f32, u64, f32)| (a.0 + b.0, a.1.max(b.1), a.2 + b.2, a.3.max(b.3));
        let all = (0..strands.len()).into_par_iter().with_min_len(64);
        let (inside, depth, kinks, jump) = all.map(strand).reduce(|| (0, 0.0, 0, 0.0), sum);
        let segments = strands.segment_count() as f64;
        let joints = segments - strands.len() as f64;
        Self {
            frame,
            inside: inside as f64 / segments,
            depth,
            kinks: if joints > 0.0 { kinks as f64 / joints } else { 0.0 },
            jump: jump.sqrt(),
        }
    }
}

/// The bodies besides the head, and where they are in a frame.
fn others(built: &BuiltScene, frame: u32) -> Vec<(&Body, Affine3A)> {
    let Form::Free(free) = &built.dynamics.form else { return Vec::new() };
    let head = built.pose(frame);
    free.bodies.iter().skip(1).map(|body| (body, body.head_from_body(frame, &head).inverse())).collect()
}

fn depth(built: &BuiltScene, others: &[(&Body, Affine3A)], p: Vec3) -> f32 {
    let in_body = |(body, body_from_head): &(&Body, Affine3A)| {
        body.distance.sample(body_from_head.transform_point3(p)).map_or(0.0, |(distance, _)| -distance)
    };
    others.iter().map(in_body).fold(built.head.depth(p), f32::max)
}

/// Joints of a strand that are kinks.
fn kinks(points: &[Vec3]) -> u64 {
    let kinked = |w: &&[Vec3]| {
        let (a, b) = (w[1] - w[0], w[2] - w[1]);
        a.dot(b) < KINK * (a.length_squared() * b.length_squared()).sqrt()
    };
    points.windows(3).filter(kinked).count() as u64
}

/// A whole motion.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MotionSummary {
    /// Frame 0.
    pub rest: FrameSummary,
    /// The frame with the largest share inside; the first of several.
    pub worst: FrameSummary,
    /// The frame of the deepest node.
    pub deepest: FrameSummary,
    /// The frame with the most kinks.
    pub most_kinked: FrameSummary,
    /// The frame of the farthest jump.
    pub farthest_jump: FrameSummary,
    /// The last frame.
    pub last: FrameSummary,
    /// What nodes may be inside of, in words.
    met: &'static str,
    before: Vec<Vec3>,
}

impl MotionSummary {
    /// Takes in the next frame; each once, from 0 on.
    pub fn add(&mut self, built: &BuiltScene, frame: u32, strands: &Strands) {
        let now = FrameSummary::of(built, frame, strands, &self.before);
        self.met = if others(built, frame).is_empty() { "the head" } else { "the head or a body" };
        self.add_frame(now);
        self.before.clear();
        self.before.extend_from_slice(strands.points());
    }

    fn add_frame(&mut self, now: FrameSummary) {
        if now.frame == 0 {
            let (met, before) = (self.met, std::mem::take(&mut self.before));
            let [rest, worst, deepest, most_kinked, farthest_jump, last] = [now; 6];
            *self = Self { rest, worst, deepest, most_kinked, farthest_jump, last, met, before };
        }
        self.last = now;
        let more = |most: &mut FrameSummary, of: fn(&FrameSummary) -> f64| {
            if of(&now) > of(most) {
                *most = now;
            }
        };
        more(&mut self.worst, |frame| frame.inside);
        more(&mut self.deepest, |frame| frame.depth.into());
        more(&mut self.most_kinked, |frame| frame.kinks);
        more(&mut self.farthest_jump, |frame| frame.jump.into());
    }
}

impl fmt::Display for MotionSummary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { rest, worst, deepest, most_kinked, farthest_jump, last, met, .. } = self;
        write!(
            f,
            "  inside  {:.2} % of the nodes are inside {met} at frame {} ({:.2} % at rest, at worst {:.2} % at frame {})",
            100.0 * last.inside,
            last.frame,
            100.0 * rest.inside,
            100.0 * worst.inside,
            worst.frame,
        )?;
        if deepest.depth > 0.0 {
            write!(f, "\n          the deepest {:.3} cm at frame {}", deepest.depth, deepest.frame)?;
        }
        write!(
            f,
            "\n  motion  joints of more than 60 degrees: {:.3} % at rest, at most {:.3} % at frame {}\n          a node goes \
             {:.2} cm in a frame at the most, at frame {}, and {:.4} cm in the last one",
            100.0 * rest.kinks,
            100.0 * most_kinked.kinks,
            most_kinked.frame,
            farthest_jump.jump,
            farthest_jump.frame,
            last.jump,
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_worst_frame_is_the_first_of_the_largest_share() {
        let mut summary = MotionSummary::default();
        let frames =
            [(0, 0.1, 0.2, 0.0, 0.0), (1, 0.4, 0.1, 0.1, 2.0), (2, 0.4, 0.9, 0.3, 1.0), (3, 0.2, 0.3, 0.3, 0.5)];
        for (frame, inside, depth, kinks, jump) in frames {
            summary.add_frame(FrameSummary { frame, inside, depth, kinks, jump });
        }
        let MotionSummary { rest, worst, deepest, most_kinked, farthest_jump, last, .. } = summary;
        assert_eq!([rest, worst, deepest, most_kinked, farthest_jump, last].map(|f| f.frame), [0, 1, 2, 2, 1, 3]);
    }

    #[test]
    fn a_joint_is_a_kink_from_sixty_degrees_on() {
        let bent = |degrees: f32| {
            let (sin, cos) = degrees.to_radians().sin_cos();
            kinks(&[Vec3::ZERO, Vec3::X * 2.0, Vec3::X * 2.0 + Vec3::new(cos, sin, 0.0)])
        };
        assert_eq!([59.9, 60.1, 180.0].map(bent), [0, 1, 1]);
    }
}
