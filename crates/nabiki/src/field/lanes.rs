//! Forces at many points at once, with the widest vectors that the machine has.

use glam::Vec3;

use super::VectorRow;
use crate::vector::dot;

/// A field in one frame, written without branches so that its loops over points become vectors.
///
/// Sums of products are written as `mul_add`, so that the bits are the same for any width. Implementations are
/// `#[inline(always)]`: only what is inlined is compiled for the wide vectors. Closures cannot be made so, hence the
/// little functions below.
pub(super) trait Lanes {
    /// The forces at N points.
    fn forces<const N: usize>(&self, points: &[[f32; N]; 3]) -> [[f32; N]; 3];
}

/// The force at one point: the bits that a row has.
pub(super) fn at(lanes: &impl Lanes, point: Vec3) -> Vec3 {
    let points = point.to_array().map(|x| [x]);
    let forces = pulp::Arch::new().dispatch(Call { lanes, points: &points });
    Vec3::from_array(forces.map(|[x]| x))
}

/// The forces at sixteen points.
pub(super) fn at_row(lanes: &impl Lanes, points: &VectorRow, forces: &mut VectorRow) {
    *forces = pulp::Arch::new().dispatch(Call { lanes, points });
}

struct Call<'a, L, const N: usize> {
    lanes: &'a L,
    points: &'a [[f32; N]; 3],
}

impl<L: Lanes, const N: usize> pulp::NullaryFnOnce for Call<'_, L, N> {
    type Output = [[f32; N]; 3];

    #[inline(always)]
    fn call(self) -> Self::Output {
        self.lanes.forces(self.points)
    }
}

/// A matrix, given by its rows, times `v`.
#[inline(always)]
pub(super) fn times(rows: &[[f32; 3]; 3], v: [f32; 3]) -> [f32; 3] {
    [dot(rows[0], v), dot(rows[1], v), dot(rows[2], v)]
}

/// The transposed of a matrix, given by its rows, times `v`.
#[inline(always)]
pub(super) fn transposed_times([a, b, c]: &[[f32; 3]; 3], v: [f32; 3]) -> [f32; 3] {
    [dot([a[0], b[0], c[0]], v), dot([a[1], b[1], c[1]], v), dot([a[2], b[2], c[2]], v)]
}

/// The products of their components.
#[inline(always)]
pub(super) fn by_part(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[0] * b[0], a[1] * b[1], a[2] * b[2]]
}

/// One of N vectors.
#[inline(always)]
pub(super) fn get<const N: usize>(vectors: &[[f32; N]; 3], lane: usize) -> [f32; 3] {
    [vectors[0][lane], vectors[1][lane], vectors[2][lane]]
}

/// Sets one of N vectors.
#[inline(always)]
pub(super) fn set<const N: usize>(vectors: &mut [[f32; N]; 3], lane: usize, v: [f32; 3]) {
    vectors[0][lane] = v[0];
    vectors[1][lane] = v[1];
    vectors[2][lane] = v[2];
}
