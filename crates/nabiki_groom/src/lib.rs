//! Grows hair: roots within a hairline, a style from the angle at the root to the cut, and a bust to grow it on.
//!
//! The result is a [`Hair`](nabiki::Hair) at rest, which [`nabiki`] moves. An engine with its own hair does not need
//! this crate.
//!
//! # A program
//!
//! ```
//! use std::sync::Arc;
//!
//! use nabiki::SettingError;
//! use nabiki::dynamics::{Dynamics, Timeline};
//! use nabiki::field::{Keyframe, KeyframedField};
//! use nabiki::glam::Vec3;
//! use nabiki_groom::{Growth, Hairline, Style, bust, grow};
//!
//! fn main() -> Result<(), SettingError> {
//!     let head = bust();
//!     let (hairline, style) = (Hairline::default(), Style::default());
//!     let growth =
//!         Growth { hairline: &hairline, style: &style, strands: 2_000, segments: 18, segment_length: 1.0, seed: 1 };
//!     // The first 20 of the 2,000, which move as they do among all.
//!     let hair = grow(&head, &growth, 20)?;
//!     let mut dynamics = Dynamics::new(head.ellipsoid);
//!     dynamics.motion.inertia_length_floor = 18.0;
//!     let gust = KeyframedField::new(&[Keyframe { through: 50, vector: Vec3::new(-100.0, 0.0, 0.0) }])?;
//!     let mut timeline = Timeline::new(&hair.strands, &dynamics, Arc::new(gust), Vec::new(), 50)?;
//!     let film = timeline.play();
//!     let tip = |frame: u32| film.strand(frame, 0)[film.strand(frame, 0).len() - 1];
//!     assert!(tip(50).x < tip(0).x, "hair goes where the wind blows");
//!     Ok(())
//! }
//! ```

#![forbid(unsafe_code)]

mod bust;
pub mod cantilever;
mod chance;
mod curl;
mod cut;
mod drape;
mod ears;
pub mod face;
mod grow;
pub mod roots;
mod strand_style;
pub mod style;

pub use bust::bust;
pub use grow::{GUIDES, Growth, groom, grow, grow_run, grow_run_while};
pub use roots::Hairline;
pub use style::Style;
