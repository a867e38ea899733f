//! What looks wrong about the size and place of a head and its hair, before anything is drawn: a unit forgotten, hair beside
//! the head.

use std::fmt;

use glam::Vec3;
use nabiki::{Ellipsoid, Head, Strands};
use nabiki_io::Placement;

use crate::scene::{EllipsoidChoice, HairSource, HeadSource, Scene};

/// Mean half axis of a person's head ellipsoid (cm): that of the built-in bust, 9.5 x 11 x 7.8.
pub(crate) const HALF_AXIS: f32 = 9.3;

/// Heads from a newborn's to half again an adult's are taken as they are: the mean half axis (cm).
const HALF_AXES: [f32; 2] = [5.0, 14.0];

/// Roots whose median lies farther than this from the skin do not grow on it (share of the mean half axis).
pub(crate) const AFLOAT: f32 = 0.15;

/// The units that a file may be in, by their names in a scene, with their centimetres.
pub(crate) const UNITS: [(&str, f32); 6] =
    [("mm", 0.1), ("cm", 1.0), ("in", 2.54), ("dm", 10.0), ("ft", 30.48), ("m", 100.0)];

/// A setting that deserves a look: what was seen, and what may mend it.
#[derive(Clone, Debug, PartialEq)]
pub struct Advice {
    /// The setting, `head.unit`.
    pub key: &'static str,
    /// The value that would make it right, in TOML, where one can be told.
    pub value: Option<String>,
    /// What was seen.
    pub seen: String,
}

impl fmt::Display for Advice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.value {
            Some(value) => write!(f, "{}: give {} = {value}", self.seen, self.key),
            None => write!(f, "{}: look at {}", self.seen, self.key),
        }
    }
}

/// What to look at before drawing. `head` and `strands` are in head space, where the placements have put them; hair
/// grown here has none.
pub fn advice(
    scene: &Scene,
    head: &Head,
    head_placement: &Placement,
    strands: &Strands,
    hair_placement: Option<&Placement>,
) -> Vec<Advice> {
    let of_head = head_size(scene, &head.ellipsoid, head_placement);
    // Hair that goes by the unit of a wrong head cannot be judged.
    if of_head.is_some() {
        return of_head.into_iter().collect();
    }
    let roots: Vec<Vec3> = strands.iter().filter_map(|strand| strand.first().copied()).collect();
    match (&scene.hair.source, hair_placement) {
        (HairSource::Imported(_), Some(placement)) => afloat(head, &roots, placement).into_iter().collect(),
        _ => Vec::new(),
    }
}

fn head_size(scene: &Scene, ellipsoid: &Ellipsoid, placement: &Placement) -> Option<Advice> {
    let size = mean_half_axis(ellipsoid);
    if (HALF_AXES[0]..=HALF_AXES[1]).contains(&size) {
        return None;
    }
    let [x, y, z] = ellipsoid.half_axes.to_array();
    let seen = format!("the head's half axes are {x:.3} x {y:.3} x {z:.3} cm, a person's about 9.5 x 11 x 7.8");
    let given = matches!(scene.head.ellipsoid, EllipsoidChoice::Given(_));
    if given || scene.head.source == HeadSource::Builtin {
        return Some(Advice { key: "head.ellipsoid", value: None, seen });
    }
    let value = unit_for(size / placement.unit.cm, HALF_AXIS);
    Some(Advice { key: "head.unit", value: Some(value), seen })
}

fn afloat(head: &Head, roots: &[Vec3], placement: &Placement) -> Option<Advice> {
    let size = mean_half_axis(&head.ellipsoid);
    let off = median_distance(head, roots)?;
    if off <= AFLOAT * size {
        return None;
    }
    let seen = format!("half of the hair's roots lie more than {off:.2} cm from the skin");
    // Roots spread over a scalp about as far as the scalp is from its middle.
    let spread = spread(roots);
    if (0.5..=2.0).contains(&(spread / size)) || spread == 0.0 {
        let middle = placement.file_from_head().transform_point3(middle(roots) - above_centre(&head.ellipsoid));
        return Some(Advice { key: "hair.origin", value: Some(vector(middle)), seen });
    }
    Some(Advice { key: "hair.unit", value: Some(unit_for(spread / placement.unit.cm, SPREAD * size)), seen })
}

/// Root mean square distance of a scalp's roots from their middle, in mean half axes.
pub(crate) const SPREAD: f32 = 0.95;

/// Where the middle of a scalp's roots is, seen from the ellipsoid's centre (cm).
pub(crate) fn above_centre(ellipsoid: &Ellipsoid) -> Vec3 {
    ellipsoid.center + ellipsoid.half_axes * Vec3::new(-0.2, 0.35, 0.0)
}

pub(crate) fn mean_half_axis(ellipsoid: &Ellipsoid) -> f32 {
    ellipsoid.half_axes.element_product().cbrt()
}

pub(crate) fn middle(points: &[Vec3]) -> Vec3 {
    points.iter().sum::<Vec3>() / points.len().max(1) as f32
}

pub(crate) fn spread(points: &[Vec3]) -> f32 {
    let middle = middle(points);
    (points.iter().map(|p| p.distance_squared(middle)).sum::<f32>() / points.len().max(1) as f32).sqrt()
}

/// The median distance of roots to the skin, of a thousand of them at most (cm).
pub(crate) fn median_distance(head: &Head, roots: &[Vec3]) -> Option<f32> {
    let step = (roots.len() / 1000).max(1);
    let mut off: Vec<f32> = roots.iter().step_by(step).map(|&root| head.distance(root).abs()).collect();
    off.sort_by(f32::total_cmp);
    off.get(off.len() / 2).copied()
}

/// The unit, in TOML, in which `size` (file units) is about `wanted` (cm): a name, or centimetres where none fits.
pub(crate) fn unit_for(size: f32, wanted: f32) -> String {
    // A head off by more than this is in another unit.
    const NEAR: f32 = 1.45;
    let off = |cm: f32| (size * cm / wanted).max(wanted / (size * cm));
    let nearest = UNITS.iter().min_by(|a, b| off(a.1).total_cmp(&off(b.1)));
    match nearest.filter(|unit| off(unit.1) < NEAR) {
        Some((name, _)) => format!("\"{name}\""),
        None => rounded(wanted / size),
    }
}

/// A number to two digits.
pub(crate) fn rounded(number: f32) -> String {
    let text = format!("{number:.1e}");
    text.parse::<f32>().map_or(text, |number| number.to_string())
}

/// A point as TOML has it.
pub(crate) fn vector(p: Vec3) -> String {
    let [x, y, z] = p.to_array().map(|x| {
        // Four digits are finer than any guess.
        let text = format!("{x:.3e}").parse::<f32>().unwrap_or(x);
        format!("{text:?}")
    });
    format!("[{x}, {y}, {z}]")
}
