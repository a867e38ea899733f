//! The cylinder model of Kajiya and Kay (1989, equations 14 and 16), which the paper shades with.

use glam::Vec3;

/// Part of the light that the model's highlight returns, against 1 for the diffuse part of white hair.
const HIGHLIGHT: f32 = 0.35;

/// The model for hair of one colour.
#[derive(Clone, Copy, Debug)]
pub struct KajiyaKay {
    /// Diffuse colour (linear).
    pub colour: [f32; 3],
    /// Exponent of the highlight.
    pub exponent: f32,
}

impl KajiyaKay {
    /// `roughness`: standard deviation of the highlight along the hair (rad).
    pub fn new(colour: [f32; 3], roughness: f32) -> Self {
        // cos^p x is near exp(-p x^2 / 2), and the highlight turns by twice the angle of what reflects it.
        Self { colour, exponent: 1.0 / (2.0 * roughness).powi(2) }
    }

    /// Light toward the eye for one lamp of strength 1.
    ///
    /// `tangent`, `toward_lamp` and `toward_eye` are unit vectors.
    pub fn reflected(&self, tangent: Vec3, toward_lamp: Vec3, toward_eye: Vec3) -> [f32; 3] {
        let (along_lamp, along_eye) = (tangent.dot(toward_lamp), tangent.dot(toward_eye));
        let across_lamp = (1.0 - along_lamp * along_lamp).max(0.0).sqrt();
        let across_eye = (1.0 - along_eye * along_eye).max(0.0).sqrt();
        // The cosine between the eye and the cone of mirror directions.
        let mirrored = (across_lamp * across_eye - along_lamp * along_eye).max(0.0);
        let highlight = HIGHLIGHT * mirrored.powf(self.exponent);
        self.colour.map(|c| c * across_lamp + highlight)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_highlight_peaks_on_the_cone_of_mirror_directions() {
        let model = KajiyaKay::new([0.0; 3], 0.14);
        let tangent = Vec3::Y;
        let lamp = Vec3::new(0.8, 0.6, 0.0);
        // Any azimuth: the mirror cone has the lamp's angle to the hair, on the other side of its normal plane.
        for azimuth in [0.0_f32, 1.0, 2.0, 3.0] {
            let on = |rise: f32| Vec3::new(azimuth.cos() * rise.cos(), rise.sin(), azimuth.sin() * rise.cos());
            let mirror = -(0.6_f32.asin());
            let best = model.reflected(tangent, lamp, on(mirror))[0];
            assert!((best - HIGHLIGHT).abs() < 1e-5);
            assert!(model.reflected(tangent, lamp, on(mirror + 0.1))[0] < best);
            assert!(model.reflected(tangent, lamp, on(mirror - 0.1))[0] < best);
        }
    }

    #[test]
    fn hair_that_points_at_the_lamp_gets_no_diffuse_light() {
        let model = KajiyaKay { colour: [1.0; 3], exponent: 1e3 };
        assert!(model.reflected(Vec3::X, Vec3::X, Vec3::Y)[0] < 1e-3);
    }
}
