//! Builds a scene stage by stage.

use std::sync::Arc;

use nabiki::dynamics::{carrying_force, earth_gravity};
use nabiki_io::cache::Shard;
use nabiki_render::colour;

use super::dynamics::{dynamics, mean_lengths, set_free};
use super::forces::ForcesInputs;
use super::groom::{Groom, GroomInputs, Wanted};
use super::model::{Model, ModelInputs};
use super::skin::{Bent, BentInputs, Scalp, ScalpInputs};
use super::stage::{At, GoesOn, Stage};
use super::way::{Way, WayInputs};
use super::{BuiltScene, Forces, Shown};
use crate::error::Result;
use crate::scene::{FieldBound, FormChoice, Scene};

/// Builds a scene, or one `shard` of it. Reuses stages of `known` scenes that would come out the same, so that files
/// are not read again. Calls `goes_on` with the share of the hair that is grown, between files and while roots are
/// chosen and hair grows.
pub(super) fn build(
    scene: Scene,
    shown: Shown,
    shard: Option<Shard>,
    known: &[&BuiltScene],
    goes_on: GoesOn<'_>,
) -> Result<BuiltScene> {
    let at = At::new(&scene, goes_on);
    let model = Model::of(ModelInputs::of(&scene), known.iter().map(|known| &known.model), at)?;
    at.still_wanted(0.0)?;
    let size = model.of_size();
    build_about(model, scene, Wanted { shown, shard }, known, goes_on).map_err(|refused| refused.blamed_on(size))
}

/// The same for a loaded head.
fn build_about(
    model: Arc<Model>,
    scene: Scene,
    wanted: Wanted,
    known: &[&BuiltScene],
    goes_on: GoesOn<'_>,
) -> Result<BuiltScene> {
    let at = At::new(&scene, goes_on);
    let way = Way::of(WayInputs::of(&scene, &model), known.iter().map(|known| &known.way), at)?;
    way.check_length(&scene)?;
    let bent = Bent::of(BentInputs::of(&scene, &model, &way), known.iter().map(|known| &known.bent_head), at)?;
    let rest_pose = way.poses.first().copied().unwrap_or_default();
    let mut dynamics = dynamics(&scene, &model, rest_pose, at)?;
    let known_grooms = || known.iter().map(|known| &known.groom);
    let inputs = GroomInputs::of(&scene, &model, dynamics.polar_axis, wanted, known_grooms(), at)?;
    let mut groom = Groom::of(inputs, known_grooms(), at)?;
    if groom.imported.is_none() {
        // As drawn, so that exports show it the same way.
        let look = &scene.picture.hair;
        let look = (Some(look.width), Some(colour::of_mass(look)));
        let worn = &groom.hair.attributes.constant;
        if (worn.width, worn.colour) != look {
            let worn = &mut Arc::make_mut(&mut groom).hair.attributes.constant;
            (worn.width, worn.colour) = look;
        }
    }
    let inputs = ScalpInputs { bent: bent.clone(), groom: groom.clone() };
    let scalp = Scalp::of(inputs, known.iter().map(|known| &known.scalp), at)?;
    dynamics.skin = scalp.skin.clone();
    let (mut bodies, mut aim_files, mut of_speed) = (Vec::new(), Vec::new(), 0.0);
    if scene.form == FormChoice::Free {
        let mean = mean_lengths(&groom.first);
        let mut form = scene.free.resolved(&dynamics, mean);
        form.regions.iter_mut().for_each(|region| region.fields.retain(|of| !scene.field.is_off(&of.field)));
        of_speed = carrying_force(&dynamics, mean.strand, form.settle.mean());
        let earth = earth_gravity(&dynamics, mean.strand).into();
        let known_files = known.iter().flat_map(|known| &known.aim_files);
        let aims;
        (aims, aim_files) = super::aims::aims(&scene, &way, &groom, earth, known_files, at)?;
        let known = known.iter().flat_map(|known| &known.bodies);
        bodies = set_free(&mut dynamics, (form, aims), &scene, (&model, &way, &bent), &groom, rest_pose, known, at)?;
    }
    let intervals = scene.field.force.iter().map(|force| force.keyframe(of_speed)).collect();
    let inputs = ForcesInputs::of(&scene, &model, &way, intervals);
    let forces = Forces::of(inputs, known.iter().map(|known| &known.forces), at)?;
    Ok(BuiltScene { scene, model, way, bent_head: bent, groom, scalp, forces, dynamics, bodies, aim_files, of_speed })
}

/// The bound of each field of the scene, and last that of `all` together.
pub(super) fn field_bounds(scene: &Scene) -> Result<Vec<FieldBound>> {
    let with_all = |Forces { field, bounds, .. }: &Forces| {
        let all = FieldBound { name: "all".to_owned(), at_most: field.strongest() };
        bounds.iter().cloned().chain([all]).collect()
    };
    if scene.field.force.iter().any(|force| force.speed.is_some()) {
        // The strength of a wind given by speed depends on the length of the hair.
        return Ok(with_all(&scene.clone().build(Shown::AtMost(1))?.forces));
    }
    let at = At::new(scene, &|_| true);
    let model = Model::make(ModelInputs::of(scene), at)?;
    let way = Way::make(WayInputs::of(scene, &model), at)?;
    way.check_length(scene)?;
    let forces = Forces::make(ForcesInputs::of(scene, &model, &way, scene.field.as_given()), at);
    Ok(with_all(&forces.map_err(|refused| refused.blamed_on(model.of_size()))?))
}
