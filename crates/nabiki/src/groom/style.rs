//! Settings of a hairstyle: the table `[hair.style]` of a scene.

use glam::{Vec2, Vec3};
use serde::{Deserialize, Serialize};

use crate::error::{check_positive, check_range};
use crate::{Head, SettingError};

/// A hairstyle: how hair leaves the scalp, how stiff and how long it is, where it is combed and cut.
///
/// Scene key: `hair.style`. Lengths in cm, directions in head space (+x where the face looks, +y up, +z to the
/// character's right), loads in units of the hair's own weight.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct Style {
    /// (E I / w)^(1/3): over about this length hair bends under its own weight (cm, default 2).
    pub stiffness: Stiffness,
    /// Length before any cut (cm, default 18); at most `hair.segments` x `hair.segment_length`.
    pub length: Length,
    /// Angle between a root and the scalp (degrees, default 20): 90 is along the normal, as in the paper.
    pub lift_degrees: Lift,
    /// The line that hair is combed away from.
    pub parting: Parting,
    /// The styling force near the root.
    pub comb: Comb,
    /// Hair combed over the forehead; none by default.
    pub fringe: Fringe,
    /// How hair lies over hair.
    pub volume: Volume,
    /// How much the strands differ.
    pub variation: Variation,
    /// How strands keep together.
    pub clumps: Clumps,
    /// Curls and waves; none by default.
    pub curl: Curl,
    /// A tail that all hair but the fringe is tied to; none by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ponytail: Option<Ponytail>,
    /// Planes beyond which hair is cut off, in any number.
    pub cuts: Vec<Cut>,
    /// Which lever arms bend a strand that hangs free (default "deformed").
    pub lever_arms: LeverArms,
}

/// Where on the scalp a strand is rooted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Region {
    /// The upper third of the head ellipsoid.
    Top,
    /// Below it, in front of the middle of the ears or nearly so.
    Sides,
    /// Below it, behind.
    Back,
    /// The hair over the forehead that is combed forward.
    Fringe,
}

impl Region {
    /// All of them; a region's place here is its number as a group of strands.
    pub const ALL: [Self; 4] = [Self::Top, Self::Sides, Self::Back, Self::Fringe];

    /// Its name in scenes and as a group of strands.
    pub fn name(self) -> &'static str {
        match self {
            Self::Top => "top",
            Self::Sides => "sides",
            Self::Back => "back",
            Self::Fringe => "fringe",
        }
    }
}

macro_rules! by_region {
    ($(#[$doc:meta])* $name:ident, $default:expr) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
        #[serde(deny_unknown_fields, default)]
        pub struct $name {
            /// On the upper third of the head; passes smoothly into `sides` and `back`.
            pub top: f32,
            /// Below, in front of the middle of the ears; passes smoothly into `back`.
            pub sides: f32,
            /// Below, behind.
            pub back: f32,
            /// Of the fringe, if the style has one.
            pub fringe: f32,
        }

        impl Default for $name {
            fn default() -> Self {
                Self { top: $default, sides: $default, back: $default, fringe: $default }
            }
        }

        impl $name {
            /// The values with the names of their keys.
            pub(super) fn each(&self) -> [(&'static str, f32); 4] {
                [("top", self.top), ("sides", self.sides), ("back", self.back), ("fringe", self.fringe)]
            }
        }
    };
}

by_region!(
    /// (E I / w)^(1/3) by region (cm, default 2). Real hair: about 4.5; combed and lying on other hair, less.
    Stiffness,
    2.0
);
by_region!(
    /// Length by region before any cut (cm, default 18).
    Length,
    18.0
);
by_region!(
    /// Angle of the roots above the scalp by region (degrees, default 20).
    Lift,
    20.0
);

/// The parting: a line over the top of the head, straight as seen from above, from the front to the crown.
///
/// Hair is combed away from the nearest point of it: to the sides along the line, all around beyond its ends.
/// Positive z is on the character's right.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct Parting {
    /// Its front end as seen from above, (x, z); it may stop short of the hairline (cm, default (10, 0): through it).
    pub front: Vec2,
    /// Its end at the crown, (x, z) (cm, default (-4, 0)).
    pub crown: Vec2,
    /// How far it strays from the straight line, clumps and single strands alike: what grows nearer falls to either
    /// side, which keeps the line from being bare (cm, default 0.3).
    pub wobble: f32,
}

impl Default for Parting {
    fn default() -> Self {
        Self { front: Vec2::new(10.0, 0.0), crown: Vec2::new(-4.0, 0.0), wobble: 0.3 }
    }
}

/// The styling force: a load besides the weight that decays along the strand as exp(-s / decay).
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct Comb {
    /// Away from the parting, level (times the hair's weight, default 1).
    pub away: f32,
    /// In one direction for all hair but the fringe, (-1, 0, 0) for backward (times the weight, default none).
    pub sweep: Vec3,
    /// Backward for hair rooted in front, growing toward the forehead, which keeps the face free (times the weight,
    /// default 0).
    pub off_face: f32,
    /// Length over which they fall to 1/e (cm, default 6).
    pub decay: f32,
}

impl Default for Comb {
    fn default() -> Self {
        Self { away: 1.0, sweep: Vec3::ZERO, off_face: 0.0, decay: 6.0 }
    }
}

/// Hair over the forehead: the strands rooted in a strip at the front are combed forward, past the parting's rule.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct Fringe {
    /// Half the width of the strip, about the middle of the head (cm, default 0: no fringe).
    pub half_width: f32,
    /// Where it ends behind (x, cm, default 5).
    pub from: f32,
    /// Load forward near the root (times the hair's weight, default 1.5).
    pub forward: f32,
    /// Load along z, for a fringe swept to one side (times the weight, default 0).
    pub aside: f32,
}

impl Default for Fringe {
    fn default() -> Self {
        Self { half_width: 0.0, from: 5.0, forward: 1.5, aside: 0.0 }
    }
}

/// Hair over hair: what comes from farther up lies farther out.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct Volume {
    /// Distance to the skin that hair from far above keeps (cm, default 0.8).
    pub thickness: f32,
    /// Length of hair on the head over which most of it is reached (cm, default 6).
    pub reach: f32,
    /// Distance that any hair keeps (cm, default 0.04).
    pub gap: f32,
    /// Whether hair from above passes over the ears (default true) or parts about them.
    pub over_ears: bool,
}

impl Default for Volume {
    fn default() -> Self {
        Self { thickness: 0.8, reach: 6.0, gap: 0.04, over_ears: true }
    }
}

/// Differences from strand to strand, drawn from the scene's seed and the root's place.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct Variation {
    /// Largest share by which a strand falls short of its length (default 0.06).
    pub length: f32,
    /// Relative deviation of the stiffness (default 0.15).
    pub stiffness: f32,
    /// Deviation of the direction, at the root and of the load (degrees, default 3).
    pub direction_degrees: f32,
    /// Share of stray hairs, whose direction deviates four times as much (default 0.02).
    pub strays: f32,
    /// Deviation of the cut from its plane (cm, default 0.15).
    pub cut: f32,
    /// Baby hair: the largest share by which a strand on the hairline falls short, and strays the more; it is as long as others from
    /// 0.2 of the hairline's unit on (1.7 cm on the bust) (default 0).
    pub baby_hair: f32,
}

impl Default for Variation {
    fn default() -> Self {
        Self { length: 0.06, stiffness: 0.15, direction_degrees: 3.0, strays: 0.02, cut: 0.15, baby_hair: 0.0 }
    }
}

/// Clumps: neighbours that fall together, and wave together.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct Clumps {
    /// Width of a clump at the scalp (cm, default 1.2).
    pub size: f32,
    /// How far its tips draw together: 0 not at all, 1 to a point (default 0.4).
    pub gather: f32,
    /// Deviation of a clump's direction as a whole (degrees, default 2).
    pub direction_degrees: f32,
    /// Height of its waves (cm, default 0.1).
    pub wave: f32,
    /// Length of its waves (cm, default 8).
    pub wave_length: f32,
}

impl Default for Clumps {
    fn default() -> Self {
        Self { size: 1.2, gather: 0.4, direction_degrees: 2.0, wave: 0.1, wave_length: 8.0 }
    }
}

/// Curls: every strand winds about the line in which it would hang without them, alike within a clump.
///
/// `hair.style.length` is the hair's own, so a strand reaches the less far the more it curls, and has the same segments.
/// Stiffness and loads are those of the curled strand as a whole, and cuts are made where its line meets the plane: its
/// end lies within the curl's radius of that.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct Curl {
    /// Distance between a strand and its line (cm, default 0: no curls), at most `pitch`.
    pub radius: f32,
    /// Length of the line in one turn (cm, default 2.5).
    pub pitch: f32,
    /// Distance from the root at which curls are whole, as a share of the strand's length: from there on they have their
    /// radius, before they grow to it (default 0.25).
    pub from: f32,
    /// 0 winds to a helix, 1 waves in a plane; between them the helix is flat (default 0).
    pub flatness: f32,
    /// How far the hair of a clump closes to one lock by `from`: 0 not at all, 1 onto one line (default 0.7).
    pub gather: f32,
    /// Largest share by which radius and pitch differ from clump to clump (default 0.2).
    pub variation: f32,
    /// The same for the radius of single strands within a clump, and for the half turn by which they may be ahead or
    /// behind (default 0.15).
    pub frizz: f32,
}

impl Default for Curl {
    fn default() -> Self {
        Self { radius: 0.0, pitch: 2.5, from: 0.25, flatness: 0.0, gather: 0.7, variation: 0.2, frizz: 0.15 }
    }
}

impl Curl {
    /// A turn is made of at least so many segments: those of a circle meet at 45 degrees then.
    pub const SEGMENTS_A_TURN: f32 = 8.0;

    fn check(&self) -> Result<(), SettingError> {
        check_positive("hair.style.curl.pitch", self.pitch)?;
        let range = |key: &str, value, low, high| check_range(&format!("hair.style.curl.{key}"), value, low, high);
        range("radius", self.radius, 0.0, self.pitch)?;
        range("from", self.from, 0.01, 1.0)?;
        range("flatness", self.flatness, 0.0, 1.0)?;
        range("gather", self.gather, 0.0, 1.0)?;
        range("variation", self.variation, 0.0, 0.6)?;
        range("frizz", self.frizz, 0.0, 0.6)
    }

    /// Hair of the tightest turn that chance may make (cm); none without curls.
    fn tightest_turn(&self) -> Option<f32> {
        if self.radius == 0.0 {
            return None;
        }
        let pitch = self.pitch * (1.0 - self.variation);
        let around = std::f32::consts::TAU * self.radius * (1.0 - self.variation) * (1.0 - self.frizz);
        // An ellipse is no shorter than the circle of its area, nor than there and back.
        let round = (1.0 - self.flatness).sqrt().max(std::f32::consts::FRAC_2_PI);
        Some(pitch.hypot(around * round))
    }

    /// The longest segments (cm, in whole thousandths) that draw its tightest turn; none where any will do.
    pub fn longest_segment(&self) -> Option<f32> {
        self.tightest_turn().map(|turn| (turn / Self::SEGMENTS_A_TURN * 1000.0).floor() / 1000.0)
    }

    /// Refuses segments (cm) that are too long to draw the tightest turn that chance may make.
    ///
    /// # Errors
    /// Names `hair.segment_length` and the longest that will do.
    pub fn check_segment_length(&self, segment_length: f32) -> Result<(), SettingError> {
        let (Some(turn), Some(longest)) = (self.tightest_turn(), self.longest_segment()) else { return Ok(()) };
        if segment_length <= turn / Self::SEGMENTS_A_TURN {
            return Ok(());
        }
        let remedy = format!(
            "must be at most {longest:.3}: the tightest turn of hair.style.curl takes {turn:.3} cm of hair, and no fewer than {} \
             segments show its shape",
            Self::SEGMENTS_A_TURN
        );
        Err(SettingError::new("hair.segment_length", segment_length, remedy))
    }
}

/// A ponytail: hair goes along the head to one place, through a band there, and falls from it.
///
/// A strand too short to reach it ends on the way. `[free] tie` holds the hair there when it moves.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Ponytail {
    /// The middle of the band (head space, cm), at least `radius` away from the skin.
    pub at: Vec3,
    /// Radius of the hair within the band (cm, default 0.9).
    #[serde(default = "band")]
    pub radius: f32,
    /// The way that hair takes through the band, of any length (default (-1, 0.2, 0): backward).
    #[serde(default = "backward")]
    pub direction: Vec3,
}

fn band() -> f32 {
    0.9
}

fn backward() -> Vec3 {
    Vec3::new(-1.0, 0.2, 0.0)
}

impl Ponytail {
    fn check(&self) -> Result<(), SettingError> {
        let key = |field: &str| format!("hair.style.ponytail.{field}");
        if !self.at.is_finite() {
            return Err(SettingError::new(key("at"), self.at, "must have finite coordinates"));
        }
        if self.direction.try_normalize().is_none() {
            return Err(SettingError::new(key("direction"), self.direction, "must be a direction, not of length 0"));
        }
        check_range(&key("radius"), self.radius, 0.01, 5.0)
    }

    /// Refuses a band that reaches into the head.
    ///
    /// # Errors
    /// Names its place, and says how far that is from the skin.
    pub fn check_place(&self, head: &Head) -> Result<(), SettingError> {
        let (distance, radius) = (head.distance(self.at), self.radius);
        if distance >= radius {
            return Ok(());
        }
        let remedy = format!(
            "the band reaches into the head: its middle is {distance:.2} cm from the skin and must be at least its \
             radius, {radius} cm"
        );
        Err(SettingError::new("hair.style.ponytail.at", self.at, remedy))
    }
}

/// A cut: hair on the side of the plane that `normal` points to is taken off.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Cut {
    /// A point of the plane (head space, cm).
    pub point: Vec3,
    /// Toward the hair taken off, of any length: (0, -1, 0) cuts level.
    pub normal: Vec3,
    /// The region whose hair it cuts; all regions if left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub region: Option<Region>,
    /// No strand is made shorter than this (cm, default 2.5): in the paper's equations (6) to (8) a strand of length
    /// L feels c_k |F| = (3 dt^2 / 2 lambda) |F| / (k L^2), and a stubble would be too quick for the time step.
    #[serde(default = "shortest")]
    pub shortest: f32,
}

fn shortest() -> f32 {
    2.5
}

/// The lever arms of the bending moment.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum LeverArms {
    /// Those of the straight strand, one pass, as in the paper's reference 9: for short or stiff hair.
    Straight,
    /// Those of the bent strand, the heavy elastica.
    #[default]
    Deformed,
}

impl Style {
    /// Refuses what cannot be styled.
    ///
    /// # Errors
    /// Names the first setting out of its range by its scene key, `hair.style. ...`.
    pub fn check(&self) -> Result<(), SettingError> {
        for (region, value) in self.stiffness.each() {
            check_range(&format!("hair.style.stiffness.{region}"), value, 0.1, 100.0)?;
        }
        for (region, value) in self.length.each() {
            check_positive(&format!("hair.style.length.{region}"), value)?;
        }
        for (region, value) in self.lift_degrees.each() {
            check_range(&format!("hair.style.lift_degrees.{region}"), value, 0.0, 90.0)?;
        }
        let range = |key: &str, value, low, high| check_range(&format!("hair.style.{key}"), value, low, high);
        for (end, at) in [("front", self.parting.front), ("crown", self.parting.crown)] {
            range(&format!("parting.{end} (x)"), at.x, -100.0, 100.0)?;
            range(&format!("parting.{end} (z)"), at.y, -100.0, 100.0)?;
        }
        range("parting.wobble", self.parting.wobble, 0.0, 5.0)?;
        range("comb.away", self.comb.away, 0.0, 1000.0)?;
        for (axis, value) in ["x", "y", "z"].into_iter().zip(self.comb.sweep.to_array()) {
            range(&format!("comb.sweep ({axis})"), value, -1000.0, 1000.0)?;
        }
        range("comb.off_face", self.comb.off_face, 0.0, 1000.0)?;
        check_positive("hair.style.comb.decay", self.comb.decay)?;
        range("fringe.half_width", self.fringe.half_width, 0.0, 100.0)?;
        range("fringe.from", self.fringe.from, -100.0, 100.0)?;
        range("fringe.forward", self.fringe.forward, 0.0, 1000.0)?;
        range("fringe.aside", self.fringe.aside, -1000.0, 1000.0)?;
        range("volume.thickness", self.volume.thickness, 0.0, 20.0)?;
        check_positive("hair.style.volume.reach", self.volume.reach)?;
        range("volume.gap", self.volume.gap, 0.0, 5.0)?;
        range("variation.length", self.variation.length, 0.0, 0.9)?;
        range("variation.stiffness", self.variation.stiffness, 0.0, 0.3)?;
        range("variation.direction_degrees", self.variation.direction_degrees, 0.0, 45.0)?;
        range("variation.strays", self.variation.strays, 0.0, 1.0)?;
        range("variation.cut", self.variation.cut, 0.0, 10.0)?;
        range("variation.baby_hair", self.variation.baby_hair, 0.0, 0.95)?;
        check_positive("hair.style.clumps.size", self.clumps.size)?;
        range("clumps.gather", self.clumps.gather, 0.0, 1.0)?;
        range("clumps.direction_degrees", self.clumps.direction_degrees, 0.0, 45.0)?;
        check_positive("hair.style.clumps.wave_length", self.clumps.wave_length)?;
        // Steeper than this a wave would turn hair back on itself.
        range("clumps.wave", self.clumps.wave, 0.0, 0.16 * self.clumps.wave_length)?;
        self.curl.check()?;
        self.ponytail.map_or(Ok(()), |tail| tail.check())?;
        for (i, cut) in self.cuts.iter().enumerate() {
            let key = |field: &str| format!("hair.style.cuts[{i}].{field}");
            if !cut.point.is_finite() {
                return Err(SettingError::new(key("point"), cut.point, "must have finite coordinates"));
            }
            if cut.normal.try_normalize().is_none() {
                return Err(SettingError::new(key("normal"), cut.normal, "must be a direction, not of length 0"));
            }
            check_positive(&key("shortest"), cut.shortest)?;
        }
        Ok(())
    }
}
