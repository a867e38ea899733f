//! The systems of a step of the free form, for one block of strands: tensions, and increments at its end.
//!
//! Loops over lanes are written as in [`kernel`](super::kernel), and for the same reasons.

use super::aimed::AimRow;
use super::kernel::{BEYOND, FreeRow, FreeState, NONE, ZERO, next};
use super::reference::{AFTER, AFTER_PRESSED, BEFORE, BENT};
use super::work::Work;
use crate::dynamics::row::{LANES, PointRow, Row, lane as lane_of, set_lane};
use crate::vector::{add, dot, scale, scale_add, subtract};

/// Goes to the tips with the tridiagonal system of the tensions: what drives the increments without them, and the first
/// half of the elimination. `ANSWERED`: after [`answer`].
#[inline(always)]
pub(super) fn pull_taut<const ANSWERED: bool>(states: &[FreeState], rows: &[FreeRow], work: &mut [Work]) {
    let mut answered_before = ZERO;
    let (mut node_before, mut velocity, mut drag, mut lightness) = (ZERO, ZERO, NONE, NONE);
    let (mut before, mut above, mut tension, mut bent) = (ZERO, NONE, NONE, NONE);
    for (i, (state, row)) in states.iter().zip(rows).enumerate() {
        let next_shear = next(work, i, &BEYOND.2).shear;
        let beyond = if ANSWERED { next(work, i, &BEYOND.2).moment } else { ZERO };
        let next_direction = next(states, i, &BEYOND.0).direction;
        let FreeState { direction, increment, .. } = *state;
        let FreeRow { length, lightness: lighter, .. } = *row;
        let work = &mut work[i];
        let Work { shear, pushed, drag: slowed, velocity: goes, moment: answers, .. } = *work;
        let mut drives = ZERO;
        for lane in 0..LANES {
            let (d, w) = (lane_of(&direction, lane), lane_of(&increment, lane));
            let (length, up, down) = (length.0[lane], lighter.0[lane], lightness.0[lane]);
            let sheared = subtract(lane_of(&shear, lane), lane_of(&next_shear, lane));
            let node = scale_add(up, sheared, lane_of(&pushed, lane));
            let differs = slowed.0[lane] - drag.0[lane];
            let driven = subtract(node, lane_of(&node_before, lane));
            let driven = scale_add(-differs, lane_of(&velocity, lane), driven);
            let mut right = length.mul_add(dot(w, w), dot(scale_add(-slowed.0[lane] * length, w, driven), d));
            if ANSWERED {
                let answered = scale(up, subtract(lane_of(&answers, lane), lane_of(&beyond, lane)));
                let by = dot(subtract(answered, lane_of(&answered_before, lane)), d);
                // Strands that need no answer keep their bits, including the sign of 0.
                right = if by == 0.0 { right } else { right + by };
                set_lane(&mut answered_before, lane, answered);
            }
            let lower = -down * dot(d, lane_of(&before, lane));
            let middle = (-lower).mul_add(above.0[lane], up + down);
            // Held and missing segments are under no tension.
            let over = if up > 0.0 { 1.0 / middle } else { 0.0 };
            let along = dot(d, lane_of(&next_direction, lane));
            above.0[lane] = -up * along * over;
            // For the joint after it, the squared sine of the bend; held segments bend no joint.
            bent.0[lane] = if up > 0.0 { (-along).mul_add(along, 1.0) } else { 0.0 };
            tension.0[lane] = (-lower).mul_add(tension.0[lane], right) * over;
            set_lane(&mut node_before, lane, node);
            set_lane(&mut drives, lane, driven);
        }
        (before, velocity, drag, lightness) = (direction, goes, slowed, lighter);
        (work.driven, work.above, work.tension, work.bent) = (drives, above, tension, bent);
    }
}

/// Comes back from the tips with the tensions.
#[inline(always)]
pub(super) fn slacken(work: &mut [Work]) {
    let mut beyond = NONE;
    for work in work.iter_mut().rev() {
        let Work { above, mut tension, .. } = *work;
        for lane in 0..LANES {
            tension.0[lane] = (-above.0[lane]).mul_add(beyond.0[lane], tension.0[lane]);
        }
        (work.tension, beyond) = (tension, tension);
    }
}

/// Adds the effect of the tensions to what drives the increments.
#[inline(always)]
pub(super) fn drive(states: &[FreeState], rows: &[FreeRow], work: &mut [Work]) {
    let mut node_before = ZERO;
    for (i, (state, row)) in states.iter().zip(rows).enumerate() {
        let next_tension = next(work, i, &BEYOND.2).tension;
        let next_direction = next(states, i, &BEYOND.0).direction;
        let FreeState { direction, increment, .. } = *state;
        let FreeRow { length, lightness, .. } = *row;
        let work = &mut work[i];
        let Work { tension, mut driven, .. } = *work;
        for lane in 0..LANES {
            let (d, w) = (lane_of(&direction, lane), lane_of(&increment, lane));
            let beyond = scale(next_tension.0[lane], lane_of(&next_direction, lane));
            let node = scale(lightness.0[lane], scale_add(-tension.0[lane], d, beyond));
            let by = add(lane_of(&driven, lane), subtract(node, lane_of(&node_before, lane)));
            set_lane(&mut driven, lane, scale_add(length.0[lane] * dot(w, w), d, by));
            set_lane(&mut node_before, lane, node);
        }
        work.driven = driven;
    }
}

/// What earlier rows of the pentadiagonal system leave: coefficients of the two next unknowns, and the right side.
#[derive(Clone, Copy)]
struct Left {
    next: Row,
    after: Row,
    right: PointRow,
}

/// The acceleration of the middle node by turns of four segments in a row.
type NodeRow = [Row; 4];

/// Goes to the tips with the pentadiagonal system of the increments, for a step of `h` frames. `pressed`: 1 for strands
/// that are solved as pressed, 0 for others.
#[inline(always)]
pub(super) fn solve(
    states: &[FreeState],
    rows: &[FreeRow],
    aims: Option<&[AimRow]>,
    h: f32,
    pressed: &Row,
    work: &mut [Work],
) {
    let share = |free: f64, pressed: f64| move |by: f32| h * h * if by > 0.0 { pressed as f32 } else { free as f32 };
    let implicit = Row(pressed.0.map(share(AFTER, AFTER_PRESSED)));
    let explicit = Row(pressed.0.map(share(BEFORE, 0.0)));
    let nothing = Left { next: NONE, after: NONE, right: ZERO };
    let (mut left, mut node_before): ([Left; 2], NodeRow) = ([nothing; 2], [NONE; 4]);
    let mut stiffness = answers(&rows[0], rows.get(1), aims.map(|aims| &aims[0].hold), &NONE, &work[0]);
    for (i, (state, row)) in states.iter().zip(rows).enumerate() {
        let (of_next, after_next) = match rows.get(i + 1) {
            Some(next) => {
                let aimed = aims.map(|aims| &aims[i + 1].hold);
                (answers(next, rows.get(i + 2), aimed, &work[i].bent, &work[i + 1]), i + 2 < rows.len())
            }
            None => ([NONE; 3], false),
        };
        let ahead = [next(states, i, &BEYOND.0), if after_next { &states[i + 2] } else { &BEYOND.0 }];
        let behind = [1, 2].map(|k| if i >= k { &states[i - k] } else { &BEYOND.0 });
        let [ahead, behind] = [ahead, behind].map(|of| of.map(|state| state.increment));
        let increment = state.increment;
        let FreeRow { length, lightness, residual, .. } = *row;
        let work = &mut work[i];
        let Work { drag, driven, .. } = *work;
        for lane in 0..LANES {
            let (implicit, explicit) = (implicit.0[lane], explicit.0[lane]);
            let (length, up) = (length.0[lane], lightness.0[lane]);
            let node = [
                up * stiffness[0].0[lane],
                up * (stiffness[1].0[lane] - of_next[0].0[lane]),
                up * (stiffness[2].0[lane] - of_next[1].0[lane]),
                -up * of_next[2].0[lane],
            ];
            let a = -node_before[0].0[lane];
            let b = node[0] - node_before[1].0[lane];
            let c = node[1] - node_before[2].0[lane];
            let d = node[2] - node_before[3].0[lane];
            let e = node[3];
            for k in 0..4 {
                node_before[k].0[lane] = node[k];
            }
            let w = lane_of(&increment, lane);
            let mut turned = scale(c, w);
            turned = scale_add(a, lane_of(&behind[1], lane), turned);
            turned = scale_add(b, lane_of(&behind[0], lane), turned);
            turned = scale_add(d, lane_of(&ahead[0], lane), turned);
            turned = scale_add(e, lane_of(&ahead[1], lane), turned);
            let driven = subtract(lane_of(&driven, lane), lane_of(&residual, lane));
            let right = scale_add(h, driven, scale_add(explicit, turned, scale(length, w)));
            let [one, two] = &left;
            let a = implicit * a;
            let b = (-a).mul_add(two.next.0[lane], implicit * b);
            let c = implicit.mul_add(c, length * h.mul_add(drag.0[lane], 1.0));
            let c = (-a).mul_add(two.after.0[lane], (-b).mul_add(one.next.0[lane], c));
            let d = (-b).mul_add(one.after.0[lane], implicit * d);
            let right = scale_add(-a, lane_of(&two.right, lane), scale_add(-b, lane_of(&one.right, lane), right));
            // Held and missing segments stay.
            let over = if up > 0.0 { 1.0 / c } else { 0.0 };
            left[1].next.0[lane] = left[0].next.0[lane];
            left[1].after.0[lane] = left[0].after.0[lane];
            let before = lane_of(&left[0].right, lane);
            set_lane(&mut left[1].right, lane, before);
            left[0].next.0[lane] = d * over;
            left[0].after.0[lane] = implicit * e * over;
            set_lane(&mut left[0].right, lane, scale(over, right));
        }
        (work.next, work.after, work.driven) = (left[0].next, left[0].after, left[0].right);
        stiffness = of_next;
    }
}

/// Q of a segment: the answer of its force to a turn of the one before it, of itself and of the next. `bent`: the
/// squared sine of the bend of the joint before it. `aimed`: the moment per radian of the aims.
#[inline(always)]
fn answers(row: &FreeRow, next: Option<&FreeRow>, aimed: Option<&Row>, bent: &Row, work: &Work) -> [Row; 3] {
    let next = next.map_or(NONE, |next| next.bending);
    let FreeRow { over_length, bending, mut hold, .. } = *row;
    if let Some(aimed) = aimed {
        for lane in 0..LANES {
            hold.0[lane] += aimed.0[lane];
        }
    }
    let Work { bent: bent_after, tension, .. } = *work;
    let bent = *bent;
    let more = BENT as f32;
    let mut answers = [NONE; 3];
    for lane in 0..LANES {
        let (over, here, next) = (over_length.0[lane], bending.0[lane], next.0[lane]);
        let joints = here.mul_add(more.mul_add(bent.0[lane], 1.0), hold.0[lane]);
        let joints = next.mul_add(more.mul_add(bent_after.0[lane], 1.0), joints);
        answers[0].0[lane] = -over * here;
        answers[1].0[lane] = over.mul_add(joints, tension.0[lane].max(0.0));
        answers[2].0[lane] = -over * next;
    }
    answers
}

/// Comes back from the tips with the increments at the end of the step.
#[inline(always)]
pub(super) fn unwind(work: &mut [Work]) {
    let (mut one, mut two) = (ZERO, ZERO);
    for work in work.iter_mut().rev() {
        let Work { next, after, mut driven, .. } = *work;
        for lane in 0..LANES {
            let left = scale_add(-next.0[lane], lane_of(&one, lane), lane_of(&driven, lane));
            set_lane(&mut driven, lane, scale_add(-after.0[lane], lane_of(&two, lane), left));
        }
        (work.driven, one, two) = (driven, driven, one);
    }
}

/// After a solve of `h` frames: records how the joints of the `pressed` strands answer the turns found, for the
/// tensions of the next solve.
#[inline(always)]
pub(super) fn answer(rows: &[FreeRow], aims: Option<&[AimRow]>, h: f32, pressed: &Row, work: &mut [Work]) {
    let share = Row(pressed.0.map(|pressed| -h * AFTER_PRESSED as f32 * pressed));
    let (mut behind, mut here, mut bent) = (ZERO, work[0].driven, NONE);
    for (i, row) in rows.iter().enumerate() {
        let ahead = next(work, i, &BEYOND.2).driven;
        let [first, second, third] = answers(row, rows.get(i + 1), aims.map(|aims| &aims[i].hold), &bent, &work[i]);
        let mut answer = ZERO;
        for lane in 0..LANES {
            let sum = scale(first.0[lane], lane_of(&behind, lane));
            let sum = scale_add(second.0[lane], lane_of(&here, lane), sum);
            let sum = scale_add(third.0[lane], lane_of(&ahead, lane), sum);
            set_lane(&mut answer, lane, scale(share.0[lane], sum));
        }
        (behind, here, bent) = (here, ahead, work[i].bent);
        work[i].moment = answer;
    }
}
