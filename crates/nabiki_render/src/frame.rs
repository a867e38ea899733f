//! A finished frame: linear light, and what display wants of it.

use rayon::prelude::*;

use crate::settings::{Picture, Tone};

/// Where nothing is, the depth layer holds this.
pub const NO_DEPTH: f32 = f32::INFINITY;

/// One picture in linear light, row after row from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// Width and height (pixels).
    pub size: [u32; 2],
    /// Red, green, blue (linear, Rec. 709 primaries) and alpha, *premultiplied*: colour is already weighted by alpha.
    pub rgba: Vec<[f32; 4]>,
    /// Depth of the nearest thing that shows in the pixel (cm along the axis of view), [`NO_DEPTH`] where nothing does.
    pub depth: Vec<f32>,
    /// Layers for compositing; empty unless asked for.
    pub layers: Vec<HairLayer>,
}

/// What a compositor may want of the hair in one pixel, weighted by its share of the pixel (premultiplied by `share`).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HairLayer {
    /// Direction of the hair from root to tip (unit vector in head space).
    pub direction: [f32; 3],
    /// Movement while the shutter is open (pixels, right and down).
    pub motion: [f32; 2],
    /// Share of the pixel that shows hair, 0..1.
    pub share: f32,
}

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

impl Tone {
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

/// Turns linear frames into display values: exposure, tone, alpha, sRGB.
pub struct Developer {
    gain: f32,
    tone: Tone,
    table: Vec<f32>,
}

impl Developer {
    /// For the exposure and tone of `picture`.
    pub fn new(picture: &Picture) -> Self {
        // Indexed by the square root of the light, which spends the table's steps where sRGB is steep.
        let table = (0..=STEPS + 1).map(|i| srgb_from_linear((i as f32 / STEPS as f32).powi(2))).collect();
        Self { gain: picture.exposure.exp2(), tone: picture.tone, table }
    }

    /// sRGB display value (0..1) of scene light.
    #[inline]
    pub fn value(&self, light: f32) -> f32 {
        let x = self.tone.display(light * self.gain).sqrt() * STEPS as f32;
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
    fn tone_and_its_inverse_agree() {
        for tone in [Tone::Linear, Tone::Filmic] {
            for i in 0..100 {
                let y = i as f32 / 100.0;
                // A few roundings of numbers up to 1, amplified by the slope of at most 1.
                assert!((tone.display(tone.scene(y)) - y).abs() < 1e-6, "{tone:?} {y}");
            }
        }
    }

    #[test]
    fn developed_values_are_srgb_to_a_tenth_of_an_8_bit_step() {
        let developer = Developer::new(&Picture { tone: Tone::Linear, ..Picture::default() });
        for i in 0..=10_000 {
            let x = i as f32 / 10_000.0;
            assert!((developer.value(x) - srgb_from_linear(x)).abs() < 0.1 / 255.0, "{x}");
        }
    }

    #[test]
    fn straight_alpha_does_not_darken() {
        let developer = Developer::new(&Picture { tone: Tone::Linear, ..Picture::default() });
        let frame =
            Frame { size: [2, 1], rgba: vec![[0.25, 0.25, 0.25, 0.5], [0.0; 4]], depth: vec![], layers: vec![] };
        let half = (srgb_from_linear(0.5) * 255.0 + 0.5) as u8;
        assert_eq!(developer.rgba8(&frame), [half, half, half, 128, 0, 0, 0, 0]);
    }
}
