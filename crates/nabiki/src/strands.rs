//! Hair as polylines: strands of any length in one contiguous array, root first.

use glam::Vec3;

/// Polylines of any length, each from root to tip, in one contiguous array of points (head space, cm).
///
/// Strand `s` owns the points `starts[s]..starts[s + 1]`: its root, then the end of each of its segments
/// (nodes p_0 .. p_k of the paper, section 3.1).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Strands {
    starts: Vec<u32>,
    points: Vec<Vec3>,
}

impl Strands {
    /// No strands, with room for `strands` of `points` points in all.
    pub fn with_capacity(strands: usize, points: usize) -> Self {
        let mut starts = Vec::with_capacity(strands + 1);
        starts.push(0);
        Self { starts, points: Vec::with_capacity(points) }
    }

    /// Takes over arrays read elsewhere: strand `s` owns `points[starts[s]..starts[s + 1]]`.
    ///
    /// # Panics
    /// If `starts` does not begin with 0, falls anywhere, or does not end with the number of points.
    pub fn from_parts(starts: Vec<u32>, points: Vec<Vec3>) -> Self {
        assert!(starts.first() == Some(&0), "starts must begin with 0");
        assert!(starts.is_sorted(), "starts must not fall");
        assert!(starts.last().map(|&n| n as usize) == Some(points.len()), "starts must end with the point count");
        Self { starts, points }
    }

    /// Appends one strand, root first.
    ///
    /// # Panics
    /// If the set would hold 2^32 points or more.
    pub fn push(&mut self, strand: impl IntoIterator<Item = Vec3>) {
        if self.starts.is_empty() {
            self.starts.push(0);
        }
        self.points.extend(strand);
        self.starts.push(u32::try_from(self.points.len()).expect("fewer than 2^32 points"));
    }

    /// Number of strands.
    pub fn len(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    /// Whether there is no strand.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The points of one strand, root first.
    pub fn strand(&self, s: usize) -> &[Vec3] {
        &self.points[self.range(s)]
    }

    /// The points of one strand, root first.
    pub fn strand_mut(&mut self, s: usize) -> &mut [Vec3] {
        let range = self.range(s);
        &mut self.points[range]
    }

    /// Where the points of strand `s` lie in [`points`](Self::points).
    pub fn range(&self, s: usize) -> std::ops::Range<usize> {
        self.starts[s] as usize..self.starts[s + 1] as usize
    }

    /// Every strand in turn, root first.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &[Vec3]> {
        self.starts.windows(2).map(|w| &self.points[w[0] as usize..w[1] as usize])
    }

    /// Offsets of the strands in [`points`](Self::points), one more than there are strands (empty for no strands).
    pub fn starts(&self) -> &[u32] {
        &self.starts
    }

    /// All points, strand after strand.
    pub fn points(&self) -> &[Vec3] {
        &self.points
    }

    /// All points, strand after strand; their number and owners stay as they are.
    pub fn points_mut(&mut self) -> &mut [Vec3] {
        &mut self.points
    }

    /// Number of segments of all strands.
    pub fn segment_count(&self) -> usize {
        self.points.len() - self.len()
    }

    /// The strands named by `indices`, in that order.
    pub fn select(&self, indices: &[usize]) -> Self {
        let mut chosen = Self::with_capacity(indices.len(), 0);
        for &s in indices {
            chosen.push(self.strand(s).iter().copied());
        }
        chosen
    }
}
