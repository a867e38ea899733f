//! Hair for the characters: roots spread over the skin, strands that lie along a flow, and the .hair file of both.

use glam::Vec3;
use nabiki::random::{mix, unit};
use nabiki::subset;

use super::glb::place;
use super::net::Skin;

/// Candidates for each root.
const CANDIDATES: usize = 4;
/// Steps that a segment is laid in.
const STEPS: usize = 4;
/// Steepest rise of a strand toward the distance from the skin that it keeps.
const RISE: f32 = 0.45;

/// Numbers in [0, 1) that follow from a seed.
pub(super) struct Chance(u64);

impl Chance {
    pub fn of(seed: u64) -> Self {
        Self(mix(seed))
    }

    pub fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(1);
        unit(mix(self.0)) as f32
    }

    /// Between -1 and 1, most often near 0.
    pub fn about(&mut self) -> f32 {
        self.next() + self.next() - 1.0
    }

    fn direction(&mut self) -> Vec3 {
        Vec3::new(self.about(), self.about(), self.about())
    }
}

/// Where a strand begins, and the normal of the skin there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Root {
    pub place: Vec3,
    pub normal: Vec3,
}

/// Spreads `count` roots evenly over where `grows` is above 0, and keeps of each place as many as it says.
pub(super) fn spread(skin: &Skin, count: usize, seed: u64, grows: &dyn Fn(Vec3) -> f32) -> Vec<Root> {
    let normals = skin.normals();
    let mut sum = 0.0;
    let mut upto = Vec::with_capacity(skin.triangles.len());
    for &triangle in &skin.triangles {
        let corners = triangle.map(|v| skin.places[v as usize]);
        let [a, b, c] = corners;
        // A triangle at the border counts whole; candidates beyond the border are dropped.
        if corners.iter().any(|&p| grows(p) > 0.0) {
            sum += f64::from((b - a).cross(c - a).length());
        }
        upto.push(sum);
    }
    let mut chance = Chance::of(seed);
    let mut candidates = Vec::with_capacity(CANDIDATES * count);
    while candidates.len() < CANDIDATES * count {
        let area = f64::from(chance.next()) * sum;
        let t = upto.partition_point(|&upto| upto <= area).min(upto.len() - 1);
        let (mut u, mut v) = (chance.next(), chance.next());
        if u + v > 1.0 {
            (u, v) = (1.0 - u, 1.0 - v);
        }
        let of = |all: &[Vec3]| {
            let [a, b, c] = skin.triangles[t].map(|w| all[w as usize]);
            a + (b - a) * u + (c - a) * v
        };
        let root = Root { place: of(&skin.places), normal: of(&normals).normalize() };
        if grows(root.place) > 0.0 {
            candidates.push(root);
        }
    }
    let places: Vec<Vec3> = candidates.iter().map(|root| root.place).collect();
    let chosen = subset::evenly(&places, count).into_iter().map(|i| candidates[i]);
    chosen.filter(|root| chance.next() < grows(root.place)).collect()
}

/// How a strand lies.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lie {
    /// Where it goes along the skin.
    pub flow: Vec3,
    /// How steeply it leaves the skin, as a slope.
    pub lift: f32,
    /// How much its weight turns it down (per cm).
    pub weight: f32,
    /// Its length (cm), and into how many segments it is cut.
    pub length: f32,
    pub segments: usize,
    /// Distance from the skin that it keeps (cm), once it is there.
    pub clear: f32,
}

/// Lays out a strand over the skin of `field`. `flow` is asked again on its way.
pub(super) fn lay(field: &dyn Fn(Vec3) -> f32, root: Root, lie: Lie, flow: &dyn Fn(Vec3) -> Vec3) -> Vec<Vec3> {
    let along = |v: Vec3, normal: Vec3| (v - normal * v.dot(normal)).normalize_or_zero();
    let mut t = (along(lie.flow, root.normal) + root.normal * lie.lift).normalize_or(root.normal);
    let ds = lie.length / (lie.segments * STEPS) as f32;
    let (mut p, mut points) = (root.place, vec![root.place]);
    for step in 1..=lie.segments * STEPS {
        let s = step as f32 * ds;
        let wanted = flow(p) * 0.25 + Vec3::NEG_Y * lie.weight;
        t = (t + wanted * ds).normalize();
        let mut next = p + t * ds;
        // Two Newton steps out of the skin, and then as far as the strand went before.
        for _ in 0..2 {
            let short = lie.clear.min(RISE * s) - field(next);
            if short > 0.0 {
                next += gradient(field, next) * short;
            }
        }
        t = (next - p).normalize();
        p += t * ds;
        if step % STEPS == 0 {
            points.push(p);
        }
    }
    points
}

/// The direction in which the field rises.
pub(super) fn gradient(field: &dyn Fn(Vec3) -> f32, p: Vec3) -> Vec3 {
    let h = 0.02;
    let rise = |e: Vec3| field(p + e * h) - field(p - e * h);
    Vec3::new(rise(Vec3::X), rise(Vec3::Y), rise(Vec3::Z)).normalize_or(Vec3::Y)
}

/// Tufts: a direction that all strands within about `size` (cm) share, from a lattice of random ones. Its length is about 1.
pub(super) fn tuft(p: Vec3, size: f32, seed: u64) -> Vec3 {
    let q = p / size;
    let cell = q.floor();
    let f = q - cell;
    let f = f * f * (3.0 - 2.0 * f);
    let mut sum = Vec3::ZERO;
    for corner in 0..8_u64 {
        let offset = Vec3::new((corner & 1) as f32, (corner >> 1 & 1) as f32, (corner >> 2) as f32);
        let at = (cell + offset).as_ivec3();
        let hash = [at.x, at.y, at.z].into_iter().fold(seed, |hash, i| mix(hash ^ u64::from(i as u32)));
        let weight = (1.0 - (f - offset).abs()).element_product();
        sum += Chance::of(hash).direction() * weight;
    }
    sum * 2.0
}

/// The .hair file (Yuksel's) of strands whose origin stands at `at` (cm) in the file of the mesh.
pub(super) fn write(strands: &[Vec<Vec3>], at: Vec3) -> Vec<u8> {
    const SEGMENTS_AND_POINTS: u32 = 3;
    let points: usize = strands.iter().map(Vec::len).sum();
    let mut bytes = b"HAIR".to_vec();
    let counts = [strands.len() as u32, points as u32, SEGMENTS_AND_POINTS, 0];
    bytes.extend(counts.iter().flat_map(|n| n.to_le_bytes()));
    // No thickness; opaque; white.
    bytes.extend([0.0_f32, 0.0, 1.0, 1.0, 1.0].iter().flat_map(|x| x.to_le_bytes()));
    bytes.resize(128, 0);
    bytes.extend(strands.iter().flat_map(|strand| (strand.len() as u16 - 1).to_le_bytes()));
    let places = strands.iter().flatten().flat_map(|&p| place(p + at).to_array());
    bytes.extend(places.flat_map(|x| x.to_le_bytes()));
    bytes
}
