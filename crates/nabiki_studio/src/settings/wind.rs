//! What pushes the hair.

use super::{Group, Shape, When};

pub(super) const GROUPS: &[Group] = &[
    Group::new(
        "From one vector to the next",
        "wind",
        "The vectors themselves are the intervals of the timeline.",
        &["ease"],
    )
    .open(),
    Group::new(
        "Gusts",
        "gust",
        "A random factor on the intervals' vectors, which rises and falls as wind does.",
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
    Group::new("Flow round the head", "flow", "Leads the wind round the head instead of through it.", &["thickness"])
        .shaped(Shape::Optional("")),
    Group::new(
        "Wind of the head's motion",
        "body_wind",
        "The wind that a head makes by moving; it needs a motion of the head.",
        &["drag", "footfall", "smoothing"],
    )
    .shaped(Shape::Optional("")),
    Group::new(
        "Fans",
        "fan",
        "Winds in a cone.",
        &["position", "direction", "strength", "spread", "falloff.law", "falloff.radius", "envelope"],
    )
    .shaped(Shape::List("position = [40.0, 0.0, 0.0]\ndirection = [-1.0, 0.0, 0.0]\nfalloff = { radius = 80.0 }")),
    Group::new(
        "Whirls",
        "vortex",
        "Forces round an axis.",
        &["position", "axis", "strength", "falloff.law", "falloff.radius", "envelope"],
    )
    .shaped(Shape::List("position = [-20.0, 0.0, 0.0]")),
    Group::new(
        "Points",
        "point",
        "Points that blow or draw.",
        &["position", "strength", "falloff.law", "falloff.radius", "envelope"],
    )
    .shaped(Shape::List("position = [-30.0, 0.0, 0.0]\nstrength = -50.0")),
    Group::new(
        "Disturbance",
        "disturbance",
        "Turns every strand a little, at random, every so many frames.",
        &["every", "from", "amplitude", "over", "seed"],
    )
    .shaped(Shape::Optional(""))
    .when(When::Paper),
    Group::new(
        "Pseudo-force",
        "pseudo_force",
        "Weakens the wind before the head: the paper's stand-in for collisions.",
        &["alpha", "coefficients"],
    ),
];
