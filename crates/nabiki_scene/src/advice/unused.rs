//! Settings that change nothing beside the others: hair does not feel them, or no picture shows them.

use glam::Vec3;
use nabiki::body::Contact;
use nabiki::field::Turbulence;
use nabiki::pseudo_force::PseudoForce;
use nabiki_render::settings::{Antialiasing, Camera, HairLook, HeadLook, Picture, Projection, Shading};

use super::{Advice, Setting};
use crate::scene::{FieldSettings, FormChoice, FreeSettings, Scene};

/// What is given and changes nothing.
pub(super) fn unused(scene: &Scene) -> Vec<Advice> {
    let mut advice: Vec<Advice> = unfelt(scene).into_iter().chain(idle(scene)).collect();
    let lines = [field(&scene.field), camera(&scene.picture.camera), picture(scene)];
    let of_line = |(changes_nothing, line): (bool, &str)| {
        changes_nothing.then(|| Advice { seen: line.to_owned(), settings: Vec::new() })
    };
    advice.extend(lines.into_iter().flatten().filter_map(of_line));
    advice
}

/// Tables of the free form beside the paper's, which feels none of them.
fn unfelt(scene: &Scene) -> Option<Advice> {
    if scene.form == FormChoice::Free {
        return None;
    }
    let tables = [
        (scene.free != FreeSettings::default(), "[free]"),
        (scene.contact != Contact::default(), "[contact]"),
        (scene.bodies.iter().any(|body| body.solid), "[[body]]"),
        (scene.neighbours.is_some(), "[neighbours]"),
    ];
    let given: Vec<&str> = tables.into_iter().filter(|&(given, _)| given).map(|(_, table)| table).collect();
    if given.is_empty() {
        return None;
    }
    let seen = format!("hair does not feel {} in the paper's form", given.join(", "));
    Some(Advice { seen, settings: vec![Setting { key: "motion.form", value: "\"free\"".to_owned() }] })
}

/// What hair of the free form does not feel, and bodies that are neither felt nor seen.
fn idle(scene: &Scene) -> Vec<Advice> {
    let mut seen = Vec::new();
    let given = scene.pseudo_force != PseudoForce::default();
    if scene.form == FormChoice::Free && given && !scene.free.pseudo_force {
        let setting = Setting { key: "free.pseudo_force", value: "true".to_owned() };
        seen.push(Advice {
            seen: "hair does not feel [pseudo_force] in the free form".to_owned(),
            settings: vec![setting],
        });
    }
    for i in (0..scene.bodies.len()).filter(|&i| !scene.bodies[i].solid && !scene.bodies[i].shown) {
        let line = format!("body[{i}] changes nothing: it is neither solid nor shown");
        seen.push(Advice { seen: line, settings: Vec::new() });
    }
    seen
}

/// Whether each of these lines is true of the field.
fn field(settings: &FieldSettings) -> Vec<(bool, &'static str)> {
    let still = settings.force.iter().all(|key| key.vector == Vec3::ZERO);
    let no_wind = still && settings.body_wind.is_none();
    let turbulence = settings.turbulence.as_ref();
    let silent = |t: &Turbulence| !t.envelope.is_empty() && t.envelope.iter().all(|key| key.factor == 0.0);
    vec![
        (settings.gust.is_some() && still, "[gust] changes nothing: the vectors of all [[force]] are 0"),
        (settings.flow.is_some() && no_wind, "[flow] changes nothing: the vectors of all [[force]] are 0"),
        (
            turbulence.is_some_and(|t| t.drift != Turbulence::default().drift && no_wind),
            "turbulence.drift changes nothing: there is no wind that swirls could go with",
        ),
        (turbulence.is_some_and(silent), "[turbulence] changes nothing: all factors of its envelope are 0"),
    ]
}

/// The same of the camera.
fn camera(camera: &Camera) -> Vec<(bool, &'static str)> {
    let perspective = camera.projection == Projection::Perspective;
    let framed = if perspective { camera.distance.is_some() } else { camera.height.is_some() };
    vec![
        (
            camera.focus_distance.is_some() && camera.f_stop.is_none(),
            "picture.camera.focus_distance changes nothing: all is sharp without picture.camera.f_stop",
        ),
        (
            camera.height.is_some() && perspective,
            "picture.camera.height changes nothing in perspective: give picture.camera.distance or fov, or projection = \"orthographic\"",
        ),
        (
            camera.fov != Camera::default().fov && !perspective,
            "picture.camera.fov changes nothing in orthographic views: give picture.camera.height",
        ),
        (
            camera.margin != Camera::default().margin && framed,
            "picture.camera.margin changes nothing: distance or height says how much is seen",
        ),
    ]
}

/// The same of the look.
fn picture(scene: &Scene) -> Vec<(bool, &'static str)> {
    let picture = &scene.picture;
    let (hair, head) = (&picture.hair, &picture.head);
    let (usual, skin) = (HairLook::default(), HeadLook::default());
    let papers = hair.shading == Shading::KajiyaKay;
    // Bodies are lit as the head is.
    let no_skin = !head.visible && !scene.bodies.iter().any(|body| body.shown);
    let unlike = head.sheen != skin.sheen || head.softness != skin.softness;
    vec![
        (
            picture.samples != Picture::default().samples && picture.antialiasing != Antialiasing::Oversample,
            "picture.samples changes nothing: it is of picture.antialiasing = \"oversample\"",
        ),
        (
            papers && (hair.scale_tilt != usual.scale_tilt || hair.refraction != usual.refraction),
            "picture.hair.scale_tilt and refraction change nothing: they are of picture.hair.shading = \"fibre\"",
        ),
        (hair.tip != usual.tip && hair.taper == 0.0, "picture.hair.tip changes nothing: picture.hair.taper is 0"),
        (
            no_skin && unlike,
            "picture.head.sheen and softness change nothing: no skin is shown, the head's nor a body's",
        ),
        (
            !head.visible && head.stubble != skin.stubble,
            "picture.head.stubble changes nothing: picture.head.visible is false",
        ),
    ]
}
