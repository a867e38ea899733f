//! What of the sky reaches a surface.

use glam::Vec3;

use super::SkyMap;
use super::arriving::between;
use super::exchange::Arriving;

/// At least as many lanes as there are directions.
const LANES: usize = 16;
/// Cells along each axis of which the last asked for are kept.
const KEPT: usize = 8;

/// Reads what arrives at places on surfaces. It keeps the cells that it was last asked for, with all directions of one side by side: places that
/// follow each other lie in the same ones.
pub struct OnSkin<'a> {
    map: &'a SkyMap,
    /// Of each direction where it comes from, and its weight; no weight for lanes without a direction.
    from: [[f32; LANES]; 3],
    weight: [f32; LANES],
    halves: [[f32; LANES]; 2],
    kept: Vec<Kept>,
}

/// The light of the sky that arrives in a cell along all directions.
#[derive(Clone, Copy)]
struct Kept {
    cell: usize,
    light: [f32; LANES],
}

impl<'a> OnSkin<'a> {
    pub fn new(map: &'a SkyMap) -> Self {
        let of = |value: &dyn Fn(usize) -> f32| {
            std::array::from_fn(|n| if n < map.directions.len() { value(n) } else { 0.0 })
        };
        let nothing = Kept { cell: usize::MAX, light: [0.0; LANES] };
        Self {
            map,
            from: [0, 1, 2].map(|axis| of(&|n| map.directions[n].from[axis])),
            weight: of(&|n| map.directions[n].weight),
            halves: [0, 1].map(|half| of(&|n| map.directions[n].halves[half])),
            kept: vec![nothing; KEPT * KEPT * KEPT],
        }
    }

    /// The shares of the sky above and of that below, 0..1 each, that arrive at a place on a surface with this unit normal.
    pub fn at(&mut self, place: Vec3, normal: Vec3) -> [f32; 2] {
        if !self.map.holds(place) {
            return self.shares(normal, &self.followed(place, normal));
        }
        let (base, beyond) = self.map.lattice(&place.to_array().map(|c| [c]));
        let base = base.map(|c| c[0] as usize);
        let [_, row, slice, _] = self.map.lines();
        let kept_at: [usize; 8] = std::array::from_fn(|i| {
            let c = [base[0] + i % 2, base[1] + i / 2 % 2, base[2] + i / 4];
            let kept_at = c[0] % KEPT + KEPT * (c[1] % KEPT + KEPT * (c[2] % KEPT));
            self.keep(kept_at, c[0] + row * c[1] + slice * c[2]);
            kept_at
        });
        let (sky, corners) = (&*self, kept_at.map(|i| &self.kept[i]));
        pulp::Arch::new().dispatch(Sum { sky, normal, corners, beyond: beyond.map(|beyond| beyond[0]) })
    }

    /// What arrives outside the box along each direction that a surface with this normal faces: the light that leaves the box on the way, or
    /// the open sky where none of it comes by the box. Skin outside keeps nothing from other skin: it might be the place's own.
    fn followed(&self, place: Vec3, normal: Vec3) -> [f32; LANES] {
        let map = self.map;
        let last = map.size.as_vec3() - 1.0;
        let from = (place - map.low) / map.cell - 0.5;
        let [_, row, slice, _] = map.lines();
        let mut open = [1.0; LANES];
        for ((open, direction), light) in open.iter_mut().zip(&map.directions).zip(&map.carried) {
            if direction.from.dot(normal) <= 0.0 {
                continue;
            }
            // Back along the light's way, in steps of the lattice, to where it is last among the cells.
            let step = Vec3::from(direction.step.map(|c| c as f32));
            let (mut least, mut most) = (0.0_f32, f32::INFINITY);
            for axis in 0..3 {
                let (from, step, last) = (from[axis], step[axis], last[axis]);
                if step == 0.0 {
                    most = if (0.0..=last).contains(&from) { most } else { f32::NEG_INFINITY };
                } else {
                    let (a, b) = (from / step, (from - last) / step);
                    (least, most) = (least.max(a.min(b)), most.min(a.max(b)));
                }
            }
            if least > most {
                continue;
            }
            let at = (from - least * step).clamp(Vec3::ZERO, last - 1e-3);
            let (base, beyond) = (at.as_uvec3(), at.fract());
            let cell = map.index(base);
            let corner =
                |i: usize| &light[cell + [0, 1, row, row + 1, slice, slice + 1, slice + row, slice + row + 1][i]];
            let corners: [&[f32; 1]; 8] = std::array::from_fn(|i| std::array::from_ref(corner(i)));
            [*open] = between(beyond.to_array(), corners);
        }
        open
    }

    /// What arrives at a place on skin that is seen, with this unit normal.
    pub fn seen(&mut self, place: Vec3, normal: Vec3) -> Arriving {
        self.map.exchange.at(place, normal).unwrap_or_else(|| {
            let through = self.at(place, normal);
            Arriving { glow: 0.0, open: [1.0; 2], through }
        })
    }

    /// Has a cell, by its number, at one of the places where cells are kept.
    fn keep(&mut self, kept_at: usize, cell: usize) {
        let kept = &mut self.kept[kept_at];
        if kept.cell != cell {
            kept.cell = cell;
            kept.light.iter_mut().zip(&self.map.carried).for_each(|(kept, light)| *kept = light[cell]);
        }
    }

    /// The shares of the sky above and below, of what is open along each direction.
    #[inline(always)]
    fn shares(&self, normal: Vec3, open: &[f32; LANES]) -> [f32; 2] {
        let Self { from, weight, halves, .. } = self;
        let mut parts = [[0.0_f32; LANES]; 4];
        for n in 0..LANES {
            let cos = normal.x * from[0][n] + normal.y * from[1][n] + normal.z * from[2][n];
            let facing = (weight[n] * cos).max(0.0);
            let (above, below) = (facing * halves[0][n], facing * halves[1][n]);
            parts[0][n] = above * open[n];
            parts[1][n] = below * open[n];
            parts[2][n] = above;
            parts[3][n] = below;
        }
        let sums = parts.map(total);
        [0, 1].map(|n| sums[n] / (sums[n + 2] + 1e-12))
    }
}

/// The sum over all directions, compiled for each width of vectors that machines have; one is chosen at run time.
struct Sum<'a> {
    sky: &'a OnSkin<'a>,
    normal: Vec3,
    corners: [&'a Kept; 8],
    beyond: [f32; 3],
}

impl pulp::NullaryFnOnce for Sum<'_> {
    type Output = [f32; 2];

    #[inline(always)]
    fn call(self) -> [f32; 2] {
        let Self { sky, normal, corners: c, beyond } = self;
        let open = between(
            beyond,
            [&c[0].light, &c[1].light, &c[2].light, &c[3].light, &c[4].light, &c[5].light, &c[6].light, &c[7].light],
        );
        sky.shares(normal, &open)
    }
}

/// The sum over all lanes, halves onto halves: one after another each would wait for the one before.
#[inline(always)]
fn total(lanes: [f32; LANES]) -> f32 {
    let eight: [f32; LANES / 2] = std::array::from_fn(|n| lanes[n] + lanes[n + 8]);
    let four: [f32; LANES / 4] = std::array::from_fn(|n| eight[n] + eight[n + 4]);
    (four[0] + four[2]) + (four[1] + four[3])
}
