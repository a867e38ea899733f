//! The free form of a scene: its bodies loaded, its carriers chosen, its gravity reckoned.

use std::sync::Arc;

use nabiki::body::{Body, BodyWay, skin_of};
use nabiki::dynamics::{Dynamics, Form};
use nabiki::free_form::{FreeMotion, Neighbours, earth_gravity};
use nabiki::pseudo_force::PseudoForce;
use nabiki::{Head, Pose, Strands};
use nabiki_io::{declared_space, mesh};

use super::{read_motion, there};
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

/// Gives `dynamics` the scene's free form. `first`: strands of the whole, as many as are wanted or as there are.
pub(super) fn set(dynamics: &mut Dynamics, scene: &Scene, head: &Head, first: &Strands, rest_pose: Pose) -> Result<()> {
    let gravity = match scene.free.gravity {
        Gravity::Strength(strength) => strength,
        Gravity::Earth => {
            let few = first.lengths().take(FEW);
            let mean = few.map(f64::from).sum::<f64>() / first.len().clamp(1, FEW) as f64;
            earth_gravity(dynamics, mean)
        }
    };
    let mut bodies = vec![Body::head(head, scene.contact)];
    for (i, settings) in scene.bodies.iter().enumerate() {
        bodies.push(body(scene, settings, i)?);
    }
    let neighbours = scene.neighbours.as_ref().map(|forces| {
        let carriers = (forces.carriers as usize).min(first.len());
        Neighbours { forces: forces.clone(), carriers: Arc::new(first.select(&(0..carriers).collect::<Vec<_>>())) }
    });
    if !scene.free.pseudo_force {
        dynamics.pseudo_force = PseudoForce::off();
    }
    dynamics.form = Form::Free(FreeMotion { form: scene.free.form(gravity), bodies, neighbours, rest_pose });
    dynamics.check().map_err(|refused| scene.refusal(refused).into())
}

fn body(scene: &Scene, settings: &BodySettings, i: usize) -> Result<Body> {
    let name = format!("body[{i}]");
    let file = there(scene, &format!("{name}.mesh"), &settings.mesh)?;
    let declared = declared_space(&file)?;
    let placement = settings.placement(declared.unit, declared.up);
    placement.check(&name).map_err(|refused| scene.refusal(refused))?;
    let (mesh, _) = mesh::import(&file, &placement, &settings.groups)?;
    let distance = skin_of(mesh, &format!("{name}.mesh")).map_err(|refused| scene.refusal(refused))?;
    let way = match &settings.motion {
        _ if settings.with_head => BodyWay::WithHead,
        None => BodyWay::InWorld(Arc::new([Pose::STILL])),
        Some(source) => BodyWay::InWorld(read_motion(scene, source, &format!("{name}.motion"))?.poses.into()),
    };
    Ok(Body { name, distance: Arc::new(distance), filled: None, way, contact: settings.contact() })
}
