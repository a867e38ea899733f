//! Hair in the way of a lamp: how many fibres the light has crossed before it arrives.
//!
//! In the spirit of deep opacity maps (Yuksel and Keyser 2008), but without layers: everything is sorted by its distance from
//! the lamp, then taken in that order. Each node first reads, from a map of the lamp's view, how much fibre was laid down
//! there so far, then lays down its own. Long pieces are cut into parts, which each lie at their own distance. Reading and laying are
//! both spread over 2 x 2 cells in proportion, so neither cells nor layers show. What lies wholly in the shadow of the head or a body
//! neither reads nor lays: the lamp does not reach it, nor what is behind it.

mod cells;
mod edges;
mod item;
mod list;
mod map;
mod strip;

use std::sync::atomic::{AtomicU32, Ordering};

use glam::Vec3;
use rayon::prelude::*;

use self::edges::Edges;
use self::list::List;
use self::map::Map;
use self::strip::Strip;
use super::headlight::SolidShadows;
use super::lamps::Lamp;
use crate::curve::CurveNode;

/// Nodes that one task looks at.
const CHUNK: usize = 8192;

/// The fibres in front of each node and each place on the skin, as seen from one lamp.
#[derive(Default)]
pub struct Crossings {
    counts: Vec<AtomicU32>,
}

impl Crossings {
    /// Mean number of fibres between the lamp and receiver `i`: nodes first, then places on the skin. 0 where nobody asked.
    #[inline(always)]
    pub fn at(&self, i: usize) -> f32 {
        f32::from_bits(self.counts[i].load(Ordering::Relaxed))
    }

    #[cfg(test)]
    pub fn of(counts: &[f32]) -> Self {
        Self { counts: counts.iter().map(|count| AtomicU32::new(count.to_bits())).collect() }
    }
}

/// What the lamp sees: nodes that lay down fibre, and places on the skin that only read.
pub struct Scene<'a> {
    pub nodes: &'a [CurveNode],
    /// Half thickness of the hair at each node (cm).
    pub radius: &'a [f32],
    /// Whether it is asked how many fibres are before each node.
    pub asked: &'a [bool],
    pub skin: &'a [SkinPlace],
    /// Skin whose cosine of the angle to the lamp is not above this is not lit by it, and does not read.
    pub least_facing: f32,
    /// Thickness of the hair at its thickest (cm).
    pub width: f32,
    /// What the side of a map's cell (cm) is at least, in a draft; 0 elsewhere.
    pub least_cell: f32,
    /// Lowest and highest corner of the box about the nodes.
    pub bounds: [Vec3; 2],
}

/// A place on the skin, or a little off it, and the skin's unit normal (head space, cm).
#[derive(Clone, Copy)]
pub struct SkinPlace {
    pub at: Vec3,
    pub normal: Vec3,
}

/// Working memory of one lamp.
#[derive(Default)]
pub struct Sweep {
    edges: Edges,
    /// Chunk by chunk of the nodes and then of the skin, what each has for each strip.
    chunks: Vec<Vec<List>>,
    strips: Vec<Strip>,
    pub crossings: Crossings,
}

/// Counts for each lamp the fibres before every node that is asked for and every place on skin. `solids` are those of the lamps, if any.
/// Each map is cut into so many `strips`, a task each: their number changes no bit.
pub fn sweep(sweeps: &mut Vec<Sweep>, lamps: &[Lamp], solids: &[SolidShadows], scene: &Scene, strips: usize) {
    sweeps.resize_with(lamps.len(), Sweep::default);
    let prepared = sweeps.par_iter_mut().zip(lamps).map(|(sweep, lamp)| sweep.prepare(lamp, scene, strips));
    let maps: Vec<Map> = prepared.collect();
    if scene.nodes.is_empty() {
        return;
    }
    // All lamps' tasks in one row: none waits within a task, with another's begun meanwhile on top of it.
    let chunks = sweeps.par_iter_mut().zip(&maps).enumerate().flat_map(|(l, (sweep, map))| {
        let Sweep { edges, chunks, .. } = sweep;
        let (edges, solids): (&Edges, _) = (edges, solids.get(l));
        chunks.par_iter_mut().enumerate().map(move |(chunk, lists)| (chunk, lists, edges, map, solids))
    });
    chunks.for_each(|(chunk, lists, edges, map, solids)| {
        let total = scene.nodes.len() + scene.skin.len();
        let (start, end) = (chunk * CHUNK, total.min((chunk + 1) * CHUNK));
        let last_node = end.min(scene.nodes.len());
        let mut lists = list::Lists { map, edges, lists };
        lists.clear();
        lists.add_hair(scene, solids, start..last_node);
        lists.add_skin(scene, last_node.max(start)..end);
    });
    let strips = sweeps.par_iter_mut().zip(&maps).flat_map(|(sweep, map)| {
        let Sweep { edges, chunks, strips, crossings } = sweep;
        let (edges, chunks, crossings): (&Edges, &[Vec<List>], &Crossings) = (edges, chunks, crossings);
        strips.par_iter_mut().enumerate().map(move |(s, strip)| (s, strip, edges, chunks, map, crossings))
    });
    strips.for_each(|(s, strip, edges, chunks, map, crossings)| {
        strip.sort(chunks.iter().map(|lists| &lists[s]), map.slabs);
        strip.walk(edges.held(s), map.size[0], scene.nodes.len(), &crossings.counts);
    });
}

impl Sweep {
    /// Makes room for what a lamp's map will hold.
    fn prepare(&mut self, lamp: &Lamp, scene: &Scene, strips: usize) -> Map {
        let total = scene.nodes.len() + scene.skin.len();
        self.crossings.counts.clear();
        self.crossings.counts.resize_with(total, Default::default);
        let map = Map::new(lamp, scene);
        self.edges.cut(&map, scene.nodes, strips);
        self.strips.resize_with(strips, Strip::default);
        self.chunks.resize_with(total.div_ceil(CHUNK), Vec::new);
        self.chunks.iter_mut().for_each(|lists| lists.resize_with(strips, List::default));
        map
    }
}

impl Scene<'_> {
    /// Mean thickness of the hair from node `i` to the next (cm).
    #[inline(always)]
    fn thickness(&self, i: usize) -> f32 {
        self.radius[i] + self.radius[i + 1]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::bounds;

    fn crossings(lamp: &Lamp, scene: &Scene, strips: usize) -> Crossings {
        let mut sweeps = Vec::new();
        sweep(&mut sweeps, std::slice::from_ref(lamp), &[], scene, strips);
        sweeps.remove(0).crossings
    }

    #[test]
    fn the_bits_do_not_depend_on_the_number_of_strips() {
        let nodes: Vec<CurveNode> = (0..3000_u32)
            .map(|i| {
                let strand = i / 10;
                let turn = crate::camera::direction(strand as f32 * 137.508, strand as f32 * 0.6 - 90.0);
                let position = (4.0 + 0.02 * strand as f32) * turn + 1.3 * (i % 10) as f32 * Vec3::NEG_Y;
                CurveNode { position, tangent: Vec3::NEG_Y, strand, ..CurveNode::default() }
            })
            .collect();
        let lamp = Lamp { toward: crate::camera::direction(30.0, 42.0), strength: [1.0; 3], spread: 0.03 };
        let skin = [Vec3::ZERO, Vec3::new(0.3, -20.0, 0.1)].map(|at| SkinPlace { at, normal: Vec3::Y });
        let radius = vec![0.05; nodes.len()];
        let asked = vec![true; nodes.len()];
        let scene = Scene {
            nodes: &nodes,
            radius: &radius,
            asked: &asked,
            skin: &skin,
            least_facing: 0.0,
            width: 0.1,
            least_cell: 0.0,
            bounds: bounds(&nodes),
        };
        let counted = |strips: usize| -> Vec<u32> {
            let crossings = crossings(&lamp, &scene, strips);
            (0..nodes.len() + skin.len()).map(|i| crossings.at(i).to_bits()).collect()
        };
        let whole = counted(1);
        assert!(whole.iter().filter(|&&bits| bits != 0).count() > nodes.len() / 2);
        for strips in [2, 3, 7, 64] {
            assert_eq!(counted(strips), whole, "{strips} strips");
        }
    }

    #[test]
    fn hair_that_faces_the_lamp_aslant_does_not_lie_in_its_own_shadow() {
        // One layer of long straight hairs side by side.
        let spacing = 0.02;
        let nodes: Vec<CurveNode> = (0..4000_u32)
            .map(|i| {
                let (strand, k) = (i / 8, i % 8);
                let position = Vec3::new(2.0 * k as f32 + 0.3 * (strand % 7) as f32, 0.0, spacing * strand as f32);
                CurveNode { position, tangent: Vec3::X, strand, ..CurveNode::default() }
            })
            .collect();
        let radius = vec![0.007; nodes.len()];
        let asked = vec![true; nodes.len()];
        let scene = Scene {
            nodes: &nodes,
            radius: &radius,
            asked: &asked,
            skin: &[],
            least_facing: 0.0,
            width: 0.014,
            least_cell: 0.0,
            bounds: bounds(&nodes),
        };
        for elevation in [15.0, 40.0, 75.0] {
            let lamp = Lamp { toward: crate::camera::direction(0.0, elevation), strength: [1.0; 3], spread: 0.03 };
            let crossings = crossings(&lamp, &scene, 1);
            let mean = (0..nodes.len()).map(|i| crossings.at(i)).sum::<f32>() / nodes.len() as f32;
            // Light crosses the layer once. Of hair beside it, what is nearer by less than half a part's depth is not before it.
            assert!(mean < 0.25 * 2.0 * 0.007 / spacing, "{elevation}: {mean}");
        }
    }

    /// Layers of hairs along x, side by side along z, each half a centimetre above the one before, the lowest in the plane y = 0.
    struct Layers {
        nodes: Vec<CurveNode>,
        radius: Vec<f32>,
    }

    impl Layers {
        fn new(count: u32, spacing: f32, radius: f32, across: std::ops::Range<i32>) -> Self {
            let strands = (0..count).flat_map(|layer| across.clone().map(move |side| (layer, side))).enumerate();
            let nodes: Vec<CurveNode> = strands
                .flat_map(|(strand, (layer, side))| {
                    (0..12).map(move |k| {
                        // No two neighbours have their nodes side by side.
                        let x = 2.0 * k as f32 - 11.0 + 0.3 * (strand % 7) as f32;
                        let position = Vec3::new(x, 0.5 * layer as f32, spacing * side as f32);
                        CurveNode { position, tangent: Vec3::X, strand: strand as u32, ..CurveNode::default() }
                    })
                })
                .collect();
            Self { radius: vec![radius; nodes.len()], nodes }
        }

        /// The fibres before places on skin that faces up.
        fn before(&self, lamp: &Lamp, places: impl Iterator<Item = Vec3>) -> Vec<f32> {
            let skin: Vec<SkinPlace> = places.map(|at| SkinPlace { at, normal: Vec3::Y }).collect();
            let scene = Scene {
                nodes: &self.nodes,
                radius: &self.radius,
                asked: &vec![false; self.nodes.len()],
                skin: &skin,
                least_facing: 0.0,
                width: 2.0 * self.radius[0],
                least_cell: 0.0,
                bounds: bounds(&self.nodes),
            };
            let crossings = crossings(lamp, &scene, 1);
            (0..skin.len()).map(|i| crossings.at(self.nodes.len() + i)).collect()
        }
    }

    #[test]
    fn light_crosses_of_each_layer_as_many_hairs_as_their_width_over_their_spacing() {
        let (spacing, radius) = (0.02, 0.004);
        for count in [1, 3] {
            let layers = Layers::new(count, spacing, radius, -350..350);
            for elevation in [30.0_f32, 55.0, 90.0] {
                for (azimuth, closer) in [(0.0, 1.0), (90.0, elevation.to_radians().sin())] {
                    let lamp =
                        Lamp { toward: crate::camera::direction(azimuth, elevation), strength: [1.0; 3], spread: 0.0 };
                    // Behind all layers by 2 cm, at places that lie each otherwise between hairs.
                    let places = (0..100).map(|i| Vec3::new(0.0, 0.0, 0.0037 * i as f32) - 2.0 * lamp.toward);
                    let found = layers.before(&lamp, places);
                    let mean = found.iter().sum::<f32>() / found.len() as f32;
                    // A lamp over the hairs' length sees them as far apart as they lie, one aside nearer to one another.
                    let wanted = count as f32 * 2.0 * radius / (spacing * closer);
                    // A place is the mean of some ten hairs, whose places are rounded to some thousandths of a cell.
                    assert!((mean / wanted - 1.0).abs() < 0.02, "{count} {azimuth} {elevation}: {mean} for {wanted}");
                }
            }
        }
    }

    #[test]
    fn the_edge_of_a_shadow_of_hair_is_as_wide_as_its_lamp() {
        // Half a plane of hair.
        let layers = Layers::new(1, 0.02, 0.01, 0..250);
        let width = |spread: f32| {
            let lamp = Lamp { toward: Vec3::Y, strength: [1.0; 3], spread };
            let step = 0.01;
            let found = layers.before(&lamp, (-250..=250).map(|i| Vec3::new(0.0, -2.0, step * i as f32)));
            // The integral of a share and what is left of it is in proportion to the width of an edge.
            found.iter().map(|count| step * count * (1.0 - count).max(0.0)).sum::<f32>()
        };
        let [narrow, wide, wider] = [0.0, 0.2, 0.4].map(width);
        // How the edge lies in the cells is a part of their width.
        let ratio = 0.4_f32.tan() / 0.2_f32.tan();
        assert!((wider / wide / ratio - 1.0).abs() < 0.25 && wide > 2.0 * narrow, "{narrow} {wide} {wider}");
    }
}
