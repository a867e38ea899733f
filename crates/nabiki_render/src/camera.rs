//! From space to pixels: the camera of one frame, and the framing of many.

use glam::{Mat3, Quat, Vec3};
use nabiki::{Ellipsoid, Mesh, Pose, Strands};

use crate::lens::Lens;
use crate::settings::{Camera, Projection};

/// Nearest depth drawn (cm): what is nearer to the eye than this, or behind it, is left out.
pub const NEAR: f32 = 1.0;

/// The box about everything that should be in the picture (head space, cm).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Least coordinates; above `high` while nothing is included.
    pub low: Vec3,
    /// Largest coordinates.
    pub high: Vec3,
}

impl Default for Bounds {
    fn default() -> Self {
        Self { low: Vec3::INFINITY, high: Vec3::NEG_INFINITY }
    }
}

impl Bounds {
    /// Grows the box to hold `point`; a point that is not finite is passed over.
    pub fn include(&mut self, point: Vec3) {
        if point.is_finite() {
            self.low = self.low.min(point);
            self.high = self.high.max(point);
        }
    }

    /// Grows the box to hold every strand: called for each frame, it frames a whole movie.
    pub fn include_strands(&mut self, strands: &Strands) {
        strands.points().iter().for_each(|&p| self.include(p));
    }

    /// Grows the box to hold the head proper: what of the `mesh` lies in 1.5 times its `ellipsoid`, without
    /// shoulders.
    pub fn include_head(&mut self, mesh: &Mesh, ellipsoid: &Ellipsoid) {
        let near = ellipsoid.scaled(1.5);
        mesh.positions.iter().filter(|&&p| near.value(p) <= 0.0).for_each(|&p| self.include(p));
    }

    /// Whether nothing is included yet.
    pub fn is_empty(&self) -> bool {
        self.low.x > self.high.x
    }

    /// What a camera frames: itself, or a head if nothing is included.
    fn framed(self) -> Self {
        if self.is_empty() { Self { low: Vec3::splat(-12.0), high: Vec3::splat(12.0) } } else { self }
    }

    fn centre(&self) -> Vec3 {
        (self.low + self.high) / 2.0
    }

    fn corners(&self) -> [Vec3; 8] {
        std::array::from_fn(|i| {
            let pick = |bit: usize, low: f32, high: f32| if i >> bit & 1 == 0 { low } else { high };
            Vec3::new(
                pick(0, self.low.x, self.high.x),
                pick(1, self.low.y, self.high.y),
                pick(2, self.low.z, self.high.z),
            )
        })
    }
}

/// The camera of one frame: where it stands and what a pixel sees. It is given in the world; a head that stands still is
/// the world.
///
/// Pixel coordinates run right and down from the picture's upper left corner; the centre of the first pixel is
/// (0.5, 0.5). Depth is the distance along the axis of view (cm).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// The eye (cm). For an orthographic view it lies well before everything.
    pub eye: Vec3,
    /// Unit vector to the picture's right.
    pub right: Vec3,
    /// Unit vector to the picture's top.
    pub up: Vec3,
    /// Unit vector along the axis of view, away from the eye.
    pub forward: Vec3,
    /// Whether rays are parallel.
    pub projection: Projection,
    /// Pixels: a length of 1 cm at depth 1 cm (perspective), or at any depth (orthographic).
    pub scale: f32,
    /// Width and height of the picture (pixels).
    pub size: [u32; 2],
    /// The lens, for perspective; none is a pinhole.
    pub lens: Option<Lens>,
}

/// The direction at `azimuth` and `elevation` (degrees): (0, 0) is +x, before the face; azimuth 90 is +z.
pub fn direction(azimuth: f32, elevation: f32) -> Vec3 {
    let (sin_a, cos_a) = azimuth.to_radians().sin_cos();
    let (sin_e, cos_e) = elevation.to_radians().sin_cos();
    Vec3::new(cos_e * cos_a, sin_e, cos_e * sin_a)
}

impl View {
    /// The view of `camera` for a picture of `size` pixels. Whatever of distance, height and target the camera leaves
    /// open is chosen so that `bounds` fits; empty bounds count as a head.
    pub fn new(camera: &Camera, size: [u32; 2], bounds: &Bounds) -> Self {
        let bounds = bounds.framed();
        let outward = direction(camera.azimuth, camera.elevation);
        let forward = -outward;
        let right = forward.cross(Vec3::Y).normalize_or(Vec3::Z);
        let up = right.cross(forward);
        let [width, height] = size.map(|s| s as f32);
        let shorter = width.min(height);
        let room = [width - 2.0 * camera.margin * shorter, height - 2.0 * camera.margin * shorter];

        let centre = bounds.centre();
        let offsets = |target: Vec3| {
            bounds.corners().map(|c| {
                let c = c - target;
                Vec3::new(c.dot(right).abs(), c.dot(up).abs(), c.dot(forward))
            })
        };
        match camera.projection {
            Projection::Perspective => {
                let scale = 0.5 * height / (0.5 * camera.fov.to_radians()).tan();
                let target = camera.target.unwrap_or(centre);
                let fit = |target| {
                    let least = |o: Vec3| (o.x * 2.0 * scale / room[0]).max(o.y * 2.0 * scale / room[1]) - o.z;
                    offsets(target).map(least).into_iter().fold(2.0 * NEAR, f32::max)
                };
                let distance = camera.distance.unwrap_or_else(|| fit(target));
                let eye = target + outward * distance;
                Self { eye, right, up, forward, projection: camera.projection, scale, size, lens: Lens::of(camera) }
            }
            Projection::Orthographic => {
                let target = camera.target.unwrap_or(centre);
                let reach = offsets(target);
                let scale = camera.height.map_or_else(
                    || {
                        let fit = |o: Vec3| (room[0] / (2.0 * o.x.max(1e-3))).min(room[1] / (2.0 * o.y.max(1e-3)));
                        reach.map(fit).into_iter().fold(f32::INFINITY, f32::min)
                    },
                    |h| height / h,
                );
                let deepest = reach.iter().fold(0.0_f32, |m, o| m.max(o.z.abs()));
                let eye = target + outward * camera.distance.unwrap_or(2.0 * deepest + 2.0 * NEAR);
                Self { eye, right, up, forward, projection: camera.projection, scale, size, lens: None }
            }
        }
    }

    /// The views of a camera that goes once round its target in `views` even steps, from where it is: always as far away as the step
    /// that needs most room for `bounds`.
    pub fn around(camera: &Camera, size: [u32; 2], bounds: &Bounds, views: u32) -> Vec<Self> {
        let step = |k: u32| Camera { azimuth: camera.azimuth + 360.0 * k as f32 / views as f32, to: None, ..*camera };
        let free: Vec<Self> = (0..views).map(|k| Self::new(&step(k), size, bounds)).collect();
        let target = camera.target.unwrap_or(bounds.framed().centre());
        let farthest = free.iter().map(|view| view.eye.distance(target)).fold(0.0, f32::max);
        let scale = match camera.projection {
            Projection::Perspective => free.first().map_or(1.0, |view| view.scale),
            Projection::Orthographic => free.iter().map(|view| view.scale).fold(f32::INFINITY, f32::min),
        };
        free.into_iter().map(|view| Self { eye: target - view.forward * farthest, scale, ..view }).collect()
    }

    /// The same camera as a head in this pose sees it.
    pub fn in_head(&self, pose: &Pose) -> Self {
        if *pose == Pose::STILL {
            return *self;
        }
        let turn = pose.rotation.inverse();
        let [right, up, forward] = [self.right, self.up, self.forward].map(|axis| turn * axis);
        Self { eye: turn * (self.eye - pose.position_cm), right, up, forward, ..*self }
    }

    /// A camera on its way: `part` (0..1) of the way from `a` to `b`, with the size and projection of `b`.
    pub(crate) fn between(a: &Self, b: &Self, part: f32) -> Self {
        if a == b {
            return *b;
        }
        let turned = |view: &Self| Quat::from_mat3(&Mat3::from_cols(view.right, view.up, -view.forward));
        let axes = Mat3::from_quat(turned(a).slerp(turned(b), part));
        Self {
            eye: a.eye.lerp(b.eye, part),
            right: axes.x_axis,
            up: axes.y_axis,
            forward: -axes.z_axis,
            scale: a.scale + (b.scale - a.scale) * part,
            lens: a.lens.zip(b.lens).map_or(b.lens, |(a, b)| Some(Lens::between(a, b, part))),
            ..*b
        }
    }

    /// Pixel coordinates and depth (cm) of a point. Meaningless where depth is below [`NEAR`].
    #[inline]
    pub fn project(&self, p: Vec3) -> Vec3 {
        let p = p - self.eye;
        let depth = p.dot(self.forward);
        let scale = self.pixels_per_cm(depth);
        let seen = Vec3::new(
            0.5 * self.size[0] as f32 + p.dot(self.right) * scale,
            0.5 * self.size[1] as f32 - p.dot(self.up) * scale,
            depth,
        );
        match &self.lens {
            Some(lens) if lens.through != [0.0; 2] => {
                let [x, y] = lens.shift(depth, self.scale);
                Vec3::new(seen.x + x, seen.y + y, depth)
            }
            _ => seen,
        }
    }

    /// Unit vector from a point toward the place of the lens that its rays go through: as [`toward_eye`](Self::toward_eye)
    /// without a lens.
    #[inline]
    pub(crate) fn toward_lens(&self, p: Vec3) -> Vec3 {
        match &self.lens {
            Some(lens) if lens.through != [0.0; 2] => {
                let [right, up] = lens.through.map(|c| 0.5 * lens.diameter * c);
                (self.eye + self.right * right + self.up * up - p).normalize_or(-self.forward)
            }
            _ => self.toward_eye(p),
        }
    }

    /// Pixels that 1 cm across the axis of view covers at a depth (cm).
    #[inline]
    pub fn pixels_per_cm(&self, depth: f32) -> f32 {
        match self.projection {
            Projection::Perspective => self.scale / depth,
            Projection::Orthographic => self.scale,
        }
    }

    /// Unit vector from a point toward the eye.
    #[inline]
    pub fn toward_eye(&self, p: Vec3) -> Vec3 {
        match self.projection {
            Projection::Perspective => (self.eye - p).normalize_or(-self.forward),
            Projection::Orthographic => -self.forward,
        }
    }

    /// The part of a vector that the picture shows, for arrows: right and down, of length 1 where the vector lies in
    /// the picture plane.
    pub fn in_picture(&self, v: Vec3) -> [f32; 2] {
        let v = v.normalize_or_zero();
        [v.dot(self.right), -v.dot(self.up)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn automatic_framing_holds_the_box_and_touches_the_margin() {
        let bounds = Bounds { low: Vec3::new(-9.0, -20.0, -8.0), high: Vec3::new(30.0, 12.0, 11.0) };
        for projection in [Projection::Perspective, Projection::Orthographic] {
            for azimuth in [0.0, 37.0, 90.0, 205.0] {
                let camera = Camera { projection, azimuth, ..Camera::default() };
                let size = [640_u32, 360];
                let view = View::new(&camera, size, &bounds);
                let margin = camera.margin * 360.0;
                let spare = bounds.corners().map(|c| {
                    let p = view.project(c);
                    assert!(p.z > NEAR);
                    p.x.min(640.0 - p.x).min(p.y).min(360.0 - p.y) - margin
                });
                let tightest = spare.into_iter().fold(f32::INFINITY, f32::min);
                // A thousandth of a pixel: rounding of coordinates of some hundred pixels in single precision.
                assert!(tightest.abs() < 1e-3 * 360.0 / 100.0, "{projection:?} {azimuth}: {tightest}");
            }
        }
    }

    #[test]
    fn a_camera_that_goes_round_stays_as_far_away_and_loses_nothing() {
        let bounds = Bounds { low: Vec3::new(-9.0, -20.0, -8.0), high: Vec3::new(30.0, 12.0, 11.0) };
        for projection in [Projection::Perspective, Projection::Orthographic] {
            let camera = Camera { projection, azimuth: 17.0, elevation: 20.0, ..Camera::default() };
            let views = View::around(&camera, [640, 360], &bounds, 24);
            assert_eq!(views[0].forward, View::new(&camera, [640, 360], &bounds).forward);
            let spare = views.iter().map(|view| {
                assert!(
                    (view.eye.distance(bounds.centre()) / views[0].eye.distance(bounds.centre()) - 1.0).abs() < 1e-5
                );
                assert_eq!(view.scale, views[0].scale);
                let corner = |c| {
                    let p = view.project(c);
                    p.x.min(640.0 - p.x).min(p.y).min(360.0 - p.y)
                };
                bounds.corners().map(corner).into_iter().fold(f32::INFINITY, f32::min) - camera.margin * 360.0
            });
            // As tight as it can be, and nowhere tighter; rounding as in the framing of one view.
            let tightest = spare.fold(f32::INFINITY, f32::min);
            assert!(tightest.abs() < 1e-2, "{projection:?}: {tightest}");
        }
    }

    #[test]
    fn the_front_camera_sees_the_characters_right_hand_on_the_left() {
        let camera = Camera { azimuth: 0.0, elevation: 0.0, ..Camera::default() };
        let view = View::new(&camera, [100, 100], &Bounds::default());
        assert!(view.project(Vec3::new(0.0, 0.0, 5.0)).x < 50.0);
        assert!(view.project(Vec3::new(0.0, 5.0, 0.0)).y < 50.0);
    }
}
