//! The specification of the free form: one segment at a time, in f64, as docs/motion-forms.md writes it.

mod aimed;
mod chain;
mod common;
mod contact;
mod strand;

use glam::{DVec3, Vec3};

use super::grid::Crowd;
use crate::dynamics::air::Breeze;
use crate::dynamics::reference::publish;
use crate::dynamics::stability::check_field;
use crate::dynamics::{Dynamics, FrameInput, Stepper};
use crate::error::SettingError;
use crate::field::Field;
use crate::free_form::FreeMotion;
use crate::strands::Strands;

pub(super) use chain::{AFTER, AFTER_PRESSED, BEFORE, BENT, ROUNDS_PRESSED};
pub(in crate::dynamics) use common::Common;
pub(in crate::dynamics) use strand::{Springs, Strand};

/// The free form of [`Reference`](crate::dynamics::Reference).
#[derive(Clone, Debug)]
pub(in crate::dynamics) struct Reference {
    hair: Hair,
    /// The carriers, and their grid of the frame before.
    crowd: Option<(Hair, Crowd)>,
    frame: u32,
}

/// Some strands, and what moves them.
#[derive(Clone, Debug)]
struct Hair {
    dynamics: Dynamics,
    free: FreeMotion,
    hair: Vec<Strand<f64>>,
    positions: Vec<DVec3>,
    strands: Strands,
}

impl Reference {
    /// Hair at rest in the given shape, at frame 0, whose settings have been checked.
    ///
    /// # Errors
    /// Strands that cannot be moved, and a field too strong for the step.
    pub fn new(
        strands: &Strands,
        dynamics: &Dynamics,
        free: &FreeMotion,
        field: &dyn Field,
    ) -> Result<Self, SettingError> {
        let hair = Hair::new(strands, dynamics, free, field)?;
        let crowd = match &free.neighbours {
            None => None,
            Some(neighbours) => {
                let carriers = Hair::new(&neighbours.carriers, dynamics, free, field)?;
                let crowd = Crowd::new(neighbours, dynamics.motion.slow, carriers.strands.points())?;
                Some((carriers, crowd))
            }
        };
        Ok(Self { hair, crowd, frame: 0 })
    }

    pub fn positions(&self) -> &[DVec3] {
        &self.hair.positions
    }
}

impl Stepper for Reference {
    fn step_frame(&mut self, input: &FrameInput) {
        match &mut self.crowd {
            None => self.hair.step(input, None),
            Some((carriers, crowd)) => {
                self.hair.step(input, Some(crowd));
                carriers.step(input, Some(crowd));
                crowd.fill(carriers.strands.points(), &carriers.velocities());
            }
        }
        self.frame = input.frame;
    }

    fn frame(&self) -> u32 {
        self.frame
    }

    fn strands(&self) -> &Strands {
        &self.hair.strands
    }
}

impl Hair {
    fn new(strands: &Strands, dynamics: &Dynamics, free: &FreeMotion, field: &dyn Field) -> Result<Self, SettingError> {
        check_field(strands, dynamics, field)?;
        let springs = Springs::default();
        let hair = strands.iter().enumerate().map(|(s, strand)| Strand::new(dynamics, free, &springs, strand, s));
        let mut hair = Self {
            dynamics: dynamics.clone(),
            free: free.clone(),
            hair: hair.collect::<Result<_, _>>()?,
            positions: vec![DVec3::ZERO; strands.points().len()],
            strands: strands.clone(),
        };
        hair.publish();
        Ok(hair)
    }

    fn step(&mut self, input: &FrameInput, crowd: Option<&Crowd>) {
        let air = Breeze { input, space: self.dynamics.motion.force_space };
        let common = Common::new(&self.dynamics, &self.free, input);
        for strand in &mut self.hair {
            strand.step(&common, &air, crowd);
        }
        self.publish();
    }

    /// The motion of every point by the increments alone in a frame (cm).
    fn velocities(&self) -> Vec<Vec3> {
        let mut velocities = Vec::with_capacity(self.positions.len());
        self.hair.iter().for_each(|strand| velocities.extend(strand.velocities().map(|v| v.as_vec3())));
        velocities
    }

    fn publish(&mut self) {
        publish(self.hair.iter().flat_map(Strand::positions), &mut self.positions, &mut self.strands);
    }
}
