//! Wind that flows around the head: the exact potential flow of a uniform wind about an ellipsoid (H. Lamb,
//! "Hydrodynamics", 114).

mod carlson;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use glam::{Mat3, Vec3};

use super::head_track::{HeadTrack, Place};
use super::lanes::{self, Lanes, by_part, get, set, times, transposed_times};
use super::{Field, VectorRow};
use crate::ellipsoid::Ellipsoid;
use crate::error::SettingError;
use crate::pose::Pose;
use crate::settings;
use crate::vector::{dot, scale, scale_add, subtract};
use carlson::{alpha, expansion, mean_square};

settings! {
    /// Leads the wind around the head instead of through it.
    pub struct Flow in "flow" {
        /// Thickness of the hair on the head ellipsoid: the wind flows around this layer too. Raise it for voluminous
        /// hair.
        pub thickness: f32 = 0.0 => "Thickness", unit "cm", least 0.0, most 100.0;
    }
}

/// A wind that is uniform far from the head and flows around it.
///
/// Outside the ellipsoid the force has no divergence and no curl. On the ellipsoid it has no normal component: it is 0
/// where the wind meets the ellipsoid and largest at its sides (1.5 times the wind for a sphere). Inside there is no
/// flow, so hair there gets the force at the surface in front of it, weakened by the square of the distance from the
/// centre in half axes. The force is therefore continuous everywhere and 0 at the centre.
#[derive(Clone, Debug)]
pub struct FlowField {
    wind: Arc<dyn Field>,
    head: HeadTrack,
    half_axes: [f32; 3],
    /// R^2 of the expansions.
    mean_square: f32,
    /// k_i = 1 / (2 - alpha_i(0)).
    gains: [f32; 3],
    /// alpha_i / tau^3 of every axis, as many terms of each.
    expansions: Vec<[f32; 3]>,
}

impl FlowField {
    /// `wind` around `ellipsoid` (head space). `poses` are those of the head in the space of the field, one per frame
    /// from frame 0 on; the last one holds after that, and none means that it does not move. A wind that varies in
    /// space counts as it is at the centre.
    ///
    /// # Errors
    /// Settings out of range, invalid poses, or half axes too different to compute the flow (beyond about 1 : 5).
    pub fn new(
        settings: &Flow,
        wind: Arc<dyn Field>,
        ellipsoid: Ellipsoid,
        poses: &[Pose],
    ) -> Result<Self, SettingError> {
        settings.check()?;
        let ellipsoid = Ellipsoid { half_axes: ellipsoid.half_axes + settings.thickness, ..ellipsoid };
        let head = HeadTrack::new(ellipsoid, poses)?;
        let half_axes = ellipsoid.half_axes.to_array();
        let axes = half_axes.map(f64::from);
        let expanded: Option<Vec<Vec<f32>>> = (0..3).map(|i| expansion(axes, i)).collect();
        let Some(expanded) = expanded else {
            let remedy = "too flat or too long for [flow]: make the half axes more alike, or remove [flow]";
            return Err(SettingError::new("head.ellipsoid.half_axes", ellipsoid.half_axes, remedy));
        };
        let terms = expanded.iter().map(Vec::len).max().unwrap_or_default();
        let term = |j: usize| [0, 1, 2].map(|i| expanded[i].get(j).copied().unwrap_or_default());
        Ok(Self {
            wind,
            head,
            half_axes,
            mean_square: mean_square(axes) as f32,
            gains: [0, 1, 2].map(|i| (1.0 / (2.0 - alpha(axes, i, 0.0))) as f32),
            expansions: (0..terms).map(term).collect(),
        })
    }

    /// The wind far from the head.
    fn far(&self, frame: u32) -> Vec3 {
        self.wind.uniform(frame).unwrap_or_else(|| self.wind.at(self.head.center(frame), frame))
    }

    /// The largest ratio of the flow to the wind: 2 / (2 - alpha_i(0)) for the shortest way around, 1.5 for a sphere.
    pub fn largest_part(&self) -> f32 {
        // A little more, for the rounding of the flow itself.
        self.gains.iter().fold(0.0_f32, |m, &k| m.max(2.0 * k)) * (1.0 + 1e-5)
    }

    fn in_frame(&self, frame: u32) -> InFrame<'_> {
        let place = *self.head.place(frame);
        let wind = (Mat3::from_cols_array_2d(&place.axes).transpose() * self.far(frame)).to_array();
        InFrame { field: self, place, wind }
    }
}

/// The flow in one frame.
struct InFrame<'a> {
    field: &'a FlowField,
    place: Place,
    /// U along the axes of the ellipsoid.
    wind: [f32; 3],
}

/// Newton steps toward lambda. Half axes of 1 : 2 need three.
const STEPS: usize = 4;

impl InFrame<'_> {
    /// lambda of a point, given by its coordinates squared: the largest root of sum x_i^2 / (a_i^2 + lambda) = 1, or 0
    /// inside.
    ///
    /// 1 / sum is concave, and linear for a sphere: Newton's method on it comes from below and meets the root at once where
    /// the ellipsoid is nearly round.
    #[inline(always)]
    fn lambda(&self, squares: [f32; 3]) -> f32 {
        let axes = by_part(self.field.half_axes, self.field.half_axes);
        let longest = axes[0].max(axes[1]).max(axes[2]);
        let mut lambda = (squares[0] + squares[1] + squares[2] - longest).max(0.0);
        for _ in 0..STEPS {
            let inverse = inverses(axes, lambda);
            let parts = by_part(squares, inverse);
            let sum = parts[0] + parts[1] + parts[2];
            let slope = dot(parts, inverse).max(f32::MIN_POSITIVE);
            lambda = (sum * (sum - 1.0) / slope + lambda).max(0.0);
        }
        lambda
    }

    /// The force at x, from the centre along the axes, once alpha_i(lambda) is known.
    #[inline(always)]
    fn force(&self, x: [f32; 3], lambda: f32, alpha: [f32; 3]) -> [f32; 3] {
        let FlowField { half_axes, gains, .. } = *self.field;
        let inverse = inverses(by_part(half_axes, half_axes), lambda);
        let product = half_axes[0] * half_axes[1] * half_axes[2];
        let delta = (inverse[0] * inverse[1] * inverse[2]).sqrt();
        // grad lambda = 2 y / |y|^2, alpha_i' = -a b c / ((a_i^2 + lambda) Delta).
        let y = by_part(x, inverse);
        let with_gains = by_part(self.wind, gains);
        let along = dot(with_gains, y);
        let back = -2.0 * product * delta * along / dot(y, y).max(f32::MIN_POSITIVE);
        let q = [x[0] / half_axes[0], x[1] / half_axes[1], x[2] / half_axes[2]];
        let inside = dot(q, q).min(1.0);
        let bent = by_part(with_gains, alpha);
        let straight = [self.wind[0] + bent[0], self.wind[1] + bent[1], self.wind[2] + bent[2]];
        scale(inside, scale_add(back, y, straight))
    }
}

/// 1 / (a_i^2 + lambda).
#[inline(always)]
fn inverses(squares: [f32; 3], lambda: f32) -> [f32; 3] {
    [(squares[0] + lambda).recip(), (squares[1] + lambda).recip(), (squares[2] + lambda).recip()]
}

impl Lanes for InFrame<'_> {
    #[allow(clippy::needless_range_loop, reason = "a loop over lanes, as in the kernel")]
    #[inline(always)]
    fn forces<const N: usize>(&self, points: &[[f32; N]; 3]) -> [[f32; N]; 3] {
        let mut x = [[0.0; N]; 3];
        let mut lambda = [0.0; N];
        let mut tau2 = [0.0; N];
        for lane in 0..N {
            let in_axes = times(&self.place.axes, subtract(get(points, lane), self.place.center));
            set(&mut x, lane, in_axes);
            lambda[lane] = self.lambda(by_part(in_axes, in_axes));
            tau2[lane] = self.field.mean_square / (self.field.mean_square + lambda[lane]);
        }
        // Clenshaw's recurrence.
        let mut before = [[0.0; N]; 3];
        let mut last = [[0.0; N]; 3];
        for coefficients in self.field.expansions.iter().skip(1).rev() {
            for axis in 0..3 {
                for lane in 0..N {
                    let twice = 4.0 * tau2[lane] - 2.0;
                    let next = twice.mul_add(last[axis][lane], coefficients[axis] - before[axis][lane]);
                    before[axis][lane] = last[axis][lane];
                    last[axis][lane] = next;
                }
            }
        }
        let first = self.field.expansions[0];
        let mut forces = [[0.0; N]; 3];
        for lane in 0..N {
            let half = 2.0 * tau2[lane] - 1.0;
            let series = scale_add(half, get(&last, lane), subtract(first, get(&before, lane)));
            let alpha = scale(tau2[lane] * tau2[lane].sqrt(), series);
            let in_axes = self.force(get(&x, lane), lambda[lane], alpha);
            set(&mut forces, lane, transposed_times(&self.place.axes, in_axes));
        }
        forces
    }
}

impl Field for FlowField {
    fn at(&self, point: Vec3, frame: u32) -> Vec3 {
        lanes::at(&self.in_frame(frame), point)
    }

    fn at_row(&self, points: &VectorRow, frame: u32, forces: &mut VectorRow) {
        lanes::at_row(&self.in_frame(frame), points, forces);
    }

    /// |grad phi| of a potential is largest on the boundary. There the flow is W less its part along the normal, with
    /// W_i = U_i 2 / (2 - alpha_i(0)).
    fn strongest(&self) -> f32 {
        self.wind.strongest() * self.largest_part()
    }

    /// Blames the wind if it is too strong by itself, or else the flow around the head.
    fn first_above(&self, limit: f64) -> Option<(String, String)> {
        let strongest = self.strongest();
        self.wind.first_above(limit).or_else(|| {
            let value =
                format!("a wind of {}, {} times as strong beside the head", self.wind.strongest(), self.largest_part());
            (f64::from(strongest) > limit).then(|| ("flow".to_owned(), value))
        })
    }

    /// Without wind there is no flow.
    fn uniform(&self, frame: u32) -> Option<Vec3> {
        (self.far(frame) == Vec3::ZERO).then_some(Vec3::ZERO)
    }
}
