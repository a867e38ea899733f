//! Sources of the frames of a motion.

use std::path::Path;

use glam::Vec3;
use nabiki::Strands;
use nabiki::dynamics::{Form, Simulation, Stepper};
use nabiki::strands::not_finite;
use nabiki_io::cache::Reader;

use crate::built::BuiltScene;
use crate::error::{Error, Result};

/// Frames in order, from 0 on.
pub trait FrameSource {
    /// The strands of frame `n` (head space, cm); call it with ascending frames.
    ///
    /// # Errors
    /// What is wrong with the file that they come from.
    fn frame(&mut self, n: u32) -> Result<&Strands>;

    /// The file that they are read from, if any.
    fn file(&self) -> Option<&Path> {
        None
    }

    /// The box around the hair of the frames up to `last`, from the head's origin along the world's axes (cm), if it is
    /// known without reading them.
    fn bounds(&self, last: u32) -> Option<[Vec3; 2]> {
        let _ = last;
        None
    }
}

/// Frames from a simulation.
pub struct Simulated<'a, S = Simulation> {
    built: &'a BuiltScene,
    stepper: S,
}

impl<'a> Simulated<'a> {
    /// Simulates the scene with the fast stepper, from rest.
    ///
    /// # Errors
    /// A field too strong for the hair, or strands that cannot be moved.
    pub fn new(built: &'a BuiltScene) -> Result<Self> {
        Ok(Self { built, stepper: built.simulation()? })
    }

    /// The same motion again, from rest.
    pub fn again(&self) -> Self {
        Self { built: self.built, stepper: self.stepper.clone() }
    }
}

impl<'a, S: Stepper> Simulated<'a, S> {
    /// Simulates the scene with this stepper, which must be at rest.
    pub fn by(built: &'a BuiltScene, stepper: S) -> Self {
        Self { built, stepper }
    }
}

impl<S: Stepper> FrameSource for Simulated<'_, S> {
    fn frame(&mut self, n: u32) -> Result<&Strands> {
        while self.stepper.frame() < n {
            self.stepper.step_frame(&self.built.input(self.stepper.frame() + 1));
            if let Some(point) = not_finite(self.stepper.strands().points()) {
                return Err(flown_off(self.built, self.stepper.frame(), point));
            }
        }
        Ok(self.stepper.strands())
    }
}

/// The error about hair whose motion diverged.
fn flown_off(built: &BuiltScene, frame: u32, point: usize) -> Error {
    let neighbours = match &built.dynamics.form {
        Form::Free(free) => free.neighbours.as_ref(),
        Form::Paper => None,
    };
    let way_out = match neighbours.map(|neighbours| &neighbours.forces) {
        Some(forces) => format!(
            "the stability of neighbours.pressure cannot be checked in advance: lower neighbours.pressure = {}",
            forces.pressure
        ),
        None => "lower the strengths of the fields".to_owned(),
    };
    let scene = built.scene.file().display();
    Error::refused(format!(
        "{scene}: frame {frame}: the hair diverges: point {point} and perhaps others are no longer finite; {way_out}"
    ))
}

/// Frames from a motion cache.
pub struct Cached {
    reader: Reader,
    strands: Strands,
}

impl Cached {
    /// The frames of a cache of this scene.
    ///
    /// # Errors
    /// A cache of another scene, or with too few frames.
    pub fn of(built: &BuiltScene, cache: &Path) -> Result<Self> {
        let reader = Reader::open(cache)?;
        let (file, scene) = (cache.display(), built.scene.file().display());
        if let Some(piece) = &reader.header().piece {
            return Err(Error::refused(format!(
                "{file}: contains shard {} of a motion; join all shards with nabiki join and give the result",
                piece.shard
            )));
        }
        if reader.header().scene != built.identity()? {
            return Err(Error::refused(format!(
                "{file}: its motion was not made from {scene} as it is now; give the --strands and --set it was made with, \
                 or run nabiki simulate again"
            )));
        }
        let (last, given) = (u64::from(built.frames()), reader.frame_count());
        if given <= last {
            return Err(Error::refused(format!(
                "{file}: has {given} frames, but {scene} has {}; render fewer with --set motion.frames={}",
                last + 1,
                given.saturating_sub(1)
            )));
        }
        Ok(Self { strands: reader.header().strands(), reader })
    }
}

impl FrameSource for Cached {
    fn frame(&mut self, n: u32) -> Result<&Strands> {
        self.reader.read(n.into(), &mut self.strands)?;
        Ok(&self.strands)
    }

    fn file(&self) -> Option<&Path> {
        Some(self.reader.path())
    }

    fn bounds(&self, last: u32) -> Option<[Vec3; 2]> {
        self.reader.bounds().filter(|_| self.reader.frame_count() == u64::from(last) + 1)
    }
}
