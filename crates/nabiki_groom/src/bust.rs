//! The built-in bust, read from `bust.bin`: its mesh and its sampled distance.
//!
//! `nabiki_bust` (in the same repository) models the bust and writes that file. Numbers are rounded to multiples of a
//! power of two, so the bust is the same on every machine and its halves are exact mirror images.

mod head;
mod layout;
mod numbers;
mod read;

pub use head::bust;

#[cfg(test)]
mod tests;
