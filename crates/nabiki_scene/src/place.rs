//! Checks the places of results, so that errors are reported before the work starts.

use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use nabiki_file::{behind_links, folder_of};

use crate::error::{Error, Result};
use crate::memory::size;
use crate::told::Told;
use crate::watch::Watch;

/// Folders created for results. Folders that stay empty because of an error are removed again.
#[derive(Default)]
pub struct Folders {
    made: Vec<PathBuf>,
}

impl Folders {
    /// Creates the folder `path` and its parents, and tests whether files can be written there.
    ///
    /// `way_out` ends the line of an error.
    pub fn make(&mut self, path: &Path, way_out: &str) -> Result<()> {
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
            let is = if path.exists() { "a file, not a folder" } else { "a broken link" };
            Err(Error::place(path, format!("this is {is}; move it away, or {way_out}"), ErrorKind::NotADirectory))
        }
    }
}

impl Drop for Folders {
    fn drop(&mut self) {
        for folder in self.made.iter().rev() {
            // Only empty folders can be removed this way, so a folder with files stays.
            let _ = fs::remove_dir(folder);
        }
    }
}

/// Refuses a file that cannot be written: something else has its name, or the folder is not writable.
pub fn file(path: &Path) -> Result<()> {
    free(path, "choose another name")?;
    let target = behind_links(path).map_err(|e| refused(path, "cannot be written there", e, "choose another name"))?;
    let folder = folder_of(&target);
    match writable(folder) {
        Ok(()) => replaceable(&target).map_err(|e| {
            let what = "cannot be replaced: another program has it open, or it is read-only; close it there";
            refused(path, what, e, "choose another name")
        }),
        Err(_) if !folder.exists() => {
            let what = format!("there is no folder {}; make it, or choose another", folder.display());
            Err(Error::place(path, what, ErrorKind::NotFound))
        }
        Err(e) => Err(refused(path, "cannot be written there", e, "choose another folder")),
    }
}

/// Refuses paths to which no scene can be written.
pub fn scene(path: &Path) -> Result<()> {
    if !path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("toml")) {
        return Err(Error::refused(format!("{}: a scene ends in .toml; choose another name", path.display())));
    }
    file(path)
}

/// Refuses paths to which no motion cache can be written.
///
/// `way_out` ends the line of the error about the name.
pub fn cache(path: &Path, way_out: &str, inputs: &[PathBuf]) -> Result<()> {
    if !path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("nabiki")) {
        let path = path.display();
        return Err(Error::refused(format!("{path}: a motion cache ends in .nabiki; {way_out}")));
    }
    file(path)?;
    not_inputs(&[path], inputs)
}

/// Refuses results that would overwrite one another, however their paths are spelled or linked. All must be writable,
/// as for [`file()`].
pub fn distinct(paths: &[&Path]) -> Result<()> {
    for (i, path) in paths.iter().enumerate() {
        if paths[..i].iter().any(|before| is_one(before, path)) {
            return Err(Error::refused(format!("{}: given twice; give each file its own name", path.display())));
        }
    }
    Ok(())
}

/// Refuses results that would overwrite inputs, however their paths are spelled or linked.
pub fn not_inputs(outputs: &[&Path], inputs: &[PathBuf]) -> Result<()> {
    for output in outputs {
        if let Some(input) = inputs.iter().find(|input| input.exists() && is_one(input, output)) {
            let is = if input == output { String::new() } else { format!(", which is {}", input.display()) };
            return Err(Error::refused(format!(
                "{}: this is an input of the result{is}; give the result another name",
                output.display()
            )));
        }
    }
    Ok(())
}

/// From this many bytes on, a result's size is reported before it is written.
const LARGE: u64 = 1 << 30;

/// Reports a large file, and refuses one that does not fit on the disk. `bytes` is its least size.
pub fn room(path: &Path, bytes: u64, watch: &mut dyn Watch) -> Result<()> {
    // The target of a link is what is written.
    let target = behind_links(path).unwrap_or_else(|_| path.to_owned());
    // If the file system does not report its free space, try.
    if let Ok(left) = nabiki_file::available_bytes(folder_of(&target))
        && bytes > left
    {
        return Err(Error::refused(format!(
            "{}: needs at least {}, but the disk has {} left; choose another folder, or fewer frames or strands",
            path.display(),
            size(bytes),
            size(left)
        )));
    }
    if bytes >= LARGE {
        watch.told(Told::Large { file: path.to_owned(), bytes });
    }
    Ok(())
}

/// Whether two names are, or will be, of one file.
fn is_one(a: &Path, b: &Path) -> bool {
    let places = [a, b].map(real);
    places[0] == places[1] || are_linked(a, b) || are_one_where_capitals_do_not_count(&places)
}

/// The place of a file, existing or not, with links resolved.
fn real(path: &Path) -> PathBuf {
    // A broken link creates its target.
    let path = behind_links(path).unwrap_or_else(|_| path.to_owned());
    fs::canonicalize(&path).unwrap_or_else(|_| {
        fs::canonicalize(folder_of(&path)).unwrap_or_default().join(path.file_name().unwrap_or_default())
    })
}

/// Whether two names are hard links to one file.
fn are_linked(a: &Path, b: &Path) -> bool {
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt;
        let place = |path: &Path| fs::metadata(path).map(|about| (about.dev(), about.ino()));
        matches!((place(a), place(b)), (Ok(a), Ok(b)) if a == b)
    }
    #[cfg(not(unix))]
    {
        let _ = (a, b);
        false
    }
}

/// Whether two files in one folder differ only in case, and the file system ignores case.
fn are_one_where_capitals_do_not_count([a, b]: &[PathBuf; 2]) -> bool {
    let (Some(first), Some(second)) = (a.file_name().and_then(|n| n.to_str()), b.file_name().and_then(|n| n.to_str()))
    else {
        return false;
    };
    if a.parent() != b.parent() || first.to_lowercase() != second.to_lowercase() {
        return false;
    }
    let Ok(tried) = tempfile::Builder::new().prefix(".nabiki-try-a").tempfile_in(folder_of(a)) else { return false };
    let name = tried.path().file_name().map(|name| name.to_string_lossy().to_uppercase()).unwrap_or_default();
    tried.path().with_file_name(name).exists()
}

/// Refuses a name of something other than an ordinary file. An existing file is replaced when the new one is complete.
pub fn free(path: &Path, way_out: &str) -> Result<()> {
    if cfg!(windows)
        && let Some(why) = path.file_name().and_then(|name| no_name_in_windows(&name.to_string_lossy()))
    {
        let what = format!("{why}, so Windows does not take it as the name of a file; {way_out}");
        return Err(Error::place(path, what, ErrorKind::InvalidFilename));
    }
    let (is, system) = match fs::metadata(path) {
        Ok(there) if there.is_dir() => ("a folder", ErrorKind::IsADirectory),
        Ok(there) if !there.is_file() => ("a device or a pipe", ErrorKind::AlreadyExists),
        Ok(_) => return Ok(()),
        // On Linux one that is too long.
        Err(e) if e.kind() == ErrorKind::InvalidFilename => {
            return Err(refused(path, "cannot be the name of a file", e, way_out));
        }
        Err(_) => return leads_to_a_folder(path, way_out),
    };
    Err(Error::place(path, format!("this is {is}, not a file; move it away, or {way_out}"), system))
}

/// Refuses a link to a file in a missing folder.
fn leads_to_a_folder(path: &Path, way_out: &str) -> Result<()> {
    let target = behind_links(path).map_err(|e| refused(path, "cannot be written there", e, way_out))?;
    let folder = folder_of(&target);
    if target == path || folder.exists() {
        return Ok(());
    }
    let (target, folder) = (target.display(), folder.display());
    let what = format!("is a link to {target}, and there is no folder {folder}; make it, or {way_out}");
    Err(Error::place(path, what, ErrorKind::NotFound))
}

/// Why Windows does not take a name for a file, as a phrase that follows the name; `None` if it does.
fn no_name_in_windows(name: &str) -> Option<&'static str> {
    let device = name.split('.').next().unwrap_or_default().trim_end().to_ascii_uppercase();
    let numbered = |kind: &str| device.strip_prefix(kind).is_some_and(|n| n.len() == 1 && ("1"..="9").contains(&n));
    if ["CON", "PRN", "AUX", "NUL"].contains(&&*device) || numbered("COM") || numbered("LPT") {
        return Some("is the name of a device");
    }
    if name.contains(|c: char| c.is_control() || "<>:\"|?*".contains(c)) {
        return Some("has one of < > : \" | ? *, or a control character");
    }
    name.ends_with(['.', ' ']).then_some("ends with a dot or a blank")
}

/// Whether an existing file can be replaced: on Windows not one that another program has open without sharing it for deletion.
fn replaceable(path: &Path) -> std::io::Result<()> {
    #[cfg(windows)]
    {
        use std::os::windows::fs::OpenOptionsExt;
        const DELETE: u32 = 0x0001_0000;
        const SHARED_FOR_ALL: u32 = 7;
        match fs::OpenOptions::new().access_mode(DELETE).share_mode(SHARED_FOR_ALL).open(path) {
            Err(e) if e.kind() != ErrorKind::NotFound => return Err(e),
            _ => {}
        }
    }
    let _ = path;
    Ok(())
}

/// Whether a folder is writable: creates a file without a name there.
fn writable(folder: &Path) -> std::io::Result<()> {
    tempfile::tempfile_in(folder).map(drop)
}

fn refused(path: &Path, what: &str, source: std::io::Error, way_out: &str) -> Error {
    let system = source.kind();
    Error::place(path, format!("{what}: {}; {way_out}", nabiki_io::Error::from(source).what), system)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_that_windows_refuses_are_known() {
        for name in
            ["a?.usdc", "b|.abc", "hair:x.abc", "aux.abc", "CON.usdc", "nul", "Lpt3.nabiki", "dot.", "blank ", "a*b"]
        {
            assert!(no_name_in_windows(name).is_some(), "{name}");
        }
        for name in [
            "gust.mp4",
            "auxiliary.abc",
            "com.usdc",
            "COM0.abc",
            "lpt12.abc",
            ".hidden",
            "größe 髪.usda",
            "a'b & c.png",
        ] {
            assert_eq!(no_name_in_windows(name), None, "{name}");
        }
    }

    #[test]
    fn a_name_that_is_too_long_is_refused_before_the_work() {
        let folder = tempfile::tempdir().unwrap();
        let long = folder.path().join("n".repeat(300) + ".abc");
        let refused = file(&long).unwrap_err().to_string();
        assert!(refused.contains("choose another name"), "{refused}");
    }
}
