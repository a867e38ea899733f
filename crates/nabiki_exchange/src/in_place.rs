//! Curves with their transform in a file.

use glam::{DAffine3, Vec3};
use nabiki::Hair;
use nabiki::hair::Role;
use nabiki::strands::{bounds, not_finite};

use crate::Problem;

/// Curves below a transform.
#[derive(Clone, Debug, PartialEq)]
pub struct InPlace {
    /// The curves in their own space.
    pub hair: Hair,
    /// Transform to the file's world. The identity if objects with different transforms were joined, since those are
    /// already in the world.
    pub world_from_hair: DAffine3,
}

/// Applies a transform to a point.
pub fn point(target_from_source: &DAffine3, p: Vec3) -> Vec3 {
    target_from_source.transform_point3(p.as_dvec3()).as_vec3()
}

impl InPlace {
    /// The curves in the file's world.
    ///
    /// # Errors
    /// If a point leaves the range of f32.
    pub fn in_world(self) -> Result<Hair, Problem> {
        if self.world_from_hair == DAffine3::IDENTITY {
            return Ok(self.hair);
        }
        let hair = self.through(&DAffine3::IDENTITY);
        check_extent(hair.strands.points())?;
        Ok(hair)
    }

    /// The curves in the space that `target_from_world` leads to from the file's world. Both transforms are applied in
    /// one step, without loss of precision.
    pub fn through(self, target_from_world: &DAffine3) -> Hair {
        let mut hair = self.hair.transformed(&(*target_from_world * self.world_from_hair));
        if self.world_from_hair != DAffine3::IDENTITY {
            let attributes = &mut hair.attributes;
            let placed =
                attributes.other.iter().filter(|o| matches!(o.role, Role::Point | Role::Vector | Role::Normal));
            let line = |name: &str| format!("the transform above {name}: it stays in its own space");
            attributes.unread.extend(placed.map(|o| line(&o.name)));
        }
        hair
    }
}

/// Refuses points whose extent is not finite.
pub fn check_extent(points: &[Vec3]) -> Result<(), Problem> {
    if let Some(i) = not_finite(points) {
        return Err(Problem(format!("point {i} of its curves is not finite")));
    }
    let [low, high] = bounds(points);
    if !points.is_empty() && !(high - low).length().is_finite() {
        return Err(Problem(format!("its curves reach from {low} to {high}: their size is not finite")));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use nabiki::Strands;

    #[test]
    fn curves_go_through_their_own_transform_before_any_other() {
        let mut strands = Strands::default();
        strands.push([Vec3::ZERO, Vec3::X]);
        let in_place =
            InPlace { hair: Hair::from(strands), world_from_hair: DAffine3::from_translation(10.0 * DVec3::X) };
        let doubled = in_place.clone().through(&DAffine3::from_scale(DVec3::splat(2.0)));
        assert_eq!(doubled.strands.points(), [20.0 * Vec3::X, 22.0 * Vec3::X]);
        assert_eq!(in_place.in_world().unwrap().strands.points(), [10.0 * Vec3::X, 11.0 * Vec3::X]);
    }
}
