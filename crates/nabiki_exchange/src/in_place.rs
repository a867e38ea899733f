//! Curves where they stand in a file.

use glam::{Affine3A, Vec3};
use nabiki::Hair;
use nabiki::hair::Role;
use nabiki::strands::{bounds, not_finite};

use crate::Problem;

/// Curves below a transform.
#[derive(Clone, Debug, PartialEq)]
pub struct InPlace {
    /// The curves in their own space.
    pub hair: Hair,
    /// Takes them to the file's world; identity where objects of different transforms were joined, which are in the
    /// world already.
    pub world_from_hair: Affine3A,
}

impl InPlace {
    /// The curves in the file's world.
    ///
    /// # Errors
    /// Points that leave the range of numbers.
    pub fn in_world(self) -> Result<Hair, Problem> {
        if self.world_from_hair == Affine3A::IDENTITY {
            return Ok(self.hair);
        }
        let mut hair = self.hair.transformed(&self.world_from_hair);
        let attributes = &mut hair.attributes;
        let placed = attributes.other.iter().filter(|o| matches!(o.role, Role::Point | Role::Vector | Role::Normal));
        attributes.unread.extend(placed.map(|o| format!("the transform above {}: it stays in its own space", o.name)));
        check_extent(hair.strands.points())?;
        Ok(hair)
    }
}

/// Refuses points of which no size can be told.
pub fn check_extent(points: &[Vec3]) -> Result<(), Problem> {
    if let Some(i) = not_finite(points) {
        return Err(Problem(format!("point {i} of its curves is not finite")));
    }
    let [low, high] = bounds(points);
    if !points.is_empty() && !(high - low).length().is_finite() {
        return Err(Problem(format!("its curves reach from {low} to {high}: their size is no finite number")));
    }
    Ok(())
}
