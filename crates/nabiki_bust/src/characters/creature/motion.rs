//! Its motion: it breathes, looks to its right, shakes itself from head to tail, and sweeps its tail.

use std::f64::consts::TAU;

use super::super::glb::RATE;
use super::super::rig::{Move, eased, keyed};
use super::{CHEST, EAR, HEAD, JOINTS, LEG, LOIN, NAPE, NECK, TAIL};

const LAST: usize = 132;
/// Frames in which the head shakes; the wave goes through the body from there.
const SHAKE: [f64; 2] = [66.0, 96.0];
/// Shakes per second.
const SHAKES: f64 = 2.2;
/// Frames by which the wave is later at the tip of the tail than at the nose.
const WAVE: f64 = 12.0;

pub(super) fn frames() -> Vec<Vec<Move>> {
    (0..=LAST).map(|frame| pose(frame as f64)).collect()
}

/// The shake where it is `late` of the way from nose to tail.
fn shake(frame: f64, late: f64) -> f64 {
    let at = frame - WAVE * late;
    let grows = eased(at, SHAKE[0], SHAKE[0] + 12.0) * (1.0 - eased(at, SHAKE[1] - 12.0, SHAKE[1]));
    grows * (TAU * SHAKES * (at - SHAKE[0]) / RATE).sin()
}

fn pose(frame: f64) -> Vec<Move> {
    let mut moves = vec![Move::NONE; JOINTS.len()];
    let begins = eased(frame, 0.0, 14.0);
    let ends = 1.0 - eased(frame, 106.0, 130.0);
    let breath = (TAU * frame / 44.0).sin() * begins * ends;
    // It looks to its right, back, and stretches down before it shakes.
    let look =
        |late: f64| keyed(&[(8.0 + late, 0.0), (26.0 + late, 1.0), (36.0 + late, 1.0), (54.0 + late, 0.0)], frame);
    let bow = keyed(&[(48.0, 0.0), (66.0, 1.0), (88.0, 1.0), (112.0, 0.0)], frame);

    moves[0] = Move::degrees(-2.0 * bow, 1.5 * shake(frame, 0.7), 1.5 * look(8.0)).by([0.0, -1.2 * bow, 0.0]);
    moves[LOIN] = Move::degrees(3.0 * bow + 0.5 * breath, 2.0 * shake(frame, 0.5), -3.0 * look(6.0));
    moves[CHEST] = Move::degrees(-4.0 * bow - 0.9 * breath, 2.5 * shake(frame, 0.35), -4.0 * look(4.0));
    moves[NECK] = Move::degrees(-6.0 * bow + 2.0 * look(3.0), 4.0 * shake(frame, 0.2), -8.0 * look(3.0));
    moves[NAPE] = Move::degrees(-5.0 * bow + 0.6 * breath, 6.0 * shake(frame, 0.1), -10.0 * look(1.5));
    moves[HEAD] =
        Move::degrees(-3.0 * bow - 3.0 * look(0.0), 10.0 * shake(frame, 0.0) - 4.0 * look(0.0), -16.0 * look(0.0));
    for (side, sign) in [(0, 1.0), (1, -1.0)] {
        moves[EAR[side]] = Move::degrees(10.0 * bow, 8.0 * shake(frame, 0.05), -sign * 8.0 * look(2.0));
    }
    // The tail sweeps as a wave that runs to its tip.
    for (n, &joint) in TAIL.iter().enumerate() {
        let late = n as f64;
        let sweep = (TAU * (frame - 4.0 * late) / 44.0).sin() * eased(frame - 3.0 * late, 2.0, 26.0) * ends;
        let lift =
            keyed(&[(40.0 + 2.0 * late, 0.0), (64.0 + 2.0 * late, 1.0), (96.0 + 2.0 * late, 1.0), (124.0, 0.0)], frame);
        let wag = shake(frame, 0.8 + 0.07 * late);
        moves[joint] = Move::degrees(-5.0 * lift, 0.0, (5.5 + 1.5 * late) * sweep + 1.5 * wag);
    }
    // The legs give way as the body turns and bows, and the paws stay about where they are.
    for (leg, &[upper, lower]) in LEG.iter().enumerate() {
        let fore = leg < 2;
        let roll = if fore { -2.5 * shake(frame, 0.4) } else { -1.5 * shake(frame, 0.7) };
        let bend = if fore { 3.0 * bow } else { 4.0 * bow };
        moves[upper] = Move::degrees(if fore { 2.0 * bow } else { 2.0 + bend } * bow, roll, 0.0);
        moves[lower] = Move::degrees(if fore { 1.0 } else { -4.0 } * bow, 0.0, 0.0);
    }
    moves
}
