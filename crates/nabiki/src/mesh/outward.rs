//! Turning a mesh so that its triangles face outward.

use std::collections::HashMap;

use glam::DVec3;

use super::Mesh;
use crate::distance::rims;

/// A piece that encloses less than this share of what a ball of its area would is flat: it has no outside.
const FLAT: f64 = 1e-3;

/// The orientation of a mesh's triangles, and how it was corrected.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Orientation {
    /// Triangles of second sides that were removed.
    pub doubled: usize,
    /// Triangles that faced inward and were turned.
    pub turned: usize,
    /// Edges of only one triangle: the rims of openings.
    pub open_edges: usize,
    /// Whether any piece encloses space once its openings are closed. If not, the mesh is a sheet and has no inside.
    pub has_inside: bool,
}

impl Mesh {
    /// Turns triangles so that all face outward, and reports how many were turned. Parts exported with two sides keep
    /// one.
    ///
    /// A piece is a set of triangles connected by edges of two triangles each. Its triangles are made to agree; then
    /// the piece is turned if the volume it encloses, with openings closed by fans, is negative. Each piece is judged
    /// separately, so a wall inside another piece counts as solid, too. Flat pieces are left unchanged.
    pub fn turn_outward(&mut self) -> Orientation {
        let joined = self.first_at_place();
        let doubled = self.keep_one_side(&joined);
        let corners: Vec<[u32; 3]> = self.triangles.iter().map(|t| t.map(|v| joined[v as usize])).collect();
        let beside = neighbours(&corners);
        let open_edges = beside.values().filter(|sides| sides.len() == 1).count();
        let pieces = agree(&corners, &beside);
        let mut turn: Vec<bool> = pieces.iter().map(|&(_, turned)| turned).collect();
        self.turn(&turn);

        let enclosed = self.enclosed(&joined, &pieces);
        let outward = |piece: usize| {
            let [volume, area] = enclosed[piece];
            // A ball of this area.
            let most = area.powf(1.5) / (6.0 * std::f64::consts::PI.sqrt());
            if volume.abs() > FLAT * most { Some(volume > 0.0) } else { None }
        };
        let has_inside = (0..enclosed.len()).any(|piece| outward(piece).is_some());
        let mut whole = vec![false; turn.len()];
        for (t, &(piece, agreed)) in pieces.iter().enumerate() {
            // A flat piece returns to its original orientation.
            whole[t] = outward(piece).map_or(agreed, |outward| !outward);
            turn[t] ^= whole[t];
        }
        self.turn(&whole);
        Orientation { doubled, turned: turn.iter().filter(|turned| **turned).count(), open_edges, has_inside }
    }

    fn turn(&mut self, which: &[bool]) {
        for (triangle, _) in self.triangles.iter_mut().zip(which).filter(|(_, turned)| **turned) {
            triangle.swap(1, 2);
        }
        for (uvs, _) in self.corner_uvs.iter_mut().flatten().zip(which).filter(|(_, turned)| **turned) {
            uvs.swap(1, 2);
        }
    }

    /// Volume and area of each piece, with its openings closed.
    fn enclosed(&self, joined: &[u32], pieces: &[(usize, bool)]) -> Vec<[f64; 2]> {
        let count = pieces.iter().map(|&(piece, _)| piece + 1).max().unwrap_or(0);
        let mut enclosed = vec![[0.0; 2]; count];
        let closed = rims::closed(self);
        let mut piece_at = vec![0; closed.positions.len()];
        for (triangle, &(piece, _)) in self.triangles.iter().zip(pieces) {
            triangle.iter().for_each(|&v| piece_at[joined[v as usize] as usize] = piece);
        }
        let middle = self.positions.iter().map(|p| p.as_dvec3()).sum::<DVec3>() / self.positions.len().max(1) as f64;
        for &triangle in &closed.triangles {
            let [a, b, c] = triangle.map(|v| closed.positions[v as usize].as_dvec3() - middle);
            let [volume, area] = &mut enclosed[piece_at[triangle[0] as usize]];
            *volume += a.dot(b.cross(c)) / 6.0;
            *area += 0.5 * (b - a).cross(c - a).length();
        }
        enclosed
    }
}

/// The triangles at each edge, keyed by its lower and its higher vertex, and whether they run along it upward.
fn neighbours(corners: &[[u32; 3]]) -> HashMap<(u32, u32), Vec<(usize, bool)>> {
    let mut beside: HashMap<(u32, u32), Vec<(usize, bool)>> = HashMap::with_capacity(corners.len() * 3 / 2);
    for (t, &[a, b, c]) in corners.iter().enumerate().filter(|(_, [a, b, c])| a != b && b != c && c != a) {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            beside.entry((from.min(to), from.max(to))).or_default().push((t, from < to));
        }
    }
    beside
}

/// For each triangle, its piece and whether it must be turned to agree with the piece's first triangle.
fn agree(corners: &[[u32; 3]], beside: &HashMap<(u32, u32), Vec<(usize, bool)>>) -> Vec<(usize, bool)> {
    let mut found: Vec<Option<(usize, bool)>> = vec![None; corners.len()];
    let mut pieces = 0;
    let mut open = Vec::new();
    for first in 0..corners.len() {
        if found[first].is_some() {
            continue;
        }
        found[first] = Some((pieces, false));
        open.push(first);
        while let Some(t) = open.pop() {
            let turned = found[t].is_some_and(|(_, turned)| turned);
            let [a, b, c] = corners[t];
            for (from, to) in [(a, b), (b, c), (c, a)] {
                let Some([one, other]) = beside.get(&(from.min(to), from.max(to))).map(Vec::as_slice) else { continue };
                let (own, next) = if one.0 == t { (one, other) } else { (other, one) };
                if found[next.0].is_none() {
                    // Triangles that agree run along their edge in opposite directions.
                    found[next.0] = Some((pieces, turned ^ (own.1 == next.1)));
                    open.push(next.0);
                }
            }
        }
        pieces += 1;
    }
    found.into_iter().map(|triangle| triangle.unwrap_or_default()).collect()
}
