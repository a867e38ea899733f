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
    Group::new("Head", "head", "Where the head comes from.", &["mesh", "ellipsoid", "shell"]).open(),
    Group::new(
        "How its file lies",
        "head",
        "What the file does not say itself.",
        &["groups", "unit", "up", "facing", "origin"],
    )
    .open()
    .when(When::ImportedHead),
    Group::new("Motion of the head", "head.motion", "A file that moves the head; without one it stands still.", MOTION)
        .shaped(Shape::Optional("")),
    Group::new(
        "Bodies",
        "body",
        "What else hair does not enter.",
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
    Group::new("Motion of a body", "body.motion", "A file that moves the body; without one it stands still.", MOTION)
        .shaped(Shape::Optional(""))
        .when(When::Free),
];
