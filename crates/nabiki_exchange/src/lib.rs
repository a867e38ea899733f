//! The parts shared by all formats that exchange grooms between programs.
//!
//! - [`curves`] turns curves into strands, using their [`Knots`] if they have any.
//! - [`attributes`] knows the names that programs use for the data of curves.
//! - [`Gathered`] joins the curves of several objects.
//! - [`Budget`] limits the memory for reading a file.
//! - [`Frames`] finds frames in samples at any times.
//! - [`export`] has the settings of a writer of moving hair.
//! - [`GroomReader`] is the interface of a reader.
//!
//! ```
//! use glam::Vec3;
//! use nabiki_exchange::Problem;
//! use nabiki_exchange::curves::{Basis, Shape};
//!
//! fn main() -> Result<(), Problem> {
//!     let curve = Shape { counts: vec![4], basis: Basis::Bezier, pinned: false };
//!     let points = vec![Vec3::ZERO, Vec3::Y, Vec3::new(1.0, 2.0, 0.0), Vec3::new(2.0, 2.0, 0.0)];
//!     let walked = curve.walk(points, Some(8))?;
//!     assert_eq!((walked.strands.len(), walked.strands.points().len()), (1, 9));
//!     assert_eq!(walked.strands.strand(0)[8], Vec3::new(2.0, 2.0, 0.0));
//!     Ok(())
//! }
//! ```

#![forbid(unsafe_code)]

pub mod attributes;
mod budget;
mod control;
pub mod curves;
pub mod export;
mod frames;
mod gather;
mod in_place;
mod knots;
mod left_out;
mod painted;
mod polygons;
mod problem;
mod reader;
mod shown;
mod window;

pub use budget::Budget;
pub use control::Course;
pub use export::{Export, FrameSink, Velocities};
pub use frames::{Frames, MOST_FRAMES};
pub use gather::{Closed, Gathered};
pub use in_place::InPlace;
pub use knots::Knots;
pub use left_out::LeftOut;
pub use painted::{Canvas, Painted, PaintedOn};
pub use polygons::{Polygons, Uvs, add_polygons};
pub use problem::Problem;
pub use reader::{BOUND_SHAPE, Contents, FIRST_SHAPE, GroomReader, Kept, Placed, Prim, PrimKind};
pub use shown::{Candidate, Hidden, kept_holes, those_that_show};
pub use window::Window;
