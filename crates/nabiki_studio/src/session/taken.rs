//! What a setting takes along, in its own step of undo: settings that nobody thinks of who changes it, and without which no scene would
//! be right. All begin from the scene before the drag, so that a drag back takes them back.

use nabiki::groom::Style;
use nabiki::profile::Profile;
use nabiki_scene::Scene;
use nabiki_scene::scene::{FormChoice, HairSource};

/// Most segments that hair is given.
const MOST_SEGMENTS: f64 = 1000.0;
/// Shortest segment that hair is given (cm).
const SHORTEST: f32 = 0.01;
/// Largest stiffness that hair is given.
const STIFFEST: f32 = 1e7;

/// How it is said.
pub(super) const TAKEN: &str = "Taken along: ";

/// What hair takes with another style: the segments of its length, shorter ones for its curls, and the stiffness with which those bend
/// as the ones before. Returns it in words, each with why; shorter and straighter hair stays as it is, to the bit.
pub(super) fn by_hair(scene: &mut Scene, before: &Scene, key: &str) -> Vec<String> {
    let mut taken = Vec::new();
    let length_before = before.hair.segment_length;
    let HairSource::Grown(grown) = &mut scene.hair.source else { return taken };
    let Some(grown_before) = before.hair.grown() else { return taken };
    if !key.starts_with("hair.") || key == "hair.segments" {
        return taken;
    }
    let (curl, curl_before) = (&mut grown.style.curl, &grown_before.style.curl);
    if key == "hair.style.curl.radius" {
        curl.pitch = curl_before.pitch.max(curl.radius);
        if curl.pitch != curl_before.pitch {
            taken.push(format!("hair.style.curl.pitch is {} (a turn is no lower than its radius)", curl.pitch));
        }
    }
    if key == "hair.style.curl.pitch" {
        curl.radius = curl_before.radius.min(curl.pitch);
        if curl.radius != curl_before.radius {
            taken.push(format!("hair.style.curl.radius is {} (no wider than a turn is high)", curl.radius));
        }
    }
    if key != "hair.segment_length" {
        let longest = curl.longest_segment().filter(|longest| *longest >= SHORTEST);
        let length = longest.map_or(length_before, |longest| length_before.min(longest));
        scene.hair.segment_length = length;
        let is_free = scene.form == FormChoice::Free;
        // The bend of hair is as long as the root of its stiffness, counted in segments.
        let stiffness = times(&before.free.stiffness, (length_before / length).powi(2));
        if length != length_before {
            taken.push(format!("hair.segment_length is {length} cm (shorter ones draw the curls)"));
        }
        if is_free && length != length_before && stiffness.largest() <= STIFFEST {
            let values: Vec<String> = stiffness.values().iter().map(f32::to_string).collect();
            taken.push(format!("free.stiffness is {} (hair bends as before)", values.join(", ")));
            scene.free.stiffness = stiffness;
        } else if is_free {
            scene.free.stiffness = before.free.stiffness.clone();
        }
    }
    let had = grown_before.segments;
    // As exact as grooming is about it.
    let takes = (f64::from(longest(&grown.style)) / f64::from(scene.hair.segment_length) * (1.0 - 1e-5)).ceil();
    // What no strand can have is refused as it stands.
    let takes = if takes <= MOST_SEGMENTS { takes as usize } else { had };
    grown.segments = had.max(takes);
    if takes > had {
        taken.push(format!("hair.segments is {takes} (as many as the longest strand takes)"));
    }
    taken
}

/// Length of the longest strand of a style (cm).
fn longest(style: &Style) -> f32 {
    let of = &style.length;
    let fringe = if style.fringe.half_width > 0.0 { of.fringe } else { 0.0 };
    of.top.max(of.sides).max(of.back).max(fringe)
}

fn times(profile: &Profile, factor: f32) -> Profile {
    if factor == 1.0 {
        return profile.clone();
    }
    // Three digits are finer than anybody sees.
    let times = |value: &f32| {
        let value = value * factor;
        let digits = 10.0_f32.powf((value.abs().max(1e-6).log10().floor() - 2.0).max(0.0));
        (value / digits).round() * digits
    };
    match profile {
        Profile::Even(value) => Profile::Even(times(value)),
        Profile::RootToTip(values) => Profile::RootToTip(values.iter().map(times).collect()),
    }
}

#[cfg(test)]
#[path = "taken_tests.rs"]
mod tests;
