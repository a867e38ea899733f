//! Beard and brows: long at the chin, short at the cheeks, combed down; the moustache is parted and combed to the sides.

use glam::Vec3;
use nabiki_groom::face;

use super::super::hair::{self, Chance, Lie, Root};
use super::super::net::Skin;
use super::{mouth, smooth};
use crate::field;

const ON_CHIN: usize = 3300;
const ON_LIP: usize = 560;
const ON_BROWS: usize = 420;

pub(super) fn strands(skin: &Skin) -> Vec<Vec<Vec3>> {
    let chin = hair::spread(skin, ON_CHIN, 11, &bears);
    let lip = hair::spread(skin, ON_LIP, 12, &on_lip);
    let brows = hair::spread(skin, ON_BROWS, 13, &on_brow);
    let of = |kind: fn(Root, &mut Chance) -> Vec<Vec3>, roots: Vec<Root>, seed: u64| {
        roots.into_iter().enumerate().map(move |(n, root)| kind(root, &mut Chance::of(seed + n as u64)))
    };
    of(of_chin, chin, 1 << 20).chain(of(of_lip, lip, 2 << 20)).chain(of(of_brow, brows, 3 << 20)).collect()
}

fn on_right(p: Vec3) -> Vec3 {
    p.with_z(p.z.abs())
}

/// Whether a place is on the outside of the face, not within the mouth.
fn outside(p: Vec3) -> f32 {
    smooth(field(p), -0.12, -0.06)
}

/// The cheek's line, from before the ear to the corner of the moustache.
fn below_cheek(p: Vec3) -> f32 {
    let t = ((p.x - 0.6) / 7.2).clamp(0.0, 1.0);
    let line = -2.4 + (-6.4 + 2.4) * (t + 0.35 * t * (1.0 - t));
    line - p.y
}

fn bears(p: Vec3) -> f32 {
    let p = on_right(p);
    if p.x < -0.5 || p.y > 0.5 || p.y < -15.0 {
        return 0.0;
    }
    let cheek = smooth(below_cheek(p), -0.2, 1.0);
    let sideburn = smooth(p.x, -0.1, 0.4) * smooth(-p.x, -2.4, -1.6) * smooth(-p.y, -0.4, 0.6) * smooth(p.z, 5.5, 6.2);
    let neck = smooth(p.y, -13.2 + 0.7 * (3.0 - p.x).max(0.0), -11.8 + 0.7 * (3.0 - p.x).max(0.0));
    let before_ear = smooth(p.x, -0.1, 0.5);
    let t = face::along_lips(p.z);
    let [_, lower] = face::lip_edges(p.z, t.min(1.0));
    // Nothing grows on the lips; under the lower one there is a bare place on either side of the middle.
    let off_lips = if p.x > 5.5 && p.z < 3.3 { smooth(lower - p.y, 0.05, 0.35) } else { 1.0 };
    let hollow = 1.0 - 0.85 * smooth(p.z, 0.6, 1.1) * smooth(-p.z, -2.6, -2.0) * smooth(p.y, -9.3, -8.8);
    (cheek.max(sideburn) * neck * before_ear * off_lips * hollow * outside(p)).clamp(0.0, 1.0)
}

fn on_lip(p: Vec3) -> f32 {
    let p = on_right(p);
    if p.x < 6.5 || p.z > 4.2 || p.y > -5.0 || p.y < -8.2 {
        return 0.0;
    }
    let t = face::along_lips(p.z);
    let [upper, _] = face::lip_edges(p.z, t.min(1.0));
    let above = smooth(p.y - upper, if t < 1.0 { 0.02 } else { -1.0 }, 0.2);
    let below_nose = smooth(-p.y, 5.42 + 0.1 * p.z * p.z, 5.62 + 0.1 * p.z * p.z);
    let groove = 0.55 + 0.45 * smooth(p.z, 0.1, 0.5);
    above * below_nose * groove * outside(p)
}

fn on_brow(p: Vec3) -> f32 {
    let p = on_right(p);
    let t = face::along_brow(p.z);
    if p.x < 4.0 || !(0.0..=1.0).contains(&t) {
        return 0.0;
    }
    let half = 0.42 - 0.22 * t;
    let off = (p.y - face::brow_line(t) - 0.1).abs();
    smooth(-off, -half, -0.4 * half) * smooth(t, 0.0, 0.12) * smooth(-t, -1.0, -0.8)
}

fn of_chin(root: Root, chance: &mut Chance) -> Vec<Vec3> {
    let p = on_right(root.place);
    let side = root.place.z.signum();
    let front = smooth(p.x, 1.5, 7.0) * smooth(-p.y, 7.6, 10.2);
    let grown = smooth(below_cheek(p), 0.0, 4.5);
    let under = smooth(-root.normal.y, 0.2, 0.8);
    let length = (0.8 + 2.2 * grown + 3.2 * front) * (1.0 - 0.3 * under) * (1.0 - 0.25 * chance.next());
    let tuft = hair::tuft(root.place, 1.3, 21);
    let flow = Vec3::new(0.22 + 0.5 * under, -1.0, -0.1 * side * (1.0 - front));
    let lie = Lie {
        flow: flow + 0.22 * tuft + 0.1 * Vec3::new(chance.about(), chance.about(), chance.about()),
        lift: 0.5 + 0.2 * chance.about(),
        weight: 0.16,
        length,
        segments: if length > 2.5 { 5 } else { 4 },
        clear: 0.15 + 0.75 * grown * chance.next(),
    };
    hair::lay(&mouth::skin, root, lie, &|_| flow * 0.4)
}

fn of_lip(root: Root, chance: &mut Chance) -> Vec<Vec3> {
    let p = on_right(root.place);
    let side = if p.z < 0.15 && chance.next() < 0.5 { -1.0 } else { 1.0 } * root.place.z.signum();
    let out = 0.55 + 0.3 * smooth(p.z, 0.0, 2.5);
    let flow = Vec3::new(0.05, -0.75, side * out);
    let lie = Lie {
        flow: flow + 0.12 * Vec3::new(chance.about(), chance.about(), chance.about()),
        lift: 0.55 + 0.15 * chance.about(),
        weight: 0.1,
        length: (1.25 + 0.6 * smooth(p.z, 0.3, 2.5)) * (1.0 - 0.25 * chance.next()),
        segments: 4,
        clear: 0.12 + 0.25 * chance.next(),
    };
    hair::lay(&field, root, lie, &|_| flow * 0.6)
}

fn of_brow(root: Root, chance: &mut Chance) -> Vec<Vec3> {
    let p = on_right(root.place);
    let t = face::along_brow(p.z);
    let side = root.place.z.signum();
    let flow = Vec3::new(0.0, 0.7 - 1.1 * t, side * (0.3 + 0.8 * t));
    let lie = Lie {
        flow: flow + 0.2 * Vec3::new(0.0, chance.about(), chance.about()),
        lift: 0.35,
        weight: 0.0,
        length: 0.7 + 0.25 * chance.next(),
        segments: 2,
        clear: 0.08 + 0.06 * chance.next(),
    };
    hair::lay(&field, root, lie, &|_| flow * 0.5)
}
