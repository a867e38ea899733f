//! From linear light to display values: exposure, tone curve, sRGB.

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
    /// Display light (0..1, linear) of scene light.
    #[inline]
    pub fn display(self, x: f32) -> f32 {
        match self {
            Self::Linear => x.clamp(0.0, 1.0),
            Self::Filmic if x <= KNEE => x.max(0.0),
            Self::Filmic => 1.0 - (1.0 - KNEE) * (-(x - KNEE) / (1.0 - KNEE)).exp(),
        }
    }

    /// Scene light that is displayed as `y` (0..1, linear); just below white at most.
    pub fn scene(self, y: f32) -> f32 {
        match self {
            Self::Filmic if y > KNEE => KNEE - (1.0 - KNEE) * ((1.0 - y.min(0.9999)) / (1.0 - KNEE)).ln(),
            _ => y,
        }
    }
}

/// Steps of the table from linear light to sRGB: fine enough that 16 bit values are right to half a step above 1/256 of
/// white, and 8 bit values everywhere.
const STEPS: usize = 1 << 14;

/// Turns linear frames into display values: exposure, tone curve, alpha, sRGB.
pub struct ToneMapping {
    gain: f32,
    curve: ToneCurve,
    table: Vec<f32>,
}

impl ToneMapping {
    /// For the exposure and tone curve of `picture`.
    pub fn new(picture: &Picture) -> Self {
        // Indexed by the square root of the light, which spends the table's steps where sRGB is steep.
        let table = (0..=STEPS + 1).map(|i| srgb_from_linear((i as f32 / STEPS as f32).powi(2))).collect();
        Self { gain: picture.exposure.exp2(), curve: picture.tone_mapping, table }
    }

    /// sRGB display value (0..1) of scene light.
    #[inline]
    pub fn value(&self, light: f32) -> f32 {
        let x = self.curve.display(light * self.gain).sqrt() * STEPS as f32;
        let i = (x as usize).min(STEPS);
        self.table[i] + (self.table[i + 1] - self.table[i]) * (x - i as f32)
    }

    fn pixel(&self, p: &[f32; 4]) -> [f32; 4] {
        let a = p[3].clamp(0.0, 1.0);
        let straight = if a > 0.0 { 1.0 / a } else { 0.0 };
        [self.value(p[0] * straight), self.value(p[1] * straight), self.value(p[2] * straight), a]
    }

    /// 8 bit sRGB with *straight* alpha, four bytes a pixel.
    pub fn rgba8(&self, frame: &Frame) -> Vec<u8> {
        let mut bytes = vec![0; 4 * frame.rgba.len()];
        bytes.par_chunks_mut(4 * 1024).zip(frame.rgba.par_chunks(1024)).for_each(|(out, pixels)| {
            for (out, p) in out.chunks_exact_mut(4).zip(pixels) {
                out.copy_from_slice(&self.pixel(p).map(|v| (v * 255.0 + 0.5) as u8));
            }
        });
        bytes
    }

    /// 16 bit sRGB with *straight* alpha, four values a pixel.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_and_its_inverse_agree() {
        for curve in [ToneCurve::Linear, ToneCurve::Filmic] {
            for i in 0..100 {
                let y = i as f32 / 100.0;
                // A few roundings of numbers up to 1, amplified by the slope of at most 1.
                assert!((curve.display(curve.scene(y)) - y).abs() < 1e-6, "{curve:?} {y}");
            }
        }
    }

    #[test]
    fn displayed_values_are_srgb_to_a_tenth_of_an_8_bit_step() {
        let tone_mapping = ToneMapping::new(&Picture { tone_mapping: ToneCurve::Linear, ..Picture::default() });
        for i in 0..=10_000 {
            let x = i as f32 / 10_000.0;
            assert!((tone_mapping.value(x) - srgb_from_linear(x)).abs() < 0.1 / 255.0, "{x}");
        }
    }

    #[test]
    fn straight_alpha_does_not_darken() {
        let tone_mapping = ToneMapping::new(&Picture { tone_mapping: ToneCurve::Linear, ..Picture::default() });
        let frame =
            Frame { size: [2, 1], rgba: vec![[0.25, 0.25, 0.25, 0.5], [0.0; 4]], depth: vec![], layers: vec![] };
        let half = (srgb_from_linear(0.5) * 255.0 + 0.5) as u8;
        assert_eq!(tone_mapping.rgba8(&frame), [half, half, half, 128, 0, 0, 0, 0]);
    }
}
