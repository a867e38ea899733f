//! Brows, sockets and closed eyes.

use glam::{Quat, Vec3};

use super::shapes::{carve, chain, join, swell, turned_ellipsoid};

/// Middle of the eyeball.
const EYE: Vec3 = Vec3::new(7.15, -0.8, 3.15);

/// Sinks the sockets, sets the lidded eyes into them and raises the brows.
pub(super) fn add(p: Vec3, skin: f32) -> f32 {
    if p.x < 2.0 || p.y.abs() > 6.0 {
        return skin;
    }
    let mut skin = skin;
    // The socket is deepest between eye and nose, and under the brow.
    skin += 0.75 * swell(p, Vec3::new(8.9, -0.5, 2.4), Vec3::new(2.2, 2.2, 2.4));
    skin += 0.35 * swell(p, Vec3::new(8.0, 0.0, 4.4), Vec3::new(2.0, 1.6, 1.8));
    // The brow follows the upper rim.
    let brow = chain(
        p,
        &[
            (Vec3::new(8.55, 1.35, 1.4), 0.2),
            (Vec3::new(8.2, 1.8, 2.8), 0.28),
            (Vec3::new(7.1, 1.8, 4.4), 0.2),
            (Vec3::new(6.0, 1.1, 5.3), 0.1),
        ],
    );
    skin = join(skin, brow, 1.3);
    let ball = turned_ellipsoid(p, EYE, Vec3::new(1.3, 1.2, 1.5), Quat::from_rotation_y(0.35));
    skin = join(skin, ball, 0.5);
    // The closed lids meet on a line that hangs like a bow, a little higher outside.
    let line = lid_line(p);
    skin = carve(skin, line, 0.3);
    skin
}

fn lid_line(p: Vec3) -> f32 {
    let at = |t: f32| {
        let z = EYE.z + 1.55 * t;
        let y = EYE.y - 0.55 + 0.5 * t * t + 0.08 * t;
        Vec3::new(8.5 - 0.55 * t - 0.55 * t * t, y, z)
    };
    let links: [(Vec3, f32); 9] = std::array::from_fn(|i| {
        let t = i as f32 / 4.0 - 1.0;
        (at(t), 0.14 - 0.06 * t * t)
    });
    chain(p, &links)
}
