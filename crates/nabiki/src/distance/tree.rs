//! A bounding-volume tree of triangles: nearest distance and winding number.

use std::f32::consts::TAU;

use glam::Vec3;

use crate::Mesh;

/// Triangles in a leaf at most.
const LEAF: usize = 4;
/// A branch farther away than this many of its own radii counts as one dipole in the winding number.
const FAR: f32 = 2.5;

/// A triangle's corners.
type Triangle = [Vec3; 3];

#[derive(Clone, Debug)]
struct Node {
    low: Vec3,
    high: Vec3,
    /// Mean of the triangles' middles by area, the place of the dipole.
    middle: Vec3,
    /// Sum of the triangles' area vectors, the dipole.
    area: Vec3,
    /// No corner lies farther from `middle`.
    radius: f32,
    /// First triangle of a leaf; second child of a branch (the first follows the branch itself).
    next: u32,
    /// Triangles of a leaf, 0 for a branch.
    count: u32,
}

#[derive(Clone, Debug)]
pub(super) struct Tree {
    nodes: Vec<Node>,
    triangles: Vec<Triangle>,
}

impl Tree {
    pub(super) fn new(mesh: &Mesh) -> Self {
        let mut triangles: Vec<Triangle> =
            mesh.triangles.iter().map(|t| t.map(|v| mesh.positions[v as usize])).collect();
        let mut nodes = Vec::with_capacity(triangles.len());
        let all = triangles.len();
        split(&mut triangles, 0, all, &mut nodes);
        Self { nodes, triangles }
    }

    /// Distance from `p` to the nearest triangle, or `limit` when none is nearer.
    pub(super) fn distance(&self, p: Vec3, limit: f32) -> f32 {
        let mut best = limit * limit;
        let mut stack = [(0_u32, 0.0_f32); 64];
        let mut top = 1;
        stack[0] = (0, self.nodes[0].box_distance_squared(p));
        while top > 0 {
            top -= 1;
            let (at, nearest) = stack[top];
            if nearest >= best {
                continue;
            }
            let node = &self.nodes[at as usize];
            if node.count > 0 {
                let first = node.next as usize;
                for triangle in &self.triangles[first..first + node.count as usize] {
                    best = best.min(nearest_on(triangle, p).distance_squared(p));
                }
                continue;
            }
            let near = (at + 1, self.nodes[at as usize + 1].box_distance_squared(p));
            let far = (node.next, self.nodes[node.next as usize].box_distance_squared(p));
            let (near, far) = if near.1 <= far.1 { (near, far) } else { (far, near) };
            stack[top] = far;
            stack[top + 1] = near;
            top += 2;
        }
        best.sqrt()
    }

    /// How often the surface winds about `p`: 1 inside, 0 outside, between where the surface has gaps.
    pub(super) fn winding(&self, p: Vec3) -> f32 {
        let mut turns = 0.0;
        let mut stack = [0_u32; 64];
        let mut top = 1;
        while top > 0 {
            top -= 1;
            let at = stack[top];
            let node = &self.nodes[at as usize];
            let away = node.middle - p;
            let squared = away.length_squared();
            if squared > (FAR * node.radius).powi(2) {
                turns += node.area.dot(away) / (squared * squared.sqrt());
            } else if node.count > 0 {
                let first = node.next as usize;
                for triangle in &self.triangles[first..first + node.count as usize] {
                    turns += solid_angle(triangle, p);
                }
            } else {
                stack[top] = node.next;
                stack[top + 1] = at + 1;
                top += 2;
            }
        }
        turns / (2.0 * TAU)
    }

    fn is_inside(&self, p: Vec3) -> bool {
        self.nodes[0].box_distance_squared(p) == 0.0 && self.winding(p) > 0.5
    }

    /// Signed distance at `p`, negative inside.
    pub(super) fn signed(&self, p: Vec3) -> f32 {
        let distance = self.distance(p, f32::INFINITY);
        if self.is_inside(p) { -distance } else { distance }
    }

    /// Signed distances at `start`, `start + step`, ... of which the first is known to be at most `limit`.
    ///
    /// The distance changes no faster than the place, so between two samples whose distances together exceed the
    /// step there is no skin: the sign carries over, and the winding number is seldom needed.
    pub(super) fn signed_row(&self, start: Vec3, step: Vec3, limit: f32, samples: &mut [f32]) {
        let length = step.length();
        let mut before: Option<(f32, bool)> = None;
        for (i, sample) in samples.iter_mut().enumerate() {
            let p = start + step * i as f32;
            let limit = before.map_or(limit, |(d, _)| (d + length) * 1.001);
            let distance = self.distance(p, limit);
            let inside = match before {
                Some((d, inside)) if d + distance > length * 1.001 => inside,
                _ => self.is_inside(p),
            };
            *sample = if inside { -distance } else { distance };
            before = Some((distance, inside));
        }
    }
}

impl Node {
    fn box_distance_squared(&self, p: Vec3) -> f32 {
        (self.low - p).max(p - self.high).max(Vec3::ZERO).length_squared()
    }
}

/// Builds the branch of `triangles[first..first + count]`, halving it across its longest side, depth first.
fn split(triangles: &mut [Triangle], first: usize, count: usize, nodes: &mut Vec<Node>) {
    let own = &mut triangles[first..first + count];
    let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    let (mut area, mut weighted, mut weight) = (Vec3::ZERO, Vec3::ZERO, 0.0);
    for triangle in own.iter() {
        let [a, b, c] = *triangle;
        low = low.min(a).min(b).min(c);
        high = high.max(a).max(b).max(c);
        let vector = 0.5 * (b - a).cross(c - a);
        area += vector;
        weighted += vector.length() * (a + b + c) / 3.0;
        weight += vector.length();
    }
    let middle = if weight > 0.0 { weighted / weight } else { 0.5 * (low + high) };
    let radius = own.iter().flatten().map(|v| v.distance_squared(middle)).fold(0.0, f32::max).sqrt();
    let at = nodes.len();
    nodes.push(Node { low, high, middle, area, radius, next: first as u32, count: count as u32 });
    if count <= LEAF {
        return;
    }
    let extent = high - low;
    let axis = (0..3).max_by(|&i, &j| extent[i].total_cmp(&extent[j])).unwrap_or(0);
    let half = count / 2;
    own.select_nth_unstable_by(half, |s, t| {
        let middle = |t: &Triangle| t[0][axis] + t[1][axis] + t[2][axis];
        middle(s).total_cmp(&middle(t))
    });
    split(triangles, first, half, nodes);
    nodes[at].next = nodes.len() as u32;
    nodes[at].count = 0;
    split(triangles, first + half, count - half, nodes);
}

/// The solid angle of a triangle seen from `p`, positive from behind (Van Oosterom and Strackee, 1983).
fn solid_angle(triangle: &Triangle, p: Vec3) -> f32 {
    let [a, b, c] = triangle.map(|v| v - p);
    let (la, lb, lc) = (a.length(), b.length(), c.length());
    let above = a.dot(b.cross(c));
    let below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
    2.0 * above.atan2(below)
}

/// The point of a triangle nearest to `p`, by the region of its plane that `p` falls into.
fn nearest_on(triangle: &Triangle, p: Vec3) -> Vec3 {
    let [a, b, c] = *triangle;
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return a;
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(bp), ac.dot(bp));
    if d3 >= 0.0 && d4 <= d3 {
        return b;
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(cp), ac.dot(cp));
    if d6 >= 0.0 && d5 <= d6 {
        return c;
    }
    let along_ab = d1 * d4 - d3 * d2;
    if along_ab <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return a + ab * (d1 / (d1 - d3));
    }
    let along_ac = d5 * d2 - d1 * d6;
    if along_ac <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return a + ac * (d2 / (d2 - d6));
    }
    let along_bc = d3 * d6 - d5 * d4;
    if along_bc <= 0.0 && d4 >= d3 && d5 >= d6 {
        return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
    }
    let sum = along_ab + along_ac + along_bc;
    a + ab * (along_ac / sum) + ac * (along_ab / sum)
}
