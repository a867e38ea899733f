//! The clock that shows one frame after another.

/// What happens after the last frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Deserialize, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Ending {
    /// It begins again.
    #[default]
    Loop,
    /// It stops there.
    Stop,
    /// It goes back, and forth again.
    Swing,
}

/// Where the play stands. Time comes in from outside.
#[derive(Clone, Debug)]
pub struct Play {
    /// The frame shown, with the part of the way to the next.
    at: f64,
    /// The last frame.
    last: u32,
    playing: bool,
    backward: bool,
    /// Part of the scene's own frame rate.
    pub speed: f64,
    /// What happens after the last frame.
    pub ending: Ending,
}

impl Default for Play {
    fn default() -> Self {
        Self { at: 0.0, last: 0, playing: false, backward: false, speed: 1.0, ending: Ending::Loop }
    }
}

impl Play {
    /// Speeds that are offered.
    pub const SPEEDS: [f64; 6] = [0.1, 0.25, 0.5, 1.0, 2.0, 4.0];

    /// A play that stands at frame 0.
    pub fn new(ending: Ending) -> Self {
        Self { ending, ..Self::default() }
    }

    /// The frame shown.
    pub fn frame(&self) -> u32 {
        (self.at as u32).min(self.last)
    }

    /// The last frame.
    pub fn last(&self) -> u32 {
        self.last
    }

    /// Whether it plays.
    pub fn is_playing(&self) -> bool {
        self.playing
    }

    /// Another number of frames; a frame beyond them becomes the last.
    pub fn set_last(&mut self, last: u32) {
        self.last = last;
        self.at = self.at.min(f64::from(last));
    }

    /// Shows a frame, or the last if there is no such frame.
    pub fn go(&mut self, frame: u32) {
        self.at = f64::from(frame.min(self.last));
    }

    /// Shows the frame so many later or earlier and stops, at either end as it ends.
    pub fn step(&mut self, frames: i64) {
        self.playing = false;
        let (count, frame) = (i64::from(self.last) + 1, i64::from(self.frame()) + frames);
        let frame = match self.ending {
            Ending::Loop => frame.rem_euclid(count),
            Ending::Stop | Ending::Swing => frame.clamp(0, count - 1),
        };
        self.at = frame as f64;
    }

    /// Plays, or pauses. From the last frame, where it would stop, it begins again.
    pub fn set_playing(&mut self, playing: bool) {
        if playing && self.ending == Ending::Stop && self.frame() == self.last {
            self.at = 0.0;
        }
        self.playing = playing;
    }

    /// Lets time pass: `seconds` at `rate` frames a second.
    pub fn advance(&mut self, seconds: f64, rate: f64) {
        let whole = f64::from(self.last) + 1.0;
        let way = seconds * rate * self.speed;
        if !self.playing || !way.is_finite() || way <= 0.0 {
            return;
        }
        match self.ending {
            Ending::Loop => self.at = (self.at + way).rem_euclid(whole),
            Ending::Stop if self.at + way >= f64::from(self.last) => {
                (self.at, self.playing) = (f64::from(self.last), false);
            }
            Ending::Stop => self.at += way,
            Ending::Swing => {
                // There and back is one round of twice the way; a place on it says where and in which direction.
                let round = 2.0 * f64::from(self.last).max(1.0);
                let place = if self.backward { round - self.at } else { self.at };
                let place = (place + way).rem_euclid(round);
                self.backward = place > round / 2.0;
                self.at = (if self.backward { round - place } else { place }).min(f64::from(self.last));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn playing(last: u32, ending: Ending) -> Play {
        let mut play = Play { ending, ..Play::default() };
        play.set_last(last);
        play.set_playing(true);
        play
    }

    #[test]
    fn every_frame_is_shown_once_in_a_round() {
        let mut play = playing(9, Ending::Loop);
        let mut shown = Vec::new();
        for _ in 0..20 {
            shown.push(play.frame());
            play.advance(0.125, 8.0);
        }
        let rounds: Vec<u32> = (0..20).map(|n| n % 10).collect();
        assert_eq!(shown, rounds);
    }

    #[test]
    fn the_speed_is_a_part_of_the_rate() {
        let mut play = playing(99, Ending::Loop);
        play.speed = 0.25;
        play.advance(1.0, 24.0);
        assert_eq!(play.frame(), 6);
    }

    #[test]
    fn it_stops_at_the_end_and_begins_again_from_there() {
        let mut play = playing(9, Ending::Stop);
        play.advance(100.0, 24.0);
        assert!(!play.is_playing());
        assert_eq!(play.frame(), 9);
        play.set_playing(true);
        assert_eq!(play.frame(), 0);
        for ending in [Ending::Loop, Ending::Swing] {
            let mut play = playing(9, ending);
            play.go(9);
            play.set_playing(true);
            assert_eq!(play.frame(), 9, "it goes on from there");
        }
    }

    #[test]
    fn a_swing_turns_at_both_ends() {
        let mut play = playing(3, Ending::Swing);
        let mut shown = Vec::new();
        for _ in 0..12 {
            shown.push(play.frame());
            play.advance(1.0, 1.0);
        }
        assert_eq!(shown, [0, 1, 2, 3, 2, 1, 0, 1, 2, 3, 2, 1]);
    }

    #[test]
    fn steps_pause_and_go_round_only_where_it_loops() {
        let mut play = playing(9, Ending::Loop);
        play.step(-1);
        assert_eq!((play.frame(), play.is_playing()), (9, false));
        for ending in [Ending::Stop, Ending::Swing] {
            play.ending = ending;
            play.step(5);
            assert_eq!(play.frame(), 9);
        }
        play.go(99);
        play.set_last(4);
        assert_eq!(play.frame(), 4);
        play.go(99);
        play.set_last(9);
        assert_eq!(play.frame(), 4, "a longer motion moves nothing");
    }

    #[test]
    fn times_that_are_none_change_nothing() {
        let mut play = playing(9, Ending::Loop);
        for way in [f64::NAN, f64::INFINITY, -1.0] {
            play.advance(way, 24.0);
            assert_eq!(play.frame(), 0);
        }
    }
}
