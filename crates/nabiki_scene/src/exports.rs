//! Moving hair for other tools: frames are written as they are computed.

use std::path::{Path, PathBuf};

use nabiki::dynamics::{Form, earth_gravity};
use nabiki::free_form::EARTH_CM_PER_S2;
use nabiki::{Hair, Pose, Strands};
use nabiki_exchange::{Export, FrameSink};
use nabiki_io::cache::Origin;
use nabiki_io::exchange;
use nabiki_io::moving::{self, ChainOptions, Springs};
use nabiki_render::colour;

use crate::built::BuiltScene;
use crate::error::{Error, Result};
use crate::memory;
use crate::place;
use crate::scene::HeadSource;
use crate::watch::Watch;

/// The files of moving hair that a task writes in addition to its other results.
#[derive(Clone, Debug, Default)]
pub struct ExportOptions {
    /// .usd, .usda, .usdc, .abc, .glb, .exr, .pc2 or .mdd files.
    pub files: Vec<PathBuf>,
    /// Prim path of a groom, for a layer with only samples over it. `None` writes complete stages.
    pub layer: Option<String>,
    /// Whether to write the head where it is usually left out: the built-in head, which is large and known to
    /// everybody, and any head in .abc files, which Unreal then imports as a mesh and not as a groom.
    pub head: bool,
    /// How hair is turned into chains of joints, for .glb files. Its cards are for .exr, too.
    pub chains: ChainOptions,
    /// Whether a .glb also gets VRM's spring bones, with the scene's hold, weight and settling. Free form only.
    pub springs: bool,
}

impl ExportOptions {
    /// Refuses file names that are not valid for moving hair, before anything is built.
    ///
    /// # Errors
    /// An ending that belongs to no format of moving hair, a layer for a format that has none, or options without their file.
    pub fn check(&self) -> Result<()> {
        if let (Some(prim), []) = (&self.layer, &self.files[..]) {
            return Err(Error::refused(format!(
                "--export-layer {prim}: also give the layer's file: --export FILE.usdc"
            )));
        }
        if let (true, Some(prim)) = (self.head, &self.layer) {
            return Err(Error::refused(format!(
                "--export-head: a layer over {prim} contains only samples of the hair; leave out one of the two"
            )));
        }
        if self.head && self.files.is_empty() {
            let line = "--export-head: adds the head to moving hair, but none is written: also give --export FILE.usdc";
            return Err(Error::refused(line));
        }
        let has_chains = self.files.iter().any(|file| moving::has_chains(file));
        if self.springs && !has_chains {
            return Err(Error::refused("springs are for chains of joints: export a .glb with them"));
        }
        self.chains.check().map_err(|why| Error::refused(format!("chains of joints: {why}")))?;
        self.files.iter().try_for_each(|file| {
            let way_out = match &self.layer {
                _ if !moving::is_moving(file) => format!("moving hair is written as {}", moving::ENDINGS),
                Some(_) if !exchange::is_usd(file) => moving::no_layers(file),
                _ => return moving::files(file).try_for_each(|file| place::file(&file)),
            };
            Err(Error::refused(format!("{}: {way_out}", file.display())))
        })
    }

    /// All files that are written: those asked for, and what comes with them.
    pub(crate) fn written(&self) -> Vec<PathBuf> {
        self.files.iter().flat_map(|file| moving::files(file)).collect()
    }
}

/// The files being written.
pub(crate) struct Exports<'a> {
    sinks: Vec<(PathBuf, Box<dyn FrameSink + 'a>)>,
    origin: Option<Origin>,
    /// Strands that the hair's file stores tip first, and memory for a frame with these reversed, as most formats have it.
    turned: Option<(&'a [bool], Strands)>,
    next: u32,
}

impl<'a> Exports<'a> {
    /// Begins the files. `hair`: that of the scene as its own file has it.
    pub fn begin(
        options: &ExportOptions,
        built: &'a BuiltScene,
        hair: &'a Hair,
        watch: &mut dyn Watch,
    ) -> Result<Self> {
        let springs = if options.springs { Some(springs_of(built)?) } else { None };
        let chains = ChainOptions { springs, ..options.chains };
        let mut sinks = Vec::new();
        for path in &options.files {
            let frame_rate = built.scene.frame_rate();
            let imported = built.groom.imported.as_ref();
            let root_first = moving::is_root_first(path);
            let hair = if root_first { &built.groom.hair } else { hair };
            let mut export = exchange::export(hair, frame_rate, imported.map(|imported| &imported.placement));
            export.first_frame = built.first_frame();
            export.frames = built.frames() + 1;
            export.default_width = Some(built.scene.picture.hair.width);
            export.default_colour = Some(colour::of_mass(&built.scene.picture.hair));
            let own = built.scene.head.source != HeadSource::Builtin;
            export.head = (options.head || own && exchange::is_usd(path)).then_some(&built.model.head.mesh);
            if let Some(prim) = &options.layer {
                let in_file = imported.map(|imported| imported.report.points_in_file as u64);
                let used = hair.strands.points().len();
                let fits = |in_file| exchange::check_layer(in_file, used).map_err(|e| e.in_file(path));
                fits(in_file)?;
                if let Some(imported) = imported {
                    let curves = imported.curves.under_layer(prim)?;
                    // Curves of a single point are not read.
                    fits(Some(curves.points))?;
                    exchange::under_groom(&mut export, curves);
                    super::tasks::lost(path, exchange::layer_losses(curves, built.head_moves()), watch);
                }
            }
            let begun = sink(path, export, options.layer.as_deref(), chains, watch)?;
            if options.layer.is_none() {
                super::tasks::lost(path, moving::losses(path, hair), watch);
            }
            sinks.push((path.clone(), begun));
        }
        let turned = built.groom.hair.attributes.tip_first.as_deref().filter(|_| !sinks.is_empty());
        let turned = turned.map(|turned| (turned, built.strands().clone()));
        Ok(Self { sinks, origin: built.hair_origin(), turned, next: 0 })
    }

    /// Writes frame `n`, unless it was written before.
    pub fn frame(&mut self, n: u32, strands: &Strands, pose: &Pose) -> Result<()> {
        if n != self.next {
            return Ok(());
        }
        self.next += 1;
        let world_from_head = Origin::world_from_head(self.origin.as_ref(), pose);
        let in_source = match &mut self.turned {
            Some((tip_first, room)) => {
                room.points_mut().copy_from_slice(strands.points());
                room.turn(tip_first);
                room
            }
            None => strands,
        };
        for (path, sink) in &mut self.sinks {
            let strands = if moving::is_root_first(path) { strands } else { in_source };
            sink.frame(strands, &world_from_head).map_err(|e| named(e, path))?;
        }
        Ok(())
    }

    /// Completes the files and names them. With each, what it holds, where that is worth telling.
    pub fn finish(self) -> Result<Vec<(PathBuf, Option<String>)>> {
        let mut written = Vec::new();
        for (path, sink) in self.sinks {
            let holds = sink.finish().map_err(|e| named(e, &path))?;
            let companions = moving::companions(&path);
            written.push((path, holds));
            written.extend(companions.into_iter().map(|(file, is)| (file, Some(is.to_owned()))));
        }
        Ok(written)
    }
}

/// Begins a file of moving hair, if there are disk and memory for it.
pub(crate) fn sink<'a>(
    path: &Path,
    export: Export<'a>,
    layer: Option<&str>,
    chains: ChainOptions,
    watch: &mut dyn Watch,
) -> Result<Box<dyn FrameSink + 'a>> {
    place::room(path, moving::least_bytes(path, &export, layer.is_some()), watch)?;
    let held = moving::held_bytes(path, &export, chains);
    match memory::short_of(held) {
        Some(short) => Err(Error::refused(format!("{}: {short}; use fewer strands or fewer frames", path.display()))),
        None => Ok(moving::sink(path, export, layer, chains)?),
    }
}

/// VRM's spring bones for the hair of a scene.
fn springs_of(built: &BuiltScene) -> Result<Springs> {
    let Form::Free(free) = &built.dynamics.form else {
        return Err(Error::refused("springs are for hair that comes back to rest: set motion.form = \"free\""));
    };
    // The unit of the force, in m/s^2.
    let unit = 0.01 * EARTH_CM_PER_S2 / f64::from(earth_gravity(&built.dynamics, built.mean_length()));
    let back = (free.form.hold.mean() + f64::from(free.form.gravity)) * unit;
    let settle = free.form.settle.mean() * f64::from(built.dynamics.motion.slow) / built.scene.frame_rate();
    if settle == 0.0 {
        let line = "with free.settle = 0 hair swings for ever, and springs cannot: give settle";
        return Err(Error::refused(line));
    }
    Ok(Springs::new(back, settle))
}

fn named(error: std::io::Error, path: &Path) -> Error {
    nabiki_io::Error::from(error).in_file(path).into()
}
