//! Pseudo-force: wind that would press hair into the head is weakened (section 3.2.2 and equation (4)).

use glam::{DVec3, Vec3};

use crate::ellipsoid::Ellipsoid;
use crate::error::SettingError;
use crate::setting::{Place, refused};
use crate::settings;

settings! {
    /// The pseudo-force: it weakens the wind in front of the head, in place of collisions. The defaults are Table 1 of
    /// the paper.
    pub struct PseudoForce in "pseudo_force" where has_coefficients {
        /// Cosine that bounds the domain Gamma: alpha of equation (4). 1 covers the whole shell, -1 only the line
        /// against the wind.
        pub alpha: f32 = -0.75 => "Alpha", least -1.0, most 1.0;
        /// Factor eps_i on the wind for each segment, from the root on. The last one continues to the tip. If segments
        /// are not `hair.segment_length` long, i counts the distance along the strand in that length.
        pub coefficients: Vec<f32> = table_1() => "Coefficients", above 0.0, most 1.0;
    }
}

fn table_1() -> Vec<f32> {
    let table_1 = [(2, 0.01), (2, 0.1), (4, 0.2), (4, 0.4), (3, 0.8), (1, 1.0)];
    table_1.iter().flat_map(|&(times, eps)| std::iter::repeat_n(eps, times)).collect()
}

impl PseudoForce {
    /// No pseudo-force: every eps_i is 1, so Gamma has no effect.
    pub fn off() -> Self {
        Self { alpha: -1.0, coefficients: vec![1.0] }
    }

    fn has_coefficients(&self, at: &Place) -> Result<(), SettingError> {
        if !self.coefficients.is_empty() {
            return Ok(());
        }
        refused(&at.key("coefficients"), "[]", "give at least one eps_i (1.0 switches the pseudo-force off)")
    }

    /// eps_i for a `position` along the strand, rounded to the nearest i. For the paper's segments the position is i
    /// itself; finer segments lie between these numbers.
    pub fn coefficient(&self, position: f64) -> f32 {
        let i = position.round().max(1.0) as usize;
        self.coefficients[(i - 1).min(self.coefficients.len() - 1)]
    }
}

/// The domain Gamma(alpha, C, E) of equation (4), for one force.
#[derive(Clone, Copy, Debug)]
pub struct Gamma {
    /// The head ellipsoid E.
    pub ellipsoid: Ellipsoid,
    /// C is E scaled by this factor, above 1.
    pub shell: f32,
    /// The cosine alpha.
    pub alpha: f32,
}

impl Gamma {
    /// Whether p lies inside C and outside E, where the outward normal D(p) points against `force` as equation (4)
    /// requires.
    pub fn contains(&self, p: DVec3, force: Vec3) -> bool {
        let (center, half_axes) = (self.ellipsoid.center.as_dvec3(), self.ellipsoid.half_axes.as_dvec3());
        let (alpha, shell, force) = (f64::from(self.alpha), f64::from(self.shell), force.as_dvec3());
        let from_center = p - center;
        let radius_squared = (from_center / half_axes).length_squared();
        let normal = from_center / (half_axes * half_axes);
        let in_shell = radius_squared > 1.0 && radius_squared <= shell * shell;
        in_shell && normal.dot(force) <= alpha * normal.length() * force.length()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEAD: Ellipsoid = Ellipsoid { center: Vec3::new(1.0, 2.0, 3.0), half_axes: Vec3::new(9.0, 11.0, 8.0) };

    #[test]
    fn table_1_gives_eighteen_coefficients() {
        let eps: Vec<f32> = (1..=18).map(|i| PseudoForce::default().coefficient(f64::from(i))).collect();
        let paper = [0.01, 0.01, 0.1, 0.1, 0.2, 0.2, 0.2, 0.2, 0.4, 0.4, 0.4, 0.4, 0.8, 0.8, 0.8, 1.0, 1.0, 1.0];
        assert_eq!(eps, paper);
    }

    #[test]
    fn alpha_1_is_all_of_the_shell_and_alpha_minus_1_only_the_line_against_the_wind() {
        let wind = Vec3::new(0.0, 0.0, -500.0);
        let gamma = |alpha| Gamma { ellipsoid: HEAD, shell: 1.25, alpha };
        let at = |x: f64, y: f64, z: f64| HEAD.center.as_dvec3() + DVec3::new(x, y, z);
        let windward = at(0.0, 0.0, 9.0);
        let (leeward, above, far, inside) =
            (at(0.0, 0.0, -9.0), at(0.0, 12.0, 0.0), at(0.0, 0.0, 10.1), at(0.0, 0.0, 7.9));
        for p in [windward, leeward, above] {
            assert!(gamma(1.0).contains(p, wind), "{p}");
        }
        assert!(gamma(-1.0).contains(windward, wind));
        assert!(!gamma(-1.0).contains(at(0.1, 0.0, 9.0), wind));
        assert!(!gamma(-0.75).contains(leeward, wind) && !gamma(-0.75).contains(above, wind));
        for p in [far, inside] {
            assert!(!gamma(1.0).contains(p, wind), "{p}");
        }
    }

    #[test]
    fn settings_outside_the_papers_ranges_are_refused() {
        let with = |alpha, coefficients: &[f32]| PseudoForce { alpha, coefficients: coefficients.to_vec() }.check();
        assert!(PseudoForce::default().check().is_ok() && PseudoForce::off().check().is_ok());
        for alpha in [-1.01, 1.01, f32::NAN] {
            assert_eq!(with(alpha, &[1.0]).unwrap_err().thing, "pseudo_force.alpha");
        }
        for eps in [0.0, -0.1, 1.01, f32::NAN] {
            assert_eq!(with(0.0, &[0.5, eps]).unwrap_err().thing, "pseudo_force.coefficients[1]");
        }
        assert!(with(0.0, &[]).is_err());
    }
}
