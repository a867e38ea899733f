//! A frame of a block of strands in the free form.

use glam::Vec3;

use super::aimed::{self, AimRow};
use super::kernel::{FreeRow, FreeState, NONE, bend, carry, untwist};
use super::packed::{Packed, Plan, Step};
use super::passes::{Blown, Go, Place, Stepped, Velocities};
use super::reference::ROUNDS_PRESSED;
use super::ride_row::{RideRow, at_rest_on};
use super::solve::{answer, drive, pull_taut, slacken, solve, unwind};
use super::work::{self, Work};
use crate::dynamics::block::Block;
use crate::dynamics::row::{LANES, PointRow, Row, lane as lane_of, set_lane};
use crate::dynamics::sweep::Swept;
use crate::prefetch::prefetch;
use crate::vector::scale;

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
            Plan::Rest(skin) => {
                states.copy_from_slice(&self.at_rest[block.rows()]);
                let mut roots = block.roots;
                if let Some(skin) = skin {
                    let turns;
                    (roots, turns) = at_rest_on(skin, self.places(block));
                    states.iter_mut().for_each(|state| state.direction = turns.of(&state.direction));
                }
                block.walk(&roots, states, rows, page, Place);
            }
            Plan::Velocities => block.walk(&PointRow::default(), states, rows, page, Velocities),
            Plan::Residual => {
                let mut room = work::room(rows.len());
                let work = &mut room[..rows.len()];
                self.drive_at_rest(block, states, work);
                work::keep(room);
            }
            Plan::Step(step) => {
                prefetch(page.as_deref().unwrap_or_default());
                let mut room = work::room(rows.len());
                self.step(block, step, states, page, &mut room[..rows.len()]);
                work::keep(room);
            }
        }
    }
}

impl Packed {
    /// Takes a block through all steps of a frame.
    #[inline(always)]
    fn step(
        &self,
        block: &Block,
        step: &Step<'_>,
        states: &mut [FreeState],
        mut page: Option<&mut [Vec3]>,
        work: &mut [Work],
    ) {
        let rows = &self.rows[block.rows()];
        let number = block.first_strand as usize / LANES;
        let led = self.aimed(number, step.frame);
        let mut room = led.map(|_| aimed::room(rows.len()));
        let mut ride = step.skin.map(|skin| RideRow::new(&skin, self.places(block), &self.anchors[number], step.steps));
        let h = 1.0 / step.steps as f32;
        let bodies = step.bodies.len() / step.steps as usize;
        let carried = (bodies > 0).then(|| self.weight_at_rest(number));
        for n in 1..=step.steps as usize {
            if let Some(ride) = &mut ride {
                ride.go_to(n as u32, step.steps);
            }
            let of = Blown { packed: self, step, block, number, ride: ride.as_ref() };
            of.go_along(states, work);
            if n == 1 {
                of.blow(states, work);
                if let Some(led) = led {
                    led.calm(step.frame, work);
                }
            }
            of.stay_behind(states, h, bodies > 0, work);
            let from_rest = ride.as_ref().map(|ride| &ride.from_rest);
            // Where aims lead stays the same through the frame, except on skin that turns.
            if let (Some(led), Some(room)) = (led, &mut room)
                && (n == 1 || from_rest.is_some())
            {
                led.lead(step.frame, from_rest, &mut room[..rows.len()]);
            }
            let aims = room.as_ref().map(|room| &room[..rows.len()]);
            carry(states, rows, &of.roots(), from_rest, carried.as_ref(), work);
            untwist(work);
            bend(states, rows, from_rest, aims, work);
            let bodies = &step.bodies[(n - 1) * bodies..n * bodies];
            let closer = bodies.iter().map(|body| body.closer).fold(0.0, f32::max);
            let stepped = Stepped { of, bodies, h, closer };
            stepped.push(states, work);
            solve_chain::<false>(states, rows, aims, h, &NONE, work);
            // Joints hold a pressed node, so it does not move as pushed: tensions need not take the other nodes there.
            if !bodies.is_empty()
                && let Some(pressed) = pressed(states)
            {
                for _ in 0..ROUNDS_PRESSED {
                    answer(rows, aims, h, &pressed, work);
                    solve_chain::<true>(states, rows, aims, h, &pressed, work);
                }
            }
            let page = if n == step.steps as usize { page.take() } else { None };
            block.walk(&of.roots(), states, rows, page, Go::new(stepped, work));
        }
        room.into_iter().for_each(aimed::keep);
    }

    /// Leaves in the increments of hair at rest what drives them there: rounding errors.
    #[inline(always)]
    fn drive_at_rest(&self, block: &Block, states: &mut [FreeState], work: &mut [Work]) {
        let (rows, first) = (&self.rows[block.rows()], block.rows().start);
        let weight = self.weight_at_rest(block.first_strand as usize / LANES);
        carry(states, rows, &block.roots, None, None, work);
        untwist(work);
        bend(states, rows, None, None, work);
        for (i, (row, work)) in rows.iter().zip(&mut *work).enumerate() {
            work.drag = self.air(first + i).air;
            for lane in 0..LANES {
                set_lane(&mut work.pushed, lane, scale(row.push.0[lane], lane_of(&weight, lane)));
            }
        }
        pull_taut::<false>(states, rows, work);
        slacken(work);
        drive(states, rows, work);
        for (state, work) in states.iter_mut().zip(work) {
            state.increment = work.driven;
        }
    }
}

/// Finds the tensions, and the increments at the end of a step of `h` frames. `ANSWERED`: takes into account how the joints of the
/// `pressed` strands answered before, see [`answer`].
#[inline(always)]
fn solve_chain<const ANSWERED: bool>(
    states: &[FreeState],
    rows: &[FreeRow],
    aims: Option<&[AimRow]>,
    h: f32,
    pressed: &Row,
    work: &mut [Work],
) {
    pull_taut::<ANSWERED>(states, rows, work);
    slacken(work);
    drive(states, rows, work);
    solve(states, rows, aims, h, pressed, work);
    unwind(work);
}

/// 1 for pressed strands, 0 for others; `None` if none is pressed.
#[inline(always)]
fn pressed(states: &[FreeState]) -> Option<Row> {
    let mut most = Row([0.0; LANES]);
    for state in states {
        let pressed = state.pressed;
        for lane in 0..LANES {
            most.0[lane] = most.0[lane].max(pressed.0[lane]);
        }
    }
    let pressed = most.0.map(|pressed| if pressed > 0.0 { 1.0 } else { 0.0 });
    pressed.iter().any(|&pressed| pressed > 0.0).then_some(Row(pressed))
}
