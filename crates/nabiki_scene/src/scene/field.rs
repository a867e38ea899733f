//! Where forces come from. The file's spelling of the one source there is, the paper's vectors, is `[[force]]`.

use nabiki::SettingError;
use nabiki::field::{Keyframe, KeyframedField};

/// A source of force. Sources add up.
#[derive(Clone, Debug, PartialEq)]
pub enum FieldSource {
    /// Vectors uniform in space, each over some frames: equation (5). Keys: `[[force]]`.
    Keyframes(Vec<Keyframe>),
}

/// The keyframes among `sources`.
///
/// # Errors
/// More than one list of them.
pub(super) fn keyframes(sources: &[FieldSource]) -> Result<&[Keyframe], SettingError> {
    match sources {
        [] => Ok(&[]),
        [FieldSource::Keyframes(keyframes)] => Ok(keyframes),
        lists => Err(SettingError::new("force", format!("{} lists", lists.len()), "a scene has one list of keyframes")),
    }
}

/// The field that `sources` make.
///
/// # Errors
/// No force at all, or keyframes that are no field.
pub(super) fn build(sources: &[FieldSource]) -> Result<KeyframedField, SettingError> {
    let keyframes = keyframes(sources)?;
    if keyframes.is_empty() {
        return Err(SettingError::new("force", "none", "give at least one [[force]] with through and vector"));
    }
    KeyframedField::new(keyframes)
}
