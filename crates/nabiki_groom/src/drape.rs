//! A strand on its head: free pieces hang as cantilevers, the others lie on the skin or on the hair below.
//!
//! The walk goes from the root. From the last node that touches, what is left of the strand is a free cantilever; as
//! long as its next node stays clear of the head, it is taken. A node that would fall inside is turned back about the
//! node before it until it lies where hair lies (method section 4), and the rest hangs from there.

use std::ops::Range;

use nabiki::Head;
use nabiki::glam::DVec3;

use crate::cantilever::{Beam, Hold, Workspace, segments};
use crate::curl::StrandCurl;
use crate::ears::EarHills;
use crate::strand_style::{StrandStyle, Tie};
use crate::style::{LeverArms, Volume};

/// A free piece is settled to this (rad): a hundredth of a millimetre on 18 cm.
const SETTLED: f64 = 5e-5;

/// Times that the bends of a lying strand are rounded.
const ROUNDINGS: usize = 5;

/// A turn (rad) beyond which a segment had rather lie closer than the layers want.
const SHARP: f64 = 0.9;

/// How much of its direction hair keeps from segment to segment on its way to a band, beside that toward the band; and
/// the distance from the band within which it keeps none (cm).
const EASE: f64 = 0.8;
const NEAR_BAND: f64 = 3.0;

/// The turn into a band is spread along the hair as a bell of this deviation (cm): no hair bends in a point.
const BAND_BEND: f64 = 0.5;

/// So far beyond its place in the band (cm, by the change of direction there) a strand turns, to pass it when the turn is spread:
/// half of a bell's mean distance from its middle.
const CORNER: f64 = 0.398_942_28 * BAND_BEND;

/// Steepest rise of lying hair toward the layer that it belongs to (slope).
const RISE: f64 = 0.4;

/// A root deeper than this under the hill over an ear (cm) is of the hair that lies about the ear.
const ON_HILL: f64 = 0.8;

/// What a segment keeps (cm): from the skin at its end and in its middle, from the hills over the ears at its end.
#[derive(Clone, Copy, Debug)]
struct Keep {
    end: f64,
    halfway: f64,
    over_ears: Option<f64>,
}

/// Nodes of one strand, and what is needed to find them; kept from strand to strand.
#[derive(Debug, Default)]
pub(crate) struct Draping {
    /// The nodes, root first (head space, cm).
    pub nodes: Vec<DVec3>,
    directions: Vec<DVec3>,
    loads: Vec<DVec3>,
    free: Vec<DVec3>,
    beam: Workspace,
}

/// What strands have in common.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ground<'a> {
    pub head: &'a Head,
    /// What hair from above passes over, if the style wants it to.
    pub ears: Option<&'a EarHills>,
    pub volume: Volume,
    pub lever_arms: LeverArms,
    pub wave_length: f64,
    /// Longest segment (cm).
    pub segment: f64,
}

impl Ground<'_> {
    /// Distance to the skin that hair keeps at arc length `s`: none at the root, then the more the farther up the
    /// strand comes from, so that upper hair lies over lower hair.
    fn clearance(&self, styled: &StrandStyle, s: f64) -> f64 {
        let layers = f64::from(self.volume.thickness) * styled.depth;
        let gap = f64::from(self.volume.gap);
        gap + layers * (1.0 - (-s / f64::from(self.volume.reach)).exp()) + styled.curl_reach(s)
    }

    /// What the segment from `p` that ends at `s` keeps. It rises toward that by no more than `RISE`.
    fn keep(&self, styled: &StrandStyle, over_ears: Option<f64>, p: DVec3, s: f64, d: f64) -> Keep {
        let here = self.distance(p).max(0.0);
        let end = self.clearance(styled, s).min((here + RISE * d).max(f64::from(self.volume.gap)));
        // The first segment starts on the skin.
        let halfway = if s < 1.5 * d { 0.0 } else { 0.7 * here.min(end) };
        Keep { end, halfway, over_ears: over_ears.map(|least| least + styled.curl_reach(s)) }
    }

    /// How far above the hills over the ears a strand stays: none, if it is rooted under one.
    fn over_ears(&self, styled: &StrandStyle) -> Option<f64> {
        let root = self.ears?.above(styled.root);
        (root > -ON_HILL).then_some(root.min(0.0))
    }

    /// How much farther from the skin than it must be a segment `reach` from `p` stays, negative if it fails to.
    fn spare(&self, p: DVec3, reach: DVec3, keep: &Keep) -> f64 {
        let end = p + reach;
        let mut spare = (self.distance(end) - keep.end).min(self.distance(p + reach * 0.5) - keep.halfway);
        if let (Some(ears), Some(least)) = (self.ears, keep.over_ears) {
            spare = spare.min(ears.above(end) - least);
        }
        spare
    }

    fn distance(&self, p: DVec3) -> f64 {
        f64::from(self.head.distance(p.as_vec3()))
    }

    /// Turns a segment from `p` along `t` toward or away from the skin until it just keeps what it must. Where that
    /// would take a sharp turn, as in the groove behind an ear, it keeps only the gap, and at worst turns aside.
    fn turned_onto(&self, p: DVec3, t: DVec3, d: f64, keep: &Keep) -> DVec3 {
        let outward = self.head.outward((p + t * d).as_vec3()).as_dvec3();
        let side = (outward - t * outward.dot(t)).try_normalize().unwrap_or_else(|| t.any_orthonormal_vector());
        let gap = f64::from(self.volume.gap);
        let bare = Keep { end: keep.end.min(gap), halfway: keep.halfway.min(0.7 * gap), over_ears: None };
        let aside = t.cross(side);
        let ways = [(side, keep, SHARP), (side, &bare, SHARP), (aside, &bare, SHARP), (-aside, &bare, SHARP)];
        let mut found = ways.iter().find_map(|&(side, keep, most)| self.turned(p, t, d, side, keep, most));
        if found.is_none() {
            found = self.turned(p, t, d, side, &bare, std::f64::consts::PI);
        }
        found.unwrap_or(outward)
    }

    /// The least turn from `t` toward `side`, if less than `most` (rad), after which the segment keeps what it must; or,
    /// if it does so before, the turn the other way that brings it down to that.
    fn turned(&self, p: DVec3, t: DVec3, d: f64, side: DVec3, keep: &Keep, most: f64) -> Option<DVec3> {
        let turned = |angle: f64| t * angle.cos() + side * angle.sin();
        let spare = |angle: f64| self.spare(p, turned(angle) * d, keep);
        // Bracket the touch between an angle that is clear and one, below it, that is not.
        let first = spare(0.0);
        let (mut clear, mut inside) = (None, None);
        *(if first >= 0.0 { &mut clear } else { &mut inside }) = Some((0.0, first));
        let away = if first >= 0.0 { -1.0 } else { 1.0 };
        let mut step = (first.abs() / d).clamp(0.02, 0.5);
        let mut angle = 0.0;
        while clear.is_none() || inside.is_none() {
            angle += away * step;
            if angle.abs() > most {
                return clear.map(|_| t);
            }
            let now = spare(angle);
            *(if now >= 0.0 { &mut clear } else { &mut inside }) = Some((angle, now));
            step = (1.5 * step).min(0.3);
        }
        let (mut clear, mut inside) = (clear?, inside?);
        for _ in 0..24 {
            if clear.1 < 1e-3 {
                break;
            }
            let share = (clear.1 / (clear.1 - inside.1)).clamp(0.1, 0.9);
            let angle = clear.0 + share * (inside.0 - clear.0);
            let now = spare(angle);
            *(if now >= 0.0 { &mut clear } else { &mut inside }) = (angle, now);
        }
        Some(turned(clear.0))
    }

    /// Lays out a strand of `length` (cm) in equal segments: its nodes end up in `draping.nodes`.
    pub(crate) fn drape(&self, styled: &StrandStyle, length: f64, draping: &mut Draping) {
        let Draping { nodes, directions, loads, free, beam: workspace } = draping;
        let k = segments(length, self.segment);
        let d = length / k as f64;
        loads.clear();
        loads.extend((0..k).map(|j| styled.load((j as f64 + 0.5) * d)));
        nodes.clear();
        nodes.push(styled.root);
        directions.clear();

        let over_ears = self.over_ears(styled);
        let mut beam = Beam { stiffness: styled.bend.powi(3), segment: d, clamp: styled.clamp, hold: Hold::Clamped };
        if let Some(tie) = &styled.tie {
            self.lie_to(tie, styled, d, k, directions, nodes);
            beam.clamp = tie.behind;
        }
        let tied = directions.len();
        // The free piece starts at this segment.
        let mut from = tied;
        self.hang(&beam, &loads[from..], false, free, workspace);
        let (mut p, mut lies, mut touched) = (nodes[tied], false, false);
        for i in tied..k {
            let s = (i + 1) as f64 * d;
            let wave = wave_at(styled, self.wave_length, s - 0.5 * d);
            let keep = self.keep(styled, over_ears, p, s, d);
            let hanging = (free[i - from] + wave).normalize();
            let taken = if self.spare(p, hanging * d, &keep) >= 0.0 {
                lies = false;
                hanging
            } else {
                // Lying hair carries about as much as hangs over one length of its stiffness: kappa = |w_perp| / bend.
                let along = if lies { beam.clamp + loads[i] * (d / styled.bend) } else { free[i - from] };
                let along = (along.try_normalize().unwrap_or(beam.clamp) + wave).normalize();
                let along = self.turned_onto(p, along, d, &keep);
                lies = true;
                touched = true;
                beam.clamp = (along - wave).normalize();
                beam.hold = Hold::Continued;
                from = i + 1;
                if free.is_empty() {
                    along
                } else {
                    let old = i + 1 - (k - free.len());
                    free.drain(..old);
                    self.hang(&beam, &loads[from..], true, free, workspace);
                    along
                }
            };
            p += taken * d;
            nodes.push(p);
            directions.push(taken);
        }
        if (1..k).contains(&tied) {
            bend_at(tied, d, directions);
            self.lay(styled, None, d, directions, nodes);
        } else if touched && tied == 0 {
            for _ in 0..ROUNDINGS {
                round(directions, 1..k);
                self.lay(styled, over_ears, d, directions, nodes);
            }
        }
    }

    /// Lays a strand along the head to where it is tied, or as far as its `k` segments reach.
    fn lie_to(
        &self,
        tie: &Tie,
        styled: &StrandStyle,
        d: f64,
        k: usize,
        directions: &mut Vec<DVec3>,
        nodes: &mut Vec<DVec3>,
    ) {
        let (mut p, mut t) = (styled.root, styled.clamp);
        while directions.len() < k {
            // What would go away from the band turns at its root; near the band it aims at it.
            let near = p.distance(tie.at) < NEAR_BAND;
            let ease = if near { 0.0 } else { EASE };
            let at = if near { tie.at + (t - tie.behind) * CORNER } else { tie.at };
            if p.distance(at) < 0.5 * d {
                break;
            }
            let wanted = (at - p).normalize();
            t = (wanted + t * ease).try_normalize().unwrap_or(wanted);
            let keep = self.keep(styled, None, p, (directions.len() + 1) as f64 * d, d);
            if self.spare(p, t * d, &keep) < 0.0 {
                t = self.turned_onto(p, t, d, &keep);
            }
            p += t * d;
            directions.push(t);
            nodes.push(p);
        }
    }

    /// Winds a strand of `length` (cm) about the line that it has been draped in; what would lie in the skin is turned out
    /// of it.
    pub(crate) fn wind(&self, styled: &StrandStyle, curl: &StrandCurl, length: f64, draping: &mut Draping) {
        let Draping { nodes, directions, .. } = draping;
        let between = nodes[0].distance(nodes[1]);
        let d = length / segments(length, self.segment) as f64;
        let gap = f64::from(self.volume.gap);
        nodes.truncate(1);
        let mut p = styled.root;
        for (i, along) in curl.wound(length, self.segment, directions, between).enumerate() {
            let halfway = if i == 0 { 0.0 } else { 0.7 * self.distance(p).clamp(0.0, gap) };
            let keep = Keep { end: gap, halfway, over_ears: None };
            let clear = self.spare(p, along * d, &keep) >= 0.0;
            p += d * if clear { along } else { self.turned_onto(p, along, d, &keep) };
            nodes.push(p);
        }
    }

    /// Lays a strand anew along the directions of its segments; what would not keep its clearance is turned until it does.
    fn lay(&self, styled: &StrandStyle, over_ears: Option<f64>, d: f64, directions: &mut [DVec3], nodes: &mut [DVec3]) {
        for (i, t) in directions.iter_mut().enumerate().skip(1) {
            let (p, s) = (nodes[i], (i + 1) as f64 * d);
            let keep = self.keep(styled, over_ears, p, s, d);
            if self.spare(p, *t * d, &keep) < 0.0 {
                *t = self.turned_onto(p, *t, d, &keep);
            }
            nodes[i + 1] = p + *t * d;
        }
    }

    fn hang(&self, beam: &Beam, loads: &[DVec3], warm: bool, free: &mut Vec<DVec3>, workspace: &mut Workspace) {
        match self.lever_arms {
            LeverArms::Straight => beam.straight_arms(loads, free),
            LeverArms::Deformed => {
                beam.settle(loads, SETTLED, warm, free, workspace);
            }
        }
    }
}

/// Rounds the bends of these segments once, as their own stiffness and the hair around them do: over an ear hair lifts off
/// above and comes down below.
fn round(directions: &mut [DVec3], segments: Range<usize>) {
    let mut before = directions[segments.start - 1];
    for i in segments {
        let t = directions[i];
        let after = directions.get(i + 1).copied().unwrap_or(t);
        directions[i] = (before + 2.0 * t + after).try_normalize().unwrap_or(t);
        before = t;
    }
}

/// Spreads the turn at the start of segment `tied`, of segments of length `d` (cm), along the hair before and behind it.
fn bend_at(tied: usize, d: f64, directions: &mut [DVec3]) {
    // A rounding adds d^2 / 2 to the variance.
    let roundings = (2.0 * (BAND_BEND / d).powi(2)).ceil() as usize;
    let reach = (4.0 * BAND_BEND / d).ceil() as usize;
    let bent = tied.saturating_sub(reach).max(1)..(tied + reach).min(directions.len());
    for _ in 0..roundings {
        round(directions, bent.clone());
    }
}

fn wave_at(styled: &StrandStyle, wave_length: f64, s: f64) -> DVec3 {
    let turns = std::f64::consts::TAU * s / wave_length;
    styled.wave * ((turns + styled.wave_phase).cos() * (s / wave_length).min(1.0))
}
