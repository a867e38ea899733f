//! Hair, heads and their motion out of a layer.

use std::path::Path;

use glam::{Affine3A, DAffine3, DMat4, Vec3};
use nabiki::{Hair, Mesh};
use nabiki_exchange::attributes::NamedValues;
use nabiki_exchange::curves::{Basis, Shape, checked_counts};
use nabiki_exchange::{
    Canvas, Closed, Contents, Course, Frames, Gathered, GroomReader, InPlace, Kept, LeftOut, MOST_FRAMES, Placed,
    Polygons, Prim, PrimKind, Uvs, add_polygons,
};

use crate::Problem;
use crate::arcs;
use crate::blend::BlendShapes;
use crate::instances;
use crate::meshes;
use crate::opened::Layer;
use crate::painted;
use crate::primvars::Primvars;
use crate::skeleton::{self, Joint};
use crate::skin::{Skin, Stance};
use crate::source::Source;
use crate::transform;

/// A layer to read hair, heads and motion from.
pub struct StageReader {
    pub(crate) layer: Layer,
    kept: Kept,
    /// Found when it is first asked for, like what follows.
    pub(crate) frames: Option<Frames>,
    pub(crate) stance: Option<Stance>,
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
        Ok(Self::of(Layer::file(path)?))
    }

    /// Opens a layer.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn new(from: impl Source + 'static) -> Result<Self, Problem> {
        Ok(Self::of(Layer::open(Box::new(from))?))
    }

    fn of(layer: Layer) -> Self {
        Self { layer, kept: Kept::default(), frames: None, stance: None }
    }

    fn z_up(&mut self) -> Result<Option<bool>, Problem> {
        let Some(handle) = self.layer.metadata.get("upAxis").copied() else { return Ok(None) };
        let axis = self.layer.words(handle)?.into_iter().next().unwrap_or_default();
        match axis.as_str() {
            "Y" | "y" => Ok(Some(false)),
            "Z" | "z" => Ok(Some(true)),
            _ => Err(Problem(format!("upAxis = \"{axis}\": must be \"Y\" or \"Z\""))),
        }
    }

    /// The curves of a prim in a frame, whose points are given.
    fn curves(
        &mut self,
        prim: usize,
        InPose { points, is_bound, said, .. }: InPose,
        frame: usize,
        segments: Option<usize>,
        attributes: bool,
    ) -> Result<Hair, Problem> {
        let time = self.code_of(frame)?;
        let layer = &mut self.layer;
        let counts = layer.at(prim, "curveVertexCounts", time);
        let counts = layer.integers(counts.ok_or_else(|| Problem::new("have no curveVertexCounts"))?)?;
        let counts = checked_counts(&counts, points.len())?;
        let Course { basis, pinned } = course(layer, prim)?;
        let lines = Shape { counts, basis, pinned }.walk(points, segments)?;
        if !attributes {
            return Ok(Hair::from(lines.strands));
        }
        let mut primvars = Primvars { layer: &mut self.layer, prim, time, frame, is_bound };
        let mut attributes = lines.attributes(&mut primvars)?;
        attributes.unread.extend(primvars.unread()?);
        attributes.unread.extend(transform::not_there(&mut self.layer, prim)?);
        attributes.unread.extend(said);
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
            return Problem(format!("has no BasisCurves except {prototypes}"));
        }
        let is_over = |&i: &usize| self.layer.prims[i].type_name == "BasisCurves" && self.layer.is_active(i);
        if let Some(over) = (0..self.layer.prims.len()).find(is_over) {
            let path = self.layer.path(over);
            return Problem(if arcs::has_instances(&self.layer) {
                format!(
                    "curves {path}: are a prototype of instances: turn off instanceable on the instances, then flatten the \
                     layer (usdcat --flatten IN -o OUT)"
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
            // A mesh that is bound goes with its joint, which often has its name, and not with its prim.
            let path = self.layer.path(prim);
            let bound = self.layer.prims[prim].type_name == "Mesh" && Skin::of(&mut self.layer, prim)?.is_some();
            let joint = if bound { self.carrying_joint(&|mesh| mesh == path)? } else { None };
            return Ok(match joint.map(|joint| skeleton::joint(&mut self.layer, &joint)).transpose()?.flatten() {
                Some(joint) => Mover::Joint(joint),
                None => Mover::Prim(prim),
            });
        }
        match skeleton::joint(&mut self.layer, node)? {
            Some(joint) => Ok(Mover::Joint(joint)),
            None => Err(Problem(format!("has no prim or joint {node}: node can be {}", self.movers()?.join(", ")))),
        }
    }

    /// The texture coordinates of a mesh, if it has any, or why they are none.
    fn texture_coordinates(
        &mut self,
        prim: usize,
        time: f64,
    ) -> Result<std::result::Result<Option<Uvs>, String>, Problem> {
        const NAME: &str = "primvars:st";
        if self.layer.at(prim, NAME, time).is_none() {
            return Ok(Ok(None));
        }
        let of = match self.layer.interpolation(prim, NAME)?.as_deref() {
            Some("faceVarying") => Uvs::OfCorners,
            Some("vertex" | "varying") => Uvs::OfVertices,
            Some("uniform") => return Ok(Err("they belong to faces, not to points".to_owned())),
            _ => return Ok(Err("they are one pair for all points".to_owned())),
        };
        let type_name = self.layer.prims[prim].attributes[NAME].type_name.clone();
        let mut primvars = Primvars { layer: &mut self.layer, prim, time, frame: 0, is_bound: false };
        if let Some(why) = primvars.misindexed("st")? {
            return Ok(Err(why.to_owned()));
        }
        let uvs = primvars.tuples::<2>("st")?;
        Ok(uvs.map(|uvs| Some(of(uvs))).ok_or_else(|| format!("they are not pairs of numbers ({type_name})")))
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

/// Points of a prim where they hang on joints, if they do.
pub(crate) struct InPose {
    pub points: Vec<Vec3>,
    /// Takes them to the world.
    pub world: DMat4,
    /// Whether they do.
    is_bound: bool,
    /// What is said of how they do.
    said: Option<String>,
}

/// Points of a prim, as its skeleton has them if it is bound to one.
pub(crate) fn in_place(
    layer: &mut Layer,
    prim: usize,
    mut points: Vec<Vec3>,
    stance: Stance,
    time: f64,
) -> Result<InPose, Problem> {
    if stance == Stance::First
        && let Some(shapes) = BlendShapes::of(layer, prim)?
    {
        shapes.blend(layer, &mut points, time)?;
    }
    match Skin::of(layer, prim)?.filter(|skin| skin.fits(points.len())) {
        None => Ok(InPose { points, world: transform::world(layer, prim, time)?, is_bound: false, said: None }),
        Some(skin) => {
            skin.place(layer, &mut points, stance, time)?;
            let said = skin.unblended(&layer.path(prim));
            Ok(InPose { points, world: skin.world(layer, time)?, is_bound: true, said })
        }
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
        (order, basis) => Err(Problem(format!("are {order} with basis {basis}, which USD does not have"))),
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
        let frames = self.frames()?.clone();
        let codes_a_second = self.codes_a_second()?;
        // Curves that move begin with the hair that is read first, whatever of the stage comes before or after.
        let start = match frames.times[..] {
            [first, ..] if frames.step > 0.0 => Some(first),
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
                        (false, _) => "inactive or in a class",
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
                    let skin = Skin::of(&mut self.layer, i)?;
                    let bound = skin.is_some();
                    let world = match skin {
                        Some(skin) => skin.world(&mut self.layer, time)?,
                        None => transform::world(&mut self.layer, i, time)?,
                    };
                    let world = DAffine3::from_mat4(world);
                    PrimKind::Curves { curves, points: self.point_count(i)?, course, world_from_curves: world, bound }
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
            let relationships: Vec<String> = self.layer.prims[i].related().map(|name| name.to_string()).collect();
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
        if self.layer.with_points("BasisCurves").is_empty() {
            return Err(self.no_curves());
        }
        let (prims, closed) = self.open_curves()?;
        closed.check(prims.len())?;
        let time = self.code_of(frame)?;
        let mut all = Gathered::default();
        for (group, &prim) in prims.iter().enumerate() {
            let path = self.layer.path(prim);
            let named = |e: Problem| Problem(format!("curves {path}: {e}"));
            let points = self
                .layer
                .points_at(prim, "points", time)
                .and_then(|points| points.ok_or_else(|| Problem::new("have no points")));
            // Curves that are bound are where the stage has them in every frame.
            let posed = in_place(&mut self.layer, prim, points.map_err(named)?, Stance::First, time)?;
            let world = DAffine3::from_mat4(posed.world);
            let part = self.curves(prim, posed, frame, segments, attributes).map_err(named)?;
            let name = self.layer.prims[prim].name.to_string();
            all.append(part, world, (prims.len() > 1).then_some((group as i32, name)))?;
        }
        let mut placed = all.hair()?;
        if attributes {
            let codes_a_second = self.codes_a_second()?;
            let unread = &mut placed.hair.attributes.unread;
            unread.extend(self.frames()?.unread(codes_a_second));
            unread.extend(self.layer.without_points("BasisCurves", "curves"));
            unread.extend(closed.unread());
            unread.extend(self.other_curves().iter().filter_map(|others| others.unread(READ)));
            unread.extend(instances::unread(&self.layer, "BasisCurves", &|_| true));
            unread.extend(arcs::unread(&mut self.layer)?);
        }
        Ok(placed)
    }

    fn meshes_with_losses(&mut self, wanted: &dyn Fn(&str) -> bool) -> Result<(Mesh, Vec<String>), Problem> {
        self.layer.budget.next_question();
        let (mut mesh, mut lost) = (Mesh::default(), Vec::new());
        let (time, stance) = (self.code_of(0)?, self.stance()?);
        for prim in meshes::chosen(&mut self.layer, wanted, stance)?.prims {
            let path = self.layer.path(prim);
            let problem = |what: &str| Problem(format!("mesh {path}: {what}"));
            let layer = &mut self.layer;
            let points: Vec<Vec3> = layer.points_at(prim, "points", time)?.ok_or_else(|| problem("has no points"))?;
            let InPose { points, world, .. } = in_place(layer, prim, points, stance, time)?;
            let counts = layer.at(prim, "faceVertexCounts", time).ok_or_else(|| problem("has no faces"))?;
            let counts = layer.integers(counts)?;
            let corners = layer.at(prim, "faceVertexIndices", time).ok_or_else(|| problem("has no faces"))?;
            let corners = layer.integers(corners)?;
            let clockwise = layer.word(prim, "orientation")?.as_deref() == Some("leftHanded");
            let world = Affine3A::from_mat4(world.as_mat4());
            let (uvs, none) = match self.texture_coordinates(prim, time)? {
                Ok(uvs) => (uvs, None),
                Err(why) => (None, Some(why)),
            };
            let polygons = Polygons { positions: &points, counts: &counts, corners: &corners, clockwise, uvs };
            let first = mesh.positions.len();
            let misfit = add_polygons(&mut mesh, polygons, &world).map_err(|e| problem(&e.0))?;
            lost.extend(none.or(misfit).map(|why| format!("texture coordinates of {path}: {why}")));
            let canvas = Canvas { vertices: points.len(), corners: &corners };
            lost.extend(painted::add(&mut self.layer, prim, time, canvas, (&mut mesh, first)));
        }
        match mesh.positions.iter().find(|p| !p.is_finite()) {
            Some(p) => Err(Problem(format!("has a vertex at {p}, which is not finite"))),
            None if mesh.triangles.is_empty() => match arcs::unread(&mut self.layer)? {
                Some(_) => {
                    Err(Problem(format!("has no meshes: if they come by reference, {}", arcs::way_out(&self.layer))))
                }
                None => match instances::unread(&self.layer, "Mesh", wanted).first() {
                    Some(prototypes) => Err(Problem(format!("has no meshes except {prototypes}"))),
                    None => Err(Problem::new("has no meshes")),
                },
            },
            None => Ok((mesh, lost)),
        }
    }

    fn meshes_unread(&mut self, wanted: &dyn Fn(&str) -> bool) -> Result<Vec<String>, Problem> {
        self.layer.budget.next_question();
        let stance = self.stance()?;
        let mut unread = meshes::chosen(&mut self.layer, wanted, stance)?.unread;
        unread.extend(arcs::unread(&mut self.layer)?);
        Ok(unread)
    }

    fn motion(&mut self, node: &str) -> Result<Vec<Placed>, Problem> {
        self.layer.budget.next_question();
        let rate = self.codes_a_second()?;
        let mover = self.mover(node)?;
        let mut times = match &mover {
            Mover::Prim(prim) => {
                // A mesh that only bends moves as long as that lasts.
                let (path, mut times) = (self.layer.path(*prim), transform::times(&self.layer, *prim));
                times.extend(self.bending_codes(&|mesh| mesh == path)?);
                times
            }
            Mover::Joint(joint) => joint.times(&self.layer),
        };
        times.sort_by(f64::total_cmp);
        times.dedup();
        // Between two keys each operation goes its own way, a parent's turn about another: whole codes follow it.
        if let [first, .., last] = times[..] {
            if last - first > MOST_FRAMES as f64 {
                return Err(Problem(format!(
                    "{node}: moves from time code {first} to {last}, longer than nabiki reads"
                )));
            }
            times.extend((first.ceil() as i64..=last.floor() as i64).map(|code| code as f64));
            times.sort_by(f64::total_cmp);
            times.dedup_by(|a, b| (*a - *b).abs() <= SAME_TIME);
        }
        if times.len() > MOST_FRAMES {
            return Err(Problem(format!("{node}: moves at {} time codes, more than nabiki reads", times.len())));
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

    fn bending_times(&mut self, wanted: &dyn Fn(&str) -> bool) -> Result<Vec<f64>, Problem> {
        self.layer.budget.next_question();
        let rate = self.codes_a_second()?;
        Ok(self.bending_codes(wanted)?.into_iter().map(|code| code / rate).collect())
    }

    fn bent_meshes(&mut self, wanted: &dyn Fn(&str) -> bool, time: f64) -> Result<Vec<Vec3>, Problem> {
        self.layer.budget.next_question();
        let code = time * self.codes_a_second()?;
        // Times are quotients of codes: a sample at this one is meant.
        let whole = code.round();
        self.bent_at(wanted, if (code - whole).abs() < 1e-6 { whole } else { code })
    }

    fn joint_of_meshes(&mut self, wanted: &dyn Fn(&str) -> bool) -> Result<Option<String>, Problem> {
        self.carrying_joint(wanted)
    }

    fn bound(&mut self, node: &str) -> Result<Option<Placed>, Problem> {
        self.layer.budget.next_question();
        let bound = match self.mover(node)? {
            Mover::Prim(_) => None,
            Mover::Joint(joint) => {
                let (time, stance) = (self.code_of(0)?, self.stance()?);
                match stance {
                    Stance::First => Some(joint.world(&mut self.layer, time)?),
                    Stance::Bound => joint.bound(&mut self.layer, time)?,
                }
            }
        };
        match bound {
            Some(world) if !(world.is_finite() && world.determinant().abs() > 0.0) => {
                Err(Problem(format!("{node}: its bind transform flattens space")))
            }
            bound => Ok(bound.map(|world| Placed::of(0.0, &world))),
        }
    }
}
