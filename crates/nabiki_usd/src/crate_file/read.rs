//! Reading of binary layers, with nothing believed that the file's size contradicts.

use std::collections::HashMap;
use std::io::{Read, Seek, SeekFrom};

use glam::Vec3;

use super::integers::{most_integers, unpack, unpack_integers};
use super::numbers::{Scalar, inlined, shape};
use super::{END_OF_SET, HEADER, MAGIC, Rep, specs, types};
use crate::Problem;
use crate::arcs;
use crate::source::{AttributeInfo, BLOCKED, Handle, PrimInfo, SKEL_BINDING};

/// Arrays shorter than this are not packed even where they say so.
const SHORTEST_PACKED: usize = 16;
/// Elements of an array that a file of any size may have.
const MANY: u64 = 1 << 24;

/// The values of a binary layer.
pub struct CrateReader<R> {
    from: R,
    size: u64,
    version: [u8; 3],
    tokens: Vec<String>,
    strings: Vec<u32>,
    /// Prims by the numbers of their paths.
    pub(super) prim_of_path: HashMap<usize, usize>,
}

/// What a path names, before prims and attributes are told apart.
struct Node {
    /// Number by which specs know it.
    path: usize,
    parent: Option<usize>,
    token: usize,
    is_property: bool,
}

type Opened<R> = (CrateReader<R>, Vec<PrimInfo>, HashMap<String, Handle>);

impl<R: Read + Seek> CrateReader<R> {
    /// Reads the tables.
    pub fn new(from: R, size: u64) -> Result<Opened<R>, Problem> {
        let (version, prim_of_path) = ([0; 3], HashMap::new());
        let mut reader = Self { from, size, version, tokens: Vec::new(), strings: Vec::new(), prim_of_path };
        let header = reader.bytes(0, HEADER as u64)?;
        if header[..8] != *MAGIC {
            return Err(Problem::new("is no binary USD layer"));
        }
        reader.version = [header[8], header[9], header[10]];
        if reader.version[0] != 0 || reader.version < [0, 4, 0] {
            let [a, b, c] = reader.version;
            return Err(Problem(format!("is a binary layer of version {a}.{b}.{c}; 0.4.0 to 0.13.x are read")));
        }
        let list = number(&header[16..24]);
        let count = number(&reader.bytes(list, 8)?);
        if count > 64 {
            return Err(Problem(format!("claims {count} tables, of which USD has 6")));
        }
        let mut sections = HashMap::new();
        for entry in reader.bytes(list + 8, 32 * count)?.chunks_exact(32) {
            let name = String::from_utf8_lossy(&entry[..16]).trim_end_matches('\0').to_owned();
            sections.insert(name, (number(&entry[16..24]), number(&entry[24..32])));
        }
        let mut section = |reader: &mut Self, name: &str| {
            let (start, length) = sections.remove(name).ok_or_else(|| Problem(format!("has no table {name}")))?;
            Ok::<_, Problem>(Table { bytes: reader.bytes(start, length)?, at: 0, most: most_integers(size) })
        };

        let mut table = section(&mut reader, "TOKENS")?;
        reader.tokens = tokens(&mut table)?;
        let mut table = section(&mut reader, "STRINGS")?;
        let count = table.count()?;
        reader.strings =
            table.take(4 * count)?.chunks_exact(4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect();
        let mut table = section(&mut reader, "FIELDS")?;
        let count = table.count()?;
        let names = table.integers(count)?;
        let reps = table.packed(8 * count)?;
        let fields: Vec<(usize, u64)> =
            names.iter().map(|&n| n as usize).zip(reps.chunks_exact(8).map(number)).collect();
        let mut table = section(&mut reader, "FIELDSETS")?;
        let count = table.count()?;
        let sets = table.integers(count)?;
        let mut table = section(&mut reader, "PATHS")?;
        let nodes = paths(&mut table)?;
        let mut table = section(&mut reader, "SPECS")?;
        let count = table.count()?;
        let (spec_paths, spec_sets, spec_kinds) =
            (table.integers(count)?, table.integers(count)?, table.integers(count)?);

        let mut of_path = HashMap::new();
        for ((&path, &set), &kind) in spec_paths.iter().zip(&spec_sets).zip(&spec_kinds) {
            of_path.insert(path as usize, (set as usize, kind as u32));
        }
        let set_fields = |set: usize| {
            let numbers = sets.get(set..).unwrap_or_default();
            numbers.iter().take_while(|&&f| f as u32 != END_OF_SET).filter_map(|&f| fields.get(f as usize)).copied()
        };
        let mut layer = (Vec::new(), HashMap::new());
        let mut prim_of_node: HashMap<usize, usize> = HashMap::new();
        // Fields are listed once a spec, and sets may share them: more in all than this is a file that repeats itself.
        let mut budget = 16 * (fields.len() + nodes.len()) + 1024;
        for (i, node) in nodes.iter().enumerate() {
            let Some(&(set, kind)) = of_path.get(&node.path) else { continue };
            let named: Vec<(&str, u64)> = set_fields(set)
                .take(budget)
                .map(|(name, rep)| (reader.tokens.get(name).map_or("", String::as_str), rep))
                .collect();
            budget = budget
                .checked_sub(named.len() + 1)
                .ok_or_else(|| Problem::new("names its fields over and over: it must be damaged"))?;
            let field = |wanted: &str| named.iter().find(|(name, _)| *name == wanted).map(|&(_, rep)| rep);
            let word = |rep: Option<u64>| rep.map(|r| reader.token(Rep(r).payload())).unwrap_or_default();
            let name = reader.tokens.get(node.token).cloned().unwrap_or_default();
            match kind {
                specs::LAYER => {
                    layer.1.extend(named.iter().map(|&(name, rep)| (name.to_owned(), (rep, 0))));
                }
                specs::PRIM if !node.is_property => {
                    let above = node.parent.filter(|&p| nodes[p].parent.is_some());
                    let parent = above.and_then(|p| prim_of_node.get(&p).copied());
                    // In a variant.
                    if above.is_some() && parent.is_none() {
                        continue;
                    }
                    let type_name = word(field("typeName"));
                    prim_of_node.insert(i, layer.0.len());
                    reader.prim_of_path.insert(node.path, layer.0.len());
                    const OVER: u64 = 1;
                    const CLASS: u64 = 2;
                    let is = |name: &str, value: u64| field(name).is_some_and(|rep| Rep(rep).payload() == value);
                    let is_off_stage = is("specifier", CLASS) || is("active", 0);
                    let (is_over, is_instance) = (is("specifier", OVER), is("instanceable", 1));
                    let schemas = field("apiSchemas");
                    let named_arcs = arcs::OF_PRIMS.map(|(arc, name)| (arc, field(name)));
                    let mut arcs = Vec::new();
                    for (arc, rep) in named_arcs {
                        if let Some(rep) = rep
                            && reader.holds_any(rep)?
                        {
                            arcs.push(arc);
                        }
                    }
                    let schemas = schemas.map(|rep| reader.list_items(rep)).transpose()?.unwrap_or_default();
                    let is_bound = schemas.into_iter().any(|schema| reader.token(schema.into()) == SKEL_BINDING);
                    let prim = PrimInfo { name, type_name, is_off_stage, is_over, parent, arcs, ..PrimInfo::default() };
                    layer.0.push(PrimInfo { is_instance, is_bound, ..prim });
                }
                specs::ATTRIBUTE => {
                    let Some(&prim) = node.parent.and_then(|p| prim_of_node.get(&p)) else { continue };
                    let default = field("default").map(value);
                    let type_name = word(field("typeName"));
                    let is_array = type_name.ends_with("[]");
                    let type_name = type_name.trim_end_matches("[]").to_owned();
                    let interpolation = field("interpolation").map(|rep| (rep, 0));
                    let has_spline = field("spline").is_some();
                    let samples = field("timeSamples");
                    let samples = samples.map(|rep| reader.samples(Rep(rep))).transpose()?.unwrap_or_default();
                    let read = AttributeInfo { type_name, is_array, default, has_spline, samples, interpolation };
                    let prim: &mut PrimInfo = &mut layer.0[prim];
                    prim.attributes.insert(name, read);
                }
                specs::RELATIONSHIP => {
                    let Some(&prim) = node.parent.and_then(|p| prim_of_node.get(&p)) else { continue };
                    if let Some(rep) = field("targetPaths") {
                        let targets = if reader.holds_any(rep)? { (rep, 0) } else { BLOCKED };
                        layer.0[prim].relationships.push((name, targets));
                    }
                }
                _ => {}
            }
        }
        Ok((reader, layer.0, layer.1))
    }

    /// Time codes and values of an attribute.
    fn samples(&mut self, rep: Rep) -> Result<Vec<(f64, Handle)>, Problem> {
        if rep.kind() != types::TIME_SAMPLES || rep.is_inlined() {
            return Err(Problem::new("has time samples of an unknown form"));
        }
        let beyond = || Problem::new("has time samples past its end");
        // Two parts, each named by its distance from the number that names it.
        let first = rep.payload();
        let times_at = first.checked_add(number(&self.bytes(first, 8)?)).ok_or_else(beyond)?;
        let times = Rep(number(&self.bytes(times_at, 8)?));
        let second = times_at + 8;
        let values_at = second.checked_add(number(&self.bytes(second, 8)?)).ok_or_else(beyond)?;
        let count = number(&self.bytes(values_at, 8)?);
        let values = self.bytes(values_at + 8, count.checked_mul(8).ok_or_else(beyond)?)?;
        let times = self.numbers(times.0)?;
        if times.len() as u64 != count {
            return Err(Problem(format!("has {} times for {count} samples", times.len())));
        }
        let mut found: Vec<(f64, Handle)> =
            times.into_iter().zip(values.chunks_exact(8).map(|b| value(number(b)))).collect();
        if found.iter().any(|(t, _)| !t.is_finite()) {
            return Err(Problem::new("has a time code that is not finite"));
        }
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        Ok(found)
    }

    /// All numbers of a value in a row; nothing for values that are not numbers.
    pub fn numbers(&mut self, rep: u64) -> Result<Vec<f64>, Problem> {
        let rep = Rep(rep);
        let Some((scalar, extent)) = shape(rep.kind()) else { return Ok(Vec::new()) };
        if rep.is_inlined() {
            return Ok(inlined(rep, scalar, extent));
        }
        if !rep.is_array() && rep.kind() != types::DOUBLE_VECTOR {
            let bytes = self.bytes(rep.payload(), (scalar.size() * extent) as u64)?;
            return Ok(scalar.numbers(&bytes));
        }
        if rep.payload() == 0 {
            return Ok(Vec::new());
        }
        let (count, place) = self.array_count(rep)?;
        if rep.is_compressed() && count >= SHORTEST_PACKED {
            return self.packed_numbers(scalar, count * extent, place);
        }
        let bytes = self.bytes(place, (count as u64).saturating_mul((scalar.size() * extent) as u64))?;
        Ok(scalar.numbers(&bytes))
    }

    /// As [`numbers`](Self::numbers) in single precision; arrays of singles are only copied.
    pub fn singles(&mut self, rep: u64) -> Result<Vec<f32>, Problem> {
        let found = Rep(rep);
        let plain = found.is_array() && !found.is_inlined() && !found.is_compressed() && found.payload() != 0;
        if let (true, Some((Scalar::F32, extent))) = (plain, shape(found.kind())) {
            let (count, place) = self.array_count(found)?;
            let bytes = self.bytes(place, (count as u64).saturating_mul(4 * extent as u64))?;
            return Ok(bytes.as_chunks::<4>().0.iter().map(|&b| f32::from_le_bytes(b)).collect());
        }
        Ok(self.numbers(rep)?.into_iter().map(|x| x as f32).collect())
    }

    /// As [`singles`](Self::singles) for points, read where they will stay if they are stored as they are wanted.
    pub fn points(&mut self, rep: u64) -> Result<Vec<Vec3>, Problem> {
        let found = Rep(rep);
        let plain = found.is_array() && !found.is_inlined() && !found.is_compressed() && found.payload() != 0;
        if !plain || found.kind() != types::VEC3F || cfg!(target_endian = "big") {
            return Ok(self.singles(rep)?.as_chunks::<3>().0.iter().map(|&p| Vec3::from(p)).collect());
        }
        let (count, place) = self.array_count(found)?;
        self.go_to(place, (count as u64).saturating_mul(12))?;
        let mut points = bytemuck::zeroed_vec(count);
        self.from.read_exact(bytemuck::cast_slice_mut(&mut points))?;
        Ok(points)
    }

    /// As [`numbers`](Self::numbers) in whole numbers; those of 64 bits keep these, signed or not.
    pub fn integers(&mut self, rep: u64) -> Result<Vec<i64>, Problem> {
        let found = Rep(rep);
        let is_wide = matches!(found.kind(), types::INT64 | types::UINT64);
        if !is_wide || found.is_inlined() || (found.is_array() && found.payload() == 0) {
            return Ok(self.numbers(rep)?.into_iter().map(|x| x as i64).collect());
        }
        let (count, place) = if found.is_array() { self.array_count(found)? } else { (1, found.payload()) };
        if found.is_compressed() && count >= SHORTEST_PACKED {
            return unpack_integers::<8>(&self.sized(place)?, count).map_err(Problem);
        }
        let bytes = self.bytes(place, (count as u64).saturating_mul(8))?;
        Ok(bytes.as_chunks::<8>().0.iter().map(|&b| i64::from_le_bytes(b)).collect())
    }

    /// All words of a value; nothing for values that are not words.
    pub fn words(&mut self, rep: u64) -> Result<Vec<String>, Problem> {
        let rep = Rep(rep);
        let word = |reader: &Self, index: u64| match rep.kind() {
            types::STRING => {
                let token = reader.strings.get(index as usize).map_or(u64::MAX, |&t| u64::from(t));
                reader.token(token)
            }
            _ => reader.token(index),
        };
        if !matches!(rep.kind(), types::STRING | types::TOKEN | types::TOKEN_VECTOR) {
            return Ok(Vec::new());
        }
        if rep.is_inlined() {
            return Ok(vec![word(self, rep.payload())]);
        }
        if rep.payload() == 0 {
            return Ok(Vec::new());
        }
        let (count, place) = self.array_count(rep)?;
        let bytes = self.bytes(place, 4 * count as u64)?;
        let indices = bytes.as_chunks::<4>().0;
        let mut budget = 64 * self.size as usize + 4096;
        let mut words = Vec::with_capacity(indices.len());
        for &index in indices {
            let word = word(self, u64::from(u32::from_le_bytes(index)));
            budget = budget
                .checked_sub(word.len())
                .ok_or_else(|| Problem::new("repeats long words more often than any honest file"))?;
            words.push(word);
        }
        Ok(words)
    }

    /// Number of elements of an array, and where they begin.
    fn array_count(&mut self, rep: Rep) -> Result<(usize, u64), Problem> {
        let place = rep.payload();
        let wide = self.version >= [0, 7, 0] || !rep.is_array();
        let (count, start) = if wide {
            (number(&self.bytes(place, 8)?), place + 8)
        } else {
            // Before 0.5.0 a number of dimensions, always 1, came first.
            let skip = if self.version < [0, 5, 0] { 4 } else { 0 };
            let bytes = self.bytes(place + skip, 4)?;
            (u64::from(u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]])), place + skip + 4)
        };
        // Packed numbers that are all alike take next to nothing, and a layer may hold nothing else. Many of them stand beside points, which
        // are not packed: each takes six bytes at least, and about a vertex of a closed mesh six corners lie.
        if count > most_integers(self.size).min(self.size.max(MANY)) {
            let size = self.size;
            return Err(Problem(format!(
                "claims {count} elements at byte {place}, more than a file of {size} bytes has"
            )));
        }
        Ok((count as usize, start))
    }

    fn packed_numbers(&mut self, scalar: Scalar, count: usize, place: u64) -> Result<Vec<f64>, Problem> {
        match scalar {
            Scalar::I32 | Scalar::U32 => {
                let found = unpack_integers::<4>(&self.sized(place)?, count).map_err(Problem)?;
                let unsigned = scalar == Scalar::U32;
                Ok(found.into_iter().map(|x| if unsigned { f64::from(x as u32) } else { x as f64 }).collect())
            }
            Scalar::I64 | Scalar::U64 => {
                let found = unpack_integers::<8>(&self.sized(place)?, count).map_err(Problem)?;
                Ok(found.into_iter().map(|x| x as f64).collect())
            }
            Scalar::F16 | Scalar::F32 | Scalar::F64 => match self.bytes(place, 1)?[0] {
                b'i' => {
                    let found = unpack_integers::<4>(&self.sized(place + 1)?, count).map_err(Problem)?;
                    Ok(found.into_iter().map(|x| x as f64).collect())
                }
                b't' => {
                    let bytes = self.bytes(place + 1, 4)?;
                    let length = u64::from(u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]));
                    let length = length * scalar.size() as u64;
                    let values = scalar.numbers(&self.bytes(place + 5, length)?);
                    let indices = unpack_integers::<4>(&self.sized(place + 5 + length)?, count).map_err(Problem)?;
                    let pick = |i: i64| usize::try_from(i).ok().and_then(|i| values.get(i)).copied();
                    let found: Option<Vec<f64>> = indices.into_iter().map(pick).collect();
                    found.ok_or_else(|| Problem::new("has a packed array that names values it does not have"))
                }
                code => Err(Problem(format!("has an array packed in an unknown way ({code})"))),
            },
            Scalar::U8 => Err(Problem::new("has packed bytes, which no version writes")),
        }
    }

    /// Bytes with their number before them.
    fn sized(&mut self, place: u64) -> Result<Vec<u8>, Problem> {
        let length = number(&self.bytes(place, 8)?);
        self.bytes(place + 8, length)
    }

    pub(super) fn bytes(&mut self, place: u64, length: u64) -> Result<Vec<u8>, Problem> {
        self.go_to(place, length)?;
        let mut bytes = vec![0; length as usize];
        self.from.read_exact(&mut bytes)?;
        Ok(bytes)
    }

    /// Goes to a place that has so many bytes.
    fn go_to(&mut self, place: u64, length: u64) -> Result<(), Problem> {
        if place.checked_add(length).is_none_or(|end| end > self.size) {
            return Err(Problem(format!("names {length} bytes at byte {place}, past its end ({})", self.size)));
        }
        self.from.seek(SeekFrom::Start(place))?;
        Ok(())
    }

    pub(super) fn token(&self, index: u64) -> String {
        self.tokens.get(index as usize).cloned().unwrap_or_default()
    }
}

/// A table's bytes.
struct Table {
    bytes: Vec<u8>,
    at: usize,
    /// Entries beyond which a count is a lie.
    most: u64,
}

impl Table {
    fn take(&mut self, length: usize) -> Result<&[u8], Problem> {
        let end = self.at.checked_add(length).filter(|&end| end <= self.bytes.len());
        let end = end.ok_or_else(|| Problem::new("has a table that ends too early"))?;
        let taken = &self.bytes[self.at..end];
        self.at = end;
        Ok(taken)
    }

    fn number(&mut self) -> Result<u64, Problem> {
        Ok(number(self.take(8)?))
    }

    fn count(&mut self) -> Result<usize, Problem> {
        let count = self.number()?;
        if count > self.most {
            return Err(Problem(format!("has a table of {count} entries, more than it can hold")));
        }
        Ok(count as usize)
    }

    fn integers(&mut self, count: usize) -> Result<Vec<i64>, Problem> {
        let length = self.number()?;
        unpack_integers::<4>(self.take(usize::try_from(length).unwrap_or(usize::MAX))?, count).map_err(Problem)
    }

    fn packed(&mut self, size: usize) -> Result<Vec<u8>, Problem> {
        let length = self.number()?;
        unpack(self.take(usize::try_from(length).unwrap_or(usize::MAX))?, size).map_err(Problem)
    }
}

fn tokens(table: &mut Table) -> Result<Vec<String>, Problem> {
    let count = table.count()?;
    let size = table.number()?;
    let words = table.packed(usize::try_from(size).unwrap_or(usize::MAX))?;
    let tokens: Vec<String> =
        words.split(|&b| b == 0).take(count).map(|w| String::from_utf8_lossy(w).into_owned()).collect();
    if tokens.len() < count {
        return Err(Problem(format!("has {} words where it claims {count}", tokens.len())));
    }
    Ok(tokens)
}

/// The paths, parents before what hangs below them.
fn paths(table: &mut Table) -> Result<Vec<Node>, Problem> {
    let damaged = || Problem::new("has a table of paths that contradicts itself");
    table.count()?;
    let count = table.count()?;
    let (indices, tokens, jumps) = (table.integers(count)?, table.integers(count)?, table.integers(count)?);
    let mut nodes: Vec<Node> = Vec::new();
    // Entries to visit, each with the node above it.
    let mut todo = if count == 0 { Vec::new() } else { vec![(0, None)] };
    while let Some((entry, parent)) = todo.pop() {
        if nodes.len() == count || entry >= count {
            return Err(damaged());
        }
        let (token, jump) = (tokens[entry], jumps[entry]);
        let is_property = token < 0;
        let token = token.unsigned_abs() as usize;
        nodes.push(Node { path: indices[entry] as usize, parent, token, is_property });
        if jump >= 0 {
            let sibling = if jump == 0 { entry + 1 } else { entry + jump as usize };
            todo.push((sibling, parent));
        }
        if jump > 0 || jump == -1 {
            todo.push((entry + 1, Some(nodes.len() - 1)));
        }
    }
    Ok(nodes)
}

/// What names a value, or says that there is none.
fn value(rep: u64) -> Handle {
    if Rep(rep).kind() == types::VALUE_BLOCK { BLOCKED } else { (rep, 0) }
}

pub(super) fn number(bytes: &[u8]) -> u64 {
    u64::from_le_bytes(bytes[..8].try_into().expect("eight bytes"))
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::super::integers::pack_integers;
    use super::*;

    #[test]
    fn an_array_of_very_many_elements_has_no_more_than_its_file_has_bytes() {
        // A layer of numbers that are all alike has fewer bytes than they are.
        let packed = pack_integers(&[7; 4096]);
        assert!(packed.len() < 1000);
        let read = |count: u64, size: u64| {
            let mut bytes = vec![0; HEADER];
            bytes.extend(count.to_le_bytes());
            bytes.extend((packed.len() as u64).to_le_bytes());
            bytes.extend(&packed);
            let (tokens, strings) = (Vec::new(), Vec::new());
            let (from, prim_of_path) = (Cursor::new(bytes), HashMap::new());
            let mut reader = CrateReader { from, size, version: [0, 8, 0], tokens, strings, prim_of_path };
            reader.integers(Rep::array(types::INT, HEADER as u64).0 | Rep::COMPRESSED)
        };
        assert_eq!(read(4096, 2000).unwrap(), [7; 4096]);
        let refused = read(MANY + 1, 1 << 20).unwrap_err().to_string();
        assert_eq!(refused, "claims 16777217 elements at byte 88, more than a file of 1048576 bytes has");
    }
}
