//! What panels ask for. Nothing else changes what is open, chosen or shown.

use std::path::PathBuf;

use glam::Vec3;
use nabiki::region::Region;
use nabiki::solve::Answer;
use nabiki_scene::Scene;
use nabiki_scene::scene::ForceSettings;
use toml::Value;

use crate::actions::Action;
use crate::dialog::{Chooser, Dialog};
use crate::document::Phase;
use crate::play::Ending;
use crate::preferences::Preferences;
use crate::tasks::Order;
use crate::tools::Tools;

/// Something asked for.
#[derive(Clone, Debug)]
pub enum Command {
    /// Something that has a key.
    Act(Action),
    /// Another value of a setting, or none.
    Set {
        /// Its whole key, as a scene file spells it.
        key: String,
        /// The value; without one it is taken out.
        value: Option<Value>,
        /// How the change goes on.
        phase: Phase,
    },
    /// Other intervals.
    Intervals {
        /// What is done to them.
        name: &'static str,
        /// What they are then.
        keys: Vec<ForceSettings>,
        /// Which are chosen then; as before if it is left out.
        chosen: Option<Vec<usize>>,
        /// How the change goes on.
        phase: Phase,
    },
    /// Another vector of an interval, which is as strong as it is long.
    Vector {
        /// Which.
        interval: usize,
        /// The vector.
        vector: Vec3,
        /// How the change goes on.
        phase: Phase,
    },
    /// The settings that pull the hair where a hand wants it.
    Pulled {
        /// What is done.
        name: &'static str,
        /// The settings.
        answer: Box<Answer>,
        /// The interval that the pull has for its own: chosen once the hand has let go.
        interval: usize,
        /// How the change goes on.
        phase: Phase,
    },
    /// Another tool, or the same set otherwise.
    Use(Box<Tools>),
    /// A region as the brush has left it.
    Painted {
        /// Which; a new one if it is left out.
        region: Option<usize>,
        /// The region.
        painted: Box<Region>,
    },
    /// Hair is combed in a frame.
    Combed {
        /// The frame.
        frame: u32,
        /// Strands of the take by their numbers, as they should lie (head space, cm).
        strands: Vec<(usize, Vec<Vec3>)>,
    },
    /// Another scene altogether, as a tool that solves for a wind gives one.
    Scene {
        /// What made it.
        name: String,
        /// The scene.
        scene: Box<Scene>,
        /// How the change goes on.
        phase: Phase,
    },
    /// The hand has let go.
    EndDrag,
    /// The hand has given up: all as before the drag.
    GiveUpDrag,
    /// These intervals are chosen.
    Choose(Vec<usize>),
    /// This frame is shown.
    Go(u32),
    /// The speed of the play, as a part of the scene's own.
    Speed(f64),
    /// What happens after the last frame.
    End(Ending),
    /// So many strands are shown.
    Strands(usize),
    /// Opens a file: a scene, or what a scene may name.
    Open(PathBuf),
    /// Saves the scene into a file, which is its file from then on.
    SaveTo(PathBuf),
    /// Saves over what another program has written.
    SaveOver,
    /// Opens what was not saved when a window was killed, by its number in the dialog.
    Recover(usize),
    /// Throws it away.
    Forget(usize),
    /// The text of a scene with errors has been changed.
    Mend(String),
    /// It is opened as it has been mended.
    UseMended,
    /// It is left alone.
    LeaveBroken,
    /// A dialog is shown, or changed.
    Show(Box<Dialog>),
    /// The desktop is asked for the file that a chooser is for.
    AskDesktop,
    /// This file is chosen.
    Chosen(Box<Chooser>, PathBuf),
    /// The dialog goes.
    CloseDialog,
    /// Goes on although something is lost by it.
    GoOn,
    /// Saves what this would lose, asks for a name if there is none, and goes on with it.
    SaveAndGoOn(crate::dialog::Next),
    /// Shows where a setting is, by its key; that of a table shows its title.
    Reveal(String),
    /// Begins an export.
    Export(Order),
    /// Stops the export of this number.
    Cancel(usize),
    /// Takes the export of this number from the list.
    Dismiss(usize),
    /// Says that something is refused.
    Refuse {
        /// What: a field, or what a hand did.
        about: String,
        /// Why, in one line.
        why: String,
    },
    /// What was refused has been given as it may be: no more is said of it.
    Took(String),
    /// Takes the word of this number away.
    Heard(usize),
    /// Other preferences.
    Prefer(Box<Preferences>),
    /// Lines that are put together from a dropped file: settings with their values, one step.
    SetAll {
        /// What they are for.
        name: String,
        /// Keys and values.
        settings: Vec<(String, Option<Value>)>,
    },
}
