//! The settings of the motion of a scene's hair, and in the free form its surroundings.

use std::sync::Arc;

use nabiki::aim::Aim;
use nabiki::dynamics::{Dynamics, Form};
use nabiki::free_form::{FreeForm, FreeMotion, Neighbours};
use nabiki::locks::Locks;
use nabiki::{Pose, Strands};

use super::bodies::{BodyInputs, BuiltBody, Reach};
use super::groom::Groom;
use super::model::Model;
use super::skin::Bent;
use super::stage::{At, Stage};
use super::way::Way;
use crate::error::Result;
use crate::scene::{FormChoice, MeanLengths, Scene};

/// Strands that represent the whole hair where one number is needed.
const FEW: usize = 256;

/// Number of first strands of the whole that are needed, whichever are shown.
pub(super) fn first_wanted(scene: &Scene) -> usize {
    match scene.form {
        FormChoice::Paper => 0,
        FormChoice::Free => scene.neighbours.as_ref().map_or(FEW, |n| FEW.max(n.carriers as usize)),
    }
}

/// The paper's form, for a head with this pose at rest.
pub(super) fn dynamics(scene: &Scene, model: &Model, rest_pose: Pose, at: At<'_>) -> Result<Dynamics> {
    let dynamics = Dynamics {
        motion: scene.motion.clone(),
        segment_length: scene.hair.segment_length,
        pseudo_force: scene.pseudo_force.clone(),
        shell: scene.head.shell,
        disturbance: scene.disturbance.clone(),
        ..Dynamics::new(model.head.ellipsoid)
    };
    dynamics.check().map_err(|refused| at.refusal(refused))?;
    Ok(Dynamics { polar_axis: rest_pose.up_in_head(), ..dynamics })
}

/// The clumps of grown hair are its locks, unless the scene sets another width.
fn locks(scene: &Scene) -> Locks {
    let clumps =
        scene.hair.grown().map_or_else(Locks::default, |hair| Locks { size: hair.style.clumps.size, seed: hair.seed });
    let size = scene.free.variation.and_then(|variation| variation.size);
    Locks { size: size.unwrap_or(clumps.size), ..clumps }
}

/// Mean length of the hair. `first`: strands of the whole.
pub(super) fn mean_lengths(first: &Strands) -> MeanLengths {
    let all: f64 = first.lengths().take(FEW).map(f64::from).sum();
    let segments: usize = first.iter().take(FEW).map(|strand| strand.len() - 1).sum();
    let [strand, segment] = [first.len().min(FEW), segments].map(|count| all / count.max(1) as f64);
    MeanLengths { strand, segment }
}

/// Sets the free form with these settings and the scene's surroundings in `dynamics`. Returns the scene's bodies; `known`
/// ones are reused.
#[expect(clippy::too_many_arguments, reason = "all that surrounds the hair")]
pub(super) fn set_free<'a>(
    dynamics: &mut Dynamics,
    (form, aims): (FreeForm, Vec<Aim>),
    scene: &Scene,
    (model, way, bent): (&Model, &Way, &Bent),
    groom: &Groom,
    rest_pose: Pose,
    known: impl Iterator<Item = &'a Arc<BuiltBody>> + Clone,
    at: At<'_>,
) -> Result<Vec<Arc<BuiltBody>>> {
    let head = bent.body(scene.contact, form.most_margin())?.unwrap_or_else(|| model.body(scene.contact));
    let reach = Reach::of(groom, dynamics.skin.as_deref(), &way.poses, scene.motion.frames, form.most_margin());
    let (mut felt, mut bodies) = (vec![head], Vec::new());
    for (i, settings) in scene.bodies.iter().enumerate() {
        // All hair is grown at this point.
        at.still_wanted(1.0)?;
        let body = BuiltBody::of(BodyInputs::of(scene, i), known.clone(), at)?;
        felt.extend(body.felt(settings, scene.motion.frames, &reach, at)?);
        bodies.push(body);
    }
    let neighbours = scene.neighbours.as_ref().map(|forces| {
        let first = &groom.first;
        let carriers = (forces.carriers as usize).min(first.len());
        Neighbours::new(forces.clone(), Arc::new(first.select(&(0..carriers).collect::<Vec<_>>())))
    });
    let (locks, members) = (locks(scene), groom.members.clone());
    dynamics.form = Form::Free(FreeMotion { form, bodies: felt, neighbours, locks, members, aims, rest_pose });
    dynamics.check().map_err(|refused| at.refusal(refused))?;
    Ok(bodies)
}
