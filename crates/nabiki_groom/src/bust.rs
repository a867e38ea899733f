//! The built-in bust, read from `bust.bin`: its mesh and its sampled distance.
//!
//! `nabiki_bust` (in the same repository) sculpts it and writes that file. Rounded to multiples of a power of two, it
//! is the same on every machine, and its halves are mirror images to the bit.

mod head;
mod layout;
mod numbers;
mod read;

pub use head::bust;

#[cfg(test)]
mod tests;
