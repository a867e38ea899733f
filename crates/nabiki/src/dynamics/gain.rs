//! Inertia and gain: equations (3), (6), (8), for segments of any length.
//!
//! The paper's strand has k segments of one length d. With its own length L = k d, equation (8) reads
//! c_i = 3 (i d) d dt^2 / (2 lambda L^4): it knows nothing of the number of segments but through d, the lever, and
//! i, the place. Imported hair keeps that d, `hair.segment_length`, as the unit in which both are counted, however
//! finely its strands are cut: k = L / d, and i = m / d + 1/2 for a segment whose middle is m away from the root,
//! which is i itself for segments as long as d. So 16 and 32 points of one strand move alike, up to the square of
//! the segment's length.

use super::Dynamics;
use crate::error::SettingError;
use crate::free_form::EARTH_CM_PER_S2;

/// c_i of equation (8) (rad per unit of force and frame), for the segment at `position` = i of a strand `count` = k
/// reference segments long. Both may be fractions, see the top of this file.
pub fn gain(dynamics: &Dynamics, position: f64, count: f64) -> f64 {
    let (dt, lambda) = (dynamics.motion.slowed_time_step(), f64::from(dynamics.motion.linear_density));
    let d = f64::from(dynamics.segment_length);
    let k = count.max(f64::from(dynamics.motion.inertia_length_floor) / d);
    3.0 * position * d * dt.powi(2) / (2.0 * lambda * k.powi(4) * d.powi(3))
}

/// A: the acceleration of hair of this length under a force of 1 (cm/frame^2), in the form where a strand is a chain. A
/// rod held at one end turns by 3 A / 2 L, which is the gain of its last segment.
pub fn push(dynamics: &Dynamics, length_cm: f64) -> f64 {
    let (dt, lambda) = (dynamics.motion.slowed_time_step(), f64::from(dynamics.motion.linear_density));
    let length = length_cm.max(f64::from(dynamics.motion.inertia_length_floor));
    f64::from(dynamics.segment_length) * dt.powi(2) / (lambda * length.powi(2))
}

/// The gravity with which hair of this length (cm) falls as on the earth: 981 cm/s^2 at the frame rate, without slow
/// motion. For 18 cm of hair with the values of Table 1 it is about 110 at 120 frames per second and 2,800 at 24. The
/// paper's hair therefore moves in slow motion.
pub fn earth_gravity(dynamics: &Dynamics, length_cm: f64) -> f32 {
    let rate = dynamics.motion.frame_rate * f64::from(dynamics.motion.slow);
    (EARTH_CM_PER_S2 / (rate * rate) / push(dynamics, length_cm)) as f32
}

/// The stiffness K with which hair of this length (cm) bends within this distance under this gravity. For real hair
/// that distance is (EI / w)^(1/3), with EI = 3/8 A L K d^2 and w = A `gravity` for 1 cm.
pub fn stiffness_of(dynamics: &Dynamics, gravity: f64, length_cm: f64, bends_within_cm: f64) -> f64 {
    8.0 * bends_within_cm.powi(3) * gravity / (3.0 * length_cm * f64::from(dynamics.segment_length).powi(2))
}

/// The force that carries limp hair of this length (cm) along at 1 cm/s if it settles in `settle` frames: F = alpha u /
/// A.
pub fn carrying_force(dynamics: &Dynamics, length_cm: f64, settle: f64) -> f64 {
    let slow = f64::from(dynamics.motion.slow);
    let (air, speed) = (2.0 / (settle * slow), 1.0 / (dynamics.motion.frame_rate * slow));
    air * speed / push(dynamics, length_cm)
}

/// Frames of one small swing about a constant force: cos(2 pi / T) = 1 - c |F| / 2. This is exact for the scheme (7).
///
/// NaN if the scheme is unstable (c |F| >= 4), infinite without force.
pub fn period(gain_times_force: f64) -> f64 {
    if gain_times_force >= 4.0 {
        return f64::NAN;
    }
    // 2 asin(sqrt(x) / 2) is acos(1 - x / 2) without its cancellation at small x.
    std::f64::consts::PI / (gain_times_force.sqrt() / 2.0).asin()
}

/// What moves one segment: lengths in cm, gains in rad per unit of force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SegmentShape {
    pub length: f64,
    /// c_i.
    pub gain: f64,
    /// eps_i c_i.
    pub gain_in_gamma: f64,
    /// Distance of the segment's end from the root as a part of the strand's length, 0..1. Both count from where the
    /// strand is held, and are 0 before.
    pub along: f64,
    /// The same for its beginning and its middle.
    pub begin: f64,
    pub middle: f64,
}

impl SegmentShape {
    /// eps_i; 1 if nothing moves the segment.
    pub fn eps(&self) -> f64 {
        if self.gain > 0.0 { self.gain_in_gamma / self.gain } else { 1.0 }
    }
}

/// Lengths and gains of every segment of one strand, root first. `held`: how many segments from the root on do not move.
///
/// # Errors
/// Strands without a segment, with coordinates that are not finite, or with a segment of length 0.
pub(super) fn segment_shapes(
    dynamics: &Dynamics,
    strand: &[glam::Vec3],
    s: usize,
    held: usize,
) -> Result<Vec<SegmentShape>, SettingError> {
    let thing = || format!("hair strand {s}");
    if strand.len() < 2 {
        return Err(SettingError::new(
            thing(),
            "",
            format!("needs at least 2 points, but has {}: remove it", strand.len()),
        ));
    }
    if let Some(i) = strand.iter().position(|p| !p.is_finite()) {
        let point = format!("{}, point {i}", thing());
        return Err(SettingError::new(point, strand[i], "every coordinate must be a finite number"));
    }
    let lengths: Vec<f64> = strand.windows(2).map(|w| w[0].as_dvec3().distance(w[1].as_dvec3())).collect();
    if let Some(i) = lengths.iter().position(|&length| length as f32 <= 0.0) {
        let remedy = format!("has segment {} of length 0: remove the duplicate point", i + 1);
        return Err(SettingError::new(thing(), "", remedy));
    }
    let d = f64::from(dynamics.segment_length);
    let total: f64 = lengths[held..].iter().sum();
    let mut end = 0.0;
    let shapes = lengths.iter().enumerate().map(|(i, &length)| {
        if i < held {
            return SegmentShape { length, gain: 0.0, gain_in_gamma: 0.0, along: 0.0, begin: 0.0, middle: 0.0 };
        }
        let position = (end + length / 2.0) / d + 0.5;
        end += length;
        let gain = gain(dynamics, position, total / d);
        let eps = dynamics.weakening().map_or(1.0, |weakening| f64::from(weakening.coefficient(position)));
        let along = end / total;
        let (begin, middle) = (along - length / total, along - 0.5 * length / total);
        SegmentShape { length, gain, gain_in_gamma: eps * gain, along, begin, middle }
    });
    Ok(shapes.collect())
}
