//! Settings of what surrounds the hair: head, background, tone mapping and movie.

use nabiki::{settings, words};

settings! {
    /// How the head is drawn.
    #[derive(Copy)]
    pub struct HeadLook {
        /// Whether to draw the head. A hidden head still hides the hair behind it and casts shadows.
        pub visible: bool = true => "Visible";
        /// Colour of the skin. The default is a muted skin tone that does not distract from the hair.
        pub colour: [f32; 3] = [0.56, 0.44, 0.37] => "Colour", unit "sRGB", least 0.0, most 1.0;
        /// How far light spreads past the terminator, as in skin.
        pub softness: f32 = 0.2 => "Softness", least 0.0, most 1.0;
        /// Strength of the sheen.
        pub sheen: f32 = 0.25 => "Sheen", least 0.0, most 1.0;
        /// Length of undrawn short hair at each root, as thick as the hair. It tints the scalp where roots are dense,
        /// so that partings do not shine. 0 shows bare skin.
        pub stubble: f32 = 2.0 => "Stubble", unit "cm", least 0.0, most 100.0;
        /// Whether the built-in head has coloured brows, eyes and lips. Other heads have one colour.
        pub face: bool = true => "Face";
    }
}

settings! {
    /// How a body other than the head is drawn.
    #[derive(Copy)]
    pub struct BodyLook {
        /// Whether the body is drawn. A hidden body hides nothing and casts no shadow.
        pub shown: bool = true => "Shown";
        /// Colour of the body. The default is a grey unlike skin.
        pub colour: [f32; 3] = [0.42, 0.46, 0.50] => "Colour", unit "sRGB", least 0.0, most 1.0;
    }
}

settings! {
    /// The background: a vertical gradient, or none.
    #[derive(Copy)]
    pub struct Background {
        /// Displayed colour at the top edge.
        pub top: [f32; 3] = [0.36, 0.38, 0.41] => "Top", unit "sRGB", least 0.0, most 1.0;
        /// Displayed colour at the bottom edge.
        pub bottom: [f32; 3] = [0.20, 0.21, 0.23] => "Bottom", unit "sRGB", least 0.0, most 1.0;
        /// Whether to leave out the background. Alpha is then 0 where there is neither hair nor head.
        pub transparent: bool = false => "Transparent";
    }
}

words! {
    /// The curve of the tone mapping: how scene light becomes display light.
    pub enum ToneCurve = Filmic {
        /// Clipped at white.
        Linear = "linear",
        /// Linear up to half of white, then a shoulder that rolls off highlights softly and keeps their hue.
        Filmic = "filmic",
    }
}

settings! {
    /// The movie file.
    #[derive(Copy)]
    pub struct Video {
        /// Quality of the movie. 0 gives a small file, 1 a large, nearly lossless one.
        pub quality: f32 = 0.75 => "Quality", least 0.0, most 1.0;
        /// Playback rate of the movie. A value below `motion.frame_rate` gives slow motion.
        pub frame_rate: Option<f64> = None => "Frame rate", unit "per second", least 1.0, most 240.0, open "the motion's";
    }
}
