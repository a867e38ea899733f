//! The bust in whole numbers, and the order in which they are told.
//!
//! Writer and reader are one walk over the same numbers, [`code`]: what the one tells the other expects. Only the
//! right half (z >= 0) is there; the left one is its mirror image.
//!
//! The mesh is a dual of a grid of nodes that are inside or outside: one vertex in each cell that has both, and four
//! such cells about each edge between the two make a quadrilateral. The innermost layer of cells straddles z = 0.

use super::numbers::{Coder, Kind};

/// Vertices and the grid's planes are whole multiples of this (cm).
pub const POSITION: f32 = 1.0 / 4096.0;
/// Distances at fine nodes are whole multiples of this (cm).
pub const DISTANCE: f32 = 1.0 / 1024.0;
/// Distances at coarse nodes are whole multiples of this (cm).
pub const COARSE_DISTANCE: f32 = 1.0 / 128.0;
/// Edge of a coarse cell of the sampled distance (cm).
pub const CELL: f32 = 333.0 / 256.0;
/// Fine steps along one coarse cell.
pub const FINE: usize = 4;

/// All that is told.
#[derive(Debug, Default)]
pub struct Quantised {
    /// The grid's planes along x and y, and along z those of the right half ([`POSITION`]).
    pub planes: [Vec<i32>; 3],
    /// Whether each node of the grid is inside, x fastest.
    pub inside: Vec<bool>,
    /// The vertex of each cell that the skin passes, in the order of [`skin_cells`] ([`POSITION`]).
    pub vertices: Vec<[i32; 3]>,
    /// Coarse cells of the sampled distance along each axis, of the right half along z.
    pub cells: [i32; 3],
    /// Where the sampled box begins along x and y, in coarse cells.
    pub low: [i32; 2],
    /// Signed distance at the coarse nodes, x fastest ([`COARSE_DISTANCE`]).
    pub coarse: Vec<i32>,
    /// Whether each coarse cell has fine samples, x fastest.
    pub near: Vec<bool>,
    /// Signed distance at the fine nodes of those cells, x fastest ([`DISTANCE`]); elsewhere 0.
    pub fine: Vec<i32>,
}

/// The cells that the skin passes through, x fastest; layer 0 straddles the middle, layer l lies between the planes
/// l - 1 and l of the right half.
pub fn skin_cells(counts: [usize; 3], inside: &[bool]) -> Vec<[usize; 3]> {
    let [nx, ny, nz] = counts;
    let mut found = Vec::new();
    let mut corners = vec![0_u8; nx];
    for layer in 0..nz {
        for j in 0..ny - 1 {
            corners.fill(0);
            for plane in [layer.saturating_sub(1), layer] {
                for row in [j, j + 1] {
                    let nodes = &inside[(plane * ny + row) * nx..][..nx];
                    corners.iter_mut().zip(nodes).for_each(|(corners, node)| *corners += u8::from(*node));
                }
            }
            for (i, pair) in corners.windows(2).enumerate() {
                if !matches!(pair[0] + pair[1], 0 | 8) {
                    found.push([i, j, layer]);
                }
            }
        }
    }
    found
}

/// The middle of a cell of the grid ([`POSITION`]).
pub fn middle(planes: &[Vec<i32>; 3], [i, j, layer]: [usize; 3]) -> [i32; 3] {
    let between = |planes: &[i32], i: usize| (planes[i] + planes[i + 1]) / 2;
    let z = if layer == 0 { 0 } else { between(&planes[2], layer - 1) };
    [between(&planes[0], i), between(&planes[1], j), z]
}

/// Tells all numbers of `bust` in order. A reader starts from an empty one.
pub fn code(bust: &mut Quantised, coder: &mut impl Coder) {
    code_mesh(bust, coder);
    code_distance(bust, coder);
}

fn code_mesh(bust: &mut Quantised, coder: &mut impl Coder) {
    for planes in &mut bust.planes {
        let mut count = planes.len() as i32;
        coder.code(Kind::Grid, 0, &mut count);
        planes.resize(count as usize, 0);
        let mut before = 0;
        for plane in planes {
            coder.code(Kind::Grid, before, plane);
            before = *plane;
        }
    }
    let counts = [0, 1, 2].map(|axis| bust.planes[axis].len());
    code_runs(&mut bust.inside, counts.iter().product(), coder);
    let cells = skin_cells(counts, &bust.inside);
    bust.vertices.resize(cells.len(), [0; 3]);
    for (vertex, cell) in bust.vertices.iter_mut().zip(cells) {
        let expected = middle(&bust.planes, cell);
        // In the middle layer z is 0.
        let axes = if cell[2] == 0 { 2 } else { 3 };
        for (value, expected) in vertex.iter_mut().zip(expected).take(axes) {
            coder.code(Kind::Vertex, expected, value);
        }
    }
}

fn code_runs<C: Coder>(values: &mut Vec<bool>, count: usize, coder: &mut C) {
    values.resize(count, false);
    let (mut at, mut now) = (0, false);
    while at < count {
        let same = || values[at..].iter().take_while(|value| **value == now).count() as i32;
        let mut run = if C::READS { 0 } else { same() };
        coder.code(Kind::Run, 0, &mut run);
        values[at..at + run as usize].fill(now);
        at += run as usize;
        now = !now;
    }
}

fn code_distance(bust: &mut Quantised, coder: &mut impl Coder) {
    for number in bust.cells.iter_mut().chain(&mut bust.low) {
        coder.code(Kind::Grid, 0, number);
    }
    let cells = bust.cells.map(|cells| cells as usize);
    let nodes = cells.map(|cells| cells + 1);
    bust.coarse.resize(nodes.iter().product(), 0);
    for at in 0..bust.coarse.len() {
        let [i, j, k] = place(at, nodes);
        let expected = expected([i, j, k], |[i, j, k]| bust.coarse[(k * nodes[1] + j) * nodes[0] + i]);
        coder.code(Kind::Coarse, expected, &mut bust.coarse[at]);
    }
    code_runs(&mut bust.near, cells.iter().product(), coder);

    let fine_nodes = cells.map(|cells| cells * FINE + 1);
    bust.fine.resize(fine_nodes.iter().product(), 0);
    let mut told = vec![false; bust.fine.len()];
    for cell in (0..bust.near.len()).filter(|&cell| bust.near[cell]) {
        let corner = place(cell, cells);
        let node = |[i, j, k]: [usize; 3]| {
            let [i, j, k] = [corner[0] * FINE + i, corner[1] * FINE + j, corner[2] * FINE + k];
            (k * fine_nodes[1] + j) * fine_nodes[0] + i
        };
        for at in 0..(FINE + 1).pow(3) {
            let at = place(at, [FINE + 1; 3]);
            let own = node(at);
            if !std::mem::replace(&mut told[own], true) {
                let expected = expected(at, |at| bust.fine[node(at)]);
                coder.code(Kind::Fine, expected, &mut bust.fine[own]);
            }
        }
    }
}

/// The place of the `at`-th entry of an array, x fastest.
pub fn place(at: usize, [nx, ny, _]: [usize; 3]) -> [usize; 3] {
    [at % nx, at / nx % ny, at / (nx * ny)]
}

/// What the samples before `at` let expect there: flat along each axis that has a sample before, straight along the
/// only one.
fn expected(at: [usize; 3], sample: impl Fn([usize; 3]) -> i32) -> i32 {
    let back = |axes: [usize; 3]| sample([at[0] - axes[0], at[1] - axes[1], at[2] - axes[2]]);
    match at.map(|i| i > 0) {
        [false, false, false] => 0,
        [true, true, true] => {
            back([1, 0, 0]) + back([0, 1, 0]) + back([0, 0, 1]) - back([1, 1, 0]) - back([1, 0, 1]) - back([0, 1, 1])
                + back([1, 1, 1])
        }
        [true, true, false] => back([1, 0, 0]) + back([0, 1, 0]) - back([1, 1, 0]),
        [true, false, true] => back([1, 0, 0]) + back([0, 0, 1]) - back([1, 0, 1]),
        [false, true, true] => back([0, 1, 0]) + back([0, 0, 1]) - back([0, 1, 1]),
        one => {
            let axis = one.iter().position(|before| *before).expect("one of them");
            let steps = |n: usize| std::array::from_fn(|i| if i == axis { n } else { 0 });
            if at[axis] > 1 { 2 * back(steps(1)) - back(steps(2)) } else { back(steps(1)) }
        }
    }
}
