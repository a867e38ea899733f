//! How hair answers.

use super::{Group, Shape, When};

pub(super) const GROUPS: &[Group] = &[
    Group::new(
        "Time",
        "motion",
        "How long it goes, and by which equations.",
        &["form", "frames", "frame_rate", "slow", "force_space"],
    )
    .open(),
    Group::new(
        "Shape and calm",
        "free",
        "What holds hair in shape and brings it to rest.",
        &["stiffness", "hold", "settle", "gravity", "drag", "substeps", "pseudo_force"],
    )
    .open()
    .when(When::Free),
    Group::new("Touch", "contact", "How hair and head touch.", &["margin", "friction", "static_friction"])
        .when(When::Free),
    Group::new("Neighbours", "neighbours", "Hair against hair.", &["pressure", "cohesion", "cell", "carriers"])
        .shaped(Shape::Optional(""))
        .when(When::Free),
    Group::new(
        "Locks",
        "free.variation",
        "How locks differ, so that they part in the wind.",
        &["air", "flutter", "flutter_frames", "stiffness", "strands", "flyaways", "size", "seed"],
    )
    .shaped(Shape::Optional(""))
    .when(When::Free),
    Group::new("Tie", "free.tie", "A band: hair that passes it does not move before it.", &["at", "within"])
        .shaped(Shape::Optional("at = [-11.0, 2.0, 0.0]\nwithin = 1.5"))
        .when(When::Free),
    Group::new(
        "Inertia",
        "motion",
        "How heavy hair is, and how far a frame leads it.",
        &["time_step", "linear_density", "inertia_length_floor", "straighten"],
    ),
];
