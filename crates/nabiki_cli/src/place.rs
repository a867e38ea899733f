//! Where results will stand: what cannot be written is refused before there is anything to write.

use std::fs;
use std::path::{Path, PathBuf};

use nabiki_io::Error;

use crate::failure::Failure;

/// Folders made for results. Those that are still empty in the end, because something was refused, are taken away again.
#[derive(Default)]
pub struct Folders {
    made: Vec<PathBuf>,
}

impl Folders {
    /// Makes the folder `path`, and those that it lies in, and tries whether files can be written there.
    ///
    /// `way_out` ends the line of a refusal.
    pub fn make(&mut self, path: &Path, way_out: &str) -> Result<(), Failure> {
        let missing: Vec<&Path> =
            path.ancestors().take_while(|p| !p.as_os_str().is_empty() && fs::symlink_metadata(p).is_err()).collect();
        for folder in missing.into_iter().rev() {
            match fs::create_dir(folder) {
                Ok(()) => self.made.push(folder.to_owned()),
                // Another command was faster.
                Err(_) if folder.is_dir() => {}
                Err(e) => return Err(refused(path, "cannot make this folder", e, way_out)),
            }
        }
        if path.is_dir() {
            writable(path).map_err(|e| refused(path, "cannot write in this folder", e, way_out))
        } else {
            let is = if path.exists() { "a file, not a folder" } else { "a link to nothing" };
            Err(Failure::new(format!("{}: this is {is}; move it away, or {way_out}", path.display())))
        }
    }
}

impl Drop for Folders {
    fn drop(&mut self) {
        for folder in self.made.iter().rev() {
            // One that holds something by now stays, since only empty folders can be removed this way.
            let _ = fs::remove_dir(folder);
        }
    }
}

/// Refuses a file that cannot be written: in its place is what a file cannot replace, or its folder takes none.
pub fn file(path: &Path) -> Result<(), Failure> {
    free(path, "choose another name")?;
    let folder = folder_of(path);
    match writable(folder) {
        Ok(()) => Ok(()),
        Err(_) if !folder.exists() => Err(Failure::new(format!(
            "{}: there is no folder {}; make it, or choose another",
            path.display(),
            folder.display()
        ))),
        Err(e) => Err(refused(path, "cannot be written there", e, "choose another folder")),
    }
}

/// Refuses files that would be written over one another, however their folders are spelled. All can be written, as
/// [`file()`] says.
pub fn distinct(paths: &[&Path]) -> Result<(), Failure> {
    let mut places = Vec::new();
    for path in paths {
        let place = fs::canonicalize(folder_of(path)).unwrap_or_default().join(path.file_name().unwrap_or_default());
        if places.contains(&place) {
            return Err(Failure::new(format!("{}: asked for twice; give each file a name of its own", path.display())));
        }
        places.push(place);
    }
    Ok(())
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Refuses a name that belongs to something else than an ordinary file. A file that is there already is replaced when
/// the new one is whole.
pub fn free(path: &Path, way_out: &str) -> Result<(), Failure> {
    let is = match fs::metadata(path) {
        Ok(there) if there.is_dir() => "a folder",
        Ok(there) if !there.is_file() => "a device or a pipe",
        _ => return Ok(()),
    };
    Err(Failure::new(format!("{}: this is {is}, not a file; move it away, or {way_out}", path.display())))
}

/// Whether a folder takes files, by putting one there that has no name.
fn writable(folder: &Path) -> std::io::Result<()> {
    tempfile::tempfile_in(folder).map(drop)
}

fn refused(path: &Path, what: &str, source: std::io::Error, way_out: &str) -> Failure {
    Failure::new(format!("{}: {what}: {}; {way_out}", path.display(), Error::from(source).what))
}
