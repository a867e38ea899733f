//! The wind as small arrows, where it is not the same everywhere.

use glam::Vec3;
use nabiki::field::Field;
use nabiki::{Ellipsoid, Pose};

use nabiki_view::Line;

/// Between neighbouring arrows (cm), and how many there are on each side of the middle one.
const SPACING_CM: f32 = 9.0;
const SIDE: i32 = 3;
/// Length of an arrow of endless strength (cm), and the strength whose arrow is half as long.
const LONGEST_CM: f32 = 6.0;
const HALF_AT: f32 = 120.0;
/// Thickness (px).
const WIDTH: f32 = 1.2;

/// The arrows of a field in a frame about a head that is at `pose` in the space of the forces: from where to where in that
/// space. None where the field is the same everywhere.
pub fn arrows(field: &dyn Field, frame: u32, head: &Ellipsoid, pose: &Pose) -> Vec<[Vec3; 2]> {
    if field.uniform(frame).is_some() {
        return Vec::new();
    }
    let middle = pose.world_from_head().transform_point3(head.center);
    let side = 2 * SIDE + 1;
    let places = (0..side * side * side)
        .map(|i| Vec3::new((i % side - SIDE) as f32, (i / side % side - SIDE) as f32, (i / side / side - SIDE) as f32));
    places
        .map(|p| middle + p * SPACING_CM)
        .filter(|&p| {
            let in_head = pose.rotation.inverse() * (p - pose.position_cm);
            head.value(in_head) > 0.0
        })
        .filter_map(|p| {
            let force = field.at(p, frame);
            let strength = force.length();
            let length = LONGEST_CM * strength / (strength + HALF_AT);
            (length > 0.15).then(|| [p, p + force / strength * length])
        })
        .collect()
}

/// The lines of an arrow: a shaft that fades in, and two barbs that face the camera looking along `forward`.
pub fn lines(arrow: [Vec3; 2], forward: Vec3) -> [Line; 3] {
    let [from, to] = arrow;
    let way = to - from;
    let across = way.cross(forward).normalize_or_zero() * way.length();
    let colour = |alpha: f32| [0.55, 0.75, 0.95, alpha];
    let line = |a: Vec3, b: Vec3, faint: f32| Line {
        a: a.to_array(),
        width: WIDTH,
        b: b.to_array(),
        pad: 0.0,
        a_colour: colour(faint),
        b_colour: colour(0.5),
    };
    let back = to - 0.28 * way;
    [line(from, to, 0.05), line(back + 0.13 * across, to, 0.5), line(back - 0.13 * across, to, 0.5)]
}

#[cfg(test)]
mod tests {
    use nabiki::field::{Falloff, Keyframe, KeyframedField, Point, PointField};

    use super::*;

    const HEAD: Ellipsoid = Ellipsoid { center: Vec3::ZERO, half_axes: Vec3::new(9.0, 11.0, 8.0) };

    #[test]
    fn a_wind_that_is_the_same_everywhere_needs_no_arrows() {
        let field = KeyframedField::new(&[Keyframe { through: 10, vector: Vec3::X }]).unwrap();
        assert!(arrows(&field, 5, &HEAD, &Pose::STILL).is_empty());
    }

    #[test]
    fn arrows_lie_outside_of_the_head_and_point_where_hair_is_pushed() {
        let position = Vec3::new(30.0, 0.0, 0.0);
        let point = Point { position, strength: 50.0, falloff: Falloff::default(), envelope: Vec::new() };
        let field = PointField::new(&point, "point").unwrap();
        let pose = Pose { position_cm: Vec3::new(3.0, 0.0, 1.0), ..Pose::STILL };
        let found = arrows(&field, 5, &HEAD, &pose);
        assert!(!found.is_empty());
        for [from, to] in &found {
            assert!(HEAD.value(*from - pose.position_cm) > 0.0);
            let force = field.at(*from, 5);
            assert!((*to - *from).dot(force) > 0.999 * (*to - *from).length() * force.length());
            assert!((*to - *from).length() < LONGEST_CM);
        }
    }
}
