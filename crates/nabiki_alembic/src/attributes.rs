//! What curves carry beside their points: properties of their schema and its geometry parameters.

use std::collections::HashMap;
use std::io::{Read, Seek};
use std::rc::Rc;

use nabiki::hair::{Per, Role, Values};
use nabiki_exchange::attributes::{NamedValues, Whatever, indexed, indexed_values, misindexed, whole};
use nabiki_exchange::{Budget, Canvas, Painted, PaintedOn, Uvs};

use crate::Problem;
use crate::layout::{Kind, Pod, stored};
use crate::tree::{Header, PropertyKind, Tree};
use crate::values::{doubles, integers, singles, words};

/// The parameters of one object's curves in one sample.
pub struct Parameters<'a, R> {
    tree: &'a mut Tree<R>,
    headers: Vec<Header>,
    /// Which of them has a name; the first of several.
    named: HashMap<Rc<str>, usize>,
    /// How many of them are the schema's own; the rest are geometry parameters.
    of_schema: usize,
    frame: usize,
}

/// Properties of the curves' schema that are read elsewhere, or say nothing of the hair.
const KNOWN: [&str; 8] = [
    "P",
    "nVertices",
    "curveBasisAndType",
    ".selfBnds",
    ".childBnds",
    ".velocities",
    ".arbGeomParams",
    ".userProperties",
];
/// Attributes that the schema itself has.
const OF_SCHEMA: [&str; 2] = ["uv", "width"];

/// Values as they are stored.
struct Sample {
    kind: Kind,
    role: Role,
    per: Option<Per>,
    bytes: Vec<u8>,
    /// Which of them stand where, for values stored once for many.
    indices: Option<Vec<i64>>,
}

impl<'a, R: Read + Seek> Parameters<'a, R> {
    /// Those of curves whose schema has the properties `inside`, in sample `frame`.
    pub fn of(tree: &'a mut Tree<R>, mut inside: Vec<Header>, frame: usize) -> Result<Self, Problem> {
        let of_schema = inside.len();
        let more = inside.iter().find(|h| &*h.name == ".arbGeomParams" && h.form == PropertyKind::Compound);
        if let Some(place) = more.map(|h| h.place) {
            inside.extend(tree.properties(place)?);
        }
        let mut named = HashMap::new();
        for (i, header) in inside.iter().enumerate() {
            named.entry(header.name.clone()).or_insert(i);
        }
        Ok(Self { tree, headers: inside, named, of_schema, frame })
    }

    fn header(&self, name: &str) -> Option<&Header> {
        self.named.get(name).map(|&i| &self.headers[i])
    }

    /// What the curves say of themselves that is not read, a phrase each.
    pub fn unread(&mut self) -> Result<Vec<String>, Problem> {
        let (schema, parameters) = self.headers.split_at(self.of_schema);
        let letters: usize = self.headers.iter().map(|h| 48 + h.name.len()).sum();
        self.tree.budget().take(letters as u64, "notes on what is not read")?;
        let known = |name: &str| KNOWN.contains(&name) || OF_SCHEMA.contains(&name);
        let other = schema.iter().filter(|h| !known(&h.name));
        let mut unread: Vec<String> = other.map(|h| format!("property {}", h.name)).collect();
        let again = self.headers.iter().enumerate().filter(|&(i, h)| self.named.get(&h.name) != Some(&i));
        unread.extend(again.map(|(_, h)| format!("a second property named {}", h.name)));
        let carried = schema.iter().filter(|h| OF_SCHEMA.contains(&&*h.name)).chain(parameters);
        let moving = carried.filter(|h| h.different_samples() > 1);
        let sample = self.frame;
        unread.extend(moving.map(|h| format!("motion of {}: its value in sample {sample} is kept", h.name)));
        let own =
            schema.iter().find(|h| &*h.name == ".userProperties" && h.form == PropertyKind::Compound).map(|h| h.place);
        if let Some(place) = own {
            let properties = self.tree.properties(place)?;
            let letters: usize = properties.iter().map(|h| 48 + h.name.len()).sum();
            self.tree.budget().take(letters as u64, "notes on what is not read")?;
            unread.extend(properties.into_iter().map(|h| format!("user property {}", h.name)));
        }
        Ok(unread)
    }

    /// The texture coordinates of a mesh, if it has any, or why they are none.
    pub fn texture_coordinates(&mut self) -> Result<std::result::Result<Option<Uvs>, String>, Problem> {
        let Some(header) = self.header("uv") else { return Ok(Ok(None)) };
        let of = match header.detail("geoScope") {
            Some("fvr") => Uvs::OfCorners,
            Some("vtx" | "var") => Uvs::OfVertices,
            Some("uni") => return Ok(Err("they belong to faces, not to points".to_owned())),
            _ => return Ok(Err("they are one pair for all points".to_owned())),
        };
        if let Some(why) = self.misindexed("uv")? {
            return Ok(Err(why.to_owned()));
        }
        Ok(self.tuples::<2>("uv")?.map(|uvs| Some(of(uvs))).ok_or_else(|| "they are not pairs of numbers".to_owned()))
    }

    /// The numbers and colours that the vertices or corners of the mesh at `path` have by a name, and what of these is left out, a
    /// phrase each. Values for faces or for the whole mesh are not read.
    pub fn painted(&mut self, path: &str, canvas: Canvas<'_>) -> (Vec<Painted>, Vec<String>) {
        let (mut all, mut left_out) = (Vec::new(), Vec::new());
        for name in self.names() {
            match self.painted_as(&name, canvas) {
                Ok(painted) => all.extend(painted),
                Err(why) => left_out.push(format!("{name} of {path}: {why}")),
            }
        }
        (all, left_out)
    }

    fn painted_as(&mut self, name: &str, canvas: Canvas<'_>) -> Result<Option<Painted>, Problem> {
        // Those of the schema are no weights.
        let Some(header) = self.header(name).filter(|_| !OF_SCHEMA.contains(&name)) else { return Ok(None) };
        let on = match header.detail("geoScope") {
            Some("fvr") => PaintedOn::Corners,
            Some("vtx" | "var") => PaintedOn::Vertices,
            _ => return Ok(None),
        };
        if let Some(why) = self.misindexed(name)? {
            return Err(Problem::new(why));
        }
        let Some(whatever) = self.whatever(name)? else { return Ok(None) };
        Painted::of(name, &whatever, on, canvas, self.budget())
    }

    fn stored(&mut self, name: &str) -> Result<Option<Sample>, Problem> {
        let Some(header) = self.header(name).cloned() else { return Ok(None) };
        let header = &header;
        let (role, per) = (role(header), per(header));
        if header.form != PropertyKind::Compound {
            let bytes = self.tree.sample(header, self.frame)?;
            return Ok(Some(Sample { kind: header.kind, role, per, bytes, indices: None }));
        }
        let inside = self.tree.properties(header.place)?;
        let part = |part: &str| {
            let found = inside.iter().find(|h| &*h.name == part && h.form != PropertyKind::Compound);
            found.ok_or_else(|| Problem(format!("attribute {name}: has no {part}")))
        };
        let (values, indices) = (part(".vals")?, part(".indices")?);
        let bytes = self.tree.sample(values, self.frame)?;
        let indices = integers(indices.kind, &self.tree.sample(indices, self.frame)?)?;
        Ok(Some(Sample { kind: values.kind, role, per, bytes, indices: Some(indices) }))
    }
}

impl Sample {
    fn is_text(&self) -> bool {
        matches!(self.kind.pod, Pod::Text | Pod::WideText)
    }

    fn expanded<T: Clone>(&self, name: &str, values: Vec<T>, budget: &Budget) -> Result<Option<Vec<T>>, Problem> {
        match &self.indices {
            Some(indices) => {
                budget.take_list::<T>(indices.len(), name)?;
                indexed(name, &values, indices).map(Some)
            }
            None => Ok(Some(values)),
        }
    }
}

fn role(header: &Header) -> Role {
    match (header.detail("interpretation"), header.kind.extent) {
        (Some("rgb" | "rgba"), _) => Role::Colour,
        (Some("point"), _) => Role::Point,
        (Some("normal"), _) => Role::Normal,
        (Some("vector"), 2) => Role::TextureCoordinate,
        (Some("vector"), _) => Role::Vector,
        _ => Role::Plain,
    }
}

fn per(header: &Header) -> Option<Per> {
    match header.detail("geoScope") {
        Some("con") => Some(Per::Groom),
        Some("uni") => Some(Per::Strand),
        Some("vtx") => Some(Per::Point),
        _ => None,
    }
}

impl<R: Read + Seek> NamedValues for Parameters<'_, R> {
    fn budget(&self) -> &Budget {
        self.tree.budget()
    }

    fn misindexed(&mut self, name: &str) -> Result<Option<&'static str>, Problem> {
        let compound = self.header(name).is_some_and(|h| h.form == PropertyKind::Compound);
        let Some(sample) = (if compound { self.stored(name)? } else { None }) else { return Ok(None) };
        let size = sample.kind.pod.size() * usize::from(sample.kind.extent);
        let count = if sample.is_text() { words(sample.kind, &sample.bytes).len() } else { sample.bytes.len() / size };
        Ok(sample.indices.and_then(|indices| misindexed(&indices, count)))
    }

    fn names(&self) -> Vec<String> {
        let carried = |&(i, h): &(usize, &Header)| i >= self.of_schema || OF_SCHEMA.contains(&&*h.name);
        let first = |&(i, h): &(usize, &Header)| self.named.get(&h.name) == Some(&i);
        let all = self.headers.iter().enumerate().filter(carried).filter(first);
        all.map(|(_, h)| h.name.to_string()).collect()
    }

    fn whatever(&mut self, name: &str) -> Result<Option<Whatever>, Problem> {
        let Some(Sample { kind, role, per, bytes, indices }) = self.stored(name)? else { return Ok(None) };
        let mut values = match kind.pod {
            Pod::F16 | Pod::F32 => Values::Floats(singles(kind, &bytes)?),
            Pod::F64 => Values::Doubles(doubles(kind, &bytes)?),
            Pod::Text => Values::Words(words(kind, &bytes)),
            Pod::WideText => return Ok(None),
            _ => Values::Integers(integers(kind, &bytes)?),
        };
        let extent = usize::from(kind.extent);
        if let Some(indices) = indices {
            self.tree.budget().take_values(&values, extent, &indices, name)?;
            values = indexed_values(name, &values, extent, &indices)?;
        }
        // Alembic has lists only: one value for all is as good as a value that is none.
        let single = per == Some(Per::Groom) && values.len() == extent;
        Ok(Some(Whatever { role, extent, stored: stored(kind.pod), single, per, values }))
    }

    fn tuples<const N: usize>(&mut self, name: &str) -> Result<Option<Vec<[f32; N]>>, Problem> {
        let Some(stored) = self.stored(name)? else { return Ok(None) };
        let extent = usize::from(stored.kind.extent);
        if stored.is_text() || extent < N {
            return Ok(None);
        }
        // Blender writes colours with an alpha; only what comes before it is kept.
        let numbers = singles(stored.kind, &stored.bytes)?;
        let values = numbers.chunks_exact(extent).map(|v| std::array::from_fn(|i| v[i])).collect();
        stored.expanded(name, values, self.tree.budget())
    }

    fn integers(&mut self, name: &str) -> Result<Option<Vec<i64>>, Problem> {
        match self.stored(name)? {
            Some(stored) if stored.kind.extent == 1 && !stored.is_text() => {
                let values = match stored.kind.pod {
                    Pod::F16 | Pod::F32 | Pod::F64 => whole(&doubles(stored.kind, &stored.bytes)?),
                    _ => Some(integers(stored.kind, &stored.bytes)?),
                };
                values.map_or(Ok(None), |values| stored.expanded(name, values, self.tree.budget()))
            }
            _ => Ok(None),
        }
    }

    fn words(&mut self, name: &str) -> Result<Option<Vec<String>>, Problem> {
        match self.stored(name)? {
            Some(stored) => {
                let values = words(stored.kind, &stored.bytes);
                if let Some(indices) = &stored.indices {
                    self.tree.budget().take_words(&values, indices, name)?;
                }
                stored.expanded(name, values, self.tree.budget())
            }
            None => Ok(None),
        }
    }
}
