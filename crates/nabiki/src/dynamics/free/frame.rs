//! What a frame does to a block of strands of the free form.

use glam::Vec3;

use super::kernel::{FreeState, Walk, lag_behind};
use super::packed::{Packed, Plan};
use super::passes::{Among, Free, Place, Velocities};
use crate::dynamics::block::Block;
use crate::dynamics::row::PointRow;
use crate::dynamics::sweep::Swept;
use crate::prefetch::prefetch;

impl Swept for Packed {
    type State = FreeState;
    type Plan<'a> = Plan<'a>;

    fn blocks(&self) -> &[Block] {
        &self.blocks
    }

    #[inline(always)]
    fn frame(&self, block: &Block, plan: &Plan<'_>, states: &mut [FreeState], page: Option<&mut [Vec3]>) {
        let rows = &self.rows[block.rows()];
        match plan {
            Plan::Rest => {
                states.copy_from_slice(&self.rest[block.rows()]);
                block.walk(&block.roots, states, rows, page, Place);
            }
            Plan::Velocities => block.walk(&PointRow::default(), states, rows, page, Velocities),
            Plan::Step(step) => {
                if let Some((axis, angle)) = step.turn {
                    for (state, lag) in states.iter_mut().zip(&self.lags[block.rows()]) {
                        lag_behind(state, axis, angle, lag);
                    }
                }
                prefetch(page.as_deref().unwrap_or_default());
                let walk = Walk::new(&block.roots, states.first().zip(rows.first()));
                match step.everywhere {
                    Some(force) if step.bodies.is_empty() => {
                        let (weight, at) = (step.weight, block.rows().start);
                        let pass = Free { packed: self, force, weight, walk, at };
                        block.walk(&block.roots, states, rows, page, pass);
                    }
                    _ => {
                        let pass = Among::new(self, step, block, walk);
                        block.walk(&block.roots, states, rows, page, pass);
                    }
                }
            }
        }
    }
}
