use glam::{Vec3, vec3};

use super::SkinDistance;
use crate::Mesh;

/// A box from -`half` to `half`, each side two triangles.
fn cuboid(half: Vec3) -> Mesh {
    let corner = |i: u32| half * vec3((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32) * 2.0 - half;
    let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    Mesh {
        positions: (0..8).map(corner).collect(),
        triangles: sides.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect(),
        ..Mesh::default()
    }
}

fn to_cuboid(half: Vec3, p: Vec3) -> f32 {
    let q = p.abs() - half;
    q.max(Vec3::ZERO).length() + q.max_element().min(0.0)
}

fn scattered(reach: f32) -> impl Iterator<Item = Vec3> {
    (0..3000).map(move |i| {
        let [a, b, c] = [0.754_877_7, 0.569_840_3, 0.430_159_7].map(|g: f32| (i as f32 * g).fract() - 0.5);
        2.0 * reach * vec3(a, b, c)
    })
}

const HALF: Vec3 = Vec3::new(4.0, 3.0, 2.0);

/// The largest error against the cuboid's own distance, near the skin.
fn worst_near_the_skin(mesh: &Mesh) -> f32 {
    let skin = SkinDistance::new(mesh, Vec3::splat(-8.0), Vec3::splat(8.0), 0.25);
    scattered(6.0)
        .filter(|&p| to_cuboid(HALF, p).abs() < 0.5)
        .map(|p| (skin.at(p) - to_cuboid(HALF, p)).abs())
        .fold(0.0, f32::max)
}

// Where the distance has a kink, at the edges and within on their bisectors, interpolation over a step h misses it by
// at most h / 2 at a corner; between kinks it is exact, for the sides are flat.
#[test]
fn near_the_skin_a_box_is_met_to_half_a_step() {
    assert!(worst_near_the_skin(&cuboid(HALF)) < 0.125);
}

#[test]
fn beyond_the_sampled_box_distance_is_exact() {
    let skin = SkinDistance::new(&cuboid(HALF), Vec3::splat(-1.0), Vec3::splat(1.0), 0.25);
    for p in scattered(12.0).filter(|p| p.abs().max_element() > 1.5) {
        assert!((skin.at(p) - to_cuboid(HALF, p)).abs() < 1e-4, "{p}");
    }
}

#[test]
fn far_from_the_skin_the_sign_is_right_and_distance_within_a_tenth() {
    let skin = SkinDistance::new(&cuboid(HALF), Vec3::splat(-8.0), Vec3::splat(8.0), 0.25);
    for p in scattered(8.0).filter(|&p| to_cuboid(HALF, p).abs() > 1.0) {
        let (found, real) = (skin.at(p), to_cuboid(HALF, p));
        // A coarse step of 1 cm over the kink in the middle of the box, and a twentieth of slack.
        assert!(
            found.signum() == real.signum() && (found - real).abs() < 0.05 * real.abs() + 0.5,
            "{p} {found} {real}"
        );
    }
}

#[test]
fn a_missing_side_counts_as_closed() {
    for side in 0..6 {
        let mut open = cuboid(HALF);
        open.triangles.drain(2 * side..2 * side + 2);
        assert!(worst_near_the_skin(&open) < 0.125, "side {side}");
    }
}

#[test]
fn doubled_vertices_at_a_seam_leave_no_hole() {
    let whole = cuboid(HALF);
    let mut seamed = Mesh::default();
    for triangle in &whole.triangles {
        let first = seamed.positions.len() as u32;
        seamed.positions.extend(triangle.map(|v| whole.positions[v as usize]));
        seamed.triangles.push([first, first + 1, first + 2]);
    }
    assert!(worst_near_the_skin(&seamed) < 0.125);
}

#[test]
fn a_stray_triangle_turns_nothing_inside_out() {
    let mut mesh = cuboid(HALF);
    mesh.positions.extend([vec3(6.0, 6.0, 6.0), vec3(7.0, 6.0, 6.0), vec3(6.0, 7.0, 6.0)]);
    mesh.triangles.push([8, 9, 10]);
    mesh.triangles.push(mesh.triangles[0]);
    let skin = SkinDistance::new(&mesh, Vec3::splat(-8.0), Vec3::splat(8.0), 0.25);
    for p in scattered(8.0).filter(|&p| to_cuboid(HALF, p).abs() > 0.3) {
        assert_eq!(skin.at(p) < 0.0, to_cuboid(HALF, p) < 0.0, "{p}");
    }
}

#[test]
fn the_gradient_points_away_from_flat_sides() {
    let skin = SkinDistance::new(&cuboid(HALF), Vec3::splat(-8.0), Vec3::splat(8.0), 0.25);
    assert!(skin.gradient(vec3(4.2, 0.3, 0.1)).distance(Vec3::X) < 1e-3);
    assert!(skin.gradient(vec3(0.2, -2.9, 0.1)).distance(Vec3::NEG_Y) < 1e-3);
}

#[test]
fn a_place_that_is_no_number_has_no_distance_and_does_no_harm() {
    let skin = SkinDistance::new(&cuboid(HALF), Vec3::splat(-8.0), Vec3::splat(8.0), 0.25);
    assert!(skin.at(Vec3::NAN).is_nan() || skin.at(Vec3::NAN) > 0.0);
    assert!(skin.at(Vec3::splat(f32::INFINITY)) > 0.0);
}

#[test]
fn loose_triangles_are_closed_each_by_itself() {
    let mut soup = Mesh::default();
    for i in 0..60_000 {
        let p = vec3((i % 200) as f32, (i / 200) as f32, 0.0);
        let first = soup.positions.len() as u32;
        soup.positions.extend([p, p + 0.1 * Vec3::X, p + 0.1 * Vec3::Y]);
        soup.triangles.push([first, first + 1, first + 2]);
    }
    assert_eq!(super::rims::closed(&soup).triangles.len(), 4 * soup.triangles.len());
}
