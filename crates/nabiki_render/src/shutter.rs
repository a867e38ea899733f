//! Hair while the shutter is open: where it is halfway, and how far each point moves.

use glam::Vec3;
use nabiki::Strands;
use rayon::prelude::*;

use crate::RenderError;

/// Hair halfway between two moments, and each point's movement from the first to the second (cm).
///
/// Between the moments the *directions* of the segments are interpolated, not the points: a strand that swings keeps its length and
/// passes along its arc.
pub fn halfway(open: &Strands, close: &Strands) -> Result<(Strands, Vec<Vec3>), RenderError> {
    if open.starts() != close.starts() {
        let (a, b) = (open.points().len(), close.points().len());
        return Err(RenderError::Geometry(format!(
            "the hair has {} strands of {a} points when the shutter opens, {} of {b} when it closes: they must agree",
            open.len(),
            close.len()
        )));
    }
    let mut middle = open.clone();
    for s in 0..open.len() {
        let (a, b) = (open.strand(s), close.strand(s));
        let Some(root) = a.first().zip(b.first()) else { continue };
        let mut at = root.0.midpoint(*root.1);
        let points = middle.strand_mut(s);
        points[0] = at;
        for i in 1..a.len() {
            let (u, v) = (a[i] - a[i - 1], b[i] - b[i - 1]);
            let length = 0.5 * (u.length() + v.length());
            let direction = (u.normalize_or_zero() + v.normalize_or_zero()).normalize_or(u.normalize_or_zero());
            at += direction * length;
            points[i] = at;
        }
    }
    let moved = open.points().par_iter().zip(close.points()).map(|(a, b)| *b - *a).collect();
    Ok((middle, moved))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_swinging_strand_keeps_its_length_halfway() {
        let strand = |angle: f32| {
            let mut s = Strands::default();
            s.push((0..6).map(|i| Vec3::new(angle.sin(), -angle.cos(), 0.0) * i as f32));
            s
        };
        let (middle, moved) = halfway(&strand(-0.5), &strand(0.5)).unwrap();
        for (i, moved) in moved.iter().enumerate() {
            // A handful of roundings of numbers up to 5.
            assert!(middle.strand(0)[i].distance(Vec3::new(0.0, -(i as f32), 0.0)) < 3e-6);
            assert!((moved.length() - 2.0 * 0.5_f32.sin() * i as f32).abs() < 3e-6);
        }
    }

    #[test]
    fn hair_of_different_shape_is_refused() {
        let mut other = Strands::default();
        other.push([Vec3::ZERO, Vec3::X]);
        assert!(halfway(&Strands::default(), &other).is_err());
    }
}
