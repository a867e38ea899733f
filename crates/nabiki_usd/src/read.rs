//! Hair, heads and their motion out of a layer.

use std::path::Path;

use glam::{Affine3A, DAffine3, Vec3};
use nabiki::{Hair, Mesh};
use nabiki_exchange::attributes::NamedValues;
use nabiki_exchange::curves::{Basis, Shape, checked_counts};
use nabiki_exchange::{
    Closed, Contents, Course, Frames, Gathered, GroomReader, InPlace, Kept, LeftOut, MOST_FRAMES, Placed, Polygons,
    Prim, PrimKind, Uvs, add_polygons,
};

use crate::Problem;
use crate::arcs;
use crate::instances;
use crate::meshes;
use crate::opened::Layer;
use crate::primvars::Primvars;
use crate::skeleton::{self, Joint};
use crate::source::Source;
use crate::transform;

/// A layer to read hair, heads and motion from.
pub struct StageReader {
    layer: Layer,
    kept: Kept,
}

/// The curves that are read.
const READ: &str = "BasisCurves";
/// Time codes apart by less than this, as a share of a frame, are the same.
const SAME_TIME: f64 = 1e-6;

impl StageReader {
    /// Opens the layer in a file, text or binary.
    ///
    /// # Errors
    /// What is wrong with it, without its name.
    pub fn open(path: &Path) -> Result<Self, Problem> {
        Ok(Self { layer: Layer::file(path)?, kept: Kept::default() })
    }

    /// Opens a layer.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn new(from: impl Source + 'static) -> Result<Self, Problem> {
        Ok(Self { layer: Layer::open(Box::new(from))?, kept: Kept::default() })
    }

    /// A number that the layer says of itself, if it does.
    fn positive(&mut self, name: &str, wanted: &str) -> Result<Option<f64>, Problem> {
        match self.layer.metadata_number(name)? {
            Some(x) if !(x.is_finite() && x > 0.0) => {
                Err(Problem(format!("{name} = {x}: must be a finite number above 0, {wanted}")))
            }
            number => Ok(number),
        }
    }

    fn z_up(&mut self) -> Result<Option<bool>, Problem> {
        let Some(handle) = self.layer.metadata.get("upAxis").copied() else { return Ok(None) };
        let axis = self.layer.words(handle)?.into_iter().next().unwrap_or_default();
        match axis.as_str() {
            "Y" | "y" => Ok(Some(false)),
            "Z" | "z" => Ok(Some(true)),
            _ => Err(Problem(format!("upAxis = \"{axis}\": must be \"Y\" or \"Z\", as USD has it"))),
        }
    }

    fn codes_a_second(&mut self) -> Result<f64, Problem> {
        let rate = self.positive("timeCodesPerSecond", "24, say")?;
        let rate = rate.or(self.positive("framesPerSecond", "24, say")?);
        Ok(rate.unwrap_or(24.0))
    }

    /// The frames of the curves with the most samples, or of what moves them whole, in time codes. Samples at uneven
    /// times, or farther apart than frames, give way to the frames, between which there is interpolation.
    fn frames(&mut self) -> Result<Frames, Problem> {
        let a_frame = self.codes_a_frame()?;
        let samples = |i: usize| self.layer.prims[i].attributes.get("points").map(|a| &a.samples[..]).unwrap_or(&[]);
        let most = self.layer.of_type("BasisCurves").into_iter().map(samples).max_by_key(|s| s.len());
        let mut codes: Vec<f64> = most.unwrap_or_default().iter().map(|&(time, _)| time).collect();
        if codes.len() < 2 {
            let most = self.layer.of_type("BasisCurves").into_iter().max_by_key(|&i| self.layer.standing[i].moves);
            let mut above = most.map(|i| transform::times(&self.layer, i)).unwrap_or_default();
            above.sort_by(f64::total_cmp);
            above.dedup();
            codes = if above.len() > 1 { above } else { codes };
        }
        let as_sampled = Frames::as_sampled(&codes).filter(|frames| frames.step <= a_frame * (1.0 + SAME_TIME));
        as_sampled.or_else(|| Frames::whole(&codes, a_frame)).ok_or_else(|| {
            let [first, last] = [codes[0], codes[codes.len() - 1]];
            Problem(format!("its curves move from time code {first} to {last}, longer than is read"))
        })
    }

    /// Time codes from one frame to the next.
    fn codes_a_frame(&mut self) -> Result<f64, Problem> {
        // Codes so close that they are no frames of any film, in a layer that does not say how many make one.
        const MOST_A_SECOND: f64 = 240.0;
        let codes = self.codes_a_second()?;
        let frames = self.positive("framesPerSecond", "24, say")?;
        Ok(codes / frames.unwrap_or(if codes > MOST_A_SECOND { 24.0 } else { codes }))
    }

    /// The time code of a frame; that of the last after those there are.
    fn code_of(&mut self, frame: usize) -> Result<f64, Problem> {
        let codes = self.frames()?.times;
        Ok(codes.get(frame).or(codes.last()).copied().unwrap_or(0.0))
    }

    fn curves(&mut self, prim: usize, time: f64, segments: Option<usize>, attributes: bool) -> Result<Hair, Problem> {
        let layer = &mut self.layer;
        let points = layer.points_at(prim, "points", time)?.ok_or_else(|| Problem::new("have no points"))?;
        let counts = layer.at(prim, "curveVertexCounts", time);
        let counts = layer.integers(counts.ok_or_else(|| Problem::new("have no curveVertexCounts"))?)?;
        let counts = checked_counts(&counts, points.len())?;
        let Course { basis, pinned } = course(layer, prim)?;
        let lines = Shape { counts, basis, pinned }.walk(points, segments)?;
        if !attributes {
            return Ok(Hair::from(lines.strands));
        }
        let mut primvars = Primvars { layer: &mut self.layer, prim, time };
        let mut attributes = lines.attributes(&mut primvars)?;
        attributes.unread.extend(primvars.unread()?);
        Ok(Hair { strands: lines.strands, attributes })
    }

    /// Whether curves are closed, which no hair is.
    fn are_closed(&mut self, prim: usize) -> Result<bool, Problem> {
        Ok(self.layer.word(prim, "wrap")?.as_deref() == Some("periodic"))
    }

    /// The curves that may be hair, and those that are closed.
    fn open_curves(&mut self) -> Result<(Vec<usize>, Closed), Problem> {
        let (mut open, mut closed) = (Vec::new(), Vec::new());
        for prim in self.layer.with_points("BasisCurves") {
            if !self.kept.holds(&self.layer.path(prim)) {
                continue;
            }
            if self.are_closed(prim)? { closed.push(self.layer.path(prim)) } else { open.push(prim) }
        }
        Ok((open, Closed(closed)))
    }

    /// What others take for strands and is not read.
    fn other_curves(&self) -> [LeftOut<'static>; 3] {
        ["HermiteCurves", "NurbsCurves", "Points"].map(|kind| {
            let paths = self.layer.of_type(kind).into_iter().map(|prim| self.layer.path(prim)).collect();
            LeftOut { kind, paths }
        })
    }

    /// Why a layer has no curves to read, and the way out.
    fn no_curves(&self) -> Problem {
        if let Some(prototypes) = instances::unread(&self.layer, "BasisCurves", &|_| true).first() {
            return Problem(format!("has no BasisCurves but {prototypes}"));
        }
        let is_over = |&i: &usize| self.layer.prims[i].type_name == "BasisCurves" && self.layer.is_active(i);
        if let Some(over) = (0..self.layer.prims.len()).find(is_over) {
            let path = self.layer.path(over);
            return Problem(if arcs::has_instances(&self.layer) {
                format!(
                    "curves {path}: are a prototype of instances, which flattening leaves: turn off instanceable on these before it \
                     (usdcat --flatten IN -o OUT)"
                )
            } else {
                let way_out = arcs::way_out(&self.layer);
                format!(
                    "curves {path}: an over defines nothing by itself: give the layer that defines it, or {way_out}"
                )
            });
        }
        if let Some(refused) = self.other_curves().iter().find_map(|others| others.refused(READ)) {
            return refused;
        }
        Problem(format!("has no BasisCurves: if they come by reference, {}", arcs::way_out(&self.layer)))
    }

    /// Number of values of an attribute at its first time code.
    fn count(&mut self, prim: usize, name: &str) -> Result<usize, Problem> {
        match self.layer.at(prim, name, f64::NEG_INFINITY) {
            Some(handle) => self.layer.count(handle, 1),
            None => Ok(0),
        }
    }

    fn point_count(&mut self, prim: usize) -> Result<usize, Problem> {
        match self.layer.at(prim, "points", f64::NEG_INFINITY) {
            Some(handle) => self.layer.count(handle, 3),
            None => Ok(0),
        }
    }

    /// The prim or joint that a node's name means.
    fn mover(&mut self, node: &str) -> Result<Mover, Problem> {
        let all = 0..self.layer.prims.len();
        let found = all.clone().find(|&i| self.layer.path(i) == node);
        let by_name = || all.clone().find(|&i| self.layer.prims[i].name.eq_ignore_ascii_case(node));
        if let Some(prim) = found.or_else(by_name) {
            return Ok(Mover::Prim(prim));
        }
        match skeleton::joint(&mut self.layer, node)? {
            Some(joint) => Ok(Mover::Joint(joint)),
            None => Err(Problem(format!("has no prim or joint {node}: node can be {}", self.movers()?.join(", ")))),
        }
    }

    /// The texture coordinates of a mesh. `None` where it has none, or one for all or for each face, which say nothing of a
    /// place.
    fn texture_coordinates(&mut self, prim: usize, time: f64) -> Result<Option<Uvs>, Problem> {
        let of = match self.layer.interpolation(prim, "primvars:st")?.as_deref() {
            Some("faceVarying") => Uvs::OfCorners,
            Some("vertex" | "varying") => Uvs::OfVertices,
            _ => return Ok(None),
        };
        let uvs = Primvars { layer: &mut self.layer, prim, time }.tuples::<2>("st")?;
        Ok(uvs.map(of))
    }

    /// Paths of what can move a head: prims that move themselves, then joints; where there are none, any prim.
    fn movers(&mut self) -> Result<Vec<String>, Problem> {
        const MOST_NAMED: usize = 40;
        const MOST_LETTERS: usize = 4000;
        let moves = |i: &usize| {
            let attributes = &self.layer.prims[*i].attributes;
            attributes.iter().any(|(name, a)| name.starts_with("xformOp:") && a.samples.len() > 1)
        };
        let (moving, still): (Vec<usize>, Vec<usize>) = (0..self.layer.prims.len()).partition(moves);
        let mut paths: Vec<String> = moving.into_iter().map(|i| self.layer.path(i)).collect();
        for skeleton in self.layer.of_type("Skeleton") {
            let path = self.layer.path(skeleton);
            let joints = skeleton::joints(&mut self.layer, skeleton)?;
            paths.extend(joints.into_iter().map(|joint| format!("{path}/{joint}")));
        }
        if paths.is_empty() {
            paths.extend(still.into_iter().map(|i| self.layer.path(i)));
        }
        paths.truncate(MOST_NAMED);
        // A line that can be read, however long the paths are.
        let mut letters = 0;
        paths.retain(|path| {
            letters += path.len();
            letters <= MOST_LETTERS
        });
        Ok(paths)
    }
}

/// How curves run.
fn course(layer: &mut Layer, prim: usize) -> Result<Course, Problem> {
    // What is not said is cubic, Bezier and open in USD.
    let order = layer.word(prim, "type")?.unwrap_or_else(|| "cubic".to_owned());
    let basis = layer.word(prim, "basis")?.unwrap_or_else(|| "bezier".to_owned());
    let pinned = layer.word(prim, "wrap")?.is_some_and(|wrap| wrap == "pinned");
    match (order.as_str(), basis.as_str()) {
        ("linear", _) => Ok(Course::LINEAR),
        ("cubic", "bezier") => Ok(Course { basis: Basis::Bezier, pinned }),
        ("cubic", "bspline") => Ok(Course { basis: Basis::Bspline, pinned }),
        ("cubic", "catmullRom") => Ok(Course { basis: Basis::CatmullRom, pinned }),
        (order, basis) => Err(Problem(format!("are {order} of basis {basis}, which USD does not know"))),
    }
}

/// What can carry a head.
enum Mover {
    Prim(usize),
    Joint(Joint),
}

impl GroomReader for StageReader {
    fn contents(&mut self) -> Result<Contents, Problem> {
        self.layer.budget.next_question();
        let paths = |layer: &Layer, kind: &str| {
            let prims = layer.of_type(kind).into_iter().filter(|&i| layer.has_points(i));
            prims.map(|i| layer.path(i)).collect::<Vec<_>>()
        };
        let curves = self.open_curves()?.0.into_iter().map(|i| self.layer.path(i)).collect();
        let frames = self.frames()?;
        let codes_a_second = self.codes_a_second()?;
        // Curves that move begin with the hair that is read first, whatever of the stage comes before or after.
        let start = match frames.times[..] {
            [first, _, ..] => Some(first),
            _ => self.layer.metadata_number("startTimeCode")?.filter(|code| code.is_finite()),
        };
        Ok(Contents {
            start: start.map(|code| code / codes_a_second),
            curves,
            meshes: paths(&self.layer, "Mesh"),
            frame_rate: if frames.step > 0.0 { frames.rate(codes_a_second) } else { codes_a_second },
            times: frames.times.into_iter().map(|code| code / codes_a_second).collect(),
            meters_per_unit: self.positive("metersPerUnit", "0.01 for centimetres")?,
            z_up: self.z_up()?,
        })
    }

    fn prims(&mut self) -> Result<Vec<Prim>, Problem> {
        self.layer.budget.next_question();
        let mut prims = Vec::with_capacity(self.layer.prims.len());
        // Found by looking at all curves: once, not for each of thousands.
        let time = if self.layer.of_type("BasisCurves").is_empty() { 0.0 } else { self.code_of(0)? };
        for i in 0..self.layer.prims.len() {
            let type_name = self.layer.prims[i].type_name.clone();
            let kind = match type_name.as_str() {
                _ if !self.layer.is_on_stage(i) => {
                    let why = match (self.layer.is_active(i), self.layer.is_defined(i)) {
                        (false, _) => "inactive or of a class",
                        (true, false) => "an over",
                        (true, true) => "drawn where its point instancer has instances",
                    };
                    PrimKind::Other(format!("{type_name} ({why})").trim_start().to_owned())
                }
                "BasisCurves" if self.are_closed(i)? => PrimKind::Other(format!("{type_name} (closed)")),
                "BasisCurves" => {
                    let curves = self.count(i, "curveVertexCounts")?;
                    // Curves that USD does not know are refused when they are read.
                    let course = course(&mut self.layer, i).unwrap_or(Course::LINEAR);
                    let world = DAffine3::from_mat4(transform::world(&mut self.layer, i, time)?);
                    PrimKind::Curves { curves, points: self.point_count(i)?, course, world_from_curves: world }
                }
                "Mesh" => {
                    let faces = self.count(i, "faceVertexCounts")?;
                    PrimKind::Mesh { faces, points: self.point_count(i)? }
                }
                "Xform" => PrimKind::Transform,
                "Skeleton" => PrimKind::Skeleton { joints: skeleton::joints(&mut self.layer, i)? },
                _ => PrimKind::Other(type_name.to_string()),
            };
            let samples = self.layer.prims[i].attributes.values().map(|a| a.samples.len()).max().unwrap_or(0);
            let relationships = self.layer.prims[i].relationships.iter().map(|name| name.to_string());
            let relationships: Vec<String> = relationships.collect();
            let letters: usize = relationships.iter().map(|name| size_of::<String>() + name.len()).sum();
            let path = self.layer.standing[i].path_bytes as usize;
            self.layer.budget.take((size_of::<Prim>() + path + letters) as u64, "prims")?;
            prims.push(Prim { path: self.layer.path(i), kind, samples, relationships });
        }
        Ok(prims)
    }

    fn keep_curves(&mut self, paths: Vec<String>) {
        self.kept = Kept::only(paths);
    }

    fn hair_in_place(&mut self, frame: usize, segments: Option<usize>, attributes: bool) -> Result<InPlace, Problem> {
        self.layer.budget.next_question();
        let time = self.code_of(frame)?;
        if self.layer.with_points("BasisCurves").is_empty() {
            return Err(self.no_curves());
        }
        let (prims, closed) = self.open_curves()?;
        closed.check(prims.len())?;
        let mut all = Gathered::default();
        for (group, &prim) in prims.iter().enumerate() {
            let part = self.curves(prim, time, segments, attributes);
            let part = part.map_err(|e| Problem(format!("curves {}: {e}", self.layer.path(prim))))?;
            let name = self.layer.prims[prim].name.to_string();
            let world = transform::world(&mut self.layer, prim, time)?;
            all.append(part, DAffine3::from_mat4(world), (prims.len() > 1).then_some((group as i32, name)))?;
        }
        let mut placed = all.hair()?;
        if attributes {
            let (frames, codes_a_second) = (self.frames()?, self.codes_a_second()?);
            let unread = &mut placed.hair.attributes.unread;
            unread.extend(frames.unread(codes_a_second));
            unread.extend(self.layer.without_points("BasisCurves", "curves"));
            unread.extend(closed.unread());
            unread.extend(self.other_curves().iter().filter_map(|others| others.unread(READ)));
            unread.extend(instances::unread(&self.layer, "BasisCurves", &|_| true));
            unread.extend(arcs::unread(&mut self.layer)?);
        }
        Ok(placed)
    }

    fn meshes(&mut self, wanted: &dyn Fn(&str) -> bool) -> Result<Mesh, Problem> {
        self.layer.budget.next_question();
        let mut mesh = Mesh::default();
        let time = self.code_of(0)?;
        for prim in meshes::chosen(&mut self.layer, wanted)?.prims {
            let path = self.layer.path(prim);
            let problem = |what: &str| Problem(format!("mesh {path}: {what}"));
            let layer = &mut self.layer;
            let points: Vec<Vec3> = layer.points_at(prim, "points", time)?.ok_or_else(|| problem("has no points"))?;
            let counts = layer.at(prim, "faceVertexCounts", time).ok_or_else(|| problem("has no faces"))?;
            let counts = layer.integers(counts)?;
            let corners = layer.at(prim, "faceVertexIndices", time).ok_or_else(|| problem("has no faces"))?;
            let corners = layer.integers(corners)?;
            let clockwise = layer.word(prim, "orientation")?.as_deref() == Some("leftHanded");
            let world = Affine3A::from_mat4(transform::world(&mut self.layer, prim, time)?.as_mat4());
            let uvs = self.texture_coordinates(prim, time)?;
            let polygons = Polygons { positions: &points, counts: &counts, corners: &corners, clockwise, uvs };
            add_polygons(&mut mesh, polygons, &world).map_err(|e| problem(&e.0))?;
        }
        match mesh.positions.iter().find(|p| !p.is_finite()) {
            Some(p) => Err(Problem(format!("has a vertex at {p}"))),
            None if mesh.triangles.is_empty() => match arcs::unread(&mut self.layer)? {
                Some(_) => {
                    Err(Problem(format!("has no meshes: if they come by reference, {}", arcs::way_out(&self.layer))))
                }
                None => match instances::unread(&self.layer, "Mesh", wanted).first() {
                    Some(prototypes) => Err(Problem(format!("has no meshes but {prototypes}"))),
                    None => Err(Problem::new("has no meshes")),
                },
            },
            None => Ok(mesh),
        }
    }

    fn meshes_unread(&mut self, wanted: &dyn Fn(&str) -> bool) -> Result<Vec<String>, Problem> {
        self.layer.budget.next_question();
        let mut unread = meshes::chosen(&mut self.layer, wanted)?.unread;
        unread.extend(arcs::unread(&mut self.layer)?);
        Ok(unread)
    }

    fn motion(&mut self, node: &str) -> Result<Vec<Placed>, Problem> {
        self.layer.budget.next_question();
        let rate = self.codes_a_second()?;
        let mover = self.mover(node)?;
        let mut times = match &mover {
            Mover::Prim(prim) => transform::times(&self.layer, *prim),
            Mover::Joint(joint) => joint.times(&self.layer),
        };
        times.sort_by(f64::total_cmp);
        times.dedup();
        // Between two keys each operation goes its own way, a parent's turn about another: whole codes follow it.
        if let [first, .., last] = times[..] {
            if last - first > MOST_FRAMES as f64 {
                return Err(Problem(format!("{node}: moves from time code {first} to {last}, longer than is read")));
            }
            times.extend((first.ceil() as i64..=last.floor() as i64).map(|code| code as f64));
            times.sort_by(f64::total_cmp);
            times.dedup_by(|a, b| (*a - *b).abs() <= SAME_TIME);
        }
        if times.len() > MOST_FRAMES {
            return Err(Problem(format!("{node}: moves at {} time codes, more than is read", times.len())));
        }
        if times.is_empty() {
            times.push(0.0);
        }
        let mut motion = Vec::with_capacity(times.len());
        for time in times {
            self.layer.budget.next_moment()?;
            let world = match &mover {
                Mover::Prim(prim) => transform::world(&mut self.layer, *prim, time)?,
                Mover::Joint(joint) => joint.world(&mut self.layer, time)?,
            };
            if !(world.is_finite() && world.determinant().abs() > 0.0) {
                return Err(Problem(format!("{node}: its transform at time code {time} flattens space")));
            }
            motion.push(Placed::of(time / rate, &world));
        }
        Ok(motion)
    }

    fn bound(&mut self, node: &str) -> Result<Option<Placed>, Problem> {
        self.layer.budget.next_question();
        let bound = match self.mover(node)? {
            Mover::Prim(_) => None,
            Mover::Joint(joint) => joint.bound(&mut self.layer)?,
        };
        match bound {
            Some(world) if !(world.is_finite() && world.determinant().abs() > 0.0) => {
                Err(Problem(format!("{node}: its bind transform flattens space")))
            }
            bound => Ok(bound.map(|world| Placed::of(0.0, &world))),
        }
    }
}
