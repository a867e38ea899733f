//! Light: lamps and sky, what gets in their way, and what hair makes of them.

pub mod approx;
pub mod fibre;
pub mod headlight;
pub mod kajiya;
pub mod lamps;
pub mod shade;
pub mod shadow;
pub mod sky;
pub mod streams;
