//! Moving hair for other tools: frames passed on as they are made.

use std::path::{Path, PathBuf};

use nabiki::{Pose, Strands};
use nabiki_exchange::FrameSink;
use nabiki_io::cache::Origin;
use nabiki_io::exchange;
use nabiki_render::colour;

use crate::built::BuiltScene;
use crate::error::{Error, Result};
use crate::place;
use crate::watch::Watch;

/// Which files of moving hair a task writes beside its other results.
#[derive(Clone, Debug, Default)]
pub struct ExportOptions {
    /// .usd, .usda, .usdc or .abc files.
    pub files: Vec<PathBuf>,
    /// Prim path of the groom over which samples alone are laid; `None` writes complete stages.
    pub layer: Option<String>,
    /// Whether the head goes into .abc files too; Unreal then takes them for a mesh, not for a groom.
    pub head: bool,
}

impl ExportOptions {
    /// Refuses names that no moving hair can have, before anything is built.
    ///
    /// # Errors
    /// An ending that is not of a format of moving hair; a layer of Alembic, which has none.
    pub fn check(&self) -> Result<()> {
        if let (Some(prim), []) = (&self.layer, &self.files[..]) {
            return Err(Error::refused(format!(
                "--export-layer {prim}: give the layer's file, too: --export FILE.usdc"
            )));
        }
        if self.head && !self.files.iter().any(|file| exchange::is_alembic(file)) {
            let line = "--export-head: puts the head into .abc files, and none is written; other files have it without";
            return Err(Error::refused(line));
        }
        self.files.iter().try_for_each(|file| {
            let way_out = match (exchange::is_usd(file), exchange::is_alembic(file), &self.layer) {
                (true, _, _) | (_, true, None) => return place::file(file),
                (_, true, Some(_)) => "Alembic has no layers: write .usd, .usda or .usdc",
                _ => "moving hair is written as .usd, .usda, .usdc or .abc",
            };
            Err(Error::refused(format!("{}: {way_out}", file.display())))
        })
    }
}

/// The files being written.
pub(crate) struct Exports<'a> {
    sinks: Vec<(PathBuf, Box<dyn FrameSink + 'a>)>,
    origin: Option<Origin>,
    next: u32,
}

impl<'a> Exports<'a> {
    /// Begins the files.
    pub fn begin(options: &ExportOptions, built: &'a BuiltScene, watch: &mut dyn Watch) -> Result<Self> {
        let mut sinks = Vec::new();
        for path in &options.files {
            let frame_rate = built.scene.frame_rate();
            let mut export = exchange::export(&built.hair, frame_rate, built.hair_placement.as_ref());
            export.first_frame = built.first_frame();
            export.default_width = Some(built.scene.picture.hair.width);
            export.default_colour = Some(colour::of_mass(&built.scene.picture.hair));
            export.head = (!exchange::is_alembic(path) || options.head).then_some(&built.head.mesh);
            if let Some(prim) = &options.layer {
                let in_file = built.import_report.map(|report| report.points_in_file as u64);
                let used = built.hair.strands.points().len();
                let fits = |in_file| exchange::check_layer(in_file, used).map_err(|e| e.in_file(path));
                fits(in_file)?;
                if let Some(groom) = &built.groom {
                    let curves = groom.under_layer(prim)?;
                    // Curves of a single point are none that are read.
                    fits(Some(curves.points))?;
                    exchange::under_groom(&mut export, curves);
                    super::tasks::lost(path, exchange::layer_losses(built.head_moves()), watch);
                }
            }
            let bytes = exchange::least_bytes(path, &export, u64::from(built.frames()) + 1, options.layer.is_some());
            place::room(path, bytes, watch)?;
            if options.layer.is_none() {
                super::tasks::lost(path, exchange::losses(path, &built.hair), watch);
            }
            sinks.push((path.clone(), exchange::sink(path, export, options.layer.as_deref())?));
        }
        Ok(Self { sinks, origin: built.hair_origin(), next: 0 })
    }

    /// Passes on frame `n`, unless it has been passed on before.
    pub fn frame(&mut self, n: u32, strands: &Strands, pose: &Pose) -> Result<()> {
        if n != self.next {
            return Ok(());
        }
        self.next += 1;
        let world_from_head = Origin::world_from_head(self.origin.as_ref(), pose);
        for (path, sink) in &mut self.sinks {
            sink.frame(strands, &world_from_head).map_err(|e| named(e, path))?;
        }
        Ok(())
    }

    /// Completes the files and names them.
    pub fn finish(self) -> Result<Vec<PathBuf>> {
        let mut written = Vec::new();
        for (path, sink) in self.sinks {
            sink.finish().map_err(|e| named(e, &path))?;
            written.push(path);
        }
        Ok(written)
    }
}

fn named(error: std::io::Error, path: &Path) -> Error {
    nabiki_io::Error::from(error).in_file(path).into()
}
