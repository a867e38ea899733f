//! The time of the stages of drawing.

use std::time::{Duration, Instant};

/// The stages of a frame, in order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Curves through the strands' points.
    Curves,
    /// The head's pixels and shadows, unless they are known from the previous frame.
    Head,
    /// Projection to the picture.
    Projection,
    /// Occlusion of lamps and sky.
    Occlusion,
    /// Shading of hair and skin.
    Shading,
    /// Sorting by depth and into tiles.
    Sorting,
    /// Coverage of pixels.
    Pixels,
}

impl Stage {
    /// All of them, in order.
    pub const ALL: [Self; 7] =
        [Self::Curves, Self::Head, Self::Projection, Self::Occlusion, Self::Shading, Self::Sorting, Self::Pixels];
}

/// Wall-clock time of each stage, summed over frames.
#[derive(Clone, Copy, Debug, Default)]
pub struct Timing {
    spent: [Duration; Stage::ALL.len()],
}

impl Timing {
    /// Time spent on a stage.
    pub fn of(&self, stage: Stage) -> Duration {
        self.spent[stage as usize]
    }

    /// Time spent on all stages.
    pub fn total(&self) -> Duration {
        self.spent.iter().sum()
    }

    pub(crate) fn start(&self) -> Clock {
        Clock(now())
    }
}

/// `None` in a browser, whose clock the standard library cannot read.
fn now() -> Option<Instant> {
    cfg!(not(all(target_family = "wasm", target_os = "unknown"))).then(Instant::now)
}

/// Runs from one stage to the next.
pub(crate) struct Clock(Option<Instant>);

impl Clock {
    pub fn lap(&mut self, timing: &mut Timing, stage: Stage) {
        let now = now();
        timing.spent[stage as usize] += now.zip(self.0).map(|(now, before)| now - before).unwrap_or_default();
        self.0 = now;
    }
}
