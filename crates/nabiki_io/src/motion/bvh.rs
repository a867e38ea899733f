//! Biovision hierarchies: one joint's world motion out of a .bvh file.
//!
//! A joint's rotation is the product of its rotation channels in the order they are listed. Its translation is its
//! OFFSET, of which each position channel replaces its own coordinate, at the root and at any other joint: OFFSET is
//! what the translation is at rest, the channel what it is in a frame. So Blender reads and writes them. (Files whose
//! root moves relative to its OFFSET are so read with the root at the file's origin, in Blender, too.)

use glam::{DQuat, DVec3};

use super::joints::{Tree, check_poses};
use super::track::{Sample, Track};
use super::words::Words;
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

/// Names of all joints, parents before their children, and the world poses of the first, the root.
pub(super) fn outline(text: &str) -> Result<(Vec<String>, Track)> {
    let mut words = Words::plain(text);
    let (joints, columns) = hierarchy(&mut words)?;
    let track = motion(&mut words, &joints, columns, &[0])?;
    Ok((joints.into_iter().map(|joint| joint.name).collect(), track))
}

/// Reads the world poses of joint `name`.
pub(super) fn track(text: &str, name: &str) -> Result<Track> {
    let mut words = Words::plain(text);
    let (joints, columns) = hierarchy(&mut words)?;
    motion(&mut words, &joints, columns, &tree(&joints).chain(name)?)
}

/// Reads the rows of `columns` numbers and puts together where the last joint of `chain` is in each.
fn motion(words: &mut Words<'_>, joints: &[Joint], columns: usize, chain: &[usize]) -> Result<Track> {
    words.expect("Frames:")?;
    let frames = words.number("the number of frames")?;
    if frames < 1.0 || frames.fract() != 0.0 {
        return Err(Error::new(format!("Frames: {frames}: must be a whole number above 0")).at_line(Some(words.line())));
    }
    words.expect("Frame")?;
    words.expect("Time:")?;
    let frame_time = words.number("the time of a frame")?;
    if frame_time <= 0.0 {
        return Err(Error::new(format!("Frame Time: {frame_time}: must be above 0 (s)")).at_line(Some(words.line())));
    }
    if columns == 0 {
        return Err(Error::new("no joint has channels, so nothing moves"));
    }
    let mut track = Track { what: format!("joint {}", joints[chain[chain.len() - 1]].name), ..Track::default() };
    let rate = rate(frame_time);
    let mut row = vec![0.0; columns];
    let mut frame = 0;
    // As many rows as there are, whatever number of them is declared: programs that cut a motion forget to change it.
    while !words.is_at_end() {
        for (column, value) in row.iter_mut().enumerate() {
            let in_channel = |e: Error| e.under(format!("frame {frame} of {frames}, {}", channel_of(joints, column)));
            *value = words.number("its value").map_err(in_channel)?;
        }
        check_poses(chain.len(), frame)?;
        track.times.push(frame as f64 / rate);
        track.samples.push(pose(joints, chain, &row));
        frame += 1;
    }
    if frame == 0 {
        return Err(Error::new(format!("declares {frames} frames but has none: is it complete?")));
    }
    if frame as f64 != frames {
        track.unlike = Some(format!("{frame} frames, although {frames} are declared"));
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
        let (mut translation, mut rotation) = (joint.offset, DQuat::IDENTITY);
        for (channel, &value) in joint.channels.iter().zip(&row[joint.first_column..]) {
            match *channel {
                Channel::Position(axis) => translation[axis] = value,
                Channel::Rotation(axis) => rotation *= DQuat::from_axis_angle(axis, value.to_radians()),
            }
        }
        world.position += world.rotation * translation;
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
        // Programs differ in their capitals.
        match &*word.to_ascii_uppercase() {
            kind @ ("ROOT" | "JOINT") => {
                if kind == "JOINT" && current.is_none() {
                    return Err(words.refusal(word, "a joint must be inside another; the first must be a ROOT"));
                }
                let name = words.line_before('{', "a joint's name")?.to_owned();
                words.expect("{")?;
                open.push(Some(joints.len()));
                let first_column = columns;
                let parent = current;
                joints.push(Joint { name, parent, offset: DVec3::ZERO, channels: Vec::new(), first_column });
            }
            "END" => {
                words.expect("Site")?;
                words.expect("{")?;
                open.push(None);
            }
            "}" => {
                open.pop().ok_or_else(|| words.refusal(word, "has no opening brace"))?;
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
                let j = current.ok_or_else(|| words.refusal(word, "channels must belong to a joint"))?;
                if !joints[j].channels.is_empty() {
                    return Err(words.refusal(word, &format!("joint {} already has channels", joints[j].name)));
                }
                let count = words.number("CHANNELS")?;
                joints[j].first_column = columns;
                while (joints[j].channels.len() as f64) < count {
                    let name = words.next("a channel's name")?;
                    let channel =
                        channel(name).ok_or_else(|| words.refusal(name, "a channel must be Xposition .. Zrotation"));
                    joints[j].channels.push(channel?);
                }
                columns += joints[j].channels.len();
            }
            "MOTION" if open.is_empty() => return Ok((joints, columns)),
            _ => return Err(words.refusal(word, "is not a keyword of a hierarchy")),
        }
    }
}

/// The names of all channels: three positions, then three rotations.
const CHANNELS: [&str; 6] = ["Xposition", "Yposition", "Zposition", "Xrotation", "Yrotation", "Zrotation"];

fn channel(name: &str) -> Option<Channel> {
    let found = CHANNELS.iter().position(|known| known.eq_ignore_ascii_case(name))?;
    Some(if found < 3 { Channel::Position(found) } else { Channel::Rotation(DVec3::AXES[found - 3]) })
}

/// Joint and name of the channel in a column of the motion: `Head.Xrotation`.
fn channel_of(joints: &[Joint], column: usize) -> String {
    let own = |joint: &&Joint| (joint.first_column..joint.first_column + joint.channels.len()).contains(&column);
    let Some(joint) = joints.iter().find(own) else { return format!("column {column}") };
    let name = match joint.channels[column - joint.first_column] {
        Channel::Position(axis) => CHANNELS[axis],
        Channel::Rotation(axis) => CHANNELS[3 + axis.max_position()],
    };
    format!("{}.{name}", joint.name)
}

fn tree(joints: &[Joint]) -> Tree<'_> {
    let names = joints.iter().map(|joint| Some(joint.name.as_str())).collect();
    Tree { kind: "joint", names, parents: joints.iter().map(|joint| joint.parent).collect() }
}
