//! The head on the picture: which of each pixel's cells it covers, how deep, and how it is lit.

use glam::Vec3;
use nabiki::Mesh;
use rayon::prelude::*;

use crate::camera::{NEAR, View};
use crate::light::approx::exp_of_negative;
use crate::light::headlight::HeadShadow;
use crate::light::lamps::Lamp;
use crate::light::shade::DENSITY;
use crate::light::shadow::Crossings;
use crate::light::sky::SkyMap;
use crate::raster::{CELLS, TILE, cell_offset};
use crate::scalp::Scalp;
use crate::settings::{Projection, Sky};

/// Pieces of surface farther apart than this (cm) in one pixel are kept apart.
const APART: f32 = 0.4;
/// Cosine of the angle to a lamp from which on the angle itself is the shadow, not what else of the head is in the way.
const TERMINATOR: f32 = -0.1;

/// One piece of the head's surface in one pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkinPixel {
    /// Pixel within its tile, row after row.
    pub pixel: u16,
    /// Which of the pixel's cells it covers, a bit each.
    pub mask: u16,
    /// Depth at the pixel's centre (cm), and its growth by a pixel right and down.
    pub depth: f32,
    pub slope: [f32; 2],
    /// A place on it (head space, cm) and the unit normal there, on the eye's side.
    pub position: Vec3,
    pub normal: Vec3,
}

/// The head as one view sees it, tile by tile.
#[derive(Default)]
pub struct SkinView {
    pub pixels: Vec<SkinPixel>,
    starts: Vec<u32>,
    /// Depth behind which nothing shows in a tile: that of the skin where it covers all of it, else infinite.
    pub hidden_beyond: Vec<f32>,
}

struct Corner {
    at: [f32; 2],
    depth: f32,
}

impl SkinView {
    /// Draws the head (with unit normals at its vertices).
    pub fn new(head: &Mesh, normals: &[Vec3], view: &View) -> Self {
        let tiles = view.size.map(|s| (s as usize).div_ceil(TILE));
        let corners: Vec<Corner> = head
            .positions
            .par_iter()
            .map(|&p| {
                let p = view.project(p);
                Corner { at: [p.x, p.y], depth: p.z }
            })
            .collect();
        let mut lists = vec![Vec::new(); tiles[0] * tiles[1]];
        for (t, triangle) in head.triangles.iter().enumerate() {
            let c = triangle.map(|v| &corners[v as usize]);
            if c.iter().any(|c| c.depth < NEAR) {
                continue;
            }
            let span = |i: usize| {
                let low = c.iter().fold(f32::INFINITY, |m, c| m.min(c.at[i])) / TILE as f32;
                let high = c.iter().fold(f32::NEG_INFINITY, |m, c| m.max(c.at[i])) / TILE as f32;
                low.max(0.0) as usize..((high.max(-1.0) + 1.0) as usize).min(tiles[i])
            };
            for y in span(1) {
                for x in span(0) {
                    lists[y * tiles[0] + x].push(t as u32);
                }
            }
        }
        let drawn: Vec<(Vec<SkinPixel>, f32)> = lists
            .par_iter()
            .enumerate()
            .map(|(tile, list)| {
                if list.is_empty() {
                    return (Vec::new(), f32::INFINITY);
                }
                TileSurface::draw([tile % tiles[0], tile / tiles[0]], list, head, &corners, view)
                    .resolve(head, normals, &corners, view)
            })
            .collect();
        let mut all = Self::default();
        for (pixels, hidden_beyond) in drawn {
            all.starts.push(all.pixels.len() as u32);
            all.pixels.extend(pixels);
            all.hidden_beyond.push(hidden_beyond);
        }
        all.starts.push(all.pixels.len() as u32);
        all
    }

    /// Where the pieces of a tile lie in `pixels`.
    pub fn tile(&self, tile: usize) -> std::ops::Range<usize> {
        self.starts[tile] as usize..self.starts[tile + 1] as usize
    }
}

/// The nearest triangle in each cell of a tile.
struct TileSurface {
    tile: [usize; 2],
    depth: Vec<[f32; CELLS]>,
    triangle: Vec<[u32; CELLS]>,
}

const NONE: u32 = u32::MAX;

impl TileSurface {
    fn draw(tile: [usize; 2], list: &[u32], head: &Mesh, corners: &[Corner], view: &View) -> Self {
        let mut surface =
            Self { tile, depth: vec![[f32::INFINITY; CELLS]; TILE * TILE], triangle: vec![[NONE; CELLS]; TILE * TILE] };
        for &t in list {
            let c = head.triangles[t as usize].map(|v| &corners[v as usize]);
            let span = |i: usize| {
                let first = (tile[i] * TILE) as f32;
                let low = c.iter().fold(f32::INFINITY, |m, c| m.min(c.at[i])) - first;
                let high = c.iter().fold(f32::NEG_INFINITY, |m, c| m.max(c.at[i])) - first;
                low.max(0.0) as usize..((high.max(-1.0) + 1.0) as usize).min(TILE)
            };
            for y in span(1) {
                for x in span(0) {
                    for s in 0..CELLS {
                        let Some((_, depth)) = weights(c, surface.place(y * TILE + x, s), view) else { continue };
                        let pixel = y * TILE + x;
                        if depth < surface.depth[pixel][s] {
                            surface.depth[pixel][s] = depth;
                            surface.triangle[pixel][s] = t;
                        }
                    }
                }
            }
        }
        surface
    }

    fn place(&self, pixel: usize, cell: usize) -> [f32; 2] {
        let offset = cell_offset(cell);
        let corner = [self.tile[0] * TILE + pixel % TILE, self.tile[1] * TILE + pixel / TILE];
        [corner[0] as f32 + offset[0], corner[1] as f32 + offset[1]]
    }

    /// Gathers the cells of each pixel into one piece of surface, or two where an edge passes before something behind.
    fn resolve(self, head: &Mesh, normals: &[Vec3], corners: &[Corner], view: &View) -> (Vec<SkinPixel>, f32) {
        let mut pixels = Vec::new();
        let mut hidden_beyond = 0.0_f32;
        for pixel in 0..TILE * TILE {
            let (depth, triangle) = (&self.depth[pixel], &self.triangle[pixel]);
            let nearest = depth.iter().copied().fold(f32::INFINITY, f32::min);
            hidden_beyond = depth.iter().copied().fold(hidden_beyond, f32::max);
            let pick = |test: &dyn Fn(f32) -> bool| {
                (0..CELLS).filter(|&s| triangle[s] != NONE && test(depth[s])).fold(0_u16, |m, s| m | 1 << s)
            };
            for mask in [pick(&|d| d < nearest + APART), pick(&|d| d >= nearest + APART)] {
                if mask == 0 {
                    continue;
                }
                let cells = || (0..CELLS).filter(|s| mask >> s & 1 == 1);
                let count = cells().count() as f32;
                let middle = [0, 1].map(|i| cells().map(|s| cell_offset(s)[i]).sum::<f32>() / count);
                let off = |s: usize| (cell_offset(s)[0] - middle[0]).hypot(cell_offset(s)[1] - middle[1]);
                let cell = cells().min_by(|&a, &b| off(a).total_cmp(&off(b))).expect("mask is not empty");
                let t = head.triangles[triangle[cell] as usize];
                let c = t.map(|v| &corners[v as usize]);
                let place = self.place(pixel, cell);
                let Some((w, here)) = weights(c, place, view) else { continue };
                let blend =
                    |of: &[Vec3]| w[0] * of[t[0] as usize] + w[1] * of[t[1] as usize] + w[2] * of[t[2] as usize];
                let position = blend(&head.positions);
                let normal = blend(normals).normalize_or(Vec3::Y);
                // Interpolated normals lean a little away from the eye at outlines; farther, it is the inside of an open mesh.
                let normal = if normal.dot(view.toward_eye(position)) < -0.2 { -normal } else { normal };
                let slope = slope(c);
                let centre = [0, 1].map(|i| (self.tile[i] * TILE) as f32 + 0.5);
                let centre = [centre[0] + (pixel % TILE) as f32, centre[1] + (pixel / TILE) as f32];
                let depth = here + slope[0] * (centre[0] - place[0]) + slope[1] * (centre[1] - place[1]);
                pixels.push(SkinPixel { pixel: pixel as u16, mask, depth, slope, position, normal });
            }
        }
        (pixels, hidden_beyond)
    }
}

/// Weights of a triangle's corners at a place of the picture and the depth there, if it is inside.
fn weights(c: [&Corner; 3], p: [f32; 2], view: &View) -> Option<([f32; 3], f32)> {
    let cross = |a: &Corner, b: &Corner, p: [f32; 2]| {
        (b.at[0] - a.at[0]) * (p[1] - a.at[1]) - (b.at[1] - a.at[1]) * (p[0] - a.at[0])
    };
    let area = cross(c[0], c[1], c[2].at);
    let mut w = [cross(c[1], c[2], p) / area, cross(c[2], c[0], p) / area, cross(c[0], c[1], p) / area];
    if !w.iter().all(|w| *w >= 0.0) {
        return None;
    }
    if view.projection == Projection::Perspective {
        let over = [0, 1, 2].map(|i| w[i] / c[i].depth);
        let sum: f32 = over.iter().sum();
        w = over.map(|o| o / sum);
    }
    Some((w, w[0] * c[0].depth + w[1] * c[1].depth + w[2] * c[2].depth))
}

/// Growth of a triangle's depth by a pixel right and down; at most so steep that a pixel spans `APART`.
fn slope([a, b, c]: [&Corner; 3]) -> [f32; 2] {
    let (u, v) = ([b.at[0] - a.at[0], b.at[1] - a.at[1]], [c.at[0] - a.at[0], c.at[1] - a.at[1]]);
    let (du, dv) = (b.depth - a.depth, c.depth - a.depth);
    let area = u[0] * v[1] - u[1] * v[0];
    [(du * v[1] - dv * u[1]) / area, (dv * u[0] - du * v[0]) / area]
        .map(|s| if s.is_finite() { s.clamp(-APART, APART) } else { 0.0 })
}

/// How skin is lit.
pub struct SkinLight<'a> {
    pub look: &'a crate::settings::HeadLook,
    pub lamps: &'a [Lamp],
    /// Fibres in front of each place, for each lamp; the first place is receiver `first_receiver`.
    pub crossings: &'a [&'a Crossings],
    pub first_receiver: usize,
    pub sky: &'a Sky,
    pub sky_map: Option<&'a SkyMap>,
    /// Colour of bare skin (linear).
    pub skin: [f32; 3],
    /// Colour of a mass of the hair (linear), for what of it is too short to be drawn.
    pub hair: [f32; 3],
    /// The part of its light that a hair passes on forward: what is scattered by hair in the way reaches skin as well.
    pub passed: [f32; 3],
    /// What the head leaves of each lamp at each place; empty without shadows.
    pub unhidden: &'a [[f32; 3]],
    /// How much of each place is covered by hair too short to be drawn; empty without.
    pub stubble: &'a [f32],
    pub view: &'a View,
}

impl SkinLight<'_> {
    /// What the head leaves of each lamp at each place: it does not change while head and lamps stand still.
    pub fn unhidden(pixels: &[SkinPixel], lamps: &[Lamp], shadows: &[HeadShadow]) -> Vec<[f32; 3]> {
        let of = |p: &SkinPixel, lamp: &Lamp, shadow: &HeadShadow| {
            let matters = p.normal.dot(lamp.toward) > TERMINATOR;
            if matters { shadow.visible_from_skin(p.position, p.normal) } else { [1.0; 3] }
        };
        pixels
            .par_iter()
            .with_min_len(256)
            .flat_map_iter(|p| lamps.iter().zip(shadows).map(move |(lamp, shadow)| of(p, lamp, shadow)))
            .collect()
    }

    /// How much of each place hair too short to be drawn covers, 0..1, where `shade` square centimetres of it stand on each root.
    pub fn stubble(pixels: &[SkinPixel], scalp: &Scalp, shade: f32) -> Vec<f32> {
        let covered = |p: &SkinPixel| 1.0 - (-shade * scalp.density(p.position)).exp();
        if shade > 0.0 { pixels.par_iter().with_min_len(256).map(covered).collect() } else { Vec::new() }
    }

    /// Light toward the eye (linear) from place `i` on the skin.
    pub fn at(&self, i: usize, p: &SkinPixel) -> [f32; 3] {
        // Red light spreads farthest under skin.
        let soft = [1.25, 0.8, 0.6].map(|s| s * self.look.softness);
        let eye = self.view.toward_eye(p.position);
        let normal = p.normal;
        let mut diffuse = [0.0; 3];
        let mut sheen = [0.0; 3];
        for (l, lamp) in self.lamps.iter().enumerate() {
            let facing = normal.dot(lamp.toward);
            let hair = self.crossings.get(l).map_or([1.0; 3], |c| self.through(c.at(self.first_receiver + i)));
            let head = self.unhidden.get(i * self.lamps.len() + l).copied().unwrap_or([1.0; 3]);
            let sure = smooth((facing - TERMINATOR) / 0.3);
            let lit = [0, 1, 2].map(|c| hair[c] * (1.0 - sure * (1.0 - head[c])));
            let halfway = (lamp.toward + eye).normalize_or(eye);
            let gloss = 0.045 * 9.0 * normal.dot(halfway).max(0.0).powi(18) * smooth(facing / 0.25);
            let rim = (1.0 - eye.dot(normal).clamp(0.0, 1.0)).powi(4) * facing.max(0.0);
            for c in 0..3 {
                let wrapped = ((facing + soft[c]) / (1.0 + soft[c])).max(0.0);
                diffuse[c] += lamp.strength[c] * lit[c] * wrapped * wrapped;
                sheen[c] += lamp.strength[c] * lit[c] * (gloss + 0.5 * rim);
            }
        }
        let arriving = self.sky_map.map(|s| s.at(p.position + 0.9 * normal));
        let open = |part: f32| if part < 1.0 { self.through(-part.max(1e-6).ln()) } else { [1.0; 3] };
        let (open_above, open_below) = arriving.map_or(([1.0; 3], [1.0; 3]), |a| (open(a.above), open(a.below)));
        let up = 0.5 + 0.5 * normal.y;
        for (c, diffuse) in diffuse.iter_mut().enumerate() {
            let sky = self.sky.above[c] * up * open_above[c] + self.sky.below[c] * (1.0 - up) * open_below[c];
            *diffuse += self.sky.strength * sky;
        }
        let hair = self.stubble.get(i).copied().unwrap_or(0.0);
        std::array::from_fn(|c| {
            let bare = self.skin[c] * diffuse[c] + self.look.sheen * sheen[c];
            bare + (self.hair[c] * diffuse[c] - bare) * hair
        })
    }

    /// What arrives through hair that light crosses `n` times: unscattered, and scattered forward as among the hair itself.
    fn through(&self, n: f32) -> [f32; 3] {
        let straight = exp_of_negative(-n);
        self.passed.map(|p| straight + DENSITY * (exp_of_negative(-n * (1.0 - p).max(0.0)) - straight).max(0.0))
    }
}

fn smooth(x: f32) -> f32 {
    let x = x.clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}
