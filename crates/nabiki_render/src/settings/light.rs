//! Settings of the light: `[[picture.lights]]` and `[picture.sky]`.

use nabiki::{settings, words};

words! {
    /// What a lamp's direction is relative to.
    pub enum LightSpace = Camera {
        /// The camera. Azimuth 0 comes from the camera, and a moving camera carries its lamps with it. They do not turn
        /// with the head.
        Camera = "camera",
        /// The world. Azimuth 0 is the world's +x, in front of a head that has not turned.
        World = "world",
        /// The head. Azimuth 0 comes from in front of the face, and the lamps turn with the head.
        Head = "head",
    }
}

words! {
    /// What the sky is fixed to.
    pub enum SkySpace = World {
        /// The world: the sky stays above when the head turns.
        World = "world",
        /// The head: the sky turns with it.
        Head = "head",
    }
}

settings! {
    /// A lamp, far away.
    #[derive(Copy)]
    pub struct Light {
        /// Direction around the vertical that the light comes from, counted like the camera's azimuth.
        pub azimuth: f32 = 0.0 => "Azimuth", unit "degrees", least -3600.0, most 3600.0;
        /// Direction above the horizon that the light comes from.
        pub elevation: f32 = 40.0 => "Elevation", unit "degrees", least -90.0, most 90.0;
        /// Strength: the brightness of a white surface that faces the lamp.
        pub strength: f32 = 1.0 => "Strength", least 0.0, most 1000.0;
        /// Colour of the light, as linear amounts.
        pub colour: [f32; 3] = [1.0; 3] => "Colour", unit "linear", least 0.0, most 1.0;
        /// Apparent size of the lamp as seen from the hair. Raise it for softer shadows.
        pub spread: f32 = 4.0 => "Spread", unit "degrees", least 0.0, most 45.0;
        /// What the direction is relative to.
        pub space: LightSpace = LightSpace::Camera => "Fixed to";
    }
}

impl Light {
    /// A portrait photographer's four lamps: a warm key light from above, a weak cool fill light, and two kickers from
    /// behind that outline the hair.
    pub fn studio() -> Vec<Self> {
        let lamp = |azimuth, elevation, strength, colour, spread| Self {
            azimuth,
            elevation,
            strength,
            colour,
            spread,
            ..Self::default()
        };
        vec![
            lamp(32.0, 48.0, 3.1, [1.0, 0.96, 0.91], 6.0),
            lamp(-50.0, 14.0, 0.5, [0.92, 0.96, 1.0], 20.0),
            lamp(168.0, 40.0, 1.0, [1.0, 0.97, 0.94], 9.0),
            lamp(-130.0, 28.0, 0.85, [0.92, 0.96, 1.0], 9.0),
        ]
    }
}

settings! {
    /// Light from all directions, dimmed where hair or head block it.
    #[derive(Copy)]
    pub struct Sky {
        /// Strength: the brightness of a white surface that nothing blocks.
        pub strength: f32 = 0.24 => "Strength", least 0.0, most 1000.0;
        /// Colour of the light from straight above.
        pub above: [f32; 3] = [0.93, 0.97, 1.0] => "Above", unit "linear", least 0.0, most 1.0;
        /// Colour of the light from straight below.
        pub below: [f32; 3] = [0.55, 0.5, 0.47] => "Below", unit "linear", least 0.0, most 1.0;
        /// Whether hair and head block the light of the sky.
        pub occlusion: bool = true => "Occlusion";
        /// Whether the sky stays fixed to the world or turns with the head.
        pub space: SkySpace = SkySpace::World => "Fixed to";
    }
}

impl Sky {
    /// Whether hair and head hide it. The light that they throw on one another is found with it, also where the sky is dark.
    pub(crate) fn is_occluded(&self) -> bool {
        self.occlusion
    }
}
