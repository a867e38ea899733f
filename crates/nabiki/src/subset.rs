//! Even subsets by the farthest-first order.
//!
//! A preview draws 200 to 300 of the strands, spread over the whole scalp (section 5 of the paper). Each next point is
//! the one farthest from all points chosen before. The first n of the order are therefore an even choice for every n.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::{IVec3, Vec3};

/// Indices of `count` roots, spread evenly over `roots` (any unit): first the first root, then always the root farthest
/// from those already chosen (on a tie, the lower index).
///
/// A smaller count returns the beginning of a larger one's result. Of coincident roots, one is taken until nothing else
/// is left. If `count` is at least their number, all roots are returned in this order. Roots with coordinates that are
/// not finite come last.
pub fn evenly(roots: &[Vec3], count: usize) -> Vec<usize> {
    evenly_while(roots, count, &|| true).unwrap_or_default()
}

/// Like [`evenly`], but calls `goes_on` regularly and returns `None` if that returns `false`.
pub fn evenly_while(roots: &[Vec3], count: usize, goes_on: &dyn Fn() -> bool) -> Option<Vec<usize>> {
    let count = count.min(roots.len());
    if roots.iter().all(|root| root.is_finite()) {
        return farthest_first(roots, count, goes_on);
    }
    let finite: Vec<u32> = (0..roots.len() as u32).filter(|&i| roots[i as usize].is_finite()).collect();
    let places: Vec<Vec3> = finite.iter().map(|&i| roots[i as usize]).collect();
    let chosen = farthest_first(&places, count.min(places.len()), goes_on)?;
    let mut chosen: Vec<usize> = chosen.into_iter().map(|i| finite[i] as usize).collect();
    chosen.extend((0..roots.len()).filter(|&i| !roots[i].is_finite()).take(count - chosen.len()));
    Some(chosen)
}

/// Points visited between two calls of `goes_on`: some milliseconds.
const LOOKED_AT: usize = 1 << 20;

/// Least memory per point while sorting (bytes): its cell, its index there, its position and its gap.
pub const BYTES_A_POINT: usize = size_of::<usize>() + size_of::<u32>() + size_of::<Vec3>() + size_of::<f32>();

/// A grid over points on a surface, with the distance of each point from the nearest chosen one.
struct Cells {
    low: Vec3,
    size: f32,
    across: IVec3,
    /// `starts[c]..starts[c + 1]` are the points of cell c, in the arrays below.
    starts: Vec<u32>,
    index: Vec<u32>,
    place: Vec<Vec3>,
    /// Squared distance to the nearest chosen point; -1 for a chosen one.
    gap: Vec<f32>,
}

/// The farthest point of one cell: by squared distance, then the lower index.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Farthest {
    /// Bits of a nonnegative number, which sort like the number.
    gap_bits: u32,
    index: Reverse<u32>,
    slot: u32,
    cell: u32,
}

impl Cells {
    fn new(points: &[Vec3]) -> Self {
        let low = points.iter().copied().fold(Vec3::INFINITY, Vec3::min);
        let high = points.iter().copied().fold(Vec3::NEG_INFINITY, Vec3::max);
        let extent = (high - low).max_element();
        // Points on a surface fill about n = (extent / size)^2 cells; a few points share one.
        let along = (0.6 * (points.len() as f32).sqrt()).clamp(1.0, 160.0);
        // A single cell holds all if they lie on one spot, or so far apart that their distances overflow.
        let measurable = extent > 0.0 && extent.is_finite();
        let size = if measurable { extent / along } else { f32::MAX };
        let across = if measurable { ((high - low) / size).floor().as_ivec3() + 1 } else { IVec3::ONE };
        let mut cells = Self { low, size, across, starts: vec![], index: vec![], place: vec![], gap: vec![] };
        let cell_of: Vec<usize> = points.iter().map(|&p| cells.linear(cells.cell_of(p))).collect();
        let mut starts = vec![0_u32; across.to_array().into_iter().map(|n| n as usize).product::<usize>() + 1];
        for &c in &cell_of {
            starts[c + 1] += 1;
        }
        for c in 1..starts.len() {
            starts[c] += starts[c - 1];
        }
        let mut fill = starts.clone();
        let mut index = vec![0; points.len()];
        for (i, &c) in cell_of.iter().enumerate() {
            index[fill[c] as usize] = i as u32;
            fill[c] += 1;
        }
        cells.place = index.iter().map(|&i| points[i as usize]).collect();
        cells.gap = vec![f32::MAX; points.len()];
        cells.starts = starts;
        cells.index = index;
        cells
    }

    fn cell_of(&self, p: Vec3) -> IVec3 {
        ((p - self.low) / self.size).floor().as_ivec3().clamp(IVec3::ZERO, self.across - 1)
    }

    fn linear(&self, c: IVec3) -> usize {
        ((c.z * self.across.y + c.y) * self.across.x + c.x) as usize
    }

    fn range(&self, cell: usize) -> std::ops::Range<usize> {
        self.starts[cell] as usize..self.starts[cell + 1] as usize
    }

    /// The point of a cell that is farthest from the chosen ones, if any is left.
    fn farthest(&self, cell: usize) -> Option<Farthest> {
        self.range(cell)
            .filter(|&slot| self.gap[slot] >= 0.0)
            .map(|slot| Farthest {
                gap_bits: self.gap[slot].to_bits(),
                index: Reverse(self.index[slot]),
                slot: slot as u32,
                cell: cell as u32,
            })
            .max()
    }

    /// Marks `slot` as chosen. No remaining gap exceeds `widest` (squared). Returns the number of points visited.
    fn choose(&mut self, slot: usize, widest: f32) -> usize {
        let p = self.place[slot];
        self.gap[slot] = -1.0;
        let reach = Vec3::splat(widest.sqrt() * 1.001);
        let (from, to) = (self.cell_of(p - reach), self.cell_of(p + reach));
        let mut looked_at = 0;
        for z in from.z..=to.z {
            for y in from.y..=to.y {
                let row = self.linear(IVec3::new(0, y, z));
                // Cells of a row are contiguous in memory.
                let slots = self.starts[row + from.x as usize] as usize..self.starts[row + to.x as usize + 1] as usize;
                looked_at += slots.len();
                for (gap, place) in self.gap[slots.clone()].iter_mut().zip(&self.place[slots]) {
                    *gap = gap.min(place.distance_squared(p));
                }
            }
        }
        looked_at
    }
}

/// The order of [`evenly`], for finite points; none if `goes_on` returns false.
fn farthest_first(points: &[Vec3], count: usize, goes_on: &dyn Fn() -> bool) -> Option<Vec<usize>> {
    if count == 0 {
        return Some(Vec::new());
    }
    let mut cells = Cells::new(points);
    let mut chosen = Vec::with_capacity(count);
    let first = cells.index.iter().position(|&i| i == 0).expect("there are points");
    let mut looked_at = cells.choose(first, f32::MAX);
    chosen.push(0);
    // Gaps only shrink, so an outdated entry is too high: it is found and corrected before it matters.
    let mut queue: BinaryHeap<Farthest> = (0..cells.starts.len() - 1).filter_map(|cell| cells.farthest(cell)).collect();
    while chosen.len() < count {
        let Some(top) = queue.pop() else { break };
        let now = cells.farthest(top.cell as usize);
        if now == Some(top) {
            looked_at += cells.choose(top.slot as usize, f32::from_bits(top.gap_bits));
            chosen.push(top.index.0 as usize);
            queue.extend(cells.farthest(top.cell as usize));
        } else {
            queue.extend(now);
        }
        looked_at += cells.range(top.cell as usize).len();
        if looked_at >= LOOKED_AT {
            looked_at = 0;
            if !goes_on() {
                return None;
            }
        }
    }
    Some(chosen)
}

#[cfg(test)]
mod tests;
