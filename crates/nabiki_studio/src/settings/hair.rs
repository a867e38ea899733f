//! How hair lies at rest.

use super::{Group, Shape, When};

pub(super) const GROUPS: &[Group] = &[
    Group::new(
        "Strands",
        "hair",
        "How many, and how finely cut.",
        &["strands", "segments", "segment_length", "seed"],
    )
    .open()
    .when(When::Grown),
    Group::new(
        "Hair file",
        "hair",
        "Where the strands are read from.",
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
        "Length before any cut.",
        &["length.top", "length.sides", "length.back", "length.fringe"],
    )
    .open()
    .when(When::Grown),
    Group::new(
        "Cuts",
        "hair.style.cuts",
        "Planes beyond which hair is cut off.",
        &["point", "normal", "region", "shortest"],
    )
    .shaped(Shape::List("point = [0.0, -18.0, 0.0]\nnormal = [0.0, -1.0, 0.0]"))
    .when(When::Grown),
    Group::new(
        "Curl",
        "hair.style.curl",
        "Every strand winds about the line in which it would hang.",
        &["radius", "pitch", "from", "flatness", "gather", "variation", "frizz"],
    )
    .when(When::Grown),
    Group::new(
        "Parting",
        "hair.style.parting",
        "The line that hair is combed away from, as seen from above.",
        &["front", "crown", "wobble"],
    )
    .when(When::Grown),
    Group::new(
        "Comb",
        "hair.style.comb",
        "The styling force near the root.",
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
        "Over about this length hair bends under its own weight.",
        &["stiffness.top", "stiffness.sides", "stiffness.back", "stiffness.fringe", "lever_arms"],
    )
    .when(When::Grown),
    Group::new(
        "Lift",
        "hair.style",
        "Angle between a root and the scalp.",
        &["lift_degrees.top", "lift_degrees.sides", "lift_degrees.back", "lift_degrees.fringe"],
    )
    .when(When::Grown),
    Group::new(
        "Volume",
        "hair.style.volume",
        "How hair lies over hair.",
        &["thickness", "reach", "gap", "over_ears"],
    )
    .when(When::Grown),
    Group::new(
        "Clumps",
        "hair.style.clumps",
        "Neighbours that fall together.",
        &["size", "gather", "direction_degrees", "wave", "wave_length"],
    )
    .when(When::Grown),
    Group::new(
        "Variation",
        "hair.style.variation",
        "How much strands differ.",
        &["length", "stiffness", "direction_degrees", "strays", "cut", "baby_hair"],
    )
    .when(When::Grown),
    Group::new(
        "Ponytail",
        "hair.style.ponytail",
        "Hair goes along the head to a band, and falls from it.",
        &["at", "radius", "direction"],
    )
    .shaped(Shape::Optional("at = [-11.0, 2.0, 0.0]"))
    .when(When::Grown),
    Group::new(
        "Hairline",
        "hair.hairline",
        "Where hair grows: depths below the top of the head, in units of its mean horizontal half axis, 8.65 cm on the bust.",
        &["forehead", "temple_recession", "sideburns", "above_ears", "behind_ears", "nape", "fade", "wander"],
    )
    .when(When::Grown),
];
