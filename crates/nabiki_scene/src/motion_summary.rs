//! Statistics of a motion, frame by frame: hair inside bodies, kinks, jumps.

use std::fmt;

use glam::{Affine3A, Vec3};
use nabiki::Strands;
use nabiki::body::Body;
use nabiki::dynamics::Form;
use rayon::prelude::*;

use crate::built::BuiltScene;

/// Cosine of the angle between two segments from which on their joint is called a kink: 60 degrees.
const KINK: f32 = 0.5;

/// How far a node may move back and forth from frame to frame without a warning (cm), for hair that feels its
/// neighbours: their pressure has no bound that could be checked in advance.
const HOP: f32 = 1.5;

/// Statistics of one frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct FrameSummary {
    /// The frame.
    pub frame: u32,
    /// Share of the nodes (except roots) inside the head or another body, 0..1.
    pub inside: f64,
    /// Depth of the deepest node (cm); 0 if none is inside.
    pub depth: f32,
    /// Share of the joints that bend by more than 60 degrees, 0..1.
    pub kinks: f64,
    /// Largest distance that a node moved since the previous frame (head space, cm); 0 in the first frame.
    pub jump: f32,
    /// Largest distance that a node moved back along its previous step (cm); 0 if none reverses. Hair that swings slows
    /// down where it reverses. A step that is too long for the forces throws hair back and forth.
    pub hop: f32,
}

impl FrameSummary {
    /// The statistics of `frame`. `before` are the points of the two previous frames, the later one first, or empty.
    pub fn of(built: &BuiltScene, frame: u32, strands: &Strands, before: [&[Vec3]; 2]) -> Self {
        let others = others(built, frame);
        let strand = |s: usize| {
            let points = strands.strand(s);
            let [before, earlier] = before.map(|points| points.get(strands.range(s)).unwrap_or(&[]));
            let depths = points[1..].iter().map(|&p| depth(built, &others, frame, p)).filter(|&depth| depth > 0.0);
            let (inside, depth) = depths.fold((0_u64, 0.0_f32), |(count, deepest), d| (count + 1, deepest.max(d)));
            let jump = points.iter().zip(before).map(|(a, b)| a.distance_squared(*b)).fold(0.0, f32::max);
            let hops =
                points.iter().zip(before).zip(earlier).map(|((now, before), earlier)| hop(*earlier, *before, *now));
            (inside, depth, kinks(points), jump, hops.fold(0.0, f32::max))
        };
        type Sums = (u64, f32, u64, f32, f32);
        let sum = |a: Sums, b: Sums| (a.0 + b.0, a.1.max(b.1), a.2 + b.2, a.3.max(b.3), a.4.max(b.4));
        let all = (0..strands.len()).into_par_iter().with_min_len(64);
        let (inside, depth, kinks, jump, hop) = all.map(strand).reduce(|| (0, 0.0, 0, 0.0, 0.0), sum);
        let segments = strands.segment_count() as f64;
        let joints = segments - strands.len() as f64;
        Self {
            frame,
            inside: inside as f64 / segments,
            depth,
            kinks: if joints > 0.0 { kinks as f64 / joints } else { 0.0 },
            jump: jump.sqrt(),
            hop,
        }
    }
}

/// The bodies, with their poses in a frame: with the head if that bends, else besides it.
fn others(built: &BuiltScene, frame: u32) -> Vec<(&Body, Affine3A)> {
    let Form::Free(free) = &built.dynamics.form else { return Vec::new() };
    let head = built.pose(frame);
    free.bodies
        .iter()
        .skip(usize::from(built.skin(frame).is_none()))
        .map(|body| (body, body.head_from_body(frame, &head).inverse()))
        .collect()
}

fn depth(built: &BuiltScene, others: &[(&Body, Affine3A)], frame: u32, p: Vec3) -> f32 {
    let in_body = |(body, body_from_head): &(&Body, Affine3A)| {
        let reading = body.shape.obstacle().read(body_from_head.transform_point3(p), frame);
        reading.map_or(0.0, |reading| -reading.distance)
    };
    let bends = built.skin(frame).is_some() && !others.is_empty();
    let in_head = if bends { 0.0 } else { built.model.head.depth(p) };
    others.iter().map(in_body).fold(in_head, f32::max)
}

/// How far a point goes back the way it came.
fn hop(earlier: Vec3, before: Vec3, now: Vec3) -> f32 {
    let (came, goes) = (before - earlier, now - before);
    let shorter = came.length().min(goes.length());
    if came.dot(goes) < -0.5 * came.length() * goes.length() { shorter } else { 0.0 }
}

/// Joints of a strand that are kinks.
fn kinks(points: &[Vec3]) -> u64 {
    let kinked = |w: &&[Vec3]| {
        let (a, b) = (w[1] - w[0], w[2] - w[1]);
        a.dot(b) < KINK * (a.length_squared() * b.length_squared()).sqrt()
    };
    points.windows(3).filter(kinked).count() as u64
}

/// Statistics of a motion.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct MotionSummary {
    /// Frame 0.
    pub rest: FrameSummary,
    /// The first frame with the largest share inside.
    pub worst: FrameSummary,
    /// The frame with the deepest node.
    pub deepest: FrameSummary,
    /// The frame with the most kinks.
    pub most_kinked: FrameSummary,
    /// The frame with the largest jump.
    pub farthest_jump: FrameSummary,
    /// The frame with the largest hop.
    pub farthest_hop: FrameSummary,
    /// The last frame.
    pub last: FrameSummary,
    /// What nodes may be inside of, in words.
    met: &'static str,
    /// What may throw hair back and forth, and the remedy.
    blamed: Option<String>,
    /// The points of the frame before, and of the one before that.
    before: [Vec<Vec3>; 2],
}

impl MotionSummary {
    /// Adds the next frame. Call it once per frame, from 0 on.
    pub fn add(&mut self, built: &BuiltScene, frame: u32, strands: &Strands) {
        let [before, earlier] = &self.before;
        let now = FrameSummary::of(built, frame, strands, [before, earlier]);
        let besides = others(built, frame).len() > usize::from(built.skin(frame).is_some());
        self.met = if besides { "the head or a body" } else { "the head" };
        if frame == 0 {
            self.blamed = blamed(built);
        }
        self.add_frame(now);
        self.before.swap(0, 1);
        self.before[0].clear();
        self.before[0].extend_from_slice(strands.points());
    }

    fn add_frame(&mut self, now: FrameSummary) {
        if now.frame == 0 {
            let (met, blamed) = (self.met, std::mem::take(&mut self.blamed));
            let [rest, worst, deepest, most_kinked, farthest_jump, farthest_hop, last] = [now; 7];
            let before = [Vec::new(), Vec::new()];
            *self = Self { rest, worst, deepest, most_kinked, farthest_jump, farthest_hop, last, met, blamed, before };
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
        more(&mut self.farthest_hop, |frame| frame.hop.into());
    }
}

/// With two digits; a share that rounds to nothing is not nothing.
fn percent(share: f64) -> String {
    if share > 0.0 && share < 5e-5 { "under 0.01 %".to_owned() } else { format!("{:.2} %", 100.0 * share) }
}

impl fmt::Display for MotionSummary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { rest, worst, deepest, most_kinked, farthest_jump, farthest_hop, last, met, blamed, .. } = self;
        write!(
            f,
            "  inside  {} of the nodes are inside {met} at frame {} ({} at rest, at most {} at frame {})",
            percent(last.inside),
            last.frame,
            percent(rest.inside),
            percent(worst.inside),
            worst.frame,
        )?;
        if deepest.depth > 0.0 {
            write!(f, "\n          the deepest {:.3} cm at frame {}", deepest.depth, deepest.frame)?;
        }
        write!(
            f,
            "\n  motion  joints of more than 60 degrees: {:.3} % at rest, at most {:.3} % at frame {}\n          a node \
             moves at most {:.2} cm in a frame, at frame {}, and {:.4} cm in the last frame",
            100.0 * rest.kinks,
            100.0 * most_kinked.kinks,
            most_kinked.frame,
            farthest_jump.jump,
            farthest_jump.frame,
            last.jump,
        )?;
        match blamed {
            Some(blamed) if farthest_hop.hop > HOP => {
                let FrameSummary { hop, frame, .. } = farthest_hop;
                write!(
                    f,
                    "\n  warning hair hops: a node moves {hop:.1} cm back and forth by frame {frame}, unlike real hair: \
                     {blamed}"
                )
            }
            _ => Ok(()),
        }
    }
}

/// What throws hair back and forth although [`BuiltScene::simulation`] accepts it, and the remedy.
fn blamed(built: &BuiltScene) -> Option<String> {
    let Form::Free(free) = &built.dynamics.form else { return None };
    let forces = &free.neighbours.as_ref()?.forces;
    let (pressure, step) = (forces.pressure, built.dynamics.motion.time_step);
    // Cohesion is implicit, and throws nothing.
    (pressure > 0.0).then(|| format!("lower neighbours.pressure = {pressure}, or motion.time_step = {step}"))
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
            summary.add_frame(FrameSummary { frame, inside, depth, kinks, jump, hop: kinks as f32 });
        }
        let MotionSummary { rest, worst, deepest, most_kinked, farthest_jump, farthest_hop, last, .. } = summary;
        let all = [rest, worst, deepest, most_kinked, farthest_jump, farthest_hop, last];
        assert_eq!(all.map(|f| f.frame), [0, 1, 2, 2, 1, 2, 3]);
    }

    #[test]
    fn what_turns_about_hops_by_the_shorter_of_its_ways() {
        let x = |to: [f32; 3]| hop(Vec3::X * to[0], Vec3::X * to[1], Vec3::X * to[2]);
        assert_eq!([[0.0, 3.0, 1.0], [0.0, 3.0, -5.0], [0.0, 3.0, 9.0], [0.0, 0.0, 4.0]].map(x), [2.0, 3.0, 0.0, 0.0]);
        // Round a bend.
        assert_eq!(hop(Vec3::ZERO, Vec3::X, Vec3::X + Vec3::Y), 0.0);
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
