//! Conversion of linear light to display values: exposure, tone curve, sRGB.

use rayon::prelude::*;

use crate::frame::Frame;
use crate::settings::{Picture, ToneCurve};

/// sRGB display value (0..1) of linear light (0..1).
pub fn srgb_from_linear(x: f32) -> f32 {
    if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 }
}

/// Linear light (0..1) of an sRGB display value (0..1).
pub fn linear_from_srgb(x: f32) -> f32 {
    if x <= 0.040_45 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) }
}

/// Where the filmic curve leaves the straight line.
const KNEE: f32 = 0.5;

impl ToneCurve {
    /// Display light (0..1, linear) for scene light: red, green and blue.
    ///
    /// The filmic curve is applied to the strongest channel, and the ratios of the others to it are raised to a power
    /// below 1. Bright colours therefore become white without a change of hue. A separate curve per channel would turn
    /// red into yellow on the way.
    #[inline]
    pub fn display(self, light: [f32; 3]) -> [f32; 3] {
        if self == Self::Linear {
            return light.map(|x| x.clamp(0.0, 1.0));
        }
        let strongest = strongest(light);
        if strongest <= KNEE {
            return light.map(|x| x.max(0.0));
        }
        let shown = 1.0 - (1.0 - KNEE) * (-(strongest - KNEE) / (1.0 - KNEE)).exp();
        light.map(|x| shown * share(x, strongest).powf(shown / strongest))
    }

    /// Scene light that is displayed as `shown` (0..1, linear), at most just below white.
    pub fn scene(self, shown: [f32; 3]) -> [f32; 3] {
        let strongest_shown = strongest(shown);
        if self == Self::Linear || strongest_shown <= KNEE {
            return shown;
        }
        let below_white = strongest_shown.min(0.9999);
        let strongest = KNEE - (1.0 - KNEE) * ((1.0 - below_white) / (1.0 - KNEE)).ln();
        shown.map(|y| strongest * share(y, strongest_shown).powf(strongest / below_white))
    }
}

fn strongest(colour: [f32; 3]) -> f32 {
    colour[0].max(colour[1]).max(colour[2])
}

/// The part that a colour is of the strongest, 0..=1; 1 where both are infinite.
fn share(x: f32, strongest: f32) -> f32 {
    (x.max(0.0) / strongest).min(1.0)
}

/// Steps of the table from linear light to sRGB: fine enough that 16 bit values are right to half a step above 1/256 of
/// white, and 8 bit values everywhere.
const STEPS: usize = 1 << 14;

/// Converts linear frames to display values: exposure, tone curve, alpha, sRGB.
pub struct ToneMapping {
    gain: f32,
    curve: ToneCurve,
    table: Vec<f32>,
}

impl ToneMapping {
    /// The conversion with the exposure and tone curve of `picture`.
    pub fn new(picture: &Picture) -> Self {
        // Indexed by the square root of the light, which spends the table's steps where sRGB is steep.
        let table = (0..=STEPS + 1).map(|i| srgb_from_linear((i as f32 / STEPS as f32).powi(2))).collect();
        Self { gain: picture.exposure.exp2(), curve: picture.tone_mapping, table }
    }

    /// sRGB display values (0..1) of scene light: red, green and blue.
    #[inline]
    pub fn values(&self, light: [f32; 3]) -> [f32; 3] {
        self.curve.display(light.map(|x| x * self.gain)).map(|x| {
            let x = x.sqrt() * STEPS as f32;
            let i = (x as usize).min(STEPS);
            self.table[i] + (self.table[i + 1] - self.table[i]) * (x - i as f32)
        })
    }

    fn pixel(&self, p: &[f32; 4]) -> [f32; 4] {
        let a = p[3].clamp(0.0, 1.0);
        let straight = if a > 0.0 { 1.0 / a } else { 0.0 };
        let [r, g, b] = self.values([p[0] * straight, p[1] * straight, p[2] * straight]);
        [r, g, b, a]
    }

    /// 8-bit sRGB with *straight* alpha, four bytes per pixel. Values are dithered, so that gradients show no bands.
    pub fn rgba8(&self, frame: &Frame) -> Vec<u8> {
        let width = frame.size[0].max(1) as usize;
        let mut bytes = vec![0; 4 * frame.rgba.len()];
        bytes.par_chunks_mut(4 * width).zip(frame.rgba.par_chunks(width)).enumerate().for_each(|(y, (out, pixels))| {
            for (x, (out, p)) in out.chunks_exact_mut(4).zip(pixels).enumerate() {
                let [r, g, b, a] = self.pixel(p);
                let up_from = threshold(x, y);
                out[..3].copy_from_slice(&[r, g, b].map(|v| (v * 255.0 + up_from) as u8));
                out[3] = (a * 255.0 + 0.5) as u8;
            }
        });
        bytes
    }

    /// 16-bit sRGB with *straight* alpha, four values per pixel.
    pub fn rgba16(&self, frame: &Frame) -> Vec<u16> {
        let mut values = vec![0; 4 * frame.rgba.len()];
        values.par_chunks_mut(4 * 1024).zip(frame.rgba.par_chunks(1024)).for_each(|(out, pixels)| {
            for (out, p) in out.chunks_exact_mut(4).zip(pixels) {
                out.copy_from_slice(&self.pixel(p).map(|v| (v * 65535.0 + 0.5) as u16));
            }
        });
        values
    }
}

/// What is added to a colour before its fraction is cut off: the interleaved gradient noise of Jimenez (2014), whose values are spread
/// evenly over every 3 x 3 pixels. It keeps off 0 and 1, so that a whole step to within rounding stays one.
#[inline]
pub(crate) fn threshold(x: usize, y: usize) -> f32 {
    // Kept small, so that no digits are lost far from the corner.
    let (x, y) = ((x % 1024) as f32, (y % 1024) as f32);
    let noise = fraction(52.982_918 * fraction(0.067_110_56 * x + 0.005_837_15 * y));
    0.02 + 0.96 * noise
}

/// That of a number from 0 to 2^31: `fract` is a call on plain x86-64.
#[inline]
fn fraction(x: f32) -> f32 {
    x - x as i32 as f32
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn a_curve_and_its_inverse_agree(shown in [0.0_f32..0.99, 0.0_f32..0.99, 0.0_f32..0.99]) {
            for curve in [ToneCurve::Linear, ToneCurve::Filmic] {
                let again = curve.display(curve.scene(shown));
                for c in 0..3 {
                    // A share s is raised to a power and back. Of the power's roundings as many parts of s |ln s|, at most 0.37, are lost,
                    // and a few roundings of s besides.
                    prop_assert!((again[c] - shown[c]).abs() < 8.0 * f32::EPSILON, "{curve:?} {shown:?} {again:?}");
                }
            }
        }

        #[test]
        fn filmic_keeps_the_order_of_colours_and_what_is_brighter_is_shown_brighter_and_paler(
            light in [0.0_f32..4.0, 0.0_f32..4.0, 0.0_f32..4.0],
            more in 1.0_f32..3.0,
        ) {
            let shown = ToneCurve::Filmic.display(light);
            let brighter = ToneCurve::Filmic.display(light.map(|x| x * more));
            let rounding = 8.0 * f32::EPSILON;
            for c in 0..3 {
                prop_assert!((0.0..=1.0).contains(&shown[c]));
                prop_assert!(brighter[c] >= shown[c] - rounding);
                for other in 0..3 {
                    prop_assert!(light[c] < light[other] || shown[c] >= shown[other]);
                    // Of what is shown no colour's share of another falls that was below it.
                    prop_assert!(light[c] > light[other] || brighter[c] * shown[other] >= shown[c] * brighter[other] - rounding);
                }
            }
        }

        #[test]
        fn filmic_shows_greys_by_one_curve_and_half_lights_as_they_are(
            grey in 0.0_f32..8.0,
            half in [0.0_f32..0.5, 0.0_f32..0.5, 0.0_f32..0.5],
        ) {
            let [r, g, b] = ToneCurve::Filmic.display([grey; 3]);
            prop_assert!(r == g && g == b && r <= grey + f32::EPSILON);
            prop_assert_eq!(ToneCurve::Filmic.display(half), half);
        }
    }

    #[test]
    fn no_light_is_too_strong_to_show() {
        let [r, g, b] = ToneCurve::Filmic.display([f32::INFINITY, f32::MAX, 1.0]);
        assert!(r == 1.0 && (0.0..=1.0).contains(&g) && (0.0..=1.0).contains(&b), "{r} {g} {b}");
    }

    #[test]
    fn red_hair_lit_through_stays_nearer_to_red_than_to_yellow() {
        // Light through red hair, three times white: a curve for each colour would show its green as 0.88 of its red.
        let [r, g, b] = ToneCurve::Filmic.display([3.0, 1.2, 0.2]);
        assert!(r > 0.99 && g < 0.8 * r && b < 0.6 * g, "{r} {g} {b}");
    }

    #[test]
    fn displayed_values_are_srgb_to_a_tenth_of_an_8_bit_step() {
        let tone_mapping = ToneMapping::new(&Picture { tone_mapping: ToneCurve::Linear, ..Picture::default() });
        for i in 0..=10_000 {
            let x = i as f32 / 10_000.0;
            assert!((tone_mapping.values([x; 3])[0] - srgb_from_linear(x)).abs() < 0.1 / 255.0, "{x}");
        }
    }

    #[test]
    fn straight_alpha_does_not_darken() {
        let tone_mapping = ToneMapping::new(&Picture { tone_mapping: ToneCurve::Linear, ..Picture::default() });
        let frame =
            Frame { size: [2, 1], rgba: vec![[0.25, 0.25, 0.25, 0.5], [0.0; 4]], depth: vec![], layers: vec![] };
        let half = (srgb_from_linear(0.5) * 255.0 + threshold(0, 0)) as u8;
        assert_eq!(tone_mapping.rgba8(&frame), [half, half, half, 128, 0, 0, 0, 0]);
    }

    #[test]
    fn a_gradient_finer_than_a_step_is_right_in_the_mean_and_has_no_bands() {
        let tone_mapping = ToneMapping::new(&Picture { tone_mapping: ToneCurve::Linear, ..Picture::default() });
        let (width, height) = (128_usize, 512_usize);
        // Four steps of 255 from top to bottom: 128 rows each, which without noise would be four flat bands.
        let shown = |y: usize| (60.0 + 4.0 * (y as f32 + 0.5) / height as f32) / 255.0;
        let light = |y: usize| linear_from_srgb(shown(y));
        let rgba = (0..width * height).map(|i| [light(i / width), light(i / width), light(i / width), 1.0]).collect();
        let frame = Frame { size: [width as u32, height as u32], rgba, depth: vec![], layers: vec![] };
        let bytes = tone_mapping.rgba8(&frame);
        for (n, rows) in bytes.chunks(4 * width * 16).enumerate() {
            let sum: f64 = rows.chunks_exact(4).map(|p| f64::from(p[0])).sum();
            let mean = sum / (rows.len() / 4) as f64;
            let wanted = f64::from(255.0 * shown(16 * n + 8) - 0.5 * 4.0 / height as f32);
            // A tenth of a step is the table's; the noise, kept to 0.96 of a step, is off by 0.02, and by 1 of 48 for its grain.
            assert!((mean - wanted).abs() < 0.15, "rows from {}: {mean} for {wanted}", 16 * n);
            // Within a band the colour would be one; but where it is a whole step, both neighbours are rare.
            let low = rows.chunks_exact(4).filter(|p| f64::from(p[0]) < wanted).count();
            let share = low as f64 / (rows.len() / 4) as f64;
            let fraction = wanted.ceil() - wanted;
            assert!((share - fraction).abs() < 0.15 || !(0.1..=0.9).contains(&fraction), "{share} for {fraction}");
        }
    }

    #[test]
    fn a_stop_of_exposure_shows_twice_the_light() {
        for tone_mapping in [ToneCurve::Linear, ToneCurve::Filmic] {
            let at = |exposure| ToneMapping::new(&Picture { exposure, tone_mapping, ..Picture::default() });
            for light in [[0.01, 0.02, 0.03], [0.3, 0.1, 0.2], [1.5, 0.7, 0.0]] {
                let twice = light.map(|x| 2.0 * x);
                assert_eq!(at(1.0).values(light), at(0.0).values(twice));
                assert_eq!(at(-2.0).values(twice), at(-1.0).values(light));
            }
        }
    }
}
