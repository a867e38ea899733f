//! Alembic archives that are small and claim much, put together group by group.

const DATA: u64 = 1 << 63;

/// Kinds of numbers by their code, and how many make a value.
pub type Kind = (u32, u32);
pub const POINTS: Kind = (10, 3);
pub const INTEGERS: Kind = (6, 1);
pub const BYTES_OF_FOUR: Kind = (1, 4);

/// Metadata by their place in the table.
pub const NONE: u8 = 0;
pub const XFORM: u8 = 1;
pub const CURVES: u8 = 2;
const TABLE: [&str; 2] = ["schema=AbcGeom_Xform_v3", "schema=AbcGeom_Curve_v2"];

/// An archive being put together.
pub struct Archive(Vec<u8>);

impl Archive {
    pub fn new() -> Self {
        Self(b"Ogawa\xff\x00\x01\0\0\0\0\0\0\0\0".to_vec())
    }

    pub fn data(&mut self, bytes: &[u8]) -> u64 {
        let place = self.0.len() as u64;
        self.0.extend((bytes.len() as u64).to_le_bytes());
        self.0.extend(bytes);
        place | DATA
    }

    pub fn group(&mut self, children: &[u64]) -> u64 {
        let place = self.0.len() as u64;
        self.0.extend((children.len() as u64).to_le_bytes());
        self.0.extend(children.iter().flat_map(|child| child.to_le_bytes()));
        place
    }

    /// Values of a sample, as a child of properties.
    pub fn sample(&mut self, bytes: &[u8]) -> u64 {
        self.data(&[&[0; 16], bytes].concat())
    }

    /// An array property of samples that may be shared: its header and its group.
    pub fn array(&mut self, name: &str, (pod, extent): Kind, samples: u32, of: &[u64]) -> (Vec<u8>, u64) {
        let children: Vec<u64> = of.iter().flat_map(|&sample| [sample, DATA]).collect();
        // Numbers of four bytes; all samples are alike where one only is stored.
        let constant = if of.len() == 1 { 0x800 } else { 0 };
        let info = 2 | 2 << 2 | pod << 4 | 0x400 | constant | extent << 12;
        let mut header = [info, samples, name.len() as u32].map(u32::to_le_bytes).concat();
        header.extend(name.bytes());
        (header, self.group(&children))
    }

    /// Properties below one name.
    pub fn compound(&mut self, name: &str, inside: u64) -> (Vec<u8>, u64) {
        let mut header = [2u32 << 2, name.len() as u32].map(u32::to_le_bytes).concat();
        header.extend(name.bytes());
        (header, inside)
    }

    pub fn properties(&mut self, all: &[(Vec<u8>, u64)]) -> u64 {
        let headers = all.iter().flat_map(|(header, _)| header.iter().copied()).collect::<Vec<_>>();
        let headers = self.data(&headers);
        let children: Vec<u64> = all.iter().map(|&(_, group)| group).chain([headers]).collect();
        self.group(&children)
    }

    /// The properties of curves: of two points each, at places that may be shared.
    pub fn curves(&mut self, points: u64, counts: u64, samples: u32) -> u64 {
        let basis = self.sample(&[1, 0, 0, 0]);
        let inside = [
            self.array("P", POINTS, samples, &[points]),
            self.array("nVertices", INTEGERS, samples, &[counts]),
            self.array("curveBasisAndType", BYTES_OF_FOUR, samples, &[basis]),
        ];
        let inside = self.properties(&inside);
        let geometry = self.compound(".geom", inside);
        self.properties(&[geometry])
    }

    /// An object with its properties and what lies below it: names, metadata and groups.
    pub fn object(&mut self, properties: u64, below: &[(&str, u8, u64)]) -> u64 {
        let mut headers = Vec::new();
        for (name, metadata, _) in below {
            headers.extend((name.len() as u32).to_le_bytes());
            headers.extend(name.bytes());
            headers.push(*metadata);
        }
        headers.extend([0; 32]);
        let headers = self.data(&headers);
        let children: Vec<u64> = [properties].into_iter().chain(below.iter().map(|b| b.2)).chain([headers]).collect();
        self.group(&children)
    }

    pub fn finish(mut self, top: u64) -> Vec<u8> {
        let table: Vec<u8> =
            TABLE.iter().flat_map(|entry| [entry.len() as u8].into_iter().chain(entry.bytes())).collect();
        let timing = [&1u32.to_le_bytes()[..], &1f64.to_le_bytes(), &1u32.to_le_bytes(), &0f64.to_le_bytes()].concat();
        let (version, library, about) = (self.data(&[0; 4]), self.data(&10_800u32.to_le_bytes()), self.data(b""));
        let (timing, table) = (self.data(&timing), self.data(&table));
        let root = self.group(&[version, library, top, about, timing, table]);
        self.0[8..16].copy_from_slice(&root.to_le_bytes());
        self.0
    }
}
