//! Curves of an archive as strands.

use std::io::{Read, Seek};

use glam::DAffine3;
use nabiki::Hair;
use nabiki::hair::Stored;
use nabiki_exchange::curves::{Basis, Shape, checked_counts};
use nabiki_exchange::{Closed, Course, Hidden, Knots, LeftOut};

use crate::Problem;
use crate::attributes::Parameters;
use crate::read::{ArchiveReader, go_toward, required};
use crate::schemas::NURBS_SURFACE;
use crate::shown::hidden;
use crate::tree::{Header, PropertyKind};
use crate::values::{doubles, integers};

/// The first byte of `curveBasisAndType`: how curves run.
mod kind {
    pub const CUBIC: u8 = 0;
    pub const LINEAR: u8 = 1;
    pub const OF_THEIR_ORDERS: u8 = 2;
}
/// Its third byte: the basis of cubic ones.
mod basis {
    pub const NONE: u8 = 0;
    pub const BEZIER: u8 = 1;
    pub const B_SPLINE: u8 = 2;
    pub const CATMULL_ROM: u8 = 3;
}

impl<R: Read + Seek> ArchiveReader<R> {
    pub(crate) fn curves(
        &mut self,
        object: usize,
        time: f64,
        segments: Option<usize>,
        attributes: bool,
    ) -> Result<(Hair, DAffine3), Problem> {
        let mut inside = self.schema(object)?;
        let positions = required(&inside, "P", "")?;
        if positions.samples == 0 {
            return Ok((Hair::default(), DAffine3::IDENTITY));
        }
        let (frame, share) = self.tree.timings[positions.timing].at(time, positions.samples);
        let mut points = self.tree.points(positions, frame)?;
        let header = required(&inside, "nVertices", "")?;
        let counts = integers(header.kind, &self.tree.sample(header, frame)?)?;
        if share > 0.0 && self.tree.sample(header, frame)? == self.tree.sample(header, frame + 1)? {
            go_toward(&mut points, &self.tree.points(positions, frame + 1)?, share);
        }
        let counts = checked_counts(&counts, points.len())?;
        let (basis, knots) = self.basis(&inside, &counts, frame)?;
        // Knots bend no polyline.
        if basis == Basis::Linear || !knots.is_empty() {
            inside.retain(|h| !matches!(&*h.name, ".knots" | ".orders"));
        }
        // Weights that are alike, or none, pull nowhere.
        if let Some(weights) = inside.iter().find(|h| &*h.name == "w" && h.form != PropertyKind::Compound) {
            let weights = doubles(weights.kind, &self.tree.sample(weights, frame)?)?;
            if weights.windows(2).all(|pair| pair[0] == pair[1]) {
                inside.retain(|h| &*h.name != "w");
            }
        }
        let lines = Shape { counts, basis, pinned: false }.walk_by(knots, points, segments)?;
        let world = DAffine3::from_mat4(self.world(object, time)?);
        if !attributes {
            return Ok((Hair::from(lines.strands), world));
        }
        let marks = hidden(&mut self.tree, object)?;
        let mut parameters = Parameters::of(&mut self.tree, inside, frame)?;
        let mut attributes = lines.attributes(&mut parameters)?;
        attributes.unread.extend(parameters.unread()?);
        attributes.unread.extend(marks.iter().map(Hidden::kept));
        // Our own name for ids beyond 32 bits.
        let long = attributes.id.as_ref().is_some_and(|ids| ids.iter().any(|&id| i32::try_from(id).is_err()));
        attributes.other.retain(|other| !(long && other.name == "id" && other.stored == Stored::I64));
        Ok((Hair { strands: lines.strands, attributes }, world))
    }

    /// How curves of so many control points run in a sample, and their knots where they go by any.
    fn basis(&mut self, inside: &[Header], counts: &[usize], frame: usize) -> Result<(Basis, Vec<Knots>), Problem> {
        let mut numbers =
            |name: &str| match inside.iter().find(|h| &*h.name == name && h.form != PropertyKind::Compound) {
                Some(header) => doubles(header.kind, &self.tree.sample(header, frame)?),
                None => Ok(Vec::new()),
            };
        let said: Vec<u8> = numbers("curveBasisAndType")?.into_iter().map(|byte| byte as u8).collect();
        let &[kind, _, basis, ..] = &said[..] else {
            return Err(Problem::new("do not say whether they are straight or cubic"));
        };
        let knots = numbers(".knots")?;
        match (kind, basis) {
            (kind::LINEAR, _) => Ok((Basis::Linear, Vec::new())),
            // Not all that have knots are called what they are.
            (kind::CUBIC, basis::NONE | basis::B_SPLINE) if !knots.is_empty() => {
                Ok((Basis::Bspline, Knots::of_curves(&[4], counts, &knots)?))
            }
            (kind::CUBIC, basis::BEZIER) => Ok((Basis::Bezier, Vec::new())),
            (kind::CUBIC, basis::B_SPLINE) => Ok((Basis::Bspline, Vec::new())),
            (kind::CUBIC, basis::CATMULL_ROM) => Ok((Basis::CatmullRom, Vec::new())),
            (kind::CUBIC, b) => {
                Err(Problem(format!("cubic curves of basis {b}: export them as linear, Bezier or B-spline curves")))
            }
            (kind::OF_THEIR_ORDERS, _) => {
                let orders: Vec<usize> = numbers(".orders")?.into_iter().map(|order| order as usize).collect();
                match &orders[..] {
                    [_, ..] if orders.iter().all(|&order| order == 2) => Ok((Basis::Linear, Vec::new())),
                    _ if knots.is_empty() => {
                        Err(Problem::new("are NURBS with their own orders but no knots: export them as linear curves"))
                    }
                    _ => Ok((Basis::Bspline, Knots::of_curves(&orders, counts, &knots)?)),
                }
            }
            (kind, _) => Err(Problem(format!("curves of type {kind}: export them as linear curves"))),
        }
    }

    /// How curves run, as far as they say it.
    pub(crate) fn course(&mut self, inside: &[Header]) -> Result<Course, Problem> {
        let Some(header) = inside.iter().find(|h| &*h.name == "curveBasisAndType" && h.samples > 0) else {
            return Ok(Course::LINEAR);
        };
        let said = self.tree.sample(header, 0)?;
        let basis = match (said.first(), said.get(2)) {
            (Some(&kind::LINEAR), _) => Basis::Linear,
            (_, Some(&basis::BEZIER)) => Basis::Bezier,
            (_, Some(&basis::CATMULL_ROM)) => Basis::CatmullRom,
            _ => Basis::Bspline,
        };
        Ok(Course { basis, pinned: false })
    }

    /// Whether curves are closed, which no hair is.
    pub(crate) fn are_closed(&mut self, object: usize) -> Result<bool, Problem> {
        let inside = self.schema(object)?;
        let Some(header) = inside.iter().find(|h| &*h.name == "curveBasisAndType" && h.samples > 0) else {
            return Ok(false);
        };
        let wrap = self.tree.sample(header, 0)?.get(1).copied();
        Ok(wrap.is_some_and(|periodic| periodic != 0))
    }

    /// The curves that may be hair, and those that are closed.
    pub(crate) fn open_curves(&mut self) -> Result<(Vec<usize>, Closed), Problem> {
        let (mut open, mut closed) = (Vec::new(), Vec::new());
        for object in self.of_schema("AbcGeom_Curve") {
            if !self.kept.holds(&self.tree.path(object)) {
                continue;
            }
            if self.are_closed(object)? {
                closed.push(self.tree.path(object));
            } else {
                open.push(object);
            }
        }
        Ok((open, Closed(closed)))
    }

    /// Objects whose paths are `wanted` and that have a shape which is not read.
    pub(crate) fn left_out(&self, schema: &str, wanted: &dyn Fn(&str) -> bool) -> LeftOut<'static> {
        let kind = if schema == NURBS_SURFACE { "NURBS surfaces" } else { "points" };
        let paths = self.of_schema(schema).into_iter().map(|object| self.tree.path(object));
        LeftOut { kind, paths: paths.filter(|path| wanted(path)).collect() }
    }
}
