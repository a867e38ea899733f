//! Vertex colours of an FBX, which belong to corners.

use nabiki::Mesh;
use nabiki_exchange::{Budget, Painted, Problem};

use super::short;
use crate::mesh::obj::COLOUR;

/// Red, green, blue and alpha.
const CHANNELS: usize = 4;

/// Adds the sets of colours of a mesh whose vertices are those from `first` on. A vertex takes the colour of the first corner that
/// names it. The answer names what is left out, and why.
pub(super) fn add(of: &ufbx::Mesh, budget: &Budget, mesh: &mut Mesh, first: usize) -> Vec<(String, String)> {
    let mut left_out = Vec::new();
    for set in of.color_sets.as_ref() {
        let name: &str = &set.name;
        let name = if name.is_empty() { COLOUR } else { name };
        let added = painted(name, of, &set.vertex_color, budget).and_then(|set| set.add_to(mesh, first, budget));
        left_out.extend(added.err().map(|why| (short(name), why.0)));
    }
    left_out
}

fn painted(name: &str, of: &ufbx::Mesh, colours: &ufbx::VertexVec4, budget: &Budget) -> Result<Painted, Problem> {
    budget.take_list::<[f32; CHANNELS]>(of.num_vertices, name)?;
    let values: &[ufbx::Vec4] = colours.values.as_ref();
    let (indices, vertices): (&[u32], &[u32]) = (colours.indices.as_ref(), of.vertex_indices.as_ref());
    let mut numbers = vec![0.0; CHANNELS * of.num_vertices];
    // The last to be written is the first corner.
    for (&index, &vertex) in indices.iter().zip(vertices).rev() {
        let from = CHANNELS * vertex as usize;
        if let (Some(colour), Some(to)) = (values.get(index as usize), numbers.get_mut(from..from + CHANNELS)) {
            to.copy_from_slice(&[colour.x, colour.y, colour.z, colour.w].map(|channel| channel as f32));
        }
    }
    Ok(Painted { name: name.to_owned(), extent: CHANNELS, numbers })
}
