//! Moving hair as a skinned mesh for games: `.glb` with chains of joints, their animation, and hair bound to them.
//!
//! Some strands, the guides, are evenly spread and become chains. Every strand follows two guides near its root, those
//! that take it nearest to where it was simulated. Only the joints are animated, so the file stays small.

mod bind;
mod chain;
mod glb;

use std::io;
use std::path::Path;

use glam::{DAffine3, DMat3, Vec3};
use nabiki::Strands;
use nabiki::subset::evenly;
use nabiki_exchange::{Export, FrameSink};
use nabiki_file::PartFile;

use bind::{Sampled, bind, choose};
use chain::Guide;

use crate::gltf_write::{colour, gltf_from_file, on_head};

/// How hair is turned into chains.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChainOptions {
    /// Number of chains, at least 1; fewer if there are fewer strands.
    pub chains: u32,
    /// Joints of a chain, at least 1.
    pub joints: u32,
    /// Width of the ribbons that strands are drawn as (cm). 0 draws lines, which few engines bind to joints.
    pub cards: f32,
    /// Settings of VRM's spring bones for the chains, for games that move hair themselves; `None` for none.
    pub springs: Option<Springs>,
}

/// How VRM's spring bones move like the hair, at 60 steps per second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Springs {
    /// `stiffness`: what turns a bone back, in metres per step and second.
    pub stiffness: f64,
    /// `dragForce`: the share of its speed that a bone loses in a step.
    pub drag: f64,
}

impl Springs {
    /// Steps per second that engines take with VRM's spring bones: their drag counts steps.
    const STEPS_PER_S: f64 = 60.0;

    /// For hair that is turned back with this acceleration (m/s^2), by hold and by what supports its weight, and whose swings
    /// fall to 1/e in `settle` seconds.
    pub fn new(back: f64, settle: f64) -> Self {
        // A step adds stiffness times its length to the way of the tail; drag takes its share of the way of the step before.
        let drag = 1.0 - (-2.0 / (Self::STEPS_PER_S * settle)).exp();
        Self { stiffness: back / Self::STEPS_PER_S, drag }
    }
}

impl Default for ChainOptions {
    fn default() -> Self {
        Self { chains: 64, joints: 8, cards: 0.4, springs: None }
    }
}

impl ChainOptions {
    /// Most joints in a file: readers store their numbers in 16 bits.
    pub const MOST_JOINTS: u32 = 65_535;

    /// Half the width of ribbons (m); `None` draws lines.
    pub(crate) fn half_width(&self) -> Option<f32> {
        (self.cards > 0.0).then_some(0.5 * 0.01 * self.cards)
    }

    /// Refuses no chains, no joints, too many of both, and a width below 0.
    ///
    /// # Errors
    /// What is wrong, as a phrase.
    pub fn check(&self) -> Result<(), String> {
        let Self { chains, joints, cards, .. } = *self;
        let all = u64::from(chains) * u64::from(joints);
        if all == 0 {
            return Err(format!("{chains}x{joints}: give at least 1x1"));
        }
        if all > u64::from(Self::MOST_JOINTS) {
            return Err(format!("{chains}x{joints} are {all} joints: a file holds at most {}", Self::MOST_JOINTS));
        }
        if !(cards >= 0.0 && cards.is_finite()) {
            return Err(format!("cards of {cards} cm: give a width, or 0 for lines"));
        }
        Ok(())
    }
}

/// So many strands for each chain may become its guide.
const CANDIDATES: u64 = 12;
/// Memory for the ways of these, and for those of the chains alone.
const MOST_BYTES: u64 = 256 << 20;
const MOST_WAYS: u64 = 4 << 30;
/// Bytes of a vertex of a ribbon, with its indices.
const VERTEX_BYTES: u64 = 52;

/// Frames in which hair and its chains are compared, at most.
const COMPARED: u32 = 16;

/// A file of chains that is being written. It is made at the end, from what its chains did.
pub(crate) struct JointChains<'a> {
    file: PartFile,
    export: Export<'a>,
    options: ChainOptions,
    gltf_from_file: DAffine3,
    guides: Vec<Guide>,
    sampled: Sampled,
    /// The head's node in each frame.
    heads: Vec<DAffine3>,
    room: Vec<Vec3>,
}

impl<'a> JointChains<'a> {
    /// Begins the file.
    ///
    /// # Errors
    /// What the disk says; hair that is not fit to be written.
    pub fn create(path: &Path, export: Export<'a>, options: ChainOptions) -> io::Result<Self> {
        export.check()?;
        options.check().map_err(|problem| io::Error::new(io::ErrorKind::InvalidInput, problem))?;
        let gltf_from_file = gltf_from_file(&export);
        let rest = on_head(&(gltf_from_file * export.file_from_head), &export.hair.strands);
        let roots: Vec<Vec3> = rest.iter().map(|strand| strand[0]).collect();
        // Their way through all frames must fit into memory.
        let bytes = (u64::from(options.joints) + 1) * u64::from(export.frames) * size_of::<Vec3>() as u64;
        let chains = u64::from(options.chains).min(export.hair.strands.len() as u64);
        let vertices = 2 * export.hair.strands.points().len() as u64;
        if bytes * chains > MOST_WAYS || vertices * VERTEX_BYTES > u64::from(u32::MAX) {
            let problem = "a .glb holds less than 4 GiB: show fewer strands or frames, or lower --export-chains";
            return Err(io::Error::new(io::ErrorKind::InvalidInput, problem));
        }
        let most = (MOST_BYTES / bytes).min(u64::from(options.chains) * CANDIDATES).max(u64::from(options.chains));
        let guides = evenly(&roots, most as usize);
        let guides = guides.into_iter().map(|s| Guide::new(s, rest.strand(s), options.joints as usize)).collect();
        let sampled = Sampled::new(&rest, export.frames, COMPARED);
        let file = PartFile::create(path)?;
        Ok(Self { file, export, options, gltf_from_file, guides, sampled, heads: Vec::new(), room: Vec::new() })
    }
}

/// Refuses a transform above the hair that is more than a turn and a shift.
fn check_rigid(parent: &DAffine3) -> io::Result<()> {
    let off = parent.matrix3.transpose() * parent.matrix3 - DMat3::IDENTITY;
    if off.to_cols_array().iter().all(|x| x.abs() < 1e-4) {
        return Ok(());
    }
    let problem = "the transform above the hair scales or shears it, which joints cannot: apply the scale in the program that the \
                   hair comes from";
    Err(io::Error::new(io::ErrorKind::InvalidInput, problem))
}

impl JointChains<'_> {
    fn gltf_from_head(&self) -> DAffine3 {
        self.gltf_from_file * self.export.file_from_head
    }
}

impl FrameSink for JointChains<'_> {
    fn frame(&mut self, strands: &Strands, world_from_head: &DAffine3) -> io::Result<()> {
        // Refuses strands that do not match.
        self.export.points(strands, &mut self.room)?;
        let now = on_head(&self.gltf_from_head(), strands);
        self.guides.iter_mut().for_each(|guide| guide.push(&now));
        self.sampled.push(&now);
        let parent = DAffine3::from_mat4(self.export.parent(world_from_head));
        check_rigid(&parent)?;
        self.heads.push(self.gltf_from_file * parent * self.gltf_from_file.inverse());
        Ok(())
    }

    fn finish(mut self: Box<Self>) -> io::Result<Option<String>> {
        let gltf_from_head = self.gltf_from_head();
        let rest = on_head(&gltf_from_head, &self.export.hair.strands);
        let candidates = std::mem::take(&mut self.guides);
        self.guides = choose(&rest, candidates, self.options.chains as usize, &self.sampled);
        let (bound, apart) = bind(&rest, &self.guides, &self.sampled);
        let head = self.export.head.map(|mesh| {
            let points = mesh.positions.iter();
            let points = points.map(|p| gltf_from_head.transform_point3(p.as_dvec3()).as_vec3()).collect();
            (points, &mesh.triangles[..])
        });
        let scene = glb::Scene {
            rest: &rest,
            center: gltf_from_head.translation.as_vec3(),
            bound: &bound,
            guides: &self.guides,
            heads: &self.heads,
            frame_rate: self.export.frame_rate,
            colour: colour(&self.export),
            half_width: self.options.half_width(),
            head,
            springs: self.options.springs,
        };
        glb::write(&scene, &mut self.file)?;
        self.file.finish()?;
        let [mean, most] = apart.map(|metres| 100.0 * metres);
        let (chains, joints) = (self.guides.len(), self.options.joints);
        Ok(Some(format!(
            "{chains} chains of {joints} joints; the skinned hair is {mean:.2} cm from the simulated on average, {most:.1} cm \
             at most"
        )))
    }
}

#[cfg(test)]
mod tests;
