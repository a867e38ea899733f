//! How hair answers.

use super::{Group, Shape, When};

pub(super) const GROUPS: &[Group] = &[
    Group::new(
        "Time",
        "motion",
        "How long the motion is, and which equations it follows.",
        &["form", "frames", "frame_rate", "slow", "force_space"],
    )
    .open(),
    Group::new(
        "Shape and settling",
        "free",
        "What holds hair in shape and brings it to rest.",
        &["stiffness", "hold", "settle", "gravity", "drag", "substeps", "pseudo_force"],
    )
    .open()
    .when(When::Free),
    Group::new(
        "Contact",
        "contact",
        "How hair collides with the head and slides on it.",
        &["margin", "friction", "static_friction"],
    )
    .when(When::Free),
    Group::new(
        "Neighbours",
        "neighbours",
        "How strands press on each other and stick together.",
        &["pressure", "cohesion", "cell", "carriers"],
    )
    .shaped(Shape::Optional(""))
    .when(When::Free),
    Group::new(
        "Locks",
        "free.variation",
        "How locks differ, so that they separate in the wind.",
        &["air", "flutter", "flutter_frames", "stiffness", "strands", "flyaways", "size", "seed"],
    )
    .shaped(Shape::Optional(""))
    .when(When::Free),
    Group::new(
        "Regions",
        "free.regions",
        "Hair that moves differently from the rest, such as a fringe that stays.",
        &[
            "name",
            "groups",
            "attribute",
            "values",
            "map",
            "painted",
            "near",
            "to",
            "within",
            "soft",
            "stiffness",
            "hold",
            "settle",
            "wind",
            "fields",
            "drag",
            "gravity",
            "margin",
        ],
    )
    .shaped(Shape::List(
        "near = [5.5, 8.6, -5.0]\nto = [5.5, 8.6, 5.0]\nwithin = 3.0\nsoft = 1.5\nhold = 4.0\nwind = 0.1",
    ))
    .when(When::Free),
    Group::new(
        "Aims",
        "aim",
        "Shapes that hair is led to in some frames.",
        &[
            "name", "region", "file", "curves", "frame", "toward", "groom", "strength", "from", "through", "ease_in",
            "ease_out",
        ],
    )
    .shaped(Shape::List("groom = true"))
    .when(When::Free),
    Group::new(
        "Tie",
        "free.tie",
        "A band that ties the hair. From root to band, the hair does not move.",
        &["at", "within"],
    )
    .shaped(Shape::Optional("at = [-11.0, 2.0, 0.0]\nwithin = 1.5"))
    .when(When::Free),
    Group::new(
        "Inertia",
        "motion",
        "How heavy the hair is, and how far it moves in a frame.",
        &["time_step", "linear_density", "inertia_length_floor", "straighten"],
    ),
];
