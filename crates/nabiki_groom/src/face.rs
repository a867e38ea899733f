//! The face of the built-in bust: its feature lines, and the paint along them.
//!
//! Both halves are symmetric: z means |z| throughout. t is the position along a feature, defined for each line. Head
//! space, cm.

use nabiki::glam::{Vec2, Vec3};

/// The line of the brow: `t` is 0 next to the nose and 1 at its end.
pub fn brow_line(t: f32) -> f32 {
    0.95 + 1.75 * t - 1.95 * t * t * t
}

/// Position along the brow.
pub fn along_brow(z: f32) -> f32 {
    (z - 1.35) / 3.85
}

/// The centre of a pupil, seen from the front.
pub const PUPIL: [f32; 2] = [-0.72, 3.12];

/// The edges of the upper and the lower lid: `t` is -1 at the inner corner and 1 at the outer. The upper edge is
/// highest toward the nose, the lower edge is lowest away from it, and the outer corner is the higher one.
pub fn lid_edges(t: f32) -> [f32; 2] {
    let corners = -0.83 + 0.1 * t;
    let bow = (1.0 - t * t).max(0.0);
    let full = bow * (1.35 - 0.35 * bow);
    [corners + full * (0.51 - 0.06 * t), corners - bow * (0.34 + 0.07 * t)]
}

/// Position along the lids.
pub fn along_lids(z: f32) -> f32 {
    (z - PUPIL[1]) / 1.53
}

/// The line where the lips meet: a shallow wave, lowest in the middle, rising slightly at the corners.
pub fn lip_parting(z: f32, t: f32) -> f32 {
    -7.12 - 0.06 * bump(z / 1.1) - 0.06 * t * t + 0.05 * t * t * t * t
}

/// The upper and the lower edge of the lips: `t` is 0 in the middle and 1 at the corner.
pub fn lip_edges(z: f32, t: f32) -> [f32; 2] {
    let fall = t.min(1.0);
    [-6.3 - 0.14 * bump(z / 0.85) - 0.8 * fall * fall.sqrt(), -8.1 + fall * fall * (0.7 + 0.3 * fall)]
}

/// 1 in the middle, falling smoothly to 0 at 1 on either side.
fn bump(off: f32) -> f32 {
    let left = (1.0 - off * off).max(0.0);
    left * left * left
}

/// Position along the lips.
pub fn along_lips(z: f32) -> f32 {
    z / 2.9
}

/// The centre of a nostril.
pub const NOSTRIL: Vec3 = Vec3::new(9.85, -5.16, 0.52);

/// The paint on the skin at a point, each 0..1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Paint {
    /// Hairs of the brow.
    pub brow: f32,
    /// Lashes, and the line of their roots.
    pub lashes: f32,
    /// The red of the lips.
    pub lips: f32,
    /// Blood under the skin of cheeks, nose and ears.
    pub flush: f32,
    /// The dark inside of the nostrils.
    pub nostrils: f32,
    /// The eye: its white and everything within it.
    pub eye: f32,
    /// The iris, as a share of the eye.
    pub iris: f32,
    /// The dark rim of the iris, as a share of it.
    pub rim: f32,
    /// The pupil, as a share of the iris.
    pub pupil: f32,
    /// The highlight in the eye.
    pub glint: f32,
    /// The light that the lids let through to the eye.
    pub shade: f32,
}

impl Paint {
    /// The sampling distance (cm) that the paint around a point needs: smallest on the hairs of brows and lashes.
    pub fn detail(p: Vec3) -> f32 {
        let z = p.z.abs();
        match () {
            () if p.x < 3.7 || z > 5.7 || !(-10.0..4.0).contains(&p.y) => 1.0,
            () if (-2.3..3.5).contains(&p.y) => 0.03,
            () => 0.1,
        }
    }

    /// The paint on the built-in bust at `p`.
    pub fn at(p: Vec3) -> Self {
        let z = p.z.abs();
        let near = |centre: Vec3, reach: f32| {
            let far = (Vec3::new(p.x, p.y, z) - centre).length_squared() / (reach * reach);
            if far < 1.0 { (1.0 - far) * (1.0 - far) } else { 0.0 }
        };
        let flush = near(Vec3::new(6.0, -3.9, 4.3), 3.2) + 0.8 * near(Vec3::new(10.9, -3.9, 0.0), 1.6);
        let ears = 0.8 * near(Vec3::new(-0.5, -2.5, 8.2), 3.2);
        if p.x < 4.0 || !(-10.0..4.0).contains(&p.y) {
            return Self { flush: ears, ..Self::default() };
        }
        // Darkest under the ceiling of the hollow.
        let nostrils = smooth(1.6 * near(NOSTRIL + 0.12 * Vec3::Y, 0.32));
        Self {
            brow: brow(p.y, z),
            lashes: lashes(p.y, z),
            lips: lips(p.y, z),
            flush: (flush + ears).min(1.0),
            nostrils,
            ..eye(p.y, z)
        }
    }

    /// The colour (linear) of `skin` with this paint, on a head with this `hair` colour.
    pub fn over(&self, skin: [f32; 3], hair: [f32; 3]) -> [f32; 3] {
        const LIPS: [f32; 3] = [0.92, 0.66, 0.70];
        const FLUSH: [f32; 3] = [1.0, 0.86, 0.86];
        const WHITE: [f32; 3] = [0.36, 0.32, 0.30];
        const IRIS: [f32; 3] = [0.10, 0.058, 0.032];
        std::array::from_fn(|c| {
            let toward = |from: f32, to: f32, share: f32| from + (to - from) * share;
            let colour = toward(skin[c], skin[c] * FLUSH[c], self.flush);
            let colour = toward(colour, skin[c] * LIPS[c], self.lips);
            // Brows and lashes are darker than hair, and always than skin.
            let colour = toward(colour, (0.5 * hair[c]).min(0.4 * skin[c]), 0.9 * self.brow);
            let colour = toward(colour, 0.15 * FLUSH[c] * skin[c], self.nostrils);
            let iris = toward(toward(IRIS[c], 0.3 * IRIS[c], self.rim), 0.004, self.pupil);
            let eye = toward(toward(WHITE[c], iris, self.iris) * self.shade, 0.45, self.glint);
            let colour = toward(colour, eye, self.eye);
            toward(colour, (0.25 * hair[c]).min(0.12 * skin[c]), self.lashes)
        })
    }
}

fn brow(y: f32, z: f32) -> f32 {
    let t = along_brow(z);
    if !(0.0..=1.0).contains(&t) {
        return 0.0;
    }
    let off = y - brow_line(t);
    let width = 0.40 - 0.2 * t;
    let within = 1.0 - (off / width) * (off / width);
    if within <= 0.0 {
        return 0.0;
    }
    // Upright beside the nose, hairs lie down along the brow farther out.
    let (sin, cos) = (1.25 - 1.0 * t).sin_cos();
    let across = cos * off - sin * (z - 1.3);
    let hairs = 0.55 * grain(across / 0.035) + 0.45 * grain(across / 0.09 + 31.7);
    (1.5 * within).min(1.0) * (5.0 * t).min(1.0) * (2.5 * (1.0 - t)).min(1.0) * (0.45 + 0.55 * hairs)
}

fn lashes(y: f32, z: f32) -> f32 {
    let t = along_lids(z);
    if !(-1.02..=1.1).contains(&t) {
        return 0.0;
    }
    let [upper, lower] = lid_edges(t.clamp(-1.0, 1.0));
    let ends = (8.0 * (1.1 - t)).min(1.0) * (5.0 * (t + 1.02)).min(1.0);
    let off = (y - upper + 0.02 - 0.06 * (t - 0.9).max(0.0)) / (0.075 + 0.025 * t);
    let line = (1.0 - off * off).max(0.0);
    let low = (y - lower + 0.02) / 0.05;
    let low = 0.35 * (1.0 - low * low).max(0.0) * (0.5 + 0.5 * t);
    ends * (1.6 * line).min(1.0).max(low)
}

/// The open eye: its white, the iris about the pupil.
fn eye(y: f32, z: f32) -> Paint {
    let t = along_lids(z);
    if t.abs() >= 1.0 {
        return Paint::default();
    }
    let [upper, lower] = lid_edges(t);
    let within = smooth((upper - y) / 0.05) * smooth((y - lower) / 0.05);
    let pupil = Vec2::from_array(PUPIL);
    let place = Vec2::new(y, z);
    let far = place.distance(pupil);
    // The upper lid and its lashes shade the eye; a lamp above is mirrored in it, in the middle, since both eyes are alike.
    let shade = 1.0 - 0.5 * smooth((y - upper + 0.3) / 0.3) - 0.25 * smooth((t.abs() - 0.6) / 0.4);
    let glint = smooth((0.09 - place.distance(pupil + Vec2::new(0.2, 0.0))) / 0.05);
    Paint {
        eye: within,
        shade,
        iris: smooth((0.63 - far) / 0.12),
        rim: smooth((far - 0.4) / 0.2),
        pupil: smooth((0.25 - far) / 0.06),
        glint,
        ..Paint::default()
    }
}

fn lips(y: f32, z: f32) -> f32 {
    let t = along_lips(z);
    if t >= 1.0 {
        return 0.0;
    }
    let [upper, lower] = lip_edges(z, t);
    smooth((upper - y) / 0.2) * smooth((y - lower) / 0.3) * (7.0 * (1.0 - t)).min(1.0)
}

fn smooth(t: f32) -> f32 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Noise along a line, 0..1: chance at whole numbers, smooth between.
fn grain(x: f32) -> f32 {
    let cell = x.floor();
    let chance = |n: i32| {
        let mixed = (n as u32).wrapping_mul(0x9E37_79B1);
        let mixed = (mixed ^ mixed >> 15).wrapping_mul(0x85EB_CA77);
        ((mixed ^ mixed >> 13) >> 8) as f32 / (1 << 24) as f32
    };
    let (a, b) = (chance(cell as i32), chance(cell as i32 + 1));
    a + (b - a) * smooth(x - cell)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paint_is_alike_on_both_sides_and_lies_on_the_face_alone() {
        let head = crate::bust();
        let mut seen = Paint::default();
        for &p in &head.mesh.positions {
            let paint = Paint::at(p);
            assert_eq!(paint, Paint::at(Vec3::new(p.x, p.y, -p.z)));
            let each = [paint.brow, paint.lashes, paint.lips, paint.flush, paint.nostrils, paint.eye, paint.shade];
            let within_eye = [paint.iris, paint.rim, paint.pupil, paint.glint];
            assert!(each.iter().chain(&within_eye).all(|share| (0.0..=1.0).contains(share)), "{paint:?} at {p}");
            if p.x < 4.0 {
                assert_eq!(paint, Paint { flush: paint.flush, ..Paint::default() }, "{p}");
            }
            seen = Paint {
                brow: seen.brow.max(paint.brow),
                lashes: seen.lashes.max(paint.lashes),
                lips: seen.lips.max(paint.lips),
                flush: seen.flush.max(paint.flush),
                nostrils: seen.nostrils.max(paint.nostrils),
                eye: seen.eye.max(paint.eye),
                iris: seen.iris.max(paint.iris.min(paint.eye)),
                pupil: seen.pupil.max(paint.pupil.min(paint.eye)),
                ..Paint::default()
            };
        }
        assert!(
            seen.brow > 0.5 && seen.lashes > 0.5 && seen.lips > 0.9 && seen.flush > 0.3 && seen.nostrils > 0.9,
            "{seen:?}"
        );
        assert!(seen.eye > 0.9 && seen.iris > 0.9 && seen.pupil > 0.9, "{seen:?}");
    }

    #[test]
    fn in_the_open_eye_the_iris_is_between_white_and_pupil_in_brightness_and_both_lids_touch_it() {
        let (skin, hair) = ([0.27, 0.16, 0.11], [0.05; 3]);
        let [y, z] = PUPIL;
        let at = |y: f32, z: f32| Paint::at(Vec3::new(8.3, y, z)).over(skin, hair)[0];
        let (pupil, iris, white) = (at(y, z), at(y, z + 0.4), at(y, z + 0.85));
        assert!(pupil < 0.5 * iris && iris < 0.5 * white, "{pupil} {iris} {white}");
        // What shows of an iris at rest: the lids cover its edge above and below.
        let [upper, lower] = lid_edges(along_lids(z));
        for (off, high) in [(upper - y, 0.5), (y - lower, 0.6)] {
            assert!((0.2..high).contains(&off), "{off}");
        }
        for t in [-0.99, -0.5, 0.0, 0.5, 0.99] {
            let [upper, lower] = lid_edges(t);
            assert!(upper > lower, "the lids cross at {t}");
        }
    }

    #[test]
    fn brows_and_lashes_darken_any_skin_under_any_hair() {
        for (skin, hair) in [([0.8, 0.7, 0.6], [0.01; 3]), ([0.05, 0.03, 0.02], [0.9, 0.8, 0.6])] {
            let bare = Paint::default().over(skin, hair);
            assert_eq!(bare, skin);
            for paint in [Paint { brow: 1.0, ..Paint::default() }, Paint { lashes: 1.0, ..Paint::default() }] {
                let painted = paint.over(skin, hair);
                assert!((0..3).all(|c| painted[c] < 0.6 * skin[c]), "{painted:?}");
            }
        }
    }

    /// Where looks far apart are said to do, what is painted changes little from one to the next.
    #[test]
    fn what_is_painted_is_as_even_as_its_detail_says() {
        let places = (0..60).flat_map(|i| (0..80).map(move |j| (0.25 * i as f32 - 8.0, 0.1 * j as f32 - 0.05)));
        for (y, z) in places {
            for x in [3.0, 5.0, 8.0, 10.0] {
                let p = Vec3::new(x, y, z);
                let step = 0.5 * Paint::detail(p).min(0.2);
                if step < 0.03 {
                    continue;
                }
                let (here, there) = (Paint::at(p), Paint::at(p + step * Vec3::Y));
                assert_eq!((here.brow, here.lashes), (0.0, 0.0), "{p}");
                // The edge of the lips rises from nothing to all of it in 0.2 cm, half as fast again in its middle.
                assert!((here.lips - there.lips).abs() < 1.5 * step / 0.2 + 1e-6, "{p}");
                assert!((here.flush - there.flush).abs() < step, "{p}");
            }
        }
    }
}
