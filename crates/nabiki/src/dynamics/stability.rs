//! Whether the step is stable: the check stands above both forms, and knows what pulls on hair by name only.
//!
//! The scheme (7) holds while c_i times the sum of all that pulls on segment i stays below 4: the field, and each [`Pull`] of a form. In the
//! free form, whose joints, hold and air are implicit, A h^2 / L stands for c_i, with h the part of a frame that a step takes.

use glam::Vec3;

use super::gain::{SegmentShape, segment_shapes};
use super::pull::Pull;
use super::{Dynamics, Form, free};
use crate::error::SettingError;
use crate::field::Field;
use crate::strands::Strands;

impl Form {
    /// What pulls on hair besides the field.
    fn pulls(&self) -> Vec<Box<dyn Pull + '_>> {
        match self {
            Self::Paper => Vec::new(),
            Self::Free(free) => free::pulls(free),
        }
    }

    /// The setting that multiplies the field's force on a strand most, as text, if one does; `root` is that of the strand.
    fn multiplies(&self, root: Vec3) -> Option<String> {
        let Self::Free(free) = self else { return None };
        let regions = free.form.regions.iter().enumerate();
        let felt = regions.filter(|&(i, region)| region.most_force() > 1.0 && free.weight_in(i, root) > 0.0);
        let (i, most) = felt.max_by(|a, b| a.1.most_force().total_cmp(&b.1.most_force()))?;
        let key = format!("free.regions[{i}]");
        let share = most.fields.iter().enumerate().max_by(|a, b| a.1.share.total_cmp(&b.1.share));
        match share {
            Some((j, of)) if of.share > most.wind => Some(format!("{key}.fields[{j}].share = {}", of.share)),
            _ => Some(format!("{key}.wind = {}", most.wind)),
        }
    }

    /// Every segment of strand number `s`.
    fn shapes(&self, dynamics: &Dynamics, strand: &[Vec3], s: usize) -> Result<Vec<SegmentShape>, SettingError> {
        match self {
            Self::Paper => segment_shapes(dynamics, strand, s, 0),
            Self::Free(free) => free::shapes(dynamics, free, strand, s),
        }
    }
}

/// The largest gain c_i of all strands. A force is stable if this times |F| is below 4.
///
/// # Errors
/// As for [`Simulation::new`](super::Simulation::new), except the stability of the field.
pub fn largest_gain(strands: &Strands, dynamics: &Dynamics) -> Result<f64, SettingError> {
    Ok(Stability::of(strands, dynamics)?.gain)
}

/// Refuses a field that is too strong for the step (7) of this hair: c_i |F| must stay below 4.
///
/// # Errors
/// As for [`Simulation::new`](super::Simulation::new), except settings out of range.
pub fn check_field(strands: &Strands, dynamics: &Dynamics, field: &dyn Field) -> Result<(), SettingError> {
    if let Form::Free(free) = &dynamics.form {
        free.form.check_shares(field)?;
    }
    if Stability::of(strands, dynamics)?.holds(field) {
        return Ok(());
    }
    Err(unstable(&[Named { name: "strand", strands, ids: &[] }], dynamics, field))
}

/// What decides whether a field is stable: the segment that tolerates the least force.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stability {
    /// c_i.
    gain: f64,
    /// What pulls on it besides the field.
    own: f64,
}

impl Stability {
    /// Refuses an empty set of strands, and strands that cannot be moved.
    pub fn of(strands: &Strands, dynamics: &Dynamics) -> Result<Self, SettingError> {
        if strands.is_empty() {
            return Err(SettingError::new("hair", "", "has 0 strands: give at least one"));
        }
        let (mut worst, mut least) = (Self { gain: 0.0, own: 0.0 }, f64::INFINITY);
        let own = dynamics.form.pulls().iter().map(|pull| pull.strongest()).sum::<f64>();
        for (s, strand) in strands.iter().enumerate() {
            for shape in dynamics.form.shapes(dynamics, strand, s)? {
                let force = 4.0 / shape.gain - own;
                if force < least {
                    (worst, least) = (Self { gain: shape.gain, own }, force);
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

    /// The strongest force that [`holds`](Self::holds), for hair that is stable without a force.
    pub fn strongest_force(&self) -> f32 {
        let mut force = ((4.0 / self.gain - self.own) as f32).min(f32::MAX);
        while force > 0.0 && !self.holds_force(force) {
            force = force.next_down();
        }
        force.max(0.0)
    }
}

/// Some hair, and the name of its strands in errors.
pub(super) struct Named<'a> {
    pub name: &'a str,
    pub strands: &'a Strands,
    /// Their numbers in the larger set; empty if they are all of it.
    pub ids: &'a [u32],
}

impl Named<'_> {
    /// The name of strand `s`, with the length that moves.
    fn strand(&self, s: usize, shapes: &[SegmentShape]) -> String {
        let number = self.ids.get(s).map_or(s, |&id| id as usize);
        let moving: f64 = shapes.iter().filter(|shape| shape.gain > 0.0).map(|shape| shape.length).sum();
        let behind = if shapes.iter().any(|shape| shape.gain == 0.0) { " beyond its tie" } else { "" };
        format!("{} {number} ({moving:.2} cm long{behind})", self.name)
    }
}

/// Where hair is least stable, and the room left for each part.
struct Worst {
    /// c_i times all that pulls.
    reached: f64,
    /// The strand.
    place: String,
    /// What multiplies the force there.
    multiplied: Option<String>,
    /// All that pulls there, the field's force last.
    parts: Vec<f64>,
    /// With all others unchanged, everywhere: the factor by which each pull may grow, and the largest force.
    rooms: Vec<f64>,
}

impl Worst {
    fn of(hair: &[Named<'_>], dynamics: &Dynamics, pulls: &[Box<dyn Pull + '_>], force: f64) -> Self {
        let last = pulls.len();
        let (mut reached, mut place, mut multiplied) = (0.0, String::new(), None);
        let (mut worst, mut rooms) = (vec![0.0; last + 1], vec![f64::INFINITY; last + 1]);
        let parts: Vec<f64> = pulls.iter().map(|pull| pull.strongest()).chain([force]).collect();
        for named in hair {
            for (s, strand) in named.strands.iter().enumerate() {
                let shapes = dynamics.form.shapes(dynamics, strand, s).unwrap_or_default();
                for shape in shapes.iter().filter(|shape| shape.gain > 0.0) {
                    for part in (0..=last).filter(|&part| parts[part] > 0.0) {
                        // Never from the sum of all, in which a part that is too large would swallow the others.
                        let others: f64 = (0..=last).filter(|&other| other != part).map(|other| parts[other]).sum();
                        let room = 4.0 / shape.gain - others;
                        rooms[part] = rooms[part].min(if part == last { room } else { room / parts[part] });
                    }
                    let all = shape.gain * parts.iter().sum::<f64>();
                    if all > reached {
                        (reached, place) = (all, named.strand(s, &shapes));
                        multiplied = dynamics.form.multiplies(strand[0]);
                        worst.copy_from_slice(&parts);
                    }
                }
            }
        }
        Self { reached, place, multiplied, parts: worst, rooms }
    }
}

/// Why movable hair is unstable under a field: the largest pull where hair is least stable, and how much of it would
/// hold beside all others.
pub(super) fn unstable(hair: &[Named<'_>], dynamics: &Dynamics, field: &dyn Field) -> SettingError {
    if field.strongest().is_nan() {
        return SettingError::new("force", field.strongest(), "must be a number");
    }
    let (pulls, strongest) = (dynamics.form.pulls(), f64::from(field.strongest()));
    let Worst { reached, place, multiplied, parts, rooms } = Worst::of(hair, dynamics, &pulls, strongest);
    let terms: Vec<&str> = pulls.iter().map(|pull| pull.name().term).collect();
    let sum = if terms.is_empty() { "|F|".to_owned() } else { format!("(|F| + {})", terms.join(" + ")) };
    let (gain, finer) = match dynamics.form {
        Form::Paper => ("c_i", ""),
        Form::Free(_) => ("A h^2 / L", "raise free.substeps, "),
    };
    let ways =
        format!("{finer}lower motion.time_step, or set motion.inertia_length_floor so that neighbours hold short hair");
    let ways = match multiplied {
        Some(by) => format!("or lower {by}, which multiplies the force there; otherwise {ways}"),
        None => ways,
    };
    let refused = |thing: &str, value: String, keep: String| {
        let reached = if reached < 1e6 { format!("{reached:.3}") } else { format!("{reached:.1e}") };
        let metres = in_metres(hair, dynamics);
        let remedy = format!(
            "unstable: {gain} {sum} reaches {reached} at {place}, but must stay below 4; {keep}, {ways}{metres}"
        );
        SettingError::new(thing, value, remedy)
    };
    let mut largest_first: Vec<usize> = (0..parts.len()).collect();
    largest_first.sort_by(|&a, &b| parts[b].total_cmp(&parts[a]));
    // The force is the part after the last pull.
    match largest_first.iter().find(|&&part| rooms[part] > 0.0 && rooms[part].is_finite()) {
        Some(&part) if part == pulls.len() => {
            let largest = rooms[part];
            // A force of exactly the limit is too strong.
            let below = largest.next_down();
            let (thing, value) =
                field.first_above(below).unwrap_or_else(|| ("force".to_owned(), field.strongest().to_string()));
            refused(&thing, value, format!("keep |F| below {largest:.4}"))
        }
        Some(&part) => {
            let (pull, name) = (&pulls[part], pulls[part].name());
            let holds = rounded_down(rooms[part] * f64::from(pull.setting()));
            refused(name.setting, pull.setting().to_string(), format!("keep {} below {holds}", name.words))
        }
        None => {
            let most = largest_first.iter().find_map(|&part| pulls.get(part));
            let (thing, value) =
                most.map_or(("force", field.strongest()), |pull| (pull.name().setting, pull.setting()));
            let others: Vec<&str> = (pulls.iter().zip(&parts))
                .filter(|(_, part)| **part > 0.0)
                .map(|(pull, _)| pull.name().setting)
                .filter(|other| *other != thing)
                .chain((strongest > 0.0).then_some("the forces"))
                .collect();
            let keep = format!("lowering it alone is not enough: also lower {}", others.join(" and "));
            refused(thing, value.to_string(), keep)
        }
    }
}

/// Hair with a longest strand below this (cm), on a head with a mean half axis below it, is in metres, not in cm.
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
    format!("; {}: if that is in metres, convert it to cm (times 100)", small.join(" and "))
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
    use crate::field::{Keyframe, KeyframedField};
    use crate::free_form::FreeMotion;
    use glam::Vec3;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn what_a_refusal_says_would_hold_holds(
            // Moderate numbers, and ones that swallow all others or overflow.
            powers in prop::array::uniform2(prop_oneof![3 => 1.0_f32..8.0, 1 => 8.0_f32..38.5]),
            cuts in prop::collection::vec((2_usize..12, 3.0_f32..20.0), 1..4),
        ) {
            let mut hair = Strands::default();
            for (count, length) in cuts {
                hair.push((0..=count).map(|i| Vec3::Y * length * (i as f32 / count as f32).powf(1.3)));
            }
            let mut free = FreeMotion::default();
            let [gravity, mut force] = powers.map(|power| (10.0_f32.powf(power) - 10.0).min(f32::MAX));
            free.form.gravity = gravity;
            let refused = |free: &FreeMotion, force: f32| {
                let dynamics = Dynamics {
                    form: Form::Free(free.clone()),
                    ..Dynamics::new(Ellipsoid { center: Vec3::ZERO, half_axes: Vec3::splat(9.0) })
                };
                let field = KeyframedField::new(&[Keyframe { through: 9, vector: Vec3::X * force }]).unwrap();
                check_field(&hair, &dynamics, &field).err()
            };
            // What is too much even without the rest is named first, so a few errors fix any scene.
            for _ in 0..5 {
                let Some(error) = refused(&free, force) else { return Ok(()) };
                let Some((_, limit)) = error.remedy.split_once(" below ").and_then(|(_, after)| after.split_once(" below ")) else {
                    // Nothing alone fixes it: remove the largest.
                    free.form.gravity = 0.0;
                    continue;
                };
                let limit: f32 = limit.split(',').next().unwrap().parse().unwrap();
                // Forces are printed with four decimals.
                let within = 0.999 * limit;
                match error.thing.to_string().as_str() {
                    "free.gravity" => free.form.gravity = within,
                    _ => force = within,
                }
                prop_assert_eq!(refused(&free, force).map(|e| e.to_string()), None);
            }
            prop_assert!(false, "five lines are not enough");
        }
    }
}
