//! Turbulence: curl noise (R. Bridson, J. Houriham, M. Nordenstam, "Curl-noise for procedural fluid flow", SIGGRAPH 2007).

#[cfg(test)]
mod tests;
mod waves;

use std::fmt;

use glam::{DVec3, Vec3};

use self::waves::{LOOP, Octave, Phases};
use super::falloff::{self, EnvelopeKey};
use super::head_track::{HeadTrack, Place};
use super::lanes::{self, Lanes, by_part, get, set, times, transposed_times};
use super::{Field, VectorRow};
use crate::ellipsoid::Ellipsoid;
use crate::error::SettingError;
use crate::pose::Pose;
use crate::random;
use crate::setting::{self, refused};
use crate::settings;
use crate::vector::{cross, dot, scale, scale_add, subtract};

settings! {
    /// Turbulence: a random force of swirls that drift with the wind and change on the way.
    ///
    /// It is the curl of a random vector potential, a sum of octaves that each have half the size of the one before.
    /// Near the head, Bridson's ramp reduces the potential to 0, so the force runs along the head.
    pub struct Turbulence in "turbulence" where its_swirls_are_large_enough {
        /// Strength far from the head: the root mean square of |F| over space.
        pub strength: f32 = 30.0 => "Strength", least 0.0;
        /// Size of the largest swirls, half of their wavelengths. The swirls of the last octave must be at least 0.01
        /// cm as well.
        pub swirl_size: f32 = 10.0 => "Swirl size", unit "cm", least 0.01, most 1e6;
        /// Approximate number of frames in which a swirl reverses and returns. 0 makes swirls drift without changing.
        /// Without drift, the pattern repeats after 16 times this number.
        pub pulse_length: f32 = 48.0 => "Pulse length", unit "frames", least 0.0;
        /// Strength of each octave relative to the one before. 0.79 is that of Kolmogorov.
        pub roughness: f32 = 0.5 => "Roughness", least 0.0, most 1.0;
        /// Number of octaves, each half the size of the one before. More give finer swirls and take longer.
        pub octaves: u32 = 2 => "Octaves", least 1.0, most Turbulence::MOST_OCTAVES as f64;
        /// Distance that the swirls drift per frame and unit of wind.
        pub drift: f32 = 0.02 => "Drift", unit "cm", least 0.0;
        /// Distance from the head ellipsoid within which the force turns along the head. 0 ignores the head. The
        /// distance is measured as (|q| - 1) times the mean half axis, with q the point in half axes from the centre,
        /// and is at most the mean half axis.
        pub near_head: f32 = 4.0 => "Near the head", unit "cm", least 0.0;
        /// Random seed of the swirls.
        pub seed: u64 = 1 => "Seed";
        /// Keyframes of the strength: the factor follows straight lines between them. Without keyframes, the strength
        /// is constant.
        #[serde(skip_serializing_if = "Vec::is_empty")]
        pub envelope: Vec<EnvelopeKey> = Vec::new() => "Over time";
    }
}

impl Turbulence {
    /// Most octaves: the eighth is 1/128 of the first.
    const MOST_OCTAVES: u32 = 8;
    /// Size of the smallest swirls of any octave (cm): 600 m from the origin their wavelengths are still counted to the whole
    /// (see `waves`).
    const FINEST_CM: f32 = 0.01;

    /// Refuses what is out of its range.
    ///
    /// # Errors
    /// Names the first such setting.
    fn its_swirls_are_large_enough(&self, at: &setting::Place) -> Result<(), SettingError> {
        let least = Self::FINEST_CM * (1_u32 << (self.octaves - 1)) as f32;
        if self.swirl_size < least {
            let remedy =
                format!("must be at least {least} with {} octaves: take larger swirls or fewer octaves", self.octaves);
            return refused(&at.key("swirl_size"), self.swirl_size, remedy);
        }
        falloff::check_order(at, &self.envelope)
    }
}

/// Turbulence as a field.
#[derive(Clone)]
pub struct TurbulenceField {
    settings: Turbulence,
    octaves: Vec<Octave>,
    head: HeadTrack,
    /// Where the pattern has drifted to by each frame (cm).
    drifted: Vec<DVec3>,
    /// The phases of every octave in the first frames, computed once instead of for every row.
    first_phases: Vec<Phases>,
}

impl TurbulenceField {
    /// Number of frames whose phases are computed in advance.
    const FIRST_FRAMES: u32 = 4096;

    /// Turbulence around the moving head ellipsoid. `poses` are those of the head in the space of the field, one per
    /// frame from frame 0 on; the last one holds after that, and none means that it does not move. `wind` is the wind
    /// with which swirls drift, one vector per frame from frame 0 on; the last one holds after that.
    ///
    /// # Errors
    /// Settings out of range, `near_head` above the mean half axis, or poses and winds that are not finite.
    pub fn new(
        settings: &Turbulence,
        ellipsoid: Ellipsoid,
        poses: &[Pose],
        wind: &[Vec3],
    ) -> Result<Self, SettingError> {
        settings.check()?;
        let head = HeadTrack::new(ellipsoid, poses)?;
        let mean = mean_half_axis(&ellipsoid);
        if settings.near_head > mean {
            let remedy = format!("must be at most {mean:.3}, the mean half axis of the head ellipsoid");
            return Err(SettingError::new("turbulence.near_head", settings.near_head, remedy));
        }
        let drifted = drifted(settings.drift, wind)?;
        let octaves = octaves(settings);
        let mut field = Self { settings: settings.clone(), octaves, head, drifted, first_phases: Vec::new() };
        let frames = if settings.strength > 0.0 { Self::FIRST_FRAMES } else { 0 };
        let octaves = 0..field.octaves.len();
        let phases = (0..frames).flat_map(|n| octaves.clone().map(move |octave| (octave, n)));
        field.first_phases = phases.map(|(octave, n)| field.phases(octave, n)).collect();
        Ok(field)
    }

    /// The largest force, where |grad ramp| is at most `slope` (1 / cm).
    fn strongest_with(&self, slope: f64) -> f32 {
        // The bound of the profile leaves room for what rounding adds to the force itself.
        let largest = self.octaves.iter().map(|octave| octave.largest(slope)).sum::<f64>() as f32;
        largest * falloff::largest(&self.settings.envelope)
    }

    /// Where the pattern has drifted to by a frame (cm).
    fn drifted(&self, frame: u32) -> DVec3 {
        let last = self.drifted.len() - 1;
        match (frame as usize).checked_sub(last) {
            None | Some(0) => self.drifted[frame as usize],
            // The last wind continues.
            Some(beyond) => {
                let step = if last > 0 { self.drifted[last] - self.drifted[last - 1] } else { DVec3::ZERO };
                self.drifted[last] + step * beyond as f64
            }
        }
    }

    /// The phases of an octave.
    fn phases(&self, octave: usize, frame: u32) -> Phases {
        let pulse = f64::from(self.settings.pulse_length);
        let pulses = if pulse > 0.0 { (f64::from(frame) / pulse) % LOOP } else { 0.0 };
        self.octaves[octave].phases(self.drifted(frame), pulses)
    }

    /// Calls a function with the field in one frame.
    fn in_frame(&self, frame: u32, act: impl FnOnce(&InFrame)) {
        let ramp = Ramp::new(self, frame);
        let first = frame as usize * self.octaves.len();
        let part = falloff::envelope(&self.settings.envelope, frame);
        let in_frame = |phases| InFrame { octaves: &self.octaves, phases, ramp, part };
        match self.first_phases.get(first..first + self.octaves.len()) {
            Some(phases) => act(&in_frame(phases)),
            None => {
                let phases: [Phases; Turbulence::MOST_OCTAVES as usize] =
                    std::array::from_fn(
                        |i| if i < self.octaves.len() { self.phases(i, frame) } else { Phases::default() },
                    );
                act(&in_frame(&phases));
            }
        }
    }
}

/// Sum of the steps by each frame.
fn drifted(drift: f32, wind: &[Vec3]) -> Result<Vec<DVec3>, SettingError> {
    if let Some(n) = wind.iter().position(|w| !w.is_finite()) {
        return Err(SettingError::new(format!("wind of frame {n}"), wind[n], "must be finite numbers"));
    }
    // A wind that does not change up to the end need not be stored.
    let end = wind.iter().rev().zip(wind.iter().rev().skip(1)).take_while(|(a, b)| a == b).count();
    let kept = &wind[..wind.len() - end];
    let mut place = DVec3::ZERO;
    let mut places = vec![place];
    for step in kept.iter().skip(1).chain(kept.last()) {
        place += f64::from(drift) * step.as_dvec3();
        places.push(place);
    }
    Ok(places)
}

fn octaves(settings: &Turbulence) -> Vec<Octave> {
    let roughness = f64::from(settings.roughness);
    let gains: Vec<f64> =
        std::iter::successors(Some(1.0), |gain| Some(gain * roughness)).take(settings.octaves as usize).collect();
    let whole = gains.iter().map(|gain| gain * gain).sum::<f64>().sqrt();
    let octave = |(i, gain): (usize, &f64)| {
        let swirl_size = f64::from(settings.swirl_size) / f64::from(1_u32 << i);
        let seed = random::mix(settings.seed.wrapping_add((i as u64).wrapping_mul(random::GOLDEN_GAMMA)));
        Octave::new(f64::from(settings.strength) * gain / whole, swirl_size, (i + 1) as f64, seed)
    };
    gains.iter().enumerate().map(octave).collect()
}

fn mean_half_axis(ellipsoid: &Ellipsoid) -> f32 {
    ellipsoid.half_axes.element_sum() / 3.0
}

/// What turns the force along the head: the potential times Bridson's ramp of the distance.
#[derive(Clone, Copy, Debug)]
struct Ramp {
    place: Place,
    /// 1 / half axis.
    inverse: [f32; 3],
    /// Mean half axis over the distance at which the ramp ends; 0 without a ramp.
    steepness: f32,
}

impl Ramp {
    fn new(field: &TurbulenceField, frame: u32) -> Self {
        let ellipsoid = &field.head.ellipsoid;
        let near = field.settings.near_head;
        let steepness = if near > 0.0 { mean_half_axis(ellipsoid) / near } else { 0.0 };
        Self { place: *field.head.place(frame), inverse: ellipsoid.half_axes.recip().to_array(), steepness }
    }

    /// The curl of ramp times potential: ramp v + grad ramp x psi.
    #[inline(always)]
    fn curl(&self, p: [f32; 3], velocity: [f32; 3], potential: [f32; 3]) -> [f32; 3] {
        let q = by_part(times(&self.place.axes, subtract(p, self.place.center)), self.inverse);
        // Where |q| is small the slope of the ramp is 0.
        let radius = dot(q, q).sqrt().max(1e-6);
        let x = ((radius - 1.0) * self.steepness).clamp(-1.0, 1.0);
        let x2 = x * x;
        let ramp = x * x2.mul_add(x2.mul_add(0.375, -1.25), 1.875);
        let slope = 1.875 * (1.0 - x2) * (1.0 - x2) * self.steepness / radius;
        let gradient = transposed_times(&self.place.axes, by_part(q, self.inverse));
        scale_add(ramp, velocity, scale(slope, cross(gradient, potential)))
    }
}

/// The field in one frame.
struct InFrame<'a> {
    octaves: &'a [Octave],
    phases: &'a [Phases],
    ramp: Ramp,
    /// Of the strength.
    part: f32,
}

impl Lanes for InFrame<'_> {
    #[allow(clippy::needless_range_loop, reason = "a loop over lanes, as in the kernel")]
    #[inline(always)]
    fn forces<const N: usize>(&self, points: &[[f32; N]; 3]) -> [[f32; N]; 3] {
        let mut velocity = [[0.0; N]; 3];
        let mut potential = [[0.0; N]; 3];
        for (octave, phases) in self.octaves.iter().zip(self.phases) {
            for lane in 0..N {
                let (mut v, mut psi) = (get(&velocity, lane), get(&potential, lane));
                octave.add(phases, get(points, lane), &mut v, &mut psi);
                set(&mut velocity, lane, v);
                set(&mut potential, lane, psi);
            }
        }
        let mut forces = [[0.0; N]; 3];
        for lane in 0..N {
            let velocity = get(&velocity, lane);
            let force = match self.ramp.steepness {
                0.0 => velocity,
                _ => self.ramp.curl(get(points, lane), velocity, get(&potential, lane)),
            };
            set(&mut forces, lane, scale(self.part, force));
        }
        forces
    }
}

impl Field for TurbulenceField {
    fn at(&self, point: Vec3, frame: u32) -> Vec3 {
        let mut force = Vec3::ZERO;
        self.in_frame(frame, |in_frame| force = lanes::at(in_frame, point));
        force
    }

    fn at_row(&self, points: &VectorRow, frame: u32, forces: &mut VectorRow) {
        self.in_frame(frame, |in_frame| lanes::at_row(in_frame, points, forces));
    }

    /// The sum over waves of what each can reach; |grad ramp| is at most 15/8 over `near_head`, times mean by smallest half axis.
    fn strongest(&self) -> f32 {
        let near = f64::from(self.settings.near_head);
        let axes = &self.head.ellipsoid.half_axes;
        let uneven = f64::from(mean_half_axis(&self.head.ellipsoid) / axes.min_element());
        let slope = if near > 0.0 { 1.875 / near * uneven } else { 0.0 };
        self.strongest_with(slope)
    }

    fn first_above(&self, limit: f64) -> Option<(String, String)> {
        let above = f64::from(self.strongest()) > limit;
        // A ramp that ends almost at once makes the force enormous.
        let of_ramp = f64::from(self.strongest_with(0.0)) <= limit;
        let Turbulence { strength, near_head, .. } = self.settings;
        let (setting, value) = if of_ramp { ("near_head", near_head) } else { ("strength", strength) };
        above.then(|| (format!("turbulence.{setting}"), format!("{value} (forces of up to {})", self.strongest())))
    }

    fn uniform(&self, frame: u32) -> Option<Vec3> {
        let part = falloff::envelope(&self.settings.envelope, frame);
        (self.settings.strength * part == 0.0).then_some(Vec3::ZERO)
    }
}

impl fmt::Debug for TurbulenceField {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("TurbulenceField").field("settings", &self.settings).finish_non_exhaustive()
    }
}
