//! What is drawn.

use super::{Group, Kind, Setting, Shape, choice, colour, fine, flag, number, vector, whole};

const PART: [f64; 2] = [0.0, 1.0];
const TURN: [f64; 2] = [-3600.0, 3600.0];
const CM: [f64; 2] = [0.1, 1e6];
/// Ways from the eye (cm).
const FROM_EYE: [f64; 2] = [1.0, 1e6];

pub(super) const GROUPS: &[Group] = &[
    Group::new(
        "Hair",
        "picture.hair",
        "Width, colour and shading.",
        &[
            Setting::new(
                "colour",
                "Colour",
                "",
                Kind::HairColour,
                "By name, by amounts of pigment, or the colour that a thick mass shows in even light.",
            ),
            fine(
                "width",
                "Width",
                "cm",
                [1e-5, 5.0],
                0.0002,
                "Thickness at the root. A real hair of 0.007 cm is made thicker where few stand for many.",
            ),
            number("tip", "Tip", "", PART, "Thickness at the tip as a part of that at the root."),
            number("taper", "Taper", "", PART, "Part of the length over which hair thins to its tip."),
            number("variation", "Variation", "", PART, "How much hairs differ in pigment and tilt of their scales."),
            choice(
                "shading",
                "Shading",
                &["fibre", "kajiya-kay"],
                "A fibre with pigment inside, or the model of 1989, as in the paper.",
            ),
            number("roughness", "Roughness", "degrees", [2.0, 40.0], "Width of the highlight's band along the hair."),
            number(
                "azimuthal_roughness",
                "Around",
                "",
                [0.05, 1.0],
                "Roughness around the hair: small sharpens the light through it.",
            ),
            number(
                "scale_tilt",
                "Scales",
                "degrees",
                [-10.0, 10.0],
                "Tilt of the scales: shifts the white highlight toward the root, the coloured one toward the tip.",
            ),
            number("refraction", "Refraction", "", [1.1, 2.5], "Refractive index of the fibre."),
            flag("smooth", "Smooth", "Whether a curve is drawn through the nodes rather than straight segments."),
        ],
    )
    .open(),
    Group::new(
        "Camera",
        "picture.camera",
        "On an orbit about the hair. Take it over from the view with View > Use as camera.",
        &[
            choice(
                "projection",
                "Projection",
                &["perspective", "orthographic"],
                "As an eye sees, or all rays parallel.",
            ),
            fine(
                "azimuth",
                "Azimuth",
                "degrees",
                TURN,
                0.5,
                "0 before the face, 90 at the character's right hand, 180 behind.",
            ),
            fine("elevation", "Elevation", "degrees", [-89.0, 89.0], 0.25, "Above the horizon."),
            fine("fov", "Field of view", "degrees", [1.0, 150.0], 0.1, "Vertical, for perspective."),
            fine("distance", "Distance", "cm", FROM_EYE, 0.5, "From the target to the eye.").or("frames everything"),
            fine("height", "Height", "cm", CM, 0.5, "Height of the picture in space, for orthographic views.")
                .or("frames everything"),
            vector("target", "Target", "cm", 0.1, "The point looked at, from the head's origin.").or("the middle"),
            fine(
                "f_stop",
                "f-stop",
                "",
                [0.1, 128.0],
                0.02,
                "Small numbers blur what is not in focus; for perspective.",
            )
            .or("all sharp"),
            fine("focus_distance", "Focus distance", "cm", FROM_EYE, 0.5, "From the eye to the plane that is sharp.")
                .or("the head"),
            number("margin", "Margin", "", [0.0, 0.45], "Empty border around what is framed."),
        ],
    )
    .open(),
    Group::new(
        "Camera at the last frame",
        "picture.camera.to",
        "It glides there from the values above.",
        &[
            fine("azimuth", "Azimuth", "degrees", TURN, 0.5, "Azimuth at the end.").or("stays"),
            fine("elevation", "Elevation", "degrees", [-89.0, 89.0], 0.25, "Elevation at the end.").or("stays"),
            fine("distance", "Distance", "cm", FROM_EYE, 0.5, "Distance at the end; needs one at the start.")
                .or("stays"),
            fine("fov", "Field of view", "degrees", [1.0, 150.0], 0.1, "Field of view at the end.").or("stays"),
            vector("target", "Target", "cm", 0.1, "Target at the end; needs one at the start.").or("stays"),
            fine("focus_distance", "Focus distance", "cm", FROM_EYE, 0.5, "At the end; needs one at the start.")
                .or("stays"),
        ],
    )
    .shaped(Shape::Optional("")),
    Group::new(
        "Lights",
        "picture.lights",
        "Lamps, far away.",
        &[
            fine("azimuth", "Azimuth", "degrees", TURN, 0.5, "Where the light comes from, about the vertical."),
            number("elevation", "Elevation", "degrees", [-90.0, 90.0], "Where it comes from, above the horizon."),
            fine("strength", "Strength", "", [0.0, 1000.0], 0.01, "A white surface facing it is as bright as this."),
            colour("colour", "Colour", true, "Its colour."),
            number(
                "spread",
                "Spread",
                "degrees",
                [0.0, 45.0],
                "How far the lamp spreads as seen from the hair: wide lamps throw soft shadows.",
            ),
            choice("space", "Goes with", &["camera", "world", "head"], "What its direction is relative to."),
        ],
    )
    .shaped(Shape::List("")),
    Group::new(
        "Sky",
        "picture.sky",
        "The light that comes from all around.",
        &[
            fine("strength", "Strength", "", [0.0, 1000.0], 0.005, "How bright it is."),
            colour("above", "Above", true, "Its colour from above."),
            colour("below", "Below", true, "Its colour from below."),
            flag("occlusion", "Occlusion", "Whether hair and head hide it."),
            choice(
                "space",
                "Goes with",
                &["world", "head"],
                "Whether it stays above when the head turns, or turns with it.",
            ),
        ],
    ),
    Group::new(
        "Head",
        "picture.head",
        "How the head is drawn.",
        &[
            flag("visible", "Visible", "Whether it is drawn; it hides hair behind it and throws shadows all the same."),
            colour("colour", "Colour", false, "Its colour."),
            number("softness", "Softness", "", PART, "How far light creeps past the terminator, as in skin."),
            number("sheen", "Sheen", "", PART, "Strength of its sheen."),
            fine(
                "stubble",
                "Stubble",
                "cm",
                [0.0, 100.0],
                0.05,
                "Hair too short to be drawn, by its length: it tints the scalp. 0 shows bare skin.",
            ),
            flag("face", "Face", "Whether the built-in head has brows, lashes and lips of their colours."),
        ],
    ),
    Group::new(
        "Background",
        "picture.background",
        "A vertical gradient, or nothing.",
        &[
            colour("top", "Top", false, "Colour at the top edge."),
            colour("bottom", "Bottom", false, "Colour at the bottom edge."),
            flag("transparent", "Transparent", "Alpha 0 where there is neither hair nor head."),
        ],
    ),
    Group::new(
        "Frame",
        "picture",
        "Size and light of the pictures.",
        &[
            Setting::new(
                "size",
                "Size",
                "pixels",
                Kind::Wholes { names: &["w", "h"], least: 1, most: 16_384 },
                "Width and height.",
            ),
            fine("exposure", "Exposure", "stops", [-20.0, 20.0], 0.02, "Each stop is a factor of 2."),
            choice("tone_mapping", "Tone mapping", &["linear", "filmic"], "How scene light becomes display light."),
            number(
                "shutter",
                "Shutter",
                "",
                PART,
                "Part of the frame during which the shutter is open: 0 is sharp, 0.5 a film camera's.",
            ),
            flag("shadows", "Shadows", "Whether hair and head cast shadows."),
            choice(
                "antialiasing",
                "Antialiasing",
                &["coverage", "oversample"],
                "Exact shares of a pixel, or points of it, the paper's way.",
            ),
            whole("samples", "Samples", "", [1, 32], "Points along each side of a pixel when oversampling."),
        ],
    ),
    Group::new(
        "Movie",
        "picture.video",
        "The movie's file.",
        &[
            number("quality", "Quality", "", PART, "0 is a small file, 1 near lossless."),
            fine(
                "frame_rate",
                "Frame rate",
                "a second",
                [1.0, 240.0],
                0.1,
                "Frames a second that the movie is played with: fewer than the motion's is slow motion.",
            )
            .or("the motion's"),
        ],
    ),
    Group::new(
        "What a run writes",
        "output",
        "Beside the movie.",
        &[
            flag("movie", "Movie", "Whether a movie is written."),
            flag("png_frames", "PNG frames", "Whether every frame is written as a PNG."),
            whole("png_bits", "PNG bits", "", [8, 16], "Bits of each channel: 8 or 16."),
            flag(
                "exr_frames",
                "OpenEXR frames",
                "Whether every frame is written as OpenEXR with depth, hair direction and motion.",
            ),
            flag(
                "field",
                "Drawn field",
                "Whether the force's projections are drawn, as SVG and PNG (the paper's Figure 10).",
            ),
            Setting::new("sheet", "Sheet", "frames", Kind::List { whole: true }, "Frames of the contact sheet.")
                .or("four, evenly"),
        ],
    ),
];
