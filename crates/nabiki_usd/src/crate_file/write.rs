//! Writing of binary layers: values as they come, tables at the end.

use std::collections::HashMap;
use std::io::{self, Seek, SeekFrom, Write};

use super::integers::{pack, pack_integers};
use super::{END_OF_SET, HEADER, MAGIC, Rep, specs, types};
use crate::layer::{Attribute, Metadata, Prim, Value};

/// What a list begins with: whether it is set whole, or has items to prepend.
const IS_SET: u8 = 1;
const IS_PREPENDED: u8 = 32;

/// A binary layer being written.
pub struct CrateWriter<W> {
    to: W,
    at: u64,
    tokens: Table<String>,
    strings: Table<u32>,
    fields: Table<(u32, Rep)>,
    field_sets: Vec<u32>,
    specs: Vec<(u32, u32)>,
    paths: Paths,
}

/// Numbered entries, each once.
struct Table<T> {
    entries: Vec<T>,
    index: HashMap<T, u32>,
}

impl<T: Clone + Eq + std::hash::Hash> Table<T> {
    fn new() -> Self {
        Self { entries: Vec::new(), index: HashMap::new() }
    }

    fn add(&mut self, entry: T) -> u32 {
        if let Some(&found) = self.index.get(&entry) {
            return found;
        }
        let new = self.entries.len() as u32;
        self.entries.push(entry.clone());
        self.index.insert(entry, new);
        new
    }
}

/// The tree of paths, flattened: each entry's last token (negative for properties) and where its sibling is.
#[derive(Default)]
struct Paths {
    tokens: Vec<i32>,
    jumps: Vec<i32>,
}

impl<W: Write + Seek> CrateWriter<W> {
    /// Begins a layer.
    pub fn new(mut to: W) -> io::Result<Self> {
        to.write_all(&[0; HEADER])?;
        let mut writer = Self {
            to,
            at: HEADER as u64,
            tokens: Table::new(),
            strings: Table::new(),
            fields: Table::new(),
            field_sets: Vec::new(),
            specs: Vec::new(),
            paths: Paths::default(),
        };
        // Properties are told by the sign of their token, so none may have number 0.
        writer.tokens.add(String::new());
        Ok(writer)
    }

    /// Writes a value, so that an attribute can name it.
    pub fn value(&mut self, value: &Value) -> io::Result<Rep> {
        match value {
            Value::Token(word) => Ok(Rep::inlined(types::TOKEN, self.token(word))),
            Value::Tokens(words) => {
                let indices: Vec<u32> = words.iter().map(|w| self.token(w)).collect();
                self.array(types::TOKEN, &indices)
            }
            Value::Texts(words) => {
                let indices: Vec<u32> = words.iter().map(|w| self.string(w)).collect();
                self.array(types::STRING, &indices)
            }
            Value::Double(x) => {
                if f64::from(*x as f32) == *x {
                    Ok(Rep::inlined(types::DOUBLE, (*x as f32).to_bits()))
                } else {
                    let place = self.put(&[&x.to_le_bytes()])?;
                    Ok(Rep::at(types::DOUBLE, place))
                }
            }
            Value::Ints(values) => self.array(types::INT, values),
            Value::Longs(values) => self.array(types::INT64, values),
            Value::Floats(values) => self.array(types::FLOAT, values),
            Value::Pairs(values) => self.array(types::VEC2F, values),
            Value::Triples(values) => self.array(types::VEC3F, values),
            Value::IntTuples(extent, values) => {
                let kind = [types::INT, types::VEC2I, types::VEC3I, types::VEC4I][extent - 1];
                self.tuples(kind, *extent, values)
            }
            Value::FloatTuples(extent, values) => {
                let kind = [types::FLOAT, types::VEC2F, types::VEC3F, types::VEC4F][extent - 1];
                self.tuples(kind, *extent, values)
            }
            Value::DoubleTuples(extent, values) => {
                let kind = match extent {
                    9 => types::MATRIX3D,
                    16 => types::MATRIX4D,
                    _ => [types::DOUBLE, types::VEC2D, types::VEC3D, types::VEC4D][extent - 1],
                };
                self.tuples(kind, *extent, values)
            }
            Value::HalfTuples(extent, values) => {
                let kind = [types::HALF, types::VEC2H, types::VEC3H, types::VEC4H][extent - 1];
                let bits: Vec<u16> = values.iter().map(|x| x.to_bits()).collect();
                self.tuples(kind, *extent, &bits)
            }
            Value::Bools(values) => self.array(types::BOOL, values),
            Value::Bytes(values) => self.array(types::UCHAR, values),
            Value::Unsigned(values) => self.array(types::UINT, values),
            Value::UnsignedLongs(values) => self.array(types::UINT64, values),
            Value::Blocked => Ok(Rep::inlined(types::VALUE_BLOCK, 0)),
            Value::NoTargets => {
                let place = self.put(&[&[IS_SET]])?;
                Ok(Rep::at(types::PATH_LIST, place))
            }
            Value::One(list) => self.one(list),
            Value::Matrix(m) => {
                let place = self.put(&[bytemuck::cast_slice(m)])?;
                Ok(Rep::at(types::MATRIX4D, place))
            }
        }
    }

    /// Writes the one value of a list: in the name itself where it has four bytes at most.
    fn one(&mut self, list: &Value) -> io::Result<Rep> {
        let (kind, small) = match list {
            Value::Texts(words) => (types::STRING, Some(self.string(&words[0]))),
            Value::Tokens(words) => (types::TOKEN, Some(self.token(&words[0]))),
            Value::Bools(v) => (types::BOOL, Some(v[0].into())),
            Value::Bytes(v) => (types::UCHAR, Some(v[0].into())),
            Value::IntTuples(1, v) => (types::INT, Some(v[0].cast_unsigned())),
            Value::Unsigned(v) => (types::UINT, Some(v[0])),
            Value::HalfTuples(1, v) => (types::HALF, Some(v[0].to_bits().into())),
            Value::FloatTuples(1, v) => (types::FLOAT, Some(v[0].to_bits())),
            _ => (0, None),
        };
        if let Some(bits) = small {
            return Ok(Rep::inlined(kind, bits));
        }
        // An array is its number of elements, eight bytes, and then these.
        let array = self.value(list)?;
        Ok(Rep::at(array.kind(), array.payload() + 8))
    }

    /// Writes an array of points.
    pub fn points(&mut self, points: &[glam::Vec3]) -> io::Result<Rep> {
        self.array(types::VEC3F, points)
    }

    /// Writes the tables. `times`: time codes of the samples of every sampled attribute.
    pub fn finish(mut self, metadata: &Metadata, prims: &[Prim<Rep>], times: &[f64]) -> io::Result<W> {
        let count = (times.len() as u64).to_le_bytes();
        let place = self.put(&[&count, bytemuck::cast_slice(times)])?;
        let times = Rep::at(types::DOUBLE_VECTOR, place);

        let double = |writer: &mut Self, x: f64| writer.value(&Value::Double(x));
        let mut fields = vec![
            ("defaultPrim", Rep::inlined(types::TOKEN, self.token(&metadata.default_prim))),
            ("documentation", {
                let text = concat!("Written by Nabiki ", env!("CARGO_PKG_VERSION"));
                Rep::inlined(types::STRING, self.string(text))
            }),
            ("endTimeCode", double(&mut self, metadata.end)?),
            ("framesPerSecond", double(&mut self, metadata.frame_rate)?),
            ("metersPerUnit", double(&mut self, metadata.meters_per_unit)?),
            ("startTimeCode", double(&mut self, metadata.start)?),
            ("timeCodesPerSecond", double(&mut self, metadata.frame_rate)?),
            ("upAxis", Rep::inlined(types::TOKEN, self.token(if metadata.z_up { "Z" } else { "Y" }))),
        ];
        fields.push(("primChildren", self.names(prims.iter().map(|p| &*p.name))?));
        self.spec(specs::LAYER, &fields);
        self.paths.tokens.push(0);
        self.paths.jumps.push(if prims.is_empty() { -2 } else { -1 });
        for (i, prim) in prims.iter().enumerate() {
            self.prim(prim, times, i + 1 < prims.len())?;
        }
        self.tables()
    }

    fn prim(&mut self, prim: &Prim<Rep>, times: Rep, sibling: bool) -> io::Result<()> {
        const DEF: u32 = 0;
        const OVER: u32 = 1;
        let specifier = if prim.type_name.is_empty() { OVER } else { DEF };
        let mut fields = vec![("specifier", Rep::inlined(types::SPECIFIER, specifier))];
        if !prim.type_name.is_empty() {
            fields.push(("typeName", Rep::inlined(types::TOKEN, self.token(prim.type_name))));
        }
        if !prim.schemas.is_empty() {
            let schemas: Vec<u32> = prim.schemas.iter().map(|schema| self.token(schema)).collect();
            let count = (schemas.len() as u64).to_le_bytes();
            let place = self.put(&[&[IS_PREPENDED], &count, bytemuck::cast_slice(&schemas)])?;
            fields.push(("apiSchemas", Rep::at(types::TOKEN_LIST, place)));
        }
        if !prim.attributes.is_empty() {
            fields.push(("properties", self.names(prim.attributes.iter().map(|a| &*a.name))?));
        }
        if !prim.children.is_empty() {
            fields.push(("primChildren", self.names(prim.children.iter().map(|p| &*p.name))?));
        }
        self.spec(specs::PRIM, &fields);
        let children = prim.attributes.len() + prim.children.len();
        let entry = self.paths.tokens.len();
        let token = self.token(&prim.name) as i32;
        self.paths.tokens.push(token);
        self.paths.jumps.push(0);
        for (i, attribute) in prim.attributes.iter().enumerate() {
            self.attribute(attribute, times)?;
            let token = self.token(&attribute.name) as i32;
            self.paths.tokens.push(-token);
            self.paths.jumps.push(if i + 1 < children { 0 } else { -2 });
        }
        for (i, child) in prim.children.iter().enumerate() {
            self.prim(child, times, i + 1 < prim.children.len())?;
        }
        self.paths.jumps[entry] = match (children > 0, sibling) {
            (false, false) => -2,
            (true, false) => -1,
            (false, true) => 0,
            (true, true) => (self.paths.tokens.len() - entry) as i32,
        };
        Ok(())
    }

    fn attribute(&mut self, attribute: &Attribute<Rep>, times: Rep) -> io::Result<()> {
        if let Some(targets @ Value::NoTargets) = &attribute.value {
            let fields = [("variability", Rep::inlined(types::VARIABILITY, 1)), ("targetPaths", self.value(targets)?)];
            self.spec(specs::RELATIONSHIP, &fields);
            return Ok(());
        }
        let mut fields = vec![("typeName", Rep::inlined(types::TOKEN, self.token(attribute.type_name)))];
        if attribute.uniform {
            fields.push(("variability", Rep::inlined(types::VARIABILITY, 1)));
        }
        if let Some(word) = attribute.interpolation {
            fields.push(("interpolation", Rep::inlined(types::TOKEN, self.token(word))));
        }
        if let Some(value) = &attribute.value {
            fields.push(("default", self.value(value)?));
        }
        if !attribute.samples.is_empty() {
            // Each of the two parts is named by its distance from the number that names it.
            let next = 8i64.to_le_bytes();
            let count = (attribute.samples.len() as u64).to_le_bytes();
            let values: Vec<u64> = attribute.samples.iter().map(|r| r.0).collect();
            let place = self.put(&[&next, &times.0.to_le_bytes(), &next, &count, bytemuck::cast_slice(&values)])?;
            fields.push(("timeSamples", Rep::at(types::TIME_SAMPLES, place)));
        }
        self.spec(specs::ATTRIBUTE, &fields);
        Ok(())
    }

    /// Notes what the next path is; specs and paths are in the same order.
    fn spec(&mut self, kind: u32, fields: &[(&str, Rep)]) {
        let set = self.field_sets.len() as u32;
        for &(name, rep) in fields {
            let token = self.token(name);
            let field = self.fields.add((token, rep));
            self.field_sets.push(field);
        }
        self.field_sets.push(END_OF_SET);
        self.specs.push((set, kind));
    }

    fn token(&mut self, word: &str) -> u32 {
        // Zeros part the words of the table.
        self.tokens.add(word.replace('\0', ""))
    }

    fn string(&mut self, word: &str) -> u32 {
        let token = self.token(word);
        self.strings.add(token)
    }

    /// A list of names that keeps their order.
    fn names<'a>(&mut self, names: impl Iterator<Item = &'a str>) -> io::Result<Rep> {
        let indices: Vec<u32> = names.map(|n| self.token(n)).collect();
        let count = (indices.len() as u64).to_le_bytes();
        let place = self.put(&[&count, bytemuck::cast_slice(&indices)])?;
        Ok(Rep::at(types::TOKEN_VECTOR, place))
    }

    fn array<T: bytemuck::NoUninit>(&mut self, kind: u8, values: &[T]) -> io::Result<Rep> {
        self.tuples(kind, 1, values)
    }

    /// An array whose elements are `extent` of `values` each.
    fn tuples<T: bytemuck::NoUninit>(&mut self, kind: u8, extent: usize, values: &[T]) -> io::Result<Rep> {
        if values.is_empty() {
            return Ok(Rep::array(kind, 0));
        }
        let count = ((values.len() / extent) as u64).to_le_bytes();
        let place = self.put(&[&count, bytemuck::cast_slice(values)])?;
        Ok(Rep::array(kind, place))
    }

    fn put(&mut self, parts: &[&[u8]]) -> io::Result<u64> {
        // Readers map the file and use numbers where they lie.
        let pad = self.at.next_multiple_of(8) - self.at;
        self.to.write_all(&[0; 8][..pad as usize])?;
        let place = self.at + pad;
        self.at = place;
        for part in parts {
            self.to.write_all(part)?;
            self.at += part.len() as u64;
        }
        Ok(place)
    }

    fn tables(mut self) -> io::Result<W> {
        let words: Vec<u8> = self.tokens.entries.iter().flat_map(|t| t.bytes().chain(std::iter::once(0))).collect();
        let packed = pack(&words);
        let mut tokens = Vec::new();
        for number in [self.tokens.entries.len(), words.len(), packed.len()] {
            tokens.extend((number as u64).to_le_bytes());
        }
        tokens.extend(packed);

        let mut strings = (self.strings.entries.len() as u64).to_le_bytes().to_vec();
        strings.extend(bytemuck::cast_slice::<u32, u8>(&self.strings.entries));

        let names: Vec<u32> = self.fields.entries.iter().map(|&(token, _)| token).collect();
        let reps: Vec<u8> = self.fields.entries.iter().flat_map(|(_, rep)| rep.0.to_le_bytes()).collect();
        let mut fields = counted(names.len());
        sized(&mut fields, pack_integers(&names));
        sized(&mut fields, pack(&reps));

        let mut field_sets = counted(self.field_sets.len());
        sized(&mut field_sets, pack_integers(&self.field_sets));

        let count = self.paths.tokens.len();
        let in_order: Vec<u32> = (0..count as u32).collect();
        let unsigned = |values: &[i32]| values.iter().map(|&x| x as u32).collect::<Vec<_>>();
        let mut paths = counted(count);
        paths.extend(counted(count));
        sized(&mut paths, pack_integers(&in_order));
        sized(&mut paths, pack_integers(&unsigned(&self.paths.tokens)));
        sized(&mut paths, pack_integers(&unsigned(&self.paths.jumps)));

        let (sets, kinds): (Vec<u32>, Vec<u32>) = self.specs.iter().copied().unzip();
        let mut specs = counted(count);
        sized(&mut specs, pack_integers(&in_order));
        sized(&mut specs, pack_integers(&sets));
        sized(&mut specs, pack_integers(&kinds));

        let sections = [
            ("TOKENS", tokens),
            ("STRINGS", strings),
            ("FIELDS", fields),
            ("FIELDSETS", field_sets),
            ("PATHS", paths),
            ("SPECS", specs),
        ];
        let mut list = counted(sections.len());
        for (name, bytes) in &sections {
            let place = self.put(&[bytes])?;
            let mut padded = [0; 16];
            padded[..name.len()].copy_from_slice(name.as_bytes());
            list.extend(padded);
            list.extend(place.to_le_bytes());
            list.extend((bytes.len() as u64).to_le_bytes());
        }
        let list_at = self.put(&[&list])?;
        self.to.seek(SeekFrom::Start(0))?;
        self.to.write_all(MAGIC)?;
        self.to.write_all(&[0, 8, 0, 0, 0, 0, 0, 0])?;
        self.to.write_all(&list_at.to_le_bytes())?;
        self.to.flush()?;
        Ok(self.to)
    }
}

fn counted(count: usize) -> Vec<u8> {
    (count as u64).to_le_bytes().to_vec()
}

fn sized(to: &mut Vec<u8>, packed: Vec<u8>) {
    to.extend((packed.len() as u64).to_le_bytes());
    to.extend(packed);
}
