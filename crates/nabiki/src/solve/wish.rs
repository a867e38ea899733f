//! Wishes: where some nodes should be in a frame.

use std::ops::RangeInclusive;

use glam::Vec3;

use crate::strands::Strands;

/// A node of a strand of [`Problem::hair`](super::Problem::hair). Node 0 is the root, which never moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Node {
    /// Index of the strand.
    pub strand: u32,
    /// Index of the point in the strand.
    pub node: u32,
}

/// Where nodes should be. "Now" is the motion of the problem before the search.
#[derive(Clone, Debug, PartialEq)]
pub enum Goal {
    /// Each node at its own place, in the order of the nodes (head space, cm).
    Places(Vec<Vec3>),
    /// Each node moved by this from where it is now (head space, cm).
    Moved(Vec3),
    /// The mean of the nodes here (head space, cm).
    MeanAt(Vec3),
    /// The mean of the nodes moved by this from where it is now (head space, cm).
    MeanMoved(Vec3),
    /// Each node where it is now: a nail.
    Stay,
}

/// A wish about one frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Wish {
    /// The frame, from 1 on.
    pub frame: u32,
    /// The nodes that should be there.
    pub nodes: Vec<Node>,
    /// Where they should be.
    pub goal: Goal,
    /// Weight relative to other wishes, above 0. It does not depend on the number of nodes.
    pub weight: f32,
}

/// The nodes within `radius` of a point (cm), without roots. `hair` is the hair in the frame in question.
pub fn nodes_near(hair: &Strands, point: Vec3, radius: f32) -> Vec<Node> {
    let near = |&p: &Vec3| p.distance_squared(point) <= radius * radius;
    let of_strand = |(s, strand): (usize, &[Vec3])| {
        let nodes = (1..strand.len()).filter(|&i| near(&strand[i]));
        nodes.map(|i| Node { strand: s as u32, node: i as u32 }).collect::<Vec<_>>()
    };
    hair.iter().enumerate().flat_map(of_strand).collect()
}

/// The nodes of one strand of `points` points whose position along it (0 at the root, 1 at the tip, by count) lies in
/// `along`, without the root.
pub fn nodes_of(strand: u32, points: usize, along: RangeInclusive<f32>) -> Vec<Node> {
    let place = |i: usize| i as f32 / (points - 1) as f32;
    let nodes = (1..points).filter(|&i| along.contains(&place(i)));
    nodes.map(|i| Node { strand, node: i as u32 }).collect()
}
