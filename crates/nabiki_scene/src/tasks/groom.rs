//! The hair of a scene, at rest.

use std::path::Path;

use nabiki_io::hair;

use crate::built::Shown;
use crate::error::Result;
use crate::place;
use crate::scene::Scene;
use crate::told::Told;
use crate::watch::Watch;

/// Grows or imports the hair of a scene and writes it into a hair file.
///
/// # Errors
/// A scene that cannot be built, a place or format that cannot be written.
pub fn groom(scene: Scene, shown: Shown, output: &Path, watch: &mut dyn Watch) -> Result<()> {
    place::file(output)?;
    // Of no hair nothing is lost, but a name that no hair is written under is refused.
    hair::losses(output, &nabiki::Hair::default())?;
    place::not_inputs(&[output], &scene.inputs())?;
    let built = scene.build(shown)?;
    super::present(&built, watch);
    for what in hair::write(output, &built.hair)? {
        watch.told(Told::Lost { file: output.to_owned(), what });
    }
    super::wrote(vec![output.to_owned()], watch);
    Ok(())
}
