//! The surface of head and bodies in pixels: which of their cells it covers, and how deep.
//!
//! While the shutter is open each cell of a pixel sees them at a moment of its own. Neighbouring pixels share the
//! moments, so an edge that moves fades over its way in as many steps as a pixel has cells. What lies between edges is told
//! apart at as many moments as it moves pixels.

use glam::Vec3;
use rayon::prelude::*;

use super::solids::Solids;
use crate::camera::{NEAR, View};
use crate::raster::{CELLS, SIDE, TILE, cell_offset};
use crate::settings::Projection;
use crate::shutter::Shot;

/// Pieces of surface farther apart than this (cm) in one pixel are kept apart.
const APART: f32 = 0.4;
/// How far surface may move on the picture (pixels) between the moments that one pixel tells apart.
const STEP: f32 = 1.5;

/// One piece of surface in one pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkinPixel {
    /// Pixel within its tile, row after row.
    pub pixel: u16,
    /// Which of the pixel's cells it covers, a bit each.
    pub mask: u16,
    /// The head, 0, or a body.
    pub solid: u16,
    /// Depth at the pixel's centre (cm), and its growth by a pixel right and down.
    pub depth: f32,
    pub slope: [f32; 2],
    /// A place on it (head space, cm) and the unit normal there, on the eye's side.
    pub position: Vec3,
    pub normal: Vec3,
}

/// Head and bodies as one view sees them, tile by tile.
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

/// Head and bodies at one moment, and the cells that see it then, a bit each.
struct Seen {
    view: View,
    cells: u16,
    corners: Vec<Corner>,
    /// The triangles within each tile.
    lists: Vec<Vec<u32>>,
}

impl Seen {
    fn new(solids: &Solids, positions: &[Vec3], view: View, cells: u16) -> Self {
        let tiles = view.size.map(|s| (s as usize).div_ceil(TILE));
        let corners: Vec<Corner> = positions
            .par_iter()
            .map(|&p| {
                let p = view.project(p);
                Corner { at: [p.x, p.y], depth: p.z }
            })
            .collect();
        let mut lists = vec![Vec::new(); tiles[0] * tiles[1]];
        for (t, triangle) in solids.triangles.iter().enumerate() {
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
        Self { view, cells, corners, lists }
    }

    /// Head and bodies while the shutter is open: once for all cells, or at as many moments as there are cells.
    fn all(solids: &Solids, middle: &[Vec3], shot: &Shot) -> Vec<Self> {
        match &shot.between {
            None => vec![Self::new(solids, middle, shot.middle, u16::MAX)],
            Some(views) => (0..CELLS)
                .into_par_iter()
                .map(|moment| {
                    let cells = (0..CELLS).filter(|&cell| moment_of(cell) == moment).fold(0, |m, cell| m | 1 << cell);
                    let positions = solids.positions(shot.bodies.iter().map(|body| body.between[moment]));
                    Self::new(solids, &positions, views[moment], cells)
                })
                .collect(),
        }
    }
}

/// At which of the moments a cell looks: a Graeco-Latin square, so that each row, each column and each fourth of the time has cells
/// spread over all of the pixel.
fn moment_of(cell: usize) -> usize {
    const TWICE: [usize; SIDE] = [0, 2, 3, 1];
    let (x, y) = (cell % SIDE, cell / SIDE);
    SIDE * (x ^ y) + (TWICE[x] ^ y)
}

/// The cells that look, and one of them for each.
#[derive(Clone, Copy)]
struct Looking {
    cells: u16,
    /// Which of each square of four looks, if not each does.
    of_four: Option<usize>,
}

impl Looking {
    const ALL: Self = Self { cells: u16::MAX, of_four: None };

    /// One of each square of four, in the order of `turn`.
    fn quarter(turn: usize) -> Self {
        let of_four = [0, 3, 1, 2][turn % 4];
        let looks = |&cell: &usize| cell % SIDE % 2 == of_four % 2 && cell / SIDE % 2 == of_four / 2;
        Self { cells: (0..CELLS).filter(looks).fold(0, |m, cell| m | 1 << cell), of_four: Some(of_four) }
    }

    /// The cell that looks for this one.
    fn instead_of(self, cell: usize) -> usize {
        let (x, y) = (cell % SIDE, cell / SIDE);
        self.of_four.map_or(cell, |n| (2 * (y / 2) + n / 2) * SIDE + 2 * (x / 2) + n % 2)
    }
}

impl SkinView {
    /// Draws head and bodies.
    pub fn new(solids: &Solids, shot: &Shot) -> Self {
        Self::looking(solids, shot, Looking::ALL)
    }

    /// The same for one of many pictures of which the mean is taken: one cell of each square of four looks for all of them, another at
    /// each `turn`. While something moves all look, each at its own moment.
    pub fn in_turn(solids: &Solids, shot: &Shot, turn: usize) -> Self {
        let looking = if shot.between.is_some() { Looking::ALL } else { Looking::quarter(turn) };
        Self::looking(solids, shot, looking)
    }

    fn looking(solids: &Solids, shot: &Shot, looking: Looking) -> Self {
        let tiles = shot.middle.size.map(|s| (s as usize).div_ceil(TILE));
        let halfway = || shot.bodies.iter().map(|body| body.middle);
        let surface = Surface { solids, positions: solids.positions(halfway()), normals: solids.normals(halfway()) };
        let seen = Seen::all(solids, &surface.positions, shot);
        let drawn: Vec<(Vec<SkinPixel>, f32)> = (0..tiles[0] * tiles[1])
            .into_par_iter()
            .map(|tile| {
                if seen.iter().all(|seen| seen.lists[tile].is_empty()) {
                    return (Vec::new(), f32::INFINITY);
                }
                let groups = groups(movement(solids, &seen, tile));
                TileSurface::draw([tile % tiles[0], tile / tiles[0]], tile, solids, &seen, looking)
                    .resolve(&surface, &seen, &groups)
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

    /// The same, where nothing counts as hidden that may show to who looks from so far aside that what lies behind moves by `beside`
    /// pixels against the surface.
    pub fn seen_from_beside(mut self, beside: f32, size: [u32; 2]) -> Self {
        if beside == 0.0 {
            return self;
        }
        let [across, down] = size.map(|s| (s as usize).div_ceil(TILE));
        let about = (beside / TILE as f32).ceil() as usize;
        let farthest = |step: usize, count: usize, of: &dyn Fn(usize) -> f32| {
            let whole = step >= about && step + about < count;
            // Beyond the picture nothing is known to hide.
            if whole { (step - about..=step + about).map(of).fold(0.0, f32::max) } else { f32::INFINITY }
        };
        for axis in [0, 1] {
            let before = self.hidden_beyond.clone();
            for (tile, hidden) in self.hidden_beyond.iter_mut().enumerate() {
                let (x, y) = (tile % across, tile / across);
                *hidden = match axis {
                    0 => farthest(x, across, &|x| before[y * across + x]),
                    _ => farthest(y, down, &|y| before[y * across + x]),
                };
            }
        }
        self
    }

    /// Where the pieces of a tile lie in `pixels`.
    pub fn tile(&self, tile: usize) -> std::ops::Range<usize> {
        self.starts[tile] as usize..self.starts[tile + 1] as usize
    }
}

/// The farthest that the surface in a tile moves between the first moment and the last (pixels).
fn movement(solids: &Solids, seen: &[Seen], tile: usize) -> f32 {
    let [first, .., last] = seen else { return 0.0 };
    let of_corner = |v: u32| {
        let (a, b) = (&first.corners[v as usize], &last.corners[v as usize]);
        (b.at[0] - a.at[0]).hypot(b.at[1] - a.at[1])
    };
    let triangles = [first, &seen[seen.len() / 2], last].into_iter().flat_map(|seen| &seen.lists[tile]);
    triangles.flat_map(|&t| solids.triangles[t as usize].map(of_corner)).fold(0.0, f32::max)
}

/// The cells that share a piece of surface, a bit each, where it moves so far (pixels).
fn groups(movement: f32) -> Vec<u16> {
    let count = ((movement / STEP).ceil().clamp(1.0, CELLS as f32) as usize).next_power_of_two();
    let mut groups = vec![0; count];
    for cell in 0..CELLS {
        groups[moment_of(cell) * count / CELLS] |= 1 << cell;
    }
    groups
}

/// Head and bodies halfway through (head space, cm).
struct Surface<'a> {
    solids: &'a Solids,
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
}

/// The nearest triangle in each cell of a tile.
struct TileSurface {
    tile: [usize; 2],
    looking: Looking,
    depth: Vec<[f32; CELLS]>,
    triangle: Vec<[u32; CELLS]>,
}

const NONE: u32 = u32::MAX;

impl TileSurface {
    fn draw(tile: [usize; 2], number: usize, solids: &Solids, seen: &[Seen], looking: Looking) -> Self {
        let depth = vec![[f32::INFINITY; CELLS]; TILE * TILE];
        let mut surface = Self { tile, looking, depth, triangle: vec![[NONE; CELLS]; TILE * TILE] };
        pulp::Arch::new().dispatch(DrawTriangles { surface: &mut surface, number, solids, seen });
        if looking.of_four.is_some() {
            for (depth, triangle) in surface.depth.iter_mut().zip(&mut surface.triangle) {
                *depth = std::array::from_fn(|cell| depth[looking.instead_of(cell)]);
                *triangle = std::array::from_fn(|cell| triangle[looking.instead_of(cell)]);
            }
        }
        surface
    }

    /// Draws a triangle in the cells that see it at this moment.
    #[inline(always)]
    fn triangle(&mut self, t: u32, solids: &Solids, seen: &Seen) {
        let c = solids.triangles[t as usize].map(|v| &seen.corners[v as usize]);
        let span = |i: usize| {
            let first = (self.tile[i] * TILE) as f32;
            let low = c.iter().fold(f32::INFINITY, |m, c| m.min(c.at[i])) - first;
            let high = c.iter().fold(f32::NEG_INFINITY, |m, c| m.max(c.at[i])) - first;
            low.max(0.0) as usize..((high.max(-1.0) + 1.0) as usize).min(TILE)
        };
        let looks: [bool; CELLS] = std::array::from_fn(|s| (seen.cells & self.looking.cells) >> s & 1 == 1);
        for y in span(1) {
            for x in span(0) {
                let pixel = y * TILE + x;
                let places: [[f32; 2]; CELLS] = std::array::from_fn(|s| self.place(pixel, s));
                let Some(depths) = depths(c, &places, &seen.view) else { continue };
                let (nearest, triangle) = (&mut self.depth[pixel], &mut self.triangle[pixel]);
                for s in 0..CELLS {
                    let nearer = looks[s] && depths[s] < nearest[s];
                    nearest[s] = if nearer { depths[s] } else { nearest[s] };
                    triangle[s] = if nearer { t } else { triangle[s] };
                }
            }
        }
    }

    #[inline(always)]
    fn place(&self, pixel: usize, cell: usize) -> [f32; 2] {
        let offset = cell_offset(cell);
        let corner = [self.tile[0] * TILE + pixel % TILE, self.tile[1] * TILE + pixel / TILE];
        [corner[0] as f32 + offset[0], corner[1] as f32 + offset[1]]
    }

    /// Gathers each group of a pixel's cells into one piece of surface, or two where an edge passes before something behind.
    fn resolve(self, surface: &Surface, seen: &[Seen], groups: &[u16]) -> (Vec<SkinPixel>, f32) {
        let mut pixels = Vec::new();
        let mut hidden_beyond = 0.0_f32;
        for pixel in 0..TILE * TILE {
            let (depth, triangle) = (&self.depth[pixel], &self.triangle[pixel]);
            hidden_beyond = depth.iter().copied().fold(hidden_beyond, f32::max);
            for group in groups {
                let cells = || (0..CELLS).filter(|s| group >> s & 1 == 1 && triangle[*s] != NONE);
                let nearest = cells().map(|s| depth[s]).fold(f32::INFINITY, f32::min);
                let pick =
                    |test: &dyn Fn(f32) -> bool| cells().filter(|&s| test(depth[s])).fold(0_u16, |m, s| m | 1 << s);
                let masks = [pick(&|d| d < nearest + APART), pick(&|d| d >= nearest + APART)];
                pixels.extend(masks.into_iter().filter_map(|mask| self.piece(pixel, mask, surface, seen)));
            }
        }
        (pixels, hidden_beyond)
    }

    /// The surface in some cells of a pixel, as it is in the middle of them; none in no cells.
    fn piece(&self, pixel: usize, mask: u16, surface: &Surface, seen: &[Seen]) -> Option<SkinPixel> {
        let cells = || (0..CELLS).filter(|s| mask >> s & 1 == 1);
        let count = cells().count() as f32;
        let middle = [0, 1].map(|i| cells().map(|s| cell_offset(s)[i]).sum::<f32>() / count);
        let off = |s: usize| (cell_offset(s)[0] - middle[0]).hypot(cell_offset(s)[1] - middle[1]);
        let looked = cells().filter(|&s| self.looking.cells >> s & 1 == 1);
        let cell = looked.min_by(|&a, &b| off(a).total_cmp(&off(b)))?;
        let Seen { view, corners, .. } = &seen[moment_of(cell) * seen.len() / CELLS];
        let t = surface.solids.triangles[self.triangle[pixel][cell] as usize];
        let c = t.map(|v| &corners[v as usize]);
        let place = self.place(pixel, cell);
        let (w, here) = weights(c, place, view)?;
        let blend = |of: &[Vec3]| w[0] * of[t[0] as usize] + w[1] * of[t[1] as usize] + w[2] * of[t[2] as usize];
        let position = blend(&surface.positions);
        let normal = blend(&surface.normals).normalize_or(Vec3::Y);
        // Interpolated normals lean a little away from the eye at outlines; farther, it is the inside of an open mesh.
        let normal = if normal.dot(view.toward_eye(position)) < -0.2 { -normal } else { normal };
        let slope = slope(c);
        let centre = [0, 1].map(|i| (self.tile[i] * TILE) as f32 + 0.5);
        let centre = [centre[0] + (pixel % TILE) as f32, centre[1] + (pixel / TILE) as f32];
        let depth = here + slope[0] * (centre[0] - place[0]) + slope[1] * (centre[1] - place[1]);
        Some(SkinPixel {
            pixel: pixel as u16,
            mask,
            solid: surface.solids.solid_of(t[0]),
            depth,
            slope,
            position,
            normal,
        })
    }
}

/// All triangles of a tile, compiled for each width of vectors that machines have; one is chosen at run time.
struct DrawTriangles<'a> {
    surface: &'a mut TileSurface,
    number: usize,
    solids: &'a Solids,
    seen: &'a [Seen],
}

impl pulp::NullaryFnOnce for DrawTriangles<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        for seen in self.seen {
            for &t in &seen.lists[self.number] {
                self.surface.triangle(t, self.solids, seen);
            }
        }
    }
}

/// Weights of a triangle's corners at a place of the picture and the depth there, if it is inside.
fn weights(c: [&Corner; 3], p: [f32; 2], view: &View) -> Option<([f32; 3], f32)> {
    let areas = areas(c, p);
    is_inside(areas, area(c)).then(|| mixed(c, areas, view))
}

/// The depth of a triangle at places of the picture: infinite at those outside it, nothing if all are.
#[inline(always)]
fn depths<const N: usize>(c: [&Corner; 3], places: &[[f32; 2]; N], view: &View) -> Option<[f32; N]> {
    let all = area(c);
    let (mut inside, mut any) = ([false; N], false);
    for n in 0..N {
        inside[n] = is_inside(areas(c, places[n]), all);
        any |= inside[n];
    }
    any.then(|| {
        let mut depths = [f32::INFINITY; N];
        for n in 0..N {
            let (_, depth) = mixed(c, areas(c, places[n]), view);
            depths[n] = if inside[n] { depth } else { f32::INFINITY };
        }
        depths
    })
}

/// Twice the area between two corners and a place, positive to one side.
#[inline(always)]
fn cross(a: &Corner, b: &Corner, p: [f32; 2]) -> f32 {
    (b.at[0] - a.at[0]) * (p[1] - a.at[1]) - (b.at[1] - a.at[1]) * (p[0] - a.at[0])
}

#[inline(always)]
fn area(c: [&Corner; 3]) -> f32 {
    cross(c[0], c[1], c[2].at)
}

/// Twice the areas between a place and the side that lies opposite to each corner.
#[inline(always)]
fn areas(c: [&Corner; 3], p: [f32; 2]) -> [f32; 3] {
    [cross(c[1], c[2], p), cross(c[2], c[0], p), cross(c[0], c[1], p)]
}

/// Whether a place with these areas lies in a triangle of that area.
#[inline(always)]
fn is_inside([a, b, c]: [f32; 3], all: f32) -> bool {
    let (front, back) = ((a >= 0.0) & (b >= 0.0) & (c >= 0.0), (a <= 0.0) & (b <= 0.0) & (c <= 0.0));
    (front & (all > 0.0)) | (back & (all < 0.0))
}

/// What each corner counts at a place with these areas, and the depth there.
#[inline(always)]
fn mixed(c: [&Corner; 3], areas: [f32; 3], view: &View) -> ([f32; 3], f32) {
    let all = area(c);
    let mut w = areas.map(|a| a / all);
    if view.projection == Projection::Perspective {
        let over = [w[0] / c[0].depth, w[1] / c[1].depth, w[2] / c[2].depth];
        let sum = over[0] + over[1] + over[2];
        w = over.map(|o| o / sum);
    }
    (w, w[0] * c[0].depth + w[1] * c[1].depth + w[2] * c[2].depth)
}

/// Growth of a triangle's depth by a pixel right and down; at most so steep that a pixel spans `APART`.
fn slope([a, b, c]: [&Corner; 3]) -> [f32; 2] {
    let (u, v) = ([b.at[0] - a.at[0], b.at[1] - a.at[1]], [c.at[0] - a.at[0], c.at[1] - a.at[1]]);
    let (du, dv) = (b.depth - a.depth, c.depth - a.depth);
    let area = u[0] * v[1] - u[1] * v[0];
    [(du * v[1] - dv * u[1]) / area, (dv * u[0] - du * v[0]) / area]
        .map(|s| if s.is_finite() { s.clamp(-APART, APART) } else { 0.0 })
}
