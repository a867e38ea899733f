//! The interface of readers of grooms, for all formats.

use glam::{DAffine3, DMat4, DQuat, DVec3, Vec3};
use nabiki::{Hair, Mesh};

use crate::Problem;
use crate::control::Course;
use crate::in_place::InPlace;

/// The message about a mesh whose points move, where only one shape is read.
pub const FIRST_SHAPE: &str = "it keeps the shape of the first frame";

/// The same where it is read as it was bound to its joints.
pub const BOUND_SHAPE: &str = "it keeps the shape in which it was bound";

/// A file of curves, meshes and transforms. All results are in the file's unit and axes.
pub trait GroomReader {
    /// What the file holds and says of itself, without reading its values.
    ///
    /// # Errors
    /// What is wrong with the file; a unit or an up axis that is none.
    fn contents(&mut self) -> Result<Contents, Problem>;

    /// What stands in the file, in its order, with the sizes of curves and meshes.
    ///
    /// # Errors
    /// What is wrong with the file.
    fn prims(&mut self) -> Result<Vec<Prim>, Problem>;

    /// From now on only the curves at these paths are read, and what else there are is as if it were not.
    fn keep_curves(&mut self, paths: Vec<String>);

    /// All curves at frame `frame` of [`Contents::times`] (the last one after those), one after another, and the
    /// transform above them.
    ///
    /// `segments`: walks every curve into as many; `None` keeps polylines as they are. `attributes`: whether what the
    /// curves carry is read, too. Curves in several objects that have no groups of their own are grouped by object,
    /// under its name. Closed curves, such as the path of a camera, are left out beside open ones, and that is said.
    ///
    /// # Errors
    /// No curves, none that are open, numbers that contradict each other or are not finite.
    fn hair_in_place(&mut self, frame: usize, segments: Option<usize>, attributes: bool) -> Result<InPlace, Problem>;

    /// All curves with their attributes at a frame, transforms applied.
    ///
    /// # Errors
    /// As [`hair_in_place`](Self::hair_in_place); points that the transforms take out of the range of numbers.
    fn hair(&mut self, frame: usize, segments: Option<usize>) -> Result<Hair, Problem> {
        self.hair_in_place(frame, segments, true)?.in_world()
    }

    /// The meshes at the first frame, cut into triangles, transforms applied, as one: of those whose path is `wanted` the
    /// ones that show, or all where none does. With what is left out of their texture coordinates, a phrase each: the
    /// shape does without.
    ///
    /// # Errors
    /// No mesh, or one whose numbers contradict each other.
    fn meshes_with_losses(&mut self, wanted: &dyn Fn(&str) -> bool) -> Result<(Mesh, Vec<String>), Problem>;

    /// The meshes alone, as [`meshes_with_losses`](Self::meshes_with_losses).
    ///
    /// # Errors
    /// As there.
    fn meshes(&mut self, wanted: &dyn Fn(&str) -> bool) -> Result<Mesh, Problem> {
        Ok(self.meshes_with_losses(wanted)?.0)
    }

    /// What [`meshes`](Self::meshes) leaves out of those that are wanted or does not obey, a phrase each.
    ///
    /// # Errors
    /// What is wrong with the file.
    fn meshes_unread(&mut self, wanted: &dyn Fn(&str) -> bool) -> Result<Vec<String>, Problem>;

    /// All meshes of the file, as [`meshes`](Self::meshes).
    ///
    /// # Errors
    /// As there.
    fn mesh(&mut self) -> Result<Mesh, Problem> {
        self.meshes(&|_| true)
    }

    /// What [`mesh`](Self::mesh) leaves out or does not obey, a phrase each.
    ///
    /// # Errors
    /// What is wrong with the file.
    fn mesh_unread(&mut self) -> Result<Vec<String>, Problem> {
        self.meshes_unread(&|_| true)
    }

    /// The way of the object at the path `node`, or of the first of that name, at all times at which it moves.
    ///
    /// # Errors
    /// No such object, with those that there are; a transform that flattens space.
    fn motion(&mut self, node: &str) -> Result<Vec<Placed>, Problem>;

    /// The joint of a skeleton that carries the meshes whose path is `wanted`, by its path below that of the skeleton; `None` where none
    /// is bound to any.
    ///
    /// # Errors
    /// What is wrong with the file.
    fn joint_of_meshes(&mut self, _wanted: &dyn Fn(&str) -> bool) -> Result<Option<String>, Problem> {
        Ok(None)
    }

    /// The times (s) at which the meshes whose path is `wanted` bend: their points, joints or blend shapes move. Empty where they
    /// only go as a whole.
    ///
    /// # Errors
    /// What is wrong with the file.
    fn bending_times(&mut self, _wanted: &dyn Fn(&str) -> bool) -> Result<Vec<f64>, Problem> {
        Ok(Vec::new())
    }

    /// The vertices of those meshes at a time (s), transforms applied, in the order of [`meshes`](Self::meshes).
    ///
    /// # Errors
    /// What is wrong with the file.
    fn bent_meshes(&mut self, wanted: &dyn Fn(&str) -> bool, time: f64) -> Result<Vec<Vec3>, Problem>;

    /// Where that object is in the pose in which [`meshes`](Self::meshes) has what is bound to it; none where that is the first of its
    /// way.
    ///
    /// # Errors
    /// What is wrong with the file.
    fn bound(&mut self, _node: &str) -> Result<Option<Placed>, Problem> {
        Ok(None)
    }
}

/// The contents of a file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Contents {
    /// Paths of objects with curves.
    pub curves: Vec<String>,
    /// Paths of meshes.
    pub meshes: Vec<String>,
    /// Times of the curves' frames (s). Empty for curves that do not move.
    pub times: Vec<f64>,
    /// Start of the shot (s): the first of several frames of the curves, or the time that the file gives; `None` if
    /// there is neither.
    pub start: Option<f64>,
    /// Frames per second; 24 if the file does not say.
    pub frame_rate: f64,
    /// Length of the unit (m), if the file says.
    pub meters_per_unit: Option<f64>,
    /// Whether z is up, if the file says.
    pub z_up: Option<bool>,
}

impl Contents {
    /// Number of the first frame, counting frames from time 0.
    pub fn first_frame(&self) -> i32 {
        (self.times.first().unwrap_or(&0.0) * self.frame_rate).round() as i32
    }
}

/// One object of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Prim {
    /// Its path.
    pub path: String,
    /// Its kind.
    pub kind: PrimKind,
    /// Number of samples over time of its most animated property; 0 or 1 if nothing moves.
    pub samples: usize,
    /// What it is bound to, in the file's terms: `material:binding`.
    pub relationships: Vec<String>,
}

/// The kind of an object in a file.
#[derive(Clone, Debug, PartialEq)]
pub enum PrimKind {
    /// Curves.
    Curves {
        /// How many.
        curves: usize,
        /// Their control points.
        points: usize,
        /// How the curves run between these.
        course: Course,
        /// Takes them to the file's world at the first frame.
        world_from_curves: DAffine3,
        /// Whether a skeleton moves them.
        bound: bool,
    },
    /// A mesh of polygons.
    Mesh {
        /// How many polygons.
        faces: usize,
        /// Vertices.
        points: usize,
    },
    /// A transform of the objects below it.
    Transform,
    /// A skeleton, with the paths of its joints.
    Skeleton {
        /// The joints.
        joints: Vec<String>,
    },
    /// Anything else, in the file's terms.
    Other(String),
}

/// Which curves to read, by path: all, unless some are chosen.
#[derive(Clone, Debug, Default)]
pub struct Kept(Option<Vec<String>>);

impl Kept {
    /// Only these.
    pub fn only(paths: Vec<String>) -> Self {
        Self(Some(paths))
    }

    /// Whether to read the curves at a path.
    pub fn holds(&self, path: &str) -> bool {
        self.0.as_ref().is_none_or(|paths| paths.iter().any(|kept| kept == path))
    }
}

/// The position of an object at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placed {
    /// Time (s).
    pub time: f64,
    /// Origin of the object in the world (the file's unit).
    pub position: DVec3,
    /// Its rotation in the world.
    pub rotation: DQuat,
    /// Its scale.
    pub scale: DVec3,
    /// Whether its axes are not orthogonal. Rotation and scale are then not the complete transform.
    pub sheared: bool,
}

impl Placed {
    /// The position of an object with this world transform at a time (s).
    pub fn of(time: f64, world: &DMat4) -> Self {
        const NORMAL: f64 = 1e-4;
        let (scale, rotation, position) = world.to_scale_rotation_translation();
        let [x, y, z] = [world.x_axis, world.y_axis, world.z_axis].map(|axis| axis.truncate().normalize_or_zero());
        let sheared = [x.dot(y), y.dot(z), z.dot(x)].into_iter().any(|cosine| cosine.abs() > NORMAL);
        Self { time, position, rotation, scale, sheared }
    }
}
