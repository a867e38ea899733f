//! The camera of a frame, from space to pixels, and the framing of a movie.

use glam::{Mat3, Quat, Vec3};
use nabiki::{Ellipsoid, Mesh, Pose, Strands};

use crate::lens::Lens;
use crate::settings::{Camera, Projection};

pub use crate::settings::NEAR;

/// The bounding box of everything that should be in the picture (head space, cm).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Smallest coordinates; above `high` while the box is empty.
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
    /// Extends the box to include `point`. A point that is not finite is ignored.
    pub fn include(&mut self, point: Vec3) {
        if point.is_finite() {
            self.low = self.low.min(point);
            self.high = self.high.max(point);
        }
    }

    /// Extends the box to include all strands. Call it for each frame to frame a complete movie.
    pub fn include_strands(&mut self, strands: &Strands) {
        strands.points().iter().for_each(|&p| self.include(p));
    }

    /// Extends the box to include the head without shoulders: the part of `mesh` within 1.5 times its `ellipsoid`.
    pub fn include_head(&mut self, mesh: &Mesh, ellipsoid: &Ellipsoid) {
        let near = ellipsoid.scaled(1.5);
        mesh.positions.iter().filter(|&&p| near.value(p) <= 0.0).for_each(|&p| self.include(p));
    }

    /// Whether the box is empty.
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

/// The camera of one frame: its position, and the projection to pixels. It is given in the world; if the head does not
/// move, head space is the world.
///
/// Pixel coordinates run right and down from the picture's upper left corner; the centre of the first pixel is
/// (0.5, 0.5). Depth is the distance along the axis of view (cm).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// The eye (cm). For an orthographic view it is well in front of everything.
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
    /// The lens, for perspective; `None` is a pinhole.
    pub lens: Option<Lens>,
}

/// The direction at `azimuth` and `elevation` (degrees): (0, 0) is +x, in front of the face; azimuth 90 is +z.
pub fn direction(azimuth: f32, elevation: f32) -> Vec3 {
    let (sin_a, cos_a) = azimuth.to_radians().sin_cos();
    let (sin_e, cos_e) = elevation.to_radians().sin_cos();
    Vec3::new(cos_e * cos_a, sin_e, cos_e * sin_a)
}

impl View {
    /// The view of `camera` for a picture of `size` pixels. If the camera does not set distance, height or target, they
    /// are chosen so that `bounds` fits. Empty bounds count as a head.
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

    /// The views of a camera that orbits its target once in `views` equal steps, starting at its position. The distance
    /// is constant: that of the step that needs most room for `bounds`.
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

    /// The camera in the space of a head with this pose.
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

    /// Pixel coordinates and depth (cm) of a point. Invalid if the depth is below [`NEAR`].
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

    /// Length in pixels of 1 cm perpendicular to the axis of view, at a depth (cm).
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

    /// The projection of a vector to the picture, for arrows: right and down, of length 1 for a unit vector in the
    /// picture plane.
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
        // What is wider than high and what is not; looked at in its middle, and far from it.
        for (size, target) in [[640, 360], [300, 640]].into_iter().flat_map(|s| [(s, None), (s, Some(Vec3::X * -15.0))])
        {
            for projection in [Projection::Perspective, Projection::Orthographic] {
                for azimuth in [0.0, 37.0, 90.0, 205.0] {
                    let camera = Camera { projection, azimuth, target, ..Camera::default() };
                    let view = View::new(&camera, size, &bounds);
                    let [width, height] = size.map(|side| side as f32);
                    let margin = camera.margin * width.min(height);
                    let spare = bounds.corners().map(|c| {
                        let p = view.project(c);
                        assert!(p.z > NEAR);
                        p.x.min(width - p.x).min(p.y).min(height - p.y) - margin
                    });
                    let tightest = spare.into_iter().fold(f32::INFINITY, f32::min);
                    // A thousandth of a pixel for each hundred: rounding of coordinates of some hundred pixels in single precision.
                    assert!(
                        tightest.abs() < 1e-5 * height.max(width),
                        "{projection:?} {azimuth} {target:?}: {tightest}"
                    );
                }
            }
        }
    }

    #[test]
    fn a_camera_that_goes_round_stays_as_far_away_and_loses_nothing() {
        let bounds = Bounds { low: Vec3::new(-9.0, -20.0, -8.0), high: Vec3::new(30.0, 12.0, 11.0) };
        for projection in [Projection::Perspective, Projection::Orthographic] {
            let camera = Camera { projection, azimuth: 17.0, elevation: 20.0, ..Camera::default() };
            let views = View::around(&camera, [640, 360], &bounds, 24);
            assert_eq!((views.len(), views[0].forward), (24, View::new(&camera, [640, 360], &bounds).forward));
            for (k, view) in views.iter().enumerate() {
                // In even steps toward her right hand and as high all the way, so that one more would be the first again.
                let there = direction(17.0 + 15.0 * k as f32, 20.0);
                assert!((-view.forward).distance(there) < 1e-5, "{k}: {}", view.forward);
            }
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

    /// What looks at `TARGET` from before the face.
    fn given() -> Camera {
        let (target, distance) = (Some(TARGET), Some(80.0));
        Camera { azimuth: 0.0, elevation: 0.0, fov: 50.0, target, distance, height: Some(30.0), ..Camera::default() }
    }

    const TARGET: Vec3 = Vec3::new(1.0, 2.0, -3.0);
    /// Coordinates of some hundred pixels are rounded, and sums of a few of them, in single precision.
    const ROUNDING: f32 = 1e-3;

    #[test]
    fn a_picture_is_as_high_as_its_field_of_view_or_its_height_and_its_pixels_are_square() {
        for size in [[640, 360], [360, 640]] {
            for (projection, half) in
                [(Projection::Perspective, 80.0 * 25.0_f32.to_radians().tan()), (Projection::Orthographic, 15.0)]
            {
                let view = View::new(&Camera { projection, ..given() }, size, &Bounds::default());
                let [width, height] = size.map(|side| side as f32);
                let (top, left) = (view.project(TARGET + half * Vec3::Y), view.project(TARGET + half * Vec3::Z));
                assert!((top.x - 0.5 * width).abs() < ROUNDING && top.y.abs() < ROUNDING, "{projection:?}: {top}");
                assert!((left.x - 0.5 * (width - height)).abs() < ROUNDING, "{projection:?}: {left}");
            }
        }
    }

    #[test]
    fn the_eye_lies_where_the_angles_say_and_its_target_in_the_middle() {
        // Before the face and above it; at her right hand; behind and below.
        for (azimuth, elevation, way) in [
            (0.0, 30.0, [0.75_f32.sqrt(), 0.5, 0.0]),
            (90.0, 0.0, [0.0, 0.0, 1.0]),
            (180.0, -30.0, [-0.75_f32.sqrt(), -0.5, 0.0]),
        ] {
            for (projection, distance) in [Projection::Perspective, Projection::Orthographic]
                .into_iter()
                .flat_map(|p| [(p, None), (p, Some(80.0))])
            {
                let camera = Camera { projection, distance, azimuth, elevation, ..given() };
                let view = View::new(&camera, [640, 360], &Bounds::default());
                let middle = view.project(TARGET).truncate();
                assert!(middle.distance(glam::vec2(320.0, 180.0)) < ROUNDING, "{camera:?}: {middle}");
                let off = view.eye - TARGET;
                assert!(off.normalize().distance(way.into()) < 1e-6, "{camera:?}: {off}");
                assert!(distance.is_none_or(|distance| (off.length() - distance).abs() < 1e-4), "{camera:?}: {off}");
            }
        }
    }

    #[test]
    fn a_view_depends_on_what_is_to_be_framed_exactly_where_its_camera_is_automatic() {
        let [small, large] = [9.0, 12.0].map(|far| Bounds { low: Vec3::splat(-far), high: Vec3::splat(2.0 * far) });
        for bits in 0..16 {
            let (keep, mut camera) = (|bit: i32| bits >> bit & 1 == 1, given());
            camera.projection = if keep(0) { Projection::Perspective } else { Projection::Orthographic };
            camera.target = camera.target.filter(|_| keep(1));
            camera.distance = camera.distance.filter(|_| keep(2));
            camera.height = camera.height.filter(|_| keep(3));
            let [a, b] = [small, large].map(|bounds| View::new(&camera, [64, 36], &bounds));
            assert_eq!(camera.is_automatic(), a != b, "{camera:?}");
        }
    }

    #[test]
    fn hair_is_framed_to_its_tips_and_the_head_without_its_shoulders() {
        let mut strands = Strands::default();
        strands.push([Vec3::ZERO, Vec3::new(-3.0, 4.0, 5.0), Vec3::new(6.0, -30.0, 2.0)]);
        let mut bounds = Bounds::default();
        bounds.include_strands(&strands);
        assert_eq!(bounds, Bounds { low: Vec3::new(-3.0, -30.0, 0.0), high: Vec3::new(6.0, 4.0, 5.0) });
        let positions = vec![Vec3::new(0.0, 14.0, 0.0), Vec3::new(0.0, -16.0, 20.0)];
        let mut bounds = Bounds::default();
        let ellipsoid = Ellipsoid { center: Vec3::ZERO, half_axes: Vec3::splat(10.0) };
        bounds.include_head(&Mesh { positions, ..Mesh::default() }, &ellipsoid);
        assert_eq!(bounds, Bounds { low: Vec3::new(0.0, 14.0, 0.0), high: Vec3::new(0.0, 14.0, 0.0) });
    }

    #[test]
    fn a_camera_on_its_way_leaves_one_view_for_the_other_and_is_in_the_middle_halfway() {
        let view = |azimuth, elevation, fov, distance: f32| {
            let camera = Camera { azimuth, elevation, fov, distance: Some(distance), f_stop: Some(2.0), ..given() };
            View::new(&Camera { focus_distance: Some(distance - 9.0), ..camera }, [64, 36], &Bounds::default())
        };
        let (a, b) = (view(10.0, -5.0, 30.0, 60.0), view(50.0, 25.0, 40.0, 80.0));
        let numbers = |view: &View| {
            let lens = view.lens.unwrap();
            let axes = [view.eye, view.right, view.up, view.forward].map(|v| v.to_array());
            [axes.as_flattened(), &[view.scale, lens.diameter, lens.focus.unwrap()]].concat()
        };
        let apart = |a: &View, b: &View| {
            numbers(a).iter().zip(numbers(b)).map(|(a, b)| (a - b).abs() / b.abs().max(1.0)).fold(0.0, f32::max)
        };
        // A turn there and back is some roundings of unit vectors.
        assert!(apart(&View::between(&a, &b, 0.0), &a) < 1e-6 && apart(&View::between(&a, &b, 1.0), &b) < 1e-6);
        let middle = View::between(&a, &b, 0.5);
        let halfway = |of: fn(&View) -> f32| (of(&middle) - 0.5 * (of(&a) + of(&b))).abs() < 1e-4;
        assert!(halfway(|v| v.scale) && halfway(|v| v.eye.x) && halfway(|v| v.eye.y) && halfway(|v| v.eye.z));
        assert!(halfway(|v| v.lens.unwrap().diameter) && halfway(|v| v.lens.unwrap().focus.unwrap()));
        let (from, to) = (middle.forward.angle_between(a.forward), middle.forward.angle_between(b.forward));
        assert!((from - to).abs() < 1e-3 && from > 0.2, "{from} {to}");
    }

    #[test]
    fn an_arrow_points_where_what_it_stands_for_moves_on_the_picture() {
        let view = View::new(
            &Camera { azimuth: 35.0, elevation: 20.0, projection: Projection::Orthographic, ..given() },
            [64, 36],
            &Bounds::default(),
        );
        for v in [Vec3::X, Vec3::Y, Vec3::Z, Vec3::new(1.0, -2.0, 2.0) / 3.0] {
            let moved = (view.project(5.0 * v) - view.project(Vec3::ZERO)).truncate() / (5.0 * view.scale);
            let [x, y] = view.in_picture(7.0 * v);
            assert!(moved.distance(glam::vec2(x, y)) < 1e-5, "{v}: {x} {y}, not {moved}");
        }
    }
}
