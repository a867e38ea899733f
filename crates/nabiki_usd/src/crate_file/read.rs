//! Reading of binary layers, with nothing believed that the file's size contradicts.

use std::cell::Cell;
use std::collections::HashMap;
use std::io::{Read, Seek, SeekFrom};
use std::rc::Rc;

use glam::Vec3;
use nabiki_exchange::Budget;

use super::integers::{most_integers, unpack_integers, unpack_integers_as};
use super::numbers::{Scalar, inlined, shape};
use super::tables::{Table, number, paths, tokens};
use super::{END_OF_SET, HEADER, MAGIC, Rep, specs, types};
use crate::Problem;
use crate::source::{
    ARCS, AttributeInfo, BLOCKED, DEEPEST, Handle, Name, PrimInfo, SKEL_BINDING, keep_prim, keep_property,
};

/// Arrays shorter than this are not packed even where they say so.
const SHORTEST_PACKED: usize = 16;

/// The values of a binary layer.
pub struct CrateReader<R> {
    from: R,
    size: u64,
    version: [u8; 3],
    tokens: Vec<Name>,
    strings: Vec<u32>,
    /// Prims by the numbers of their paths.
    pub(super) prim_of_path: HashMap<usize, usize>,
    pub(super) budget: Rc<Budget>,
}

type Opened<R> = (CrateReader<R>, Vec<PrimInfo>, HashMap<Name, Handle>);

impl<R: Read + Seek> CrateReader<R> {
    /// Reads the tables.
    pub fn new(from: R, size: u64, budget: Rc<Budget>) -> Result<Opened<R>, Problem> {
        let (version, prim_of_path) = ([0; 3], HashMap::new());
        let mut reader = Self { from, size, version, tokens: Vec::new(), strings: Vec::new(), prim_of_path, budget };
        let header = reader.bytes(0, HEADER as u64)?;
        if header[..8] != *MAGIC {
            return Err(Problem::new("is not a binary USD layer"));
        }
        reader.version = [header[8], header[9], header[10]];
        if reader.version[0] != 0 || reader.version < [0, 4, 0] {
            let [a, b, c] = reader.version;
            return Err(Problem(format!("is a binary layer of version {a}.{b}.{c}; 0.4.0 to 0.13.x are read")));
        }
        let list = number(&header[16..24]);
        let count = number(&reader.bytes(list, 8)?);
        if count > 64 {
            return Err(Problem(format!("claims {count} tables, but USD has 6")));
        }
        let mut sections = HashMap::new();
        for entry in reader.bytes(list + 8, 32 * count)?.chunks_exact(32) {
            let name = String::from_utf8_lossy(&entry[..16]).trim_end_matches('\0').to_owned();
            sections.insert(name, (number(&entry[16..24]), number(&entry[24..32])));
        }
        let mut section = |reader: &mut Self, name: &'static str| {
            let (start, length) = sections.remove(name).ok_or_else(|| Problem(format!("has no table {name}")))?;
            let bytes = reader.bytes(start, length)?;
            Ok::<_, Problem>(Table { bytes, at: 0, most: most_integers(size), name, budget: reader.budget.clone() })
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
        table.budget.take_list::<(usize, u64)>(count, table.name)?;
        let fields: Vec<(usize, u64)> =
            names.iter().map(|&n| n as u32 as usize).zip(reps.chunks_exact(8).map(number)).collect();
        let mut table = section(&mut reader, "FIELDSETS")?;
        let count = table.count()?;
        let sets = table.integers(count)?;
        let mut table = section(&mut reader, "PATHS")?;
        let nodes = paths(&mut table)?;
        let mut table = section(&mut reader, "SPECS")?;
        let count = table.count()?;
        let (spec_paths, spec_sets, spec_kinds) =
            (table.integers(count)?, table.integers(count)?, table.integers(count)?);

        // Not all numbers of paths stand in the tree: variants are named elsewhere.
        reader.budget.take_list::<[u32; 6]>(spec_paths.len(), "SPECS")?;
        let mut of_path: HashMap<u32, (u32, u32)> = HashMap::with_capacity(spec_paths.len());
        for ((&path, &set), &kind) in spec_paths.iter().zip(&spec_sets).zip(&spec_kinds) {
            of_path.insert(path as u32, (set as u32, kind as u32));
        }
        let set_fields = |set: usize| {
            let numbers = sets.get(set..).unwrap_or_default();
            numbers.iter().take_while(|&&f| f as u32 != END_OF_SET).filter_map(|&f| fields.get(f as usize)).copied()
        };
        let mut layer = (Vec::new(), HashMap::new());
        let mut prim_of_node: HashMap<usize, usize> = HashMap::new();
        // Names of types without the brackets of arrays.
        let mut types_of_values: HashMap<Name, Name> = HashMap::new();
        // Fields are listed once a spec, and sets may share them: more in all than this is a file that repeats itself.
        let mut budget = 16 * (fields.len() + nodes.len()) + 1024;
        for (i, node) in nodes.iter().enumerate() {
            let Some(&(set, kind)) = of_path.get(&node.path) else { continue };
            let set = set as usize;
            let named: Vec<(&str, u64)> = set_fields(set)
                .take(budget)
                .map(|(name, rep)| (reader.tokens.get(name).map_or("", Name::as_str), rep))
                .collect();
            budget = budget
                .checked_sub(named.len() + 1)
                .ok_or_else(|| Problem::new("repeats its fields: it must be damaged"))?;
            let field = |wanted: &str| named.iter().find(|(name, _)| *name == wanted).map(|&(_, rep)| rep);
            let word = |rep: Option<u64>| rep.map(|r| reader.token(Rep(r).payload())).unwrap_or_default();
            let name = reader.token(node.token.into());
            match kind {
                specs::LAYER => {
                    for (name, rep) in set_fields(set).take(named.len()) {
                        let name = reader.token(name as u64);
                        keep_property(&reader.budget, &name)?;
                        layer.1.insert(name, (rep, 0));
                    }
                }
                specs::PRIM if !node.is_property => {
                    if node.depth as usize > DEEPEST {
                        return Err(Problem(format!("has prims nested deeper than {DEEPEST}, deeper than any scene")));
                    }
                    keep_prim(&reader.budget, &name)?;
                    let above = node.parent.map(|p| p as usize).filter(|&p| nodes[p].parent.is_some());
                    let parent = above.and_then(|p| prim_of_node.get(&p).copied());
                    // In a variant.
                    if above.is_some() && parent.is_none() {
                        continue;
                    }
                    let type_name = word(field("typeName"));
                    prim_of_node.insert(i, layer.0.len());
                    reader.prim_of_path.insert(node.path as usize, layer.0.len());
                    const OVER: u64 = 1;
                    const CLASS: u64 = 2;
                    let is = |name: &str, value: u64| field(name).is_some_and(|rep| Rep(rep).payload() == value);
                    let is_off_stage = is("specifier", CLASS) || is("active", 0);
                    let (is_over, is_instance) = (is("specifier", OVER), is("instanceable", 1));
                    let schemas = field("apiSchemas");
                    let named_arcs = ARCS.map(|(arc, name)| (arc, field(name)));
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
                    let Some(&prim) = node.parent.and_then(|p| prim_of_node.get(&(p as usize))) else { continue };
                    keep_property(&reader.budget, &name)?;
                    let default = field("default").map(value);
                    let type_name = word(field("typeName"));
                    let is_array = type_name.ends_with("[]");
                    let type_name = types_of_values
                        .entry(type_name)
                        .or_insert_with_key(|whole| Name::from(whole.trim_end_matches("[]")));
                    let type_name = type_name.clone();
                    let interpolation = field("interpolation").map(|rep| (rep, 0));
                    let has_spline = field("spline").is_some();
                    let samples = field("timeSamples");
                    let samples = samples.map(|rep| reader.samples(Rep(rep))).transpose()?.unwrap_or_default();
                    let read = AttributeInfo { type_name, is_array, default, has_spline, samples, interpolation };
                    let prim: &mut PrimInfo = &mut layer.0[prim];
                    prim.attributes.insert(name, Box::new(read));
                }
                specs::RELATIONSHIP => {
                    let Some(&prim) = node.parent.and_then(|p| prim_of_node.get(&(p as usize))) else { continue };
                    if let Some(rep) = field("targetPaths") {
                        keep_property(&reader.budget, &name)?;
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
        self.budget.keep(count * size_of::<(f64, Handle)>() as u64 / 2, "time samples")?;
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
            return self.packed_numbers(scalar, count.saturating_mul(extent), place);
        }
        let bytes = self.bytes(place, (count as u64).saturating_mul((scalar.size() * extent) as u64))?;
        self.takes::<f64>(count * extent, bytes.len())?;
        Ok(scalar.numbers(&bytes))
    }

    /// Number of values of an array, where it says so itself; none of them is read.
    pub fn count(&mut self, rep: u64) -> Result<Option<usize>, Problem> {
        let rep = Rep(rep);
        let said = rep.is_array() && !rep.is_inlined() && rep.payload() != 0 && shape(rep.kind()).is_some();
        if said { Ok(Some(self.array_count(rep)?.0)) } else { Ok(None) }
    }

    /// Counts values of which `stored` bytes are counted already: what half of their memory is more than that, as all are read
    /// as wide as the widest of their kind.
    fn takes<T>(&self, values: usize, stored: usize) -> Result<(), Problem> {
        let half = values.saturating_mul(size_of::<T>()) / 2;
        self.budget.take(half.saturating_sub(stored) as u64, ARRAYS)
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
        self.budget.take_list::<Vec3>(count, "points")?;
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
            self.takes::<u64>(count, 0)?;
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
        // A copy of its own for each.
        let spelt = |reader: &Self, word: Name| {
            reader.budget.take((size_of::<String>() + word.len()) as u64, "words")?;
            Ok(word.to_string())
        };
        if !matches!(rep.kind(), types::STRING | types::TOKEN | types::TOKEN_VECTOR) {
            return Ok(Vec::new());
        }
        if rep.is_inlined() {
            return Ok(vec![spelt(self, word(self, rep.payload()))?]);
        }
        if rep.payload() == 0 {
            return Ok(Vec::new());
        }
        let (count, place) = self.array_count(rep)?;
        let bytes = self.bytes(place, (count as u64).saturating_mul(4))?;
        let indices = bytes.as_chunks::<4>().0.iter().map(|&index| u64::from(u32::from_le_bytes(index)));
        indices.map(|index| spelt(self, word(self, index))).collect()
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
        if count > most_integers(self.size) {
            let size = self.size;
            return Err(Problem(format!(
                "claims {count} elements at byte {place}, more than a file of {size} bytes has"
            )));
        }
        Ok((count as usize, start))
    }

    fn packed_numbers(&mut self, scalar: Scalar, count: usize, place: u64) -> Result<Vec<f64>, Problem> {
        // Numbers that are all alike take next to nothing.
        self.takes::<f64>(count, 0)?;
        match scalar {
            Scalar::I32 => unpack_integers_as::<4, f64>(&self.sized(place)?, count, |x| x as f64).map_err(Problem),
            Scalar::U32 => {
                unpack_integers_as::<4, f64>(&self.sized(place)?, count, |x| f64::from(x as u32)).map_err(Problem)
            }
            Scalar::I64 | Scalar::U64 => {
                unpack_integers_as::<8, f64>(&self.sized(place)?, count, |x| x as f64).map_err(Problem)
            }
            Scalar::F16 | Scalar::F32 | Scalar::F64 => match self.bytes(place, 1)?[0] {
                b'i' => unpack_integers_as::<4, f64>(&self.sized(place + 1)?, count, |x| x as f64).map_err(Problem),
                b't' => {
                    let bytes = self.bytes(place + 1, 4)?;
                    let length = u64::from(u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]));
                    let length = length * scalar.size() as u64;
                    let values = scalar.numbers(&self.bytes(place + 5, length)?);
                    let indices = self.sized(place + 5 + length)?;
                    let missing = Cell::new(false);
                    let pick = |i: i64| {
                        let found = usize::try_from(i).ok().and_then(|i| values.get(i)).copied();
                        missing.set(missing.get() || found.is_none());
                        found.unwrap_or_default()
                    };
                    let found = unpack_integers_as::<4, f64>(&indices, count, pick).map_err(Problem)?;
                    if missing.get() {
                        return Err(Problem::new("has a packed array that names values it does not have"));
                    }
                    Ok(found)
                }
                code => Err(Problem(format!("has an array packed in an unknown way ({code})"))),
            },
            Scalar::U8 => Err(Problem::new("has packed bytes, which no version of USD writes")),
        }
    }

    /// Bytes with their number before them.
    fn sized(&mut self, place: u64) -> Result<Vec<u8>, Problem> {
        let length = number(&self.bytes(place, 8)?);
        self.bytes(place + 8, length)
    }

    pub(super) fn bytes(&mut self, place: u64, length: u64) -> Result<Vec<u8>, Problem> {
        self.go_to(place, length)?;
        self.budget.take(length, ARRAYS)?;
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

    pub(super) fn token(&self, index: u64) -> Name {
        self.tokens.get(index as usize).cloned().unwrap_or_default()
    }
}

/// What values are called in the budget.
const ARRAYS: &str = "arrays";

/// What names a value, or says that there is none.
fn value(rep: u64) -> Handle {
    if Rep(rep).kind() == types::VALUE_BLOCK { BLOCKED } else { (rep, 0) }
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::super::integers::pack_integers;
    use super::*;

    fn reader(bytes: Vec<u8>, size: u64) -> CrateReader<Cursor<Vec<u8>>> {
        let budget = Rc::new(Budget::of(size));
        let (tokens, strings, prim_of_path) = (Vec::new(), Vec::new(), HashMap::new());
        CrateReader { from: Cursor::new(bytes), size, version: [0, 8, 0], tokens, strings, prim_of_path, budget }
    }

    #[test]
    fn packed_arrays_take_no_more_than_their_file_may_in_all() {
        // A layer of numbers that are all alike has fewer bytes than they are.
        const COUNT: usize = 1 << 20;
        let packed = pack_integers(&[7; COUNT]);
        assert!(packed.len() < COUNT / 500);
        let mut bytes = vec![0; HEADER];
        bytes.extend((COUNT as u64).to_le_bytes());
        bytes.extend((packed.len() as u64).to_le_bytes());
        bytes.extend(&packed);
        let size = bytes.len() as u64;
        let mut reader = reader(bytes, size);
        let array = Rep::array(types::INT, HEADER as u64).0 | Rep::COMPRESSED;
        assert_eq!(reader.integers(array).unwrap(), [7; COUNT]);
        let reads = (0..1000).take_while(|_| reader.integers(array).is_ok()).count() as u64 + 1;
        assert!(reads * COUNT as u64 * 4 <= Budget::of(size).most(), "{reads}");
        let refused = reader.integers(array).unwrap_err().to_string();
        assert!(refused.starts_with("needs 3") && refused.contains(" MB of memory with its arrays"), "{refused}");
        // A further question begins anew.
        reader.budget.next_question();
        assert!(reader.integers(array).is_ok());
    }

    #[test]
    fn a_picked_value_that_is_not_there_is_refused_and_one_that_is_no_number_is_kept() {
        let array = |values: [f32; 2], last: u32| {
            let mut indices = [0u32; 20];
            indices[19] = last;
            let packed = pack_integers(&indices);
            let mut bytes = vec![0; HEADER];
            bytes.extend(20u64.to_le_bytes());
            bytes.push(b't');
            bytes.extend(2u32.to_le_bytes());
            bytes.extend(values.iter().flat_map(|x| x.to_le_bytes()));
            bytes.extend((packed.len() as u64).to_le_bytes());
            bytes.extend(packed);
            let size = bytes.len() as u64;
            reader(bytes, size).singles(Rep::array(types::FLOAT, HEADER as u64).0 | Rep::COMPRESSED)
        };
        assert_eq!(array([0.5, 2.0], 1).unwrap()[18..], [0.5, 2.0]);
        assert!(array([0.5, f32::NAN], 1).unwrap()[19].is_nan());
        for values in [[0.5, 2.0], [0.5, f32::NAN]] {
            let refused = array(values, 2).unwrap_err().to_string();
            assert_eq!(refused, "has a packed array that names values it does not have");
        }
    }
}
