//! The colour of hair: from pigment to absorption, and the colour of a mass of hair.

use crate::settings::{HairColour, HairLook};
use crate::tone_mapping::linear_from_srgb;

/// Absorption of a unit of eumelanin and of pheomelanin for red, green and blue (per fibre radius), after d'Eon et al.
/// (2011), figure 12, as tabulated for red, green and blue by Pharr, Jakob and Humphreys.
const EUMELANIN: [f32; 3] = [0.419, 0.697, 1.37];
const PHEOMELANIN: [f32; 3] = [0.187, 0.4, 1.05];

/// Absorption inside the fibre (per fibre radius; red, green, blue).
pub fn absorption(look: &HairLook) -> [f32; 3] {
    match (look.colour.melanin(), look.colour) {
        (Some([eumelanin, pheomelanin]), _) => {
            std::array::from_fn(|c| eumelanin * EUMELANIN[c] + pheomelanin * PHEOMELANIN[c])
        }
        (None, HairColour::Rgb(rgb)) => {
            let depth = albedo_depth(look.azimuthal_roughness);
            rgb.map(|c| (linear_from_srgb(c).clamp(1e-4, 0.999).ln() / depth).powi(2))
        }
        (None, _) => [0.0; 3],
    }
}

/// Colour (linear) of a thick mass of hair with this absorption in even light: the inverse of the fit of Chiang et al.
/// (2016), equation 9.
pub fn albedo(absorption: [f32; 3], azimuthal_roughness: f32) -> [f32; 3] {
    let depth = albedo_depth(azimuthal_roughness);
    absorption.map(|a| (-a.sqrt() * depth).exp())
}

/// Colour (linear red, green, blue) of a thick mass of this hair in even light.
pub fn of_mass(look: &HairLook) -> [f32; 3] {
    albedo(absorption(look), look.azimuthal_roughness)
}

fn albedo_depth(b: f32) -> f32 {
    5.969 + b * (-0.215 + b * (2.532 + b * (-10.73 + b * (5.574 + b * 0.245))))
}

/// The luminance of a colour, with the weights of Rec. 709.
pub fn luminance([r, g, b]: [f32; 3]) -> f32 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

/// A uniform random number in 0..1 for a strand and a purpose (a hash by multiplication and shift).
pub fn of_strand(strand: u32, purpose: u32) -> f32 {
    let mut h = strand.wrapping_mul(0x9E37_79B1) ^ purpose.wrapping_mul(0x85EB_CA77);
    h = (h ^ h >> 16).wrapping_mul(0x7FEB_352D);
    h = (h ^ h >> 15).wrapping_mul(0x846C_A68B);
    h ^= h >> 16;
    (h >> 8) as f32 / (1 << 24) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_given_colour_comes_back_from_its_absorption() {
        let rgb = [0.6, 0.35, 0.2];
        let look = HairLook { colour: HairColour::Rgb(rgb), ..HairLook::default() };
        let shown = albedo(absorption(&look), look.azimuthal_roughness);
        for c in 0..3 {
            assert!((shown[c] - linear_from_srgb(rgb[c])).abs() < 1e-5);
        }
    }

    #[test]
    fn numbers_of_strands_are_spread_evenly() {
        let mean = (0..10_000).map(|s| of_strand(s, 3)).sum::<f32>() / 10_000.0;
        // Six standard errors of the mean of 10,000 uniform numbers: 6 / sqrt(12 * 10000).
        assert!((mean - 0.5).abs() < 0.0174);
    }
}
