//! What skin and head do to a block of strands before a step: taken along by the one, left behind by the turn of both.

use super::kernel::{FreeState, ends, stay_behind};
use super::passes::Blown;
use super::work::Work;
use crate::dynamics::row::{LANES, Row, lane as lane_of, set_lane};
use crate::vector::{add, dot, subtract};

impl Blown<'_, '_> {
    /// Takes hair along with skin that moves in a step, and notes how far.
    #[inline(always)]
    pub fn go_along(&self, states: &mut [FreeState], work: &mut [Work]) {
        let Some(ride) = self.ride else { return };
        let (mut before, mut end) = (ride.roots_before, ride.roots);
        for ((state, row), work) in states.iter_mut().zip(self.rows()).zip(work) {
            before = ends(state, row, &before);
            ride.carry(state, row);
            end = ends(state, row, &end);
            let mut gap = state.gap;
            for lane in 0..LANES {
                let way = subtract(lane_of(&end, lane), lane_of(&before, lane));
                gap.0[lane] -= dot(way, way).sqrt();
                set_lane(&mut work.ridden, lane, way);
            }
            state.gap = gap;
            work.shifted = work.ridden;
        }
    }

    /// Leaves hair behind by its share of the turn in a step of `h` frames, and notes how far.
    #[inline(always)]
    pub fn stay_behind(&self, states: &mut [FreeState], h: f32, meets_bodies: bool, work: &mut [Work]) {
        match (self.ride, self.step.turn) {
            (Some(ride), _) if ride.turns => {
                let turn = |lane: usize| (lane_of(&ride.axis, lane), h * ride.angle.0[lane]);
                self.turn_back(states, turn, meets_bodies, work);
            }
            (None, Some((axis, angle))) => self.turn_back(states, |_| (axis, h * angle), meets_bodies, work),
            _ => {}
        }
    }

    #[inline(always)]
    fn turn_back(
        &self,
        states: &mut [FreeState],
        turn: impl Fn(usize) -> ([f32; 3], f32),
        meets_bodies: bool,
        work: &mut [Work],
    ) {
        let (rows, first, roots) = (self.rows(), self.block.rows().start, self.roots());
        let (mut before, mut end, mut ways) = (roots, roots, Row::default());
        for lane in 0..LANES {
            ways.0[lane] = turn(lane).1.abs() * self.packed.longest * self.packed.most_drag;
        }
        for (i, ((state, row), work)) in states.iter_mut().zip(rows).zip(work).enumerate() {
            before = ends(state, row, &before);
            stay_behind(state, row, &turn, &self.packed.air(first + i).drag);
            if meets_bodies {
                end = ends(state, row, &end);
                for lane in 0..LANES {
                    let way = subtract(lane_of(&end, lane), lane_of(&before, lane));
                    let way = if self.ride.is_some() { add(way, lane_of(&work.ridden, lane)) } else { way };
                    set_lane(&mut work.shifted, lane, way);
                    state.gap.0[lane] -= ways.0[lane];
                }
            }
        }
    }
}
