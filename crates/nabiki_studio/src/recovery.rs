//! What is not saved yet, kept beside the preferences, and found again after a window was killed.
//!
//! Each window holds a lock for as long as it lives. What lies beside a lock that nobody holds belongs to a window that is
//! gone.

use std::fs::{self, File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

use serde::{Deserialize, Serialize};

use crate::document::Document;

/// Where this window keeps what is not saved.
#[derive(Debug)]
pub struct Keeper {
    file: PathBuf,
    lock: PathBuf,
    /// Held as long as the window lives.
    _held: File,
    /// The version of the document that is kept.
    kept: Option<u64>,
    /// The text that is kept.
    text: Option<String>,
}

/// A scene that was not saved.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Kept {
    /// The scene's file, or the name that it had without one.
    pub path: PathBuf,
    /// Whether it had a file.
    pub has_file: bool,
    /// When it was kept (seconds since 1970).
    pub seconds: u64,
    /// The scene.
    pub text: String,
    /// Where it is kept.
    #[serde(skip)]
    place: PathBuf,
}

impl Keeper {
    /// A place of this window's own in `folder`, which is made if it is not there.
    ///
    /// # Errors
    /// What the disk says.
    pub fn begin(folder: &Path) -> io::Result<Self> {
        fs::create_dir_all(folder)?;
        sweep(folder);
        let process = std::process::id();
        for n in 0.. {
            let lock = folder.join(format!("{process}-{n}.lock"));
            let held = File::options().create(true).append(true).open(&lock)?;
            match held.try_lock() {
                // A window that has just begun, too, has swept it away as nobody's.
                Ok(()) if !lock.exists() => {}
                Ok(()) => {
                    let file = lock.with_extension("toml");
                    // A process of the same number may have left something that nobody has asked for yet. No keeper is made for
                    // it, which would take it away when it goes.
                    if !file.exists() {
                        return Ok(Self { file, lock, _held: held, kept: None, text: None });
                    }
                }
                Err(TryLockError::WouldBlock) => {}
                Err(TryLockError::Error(e)) => return Err(e),
            }
        }
        Err(io::Error::other("no name is free"))
    }

    /// Keeps the document as it is, if it is not saved and not kept yet.
    ///
    /// # Errors
    /// What the disk says; what was kept before is then still there.
    pub fn keep(&mut self, document: &Document) -> io::Result<()> {
        if self.kept == Some(document.version()) {
            return Ok(());
        }
        if document.is_dirty() {
            let scene = document.scene();
            self.write(scene.file(), document.path().is_some(), scene.to_toml().map_err(io::Error::other)?)?;
        } else {
            self.forget();
        }
        self.kept = Some(document.version());
        Ok(())
    }

    /// Whether the document is kept as it is, or has been seen to need no keeping.
    pub fn has(&self, document: &Document) -> bool {
        self.kept == Some(document.version())
    }

    /// The text that is kept.
    pub fn text(&self) -> Option<&str> {
        self.text.as_deref()
    }

    /// Keeps a text that is no scene yet, if it is not kept yet.
    ///
    /// # Errors
    /// As there.
    pub fn keep_text(&mut self, path: &Path, text: &str) -> io::Result<()> {
        if self.text.as_deref() != Some(text) {
            self.write(path, true, text.to_owned())?;
            self.text = Some(text.to_owned());
        }
        Ok(())
    }

    fn write(&self, path: &Path, has_file: bool, text: String) -> io::Result<()> {
        let seconds = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |passed| passed.as_secs());
        let kept = Kept { path: std::path::absolute(path)?, has_file, seconds, text, place: PathBuf::new() };
        let text = toml::to_string(&kept).map_err(io::Error::other)?;
        nabiki_file::write(&self.file, text.as_bytes())
    }

    /// Nothing is kept any more: it is saved, or to be lost.
    pub fn forget(&mut self) {
        self.kept = None;
        // It may never have been there.
        let _ = fs::remove_file(&self.file);
    }
}

impl Drop for Keeper {
    /// A window that closes has asked before what to do with what is not saved; one that panics has not.
    fn drop(&mut self) {
        if std::thread::panicking() {
            return;
        }
        self.forget();
        let _ = fs::remove_file(&self.lock);
    }
}

/// Takes away the locks of windows that were killed and had nothing to keep.
fn sweep(folder: &Path) {
    for lock in fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path()) {
        if lock.extension().is_some_and(|ending| ending == "lock")
            && !lock.with_extension("toml").exists()
            && let Ok(held) = File::open(&lock)
            && held.try_lock().is_ok()
        {
            let _ = fs::remove_file(&lock);
        }
    }
}

/// What windows that are gone have left in `folder`, the newest first.
pub fn left_behind(folder: &Path) -> Vec<Kept> {
    let mut left: Vec<Kept> =
        fs::read_dir(folder).into_iter().flatten().flatten().filter_map(|entry| look(&entry.path())).collect();
    left.sort_by_key(|kept| std::cmp::Reverse(kept.seconds));
    left
}

fn look(place: &Path) -> Option<Kept> {
    if place.extension()? != "toml" {
        return None;
    }
    // Without a lock the window that wrote it has been killed and its lock swept away: it is left behind, too.
    if let Ok(lock) = File::open(place.with_extension("lock"))
        && lock.try_lock().is_err()
    {
        return None;
    }
    let kept: Kept = toml::from_str(&fs::read_to_string(place).ok()?).ok()?;
    Some(Kept { place: place.to_owned(), ..kept })
}

impl Kept {
    /// Takes it away, once it has been opened or is not wanted.
    pub fn remove(&self) {
        let _ = fs::remove_file(&self.place);
        let _ = fs::remove_file(self.place.with_extension("lock"));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::Phase;
    use nabiki_scene::Scene;

    fn edited() -> Document {
        let scene = Scene::parse("[[force]]\nthrough = 50\nvector = [1, 2, 3]\n", "wind.toml".as_ref(), &[]).unwrap();
        let mut document = Document::untitled(scene.clone());
        let mut scene = scene;
        scene.field.force[0].through = 60;
        document.edit("Move a border", scene, Phase::Done);
        document
    }

    #[test]
    fn what_a_dead_window_has_not_saved_is_found() {
        let folder = tempfile::tempdir().unwrap();
        let mut keeper = Keeper::begin(folder.path()).unwrap();
        let mut document = edited();
        keeper.keep(&document).unwrap();
        assert_eq!(left_behind(folder.path()), [], "the window lives");
        // As when it is killed: nothing of it is run, and the system lets go of its lock.
        let held = keeper._held.try_clone().unwrap();
        held.unlock().unwrap();
        std::mem::forget(keeper);
        let left = left_behind(folder.path());
        assert_eq!(left.len(), 1);
        assert!(left[0].text.contains("through = 60"));
        assert!(!left[0].has_file);
        assert!(left[0].path.is_absolute(), "the next window may begin in another folder");
        let scene = Scene::parse(&left[0].text, &left[0].path, &[]).unwrap();
        assert_eq!(scene, *document.scene());
        left[0].remove();
        assert_eq!(left_behind(folder.path()), []);
        document.undo();
    }

    #[test]
    fn what_a_window_that_panics_has_not_saved_is_found() {
        let folder = tempfile::tempdir().unwrap();
        let place = folder.path().to_owned();
        let window = std::thread::spawn(move || {
            let mut keeper = Keeper::begin(&place).unwrap();
            keeper.keep(&edited()).unwrap();
            panic!("as a fault of the window's would");
        });
        assert!(window.join().is_err());
        assert_eq!(left_behind(folder.path()).len(), 1, "nobody was asked");
    }

    #[test]
    fn what_is_saved_or_closed_is_not_kept() {
        let folder = tempfile::tempdir().unwrap();
        let mut keeper = Keeper::begin(folder.path()).unwrap();
        let mut document = edited();
        keeper.keep(&document).unwrap();
        assert!(keeper.file.exists());
        document.save_as(&folder.path().join("saved.scene")).unwrap();
        keeper.keep(&document).unwrap();
        assert!(!keeper.file.exists());
        drop(keeper);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "only what was saved");
    }

    #[test]
    fn what_a_process_of_the_same_number_has_left_stays_until_it_is_asked_for() {
        let folder = tempfile::tempdir().unwrap();
        let mut dead = Keeper::begin(folder.path()).unwrap();
        dead.keep(&edited()).unwrap();
        dead._held.unlock().unwrap();
        std::mem::forget(dead);
        let alive = Keeper::begin(folder.path()).unwrap();
        assert_eq!(left_behind(folder.path()).len(), 1);
        drop(alive);
        assert_eq!(left_behind(folder.path()).len(), 1);
    }

    #[test]
    fn locks_that_nobody_holds_are_swept_away_and_no_others() {
        let folder = tempfile::tempdir().unwrap();
        let alive = Keeper::begin(folder.path()).unwrap();
        fs::write(folder.path().join("7-0.lock"), "").unwrap();
        fs::write(folder.path().join("8-0.lock"), "").unwrap();
        fs::write(folder.path().join("8-0.toml"), "").unwrap();
        let other = Keeper::begin(folder.path()).unwrap();
        assert!(alive.lock.exists() && other.lock.exists() && folder.path().join("8-0.lock").exists());
        assert!(!folder.path().join("7-0.lock").exists());
    }

    #[test]
    fn what_was_kept_last_is_offered_first() {
        let folder = tempfile::tempdir().unwrap();
        for (name, seconds) in [("1-0.toml", 20), ("2-0.toml", 30), ("3-0.toml", 10)] {
            let text = format!("path = \"/a.toml\"\nhas_file = true\nseconds = {seconds}\ntext = \"\"\n");
            fs::write(folder.path().join(name), text).unwrap();
        }
        let seconds: Vec<u64> = left_behind(folder.path()).iter().map(|kept| kept.seconds).collect();
        assert_eq!(seconds, [30, 20, 10]);
    }

    #[test]
    fn two_windows_of_one_process_keep_apart_and_rubbish_is_passed_over() {
        let folder = tempfile::tempdir().unwrap();
        let (a, b) = (Keeper::begin(folder.path()).unwrap(), Keeper::begin(folder.path()).unwrap());
        assert_ne!(a.file, b.file);
        fs::write(folder.path().join("9-9.toml"), "not what is meant").unwrap();
        assert_eq!(left_behind(folder.path()), []);
    }
}
