//! The wind of a list of numbers, frame by frame, with gusts.

use std::sync::Arc;

use glam::{DVec3, Vec3};

use super::unknowns::{Guess, Layout, Unknown};
use crate::error::SettingError;
use crate::field::{Field, FieldSum, Gust, GustField};

/// The wind of a guess, one vector per frame.
#[derive(Debug)]
pub(super) struct WindTable {
    /// From frame 1 on; the last one holds after that.
    vectors: Vec<Vec3>,
    strongest: f32,
}

/// Gusts per frame, of intensity 1: the factor on the wind is 1 plus this times the intensity.
#[derive(Clone, Debug)]
pub(super) struct Gusts {
    /// From frame 1 on.
    by_frame: Vec<f64>,
    largest: f64,
}

impl Gusts {
    pub fn new(gust: Option<&Gust>, frame_rate: f64, frames: u32) -> Result<Self, SettingError> {
        let Some(gust) = gust else { return Ok(Self { by_frame: vec![0.0; frames as usize], largest: 0.0 }) };
        let unit = Gust { intensity: 1.0, ..gust.clone() };
        let field = GustField::new(&unit, Arc::new(FieldSum::default()), frame_rate)?;
        let by_frame = (1..=frames).map(|n| f64::from(field.factor(n)) - 1.0).collect();
        Ok(Self { by_frame, largest: f64::from(field.largest_factor()) - 1.0 })
    }

    /// The wind of a guess.
    pub fn table(&self, guess: &Guess) -> WindTable {
        let wind = |(n, gust): (usize, &f64)| ((1.0 + guess.gust * gust) * guess.track.vector(n as u32 + 1)).as_vec3();
        let strongest = guess.track.vectors.iter().map(|v| v.length()).fold(0.0, f64::max);
        WindTable {
            vectors: self.by_frame.iter().enumerate().map(wind).collect(),
            strongest: (strongest * (1.0 + guess.gust * self.largest)) as f32,
        }
    }

    /// The derivative of each frame's wind, from 1 on, by each number of a layout.
    pub fn by_number(&self, guess: &Guess, layout: &Layout) -> Vec<Vec<DVec3>> {
        let of_frame = |(n, gust): (usize, &f64)| {
            let frame = n as u32 + 1;
            let factor = 1.0 + guess.gust * gust;
            let mut by_number = vec![DVec3::ZERO; layout.numbers];
            for &(unknown, at) in &layout.unknowns {
                match unknown {
                    Unknown::Vector(vector) => guess.track.parts(frame, |j, part| {
                        if j == vector {
                            for (axis, along) in DVec3::AXES.into_iter().enumerate() {
                                by_number[at + axis] += factor * part * along;
                            }
                        }
                    }),
                    Unknown::Border(j) => by_number[at] = factor * guess.track.by_border(frame, j),
                    Unknown::Gust => by_number[at] = *gust * guess.track.vector(frame),
                    Unknown::Stiffness | Unknown::Settle => {}
                }
            }
            by_number
        };
        self.by_frame.iter().enumerate().map(of_frame).collect()
    }
}

impl WindTable {
    /// For one vector per frame, from frame 1 on.
    pub fn of(vectors: impl Iterator<Item = DVec3>) -> Self {
        let vectors: Vec<Vec3> = vectors.map(|v| v.as_vec3()).collect();
        let strongest = vectors.iter().map(|v| v.length()).fold(0.0, f32::max);
        Self { vectors, strongest }
    }

    fn vector(&self, frame: u32) -> Vec3 {
        let n = (frame.max(1) - 1) as usize;
        self.vectors.get(n).or(self.vectors.last()).copied().unwrap_or_default()
    }
}

impl Field for WindTable {
    fn at(&self, _point: Vec3, frame: u32) -> Vec3 {
        self.vector(frame)
    }

    fn strongest(&self) -> f32 {
        self.strongest
    }

    fn uniform(&self, frame: u32) -> Option<Vec3> {
        Some(self.vector(frame))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::field::{Ease, Keyframe};
    use crate::solve::KeyedWind;

    fn key(through: u32, x: f32) -> Keyframe {
        Keyframe { through, vector: Vec3::new(x, 0.0, 0.0) }
    }

    #[test]
    fn gusts_of_a_guess_are_those_of_a_scene() {
        let keyframes = vec![key(10, 50.0), key(40, -80.0)];
        let gust = Gust { intensity: 0.37, ..Gust::default() };
        let wind = KeyedWind { keyframes, ease: Ease::Smooth, gust: Some(gust) };
        let scene = wind.field(24.0).unwrap();
        let layout = Layout { unknowns: Vec::new(), numbers: 0 };
        let table = Gusts::new(wind.gust.as_ref(), 24.0, 60).unwrap().table(&layout.guess(&wind, &[]));
        for n in 1..=60 {
            let (a, b) = (table.vector(n), scene.at(Vec3::ZERO, n));
            assert!(a.distance(b) < 1e-3, "{n}: {a} {b}");
        }
        assert!((table.strongest() - scene.strongest()).abs() < 1e-2);
    }
}
