//! Regions: hair that moves differently from the rest, such as a fringe that stays.
//!
//! How much a strand belongs to a region depends only on its root, so a preview has the regions of all the hair.

use std::sync::Arc;

use glam::{DVec3, Vec3};

use crate::error::SettingError;
use crate::locks::Own;
use crate::setting::{Place, refused};
use crate::settings;
use crate::smoothing::rise;

/// The farthest that a region reaches (cm).
const FARTHEST: f64 = 1000.0;
/// The largest factor.
const MOST: f64 = 10.0;

settings! {
    /// Hair that moves differently from the rest, such as a fringe that stays in the wind.
    ///
    /// A strand belongs to the region by its group, by an attribute of the hair, or if its root is near a point or line;
    /// with several of these, by all of them. Each factor multiplies a setting of `[free]`. Where regions overlap, their
    /// factors multiply.
    pub struct Region where reaches_hair {
        /// Name of the region, for `info`.
        pub name: String = String::new() => "Name";
        /// Groups of hair: only strands of these groups belong to it. Grown hair has the groups "top", "sides", "back"
        /// and "fringe"; hair from a file has those of the file.
        #[serde(skip_serializing_if = "Vec::is_empty")]
        pub groups: Vec<String> = Vec::new() => "Groups";
        /// Attribute of the hair in its file, such as a painted weight: one number per strand or point, of which that of
        /// the root counts. It is how much the strand belongs to the region: 0 not at all, 1 fully.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub attribute: Option<String> = None => "Attribute", open "none";
        /// Where the region is, in the space of the head at rest.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub near: Option<Vec3> = None => "Near", unit "cm", least -FARTHEST, most FARTHEST, open "everywhere";
        /// End of the line that the region lies along, such as the other end of a parting.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub to: Option<Vec3> = None => "To", unit "cm", least -FARTHEST, most FARTHEST, open "a point, not a line";
        /// Distance up to which roots belong to it fully.
        pub within: f32 = 4.0 => "Within", unit "cm", least 0.0, most FARTHEST;
        /// Width of its border. Across it, the factors fade to 1.
        pub soft: f32 = 2.0 => "Soft", unit "cm", least 0.0, most FARTHEST;
        /// Factor on `free.stiffness`.
        pub stiffness: f32 = 1.0 => "Stiffness", least 0.0, most MOST;
        /// Factor on `free.hold`.
        pub hold: f32 = 1.0 => "Hold", least 0.0, most MOST;
        /// Factor on `free.settle`: at 2, hair swings twice as long.
        pub settle: f32 = 1.0 => "Settle", least 0.01, most MOST;
        /// Factor on the forces of all fields. At 0, no wind moves the hair.
        pub wind: f32 = 1.0 => "Wind", least 0.0, most MOST;
        /// Factor on `free.drag`.
        pub drag: f32 = 1.0 => "Drag", least 0.0, most MOST;
    }
}

impl Region {
    /// Whether the hair itself determines what belongs to the region, by its groups or an attribute. Such a region needs
    /// [`Members`].
    pub fn has_members(&self) -> bool {
        !self.groups.is_empty() || self.attribute.is_some()
    }

    /// How much a strand with this root (head space at rest, cm) belongs to the region by its place: 1 inside, 0 outside,
    /// and 1 - 3 x^2 + 2 x^3 at a share x of the border's width. 1 everywhere without `near`.
    pub fn weight(&self, root: Vec3) -> f64 {
        let Some(near) = self.near.map(|near| near.as_dvec3()) else { return 1.0 };
        let root = root.as_dvec3();
        let line = self.to.map_or(DVec3::ZERO, |to| to.as_dvec3() - near);
        let along = ((root - near).dot(line) / line.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        let beyond = root.distance(near + along * line) - f64::from(self.within);
        match f64::from(self.soft) {
            _ if beyond <= 0.0 => 1.0,
            soft if beyond < soft => 1.0 - rise(beyond / soft),
            _ => 0.0,
        }
    }

    /// Multiplies what is a strand's own by the factors of the region, to which it belongs by this weight.
    pub(crate) fn change(&self, own: &mut Own, weight: f64) {
        if weight == 0.0 {
            return;
        }
        let factor = |factor: f32| (f64::from(factor) - 1.0).mul_add(weight, 1.0);
        own.stiffness *= factor(self.stiffness);
        own.hold *= factor(self.hold);
        own.settle *= factor(self.settle);
        own.wind *= factor(self.wind);
        own.drag *= factor(self.drag);
    }

    /// Refuses a region of no hair in particular, a line without a length, and a place that no root can be in.
    fn reaches_hair(&self, at: &Place) -> Result<(), SettingError> {
        let Some(near) = self.near else {
            return match self.to {
                Some(to) => refused(&at.key("to"), to, "is the end of a line that begins at near: add near"),
                None if self.has_members() => Ok(()),
                None => Err(SettingError::new(&at.key("near"), "", "is missing: give near, groups or attribute")),
            };
        };
        if let Some(to) = self.to.filter(|&to| to == near) {
            return refused(&at.key("to"), to, "must differ from near: leave it out for a region around a point");
        }
        if self.within + self.soft == 0.0 {
            return refused(&at.key("within"), self.within, "the region reaches no hair: give within or soft a width");
        }
        Ok(())
    }
}

/// How much the strands of some hair belong to a region, for regions by group or attribute. Strands are known by their
/// roots, so a subset of the hair has the same members.
#[derive(Clone, Debug, PartialEq)]
pub struct Members(Arc<[(Bits, f32)]>);

/// The bits of a root's coordinates.
type Bits = [u32; 3];

impl Members {
    /// Members by their roots (head space at rest, cm), with weights from 0 to 1. Of strands with the same root, the
    /// largest weight counts.
    pub fn new(of: impl IntoIterator<Item = (Vec3, f32)>) -> Self {
        let mut of: Vec<(Bits, f32)> = of.into_iter().map(|(root, weight)| (bits(root), weight)).collect();
        of.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(b.1.total_cmp(&a.1)));
        of.dedup_by_key(|of| of.0);
        Self(of.into())
    }

    /// How much the strand with this root belongs to the region; 0 for a root that was not given.
    pub fn weight(&self, root: Vec3) -> f64 {
        let root = bits(root);
        self.0.binary_search_by_key(&root, |of| of.0).map_or(0.0, |i| self.0[i].1.into())
    }

    /// Coordinates of each root and its weight, in an order that depends only on the roots.
    pub fn numbers(&self) -> impl Iterator<Item = f32> {
        self.0.iter().flat_map(|&([x, y, z], weight)| [x, y, z].map(f32::from_bits).into_iter().chain([weight]))
    }
}

/// -0 is 0.
fn bits(root: Vec3) -> Bits {
    (root + Vec3::ZERO).to_array().map(f32::to_bits)
}

#[cfg(test)]
mod tests {
    use super::*;

    const NEAR: Vec3 = Vec3::new(1.0, 2.0, 3.0);

    fn region() -> Region {
        Region { near: Some(NEAR), within: 2.0, soft: 4.0, hold: 3.0, wind: 0.0, ..Region::default() }
    }

    #[test]
    fn a_region_is_full_inside_and_fades_to_nothing_over_its_border() {
        let at = |far: f32| region().weight(NEAR + far * Vec3::Y);
        assert_eq!([at(0.0), at(2.0), at(4.0), at(6.0), at(9.0)], [1.0, 1.0, 0.5, 0.0, 0.0]);
        // The steepest slope of the border is 1.5 widths.
        for i in 0..100 {
            let (a, b) = (at(1.9 + 0.042 * i as f32), at(1.942 + 0.042 * i as f32));
            assert!(b <= a && a - b <= 1.5 / 4.0 * 0.042 * (1.0 + 1e-4), "{i}: {a} {b}");
        }
    }

    #[test]
    fn a_line_has_the_same_region_all_along() {
        let along = Region { to: Some(Vec3::new(9.0, 2.0, 3.0)), ..region() };
        for x in [1.0, 4.0, 9.0] {
            assert_eq!(along.weight(Vec3::new(x, 6.0, 3.0)), 0.5);
        }
        assert_eq!(along.weight(Vec3::new(13.0, 2.0, 3.0)), 0.5);
        assert_eq!(along.weight(Vec3::new(-3.0, 2.0, 3.0)), 0.5);
    }

    #[test]
    fn factors_fade_with_the_weight_and_multiply_where_regions_overlap() {
        let mut own = Own::default();
        region().change(&mut own, 0.5);
        assert_eq!((own.hold, own.wind, own.stiffness), (2.0, 0.5, 1.0));
        region().change(&mut own, 0.5);
        assert_eq!((own.hold, own.wind), (4.0, 0.25));
        let mut outside = Own::default();
        region().change(&mut outside, 0.0);
        assert_eq!(outside, Own::default());
    }

    #[test]
    fn what_reaches_no_hair_is_refused() {
        let refused = |region: Region| region.check_at("region[0]").unwrap_err().to_string();
        assert!(refused(Region { within: 0.0, soft: 0.0, ..region() }).starts_with("region[0].within = 0"));
        assert!(refused(Region { to: Some(NEAR), ..region() }).starts_with("region[0].to = "));
        assert!(refused(Region { near: None, to: Some(NEAR), ..region() }).starts_with("region[0].to = "));
        assert!(refused(Region { near: None, ..region() }).starts_with("region[0].near is missing"));
        let of_a_group = Region { near: None, groups: vec!["fringe".to_owned()], ..region() };
        assert!(of_a_group.check_at("region[0]").is_ok());
    }

    #[test]
    fn members_are_known_by_their_roots_and_weigh_what_they_are_given() {
        let roots = [Vec3::X, Vec3::Y, Vec3::new(-0.0, 0.0, 2.0), Vec3::X];
        let members = Members::new(roots.into_iter().zip([0.25, 1.0, 0.5, 0.75]));
        let found = [Vec3::X, Vec3::Y, Vec3::new(0.0, -0.0, 2.0), Vec3::Z].map(|root| members.weight(root));
        assert_eq!(found, [0.75, 1.0, 0.5, 0.0]);
        let numbers: Vec<f32> = members.numbers().collect();
        assert_eq!(numbers, [0.0, 0.0, 2.0, 0.5, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.75]);
    }
}
