//! Hair while the shutter is open: where it is between two frames, and how far each point moves.

use glam::Vec3;
use nabiki::Strands;
use rayon::prelude::*;

use crate::RenderError;

/// Strands handed to one task at a time.
const CHUNK: usize = 256;

/// Hair between two frames: `part` (0..1) of the way from `a` to `b`.
///
/// The *directions* of the segments are interpolated, not the points: a strand that swings keeps its length and
/// passes along its arc.
///
/// # Errors
/// If the two have not the same strands.
pub fn between(a: &Strands, b: &Strands, part: f32) -> Result<Strands, RenderError> {
    if a.starts() != b.starts() {
        return Err(RenderError::Geometry(format!(
            "the hair has {} strands of {} points before and {} of {} after: they must agree to move",
            a.len(),
            a.points().len(),
            b.len(),
            b.points().len()
        )));
    }
    let mut mixed = a.clone();
    let starts = a.starts();
    let mut rest = mixed.points_mut();
    let mut chunks = Vec::new();
    for first in (0..a.len()).step_by(CHUNK) {
        let last = (first + CHUNK).min(a.len());
        let (chunk, after) = std::mem::take(&mut rest).split_at_mut((starts[last] - starts[first]) as usize);
        chunks.push((first..last, chunk));
        rest = after;
    }
    chunks.into_par_iter().for_each(|(strands, points)| {
        let first = a.range(strands.start).start;
        for s in strands {
            let range = a.range(s);
            swing(a.strand(s), b.strand(s), part, &mut points[range.start - first..range.end - first]);
        }
    });
    Ok(mixed)
}

fn swing(a: &[Vec3], b: &[Vec3], part: f32, mixed: &mut [Vec3]) {
    let (Some(&root_a), Some(&root_b)) = (a.first(), b.first()) else { return };
    let mut at = root_a.lerp(root_b, part);
    mixed[0] = at;
    for i in 1..a.len() {
        let (u, v) = (a[i] - a[i - 1], b[i] - b[i - 1]);
        let length = u.length() + (v.length() - u.length()) * part;
        let unit = u.normalize_or_zero();
        at += unit.lerp(v.normalize_or_zero(), part).normalize_or(unit) * length;
        mixed[i] = at;
    }
}

/// Hair halfway between two moments, and each point's movement from the first to the second (cm).
pub(crate) fn halfway(open: &Strands, close: &Strands) -> Result<(Strands, Vec<Vec3>), RenderError> {
    let middle = between(open, close, 0.5)?;
    let moved = open.points().par_iter().zip(close.points()).map(|(a, b)| *b - *a).collect();
    Ok((middle, moved))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn straight(angle: f32) -> Strands {
        let mut s = Strands::default();
        s.push((0..6).map(|i| Vec3::new(angle.sin(), -angle.cos(), 0.0) * i as f32));
        s
    }

    #[test]
    fn a_swinging_strand_keeps_its_length_halfway() {
        let (middle, moved) = halfway(&straight(-0.5), &straight(0.5)).unwrap();
        for (i, moved) in moved.iter().enumerate() {
            // A handful of roundings of numbers up to 5.
            assert!(middle.strand(0)[i].distance(Vec3::new(0.0, -(i as f32), 0.0)) < 3e-6);
            assert!((moved.length() - 2.0 * 0.5_f32.sin() * i as f32).abs() < 3e-6);
        }
    }

    #[test]
    fn the_way_begins_and_ends_at_the_frames() {
        let (a, b) = (straight(-0.5), straight(0.7));
        for (part, end) in [(0.0, &a), (1.0, &b)] {
            let mixed = between(&a, &b, part).unwrap();
            assert!(mixed.points().iter().zip(end.points()).all(|(p, q)| p.distance(*q) < 3e-6));
        }
    }

    #[test]
    fn hair_of_different_shape_is_refused() {
        let mut other = Strands::default();
        other.push([Vec3::ZERO, Vec3::X]);
        assert!(halfway(&Strands::default(), &other).is_err());
    }
}
