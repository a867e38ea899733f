//! Settings that change nothing: hair does not feel them, no picture shows them, or another replaces them.

use glam::Vec3;
use nabiki::body::Contact;
use nabiki::field::{EnvelopeKey, KeyframedField, Turbulence, envelope};
use nabiki::pseudo_force::PseudoForce;
use nabiki_groom::style::Variation;
use nabiki_render::settings::{Antialiasing, Camera, HairLook, HeadLook, Picture, Projection, Shading};

use super::{Advice, Fix};
use crate::scene::{FieldSettings, FormChoice, FreeSettings, Scene};

/// Settings that are given and change nothing.
pub(crate) fn unused(scene: &Scene) -> Vec<Advice> {
    let said = scene.replaced().chain([uncut(scene), too_late(scene)].into_iter().flatten()).chain(silent(scene));
    let said = said.map(Advice::new);
    let moving = unfelt(scene).into_iter().chain(idle(scene)).chain(true_of(field(&scene.field))).chain(said);
    moving.chain(of_pictures(scene)).collect()
}

/// The same for what is only seen: all that matters for a picture of existing motion.
pub(crate) fn of_pictures(scene: &Scene) -> impl Iterator<Item = Advice> {
    true_of(camera(&scene.picture.camera)).chain(true_of(picture(scene)))
}

/// The lines whose condition is true.
fn true_of(lines: Vec<(bool, &'static str)>) -> impl Iterator<Item = Advice> {
    let of_line = |(changes_nothing, line): (bool, &str)| changes_nothing.then(|| Advice::new(line));
    lines.into_iter().filter_map(of_line)
}

/// Tables of the free form, which the paper's form ignores.
fn unfelt(scene: &Scene) -> Option<Advice> {
    if scene.form == FormChoice::Free {
        return None;
    }
    let tables = [
        (scene.free != FreeSettings::default(), "[free]"),
        (scene.contact != Contact::default(), "[contact]"),
        (scene.bodies.iter().any(|body| body.solid), "[[body]]"),
        (!scene.aims.is_empty(), "[[aim]]"),
        (scene.neighbours.is_some(), "[neighbours]"),
    ];
    let given: Vec<&str> = tables.into_iter().filter(|&(given, _)| given).map(|(_, table)| table).collect();
    if given.is_empty() {
        return None;
    }
    let seen = format!("hair does not feel {} in the paper's form", given.join(", "));
    Some(Advice { seen, fixes: vec![Fix { key: "motion.form", value: "\"free\"".to_owned() }] })
}

/// What hair of the free form does not feel, and bodies that are neither felt nor seen.
fn idle(scene: &Scene) -> Vec<Advice> {
    let mut seen = Vec::new();
    let given = scene.pseudo_force != PseudoForce::default();
    if scene.form == FormChoice::Free && given && !scene.free.pseudo_force {
        let fix = Fix { key: "free.pseudo_force", value: "true".to_owned() };
        seen.push(Advice { seen: "hair does not feel [pseudo_force] in the free form".to_owned(), fixes: vec![fix] });
    }
    for i in (0..scene.bodies.len()).filter(|&i| !scene.bodies[i].solid && !scene.bodies[i].shown) {
        let line = format!("body[{i}] changes nothing: it is neither solid nor shown");
        seen.push(Advice::new(line));
    }
    seen
}

/// Variation of a cut that is not made.
fn uncut(scene: &Scene) -> Option<String> {
    let style = &scene.hair.grown()?.style;
    let idle = style.cuts.is_empty() && style.variation.cut != Variation::default().cut;
    idle.then(|| "hair.style.variation.cut changes nothing: there are no hair.style.cuts".to_owned())
}

/// The last frame; infinite if an override sets it, because whoever tries fewer frames knows that some are left out.
fn last_frame(scene: &Scene) -> u32 {
    if scene.is_overridden("motion.frames") { u32::MAX } else { scene.motion.frames.max(1) }
}

/// Intervals after the last frame.
fn too_late(scene: &Scene) -> Option<String> {
    let (force, last) = (&scene.field.force, last_frame(scene));
    let wind = KeyframedField::new(&scene.field.as_given()).ok()?.eased(scene.field.wind.ease);
    // After a new interval that ends with the last frame, a solver leaves one frame of the interval that was there.
    let late = |&j: &usize| wind.first_felt(j) > last && force[j].through != last.saturating_add(1);
    let j = (0..force.len()).find(late)?;
    let change = if j + 1 == force.len() { "changes" } else { "and what comes after it change" };
    let first = wind.first_felt(j);
    Some(format!(
        "force[{j}] {change} nothing: it is first felt in frame {first}, but the last frame is motion.frames = {last}"
    ))
}

/// Fields whose envelope is 0.
fn silent(scene: &Scene) -> impl Iterator<Item = String> {
    let FieldSettings { turbulence, point, vortex, fan, .. } = &scene.field;
    let named = |kind: &str, i: usize| format!("{kind}[{i}]");
    let turbulence = turbulence.iter().map(|field| ("[turbulence]".to_owned(), &field.envelope));
    let points = point.iter().enumerate().map(move |(i, field)| (named("point", i), &field.envelope));
    let vortices = vortex.iter().enumerate().map(move |(i, field)| (named("vortex", i), &field.envelope));
    let fans = fan.iter().enumerate().map(move |(i, field)| (named("fan", i), &field.envelope));
    let last = last_frame(scene);
    let all = turbulence.chain(points).chain(vortices).chain(fans);
    let silent = all.filter(move |(_, envelope)| is_silent(envelope, last));
    silent.map(|(name, _)| format!("{name} changes nothing: its envelope is 0 in all frames"))
}

/// Whether an envelope is 0 in the frames from 1 through `last`. It is straight between keys, so the frames at and next
/// to them suffice.
fn is_silent(keys: &[EnvelopeKey], last: u32) -> bool {
    let beside = |key: &EnvelopeKey| [key.frame.saturating_sub(1), key.frame, key.frame.saturating_add(1)];
    let mut frames = keys.iter().flat_map(beside).chain([1, last]);
    !keys.is_empty() && frames.all(|frame| envelope(keys, frame.clamp(1, last)) == 0.0)
}

/// Whether each of these lines is true for the field.
fn field(settings: &FieldSettings) -> Vec<(bool, &'static str)> {
    let still = settings.force.iter().all(|key| key.vector == Vec3::ZERO);
    let no_wind = still && settings.body_wind.is_none();
    let turbulence = settings.turbulence.as_ref();
    vec![
        (settings.gust.is_some() && still, "[gust] changes nothing: the vectors of all [[force]] are 0"),
        (settings.flow.is_some() && no_wind, "[flow] changes nothing: the vectors of all [[force]] are 0"),
        (
            turbulence.is_some_and(|t| t.drift != Turbulence::default().drift && no_wind),
            "turbulence.drift changes nothing: there is no wind for swirls to drift with",
        ),
    ]
}

/// The same for the camera.
fn camera(camera: &Camera) -> Vec<(bool, &'static str)> {
    let perspective = camera.projection == Projection::Perspective;
    let framed = if perspective { camera.distance.is_some() } else { camera.height.is_some() };
    vec![
        (
            camera.focus_distance.is_some() && camera.f_stop.is_none(),
            "picture.camera.focus_distance changes nothing: without picture.camera.f_stop everything is sharp",
        ),
        (
            camera.height.is_some() && perspective,
            "picture.camera.height changes nothing in perspective: give picture.camera.distance or fov, or projection = \
             \"orthographic\"",
        ),
        (
            camera.fov != Camera::default().fov && !perspective,
            "picture.camera.fov changes nothing in orthographic views: give picture.camera.height",
        ),
        (
            camera.margin != Camera::default().margin && framed,
            "picture.camera.margin changes nothing: distance or height sets how much is visible",
        ),
    ]
}

/// The same for the look.
fn picture(scene: &Scene) -> Vec<(bool, &'static str)> {
    let picture = &scene.picture;
    let (hair, head) = (&picture.hair, &picture.head);
    let (usual, skin) = (HairLook::default(), HeadLook::default());
    let papers = hair.shading == Shading::KajiyaKay;
    // Bodies are lit like the head.
    let no_skin = !head.visible && !scene.bodies.iter().any(|body| body.shown);
    let unlike = head.sheen != skin.sheen || head.softness != skin.softness;
    vec![
        (
            picture.samples != Picture::default().samples && picture.antialiasing != Antialiasing::Oversample,
            "picture.samples changes nothing: it needs picture.antialiasing = \"oversample\"",
        ),
        (
            papers && (hair.scale_tilt != usual.scale_tilt || hair.refraction != usual.refraction),
            "picture.hair.scale_tilt and refraction change nothing: they need picture.hair.shading = \"fibre\"",
        ),
        (
            papers && hair.variation != usual.variation,
            "picture.hair.variation changes nothing: it needs picture.hair.shading = \"fibre\"",
        ),
        (hair.tip != usual.tip && hair.taper == 0.0, "picture.hair.tip changes nothing: picture.hair.taper is 0"),
        (no_skin && unlike, "picture.head.sheen and softness change nothing: neither the head nor a body is visible"),
        (
            !head.visible && head.stubble != skin.stubble,
            "picture.head.stubble changes nothing: picture.head.visible is false",
        ),
    ]
}
