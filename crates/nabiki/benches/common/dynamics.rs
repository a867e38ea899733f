//! How hair of the default style answers a force.

use nabiki::Head;
use nabiki::body::{Body, Contact};
use nabiki::dynamics::{Dynamics, Form, Motion};
use nabiki::free_form::FreeMotion;
use nabiki::pseudo_force::PseudoForce;

/// Table 1's settings in a form, short hair moving with the long; the pseudo-force is the paper's form's alone.
pub fn dynamics(head: &Head, form: Form) -> Dynamics {
    Dynamics {
        motion: Motion { inertia_length_floor: 18.0, ..Motion::default() },
        pseudo_force: if form == Form::Paper { PseudoForce::default() } else { PseudoForce::off() },
        form,
        ..Dynamics::new(head.ellipsoid)
    }
}

/// The free form with the head in the way.
pub fn free(head: &Head) -> FreeMotion {
    FreeMotion { bodies: vec![Body::head(head, Contact::default())], ..FreeMotion::default() }
}
