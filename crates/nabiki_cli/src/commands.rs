//! One file for each subcommand.

pub mod convert;
pub mod groom;

pub mod preview;
pub mod render;
pub mod run;
pub mod simulate;
