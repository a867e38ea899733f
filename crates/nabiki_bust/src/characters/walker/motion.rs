//! Her motion: she stands, walks, looks over her right shoulder, stops and nods.

use std::f64::consts::TAU;

use super::super::glb::RATE;
use super::super::rig::{Move, eased, eased_way, keyed};
use super::{ARM, CHEST, COLLAR, HEAD, JOINTS, NECK, SPINE};

const LAST: usize = 144;
/// Two steps (per second), and the way of both (cm).
const STRIDES: f64 = 0.9;
const STRIDE: f64 = 130.0;
/// Frames in which she starts and stops.
const STARTS: [f64; 2] = [6.0, 30.0];
const STOPS: [f64; 2] = [100.0, 126.0];

pub(super) fn frames() -> Vec<Vec<Move>> {
    (0..=LAST).map(|frame| pose(frame as f64)).collect()
}

fn pose(frame: f64) -> Vec<Move> {
    let walks = eased(frame, STARTS[0], STARTS[1]) - eased(frame, STOPS[0], STOPS[1]);
    let seconds = eased_way(frame, STARTS[0], STARTS[1]) - eased_way(frame, STOPS[0], STOPS[1]);
    let forward = STRIDES * STRIDE * seconds / RATE;
    let phase = TAU * STRIDES * (frame - STARTS[0]) / RATE;
    let (step, twice) = (phase.sin(), (2.0 * phase).cos());

    // She begins to turn with the eyes, so the head leads and neck and chest follow.
    let look =
        |late: f64| keyed(&[(44.0 + late, 0.0), (60.0 + late, 1.0), (72.0 + late, 1.0), (90.0 + late, 0.0)], frame);
    let nod = keyed(&[(118.0, 0.0), (125.0, 1.0), (132.0, -0.25), (138.0, 0.35), (144.0, 0.0)], frame);

    let mut moves = vec![Move::NONE; JOINTS.len()];
    let bob = -1.7 * twice * walks;
    moves[0] = Move::degrees(-2.0 * walks, 2.2 * step * walks, 4.0 * step * walks).by([
        forward + 0.6 * (2.0 * phase).sin() * walks,
        bob,
        1.8 * step * walks,
    ]);
    // The chest turns against the pelvis.
    moves[SPINE] = Move::degrees(0.6 * twice * walks, -1.8 * step * walks, -5.0 * step * walks - 3.0 * look(3.0));
    moves[CHEST] = Move::degrees(0.8 * twice * walks, -1.6 * step * walks, -4.5 * step * walks - 9.0 * look(3.0));
    let steady = 4.0 * step * walks;
    moves[NECK] = Move::degrees(-2.0 * nod - 0.5 * twice * walks, 0.4 * step * walks, 0.5 * steady - 20.0 * look(1.0));
    moves[HEAD] = Move::degrees(
        1.5 * walks - 13.0 * nod - 0.9 * twice * walks - 3.0 * look(0.0),
        0.4 * step * walks + 4.0 * look(0.0),
        0.5 * steady - 30.0 * look(0.0),
    );
    for (side, sign) in [(0, 1.0), (1, -1.0)] {
        // The arm of the side whose foot is behind swings forward.
        let swing = sign * (phase - 0.25).sin() * walks;
        moves[COLLAR[side]] = Move::degrees(0.0, -sign * (1.2 * twice + 0.6) * walks, 3.0 * sign * swing);
        moves[ARM[side]] = Move::degrees(15.0 * swing + 3.0 * walks, 0.0, 0.0);
    }
    moves
}
