//! Which wind makes the hair of a scene do this? Connects scenes to the solver.

mod find;
mod solved;
mod wishes;

use std::sync::Arc;

use nabiki::SettingError;
use nabiki::dynamics::{ForceSpace, Form};
use nabiki::field::{Field, FlowField};
use nabiki::solve::{Answer, KeyedWind, Prior, Problem, Surroundings, Unknown, Wish};

use crate::built::BuiltScene;
use crate::scene::{FieldPlace, FieldSettings, ForceSettings, Scene, given_as};

pub use find::Named;
pub use solved::{MET_CM, Solved};
pub use wishes::{Interval, NailEntry, Near, Unknowns, WishEntry, WishFile, WishSpace, Wishes};

impl BuiltScene {
    /// The problem for these wishes and unknowns. Nodes are those of [`groom`](Self::groom); positions are in head
    /// space.
    pub fn problem(&self, unknowns: Vec<Unknown>, wishes: Vec<Wish>) -> Problem {
        let field = &self.scene.field;
        let poses = self.given_poses();
        // The solver has no frames after these.
        let place = FieldPlace { poses: poses.clone().into(), ..self.forces.inputs.place.clone() };
        Problem {
            hair: self.strands().clone(),
            ids: self.groom.ids.clone(),
            dynamics: self.dynamics.clone(),
            wind: KeyedWind {
                keyframes: self.forces.intervals().to_vec(),
                ease: field.wind.ease,
                gust: field.gust.clone(),
            },
            surroundings: Arc::new(SceneSurroundings { field: field.clone(), place }),
            poses,
            unknowns,
            wishes,
            prior: Prior::default(),
        }
    }
}

impl Scene {
    /// Applies an answer that a solver found for this scene as `built`. Settings that did not change keep the form in
    /// which they are given, such as a speed or a physical unit.
    pub fn accept(&mut self, answer: &Answer, built: &BuiltScene) {
        let Answer { keyframes, gust, stiffness, settle } = answer;
        let (given, was) = (&built.scene.field.force, built.forces.intervals());
        self.field.force = given_as(given, was, keyframes);
        self.field.gust.clone_from(gust);
        if let (Form::Free(free), Some(stiffness), Some(settle)) = (&built.dynamics.form, stiffness, settle) {
            self.free.stiffness = built.scene.free.stiffness.clone();
            self.free.settle = built.scene.free.settle.clone();
            self.free.accept(&free.form, stiffness, settle);
            if *settle != free.form.settle {
                // A wind at this speed would have another strength.
                self.field.force = keyframes.iter().copied().map(ForceSettings::from).collect();
            }
        }
    }
}

/// The fields of a scene around any wind.
#[derive(Debug)]
struct SceneSurroundings {
    field: FieldSettings,
    place: FieldPlace,
}

impl Surroundings for SceneSurroundings {
    fn field(&self, wind: Arc<dyn Field>) -> Result<Arc<dyn Field>, SettingError> {
        Ok(self.field.build_about(&self.place, wind)?.field)
    }

    fn of_wind(&self, wind: Arc<dyn Field>) -> Result<Arc<dyn Field>, SettingError> {
        let Some(flow) = &self.field.flow else { return Ok(wind) };
        let poses = match self.place.space {
            ForceSpace::World => &self.place.poses[..],
            ForceSpace::Head => &[],
        };
        Ok(Arc::new(FlowField::new(flow, wind, self.place.ellipsoid, poses)?))
    }
}
