//! Hair, head and camera while the shutter is open: their positions between two frames, and how far each point moves.

use std::borrow::Cow;

use glam::{Affine3A, Vec3};
use nabiki::{Pose, Strands};
use rayon::prelude::*;

use crate::RenderError;
use crate::camera::{NEAR, View};
use crate::moment::FrameToDraw;
use crate::raster::CELLS;

/// Strands handed to one task at a time.
const CHUNK: usize = 256;

/// Hair between two frames, at `part` (0..1) of the way from `a` to `b`.
///
/// Interpolates the *directions* of the segments instead of the points. A strand that swings therefore keeps its length
/// and moves along an arc.
///
/// # Errors
/// If the strands of the two do not match.
pub fn between(a: &Strands, b: &Strands, part: f32) -> Result<Strands, RenderError> {
    if a.starts() != b.starts() {
        return Err(RenderError::Geometry(format!(
            "the hair has {} strands of {} points before and {} of {} after: they must match",
            a.len(),
            a.points().len(),
            b.len(),
            b.points().len()
        )));
    }
    let mut mixed = a.clone();
    let starts = a.starts();
    let mut rest = mixed.points_mut();
    let mut chunks = Vec::new();
    for first in (0..a.len()).step_by(CHUNK) {
        let last = (first + CHUNK).min(a.len());
        let (chunk, after) = std::mem::take(&mut rest).split_at_mut((starts[last] - starts[first]) as usize);
        chunks.push((first..last, chunk));
        rest = after;
    }
    chunks.into_par_iter().for_each(|(strands, points)| {
        let first = a.range(strands.start).start;
        for s in strands {
            let range = a.range(s);
            swing(a.strand(s), b.strand(s), part, &mut points[range.start - first..range.end - first]);
        }
    });
    Ok(mixed)
}

fn swing(a: &[Vec3], b: &[Vec3], part: f32, mixed: &mut [Vec3]) {
    let (Some(&root_a), Some(&root_b)) = (a.first(), b.first()) else { return };
    let mut at = root_a.lerp(root_b, part);
    mixed[0] = at;
    for i in 1..a.len() {
        let (u, v) = (a[i] - a[i - 1], b[i] - b[i - 1]);
        let length = u.length() + (v.length() - u.length()) * part;
        let unit = u.normalize_or_zero();
        at += unit.lerp(v.normalize_or_zero(), part).normalize_or(unit) * length;
        mixed[i] = at;
    }
}

/// Hair halfway between two moments, and each point's movement from the first to the second (cm).
fn halfway(open: &Strands, close: &Strands) -> Result<(Strands, Vec<Vec3>), RenderError> {
    let middle = between(open, close, 0.5)?;
    let moved = open.points().par_iter().zip(close.points()).map(|(a, b)| *b - *a).collect();
    Ok((middle, moved))
}

/// A head between two frames: `part` (0..1) of the way from `a` to `b`.
fn pose_between(a: Pose, b: Pose, part: f32) -> Pose {
    if a == b {
        return a;
    }
    Pose { position_cm: a.position_cm.lerp(b.position_cm, part), rotation: a.rotation.slerp(b.rotation, part) }
}

/// What an open shutter sees of one frame.
pub(crate) struct Exposure<'a> {
    /// The hair halfway through (head space, cm).
    pub strands: Cow<'a, Strands>,
    /// Movement of each point while the shutter is open (head space, cm); empty if it is not open for any time.
    pub moved: Vec<Vec3>,
    /// Head and camera halfway through; the camera in the world.
    pub pose: Pose,
    pub view: View,
    /// The camera as the head sees it.
    pub shot: Shot,
}

impl<'a> Exposure<'a> {
    /// The shutter closes at the frame and opened `shutter` (0..1) of a frame earlier.
    pub fn new(frame: &FrameToDraw<'a>, shutter: f32) -> Result<Self, RenderError> {
        let now = frame.now;
        let Some(before) = frame.before.filter(|_| shutter > 0.0) else {
            let bodies = now.bodies.iter().map(|body| Passage::still(in_head_space(body, &now.pose))).collect();
            let shot = Shot { bodies, ..Shot::sharp(now.view.in_head(&now.pose)) };
            let strands = Cow::Borrowed(now.strands);
            return Ok(Self { strands, moved: Vec::new(), pose: now.pose, view: now.view, shot });
        };
        let open = between(before.strands, now.strands, 1.0 - shutter)?;
        let (middle, moved) = halfway(&open, now.strands)?;
        let at = |part: f32| {
            let part = 1.0 - shutter * (1.0 - part);
            (pose_between(before.pose, now.pose, part), View::between(&before.view, &now.view, part))
        };
        let in_head = |part: f32| {
            let (pose, view) = at(part);
            view.in_head(&pose)
        };
        let (pose, view) = at(0.5);
        let [open, middle_view, close] = [0.0, 0.5, 1.0].map(in_head);
        let mut bodies: Vec<Passage> = (before.bodies.iter().zip(now.bodies))
            .map(|(a, b)| {
                let place = |part: f32| {
                    let part = 1.0 - shutter * (1.0 - part);
                    in_head_space(&pose_between(*a, *b, part), &pose_between(before.pose, now.pose, part))
                };
                let [open, middle, close] = [0.0, 0.5, 1.0].map(place);
                let between = (0..CELLS).map(|k| place((k as f32 + 0.5) / CELLS as f32)).collect();
                Passage { open, middle, close, between }
            })
            .collect();
        let moves = open != close || bodies.iter().any(|body| body.open != body.close);
        if !moves {
            bodies.iter_mut().for_each(|body| body.between.clear());
        }
        let between = moves.then(|| Box::new(std::array::from_fn(|k| in_head((k as f32 + 0.5) / CELLS as f32))));
        let shot = Shot { open, middle: middle_view, close, between, bodies };
        Ok(Self { strands: Cow::Owned(middle), moved, pose, view, shot })
    }
}

/// Takes points of a body into head space.
fn in_head_space(body: &Pose, head: &Pose) -> Affine3A {
    head.world_from_head().inverse() * body.world_from_head()
}

/// Where a body is in head space while the shutter is open.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Passage {
    pub open: Affine3A,
    pub middle: Affine3A,
    pub close: Affine3A,
    /// As [`Shot::between`]; empty if nothing moves.
    pub between: Vec<Affine3A>,
}

impl Passage {
    fn still(place: Affine3A) -> Self {
        Self { open: place, middle: place, close: place, between: Vec::new() }
    }

    /// How a place that is at `p` halfway through moves in head space (cm).
    fn motion(&self, p: Vec3) -> Vec3 {
        let own = self.middle.inverse().transform_point3(p);
        self.close.transform_point3(own) - self.open.transform_point3(own)
    }
}

/// The camera and the bodies in head space while the shutter is open.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Shot {
    pub open: View,
    pub middle: View,
    pub close: View,
    /// The middles of as many equal parts of the time as a pixel has cells; none if neither camera nor a body moves.
    pub between: Option<Box<[View; CELLS]>>,
    pub bodies: Vec<Passage>,
}

impl Shot {
    /// Of a camera that does not move, without bodies.
    pub fn sharp(view: View) -> Self {
        Self { open: view, middle: view, close: view, between: None, bodies: Vec::new() }
    }

    /// The same with other views: each of the camera's as `seen` makes it.
    pub fn seen(&self, seen: impl Fn(&View) -> View) -> Self {
        let between = self.between.as_ref().map(|views| Box::new(std::array::from_fn(|k| seen(&views[k]))));
        let [open, middle, close] = [&self.open, &self.middle, &self.close].map(seen);
        Self { open, middle, close, between, bodies: self.bodies.clone() }
    }

    /// The same halfway through, where nothing moves.
    pub fn halfway(&self) -> Self {
        Self {
            bodies: self.bodies.iter().map(|body| Passage::still(body.middle)).collect(),
            ..Self::sharp(self.middle)
        }
    }

    /// How a place on the head (solid 0) or on a body that is at `p` halfway through moves on the picture, as
    /// [`motion`](Self::motion).
    #[inline]
    pub fn motion_of_solid(&self, solid: u16, p: Vec3) -> Vec3 {
        let body = usize::from(solid).checked_sub(1).map(|i| self.bodies[i].motion(p));
        self.motion(p, body.unwrap_or_default())
    }

    /// How a place that is at `p` halfway through, and moves by `v` in head space (cm), moves on the picture: pixels right and
    /// down, and depth (cm). Nothing for what comes too near to the eye.
    #[inline]
    pub fn motion(&self, p: Vec3, v: Vec3) -> Vec3 {
        let (a, b) = (self.open.project(p - 0.5 * v), self.close.project(p + 0.5 * v));
        if a.z.min(b.z) < NEAR { Vec3::ZERO } else { b - a }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn straight(angle: f32) -> Strands {
        let mut s = Strands::default();
        s.push((0..6).map(|i| Vec3::new(angle.sin(), -angle.cos(), 0.0) * i as f32));
        s
    }

    #[test]
    fn a_swinging_strand_keeps_its_length_halfway() {
        let (middle, moved) = halfway(&straight(-0.5), &straight(0.5)).unwrap();
        for (i, moved) in moved.iter().enumerate() {
            // A handful of roundings of numbers up to 5.
            assert!(middle.strand(0)[i].distance(Vec3::new(0.0, -(i as f32), 0.0)) < 3e-6);
            assert!((moved.length() - 2.0 * 0.5_f32.sin() * i as f32).abs() < 3e-6);
        }
    }

    #[test]
    fn the_way_begins_and_ends_at_the_frames() {
        let (a, b) = (straight(-0.5), straight(0.7));
        for (part, end) in [(0.0, &a), (1.0, &b)] {
            let mixed = between(&a, &b, part).unwrap();
            assert!(mixed.points().iter().zip(end.points()).all(|(p, q)| p.distance(*q) < 3e-6));
        }
    }

    #[test]
    fn hair_of_different_shape_is_refused() {
        let mut other = Strands::default();
        other.push([Vec3::ZERO, Vec3::X]);
        assert!(halfway(&Strands::default(), &other).is_err());
    }
}
