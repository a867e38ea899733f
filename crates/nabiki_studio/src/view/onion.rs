//! Onion skins: the paths of tips through the frames before and after, fading away from now.

use glam::Vec3;

use nabiki_view::Line;

use crate::take::Take;

/// Frames before and after.
pub const REACH: u32 = 12;
/// Strands whose tips leave a path: the first of the farthest-first order, so spread over the scalp.
const TIPS: usize = 140;
/// Thickness (px).
const WIDTH: f32 = 1.3;
/// Linear colours of what was and of what comes.
const BEFORE: [f32; 3] = [0.95, 0.42, 0.18];
const AFTER: [f32; 3] = [0.16, 0.62, 0.85];

/// How much of a path shows at a frame: all of it now, nothing beyond the reach.
pub fn fade(frame: u32, now: u32) -> f32 {
    let part = 1.0 - frame.abs_diff(now) as f32 / (REACH + 1) as f32;
    part.max(0.0).powi(2)
}

/// The paths about a frame, in head space as the head is in that frame.
pub fn paths(take: &Take, now: u32) -> Vec<Line> {
    let strands = take.strands();
    let (first, last) = (now.saturating_sub(REACH), (now + REACH).min(take.frames()));
    let head_now = take.pose(now).world_from_head().inverse();
    let ways: Vec<_> = (first..=last).map(|frame| head_now * take.pose(frame).world_from_head()).collect();
    let mut lines = Vec::with_capacity(TIPS * 2 * REACH as usize);
    for strand in 0..strands.len().min(TIPS) {
        let Some(tip) = strands.range(strand).last() else { continue };
        let place = |frame: u32| ways[(frame - first) as usize].transform_point3(take.points(frame)[tip]);
        for frame in first..last {
            let colour = if frame < now { BEFORE } else { AFTER };
            let at = |frame| [colour[0], colour[1], colour[2], 0.8 * fade(frame, now)];
            lines.push(Line {
                a: place(frame).to_array(),
                width: WIDTH,
                b: place(frame + 1).to_array(),
                pad: 0.0,
                a_colour: at(frame),
                b_colour: at(frame + 1),
            });
        }
    }
    lines.retain(|line| Vec3::from(line.a) != Vec3::from(line.b));
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_fade_away_from_now_on_both_sides() {
        let now = 40;
        assert_eq!(fade(now, now), 1.0);
        assert_eq!(fade(now - REACH - 1, now), 0.0);
        assert_eq!(fade(now + REACH + 5, now), 0.0);
        for n in 0..REACH {
            assert!(fade(now + n, now) > fade(now + n + 1, now));
            assert_eq!(fade(now + n, now), fade(now - n, now));
        }
    }
}
