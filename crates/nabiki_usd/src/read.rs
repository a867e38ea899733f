//! Hair, heads and their motion out of a layer.

use std::path::Path;

use glam::{Affine3A, DMat4, DQuat, DVec3, Vec3};
use nabiki::curves::{Basis, Carried, Gathered, Shape, checked_counts, indexed};
use nabiki::{Hair, Mesh};

use crate::Problem;
use crate::source::{Handle, Layer, Source};
use crate::transform;

/// A layer to read hair, heads and motion from; everything comes in the layer's own unit and axes.
pub struct StageReader {
    layer: Layer,
}

/// What a layer holds.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Contents {
    /// Paths of prims with curves.
    pub curves: Vec<String>,
    /// Paths of meshes.
    pub meshes: Vec<String>,
    /// Time codes at which the curves' points have samples.
    pub times: Vec<f64>,
    /// Time codes a second, 24 where the layer does not say.
    pub frame_rate: f64,
    /// Length of the unit (m), where the layer says it; USD takes 0.01 where not.
    pub meters_per_unit: Option<f64>,
    /// Whether z is up, where the layer says it; USD takes y where not.
    pub z_up: Option<bool>,
}

/// Frames a layer may have: what more would be is no time.
const MOST_SAMPLES: usize = 1 << 18;

impl StageReader {
    /// Opens the layer in a file, text or binary.
    ///
    /// # Errors
    /// What is wrong with it, without its name.
    pub fn open(path: &Path) -> Result<Self, Problem> {
        Ok(Self { layer: Layer::file(path)? })
    }

    /// Opens a layer.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn new(from: impl Source + 'static) -> Result<Self, Problem> {
        Ok(Self { layer: Layer::open(Box::new(from))? })
    }

    /// Lists what is in the layer.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn contents(&mut self) -> Result<Contents, Problem> {
        let up = match self.layer.metadata.get("upAxis").copied() {
            Some(handle) => self.layer.words(handle)?.into_iter().next(),
            None => None,
        };
        let rate = self.layer.metadata_number("timeCodesPerSecond")?;
        let rate = rate.or(self.layer.metadata_number("framesPerSecond")?);
        Ok(Contents {
            curves: self.of_type("BasisCurves").into_iter().map(|i| self.layer.path(i)).collect(),
            meshes: self.of_type("Mesh").into_iter().map(|i| self.layer.path(i)).collect(),
            times: self.times(),
            frame_rate: rate.filter(|r| r.is_finite() && *r > 0.0).unwrap_or(24.0),
            meters_per_unit: self.layer.metadata_number("metersPerUnit")?.filter(|m| m.is_finite() && *m > 0.0),
            z_up: up.map(|axis| axis.eq_ignore_ascii_case("z")),
        })
    }

    fn of_type(&self, wanted: &str) -> Vec<usize> {
        (0..self.layer.prims.len()).filter(|&i| self.layer.prims[i].type_name == wanted).collect()
    }

    /// Time codes of the points of the curves with the most.
    fn times(&self) -> Vec<f64> {
        let samples = |i: usize| self.layer.prims[i].attributes.get("points").map(|a| &a.samples[..]).unwrap_or(&[]);
        let most = self.of_type("BasisCurves").into_iter().map(samples).max_by_key(|s| s.len());
        most.unwrap_or_default().iter().map(|&(time, _)| time).collect()
    }

    /// All curves at the `frame`th time code that has points (the last one after those), one after another, with the
    /// transforms above them.
    ///
    /// `segments`: walks every curve into as many; `None` keeps polylines as they are. Curves in several prims that
    /// have no groups of their own are grouped by prim, under its name.
    ///
    /// # Errors
    /// No curves, closed ones, numbers that contradict each other or are not finite.
    pub fn hair(&mut self, frame: usize, segments: Option<usize>) -> Result<Hair, Problem> {
        let times = self.times();
        let time = times.get(frame).or(times.last()).copied().unwrap_or(0.0);
        let prims = self.of_type("BasisCurves");
        if prims.is_empty() {
            return Err(Problem::new(
                "has no BasisCurves: if they come by reference, flatten it first (usdcat --flatten IN -o OUT)",
            ));
        }
        let mut all = Gathered::default();
        for (group, &prim) in prims.iter().enumerate() {
            let part = self.curves(prim, time, segments);
            let part = part.map_err(|e| Problem(format!("curves {}: {e}", self.layer.path(prim))))?;
            let name = self.layer.prims[prim].name.clone();
            all.append(part, (prims.len() > 1).then_some((group as i32, name)));
        }
        all.hair()
    }

    fn curves(&mut self, prim: usize, time: f64, segments: Option<usize>) -> Result<Hair, Problem> {
        let layer = &mut self.layer;
        let points = layer.at(prim, "points", time).ok_or_else(|| Problem::new("have no points"))?;
        let points = layer.points(points)?;
        let counts = layer.at(prim, "curveVertexCounts", time);
        let counts = layer.integers(counts.ok_or_else(|| Problem::new("have no curveVertexCounts"))?)?;
        let counts = checked_counts(&counts, points.len())?;
        // What is not said is cubic, Bezier and open in USD.
        let order = layer.word(prim, "type")?.unwrap_or_else(|| "cubic".to_owned());
        let basis = layer.word(prim, "basis")?.unwrap_or_else(|| "bezier".to_owned());
        let wrap = layer.word(prim, "wrap")?.unwrap_or_else(|| "nonperiodic".to_owned());
        if wrap == "periodic" {
            return Err(Problem::new("are closed, which no hair is: export them as open (nonperiodic) curves"));
        }
        let basis = match (order.as_str(), basis.as_str()) {
            ("linear", _) => Basis::Linear,
            ("cubic", "bezier") => Basis::Bezier,
            ("cubic", "bspline") => Basis::Bspline,
            ("cubic", "catmullRom") => Basis::CatmullRom,
            (order, basis) => return Err(Problem(format!("are {order} of basis {basis}, which USD does not know"))),
        };
        let walked = Shape { counts, basis, pinned: wrap == "pinned" }.walk(points, segments)?;
        let attributes = walked.attributes(&mut Primvars { layer: &mut self.layer, prim, time })?;
        let hair = Hair { strands: walked.strands, attributes };
        let world = transform::world(&mut self.layer, prim, time)?;
        Ok(if world == DMat4::IDENTITY { hair } else { hair.transformed(&Affine3A::from_mat4(world.as_mat4())) })
    }

    /// All meshes at their first time code, cut into triangles, with the transforms above them, as one.
    ///
    /// # Errors
    /// No mesh, or one whose numbers contradict each other.
    pub fn mesh(&mut self) -> Result<Mesh, Problem> {
        let mut mesh = Mesh::default();
        let first = f64::NEG_INFINITY;
        for prim in self.of_type("Mesh") {
            let path = self.layer.path(prim);
            let problem = |what: &str| Problem(format!("mesh {path}: {what}"));
            let layer = &mut self.layer;
            let points = layer.at(prim, "points", first).ok_or_else(|| problem("has no points"))?;
            let points = layer.singles(points)?;
            let counts = layer.at(prim, "faceVertexCounts", first).ok_or_else(|| problem("has no faces"))?;
            let counts = layer.integers(counts)?;
            let corners = layer.at(prim, "faceVertexIndices", first).ok_or_else(|| problem("has no faces"))?;
            let corners = layer.integers(corners)?;
            let left_handed = layer.word(prim, "orientation")?.as_deref() == Some("leftHanded");
            let world = transform::world(&mut self.layer, prim, 0.0)?.as_mat4();
            let positions = points.as_chunks::<3>().0.iter().map(|&p| world.transform_point3(Vec3::from(p)));
            mesh.add_polygons(positions, &counts, &corners, left_handed).map_err(|e| problem(&e.0))?;
        }
        match mesh.positions.iter().find(|p| !p.is_finite()) {
            Some(p) => Err(Problem(format!("has a vertex at {p}"))),
            None if mesh.triangles.is_empty() => Err(Problem::new("has no meshes")),
            None => Ok(mesh),
        }
    }

    /// World position and rotation of the prim `path` (or of the first of that name) at each time code at which it or
    /// a prim above it moves, with their times (s).
    ///
    /// # Errors
    /// No such prim; a transform that flattens space.
    pub fn motion(&mut self, path: &str) -> Result<Vec<(f64, DVec3, DQuat)>, Problem> {
        let rate = self.contents()?.frame_rate;
        let all = 0..self.layer.prims.len();
        let found = all.clone().find(|&i| self.layer.path(i) == path);
        let by_name = || all.clone().find(|&i| self.layer.prims[i].name.eq_ignore_ascii_case(path));
        let prim = found.or_else(by_name).ok_or_else(|| {
            let names: Vec<String> = all.clone().take(40).map(|i| self.layer.path(i)).collect();
            Problem(format!("has no prim {path}: node can be {}", names.join(", ")))
        })?;
        let mut times = Vec::new();
        let mut above = Some(prim);
        while let Some(i) = above {
            let moving = self.layer.prims[i].attributes.iter().filter(|(name, _)| name.starts_with("xformOp:"));
            times.extend(moving.flat_map(|(_, a)| a.samples.iter().map(|&(t, _)| t)));
            above = self.layer.prims[i].parent;
        }
        times.sort_by(f64::total_cmp);
        times.dedup();
        if times.len() > MOST_SAMPLES {
            return Err(Problem(format!("prim {path}: moves at {} time codes, more than is read", times.len())));
        }
        if times.is_empty() {
            times.push(0.0);
        }
        let mut motion = Vec::with_capacity(times.len());
        for time in times {
            let world = transform::world(&mut self.layer, prim, time)?;
            if !(world.is_finite() && world.determinant().abs() > 0.0) {
                return Err(Problem(format!("prim {path}: its transform at time code {time} flattens space")));
            }
            let (_, rotation, position) = world.to_scale_rotation_translation();
            motion.push((time / rate, position, rotation));
        }
        Ok(motion)
    }
}

/// What a prim carries at a time code: its primvars, and `widths`, which is an attribute of its own.
struct Primvars<'a> {
    layer: &'a mut Layer,
    prim: usize,
    time: f64,
}

impl Primvars<'_> {
    fn named(&self, name: &str) -> Option<Handle> {
        let plain = if name == "widths" { self.layer.at(self.prim, name, self.time) } else { None };
        plain.or_else(|| self.layer.at(self.prim, &format!("primvars:{name}"), self.time))
    }

    /// Values, looked up where they are stored by index.
    fn expanded<T: Clone>(&mut self, name: &str, values: Vec<T>) -> Result<Option<Vec<T>>, Problem> {
        match self.layer.at(self.prim, &format!("primvars:{name}:indices"), self.time) {
            Some(indices) => indexed(name, &values, &self.layer.integers(indices)?).map(Some),
            None => Ok(Some(values)),
        }
    }
}

impl Carried for Primvars<'_> {
    fn tuples<const N: usize>(&mut self, name: &str) -> Result<Option<Vec<[f32; N]>>, Problem> {
        let Some(handle) = self.named(name) else { return Ok(None) };
        let numbers = self.layer.singles(handle)?;
        match numbers.as_chunks::<N>() {
            (values, []) if !values.is_empty() => self.expanded(name, values.to_vec()),
            _ => Ok(None),
        }
    }

    fn integers(&mut self, name: &str) -> Result<Option<Vec<i64>>, Problem> {
        let Some(handle) = self.named(name) else { return Ok(None) };
        let values = self.layer.integers(handle)?;
        self.expanded(name, values)
    }

    fn words(&mut self, name: &str) -> Result<Option<Vec<String>>, Problem> {
        let Some(handle) = self.named(name) else { return Ok(None) };
        let values = self.layer.words(handle)?;
        self.expanded(name, values)
    }
}
