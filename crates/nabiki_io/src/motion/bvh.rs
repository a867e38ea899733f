//! Biovision hierarchies: one joint's world motion out of a .bvh file.
//!
//! A joint's rotation is the product of its rotation channels in the order they are listed; its translation is its
//! OFFSET, to which the root's position channels are added and which those of any other joint replace (they repeat
//! the bone there).

use glam::{DQuat, DVec3};

use super::{Sample, Track, chain_to_root, unknown_node};
use crate::error::{Error, Result};

/// What one column of the motion drives.
#[derive(Clone, Copy)]
enum Channel {
    Position(usize),
    Rotation(DVec3),
}

struct Joint {
    name: String,
    parent: Option<usize>,
    offset: DVec3,
    channels: Vec<Channel>,
    first_column: usize,
}

/// Names of all joints, parents before their children.
pub(super) fn joints(text: &str) -> Result<Vec<String>> {
    let mut words = Words { words: text.split_ascii_whitespace(), count: 0 };
    Ok(hierarchy(&mut words)?.0.into_iter().map(|joint| joint.name).collect())
}

/// Reads the world poses of joint `name`.
pub(super) fn track(text: &str, name: &str) -> Result<Track> {
    let mut words = Words { words: text.split_ascii_whitespace(), count: 0 };
    let (joints, columns) = hierarchy(&mut words)?;
    let found = joints.iter().position(|j| j.name.eq_ignore_ascii_case(name));
    let names = joints.iter().map(|j| j.name.as_str());
    let found = found.ok_or_else(|| unknown_node("joint", name, names))?;
    let chain = chain_to_root(found, |joint| joints[joint].parent, joints.len())?;

    words.expect("Frames:")?;
    let frames = words.number("Frames")?;
    words.expect("Frame")?;
    words.expect("Time:")?;
    let frame_time = words.number("Frame Time")?;
    if frames < 1.0 || frames.fract() != 0.0 {
        return Err(Error::new(format!("Frames: {frames}: must be a whole number above 0")));
    }
    if frame_time <= 0.0 {
        return Err(Error::new(format!("Frame Time: {frame_time}: must be above 0 (s)")));
    }
    if columns == 0 {
        return Err(Error::new("no joint has channels, so nothing moves"));
    }
    let mut track = Track { what: format!("joint {}", joints[chain[chain.len() - 1]].name), ..Track::default() };
    let rate = rate(frame_time);
    let mut row = vec![0.0; columns];
    let mut frame = 0;
    while (frame as f64) < frames {
        for (column, value) in row.iter_mut().enumerate() {
            *value = words
                .number("motion")
                .map_err(|e| Error::new(format!("frame {frame} of {frames}, channel {column} of {columns}: {e}")))?;
        }
        track.times.push(frame as f64 / rate);
        track.samples.push(pose(&joints, &chain, &row));
        frame += 1;
    }
    Ok(track)
}

/// Frames a second. Files round the frame time to a few digits (.0083333 for 120 Hz), which would add up to a lost
/// frame: a rate within 1e-4 of a whole number is that number.
fn rate(frame_time: f64) -> f64 {
    let rate = 1.0 / frame_time;
    let whole = rate.round();
    if (rate - whole).abs() < 1e-4 * rate { whole } else { rate }
}

/// Where the chain's last joint is, given one row of channel values.
fn pose(joints: &[Joint], chain: &[usize], row: &[f64]) -> Sample {
    let mut world = Sample { position: DVec3::ZERO, rotation: DQuat::IDENTITY };
    for &j in chain {
        let joint = &joints[j];
        let (mut offset, mut rotation) = (joint.offset, DQuat::IDENTITY);
        for (channel, &value) in joint.channels.iter().zip(&row[joint.first_column..]) {
            match *channel {
                Channel::Position(axis) if joint.parent.is_none() => offset[axis] += value,
                Channel::Position(axis) => offset[axis] = value,
                Channel::Rotation(axis) => rotation *= DQuat::from_axis_angle(axis, value.to_radians()),
            }
        }
        world.position += world.rotation * offset;
        world.rotation *= rotation;
    }
    world.rotation = world.rotation.normalize();
    world
}

/// Reads up to and with the word MOTION; the joints, and how many columns a row of motion has.
fn hierarchy(words: &mut Words<'_>) -> Result<(Vec<Joint>, usize)> {
    words.expect("HIERARCHY")?;
    let mut joints: Vec<Joint> = Vec::new();
    // Joints whose braces are open; None for an End Site.
    let mut open: Vec<Option<usize>> = Vec::new();
    let mut columns = 0;
    loop {
        let word = words.next("MOTION")?;
        let current = open.last().copied().flatten();
        match word {
            "ROOT" | "JOINT" => {
                if word == "JOINT" && current.is_none() {
                    return Err(Error::new(format!("word {}: JOINT outside a joint", words.count)));
                }
                let name = words.next("a joint's name")?.to_owned();
                words.expect("{")?;
                open.push(Some(joints.len()));
                let first_column = columns;
                let parent = current;
                joints.push(Joint { name, parent, offset: DVec3::ZERO, channels: Vec::new(), first_column });
            }
            "End" => {
                words.expect("Site")?;
                words.expect("{")?;
                open.push(None);
            }
            "}" => {
                open.pop().ok_or_else(|| Error::new(format!("word {}: a closing brace too many", words.count)))?;
            }
            "OFFSET" => {
                let x = words.number("OFFSET")?;
                let y = words.number("OFFSET")?;
                let z = words.number("OFFSET")?;
                if let Some(j) = current {
                    joints[j].offset = DVec3::new(x, y, z);
                }
            }
            "CHANNELS" => {
                let j = current.ok_or_else(|| Error::new(format!("word {}: CHANNELS outside a joint", words.count)))?;
                if !joints[j].channels.is_empty() {
                    return Err(Error::new(format!("joint {}: CHANNELS twice", joints[j].name)));
                }
                let count = words.number("CHANNELS")?;
                joints[j].first_column = columns;
                while (joints[j].channels.len() as f64) < count {
                    joints[j].channels.push(channel(words.next("a channel's name")?)?);
                }
                columns += joints[j].channels.len();
            }
            "MOTION" if open.is_empty() => return Ok((joints, columns)),
            other => {
                let at = words.count;
                return Err(Error::new(format!("word {at}, \"{other:.40}\": not a word of a hierarchy")));
            }
        }
    }
}

fn channel(name: &str) -> Result<Channel> {
    Ok(match name.to_ascii_lowercase().as_str() {
        "xposition" => Channel::Position(0),
        "yposition" => Channel::Position(1),
        "zposition" => Channel::Position(2),
        "xrotation" => Channel::Rotation(DVec3::X),
        "yrotation" => Channel::Rotation(DVec3::Y),
        "zrotation" => Channel::Rotation(DVec3::Z),
        _ => return Err(Error::new(format!("channel \"{name:.40}\": must be one of Xposition .. Zrotation"))),
    })
}

/// The file's words, counted so that an error can say where.
struct Words<'a> {
    words: std::str::SplitAsciiWhitespace<'a>,
    count: usize,
}

impl<'a> Words<'a> {
    fn next(&mut self, wanted: &str) -> Result<&'a str> {
        self.count += 1;
        self.words.next().ok_or_else(|| Error::new(format!("ends where {wanted} should follow: is it whole?")))
    }

    fn expect(&mut self, wanted: &str) -> Result<()> {
        match self.next(wanted)? {
            found if found.eq_ignore_ascii_case(wanted) => Ok(()),
            found => Err(Error::new(format!("word {}, \"{found:.40}\": {wanted} should stand here", self.count))),
        }
    }

    fn number(&mut self, what: &str) -> Result<f64> {
        let word = self.next("a number")?;
        match word.parse::<f64>() {
            Ok(x) if x.is_finite() => Ok(x),
            _ => Err(Error::new(format!("word {}, {what} \"{word:.40}\": not a finite number", self.count))),
        }
    }
}
