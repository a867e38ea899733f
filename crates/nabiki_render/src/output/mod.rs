//! Output files: pictures, movies, sheets and drawings. Each gets its name only when it is complete.

pub mod canvas;
#[cfg(feature = "exr")]
pub mod exr;
pub mod field_plot;
mod font;
mod mp4;
pub mod png;
pub mod sheet;
pub mod video;

use std::io::Write;
use std::path::Path;

use nabiki_file::PartFile;

use crate::RenderError;

/// The file that will be `path` when it is whole.
fn create_part(path: &Path) -> Result<PartFile, RenderError> {
    PartFile::create(path).map_err(|source| RenderError::Write { path: path.to_owned(), source })
}

/// Writes the bytes of a picture, such as those from [`png::bytes`], to a file.
///
/// # Errors
/// Errors of the disk.
pub fn write_bytes(path: &Path, bytes: &[u8]) -> Result<(), RenderError> {
    write_whole(path, |file| file.write_all(bytes).map_err(Into::into))
}

/// Writes a whole file with `fill`, then gives it its name.
fn write_whole(
    path: &Path,
    fill: impl FnOnce(&mut PartFile) -> Result<(), Box<dyn std::error::Error + Send + Sync>>,
) -> Result<(), RenderError> {
    let mut file = create_part(path)?;
    fill(&mut file).map_err(|e| RenderError::write(path, e))?;
    file.finish().map_err(|source| RenderError::Write { path: path.to_owned(), source })
}
