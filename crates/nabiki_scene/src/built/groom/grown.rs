//! Hair grown on the head of a scene.

use std::sync::Arc;

use glam::Vec3;
use nabiki::{Hair, Head};
use nabiki_groom::roots::{self, Root};
use nabiki_groom::style::Region;
use nabiki_groom::{Growth, Hairline, grow_run_while};
use nabiki_io::identity::StrandSum;

use super::members::Names;
use super::{Groom, GroomInputs, ShardOf, check_memory};
use crate::built::model::Model;
use crate::built::stage::{At, GoesOn, Stage};
use crate::error::{Error, Result};
use crate::memory;
use crate::scene::{EllipsoidChoice, GrownHair};

/// The roots of the hair. Equal only to themselves.
#[derive(Debug)]
pub(in crate::built) struct Roots {
    inputs: RootsInputs,
    /// The first ones of the farthest-first order.
    list: Vec<Root>,
}

/// The inputs of roots.
#[derive(Debug, PartialEq)]
pub(in crate::built) struct RootsInputs {
    model: Arc<Model>,
    hairline: Hairline,
    seed: u64,
    /// For the whole scene: all are spread, however few are wanted.
    strands: usize,
    /// How many are wanted.
    count: usize,
}

impl RootsInputs {
    pub fn of(model: Arc<Model>, settings: &GrownHair, count: usize) -> Self {
        let GrownHair { strands, seed, hairline, .. } = settings;
        Self { model, hairline: hairline.clone(), seed: *seed, strands: *strands, count }
    }
}

impl PartialEq for Roots {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self, other)
    }
}

impl Stage for Roots {
    type Inputs = RootsInputs;

    fn is_of(&self, inputs: &RootsInputs) -> bool {
        self.inputs == *inputs
    }

    fn make(inputs: RootsInputs, at: At<'_>) -> Result<Self> {
        let RootsInputs { model, hairline, seed, strands, count } = &inputs;
        check_memory(at, "hair.strands", strands, roots::least_bytes(*strands), "spreading their roots", "grow fewer")?;
        let still = || (at.goes_on)(0.0);
        let list = roots::spread_first_while(&model.head, hairline, *strands, *count, *seed, &still);
        let list = list.map_err(|mut refused| {
            // Hair grows where the skin is near the ellipsoid, so a given one may be the cause, too.
            if refused.thing == "hair.hairline" && matches!(model.inputs.ellipsoid, EllipsoidChoice::Given(_)) {
                refused.remedy += ", or correct head.ellipsoid: hair grows where the skin is near it";
            }
            at.refusal(refused)
        })?;
        Ok(Self { list: list.ok_or(Error::Cancelled)?, inputs })
    }
}

/// The wanted strands, grown from their roots.
pub(super) fn grow(
    inputs: &GroomInputs,
    settings: &GrownHair,
    segment_length: f32,
    roots: &Roots,
    at: At<'_>,
) -> Result<Groom> {
    let GrownHair { strands, segments, seed, hairline, style } = settings;
    let growth = Growth { hairline, style, strands: *strands, segments: *segments, segment_length, seed: *seed };
    let (count, run) = inputs.wanted.of(*strands, true)?;
    let first = inputs.first.min(*strands);
    // Those from index `from` on.
    let grown = |roots: &[Root], from: usize, goes_on: GoesOn<'_>| -> Result<Hair> {
        let head = &inputs.model.head;
        check_growth(at, &growth, head, roots)?;
        let grown = grow_run_while(head, &growth, roots, from, goes_on);
        grown.map_err(|refused| at.refusal(refused))?.ok_or(Error::Cancelled)
    };
    let roots = &roots.list;
    let (hair, first) = if run.start < first {
        // The first strands are grown in any case.
        let hair = grown(roots, 0, at.goes_on)?;
        let first = hair.select(&(0..first).collect::<Vec<_>>());
        let more = hair.strands.len() > run.len();
        (if more { hair.select(&run.clone().collect::<Vec<_>>()) } else { hair }, first)
    } else {
        let first = grown(&roots[..first], 0, &|_| (at.goes_on)(0.0))?;
        (grown(&roots[run.clone()], run.start, at.goes_on)?, first)
    };
    let ids = run.map(|number| number as u32).collect();
    let shard = inputs.wanted.shard.map(|shard| ShardOf { shard, strands: count, groom: StrandSum::default() });
    let names = Names { of_others: &Region::ALL.map(Region::word), ..Names::default() };
    let members = inputs.selectors.members(&[&hair, &first], &inputs.model.head, &names);
    let (members, first) = (members.map_err(|refused| at.refusal(refused))?, first.strands);
    Ok(Groom { inputs: inputs.clone(), hair, of_scene: *strands, shard, imported: None, ids, first, members })
}

/// Refuses hair whose points take more memory than there is.
fn check_growth(at: At<'_>, growth: &Growth<'_>, head: &Head, roots: &[Root]) -> Result<()> {
    // This many show how long the others will be.
    const FEW: usize = 256;
    // Before and after straightening.
    let bytes = |points: f64| (2.0 * points * size_of::<Vec3>() as f64) as u64;
    if memory::short_of(bytes(roots.len() as f64 * (growth.segments as f64 + 1.0))).is_none() {
        return Ok(());
    }
    // Short hair has fewer segments than the maximum.
    let few = &roots[..roots.len().min(FEW)];
    let tried = grow_run_while(head, growth, few, 0, &|_| true).map_err(|refused| at.refusal(refused))?;
    let mean = tried.map_or(0.0, |hair| hair.strands.points().len() as f64 / few.len().max(1) as f64);
    // A lower bound: the strands tried may be longer than most.
    let needed = bytes(0.9 * mean * roots.len() as f64);
    let what_for = format!("growing {} of them", roots.len());
    check_memory(at, "hair.strands", growth.strands, needed, &what_for, "show fewer strands")
}
