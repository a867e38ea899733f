//! What a window knows: the scene, its motion, what is chosen, played, asked and exported. It changes by commands and by
//! the time that passes.

mod deep;
mod edit;
mod files;
mod followed;
mod kept;
mod lost;
mod regions;
mod revealed;
mod taken;
mod watch;
mod words;

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use nabiki::field::Keyframe;
use nabiki_scene::told::SwingTable;
use toml::Table;

use crate::actions::Action;
use crate::command::Command;
use crate::desktop::Asked;
use crate::dialog::Dialog;
use crate::document::Document;
use crate::motion::{Manner, Motion, Moved, Stage};
use crate::play::{Ending, Play};
use crate::preferences::Preferences;
use crate::recovery::{self, Keeper};
use crate::settings::Page;
use crate::take::{TOUCHED, Take};
use crate::tasks::Task;
use crate::timeline::Clip;
use crate::tools::{Tool, Tools};
use deep::Deep;
pub use kept::Difference;
use kept::KeptTake;
pub use lost::Broken;
use revealed::Revealed;
use watch::Watch;
pub use words::Word;

/// Between two looks at the scene's file, and between two times at which what is not saved is kept.
const LOOK: Duration = Duration::from_secs(1);

/// What only the window itself can do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wish {
    /// Frame the hair in the view.
    Frame,
    /// Look through the scene's camera.
    SceneCamera,
    /// Take the view over as the scene's camera.
    UseCamera,
    /// Put the panels where they were at the first start.
    ResetLayout,
    /// Show a page.
    Page(Page),
    /// Close.
    Quit,
}

/// Why the scene as it is does not move.
#[derive(Clone, Debug, PartialEq)]
pub struct Trouble {
    /// In one line.
    pub text: String,
    /// The setting to blame, where one is.
    pub key: Option<String>,
}

/// A window's state.
#[derive(Debug)]
pub struct Session {
    document: Option<Document>,
    settings: Arc<Table>,
    broken: Option<Broken>,
    motion: Motion,
    deep: Deep,
    desktop: Option<Asked>,
    has_desktop: bool,
    take: Option<Arc<Take>>,
    kept: Option<KeptTake>,
    swings: Option<SwingTable>,
    trouble: Option<Trouble>,
    took: Duration,
    asked: u64,
    /// The first motion that was asked for of this scene.
    first_asked: u64,
    /// How large head and hair were before a head that is of another size since.
    sizes: Option<followed::Sizes>,
    /// How many scenes have been opened: what belongs to one scene goes with it.
    opened: u64,
    chosen: Vec<usize>,
    /// The same before a pull that goes on, which has its own interval chosen.
    chosen_before: Option<Vec<usize>>,
    clip: Clip,
    tools: Tools,
    /// The name of the region that is painted, and how many there were.
    painted: (String, usize),
    /// The setting that is pointed out.
    revealed: Option<Revealed>,
    dialog: Option<Dialog>,
    /// When it was asked, by the clock.
    asked_at: Option<f64>,
    tasks: Vec<Task>,
    words: Vec<Word>,
    wishes: Vec<Wish>,
    preferences: Preferences,
    folder: Option<PathBuf>,
    keeper: Option<Keeper>,
    /// Keeps the text being mended, while it is not saved.
    text_keeper: Option<Keeper>,
    clock: f64,
    /// When what is not saved was kept last.
    looked: Instant,
    /// Looks at the scene's file.
    watch: Watch,
    said_changed: bool,
    seen_version: u64,
    wake: Waker,
    /// The clock of the play.
    pub play: Play,
}

/// Calls for a new picture of the window.
#[derive(Clone)]
pub struct Waker(Arc<dyn Fn() + Send + Sync>);

impl std::fmt::Debug for Waker {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Waker")
    }
}

impl Session {
    /// A window without a scene. `folder`: where it remembers things, if anywhere. `wake` is called when there is something
    /// new to see.
    ///
    /// # Errors
    /// The system's, if it gives no thread.
    pub fn new(folder: Option<PathBuf>, wake: impl Fn() + Send + Sync + 'static) -> std::io::Result<Self> {
        let wake = Waker(Arc::new(wake));
        let [theirs, of_files] = [wake.clone(), wake.clone()];
        let motion = Motion::start(Manner::Finishes, move || theirs.0())?;
        let watch = Watch::start(LOOK, move || of_files.0())?;
        let (preferences, said) = folder.as_deref().map_or((Preferences::default(), None), Preferences::load);
        let mut session = Self {
            document: None,
            settings: Arc::default(),
            broken: None,
            motion,
            deep: Deep::default(),
            desktop: None,
            has_desktop: true,
            take: None,
            kept: None,
            swings: None,
            trouble: None,
            took: Duration::ZERO,
            asked: 0,
            first_asked: 0,
            sizes: None,
            opened: 0,
            chosen: Vec::new(),
            chosen_before: None,
            clip: Clip::default(),
            tools: Tools::default(),
            painted: Default::default(),
            revealed: None,
            dialog: None,
            asked_at: None,
            tasks: Vec::new(),
            words: Vec::new(),
            wishes: Vec::new(),
            play: Play::new(preferences.ending),
            preferences,
            keeper: None,
            text_keeper: None,
            folder,
            clock: 0.0,
            looked: Instant::now(),
            watch,
            said_changed: false,
            seen_version: 0,
            wake,
        };
        said.into_iter().for_each(|said| session.say_of_window(said, true));
        session.look_for_what_is_left();
        Ok(session)
    }

    /// Finds what windows that were killed have left, and begins to keep what this one has.
    fn look_for_what_is_left(&mut self) {
        let Some(folder) = self.folder.as_ref().map(|folder| folder.join("recovery")) else { return };
        let left = recovery::left_behind(&folder);
        if !left.is_empty() {
            self.dialog = Some(Dialog::Recover(left));
        }
        match Keeper::begin(&folder) {
            Ok(keeper) => self.keeper = Some(keeper),
            Err(e) => {
                self.say_of_window(
                    format!("{}: {e}; unsaved changes are lost if this window is killed", folder.display()),
                    true,
                );
            }
        }
    }

    /// The scene that is open.
    pub fn document(&self) -> Option<&Document> {
        self.document.as_ref()
    }

    /// All its settings by their keys.
    pub fn settings(&self) -> &Table {
        &self.settings
    }

    /// A scene's text that cannot be read.
    pub fn broken(&self) -> Option<&Broken> {
        self.broken.as_ref()
    }

    /// The last good motion.
    pub fn take(&self) -> Option<&Arc<Take>> {
        self.take.as_ref()
    }

    /// How long the swings of each interval take.
    pub fn swings(&self) -> Option<&SwingTable> {
        self.swings.as_ref()
    }

    /// The intervals of the wind by their strength, as the last good motion has it: that of a speed depends on the hair.
    pub fn strengths(&self) -> Vec<Keyframe> {
        let Some(document) = &self.document else { return Vec::new() };
        let field = &document.scene().field;
        self.take.as_ref().map_or_else(|| field.as_given(), |take| take.built.strengths_of(&field.force))
    }

    /// Why the scene as it is does not move; the last good motion is then another's.
    pub fn trouble(&self) -> Option<&Trouble> {
        self.trouble.as_ref()
    }

    /// How long the last motion took.
    pub fn took(&self) -> Duration {
        self.took
    }

    /// Whether a motion is being worked out.
    pub fn is_moving(&self) -> bool {
        let kept = self.kept.as_ref().is_some_and(KeptTake::is_working);
        self.motion.is_working() || self.deep.is_working() || kept
    }

    /// What is done for the motion of more strands than a touch moves, while it is being worked out, and how much of that, 0..1.
    pub fn progress_deep(&self) -> Option<(Stage, f32)> {
        self.deep.progress()
    }

    /// Waits until the scene has been moved as it is, with all strands that are asked for.
    pub fn wait(&mut self) {
        self.motion.wait();
        self.receive();
        if self.deep.is_due(f64::INFINITY) {
            self.deepen();
        }
        self.deep.wait();
        self.receive();
        self.kept.iter().for_each(KeptTake::wait);
        self.receive();
    }

    /// Seconds until there is something to do that nobody calls for; endless where there is not: a window at rest is not drawn.
    pub fn waits(&self) -> f64 {
        // More strands wait for the motion of the few, which calls when it is there.
        let deep = if self.motion.is_working() { f64::INFINITY } else { self.deep.waits(self.clock) };
        let keep = if self.is_kept() { f64::INFINITY } else { LOOK.as_secs_f64() };
        deep.min(keep).min(self.news_goes_in()).min(self.revealed_for())
    }

    /// How many scenes have been opened, this one included.
    pub fn opened(&self) -> u64 {
        self.opened
    }

    /// The intervals chosen, in ascending order.
    pub fn chosen(&self) -> &[usize] {
        &self.chosen
    }

    /// The tool at hand.
    pub fn tools(&self) -> &Tools {
        &self.tools
    }

    /// Whether something was copied.
    pub fn has_clip(&self) -> bool {
        !self.clip.0.is_empty()
    }

    /// The question asked.
    pub fn dialog(&self) -> Option<&Dialog> {
        self.dialog.as_ref()
    }

    /// Exports, running and ended.
    pub fn tasks(&self) -> &[Task] {
        &self.tasks
    }

    /// What is remembered.
    pub fn preferences(&self) -> &Preferences {
        &self.preferences
    }

    /// The folder in which it is.
    pub fn folder(&self) -> Option<&Path> {
        self.folder.as_deref()
    }

    /// Seconds since the window came up.
    pub fn clock(&self) -> f64 {
        self.clock
    }

    /// What only the window can do, once.
    pub fn wishes(&mut self) -> Vec<Wish> {
        std::mem::take(&mut self.wishes)
    }

    /// Lets so many seconds pass, and takes what has come of what was asked for. `played`: those that a play goes on by; it
    /// does not leap over what a window has rested for.
    pub fn tick(&mut self, passed: f64, played: f64) {
        self.clock += passed;
        self.see_revealed();
        if let Some(document) = &self.document {
            self.play.advance(played, document.scene().frame_rate());
        }
        self.receive();
        self.hear_desktop();
        if self.deep.is_due(self.clock) && !self.motion.is_working() {
            self.deepen();
        }
        self.forget_good_news();
        let open = self.document.as_ref().and_then(Document::path);
        let files = open.into_iter().chain(self.broken.as_ref().map(|broken| broken.path.as_path()));
        self.watch.of(files.map(Path::to_owned).collect());
        if self.watch.has_changed() {
            self.look_at_file();
        }
        if self.looked.elapsed() >= LOOK {
            self.looked = Instant::now();
            self.keep();
        }
    }

    fn receive(&mut self) {
        if let Some(moved) = self.motion.take() {
            self.receive_touched(moved);
        }
        if let Some(moved) = self.deep.take() {
            self.receive_deep(moved);
        }
        if let Some(moved) = self.kept.as_ref().and_then(KeptTake::moved) {
            self.receive_kept(moved);
        }
        self.match_strands();
    }

    fn receive_touched(&mut self, Moved { number, result, took }: Moved) {
        if number < self.first_asked {
            return;
        }
        match result {
            Ok((take, swings)) => {
                self.play.set_last(take.frames());
                self.say_what_followed(&take);
                (self.take, self.swings, self.took) = (Some(take), Some(swings), took);
                if number == self.asked {
                    self.trouble = None;
                }
            }
            Err(error) if number == self.asked => {
                let key = match &error {
                    nabiki_scene::Error::Scene(refused) => Some(refused.key.to_string()).filter(|key| !key.is_empty()),
                    _ => None,
                };
                self.trouble = Some(Trouble { text: error.to_string(), key });
            }
            Err(_) => {}
        }
    }

    /// Asks for the motion of the scene as it is.
    fn move_again(&mut self, fresh: bool) {
        let Some(document) = &self.document else { return };
        self.seen_version = document.version();
        match document.scene().settings() {
            Ok(settings) => self.settings = Arc::new(settings),
            Err(e) => self.trouble = Some(Trouble { text: e.to_string(), key: None }),
        }
        self.play.set_last(document.scene().motion.frames);
        if !document.is_dragging() {
            // Only a hand that drags wants to see what it has left behind.
            self.motion.stop();
        }
        self.asked = self.motion.ask(document.scene().clone(), self.preferences.strands.min(TOUCHED), fresh);
        self.choose_what_is_there();
        self.wait_to_deepen(fresh);
    }

    /// Does what is asked for.
    pub fn apply(&mut self, command: Command) {
        match command {
            Command::Act(action) => self.act(action),
            Command::Go(frame) => {
                self.play.set_playing(false);
                self.play.go(frame);
            }
            Command::Speed(speed) => self.play.speed = speed,
            Command::End(ending) => self.set_ending(ending),
            Command::Strands(strands) => self.show_strands(strands),
            Command::Choose(chosen) => self.chosen = chosen,
            Command::Use(tools) => self.tools = *tools,
            Command::Show(dialog) => self.dialog = Some(*dialog),
            Command::CloseDialog => self.close_dialog(),
            Command::AskDesktop => self.ask_desktop(),
            Command::Chosen(chooser, path) => self.chosen_file(*chooser, path),
            Command::Cancel(task) => self.tasks.get(task).into_iter().for_each(Task::cancel),
            Command::Dismiss(task) if task < self.tasks.len() => drop(self.tasks.remove(task)),
            Command::Heard(word) if word < self.words.len() => drop(self.words.remove(word)),
            Command::Refuse { about, why } => self.refuse(&about, why),
            Command::Took(about) => self.accept(&about),
            Command::Dismiss(_) | Command::Heard(_) => {}
            Command::Prefer(preferences) => {
                let strands = preferences.strands;
                let before = std::mem::replace(&mut self.preferences, *preferences).strands;
                if strands != before {
                    self.preferences.strands = before;
                    self.show_strands(strands);
                }
            }
            Command::Reveal(key) => self.reveal(&key),
            Command::Export(order) => self.export(order),
            command => self.apply_to_document(command),
        }
        if self.broken.is_none() {
            self.accept(edit::BEHIND_TEXT);
        }
        self.note_question();
        self.move_if_changed();
        // Panels speak of the intervals as they were when they were drawn; a key may have taken some since.
        self.choose_what_is_there();
    }

    fn choose_what_is_there(&mut self) {
        let intervals = self.document.as_ref().map_or(0, |document| document.scene().field.force.len());
        self.chosen.retain(|&j| j < intervals);
        self.follow_region();
    }

    fn move_if_changed(&mut self) {
        if self.document.as_ref().is_some_and(|document| document.version() != self.seen_version) {
            self.see_scene();
            self.move_again(false);
        }
    }

    fn set_ending(&mut self, ending: Ending) {
        self.play.ending = ending;
        self.preferences.ending = ending;
    }

    fn close_dialog(&mut self) {
        if self.dialog == Some(Dialog::Welcome) {
            self.preferences.welcomed = true;
        }
        (self.dialog, self.desktop) = (None, None);
    }

    fn export(&mut self, order: crate::tasks::Order) {
        let Some(document) = &self.document else { return };
        self.dialog = None;
        let wake = self.wake.clone();
        match Task::begin(order, document.scene().clone(), move || wake.0()) {
            Ok(task) => self.tasks.push(task),
            Err(e) => self.say(format!("the export cannot start: {e}"), true),
        }
    }

    /// The window has closed: what it remembers is written, and what it kept in case it would be killed goes, before threads are
    /// waited for.
    pub fn end(&mut self) {
        self.remember();
        (self.keeper, self.text_keeper) = (None, None);
    }

    /// Remembers the preferences. What goes wrong is said, and matters to nobody else.
    pub fn remember(&mut self) {
        let Some(folder) = &self.folder else { return };
        if let Err(e) = self.preferences.save(folder) {
            self.say_of_window(format!("{}: {e}; preferences are not saved", folder.display()), true);
        }
    }

    fn act(&mut self, action: Action) {
        if edit::CHANGES.contains(&action) && self.is_behind_text() {
            return;
        }
        match action {
            Action::Play => self.play.set_playing(!self.play.is_playing()),
            Action::Forward => self.play.step(1),
            Action::Back => self.play.step(-1),
            Action::First => self.apply(Command::Go(0)),
            Action::Last => self.apply(Command::Go(self.play.last())),
            Action::Ending => self.set_ending(match self.play.ending {
                Ending::Loop => Ending::Stop,
                Ending::Stop => Ending::Swing,
                Ending::Swing => Ending::Loop,
            }),
            Action::Frame => self.wishes.push(Wish::Frame),
            Action::SceneCamera => self.wishes.push(Wish::SceneCamera),
            Action::UseCamera => self.wishes.push(Wish::UseCamera),
            Action::ResetLayout => self.wishes.push(Wish::ResetLayout),
            Action::Ghosts => self.preferences.ghosts = !self.preferences.ghosts,
            Action::Arrows => self.preferences.arrows = !self.preferences.arrows,
            Action::FinalPicture => self.preferences.final_picture = !self.preferences.final_picture,
            Action::Pull => self.tools.tool = Tool::Pull,
            Action::Paint => self.tools.toggle(Tool::Paint),
            Action::Comb => self.tools.toggle(Tool::Comb),
            Action::Fewer | Action::More if self.tools.tool != Tool::Pull => self.tools.resize(action == Action::More),
            Action::Fewer => self.step_strands(false),
            Action::More => self.step_strands(true),
            Action::ZoomIn => self.preferences.zoom = (self.preferences.zoom * 1.1).min(4.0),
            Action::ZoomOut => self.preferences.zoom = (self.preferences.zoom / 1.1).max(0.5),
            Action::Keep | Action::Compare | Action::Exchange => self.act_on_kept(action),
            Action::Palette => self.dialog = Some(Dialog::Palette { query: String::new(), line: 0 }),
            Action::Keys => self.dialog = Some(Dialog::Keys),
            Action::Welcome => self.dialog = Some(Dialog::Welcome),
            Action::Preferences => self.dialog = Some(Dialog::Preferences),
            Action::Open | Action::Save | Action::SaveAs | Action::Reload | Action::Export | Action::Quit => {
                self.act_on_files(action);
            }
            action => self.act_on_intervals(action),
        }
    }
}

#[cfg(test)]
#[path = "session_tests.rs"]
mod tests;
#[cfg(test)]
#[path = "session/ways_tests.rs"]
mod ways_tests;
