//! The aims that lead one strand.

use glam::{DVec3, Vec3};

use crate::aim::Lead;
use crate::free_form::FreeMotion;
use crate::skin::Skin;

/// The aims that lead one strand, with the directions of its segments at rest.
#[derive(Clone, Debug)]
pub(super) struct Aimed(Vec<(Lead, f64, Vec<DVec3>)>);

impl Aimed {
    pub fn of(free: &FreeMotion, strand: &[Vec3], skin: Option<&Skin>) -> Self {
        let led = free.aims.iter().filter_map(|aim| {
            let strength = free.weight_of(aim, strand[0]) * f64::from(aim.lead.strength);
            (strength > 0.0).then(|| (aim.lead, strength, aim.directions(strand, free.form.held(strand), skin)))
        });
        Self(led.collect())
    }

    /// The strengths of all in a frame together, in F.
    pub fn strength(&self, frame: u32) -> f64 {
        self.0.iter().map(|(lead, strength, _)| lead.part(frame) * strength).sum()
    }

    /// Where they lead a segment together, if any has a strength: the mean direction by their strengths.
    pub fn toward(&self, segment: usize, frame: u32) -> DVec3 {
        let mut acting = self.0.iter().filter(|(lead, ..)| lead.part(frame) > 0.0);
        match (acting.next(), acting.next()) {
            // The direction of a single aim keeps its bits.
            (Some((_, _, directions)), None) => directions[segment],
            _ => {
                let pull = |(lead, strength, directions): &(Lead, f64, Vec<DVec3>)| {
                    lead.part(frame) * strength * directions[segment]
                };
                self.0.iter().map(pull).sum::<DVec3>() / self.strength(frame)
            }
        }
    }
}
