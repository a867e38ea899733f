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
