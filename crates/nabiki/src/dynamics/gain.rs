//! Inertia and gain: equations (3), (6), (8), for segments of any length.
//!
//! The paper's strand has k segments of one length d. With its own length L = k d, equation (8) reads
//! c_i = 3 (i d) d dt^2 / (2 lambda L^4): it knows nothing of the number of segments but through d, the lever, and
//! i, the place. Imported hair keeps that d, `hair.segment_length`, as the unit in which both are counted, however
//! finely its strands are cut: k = L / d, and i = m / d + 1/2 for a segment whose middle is m away from the root,
//! which is i itself for segments as long as d. So 16 and 32 points of one strand move alike, up to the square of
//! the segment's length.

use super::free::free_segments;
use super::{Dynamics, Form};
use crate::error::SettingError;
use crate::field::Field;
use crate::strands::{Strands, length};

/// c_i of equation (8) (rad per unit of force and frame), for the segment at `position` = i of a strand `count` = k
/// reference segments long. Both may be fractions, see the top of this file.
pub fn gain(dynamics: &Dynamics, position: f64, count: f64) -> f64 {
    let (dt, lambda) = (f64::from(dynamics.motion.time_step), f64::from(dynamics.motion.linear_density));
    let d = f64::from(dynamics.segment_length);
    let k = count.max(f64::from(dynamics.motion.inertia_length_floor) / d);
    3.0 * position * d * dt.powi(2) / (2.0 * lambda * k.powi(4) * d.powi(3))
}

/// Frames of one small swing about a constant force, cos(2 pi / T) = 1 - c |F| / 2: exact for the scheme (7).
///
/// NaN where the scheme is unstable, c |F| >= 4; infinite without force.
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
    /// Distance of the segment's end from the root as a part of the strand's length, 0..1; both from the band on, where
    /// the strand is tied.
    pub along: f64,
}

impl SegmentShape {
    /// eps_i; 1 where nothing moves the segment.
    pub fn eps(&self) -> f64 {
        if self.gain > 0.0 { self.gain_in_gamma / self.gain } else { 1.0 }
    }
}

/// Lengths and gains of every segment of one strand, root first.
///
/// # Errors
/// Strands without a segment, with coordinates that are no numbers, or with a segment of no length.
pub(super) fn segment_shapes(
    dynamics: &Dynamics,
    strand: &[glam::Vec3],
    s: usize,
) -> Result<Vec<SegmentShape>, SettingError> {
    let thing = || format!("hair strand {s}");
    if strand.len() < 2 {
        return Err(SettingError::new(thing(), format!("{} points", strand.len()), "needs at least 2 points"));
    }
    if let Some(p) = strand.iter().find(|p| !p.is_finite()) {
        return Err(SettingError::new(thing(), p, "every coordinate must be a finite number"));
    }
    let lengths: Vec<f64> = strand.windows(2).map(|w| w[0].as_dvec3().distance(w[1].as_dvec3())).collect();
    if let Some(i) = lengths.iter().position(|&length| length as f32 <= 0.0) {
        let remedy = "remove the doubled point: a segment needs a direction";
        return Err(SettingError::new(thing(), format!("segment {} of length 0", i + 1), remedy));
    }
    let d = f64::from(dynamics.segment_length);
    let held = held(dynamics, strand);
    let total: f64 = lengths[held..].iter().sum();
    let mut end = 0.0;
    let shapes = lengths.iter().enumerate().map(|(i, &length)| {
        if i < held {
            return SegmentShape { length, gain: 0.0, gain_in_gamma: 0.0, along: 0.0 };
        }
        let position = (end + length / 2.0) / d + 0.5;
        end += length;
        let gain = gain(dynamics, position, total / d);
        let eps = f64::from(dynamics.pseudo_force.coefficient(position));
        SegmentShape { length, gain, gain_in_gamma: eps * gain, along: end / total }
    });
    Ok(shapes.collect())
}

/// How many segments of a strand are held where it is tied.
pub(super) fn held(dynamics: &Dynamics, strand: &[glam::Vec3]) -> usize {
    match &dynamics.form {
        Form::Paper => 0,
        Form::Free(free) => free.form.tie.map_or(0, |tie| tie.held(strand)),
    }
}

/// The largest gain c_i of all strands: a force is stable while it times |F| stays below 4.
///
/// # Errors
/// As [`Simulation::new`](super::Simulation::new), but for the stability of the field.
pub fn largest_gain(strands: &Strands, dynamics: &Dynamics) -> Result<f64, SettingError> {
    Ok(Stability::of(strands, dynamics)?.gain)
}

/// Refuses a field that is too strong for the step (7) of this hair: c_i |F| must stay below 4.
///
/// # Errors
/// As [`Simulation::new`](super::Simulation::new), but for settings out of range.
pub fn check_field(strands: &Strands, dynamics: &Dynamics, field: &dyn Field) -> Result<(), SettingError> {
    Stability::of(strands, dynamics)?.check(field)
}

/// What decides whether a field is stable: the segment for which the least force is too much.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stability {
    /// c_i.
    gain: f64,
    /// What pulls on it besides the field in the free form.
    own: f64,
    /// Its strand, and the length of that (cm).
    strand: usize,
    length: f32,
    /// The largest that the scene gives; none in the paper's form.
    stiffness: Option<f32>,
}

impl Stability {
    /// Refuses no strands, and those that cannot be moved.
    pub fn of(strands: &Strands, dynamics: &Dynamics) -> Result<Self, SettingError> {
        if strands.is_empty() {
            return Err(SettingError::new("hair", "0 strands", "there is nothing to move; give at least one strand"));
        }
        let (mut worst, mut least) = ((0.0, 0.0, 0), f64::INFINITY);
        for (s, strand) in strands.iter().enumerate() {
            let own = own_strengths(dynamics, strand, s)?;
            for (shape, own) in segment_shapes(dynamics, strand, s)?.iter().zip(own) {
                let force = 4.0 / shape.gain - own;
                if force < least {
                    (worst, least) = ((shape.gain, own, s), force);
                }
            }
        }
        let (gain, own, strand) = worst;
        let stiffness = match &dynamics.form {
            Form::Paper => None,
            Form::Free(free) => Some(free.form.stiffness.largest()),
        };
        Ok(Self { gain, own, strand, length: length(strands.strand(strand)), stiffness })
    }

    /// Refuses fields under which the scheme is unstable.
    pub fn check(&self, field: &dyn Field) -> Result<(), SettingError> {
        let Self { gain, own, strand, length, stiffness } = *self;
        let free = stiffness.is_some();
        let stiffness = stiffness.unwrap_or(0.0);
        let strongest = f64::from(field.strongest());
        if gain * (strongest + own) < 4.0 {
            return Ok(());
        }
        let (largest, reached) = (4.0 / gain - own, gain * (strongest + own));
        let what = if free { "c_i (|F| + 4 K + H + 2 gravity)" } else { "c_i |F|" };
        let ways = "make motion.time_step smaller, or set motion.inertia_length_floor so that short hair is held by its \
                    neighbours";
        if largest <= 0.0 {
            // What is asked for is given for segments of hair.segment_length; where it acts, it is larger by their cut.
            let holds = 0.99 * f64::from(stiffness) * 4.0 / (gain * own);
            let remedy = format!(
                "unstable without any force: {what} reaches {:.3} at strand {strand} ({length:.2} cm long), and must \
                 stay below 4; keep the largest stiffness below {holds:.0}, {ways}",
                gain * own
            );
            return Err(SettingError::new("free.stiffness", stiffness, remedy));
        }
        // A force of exactly the largest is one too strong.
        let below = largest.next_down();
        let (thing, value) =
            field.first_above(below).unwrap_or_else(|| ("force".to_owned(), field.strongest().to_string()));
        let remedy = format!(
            "unstable: {what} reaches {reached:.3} at the tip of strand {strand} ({length:.2} cm long), and must stay \
             below 4; keep |F| below {largest:.4}, {ways}"
        );
        Err(SettingError::new(thing, value, remedy))
    }
}

/// What pulls on each segment of a strand besides the field, at the most: by Gershgorin's circles twice the stiffness of
/// both of its joints, H, and twice the weight.
fn own_strengths(dynamics: &Dynamics, strand: &[glam::Vec3], s: usize) -> Result<Vec<f64>, SettingError> {
    let Form::Free(free) = &dynamics.form else { return Ok(vec![0.0; strand.len() - 1]) };
    let segments = free_segments(dynamics, &free.form, strand, s)?;
    let after = segments.iter().skip(1).map(|segment| segment.stiffness).chain([0.0]);
    let weight = 2.0 * f64::from(free.form.gravity);
    Ok(segments
        .iter()
        .zip(after)
        .map(|(segment, after)| 2.0 * (segment.stiffness + after) + segment.hold + weight)
        .collect())
}
