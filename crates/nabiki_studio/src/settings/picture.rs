//! What is drawn.

use super::{Group, Shape};

pub(super) const GROUPS: &[Group] = &[
    Group::new(
        "Hair",
        "picture.hair",
        "Width, colour and shading.",
        &[
            "colour",
            "width",
            "tip",
            "taper",
            "variation",
            "shading",
            "roughness",
            "azimuthal_roughness",
            "scale_tilt",
            "refraction",
            "smooth",
        ],
    )
    .open(),
    Group::new(
        "Camera",
        "picture.camera",
        "On an orbit about the hair. Take it over from the view with View > Use as camera.",
        &[
            "projection",
            "azimuth",
            "elevation",
            "fov",
            "distance",
            "height",
            "target",
            "f_stop",
            "focus_distance",
            "margin",
        ],
    )
    .open(),
    Group::new(
        "Camera at the last frame",
        "picture.camera.to",
        "It glides there from the values above.",
        &["azimuth", "elevation", "distance", "fov", "target", "focus_distance"],
    )
    .shaped(Shape::Optional("")),
    Group::new(
        "Lights",
        "picture.lights",
        "Lamps, far away.",
        &["azimuth", "elevation", "strength", "colour", "spread", "space"],
    )
    .shaped(Shape::List("")),
    Group::new(
        "Sky",
        "picture.sky",
        "The light that comes from all around.",
        &["strength", "above", "below", "occlusion", "space"],
    ),
    Group::new(
        "Head",
        "picture.head",
        "How the head is drawn.",
        &["visible", "colour", "softness", "sheen", "stubble", "face"],
    ),
    Group::new(
        "Background",
        "picture.background",
        "A vertical gradient, or nothing.",
        &["top", "bottom", "transparent"],
    ),
    Group::new(
        "Frame",
        "picture",
        "Size and light of the pictures.",
        &["size", "exposure", "tone_mapping", "shutter", "shadows", "antialiasing", "samples"],
    ),
    Group::new("Movie", "picture.video", "The movie's file.", &["quality", "frame_rate"]),
    Group::new(
        "What a run writes",
        "output",
        "Beside the movie.",
        &["movie", "png_frames", "png_bits", "exr_frames", "field", "sheet"],
    ),
];
