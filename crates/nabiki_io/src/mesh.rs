//! Triangle meshes of heads: .obj, .glb, .gltf, .fbx, .ply, .tfxmesh, USD and Alembic. The ending of the name decides.

mod check;
#[cfg(feature = "fbx")]
pub(crate) mod fbx;
pub(crate) mod glb;
mod obj;
pub(crate) mod parts;
mod ply;
mod tfxmesh;

use std::{
    collections::{HashMap, HashSet},
    path::Path,
};

use glam::{Vec2, Vec3};
use nabiki::Mesh;
use serde::Serialize;

use crate::{
    error::{Error, Result},
    exchange, fbx_file,
    input::{self, MOST_BINARY_BYTES, MOST_TEXT_BYTES},
    kind::{extension, way_out},
    placement::Placement,
};

/// The results of a mesh import, before and after cleaning.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct MeshReport {
    /// Vertices of the chosen groups in the file.
    pub vertices_in_file: usize,
    /// Vertices joined because they are at the same position as another (seams of UVs and normals).
    pub joined_vertices: usize,
    /// Triangles dropped because two of their corners coincide.
    pub dropped_triangles: usize,
    /// Phrases about data of the file's meshes that is not used.
    pub unread: Vec<String>,
}

/// Reads the triangles of a mesh file in its unit and axes. `groups` are the names of .obj groups or objects, glTF
/// or FBX nodes or meshes, USD prims or Alembic objects to keep; if empty, everything is kept. Larger polygons become fans.
/// Node transforms are applied, glTF skins are deformed by the joints' pose in the file, and FBX skins
/// are in their bind pose.
pub fn read(path: &Path, groups: &[String]) -> Result<Mesh> {
    read_with_losses(path, groups).map(|(mesh, _)| mesh)
}

/// Like [`read`]; also returns phrases about data of the meshes that is not used.
pub fn read_with_losses(path: &Path, groups: &[String]) -> Result<(Mesh, Vec<String>)> {
    let named = |e: Error| e.in_file(path);
    let text = || input::read(path, MOST_TEXT_BYTES);
    let binary = || input::read(path, MOST_BINARY_BYTES);
    match extension(path).as_str() {
        "obj" => with_losses(&mut |lost| obj::from_bytes(&text()?, groups, lost)).map_err(named),
        "glb" | "gltf" => glb::from_bytes(&binary()?, path.parent(), groups).map_err(named),
        "fbx" => fbx_file::mesh(&binary()?, groups).map_err(named),
        "ply" => with_losses(&mut |lost| ply(without_mark(&binary()?), groups, lost)).map_err(named),
        "tfxmesh" => from_bytes(&text()?, "tfxmesh", groups).map(|mesh| (mesh, Vec::new())).map_err(named),
        "abc" | "usd" | "usda" | "usdc" => exchange::mesh(path, groups),
        other => {
            // A name without an ending may be a slip, or a folder.
            if other.is_empty() {
                input::open(path)?;
            }
            let known = ".obj, .glb, .gltf, .fbx, .ply, .tfxmesh, .usd, .usda, .usdc or .abc";
            Err(named(Error::new(format!("ending \"{other}\" is not a mesh format: {known}{}", way_out(other)))))
        }
    }
}

/// What `read` answers, with what it says is lost.
fn with_losses(read: &mut dyn FnMut(&mut Vec<String>) -> Result<Mesh>) -> Result<(Mesh, Vec<String>)> {
    let mut lost = Vec::new();
    Ok((read(&mut lost)?, lost))
}

/// Whether the file name ends like a glTF.
pub fn is_gltf(path: &Path) -> bool {
    matches!(extension(path).as_str(), "glb" | "gltf")
}

/// Whether the file name ends like an FBX.
pub fn is_fbx(path: &Path) -> bool {
    fbx_file::is_fbx(path)
}

/// What some editors put before a text is no part of it.
fn without_mark(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(input::BYTE_ORDER_MARK).unwrap_or(bytes)
}

/// Names for choosing parts of a mesh file, with the number of faces of each, most faces first: groups and objects of a
/// .obj, nodes of a glTF or FBX with a mesh, and paths of meshes in a USD layer or Alembic archive. Empty for other formats.
///
/// # Errors
/// A file that cannot be read.
pub fn groups(path: &Path) -> Result<Vec<(String, usize)>> {
    let mut groups = match extension(path).as_str() {
        "obj" => obj::groups(&input::read(path, MOST_TEXT_BYTES)?),
        "glb" | "gltf" => glb::groups(&input::read(path, MOST_BINARY_BYTES)?).map_err(|e| e.in_file(path))?,
        "fbx" => fbx_file::groups(&input::read(path, MOST_BINARY_BYTES)?).map_err(|e| e.in_file(path))?,
        _ if exchange::is_usd(path) || exchange::is_alembic(path) => exchange::mesh_sizes(path)?,
        _ => Vec::new(),
    };
    groups.sort_by(|a, b| b.1.cmp(&a.1).then_with(|| a.0.cmp(&b.0)));
    Ok(groups)
}

/// Reads a mesh from memory. `extension` is `obj`, `ply`, `tfxmesh`, `fbx`, `glb` or `gltf`. Buffers in separate files are
/// refused.
pub fn from_bytes(bytes: &[u8], extension: &str, groups: &[String]) -> Result<Mesh> {
    match extension {
        "obj" => obj::from_bytes(bytes, groups, &mut Vec::new()),
        "ply" => ply(bytes, groups, &mut Vec::new()),
        "tfxmesh" => tfxmesh::from_bytes(bytes).and_then(|mesh| without_parts(mesh, groups)),
        "fbx" => fbx_file::mesh(bytes, groups).map(|(mesh, _)| mesh),
        _ => glb::from_bytes(bytes, None, groups).map(|(mesh, _)| mesh),
    }
}

fn ply(bytes: &[u8], groups: &[String], lost: &mut Vec<String>) -> Result<Mesh> {
    ply::from_bytes(bytes, lost).and_then(|mesh| without_parts(mesh, groups))
}

/// A mesh of a format that has no groups: none may be asked for.
fn without_parts(mesh: Mesh, groups: &[String]) -> Result<Mesh> {
    check::check_groups(groups, &[]).map(|()| mesh)
}

/// Reads a mesh into head space, joins vertices at the same position and drops triangles without area.
pub fn import(path: &Path, placement: &Placement, groups: &[String]) -> Result<(Mesh, MeshReport)> {
    placement.check("head").map_err(|e| Error::from(e).in_file(path))?;
    let (mesh, unread) = read_with_losses(path, groups)?;
    let (mesh, report) = place_and_weld(mesh, placement).map_err(|e| e.in_file(path))?;
    Ok((mesh, MeshReport { unread, ..report }))
}

/// Like [`import`], for a mesh that was read by this crate or another.
pub fn place_and_weld(mesh: Mesh, placement: &Placement) -> Result<(Mesh, MeshReport)> {
    let vertices_in_file = mesh.positions.len();
    let triangles_in_file = mesh.triangles.len();
    let mut welded = weld(mesh);
    let head_from_file = placement.head_from_file();
    for (v, p) in welded.positions.iter_mut().enumerate() {
        *p = head_from_file.transform_point3(*p);
        if !p.is_finite() {
            return Err(Error::new(format!(
                "vertex {v} leaves the range of f32 when converted to cm: check head.unit"
            )));
        }
    }
    let report = MeshReport {
        vertices_in_file,
        joined_vertices: vertices_in_file - welded.positions.len(),
        dropped_triangles: triangles_in_file - welded.triangles.len(),
        unread: Vec::new(),
    };
    if welded.triangles.is_empty() {
        return Err(Error::new(
            "holds no triangle with an area: is a transform's scale 0, or head.unit far too small?",
        ));
    }
    Ok((welded, report))
}

/// What a vertex takes in memory until it is welded and its edges are counted, and what a triangle does; half of that, as budgets
/// count.
const VERTEX_BYTES: u64 = 50;
const TRIANGLE_BYTES: u64 = 60;

/// Appends a polygon, cut into triangles from its first corner: the vertex and the texture coordinates of each.
fn push_fan(mesh: &mut Mesh, polygon: &[(u32, Option<Vec2>)]) {
    for k in 2..polygon.len() {
        let corners = [polygon[0], polygon[k - 1], polygon[k]];
        let uvs = match corners.map(|(_, uv)| uv) {
            [Some(a), Some(b), Some(c)] => Some([a, b, c]),
            _ => None,
        };
        mesh.push(corners.map(|(vertex, _)| vertex), uvs);
    }
}

/// Which vertices of a mesh are left once those at the same place are joined.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Welded {
    /// How many it had.
    pub vertices: usize,
    /// The numbers of those that are left, in their order.
    pub kept: Vec<u32>,
}

/// Those that [`import`] and [`place_and_weld`] keep of these positions.
#[must_use]
pub fn welded_from(positions: &[Vec3]) -> Welded {
    let mut seen = HashSet::with_capacity(positions.len());
    let first = positions.iter().enumerate().filter(|(_, p)| seen.insert(place(**p)));
    Welded { vertices: positions.len(), kept: first.map(|(v, _)| v as u32).collect() }
}

/// The same for positions that are equal: adding 0 turns -0 into 0.
fn place(p: Vec3) -> [u32; 3] {
    (p + 0.0).to_array().map(f32::to_bits)
}

/// Joins vertices at the very same place (the first of them stays, with its weights) and drops triangles with coinciding
/// corners. What is left keeps the texture coordinates of its own corners, so that seams stay.
fn weld(mesh: Mesh) -> Mesh {
    let mut numbers: HashMap<[u32; 3], u32> = HashMap::with_capacity(mesh.positions.len());
    let (mut positions, mut kept) = (Vec::new(), Vec::new());
    let number: Vec<u32> = (0..)
        .zip(&mesh.positions)
        .map(|(v, &p)| {
            *numbers.entry(place(p)).or_insert_with(|| {
                positions.push(p);
                kept.push(v);
                positions.len() as u32 - 1
            })
        })
        .collect();
    let weights = mesh.weights.iter().map(|weights| weights.of_vertices(kept.iter().copied())).collect();
    let mut welded = Mesh { positions, weights, ..Mesh::default() };
    for (t, triangle) in mesh.triangles.iter().enumerate() {
        let [a, b, c] = triangle.map(|v| number[v as usize]);
        if a != b && b != c && c != a {
            welded.push([a, b, c], mesh.corner_uvs.as_ref().map(|uvs| uvs[t]));
        }
    }
    welded
}

#[cfg(test)]
mod tests {
    use super::*;

    const TWO_GROUPS: &str = "\
        v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\n\
        g body\nf 1 2 3 4\ng helper\nf 1 2 5\n";

    #[test]
    fn quads_become_triangles_and_groups_are_chosen() {
        let all = from_bytes(TWO_GROUPS.as_bytes(), "obj", &[]).unwrap();
        assert_eq!(all.triangles.len(), 3);
        let body = from_bytes(TWO_GROUPS.as_bytes(), "obj", &["body".to_owned()]).unwrap();
        assert_eq!(body.triangles.len(), 2);
        assert_eq!(body.positions.len(), 4, "vertices of other groups are not carried along");
    }

    #[test]
    fn an_unknown_group_is_refused_with_the_nearest() {
        let error = from_bytes(TWO_GROUPS.as_bytes(), "obj", &["bdoy".to_owned()]).unwrap_err();
        assert_eq!(error.to_string(), "group \"bdoy\" is not in the file; did you mean \"body\"?");
    }

    #[test]
    fn seams_are_joined_and_slivers_dropped_and_both_counted() {
        let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\nf 4 6 5\nf 1 4 2\n";
        let mesh = from_bytes(text.as_bytes(), "obj", &[]).unwrap();
        let (mesh, report) = place_and_weld(mesh, &Placement::default()).unwrap();
        assert_eq!(
            report,
            MeshReport { vertices_in_file: 6, joined_vertices: 2, dropped_triangles: 1, unread: Vec::new() }
        );
        assert_eq!((mesh.positions.len(), mesh.triangles.len()), (4, 2));
    }

    #[test]
    fn joined_vertices_keep_the_weights_of_the_first() {
        let text =
            "v 0 0 0 0.5 0.5 0.5\nv 1 0 0\nv 0 1 0 1 1 1\nv 0 0 0 1 1 1\nv 0 0 1 0.25 0.25 0.25\nf 1 2 3\nf 4 5 2\n";
        let mesh = from_bytes(text.as_bytes(), "obj", &[]).unwrap();
        let (mesh, report) = place_and_weld(mesh, &Placement::default()).unwrap();
        assert_eq!(report.joined_vertices, 1);
        assert_eq!(mesh.weights_named("color").unwrap().values, [0.5, 0.0, 1.0, 0.25]);
    }

    #[test]
    fn vertices_are_joined_whichever_sign_their_nought_has() {
        let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv -0 0 -0\nv 1 -0 0\nv 0 0 1\nf 1 2 3\nf 4 6 5\n";
        let mesh = from_bytes(text.as_bytes(), "obj", &[]).unwrap();
        let (mesh, report) = place_and_weld(mesh, &Placement::default()).unwrap();
        assert_eq!((report.joined_vertices, mesh.triangles), (2, vec![[0, 1, 2], [0, 3, 1]]));
    }

    #[test]
    fn a_fan_keeps_the_texture_coordinates_of_its_corners_on_both_sides_of_a_seam() {
        let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 0\nv 1 0 0\nv 0 0 1\nvt 0 0\nvt 1 0 0\nvt 1 1\nvt 0.5\n\
                    f 1/1 2/2 3/3 4/4\nf 5/-1 7/-2/1 6/2/2\nf 5/1 1/1 2/2\n";
        let mesh = from_bytes(text.as_bytes(), "obj", &[]).unwrap();
        let (mesh, report) = place_and_weld(mesh, &Placement::default()).unwrap();
        assert_eq!(
            report,
            MeshReport { vertices_in_file: 7, joined_vertices: 2, dropped_triangles: 1, unread: Vec::new() }
        );
        let [a, b, c, d] = [Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::new(0.5, 0.0)];
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3], [0, 4, 1]]);
        assert_eq!(mesh.corner_uvs, Some(vec![[a, b, c], [a, c, d], [d, c, b]]));
    }

    #[test]
    fn a_mesh_has_texture_coordinates_for_all_its_faces_or_none() {
        let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\no a\nf 1/1 2/1 3/1\no b\nf 1/1 3//1 2/1\n";
        let uvs = |groups: &[String]| from_bytes(text.as_bytes(), "obj", groups).unwrap().corner_uvs;
        assert_eq!((uvs(&[]), uvs(&["b".to_owned()])), (None, None));
        assert_eq!(uvs(&["a".to_owned()]), Some(vec![[Vec2::ZERO; 3]]));
    }

    #[test]
    fn what_cannot_be_a_mesh_is_refused() {
        let refused = |text: &str| from_bytes(text.as_bytes(), "obj", &[]).unwrap_err().to_string();
        assert_eq!(refused("v 0 0 0\n"), "holds 1 vertices but no faces: not a head");
        let nan = refused("v 0 0 0\nv 1 0 0\nv 0 nan 0\nf 1 2 3\n");
        assert_eq!(nan, "vertex 2: (0, NaN, 0) is not a place: coordinates must be finite");
        assert_eq!(refused("v 0 0 0\nf 1 2 3\n"), "\"f 1 2 3\": \"2\" is not one of the 1 vertices before this line");
        assert_eq!(refused("v 0 0 0\nf 1 1\n"), "\"f 1 1\": a face needs at least three vertices");
        // Found by fuzzing.
        assert!(refused("v 1 0 0\nv 2 3 4\nf -1//-2 //4 1\n").contains("\"//4\" is not one of the 2 vertices"));
    }

    #[test]
    fn texture_coordinates_that_are_none_cost_the_shape_nothing_and_are_said() {
        let read = |text: &str| {
            let mut lost = Vec::new();
            let mesh = obj::from_bytes(text.as_bytes(), &[], &mut lost).unwrap();
            assert_eq!((mesh.triangles.len(), mesh.corner_uvs), (1, None), "{text}");
            lost
        };
        let named = "texture coordinates: line 5: \"f 1/1 2/2 3\": \"2/2\" is not one of the 1 texture coordinates before \
                     this line";
        assert_eq!(read("v 1 0 0\nv 2 3 4\nv 0 0 1\nvt 0 0\nf 1/1 2/2 3\n"), [named]);
        let word = "texture coordinates: line 4: \"vt 0 x\": texture coordinates need one to three numbers";
        assert_eq!(read("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 x\nvt 0 0\nf 1/1 2/2 3/2\n"), [word]);
        let nan = "texture coordinates: those of triangle 0 are (0, NaN), which are not finite";
        assert_eq!(read("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 nan\nf 1/1 2/1 3/1\n"), [nan]);
        // One that no face names is nothing's loss.
        let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 x\nvt 0 0\nf 1/2 2/2 3/2\n";
        let (mut lost, uvs) = (Vec::new(), Some(vec![[Vec2::ZERO; 3]]));
        assert_eq!(obj::from_bytes(text.as_bytes(), &[], &mut lost).unwrap().corner_uvs, uvs);
        assert!(lost.is_empty(), "{lost:?}");
    }
}
