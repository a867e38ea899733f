//! The bust as a head: its mesh and its sampled distance.

use std::sync::LazyLock;

use nabiki::distance::{COARSE, EDGE, Samples};
use nabiki::glam::{UVec3, Vec3};
use nabiki::{Ellipsoid, Head};

use super::layout::{self, CELL, COARSE_DISTANCE, DISTANCE, FINE, Quantised};
use super::read;

/// Its E: the half axes that make the paper's unit of length a centimetre.
const ELLIPSOID: Ellipsoid = Ellipsoid { center: Vec3::ZERO, half_axes: Vec3::new(9.5, 11.0, 7.8) };

/// What `nabiki_bust` wrote.
const BAKED: &[u8] = include_bytes!("bust.bin");

/// The built-in bust: head, neck and shoulders of an adult with open eyes and no hair. It is the same on every machine,
/// bit by bit, and symmetric in z.
pub fn bust() -> Head {
    // Whoever builds scene after scene asks for it again and again.
    static BUST: LazyLock<Head> = LazyLock::new(|| {
        let bust = read::numbers(BAKED);
        let mut head = Head::from_samples(read::mesh(&bust), ELLIPSOID, samples(&bust)).expect("the bust is a head");
        head.is_builtin = true;
        head
    });
    BUST.clone()
}

/// The sampled distance, whose right half stands for both.
fn samples(bust: &Quantised) -> Samples {
    let cells = bust.cells.map(|cells| cells as usize);
    let [nx, ny, nz] = cells.map(|cells| cells + 1);
    let [fx, fy] = [cells[0] * FINE + 1, cells[1] * FINE + 1];
    let (mut block_of, mut fine) = (Vec::with_capacity(bust.near.len()), Vec::new());
    for (cell, &near) in bust.near.iter().enumerate() {
        if !near {
            block_of.push(COARSE);
            continue;
        }
        block_of.push(fine.len() as u32);
        let corner = layout::place(cell, cells);
        fine.push(std::array::from_fn(|at| {
            let inner = layout::place(at, [EDGE; 3]);
            let [x, y, z] = [0, 1, 2].map(|axis| corner[axis] * FINE + inner[axis]);
            DISTANCE * bust.fine[(z * fy + y) * fx + x] as f32
        }));
    }
    let coarse = bust.coarse.iter().map(|&distance| COARSE_DISTANCE * distance as f32).collect();
    let low = CELL * Vec3::new(bust.low[0] as f32, bust.low[1] as f32, 0.0);
    let nodes = UVec3::new(nx as u32, ny as u32, nz as u32);
    Samples { low, cell: CELL, nodes, mirrored: true, coarse, block_of, fine }
}
