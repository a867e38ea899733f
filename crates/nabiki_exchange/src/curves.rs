//! Turns the curves of other tools into the polylines of strands.
//!
//! Cubic curves are divided by arc length into segments of equal length. Polylines stay unchanged unless you ask for
//! another number of segments. Values at control points are blended with the weights of the curve's basis.

use glam::Vec3;
use nabiki::Strands;
use nabiki::strands::{check_points, not_finite};

use crate::Problem;
use crate::knots::Knots;

/// The basis of a curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Basis {
    /// Straight from point to point.
    Linear,
    /// Passes through every third point; the others attract it.
    Bezier,
    /// Approximates its points.
    Bspline,
    /// Passes through its points.
    CatmullRom,
}

/// Everything about curves except their points.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    /// Control points of each curve.
    pub counts: Vec<usize>,
    /// How they run.
    pub basis: Basis,
    /// Whether B-splines and Catmull-Rom curves start and end at their first and last points ("pinned"), as if there
    /// were one more point beyond each end. Otherwise they end one segment short of them.
    pub pinned: bool,
}

/// One point of a strand as a blend of its curve's control points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blend {
    /// Index of the first control point (of all curves).
    pub first: usize,
    /// Its weight and those of the three following points; 0 if there is none.
    pub weights: [f64; 4],
    /// The segment of the curve and the position on it (0..1), for values at the ends of segments.
    pub segment: (usize, f64),
}

/// Strands made from curves.
#[derive(Clone, Debug)]
pub struct Polylines {
    /// The strands.
    pub strands: Strands,
    /// The origin of each point. Empty if the strands' points are the control points themselves.
    pub blends: Vec<Blend>,
    /// The original curves.
    pub shape: Shape,
    /// The knots of each curve; empty if only the basis determines the curves.
    pub knots: Vec<Knots>,
}

/// Checks counts from a file: none may be negative, and they must add up to `total`.
///
/// # Errors
/// A negative count, or a wrong sum.
pub fn checked_counts(counts: &[i64], total: usize) -> Result<Vec<usize>, Problem> {
    let mut sum = 0usize;
    let mut checked = Vec::with_capacity(counts.len());
    for &count in counts {
        let count = usize::try_from(count).map_err(|_| Problem(format!("has a negative count, {count}")))?;
        sum = sum.saturating_add(count);
        checked.push(count);
    }
    if sum == total { Ok(checked) } else { Err(Problem(format!("its counts add up to {sum} instead of {total}"))) }
}

/// Steps into which a cubic is cut to measure its length.
const STEPS: usize = 32;

impl Shape {
    /// Divides every curve into `segments` segments. `None` keeps polylines unchanged and gives cubic curves as many
    /// points as they have control points. `points` are the control points, curve after curve, root first.
    ///
    /// # Errors
    /// A point that is not finite; a curve with too few control points for its basis, which the text names; a number of
    /// segments that is 0 or gives more than 2^32 points in total. Curves of one point or none are allowed and become
    /// such strands.
    ///
    /// # Panics
    /// If the counts do not add up to the number of points.
    pub fn walk(self, points: Vec<Vec3>, segments: Option<usize>) -> Result<Polylines, Problem> {
        self.walk_by(Vec::new(), points, segments)
    }

    /// Like [`walk`](Self::walk), for B-splines with knots. `knots` are those of each curve and take precedence over
    /// the basis. If there are none, the basis applies.
    ///
    /// # Errors
    /// As for [`walk`](Self::walk); knots for another number of curves or control points.
    ///
    /// # Panics
    /// As for [`walk`](Self::walk).
    pub fn walk_by(self, knots: Vec<Knots>, points: Vec<Vec3>, segments: Option<usize>) -> Result<Polylines, Problem> {
        assert_eq!(self.counts.iter().sum::<usize>(), points.len(), "counts and points");
        if let Some(i) = not_finite(&points) {
            let way_out = "must be finite: correct it or remove its curve where the file was made";
            return Err(Problem(format!("point {i} is {}: {way_out}", points[i])));
        }
        if segments == Some(0) {
            return Err(Problem::new("0 segments: a strand needs at least one"));
        }
        if let Some(segments) = segments {
            check_points("segments", segments, self.counts.len()).map_err(|refused| Problem(refused.to_string()))?;
        }
        let pieces = self.counts.iter().enumerate().map(|(curve, &count)| {
            let pieces = match knots.get(curve) {
                _ if count < 2 => Ok(0),
                Some(knots) if knots.control_points() == count => Ok(knots.pieces()),
                Some(knots) => Err(format!("{count} control points, but knots for {}", knots.control_points())),
                None if knots.is_empty() => self.pieces(count),
                None => Err(format!("has no knots: its object has knots for the first {} only", knots.len())),
            };
            pieces.map_err(|e| Problem(format!("curve {curve}: {e}")))
        });
        if (self.basis, segments, knots.is_empty()) == (Basis::Linear, None, true) {
            pieces.collect::<Result<Vec<_>, _>>()?;
            let ends = self.counts.iter().scan(0, |at, &count| {
                *at += count as u32;
                Some(*at)
            });
            let starts = std::iter::once(0).chain(ends).collect();
            return Ok(Polylines {
                strands: Strands::from_parts(starts, points),
                blends: Vec::new(),
                shape: self,
                knots,
            });
        }
        let mut strands = Strands::with_capacity(self.counts.len(), 0);
        let mut blends = Vec::new();
        let mut first = 0;
        for (curve, (&count, pieces)) in self.counts.iter().zip(pieces).enumerate() {
            let points = &points[first..first + count];
            let of_curve = match pieces? {
                0 => {
                    (0..count).map(|first| Blend { first, weights: [1.0, 0.0, 0.0, 0.0], segment: (0, 0.0) }).collect()
                }
                pieces => self.blends(points, knots.get(curve), pieces, segments),
            };
            strands.push(of_curve.iter().map(|b| b.of(points).as_vec3()));
            blends.extend(of_curve.into_iter().map(|b| Blend { first: first + b.first, ..b }));
            first += count;
        }
        Ok(Polylines { strands, blends, shape: self, knots })
    }

    /// Number of segments between ends of pieces: straight lines or cubics.
    fn pieces(&self, count: usize) -> Result<usize, String> {
        let (pieces, rest) = match self.basis {
            Basis::Linear => (count.saturating_sub(1), 0),
            Basis::Bezier => (count.saturating_sub(1) / 3, count.saturating_sub(1) % 3),
            _ if self.pinned => (count.saturating_sub(1), 0),
            _ => (count.saturating_sub(3), 0),
        };
        if pieces == 0 || rest != 0 {
            let (basis, wrap) = (self.basis, if self.pinned { "pinned " } else { "" });
            return Err(format!("{count} control points do not make a {wrap}{basis:?} curve"));
        }
        Ok(pieces)
    }

    /// `segments` + 1 points equally far apart along a curve.
    fn blends(&self, points: &[Vec3], knots: Option<&Knots>, pieces: usize, segments: Option<usize>) -> Vec<Blend> {
        let is_straight = knots.map_or(self.basis == Basis::Linear, Knots::is_straight);
        let steps = if is_straight { 1 } else { STEPS };
        let at = |step: usize, part: f64| {
            let place = (step as f64 + part) / steps as f64;
            let piece = (place as usize).min(pieces - 1);
            let t = place - piece as f64;
            match knots.map(|knots| knots.weights(piece, t)) {
                Some((first, weights)) => Blend { first, weights, segment: (piece, t) },
                None => self.blend(points.len(), piece, t),
            }
        };
        // A straight curve among others that bend: polylines stay as they are.
        if is_straight && segments.is_none() {
            return (0..=pieces).map(|end| at(end, 0.0)).collect();
        }
        let segments = segments.unwrap_or(points.len() - 1);
        let mut lengths = Vec::with_capacity(pieces * steps + 1);
        let (mut length, mut last) = (0.0, at(0, 0.0).of(points));
        lengths.push(0.0);
        for step in 1..=pieces * steps {
            let next = at(step, 0.0).of(points);
            length += next.distance(last);
            last = next;
            lengths.push(length);
        }
        let mut step = 0;
        (0..=segments)
            .map(|n| {
                let wanted = length * n as f64 / segments as f64;
                while step + 2 < lengths.len() && lengths[step + 1] < wanted {
                    step += 1;
                }
                let span = lengths[step + 1] - lengths[step];
                let part = if span > 0.0 { ((wanted - lengths[step]) / span).clamp(0.0, 1.0) } else { 0.0 };
                if n == segments { at(pieces * steps, 0.0) } else { at(step, part) }
            })
            .collect()
    }

    /// The blend at `t` (0..1) of a piece of a curve of `count` points.
    pub(crate) fn blend(&self, count: usize, piece: usize, t: f64) -> Blend {
        let (t2, t3, u) = (t * t, t * t * t, 1.0 - t);
        let segment = (piece, t);
        match self.basis {
            Basis::Linear => Blend { first: piece, weights: [u, t, 0.0, 0.0], segment },
            Basis::Bezier => {
                Blend { first: 3 * piece, weights: [u * u * u, 3.0 * u * u * t, 3.0 * u * t2, t3], segment }
            }
            Basis::Bspline | Basis::CatmullRom => {
                let weights = if self.basis == Basis::Bspline {
                    [u * u * u, 4.0 - 6.0 * t2 + 3.0 * t3, 1.0 + 3.0 * t + 3.0 * t2 - 3.0 * t3, t3].map(|w| w / 6.0)
                } else {
                    [-t + 2.0 * t2 - t3, 2.0 - 5.0 * t2 + 3.0 * t3, t + 4.0 * t2 - 3.0 * t3, t3 - t2].map(|w| w / 2.0)
                };
                if !self.pinned {
                    return Blend { first: piece, weights, segment };
                }
                // The points beyond the ends, 2 p_0 - p_1 and its like, are put in terms of those there are.
                let first = piece.saturating_sub(1).min(count.saturating_sub(4));
                let mut folded = [0.0; 4];
                for (k, w) in weights.into_iter().enumerate() {
                    match (piece + k).checked_sub(1) {
                        None => {
                            folded[0] += 2.0 * w;
                            folded[1] -= w;
                        }
                        Some(i) if i >= count => {
                            folded[count - 1 - first] += 2.0 * w;
                            folded[count - 2 - first] -= w;
                        }
                        Some(i) => folded[i - first] += w,
                    }
                }
                Blend { first, weights: folded, segment }
            }
        }
    }
}

impl Polylines {
    /// Number of control points of the curves.
    pub fn control_points(&self) -> usize {
        self.shape.counts.iter().sum()
    }

    /// The `values` at each point of the strands. Their number decides whether they are constant, per curve, per
    /// control point, or per end of the curves' segments. `None` for any other number.
    pub fn at_points<const N: usize>(&self, values: &[[f32; N]]) -> Option<Vec<[f32; N]>> {
        let (shape, all, n) = (&self.shape, self.strands.points().len(), values.len());
        let pieces = |(curve, &count): (usize, &usize)| {
            self.knots.get(curve).map_or_else(|| shape.pieces(count).unwrap_or(0), Knots::pieces)
        };
        let ends = || shape.counts.iter().enumerate().map(|curve| pieces(curve) + 1);
        if n == self.control_points() {
            return Some(if self.blends.is_empty() {
                values.to_vec()
            } else {
                self.blends.iter().map(|b| b.values(values)).collect()
            });
        }
        if n == shape.counts.len() {
            let each = self.strands.iter().zip(values);
            return Some(each.flat_map(|(strand, &v)| std::iter::repeat_n(v, strand.len())).collect());
        }
        if n == ends().sum::<usize>() && !self.blends.is_empty() {
            let mut first = 0;
            let mut found = Vec::with_capacity(all);
            for (s, ends) in ends().enumerate() {
                for blend in &self.blends[self.strands.range(s)] {
                    let (piece, t) = blend.segment;
                    // A curve of one point ends where it begins.
                    let [a, b] = [first + piece, (first + piece + 1).min(n - 1)].map(|i| values[i]);
                    found.push(std::array::from_fn(|i| a[i] + (b[i] - a[i]) * t as f32));
                }
                first += ends;
            }
            return Some(found);
        }
        (n == 1).then(|| vec![values[0]; all])
    }

    /// The `values` of each curve: one per curve, one for all, or, with one per control point, that at the root.
    pub fn at_roots<T: Clone>(&self, values: &[T]) -> Option<Vec<T>> {
        let counts = &self.shape.counts;
        match values.len() {
            n if n == counts.len() => Some(values.to_vec()),
            1 => Some(vec![values[0].clone(); counts.len()]),
            n if n == self.control_points() => {
                let roots = counts.iter().scan(0, |at, &count| {
                    *at += count;
                    Some(*at - count)
                });
                // A curve without points, which may be the last, has no root.
                roots.map(|root| values.get(root).or(values.last()).cloned()).collect()
            }
            _ => None,
        }
    }

    /// Number of curves along which `values` vary. 0 unless there is one value per control point.
    pub fn changing<T: PartialEq>(&self, values: &[T]) -> usize {
        let counts = &self.shape.counts;
        if values.len() != self.control_points() || values.len() == counts.len() {
            return 0;
        }
        let of_curves = counts.iter().scan(values, |rest, &count| {
            let (curve, after) = rest.split_at(count);
            *rest = after;
            Some(curve)
        });
        of_curves.filter(|curve| curve.iter().any(|value| *value != curve[0])).count()
    }
}

impl Blend {
    pub(crate) fn of(&self, points: &[Vec3]) -> glam::DVec3 {
        let near = points[self.first..].iter().zip(self.weights);
        near.map(|(p, w)| p.as_dvec3() * w).sum()
    }

    /// Blends values at the control points (of all curves), `N` numbers each.
    pub fn values<const N: usize>(&self, values: &[[f32; N]]) -> [f32; N] {
        let mut sum = [0.0; N];
        for (value, w) in values[self.first..].iter().zip(self.weights) {
            for (sum, v) in sum.iter_mut().zip(value) {
                *sum += w * f64::from(*v);
            }
        }
        sum.map(|x| x as f32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BASES: [(Basis, bool); 6] = [
        (Basis::Linear, false),
        (Basis::Bezier, false),
        (Basis::Bspline, false),
        (Basis::Bspline, true),
        (Basis::CatmullRom, false),
        (Basis::CatmullRom, true),
    ];

    #[test]
    fn evenly_spaced_points_on_a_line_stay_evenly_spaced_on_it() {
        let points: Vec<Vec3> = (0..7).map(|i| Vec3::new(1.0, -2.0, 0.5) * i as f32).collect();
        for (basis, pinned) in BASES {
            let lines = Shape { counts: vec![7], basis, pinned }.walk(points.clone(), Some(9)).unwrap();
            // Unpinned splines leave one segment at each end undrawn.
            let short = f32::from(u8::from(!pinned && matches!(basis, Basis::Bspline | Basis::CatmullRom)));
            for (i, p) in lines.strands.strand(0).iter().enumerate() {
                let expected = Vec3::new(1.0, -2.0, 0.5) * (short + (6.0 - 2.0 * short) * i as f32 / 9.0);
                assert!(p.distance(expected) < 1e-5, "{basis:?} {pinned}: {p} {expected}");
            }
        }
    }

    #[test]
    fn weights_of_every_basis_add_up_to_one() {
        for (basis, pinned) in BASES {
            let curves = Shape { counts: Vec::new(), basis, pinned };
            for count in [2, 4, 7] {
                for piece in 0..curves.pieces(count).unwrap_or(0) {
                    for t in [0.0, 0.3, 1.0] {
                        let blend = curves.blend(count, piece, t);
                        assert!((blend.weights.iter().sum::<f64>() - 1.0).abs() < 1e-12, "{basis:?} {blend:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_bezier_quarter_circle_is_cut_into_equal_chords() {
        let k = 0.552_284_8;
        let points = vec![Vec3::X, Vec3::new(1.0, k, 0.0), Vec3::new(k, 1.0, 0.0), Vec3::Y];
        let lines = Shape { counts: vec![4], basis: Basis::Bezier, pinned: false }.walk(points, Some(12));
        let lines = lines.unwrap();
        let strand = lines.strands.strand(0);
        assert_eq!(strand[0], Vec3::X);
        assert!(strand[12].distance(Vec3::Y) < 1e-6);
        let chord = 2.0 * (std::f32::consts::FRAC_PI_2 / 24.0).sin();
        for w in strand.windows(2) {
            // This cubic is off the circle by 2.7e-4, and within one of the 32 steps its speed is taken as constant.
            assert!((w[0].distance(w[1]) / chord - 1.0).abs() < 1e-3);
        }
    }

    #[test]
    fn polylines_are_left_alone_and_cubics_keep_their_number_of_points() {
        let points: Vec<Vec3> = (0..9).map(|i| Vec3::new(0.1, 0.7, 0.3) * (i * i) as f32).collect();
        let linear = Shape { counts: vec![4, 5], basis: Basis::Linear, pinned: false };
        let lines = linear.clone().walk(points.clone(), None).unwrap();
        assert_eq!(lines.strands.points(), points);
        assert!(lines.blends.is_empty());
        let spline = Shape { basis: Basis::Bspline, ..linear.clone() }.walk(points.clone(), None).unwrap();
        assert_eq!(spline.strands.starts(), [0, 4, 9]);
        let refused = Shape { basis: Basis::Bezier, ..linear }.walk(points, None).unwrap_err();
        assert!(refused.0.starts_with("curve 1: 5 control"), "{refused}");
    }

    #[test]
    fn splines_begin_and_end_where_their_basis_has_it() {
        let p = [Vec3::ZERO, Vec3::new(1.0, 2.0, 0.0), Vec3::new(3.0, 1.0, -1.0), Vec3::new(4.0, 4.0, 2.0)];
        let ends = |basis, pinned| {
            let lines = Shape { counts: vec![4], basis, pinned }.walk(p.to_vec(), Some(1)).unwrap();
            lines.strands.points().to_vec()
        };
        for basis in [Basis::Bspline, Basis::CatmullRom] {
            assert_eq!(ends(basis, true), [p[0], p[3]], "{basis:?}");
        }
        assert_eq!(ends(Basis::Bezier, false), [p[0], p[3]]);
        assert_eq!(ends(Basis::CatmullRom, false), [p[1], p[2]]);
        let near = ends(Basis::Bspline, false);
        for (found, expected) in near.iter().zip([(p[0] + 4.0 * p[1] + p[2]) / 6.0, (p[1] + 4.0 * p[2] + p[3]) / 6.0]) {
            assert!(found.distance(expected) < 1e-6, "{found} {expected}");
        }
        // Between two points a Catmull-Rom curve goes through the middle of both, less an eighth of how much their neighbours'
        // middle lies off.
        let spline = Shape { counts: vec![4], basis: Basis::CatmullRom, pinned: false };
        let half = spline.blend(4, 0, 0.5).of(&p).as_vec3();
        assert!(half.distance((9.0 * (p[1] + p[2]) - p[0] - p[3]) / 16.0) < 1e-6, "{half}");
    }

    #[test]
    fn values_at_the_ends_of_segments_are_blended_between_these_curve_by_curve() {
        // Evenly spaced along lines, so that as far along the curve is as far along its segments: two, and one.
        let along = |y: f32, count: usize| (0..count).map(move |i| Vec3::new(i as f32, y, 0.0));
        let points: Vec<Vec3> = along(0.0, 7).chain(along(1.0, 4)).collect();
        let curves = Shape { counts: vec![7, 4], basis: Basis::Bezier, pinned: false };
        let lines = curves.walk(points, Some(4)).unwrap();
        let found = lines.at_points(&[[0.0], [1.0], [3.0], [10.0], [20.0]]).unwrap();
        let expected = [0.0, 0.5, 1.0, 2.0, 3.0, 10.0, 12.5, 15.0, 17.5, 20.0];
        assert_eq!(found.len(), expected.len());
        for ([found], expected) in found.into_iter().zip(expected) {
            assert!((found - expected).abs() < 1e-5, "{found} {expected}");
        }
    }

    #[test]
    fn more_points_than_strands_can_count_are_refused_before_any_is_made() {
        let lines = Shape { counts: vec![2; 3], basis: Basis::Linear, pinned: false };
        // 2^32 - 1 points are three times a third; each strand has a point more than segments.
        let refused = lines.walk(vec![Vec3::X; 6], Some(u32::MAX as usize / 3)).unwrap_err();
        assert_eq!(refused.0, "segments = 1431655765: gives more than 2^32 points in all: ask for fewer");
    }

    #[test]
    fn values_at_the_control_points_follow_the_points() {
        let points: Vec<Vec3> = (0..8).map(|i| Vec3::new(i as f32, (i % 3) as f32, 0.5)).collect();
        for (basis, pinned) in [(Basis::Bspline, true), (Basis::CatmullRom, false), (Basis::Linear, false)] {
            let lines = Shape { counts: vec![8], basis, pinned }.walk(points.clone(), Some(20)).unwrap();
            let values: Vec<[f32; 3]> = points.iter().map(|p| p.to_array()).collect();
            for (blend, p) in lines.blends.iter().zip(lines.strands.points()) {
                assert_eq!(blend.values(&values), p.to_array());
            }
        }
    }
}
