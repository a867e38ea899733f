//! Hair, heads and their motion out of an archive.

use std::fs::File;
use std::io::{Read, Seek};
use std::path::Path;

use glam::{Affine3A, DMat4, DQuat, DVec3, Vec3};
use nabiki::curves::{Basis, Gathered, Shape, checked_counts};
use nabiki::{Hair, Mesh};

use crate::Problem;
use crate::attributes::Parameters;
use crate::tree::{Form, Header, Tree};
use crate::values::{doubles, integers, singles};

/// Samples of a motion that are read at most: three hours of frames.
const MOST_SAMPLES: usize = 1 << 18;

/// An archive to read hair, heads and motion from; everything comes in the archive's own unit, y up.
pub struct ArchiveReader<R = File> {
    tree: Tree<R>,
}

/// What an archive holds.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Contents {
    /// Objects with curves: path, number of samples.
    pub curves: Vec<(String, usize)>,
    /// Objects with meshes.
    pub meshes: Vec<String>,
    /// Transforms: path, number of samples.
    pub transforms: Vec<(String, usize)>,
    /// Samples of the curves with the most: frames.
    pub frames: usize,
    /// Time of the first of them (s).
    pub start: f64,
    /// Frames a second, from the first two; 0 where there is one only.
    pub frame_rate: f64,
}

impl ArchiveReader<File> {
    /// Opens the archive at `path`.
    ///
    /// # Errors
    /// What is wrong with it, without its name.
    pub fn open(path: &Path) -> Result<Self, Problem> {
        Self::new(File::open(path)?)
    }
}

impl<R: Read + Seek> ArchiveReader<R> {
    /// Opens an archive.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn new(from: R) -> Result<Self, Problem> {
        Ok(Self { tree: Tree::new(from)? })
    }

    /// Lists what is in the archive.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn contents(&mut self) -> Result<Contents, Problem> {
        let mut contents = Contents::default();
        for i in 0..self.tree.objects.len() {
            let path = self.tree.objects[i].path.clone();
            if self.tree.objects[i].is("AbcGeom_Curve") {
                let inside = self.schema(i)?;
                let header = required(&inside, "P", &path)?;
                if header.samples > contents.frames {
                    let timing = &self.tree.timings[header.timing];
                    contents.frames = header.samples;
                    contents.start = timing.time(0);
                    let step = timing.time(1) - timing.time(0);
                    contents.frame_rate = if header.samples > 1 && step > 0.0 { 1.0 / step } else { 0.0 };
                }
                contents.curves.push((path, header.samples));
            } else if self.tree.objects[i].is("AbcGeom_PolyMesh") {
                contents.meshes.push(path);
            } else if self.tree.objects[i].is("AbcGeom_Xform") {
                let inside = self.schema(i)?;
                let samples = inside.iter().find(|h| h.name == ".vals").map_or(1, |h| h.samples);
                contents.transforms.push((path, samples));
            }
        }
        Ok(contents)
    }

    /// All curves at sample `frame` (the nearest each has), one after another, with the transforms above them.
    ///
    /// `segments`: walks every curve into as many; `None` keeps polylines as they are. Curves in several objects
    /// that have no groups of their own are grouped by object, under its name.
    ///
    /// # Errors
    /// No curves, curves that are periodic or of mixed order, numbers that contradict each other or are not finite.
    pub fn hair(&mut self, frame: usize, segments: Option<usize>) -> Result<Hair, Problem> {
        let objects: Vec<usize> =
            (0..self.tree.objects.len()).filter(|&i| self.tree.objects[i].is("AbcGeom_Curve")).collect();
        if objects.is_empty() {
            return Err(Problem::new("has no curves"));
        }
        let mut all = Gathered::default();
        for (group, &object) in objects.iter().enumerate() {
            let path = self.tree.objects[object].path.clone();
            let name = path.rsplit('/').next().unwrap_or_default().to_owned();
            let part = self.curves(object, frame, segments).map_err(|e| Problem(format!("curves {path}: {e}")))?;
            all.append(part, (objects.len() > 1).then_some((group as i32, name)));
        }
        all.hair()
    }

    fn curves(&mut self, object: usize, frame: usize, segments: Option<usize>) -> Result<Hair, Problem> {
        let inside = self.schema(object)?;
        let positions = required(&inside, "P", "")?;
        let time = self.tree.timings[positions.timing].time(frame.min(positions.samples.saturating_sub(1)));
        let points = self.tree.points(positions, frame)?;
        let counts = required(&inside, "nVertices", "")?;
        let counts = integers(counts.kind, &self.tree.sample(counts, frame)?)?;
        let counts = checked_counts(&counts, points.len())?;
        let basis = match inside.iter().find(|h| h.name == "curveBasisAndType") {
            Some(header) => basis(&self.tree.sample(header, frame)?)?,
            None => return Err(Problem::new("do not say whether they are straight or cubic")),
        };
        let walked = Shape { counts, basis, pinned: false }.walk(points, segments)?;
        let attributes = walked.attributes(&mut Parameters::of(&mut self.tree, inside, frame)?)?;
        let hair = Hair { strands: walked.strands, attributes };
        let world = self.world(object, time)?;
        Ok(if world == DMat4::IDENTITY { hair } else { hair.transformed(&Affine3A::from_mat4(world.as_mat4())) })
    }

    /// All polygon meshes at their first sample, cut into triangles, with the transforms above them, as one.
    ///
    /// # Errors
    /// No mesh, or one whose numbers contradict each other.
    pub fn mesh(&mut self) -> Result<Mesh, Problem> {
        let mut mesh = Mesh::default();
        for object in 0..self.tree.objects.len() {
            if !self.tree.objects[object].is("AbcGeom_PolyMesh") {
                continue;
            }
            let path = self.tree.objects[object].path.clone();
            let inside = self.schema(object)?;
            let world = self.world(object, 0.0)?;
            let mut numbers = |name: &str| -> Result<(&Header, Vec<u8>), Problem> {
                let header = required(&inside, name, &path)?;
                let bytes = self.tree.sample(header, 0)?;
                Ok((header, bytes))
            };
            let (header, bytes) = numbers("P")?;
            let positions = singles(header.kind, &bytes)?;
            let (header, bytes) = numbers(".faceCounts")?;
            let counts = integers(header.kind, &bytes)?;
            let (header, bytes) = numbers(".faceIndices")?;
            let corners = integers(header.kind, &bytes)?;
            let world = world.as_mat4();
            let positions = positions.as_chunks::<3>().0.iter().map(|&p| world.transform_point3(Vec3::from(p)));
            // Alembic winds faces clockwise.
            let added = mesh.add_polygons(positions, &counts, &corners, true);
            added.map_err(|e| Problem(format!("mesh {path}: {e}")))?;
        }
        match mesh.positions.iter().find(|p| !p.is_finite()) {
            Some(p) => Err(Problem(format!("has a vertex at {p}"))),
            None if mesh.triangles.is_empty() => Err(Problem::new("has no polygons")),
            None => Ok(mesh),
        }
    }

    /// World position and rotation of the object `path` (or of the first whose last name it is) at each sample of
    /// its own transform, with their times (s).
    ///
    /// # Errors
    /// No such object; a transform that flattens space.
    pub fn motion(&mut self, path: &str) -> Result<Vec<(f64, DVec3, DQuat)>, Problem> {
        let named = |o: &&crate::tree::Object| {
            o.path == path || o.path.rsplit('/').next().is_some_and(|n| n.eq_ignore_ascii_case(path))
        };
        let Some(object) = self.tree.objects.iter().position(|o| named(&o) && !o.path.is_empty()) else {
            let names: Vec<&str> = self.tree.objects.iter().skip(1).map(|o| o.path.as_str()).take(40).collect();
            return Err(Problem(format!("has no object {path}: node can be {}", names.join(", "))));
        };
        // The samples of the nearest transform that moves say when to look.
        let mut above = Some(object);
        let mut times = vec![0.0];
        while let Some(i) = above {
            if self.tree.objects[i].is("AbcGeom_Xform") {
                let inside = self.schema(i)?;
                if let Some(values) = inside.iter().find(|h| h.name == ".vals").filter(|h| h.samples > 1) {
                    let (timing, samples) = (&self.tree.timings[values.timing], values.different_samples());
                    if samples > MOST_SAMPLES {
                        return Err(Problem(format!("object {path}: moves over {samples} samples, more than is read")));
                    }
                    times = (0..samples).map(|n| timing.time(n)).collect();
                    break;
                }
            }
            above = self.tree.objects[i].parent;
        }
        let mut motion = Vec::with_capacity(times.len());
        for time in times {
            let world = self.world(object, time)?;
            if !(world.is_finite() && world.determinant().abs() > 0.0) {
                return Err(Problem(format!("object {path}: its transform at {time} s flattens space")));
            }
            let (_, rotation, position) = world.to_scale_rotation_translation();
            motion.push((time, position, rotation));
        }
        Ok(motion)
    }

    /// The properties of an object's schema.
    fn schema(&mut self, object: usize) -> Result<Vec<Header>, Problem> {
        let properties = self.tree.properties_of(object)?;
        match properties.iter().find(|h| h.form == Form::Compound && matches!(&*h.name, ".geom" | ".xform")) {
            Some(header) => self.tree.properties(header.place),
            None => Err(Problem(format!("object {}: its schema is empty", self.tree.objects[object].path))),
        }
    }

    /// The product of all transforms from the top down to `object` at `time` (s).
    fn world(&mut self, object: usize, time: f64) -> Result<DMat4, Problem> {
        let mut world = DMat4::IDENTITY;
        let mut above = Some(object);
        while let Some(i) = above {
            if self.tree.objects[i].is("AbcGeom_Xform") {
                let (local, inherits) = self.local(i, time)?;
                world = local * world;
                if !inherits {
                    break;
                }
            }
            above = self.tree.objects[i].parent;
        }
        Ok(world)
    }

    /// A transform, and whether those above it count.
    fn local(&mut self, object: usize, time: f64) -> Result<(DMat4, bool), Problem> {
        let inside = self.schema(object)?;
        let mut numbers = |name: &str| -> Result<Vec<f64>, Problem> {
            let Some(header) = inside.iter().find(|h| h.name == name) else { return Ok(Vec::new()) };
            let timing = &self.tree.timings[header.timing];
            let most = header.samples.saturating_sub(1);
            // The last sample at or before the time; a hair of it later counts as before.
            let (mut low, mut high) = (0, most);
            while low < high {
                let middle = (low + high).div_ceil(2);
                if timing.time(middle) <= time + 1e-6 {
                    low = middle;
                } else {
                    high = middle - 1;
                }
            }
            let bytes = self.tree.sample(header, low)?;
            doubles(header.kind, &bytes)
        };
        let inherits = numbers(".inherits")?.first().is_none_or(|&x| x != 0.0);
        let (operations, values) = (numbers(".ops")?, numbers(".vals")?);
        let mut values = &values[..];
        let mut local = DMat4::IDENTITY;
        for operation in operations {
            let kind = operation as u8 >> 4;
            let needed = match kind {
                0 | 1 => 3,
                2 => 4,
                3 => 16,
                4..=6 => 1,
                _ => return Err(Problem(format!("transform of unknown kind {kind}"))),
            };
            let path = &self.tree.objects[object].path;
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
}

fn required<'a>(headers: &'a [Header], name: &str, path: &str) -> Result<&'a Header, Problem> {
    let found = headers.iter().find(|h| h.name == name && h.form != Form::Compound);
    found.ok_or_else(|| Problem(format!("{path} has no property {name}")))
}

/// Type, wrap and basis of curves.
fn basis(bytes: &[u8]) -> Result<Basis, Problem> {
    let &[order, periodic, basis, ..] = bytes else {
        return Err(Problem::new("do not say whether they are straight or cubic"));
    };
    if periodic != 0 {
        return Err(Problem::new("are closed, which no hair is: export them as open (non-periodic) curves"));
    }
    match (order, basis) {
        (1, _) => Ok(Basis::Linear),
        (0, 1) => Ok(Basis::Bezier),
        (0, 2) => Ok(Basis::Bspline),
        (0, 3) => Ok(Basis::CatmullRom),
        (0, b) => Err(Problem(format!("cubic curves of basis {b}: export them as linear, Bezier or B-spline curves"))),
        _ => Err(Problem::new("are NURBS of their own orders: export them as linear curves")),
    }
}
