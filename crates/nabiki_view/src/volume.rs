//! How deep in hair every place lies, as lamps and sky see it: soft self-shadow for the view, worked out anew for every frame.
//!
//! Space is cut into cells that know how much hair they hold. Its depth, counted in hairs crossed, is carried through them
//! away from each lamp, slice by slice; shaders read it from a texture. The sky's cells are twice as wide.

mod sky_light;

use std::ops::Range;

use glam::{IVec3, UVec3, Vec3};
use half::f16;
use nabiki::{Ellipsoid, Mesh, Strands};
use nabiki_render::colour::of_strand;
use rayon::prelude::*;

pub use sky_light::{KINDS, SkyLight};
use sky_light::{Seen, SkinIn};

/// Lamps that throw shadows.
pub const LAMPS: usize = 4;
/// Edge of a cell (cm), and most cells before it grows.
const CELL: f32 = 0.7;
const MOST_CELLS: f32 = 220_000.0;
/// Most strands that are laid into cells, the first, each for as many as there are: more would fill the same cells.
const MOST_LAID: usize = 20_000;
/// Most hairs that one that stands for many is laid as, over the place of those.
const MOST_OF_LOCK: u32 = 8;
/// Bundles that these are laid in.
const BUNDLES: usize = 8;
/// Empty cells around the hair.
const BORDER: f32 = 2.0;
/// What skin takes of the sky's light in each full crossing of a cell, as the renderer has it.
const SKIN: f32 = 4.0;

/// What stands in the way of light.
pub struct Casting<'a> {
    /// The points of the strands now (head space, cm).
    pub points: &'a [Vec3],
    /// How they make strands.
    pub strands: &'a Strands,
    /// Thickness of a strand (cm), times how many of the whole hair it stands for.
    pub thickness: f32,
    /// How many strands of the whole hair each stands for.
    pub share: f32,
    /// Half of the room that the hairs of a lock take beside one another (cm).
    pub lock_half_width: f32,
    /// Unit vectors toward the lamps.
    pub lamps: &'a [Vec3],
    /// How bright each is (luminance).
    pub brightness: &'a [f32],
    /// Where the sky is above.
    pub zenith: Vec3,
    /// How bright it is there, and below (luminance).
    pub sky: [f32; 2],
    /// Unit vector from a place toward the eye.
    pub toward_eye: &'a (dyn Fn(Vec3) -> Vec3 + Sync),
    /// What of the head is in the way of lamps.
    pub ellipsoid: Ellipsoid,
    /// Whether anything throws a shadow at all.
    pub shadows: bool,
    /// Whether the sky is hidden by what lies before it.
    pub occlusion: bool,
}

impl Casting<'_> {
    /// Hairs that each of so many strands is laid as.
    fn hairs(&self, laid: usize) -> u32 {
        let wanted = self.share.max(1.0).round().min(MOST_OF_LOCK as f32) as u32;
        wanted.min((MOST_LAID / laid.max(1)) as u32).max(1)
    }

    /// To the side and outward, as far as the hairs of a lock lie from its middle: as hair.wgsl's `in_lock` has it.
    fn across_lock(&self, at: Vec3, way: Vec3, part: f32) -> [Vec3; 2] {
        if self.share <= 1.0 {
            return [Vec3::ZERO; 2];
        }
        let squared = self.ellipsoid.half_axes * self.ellipsoid.half_axes;
        let outward = ((at - self.ellipsoid.center) / squared).normalize_or(Vec3::Y);
        let aside = way.cross(outward).normalize_or(Vec3::X);
        let wide = self.lock_half_width * (1.0 - 0.45 * part);
        [wide * aside, 0.3 * wide * outward]
    }
}

/// Where a hair of a lock lies: to the side in -1..1, outward in 0..1.
fn place_in_lock(strand: u32, hair: u32) -> [f32; 2] {
    if hair == 0 {
        return [0.0; 2];
    }
    [2.0 * of_strand(strand, 10 + 2 * hair) - 1.0, of_strand(strand, 11 + 2 * hair)]
}

/// Cells about the hair.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Volume {
    /// Lowest corner (head space, cm).
    pub low: Vec3,
    /// Edge of a cell (cm).
    pub cell: f32,
    /// Cells along each axis; even, for the sky's are half as many.
    pub size: UVec3,
    /// Hairs between each cell and each lamp, x fastest.
    pub depth: Vec<[f16; LAMPS]>,
    /// Hairs met in a full crossing of each cell.
    pub hair: Vec<f16>,
    /// What arrives otherwise, in cells twice as wide.
    pub sky: SkyLight,
}

impl Volume {
    /// One of so many cells in which nothing stands in the way of light.
    pub fn empty(size: UVec3) -> Self {
        let cells = |size: UVec3| size.element_product() as usize;
        let (depth, sky) = (vec![[f16::ZERO; LAMPS]; cells(size)], SkyLight::open(cells(size / 2)));
        let hair = vec![f16::ZERO; cells(size)];
        Self { low: Vec3::ZERO, cell: 1.0, size, depth, hair, sky }
    }
}

/// Makes volumes; it remembers where the head's skin is.
#[derive(Debug, Default)]
pub struct VolumeMaker {
    skin: Vec<(IVec3, SkinIn)>,
    skin_of: Option<f32>,
}

/// What takes light, cell by cell.
struct Cells {
    size: UVec3,
    taken: Vec<f32>,
}

impl VolumeMaker {
    /// Forgets a head that is no longer the one.
    pub fn forget_head(&mut self) {
        self.skin_of = None;
    }

    /// The depths of hair before a head.
    pub fn make(&mut self, casting: &Casting, head: &Mesh) -> Volume {
        let nothing = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        let finite = |points: &[Vec3]| {
            points.iter().filter(|p| p.is_finite()).fold(nothing, |(low, high), &p| (low.min(p), high.max(p)))
        };
        let both = |(a, b): (Vec3, Vec3), (c, d): (Vec3, Vec3)| (a.min(c), b.max(d));
        let (low, high) = casting.points.par_chunks(1 << 14).map(finite).reduce(|| nothing, both);
        if low.x > high.x || !(casting.shadows || casting.occlusion) {
            return Volume::empty(UVec3::splat(2));
        }
        // Cells of a few sizes only, on a lattice that stands still: light that jumped with the hair would flicker.
        let mut cell = CELL;
        while ((high - low) / cell + 2.0 * BORDER).element_product() > MOST_CELLS {
            cell *= 1.25;
        }
        let wide = 2.0 * cell;
        let first = (low / wide - 1.0).floor();
        let low = first * wide;
        let half = ((high - low) / wide + 1.0).ceil().as_uvec3();
        let size = 2 * half;

        let mut hair = Cells { size, taken: vec![0.0; size.element_product() as usize] };
        hair.lay(casting, low, cell);

        let mut depth = vec![[f16::ZERO; LAMPS]; hair.taken.len()];
        if casting.shadows {
            let lamps = casting.lamps.get(..LAMPS).unwrap_or(casting.lamps);
            let depths: Vec<_> = lamps.par_iter().map(|&toward| hair.depth(toward, 0.5)).collect();
            for (l, of_lamp) in depths.iter().enumerate() {
                depth.iter_mut().zip(of_lamp).for_each(|(depth, &n)| depth[l] = f16::from_f32(n));
            }
        }
        let wide_hair = hair.twice_as_wide();
        let held = hair.taken.par_iter().with_min_len(4096).map(|&taken| f16::from_f32(taken)).collect();
        let mut volume = Volume { low, cell, size, depth, hair: held, sky: SkyLight::default() };
        volume.sky = if casting.occlusion {
            if self.skin_of != Some(wide) {
                self.skin = skin_cells(head, wide);
                self.skin_of = Some(wide);
            }
            let within = |(at, skin): &(IVec3, SkinIn)| {
                let c = *at - first.as_ivec3();
                let within = c.cmpge(IVec3::ZERO).all() && c.cmplt(half.as_ivec3()).all();
                within.then(|| SkinIn { at: wide_hair.index(c.as_uvec3()), ..*skin })
            };
            let skin: Vec<SkinIn> = self.skin.iter().filter_map(within).collect();
            let cells = sky_light::Cells { low, edge: wide, size: half, hair: &wide_hair.taken, skin: &skin };
            let lit = |skin: &SkinIn, open: [f32; 2]| volume.falls_onto(casting, skin, open);
            let Casting { zenith, lamps, toward_eye, .. } = *casting;
            SkyLight::new(&cells, &Seen { zenith, lamps, toward_eye, lit: &lit })
        } else {
            SkyLight::open(wide_hair.taken.len())
        };
        volume
    }
}

impl Volume {
    /// The light that falls onto skin, of lamps through hair and past the head, and of the sky of which these shares arrive (luminance).
    fn falls_onto(&self, casting: &Casting, skin: &SkinIn, open: [f32; 2]) -> f32 {
        let depth = self.depth_at(skin.place + 0.5 * skin.normal);
        let of_lamp = |(l, (toward, brightness)): (usize, (&Vec3, &f32))| {
            let facing = skin.normal.dot(*toward).max(0.0);
            let hair = if l < LAMPS { (-depth[l].to_f32()).exp() } else { 1.0 };
            let head = if casting.shadows {
                past_head(&casting.ellipsoid, skin.place + 0.3 * skin.normal, *toward)
            } else {
                1.0
            };
            facing * brightness * hair * head
        };
        let up = 0.5 + 0.5 * skin.normal.dot(casting.zenith);
        let lamps: f32 = casting.lamps.iter().zip(casting.brightness).enumerate().map(of_lamp).sum();
        lamps + casting.sky[0] * up * open[0] + casting.sky[1] * (1.0 - up) * open[1]
    }

    /// Hairs between a place and each lamp, as the cell it lies in has them, or the nearest one.
    fn depth_at(&self, place: Vec3) -> [f16; LAMPS] {
        let c = ((place - self.low) / self.cell).clamp(Vec3::ZERO, self.size.as_vec3() - 1.0).as_uvec3();
        self.depth[(c.x + self.size.x * (c.y + self.size.y * c.z)) as usize]
    }
}

/// What the head leaves of a lamp at a place: common.wgsl's `past_head`.
fn past_head(head: &Ellipsoid, place: Vec3, toward: Vec3) -> f32 {
    let (q, d) = ((place - head.center) / head.half_axes, toward / head.half_axes);
    let t = -q.dot(d) / d.dot(d);
    let part = (((q + d * t).length() - 0.82) / 0.18).clamp(0.0, 1.0);
    if t <= 0.0 { 1.0 } else { part * part * (3.0 - 2.0 * part) }
}

impl Cells {
    fn index(&self, c: UVec3) -> usize {
        (c.x + self.size.x * (c.y + self.size.y * c.z)) as usize
    }

    /// Optical depth per crossing: the hair's projected area over the cell's face, averaged over directions (pi / 4). Bundles of strands are laid
    /// side by side, as many whatever the cores, so that sums have the same bits.
    fn lay(&mut self, casting: &Casting, low: Vec3, cell: f32) {
        let per_length = casting.thickness * std::f32::consts::FRAC_PI_4 / (cell * cell);
        let laid = casting.strands.len().min(MOST_LAID);
        let per_length = per_length * casting.strands.len() as f32 / laid.max(1) as f32;
        let of_bundle = |bundle: usize| {
            let mut cells = Self { size: self.size, taken: vec![0.0; self.taken.len()] };
            cells.lay_strands(casting, laid * bundle / BUNDLES..laid * (bundle + 1) / BUNDLES, low, cell, per_length);
            cells
        };
        let bundles: Vec<Self> = (0..BUNDLES).into_par_iter().map(of_bundle).collect();
        self.taken.par_iter_mut().with_min_len(4096).enumerate().for_each(|(i, taken)| {
            *taken = bundles.iter().map(|bundle| bundle.taken[i]).sum();
        });
    }

    fn lay_strands(&mut self, casting: &Casting, strands: Range<usize>, low: Vec3, cell: f32, per_length: f32) {
        let hairs = casting.hairs(casting.strands.len().min(MOST_LAID));
        for s in strands {
            let points = &casting.points[casting.strands.range(s)];
            let last = points.len().max(2) - 1;
            for (n, pair) in points.windows(2).enumerate() {
                let way = pair[1] - pair[0];
                if !way.is_finite() {
                    continue;
                }
                let pieces = (way.length() / cell).ceil().clamp(1.0, 8.0) as usize;
                let amount = per_length * way.length() / (pieces as u32 * hairs) as f32;
                for k in 0..pieces {
                    let u = (k as f32 + 0.5) / pieces as f32;
                    let at = pair[0] + way * u;
                    let part = (n as f32 + u) / last as f32;
                    let [aside, outward] = casting.across_lock(at, way, part);
                    for hair in 0..hairs {
                        let [x, y] = place_in_lock(s as u32, hair);
                        self.put(amount, ((at + x * aside + y * outward) - low) / cell - 0.5);
                    }
                }
            }
        }
    }

    /// An amount, shared by the eight cells about a place (in cells).
    fn put(&mut self, amount: f32, place: Vec3) {
        let (row, slice) = (self.size.x as usize, (self.size.x * self.size.y) as usize);
        // Hair of a lock may lie beyond the border.
        let place = place.clamp(Vec3::ZERO, self.size.as_vec3() - 1.01);
        let base = place.as_uvec3();
        let f = place - base.as_vec3();
        let at = self.index(base);
        for (z, wz) in [(0, 1.0 - f.z), (slice, f.z)] {
            for (y, wy) in [(0, 1.0 - f.y), (row, f.y)] {
                self.taken[at + z + y] += amount * wz * wy * (1.0 - f.x);
                self.taken[at + z + y + 1] += amount * wz * wy * f.x;
            }
        }
    }

    /// Hairs between each cell and what lies endlessly far `toward` (unit); of its own cell `own` counts.
    fn depth(&self, toward: Vec3, own: f32) -> Vec<f32> {
        let size = self.size.as_ivec3();
        let axis = toward.abs().max_position();
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let step = toward / toward[axis].abs();
        let ahead = step[axis].signum() as i32;
        let length = step.length();
        let stride = [1, size.x, size.x * size.y];
        let mut depth = vec![0.0_f32; self.taken.len()];
        let (du, dv) = (step[u].floor() as i32, step[v].floor() as i32);
        let (fu, fv) = (step[u] - step[u].floor(), step[v] - step[v].floor());
        let weights =
            [((1.0 - fu) * (1.0 - fv), 0, 0), (fu * (1.0 - fv), 1, 0), ((1.0 - fu) * fv, 0, 1), (fu * fv, 1, 1)];
        let slices = size[axis];
        for k in 0..slices {
            let slice = if ahead > 0 { slices - 1 - k } else { k };
            let from = slice + ahead;
            let within = (0..slices).contains(&from);
            for b in 0..size[v] {
                for a in 0..size[u] {
                    let i = (slice * stride[axis] + a * stride[u] + b * stride[v]) as usize;
                    let mut sum = 0.0;
                    if within {
                        for (weight, ou, ov) in weights {
                            let (a, b) = (a + du + ou, b + dv + ov);
                            if weight > 0.0 && a >= 0 && a < size[u] && b >= 0 && b < size[v] {
                                let j = (from * stride[axis] + a * stride[u] + b * stride[v]) as usize;
                                sum += weight * (depth[j] + (1.0 - own) * length * self.taken[j]);
                            }
                        }
                    }
                    depth[i] = sum + own * length * self.taken[i];
                }
            }
        }
        depth
    }

    /// The same in cells twice as wide.
    fn twice_as_wide(&self) -> Self {
        let half = self.size / 2;
        let mut wide = Self { size: half, taken: vec![0.0; half.element_product() as usize] };
        for z in 0..self.size.z {
            for y in 0..self.size.y {
                for x in 0..self.size.x {
                    let at = UVec3::new(x, y, z);
                    let to = wide.index(at / 2);
                    // Eight cells lie two behind one another in four columns.
                    wide.taken[to] += 0.25 * self.taken[self.index(at)];
                }
            }
        }
        wide
    }
}

/// Cells of edge `cell` that the head's surface passes through, by their place on the lattice through the origin, each with
/// the skin in it.
fn skin_cells(head: &Mesh, cell: f32) -> Vec<(IVec3, SkinIn)> {
    let mut shares: Vec<([i32; 3], f32, Vec3, Vec3)> = Vec::new();
    for triangle in &head.triangles {
        let [a, b, c] = triangle.map(|v| head.positions[v as usize]);
        let across = (b - a).cross(c - a);
        let area = 0.5 * across.length();
        let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
        let steps = (2.0 * longest / cell).ceil().clamp(1.0, 64.0) as usize;
        let share = area / (steps * steps) as f32 / (cell * cell);
        for i in 0..steps * steps {
            let (mut u, mut v) = (((i % steps) as f32 + 0.5) / steps as f32, ((i / steps) as f32 + 0.5) / steps as f32);
            if u + v > 1.0 {
                (u, v) = (1.0 - u, 1.0 - v);
            }
            let place = a + (b - a) * u + (c - a) * v;
            let lattice = (place / cell).floor().as_ivec3().to_array();
            shares.push((lattice, share, share * place, share * across.normalize_or_zero()));
        }
    }
    shares.sort_by_key(|share| share.0);
    let skin = |of: &[([i32; 3], f32, Vec3, Vec3)]| {
        let marked: f32 = of.iter().map(|share| share.1).sum();
        let place = of.iter().map(|share| share.2).sum::<Vec3>() / marked.max(1e-12);
        let normal = of.iter().map(|share| share.3).sum::<Vec3>().normalize_or_zero();
        (IVec3::from(of[0].0), SkinIn { at: 0, taken: SKIN * marked.min(1.5), normal, place })
    };
    shares.chunk_by(|a, b| a.0 == b.0).map(skin).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square mat of straight hairs at height 0, `spacing` cm apart.
    fn mat(spacing: f32) -> Strands {
        let mut strands = Strands::default();
        let count = (20.0 / spacing) as i32;
        for i in 0..count {
            let z = (i as f32 + 0.5) * spacing - 10.0;
            strands.push((0..=20).map(|k| Vec3::new(k as f32 - 10.0, 0.0, z)));
        }
        strands
    }

    fn cast(strands: &Strands, thickness: f32, share: f32, lamps: &[Vec3]) -> Volume {
        let casting = Casting {
            points: strands.points(),
            strands,
            thickness,
            share,
            lock_half_width: 0.5,
            lamps,
            brightness: &[1.0; 2],
            zenith: Vec3::Y,
            sky: [1.0; 2],
            toward_eye: &|_| Vec3::Z,
            ellipsoid: Ellipsoid { center: Vec3::ZERO, half_axes: Vec3::splat(1e-3) },
            shadows: true,
            occlusion: true,
        };
        VolumeMaker::default().make(&casting, &Mesh::default())
    }

    /// Hairs between a place and a lamp.
    fn depth_at(volume: &Volume, place: Vec3, lamp: usize) -> f32 {
        volume.depth_at(place)[lamp].to_f32()
    }

    #[test]
    fn hair_is_crossed_once_from_either_side_and_nothing_above_it() {
        let (spacing, thickness) = (0.1, 0.02);
        let volume = cast(&mat(spacing), thickness, 1.0, &[Vec3::Y, -Vec3::Y]);
        // The mean over directions: pi / 4 of the thickness over the spacing.
        let whole = std::f32::consts::FRAC_PI_4 * thickness / spacing;
        // Beside the middle of the mat, where no rim is near. Pieces of half a centimetre on cells of 0.7 beat by a twentieth.
        let (below, above) = (Vec3::new(0.3, -1.4, 0.2), Vec3::new(0.3, 1.4, 0.2));
        assert!((depth_at(&volume, below, 0) - whole).abs() < 0.05 * whole, "{}", depth_at(&volume, below, 0));
        assert!((depth_at(&volume, above, 1) - whole).abs() < 0.05 * whole);
        assert!(depth_at(&volume, above, 0) < 0.05 * whole && depth_at(&volume, below, 1) < 0.05 * whole);
    }

    #[test]
    fn few_strands_that_stand_for_many_throw_the_shadow_of_all() {
        let lamp = [Vec3::new(0.3, 0.9, 0.2).normalize()];
        let all = cast(&mat(0.05), 0.02, 1.0, &lamp);
        let few = cast(&mat(1.0), 0.02 * 20.0, 20.0, &lamp);
        let mean = |volume: &Volume| {
            let places = (0..64).map(|i| Vec3::new((i % 8) as f32 - 3.5, -2.0, (i / 8) as f32 - 3.5));
            places.map(|p| depth_at(volume, p, 0)).sum::<f32>() / 64.0
        };
        // The lattice of 1 cm hairs on 0.7 cm cells beats by a part of a hair in seven.
        assert!((mean(&all) / mean(&few) - 1.0).abs() < 0.15, "{} {}", mean(&all), mean(&few));
    }

    #[test]
    fn the_sky_is_closed_below_a_mat_and_open_beside_none() {
        let mut layers = Strands::default();
        for y in 0..8 {
            for strand in mat(0.1).iter() {
                layers.push(strand.iter().map(|p| *p + Vec3::Y * (0.7 * y as f32)));
            }
        }
        let volume = cast(&layers, 0.06, 1.0, &[]);
        let half = volume.size / 2;
        let at = |p: Vec3| {
            let c = ((p - volume.low) / (2.0 * volume.cell)).as_uvec3();
            volume.sky.0[4][(c.x + half.x * (c.y + half.y * c.z)) as usize][0].to_f32()
        };
        let (within, top) = (at(Vec3::new(0.0, 0.1, 0.0)), at(Vec3::new(0.0, 6.2, 0.0)));
        assert!(within < 0.5 * top && top > 0.6, "{within} {top}");
        let none = cast(&Strands::default(), 0.06, 1.0, &[Vec3::Y]);
        assert_eq!((depth_at(&none, Vec3::ZERO, 0), none.sky.0[4][0][0]), (0.0, f16::ONE));
    }
}
