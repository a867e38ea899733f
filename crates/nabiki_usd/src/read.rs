//! Hair, heads and their motion out of a layer.

use std::path::Path;

use glam::{Affine3A, DMat4, DQuat, DVec3, Mat4, Vec3};
use nabiki::curves::{Basis, Curves, Gathered, Walked};
use nabiki::hair::Attributes;
use nabiki::{Hair, Mesh};

use crate::Problem;
use crate::source::{Layer, Source};
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
        let hair = all.hair();
        match hair.strands.points().iter().position(|p| !p.is_finite()) {
            Some(i) => Err(Problem(format!("point {i} of its curves is not finite"))),
            None => Ok(hair),
        }
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
        let curves = Curves { counts: &counts, points: &points, basis, pinned: wrap == "pinned" };
        let walked = curves.walk(segments).map_err(Problem)?;
        let attributes = self.attributes(prim, time, &curves, &walked)?;
        let hair = Hair { strands: walked.strands, attributes };
        let world = transform::world(&mut self.layer, prim, time)?;
        Ok(if world == DMat4::IDENTITY { hair } else { hair.transformed(&Affine3A::from_mat4(single(world))) })
    }

    fn attributes(
        &mut self,
        prim: usize,
        time: f64,
        curves: &Curves<'_>,
        walked: &Walked,
    ) -> Result<Attributes, Problem> {
        let one = |values: Vec<[f32; 1]>| values.into_iter().map(|[x]| x).collect();
        let mut found = Attributes {
            width: self.by_point(prim, &["widths"], time, curves, walked)?.map(one),
            ..Attributes::default()
        };
        found.color = self.by_point(prim, &["displayColor", "groom_color"], time, curves, walked)?;
        found.point_uv = self.by_point(prim, &["point_uv"], time, curves, walked)?;
        found.freedom = self.by_point(prim, &["freedom"], time, curves, walked)?.map(one);
        found.transparency = self.by_point(prim, &["transparency"], time, curves, walked)?.map(one);
        if found.transparency.is_none() {
            let opacity = self.by_point::<1>(prim, &["displayOpacity"], time, curves, walked)?;
            found.transparency = opacity.map(|o| o.into_iter().map(|[x]| 1.0 - x).collect());
        }
        // `surface_uv_coordinate` is Blender's, `rootuv` Houdini's.
        for name in ["st", "groom_root_uv", "surface_uv_coordinate", "rootuv", "uv", "UVMap"] {
            if found.root_uv.is_none() {
                let values = self.values::<2>(prim, name, time)?;
                found.root_uv = values.and_then(|v| curves.at_roots(&v));
            }
        }
        let id = self.whole(prim, &["groom_id", "id", "ids", "hairId"], time)?;
        found.id = id.and_then(|v| curves.at_roots(&v));
        let group = self.whole(prim, &["groom_group_id", "group_id", "group"], time)?;
        found.group = group.and_then(|v| curves.at_roots(&v)).map(|g| g.into_iter().map(|g| g as i32).collect());
        let guide = self.whole(prim, &["groom_guide", "guide"], time)?;
        found.guide = guide.and_then(|v| curves.at_roots(&v)).map(|g| g.into_iter().map(|g| g != 0).collect());
        if let (Some(groups), Some(handle)) = (&found.group, self.primvar(prim, "groom_group_name", time)) {
            let words = self.layer.words(handle)?;
            let names = curves.at_roots(&words.iter().collect::<Vec<_>>());
            let named = groups.iter().zip(names.into_iter().flatten().cloned());
            found.group_names = named.filter(|(_, name)| !name.is_empty()).map(|(&g, name)| (g, name)).collect();
        }
        Ok(found)
    }

    fn primvar(&self, prim: usize, name: &str, time: f64) -> Option<crate::source::Handle> {
        if name == "widths" {
            let plain = self.layer.at(prim, name, time);
            return plain.or_else(|| self.layer.at(prim, "primvars:widths", time));
        }
        self.layer.at(prim, &format!("primvars:{name}"), time)
    }

    /// Values of a primvar, `N` numbers each, looked up where it is stored by index.
    fn values<const N: usize>(&mut self, prim: usize, name: &str, time: f64) -> Result<Option<Vec<[f32; N]>>, Problem> {
        let Some(handle) = self.primvar(prim, name, time) else { return Ok(None) };
        let numbers = self.layer.singles(handle)?;
        if numbers.is_empty() || numbers.len() % N != 0 {
            return Ok(None);
        }
        let values = numbers.as_chunks::<N>().0;
        let Some(indices) = self.layer.at(prim, &format!("primvars:{name}:indices"), time) else {
            return Ok(Some(values.to_vec()));
        };
        let pick = |i: i64| usize::try_from(i).ok().and_then(|i| values.get(i)).copied();
        let picked: Option<Vec<[f32; N]>> = self.layer.integers(indices)?.into_iter().map(pick).collect();
        picked.map(Some).ok_or_else(|| Problem(format!("primvar {name}: an index past its values")))
    }

    /// Values at the walked points of the first primvar there is of those named.
    fn by_point<const N: usize>(
        &mut self,
        prim: usize,
        names: &[&str],
        time: f64,
        curves: &Curves<'_>,
        walked: &Walked,
    ) -> Result<Option<Vec<[f32; N]>>, Problem> {
        for name in names {
            let Some(values) = self.values::<N>(prim, name, time)? else { continue };
            let found = curves.at_points(walked, &values);
            return found.map(Some).ok_or_else(|| {
                let (n, points, curves) = (values.len(), curves.points.len(), curves.counts.len());
                Problem(format!("{name}: {n} values for {points} points of {curves} curves"))
            });
        }
        Ok(None)
    }

    fn whole(&mut self, prim: usize, names: &[&str], time: f64) -> Result<Option<Vec<i64>>, Problem> {
        for name in names {
            if let Some(handle) = self.primvar(prim, name, time) {
                let values = self.layer.integers(handle)?;
                if !values.is_empty() {
                    return Ok(Some(values));
                }
            }
        }
        Ok(None)
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
            let counts = checked_counts(&counts, corners.len()).map_err(|e| problem(&e.0))?;
            let points = points.as_chunks::<3>().0;
            let base = mesh.positions.len() as u32;
            let corner = |c: &i64| match usize::try_from(*c) {
                Ok(i) if i < points.len() => Ok(base + i as u32),
                _ => Err(Problem(format!("mesh {path}: corner {c} of {} points", points.len()))),
            };
            let mut at = 0;
            for count in counts {
                let face = corners[at..at + count].iter().map(corner).collect::<Result<Vec<u32>, _>>()?;
                let wound = |k: usize| {
                    if left_handed { [face[0], face[k], face[k - 1]] } else { [face[0], face[k - 1], face[k]] }
                };
                mesh.triangles.extend((2..count).map(wound));
                at += count;
            }
            let world = single(transform::world(&mut self.layer, prim, 0.0)?);
            mesh.positions.extend(points.iter().map(|&p| world.transform_point3(Vec3::from(p))));
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

fn single(m: DMat4) -> Mat4 {
    Mat4::from_cols_array(&m.to_cols_array().map(|x| x as f32))
}

/// Counts that are not negative and add up to `total`.
fn checked_counts(counts: &[i64], total: usize) -> Result<Vec<usize>, Problem> {
    let mut sum = 0usize;
    let mut checked = Vec::with_capacity(counts.len());
    for &count in counts {
        let count = usize::try_from(count).map_err(|_| Problem(format!("a count of {count}")))?;
        sum = sum.saturating_add(count);
        checked.push(count);
    }
    if sum == total {
        Ok(checked)
    } else {
        Err(Problem(format!("counts that add up to {sum} where there are {total}")))
    }
}
