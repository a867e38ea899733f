//! Jolt object streams in text: one joint's way out of a `SkeletalAnimation` and the `Skeleton` that it moves, each in
//! a .tof file.
//!
//! The animation holds keys for each joint, all local to the joint's parent: rotation, translation, time (s). Between
//! keys, translations are on straight lines and rotations turn at a constant rate, as in Jolt. The skeleton says who
//! is whose parent and nothing of a rest pose, so the rotation given is the joint's own, from its axes to the file's
//! world: the joint is unturned where the two agree. Jolt itself counts in metres with y up, but a file does not say so.
//!
//! Declared shapes say how many words a value has. The shape of a reference and that of a value in place are declared
//! alike, so only the two classes wanted are read, and the rest of a file is passed over word by word.

use std::collections::HashMap;

use glam::{DQuat, DVec3};

use super::joints::{Tree, check_poses};
use super::track::{Sample, Track};
use super::words::Words;
use crate::error::{Error, Result};

/// Attributes of a class in the order of its values: name and type.
type Shape = Vec<(String, String)>;

const JOINT: [(&str, &str); 2] = [("mName", "string"), ("mParentName", "string")];
const ANIMATED_JOINT: [(&str, &str); 2] =
    [("mJointName", "string"), ("mKeyframes", "array instance SkeletalAnimation::Keyframe")];
const KEYFRAME: [(&str, &str); 3] = [("mRotation", "quat"), ("mTranslation", "vec3"), ("mTime", "float")];

/// A joint of a skeleton.
pub(super) struct Joint {
    /// Its name.
    pub name: String,
    parent: String,
}

/// A joint's pose seen from its parent, at a time (s).
struct Key {
    time: f64,
    position: DVec3,
    rotation: DQuat,
}

/// The keys of a joint.
pub(super) struct AnimatedJoint {
    /// Its name.
    pub name: String,
    keys: Vec<Key>,
}

/// Reads the joints of the `Skeleton` in a file.
pub(super) fn skeleton(text: &str) -> Result<Vec<Joint>> {
    let (mut words, shapes) = object(text, "Skeleton")?;
    expect_first(&shapes, "Skeleton", "mJoints", "array instance Skeleton::Joint")?;
    expect(&shapes, "Skeleton::Joint", &JOINT)?;
    let mut joints = Vec::new();
    for _ in 0..words.count("joints")? {
        joints.push(Joint { name: words.text("a joint's name")?, parent: words.text("a parent's name")? });
    }
    Ok(joints)
}

/// Reads the keys of the `SkeletalAnimation` in a file.
pub(super) fn animation(text: &str) -> Result<Vec<AnimatedJoint>> {
    let (mut words, shapes) = object(text, "SkeletalAnimation")?;
    let joints = "array instance SkeletalAnimation::AnimatedJoint";
    expect_first(&shapes, "SkeletalAnimation", "mAnimatedJoints", joints)?;
    expect(&shapes, "SkeletalAnimation::AnimatedJoint", &ANIMATED_JOINT)?;
    expect(&shapes, "SkeletalAnimation::Keyframe", &KEYFRAME)?;
    let mut animated = Vec::new();
    for _ in 0..words.count("animated joints")? {
        let mut joint = AnimatedJoint { name: words.text("a joint's name")?, keys: Vec::new() };
        for _ in 0..words.count("keys")? {
            let key = words.key().map_err(|e| e.under(format!("joint {}", joint.name)))?;
            if joint.keys.last().is_some_and(|last| last.time >= key.time) {
                let what = format!("joint {}: time {} s: times must increase", joint.name, key.time);
                return Err(Error::new(what).at_line(Some(words.line())));
            }
            joint.keys.push(key);
        }
        animated.push(joint);
    }
    Ok(animated)
}

/// Duration (s) and number of the keys of the joint that has most.
pub(super) fn extent(joints: &[AnimatedJoint]) -> (f64, usize) {
    let keys = joints.iter().map(|joint| &joint.keys).max_by_key(|keys| keys.len());
    let ends = keys.and_then(|keys| keys.first().zip(keys.last()));
    (ends.map_or(0.0, |(first, last)| last.time - first.time), keys.map_or(0, Vec::len))
}

/// Names of the joints from the root down to `node`.
pub(super) fn chain(skeleton: &[Joint], node: &str) -> Result<Vec<String>> {
    let mut numbers: HashMap<&str, usize> = HashMap::new();
    for (number, joint) in skeleton.iter().enumerate() {
        if numbers.insert(&joint.name, number).is_some() {
            return Err(twice(&joint.name, "the skeleton"));
        }
    }
    let names = skeleton.iter().map(|joint| Some(joint.name.as_str())).collect();
    let parents = skeleton.iter().map(|joint| numbers.get(joint.parent.as_str()).copied()).collect();
    let chain = Tree { kind: "joint", names, parents }.chain(node)?;
    let root = &skeleton[chain[0]];
    if !root.parent.is_empty() {
        return Err(Error::new(format!("joint {}: its parent {} is not in the skeleton", root.name, root.parent)));
    }
    Ok(chain.into_iter().map(|joint| skeleton[joint].name.clone()).collect())
}

/// Joints are told apart, and find their parents and keys, by name alone.
fn twice(name: &str, place: &str) -> Error {
    Error::new(format!("joint {name:.80}: occurs twice in {place}, but names must differ: rename one"))
}

/// The way of the last joint of `chain`, at every time at which a joint of it has a key.
pub(super) fn track(chain: &[String], animation: &[AnimatedJoint]) -> Result<Track> {
    let mut animated: HashMap<&str, &[Key]> = HashMap::new();
    for joint in animation {
        if animated.insert(&joint.name, &joint.keys).is_some() {
            return Err(twice(&joint.name, "the animation"));
        }
    }
    let keys = chain.iter().map(|name| match animated.get(name.as_str()) {
        Some(keys) if !keys.is_empty() => Ok(*keys),
        _ => Err(Error::new(format!("joint {name}: has no keys: does the animation belong to the skeleton?"))),
    });
    let keys: Vec<&[Key]> = keys.collect::<Result<_>>()?;
    let mut times: Vec<f64> = keys.iter().copied().flatten().map(|key| key.time).collect();
    times.sort_unstable_by(f64::total_cmp);
    times.dedup();
    check_poses(keys.len(), times.len())?;
    let samples = times.iter().map(|&time| {
        let mut world = Sample { position: DVec3::ZERO, rotation: DQuat::IDENTITY };
        for keys in &keys {
            let local = at(keys, time);
            world.position += world.rotation * local.position;
            world.rotation = (world.rotation * local.rotation).normalize();
        }
        world
    });
    let samples = samples.collect();
    let what = format!("joint {}", chain[chain.len() - 1]);
    Ok(Track { times, samples, what, ..Track::default() })
}

/// The pose at `time`; before the first key and after the last, theirs.
fn at(keys: &[Key], time: f64) -> Sample {
    let after = keys.partition_point(|key| key.time <= time);
    let a = &keys[after.saturating_sub(1)];
    let b = &keys[after.min(keys.len() - 1)];
    let u = if after == 0 || b.time <= a.time { 0.0 } else { (time - a.time) / (b.time - a.time) };
    Sample { position: a.position.lerp(b.position, u), rotation: a.rotation.slerp(b.rotation, u) }
}

/// What follows the head of the first object of `class`, and the shapes declared before it.
fn object<'a>(text: &'a str, class: &str) -> Result<(Words<'a>, HashMap<String, Shape>)> {
    let mut words = Words::quoted(text);
    match (words.next("TOS"), words.next("a version")) {
        (Ok("TOS"), Ok(version)) if version.split('.').next() == Some("1") => {}
        (Ok("TOS"), Ok(version)) => {
            return Err(Error::new(format!("version {version:.40}: only text object streams of version 1 are read")));
        }
        _ => return Err(Error::new("does not start with TOS: not a text object stream of Jolt")),
    }
    let mut shapes = HashMap::new();
    let mut others: Vec<&str> = Vec::new();
    loop {
        let word = words.next(class).map_err(|_| {
            let held = if others.is_empty() { String::new() } else { format!(", only {}", others.join(", ")) };
            Error::new(format!("holds no {class}{held}: is this the right file?"))
        })?;
        match word {
            "declare" => {
                let name = words.next("a class")?.to_owned();
                shapes.insert(name, shape(&mut words)?);
            }
            "object" => {
                let found = words.next("a class")?;
                words.next("an object's number")?;
                if found == class {
                    return Ok((words, shapes));
                }
                if others.len() < 20 && !others.contains(&found) {
                    others.push(found);
                }
            }
            _ => {}
        }
    }
}

/// The attributes that a declaration lists.
fn shape(words: &mut Words<'_>) -> Result<Shape> {
    let mut shape = Shape::new();
    for _ in 0..words.count("attributes")? {
        let name = words.next("an attribute's name")?.to_owned();
        let mut kind = Vec::new();
        while kind.iter().all(|&word| word == "array") {
            kind.push(words.next("a type")?);
        }
        if matches!(kind.last(), Some(&("instance" | "pointer"))) {
            kind.push(words.next("a class")?);
        }
        shape.push((name, kind.join(" ")));
    }
    Ok(shape)
}

/// Refuses another shape of `class` than the one known.
fn expect(shapes: &HashMap<String, Shape>, class: &str, known: &[(&str, &str)]) -> Result<()> {
    let found = shapes.get(class).map_or(&[][..], Vec::as_slice);
    let same = found.len() == known.len()
        && found.iter().zip(known).all(|((name, kind), (wanted_name, wanted))| name == wanted_name && kind == wanted);
    if same {
        return Ok(());
    }
    let list = known.iter().map(|(name, kind)| format!("{name} {kind}")).collect::<Vec<_>>().join(", ");
    Err(Error::new(format!("{class} is not declared as {list}: files of this version of Jolt are not read")))
}

/// Refuses a `class` whose first attribute is another; those that follow are never come to.
fn expect_first(shapes: &HashMap<String, Shape>, class: &str, name: &str, kind: &str) -> Result<()> {
    match shapes.get(class).and_then(|shape| shape.first()) {
        Some((found_name, found)) if found_name == name && found == kind => Ok(()),
        _ => Err(Error::new(format!("{class} does not begin with {name} {kind}: such files are not read"))),
    }
}

/// What the words of an object stream stand for.
impl Words<'_> {
    fn text(&mut self, wanted: &str) -> Result<String> {
        let word = self.next(wanted)?;
        let inner = word.strip_prefix('"').and_then(|word| word.strip_suffix('"'));
        let inner = inner.ok_or_else(|| self.refusal(word, &format!("{wanted} in quotes expected here")))?;
        let mut escaped = false;
        let kept = inner.chars().filter(|&c| {
            escaped = c == '\\' && !escaped;
            !escaped
        });
        Ok(kept.collect())
    }

    fn count(&mut self, what: &str) -> Result<u32> {
        let word = self.next("a count")?;
        word.parse().map_err(|_| self.refusal(word, &format!("the number of {what} expected here")))
    }

    fn key(&mut self) -> Result<Key> {
        let mut v = [0.0; 8];
        for v in &mut v {
            *v = self.number("a key")?;
        }
        let [x, y, z, w, px, py, pz, time] = v;
        let rotation = DQuat::from_xyzw(x, y, z, w);
        // Files are rounded to some digits; a length further off than that is another mistake.
        if (rotation.length() - 1.0).abs() > 1e-2 {
            let length = rotation.length();
            let what = format!("time {time} s: quaternion of length {length}, but only 1 is a rotation");
            return Err(Error::new(what).at_line(Some(self.line())));
        }
        Ok(Key { time, position: DVec3::new(px, py, pz), rotation: rotation.normalize() })
    }
}

#[cfg(test)]
#[path = "tof_tests.rs"]
pub(super) mod tests;
