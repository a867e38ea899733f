//! A new scene for your own files, from their declarations or, failing that, their geometry.

mod roots;

use std::path::Path;

use glam::Vec3;
use nabiki::setting::plain;
use nabiki::{Ellipsoid, Head, Mesh, Strands};
use nabiki_groom::bust;
use nabiki_io::{Axis, DeclaredSpace, Error, GroomFile, Placement, Result, Unit, declared_space, exchange, info, mesh};

use crate::built::holds_scenes;
use crate::scene::ImportedHair;
use crate::schema;
use crate::seat::{self, LikelyRoots, Mended, Seat, centimetres};
use crate::size::{HALF_AXIS, decimal, mean_half_axis, middle, named_unit, vector};
use roots::{grow_on, likely_roots};

/// A scene to start from.
#[derive(Clone, Debug, PartialEq)]
pub struct Template {
    /// The scene with comments.
    pub text: String,
    /// The guesses, a line each.
    pub guesses: Vec<String>,
    head: String,
    hair: String,
    shot: Shot,
}

impl Template {
    fn new(head: String, hair: String, shot: Shot, guesses: Vec<String>) -> Self {
        let text = format!("{INTRODUCTION}\n{head}\n{hair}{}", rest(shot));
        Self { text, guesses, head, hair, shot }
    }

    /// The same scene with a head that moves: `motion` is the value of `head.motion`, in TOML, and lasts for `frames`.
    pub(crate) fn moving(&self, motion: &str, frames: usize) -> Self {
        let head = format!("{}motion = {motion}\n", self.head);
        let frames = if self.shot.of_hair { frames.min(self.shot.frames) } else { frames };
        Self::new(head, self.hair.clone(), Shot { frames, ..self.shot }, self.guesses.clone())
    }
}

/// The text of a scene that will be saved at the path `scene`. `head` is a mesh, of which `groups` are kept (all if
/// empty); by default the built-in bust. `hair` is a hair file; by default, hair is grown.
///
/// # Errors
/// A file that cannot be read, or a head without a skull.
pub fn template(scene: &Path, head: Option<&Path>, groups: &[String], hair: Option<&Path>) -> Result<Template> {
    let mut guesses = Vec::new();
    let (strands, shot) = hair.map(strands_of).transpose()?.unzip();
    let mut shot = shot.unwrap_or_default();
    let hair_has_rate = hair.is_some_and(|file| exchange::is_usd(file) || exchange::is_alembic(file));
    if let Some(rate) = head.filter(|_| !hair_has_rate).map(exchange::frame_rate).transpose()?.flatten() {
        shot.rate = rate;
    }
    let (of_head, head_text) = match head {
        None => (
            None,
            "[head]\nmesh = \"builtin:bust\"      # or a .obj, .glb, .fbx, .ply, USD layer or Alembic archive\n"
                .to_owned(),
        ),
        Some(file) => {
            let found = look_at_head(file, groups, strands.as_ref())?;
            guesses.extend(found.guesses.iter().cloned());
            let text = found.text(scene, file)?;
            (Some(found), text)
        }
    };
    let hair_text = match (hair, &strands) {
        (Some(file), Some(strands)) => {
            let of_head = of_head.as_ref().zip(head).map(|(found, head)| (found, seat::is_one_file(head, file)));
            imported_hair(scene, file, strands, of_head, &mut guesses)?
        }
        _ => format!("[hair]\n{}\n{STYLE}", lines("hair", &["strands", "segments", "segment_length"])),
    };
    Ok(Template::new(head_text, hair_text, shot, guesses))
}

const INTRODUCTION: &str = "\
# A scene of hair in the wind. Lengths are in centimetres, y is up and the face looks along +x, whatever the files use.
# To change any setting for one run: nabiki preview SCENE --set motion.time_step=0.05
";

const STYLE: &str = "\
[hair.style]
stiffness = { top = 2.2, sides = 2.0, back = 2.0 }
length = { top = 18.0, sides = 18.0, back = 18.0 }
lift_degrees = { top = 18.0, sides = 15.0, back = 12.0 }
comb = { away = 1.0, sweep = [-0.3, 0.0, 0.0], off_face = 2.8, decay = 3.5 }
";

/// Settings of a table at their defaults, one line each with its description.
fn lines(table: &str, keys: &[&str]) -> String {
    let line = |key: &&str| {
        let found = schema::find(&format!("{table}.{key}").into());
        let setting = found.first()?;
        let given = format!("{key} = {}", schema::in_toml(&(setting.default)()));
        let help = plain(setting.help);
        let sentence = help.split_once(". ").map_or(help.as_str(), |(first, _)| first).trim_end_matches('.');
        let unit = if setting.range.unit.is_empty() { String::new() } else { format!(" ({})", setting.range.unit) };
        Some(format!("{given:<26} # {sentence}{unit}\n"))
    };
    keys.iter().filter_map(line).collect()
}

/// Realistic hair in true timing at any frame rate: real hair, styled a little at its root.
const FREE: &str = "\
stiffness = [\"6 cm\", \"4.5 cm\"]   # the length over which hair bends under its own weight, at root and tip; real hair has 4.5 cm
hold = \"0.3 g\"              # hair spray: returns hair to its place, as a share of its weight
settle = \"0.6 s\"            # the time in which a swing falls to about a third
gravity = \"1 g\"             # as on earth
drag = 1.0                  # how far a moving head leaves the hair behind: 1 is realistic
";

/// Motion, wind and camera of a new scene.
fn rest(Shot { frames, rate, .. }: Shot) -> String {
    let contact = lines("contact", &["margin", "friction", "static_friction"]);
    let variation = lines("free.variation", &["air", "flutter", "flyaways"]);
    let neighbours: String =
        lines("neighbours", &["pressure", "cohesion"]).lines().map(|line| format!("# {line}\n")).collect();
    // Intervals have at least one frame.
    let calm = (frames / 16).max(1);
    let half = (frames * 7 / 16).max(calm + 1);
    let last = frames.max(half + 1);
    format!(
        "
[motion]
form = \"free\"              # \"paper\": the equations of 1993, without contact and damping
frames = {frames}
frame_rate = {rate}
inertia_length_floor = 14.0   # shorter hair swings like hair of this length (cm)

# How hair keeps its shape and settles. All but gravity may be lists from root to tip; plain numbers are in F, the unit of the wind.
[free]
{FREE}
# How locks differ, so that they part in the wind. Without this table the hair moves as one sheet.
[free.variation]
{variation}
# Hair keeps out of the head and of each [[body]]: a mesh or a capsule that stands still, has a motion, or is worn.
[contact]
{contact}
# Hair against hair. Remove the # to turn it on:
# [neighbours]
{neighbours}
# The wind: direction and speed, up to a frame. Without speed, the length of the vector is the strength.
[[force]]
through = {calm}
vector = [0, 0, 0]

[[force]]
through = {half}
vector = [-1, 0.1, 0]      # backward
speed = \"25 km/h\"

[[force]]
through = {last}
vector = [-1, 0, 0]
speed = \"2 km/h\"           # a breeze, in which the hair returns

[wind]
ease = \"smooth\"            # how the wind changes from one to the next

# The camera frames everything that moves; distance (cm) and target override that.
[picture]
camera = {{ azimuth = 50.0, elevation = 4.0 }}
"
    )
}

/// A head file, examined.
struct Looked {
    head: Head,
    placement: Placement,
    declared: DeclaredSpace,
    /// Groups of the file to keep; all if empty.
    groups: Vec<String>,
    /// The unit, in TOML.
    unit_text: String,
    /// Whether the ellipsoid could not be fitted, and encloses the mesh instead.
    boxed: Option<Ellipsoid>,
    guesses: Vec<String>,
}

impl Looked {
    fn text(&self, scene: &Path, file: &Path) -> Result<String> {
        let mut text = format!("[head]\nmesh = {}\n", quoted(scene, file)?);
        if !self.groups.is_empty() {
            let names: Vec<String> =
                self.groups.iter().map(|group| toml::Value::String(group.clone()).to_string()).collect();
            text += &format!("groups = [{}]\n", names.join(", "));
        }
        if self.declared.unit.is_none() {
            text += &format!(
                "unit = {:<20} # of the file, guessed: mm, cm, dm, m, in, ft or a number of cm\n",
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
                let size = mean_half_axis(&self.head.ellipsoid);
                let origin = self.placement.file_from_head().transform_point3(center);
                let origin = seat::rounded(origin, size / self.placement.unit.cm);
                text += &format!("origin = {}\n", vector(origin));
                text += "# No skull was found to fit the ellipsoid to, so it encloses the mesh or the roots.\n";
                text += &format!(
                    "ellipsoid = {{ center = [0.0, 0.0, 0.0], half_axes = {} }}\n",
                    vector(seat::rounded(half_axes, size))
                );
            }
        }
        Ok(text)
    }
}

fn look_at_head(file: &Path, groups: &[String], strands: Option<&Strands>) -> Result<Looked> {
    let declared = declared_space(file)?;
    let mut guesses = Vec::new();
    let Chosen { mesh, groups, up, skull } = chosen(file, groups, &declared, &mut guesses)?;
    // Hair of another head, or in another unit, says nothing about this one.
    let roots = strands.map(|strands| likely_roots(strands, &mesh)).filter(|roots| grow_on(roots, &mesh));
    let roots = roots.as_deref();
    let front = front_of(up);
    let as_is = Placement { unit: Unit { cm: 1.0 }, up, facing: front, origin: Vec3::ZERO };
    let facing = roots.and_then(|roots| facing_of(roots, &mesh, &as_is)).unwrap_or(front);
    let how = if facing != front { "away from most of the roots" } else { "as most files have it" };
    guesses.push(format!("head.facing = \"{facing}\", {how}"));
    let placed = Placement { facing, ..as_is };
    // The fit does not depend on the unit, so it can determine the unit.
    let fitted = if facing == front { skull } else { skull_of(&mesh, &placed) };
    let boxed = fitted.is_none();
    let ellipsoid = fitted.unwrap_or_else(|| about(roots.unwrap_or(&mesh.positions), &placed));
    let (cm, unit_text) = match declared.unit {
        Some(unit) => (unit.cm, String::new()),
        None => {
            let (text, guess) = unit_of(&mesh, &ellipsoid, boxed, up).map_err(|e| e.in_file(file))?;
            guesses.push(guess);
            (centimetres(&text), text)
        }
    };
    let unit = Unit { cm };
    let unmoved = Placement { unit, ..placed };
    let scaled = Ellipsoid { center: ellipsoid.center * cm, half_axes: ellipsoid.half_axes * cm };
    let origin = unmoved.file_from_head().transform_point3(scaled.center);
    let placement = Placement { origin, ..unmoved };
    let centred = Ellipsoid { center: Vec3::ZERO, ..scaled };
    let (in_head, _) = mesh::place_and_weld(mesh, &placement).map_err(|e| e.in_file(file))?;
    let head = Head::from_mesh(in_head, Some(centred)).map_err(|e| Error::from(e).in_file(file))?;
    if boxed {
        let what = if roots.is_some() { "the roots" } else { "the whole mesh" };
        guesses.push(format!("head.ellipsoid, around {what}: no skull was found"));
    }
    Ok(Looked { head, placement, declared, groups, unit_text, boxed: boxed.then_some(centred), guesses })
}

/// The part of a file that is taken as the head.
struct Chosen {
    mesh: Mesh,
    groups: Vec<String>,
    up: Axis,
    /// The ellipsoid fitted to its skull, facing as most files do (the file's unit); `None` where none was found.
    skull: Option<Ellipsoid>,
}

/// The whole file, or the largest of its groups with a skull if the whole has none: files of bodies also hold clothes
/// and helpers.
fn chosen(file: &Path, groups: &[String], declared: &DeclaredSpace, guesses: &mut Vec<String>) -> Result<Chosen> {
    // Files with more groups than this have never been a body among other things.
    const MOST_TRIED: usize = 5;
    let look = |groups: Vec<String>| -> Result<Chosen> {
        let mesh = mesh::read(file, &groups)?;
        let up = declared.up.unwrap_or_else(|| up_of(&mesh));
        let as_is = Placement { unit: Unit { cm: 1.0 }, up, facing: front_of(up), origin: Vec3::ZERO };
        let skull = skull_of(&mesh, &as_is);
        Ok(Chosen { mesh, groups, up, skull })
    };
    let mut found = look(groups.to_vec())?;
    let parts = if groups.is_empty() { mesh::groups(file)? } else { Vec::new() };
    if found.skull.is_some() && parts.len() > 1 && holds_scenes(file) {
        let names: Vec<&str> = parts.iter().map(|(name, _)| name.as_str()).take(MOST_TRIED).collect();
        let (count, names) = (parts.len(), names.join(", "));
        guesses.push(format!(
            "head.mesh, all {count} meshes of the file, the largest {names}: head.groups selects some of them"
        ));
    }
    if found.skull.is_none() {
        for (group, _) in parts.into_iter().take(MOST_TRIED) {
            let part = look(vec![group.clone()])?;
            if part.skull.is_some() {
                guesses.push(format!("head.groups = [\"{group}\"], the largest with a skull"));
                found = part;
                break;
            }
        }
    }
    if declared.up.is_none() {
        guesses.push(format!("head.up = \"{}\", by the shape of its box", found.up));
    }
    Ok(found)
}

/// The facing of most files whose up axis is `up`.
fn front_of(up: Axis) -> Axis {
    if matches!(up, Axis::PlusZ) { Axis::MinusY } else { Axis::PlusZ }
}

/// The ellipsoid of a mesh's skull, placed.
fn skull_of(mesh: &Mesh, placement: &Placement) -> Option<Ellipsoid> {
    let turn = placement.head_from_file();
    let positions = mesh.positions.iter().map(|&p| turn.transform_point3(p)).collect();
    Head::fit(&Mesh { positions, ..mesh.clone() }).ok()
}

/// The unit of a file that declares none, in TOML, and how it was found: by its skull, or else by its height.
fn unit_of(mesh: &Mesh, ellipsoid: &Ellipsoid, boxed: bool, up: Axis) -> Result<(String, String)> {
    // Units from a micrometre to a kilometre (cm).
    const UNITS: std::ops::RangeInclusive<f32> = 1e-4..=1e5;
    let size = mean_half_axis(ellipsoid);
    if !UNITS.contains(&(HALF_AXIS / size)) {
        let line = "is its mean half axis in its own units, and no unit of length makes that a person's";
        return Err(Error::new(format!("{size:e} {line}: scale it in the file, to metres or centimetres")));
    }
    Ok(if !boxed {
        match named_unit(size, HALF_AXIS) {
            Some(name) => (format!("\"{name}\""), format!("head.unit = \"{name}\", by the size of the head")),
            None => {
                let cm = decimal(HALF_AXIS / size, 2);
                let guess = format!(
                    "head.unit = {cm} (cm): no named unit gives it the size of a person; give the unit of the file"
                );
                (cm, guess)
            }
        }
    } else {
        by_height(mesh, up)
    })
}

/// The unit of a mesh without a skull, in TOML, and how it was found.
fn by_height(mesh: &Mesh, up: Axis) -> (String, String) {
    let (low, high) = bounds(&mesh.positions);
    let height = (high - low).dot(up.vector().as_vec3()).abs();
    match info::likely_unit(height) {
        Some(name) => (format!("\"{name}\""), format!("head.unit = \"{name}\", by how tall the mesh is")),
        None => {
            let guess =
                "head.unit = \"cm\": no unit gives it the height of a person's head or body; give the unit of the file";
            ("\"cm\"".to_owned(), guess.to_owned())
        }
    }
}

/// The up axis of a mesh that does not declare it: z if it is clearly taller that way, else y.
fn up_of(mesh: &Mesh) -> Axis {
    let (low, high) = bounds(&mesh.positions);
    let size = high - low;
    // A head is as deep as it is high; a bust or body is not.
    if size.z > 1.15 * size.y { Axis::PlusZ } else { Axis::PlusY }
}

fn bounds(points: &[Vec3]) -> (Vec3, Vec3) {
    points.iter().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), &p| (low.min(p), high.max(p)))
}

/// Hair grows on top and behind: seen from the middle of the upper mesh, the face looks away from the middle of the
/// roots.
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
    // Heads are symmetric, so the roots are hardly off sideways.
    let clear = level.length() > 0.05 * (high - low).length();
    let away = |axis: Axis| axis.vector().as_vec3().dot(-level);
    let best = Axis::ALL.into_iter().filter(|axis| axis.is_across(placement.up));
    best.max_by(|a, b| away(*a).total_cmp(&away(*b))).filter(|_| clear)
}

/// An ellipsoid in the bounding box, if there is no skull (placed, in the file's unit).
fn about(points: &[Vec3], placement: &Placement) -> Ellipsoid {
    let turn = placement.head_from_file();
    let placed: Vec<Vec3> = points.iter().map(|&p| turn.transform_point3(p)).collect();
    let (low, high) = bounds(&placed);
    let half_axes = 0.5 * (high - low);
    Ellipsoid { center: 0.5 * (low + high), half_axes: half_axes.max(Vec3::splat(half_axes.max_element() / 3.0)) }
}

/// Length of a shot, and its frame rate.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Shot {
    frames: usize,
    rate: f64,
    /// Whether its length is that of moving hair in a file.
    of_hair: bool,
}

impl Default for Shot {
    fn default() -> Self {
        Self { frames: 100, rate: 24.0, of_hair: false }
    }
}

/// The strands by which a hair file is judged, and its shot.
fn strands_of(file: &Path) -> Result<(Strands, Shot)> {
    let mut opened = GroomFile::open(file)?;
    let strands = seat::judged(&opened.hair_in_place(0, None)?);
    if strands.is_empty() {
        return Err(Error::new("holds no strands").in_file(file));
    }
    // As long as the file's if its hair moves; with two frames, the hair was only moved.
    let frames = opened.frames()? - 1;
    let of_hair = frames > 1;
    let frames = if of_hair { frames } else { Shot::default().frames };
    Ok((strands, Shot { frames, rate: opened.frame_rate()?, of_hair }))
}

/// Why hair has the unit or axis of its head.
const AS_THE_HEAD: &str = "the head's, with which the hair lies on it";

/// `head`: that of the scene, if it is not built in, and whether it is from the same file.
fn imported_hair(
    scene: &Path,
    file: &Path,
    strands: &Strands,
    head: Option<(&Looked, bool)>,
    guesses: &mut Vec<String>,
) -> Result<String> {
    let of_head = head.is_some_and(|(_, same)| same);
    let declared = seat::heeded(declared_space(file)?, of_head);
    let mut text = format!("[hair]\nfile = {}\n", quoted(scene, file)?);
    let mut settings = ImportedHair { file: file.to_owned(), ..ImportedHair::default() };
    let built_in;
    let (skin, head_placement) = match head {
        Some((looked, _)) => (&looked.head, looked.placement),
        None => {
            built_in = bust();
            (&built_in, Placement::default())
        }
    };
    settings.facing = head.is_none().then(|| front_of(declared.up.unwrap_or(head_placement.up)));
    let ends = LikelyRoots::default();
    let seat =
        Seat { head: skin, strands, settings: &settings, head_placement: &head_placement, declared, of_head, ends };
    let (Mended { facing, unit, up, origin, as_the_head }, on_skin) =
        seat.mended().map_or((Mended::default(), true), |(mended, then)| (mended, then.on_skin));
    let how = if facing.is_some() { "in which the hair lies on the head" } else { "as most files have it" };
    if let Some(facing) = facing.or(settings.facing) {
        text += &format!("facing = \"{facing}\"              # guessed: where the face looks\n");
        guesses.push(format!("hair.facing = \"{facing}\", {how}"));
    }
    if let Some(unit) = unit {
        text += &format!("unit = {unit:<20} # guessed\n");
        let how = if as_the_head { AS_THE_HEAD } else { "by how the roots spread and lie on the head" };
        guesses.push(format!("hair.unit = {unit}, {how}"));
    }
    if let Some(up) = up {
        text += &format!("up = \"{up}\"                  # guessed\n");
        guesses.push(format!("hair.up = \"{up}\", {AS_THE_HEAD}"));
    }
    if let Some(origin) = origin.map(vector) {
        text += &format!("origin = {origin}   # guessed: the point of the file at the middle of the head\n");
        let there = if on_skin { "onto the scalp" } else { "as close to the skin as possible" };
        guesses.push(format!("hair.origin = {origin}, which brings the roots {there}"));
    }
    text += "# strands = 5000           # use only this many, spread evenly\n";
    text += "# segments = 20            # resample each strand to equal segments\n";
    text += "segment_length = 1.0       # the paper's d (cm), in which k and i are counted\n";
    Ok(text)
}

/// A file as a scene beside it names it, in quotes.
fn quoted(scene: &Path, file: &Path) -> Result<String> {
    let folder = nabiki_file::folder_of(scene);
    let absolute = |path: &Path| std::path::absolute(path).map_err(|e| Error::from(e).in_file(path));
    let (folder, file) = (absolute(folder)?, absolute(file)?);
    let named = file.strip_prefix(&folder).unwrap_or(&file);
    let text = named.to_str().ok_or_else(|| Error::new("a scene is text, but this name is not").in_file(&file))?;
    // A scene beside its files may go to another system.
    let text = if named.is_relative() { text.replace(std::path::MAIN_SEPARATOR, "/") } else { text.to_owned() };
    Ok(toml::Value::String(text).to_string())
}
