use std::collections::HashSet;
use std::sync::LazyLock;

use nabiki::Head;
use nabiki::glam::{Vec3, vec3};

use super::bust;

static BUST: LazyLock<Head> = LazyLock::new(bust);

#[test]
fn the_bust_is_the_same_on_both_sides_to_the_bit() {
    let (head, mirror) = (&*BUST, Vec3::new(1.0, 1.0, -1.0));
    // Adding 0 turns -0 into +0.
    let place = |p: Vec3| (p + 0.0).to_array().map(f32::to_bits);
    let places: HashSet<_> = head.mesh.positions.iter().map(|&p| place(p)).collect();
    assert_eq!(places.len(), head.mesh.positions.len());
    assert!(head.mesh.positions.iter().all(|&p| places.contains(&place(mirror * p))));
    // A mirrored triangle runs the other way round.
    let named = |t: [u32; 3], sign: Vec3| {
        let mut corners = t.map(|v| place(sign * head.mesh.positions[v as usize]));
        if sign.z < 0.0 {
            corners.reverse();
        }
        let first = (0..3).min_by_key(|&i| corners[i]).unwrap();
        corners.rotate_left(first);
        corners
    };
    let triangles: HashSet<_> = head.mesh.triangles.iter().map(|&t| named(t, Vec3::ONE)).collect();
    assert_eq!(triangles.len(), head.mesh.triangles.len());
    assert!(head.mesh.triangles.iter().all(|&t| triangles.contains(&named(t, mirror))));
    for i in 0..20_000 {
        let [a, b, c] = [0.618_034, 0.754_878, 0.569_84].map(|g: f32| (i as f32 * g).fract() - 0.5);
        let p = vec3(50.0 * a, 70.0 * b - 10.0, 60.0 * c);
        assert_eq!(head.distance(p).to_bits(), head.distance(mirror * p).to_bits(), "{p}");
        assert_eq!(head.outward(p), mirror * head.outward(mirror * p), "{p}");
    }
}

#[test]
fn the_bust_has_an_adult_heads_measures() {
    let head = &*BUST;
    let reach = |from: Vec3, toward: Vec3| {
        let mut t = 0.0;
        while t < 80.0 && head.distance(from + t * toward) > 0.005 {
            t += 0.9 * head.distance(from + t * toward);
        }
        from + t * toward
    };
    let crown = reach(vec3(0.0, 60.0, 0.0), Vec3::NEG_Y).y;
    let chin = head.mesh.positions.iter().filter(|p| p.x > 5.0 && p.z.abs() < 2.0).fold(0.0_f32, |y, p| y.min(p.y));
    let breadth = 2.0 * reach(vec3(-2.0, 4.0, 60.0), Vec3::NEG_Z).z;
    let depth = reach(vec3(60.0, 1.5, 0.0), Vec3::NEG_X).x - reach(vec3(-60.0, 1.5, 0.0), Vec3::X).x;
    let shoulders = 2.0 * head.mesh.positions.iter().fold(0.0_f32, |z, p| z.max(p.z));
    // Within the spread of adults (cm): menton to vertex, head breadth above the ears, head length, bideltoid breadth.
    assert!((21.0..24.5).contains(&(crown - chin)), "height {}", crown - chin);
    assert!((13.8..16.5).contains(&breadth), "breadth {breadth}");
    assert!((17.5..20.5).contains(&depth), "depth {depth}");
    assert!((36.0..46.0).contains(&shoulders), "shoulders {shoulders}");
    let nose = reach(vec3(60.0, -4.5, 0.0), Vec3::NEG_X).x;
    let beside = reach(vec3(60.0, -4.5, 2.5), Vec3::NEG_X).x;
    assert!((1.5..4.5).contains(&(nose - beside)), "nose {}", nose - beside);
}

#[test]
fn the_bust_is_closed_and_faces_outward() {
    let mut mesh = BUST.mesh.clone();
    assert_eq!(mesh.turn_outward(), BUST.orientation);
    assert_eq!(mesh, BUST.mesh);
}

#[test]
fn the_ellipsoid_of_the_bust_is_the_one_that_fits_it() {
    let head = &*BUST;
    let fitted = Head::from_mesh(head.mesh.clone(), None).unwrap().ellipsoid;
    let off = (fitted.half_axes - head.ellipsoid.half_axes).abs().max((fitted.center - head.ellipsoid.center).abs());
    // The skull is no ellipsoid: 0.4 cm is the rms that the fit leaves on real heads.
    assert!(off.max_element() < 0.8, "{fitted:?}");
}
