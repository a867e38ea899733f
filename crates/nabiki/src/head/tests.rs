use glam::{Vec3, vec3};

use super::Head;
use crate::sketch::{self, egg};
use crate::{Ellipsoid, Mesh};

fn refused(mesh: Mesh, ellipsoid: Option<Ellipsoid>) -> String {
    Head::from_mesh(mesh, ellipsoid).expect_err("refused").to_string()
}

#[test]
fn an_ellipsoid_is_found_again_wherever_it_is_and_however_large() {
    for (size, center) in [(1.0, Vec3::ZERO), (0.01, vec3(3.0, 1.6, -2.0)), (250.0, vec3(-40.0, 900.0, 70.0))] {
        let made = Ellipsoid { center, half_axes: size * vec3(9.6, 10.4, 7.9) };
        let found = Head::from_mesh(egg(made, 60), None).unwrap().ellipsoid;
        // The positions are rounded to f32, relative to the largest coordinate.
        let rounding = 40.0 * f32::EPSILON * center.abs().max_element();
        let off = (found.half_axes - made.half_axes).abs().max((found.center - center).abs()).max_element();
        assert!(off < 1e-4 * size + rounding, "{made:?} but {found:?}");
    }
}

#[test]
fn distance_gradient_and_inside_agree_on_an_egg() {
    let e = Ellipsoid { center: vec3(1.0, 2.0, -0.5), half_axes: vec3(9.5, 11.0, 8.0) };
    let head = Head::from_mesh(egg(e, 80), Some(e)).unwrap();
    for i in 0..500 {
        let (y, around) = (1.0 - (i as f32 + 0.5) / 250.0, 2.4 * i as f32);
        let u = vec3((1.0 - y * y).sqrt() * around.cos(), y, (1.0 - y * y).sqrt() * around.sin());
        let (on, normal) = (e.center + e.half_axes * u, (u / e.half_axes).normalize());
        for away in [-0.4, 0.0, 0.3] {
            let p = on + away * normal;
            // Facets of 0.4 cm and samples 0.33 cm apart on a radius of at least 8^2 / 11 cm leave 0.01 cm.
            assert!((head.distance(p) - away).abs() < 0.01, "{p}");
            assert!(head.outward(p).dot(normal) > 0.998, "{p}");
        }
        assert!(head.contains(on - 0.1 * normal) && !head.contains(on + 0.1 * normal));
    }
}

#[test]
fn a_triangle_that_is_turned_takes_its_texture_with_it() {
    let mut mesh = egg(Ellipsoid { center: vec3(0.0, 1.0, 2.0), half_axes: vec3(9.0, 11.0, 8.0) }, 12);
    let at = |positions: &[Vec3], t: &[u32; 3]| t.map(|v| positions[v as usize].truncate());
    mesh.triangles.iter_mut().step_by(3).for_each(|t| t.swap(1, 2));
    mesh.corner_uvs = Some(mesh.triangles.iter().map(|t| at(&mesh.positions, t)).collect());
    assert!(mesh.turn_outward().turned > 10);
    for (t, uvs) in mesh.triangles.iter().zip(mesh.corner_uvs.as_ref().unwrap()) {
        assert_eq!(at(&mesh.positions, t), *uvs);
    }
}

#[test]
fn a_head_exported_with_two_sides_has_an_inside() {
    let e = Ellipsoid { center: Vec3::ZERO, half_axes: vec3(9.0, 11.0, 8.0) };
    let one = egg(e, 24);
    let mut two = one.clone();
    // By a copy of each vertex, as programs write sides apart.
    let first = one.positions.len() as u32;
    two.positions.extend(&one.positions);
    two.triangles.extend(one.triangles.iter().map(|&[a, b, c]| [a + first, c + first, b + first]));
    let head = Head::from_mesh(two, Some(e)).unwrap();
    let slivers = 2 * 48;
    assert!(head.orientation.doubled + slivers >= one.triangles.len(), "{:?}", head.orientation);
    let alone = Head::from_mesh(one, Some(e)).unwrap();
    assert!(head.contains(Vec3::ZERO) && !head.contains(vec3(0.0, 14.0, 0.0)));
    // Near the skin both are that of the mesh.
    for p in [vec3(8.8, 0.0, 0.0), vec3(9.2, 0.0, 0.0), vec3(0.0, 0.0, 8.3)] {
        assert!((head.distance(p) - alone.distance(p)).abs() < 1e-4, "{p}");
    }
}

#[test]
fn what_is_no_mesh_is_refused_by_name() {
    let sound = egg(Ellipsoid { center: Vec3::ZERO, half_axes: vec3(9.0, 10.0, 8.0) }, 12);
    assert!(refused(Mesh::default(), None).starts_with("head.mesh = no triangles"));
    let mut points = sound.clone();
    points.triangles.iter_mut().for_each(|t| t[1] = t[0]);
    assert!(refused(points, None).starts_with("head.mesh = only triangles without area"));
    let mut lost = sound.clone();
    lost.triangles[5][1] = 100_000;
    assert!(refused(lost, None).starts_with("head.mesh = index 100000"));
    let mut torn = sound.clone();
    torn.positions[7].y = f32::NAN;
    assert!(refused(torn, None).starts_with("head.mesh = vertex 7 at"));

    let uvs =
        |count: usize, uv: f32| Mesh { corner_uvs: Some(vec![[glam::Vec2::splat(uv); 3]; count]), ..sound.clone() };
    let text = refused(uvs(7, 0.0), None);
    assert!(text.starts_with("head.mesh = texture coordinates of 7 triangles"), "{text}");
    let text = refused(uvs(sound.triangles.len(), f32::NAN), None);
    assert!(text.starts_with("head.mesh = triangle 0 with texture coordinates that are not finite"), "{text}");
    let mut flat = sound.clone();
    flat.positions.iter_mut().for_each(|p| p.y = 0.0);
    assert!(refused(flat, None).starts_with("head.mesh = no skull, 576 triangles, 18.000 x 0.000 x 16.000 cm"));
}

#[test]
fn what_is_no_ellipsoid_is_refused_by_name() {
    let sound = Ellipsoid { center: Vec3::ZERO, half_axes: vec3(9.0, 10.0, 8.0) };
    let mesh = egg(sound, 12);
    let nowhere = Ellipsoid { center: vec3(0.0, f32::INFINITY, 0.0), ..sound };
    assert!(refused(mesh.clone(), Some(nowhere)).starts_with("head.ellipsoid.center"));
    for half_axes in [vec3(9.0, 0.0, 8.0), vec3(9.0, f32::NAN, 8.0), vec3(-9.0, 10.0, 8.0), vec3(90.0, 10.0, 8.0)] {
        let text = refused(mesh.clone(), Some(Ellipsoid { half_axes, ..sound }));
        assert!(text.starts_with("head.ellipsoid.half_axes"), "{text}");
    }
}

proptest::proptest! {
    #![proptest_config(proptest::prelude::ProptestConfig::with_cases(60))]

    #[test]
    fn any_heap_of_triangles_is_a_head_or_refused(
        corners in proptest::collection::vec((-20.0_f32..20.0, -20.0_f32..20.0, -20.0_f32..20.0), 3..12),
        picks in proptest::collection::vec((0_u32..3, 0_u32..12, 0_u32..12), 1..20),
        flat in proptest::bool::ANY,
        fit in proptest::bool::ANY,
    ) {
        let lift = if flat { 0.0 } else { 1.0 };
        let positions: Vec<Vec3> = corners.iter().map(|&(x, y, z)| vec3(x, lift * y, z)).collect();
        let count = positions.len() as u32;
        let triangles = picks.iter().map(|&(a, b, c)| [a, b % count, c % count]).collect();
        let mesh = Mesh { positions, triangles, ..Mesh::default() };
        let given = Ellipsoid { center: Vec3::ZERO, half_axes: vec3(9.0, 10.0, 8.0) };
        if let Ok(head) = Head::from_mesh(mesh, (!fit).then_some(given)) {
            proptest::prop_assert!(head.distance(Vec3::ZERO).is_finite());
            proptest::prop_assert!(head.outward(vec3(3.0, 4.0, 5.0)).is_normalized());
        }
    }
}

/// A ball with its cap cut off along a circle of 40 degrees: the sagitta of the cap is what is missing.
#[test]
fn a_hole_where_hair_grows_is_told_from_one_below() {
    let ball = Ellipsoid { center: vec3(3.0, -2.0, 1.0), half_axes: Vec3::splat(10.0) };
    let whole = egg(ball, 90);
    let cos = (40.0_f32).to_radians().cos();
    let without = |axis: Vec3| {
        let mut mesh = whole.clone();
        mesh.triangles
            .retain(|t| t.iter().any(|&v| (whole.positions[v as usize] - ball.center).dot(axis) < 10.0 * cos));
        let mut openings = Head::from_mesh(mesh, Some(ball)).unwrap().openings;
        // The lowest corners of the egg lie apart by the rounding of pi.
        openings.retain(|hole| hole.radius > 1e-4);
        openings
    };
    for (axis, on_scalp) in [
        (Vec3::Y, true),
        (vec3(-0.8, 0.6, 0.0), true),
        (vec3(0.0, 0.8, 0.6), true),
        (Vec3::NEG_Y, false),
        (vec3(0.9, -0.436, 0.0), false),
    ] {
        let [hole] = without(axis)[..] else { panic!("{axis}: one hole") };
        assert_eq!(hole.missing.is_some(), on_scalp, "{axis}: {hole:?}");
        // About the egg's own axis the rim is a circle; elsewhere its corners lie closer on one side than on the other.
        if axis.y.abs() < 1.0 {
            continue;
        }
        // Triangles are 2 degrees high and wide, and go as a whole.
        let (low, high) = ((40.0_f32 - 3.0).to_radians(), 40.0_f32.to_radians());
        assert!((10.0 * low.sin()..=10.0 * high.sin() + 1e-3).contains(&hole.radius), "{axis}: {hole:?}");
        let sagitta = (10.0 * (1.0 - low.cos()), 10.0 * (1.0 - high.cos()) + 1e-3);
        assert!(hole.missing.is_none_or(|missing| (sagitta.0..=sagitta.1).contains(&missing)), "{axis}: {hole:?}");
    }
}

#[test]
fn a_head_beyond_any_size_is_refused() {
    for (size, said) in [(1e-9, "a head of 1.000e-9 cm"), (1e20, "a head of 1.000e20 cm")] {
        let ball = Ellipsoid { center: Vec3::ZERO, half_axes: Vec3::splat(size) };
        let line = refused(egg(ball, 12), Some(ball));
        assert!(
            line.starts_with("head.mesh = ") && line.contains(said) && line.ends_with("correct head.unit"),
            "{line}"
        );
    }
}

#[test]
fn a_head_of_stored_samples_is_the_head_and_what_is_none_is_refused() {
    let head = sketch::head();
    let samples = || head.skin().samples().clone();
    let again = Head::from_samples(head.mesh.clone(), head.ellipsoid, samples()).unwrap();
    for i in 0..2000 {
        let share = [0.618_034, 0.754_878, 0.569_84].map(|g: f32| 2.0 * (i as f32 * g).fract() - 1.0);
        let p = Vec3::from_array(share) * vec3(30.0, 40.0, 40.0);
        assert_eq!(again.distance(p).to_bits(), head.distance(p).to_bits(), "{p}");
        assert_eq!((again.depth(p), again.outward(p)), (head.depth(p), head.outward(p)), "{p}");
    }
    let refused = |mesh: Mesh, half_axes: Vec3, cell: f32| {
        let samples = crate::distance::Samples { cell, ..samples() };
        Head::from_samples(mesh, Ellipsoid { half_axes, ..head.ellipsoid }, samples).unwrap_err().thing
    };
    let half_axes = head.ellipsoid.half_axes;
    assert_eq!(refused(Mesh::default(), half_axes, 1.0), "head.mesh");
    assert_eq!(refused(head.mesh.clone(), Vec3::ZERO, 1.0), "head.ellipsoid.half_axes");
    assert_eq!(refused(head.mesh.clone(), 1e6 * half_axes, 1.0), "head.mesh");
    assert_eq!(refused(head.mesh.clone(), half_axes, -1.0), "samples.cell");
}
