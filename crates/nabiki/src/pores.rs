//! Pores: where hair grows out of the scalp (the paper, section 3.1).
//!
//! The paper sets the pores on the head ellipsoid E. A real scalp differs from E by some millimetres, so here each
//! place chosen on E is carried along the normal of E onto the skin: outward where the skin stands outside E, inward
//! where it lies inside. The pores are blue noise, and in an order whose every beginning is blue noise too: the first
//! 300 of 20,000 are a preview of them.

mod hairline;

use glam::Vec3;
use rayon::prelude::*;

use crate::subset::farthest_first;
use crate::{Head, SettingError};

pub use hairline::Hairline;

/// One pore: the root of a strand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pore {
    /// On the skin (head space, cm).
    pub position: Vec3,
    /// Outward normal of the skin there, of unit length.
    pub normal: Vec3,
}

/// Candidates for each pore asked for: with more the spacing gains little, with fewer it shows.
const CANDIDATES: usize = 5;
/// Directions drawn at most for each candidate kept; a hairline that keeps less leaves no scalp to speak of.
const TRIES: usize = 64;

/// Spreads `count` pores evenly within `hairline`; the same `seed` gives the same pores to the bit.
///
/// # Errors
/// If the hairline is out of range or leaves nothing of the scalp.
pub fn spread(head: &Head, hairline: &Hairline, count: usize, seed: u64) -> Result<Vec<Pore>, SettingError> {
    hairline.check()?;
    let wanted = count.saturating_mul(CANDIDATES);
    let mut candidates: Vec<Pore> = Vec::with_capacity(wanted);
    let mut drawn = 0_u64;
    while candidates.len() < wanted {
        if drawn > (wanted.saturating_mul(TRIES) as u64).max(100_000) {
            return Err(SettingError::new("hair.hairline", "no scalp", "leaves hardly a place for hair: widen it"));
        }
        let batch = (2 * (wanted - candidates.len())).max(1024) as u64;
        let found: Vec<Pore> =
            (drawn..drawn + batch).into_par_iter().filter_map(|i| candidate(head, hairline, seed, i)).collect();
        candidates.extend(found.into_iter().take(wanted - candidates.len()));
        drawn += batch;
    }
    let places: Vec<Vec3> = candidates.iter().map(|pore| pore.position).collect();
    Ok(farthest_first(&places, count).into_iter().map(|i| candidates[i]).collect())
}

/// The `i`-th draw of the seed: a place uniform over the area of E, kept if hair grows there.
fn candidate(head: &Head, hairline: &Hairline, seed: u64, i: u64) -> Option<Pore> {
    let mut state = seed.wrapping_mul(0xD134_2543_DE82_EF95) ^ i.wrapping_mul(0x9E37_79B9_7F4A_7C15);
    let mut uniform = || {
        // SplitMix64 (Steele, Lea and Flood, 2014), its upper 24 bits as a number in [0, 1).
        state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (state ^ (state >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 40) as f32 / (1_u32 << 24) as f32
    };
    let y = 2.0 * uniform() - 1.0;
    let (sin, cos) = (std::f32::consts::TAU * uniform()).sin_cos();
    let around = (1.0 - y * y).sqrt();
    let u = Vec3::new(around * cos, y, around * sin);
    // The sphere's area is stretched by |u / h| times the product of the half axes h: keep in proportion to it.
    let h = head.ellipsoid.half_axes;
    if uniform() > (u / h).length() * h.min_element() || !hairline.grows(u, uniform()) {
        return None;
    }
    let on_ellipsoid = head.ellipsoid.center + u * h;
    let along = (u / h).normalize();
    let mut position = on_ellipsoid;
    for _ in 0..8 {
        position -= head.distance(position) * along;
    }
    let normal = head.outward(position);
    let off = (position - on_ellipsoid).dot(along) / h.min_element();
    let is_scalp = normal.dot(along) > 0.6 && off.abs() < 0.2 && head.distance(position).abs() < 0.01 * h.min_element();
    is_scalp.then_some(Pore { position, normal })
}

#[cfg(test)]
mod tests;
