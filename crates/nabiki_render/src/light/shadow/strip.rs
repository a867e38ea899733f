//! The walk through a strip of a lamp's map, away from the lamp.

use std::ops::Range;
use std::sync::atomic::{AtomicU32, Ordering};

use super::cells::Cells;
use super::item::Item;
use super::list::List;

/// What one strip of the map holds, in the order of distance; kept from frame to frame.
#[derive(Default)]
pub struct Strip {
    starts: Vec<u32>,
    order: Vec<Item>,
    cells: Vec<f32>,
}

impl Strip {
    /// Collects what is listed in the order of distance from the lamp, ties in the order of the lists.
    pub fn sort<'a>(&mut self, lists: impl Iterator<Item = &'a List> + Clone, slabs: usize) {
        self.starts.clear();
        self.starts.resize(slabs, 0);
        for list in lists.clone() {
            list.slabs.iter().for_each(|&slab| self.starts[usize::from(slab)] += 1);
        }
        let mut sum = 0;
        for start in &mut self.starts {
            sum += std::mem::replace(start, sum);
        }
        self.order.resize(sum as usize, Item::default());
        for list in lists {
            for (item, &slab) in list.items.iter().zip(&list.slabs) {
                let start = &mut self.starts[usize::from(slab)];
                self.order[*start as usize] = *item;
                *start += 1;
            }
        }
    }

    /// Takes what was sorted in its order: what reads has its count written, by the number of the receiver.
    pub fn walk(&mut self, held: Range<usize>, width: usize, first_on_skin: usize, counts: &[AtomicU32]) {
        self.cells.clear();
        self.cells.resize(held.len() * width, 0.0);
        let cells = Cells { first_row: held.start, width, cells: &mut self.cells };
        pulp::Arch::new().dispatch(Walk { order: &self.order, cells, first_on_skin, counts });
    }
}

/// The walk, compiled for each width of vectors that machines have; one is chosen at run time.
struct Walk<'a> {
    order: &'a [Item],
    cells: Cells<'a>,
    first_on_skin: usize,
    counts: &'a [AtomicU32],
}

impl pulp::NullaryFnOnce for Walk<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { order, mut cells, first_on_skin, counts } = self;
        for item in order {
            match item.receiver() {
                None => cells.lay(item.at, &item.fibre()),
                Some(receiver) => {
                    let fibres = if receiver < first_on_skin { cells.read(item.at) } else { cells.around(item.at) };
                    counts[receiver].store(fibres.to_bits(), Ordering::Relaxed);
                }
            }
        }
    }
}
