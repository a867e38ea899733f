//! Folders that one program writes its results into, and others only where that does no harm.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::sleep;
use std::time::Duration;

use crate::is_at;

/// The file by which a folder is held: the system frees it when a program ends, however that comes.
const NAME: &str = ".nabiki-lock";

/// How often, and how far apart, it is tried to hold a folder: whoever lets go of one has it for himself for an instant.
const TRIES: u32 = 5;
const PAUSE: Duration = Duration::from_millis(20);

/// The lock files that this program holds.
static HELD: Mutex<Vec<Arc<LockFile>>> = Mutex::new(Vec::new());

fn held() -> MutexGuard<'static, Vec<Arc<LockFile>>> {
    HELD.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Who may write into a folder beside its holder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hold {
    /// Nobody.
    Alone,
    /// Others that hold it in this way.
    BesideOthers,
}

/// A folder that is held for as long as this lives.
#[derive(Debug)]
pub struct HeldFolder(Option<Arc<LockFile>>);

#[derive(Debug)]
struct LockFile {
    file: File,
    path: PathBuf,
}

impl HeldFolder {
    /// Holds `folder`, which is there; `None` where another holder, in this program or another, does not allow it. Where a file
    /// system has no locks, or takes no file, all are allowed.
    ///
    /// # Errors
    /// What stands in the place of the lock file is no file: its path.
    pub fn hold(folder: &Path, hold: Hold) -> Result<Option<Self>, PathBuf> {
        let path = folder.join(NAME);
        for turn in 0..TRIES {
            if turn > 0 {
                sleep(PAUSE);
            }
            let file = match open(&path) {
                Ok(file) => file,
                Err(e) if e.kind() == io::ErrorKind::AlreadyExists => return Err(path),
                Err(_) => return Ok(Some(Self(None))),
            };
            let locked = match hold {
                Hold::Alone => file.try_lock(),
                Hold::BesideOthers => file.try_lock_shared(),
            };
            match locked {
                // Who held it before may have taken the file away since it was opened.
                Ok(()) if is_at(&file, &path) => {
                    let file = Arc::new(LockFile { file, path });
                    held().push(file.clone());
                    return Ok(Some(Self(Some(file))));
                }
                Ok(()) | Err(TryLockError::WouldBlock) => {}
                Err(TryLockError::Error(_)) => {
                    let _ = fs::remove_file(&path);
                    return Ok(Some(Self(None)));
                }
            }
        }
        Ok(None)
    }
}

impl Drop for HeldFolder {
    fn drop(&mut self) {
        let Some(file) = self.0.take() else { return };
        let mut held = held();
        // It is not there when all were let go of at once.
        if let Some(at) = held.iter().position(|held| Arc::ptr_eq(held, &file)) {
            held.swap_remove(at).let_go();
        }
    }
}

impl LockFile {
    /// Takes the file away, unless others hold the folder.
    fn let_go(&self) {
        if self.file.unlock().is_ok() && self.file.try_lock().is_ok() {
            let _ = fs::remove_file(&self.path);
        }
    }
}

/// Lets go of every folder that this program holds.
pub(super) fn let_go_of_all() {
    held().drain(..).for_each(|file| file.let_go());
}

/// The lock file, made if it is not there. One that another user has left can only be read, which is enough for most locks.
fn open(path: &Path) -> io::Result<File> {
    // A link would be followed to a file that is none of ours, be it to make it; a pipe would be waited for.
    if fs::symlink_metadata(path).is_ok_and(|there| !there.is_file()) {
        return Err(io::Error::from(io::ErrorKind::AlreadyExists));
    }
    let there = OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path);
    there.or_else(|_| File::open(path))
}
