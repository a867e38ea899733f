//! Inertia and gain: equations (3), (6), (8), for segments of any length.
//!
//! The paper's strand has k segments of one length d. With its own length L = k d, equation (8) reads
//! c_i = 3 (i d) d dt^2 / (2 lambda L^4): it knows nothing of the number of segments but through d, the lever, and
//! i, the place. Imported hair keeps that d, `hair.segment_length`, as the unit in which both are counted, however
//! finely its strands are cut: k = L / d, and i = m / d + 1/2 for a segment whose middle is m away from the root,
//! which is i itself for segments as long as d. So 16 and 32 points of one strand move alike, up to the square of
//! the segment's length.

use super::free::{FreeSegment, free_segments};
use super::{Dynamics, Form};
use crate::error::SettingError;
use crate::field::Field;
use crate::free_form::FreeForm;
use crate::strands::Strands;

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
        let eps = dynamics.weakening().map_or(1.0, |weakening| f64::from(weakening.coefficient(position)));
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
    if Stability::of(strands, dynamics)?.holds(field) {
        return Ok(());
    }
    Err(unstable(&[Named { name: "strand", strands, ids: &[] }], dynamics, field))
}

/// What decides whether a field is stable: the segment for which the least force is too much.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stability {
    /// c_i.
    gain: f64,
    /// What pulls on it besides the field in the free form.
    own: f64,
}

impl Stability {
    /// Refuses no strands, and those that cannot be moved.
    pub fn of(strands: &Strands, dynamics: &Dynamics) -> Result<Self, SettingError> {
        if strands.is_empty() {
            return Err(SettingError::new("hair", "0 strands", "there is nothing to move; give at least one strand"));
        }
        let (mut worst, mut least) = (Self { gain: 0.0, own: 0.0 }, f64::INFINITY);
        for (s, strand) in strands.iter().enumerate() {
            for Pull { gain, own, .. } in pulls(dynamics, strand, s)? {
                let own: f64 = own.iter().sum();
                let force = 4.0 / gain - own;
                if force < least {
                    (worst, least) = (Self { gain, own }, force);
                }
            }
        }
        Ok(worst)
    }

    /// Whether the scheme is stable under a field.
    pub fn holds(&self, field: &dyn Field) -> bool {
        self.holds_force(field.strongest())
    }

    fn holds_force(&self, force: f32) -> bool {
        self.gain * (f64::from(force) + self.own) < 4.0
    }

    /// The strongest force that [`holds`](Self::holds), of hair that is stable without one.
    pub fn strongest_force(&self) -> f32 {
        let mut force = ((4.0 / self.gain - self.own) as f32).min(f32::MAX);
        while force > 0.0 && !self.holds_force(force) {
            force = force.next_down();
        }
        force.max(0.0)
    }
}

/// What pulls on a segment in the free form, by Gershgorin's circles the most that it can: twice the stiffness of both of its
/// joints, H, and twice the weight; and twice what cohesion holds against its own increment.
struct Pull {
    gain: f64,
    own: [f64; OWN],
    length: f64,
}

/// How many things pull on a segment beside the force.
const OWN: usize = 4;
/// The number of the force among all that pulls.
const FORCE: usize = OWN;

/// What these come from in a scene, what they are called, and what the largest of each is.
fn owners(dynamics: &Dynamics) -> [(&'static str, &'static str, f32); OWN] {
    let of_form = |form: &FreeForm| [form.stiffness.largest(), form.hold.largest(), form.weight()];
    let [stiffness, hold, gravity] = match &dynamics.form {
        Form::Paper => [0.0; 3],
        Form::Free(free) => of_form(&free.form),
    };
    let cohesion = cohesion(dynamics);
    [
        ("free.stiffness", "the largest stiffness", stiffness),
        ("free.hold", "the largest hold", hold),
        ("free.gravity", "gravity", gravity),
        ("neighbours.cohesion", "cohesion", cohesion),
    ]
}

/// The strength of what holds a node against its own motion; 0 where neighbours are not felt.
fn cohesion(dynamics: &Dynamics) -> f32 {
    match &dynamics.form {
        Form::Free(free) => free.neighbours.as_ref().map_or(0.0, |neighbours| neighbours.forces.cohesion),
        Form::Paper => 0.0,
    }
}

fn pulls(dynamics: &Dynamics, strand: &[glam::Vec3], s: usize) -> Result<Vec<Pull>, SettingError> {
    let Form::Free(free) = &dynamics.form else {
        let pull = |shape: SegmentShape| Pull { gain: shape.gain, own: [0.0; OWN], length: shape.length };
        return Ok(segment_shapes(dynamics, strand, s)?.into_iter().map(pull).collect());
    };
    let segments = free_segments(dynamics, &free.form, strand, s)?;
    let after = segments.iter().skip(1).map(|segment| segment.stiffness).chain([0.0]);
    let weight = 2.0 * f64::from(free.form.weight());
    let cohesion = 2.0 * f64::from(cohesion(dynamics));
    let pull = |(segment, after): (&FreeSegment, f64)| Pull {
        gain: segment.shape.gain,
        own: [2.0 * (segment.stiffness + after), segment.hold, weight, cohesion * segment.shape.length],
        length: segment.shape.length,
    };
    Ok(segments.iter().zip(after).map(pull).collect())
}

/// Some hair, and what one of its strands is called.
pub(super) struct Named<'a> {
    pub name: &'a str,
    pub strands: &'a Strands,
    /// Their numbers in the set that they are some of; none where they are all.
    pub ids: &'a [u32],
}

/// Why hair that can be moved is unstable under a field: what pulls most where it is least stable, and how much of that would
/// hold beside all else.
pub(super) fn unstable(hair: &[Named<'_>], dynamics: &Dynamics, field: &dyn Field) -> SettingError {
    let strongest = f64::from(field.strongest());
    let parts = |pull: &Pull| {
        let [stiffness, hold, weight, cohesion] = pull.own;
        [stiffness, hold, weight, cohesion, strongest]
    };
    let reached = |pull: &Pull| pull.gain * parts(pull).iter().sum::<f64>();
    let strands = || {
        hair.iter().flat_map(|&Named { name, strands, ids }| {
            let number = move |s: usize| ids.get(s).map_or(s, |&id| id as usize);
            strands.iter().enumerate().map(move |(s, strand)| (name, number(s), strand))
        })
    };
    let of = |s: usize, strand: &[glam::Vec3]| pulls(dynamics, strand, s).unwrap_or_default();
    // All others being as they are: by how many times each part may be as large as it is, and how large the force.
    let mut rooms = [f64::INFINITY; OWN + 1];
    let (mut worst, mut most) = ((String::new(), [0.0; OWN + 1]), 0.0);
    for (name, s, strand) in strands() {
        let pulls = of(s, strand);
        let moving = || pulls.iter().filter(|pull| pull.gain > 0.0);
        for pull in moving() {
            let parts = parts(pull);
            for part in (0..=OWN).filter(|&part| parts[part] > 0.0) {
                // Never from the sum of all, in which one that is too large swallows the others.
                let others: f64 = (0..=OWN).filter(|&other| other != part).map(|other| parts[other]).sum();
                let room = 4.0 / pull.gain - others;
                rooms[part] = rooms[part].min(if part == FORCE { room } else { room / parts[part] });
            }
            if reached(pull) > most {
                let length: f64 = moving().map(|pull| pull.length).sum();
                let behind = if pulls.iter().any(|pull| pull.gain == 0.0) { " behind its tie" } else { "" };
                (worst, most) = ((format!("{name} {s} ({length:.2} cm long{behind})"), parts), reached(pull));
            }
        }
    }
    let (place, parts) = worst;
    let free = matches!(dynamics.form, Form::Free(_));
    let what = match (free, cohesion(dynamics) > 0.0) {
        (false, _) => "c_i |F|",
        (true, false) => "c_i (|F| + 4 K + H + 2 gravity)",
        (true, true) => "c_i (|F| + 4 K + H + 2 gravity + 2 l cohesion)",
    };
    let ways = "make motion.time_step smaller, or set motion.inertia_length_floor so that short hair is held by its neighbours";
    let mut largest_first = [0, 1, 2, 3, 4];
    largest_first.sort_by(|&a, &b| parts[b].total_cmp(&parts[a]));
    let blamed = largest_first.into_iter().find(|&part| rooms[part] > 0.0 && rooms[part].is_finite());
    let refused = |thing: &str, value: String, keep: String| {
        let most = if most < 1e6 { format!("{most:.3}") } else { format!("{most:.1e}") };
        let metres = in_metres(hair, dynamics);
        let remedy =
            format!("unstable: {what} reaches {most} at {place}, and must stay below 4; {keep}, {ways}{metres}");
        SettingError::new(thing, value, remedy)
    };
    let owners = owners(dynamics);
    match blamed {
        Some(FORCE) => {
            let largest = rooms[FORCE];
            // A force of exactly the largest is one too strong.
            let below = largest.next_down();
            let (thing, value) =
                field.first_above(below).unwrap_or_else(|| ("force".to_owned(), field.strongest().to_string()));
            refused(&thing, value, format!("keep |F| below {largest:.4}"))
        }
        Some(part) => {
            let (thing, named, value) = owners[part];
            let holds = rounded_down(rooms[part] * f64::from(value));
            let others = if has_others(dynamics, thing) { ", the others in proportion" } else { "" };
            refused(thing, value.to_string(), format!("keep {named} below {holds}{others}"))
        }
        None => {
            let (thing, _, value) = owners[if largest_first[0] != FORCE { largest_first[0] } else { largest_first[1] }];
            let others: Vec<&str> = (owners.iter().zip(parts))
                .filter(|((other, ..), part)| *other != thing && *part > 0.0)
                .map(|((other, ..), _)| *other)
                .chain((strongest > 0.0).then_some("the forces"))
                .collect();
            refused(
                thing,
                value.to_string(),
                format!("less of it alone does not mend it: lower {}, too", others.join(", ")),
            )
        }
    }
}

/// Hair shorter than this (cm) at its longest, about a head whose mean half axis is below it: a person's in metres, not in cm.
const METRES_CM: f32 = 1.0;

/// What else may be wrong with hair that is unstable: its unit.
fn in_metres(hair: &[Named<'_>], dynamics: &Dynamics) -> String {
    let longest = hair.iter().flat_map(|named| named.strands.lengths()).fold(0.0, f32::max);
    let head = dynamics.ellipsoid.half_axes.element_product().cbrt();
    let things = [("the longest strand", longest), ("the head's mean half axis", head)];
    let small = things.into_iter().filter(|&(_, cm)| cm < METRES_CM).map(|(what, cm)| format!("{what} is {cm:.2} cm"));
    let small: Vec<String> = small.collect();
    if small.is_empty() {
        return String::new();
    }
    format!("; {}: if that is in metres, give it in cm, times 100", small.join(" and "))
}

/// Whether a setting has more numbers than its largest, from root to tip.
fn has_others(dynamics: &Dynamics, thing: &str) -> bool {
    let Form::Free(free) = &dynamics.form else { return false };
    match thing {
        "free.stiffness" => free.form.stiffness.values().len() > 1,
        "free.hold" => free.form.hold.values().len() > 1,
        _ => false,
    }
}

/// With three digits, and not above the number.
fn rounded_down(x: f64) -> f32 {
    let unit = 10.0_f64.powf(x.log10().floor() - 2.0);
    ((x / unit).floor() * unit) as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Ellipsoid;
    use crate::dynamics::Motion;
    use crate::field::{Keyframe, KeyframedField};
    use crate::free_form::FreeMotion;
    use crate::pseudo_force::PseudoForce;
    use glam::Vec3;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn what_a_refusal_says_would_hold_holds(
            // Of moderate numbers, and of such as swallow all others or overflow.
            powers in prop::array::uniform4(prop_oneof![3 => 1.0_f32..8.0, 1 => 8.0_f32..38.5]),
            cuts in prop::collection::vec((2_usize..12, 3.0_f32..20.0), 1..4),
        ) {
            let mut hair = Strands::default();
            for (count, length) in cuts {
                hair.push((0..=count).map(|i| Vec3::Y * length * (i as f32 / count as f32).powf(1.3)));
            }
            let mut free = FreeMotion::default();
            let [stiffness, hold, gravity, mut force] = powers.map(|power| (10.0_f32.powf(power) - 10.0).min(f32::MAX));
            free.form.stiffness = stiffness.into();
            free.form.hold = hold.into();
            free.form.gravity = gravity.into();
            let refused = |free: &FreeMotion, force: f32| {
                let dynamics = Dynamics {
                    motion: Motion::default(),
                    segment_length: 1.0,
                    pseudo_force: PseudoForce::default(),
                    ellipsoid: Ellipsoid { center: Vec3::ZERO, half_axes: Vec3::splat(9.0) },
                    shell: 1.25,
                    polar_axis: Vec3::Y,
                    disturbance: None,
                    form: Form::Free(free.clone()),
                };
                let field = KeyframedField::new(&[Keyframe { through: 9, vector: Vec3::X * force }]).unwrap();
                check_field(&hair, &dynamics, &field).err()
            };
            // What is too much beside all else is named first, so a few lines mend any scene.
            for _ in 0..5 {
                let Some(error) = refused(&free, force) else { return Ok(()) };
                let Some((_, limit)) = error.remedy.split_once(" below ").and_then(|(_, after)| after.split_once(" below ")) else {
                    // Nothing alone mends it: the largest goes.
                    match error.thing.to_string().as_str() {
                        "free.stiffness" => free.form.stiffness = 0.0.into(),
                        "free.hold" => free.form.hold = 0.0.into(),
                        _ => free.form.gravity = 0.0.into(),
                    }
                    continue;
                };
                let limit: f32 = limit.split(',').next().unwrap().parse().unwrap();
                // Forces are given to four places.
                let within = 0.999 * limit;
                match error.thing.to_string().as_str() {
                    "free.stiffness" => free.form.stiffness = within.into(),
                    "free.hold" => free.form.hold = within.into(),
                    "free.gravity" => free.form.gravity = within.into(),
                    _ => force = within,
                }
                prop_assert_eq!(refused(&free, force).map(|e| e.to_string()), None);
            }
            prop_assert!(false, "five lines do not mend it");
        }
    }
}
