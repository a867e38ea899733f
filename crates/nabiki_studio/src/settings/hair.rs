//! How hair lies at rest.

use super::{Group, Shape, When};

pub(super) const GROUPS: &[Group] = &[
    Group::new(
        "Strands",
        "hair",
        "How many strands, and how many segments each has.",
        &["strands", "segments", "segment_length", "seed"],
    )
    .open()
    .when(When::Grown),
    Group::new(
        "Hair file",
        "hair",
        "The file that the strands come from.",
        &[
            "file", "groups", "strands", "segments", "segment_length", "unit", "up", "facing", "origin", "root",
            "join_within", "drop_shorter_than",
        ],
    )
    .open()
    .when(When::Imported),
    Group::new(
        "Length",
        "hair.style",
        "The length of the hair before any cut.",
        &["length.top", "length.sides", "length.back", "length.fringe"],
    )
    .open()
    .when(When::Grown),
    Group::new(
        "Cuts",
        "hair.style.cuts",
        "Planes that cut off the hair beyond them.",
        &["point", "normal", "region", "shortest"],
    )
    .shaped(Shape::List("point = [0.0, -18.0, 0.0]\nnormal = [0.0, -1.0, 0.0]"))
    .when(When::Grown),
    Group::new(
        "Curl",
        "hair.style.curl",
        "Winds each strand around the line in which it would hang.",
        &["radius", "pitch", "from", "flatness", "gather", "variation", "frizz"],
    )
    .when(When::Grown),
    Group::new(
        "Parting",
        "hair.style.parting",
        "The line from which hair is combed away, seen from above.",
        &["front", "crown", "wobble"],
    )
    .when(When::Grown),
    Group::new(
        "Comb",
        "hair.style.comb",
        "The styling force near the roots.",
        &["away", "sweep", "off_face", "decay"],
    )
    .when(When::Grown),
    Group::new(
        "Fringe",
        "hair.style.fringe",
        "Hair combed over the forehead.",
        &["half_width", "from", "forward", "aside"],
    )
    .when(When::Grown),
    Group::new(
        "Stiffness at rest",
        "hair.style",
        "The length over which hair bends under its own weight.",
        &["stiffness.top", "stiffness.sides", "stiffness.back", "stiffness.fringe", "lever_arms"],
    )
    .when(When::Grown),
    Group::new(
        "Lift",
        "hair.style",
        "The angle between hair and scalp at the roots.",
        &["lift_degrees.top", "lift_degrees.sides", "lift_degrees.back", "lift_degrees.fringe"],
    )
    .when(When::Grown),
    Group::new(
        "Volume",
        "hair.style.volume",
        "How layers of hair lie on each other.",
        &["thickness", "reach", "gap", "over_ears"],
    )
    .when(When::Grown),
    Group::new(
        "Clumps",
        "hair.style.clumps",
        "Neighbouring strands that fall together.",
        &["size", "gather", "direction_degrees", "wave", "wave_length"],
    )
    .when(When::Grown),
    Group::new(
        "Variation",
        "hair.style.variation",
        "How much the strands differ.",
        &["length", "stiffness", "direction_degrees", "strays", "cut", "baby_hair"],
    )
    .when(When::Grown),
    Group::new(
        "Ponytail",
        "hair.style.ponytail",
        "Gathers the hair along the head to a band, from which it falls.",
        &["at", "radius", "direction"],
    )
    .shaped(Shape::Optional("at = [-11.0, 2.0, 0.0]"))
    .when(When::Grown),
    Group::new(
        "Hairline",
        "hair.hairline",
        "Where hair grows. Depths are below the top of the head, in units of its mean horizontal half axis (8.65 cm on the bust).",
        &["forehead", "temple_recession", "sideburns", "above_ears", "behind_ears", "nape", "fade", "wander"],
    )
    .when(When::Grown),
];
