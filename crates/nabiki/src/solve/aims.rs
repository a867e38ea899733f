//! Wishes as residuals: the observed nodes, and their distances from the goals.

use std::ops::Range;

use glam::{DVec3, Vec3};

use super::linear::Normal;
use super::problem::Problem;
use super::wish::{Goal, Wish};
use crate::dynamics::{Asked, Points};
use crate::error::SettingError;

/// All wishes of a problem.
#[derive(Clone, Debug)]
pub(super) struct Aims {
    /// The strands of the problem that wishes name, ascending.
    pub strands: Vec<usize>,
    /// The observed nodes ("spots"), ascending; strands are counted in `strands`.
    pub spots: Vec<Asked>,
    aims: Vec<Aim>,
}

/// One wish.
#[derive(Clone, Debug)]
struct Aim {
    /// Its nodes, as indices of spots.
    spots: Vec<usize>,
    /// Their positions in the motion of the problem.
    now: Vec<DVec3>,
    to: To,
    /// Its share of all wishes.
    share: f64,
}

#[derive(Clone, Debug)]
enum To {
    Each(Vec<DVec3>),
    Mean(DVec3),
}

/// Limit of the usual, as a multiple of the median strand's remaining mean square: three times as far.
const MOST: f64 = 9.0;

impl Aims {
    /// Refuses an empty list of wishes, and wishes for nothing.
    pub fn new(problem: &Problem) -> Result<Self, SettingError> {
        let Problem { hair, wishes, dynamics, .. } = problem;
        if wishes.is_empty() {
            let remedy = "has no entries, so there is nothing to solve for: give one";
            return Err(SettingError::new("wish", "", remedy));
        }
        for (i, wish) in wishes.iter().enumerate() {
            check(wish, i, problem, dynamics.motion.frames)?;
        }
        let mut strands: Vec<usize> = wishes.iter().flat_map(|w| w.nodes.iter().map(|n| n.strand as usize)).collect();
        strands.sort_unstable();
        strands.dedup();
        debug_assert!(strands.iter().all(|&s| s < hair.len()));
        let spot = |frame: u32, node: &super::wish::Node| Asked {
            strand: strands.partition_point(|&s| s < node.strand as usize),
            frame,
            node: node.node as usize,
        };
        let mut spots: Vec<Asked> =
            wishes.iter().flat_map(|wish| wish.nodes.iter().map(|node| spot(wish.frame, node))).collect();
        spots.sort_unstable();
        spots.dedup();
        let sum: f64 = wishes.iter().map(|wish| f64::from(wish.weight)).sum();
        let aim = |wish: &Wish| {
            let place = |node| spots.partition_point(|&other| other < spot(wish.frame, node));
            Aim {
                spots: wish.nodes.iter().map(place).collect(),
                now: Vec::new(),
                to: To::Each(Vec::new()),
                share: f64::from(wish.weight) / sum,
            }
        };
        let aims = wishes.iter().map(aim).collect();
        Ok(Self { strands, spots, aims })
    }

    /// Reads the motion of the problem, and sets the goals relative to it.
    pub fn set_now(&mut self, places: &[DVec3], wishes: &[Wish]) {
        for (aim, wish) in self.aims.iter_mut().zip(wishes) {
            aim.now = aim.spots.iter().map(|&spot| places[spot]).collect();
            aim.set(&wish.goal);
        }
    }

    /// Sets another goal for a wish; it has been checked.
    pub fn set_goal(&mut self, wish: usize, goal: &Goal) {
        self.aims[wish].set(goal);
    }

    /// Lets only one wish count.
    pub fn leave_only(&mut self, wish: usize) {
        for (i, aim) in self.aims.iter_mut().enumerate() {
            aim.share = if i == wish { 1.0 } else { 0.0 };
        }
    }

    /// The observed frames, ascending.
    pub fn frames(&self) -> Vec<u32> {
        let mut frames: Vec<u32> = self.spots.iter().map(|spot| spot.frame).collect();
        frames.sort_unstable();
        frames.dedup();
        frames
    }

    /// The positions of a wish's nodes.
    pub fn places(&self, wish: usize, places: &[DVec3]) -> Vec<Vec3> {
        self.aims[wish].spots.iter().map(|&spot| places[spot].as_vec3()).collect()
    }

    /// Weighted mean square of the remaining distances of all wishes (cm^2).
    pub fn mean_square(&self, places: &[DVec3]) -> f64 {
        self.aims.iter().map(|aim| aim.share * aim.mean_square(places)).sum()
    }

    /// Root mean square of the remaining distance of each wish (cm).
    pub fn left(&self, places: &[DVec3]) -> Vec<f64> {
        self.aims.iter().map(|aim| aim.mean_square(places).sqrt()).collect()
    }

    /// Whether some wish for places has enough strands for most of them to differ from all of them.
    pub fn tell_most(&self) -> bool {
        self.aims.iter().any(|aim| {
            let strands = aim.spots.chunk_by(|a, b| self.spots[*a].strand == self.spots[*b].strand).count();
            matches!(aim.to, To::Each(_)) && strands > 2
        })
    }

    /// For each wish for places, the usual remaining distance: [`MOST`] times that of the median strand (mean square, cm^2).
    pub fn usual(&self, places: &[DVec3]) -> Vec<f64> {
        let of = |aim: &Aim| {
            let mut squares: Vec<f64> = self.by_strand(aim, places).map(|(_, square)| square).collect();
            squares.sort_by(f64::total_cmp);
            (squares.get(squares.len() / 2).copied().unwrap_or_default() * MOST).max(f64::MIN_POSITIVE)
        };
        self.aims.iter().map(of).collect()
    }

    /// Like [`mean_square`](Self::mean_square), but a strand much farther from its places than is [usual](Self::usual)
    /// counts hardly more than one at that distance: its square s counts as s u / (s + u).
    pub fn mean_square_of_most(&self, places: &[DVec3], usual: &[f64]) -> f64 {
        let of = |(aim, &usual): (&Aim, &f64)| {
            let each: f64 = (self.by_strand(aim, places))
                .map(|(spots, square)| spots.len() as f64 * square * usual / (usual + square))
                .sum();
            let square = if let To::Each(_) = aim.to { each / aim.spots.len() as f64 } else { aim.mean_square(places) };
            aim.share * square
        };
        self.aims.iter().zip(usual).map(of).sum()
    }

    /// The strands of a wish for places: the range of nodes of each, and its remaining distance (mean square, cm^2).
    fn by_strand(&self, aim: &Aim, places: &[DVec3]) -> impl Iterator<Item = (Range<usize>, f64)> {
        let goals = if let To::Each(goals) = &aim.to { &goals[..] } else { &[] };
        let alike = |a: &usize, b: &usize| self.spots[*a].strand == self.spots[*b].strand;
        let mut begin = 0;
        aim.spots[..goals.len()].chunk_by(alike).map(move |spots| {
            let range = begin..begin + spots.len();
            begin = range.end;
            let squares = spots.iter().zip(&goals[range.clone()]);
            let sum: f64 = squares.map(|(&spot, goal)| places[spot].distance_squared(*goal)).sum();
            (range, sum / spots.len() as f64)
        })
    }

    /// Adds the residuals to the normal equations. `places`: of the spots, which number the residuals; `points` has
    /// their tangents. `usual`: the remaining distance of [most](Self::usual) strands, if outliers are to count little.
    pub fn add_to(&self, normal: &mut Normal, places: &[DVec3], points: &Points, usual: Option<&[f64]>) {
        let n = normal.n;
        let row = |spot: usize, axis: usize| &points.tangents[(3 * spot + axis) * n..][..n];
        let mut mean = vec![0.0; n];
        for (i, aim) in self.aims.iter().enumerate() {
            let count = aim.spots.len() as f64;
            match &aim.to {
                To::Each(goals) => {
                    for (nodes, square) in self.by_strand(aim, places) {
                        let part = usual.map_or(1.0, |usual| (usual[i] / (usual[i] + square)).powi(2));
                        for (&spot, goal) in aim.spots[nodes.clone()].iter().zip(&goals[nodes]) {
                            let left = places[spot] - goal;
                            for axis in 0..3 {
                                normal.add(part * aim.share / count, left[axis], row(spot, axis));
                            }
                        }
                    }
                }
                To::Mean(goal) => {
                    let left = aim.mean(places) - goal;
                    for axis in 0..3 {
                        mean.fill(0.0);
                        for &spot in &aim.spots {
                            for (sum, tangent) in mean.iter_mut().zip(row(spot, axis)) {
                                *sum += tangent / count;
                            }
                        }
                        normal.add(aim.share, left[axis], &mean);
                    }
                }
            }
        }
    }
}

impl Aim {
    fn set(&mut self, goal: &Goal) {
        let now = || self.now.iter().sum::<DVec3>() / self.now.len() as f64;
        self.to = match goal {
            Goal::Places(places) => To::Each(places.iter().map(|p| p.as_dvec3()).collect()),
            Goal::Moved(by) => To::Each(self.now.iter().map(|&p| p + by.as_dvec3()).collect()),
            Goal::MeanAt(place) => To::Mean(place.as_dvec3()),
            Goal::MeanMoved(by) => To::Mean(now() + by.as_dvec3()),
            Goal::Stay => To::Each(self.now.clone()),
        };
    }

    fn mean(&self, places: &[DVec3]) -> DVec3 {
        self.spots.iter().map(|&spot| places[spot]).sum::<DVec3>() / self.spots.len() as f64
    }

    fn mean_square(&self, places: &[DVec3]) -> f64 {
        match &self.to {
            To::Mean(goal) => self.mean(places).distance_squared(*goal),
            To::Each(goals) => {
                let squares = self.spots.iter().zip(goals).map(|(&spot, goal)| places[spot].distance_squared(*goal));
                squares.sum::<f64>() / self.spots.len() as f64
            }
        }
    }
}

/// Refuses an invalid goal, or one for another number of nodes.
pub(super) fn check_goal(goal: &Goal, nodes: usize, wish: usize) -> Result<(), SettingError> {
    let finite = |thing: &str, v: &Vec3| match v.is_finite() {
        true => Ok(()),
        false => Err(SettingError::new(format!("wish[{wish}].{thing}"), v, "must be three finite numbers (cm)")),
    };
    match goal {
        Goal::Stay => Ok(()),
        Goal::Moved(by) => finite("moved", by),
        Goal::MeanAt(place) => finite("mean_at", place),
        Goal::MeanMoved(by) => finite("mean_moved", by),
        Goal::Places(places) if places.len() != nodes => {
            let value = format!("{} places", places.len());
            let remedy = format!("the wish has {nodes} nodes: give a place for each, or one mean place");
            Err(SettingError::new(format!("wish[{wish}].places"), value, remedy))
        }
        Goal::Places(places) => places.iter().try_for_each(|place| finite("places", place)),
    }
}

fn check(wish: &Wish, i: usize, problem: &Problem, frames: u32) -> Result<(), SettingError> {
    let refused =
        |key: &str, value: String, remedy: String| Err(SettingError::new(format!("wish[{i}].{key}"), value, remedy));
    if !(1..=frames).contains(&wish.frame) {
        let remedy = format!("hair moves in frames 1 to {frames} of the scene");
        return refused("frame", wish.frame.to_string(), remedy);
    }
    if !(wish.weight.is_finite() && wish.weight > 0.0) {
        return refused("weight", wish.weight.to_string(), "must be a finite number above 0".to_owned());
    }
    if wish.nodes.is_empty() {
        return refused("nodes", String::new(), "has no entries: give a larger radius".to_owned());
    }
    for node in &wish.nodes {
        let strand = node.strand as usize;
        if strand >= problem.hair.len() {
            let remedy = format!("must be one of the {} strands, 0 to {}", problem.hair.len(), problem.hair.len() - 1);
            return refused("strands", node.strand.to_string(), remedy);
        }
        let points = problem.hair.strand(strand).len();
        if node.node == 0 || node.node as usize >= points {
            let remedy = format!("only nodes 1 to {} of strand {strand} move", points - 1);
            return refused("nodes", node.node.to_string(), remedy);
        }
    }
    check_goal(&wish.goal, wish.nodes.len(), i)
}
