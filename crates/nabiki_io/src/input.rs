//! Reads regular files up to a size limit.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;

use crate::error::{Error, Result};

/// Size limit of text files with numbers: meshes, motion, strands as lines (bytes).
pub const MOST_TEXT_BYTES: u64 = 1 << 30;

/// Size limit of a scene (bytes). A text of only brackets and commas takes 100 times as much memory.
pub const MOST_SCENE_BYTES: u64 = 1 << 20;

/// Size limit of a binary file that is read into memory (bytes): the largest size that a .glb can declare.
pub const MOST_BINARY_BYTES: u64 = 1 << 32;

/// Opens a regular file. It refuses folders, devices and pipes (which may block or never end), and the placeholder that
/// Git LFS leaves for a file that was not fetched.
///
/// # Errors
/// One line that names the file.
pub fn open(path: &Path) -> Result<File> {
    let named = |e: std::io::Error| Error::from(e).in_file(path);
    // Asked before it is opened: opening a pipe waits for someone to write into it.
    let before = std::fs::metadata(path).map_err(named)?;
    let file = if before.is_file() { Some(File::open(path).map_err(named)?) } else { None };
    match file {
        Some(mut file) if file.metadata().map_err(named)?.is_file() => {
            if is_lfs_pointer(&mut file).map_err(named)? {
                return Err(Error::new("is a Git LFS pointer: fetch the file with git lfs pull").in_file(path));
            }
            Ok(file)
        }
        _ => {
            let what = if before.is_dir() { "a folder" } else { "a device or a pipe" };
            let refused = Error::new(format!("is {what}, not a regular file: give a file")).in_file(path);
            Err(if before.is_dir() { refused.of_system(std::io::ErrorKind::IsADirectory) } else { refused })
        }
    }
}

/// Whether a file, at its beginning, is a pointer as the specification of Git LFS has it: a short text that begins so.
fn is_lfs_pointer(file: &mut File) -> std::io::Result<bool> {
    const SHORTER_THAN: u64 = 1024;
    const BEGINNINGS: [&[u8]; 2] =
        [b"version https://git-lfs.github.com/spec/", b"version https://hawser.github.com/spec/"];
    if file.metadata()?.len() >= SHORTER_THAN {
        return Ok(false);
    }
    let mut first = Vec::new();
    file.take(48).read_to_end(&mut first)?;
    file.seek(SeekFrom::Start(0))?;
    Ok(BEGINNINGS.iter().any(|beginning| first.starts_with(beginning)))
}

/// Reads a regular file of at most `most` bytes.
///
/// # Errors
/// If the file is not regular, is longer, or cannot be read. One line that names the file.
pub fn read(path: &Path, most: u64) -> Result<Vec<u8>> {
    let named = |e: std::io::Error| Error::from(e).in_file(path);
    let file = open(path)?;
    let length = file.metadata().map_err(named)?.len();
    let longer = || Error::new(format!("is longer than {}, the most that nabiki reads", Size(most))).in_file(path);
    if length > most {
        return Err(longer());
    }
    let mut bytes = Vec::with_capacity(length as usize);
    // A file may grow while it is read, and some that the system makes up say that they have no length.
    file.take(most + 1).read_to_end(&mut bytes).map_err(named)?;
    if bytes.len() as u64 > most { Err(longer()) } else { Ok(bytes) }
}

/// Reads a regular file of at most `most` bytes, which must be UTF-8.
///
/// # Errors
/// As for [`read`]; or if the file is not UTF-8.
pub fn read_text(path: &Path, most: u64) -> Result<String> {
    let mut bytes = read(path, most)?;
    // A mark that some editors put before UTF-8; it is no part of the text.
    if bytes.starts_with(BYTE_ORDER_MARK) {
        bytes.drain(..BYTE_ORDER_MARK.len());
    }
    if bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff") {
        return Err(Error::new("is UTF-16, as Windows PowerShell writes it: save it as UTF-8").in_file(path));
    }
    String::from_utf8(bytes).map_err(|e| {
        let at = e.utf8_error().valid_up_to();
        Error::new(format!("byte {at} is not text (UTF-8): is this the right file?")).in_file(path)
    })
}

/// What some editors put before UTF-8.
pub(crate) const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// A number of bytes in whole units of 1024 each.
struct Size(u64);

impl std::fmt::Display for Size {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mut left = self.0;
        for unit in ["bytes", "KiB", "MiB"] {
            if left == 0 || !left.is_multiple_of(1024) {
                return write!(f, "{left} {unit}");
            }
            left /= 1024;
        }
        write!(f, "{left} GiB")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_read_up_to_what_is_stated_and_no_further() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("seven.txt");
        std::fs::write(&path, "1234567").unwrap();
        assert_eq!(read_text(&path, 7).unwrap(), "1234567");
        let refused = |most| read_text(&path, most).unwrap_err().to_string();
        assert_eq!(refused(6), format!("{}: is longer than 6 bytes, the most that nabiki reads", path.display()));
        std::fs::write(&path, b"12\xff").unwrap();
        assert!(refused(7).contains("byte 2 is not text"), "{}", refused(7));
        std::fs::write(&path, b"\xff\xfea\0").unwrap();
        assert!(refused(7).ends_with("is UTF-16, as Windows PowerShell writes it: save it as UTF-8"));
        // A file full of holes is longer than it takes on the disk, and is refused before any of it is read.
        std::fs::File::create(&path).unwrap().set_len(1 << 40).unwrap();
        assert!(refused(MOST_TEXT_BYTES).contains("is longer than 1 GiB"), "{}", refused(MOST_TEXT_BYTES));
        assert!(refused(MOST_SCENE_BYTES).contains("is longer than 1 MiB"));
    }

    #[cfg(unix)]
    #[test]
    fn what_never_ends_or_never_begins_is_refused_at_once() {
        let folder = tempfile::tempdir().unwrap();
        let refused = |path: &Path| read(path, MOST_TEXT_BYTES).unwrap_err().to_string();
        let is = |what: &str, path: &Path| format!("{}: is {what}, not a regular file: give a file", path.display());
        assert_eq!(refused(folder.path()), is("a folder", folder.path()));
        // Links that lead to a device are followed, and end there.
        let link = folder.path().join("endless.bvh");
        std::os::unix::fs::symlink("/dev/zero", &link).unwrap();
        assert_eq!(refused(&link), is("a device or a pipe", &link));
        let pipe = folder.path().join("pipe.obj");
        assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        assert_eq!(refused(&pipe), is("a device or a pipe", &pipe));
        let missing = folder.path().join("no.csv");
        assert!(refused(&missing).contains("there is no such file"), "{}", refused(&missing));
    }
}
