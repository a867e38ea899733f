//! Looks at files now and then on a thread of its own, so that a window at rest need not be drawn to find that another program has
//! written one.

use std::path::PathBuf;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, SystemTime};

/// What tells one state of a file from another: when it was written, how long it is, and which file has its name; none where
/// there is none.
type Stamp = Option<(Option<SystemTime>, u64, [u64; 3])>;

#[derive(Debug, Default)]
struct State {
    files: Vec<PathBuf>,
    /// As they were at the last look; empty before the first.
    stamps: Vec<Stamp>,
    changed: bool,
    quit: bool,
}

#[derive(Debug, Default)]
struct Shared {
    state: Mutex<State>,
    asked: Condvar,
}

impl Shared {
    /// Nothing is done under the lock that could fail half way.
    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The looks. They end with it.
#[derive(Debug)]
pub(super) struct Watch {
    shared: Arc<Shared>,
}

impl Watch {
    /// Looks every so often, and calls `wake` when a file is other than at the last look.
    ///
    /// # Errors
    /// The system's, if it gives no thread.
    pub fn start(every: Duration, wake: impl Fn() + Send + 'static) -> std::io::Result<Self> {
        let shared = Arc::new(Shared::default());
        let theirs = shared.clone();
        std::thread::Builder::new().name("files".to_owned()).spawn(move || look(&theirs, every, &wake))?;
        Ok(Self { shared })
    }

    /// Looks at these files from now on. Whoever has read one has to look once more: it may have changed since.
    pub fn of(&self, files: Vec<PathBuf>) {
        let mut state = self.shared.lock();
        if state.files != files {
            (state.files, state.stamps, state.changed) = (files, Vec::new(), true);
            self.shared.asked.notify_all();
        }
    }

    /// Whether a file may have changed since this was asked last.
    pub fn has_changed(&self) -> bool {
        std::mem::take(&mut self.shared.lock().changed)
    }
}

impl Drop for Watch {
    fn drop(&mut self) {
        self.shared.lock().quit = true;
        self.shared.asked.notify_all();
    }
}

fn look(shared: &Shared, every: Duration, wake: &dyn Fn()) {
    let mut state = shared.lock();
    while !state.quit {
        if state.files.is_empty() {
            // There is nothing to look at.
            state = shared.asked.wait(state).unwrap_or_else(PoisonError::into_inner);
            continue;
        }
        let files = state.files.clone();
        drop(state);
        let stamps: Vec<Stamp> = files.iter().map(|file| std::fs::metadata(file).ok().map(|m| stamp(&m))).collect();
        state = shared.lock();
        if state.files == files {
            let is_other = !state.stamps.is_empty() && state.stamps != stamps;
            (state.stamps, state.changed) = (stamps, state.changed || is_other);
            if is_other {
                drop(state);
                wake();
                state = shared.lock();
            }
            let waited = shared.asked.wait_timeout(state, every);
            state = waited.unwrap_or_else(PoisonError::into_inner).0;
        }
    }
}

fn stamp(metadata: &std::fs::Metadata) -> (Option<SystemTime>, u64, [u64; 3]) {
    #[cfg(unix)]
    let other = {
        use std::os::unix::fs::MetadataExt;
        // A program may set the time of writing back, but not this one.
        [metadata.ino(), metadata.ctime() as u64, metadata.ctime_nsec() as u64]
    };
    #[cfg(not(unix))]
    let other = [0; 3];
    (metadata.modified().ok(), metadata.len(), other)
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc::{Receiver, channel};

    use super::*;

    fn comes(woken: &Receiver<()>) -> bool {
        woken.recv_timeout(Duration::from_secs(20)).is_ok()
    }

    #[test]
    fn a_file_that_another_program_writes_takes_away_or_brings_back_calls_once_each() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a.toml");
        std::fs::write(&file, "a = 1").unwrap();
        let (wake, woken) = channel();
        let watch = Watch::start(Duration::from_millis(5), move || wake.send(()).unwrap_or_default()).unwrap();
        watch.of(vec![file.clone()]);
        assert!(watch.has_changed() && !watch.has_changed(), "whoever has read it looks once more");
        watch.of(vec![file.clone()]);
        assert!(!watch.has_changed(), "it is the same file");
        while watch.shared.lock().stamps.is_empty() {
            std::thread::yield_now();
        }
        std::fs::write(&file, "a = 1234").unwrap();
        assert!(comes(&woken) && watch.has_changed());
        std::fs::remove_file(&file).unwrap();
        assert!(comes(&woken) && watch.has_changed());
        std::fs::write(&file, "a = 1234").unwrap();
        assert!(comes(&woken));
    }
}
