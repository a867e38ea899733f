//! The light that each node of the hair sends to the eye.
//!
//! A lamp's light that crosses `n` fibres on its way arrives unscattered with e^-n; what is scattered forward by those fibres
//! arrives with e^(-n (1 - a)) - e^-n, where a is the part that one fibre passes on: the Poisson mean of a^k over k >= 1 crossings. It strays
//! from the lamp's direction, so half of it is reckoned with what is about that direction in place of what is straight on. This
//! follows the dual scattering of Zinke et al. (2008), with one wide shape for all scattered light. What the hair behind sends back
//! is summed over all orders of reversals at once.

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
    AT_ONCE, BEHIND_ABOVE, BEHIND_BELOW, BEHIND_GLOW, FRONT_ABOVE, FRONT_BELOW, FRONT_GLOW, Places, SkyMap,
    TOWARD_LAMPS,
};
use crate::camera::View;
use crate::colour::of_strand;
use crate::curve::CurveNode;
use crate::raster::Node;
use crate::settings::Sky;

/// Nodes that are shaded together.
const LANES: usize = 16;
/// Share of a lamp's light scattered forward that stays within hair: dual scattering's density factor.
pub const DENSITY: f32 = 0.7;
/// The same of the sky's light, and of what of it hair behind sends back: much of what lies behind sees less of the sky.
pub const SKY_DENSITY: f32 = 0.5;
/// Variance along the hair of light scattered more than once (rad^2).
pub const WIDE: f32 = 0.22;
/// Largest deviation of a strand's tilt (rad), for a variation of 1.
pub const TILT_SPREAD: f32 = 0.14;

/// How hair reflects.
pub enum Model {
    Fibre(Box<Fibre>),
    KajiyaKay(KajiyaKay),
}

impl Model {
    /// The part of its light (red, green, blue) that one hair, of middling pigment and lean to the light, passes on forward.
    pub fn passed_on(&self) -> [f32; 3] {
        match self {
            Self::Fibre(fibre) => fibre.grades[GRADES / 2].row(0.5 * (ROWS - 1) as f32).forward,
            Self::KajiyaKay(_) => [0.0; 3],
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
        let open = [[0.5; N], [0.5; N], [0.5; N], [0.5; N], [0.0; N], [0.0; N], [0.0; N], [0.0; N]];
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
        let wide = Longitudinal::new(WIDE);
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

        let mut rows = Rows::default();
        let mut places = None;
        if let Some(map) = self.sky_map {
            places = Some(map.places(&place));
        }
        let sky = self.sky_at(places.as_ref());
        for lane in 0..LANES {
            let row = tables[lane].row(sin_eye[lane].abs() * (ROWS - 1) as f32);
            for c in 0..3 {
                rows.forward[c][lane] = row.forward[c];
                rows.back[c][lane] = row.back[c];
                rows.rest[c][lane] = row.rest[c];
            }
        }
        let mut light = [[0.0_f32; LANES]; 3];
        for c in 0..3 {
            for lane in 0..LANES {
                let (a, b) = (rows.forward[c][lane], rows.back[c][lane]);
                let again = sent_back(a, b) - b;
                rows.again[c][lane] = again;
                // What hair in the way scatters forward arrives as well: on both sides as much more than what is open as the
                // mean depth of the hair there says.
                let more = |open: f32| {
                    let open = open.clamp(1e-6, 1.0);
                    let scattered = exp_of_negative(ln(open) * (1.0 - a).max(0.0));
                    1.0 + SKY_DENSITY * (scattered / open - 1.0).max(0.0)
                };
                let colour = |above: f32, below: f32| self.sky.above[c] * above + self.sky.below[c] * below;
                let (above, below) = (sky[FRONT_ABOVE][lane], sky[FRONT_BELOW][lane]);
                let front = self.sky.strength * colour(above, below) * more(above + below)
                    + self.skin[c] * sky[FRONT_GLOW][lane];
                let (above, below) = (sky[BEHIND_ABOVE][lane], sky[BEHIND_BELOW][lane]);
                let gain = more(above + below);
                let behind = self.sky.strength * colour(above, below) * gain + self.skin[c] * sky[BEHIND_GLOW][lane];
                // Where it is open behind there is no hair that sends back.
                let again = SKY_DENSITY * again * (1.0 - (above + below) * gain).max(0.0);
                light[c][lane] = front * (b + again) + behind * a;
            }
        }

        let mut known = sky;
        for (l, lamp) in self.lamps.iter().enumerate() {
            let toward = lamp.toward.to_array();
            let mut column = [0.0_f32; LANES];
            let mut cos_azimuth = [0.0_f32; LANES];
            let mut along = [[0.0_f32; LANES]; 4];
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
                along[3][lane] = wide.at(s, c, sin_eye[lane], cos_eye[lane]);
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
            // Where it is not known what is about, as much as straight on.
            let mut aside = crossed;
            if let (Some(map), Some(places)) = (self.sky_map, &places) {
                let number = TOWARD_LAMPS + l;
                if number.is_multiple_of(AT_ONCE) {
                    known = map.at(places, number / AT_ONCE);
                }
                for lane in 0..LANES {
                    aside[lane] = -ln(known[number % AT_ONCE][lane].clamp(1e-6, 1.0));
                }
            }
            let mut straight = [0.0_f32; LANES];
            for lane in 0..LANES {
                straight[lane] = exp_of_negative(-crossed[lane]);
            }
            for c in 0..3 {
                for lane in 0..LANES {
                    let cos = cos_azimuth[lane];
                    let (same_side, far_side) = (0.5 * (1.0 + cos) / PI, 0.5 * (1.0 - cos) / PI);
                    let m = [along[0][lane], along[1][lane], along[2][lane], along[3][lane]];
                    let (forward, rest) = (rows.forward[c][lane], rows.rest[c][lane]);
                    let once = m[0] * lobes[0][lane] + m[1] * lobes[1 + c][lane] + m[2] * (lobes[4 + c][lane] + rest);
                    let back = m[3] * rows.again[c][lane] * same_side;
                    let many = m[3] * (rows.back[c][lane] * same_side + forward * far_side);
                    let straight = straight[lane];
                    let lost = (1.0 - forward).max(0.0);
                    let scattered = exp_of_negative(-crossed[lane] * lost) + exp_of_negative(-aside[lane] * lost);
                    let passed = 0.5 * scattered - straight;
                    let part = straight * (once + back) + DENSITY * passed.max(0.0) * (many + back);
                    light[c][lane] += PI * visible[lane] * lamp.strength[c] * part;
                }
            }
        }
        std::array::from_fn(|lane| [light[0][lane], light[1][lane], light[2][lane]])
    }
}

/// The part of even light that hair without end sends back, of which each fibre passes on the part `a` and sends back `b`.
///
/// One fibre more before it changes nothing: R = b + a^2 R / (1 - b R), whose smaller root this is. It is the sum over all
/// numbers of reversals, of which Zinke et al. (2008) take one and three.
#[inline(always)]
pub fn sent_back(a: f32, b: f32) -> f32 {
    let q = 1.0 - a * a + b * b;
    2.0 * b / (q + (q * q - 4.0 * b * b).max(0.0).sqrt()).max(1e-12)
}

/// Rows of the lanes' tables, and the light that comes back from the hair behind.
#[derive(Default)]
struct Rows {
    forward: [[f32; LANES]; 3],
    back: [[f32; LANES]; 3],
    rest: [[f32; LANES]; 3],
    again: [[f32; LANES]; 3],
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_hair_sends_back_is_the_sum_of_all_reversals_and_no_more_than_arrives() {
        for (a, b) in [(0.05, 0.04), (0.5, 0.3), (0.75, 0.2), (0.3, 0.65), (0.8, 0.15), (0.0, 0.5), (0.0, 0.0)] {
            // Layer upon layer: each new one before those that are there sends back what goes to and fro between them.
            let mut sum = 0.0_f64;
            for _ in 0..2000 {
                sum = b + a * a * sum / (1.0 - b * sum);
            }
            // A few roundings; the root takes the half of the digits where a + b is near 1.
            assert!((f64::from(sent_back(a as f32, b as f32)) - sum).abs() < 1e-5, "{a} {b}");
            assert!(sum < 1.0);
        }
        // Clear hair sends back all, to the root of a rounding.
        for b in [0.1, 0.5, 0.9] {
            assert!((sent_back(1.0 - b, b) - 1.0).abs() < 3e-3, "{b}");
        }
    }
}
