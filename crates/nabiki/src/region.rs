//! Regions: hair that moves differently from the rest, such as a fringe that stays.
//!
//! How much a strand belongs to a region depends only on its root, so a preview has the regions of all the hair.

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
    /// A strand belongs to the region if its root is near a point, or near the line from that point to a second one. Each
    /// factor multiplies a setting of `[free]`. Where regions overlap, their factors multiply.
    pub struct Region where has_a_line {
        /// Name of the region, for `info`.
        pub name: String = String::new() => "Name";
        /// Where the region is, in the space of the head at rest.
        pub near: Vec3 = Vec3::ZERO => "Near", must "[x, y, z]", unit "cm", least -FARTHEST, most FARTHEST;
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
    /// How much a strand with this root (head space at rest, cm) belongs to the region: 1 inside, 0 outside, and
    /// 1 - 3 x^2 + 2 x^3 at a share x of the border's width.
    pub fn weight(&self, root: Vec3) -> f64 {
        let (root, near) = (root.as_dvec3(), self.near.as_dvec3());
        let line = self.to.map_or(DVec3::ZERO, |to| to.as_dvec3() - near);
        let along = ((root - near).dot(line) / line.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        let beyond = root.distance(near + along * line) - f64::from(self.within);
        match f64::from(self.soft) {
            _ if beyond <= 0.0 => 1.0,
            soft if beyond < soft => 1.0 - rise(beyond / soft),
            _ => 0.0,
        }
    }

    /// Multiplies what is a strand's own by the factors of the region.
    pub(crate) fn change(&self, own: &mut Own, root: Vec3) {
        let weight = self.weight(root);
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

    /// Refuses a line without a length, and a region that no root can be in.
    fn has_a_line(&self, at: &Place) -> Result<(), SettingError> {
        if let Some(to) = self.to.filter(|&to| to == self.near) {
            return refused(&at.key("to"), to, "must differ from near: leave it out for a region around a point");
        }
        if self.within + self.soft == 0.0 {
            return refused(&at.key("within"), self.within, "the region reaches no hair: give within or soft a width");
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn region() -> Region {
        Region { near: Vec3::new(1.0, 2.0, 3.0), within: 2.0, soft: 4.0, hold: 3.0, wind: 0.0, ..Region::default() }
    }

    #[test]
    fn a_region_is_full_inside_and_fades_to_nothing_over_its_border() {
        let at = |far: f32| region().weight(region().near + far * Vec3::Y);
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
        let half = region().near + 4.0 * Vec3::Y;
        let mut own = Own::default();
        region().change(&mut own, half);
        assert_eq!((own.hold, own.wind, own.stiffness), (2.0, 0.5, 1.0));
        region().change(&mut own, half);
        assert_eq!((own.hold, own.wind), (4.0, 0.25));
        let mut outside = Own::default();
        region().change(&mut outside, Vec3::splat(50.0));
        assert_eq!(outside, Own::default());
    }

    #[test]
    fn what_reaches_no_hair_is_refused() {
        let refused = |region: Region| region.check_at("region[0]").unwrap_err().to_string();
        assert!(refused(Region { within: 0.0, soft: 0.0, ..region() }).starts_with("region[0].within = 0"));
        assert!(refused(Region { to: Some(region().near), ..region() }).starts_with("region[0].to = "));
    }
}
