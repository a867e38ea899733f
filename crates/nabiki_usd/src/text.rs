//! Layers as text (.usda).

pub mod numbers;
pub mod read;
pub mod scan;
pub mod write;
