//! The creature's fur: it lies back along the body, longer on mane, belly and tail.

use glam::Vec3;

use super::super::hair::{self, Chance, Lie, Root};
use super::super::net::Skin;
use super::super::rig::smooth;
use super::body;

/// Strands on the body and on mane and tail, which are the denser.
const ON_BODY: usize = 5950;
const ON_TAIL: usize = 1250;
const ON_MANE: usize = 880;
const SEGMENTS: usize = 4;

pub(super) fn strands(skin: &Skin) -> Vec<Vec<Vec3>> {
    let mut roots = hair::spread(skin, ON_BODY, 1, &bears);
    roots.extend(hair::spread(skin, ON_TAIL, 2, &|p| if of_tail(p) > 0.5 { 1.0 } else { 0.0 }));
    roots.extend(hair::spread(skin, ON_MANE, 3, &|p| of_mane(p)));
    roots.into_iter().enumerate().map(|(n, root)| strand(n, root)).collect()
}

/// Nose, eyes and soles are bare.
fn bears(p: Vec3) -> f32 {
    let nose = smooth(p.x, 53.6, 52.4);
    let eye = smooth(p.with_z(p.z.abs()).distance(Vec3::new(46.2, 21.9, 4.0)), 1.5, 2.1);
    let sole = smooth(p.y, -35.0, -34.0);
    nose * eye * sole
}

fn of_tail(p: Vec3) -> f32 {
    smooth(-p.x, 33.0, 41.0)
}

/// Neck and chest, and the withers above.
fn of_mane(p: Vec3) -> f32 {
    let up = 0.7 * (p.x - 21.0) + 0.7 * (p.y - 6.0);
    smooth(up, -8.0, -2.0) * smooth(-up, -19.0, -14.0)
}

fn of_leg(p: Vec3) -> f32 {
    smooth(-p.y, 9.0, 17.0) * (1.0 - of_tail(p))
}

/// How far back from nose and brow on the head.
fn of_head(p: Vec3) -> f32 {
    smooth(0.7 * (p.x - 21.0) + 0.7 * (p.y - 6.0), 15.0, 22.0)
}

/// Where fur lies along the skin.
fn flow(p: Vec3) -> Vec3 {
    let trunk = Vec3::new(-1.0, -0.55 - 0.5 * smooth(p.z.abs(), 3.0, 9.0), 0.0);
    let leg = Vec3::new(-0.35, -1.0, 0.0);
    let mane = Vec3::new(-0.75, -0.8, 0.0);
    let along_tail = if p.x > -48.0 { Vec3::new(-1.0, -0.25, 0.0) } else { Vec3::new(-0.9, -0.5, 0.0) };
    let from_nose = (p - Vec3::new(56.0, 17.0, 0.0)).normalize_or(Vec3::NEG_X);
    let ear = Vec3::new(-0.3, 1.0, 0.0);
    let mut flow = trunk;
    flow = flow.lerp(mane, of_mane(p));
    flow = flow.lerp(leg, of_leg(p));
    flow = flow.lerp(along_tail, of_tail(p));
    flow = flow.lerp(from_nose, of_head(p));
    flow = flow.lerp(ear, smooth(p.y, 26.5, 28.5));
    flow.normalize_or(Vec3::NEG_X)
}

fn length(p: Vec3) -> f32 {
    let belly = smooth(-p.y, 5.0, 11.0) * (1.0 - smooth(-p.y, 12.0, 17.0));
    let mut length = 7.6 + 3.6 * belly;
    length += 4.6 * of_mane(p);
    // Feathers behind the legs, short before and at the paws.
    let feet = 4.4 - 2.4 * smooth(-p.y, 26.0, 32.0);
    length += (feet - length) * of_leg(p);
    let tail = 8.0 + 4.0 * smooth(-p.x, 42.0, 52.0) - 2.5 * smooth(-p.x, 62.0, 71.0);
    length += (tail - length) * of_tail(p);
    // The cheeks have a ruff, the muzzle hardly any.
    let face = 5.6 - 4.5 * smooth(p.x, 39.0, 47.0);
    length += (face - length) * of_head(p);
    // Between the legs there is no room for more.
    length *= 1.0 - 0.6 * smooth(-p.z.abs(), -6.6, -5.0) * smooth(-p.y, 7.0, 12.0) * (1.0 - of_tail(p));
    length += (1.8 - length) * smooth(p.y, 26.5, 28.5);
    length
}

fn strand(n: usize, root: Root) -> Vec<Vec3> {
    let p = root.place;
    let mut chance = Chance::of(7 + n as u64);
    let tuft = hair::tuft(p, 3.2, 5);
    let short = smooth(length(p), 1.2, 5.0);
    let lie = Lie {
        flow: flow(p) + (0.28 * tuft + 0.12 * Vec3::new(chance.about(), chance.about(), chance.about())) * short,
        lift: 0.45 + 0.3 * of_tail(p) + 0.2 * of_mane(p) + 0.12 * chance.about(),
        weight: 0.03 + 0.05 * short,
        length: length(p) * (1.0 - 0.22 * chance.next()) * (1.0 + 0.12 * tuft.x),
        segments: SEGMENTS,
        clear: 0.25 + 0.95 * short * chance.next(),
    };
    hair::lay(&body::skin, root, lie, &flow)
}
