//! The wind that is solved for, and what stands around it.

use std::fmt::Debug;
use std::sync::Arc;

use glam::{DVec3, Vec3};

use super::unknowns::{Guess, Layout, Unknown};
use crate::error::SettingError;
use crate::field::{Ease, Field, FieldSum, Gust, GustField, Keyframe, KeyframedField};

/// The wind whose vectors, borders and gusts may be unknown: keyframes, eased or not, and the gusts on them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct KeyedWind {
    /// The intervals. None: no wind yet; see [`with_interval`].
    pub keyframes: Vec<Keyframe>,
    /// From one vector to the next.
    pub ease: Ease,
    /// A random factor on all of them.
    pub gust: Option<Gust>,
}

impl KeyedWind {
    /// The field of it, as a scene has it. `frame_rate`: frames a second.
    ///
    /// # Errors
    /// Keyframes out of order and numbers that are none, but for no keyframes: those are no wind.
    pub fn field(&self, frame_rate: f64) -> Result<Arc<dyn Field>, SettingError> {
        if self.keyframes.is_empty() {
            return Ok(Arc::new(FieldSum::default()));
        }
        let keyframed = Arc::new(KeyframedField::new(&self.keyframes)?.eased(self.ease));
        match &self.gust {
            None => Ok(keyframed),
            Some(gust) => Ok(Arc::new(GustField::new(gust, keyframed, frame_rate)?)),
        }
    }
}

/// What makes of a wind, uniform in space, all that pushes the hair.
pub trait Surroundings: Debug + Send + Sync {
    /// All that pushes where this is the wind.
    ///
    /// # Errors
    /// A wind that cannot be made a field of.
    fn field(&self, wind: Arc<dyn Field>) -> Result<Arc<dyn Field>, SettingError>;

    /// The part of it that is linear in the wind, for this wind: the wind itself, or its way round the head. What else
    /// depends on the wind, as the drift of swirls, is held while tangents are taken.
    ///
    /// # Errors
    /// As [`field`](Self::field).
    fn of_wind(&self, wind: Arc<dyn Field>) -> Result<Arc<dyn Field>, SettingError>;
}

/// Nothing but the wind.
#[derive(Clone, Copy, Debug, Default)]
pub struct OpenAir;

impl Surroundings for OpenAir {
    fn field(&self, wind: Arc<dyn Field>) -> Result<Arc<dyn Field>, SettingError> {
        Ok(wind)
    }

    fn of_wind(&self, wind: Arc<dyn Field>) -> Result<Arc<dyn Field>, SettingError> {
        Ok(wind)
    }
}

/// The same keyframes with an interval of its own from frame `from` to `through`, both included, and its number. It
/// begins with the vector that was there at its first frame, or none: stepped, hair moves as before until a vector is
/// changed. Intervals that it covers wholly are gone.
///
/// # Panics
/// If `from` is 0 or after `through`.
pub fn with_interval(keyframes: &[Keyframe], from: u32, through: u32) -> (Vec<Keyframe>, usize) {
    assert!(0 < from && from <= through, "frames {from} to {through}");
    let at = |frame: u32| {
        let j = keyframes.partition_point(|key| key.through < frame);
        keyframes.get(j).or(keyframes.last()).map_or(Vec3::ZERO, |key| key.vector)
    };
    let mut cut: Vec<Keyframe> = keyframes.iter().copied().filter(|key| key.through < from).collect();
    if from > 1 && cut.last().is_none_or(|key| key.through < from - 1) {
        cut.push(Keyframe { through: from - 1, vector: at(from - 1) });
    }
    let new = cut.len();
    cut.push(Keyframe { through, vector: at(from) });
    cut.extend(keyframes.iter().copied().filter(|key| key.through > through));
    if cut.len() == new + 1 && through < u32::MAX {
        // What held for good goes on.
        cut.push(Keyframe { through: through + 1, vector: at(through + 1) });
    }
    (cut, new)
}

/// The wind of a guess, one vector a frame.
#[derive(Debug)]
pub(super) struct WindTable {
    /// From frame 1 on; the last one holds for good.
    vectors: Vec<Vec3>,
    strongest: f32,
}

/// Gusts by the frame, of intensity 1: what the wind is multiplied by is 1 and so many times the intensity.
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

    /// The wind that a guess means.
    pub fn table(&self, guess: &Guess) -> WindTable {
        let wind = |(n, gust): (usize, &f64)| ((1.0 + guess.gust * gust) * guess.track.vector(n as u32 + 1)).as_vec3();
        let strongest = guess.track.vectors.iter().map(|v| v.length()).fold(0.0, f64::max);
        WindTable {
            vectors: self.by_frame.iter().enumerate().map(wind).collect(),
            strongest: (strongest * (1.0 + guess.gust * self.largest)) as f32,
        }
    }

    /// How the wind of each frame, from 1 on, changes with each number of a layout.
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
    /// Of one vector a frame, from frame 1 on.
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

    fn key(through: u32, x: f32) -> Keyframe {
        Keyframe { through, vector: Vec3::new(x, 0.0, 0.0) }
    }

    #[test]
    fn a_new_interval_changes_no_frame() {
        let lists = [vec![key(10, 1.0), key(20, 2.0), key(30, 3.0)], vec![key(5, 4.0)], Vec::new()];
        for keys in &lists {
            for (from, through) in [(1, 3), (1, 30), (4, 12), (11, 20), (15, 40), (31, 50), (6, 6), (20, 21)] {
                let (cut, new) = with_interval(keys, from, through);
                let first = new.checked_sub(1).map_or(1, |before| cut[before].through + 1);
                assert_eq!((first, cut[new].through), (from, through), "{keys:?}");
                let before = |n| match keys.is_empty() {
                    true => Vec3::ZERO,
                    false => KeyframedField::new(keys).unwrap().vector(n),
                };
                let after = KeyframedField::new(&cut).unwrap();
                for n in (1..60).filter(|n| !(from..=through).contains(n)) {
                    assert_eq!(after.vector(n), before(n), "{keys:?} {from} {through} frame {n}");
                }
                assert!((from..=through).all(|n| after.vector(n) == before(from)));
            }
        }
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
