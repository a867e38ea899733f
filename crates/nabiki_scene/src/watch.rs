//! Watchers of long tasks, which receive reports and progress and may stop the task.

use crate::error::{Error, Result};
use crate::told::Told;

/// The front end's side of a task: a terminal, a window, a script. All methods have defaults.
pub trait Watch {
    /// Something is now known that a person wants to read.
    fn told(&mut self, told: Told) {
        let _ = told;
    }

    /// A stretch of `steps` frames begins, or of so many trials at the most; `doing`: "drawing", "simulating", ...
    fn begin(&mut self, doing: &'static str, steps: u64) {
        let _ = (doing, steps);
    }

    /// One frame of the stretch is done, or one trial.
    fn step(&mut self) {}

    /// The stretch has ended, maybe before all of its steps.
    fn end(&mut self) {}

    /// Whether the task is to stop at the next frame.
    fn cancelled(&self) -> bool {
        false
    }
}

/// A watcher that ignores everything.
#[derive(Clone, Copy, Debug, Default)]
pub struct Unwatched;

impl Watch for Unwatched {}

/// Calls `frame` for each of `frames`, and reports to `watch`.
pub(crate) fn each_frame(
    watch: &mut dyn Watch,
    doing: &'static str,
    frames: std::ops::RangeInclusive<u32>,
    mut frame: impl FnMut(u32) -> Result<()>,
) -> Result<()> {
    watch.begin(doing, u64::from(frames.end() - frames.start()) + 1);
    for n in frames {
        if watch.cancelled() {
            return Err(Error::Cancelled);
        }
        frame(n)?;
        watch.step();
    }
    watch.end();
    Ok(())
}
