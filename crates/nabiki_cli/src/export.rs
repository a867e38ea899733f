//! Moving hair for other tools: the frames of a take, passed on as they are made.

use std::path::{Path, PathBuf};

use glam::Affine3A;
use nabiki::Pose;
use nabiki::Strands;
use nabiki_exchange::FrameSink;
use nabiki_io::{Error, exchange};
use nabiki_scene::Take;

use crate::args::ExportArgs;
use crate::failure::Failure;
use crate::film::Frames;
use crate::place;

/// The files being written.
pub struct Exports<'a> {
    sinks: Vec<(PathBuf, Box<dyn FrameSink + 'a>)>,
    next: u32,
}

impl<'a> Exports<'a> {
    /// Begins the files that were asked for, `beside` the other files of the command.
    pub fn begin(args: &ExportArgs, beside: &[&Path], take: &'a Take) -> Result<Self, Failure> {
        let stage = &take.stage;
        let mut sinks = Vec::new();
        for path in &args.export {
            place::file(path)?;
        }
        let exports = args.export.iter().map(PathBuf::as_path);
        place::distinct(&beside.iter().copied().chain(exports).collect::<Vec<_>>())?;
        for path in &args.export {
            let frame_rate = f64::from(stage.scene.picture.video.fps);
            let mut export = exchange::export(&stage.hair, frame_rate, stage.hair_placement.as_ref());
            export.default_width = Some(stage.scene.picture.hair.width);
            // Unreal takes no archive that has a mesh for a groom.
            export.head = (!exchange::is_alembic(path) || args.export_head).then_some(&stage.head.mesh);
            if args.export_layer.is_some() {
                let in_file = stage.import_report.map(|report| report.points_in_file as u64);
                exchange::check_layer(in_file, stage.hair.strands.points().len()).map_err(|e| e.in_file(path))?;
            }
            sinks.push((path.clone(), exchange::sink(path, export, args.export_layer.as_deref())?));
        }
        Ok(Self { sinks, next: 0 })
    }

    /// Passes on frame `n`, unless it has been passed on before.
    pub fn frame(&mut self, n: u32, strands: &Strands, pose: &Pose) -> Result<(), Failure> {
        if n != self.next {
            return Ok(());
        }
        self.next += 1;
        let world_from_head = Affine3A::from_rotation_translation(pose.rotation, pose.position_cm);
        for (path, sink) in &mut self.sinks {
            sink.frame(strands, &world_from_head).map_err(|e| Error::from(e).in_file(path))?;
        }
        Ok(())
    }

    /// Completes the files and names them.
    pub fn finish(self) -> Result<Vec<PathBuf>, Failure> {
        let mut written = Vec::new();
        for (path, sink) in self.sinks {
            sink.finish().map_err(|e| Error::from(e).in_file(&path))?;
            written.push(path);
        }
        Ok(written)
    }
}

/// Frames that are passed on to files as they are asked for.
pub struct Exported<'a, 'b, F> {
    pub frames: F,
    pub take: &'a Take,
    pub exports: &'b mut Exports<'a>,
}

impl<F: Frames> Frames for Exported<'_, '_, F> {
    fn frame(&mut self, n: u32) -> Result<&Strands, Failure> {
        let strands = self.frames.frame(n)?;
        self.exports.frame(n, strands, &self.take.pose(n))?;
        Ok(strands)
    }
}
