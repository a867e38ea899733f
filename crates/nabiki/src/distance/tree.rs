//! A bounding-volume tree of triangles: nearest distance and winding number.

use std::f32::consts::TAU;

use glam::{Vec3, Vec3A};

use crate::Mesh;

/// Most triangles in a leaf.
const LEAF: usize = 4;
/// A branch farther away than this many of its own radii counts as one dipole in the winding number.
const FAR: f32 = 2.5;

/// Slightly above 1. Widens a bound so that rounding cannot break it.
const ROUNDING: f32 = 1.001;

/// A triangle's corners.
type Triangle = [Vec3A; 3];

#[derive(Clone, Debug)]
struct Node {
    low: Vec3A,
    high: Vec3A,
    /// First triangle of a leaf; second child of a branch (the first follows the branch itself).
    next: u32,
    /// Triangles of a leaf, 0 for a branch.
    count: u32,
}

/// A branch as seen from far away: the winding number of its triangles as one dipole.
#[derive(Clone, Debug)]
struct Dipole {
    /// Mean of the triangles' middles, weighted by area.
    middle: Vec3A,
    /// Sum of the triangles' area vectors.
    area: Vec3A,
    /// Largest distance of a corner from `middle`.
    radius: f32,
}

#[derive(Clone, Debug)]
pub(super) struct Tree {
    nodes: Vec<Node>,
    /// One per node.
    dipoles: Vec<Dipole>,
    triangles: Vec<Triangle>,
}

impl Tree {
    pub(super) fn new(mesh: &Mesh) -> Self {
        let triangles: Vec<Triangle> =
            mesh.triangles.iter().map(|t| t.map(|v| mesh.positions[v as usize].into())).collect();
        let count = triangles.len();
        let mut tree = Self { nodes: Vec::with_capacity(count), dipoles: Vec::with_capacity(count), triangles };
        tree.split(0, count);
        tree
    }

    /// Distance from `p` to the nearest triangle, or `limit` when none is nearer. It may come out too large by the
    /// share `slack`: from the middle of a head half its skin is about equally far, and to tell which is nearest
    /// costs a visit to all of it. `nearest` is a triangle to look at first, at best that of a place close by, and is
    /// left at the one found.
    pub(super) fn distance(&self, p: Vec3, limit: f32, slack: f32, nearest: &mut usize) -> f32 {
        let near_enough = 1.0 / (1.0 + slack).powi(2);
        let p = Vec3A::from(p);
        let mut best = (limit * limit).min(nearest_on(&self.triangles[*nearest], p).distance_squared(p));
        let mut stack = [(0_u32, 0.0_f32); 64];
        let mut top = 1;
        stack[0] = (0, self.nodes[0].box_distance_squared(p));
        while top > 0 {
            top -= 1;
            let (at, at_least) = stack[top];
            if at_least >= best * near_enough {
                continue;
            }
            let node = &self.nodes[at as usize];
            if node.count > 0 {
                let first = node.next as usize;
                for (i, triangle) in self.triangles[first..first + node.count as usize].iter().enumerate() {
                    let squared = nearest_on(triangle, p).distance_squared(p);
                    if squared < best {
                        best = squared;
                        *nearest = first + i;
                    }
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

    /// The corners of the triangle nearest to `p`.
    pub(super) fn nearest(&self, p: Vec3) -> [Vec3; 3] {
        let mut nearest = 0;
        self.distance(p, f32::INFINITY, 0.0, &mut nearest);
        self.triangles[nearest].map(Vec3::from)
    }

    /// The winding number of the surface around `p`: 1 inside, 0 outside, in between where the surface has gaps.
    pub(super) fn winding(&self, p: Vec3) -> f32 {
        let p = Vec3A::from(p);
        let mut turns = 0.0;
        let mut stack = [0_u32; 64];
        let mut top = 1;
        while top > 0 {
            top -= 1;
            let at = stack[top];
            let (node, dipole) = (&self.nodes[at as usize], &self.dipoles[at as usize]);
            let away = dipole.middle - p;
            let squared = away.length_squared();
            if squared > (FAR * dipole.radius).powi(2) {
                turns += dipole.area.dot(away) / (squared * squared.sqrt());
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
        self.nodes[0].box_distance_squared(p.into()) == 0.0 && self.winding(p) > 0.5
    }

    /// Signed distance at `p`, negative inside.
    pub(super) fn signed(&self, p: Vec3) -> f32 {
        let distance = self.distance(p, f32::INFINITY, 0.0, &mut 0);
        if self.is_inside(p) { -distance } else { distance }
    }

    /// Signed distance at `p`, at the length `away` from a place whose signed distance is `known`.
    ///
    /// The distance changes no faster than the place, so where both distances together exceed the length between
    /// there is no skin between: the sign carries over, and the winding number is seldom needed.
    pub(super) fn signed_beside(&self, p: Vec3, known: f32, away: f32, slack: f32, nearest: &mut usize) -> f32 {
        let distance = self.distance(p, (known.abs() + away) * ROUNDING, slack, nearest);
        let inside =
            if known.abs() + distance > away * ROUNDING * (1.0 + slack) { known < 0.0 } else { self.is_inside(p) };
        if inside { -distance } else { distance }
    }
}

impl Tree {
    /// Builds the branch of `count` triangles from `first` on, halved across its longest side, depth first.
    fn split(&mut self, first: usize, count: usize) {
        let own = &mut self.triangles[first..first + count];
        let (mut low, mut high) = (Vec3A::INFINITY, Vec3A::NEG_INFINITY);
        let (mut area, mut weighted, mut weight) = (Vec3A::ZERO, Vec3A::ZERO, 0.0);
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
        let at = self.nodes.len();
        self.nodes.push(Node { low, high, next: first as u32, count: count as u32 });
        self.dipoles.push(Dipole { middle, area, radius });
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
        self.split(first, half);
        self.nodes[at].next = self.nodes.len() as u32;
        self.nodes[at].count = 0;
        self.split(first + half, count - half);
    }
}

impl Node {
    fn box_distance_squared(&self, p: Vec3A) -> f32 {
        (self.low - p).max(p - self.high).max(Vec3A::ZERO).length_squared()
    }
}

/// The solid angle of a triangle seen from `p`, positive from behind (Van Oosterom and Strackee, 1983).
fn solid_angle(triangle: &Triangle, p: Vec3A) -> f32 {
    let [a, b, c] = triangle.map(|v| v - p);
    let (la, lb, lc) = (a.length(), b.length(), c.length());
    let above = a.dot(b.cross(c));
    let below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
    2.0 * above.atan2(below)
}

/// The point of a triangle nearest to `p`, by the region of its plane that `p` falls into.
fn nearest_on(triangle: &Triangle, p: Vec3A) -> Vec3A {
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
