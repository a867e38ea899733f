use super::*;
use crate::distance::SkinDistance;

/// A ball of mesh about the origin, open at the bottom as a bust is.
fn ball(radius: f32) -> Mesh {
    let (rings, sides) = (48_u32, 64_u32);
    let mut mesh = Mesh::default();
    for i in 0..=rings {
        for j in 0..sides {
            let polar = 2.8 * i as f32 / rings as f32;
            let azimuth = std::f32::consts::TAU * j as f32 / sides as f32;
            mesh.positions
                .push(radius * Vec3::new(polar.sin() * azimuth.cos(), polar.cos(), polar.sin() * azimuth.sin()));
        }
    }
    let at = |i: u32, j: u32| i * sides + j % sides;
    for i in 0..rings {
        for j in 0..sides {
            mesh.triangles.push([at(i, j), at(i, j + 1), at(i + 1, j)]);
            mesh.triangles.push([at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)]);
        }
    }
    mesh
}

const SPACING: f32 = 0.3;

/// A ball that breathes by 4 % and bends to the side.
fn breathing() -> (BendingSkin, Vec<Vec<Vec3>>, Mesh) {
    let mesh = ball(8.0);
    let frame = |n: usize| {
        let swing = (0.4 * n as f32).sin();
        mesh.positions.iter().map(|p| (1.0 + 0.04 * swing) * *p + Vec3::X * (0.01 * swing * p.y * p.y)).collect()
    };
    let frames: Vec<Vec<Vec3>> = (0..6).map(frame).collect();
    let rest = Arc::new(SkinDistance::new(&mesh, Vec3::splat(-16.0), Vec3::splat(16.0), SPACING));
    (BendingSkin::new(rest.clone(), &mesh, &frames, rest.sampled_box(), 0.5), frames, mesh)
}

/// Near the skin distances are as right as those of a rigid mesh of that shape; beyond, they are on the same side and not too large.
#[test]
fn distances_are_those_of_the_shape_in_each_frame() {
    let (bending, frames, mesh) = breathing();
    for n in [0, 3, 5] {
        let shape = Mesh { positions: frames[n].clone(), ..mesh.clone() };
        let exact = SkinDistance::new(&shape, Vec3::splat(-16.0), Vec3::splat(16.0), SPACING);
        let mut near = 0;
        for i in 0..8000 {
            let [x, y, z] = [i % 20, i / 20 % 20, i / 400].map(|i| i as f32 * 1.5 - 14.3);
            let p = Vec3::new(x, y, z);
            let (found, truth) = (bending.read(p, n as u32).unwrap().distance, exact.exact(p));
            if truth.abs() < 0.5 {
                // Between samples a step h apart, facets that meet at an angle are off by a quarter of h times that: along both
                // ways of a vertex, a tenth of a radian and 0.06; at the rim, where a fan closes the ball, a third of a radian more.
                let angle = if p.y < -6.0 { 0.16 + 0.34 } else { 0.16 };
                assert!((found - truth).abs() < SPACING * angle / 4.0, "frame {n}, {p}: {found} for {truth}");
                near += 1;
            } else {
                assert!(found * truth > 0.0, "frame {n}, {p}: {found} for {truth}");
                // In the middle of a coarse cell a band may be read that is not there.
                assert!(found.abs() < 1.05 * truth.abs() + 0.1, "frame {n}, {p}: {found} for {truth}");
            }
        }
        assert!(near > 100, "{near}");
    }
}

/// Skin moves as its vertices do, and no part of it farther than is said.
#[test]
fn motion_is_that_of_the_skin() {
    let (bending, frames, _) = breathing();
    assert_eq!((bending.farthest_moved(0), bending.moved(Vec3::X * 8.0, 0)), (0.0, Vec3::ZERO));
    assert_eq!((bending.farthest_moved(6), bending.moved(Vec3::X * 8.0, 6)), (0.0, Vec3::ZERO), "after the last frame");
    for n in 1..6 {
        let mut farthest = 0.0_f32;
        for (now, before) in frames[n].iter().zip(&frames[n - 1]) {
            let moved = *now - *before;
            farthest = farthest.max(moved.length());
            let found = bending.moved(*now, n as u32);
            // The ways of vertices a cell of 1.2 cm apart differ by 4 % and 0.02 y of that in five sixths of a frame.
            assert!(found.distance(moved) < 0.06, "frame {n}, {now}: {found} for {moved}");
        }
        assert_eq!(bending.farthest_moved(n as u32), farthest);
    }
}

/// Between two frames, distances are between theirs.
#[test]
fn part_of_a_frame_is_between_two() {
    let (bending, ..) = breathing();
    let p = Vec3::new(3.0, 5.0, -5.5);
    let [before, now] = [2, 3].map(|frame| bending.read(p, frame).unwrap().distance);
    for part in [0.25, 0.5, 1.0] {
        let found = bending.read_during(p, 3, part).unwrap().distance;
        assert!((found - (before + part * (now - before))).abs() < 1e-6, "{part}: {found} of {before} and {now}");
    }
}

/// Faces that look inward are turned, as those of rigid meshes are.
#[test]
fn a_mesh_inside_out_is_the_same_body() {
    let (bending, frames, mut mesh) = breathing();
    mesh.triangles.iter_mut().for_each(|triangle| triangle.swap(0, 1));
    let rest = bending.rest.clone();
    let turned = BendingSkin::new(rest.clone(), &mesh, &frames, rest.sampled_box(), 0.5);
    for p in [Vec3::new(0.0, 7.0, 0.0), Vec3::new(0.0, 9.0, 0.0), Vec3::new(5.0, 5.5, 1.0), Vec3::ZERO] {
        let [one, other] = [&bending, &turned].map(|skin| skin.read(p, 3).unwrap().distance);
        assert!(one * other > 0.0 && (one - other).abs() < 1e-4, "{p}: {one} and {other}");
    }
}

/// Skin that leaves the box where hair is touches nothing there.
#[test]
fn a_body_that_is_away_is_away() {
    let mesh = ball(8.0);
    let frames = vec![mesh.positions.iter().map(|p| *p + 100.0 * Vec3::X).collect()];
    let rest = Arc::new(SkinDistance::new(&mesh, Vec3::splat(-16.0), Vec3::splat(16.0), SPACING));
    let clearance = 5.0;
    let skin = BendingSkin::new(rest.clone(), &mesh, &frames, rest.sampled_box(), clearance);
    assert!(skin.read(Vec3::new(8.0, 0.0, 0.0), 0).unwrap().distance > clearance);
    assert_eq!(skin.farthest_moved(0), 0.0);
}
