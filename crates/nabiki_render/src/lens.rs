//! The lens of a camera: a thin lens. Seen through all its points, objects in focus are at the same place, and others
//! are apart.
//!
//! Seen through the point o of the lens (cm, from its middle), an object at depth z moves on the picture by `scale` o
//! (1 / F - 1 / z), where F is the depth in focus. The circle of confusion is the lens scaled by that factor. Straight
//! lines stay straight.

use crate::settings::Camera;

/// Height of the picture on the sensor (cm): that of a 35 mm camera, by which photographers know their lenses.
const SENSOR_HEIGHT: f32 = 2.4;

/// A thin lens, and a point on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lens {
    /// Diameter (cm).
    pub diameter: f32,
    /// Depth in focus (cm along the axis of view); `None` is the near side of the head.
    pub focus: Option<f32>,
    /// The point of the lens, right and up from the middle (radii of the lens).
    pub through: [f32; 2],
}

impl Lens {
    /// The lens of a scene's camera; `None` for a pinhole.
    pub fn of(camera: &Camera) -> Option<Self> {
        let focal_length = 0.5 * SENSOR_HEIGHT / (0.5 * camera.fov.to_radians()).tan();
        let diameter = focal_length / camera.f_stop?;
        Some(Self { diameter, focus: camera.focus_distance, through: [0.0; 2] })
    }

    /// A lens that is pulled from one focus to another: `part` (0..1) of the way from `a` to `b`.
    pub(crate) fn between(a: Self, b: Self, part: f32) -> Self {
        let mix = |a: f32, b: f32| a + (b - a) * part;
        let focus = a.focus.zip(b.focus).map_or(b.focus, |(a, b)| Some(mix(a, b)));
        Self { diameter: mix(a.diameter, b.diameter), focus, ..b }
    }

    /// How far off, for a point of the lens one radius off its middle, what lies at a depth (cm) appears, where 1 cm at depth 1 cm
    /// is `scale` pixels: the radius of its circle of confusion (pixels), below 0 before the plane that is sharp.
    #[inline]
    pub(crate) fn blur(&self, depth: f32, scale: f32) -> f32 {
        0.5 * self.diameter * scale * (self.focus.map_or(0.0, f32::recip) - depth.recip())
    }

    /// How far what lies at a depth moves on the picture (pixels right and down) for being seen through this point of the lens.
    #[inline]
    pub(crate) fn shift(&self, depth: f32, scale: f32) -> [f32; 2] {
        let blur = self.blur(depth, scale);
        [self.through[0] * blur, -self.through[1] * blur]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_f_stop_counts_as_that_of_a_35_mm_camera() {
        // 24 mm across 26 degrees: a lens of 52 mm.
        let lens = Lens::of(&Camera { f_stop: Some(2.0), ..Camera::default() }).unwrap();
        assert!((lens.diameter - 2.6).abs() < 0.01, "{}", lens.diameter);
        assert_eq!(Lens::of(&Camera::default()), None);
    }
}
