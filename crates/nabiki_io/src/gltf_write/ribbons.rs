//! Strands as ribbons: two vertices at each point.

use glam::Vec3;
use nabiki::Strands;

/// Across and along each strand, in parts of the largest number: 0 along at the root, 1 at the tip.
pub(super) fn uvs(strands: &Strands) -> Vec<[u16; 2]> {
    strands.iter().flat_map(along).flat_map(|v| [[0, v], [u16::MAX, v]]).collect()
}

/// How far along the strand each point is: 0 at the root, the largest number at the tip.
fn along(strand: &[Vec3]) -> Vec<u16> {
    let last = strand.len() - 1;
    (0..=last).map(|i| (i * usize::from(u16::MAX) / last) as u16).collect()
}

/// The direction of the strand at each point.
pub(crate) fn tangents(strand: &[Vec3]) -> impl Iterator<Item = Vec3> {
    let last = strand.len() - 1;
    (0..=last).map(move |i| (strand[(i + 1).min(last)] - strand[i.saturating_sub(1)]).normalize_or(Vec3::NEG_Y))
}

/// A direction across the strand at each point that lies on the skin as near as may be: ribbons lie flat on the head.
pub(crate) fn normals(strand: &[Vec3], center: Vec3) -> Vec<Vec3> {
    // Hair grows away from the middle of the head.
    let out = (strand[0] - center).normalize_or(Vec3::Y);
    tangents(strand)
        .map(|tangent| (out - tangent * tangent.dot(out)).normalize_or(tangent.any_orthonormal_vector()))
        .collect()
}

/// From each point of the strand to its right vertex.
pub(crate) fn sides(strand: &[Vec3], half: f32, center: Vec3) -> impl Iterator<Item = Vec3> {
    tangents(strand).zip(normals(strand, center)).map(move |(tangent, normal)| half * tangent.cross(normal))
}

/// Two points at each point of the strand, left and right.
pub(crate) fn ribbon(strand: &[Vec3], half: f32, center: Vec3) -> Vec<Vec3> {
    strand.iter().zip(sides(strand, half, center)).flat_map(|(p, side)| [*p - side, *p + side]).collect()
}
