//! What shows where nothing hides it.

use crate::settings::Picture;
use crate::tone_mapping::linear_from_srgb;

/// The background of each row of a picture.
pub struct Backdrop {
    rows: Vec<[f32; 4]>,
}

impl Backdrop {
    /// Its colours come out of the tone mapping as the settings have them.
    pub fn new(picture: &Picture, height: usize) -> Self {
        let look = &picture.background;
        let rows = (0..height)
            .map(|y| {
                if look.transparent {
                    return [0.0; 4];
                }
                let t = (y as f32 + 0.5) / height as f32;
                let shown: [f32; 3] = std::array::from_fn(|c| look.top[c] + (look.bottom[c] - look.top[c]) * t);
                let light = picture.tone_mapping.scene(shown.map(linear_from_srgb));
                let [r, g, b] = light.map(|x| x * (-picture.exposure).exp2());
                [r, g, b, 1.0]
            })
            .collect();
        Self { rows }
    }

    /// Premultiplied light with the background of `row` behind it.
    pub fn behind(&self, light: [f32; 4], row: usize) -> [f32; 4] {
        match self.rows.get(row) {
            Some(back) => std::array::from_fn(|c| light[c] + back[c] * (1.0 - light[3])),
            None => light,
        }
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
}
