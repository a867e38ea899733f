//! Stanford .ply: a text header that names elements and their properties, then those, as text or binary.

mod columns;

use glam::{Vec2, Vec3};
use nabiki::Mesh;
use nabiki_exchange::Budget;

use super::{TRIANGLE_BYTES, VERTEX_BYTES, check::check, push_fan};
use crate::error::{Error, Result};
use columns::Columns;

/// How the body is written.
#[derive(Clone, Copy, PartialEq)]
enum Encoding {
    Text,
    Little,
    Big,
}

/// Type of a number.
#[derive(Clone, Copy)]
enum Kind {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Kind {
    fn of(name: &str) -> Option<Self> {
        Some(match name {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return None,
        })
    }

    /// Bytes of a number that is not text.
    fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }
}

struct Property {
    name: String,
    /// Type of a list's length; `None` for a single number.
    list: Option<Kind>,
    kind: Kind,
}

struct Element {
    name: String,
    count: usize,
    properties: Vec<Property>,
}

/// Names that programs give the texture coordinates of a vertex.
const UV: [[&str; 2]; 3] = [["s", "t"], ["u", "v"], ["texture_u", "texture_v"]];

/// Reads the vertices and faces; larger polygons become fans, other elements are passed over. Texture coordinates are
/// those that the faces list for their corners (`texcoord`), else those of the vertices. Further numbers of the
/// vertices are their weights. `lost`: what of these and of the texture coordinates is left out is put there; the shape does
/// without.
pub fn from_bytes(bytes: &[u8], lost: &mut Vec<String>) -> Result<Mesh> {
    let (encoding, elements, body) = header(bytes)?;
    check_counts(encoding, &elements, body)?;
    let budget = Budget::of(bytes.len() as u64);
    let mut body = Body { encoding, rest: body };
    let mut mesh = Mesh::default();
    let mut uvs: Vec<Vec2> = Vec::new();
    for element in &elements {
        let place = |name: &str| element.properties.iter().position(|p| p.name == name && p.list.is_none());
        let [u, v] = UV.map(|names| names.map(place)).into_iter().find(|uv| !uv.contains(&None)).unwrap_or_default();
        let wanted = [place("x"), place("y"), place("z"), u, v];
        let is_face = element.name == "face";
        let first = mesh.positions.len();
        let mut columns = Columns::of(element, &wanted);
        for i in 0..element.count {
            let mut vertex = [0.0f32; 5];
            let (mut face, mut texcoord) = (Vec::new(), Vec::new());
            for (p, property) in element.properties.iter().enumerate() {
                let short = || Error::new(format!("ends within {} {i} of {}", element.name, element.count));
                let length = match property.list {
                    Some(kind) => body.number(kind).ok_or_else(short)?,
                    None => 1.0,
                };
                let mut list = match property.name.as_str() {
                    "vertex_indices" | "vertex_index" if is_face => Some(&mut face),
                    "texcoord" if is_face && property.list.is_some() => Some(&mut texcoord),
                    _ => None,
                };
                let mut n = 0.0;
                while n < length {
                    let value = body.number(property.kind).ok_or_else(short)?;
                    if let Some(part) = wanted.iter().position(|&w| w == Some(p)) {
                        vertex[part] = value as f32;
                    }
                    columns.take(p, value, &budget)?;
                    if let Some(list) = &mut list {
                        list.push(value);
                    }
                    n += 1.0;
                }
            }
            budget.take(face.len().saturating_sub(2) as u64 * TRIANGLE_BYTES, "triangles")?;
            push_fan(&mut mesh, &polygon(i, &face, &texcoord, lost)?);
            if element.name == "vertex" {
                budget.take(VERTEX_BYTES, "vertices")?;
                let [x, y, z, s, t] = vertex;
                mesh.positions.push(Vec3::new(x, y, z));
                uvs.extend(u.map(|_| Vec2::new(s, t)));
            }
        }
        columns.add_to(&mut mesh, first, &budget, lost);
    }
    let vertices = mesh.positions.len();
    if let Some(v) = mesh.triangles.iter().flatten().find(|&&v| v as usize >= vertices) {
        return Err(Error::new(format!("a face names vertex {v}, but there are {vertices}, counted from 0")));
    }
    if mesh.corner_uvs.is_none() && uvs.len() == vertices {
        mesh.corner_uvs = Some(mesh.triangles.iter().map(|t| t.map(|v| uvs[v as usize])).collect());
    }
    check(mesh, lost)
}

/// Refuses counts of elements for which there are too few bytes: each has some for every property, a list for its length.
fn check_counts(encoding: Encoding, elements: &[Element], body: &[u8]) -> Result<()> {
    let mut least = 0usize;
    for Element { name, count, properties } in elements {
        if properties.is_empty() && *count > 0 {
            return Err(Error::new(format!("element {name} has {count} entries but no properties")));
        }
        let least_of = |property: &Property| match encoding {
            // A digit and a blank.
            Encoding::Text => 2,
            _ => property.list.unwrap_or(property.kind).size(),
        };
        let each: usize = properties.iter().map(least_of).sum();
        least = count.saturating_mul(each).saturating_add(least);
        // The last of a text may stand without a blank.
        if least > body.len() + 1 {
            let found = body.len();
            return Err(Error::new(format!(
                "element {name} has {count} entries, more than fit in {found} bytes: is it complete?"
            )));
        }
    }
    Ok(())
}

/// The corners of face `i`, with their texture coordinates if it lists any that can be theirs.
fn polygon(i: usize, face: &[f64], texcoord: &[f64], lost: &mut Vec<String>) -> Result<Vec<(u32, Option<Vec2>)>> {
    let (found, corners) = (texcoord.len(), face.len());
    let fit = found == 2 * corners;
    if !(fit || found == 0) && lost.is_empty() {
        lost.push(format!("texture coordinates: face {i} has {found} numbers for {corners} corners"));
    }
    let uvs = texcoord.as_chunks::<2>().0;
    let uv = |k: usize| uvs.get(k).filter(|_| fit).map(|&[u, v]| Vec2::new(u as f32, v as f32));
    face.iter().enumerate().map(|(k, &v)| Ok((corner(v)?, uv(k)))).collect()
}

fn corner(value: f64) -> Result<u32> {
    if value.fract() == 0.0 && (0.0..4_294_967_296.0).contains(&value) {
        Ok(value as u32)
    } else {
        Err(Error::new(format!("a face names vertex {value}, which is not a vertex number")))
    }
}

fn header(bytes: &[u8]) -> Result<(Encoding, Vec<Element>, &[u8])> {
    let mut rest = bytes;
    let mut line = || -> Result<Vec<&str>> {
        let end = rest.iter().position(|&b| b == b'\n').ok_or_else(|| Error::new("its header never ends"))?;
        let text = std::str::from_utf8(&rest[..end]).map_err(|_| Error::new("its header is not text"))?;
        rest = &rest[end + 1..];
        Ok(text.split_ascii_whitespace().collect())
    };
    if line()? != ["ply"] {
        return Err(Error::new("does not start with ply: not a .ply file"));
    }
    let mut encoding = None;
    let mut elements: Vec<Element> = Vec::new();
    loop {
        let words = line()?;
        let unknown = || Error::new(format!("header line \"{}\" is not understood", words.join(" ")));
        match words[..] {
            ["format", "ascii", _] => encoding = Some(Encoding::Text),
            ["format", "binary_little_endian", _] => encoding = Some(Encoding::Little),
            ["format", "binary_big_endian", _] => encoding = Some(Encoding::Big),
            ["comment" | "obj_info", ..] | [] => {}
            ["element", name, count] => {
                let count: usize = count.parse().map_err(|_| unknown())?;
                elements.push(Element { name: name.to_owned(), count, properties: Vec::new() });
            }
            ["property", "list", length, kind, name] => {
                let list = Some(Kind::of(length).ok_or_else(unknown)?);
                let kind = Kind::of(kind).ok_or_else(unknown)?;
                let property = Property { name: name.to_owned(), list, kind };
                elements.last_mut().ok_or_else(unknown)?.properties.push(property);
            }
            ["property", kind, name] => {
                let kind = Kind::of(kind).ok_or_else(unknown)?;
                let property = Property { name: name.to_owned(), list: None, kind };
                elements.last_mut().ok_or_else(unknown)?.properties.push(property);
            }
            ["end_header"] => break,
            _ => return Err(unknown()),
        }
    }
    let encoding = encoding.ok_or_else(|| Error::new("its header names no format"))?;
    Ok((encoding, elements, rest))
}

/// What is left to read.
struct Body<'a> {
    encoding: Encoding,
    rest: &'a [u8],
}

impl Body<'_> {
    fn number(&mut self, kind: Kind) -> Option<f64> {
        if self.encoding == Encoding::Text {
            let start = self.rest.iter().position(|b| !b.is_ascii_whitespace())?;
            let word = &self.rest[start..];
            let end = word.iter().position(u8::is_ascii_whitespace).unwrap_or(word.len());
            self.rest = &word[end..];
            return std::str::from_utf8(&word[..end]).ok()?.parse().ok();
        }
        Some(match kind {
            Kind::I8 => f64::from(i8::from_le_bytes(self.take()?)),
            Kind::U8 => f64::from(u8::from_le_bytes(self.take()?)),
            Kind::I16 => f64::from(i16::from_le_bytes(self.take()?)),
            Kind::U16 => f64::from(u16::from_le_bytes(self.take()?)),
            Kind::I32 => f64::from(i32::from_le_bytes(self.take()?)),
            Kind::U32 => f64::from(u32::from_le_bytes(self.take()?)),
            Kind::F32 => f64::from(f32::from_le_bytes(self.take()?)),
            Kind::F64 => f64::from_le_bytes(self.take()?),
        })
    }

    /// The next bytes, the least significant first.
    fn take<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (taken, rest) = self.rest.split_first_chunk::<N>()?;
        self.rest = rest;
        let mut taken = *taken;
        if self.encoding == Encoding::Big {
            taken.reverse();
        }
        Some(taken)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn from_bytes(bytes: &[u8]) -> Result<Mesh> {
        super::from_bytes(bytes, &mut Vec::new())
    }

    const HEADER: &str = "ply\nformat FORMAT 1.0\ncomment a square\nelement vertex 4\nproperty float x\nproperty uchar red\n\
        property float y\nproperty double z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";

    fn text() -> Vec<u8> {
        let body = "0 9 0 0\n1 9 0 0\n1 9 1 0.5\n0 9 1 0\n4 0 1 2 3\n";
        (HEADER.replace("FORMAT", "ascii") + body).into_bytes()
    }

    fn binary(big: bool) -> Vec<u8> {
        let mut bytes = HEADER.replace("FORMAT", if big { "binary_big_endian" } else { "binary_little_endian" });
        let mut body: Vec<u8> = Vec::new();
        let mut put = |le: &[u8]| {
            if big { body.extend(le.iter().rev()) } else { body.extend(le) }
        };
        for [x, y, z] in [[0.0f32, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.5], [0.0, 1.0, 0.0]] {
            put(&x.to_le_bytes());
            put(&[9]);
            put(&y.to_le_bytes());
            put(&f64::from(z).to_le_bytes());
        }
        put(&[4]);
        (0..4i32).for_each(|v| put(&v.to_le_bytes()));
        let mut all = std::mem::take(&mut bytes).into_bytes();
        all.extend(body);
        all
    }

    #[test]
    fn text_and_both_byte_orders_give_the_same_mesh() {
        let mesh = from_bytes(&text()).unwrap();
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
        assert_eq!(mesh.positions[2], Vec3::new(1.0, 1.0, 0.5));
        assert_eq!(from_bytes(&binary(false)).unwrap(), mesh);
        assert_eq!(from_bytes(&binary(true)).unwrap(), mesh);
    }

    #[test]
    fn further_numbers_of_vertices_are_weights_and_colours_are_shares() {
        let text = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
                    property float nx\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nproperty float quality\n\
                    property uchar part\nelement face 1\nproperty list uchar int vertex_index\nend_header\n\
                    0 0 0 1 255 255 255 0.5 3\n1 0 0 1 51 51 51 1 7\n0 1 0 1 0 255 0 0 7\n3 0 1 2\n";
        let mesh = from_bytes(text.as_bytes()).unwrap();
        let of = |name: &str| mesh.weights_named(name).map(|weights| weights.values.clone());
        assert_eq!(mesh.weight_names().collect::<Vec<_>>(), ["color", "quality", "part"]);
        assert_eq!(of("color.r"), Some(vec![1.0, 0.2, 0.0]));
        assert_eq!(of("color"), Some(vec![1.0, 0.2, 0.7152]));
        assert_eq!(of("quality"), Some(vec![0.5, 1.0, 0.0]));
        assert_eq!(of("part"), Some(vec![3.0, 7.0, 7.0]));
        // One channel alone is no colour.
        assert_eq!(from_bytes(&super::tests::text()).unwrap().weights_named("red").unwrap().values, [9.0; 4]);
    }

    #[test]
    fn texture_coordinates_of_corners_go_before_those_of_vertices() {
        let text = |names: [&str; 2], list: &str, faces: &str| {
            format!(
                "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float {}\nproperty float y\n\
                 property float z\nproperty float {}\nelement face 2\nproperty list uchar int vertex_index\n{list}\
                 end_header\n0 0 0 0 0.5\n1 0.25 0 0 0.5\n0 0 1 0 0.75\n{faces}",
                names[0], names[1]
            )
        };
        let uvs = |names: [&str; 2], list: &str, faces: &str| {
            from_bytes(text(names, list, faces).as_bytes()).map(|mesh| mesh.corner_uvs).map_err(|e| e.to_string())
        };
        let [a, b, c] = [Vec2::new(0.0, 0.5), Vec2::new(0.25, 0.5), Vec2::new(0.0, 0.75)];
        for names in UV {
            assert_eq!(uvs(names, "", "3 0 1 2\n3 0 2 1\n"), Ok(Some(vec![[a, b, c], [a, c, b]])));
        }
        assert_eq!(uvs(["s", "v"], "", "3 0 1 2\n3 0 2 1\n"), Ok(None));
        let list = "property list uchar float texcoord\n";
        let own = "3 0 1 2 6 0 0 1 0 1 1\n3 0 2 1 6 0.5 0.5 0.5 0.5 0.5 0.5\n";
        let expected = vec![[Vec2::ZERO, Vec2::X, Vec2::ONE], [Vec2::splat(0.5); 3]];
        assert_eq!(uvs(["s", "t"], list, own), Ok(Some(expected)));
        let some = "3 0 1 2 6 0 0 1 0 1 1\n3 0 2 1 0\n";
        assert_eq!(uvs(["s", "t"], list, some), Ok(Some(vec![[a, b, c], [a, c, b]])));
        // Those of the vertices stand in for a list that is too short.
        let (short, mut lost) = ("3 0 1 2 4 0 0 1 0\n3 0 2 1 0\n", Vec::new());
        let mesh = super::from_bytes(text(["s", "t"], list, short).as_bytes(), &mut lost).unwrap();
        assert_eq!(mesh.corner_uvs, Some(vec![[a, b, c], [a, c, b]]));
        assert_eq!(lost, ["texture coordinates: face 0 has 4 numbers for 3 corners"]);
    }

    #[test]
    fn truncated_and_lying_files_are_errors() {
        for file in [text(), binary(false), binary(true)] {
            // The last number of a text may lose its line's end and still be whole.
            for length in 0..file.len() - 2 {
                assert!(from_bytes(&file[..length]).is_err(), "{length}");
            }
        }
        let broken = |from: &str, to: &str| {
            let file = String::from_utf8(text()).unwrap();
            assert!(file.contains(from), "{from}");
            from_bytes(file.replacen(from, to, 1).as_bytes()).unwrap_err().to_string()
        };
        assert!(broken("vertex 4", "vertex 99999999999").contains("more than fit in"));
        assert!(
            broken("element face", "element vertex 9\nelement face").contains("vertex has 9 entries but no properties")
        );
        assert!(broken("0 1 2 3", "0 1 2 4").contains("vertex 4, but there are 4"));
        assert!(broken("0 1 2 3", "0 1 -2 3").contains("which is not a vertex number"));
        assert!(broken("1 9 1 0.5", "1 9 inf 0.5").contains("is not a place"));
        assert!(broken("4 0 1 2 3", "1e30 0 1 2 3").contains("ends within"));
        assert!(broken("property float x", "property matrix x").contains("not understood"));
    }
}
