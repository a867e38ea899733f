//! How densely roots stand in the skin: what hair too short to be drawn does to the colour of a scalp.

use glam::{IVec3, Vec3};
use nabiki::Strands;

/// Roots farther from a place than this (cm) do not tint it.
const REACH: f32 = 0.8;
/// Side of the cells that roots are sorted into (cm): no place's neighbours lie in more than two of them along any axis.
const CELL: f32 = 2.0 * REACH;

/// The roots of strands, cell by cell.
#[derive(Debug, Default)]
pub struct Scalp {
    roots: Vec<([i32; 3], Vec3)>,
}

impl Scalp {
    /// The first points of the strands (head space, cm; all finite).
    pub fn new(strands: &Strands) -> Self {
        let mut roots: Vec<_> = roots(strands).map(|root| (order(cell(root)), root)).collect();
        roots.sort_by_key(|r| r.0);
        Self { roots }
    }

    /// Roots per square centimetre of skin about a place (head space, cm): near ones count more, and the whole is exact for roots
    /// spread evenly over a plane through it.
    pub fn density(&self, place: Vec3) -> f32 {
        const PER_AREA: f32 = 2.0 / (std::f32::consts::PI * REACH * REACH);
        let (low, high) = (cell(place - REACH), cell(place + REACH));
        let mut sum = 0.0;
        for z in low.z..=high.z {
            for y in low.y..=high.y {
                let last = order(IVec3::new(high.x, y, z));
                let first = self.roots.partition_point(|r| r.0 < order(IVec3::new(low.x, y, z)));
                let row = self.roots[first..].iter().take_while(|r| r.0 <= last);
                sum += row.map(|r| (1.0 - r.1.distance_squared(place) / (REACH * REACH)).max(0.0)).sum::<f32>();
            }
        }
        sum * PER_AREA
    }
}

/// The first point of each strand that has one.
pub fn roots(strands: &Strands) -> impl Iterator<Item = Vec3> + '_ {
    strands.iter().filter_map(|s| s.first().copied())
}

fn cell(p: Vec3) -> IVec3 {
    (p / CELL).floor().as_ivec3()
}

/// Cells along x follow one another.
fn order(cell: IVec3) -> [i32; 3] {
    [cell.z, cell.y, cell.x]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn even_roots_have_their_density_and_what_is_far_has_none() {
        let mut strands = Strands::default();
        let spacing = 0.1;
        for i in -100..=100 {
            for j in -100..=100 {
                strands.push([Vec3::new(i as f32, 0.0, j as f32) * spacing, Vec3::Y]);
            }
        }
        let scalp = Scalp::new(&strands);
        for place in [Vec3::ZERO, Vec3::new(1.63, 0.0, -0.37), Vec3::new(-3.2, 0.0, 1.6)] {
            // The sum over a lattice strays from the integral by its cells on the disc's rim, where the kernel is as small as
            // a spacing is to the reach: 2 pi (spacing / reach)^2 of the whole at most, here a tenth.
            let density = scalp.density(place) * spacing * spacing;
            assert!((density - 1.0).abs() < 0.1, "{place}: {density}");
        }
        assert_eq!(scalp.density(Vec3::Y), 0.0);
        assert_eq!(scalp.density(Vec3::splat(9e6)), 0.0);
        let edge = scalp.density(Vec3::new(10.0, 0.0, 0.0)) * spacing * spacing;
        assert!((edge - 0.5).abs() < 0.1, "{edge}");
    }

    #[test]
    fn no_roots_no_density() {
        assert_eq!(Scalp::new(&Strands::default()).density(Vec3::ZERO), 0.0);
    }
}
