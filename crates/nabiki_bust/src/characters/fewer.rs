//! Fewer triangles: the edge whose end costs the shape least is drawn together to one vertex, again and again (Garland and
//! Heckbert, 1997).

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::{DMat3, DVec3, Vec3};

use super::net::Skin;

/// What a vertex pays for leaving the place of those that it stands for, beside what it pays for leaving their planes: that
/// keeps triangles of like size and good shape.
const STAY: f64 = 0.004;

/// The skin in about `wanted` vertices.
pub(super) fn triangles(skin: &Skin, wanted: usize, care: &dyn Fn(Vec3) -> f32) -> Skin {
    let mut work = Work::new(skin, care);
    let mut left = skin.places.len();
    while left > wanted {
        let Some(Reverse(edge)) = work.queue.pop() else { break };
        if work.is_current(&edge) && work.draw_together(&edge) {
            left -= 1;
        }
    }
    work.result()
}

/// Sum of squared distances to planes and places: p' A p - 2 b' p + c.
#[derive(Clone, Copy)]
struct Cost {
    a: DMat3,
    b: DVec3,
    c: f64,
}

impl Cost {
    const NONE: Self = Self { a: DMat3::ZERO, b: DVec3::ZERO, c: 0.0 };

    fn of_plane(normal: DVec3, on: DVec3, weight: f64) -> Self {
        let off = normal.dot(on);
        let outer = DMat3::from_cols(normal * normal.x, normal * normal.y, normal * normal.z);
        Self { a: outer * weight, b: normal * (off * weight), c: off * off * weight }
    }

    fn of_place(place: DVec3, weight: f64) -> Self {
        Self { a: DMat3::IDENTITY * weight, b: place * weight, c: place.length_squared() * weight }
    }

    fn plus(self, other: Self) -> Self {
        Self { a: self.a + other.a, b: self.b + other.b, c: self.c + other.c }
    }

    fn at(&self, p: DVec3) -> f64 {
        p.dot(self.a * p) - 2.0 * self.b.dot(p) + self.c
    }

    /// Where it is least; a place of weight is always in the sum, so there is one such point.
    fn least(&self) -> DVec3 {
        self.a.inverse() * self.b
    }
}

/// An edge that may be drawn together: its cost as ordered bits, its ends, and how often these had changed then.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Edge {
    cost: u64,
    ends: [u32; 2],
    changes: [u32; 2],
}

struct Work {
    places: Vec<DVec3>,
    costs: Vec<Cost>,
    triangles: Vec<Option<[u32; 3]>>,
    /// The triangles about each vertex.
    about: Vec<Vec<u32>>,
    changes: Vec<u32>,
    queue: BinaryHeap<Reverse<Edge>>,
}

impl Work {
    fn new(skin: &Skin, care: &dyn Fn(Vec3) -> f32) -> Self {
        let places: Vec<DVec3> = skin.places.iter().map(|p| p.as_dvec3()).collect();
        let mut costs = vec![Cost::NONE; places.len()];
        let mut about = vec![Vec::new(); places.len()];
        for (t, triangle) in skin.triangles.iter().enumerate() {
            let [a, b, c] = triangle.map(|v| places[v as usize]);
            let twice = (b - a).cross(c - a);
            let area = 0.5 * twice.length();
            let weight = area * f64::from(care(((a + b + c) / 3.0).as_vec3()));
            let plane = Cost::of_plane(twice.normalize_or_zero(), a, weight);
            for &v in triangle {
                costs[v as usize] =
                    costs[v as usize].plus(plane).plus(Cost::of_place(places[v as usize], STAY * weight));
                about[v as usize].push(t as u32);
            }
        }
        let triangles = skin.triangles.iter().copied().map(Some).collect();
        let changes = vec![0; places.len()];
        let mut work = Self { places, costs, triangles, about, changes, queue: BinaryHeap::new() };
        for &[a, b, c] in &skin.triangles {
            for (a, b) in [(a, b), (b, c), (c, a)] {
                if a < b {
                    work.enqueue(a, b);
                }
            }
        }
        work
    }

    fn enqueue(&mut self, a: u32, b: u32) {
        let ends = [a.min(b), a.max(b)];
        let both = self.costs[a as usize].plus(self.costs[b as usize]);
        let cost = both.at(both.least()).max(0.0).to_bits();
        self.queue.push(Reverse(Edge { cost, ends, changes: ends.map(|v| self.changes[v as usize]) }));
    }

    fn is_current(&self, edge: &Edge) -> bool {
        edge.ends.map(|v| self.changes[v as usize]) == edge.changes
    }

    /// The vertices beside one, in order.
    fn beside(&self, v: u32) -> Vec<u32> {
        let corners = self.about[v as usize].iter().filter_map(|&t| self.triangles[t as usize]).flatten();
        let mut beside: Vec<u32> = corners.filter(|&w| w != v).collect();
        beside.sort_unstable();
        beside.dedup();
        beside
    }

    /// Puts both ends into one place, unless that would fold the skin or close a loop of it.
    fn draw_together(&mut self, edge: &Edge) -> bool {
        let [a, b] = edge.ends;
        let (beside_a, beside_b) = (self.beside(a), self.beside(b));
        let shared = beside_a.iter().filter(|v| beside_b.binary_search(v).is_ok()).count();
        if shared != 2 {
            return false;
        }
        let both = self.costs[a as usize].plus(self.costs[b as usize]);
        let place = both.least();
        if [a, b].into_iter().any(|v| self.folds(v, edge.ends, place)) {
            return false;
        }
        let of_b = std::mem::take(&mut self.about[b as usize]);
        for t in of_b {
            let Some(triangle) = &mut self.triangles[t as usize] else { continue };
            if triangle.contains(&a) {
                self.triangles[t as usize] = None;
                continue;
            }
            triangle.iter_mut().filter(|v| **v == b).for_each(|v| *v = a);
            self.about[a as usize].push(t);
        }
        let triangles = &self.triangles;
        self.about[a as usize].retain(|&t| triangles[t as usize].is_some());
        (self.places[a as usize], self.costs[a as usize]) = (place, both);
        self.changes[a as usize] += 1;
        self.changes[b as usize] = u32::MAX;
        for v in self.beside(a) {
            self.enqueue(a, v);
        }
        true
    }

    /// Whether a triangle about `v` that stays would turn over, or become a sliver, with `v` at `place`.
    fn folds(&self, v: u32, ends: [u32; 2], place: DVec3) -> bool {
        self.about[v as usize].iter().filter_map(|&t| self.triangles[t as usize]).any(|triangle| {
            if triangle.iter().filter(|v| ends.contains(v)).count() == 2 {
                return false;
            }
            let before = triangle.map(|w| self.places[w as usize]);
            let after = triangle.map(|w| if w == v { place } else { self.places[w as usize] });
            let normal = |[a, b, c]: [DVec3; 3]| (b - a).cross(c - a);
            let longest =
                |[a, b, c]: [DVec3; 3]| a.distance_squared(b).max(b.distance_squared(c)).max(c.distance_squared(a));
            let (old, new) = (normal(before), normal(after));
            new.dot(old) < 0.3 * new.length() * old.length() || new.length() < 0.08 * longest(after)
        })
    }

    fn result(self) -> Skin {
        let mut number = vec![u32::MAX; self.places.len()];
        let mut skin = Skin::default();
        for triangle in self.triangles.into_iter().flatten() {
            skin.triangles.push(triangle.map(|v| {
                let number = &mut number[v as usize];
                if *number == u32::MAX {
                    *number = skin.places.len() as u32;
                    skin.places.push(self.places[v as usize].as_vec3());
                }
                *number
            }));
        }
        skin
    }
}
