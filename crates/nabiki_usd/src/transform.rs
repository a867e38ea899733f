//! Transforms of prims, from the operations that each lists.

use std::collections::HashMap;
use std::rc::Rc;

use glam::{DMat4, DVec3};
use nabiki::hair::Stored;

use crate::Problem;
use crate::opened::Layer;
use crate::primvars;

/// Transforms of one prim; a tool that bakes writes one, a rig some ten.
const MOST_OPERATIONS: usize = 1024;
/// Numbers of the largest, a matrix.
const MOST_NUMBERS: usize = 16;
/// What one counts for in the budget of its file.
const A_TRANSFORM: u64 = 32;

/// The product of all transforms from the top down to `prim` at a time code. Between samples, each operation is
/// interpolated before the product is taken, as USD does.
pub fn world(layer: &mut Layer, prim: usize, time: f64) -> Result<DMat4, Problem> {
    // Many prims stand below the same ones.
    if layer.worlds.0 != time {
        layer.worlds = (time, HashMap::new());
    }
    let mut world = DMat4::IDENTITY;
    let mut locals: Vec<(usize, DMat4)> = Vec::new();
    let upward: Vec<usize> = layer.upward(prim).collect();
    for i in upward {
        if let Some(&known) = layer.worlds.1.get(&i) {
            world = known;
            break;
        }
        let (local, resets) = local(layer, i, time)?;
        locals.push((i, local));
        if resets {
            break;
        }
    }
    for (i, local) in locals.into_iter().rev() {
        world *= local;
        layer.worlds.1.insert(i, world);
    }
    Ok(world)
}

/// The time codes at which `prim` or a prim above it moves.
pub fn times(layer: &Layer, prim: usize) -> Vec<f64> {
    let moving = layer.upward(prim).filter(|&i| layer.standing[i].moves_itself);
    let attributes = moving.flat_map(|i| &layer.prims[i].attributes);
    let moving = attributes.filter(|(name, _)| name.starts_with("xformOp:"));
    moving.flat_map(|(_, a)| a.samples.iter().map(|&(t, _)| t)).collect()
}

/// The operations that the order of `prim`, or of one above it, names and that are not there, a phrase each: USD passes over them, too.
pub fn not_there(layer: &mut Layer, prim: usize) -> Result<Vec<String>, Problem> {
    let mut lines = Vec::new();
    let upward: Vec<usize> = layer.upward(prim).collect();
    for i in upward {
        let own = not_there_itself(layer, i)?;
        let letters: usize = own.iter().map(|line| size_of::<String>() + line.len()).sum();
        layer.budget.take(letters as u64, "notes on transforms")?;
        lines.extend_from_slice(&own);
    }
    lines.sort();
    lines.dedup();
    Ok(lines)
}

/// The same of the prim's own order. Read once: thousands of prims may stand below it.
fn not_there_itself(layer: &mut Layer, prim: usize) -> Result<Rc<[String]>, Problem> {
    if let Some(known) = layer.not_there.get(&prim) {
        return Ok(known.clone());
    }
    let order = layer.at(prim, "xformOpOrder", f64::NEG_INFINITY).filter(|_| layer.prims[prim].is_transformable());
    let words = order.map(|order| layer.words(order)).transpose()?.unwrap_or_default();
    let mut lines = Vec::new();
    for word in words {
        let name = word.strip_prefix("!invert!").unwrap_or(&word);
        if name != RESET && !layer.prims[prim].attributes.contains_key(name) {
            let line = format!("{word:?} of {}: its xformOpOrder names it, but it does not exist", layer.path(prim));
            layer.budget.keep(line.len() as u64, "notes on transforms")?;
            lines.push(line);
        }
    }
    if layer.prims[prim].attributes.contains_key("xformOpOrder") && !layer.prims[prim].is_transformable() {
        let kind = if layer.prims[prim].type_name.is_empty() { "has no type" } else { "is a Scope" };
        lines.push(format!("the transform of {}: USD ignores it, because the prim {kind}", layer.path(prim)));
    }
    let lines: Rc<[String]> = lines.into();
    layer.not_there.insert(prim, lines.clone());
    Ok(lines)
}

/// What in an order takes away the transforms above.
const RESET: &str = "!resetXformStack!";

/// A prim's own transform, and whether those above it do not count.
fn local(layer: &mut Layer, prim: usize, time: f64) -> Result<(DMat4, bool), Problem> {
    let mut local = DMat4::IDENTITY;
    let mut resets = false;
    let order = layer.at(prim, "xformOpOrder", time).filter(|_| layer.prims[prim].is_transformable());
    let Some(order) = order else { return Ok((local, resets)) };
    let words = layer.words(order)?;
    if words.len() > MOST_OPERATIONS {
        let (path, found) = (layer.path(prim), words.len());
        return Err(Problem(format!(
            "prim {path}: {found} transforms in its xformOpOrder, but nabiki reads at most {MOST_OPERATIONS}: combine them"
        )));
    }
    for word in words {
        // Each is looked up, read and multiplied at every time code.
        layer.budget.take(A_TRANSFORM, "transforms")?;
        if word == RESET {
            (local, resets) = (DMat4::IDENTITY, true);
            continue;
        }
        let (inverted, name) = match word.strip_prefix("!invert!") {
            Some(name) => (true, name),
            None => (false, word.as_str()),
        };
        let Some(attribute) = layer.prims[prim].attributes.get(name) else { continue };
        let kind = name.strip_prefix("xformOp:").and_then(|rest| rest.split(':').next()).unwrap_or_default();
        if attribute.has_spline && attribute.samples.is_empty() {
            let path = layer.path(prim);
            return Err(Problem(format!(
                "prim {path}: {name} is a spline, which is not read: bake it to time samples"
            )));
        }
        let is_known = attribute.type_name.is_empty() || fits(kind, &attribute.type_name) && !attribute.is_array;
        let operation = if !is_known {
            None
        } else if kind == "orient" {
            let turn = layer.quaternions_at(prim, name, time)?.unwrap_or_default();
            Some(turn.first().map_or(DMat4::IDENTITY, |&turn| DMat4::from_quat(turn)))
        } else {
            if let Some(value) = layer.at(prim, name, time)
                && layer.has_more_than(value, MOST_NUMBERS)?
            {
                return Err(Problem(format!("prim {}: {name} is not a transform", layer.path(prim))));
            }
            match layer.numbers_at(prim, name, time)?.as_deref() {
                // What has no value, or one that is blocked, moves nothing in USD.
                None | Some([]) => Some(DMat4::IDENTITY),
                Some(numbers) => operation(kind, numbers),
            }
        };
        let Some(operation) = operation else {
            let path = layer.path(prim);
            return Err(Problem(format!("prim {path}: {name} is not a transform of USD")));
        };
        local *= if inverted { operation.inverse() } else { operation };
    }
    Ok((local, resets))
}

/// Whether values of a type can be operations of a kind.
fn fits(kind: &str, type_name: &str) -> bool {
    if kind == "orient" {
        return matches!(type_name, "quath" | "quatf" | "quatd");
    }
    let numbers = primvars::kind(type_name).filter(|k| matches!(k.stored, Stored::F16 | Stored::F32 | Stored::F64));
    let wanted = match kind {
        "transform" => 16,
        "translateX" | "translateY" | "translateZ" | "scaleX" | "scaleY" | "scaleZ" => 1,
        "rotateX" | "rotateY" | "rotateZ" => 1,
        _ => 3,
    };
    numbers.is_some_and(|numbers| numbers.extent == wanted)
}

/// One operation as a matrix that multiplies columns.
fn operation(kind: &str, v: &[f64]) -> Option<DMat4> {
    let triple = || v.get(..3).map(DVec3::from_slice);
    let turn = |axes: &str| {
        let angles = triple()?;
        // Rows multiplied from the left turn about the first letter first; in columns that one stands last.
        Some(axes.chars().fold(DMat4::IDENTITY, |product, axis| match axis {
            'X' => DMat4::from_rotation_x(angles.x.to_radians()) * product,
            'Y' => DMat4::from_rotation_y(angles.y.to_radians()) * product,
            _ => DMat4::from_rotation_z(angles.z.to_radians()) * product,
        }))
    };
    Some(match kind {
        "translate" => DMat4::from_translation(triple()?),
        "translateX" => DMat4::from_translation(DVec3::X * v.first()?),
        "translateY" => DMat4::from_translation(DVec3::Y * v.first()?),
        "translateZ" => DMat4::from_translation(DVec3::Z * v.first()?),
        "scale" => DMat4::from_scale(triple()?),
        "scaleX" => DMat4::from_scale(DVec3::new(*v.first()?, 1.0, 1.0)),
        "scaleY" => DMat4::from_scale(DVec3::new(1.0, *v.first()?, 1.0)),
        "scaleZ" => DMat4::from_scale(DVec3::new(1.0, 1.0, *v.first()?)),
        "rotateX" => DMat4::from_rotation_x(v.first()?.to_radians()),
        "rotateY" => DMat4::from_rotation_y(v.first()?.to_radians()),
        "rotateZ" => DMat4::from_rotation_z(v.first()?.to_radians()),
        "rotateXYZ" | "rotateXZY" | "rotateYXZ" | "rotateYZX" | "rotateZXY" | "rotateZYX" => turn(&kind[6..])?,
        "transform" => DMat4::from_cols_array(v.try_into().ok()?),
        _ => return None,
    })
}
