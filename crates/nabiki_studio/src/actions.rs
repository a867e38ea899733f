//! What can be done by a key, from the menu or from the palette: one table for all three, and for the list of keys.

/// Something that can be done without being told more.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Action {
    /// Opens a scene.
    Open,
    /// Saves it.
    Save,
    /// Saves it under another name.
    SaveAs,
    /// Reads it and its files again.
    Reload,
    /// Shows the dialog of exports.
    Export,
    /// Closes the window.
    Quit,
    /// Takes the last step back.
    Undo,
    /// Repeats the step that you undid.
    Redo,
    /// Copies the selected intervals.
    Copy,
    /// Copies and removes them.
    Cut,
    /// Lays what was copied over the wind at this frame.
    Paste,
    /// Removes the chosen intervals.
    Delete,
    /// Selects all intervals.
    SelectAll,
    /// Chooses none.
    SelectNone,
    /// Adds an interval.
    Add,
    /// Cuts the interval at this frame.
    Split,
    /// Joins the chosen intervals.
    Join,
    /// Goes through stepped, linear, smooth.
    Ease,
    /// Keeps the take that is seen.
    Keep,
    /// Shows the take that is kept, or the scene again.
    Compare,
    /// The scene becomes what is kept.
    Exchange,
    /// Plays or pauses.
    Play,
    /// One frame on.
    Forward,
    /// One frame back.
    Back,
    /// The rest frame.
    First,
    /// The last frame.
    Last,
    /// The next border of an interval.
    NextBorder,
    /// The one before.
    PreviousBorder,
    /// Loop, stop, swing.
    Ending,
    /// Frames the hair in the view.
    Frame,
    /// Takes the view over as the scene's camera.
    UseCamera,
    /// Shows the scene's camera in the view.
    SceneCamera,
    /// Paths of the tips.
    Ghosts,
    /// Arrows of the wind.
    Arrows,
    /// The finished picture when the hand rests.
    FinalPicture,
    /// The hand that pulls.
    Pull,
    /// The brush that paints regions.
    Paint,
    /// The comb that makes aims.
    Comb,
    /// Fewer strands.
    Fewer,
    /// More strands.
    More,
    /// Everything larger.
    ZoomIn,
    /// Everything smaller.
    ZoomOut,
    /// The panels as at the first start.
    ResetLayout,
    /// The palette.
    Palette,
    /// The list of keys.
    Keys,
    /// Shows the note with first steps.
    Welcome,
    /// The preferences.
    Preferences,
}

/// A key with what must be held. `command`: Ctrl, or Cmd on a Mac.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shortcut {
    /// Ctrl, or Cmd on a Mac.
    pub command: bool,
    /// Shift.
    pub shift: bool,
    /// The key as the window's library names it.
    pub key: &'static str,
}

impl Shortcut {
    /// As it is written on a key's list.
    pub fn text(&self) -> String {
        let mut text = String::new();
        if self.command {
            text.push_str("Ctrl+");
        }
        if self.shift {
            text.push_str("Shift+");
        }
        text.push_str(match self.key {
            "ArrowRight" => "Right",
            "ArrowLeft" => "Left",
            "ArrowUp" => "Up",
            "ArrowDown" => "Down",
            "Equals" | "Plus" => "+",
            "Minus" => "-",
            "OpenBracket" => "[",
            "CloseBracket" => "]",
            key => key,
        });
        text
    }
}

/// An action with its names.
#[derive(Debug)]
pub struct Entry {
    /// What it does.
    pub action: Action,
    /// The menu that it is in.
    pub menu: &'static str,
    /// Its name there.
    pub name: &'static str,
    /// Its key, if it has one.
    pub key: Option<Shortcut>,
    /// What it does, in a sentence.
    pub help: &'static str,
}

impl Entry {
    /// All its keys, the one of the menus first.
    pub fn keys(&self) -> impl Iterator<Item = Shortcut> {
        let second = SECOND.into_iter().filter(|(action, _)| *action == self.action).map(|(_, key)| key);
        self.key.into_iter().chain(second)
    }

    /// These as they are written on a list.
    pub fn keys_text(&self) -> String {
        let mut texts: Vec<String> = self.keys().map(|key| key.text()).collect();
        texts.dedup();
        texts.join(", ")
    }
}

/// Second keys: on keyboards where + is a key of its own, and the other usual key for redo.
const SECOND: [(Action, Shortcut); 2] = [
    (Action::ZoomIn, Shortcut { command: true, shift: false, key: "Plus" }),
    (Action::Redo, Shortcut { command: true, shift: false, key: "Y" }),
];

/// The menus, in their order.
pub const MENUS: [&str; 6] = ["File", "Edit", "Wind", "Play", "View", "Help"];

const fn plain(key: &'static str) -> Option<Shortcut> {
    Some(Shortcut { command: false, shift: false, key })
}

const fn shift(key: &'static str) -> Option<Shortcut> {
    Some(Shortcut { command: false, shift: true, key })
}

const fn command(key: &'static str) -> Option<Shortcut> {
    Some(Shortcut { command: true, shift: false, key })
}

const fn both(key: &'static str) -> Option<Shortcut> {
    Some(Shortcut { command: true, shift: true, key })
}

const fn entry(
    action: Action,
    menu: &'static str,
    name: &'static str,
    key: Option<Shortcut>,
    help: &'static str,
) -> Entry {
    Entry { action, menu, name, key, help }
}

/// All actions, as the menus have them.
pub const ACTIONS: &[Entry] = &[
    entry(Action::Open, "File", "Open...", command("O"), "Opens a scene file."),
    entry(Action::Save, "File", "Save", command("S"), "Saves the scene to its file and keeps the comments."),
    entry(Action::SaveAs, "File", "Save as...", both("S"), "Saves to another file and continues there."),
    entry(Action::Reload, "File", "Reload", plain("F5"), "Reads the scene and its files again."),
    entry(
        Action::Export,
        "File",
        "Export...",
        command("E"),
        "Exports a movie, a still, hair for other programs or a motion cache.",
    ),
    entry(Action::Quit, "File", "Quit", command("Q"), "Closes the window. Asks first if there are unsaved changes."),
    entry(Action::Undo, "Edit", "Undo", command("Z"), "Undoes the last step. One drag is one step."),
    entry(Action::Redo, "Edit", "Redo", both("Z"), "Repeats the step that you undid."),
    entry(Action::Cut, "Edit", "Cut", command("X"), "Copies the selected intervals and removes them."),
    entry(Action::Copy, "Edit", "Copy", command("C"), "Copies the selected intervals."),
    entry(
        Action::Paste,
        "Edit",
        "Paste",
        command("V"),
        "Pastes the copied intervals over the wind, from this frame on.",
    ),
    entry(
        Action::Delete,
        "Edit",
        "Delete",
        plain("Delete"),
        "Removes the selected intervals. The one before them gets longer.",
    ),
    entry(Action::SelectAll, "Edit", "Select all", command("A"), "Selects all intervals."),
    entry(
        Action::SelectNone,
        "Edit",
        "Select none",
        plain("Escape"),
        "Closes a menu, cancels a drag, or clears the selection.",
    ),
    entry(Action::Add, "Wind", "Add interval", plain("A"), "Adds an interval at this frame, or after the last one."),
    entry(Action::Split, "Wind", "Split", plain("S"), "Splits the interval at this frame in two."),
    entry(
        Action::Join,
        "Wind",
        "Join",
        plain("J"),
        "Joins adjacent selected intervals. The longest one gives the vector.",
    ),
    entry(Action::Ease, "Wind", "Next ease", plain("E"), "Switches how vectors change: stepped, linear or smooth."),
    entry(Action::Play, "Play", "Play or pause", plain("Space"), "Plays from this frame, or pauses."),
    entry(Action::Forward, "Play", "Next frame", plain("ArrowRight"), "Goes one frame forward."),
    entry(Action::Back, "Play", "Previous frame", plain("ArrowLeft"), "Goes one frame back."),
    entry(Action::First, "Play", "First frame", plain("Home"), "Goes to frame 0, the hair at rest."),
    entry(Action::Last, "Play", "Last frame", plain("End"), "Goes to the last frame."),
    entry(
        Action::NextBorder,
        "Play",
        "Next border",
        shift("ArrowRight"),
        "Goes to the next frame where an interval begins.",
    ),
    entry(
        Action::PreviousBorder,
        "Play",
        "Previous border",
        shift("ArrowLeft"),
        "Goes to the previous frame where an interval begins.",
    ),
    entry(Action::Ending, "Play", "Loop, stop or ping-pong", plain("L"), "Switches what happens after the last frame."),
    entry(Action::Keep, "Play", "Keep this take", plain("K"), "Keeps the take you see, for comparison."),
    entry(
        Action::Compare,
        "Play",
        "Compare with kept take",
        plain("X"),
        "Switches between the kept take and the scene.",
    ),
    entry(
        Action::Exchange,
        "Play",
        "Swap with kept take",
        shift("X"),
        "Makes the kept take the scene, and keeps the scene as the take.",
    ),
    entry(Action::Frame, "View", "Frame the hair", plain("F"), "Fits all of the hair in the view."),
    entry(Action::SceneCamera, "View", "Scene camera", plain("C"), "Looks through the scene's camera."),
    entry(Action::UseCamera, "View", "Use view as camera", both("C"), "Sets the scene's camera to this view."),
    entry(Action::Ghosts, "View", "Tip paths", plain("G"), "Shows where the tips were and will be."),
    entry(Action::Arrows, "View", "Wind arrows", plain("W"), "Shows the wind as arrows where it varies in space."),
    entry(Action::FinalPicture, "View", "Final picture", plain("R"), "Renders all strands when you pause."),
    entry(Action::Pull, "View", "Pull hair", plain("P"), "Takes the hand: dragged hair finds its wind."),
    entry(
        Action::Paint,
        "View",
        "Paint a region",
        plain("B"),
        "Takes the brush, or puts it away: it says which hair belongs to a region.",
    ),
    entry(
        Action::Comb,
        "View",
        "Comb hair",
        plain("H"),
        "Takes the comb, or puts it away: an aim leads hair to where it is combed.",
    ),
    entry(
        Action::Fewer,
        "View",
        "Fewer strands",
        plain("OpenBracket"),
        "Shows half as many strands; with brush or comb, makes it smaller.",
    ),
    entry(
        Action::More,
        "View",
        "More strands",
        plain("CloseBracket"),
        "Shows twice as many strands; with brush or comb, makes it larger.",
    ),
    entry(Action::ZoomIn, "View", "Larger", command("Equals"), "Makes text and panels 10 % larger."),
    entry(Action::ZoomOut, "View", "Smaller", command("Minus"), "Makes text and panels 10 % smaller."),
    entry(Action::ResetLayout, "View", "Reset panels", None, "Restores the default panel layout."),
    entry(Action::Palette, "Help", "Find...", command("P"), "Finds a command or setting by a few letters."),
    entry(Action::Keys, "Help", "Keys", plain("F1"), "Lists all keys and mouse actions."),
    entry(Action::Welcome, "Help", "What to try first", None, "Shows the note with first steps."),
    entry(
        Action::Preferences,
        "Edit",
        "Preferences...",
        command("Comma"),
        "Sets navigation, the number of strands and the text size.",
    ),
];

impl Action {
    /// Its names.
    ///
    /// # Panics
    /// Never: every action is in the table, as a test says.
    pub fn entry(self) -> &'static Entry {
        ACTIONS.iter().find(|entry| entry.action == self).expect("every action is in the table")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_key_means_two_things() {
        for (i, a) in ACTIONS.iter().enumerate() {
            for b in &ACTIONS[i + 1..] {
                assert!(a.keys().all(|key| b.keys().all(|other| key != other)), "{} and {}", a.name, b.name);
                assert_ne!(a.action, b.action);
            }
            assert!(MENUS.contains(&a.menu));
        }
    }

    #[test]
    fn every_key_stands_in_the_documentation() {
        let text = include_str!("../../../docs/studio.md");
        for entry in ACTIONS {
            let row = format!("| {} | {} | {} |", entry.keys_text(), entry.name.trim_end_matches("..."), entry.help);
            assert!(text.contains(&row), "docs/studio.md lacks this row:\n{row}");
        }
    }
}
