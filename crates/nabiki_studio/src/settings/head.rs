//! The head, other bodies, and the files that they come from.

use super::{Group, Shape, When};

/// A file's motion, of the head or of a body.
const MOTION: &[&str] = &[
    "file",
    "skeleton",
    "node",
    "clip",
    "unit_cm",
    "up",
    "facing",
    "frames_per_second",
    "skip",
    "positions",
    "speed",
    "smoothing",
    "start_at_origin",
    "bind_at_start",
];

pub(super) const GROUPS: &[Group] = &[
    Group::new("Head", "head", "The shape of the head.", &["mesh", "ellipsoid", "shell"]).open(),
    Group::new(
        "Head file",
        "head",
        "Unit and orientation, where the file does not give them.",
        &["groups", "unit", "up", "facing", "origin"],
    )
    .open()
    .when(When::ImportedHead),
    Group::new(
        "Head motion",
        "head.motion",
        "A file that moves the head. Without one, the head does not move.",
        MOTION,
    )
    .shaped(Shape::Optional("")),
    Group::new(
        "Bodies",
        "body",
        "Other objects that hair collides with.",
        &[
            "mesh",
            "groups",
            "unit",
            "up",
            "facing",
            "origin",
            "with_head",
            "solid",
            "shown",
            "colour",
            "margin",
            "friction",
            "static_friction",
        ],
    )
    .shaped(Shape::List(""))
    .when(When::Free),
    Group::new("Body capsule", "body.capsule", "A capsule or ball in place of a mesh.", &["from", "to", "radius"])
        .shaped(Shape::Optional("from = [0.0, -20.0, 0.0]\nradius = 5.0"))
        .when(When::Free),
    Group::new(
        "Body motion",
        "body.motion",
        "A file that moves the body. Without one, the body does not move.",
        MOTION,
    )
    .shaped(Shape::Optional(""))
    .when(When::Free),
];
