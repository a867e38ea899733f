//! What has followed another setting without being asked to: hair whose file has no unit of its own grows with its head.

use glam::Vec3;
use nabiki::Mesh;

use super::Session;
use crate::take::Take;

/// Sizes that differ by less than this share are the same.
const SAME: f32 = 0.005;

/// How it is said.
const FOLLOWED: &str = "The head is ";

/// How large a head is, and how long its hair (cm).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sizes {
    head: f32,
    hair: f32,
}

impl Sizes {
    fn of(take: &Take) -> Self {
        Self { head: height(&take.built.model.head.mesh), hair: longest(take) }
    }

    /// What has become of both since, in one line; nothing where the head is as large as it was.
    fn until(self, now: Self, follows: bool) -> Option<String> {
        let times = ratio(self.head, now.head)?;
        let head = format!("{FOLLOWED}{} now, {} high", in_words(times), cm(now.head));
        let hair = match ratio(self.hair, now.hair) {
            None => format!("the hair keeps its length, {} at the longest", cm(now.hair)),
            Some(of_hair) => {
                let why = if follows {
                    "its file has no unit and uses the head's; set hair.unit to change that"
                } else {
                    "its settings have changed, too"
                };
                let (was, is) = (cm(self.hair), cm(now.hair));
                format!("the hair is {}, from {was} to {is} at the longest ({why})", in_words(of_hair))
            }
        };
        Some(format!("{head}; {hair}"))
    }
}

impl Session {
    /// Says what a head that is the same file and has another size now has done to the hair, until it has its size again.
    pub(super) fn say_what_followed(&mut self, now: &Take) {
        let Some(before) = self.take.clone() else { return };
        let (old, new) = (&before.built.scene, &now.built.scene);
        if old.head == new.head || old.head.mesh() != new.head.mesh() {
            return;
        }
        let is_said = self.words.iter().any(|word| word.text.starts_with(FOLLOWED));
        let from = self.sizes.filter(|_| is_said).unwrap_or_else(|| Sizes::of(&before));
        self.words.retain(|word| !word.text.starts_with(FOLLOWED));
        self.sizes = Some(from);
        if let Some(text) = from.until(Sizes::of(now), old.hair == new.hair) {
            self.say(text, true);
        }
    }
}

/// By how much the second is larger, where it is.
fn ratio(was: f32, is: f32) -> Option<f32> {
    let times = is / was;
    (times.is_finite() && times > 0.0 && (times - 1.0).abs() > SAME).then_some(times)
}

fn in_words(times: f32) -> String {
    let number = |times: f32| {
        let digits = if times < 10.0 { 2 } else { 0 };
        let text = format!("{times:.digits$}");
        if digits > 0 { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
    };
    if times > 1.0 {
        format!("{} times as large", number(times))
    } else {
        format!("{} times smaller", number(1.0 / times))
    }
}

fn cm(length: f32) -> String {
    if length < 10.0 { format!("{length:.2} cm") } else { format!("{length:.0} cm") }
}

fn height(mesh: &Mesh) -> f32 {
    let nothing = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    let (low, high) = mesh.positions.iter().fold(nothing, |(low, high), &p| (low.min(p), high.max(p)));
    (high - low).y
}

/// The longest strand at hand (cm).
fn longest(take: &Take) -> f32 {
    let strands = take.strands();
    let length = |s: usize| take.points(0)[strands.range(s)].windows(2).map(|pair| pair[0].distance(pair[1])).sum();
    (0..take.at_hand()).map(length).fold(0.0, f32::max)
}

#[cfg(test)]
#[path = "followed_tests.rs"]
mod tests;
