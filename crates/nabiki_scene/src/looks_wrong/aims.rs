//! Aims that hair cannot follow, or that never begin.

use nabiki::aim::{Aim, AimCurves, AimShape};
use nabiki::dynamics::Form;
use nabiki::strands::length;
use nabiki_io::info::Short;

use crate::advice::Advice;
use crate::built::BuiltScene;
use crate::size::mean_half_axis;

/// Curves of more than this share of the hair's length lead to where it cannot reach.
const LONGER: f32 = 1.1;

/// What looks wrong about the aims of a scene.
pub(super) fn advice(built: &BuiltScene) -> Vec<Advice> {
    let Form::Free(free) = &built.dynamics.form else { return Vec::new() };
    let led = |aim: &Aim| -> Vec<f32> {
        let strands = built.strands().iter().filter(|strand| in_region(built, aim, strand[0]));
        strands.map(length).collect()
    };
    let mut advice = Vec::new();
    for aim in &free.aims {
        let begins = aim.lead.from.saturating_sub(aim.lead.ease_in);
        let last = built.frames();
        if begins > last && !built.scene.is_overridden("motion.frames") {
            let line =
                format!("{} changes nothing: it begins in frame {begins}, but the last frame is {last}", aim.name);
            advice.push(Advice::new(line));
        }
        let AimShape::Curves(curves) = &aim.shape else { continue };
        let lengths = led(aim);
        if let Some(far) = far_away(built, aim, curves).filter(|_| curves.frame().is_none()) {
            let line = format!(
                "the curves of {} begin {} cm from the hair that it leads: give the frame in which they are posed, or curves on the \
                 head at rest",
                aim.name,
                Short(far)
            );
            advice.push(Advice::new(line));
        }
        let mean = |of: &[f32]| of.iter().sum::<f32>() / of.len().max(1) as f32;
        let (hair, shape) = (mean(&lengths), mean(&curves.curves().lengths().collect::<Vec<_>>()));
        if !lengths.is_empty() && shape > LONGER * hair {
            let line = format!(
                "the curves of {} are {} cm long, but the hair that it leads only {} cm: hair takes their directions as far \
                 as it reaches",
                aim.name,
                Short(shape),
                Short(hair)
            );
            advice.push(Advice::new(line));
        }
    }
    advice
}

/// How far the curves begin from the hair, if that is farther than the head is wide (cm).
fn far_away(built: &BuiltScene, aim: &Aim, curves: &AimCurves) -> Option<f32> {
    let root = built.strands().iter().map(|strand| strand[0]).find(|&root| in_region(built, aim, root))?;
    let far = curves.curves().iter().map(|curve| curve[0].distance(root)).fold(f32::INFINITY, f32::min);
    (far > 2.0 * mean_half_axis(&built.model.head.ellipsoid)).then_some(far)
}

fn in_region(built: &BuiltScene, aim: &Aim, root: glam::Vec3) -> bool {
    let Form::Free(free) = &built.dynamics.form else { return false };
    aim.region.is_none_or(|region| free.weight_in(region, root) > 0.0)
}
