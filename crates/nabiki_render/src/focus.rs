//! What a lens does to a view: the points that it is looked through, how wide hair is spread, what is sharp.

use glam::Vec3;
use nabiki::{Ellipsoid, Mesh, SettingError};

use crate::camera::View;
use crate::lens::Lens;
use crate::settings::NEAR;

/// The points of a lens that a picture is the mean of, and how much of the lens each stands for.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct LensPoints {
    /// Right and up from the middle (radii of the lens).
    pub points: Vec<[f32; 2]>,
    /// Half of the width to which hair is spread for each (radii of the circle of confusion).
    pub spread: f32,
}

/// Half the width of the strip that hair becomes at one point of the lens, in radii of a disc with that point's share of the lens. So wide
/// strips overlap, and no single ones show.
const OVERLAP: f32 = 1.25;

impl LensPoints {
    /// As many points, in the order of a sunflower's seeds: each has an equal part of the disc, and from no side do many lie in a line.
    /// They lie so much nearer to the middle that they and the strips together are as wide (root mean square) as the lens.
    pub fn new(count: usize) -> Self {
        let spread = OVERLAP / (count as f32).sqrt();
        // Across a disc of radius 1 the mean square is 1/4, across a strip of half the width b it is b^2 / 3.
        let reach = (1.0 - 4.0 / 3.0 * spread * spread).sqrt();
        let turn = std::f32::consts::PI * (3.0 - 5.0_f32.sqrt());
        let seed = |i: usize| {
            let from_middle = reach * ((i as f32 + 0.5) / count as f32).sqrt();
            let (sin, cos) = (i as f32 * turn).sin_cos();
            [from_middle * cos, from_middle * sin]
        };
        Self { points: evened((0..count).map(seed).collect(), 0.5 * reach), spread }
    }

    /// Enough that no single ones show where the circles of confusion of hair and of skin have these radii (pixels): edges of skin are not
    /// widened, and show more. A power of two, so that the mean of what is the same through all of them is that.
    pub fn for_blur(hair: f32, skin: f32) -> Self {
        let enough = [(16, 24.0, 4.0), (32, 64.0, 9.0), (64, f32::INFINITY, 24.0)];
        let enough = enough.into_iter().find(|&(_, h, s)| hair <= h && skin <= s);
        Self::new(enough.map_or(128, |(count, ..)| count))
    }
}

/// The points moved so little that their mean is the middle and that they are equally wide to all sides: what is blurred stays where it
/// is. `width`: root mean square along any direction.
fn evened(mut points: Vec<[f32; 2]>, width: f32) -> Vec<[f32; 2]> {
    let count = points.len() as f32;
    let mean = |points: &[[f32; 2]], of: fn(&[f32; 2]) -> f32| points.iter().map(of).sum::<f32>() / count;
    let middle = [mean(&points, |p| p[0]), mean(&points, |p| p[1])];
    points.iter_mut().for_each(|p| *p = [p[0] - middle[0], p[1] - middle[1]]);
    let (xx, xy) = (mean(&points, |p| p[0] * p[0]), mean(&points, |p| p[0] * p[1]));
    points.iter_mut().for_each(|p| p[1] -= xy / xx * p[0]);
    let yy = mean(&points, |p| p[1] * p[1]);
    points.iter().map(|p| [p[0] * width / xx.sqrt(), p[1] * width / yy.sqrt()]).collect()
}

/// By how much hair is spread on the picture at its depth, for one point of the lens.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Spread {
    /// Pixels, for a difference of 1 between one over the depth and one over the depth that is sharp (1/cm); 0 without a lens.
    per: f32,
    per_focus: f32,
}

impl Spread {
    /// At one of these points of the lens of a view.
    pub fn new(view: &View, points: &LensPoints) -> Self {
        view.lens.map_or(Self::default(), |lens| Self {
            per: 0.5 * lens.diameter * view.scale * points.spread,
            per_focus: lens.focus.map_or(0.0, f32::recip),
        })
    }

    /// Half the width (pixels) at a depth (cm).
    #[inline(always)]
    pub fn at(&self, depth: f32) -> f32 {
        if self.per == 0.0 { 0.0 } else { self.per * (self.per_focus - depth.recip()).abs() }
    }
}

/// What a lens without a distance to focus on is focused on: a head.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Subject(pub Ellipsoid);

impl Subject {
    /// A head of which nothing but its surface is known.
    pub fn of_mesh(head: &Mesh) -> Self {
        let (low, high) = (head.positions.iter())
            .fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), &p| (low.min(p), high.max(p)));
        let known = low.cmple(high).all();
        let (center, half_axes) =
            if known { (0.5 * (low + high), 0.5 * (high - low)) } else { (Vec3::ZERO, Vec3::ZERO) };
        Self(Ellipsoid { center, half_axes })
    }

    /// The view (in head space) with its lens focused, on the near side of the head unless a distance is given.
    pub fn focus(&self, view: &View) -> Result<View, SettingError> {
        let Some(lens) = view.lens.filter(|lens| lens.focus.is_none()) else { return Ok(*view) };
        let middle = (self.0.center - view.eye).dot(view.forward);
        let near_side = middle - (self.0.half_axes * view.forward).length();
        if near_side < NEAR {
            let way_out = "is needed, because the eye is not in front of the head: give a distance (cm)";
            return Err(SettingError::new("picture.camera.focus_distance", "", way_out));
        }
        Ok(View { lens: Some(Lens { focus: Some(near_side), ..lens }), ..*view })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::Camera;

    #[test]
    fn points_and_strips_together_are_as_wide_as_the_lens_on_every_side() {
        for count in [16, 32, 64, 256] {
            let LensPoints { points, spread } = LensPoints::new(count);
            for side in 0..12 {
                let (sin, cos) = (side as f32 * 15.0).to_radians().sin_cos();
                let along = |p: &[f32; 2]| p[0] * cos + p[1] * sin;
                let middle = points.iter().map(along).sum::<f32>() / count as f32;
                let square = points.iter().map(|p| along(p).powi(2)).sum::<f32>() / count as f32;
                // Rounding of sums of numbers up to 1.
                assert!(middle.abs() < 1e-6, "{count} {side}: {middle}");
                let wide = square + spread * spread / 3.0;
                assert!((wide - 0.25).abs() < 1e-6, "{count} {side}: {wide}");
            }
        }
    }

    #[test]
    fn a_point_of_the_lens_sees_what_a_pinhole_there_sees_that_keeps_the_sharp_plane_in_its_place() {
        let camera =
            Camera { f_stop: Some(1.4), focus_distance: Some(40.0), distance: Some(50.0), ..Camera::default() };
        let camera = Camera { target: Some(Vec3::ZERO), ..camera };
        let seen = View::new(&camera, [320, 180], &crate::Bounds::default());
        let lens = seen.lens.unwrap();
        let sharp = seen.eye + 40.0 * seen.forward;
        for through in [[0.9, 0.0], [0.0, 0.9], [-0.5, 0.4]] {
            let [right, up] = through.map(|c| 0.5 * lens.diameter * c);
            let eye = seen.eye + right * seen.right + up * seen.up;
            let pinhole = View { eye, lens: None, ..seen };
            let through = View { lens: Some(Lens { through, ..lens }), ..seen };
            let in_place = seen.project(sharp) - pinhole.project(sharp);
            for p in [Vec3::ZERO, Vec3::new(20.0, 3.0, -5.0), Vec3::new(-30.0, -8.0, 9.0)] {
                let (found, wanted) = (through.project(p), pinhole.project(p) + in_place);
                // Coordinates of some hundred pixels, rounded a few times.
                assert!(found.distance(wanted) < 1e-3, "{p}: {found}, not {wanted}");
                assert!(through.toward_lens(p).distance((eye - p).normalize()) < 1e-6);
            }
        }
    }
}
