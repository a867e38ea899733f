//! The aims that lead one strand.

use glam::{DVec3, Vec3};

use crate::aim::{Lead, calming};
use crate::dynamics::free::segment::{FreeSegment, swing_of};
use crate::free_form::FreeMotion;
use crate::skin::Skin;

/// The aims that lead one strand.
#[derive(Clone, Debug)]
pub(super) struct Aimed {
    aims: Vec<Led>,
    /// See [`swing`](crate::aim::swing).
    swing: f64,
}

/// One of them.
#[derive(Clone, Debug)]
struct Led {
    lead: Lead,
    /// Its strength in F where it is in full force, by how much the strand belongs to its region.
    strength: f64,
    /// Of each segment at rest.
    directions: Vec<DVec3>,
}

impl Aimed {
    pub fn of(free: &FreeMotion, strand: &[Vec3], segments: &[FreeSegment], skin: Option<&Skin>) -> Self {
        let led = free.aims.iter().filter_map(|aim| {
            let strength = free.weight_of(aim, strand[0]) * f64::from(aim.lead.strength);
            let directions = || aim.directions(strand, free.form.held(strand), skin);
            (strength > 0.0).then(|| Led { lead: aim.lead, strength, directions: directions() })
        });
        Self { aims: led.collect(), swing: swing_of(segments) }
    }

    /// The strengths of all in a frame together, in F.
    pub fn strength(&self, frame: u32) -> f64 {
        self.aims.iter().map(|led| led.lead.part(frame) * led.strength).sum()
    }

    /// What they add to the drag of its nodes in a frame (1 per frame).
    pub fn calming(&self, frame: u32) -> f64 {
        calming(self.swing, self.strength(frame))
    }

    /// Where they lead a segment together, if any has a strength: the mean direction by their strengths.
    pub fn toward(&self, segment: usize, frame: u32) -> DVec3 {
        let mut acting = self.aims.iter().filter(|led| led.lead.part(frame) > 0.0);
        match (acting.next(), acting.next()) {
            // The direction of a single aim keeps its bits.
            (Some(led), None) => led.directions[segment],
            _ => {
                let pull = |led: &Led| led.lead.part(frame) * led.strength * led.directions[segment];
                self.aims.iter().map(pull).sum::<DVec3>() / self.strength(frame)
            }
        }
    }
}
