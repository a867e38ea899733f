//! Hair on a graphics card, as it moves: strands, head and bodies in the look of a [`Picture`](nabiki_render::Picture), many
//! pictures a second. The renderer's own tables and lamps light it, so its pictures resemble the finished ones.
//!
//! A [`Gpu`] belongs to a [`wgpu::Device`], which may be a window's, an engine's or [one of its own](Gpu::headless). A [`Drawing`] is
//! plain values: nothing here knows of scenes or windows.

mod globals;
mod gpu;
mod hair;
mod mesh;
mod volume;

pub use globals::widened;
pub use gpu::{Body, Drawing, Gpu, Line, MOST_HAIRS};
pub use wgpu;
