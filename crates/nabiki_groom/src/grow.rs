//! The hairstyle: how a strand leaves its root, bends, lies on the head, hangs and is cut (method section 4).
//!
//! Each strand depends only on its root, the style and the seed. Any subset of roots, in any order and on any number of
//! threads, therefore gives the same strands, bit by bit.

use std::sync::atomic::{AtomicUsize, Ordering};

use nabiki::error::check_positive;
use nabiki::hair::Attributes;
use nabiki::{Hair, Head, SettingError, Strands};
use rayon::prelude::*;

use crate::drape::{Draping, Ground};
use crate::ears::EarHills;
use crate::roots::{self, Hairline, Root};
use crate::style::{Region, Style};
use crate::{cut, strand_style};

/// Strands styled by one task.
const STRANDS_A_TASK: usize = 64;

/// Number of guides: the first strands in the farthest-first order of the roots, however many strands are grown.
pub const GUIDES: usize = 256;

/// The settings that determine the hair on a head.
#[derive(Clone, Copy, Debug)]
pub struct Growth<'a> {
    /// Where hair grows.
    pub hairline: &'a Hairline,
    /// The hairstyle.
    pub style: &'a Style,
    /// Total number of strands.
    pub strands: usize,
    /// Largest number of segments of a strand.
    pub segments: usize,
    /// Longest segment (cm).
    pub segment_length: f32,
    /// Seed of all random numbers.
    pub seed: u64,
}

/// Grows the first `shown` strands (all, if there are no more) in the farthest-first order of their roots. They are the
/// same, bit by bit, as among all strands, and only they take time.
///
/// They have the usual attributes of a groom: `id`, the index in that order, which does not depend on `shown`;
/// `root_uv`; `group`, the region of the style ([`Region::ALL`]) with its name; and `guide` for the first [`GUIDES`].
///
/// # Errors
/// If a setting is out of range, or the hairline leaves none of the scalp.
pub fn grow(head: &Head, growth: &Growth<'_>, shown: usize) -> Result<Hair, SettingError> {
    let roots = roots::spread_first(head, growth.hairline, growth.strands, shown, growth.seed)?;
    grow_run(head, growth, &roots, 0)
}

/// Like [`grow`], from existing roots: a run of those that [`roots::spread_first`] returns for this hairline, number
/// and seed, starting with index `first` of the order. A change of style does not move roots.
///
/// # Errors
/// As for [`groom()`].
pub fn grow_run(head: &Head, growth: &Growth<'_>, roots: &[Root], first: usize) -> Result<Hair, SettingError> {
    grow_run_while(head, growth, roots, first, &|_| true).map(Option::unwrap_or_default)
}

/// Like [`grow_run`], but any thread calls `goes_on` regularly with the share that is done, 0..1. If it returns
/// `false`, the result is `None`.
///
/// # Errors
/// As for [`groom()`].
pub fn grow_run_while(
    head: &Head,
    growth: &Growth<'_>,
    roots: &[Root],
    first: usize,
    goes_on: &(dyn Fn(f32) -> bool + Sync),
) -> Result<Option<Hair>, SettingError> {
    let &Growth { style, segments, segment_length, seed, .. } = growth;
    let Some(strands) = groom_while(head, roots, style, segments, segment_length, seed, goes_on)? else {
        return Ok(None);
    };
    let group = |root: &Root| strand_style::region(head, style, root, seed) as i32;
    let groups: Vec<i32> = roots.iter().map(group).collect();
    let grown = Region::ALL.iter().filter(|&&region| groups.contains(&(region as i32)));
    let numbers = first..first + roots.len();
    let attributes = Attributes {
        id: Some(numbers.clone().map(|number| number as i64).collect()),
        root_uv: Some(roots.iter().map(|root| root.uv.to_array()).collect()),
        group_names: grown.map(|&region| (region as i32, region.word().to_owned())).collect(),
        group: Some(groups),
        guide: Some(numbers.map(|number| number < GUIDES).collect()),
        ..Attributes::default()
    };
    Ok(Some(Hair { strands, attributes }))
}

/// Styles one strand per root, in the order of the roots: nodes from root to tip (head space, cm).
///
/// A strand of length L has the smallest number of equal segments that are not longer than `segment_length` (cm), at
/// most `segments`. The style must not ask for a length above `segments` x `segment_length`.
///
/// # Errors
/// If a setting is out of range, or a length is above that.
pub fn groom(
    head: &Head,
    roots: &[Root],
    style: &Style,
    segments: usize,
    segment_length: f32,
    seed: u64,
) -> Result<Strands, SettingError> {
    groom_while(head, roots, style, segments, segment_length, seed, &|_| true).map(Option::unwrap_or_default)
}

fn groom_while(
    head: &Head,
    roots: &[Root],
    style: &Style,
    segments: usize,
    segment_length: f32,
    seed: u64,
    goes_on: &(dyn Fn(f32) -> bool + Sync),
) -> Result<Option<Strands>, SettingError> {
    style.check()?;
    check_positive("hair.segment_length", segment_length)?;
    style.curl.check_segment_length(segment_length)?;
    style.ponytail.map_or(Ok(()), |tail| tail.check_place(head))?;
    if segments == 0 {
        return Err(SettingError::new("hair.segments", segments, "must be at least 1"));
    }
    let longest = segments as f32 * segment_length;
    for (region, length) in Region::ALL.into_iter().zip(style.length.each()) {
        let grows = region != Region::Fringe || style.fringe.half_width > 0.0;
        if grows && length > longest * (1.0 + 1e-5) {
            let remedy =
                format!("must be at most hair.segments x hair.segment_length = {longest} cm: raise one of them");
            return Err(SettingError::new(format!("hair.style.length.{}", region.word()), length, remedy));
        }
    }
    let ears = style.volume.over_ears.then(|| EarHills::new(head));
    let ground = Ground {
        head,
        ears: ears.as_ref(),
        volume: style.volume,
        lever_arms: style.lever_arms,
        wave_length: f64::from(style.clumps.wave_length),
        segment: f64::from(segment_length),
    };
    let done = AtomicUsize::new(0);
    let parts: Option<Vec<Strands>> = roots
        .par_chunks(STRANDS_A_TASK)
        .map_init(Draping::default, |draping, of_task| {
            if !goes_on(done.load(Ordering::Relaxed) as f32 / roots.len() as f32) {
                return None;
            }
            let mut strands = Strands::with_capacity(of_task.len(), of_task.len() * (segments + 1));
            for root in of_task {
                let styled = strand_style::strand_style(head, style, root, seed);
                cut::drape_and_cut(&ground, &style.cuts, &styled, draping);
                strands.push(draping.nodes.iter().map(|p| p.as_vec3()));
            }
            done.fetch_add(of_task.len(), Ordering::Relaxed);
            Some(strands)
        })
        .collect();
    let Some(parts) = parts else { return Ok(None) };
    let points = parts.iter().map(|part| part.points().len()).sum();
    let mut strands = Strands::with_capacity(roots.len(), points);
    for strand in parts.iter().flat_map(Strands::iter) {
        strands.push(strand.iter().copied());
    }
    Ok(Some(strands))
}
