//! What is in a scene file.

use std::fmt;

use nabiki::Ellipsoid;
use nabiki::field::Keyframe;
use serde::Serialize;

use crate::scene::{GrownHair, HairSource, ImportedHair, Scene};
use nabiki_io::info::Short;

/// The outline of a scene; of what it names the head alone is loaded.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SceneInfo {
    /// The head's mesh, as the scene names it.
    pub head: String,
    /// The head ellipsoid E (head space, cm), where the head can be loaded.
    pub ellipsoid: Option<Ellipsoid>,
    /// Why the head cannot be loaded, where it cannot.
    pub head_problem: Option<String>,
    /// C is E scaled by this.
    pub shell: f32,
    /// The hair's file, or how it is grown.
    pub hair: String,
    /// Frames after the rest frame.
    pub frames: u32,
    /// Delta t.
    pub time_step: f32,
    /// lambda.
    pub linear_density: f32,
    /// alpha.
    pub alpha: f32,
    /// The field.
    pub force: Vec<Keyframe>,
    /// Frames from one disturbance to the next.
    pub disturbed_every: Option<u32>,
    /// Width and height of the pictures (pixels).
    pub picture: [u32; 2],
}

impl SceneInfo {
    /// Outlines `scene`.
    pub fn of(scene: &Scene) -> Self {
        let hair = match &scene.hair.source {
            HairSource::Imported(ImportedHair { file, strands: None, .. }) => file.display().to_string(),
            HairSource::Imported(ImportedHair { file, strands: Some(count), .. }) => {
                format!("{count} strands of {}", file.display())
            }
            HairSource::Grown(GrownHair { strands, segments, .. }) => {
                format!("{strands} strands of at most {segments} x {} cm", scene.hair.segment_length)
            }
        };
        let head = scene.load_head();
        Self {
            head: scene.head.mesh(),
            ellipsoid: head.as_ref().ok().map(|head| head.ellipsoid),
            head_problem: head.err().map(|problem| problem.to_string()),
            shell: scene.head.shell,
            hair,
            frames: scene.motion.frames,
            time_step: scene.motion.time_step,
            linear_density: scene.motion.linear_density,
            alpha: scene.pseudo_force.alpha,
            force: scene.keyframes().to_vec(),
            disturbed_every: scene.disturbance.as_ref().map(|d| d.every),
            picture: scene.picture.size,
        }
    }
}

impl fmt::Display for SceneInfo {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "scene: {} frames, {} x {} pixels", self.frames, self.picture[0], self.picture[1])?;
        writeln!(f, "head: {}", self.head)?;
        if let Some(Ellipsoid { center, half_axes }) = self.ellipsoid {
            let [x, y, z] = center.to_array().map(Short);
            let [a, b, c] = half_axes.to_array().map(Short);
            writeln!(f, "ellipsoid: {a} x {b} x {c} cm about ({x}, {y}, {z}), shell {} of it", Short(self.shell))?;
        }
        if let Some(problem) = &self.head_problem {
            writeln!(f, "ellipsoid: unknown, {problem}")?;
        }
        writeln!(f, "hair: {}", self.hair)?;
        let (step, density) = (Short(self.time_step), Short(self.linear_density));
        write!(f, "motion: time step {step}, linear density {density}, alpha {}", Short(self.alpha))?;
        if let Some(every) = self.disturbed_every {
            write!(f, ", disturbed every {every} frames")?;
        }
        let mut first = 1;
        for key in &self.force {
            let [x, y, z] = key.vector.to_array().map(Short);
            write!(f, "\nforce: ({x}, {y}, {z}) in frames {first} to {}", key.through)?;
            first = key.through + 1;
        }
        Ok(())
    }
}
