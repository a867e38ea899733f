//! Regions: hair that moves differently from the rest, such as a fringe that stays.
//!
//! How much a strand belongs to a region depends only on its root, so a preview has the regions of all the hair.

use std::path::PathBuf;
use std::sync::Arc;

use glam::{DVec3, Vec3};

use crate::error::SettingError;
use crate::nearest::Nearest;
use crate::profile::Profile;
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
    /// A strand belongs to the region by its group, by an attribute of the hair or of the head's mesh, by a painted map, by painted points, or if
    /// its root is near a point or line; with several of these, by all of them. Factors multiply the settings of the scene. Where a factor may be
    /// a list, it runs from root to tip. Where regions overlap, their factors multiply.
    pub struct Region where reaches_hair {
        /// Name of the region, for `info`.
        pub name: String = String::new() => "Name";
        /// Groups of hair: only strands of these groups belong to it. Grown hair has the groups "top", "sides", "back"
        /// and "fringe"; hair from a file has those of the file.
        #[serde(skip_serializing_if = "Vec::is_empty")]
        pub groups: Vec<String> = Vec::new() => "Groups";
        /// Attribute of the hair in its file, such as a painted weight: one number per strand or point, of which that of
        /// the root counts. It is how much the strand belongs to the region: 0 not at all, 1 fully. If the hair has none of
        /// this name, it is a weight or colour that is painted on the vertices of the head's mesh, where the strand grows. Of
        /// a colour the luminance counts, or one channel: "COLOR_0.g".
        #[serde(skip_serializing_if = "Option::is_none")]
        pub attribute: Option<String> = None => "Attribute", open "none";
        /// Values of the attribute that belong to the region, such as the numbers of clumps, or of parts of the head's mesh.
        /// Without them, the attribute is a weight.
        #[serde(skip_serializing_if = "Vec::is_empty")]
        pub values: Vec<i32> = Vec::new() => "Values";
        /// A picture over the head, PNG: white where hair belongs to it fully, black where it does not. Hair finds its
        /// place by its own root UVs, or else by the UVs of the head's mesh where it grows.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub map: Option<PathBuf> = None => "Map", open "none";
        /// Painted points of the skin, as the studio's brush leaves them: x, y, z in the space of the head at rest (cm), and
        /// how much hair there belongs to the region, 0 to 1. A root takes the weights of the three points nearest to it,
        /// and belongs to the region only up to `within` from the nearest one, fading over `soft`.
        #[serde(skip_serializing_if = "Vec::is_empty")]
        pub painted: Vec<[f32; 4]> = Vec::new() => "Painted", least -FARTHEST, most FARTHEST;
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
        pub stiffness: Profile = Profile::Even(1.0) => "Stiffness", least 0.0, most MOST;
        /// Factor on `free.hold`.
        pub hold: Profile = Profile::Even(1.0) => "Hold", least 0.0, most MOST;
        /// Factor on `free.settle`: at 2, hair swings twice as long.
        pub settle: Profile = Profile::Even(1.0) => "Settle", least 0.01, most MOST;
        /// Factor on the forces of all fields. At 0, no wind moves the hair.
        pub wind: f32 = 1.0 => "Wind", least 0.0, most MOST;
        /// Factors on single fields, such as a fan that the fringe does not feel.
        #[serde(skip_serializing_if = "Vec::is_empty")]
        pub fields: Vec<FieldShare> = Vec::new() => "Fields";
        /// Factor on `free.gravity`, for each strand as a whole. Hair at rest does not sag, whatever its weight. Factors
        /// above 1 of all regions together may raise the number of steps per frame.
        pub gravity: f32 = 1.0 => "Weight", least 0.0, most MOST;
        /// Factor on the distance that hair keeps from the head and from bodies, `contact.margin`. That distance times the
        /// factors above 1 of all regions, whether they overlap or not, is at most 5 cm.
        pub margin: f32 = 1.0 => "Margin", least 0.0, most MOST;
        /// Factor on `free.drag`.
        pub drag: Profile = Profile::Even(1.0) => "Drag", least 0.0, most MOST;
    }
}

settings! {
    /// How strongly the hair of a region feels one field.
    pub struct FieldShare where names_a_field {
        /// The field: `wind` for `[[force]]`, `[gust]`, `[body_wind]` and `[flow]` together, `turbulence`, or a table of
        /// which there may be several with its number, from 0, such as `fan[0]`.
        pub field: String = "turbulence".to_owned() => "Field", must "\"turbulence\"";
        /// Factor on its force. At 0, the hair does not feel it.
        pub share: f32 = 0.3 => "Share", must "0.3", least 0.0, most MOST;
    }
}

impl FieldShare {
    fn names_a_field(&self, at: &Place) -> Result<(), SettingError> {
        match self.field.as_str() {
            "" => Err(SettingError::new(
                &at.key("field"),
                "",
                "is empty: give the name of a field, such as \"turbulence\"",
            )),
            _ => Ok(()),
        }
    }
}

impl Region {
    /// Whether more than the place determines what belongs to the region: groups, an attribute or a map. Such a region
    /// needs [`Members`].
    pub fn has_members(&self) -> bool {
        !self.groups.is_empty() || self.attribute.is_some() || self.map.is_some()
    }

    /// The factor on the force of the field with this name. Several factors on the same field multiply.
    fn share_of(&self, field: &str) -> f32 {
        self.fields.iter().filter(|of| of.field == field).map(|of| of.share).product()
    }

    /// The most by which it multiplies the force of any field.
    pub(crate) fn most_force(&self) -> f32 {
        self.fields.iter().map(|of| self.share_of(&of.field)).fold(1.0, f32::max) * self.wind
    }

    /// How much a strand with this root (head space at rest, cm) belongs to the region by its place: 1 inside, 0 outside,
    /// and 1 - 3 x^2 + 2 x^3 at a share x of the border's width. 1 everywhere without `near` and `painted`.
    pub fn weight(&self, root: Vec3) -> f64 {
        let root = root.as_dvec3();
        let near = self.near.map_or(1.0, |near| self.inside(root.distance(self.on_line(near.as_dvec3(), root))));
        if near == 0.0 || self.painted.is_empty() { near } else { near * self.painted_weight(root) }
    }

    /// The point of the line from `near` to `to` that is nearest to the root.
    fn on_line(&self, near: DVec3, root: DVec3) -> DVec3 {
        let line = self.to.map_or(DVec3::ZERO, |to| to.as_dvec3() - near);
        let along = ((root - near).dot(line) / line.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        near + along * line
    }

    /// The weight at this distance from the place of the region.
    fn inside(&self, distance: f64) -> f64 {
        let beyond = distance - f64::from(self.within);
        match f64::from(self.soft) {
            _ if beyond <= 0.0 => 1.0,
            soft if beyond < soft => 1.0 - rise(beyond / soft),
            _ => 0.0,
        }
    }

    /// The weight that is painted at this root.
    fn painted_weight(&self, root: DVec3) -> f64 {
        let mut nearest = Nearest::default();
        let mut reach = f64::INFINITY;
        for (i, &[x, y, z, _]) in self.painted.iter().enumerate() {
            let apart = root.distance_squared(Vec3::new(x, y, z).as_dvec3());
            // Most of many points are too far away to need a root.
            if apart <= reach {
                nearest.offer(apart.sqrt(), i as u32);
                reach = nearest.reach().powi(2);
            }
        }
        let inside = self.inside(nearest.distance());
        if inside == 0.0 {
            return 0.0;
        }
        let weights = nearest.weights();
        let sum: f64 = weights.iter().map(|of| of.1).sum();
        let mixed: f64 = weights.iter().map(|&(i, of)| of * f64::from(self.painted[i as usize][3])).sum();
        inside * (mixed / sum).min(1.0)
    }

    /// Refuses a region of no hair in particular, a line without a length, and a place that no root can be in.
    fn reaches_hair(&self, at: &Place) -> Result<(), SettingError> {
        if !self.values.is_empty() && self.attribute.is_none() {
            return refused(
                &at.key("values"),
                format!("{:?}", self.values),
                "are values of an attribute: add attribute",
            );
        }
        if let (None, Some(to)) = (self.near, self.to) {
            return refused(&at.key("to"), to, "is the end of a line that begins at near: add near");
        }
        if self.near.is_none() && self.painted.is_empty() {
            let remedy = "is missing: give near, groups, attribute, map or painted";
            return if self.has_members() { Ok(()) } else { Err(SettingError::new(&at.key("near"), "", remedy)) };
        }
        if let Some(to) = self.to.filter(|&to| Some(to) == self.near) {
            return refused(&at.key("to"), to, "must differ from near: leave it out for a region around a point");
        }
        if self.within + self.soft == 0.0 {
            return refused(&at.key("within"), self.within, "the region reaches no hair: give within or soft a width");
        }
        if let Some(i) = self.painted.iter().position(|point| !(0.0..=1.0).contains(&point[3])) {
            let key = at.key("painted");
            return refused(
                &key.entry(i),
                format!("{:?}", self.painted[i]),
                "the fourth number is a weight, from 0 to 1",
            );
        }
        if !self.painted.is_empty() && self.painted.iter().all(|point| point[3] == 0.0) {
            let remedy = "all points have weight 0, so the region reaches no hair: give one of them a weight";
            return Err(SettingError::new(&at.key("painted"), "", remedy));
        }
        Ok(())
    }
}

/// The regions that a strand belongs to, each with its weight.
#[derive(Clone, Debug, Default)]
pub(crate) struct Belongs<'a>(Vec<(&'a Region, f64)>);

impl<'a> Belongs<'a> {
    pub fn new(regions: impl Iterator<Item = (&'a Region, f64)>) -> Self {
        Self(regions.filter(|&(_, weight)| weight != 0.0).collect())
    }

    /// `first` times the factors of the regions on a setting at a fraction of the strand's length.
    pub fn times(&self, first: f64, factor: impl Fn(&Region) -> &Profile, along: f64) -> f64 {
        self.0
            .iter()
            .fold(first, |product, (region, weight)| product * (factor(region).at(along) - 1.0).mul_add(*weight, 1.0))
    }

    /// The product of a factor of the regions on the strand as a whole.
    pub fn product(&self, factor: impl Fn(&Region) -> f32) -> f64 {
        self.0
            .iter()
            .fold(1.0, |product, (region, weight)| product * (f64::from(factor(region)) - 1.0).mul_add(*weight, 1.0))
    }

    /// The factors on the forces of the fields with these names.
    pub fn shares(&self, fields: &[&str]) -> FieldShares {
        let share = |field: &str| (field.to_owned(), self.product(|region| region.share_of(field)) as f32);
        FieldShares(fields.iter().map(|field| share(field)).collect())
    }
}

/// How strongly a strand feels the fields that regions name: factors on their forces.
#[derive(Clone, Debug, Default)]
pub(crate) struct FieldShares(Vec<(String, f32)>);

impl FieldShares {
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The factor on the field with this name.
    pub fn of(&self, field: &str) -> f32 {
        self.0.iter().find(|of| of.0 == field).map_or(1.0, |of| of.1)
    }

    /// The largest factor, at least 1.
    pub fn largest(&self) -> f32 {
        self.0.iter().map(|of| of.1).fold(1.0, f32::max)
    }

    /// The factors, in the order of their names.
    pub fn factors(&self) -> impl Iterator<Item = f32> {
        self.0.iter().map(|of| of.1)
    }
}

/// How much the strands of some hair belong to a region, for regions by group, attribute or map. Strands are known by their
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
        Region { near: Some(NEAR), within: 2.0, soft: 4.0, hold: 3.0.into(), wind: 0.0, ..Region::default() }
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
        let region = Region { hold: Profile::RootToTip(vec![3.0, 5.0]), ..region() };
        let belongs = |weights: &[f64]| {
            let of = Belongs::new(weights.iter().map(|&weight| (&region, weight)));
            let hold = |along| of.times(1.0, |region| &region.hold, along);
            (
                [hold(0.0), hold(0.5), hold(1.0)],
                of.product(|region| region.wind),
                of.times(7.0, |region| &region.stiffness, 0.3),
            )
        };
        assert_eq!(belongs(&[0.5]), ([2.0, 2.5, 3.0], 0.5, 7.0));
        assert_eq!(belongs(&[0.5, 0.5]), ([4.0, 6.25, 9.0], 0.25, 7.0));
        assert_eq!(belongs(&[0.0]), ([1.0; 3], 1.0, 7.0));
    }

    fn painted(points: &[(Vec3, f32)]) -> Region {
        let painted = points.iter().map(|&(at, weight)| [at.x, at.y, at.z, weight]).collect();
        Region { near: None, painted, ..region() }
    }

    #[test]
    fn painted_weights_hold_at_their_points_and_change_smoothly_between_them() {
        let points: Vec<(Vec3, f32)> =
            (0..8).map(|i| (Vec3::new((i % 4) as f32, 0.4 * (i / 4) as f32, 0.0), (i * 3 % 8) as f32 / 7.0)).collect();
        let region = painted(&points);
        for &(at, weight) in &points {
            assert!((region.weight(at) - f64::from(weight)).abs() < 1e-6, "{at}");
        }
        // Also where another three points become the nearest.
        let along = |i: u32| region.weight(Vec3::new(i as f32 * 1e-3, 0.15, 0.0));
        for i in 0..3000 {
            let (a, b) = (along(i), along(i + 1));
            assert!((0.0..=1.0).contains(&a) && (a - b).abs() < 0.02, "{i}: {a} {b}");
        }
    }

    #[test]
    fn painted_points_reach_as_far_as_places_do_and_add_to_them() {
        let one = painted(&[(NEAR, 0.5)]);
        for far in [0.0, 1.9, 3.0, 4.0, 5.9, 7.0] {
            let at = NEAR + far * Vec3::X;
            assert_eq!(one.weight(at), 0.5 * region().weight(at), "{far}");
            assert_eq!(Region { near: Some(NEAR), ..one.clone() }.weight(at), 0.5 * region().weight(at).powi(2));
        }
        // The order in which they are written does not matter.
        let points: Vec<(Vec3, f32)> = (0..6).map(|i| (Vec3::new(i as f32, 1.0, 0.3), 1.0 / (i + 1) as f32)).collect();
        let back: Vec<(Vec3, f32)> = points.iter().rev().copied().collect();
        for x in 0..50 {
            let at = Vec3::new(0.11 * x as f32, 1.4, 0.0);
            assert!((painted(&points).weight(at) - painted(&back).weight(at)).abs() < 1e-12);
        }
    }

    #[test]
    fn what_reaches_no_hair_is_refused() {
        let of_painted = |weight| painted(&[(NEAR, weight)]).check_at("region[0]").map_err(|e| e.to_string());
        assert_eq!(of_painted(0.1), Ok(()));
        assert!(of_painted(0.0).unwrap_err().starts_with("region[0].painted"));
        assert!(of_painted(1.5).unwrap_err().starts_with("region[0].painted[0] = [1.0, 2.0, 3.0, 1.5]"));
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
