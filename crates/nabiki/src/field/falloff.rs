//! How a local force weakens with distance and varies over time.

use crate::error::SettingError;
use crate::setting::{Place, refused};
use crate::{settings, words};

settings! {
    /// How a local force weakens with the distance r.
    #[derive(Copy)]
    pub struct Falloff {
        /// The law by which the force weakens with distance.
        pub law: FalloffLaw = FalloffLaw::Smooth => "Falloff";
        /// Radius R of the law. Within a twentieth of it the force fades to 0.
        pub radius: f32 = 30.0 => "Radius", unit "cm", above 0.0;
    }
}

words! {
    /// How a local force weakens with the distance r, by the radius R.
    pub enum FalloffLaw = Smooth {
        /// Full strength at any distance. R sets only the size of the core.
        None = "none",
        /// 1 - r / R, and 0 beyond R.
        Linear = "linear",
        /// 1 - 3 (r / R)^2 + 2 (r / R)^3, and 0 beyond R.
        Smooth = "smooth",
        /// 1 / (1 + r / R): half at R.
        Inverse = "inverse",
        /// 1 / (1 + (r / R)^2): half at R.
        InverseSquare = "inverse_square",
    }
}

impl Falloff {
    /// Part of the radius within which the direction of a force without one at its centre fades to 0.
    pub(super) const CORE: f32 = 0.05;

    /// The factor on the strength at a distance (cm), 0..1.
    pub fn at(&self, distance: f32) -> f32 {
        let [part] = self.at_roots(&[distance * distance]);
        part
    }

    /// The same at distances given by their squares.
    #[inline(always)]
    pub(super) fn at_roots<const N: usize>(&self, squares: &[f32; N]) -> [f32; N] {
        let mut x = *squares;
        for x in &mut x {
            *x = x.sqrt() / self.radius;
        }
        // One law for all lanes: a choice in each would prevent vector code.
        match self.law {
            FalloffLaw::None => x = [1.0; N],
            FalloffLaw::Linear => x.iter_mut().for_each(|x| *x = within(*x)),
            FalloffLaw::Smooth => {
                for x in &mut x {
                    // 3 w^2 - 2 w^3 of the remaining way.
                    let left = within(*x);
                    *x = left * left * left.mul_add(-2.0, 3.0);
                }
            }
            FalloffLaw::Inverse => x.iter_mut().for_each(|x| *x = (1.0 + *x).recip()),
            FalloffLaw::InverseSquare => {
                for x in &mut x {
                    *x = x.mul_add(*x, 1.0).recip();
                }
            }
        }
        x
    }
}

/// The remaining part of the way to the radius.
#[inline(always)]
fn within(x: f32) -> f32 {
    (1.0 - x).max(0.0)
}

settings! {
    /// A keyframe of the strength.
    #[derive(Copy)]
    pub struct EnvelopeKey {
        /// The frame.
        pub frame: u32 = 0 => "Frame", must "1";
        /// Factor on the strength, any finite number.
        pub factor: f32 = 1.0 => "Factor", must "1.0";
    }
}

/// The factor on the strength in a frame: linear between keys, constant before the first and after the last. Without
/// keys it is 1.
pub fn envelope(keys: &[EnvelopeKey], frame: u32) -> f32 {
    let next = keys.partition_point(|key| key.frame < frame);
    match (next.checked_sub(1).map(|i| keys[i]), keys.get(next)) {
        (None, None) => 1.0,
        (None, Some(key)) => key.factor,
        (Some(key), None) => key.factor,
        (Some(a), Some(b)) => {
            let t = f64::from(frame - a.frame) / f64::from(b.frame - a.frame);
            (f64::from(a.factor) * (1.0 - t) + f64::from(b.factor) * t) as f32
        }
    }
}

/// Largest size of [`envelope`] in any frame.
pub(super) fn largest(keys: &[EnvelopeKey]) -> f32 {
    if keys.is_empty() { 1.0 } else { keys.iter().map(|key| key.factor.abs()).fold(0.0, f32::max) }
}

/// Refuses keys of the table `at` whose frames do not ascend.
pub(super) fn check_order(at: &Place, keys: &[EnvelopeKey]) -> Result<(), SettingError> {
    let Some(i) = keys.windows(2).position(|pair| pair[1].frame <= pair[0].frame) else { return Ok(()) };
    let remedy = format!("must come after frame {}, the frame of the key before it", keys[i].frame);
    refused(&at.key("envelope").entry(i + 1).key("frame"), keys[i + 1].frame, remedy)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_law_begins_with_all_and_never_grows() {
        let laws =
            [FalloffLaw::None, FalloffLaw::Linear, FalloffLaw::Smooth, FalloffLaw::Inverse, FalloffLaw::InverseSquare];
        for (law, at_radius) in laws.into_iter().zip([1.0, 0.0, 0.0, 0.5, 0.5]) {
            let falloff = Falloff { law, radius: 20.0 };
            assert_eq!((falloff.at(0.0), falloff.at(20.0)), (1.0, at_radius));
            let parts: Vec<f32> = (0..200).map(|i| falloff.at(0.3 * i as f32)).collect();
            assert!(parts.windows(2).all(|w| (0.0..=w[0]).contains(&w[1])), "{law:?}");
        }
    }

    #[test]
    fn each_law_is_its_formula() {
        let formula = |law: FalloffLaw, x: f64| match law {
            FalloffLaw::None => 1.0,
            FalloffLaw::Linear => 1.0 - x.min(1.0),
            FalloffLaw::Smooth => 1.0 - 3.0 * x.min(1.0).powi(2) + 2.0 * x.min(1.0).powi(3),
            FalloffLaw::Inverse => 1.0 / (1.0 + x),
            FalloffLaw::InverseSquare => 1.0 / (1.0 + x * x),
        };
        let laws =
            [FalloffLaw::None, FalloffLaw::Linear, FalloffLaw::Smooth, FalloffLaw::Inverse, FalloffLaw::InverseSquare];
        for law in laws {
            for i in 0..100 {
                let r = 0.4 * i as f32;
                let x = f64::from(r) / 20.0;
                let expected = formula(law, x);
                // A few roundings of numbers below 3.
                let part = f64::from(Falloff { law, radius: 20.0 }.at(r));
                assert!((part - expected).abs() < 1e-6, "{law:?} at {x}: {part}, not {expected}");
            }
        }
    }

    #[test]
    fn an_envelope_goes_straight_from_key_to_key() {
        let keys = [(10, 0.0), (20, 2.0), (40, -1.0)].map(|(frame, factor)| EnvelopeKey { frame, factor });
        for (frame, factor) in [(0, 0.0), (10, 0.0), (15, 1.0), (20, 2.0), (30, 0.5), (40, -1.0), (99, -1.0)] {
            assert_eq!(envelope(&keys, frame), factor, "frame {frame}");
        }
        assert_eq!((envelope(&[], 7), largest(&[]), largest(&keys)), (1.0, 1.0, 2.0));
        let twice = [keys[0], keys[0]];
        assert_eq!(check_order(&Place::Table("fan[0]"), &twice).unwrap_err().thing, "fan[0].envelope[1].frame");
    }
}
