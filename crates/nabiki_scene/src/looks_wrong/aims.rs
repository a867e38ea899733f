//! Aims that hair cannot follow, or that never begin.

use nabiki::aim::{Aim, AimShape};
use nabiki::dynamics::Form;
use nabiki::strands::length;
use nabiki_io::info::Short;

use crate::advice::Advice;
use crate::built::BuiltScene;

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
        if begins >= last && !built.scene.is_overridden("motion.frames") {
            let line =
                format!("{} changes nothing: it begins after frame {begins}, but the last frame is {last}", aim.name);
            advice.push(Advice::new(line));
        }
        let (AimShape::Curves(curves), lengths) = (&aim.shape, led(aim)) else { continue };
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

fn in_region(built: &BuiltScene, aim: &Aim, root: glam::Vec3) -> bool {
    let Form::Free(free) = &built.dynamics.form else { return false };
    aim.region.is_none_or(|region| free.weight_in(region, root) > 0.0)
}
