//! A hair renderer for the CPU: strands and a head become pictures, movies and contact sheets.
//!
//! ```
//! use nabiki_render::{Bounds, FrameToDraw, Picture, Renderer, ToneMapping, View};
//! # use nabiki::{Mesh, Strands};
//! # let (strands, head) = (Strands::default(), Mesh::default());
//! let picture = Picture { size: [64, 36], ..Picture::default() };
//! let mut bounds = Bounds::default();
//! bounds.include_strands(&strands); // of every frame, so that the movie's camera stands still
//! let view = View::new(&picture.camera.at(0.0), picture.size, &bounds);
//! let mut renderer = Renderer::new(&picture, &head)?;
//! let frame = renderer.draw(&FrameToDraw::at_rest(&strands, view))?;
//! let display = ToneMapping::new(&picture).rgba8(&frame);
//! # assert_eq!(display.len(), 64 * 36 * 4);
//! # Ok::<(), nabiki_render::RenderError>(())
//! ```
//!
//! Spaces and units are those of [`nabiki`]: head space, y up, face toward +x, centimetres. A [`Moment`] has the pose
//! of the head in the world, where the camera is. Angles in settings are in degrees. Light is linear, with Rec. 709
//! primaries.

#![deny(unsafe_code)]

mod backdrop;
pub mod camera;
pub mod colour;
mod curve;
mod draft;
mod error;
mod focus;
pub mod frame;
pub mod lens;
mod light;
pub mod live;
mod moment;
pub mod output;
mod prefetch;
mod raster;
mod renderer;
mod scalp;
pub mod settings;
pub mod shutter;
mod skin;
pub mod timing;
pub mod tone_mapping;

pub use camera::{Bounds, View};
pub use draft::Draft;
pub use error::RenderError;
pub use frame::Frame;
pub use moment::{DrawnBody, FrameToDraw, Moment};
pub use output::canvas::Canvas;
pub use output::sheet::{ContactSheet, ForceArrow};
pub use output::video::Movie;
pub use renderer::Renderer;
pub use settings::Picture;
pub use tone_mapping::ToneMapping;
