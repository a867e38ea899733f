//! The aims of a block of strands, for the fast step.

use std::cell::RefCell;

use super::kernel::{FrameRow, NONE, ZERO};
use super::segment::{FreeSegment, swing_of};
use super::work::Work;
use crate::aim::Lead;
use crate::dynamics::row::{LANES, PointRow, Row, lane as lane_of, set_lane};
use crate::free_form::FreeMotion;
use crate::skin::Skin;
use crate::strands::Strands;
use crate::vector::{add, scale};

/// The aims that lead strands of a block.
#[derive(Clone, Debug)]
pub(super) struct AimedBlock {
    /// The moment per radian of an aim of strength 1, for each segment.
    levers: Vec<Row>,
    /// See [`swing`](crate::aim::swing).
    swing: Row,
    aims: Vec<AimedRows>,
}

/// One of them.
#[derive(Clone, Debug)]
struct AimedRows {
    lead: Lead,
    /// Its strength in F where it is in full force, by how much the strand belongs to its region.
    strengths: Row,
    /// For each segment, its direction.
    directions: Vec<PointRow>,
}

/// Where all aims together lead a segment of every strand: a vector of length 1 if there is one aim, and the moment per
/// radian toward it.
#[derive(Clone, Copy, Debug)]
pub(super) struct AimRow {
    pub toward: PointRow,
    pub hold: Row,
}

impl AimRow {
    const NONE: Self = Self { toward: ZERO, hold: NONE };
}

impl AimedBlock {
    /// Of strands of the block with these numbers; `None` if no aim leads them. `rows`: segments of the longest.
    pub fn of(
        free: &FreeMotion,
        strands: &Strands,
        first: usize,
        segments: &[Vec<FreeSegment>],
        rows: usize,
        skin: Option<&Skin>,
    ) -> Option<Self> {
        let mut of = Self { levers: vec![NONE; rows], swing: NONE, aims: Vec::new() };
        for aim in free.aims.iter().filter(|aim| aim.lead.strength > 0.0) {
            let mut led = AimedRows { lead: aim.lead, strengths: NONE, directions: vec![ZERO; rows] };
            for (lane, segments) in segments.iter().enumerate() {
                let strand = strands.strand(first + lane);
                let weight = free.weight_of(aim, strand[0]);
                if weight == 0.0 {
                    continue;
                }
                led.strengths.0[lane] = (weight * f64::from(aim.lead.strength)) as f32;
                let directions = aim.directions(strand, free.form.held(strand), skin);
                for (row, direction) in led.directions.iter_mut().zip(directions) {
                    set_lane(row, lane, direction.as_vec3().to_array());
                }
                for (lever, segment) in of.levers.iter_mut().zip(segments) {
                    lever.0[lane] = segment.lever as f32;
                }
                of.swing.0[lane] = swing_of(segments) as f32;
            }
            if led.strengths.0.iter().any(|&strength| strength > 0.0) {
                of.aims.push(led);
            }
        }
        (!of.aims.is_empty()).then_some(of)
    }

    /// Whether any of them acts in a frame.
    pub fn acts(&self, frame: u32) -> bool {
        self.aims.iter().any(|aim| aim.lead.part(frame) > 0.0)
    }

    /// Where they lead in a frame. `from_rest`: the turn of the skin, if it moves.
    #[inline(always)]
    pub fn lead(&self, frame: u32, from_rest: Option<&FrameRow>, rows: &mut [AimRow]) {
        rows.fill(AimRow::NONE);
        for aim in &self.aims {
            let part = aim.lead.part(frame) as f32;
            if part == 0.0 {
                continue;
            }
            for (row, directions) in rows.iter_mut().zip(&aim.directions) {
                for lane in 0..LANES {
                    let (before, strength) = (row.hold.0[lane], part * aim.strengths.0[lane]);
                    let direction = lane_of(directions, lane);
                    let both = before + strength;
                    let mixed = add(scale(before, lane_of(&row.toward, lane)), scale(strength, direction));
                    // The direction of a single aim keeps its bits.
                    let toward = if before > 0.0 { scale(1.0 / both, mixed) } else { direction };
                    if strength > 0.0 {
                        set_lane(&mut row.toward, lane, toward);
                        row.hold.0[lane] = both;
                    }
                }
            }
        }
        for (row, lever) in rows.iter_mut().zip(&self.levers) {
            for lane in 0..LANES {
                row.hold.0[lane] *= lever.0[lane];
            }
            if let Some(turn) = from_rest {
                row.toward = turn.of(&row.toward);
            }
        }
    }

    /// Slows the nodes of the strands that are led in a frame.
    #[inline(always)]
    pub fn calm(&self, frame: u32, work: &mut [Work]) {
        let mut strengths = NONE;
        for aim in &self.aims {
            let part = aim.lead.part(frame) as f32;
            for lane in 0..LANES {
                strengths.0[lane] = part.mul_add(aim.strengths.0[lane], strengths.0[lane]);
            }
        }
        let mut calming = Row::default();
        for lane in 0..LANES {
            calming.0[lane] = 2.0 * (self.swing.0[lane] * strengths.0[lane]).sqrt();
        }
        for work in work {
            for lane in 0..LANES {
                work.drag.0[lane] += calming.0[lane];
            }
        }
    }
}

thread_local! {
    static ROOM: RefCell<Vec<AimRow>> = const { RefCell::new(Vec::new()) };
}

/// Takes this thread's memory, for this many segments; [`keep`] returns it. Its contents are stale.
#[inline(always)]
pub(super) fn room(segments: usize) -> Vec<AimRow> {
    let mut room = ROOM.with(RefCell::take);
    if room.len() < segments {
        room.resize(segments, AimRow::NONE);
    }
    room
}

/// Gives it back.
#[inline(always)]
pub(super) fn keep(room: Vec<AimRow>) {
    ROOM.with(|of_thread| of_thread.replace(room));
}
