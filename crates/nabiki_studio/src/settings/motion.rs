//! How hair answers.

use super::{Group, Kind, Setting, Shape, When, choice, fine, flag, number, vector, whole};

pub(super) const GROUPS: &[Group] = &[
    Group::new(
        "Time",
        "motion",
        "How long it goes, and by which equations.",
        &[
            choice("form", "Form", &["paper", "free"], "Paper: the equations of 1993. Free: hair comes back to rest, stays out of the head and rides on it."),
            whole("frames", "Frames", "", [1, 10_000_000], "Frames after the rest frame 0."),
            fine("frame_rate", "Frame rate", "a second", [1.0, 240.0], 0.1, "Frames in a second: how fast they are shown, and where a recorded head is in each."),
            choice("force_space", "Forces", &["world", "head"], "Whether forces stay in the world while the head turns under them, or turn with it."),
        ],
    )
    .open(),
    Group::new(
        "Shape and calm",
        "free",
        "What holds hair in shape and brings it to rest.",
        &[
            Setting::new("stiffness", "Stiffness", "", Kind::Profile { most: 1e7, step: 20.0 }, "With what moment a joint turns its two segments toward their rest shape. Where it is 36 times the wind, hair bends within 6 segment lengths."),
            Setting::new("hold", "Hold", "", Kind::Profile { most: 1e5, step: 0.5 }, "What turns a segment toward its rest direction, as hair spray does; in the unit of the force."),
            Setting::new("settle", "Settle", "frames", Kind::Profile { most: 1e5, step: 0.2 }, "Frames in which a swing dies to 1/e; 0: never."),
            Setting::new("gravity", "Weight", "", Kind::NumberOr { word: "earth", most: 1e6, step: 1.0 }, "The weight of hair that has been moved, in the unit of the force, or that of the earth at this frame rate."),
            fine("lag", "Lag", "", [0.0, 8.0], 0.01, "How far tips stay behind a head that turns; 0: not at all."),
            flag("pseudo_force", "Pseudo-force", "Whether the paper's pseudo-force weakens the wind before the head, too."),
        ],
    )
    .open()
    .when(When::Free),
    Group::new(
        "Touch",
        "contact",
        "How hair and head touch.",
        &[
            fine("margin", "Margin", "cm", [0.0, 5.0], 0.005, "How far from the skin hair is kept; what lies closer at rest stays so."),
            fine("friction", "Friction", "", [0.0, 10.0], 0.005, "The part of a push that sliding hair loses of its speed."),
            fine("static_friction", "Static friction", "", [0.0, 10.0], 0.005, "The same for hair that lies still; at least the friction."),
        ],
    )
    .when(When::Free),
    Group::new(
        "Neighbours",
        "neighbours",
        "Hair against hair.",
        &[
            number("pressure", "Pressure", "", [0.0, 1e4], "Pushes hair out of places fuller than at rest."),
            number("cohesion", "Cohesion", "", [0.0, 1e4], "Hair takes the hair beside it along."),
            fine("cell", "Cell", "cm", [0.5, 20.0], 0.02, "Edge of a cell of the grid in which hair feels hair."),
            whole("carriers", "Carriers", "strands", [1, 4096], "Strands that stand for the whole in that grid."),
        ],
    )
    .shaped(Shape::Optional(""))
    .when(When::Free),
    Group::new(
        "Tie",
        "free.tie",
        "A band: hair that passes it does not move before it.",
        &[
            vector("at", "At", "cm", 0.05, "Its middle, in head space."),
            fine("within", "Within", "cm", [0.01, 50.0], 0.02, "How near a strand passes that is tied."),
        ],
    )
    .shaped(Shape::Optional("at = [-11.0, 2.0, 0.0]\nwithin = 1.5"))
    .when(When::Free),
    Group::new(
        "Inertia",
        "motion",
        "How heavy hair is, and how far a frame leads it.",
        &[
            fine("time_step", "Time step", "", [1e-4, 10.0], 0.001, "Delta t of equation (7); a frame is one step."),
            fine("linear_density", "Density", "per cm", [1e-4, 100.0], 0.0005, "Mass of a centimetre of hair, in the units of the force."),
            fine("inertia_length_floor", "Shortest inertia", "cm", [0.0, 1000.0], 0.1, "Shorter hair has the inertia of hair this long: its longer neighbours hold it. 0: the paper's way."),
            fine("straighten", "Straighten", "degrees", [0.0, 45.0], 0.1, "Segments that hang within this of the vertical at rest hang exactly so, and swing in any direction."),
        ],
    ),
];
