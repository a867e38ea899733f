//! The document of Nabiki and all that a shell does with it: scenes, what they name, loaded and ready to move, films,
//! exports, reports.

#![forbid(unsafe_code)]

pub mod advice;
pub mod info;
pub mod scene;
pub mod stage;
pub mod take;
pub mod template;

pub use scene::Scene;
pub use stage::Stage;
pub use take::Take;
