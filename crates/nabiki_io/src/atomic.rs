//! Files that appear under their own name only when whole.

use std::{
    io::{BufWriter, Write},
    path::{Path, PathBuf},
};

use tempfile::NamedTempFile;

use crate::error::{Error, Result};

/// A file being written beside its final name; dropped unfinished, it leaves nothing.
pub(crate) struct Unfinished {
    /// Where content goes.
    pub file: BufWriter<NamedTempFile>,
    target: PathBuf,
}

impl Unfinished {
    /// Starts a file in the folder of `target`.
    pub fn beside(target: &Path) -> Result<Self> {
        let folder = match target.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder,
            _ => Path::new("."),
        };
        let mut builder = tempfile::Builder::new();
        builder.prefix(".nabiki-").suffix(".part");
        // Temporary files are private by default; this one becomes an ordinary file.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        let named = |e| Error::from(e).in_file(target);
        let file = BufWriter::with_capacity(1 << 20, builder.tempfile_in(folder).map_err(named)?);
        Ok(Self { file, target: target.to_owned() })
    }

    /// Puts the content under its final name.
    pub fn finish(mut self) -> Result<()> {
        let named = |e: std::io::Error| Error::from(e).in_file(&self.target);
        self.file.flush().map_err(named)?;
        let file = self.file.into_inner().map_err(|e| named(e.into_error()))?;
        file.persist(&self.target).map_err(|e| named(e.error))?;
        Ok(())
    }
}

/// Writes a whole file; `content` fills it.
pub(crate) fn write(target: &Path, content: impl FnOnce(&mut dyn Write) -> Result<()>) -> Result<()> {
    let mut unfinished = Unfinished::beside(target)?;
    content(&mut unfinished.file).map_err(|e| e.in_file(target))?;
    unfinished.finish()
}
