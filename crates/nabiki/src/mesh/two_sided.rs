//! Surfaces exported with two sides: each face a second time, facing the other way, perhaps cut into other triangles.
//! There is no space between the two, so nothing would be inside.

use std::collections::HashMap;

use glam::DVec3;

use super::Mesh;

/// A part that encloses less than this share of what a ball of its area would may have two sides.
const NO_SPACE: f64 = 1e-6;

/// The direction of triangles below this share of the largest one's area is arbitrary.
const NO_AREA: f64 = 1e-6;

impl Mesh {
    /// Keeps one side of every two-sided part, and returns the number of triangles removed. `joined`: for each vertex, the first one at
    /// its position.
    pub(super) fn keep_one_side(&mut self, joined: &[u32]) -> usize {
        let corners: Vec<[u32; 3]> = self.triangles.iter().map(|t| t.map(|v| joined[v as usize])).collect();
        let middle = self.positions.iter().map(|p| p.as_dvec3()).sum::<DVec3>() / self.positions.len().max(1) as f64;
        let at = |v: u32| self.positions[v as usize].as_dvec3() - middle;
        let areas: Vec<DVec3> = corners.iter().map(|&[a, b, c]| 0.5 * (at(b) - at(a)).cross(at(c) - at(a))).collect();
        let mut beside: HashMap<(u32, u32), Vec<usize>> = HashMap::with_capacity(3 * corners.len());
        // A triangle with almost no area has no side.
        let largest = areas.iter().map(|area| area.length()).fold(0.0, f64::max);
        let flat = |t: usize| areas[t].length() <= NO_AREA * largest;
        for (t, &[a, b, c]) in corners.iter().enumerate().filter(|&(t, _)| !flat(t)) {
            [(a, b), (b, c), (c, a)].into_iter().for_each(|edge| beside.entry(edge).or_default().push(t));
        }
        // No edge has two triangles that run along it in the same direction: nothing is two-sided.
        if beside.values().all(|triangles| triangles.len() < 2) {
            return 0;
        }
        let mut keep = vec![true; corners.len()];
        let mut seen: Vec<bool> = (0..corners.len()).map(flat).collect();
        for first in 0..corners.len() {
            if seen[first] {
                continue;
            }
            let part = around(first, &mut seen, &corners, &beside);
            let has_space = |triangles: &[usize]| {
                let volume: f64 = triangles.iter().map(|&t| at(corners[t][0]).dot(areas[t]) / 3.0).sum();
                let area: f64 = triangles.iter().map(|&t| areas[t].length()).sum();
                volume.abs() > NO_SPACE * area.powf(1.5)
            };
            if has_space(&part) {
                continue;
            }
            let side = side(first, &corners, &beside, &areas);
            if 2 * side.len() == part.len() && has_space(&side) {
                part.iter().for_each(|&t| keep[t] = false);
                side.iter().for_each(|&t| keep[t] = true);
            }
        }
        let mut kept = keep.iter().copied();
        self.triangles.retain(|_| kept.next().unwrap_or(true));
        if let Some(uvs) = &mut self.corner_uvs {
            let mut kept = keep.iter().copied();
            uvs.retain(|_| kept.next().unwrap_or(true));
        }
        keep.iter().filter(|keep| !**keep).count()
    }
}

/// The triangles connected to this one by edges, including itself.
fn around(
    first: usize,
    seen: &mut [bool],
    corners: &[[u32; 3]],
    beside: &HashMap<(u32, u32), Vec<usize>>,
) -> Vec<usize> {
    let mut part = vec![first];
    seen[first] = true;
    let mut next = 0;
    while let Some(&t) = part.get(next) {
        next += 1;
        let [a, b, c] = corners[t];
        for (from, to) in [(a, b), (b, a), (b, c), (c, b), (c, a), (a, c)] {
            for &other in beside.get(&(from, to)).into_iter().flatten() {
                if !std::mem::replace(&mut seen[other], true) {
                    part.push(other);
                }
            }
        }
    }
    part
}

/// Those that can be reached without crossing an edge to the other side: of the triangles that run along an edge the
/// other way, the one on the same side turns the least.
fn side(first: usize, corners: &[[u32; 3]], beside: &HashMap<(u32, u32), Vec<usize>>, areas: &[DVec3]) -> Vec<usize> {
    let mut side = vec![first];
    let mut reached = std::collections::HashSet::from([first]);
    let mut next = 0;
    while let Some(&t) = side.get(next) {
        next += 1;
        let [a, b, c] = corners[t];
        let turns = |other: usize| areas[t].normalize_or_zero().dot(areas[other].normalize_or_zero());
        for edge in [(b, a), (c, b), (a, c)] {
            let beyond = beside.get(&edge).into_iter().flatten().copied();
            if let Some(other) = beyond.max_by(|&x, &y| turns(x).total_cmp(&turns(y)))
                && turns(other) > -0.999
                && reached.insert(other)
            {
                side.push(other);
            }
        }
    }
    side
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    /// A box of quads, each cut into two triangles from its first corner; the other side of each begins with another corner.
    fn quads(two_sides: bool) -> Mesh {
        let corner = |i: u32| 2.0 * Vec3::new((i >> 2) as f32, (i >> 1 & 1) as f32, (i & 1) as f32);
        let faces = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
        let other = faces.map(|[a, b, c, d]| [d, c, b, a]);
        let cut = |&[a, b, c, d]: &[u32; 4]| [[a, b, c], [a, c, d]];
        let mut triangles: Vec<[u32; 3]> = faces.iter().flat_map(cut).collect();
        if two_sides {
            triangles.extend(other.iter().flat_map(cut));
        }
        Mesh { positions: (0..8).map(corner).collect(), triangles, ..Mesh::default() }
    }

    #[test]
    fn a_box_with_two_sides_is_a_box() {
        let (mut one, mut two) = (quads(false), quads(true));
        let orientation = two.turn_outward();
        assert_eq!(orientation, super::super::Orientation { doubled: 12, ..one.turn_outward() });
        assert_eq!(two, one);
    }

    #[test]
    fn what_has_one_side_stays_as_it_is() {
        let mut mesh = quads(false);
        let before = mesh.clone();
        assert_eq!(mesh.keep_one_side(&[0, 1, 2, 3, 4, 5, 6, 7]), 0);
        // A stray duplicate is not a second side.
        mesh.triangles.push(mesh.triangles[3]);
        assert_eq!(mesh.keep_one_side(&[0, 1, 2, 3, 4, 5, 6, 7]), 0);
        assert_eq!(mesh.triangles[..12], before.triangles);
    }
}
