//! The free form of a scene: its bodies loaded, its carriers chosen, its gravity reckoned.

use std::sync::Arc;

use nabiki::body::{Body, BodyWay, skin_of};
use nabiki::dynamics::{Dynamics, Form};
use nabiki::free_form::{FreeMotion, Neighbours, earth_gravity};
use nabiki::pseudo_force::PseudoForce;
use nabiki::{Head, Mesh, Pose, Strands};
use nabiki_io::{declared_space, mesh};

use super::{read_motion, there};
use crate::built::BuiltBody;
use crate::error::Result;
use crate::scene::{BodySettings, FormChoice, Gravity, Scene};

/// Strands that stand for the whole where one number is wanted of it.
const FEW: usize = 256;

/// How many of the first strands of the whole are needed, whichever are shown.
pub(super) fn first_wanted(scene: &Scene) -> usize {
    match scene.form {
        FormChoice::Paper => 0,
        FormChoice::Free => scene.neighbours.as_ref().map_or(FEW, |n| FEW.max(n.carriers as usize)),
    }
}

/// Gives `dynamics` the scene's free form. `first`: strands of the whole, as many as are wanted or as there are. Returns the
/// scene's bodies as they are drawn.
pub(super) fn set(
    dynamics: &mut Dynamics,
    scene: &Scene,
    head: &Head,
    first: &Strands,
    rest_pose: Pose,
) -> Result<Vec<BuiltBody>> {
    let gravity = match scene.free.gravity {
        Gravity::Strength(strength) => strength,
        Gravity::Earth => {
            let few = first.lengths().take(FEW);
            let mean = few.map(f64::from).sum::<f64>() / first.len().clamp(1, FEW) as f64;
            earth_gravity(dynamics, mean)
        }
    };
    let mut bodies = vec![Body::head(head, scene.contact)];
    let mut drawn = Vec::new();
    for (i, settings) in scene.bodies.iter().enumerate() {
        let name = format!("body[{i}]");
        let (mesh, way) = mesh_and_way(scene, settings, &name)?;
        way.check(&name, scene.motion.frames).map_err(|refused| scene.refusal(refused))?;
        if settings.solid {
            let distance = skin_of(mesh.clone(), &format!("{name}.mesh")).map_err(|refused| scene.refusal(refused))?;
            let (distance, way, contact) = (Arc::new(distance), way.clone(), settings.contact());
            bodies.push(Body { name, distance, filled: None, way, contact });
        }
        drawn.push(BuiltBody { mesh, way });
    }
    let neighbours = scene.neighbours.as_ref().map(|forces| {
        let carriers = (forces.carriers as usize).min(first.len());
        Neighbours { forces: forces.clone(), carriers: Arc::new(first.select(&(0..carriers).collect::<Vec<_>>())) }
    });
    if !scene.free.pseudo_force {
        dynamics.pseudo_force = PseudoForce::off();
    }
    dynamics.form = Form::Free(FreeMotion { form: scene.free.form(gravity), bodies, neighbours, rest_pose });
    dynamics.check().map_err(|refused| scene.refusal(refused))?;
    Ok(drawn)
}

fn mesh_and_way(scene: &Scene, settings: &BodySettings, name: &str) -> Result<(Mesh, BodyWay)> {
    let file = there(scene, &format!("{name}.mesh"), &settings.mesh)?;
    let declared = declared_space(&file)?;
    let placement = settings.placement(declared.unit, declared.up);
    placement.check(name).map_err(|refused| scene.refusal(refused))?;
    let (mesh, _) = mesh::import(&file, &placement, &settings.groups)?;
    let way = match &settings.motion {
        _ if settings.with_head => BodyWay::WithHead,
        None => BodyWay::InWorld(Arc::new([Pose::STILL])),
        Some(source) => BodyWay::InWorld(read_motion(scene, source, &format!("{name}.motion"))?.poses.into()),
    };
    Ok((mesh, way))
}
