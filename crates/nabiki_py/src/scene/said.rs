//! What a scene, and its motion, are in one line: what Python shows of them.

use nabiki_scene::BuiltScene;
use nabiki_scene::scene::{FieldSettings, FormChoice, HairSource};

/// `<nabiki.Scene scenes/gust.toml: free form, 60000 strands, frames 0 to 110 at 24 a second, 3 forces>`.
pub fn scene(scene: &nabiki_scene::Scene) -> String {
    let form = match scene.form {
        FormChoice::Paper => "the paper's form",
        FormChoice::Free => "free form",
    };
    let hair = match &scene.hair.source {
        HairSource::Grown(hair) => counted(hair.strands, "strand"),
        HairSource::Imported(hair) => format!("hair of {}", hair.file.display()),
    };
    let (frames, rate) = (scene.motion.frames, scene.frame_rate());
    let field = field(&scene.field);
    format!("<nabiki.Scene {}: {form}, {hair}, frames 0 to {frames} at {rate} a second, {field}>", name(scene))
}

/// `of scenes/gust.toml: 111 frames of 300 strands, 5700 points (cm)`.
pub fn motion(built: &BuiltScene) -> String {
    let (strands, points) = (built.strands().len(), built.strands().points().len());
    let (frames, strands) = (counted(built.frames() as usize + 1, "frame"), counted(strands, "strand"));
    format!("of {}: {frames} of {strands}, {points} points (cm)", name(&built.scene))
}

fn name(scene: &nabiki_scene::Scene) -> String {
    match scene.file() {
        file if file.as_os_str().is_empty() => "made in Python".to_owned(),
        file => file.display().to_string(),
    }
}

fn field(field: &FieldSettings) -> String {
    let FieldSettings { force, wind: _, gust, body_wind, flow, turbulence, point, vortex, fan, own } = field;
    let all = [
        (force.len(), "force"),
        (usize::from(gust.is_some()), "gust"),
        (usize::from(body_wind.is_some()), "body_wind"),
        (usize::from(flow.is_some()), "flow"),
        (usize::from(turbulence.is_some()), "turbulence"),
        (point.len(), "point"),
        (vortex.len(), "vortex"),
        (fan.len(), "fan"),
        (own.len(), "function"),
    ];
    let there: Vec<String> =
        all.into_iter().filter(|(count, _)| *count > 0).map(|(count, name)| counted(count, name)).collect();
    if there.is_empty() { "no wind".to_owned() } else { there.join(", ") }
}

fn counted(count: usize, name: &str) -> String {
    let end = match (count, name) {
        (1, _) => "",
        (_, "vortex") => "es",
        _ => "s",
    };
    format!("{count} {name}{end}")
}
