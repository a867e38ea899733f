//! Settings of a hairstyle: the table `[hair.style]` of a scene.

use nabiki::glam::{Vec2, Vec3};
use nabiki::setting::{Place, refused};
use nabiki::{Head, SettingError, settings, words};

settings! {
    /// A hairstyle: how hair leaves the scalp, its stiffness and length, and where it is combed and cut.
    ///
    /// Lengths are in cm. Directions are in head space: +x where the face looks, +y up, +z to the character's right.
    /// Loads are in units of the hair's own weight.
    pub struct Style in "hair.style" {
        /// Length over which hair bends under its own weight: (E I / w)^(1/3).
        pub stiffness: Stiffness = Stiffness::default() => "Stiffness at rest";
        /// Length before any cut, at most `hair.segments` x `hair.segment_length`.
        pub length: Length = Length::default() => "Length";
        /// Angle between root and scalp. 90 is along the normal, as in the paper.
        pub lift_degrees: Lift = Lift::default() => "Lift";
        /// The line that hair is combed away from.
        pub parting: Parting = Parting::default() => "Parting";
        /// The styling force near the root.
        pub comb: Comb = Comb::default() => "Comb";
        /// Hair combed over the forehead. Off by default.
        pub fringe: Fringe = Fringe::default() => "Fringe";
        /// How hair lies over other hair.
        pub volume: Volume = Volume::default() => "Volume";
        /// How much strands differ.
        pub variation: Variation = Variation::default() => "Variation";
        /// How strands keep together.
        pub clumps: Clumps = Clumps::default() => "Clumps";
        /// Curls and waves. Off by default.
        pub curl: Curl = Curl::default() => "Curl";
        /// A ponytail that ties all hair except the fringe.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub ponytail: Option<Ponytail> = None => "Ponytail", open "no tail";
        /// Any number of planes that cut off the hair beyond them.
        pub cuts: Vec<Cut> = Vec::new() => "Cuts";
        /// Which lever arms bend a strand that hangs free.
        pub lever_arms: LeverArms = LeverArms::Deformed => "Lever arms";
    }
}

words! {
    /// Where on the scalp a strand is rooted.
    pub enum Region {
        /// The upper third of the head ellipsoid.
        Top = "top",
        /// Below the top, in front of about the middle of the ears.
        Sides = "sides",
        /// Below the top, behind the ears.
        Back = "back",
        /// The hair over the forehead that is combed forward.
        Fringe = "fringe",
    }
}

impl Region {
    /// All regions. The index of a region here is its group number of strands.
    pub const ALL: [Self; 4] = [Self::Top, Self::Sides, Self::Back, Self::Fringe];
}

macro_rules! by_region {
    ($(#[doc = $doc:literal])* $name:ident = $default:literal, $($range:tt)*) => {
        settings! {
            $(#[doc = $doc])*
            #[derive(Copy)]
            pub struct $name {
                /// Value on the upper third of the head. It blends smoothly into `sides` and `back`.
                pub top: f32 = $default => "Top", $($range)*;
                /// Value below the top, in front of the middle of the ears. It blends smoothly into `back`.
                pub sides: f32 = $default => "Sides", $($range)*;
                /// Value below the top, behind the ears.
                pub back: f32 = $default => "Back", $($range)*;
                /// Value of the fringe, if the style has one.
                pub fringe: f32 = $default => "Fringe", $($range)*;
            }
        }

        impl $name {
            /// The values in the order of [`Region::ALL`].
            pub(crate) fn each(&self) -> [f32; 4] {
                [self.top, self.sides, self.back, self.fringe]
            }
        }
    };
}

by_region!(
    /// Bending length (E I / w)^(1/3) by region. Raise it for hair that stands off more. Real hair has about 4.5 cm; combed
    /// hair that lies on other hair has less.
    Stiffness = 2.0, unit "cm", least 0.1, most 100.0
);
by_region!(
    /// Length by region, before any cut.
    Length = 18.0, unit "cm", above 0.0
);
by_region!(
    /// Angle of the roots above the scalp, by region.
    Lift = 20.0, unit "degrees", least 0.0, most 90.0
);

settings! {
    /// The parting: a line over the top of the head from the front to the crown, straight as seen from above.
    ///
    /// Hair is combed away from the nearest point of the line: to the sides along it, in all directions beyond its
    /// ends. Positive z is on the character's right.
    #[derive(Copy)]
    pub struct Parting {
        /// Front end of the line as seen from above, (x, z). It may lie behind the hairline.
        pub front: Vec2 = Vec2::new(10.0, 0.0) => "Front", unit "cm", least -100.0, most 100.0;
        /// End of the line at the crown, (x, z).
        pub crown: Vec2 = Vec2::new(-4.0, 0.0) => "Crown", unit "cm", least -100.0, most 100.0;
        /// How far the parting strays from the straight line, by clumps and single strands. Raise it to hide a bare
        /// line: hair that grows nearer falls to either side.
        pub wobble: f32 = 0.3 => "Wobble", unit "cm", least 0.0, most 5.0;
    }
}

settings! {
    /// The styling force. It acts in addition to weight and decays along the strand as exp(-s / decay).
    #[derive(Copy)]
    pub struct Comb {
        /// Load away from the parting, horizontally.
        pub away: f32 = 1.0 => "Away", unit "weights", least 0.0, most 1000.0;
        /// Load in one direction for all hair except the fringe. (-1, 0, 0) is backward.
        pub sweep: Vec3 = Vec3::ZERO => "Sweep", unit "weights", least -1000.0, most 1000.0;
        /// Backward load on hair rooted in front, strongest at the forehead. Raise it to keep the face free.
        pub off_face: f32 = 0.0 => "Off the face", unit "weights", least 0.0, most 1000.0;
        /// Length over which these loads fall to 1/e.
        pub decay: f32 = 6.0 => "Decay", unit "cm", above 0.0;
    }
}

settings! {
    /// Hair over the forehead. Strands rooted in a strip at the front are combed forward instead of away from the
    /// parting.
    #[derive(Copy)]
    pub struct Fringe {
        /// Half the width of the strip, centred on the head. 0 makes no fringe.
        pub half_width: f32 = 0.0 => "Half width", unit "cm", least 0.0, most 100.0;
        /// Rear edge of the strip along x.
        pub from: f32 = 5.0 => "Rear edge", unit "cm", least -100.0, most 100.0;
        /// Forward load near the root.
        pub forward: f32 = 1.5 => "Forward", unit "weights", least 0.0, most 1000.0;
        /// Load along z near the root. Raise it to sweep the fringe to one side.
        pub aside: f32 = 0.0 => "Sideways", unit "weights", least -1000.0, most 1000.0;
    }
}

settings! {
    /// Hair over hair: hair from farther up lies farther out.
    #[derive(Copy)]
    pub struct Volume {
        /// Distance from the skin that hair from far above keeps.
        pub thickness: f32 = 0.8 => "Thickness", unit "cm", least 0.0, most 20.0;
        /// Length of hair on the head over which most of `thickness` is reached.
        pub reach: f32 = 6.0 => "Reach", unit "cm", above 0.0;
        /// Distance from the skin that all hair keeps.
        pub gap: f32 = 0.04 => "Gap", unit "cm", least 0.0, most 5.0;
        /// Whether hair from above passes over the ears instead of parting around them.
        pub over_ears: bool = true => "Over the ears";
    }
}

settings! {
    /// Random differences between strands. They depend on the scene's seed and the place of the root.
    #[derive(Copy)]
    pub struct Variation {
        /// Largest share by which a strand is shorter than `length`.
        pub length: f32 = 0.06 => "Length", least 0.0, most 0.9;
        /// Standard deviation of the stiffness, relative to its value.
        pub stiffness: f32 = 0.15 => "Stiffness", least 0.0, most 0.3;
        /// Standard deviation of the direction, at the root and of the load.
        pub direction_degrees: f32 = 3.0 => "Direction", unit "degrees", least 0.0, most 45.0;
        /// Share of stray hairs. Their direction varies four times as much.
        pub strays: f32 = 0.02 => "Strays", least 0.0, most 1.0;
        /// Standard deviation of the cut from its plane.
        pub cut: f32 = 0.15 => "Cut", unit "cm", least 0.0, most 10.0;
        /// Largest share by which a strand at the hairline is shorter; it also strays more. Hair has its full length
        /// from 0.2 of the unit of the hairline on (1.7 cm on the bust).
        pub baby_hair: f32 = 0.0 => "Baby hair", least 0.0, most 0.95;
    }
}

settings! {
    /// Clumps: neighbouring strands that fall and wave together.
    #[derive(Copy)]
    pub struct Clumps where does_not_turn_back {
        /// Width of a clump at the scalp.
        pub size: f32 = 1.2 => "Size", unit "cm", above 0.0;
        /// How far the tips of a clump draw together, from 0 (not at all) to 1 (to a point).
        pub gather: f32 = 0.4 => "Gather", least 0.0, most 1.0;
        /// Standard deviation of the direction of each clump.
        pub direction_degrees: f32 = 2.0 => "Direction", unit "degrees", least 0.0, most 45.0;
        /// Height of the waves of a clump, at most 0.16 of their length.
        pub wave: f32 = 0.1 => "Wave", unit "cm", least 0.0;
        /// Length of the waves of a clump.
        pub wave_length: f32 = 8.0 => "Wave length", unit "cm", above 0.0;
    }
}

impl Clumps {
    /// Refuses waves so steep that they would turn hair back on itself.
    fn does_not_turn_back(&self, at: &Place) -> Result<(), SettingError> {
        check_most(&at.key("wave"), self.wave, 0.16 * self.wave_length)
    }
}

/// Refuses a number above `most`, which another setting gives.
fn check_most(at: &Place, value: f32, most: f32) -> Result<(), SettingError> {
    if value <= most { Ok(()) } else { refused(at, value, format!("must lie in 0..{most}")) }
}

settings! {
    /// Curls: each strand winds around the line that it would follow without curls, alike within a clump.
    ///
    /// A strand keeps the length of `hair.style.length` and its segments, so it reaches less far the more it curls.
    /// Stiffness and loads act on the curled strand. A cut acts where the line meets the plane, so the end of the
    /// strand lies within the curl's radius of it.
    #[derive(Copy)]
    pub struct Curl where winds_forward {
        /// Distance between a strand and its line, at most `pitch`. 0 makes no curls.
        pub radius: f32 = 0.0 => "Radius", unit "cm", least 0.0;
        /// Length of the line per turn.
        pub pitch: f32 = 2.5 => "Pitch", unit "cm", above 0.0;
        /// Distance from the root at which curls reach their full radius, as a share of the strand's length.
        pub from: f32 = 0.25 => "Full from", least 0.01, most 1.0;
        /// 0 winds a helix, 1 waves in a plane. Values in between flatten the helix.
        pub flatness: f32 = 0.0 => "Flatness", least 0.0, most 1.0;
        /// How far the hair of a clump closes to one lock by `from`, from 0 (not at all) to 1 (onto one line).
        pub gather: f32 = 0.7 => "Gather", least 0.0, most 1.0;
        /// Largest share by which radius and pitch differ between clumps.
        pub variation: f32 = 0.2 => "Variation", least 0.0, most 0.6;
        /// Largest share by which the radius differs between strands of a clump. It also shifts strands along the curl,
        /// by up to half a turn at 1.
        pub frizz: f32 = 0.15 => "Frizz", least 0.0, most 0.6;
    }
}

impl Curl {
    /// Least number of segments in a turn. The segments of a circle then meet at 45 degrees.
    pub const SEGMENTS_A_TURN: f32 = 8.0;

    fn winds_forward(&self, at: &Place) -> Result<(), SettingError> {
        check_most(&at.key("radius"), self.radius, self.pitch)
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

    /// The longest segments (cm, in whole thousandths) that can follow the tightest turn. `None` if any length can.
    pub fn longest_segment(&self) -> Option<f32> {
        self.tightest_turn().map(|turn| (turn / Self::SEGMENTS_A_TURN * 1000.0).floor() / 1000.0)
    }

    /// Refuses segments (cm) that are too long for the tightest turn that the random variation may produce.
    ///
    /// # Errors
    /// Names `hair.segment_length` and the largest valid value.
    pub fn check_segment_length(&self, segment_length: f32) -> Result<(), SettingError> {
        let (Some(turn), Some(longest)) = (self.tightest_turn(), self.longest_segment()) else { return Ok(()) };
        if segment_length <= turn / Self::SEGMENTS_A_TURN {
            return Ok(());
        }
        let remedy = format!(
            "must be at most {longest:.3}: the tightest turn of hair.style.curl takes {turn:.3} cm of hair and needs at \
             least {} segments",
            Self::SEGMENTS_A_TURN
        );
        Err(SettingError::new("hair.segment_length", segment_length, remedy))
    }
}

settings! {
    /// A ponytail: hair runs along the head to a band, passes through it and falls from there.
    ///
    /// A strand too short to reach the band ends on the way. To hold the hair there when it moves, add `[free.tie]`.
    #[derive(Copy)]
    pub struct Ponytail where leads_somewhere {
        /// Middle of the band in head space, at least `radius` away from the skin.
        pub at: Vec3 = Vec3::new(-11.0, 2.0, 0.0) => "Position", must "[x, y, z]", unit "cm";
        /// Radius of the hair within the band.
        pub radius: f32 = 0.9 => "Radius", unit "cm", least 0.01, most 5.0;
        /// Direction of the hair through the band. Any length except 0.
        pub direction: Vec3 = Vec3::new(-1.0, 0.2, 0.0) => "Direction";
    }
}

impl Ponytail {
    fn leads_somewhere(&self, at: &Place) -> Result<(), SettingError> {
        check_direction(&at.key("direction"), self.direction)
    }

    /// Refuses a band that reaches into the head.
    ///
    /// # Errors
    /// Names its position and its distance from the skin.
    pub fn check_place(&self, head: &Head) -> Result<(), SettingError> {
        let (distance, radius) = (head.distance(self.at), self.radius);
        if distance >= radius {
            return Ok(());
        }
        let remedy = format!(
            "the band reaches into the head: its middle is {distance:.2} cm from the skin, but must be at least its \
             radius, {radius} cm"
        );
        Err(SettingError::new("hair.style.ponytail.at", self.at, remedy))
    }
}

settings! {
    /// A cut. It removes the hair on the side of the plane that `normal` points to.
    #[derive(Copy)]
    pub struct Cut where has_a_normal {
        /// A point of the plane, in head space.
        pub point: Vec3 = Vec3::new(0.0, -18.0, 0.0) => "Point", must "[x, y, z]", unit "cm";
        /// Direction toward the removed hair. Any length except 0; (0, -1, 0) cuts horizontally.
        pub normal: Vec3 = Vec3::NEG_Y => "Normal", must "[x, y, z]";
        /// The region whose hair is cut.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub region: Option<Region> = None => "Region", open "all";
        /// Minimum length of a strand after the cut. Very short strands swing too fast for the time step: by the
        /// paper's equations (6) to (8), a strand of length L feels c_k |F| = (3 dt^2 / 2 lambda) |F| / (k L^2).
        pub shortest: f32 = 2.5 => "Minimum length", unit "cm", above 0.0;
    }
}

impl Cut {
    fn has_a_normal(&self, at: &Place) -> Result<(), SettingError> {
        check_direction(&at.key("normal"), self.normal)
    }
}

fn check_direction(at: &Place, direction: Vec3) -> Result<(), SettingError> {
    match direction.try_normalize() {
        Some(_) => Ok(()),
        None => refused(at, direction, "must be a direction, not of length 0"),
    }
}

words! {
    /// The lever arms of the bending moment.
    pub enum LeverArms = Deformed {
        /// Lever arms of the straight strand, in one pass, as in the paper's reference 9. For short or stiff hair.
        Straight = "straight",
        /// Lever arms of the bent strand: the heavy elastica.
        Deformed = "deformed",
    }
}

#[cfg(test)]
mod tests {
    use super::Style;
    use crate::Hairline;

    #[test]
    fn a_default_is_in_its_range() {
        assert_eq!(Style::default().check(), Ok(()));
        assert_eq!(Hairline::default().check(), Ok(()));
    }
}
