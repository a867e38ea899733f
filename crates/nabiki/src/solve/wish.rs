//! Wishes: where some nodes should be in a frame.

use std::ops::RangeInclusive;

use glam::Vec3;

use crate::strands::Strands;

/// A node of a strand of [`Problem::hair`](super::Problem::hair): 0 is the root, which nothing moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Node {
    /// Which strand.
    pub strand: u32,
    /// Which of its points.
    pub node: u32,
}

/// Where nodes should be. What is counted from "now" is counted from the motion as the problem gives it, before anything
/// is solved.
#[derive(Clone, Debug, PartialEq)]
pub enum Goal {
    /// Each at a place of its own, in the order of the nodes (head space, cm).
    Places(Vec<Vec3>),
    /// Each moved by this from where it is now (head space, cm).
    Moved(Vec3),
    /// Their mean here (head space, cm).
    MeanAt(Vec3),
    /// Their mean moved by this from where it is now (head space, cm).
    MeanMoved(Vec3),
    /// Each where it is now: a nail.
    Stay,
}

/// A wish about one frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Wish {
    /// The frame, from 1 on.
    pub frame: u32,
    /// What should be there.
    pub nodes: Vec<Node>,
    /// Where.
    pub goal: Goal,
    /// How much it counts beside other wishes, above 0, however many nodes it has.
    pub weight: f32,
}

/// The nodes within `radius` of a point (cm), `hair` being as it is in the frame that is looked at. Roots are left out.
pub fn nodes_near(hair: &Strands, point: Vec3, radius: f32) -> Vec<Node> {
    let near = |&p: &Vec3| p.distance_squared(point) <= radius * radius;
    let of_strand = |(s, strand): (usize, &[Vec3])| {
        let nodes = (1..strand.len()).filter(|&i| near(&strand[i]));
        nodes.map(|i| Node { strand: s as u32, node: i as u32 }).collect::<Vec<_>>()
    };
    hair.iter().enumerate().flat_map(of_strand).collect()
}

/// The nodes of one strand of `points` points whose place along it, 0 at the root and 1 at the tip by count, lies in `along`.
/// The root is left out.
pub fn nodes_of(strand: u32, points: usize, along: RangeInclusive<f32>) -> Vec<Node> {
    let place = |i: usize| i as f32 / (points - 1) as f32;
    let nodes = (1..points).filter(|&i| along.contains(&place(i)));
    nodes.map(|i| Node { strand, node: i as u32 }).collect()
}
