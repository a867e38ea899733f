//! Hair, heads and their motion out of an archive.

use std::collections::HashMap;
use std::fs::File;
use std::io::{Read, Seek};
use std::path::Path;

use glam::{DAffine3, DMat4, DVec3, Vec3};
use nabiki::Mesh;
use nabiki_exchange::{
    Contents, Frames, Gathered, GroomReader, InPlace, Kept, MOST_FRAMES, Placed, Prim, PrimKind, Window,
};

use crate::Problem;
use crate::schemas::{NURBS_SURFACE, POINTS, READ, is_mesh};
use crate::tree::{Header, PropertyKind, SAME_TIME, Timing, Tree};
use crate::values::doubles;

/// Steps of samples that differ by less than this, as a share of a frame, from a frame are frames: files round their times.
const SAME_FRAME: f64 = 1e-3;
/// Frames a second where an archive does not say.
const DEFAULT_RATE: f64 = 24.0;

/// What a transform counts for in the budget of its file.
const A_TRANSFORM: u64 = 32;

/// An archive to read hair, heads and motion from. Alembic names no unit, and y is up.
pub struct ArchiveReader<R = Window<File>> {
    pub(crate) tree: Tree<R>,
    pub(crate) kept: Kept,
    /// The frames, once they have been asked for (s).
    frames: Option<Frames>,
    /// The values of transforms that move, of the objects that were asked.
    moving: HashMap<usize, Option<Header>>,
}

impl ArchiveReader<Window<File>> {
    /// Opens the archive at `path`.
    ///
    /// # Errors
    /// What is wrong with it, without its name.
    pub fn open(path: &Path) -> Result<Self, Problem> {
        Self::new(Window::new(File::open(path)?)?)
    }
}

impl<R: Read + Seek> ArchiveReader<R> {
    /// Opens an archive.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn new(from: R) -> Result<Self, Problem> {
        Ok(Self { tree: Tree::new(from)?, kept: Kept::default(), frames: None, moving: HashMap::new() })
    }

    /// The properties of an object's schema.
    pub(crate) fn schema(&mut self, object: usize) -> Result<Vec<Header>, Problem> {
        let properties = self.tree.properties_of(object)?;
        match properties.iter().find(|h| h.form == PropertyKind::Compound && matches!(&*h.name, ".geom" | ".xform")) {
            Some(header) => self.tree.properties(header.place),
            None => Err(Problem(format!("object {}: its schema is empty", self.tree.path(object)))),
        }
    }

    /// The product of all transforms from the top down to `object` at `time` (s).
    pub(crate) fn world(&mut self, object: usize, time: f64) -> Result<DMat4, Problem> {
        // Many objects stand below the same ones.
        if self.tree.worlds.0 != time {
            self.tree.worlds = (time, HashMap::new());
        }
        let mut world = DMat4::IDENTITY;
        let mut locals: Vec<(usize, DMat4)> = Vec::new();
        let mut above = Some(object);
        while let Some(i) = above {
            if let Some(&known) = self.tree.worlds.1.get(&i) {
                world = known;
                break;
            }
            let is_transform = self.tree.objects[i].is("AbcGeom_Xform");
            let (local, inherits) = if is_transform { self.local(i, time)? } else { (DMat4::IDENTITY, true) };
            locals.push((i, local));
            if !inherits {
                break;
            }
            above = self.tree.objects[i].parent;
        }
        for (i, local) in locals.into_iter().rev() {
            world *= local;
            self.tree.worlds.1.insert(i, world);
        }
        Ok(world)
    }

    /// A transform, and whether those above it count. The numbers of its operations are interpolated between samples.
    fn local(&mut self, object: usize, time: f64) -> Result<(DMat4, bool), Problem> {
        let inside = self.schema(object)?;
        let mut numbers = |name: &str, between: bool| -> Result<Vec<f64>, Problem> {
            let Some(header) = inside.iter().find(|h| &*h.name == name) else { return Ok(Vec::new()) };
            let (low, share) = self.tree.timings[header.timing].at(time, header.samples);
            let mut numbers = doubles(header.kind, &self.tree.sample(header, low)?)?;
            if between && share > 0.0 {
                let next = doubles(header.kind, &self.tree.sample(header, low + 1)?)?;
                if next.len() == numbers.len() {
                    numbers.iter_mut().zip(next).for_each(|(a, b)| *a = (1.0 - share) * *a + share * b);
                }
            }
            Ok(numbers)
        };
        let inherits = numbers(".inherits", false)?.first().is_none_or(|&x| x != 0.0);
        let (operations, values) = (numbers(".ops", false)?, numbers(".vals", true)?);
        let mut values = &values[..];
        let mut local = DMat4::IDENTITY;
        for operation in operations {
            // Each is looked up and multiplied at every time.
            self.tree.budget().take(A_TRANSFORM, "transforms")?;
            let kind = operation as u8 >> 4;
            let needed = match kind {
                0 | 1 => 3,
                2 => 4,
                3 => 16,
                4..=6 => 1,
                _ => return Err(Problem(format!("transform of unknown kind {kind}"))),
            };
            let path = &self.tree.path(object);
            let (v, rest) = values
                .split_at_checked(needed)
                .ok_or_else(|| Problem(format!("transform {path}: fewer numbers than it needs")))?;
            values = rest;
            local *= match kind {
                0 => DMat4::from_scale(DVec3::new(v[0], v[1], v[2])),
                1 => DMat4::from_translation(DVec3::new(v[0], v[1], v[2])),
                2 => {
                    let axis = DVec3::new(v[0], v[1], v[2]).try_normalize().unwrap_or(DVec3::X);
                    DMat4::from_axis_angle(axis, v[3].to_radians())
                }
                3 => DMat4::from_cols_array(v.try_into().expect("sixteen numbers")),
                4 => DMat4::from_rotation_x(v[0].to_radians()),
                5 => DMat4::from_rotation_y(v[0].to_radians()),
                _ => DMat4::from_rotation_z(v[0].to_radians()),
            };
        }
        Ok((local, inherits))
    }

    /// Paths of what can move a head, transforms that move first.
    fn movers(&mut self) -> Result<Vec<String>, Problem> {
        const MOST_NAMED: usize = 40;
        const MOST_LETTERS: usize = 4000;
        let (mut moving, mut still) = (Vec::new(), Vec::new());
        for i in 1..self.tree.objects.len() {
            let moves = self.moving(i)?.is_some();
            let list = if moves { &mut moving } else { &mut still };
            list.push(self.tree.path(i));
        }
        moving.extend(still);
        moving.truncate(MOST_NAMED);
        // A line that can be read, however long the paths are.
        let mut letters = 0;
        moving.retain(|path| {
            letters += path.len();
            letters <= MOST_LETTERS
        });
        Ok(moving)
    }

    /// The frames (s): the samples of the curves with the most, or of what moves them whole. Samples at uneven times, and
    /// those of a shutter, give way to the whole frames, between which there is interpolation.
    fn frames(&mut self) -> Result<&Frames, Problem> {
        if self.frames.is_none() {
            self.frames = Some(self.find_frames()?);
        }
        Ok(self.frames.as_ref().expect("found above"))
    }

    fn find_frames(&mut self) -> Result<Frames, Problem> {
        let mut most = Motion::default();
        for object in self.of_schema("AbcGeom_Curve") {
            let inside = self.schema(object)?;
            let header = required(&inside, "P", &self.tree.path(object))?;
            if header.samples > MOST_FRAMES {
                return Err(Problem(format!("its curves have {} samples, more than nabiki reads", header.samples)));
            }
            if header.samples == 0 {
                continue;
            }
            // Not more than there are already.
            if header.samples > 1 && header.samples <= most.times.len() {
                continue;
            }
            self.tree.budget().take_list::<f64>(header.samples, "times of samples")?;
            let mut motion = Motion::default();
            motion.add(&self.tree.timings[header.timing], header.samples);
            if motion.times.len() < 2 {
                let above = self.above(object)?;
                motion = if above.times.len() > 1 { above } else { motion };
            }
            if motion.times.len() > most.times.len() {
                most = motion;
            }
        }
        // Of samples that follow each other within a frame of the archive's own rate, several make one, too.
        let stated = self.tree.frame_rate.map(|rate| 1.0 / rate);
        let as_sampled = Frames::as_sampled(&most.times).filter(|frames| {
            let within = stated.is_some_and(|frame| most.times.len() > 1 && frames.step < frame * (1.0 - SAME_FRAME));
            !(most.shutter || within)
        });
        let own = most.period.filter(|_| most.shutter);
        let period = own.or(stated).or(most.period).unwrap_or(1.0 / DEFAULT_RATE);
        as_sampled.or_else(|| Frames::whole(&most.times, period)).ok_or_else(|| {
            let [first, last] = [most.times[0], most.times[most.times.len() - 1]];
            Problem(format!("its curves move from {first} s to {last} s, longer than nabiki reads"))
        })
    }

    /// When a frame is (s); the last after those there are.
    fn time_of(&mut self, frame: usize) -> Result<f64, Problem> {
        let times = &self.frames()?.times;
        Ok(times.get(frame).or(times.last()).copied().unwrap_or(0.0))
    }

    /// The objects of a schema.
    pub(crate) fn of_schema(&self, schema: &str) -> Vec<usize> {
        (0..self.tree.objects.len()).filter(|&i| self.tree.objects[i].is(schema)).collect()
    }

    /// The values of the transform `object`, if it is one that moves.
    fn moving(&mut self, object: usize) -> Result<Option<Header>, Problem> {
        if !self.tree.objects[object].is("AbcGeom_Xform") {
            return Ok(None);
        }
        if let Some(known) = self.moving.get(&object) {
            return Ok(known.clone());
        }
        let inside = self.schema(object)?;
        let found = inside.into_iter().find(|h| &*h.name == ".vals" && h.different_samples() > 1);
        self.tree.budget().keep(size_of::<Header>() as u64, "objects")?;
        self.moving.insert(object, found.clone());
        Ok(found)
    }

    /// How `object` and those above it move.
    fn above(&mut self, object: usize) -> Result<Motion, Problem> {
        let mut motion = Motion::default();
        let mut above = Some(object);
        while let Some(i) = above {
            if let Some(values) = self.moving(i)? {
                let samples = values.different_samples();
                if samples + motion.times.len() > MOST_FRAMES {
                    let path = &self.tree.path(i);
                    return Err(Problem(format!(
                        "object {path}: moves over {samples} samples, more than nabiki reads"
                    )));
                }
                self.tree.budget().take_list::<f64>(samples, "times of samples")?;
                motion.add(&self.tree.timings[values.timing], samples);
            }
            above = self.tree.objects[i].parent;
        }
        motion.times.sort_by(f64::total_cmp);
        motion.times.dedup_by(|b, a| *b - *a <= SAME_TIME);
        if motion.times.is_empty() {
            motion.times.push(0.0);
        }
        Ok(motion)
    }

    /// Values of an array property in its first sample.
    pub(crate) fn count(&mut self, header: Option<&Header>) -> Result<usize, Problem> {
        let Some(header) = header else { return Ok(0) };
        let size = header.kind.pod.size() * usize::from(header.kind.extent);
        Ok(self.tree.sample_length(header, 0)? / size)
    }
}

impl<R: Read + Seek> GroomReader for ArchiveReader<R> {
    fn contents(&mut self) -> Result<Contents, Problem> {
        self.tree.budget().next_question();
        let (curves, meshes) = (self.open_curves()?.0, self.all_meshes());
        let paths = |of: Vec<usize>| of.into_iter().map(|i| self.tree.path(i)).collect();
        let mut contents = Contents {
            curves: paths(curves),
            meshes: paths(meshes),
            // One frame has no step from which it could be told.
            frame_rate: self.tree.frame_rate.unwrap_or(DEFAULT_RATE),
            z_up: Some(false),
            ..Contents::default()
        };
        let frames = self.frames()?;
        if frames.step > 0.0 {
            contents.frame_rate = frames.rate(1.0);
        }
        contents.times.clone_from(&frames.times);
        contents.start = contents.times.first().copied();
        Ok(contents)
    }

    fn prims(&mut self) -> Result<Vec<Prim>, Problem> {
        self.tree.budget().next_question();
        let mut prims = Vec::new();
        for i in 1..self.tree.objects.len() {
            let path = self.tree.path(i);
            self.tree.budget().take((size_of::<Prim>() + path.len()) as u64, "objects")?;
            let object = &self.tree.objects[i];
            let known = ["AbcGeom_Curve", "AbcGeom_Xform"].into_iter().find(|s| object.is(s));
            let Some(schema) = known.or(is_mesh(object).then_some("")) else {
                let known = object.metadata.split(';').find_map(|entry| entry.strip_prefix("schema="));
                let kind = PrimKind::Other(known.unwrap_or_default().to_owned());
                prims.push(Prim { path, kind, samples: 0, relationships: Vec::new() });
                continue;
            };
            let inside = self.schema(i)?;
            let named = |name: &str| inside.iter().find(|h| &*h.name == name && h.form != PropertyKind::Compound);
            let samples = |name: &str| named(name).map_or(0, Header::different_samples);
            prims.push(match schema {
                "AbcGeom_Xform" => {
                    Prim { path, kind: PrimKind::Transform, samples: samples(".vals"), relationships: Vec::new() }
                }
                "AbcGeom_Curve" if self.are_closed(i)? => {
                    let kind = PrimKind::Other("curves (closed)".to_owned());
                    Prim { path, kind, samples: samples("P"), relationships: Vec::new() }
                }
                "AbcGeom_Curve" => {
                    let (curves, points) = (self.count(named("nVertices"))?, self.count(named("P"))?);
                    let course = self.course(&inside)?;
                    let time = self.time_of(0)?;
                    let world_from_curves = DAffine3::from_mat4(self.world(i, time)?);
                    Prim {
                        path,
                        kind: PrimKind::Curves { curves, points, course, world_from_curves, bound: false },
                        samples: samples("P"),
                        relationships: Vec::new(),
                    }
                }
                _ => {
                    let (faces, points) = (self.count(named(".faceCounts"))?, self.count(named("P"))?);
                    Prim {
                        path,
                        kind: PrimKind::Mesh { faces, points },
                        samples: samples("P"),
                        relationships: Vec::new(),
                    }
                }
            });
        }
        Ok(prims)
    }

    fn keep_curves(&mut self, paths: Vec<String>) {
        self.kept = Kept::only(paths);
    }

    fn hair_in_place(&mut self, frame: usize, segments: Option<usize>, attributes: bool) -> Result<InPlace, Problem> {
        self.tree.budget().next_question();
        if self.of_schema("AbcGeom_Curve").is_empty() {
            let points = self.left_out(POINTS, &|_| true);
            return Err(points.refused("curves").unwrap_or_else(|| Problem::new("has no curves")));
        }
        let (objects, closed) = self.open_curves()?;
        closed.check(objects.len())?;
        let time = self.time_of(frame)?;
        let mut all = Gathered::default();
        for (group, &object) in objects.iter().enumerate() {
            let path = self.tree.path(object);
            let name = path.rsplit('/').next().unwrap_or_default().to_owned();
            let part = self.curves(object, time, segments, attributes);
            let (hair, world) = part.map_err(|e| Problem(format!("curves {path}: {e}")))?;
            all.append(hair, world, (objects.len() > 1).then_some((group as i32, name)))?;
        }
        let mut all = all.hair()?;
        if attributes {
            all.hair.attributes.unread.extend(self.frames()?.unread(1.0));
            all.hair.attributes.unread.extend(closed.unread());
            let left_out = [POINTS, NURBS_SURFACE].map(|schema| self.left_out(schema, &|_| true));
            all.hair.attributes.unread.extend(left_out.iter().filter_map(|objects| objects.unread(READ)));
        }
        Ok(all)
    }

    fn meshes_with_losses(&mut self, wanted: &dyn Fn(&str) -> bool) -> Result<(Mesh, Vec<String>), Problem> {
        self.tree.budget().next_question();
        let (mut mesh, mut lost) = (Mesh::default(), Vec::new());
        // Where the head stands as the hair's first frame finds it.
        let time = self.time_of(0)?;
        for object in self.chosen_meshes(wanted)?.objects {
            lost.extend(self.add_mesh(&mut mesh, object, time)?);
        }
        match mesh.positions.iter().find(|p| !p.is_finite()) {
            Some(p) => Err(Problem(format!("has a vertex at {p}, which is not finite"))),
            None if mesh.triangles.is_empty() => {
                let surfaces = self.left_out(NURBS_SURFACE, wanted);
                Err(surfaces.refused("meshes of polygons").unwrap_or_else(|| Problem::new("has no polygons")))
            }
            None => Ok((mesh, lost)),
        }
    }

    fn meshes_unread(&mut self, wanted: &dyn Fn(&str) -> bool) -> Result<Vec<String>, Problem> {
        self.tree.budget().next_question();
        Ok(self.chosen_meshes(wanted)?.unread)
    }

    fn motion(&mut self, node: &str) -> Result<Vec<Placed>, Problem> {
        self.tree.budget().next_question();
        // The topmost has no name.
        let named = |i: &usize| {
            let name = &self.tree.objects[*i].name;
            name.eq_ignore_ascii_case(node)
                || (node.starts_with('/') && node.ends_with(&**name) && self.tree.path(*i) == node)
        };
        let Some(object) = (1..self.tree.objects.len()).find(named) else {
            return Err(Problem(format!("has no object {node}: node can be {}", self.movers()?.join(", "))));
        };
        let mut times = self.above(object)?.times;
        if times.len() < 2 {
            // A mesh that only bends moves as long as that lasts.
            let path = self.tree.path(object);
            let bends = self.times_of_points(&|mesh| mesh == path)?;
            times = if bends.is_empty() { times } else { bends };
        }
        let mut motion = Vec::with_capacity(times.len());
        for time in times {
            self.tree.budget().next_moment()?;
            let world = self.world(object, time)?;
            if !(world.is_finite() && world.determinant().abs() > 0.0) {
                return Err(Problem(format!("object {node}: its transform at {time} s flattens space")));
            }
            motion.push(Placed::of(time, &world));
        }
        Ok(motion)
    }

    fn bending_times(&mut self, wanted: &dyn Fn(&str) -> bool) -> Result<Vec<f64>, Problem> {
        self.tree.budget().next_question();
        self.times_of_points(wanted)
    }

    fn bent_meshes(&mut self, wanted: &dyn Fn(&str) -> bool, time: f64) -> Result<Vec<Vec3>, Problem> {
        self.tree.budget().next_question();
        self.vertices_at(wanted, time)
    }
}

/// When something moves.
#[derive(Default)]
struct Motion {
    /// Times of its samples (s).
    times: Vec<f64>,
    /// The shortest cycle in which they repeat (s), where they do.
    period: Option<f64>,
    /// Whether a cycle has several samples, as motion blur wants them.
    shutter: bool,
}

impl Motion {
    fn add(&mut self, timing: &Timing, samples: usize) {
        self.times.extend((0..samples).map(|n| timing.time(n)));
        if let Some(period) = timing.cycle() {
            self.period = Some(self.period.map_or(period, |shortest| shortest.min(period)));
            self.shutter |= timing.times.len() > 1;
        }
    }
}

pub(crate) fn required<'a>(headers: &'a [Header], name: &str, path: &str) -> Result<&'a Header, Problem> {
    let found = headers.iter().find(|h| &*h.name == name && h.form != PropertyKind::Compound);
    found.ok_or_else(|| Problem(format!("{path} has no property {name}")))
}

/// Moves points a share of the way to those of the next sample.
pub(crate) fn go_toward(points: &mut [Vec3], next: &[Vec3], share: f64) {
    points.iter_mut().zip(next).for_each(|(point, &next)| *point = point.lerp(next, share as f32));
}
