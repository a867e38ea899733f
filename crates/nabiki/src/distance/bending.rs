//! Signed distance to a skin that bends: sampled anew in each frame, in a band around it.
//!
//! Each triangle gives its distance to the samples within the band; the sign is that of the nearest face, edge or vertex
//! (J. Baerentzen and H. Aanaes, "Signed distance computation using the angle weighted pseudonormal", 2005). Beyond the band,
//! distances go from sample to sample, and are too small rather than too large.

use std::collections::HashMap;
use std::sync::{Arc, OnceLock};

use glam::{UVec3, Vec3};
use rayon::prelude::*;

use super::nearest::weights;
use super::{COARSE, EDGE, FINE, SLICE, Samples, SkinDistance, rims};
use crate::Mesh;
use crate::obstacle::{Obstacle, Reading};
use crate::random::mix;

/// Width of the band beyond the largest clearance, in fine steps: the diagonal of a cell, so that all around a clearance is known.
const BAND: f32 = 1.75;
/// Share of the way from sample to sample by which distances grow beyond the band: along the axes, ways are up to the root of 3 times
/// too long.
const SURE: f32 = 0.57;
const BLOCK: usize = EDGE * EDGE * EDGE;

/// A skin that bends from frame to frame, as a body that hair stays out of. Outside its frames it keeps the shape of the first or the
/// last one.
#[derive(Debug)]
pub struct BendingSkin {
    rest: Arc<SkinDistance>,
    frames: Vec<Frame>,
    identity: [f32; 2],
    /// Within this distance of the skin, distances are not too small.
    band: f32,
}

#[derive(Debug)]
struct Frame {
    skin: SkinDistance,
    /// The motion of the skin since the frame before at the corners of each block, x fastest.
    moved: Vec<[Vec3; 8]>,
    /// The largest of a corner of the triangles that are sampled (cm).
    farthest: f32,
}

impl BendingSkin {
    /// A skin with this distance and `mesh` at rest, and with these vertices in each frame, in the order of the mesh (all in one space, cm).
    /// Distances are sampled in the box `low..high`, as finely as at rest, up to `clearance` from the skin, and are at least that beyond.
    ///
    /// # Panics
    /// If a frame has another number of vertices than the mesh.
    pub fn new(
        rest: Arc<SkinDistance>,
        mesh: &Mesh,
        frames: &[Vec<Vec3>],
        [low, high]: [Vec3; 2],
        clearance: f32,
    ) -> Self {
        let spacing = rest.spacing();
        let cell = spacing * FINE as f32;
        let cells = ((high - low) / cell).ceil().as_uvec3().max(UVec3::ONE);
        // Signs are those of the faces.
        let mut mesh = mesh.clone();
        mesh.turn_outward();
        let sampler =
            Sampler { topology: &Topology::new(&mesh), low, spacing, cells, band: clearance + BAND * spacing };
        let frame = |n: usize| sampler.frame(&frames[n], &frames[n.saturating_sub(1)]);
        let identity = frames
            .iter()
            .flatten()
            .fold(0, |hash, p| p.to_array().into_iter().fold(hash, |hash, x| mix(hash ^ u64::from(x.to_bits()))));
        let identity = [identity as u32, (identity >> 32) as u32].map(f32::from_bits);
        let band = sampler.band;
        Self { rest, frames: (0..frames.len()).into_par_iter().map(frame).collect(), identity, band }
    }

    /// Its memory (bytes).
    pub fn bytes(&self) -> u64 {
        let of = |frame: &Frame| {
            let Samples { coarse, block_of, fine, .. } = &frame.skin.samples;
            size_of_val(&coarse[..])
                + size_of_val(&block_of[..])
                + size_of_val(&fine[..])
                + size_of_val(&frame.moved[..])
        };
        self.frames.iter().map(|frame| of(frame) as u64).sum()
    }

    fn frame(&self, frame: u32) -> Option<&Frame> {
        self.frames.get(frame as usize).or(self.frames.last())
    }
}

impl Obstacle for BendingSkin {
    fn reach(&self) -> [Vec3; 2] {
        self.frames.first().map_or_else(|| self.rest.sampled_box(), |frame| frame.skin.sampled_box())
    }

    fn read(&self, p: Vec3, frame: u32) -> Option<Reading> {
        self.frame(frame).map_or_else(|| self.rest.read(p, 0), |frame| frame.skin.read(p, 0))
    }

    fn read_during(&self, p: Vec3, frame: u32, part: f32) -> Option<Reading> {
        let now = self.read(p, frame)?;
        if part >= 1.0 || self.farthest_moved(frame) == 0.0 {
            return Some(now);
        }
        let before = self.read(p, frame - 1)?;
        let mix = |before: f32, now: f32| before + part * (now - before);
        Some(Reading {
            distance: mix(before.distance, now.distance),
            gradient: before.gradient.lerp(now.gradient, part),
            hessian: before.hessian + part * (now.hessian - before.hessian),
        })
    }

    fn exact_within(&self) -> f32 {
        self.band
    }

    fn read_at_rest(&self, p: Vec3) -> Option<Reading> {
        self.rest.read(p, 0)
    }

    fn moved(&self, p: Vec3, frame: u32) -> Vec3 {
        match self.frames.get(frame as usize) {
            Some(at) if frame > 0 => at.moved(p),
            _ => Vec3::ZERO,
        }
    }

    fn farthest_moved(&self, frame: u32) -> f32 {
        if frame == 0 { 0.0 } else { self.frames.get(frame as usize).map_or(0.0, |frame| frame.farthest) }
    }

    fn identify(&self, hand_on: &mut dyn FnMut(&[f32])) {
        self.rest.identify(hand_on);
        hand_on(&self.identity);
    }
}

impl Frame {
    fn moved(&self, p: Vec3) -> Vec3 {
        let Samples { low, cell, nodes, block_of, .. } = &self.skin.samples;
        let (q, cells) = ((p - low) / cell, *nodes - 1);
        if !(q.cmpge(Vec3::ZERO).all() && q.cmplt(cells.as_vec3()).all()) {
            return Vec3::ZERO;
        }
        let c = q.as_uvec3();
        let t = q - c.as_vec3();
        let block = block_of[((c.z * cells.y + c.y) * cells.x + c.x) as usize];
        let Some(corners) = self.moved.get(block as usize) else { return Vec3::ZERO };
        let along_x = |i: usize| corners[i].lerp(corners[i + 1], t.x);
        let along_y = |i: usize| along_x(i).lerp(along_x(i + 2), t.y);
        along_y(0).lerp(along_y(4), t.z)
    }
}

/// What of a mesh does not change as it bends.
struct Topology {
    /// With joined seams and closed rims.
    triangles: Vec<[u32; 3]>,
    /// The triangle across each edge, from corner i to i + 1; its own number where there is none.
    beside: Vec<[u32; 3]>,
    rims: Vec<Vec<u32>>,
    vertices: usize,
}

impl Topology {
    fn new(mesh: &Mesh) -> Self {
        let triangles = rims::closed(mesh).triangles;
        let mut of_edge: HashMap<[u32; 2], u32> = HashMap::with_capacity(3 * triangles.len());
        for (t, triangle) in triangles.iter().enumerate() {
            (0..3).for_each(|i| {
                of_edge.insert([triangle[i], triangle[(i + 1) % 3]], t as u32);
            });
        }
        let across = |(t, triangle): (usize, &[u32; 3])| {
            [0, 1, 2].map(|i| of_edge.get(&[triangle[(i + 1) % 3], triangle[i]]).copied().unwrap_or(t as u32))
        };
        let beside = triangles.iter().enumerate().map(across).collect();
        Self { beside, triangles, rims: rims::of(mesh), vertices: mesh.positions.len() }
    }

    /// The vertices, and after them the middles of the rims.
    fn vertices(&self, positions: &[Vec3]) -> Vec<Vec3> {
        assert_eq!(positions.len(), self.vertices, "a frame has every vertex of the mesh");
        let middles = self.rims.iter().map(|rim| rims::middle(rim, positions));
        positions.iter().copied().chain(middles).collect()
    }
}

/// Where and how a skin is sampled.
struct Sampler<'a> {
    topology: &'a Topology,
    low: Vec3,
    spacing: f32,
    cells: UVec3,
    band: f32,
}

/// A skin in one frame.
struct Shape<'a> {
    topology: &'a Topology,
    vertices: Vec<Vec3>,
    before: Vec<Vec3>,
    /// Of the triangles, of length 1 or 0.
    faces: Vec<Vec3>,
    /// Of the vertices, weighted by angles.
    corners: Vec<Vec3>,
}

impl<'a> Shape<'a> {
    fn new(topology: &'a Topology, positions: &[Vec3], before: &[Vec3]) -> Self {
        let vertices = topology.vertices(positions);
        let mut corners = vec![Vec3::ZERO; vertices.len()];
        let face = |triangle: &[u32; 3]| {
            let at = triangle.map(|v| vertices[v as usize]);
            let normal = (at[1] - at[0]).cross(at[2] - at[0]).normalize_or_zero();
            for i in 0..3 {
                let [to, back] = [1, 2].map(|k| (at[(i + k) % 3] - at[i]).normalize_or_zero());
                corners[triangle[i] as usize] += to.dot(back).clamp(-1.0, 1.0).acos() * normal;
            }
            normal
        };
        let faces = topology.triangles.iter().map(face).collect();
        Self { topology, before: topology.vertices(before), faces, corners, vertices }
    }

    fn triangle(&self, t: u32) -> [Vec3; 3] {
        self.topology.triangles[t as usize].map(|v| self.vertices[v as usize])
    }

    /// 1 outside, -1 inside, by the nearest triangle; and how its nearest point has moved.
    fn sign_and_motion(&self, p: Vec3, t: u32) -> (f32, Vec3) {
        let numbers = self.topology.triangles[t as usize];
        let weights = weights(self.triangle(t), p);
        let of = |all: &[Vec3]| (0..3).map(|i| weights[i] * all[numbers[i] as usize]).sum::<Vec3>();
        let at = of(&self.vertices);
        let on = [0, 1, 2].map(|i| weights[i] > 0.0);
        let normal = match on.iter().filter(|&&on| on).count() {
            1 => self.corners[numbers[on.iter().position(|&on| on).unwrap_or(0)] as usize],
            2 => {
                // The edge before the corner that it leaves out.
                let edge = (on.iter().position(|&on| !on).unwrap_or(0) + 1) % 3;
                self.faces[t as usize] + self.faces[self.topology.beside[t as usize][edge] as usize]
            }
            _ => self.faces[t as usize],
        };
        (if (p - at).dot(normal) < 0.0 { -1.0 } else { 1.0 }, at - of(&self.before))
    }
}

impl Sampler<'_> {
    fn frame(&self, positions: &[Vec3], before: &[Vec3]) -> Frame {
        let shape = Shape::new(self.topology, positions, before);
        let (low, cell) = (self.low, self.spacing * FINE as f32);
        let nodes = self.cells + 1;
        let [nx, ny, _] = nodes.to_array();
        let mut coarse = vec![f32::NAN; nodes.element_product() as usize];
        let mut block_of = vec![COARSE; self.cells.element_product() as usize];
        let (mut fine, mut moved) = (Vec::new(), Vec::new());
        let (starts, triangles) = self.triangles_by_cell(&shape);
        for (number, range) in (0..).zip(starts.windows(2)) {
            let triangles = &triangles[range[0] as usize..range[1] as usize];
            if triangles.is_empty() {
                continue;
            }
            let c = UVec3::new(
                number % self.cells.x,
                number / self.cells.x % self.cells.y,
                number / (self.cells.x * self.cells.y),
            );
            let Some((block, corners)) = self.block(&shape, low + cell * c.as_vec3(), triangles) else { continue };
            for (k, corner) in corner_nodes().enumerate() {
                let node = c + UVec3::new(k as u32 & 1, k as u32 >> 1 & 1, k as u32 >> 2);
                coarse[((node.z * ny + node.y) * nx + node.x) as usize] = block[corner];
            }
            block_of[number as usize] = fine.len() as u32;
            fine.push(block);
            moved.push(corners);
        }
        spread(&mut coarse, nodes, SURE * cell, self.band);
        let samples = Samples { low, cell, nodes, mirrored: false, coarse, block_of, fine };
        Frame {
            skin: SkinDistance { tree: OnceLock::new(), mesh: Mesh::default(), samples },
            moved,
            farthest: self.farthest(&shape),
        }
    }

    /// The largest motion of a corner of the triangles within the band of any cell, now or before (cm).
    fn farthest(&self, shape: &Shape) -> f32 {
        let motion = |triangle: &[u32; 3]| {
            let [now, before] = [&shape.vertices, &shape.before].map(|all| triangle.map(|v| all[v as usize]));
            let near = self.cells_about(now).is_some() || self.cells_about(before).is_some();
            let motions = now.into_iter().zip(before).map(|(now, before)| now.distance(before));
            if near { motions.fold(0.0, f32::max) } else { 0.0 }
        };
        shape.topology.triangles.iter().map(motion).fold(0.0, f32::max)
    }

    /// The triangles within the band of each cell: where those of a cell begin, one after another, and all of them.
    fn triangles_by_cell(&self, shape: &Shape) -> (Vec<u32>, Vec<u32>) {
        let count = self.cells.element_product() as usize;
        let each = |visit: &mut dyn FnMut(usize, u32)| {
            for t in 0..shape.topology.triangles.len() as u32 {
                let Some([from, to]) = self.cells_about(shape.triangle(t)) else { continue };
                for z in from.z..=to.z {
                    for y in from.y..=to.y {
                        let row = ((z * self.cells.y + y) * self.cells.x) as usize;
                        (from.x..=to.x).for_each(|x| visit(row + x as usize, t));
                    }
                }
            }
        };
        let mut starts = vec![0_u32; count + 1];
        each(&mut |cell, _| starts[cell + 1] += 1);
        for cell in 0..count {
            starts[cell + 1] += starts[cell];
        }
        let (mut next, mut all) = (starts.clone(), vec![0; starts[count] as usize]);
        each(&mut |cell, t| {
            all[next[cell] as usize] = t;
            next[cell] += 1;
        });
        (starts, all)
    }

    /// The first and last cell within the band of a triangle, if there is any.
    fn cells_about(&self, [a, b, c]: [Vec3; 3]) -> Option<[UVec3; 2]> {
        let cell = self.spacing * FINE as f32;
        let from = (a.min(b).min(c) - self.band - self.low) / cell;
        let to = (a.max(b).max(c) + self.band - self.low) / cell;
        let outside = to.cmplt(Vec3::ZERO).any() || from.cmpge(self.cells.as_vec3()).any();
        (!outside).then(|| [from.max(Vec3::ZERO).as_uvec3(), to.as_uvec3().min(self.cells - 1)])
    }

    /// The samples of a cell with this lower corner, and the motion of the skin at its corners; `None` if no triangle is within the
    /// band of any.
    fn block(&self, shape: &Shape, corner: Vec3, triangles: &[u32]) -> Option<([f32; BLOCK], [Vec3; 8])> {
        let (mut distances, mut nearest) = ([self.band; BLOCK], [u32::MAX; BLOCK]);
        for &t in triangles {
            let [a, b, c] = shape.triangle(t);
            // Only samples in the box around the triangle.
            let from = ((a.min(b).min(c) - self.band - corner) / self.spacing).ceil().max(Vec3::ZERO);
            let to = ((a.max(b).max(c) + self.band - corner) / self.spacing).floor().min(Vec3::splat(FINE as f32));
            if from.cmpgt(to).any() {
                continue;
            }
            let ([i0, j0, k0], [i1, j1, k1]) = (from.as_uvec3().to_array(), to.as_uvec3().to_array());
            let middle = (a + b + c) / 3.0;
            let radius = [a, b, c].map(|corner| corner.distance_squared(middle)).into_iter().fold(0.0, f32::max).sqrt();
            let (reach, away) = (self.band + radius, corner - middle);
            for k in k0..=k1 {
                let z = away.z + self.spacing * k as f32;
                for j in j0..=j1 {
                    let y = away.y + self.spacing * j as f32;
                    let beside = y * y + z * z;
                    if beside >= reach * reach {
                        continue;
                    }
                    let row = (k as usize * EDGE + j as usize) * EDGE;
                    for i in i0..=i1 {
                        let (x, at) = (away.x + self.spacing * i as f32, row + i as usize);
                        // Most triangles are farther away than one that was looked at before.
                        let near = distances[at] + radius;
                        if x * x + beside >= near * near {
                            continue;
                        }
                        let p = middle + Vec3::new(x, y, z);
                        let weights = weights([a, b, c], p);
                        let distance = p.distance(weights.x * a + weights.y * b + weights.z * c);
                        if distance < distances[at] {
                            (distances[at], nearest[at]) = (distance, t);
                        }
                    }
                }
            }
        }
        if nearest.iter().all(|&t| t == u32::MAX) {
            return None;
        }
        let place = |at: usize| {
            let [i, j, k] = [at % EDGE, at / EDGE % EDGE, at / SLICE].map(|i| i as f32);
            corner + self.spacing * Vec3::new(i, j, k)
        };
        let mut block = [f32::NAN; BLOCK];
        for at in 0..BLOCK {
            if nearest[at] != u32::MAX {
                block[at] = shape.sign_and_motion(place(at), nearest[at]).0 * distances[at];
            }
        }
        // Farther away than the band, on the side of their neighbours.
        spread(&mut block, UVec3::splat(EDGE as u32), 0.0, self.band);
        block.iter_mut().zip(nearest).filter(|(_, t)| *t == u32::MAX).for_each(|(d, _)| *d = self.band.copysign(*d));
        let motion = |at: usize| match nearest[at] {
            // As that of any triangle near by.
            u32::MAX => shape.sign_and_motion(place(at), triangles[0]).1,
            t => shape.sign_and_motion(place(at), t).1,
        };
        let mut corners = [Vec3::ZERO; 8];
        corner_nodes().enumerate().for_each(|(k, at)| corners[k] = motion(at));
        Some((block, corners))
    }
}

/// The samples of a block at its corners, x fastest.
fn corner_nodes() -> impl Iterator<Item = usize> {
    (0..8).map(|k| ((k >> 2) * EDGE + (k >> 1 & 1)) * EDGE * FINE + (k & 1) * FINE)
}

/// Fills samples that are not numbers from their neighbours along the axes, with the sign of the nearest, each step farther away by `step`;
/// with `alone` if none is a number.
fn spread(samples: &mut [f32], nodes: UVec3, step: f32, alone: f32) {
    let [nx, ny, nz] = nodes.to_array().map(|n| n as usize);
    let unknown: Vec<bool> = samples.iter().map(|d| d.is_nan()).collect();
    if !unknown.contains(&true) {
        return;
    }
    if !unknown.contains(&false) {
        // No skin within reach.
        samples.fill(alone);
        return;
    }
    let mut goes_on = true;
    while goes_on {
        goes_on = false;
        for forth in [true, false] {
            for n in 0..samples.len() {
                let at = if forth { n } else { samples.len() - 1 - n };
                if !unknown[at] {
                    continue;
                }
                let place = [at % nx, at / nx % ny, at / (nx * ny)];
                for (axis, stride) in [1, nx, nx * ny].into_iter().enumerate() {
                    let beside = match forth {
                        true if place[axis] > 0 => at - stride,
                        false if place[axis] + 1 < [nx, ny, nz][axis] => at + stride,
                        _ => continue,
                    };
                    let from = samples[beside];
                    let there = (from.abs() + step).copysign(from);
                    if !from.is_nan() && (samples[at].is_nan() || there.abs() < samples[at].abs()) {
                        (samples[at], goes_on) = (there, true);
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests;
