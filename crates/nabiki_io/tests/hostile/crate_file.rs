//! Binary USD layers that are small and claim much, put together table by table.

/// The type of a value, and whether it is the value itself, an array, or a packed one.
pub mod kind {
    pub const INT: u64 = 3;
    pub const TOKEN: u64 = 11;
    pub const VEC3F: u64 = 24;
    pub const SPECIFIER: u64 = 42;
    pub const TIME_SAMPLES: u64 = 46;
    pub const DOUBLE_VECTOR: u64 = 48;
    pub const ARRAY: u64 = 1 << 63;
    pub const INLINED: u64 = 1 << 62;
    pub const PACKED: u64 = 1 << 61;
}

/// What a path is of.
#[derive(Clone, Copy, PartialEq)]
pub enum Spec {
    Layer = 7,
    Prim = 6,
    Attribute = 1,
}

/// An entry of the tree of paths: its name, what it is, its fields, and what lies below it.
#[derive(Clone)]
pub struct Node {
    pub token: u32,
    pub spec: Spec,
    pub fields: Vec<u32>,
    pub below: Vec<Node>,
}

/// A layer being put together.
pub struct Layer {
    bytes: Vec<u8>,
    tokens: Vec<u8>,
    token_count: usize,
    fields: Vec<(u32, u64)>,
}

impl Layer {
    pub fn new() -> Self {
        // Properties are told by the sign of their token, so none may have number 0.
        Self { bytes: vec![0; 88], tokens: vec![0], token_count: 1, fields: Vec::new() }
    }

    pub fn token(&mut self, word: &str) -> u32 {
        self.tokens.extend(word.bytes().chain([0]));
        self.token_count += 1;
        self.token_count as u32 - 1
    }

    /// So many tokens of no letters.
    pub fn words_without_letters(&mut self, count: usize) {
        self.tokens.resize(self.tokens.len() + count, 0);
        self.token_count += count;
    }

    /// A field of a name with a value; its number.
    pub fn field(&mut self, name: &str, rep: u64) -> u32 {
        let token = self.token(name);
        self.fields.push((token, rep));
        self.fields.len() as u32 - 1
    }

    pub fn word_field(&mut self, name: &str, word: &str) -> u32 {
        let word = u64::from(self.token(word));
        self.field(name, kind::INLINED | kind::TOKEN << 48 | word)
    }

    /// The fields of a prim of a type.
    pub fn prim(&mut self, type_name: &str) -> Vec<u32> {
        vec![self.field("specifier", kind::INLINED | kind::SPECIFIER << 48), self.word_field("typeName", type_name)]
    }

    /// Bytes at a place, which is given.
    pub fn put(&mut self, bytes: &[u8]) -> u64 {
        self.bytes.resize(self.bytes.len().next_multiple_of(8), 0);
        self.bytes.extend(bytes);
        (self.bytes.len() - bytes.len()) as u64
    }

    /// An array of so many of the same number, packed.
    pub fn packed(&mut self, value: u32, count: usize) -> u64 {
        let packed = pack_integers(std::iter::repeat_n(value, count));
        let head = [count as u64, packed.len() as u64].map(u64::to_le_bytes).concat();
        let place = self.put(&[head, packed].concat());
        kind::ARRAY | kind::PACKED | kind::INT << 48 | place
    }

    /// An array of points.
    pub fn points(&mut self, count: usize) -> u64 {
        let numbers = (0..3 * count).flat_map(|n| (n as f32).to_le_bytes());
        let bytes: Vec<u8> = (count as u64).to_le_bytes().into_iter().chain(numbers).collect();
        kind::ARRAY | kind::VEC3F << 48 | self.put(&bytes)
    }

    /// The file of these prims.
    pub fn finish(self, prims: Vec<Node>) -> Vec<u8> {
        let root = Node { token: 0, spec: Spec::Layer, fields: Vec::new(), below: prims };
        let mut flat = Vec::new();
        flatten(&root, false, &mut flat);
        self.finish_flat(flat.into_iter())
    }

    /// The file of entries in the order of the table of paths: token (negative for properties), jump, spec, fields.
    pub fn finish_flat(mut self, entries: impl Iterator<Item = (i32, i32, Spec, Vec<u32>)>) -> Vec<u8> {
        let (mut tokens, mut jumps, mut sets, mut set_of, mut specs) = (vec![], vec![], vec![], vec![], vec![]);
        let mut last: Option<Vec<u32>> = None;
        for (token, jump, spec, fields) in entries {
            tokens.push(token as u32);
            jumps.push(jump as u32);
            specs.push(spec as u32);
            // Neighbours of the same fields share their set.
            if last.as_ref() != Some(&fields) {
                set_of.push(sets.len() as u32);
                sets.extend(fields.iter().copied().chain([u32::MAX]));
                last = Some(fields);
            } else {
                set_of.push(set_of[set_of.len() - 1]);
            }
        }
        let count = tokens.len();
        let counted = |n: usize| (n as u64).to_le_bytes().to_vec();
        let sized = |packed: Vec<u8>| [counted(packed.len()), packed].concat();
        let integers = |numbers: Vec<u32>| sized(pack_integers(numbers.into_iter()));
        let (words, word_count) = (std::mem::take(&mut self.tokens), self.token_count);
        let names = self.fields.iter().map(|f| f.0).collect();
        let reps: Vec<u8> = self.fields.iter().flat_map(|f| f.1.to_le_bytes()).collect();
        let sections = [
            ("TOKENS", [counted(word_count), counted(words.len()), sized(pack(&words))].concat()),
            ("STRINGS", counted(0)),
            ("FIELDS", [counted(self.fields.len()), integers(names), sized(pack(&reps))].concat()),
            ("FIELDSETS", [counted(sets.len()), integers(sets)].concat()),
            ("PATHS", {
                let order = integers((0..count as u32).collect());
                [counted(count), counted(count), order, integers(tokens), integers(jumps)].concat()
            }),
            (
                "SPECS",
                [counted(count), integers((0..count as u32).collect()), integers(set_of), integers(specs)].concat(),
            ),
        ];
        let mut list = counted(sections.len());
        for (name, bytes) in &sections {
            let place = self.put(bytes);
            let mut padded = [0; 16];
            padded[..name.len()].copy_from_slice(name.as_bytes());
            list.extend(padded);
            list.extend([place, bytes.len() as u64].map(u64::to_le_bytes).concat());
        }
        let list = self.put(&list);
        self.bytes[..8].copy_from_slice(b"PXR-USDC");
        self.bytes[9] = 8;
        self.bytes[16..24].copy_from_slice(&list.to_le_bytes());
        self.bytes
    }
}

fn flatten(node: &Node, has_sibling: bool, to: &mut Vec<(i32, i32, Spec, Vec<u32>)>) {
    let entry = to.len();
    let token = if node.spec == Spec::Attribute { -(node.token as i32) } else { node.token as i32 };
    to.push((token, 0, node.spec, node.fields.clone()));
    for (i, below) in node.below.iter().enumerate() {
        flatten(below, i + 1 < node.below.len(), to);
    }
    to[entry].1 = match (node.below.is_empty(), has_sibling) {
        (true, false) => -2,
        (false, false) => -1,
        (true, true) => 0,
        (false, true) => (to.len() - entry) as i32,
    };
}

/// Integers as differences, the commonest of which takes two bits.
fn pack_integers(numbers: impl Iterator<Item = u32>) -> Vec<u8> {
    let mut last = 0u32;
    let mut differences = Vec::new();
    for number in numbers {
        differences.push(number.wrapping_sub(last) as i32);
        last = number;
    }
    // The second stands for all, where they are alike.
    let common = differences.get(1).or(differences.first()).copied().unwrap_or_default();
    let mut codes = vec![0u8; differences.len().div_ceil(4)];
    let mut rest = Vec::new();
    for (i, &difference) in differences.iter().enumerate().filter(|&(_, &difference)| difference != common) {
        codes[i / 4] |= 3 << (2 * (i % 4));
        rest.extend(difference.to_le_bytes());
    }
    pack(&[common.to_le_bytes().to_vec(), codes, rest].concat())
}

/// LZ4 of bytes, of which runs of the same one are made short: each byte of a length stands for 255 of them.
pub fn pack(bytes: &[u8]) -> Vec<u8> {
    let mut packed = vec![0];
    let mut literals: Vec<u8> = Vec::new();
    let mut at = 0;
    let length = |to: &mut Vec<u8>, mut rest: usize| {
        while rest >= 255 {
            to.push(255);
            rest -= 255;
        }
        to.push(rest as u8);
    };
    while at < bytes.len() {
        let byte = bytes[at];
        let run = bytes[at..].iter().take_while(|&&b| b == byte).count();
        literals.push(byte);
        // The last of a block are literals.
        let copied = if at + run == bytes.len() { run.saturating_sub(13) } else { run - 1 };
        if copied < 20 {
            at += 1;
            continue;
        }
        packed.push((literals.len().min(15) << 4 | 15) as u8);
        if literals.len() >= 15 {
            length(&mut packed, literals.len() - 15);
        }
        packed.append(&mut literals);
        packed.extend([1, 0]);
        length(&mut packed, copied - 4 - 15);
        at += 1 + copied;
    }
    packed.push((literals.len().min(15) << 4) as u8);
    if literals.len() >= 15 {
        length(&mut packed, literals.len() - 15);
    }
    packed.extend(literals);
    packed
}
