//! glTF 2.0, .glb and .gltf, by way of the crate gltf: triangles of the default scene in its still pose, the one that it has without
//! its animations: node transforms applied, skins by their joints, morphs by the file's own weights.

mod painted;
mod skin;

use std::path::Path;

use glam::{DAffine3, Vec2, Vec3};
use gltf::{Semantic, mesh::Mode};
use nabiki::Mesh;

use super::check::{check, check_groups};
use super::{TRIANGLE_BYTES, VERTEX_BYTES};
use crate::error::{Error, Result};
use crate::gltf_file::accessors::{Whole, numbers, whole_numbers};
use crate::gltf_file::{Buffers, open, pose};
use crate::motion::Clip;
use crate::skin::{move_apart, movers};
use skin::Skin;

/// The triangles, and what of the meshes is left out or not obeyed, a phrase each. `folder`: where buffers in files of their own
/// are; `None` refuses them.
pub(super) fn from_bytes(bytes: &[u8], folder: Option<&Path>, groups: &[String]) -> Result<(Mesh, Vec<String>)> {
    let (document, blob) = open(bytes)?;
    let buffers = Buffers::new(&document, bytes, blob, folder)?;
    let (mut mesh, mut unread) = (Mesh::default(), Vec::new());
    each_part(&document, &buffers, groups, None, &mut |part| part.append_to(&mut mesh, &buffers, &mut unread))?;
    let used = |extension: &str| document.extensions_used().any(|used| used == extension);
    if mesh.corner_uvs.is_some() && used("KHR_texture_transform") {
        unread.push("KHR_texture_transform: texture coordinates are read without it".to_owned());
    }
    if used("EXT_mesh_gpu_instancing") {
        unread.push("EXT_mesh_gpu_instancing: each mesh is used once, at its node".to_owned());
    }
    if mesh.triangles.is_empty()
        && let Some(mode) =
            document.meshes().flat_map(|mesh| mesh.primitives()).find_map(|other| not_a_surface(other.mode()))
    {
        return Err(Error::new(format!("holds {mode} and no triangles: export triangles")));
    }
    let mesh = check(mesh, &mut unread)?;
    unread.sort();
    unread.dedup();
    Ok((mesh, unread))
}

/// How many of the vertices for which `counts` holds (the file's unit) each node carries: the joint of a skin that has the largest
/// share of one, or the node of a mesh that has no skin.
pub(crate) fn carried(
    document: &gltf::Document,
    buffers: &Buffers<'_>,
    groups: &[String],
    counts: &dyn Fn(Vec3) -> bool,
) -> Result<Vec<usize>> {
    let mut carried = vec![0; document.nodes().len()];
    each_part(document, buffers, groups, None, &mut |part| {
        for (v, _) in part.positions.iter().enumerate().filter(|(_, p)| counts(**p)) {
            carried[part.carriers.as_ref().map_or(part.node.index(), |carriers| carriers[v])] += 1;
        }
        Ok(())
    })?;
    Ok(carried)
}

/// The named nodes that have a mesh, with its triangles.
pub(super) fn groups(bytes: &[u8]) -> Result<Vec<(String, usize)>> {
    let (document, _) = open(bytes)?;
    let corners = |primitive: gltf::Primitive| {
        let counted = primitive.indices().or_else(|| primitive.get(&Semantic::Positions));
        counted.map_or(0, |accessor| accessor.count())
    };
    let group = |node: gltf::Node| {
        let (name, mesh) = (node.name()?.to_owned(), node.mesh()?);
        Some((name, mesh.primitives().map(corners).sum::<usize>() / 3))
    };
    Ok(document.nodes().filter_map(group).collect())
}

/// What a primitive is that is not a surface, such as loose edges that were exported with one.
fn not_a_surface(mode: Mode) -> Option<&'static str> {
    match mode {
        Mode::Points => Some("points"),
        Mode::Lines | Mode::LineLoop | Mode::LineStrip => Some("lines"),
        Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan => None,
    }
}

/// The triangles of the vertices that a primitive goes through.
fn triangles(mode: Mode, corners: &[u32]) -> Vec<[u32; 3]> {
    match mode {
        // Every other one is wound the other way.
        Mode::TriangleStrip => {
            let turned = |(n, t): (usize, &[u32])| if n % 2 == 0 { [t[0], t[1], t[2]] } else { [t[1], t[0], t[2]] };
            corners.windows(3).enumerate().map(turned).collect()
        }
        Mode::TriangleFan => corners.windows(2).skip(1).map(|t| [corners[0], t[0], t[1]]).collect(),
        _ => corners.as_chunks::<3>().0.to_vec(),
    }
}

/// What becomes of a mesh that bends, where a head or body does not.
pub(crate) const STILL_SHAPE: &str = "it keeps its shape in the file's still pose";

/// A primitive of a mesh as one of its nodes has it.
struct Part<'a> {
    node: gltf::Node<'a>,
    mesh: gltf::Mesh<'a>,
    primitive: gltf::Primitive<'a>,
    /// Of its vertices in the still pose.
    positions: Vec<Vec3>,
    /// The node of the joint that has the largest share of each; `None` without a skin.
    carriers: Option<Vec<usize>>,
    /// Whether what places it turns the surface inside out.
    mirrored: bool,
}

/// An animation at a time (s).
#[derive(Clone, Copy)]
struct Playing<'a> {
    clip: &'a Clip,
    time: f64,
}

/// The vertices of [`from_bytes`] at some times (s) of an animation, in its order, one time after another.
pub(crate) fn each_bent(
    bytes: &[u8],
    folder: Option<&Path>,
    groups: &[String],
    clip: &str,
    times: &[f64],
    frame: &mut dyn FnMut(usize, Vec<Vec3>) -> Result<()>,
) -> Result<()> {
    let (document, blob) = open(bytes)?;
    let buffers = Buffers::new(&document, bytes, blob, folder)?;
    let clip = Clip::read(&document, &buffers, clip, &|_| true)?;
    for (n, &time) in times.iter().enumerate() {
        buffers.budget.next_question();
        let mut all = Vec::new();
        each_part(&document, &buffers, groups, Some(Playing { clip: &clip, time }), &mut |part| {
            all.extend(&part.positions);
            Ok(())
        })?;
        frame(n, all)?;
    }
    Ok(())
}

/// Whether an animation bends the meshes: morphs, or joints of a skin that move against each other.
pub(crate) fn bends(bytes: &[u8], folder: Option<&Path>, groups: &[String], clip: &str) -> Result<bool> {
    let (document, blob) = open(bytes)?;
    let buffers = Buffers::new(&document, bytes, blob, folder)?;
    let parents = pose::parents(&document)?;
    let (mut nodes, mut skins) = (Vec::new(), Vec::new());
    each_part(&document, &buffers, groups, None, &mut |part| {
        nodes.push(part.node.index());
        let skin = part.node.skin().filter(|_| part.carriers.is_some());
        skins.extend(skin.map(|skin| skin.index()));
        Ok(())
    })?;
    nodes.sort_unstable();
    skins.sort_unstable();
    skins.dedup();
    let joints = |skin: &gltf::Skin| skin.joints().map(|joint| joint.index()).collect::<Vec<_>>();
    let skins: Vec<Vec<usize>> =
        document.skins().filter(|skin| skins.contains(&skin.index())).map(|skin| joints(&skin)).collect();
    let mut carries = vec![false; parents.len()];
    for &joint in skins.iter().flatten() {
        // Up to what is known to carry one.
        let mut at = Some(joint);
        while let Some(node) = at.filter(|&node| !std::mem::replace(&mut carries[node], true)) {
            at = parents[node];
        }
    }
    let wanted = |node| carries[node] || nodes.binary_search(&node).is_ok();
    let clip = Clip::read(&document, &buffers, clip, &wanted)?;
    let movers = movers(&parents, |node| clip.moves([node]));
    let bent = |skin: &Vec<usize>| move_apart(skin.iter().map(|&joint| movers[joint]));
    Ok(nodes.iter().any(|&node| clip.morphs(node)) || skins.iter().any(bent))
}

/// Goes through what the default scene shows, or of it what `groups` name: in the still pose, or as an animation has it.
fn each_part<'a>(
    document: &'a gltf::Document,
    buffers: &Buffers<'_>,
    groups: &[String],
    playing: Option<Playing<'_>>,
    visit: &mut dyn FnMut(&Part<'a>) -> Result<()>,
) -> Result<()> {
    let nodes = document.nodes().filter_map(|n| n.name());
    let names: Vec<&str> = nodes.chain(document.meshes().filter_map(|m| m.name())).collect();
    check_groups(groups, &names)?;
    let wanted = |name: Option<&str>| name.is_some_and(|name| groups.iter().any(|g| g == name));

    let moved = |node: &gltf::Node| playing.and_then(|Playing { clip, time }| clip.transform(node.index(), time));
    let pose = pose::pose(document, &moved)?;
    let mut skins: Vec<Option<Skin>> = document.skins().map(|_| None).collect();
    let mut seen = vec![false; document.nodes().len()];
    let scene = document.default_scene().or_else(|| document.scenes().next());
    let roots: Vec<_> = match scene {
        Some(scene) => scene.nodes().collect(),
        None => {
            let parents = pose::parents(document)?;
            document.nodes().filter(|node| parents[node.index()].is_none()).collect()
        }
    };
    let mut open: Vec<_> = roots.into_iter().map(|node| (node, groups.is_empty())).collect();
    open.reverse();
    while let Some((node, parent_wanted)) = open.pop() {
        if std::mem::replace(&mut seen[node.index()], true) {
            return Err(Error::new(format!("node {} has two parents or is its own ancestor", node.index())));
        }
        let own_ancestor = || Error::new(format!("node {} is its own ancestor", node.index()));
        let scene_from_node = pose[node.index()].ok_or_else(own_ancestor)?;
        let node_wanted = parent_wanted || wanted(node.name());
        if let Some(mesh) = node.mesh().filter(|m| node_wanted || wanted(m.name())) {
            let skin = match node.skin() {
                Some(skin) => {
                    let known = &mut skins[skin.index()];
                    if known.is_none() {
                        *known = Some(Skin::new(&skin, &pose, buffers)?);
                    }
                    known.as_ref()
                }
                None => None,
            };
            for primitive in mesh.primitives() {
                let named = |e: Error| Error::new(format!("mesh {}: {}", mesh.index(), e.what));
                let (node, mesh) = (node.clone(), mesh.clone());
                let weights = playing.and_then(|Playing { clip, time }| clip.weights(node.index(), time));
                let part =
                    Part::new(node, mesh, primitive, buffers, scene_from_node, (skin, weights)).map_err(named)?;
                visit(&part).map_err(named)?;
            }
        }
        open.extend(node.children().map(|child| (child, node_wanted)));
    }
    Ok(())
}

impl<'a> Part<'a> {
    fn new(
        node: gltf::Node<'a>,
        mesh: gltf::Mesh<'a>,
        primitive: gltf::Primitive<'a>,
        buffers: &Buffers<'_>,
        scene_from_node: DAffine3,
        (skin, weights): (Option<&Skin>, Option<Vec<f32>>),
    ) -> Result<Self> {
        if not_a_surface(primitive.mode()).is_some() {
            return Ok(Self { node, mesh, primitive, positions: Vec::new(), carriers: None, mirrored: false });
        }
        // A mesh drawn by many nodes is copied for each.
        let vertices = primitive.get(&Semantic::Positions).map_or(0, |accessor| accessor.count());
        buffers.budget.take(vertices as u64 * VERTEX_BYTES, "vertices")?;
        let still = node.weights().or(mesh.weights()).unwrap_or_default();
        let own = positions(&primitive, weights.as_deref().unwrap_or(still), buffers)?;
        if let Some(bent) = skin.map(|skin| skin.bend(&primitive, &own, buffers)).transpose()?.flatten() {
            let (positions, carriers, mirrored) = (bent.positions, Some(bent.carriers), bent.mirrored);
            return Ok(Self { node, mesh, primitive, positions, carriers, mirrored });
        }
        let positions = own.iter().map(|p| scene_from_node.transform_point3(p.as_dvec3()).as_vec3()).collect();
        let mirrored = scene_from_node.matrix3.determinant() < 0.0;
        Ok(Self { node, mesh, primitive, positions, carriers: None, mirrored })
    }

    /// Adds its triangles, and to `unread` what of it is left out or not obeyed.
    fn append_to(&self, mesh: &mut Mesh, buffers: &Buffers<'_>, unread: &mut Vec<String>) -> Result<()> {
        if let Some(others) = not_a_surface(self.primitive.mode()) {
            unread.push(format!("the {others} of {}", self.name()));
            return Ok(());
        }
        let first = u32::try_from(mesh.positions.len()).map_err(|_| Error::new("more than 2^32 vertices"))?;
        let count = self.positions.len();
        let indices: Vec<u32> = match self.primitive.indices() {
            None => (0..count as u32).collect(),
            Some(indices) => whole_numbers::<1>(&indices, buffers, "indices")?.into_iter().map(|[i]| i).collect(),
        };
        if let Some(&bad) = indices.iter().find(|&&v| v as usize >= count) {
            return Err(Error::new(format!("index {bad} is past the {count} vertices")));
        }
        let triangles = match self.primitive.mode() {
            Mode::Triangles => indices.len() / 3,
            _ => indices.len().saturating_sub(2),
        };
        buffers.budget.take(triangles as u64 * TRIANGLE_BYTES, "triangles")?;
        mesh.positions.extend(&self.positions);
        let uvs = texture_coordinates(&self.primitive, buffers, count).unwrap_or_else(|e| {
            unread.push(format!("the texture coordinates of {}: {}", self.name(), e.what));
            None
        });
        for [a, b, c] in self::triangles(self.primitive.mode(), &indices) {
            let corners = if self.mirrored { [a, c, b] } else { [a, b, c] };
            mesh.push(corners.map(|v| first + v), uvs.as_ref().map(|uvs| corners.map(|v| uvs[v as usize])));
        }
        for (name, why) in painted::add(&self.primitive, buffers, mesh, first as usize, count) {
            unread.push(format!("{name} of {}: {why}", self.name()));
        }
        unread.extend(self.bends());
        Ok(())
    }

    /// What bends it over time, which a head or body does not.
    fn bends(&self) -> impl Iterator<Item = String> {
        let name = self.name();
        let skin = self.carriers.as_ref().and_then(|_| self.node.skin()).map(|skin| match skin.joints().count() {
            1 => format!("the joint that {name} is bound to: {STILL_SHAPE}"),
            joints => format!("the {joints} joints that {name} is bound to: {STILL_SHAPE}"),
        });
        let morphs = match self.primitive.morph_targets().len() {
            0 => None,
            morphs => Some(format!("changes of the {morphs} morphs of {name}: {STILL_SHAPE}")),
        };
        skin.into_iter().chain(morphs)
    }

    fn name(&self) -> String {
        let name = self.mesh.name().or(self.node.name());
        name.map_or_else(|| format!("mesh {}", self.mesh.index()), str::to_owned)
    }
}

/// The vertices of a primitive in its node's space, moved by its morphs.
fn positions(primitive: &gltf::Primitive, weights: &[f32], buffers: &Buffers<'_>) -> Result<Vec<Vec3>> {
    let accessor = primitive.get(&Semantic::Positions).ok_or_else(|| Error::new("a primitive has no positions"))?;
    let numbers = |accessor, what| numbers::<3>(&accessor, buffers, Whole::AsSaid, what);
    let mut positions: Vec<Vec3> = numbers(accessor, "positions")?.into_iter().map(Vec3::from).collect();
    for (morph, &weight) in primitive.morph_targets().zip(weights).filter(|(_, weight)| **weight != 0.0) {
        let Some(accessor) = morph.positions() else { continue };
        let moved = numbers(accessor, "morphs")?;
        if moved.len() != positions.len() {
            let (moved, count) = (moved.len(), positions.len());
            return Err(Error::new(format!("a morph has {moved} vertices instead of {count}")));
        }
        positions.iter_mut().zip(moved).for_each(|(place, by)| *place += weight * Vec3::from(by));
    }
    Ok(positions)
}

/// The first texture coordinates of each of `count` vertices, v upward: that of glTF runs down.
fn texture_coordinates(primitive: &gltf::Primitive, buffers: &Buffers<'_>, count: usize) -> Result<Option<Vec<Vec2>>> {
    let Some(accessor) = primitive.get(&Semantic::TexCoords(0)) else { return Ok(None) };
    let found = accessor.count();
    if found != count {
        return Err(Error::new(format!("{found} for {count} vertices")));
    }
    let uvs = numbers::<2>(&accessor, buffers, Whole::AsSaid, "texture coordinates")?;
    match uvs.iter().find(|uv| !Vec2::from(**uv).is_finite()) {
        Some([u, v]) => Err(Error::new(format!("({u}, {v}) is not a texture coordinate"))),
        None => Ok(Some(uvs.into_iter().map(|[u, v]| Vec2::new(u, 1.0 - v)).collect())),
    }
}

#[cfg(test)]
#[path = "glb/tests.rs"]
mod tests;
