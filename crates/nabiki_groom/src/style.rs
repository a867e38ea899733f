//! Settings of a hairstyle: the table `[hair.style]` of a scene.

use nabiki::glam::{Vec2, Vec3};
use nabiki::setting::{Place, refused};
use nabiki::{Head, SettingError, settings, words};

settings! {
    /// A hairstyle: how hair leaves the scalp, how stiff and how long it is, where it is combed and cut.
    ///
    /// Lengths are in cm, directions in head space (+x where the face looks, +y up, +z to the character's right), loads in units of the
    /// hair's own weight.
    pub struct Style in "hair.style" {
        /// (E I / w)^(1/3): over about this length hair bends under its own weight.
        pub stiffness: Stiffness = Stiffness::default() => "Stiffness at rest";
        /// Length before any cut, at most `hair.segments` x `hair.segment_length`.
        pub length: Length = Length::default() => "Length";
        /// Angle between a root and the scalp: 90 is along the normal, as in the paper.
        pub lift_degrees: Lift = Lift::default() => "Lift";
        /// The line that hair is combed away from.
        pub parting: Parting = Parting::default() => "Parting";
        /// The styling force near the root.
        pub comb: Comb = Comb::default() => "Comb";
        /// Hair combed over the forehead; none by default.
        pub fringe: Fringe = Fringe::default() => "Fringe";
        /// How hair lies over hair.
        pub volume: Volume = Volume::default() => "Volume";
        /// How much the strands differ.
        pub variation: Variation = Variation::default() => "Variation";
        /// How strands keep together.
        pub clumps: Clumps = Clumps::default() => "Clumps";
        /// Curls and waves; none by default.
        pub curl: Curl = Curl::default() => "Curl";
        /// A tail that all hair but the fringe is tied to.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub ponytail: Option<Ponytail> = None => "Ponytail", open "no tail";
        /// Planes beyond which hair is cut off, in any number.
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
        /// Below it, in front of the middle of the ears or nearly so.
        Sides = "sides",
        /// Below it, behind.
        Back = "back",
        /// The hair over the forehead that is combed forward.
        Fringe = "fringe",
    }
}

impl Region {
    /// All of them; a region's place here is its number as a group of strands.
    pub const ALL: [Self; 4] = [Self::Top, Self::Sides, Self::Back, Self::Fringe];
}

macro_rules! by_region {
    ($(#[doc = $doc:literal])* $name:ident = $default:literal, $($range:tt)*) => {
        settings! {
            $(#[doc = $doc])*
            #[derive(Copy)]
            pub struct $name {
                /// On the upper third of the head; passes smoothly into `sides` and `back`.
                pub top: f32 = $default => "Top", $($range)*;
                /// Below, in front of the middle of the ears; passes smoothly into `back`.
                pub sides: f32 = $default => "Sides", $($range)*;
                /// Below, behind.
                pub back: f32 = $default => "Back", $($range)*;
                /// Of the fringe, if the style has one.
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
    /// (E I / w)^(1/3) by region. Real hair: about 4.5; combed and lying on other hair, less.
    Stiffness = 2.0, unit "cm", least 0.1, most 100.0
);
by_region!(
    /// Length by region before any cut.
    Length = 18.0, unit "cm", above 0.0
);
by_region!(
    /// Angle of the roots above the scalp by region.
    Lift = 20.0, unit "degrees", least 0.0, most 90.0
);

settings! {
    /// The parting: a line over the top of the head, straight as seen from above, from the front to the crown.
    ///
    /// Hair is combed away from the nearest point of it: to the sides along the line, all around beyond its ends.
    /// Positive z is on the character's right.
    #[derive(Copy)]
    pub struct Parting {
        /// Its front end as seen from above, (x, z); it may stop short of the hairline.
        pub front: Vec2 = Vec2::new(10.0, 0.0) => "Front", unit "cm", least -100.0, most 100.0;
        /// Its end at the crown, (x, z).
        pub crown: Vec2 = Vec2::new(-4.0, 0.0) => "Crown", unit "cm", least -100.0, most 100.0;
        /// How far it strays from the straight line, clumps and single strands alike: what grows nearer falls to either
        /// side, which keeps the line from being bare.
        pub wobble: f32 = 0.3 => "Wobble", unit "cm", least 0.0, most 5.0;
    }
}

settings! {
    /// The styling force: a load besides the weight that decays along the strand as exp(-s / decay).
    #[derive(Copy)]
    pub struct Comb {
        /// Away from the parting, level.
        pub away: f32 = 1.0 => "Away", unit "weights", least 0.0, most 1000.0;
        /// In one direction for all hair but the fringe: (-1, 0, 0) is backward.
        pub sweep: Vec3 = Vec3::ZERO => "Sweep", unit "weights", least -1000.0, most 1000.0;
        /// Backward for hair rooted in front, growing toward the forehead, which keeps the face free.
        pub off_face: f32 = 0.0 => "Off the face", unit "weights", least 0.0, most 1000.0;
        /// Length over which they fall to 1/e.
        pub decay: f32 = 6.0 => "Decay", unit "cm", above 0.0;
    }
}

settings! {
    /// Hair over the forehead: the strands rooted in a strip at the front are combed forward, past the parting's rule.
    #[derive(Copy)]
    pub struct Fringe {
        /// Half the width of the strip, about the middle of the head; 0: no fringe.
        pub half_width: f32 = 0.0 => "Half width", unit "cm", least 0.0, most 100.0;
        /// Where it ends behind, along x.
        pub from: f32 = 5.0 => "From", unit "cm", least -100.0, most 100.0;
        /// Load forward near the root.
        pub forward: f32 = 1.5 => "Forward", unit "weights", least 0.0, most 1000.0;
        /// Load along z, for a fringe swept to one side.
        pub aside: f32 = 0.0 => "Aside", unit "weights", least -1000.0, most 1000.0;
    }
}

settings! {
    /// Hair over hair: what comes from farther up lies farther out.
    #[derive(Copy)]
    pub struct Volume {
        /// Distance to the skin that hair from far above keeps.
        pub thickness: f32 = 0.8 => "Thickness", unit "cm", least 0.0, most 20.0;
        /// Length of hair on the head over which most of it is reached.
        pub reach: f32 = 6.0 => "Reach", unit "cm", above 0.0;
        /// Distance that any hair keeps.
        pub gap: f32 = 0.04 => "Gap", unit "cm", least 0.0, most 5.0;
        /// Whether hair from above passes over the ears or parts about them.
        pub over_ears: bool = true => "Over the ears";
    }
}

settings! {
    /// Differences from strand to strand, drawn from the scene's seed and the root's place.
    #[derive(Copy)]
    pub struct Variation {
        /// Largest share by which a strand falls short of its length.
        pub length: f32 = 0.06 => "Length", least 0.0, most 0.9;
        /// Relative deviation of the stiffness.
        pub stiffness: f32 = 0.15 => "Stiffness", least 0.0, most 0.3;
        /// Deviation of the direction, at the root and of the load.
        pub direction_degrees: f32 = 3.0 => "Direction", unit "degrees", least 0.0, most 45.0;
        /// Share of stray hairs, whose direction deviates four times as much.
        pub strays: f32 = 0.02 => "Strays", least 0.0, most 1.0;
        /// Deviation of the cut from its plane.
        pub cut: f32 = 0.15 => "Cut", unit "cm", least 0.0, most 10.0;
        /// Baby hair: the largest share by which a strand on the hairline falls short, and strays the more. It is as long as others from
        /// 0.2 of the hairline's unit on (1.7 cm on the bust).
        pub baby_hair: f32 = 0.0 => "Baby hair", least 0.0, most 0.95;
    }
}

settings! {
    /// Clumps: neighbours that fall together, and wave together.
    #[derive(Copy)]
    pub struct Clumps where does_not_turn_back {
        /// Width of a clump at the scalp.
        pub size: f32 = 1.2 => "Size", unit "cm", above 0.0;
        /// How far its tips draw together: 0 not at all, 1 to a point.
        pub gather: f32 = 0.4 => "Gather", least 0.0, most 1.0;
        /// Deviation of a clump's direction as a whole.
        pub direction_degrees: f32 = 2.0 => "Direction", unit "degrees", least 0.0, most 45.0;
        /// Height of its waves, at most 0.16 of their length.
        pub wave: f32 = 0.1 => "Wave", unit "cm", least 0.0;
        /// Length of its waves.
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
    /// Curls: every strand winds about the line in which it would hang without them, alike within a clump.
    ///
    /// `hair.style.length` is the hair's own, so a strand reaches the less far the more it curls, and has the same segments.
    /// Stiffness and loads are those of the curled strand as a whole, and cuts are made where its line meets the plane: its
    /// end lies within the curl's radius of that.
    #[derive(Copy)]
    pub struct Curl where winds_forward {
        /// Distance between a strand and its line, at most `pitch`; 0: no curls.
        pub radius: f32 = 0.0 => "Radius", unit "cm", least 0.0;
        /// Length of the line in one turn.
        pub pitch: f32 = 2.5 => "Pitch", unit "cm", above 0.0;
        /// Distance from the root at which curls are whole, as a share of the strand's length: from there on they have their
        /// radius, before they grow to it.
        pub from: f32 = 0.25 => "From", least 0.01, most 1.0;
        /// 0 winds to a helix, 1 waves in a plane; between them the helix is flat.
        pub flatness: f32 = 0.0 => "Flatness", least 0.0, most 1.0;
        /// How far the hair of a clump closes to one lock by `from`: 0 not at all, 1 onto one line.
        pub gather: f32 = 0.7 => "Gather", least 0.0, most 1.0;
        /// Largest share by which radius and pitch differ from clump to clump.
        pub variation: f32 = 0.2 => "Variation", least 0.0, most 0.6;
        /// The same for the radius of single strands within a clump, and for the half turn by which they may be ahead or
        /// behind.
        pub frizz: f32 = 0.15 => "Frizz", least 0.0, most 0.6;
    }
}

impl Curl {
    /// A turn is made of at least so many segments: those of a circle meet at 45 degrees then.
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

settings! {
    /// A ponytail: hair goes along the head to one place, through a band there, and falls from it.
    ///
    /// A strand too short to reach it ends on the way. `[free] tie` holds the hair there when it moves.
    #[derive(Copy)]
    pub struct Ponytail where leads_somewhere {
        /// The middle of the band, in head space, at least `radius` away from the skin.
        pub at: Vec3 = Vec3::new(-11.0, 2.0, 0.0) => "At", must "[x, y, z]", unit "cm";
        /// Radius of the hair within the band.
        pub radius: f32 = 0.9 => "Radius", unit "cm", least 0.01, most 5.0;
        /// The way that hair takes through the band, of any length but 0.
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

settings! {
    /// A cut: hair on the side of the plane that `normal` points to is taken off.
    #[derive(Copy)]
    pub struct Cut where has_a_normal {
        /// A point of the plane, in head space.
        pub point: Vec3 = Vec3::new(0.0, -18.0, 0.0) => "Point", must "[x, y, z]", unit "cm";
        /// Toward the hair taken off, of any length but 0: (0, -1, 0) cuts level.
        pub normal: Vec3 = Vec3::NEG_Y => "Normal", must "[x, y, z]";
        /// The region whose hair it cuts.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub region: Option<Region> = None => "Region", open "all";
        /// No strand is made shorter than this: in the paper's equations (6) to (8) a strand of length L feels
        /// c_k |F| = (3 dt^2 / 2 lambda) |F| / (k L^2), and a stubble would be too quick for the time step.
        pub shortest: f32 = 2.5 => "Shortest", unit "cm", above 0.0;
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
        /// Those of the straight strand, one pass, as in the paper's reference 9: for short or stiff hair.
        Straight = "straight",
        /// Those of the bent strand, the heavy elastica.
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
