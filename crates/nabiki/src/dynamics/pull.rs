//! What pulls on hair besides the field, as the check of stability sees it: by name, and no stronger than so much.

use super::gain::SegmentShape;

/// A force on hair besides the field, as the check of stability sees it.
pub(super) trait Pull {
    /// What a refusal calls it.
    fn name(&self) -> Name;

    /// Its setting, or the largest number of that.
    fn setting(&self) -> f32;

    /// Whether that setting has other numbers, which go down with the largest.
    fn has_others(&self) -> bool {
        false
    }

    /// The steepest slope of its force on a segment, in the unit of F a radian. `next`: the segment after it.
    fn strongest(&self, segment: &SegmentShape, next: Option<&SegmentShape>) -> f64;
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
