//! Light that goes from cell to cell along the directions of a lattice.

use glam::{UVec3, Vec3};

/// Weights by which the sky is summed over lattice directions: along the axes and along the diagonals of a cube (Lebedev's rule
/// of 14 points, exact for polynomials of fifth degree).
const ALONG_AXIS: f32 = 1.0 / 15.0;
const ALONG_DIAGONAL: f32 = 3.0 / 40.0;

/// How far light goes in each cell, along the axes and along the diagonals (sides of a cell).
pub const LENGTHS: [f32; 2] = [1.0, 1.732_050_8];

/// A lattice direction in which light travels.
pub struct Direction {
    /// From cell to cell.
    pub step: [i32; 3],
    /// Unit vector to where the light comes from.
    pub from: Vec3,
    /// How much of the mean over all directions is its.
    pub weight: f32,
    /// The parts of its light that count as from above and as from below.
    pub halves: [f32; 2],
}

impl Direction {
    /// All fourteen, for a sky that is above at `zenith` (unit).
    pub fn all(zenith: Vec3) -> impl Iterator<Item = Self> {
        (0..27_i32).map(|i| [i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1]).filter_map(move |step| {
            let weight = match squared_length(step) {
                1 => ALONG_AXIS,
                3 => ALONG_DIAGONAL,
                _ => return None,
            };
            let from = -Vec3::from_array(step.map(|c| c as f32)).normalize();
            Some(Self { step, from, weight, halves: halves(from.dot(zenith)) })
        })
    }

    /// Which of [`LENGTHS`] its light goes in each cell.
    pub fn length_index(&self) -> usize {
        usize::from(squared_length(self.step) != 1)
    }

    /// Whether light that goes this way leaves a surface with this normal.
    pub fn leaves(&self, normal: Vec3) -> bool {
        normal.dot(self.from) < 0.0
    }
}

/// Light that arrives in each cell along a lattice direction, before the cell takes its own part. It takes the place of what is in the
/// cells, or is added to it; the border's cells stay as they are. Compiled for each width of vectors that machines have; one is chosen at
/// run time.
pub struct Carry<'a, const ADDED: bool> {
    /// The way that the light goes.
    pub direction: &'a Direction,
    /// Cells along each axis.
    pub size: UVec3,
    /// What a cell leaves of the light.
    pub through: &'a [f32],
    /// The light in each cell, x fastest.
    pub light: &'a mut [f32],
}

impl<const ADDED: bool> Carry<'_, ADDED> {
    /// Carries it.
    pub fn carry(self) {
        pulp::Arch::new().dispatch(self);
    }
}

impl<const ADDED: bool> pulp::NullaryFnOnce for Carry<'_, ADDED> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { direction: &Direction { step: d, .. }, size, through, light } = self;
        let [nx, ny, nz] = [size.x, size.y, size.z].map(|n| n as i32);
        let order = |n: i32, step: i32| (0..n).map(move |i| if step < 0 { n - 1 - i } else { i });
        for z in order(nz, d[2]) {
            for y in order(ny, d[1]) {
                let (fy, fz) = (y - d[1], z - d[2]);
                if !(0..ny).contains(&fy) || !(0..nz).contains(&fz) {
                    continue;
                }
                let width = nx as usize;
                let (here, from) = (width * (y + ny * z) as usize, width * (fy + ny * fz) as usize);
                if here == from {
                    for x in order(nx, d[0]) {
                        let fx = x - d[0];
                        if (0..nx).contains(&fx) {
                            let i = from + fx as usize;
                            let before = if ADDED { light[here + x as usize] } else { 0.0 };
                            light[here + x as usize] = before + light[i] * through[i];
                        }
                    }
                    continue;
                }
                let (to, source) = if here > from {
                    let (before, after) = light.split_at_mut(here);
                    (&mut after[..width], &before[from..from + width])
                } else {
                    let (before, after) = light.split_at_mut(from);
                    (&mut before[here..here + width], &after[..width])
                };
                let (first, count) = (d[0].max(0) as usize, width - d[0].unsigned_abs() as usize);
                let from_x = (-d[0]).max(0) as usize;
                let through = &through[from + from_x..][..count];
                for ((to, &light), &through) in
                    to[first..][..count].iter_mut().zip(&source[from_x..][..count]).zip(through)
                {
                    *to = if ADDED { *to } else { 0.0 } + light * through;
                }
            }
        }
    }
}

fn squared_length(d: [i32; 3]) -> i32 {
    d.iter().map(|c| c * c).sum()
}

/// The parts of the light from a direction of this height (-1..1) that count as from above and as from below. The halves of the sky meet at
/// the horizon, softly, so that a head that turns does not take its fourteen directions across it at once.
pub fn halves(height: f32) -> [f32; 2] {
    let above = 0.5 + height * (0.75 - 0.25 * height * height);
    [above, 1.0 - above]
}
