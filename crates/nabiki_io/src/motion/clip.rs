//! One node's world motion out of a glTF animation.
//!
//! Every node from the scene's root down to the wanted one is evaluated at the scene's frames themselves (STEP, LINEAR
//! or CUBICSPLINE as each channel says), so nothing is interpolated twice. The rotation given is that from the node's
//! still pose, the one the file has without its animation, since a bone's own axes seldom lie along the world's.

use std::collections::HashMap;
use std::rc::Rc;

use glam::{DAffine3, DMat4, DQuat, DVec3, DVec4};
use gltf::animation::{Interpolation, Property, util::ReadOutputs};

use super::joints::{Tree, check_poses};
use super::source::MotionSource;
use super::track::{Sample, hermite};
use super::world::{HeadMotion, WorldFromFile, frame_count, poses};
use crate::axis::Axis;
use crate::error::{Error, Result};
use crate::gltf_file;

/// Reads the poses of `source.node` in `source.clip` out of the file's bytes.
pub(super) fn head_motion(source: &MotionSource, bytes: &[u8], frame_rate: f64) -> Result<HeadMotion> {
    let (document, blob) = gltf_file::open(bytes)?;
    let buffers = gltf_file::buffers(&document, blob, source.file.parent())?;
    let budget = gltf_file::budget(bytes, &buffers);
    let chain = chain(&document, &source.node)?;
    let animation = animation(&document, &source.clip)?;
    // The crate's own validation passes over a channel's target, and its reader would panic.
    let json = document.as_json();
    for target in json.animations[animation.index()].channels.iter().map(|channel| &channel.target) {
        if matches!(target.path, gltf::json::validation::Checked::Invalid) {
            return Err(Error::new("a channel moves something that is no translation, rotation, scale or weights"));
        }
        let (node, count) = (target.node.value(), json.nodes.len());
        if node >= count {
            return Err(Error::new(format!("a channel moves node {node}, there are {count}")));
        }
    }

    let mut curves: Vec<Curves> = chain.iter().map(still).collect();
    let (mut start, mut end) = (f64::INFINITY, f64::NEG_INFINITY);
    // Many channels share their times.
    let mut known: HashMap<usize, Rc<[f64]>> = HashMap::new();
    for channel in animation.channels() {
        check_accessors(&channel, &buffers)?;
        let reader = channel.reader(|buffer| buffers.get(buffer.index()).map(|bytes| &**bytes));
        let input = channel.sampler().input();
        let times = match known.get(&input.index()) {
            Some(times) => times.clone(),
            None => {
                budget.take_list::<f64>(input.count(), "times")?;
                let times = reader.read_inputs().ok_or_else(|| Error::new("an animation without times"))?;
                known.entry(input.index()).or_insert(times.map(f64::from).collect()).clone()
            }
        };
        let node = channel.target().node();
        let name = node.name().unwrap_or("without a name");
        if times.is_empty() || !times.iter().all(|t| t.is_finite()) || times.windows(2).any(|w| w[0] >= w[1]) {
            return Err(Error::new(format!("clip of node {name}: its times must grow and be finite")));
        }
        start = start.min(times[0]);
        end = end.max(times[times.len() - 1]);
        let Some(place) = chain.iter().position(|n| n.index() == node.index()) else { continue };
        budget.take_list::<[f32; 4]>(channel.sampler().output().count(), "values")?;
        let interpolation = channel.sampler().interpolation();
        let curve = |values: Vec<DVec4>| Curve::new(times.clone(), values, interpolation, name);
        let wide = |v: [f32; 3]| DVec3::from(v.map(f64::from)).extend(0.0);
        match reader.read_outputs().ok_or_else(|| Error::new("an animation without values"))? {
            ReadOutputs::Translations(v) => curves[place].translation = curve(v.map(wide).collect())?,
            ReadOutputs::Scales(v) => curves[place].scale = curve(v.map(wide).collect())?,
            ReadOutputs::Rotations(v) => {
                let values = v.into_f32().map(|q| DVec4::from(q.map(f64::from))).collect();
                curves[place].rotation = curve(values)?;
            }
            ReadOutputs::MorphTargetWeights(_) => {}
        }
    }
    if start > end {
        return Err(Error::new(format!("clip \"{}\" has no channel", animation.name().unwrap_or_default())));
    }
    let still_pose = world(chain.iter().map(|node| matrix(node.transform())), &source.node)?;
    let (up, facing) = (source.up.unwrap_or(Axis::PlusY), source.facing.unwrap_or(Axis::PlusZ));
    let unit_cm = source.unit_cm.unwrap_or(100.0);
    let world_from_file = WorldFromFile::new(Some(unit_cm), Some(up), Some(facing))?;
    let frames = frame_count(end - start, frame_rate / source.speed)?;
    check_poses(chain.len(), frames)?;
    let mut samples = Vec::with_capacity(frames.min(1 << 16));
    for n in 0..frames {
        let time = start + n as f64 / (frame_rate / source.speed);
        let pose = world(curves.iter().map(|c| c.matrix_at(time)), &source.node)?;
        samples.push(Sample {
            position: pose.position,
            rotation: (pose.rotation * still_pose.rotation.inverse()).normalize(),
        });
    }
    let report = format!(
        "{}: clip {}, node {}, {:.3} s -> {frames} frames at {frame_rate} Hz{} (evaluated at the frames; unit {unit_cm} cm, \
         up {up}, face {facing})",
        source.file.display(),
        animation.name().unwrap_or("without a name"),
        source.node,
        end - start,
        source.changes(),
    );
    let poses = poses(&world_from_file, samples.into_iter(), source)?;
    Ok(HeadMotion { frame_rate, poses, bound: None, first_frame: None, report })
}

/// The nodes from the scene's root down to the one named.
fn chain<'a>(document: &'a gltf::Document, name: &str) -> Result<Vec<gltf::Node<'a>>> {
    let nodes: Vec<gltf::Node<'a>> = document.nodes().collect();
    let mut parents = vec![None; nodes.len()];
    for node in &nodes {
        for child in node.children() {
            if parents[child.index()].replace(node.index()).is_some() {
                return Err(Error::new(format!("node {} hangs below two others", child.index())));
            }
        }
    }
    let names = nodes.iter().map(|node| node.name()).collect();
    let chain = Tree { kind: "node", names, parents }.chain(name)?;
    Ok(chain.into_iter().map(|node| nodes[node].clone()).collect())
}

fn animation<'a>(document: &'a gltf::Document, clip: &str) -> Result<gltf::Animation<'a>> {
    let names = || document.animations().filter_map(|a| a.name()).take(100).collect::<Vec<_>>().join(", ");
    if clip.is_empty() {
        let mut all = document.animations();
        match (all.next(), all.next()) {
            (Some(only), None) => Ok(only),
            (None, _) => Err(Error::new("has no animation")),
            _ => Err(Error::new(format!("has several animations: give clip = one of {}", names()))),
        }
    } else {
        let mut all = document.animations().filter(|a| a.name() == Some(clip));
        match (all.next(), all.next()) {
            (Some(only), None) => Ok(only),
            (None, _) => Err(Error::new(format!("no clip \"{clip}\": clip can be {}", names()))),
            _ => Err(Error::new(format!("clip \"{clip}\": several have that name; rename all but one in the file"))),
        }
    }
}

/// Refuses accessors that reach past their buffers, which the reader itself would meet with a panic, and those of
/// another shape than what the channel moves, which it would read askew.
fn check_accessors(channel: &gltf::animation::Channel<'_>, buffers: &[gltf_file::Buffer<'_>]) -> Result<()> {
    let sampler = channel.sampler();
    for accessor in [sampler.input(), sampler.output()] {
        let problem = |what: &str| Error::new(format!("accessor {}: {what}", accessor.index()));
        if accessor.sparse().is_some() {
            return Err(problem("sparse animation data is not read"));
        }
        let view = accessor.view().ok_or_else(|| problem("without a view of a buffer"))?;
        let size = accessor.size() as u128;
        let stride = view.stride().map_or(size, |s| s as u128);
        let used = match accessor.count() as u128 {
            0 => return Err(problem("is empty")),
            n => accessor.offset() as u128 + stride * (n - 1) + size,
        };
        let held = buffers.get(view.buffer().index()).map_or(0, |b| b.len() as u128);
        if stride < size || used > view.length() as u128 || view.offset() as u128 + view.length() as u128 > held {
            return Err(problem("reaches past the end of its buffer: is the file whole?"));
        }
    }
    use gltf::accessor::{DataType, Dimensions};
    let input = sampler.input();
    if (input.data_type(), input.dimensions()) != (DataType::F32, Dimensions::Scalar) {
        return Err(Error::new(format!("accessor {}: times must be 32-bit floats", input.index())));
    }
    let (output, moved) = (sampler.output(), channel.target().property());
    let whole = matches!(output.data_type(), DataType::I8 | DataType::U8 | DataType::I16 | DataType::U16);
    let fits = match (moved, output.dimensions()) {
        (Property::Translation | Property::Scale, Dimensions::Vec3) => output.data_type() == DataType::F32,
        (Property::Rotation, Dimensions::Vec4) | (Property::MorphTargetWeights, Dimensions::Scalar) => {
            output.data_type() == DataType::F32 || whole
        }
        _ => false,
    };
    if fits {
        return Ok(());
    }
    let (kind, shape) = (output.data_type(), output.dimensions());
    Err(Error::new(format!("accessor {}: {kind:?} {shape:?} is not a {moved:?}", output.index())))
}

/// What moves one node; a curve without times holds its one value.
struct Curves {
    translation: Curve,
    rotation: Curve,
    scale: Curve,
    /// A node whose pose is a matrix cannot be animated.
    matrix: Option<DMat4>,
}

fn still(node: &gltf::Node<'_>) -> Curves {
    let (t, r, s) = node.transform().decomposed();
    let constant = |value| Curve { times: Rc::default(), values: vec![value], interpolation: Interpolation::Step };
    Curves {
        translation: constant(DVec3::from(t.map(f64::from)).extend(0.0)),
        rotation: constant(DVec4::from(r.map(f64::from))),
        scale: constant(DVec3::from(s.map(f64::from)).extend(0.0)),
        matrix: match node.transform() {
            gltf::scene::Transform::Matrix { .. } => Some(matrix(node.transform())),
            gltf::scene::Transform::Decomposed { .. } => None,
        },
    }
}

fn matrix(transform: gltf::scene::Transform) -> DMat4 {
    DMat4::from_cols_array_2d(&transform.matrix().map(|column| column.map(f64::from)))
}

impl Curves {
    fn matrix_at(&self, time: f64) -> DMat4 {
        if let (Some(matrix), true) = (self.matrix, self.is_still()) {
            return matrix;
        }
        DMat4::from_scale_rotation_translation(
            self.scale.at(time).truncate(),
            DQuat::from_vec4(self.rotation.turned(time)).normalize(),
            self.translation.at(time).truncate(),
        )
    }

    fn is_still(&self) -> bool {
        [&self.translation, &self.rotation, &self.scale].iter().all(|c| c.times.is_empty())
    }
}

/// Position and rotation of the product of `matrices`, root first.
fn world(matrices: impl Iterator<Item = DMat4>, name: &str) -> Result<Sample> {
    let product = matrices.fold(DMat4::IDENTITY, |product, m| product * m);
    let affine = DAffine3::from_mat4(product);
    let volume = affine.matrix3.determinant();
    if !(product.is_finite() && volume.is_finite() && volume.abs() > 0.0) {
        return Err(Error::new(format!("node {name}: its transform is not finite or flattens space")));
    }
    let (_, rotation, position) = affine.to_scale_rotation_translation();
    Ok(Sample { position, rotation })
}

/// Values over time; CUBICSPLINE keeps in-tangent, value and out-tangent for each time.
struct Curve {
    times: Rc<[f64]>,
    values: Vec<DVec4>,
    interpolation: Interpolation,
}

impl Curve {
    fn new(times: Rc<[f64]>, values: Vec<DVec4>, interpolation: Interpolation, node: &str) -> Result<Self> {
        let each = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
        if values.len() != each * times.len() {
            let (v, t) = (values.len(), times.len());
            return Err(Error::new(format!("clip of node {node}: {v} values for {t} times ({each} each are needed)")));
        }
        match values.iter().position(|v| !v.is_finite()) {
            Some(i) => Err(Error::new(format!("clip of node {node}: value {i} is not finite"))),
            None => Ok(Self { times, values, interpolation }),
        }
    }

    /// Index of the key at or before `time`, and how far it is to the next (0..1; 0 outside the keys).
    fn place(&self, time: f64) -> (usize, f64) {
        let after = self.times.partition_point(|&t| t <= time);
        if after == 0 || after >= self.times.len() {
            return (after.saturating_sub(1), 0.0);
        }
        let (a, b) = (self.times[after - 1], self.times[after]);
        (after - 1, (time - a) / (b - a))
    }

    fn at(&self, time: f64) -> DVec4 {
        let (key, u) = self.place(time);
        match self.interpolation {
            Interpolation::Step => self.values[key],
            Interpolation::Linear if u > 0.0 => self.values[key].lerp(self.values[key + 1], u),
            Interpolation::Linear => self.values[key],
            Interpolation::CubicSpline if u > 0.0 => self.spline(key, u),
            Interpolation::CubicSpline => self.values[3 * key + 1],
        }
    }

    /// As [`at`](Self::at) for quaternions: along the shorter great circle where linear.
    fn turned(&self, time: f64) -> DVec4 {
        let (key, u) = self.place(time);
        if self.interpolation != Interpolation::Linear || u == 0.0 {
            return self.at(time);
        }
        let [a, b] = [self.values[key], self.values[key + 1]].map(|v| DQuat::from_vec4(v).normalize());
        a.slerp(b, u).into()
    }

    fn spline(&self, key: usize, u: f64) -> DVec4 {
        let span = self.times[key + 1] - self.times[key];
        let [_, p0, m0, m1, p1, _] = std::array::from_fn(|i| self.values[3 * key + i]);
        let (m0, m1) = (m0 * span, m1 * span);
        let rest = hermite(DVec3::X * p0.w, DVec3::X * m0.w, DVec3::X * p1.w, DVec3::X * m1.w, u).x;
        hermite(p0.truncate(), m0.truncate(), p1.truncate(), m1.truncate(), u).extend(rest)
    }
}

#[cfg(test)]
#[path = "clip_tests.rs"]
mod tests;
