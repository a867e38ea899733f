//! Lines that go on in one another, put together.

use std::collections::{HashMap, HashSet};

use glam::Vec3;

use crate::error::{Error, Result};

/// `l` elements by the numbers of their vertices.
#[derive(Default)]
pub(super) struct Lines {
    vertices: Vec<u32>,
    /// Where those of each end.
    ends: Vec<usize>,
    /// The line of the file that each stands in.
    numbers: Vec<usize>,
}

/// An end of a line: twice its number, and one more for the last.
type End = usize;

/// No end.
const NONE: End = End::MAX;

/// What meets at a vertex.
#[derive(Clone)]
struct Met {
    /// The first two ends.
    ends: [End; 2],
    /// Whether there is more, ends or lines that pass.
    more: bool,
    /// Whether all of it is edges.
    edges: bool,
}

impl Default for Met {
    fn default() -> Self {
        Self { ends: [NONE; 2], more: false, edges: true }
    }
}

impl Met {
    /// Adds the end of a line, or one that passes.
    fn add(&mut self, end: Option<End>, edge: bool) {
        self.edges &= edge;
        match (end, self.ends.iter_mut().find(|free| **free == NONE)) {
            (Some(end), Some(free)) => *free = end,
            _ => self.more = true,
        }
    }
}

impl Lines {
    /// Adds an element; `false` for one without vertices.
    pub fn push(&mut self, vertices: impl Iterator<Item = Result<u32>>, number: usize) -> Result<bool> {
        let before = self.vertices.len();
        for vertex in vertices {
            self.vertices.push(vertex?);
        }
        self.ends.push(self.vertices.len());
        self.numbers.push(number);
        Ok(self.vertices.len() > before)
    }

    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    fn len(&self) -> usize {
        self.ends.len()
    }

    fn line(&self, line: usize) -> &[u32] {
        let start = if line == 0 { 0 } else { self.ends[line - 1] };
        &self.vertices[start..self.ends[line]]
    }

    /// The vertex at an end.
    fn at(&self, end: End) -> u32 {
        let line = self.line(end / 2);
        line[if is_last(end) { line.len() - 1 } else { 0 }]
    }

    fn is_edge(&self, line: usize) -> bool {
        let line = self.line(line);
        line.len() == 2 && line[0] != line[1]
    }

    fn is_closed(&self, line: usize) -> bool {
        let line = self.line(line);
        line.len() > 2 && line[0] == line[line.len() - 1]
    }

    /// Strands by their vertices, each of one line or of several, and how many lines were closed.
    ///
    /// # Errors
    /// Edges that branch.
    pub fn joined(mut self, places: &[Vec3]) -> Result<(Vec<Vec<u32>>, usize)> {
        self.drop_repeated_edges();
        let all_edges = (0..self.len()).all(|line| self.is_edge(line));
        let mut next = self.next(places.len(), |vertex| vertex as usize)?;
        if all_edges && next.iter().all(|&end| end == NONE) {
            // Some programs give each edge vertices of its own. Edges that branch by place alone are left as they are.
            let first = first_at_its_place(places);
            next = self.next(places.len(), |vertex| first[vertex as usize]).unwrap_or(next);
        }
        let mut taken: Vec<bool> = (0..self.len()).map(|line| self.is_closed(line)).collect();
        let mut closed = taken.iter().filter(|&&closed| closed).count();
        let mut strands: Vec<(usize, Vec<u32>)> = Vec::new();
        for end in 0..next.len() {
            // Chains have two open ends; what is left after them goes round.
            if next[end] == NONE && !taken[end / 2] {
                strands.push(self.chain(&next, &mut taken, end));
            }
        }
        for line in 0..self.len() {
            closed += usize::from(!taken[line]);
            let mut end = 2 * line;
            while !std::mem::replace(&mut taken[end / 2], true) {
                end = next[other(end)];
            }
        }
        strands.sort_by_key(|&(first, _)| first);
        let mut strands: Vec<Vec<u32>> = strands.into_iter().map(|(_, strand)| strand).collect();
        if all_edges && strands.len() < self.len() {
            // In the order of their vertices, whatever that of their edges.
            strands.sort_by_key(|strand| strand[0]);
        }
        Ok((strands, closed))
    }

    /// An edge that is given twice is one edge.
    fn drop_repeated_edges(&mut self) {
        let mut known = HashSet::new();
        let kept: Vec<usize> = (0..self.len())
            .filter(|&line| {
                let [a, b] = [self.at(2 * line), self.at(2 * line + 1)];
                !self.is_edge(line) || known.insert([a.min(b), a.max(b)])
            })
            .collect();
        if kept.len() < self.len() {
            let mut lines = Self::default();
            for line in kept {
                lines.vertices.extend(self.line(line));
                lines.ends.push(lines.vertices.len());
                lines.numbers.push(self.numbers[line]);
            }
            *self = lines;
        }
    }

    /// The end at which each goes on: where exactly two ends meet, of two edges, or the last of one line and the first of another.
    /// `of`: the number by which a vertex is known, of `count`.
    ///
    /// # Errors
    /// Three edges at one vertex.
    fn next(&self, count: usize, of: impl Fn(u32) -> usize) -> Result<Vec<End>> {
        let mut met = vec![Met::default(); count];
        for line in 0..self.len() {
            let edge = self.is_edge(line);
            if let [first, between @ .., last] = self.line(line) {
                met[of(*first)].add(Some(2 * line), edge);
                met[of(*last)].add(Some(2 * line + 1), edge);
                between.iter().for_each(|&vertex| met[of(vertex)].add(None, false));
            }
        }
        if let Some(vertex) = met.iter().position(|met| met.more && met.edges) {
            return Err(self.branch(vertex, of));
        }
        let mut next = vec![NONE; 2 * self.len()];
        for Met { ends: [one, other], more, edges } in met {
            if !more && other != NONE && one / 2 != other / 2 && (edges || is_last(one) != is_last(other)) {
                (next[one], next[other]) = (other, one);
            }
        }
        Ok(next)
    }

    /// The refusal of a vertex at which edges branch.
    fn branch(&self, vertex: usize, of: impl Fn(u32) -> usize) -> Error {
        let meets = |&line: &usize| self.line(line).iter().any(|&v| of(v) == vertex);
        let edges: Vec<usize> = (0..self.len()).filter(meets).collect();
        let why = format!(
            "{} edges meet at vertex {}, but strands do not branch: give each strand its own vertices",
            edges.len(),
            vertex + 1
        );
        Error::new(why).at_line(edges.get(2).map(|&line| self.numbers[line]))
    }

    /// The vertices from an open end on to the other, of edges alone from that which stands first in the file; before them the first
    /// of its lines.
    fn chain(&self, next: &[End], taken: &mut [bool], begun: End) -> (usize, Vec<u32>) {
        let (mut end, mut first, mut vertices) = (begun, begun / 2, Vec::new());
        // Which way a line of more than two vertices goes in it.
        let mut backward = None;
        loop {
            let line = end / 2;
            taken[line] = true;
            first = first.min(line);
            if !self.is_edge(line) {
                backward = Some(is_last(end));
            }
            // The vertex at which it goes on is there already.
            let shared = usize::from(!vertices.is_empty());
            match is_last(end) {
                false => vertices.extend(self.line(line).iter().skip(shared)),
                true => vertices.extend(self.line(line).iter().rev().skip(shared)),
            }
            match next[other(end)] {
                NONE => break,
                following => end = following,
            }
        }
        let of_edges = || if end == begun { is_last(begun) } else { vertices[vertices.len() - 1] < vertices[0] };
        if backward.unwrap_or_else(of_edges) {
            vertices.reverse();
        }
        (first, vertices)
    }
}

fn is_last(end: End) -> bool {
    end % 2 == 1
}

/// The other end of the same line.
fn other(end: End) -> End {
    end ^ 1
}

/// Of each vertex the number of the first at its place.
fn first_at_its_place(places: &[Vec3]) -> Vec<usize> {
    let mut known = HashMap::with_capacity(places.len());
    // Adding 0 turns -0 into 0.
    let first = |(v, p): (usize, &Vec3)| *known.entry((*p + 0.0).to_array().map(f32::to_bits)).or_insert(v);
    places.iter().enumerate().map(first).collect()
}

#[cfg(test)]
mod tests {
    use crate::obj_lines::from_bytes;

    /// The x of each strand's points in a file of vertices at x = 1, 2, 3 .. and of these elements.
    fn strands(vertices: usize, elements: &[&str]) -> Vec<Vec<f32>> {
        let hair = from_bytes(text(vertices, elements).as_bytes()).unwrap();
        hair.strands.iter().map(|strand| strand.iter().map(|p| p.x).collect()).collect()
    }

    fn text(vertices: usize, elements: &[&str]) -> String {
        let vertices: String = (1..=vertices).map(|x| format!("v {x} 0 0\n")).collect();
        vertices + &elements.iter().map(|element| format!("l {element}\n")).collect::<String>()
    }

    fn refused(vertices: usize, elements: &[&str]) -> String {
        from_bytes(text(vertices, elements).as_bytes()).unwrap_err().to_string()
    }

    #[test]
    fn edges_in_any_order_and_direction_are_the_strands_that_polylines_are() {
        let whole = strands(7, &["1 2 3 4", "5 6 7"]);
        assert_eq!(whole, [vec![1.0, 2.0, 3.0, 4.0], vec![5.0, 6.0, 7.0]]);
        for edges in [
            ["1 2", "2 3", "3 4", "5 6", "6 7"],
            ["2 1", "3 2", "4 3", "6 5", "7 6"],
            ["3 4", "6 7", "2 1", "6 5", "2 3"],
            ["-1 -2", "2 3", "-3 -2", "4 3", "1 2"],
        ] {
            assert_eq!(strands(7, &edges), whole, "{edges:?}");
        }
        // An edge that is there twice, in either direction, is one.
        assert_eq!(strands(4, &["1 2", "2 3", "2 1", "3 4", "3 4"]), [vec![1.0, 2.0, 3.0, 4.0]]);
    }

    #[test]
    fn edges_with_vertices_of_their_own_meet_where_these_lie() {
        let doubled =
            "v 1 0 0\nv 2 0 0\nv 2 0 0\nv 3 0 -0\nl 1 2\nv 3 0 0\nv 4 0 0\nl 4 3\nl 5 6\nv 9 0 0\nv 8 0 0\nl 7 8\n";
        let hair = from_bytes(doubled.as_bytes()).unwrap();
        let x: Vec<Vec<f32>> = hair.strands.iter().map(|strand| strand.iter().map(|p| p.x).collect()).collect();
        assert_eq!(x, [vec![1.0, 2.0, 3.0, 4.0], vec![9.0, 8.0]]);
        // Strands of one segment that begin at one place are what they were.
        let star = "v 0 0 0\nv 1 0 0\nv 0 0 0\nv 2 0 0\nv 0 0 0\nv 3 0 0\nl 1 2\nl 3 4\nl 5 6\n";
        assert_eq!(from_bytes(star.as_bytes()).unwrap().strands.len(), 3);
    }

    #[test]
    fn lines_go_on_where_another_ends_and_polylines_from_one_root_stay_apart() {
        assert_eq!(strands(6, &["4 5 6", "1 2 3 4"]), [[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]]);
        assert_eq!(strands(5, &["1 2 3", "3 4", "4 5"]), [[1.0, 2.0, 3.0, 4.0, 5.0]]);
        assert_eq!(strands(5, &["5 4 3", "2 1", "3 2"]), [[5.0, 4.0, 3.0, 2.0, 1.0]], "a polyline says its root");
        assert_eq!(strands(5, &["1 2 3", "1 4 5"]), [[1.0, 2.0, 3.0], [1.0, 4.0, 5.0]]);
        assert_eq!(strands(5, &["1 2 3", "4 5 3"]), [[1.0, 2.0, 3.0], [4.0, 5.0, 3.0]]);
        assert_eq!(strands(5, &["1 2 3", "3 4", "3 5"]), [vec![1.0, 2.0, 3.0], vec![3.0, 4.0], vec![3.0, 5.0]]);
        assert_eq!(strands(4, &["3 4", "2 1"]), [[3.0, 4.0], [2.0, 1.0]], "edges that do not meet stay as they are");
    }

    #[test]
    fn edges_that_branch_are_refused_and_closed_lines_are_left_out_and_said() {
        assert_eq!(
            from_bytes(text(5, &["1 2", "2 3", "3 4", "3 5"]).as_bytes()).map_err(|e| (e.line, e.what)).unwrap_err(),
            (
                Some(9),
                "3 edges meet at vertex 3, but strands do not branch: give each strand its own vertices".to_owned()
            )
        );
        let hair = from_bytes(text(9, &["1 2", "3 4", "4 5", "5 3", "6 7 8 6", "2 9"]).as_bytes()).unwrap();
        assert_eq!(hair.strands.len(), 1);
        assert_eq!(hair.attributes.unread, ["2 closed lines, which cannot be hair"]);
        assert!(refused(3, &["1 2", "3 2", "3 1"]).contains("closed lines, which cannot be hair"));
    }
}
