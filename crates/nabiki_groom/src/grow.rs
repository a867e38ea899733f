//! The hairstyle: how a strand leaves its root, bends, lies on the head, hangs and is cut (method section 4).
//!
//! Every strand is styled alone, from its root, the style and the seed: any subset of roots, in any order, gives the
//! same strands to the bit, as does any number of threads.

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

/// So many strands, first of the farthest-first order of the roots, are guides: whatever number of them is grown.
pub const GUIDES: usize = 256;

/// Everything that decides which hair grows on a head.
#[derive(Clone, Copy, Debug)]
pub struct Growth<'a> {
    /// Where it grows.
    pub hairline: &'a Hairline,
    /// How it is styled.
    pub style: &'a Style,
    /// Strands of the whole.
    pub strands: usize,
    /// Most segments of a strand.
    pub segments: usize,
    /// Longest segment (cm).
    pub segment_length: f32,
    /// Seed of all that is random.
    pub seed: u64,
}

/// Grows the first `shown` strands of the whole (all of them if it has no more), in the farthest-first order of their
/// roots: to the bit those of the whole, but only they cost time.
///
/// They carry what grooms are expected to have: as `id` the number in that order, which does not depend on how many are
/// shown; `root_uv`; as `group` the region of the style ([`Region::ALL`]) with its name; and the first [`GUIDES`] are
/// marked as guides.
///
/// # Errors
/// If a setting is out of its range, or the hairline leaves nothing of the scalp.
pub fn grow(head: &Head, growth: &Growth<'_>, shown: usize) -> Result<Hair, SettingError> {
    let roots = roots::spread_first(head, growth.hairline, growth.strands, shown, growth.seed)?;
    grow_run(head, growth, &roots, 0)
}

/// The same from roots that are there already, a run of those that [`roots::spread_first`] gives for this hairline, number and
/// seed, which begins with number `first` of the order. Another style does not move them.
///
/// # Errors
/// As [`groom()`].
pub fn grow_run(head: &Head, growth: &Growth<'_>, roots: &[Root], first: usize) -> Result<Hair, SettingError> {
    grow_run_while(head, growth, roots, first, &|_| true).map(Option::unwrap_or_default)
}

/// The same for whoever may want it no more: again and again `goes_on` is told, by any thread, how much is grown, 0..1, and asked
/// whether to go on. None where it was not to.
///
/// # Errors
/// As [`groom()`].
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

/// Styles one strand a root, in the order of the roots: nodes from root to tip (head space, cm).
///
/// A strand of length L is made of the fewest equal segments that are not longer than `segment_length` (cm), so at
/// most `segments` of them: the style may ask for no length beyond `segments` x `segment_length`.
///
/// # Errors
/// If a setting is out of its range, or a length is greater than that.
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
