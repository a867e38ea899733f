//! What pushes the hair.

use super::{Group, Kind, Setting, Shape, When, choice, fine, number, vector, whole};

const LAWS: &[&str] = &["none", "linear", "smooth", "inverse", "inverse_square"];
const FORCE: [f64; 2] = [-1e5, 1e5];
const LENGTH: [f64; 2] = [0.01, 1e4];
const SEED: [i64; 2] = [0, i64::MAX];

const LAW: Setting = choice(
    "falloff.law",
    "Falloff",
    LAWS,
    "How the force weakens with the distance r: none, in a line to 0 at the radius R, smoothly to 0 there, as 1 / (1 + r/R), or as 1 / (1 + (r/R)^2).",
);
const RADIUS: Setting = number(
    "falloff.radius",
    "Radius",
    "cm",
    LENGTH,
    "R of the falloff. Within a twentieth of it the force is let go to 0.",
);
const ENVELOPE: Setting = Setting::new(
    "envelope",
    "Over time",
    "",
    Kind::Envelope,
    "Parts of the strength at some frames, with straight lines between; all of it always if there are none.",
);

pub(super) const GROUPS: &[Group] = &[
    Group::new(
        "From one vector to the next",
        "wind",
        "The vectors themselves are the intervals of the timeline.",
        &[choice(
            "ease",
            "Ease",
            &["stepped", "linear", "smooth"],
            "Stepped: each vector holds through its interval, the paper's way. Otherwise each is reached in the middle of its interval.",
        )],
    )
    .open(),
    Group::new(
        "Gusts",
        "gust",
        "A random factor on the intervals' vectors, which rises and falls as wind does.",
        &[
            fine("intensity", "Intensity", "", [0.0, 2.0], 0.005, "Root mean square of the factor about 1. Open country 0.15, a town 0.4; above 0.4 the wind now and then turns round."),
            fine("time_scale", "Time scale", "s", [0.01, 100.0], 0.02, "Length of the turbulence over the mean speed of the wind."),
            fine("highest", "Highest", "Hz", [0.01, 100.0], 0.01, "Highest frequency. What is faster is not felt by all of the hair at once."),
            whole("seed", "Seed", "", SEED, "Another number, other gusts."),
        ],
    )
    .shaped(Shape::Optional("")),
    Group::new(
        "Turbulence",
        "turbulence",
        "Random swirls that drift with the wind and run along the head.",
        &[
            number("strength", "Strength", "", [0.0, 1e4], "Root mean square of |F| over space, far from the head."),
            fine("swirl_size", "Swirl size", "cm", [0.1, 1000.0], 0.1, "Size of the largest swirls."),
            number("pulse_length", "Pulse", "frames", [0.0, 1e4], "Frames in which a swirl turns into its opposite and back, about; 0: swirls drift and never change."),
            fine("roughness", "Roughness", "", [0.0, 1.0], 0.005, "Strength of each octave by that of the one before; 0.79 is Kolmogorov's."),
            whole("octaves", "Octaves", "", [1, 8], "Each is half as large as the one before. Time is spent on each."),
            fine("drift", "Drift", "cm", [0.0, 10.0], 0.001, "Way that swirls go in a frame for each unit of the wind."),
            fine("near_head", "Near the head", "cm", [0.0, 20.0], 0.05, "Distance from the head within which the force is turned along it; 0: it knows nothing of the head."),
            whole("seed", "Seed", "", SEED, "Another number, other swirls."),
            ENVELOPE,
        ],
    )
    .shaped(Shape::Optional("")),
    Group::new(
        "Flow round the head",
        "flow",
        "Leads the wind round the head instead of through it.",
        &[fine("thickness", "Thickness", "cm", [0.0, 20.0], 0.02, "What the wind goes round stands out so far from the head ellipsoid, as hair itself does.")],
    )
    .shaped(Shape::Optional("")),
    Group::new(
        "Wind of the head's motion",
        "body_wind",
        "The wind that a head makes by moving; it needs a motion of the head.",
        &[
            fine("drag", "Drag", "per cm/s", [0.0, 100.0], 0.005, "Force for each cm/s of the head, against its way."),
            fine("footfall", "Footfall", "per cm/s2", [0.0, 10.0], 0.001, "Force for each cm/s2 by which the head is lifted, downward."),
            number("smoothing", "Smoothing", "frames", [0.0, 240.0], "Deviation of the bell by which the head's places are averaged. Recorded places tremble, and accelerations many times more."),
        ],
    )
    .shaped(Shape::Optional("")),
    Group::new(
        "Fans",
        "fan",
        "Winds in a cone.",
        &[
            vector("position", "Position", "cm", 0.1, "The tip of the cone."),
            vector("direction", "Direction", "", 0.01, "Where it blows, of any length but 0."),
            number("strength", "Strength", "", FORCE, "|F| on the axis beside the fan; negative draws in."),
            number("spread", "Spread", "degrees", [1.0, 90.0], "Angle between the axis and the edge of the cone."),
            LAW,
            RADIUS,
            ENVELOPE,
        ],
    )
    .shaped(Shape::List("position = [40.0, 0.0, 0.0]\ndirection = [-1.0, 0.0, 0.0]\nfalloff = { radius = 80.0 }")),
    Group::new(
        "Whirls",
        "vortex",
        "Forces round an axis.",
        &[
            vector("position", "Position", "cm", 0.1, "A point of the axis."),
            vector("axis", "Axis", "", 0.01, "Along the axis: hair goes round it counter-clockwise as seen from its tip."),
            number("strength", "Strength", "", FORCE, "|F| beside the axis; negative goes round the other way."),
            LAW,
            RADIUS,
            ENVELOPE,
        ],
    )
    .shaped(Shape::List("position = [-20.0, 0.0, 0.0]")),
    Group::new(
        "Points",
        "point",
        "Points that blow or draw.",
        &[
            vector("position", "Position", "cm", 0.1, "Where it is."),
            number("strength", "Strength", "", FORCE, "|F| beside the point; negative draws in."),
            LAW,
            RADIUS,
            ENVELOPE,
        ],
    )
    .shaped(Shape::List("position = [-30.0, 0.0, 0.0]\nstrength = -50.0")),
    Group::new(
        "Disturbance",
        "disturbance",
        "Turns every strand a little, at random, every so many frames.",
        &[
            whole("every", "Every", "frames", [1, 100_000], "Frames from one disturbance to the next. The paper: 10."),
            whole("from", "From", "frame", [0, 10_000_000], "First frame that may be disturbed. The paper disturbs the last 60 of 100."),
            fine("amplitude", "Amplitude", "rad", [0.0001, std::f64::consts::PI], 0.002, "Largest turn at the tip."),
            whole("over", "Over", "frames", [1, 100_000], "Frames in which it sets in. At 1, the paper's way, it is seen as a jump."),
            whole("seed", "Seed", "", SEED, "Another number, other turns."),
        ],
    )
    .shaped(Shape::Optional(""))
    .when(When::Paper),
    Group::new(
        "Pseudo-force",
        "pseudo_force",
        "Weakens the wind before the head: the paper's stand-in for collisions.",
        &[
            fine("alpha", "Alpha", "", [-1.0, 1.0], 0.005, "The cosine that bounds Gamma: at 1 all of the shell, at -1 only the line against the wind."),
            Setting::new("coefficients", "Coefficients", "", Kind::List { whole: false }, "eps_i for the segments from the root on, each above 0 and at most 1; the last goes on to the tip."),
        ],
    ),
];
