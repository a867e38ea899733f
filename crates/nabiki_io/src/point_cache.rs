//! Point caches, which programs lay over a mesh with the same points: PC2 of 3ds Max, and MDD of LightWave.
//!
//! Of hair, every frame holds every point in the world of the file, strand after strand, in the order of the hair's file.

mod read;

use std::io::{self, Write};
use std::path::Path;

use glam::{DAffine3, Vec3};
use nabiki::Strands;
use nabiki_exchange::{Export, FrameSink};
use nabiki_file::PartFile;

pub(crate) use read::PointFrames;
pub use read::is_point_cache;

/// A kind of point cache.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// `.pc2`: little-endian, with the number of the first frame.
    Pc2,
    /// `.mdd`: big-endian, with the time of each frame.
    Mdd,
}

/// A point cache that is being written.
pub(crate) struct PointCache<'a> {
    file: PartFile,
    kind: Kind,
    export: Export<'a>,
    written: u32,
    /// The bytes of a frame.
    bytes: Vec<u8>,
}

impl<'a> PointCache<'a> {
    /// Begins the file, for as many frames as the export says.
    ///
    /// # Errors
    /// What the disk says; hair that is not fit to be written, or too much of it.
    pub fn create(path: &Path, kind: Kind, export: Export<'a>) -> io::Result<Self> {
        export.check()?;
        let invalid = |problem: String| io::Error::new(io::ErrorKind::InvalidInput, problem);
        let count =
            |n: usize, of: &str| i32::try_from(n).map_err(|_| invalid(format!("{n} {of}: at most 2^31 - 1 fit")));
        let points = count(export.hair.strands.points().len(), "points")?;
        let frames = count(export.frames as usize, "frames")?;
        let mut file = PartFile::create(path)?;
        match kind {
            Kind::Pc2 => {
                file.write_all(b"POINTCACHE2\0")?;
                file.write_all(&1_i32.to_le_bytes())?;
                file.write_all(&points.to_le_bytes())?;
                file.write_all(&(export.first_frame as f32).to_le_bytes())?;
                // Frames from one sample to the next.
                file.write_all(&1.0_f32.to_le_bytes())?;
                file.write_all(&frames.to_le_bytes())?;
            }
            Kind::Mdd => {
                file.write_all(&frames.to_be_bytes())?;
                file.write_all(&points.to_be_bytes())?;
                for n in 0..frames {
                    let time = (f64::from(export.first_frame) + f64::from(n)) / export.frame_rate;
                    file.write_all(&(time as f32).to_be_bytes())?;
                }
            }
        }
        Ok(Self { file, kind, export, written: 0, bytes: Vec::new() })
    }
}

impl FrameSink for PointCache<'_> {
    fn frame(&mut self, strands: &Strands, world_from_head: &DAffine3) -> io::Result<()> {
        let points = self.export.world_points(strands, world_from_head)?;
        self.bytes.clear();
        let bytes = |x: f32| if self.kind == Kind::Pc2 { x.to_le_bytes() } else { x.to_be_bytes() };
        self.bytes.extend(points.flat_map(|p: Vec3| p.to_array()).flat_map(bytes));
        self.written += 1;
        self.file.write_all(&self.bytes)
    }

    fn finish(self: Box<Self>) -> io::Result<Option<String>> {
        let (written, frames) = (self.written, self.export.frames);
        if written != frames {
            let problem = format!("{written} frames were written of the {frames} that the file begins with");
            return Err(io::Error::new(io::ErrorKind::InvalidInput, problem));
        }
        self.file.finish()?;
        let (points, strands) = (self.export.hair.strands.points().len(), self.export.hair.strands.len());
        Ok(Some(format!("{frames} frames of {points} points, strand after strand of {strands}")))
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use nabiki::Hair;

    use super::*;

    fn hair() -> Hair {
        let mut strands = Strands::default();
        strands.push([Vec3::ZERO, Vec3::X, Vec3::new(2.0, 1.0, 0.0)]);
        strands.push([Vec3::Y, Vec3::Z]);
        Hair { strands, ..Hair::default() }
    }

    fn written(kind: Kind) -> Vec<u8> {
        let (folder, hair) = (tempfile::tempdir().unwrap(), hair());
        let path = folder.path().join("a.cache");
        let mut export = Export::new(&hair, 24.0);
        (export.frames, export.first_frame) = (2, 12);
        let mut sink: Box<dyn FrameSink> = Box::new(PointCache::create(&path, kind, export).unwrap());
        for x in [0.0, 10.0] {
            sink.frame(&hair.strands, &DAffine3::from_translation(DVec3::X * x)).unwrap();
        }
        assert_eq!(sink.finish().unwrap().unwrap(), "2 frames of 5 points, strand after strand of 2");
        std::fs::read(path).unwrap()
    }

    /// Byte by byte, as the formats are described: 12 + 4 numbers, then three per point.
    #[test]
    fn a_pc2_is_as_its_makers_describe_it() {
        let bytes = written(Kind::Pc2);
        assert_eq!(&bytes[..12], b"POINTCACHE2\0");
        let whole = |at: usize| i32::from_le_bytes(bytes[at..at + 4].try_into().unwrap());
        let number = |at: usize| f32::from_le_bytes(bytes[at..at + 4].try_into().unwrap());
        assert_eq!((whole(12), whole(16), number(20), number(24), whole(28)), (1, 5, 12.0, 1.0, 2));
        assert_eq!(bytes.len(), 32 + 2 * 5 * 12);
        // The third point, in both frames.
        assert_eq!([56, 60, 64].map(number), [2.0, 1.0, 0.0]);
        assert_eq!([116, 120, 124].map(number), [12.0, 1.0, 0.0]);
    }

    #[test]
    fn an_mdd_is_as_its_makers_describe_it() {
        let bytes = written(Kind::Mdd);
        let whole = |at: usize| i32::from_be_bytes(bytes[at..at + 4].try_into().unwrap());
        let number = |at: usize| f32::from_be_bytes(bytes[at..at + 4].try_into().unwrap());
        assert_eq!((whole(0), whole(4), number(8)), (2, 5, 0.5));
        assert!((number(12) - 13.0 / 24.0).abs() < 1e-7);
        assert_eq!(bytes.len(), 16 + 2 * 5 * 12);
        assert_eq!([100, 104, 108].map(number), [12.0, 1.0, 0.0]);
    }

    #[test]
    fn a_cache_that_lacks_a_frame_is_not_finished() {
        let (folder, hair) = (tempfile::tempdir().unwrap(), hair());
        let path = folder.path().join("a.pc2");
        let mut export = Export::new(&hair, 24.0);
        export.frames = 2;
        let mut sink: Box<dyn FrameSink> = Box::new(PointCache::create(&path, Kind::Pc2, export).unwrap());
        sink.frame(&hair.strands, &DAffine3::IDENTITY).unwrap();
        assert!(sink.finish().is_err() && !path.exists());
    }
}
