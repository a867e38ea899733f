//! What a layer keeps of its skeletons, so that each is read once.

use std::collections::HashMap;
use std::rc::Rc;

use glam::DMat4;

/// A skeleton and what moves it.
#[derive(Clone)]
pub struct Rig {
    /// The prim.
    pub skeleton: usize,
    /// The joints, each by its path in the skeleton: `hips/neck/head`.
    pub joints: Vec<String>,
    /// The joint above each.
    pub parents: Vec<Option<usize>>,
    /// What is bound to it.
    pub animation: Option<Animation>,
}

/// An animation of a skeleton's joints.
#[derive(Clone)]
pub struct Animation {
    /// The prim.
    pub prim: usize,
    /// Number of its joints.
    pub count: usize,
    /// The number that each joint of the skeleton has in it.
    pub numbers: Vec<Option<usize>>,
}

/// The rigs of a layer that were asked for, and where the joints of one of them were at a time code.
#[derive(Default)]
pub struct Rigs {
    /// By the skeleton's prim.
    pub by_skeleton: HashMap<usize, Rc<Rig>>,
    /// Where the joints of each were when meshes were bound to it, if it says so.
    pub bound: HashMap<usize, Option<Rc<[DMat4]>>>,
    /// The skeleton, the time code and the joints then.
    pub posed: Option<(usize, f64, Rc<Poses>)>,
}

/// Where each joint is in the skeleton's space; none for joints that neither an animation nor a rest transform places.
pub type Poses = [Option<DMat4>];
