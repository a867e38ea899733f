//! The state of strands of the specification at a frame. Up to the frame in which an unknown is first felt nothing
//! changes, so repeated solves need not step from rest each time.

use glam::Vec3;
use rayon::prelude::*;

use super::air::Breeze;
use super::free::{self, Crowd, Springs};
use super::paper::{self, PolarAxis};
use super::{Dynamics, Form, FrameInput, Timeline};
use crate::error::SettingError;
use crate::field::Field;
use crate::free_form::{FreeMotion, Neighbours};
use crate::pose::Pose;
use crate::strands::Strands;

/// Some strands, and their motion.
pub(crate) struct Moved<'a> {
    pub strands: &'a Strands,
    /// Their numbers in the larger set.
    pub ids: &'a [u32],
    pub dynamics: &'a Dynamics,
    pub poses: &'a [Pose],
    /// Their state at the last frame before any unknown is felt; none: at rest.
    pub standing: Option<&'a Standing>,
    /// The carriers' grid in that frame and all after it; none if the specification steps them, too.
    pub crowds: Option<&'a Crowds>,
}

impl Moved<'_> {
    /// The frame from which they continue.
    pub(super) fn from(&self) -> u32 {
        self.standing.map_or(0, |standing| standing.frame)
    }
}

/// Strands at a frame.
#[derive(Clone, Debug)]
pub(crate) struct Standing {
    pub(super) frame: u32,
    pub(super) hair: Standings,
}

/// The strands, by form of their motion.
#[derive(Clone, Debug)]
pub(super) enum Standings {
    Paper(Vec<paper::Strand<f64>>),
    Free(Vec<free::Strand<f64>>),
}

/// The carriers' grids in some frames, by the fast stepper.
#[derive(Clone, Debug)]
pub(crate) struct Crowds(pub(super) Vec<Crowd>);

impl Crowds {
    /// From the timeline's current frame to the one before `last`, to which it goes; none if hair feels no neighbours.
    pub fn of(timeline: &mut Timeline, last: u32) -> Option<Self> {
        let mut left = Vec::new();
        while timeline.frame() < last {
            left.push(timeline.crowd()?.left());
            timeline.advance();
        }
        Some(Self(left))
    }
}

impl Standing {
    /// Takes strands from rest to a frame. `timeline`: their fast motion in this field, at rest; it provides the carriers' grids.
    ///
    /// # Errors
    /// Strands that cannot be moved.
    pub fn at(frame: u32, moved: &Moved, field: &dyn Field, mut timeline: Timeline) -> Result<Self, SettingError> {
        let Moved { strands, ids, dynamics, poses, .. } = *moved;
        let inputs: Vec<FrameInput> = (1..=frame).map(|n| FrameInput::new(n, poses, field)).collect();
        let air = |input| Breeze { input, space: dynamics.motion.force_space };
        let each = strands.iter().enumerate();
        let hair = match &dynamics.form {
            Form::Paper => {
                let polar_from_head = PolarAxis::new(dynamics.polar_axis).polar_from_head();
                let common = paper::Common { gamma: dynamics.gamma(), polar_from_head };
                let new = |(s, strand)| paper::Strand::new(dynamics, &common, strand, s);
                let mut hair = each.map(new).collect::<Result<Vec<_>, _>>()?;
                hair.par_iter_mut().zip(ids).for_each(|(strand, &id)| {
                    for input in &inputs {
                        let disturbance = dynamics.disturbance.as_ref();
                        let part = disturbance.and_then(|of| Some((of, of.part(input.frame)?)));
                        let turn = part.map(|(of, part)| of.turn(id, &part).map(f64::from));
                        let skin = dynamics.skin.as_ref().map(|skin| skin.at(input.frame));
                        strand.step(&common, &air(input), turn, skin);
                    }
                });
                Standings::Paper(hair)
            }
            Form::Free(free) => {
                let springs = Springs::default();
                let new = |(s, strand)| free::Strand::new(dynamics, free, &springs, strand, s);
                let mut hair = each.map(new).collect::<Result<Vec<_>, _>>()?;
                if free.neighbours.is_none() {
                    let settings: Vec<_> =
                        inputs.iter().map(|input| free::Common::new(dynamics, free, input)).collect();
                    hair.par_iter_mut().for_each(|strand| {
                        for (input, common) in inputs.iter().zip(&settings) {
                            strand.step(common, &air(input), None);
                        }
                    });
                } else {
                    for input in &inputs {
                        let (common, left) = (free::Common::new(dynamics, free, input), timeline.crowd());
                        hair.par_iter_mut().for_each(|strand| strand.step(&common, &air(input), left));
                        timeline.advance();
                    }
                }
                Standings::Free(hair)
            }
        };
        Ok(Self { frame, hair })
    }
}

/// The carriers at rest, and their grid.
pub(super) fn carriers_at_rest(
    dynamics: &Dynamics,
    free: &FreeMotion,
    neighbours: &Neighbours,
) -> Result<(Vec<free::Strand<f64>>, Crowd), SettingError> {
    let springs = Springs::default();
    let new = |(s, strand)| free::Strand::<f64>::new(dynamics, free, &springs, strand, s);
    let carriers = neighbours.carriers.iter().enumerate().map(new).collect::<Result<Vec<_>, _>>()?;
    let mut points = vec![Vec3::ZERO; neighbours.carriers.points().len()];
    let mut velocities = points.clone();
    collect(&carriers, &mut points, &mut velocities);
    let crowd = Crowd::new(neighbours, dynamics.motion.slow, &points)?;
    Ok((carriers, crowd))
}

/// Points and velocities of all carriers, one after another.
pub(super) fn collect(carriers: &[free::Strand<f64>], points: &mut [Vec3], velocities: &mut [Vec3]) {
    let all = carriers.iter().flat_map(|strand| strand.positions().iter().zip(strand.velocities()));
    for (((p, v), point), velocity) in all.zip(points).zip(velocities) {
        (*point, *velocity) = (p.value().as_vec3(), v.as_vec3());
    }
}
