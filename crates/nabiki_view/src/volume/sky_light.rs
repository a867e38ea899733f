//! What arrives of the sky, and of the light that skin sends back, at every place among the hair: by the renderer's own way from cell to
//! cell (its light/sky.rs), in fewer and larger cells.

use glam::{UVec3, Vec3};
use half::f16;
use nabiki_render::live::{Carry, Direction, LENGTHS};
use rayon::prelude::*;

use super::LAMPS;

/// How many numbers of each cell lie side by side.
const FOUR: usize = 4;
/// And how often there are four of them.
pub const KINDS: usize = 5;
/// Edge of the renderer's cells (cm): what lies in a cell hides some of it from the rest, and larger cells would hide more.
const FINE: f32 = 0.55;
/// Where it is not known how open it is about a lamp.
const UNKNOWN: f32 = 2.0;

type Numbers = Vec<[f16; FOUR]>;

/// Numbers of each cell, x fastest, in the order in which shaders have them:
/// the sky's light from above and from below on the eye's side, and the same from behind;
/// skin's light on the eye's side and from behind, and both sides' sky as it was without hair;
/// how open it is about each lamp, and about what lies opposite;
/// the share of the sky above and of that below that arrives, and the light that skin sends to skin, times its weight, and that weight.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SkyLight(pub [Numbers; KINDS]);

/// A cell that skin passes through.
#[derive(Clone, Copy, Debug)]
pub struct SkinIn {
    /// Its number.
    pub at: usize,
    /// What skin takes in each full crossing of it.
    pub taken: f32,
    /// Unit, outward.
    pub normal: Vec3,
    /// The mean place of its skin (head space, cm).
    pub place: Vec3,
}

/// Cells about the hair.
pub struct Cells<'a> {
    /// Lowest corner (head space, cm), edge of a cell, and cells along each axis.
    pub low: Vec3,
    pub edge: f32,
    pub size: UVec3,
    /// What hair takes in a full crossing.
    pub hair: &'a [f32],
    pub skin: &'a [SkinIn],
}

/// Who looks, and what shines.
pub struct Seen<'a> {
    /// Where the sky is above.
    pub zenith: Vec3,
    /// Unit vectors toward the lamps.
    pub lamps: &'a [Vec3],
    /// Unit vector from a place toward the eye.
    pub toward_eye: &'a (dyn Fn(Vec3) -> Vec3 + Sync),
    /// The light that falls onto skin, given the shares of the sky above and below that arrive there.
    pub lit: &'a (dyn Fn(&SkinIn, [f32; 2]) -> f32 + Sync),
}

impl SkyLight {
    /// That of so many cells where nothing is in the way.
    pub fn open(cells: usize) -> Self {
        let all = |numbers: [f32; FOUR]| vec![numbers.map(f16::from_f32); cells];
        Self([all([0.5; 4]), all([0.0, 0.0, 1.0, 1.0]), all([UNKNOWN; 4]), all([0.0; 4]), all([1.0, 1.0, 0.0, 0.0])])
    }

    /// Carries light past hair and skin.
    pub fn new(cells: &Cells<'_>, seen: &Seen<'_>) -> Self {
        let count = cells.hair.len();
        let mut of_skin = vec![0.0; count];
        cells.skin.iter().for_each(|skin| of_skin[skin.at] += skin.taken);
        let taken: Vec<f32> = cells.hair.iter().zip(&of_skin).map(|(hair, skin)| hair + skin).collect();
        let leaves =
            |taken: &[f32]| LENGTHS.map(|length| taken.iter().map(|t| (-t * length).exp()).collect::<Vec<_>>());
        let [through, through_skin] = [leaves(&taken), leaves(&of_skin)];
        let directions: Vec<Direction> = Direction::all(seen.zenith).collect();
        let carry = |direction: &Direction, through: &[Vec<f32>; 2]| {
            let mut light = vec![1.0; count];
            let through = &through[direction.length_index()];
            Carry::<false> { direction, size: cells.size, through, light: &mut light }.carry();
            light
        };
        let carried: Vec<[Vec<f32>; 2]> =
            directions.par_iter().map(|d| [carry(d, &through), carry(d, &through_skin)]).collect();
        let open = |i: usize| {
            let sum =
                |half: usize| directions.iter().zip(&carried).map(move |(d, of)| d.weight * d.halves[half] * of[0][i]);
            // Each half of the sky is half of all.
            [0, 1].map(|half| 2.0 * sum(half).sum::<f32>())
        };
        let lit: Vec<f32> = cells
            .skin
            .par_iter()
            .map(|skin| {
                // Above the cell that the skin itself fills.
                let above = cells.index_at(skin.place + 0.9 * skin.normal);
                (seen.lit)(skin, open(above)) * (-cells.hair[skin.at] * FINE / cells.edge).exp()
            })
            .collect();
        let glow: Vec<Vec<f32>> = directions
            .par_iter()
            .map(|direction| {
                let through = &through[direction.length_index()];
                let mut glow = vec![0.0; count];
                for (skin, lit) in cells.skin.iter().zip(&lit) {
                    if direction.leaves(skin.normal) {
                        let sent = lit * (1.0 - through[skin.at]) * (skin.taken / taken[skin.at]).min(1.0);
                        glow[skin.at] += sent;
                        if let Some(next) = cells.next(skin.at, direction.step) {
                            glow[next] += sent;
                        }
                    }
                }
                Carry::<true> { direction, size: cells.size, through, light: &mut glow }.carry();
                glow
            })
            .collect();
        let about_lamps: Vec<Vec<f32>> = [1.0, -1.0]
            .into_iter()
            .flat_map(|side| seen.lamps.iter().take(LAMPS).map(move |lamp| side * *lamp))
            .map(|toward| {
                let shares: Vec<f32> =
                    directions.iter().map(|d| d.weight * d.from.dot(toward).max(0.0).powi(2)).collect();
                let all: f32 = shares.iter().sum();
                shares.into_iter().map(|share| share / all).collect()
            })
            .collect();
        let lamps = about_lamps.len() / 2;
        let own = FINE / cells.edge;
        let of_cell = |i: usize| {
            let eye = (seen.toward_eye)(cells.middle(i));
            let mut sums = [0.0_f32; 8];
            for ((d, [light, bare]), glow) in directions.iter().zip(&carried).zip(&glow) {
                let aside = eye.dot(d.from);
                // Each of mean 1 over all directions. What passes through a fibre goes on nearly straight.
                let (before, after) = (1.0 + aside, (1.0 - aside).powi(4) / 3.2);
                let [above, below] = d.halves.map(|half| d.weight * half * light[i]);
                let (glow, bare) = (d.weight * glow[i], d.weight * bare[i]);
                for (sum, part) in sums.iter_mut().zip([
                    above * before,
                    below * before,
                    above * after,
                    below * after,
                    glow * before,
                    glow * after,
                    bare * before,
                    bare * after,
                ]) {
                    *sum += part;
                }
            }
            // What the eye sees of a cell lies on its near side: what comes from behind has to cross it.
            let behind = (-own * taken[i]).exp();
            let [fa, fb, ba, bb, fg, bg, fs, bs] = sums;
            let about = |lamp: usize| {
                let open =
                    directions.iter().zip(&carried).enumerate().map(|(n, (_, of))| about_lamps[lamp][n] * of[0][i]);
                open.sum::<f32>()
            };
            let mut toward = [UNKNOWN; LAMPS];
            let mut opposite = [0.0; LAMPS];
            for lamp in 0..lamps {
                (toward[lamp], opposite[lamp]) = (about(lamp), about(lamps + lamp));
            }
            let [above, below] = open(i);
            [
                [fa, fb, ba * behind, bb * behind],
                [fg, bg * (-own * cells.hair[i]).exp(), fs, bs * (-own * of_skin[i]).exp()],
                toward,
                opposite,
                [above, below, 0.0, 0.0],
            ]
            .map(|numbers| numbers.map(f16::from_f32))
        };
        let all: Vec<[[f16; FOUR]; KINDS]> = (0..count).into_par_iter().with_min_len(512).map(of_cell).collect();
        let mut light: [Numbers; KINDS] = std::array::from_fn(|kind| all.iter().map(|of| of[kind]).collect());
        for skin in cells.skin {
            let parts = directions
                .iter()
                .zip(&glow)
                .map(|(d, glow)| (d.weight * d.from.dot(skin.normal).max(0.0), glow[skin.at]));
            let (sum, all) = parts.fold((0.0, 1e-6), |(sum, all), (part, glow)| (sum + part * glow, all + part));
            let numbers = &mut light[4][skin.at];
            (numbers[2], numbers[3]) = (f16::from_f32(sum / all), f16::ONE);
        }
        Self(light)
    }
}

impl Cells<'_> {
    fn coordinates(&self, i: usize) -> UVec3 {
        let [x, y] = [self.size.x as usize, self.size.y as usize];
        UVec3::new((i % x) as u32, (i / x % y) as u32, (i / (x * y)) as u32)
    }

    fn middle(&self, i: usize) -> Vec3 {
        self.low + self.edge * (self.coordinates(i).as_vec3() + 0.5)
    }

    /// The cell of a place, or the nearest.
    fn index_at(&self, place: Vec3) -> usize {
        let c = ((place - self.low) / self.edge).clamp(Vec3::ZERO, self.size.as_vec3() - 1.0).as_uvec3();
        (c.x + self.size.x * (c.y + self.size.y * c.z)) as usize
    }

    fn next(&self, i: usize, step: [i32; 3]) -> Option<usize> {
        let next = self.coordinates(i).as_ivec3() + glam::IVec3::from(step);
        let within = next.cmpge(glam::IVec3::ZERO).all() && next.cmplt(self.size.as_ivec3()).all();
        within.then(|| {
            let next = next.as_uvec3();
            (next.x + self.size.x * (next.y + self.size.y * next.z)) as usize
        })
    }
}
