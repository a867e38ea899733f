//! What pulls on hair besides the field, for the stability check: a name and a bound.

/// A force on hair besides the field, for the stability check.
pub(super) trait Pull {
    /// Its names in an error.
    fn name(&self) -> Name;

    /// Its setting.
    fn setting(&self) -> f32;

    /// Its strongest force on a segment, in the unit of F.
    fn strongest(&self) -> f64;
}

/// The names of a pull in an error.
#[derive(Clone, Copy, Debug)]
pub(super) struct Name {
    /// Its setting in a scene.
    pub setting: &'static str,
    /// Its name in words.
    pub words: &'static str,
    /// Its term in the sum that must stay below 4.
    pub term: &'static str,
}
