//! In the place of the codec, where it is not built in.

use super::Planes;

/// Whether there is a codec.
pub const IS_BUILT_IN: bool = false;

/// There is none.
pub enum Codec {}

impl Codec {
    pub fn new(_: u8, _: f64) -> Result<Self, String> {
        Err("built without the feature video".to_owned())
    }

    pub fn code(&mut self, _: [usize; 2], _: &Planes, _: &mut Vec<u8>) -> Result<(), String> {
        match *self {}
    }
}
