//! The hairline: a closed curve about the head, above which hair grows.

use glam::Vec3;
use serde::{Deserialize, Serialize};

use crate::SettingError;
use crate::error::check_range;

/// Where hair grows, as heights above the middle of the head ellipsoid E, so that it fits a head of any size.
///
/// Heights are angles (rad) of the direction from the centre of E, measured after scaling E to a sphere: 0 at the
/// level of the centre, pi / 2 at the top. Scene key: `hair.hairline`.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct Hairline {
    /// Height of the line over the middle of the forehead (rad, default 0.68).
    pub forehead: f32,
    /// How much higher the line stands over the temples (rad, default 0.08).
    pub temple_recession: f32,
    /// Height of the lower end of the sideburns, in front of the ears (rad, default -0.15).
    pub sideburns: f32,
    /// Height of the line above the ears (rad, default 0.15).
    pub above_ears: f32,
    /// Height of the line on the nape (rad, default -0.75).
    pub nape: f32,
    /// Width over which hair thins out at the line (rad, default 0.08).
    pub fade: f32,
}

impl Default for Hairline {
    fn default() -> Self {
        Self { forehead: 0.68, temple_recession: 0.08, sideburns: -0.15, above_ears: 0.15, nape: -0.75, fade: 0.08 }
    }
}

impl Hairline {
    /// Refuses angles that are not finite or lie outside the head.
    ///
    /// # Errors
    /// Names the first such setting.
    pub fn check(&self) -> Result<(), SettingError> {
        check_range("hair.hairline.forehead", self.forehead, -0.5, 1.5)?;
        check_range("hair.hairline.temple_recession", self.temple_recession, -0.5, 0.5)?;
        check_range("hair.hairline.sideburns", self.sideburns, -1.0, 1.0)?;
        check_range("hair.hairline.above_ears", self.above_ears, -1.0, 1.0)?;
        check_range("hair.hairline.nape", self.nape, -1.2, 1.0)?;
        check_range("hair.hairline.fade", self.fade, 0.0, 0.5)
    }

    /// The line's height (rad) at the angle `around` (rad) from the front: 0 there, pi at the back.
    pub fn height(&self, around: f32) -> f32 {
        let knots = [
            (0.0, self.forehead),
            (0.65, self.forehead + self.temple_recession),
            (1.05, 0.5 * (self.forehead + self.sideburns)),
            (1.30, self.sideburns),
            (1.42, self.sideburns),
            (1.60, self.above_ears),
            (1.95, self.above_ears),
            (2.35, 0.5 * (self.above_ears + self.nape)),
            (2.75, self.nape),
            (std::f32::consts::PI, self.nape),
        ];
        let next = knots.partition_point(|k| k.0 <= around).clamp(1, knots.len() - 1);
        let ((a, from), (b, to)) = (knots[next - 1], knots[next]);
        let t = ((around - a) / (b - a)).clamp(0.0, 1.0);
        from + (to - from) * t * t * (3.0 - 2.0 * t)
    }

    /// Whether hair grows in the direction `u` (of unit length, E scaled to a sphere); `chance` in 0..1 decides
    /// within the fading edge.
    pub(super) fn grows(&self, u: Vec3, chance: f32) -> bool {
        let above = u.y.clamp(-1.0, 1.0).asin() - self.height(u.z.abs().atan2(u.x));
        above > self.fade * chance
    }
}
