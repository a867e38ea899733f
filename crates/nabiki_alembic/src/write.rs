//! Moving hair into an archive, one frame at a time.
//!
//! The archive: a transform `head`, below it the curves `hair` and, if asked for, the mesh `skin`. Positions, bounds
//! and the transform have a sample a frame; all else is stored once. Alembic has no unit and no up axis: consumers
//! take it as y up, and its unit for their own.

use std::io;
use std::path::Path;

use glam::{DAffine3, Vec2, Vec3};
use nabiki::hair::{Attributes, Other, Per, Stored};
use nabiki::strands::bounds;
use nabiki::{Mesh, Strands};
use nabiki_exchange::attributes::names;
use nabiki_exchange::{Export, FrameSink, Velocities};
use nabiki_file::PartFile;

use crate::carried;
use crate::layout::{Kind, Pod};
use crate::ogawa::write::Writer;
use crate::property::{Compound, MetadataTable, Object, Property, Schema};

const POINT: Kind = Kind { pod: Pod::F32, extent: 3 };
const UV: Kind = Kind { pod: Pod::F32, extent: 2 };
const NUMBER: Kind = Kind { pod: Pod::F32, extent: 1 };
const INTEGER: Kind = Kind { pod: Pod::I32, extent: 1 };
const LONG: Kind = Kind { pod: Pod::I64, extent: 1 };
const TEXT: Kind = Kind { pod: Pod::Text, extent: 1 };
const BOX: Kind = Kind { pod: Pod::F64, extent: 6 };
const FLAG: Kind = Kind { pod: Pod::Bool, extent: 1 };
const BYTE: Kind = Kind { pod: Pod::U8, extent: 1 };

/// Time samplings of the archive: 0 is the default every archive has, 1 that of the frames.
const FRAMES: u32 = 1;

type Archive = Writer<PartFile>;

/// An Alembic archive that takes the hair frame by frame.
pub struct HairArchive<'a> {
    export: Export<'a>,
    to: Archive,
    positions: Property,
    bounds: Property,
    transform: Property,
    moved_channels: [bool; 16],
    rest_transform: Option<[f64; 16]>,
    velocities: Option<Velocities>,
    /// The velocities of the frames.
    moving: Property,
    points: Vec<Vec3>,
}

impl<'a> HairArchive<'a> {
    /// Begins the archive that [`FrameSink::finish`] will name `path`.
    ///
    /// # Errors
    /// Settings that [`Export::check`] refuses; what the disk says.
    pub fn create(path: &Path, export: Export<'a>) -> io::Result<Self> {
        export.check()?;
        Ok(Self {
            velocities: export.velocities.then(Velocities::default),
            export,
            to: Writer::new(PartFile::create(path)?)?,
            positions: Property::array("P", "geoScope=vtx;interpretation=point", POINT, FRAMES),
            bounds: Property::scalar(".selfBnds", "interpretation=box", BOX, FRAMES),
            transform: Property::scalar(".vals", "", Kind { pod: Pod::F64, extent: 16 }, FRAMES),
            moved_channels: [false; 16],
            rest_transform: None,
            moving: Property::array(".velocities", "interpretation=vector", POINT, FRAMES),
            points: Vec::new(),
        })
    }

    fn complete(mut self) -> io::Result<()> {
        if self.positions.samples() == 0 {
            return Err(io::Error::new(io::ErrorKind::InvalidInput, "no frame was given"));
        }
        if let Some(last) = self.velocities.as_ref().and_then(Velocities::of_last) {
            self.moving.put(&mut self.to, bytemuck::cast_slice(last))?;
        }
        let mut table = MetadataTable::default();
        let version = self.to.data(&[&0i32.to_le_bytes()])?;
        // The layout is that of Alembic 1.7 to 1.8; readers use the number to tell what they may meet.
        let library = self.to.data(&[&10_800i32.to_le_bytes()])?;
        let timing = self.timing();
        let to = &mut self.to;
        let moving = Some(&self.moving).filter(|m| m.samples() > 0);
        let hair = curves(to, &mut table, &self.export, [Some(&self.bounds), Some(&self.positions), moving])?;
        let skin = self.export.head.map(|mesh| polygons(to, &mut table, mesh, &self.export)).transpose()?;

        let inside = transform(to, &mut table, &self.transform, &self.moved_channels)?;
        let mut head = Object::with_schema(to, &mut table, Schema::Xform, inside)?;
        head.add(to, &mut table, "hair", Schema::Curves, hair)?;
        if let Some(skin) = skin {
            head.add(to, &mut table, "skin", Schema::PolyMesh, skin)?;
        }
        let mut top = Object::default();
        top.add(to, &mut table, "head", Schema::Xform, head)?;
        let top = top.finish(to)?;

        let metadata = format!("_ai_AlembicVersion=Alembic 1.8.0;_ai_Application=Nabiki {}", env!("CARGO_PKG_VERSION"));
        let fps = format!(";_ai_DCC_FPS={}", self.export.frame_rate);
        let metadata = to.data(&[metadata.as_bytes(), fps.as_bytes()])?;
        let timing = to.data(&[&timing])?;
        let table = to.data(&[&table.bytes()])?;
        let root = to.group(&[version, library, top, metadata, timing, table])?;
        self.to.finish(root)?.finish()
    }

    /// Time samplings: the default, and a uniform one of the frames.
    fn timing(&self) -> Vec<u8> {
        let period = 1.0 / self.export.frame_rate;
        let start = f64::from(self.export.first_frame) * period;
        let mut bytes = Vec::new();
        for (samples, period, start) in [(1, 1.0, 0.0), (self.positions.samples(), period, start)] {
            bytes.extend(u32::to_le_bytes(samples));
            bytes.extend(f64::to_le_bytes(period));
            bytes.extend(1u32.to_le_bytes());
            bytes.extend(f64::to_le_bytes(start));
        }
        bytes
    }
}

impl FrameSink for HairArchive<'_> {
    fn frame(&mut self, strands: &Strands, world_from_head: &DAffine3) -> io::Result<()> {
        let points = self.export.points(strands, &mut self.points)?;
        self.positions.put(&mut self.to, bytemuck::cast_slice(points))?;
        self.bounds.put(&mut self.to, &box_of(points))?;
        if let Some(velocities) = &mut self.velocities
            && let Some(found) = velocities.before(points, self.export.frame_rate)?
        {
            self.moving.put(&mut self.to, bytemuck::cast_slice(found))?;
        }
        // Alembic multiplies rows from the left.
        let parent = self.export.parent(world_from_head).to_cols_array();
        let rest = self.rest_transform.get_or_insert(parent);
        for (moved, (a, b)) in self.moved_channels.iter_mut().zip(rest.iter().zip(&parent)) {
            *moved |= a != b;
        }
        self.transform.put(&mut self.to, bytemuck::cast_slice(&parent))
    }

    fn finish(self: Box<Self>) -> io::Result<Option<String>> {
        self.complete()?;
        Ok(None)
    }
}

fn box_of(points: &[Vec3]) -> Vec<u8> {
    let [low, high] = bounds(points);
    let numbers: [f64; 6] = [low.x, low.y, low.z, high.x, high.y, high.z].map(f64::from);
    bytemuck::cast_slice(&numbers).to_vec()
}

/// The properties of the parent transform: one matrix.
fn transform(
    to: &mut Archive,
    table: &mut MetadataTable,
    values: &Property,
    moved: &[bool; 16],
) -> io::Result<Compound> {
    const MATRIX: u8 = 3 << 4;
    let mut inside = Compound::default();
    let mut once = |inside: &mut Compound, mut property: Property, value: &[u8]| {
        property.put(to, value)?;
        // Readers take the number of a transform's samples from these.
        property.hold(values.samples());
        inside.add(to, table, &property)
    };
    once(&mut inside, Property::scalar(".inherits", "", FLAG, FRAMES), &[1])?;
    once(&mut inside, Property::scalar(".ops", "", BYTE, 0), &[MATRIX])?;
    inside.add(to, table, values)?;
    let mut still = Property::scalar("isNotConstantIdentity", "", FLAG, 0);
    still.put(to, &[1])?;
    inside.add(to, table, &still)?;
    let channels: Vec<u32> = (0..16u32).filter(|&c| moved[c as usize]).collect();
    if !channels.is_empty() {
        let mut animated = Property::array(".animChans", "", Kind { pod: Pod::U32, extent: 1 }, 0);
        animated.put(to, bytemuck::cast_slice(&channels))?;
        inside.add(to, table, &animated)?;
    }
    let groom = groom_properties(to, table)?;
    inside.nest(to, table, ".userProperties", "", groom)?;
    Ok(inside)
}

/// What says to Unreal which form of groom this is, at the topmost transform.
fn groom_properties(to: &mut Archive, table: &mut MetadataTable) -> io::Result<Compound> {
    let mut inside = Compound::default();
    let number = Kind { pod: Pod::I16, extent: 1 };
    for (name, value) in [("groom_version_major", 1i16), ("groom_version_minor", 5)] {
        let mut property = Property::scalar(name, "", number, 0);
        property.put(to, &value.to_le_bytes())?;
        inside.add(to, table, &property)?;
    }
    let mut tool = Property::scalar("groom_tool", "", TEXT, 0);
    tool.put(to, concat!("Nabiki ", env!("CARGO_PKG_VERSION"), "\0").as_bytes())?;
    inside.add(to, table, &tool)?;
    Ok(inside)
}

/// The curves: what the frames have put into `sampled`, and everything that does not move.
fn curves(
    to: &mut Archive,
    table: &mut MetadataTable,
    export: &Export<'_>,
    sampled: [Option<&Property>; 3],
) -> io::Result<Object> {
    let mut inside = Compound::default();
    let mut samples = 0;
    for property in sampled.into_iter().flatten() {
        inside.add(to, table, property)?;
        samples = property.samples();
    }
    let strands = &export.hair.strands;
    let attributes = &export.hair.attributes;
    let mut own = Held { to, table, inside: Compound::default(), samples };
    own.inside = inside;
    let counts: Vec<i32> = strands.iter().map(|s| s.len() as i32).collect();
    own.put(Property::array("nVertices", "", INTEGER, FRAMES), bytemuck::cast_slice(&counts))?;
    // Linear, not periodic, no basis.
    own.put(Property::scalar("curveBasisAndType", "", Kind { pod: Pod::U8, extent: 4 }, FRAMES), &[1, 0, 0, 0])?;
    if let Some(other) = attributes.other.iter().find(|other| is_own_uv(other)) {
        let scope = if other.per == Per::Point { "vtx" } else { "uni" };
        own.put(Property::attribute("uv", scope, "vector", UV, FRAMES), &carried::bytes(other))?;
    } else if let Some(uv) = &attributes.root_uv {
        own.put(Property::attribute("uv", "uni", "vector", UV, FRAMES), bytemuck::cast_slice(uv))?;
    }
    if let Some(widths) = export.widths() {
        own.put(Property::attribute("width", "vtx", "", NUMBER, FRAMES), bytemuck::cast_slice(&widths))?;
    }
    let mut inside = own.inside;
    let mut more = Held { to, table, inside: Compound::default(), samples };
    parameters(&mut more, export)?;
    let more = more.inside;
    inside.nest(to, table, ".arbGeomParams", "", more)?;
    Object::with_schema(to, table, Schema::Curves, inside)
}

/// Whether what is passed on is the texture coordinates for which the schema of curves has a place of its own.
fn is_own_uv(other: &Other) -> bool {
    other.name == "uv" && other.per != Per::Groom && (other.stored, other.extent) == (Stored::F32, 2)
}

/// Properties with one value for all frames.
struct Held<'a> {
    to: &'a mut Archive,
    table: &'a mut MetadataTable,
    inside: Compound,
    /// Number of frames.
    samples: u32,
}

impl Held<'_> {
    fn put(&mut self, mut property: Property, value: &[u8]) -> io::Result<()> {
        property.put(self.to, value)?;
        property.hold(if property.is_timed() { self.samples } else { 1 });
        self.inside.add(self.to, self.table, &property)
    }

    /// A value for each strand.
    fn by_strand(&mut self, name: &str, interpretation: &str, kind: Kind, value: &[u8]) -> io::Result<()> {
        self.put(Property::attribute(name, "uni", interpretation, kind, 0), value)
    }

    /// A value for each point.
    fn by_point(&mut self, name: &str, interpretation: &str, kind: Kind, value: &[u8]) -> io::Result<()> {
        self.put(Property::attribute(name, "vtx", interpretation, kind, 0), value)
    }
}

/// The geometry parameters. What was carried along goes before what is made here under the same name.
fn parameters(more: &mut Held<'_>, export: &Export<'_>) -> io::Result<()> {
    let at = &export.hair.attributes;
    let names = carried::names(&at.other);
    let others = at.other.iter().zip(&names).filter(|(other, name)| !(is_own_uv(other) && *name == "uv"));
    let passed_on: Vec<(&Other, Property)> =
        others.clone().filter_map(|(other, name)| Some((other, carried::property(other, name)?))).collect();
    let made = |name: &str| others.clone().all(|(_, other)| other != name);
    roots(more, at, &made)?;
    let points = export.hair.strands.points().len();
    let one_color = at.constant.colour.or(export.default_colour).map(|c| vec![c; points]);
    if let Some(colors) = at.colour.as_ref().or(one_color.as_ref()).filter(|_| made("groom_color")) {
        more.by_point("groom_color", "rgb", POINT, bytemuck::cast_slice(colors))?;
    }
    if let Some(uv) = at.point_uv.as_ref().filter(|_| made("point_uv")) {
        more.by_point("point_uv", "vector", UV, bytemuck::cast_slice(uv))?;
    }
    if let Some(values) = export.transparency().filter(|_| made("transparency")) {
        more.by_point("transparency", "", NUMBER, bytemuck::cast_slice(&values))?;
    }
    if let Some(values) = at.inverse_mass.as_ref().filter(|_| made("freedom")) {
        more.by_point("freedom", "", NUMBER, bytemuck::cast_slice(values))?;
    }
    if export.rest && made(names::REST) {
        more.by_point(names::REST, "point", POINT, bytemuck::cast_slice(&export.rest_points()))?;
    }
    passed_on.into_iter().try_for_each(|(other, property)| more.put(property, &carried::bytes(other)))
}

/// What strands have one of each: UVs of their roots, ids, groups, guides.
fn roots(more: &mut Held<'_>, at: &Attributes, made: &dyn Fn(&str) -> bool) -> io::Result<()> {
    if let Some(uv) = &at.root_uv {
        for name in ["groom_root_uv", "surface_uv_coordinate"].into_iter().filter(|name| made(name)) {
            more.by_strand(name, "vector", UV, bytemuck::cast_slice(uv))?;
        }
    }
    if let Some(ids) = at.id.as_ref().filter(|_| made("groom_id")) {
        // Unreal's ids are 32-bit; others are kept whole under a name of our own.
        match ids.iter().map(|&id| i32::try_from(id)).collect::<Result<Vec<_>, _>>() {
            Ok(ids) => more.by_strand("groom_id", "", INTEGER, bytemuck::cast_slice(&ids))?,
            Err(_) => {
                let name = if made("id") { "id" } else { "groom_id" };
                more.by_strand(name, "", LONG, bytemuck::cast_slice(ids))?;
            }
        }
    }
    if let Some(groups) = at.group.as_ref().filter(|_| made("groom_group_id")) {
        more.by_strand("groom_group_id", "", INTEGER, bytemuck::cast_slice(groups))?;
        if !at.group_names.is_empty() && made("groom_group_name") {
            let empty = String::new();
            let name = |g: &i32| at.group_names.get(g).unwrap_or(&empty).replace('\0', "") + "\0";
            let names: String = groups.iter().map(name).collect();
            more.by_strand("groom_group_name", "", TEXT, names.as_bytes())?;
        }
    }
    if let Some(guides) = at.guide.as_ref().filter(|_| made("groom_guide")) {
        let guides: Vec<i16> = guides.iter().map(|&g| i16::from(g)).collect();
        more.by_strand("groom_guide", "", Kind { pod: Pod::I16, extent: 1 }, bytemuck::cast_slice(&guides))?;
    }
    Ok(())
}

/// The head, which keeps its shape.
fn polygons(to: &mut Archive, table: &mut MetadataTable, mesh: &Mesh, export: &Export<'_>) -> io::Result<Object> {
    let (positions, mirrored) = export.skin(mesh);
    // Alembic winds faces clockwise; a mirroring turns them once more.
    let wound = |&[a, b, c]: &[u32; 3]| if mirrored { [a, b, c] } else { [c, b, a] };
    let corners: Vec<i32> = mesh.triangles.iter().flat_map(wound).map(|v| v as i32).collect();
    let counts = vec![3i32; mesh.triangles.len()];
    let mut inside = Compound::default();
    for (property, value) in [
        (Property::scalar(".selfBnds", "interpretation=box", BOX, 0), &box_of(&positions)[..]),
        (Property::array("P", "geoScope=vtx;interpretation=point", POINT, 0), bytemuck::cast_slice(&positions)),
        (Property::array(".faceIndices", "", INTEGER, 0), bytemuck::cast_slice(&corners)),
        (Property::array(".faceCounts", "", INTEGER, 0), bytemuck::cast_slice(&counts)),
    ] {
        let mut property = property;
        property.put(to, value)?;
        inside.add(to, table, &property)?;
    }
    if let Some(uvs) = &mesh.corner_uvs {
        let wound = |&[a, b, c]: &[Vec2; 3]| if mirrored { [a, b, c] } else { [c, b, a] };
        let uvs: Vec<Vec2> = uvs.iter().flat_map(wound).collect();
        let mut property = Property::attribute("uv", "fvr", "vector", UV, 0);
        property.put(to, bytemuck::cast_slice(&uvs))?;
        inside.add(to, table, &property)?;
    }
    Object::with_schema(to, table, Schema::PolyMesh, inside)
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;
    use crate::tree::{Header, Tree};
    use crate::values::{doubles, integers, singles};
    use nabiki::Hair;

    /// The properties of the object at `path`.
    fn properties(tree: &mut Tree<Cursor<Vec<u8>>>, path: &str) -> Vec<Header> {
        let object = (0..tree.objects.len()).find(|&object| tree.path(object) == path).unwrap();
        let schema = tree.properties_of(object).unwrap();
        tree.properties(schema[0].place).unwrap()
    }

    #[test]
    fn what_only_other_programs_ask_for_is_in_every_frame() {
        let mut strands = Strands::default();
        strands.push([Vec3::ZERO, Vec3::new(1.0, -2.0, 3.0)]);
        let mut hair = Hair::from(strands.clone());
        hair.attributes.width = Some(vec![0.5, 0.25]);
        hair.attributes.id = Some(vec![7]);
        hair.attributes.root_uv = Some(vec![[0.5, 0.25]]);
        let skin =
            Mesh { positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y], triangles: vec![[0, 1, 2]], ..Mesh::default() };
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("hair.abc");
        let mut export = Export::new(&hair, 8.0);
        (export.velocities, export.head) = (true, Some(&skin));
        (export.rest, export.default_colour) = (true, Some([0.25, 0.5, 1.0]));
        let mut sink = Box::new(HairArchive::create(&path, export).unwrap());
        for frame in 0..3 {
            let mut moved = strands.clone();
            moved.points_mut()[1].x += (frame * frame) as f32;
            sink.frame(&moved, &DAffine3::IDENTITY).unwrap();
        }
        sink.finish().unwrap();
        let mut tree = Tree::new(Cursor::new(std::fs::read(path).unwrap())).unwrap();
        let of_hair = properties(&mut tree, "/head/hair");
        let named = |headers: &[Header], name: &str| headers.iter().find(|h| &*h.name == name).unwrap().clone();
        let (bounds, velocities) = (named(&of_hair, ".selfBnds"), named(&of_hair, ".velocities"));
        assert_eq!((bounds.samples, velocities.samples, velocities.timing), (3, 3, FRAMES as usize));
        // The tip goes by 1 and by 3, eight times a second; the last frame goes on as it came.
        for (frame, (farthest, speed)) in [(1.0, 8.0), (2.0, 24.0), (5.0, 24.0)].into_iter().enumerate() {
            let found = doubles(bounds.kind, &tree.sample(&bounds, frame).unwrap()).unwrap();
            assert_eq!(found, [0.0, -2.0, 0.0, farthest, 0.0, 3.0], "the least corner, then the greatest");
            let found = singles(velocities.kind, &tree.sample(&velocities, frame).unwrap()).unwrap();
            assert_eq!(found, [0.0, 0.0, 0.0, speed, 0.0, 0.0], "frame {frame}");
        }
        let more = named(&of_hair, ".arbGeomParams");
        let parameters = [of_hair, tree.properties(more.place).unwrap()].concat();
        for (name, scope) in [
            ("uv", "uni"),
            ("width", "vtx"),
            ("groom_id", "uni"),
            ("groom_root_uv", "uni"),
            ("groom_color", "vtx"),
            ("rest", "vtx"),
        ] {
            assert_eq!(named(&parameters, name).detail("geoScope"), Some(scope), "{name}");
        }
        let of_head = properties(&mut tree, "/head");
        assert_eq!(tree.sample(&named(&of_head, ".inherits"), 0).unwrap(), [1]);
        // By which Unreal knows how to read the rest.
        let own = tree.properties(named(&of_head, ".userProperties").place).unwrap();
        for (name, number) in [("groom_version_major", 1), ("groom_version_minor", 5)] {
            let header = named(&own, name);
            assert_eq!(integers(header.kind, &tree.sample(&header, 0).unwrap()).unwrap(), [number], "{name}");
        }
        // Clockwise, seen from outside.
        let of_skin = properties(&mut tree, "/head/skin");
        let corners = named(&of_skin, ".faceIndices");
        assert_eq!(integers(corners.kind, &tree.sample(&corners, 0).unwrap()).unwrap(), [2, 1, 0]);
    }
}
