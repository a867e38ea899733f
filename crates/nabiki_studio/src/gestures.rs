//! What a mouse does, with what is held: one table for the list of keys and for the documentation.

/// Something that a hand does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Gesture {
    /// Where.
    pub place: &'static str,
    /// With which button on what, and what is held.
    pub hand: &'static str,
    /// What it does, in a sentence.
    pub what: &'static str,
}

const fn gesture(place: &'static str, hand: &'static str, what: &'static str) -> Gesture {
    Gesture { place, hand, what }
}

/// The places, in their order.
pub const PLACES: [&str; 3] = ["View", "Timeline", "Numbers"];

/// All that a hand does but for moving the camera, which is as the preferences say.
pub const GESTURES: &[Gesture] = &[
    gesture("View", "Drag hair", "Pulls a lock; the wind follows."),
    gesture("View", "N+click hair", "Nails a lock in its frame, or takes the nail out."),
    gesture("View", "Drag the arrow's tip", "Changes the vector of the chosen interval."),
    gesture("View", "Drag beside the hair", "Turns."),
    gesture("View", "Wheel", "Nearer, farther."),
    gesture("Timeline", "Drag in the ruler", "Shows a frame."),
    gesture("Timeline", "Double click in the ruler", "Shows all frames again."),
    gesture("Timeline", "Wheel", "Fewer frames, more."),
    gesture("Timeline", "Shift+wheel", "Earlier frames, later ones."),
    gesture("Timeline", "Click a block", "Chooses its interval; Shift: all up to it, Ctrl: one more or less."),
    gesture("Timeline", "Drag over nothing", "Chooses the intervals of these frames."),
    gesture("Timeline", "Drag a block", "Slides it."),
    gesture("Timeline", "Drag a border", "Moves it; Shift: what comes after, too."),
    gesture("Timeline", "Drag a key", "Moves it: strength over time."),
    gesture("Timeline", "Double click over time", "A new key."),
    gesture("Timeline", "Right click on a key", "Removes it."),
    gesture("Numbers", "Drag", "Less, more."),
    gesture("Numbers", "Click", "Types another; Enter takes it, Escape puts the old one back."),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_gesture_stands_in_the_documentation() {
        let text = include_str!("../../../docs/studio.md");
        for Gesture { place, hand, what } in GESTURES {
            assert!(PLACES.contains(place));
            let row = format!("| {place} | {hand} | {what} |");
            assert!(text.contains(&row), "docs/studio.md lacks this row:\n{row}");
        }
    }
}
