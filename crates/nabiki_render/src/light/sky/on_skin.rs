//! What of the sky reaches a surface.

use glam::Vec3;

use super::SkyMap;
use super::arriving::between;

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

/// The light of the sky that arrives in a cell along all directions, and whether it is that for places outside the box.
#[derive(Clone, Copy)]
struct Kept {
    cell: usize,
    outside: bool,
    light: [f32; LANES],
}

impl<'a> OnSkin<'a> {
    pub fn new(map: &'a SkyMap) -> Self {
        let of = |value: &dyn Fn(usize) -> f32| {
            std::array::from_fn(|n| if n < map.directions.len() { value(n) } else { 0.0 })
        };
        let nothing = Kept { cell: usize::MAX, outside: false, light: [0.0; LANES] };
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
        let (base, beyond) = self.map.lattice(&place.to_array().map(|c| [c]));
        let base = base.map(|c| c[0] as usize);
        let outside = !self.map.holds(place);
        let [_, row, slice, _] = self.map.lines();
        let kept_at: [usize; 8] = std::array::from_fn(|i| {
            let c = [base[0] + i % 2, base[1] + i / 2 % 2, base[2] + i / 4];
            let kept_at = c[0] % KEPT + KEPT * (c[1] % KEPT + KEPT * (c[2] % KEPT));
            self.keep(kept_at, (c, c[0] + row * c[1] + slice * c[2]), outside);
            kept_at
        });
        let (sky, corners) = (&*self, kept_at.map(|i| &self.kept[i]));
        pulp::Arch::new().dispatch(Sum { sky, normal, corners, beyond: beyond.map(|beyond| beyond[0]) })
    }

    /// The light that other skin sends to a place on a surface with this unit normal.
    pub fn glow(&self, place: Vec3, normal: Vec3) -> f32 {
        self.map.exchange.at(place, normal)
    }

    /// Has a cell, by its place in the box and its number, at one of the places where cells are kept. Places outside the box read the nearest cell, and
    /// see the open sky where light comes into it: what skin outside takes there may be their own.
    fn keep(&mut self, kept_at: usize, (c, cell): ([usize; 3], usize), outside: bool) {
        let kept = &mut self.kept[kept_at];
        if kept.cell != cell || kept.outside != outside {
            (kept.cell, kept.outside) = (cell, outside);
            let enters = |step: [i32; 3]| {
                (0..3).any(|axis| !(0..self.map.size[axis] as i32).contains(&(c[axis] as i32 - step[axis])))
            };
            for ((kept, light), direction) in kept.light.iter_mut().zip(&self.map.carried).zip(&self.map.directions) {
                *kept = if outside && enters(direction.step) { 1.0 } else { light[cell] };
            }
        }
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
        let Self { sky: OnSkin { from, weight, halves, .. }, normal, corners: c, beyond } = self;
        let open = between(
            beyond,
            [&c[0].light, &c[1].light, &c[2].light, &c[3].light, &c[4].light, &c[5].light, &c[6].light, &c[7].light],
        );
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

/// The sum over all lanes, halves onto halves: one after another each would wait for the one before.
#[inline(always)]
fn total(lanes: [f32; LANES]) -> f32 {
    let eight: [f32; LANES / 2] = std::array::from_fn(|n| lanes[n] + lanes[n + 8]);
    let four: [f32; LANES / 4] = std::array::from_fn(|n| eight[n] + eight[n + 4]);
    (four[0] + four[2]) + (four[1] + four[3])
}
