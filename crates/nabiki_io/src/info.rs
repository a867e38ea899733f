//! What is in a file, for a person to read or, through serde, for a program.

mod cache;
mod hair;
mod mesh;
mod motion;

use std::{fmt, fs, path::Path};

use glam::Vec3;
use serde::Serialize;

pub use cache::CacheInfo;
pub use hair::HairInfo;
pub use mesh::MeshInfo;
pub use motion::MotionInfo;

use crate::{
    error::{Error, Result},
    exchange::ExchangeInfo,
    hair::extension,
};

/// What a file turned out to be.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum Info {
    /// Strands at rest.
    Hair(HairInfo),
    /// A head, or anything made of triangles.
    Mesh(MeshInfo),
    /// Moving strands.
    Cache(CacheInfo),
    /// A USD layer or an Alembic archive.
    Exchange(ExchangeInfo),
    /// Motion of a head.
    Motion(MotionInfo),
}

impl fmt::Display for Info {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Hair(info) => info.fmt(f),
            Self::Mesh(info) => info.fmt(f),
            Self::Cache(info) => info.fmt(f),
            Self::Exchange(info) => info.fmt(f),
            Self::Motion(info) => info.fmt(f),
        }
    }
}

/// Looks into a file, told by its name's ending: .hair, .tfx, .obj, .glb, .gltf, .ply, .tfxmesh, .usda, .usdc, .abc,
/// .bvh, .csv, .amc, .asf, .tof or .nabiki.
pub fn info(path: &Path) -> Result<Info> {
    match extension(path).as_str() {
        "hair" | "tfx" | "tfxbone" => Ok(Info::Hair(HairInfo::of(&crate::hair::read(path)?))),
        "usd" | "usda" | "usdc" | "abc" => Ok(Info::Exchange(ExchangeInfo::of(path)?)),
        "bvh" | "csv" | "amc" | "asf" | "tof" => Ok(Info::Motion(MotionInfo::of(path)?)),
        "glb" | "gltf" | "ply" | "tfxmesh" => Ok(Info::Mesh(MeshInfo::of_file(path)?)),
        "obj" => {
            let bytes = fs::read(path).map_err(|e| Error::from(e).in_file(path))?;
            let is_hair = bytes.split(|&b| b == b'\n').any(|line| line.starts_with(b"l "));
            if is_hair {
                Ok(Info::Hair(HairInfo::of(&crate::hair::read(path)?)))
            } else {
                Ok(Info::Mesh(MeshInfo::of_file(path)?))
            }
        }
        "nabiki" => Ok(Info::Cache(CacheInfo::of(crate::cache::Reader::open(path)?)?)),
        other => {
            let known = ".hair, .tfx, .obj, .glb, .gltf, .ply, .tfxmesh, .usda, .usdc, .abc, .bvh, .csv, .amc, .asf, .tof \
                         or .nabiki";
            Err(Error::new(format!("ending \"{other}\" is not one of {known}")).in_file(path))
        }
    }
}

/// The corners of a box around points (the file's unit).
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Box3 {
    /// Least x, y and z.
    pub min: [f32; 3],
    /// Greatest x, y and z.
    pub max: [f32; 3],
}

impl Box3 {
    /// The box of `points`, of which there is at least one.
    pub fn of(points: &[Vec3]) -> Self {
        let (min, max) =
            points.iter().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), &p| (low.min(p), high.max(p)));
        Self { min: min.to_array(), max: max.to_array() }
    }

    fn diagonal(&self) -> f32 {
        Vec3::from_array(self.max).distance(Vec3::from_array(self.min))
    }
}

impl fmt::Display for Box3 {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, axis) in ["x", ", y", ", z"].into_iter().enumerate() {
            write!(f, "{axis} {}..{}", Short(self.min[i]), Short(self.max[i]))?;
        }
        Ok(())
    }
}

/// Least, middle and greatest of some values.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Spread {
    /// Least.
    pub min: f32,
    /// As many lie below as above.
    pub median: f32,
    /// Greatest.
    pub max: f32,
}

impl Spread {
    /// Of values in any order; all 0 where there are none.
    pub fn of(mut values: Vec<f32>) -> Self {
        if values.is_empty() {
            return Self { min: 0.0, median: 0.0, max: 0.0 };
        }
        let middle = values.len() / 2;
        let (below, &mut median, above) = values.select_nth_unstable_by(middle, f32::total_cmp);
        let min = below.iter().copied().fold(median, f32::min);
        let max = above.iter().copied().fold(median, f32::max);
        Self { min, median, max }
    }
}

impl fmt::Display for Spread {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} / {} (median) / {}", Short(self.min), Short(self.median), Short(self.max))
    }
}

/// A number with four digits that count.
pub struct Short(pub f32);

impl fmt::Display for Short {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.0.abs();
        if size == 0.0 {
            f.write_str("0")
        } else if (1e-4..1e6).contains(&size) {
            let decimals = (3 - size.log10().floor() as i32).max(0) as usize;
            let text = format!("{:.decimals$}", self.0);
            f.write_str(if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text })
        } else {
            write!(f, "{:.3e}", self.0)
        }
    }
}

/// The unit in which something `size` large is most likely what it is meant to be: of `low..high` cm, and nearest, as
/// a ratio, to their geometric middle. `None` where no unit makes it so.
fn guess_unit(size: f32, low: f32, high: f32) -> Option<&'static str> {
    let middle = (low * high).sqrt();
    let sizes = [("mm", 0.1), ("cm", 1.0), ("dm", 10.0), ("m", 100.0)].map(|(unit, cm)| (unit, size * cm));
    let fitting = sizes.into_iter().filter(|(_, cm)| (low..high).contains(cm));
    let off = |cm: f32| (cm / middle).ln().abs();
    fitting.min_by(|a, b| off(a.1).total_cmp(&off(b.1))).map(|(unit, _)| unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        let texts = [0.0, 7e-5, 0.10149, 12.5, 18.0, 1234.56, -0.3333333, 2e9].map(|x| Short(x).to_string());
        assert_eq!(texts, ["0", "7.000e-5", "0.1015", "12.5", "18", "1235", "-0.3333", "2.000e9"]);
    }

    #[test]
    fn the_spread_is_that_of_sorted_values() {
        let spread = Spread::of(vec![5.0, 1.0, 4.0, 2.0, 3.0]);
        assert_eq!((spread.min, spread.median, spread.max), (1.0, 3.0, 5.0));
        assert_eq!(Spread::of(Vec::new()).max, 0.0);
    }

    #[test]
    fn a_unit_is_guessed_only_where_one_fits() {
        assert_eq!(guess_unit(0.44, 15.0, 140.0), Some("m"));
        assert_eq!(guess_unit(44.0, 15.0, 140.0), Some("cm"));
        assert_eq!(guess_unit(1e6, 15.0, 140.0), None);
    }
}
