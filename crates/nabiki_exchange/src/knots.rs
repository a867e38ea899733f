//! B-splines with knots: the parameters at which a curve changes from one polynomial to the next.

use crate::Problem;

/// Knots apart by no more than this share of them all are one: files keep them in singles, whose steps are larger.
const SAME: f64 = 1e-9;
/// What is done about knots that are refused.
const WAY_OUT: &str = "export them as linear curves";

/// The knots of one B-spline of order 2, 3 or 4 (straight, quadratic, cubic).
#[derive(Clone, Debug, PartialEq)]
pub struct Knots {
    degree: usize,
    /// All but the first and the last, on which no point of the curve depends: `degree` - 1 more than control points.
    inner: Vec<f64>,
    /// The first control point of each span that has a length.
    spans: Vec<usize>,
}

impl Knots {
    /// The knots of a curve with this many control points. `knots` must not decrease. Their number is that of control
    /// points plus order, or two fewer for programs that leave out the first and the last.
    ///
    /// # Errors
    /// An order other than 2 to 4, fewer control points than the order, a wrong number of knots, a knot that is not
    /// finite or less than the one before it, or knots that break the curve or leave it empty. The text does not name
    /// the curve.
    pub fn new(order: usize, control_points: usize, knots: &[f64]) -> Result<Self, Problem> {
        if !(2..=4).contains(&order) {
            return Err(Problem(format!("has order {order}, but only 2 to 4 are read")));
        }
        if control_points < order {
            return Err(Problem(format!("{control_points} control points do not make a B-spline of order {order}")));
        }
        let all = control_points.saturating_add(order);
        let inner = match knots.len() {
            n if n == all => &knots[1..n - 1],
            n if n + 2 == all => knots,
            n => {
                let line = format!(
                    "{n} knots for {control_points} control points of order {order}, which need {all} or {}",
                    all - 2
                );
                return Err(Problem(line));
            }
        };
        if let Some(i) = knots.iter().position(|knot| !knot.is_finite()) {
            return Err(Problem(format!("knot {i} is {}: must be finite", knots[i])));
        }
        if let Some(i) = knots.windows(2).position(|pair| pair[1] < pair[0]) {
            return Err(Problem(format!("knot {} is {}, less than {} before it", i + 1, knots[i + 1], knots[i])));
        }
        let (first, last) = (inner[0], inner[inner.len() - 1]);
        let same = (last - first) * SAME;
        if !(same.is_finite() && same > 0.0) {
            return Err(Problem(format!("its knots from {first} to {last} leave no curve")));
        }
        let degree = order - 1;
        if let Some(i) = inner.windows(order).position(|these| these[degree] - these[0] <= same) {
            return Err(Problem(format!("breaks at knot {}, which occurs more than {degree} times", inner[i])));
        }
        let has_length = |&i: &usize| inner[degree + i] - inner[degree + i - 1] > same;
        let spans: Vec<usize> = (0..=control_points - order).filter(has_length).collect();
        if spans.is_empty() {
            return Err(Problem(format!("its knots from {first} to {last} leave no curve")));
        }
        Ok(Self { degree, inner: inner.to_vec(), spans })
    }

    /// The knots of many curves, one after another in `knots`. Either all curves have the first and last knot, or none
    /// has. `orders` has one entry per curve, or one for all. `counts` are the control points of each.
    ///
    /// # Errors
    /// Inconsistent numbers, or as for [`new`](Self::new), naming the curve.
    pub fn of_curves(orders: &[usize], counts: &[usize], knots: &[f64]) -> Result<Vec<Self>, Problem> {
        let curves = counts.len();
        if orders.len() != curves && orders.len() != 1 {
            return Err(Problem(format!("{} orders for {curves} curves: {WAY_OUT}", orders.len())));
        }
        let order = |curve: usize| orders.get(curve).copied().unwrap_or(orders[0]);
        let all = counts.iter().enumerate().map(|(i, &count)| count.saturating_add(order(i)));
        let needed = all.clone().fold(0, usize::saturating_add);
        let short = match knots.len() {
            n if n == needed => 0,
            n if Some(n) == needed.checked_sub(2 * curves) => 2,
            n => {
                let fewer = needed.saturating_sub(2 * curves);
                return Err(Problem(format!(
                    "{n} knots for {curves} curves, which need {needed} or {fewer}: {WAY_OUT}"
                )));
            }
        };
        let mut rest = knots;
        let of_curve = |(i, all): (usize, usize)| {
            let (own, after) = rest.split_at(all.saturating_sub(short).min(rest.len()));
            rest = after;
            Self::new(order(i), counts[i], own).map_err(|e| Problem(format!("curve {i}: {e}: {WAY_OUT}")))
        };
        all.enumerate().map(of_curve).collect()
    }

    /// Number of control points.
    pub fn control_points(&self) -> usize {
        self.inner.len() + 1 - self.degree
    }

    /// Whether the curve is a polyline through its control points.
    pub fn is_straight(&self) -> bool {
        self.degree == 1
    }

    /// Number of polynomial pieces of the curve.
    pub fn pieces(&self) -> usize {
        self.spans.len()
    }

    /// The first control point that influences the curve at `t` (0..1) of a piece, and the weights of it and the next
    /// three. They add up to 1.
    ///
    /// # Panics
    /// If there is no such piece.
    pub fn weights(&self, piece: usize, t: f64) -> (usize, [f64; 4]) {
        let (first, knots) = (self.spans[piece], &self.inner);
        // The knots about the span are knots[k - 1] and knots[k].
        let k = first + self.degree;
        // Both ends are met to the bit.
        let at = (1.0 - t) * knots[k - 1] + t * knots[k];
        let mut weights = [1.0, 0.0, 0.0, 0.0];
        // Cox and de Boor: from those of each degree come those of the next.
        for degree in 1..=self.degree {
            let mut carried = 0.0;
            for (i, weight) in weights.iter_mut().enumerate().take(degree) {
                let (before, after) = (knots[k + i - degree], knots[k + i]);
                let share = (after - at) / (after - before);
                let whole = *weight;
                *weight = carried + share * whole;
                carried = (1.0 - share) * whole;
            }
            weights[degree] = carried;
        }
        (first, weights)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curves::{Basis, Shape};
    use glam::Vec3;

    /// Curves that go by knots, whatever the basis is.
    fn splines(counts: Vec<usize>) -> Shape {
        Shape { counts, basis: Basis::Linear, pinned: false }
    }

    const POINTS: [Vec3; 7] = [
        Vec3::new(0.1, 0.7, -0.3),
        Vec3::new(1.0, 2.0, 0.0),
        Vec3::new(3.0, 1.0, -1.0),
        Vec3::new(4.0, 4.0, 2.0),
        Vec3::new(4.5, 3.0, 2.0),
        Vec3::new(6.0, 2.0, 1.0),
        Vec3::new(6.3, 0.1, 0.9),
    ];

    /// The first `count` of the points as one curve, cut into `segments`.
    fn walked(count: usize, basis: Basis, segments: Option<usize>) -> Vec<Vec3> {
        let shape = Shape { counts: vec![count], basis, pinned: false };
        shape.walk(POINTS[..count].to_vec(), segments).unwrap().strands.points().to_vec()
    }

    /// The same of a B-spline with knots.
    fn by_knots(order: usize, knots: &[f64], count: usize, segments: Option<usize>) -> Vec<Vec3> {
        let knots = vec![Knots::new(order, count, knots).unwrap()];
        let lines = splines(vec![count]).walk_by(knots, POINTS[..count].to_vec(), segments).unwrap();
        lines.strands.points().to_vec()
    }

    /// Whether two walks go through the same points. Weights differ by what rounding in doubles leaves, so that singles made of
    /// them may lie to either side.
    fn assert_same(a: &[Vec3], b: &[Vec3]) {
        assert_eq!(a.len(), b.len());
        for (a, b) in a.iter().zip(b) {
            assert!(a.abs_diff_eq(*b, f32::EPSILON * 8.0), "{a} {b}");
        }
    }

    #[test]
    fn clamped_curves_begin_and_end_at_their_first_and_last_control_points() {
        let single = |knot: f32| f64::from(knot);
        for (order, inner) in [
            (2, vec![0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0]),
            (3, vec![0.3, 0.3, 1.0, 2.0, 3.0, 4.0, 5.1, 5.1].into_iter().map(single).collect()),
            (4, vec![0.1, 0.1, 0.1, 0.7, 0.7, 2.3, 9.1, 9.1, 9.1].into_iter().map(single).collect()),
        ] {
            for segments in [None, Some(1), Some(23)] {
                let strand = by_knots(order, &inner, 7, segments);
                assert_eq!([strand[0], strand[strand.len() - 1]], [POINTS[0], POINTS[6]], "{order}");
            }
        }
    }

    #[test]
    fn evenly_spaced_knots_of_either_number_are_those_of_a_curve_without() {
        for count in 4..=7 {
            // Steps and their sums are exact.
            let knots: Vec<f64> = (0..count + 4).map(|k| 0.25 * k as f64 - 0.75).collect();
            for segments in [None, Some(1), Some(23)] {
                let expected = walked(count, Basis::Bspline, segments);
                assert_same(&by_knots(4, &knots, count, segments), &expected);
                assert_same(&by_knots(4, &knots[1..count + 3], count, segments), &expected);
            }
        }
    }

    #[test]
    fn a_cubic_whose_knots_are_all_at_its_ends_is_the_bezier_curve() {
        for knots in [&[0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0][..], &[2.0, 2.0, 2.0, 10.0, 10.0, 10.0]] {
            assert_same(&by_knots(4, knots, 4, Some(23)), &walked(4, Basis::Bezier, Some(23)));
            let (first, weights) = Knots::new(4, 4, knots).unwrap().weights(0, 0.5);
            assert_eq!((first, weights), (0, [0.125, 0.375, 0.375, 0.125]));
        }
        // And where they are three at a time, a chain of them.
        let chain = [0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 2.0, 2.0, 2.0];
        assert_same(&by_knots(4, &chain, 7, Some(23)), &walked(7, Basis::Bezier, Some(23)));
    }

    #[test]
    fn straight_curves_keep_their_points_and_are_cut_as_polylines_are() {
        let straight = |segments| by_knots(2, &[0.0, 1.0, 1.5, 2.0, 3.0, 5.0, 8.0], 7, segments);
        assert_eq!(straight(None), POINTS);
        assert_same(&straight(Some(23)), &walked(7, Basis::Linear, Some(23)));
    }

    #[test]
    fn knots_of_other_curves_than_there_are_are_refused() {
        let refused = |counts: Vec<usize>| {
            let points = POINTS[..counts.iter().sum()].to_vec();
            let clamped = Knots::new(4, 4, &[0.0, 0.0, 0.0, 1.0, 1.0, 1.0]).unwrap();
            splines(counts).walk_by(vec![clamped], points, None).unwrap_err().0
        };
        assert_eq!(refused(vec![5]), "curve 0: 5 control points, but knots for 4");
        assert_eq!(refused(vec![4, 3]), "curve 1: has no knots: its object has knots for the first 1 only");
    }

    #[test]
    fn weights_are_none_below_nought_and_add_up_to_one() {
        for (order, knots) in [
            (2, vec![0.0, 1.0, 3.0, 3.5, 8.0]),
            (3, vec![0.0, 0.0, 1.0, 1.0, 2.5, 4.0]),
            (4, vec![-1.0, -1.0, -1.0, 0.25, 0.25, 2.0, 7.0]),
        ] {
            let knots = Knots::new(order, 5, &knots).unwrap();
            assert_eq!(knots.control_points(), 5);
            for piece in 0..knots.pieces() {
                for t in [0.0, 0.3, 1.0] {
                    let (first, weights) = knots.weights(piece, t);
                    // At most six products and as many sums, each of numbers of at most 1.
                    assert!((weights.iter().sum::<f64>() - 1.0).abs() <= 12.0 * f64::EPSILON, "{weights:?}");
                    assert!(weights.iter().all(|&w| w >= 0.0) && first + order <= 5, "{first} {weights:?}");
                }
            }
        }
    }

    #[test]
    fn pieces_meet_where_one_goes_over_into_the_next() {
        let knots = Knots::new(4, 7, &[0.0, 0.0, 0.0, 1.0, 1.5, 1.5, 4.0, 4.0, 4.0]).unwrap();
        assert_eq!(knots.pieces(), 3, "the double knot has no length");
        let of_points = |(first, weights): (usize, [f64; 4])| {
            let mut all = [0.0; 7];
            weights.into_iter().enumerate().for_each(|(k, w)| all[first + k] += w);
            all
        };
        for piece in 1..3 {
            let (before, after) = (of_points(knots.weights(piece - 1, 1.0)), of_points(knots.weights(piece, 0.0)));
            for (a, b) in before.into_iter().zip(after) {
                assert!((a - b).abs() <= 12.0 * f64::EPSILON, "{before:?} {after:?}");
            }
        }
    }

    #[test]
    fn knots_that_make_no_curve_are_refused_by_what_is_wrong() {
        let clamped = [0.0, 0.0, 0.0, 1.0, 1.0, 1.0];
        let with = |i: usize, knot: f64| {
            let mut knots = clamped;
            knots[i] = knot;
            knots.to_vec()
        };
        for (order, points, knots, why) in [
            (4, 4, with(2, f64::NAN), "knot 2 is NaN: must be finite"),
            (4, 4, with(5, f64::INFINITY), "knot 5 is inf: must be finite"),
            (4, 4, with(3, -1.0), "knot 3 is -1, less than 0 before it"),
            (4, 4, clamped[1..].to_vec(), "5 knots for 4 control points of order 4, which need 8 or 6"),
            (4, 4, vec![2.0; 8], "its knots from 2 to 2 leave no curve"),
            (4, 4, vec![-f64::MAX, -1.0, 0.0, 1.0, 2.0, f64::MAX], "leave no curve"),
            (4, 4, vec![0.0, 0.0, 0.0, 0.0, 1.0, 1.0], "breaks at knot 0, which occurs more than 3 times"),
            (4, 3, clamped.to_vec(), "3 control points do not make a B-spline of order 4"),
            (5, 4, clamped.to_vec(), "has order 5, but only 2 to 4 are read"),
            (0, 4, Vec::new(), "has order 0, but only 2 to 4 are read"),
            (1, 4, Vec::new(), "has order 1, but only 2 to 4 are read"),
        ] {
            let refused = Knots::new(order, points, &knots).unwrap_err().0;
            assert!(refused.contains(why), "{refused}");
        }
        // Knots as close as singles can be are no break.
        assert!(Knots::new(4, 4, &with(3, f64::from(f32::EPSILON))).is_ok());
    }

    #[test]
    fn knots_of_many_curves_are_those_of_each() {
        let all = [0.0, 0.0, 1.0, 2.0, 2.0, 0.0, 0.0, 0.0, 0.0, 3.0, 3.0, 3.0, 3.0];
        let textbook = Knots::of_curves(&[2, 4], &[3, 4], &all).unwrap();
        let short: Vec<f64> = [&all[1..4], &all[6..12]].concat();
        assert_eq!(textbook, Knots::of_curves(&[2, 4], &[3, 4], &short).unwrap());
        assert_eq!(textbook[1], Knots::new(4, 4, &all[5..]).unwrap());
        for (orders, counts, knots, why) in [
            (
                &[2, 4][..],
                &[3, 4][..],
                &all[1..],
                "12 knots for 2 curves, which need 13 or 9: export them as linear curves",
            ),
            (&[2, 4, 4], &[3, 4], &all, "3 orders for 2 curves: export them as linear curves"),
            (&[], &[3, 4], &all, "0 orders for 2 curves: export them as linear curves"),
            (&[4], &[3, 4], &[0.0; 15], "curve 0: 3 control points do not make a B-spline of order 4: export"),
            (&[0, 4], &[0, 4], &[0.0; 4], "curve 0: has order 0"),
            (&[4], &[usize::MAX, 4], &all, "13 knots for 2 curves"),
        ] {
            let refused = Knots::of_curves(orders, counts, knots).unwrap_err().0;
            assert!(refused.starts_with(why), "{refused}");
        }
    }
}
