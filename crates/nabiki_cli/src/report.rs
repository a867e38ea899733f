//! What a command says on standard output, unless it is told to be quiet.

use std::path::PathBuf;

use nabiki::Strands;
use nabiki::dynamics::{gain, period};
use nabiki_scene::Take;

use crate::say::say;

/// Says things about one take.
pub struct Report<'a> {
    take: &'a Take,
    quiet: bool,
}

impl<'a> Report<'a> {
    pub fn new(take: &'a Take, quiet: bool) -> Self {
        Self { take, quiet }
    }

    /// What the scene holds, and what was dropped of an imported file.
    pub fn scene(&self) {
        if self.quiet {
            return;
        }
        let stage = &self.take.stage;
        say!("{}", stage.scene.file().display());
        let ellipsoid = stage.head.ellipsoid;
        let axes = ellipsoid.half_axes;
        say!("  head    {}, ellipsoid {:.1} x {:.1} x {:.1} cm", stage.scene.head.mesh, axes.x, axes.y, axes.z);
        if let Some(motion) = &self.take.motion_report {
            say!("          {motion}");
        }
        let hair = &stage.hair.strands;
        let longest = hair.iter().map(length).fold(0.0, f32::max);
        say!("  hair    {} strands, {} segments, up to {longest:.1} cm", hair.len(), hair.segment_count());
        if let Some(import) = &stage.import_report {
            let joined = import.degenerate.joined_points;
            let dropped = import.degenerate.dropped_strands + import.dropped_short;
            say!(
                "          of {} strands in the file; {joined} doubled points joined, {dropped} strands dropped as too short",
                import.strands_in_file
            );
            if let Some(warning) = import.warning() {
                say!("          {warning}");
            }
        }
    }

    /// How long a swing takes at the root, the middle and the tip of a strand under each force: what c_i and F give
    /// before any step (section 4.3 of the paper).
    pub fn swing(&self) {
        if self.quiet {
            return;
        }
        let stage = &self.take.stage;
        let d = f64::from(stage.dynamics.segment_length);
        let mut lengths: Vec<f32> = stage.hair.strands.iter().map(length).collect();
        lengths.sort_by(f32::total_cmp);
        let middle = f64::from(lengths[lengths.len() / 2]);
        let count = middle / d;
        say!("  swing   frames of one swing of a strand of {middle:.1} cm: at its root, middle, tip");
        let mut first = 1;
        for key in stage.dynamics.field.keyframes() {
            let force = f64::from(key.vector.length());
            let frames = |position: f64| period(gain(&stage.dynamics, position, count) * force);
            let [root, middle, tip] = [1.0, (count + 1.0) / 2.0, count].map(frames);
            let interval = format!("{first} to {}", key.through);
            say!("          frames {interval:<11} |F| = {force:<8.2} {root:>8.0} {middle:>8.0} {tip:>8.0}");
            first = key.through + 1;
        }
    }

    /// The share of nodes, but for the roots, that lie inside the head.
    pub fn inside(&self, strands: &Strands) {
        if self.quiet {
            return;
        }
        let head = &self.take.stage.head;
        let share = |strands: &Strands| {
            let inside = strands.iter().flat_map(|strand| &strand[1..]).filter(|&&p| head.contains(p)).count();
            100.0 * inside as f64 / strands.segment_count() as f64
        };
        let frames = self.take.stage.scene.motion.frames;
        let (now, at_rest) = (share(strands), share(&self.take.stage.hair.strands));
        say!("  inside  {now:.2} % of the nodes are inside the head at frame {frames} ({at_rest:.2} % at rest)");
    }

    /// What a format could not hold.
    pub fn losses(&self, losses: &[String]) {
        for loss in losses.iter().filter(|_| !self.quiet) {
            say!("  lost    {loss}");
        }
    }

    /// The files that now exist.
    pub fn written(&self, files: &[PathBuf]) {
        for file in files.iter().filter(|_| !self.quiet) {
            say!("  wrote   {}", file.display());
        }
    }
}

fn length(strand: &[glam::Vec3]) -> f32 {
    strand.windows(2).map(|w| w[0].distance(w[1])).sum()
}
