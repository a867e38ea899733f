//! How hair lies at rest.

use super::{AXES, Group, HAIR_FILES, Kind, Setting, Shape, When, choice, file, fine, flag, number, vector, whole};

const PART: [f64; 2] = [0.0, 1.0];
const LOAD: [f64; 2] = [0.0, 1000.0];
const ROOT_ENDS: &[&str] = &["skin", "first", "last"];

pub(super) const GROUPS: &[Group] = &[
    Group::new(
        "Strands",
        "hair",
        "How many, and how finely cut.",
        &[
            whole("strands", "Strands", "", [1, 5_000_000], "Number of strands of the whole scene; the view shows the first few."),
            whole("segments", "Segments", "", [1, 65_535], "Most segments of a strand."),
            fine("segment_length", "Segment length", "cm", [0.01, 100.0], 0.01, "Length of the segments that are grown; stiffness and the paper's k are counted in it."),
            whole("seed", "Seed", "", [0, i64::MAX], "Another number, other roots and other differences between strands."),
        ],
    )
    .open()
    .when(When::Grown),
    Group::new(
        "Hair file",
        "hair",
        "Where the strands are read from.",
        &[
            file("file", "File", HAIR_FILES, "A .hair, .tfx, .obj with polylines, USD layer or Alembic archive."),
            Setting::new("groups", "Groups", "", Kind::Texts, "Curves of a USD layer or Alembic archive to keep, by name or path, separated by commas; all if empty."),
            whole("strands", "Strands", "", [1, 5_000_000], "An even choice of so many strands.").or("all"),
            whole("segments", "Segments", "", [1, 65_535], "Cuts every strand anew into so many equally long segments.").or("as in the file"),
            fine("segment_length", "Segment length", "cm", [0.01, 100.0], 0.01, "The unit of length in which stiffness and the paper's k are counted."),
            Setting::new("unit", "Unit", "", Kind::Unit, "Unit of the file.").or("what files say"),
            choice("up", "Up", AXES, "Axis of the file that points up.").or("what files say"),
            choice("facing", "Facing", AXES, "Axis of the file along which the face looks.").or("the head's"),
            vector("origin", "Origin", "", 0.1, "Point of the file that becomes the origin of head space, in the file's unit.").or("the head's"),
            choice("root", "Root", ROOT_ENDS, "Which end of a strand is its root: the one on the skin where the other is not, the first, or the last."),
            fine("join_within", "Join within", "cm", [0.0, 1.0], 0.0005, "Neighbouring points of a strand this close are joined."),
            fine("drop_shorter_than", "Drop shorter", "cm", [0.0, 1000.0], 0.02, "Strands shorter than this are dropped."),
        ],
    )
    .open()
    .when(When::Imported),
    Group::new(
        "Length",
        "hair.style",
        "Length before any cut.",
        &[
            fine("length.top", "Top", "cm", [0.1, 1000.0], 0.1, "On the upper third of the head. At most segments x segment length."),
            fine("length.sides", "Sides", "cm", [0.1, 1000.0], 0.1, "Below, in front of the middle of the ears."),
            fine("length.back", "Back", "cm", [0.1, 1000.0], 0.1, "Below, behind."),
            fine("length.fringe", "Fringe", "cm", [0.1, 1000.0], 0.1, "Of the fringe, if there is one."),
        ],
    )
    .open()
    .when(When::Grown),
    Group::new(
        "Cuts",
        "hair.style.cuts",
        "Planes beyond which hair is cut off.",
        &[
            vector("point", "Point", "cm", 0.1, "A point of the plane, in head space."),
            vector("normal", "Normal", "", 0.01, "Toward the hair taken off: (0, -1, 0) cuts level."),
            choice("region", "Region", &["top", "sides", "back", "fringe"], "Whose hair it cuts.").or("all"),
            fine("shortest", "Shortest", "cm", [0.1, 100.0], 0.02, "No strand is made shorter than this."),
        ],
    )
    .shaped(Shape::List("point = [0.0, -18.0, 0.0]\nnormal = [0.0, -1.0, 0.0]"))
    .when(When::Grown),
    Group::new(
        "Curl",
        "hair.style.curl",
        "Every strand winds about the line in which it would hang.",
        &[
            fine("radius", "Radius", "cm", [0.0, 10.0], 0.01, "Distance between a strand and its line; 0: no curls. At most the pitch."),
            fine("pitch", "Pitch", "cm", [0.1, 50.0], 0.02, "Length of the line in one turn."),
            number("from", "From", "", [0.01, 1.0], "Part of the length from which on curls are whole."),
            number("flatness", "Flatness", "", PART, "0 winds to a helix, 1 waves in a plane."),
            number("gather", "Gather", "", PART, "How far the hair of a clump closes to one lock."),
            number("variation", "Variation", "", [0.0, 0.6], "How much radius and pitch differ from clump to clump."),
            number("frizz", "Frizz", "", [0.0, 0.6], "How much strands of a clump differ."),
        ],
    )
    .when(When::Grown),
    Group::new(
        "Parting",
        "hair.style.parting",
        "The line that hair is combed away from, as seen from above.",
        &[
            Setting::new("front", "Front", "cm", Kind::Numbers { names: &["x", "z"], step: 0.05 }, "Its front end; it may stop short of the hairline."),
            Setting::new("crown", "Crown", "cm", Kind::Numbers { names: &["x", "z"], step: 0.05 }, "Its end at the crown."),
            fine("wobble", "Wobble", "cm", [0.0, 5.0], 0.01, "How far it strays from the straight line, which keeps it from being bare."),
        ],
    )
    .when(When::Grown),
    Group::new(
        "Comb",
        "hair.style.comb",
        "The styling force near the root.",
        &[
            fine("away", "Away", "weights", LOAD, 0.02, "Away from the parting, level."),
            vector("sweep", "Sweep", "weights", 0.02, "In one direction for all hair but the fringe: (-1, 0, 0) is backward."),
            fine("off_face", "Off the face", "weights", LOAD, 0.02, "Backward for hair rooted in front, which keeps the face free."),
            fine("decay", "Decay", "cm", [0.01, 1000.0], 0.02, "Length over which they fall to 1/e."),
        ],
    )
    .when(When::Grown),
    Group::new(
        "Fringe",
        "hair.style.fringe",
        "Hair combed over the forehead.",
        &[
            fine("half_width", "Half width", "cm", [0.0, 100.0], 0.02, "Half the width of the strip; 0: no fringe."),
            fine("from", "From", "cm", [-100.0, 100.0], 0.02, "Where it ends behind, along x."),
            fine("forward", "Forward", "weights", LOAD, 0.02, "Load forward near the root."),
            fine("aside", "Aside", "weights", [-1000.0, 1000.0], 0.02, "Load along z, for a fringe swept to one side."),
        ],
    )
    .when(When::Grown),
    Group::new(
        "Stiffness at rest",
        "hair.style",
        "Over about this length hair bends under its own weight.",
        &[
            fine("stiffness.top", "Top", "cm", [0.1, 100.0], 0.02, "On the upper third of the head. Real hair: about 4.5; combed and lying on other hair, less."),
            fine("stiffness.sides", "Sides", "cm", [0.1, 100.0], 0.02, "Below, in front of the middle of the ears."),
            fine("stiffness.back", "Back", "cm", [0.1, 100.0], 0.02, "Below, behind."),
            fine("stiffness.fringe", "Fringe", "cm", [0.1, 100.0], 0.02, "Of the fringe, if there is one."),
            choice("lever_arms", "Lever arms", &["straight", "deformed"], "Those of the straight strand, for short or stiff hair, or of the bent one."),
        ],
    )
    .when(When::Grown),
    Group::new(
        "Lift",
        "hair.style",
        "Angle between a root and the scalp.",
        &[
            number("lift_degrees.top", "Top", "degrees", [0.0, 90.0], "On the upper third of the head; 90 is along the normal."),
            number("lift_degrees.sides", "Sides", "degrees", [0.0, 90.0], "Below, in front of the middle of the ears."),
            number("lift_degrees.back", "Back", "degrees", [0.0, 90.0], "Below, behind."),
            number("lift_degrees.fringe", "Fringe", "degrees", [0.0, 90.0], "Of the fringe, if there is one."),
        ],
    )
    .when(When::Grown),
    Group::new(
        "Volume",
        "hair.style.volume",
        "How hair lies over hair.",
        &[
            fine("thickness", "Thickness", "cm", [0.0, 20.0], 0.01, "Distance to the skin that hair from far above keeps."),
            fine("reach", "Reach", "cm", [0.01, 1000.0], 0.05, "Length of hair on the head over which most of it is reached."),
            fine("gap", "Gap", "cm", [0.0, 5.0], 0.005, "Distance that any hair keeps."),
            flag("over_ears", "Over the ears", "Whether hair from above passes over the ears or parts about them."),
        ],
    )
    .when(When::Grown),
    Group::new(
        "Clumps",
        "hair.style.clumps",
        "Neighbours that fall together.",
        &[
            fine("size", "Size", "cm", [0.05, 100.0], 0.01, "Width of a clump at the scalp."),
            number("gather", "Gather", "", PART, "How far its tips draw together: 1 to a point."),
            number("direction_degrees", "Direction", "degrees", [0.0, 45.0], "Deviation of a clump's direction as a whole."),
            fine("wave", "Wave", "cm", [0.0, 10.0], 0.005, "Height of its waves, at most 0.16 of their length."),
            fine("wave_length", "Wave length", "cm", [0.1, 1000.0], 0.05, "Length of its waves."),
        ],
    )
    .when(When::Grown),
    Group::new(
        "Variation",
        "hair.style.variation",
        "How much strands differ.",
        &[
            number("length", "Length", "", [0.0, 0.9], "Largest share by which a strand falls short of its length."),
            number("stiffness", "Stiffness", "", [0.0, 0.3], "Relative deviation of the stiffness."),
            number("direction_degrees", "Direction", "degrees", [0.0, 45.0], "Deviation of the direction at the root and of the load."),
            number("strays", "Strays", "", PART, "Share of stray hairs, whose direction deviates four times as much."),
            fine("cut", "Cut", "cm", [0.0, 10.0], 0.005, "Deviation of the cut from its plane."),
            number("baby_hair", "Baby hair", "", [0.0, 0.95], "Largest share by which a strand on the hairline falls short; it strays the more."),
        ],
    )
    .when(When::Grown),
    Group::new(
        "Ponytail",
        "hair.style.ponytail",
        "Hair goes along the head to a band, and falls from it.",
        &[
            vector("at", "At", "cm", 0.05, "The middle of the band, in head space, outside of the skin."),
            fine("radius", "Radius", "cm", [0.01, 5.0], 0.01, "Radius of the hair within the band."),
            vector("direction", "Direction", "", 0.01, "The way that hair takes through the band."),
        ],
    )
    .shaped(Shape::Optional("at = [-11.0, 2.0, 0.0]"))
    .when(When::Grown),
    Group::new(
        "Hairline",
        "hair.hairline",
        "Where hair grows: depths below the top of the head, in units of its mean horizontal half axis, 8.65 cm on the bust.",
        &[
            number("forehead", "Forehead", "", [0.0, 2.0], "Depth over the middle of the forehead."),
            number("temple_recession", "Temples", "", [-0.5, 0.5], "How much higher the line stands over the temples."),
            number("sideburns", "Sideburns", "", [0.0, 2.5], "Depth of their lower end, in front of the ears."),
            number("above_ears", "Above the ears", "", [0.0, 2.5], "Depth above the ears."),
            number("behind_ears", "Behind the ears", "", [0.0, 0.25], "How much farther forward it comes down there."),
            number("nape", "Nape", "", [0.0, 2.8], "Depth on the nape."),
            number("fade", "Fade", "", PART, "Height over which hair thins out at the line."),
            number("wander", "Wander", "", [0.0, 0.3], "How far the line wanders up and down."),
        ],
    )
    .when(When::Grown),
];
