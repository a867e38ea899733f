//! Which end of a strand is its root: hair grows on the skin, and stands off it somewhere else.
//!
//! Most strands tell by themselves: one of their ends lies on the skin and the other well outside. Where some of a file's are thus
//! stored tip first, those that do not tell (hair that lies on the skin from end to end) go by how far from the skin the roots of
//! the others are, and by how many of these are tip first.

use glam::Vec3;
use nabiki::strands::length;
use nabiki::{Head, Strands};
use nabiki_io::Placement;

use crate::size::mean_half_axis;

/// Ends of imported hair on the skin lie no farther outside than this, and no deeper inside (shares of the mean half axis).
const OUTSIDE: f32 = 0.15;
const INSIDE: f32 = 0.3;

/// A strand tells which end is its root where the other stands off the skin by so much of its length, by so many times as much as the
/// root, and by more than heads are unlike the one that the hair was made on (share of the mean half axis).
const STANDS_OFF: f32 = 0.1;
const TIMES: f32 = 5.0;
const UNLIKE: f32 = 0.05;

/// Of hair that is in its place this share has an end on the skin at least. Any other tells nothing.
const IN_PLACE: f32 = 0.5;

/// A file has strands tip first where so many of those that tell are.
const SOME: f32 = 0.005;

/// How much sooner a strand that does not tell is taken to be as most are that do, at the most.
const LIKE_OTHERS: f32 = 10.0;

/// The distances of the ends of a strand from the skin, below 0 inside, and its length (all cm).
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
    /// The distances of its root and of its tip, where it is as `told`.
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

/// Which of the strands a file has tip first, that lies so; `None` where it has none so.
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
    // How far from the skin the roots of most are, and how unlike one another. Where the head is not the one that the hair was made
    // on, a root stands off it easily, and that tells little.
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

/// The value below which so large a part of all lies; 0 of none.
fn quantile(mut all: Vec<f32>, part: f32) -> f32 {
    all.sort_by(f32::total_cmp);
    all.get((part * all.len() as f32) as usize).copied().unwrap_or(0.0)
}
