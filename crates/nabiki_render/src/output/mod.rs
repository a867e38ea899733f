//! Files: pictures, movies, sheets and drawings, each written beside its name and renamed when whole.

pub mod canvas;
pub mod exr;
pub mod field_plot;
mod font;
mod mp4;
pub mod png;
pub mod sheet;
pub mod video;

use std::io::{BufWriter, Write};
use std::path::Path;

use tempfile::NamedTempFile;

use crate::RenderError;

/// An unnamed file in the folder where `path` will be.
fn beside(path: &Path) -> Result<NamedTempFile, RenderError> {
    let folder = path.parent().filter(|f| !f.as_os_str().is_empty()).unwrap_or(Path::new("."));
    tempfile::Builder::new()
        .prefix(".nabiki-")
        .tempfile_in(folder)
        .map_err(|source| RenderError::Write { path: path.to_owned(), source })
}

/// Writes a whole file with `fill`, then gives it its name.
fn write_whole(
    path: &Path,
    fill: impl FnOnce(&mut BufWriter<&mut std::fs::File>) -> Result<(), Box<dyn std::error::Error + Send + Sync>>,
) -> Result<(), RenderError> {
    let mut file = beside(path)?;
    let mut writer = BufWriter::new(file.as_file_mut());
    fill(&mut writer).map_err(|e| RenderError::write(path, e))?;
    writer.flush().map_err(|e| RenderError::write(path, e))?;
    drop(writer);
    name(file, path)
}

/// Gives a finished file its name, readable as other new files are.
fn name(file: NamedTempFile, path: &Path) -> Result<(), RenderError> {
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        file.as_file()
            .set_permissions(std::fs::Permissions::from_mode(0o644))
            .map_err(|e| RenderError::write(path, e))?;
    }
    file.persist(path).map_err(|e| RenderError::write(path, e.error))?;
    Ok(())
}
