//! How the strands of a block modify the wind: see [`Own::wind`].

use crate::dynamics::row::{LANES, PointRow, Row, lane as lane_of, set_lane};
use crate::dynamics::trigonometry::sin_cos;
use crate::locks::{Own, Wave};
use crate::region::FieldShares;
use crate::vector::{add, cross, scale};

/// [`Own`] of every strand of a block.
#[derive(Clone, Debug)]
pub(super) struct OwnRow {
    share: Row,
    flutter: Row,
    rhythm: [[WaveRow; 2]; 4],
}

#[derive(Clone, Copy, Debug, Default)]
struct WaveRow {
    frequency: Row,
    phase: Row,
}

impl OwnRow {
    /// Lanes without a strand get a share of 1 and no flutter.
    pub fn of(strands: impl Iterator<Item = Own>) -> Self {
        let mut of = Self { share: Row([1.0; LANES]), flutter: Row::default(), rhythm: Default::default() };
        for (lane, own) in strands.enumerate() {
            (of.share.0[lane], of.flutter.0[lane]) = (own.share() as f32, own.flutter as f32);
            for (row, wave) in of.rhythm.as_flattened_mut().iter_mut().zip(own.rhythm.as_flattened()) {
                (row.frequency.0[lane], row.phase.0[lane]) = (wave.frequency, wave.phase);
            }
        }
        of
    }

    /// s and b of a frame.
    #[inline(always)]
    pub fn wind(&self, frame: u32) -> WindRow {
        let mut sums = [Row::default(); 4];
        for (sum, waves) in sums.iter_mut().zip(&self.rhythm) {
            for of in waves {
                for lane in 0..LANES {
                    let wave = Wave { frequency: of.frequency.0[lane], phase: of.phase.0[lane] };
                    sum.0[lane] += sin_cos(wave.angle(frame) as f32).0;
                }
            }
        }
        let mut wind = WindRow { scale: self.share, turn: PointRow::default() };
        for lane in 0..LANES {
            let flutter = self.flutter.0[lane];
            wind.scale.0[lane] *= flutter.mul_add(sums[0].0[lane], 1.0);
            let turn = [sums[1].0[lane], sums[2].0[lane], sums[3].0[lane]];
            set_lane(&mut wind.turn, lane, scale(flutter, turn));
        }
        wind
    }
}

/// The shares of the strands of a block in the fields that regions name, field by field. 1 without a strand.
#[derive(Clone, Debug)]
pub(super) struct SharesRow(Vec<Row>);

impl SharesRow {
    pub fn of(strands: impl Iterator<Item = FieldShares>, fields: usize) -> Self {
        let mut rows = vec![Row([1.0; LANES]); fields];
        for (lane, shares) in strands.enumerate() {
            rows.iter_mut().zip(shares.factors()).for_each(|(row, share)| row.0[lane] = share);
        }
        Self(rows)
    }

    /// In the field with this name, if it is one of those that regions name, in order.
    pub fn in_field(&self, field: &str, shared: &[String]) -> Option<[f32; LANES]> {
        shared.iter().zip(&self.0).find(|of| of.0 == field).map(|of| of.1.0)
    }
}

/// The effective force of the field in one frame: s (F + b x F).
pub(super) struct WindRow {
    scale: Row,
    turn: PointRow,
}

impl WindRow {
    #[inline(always)]
    pub fn take(&self, forces: &mut PointRow) {
        for lane in 0..LANES {
            let force = lane_of(forces, lane);
            let turned = add(force, cross(lane_of(&self.turn, lane), force));
            set_lane(forces, lane, scale(self.scale.0[lane], turned));
        }
    }
}
