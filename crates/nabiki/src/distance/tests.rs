use glam::Vec3;

use super::SkinDistance;
use crate::head::Head;

#[test]
fn bust_is_negative_inside_and_positive_outside() {
    let head = Head::builtin();
    let skin = SkinDistance::new(&head.mesh, Vec3::splat(-5.0), Vec3::splat(5.0), 0.25);
    assert!(skin.at(Vec3::ZERO) < -5.0);
    assert!(skin.at(Vec3::new(0.0, 40.0, 0.0)) > 20.0);
}
