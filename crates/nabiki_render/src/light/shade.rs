//! The light that each node of the hair sends to the eye.
//!
//! A lamp's light that crosses `n` fibres on its way arrives unscattered with e^-n, as in the dual scattering of Zinke et al. (2008).
//! What fibres scatter goes on in two streams, away from the lamp and back to it, through the hair before a node and the hair behind it: a
//! slab as deep as both. It turns out of its inclination to the hair a little with each fibre.

#![expect(clippy::needless_range_loop, reason = "lanes side by side read as vector code")]

use std::f32::consts::PI;

use rayon::prelude::*;

use super::approx::{arccos, exp_of_negative, ln};
use super::fibre::{COLUMNS, Fibre, GRADES, Longitudinal, ROWS};
use super::headlight::SolidShadows;
use super::kajiya::KajiyaKay;
use super::lamps::Lamp;
use super::shadow::Crossings;
use super::sky::{
    AT_ONCE, BEHIND_ABOVE, BEHIND_BARE, BEHIND_BELOW, BEHIND_GLOW, FRONT_ABOVE, FRONT_BARE, FRONT_BELOW, FRONT_GLOW,
    Places, SkyMap, TOWARD_LAMPS,
};
use super::streams::{Medium, slab};
use crate::camera::View;
use crate::colour::of_strand;
use crate::curve::CurveNode;
use crate::raster::Node;
use crate::settings::Sky;

/// Nodes that are shaded together.
const LANES: usize = 16;
/// Of the light that a fibre lets through, the share that goes on by other ways than straight from the lamp. Fitted.
pub const STRAYS: f32 = 0.25;
/// Share of the sky's light that goes on as it came at each scattering in hair, and of what hair behind sends back: the rest strays to where less of
/// the sky is seen. Fitted.
pub const SKY_KEPT: f32 = 0.7;
/// Depth of hair without end (fibres).
const ENDLESS: f32 = 100.0;
/// Light of this variance along the hair (rad^2) goes to all inclinations, near enough.
const EVEN: f32 = 1.0;
/// Largest deviation of a strand's tilt (rad), for a variation of 1.
pub const TILT_SPREAD: f32 = 0.14;

/// How hair reflects.
pub enum Model {
    Fibre(Box<Fibre>),
    KajiyaKay(KajiyaKay),
}

impl Model {
    /// By how much less of its light (red, green, blue) arrives for each hair before a place, those of middling pigment.
    pub fn decay(&self) -> [f32; 3] {
        match self {
            Self::Fibre(fibre) => fibre.grades[GRADES / 2].medium.decay,
            Self::KajiyaKay(_) => [1.0; 3],
        }
    }
}

/// Everything that light meets on its way to a node.
pub struct HairLight<'a> {
    pub model: &'a Model,
    pub variation: f32,
    pub lamps: &'a [Lamp],
    /// For each lamp; empty without shadows.
    pub crossings: &'a [&'a Crossings],
    pub solid_shadows: &'a [SolidShadows],
    pub sky: &'a Sky,
    pub sky_map: Option<&'a SkyMap>,
    /// Colour of the skin that sends light back (linear).
    pub skin: [f32; 3],
    pub view: &'a View,
}

/// One batch, compiled for each width of vectors that machines have; one is chosen at run time.
struct ShadeFibre<'a> {
    light: &'a HairLight<'a>,
    fibre: &'a Fibre,
    batch: &'a [usize; LANES],
    curve: &'a [CurveNode],
}

impl pulp::WithSimd for ShadeFibre<'_> {
    type Output = [[f32; 3]; LANES];

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) -> Self::Output {
        self.light.fibre(self.fibre, self.batch, self.curve)
    }
}

impl HairLight<'_> {
    /// Fills in the light of every node for which it is `asked`.
    pub fn shade(&self, curve: &[CurveNode], asked: &[bool], nodes: &mut [Node]) {
        const CHUNK: usize = 64 * LANES;
        nodes.par_chunks_mut(CHUNK).enumerate().for_each(|(chunk, nodes)| {
            let first = chunk * CHUNK;
            let mut batch = [0; LANES];
            let mut filled = 0;
            for i in first..first + nodes.len() {
                if asked[i] {
                    batch[filled] = i;
                    filled += 1;
                }
                if filled == LANES || (i + 1 == first + nodes.len() && filled > 0) {
                    let last = batch[filled - 1];
                    batch[filled..].fill(last);
                    let light = match self.model {
                        Model::Fibre(fibre) => {
                            pulp::Arch::new().dispatch(ShadeFibre { light: self, fibre, batch: &batch, curve })
                        }
                        Model::KajiyaKay(model) => batch.map(|i| self.kajiya(model, i, &curve[i])),
                    };
                    for (lane, &i) in batch.iter().enumerate() {
                        nodes[i - first].light = light[lane];
                    }
                    filled = 0;
                }
            }
        });
    }

    /// What arrives of the sky: the first numbers of [`SkyMap::at`].
    #[inline(always)]
    fn sky_at<const N: usize>(&self, places: Option<&Places<N>>) -> [[f32; N]; AT_ONCE] {
        let open = [[0.5; N], [0.5; N], [0.5; N], [0.5; N], [0.0; N], [0.0; N], [1.0; N], [1.0; N]];
        // A closure here, as a few below, would be compiled by itself, without vectors.
        match (self.sky_map, places) {
            (Some(map), Some(places)) => map.at(places, 0),
            _ => open,
        }
    }

    fn kajiya(&self, model: &KajiyaKay, i: usize, node: &CurveNode) -> [f32; 3] {
        let eye = self.view.toward_eye(node.position);
        let place = node.position.to_array().map(|c| [c]);
        let [[front_above], [front_below], [behind_above], [behind_below], ..] =
            self.sky_at(self.sky_map.map(|map| map.places(&place)).as_ref());
        let (above, below) = (0.5 * (front_above + behind_above), 0.5 * (front_below + behind_below));
        let mut light: [f32; 3] = std::array::from_fn(|c| {
            self.sky.strength * model.colour[c] * (self.sky.above[c] * above + self.sky.below[c] * below)
        });
        for (l, lamp) in self.lamps.iter().enumerate() {
            let hair = self.crossings.get(l).map_or(1.0, |c| (-c.at(i)).exp());
            let head = self.solid_shadows.get(l).map_or(1.0, |s| s.visible(&place)[0]);
            let part = model.reflected(node.tangent, lamp.toward, eye);
            light = std::array::from_fn(|c| light[c] + part[c] * lamp.strength[c] * hair * head);
        }
        light
    }

    #[inline(always)]
    fn fibre(&self, fibre: &Fibre, batch: &[usize; LANES], curve: &[CurveNode]) -> [[f32; 3]; LANES] {
        let mut place = [[0.0_f32; LANES]; 3];
        let mut tangent = [[0.0_f32; LANES]; 3];
        let mut eye = [[0.0_f32; LANES]; 3];
        let mut tilt = [0.0_f32; LANES];
        let mut tables = [&fibre.grades[0]; LANES];
        for lane in 0..LANES {
            let node = &curve[batch[lane]];
            let toward = self.view.toward_eye(node.position);
            for c in 0..3 {
                place[c][lane] = node.position[c];
                tangent[c][lane] = node.tangent[c];
                eye[c][lane] = toward[c];
            }
            let deviation = of_strand(node.strand, 1) + of_strand(node.strand, 2) - 1.0;
            tilt[lane] = fibre.tilt + TILT_SPREAD * self.variation * deviation;
            let grade = (of_strand(node.strand, 3) + of_strand(node.strand, 4)) * 0.5 * GRADES as f32;
            tables[lane] = &fibre.grades[(grade as usize).min(GRADES - 1)];
        }

        let mut sin_eye = [0.0_f32; LANES];
        let mut cos_eye = [0.0_f32; LANES];
        let mut turned = [[(0.0_f32, 0.0_f32); LANES]; 3];
        for lane in 0..LANES {
            let s = tangent[0][lane] * eye[0][lane] + tangent[1][lane] * eye[1][lane] + tangent[2][lane] * eye[2][lane];
            let s = s.clamp(-0.9995, 0.9995);
            let c = (1.0 - s * s).sqrt();
            sin_eye[lane] = s;
            cos_eye[lane] = c;
            for (p, turn) in Fibre::turns(tilt[lane]).into_iter().enumerate() {
                // Sine and cosine of a small turn, by the first terms of their series.
                let (st, ct) = (turn - turn * turn * turn * (1.0 / 6.0), 1.0 - 0.5 * turn * turn);
                turned[p][lane] = (s * ct + c * st, (c * ct - s * st).abs());
            }
        }

        let (mut rows, mut medium) = (Rows::default(), MediumRows::default());
        let mut places = None;
        if let Some(map) = self.sky_map {
            places = Some(map.places_seen(&place, &eye));
        }
        let sky = self.sky_at(places.as_ref());
        for lane in 0..LANES {
            let row = tables[lane].row(sin_eye[lane].abs() * (ROWS - 1) as f32);
            for c in 0..3 {
                rows.forward[c][lane] = row.forward[c];
                rows.back[c][lane] = row.back[c];
                rows.rest[c][lane] = row.rest[c];
            }
            medium.set(lane, &tables[lane].medium);
        }
        let mut light = [[0.0_f32; LANES]; 3];
        for c in 0..3 {
            for lane in 0..LANES {
                let (a, b) = (rows.forward[c][lane], rows.back[c][lane]);
                let lost = (1.0 - SKY_KEPT * medium.forward[c][lane]).max(0.0);
                // What hair in the way scatters forward arrives as well: on both sides as much more than what is open as the
                // mean depth of the hair there says. What skin takes is gone.
                let share = |open: f32, bare: f32| (open / bare.max(1e-6)).clamp(1e-6, 1.0);
                let arrives = |share: f32| exp_of_negative(ln(share) * lost).max(share);
                let colour = |above: f32, below: f32| self.sky.above[c] * above + self.sky.below[c] * below;
                let (above, below) = (sky[FRONT_ABOVE][lane], sky[FRONT_BELOW][lane]);
                let through = share(above + below, sky[FRONT_BARE][lane]);
                let front = self.sky.strength * colour(above, below) * (arrives(through) / through)
                    + self.skin[c] * sky[FRONT_GLOW][lane];
                let (above, below) = (sky[BEHIND_ABOVE][lane], sky[BEHIND_BELOW][lane]);
                let through = share(above + below, sky[BEHIND_BARE][lane]);
                let arriving = arrives(through);
                let behind = self.sky.strength * colour(above, below) * (arriving / through)
                    + self.skin[c] * sky[BEHIND_GLOW][lane];
                // Where it is open behind there is no hair that sends back; before skin there is.
                let of_those = (medium.whole[c][lane] - medium.back[c][lane]).max(0.0);
                let again = SKY_KEPT * of_those * (1.0 - arriving * sky[BEHIND_BARE][lane]).max(0.0);
                // Fibres keep the inclination, so the light that they send back to the eye has come from the eye's side of hair seen
                // across, and from behind hair that points at the eye: their cosine is 1 - 2 sin^2.
                let from_behind = sin_eye[lane] * sin_eye[lane];
                let mirrored = front + from_behind * (behind - front);
                light[c][lane] = mirrored * (b + again) + behind * a;
            }
        }

        // Light turns along the hair in each fibre that scatters it: in those before it arrives, the last of which is another than shows it, and
        // in those behind on its way there and back, where one sends it back as TRT does. What goes on forward is half R and half TT,
        // near enough. By green for all.
        let [of_surface, of_passing, of_return] = fibre.variances;
        let of_forward = 0.5 * (of_surface + of_passing);
        let mut home = [0.0_f32; LANES];
        for lane in 0..LANES {
            home[lane] = of_return + of_forward * (medium.forward[1][lane] / medium.decay[1][lane] - 1.0);
        }

        let mut known = sky;
        for (l, lamp) in self.lamps.iter().enumerate() {
            let toward = lamp.toward.to_array();
            let mut column = [0.0_f32; LANES];
            let mut cos_azimuth = [0.0_f32; LANES];
            let mut along = [[0.0_f32; LANES]; 3];
            let mut inclined = [(0.0_f32, 0.0_f32); LANES];
            for lane in 0..LANES {
                let t = [tangent[0][lane], tangent[1][lane], tangent[2][lane]];
                let s = t[0] * toward[0] + t[1] * toward[1] + t[2] * toward[2];
                let s = s.clamp(-0.9995, 0.9995);
                let c = (1.0 - s * s).sqrt();
                let cos = toward[0] * eye[0][lane] + toward[1] * eye[1][lane] + toward[2] * eye[2][lane];
                let azimuth = ((cos - s * sin_eye[lane]) / (c * cos_eye[lane])).clamp(-1.0, 1.0);
                cos_azimuth[lane] = azimuth;
                column[lane] = arccos(azimuth) * (COLUMNS as f32 / PI);
                for p in 0..3 {
                    let (st, ct) = turned[p][lane];
                    along[p][lane] = fibre.spread[p].at(s, c, st, ct);
                }
                inclined[lane] = (s, c);
            }
            let visible = match self.solid_shadows.get(l) {
                Some(shadows) => shadows.visible(&place),
                None => [1.0; LANES],
            };
            let mut crossed = [0.0_f32; LANES];
            let mut lobes = [[0.0_f32; LANES]; 8];
            for lane in 0..LANES {
                let i = batch[lane];
                crossed[lane] = match self.crossings.get(l) {
                    Some(crossings) => crossings.at(i),
                    None => 0.0,
                };
                let mixed = tables[lane].lobes(sin_eye[lane].abs() * (ROWS - 1) as f32, column[lane]);
                for i in 0..8 {
                    lobes[i][lane] = mixed[i];
                }
            }
            // Where it is not known what is about, as much as straight on, and hair without end behind.
            let mut aside = crossed;
            let mut behind = [ENDLESS; LANES];
            if let (Some(map), Some(places)) = (self.sky_map, &places) {
                let number = TOWARD_LAMPS + 2 * l;
                if number.is_multiple_of(AT_ONCE) {
                    known = map.at(places, number / AT_ONCE);
                }
                for lane in 0..LANES {
                    aside[lane] = -ln(known[number % AT_ONCE][lane].clamp(1e-6, 1.0));
                    behind[lane] = -ln(known[number % AT_ONCE + 1][lane].clamp(1e-6, 1.0));
                }
            }
            let mut straight = [0.0_f32; LANES];
            let mut many = [[0.0_f32; LANES]; 2];
            for lane in 0..LANES {
                straight[lane] = exp_of_negative(-crossed[lane]);
                let (s, c) = inclined[lane];
                let away = 2.0 * of_surface + of_forward * crossed[lane] * medium.forward[1][lane];
                for (many, variance) in many.iter_mut().zip([away, away + home[lane]]) {
                    many[lane] = Longitudinal::of(variance.min(EVEN)).at(s, c, sin_eye[lane], cos_eye[lane]);
                }
            }
            for c in 0..3 {
                for lane in 0..LANES {
                    let cos = cos_azimuth[lane];
                    let (same_side, far_side) = (0.5 * (1.0 + cos) / PI, 0.5 * (1.0 - cos) / PI);
                    let m = [along[0][lane], along[1][lane], along[2][lane]];
                    let (a, b, rest) = (rows.forward[c][lane], rows.back[c][lane], rows.rest[c][lane]);
                    let once = m[0] * lobes[0][lane] + m[1] * lobes[1 + c][lane] + m[2] * (lobes[4 + c][lane] + rest);
                    let lost = medium.decay[c][lane];
                    let strays = STRAYS * medium.forward[c][lane];
                    let before = (1.0 - strays) * exp_of_negative(-crossed[lane] * lost)
                        + strays * exp_of_negative(-aside[lane] * lost);
                    let [away, back] = slab(medium.whole[c][lane], before, exp_of_negative(-behind[lane] * lost));
                    let away = many[0][lane] * (away - straight[lane]).max(0.0);
                    let back = many[1][lane] * back;
                    let part = straight[lane] * once
                        + away * (b * same_side + a * far_side)
                        + back * (a * same_side + b * far_side);
                    light[c][lane] += PI * visible[lane] * lamp.strength[c] * part;
                }
            }
        }
        std::array::from_fn(|lane| [light[0][lane], light[1][lane], light[2][lane]])
    }
}

/// Rows of the lanes' tables.
#[derive(Default)]
struct Rows {
    forward: [[f32; LANES]; 3],
    back: [[f32; LANES]; 3],
    rest: [[f32; LANES]; 3],
}

/// The lanes' mediums.
#[derive(Default)]
struct MediumRows {
    forward: [[f32; LANES]; 3],
    back: [[f32; LANES]; 3],
    whole: [[f32; LANES]; 3],
    decay: [[f32; LANES]; 3],
}

impl MediumRows {
    #[inline(always)]
    fn set(&mut self, lane: usize, medium: &Medium) {
        for c in 0..3 {
            self.forward[c][lane] = medium.forward[c];
            self.back[c][lane] = medium.back[c];
            self.whole[c][lane] = medium.whole[c];
            self.decay[c][lane] = medium.decay[c];
        }
    }
}

#[cfg(test)]
mod tests;
