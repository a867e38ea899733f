//! Which bones lead each strand, and how well.

use glam::{DVec3, Vec3};
use nabiki::Strands;

use super::chain::{Bone, Guide};

/// Of this many guides nearest to a root, the best two lead the strand.
const TRIED: usize = 16;
/// Places along a strand at which it is compared with its guides, the last one its tip.
const PLACES: usize = 4;

/// All strands in some of the frames.
#[derive(Clone, Debug)]
pub(super) struct Sampled {
    frame: u32,
    every: u32,
    /// Numbers of the frames.
    frames: Vec<usize>,
    /// For each strand the indices of its points that are compared.
    places: Vec<[usize; PLACES]>,
    /// These points, frame by frame.
    points: Vec<Vec3>,
}

impl Sampled {
    /// Of these strands at rest, in at most `most` of `frames` frames.
    pub fn new(rest: &Strands, frames: u32, most: u32) -> Self {
        let place = |s: usize| {
            let last = rest.strand(s).len() - 1;
            std::array::from_fn(|i| (last * (i + 1)).div_ceil(PLACES))
        };
        let every = frames.div_ceil(most).max(1);
        Self { frame: 0, every, frames: Vec::new(), places: (0..rest.len()).map(place).collect(), points: Vec::new() }
    }

    /// Takes the next frame.
    pub fn push(&mut self, now: &Strands) {
        if self.frame.is_multiple_of(self.every) {
            self.frames.push(self.frame as usize);
            for (s, places) in self.places.iter().enumerate() {
                let strand = now.strand(s);
                self.points.extend(places.map(|at| strand[at]));
            }
        }
        self.frame += 1;
    }

    /// The compared points of a strand in all sampled frames.
    fn way(&self, s: usize) -> Vec<DVec3> {
        let first = |n: usize| (n * self.places.len() + s) * PLACES;
        let of = |n: usize| self.points[first(n)..first(n) + PLACES].iter().map(|p| p.as_dvec3());
        (0..self.frames.len()).flat_map(of).collect()
    }
}

/// What leads a point: four joints by their numbers (guide by guide), and their weights, which sum to 255.
pub(super) type Influence = ([u16; 4], [u8; 4]);

/// Two guides of a strand, and the share of the first.
#[derive(Clone, Copy, Debug)]
struct Led {
    guides: [usize; 2],
    share: f64,
}

/// What leads every point, and how far from where they were simulated the compared points are: the mean and the largest
/// distance.
pub(super) fn bind(rest: &Strands, guides: &[Guide], sampled: &Sampled) -> (Vec<Influence>, [f64; 2]) {
    let bones: Vec<Poses> = guides.iter().map(|guide| poses(guide, sampled)).collect();
    let (mut bound, mut sum, mut most, mut count) = (Vec::with_capacity(rest.points().len()), 0.0, 0.0_f64, 0_u64);
    for (s, strand) in rest.iter().enumerate() {
        let near = nearest(guides.iter().map(|guide| guide.rest[0]), strand[0]);
        let lengths = lengths(strand);
        // Where each guide takes the compared points in each sampled frame.
        let followed = Followed { places: &sampled.places[s], strand, lengths: &lengths };
        let taken: Vec<Vec<DVec3>> = near.iter().map(|&g| followed.by(&guides[g], &bones[g])).collect();
        let wanted = sampled.way(s);
        let (led, apart) = best(&taken, &wanted);
        for distance in apart {
            (sum, most, count) = (sum + distance, most.max(distance), count + 1);
        }
        let led = Led { guides: led.guides.map(|at| near[at]), ..led };
        bound.extend(lengths.iter().map(|&along| influence(guides, led, along)));
    }
    (bound, [sum / count.max(1) as f64, most])
}

/// The bones of a guide in every sampled frame.
type Poses = Vec<Vec<Bone>>;

fn poses(guide: &Guide, sampled: &Sampled) -> Poses {
    sampled.frames.iter().map(|&frame| guide.bones(frame)).collect()
}

/// A strand at rest that may follow a guide.
struct Followed<'a> {
    places: &'a [usize; PLACES],
    strand: &'a [Vec3],
    lengths: &'a [f32],
}

impl Followed<'_> {
    /// Where a guide takes the compared points in each sampled frame.
    fn by(&self, guide: &Guide, poses: &Poses) -> Vec<DVec3> {
        let place = |bones: &[Bone], at: usize| taken(bones, guide, self.lengths[at], self.strand[at].as_dvec3());
        poses.iter().flat_map(|bones| self.places.map(|at| place(bones, at))).collect()
    }
}

/// Chooses `count` of the candidates, of which the first are spread most evenly: those from which, each among its nearest,
/// the others are led best.
pub(super) fn choose(rest: &Strands, mut candidates: Vec<Guide>, count: usize, sampled: &Sampled) -> Vec<Guide> {
    /// Rounds of assigning candidates to guides, and of choosing each guide anew among its own.
    const ROUNDS: usize = 6;
    let poses: Vec<Poses> = candidates.iter().map(|guide| poses(guide, sampled)).collect();
    let ways: Vec<Vec<DVec3>> = candidates.iter().map(|guide| sampled.way(guide.strand)).collect();
    let lengths: Vec<Vec<f32>> = candidates.iter().map(|guide| lengths(rest.strand(guide.strand))).collect();
    // How badly one candidate leads another: the sum of the squared distances.
    let cost = |led: usize, by: usize| -> f64 {
        let s = candidates[led].strand;
        let led_strand = Followed { places: &sampled.places[s], strand: rest.strand(s), lengths: &lengths[led] };
        let taken = led_strand.by(&candidates[by], &poses[by]);
        taken.iter().zip(&ways[led]).map(|(a, b)| a.distance_squared(*b)).sum()
    };
    let root = |c: usize| candidates[c].rest[0];
    let mut chosen: Vec<usize> = (0..count.min(candidates.len())).collect();
    for _ in 0..ROUNDS {
        let mut own: Vec<Vec<usize>> = vec![Vec::new(); chosen.len()];
        for c in 0..candidates.len() {
            let near = nearest(chosen.iter().map(|&guide| root(guide)), root(c));
            let best = near.into_iter().map(|g| (cost(c, chosen[g]), g)).min_by(|a, b| a.0.total_cmp(&b.0));
            if let Some((_, g)) = best {
                own[g].push(c);
            }
        }
        let before = chosen.clone();
        for (guide, own) in chosen.iter_mut().zip(&own) {
            let all = |by: usize| own.iter().map(|&led| cost(led, by)).sum::<f64>();
            let best = own.iter().map(|&by| (all(by), by)).min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            *guide = best.map_or(*guide, |(_, by)| by);
        }
        if chosen == before {
            break;
        }
    }
    chosen.sort_unstable();
    let mut at = 0;
    candidates.retain(|_| {
        at += 1;
        chosen.binary_search(&(at - 1)).is_ok()
    });
    candidates
}

/// The numbers of the roots nearest to a place, nearest first; of roots at the same distance, the lower number first.
fn nearest(roots: impl Iterator<Item = Vec3>, place: Vec3) -> Vec<usize> {
    let mut all: Vec<(f32, usize)> = roots.enumerate().map(|(g, root)| (root.distance_squared(place), g)).collect();
    let order = |a: &(f32, usize), b: &(f32, usize)| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1));
    if all.len() > TRIED {
        all.select_nth_unstable_by(TRIED, order);
        all.truncate(TRIED);
    }
    all.sort_by(order);
    all.into_iter().map(|(_, g)| g).collect()
}

/// The length of hair up to each point.
fn lengths(strand: &[Vec3]) -> Vec<f32> {
    let mut along = 0.0;
    let further = strand.windows(2).map(|ends| {
        along += ends[0].distance(ends[1]);
        along
    });
    std::iter::once(0.0).chain(further.collect::<Vec<_>>()).collect()
}

/// The best two of the guides, or one of them alone, by the mean square of the distances; and the distances that remain.
fn best(taken: &[Vec<DVec3>], wanted: &[DVec3]) -> (Led, Vec<f64>) {
    let mixed = |led: Led| -> Vec<f64> {
        let [a, b] = led.guides.map(|guide| &taken[guide]);
        let pairs = a.iter().zip(b).zip(wanted);
        pairs.map(|((a, b), wanted)| b.lerp(*a, led.share).distance(*wanted)).collect()
    };
    let square = |of: &[f64]| of.iter().map(|distance| distance * distance).sum::<f64>();
    let mut found = (Led { guides: [0; 2], share: 1.0 }, mixed(Led { guides: [0; 2], share: 1.0 }));
    for first in 0..taken.len() {
        for second in 0..first {
            let (a, b) = (&taken[first], &taken[second]);
            // The share that leaves the least: (wanted - b) along (a - b).
            let (mut along, mut across) = (0.0, 0.0);
            for ((a, b), wanted) in a.iter().zip(b).zip(wanted) {
                along += (*wanted - *b).dot(*a - *b);
                across += (*a - *b).length_squared();
            }
            let share = if across > 0.0 { (along / across).clamp(0.0, 1.0) } else { 1.0 };
            let led = Led { guides: [first, second], share };
            let left = mixed(led);
            if square(&left) < square(&found.1) {
                found = (led, left);
            }
        }
    }
    found
}

/// The two bones of a guide that share a point this far along, and the share of the second.
fn shared(guide: &Guide, along: f32) -> ([usize; 2], f32) {
    let bones = guide.rest.len() - 1;
    let length = guide.along[bones].max(f32::MIN_POSITIVE);
    // From the middle of one bone to that of the next.
    let place = (along / length * bones as f32 - 0.5).clamp(0.0, bones as f32 - 1.0);
    let first = (place as usize).min(bones - 1);
    ([first, (first + 1).min(bones - 1)], place - first as f32)
}

/// Where a guide takes a point at rest that is this far along its strand.
fn taken(bones: &[Bone], guide: &Guide, along: f32, p: DVec3) -> DVec3 {
    let ([first, second], part) = shared(guide, along);
    bones[first].takes(p).lerp(bones[second].takes(p), part.into())
}

/// What leads a point this far along.
fn influence(guides: &[Guide], led: Led, along: f32) -> Influence {
    let mut joints = [0; 4];
    let mut weights = [0.0; 4];
    for (i, (guide, share)) in led.guides.into_iter().zip([led.share, 1.0 - led.share]).enumerate() {
        let (bones, part) = shared(&guides[guide], along);
        let before = guide * (guides[guide].rest.len() - 1);
        joints[2 * i] = (before + bones[0]) as u16;
        joints[2 * i + 1] = (before + bones[1]) as u16;
        weights[2 * i] = share * f64::from(1.0 - part);
        weights[2 * i + 1] = share * f64::from(part);
    }
    let weights = whole(weights);
    // The number of a joint without a weight is 0.
    joints.iter_mut().zip(weights).filter(|(_, weight)| *weight == 0).for_each(|(joint, _)| *joint = 0);
    (joints, weights)
}

/// Weights that sum to 1 in parts of 255, as near as they can: what rounding leaves goes to the largest.
fn whole(weights: [f64; 4]) -> [u8; 4] {
    let mut parts = weights.map(|weight| (255.0 * weight).round() as i32);
    let largest = (0..4).max_by(|&a, &b| weights[a].total_cmp(&weights[b])).unwrap_or(0);
    parts[largest] += 255 - parts.iter().sum::<i32>();
    parts.map(|part| part.clamp(0, 255) as u8)
}
