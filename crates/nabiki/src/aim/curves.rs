//! Curves that lead hair: each strand takes the directions of those that begin nearest to its root.

use glam::{DVec3, Vec3};

use crate::error::SettingError;
use crate::nearest::Nearest;
use crate::strands::{Strands, not_finite};

/// Curves that lead hair.
#[derive(Clone, Debug, PartialEq)]
pub struct AimCurves {
    curves: Strands,
    frame: Option<u32>,
    /// Curves in the order of x at their roots.
    order: Vec<u32>,
}

impl AimCurves {
    /// Curves (head space, cm), each at least two points long. `frame`: the frame in which they are posed on head and
    /// skin; `None` is at rest. `thing` names them in errors.
    ///
    /// # Errors
    /// No curve, a curve without a length, and a point that is not finite.
    pub fn new(curves: Strands, frame: Option<u32>, thing: &str) -> Result<Self, SettingError> {
        if curves.is_empty() {
            return Err(SettingError::new(thing, "", "has no curves: an aim needs at least one"));
        }
        if let Some(point) = not_finite(curves.points()) {
            let remedy = "every coordinate must be a finite number";
            return Err(SettingError::new(thing, curves.points()[point], remedy));
        }
        if let Some(s) = curves.lengths().position(|length| length == 0.0) {
            return Err(SettingError::new(thing, "", format!("has a curve without a length, number {s}: remove it")));
        }
        let x = |&s: &u32| curves.strand(s as usize)[0].x;
        let mut order: Vec<u32> = (0..curves.len() as u32).collect();
        order.sort_by(|a, b| x(a).total_cmp(&x(b)));
        Ok(Self { curves, frame, order })
    }

    /// The curves (head space of their frame, cm).
    pub fn curves(&self) -> &Strands {
        &self.curves
    }

    /// The frame in which they are posed on head and skin; `None` is at rest.
    pub fn frame(&self) -> Option<u32> {
        self.frame
    }

    /// The same with `ratio` times as many frames.
    pub(super) fn times(&self, ratio: f64) -> Self {
        Self { frame: self.frame.map(|frame| (f64::from(frame) * ratio).round() as u32), ..self.clone() }
    }

    fn root(&self, curve: u32) -> DVec3 {
        self.curves.strand(curve as usize)[0].as_dvec3()
    }

    /// The direction, of length 1, of each segment of a strand whose root is here.
    pub(super) fn directions(&self, root: DVec3, strand: &[Vec3]) -> Vec<DVec3> {
        let near: Vec<(Vec<DVec3>, f64)> =
            self.near(root).into_iter().map(|(curve, weight)| (self.along(curve, strand), weight)).collect();
        let mix = |i: usize| {
            let sum: DVec3 = near.iter().map(|(along, weight)| *weight * along[i]).sum();
            // Curves that point away from each other leave nothing: the nearest one counts.
            sum.try_normalize().unwrap_or(near[0].0[i])
        };
        (0..strand.len() - 1).map(mix).collect()
    }

    /// The curves that a strand with this root mixes, nearest first, with their weights.
    fn near(&self, root: DVec3) -> Vec<(u32, f64)> {
        let mut nearest = Nearest::default();
        let place = self.order.partition_point(|&curve| self.root(curve).x < root.x);
        let (mut left, mut right) = (place, place);
        loop {
            let aside = |at: Option<&u32>| at.map_or(f64::INFINITY, |&curve| (self.root(curve).x - root.x).abs());
            let before = left.checked_sub(1).and_then(|at| self.order.get(at));
            let (to_left, to_right) = (aside(before), aside(self.order.get(right)));
            // Also the end: both are infinite.
            if to_left.min(to_right) >= nearest.reach() {
                break;
            }
            let at = if to_left < to_right { left - 1 } else { right };
            (left, right) = if to_left < to_right { (left - 1, right) } else { (left, right + 1) };
            nearest.offer(self.root(self.order[at]).distance(root), self.order[at]);
        }
        nearest.weights()
    }

    /// The direction of a curve along each segment of a strand, from the same lengths of hair: that of its end for a
    /// strand that is longer.
    fn along(&self, curve: u32, strand: &[Vec3]) -> Vec<DVec3> {
        let points: Vec<DVec3> = self.curves.strand(curve as usize).iter().map(|p| p.as_dvec3()).collect();
        let (mut segment, mut begin, mut length) = (0, 0.0, points[0].distance(points[1]));
        // The point at this length of hair, which grows from call to call.
        let mut at = |along: f64| {
            while along > begin + length && segment + 2 < points.len() {
                begin += length;
                segment += 1;
                length = points[segment].distance(points[segment + 1]);
            }
            let part = if length > 0.0 { ((along - begin) / length).min(1.0) } else { 1.0 };
            points[segment].lerp(points[segment + 1], part)
        };
        let (mut from, mut along, mut last) = (points[0], 0.0, None);
        let mut directions = Vec::with_capacity(strand.len() - 1);
        for ends in strand.windows(2) {
            along += ends[0].as_dvec3().distance(ends[1].as_dvec3());
            let to = at(along);
            // A segment that is mostly beyond the end has hardly a direction of its own.
            let way = to - from;
            if way.length() > 0.5 * f64::from(ends[0].distance(ends[1])) || last.is_none() {
                last = way.try_normalize().or(last);
            }
            directions.push(last.unwrap_or_else(|| (points[points.len() - 1] - points[0]).normalize_or(DVec3::Y)));
            from = to;
        }
        directions
    }
}
