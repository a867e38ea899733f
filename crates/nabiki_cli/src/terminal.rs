//! A terminal that watches a task: lines on standard output, a bar with time left on standard error.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use nabiki_scene::{Told, Watch};

use crate::say::say;

pub struct Terminal {
    quiet: bool,
    bar: ProgressBar,
}

impl Terminal {
    pub fn new(quiet: bool) -> Self {
        Self { quiet, bar: ProgressBar::hidden() }
    }
}

impl Watch for Terminal {
    fn told(&mut self, told: Told) {
        if !self.quiet {
            say!("{told}");
        }
    }

    fn begin(&mut self, doing: &'static str, steps: u64) {
        // Standard error draws no bar where it is no terminal.
        let target = if self.quiet { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
        let style = ProgressStyle::with_template("{msg:10} {wide_bar} {pos}/{len}, {eta} left")
            .unwrap_or_else(|_| ProgressStyle::default_bar());
        self.bar = ProgressBar::with_draw_target(Some(steps), target).with_style(style).with_message(doing);
    }

    fn step(&mut self) {
        self.bar.inc(1);
    }

    fn end(&mut self) {
        self.bar.finish_and_clear();
    }
}
