//! One motion of a scene, whole: all frames of the strands that are shown.

use std::sync::Arc;

use glam::Vec3;
use nabiki::{Pose, Strands};
use nabiki_render::{Picture, View};
use nabiki_scene::BuiltScene;
use nabiki_view::{Body, Drawing, MOST_HAIRS};

/// Most strands that are moved with every touch; where more are shown, they follow once the hand rests.
pub const TOUCHED: usize = 2000;

/// A scene as it was built, and where its shown strands are in every frame.
#[derive(Clone, Debug)]
pub struct Take {
    /// What was moved.
    pub built: Arc<BuiltScene>,
    /// The points of frame 0, then those of frame 1, ... (head space, cm), as [`Strands::points`] orders them.
    pub film: Arc<[Vec3]>,
    /// Counts up with every take of a window, so that what is drawn from one can be kept until the next.
    pub number: u64,
}

impl Take {
    /// The last frame.
    pub fn frames(&self) -> u32 {
        self.built.frames()
    }

    /// The shown strands at rest.
    pub fn strands(&self) -> &Strands {
        self.built.strands()
    }

    /// How many of the strands are at hand: the first, which every touch moves, however many are shown. What is taken hold of
    /// is one of them, and the automatic camera frames them, so that neither changes when more strands come.
    pub fn at_hand(&self) -> usize {
        self.strands().len().min(TOUCHED)
    }

    /// All points at a frame (head space, cm).
    ///
    /// # Panics
    /// If there is no such frame.
    pub fn points(&self, frame: u32) -> &[Vec3] {
        let points = self.strands().points().len();
        &self.film[frame as usize * points..][..points]
    }

    /// Where the head is in a frame.
    pub fn pose(&self, frame: u32) -> Pose {
        self.built.pose(frame)
    }

    /// What is seen besides head and hair in a frame.
    pub fn bodies(&self, frame: u32) -> Vec<Body<'_>> {
        let colour = |i: usize| self.built.scene.bodies[i].colour;
        self.built
            .shown_bodies(frame)
            .map(|(i, mesh, pose)| Body { mesh, skin: self.built.skin_of_body(i, frame), colour: colour(i), pose })
            .collect()
    }

    /// A frame with its `bodies` in a look, for the view to draw.
    ///
    /// # Panics
    /// If there is no such frame.
    pub fn drawing<'a>(&'a self, frame: u32, bodies: &'a [Body], picture: &'a Picture, view: View) -> Drawing<'a> {
        let strands = self.strands();
        Drawing {
            strands,
            points: self.points(frame),
            share: self.built.groom.of_scene as f32 / strands.len().max(1) as f32,
            head: &self.built.model.head,
            skin: self.built.skin(frame),
            pose: self.pose(frame),
            bodies,
            picture,
            view,
            lines: &[],
            most_hairs: MOST_HAIRS,
        }
    }
}
