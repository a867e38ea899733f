//! What a style asks of one strand: from its root to the direction, length, stiffness and loads it starts with.

use nabiki::glam::{DVec2, DVec3, Vec3};
use nabiki::locks::{Lock, Locks};
use nabiki::{Ellipsoid, Head};

use crate::chance::{Chance, channel};
use crate::curl::{Clump, StrandCurl};
use crate::roots::Root;
use crate::style::{Ponytail, Region, Style};

/// One strand's share of the style (head space, cm; loads in units of its own weight).
#[derive(Clone, Copy, Debug)]
pub(crate) struct StrandStyle {
    /// The root.
    pub root: DVec3,
    /// Direction of the hair at the root (unit vector).
    pub clamp: DVec3,
    /// (E I / w)^(1/3) (cm).
    pub bend: f64,
    /// Length before any cut (cm).
    pub length: f64,
    /// Load along all of the strand: the weight, tilted.
    pub weight: DVec3,
    /// Load at the root, and the length over which it falls to 1/e (cm).
    pub comb: DVec3,
    /// See `comb`.
    pub comb_decay: f64,
    /// Share of the layer's thickness that this strand reaches, 0..1.
    pub depth: f64,
    /// Slope of the strand's waves, across them.
    pub wave: DVec3,
    /// Phase of the waves at the root (rad).
    pub wave_phase: f64,
    /// Where the strand is rooted.
    pub region: Region,
    /// How far beyond its plane a cut is made (cm).
    pub cut_offset: f64,
    /// How it curls, if the style has curls.
    pub curl: Option<StrandCurl>,
    /// Where it is tied, if it is.
    pub tie: Option<Tie>,
}

/// Where a strand passes the band of a ponytail (head space, cm), and its direction behind that (unit vector).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tie {
    pub at: DVec3,
    pub behind: DVec3,
}

impl Tie {
    /// In the band, hair lies on the side that it comes from.
    fn new(tail: &Ponytail, root: DVec3, strand: Chance) -> Self {
        let middle = tail.at.as_dvec3();
        let through = tail.direction.as_dvec3().normalize();
        let from = root - middle;
        let side =
            (from - through * from.dot(through)).try_normalize().unwrap_or_else(|| through.any_orthonormal_vector());
        let off = side * strand.unit(channel::BAND).sqrt();
        Self { at: middle + off * f64::from(tail.radius), behind: (through + off * FLARE).normalize() }
    }
}

/// So far above the hairline, in its unit, no hair is baby hair.
const BABY_HAIR: f32 = 0.2;

/// Slope at which hair from the rim of a band leaves its middle line.
const FLARE: f64 = 0.25;

impl StrandStyle {
    /// How far it reaches from its line at the distance `s` along that (cm).
    pub(crate) fn curl_reach(&self, s: f64) -> f64 {
        self.curl.map_or(0.0, |curl| curl.reach(s))
    }

    /// Length of the line about which the whole strand winds, in segments no longer than `longest` (cm): its own length,
    /// if it does not curl.
    pub(crate) fn line_length(&self, longest: f64) -> f64 {
        self.curl.map_or(self.length, |curl| curl.line_length(self.length, longest))
    }

    /// The load per unit length at arc length `s` (cm).
    pub(crate) fn load(&self, s: f64) -> DVec3 {
        self.weight + self.comb * (-s / self.comb_decay).exp()
    }
}

/// Rises from 0 to 1 over 0..1, smoothly.
fn smooth(t: f32) -> f32 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Shares of top, sides, back and fringe at a root.
fn shares(ellipsoid: &Ellipsoid, style: &Style, root: Vec3, strand: Chance) -> [f32; 4] {
    let u = (root - ellipsoid.center) / ellipsoid.half_axes;
    // The fringe's edges are partings too.
    let astray = style.parting.wobble * strand.bell(channel::EDGE).abs() as f32;
    let fringe = &style.fringe;
    if fringe.half_width > 0.0 && root.z.abs() < fringe.half_width + astray && root.x > fringe.from - astray {
        return [0.0, 0.0, 0.0, 1.0];
    }
    let top = smooth((u.y - 0.45) / 0.3);
    let back = smooth((0.1 - u.x) / 0.4);
    [top, (1.0 - top) * (1.0 - back), (1.0 - top) * back, 0.0]
}

/// The region that has the greatest share.
fn region_of([top, sides, back, fringe]: [f32; 4]) -> Region {
    if fringe > 0.0 {
        Region::Fringe
    } else if top >= 0.5 {
        Region::Top
    } else if sides > back {
        Region::Sides
    } else {
        Region::Back
    }
}

/// The region that the style counts a root to.
pub(crate) fn region(head: &Head, style: &Style, root: &Root, seed: u64) -> Region {
    region_of(shares(&head.ellipsoid, style, root.position, Chance::at_point(seed, root.position)))
}

fn mean(values: [f32; 4], shares: [f32; 4]) -> f64 {
    values.iter().zip(shares).map(|(value, share)| f64::from(value * share)).sum()
}

/// So near the parting (cm) hair leaves it at a slant, toward the crown, and covers the line better than it would
/// straight across.
const SLANTED: f32 = 2.5;

/// The direction, level, in which hair is combed at `root`: away from the nearest point of the parting.
fn away_from_parting(style: &Style, root: DVec3, strand: Chance, clump: Chance) -> DVec3 {
    let plane = |chance: Chance| DVec2::new(chance.bell(channel::WOBBLE), chance.bell(channel::WOBBLE + 1));
    let [front, crown] = [style.parting.front, style.parting.crown].map(|end| end.as_dvec2());
    let line = front - crown;
    let strays = f64::from(style.parting.wobble);
    let here = DVec2::new(root.x, root.z) + strays * (plane(clump) + plane(strand)) * 0.7;
    let share = ((here - crown).dot(line) / line.length_squared().max(1e-12)).clamp(0.0, 1.0);
    let away = here - (crown + line * share);
    let away = DVec3::new(away.x, 0.0, away.y);
    let apart = f64::from(smooth(away.length() as f32 / SLANTED));
    let side = if strand.unit(channel::SIDE) < 0.5 { DVec3::Z } else { DVec3::NEG_Z };
    let away = away.try_normalize().unwrap_or(side);
    let back = DVec3::new(-line.x, 0.0, -line.y).try_normalize().unwrap_or(away);
    back.lerp(away, 0.3 + 0.7 * apart)
}

/// What the style asks of the strand at `root`.
pub(crate) fn strand_style(
    head: &Head,
    style: &Style,
    &Root { position, normal, above_hairline, .. }: &Root,
    seed: u64,
) -> StrandStyle {
    let (root, normal) = (position.as_dvec3(), normal.as_dvec3());
    let strand = Chance::at_point(seed, position);
    let Lock { middle: clump_middle, chance: clump } = Locks { size: style.clumps.size, seed }.of(position);
    let shares = shares(&head.ellipsoid, style, position, strand);
    let region = region_of(shares);

    let (comb, off_face) = if region == Region::Fringe {
        (DVec3::new(f64::from(style.fringe.forward), 0.0, f64::from(style.fringe.aside)), DVec3::ZERO)
    } else {
        let away = away_from_parting(style, root, strand, clump);
        let front = (position.x - head.ellipsoid.center.x) / head.ellipsoid.half_axes.x;
        let off_face = f64::from(style.comb.off_face * smooth((front - 0.3) / 0.5));
        (away * f64::from(style.comb.away) + style.comb.sweep.as_dvec3(), DVec3::NEG_X * off_face)
    };
    let variation = &style.variation;
    let stray = if strand.unit(channel::STRAY) < f64::from(variation.strays) { 4.0 } else { 1.0 };
    // How short baby hair is here: longer with every millimetre above the line, and each by its own chance.
    let at_line = 1.0 - f64::from(smooth(above_hairline / BABY_HAIR));
    let short = f64::from(variation.baby_hair) * at_line * strand.unit(channel::BABY);
    let own = f64::from(variation.direction_degrees).to_radians() * stray * (1.0 + 3.0 * short);
    let shared = f64::from(style.clumps.direction_degrees).to_radians();

    // Along the scalp: as combed on top, where that says little (on the sides) as the hair falls. What keeps it off the face
    // says as much on a steep forehead.
    let falls = 1.0 + comb.length() * (1.0 - normal.y).clamp(0.0, 1.0).powi(2);
    let comb = comb + off_face;
    let wanted = comb + DVec3::NEG_Y * falls;
    let along = wanted - normal * wanted.dot(normal);
    let along = along.try_normalize().unwrap_or_else(|| normal.any_orthonormal_vector());
    let lift = mean(style.lift_degrees.each(), shares).to_radians();
    let clamp = along * lift.cos() + normal * lift.sin();
    let clamp = (clamp + strand.vector(channel::ROOT) * own + clump.vector(channel::ROOT) * shared).normalize();
    // Chance must not lead a root into the skin.
    let clamp = (clamp + normal * (0.05 - clamp.dot(normal)).max(0.0)).normalize();

    let length = mean(style.length.each(), shares)
        * (1.0 - f64::from(variation.length) * strand.unit(channel::LENGTH))
        * (1.0 - short);
    let level = |v: DVec3| DVec3::new(v.x, 0.0, v.z);
    let gather = level((clump_middle - position).as_dvec3()) * (f64::from(style.clumps.gather) / length);
    let tilt = level(strand.vector(channel::TILT) * (0.5 * own) + clump.vector(channel::TILT) * shared) + gather;

    let wave_slope = std::f64::consts::TAU * f64::from(style.clumps.wave) / f64::from(style.clumps.wave_length);
    let across = clump.vector(channel::PHASE).try_normalize().unwrap_or(DVec3::Z);

    let out = (clump_middle - head.ellipsoid.center).as_dvec3().try_normalize().unwrap_or(normal);
    let of_curls = Clump { middle: clump_middle, chance: clump, outward: out };
    let curl = StrandCurl::new(&style.curl, length, root, clamp, strand, &of_curls);
    let tie = style.ponytail.filter(|_| region != Region::Fringe).map(|tail| Tie::new(&tail, root, strand));
    // A lock lies in one layer.
    let depth = curl.map_or(strand, |_| clump).unit(channel::DEPTH);
    StrandStyle {
        root,
        clamp,
        bend: mean(style.stiffness.each(), shares)
            * (1.0 + f64::from(variation.stiffness) * strand.bell(channel::STIFFNESS)),
        length,
        weight: DVec3::NEG_Y + tilt,
        comb,
        comb_decay: f64::from(style.comb.decay),
        depth,
        wave: across * wave_slope * (0.8 + 0.4 * strand.unit(channel::PHASE)),
        wave_phase: std::f64::consts::TAU * clump.unit(channel::PHASE) + 0.5 * strand.bell(channel::PHASE),
        region,
        cut_offset: f64::from(variation.cut) * strand.bell(channel::CUT),
        curl,
        tie,
    }
}
