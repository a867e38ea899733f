//! Aims: shapes that hair is led to in some frames, whatever the wind does.
//!
//! An aim gives each segment a direction and pulls it there as hold pulls it to its groomed one. What it asks of a strand
//! depends only on that strand, so a preview follows the aims as all the hair does.

mod curves;

use std::sync::Arc;

use glam::{DQuat, DVec3, Vec3};

use crate::error::SettingError;
use crate::setting::{Place, refused};
use crate::settings;
use crate::skin::{Skin, SkinPlace};
use crate::smoothing::rise;

pub use curves::AimCurves;

settings! {
    /// How strongly an aim leads hair, and when.
    #[derive(Copy)]
    pub struct Lead where ends_after_it_begins {
        /// Strength of the pull, in F: a limp strand settles along the sum of this in the direction of the aim and all
        /// other forces.
        pub strength: f32 = 300.0 => "Strength", least 0.0, most 1e9;
        /// First frame of the full strength.
        pub from: u32 = 0 => "From", unit "frame";
        /// Last frame of the full strength. Without it, the aim never ends.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub through: Option<u32> = None => "Through", unit "frame", open "the end";
        /// Number of frames before `from` in which the strength rises from 0.
        pub ease_in: u32 = 12 => "Ease in", unit "frames", most 1e6;
        /// Number of frames after `through` in which the strength falls to 0.
        pub ease_out: u32 = 12 => "Ease out", unit "frames", most 1e6;
    }
}

impl Lead {
    /// The share of the strength in a frame: 1 from `from` through `through`, 0 beyond the frames of ease, and
    /// 3 t^2 - 2 t^3 between.
    pub fn part(&self, frame: u32) -> f64 {
        let eased = |away: u32, over: u32| {
            if away > over { 0.0 } else { rise(1.0 - f64::from(away) / (f64::from(over) + 1.0)) }
        };
        match self.through {
            _ if frame < self.from => eased(self.from - frame, self.ease_in),
            Some(through) if frame > through => eased(frame - through, self.ease_out),
            _ => 1.0,
        }
    }

    fn ends_after_it_begins(&self, at: &Place) -> Result<(), SettingError> {
        match self.through.filter(|&through| through < self.from) {
            Some(through) => {
                let remedy = format!("must not be before `from`, which is {}", self.from);
                refused(&at.key("through"), through, remedy)
            }
            None => Ok(()),
        }
    }

    /// The same with `ratio` times as many frames.
    pub(crate) fn times(&self, ratio: f64) -> Self {
        let frames = |count: u32| (f64::from(count) * ratio).round() as u32;
        Self {
            from: frames(self.from),
            through: self.through.map(frames),
            ease_in: frames(self.ease_in),
            ease_out: frames(self.ease_out),
            ..*self
        }
    }
}

/// What leads hair in some frames. Free form only.
#[derive(Clone, Debug, PartialEq)]
pub struct Aim {
    /// Name of the aim in errors, such as `aim[0]`.
    pub name: String,
    /// How strongly, and when.
    pub lead: Lead,
    /// The index of the region that it leads, in [`FreeForm::regions`](crate::free_form::FreeForm::regions). `None` is
    /// all hair.
    pub region: Option<usize>,
    /// Where to.
    pub shape: AimShape,
}

/// The shape that an aim leads hair to.
#[derive(Clone, Debug, PartialEq)]
pub enum AimShape {
    /// The hair at rest.
    Groom,
    /// A straight line from the root, or the end of what a tie holds, toward this point (head space at rest, cm).
    Toward(Vec3),
    /// The directions of curves that begin near the strand.
    Curves(Arc<AimCurves>),
}

impl Aim {
    /// Refuses settings out of range, and a region that is not among `regions`.
    pub(crate) fn check(&self, regions: usize) -> Result<(), SettingError> {
        self.lead.check_at(&self.name)?;
        let key = |key: &str| format!("{}.{key}", self.name);
        match (self.region, &self.shape) {
            (Some(region), _) if region >= regions => {
                Err(SettingError::new(key("region"), region, format!("there are {regions} regions: count from 0")))
            }
            (_, AimShape::Toward(point)) if !point.is_finite() => {
                Err(SettingError::new(key("toward"), point, "every coordinate must be a finite number"))
            }
            _ => Ok(()),
        }
    }

    /// The same with `ratio` times as many frames.
    pub(crate) fn times(&self, ratio: f64) -> Self {
        let shape = match &self.shape {
            AimShape::Curves(curves) => AimShape::Curves(Arc::new(curves.times(ratio))),
            shape => shape.clone(),
        };
        Self { lead: self.lead.times(ratio), shape, ..self.clone() }
    }

    /// The direction of each segment of a strand at rest (head space, cm), of length 1, before the skin turns it.
    /// `held`: how many of its segments a tie holds.
    pub(crate) fn directions(&self, strand: &[Vec3], held: usize, skin: Option<&Skin>) -> Vec<DVec3> {
        let rest = || strand.windows(2).map(|ends| (ends[1].as_dvec3() - ends[0].as_dvec3()).normalize());
        match &self.shape {
            AimShape::Groom => rest().collect(),
            AimShape::Toward(point) => {
                let way = (point.as_dvec3() - strand[held].as_dvec3()).try_normalize();
                rest().map(|rest| way.unwrap_or(rest)).collect()
            }
            AimShape::Curves(curves) => {
                let posed = skin.zip(curves.frame()).map(|(skin, frame)| (skin.place(strand[0]), skin.at(frame)));
                let turn = posed.as_ref().map_or(DQuat::IDENTITY, |(place, frame)| place.turn(frame));
                let root = posed.map_or(strand[0].as_dvec3(), |(place, frame): (SkinPlace, _)| place.root(frame));
                let mut directions = curves.directions(root, strand);
                if turn != DQuat::IDENTITY {
                    directions.iter_mut().for_each(|direction| *direction = turn.inverse() * *direction);
                }
                directions
            }
        }
    }
}

/// How much the aims of a strand add to the drag of its nodes (1 per frame), for a sum of strengths: so much that a
/// strand led by them alone comes to rest without swinging. `swing`: see [`swing`].
pub(crate) fn calming(swing: f64, strength: f64) -> f64 {
    2.0 * (swing * strength).sqrt()
}

/// The square of the rate (1 per frame^2) at which a strand of this length swings about an aim of strength 1: a rod on
/// a hinge, with the moment of a force on all of it and a third of its mass at its end.
pub(crate) fn swing(push: f64, length: f64) -> f64 {
    1.5 * push / length
}

#[cfg(test)]
mod tests;
