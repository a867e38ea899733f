//! What curves carry beside their points: properties of their schema and its geometry parameters.

use std::io::{Read, Seek};

use nabiki::curves::{Carried, indexed};

use crate::Problem;
use crate::layout::{Kind, Pod};
use crate::tree::{Form, Header, Tree};
use crate::values::{integers, singles, words};

/// The parameters of one object's curves in one sample.
pub struct Parameters<'a, R> {
    tree: &'a mut Tree<R>,
    headers: Vec<Header>,
    frame: usize,
}

/// Values as they are stored.
struct Stored {
    kind: Kind,
    bytes: Vec<u8>,
    /// Which of them stand where, for values stored once for many.
    indices: Option<Vec<i64>>,
}

impl<'a, R: Read + Seek> Parameters<'a, R> {
    /// Those of curves whose schema has the properties `inside`, in sample `frame`.
    pub fn of(tree: &'a mut Tree<R>, mut inside: Vec<Header>, frame: usize) -> Result<Self, Problem> {
        let more = inside.iter().find(|h| h.name == ".arbGeomParams" && h.form == Form::Compound);
        if let Some(place) = more.map(|h| h.place) {
            inside.extend(tree.properties(place)?);
        }
        Ok(Self { tree, headers: inside, frame })
    }

    fn stored(&mut self, name: &str) -> Result<Option<Stored>, Problem> {
        let Some(header) = self.headers.iter().find(|h| h.name == name) else { return Ok(None) };
        if header.form != Form::Compound {
            let bytes = self.tree.sample(header, self.frame)?;
            return Ok(Some(Stored { kind: header.kind, bytes, indices: None }));
        }
        let inside = self.tree.properties(header.place)?;
        let part = |part: &str| {
            let found = inside.iter().find(|h| h.name == part && h.form != Form::Compound);
            found.ok_or_else(|| Problem(format!("attribute {name}: has no {part}")))
        };
        let (values, indices) = (part(".vals")?, part(".indices")?);
        let bytes = self.tree.sample(values, self.frame)?;
        let indices = integers(indices.kind, &self.tree.sample(indices, self.frame)?)?;
        Ok(Some(Stored { kind: values.kind, bytes, indices: Some(indices) }))
    }
}

impl Stored {
    fn is_text(&self) -> bool {
        matches!(self.kind.pod, Pod::Text | Pod::WideText)
    }

    fn expanded<T: Clone>(&self, name: &str, values: Vec<T>) -> Result<Option<Vec<T>>, Problem> {
        match &self.indices {
            Some(indices) => indexed(name, &values, indices).map(Some),
            None => Ok(Some(values)),
        }
    }
}

impl<R: Read + Seek> Carried for Parameters<'_, R> {
    fn tuples<const N: usize>(&mut self, name: &str) -> Result<Option<Vec<[f32; N]>>, Problem> {
        let Some(stored) = self.stored(name)? else { return Ok(None) };
        let extent = usize::from(stored.kind.extent);
        if stored.is_text() || extent < N {
            return Ok(None);
        }
        // Blender writes colours with an alpha; only what comes before it is kept.
        let numbers = singles(stored.kind, &stored.bytes)?;
        let values = numbers.chunks_exact(extent).map(|v| std::array::from_fn(|i| v[i])).collect();
        stored.expanded(name, values)
    }

    fn integers(&mut self, name: &str) -> Result<Option<Vec<i64>>, Problem> {
        match self.stored(name)? {
            Some(stored) if stored.kind.extent == 1 && !stored.is_text() => {
                stored.expanded(name, integers(stored.kind, &stored.bytes)?)
            }
            _ => Ok(None),
        }
    }

    fn words(&mut self, name: &str) -> Result<Option<Vec<String>>, Problem> {
        match self.stored(name)? {
            Some(stored) => stored.expanded(name, words(stored.kind, &stored.bytes)),
            None => Ok(None),
        }
    }
}
