//! A take: the hair of a stage, all or some of it, and the head's way through the frames.

use glam::Vec3;
use nabiki::dynamics::{ForceSpace, Reference, Simulation};
use nabiki::subset;

use crate::stage::Stage;
use nabiki::Pose;
use nabiki_io::Result;

/// A stage ready to be stepped, frame by frame.
#[derive(Clone, Debug)]
pub struct Take {
    /// Head, hair at rest and dynamics.
    pub stage: Stage,
    /// Number of each strand in the whole hair.
    ids: Vec<u32>,
    /// World poses of the head from frame 0 on; none for a head that stands still.
    poses: Vec<Pose>,
    /// How the head's motion was read and converted, in one line.
    pub motion_report: Option<String>,
}

impl Take {
    /// All of a stage's hair. The head's motion is read at the frame rate of the movie.
    ///
    /// # Errors
    /// A motion file that cannot be read or is shorter than the scene.
    pub fn new(stage: Stage) -> Result<Self> {
        let ids = (0..stage.hair.strands.len() as u32).collect();
        let motion = stage.head_motion(f64::from(stage.scene.picture.video.fps))?;
        let Some(motion) = motion else {
            return Ok(Self { stage, ids, poses: Vec::new(), motion_report: None });
        };
        let (frames, given) = (stage.scene.motion.frames as usize, motion.poses.len());
        if given <= frames {
            let remedy = format!(
                "head.motion ends at frame {} and motion.frames = {frames}: make motion.frames smaller, or the file longer",
                given.saturating_sub(1)
            );
            return Err(nabiki_io::Error::new(remedy).in_file(stage.scene.file()));
        }
        Ok(Self { stage, ids, poses: motion.poses, motion_report: Some(motion.report) })
    }

    /// The same with `count` strands chosen evenly over the scalp, which move exactly as they do in the whole.
    pub fn thinned(&self, count: usize) -> Self {
        let hair = &self.stage.hair;
        let chosen: Vec<usize> = if self.stage.hair_placement.is_none() {
            // Grown hair is in that order.
            (0..count.min(hair.strands.len())).collect()
        } else {
            let roots: Vec<Vec3> = hair.strands.iter().map(|strand| strand[0]).collect();
            let mut chosen = subset::evenly(&roots, count);
            chosen.sort_unstable();
            chosen
        };
        let mut thinned = self.clone();
        thinned.stage.hair = self.stage.hair.select(&chosen);
        thinned.ids = chosen.iter().map(|&s| self.ids[s]).collect();
        thinned
    }

    /// The fast stepper, at rest.
    ///
    /// # Errors
    /// A field too strong for the hair; strands that cannot be moved.
    pub fn simulation(&self) -> Result<Simulation> {
        let Stage { hair, dynamics, .. } = &self.stage;
        Simulation::with_ids(&hair.strands, &self.ids, dynamics).map_err(|refused| self.stage.refusal(refused))
    }

    /// The f64 stepper, at rest.
    ///
    /// # Errors
    /// As [`simulation`](Self::simulation).
    pub fn reference(&self) -> Result<Reference> {
        let Stage { hair, dynamics, .. } = &self.stage;
        Reference::with_ids(&hair.strands, &self.ids, dynamics).map_err(|refused| self.stage.refusal(refused))
    }

    /// Where the head is in a frame.
    pub fn pose(&self, frame: u32) -> Pose {
        self.poses.get(frame as usize).copied().unwrap_or_default()
    }

    /// F(n), in the space that the scene gives its forces in.
    pub fn force(&self, frame: u32) -> Vec3 {
        self.stage.dynamics.field.at(frame)
    }

    /// F(n) as the hair on the turning head feels it.
    pub fn force_in_head(&self, frame: u32) -> Vec3 {
        let force = self.force(frame);
        match self.stage.dynamics.motion.force_space {
            ForceSpace::World => self.pose(frame).rotation.inverse() * force,
            ForceSpace::Head => force,
        }
    }

    /// Whether the head moves.
    pub fn head_moves(&self) -> bool {
        !self.poses.is_empty()
    }
}
