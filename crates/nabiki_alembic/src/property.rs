//! Properties being written: samples as they come, the header at the end.

use std::io::{self, Seek, Write};

use crate::digest::digest;
use crate::layout::{INLINE_METADATA, Kind, Pod, flags};
use crate::ogawa::write::{Child, EMPTY_DATA, Writer};

/// Properties leave the rest of the table to objects and compounds.
const LAST_OF_PROPERTIES: u8 = 200;

/// The archive's table of metadata, which headers name by number.
#[derive(Default)]
pub struct MetadataTable {
    entries: Vec<String>,
}

impl MetadataTable {
    /// The number of an entry of objects and compounds, of which this crate has some ten.
    fn index(&mut self, metadata: &str) -> u8 {
        self.index_below(metadata, INLINE_METADATA)
    }

    /// The number of an entry, if it is or comes to be below `end`: what the table has no room for stands behind its
    /// header.
    fn index_below(&mut self, metadata: &str, end: u8) -> u8 {
        if metadata.is_empty() {
            return 0;
        }
        let found = self.entries.iter().position(|e| e == metadata);
        match u8::try_from(found.unwrap_or(self.entries.len()) + 1) {
            Ok(index) if index < end => {
                if found.is_none() {
                    self.entries.push(metadata.to_owned());
                }
                index
            }
            _ => INLINE_METADATA,
        }
    }

    /// The table as the archive stores it.
    pub fn bytes(&self) -> Vec<u8> {
        self.entries.iter().flat_map(|e| std::iter::once(e.len() as u8).chain(e.bytes())).collect()
    }
}

/// A scalar or array property and the samples it has so far.
pub struct Property {
    name: String,
    metadata: String,
    kind: Kind,
    array: bool,
    /// Which of the archive's time samplings its samples follow.
    timing: u32,
    children: Vec<Child>,
    last: Option<Sample>,
    samples: u32,
    first_change: u32,
    last_change: u32,
    one_value: bool,
    homogeneous: bool,
}

#[derive(Clone, Copy, PartialEq)]
struct Sample {
    digest: [u8; 16],
    bytes: usize,
    data: Child,
    dimensions: Child,
}

impl Property {
    /// A scalar property: one value a sample.
    pub fn scalar(name: &str, metadata: &str, kind: Kind, timing: u32) -> Self {
        Self::new(name, metadata, kind, timing, false)
    }

    /// An array property: any number of values a sample.
    pub fn array(name: &str, metadata: &str, kind: Kind, timing: u32) -> Self {
        Self::new(name, metadata, kind, timing, true)
    }

    /// An array property that geometry consumers take for an attribute of the given scope: "con", "uni" or "vtx".
    pub fn attribute(name: &str, scope: &str, interpretation: &str, kind: Kind, timing: u32) -> Self {
        let interpretation =
            if interpretation.is_empty() { String::new() } else { format!("interpretation={interpretation};") };
        let metadata = format!(
            "arrayExtent=1;geoScope={scope};{interpretation}isGeomParam=true;podExtent={};podName={}",
            kind.extent,
            kind.pod.name()
        );
        Self::new(name, &metadata, kind, timing, true)
    }

    fn new(name: &str, metadata: &str, kind: Kind, timing: u32, array: bool) -> Self {
        Self {
            name: name.to_owned(),
            metadata: metadata.to_owned(),
            kind,
            array,
            timing,
            children: Vec::new(),
            last: None,
            samples: 0,
            first_change: 0,
            last_change: 0,
            one_value: true,
            homogeneous: true,
        }
    }

    /// Adds a sample. Nothing is written for one that equals the sample before it.
    pub fn put<W: Write + Seek>(&mut self, to: &mut Writer<W>, values: &[u8]) -> io::Result<()> {
        let digest = digest(values);
        if self.last.is_some_and(|last| last.digest == digest && last.bytes == values.len()) {
            self.samples += 1;
            return Ok(());
        }
        if let Some(last) = self.last {
            if self.first_change == 0 {
                self.first_change = self.samples;
            } else {
                // Samples between two changes are listed; only the run before the first change is understood.
                for _ in self.last_change + 1..self.samples {
                    self.list(last);
                }
            }
            self.last_change = self.samples;
        }
        let data = if values.is_empty() { EMPTY_DATA } else { to.data(&[&digest, values])? };
        let count = if self.kind.pod == Pod::Text {
            values.iter().filter(|&&b| b == 0).count()
        } else {
            values.len() / (self.kind.pod.size() * usize::from(self.kind.extent))
        };
        let dimensions = match self.kind.pod {
            Pod::Text if self.array => to.data(&[&(count as u64).to_le_bytes()])?,
            _ => EMPTY_DATA,
        };
        self.homogeneous &= self.last.is_none_or(|last| last.bytes == values.len());
        self.one_value &= count == 1;
        let sample = Sample { digest, bytes: values.len(), data, dimensions };
        self.list(sample);
        self.last = Some(sample);
        self.samples += 1;
        Ok(())
    }

    fn list(&mut self, sample: Sample) {
        self.children.push(sample.data);
        if self.array {
            self.children.push(sample.dimensions);
        }
    }

    /// Repeats the last sample until there are `samples` in all.
    pub fn hold(&mut self, samples: u32) {
        self.samples = self.samples.max(samples);
    }

    /// Number of samples so far.
    pub fn samples(&self) -> u32 {
        self.samples
    }

    /// Whether its samples are the archive's frames.
    pub fn is_timed(&self) -> bool {
        self.timing > 0
    }

    /// Whether samples differ.
    pub fn changes(&self) -> bool {
        self.last_change > 0
    }

    fn header(&self, table: &mut MetadataTable) -> Vec<u8> {
        let mut info = if self.array { 2 | u32::from(self.one_value) } else { 1 };
        info |= (self.kind.pod as u32) << flags::POD_SHIFT;
        info |= u32::from(self.kind.extent) << flags::EXTENT_SHIFT;
        let metadata = table.index_below(&self.metadata, LAST_OF_PROPERTIES);
        info |= u32::from(metadata) << flags::METADATA_SHIFT;
        info |= if self.homogeneous { flags::HOMOGENEOUS } else { 0 };
        info |= if self.timing > 0 { flags::TIMED } else { 0 };
        let mut numbers = vec![self.samples];
        if !self.changes() {
            info |= flags::CONSTANT;
        } else if (self.first_change, self.last_change) != (1, self.samples - 1) {
            info |= flags::CHANGES;
            numbers.extend([self.first_change, self.last_change]);
        }
        if self.timing > 0 {
            numbers.push(self.timing);
        }
        numbers.push(self.name.len() as u32);
        let stands_behind = metadata == INLINE_METADATA;
        let width = match numbers.iter().copied().max().unwrap_or_default() {
            0..=0xff => 0,
            0x100..=0xffff => 1,
            _ => 2,
        };
        info |= width << flags::WIDTH_SHIFT;
        let mut bytes = info.to_le_bytes().to_vec();
        for number in numbers {
            bytes.extend(&number.to_le_bytes()[..1 << width]);
        }
        bytes.extend(self.name.as_bytes());
        if stands_behind {
            bytes.extend(&(self.metadata.len() as u32).to_le_bytes()[..1 << width]);
            bytes.extend(self.metadata.as_bytes());
        }
        bytes
    }
}

/// A compound property or the properties of an object: groups, then their headers.
#[derive(Default)]
pub struct Compound {
    groups: Vec<Child>,
    headers: Vec<u8>,
}

impl Compound {
    /// Adds a finished scalar or array property.
    pub fn add<W: Write + Seek>(
        &mut self,
        to: &mut Writer<W>,
        table: &mut MetadataTable,
        property: &Property,
    ) -> io::Result<()> {
        self.groups.push(to.group(&property.children)?);
        self.headers.extend(property.header(table));
        Ok(())
    }

    /// Adds a finished compound property.
    pub fn nest<W: Write + Seek>(
        &mut self,
        to: &mut Writer<W>,
        table: &mut MetadataTable,
        name: &str,
        metadata: &str,
        inner: Self,
    ) -> io::Result<()> {
        self.groups.push(inner.finish(to)?);
        let info = u32::from(table.index(metadata)) << flags::METADATA_SHIFT;
        self.headers.extend(info.to_le_bytes());
        self.headers.push(name.len() as u8);
        self.headers.extend(name.as_bytes());
        Ok(())
    }

    /// Writes the group.
    pub fn finish<W: Write + Seek>(mut self, to: &mut Writer<W>) -> io::Result<Child> {
        if !self.headers.is_empty() {
            self.groups.push(to.data(&[&self.headers])?);
        }
        to.group(&self.groups)
    }
}

/// An object: its properties and the objects below it.
#[derive(Default)]
pub struct Object {
    properties: Compound,
    children: Vec<Child>,
    headers: Vec<u8>,
}

impl Object {
    /// An object with one compound property, as every schema of geometry has it.
    pub fn with_schema<W: Write + Seek>(
        to: &mut Writer<W>,
        table: &mut MetadataTable,
        schema: Schema,
        inside: Compound,
    ) -> io::Result<Self> {
        let mut properties = Compound::default();
        properties.nest(to, table, schema.property(), schema.property_metadata(), inside)?;
        Ok(Self { properties, ..Self::default() })
    }

    /// Adds a finished child.
    pub fn add<W: Write + Seek>(
        &mut self,
        to: &mut Writer<W>,
        table: &mut MetadataTable,
        name: &str,
        schema: Schema,
        child: Self,
    ) -> io::Result<()> {
        self.children.push(child.finish(to)?);
        self.headers.extend((name.len() as u32).to_le_bytes());
        self.headers.extend(name.as_bytes());
        self.headers.push(table.index(schema.object_metadata()));
        Ok(())
    }

    /// Writes the group.
    pub fn finish<W: Write + Seek>(self, to: &mut Writer<W>) -> io::Result<Child> {
        // Two hashes of 16 bytes close the headers: of the properties and of the children, by which readers may
        // tell changed objects without reading them.
        let own = digest(&self.properties.headers);
        let below = if self.headers.is_empty() { [0; 16] } else { digest(&self.headers) };
        let mut group = vec![self.properties.finish(to)?];
        group.extend(self.children);
        group.push(to.data(&[&self.headers, &own, &below])?);
        to.group(&group)
    }
}

/// What an object is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Schema {
    /// A transform of what is below it.
    Xform,
    /// Curves.
    Curves,
    /// A mesh of polygons.
    PolyMesh,
}

impl Schema {
    fn property(self) -> &'static str {
        if self == Self::Xform { ".xform" } else { ".geom" }
    }

    fn property_metadata(self) -> &'static str {
        match self {
            Self::Xform => "schema=AbcGeom_Xform_v3",
            Self::Curves => "schema=AbcGeom_Curve_v2;schemaBaseType=AbcGeom_GeomBase_v1",
            Self::PolyMesh => "schema=AbcGeom_PolyMesh_v1;schemaBaseType=AbcGeom_GeomBase_v1",
        }
    }

    fn object_metadata(self) -> &'static str {
        match self {
            Self::Xform => "schema=AbcGeom_Xform_v3;schemaObjTitle=AbcGeom_Xform_v3:.xform",
            Self::Curves => {
                "schema=AbcGeom_Curve_v2;schemaBaseType=AbcGeom_GeomBase_v1;schemaObjTitle=AbcGeom_Curve_v2:.geom"
            }
            Self::PolyMesh => {
                "schema=AbcGeom_PolyMesh_v1;schemaBaseType=AbcGeom_GeomBase_v1;\
                 schemaObjTitle=AbcGeom_PolyMesh_v1:.geom"
            }
        }
    }
}
