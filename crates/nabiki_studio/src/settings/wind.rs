//! What pushes the hair.

use super::{Group, Shape, When};

pub(super) const GROUPS: &[Group] = &[
    Group::new(
        "Between intervals",
        "wind",
        "How one vector leads to the next. The intervals in the timeline set the vectors.",
        &["ease"],
    )
    .open(),
    Group::new(
        "Gusts",
        "gust",
        "A random factor on the vectors of the intervals, which rises and falls like real wind.",
        &["intensity", "time_scale", "highest", "seed"],
    )
    .shaped(Shape::Optional("")),
    Group::new(
        "Turbulence",
        "turbulence",
        "Random swirls that drift with the wind and run along the head.",
        &["strength", "swirl_size", "pulse_length", "roughness", "octaves", "drift", "near_head", "seed", "envelope"],
    )
    .shaped(Shape::Optional("")),
    Group::new(
        "Flow around the head",
        "flow",
        "Makes the wind flow around the head instead of through it.",
        &["thickness"],
    )
    .shaped(Shape::Optional("")),
    Group::new(
        "Wind from head motion",
        "body_wind",
        "The wind that a moving head makes. Requires Head motion.",
        &["drag", "footfall", "smoothing"],
    )
    .shaped(Shape::Optional("")),
    Group::new(
        "Fans",
        "fan",
        "Wind that blows in a cone.",
        &["position", "direction", "strength", "spread", "falloff.law", "falloff.radius", "envelope"],
    )
    .shaped(Shape::List("position = [40.0, 0.0, 0.0]\ndirection = [-1.0, 0.0, 0.0]\nfalloff = { radius = 80.0 }")),
    Group::new(
        "Whirls",
        "vortex",
        "Forces around an axis.",
        &["position", "axis", "strength", "falloff.law", "falloff.radius", "envelope"],
    )
    .shaped(Shape::List("position = [-20.0, 0.0, 0.0]")),
    Group::new(
        "Points",
        "point",
        "Points that push the hair away or pull it in.",
        &["position", "strength", "falloff.law", "falloff.radius", "envelope"],
    )
    .shaped(Shape::List("position = [-30.0, 0.0, 0.0]\nstrength = -50.0")),
    Group::new(
        "Disturbance",
        "disturbance",
        "Turns each strand slightly at random, every few frames.",
        &["every", "from", "amplitude", "over", "seed"],
    )
    .shaped(Shape::Optional(""))
    .when(When::Paper),
    Group::new(
        "Pseudo-force",
        "pseudo_force",
        "Weakens the wind in front of the head. The paper uses it in place of collisions.",
        &["alpha", "coefficients"],
    ),
];
