//! The free form through the frames: hair, and the carriers that move before it.

use std::sync::Arc;

use glam::Vec3;

use super::contact::PlacedBody;
use super::grid::Crowd;
use super::kernel::FreeState;
use super::packed::{Packed, Plan};
use crate::dynamics::row::{LANES, PointRow, Row};
use crate::dynamics::stability::{Named, unstable};
use crate::dynamics::state::{Header, Reader, Writer};
use crate::dynamics::sweep::{Pages, sweep};
use crate::dynamics::{Dynamics, FrameInput, VectorWidth};
use crate::error::SettingError;
use crate::field::Field;
use crate::free_form::FreeMotion;
use crate::strands::Strands;

/// Some hair, its carriers, and the frame that both are at.
#[derive(Clone, Debug)]
pub(in crate::dynamics) struct Runner {
    /// Shared by all clones.
    packed: Arc<Packed>,
    states: Vec<FreeState>,
    carriers: Option<Carriers>,
    /// Working memory for the bodies in one frame.
    bodies: Vec<PlacedBody>,
}

impl Runner {
    /// Bytes of a row of sixteen segments that so many aims lead.
    pub fn bytes_a_row(aims: usize) -> usize {
        Packed::BYTES_A_ROW + aims * size_of::<PointRow>()
    }

    /// Hair at rest in the given shape, whose settings have been checked. `known`: the same hair with other settings.
    pub fn new(
        strands: &Strands,
        dynamics: &Dynamics,
        free: &FreeMotion,
        known: Option<&Self>,
    ) -> Result<Self, SettingError> {
        let packed = Arc::new(Packed::new(strands, dynamics, free, known.map(|known| &*known.packed))?);
        let carriers = match &free.neighbours {
            None => None,
            Some(neighbours) => {
                let known = known.and_then(|known| known.carriers.as_ref()).map(|carriers| &carriers.hair);
                let known = known.filter(|known| known.strands == neighbours.carriers).map(|known| &*known.packed);
                Some(Carriers::new(Packed::new(&neighbours.carriers, dynamics, free, known)?, neighbours)?)
            }
        };
        let bodies = Vec::with_capacity(free.bodies.len() * free.form.steps() as usize);
        Ok(Self { states: packed.states(), packed, carriers, bodies })
    }

    /// Refuses a field under which this hair, or its carriers, cannot be stepped. `strands` are those that it was built
    /// from, `ids` their numbers.
    pub fn check_field(&self, strands: &Strands, ids: &[u32], field: &dyn Field) -> Result<(), SettingError> {
        self.packed.free.form.check_shares(field)?;
        let carriers = self.carriers.as_ref();
        if self.packed.is_stable(field) && carriers.is_none_or(|carriers| carriers.hair.packed.is_stable(field)) {
            return Ok(());
        }
        let mut hair = vec![Named { name: "strand", strands, ids }];
        hair.extend(carriers.map(|carriers| Named { name: "carrier", strands: &carriers.hair.strands, ids: &[] }));
        Err(unstable(&hair, self.dynamics(), field))
    }

    pub fn dynamics(&self) -> &Dynamics {
        self.packed.dynamics()
    }

    /// The carriers' grid in the current frame; none if hair feels no neighbours.
    pub fn crowd(&self) -> Option<&Crowd> {
        self.carriers.as_ref().map(|carriers| &carriers.crowd)
    }

    /// The strongest force under which this hair and its carriers can be stepped.
    pub fn strongest_force(&self) -> f32 {
        let of_carriers = self.carriers.as_ref().map(|carriers| carriers.hair.packed.strongest_force());
        self.packed.strongest_force().min(of_carriers.unwrap_or(f32::MAX))
    }

    /// Whether both share everything that does not change from frame to frame.
    pub fn is_clone_of(&self, of: &Self) -> bool {
        Arc::ptr_eq(&self.packed, &of.packed)
    }

    /// Takes the state of the same hair, even among other bodies or carriers. `headers` are its own and that of `of`; none for clones.
    pub fn set_state(&mut self, of: &Self, headers: Option<&(Header, Header)>, width: VectorWidth) {
        self.states.copy_from_slice(&of.states);
        if let (Some(carriers), Some(of)) = (&mut self.carriers, &of.carriers)
            && headers.is_none_or(|(own, other)| own.has_carriers_of(other))
        {
            carriers.hair.points.copy_from_slice(&of.hair.points);
            carriers.hair.states.copy_from_slice(&of.hair.states);
            if headers.is_none() {
                carriers.crowd.take(&of.crowd);
            }
        }
        if let Some((own, other)) = headers {
            self.settle_in(own, other, width);
        }
    }

    /// Call after states and points with other settings, of header `of`, have replaced its own.
    fn settle_in(&mut self, own: &Header, of: &Header, width: VectorWidth) {
        self.packed.hold(&mut self.states);
        if let Some(carriers) = &mut self.carriers {
            if own.has_carriers_of(of) {
                carriers.hair.packed.hold(&mut carriers.hair.states);
                carriers.fill(width);
            } else {
                carriers.rewind(width);
            }
        }
        if own.bodies != of.bodies {
            self.jumped();
        }
    }

    /// Identifies what it holds the state of.
    pub fn header(&self) -> Header {
        let carriers = self.carriers.as_ref().map(|carriers| &carriers.hair);
        let of_carriers = carriers.map_or(0, |hair| 3 * hair.points.len() + hair.states.len() * FreeState::NUMBERS);
        Header {
            is_free: true,
            numbers: (self.states.len() * FreeState::NUMBERS) as u64,
            of_carriers: of_carriers as u64,
            hair: self.packed.identity(),
            carriers: carriers.map_or(0, |hair| hair.packed.identity()),
            // Carriers may keep another distance from these than all hair that is here.
            bodies: self.packed.bodies_identity()
                ^ carriers.map_or(0, |hair| hair.packed.bodies_identity().rotate_left(1)),
            ..Header::default()
        }
    }

    /// Writes its state.
    pub fn write(&self, writer: &mut Writer) {
        writer.rows(self.states.iter().flat_map(FreeState::rows));
        if let Some(Carriers { hair, .. }) = &self.carriers {
            writer.points(&hair.points);
            writer.rows(hair.states.iter().flat_map(FreeState::rows));
        }
    }

    /// Takes a written state of the same hair, even among other bodies or carriers. `own`: its header.
    pub fn read(&mut self, reader: &mut Reader, own: &Header, width: VectorWidth) {
        reader.rows(self.states.iter_mut().flat_map(FreeState::rows_mut));
        if let Some(Carriers { hair, .. }) = &mut self.carriers
            && own.has_carriers_of(&reader.header)
        {
            reader.points(&mut hair.points);
            reader.rows(hair.states.iter_mut().flat_map(FreeState::rows_mut));
        }
        self.settle_in(own, &reader.header, width);
    }

    /// Forgets the distances of all segments from the bodies, so that the next step computes them.
    pub fn jumped(&mut self) {
        let of_carriers = self.carriers.iter_mut().flat_map(|carriers| &mut carriers.hair.states);
        for state in self.states.iter_mut().chain(of_carriers) {
            state.gap = Row([f32::NEG_INFINITY; LANES]);
        }
    }

    /// Puts the hair back to rest.
    pub fn rewind(&mut self, width: VectorWidth, page: &mut [Vec3]) {
        sweep(&*self.packed, &[self.packed.rest()], width, &mut self.states, Pages::Last(page));
        if let Some(carriers) = &mut self.carriers {
            carriers.rewind(width);
        }
    }

    /// Moves the hair by one frame, and the carriers in parallel.
    pub fn step(&mut self, input: &FrameInput, width: VectorWidth, page: &mut [Vec3]) {
        let Self { packed, states, carriers, bodies } = self;
        packed.bodies(input, bodies);
        let Some(carriers) = carriers else {
            let plan = packed.plan(input, bodies, None);
            return sweep(&**packed, &[plan], width, states, Pages::Last(page));
        };
        let Carriers { hair, crowd, next } = carriers;
        let plan = packed.plan(input, bodies, Some(crowd));
        // Writing the carriers' grid is sequential, so it begins first.
        rayon::join(
            || hair.step(input, bodies, width, crowd, next),
            || sweep(&**packed, &[plan], width, states, Pages::Last(page)),
        );
        std::mem::swap(crowd, next);
    }

    /// Moves the hair through many frames, the first of them rest if `from_rest`.
    pub fn run(&mut self, from_rest: bool, inputs: &[FrameInput], width: VectorWidth, pages: Pages) {
        let Self { packed, states, carriers, .. } = self;
        let bodies: Vec<Vec<PlacedBody>> = (inputs.iter())
            .map(|input| {
                let mut of_frame = Vec::new();
                packed.bodies(input, &mut of_frame);
                of_frame
            })
            .collect();
        let crowds: Vec<Crowd> = match carriers {
            None => Vec::new(),
            Some(carriers) => {
                if from_rest {
                    carriers.rewind(width);
                }
                let before = |(input, bodies): (&FrameInput, &Vec<PlacedBody>)| {
                    let Carriers { hair, crowd, next } = &mut *carriers;
                    hair.step(input, bodies, width, crowd, next);
                    std::mem::swap(crowd, next);
                    next.left()
                };
                inputs.iter().zip(&bodies).map(before).collect()
            }
        };
        let steps = inputs.iter().zip(&bodies).enumerate();
        let steps = steps.map(|(n, (input, bodies))| packed.plan(input, bodies, crowds.get(n)));
        let plans: Vec<Plan> = from_rest.then(|| packed.rest()).into_iter().chain(steps).collect();
        sweep(&**packed, &plans, width, states, pages);
    }
}

/// The strands that carry density and velocity, and their grid.
#[derive(Clone, Debug)]
struct Carriers {
    hair: CarrierHair,
    /// Their grid of the frame before.
    crowd: Crowd,
    /// Memory for their grid of this frame.
    next: Crowd,
}

#[derive(Clone, Debug)]
struct CarrierHair {
    /// At rest, as given.
    strands: Arc<Strands>,
    packed: Arc<Packed>,
    states: Vec<FreeState>,
    /// Their points, as computed by the step.
    points: Vec<Vec3>,
    velocities: Vec<Vec3>,
    crowd_at_rest: Arc<Crowd>,
}

impl Carriers {
    fn new(packed: Packed, neighbours: &crate::free_form::Neighbours) -> Result<Self, SettingError> {
        let (mut states, mut points) = (packed.states(), neighbours.carriers.points().to_vec());
        sweep(&packed, &[packed.rest()], VectorWidth::default(), &mut states, Pages::Last(&mut points));
        let crowd = Crowd::new(neighbours, packed.dynamics.motion.slow, &points)?;
        let velocities = vec![Vec3::ZERO; points.len()];
        let strands = neighbours.carriers.clone();
        let (packed, crowd_at_rest) = (Arc::new(packed), Arc::new(crowd.clone()));
        let hair = CarrierHair { strands, states, packed, points, velocities, crowd_at_rest };
        Ok(Self { hair, next: crowd.clone(), crowd })
    }

    fn rewind(&mut self, width: VectorWidth) {
        let Self { hair, crowd, next } = self;
        sweep(&*hair.packed, &[hair.packed.rest()], width, &mut hair.states, Pages::Last(&mut hair.points));
        crowd.take(&hair.crowd_at_rest);
        next.take(&hair.crowd_at_rest);
    }

    /// Recomputes the grid of carriers that were moved elsewhere.
    fn fill(&mut self, width: VectorWidth) {
        let Self { hair, crowd, .. } = self;
        sweep(&*hair.packed, &[Plan::Velocities], width, &mut hair.states, Pages::Last(&mut hair.velocities));
        crowd.fill(&hair.points, &hair.velocities);
    }
}

impl CarrierHair {
    /// Moves by one frame under the grid of the frame before, and writes the new grid to `next`.
    fn step(&mut self, input: &FrameInput, bodies: &[PlacedBody], width: VectorWidth, crowd: &Crowd, next: &mut Crowd) {
        let plan = self.packed.plan(input, bodies, Some(crowd));
        sweep(&*self.packed, &[plan], width, &mut self.states, Pages::Last(&mut self.points));
        sweep(&*self.packed, &[Plan::Velocities], width, &mut self.states, Pages::Last(&mut self.velocities));
        next.fill(&self.points, &self.velocities);
    }
}

#[cfg(test)]
mod tests;
