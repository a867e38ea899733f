//! The motion up to the frame in which an unknown first has an effect.

use glam::DVec3;

use crate::dynamics::{Stability, Timeline, check_field};
use crate::error::SettingError;
use crate::solve::aims::Aims;
use crate::solve::problem::Problem;
use crate::strands::Strands;

/// The state of a problem's hair in a frame. Solvers whose unknowns act later can start there.
#[derive(Clone, Debug)]
pub struct Preroll {
    pub(super) timeline: Timeline,
    /// Positions of the spots observed up to that frame.
    pub(super) early: Vec<DVec3>,
    /// The strands in wishes, with their numbers.
    pub(super) strands: Strands,
    pub(super) ids: Vec<u32>,
}

impl Preroll {
    /// Goes to a frame in the unchanged wind of the problem, but not beyond the last frame of a wish.
    ///
    /// # Errors
    /// As for [`Solver::new`](super::Solver::new).
    pub fn new(problem: &Problem, frame: u32) -> Result<Self, SettingError> {
        let aims = Aims::new(problem)?;
        let steady = Stability::of(&problem.hair, &problem.dynamics)?;
        let frame = frame.min(aims.frames().last().copied().unwrap_or(1));
        Self::onward(problem, &aims, &steady, None, frame)
    }

    /// Goes to a frame in the wind of the problem, from its known state if that is not later.
    pub(super) fn onward(
        problem: &Problem,
        aims: &Aims,
        steady: &Stability,
        known: Option<&Self>,
        until: u32,
    ) -> Result<Self, SettingError> {
        let Problem { hair, ids, dynamics, poses, wind, surroundings, .. } = problem;
        let field = surroundings.field(wind.field(dynamics.motion.frame_rate)?)?;
        if !steady.holds(&*field) {
            check_field(hair, dynamics, &*field)?;
        }
        let known = known.filter(|known| known.timeline.frame() <= until);
        let mut preroll = match known {
            Some(known) => {
                let mut known = known.clone();
                known.timeline.set_field_onward(field)?;
                known
            }
            None => {
                let strands = hair.select(&aims.strands);
                let ids: Vec<u32> = aims.strands.iter().map(|&s| ids[s]).collect();
                let last = aims.frames().last().copied().unwrap_or(1);
                let poses =
                    if poses.is_empty() { Vec::new() } else { poses[..poses.len().min(last as usize + 1)].to_vec() };
                let timeline = Timeline::with_ids(&strands, &ids, dynamics, field, poses, last)?;
                let early = vec![DVec3::ZERO; aims.spots.len()];
                Self { timeline, early, strands, ids }
            }
        };
        look(aims, until, &mut preroll.timeline, &mut preroll.early);
        preroll.timeline.seek(until);
        Ok(preroll)
    }
}

/// Takes a timeline to the last observed frame, up to `until`, and records the positions of all spots on the way.
pub(super) fn look(aims: &Aims, until: u32, timeline: &mut Timeline, places: &mut [DVec3]) {
    let begin = timeline.frame();
    for frame in aims.frames().into_iter().filter(|&frame| frame > begin && frame <= until) {
        let strands = timeline.seek(frame);
        for (spot, place) in aims.spots.iter().zip(&mut *places).filter(|(spot, _)| spot.frame == frame) {
            *place = strands.strand(spot.strand)[spot.node].as_dvec3();
        }
    }
}
