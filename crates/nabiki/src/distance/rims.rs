//! Closing the open rims of a mesh, so that it has an inside.

use std::collections::HashMap;

use glam::Vec3;

use crate::Mesh;

/// The mesh with duplicate vertices joined (those at exactly the same place, as texture seams leave them) and a fan of
/// triangles from the middle of each open rim.
pub(crate) fn closed(mesh: &Mesh) -> Mesh {
    let mut closed = Mesh { positions: mesh.positions.clone(), triangles: joined(mesh), ..Mesh::default() };
    for rim in rims(&closed.triangles) {
        let middle = middle(&rim, &closed.positions);
        let hub = closed.positions.len() as u32;
        closed.positions.push(middle);
        for (i, &v) in rim.iter().enumerate() {
            closed.triangles.push([v, rim[(i + 1) % rim.len()], hub]);
        }
    }
    closed
}

/// The rims of a mesh's openings after duplicate vertices are joined: the vertices of each, in order.
pub(crate) fn of(mesh: &Mesh) -> Vec<Vec<u32>> {
    rims(&joined(mesh))
}

/// The triangles with duplicate vertices joined, without those that then have two equal corners.
fn joined(mesh: &Mesh) -> Vec<[u32; 3]> {
    let first = mesh.first_at_place();
    let triangles = mesh.triangles.iter().map(|t| t.map(|v| first[v as usize]));
    triangles.filter(|[a, b, c]| a != b && b != c && c != a).collect()
}

/// The mean of a rim's vertices: the hub of the fan that closes it.
pub(crate) fn middle(rim: &[u32], positions: &[Vec3]) -> Vec3 {
    rim.iter().map(|&v| positions[v as usize]).sum::<Vec3>() / rim.len() as f32
}

/// Chains of edges with more triangles on one side than on the other, in the reverse of their direction there.
fn rims(triangles: &[[u32; 3]]) -> Vec<Vec<u32>> {
    let mut balance: HashMap<(u32, u32), i32> = HashMap::with_capacity(triangles.len() * 2);
    for &[a, b, c] in triangles {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            let (key, sign) = if from < to { ((from, to), 1) } else { ((to, from), -1) };
            *balance.entry(key).or_default() += sign;
        }
    }
    let mut open: Vec<(u32, u32)> = balance
        .into_iter()
        .filter(|&(_, count)| count != 0)
        .map(|((a, b), count)| if count > 0 { (b, a) } else { (a, b) })
        .collect();
    open.sort_unstable();
    let mut onward: HashMap<u32, Vec<u32>> = HashMap::with_capacity(open.len());
    for &(from, to) in &open {
        onward.entry(from).or_default().push(to);
    }
    let mut rims = Vec::new();
    for (start, _) in open {
        let Some(mut at) = onward.get_mut(&start).and_then(Vec::pop) else { continue };
        let mut rim = vec![start];
        while at != start {
            rim.push(at);
            // The rim of a badly joined mesh may not close; the last fan triangle then closes it.
            let Some(next) = onward.get_mut(&at).and_then(Vec::pop) else { break };
            at = next;
        }
        rims.push(rim);
    }
    rims
}
