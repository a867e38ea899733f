//! Long work in the background: exports, with how far they are, how long it still takes, and a way to stop them.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use nabiki_scene::exports::ExportOptions;
use nabiki_scene::tasks::{self, Pictures, RenderOptions, SimulateOptions, Twin};
use nabiki_scene::{Error, Scene, Shown, Told, Watch};

/// What is exported.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A movie and whatever else `[output]` asks for, into a folder.
    Movie,
    /// A picture of one frame, into a folder.
    Still,
    /// Moving hair as USD.
    Usd,
    /// Moving hair as Alembic.
    Alembic,
    /// A motion cache.
    Cache,
}

impl Kind {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Movie, Self::Still, Self::Usd, Self::Alembic, Self::Cache];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Movie => "Movie",
            Self::Still => "Still",
            Self::Usd => "USD",
            Self::Alembic => "Alembic",
            Self::Cache => "Motion cache",
        }
    }

    /// What it is, in a sentence.
    pub fn help(self) -> &'static str {
        match self {
            Self::Movie => {
                "Draws all strands: a movie, a contact sheet, and the files set in Picture > Output. Writes a folder."
            }
            Self::Still => "Draws this frame with all strands as a PNG, from the scene's camera. Writes a folder.",
            Self::Usd => "Moving hair for other programs: .usdc, or .usda as text.",
            Self::Alembic => "Moving hair for other programs: .abc.",
            Self::Cache => "The motion cache that nabiki render reads: .nabiki.",
        }
    }

    /// The ending of its file; none for what goes into a folder.
    pub fn ending(self) -> Option<&'static str> {
        match self {
            Self::Movie | Self::Still => None,
            Self::Usd => Some("usdc"),
            Self::Alembic => Some("abc"),
            Self::Cache => Some("nabiki"),
        }
    }

    /// Where it would go by default.
    pub fn place(self, scene: &Scene) -> PathBuf {
        let folder = std::path::absolute(scene.file()).ok().and_then(|file| file.parent().map(Path::to_owned));
        let folder = folder.unwrap_or_default().join("out");
        match self.ending() {
            None => folder,
            Some(ending) => folder.join(format!("{}.{ending}", scene.name())),
        }
    }
}

/// What is to be exported, and where.
#[derive(Clone, Debug, PartialEq)]
pub struct Order {
    /// What.
    pub kind: Kind,
    /// The file or folder.
    pub place: PathBuf,
    /// The frame of a still.
    pub frame: u32,
    /// Strands, of the whole scene if none are named.
    pub strands: Option<usize>,
}

/// How far a task is.
#[derive(Clone, Debug)]
pub struct Progress {
    /// What it does: "drawing", "simulating".
    pub doing: String,
    /// Steps done and in all.
    pub steps: [u64; 2],
    /// When this stretch began.
    began: Instant,
    /// What it said, a line each.
    pub said: Vec<String>,
    /// How it ended, once it has.
    pub ended: Option<Ended>,
}

/// How a task ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Ended {
    /// These files are there.
    Wrote(Vec<PathBuf>),
    /// It was stopped, and left nothing.
    Cancelled,
    /// In one line.
    Failed(String),
}

impl Progress {
    /// The part done, 0..1.
    pub fn part(&self) -> f32 {
        let [done, all] = self.steps;
        if all == 0 { 0.0 } else { done as f32 / all as f32 }
    }

    /// How long the rest of this stretch will take, by what it has taken so far; none before a tenth of a second.
    pub fn left(&self) -> Option<Duration> {
        left(self.began.elapsed(), self.steps)
    }
}

fn left(passed: Duration, [done, all]: [u64; 2]) -> Option<Duration> {
    (done > 0 && passed > Duration::from_millis(100))
        .then(|| passed.mul_f64(all.saturating_sub(done) as f64 / done as f64))
}

/// A task in the background.
#[derive(Debug)]
pub struct Task {
    /// What it makes, and where.
    pub order: Order,
    progress: Arc<Mutex<Progress>>,
    cancel: Arc<AtomicBool>,
}

impl Task {
    /// Begins one. `wake` is called whenever there is something new to see.
    ///
    /// # Errors
    /// The system's, if it gives no thread.
    pub fn begin(order: Order, scene: Scene, wake: impl Fn() + Send + 'static) -> std::io::Result<Self> {
        let progress = Arc::new(Mutex::new(Progress {
            doing: "preparing".to_owned(),
            steps: [0, 0],
            began: Instant::now(),
            said: Vec::new(),
            ended: None,
        }));
        let cancel = Arc::new(AtomicBool::new(false));
        let mut watcher = Watcher { progress: progress.clone(), cancel: cancel.clone(), wake, wrote: Vec::new() };
        let theirs = order.clone();
        std::thread::Builder::new().name("export".to_owned()).spawn(move || {
            // Tasks of its own pool do not stand in the way of a touch.
            let result = match rayon::ThreadPoolBuilder::new().build() {
                Ok(pool) => pool.install(|| carry_out(&theirs, scene, &mut watcher)),
                Err(_) => carry_out(&theirs, scene, &mut watcher),
            };
            let ended = match result {
                Ok(()) => Ended::Wrote(std::mem::take(&mut watcher.wrote)),
                Err(Error::Cancelled) => Ended::Cancelled,
                Err(e) => Ended::Failed(e.to_string()),
            };
            watcher.change(|progress| progress.ended = Some(ended));
        })?;
        Ok(Self { order, progress, cancel })
    }

    /// How far it is.
    pub fn progress(&self) -> Progress {
        self.progress.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Stops it at the next frame.
    pub fn cancel(&self) {
        self.cancel.store(true, Ordering::Relaxed);
    }

    /// Whether it was told to stop.
    pub fn is_cancelled(&self) -> bool {
        self.cancel.load(Ordering::Relaxed)
    }

    /// Whether it has ended.
    pub fn has_ended(&self) -> bool {
        self.progress().ended.is_some()
    }
}

struct Watcher<W> {
    progress: Arc<Mutex<Progress>>,
    cancel: Arc<AtomicBool>,
    wake: W,
    wrote: Vec<PathBuf>,
}

impl<W: Fn()> Watcher<W> {
    fn change(&self, change: impl FnOnce(&mut Progress)) {
        change(&mut self.progress.lock().unwrap_or_else(PoisonError::into_inner));
        (self.wake)();
    }
}

impl<W: Fn()> Watch for Watcher<W> {
    fn told(&mut self, told: Told) {
        if let Told::Wrote { file, .. } = &told {
            self.wrote.push(file.clone());
        }
        // What the scene is like is seen in the window; what goes wrong or is lost is not.
        let worth_a_line = matches!(
            told,
            Told::Advice(_) | Told::Unread { .. } | Told::Lost { .. } | Told::Large { .. } | Told::Removed { .. }
        );
        if worth_a_line {
            let line = told.to_string().trim().to_owned();
            self.change(|progress| progress.said.push(line));
        }
    }

    fn begin(&mut self, doing: &'static str, steps: u64) {
        self.change(|progress| {
            (progress.doing, progress.steps, progress.began) = (doing.to_owned(), [0, steps], Instant::now());
        });
    }

    fn step(&mut self) {
        self.change(|progress| progress.steps[0] += 1);
    }

    fn cancelled(&self) -> bool {
        self.cancel.load(Ordering::Relaxed)
    }
}

fn carry_out(order: &Order, scene: Scene, watch: &mut dyn Watch) -> Result<(), Error> {
    let Order { kind, place, frame, strands } = order;
    let shown = strands.map_or(Shown::All, Shown::AtMost);
    if kind.ending().is_some()
        && let Some(folder) = place.parent().filter(|folder| !folder.as_os_str().is_empty())
        && !folder.exists()
    {
        std::fs::create_dir_all(folder)
            .map_err(|e| Error::refused(format!("{}: cannot create this folder: {e}", folder.display())))?;
    }
    match kind {
        Kind::Movie => tasks::run(scene, shown, place, &ExportOptions::default(), watch),
        Kind::Still => {
            let options = RenderOptions { motion: None, pictures: Pictures::One(*frame) };
            tasks::render(scene, shown, &options, place, watch)
        }
        Kind::Usd | Kind::Alembic | Kind::Cache => {
            let options = SimulateOptions {
                output: place.clone(),
                exports: ExportOptions::default(),
                twin: Twin::Fast,
                shard: None,
            };
            tasks::simulate(scene, shown, &options, watch)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene() -> Scene {
        let text = "[hair]\nstrands = 40\nsegments = 18\n[motion]\nframes = 12\n[[force]]\nthrough = 12\nvector = [-50, 0, 0]\n\
                    [picture]\nsize = [64, 48]\n";
        Scene::parse(text, "small.toml".as_ref(), &[]).unwrap()
    }

    fn ended(kind: Kind, place: PathBuf, cancelled: bool) -> Ended {
        let order = Order { kind, place, frame: 5, strands: None };
        let (woken, wakes) = std::sync::mpsc::channel();
        let wake = move || woken.send(()).unwrap_or_default();
        let task = Task::begin(order, scene(), wake).unwrap();
        if cancelled {
            task.cancel();
        }
        // The sender goes when the thread has ended.
        while wakes.recv().is_ok() {}
        task.progress().ended.unwrap()
    }

    #[test]
    fn every_kind_writes_what_it_says() {
        let folder = tempfile::tempdir().unwrap();
        for kind in Kind::ALL {
            let name = kind.ending().map_or("out".to_owned(), |ending| format!("below/hair.{ending}"));
            let Ended::Wrote(files) = ended(kind, folder.path().join(name), false) else {
                panic!("{kind:?} was not written");
            };
            assert!(!files.is_empty(), "{kind:?}");
            assert!(files.iter().all(|file| file.exists()), "{kind:?}: {files:?}");
        }
    }

    #[test]
    fn what_is_stopped_leaves_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("hair.usda");
        assert_eq!(ended(Kind::Usd, file, true), Ended::Cancelled);
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    }

    #[test]
    fn what_cannot_be_written_is_said_in_one_line() {
        let folder = tempfile::tempdir().unwrap();
        let taken = folder.path().join("taken");
        std::fs::write(&taken, "").unwrap();
        let Ended::Failed(line) = ended(Kind::Cache, taken.join("hair.nabiki"), false) else {
            panic!("a file was taken for a folder");
        };
        assert!(!line.contains('\n') && line.contains("taken"), "{line}");
    }

    #[test]
    fn the_rest_takes_as_long_as_what_is_done() {
        let second = Duration::from_secs(1);
        assert_eq!(left(second, [1, 4]), Some(3 * second));
        assert_eq!(left(second, [4, 4]), Some(Duration::ZERO));
        assert_eq!(left(second, [0, 4]), None);
    }
}
