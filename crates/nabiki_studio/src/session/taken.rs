//! What a setting takes along, in its own step of undo: settings that nobody thinks of who changes it, and without which no scene would
//! be right. All begin from the scene before the drag, so that a drag back takes them back.

use nabiki_groom::Style;
use nabiki_scene::Scene;
use nabiki_scene::scene::{FormChoice, HairSource};

/// Most segments that hair is given.
const MOST_SEGMENTS: f64 = 1000.0;
/// Shortest segment that hair is given (cm).
const SHORTEST: f32 = 0.01;

/// Height of a clump's wave to its length, at most.
const STEEPEST: f32 = 0.16;

/// How it is said.
pub(super) const TAKEN: &str = "Also changed: ";

/// What hair takes with another style: the segments of its length, and shorter ones for its curls. Returns it in words, each with why; shorter and straighter hair stays as it is, to the bit.
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
            taken.push(format!("hair.style.curl.pitch is now {} (at least the radius)", curl.pitch));
        }
    }
    if key == "hair.style.curl.pitch" {
        curl.radius = curl_before.radius.min(curl.pitch);
        if curl.radius != curl_before.radius {
            taken.push(format!("hair.style.curl.radius is now {} (at most the pitch)", curl.radius));
        }
    }
    if key != "hair.segment_length" {
        let longest = curl.longest_segment().filter(|longest| *longest >= SHORTEST);
        let length = longest.map_or(length_before, |longest| length_before.min(longest));
        scene.hair.segment_length = length;
        if length != length_before {
            // How stiff hair shall be is left to the hand.
            let softer = if scene.form == FormChoice::Free {
                "; free.stiffness counts segments, so the hair gets softer"
            } else {
                ""
            };
            taken.push(format!("hair.segment_length is now {length} cm (curls need shorter segments{softer})"));
        }
    }
    let had = grown_before.segments;
    // As exact as grooming is about it.
    let takes = (f64::from(longest(&grown.style)) / f64::from(scene.hair.segment_length) * (1.0 - 1e-5)).ceil();
    // What no strand can have is refused as it stands.
    let takes = if takes <= MOST_SEGMENTS { takes as usize } else { had };
    grown.segments = had.max(takes);
    if takes > had {
        taken.push(format!("hair.segments is now {takes} (the longest strand needs that many)"));
    }
    taken
}

/// What one of two takes that must not be more than the other: waves of clumps no steeper than they may be, hair at rest held by no less than
/// hair that slides. In words, each with why.
pub(super) fn by_pair(scene: &mut Scene, before: &Scene, key: &str) -> Vec<String> {
    let mut taken = Vec::new();
    if let (HairSource::Grown(grown), Some(grown_before)) = (&mut scene.hair.source, before.hair.grown()) {
        let (clumps, had) = (&mut grown.style.clumps, &grown_before.style.clumps);
        if key == "hair.style.clumps.wave" && clumps.wave.is_finite() {
            clumps.wave_length = had.wave_length;
            if clumps.wave > STEEPEST * had.wave_length {
                clumps.wave_length = (clumps.wave / STEEPEST * 1e3).ceil() / 1e3 + 1e-3;
                let why = "a steeper wave would fold the hair back";
                taken.push(format!("hair.style.clumps.wave_length is now {} ({why})", clumps.wave_length));
            }
        }
        if key == "hair.style.clumps.wave_length" && clumps.wave_length > 0.0 {
            let most = STEEPEST * clumps.wave_length;
            clumps.wave = had.wave.min(most).min((most * 1e3).floor() / 1e3);
            if clumps.wave != had.wave {
                let why = "a steeper wave would fold the hair back";
                taken.push(format!("hair.style.clumps.wave is now {} ({why})", clumps.wave));
            }
        }
    }
    let mut pair = |name: &str, sliding: &mut f32, at_rest: &mut f32, had: [f32; 2]| {
        if key == format!("{name}.friction") {
            *at_rest = had[1].max(*sliding);
            if *at_rest != had[1] {
                taken.push(format!("{name}.static_friction is now {at_rest} (at least the friction)"));
            }
        } else if key == format!("{name}.static_friction") {
            *sliding = had[0].min(*at_rest);
            if *sliding != had[0] {
                taken.push(format!("{name}.friction is now {sliding} (at most the static friction)"));
            }
        }
    };
    let (now, had) = (&mut scene.contact, before.contact);
    pair("contact", &mut now.friction, &mut now.static_friction, [had.friction, had.static_friction]);
    for (i, (now, had)) in scene.bodies.iter_mut().zip(&before.bodies).enumerate() {
        let had = [had.friction, had.static_friction];
        pair(&format!("body[{i}]"), &mut now.friction, &mut now.static_friction, had);
    }
    taken
}

/// Length of the longest strand of a style (cm).
fn longest(style: &Style) -> f32 {
    let of = &style.length;
    let fringe = if style.fringe.half_width > 0.0 { of.fringe } else { 0.0 };
    of.top.max(of.sides).max(of.back).max(fringe)
}

#[cfg(test)]
#[path = "taken_tests.rs"]
mod tests;
