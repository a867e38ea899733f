//! Hair as polylines: strands of any length in one contiguous array, root first.

use glam::Vec3;

use crate::error::SettingError;

/// The first point that is NaN or infinite.
///
/// If all points are finite, it runs at memory speed: it tests exponents with a branch-free maximum.
pub fn not_finite(points: &[Vec3]) -> Option<usize> {
    let numbers: &[f32] = bytemuck::cast_slice(points);
    if numbers.iter().fold(0, |greatest, x| (x.to_bits() & 0x7fff_ffff).max(greatest)) < 0x7f80_0000 {
        return None;
    }
    points.iter().position(|p| !p.is_finite())
}

/// The corners of the bounding box. Infinite for no points; NaN is ignored.
pub fn bounds(points: &[Vec3]) -> [Vec3; 2] {
    // Eight boxes side by side, so that none waits for its own last point. Plain comparisons are one instruction, a
    // float maximum is several.
    const ROW: usize = 24;
    let lower = |a: f32, b: f32| if b < a { b } else { a };
    let higher = |a: f32, b: f32| if b > a { b } else { a };
    let (rows, rest) = bytemuck::cast_slice::<Vec3, f32>(points).as_chunks::<ROW>();
    let (mut low, mut high) = ([f32::INFINITY; ROW], [f32::NEG_INFINITY; ROW]);
    for row in rows {
        low = std::array::from_fn(|k| lower(low[k], row[k]));
        high = std::array::from_fn(|k| higher(high[k], row[k]));
    }
    let all = |boxes: [f32; ROW], start: f32, chosen: &dyn Fn(f32, f32) -> f32| {
        let numbers = boxes.as_chunks::<3>().0.iter().chain(rest.as_chunks::<3>().0);
        Vec3::from(numbers.fold([start; 3], |a, b| std::array::from_fn(|k| chosen(a[k], b[k]))))
    };
    [all(low, f32::INFINITY, &lower), all(high, f32::NEG_INFINITY, &higher)]
}

/// Refuses numbers of strands and segments that need more points than [`Strands`] can count. `name` is the setting of
/// the number of segments.
///
/// # Errors
/// Names the number of segments.
pub fn check_points(name: &str, segments: usize, strands: usize) -> Result<(), SettingError> {
    let points = segments.checked_add(1).and_then(|points| points.checked_mul(strands));
    match points {
        Some(points) if points <= u32::MAX as usize => Ok(()),
        _ => Err(SettingError::new(name, segments, "gives more than 2^32 points in all: ask for fewer")),
    }
}

/// The length of one strand (in the unit of its points).
pub fn length(strand: &[Vec3]) -> f32 {
    strand.windows(2).map(|w| w[0].distance(w[1])).sum()
}

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
    /// An empty set with room for `strands` strands of `points` points in total.
    pub fn with_capacity(strands: usize, points: usize) -> Self {
        let mut starts = Vec::with_capacity(strands + 1);
        starts.push(0);
        Self { starts, points: Vec::with_capacity(points) }
    }

    /// Builds strands from arrays: strand `s` owns `points[starts[s]..starts[s + 1]]`.
    ///
    /// # Panics
    /// If `starts` does not begin with 0, decreases anywhere, or does not end with the number of points.
    pub fn from_parts(starts: Vec<u32>, points: Vec<Vec3>) -> Self {
        assert!(starts.first() == Some(&0), "starts must begin with 0");
        assert!(starts.is_sorted(), "starts must not fall");
        assert!(starts.last().map(|&n| n as usize) == Some(points.len()), "starts must end with the point count");
        Self { starts, points }
    }

    /// Appends one strand, root first.
    ///
    /// # Panics
    /// If the set would have 2^32 points or more.
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

    /// Whether there are no strands.
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

    /// The range of strand `s` in [`points`](Self::points).
    pub fn range(&self, s: usize) -> std::ops::Range<usize> {
        self.starts[s] as usize..self.starts[s + 1] as usize
    }

    /// All strands, root first.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &[Vec3]> {
        self.starts.windows(2).map(|w| &self.points[w[0] as usize..w[1] as usize])
    }

    /// Offsets of the strands in [`points`](Self::points): one more than there are strands, or none without strands.
    pub fn starts(&self) -> &[u32] {
        &self.starts
    }

    /// All points, strand after strand.
    pub fn points(&self) -> &[Vec3] {
        &self.points
    }

    /// Interpolates between earlier points of the same strands and these, for pictures between two steps (head space,
    /// cm). `part` is 0..=1. Roots move linearly. Each segment turns from its earlier to its current direction and
    /// keeps its length, which linear interpolation of points would not. A segment that turned by exactly half a turn
    /// takes the direction nearer in time.
    ///
    /// # Panics
    /// If the slices do not have as many points as these strands.
    pub fn between(&self, before: &[Vec3], part: f32, points: &mut [Vec3]) {
        assert_eq!(before.len(), self.points.len(), "points before, of the same strands");
        assert_eq!(points.len(), self.points.len(), "room for every point");
        for s in 0..self.len() {
            let range = self.range(s);
            let (then, now, between) = (&before[range.clone()], self.strand(s), &mut points[range]);
            let (Some((a, then)), Some((b, now))) = (then.split_first(), now.split_first()) else { continue };
            let (mut a, mut b, mut p) = (*a, *b, a.lerp(*b, part));
            between[0] = p;
            for ((next_a, next_b), point) in then.iter().zip(now).zip(&mut between[1..]) {
                let (from, to) = (*next_a - a, *next_b - b);
                let (length_from, length_to) = (from.length(), to.length());
                let length = length_from + part * (length_to - length_from);
                let mean = from.lerp(to, part);
                let nearer = if part < 0.5 { from } else { to };
                // What is left of two vectors that almost cancel has no direction.
                let way = if mean.length_squared() > 1e-8 * length * length { mean } else { nearer };
                p += length * way.normalize_or_zero();
                (a, b, *point) = (*next_a, *next_b, p);
            }
        }
    }

    /// All points, strand after strand, for editing in place.
    pub fn points_mut(&mut self) -> &mut [Vec3] {
        &mut self.points
    }

    /// Reverses the strands for which `which` is true.
    pub fn turn(&mut self, which: &[bool]) {
        for (s, _) in which.iter().enumerate().filter(|(_, turned)| **turned) {
            self.strand_mut(s).reverse();
        }
    }

    /// The length of every strand (cm).
    pub fn lengths(&self) -> impl ExactSizeIterator<Item = f32> {
        self.iter().map(length)
    }

    /// Total number of segments.
    pub fn segment_count(&self) -> usize {
        self.points.len() - self.len()
    }

    /// The strands with these `indices`, in that order.
    pub fn select(&self, indices: &[usize]) -> Self {
        let mut chosen = Self::with_capacity(indices.len(), 0);
        for &s in indices {
            chosen.push(self.strand(s).iter().copied());
        }
        chosen
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_point_that_is_not_finite_is_found_anywhere() {
        let mut points: Vec<Vec3> = (0..100).map(|i| Vec3::splat(f32::MAX - 1e32 * i as f32)).collect();
        assert_eq!(not_finite(&points), None);
        for i in (0..100).rev() {
            points[i][i % 3] = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY][i % 3];
            assert_eq!(not_finite(&points), Some(i));
        }
    }

    #[test]
    fn as_many_points_as_32_bits_count_are_allowed_and_no_more() {
        // 2^32 - 1 = 65,535 x 65,537.
        assert_eq!(check_points("hair.segments", 65_536, 65_535), Ok(()));
        let refused = check_points("hair.segments", 65_537, 65_535).unwrap_err();
        assert_eq!(refused.to_string(), "hair.segments = 65537: gives more than 2^32 points in all: ask for fewer");
        assert!(check_points("hair.segments", usize::MAX, 1).is_err());
    }

    #[test]
    fn bounds_are_the_lowest_and_highest_of_any_number_of_points() {
        let points: Vec<Vec3> =
            (0..50).map(|i| Vec3::new((i as f32).sin(), (7.3 * i as f32).cos(), -(i as f32))).collect();
        for n in 0..points.len() {
            let low = points[..n].iter().fold(Vec3::INFINITY, |a, &b| a.min(b));
            let high = points[..n].iter().fold(Vec3::NEG_INFINITY, |a, &b| a.max(b));
            assert_eq!(bounds(&points[..n]), [low, high], "{n} points");
        }
    }
}
