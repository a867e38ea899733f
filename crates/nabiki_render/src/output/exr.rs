//! OpenEXR files: linear light, alpha, depth, and hair layers for compositing.

use std::io::{Cursor, Seek, Write};
use std::path::Path;

use exr::meta::MetaData;
use exr::meta::header::Header;
use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, ImageAttributes, IntegerBounds, Layer, LayerAttributes,
    Vec2, WritableImage,
};

use super::write_whole;
use crate::RenderError;
use crate::frame::{Frame, Layer as PixelLayer};

/// Writes a frame as an OpenEXR file of 32-bit floats with lossless compression.
///
/// Channels: `R`, `G`, `B` (linear, Rec. 709 primaries), *premultiplied* by `A` as usual in OpenEXR; `Z`, the depth
/// along the axis of view (cm), infinite for empty pixels. With the frame's layers also `hair.A` and `head.A`, the
/// shares of the pixel that show hair and head; `direction.X`, `.Y`, `.Z`, the direction of the hair from root to tip
/// in head space, premultiplied by `hair.A`; and `motion.X`, `.Y`, the movement of both while the shutter is open
/// (pixels, right and down), premultiplied by `hair.A + head.A`.
pub fn write(path: &Path, frame: &Frame) -> Result<(), RenderError> {
    write_whole(path, |file| into(file, frame).map_err(Into::into))
}

/// Whether a file is an OpenEXR file that this crate has written, by the mark in it.
pub fn is_ours(path: &Path) -> bool {
    // Opening a pipe waits for someone to write into it.
    let is_file = std::fs::metadata(path).is_ok_and(|about| about.is_file());
    let Some(meta) = is_file.then(|| MetaData::read_from_file(path, false)) else { return false };
    let of = |header: &Header| header.own_attributes.software_name.as_ref().is_some_and(|name| name.eq(MARK));
    meta.is_ok_and(|meta| meta.headers.iter().any(of))
}

/// What says who has made the file, by which a later run knows which frames it may remove.
const MARK: &str = "Nabiki";

/// A frame as the bytes of an OpenEXR file, as [`write()`] writes them.
pub fn bytes(frame: &Frame) -> Result<Vec<u8>, RenderError> {
    let mut file = Cursor::new(Vec::new());
    into(&mut file, frame).map_err(|e| RenderError::Geometry(e.to_string()))?;
    Ok(file.into_inner())
}

fn into(file: &mut (impl Write + Seek), frame: &Frame) -> exr::error::UnitResult {
    let channel = |name: &str, values: Vec<f32>| AnyChannel::new(name, FlatSamples::F32(values));
    let of = |i: usize| frame.rgba.iter().map(|p| p[i]).collect::<Vec<f32>>();
    let mut channels = vec![
        channel("R", of(0)),
        channel("G", of(1)),
        channel("B", of(2)),
        channel("A", of(3)),
        channel("Z", frame.depth.clone()),
    ];
    if !frame.layers.is_empty() {
        let of = |value: fn(&PixelLayer) -> f32| frame.layers.iter().map(value).collect::<Vec<f32>>();
        channels.extend([
            channel("hair.A", of(|l| l.hair)),
            channel("head.A", of(|l| l.head)),
            channel("direction.X", of(|l| l.direction[0])),
            channel("direction.Y", of(|l| l.direction[1])),
            channel("direction.Z", of(|l| l.direction[2])),
            channel("motion.X", of(|l| l.motion[0])),
            channel("motion.Y", of(|l| l.motion[1])),
        ]);
    }
    let size = Vec2(frame.size[0] as usize, frame.size[1] as usize);
    let layer = Layer::new(
        size,
        LayerAttributes { software_name: Some(MARK.into()), ..LayerAttributes::default() },
        Encoding::SMALL_LOSSLESS,
        AnyChannels::sort(channels.into_iter().collect()),
    );
    let image = Image::empty(ImageAttributes::new(IntegerBounds::from_dimensions(size))).with_layer(layer);
    image.write().to_buffered(file)
}
