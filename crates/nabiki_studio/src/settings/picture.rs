//! What is drawn.

use super::{Group, Shape};

pub(super) const GROUPS: &[Group] = &[
    Group::new(
        "Hair",
        "picture.hair",
        "Width, colour and shading of the hair.",
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
        "Orbits the hair. View > Use view as camera sets it from the view.",
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
        "The camera moves from the values above to these.",
        &["azimuth", "elevation", "distance", "fov", "target", "focus_distance"],
    )
    .shaped(Shape::Optional("")),
    Group::new(
        "Lights",
        "picture.lights",
        "Distant lights.",
        &["azimuth", "elevation", "strength", "colour", "spread", "space"],
    )
    .shaped(Shape::List("")),
    Group::new(
        "Sky",
        "picture.sky",
        "Light from all directions.",
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
        "A vertical gradient, or transparent.",
        &["top", "bottom", "transparent"],
    ),
    Group::new(
        "Frame",
        "picture",
        "Size, exposure and sampling of the pictures.",
        &["size", "exposure", "tone_mapping", "shutter", "shadows", "antialiasing", "samples"],
    ),
    Group::new("Movie", "picture.video", "Quality and frame rate of the movie.", &["quality", "frame_rate"]),
    Group::new(
        "Output",
        "output",
        "The files that a run writes.",
        &["movie", "png_frames", "png_bits", "exr_frames", "field", "sheet"],
    ),
];
