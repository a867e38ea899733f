//! The head, other bodies, and the files that they come from.

use super::{
    AXES, Group, Kind, MESH_FILES, MOTION_FILES, Setting, Shape, When, choice, colour, file, fine, flag, number,
    vector, whole,
};

const UNIT: Setting = Setting::new("unit", "Unit", "", Kind::Unit, "Unit of the file.").or("what the file says, or cm");
const UP: Setting = choice("up", "Up", AXES, "Axis of the file that points up.").or("what the file says, or +y");
const FACING: Setting = choice("facing", "Facing", AXES, "Axis of the file along which the face looks.").or("+x");
const GROUPS_OF_FILE: Setting = Setting::new(
    "groups",
    "Groups",
    "",
    Kind::Texts,
    "Groups, objects or nodes of the file to keep, separated by commas; all if empty.",
);

macro_rules! motion {
    () => {
        &[
            file("file", "File", MOTION_FILES, "A .bvh, .amc, .tof, .glb, .csv, USD layer or Alembic archive."),
            file(
                "skeleton",
                "Skeleton",
                &["asf", "tof"],
                "The .asf of an .amc, the .tof with the skeleton of a .tof animation.",
            )
            .or("none"),
            Setting::new(
                "node",
                "Node",
                "",
                Kind::Text,
                "Joint, bone or node that carries it; capitals do not count. Not used for .csv.",
            ),
            Setting::new(
                "clip",
                "Clip",
                "",
                Kind::Text,
                "Animation of a .glb by name; may stay empty where there is one only.",
            ),
            fine(
                "unit_cm",
                "Unit",
                "cm",
                [1e-6, 1e6],
                0.1,
                "Length of the file's unit. Needed for .bvh, .tof and .abc.",
            )
            .or("what the file says"),
            choice("up", "Up", AXES, "Up axis of the file's world. Needed for .bvh, .amc, .tof and .csv.")
                .or("what the file says"),
            choice(
                "facing",
                "Facing",
                AXES,
                "Axis of the file's world that the character faces while the joint is unturned.",
            )
            .or("what the file says"),
            fine(
                "frames_per_second",
                "Samples",
                "a second",
                [0.01, 10_000.0],
                0.1,
                "Samples a second. Needed for an .amc.",
            )
            .or("what the file says"),
            whole("skip", "Skip", "samples", [0, 10_000_000], "Samples dropped at the start. Not for .glb."),
            choice(
                "positions",
                "Positions",
                &["linear", "cubic"],
                "How a position between two samples is found. Not for .glb.",
            ),
            fine("speed", "Speed", "", [0.01, 100.0], 0.005, "How fast the motion is played: 0.25 takes four times as long."),
            number(
                "smoothing",
                "Smoothing",
                "frames",
                [0.0, 240.0],
                "Deviation of the bell that places and turns are averaged by. Recordings tremble, and hair feels accelerations.",
            ),
            flag(
                "start_at_origin",
                "Start at origin",
                "Whether the first frame is moved to the world's origin and turned to face +x.",
            ),
            flag("bind_at_start", "Bind at start", "Whether the mesh stands in its file as the first frame has it."),
        ]
    };
}

pub(super) const GROUPS: &[Group] = &[
    Group::new(
        "Head",
        "head",
        "Where the head comes from.",
        &[
            file(
                "mesh",
                "Mesh",
                MESH_FILES,
                "builtin:bust, or a .obj, .glb, .ply, .tfxmesh, USD layer or Alembic archive.",
            ),
            Setting::new(
                "ellipsoid",
                "Ellipsoid",
                "cm",
                Kind::Ellipsoid,
                "Fitted to the part of the head where hair grows, or given in head space.",
            ),
            fine(
                "shell",
                "Shell",
                "",
                [1.000_001, 100.0],
                0.005,
                "The ellipsoid in which the pseudo-force may hold, by the head's.",
            ),
        ],
    )
    .open(),
    Group::new(
        "How its file lies",
        "head",
        "What the file does not say itself.",
        &[
            GROUPS_OF_FILE,
            UNIT,
            UP,
            FACING,
            vector(
                "origin",
                "Origin",
                "",
                0.1,
                "Point of the file that becomes the origin of head space, in the file's unit.",
            )
            .or("the ellipsoid's centre"),
        ],
    )
    .open()
    .when(When::ImportedHead),
    Group::new(
        "Motion of the head",
        "head.motion",
        "A file that moves the head; without one it stands still.",
        motion!(),
    )
    .shaped(Shape::Optional("")),
    Group::new(
        "Bodies",
        "body",
        "What else hair does not enter.",
        &[
            file("mesh", "Mesh", MESH_FILES, "A .obj, .glb, .ply, .tfxmesh, USD layer or Alembic archive."),
            GROUPS_OF_FILE,
            UNIT,
            UP,
            FACING,
            vector(
                "origin",
                "Origin",
                "",
                0.1,
                "Point of the file that the body's motion carries, in the file's unit.",
            )
            .or("the file's"),
            flag("with_head", "With the head", "Whether it is worn: it stands in head space and goes with the head."),
            flag("solid", "Solid", "Whether hair keeps out of it; otherwise it is drawn and no more, and may be open."),
            flag("shown", "Shown", "Whether it is drawn. What is not shown hides nothing and throws no shadow."),
            colour("colour", "Colour", false, "Its colour in pictures."),
            fine("margin", "Margin", "cm", [0.0, 5.0], 0.005, "How far from its skin hair is kept."),
            fine(
                "friction",
                "Friction",
                "",
                [0.0, 10.0],
                0.005,
                "The part of a push that sliding hair loses of its speed.",
            ),
            fine(
                "static_friction",
                "Static friction",
                "",
                [0.0, 10.0],
                0.005,
                "The same for hair that lies still; at least the friction.",
            ),
        ],
    )
    .shaped(Shape::List(""))
    .when(When::Free),
    Group::new(
        "Motion of a body",
        "body.motion",
        "A file that moves the body; without one it stands still.",
        motion!(),
    )
    .shaped(Shape::Optional(""))
    .when(When::Free),
];
