//! A layer being read, whether text or binary: prims, attributes, and values that are fetched when needed.

use std::collections::HashMap;
use std::fs::File;
use std::io::{Read, Seek, SeekFrom};

use glam::Vec3;

use crate::Problem;
use crate::crate_file::MAGIC;
use crate::crate_file::read::CrateReader;
use crate::text::read as text;

/// Where a value is: in text its first byte and length, in binary what names it.
pub type Handle = (u64, u64);

/// A prim of the layer.
#[derive(Clone, Debug, Default)]
pub struct PrimInfo {
    /// Name.
    pub name: String,
    /// Type; empty for an `over` or a prim of no type.
    pub type_name: String,
    /// The prim above it in the list.
    pub parent: Option<usize>,
    /// Attributes by name.
    pub attributes: HashMap<String, AttributeInfo>,
}

/// An attribute of a prim.
#[derive(Clone, Debug, Default)]
pub struct AttributeInfo {
    /// Value without a time.
    pub default: Option<Handle>,
    /// Time codes and values, times growing.
    pub samples: Vec<(f64, Handle)>,
}

/// A layer.
pub struct Layer {
    /// Prims, parents before their children.
    pub prims: Vec<PrimInfo>,
    /// What the layer says about itself.
    pub metadata: HashMap<String, Handle>,
    values: Values,
}

enum Values {
    Text(Box<dyn Source>),
    Binary(Box<CrateReader<Box<dyn Source>>>),
}

/// What a layer is read from.
pub trait Source: Read + Seek {}
impl<T: Read + Seek> Source for T {}

impl Layer {
    /// Reads what prims a layer has; it is told by its first bytes whether it is text.
    pub fn open(mut from: Box<dyn Source>) -> Result<Self, Problem> {
        let mut first = [0; 8];
        let length = from.seek(SeekFrom::End(0))?;
        from.seek(SeekFrom::Start(0))?;
        from.read_exact(&mut first[..length.min(8) as usize])?;
        from.seek(SeekFrom::Start(0))?;
        if first == *MAGIC {
            let (reader, prims, metadata) = CrateReader::new(from, length)?;
            return Ok(Self { prims, metadata, values: Values::Binary(Box::new(reader)) });
        }
        if first.starts_with(b"PK\x03\x04") {
            return Err(Problem::new("is a .usdz package: unpack it and give the layer inside"));
        }
        if !first.starts_with(b"#usda") && !first.starts_with(b"#sdf") {
            return Err(Problem::new("is no USD layer: it begins neither with #usda nor with PXR-USDC"));
        }
        let (prims, metadata) = text::parse(&mut *from, length)?;
        Ok(Self { prims, metadata, values: Values::Text(from) })
    }

    /// Opens the layer in a file.
    pub fn file(path: &std::path::Path) -> Result<Self, Problem> {
        Self::open(Box::new(File::open(path)?))
    }

    /// All numbers of a value, in a row; nothing for text.
    pub fn numbers(&mut self, handle: Handle) -> Result<Vec<f64>, Problem> {
        match &mut self.values {
            Values::Text(from) => text::numbers(&mut **from, handle),
            Values::Binary(reader) => reader.numbers(handle.0),
        }
    }

    /// All numbers of a value as singles.
    pub fn singles(&mut self, handle: Handle) -> Result<Vec<f32>, Problem> {
        match &mut self.values {
            Values::Text(from) => text::numbers(&mut **from, handle),
            Values::Binary(reader) => reader.singles(handle.0),
        }
    }

    /// All numbers of a value as points.
    pub fn points(&mut self, handle: Handle) -> Result<Vec<Vec3>, Problem> {
        match &mut self.values {
            Values::Text(from) => {
                let numbers: Vec<f32> = text::numbers(&mut **from, handle)?;
                Ok(numbers.as_chunks::<3>().0.iter().map(|&p| Vec3::from(p)).collect())
            }
            Values::Binary(reader) => reader.points(handle.0),
        }
    }

    /// All numbers of a value as whole numbers.
    pub fn integers(&mut self, handle: Handle) -> Result<Vec<i64>, Problem> {
        match &mut self.values {
            Values::Text(from) => text::numbers(&mut **from, handle),
            Values::Binary(reader) => reader.integers(handle.0),
        }
    }

    /// All words of a value: tokens or strings.
    pub fn words(&mut self, handle: Handle) -> Result<Vec<String>, Problem> {
        match &mut self.values {
            Values::Text(from) => text::words(&mut **from, handle),
            Values::Binary(reader) => reader.words(handle.0),
        }
    }

    /// Whether quaternions come with their real part first, as text has them.
    pub fn real_first(&self) -> bool {
        matches!(self.values, Values::Text(_))
    }

    /// Path of a prim.
    pub fn path(&self, prim: usize) -> String {
        let mut names = Vec::new();
        let mut above = Some(prim);
        while let Some(i) = above {
            names.push(self.prims[i].name.as_str());
            above = self.prims[i].parent;
        }
        names.iter().rev().fold(String::new(), |path, name| path + "/" + name)
    }

    /// The value of an attribute at a time code: the last sample at or before it, or the first.
    pub fn at(&self, prim: usize, name: &str, time: f64) -> Option<Handle> {
        let attribute = self.prims[prim].attributes.get(name)?;
        let after = attribute.samples.partition_point(|&(t, _)| t <= time + 1e-6);
        match attribute.samples.get(after.saturating_sub(1)) {
            Some(&(_, handle)) => Some(handle),
            None => attribute.default,
        }
    }

    /// The first word of a token attribute.
    pub fn word(&mut self, prim: usize, name: &str) -> Result<Option<String>, Problem> {
        match self.at(prim, name, f64::NEG_INFINITY) {
            Some(handle) => Ok(self.words(handle)?.into_iter().next()),
            None => Ok(None),
        }
    }

    /// A number the layer says about itself.
    pub fn metadata_number(&mut self, name: &str) -> Result<Option<f64>, Problem> {
        match self.metadata.get(name).copied() {
            Some(handle) => Ok(self.numbers(handle)?.first().copied()),
            None => Ok(None),
        }
    }
}
