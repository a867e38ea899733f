//! The free form of a scene: its bodies loaded, its carriers chosen, its gravity reckoned.

use std::sync::Arc;

use nabiki::body::{Body, BodyWay, Shape, skin_of};
use nabiki::dynamics::{Dynamics, Form, earth_gravity};
use nabiki::free_form::{FreeForm, FreeMotion, Gravity, Neighbours};
use nabiki::{Head, Pose, Strands};
use nabiki_io::{declared_space, mesh};

use super::{GoesOn, read_motion, still_wanted, there};
use crate::built::{BuiltBody, BuiltScene};
use crate::error::Result;
use crate::scene::{BodySettings, FormChoice, Scene};

/// Strands that stand for the whole where one number is wanted of it.
const FEW: usize = 256;

/// How many of the first strands of the whole are needed, whichever are shown.
pub(super) fn first_wanted(scene: &Scene) -> usize {
    match scene.form {
        FormChoice::Paper => 0,
        FormChoice::Free => scene.neighbours.as_ref().map_or(FEW, |n| FEW.max(n.carriers as usize)),
    }
}

/// Scenes that are built, of which bodies may be taken.
#[derive(Clone, Copy)]
pub(super) struct Known<'a> {
    /// One with the same head.
    pub same_head: Option<&'a BuiltScene>,
    /// One with the same frame rate, in the same folder.
    pub same_rate: Option<&'a BuiltScene>,
}

/// Gives `dynamics` the scene's free form. `first`: strands of the whole, as many as are wanted or as there are. Returns the
/// scene's bodies as they are drawn.
pub(super) fn set(
    dynamics: &mut Dynamics,
    scene: &Scene,
    head: &Head,
    first: &Strands,
    rest_pose: Pose,
    known: Known<'_>,
    goes_on: GoesOn<'_>,
) -> Result<Vec<BuiltBody>> {
    let gravity = match scene.free.gravity {
        Gravity::Strength(strength) => strength,
        Gravity::Earth => {
            let few = first.lengths().take(FEW);
            let mean = few.map(f64::from).sum::<f64>() / first.len().clamp(1, FEW) as f64;
            earth_gravity(dynamics, mean)
        }
    };
    let of_head = known.same_head.and_then(solid_bodies).and_then(|bodies| bodies.first());
    let mut bodies = vec![match of_head {
        Some(known) => {
            let mut head = known.clone();
            head.contact = scene.contact;
            head
        }
        None => Body::head(head, scene.contact),
    }];
    let mut drawn = Vec::new();
    for (i, settings) in scene.bodies.iter().enumerate() {
        let name = format!("body[{i}]");
        // All hair is grown by now.
        still_wanted(goes_on, 1.0)?;
        let known = known.same_rate.and_then(|known| known_body(known, settings, i));
        let (body, shape) = match known {
            Some(known) => known,
            None => (load(scene, settings, &name)?, None),
        };
        let BuiltBody { mesh, way, .. } = &body;
        let frames = scene.motion.frames;
        let long_enough = if settings.motion.is_some() { way.check_length(&name, frames) } else { Ok(()) };
        long_enough.and_then(|()| way.check(&name, frames)).map_err(|refused| scene.refusal(refused))?;
        if settings.solid {
            let shape = match shape {
                Some(shape) => shape,
                None => {
                    let skin = skin_of(mesh.clone(), &format!("{name}.mesh"));
                    Arc::new(skin.map_err(|refused| scene.refusal(refused))?).into()
                }
            };
            bodies.push(Body::new(name, shape, way.clone(), settings.contact()));
        }
        drawn.push(body);
    }
    let neighbours = scene.neighbours.as_ref().map(|forces| {
        let carriers = (forces.carriers as usize).min(first.len());
        Neighbours::new(forces.clone(), Arc::new(first.select(&(0..carriers).collect::<Vec<_>>())))
    });
    let form = FreeForm { gravity: Gravity::Strength(gravity), ..scene.free.clone() };
    dynamics.form = Form::Free(FreeMotion { form, bodies, neighbours, rest_pose });
    dynamics.check().map_err(|refused| scene.refusal(refused))?;
    Ok(drawn)
}

/// The bodies that hair of a scene in the free form does not enter, the head first.
fn solid_bodies(built: &BuiltScene) -> Option<&[Body]> {
    match &built.dynamics.form {
        Form::Free(free) => Some(&free.bodies),
        Form::Paper => None,
    }
}

/// Body `i` of a scene that is built, with its shape if it is solid there; none if its file or its motion is another.
fn known_body(known: &BuiltScene, settings: &BodySettings, i: usize) -> Option<(BuiltBody, Option<Shape>)> {
    let was = known.scene.bodies.get(i)?;
    let BodySettings { mesh, groups, unit, up, facing, origin, motion, with_head, .. } = settings;
    let same = *mesh == was.mesh
        && *groups == was.groups
        && *unit == was.unit
        && *up == was.up
        && *facing == was.facing
        && *origin == was.origin
        && *motion == was.motion
        && *with_head == was.with_head;
    let body = known.bodies.get(i).filter(|_| same)?.clone();
    let name = format!("body[{i}]");
    let solid = solid_bodies(known)?.iter().find(|body| body.name == name);
    Some((body, solid.map(|body| body.shape.clone())))
}

fn load(scene: &Scene, settings: &BodySettings, name: &str) -> Result<BuiltBody> {
    let file = there(scene, &format!("{name}.mesh"), &settings.mesh)?;
    let declared = declared_space(&file)?;
    let placement = settings.placement(declared.unit, declared.up);
    placement.check(name).map_err(|refused| scene.refusal(refused))?;
    let (mesh, report) = mesh::import(&file, &placement, &settings.groups)?;
    let way = match &settings.motion {
        _ if settings.with_head => BodyWay::WithHead,
        None => BodyWay::InWorld(Arc::new([Pose::STILL])),
        Some(source) => BodyWay::InWorld(
            read_motion(scene, source, &format!("{name}.motion"), (Some(&file), &placement))?.poses.into(),
        ),
    };
    Ok(BuiltBody { mesh, unread: report.unread, way })
}
