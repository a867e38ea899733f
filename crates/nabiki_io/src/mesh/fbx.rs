//! Meshes of FBX at rest, and bent by an animation.

mod painted;
mod skin;

use std::collections::HashSet;

use glam::{DAffine3, DVec3, Vec2, Vec3};
use nabiki::Mesh;
use nabiki_exchange::{BOUND_SHAPE, Candidate, Hidden, those_that_show};
use ufbx::{ElementType, Node};

use super::check::{check, check_groups};
use super::glb::STILL_SHAPE;
use super::{TRIANGLE_BYTES, VERTEX_BYTES, push_fan};
use crate::error::{Error, Result};
use crate::fbx_file::document::{Moved, name, number, vector};
use crate::fbx_file::{Document, Outline, affine};
use crate::skin::{move_apart, movers};
use skin::{Bent, Skin};

/// Polygons of more corners are cut as fans: to cut off their ears takes the square of that number.
const MOST_CORNERS: u32 = 1000;

/// The triangles at rest, and what of the meshes is left out or not obeyed, a phrase each.
pub(crate) fn mesh(bytes: &[u8], groups: &[String]) -> Result<(Mesh, Vec<String>)> {
    let document = Document::open(bytes)?;
    let (nodes, mut unread) = chosen(&document, groups)?;
    let rest = document.rest_pose();
    let mut mesh = Mesh::default();
    for node in nodes {
        let part = Part::at_rest(&document, node, &rest)?;
        part.append_to(&mut mesh, &document, &mut unread).map_err(|e| e.under(part.name()))?;
    }
    if mesh.triangles.is_empty() && !document.scene.nurbs_surfaces.is_empty() {
        return Err(Error::new("holds NURBS surfaces and no polygons: convert them to polygons"));
    }
    let mesh = check(mesh, &mut unread)?;
    unread.sort();
    unread.dedup();
    Ok((mesh, unread))
}

/// What the file declares.
pub(crate) fn outline(bytes: &[u8]) -> Result<Outline> {
    let document = Document::open(bytes)?;
    let stacks = document.scene.anim_stacks.as_ref().iter();
    let clip = |stack: &ufbx::AnimStack| {
        let [first, last] = Moved::by(&document, stack).range;
        (stack.element.name.to_string(), last - first)
    };
    Ok(Outline {
        space: document.space()?,
        rate: document.rate(),
        meshes: document.nodes().filter(|node| node.mesh.is_some()).count(),
        clips: stacks.map(|stack| clip(stack)).collect(),
        nodes: document.nodes().filter_map(name).map(str::to_owned).collect(),
    })
}

/// The named nodes that have a mesh, with its triangles.
pub(crate) fn groups(bytes: &[u8]) -> Result<Vec<(String, usize)>> {
    let document = Document::open(bytes)?;
    let group = |node: &Node| Some((name(node)?.to_owned(), node.mesh.as_ref()?.num_triangles));
    Ok(document.nodes().filter_map(group).collect())
}

/// How many of the vertices for which `counts` holds (the file's unit) each node carries: the joint of a skin that has the largest
/// share of one, or the node of a mesh that has no skin.
pub(crate) fn carried(document: &Document, groups: &[String], counts: &dyn Fn(Vec3) -> bool) -> Result<Vec<usize>> {
    let rest = document.rest_pose();
    let mut carried = vec![0; rest.len()];
    for node in chosen(document, groups)?.0 {
        let part = Part::at_rest(document, node, &rest)?;
        for (v, _) in part.positions.iter().enumerate().filter(|(_, p)| counts(**p)) {
            carried[part.carriers.as_ref().map_or(node, |carriers| carriers[v])] += 1;
        }
    }
    Ok(carried)
}

/// The vertices of [`mesh`] at some times (s) of an animation, in its order, one time after another.
pub(crate) fn each_bent(
    bytes: &[u8],
    groups: &[String],
    clip: &str,
    times: &[f64],
    frame: &mut dyn FnMut(usize, Vec<Vec3>) -> Result<()>,
) -> Result<()> {
    let document = Document::open(bytes)?;
    let stack = document.stack(clip)?;
    // A mesh that shows at times is one mesh in all of them.
    let nodes = chosen(&document, groups)?.0;
    for (n, &time) in times.iter().enumerate() {
        document.budget.next_question();
        let scene = document.at(&stack.anim, time)?;
        let mut all = Vec::new();
        for &node in &nodes {
            let node = &scene.nodes[node];
            if let Some(mesh) = &node.mesh {
                document.budget.take(mesh.num_vertices as u64 * VERTEX_BYTES, "vertices")?;
                all.extend(bent(node, mesh));
            }
        }
        frame(n, all)?;
    }
    Ok(())
}

/// Whether an animation bends the meshes: blend shapes, or joints of a skin that move against each other, because what moves
/// one of them, or a node above it, does not move another.
pub(crate) fn bends(bytes: &[u8], groups: &[String], clip: &str) -> Result<bool> {
    let document = Document::open(bytes)?;
    let moved = Moved::by(&document, document.stack(clip)?);
    let parents: Vec<_> = document.scene.nodes.iter().map(|node| node.parent.as_deref().map(number)).collect();
    let movers = movers(&parents, |node| moved.nodes[node]);
    let nodes = chosen(&document, groups)?.0;
    let meshes = nodes.iter().filter_map(|&node| document.scene.nodes[node].mesh.as_ref());
    Ok(meshes.into_iter().any(|mesh| {
        let mut shapes = mesh.blend_deformers.as_ref().iter().flat_map(|blend| &blend.channels);
        let clusters = mesh.skin_deformers.as_ref().first().map_or(&[][..], |skin| skin.clusters.as_ref());
        let joints = clusters.iter().filter_map(|cluster| cluster.bone_node.as_ref());
        shapes.any(|shape| moved.shapes[shape.element.typed_id as usize])
            || move_apart(joints.map(|joint| movers[number(joint)]))
    }))
}

/// The vertices of a mesh in an evaluated scene.
fn bent(node: &Node, mesh: &ufbx::Mesh) -> Vec<Vec3> {
    let own = shaped(mesh);
    let skin = mesh.skin_deformers.as_ref().first();
    let place = |(v, p): (usize, &ufbx::Vec3)| {
        let matrix = match skin {
            Some(skin) if v < skin.vertices.len() => ufbx::get_skin_vertex_matrix(skin, v, &node.geometry_to_world),
            _ => node.geometry_to_world,
        };
        affine(&matrix).transform_point3(vector(*p)).as_vec3()
    };
    own.iter().enumerate().map(place).collect()
}

/// The vertices of a mesh in its own space, moved by its blend shapes.
fn shaped(mesh: &ufbx::Mesh) -> Vec<ufbx::Vec3> {
    let mut own = mesh.vertices.as_ref().to_vec();
    for blend in &mesh.blend_deformers {
        ufbx::add_blend_vertex_offsets(blend, &mut own, 1.0);
    }
    own
}

/// The nodes whose meshes show, or of these what `groups` name, and phrases about what is hidden.
fn chosen(document: &Document, groups: &[String]) -> Result<(Vec<usize>, Vec<String>)> {
    let names: HashSet<&str> =
        document.nodes().flat_map(|node| name(node).into_iter().chain(mesh_name(node))).collect();
    let mut names: Vec<&str> = names.into_iter().collect();
    names.sort_unstable();
    check_groups(groups, &names)?;
    let wanted = |name: Option<&str>| name.is_some_and(|name| groups.iter().any(|group| group == name));
    let count = document.nodes().len();
    let (mut is_wanted, mut hidden) = (vec![groups.is_empty(); count], vec![None; count]);
    let mut candidates = Vec::new();
    for (n, node) in document.nodes().enumerate() {
        if let Some(parent) = &node.parent {
            is_wanted[n] |= is_wanted[number(parent)];
            hidden[n] = hidden[number(parent)];
        }
        is_wanted[n] |= wanted(name(node));
        hidden[n] = hidden[n].or_else(|| is_hidden(node).then_some(node));
        if node.mesh.is_some() && (is_wanted[n] || wanted(mesh_name(node))) {
            let path = name(node).map_or_else(|| "without a name".to_owned(), short);
            candidates.push(Candidate { mesh: n, path, hidden: hidden[n].map(hidden_by).into_iter().collect() });
        }
    }
    Ok(those_that_show(candidates))
}

/// Whether a node is hidden, and what is below it: by its visibility, or since its parent shows it from afar.
fn is_hidden(node: &Node) -> bool {
    let first = |levels: &Node| levels.children.as_ref().first().map(|child| number(child));
    !node.visible || levels(node).is_some_and(|levels| first(levels) != Some(number(node)))
}

/// What hides such a node.
fn hidden_by(node: &Node) -> Hidden {
    let by = |of: &Node, name, value: &str| Hidden {
        by: short(&of.element.name),
        name,
        value: value.to_owned(),
        at_times: false,
    };
    match levels(node) {
        Some(levels) if node.visible => by(levels, "level of detail", "coarser"),
        _ => by(node, "Visibility", "0"),
    }
}

/// What a node is a level of detail of.
fn levels(node: &Node) -> Option<&Node> {
    node.parent.as_deref().filter(|parent| parent.attrib_type == ElementType::LodGroup)
}

/// A name for phrases, of which each may have as many as the file has nodes.
fn short(name: &str) -> String {
    format!("{name:.80}")
}

fn mesh_name(node: &Node) -> Option<&str> {
    node.mesh.as_ref().map(|mesh| &*mesh.element.name).filter(|name| !name.is_empty())
}

/// The mesh of a node at rest.
struct Part<'a> {
    node: &'a Node,
    mesh: &'a ufbx::Mesh,
    positions: Vec<Vec3>,
    /// The number of the joint that has the largest share of each; `None` without a skin.
    carriers: Option<Vec<usize>>,
    /// Whether what places it turns the surface inside out.
    mirrored: bool,
}

impl<'a> Part<'a> {
    fn at_rest(document: &'a Document, node: usize, rest: &[DAffine3]) -> Result<Self> {
        let scene_from_node = rest[node];
        let node = &document.scene.nodes[node];
        let mesh = node.mesh.as_ref().ok_or_else(|| Error::new("a node has lost its mesh"))?;
        // A mesh that many nodes show is copied for each.
        document.budget.take(mesh.num_vertices as u64 * VERTEX_BYTES, "vertices")?;
        let own: Vec<DVec3> = shaped(mesh).into_iter().map(vector).collect();
        let scene_from_mesh = scene_from_node * affine(&node.geometry_to_node);
        if let Some(skin) = mesh.skin_deformers.as_ref().first() {
            let Bent { positions, carriers, mirrored } =
                Skin::new(skin, rest).bend(&own, (scene_from_mesh, number(node)));
            return Ok(Self { node, mesh, positions, carriers: Some(carriers), mirrored });
        }
        let positions = own.iter().map(|&p| scene_from_mesh.transform_point3(p).as_vec3()).collect();
        let mirrored = scene_from_mesh.matrix3.determinant() < 0.0;
        Ok(Self { node, mesh, positions, carriers: None, mirrored })
    }

    /// Adds its triangles, and to `unread` what of it is left out or not obeyed.
    fn append_to(&self, mesh: &mut Mesh, document: &Document, unread: &mut Vec<String>) -> Result<()> {
        let first = u32::try_from(mesh.positions.len()).map_err(|_| Error::new("more than 2^32 vertices"))?;
        if let Some(v) = self.positions.iter().position(|p| !p.is_finite()) {
            return Err(Error::new(format!("vertex {v} is not finite: export it again")));
        }
        document.budget.take(self.mesh.num_triangles as u64 * TRIANGLE_BYTES, "triangles")?;
        mesh.positions.extend(&self.positions);
        let vertex = |corner: u32| self.mesh.vertex_indices[corner as usize];
        if self.mesh.vertex_indices.as_ref().iter().any(|&v| v as usize >= self.positions.len()) {
            return Err(Error::new(format!("a corner is past its {} vertices: export it again", self.positions.len())));
        }
        let uvs = &self.mesh.vertex_uv;
        let uv = |corner: u32| {
            let index = uvs.indices.as_ref().get(corner as usize)?;
            uvs.values.as_ref().get(*index as usize).map(|uv| Vec2::new(uv.x as f32, uv.y as f32))
        };
        let mut corners = Vec::new();
        for face in self.mesh.faces.as_ref() {
            if (4..=MOST_CORNERS).contains(&face.num_indices) {
                let count = ufbx::triangulate_face_vec(&mut corners, self.mesh, *face);
                corners.truncate(3 * count as usize);
            } else {
                let own = face.index_begin..face.index_begin + face.num_indices;
                fan(&mut corners, own);
            }
            for &[a, b, c] in corners.as_chunks::<3>().0 {
                let triangle = if self.mirrored { [a, c, b] } else { [a, b, c] };
                push_fan(mesh, &triangle.map(|corner| (first + vertex(corner), uv(corner))));
            }
        }
        for (name, why) in painted::add(self.mesh, &document.budget, mesh, first as usize) {
            unread.push(format!("{name} of {}: {why}", self.name()));
        }
        unread.extend(self.bends());
        Ok(())
    }

    /// What of it bends over time, which a rigid head or body does not, and what is not read.
    fn bends(&self) -> Vec<String> {
        let (name, mesh) = (self.name(), self.mesh);
        let mut unread = Vec::new();
        let clusters = mesh.skin_deformers.as_ref().first().map_or(0, |skin| skin.clusters.count);
        match clusters {
            0 => {}
            1 => unread.push(format!("the joint that {name} is bound to: {BOUND_SHAPE}")),
            joints => unread.push(format!("the {joints} joints that {name} is bound to: {BOUND_SHAPE}")),
        }
        match mesh.blend_deformers.as_ref().iter().map(|blend| blend.channels.count).sum::<usize>() {
            0 => {}
            1 => unread.push(format!("changes of the blend shape of {name}: {STILL_SHAPE}")),
            shapes => unread.push(format!("changes of the {shapes} blend shapes of {name}: {STILL_SHAPE}")),
        }
        if mesh.skin_deformers.count > 1 {
            unread.push(format!("{} more skins of {name}: only its first moves it", mesh.skin_deformers.count - 1));
        }
        if mesh.cache_deformers.count > 0 {
            unread.push(format!("the point cache of {name}: give its .pc2 as the motion"));
        }
        unread
    }

    fn name(&self) -> String {
        name(self.node).or(mesh_name(self.node)).map_or_else(|| format!("mesh {}", number(self.node)), short)
    }
}

/// Cuts a polygon of these corners into triangles from its first. Points and edges have none.
fn fan(corners: &mut Vec<u32>, of: std::ops::Range<u32>) {
    corners.clear();
    let (first, end) = (of.start, of.end);
    corners.extend((first + 2..end.max(first + 2)).flat_map(|c| [first, c - 1, c]));
}
