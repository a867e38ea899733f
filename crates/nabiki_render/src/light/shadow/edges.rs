//! A lamp's map cut into strips of rows, with about as much to do in each.

use std::ops::Range;

use super::cells::AROUND;
use super::map::Map;
use crate::curve::CurveNode;

/// Nodes by which the hair is weighed.
const SAMPLE: usize = 4096;

/// Where strips end, and in which of them each row lies.
#[derive(Default)]
pub struct Edges {
    /// The first row of each strip, and the end of the last.
    rows: Vec<usize>,
    strips: Vec<u16>,
    /// Sampled nodes in each row.
    weights: Vec<u32>,
}

impl Edges {
    /// Cuts a map into strips that hold alike many of the nodes, as far as a sample of them tells.
    pub fn cut(&mut self, map: &Map, nodes: &[CurveNode], strips: usize) {
        let height = map.size[1];
        self.weights.clear();
        self.weights.resize(height, 0);
        let mut total = 0;
        if strips > 1 {
            for node in nodes.iter().step_by((nodes.len() / SAMPLE).max(1)) {
                let row = map.project(node.position).y as usize;
                self.weights[row.min(height - 1)] += 1;
                total += 1;
            }
        }
        self.rows.clear();
        self.strips.clear();
        self.rows.push(0);
        let mut before = 0;
        for (row, weight) in self.weights.iter().enumerate() {
            // The strip ends before the row with which it would have more than its share.
            while self.rows.len() < strips && before * strips >= self.rows.len() * total {
                self.rows.push(row);
            }
            self.strips.push(self.rows.len() as u16 - 1);
            before += *weight as usize;
        }
        self.rows.resize(strips, height);
        self.rows.push(height);
    }

    /// The strip that a place of the map is read in; none where it lies above or below the map (cells down).
    #[inline(always)]
    pub fn strip_of(&self, y: f32) -> Option<usize> {
        // Toward zero is down: what lies above the map is in no strip.
        if y >= 0.0 { self.strips.get(y as usize).map(|&strip| usize::from(strip)) } else { None }
    }

    /// The strips that hold rows so far about a place.
    #[inline(always)]
    pub fn strips_about(&self, y: f32, half_height: f32) -> Range<usize> {
        if self.rows.len() == 2 {
            return 0..1;
        }
        let beyond = half_height + AROUND as f32;
        let last = self.strips.len() - 1;
        let [first, end] = [y - beyond, y + beyond].map(|row| usize::from(self.strips[(row as usize).min(last)]));
        first..end + 1
    }

    /// The rows that a strip holds: what its receivers read lies around them.
    pub fn held(&self, strip: usize) -> Range<usize> {
        self.rows[strip].saturating_sub(AROUND)..self.rows[strip + 1] + AROUND + 1
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::curve::bounds;
    use crate::light::lamps::Lamp;
    use crate::light::shadow::Scene;

    #[test]
    fn strips_hold_alike_many_nodes_however_they_lie() {
        // Ever fewer to one side, down to a lone one.
        let position = |i: u32| Vec3::new(0.001 * i as f32, 0.0, 1e-8 * (i as f32).powi(3));
        let nodes: Vec<CurveNode> =
            (0..3000).map(|i| CurveNode { position: position(i), ..CurveNode::default() }).collect();
        let radius = vec![0.01; nodes.len()];
        let asked = vec![true; nodes.len()];
        let (bounds, width) = (bounds(&nodes), 0.02);
        let scene = Scene {
            nodes: &nodes,
            radius: &radius,
            asked: &asked,
            skin: &[],
            least_facing: 0.0,
            width,
            least_cell: 0.0,
            bounds,
        };
        for toward in [Vec3::Y, Vec3::Z, Vec3::new(0.6, 0.8, 0.0)] {
            let map = Map::new(&Lamp { toward, strength: [1.0; 3], spread: 0.0 }, &scene);
            let row = |node: &CurveNode| map.project(node.position).y;
            let mut rows = vec![0; map.size[1]];
            nodes.iter().for_each(|node| rows[row(node) as usize] += 1);
            let fullest = *rows.iter().max().unwrap();
            for strips in [1, 2, 5, 16] {
                let mut edges = Edges::default();
                edges.cut(&map, &nodes, strips);
                let mut held = vec![0; strips];
                nodes.iter().for_each(|node| held[edges.strip_of(row(node)).unwrap()] += 1);
                // An edge is where a row ends.
                let share = nodes.len() / strips;
                assert!(
                    held.iter().all(|held: &usize| held.abs_diff(share) <= fullest + 1),
                    "{toward} {strips}: {held:?}"
                );
            }
        }
    }
}
