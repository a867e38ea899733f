//! What is in a scene file.

use std::fmt;

use nabiki::Ellipsoid;
use nabiki::field::{Ease, Keyframe};
use serde::Serialize;

use crate::scene::{FieldBound, FieldSettings, GrownHair, HairSource, ImportedHair, Scene};
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
    /// The vectors of the field.
    pub force: Vec<Keyframe>,
    /// How they follow one another.
    pub ease: Ease,
    /// The other fields in words, each by its table.
    pub fields: Vec<(String, String)>,
    /// What each field can reach, where head and motion can be loaded; none where there is nothing but `force`, stepped.
    pub bounds: Vec<FieldBound>,
    /// Why that is unknown, where it is.
    pub bounds_problem: Option<String>,
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
        let bounds = if scene.field.is_the_papers() { Ok(Vec::new()) } else { scene.field_bounds() };
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
            force: scene.field.force.clone(),
            ease: scene.field.wind.ease,
            fields: in_words(&scene.field),
            bounds: bounds.as_ref().cloned().unwrap_or_default(),
            bounds_problem: bounds.err().map(|problem| problem.to_string()),
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
        match self.ease {
            Ease::Stepped => {}
            Ease::Linear => write!(f, "\nwind: eased linearly from one to the next")?,
            Ease::Smooth => write!(f, "\nwind: eased smoothly from one to the next")?,
        }
        for (name, words) in &self.fields {
            write!(f, "\n{name}: {words}")?;
            match self.bounds.iter().find(|bound| bound.name == *name) {
                Some(FieldBound { at_most, .. }) if name == "gust" || name == "flow" => {
                    write!(f, ", at most {} times the wind", Short(*at_most))?;
                }
                Some(FieldBound { at_most, .. }) => write!(f, ", |F| at most {}", Short(*at_most))?,
                None => {}
            }
        }
        match (self.bounds.iter().find(|bound| bound.name == "all"), &self.bounds_problem) {
            (Some(all), _) => write!(f, "\nall fields: |F| at most {}", Short(all.at_most)),
            (None, Some(problem)) => write!(f, "\nall fields: bound unknown, {problem}"),
            (None, None) => Ok(()),
        }
    }
}

/// The fields beside `[[force]]`, each by its table.
fn in_words(field: &FieldSettings) -> Vec<(String, String)> {
    let FieldSettings { force: _, wind: _, gust, body_wind, flow, turbulence, point, vortex, fan, own } = field;
    let mut words = Vec::new();
    let mut say = |name: String, text: String| words.push((name, text));
    if let Some(gust) = gust {
        let (part, time) = (Short(100.0 * gust.intensity), Short(gust.time_scale));
        say("gust".to_owned(), format!("{part} % of the wind, time scale {time} s, up to {} Hz", Short(gust.highest)));
    }
    if let Some(body_wind) = body_wind {
        let (drag, footfall) = (Short(body_wind.drag), Short(body_wind.footfall));
        say("body_wind".to_owned(), format!("{drag} per cm/s of the head, {footfall} per cm/s^2 upward"));
    }
    if let Some(flow) = flow {
        say("flow".to_owned(), format!("round the head ellipsoid and {} cm of hair", Short(flow.thickness)));
    }
    if let Some(turbulence) = turbulence {
        let (strength, size) = (Short(turbulence.strength), Short(turbulence.swirl_size));
        let text = format!("strength {strength}, swirls of {size} cm and {} octaves", turbulence.octaves);
        say("turbulence".to_owned(), text);
    }
    let place = |position: glam::Vec3| {
        let [x, y, z] = position.to_array().map(Short);
        format!("at ({x}, {y}, {z})")
    };
    for (i, point) in point.iter().enumerate() {
        say(format!("point[{i}]"), format!("strength {} {}", Short(point.strength), place(point.position)));
    }
    for (i, vortex) in vortex.iter().enumerate() {
        say(format!("vortex[{i}]"), format!("strength {} {}", Short(vortex.strength), place(vortex.position)));
    }
    for (i, fan) in fan.iter().enumerate() {
        let text = format!(
            "strength {} {}, {} degrees wide",
            Short(fan.strength),
            place(fan.position),
            Short(2.0 * fan.spread)
        );
        say(format!("fan[{i}]"), text);
    }
    for i in 0..own.len() {
        say(format!("own[{i}]"), "a field that a program gave".to_owned());
    }
    words
}
