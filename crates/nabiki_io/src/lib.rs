//! What goes in and out of Nabiki: scenes, hair, heads, motion of the head, caches.

#![forbid(unsafe_code)]

pub mod motion;
