//! A finished frame: linear light.

/// The depth of empty pixels.
pub const NO_DEPTH: f32 = f32::INFINITY;

/// One picture in linear light, row after row from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// Width and height (pixels).
    pub size: [u32; 2],
    /// Red, green, blue (linear, Rec. 709 primaries) and alpha, *premultiplied*: colour is already weighted by alpha.
    pub rgba: Vec<[f32; 4]>,
    /// Depth of the nearest visible object in the pixel (cm along the axis of view), or [`NO_DEPTH`].
    pub depth: Vec<f32>,
    /// Layers for compositing; empty unless asked for.
    pub layers: Vec<Layer>,
}

/// The compositing data of one pixel, weighted by the share of the pixel that it applies to (premultiplied).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Layer {
    /// Direction of the hair from root to tip (unit vector in head space), times `hair`.
    pub direction: [f32; 3],
    /// Movement of hair, head and bodies while the shutter is open (pixels, right and down), times `hair + head`.
    pub motion: [f32; 2],
    /// Share of the pixel that shows hair, 0..1.
    pub hair: f32,
    /// Share of the pixel that shows the head or a body, 0..1.
    pub head: f32,
}
