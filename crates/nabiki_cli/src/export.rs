//! Moving hair for other tools: the frames of a take, passed on as they are made.

use std::path::{Path, PathBuf};

use glam::Affine3A;
use nabiki::Strands;
use nabiki::export::{Export, FrameSink};
use nabiki_io::exchange;
use nabiki_io::motion::{Axis, Pose};
use nabiki_io::take::Take;

use crate::args::ExportArgs;
use crate::failure::Failure;
use crate::film::Frames;

/// The files being written.
pub struct Exports<'a> {
    sinks: Vec<(PathBuf, Box<dyn FrameSink + 'a>)>,
    next: u32,
}

impl<'a> Exports<'a> {
    /// Begins the files that were asked for.
    ///
    /// Hair that came from a file goes back into that file's own space; hair grown here is in centimetres, y up.
    pub fn begin(args: &ExportArgs, take: &'a Take) -> Result<Self, Failure> {
        let mut sinks = Vec::new();
        for path in &args.export {
            let mut export = Export::new(&take.stage.hair, f64::from(take.stage.scene.picture.video.fps));
            if let Some(placement) = &take.stage.hair_placement {
                export.file_from_head = placement.file_from_head();
                export.meters_per_unit = f64::from(placement.unit.cm) / 100.0;
                export.z_up = placement.up == Axis::PlusZ;
            }
            export.default_width = Some(take.stage.scene.picture.hair.width);
            // Unreal takes no archive that has a mesh for a groom.
            export.head = (!exchange::is_alembic(path) || args.export_head).then_some(&take.stage.head.mesh);
            if args.export_layer.is_some() {
                same_strands(take, path)?;
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
            sink.frame(strands, &world_from_head).map_err(|e| failed(path, &e))?;
        }
        Ok(())
    }

    /// Completes the files and names them.
    pub fn finish(self) -> Result<Vec<PathBuf>, Failure> {
        let mut written = Vec::new();
        for (path, sink) in self.sinks {
            sink.finish().map_err(|e| failed(&path, &e))?;
            written.push(path);
        }
        Ok(written)
    }
}

fn failed(path: &Path, error: &std::io::Error) -> Failure {
    Failure::new(format!("{}: {error}", path.display()))
}

/// Refuses a layer over a groom whose strands the import has changed: it would not fit.
fn same_strands(take: &Take, path: &Path) -> Result<(), Failure> {
    let refuse = |why: String| Err(Failure::new(format!("{}: a layer would not fit the groom: {why}", path.display())));
    match &take.stage.import_report {
        None => refuse("its hair is grown here; leave out --export-layer for a complete stage".to_owned()),
        Some(report) if report.points_in_file != take.stage.hair.strands.points().len() => refuse(format!(
            "{} of its {} points are used; set hair.join_within = 0 and hair.drop_shorter_than = 0, leave out \
             hair.strands, and take strands without extent out of the file",
            take.stage.hair.strands.points().len(),
            report.points_in_file
        )),
        Some(_) => Ok(()),
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
