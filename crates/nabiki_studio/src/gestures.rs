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
    gesture("View", "Drag hair", "Pulls a lock. The wind changes to bring it there."),
    gesture("View", "B, drag over hair", "Paints which hair belongs to a region. Ctrl erases, Shift smooths."),
    gesture("View", "H, drag hair", "Combs it in this frame. An aim leads it there."),
    gesture("View", "N+click hair", "Nails a lock in its frame, or removes the nail."),
    gesture("View", "Drag the arrow's tip", "Changes the vector of the selected interval."),
    gesture("View", "Drag next to the hair", "Turns the view."),
    gesture("View", "Wheel", "Zooms."),
    gesture("Timeline", "Drag in the ruler", "Scrubs through the frames."),
    gesture("Timeline", "Double-click in the ruler", "Shows all frames again."),
    gesture("Timeline", "Wheel", "Zooms in time."),
    gesture("Timeline", "Shift+wheel", "Scrolls in time."),
    gesture("Timeline", "Click a block", "Selects its interval. Shift selects a range, Ctrl adds or removes one."),
    gesture("Timeline", "Drag over empty space", "Selects the intervals of these frames."),
    gesture("Timeline", "Drag a block", "Moves it in time."),
    gesture("Timeline", "Drag a border", "Moves it. With Shift, everything after it moves along."),
    gesture("Timeline", "Drag a key", "Changes its frame and strength."),
    gesture("Timeline", "Double-click an envelope", "Adds a key."),
    gesture("Timeline", "Right-click a key", "Removes it."),
    gesture("Numbers", "Drag", "Changes the number."),
    gesture("Numbers", "Click", "Lets you type a number. Enter accepts it, Escape restores the old one."),
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
