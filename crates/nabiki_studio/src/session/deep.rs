//! More strands than a touch moves: they follow when the hand rests, on a thread that gives way to the next touch.

use super::Session;
use crate::command::Command;
use crate::motion::{Manner, Motion, Moved, Stage, most_strands};
use crate::preferences::{ALL, FEWEST};
use crate::take::TOUCHED;

/// Seconds without a touch before they are moved.
const REST: f64 = 0.15;

/// Their motion.
#[derive(Debug, Default)]
pub(super) struct Deep {
    /// Its worker, once it has been needed.
    motion: Option<Motion>,
    /// When it is asked for, by the session's clock; none while nothing more is wanted.
    due: Option<f64>,
    /// Whether files are to be read again for it.
    fresh: bool,
}

impl Deep {
    pub fn is_due(&self, clock: f64) -> bool {
        self.due.is_some_and(|due| due <= clock)
    }

    /// Seconds until it is due.
    pub fn waits(&self, clock: f64) -> f64 {
        self.due.map_or(f64::INFINITY, |due| (due - clock).max(0.0))
    }

    pub fn is_working(&self) -> bool {
        self.motion.as_ref().is_some_and(Motion::is_working)
    }

    /// What is being done, and how much of that is, 0..1.
    pub fn progress(&self) -> Option<(Stage, f32)> {
        self.motion.as_ref().filter(|motion| motion.is_working()).map(Motion::progress)
    }

    pub fn wait(&self) {
        self.motion.iter().for_each(Motion::wait);
    }

    pub fn take(&self) -> Option<Moved> {
        self.motion.as_ref()?.take()
    }
}

impl Session {
    /// Gives up what is being moved of more strands than a touch moves. It is asked for when the hand has rested, if it is
    /// wanted. `fresh`: with all files read again.
    pub(super) fn wait_to_deepen(&mut self, fresh: bool) {
        let wanted = self.preferences.strands > TOUCHED;
        let clock = self.clock;
        let deep = &mut self.deep;
        deep.fresh |= fresh;
        deep.due = wanted.then_some(clock + REST);
        match &deep.motion {
            Some(motion) if wanted => motion.stop(),
            Some(motion) => motion.forget(),
            None => {}
        }
    }

    /// Asks for it, where there are more strands and the scene moves as it is.
    pub(super) fn deepen(&mut self) {
        self.deep.due = None;
        let (Some(document), Some(take), None) = (&self.document, &self.take, &self.trouble) else { return };
        let strands = self.preferences.strands.min(most_strands(take));
        if strands <= TOUCHED {
            return;
        }
        let scene = document.scene().clone();
        let motion = match self.deep.motion.take() {
            Some(motion) => Ok(motion),
            None => {
                let wake = self.wake.clone();
                Motion::start(Manner::GivesWay, move || wake.0())
            }
        };
        match motion {
            Ok(mut motion) => {
                motion.ask(scene, strands, std::mem::take(&mut self.deep.fresh));
                self.deep.motion = Some(motion);
            }
            Err(e) => self.say(format!("no more than {TOUCHED} strands can be moved: {e}"), true),
        }
    }

    pub(super) fn receive_deep(&mut self, Moved { result, took, .. }: Moved) {
        match result {
            Ok((take, _)) => (self.take, self.took) = (Some(take), took),
            Err(error) => self.say(error.to_string(), true),
        }
    }

    pub(super) fn show_strands(&mut self, strands: usize) {
        let before = std::mem::replace(&mut self.preferences.strands, strands.max(1));
        if before >= TOUCHED && strands > TOUCHED && self.trouble.is_none() {
            // What a touch moves is there already, and stays until more is.
            self.wait_to_deepen(false);
        } else {
            self.move_again(false);
        }
    }

    /// Twice as many strands, or half as many.
    pub(super) fn step_strands(&mut self, more: bool) {
        let most = self.take.as_ref().map_or(ALL, |take| most_strands(take).max(FEWEST));
        let strands = self.preferences.strands.min(most);
        self.apply(Command::Strands(match more {
            true if 2 * strands >= most => ALL,
            true => 2 * strands,
            false => (strands / 2).max(FEWEST.min(strands)),
        }));
    }
}
