//! Settings of the light: `[[picture.lights]]` and `[picture.sky]`.

use nabiki::{settings, words};

words! {
    /// What a lamp's direction is relative to.
    pub enum LightSpace = Camera {
        /// The camera: azimuth 0 comes from where the camera stands, and a moving camera carries its lamps with it. They stay
        /// in the world when the head turns.
        Camera = "camera",
        /// The world: azimuth 0 is the world's +x, before the face of a head that has not turned.
        World = "world",
        /// The head: azimuth 0 comes from before the face, and the lamps turn with the head.
        Head = "head",
    }
}

words! {
    /// What the sky is fixed to.
    pub enum SkySpace = World {
        /// The world: it stays above when the head turns.
        World = "world",
        /// The head: it turns with the head.
        Head = "head",
    }
}

settings! {
    /// A lamp, far away.
    #[derive(Copy)]
    pub struct Light {
        /// Where the light comes from, about the vertical, counted as the camera's azimuth.
        pub azimuth: f32 = 0.0 => "Azimuth", unit "degrees", least -3600.0, most 3600.0;
        /// Where it comes from, above the horizon.
        pub elevation: f32 = 40.0 => "Elevation", unit "degrees", least -90.0, most 90.0;
        /// Its strength: a white surface facing it is as bright as this.
        pub strength: f32 = 1.0 => "Strength", least 0.0, most 1000.0;
        /// Its colour: amounts of light.
        pub colour: [f32; 3] = [1.0; 3] => "Colour", unit "linear", least 0.0, most 1.0;
        /// How far the lamp spreads as seen from the hair: wide lamps throw soft shadows.
        pub spread: f32 = 4.0 => "Spread", unit "degrees", least 0.0, most 45.0;
        /// What its direction is relative to.
        pub space: LightSpace = LightSpace::Camera => "Goes with";
    }
}

impl Light {
    /// A portrait photographer's four lamps: a warm key from above, a weak cool fill, and two kickers from behind that edge the hair.
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
    /// The light that comes from all around, dimmed where hair or head hide it.
    #[derive(Copy)]
    pub struct Sky {
        /// Its strength: an unhidden white surface is as bright as this.
        pub strength: f32 = 0.24 => "Strength", least 0.0, most 1000.0;
        /// Colour of the light from straight above.
        pub above: [f32; 3] = [0.93, 0.97, 1.0] => "Above", unit "linear", least 0.0, most 1.0;
        /// Colour of the light from straight below.
        pub below: [f32; 3] = [0.55, 0.5, 0.47] => "Below", unit "linear", least 0.0, most 1.0;
        /// Whether hair and head hide the sky from what lies within.
        pub occlusion: bool = true => "Occlusion";
        /// Whether it stays above when the head turns, or turns with it.
        pub space: SkySpace = SkySpace::World => "Goes with";
    }
}

impl Sky {
    /// Whether hair and head hide it. The light that they throw on one another is found with it, also where the sky is dark.
    pub(crate) fn is_occluded(&self) -> bool {
        self.occlusion
    }
}
