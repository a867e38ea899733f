//! Locks: nodes that are pulled together.

use glam::Vec3;
use nabiki::Strands;
use nabiki::solve::{Goal, Node, Wish};

/// Nodes that are pulled together, in one frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Lock {
    /// The frame.
    pub frame: u32,
    /// Strand and index of each node.
    pub nodes: Vec<(usize, usize)>,
}

impl Lock {
    /// The lock around a node: from each of the first `among` strands with a node within `radius` (cm), the node
    /// nearest to it, without roots. The strand of that node comes first, then the others by distance. `points` are
    /// those of the strands in this frame.
    pub fn about(
        frame: u32,
        points: &[Vec3],
        strands: &Strands,
        among: usize,
        (held, at): (usize, usize),
        radius: f32,
    ) -> Self {
        let place = points[strands.range(held)][at];
        let mut near: Vec<(f32, usize, usize)> = (0..strands.len().min(among))
            .filter_map(|strand| {
                if strand == held {
                    return Some((-1.0, strand, at));
                }
                let of = points[strands.range(strand)].iter().enumerate().skip(1);
                let nearest = of.map(|(node, p)| (p.distance_squared(place), node)).min_by(|a, b| a.0.total_cmp(&b.0));
                nearest
                    .filter(|(squared, _)| *squared <= radius * radius)
                    .map(|(squared, node)| (squared, strand, node))
            })
            .collect();
        near.sort_by(|a, b| a.0.total_cmp(&b.0));
        Self { frame, nodes: near.into_iter().map(|(_, strand, node)| (strand, node)).collect() }
    }

    /// The middle of its nodes (head space, cm) for these points of the strands.
    pub fn middle(&self, points: &[Vec3], strands: &Strands) -> Vec3 {
        let sum: Vec3 = self.nodes.iter().map(|&(strand, node)| points[strands.range(strand)][node]).sum();
        sum / self.nodes.len().max(1) as f32
    }

    /// Whether all its nodes exist in these strands.
    pub fn fits(&self, strands: &Strands) -> bool {
        self.nodes.iter().all(|&(strand, node)| strand < strands.len() && node < strands.range(strand).len())
    }

    pub(super) fn wish(&self, goal: Goal, weight: f32) -> Wish {
        let nodes = self.nodes.iter().map(|&(strand, node)| Node { strand: strand as u32, node: node as u32 });
        Wish { frame: self.frame, nodes: nodes.collect(), goal, weight }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lock_is_what_has_a_node_within_its_radius() {
        let mut strands = Strands::default();
        for [x, z] in [[12.0, 0.0], [12.0, 1.0], [12.0, -2.5], [12.0, 6.0]] {
            strands.push((0..10).map(|k| Vec3::new(x, 5.0 - k as f32, z)));
        }
        let lock = |among, radius| Lock::about(3, strands.points(), &strands, among, (1, 5), radius).nodes;
        assert_eq!(lock(usize::MAX, 2.0), [(1, 5), (0, 5)]);
        assert_eq!(lock(usize::MAX, 0.0), [(1, 5)]);
        assert_eq!(lock(usize::MAX, 100.0).len(), 4);
        assert_eq!(lock(2, 100.0).len(), 2, "of those at hand");
    }
}
