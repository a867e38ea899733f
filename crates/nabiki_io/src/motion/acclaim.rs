//! Acclaim motion: one bone's way out of an .amc file and the .asf skeleton that it moves.
//!
//! The .asf gives each bone a direction and a length in the rest pose, and an axis frame C in which its angles turn.
//! A bone's angles make M, the first listed turning first, and C M C^-1 turns it from the rest pose, seen from its
//! parent. A bone starts where its parent ends. The rotation given is that from the rest pose, in which the whole
//! body is unturned, and the position is where the bone starts.
//!
//! Lengths are in inches times the `length` of the .asf's units, which is how the format's definition (Acclaim,
//! version 1.10) uses that number, and CMU's files with their 0.45.

use std::collections::HashMap;

use glam::{DQuat, DVec3};

use super::joints::{Tree, check_poses};
use super::source::asked;
use super::track::{Sample, Track};
use crate::error::{Error, Result};

/// What one number of the motion drives.
#[derive(Clone, Copy)]
enum Freedom {
    Move(usize),
    Turn(DVec3),
}

struct Bone {
    name: String,
    parent: Option<usize>,
    /// From its start to its end in the rest pose (file's unit).
    offset: DVec3,
    /// C.
    axes: DQuat,
    freedoms: Vec<Freedom>,
}

/// The bones of an .asf; the first is the root.
pub(super) struct Skeleton {
    bones: Vec<Bone>,
    numbers: HashMap<String, usize>,
    /// Whether angles are in degrees, unless a motion says otherwise.
    degrees: bool,
    /// Length of the file's unit (cm), where it says so.
    pub unit_cm: Option<f64>,
}

/// A line's number, counted from 1, and its words.
type Line<'a> = (usize, Vec<&'a str>);

/// The lines that hold more than a comment. Commas and parentheses count as spaces.
fn lines(text: &str) -> impl Iterator<Item = Line<'_>> {
    text.lines().enumerate().filter_map(|(i, line)| {
        let line = line.split('#').next().unwrap_or_default();
        let between = |c: char| c.is_ascii_whitespace() || matches!(c, ',' | '(' | ')');
        let words: Vec<&str> = line.split(between).filter(|word| !word.is_empty()).collect();
        (!words.is_empty()).then_some((i + 1, words))
    })
}

fn refusal(line: usize, what: impl Into<String>) -> Error {
    Error::new(what).at_line(Some(line))
}

fn number(line: usize, word: Option<&&str>, what: &str) -> Result<f64> {
    let word = word.copied().unwrap_or_default();
    match word.parse::<f64>() {
        Ok(x) if x.is_finite() => Ok(x),
        _ => Err(refusal(line, format!("{what} \"{word:.40}\": not a finite number"))),
    }
}

fn triple(line: usize, words: &[&str], what: &str) -> Result<DVec3> {
    let [x, y, z] = [0, 1, 2].map(|i| number(line, words.get(i), what));
    Ok(DVec3::new(x?, y?, z?))
}

fn axis(letter: char) -> Option<usize> {
    "xyz".find(letter.to_ascii_lowercase())
}

/// The axes of `XYZ` or the like, in the order in which they are turned about.
fn order(line: usize, word: Option<&&str>) -> Result<Vec<DVec3>> {
    let word = word.copied().unwrap_or_default();
    let axes: Option<Vec<DVec3>> = word.chars().map(|c| axis(c).map(|a| DVec3::AXES[a])).collect();
    match axes {
        Some(axes) if axes.len() == 3 => Ok(axes),
        _ => Err(refusal(line, format!("axis order \"{word:.40}\": must be three letters such as XYZ"))),
    }
}

/// `rx`, `tz` and the like.
fn freedom(line: usize, word: &str) -> Result<Freedom> {
    let letters: Vec<char> = word.to_ascii_lowercase().chars().collect();
    match letters[..] {
        ['r', letter] if axis(letter).is_some() => Ok(Freedom::Turn(DVec3::AXES[axis(letter).unwrap_or_default()])),
        ['t', letter] if axis(letter).is_some() => Ok(Freedom::Move(axis(letter).unwrap_or_default())),
        _ => Err(refusal(line, format!("\"{word:.40}\": a root moves by tx..tz and rx..rz, a bone by rx, ry and rz"))),
    }
}

/// The product of turns about fixed axes, the first of them first.
fn turn(turns: impl Iterator<Item = (DVec3, f64)>) -> DQuat {
    turns.fold(DQuat::IDENTITY, |before, (axis, angle)| DQuat::from_axis_angle(axis, angle) * before)
}

impl Skeleton {
    /// Reads an .asf.
    pub(super) fn read(text: &str) -> Result<Self> {
        let root = Bone {
            name: "root".to_owned(),
            parent: None,
            offset: DVec3::ZERO,
            axes: DQuat::IDENTITY,
            freedoms: Vec::new(),
        };
        let mut skeleton = Self { bones: vec![root], numbers: HashMap::new(), degrees: true, unit_cm: None };
        skeleton.numbers.insert("root".to_owned(), 0);
        let mut section = String::new();
        let mut angle = None;
        // The bone between a `begin` and its `end`.
        let mut open: Option<Vec<Line<'_>>> = None;
        for (line, words) in lines(text) {
            if words[0].starts_with(':') {
                section = words[0].to_ascii_lowercase();
                continue;
            }
            let word = words[0].to_ascii_lowercase();
            match (section.as_str(), word.as_str()) {
                ("", _) => return Err(refusal(line, format!("\"{word:.40}\": a keyword like :version comes first"))),
                (":units", "length") => {
                    let length = number(line, words.get(1), "length")?;
                    if length <= 0.0 {
                        return Err(refusal(line, format!("length {length}: must be above 0")));
                    }
                    skeleton.unit_cm = Some(2.54 / length);
                }
                (":units", "angle") => {
                    let unit = words.get(1).copied().unwrap_or_default();
                    angle = Some(unit.to_ascii_lowercase().starts_with("deg"));
                    if !["deg", "rad"].iter().any(|known| unit.to_ascii_lowercase().starts_with(known)) {
                        return Err(refusal(line, format!("angle \"{unit:.40}\": must be deg or rad")));
                    }
                }
                (":root", "order") => {
                    let freedoms = words[1..].iter().map(|word| freedom(line, word));
                    skeleton.bones[0].freedoms = freedoms.collect::<Result<_>>()?;
                }
                (":root", "position" | "orientation") if triple(line, &words[1..], &word)? != DVec3::ZERO => {
                    let why = "programs disagree on what a preset of the root means; only 0 0 0 is read";
                    return Err(refusal(line, format!("root {word} {}: {why}", words[1..].join(" "))));
                }
                (":bonedata", "begin") => open = Some(Vec::new()),
                (":bonedata", "end") => {
                    let lines = open.take().ok_or_else(|| refusal(line, "end without a begin"))?;
                    let bone = bone(line, &lines, angle)?;
                    if skeleton.numbers.insert(bone.name.to_lowercase(), skeleton.bones.len()).is_some() {
                        return Err(refusal(line, format!("bone {}: defined twice", bone.name)));
                    }
                    skeleton.bones.push(bone);
                }
                (":bonedata", _) => match &mut open {
                    Some(lines) => lines.push((line, words)),
                    None => return Err(refusal(line, format!("\"{word:.40}\": a bone begins with begin"))),
                },
                (":hierarchy", "begin" | "end") => {}
                (":hierarchy", _) => skeleton.hang(line, &words)?,
                _ => {}
            }
        }
        skeleton.degrees =
            angle.ok_or_else(|| Error::new(":units has no angle: a line angle deg or angle rad is needed"))?;
        if skeleton.bones.len() == 1 || open.is_some() {
            return Err(Error::new("has no complete :bonedata: is it a complete Acclaim skeleton?"));
        }
        Ok(skeleton)
    }

    /// Hangs the children named after the first word below the bone that it names.
    fn hang(&mut self, line: usize, words: &[&str]) -> Result<()> {
        let numbers = words.iter().map(|&word| {
            let found = self.numbers.get(&word.to_lowercase()).copied();
            found.ok_or_else(|| refusal(line, format!("\"{word:.40}\": no bone of that name is in :bonedata")))
        });
        let numbers: Vec<usize> = numbers.collect::<Result<_>>()?;
        for &child in &numbers[1..] {
            if child == 0 || self.bones[child].parent.replace(numbers[0]).is_some() {
                return Err(refusal(line, format!("bone {}: has two parents", self.bones[child].name)));
            }
        }
        Ok(())
    }

    /// Names of all bones, the root first.
    pub(super) fn names(&self) -> Vec<String> {
        self.bones.iter().map(|bone| bone.name.clone()).collect()
    }

    /// The bones from the root down to `node`.
    pub(super) fn chain(&self, node: &str) -> Result<Vec<usize>> {
        let names = self.bones.iter().map(|bone| Some(bone.name.as_str())).collect();
        let parents = self.bones.iter().map(|bone| bone.parent).collect();
        let chain = Tree { kind: "bone", names, parents }.chain(node)?;
        if chain[0] != 0 {
            return Err(Error::new(format!("bone {node}: :hierarchy does not connect it to the root")));
        }
        Ok(chain)
    }

    /// Reads the way of the last bone of `chain` out of an .amc. `rate`: samples a second, where the scene gives them.
    pub(super) fn track(&self, chain: &[usize], text: &str, rate: Option<f64>) -> Result<Track> {
        let mut degrees = self.degrees;
        let mut rate_in_file = None;
        let mut samples = Vec::new();
        let mut frame: Option<(usize, u64)> = None;
        let mut row = Row { values: vec![Vec::new(); self.bones.len()], frame: vec![0; self.bones.len()] };
        for (line, words) in lines(text) {
            match words[..] {
                [keyword] if keyword.eq_ignore_ascii_case(":degrees") => degrees = true,
                [keyword] if keyword.eq_ignore_ascii_case(":radians") => degrees = false,
                [keyword, per_second] if keyword.eq_ignore_ascii_case(":samples-per-second") => {
                    rate_in_file = Some(number(line, Some(&per_second), keyword)?);
                }
                [keyword, ..] if keyword.starts_with(':') => {}
                [word] if is_frame(word) => {
                    let next = word.parse().map_err(|_| refusal(line, format!("frame {word:.40}: too large")))?;
                    if let Some((begun, before)) = frame {
                        check_poses(chain.len(), samples.len())?;
                        samples.push(self.pose(chain, &row, samples.len() + 1, degrees).map_err(|e| at(e, begun))?);
                        if before.checked_add(1) != Some(next) {
                            let what = format!("frame {next} follows frame {before}: frames must have no gaps");
                            return Err(refusal(line, what));
                        }
                    }
                    frame = Some((line, next));
                }
                [name, ..] if frame.is_some() => self.fill(&mut row, line, name, &words[1..], samples.len() + 1)?,
                _ => return Err(refusal(line, format!("\"{:.40}\": a frame's number expected here", words[0]))),
            }
        }
        let (begun, _) = frame.ok_or_else(|| Error::new("holds no frames: is it Acclaim motion?"))?;
        samples.push(self.pose(chain, &row, samples.len() + 1, degrees).map_err(|e| at(e, begun))?);
        let rate = sample_rate(rate_in_file, rate)?;
        let times = (0..samples.len()).map(|i| i as f64 / rate).collect();
        let what = format!("bone {}", self.bones[chain[chain.len() - 1]].name);
        Ok(Track { times, samples, what, unit_cm: self.unit_cm, ..Track::default() })
    }

    /// Takes the numbers of one bone in the `sample`th frame, counted from 1.
    fn fill(&self, row: &mut Row, line: usize, name: &str, words: &[&str], sample: usize) -> Result<()> {
        let found = self.numbers.get(&name.to_lowercase()).copied();
        let bone = found.ok_or_else(|| {
            refusal(line, format!("bone {name:.40} is not in the skeleton: does the .asf belong to this motion?"))
        })?;
        let (given, wanted) = (words.len(), self.bones[bone].freedoms.len());
        if given != wanted {
            let what = format!("bone {name}: {given} numbers, but the skeleton gives it {wanted} degrees of freedom");
            return Err(refusal(line, what));
        }
        if std::mem::replace(&mut row.frame[bone], sample) == sample {
            return Err(refusal(line, format!("bone {name}: occurs twice in one frame")));
        }
        row.values[bone].clear();
        for word in words {
            row.values[bone].push(number(line, Some(word), name)?);
        }
        Ok(())
    }

    /// Where the chain's last bone is in the `sample`th frame.
    fn pose(&self, chain: &[usize], row: &Row, sample: usize, degrees: bool) -> Result<Sample> {
        let mut world = Sample { position: DVec3::ZERO, rotation: DQuat::IDENTITY };
        let mut end = DVec3::ZERO;
        for &number in chain {
            let bone = &self.bones[number];
            if !bone.freedoms.is_empty() && row.frame[number] != sample {
                return Err(Error::new(format!("bone {}: has no numbers in this frame", bone.name)));
            }
            let values = &row.values[number];
            let in_radians = |value: f64| if degrees { value.to_radians() } else { value };
            let turned = turn(bone.freedoms.iter().zip(values).filter_map(|(freedom, &value)| match *freedom {
                Freedom::Turn(axis) => Some((axis, in_radians(value))),
                Freedom::Move(_) => None,
            }));
            world.position += world.rotation * end;
            for (freedom, &value) in bone.freedoms.iter().zip(values) {
                if let Freedom::Move(axis) = *freedom {
                    world.position[axis] += value;
                }
            }
            world.rotation *= bone.axes * turned * bone.axes.inverse();
            end = bone.offset;
        }
        world.rotation = world.rotation.normalize();
        Ok(world)
    }
}

/// What an .amc says without its skeleton.
#[derive(Default)]
pub(super) struct Outline {
    /// Number of frames.
    pub frames: usize,
    /// Samples a second, where the file says so.
    pub rate: Option<f64>,
    /// Bones of the first frame.
    pub names: Vec<String>,
}

/// Looks through an .amc.
pub(super) fn outline(text: &str) -> Result<Outline> {
    let mut outline = Outline::default();
    for (line, words) in lines(text) {
        match words[..] {
            [keyword, per_second] if keyword.eq_ignore_ascii_case(":samples-per-second") => {
                outline.rate = Some(number(line, Some(&per_second), keyword)?);
            }
            [word] if is_frame(word) => outline.frames += 1,
            [name, ..] if outline.frames == 1 => outline.names.push(name.to_owned()),
            _ => {}
        }
    }
    if outline.frames == 0 {
        return Err(Error::new("holds no frames: is it Acclaim motion?"));
    }
    Ok(outline)
}

/// Whether a line of this one word begins a frame.
fn is_frame(word: &str) -> bool {
    word.bytes().all(|byte| byte.is_ascii_digit())
}

/// The numbers of every bone, and the frame, counted from 1, that they were last given in.
struct Row {
    values: Vec<Vec<f64>>,
    frame: Vec<usize>,
}

fn at(error: Error, line: usize) -> Error {
    error.at_line(Some(line))
}

/// The rate that the file gives, or else the scene.
fn sample_rate(in_file: Option<f64>, in_scene: Option<f64>) -> Result<f64> {
    let rate = match (in_file, in_scene) {
        (Some(rate), None) | (None, Some(rate)) => rate,
        (Some(rate), Some(_)) => {
            return Err(Error::new(format!(
                "frames_per_second: the file already has {rate} samples per second; remove frames_per_second"
            )));
        }
        (None, None) => return Err(asked("frames_per_second", "120")),
    };
    if !(rate.is_finite() && rate > 0.0) {
        return Err(Error::new(format!("frames_per_second = {rate}: must be a finite number above 0")));
    }
    Ok(rate)
}

/// A bone out of the lines between its `begin` and the `end` in line `end`.
fn bone(end: usize, lines: &[Line<'_>], degrees: Option<bool>) -> Result<Bone> {
    let (mut name, mut direction, mut length) = (None, None, None);
    let (mut axes, mut freedoms) = (DQuat::IDENTITY, Vec::new());
    for (line, words) in lines {
        let (line, rest) = (*line, &words[1..]);
        match words[0].to_ascii_lowercase().as_str() {
            "name" => name = rest.first().copied(),
            "direction" => direction = Some(triple(line, rest, "direction")?),
            "length" => length = Some(number(line, rest.first(), "length")?),
            "axis" => {
                let in_degrees =
                    degrees.ok_or_else(|| refusal(line, "axis: :units should say angle deg or rad first"))?;
                let angles = triple(line, rest, "axis")?;
                let angles = if in_degrees { angles * 1f64.to_radians() } else { angles };
                axes = turn(order(line, rest.get(3))?.into_iter().zip(angles.to_array()));
            }
            "dof" => {
                freedoms = rest.iter().map(|word| freedom(line, word)).collect::<Result<_>>()?;
                if freedoms.iter().any(|freedom| matches!(freedom, Freedom::Move(_))) {
                    return Err(refusal(line, "dof tx, ty, tz: bones that leave their parents are not read"));
                }
            }
            _ => {}
        }
    }
    let missing = |what: &str| refusal(end, format!("a bone without {what} ends here"));
    let name = name.ok_or_else(|| missing("a name"))?.to_owned();
    let direction: DVec3 = direction.ok_or_else(|| missing("a direction"))?;
    let offset = direction * length.ok_or_else(|| missing("a length"))?;
    Ok(Bone { name, parent: None, offset, axes, freedoms })
}

#[cfg(test)]
#[path = "acclaim_tests.rs"]
pub(super) mod tests;
