//! What the tests of pictures share.

use nabiki_render::settings::Light;

/// A key, a fill and a rim: laws are held under one light, whatever the default is.
pub fn lamps() -> Vec<Light> {
    vec![
        Light { azimuth: 30.0, elevation: 42.0, strength: 2.9, ..Light::default() },
        Light { azimuth: -50.0, elevation: 15.0, strength: 0.6, spread: 20.0, ..Light::default() },
        Light { azimuth: -155.0, elevation: 38.0, strength: 0.9, ..Light::default() },
    ]
}
