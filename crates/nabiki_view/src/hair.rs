//! Strands as the card has them: what does not change with the frame.

use nabiki::Strands;

/// Marks of the points: bit 0 a root, bit 1 a tip, bits 2 to 11 the part of the strand's length in 1/1023, then the strand.
pub fn marks(strands: &Strands) -> Vec<u32> {
    let mut marks = Vec::with_capacity(strands.points().len());
    for s in 0..strands.len() {
        let count = strands.range(s).len();
        for k in 0..count {
            let part = (k * 1023 / (count - 1).max(1)) as u32;
            marks.push(u32::from(k == 0) | u32::from(k + 1 == count) << 1 | part << 2 | (s as u32) << 12);
        }
    }
    marks
}

/// The triangles of ribbons whose segments are cut into `pieces`, two for each, once for each of the `hairs` of a lock. Node
/// j = (hair x points + point) x pieces + piece has vertices 2 j and 2 j + 1.
pub fn triangles(strands: &Strands, pieces: u32, hairs: u32) -> Vec<u32> {
    let mut indices = Vec::with_capacity(strands.segment_count() * (pieces * hairs) as usize * 6);
    let points = strands.points().len() as u32;
    for hair in 0..hairs {
        for s in 0..strands.len() {
            let range = strands.range(s);
            let first = (hair * points + range.start as u32) * pieces;
            let last = (hair * points + (range.end as u32).saturating_sub(1)) * pieces;
            for j in first..last {
                let [a, b, c, d] = [0, 1, 2, 3].map(|k| 2 * j + k);
                indices.extend([a, b, c, c, b, d]);
            }
        }
    }
    indices
}

/// Into how many pieces a segment is cut, so that few strands are round and many are drawn in time.
pub fn pieces(points: usize) -> u32 {
    match points {
        0..20_000 => 4,
        20_000..60_000 => 2,
        _ => 1,
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    fn mixed() -> Strands {
        let mut strands = Strands::default();
        for count in [4_usize, 2, 7] {
            strands.push((0..count).map(|k| Vec3::splat(k as f32)));
        }
        strands
    }

    #[test]
    fn each_strand_has_one_root_and_one_tip_and_its_length_runs_from_0_to_1() {
        let strands = mixed();
        let marks = marks(&strands);
        assert_eq!(marks.len(), 13);
        for s in 0..strands.len() {
            let of = &marks[strands.range(s)];
            assert!(of.iter().all(|m| (m >> 12) as usize == s));
            assert_eq!(of.iter().filter(|&&m| m & 1 == 1).count(), 1);
            assert_eq!(of.iter().filter(|&&m| m & 2 == 2).count(), 1);
            let (first, last) = (of[0], of[of.len() - 1]);
            assert_eq!((first & 1, last & 2), (1, 2));
            assert_eq!((first >> 2 & 1023, last >> 2 & 1023), (0, 1023));
        }
    }

    #[test]
    fn ribbons_never_reach_from_strand_to_strand() {
        let strands = mixed();
        for pieces in [1, 2, 4] {
            let triangles = triangles(&strands, pieces, 3);
            assert_eq!(triangles.len(), strands.segment_count() * pieces as usize * 6 * 3);
            for three in triangles.chunks(3) {
                let strand = |vertex: u32| {
                    let point = vertex / 2 / pieces % 13;
                    strands.starts().partition_point(|&start| start <= point) - 1
                };
                assert!(three.iter().all(|&v| strand(v) == strand(three[0])));
            }
        }
    }
}
