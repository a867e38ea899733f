//! Result files that appear under their own name only when whole.
//!
//! A [`PartFile`] grows beside its final place, under a hidden name, and takes its own name when it is finished. Dropped
//! unfinished, it is removed; [`remove_unfinished`] removes all that a program has open, for a handler of signals. What a
//! killed program left behind is removed by the next one that writes to the same place: the part files of programs that
//! run are locked. A [`HeldFolder`] is one that others do not write into meanwhile.
//!
//! ```
//! use std::io::Write;
//!
//! use nabiki_file::PartFile;
//!
//! fn main() -> std::io::Result<()> {
//!     let path = std::env::temp_dir().join(format!("nabiki_file_{}.txt", std::process::id()));
//!     let mut file = PartFile::create(&path)?;
//!     file.write_all(b"whole or not at all")?;
//!     assert!(!path.exists());
//!     file.finish()?;
//!     assert_eq!(std::fs::read(&path)?, b"whole or not at all");
//!     std::fs::remove_file(&path)
//! }
//! ```

#![forbid(unsafe_code)]

#[cfg(unix)]
mod access;
mod hold;

use std::fs::{self, File, TryLockError};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::io::{self, BufWriter, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use tempfile::TempPath;

pub use hold::{HeldFolder, Hold};

/// How the name of every part file begins.
const MARK: &str = ".nabiki-part-";

/// How often a part file is begun anew that another program took for a stale one.
const TRIES: u32 = 100;

/// How often a finished file is given its name again, and how long after the try before.
const PATIENCE: u32 = 15;
const PAUSE: std::time::Duration = std::time::Duration::from_millis(100);

/// Bytes gathered before they are written.
const BUFFER: usize = 1 << 20;

/// The part files that this program has open.
static OPEN: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

fn open_parts() -> MutexGuard<'static, Vec<PathBuf>> {
    OPEN.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A file being written beside its final name; dropped unfinished, it leaves nothing.
#[derive(Debug)]
pub struct PartFile {
    file: BufWriter<File>,
    part: Part,
    target: PathBuf,
}

/// The name of a part file, listed among those open for as long as it lives.
#[derive(Debug)]
struct Part(Option<TempPath>);

impl Drop for Part {
    fn drop(&mut self) {
        let Some(path) = self.0.take() else { return };
        open_parts().retain(|open| *open != *path);
    }
}

impl Part {
    fn path(&self) -> &Path {
        self.0.as_deref().unwrap_or(Path::new(""))
    }
}

impl PartFile {
    /// Starts the file that will be `target`. A `target` that is a link stays one: what it leads to is replaced. Whoever
    /// may read other new files may read this one (the umask holds); a file that is replaced keeps its permissions, and its
    /// owner and group where the system lets it.
    ///
    /// # Errors
    /// What the disk says.
    pub fn create(target: &Path) -> io::Result<Self> {
        let target = behind_links(target)?;
        let folder = folder_of(&target);
        remove_stale(folder, &target);
        for _ in 0..TRIES {
            let (file, part) = new_part(folder, &target)?;
            // Whoever looks for stale parts holds a file for an instant, and removes what it could hold.
            match file.try_lock() {
                Ok(()) if is_at(&file, part.path()) => {}
                Ok(()) | Err(TryLockError::WouldBlock) => continue,
                // Where a file system has no locks, nobody removes the part, and that of a killed program stays.
                Err(TryLockError::Error(_)) => {}
            }
            #[cfg(unix)]
            access::keep(&file, &target);
            return Ok(Self { file: BufWriter::with_capacity(BUFFER, file), part, target });
        }
        Err(io::Error::other("other programs remove the new file again and again"))
    }

    /// Puts the content under its final name.
    ///
    /// # Errors
    /// What the disk says; the file that was there before is then as it was.
    pub fn finish(mut self) -> io::Result<()> {
        self.file.flush()?;
        // A name that reaches the disk before its content would stand for an empty file after a power cut.
        on_disk(self.file.get_ref())?;
        let path = self.part.0.take().ok_or_else(|| io::Error::other("the file is finished already"))?;
        open_parts().retain(|open| *open != *path);
        persist(path, &self.target)?;
        // The file is whole under its name by now: a folder that cannot be synchronised does not change that.
        #[cfg(unix)]
        let _ = File::open(folder_of(&self.target)).and_then(|folder| folder.sync_all());
        Ok(())
    }
}

/// Gives a finished file its name. On Windows another program may have the file open that is there, for an instant or for long: then
/// the finished file stays beside it.
fn persist(part: TempPath, target: &Path) -> io::Result<()> {
    let mut refused = match part.persist(target) {
        Ok(()) => return Ok(()),
        Err(refused) => refused,
    };
    if cfg!(windows) && refused.error.kind() == io::ErrorKind::PermissionDenied {
        for _ in 0..PATIENCE {
            std::thread::sleep(PAUSE);
            match refused.path.persist(target) {
                Ok(()) => return Ok(()),
                Err(again) => refused = again,
            }
        }
        let mut beside = target.as_os_str().to_owned();
        beside.push(".new");
        if let Ok(()) = refused.path.persist(&beside) {
            let line = format!("{}: another program has it open; the result is {}", refused.error, beside.display());
            return Err(io::Error::new(io::ErrorKind::PermissionDenied, line));
        }
    }
    Err(refused.error)
}

impl Write for PartFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn write_all(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.file.write_all(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl Read for PartFile {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        self.file.flush()?;
        self.file.get_mut().read(bytes)
    }
}

impl Seek for PartFile {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.file.seek(to)
    }
}

/// Writes a whole file. Until it is complete, the file that was there stays.
///
/// # Errors
/// What the disk says.
pub fn write(target: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = PartFile::create(target)?;
    file.write_all(bytes)?;
    file.finish()
}

/// Removes every part file that this program has open, and lets go of the folders that it holds: the last act of a program
/// that is told to end.
pub fn remove_unfinished() {
    for part in open_parts().drain(..) {
        let _ = fs::remove_file(part);
    }
    hold::let_go_of_all();
}

/// Bytes that a file in `folder` may grow to before the disk is full.
///
/// # Errors
/// What the disk says; a system without disks.
pub fn available_bytes(folder: &Path) -> io::Result<u64> {
    #[cfg(any(unix, windows))]
    return fs4::available_space(folder);
    #[cfg(not(any(unix, windows)))]
    return Err(io::Error::new(io::ErrorKind::Unsupported, folder.display().to_string()));
}

/// The folder that a file is in; `.` for a bare name.
pub fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// What `path` leads to, where it is a link; a link that leads nowhere names the file to be made.
///
/// # Errors
/// Links that lead in a circle.
pub fn behind_links(path: &Path) -> io::Result<PathBuf> {
    // As many as Linux follows.
    const MOST_LINKS: usize = 40;
    let mut path = path.to_owned();
    for _ in 0..MOST_LINKS {
        match fs::read_link(&path) {
            Ok(to) => path = folder_of(&path).join(to),
            Err(_) => return Ok(path),
        }
    }
    Err(io::Error::other("too many links in a row"))
}

/// How the names of all part files of `target` begin. Its own name may be as long as names can be, so it is not in it.
fn prefix_of(target: &Path) -> String {
    let mut hasher = DefaultHasher::new();
    target.file_name().hash(&mut hasher);
    format!("{MARK}{:016x}-", hasher.finish())
}

/// Removes the part files of `target` that no running program holds.
fn remove_stale(folder: &Path, target: &Path) {
    let prefix = prefix_of(target);
    let Ok(entries) = fs::read_dir(folder) else { return };
    for entry in entries.flatten() {
        if !entry.file_name().as_encoded_bytes().starts_with(prefix.as_bytes()) {
            continue;
        }
        let path = entry.path();
        // A pipe of such a name would be waited for, and is none of ours.
        if open_parts().contains(&path) || !entry.file_type().is_ok_and(|kind| kind.is_file()) {
            continue;
        }
        remove_unheld(&path);
    }
}

/// Removes a part file unless a running program holds it.
fn remove_unheld(path: &Path) {
    let Ok(file) = File::open(path) else { return };
    // The lock lasts until the file is gone: let go of before, its writer could take it, and would lose the file afterwards.
    if file.try_lock().is_ok() {
        let _ = fs::remove_file(path);
    }
}

/// A new, empty part file of `target`, listed among those that are open.
fn new_part(folder: &Path, target: &Path) -> io::Result<(File, Part)> {
    let mut options = File::options();
    options.read(true).write(true).create_new(true);
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::mode(&mut options, access::at_first(target));
    let mut builder = tempfile::Builder::new();
    let prefix = prefix_of(target);
    builder.prefix(&prefix);
    // The list is held while the file is made, so that a signal in between finds it.
    let mut open = open_parts();
    // Made by hand: the crate's own way keeps of an error neither its number nor its words.
    let (file, path) = builder.make_in(folder, |path| options.open(path)).map_err(without_path)?.into_parts();
    open.push(path.to_path_buf());
    Ok((file, Part(Some(path))))
}

/// Brings what has been written onto the disk, as far as its file system can.
fn on_disk(file: &File) -> io::Result<()> {
    match file.sync_all() {
        Err(e) if matches!(e.kind(), io::ErrorKind::InvalidInput | io::ErrorKind::Unsupported) => Ok(()),
        done => done,
    }
}

/// Whether `file` is the one of that name. What a link leads to is not.
fn is_at(file: &File, path: &Path) -> bool {
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt;
        let place = |about: &fs::Metadata| (about.dev(), about.ino());
        matches!((file.metadata(), fs::symlink_metadata(path)), (Ok(a), Ok(b)) if place(&a) == place(&b))
    }
    #[cfg(not(unix))]
    {
        let _ = file;
        path.exists()
    }
}

/// The crate tempfile adds the name of the part file, which is gone by the time anyone reads this.
fn without_path(error: io::Error) -> io::Error {
    match error.raw_os_error() {
        Some(code) => io::Error::from_raw_os_error(code),
        None => io::Error::new(error.kind(), error.kind().to_string()),
    }
}

#[cfg(test)]
mod tests;
