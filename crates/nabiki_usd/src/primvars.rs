//! What a prim of curves carries, and what of it is not read.

use nabiki::hair::{Per, Role, Stored, Values};
use nabiki_exchange::attributes::{NamedValues, Whatever, indexed, indexed_values, misindexed, whole};
use nabiki_exchange::{Budget, Hidden};

use crate::Problem;
use crate::opened::Layer;
use crate::shown::hidden;
use crate::source::{AttributeInfo, Handle, Name};

/// What a prim carries at a time code: its primvars, and `widths`, which is an attribute of its own.
pub struct Primvars<'a> {
    /// The layer.
    pub layer: &'a mut Layer,
    /// The prim.
    pub prim: usize,
    /// The time code.
    pub time: f64,
    /// The frame that this is.
    pub frame: usize,
    /// Whether the points hang on joints: what says how is obeyed, then, and is no primvar of theirs any more.
    pub is_bound: bool,
}

/// Attributes of curves that are read elsewhere, or say nothing of the hair.
const KNOWN: [&str; 11] = [
    "points",
    "curveVertexCounts",
    "type",
    "basis",
    "wrap",
    "widths",
    "extent",
    "velocities",
    "visibility",
    "purpose",
    "xformOpOrder",
];

/// Whether a property, or a primvar, says how a prim is bound to a skeleton.
fn is_of_bond(name: &str) -> bool {
    name.strip_prefix("primvars:").unwrap_or(name).starts_with("skel:")
}

/// What is called in the budget what is said of what is not read.
const LINES: &str = "notes on what is not read";

impl Primvars<'_> {
    /// What the prim says of itself that is not read, a phrase each.
    pub fn unread(&mut self) -> Result<Vec<String>, Problem> {
        let mut marks: Vec<String> = hidden(self.layer, self.prim)?.iter().map(Hidden::kept).collect();
        let prim = &self.layer.prims[self.prim];
        let other = |name: &&Name| {
            !KNOWN.contains(&name.as_str()) && !name.starts_with("primvars:") && !name.starts_with("xformOp:")
        };
        let of_bond = |name: &str| self.is_bound && is_of_bond(name);
        let mut unread: Vec<String> = prim
            .authored()
            .map(|(name, _)| name)
            .filter(|name| other(name) && !of_bond(name))
            .map(|name| format!("attribute {name}"))
            .collect();
        let moving = prim
            .authored()
            .filter(|(name, a)| (name.starts_with("primvars:") || name.as_str() == "widths") && a.samples.len() > 1);
        let frame = self.frame;
        unread.extend(moving.map(|(name, _)| format!("motion of {name}: its value in frame {frame} is kept")));
        let splines = prim.attributes.iter().filter(|(name, a)| name.starts_with("primvars:") && a.has_spline);
        unread.extend(splines.map(|(name, _)| format!("the spline of {name}")));
        unread.append(&mut marks);
        for above in self.layer.upward(self.prim) {
            if !self.layer.standing[above].says {
                continue;
            }
            let path = self.layer.path(above);
            let mut say = |name: &Name, end: &str| {
                let line = format!("{name} of {path}{end}");
                self.layer.budget.take(line.len() as u64, LINES)?;
                unread.push(line);
                Ok::<_, Problem>(())
            };
            let prim = &self.layer.prims[above];
            let names = prim.authored().map(|(name, _)| name).filter(|_| above != self.prim);
            let mut inherited =
                names.filter(|name| name.starts_with("primvars:") && !name.ends_with(":indices") && !of_bond(name));
            inherited.try_for_each(|name| say(name, ", which is above it"))?;
            prim.related().filter(|name| !of_bond(name)).try_for_each(|name| say(name, ""))?;
        }
        let letters: usize = unread.iter().map(|line| size_of::<String>() + line.len()).sum();
        self.layer.budget.take(letters as u64, LINES)?;
        unread.sort();
        Ok(unread)
    }

    fn named(&self, name: &str) -> Option<Handle> {
        self.typed(name).map(|(handle, _)| handle)
    }

    /// The values of a name and their type.
    fn typed(&self, name: &str) -> Option<(Handle, &str)> {
        let of = |whole: &str| {
            let handle = self.layer.at(self.prim, whole, self.time)?;
            Some((handle, self.layer.prims[self.prim].attributes.get(whole)?.type_name.as_str()))
        };
        // The primvar wins over the attribute of its name.
        of(&format!("primvars:{name}")).or_else(|| if name == "widths" { of(name) } else { None })
    }

    /// Values that are numbers, and what they are made of.
    fn numeric(&self, name: &str) -> Option<(Handle, Kind)> {
        let (handle, type_name) = self.typed(name)?;
        let kind = kind(type_name).filter(|kind| !matches!(kind.stored, Stored::Text | Stored::Token))?;
        Some((handle, kind))
    }

    fn indices(&mut self, name: &str) -> Result<Option<Vec<i64>>, Problem> {
        let indices = self.layer.at(self.prim, &format!("primvars:{name}:indices"), self.time);
        indices.map(|indices| self.layer.integers(indices)).transpose()
    }

    /// Values, looked up where they are stored by index.
    fn expanded<T: Clone>(&mut self, name: &str, values: Vec<T>) -> Result<Option<Vec<T>>, Problem> {
        match self.indices(name)? {
            Some(indices) => {
                self.layer.budget.take_list::<T>(indices.len(), name)?;
                indexed(name, &values, &indices).map(Some)
            }
            None => Ok(Some(values)),
        }
    }
}

impl NamedValues for Primvars<'_> {
    fn budget(&self) -> &Budget {
        &self.layer.budget
    }

    fn misindexed(&mut self, name: &str) -> Result<Option<&'static str>, Problem> {
        let (Some(indices), Some(handle)) = (self.indices(name)?, self.named(name)) else { return Ok(None) };
        let type_name =
            &self.layer.prims[self.prim].attributes.get(format!("primvars:{name}").as_str()).map(|a| &a.type_name);
        let count = match type_name.and_then(|name| kind(name)) {
            Some(Kind { stored: Stored::Text | Stored::Token, .. }) => self.layer.words(handle)?.len(),
            Some(Kind { extent, .. }) => self.layer.count(handle, extent)?,
            None => return Ok(None),
        };
        Ok(misindexed(&indices, count))
    }

    fn names(&self) -> Vec<String> {
        // Of a spline there is no value, which is said.
        let has_value =
            |(name, a): &(&Name, &AttributeInfo)| a.has_spline || self.layer.at(self.prim, name, self.time).is_some();
        let attributes = self.layer.prims[self.prim].authored().filter(has_value);
        let names = attributes.filter_map(|(name, _)| name.strip_prefix("primvars:"));
        let names = names.filter(|name| !(self.is_bound && is_of_bond(name)));
        names.filter(|name| !name.ends_with(":indices")).map(str::to_owned).collect()
    }

    fn is_wider(&self, name: &str, read: usize) -> bool {
        self.numeric(name).is_some_and(|(_, kind)| kind.extent > read)
    }

    fn tuples<const N: usize>(&mut self, name: &str) -> Result<Option<Vec<[f32; N]>>, Problem> {
        let Some((handle, Kind { extent, .. })) = self.numeric(name) else { return Ok(None) };
        // Colours may have an alpha, and texture coordinates a third number.
        if extent != N && (N == 1 || extent != N + 1) {
            return Ok(None);
        }
        let numbers = self.layer.singles(handle)?;
        if numbers.is_empty() || !numbers.len().is_multiple_of(extent) {
            return Ok(None);
        }
        let values = numbers.chunks_exact(extent).map(|v| std::array::from_fn(|i| v[i])).collect();
        self.expanded(name, values)
    }

    fn integers(&mut self, name: &str) -> Result<Option<Vec<i64>>, Problem> {
        let Some((handle, kind)) = self.numeric(name).filter(|(_, kind)| kind.extent == 1) else { return Ok(None) };
        let values = match kind.stored {
            Stored::F16 | Stored::F32 | Stored::F64 => whole(&self.layer.numbers(handle)?),
            _ => Some(self.layer.integers(handle)?),
        };
        values.map_or(Ok(None), |values| self.expanded(name, values))
    }

    fn words(&mut self, name: &str) -> Result<Option<Vec<String>>, Problem> {
        let Some(handle) = self.named(name) else { return Ok(None) };
        let values = self.layer.words(handle)?;
        if let Some(indices) = self.indices(name)? {
            self.layer.budget.take_words(&values, &indices, name)?;
        }
        self.expanded(name, values)
    }

    fn whatever(&mut self, name: &str) -> Result<Option<Whatever>, Problem> {
        let whole = format!("primvars:{name}");
        let Some(handle) = self.layer.at(self.prim, &whole, self.time) else { return Ok(None) };
        let attribute = &self.layer.prims[self.prim].attributes[whole.as_str()];
        let single = !attribute.is_array;
        let Some(Kind { stored, role, extent }) = kind(&attribute.type_name) else { return Ok(None) };
        let mut values = match stored {
            Stored::F16 | Stored::F32 => Values::Floats(self.layer.singles(handle)?),
            Stored::F64 => Values::Doubles(self.layer.numbers(handle)?),
            Stored::Text | Stored::Token => Values::Words(self.layer.words(handle)?),
            _ => Values::Integers(self.layer.integers(handle)?),
        };
        if let Some(indices) = self.indices(name)? {
            self.layer.budget.take_values(&values, extent, &indices, name)?;
            values = indexed_values(name, &values, extent, &indices)?;
        }
        let per = match self.layer.interpolation(self.prim, &whole)?.as_deref() {
            Some("constant") => Some(Per::Groom),
            Some("uniform") => Some(Per::Strand),
            Some("vertex") => Some(Per::Point),
            _ => None,
        };
        Ok(Some(Whatever { role, extent, stored, single, per, values }))
    }
}

/// What a value of a type is made of.
pub struct Kind {
    /// How a number or word is stored.
    pub stored: Stored,
    /// What the numbers stand for.
    pub role: Role,
    /// Numbers or words that make a value.
    pub extent: usize,
}

/// USD's longest vectors, and the sides of its largest matrices.
const MOST_PARTS: usize = 4;

/// What a type is made of: `color3f` is three floats that make a colour. `None` for a type that is not read.
pub fn kind(type_name: &str) -> Option<Kind> {
    use Stored::{Bool, F16, F32, F64, I32, I64, Text, Token, U8, U32, U64};
    let split = type_name.find(|c: char| c.is_ascii_digit()).unwrap_or(type_name.len());
    let (base, rest) = match type_name {
        // Digits of which these two are the width and not the extent.
        "int64" | "uint64" => (type_name, ""),
        _ => type_name.split_at(split),
    };
    let extent = match rest.trim_end_matches(['f', 'h', 'd']) {
        "" => 1,
        digits => digits.parse::<usize>().ok().filter(|extent| (1..=MOST_PARTS).contains(extent))?,
    };
    let precision = match rest.chars().last() {
        Some('d') => F64,
        Some('h') => F16,
        _ => F32,
    };
    let (stored, role, extent) = match base {
        "bool" => (Bool, Role::Plain, extent),
        "uchar" => (U8, Role::Plain, extent),
        "int" => (I32, Role::Plain, extent),
        "uint" => (U32, Role::Plain, extent),
        "int64" => (I64, Role::Plain, extent),
        "uint64" => (U64, Role::Plain, extent),
        "half" => (F16, Role::Plain, extent),
        "float" => (F32, Role::Plain, extent),
        "double" => (F64, Role::Plain, extent),
        "string" => (Text, Role::Plain, 1),
        "token" => (Token, Role::Plain, 1),
        "color" => (precision, Role::Colour, extent),
        "point" => (precision, Role::Point, extent),
        "vector" => (precision, Role::Vector, extent),
        "normal" => (precision, Role::Normal, extent),
        "texCoord" => (precision, Role::TextureCoordinate, extent),
        // Four numbers in a row would come back as a double4.
        "matrix" if extent > 2 => (F64, Role::Plain, extent * extent),
        _ => return None,
    };
    Some(Kind { stored, role, extent })
}
