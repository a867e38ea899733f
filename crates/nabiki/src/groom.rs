//! The hairstyle: how a strand leaves its pore, bends, lies on the head, hangs and is cut (method section 4).
//!
//! Every strand is styled alone, from its pore, the style and the seed: any subset of pores, in any order, gives the
//! same strands to the bit, as does any number of threads.

mod chance;
mod course;
mod cut;
mod drape;
mod ears;

pub mod cantilever;
pub mod style;

use rayon::prelude::*;

pub use style::Style;

use crate::error::check_positive;
use crate::pores::Pore;
use crate::{Head, SettingError, Strands};
use drape::{Draping, Ground};
use ears::EarHills;

/// Strands styled by one task.
const STRANDS_A_TASK: usize = 64;

/// Styles one strand a pore, in the order of the pores: nodes from root to tip (head space, cm).
///
/// A strand of length L is made of the fewest equal segments that are not longer than `segment_length` (cm), so at
/// most `segments` of them: the style may ask for no length beyond `segments` x `segment_length`.
///
/// # Errors
/// If a setting is out of its range, or a length is greater than that.
pub fn groom(
    head: &Head,
    pores: &[Pore],
    style: &Style,
    segments: usize,
    segment_length: f32,
    seed: u64,
) -> Result<Strands, SettingError> {
    style.check()?;
    check_positive("hair.segment_length", segment_length)?;
    if segments == 0 {
        return Err(SettingError::new("hair.segments", segments, "must be at least 1"));
    }
    let longest = segments as f32 * segment_length;
    for (region, length) in style.length.each() {
        let grows = region != "fringe" || style.fringe.half_width > 0.0;
        if grows && length > longest * (1.0 + 1e-5) {
            let remedy =
                format!("must be at most hair.segments x hair.segment_length = {longest} cm: raise one of them");
            return Err(SettingError::new(format!("hair.style.length.{region}"), length, remedy));
        }
    }
    let ears = style.volume.over_ears.then(|| EarHills::new(head));
    let ground = Ground {
        head,
        ears: ears.as_ref(),
        volume: style.volume,
        lever_arms: style.lever_arms,
        wave_length: f64::from(style.locks.wave_length),
        segment: f64::from(segment_length),
    };
    let parts: Vec<Strands> = pores
        .par_chunks(STRANDS_A_TASK)
        .map_init(Draping::default, |draping, pores| {
            let mut strands = Strands::with_capacity(pores.len(), pores.len() * (segments + 1));
            for pore in pores {
                let course = course::course(head, style, pore, seed);
                cut::drape_and_cut(&ground, &style.cuts, &course, draping);
                strands.push(draping.nodes.iter().map(|p| p.as_vec3()));
            }
            strands
        })
        .collect();
    let points = parts.iter().map(|part| part.points().len()).sum();
    let mut strands = Strands::with_capacity(pores.len(), points);
    for strand in parts.iter().flat_map(Strands::iter) {
        strands.push(strand.iter().copied());
    }
    Ok(strands)
}
