//! Reasons why a wish is not met.

use glam::{DVec3, Vec3};

use super::{Damping, Solver};
use crate::body::Body;
use crate::dynamics::Form;
use crate::obstacle::Reading;
use crate::solve::Node;

/// Why a wish is not met: the first of these reasons that applies. `Length` comes after a nail and a force if it
/// explains less than half of the remaining distance.
#[derive(Clone, Debug, PartialEq)]
pub enum Stop {
    /// The goal is farther from the roots than the length of the hair up to its nodes (cm, means). Roots are where hair
    /// starts to be free.
    Length {
        /// Distance from the roots to the goal.
        away_cm: f64,
        /// Length of the hair.
        reach_cm: f64,
    },
    /// A body is in the way: the goal lies in it, or the hair lies on it. This is its name; `contact` is the head.
    Body(String),
    /// Another wish holds the hair. This is its index. Without it, the goal or half of the remaining distance would be
    /// reached.
    Nail(usize),
    /// The wish needs a stronger force (as counted by the field's bound) than is stable for this hair.
    Force {
        /// The strongest stable force.
        strongest: f32,
    },
    /// The unknowns cannot bring the hair there: the wind of this many frames up to the wish's frame.
    Unknowns {
        /// Number of frames in which the unknowns act.
        frames: u32,
    },
}

/// A body, and the position of a point relative to it: the distance, the clearance of the hair (cm), and the way out (head space).
struct Beside<'a> {
    name: &'a str,
    distance: f32,
    margin: f32,
    out: DVec3,
}

/// Share of its length to which a wind can draw out hair.
const TAUT: f64 = 0.98;
/// Hair this near to a body lies on it (cm, besides its clearance).
const TOUCHES_CM: f32 = 0.1;
/// Steps to find out whether a nail holds the hair.
const STEPS: usize = 12;
/// A step that leaves more than this share of the remaining distance (squared) gains nothing.
const WORTH: f64 = 0.96;

impl Solver {
    /// Why a wish with this remaining distance (cm) is not met in the current motion. It computes a few motions to see
    /// what would happen without the other wishes. `goal` is where the mean of the nodes should be (head space, cm). It
    /// may differ from the goal of this solver if its hair stands for other hair.
    pub fn stopped_by(&mut self, wish: usize, goal: Vec3, left_cm: f64) -> Stop {
        let goal = goal.as_dvec3();
        let length = self.by_length(wish, goal);
        let is_most = |stop: &Stop| matches!(stop, Stop::Length { away_cm, reach_cm } if 2.0 * (away_cm - TAUT * reach_cm) >= left_cm);
        length
            .clone()
            .filter(is_most)
            .or_else(|| self.by_goal_in_body(wish, goal))
            .or_else(|| self.by_nail(wish, left_cm))
            .or_else(|| self.by_force())
            .or(length)
            .or_else(|| self.by_touch(wish, goal))
            .unwrap_or_else(|| self.by_unknowns(wish))
    }

    fn by_length(&self, wish: usize, goal: DVec3) -> Option<Stop> {
        let nodes = &self.problem.wishes[wish].nodes;
        let (mut root, mut reach) = (DVec3::ZERO, 0.0);
        for node in nodes {
            let strand = self.problem.hair.strand(node.strand as usize);
            let held = match &self.problem.dynamics.form {
                Form::Paper => 0,
                Form::Free(free) => free.form.tie.map_or(0, |tie| tie.held(strand)),
            };
            let held = held.min(node.node as usize);
            root += strand[held].as_dvec3();
            let free = strand[held..=node.node as usize].windows(2);
            reach += free.map(|pair| f64::from(pair[0].distance(pair[1]))).sum::<f64>();
        }
        let count = nodes.len() as f64;
        let (away_cm, reach_cm) = (goal.distance(root / count), reach / count);
        (away_cm > TAUT * reach_cm).then_some(Stop::Length { away_cm, reach_cm })
    }

    /// The bodies near a point (head space, cm) in the frame of a wish, each with its distance and the way out. The margin is that of
    /// the strand that is kept farthest off.
    fn bodies<'a>(&'a self, wish: usize, point: DVec3) -> Vec<Beside<'a>> {
        let Form::Free(free) = &self.problem.dynamics.form else { return Vec::new() };
        let frame = self.problem.wishes[wish].frame;
        let head = self.problem.poses.get(frame as usize).copied().unwrap_or_default();
        let strand = |node: &Node| self.problem.hair.strand(node.strand as usize);
        let nodes = self.problem.wishes[wish].nodes.iter();
        let times = nodes.map(|node| free.own(strand(node)).margin).fold(0.0, f64::max) as f32;
        let of_body = |body: &'a Body| {
            let head_from_body = body.head_from_body(frame, &head);
            let there = head_from_body.inverse().transform_point3(point.as_vec3());
            let Reading { distance, gradient, .. } = body.shape.obstacle().read(there, frame)?;
            let out = head_from_body.transform_vector3(gradient).as_dvec3();
            Some(Beside { name: &body.name, distance, margin: times * body.contact.margin, out })
        };
        free.bodies.iter().filter_map(of_body).collect()
    }

    fn by_goal_in_body(&self, wish: usize, goal: DVec3) -> Option<Stop> {
        let within = self.bodies(wish, goal).into_iter().find(|body| body.distance < 0.0);
        within.map(|body| Stop::Body(body.name.to_owned()))
    }

    /// Whether the hair lies on a body that is in its way to the goal.
    fn by_touch(&self, wish: usize, goal: DVec3) -> Option<Stop> {
        let places = self.aims.places(wish, &self.at.places);
        let count = places.len() as f64;
        let middle = places.iter().map(|p| p.as_dvec3()).sum::<DVec3>() / count;
        let way = goal - middle;
        let mut touching: Vec<(&str, usize)> = Vec::new();
        for place in &places {
            for Beside { name, distance, margin, out } in self.bodies(wish, place.as_dvec3()) {
                if distance < margin + TOUCHES_CM && out.dot(way) < 0.0 {
                    match touching.iter_mut().find(|(known, _)| *known == name) {
                        Some((_, times)) => *times += 1,
                        None => touching.push((name, 1)),
                    }
                }
            }
        }
        let most = touching.into_iter().max_by_key(|(_, times)| *times)?;
        (2 * most.1 >= places.len()).then(|| Stop::Body(most.0.to_owned()))
    }

    /// Whether it comes nearer without the other wishes; if so, the one that then yields most.
    fn by_nail(&mut self, wish: usize, left: f64) -> Option<Stop> {
        if self.problem.wishes.len() < 2 {
            return None;
        }
        let (at, damping, aims) = (self.at.clone(), self.damping, self.aims.clone());
        self.aims.leave_only(wish);
        self.at.cost = self.cost(&self.at.x, &self.at.places);
        self.damping = Damping::default();
        for _ in 0..STEPS {
            if !self.descend_once() {
                break;
            }
        }
        let free = self.aims.left(&self.at.places)[wish];
        let moved = aims.left(&self.at.places);
        (self.at, self.damping, self.aims) = (at, damping, aims);
        if free > 0.5 * left {
            return None;
        }
        let others = (0..moved.len()).filter(|&other| other != wish);
        others.max_by(|&a, &b| moved[a].total_cmp(&moved[b])).map(Stop::Nail)
    }

    /// Whether the force of the next step from the nearest motion is too strong, and no shorter step gains anything.
    fn by_force(&mut self) -> Option<Stop> {
        let (at, damping) = (self.at.clone(), self.damping);
        self.too_strong = false;
        self.damping = Damping::default();
        self.descend_once();
        let gained = self.at.cost < WORTH * at.cost;
        (self.at, self.damping) = (at, damping);
        (self.too_strong && !gained).then(|| Stop::Force { strongest: self.steady.strongest_force() })
    }

    fn by_unknowns(&self, wish: usize) -> Stop {
        let frame = self.problem.wishes[wish].frame;
        Stop::Unknowns { frames: frame.saturating_sub(self.begin.frame()) }
    }
}
