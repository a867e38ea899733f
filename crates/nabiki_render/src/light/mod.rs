//! Light: lamps as directions, and what hair and skin make of them.

pub mod kajiya;
pub mod lamps;
