//! In the place of the reader, where it is not built in: every file is refused.

use glam::Vec3;
use nabiki::Mesh;

use super::Outline;
use crate::error::{Error, Result};
use crate::motion::{ClipMover, HeadMotion, MotionSource};

fn refused<T>() -> Result<T> {
    let line = "this program was built without FBX: build it with the feature fbx, or export glTF, USD or Alembic";
    Err(Error::new(line))
}

pub(crate) fn outline(_: &[u8]) -> Result<Outline> {
    refused()
}

pub(crate) fn mesh(_: &[u8], _: &[String]) -> Result<(Mesh, Vec<String>)> {
    refused()
}

pub(crate) fn groups(_: &[u8]) -> Result<Vec<(String, usize)>> {
    refused()
}

pub(crate) fn bends(_: &[u8], _: &[String], _: &str) -> Result<bool> {
    refused()
}

pub(crate) fn each_bent(
    _: &[u8],
    _: &[String],
    _: &str,
    _: &[f64],
    _: &mut dyn FnMut(usize, Vec<Vec3>) -> Result<()>,
) -> Result<()> {
    refused()
}

pub(crate) fn head_motion(_: &MotionSource, _: &[u8], _: f64) -> Result<HeadMotion> {
    refused()
}

pub(crate) fn mover(_: &[u8], _: &[String], _: &dyn Fn(Vec3) -> bool) -> Result<Option<ClipMover>> {
    refused()
}

pub(crate) fn carries(_: &[u8], _: &str, _: &[String]) -> Result<bool> {
    refused()
}
