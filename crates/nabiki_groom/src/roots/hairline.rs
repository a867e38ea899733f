//! The hairline: a closed curve around the head. Hair grows above it.

use std::f32::consts::PI;

use nabiki::glam::Vec3;
use nabiki::{Ellipsoid, settings};

settings! {
    /// Where hair grows: how far the hairline runs below the crown, all around the head.
    ///
    /// Depths are measured straight down from the top of the head ellipsoid E. The unit is the mean of its two
    /// horizontal half axes, 8.65 cm on the built-in bust, so a hairline fits heads of any size.
    pub struct Hairline in "hair.hairline" {
        /// Depth of the line above the middle of the forehead. 0.5 is 4.3 cm on the bust.
        pub forehead: f32 = 0.5 => "Forehead", least 0.0, most 2.0;
        /// How much higher the line is at the temples than at the forehead. 0.05 is 0.4 cm on the bust.
        pub temple_recession: f32 = 0.05 => "Temples", least -0.5, most 0.5;
        /// Depth of the lower end of the sideburns, in front of the ears. 1.45 is 12.5 cm on the bust.
        pub sideburns: f32 = 1.45 => "Sideburns", least 0.0, most 2.5;
        /// Depth of the line above the ears. 0.98 is 8.5 cm on the bust.
        pub above_ears: f32 = 0.98 => "Above the ears", least 0.0, most 2.5;
        /// How much farther forward the line comes down behind the ears. It shows when hair is tied up. 0.25 is 2.2 cm
        /// on the bust.
        pub behind_ears: f32 = 0.0 => "Behind the ears", least 0.0, most 0.25;
        /// Depth of the line at the nape. 2.1 is 18 cm on the bust.
        pub nape: f32 = 2.1 => "Nape", least 0.0, most 2.8;
        /// Height of the band along the line in which hair thins out. 0.1 is 0.9 cm on the bust.
        pub fade: f32 = 0.1 => "Fade", least 0.0, most 1.0;
        /// How far the line wanders up and down, in waves of 1 to 3 cm on the bust. Raise it for a less regular
        /// hairline.
        pub wander: f32 = 0.0 => "Wander", least 0.0, most 0.3;
    }
}

impl Hairline {
    /// The line's depth at the angle `around` (rad) from the front: 0 there, pi at the back.
    pub fn depth(&self, around: f32) -> f32 {
        let temple = self.forehead - self.temple_recession;
        let before_ear = |t: f32| temple + (self.sideburns - temple) * t;
        let behind_ear = |t: f32| self.above_ears + (self.nape - self.above_ears) * t;
        // On the side of the head a radian is about one unit long.
        let forward = self.behind_ears;
        let knots = [
            (0.0, self.forehead),
            (0.61, temple),
            (0.90, before_ear(0.14)),
            (1.09, before_ear(0.50)),
            (1.20, before_ear(0.85)),
            (1.29, self.sideburns),
            (1.41, self.sideburns),
            (1.52, self.sideburns + (self.above_ears - self.sideburns) * 0.7),
            (1.62, self.above_ears),
            (1.88 - forward, self.above_ears),
            (2.10 - forward, behind_ear(0.20)),
            (2.30 - forward, behind_ear(0.55)),
            (2.50 - forward, behind_ear(0.86)),
            (2.72 - forward, self.nape),
            (PI, self.nape),
        ];
        let at = |i: usize| knots[i.min(knots.len() - 1)];
        let rise = |i: usize| (at(i + 1).1 - at(i).1) / (at(i + 1).0 - at(i).0);
        // The harmonic mean of the slopes at both sides, 0 at a turning point, never overshoots (Fritsch and
        // Butland, 1984).
        let slope = |i: usize| {
            let (a, b) = if i == 0 || i + 1 >= knots.len() { (0.0, 0.0) } else { (rise(i - 1), rise(i)) };
            if a * b > 0.0 { 2.0 * a * b / (a + b) } else { 0.0 }
        };
        let i = knots.partition_point(|k| k.0 <= around).clamp(1, knots.len() - 1) - 1;
        let width = at(i + 1).0 - at(i).0;
        let t = ((around - at(i).0) / width).clamp(0.0, 1.0);
        let (t2, t3) = (t * t, t * t * t);
        at(i).1 * (2.0 * t3 - 3.0 * t2 + 1.0)
            + at(i + 1).1 * (3.0 * t2 - 2.0 * t3)
            + width * (slope(i) * (t3 - 2.0 * t2 + t) + slope(i + 1) * (t3 - t2))
    }

    /// Height of `p` (head space, cm) above the line, in its unit. Negative where no hair grows.
    pub fn above(&self, ellipsoid: &Ellipsoid, p: Vec3) -> f32 {
        let Ellipsoid { center, half_axes } = *ellipsoid;
        let q = (p - center) / half_axes;
        let unit = 0.5 * (half_axes.x + half_axes.z);
        let depth = (center.y + half_axes.y - p.y) / unit;
        self.depth(q.z.abs().atan2(q.x)) + self.wander * waves((p - center) / unit) - depth
    }

    /// Whether hair grows at `p`; `chance` in 0..1 decides within the fading edge.
    ///
    /// More places are tried than are taken, so that hair would be as dense at a third of the chances as at all of
    /// them: with the cube it thins out visibly.
    pub(super) fn grows(&self, ellipsoid: &Ellipsoid, p: Vec3, chance: f32) -> bool {
        let above = self.above(ellipsoid, p);
        let share = if above < self.fade { above / self.fade } else { 1.0 };
        above > 0.0 && share * share * share > chance
    }
}

/// Waves of three lengths that never meet in step, within -1..1; `p` in the hairline's unit. Both sides of a head differ.
fn waves(p: Vec3) -> f32 {
    let wave = |direction: Vec3, phase: f32| (p.dot(direction) + phase).sin();
    0.5 * wave(Vec3::new(5.0, 4.0, 17.0), 1.3)
        + 0.3 * wave(Vec3::new(-21.0, 9.0, 27.0), 4.0)
        + 0.2 * wave(Vec3::new(29.0, -13.0, 47.0), 0.4)
}
