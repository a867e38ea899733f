//! Settings of the free form of the motion. docs/motion-forms.md has its equations.

use std::sync::Arc;

use glam::Vec3;

use crate::aim::Aim;
use crate::body::{Body, MOST_MARGIN};
use crate::chance::Chance;
use crate::error::SettingError;
use crate::field::Field;
use crate::locks::{Lock, LockVariation, Locks, Own};
use crate::pose::{Pose, check_poses};
use crate::profile::Profile;
use crate::region::{Belongs, FieldShares, Members, Region};
use crate::settings;
use crate::strands::Strands;

/// Acceleration of the earth's gravity (cm/s^2).
pub const EARTH_CM_PER_S2: f64 = 981.0;

settings! {
    /// How hair keeps its shape and settles in the free form. Strengths are in F, the unit of the wind.
    pub struct FreeForm in "free" {
        /// How firmly hair keeps its shape: at 36 times the strength of the wind, hair of 18 cm bends over about 6 cm.
        /// One number, or a list from root to tip. In docs/motion-forms.md this is K, with EI = 3/8 A L K d^2 and d =
        /// `hair.segment_length`. The number of segments does not change how hair bends.
        pub stiffness: Profile = Profile::RootToTip(vec![12_000.0, 1000.0]) => "Stiffness", least 0.0, most 1e9;
        /// How firmly hair returns to its groomed place on the head, like hair spray. One number, or a list from root
        /// to tip. In docs/motion-forms.md this is H: it turns segments toward their rest direction on the head.
        /// Against a force F, limp hair settles along F + H r.
        pub hold: Profile = Profile::Even(30.0) => "Hold", least 0.0, most 1e9;
        /// Number of frames in which a swing falls to 1/e: 7 looks like wet hair, 20 swings over once, 60 keeps waving,
        /// 0 removes the air. One number, or a list from root to tip, interpolated in frames: hair next to a 0 hardly
        /// swings.
        pub settle: Profile = Profile::Even(20.0) => "Settle", unit "frames", least 0.0;
        /// How fast moved hair falls. Hair at rest does not sag. [`earth_gravity`](crate::dynamics::earth_gravity) is
        /// the gravity of the earth.
        pub gravity: f32 = 100.0 => "Weight", least 0.0, most 1e9;
        /// How far a moving head leaves the hair behind: 0 moves hair with the head, 1 is realistic, more exaggerates.
        /// It scales the effect of turns, accelerations and still air. One number, or a list from root to tip.
        pub drag: Profile = Profile::Even(1.0) => "Drag", least 0.0, most 10.0;
        /// Whether `[pseudo_force]` weakens the wind in front of the head, as in the paper's form.
        pub pseudo_force: bool = false => "Pseudo-force";
        /// Differences between locks, so that they part in the wind.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub variation: Option<LockVariation> = None => "Locks", open "locks do not differ";
        /// Parts of the hair that move differently, such as a fringe that stays.
        #[serde(skip_serializing_if = "Vec::is_empty")]
        pub regions: Vec<Region> = Vec::new() => "Regions";
        /// A band that ties hair. Strands that pass it at rest are held from the root to the band.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub tie: Option<Tie> = None => "Tie", open "none";
        /// Number of steps per frame. By default a scene takes as many as weight and stiffness need, at least 2. Raise
        /// it if fast contact is missed.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub substeps: Option<u32> = None => "Substeps", least 1.0, most 32.0, open "as many as needed";
    }
}

settings! {
    /// A band that ties hair. A strand that passes the band at rest moves with the head up to it. Beyond the band it
    /// moves as if rooted there.
    ///
    /// Segments up to the node nearest to the band are held: their inverse mass is 0. Lengths, and lists from root to
    /// tip, count from there. A strand that passes with no node close enough is tied at the nearer node of that
    /// segment, but never at its root.
    #[derive(Copy)]
    pub struct Tie {
        /// Middle of the band in head space.
        pub at: Vec3 = Vec3::new(-11.0, 2.0, 0.0) => "Position", must "[x, y, z]", unit "cm";
        /// Largest distance from the band of the strands to tie.
        pub within: f32 = 1.5 => "Distance", must "1.5", unit "cm", above 0.0;
    }
}

impl Tie {
    /// Number of segments that the band holds: up to the strand's node nearest to the band, if that is close enough.
    /// Otherwise up to the nearer node of the first segment that passes close enough, at least one. Otherwise 0.
    pub fn held(&self, strand: &[Vec3]) -> usize {
        let far = |p: &Vec3| p.distance_squared(self.at);
        let near_enough = |far: f32| far <= self.within * self.within;
        let nearest = strand.iter().enumerate().min_by(|a, b| far(a.1).total_cmp(&far(b.1)));
        if let Some((i, _)) = nearest.filter(|(_, p)| near_enough(far(p))) {
            return i;
        }
        let between = |(i, pair): (usize, &[Vec3])| (i, far(&nearest_between(pair[0], pair[1], self.at)));
        let segments = strand.windows(2).enumerate().map(between);
        let nearest = segments.min_by(|a, b| a.1.total_cmp(&b.1)).filter(|&(_, far)| near_enough(far));
        nearest.map_or(0, |(i, _)| if far(&strand[i]) < far(&strand[i + 1]) { i.max(1) } else { i + 1 })
    }
}

/// The point of a segment nearest to a place.
fn nearest_between(from: Vec3, to: Vec3, place: Vec3) -> Vec3 {
    let way = to - from;
    let part = (place - from).dot(way) / way.length_squared().max(f32::MIN_POSITIVE);
    from + part.clamp(0.0, 1.0) * way
}

impl FreeForm {
    /// Number of segments of a strand that the tie holds.
    pub(crate) fn held(&self, strand: &[Vec3]) -> usize {
        self.tie.map_or(0, |tie| tie.held(strand))
    }

    /// At least the largest drag of any segment.
    pub(crate) fn most_drag(&self) -> f32 {
        self.regions.iter().fold(self.drag.largest(), |most, region| most * region.drag.largest().max(1.0))
    }

    /// The most by which regions multiply the stiffness of hair, as if all of them overlapped.
    pub(crate) fn most_stiffened(&self) -> f64 {
        self.regions.iter().map(|region| f64::from(region.stiffness.largest().max(1.0))).product()
    }

    /// The most by which regions multiply the weight of hair, as if all of them overlapped.
    pub(crate) fn most_weight(&self) -> f64 {
        self.regions.iter().map(|region| f64::from(region.gravity.max(1.0))).product()
    }

    /// The most by which regions multiply the margin of a contact.
    pub fn most_margin(&self) -> f32 {
        self.regions.iter().map(|region| region.margin.max(1.0)).product()
    }

    /// Names of the fields that strands feel in shares of their own, in order.
    pub(crate) fn shared(&self) -> Vec<&str> {
        let mut names: Vec<&str> =
            self.regions.iter().flat_map(|region| &region.fields).map(|of| of.field.as_str()).collect();
        names.sort_unstable();
        names.dedup();
        names
    }

    /// Refuses a region's share in a field that is not there.
    pub(crate) fn check_shares(&self, field: &dyn Field) -> Result<(), SettingError> {
        let there = field.parts();
        // Where nothing blows, there is nothing to have a share of.
        if there.is_empty() && field.strongest() == 0.0 {
            return Ok(());
        }
        for (i, region) in self.regions.iter().enumerate() {
            let unknown = region.fields.iter().position(|of| !there.contains(&of.field));
            if let Some(j) = unknown {
                let key = format!("free.regions[{i}].fields[{j}].field");
                let remedy = match there {
                    [] => "no such field: remove it".to_owned(),
                    _ => format!("no such field: use one of {}, or remove it", there.join(", ")),
                };
                return Err(SettingError::new(key, format!("{:?}", region.fields[j].field), remedy));
            }
        }
        Ok(())
    }

    /// Whether strands may differ in what they make of the wind.
    pub(crate) fn wind_differs(&self) -> bool {
        self.variation.is_some() || self.regions.iter().any(|region| region.wind != 1.0)
    }

    /// alpha: how fast the air slows a node (1/frame). The amplitude of a swing falls half as fast, to 1/e in `settle`
    /// frames.
    pub fn air(&self, along: f64) -> f64 {
        let settle = self.settle.at(along);
        if settle > 0.0 { 2.0 / settle } else { 0.0 }
    }

    /// Steps per frame for a stepper: 2 if `substeps` is not set, see [`substeps`](crate::dynamics::substeps).
    pub fn steps(&self) -> u32 {
        self.substeps.unwrap_or(2)
    }
}

settings! {
    /// Hair against hair. A few strands, the carriers, fill a grid as they move.
    ///
    /// Carriers write density and mean velocity to the grid. In the next frame all strands read them. A strand
    /// therefore depends only on itself and the carriers, and any subset of the hair moves as it does among all.
    pub struct NeighbourForces in "neighbours" {
        /// Number of carriers: the first strands of an even selection.
        pub carriers: u32 = 256 => "Carriers", unit "strands", least 1.0, most 4096.0;
        /// How firmly hair keeps its volume: it pushes hair out of places that are fuller than at rest. In the unit F,
        /// where the density falls by that of hair at rest over one cell.
        pub pressure: f32 = 40.0 => "Pressure", least 0.0;
        /// How firmly strands drag their neighbours along: raise it if neighbours drift apart. It pulls a node toward
        /// the mean velocity around it, in the unit F per cm per frame.
        pub cohesion: f32 = 40.0 => "Cohesion", least 0.0;
        /// Edge length of a grid cell.
        pub cell: f32 = 2.0 => "Cell", unit "cm", least 0.5, most 20.0;
    }
}

/// Hair against hair: the settings and the carriers.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Neighbours {
    /// Strengths.
    pub forces: NeighbourForces,
    /// The carriers at rest (head space, cm). They do not depend on which strands are stepped. For your own hair, use
    /// `hair.select(&evenly(&roots, 256))`, see [`evenly`](crate::subset::evenly).
    pub carriers: Arc<Strands>,
}

impl Neighbours {
    /// Neighbour forces of these strengths with these carriers at rest (head space, cm).
    pub fn new(forces: NeighbourForces, carriers: Arc<Strands>) -> Self {
        Self { forces, carriers }
    }
}

/// The free form, with everything around the hair.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FreeMotion {
    /// How hair keeps its shape and settles.
    pub form: FreeForm,
    /// Bodies that hair collides with.
    pub bodies: Vec<Body>,
    /// Hair against hair, if any.
    pub neighbours: Option<Neighbours>,
    /// The locks, for [`FreeForm::variation`]. The `size` in those settings is used only by scenes.
    pub locks: Locks,
    /// Which strands belong to each region of [`FreeForm::regions`] that goes by groups, an attribute or a map. `None`, or
    /// nothing, for other regions.
    pub members: Vec<Option<Members>>,
    /// What leads hair to other shapes in some frames.
    pub aims: Vec<Aim>,
    /// The head's pose in frame 0. It determines how gravity acts on the hair at rest.
    pub rest_pose: Pose,
}

impl FreeMotion {
    /// The lock of a strand at rest (head space, cm). Tied hair is divided into locks where it leaves its band.
    pub fn lock(&self, strand: &[Vec3]) -> Lock {
        self.locks.of(strand[self.form.held(strand)])
    }

    /// How a strand at rest (head space, cm) differs from the settings of the form.
    pub fn own(&self, strand: &[Vec3]) -> Own {
        let mut own = self.form.variation.map_or_else(Own::default, |variation| {
            variation.of(&self.lock(strand), Chance::at_point(self.locks.seed, strand[0]))
        });
        let regions = self.regions_of(strand[0]);
        own.wind *= regions.product(|region| region.wind);
        own.weight *= regions.product(|region| region.gravity);
        own.margin *= regions.product(|region| region.margin);
        own
    }

    /// How strongly the strand with this root (head space at rest, cm) feels the fields that regions name.
    pub(crate) fn shares(&self, root: Vec3) -> FieldShares {
        match &self.form.shared()[..] {
            [] => FieldShares::default(),
            fields => self.regions_of(root).shares(fields),
        }
    }

    /// The regions that the strand with this root (head space at rest, cm) belongs to.
    pub(crate) fn regions_of(&self, root: Vec3) -> Belongs<'_> {
        Belongs::new(self.form.regions.iter().enumerate().map(|(i, region)| (region, self.weight_in(i, root))))
    }

    /// How much the strand with this root (head space at rest, cm) is led by an aim.
    pub(crate) fn weight_of(&self, aim: &Aim, root: Vec3) -> f64 {
        aim.region.map_or(1.0, |region| self.weight_in(region, root))
    }

    /// The members of a region, if it has any.
    fn members_of(&self, region: usize) -> Option<&Members> {
        self.members.get(region)?.as_ref()
    }

    /// How much the strand with this root (head space at rest, cm) belongs to a region.
    pub fn weight_in(&self, region: usize, root: Vec3) -> f64 {
        self.form.regions[region].weight(root) * self.members_of(region).map_or(1.0, |members| members.weight(root))
    }

    /// Refuses a region that keeps hair farther from a body than a contact may.
    fn check_margins(&self) -> Result<(), SettingError> {
        let times = self.form.most_margin();
        let keeps = |body: &Body| body.contact.margin * times;
        let too_far = self.bodies.iter().find(|body| times > 1.0 && f64::from(keeps(body)) > MOST_MARGIN);
        let Some(body) = too_far else { return Ok(()) };
        let i = self.form.regions.iter().position(|region| region.margin > 1.0).unwrap_or_default();
        let remedy = format!(
            "the regions together multiply {}.margin to {} cm, but at most {MOST_MARGIN} cm is possible: lower one of them",
            body.name,
            keeps(body)
        );
        Err(SettingError::new(format!("free.regions[{i}].margin"), self.form.regions[i].margin, remedy))
    }

    /// Refuses settings out of range, and bodies without a pose in any of the `frames` frames after frame 0.
    pub fn check(&self, frames: u32) -> Result<(), SettingError> {
        self.form.check()?;
        for (i, region) in self.form.regions.iter().enumerate() {
            if region.has_members() && self.members_of(i).is_none() {
                let key = format!("free.regions[{i}]");
                return Err(SettingError::new(key, "", "goes by groups, an attribute or a map, so it needs members"));
            }
        }
        if !(self.locks.size > 0.0 && self.locks.size.is_finite()) {
            return Err(SettingError::new("free.variation.size", self.locks.size, "must be above 0"));
        }
        self.bodies.iter().try_for_each(|body| body.check(frames))?;
        self.check_margins()?;
        self.aims.iter().try_for_each(|aim| aim.check(self.form.regions.len()))?;
        check_poses("head.motion", &[self.rest_pose])?;
        match &self.neighbours {
            None => Ok(()),
            Some(Neighbours { forces, carriers }) => {
                forces.check()?;
                if carriers.is_empty() {
                    let remedy = "neighbours need at least one strand to carry them";
                    return Err(SettingError::new("neighbours.carriers", "0 strands", remedy));
                }
                Ok(())
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_out_of_range_are_refused_by_name() {
        let refused = |change: fn(&mut FreeForm)| {
            let mut form = FreeForm::default();
            change(&mut form);
            form.check().unwrap_err().thing
        };
        assert_eq!(refused(|f| f.stiffness = Profile::Even(-1.0)), "free.stiffness");
        assert_eq!(refused(|f| f.hold = Profile::RootToTip(vec![1.0, f32::INFINITY])), "free.hold[1]");
        assert_eq!(refused(|f| f.settle = Profile::RootToTip(Vec::new())), "free.settle");
        assert_eq!(refused(|f| f.gravity = f32::NAN), "free.gravity");
        assert_eq!(refused(|f| f.drag = Profile::Even(-0.5)), "free.drag");
        let refused = |forces: NeighbourForces| forces.check().unwrap_err().thing;
        assert_eq!(refused(NeighbourForces { carriers: 0, ..Default::default() }), "neighbours.carriers");
        assert_eq!(refused(NeighbourForces { pressure: -1.0, ..Default::default() }), "neighbours.pressure");
        assert_eq!(refused(NeighbourForces { cohesion: f32::NAN, ..Default::default() }), "neighbours.cohesion");
        assert_eq!(refused(NeighbourForces { cell: 0.1, ..Default::default() }), "neighbours.cell");
    }

    #[test]
    fn hair_that_passes_a_band_between_two_nodes_is_tied_at_the_nearer_one() {
        let strand: Vec<Vec3> = (0..5).map(|i| Vec3::new(i as f32, 0.0, 0.0)).collect();
        let held = |x: f32, y: f32, within: f32| Tie { at: Vec3::new(x, y, 0.0), within }.held(&strand);
        // No node lies within.
        assert_eq!([0.4, 0.6, 1.4, 1.6, 2.5, 3.6].map(|x| held(x, 0.1, 0.3)), [1, 1, 1, 2, 3, 4]);
        // One does: it decides, be it the root.
        assert_eq!([0.1, 1.2, 3.9, 4.2].map(|x| held(x, 0.1, 0.3)), [0, 1, 4, 4]);
        // The strand does not come so near.
        assert_eq!([held(1.5, 0.4, 0.3), held(-0.3, 0.1, 0.3), held(4.4, 0.0, 0.3)], [0; 3]);
        let doubled = [strand[1]; 3];
        assert_eq!(Tie { at: Vec3::ZERO, within: 0.5 }.held(&doubled), 0);
    }
}
