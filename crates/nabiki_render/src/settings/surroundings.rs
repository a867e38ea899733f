//! Settings of what surrounds the hair: head, background, tone mapping and movie.

use nabiki::{settings, words};

settings! {
    /// How the head is drawn.
    #[derive(Copy)]
    pub struct HeadLook {
        /// Whether the head is drawn; it hides hair behind it and throws shadows all the same.
        pub visible: bool = true => "Visible";
        /// Its colour. The default is a neutral skin, dull enough to leave the eye to the hair.
        pub colour: [f32; 3] = [0.56, 0.44, 0.37] => "Colour", unit "sRGB", least 0.0, most 1.0;
        /// How far light creeps past the terminator, as in skin.
        pub softness: f32 = 0.2 => "Softness", least 0.0, most 1.0;
        /// Strength of its sheen.
        pub sheen: f32 = 0.25 => "Sheen", least 0.0, most 1.0;
        /// Hair too short to be drawn: its length for each root, as thick as the hair. It tints the scalp as dense as the roots stand, so
        /// that partings do not gleam; 0 shows bare skin.
        pub stubble: f32 = 2.0 => "Stubble", unit "cm", least 0.0, most 100.0;
        /// Whether the built-in head has brows, eyes and lips of their colours; other heads have what their mesh has, one colour.
        pub face: bool = true => "Face";
    }
}

settings! {
    /// How a body besides the head is drawn.
    #[derive(Copy)]
    pub struct BodyLook {
        /// Whether it is drawn. What is not shown hides nothing and throws no shadow.
        pub shown: bool = true => "Shown";
        /// Its colour. The default is a grey that is no skin.
        pub colour: [f32; 3] = [0.42, 0.46, 0.50] => "Colour", unit "sRGB", least 0.0, most 1.0;
    }
}

settings! {
    /// What is behind it all: a vertical gradient, or nothing.
    #[derive(Copy)]
    pub struct Background {
        /// Colour at the top edge, as displayed.
        pub top: [f32; 3] = [0.36, 0.38, 0.41] => "Top", unit "sRGB", least 0.0, most 1.0;
        /// Colour at the bottom edge, as displayed.
        pub bottom: [f32; 3] = [0.20, 0.21, 0.23] => "Bottom", unit "sRGB", least 0.0, most 1.0;
        /// Whether it is left out: alpha 0 where there is neither hair nor head.
        pub transparent: bool = false => "Transparent";
    }
}

words! {
    /// The curve of the tone mapping: how scene light becomes display light.
    pub enum ToneCurve = Filmic {
        /// Clipped at white.
        Linear = "linear",
        /// Straight up to half of white, then a shoulder that rolls highlights off softly, by way of their own hue.
        Filmic = "filmic",
    }
}

settings! {
    /// The movie's file.
    #[derive(Copy)]
    pub struct Video {
        /// 0 is a small file, 1 a large one, near lossless.
        pub quality: f32 = 0.75 => "Quality", least 0.0, most 1.0;
        /// Frames a second that the movie is played with: fewer than `motion.frame_rate`, which is taken otherwise, is slow motion.
        pub frame_rate: Option<f64> = None => "Frame rate", unit "a second", least 1.0, most 240.0, open "the motion's";
    }
}
