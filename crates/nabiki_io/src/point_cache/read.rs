//! Point caches that are read: the vertices of a mesh in each of their frames.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;

use glam::Vec3;

use super::Kind;
use crate::error::{Error, Result};
use crate::input;
use crate::kind::extension;

/// Whether the ending is that of a point cache.
pub fn is_point_cache(path: &Path) -> bool {
    Kind::of(path).is_some()
}

/// An open point cache.
#[derive(Debug)]
pub(crate) struct PointFrames {
    file: File,
    kind: Kind,
    points: usize,
    /// The time of each frame: seconds in an MDD, frames in a PC2.
    times: Vec<f64>,
    first_at: u64,
}

impl Kind {
    pub fn of(path: &Path) -> Option<Self> {
        match extension(path).as_str() {
            "pc2" => Some(Self::Pc2),
            "mdd" => Some(Self::Mdd),
            _ => None,
        }
    }

    fn whole(self, bytes: [u8; 4]) -> i32 {
        if self == Self::Pc2 { i32::from_le_bytes(bytes) } else { i32::from_be_bytes(bytes) }
    }

    fn number(self, bytes: [u8; 4]) -> f32 {
        f32::from_bits(self.whole(bytes) as u32)
    }
}

impl PointFrames {
    /// Opens a cache and checks that the file is as long as it says.
    ///
    /// # Errors
    /// Another format, a file that is cut off, or one without points or frames.
    pub fn open(path: &Path) -> Result<Self> {
        Self::begin(path).map_err(|e| e.in_file(path))
    }

    fn begin(path: &Path) -> Result<Self> {
        let mut file = input::open(path)?;
        let length = file.metadata()?.len();
        let kind = Kind::of(path).ok_or_else(|| Error::new("is no point cache: give a .pc2 or .mdd"))?;
        let mut word = || -> Result<[u8; 4]> {
            let mut bytes = [0; 4];
            file.read_exact(&mut bytes).map_err(|_| Error::new("ends within its header: the file is cut off"))?;
            Ok(bytes)
        };
        let (points, frames, first, step);
        match kind {
            Kind::Pc2 => {
                let magic = [word()?, word()?, word()?].concat();
                let version = kind.whole(word()?);
                if magic != b"POINTCACHE2\0" || version != 1 {
                    return Err(Error::new(
                        "is not a PC2 of version 1: write it again from the program that it comes from",
                    ));
                }
                points = kind.whole(word()?);
                (first, step) = (f64::from(kind.number(word()?)), f64::from(kind.number(word()?)));
                frames = kind.whole(word()?);
                if !(first.is_finite() && step.is_finite() && step > 0.0) {
                    return Err(Error::new(format!(
                        "begins at frame {first} in steps of {step}: steps must be above 0"
                    )));
                }
            }
            Kind::Mdd => {
                (frames, points) = (kind.whole(word()?), kind.whole(word()?));
                (first, step) = (0.0, 1.0);
            }
        }
        let (Ok(count @ 1..), Ok(vertices @ 1..)) = (u64::try_from(frames), u64::try_from(points)) else {
            return Err(Error::new(format!("holds {frames} frames of {points} points: both must be above 0")));
        };
        let first_at = if kind == Kind::Pc2 { 32 } else { 8 + 4 * count };
        let wanted = vertices.checked_mul(12).and_then(|bytes| bytes.checked_mul(count)?.checked_add(first_at));
        if wanted.is_none_or(|wanted| length < wanted) {
            let wanted = wanted.map_or_else(|| "more than any file has".to_owned(), |wanted| wanted.to_string());
            let line =
                format!("has {length} bytes, but {frames} frames of {points} points take {wanted}: it is cut off");
            return Err(Error::new(line));
        }
        let times = match kind {
            Kind::Pc2 => (0..count).map(|n| first + n as f64 * step).collect(),
            Kind::Mdd => {
                let mut bytes = vec![0; 4 * count as usize];
                file.read_exact(&mut bytes)?;
                bytes.as_chunks().0.iter().map(|&word| f64::from(kind.number(word))).collect()
            }
        };
        Ok(Self { file, kind, points: vertices as usize, times, first_at })
    }

    /// Number of points of each frame.
    pub fn points(&self) -> usize {
        self.points
    }

    /// Times of the frames (s); `rate` is that of a cache that counts frames.
    pub fn times(&self, rate: f64) -> Vec<f64> {
        let second = if self.kind == Kind::Pc2 { rate } else { 1.0 };
        self.times.iter().map(|time| time / second).collect()
    }

    /// Number of frames.
    pub fn frames(&self) -> usize {
        self.times.len()
    }

    /// The points of a frame.
    ///
    /// # Errors
    /// What the disk says, and a point that is not finite.
    pub fn frame(&mut self, n: usize) -> Result<Vec<Vec3>> {
        let mut bytes = vec![0; 12 * self.points];
        self.file.seek(SeekFrom::Start(self.first_at + n as u64 * bytes.len() as u64))?;
        self.file.read_exact(&mut bytes)?;
        let (words, _) = bytes.as_chunks::<4>();
        let numbers: Vec<f32> = words.iter().map(|&word| self.kind.number(word)).collect();
        let points: Vec<Vec3> = numbers.as_chunks::<3>().0.iter().map(|&p| p.into()).collect();
        match points.iter().position(|p| !p.is_finite()) {
            Some(v) => Err(Error::new(format!("frame {n}: point {v} is {}: it must be finite", points[v]))),
            None => Ok(points),
        }
    }

    /// The points at a time among these times, on straight lines between frames.
    pub fn at(&mut self, times: &[f64], time: f64) -> Result<Vec<Vec3>> {
        let next = times.partition_point(|&at| at <= time);
        let before = next.saturating_sub(1);
        let points = self.frame(before)?;
        if next == 0 || next >= times.len() || times[before] == time {
            return Ok(points);
        }
        let part = ((time - times[before]) / (times[next] - times[before])) as f32;
        Ok(points.iter().zip(self.frame(next)?).map(|(a, b)| a.lerp(b, part)).collect())
    }
}
