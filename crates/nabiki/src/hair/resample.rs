//! Resamples strands to another number of evenly spaced points.

use glam::Vec3;

use super::{Attributes, Hair};
use crate::Strands;

/// A place along a strand: between the points `from` and `from + 1` of the whole array, at `t` of the way.
#[derive(Clone, Copy)]
struct Place {
    from: usize,
    t: f32,
}

impl Hair {
    /// Resamples each strand to `points` points (at least 2), equally spaced along its polyline. Root and tip do not
    /// move. Values by point are interpolated, too. A strand with a single point repeats it.
    pub fn resampled(&self, points: usize) -> Self {
        let points = points.max(2);
        let mut places = Vec::with_capacity(self.strands.len() * points);
        for s in 0..self.strands.len() {
            place_evenly(&self.strands, s, points, &mut places);
        }
        let old = self.strands.points();
        let last = old.len().saturating_sub(1);
        let mut strands = Strands::with_capacity(self.strands.len(), places.len());
        for strand in places.chunks(points) {
            strands.push(strand.iter().map(|p| mix(p, old[p.from], old[(p.from + 1).min(last)], Vec3::lerp)));
        }
        let a = &self.attributes;
        let attributes = Attributes {
            width: scalars(&a.width, &places),
            colour: arrays(&a.colour, &places),
            transparency: scalars(&a.transparency, &places),
            point_uv: arrays(&a.point_uv, &places),
            inverse_mass: scalars(&a.inverse_mass, &places),
            other: a.other.iter().map(|other| other.resampled(blends(&places, last))).collect(),
            ..a.clone()
        };
        Self { strands, attributes }
    }
}

/// The two points that each place lies between, with their weights.
fn blends(places: &[Place], last: usize) -> impl Iterator<Item = [(usize, f64); 2]> {
    places.iter().map(move |p| [(p.from, 1.0 - f64::from(p.t)), ((p.from + 1).min(last), f64::from(p.t))])
}

/// The ends are given as they are, without arithmetic.
fn mix<T>(place: &Place, a: T, b: T, between: impl Fn(T, T, f32) -> T) -> T {
    match place.t {
        0.0 => a,
        1.0 => b,
        t => between(a, b, t),
    }
}

fn scalars(values: &Option<Vec<f32>>, places: &[Place]) -> Option<Vec<f32>> {
    let values = values.as_ref()?;
    let at = |i: usize| values[i.min(values.len() - 1)];
    Some(places.iter().map(|p| mix(p, at(p.from), at(p.from + 1), |a, b, t| a + (b - a) * t)).collect())
}

fn arrays<const N: usize>(values: &Option<Vec<[f32; N]>>, places: &[Place]) -> Option<Vec<[f32; N]>> {
    let values = values.as_ref()?;
    let at = |i: usize| values[i.min(values.len() - 1)];
    let between = |a: [f32; N], b: [f32; N], t: f32| std::array::from_fn(|i| a[i] + (b[i] - a[i]) * t);
    Some(places.iter().map(|p| mix(p, at(p.from), at(p.from + 1), between)).collect())
}

fn place_evenly(strands: &Strands, s: usize, points: usize, places: &mut Vec<Place>) {
    let range = strands.range(s);
    if range.len() < 2 {
        places.extend((0..points).map(|_| Place { from: range.start, t: 0.0 }));
        return;
    }
    let strand = strands.strand(s);
    // In f64, so that a long strand of short segments keeps its even spacing.
    let lengths = strand.windows(2).map(|w| w[0].as_dvec3().distance(w[1].as_dvec3()));
    let mut ends = Vec::with_capacity(strand.len() - 1);
    let mut total = 0.0;
    for length in lengths {
        total += length;
        ends.push(total);
    }
    let mut segment = 0;
    for i in 0..points {
        let at = total * i as f64 / (points - 1) as f64;
        while segment + 1 < ends.len() && ends[segment] < at {
            segment += 1;
        }
        let start = if segment == 0 { 0.0 } else { ends[segment - 1] };
        let t = match i {
            0 => 0.0,
            i if i + 1 == points => 1.0,
            _ if ends[segment] > start => ((at - start) / (ends[segment] - start)) as f32,
            _ => 0.0,
        };
        let segment = if i + 1 == points { ends.len() - 1 } else { segment };
        places.push(Place { from: range.start + segment, t });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hair(strands: &[&[Vec3]]) -> Hair {
        let mut set = Strands::default();
        for strand in strands {
            set.push(strand.iter().copied());
        }
        set.into()
    }

    #[test]
    fn root_and_tip_stay_and_the_points_between_are_evenly_spaced_along_the_strand() {
        let bent = [Vec3::ZERO, 3.0 * Vec3::X, Vec3::new(3.0, 1.0, 0.0)];
        let straight = [Vec3::ZERO, 0.1 * Vec3::Z, 0.3 * Vec3::Z, Vec3::Z];
        let resampled = hair(&[&bent, &straight]).resampled(9);
        assert_eq!(resampled.strands.starts(), [0, 9, 18]);
        let strand = resampled.strands.strand(0);
        assert_eq!((strand[0], strand[8]), (bent[0], bent[2]));
        // The corner lies at 3/4 of the length: the points before it 0.5 apart, and so those behind it.
        for (i, p) in strand.iter().enumerate() {
            let along = 0.5 * i as f32;
            let expected = Vec3::new(along.min(3.0), (along - 3.0).max(0.0), 0.0);
            assert!(
                p.distance(expected) <= 4.0 * f32::EPSILON * 3.0,
                "point {i}: {p}, a few roundings from {expected}"
            );
        }
        let strand = resampled.strands.strand(1);
        assert!(strand.windows(2).all(|w| (w[0].distance(w[1]) - 0.125).abs() <= 4.0 * f32::EPSILON));
    }

    #[test]
    fn values_by_point_go_along_and_values_by_strand_stay() {
        let mut original = hair(&[&[Vec3::ZERO, Vec3::X, 2.0 * Vec3::X]]);
        original.attributes.width = Some(vec![0.4, 0.2, 0.0]);
        original.attributes.colour = Some(vec![[0.0, 1.0, 0.5], [1.0, 0.0, 0.5], [1.0, 1.0, 0.5]]);
        original.attributes.id = Some(vec![7]);
        let resampled = original.resampled(5);
        assert_eq!(resampled.check_lengths(), Ok(()));
        let width = resampled.attributes.width.unwrap();
        assert!(width.iter().enumerate().all(|(i, w)| (w - (0.4 - 0.1 * i as f32)).abs() <= f32::EPSILON));
        assert_eq!(resampled.attributes.colour.unwrap()[1], [0.5, 0.5, 0.5]);
        assert_eq!(resampled.attributes.id, Some(vec![7]));
        assert_eq!(original.resampled(3).strands, original.strands, "even strands stay as they are");
    }

    #[test]
    fn strands_without_extent_are_repeated_points() {
        let resampled = hair(&[&[Vec3::Y], &[Vec3::X, Vec3::X]]).resampled(3);
        assert_eq!(resampled.strands.points(), [Vec3::Y, Vec3::Y, Vec3::Y, Vec3::X, Vec3::X, Vec3::X]);
    }
}
