//! One file for each subcommand.

pub mod convert;
pub mod groom;
pub mod info;
pub mod new;
pub mod preview;
pub mod render;
pub mod run;
pub mod simulate;
