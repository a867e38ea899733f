//! What pulls on hair in the free form, one force per file: over any scalar for the specification, and for one lane of the fast step.

pub(super) mod hold;
pub(super) mod joints;
pub(super) mod neighbours;
pub(super) mod weight;

use self::weight::Gravity;
use crate::dynamics::pull::Pull;
use crate::free_form::FreeMotion;

/// What may be too strong for the step, besides the field. Joints and hold are implicit and may have any strength.
pub(in crate::dynamics) fn pulls(free: &FreeMotion) -> Vec<Box<dyn Pull + '_>> {
    vec![Box::new(Gravity { setting: free.form.gravity, times: free.form.most_weight() })]
}
