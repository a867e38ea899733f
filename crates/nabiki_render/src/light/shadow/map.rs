//! Hair as a lamp sees it: cells of a plane, and distances in slabs.

use glam::Vec3;

use super::Scene;
use super::item::{Fibre, Item};
use crate::light::lamps::Lamp;

/// Distances are told apart in slabs so thick (cm): a few fibres. Within a slab the order is that of the nodes.
const SLAB: f32 = 0.05;
const MOST_SLABS: f32 = 2048.0;
/// Hair farther than this from the origin of head space (cm) is not told apart, lest one lost strand spoil the order of all.
const FARTHEST: f32 = 200.0;
/// Side of a cell (cm) for a lamp that is a point: a few hairs. Where cells are wider than the way to the next layer of hair, hair that
/// faces the lamp at a grazing angle lies in its own shadow.
const CELL: f32 = 0.05;
/// Largest side of a map (cells).
const LARGEST: f32 = 4096.0;
/// Pieces are cut into parts that reach no farther into depth than this, and are no longer (cm): each lies at one distance.
const DEEPEST: f32 = 0.3;
const LONGEST: f32 = 1.0;
const MOST_PARTS: f32 = 32.0;
/// How far behind a part (cm) what is spread over cells beside it still counts as the same layer, at most.
const SPREAD_BEHIND: f32 = 0.1;

/// The plane and the distances that hold hair.
pub struct Map {
    right: Vec3,
    up: Vec3,
    pub toward: Vec3,
    cells_per_cm: f32,
    /// First cell, and number of cells right and down.
    low: [f32; 2],
    pub size: [usize; 2],
    spread_behind: f32,
    near: f32,
    slabs_per_cm: f32,
    pub slabs: usize,
}

impl Map {
    pub fn new(lamp: &Lamp, scene: &Scene) -> Self {
        let [low, high] = scene.bounds;
        let toward = lamp.toward;
        let right = toward.any_orthonormal_vector();
        let up = toward.cross(right);
        // A wide lamp blurs what lies a centimetre behind the occluder by so much.
        let cells_per_cm = 1.0 / CELL.max(1.25 * lamp.spread.tan()).max(scene.width).max(scene.least_cell);
        // The box as the lamp sees it.
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        let [x, y, z] = [cells_per_cm * right, cells_per_cm * up, -toward].map(|axis| {
            let (middle, half) = (middle.dot(axis), half.dot(axis.abs()));
            [middle - half, middle + half]
        });
        let (low, high) = (Vec3::new(x[0], y[0], z[0]), Vec3::new(x[1], y[1], z[1]));
        // Beyond the largest map, far outliers are left without shadow rather than all hair with a coarse one.
        let middle = 0.5 * (low + high);
        let side = (high - low).min(Vec3::splat(LARGEST));
        let (near, far) = (low.z.clamp(-FARTHEST, FARTHEST), high.z.clamp(-FARTHEST, FARTHEST));
        let slabs = ((far - near) / SLAB).ceil().clamp(1.0, MOST_SLABS);
        Self {
            right,
            up,
            toward,
            cells_per_cm,
            low: [middle.x - 0.5 * side.x, middle.y - 0.5 * side.y],
            size: [side.x as usize + 3, side.y as usize + 3],
            spread_behind: SPREAD_BEHIND.max(2.0 * scene.least_cell),
            near,
            slabs_per_cm: slabs / (far - near).max(SLAB),
            slabs: slabs as usize,
        }
    }

    /// A place as the lamp sees it: cells right and down, and distance (cm).
    #[inline(always)]
    pub fn project(&self, p: Vec3) -> Vec3 {
        let cells = self.cells_per_cm;
        Vec3::new(p.dot(self.right) * cells - self.low[0], p.dot(self.up) * cells - self.low[1], -p.dot(self.toward))
    }

    /// The slab of a distance.
    #[inline(always)]
    pub fn slab(&self, distance: f32) -> u16 {
        ((distance - self.near) * self.slabs_per_cm).min(self.slabs as f32 - 1.0) as u16
    }

    /// Cuts the piece that the lamp sees between two places, of hair so thick (cm), into parts that each lie at one distance: `each` is
    /// given a part and the distance (cm) from which on it counts.
    #[inline(always)]
    pub fn cut(&self, from: Vec3, to: Vec3, thickness: f32, mut each: impl FnMut(Item, f32)) {
        let way = to - from;
        let across = (way.x * way.x + way.y * way.y).sqrt();
        let cm = 1.0 / self.cells_per_cm;
        let length = (cm * cm * across * across + way.z * way.z).sqrt();
        let wanted = (way.z.abs() * (1.0 / DEEPEST)).max(length * (1.0 / LONGEST)).min(MOST_PARTS);
        // Rounded up, without a call.
        let down = wanted as u8;
        let count = down + u8::from(f32::from(down) < wanted);
        let share = 1.0 / f32::from(count.max(1));
        let (part, across) = (way * share, across * share);
        // Hair beside it is not in its shadow: it counts for what lies behind its far half, and behind half of a cell beyond.
        let deep = part.z.abs();
        let behind = 0.25 * deep + (0.5 * deep / across.max(1e-6)).min(self.spread_behind);
        let fibre = Fibre { extent: [part.x, part.y], fibres: thickness * self.cells_per_cm * across };
        for k in 0..count {
            let at = from + part * (f32::from(k) + 0.5);
            each(Item::lays(at, &fibre), at.z + behind);
        }
    }
}
