//! The specification: projective equations one segment at a time, in f64, as the paper writes them.

mod strand;

use glam::DVec3;

use super::polar::PolarAxis;
use crate::dynamics::air::Breeze;
use crate::dynamics::reference::publish;
use crate::dynamics::ride::skin_frames;
use crate::dynamics::stability::check_field;
use crate::dynamics::{Dynamics, FrameInput, Stepper};
use crate::error::SettingError;
use crate::field::Field;
use crate::strands::Strands;

pub(in crate::dynamics) use strand::{Common, Strand};

/// The paper's form of [`Reference`](crate::dynamics::Reference).
#[derive(Clone, Debug)]
pub(in crate::dynamics) struct Reference {
    dynamics: Dynamics,
    common: Common,
    hair: Vec<Strand<f64>>,
    ids: Vec<u32>,
    frame: u32,
    positions: Vec<DVec3>,
    strands: Strands,
}

impl Reference {
    pub fn new(strands: &Strands, ids: &[u32], dynamics: &Dynamics, field: &dyn Field) -> Result<Self, SettingError> {
        check_field(strands, dynamics, field)?;
        let common =
            Common { gamma: dynamics.gamma(), polar_from_head: PolarAxis::new(dynamics.polar_axis).polar_from_head() };
        let hair = strands.iter().enumerate().map(|(s, strand)| Strand::new(dynamics, &common, strand, s));
        let mut reference = Self {
            dynamics: dynamics.clone(),
            hair: hair.collect::<Result<_, _>>()?,
            common,
            ids: ids.to_vec(),
            frame: 0,
            positions: vec![DVec3::ZERO; strands.points().len()],
            strands: strands.clone(),
        };
        reference.publish();
        Ok(reference)
    }

    pub fn positions(&self) -> &[DVec3] {
        &self.positions
    }

    fn publish(&mut self) {
        publish(self.hair.iter().flat_map(Strand::positions), &mut self.positions, &mut self.strands);
    }
}

impl Stepper for Reference {
    fn step_frame(&mut self, input: &FrameInput) {
        let air = Breeze { input, space: self.dynamics.motion.force_space };
        let disturbance = self.dynamics.disturbance.as_ref();
        let part = disturbance.and_then(|disturbance| Some((disturbance, disturbance.part(input.frame)?)));
        let skin = skin_frames(&self.dynamics, input).map(|[now, ..]| now);
        for (strand, &id) in self.hair.iter_mut().zip(&self.ids) {
            let disturbed = part.as_ref().map(|(disturbance, part)| disturbance.turn(id, part).map(f64::from));
            strand.step(&self.common, &air, disturbed, skin);
        }
        self.frame = input.frame;
        self.publish();
    }

    fn frame(&self) -> u32 {
        self.frame
    }

    fn strands(&self) -> &Strands {
        &self.strands
    }
}
