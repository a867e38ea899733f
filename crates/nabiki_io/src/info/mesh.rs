//! Summary of a mesh file.

use std::{collections::HashMap, fmt, path::Path};

use nabiki::Mesh;
use serde::Serialize;

use super::measure::{Box3, Guess, guess_unit};
use crate::{
    declared::DeclaredSpace,
    error::Result,
    fbx_file::{Outline, is_fbx, outline_of},
    gltf_file,
    input::{self, MOST_BINARY_BYTES},
    kind::extension,
    mesh::{self, place_and_weld},
    placement::Placement,
    screen::{OneLine, list},
    short::Short,
    unit::Unit,
};

/// Triangles and their properties, in the file's unit.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct MeshInfo {
    /// Vertices in the file.
    pub vertices: usize,
    /// Triangles in the file, with larger polygons divided.
    pub triangles: usize,
    /// Bounding box of all vertices.
    pub bounds: Box3,
    /// Vertices at the same position as another one.
    pub doubled_vertices: usize,
    /// Triangles with two corners at the same position.
    pub degenerate_triangles: usize,
    /// Edges with a triangle on only one side, with doubled vertices joined: 0 for a closed surface.
    pub open_edges: usize,
    /// Edges with more than two triangles.
    pub crowded_edges: usize,
    /// Names of the weights and colours of its vertices.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub vertex_attributes: Vec<String>,
    /// Phrases about data of the file's meshes that is not used.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub unread: Vec<String>,
    /// A guess at the unit, assuming a person's head, bust or body with y up; `None` if it is declared.
    #[serde(flatten)]
    pub guess: Option<Guess>,
    /// The file's unit in centimetres, if the format defines it.
    pub unit_cm: Option<f32>,
    /// The up axis, if the format defines it.
    pub up: Option<String>,
    /// The axis along which a character of the file looks, if the format defines it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub facing: Option<String>,
    /// Frames per second, if the file declares them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub frame_rate: Option<f64>,
    /// Animations of a .glb or .fbx that may move a head.
    pub clips: Vec<ClipInfo>,
    /// Names of the nodes that the animations may move.
    pub nodes: Vec<String>,
}

/// An animation of a .glb or .fbx.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ClipInfo {
    /// Its name, or empty.
    pub name: String,
    /// Time of its last key (s), if the file's header gives it.
    pub end: Option<f64>,
}

impl MeshInfo {
    /// Summarises a mesh file.
    pub fn of_file(path: &Path) -> Result<Self> {
        let of_meshes = || -> Result<Self> {
            let (mesh, unread) = mesh::read_with_losses(path, &[])?;
            Ok(Self { unread, ..Self::of(&mesh) })
        };
        if is_fbx(path) {
            return Self::of_fbx(path, of_meshes);
        }
        if !matches!(extension(path).as_str(), "glb" | "gltf") {
            return of_meshes();
        }
        let bytes = input::read(path, MOST_BINARY_BYTES)?;
        let (document, _) = gltf_file::open(&bytes).map_err(|e| e.in_file(path))?;
        // A file may hold nothing but the motion of its nodes.
        let moves_alone = document.meshes().len() == 0 && document.animations().len() > 0;
        let info = if moves_alone { Self::of(&Mesh::default()) } else { of_meshes()? };
        let clips: Vec<ClipInfo> = document.animations().map(|animation| clip(&animation)).collect();
        let names = document.nodes().filter_map(|node| node.name().map(str::to_owned));
        let DeclaredSpace { unit, up } = DeclaredSpace::GLTF;
        let facing = (!clips.is_empty()).then(|| "+z".to_owned());
        let info =
            Self { guess: None, unit_cm: unit.map(|unit| unit.cm), up: up.map(|up| up.to_string()), facing, ..info };
        Ok(Self { nodes: if clips.is_empty() { Vec::new() } else { names.collect() }, clips, ..info })
    }

    fn of_fbx(path: &Path, of_meshes: impl Fn() -> Result<Self>) -> Result<Self> {
        let Outline { space: DeclaredSpace { unit, up }, rate, meshes, clips, nodes } = outline_of(path)?;
        // As for a glTF.
        let moves_alone = meshes == 0 && !clips.is_empty();
        let info = if moves_alone { Self::of(&Mesh::default()) } else { of_meshes()? };
        Ok(Self {
            guess: None,
            unit_cm: unit.map(|unit| unit.cm),
            up: up.map(|up| up.to_string()),
            frame_rate: rate,
            nodes: if clips.is_empty() { Vec::new() } else { nodes },
            clips: clips.into_iter().map(|(name, length)| ClipInfo { name, end: Some(length) }).collect(),
            ..info
        })
    }

    /// Summarises `mesh`.
    pub fn of(mesh: &Mesh) -> Self {
        let bounds = Box3::of(&mesh.positions);
        let mut edges: HashMap<[u32; 2], u32> = HashMap::new();
        let (mut doubled_vertices, mut degenerate_triangles) = (0, mesh.triangles.len());
        if let Ok((welded, report)) = place_and_weld(mesh.clone(), &Placement::default()) {
            (doubled_vertices, degenerate_triangles) = (report.joined_vertices, report.dropped_triangles);
            for &[a, b, c] in &welded.triangles {
                for (p, q) in [(a, b), (b, c), (c, a)] {
                    *edges.entry([p.min(q), p.max(q)]).or_default() += 1;
                }
            }
        }
        Self {
            vertices: mesh.positions.len(),
            triangles: mesh.triangles.len(),
            doubled_vertices,
            degenerate_triangles,
            open_edges: edges.values().filter(|&&n| n == 1).count(),
            crowded_edges: edges.values().filter(|&&n| n > 2).count(),
            guess: Some(Guess { likely_unit: likely_unit(bounds.max[1] - bounds.min[1]), likely_up: None }),
            bounds,
            vertex_attributes: mesh.weight_names().map(str::to_owned).collect(),
            unread: Vec::new(),
            unit_cm: None,
            up: None,
            facing: None,
            frame_rate: None,
            clips: Vec::new(),
            nodes: Vec::new(),
        }
    }
}

/// The unit in which a mesh of this height (file units) is most likely a person's head, bust or body; `None` if it is
/// none in any metric unit.
pub fn likely_unit(height: f32) -> Option<&'static str> {
    // A small head to a tall body.
    guess_unit(height, 18.0, 220.0)
}

fn clip(animation: &gltf::Animation<'_>) -> ClipInfo {
    let last = |sampler: gltf::animation::Sampler<'_>| sampler.input().max()?.get(0)?.as_f64();
    let end = animation.samplers().filter_map(last).reduce(f64::max);
    ClipInfo { name: animation.name().unwrap_or_default().to_owned(), end }
}

impl fmt::Display for MeshInfo {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.vertices == 0 {
            write!(f, "mesh: none")?;
        } else {
            writeln!(f, "mesh: {} vertices, {} triangles", self.vertices, self.triangles)?;
            writeln!(f, "box: {}", self.bounds)?;
            writeln!(f, "edges: {} open, {} with more than two triangles", self.open_edges, self.crowded_edges)?;
            let (doubled, degenerate) = (self.doubled_vertices, self.degenerate_triangles);
            write!(f, "degenerate: {degenerate} triangles without area; {doubled} doubled vertices")?;
        }
        if !self.vertex_attributes.is_empty() {
            write!(f, "\nvertex attributes: {}", list(&self.vertex_attributes))?;
        }
        for unread in &self.unread {
            write!(f, "\nnot read: {}", OneLine(unread))?;
        }
        if !self.clips.is_empty() {
            let clips = self.clips.iter().map(|clip| match clip.end {
                Some(end) => format!("{} ({end:.3} s)", clip.name),
                None => clip.name.clone(),
            });
            write!(f, "\nnodes: {}", list(&self.nodes))?;
            write!(f, "\nclips: {}", list(&clips.collect::<Vec<_>>()))?;
            if let Some(rate) = self.frame_rate {
                write!(f, "\nframe rate: {}", Short(rate as f32))?;
            }
            match &self.facing {
                Some(facing) => write!(f, "\nas motion: facing {facing}; required in the scene: node, clip")?,
                None => write!(
                    f,
                    "\nas motion, required in the scene: node, clip, facing (but not if the mesh is from this file)"
                )?,
            }
        }
        if let (Some(cm), Some(up)) = (self.unit_cm, &self.up) {
            let says = if self.frame_rate.is_some() { "the file" } else { "its format" };
            write!(f, "\n{says} says: unit {}, up {up}; facing: unknown", Unit { cm })?;
        }
        match self.guess {
            Some(Guess { likely_unit: Some(unit), .. }) => {
                write!(f, "\nunit: {unit} (a guess, if y is up); up, facing: unknown")
            }
            Some(_) => write!(f, "\nunit, up, facing: unknown"),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    #[test]
    fn vertex_attributes_are_named_once_each_colour() {
        let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
        let mut mesh = Mesh { positions, triangles: vec![[0, 1, 2]], ..Mesh::default() };
        assert!(!MeshInfo::of(&mesh).to_string().contains("vertex attributes"));
        mesh.add_colours("COLOR_0", 0, 3, &[0.5; 9]);
        mesh.add_weights("_FRINGE", 0, [0.0, 1.0, 1.0].into_iter());
        let said = MeshInfo::of(&mesh).to_string();
        assert!(said.contains("\nvertex attributes: COLOR_0, _FRINGE\n"), "{said}");
    }

    #[test]
    fn edges_of_one_triangle_are_open_and_those_of_more_than_two_crowded() {
        let edges = |triangles: &[[u32; 3]]| {
            let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z, Vec3::NEG_Y];
            let info = MeshInfo::of(&Mesh { positions, triangles: triangles.to_vec(), ..Mesh::default() });
            (info.open_edges, info.crowded_edges)
        };
        assert_eq!(edges(&[[0, 1, 2]]), (3, 0));
        assert_eq!(edges(&[[0, 1, 2], [1, 0, 4]]), (4, 0));
        assert_eq!(edges(&[[0, 1, 2], [1, 0, 4], [0, 1, 3]]), (6, 1));
        assert_eq!(edges(&[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]), (0, 0));
    }
}
