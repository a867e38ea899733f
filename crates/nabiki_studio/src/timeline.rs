//! The intervals of the wind: what may be done to the list `[[force]]`. Each function takes the list and
//! returns another, whose last frames ascend as the method wants them.

use std::ops::RangeInclusive;

use glam::Vec3;
use nabiki_scene::scene::ForceSettings;

/// A stretch of wind, cut out: how many frames of which interval's force, one after another; each goes through as many frames.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Clip(pub Vec<(u32, ForceSettings)>);

/// First and last frame of interval `j`.
pub fn frames(keys: &[ForceSettings], j: usize) -> RangeInclusive<u32> {
    first(keys, j)..=keys[j].through
}

/// First frame of interval `j`.
fn first(keys: &[ForceSettings], j: usize) -> u32 {
    1 + j.checked_sub(1).map_or(0, |before| keys[before].through)
}

/// How many frames the last interval can still end later: who means for good may have written the last frame that there is.
fn room_after(keys: &[ForceSettings]) -> i64 {
    keys.last().map_or(0, |last| i64::from(u32::MAX - last.through))
}

/// The interval whose force is felt in a frame; the last one holds for good.
pub fn at(keys: &[ForceSettings], frame: u32) -> Option<usize> {
    let j = keys.partition_point(|key| key.through < frame);
    (!keys.is_empty()).then(|| j.min(keys.len() - 1))
}

/// Moves the end of interval `j` to a frame, as far as its neighbours let it: every interval keeps a frame. With `ripple`
/// what comes after moves along and keeps its lengths.
pub fn move_border(keys: &[ForceSettings], j: usize, frame: u32, ripple: bool) -> Vec<ForceSettings> {
    let mut keys = keys.to_vec();
    let low = first(&keys, j);
    if ripple {
        let by = i64::from(frame.max(low)) - i64::from(keys[j].through);
        let by = by.min(room_after(&keys));
        keys[j..].iter_mut().for_each(|key| key.through = (i64::from(key.through) + by) as u32);
    } else {
        let high = keys.get(j + 1).map_or(u32::MAX, |next| next.through - 1);
        keys[j].through = frame.clamp(low, high);
    }
    keys
}

/// Gives each chosen interval as many frames as `length` says for it, one at least; what comes after moves along, as far as there
/// are frames.
pub fn with_lengths(keys: &[ForceSettings], chosen: &[usize], length: impl Fn(usize) -> u32) -> Vec<ForceSettings> {
    let mut end = 0_u32;
    let with = |(j, key): (usize, &ForceSettings)| {
        let frames = if chosen.contains(&j) { length(j).max(1) } else { key.through - first(keys, j) + 1 };
        // Each interval that is still to come keeps a frame.
        let room = u32::MAX - (keys.len() - 1 - j) as u32;
        end = end.saturating_add(frames).min(room);
        ForceSettings { through: end, ..*key }
    };
    keys.iter().enumerate().map(with).collect()
}

/// Moves the intervals of `chosen` (neighbours or not; those that are there) by so many frames, each as far as the intervals beside it
/// let it.
pub fn slide(keys: &[ForceSettings], chosen: &[usize], by: i64) -> Vec<ForceSettings> {
    let mut moved = keys.to_vec();
    let mut runs: Vec<RangeInclusive<usize>> = Vec::new();
    for &j in chosen.iter().filter(|&&j| j < keys.len()) {
        match runs.last_mut() {
            Some(run) if *run.end() + 1 == j => *run = *run.start()..=j,
            _ => runs.push(j..=j),
        }
    }
    for run in runs {
        let (a, b) = (*run.start(), *run.end());
        // The first interval begins at frame 1 whatever comes, and the one after the last keeps a frame.
        let Some(before) = a.checked_sub(1) else { continue };
        let low = i64::from(first(&moved, before)) - i64::from(moved[before].through);
        let high = match keys.get(b + 1) {
            Some(next) => i64::from(next.through) - i64::from(moved[b].through) - 1,
            None => room_after(keys),
        };
        let by = by.clamp(low, high.max(0));
        moved[before..=b].iter_mut().for_each(|key| key.through = (i64::from(key.through) + by) as u32);
    }
    moved
}

/// Cuts the interval that holds a frame in two, of which the first ends there. None where it ends there already.
pub fn split(keys: &[ForceSettings], frame: u32) -> Option<Vec<ForceSettings>> {
    let j = at(keys, frame)?;
    (frame >= first(keys, j) && frame != keys[j].through).then(|| {
        let mut keys = keys.to_vec();
        // After the last interval its force goes on: the cut then ends it there.
        let (through, at) = if frame < keys[j].through { (frame, j) } else { (frame, j + 1) };
        keys.insert(at, ForceSettings { through, ..keys[j] });
        keys
    })
}

/// Makes one interval of each run of neighbours among `chosen`; its force is that of the longest of them. None where no two
/// are neighbours.
pub fn join(keys: &[ForceSettings], chosen: &[usize]) -> Option<Vec<ForceSettings>> {
    let mut joined: Vec<ForceSettings> = Vec::new();
    let mut longest = 0;
    for (j, key) in keys.iter().enumerate() {
        let length = key.through - first(keys, j) + 1;
        let goes_on = j > 0 && chosen.contains(&j) && chosen.contains(&(j - 1));
        match joined.last_mut() {
            Some(last) if goes_on => {
                last.through = key.through;
                if length > longest {
                    (*last, longest) = (*key, length);
                }
            }
            _ => {
                joined.push(*key);
                longest = length;
            }
        }
    }
    (joined.len() < keys.len()).then_some(joined)
}

/// Takes intervals out; the one before each goes on in its place, or the one after where there is none before.
pub fn remove(keys: &[ForceSettings], chosen: &[usize]) -> Vec<ForceSettings> {
    let mut left: Vec<ForceSettings> = Vec::new();
    for (j, key) in keys.iter().enumerate() {
        match left.last_mut() {
            _ if !chosen.contains(&j) => left.push(*key),
            Some(last) => last.through = key.through,
            None => {}
        }
    }
    left
}

/// The chosen intervals, in their order.
pub fn copy(keys: &[ForceSettings], chosen: &[usize]) -> Clip {
    let chosen = chosen.iter().filter(|&&j| j < keys.len());
    let cut = |&j: &usize| {
        let frames = keys[j].through - first(keys, j) + 1;
        (frames, ForceSettings { through: frames, ..keys[j] })
    };
    Clip(chosen.map(cut).collect())
}

/// Lays a clip over the wind from frame `from` on, and says which intervals it then is. What it covers is gone, what stands
/// before and after stays.
pub fn paste(keys: &[ForceSettings], from: u32, clip: &Clip) -> (Vec<ForceSettings>, Vec<usize>) {
    let from = from.max(1);
    let end = clip.0.iter().fold(from - 1, |end, (frames, _)| end.saturating_add(*frames));
    let mut pasted: Vec<ForceSettings> = keys.iter().copied().filter(|key| key.through < from).collect();
    let under = keys.iter().find(|key| key.through >= from).or(keys.last());
    if let Some(under) = under
        && pasted.last().map_or(0, |last| last.through) + 1 < from
    {
        pasted.push(ForceSettings { through: from - 1, ..*under });
    } else if keys.is_empty() && from > 1 {
        pasted.push(ForceSettings { through: from - 1, ..ForceSettings::default() });
    }
    let first = pasted.len();
    let mut through = from - 1;
    for &(frames, force) in &clip.0 {
        if through == u32::MAX {
            // There is no frame left for it.
            break;
        }
        through = through.saturating_add(frames);
        pasted.push(ForceSettings { through, ..force });
    }
    let chosen = (first..pasted.len()).collect();
    pasted.extend(keys.iter().copied().filter(|key| key.through > end));
    (pasted, chosen)
}

/// Adds an interval: it takes the later half of the one that holds `frame`, or all frames up to `last` where there is none.
/// Returns its number, too.
pub fn add(keys: &[ForceSettings], frame: u32, last: u32) -> (Vec<ForceSettings>, usize) {
    let Some(j) = at(keys, frame.max(1)) else {
        let vector = Vec3::new(-100.0, 0.0, 0.0);
        return (vec![ForceSettings { through: last.max(1), vector, speed: None }], 0);
    };
    if keys[j].through < last && j + 1 == keys.len() {
        let mut keys = keys.to_vec();
        keys.push(ForceSettings { through: last, ..keys[j] });
        return (keys, j + 1);
    }
    let range = frames(keys, j);
    let middle = range.start() + (range.end() - range.start()) / 2;
    match split(keys, if range.contains(&frame) && frame < *range.end() { frame.max(1) } else { middle }) {
        Some(keys) => (keys, j + 1),
        None => (keys.to_vec(), j),
    }
}

/// The intervals that share a frame with a range.
pub fn within(keys: &[ForceSettings], range: RangeInclusive<u32>) -> Vec<usize> {
    let meets = |j: &usize| {
        let frames = frames(keys, *j);
        frames.start() <= range.end() && range.start() <= frames.end()
    };
    (0..keys.len()).filter(meets).collect()
}

#[cfg(test)]
#[path = "timeline_tests.rs"]
mod tests;
