//! One node's world motion out of a glTF animation.
//!
//! Every node from the scene's root down to the wanted one is evaluated at the scene's frames themselves (STEP, LINEAR
//! or CUBICSPLINE as each channel says), so nothing is interpolated twice. The rotation given is that from the node's
//! still pose, the one the file has without its animation, since a bone's own axes seldom lie along the world's.

use std::collections::HashMap;
use std::rc::Rc;

use glam::{DAffine3, DMat4, DQuat, DVec3, DVec4};
use gltf::animation::{Interpolation, Property};

use super::joints::{Tree, check_poses};
use super::source::MotionSource;
use super::track::{Sample, hermite};
use super::world::{HeadMotion, WorldFromFile, frame_count, pose_of, poses};
use crate::axis::Axis;
use crate::error::{Error, Result};
use crate::gltf_file::accessors::{Whole, numbers};
use crate::gltf_file::{self, Buffers, pose};

/// Reads the poses of `source.node` in `source.clip` out of the file's bytes.
pub(super) fn head_motion(source: &MotionSource, bytes: &[u8], frame_rate: f64) -> Result<HeadMotion> {
    let (document, blob) = gltf_file::open(bytes)?;
    let buffers = Buffers::new(&document, bytes, blob, source.file.parent())?;
    let chain = chain(&document, &source.node)?;
    let on_chain = |node: usize| chain.iter().any(|other| other.index() == node);
    let clip = Clip::read(&document, &buffers, &source.clip, &on_chain)?;
    let Clip { start, end, .. } = clip;
    let curves: Vec<&Curves> = chain.iter().map(|node| &clip.curves[&node.index()]).collect();
    let (still_pose, _) = world(chain.iter().map(|node| matrix(node.transform())), &source.node)?;
    let (up, facing) = (source.up.unwrap_or(Axis::PlusY), source.facing.unwrap_or(Axis::PlusZ));
    let unit_cm = source.unit_cm.unwrap_or(100.0);
    let world_from_file = WorldFromFile::new(Some(unit_cm), Some(up), Some(facing))?;
    let frames = frame_count(end - start, frame_rate / source.speed)?;
    check_poses(chain.len(), frames)?;
    let mut samples = Vec::with_capacity(frames.min(1 << 16));
    let (mut first_scale, mut grows) = (None, false);
    for n in 0..frames {
        let time = start + n as f64 / (frame_rate / source.speed);
        let (pose, scale) = world(curves.iter().map(|c| c.matrix_at(time)), &source.node)?;
        grows |= !(scale / *first_scale.get_or_insert(scale)).abs_diff_eq(DVec3::ONE, SAME_SCALE);
        samples.push(Sample {
            position: pose.position,
            rotation: (pose.rotation * still_pose.rotation.inverse()).normalize(),
        });
    }
    let report = format!(
        "{}: clip {}, node {}, {:.3} s -> {frames} frames at {frame_rate} Hz{} (evaluated at the frames; unit {unit_cm} cm, \
         up {up}, face {facing}){}",
        source.file.display(),
        clip.name.as_deref().unwrap_or("without a name"),
        source.node,
        end - start,
        source.changes(),
        if grows { "; ignored: its scale, which changes" } else { "" },
    );
    let poses = poses(&world_from_file, samples.into_iter(), source)?;
    // Meshes stand in the still pose, from which turns are counted.
    let unturned = Sample { rotation: DQuat::IDENTITY, ..still_pose };
    let bound = Some(pose_of(world_from_file.pose(unturned)));
    let times = [start, source.speed / frame_rate];
    Ok(HeadMotion { frame_rate, poses, bound, times, first_frame: None, report })
}

/// An animation: what moves nodes and morphs over time.
pub(crate) struct Clip {
    name: Option<String>,
    /// Of the nodes that are wanted.
    curves: HashMap<usize, Curves>,
    /// Of the morphs of nodes that are wanted.
    morphs: HashMap<usize, Morphs>,
    /// Its first and last time (s).
    start: f64,
    end: f64,
}

impl Clip {
    /// The animation `clip`, which may be empty if there is only one, as far as it moves the nodes for which `wanted` is true.
    ///
    /// # Errors
    /// No such animation, or one whose numbers contradict each other.
    pub fn read(
        document: &gltf::Document,
        buffers: &Buffers<'_>,
        clip: &str,
        wanted: &dyn Fn(usize) -> bool,
    ) -> Result<Self> {
        let animation = animation(document, clip)?;
        // The crate's own validation passes over a channel's target, and its reader would panic.
        let json = document.as_json();
        for target in json.animations[animation.index()].channels.iter().map(|channel| &channel.target) {
            if matches!(target.path, gltf::json::validation::Checked::Invalid) {
                return Err(Error::new("a channel moves something other than translation, rotation, scale or weights"));
            }
            let (node, count) = (target.node.value(), json.nodes.len());
            if node >= count {
                return Err(Error::new(format!("a channel moves node {node}, but there are {count}")));
            }
        }
        let nodes = document.nodes().filter(|node| wanted(node.index()));
        let mut curves: HashMap<usize, Curves> = nodes.map(|node| (node.index(), still(&node))).collect();
        let mut morphs = HashMap::new();
        let (mut start, mut end) = (f64::INFINITY, f64::NEG_INFINITY);
        // Many channels share their times.
        let mut known: HashMap<usize, Rc<[f64]>> = HashMap::new();
        for channel in animation.channels() {
            let sampler = channel.sampler();
            let input = sampler.input();
            let times = match known.get(&input.index()) {
                Some(times) => times.clone(),
                None => {
                    let times = numbers::<1>(&input, buffers, Whole::AsSaid, "times")?;
                    known.entry(input.index()).or_insert(times.into_iter().map(|[t]| f64::from(t)).collect()).clone()
                }
            };
            let node = channel.target().node();
            let name = node.name().unwrap_or("without a name");
            if times.is_empty() || !times.iter().all(|t| t.is_finite()) || times.windows(2).any(|w| w[0] >= w[1]) {
                return Err(Error::new(format!("clip of node {name}: its times must increase and be finite")));
            }
            start = start.min(times[0]);
            end = end.max(times[times.len() - 1]);
            let Some(of_node) = curves.get_mut(&node.index()) else { continue };
            let curve = |values: Vec<DVec4>| Curve::new(times.clone(), values, sampler.interpolation(), name);
            let triples = |what| -> Result<Vec<DVec4>> {
                let values = numbers::<3>(&sampler.output(), buffers, Whole::Shares, what)?;
                Ok(values.into_iter().map(|v| DVec3::from(v.map(f64::from)).extend(0.0)).collect())
            };
            match channel.target().property() {
                Property::Translation => of_node.translation = curve(triples("translations")?)?,
                Property::Scale => of_node.scale = curve(triples("scales")?)?,
                Property::Rotation => {
                    let values = numbers::<4>(&sampler.output(), buffers, Whole::Shares, "rotations")?;
                    of_node.rotation = curve(values.into_iter().map(|q| DVec4::from(q.map(f64::from))).collect())?;
                }
                Property::MorphTargetWeights => {
                    let values = numbers::<1>(&sampler.output(), buffers, Whole::Shares, "weights of morphs")?;
                    let values = values.into_iter().map(|[weight]| f64::from(weight)).collect();
                    let of_morphs = Morphs::new(times.clone(), values, sampler.interpolation(), name)?;
                    morphs.insert(node.index(), of_morphs);
                }
            }
        }
        let name = animation.name().map(str::to_owned);
        if start > end {
            return Err(Error::new(format!("clip \"{}\" has no channel", name.unwrap_or_default())));
        }
        Ok(Self { name, curves, morphs, start, end })
    }

    /// Whether it moves any of these nodes.
    pub fn moves(&self, nodes: impl IntoIterator<Item = usize>) -> bool {
        nodes.into_iter().any(|node| self.curves.get(&node).is_some_and(|curves| !curves.is_still()))
    }

    /// Whether it moves the morphs of a node.
    pub fn morphs(&self, node: usize) -> bool {
        self.morphs.contains_key(&node)
    }

    /// Takes a node's space to the one above it at a time (s); none for nodes that were not wanted.
    pub fn transform(&self, node: usize, time: f64) -> Option<DAffine3> {
        self.curves.get(&node).map(|curves| DAffine3::from_mat4(curves.matrix_at(time)))
    }

    /// The weights of a node's morphs at a time (s), if it moves them.
    pub fn weights(&self, node: usize, time: f64) -> Option<Vec<f32>> {
        self.morphs.get(&node).map(|morphs| morphs.at(time))
    }
}

/// The weights of the morphs of one node: a curve for each.
struct Morphs(Vec<Curve>);

impl Morphs {
    fn new(times: Rc<[f64]>, values: Vec<f64>, interpolation: Interpolation, node: &str) -> Result<Self> {
        let each = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
        let (count, rows) = (values.len(), each * times.len());
        if !count.is_multiple_of(rows) {
            let times = times.len();
            return Err(Error::new(format!("clip of node {node}: {count} weights of morphs for {times} times")));
        }
        let morphs = count / rows;
        let of = |morph: usize| {
            let own = values.iter().skip(morph).step_by(morphs).map(|&weight| DVec4::X * weight);
            Curve::new(times.clone(), own.collect(), interpolation, node)
        };
        (0..morphs).map(of).collect::<Result<_>>().map(Self)
    }

    fn at(&self, time: f64) -> Vec<f32> {
        self.0.iter().map(|curve| curve.at(time).x as f32).collect()
    }
}

/// The nodes from the scene's root down to the one named.
pub(super) fn chain<'a>(document: &'a gltf::Document, name: &str) -> Result<Vec<gltf::Node<'a>>> {
    let nodes: Vec<gltf::Node<'a>> = document.nodes().collect();
    let parents = pose::parents(document)?;
    let names = nodes.iter().map(|node| node.name()).collect();
    let chain = Tree { kind: "node", names, parents }.chain(name)?;
    Ok(chain.into_iter().map(|node| nodes[node].clone()).collect())
}

fn animation<'a>(document: &'a gltf::Document, clip: &str) -> Result<gltf::Animation<'a>> {
    let mut all: Vec<gltf::Animation<'a>> = document.animations().collect();
    let names: Vec<Option<&str>> =
        document.as_json().animations.iter().map(|animation| animation.name.as_deref()).collect();
    let chosen = choose_clip(&names, clip)?;
    Ok(all.swap_remove(chosen))
}

/// Which of the animations with these names `clip` is; it may be empty if there is only one.
pub(crate) fn choose_clip(names: &[Option<&str>], clip: &str) -> Result<usize> {
    let known = || names.iter().copied().flatten().take(100).collect::<Vec<_>>().join(", ");
    if clip.is_empty() {
        return match names.len() {
            1 => Ok(0),
            0 => Err(Error::new("has no animation")),
            _ => Err(Error::new(format!("has several animations: give clip = one of {}", known()))),
        };
    }
    let mut of_name = (0..names.len()).filter(|&n| names[n] == Some(clip));
    match (of_name.next(), of_name.next()) {
        (Some(only), None) => Ok(only),
        (None, _) => Err(Error::new(format!("no clip \"{clip}\": clip can be {}", known()))),
        _ => Err(Error::new(format!("clip \"{clip}\": several have that name; rename all but one in the file"))),
    }
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

/// Scales that differ by less than this part are one scale.
pub(super) const SAME_SCALE: f64 = 1e-3;

/// Position and rotation of the product of `matrices`, root first, and its scale.
pub(super) fn world(matrices: impl Iterator<Item = DMat4>, name: &str) -> Result<(Sample, DVec3)> {
    let product = matrices.fold(DMat4::IDENTITY, |product, m| product * m);
    let affine = DAffine3::from_mat4(product);
    let volume = affine.matrix3.determinant();
    if !(product.is_finite() && volume.is_finite() && volume.abs() > 0.0) {
        return Err(Error::new(format!("node {name}: its transform is not finite or flattens space")));
    }
    let (scale, rotation, position) = affine.to_scale_rotation_translation();
    Ok((Sample { position, rotation }, scale))
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
            return Err(Error::new(format!("clip of node {node}: {v} values for {t} times (each needs {each})")));
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
