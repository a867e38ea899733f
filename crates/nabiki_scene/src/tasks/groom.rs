//! Writes the hair of a scene at rest.

use std::path::Path;

use glam::DAffine3;
use nabiki_io::exchange::{self, DeclaredSpace};
use nabiki_io::hair;
use nabiki_io::moving::{self, ChainOptions};

use crate::built::Shown;
use crate::error::Result;
use crate::place;
use crate::scene::Scene;
use crate::watch::Watch;

/// Grows or imports the hair of a scene and writes a hair file. A layer or archive also gets the points at rest as an
/// attribute, for programs that move the hair further.
///
/// # Errors
/// A scene that cannot be built, or a place or format that cannot be written.
pub fn groom(scene: Scene, shown: Shown, output: &Path, watch: &mut dyn Watch) -> Result<()> {
    place::file(output)?;
    // Without hair nothing is lost, but an invalid name is refused.
    hair::losses(output, &nabiki::Hair::default())?;
    place::not_inputs(&[output], &scene.inputs())?;
    let built = super::build(scene, shown, watch)?;
    super::present(&built, watch);
    let losses = if exchange::is_usd(output) || exchange::is_alembic(output) {
        let mut export = exchange::still(&built.groom.hair, DeclaredSpace::default());
        export.rest = true;
        place::room(output, exchange::least_bytes(output, &export, 1, false), watch)?;
        moving::write_still(output, export, &DAffine3::IDENTITY, ChainOptions::default())?;
        exchange::losses(output, &built.groom.hair)
    } else {
        place::room(output, hair::least_bytes(output, &built.groom.hair)?, watch)?;
        hair::write(output, &built.groom.hair)?
    };
    super::lost(output, losses, watch);
    super::wrote(vec![output.to_owned()], watch);
    Ok(())
}
