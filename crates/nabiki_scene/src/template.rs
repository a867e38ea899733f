//! A new scene about files of one's own: what they say, and where they do not say it, what they look like.

use std::path::Path;

use glam::Vec3;
use nabiki::{Ellipsoid, Head, Mesh};
use nabiki_io::Axis;
use nabiki_io::{DeclaredSpace, Error, Result, exchange, hair, mesh};
use nabiki_io::{Placement, Unit};

use crate::advice::{
    AFLOAT, HALF_AXIS, SPREAD, above_centre, mean_half_axis, median_distance, middle, spread, unit_for, vector,
};

/// A scene to begin with.
#[derive(Clone, Debug, PartialEq)]
pub struct Template {
    /// The scene, commented.
    pub text: String,
    /// What was guessed, a line each.
    pub guesses: Vec<String>,
}

/// Writes a scene for `scene`, the path that it will be saved at. `head`: a mesh, of which `groups` are kept (all if
/// empty); without it the built-in bust. `hair`: a hair file; without it hair is grown.
///
/// # Errors
/// A file that cannot be read, or a head on which no skull is found.
pub fn template(scene: &Path, head: Option<&Path>, groups: &[String], hair: Option<&Path>) -> Result<Template> {
    let mut guesses = Vec::new();
    let roots = hair.map(roots_of).transpose()?;
    let (of_head, head_text) = match head {
        None => (
            None,
            "[head]\nmesh = \"builtin:bust\"      # or a .obj, .glb, .ply, USD layer or Alembic archive\n".to_owned(),
        ),
        Some(file) => {
            let found = look_at_head(file, groups, roots.as_deref())?;
            guesses.extend(found.guesses.iter().cloned());
            let text = found.text(scene, file, groups)?;
            (Some(found), text)
        }
    };
    let hair_text = match (hair, &roots) {
        (Some(file), Some(roots)) => imported_hair(scene, file, roots, of_head.as_ref(), &mut guesses)?,
        _ => GROWN.to_owned(),
    };
    let text = format!("{INTRODUCTION}\n{head_text}{SHELL}\n{hair_text}{REST}");
    Ok(Template { text, guesses })
}

const INTRODUCTION: &str = "\
# A scene of hair in the wind. Lengths are centimetres, y is up and the face looks along +x, whatever the files have.
# Every setting may be changed for one try: nabiki preview SCENE --set motion.time_step=0.05
";

const SHELL: &str = "\
shell = 1.6                # how far the pseudo-force reaches: the head's ellipsoid, so much larger
";

const GROWN: &str = "\
[hair]
strands = 19330
segments = 18
segment_length = 1.0       # cm

[hair.style]
stiffness = { top = 2.2, sides = 2.0, back = 2.0 }
length = { top = 18.0, sides = 18.0, back = 18.0 }
lift_degrees = { top = 18.0, sides = 15.0, back = 12.0 }
comb = { away = 1.0, sweep = [-0.3, 0.0, 0.0], off_face = 2.8, decay = 3.5 }
";

const REST: &str = "
[motion]
frames = 100
frame_rate = 24
inertia_length_floor = 14.0   # shorter hair is held by the longer hair beside it (cm)
straighten = 3.0           # hair that hangs within so many degrees of straight goes with any wind

# The wind is weakened where it would press hair into the head: by these factors, from the root on.
[pseudo_force]
alpha = 0.2
coefficients = [0.005, 0.005, 0.01, 0.01, 0.03, 0.03, 0.05, 0.05, 0.1, 0.1, 0.15, 0.15, 0.3, 0.3, 0.5, 0.5, 0.7, 1.0]

# Where the hair shall go: a direction with a strength, up to a frame. Four times the force halves the time of a swing.
[[force]]
through = 50
vector = [-40, 0, 0]       # backward

[[force]]
through = 100
vector = [-5, -50, 0]      # and down

# The camera frames all that moves; distance (cm) and target fix it.
[picture]
camera = { azimuth = 50.0, elevation = 4.0 }
";

/// A head file, looked at.
struct Looked {
    head: Head,
    placement: Placement,
    declared: DeclaredSpace,
    unit_text: String,
    /// Whether the ellipsoid could not be fitted, and was drawn about the mesh instead.
    boxed: Option<Ellipsoid>,
    guesses: Vec<String>,
}

impl Looked {
    fn text(&self, scene: &Path, file: &Path, groups: &[String]) -> Result<String> {
        let mut text = format!("[head]\nmesh = {}\n", quoted(scene, file)?);
        if !groups.is_empty() {
            let names: Vec<String> =
                groups.iter().map(|group| toml::Value::String(group.clone()).to_string()).collect();
            text += &format!("groups = [{}]\n", names.join(", "));
        }
        if self.declared.unit.is_none() {
            text += &format!(
                "unit = {:<20} # of the file, guessed: mm, cm, dm, m, in, ft or centimetres\n",
                self.unit_text
            );
        }
        if self.declared.up.is_none() {
            text += &format!("up = \"{}\"                  # guessed\n", self.placement.up);
        }
        text += &format!("facing = \"{}\"              # guessed: where the face looks\n", self.placement.facing);
        match self.boxed {
            None => text += "ellipsoid = \"fit\"\n",
            Some(Ellipsoid { center, half_axes }) => {
                let origin = self.placement.file_from_head().transform_point3(center);
                text += &format!("origin = {}\n", vector(origin));
                text += "# No skull was found to fit it to: it is drawn about what there is.\n";
                text += &format!("ellipsoid = {{ center = [0.0, 0.0, 0.0], half_axes = {} }}\n", vector(half_axes));
            }
        }
        Ok(text)
    }
}

fn look_at_head(file: &Path, groups: &[String], roots: Option<&[Vec3]>) -> Result<Looked> {
    let declared = exchange::declared_space(file)?;
    let mesh = mesh::read(file, groups)?;
    let mut guesses = Vec::new();
    let up = declared.up.unwrap_or_else(|| {
        let up = up_of(&mesh);
        guesses.push(format!("head.up = \"{up}\", by the shape of its box"));
        up
    });
    let front = if matches!(up, Axis::PlusZ) { Axis::MinusY } else { Axis::PlusZ };
    let as_is = Placement { unit: Unit { cm: 1.0 }, up, facing: front, origin: Vec3::ZERO };
    // The fit does not know the unit, so that the unit can be told by the fit.
    let fit = |facing| {
        let turn = Placement { facing, ..as_is }.head_from_file();
        let positions = mesh.positions.iter().map(|&p| turn.transform_point3(p)).collect();
        let turned = Mesh { positions, ..mesh.clone() };
        Head::fit(&turned).map(|ellipsoid| (ellipsoid, turned))
    };
    let facing = match roots {
        Some(roots) => facing_of(roots, &mesh, &as_is).unwrap_or(front),
        None => front,
    };
    let how = if facing != front { "away from most of the roots" } else { "as most files have it" };
    guesses.push(format!("head.facing = \"{facing}\", {how}"));
    let placed = Placement { facing, ..as_is };
    let (ellipsoid, boxed) = match fit(facing) {
        Ok((ellipsoid, _)) => (ellipsoid, false),
        Err(_) => (about(roots.unwrap_or(&mesh.positions), &placed), true),
    };
    let (cm, unit_text) = match declared.unit {
        Some(unit) => (unit.cm, String::new()),
        None => {
            let text = unit_for(mean_half_axis(&ellipsoid), HALF_AXIS);
            guesses.push(format!("head.unit = {text}, by the size of the head"));
            (centimetres(&text), text)
        }
    };
    let unit = Unit { cm };
    let unmoved = Placement { unit, ..placed };
    let scaled = Ellipsoid { center: ellipsoid.center * cm, half_axes: ellipsoid.half_axes * cm };
    let origin = unmoved.file_from_head().transform_point3(scaled.center);
    let placement = Placement { origin, ..unmoved };
    let centred = Ellipsoid { center: Vec3::ZERO, ..scaled };
    let (in_head, _) = mesh::place_and_weld(mesh.clone(), &placement).map_err(|e| e.in_file(file))?;
    let head = Head::from_mesh(in_head, Some(centred)).map_err(|e| Error::from(e).in_file(file))?;
    if boxed {
        let what = if roots.is_some() { "the roots" } else { "the whole mesh" };
        guesses.push(format!("head.ellipsoid, about {what}: no skull was found"));
    }
    Ok(Looked { head, placement, declared, unit_text, boxed: boxed.then_some(centred), guesses })
}

/// The axis along which a mesh that does not say it stands: z where it is clearly taller that way, else y.
fn up_of(mesh: &Mesh) -> Axis {
    let (low, high) = bounds(&mesh.positions);
    let size = high - low;
    // A head is as deep as it is high, a bust or body is not.
    if size.z > 1.15 * size.y { Axis::PlusZ } else { Axis::PlusY }
}

fn bounds(points: &[Vec3]) -> (Vec3, Vec3) {
    points.iter().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), &p| (low.min(p), high.max(p)))
}

/// Hair grows on top and behind: the face looks away from the middle of the roots, seen from that of the upper mesh.
fn facing_of(roots: &[Vec3], mesh: &Mesh, placement: &Placement) -> Option<Axis> {
    let up = placement.up.vector().as_vec3();
    let (low, high) = bounds(roots);
    let height = |p: Vec3| p.dot(up);
    let (bottom, top) = (height(low).min(height(high)), height(low).max(height(high)));
    let around: Vec<Vec3> = mesh.positions.iter().copied().filter(|&p| (bottom..=top).contains(&height(p))).collect();
    if around.is_empty() {
        return None;
    }
    let (low, high) = bounds(&around);
    let off = middle(roots) - 0.5 * (low + high);
    let level = off - off.dot(up) * up;
    let axes = [Axis::PlusX, Axis::MinusX, Axis::PlusY, Axis::MinusY, Axis::PlusZ, Axis::MinusZ];
    // Heads are symmetric: sideways the roots are off by little.
    let clear = level.length() > 0.05 * (high - low).length();
    let away = |axis: Axis| axis.vector().as_vec3().dot(-level);
    let best = axes.into_iter().filter(|axis| axis.vector().dot(placement.up.vector()) == 0.0);
    best.max_by(|a, b| away(*a).total_cmp(&away(*b))).filter(|_| clear)
}

/// An ellipsoid in the box of points, where there is no skull (placed, in the file's unit).
fn about(points: &[Vec3], placement: &Placement) -> Ellipsoid {
    let turn = placement.head_from_file();
    let placed: Vec<Vec3> = points.iter().map(|&p| turn.transform_point3(p)).collect();
    let (low, high) = bounds(&placed);
    let half_axes = 0.5 * (high - low);
    Ellipsoid { center: 0.5 * (low + high), half_axes: half_axes.max(Vec3::splat(half_axes.max_element() / 3.0)) }
}

fn roots_of(file: &Path) -> Result<Vec<Vec3>> {
    let hair = hair::read(file)?;
    let roots: Vec<Vec3> = hair.strands.iter().filter_map(|strand| strand.first().copied()).collect();
    if roots.is_empty() { Err(Error::new("holds no strands").in_file(file)) } else { Ok(roots) }
}

fn imported_hair(
    scene: &Path,
    file: &Path,
    roots: &[Vec3],
    head: Option<&Looked>,
    guesses: &mut Vec<String>,
) -> Result<String> {
    let declared = exchange::declared_space(file)?;
    let mut text = format!("[hair]\nfile = {}\n", quoted(scene, file)?);
    let built_in;
    let (skin, beside) = match head {
        Some(looked) => (&looked.head, looked.placement),
        None => {
            built_in = Head::builtin();
            (&built_in, Placement::default())
        }
    };
    let mut placement =
        Placement { unit: declared.unit.unwrap_or(beside.unit), up: declared.up.unwrap_or(beside.up), ..beside };
    if head.is_none() {
        placement.facing = if matches!(placement.up, Axis::PlusZ) { Axis::MinusY } else { Axis::PlusZ };
        text += &format!("facing = \"{}\"              # guessed: where the face looks\n", placement.facing);
        guesses.push(format!("hair.facing = \"{}\", as most files have it", placement.facing));
    }
    let size = mean_half_axis(&skin.ellipsoid);
    let placed = |placement: &Placement| -> Vec<Vec3> {
        let place = placement.head_from_file();
        roots.iter().map(|&root| place.transform_point3(root)).collect()
    };
    let grows =
        |placement: &Placement| median_distance(skin, &placed(placement)).is_some_and(|off| off <= AFLOAT * size);
    if head.is_some() && placement.up == beside.up {
        // The head's origin is a place that both files share, whatever their units.
        placement.origin = beside.origin * (beside.unit.cm / placement.unit.cm);
    }
    if !grows(&placement) && declared.unit.is_none() {
        let unit = unit_for(spread(roots), SPREAD * size);
        let cm = centimetres(&unit);
        placement.origin *= placement.unit.cm / cm;
        placement.unit = Unit { cm };
        text += &format!("unit = {unit:<20} # guessed\n");
        guesses.push(format!("hair.unit = {unit}, by how far the roots spread"));
    }
    if !grows(&placement) {
        let now = middle(&placed(&placement));
        placement.origin = placement.file_from_head().transform_point3(now - above_centre(&skin.ellipsoid));
        let origin = vector(placement.origin);
        text += &format!("origin = {origin}   # guessed: the point of the file that is the middle of the head\n");
        guesses.push(format!("hair.origin = {origin}, which brings the roots onto the scalp"));
    }
    text += "# strands = 5000           # an even choice of the file's\n";
    text += "# segments = 20            # cuts every strand anew into equal segments\n";
    text += "segment_length = 1.0       # the paper's d (cm), which its k and i are counted in\n";
    Ok(text)
}

/// Centimetres of a unit as a scene spells it.
fn centimetres(text: &str) -> f32 {
    text.trim_matches('"').parse().map_or(1.0, |unit: Unit| unit.cm)
}

/// A file as a scene beside it names it, in quotes.
fn quoted(scene: &Path, file: &Path) -> Result<String> {
    let folder = nabiki_file::folder_of(scene);
    let absolute = |path: &Path| std::path::absolute(path).map_err(|e| Error::from(e).in_file(path));
    let (folder, file) = (absolute(folder)?, absolute(file)?);
    let named = file.strip_prefix(&folder).unwrap_or(&file);
    let text = named.to_str().ok_or_else(|| Error::new("a scene is text, and this name is not").in_file(&file))?;
    Ok(toml::Value::String(text.to_owned()).to_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::advice::rounded;

    #[test]
    fn units_are_told_by_the_size_of_a_head() {
        for (name, cm) in crate::advice::UNITS {
            assert_eq!(unit_for(HALF_AXIS / cm, HALF_AXIS), format!("\"{name}\""));
        }
        // 1.85 of a unit are a head: no unit has that name.
        assert_eq!(unit_for(1.85, HALF_AXIS), rounded(HALF_AXIS / 1.85));
    }
}
