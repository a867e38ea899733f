//! `[free]`: the free form, with values in physical units.

use nabiki::dynamics::{Dynamics, earth_gravity, stiffness_of, substeps};
use nabiki::free_form::{FreeForm, Tie};
use nabiki::locks::LockVariation;
use nabiki::region::Region;
use nabiki::setting::{Place, refused};
use nabiki::{Profile, SettingError, settings};

use super::quantity::{Amount, Length, Measure, Strength, Time, Weight};

settings! {
    /// How hair keeps its shape and settles in the free form. Strengths are in F, the unit of the wind, or in world
    /// units.
    pub struct FreeSettings in "free" where weight_bends_it {
        /// How firmly hair keeps its shape: at 36 times the strength of the wind, hair of 18 cm bends over about 6 cm.
        /// "4.5 cm" is hair that bends under its own `gravity` over that length, like real hair. One value, or a list
        /// from root to tip. In docs/motion-forms.md this is K, with EI = 3/8 A L K d^2 and d = `hair.segment_length`.
        /// The number of segments does not change how hair bends.
        pub stiffness: Profile<Amount<Length>> = in_own_unit(&FreeForm::default().stiffness) => of FreeForm;
        /// How firmly hair returns to its groomed place on the head, like hair spray. "0.3 g" pulls with 0.3 times the
        /// weight of the hair on earth. One value, or a list from root to tip. In docs/motion-forms.md this is H: it
        /// turns segments toward their rest direction on the head. Against a force F, limp hair settles along F + H r.
        pub hold: Profile<Amount<Strength>> = in_own_unit(&FreeForm::default().hold) => of FreeForm;
        /// Number of frames in which a swing falls to 1/e: 7 looks like wet hair, 20 swings over once, 60 keeps waving,
        /// 0 removes the air. "0.8 s" is a time instead of a number of frames. One value, or a list from root to tip,
        /// interpolated in frames: hair next to a 0 hardly swings.
        pub settle: Profile<Amount<Time>> = in_own_unit(&FreeForm::default().settle) => of FreeForm;
        /// How fast moved hair falls. Hair at rest does not sag. Give a strength in F, or "1 g" or "earth" for 981
        /// cm/s^2 at `motion.frame_rate`.
        pub gravity: Amount<Weight> = FreeForm::default().gravity.into() => of FreeForm;
        /// How far a moving head leaves the hair behind: 0 moves hair with the head, 1 is realistic, more exaggerates.
        /// It scales the effect of turns, accelerations and still air. One number, or a list from root to tip.
        pub drag: Profile => of FreeForm;
        /// Whether `[pseudo_force]` weakens the wind in front of the head, as in the paper's form.
        pub pseudo_force: bool => of FreeForm;
        /// Differences between locks, so that they part in the wind.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub variation: Option<LockVariation> => of FreeForm, open "locks do not differ";
        /// Parts of the hair that move differently, such as a fringe that stays.
        pub regions: Vec<Region> => of FreeForm;
        /// A band that ties hair. Strands that pass it at rest are held from the root to the band.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub tie: Option<Tie> => of FreeForm, open "none";
        /// Number of steps per frame. By default a scene takes as many as weight and stiffness need, at least 2. Raise
        /// it if fast contact is missed.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub substeps: Option<u32> => of FreeForm, open "as many as needed";
    }
}

/// Numbers as a scene holds them.
fn in_own_unit<M: Measure>(profile: &Profile) -> Profile<Amount<M>> {
    profile.map(|&number| number.into())
}

/// Mean length of a scene's hair, and that of its segments (cm).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MeanLengths {
    pub strand: f64,
    pub segment: f64,
}

impl FreeSettings {
    /// The same in the unit of the force and in frames, for steppers, for hair of these lengths.
    pub(crate) fn resolved(&self, dynamics: &Dynamics, mean: MeanLengths) -> FreeForm {
        let Self { stiffness, hold, settle, gravity, drag, pseudo_force, variation, regions, tie, substeps: steps } =
            self;
        let earth = f64::from(earth_gravity(dynamics, mean.strand));
        let gravity = gravity.number(|g| g * earth);
        let bent = |cm: f64| stiffness_of(dynamics, gravity.into(), mean.strand, cm);
        let mut form = FreeForm {
            stiffness: stiffness.map(|stiffness| stiffness.number(bent)),
            hold: hold.map(|hold| hold.number(|g| g * earth)),
            settle: settle.map(|settle| settle.number(|seconds| seconds * dynamics.motion.frame_rate)),
            gravity,
            drag: drag.clone(),
            pseudo_force: *pseudo_force,
            variation: *variation,
            regions: regions.clone(),
            tie: *tie,
            substeps: *steps,
        };
        let needed = || substeps(dynamics, &form, gravity, [mean.strand, mean.segment]);
        form.substeps = Some(steps.unwrap_or_else(needed));
        form
    }

    /// Takes a field that is removed, such as `fan[1]`, out of the regions' shares, and numbers those after it anew.
    pub(crate) fn forget_field(&mut self, removed: &str) {
        let number = |name: &str| -> Option<(String, usize)> {
            let (table, number) = name.strip_suffix(']')?.split_once('[')?;
            Some((table.to_owned(), number.parse().ok()?))
        };
        let Some((table, gone)) = number(removed) else { return };
        for region in &mut self.regions {
            region.fields.retain(|of| of.field != removed);
            for share in &mut region.fields {
                match number(&share.field) {
                    Some((of, i)) if of == table && i > gone => share.field = format!("{table}[{}]", i - 1),
                    _ => {}
                }
            }
        }
    }

    /// Applies a solver's stiffness and settling where they differ from the scene's own, which were `was` to it.
    pub(crate) fn accept(&mut self, was: &FreeForm, stiffness: &Profile, settle: &Profile) {
        if *stiffness != was.stiffness {
            self.stiffness = in_own_unit(stiffness);
        }
        if *settle != was.settle {
            self.settle = in_own_unit(settle);
        }
    }

    /// A bending length means nothing without weight.
    fn weight_bends_it(&self, at: &Place) -> Result<(), SettingError> {
        match self.stiffness.values().iter().find_map(Amount::quantity) {
            Some(length) if self.gravity.is_zero() => {
                let remedy = "a bending length needs gravity: give gravity, or a number";
                refused(&at.key("stiffness"), length, remedy)
            }
            _ => Ok(()),
        }
    }
}
