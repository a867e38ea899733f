//! FBX documents: opened within a budget, their unit and axes, nodes, rest pose and animations.

use glam::{DAffine3, DMat3, DVec3};
use nabiki_exchange::Budget;
use ufbx::{
    AllocatorOpts, Anim, AnimCurve, AnimStack, CoordinateAxes, CoordinateAxis, ErrorType, EvaluateOpts, FileFormat,
    IndexErrorHandling, InheritMode, LoadOpts, MirrorAxis, Node, SceneRoot,
};

use crate::axis::Axis;
use crate::declared::DeclaredSpace;
use crate::error::{Error, Result};
use crate::motion::DEEPEST;
use crate::unit::Unit;

/// A file that is open.
pub(crate) struct Document {
    pub scene: SceneRoot,
    /// What may be made of it. What ufbx makes has limits of its own.
    pub budget: Budget,
}

impl Document {
    pub fn open(bytes: &[u8]) -> Result<Self> {
        let scene = load(bytes, None)?;
        // Numbers mean the same on either hand. Mirrored, they are those of a right hand with the same up.
        let scene = match left_handed(&scene.settings.axes) {
            Some(mirrored) => {
                // One of them at a time.
                drop(scene);
                load(bytes, Some(mirrored))?
            }
            None => scene,
        };
        Ok(Self { scene, budget: Budget::of(bytes.len() as u64) })
    }

    /// Unit and up axis. A file that states none means centimetres and +y, by the rule of FBX.
    pub fn space(&self) -> Result<DeclaredSpace> {
        let settings = &self.scene.settings;
        let metres = settings.unit_meters;
        if !(1e-9..=1e6).contains(&metres) {
            let line =
                format!("UnitScaleFactor is {}: must be the centimetres in one unit, such as 1 or 100", 100.0 * metres);
            return Err(Error::new(line));
        }
        let up = match settings.axes.up {
            CoordinateAxis::PositiveX => Axis::PlusX,
            CoordinateAxis::NegativeX => Axis::MinusX,
            CoordinateAxis::NegativeY => Axis::MinusY,
            CoordinateAxis::PositiveZ => Axis::PlusZ,
            CoordinateAxis::NegativeZ => Axis::MinusZ,
            CoordinateAxis::PositiveY | CoordinateAxis::Unknown => Axis::PlusY,
        };
        Ok(DeclaredSpace { unit: Some(Unit { cm: (100.0 * metres) as f32 }), up: Some(up) })
    }

    /// Frames per second, if the file states a usable number.
    pub fn rate(&self) -> Option<f64> {
        let rate = self.scene.settings.frames_per_second;
        (1.0..=1000.0).contains(&rate).then_some(rate)
    }

    /// The nodes, parents first. The first is the root of the scene, which has no name.
    pub fn nodes(&self) -> impl ExactSizeIterator<Item = &Node> {
        self.scene.nodes.as_ref().iter().map(|node| &**node)
    }

    /// The names of the nodes, and the one above each; none above those below the root.
    pub fn tree(&self) -> (Vec<Option<&str>>, Vec<Option<usize>>) {
        let above = |node: &Node| node.parent.as_ref().filter(|parent| !parent.is_root).map(|parent| number(parent));
        self.nodes().map(|node| (name(node), above(node))).unzip()
    }

    /// Takes each node's space to the scene's at rest: joints where the skins bind them, other nodes below these as they are without
    /// animation.
    pub fn rest_pose(&self) -> Vec<DAffine3> {
        let still: Vec<DAffine3> = self.nodes().map(|node| affine(&node.node_to_world)).collect();
        let mut bound: Vec<Option<DAffine3>> = vec![None; still.len()];
        for cluster in &self.scene.skin_clusters {
            let bind = affine(&cluster.bind_to_world);
            if let Some(joint) = cluster.bone_node.as_ref().filter(|_| is_place(&bind)) {
                bound[number(joint)].get_or_insert(bind);
            }
        }
        let mut rest = still.clone();
        for (n, node) in self.nodes().enumerate() {
            let above = node.parent.as_ref().map(|parent| number(parent)).filter(|&above| rest[above] != still[above]);
            let moved = || above.map(|above| rest[above] * still[above].inverse() * still[n]).filter(is_place);
            rest[n] = bound[n].or_else(moved).unwrap_or(still[n]);
        }
        rest
    }

    /// The animation `clip`, which may be empty if there is only one.
    pub fn stack(&self, clip: &str) -> Result<&AnimStack> {
        let names: Vec<Option<&str>> = self.scene.anim_stacks.as_ref().iter().map(|stack| clip_name(stack)).collect();
        crate::motion::choose_clip(&names, clip).map(|n| &self.scene.anim_stacks[n])
    }

    /// The scene at a time (s) of an animation. Its nodes have their numbers.
    pub fn at(&self, anim: &Anim, time: f64) -> Result<SceneRoot> {
        let limit = self.budget.most() as usize;
        let opts = EvaluateOpts {
            temp_allocator: limited(limit),
            result_allocator: limited(limit),
            ..EvaluateOpts::default()
        };
        ufbx::evaluate_scene(&self.scene, anim, time, opts).map_err(|e| refusal(&e, limit))
    }
}

/// The name of an animation; none where it is empty.
pub(crate) fn clip_name(stack: &AnimStack) -> Option<&str> {
    Some(&*stack.element.name).filter(|name| !name.is_empty())
}

fn load(bytes: &[u8], mirrored: Option<(CoordinateAxes, MirrorAxis)>) -> Result<SceneRoot> {
    let limit = Budget::of(bytes.len() as u64).most() as usize;
    let mut opts = LoadOpts {
        temp_allocator: limited(limit),
        result_allocator: limited(limit),
        ignore_embedded: true,
        clean_skin_weights: true,
        index_error_handling: IndexErrorHandling::AbortLoading,
        node_depth_limit: DEEPEST as u32,
        ..LoadOpts::default()
    };
    if let Some((axes, mirror)) = mirrored {
        opts.target_axes = axes;
        opts.handedness_conversion_axis = mirror;
    }
    let scene = ufbx::load_memory(bytes, opts).map_err(|e| refusal(&e, limit))?;
    // It knows other formats as well, by their contents.
    if scene.metadata.file_format != FileFormat::Fbx {
        return Err(no_fbx());
    }
    Ok(scene)
}

fn limited(memory_limit: usize) -> AllocatorOpts {
    AllocatorOpts { memory_limit, ..AllocatorOpts::default() }
}

fn no_fbx() -> Error {
    Error::new("is not an FBX: it starts neither with Kaydara FBX nor with ; FBX")
}

fn refusal(error: &ufbx::Error, limit: usize) -> Error {
    Error::new(match error.type_ {
        ErrorType::EmptyFile => "is empty: export it again".to_owned(),
        ErrorType::UnrecognizedFileFormat => return no_fbx(),
        ErrorType::TruncatedFile | ErrorType::Io => {
            "ends too early: is it still being written, or was it cut off?".to_owned()
        }
        ErrorType::MemoryLimit | ErrorType::AllocationLimit | ErrorType::OutOfMemory => {
            format!("takes more than {} MiB of memory, too much for its length: export it again", limit >> 20)
        }
        ErrorType::NodeDepthLimit => format!("a node has more than {DEEPEST} ancestors, more than nabiki reads"),
        ErrorType::BadIndex => "an index is past the end of its list: export it again".to_owned(),
        ErrorType::UnsupportedVersion => "its version is not read: export FBX 2011 or later".to_owned(),
        ErrorType::Unknown => "is damaged: export it again".to_owned(),
        _ => format!("is not a readable FBX: {}", &*error.description),
    })
}

/// For axes of a left hand: those of a right one, and what is mirrored.
fn left_handed(axes: &CoordinateAxes) -> Option<(CoordinateAxes, MirrorAxis)> {
    let vector = |axis: CoordinateAxis| match axis {
        CoordinateAxis::PositiveX => DVec3::X,
        CoordinateAxis::NegativeX => DVec3::NEG_X,
        CoordinateAxis::PositiveY => DVec3::Y,
        CoordinateAxis::NegativeY => DVec3::NEG_Y,
        CoordinateAxis::PositiveZ => DVec3::Z,
        CoordinateAxis::NegativeZ => DVec3::NEG_Z,
        CoordinateAxis::Unknown => DVec3::ZERO,
    };
    let hand = DMat3::from_cols(vector(axes.right), vector(axes.up), vector(axes.front)).determinant();
    let (right, mirror) = match axes.right {
        CoordinateAxis::PositiveX => (CoordinateAxis::NegativeX, MirrorAxis::X),
        CoordinateAxis::NegativeX => (CoordinateAxis::PositiveX, MirrorAxis::X),
        CoordinateAxis::PositiveY => (CoordinateAxis::NegativeY, MirrorAxis::Y),
        CoordinateAxis::NegativeY => (CoordinateAxis::PositiveY, MirrorAxis::Y),
        CoordinateAxis::PositiveZ => (CoordinateAxis::NegativeZ, MirrorAxis::Z),
        CoordinateAxis::NegativeZ => (CoordinateAxis::PositiveZ, MirrorAxis::Z),
        CoordinateAxis::Unknown => return None,
    };
    (hand < 0.0).then_some((CoordinateAxes { right, ..*axes }, mirror))
}

/// A node's name; none if it is empty, so that it cannot be chosen.
pub(crate) fn name(node: &Node) -> Option<&str> {
    Some(&*node.element.name).filter(|name| !name.is_empty())
}

/// A node's number in its scene.
pub(crate) fn number(node: &Node) -> usize {
    node.element.typed_id as usize
}

pub(crate) fn affine(m: &ufbx::Matrix) -> DAffine3 {
    DAffine3 {
        matrix3: DMat3::from_cols(
            DVec3::new(m.m00, m.m10, m.m20),
            DVec3::new(m.m01, m.m11, m.m21),
            DVec3::new(m.m02, m.m12, m.m22),
        ),
        translation: DVec3::new(m.m03, m.m13, m.m23),
    }
}

fn is_place(transform: &DAffine3) -> bool {
    let volume = transform.matrix3.determinant();
    transform.is_finite() && volume.is_finite() && volume != 0.0
}

/// What an animation moves, by its curves.
pub(crate) struct Moved {
    /// Whether it moves each node, by number.
    pub nodes: Vec<bool>,
    /// Whether it moves each channel of a blend shape, by number.
    pub shapes: Vec<bool>,
    /// Its first and last time (s): those that the file states, or else of its keys.
    pub range: [f64; 2],
}

impl Moved {
    pub fn by(document: &Document, stack: &AnimStack) -> Self {
        let scene = &document.scene;
        let mut nodes = vec![false; scene.nodes.count];
        let mut shapes = vec![false; scene.blend_channels.count];
        let (mut first, mut last) = (f64::INFINITY, f64::NEG_INFINITY);
        for prop in stack.layers.as_ref().iter().flat_map(|layer| layer.anim_props.as_ref()) {
            for curve in prop.anim_value.curves.iter().flatten().filter(|curve| !curve.keyframes.is_empty()) {
                first = first.min(curve.min_time);
                last = last.max(curve.max_time);
                let of = match prop.element.type_ {
                    ufbx::ElementType::Node => &mut nodes,
                    ufbx::ElementType::BlendChannel => &mut shapes,
                    _ => continue,
                };
                if let Some(moved) = of.get_mut(prop.element.typed_id as usize) {
                    *moved |= !is_still(curve);
                }
            }
        }
        let stated = stack.time_end > stack.time_begin;
        let range = if stated || first > last { [stack.time_begin, stack.time_end] } else { [first, last] };
        Self { nodes, shapes, range }
    }
}

/// Whether a curve holds one value. Many programs write keys for whatever they could move.
fn is_still(curve: &AnimCurve) -> bool {
    let level = |key: &ufbx::Keyframe| key.left.dy == 0.0 && key.right.dy == 0.0;
    curve.min_value == curve.max_value && curve.keyframes.as_ref().iter().all(level)
}

/// Where a node of a chain is, and what of its scale those below it take over.
#[derive(Clone, Copy)]
pub(crate) struct Placed {
    pub scene_from_node: DAffine3,
    /// The same without the node's own scale.
    unscaled: DAffine3,
    scale: DVec3,
}

impl Placed {
    /// The root of the scene.
    pub fn root(node: &Node) -> Self {
        let scene_from_node = affine(&node.node_to_world);
        Self {
            scene_from_node,
            unscaled: affine(&node.unscaled_node_to_world),
            scale: vector(node.local_transform.scale),
        }
    }

    /// A node at a time of an animation, below the one that `above` placed. `inherited`: the scale of the node whose scale it takes
    /// over, in the two ways that FBX has besides the usual product of matrices.
    pub fn below(above: &Self, inherited: Option<DVec3>, anim: &Anim, node: &Node, time: f64) -> Self {
        let local = ufbx::evaluate_transform(anim, node, time);
        let rotation = glam::DQuat::from_xyzw(local.rotation.x, local.rotation.y, local.rotation.z, local.rotation.w);
        let (mut scale, mut translation) = (vector(local.scale), vector(local.translation));
        let mut from = above.scene_from_node;
        if node.inherit_mode != InheritMode::Normal {
            scale *= inherited.unwrap_or(DVec3::ONE);
            translation *= above.scale;
            from = above.unscaled;
        }
        Self {
            scene_from_node: from * DAffine3::from_scale_rotation_translation(scale, rotation, translation),
            unscaled: from * DAffine3::from_rotation_translation(rotation, translation),
            scale,
        }
    }

    pub fn scale(&self) -> DVec3 {
        self.scale
    }
}

pub(crate) fn vector(v: ufbx::Vec3) -> DVec3 {
    DVec3::new(v.x, v.y, v.z)
}
