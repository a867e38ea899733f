//! Computes control points for curves that pass through given points.

use glam::{DVec3, Vec3};
use nabiki::Strands;

use crate::curves::{Basis, Shape};

/// The basis of curves, and where they end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Course {
    /// The basis.
    pub basis: Basis,
    /// As [`Shape::pinned`].
    pub pinned: bool,
}

impl Course {
    /// Straight lines, which pass through their control points.
    pub const LINEAR: Self = Self { basis: Basis::Linear, pinned: false };

    /// Replaces `points`, those of `strands` in any space, by the control points of curves that run from the first
    /// point of each strand to its last.
    ///
    /// Bezier curves and pinned splines pass through all points. Unpinned curves lie between all control points but the
    /// first and last, so they have two knots fewer. Their knots lie on the Catmull-Rom curve through the points; they
    /// leave the root and reach the tip along the parabola through the three points there.
    ///
    /// Strands whose number of points allows no such curve are left unchanged.
    ///
    /// # Panics
    /// If the number of points is not that of the strands.
    pub fn control_points(self, strands: &Strands, points: &mut [Vec3]) {
        if self == Self::LINEAR {
            return;
        }
        let mut room = Vec::new();
        for s in 0..strands.len() {
            room.clear();
            let strand = &mut points[strands.range(s)];
            self.of_strand(strand, &mut room);
            strand.copy_from_slice(&room);
        }
    }

    fn of_strand(self, p: &[Vec3], room: &mut Vec<Vec3>) {
        let n = p.len();
        match (self.basis, self.pinned) {
            (Basis::Bezier, _) if n >= 4 && n % 3 == 1 => bezier(p, room),
            (Basis::Bspline, true) if n >= 3 => {
                let mut inner: Vec<DVec3> = p.iter().map(|p| 6.0 * p.as_dvec3()).collect();
                // The points beyond the ends stand so that the curve begins and ends at its own first and last.
                let ends = [inner[0] / 6.0, inner[n - 1] / 6.0];
                inner[1] -= ends[0];
                inner[n - 2] -= ends[1];
                solve(&mut inner[1..n - 1], 4.0);
                room.push(p[0]);
                room.extend(inner[1..n - 1].iter().map(|c| c.as_vec3()));
                room.push(p[n - 1]);
            }
            (Basis::Bspline | Basis::CatmullRom, false) if n >= 4 => unpinned(self.basis, p, room),
            _ => room.extend_from_slice(p),
        }
    }
}

/// The cubic of every third point to the next that passes the two between them at its thirds.
fn bezier(p: &[Vec3], room: &mut Vec<Vec3>) {
    room.push(p[0]);
    for piece in p.windows(4).step_by(3) {
        let [a, b, c, d] = std::array::from_fn(|i| piece[i].as_dvec3());
        room.push(((-5.0 * a + 18.0 * b - 9.0 * c + 2.0 * d) / 6.0).as_vec3());
        room.push(((2.0 * a - 9.0 * b + 18.0 * c - 5.0 * d) / 6.0).as_vec3());
        room.push(piece[3]);
    }
}

/// A spline whose first and last pieces are not drawn, so that two of its points say only how it leaves its ends.
fn unpinned(basis: Basis, p: &[Vec3], room: &mut Vec<Vec3>) {
    let n = p.len();
    let through = Shape { counts: Vec::new(), basis: Basis::CatmullRom, pinned: true };
    // Points of `p` from one knot to the next.
    let step = (n - 1) as f64 / (n - 3) as f64;
    let knot = |k: usize| {
        let place = k as f64 * step;
        let piece = (place as usize).min(n - 2);
        through.blend(n, piece, place - piece as f64).of(p)
    };
    let last = n - 3;
    let mut knots: Vec<DVec3> = (1..last).map(knot).collect();
    knots.insert(0, p[0].as_dvec3());
    knots.push(p[n - 1].as_dvec3());
    let leaves = |a: Vec3, b: Vec3, c: Vec3| (4.0 * b.as_dvec3() - 3.0 * a.as_dvec3() - c.as_dvec3()) * (0.5 * step);
    let (root, tip) = (leaves(p[0], p[1], p[2]), leaves(p[n - 1], p[n - 2], p[n - 3]));
    if basis == Basis::Bspline {
        // Six times a knot is c_0 + 4 c_1 + c_2, and how the curve leaves it half of c_2 - c_0: c_0 is put in terms of the others.
        knots.iter_mut().for_each(|knot| *knot *= 6.0);
        knots[0] = 0.5 * knots[0] + root;
        knots[last] = 0.5 * knots[last] + tip;
        solve(&mut knots, 2.0);
    }
    let (first, beyond) = (knots[1] - 2.0 * root, knots[last - 1] - 2.0 * tip);
    room.push(first.as_vec3());
    room.extend(knots.iter().map(|c| c.as_vec3()));
    room.push(beyond.as_vec3());
}

/// Solves x_(i-1) + 4 x_i + x_(i+1) = v_i in place, where the first and last have `end` for 4 and no neighbour outside.
fn solve(v: &mut [DVec3], end: f64) {
    let n = v.len();
    let diagonal = |i: usize| if i == 0 || i == n - 1 { end } else { 4.0 };
    let mut above = Vec::with_capacity(n);
    for i in 0..n {
        let before = if i == 0 { (0.0, DVec3::ZERO) } else { (above[i - 1], v[i - 1]) };
        let pivot = diagonal(i) - before.0;
        above.push(1.0 / pivot);
        v[i] = (v[i] - before.1) / pivot;
    }
    for i in (0..n.saturating_sub(1)).rev() {
        v[i] -= above[i] * v[i + 1];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const COURSES: [(Basis, bool, usize); 6] = [
        (Basis::Linear, false, 2),
        (Basis::Bezier, false, 4),
        (Basis::Bspline, false, 4),
        (Basis::Bspline, true, 2),
        (Basis::CatmullRom, false, 4),
        (Basis::CatmullRom, true, 2),
    ];

    /// A strand of `n` points evenly along a half turn of a helix: `bend` is the radius.
    fn helix(n: usize, bend: f32) -> Vec<Vec3> {
        let at = |i: usize| std::f32::consts::PI * i as f32 / (n - 1) as f32;
        (0..n).map(|i| Vec3::new(150.0 + bend * at(i).cos(), bend * at(i).sin(), -20.0 + at(i))).collect()
    }

    /// The curve that is drawn, at `steps` + 1 places evenly far along its parameter.
    fn drawn(course: Course, control: &[Vec3], steps: usize) -> Vec<DVec3> {
        let n = control.len();
        let shape = Shape { counts: vec![n], basis: course.basis, pinned: course.pinned };
        let pieces = match (course.basis, course.pinned) {
            (Basis::Bezier, _) => (n - 1) / 3,
            (Basis::Bspline | Basis::CatmullRom, false) => n - 3,
            _ => n - 1,
        };
        let at = |step: usize| {
            let place = (pieces * step) as f64 / steps as f64;
            let piece = (place as usize).min(pieces - 1);
            shape.blend(n, piece, place - piece as f64).of(control)
        };
        (0..=steps).map(at).collect()
    }

    fn through(course: Course, p: &[Vec3]) -> Vec<Vec3> {
        let mut strands = Strands::default();
        // Between others, as its own points alone count.
        for strand in [&p[..2], p, &p[..2]] {
            strands.push(strand.iter().copied());
        }
        let mut points = strands.points().to_vec();
        course.control_points(&strands, &mut points);
        points[2..2 + p.len()].to_vec()
    }

    /// What rounding of control points to singles leaves of a place: half a step of the farthest, whose weights add up to 1.
    fn rounding(control: &[Vec3]) -> f64 {
        let farthest = control.iter().map(|c| c.abs().max_element()).fold(0.0, f32::max);
        // In each of three coordinates.
        1.01 * 3f64.sqrt() * f64::from(farthest * 0.5 * f32::EPSILON)
    }

    #[test]
    fn a_drawn_curve_begins_at_the_root_and_ends_at_the_tip() {
        for (basis, pinned, least) in COURSES {
            let course = Course { basis, pinned };
            for n in (least..40).filter(|n| basis != Basis::Bezier || n % 3 == 1) {
                // Bent everywhere, and with a sharp corner next to the root.
                let mut sharp = helix(n, 10.0);
                sharp[1] += Vec3::new(3.0, -7.0, 2.0);
                for p in [helix(n, 10.0), sharp] {
                    let control = through(course, &p);
                    let curve = drawn(course, &control, 1);
                    for (end, of) in [(curve[0], p[0]), (curve[1], p[n - 1])] {
                        let off = end.distance(of.as_dvec3());
                        assert!(off <= rounding(&control), "{basis:?} {pinned} {n}: {off:e}");
                    }
                }
            }
        }
    }

    #[test]
    fn pinned_curves_and_bezier_curves_pass_through_all_points() {
        for (basis, pinned, least) in COURSES {
            if !(pinned || matches!(basis, Basis::Bezier | Basis::Linear)) {
                continue;
            }
            let course = Course { basis, pinned };
            for n in (least..20).filter(|n| basis != Basis::Bezier || n % 3 == 1) {
                let p = helix(n, 10.0);
                let control = through(course, &p);
                for (at, of) in drawn(course, &control, n - 1).into_iter().zip(&p) {
                    // The points of a Bezier curve weigh up to 1 between its ends, and their places in the parameter round.
                    let off = at.distance(of.as_dvec3());
                    assert!(off <= rounding(&control) + 1e-12 * 200.0, "{basis:?} {pinned} {n}: {off:e}");
                }
            }
        }
    }

    #[test]
    fn curves_that_are_not_pinned_are_drawn_as_long_and_near_all_points() {
        for basis in [Basis::Bspline, Basis::CatmullRom] {
            let course = Course { basis, pinned: false };
            let worst = |n: usize| {
                let p = helix(n, 10.0);
                let curve = drawn(course, &through(course, &p), 4000);
                let off = |p: &Vec3| curve.iter().map(|q| q.distance(p.as_dvec3())).fold(f64::INFINITY, f64::min);
                let length: f64 = curve.windows(2).map(|w| w[0].distance(w[1])).sum();
                let expected = std::f64::consts::PI * 101f64.sqrt();
                (p.iter().map(off).fold(0.0, f64::max), (length / expected - 1.0).abs())
            };
            // Cubics through points of distance h are off by h^4 of what bends them, parabolas at the ends by h^3: halving the
            // distance leaves an eighth. A radius of 10 over 7 segments, h = 0.45, has 10 h^3 / 10 at most.
            let (coarse, fine) = (worst(8), worst(15));
            assert!(coarse.0 < 0.09 && fine.0 < coarse.0 / 8.0, "{basis:?}: {coarse:?} {fine:?}");
            assert!(coarse.1 < 0.01 && fine.1 < 0.001, "{basis:?}: {coarse:?} {fine:?}");
        }
    }

    #[test]
    fn straight_strands_have_evenly_spaced_control_points() {
        for (basis, pinned, least) in COURSES {
            for n in (least..12).filter(|n| basis != Basis::Bezier || n % 3 == 1) {
                let p: Vec<Vec3> = (0..n).map(|i| Vec3::new(1.0, -2.0, 0.5) * i as f32).collect();
                let control = through(Course { basis, pinned }, &p);
                let step = (control[1] - control[0]).as_dvec3();
                for pair in control.windows(2) {
                    let off = (pair[1] - pair[0]).as_dvec3().distance(step);
                    assert!(off <= 8.0 * rounding(&control), "{basis:?} {pinned} {n}: {off:e}");
                }
            }
        }
    }
}
