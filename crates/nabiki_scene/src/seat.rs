//! Where imported hair sits on a head: how well it lies there, and where it would lie better.
//!
//! Everything is judged by an even choice of the file's own strands, however many are shown. The result depends only on the
//! file, the head, the axes and the unit; a facing is tried only if no origin is given. So advice that was followed is not
//! reversed later.

use std::path::Path;

use glam::{Mat3, Vec3};
use nabiki::{Ellipsoid, Hair, Head, Strands};
use nabiki_exchange::InPlace;
use nabiki_io::{Axis, DeclaredSpace, Placement, Unit};

use crate::root_ends;
use crate::scene::{ImportedHair, RootEnd};
use crate::size::{decimal, mean_half_axis, middle, spread, unit_for};

/// If the roots' median distance from the skin exceeds this, they do not grow on it (share of the mean half axis).
const AFLOAT: f32 = 0.15;

/// Hair with more than this share of points inside the head was made for another. (Hair that fits has 0.2 to 1.5 %,
/// because its lowest layers were modelled on a skin between whose vertices they now lie.)
const INSIDE: f32 = 0.05;

/// Number of strands by which a file is judged.
const JUDGED: usize = 600;

/// Number of roots by which a place is found.
const FITTED: usize = 200;

/// Root mean square distance of a scalp's roots from their middle, in mean half axes.
const SPREAD: f32 = 0.95;

/// Spreads that a scalp, or a large part of one, may have, in mean half axes.
const SPREADS: std::ops::RangeInclusive<f32> = 0.5..=2.0;

/// A unit in a file counts as wrong only beyond this factor: some programs name a wrong one, and hair that lies a
/// little too deep should keep its unit.
const MISNAMED: f32 = 2.0;

/// The placement of the hair's file in head space: like the head's file, except for what the scene or the file itself
/// declares. Two files with different up axes are tipped accordingly.
pub(crate) fn hair_placement(settings: &ImportedHair, head: &Placement, declared: DeclaredSpace) -> Placement {
    let up = settings.up.or(declared.up).unwrap_or(head.up);
    let unmoved = Placement {
        unit: settings.unit.or(declared.unit).unwrap_or(head.unit),
        up,
        facing: settings.facing.unwrap_or_else(|| head.facing.tipped(head.up, up)),
        origin: Vec3::ZERO,
    };
    if unmoved == (Placement { origin: Vec3::ZERO, ..*head }) {
        return Placement { origin: settings.origin.unwrap_or(head.origin), ..unmoved };
    }
    // The head's origin is a place in the world that both files share.
    let shared = Placement { origin: Vec3::ZERO, ..*head }.head_from_file().transform_point3(head.origin);
    let origin = settings.origin.unwrap_or_else(|| unmoved.file_from_head().transform_point3(shared));
    Placement { origin, ..unmoved }
}

/// How hair lies on a head.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Lie {
    /// Median distance of the roots from the skin (cm).
    pub off: f32,
    /// Share of the other points that are inside the head.
    pub inside: f32,
    /// How deep the deepest of them is (cm).
    pub depth: f32,
    /// Whether the roots are on the skin.
    pub on_skin: bool,
}

impl Lie {
    /// Whether the hair may belong to this head.
    pub fn is_good(&self) -> bool {
        self.on_skin && self.inside <= INSIDE
    }

    /// Whether this is clearly better than `other`.
    fn is_better_than(&self, other: &Self) -> bool {
        let clearly = |a: f32, b: f32| a < 0.8 * b;
        self.is_good()
            || if other.on_skin {
                self.on_skin && clearly(self.inside, other.inside)
            } else {
                self.on_skin || clearly(self.off, other.off)
            }
    }
}

/// Settings of `[hair]` that would seat it better; `None` means no change.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Mended {
    /// `hair.facing`.
    pub facing: Option<Axis>,
    /// `hair.unit`, in TOML.
    pub unit: Option<String>,
    /// `hair.up`.
    pub up: Option<Axis>,
    /// `hair.origin` (the file's unit).
    pub origin: Option<Vec3>,
    /// Whether unit and axes are those of the head.
    pub as_the_head: bool,
}

/// What the hair's file declares; for the head's own file, only what the head has.
pub(crate) fn heeded(declared: DeclaredSpace, of_head: bool) -> DeclaredSpace {
    if of_head { DeclaredSpace::default() } else { declared }
}

/// Whether two names refer to one file.
pub(crate) fn is_one_file(a: &Path, b: &Path) -> bool {
    a == b || a.canonicalize().ok().zip(b.canonicalize().ok()).is_some_and(|(a, b)| a == b)
}

/// An even choice of a file's strands, in the file's world.
pub(crate) fn judged(read: &InPlace) -> Strands {
    let all = &read.hair.strands;
    let step = all.len().div_ceil(JUDGED).max(1);
    let chosen: Vec<usize> = (0..all.len()).step_by(step).filter(|&s| !all.strand(s).is_empty()).collect();
    Hair::from(all.select(&chosen)).transformed(&read.world_from_hair).strands
}

/// Hair of a file on a head.
pub(crate) struct Seat<'a> {
    pub head: &'a Head,
    /// Chosen by [`judged`] (the file's unit and axes).
    pub strands: &'a Strands,
    /// The scene's settings for the file.
    pub settings: &'a ImportedHair,
    pub head_placement: &'a Placement,
    /// What the file itself declares; nothing if it is also the head's file, and then has the head's placement.
    pub declared: DeclaredSpace,
    /// Whether it is also the head's file.
    pub of_head: bool,
    /// Which ends of the strands are on the skin, before the placement of the file is known.
    pub ends: LikelyRoots,
}

/// The ends of strands that may be roots.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) enum LikelyRoots {
    /// The first point of each.
    #[default]
    First,
    /// The last point of each.
    Last,
    /// Either.
    Either,
}

impl Seat<'_> {
    /// How the hair lies with the scene's settings.
    pub fn lie(&self) -> Lie {
        self.lie_at(&self.placement(&Mended::default()))
    }

    /// Settings that give hair from the head's own file another placement than the head.
    pub fn astray(&self) -> Vec<&'static str> {
        if !self.of_head || self.placement(&Mended::default()) == *self.head_placement {
            return Vec::new();
        }
        let ImportedHair { unit, up, facing, origin, .. } = self.settings;
        let given = [
            (unit.is_some(), "hair.unit"),
            (up.is_some(), "hair.up"),
            (facing.is_some(), "hair.facing"),
            (origin.is_some(), "hair.origin"),
        ];
        given.into_iter().filter(|(given, _)| *given).map(|(_, key)| key).collect()
    }

    /// Whether the scene sets the place of the head in the file.
    pub fn has_origin(&self) -> bool {
        self.settings.origin.is_some()
    }

    /// Settings with which it would lie clearly better, and how it would lie then. Hair from the head's own file is in
    /// its place.
    pub fn mended(&self) -> Option<(Mended, Lie)> {
        let now = self.lie();
        if now.is_good() || self.of_head {
            return None;
        }
        if let Some(as_the_head) = self.as_the_head() {
            return Some(as_the_head);
        }
        let best = self.mended_from(now);
        if self.settings.root != RootEnd::Skin || best.as_ref().is_some_and(|(_, then)| then.is_good()) {
            return best;
        }
        // The file may have strands tip first.
        let others = [LikelyRoots::Last, LikelyRoots::Either].into_iter();
        let mut others = others.filter_map(|ends| Seat { ends, ..*self }.mended_from(now));
        others.find(|(_, then)| then.is_good()).or(best)
    }

    /// In the unit and axes of the head, if it lies well then, whatever its own file says: exporters leave them out of one
    /// of two files, and a USD layer without a unit means centimetres.
    fn as_the_head(&self) -> Option<(Mended, Lie)> {
        let ImportedHair { unit, up, facing, origin, .. } = self.settings;
        if unit.is_some() || up.is_some() || facing.is_some() || origin.is_some() {
            return None;
        }
        let head = self.head_placement;
        let now = self.placement(&Mended::default());
        let mended = Mended {
            unit: (head.unit != now.unit).then(|| exactly(head.unit)),
            up: (head.up != now.up).then_some(head.up),
            as_the_head: true,
            ..Mended::default()
        };
        let then = self.lie_at(&self.placement(&mended));
        then.is_good().then_some((mended, then))
    }

    fn mended_from(&self, now: Lie) -> Option<(Mended, Lie)> {
        let mended = self.turned(&now).unwrap_or_else(|| self.best());
        let then = self.lie_at(&self.placement(&mended));
        if !then.is_good()
            && let Some(other) = self.in_another_unit(&now)
        {
            return Some(other);
        }
        then.is_better_than(&now).then_some((mended, then))
    }

    /// As if the file named no unit, if it lies well then: some programs name a wrong one.
    fn in_another_unit(&self, now: &Lie) -> Option<(Mended, Lie)> {
        if self.unit_is_open() || self.settings.unit.is_some() {
            return None;
        }
        let open = Seat { declared: DeclaredSpace { unit: None, ..self.declared }, ..*self };
        let mut mended = open.turned(now).unwrap_or_else(|| open.best());
        let unit = open.placement(&mended).unit;
        mended.unit.get_or_insert_with(|| decimal(unit.cm, 3));
        let off = unit.cm / self.placement(&Mended::default()).unit.cm;
        if (MISNAMED.recip()..=MISNAMED).contains(&off) {
            return None;
        }
        let then = self.lie_at(&self.placement(&mended));
        then.is_good().then_some((mended, then))
    }

    fn placement(&self, mended: &Mended) -> Placement {
        let unit = mended.unit.as_deref().map(|text| Unit { cm: centimetres(text) });
        let settings = ImportedHair {
            unit: unit.or(self.settings.unit),
            up: mended.up.or(self.settings.up),
            facing: mended.facing.or(self.settings.facing),
            origin: mended.origin.or(self.settings.origin),
            ..self.settings.clone()
        };
        hair_placement(&settings, self.head_placement, self.declared)
    }

    fn lie_at(&self, placement: &Placement) -> Lie {
        let place = placement.head_from_file();
        let tip_first = match self.settings.root {
            RootEnd::Skin => root_ends::tip_first(self.strands, self.head, placement).unwrap_or_default(),
            RootEnd::First => Vec::new(),
            RootEnd::Last => vec![true; self.strands.len()],
        };
        // The root of each strand, and its other points.
        let parted = self.strands.iter().enumerate().map(|(s, strand)| match tip_first.get(s) {
            Some(true) => (strand[strand.len() - 1], &strand[..strand.len() - 1]),
            _ => (strand[0], &strand[1..]),
        });
        let parted: Vec<(Vec3, &[Vec3])> = parted.collect();
        let mut off: Vec<f32> =
            parted.iter().map(|(root, _)| self.head.distance(place.transform_point3(*root)).abs()).collect();
        off.sort_by(f32::total_cmp);
        let off = off.get(off.len() / 2).copied().unwrap_or(0.0);
        let mut points = 0;
        let (mut inside, mut depth) = (0, 0.0_f32);
        for &p in parted.iter().flat_map(|(_, others)| *others) {
            let deep = self.head.depth(place.transform_point3(p));
            points += 1;
            inside += usize::from(deep > 0.0);
            depth = depth.max(deep);
        }
        let on_skin = off <= AFLOAT * mean_half_axis(&self.head.ellipsoid);
        Lie { off, inside: inside as f32 / points.max(1) as f32, depth, on_skin }
    }

    /// Another facing if it lies well with it, alone or with a unit and an origin, and does not lie well now.
    fn turned(&self, now: &Lie) -> Option<Mended> {
        // A given origin belongs to the given facing.
        if self.has_origin() {
            return None;
        }
        let placement = self.placement(&Mended::default());
        let as_it_faces = self.lie_at(&self.placement(&self.moved(Mended::default())));
        if as_it_faces.is_good() {
            return None;
        }
        let around = Axis::ALL.into_iter().filter(|axis| axis.is_across(placement.up) && *axis != placement.facing);
        let turned = || around.clone().map(|axis| Mended { facing: Some(axis), ..Mended::default() });
        // Hair is about equally long on all sides, so a small improvement may be chance.
        let least = 0.5 * if now.on_skin { now.inside.min(as_it_faces.inside) } else { as_it_faces.inside };
        // Hair that was only moved aside still fits its head best as it faces, however much of it is inside.
        let lies_well = |mended: &Mended| {
            let lie = self.lie_at(&self.placement(mended));
            lie.is_good() && lie.inside < least && lie.off <= as_it_faces.off
        };
        turned().find(lies_well).or_else(|| turned().map(|mended| self.moved(mended)).find(lies_well))
    }

    /// Tries the unit by the spread of the roots, if none is stated and the scene's gives no scalp; then with the origin.
    fn moved(&self, mut best: Mended) -> Mended {
        let size = mean_half_axis(&self.head.ellipsoid);
        let spread = spread(&self.roots());
        let placement = self.placement(&best);
        if self.unit_is_open() && spread > 0.0 && !SPREADS.contains(&(spread * placement.unit.cm / size)) {
            best.unit = Some(unit_for(spread, SPREAD * size));
        }
        if !self.lie_at(&self.placement(&best)).on_skin {
            best.origin = Some(self.found_origin(&self.placement(&best)));
        }
        best
    }

    fn unit_is_open(&self) -> bool {
        self.declared.unit.is_none()
    }

    /// Moved like this, and with a slightly larger unit if too much of the hair is inside.
    fn best(&self) -> Mended {
        let best = self.moved(Mended::default());
        let lie = self.lie_at(&self.placement(&best));
        if self.unit_is_open() && lie.on_skin && lie.inside > INSIDE {
            return self.enlarged(&self.placement(&best)).unwrap_or(best);
        }
        best
    }

    fn roots(&self) -> Vec<Vec3> {
        let last = |strand: &[Vec3]| strand[strand.len() - 1];
        match (self.settings.root, self.ends) {
            (RootEnd::Last, _) | (RootEnd::Skin, LikelyRoots::Last) => self.strands.iter().map(last).collect(),
            (RootEnd::First, _) | (RootEnd::Skin, LikelyRoots::First) => {
                self.strands.iter().map(|strand| strand[0]).collect()
            }
            (RootEnd::Skin, LikelyRoots::Either) => {
                self.strands.iter().flat_map(|strand| [strand[0], last(strand)]).collect()
            }
        }
    }

    /// The origin that brings the roots nearest to the skin, in the file's unit: the least sum of distances, from
    /// several starting places on the scalp.
    fn found_origin(&self, placement: &Placement) -> Vec3 {
        let turn = Placement { origin: Vec3::ZERO, ..*placement }.head_from_file();
        let roots: Vec<Vec3> = self.roots().iter().map(|&root| turn.transform_point3(root)).collect();
        let step = roots.len().div_ceil(FITTED).max(1);
        let some: Vec<Vec3> = roots.iter().copied().step_by(step).collect();
        let sum = |shift: Vec3| some.iter().map(|&root| self.head.distance(root + shift).abs()).sum::<f32>();
        let mut best: Option<(f32, Vec3)> = None;
        for start in starts(&self.head.ellipsoid) {
            let shift = settled(self.head, &some, start - middle(&roots));
            let off = sum(shift);
            // The first assumes a whole scalp; a clearly better one replaces it.
            if best.is_none_or(|(least, _)| off < 0.8 * least) {
                best = Some((off, shift));
            }
        }
        let shift = best.map_or(Vec3::ZERO, |(_, shift)| shift);
        self.rounded(turn.inverse().transform_point3(-shift), placement.unit)
    }

    /// The least enlargement about the middle of the head that brings the hair out of it and keeps its roots on the skin.
    fn enlarged(&self, placement: &Placement) -> Option<Mended> {
        let center = self.head.ellipsoid.center;
        let middle = placement.file_from_head().transform_point3(center);
        (1..=15).find_map(|step| {
            let text = decimal(placement.unit.cm * (1.0 + 0.02 * step as f32), 3);
            let unit = Unit { cm: centimetres(&text) };
            let turn = Placement { unit, origin: Vec3::ZERO, ..*placement };
            let origin = self.rounded(middle - turn.file_from_head().transform_vector3(center), unit);
            let mended = Mended { unit: Some(text), origin: Some(origin), ..Mended::default() };
            self.lie_at(&self.placement(&mended)).is_good().then_some(mended)
        })
    }

    /// A point of the file as written in a scene.
    fn rounded(&self, p: Vec3, unit: Unit) -> Vec3 {
        rounded(p, mean_half_axis(&self.head.ellipsoid) / unit.cm)
    }
}

/// Candidates for the middle of some roots: of a whole scalp, of its top, its back, its sides.
fn starts(ellipsoid: &Ellipsoid) -> [Vec3; 5] {
    [[-0.2, 0.35, 0.0], [0.0, 0.9, 0.0], [-0.8, 0.3, 0.0], [-0.1, 0.4, 0.8], [-0.1, 0.4, -0.8]]
        .map(|[x, y, z]| ellipsoid.center + ellipsoid.half_axes * Vec3::new(x, y, z))
}

/// The shift near `shift` with the least sum of distances to the skin: Gauss-Newton steps, with each point weighted by
/// the inverse of its distance.
fn settled(head: &Head, points: &[Vec3], mut shift: Vec3) -> Vec3 {
    // Points this near to the skin have equal weight (share of the mean half axis).
    const NEAR: f32 = 0.01;
    const STEPS: usize = 40;
    let size = mean_half_axis(&head.ellipsoid);
    for _ in 0..STEPS {
        let (mut matrix, mut right) = (Mat3::from_diagonal(Vec3::splat(1e-3)), Vec3::ZERO);
        for &point in points {
            let (off, out) = (head.distance(point + shift), head.outward(point + shift));
            let weight = (off.abs() / size + NEAR).recip() / points.len() as f32;
            matrix += Mat3::from_cols(out * out.x, out * out.y, out * out.z) * weight;
            right += out * (off * weight);
        }
        let step = (matrix.inverse() * right).clamp_length_max(0.3 * size);
        if !step.is_finite() {
            break;
        }
        shift -= step;
        if step.length() < 1e-4 * size {
            break;
        }
    }
    shift
}

/// A point of a file, rounded to a thousandth of the size of its head (the file's unit): finer than any guess.
pub(crate) fn rounded(p: Vec3, size: f32) -> Vec3 {
    let decimals = (3.0 - size.log10()).ceil().clamp(0.0, 9.0) as usize;
    Vec3::from(p.to_array().map(|x| format!("{x:.decimals$}").parse::<f32>().unwrap_or(x) + 0.0))
}

/// A unit as a scene names it, or its centimetres.
fn exactly(unit: Unit) -> String {
    let name = unit.to_string();
    if name.contains(' ') { unit.cm.to_string() } else { format!("\"{name}\"") }
}

/// Centimetres of a unit as written in a scene.
pub(crate) fn centimetres(text: &str) -> f32 {
    text.trim_matches('"').parse().map_or(1.0, |unit: Unit| unit.cm)
}
