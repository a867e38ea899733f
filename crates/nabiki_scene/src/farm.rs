//! A scene as a job for many machines: the commands, their order, and the job files of farm engines.

mod openjd;
mod slurm;

use std::ops::RangeInclusive;
use std::path::PathBuf;

use nabiki_io::shell::quoted;

/// The engine that runs a job.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Engine {
    /// Open Job Description templates (jobtemplate-2023-09): AWS Deadline Cloud and others.
    OpenJd,
    /// Slurm: a script that submits itself as arrays of tasks.
    Slurm,
}

/// What a job does.
#[derive(Clone, Debug)]
pub(crate) struct Plan {
    /// The scene's name, which begins the names of results.
    pub name: String,
    /// The scene file, from the root of the file system.
    pub scene: PathBuf,
    /// The folder of the job file, and that of its results, as absolute paths.
    pub folder: PathBuf,
    pub results: PathBuf,
    /// Changes to the scene: `motion.time_step=0.05`.
    pub sets: Vec<String>,
    /// Number of strands; `None` for all of the scene's.
    pub strands: Option<usize>,
    pub shards: u32,
    /// The last frame.
    pub last: u32,
    pub frames_a_task: u32,
    /// Whether the frames become a movie.
    pub movie: bool,
}

/// The words of an engine for what differs between tasks or machines.
struct Names {
    scene: &'static str,
    results: &'static str,
    /// A placeholder for the scene's name; `None` writes the name itself.
    name: Option<&'static str>,
    /// Number of the shard.
    shard: &'static str,
    /// `10..19`
    frames: &'static str,
}

/// A word of a command.
enum Word {
    /// Literal text.
    Plain(String),
    /// A placeholder that the engine fills in.
    Filled(String),
}

impl From<&str> for Word {
    fn from(word: &str) -> Self {
        Self::Plain(word.to_owned())
    }
}

/// A step of the job: its tasks may run in parallel, and all run after the step before.
struct Step {
    name: &'static str,
    tasks: Tasks,
    /// The words after `nabiki`.
    command: Vec<Word>,
}

/// The tasks of a step.
enum Tasks {
    /// A single task.
    One,
    /// One per shard.
    Shards,
    /// One per run of frames.
    Frames,
}

impl Plan {
    /// The steps, in order.
    fn steps(&self, names: &Names) -> Vec<Step> {
        let (name, shards) = (names.name.unwrap_or(&self.name), self.shards);
        let result = |file: &str| Word::Filled(format!("{}/{file}", names.results));
        let shard_file = |number: &str| result(&format!("shards/{number}_of_{shards}.nabiki"));
        let (motion, stills) = (format!("{name}.nabiki"), format!("{name}_frames"));
        let scene = || Word::Filled(names.scene.to_owned());

        let mut simulate = vec!["simulate".into(), scene()];
        simulate.extend(self.strands());
        simulate.extend(self.changes());
        simulate.extend(["--shard".into(), Word::Filled(format!("{}/{shards}", names.shard))]);
        simulate.extend(["-o".into(), shard_file(names.shard), "--quiet".into()]);

        let mut join = vec!["join".into()];
        join.extend((1..=shards).map(|number| shard_file(&number.to_string())));
        join.extend(["-o".into(), result(&motion), "--quiet".into()]);

        let mut render = vec!["render".into(), scene()];
        render.extend(self.strands());
        render.extend(self.changes());
        // The movie of these is made from the frames themselves.
        render.extend(["--set".into(), "output.png_bits=16".into()]);
        render.extend(["--motion".into(), result(&motion)]);
        render.extend(["--frames".into(), Word::Filled(names.frames.to_owned())]);
        render.extend(["--out".into(), Word::Filled(names.results.to_owned()), "--quiet".into()]);

        let step = |name, tasks, command| Step { name, tasks, command };
        let mut steps = vec![
            step("Simulate", Tasks::Shards, simulate),
            step("Join", Tasks::One, join),
            step("Render", Tasks::Frames, render),
        ];
        if self.movie {
            let mut movie = vec!["movie".into(), result(&stills), "--scene".into(), scene()];
            movie.extend(self.strands());
            movie.extend(self.changes());
            movie.extend(["-o".into(), result(&format!("{name}.mp4")), "--quiet".into()]);
            steps.push(step("Movie", Tasks::One, movie));
        }
        steps
    }

    fn strands(&self) -> Vec<Word> {
        self.strands.map_or_else(Vec::new, |count| vec!["--strands".into(), Word::Plain(count.to_string())])
    }

    fn changes(&self) -> impl Iterator<Item = Word> {
        self.sets.iter().flat_map(|set| ["--set".into(), Word::Plain(set.clone())])
    }

    /// The frames of each drawing task.
    pub fn runs(&self) -> impl Iterator<Item = RangeInclusive<u32>> {
        let (last, step) = (self.last, self.frames_a_task);
        (0..=last).step_by(step as usize).map(move |from| from..=from.saturating_add(step - 1).min(last))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plan(last: u32, frames_a_task: u32) -> Plan {
        Plan {
            name: "gust".to_owned(),
            scene: "/scenes/gust.toml".into(),
            folder: "/jobs".into(),
            results: "/jobs/gust".into(),
            sets: vec!["force.0.vector=[1, 2, 3]".to_owned()],
            strands: Some(60),
            shards: 3,
            last,
            frames_a_task,
            movie: true,
        }
    }

    #[test]
    fn runs_are_all_frames_each_once() {
        for last in [0, 1, 9, 10, 11, 100] {
            for frames_a_task in [1, 2, 3, 7, 10, 1000, u32::MAX] {
                let runs: Vec<_> = plan(last, frames_a_task).runs().collect();
                assert!(runs.iter().all(|run| run.end() - run.start() < frames_a_task));
                let frames: Vec<u32> = runs.into_iter().flatten().collect();
                assert_eq!(frames, (0..=last).collect::<Vec<_>>(), "{frames_a_task}");
            }
        }
    }

    #[test]
    fn both_engines_run_the_same_commands() {
        let plan = plan(100, 10);
        let template = plan.template().unwrap();
        let script = plan.script();
        for word in ["force.0.vector=[1, 2, 3]", "--strands", "shards/2_of_3.nabiki", "output.png_bits=16", ".mp4"] {
            assert!(template.contains(word) && script.contains(word), "{word}");
        }
        let silent = Plan { movie: false, ..plan };
        assert!(!silent.template().unwrap().contains("mp4") && !silent.script().contains("mp4"));
    }

    #[test]
    fn what_open_job_description_would_fill_in_is_refused() {
        let odd = Plan { sets: vec!["head.mesh=\"{{x}}.obj\"".to_owned()], ..plan(10, 1) };
        assert!(odd.template().unwrap_err().to_string().contains("{{"));
        assert!(odd.script().contains("{{x}}"));
        let named = Plan { name: "x{{y}}".to_owned(), scene: "/scenes/x{{y}}.toml".into(), ..plan(10, 1) };
        let said = named.template().unwrap_err().to_string();
        assert!(
            said.starts_with("/scenes/x{{y}}.toml: its name contains {{ or }}, ")
                && said.ends_with("; rename the scene"),
            "{said}"
        );
    }
}
