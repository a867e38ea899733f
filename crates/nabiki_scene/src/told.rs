//! Reports of tasks, as data. They display as the text of the command line.

use std::fmt;
use std::path::PathBuf;

use glam::Vec3;
use nabiki::Profile;
use nabiki::dynamics::{Dynamics, Form, gain, period, push};
use nabiki::field::Ease;
use nabiki::free_form::FreeForm;
use nabiki_io::hair::ImportReport;
use nabiki_io::screen::OneLine;

use crate::advice::Advice;
use crate::built::{BuiltScene, ShardOf};
use crate::memory::size;
use crate::motion_summary::MotionSummary;
use crate::solve::Solved;

/// A report of a task.
#[derive(Clone, Debug)]
pub enum Told {
    /// Files that are about to be read. Sampling the distance to a large head takes seconds.
    Reading(Vec<PathBuf>),
    /// A summary of the scene.
    Scene(SceneSummary),
    /// The periods of swings.
    Swing(SwingTable),
    /// Statistics of the motion.
    Motion(MotionSummary),
    /// The results of a solver.
    Solved(Box<Solved>),
    /// Something that looks wrong about the size or position of head and hair.
    Advice(Advice),
    /// An assumption of a new scene that no file declares.
    Guessed(String),
    /// Data of a hair file that is not used.
    Unread {
        /// The file.
        file: PathBuf,
        /// What it is, as a phrase.
        what: String,
    },
    /// Data of the hair that a format could not store.
    Lost {
        /// The file.
        file: PathBuf,
        /// What it lacks, as a phrase.
        what: String,
    },
    /// A result will be large.
    Large {
        /// The file or folder.
        file: PathBuf,
        /// Bytes that it will take at least.
        bytes: u64,
    },
    /// Frames of an earlier, longer run that were removed.
    Removed {
        /// The folder that they were in.
        folder: PathBuf,
        /// How many.
        frames: usize,
        /// The last frame of this run, after which they came.
        last: u32,
    },
    /// A file that was written.
    Wrote {
        /// The file or folder.
        file: PathBuf,
        /// What is in it, where the task does not go without saying.
        holds: Option<String>,
    },
}

impl fmt::Display for Told {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Scene(summary) => summary.fmt(f),
            Self::Swing(table) => table.fmt(f),
            Self::Motion(summary) => summary.fmt(f),
            Self::Solved(solved) => solved.fmt(f),
            line => OneLine(line.line()).fmt(f),
        }
    }
}

impl Told {
    /// A report of one line, as text.
    fn line(&self) -> String {
        match self {
            Self::Reading(files) => {
                let names: Vec<String> = files.iter().map(|file| file.display().to_string()).collect();
                format!("  reading {}", names.join(", "))
            }
            Self::Scene(_) | Self::Swing(_) | Self::Motion(_) | Self::Solved(_) => String::new(),
            Self::Advice(advice) => format!("  warning {advice}"),
            Self::Guessed(what) => format!("  guessed {what}"),
            Self::Unread { file, what } => format!("  ignored in {}: {what}", file.display()),
            Self::Lost { file, what } => format!("  lost    {} cannot hold {what}", file.display()),
            Self::Large { file, bytes } => {
                format!("  large   {} needs at least {}", file.display(), size(*bytes))
            }
            Self::Removed { folder, frames, last } => {
                format!(
                    "  removed {frames} files of frames after {last} from {}, left over from a longer run",
                    folder.display()
                )
            }
            Self::Wrote { file, holds: None } => format!("  wrote   {}", file.display()),
            Self::Wrote { file, holds: Some(what) } => format!("  wrote   {}: {what}", file.display()),
        }
    }
}

/// Summary of a scene, and of what was dropped from imported files.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct SceneSummary {
    /// The scene file.
    pub file: PathBuf,
    /// The head's mesh, as named in the scene.
    pub head: String,
    /// Half axes of the head ellipsoid E (cm).
    pub half_axes: [f32; 3],
    /// Triangles of second sides of the head's mesh that were removed.
    pub doubled_triangles: usize,
    /// Triangles of the head's mesh that faced inward and were turned.
    pub turned_triangles: usize,
    /// Edges of the head's openings, which count as closed.
    pub open_edges: usize,
    /// Whether an opening lies where hair grows.
    pub skull_is_open: bool,
    /// Phrases about data of the head's file that is not used.
    pub unread: Vec<String>,
    /// The same for bodies' files, each with the index of the body.
    pub unread_of_bodies: Vec<(usize, String)>,
    /// Frames of the hair's file, of which the first is used; 1 for hair that does not move.
    pub frames_in_file: usize,
    /// How the head's motion was read and converted.
    pub motion: Option<String>,
    /// How the head's skin carries hair, if it bends.
    pub skin: Option<String>,
    /// Number of strands built.
    pub strands: usize,
    /// Number of strands of the scene.
    pub strands_of_scene: usize,
    /// The shard of the requested strands, if these are not all.
    pub shard: Option<ShardOf>,
    /// Number of segments built.
    pub segments: usize,
    /// Length of the longest strand (cm).
    pub longest: f32,
    /// The results of the import.
    pub import: Option<ImportReport>,
}

impl SceneSummary {
    /// The summary of a built scene.
    pub fn of(built: &BuiltScene) -> Self {
        let strands = built.strands();
        let (imported, bodies) = (built.groom.imported.as_ref(), built.bodies.iter().enumerate());
        Self {
            file: built.scene.file().to_owned(),
            head: built.scene.head.mesh(),
            half_axes: built.model.head.ellipsoid.half_axes.to_array(),
            doubled_triangles: built.model.head.orientation.doubled,
            turned_triangles: built.model.head.orientation.turned,
            open_edges: built.model.head.orientation.open_edges,
            skull_is_open: built.model.head.openings.iter().any(|opening| opening.missing.is_some()),
            unread: built.unread_of_head(),
            skin: built.scalp.report.clone(),
            unread_of_bodies: bodies
                .flat_map(|(i, body)| body.unread.iter().map(move |unread| (i, unread.clone())))
                .collect(),
            frames_in_file: imported.map_or(1, |imported| imported.frames),
            motion: built.way.report.clone(),
            strands: strands.len(),
            strands_of_scene: built.groom.of_scene,
            shard: built.groom.shard,
            segments: strands.segment_count(),
            longest: strands.lengths().fold(0.0, f32::max),
            import: imported.map(|imported| imported.report),
        }
    }
}

impl fmt::Display for SceneSummary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}", OneLine(self.file.display()))?;
        let [x, y, z] = self.half_axes;
        writeln!(f, "  head    {}, ellipsoid {x:.1} x {y:.1} x {z:.1} cm", OneLine(&self.head))?;
        if self.doubled_triangles > 0 {
            writeln!(f, "          left out {} back-side triangles", self.doubled_triangles)?;
        }
        if self.turned_triangles > 0 {
            writeln!(f, "          turned {} triangles that faced inward", self.turned_triangles)?;
        }
        if self.open_edges > 0 {
            let place = if self.skull_is_open { "some of them in the skull" } else { "none of them in the skull" };
            writeln!(
                f,
                "          open along {} edges, {place}; nabiki treats openings as closed straight across",
                self.open_edges
            )?;
        }
        for unread in &self.unread {
            writeln!(f, "          ignored in its file: {}", OneLine(unread))?;
        }
        if let Some(motion) = &self.motion {
            writeln!(f, "          {}", OneLine(motion))?;
        }
        if let Some(skin) = &self.skin {
            writeln!(f, "          {}", OneLine(skin))?;
        }
        for (i, unread) in &self.unread_of_bodies {
            writeln!(f, "  body[{i}] ignored in its file: {}", OneLine(unread))?;
        }
        write!(f, "  hair    {} strands", self.strands)?;
        if self.strands < self.strands_of_scene {
            write!(f, " of {}", self.strands_of_scene)?;
        }
        if let Some(ShardOf { shard, strands, .. }) = self.shard {
            write!(f, ", shard {shard} of {strands} strands")?;
        }
        write!(f, ", {} segments, up to {:.1} cm", self.segments, self.longest)?;
        if let Some(import) = &self.import {
            let joined = import.degenerate.joined_points;
            let dropped = import.degenerate.dropped_strands + import.dropped_short;
            write!(
                f,
                "\n          of {} strands in the file; joined {joined} duplicate points, dropped {dropped} strands that are \
                 too short",
                import.strands_in_file
            )?;
            if self.frames_in_file > 1 {
                write!(
                    f,
                    "\n          uses the first of the file's {} frames and ignores its motion",
                    self.frames_in_file
                )?;
            }
            for line in import.turned().into_iter().chain(import.warning()) {
                write!(f, "\n          {line}")?;
            }
        }
        Ok(())
    }
}

/// The periods of swings under each force, before any step. In the paper's form for segments at the root, the middle
/// and the tip of a strand, from c_i and F (section 4.3 of the paper); in the free form for the complete strand.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct SwingTable {
    /// Length of the strand, the median of the hair (cm). For tied hair, the length beyond the tie.
    pub length: f32,
    /// Whether at least half of the hair is tied.
    pub tied: bool,
    /// Number of steps per frame, in the free form.
    pub steps: Option<u32>,
    /// Whether the wind changes gradually. A row then has the force in the middle of its interval.
    pub eased: bool,
    /// One row per interval of `[[force]]`.
    pub rows: Vec<SwingRow>,
    /// The swing under the bound of all fields, where that exceeds the force of every row. The force is taken to pull
    /// the same way as weight, so no swing is faster.
    pub at_most: Option<SwingRow>,
}

/// The swing in one interval.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SwingRow {
    /// First and last frame of the interval.
    pub frames: [u32; 2],
    /// |F|.
    pub force: f64,
    /// Frames of a swing. Infinite without force.
    pub swing: Swing,
}

/// The number of frames of a swing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Swing {
    /// In the paper's form: of single segments at the root, in the middle and at the tip.
    Segments([f64; 3]),
    /// In the free form: the slowest swing of the strand under force, weight and hold, fixed at its root.
    Strand(f64),
}

impl Swing {
    /// The number at the tip.
    pub fn of_tip(self) -> f64 {
        match self {
            Self::Segments([_, _, tip]) => tip,
            Self::Strand(frames) => frames,
        }
    }

    /// All numbers, root first.
    pub fn frames(&self) -> &[f64] {
        match self {
            Self::Segments(frames) => frames,
            Self::Strand(frames) => std::slice::from_ref(frames),
        }
    }
}

/// Frames of the slowest swing of a straight strand of the free form that hangs from its root in the direction of the total `pull`.
///
/// Without stiffness it is a hanging chain, whose omega^2 is 1.446 g / L (1.2024 is half the first zero of the Bessel function J_0), and
/// hold makes it heavier by as much. Without weight it is a cantilever of 12.36 EI / (lambda L^4). Both at once swing at least as fast as
/// their sum says, and at most 3 % faster. Stiffness counts by the square of the curvature, of which the most is at the root; hold by the
/// square of the slope times all that hangs beyond.
fn strand_swing(dynamics: &Dynamics, form: &FreeForm, length: f64, pull: f64) -> f64 {
    let stiffness = mean(&form.stiffness, |s| (1.0 - s).powi(3));
    let hold = mean(&form.hold, |s| s * (1.0 - s));
    let push = push(dynamics, length);
    // EI / lambda in docs/motion-forms.md.
    let bending = 0.375 * push * length * stiffness * f64::from(dynamics.segment_length).powi(2);
    let squared = 1.446 * push * (pull + hold) / length + 12.36 * bending / length.powi(4);
    std::f64::consts::TAU / squared.sqrt()
}

/// The weighted mean of a strength from root (0) to tip (1).
fn mean(profile: &Profile, weight: impl Fn(f64) -> f64) -> f64 {
    const PARTS: u32 = 128;
    let (sum, all) = (0..PARTS).fold((0.0, 0.0), |(sum, all), i| {
        let s = (f64::from(i) + 0.5) / f64::from(PARTS);
        (sum + weight(s) * profile.at(s), all + weight(s))
    });
    sum / all
}

impl SwingTable {
    /// The periods for a built scene, whose field must not be too strong for its hair.
    pub fn of(built: &BuiltScene) -> Self {
        let form = match &built.dynamics.form {
            Form::Paper => None,
            Form::Free(free) => Some(&free.form),
        };
        let tie = form.and_then(|form| form.tie);
        // Held segments do not swing.
        let swinging = |strand: &[Vec3]| {
            let held = tie.map_or(0, |tie| tie.held(strand));
            (strand[held..].windows(2).map(|w| w[0].distance(w[1])).sum::<f32>(), held > 0)
        };
        let (mut lengths, tied): (Vec<f32>, Vec<bool>) = built.strands().iter().map(swinging).unzip();
        lengths.sort_by(f32::total_cmp);
        let length = lengths[lengths.len() / 2];
        let tied = 2 * tied.iter().filter(|&&tied| tied).count() >= lengths.len();
        // `pull`: force and weight together.
        let row = |frames: [u32; 2], force: f32, pull: f64| {
            let (force, long) = (f64::from(force.max(0.0)), f64::from(length));
            let count = long / f64::from(built.dynamics.segment_length);
            let segment = |position: f64| period(gain(&built.dynamics, position, count) * force);
            let swing = match form {
                None => Swing::Segments([1.0, (count + 1.0) / 2.0, count].map(segment)),
                Some(form) => Swing::Strand(strand_swing(&built.dynamics, form, long, pull)),
            };
            SwingRow { frames, force, swing }
        };
        let weight = form.map_or(0.0, |form| form.gravity);
        let mut first = 1;
        let (field, last) = (&built.scene.field, built.frames());
        let reached = built.forces.intervals().iter().scan(0, |before, key| {
            let begins = *before < last;
            *before = key.through;
            begins.then_some(key)
        });
        let rows = reached.map(|key| {
            let pull = (key.vector - weight * Vec3::Y).length();
            let row = row([first, key.through.min(last)], key.vector.length(), pull.into());
            first = key.through.saturating_add(1);
            row
        });
        let rows: Vec<SwingRow> = rows.collect();
        let strongest = built.forces.field.strongest();
        let exceeds = !field.is_the_papers() && rows.iter().all(|row| f64::from(strongest) > row.force);
        let at_most = exceeds.then(|| row([1, last], strongest, (strongest + weight).into()));
        let eased = field.wind.ease != Ease::Stepped;
        Self { length, tied, steps: form.map(FreeForm::steps), eased, rows, at_most }
    }
}

impl fmt::Display for SwingTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (root, tied) = if self.tied { ("tie", " beyond its tie") } else { ("root", "") };
        let length = self.length;
        write!(f, "  swing   frames of one swing of a strand of {length:.1} cm{tied}")?;
        match self.steps {
            None => write!(f, ": at its {root}, middle, tip")?,
            Some(1) => write!(f, "; a frame is one step")?,
            Some(steps) => write!(f, "; a frame is {steps} steps")?,
        }
        if self.eased && !self.rows.is_empty() {
            write!(f, "; |F| in the middle of an interval")?;
        }
        let told = self.rows.iter().map(|row| ("=", row)).chain(self.at_most.iter().map(|row| ("at most", row)));
        for (sign, SwingRow { frames: [first, last], force, swing }) in told {
            let interval = format!("{first} to {last}");
            let force = format!("{sign} {force:.2}");
            write!(f, "\n          frames {interval:<11} |F| {force:<16}")?;
            swing.frames().iter().try_for_each(|frames| write!(f, " {frames:>8.0}"))?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use nabiki::dynamics::Timeline;
    use nabiki::field::{Keyframe, KeyframedField};
    use nabiki::free_form::FreeMotion;
    use nabiki::{Ellipsoid, Strands};

    use super::*;

    /// The times of one swing of a straight strand are those between two passes of its tip in one direction. What is told is at most 3 %
    /// more than a rod of even stiffness takes, the weights of a list take another 2 %, and so do 18 segments and the steps.
    #[test]
    fn a_strand_of_the_free_form_swings_in_as_many_frames_as_are_told() {
        const LENGTH_CM: f32 = 18.0;
        const FRAMES: u32 = 1200;
        let taper = Profile::RootToTip(vec![12_000.0, 1000.0]);
        let even = Profile::Even;
        for (stiffness, hold, gravity) in [
            (even(30.0), even(0.0), 100.0),
            (even(2000.0), even(0.0), 100.0),
            (even(4000.0), even(0.0), 0.0),
            (taper.clone(), even(0.0), 0.0),
            (even(300.0), even(80.0), 0.0),
            (even(300.0), Profile::RootToTip(vec![120.0, 0.0]), 0.0),
            (taper, even(30.0), 100.0),
        ] {
            let form = FreeForm { stiffness, hold, gravity, settle: even(0.0), ..FreeForm::default() };
            let mut dynamics = Dynamics::new(Ellipsoid { center: Vec3::Y * 100.0, half_axes: Vec3::ONE });
            let told = strand_swing(&dynamics, &form, LENGTH_CM.into(), gravity.into());
            dynamics.form = Form::Free(FreeMotion { form: form.clone(), ..FreeMotion::default() });
            let mut strands = Strands::default();
            strands.push((0..=18).map(|i| Vec3::NEG_Y * LENGTH_CM * i as f32 / 18.0));
            let keys = [Keyframe { through: 8, vector: Vec3::X * 5.0 }, Keyframe { through: 9, vector: Vec3::ZERO }];
            let field = Arc::new(KeyframedField::new(&keys).unwrap());
            let mut timeline = Timeline::new(&strands, &dynamics, field, Vec::new(), FRAMES).unwrap();
            let film = timeline.play();
            let tip: Vec<f64> = (9..=FRAMES).map(|n| film.strand(n, 0)[18].x.into()).collect();
            // After the first third, higher modes have died out, and the tip passes its rest twice in a swing.
            let passes: Vec<f64> = (FRAMES as usize / 3..tip.len())
                .filter(|&i| tip[i - 1] < 0.0 && tip[i] >= 0.0)
                .map(|i| i as f64 - tip[i] / (tip[i] - tip[i - 1]))
                .collect();
            let swing = (passes[passes.len() - 1] - passes[0]) / (passes.len() - 1) as f64;
            assert!((told / swing - 1.0).abs() < 0.05, "{told} frames for {swing}: {form:?}");
        }
    }

    #[test]
    fn what_nothing_pulls_on_takes_for_ever() {
        let form = FreeForm { stiffness: Profile::Even(0.0), hold: Profile::Even(0.0), ..FreeForm::default() };
        let dynamics = Dynamics::new(Ellipsoid { center: Vec3::ZERO, half_axes: Vec3::ONE });
        assert_eq!(strand_swing(&dynamics, &form, 18.0, 0.0), f64::INFINITY);
        // Slow motion equals a time step smaller by the same factor.
        let mut slow = dynamics.clone();
        slow.motion.slow = 4.0;
        let [all, slowly] = [&dynamics, &slow].map(|dynamics| strand_swing(dynamics, &form, 18.0, 100.0));
        assert!((slowly / all - 4.0).abs() < 1e-9, "{slowly} frames, {all}");
    }
}
