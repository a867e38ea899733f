//! Summary of a hair file.

use std::fmt;

use glam::Vec3;
use nabiki::Hair;
use nabiki::hair::{Other, Per, Role};
use nabiki_exchange::attributes::type_name;
use serde::Serialize;

use super::measure::{Box3, Guess, Spread, guess_unit};
use crate::hair::{held_at_both_ends, length};
use crate::screen::OneLine;

/// Strands and their properties, in the file's unit.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct HairInfo {
    /// Number of strands.
    pub strands: usize,
    /// Number of points of all strands.
    pub points: usize,
    /// Smallest and largest number of segments of a strand; 0 without strands.
    pub segments: [usize; 2],
    /// Bounding box of all points.
    pub bounds: Box3,
    /// Arc length of the strands.
    pub strand_length: Spread,
    /// Length of the segments.
    pub segment_length: Spread,
    /// Segments of length 0.
    pub zero_segments: usize,
    /// Strands of length 0.
    pub empty_strands: usize,
    /// Strands whose tips are fixed as well as their roots. The motion lets these tips swing.
    pub held_at_both_ends: usize,
    /// Names of the attributes.
    pub attributes: Vec<&'static str>,
    /// Attributes that are only passed on.
    pub carried: Vec<Carried>,
    /// Phrases about data of the strands that is not read.
    pub unread: Vec<String>,
    /// A guess at unit and axis, assuming a person's hair; `None` if they are declared.
    #[serde(flatten)]
    pub guess: Option<Guess>,
}

impl HairInfo {
    /// Summarises `hair`.
    pub fn of(hair: &Hair) -> Self {
        let strands = &hair.strands;
        let lengths: Vec<f32> = strands.iter().map(length).collect();
        let segments: Vec<f32> =
            strands.iter().flat_map(|strand| strand.windows(2).map(|w| w[0].distance(w[1]))).collect();
        let counts = || strands.iter().map(|strand| strand.len().saturating_sub(1));
        let (fewest, most) = (counts().min().unwrap_or(0), counts().max().unwrap_or(0));
        let bounds = Box3::of(strands.points());
        Self {
            strands: strands.len(),
            points: strands.points().len(),
            segments: [fewest, most],
            zero_segments: segments.iter().filter(|&&length| length == 0.0).count(),
            empty_strands: lengths.iter().filter(|&&length| length == 0.0).count(),
            strand_length: Spread::of(lengths),
            segment_length: Spread::of(segments),
            held_at_both_ends: held_at_both_ends(hair),
            attributes: attributes(hair),
            carried: hair.attributes.other.iter().map(Carried::of).collect(),
            unread: hair.attributes.unread.clone(),
            // A crop to hair down to the knees.
            guess: (!strands.is_empty())
                .then(|| Guess { likely_unit: guess_unit(bounds.diagonal(), 15.0, 140.0), likely_up: up(hair) }),
            bounds,
        }
    }
}

/// An attribute that is only passed on, as in the file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct Carried {
    /// Its name.
    pub name: String,
    /// Its type, with the number of components if there are several: `half`, `float3`.
    #[serde(rename = "type")]
    pub type_name: String,
    /// The meaning of its numbers, if they have one: `colour`.
    pub role: Option<&'static str>,
    /// What each value belongs to: `constant` for the groom, `uniform` for a strand, `vertex` for a point.
    pub interpolation: &'static str,
    /// Number of values.
    pub length: usize,
}

impl Carried {
    fn of(other: &Other) -> Self {
        let name = type_name(other.stored);
        let role = match other.role {
            Role::Plain => None,
            Role::Colour => Some("colour"),
            Role::Point => Some("point"),
            Role::Vector => Some("vector"),
            Role::Normal => Some("normal"),
            Role::TextureCoordinate => Some("texture coordinates"),
        };
        let interpolation = match other.per {
            Per::Groom => "constant",
            Per::Strand => "uniform",
            Per::Point => "vertex",
        };
        Self {
            name: other.name.clone(),
            type_name: if other.extent == 1 { name.to_owned() } else { format!("{name}{}", other.extent) },
            role,
            interpolation,
            length: other.values.len() / other.extent.max(1),
        }
    }
}

impl fmt::Display for Carried {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", OneLine(&self.name), self.type_name)?;
        if let Some(role) = self.role {
            write!(f, " ({role})")?;
        }
        write!(f, ", {}, {} values", self.interpolation, self.length)
    }
}

fn attributes(hair: &Hair) -> Vec<&'static str> {
    let a = &hair.attributes;
    let all = [
        (a.id.is_some(), "strand ids"),
        (a.root_uv.is_some(), "root UVs"),
        (a.group.is_some(), "groups"),
        (a.guide.is_some(), "guide flags"),
        (a.width.is_some(), "widths"),
        (a.colour.is_some(), "colours"),
        (a.transparency.is_some(), "transparencies"),
        (a.point_uv.is_some(), "point UVs"),
        (a.inverse_mass.is_some(), "held points"),
        (a.constant.width.is_some(), "one width"),
        (a.constant.colour.is_some(), "one colour"),
        (a.constant.transparency.is_some(), "one transparency"),
    ];
    all.into_iter().filter(|&(there, _)| there).map(|(_, name)| name).collect()
}

/// Against the mean direction from root to tip, if that is clearly along y or z: no tool in use has x for up.
fn up(hair: &Hair) -> Option<&'static str> {
    let chords = hair.strands.iter().filter_map(|strand| (*strand.last()? - *strand.first()?).try_normalize());
    let mean = chords.fold(Vec3::ZERO, |sum, chord| sum + chord) / hair.strands.len() as f32;
    let axis = mean.abs().max_position();
    let others = mean.abs()[(axis + 1) % 3].max(mean.abs()[(axis + 2) % 3]);
    let clear = mean[axis].abs() > 0.3 && mean[axis].abs() > 2.0 * others;
    let name = [[None, None], [Some("-y"), Some("+y")], [Some("-z"), Some("+z")]][axis];
    name[usize::from(mean[axis] < 0.0)].filter(|_| clear)
}

impl fmt::Display for HairInfo {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.strands > 0 {
            self.shape(f)?;
        } else {
            write!(f, "hair: 0 strands")?;
        }
        for carried in &self.carried {
            write!(f, "\npassed on: {carried}")?;
        }
        for unread in &self.unread {
            write!(f, "\nnot read: {}", OneLine(unread))?;
        }
        match self.guess {
            Some(guess) => write!(f, "\n{guess}"),
            None => Ok(()),
        }
    }
}

impl HairInfo {
    fn shape(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [fewest, most] = self.segments;
        let of = if fewest == most { format!("{most}") } else { format!("{fewest} to {most}") };
        writeln!(f, "hair: {} strands of {of} segments, {} points", self.strands, self.points)?;
        writeln!(f, "box: {}", self.bounds)?;
        writeln!(f, "strand length: {}", self.strand_length)?;
        writeln!(f, "segment length: {}", self.segment_length)?;
        writeln!(f, "degenerate: {} zero segments, {} strands without extent", self.zero_segments, self.empty_strands)?;
        if self.held_at_both_ends > 0 {
            writeln!(f, "held: {} strands at both ends; here their tips swing freely", self.held_at_both_ends)?;
        }
        let carried = if self.attributes.is_empty() { "nothing".to_owned() } else { self.attributes.join(", ") };
        write!(f, "beside the points: {carried}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hair_that_clearly_hangs_tells_which_way_is_up() {
        let guess = |tips: &[[f32; 3]]| {
            let mut strands = nabiki::Strands::default();
            tips.iter().for_each(|&tip| strands.push([Vec3::ZERO, tip.into()]));
            up(&Hair::from(strands))
        };
        for (tip, up) in [
            ([1.0, -5.0, 0.0], Some("+y")),
            ([1.0, 5.0, 0.0], Some("-y")),
            ([0.0, 1.0, -5.0], Some("+z")),
            ([0.0, 1.0, 5.0], Some("-z")),
            // No tool has x for up; a slant tells nothing.
            ([-5.0, 0.0, 1.0], None),
            ([0.0, -3.0, -2.0], None),
        ] {
            assert_eq!(guess(&[tip]), up, "{tip:?}");
        }
        // Hair that stands on end all round.
        assert_eq!(guess(&[[0.0, -1.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]]), None);
    }

    #[test]
    fn of_no_strands_nothing_is_measured() {
        let mut hair = Hair::default();
        hair.attributes.unread = vec!["material:binding".to_owned()];
        let info = HairInfo::of(&hair);
        assert_eq!(info.to_string(), "hair: 0 strands\nnot read: material:binding");
        assert_eq!((info.segments, info.bounds.max, info.guess), ([0, 0], [0.0; 3], None));
    }
}
