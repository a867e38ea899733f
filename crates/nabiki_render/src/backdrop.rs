//! What shows where nothing hides it.

use rayon::prelude::*;

use crate::frame::Frame;
use crate::settings::{Picture, ToneCurve};
use crate::tone_mapping::linear_from_srgb;

/// The background of each row of a picture; none of one that is transparent.
pub struct Backdrop {
    curve: ToneCurve,
    gain: f32,
    rows: Vec<Back>,
}

struct Back {
    /// What is to be displayed (0..1, linear), and the scene light that is displayed so.
    shown: [f32; 3],
    light: [f32; 3],
    /// What is to be displayed beyond what that would be as scene light, where the tone curve bends.
    beyond: [f32; 3],
}

impl Backdrop {
    /// Its colours come out of the tone mapping as the settings have them.
    pub fn new(picture: &Picture, height: usize) -> Self {
        let (look, curve) = (&picture.background, picture.tone_mapping);
        let gain = picture.exposure.exp2();
        let back = |y: usize| {
            let t = (y as f32 + 0.5) / height as f32;
            let shown: [f32; 3] = std::array::from_fn(|c| look.top[c] + (look.bottom[c] - look.top[c]) * t);
            let shown = shown.map(linear_from_srgb);
            let as_light = curve.display(shown);
            let light = curve.scene(shown).map(|x| x / gain);
            Back { shown, light, beyond: [0, 1, 2].map(|c| shown[c] - as_light[c]) }
        };
        Self { curve, gain, rows: if look.transparent { Vec::new() } else { (0..height).map(back).collect() } }
    }

    /// None at all.
    pub fn none() -> Self {
        Self { curve: ToneCurve::Linear, gain: 1.0, rows: Vec::new() }
    }

    /// Premultiplied light with the background of `row` behind it.
    ///
    /// A bright background is scene light far above white, of which a little would hide all that lies before it. So it is mixed in as what it
    /// displays, and what the tone curve then lacks is added as displayed: where the curve is straight that is plain mixing of light.
    #[inline]
    pub fn behind(&self, light: [f32; 4], row: usize) -> [f32; 4] {
        let Some(back) = self.rows.get(row) else { return light };
        let open = 1.0 - light[3];
        let all = |[r, g, b]: [f32; 3]| [r, g, b, 1.0];
        if back.beyond == [0.0; 3] || open == 0.0 {
            return all([0, 1, 2].map(|c| light[c] + back.light[c] * open));
        }
        if open == 1.0 {
            return all(back.light);
        }
        let mixed = self.curve.display([0, 1, 2].map(|c| light[c] * self.gain + back.shown[c] * open));
        let shown = [0, 1, 2].map(|c| (mixed[c] + back.beyond[c] * open).clamp(0.0, 1.0));
        all(self.curve.scene(shown).map(|x| x / self.gain))
    }

    /// The same of all of a frame.
    pub fn lay_behind(&self, frame: &mut Frame) {
        let width = frame.size[0].max(1) as usize;
        frame.rgba.par_chunks_mut(width).enumerate().for_each(|(row, pixels)| {
            pixels.iter_mut().for_each(|pixel| *pixel = self.behind(*pixel, row));
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::{Background, ToneCurve};
    use crate::tone_mapping::ToneMapping;

    #[test]
    fn a_background_is_shown_in_its_colours_from_top_to_bottom_whatever_exposure_and_curve_do_to_the_rest() {
        let look = Background { top: [0.2, 0.5, 0.9], bottom: [0.8, 0.1, 0.02], transparent: false };
        for tone_mapping in [ToneCurve::Linear, ToneCurve::Filmic] {
            for exposure in [-2.0, 0.0, 3.0] {
                let picture = Picture { background: look, tone_mapping, exposure, ..Picture::default() };
                let backdrop = Backdrop::new(&picture, 40);
                for row in 0..40 {
                    let [r, g, b, alpha] = backdrop.behind([0.0; 4], row);
                    let shown = ToneMapping::new(&picture).values([r, g, b]);
                    let t = (row as f32 + 0.5) / 40.0;
                    let wanted = [0, 1, 2].map(|c| look.top[c] + (look.bottom[c] - look.top[c]) * t);
                    // A tenth of a step is the table's.
                    let off = [0, 1, 2].map(|c| (shown[c] - wanted[c]).abs()).into_iter().fold(0.0, f32::max);
                    assert!(
                        off < 0.15 / 255.0 && alpha == 1.0,
                        "{tone_mapping:?} {exposure} {row}: {shown:?} {wanted:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn of_what_lies_before_it_as_much_of_a_background_shows_as_that_leaves_open() {
        let backdrop = Backdrop::new(&Picture::default(), 1);
        let [r, g, b, _] = backdrop.behind([0.0; 4], 0);
        assert_eq!(backdrop.behind([0.3, 0.2, 0.1, 0.5], 0), [0.3 + 0.5 * r, 0.2 + 0.5 * g, 0.1 + 0.5 * b, 1.0]);
    }

    /// As much as hair covers of a white wall, so much darker it shows, up to what the tone curve bends (of mid grey and white together 0.1),
    /// and the darker the more it covers. As scene light a wall of 4.8 would show as white through half of it.
    #[test]
    fn hair_before_a_white_wall_shows_as_far_as_it_covers_it() {
        for exposure in [-1.0, 0.0, 2.0] {
            let background = Background { top: [1.0; 3], bottom: [1.0; 3], transparent: false };
            let picture = Picture { background, exposure, ..Picture::default() };
            let (backdrop, curve) = (Backdrop::new(&picture, 1), picture.tone_mapping);
            let gain = exposure.exp2();
            let shown = |alpha: f32, hair: f32| {
                let [r, g, b, whole] =
                    backdrop.behind([hair * alpha / gain, hair * alpha / gain, hair * alpha / gain, alpha], 0);
                assert_eq!(whole, 1.0);
                let [r, g, b] = curve.display([r, g, b].map(|x| x * gain));
                assert!(r == g && g == b);
                r
            };
            for hair in [0.0, 0.02, 0.3] {
                let mut before = 1.0 + 1e-3;
                for alpha in [0.0, 0.01, 0.1, 0.3, 0.5, 0.8, 0.99, 1.0] {
                    let now = shown(alpha, hair);
                    let wanted = alpha * curve.display([hair; 3])[0] + (1.0 - alpha);
                    assert!((now - wanted).abs() < 0.11 && now < before, "{hair} {alpha}: {now} for {wanted}");
                    before = now;
                }
            }
        }
    }

    /// Where a background is as bright as the curve begins to bend, both ways to mix it agree.
    #[test]
    fn nothing_jumps_where_the_curve_begins_to_bend() {
        let mixed = |grey: f32| {
            let background = Background { top: [grey; 3], bottom: [grey; 3], transparent: false };
            Backdrop::new(&Picture { background, ..Picture::default() }, 1).behind([0.4, 0.1, 0.02, 0.3], 0)
        };
        let knee = crate::tone_mapping::srgb_from_linear(0.5);
        let (below, above) = (mixed(knee - 1e-4), mixed(knee + 1e-4));
        // Twice 1e-4 of sRGB is 3.2e-4 of light there.
        assert!((0..4).all(|c| (below[c] - above[c]).abs() < 4e-4), "{below:?} {above:?}");
    }
}
