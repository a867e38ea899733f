//! The hair of a scene at rest.

mod grown;
mod imported;
mod members;

use std::fmt::Display;
use std::ops::Range;
use std::sync::Arc;

use glam::Vec3;
use nabiki::dynamics::{Motion, straightened};
use nabiki::region::Members;
use nabiki::{Hair, SettingError, Strands};
use nabiki_io::cache::Shard;
use nabiki_io::identity::StrandSum;
use nabiki_io::painted::PaintedMap;

use super::Shown;
use super::dynamics::first_wanted;
use super::model::Model;
use super::stage::{At, Stage};
use crate::error::{Error, Result};
use crate::memory;
use crate::scene::{GrownHair, HairSource, ImportedHair, Scene};

pub use imported::Imported;

use grown::{Roots, RootsInputs};
use members::Selectors;

/// Hair at rest: all of a scene's strands, or some.
#[derive(Clone, Debug)]
pub struct Groom {
    inputs: GroomInputs,
    /// The hair.
    pub hair: Hair,
    /// Number of strands of the scene. [`hair`](Self::hair) may have fewer.
    pub of_scene: usize,
    /// The shard, if the hair is one shard of the requested strands.
    pub shard: Option<ShardOf>,
    /// The imported file; `None` for grown hair.
    pub imported: Option<Imported>,
    /// Index of each strand among all strands of the scene.
    pub ids: Vec<u32>,
    /// The first strands of the farthest-first order of the whole, whichever are shown: those that the free form needs.
    pub(super) first: Strands,
    /// Which strands belong to each region of the scene: of imported hair all, of grown hair those grown.
    pub(super) members: Vec<Option<Members>>,
}

/// A shard of the requested strands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShardOf {
    /// The shard.
    pub shard: Shard,
    /// Number of requested strands.
    pub strands: usize,
    /// All strands of an imported groom; empty for grown hair.
    pub(super) groom: StrandSum,
}

/// The inputs of hair at rest.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct GroomInputs {
    model: Arc<Model>,
    source: Source,
    /// Segments within this many degrees of an axis (head space) are aligned with it; `None` for none.
    straight: Option<(f32, Vec3)>,
    /// How many of the first strands are wanted.
    first: usize,
    wanted: Wanted,
    selectors: Selectors,
}

#[derive(Clone, Debug, PartialEq)]
enum Source {
    Grown { settings: Box<GrownHair>, segment_length: f32, roots: Arc<Roots> },
    Imported(ImportedHair),
}

/// Which strands are wanted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Wanted {
    pub shown: Shown,
    /// Only one run of these.
    pub shard: Option<Shard>,
}

impl Wanted {
    /// The number of strands shown of `of_scene`, and the run of these that is wanted.
    fn of(self, of_scene: usize, grown: bool) -> Result<(usize, Range<usize>)> {
        let count = self.shown.of(of_scene, grown)?;
        let Some(shard) = self.shard else { return Ok((count, 0..count)) };
        if shard.of() as usize > count {
            let line = format!("shard {shard}: more shards than strands; use at most {count}");
            return Err(Error::refused(line));
        }
        Ok((count, shard.range(count)))
    }
}

impl GroomInputs {
    /// The hair of a scene on its head, with the given polar axis. Reuses `known` roots if they are the same.
    pub fn of<'a>(
        scene: &Scene,
        model: &Arc<Model>,
        polar_axis: Vec3,
        wanted: Wanted,
        known: impl Iterator<Item = &'a Arc<Groom>> + Clone,
        at: At<'_>,
    ) -> Result<Self> {
        let first = first_wanted(scene);
        let selectors = Selectors::of(scene, known.clone().map(|known| &known.inputs.selectors), at)?;
        let source = match &scene.hair.source {
            HairSource::Imported(settings) => Source::Imported(settings.clone()),
            HairSource::Grown(settings) => {
                let (_, run) = wanted.of(settings.strands, true)?;
                let count = run.end.max(first.min(settings.strands));
                let known = known.filter_map(|known| known.roots());
                let roots = Roots::of(RootsInputs::of(model.clone(), settings, count), known, at)?;
                Source::Grown { settings: Box::new(settings.clone()), segment_length: scene.hair.segment_length, roots }
            }
        };
        let straighten = scene.motion.straighten;
        let straight = (straighten != 0.0).then_some((straighten, polar_axis));
        Ok(Self { model: model.clone(), source, straight, first, wanted, selectors })
    }
}

impl Stage for Groom {
    type Inputs = GroomInputs;

    fn is_of(&self, inputs: &GroomInputs) -> bool {
        // The number of strands can be set in several ways; the number in a file is known by now.
        let shown = |of: &GroomInputs| of.wanted.shown.of(self.of_scene, true).ok();
        let wanted = Wanted { shown: self.inputs.wanted.shown, ..inputs.wanted };
        shown(inputs) == shown(&self.inputs) && GroomInputs { wanted, ..inputs.clone() } == self.inputs
    }

    fn make(inputs: GroomInputs, at: At<'_>) -> Result<Self> {
        let mut groom = match &inputs.source {
            Source::Imported(settings) => imported::import(&inputs, settings, at)?,
            Source::Grown { settings, segment_length, roots } => {
                grown::grow(&inputs, settings, *segment_length, roots, at)?
            }
        };
        if let Some((straighten, axis)) = inputs.straight {
            let motion = Motion { straighten, ..Motion::default() };
            groom.hair.strands = straightened(&groom.hair.strands, &motion, axis);
            groom.first = straightened(&groom.first, &motion, axis);
        }
        Ok(groom)
    }
}

impl Groom {
    /// The painted maps of its regions, in the order of these.
    pub(super) fn maps(&self) -> impl Iterator<Item = &PaintedMap> {
        self.inputs.selectors.maps()
    }

    /// The names of the attributes that its regions go by.
    pub(super) fn attributes(&self) -> impl Iterator<Item = &str> {
        self.inputs.selectors.attributes()
    }

    /// Its roots; `None` for hair from a file.
    pub(super) fn roots(&self) -> Option<&Arc<Roots>> {
        match &self.inputs.source {
            Source::Grown { roots, .. } => Some(roots),
            Source::Imported(_) => None,
        }
    }
}

/// Refuses what needs more memory than there is.
fn check_memory(at: At<'_>, key: &str, value: impl Display, needed: u64, what_for: &str, way_out: &str) -> Result<()> {
    match memory::short_of(needed) {
        None => Ok(()),
        Some(short) => Err(at.refusal(SettingError::new(key, value, format!("{what_for} {short}: {way_out}")))),
    }
}
