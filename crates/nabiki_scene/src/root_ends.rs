//! Which end of a strand is its root: hair grows on the skin, and stands off it elsewhere.
//!
//! Most strands tell by themselves: one of their ends lies on the skin and the other well outside. Where some of a file's are thus
//! stored tip first, those that do not tell (hair that lies on the skin from end to end) go by how far from the skin the roots of
//! the others are, and by how many of these are tip first.

use glam::Vec3;
use nabiki::strands::length;
use nabiki::{Head, Strands};
use nabiki_io::Placement;

use crate::size::mean_half_axis;

/// Ends of imported hair on the skin are no farther outside than this, and no deeper inside (shares of the mean half axis).
const OUTSIDE: f32 = 0.15;
const INSIDE: f32 = 0.3;

/// The root of a strand is clear if the other end stands off the skin by this share of its length, by this multiple of the root's
/// distance, and by more than heads differ from the one that the hair was made on (share of the mean half axis).
const STANDS_OFF: f32 = 0.1;
const TIMES: f32 = 5.0;
const UNLIKE: f32 = 0.05;

/// In hair that is in place, at least this share has an end on the skin. Other hair tells nothing.
const IN_PLACE: f32 = 0.5;

/// A file stores strands tip first if this many of the clear ones are.
const SOME: f32 = 0.005;

/// The largest preference of unclear strands for the direction of most clear ones.
const LIKE_OTHERS: f32 = 10.0;

/// The distances of the ends of a strand from the skin, negative inside, and its length (all cm).
struct Ends {
    first: f32,
    last: f32,
    length: f32,
}

/// What a strand tells by itself.
#[derive(Clone, Copy, PartialEq)]
enum Told {
    RootFirst,
    TipFirst,
    Nothing,
}

impl Ends {
    /// The distances of its root and of its tip, given which end is the root.
    fn of(&self, told: Told) -> (f32, f32) {
        if told == Told::TipFirst { (self.last, self.first) } else { (self.first, self.last) }
    }

    fn on_skin(&self, size: f32) -> bool {
        [self.first, self.last].iter().any(|end| (-INSIDE * size..=OUTSIDE * size).contains(end))
    }

    fn tell(&self, size: f32) -> Told {
        let is_root = |near: f32, far: f32| {
            let on_skin = (-INSIDE * size..=OUTSIDE * size).contains(&near);
            let least = (STANDS_OFF * self.length).max(TIMES * near).max(UNLIKE * size);
            on_skin && far >= least
        };
        match (is_root(self.first, self.last), is_root(self.last, self.first)) {
            (true, _) => Told::RootFirst,
            (_, true) => Told::TipFirst,
            _ => Told::Nothing,
        }
    }
}

/// The strands that a file with this placement stores tip first; `None` if there are none.
pub(crate) fn tip_first(strands: &Strands, head: &Head, placement: &Placement) -> Option<Vec<bool>> {
    let size = mean_half_axis(&head.ellipsoid);
    let (place, cm) = (placement.head_from_file(), placement.unit.cm);
    let ends = |strand: &[Vec3]| {
        let off = |p: Option<&Vec3>| p.map_or(f32::INFINITY, |&p| head.distance(place.transform_point3(p)));
        Ends { first: off(strand.first()), last: off(strand.last()), length: cm * length(strand) }
    };
    let ends: Vec<Ends> = strands.iter().map(ends).collect();
    let in_place = ends.iter().filter(|ends| ends.on_skin(size)).count() as f32;
    if in_place < IN_PLACE * ends.len() as f32 {
        return None;
    }
    let mut told: Vec<Told> = ends.iter().map(|ends| ends.tell(size)).collect();
    let count = |told: &[Told], what: Told| told.iter().filter(|&&told| told == what).count() as f32;
    let most =
        if count(&told, Told::TipFirst) > count(&told, Told::RootFirst) { Told::TipFirst } else { Told::RootFirst };
    // The typical distance of roots from the skin, and its spread. On another head than the one the hair was made on,
    // roots stand off easily, which tells little.
    let roots = ends.iter().zip(&told).filter(|(_, told)| **told == most).map(|(ends, _)| ends.of(most).0);
    let usual = quantile(roots.clone().collect(), 0.5);
    let unlike = quantile(roots.map(|root| (root - usual).abs()).collect(), 0.9);
    for (ends, told) in ends.iter().zip(&mut told).filter(|(_, told)| **told != most) {
        if ends.of(*told).1 - usual < TIMES * unlike {
            *told = Told::Nothing;
        }
    }
    let (root_first, tip_first) = (count(&told, Told::RootFirst), count(&told, Told::TipFirst));
    if tip_first == 0.0 || tip_first < SOME * (root_first + tip_first) {
        return None;
    }
    let like_others = (root_first / tip_first).clamp(LIKE_OTHERS.recip(), LIKE_OTHERS);
    let is_tip_first = |(ends, told): (&Ends, &Told)| match told {
        Told::RootFirst => false,
        Told::TipFirst => true,
        Told::Nothing => like_others * (ends.last - usual).abs() < (ends.first - usual).abs(),
    };
    Some(ends.iter().zip(&told).map(is_tip_first).collect())
}

/// The value below which this share of all lies; 0 for none.
fn quantile(mut all: Vec<f32>, part: f32) -> f32 {
    all.sort_by(f32::total_cmp);
    all.get((part * all.len() as f32) as usize).copied().unwrap_or(0.0)
}
