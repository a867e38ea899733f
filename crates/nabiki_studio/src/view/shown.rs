//! What is shown in the view, and what a hand does there.

use std::ops::RangeInclusive;

use glam::Vec3;
use nabiki::field::Keyframe;
use nabiki::region::Region;
use nabiki::solve::Answer;
use nabiki_render::Picture;
use nabiki_scene::scene::AimSettings;

use super::Navigation;
use crate::document::Phase;
use crate::take::Take;
use crate::tools::{Tool, Tools};

/// All that is shown, and what is selected of it.
#[derive(Clone, Copy, Debug)]
pub struct Shown<'a> {
    /// The number of the scene: what a hand has left in the view goes with it.
    pub scene: u64,
    /// The last good motion.
    pub take: &'a Take,
    /// The look as it is now: it may be newer than the one the take was built from.
    pub picture: &'a Picture,
    /// The intervals by their strength as they are now, newer than the take while it is simulated.
    pub force: &'a [Keyframe],
    /// The frame looked at, at most the take's last.
    pub frame: u32,
    /// Whether frames are running: nothing is refined then.
    pub playing: bool,
    /// The interval whose vector is a handle in space.
    pub selected_interval: Option<usize>,
    /// Whether the paths of tips are drawn.
    pub ghosts: bool,
    /// Whether the wind is drawn as arrows.
    pub wind: bool,
    /// Whether the final picture fades in when the hand rests.
    pub final_picture: bool,
    /// Strands of the final picture; all of the scene's where it has fewer.
    pub strands_in_final: usize,
    /// Whether a hand can move the camera alone: what is seen is not the scene.
    pub hands_off: bool,
    /// Which buttons move the camera.
    pub navigation: Navigation,
    /// The tool at hand.
    pub tools: &'a Tools,
    /// The regions of the scene as it is now.
    pub regions: &'a [Region],
    /// The aims of the scene as it is now.
    pub aims: &'a [AimSettings],
    /// Whether the scene is in the free form, which regions and aims need.
    pub is_free: bool,
}

impl Shown<'_> {
    /// The tool that a hand has: what is not the scene is not changed.
    pub fn tool(&self) -> Tool {
        if self.hands_off { Tool::Pull } else { self.tools.tool }
    }
}

/// What a hand did in the view, for the session to make true.
#[derive(Clone, Debug, PartialEq)]
pub enum Touch {
    /// The vector of an interval, its handle being dragged; `done` with the button let go: one step of undo.
    SetVector {
        /// Which.
        interval: usize,
        /// Its new vector.
        vector: Vec3,
        /// Whether the hand has let go.
        done: bool,
    },
    /// The hair is pulled: the settings that bring it there.
    Pulled {
        /// What is done, for the menu.
        name: &'static str,
        /// The settings.
        answer: Box<Answer>,
        /// The interval that the pull has for its own.
        interval: usize,
        /// Whether the hand still pulls, has let go, or something nearer was found after it had.
        phase: Phase,
    },
    /// Another tool, or the same set otherwise.
    Use(Box<Tools>),
    /// A region is painted.
    Painted {
        /// Which; a new one if it is left out.
        region: Option<usize>,
        /// The region as the brush has left it.
        painted: Box<Region>,
    },
    /// Hair is combed in a frame.
    Combed {
        /// The frame.
        frame: u32,
        /// Strands by their numbers, as they should lie (head space, cm).
        strands: Vec<(usize, Vec<Vec3>)>,
    },
    /// A drag was given up: all as it was before its first touch.
    Undone,
    /// The camera was moved by hand. [`View::camera`](super::View::camera) is where it is.
    CameraMoved,
    /// It cannot be done, and why.
    Refused(String),
    /// Something else is done than what was refused.
    Heard,
}

/// Frames in which hair is wished to be somewhere.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Marks {
    /// Those of nails.
    pub nails: Vec<u32>,
    /// That of the lock in the hand.
    pub pulled: Option<u32>,
    /// The frames whose wind follows it.
    pub felt: Option<RangeInclusive<u32>>,
}
