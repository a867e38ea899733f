//! What pulls on hair besides the field, as the check of stability sees it: by name, and no stronger than so much.

/// A force on hair besides the field, as the check of stability sees it.
pub(super) trait Pull {
    /// What a refusal calls it.
    fn name(&self) -> Name;

    /// Its setting.
    fn setting(&self) -> f32;

    /// Its strongest force on a segment, in the unit of F.
    fn strongest(&self) -> f64;
}

/// What a refusal calls a pull.
#[derive(Clone, Copy, Debug)]
pub(super) struct Name {
    /// Its setting in a scene.
    pub setting: &'static str,
    /// The same in words.
    pub words: &'static str,
    /// Its term in the sum that must stay below 4.
    pub term: &'static str,
}
