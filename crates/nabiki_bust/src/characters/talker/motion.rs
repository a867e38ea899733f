//! His motion: he says two phrases, nods at the end of one and smiles after the other.

use std::f64::consts::TAU;

use super::super::glb::RATE;
use super::super::rig::{Move, eased, keyed};
use super::{HEAD, JAW, JOINTS, NECK};

const LAST: usize = 120;
/// Phrases: first and last frame.
const PHRASES: [[f64; 2]; 2] = [[8.0, 46.0], [58.0, 92.0]];
/// Syllables per second.
const SYLLABLES: f64 = 3.3;

/// What the joints do in each frame, and the weights of smile and round lips.
pub(super) fn frames() -> (Vec<Vec<Move>>, [Vec<f32>; 2]) {
    let frames = || (0..=LAST).map(|frame| frame as f64);
    let weights = |of: fn(f64) -> f64| frames().map(|frame| of(frame) as f32).collect();
    (frames().map(pose).collect(), [weights(smile), weights(round)])
}

fn speaks(frame: f64) -> f64 {
    PHRASES.iter().map(|[from, to]| eased(frame, *from, from + 8.0) * (1.0 - eased(frame, to - 8.0, *to))).sum()
}

/// How far the jaw opens (degrees): syllables of uneven strength.
fn opens(frame: f64) -> f64 {
    let beat = TAU * SYLLABLES * frame / RATE;
    let stress = 1.0 + 0.45 * (0.37 * beat + 0.8).sin() + 0.25 * (0.61 * beat).sin();
    speaks(frame) * (4.2 * stress * 0.5 * (1.0 - beat.cos()) + 1.0)
}

fn smile(frame: f64) -> f64 {
    keyed(&[(84.0, 0.0), (98.0, 1.0), (108.0, 1.0), (120.0, 0.35)], frame)
}

fn round(frame: f64) -> f64 {
    let beat = TAU * SYLLABLES * frame / RATE;
    speaks(frame) * (0.5 + 0.5 * (0.5 * beat + 2.0).sin()) * 0.9
}

fn pose(frame: f64) -> Vec<Move> {
    let mut moves = vec![Move::NONE; JOINTS.len()];
    let begins = eased(frame, 0.0, 16.0);
    let sway = (TAU * frame / 76.0).sin() * begins;
    let tilt = (TAU * frame / 58.0 + 1.0).sin() * begins;
    let nod =
        keyed(&[(38.0, 0.0), (44.0, 1.0), (50.0, -0.2), (57.0, 0.0), (70.0, 0.0), (77.0, 0.6), (86.0, 0.0)], frame);
    let turn = keyed(&[(50.0, 0.0), (68.0, 1.0), (84.0, 1.0), (104.0, 0.0)], frame);
    moves[NECK] = Move::degrees(-3.0 * nod, 1.0 * tilt, 2.0 * sway - 8.0 * turn);
    moves[HEAD] = Move::degrees(-7.0 * nod + 1.2 * sway, 2.5 * tilt + 2.0 * turn, 3.0 * sway - 14.0 * turn);
    moves[JAW] = Move::degrees(-opens(frame), 0.0, 0.0);
    moves
}
