//! Summary of a scene file.

use std::fmt;
use std::path::Path;

use glam::Vec3;
use nabiki::body::Contact;
use nabiki::disturbance::Disturbance;
use nabiki::dynamics::{Form, Motion};
use nabiki::field::{Ease, Keyframe};
use nabiki::free_form::{FreeForm, NeighbourForces};
use nabiki::pseudo_force::PseudoForce;
use nabiki::region::Region;
use nabiki::setting::{Datum, Kind, Setting, Settings, Table, Value};
use nabiki::{Ellipsoid, Profile};
use serde::Serialize;

use crate::advice::Advice;
use crate::built::{BuiltScene, Shown};
use crate::looks_wrong::unused;
use crate::scene::{
    AimSettings, Amount, BodySettings, CapsuleSettings, FieldBound, FieldSettings, ForceSettings, FormChoice,
    FreeSettings, GrownHair, HairSource, ImportedHair, Measure, Scene,
};
use crate::schema;
use nabiki_io::info::Short;
use nabiki_io::motion::MotionSource;
use nabiki_io::screen::OneLine;

/// The summary of a scene. The head and its motion are loaded; in the free form, so is everything else. Missing files
/// are marked as missing.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct SceneInfo {
    /// The head's mesh, as named in the scene.
    pub head: String,
    /// The head ellipsoid E (head space, cm), if the head can be loaded.
    pub ellipsoid: Option<Ellipsoid>,
    /// Why the head cannot be loaded.
    pub head_problem: Option<String>,
    /// C is E scaled by this factor.
    pub shell: f32,
    /// The file that moves the head, if any.
    pub head_motion: Option<String>,
    /// The hair's file, or a description of grown hair.
    pub hair: String,
    /// Frames after the rest frame.
    pub frames: u32,
    /// Delta t.
    pub time_step: f32,
    /// Slow-motion factor of the hair.
    pub slow: f32,
    /// lambda.
    pub linear_density: f32,
    /// alpha. In the free form only if the pseudo-force weakens its field.
    pub alpha: Option<f32>,
    /// Settings of the free form; `None` in the paper's form.
    pub free: Option<FreeInfo>,
    /// The other bodies, each with its table.
    pub bodies: Vec<(String, String)>,
    /// The vectors of the field.
    pub force: Vec<ForceSettings>,
    /// The vectors with speeds converted to strengths, if there is a speed and the hair can be loaded.
    pub strengths: Vec<Keyframe>,
    /// The ease between them.
    pub ease: Ease,
    /// Descriptions of the other fields, each with its table.
    pub fields: Vec<(String, String)>,
    /// The bound of each field, if head and motion can be loaded. Empty if there is only a stepped `force`.
    pub bounds: Vec<FieldBound>,
    /// Why the bounds are unknown.
    pub bounds_problem: Option<String>,
    /// Frames between disturbances.
    pub disturbed_every: Option<u32>,
    /// Width and height of the pictures (pixels).
    pub picture: [u32; 2],
    /// Settings without effect, a line each.
    pub unused: Vec<String>,
    /// Why the scene does not move, if it is in the free form.
    pub problem: Option<String>,
}

/// `[free]`, `[contact]` and `[neighbours]` of a scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct FreeInfo {
    /// As given in the scene.
    pub given: FreeSettings,
    /// The same in units of force and frames, with the steps per frame, if the hair can be loaded.
    pub resolved: Option<FreeForm>,
    /// Distance of nodes from the head's skin (cm).
    pub margin: f32,
    /// Neighbour forces, if they are on.
    pub neighbours: Option<NeighbourForces>,
    /// What leads hair to other shapes.
    pub aims: Vec<AimSettings>,
}

impl FreeInfo {
    fn of(scene: &Scene, built: Option<&BuiltScene>) -> Option<Self> {
        let resolved = built.and_then(|built| match &built.dynamics.form {
            Form::Paper => None,
            Form::Free(free) => Some(free.form.clone()),
        });
        (scene.form == FormChoice::Free).then(|| Self {
            given: scene.free.clone(),
            resolved,
            margin: scene.contact.margin,
            neighbours: scene.neighbours.clone(),
            aims: scene.aims.clone(),
        })
    }
}

impl SceneInfo {
    /// Summarises `scene`.
    pub fn of(scene: &Scene) -> Self {
        let hair = match &scene.hair.source {
            HairSource::Imported(ImportedHair { file, strands: None, .. }) => named(scene, file),
            HairSource::Imported(ImportedHair { file, strands: Some(count), .. }) => {
                format!("{count} strands of {}", named(scene, file))
            }
            HairSource::Grown(GrownHair { strands, segments, .. }) => {
                format!("{strands} strands of at most {segments} x {} cm", scene.hair.segment_length)
            }
        };
        let head = scene.load_head();
        let by_speed = scene.field.force.iter().any(|force| force.speed.is_some());
        let bounds = if scene.field.is_the_papers() { Ok(Vec::new()) } else { scene.field_bounds() };
        // Converting physical units, and the steps per frame, needs the length of the hair.
        let built = (scene.form == FormChoice::Free).then(|| scene.clone().build(Shown::AtMost(1)));
        let (built, problem) = match built.transpose() {
            Ok(built) => (built, None),
            Err(problem) => (None, Some(problem.to_string())),
        };
        let free = FreeInfo::of(scene, built.as_ref());
        Self {
            head: scene.head.mesh(),
            ellipsoid: head.as_ref().ok().map(|head| head.ellipsoid),
            head_problem: head.err().map(|problem| problem.to_string()),
            shell: scene.head.shell,
            head_motion: scene.head.motion.as_ref().map(|motion| motion_in_words(scene, motion)),
            hair,
            frames: scene.motion.frames,
            time_step: scene.motion.time_step,
            slow: scene.motion.slow,
            linear_density: scene.motion.linear_density,
            alpha: (free.is_none() || scene.free.pseudo_force).then_some(scene.pseudo_force.alpha),
            free,
            bodies: scene
                .bodies
                .iter()
                .enumerate()
                .map(|(i, body)| (format!("body[{i}]"), body_in_words(scene, body)))
                .collect(),
            force: scene.field.force.clone(),
            strengths: built.filter(|_| by_speed).map_or(Vec::new(), |built| built.forces.intervals().to_vec()),
            ease: scene.field.wind.ease,
            fields: in_words(&scene.field),
            bounds: bounds.as_ref().cloned().unwrap_or_default(),
            bounds_problem: bounds.err().map(|problem| problem.to_string()),
            disturbed_every: scene.disturbance.as_ref().map(|d| d.every),
            picture: scene.picture.size,
            unused: unused(scene).iter().map(Advice::to_string).collect(),
            problem,
        }
    }
}

impl fmt::Display for SceneInfo {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "scene: {} frames, {} x {} pixels", self.frames, self.picture[0], self.picture[1])?;
        write!(f, "head: {}", OneLine(&self.head))?;
        if let Some(motion) = &self.head_motion {
            write!(f, ", moved by {}", OneLine(motion))?;
        }
        writeln!(f)?;
        if let Some(Ellipsoid { center, half_axes }) = self.ellipsoid {
            let [x, y, z] = center.to_array().map(Short);
            let [a, b, c] = half_axes.to_array().map(Short);
            writeln!(f, "ellipsoid: {a} x {b} x {c} cm around ({x}, {y}, {z}), shell scale {}", Short(self.shell))?;
        }
        if let Some(problem) = &self.head_problem {
            writeln!(f, "ellipsoid: unknown, {}", OneLine(problem))?;
        }
        writeln!(f, "hair: {}", OneLine(&self.hair))?;
        let [step, density] = [("time_step", self.time_step), ("linear_density", self.linear_density)]
            .map(|(key, value)| labelled::<Motion>(key, value));
        let form = if self.free.is_some() { "free form, " } else { "" };
        write!(f, "motion: {form}{step}, {density}")?;
        if self.slow != 1.0 {
            write!(f, ", {}", labelled::<Motion>("slow", self.slow))?;
        }
        if let Some(alpha) = self.alpha {
            write!(f, ", {}", labelled::<PseudoForce>("alpha", alpha))?;
        }
        if let Some(every) = self.disturbed_every {
            write!(f, ", disturbed {}", labelled::<Disturbance>("every", every))?;
        }
        if let Some(free) = &self.free {
            write!(f, "\n{free}")?;
        }
        for (name, words) in &self.bodies {
            write!(f, "\n{name}: {}", OneLine(words))?;
        }
        let mut first = 1;
        for (j, key) in self.force.iter().enumerate() {
            let [x, y, z] = key.vector.to_array().map(Short);
            match key.speed {
                None => write!(f, "\nforce: ({x}, {y}, {z})")?,
                Some(speed) => write!(f, "\nforce: {speed} along ({x}, {y}, {z})")?,
            }
            if let (Some(_), Some(strength)) = (key.speed, self.strengths.get(j)) {
                write!(f, " (|F| = {})", grouped(strength.vector.length()))?;
            }
            write!(f, " in frames {first} to {}", key.through)?;
            first = key.through.saturating_add(1);
        }
        match self.ease {
            Ease::Stepped => {}
            Ease::Linear => write!(f, "\nwind: eased linearly from one to the next")?,
            Ease::Smooth => write!(f, "\nwind: eased smoothly from one to the next")?,
        }
        for (name, words) in &self.fields {
            write!(f, "\n{name}: {}", OneLine(words))?;
            match self.bounds.iter().find(|bound| bound.name == *name) {
                Some(FieldBound { at_most, .. }) if name == "gust" || name == "flow" => {
                    write!(f, ", at most {} times the wind", Short(*at_most))?;
                }
                Some(FieldBound { at_most, .. }) => write!(f, ", |F| at most {}", Short(*at_most))?,
                None => {}
            }
        }
        match (self.bounds.iter().find(|bound| bound.name == "all"), &self.bounds_problem) {
            (Some(all), _) => write!(f, "\nall fields: |F| at most {}", Short(all.at_most))?,
            (None, Some(problem)) => write!(f, "\nall fields: bound unknown, {}", OneLine(problem))?,
            (None, None) => {}
        }
        self.unused.iter().try_for_each(|line| write!(f, "\nwarning: {}", OneLine(line)))
    }
}

impl fmt::Display for FreeInfo {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { given, resolved, margin, neighbours, aims } = self;
        let number = |of: fn(&FreeForm) -> &Profile| resolved.as_ref().map(|form| of(form).values().to_vec());
        let told = [
            amounts("stiffness", &given.stiffness, number(|form| &form.stiffness)),
            amounts("hold", &given.hold, number(|form| &form.hold)),
            amounts("settle", &given.settle, number(|form| &form.settle)),
            amounts("gravity", &Profile::Even(given.gravity), resolved.as_ref().map(|form| vec![form.gravity])),
            labelled::<FreeSettings>("drag", given.drag.clone()),
        ];
        let steps = match resolved.as_ref().map(FreeForm::steps).or(given.substeps) {
            None => "steps per frame by weight and stiffness".to_owned(),
            Some(1) => "1 step per frame".to_owned(),
            Some(steps) => format!("{steps} steps per frame"),
        };
        write!(f, "free: {}, {steps}\ncontact: {}", told.join(", "), labelled::<Contact>("margin", *margin))?;
        if let Some(NeighbourForces { cohesion, pressure, .. }) = neighbours {
            let of = |key: &str, strength: f32| labelled::<NeighbourForces>(key, strength);
            write!(f, "\nneighbours: {}, {}", of("cohesion", *cohesion), of("pressure", *pressure))?;
        }
        for (i, region) in given.regions.iter().enumerate() {
            write!(f, "\nfree.regions[{i}]: {}", OneLine(&region_in_words(region)))?;
        }
        for (i, aim) in aims.iter().enumerate() {
            write!(f, "\naim[{i}]: {}", OneLine(&aim_in_words(aim)))?;
        }
        Ok(())
    }
}

/// A region: `bangs, groups fringe, roots within 4 to 6 cm of (8.5, 4, 0): hold x 3, wind x 0.3`.
fn region_in_words(region: &Region) -> String {
    let name = if region.name.is_empty() { String::new() } else { format!("{}, ", region.name) };
    let mut strands = Vec::new();
    if !region.groups.is_empty() {
        strands.push(format!("groups {}", region.groups.join(" and ")));
    }
    strands.extend(region.attribute.as_ref().map(|attribute| match &region.values[..] {
        [] => format!("attribute {attribute}"),
        values => {
            format!("attribute {attribute} of {}", values.iter().map(i32::to_string).collect::<Vec<_>>().join(", "))
        }
    }));
    strands.extend(region.map.as_ref().map(|map| format!("map {}", map.display())));
    match region.painted.len() {
        0 => {}
        1 => strands.push("1 painted point".to_owned()),
        count => strands.push(format!("{count} painted points")),
    }
    if let Some(near) = region.near {
        let [inner, outer] = [region.within, region.within + region.soft].map(Short);
        let place = match region.to {
            None => point(near),
            Some(to) => format!("the line from {} to {}", point(near), point(to)),
        };
        strands.push(format!("roots within {inner} to {outer} cm of {place}"));
    }
    let [wind, gravity, margin] = [region.wind, region.gravity, region.margin].map(Profile::Even);
    let factors = [
        ("stiffness", &region.stiffness),
        ("hold", &region.hold),
        ("settle", &region.settle),
        ("wind", &wind),
        ("drag", &region.drag),
        ("gravity", &gravity),
        ("margin", &margin),
    ];
    let along = |factor: &Profile| {
        let values: Vec<String> = factor.values().iter().map(|&value| Short(value).to_string()).collect();
        values.join(" to ")
    };
    let mut told: Vec<String> = (factors.into_iter().filter(|&(_, factor)| *factor != Profile::Even(1.0)))
        .map(|(key, factor)| format!("{key} x {}", along(factor)))
        .collect();
    told.extend(region.fields.iter().map(|of| format!("{} x {}", of.field, Short(of.share))));
    let told = if told.is_empty() { "no change".to_owned() } else { told.join(", ") };
    format!("{name}{}: {told}", strands.join(", "))
}

/// An aim: `bow, region fringe: pose.usda in frame 60, 3 g in frames 40 to 60, eased over 12 and 12`.
fn aim_in_words(aim: &AimSettings) -> String {
    let name = if aim.name.is_empty() { String::new() } else { format!("{}, ", aim.name) };
    let hair = aim.region.as_ref().map_or_else(|| "all hair".to_owned(), |region| format!("region {region}"));
    let curves = match aim.curves.len() {
        0 => aim.file.display().to_string(),
        1 => "1 curve".to_owned(),
        count => format!("{count} curves"),
    };
    let shape = match (aim.toward, aim.frame) {
        (Some(p), _) => format!("toward {}", point(p)),
        _ if aim.groom => "to the groom".to_owned(),
        (None, Some(frame)) => format!("{curves} in frame {frame}"),
        (None, None) => format!("{curves} on the head at rest"),
    };
    let strength = match aim.strength {
        Amount::Number(number) => format!("strength {}", Short(number)),
        Amount::World(quantity) => quantity.to_string(),
    };
    let end = aim.through.map_or_else(|| "the end".to_owned(), |frame| frame.to_string());
    let AimSettings { from, ease_in, ease_out, .. } = aim;
    format!("{name}{hair}: {shape}, {strength} in frames {from} to {end}, eased over {ease_in} and {ease_out}")
}

fn point(p: Vec3) -> String {
    let [x, y, z] = p.to_array().map(Short);
    format!("({x}, {y}, {z})")
}

/// A setting of `[free]` as given, and its value if it is in a physical unit: `stiffness 9 cm to 4.5 cm (K = 250,000 to
/// 31,000)`.
fn amounts<M: Measure>(key: &str, given: &Profile<Amount<M>>, numbers: Option<Vec<f32>>) -> String {
    let setting = FreeSettings::TABLE.setting(key);
    let one = |amount: &Amount<M>| match amount {
        Amount::Number(number) => Short(*number).to_string(),
        Amount::World(quantity) => quantity.to_string(),
    };
    let told = given.values().iter().map(one).collect::<Vec<_>>().join(" to ");
    let unit = if setting.range.unit.is_empty() { String::new() } else { format!(" {}", setting.range.unit) };
    let label = setting.label.to_lowercase();
    if !is_of_world(given) {
        return format!("{label} {told}{unit}");
    }
    match numbers {
        None => format!("{label} {told}"),
        Some(numbers) => format!("{label} {told} ({})", come_to(setting, &numbers)),
    }
}

/// Numbers of a setting of `[free]`, with its symbol and in its own unit: `K = 250,000 to 31,000`.
fn come_to(setting: &Setting, numbers: &[f32]) -> String {
    let symbol = match setting.key {
        "stiffness" => "K = ",
        "hold" => "H = ",
        _ => "",
    };
    let unit = if setting.range.unit.is_empty() { String::new() } else { format!(" {}", setting.range.unit) };
    let numbers: Vec<String> = numbers.iter().map(|&number| grouped(number)).collect();
    format!("{symbol}{}{unit}", numbers.join(" to "))
}

impl BuiltScene {
    /// The value in its own unit of a setting that is given in a physical unit. For `free.stiffness`: `K = 250,000 to
    /// 31,000`.
    pub fn comes_to(&self, key: &str) -> Option<String> {
        let (Form::Free(free), Some(key)) = (&self.dynamics.form, key.strip_prefix("free.")) else { return None };
        let (given, form) = (&self.scene.free, &free.form);
        let (of_world, numbers) = match key {
            "stiffness" => (is_of_world(&given.stiffness), form.stiffness.values()),
            "hold" => (is_of_world(&given.hold), form.hold.values()),
            "settle" => (is_of_world(&given.settle), form.settle.values()),
            "gravity" => (given.gravity.quantity().is_some(), std::slice::from_ref(&form.gravity)),
            _ => return None,
        };
        of_world.then(|| come_to(FreeSettings::TABLE.setting(key), numbers))
    }
}

/// Whether any of the numbers is in a physical unit.
fn is_of_world<M: Measure>(given: &Profile<Amount<M>>) -> bool {
    given.values().iter().any(|amount| amount.quantity().is_some())
}

/// A number with three significant digits, and commas between its thousands.
fn grouped(number: f32) -> String {
    let size = number.abs();
    if size < 1000.0 || !size.is_finite() {
        return Short(number).to_string();
    }
    let unit = 10.0_f64.powf(f64::from(size).log10().floor() - 2.0);
    let digits = format!("{:.0}", (f64::from(number) / unit).round() * unit);
    let groups = |digits: &str| {
        let bytes: Vec<&[u8]> = digits.as_bytes().rchunks(3).rev().collect();
        bytes.iter().map(|group| String::from_utf8_lossy(group)).collect::<Vec<_>>().join(",")
    };
    match digits.strip_prefix('-') {
        Some(digits) => format!("-{}", groups(digits)),
        None => groups(&digits),
    }
}

/// A file as named in the scene, with a note if it is missing.
fn named(scene: &Scene, file: &Path) -> String {
    let missing = if scene.resolve(file).exists() { "" } else { " (missing)" };
    format!("{}{missing}", file.display())
}

/// The file of a motion, and that of its skeleton.
fn motion_in_words(scene: &Scene, motion: &MotionSource) -> String {
    let skeleton = motion.skeleton.as_ref().map(|skeleton| format!(" of {}", named(scene, skeleton)));
    named(scene, &motion.file) + &skeleton.unwrap_or_default()
}

/// A body: its file, motion and contact.
fn body_in_words(scene: &Scene, body: &BodySettings) -> String {
    let way = match &body.motion {
        _ if body.with_head => "moves with the head".to_owned(),
        Some(motion) => format!("moved by {}", motion_in_words(scene, motion)),
        None => "stands still".to_owned(),
    };
    let felt = match scene.form {
        _ if !body.solid => "not solid".to_owned(),
        FormChoice::Paper => "no effect in the paper's form".to_owned(),
        FormChoice::Free => labelled::<Contact>("margin", body.margin),
    };
    let seen = if body.shown { "" } else { ", hidden" };
    let shape = match body.capsule {
        None => named(scene, &body.mesh),
        Some(CapsuleSettings { to: None, radius, .. }) => format!("a ball of radius {} cm", Short(radius)),
        Some(CapsuleSettings { radius, .. }) => format!("a capsule of radius {} cm", Short(radius)),
    };
    format!("{shape}, {way}, {felt}{seen}")
}

/// The fields other than `[[force]]`, each by its table, in the words of the schema.
fn in_words(field: &FieldSettings) -> Vec<(String, String)> {
    let FieldSettings { force: _, wind: _, gust, body_wind, flow, turbulence, point, vortex, fan, own } = field;
    fn one<T: Settings>(name: &str, table: Option<&T>) -> Option<(String, String)> {
        Some((name.to_owned(), said(&T::TABLE, &table?.datum())))
    }
    fn each<T: Settings>(name: &str, list: &[T]) -> impl Iterator<Item = (String, String)> {
        list.iter().enumerate().map(move |(i, entry)| (format!("{name}[{i}]"), said(&T::TABLE, &entry.datum())))
    }
    let own = (0..own.len()).map(|i| (format!("own[{i}]"), "a field from a program".to_owned()));
    let winds = [
        one("gust", gust.as_ref()),
        one("body_wind", body_wind.as_ref()),
        one("flow", flow.as_ref()),
        one("turbulence", turbulence.as_ref()),
    ];
    let local = each("point", point).chain(each("vortex", vortex)).chain(each("fan", fan));
    winds.into_iter().flatten().chain(local).chain(own).collect()
}

/// The settings of a table by their labels: `strength 30, swirl size 10 cm`.
fn said(table: &Table, values: &Datum) -> String {
    let Datum::Table(values) = values else { return String::new() };
    let all = table.settings.iter().zip(values).filter_map(|(setting, (_, value))| one_said(setting, value));
    all.collect::<Vec<_>>().join(", ")
}

/// A setting of a table with its label from the schema, and its unit.
fn labelled<T: Settings>(key: &str, value: impl Value) -> String {
    let setting = T::TABLE.settings.iter().find(|setting| setting.key == key);
    setting.and_then(|setting| one_said(setting, &value.datum())).unwrap_or_default()
}

fn one_said(setting: &Setting, value: &Datum) -> Option<String> {
    let number = |x: &Datum| if let Datum::Number(x) = x { Short(*x as f32).to_string() } else { String::new() };
    let value = match (value, &setting.kind) {
        (Datum::Open, _) => return None,
        (Datum::Table(_), Kind::Table(below)) => return Some(said(below, value)),
        (Datum::List(keys), Kind::List(_)) if keys.is_empty() => return None,
        (Datum::List(keys), Kind::List(_)) => format!("by {} keys", keys.len()),
        // From root to tip.
        (Datum::List(numbers), Kind::OneOf(_)) => numbers.iter().map(number).collect::<Vec<_>>().join(" to "),
        (Datum::List(numbers), _) => format!("({})", numbers.iter().map(number).collect::<Vec<_>>().join(", ")),
        (Datum::Number(_), _) => number(value),
        (Datum::Text(word), _) => word.clone(),
        (value, _) => schema::in_toml(value),
    };
    let unit = if setting.range.unit.is_empty() { String::new() } else { format!(" {}", setting.range.unit) };
    Some(format!("{} {value}{unit}", setting.label.to_lowercase()))
}
