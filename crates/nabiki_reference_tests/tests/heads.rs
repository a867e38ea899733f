//! Real heads: the fitted ellipsoid lies on each scalp, and the distance agrees with a published grid.

use glam::Vec3;
use nabiki::{Ellipsoid, Head, Mesh};
use nabiki_reference_tests::shared;

/// The triangles of an .obj file, or of one group of it, in head space: y up as they are, face from +z to +x.
fn read(path: &str, group: Option<&str>, cm: f32) -> Mesh {
    let text = std::fs::read_to_string(shared(path)).expect("readable");
    let mut mesh = Mesh::default();
    let mut wanted = group.is_none();
    for line in text.lines() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                let p: Vec<f32> = words.take(3).map(|w| w.parse().expect("a coordinate")).collect();
                mesh.positions.push(cm * Vec3::new(p[2], p[1], -p[0]));
            }
            Some("g") => wanted = group.is_none_or(|g| words.next() == Some(g)),
            Some("f") if wanted => {
                let corner = |w: &str| w.split('/').next().and_then(|i| i.parse::<u32>().ok()).expect("an index") - 1;
                let face: Vec<u32> = words.map(corner).collect();
                mesh.triangles.extend((2..face.len()).map(|i| [face[0], face[i - 1], face[i]]));
            }
            _ => {}
        }
    }
    mesh
}

/// Distances of the skin from E over the back and top of the skull, in shares of the mean half axis: those of the
/// points where rays from the centre leave the skin, evenly over the directions where hair grows on anyone.
fn off_the_scalp(head: &Head) -> Vec<f32> {
    let Ellipsoid { center, half_axes } = head.ellipsoid;
    let golden = std::f32::consts::PI * (3.0 - 5.0_f32.sqrt());
    let directions = (0..2000).map(|i| {
        let y = 1.0 - (i as f32 + 0.5) / 1000.0;
        let (sin, cos) = (golden * i as f32).sin_cos();
        Vec3::new((1.0 - y * y).sqrt() * cos, y, (1.0 - y * y).sqrt() * sin)
    });
    directions
        .filter(|u| u.y > 0.3 && u.x < 0.5 || u.y > -0.2 && u.x < -0.6)
        .map(|u| {
            let mut t = 1.0;
            for _ in 0..20 {
                t -= head.distance(center + t * u * half_axes) / (u * half_axes).length();
            }
            (t - 1.0) * (u * half_axes).length() / (half_axes.element_sum() / 3.0)
        })
        .collect()
}

/// Fits E to a head whose skull should have these half axes (cm), give or take `within` of each.
fn lies_on_the_scalp(mesh: Mesh) -> Ellipsoid {
    let head = Head::from_mesh(mesh, None).expect("a head");
    let off = off_the_scalp(&head);
    let rms = (off.iter().map(|d| d * d).sum::<f32>() / off.len() as f32).sqrt();
    let worst = off.iter().fold(0.0_f32, |w, d| w.max(d.abs()));
    println!("{:?} rms {:.2} % worst {:.2} %", head.ellipsoid, 100.0 * rms, 100.0 * worst);
    assert!(rms < 0.04, "{rms}");
    head.ellipsoid
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs the shared reference data beside the project")]
fn the_scanned_head_gets_an_ellipsoid_on_its_scalp() {
    // The scan's unit is its own; its head of 4.5 units is taken for one of 22.5 cm.
    let mesh = read("heads/lps_head.obj", None, 5.0);
    lies_on_the_scalp(mesh);
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs the shared reference data beside the project")]
fn the_sintel_bust_gets_an_ellipsoid_on_its_scalp() {
    let mesh = read("heads/sintel_bust.obj", None, 100.0);
    lies_on_the_scalp(mesh);
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs the shared reference data beside the project")]
fn the_makehuman_body_gets_an_ellipsoid_on_its_scalp() {
    let mesh = read("heads/makehuman_base.obj", Some("body"), 10.0);
    lies_on_the_scalp(mesh);
}

/// The grid file: 64, 0, the box's corners, then 64^3 distances at the middles of the cells, x fastest.
fn published_grid() -> (Vec3, Vec3, Vec<f32>) {
    let bytes = std::fs::read(shared("heads/sintel_collider_sdf64.bin")).expect("readable");
    let words: Vec<[u8; 4]> = bytes.chunks_exact(4).map(|c| c.try_into().expect("four bytes")).collect();
    assert_eq!((u32::from_le_bytes(words[0]), words.len()), (64, 8 + 64 * 64 * 64));
    let numbers: Vec<f32> = words[2..].iter().map(|&w| f32::from_le_bytes(w)).collect();
    (Vec3::from_slice(&numbers[..3]), Vec3::from_slice(&numbers[3..6]), numbers[6..].to_vec())
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs the shared reference data beside the project")]
fn distance_agrees_with_a_published_grid() {
    let mesh = read("heads/sintel_collider.obj", None, 100.0);
    let (low, high, grid) = published_grid();
    let head = Head::from_mesh(mesh, None).expect("a head");
    let (mut worst_near, mut worst_far) = (0.0_f32, 0.0_f32);
    for (i, &metres) in grid.iter().enumerate() {
        let cell = Vec3::new((i % 64) as f32, (i / 64 % 64) as f32, (i / 4096) as f32);
        let p = 100.0 * (low + (cell + 0.5) * (high - low) / 64.0);
        let (found, real) = (head.distance(Vec3::new(p.z, p.y, -p.x)), 100.0 * metres);
        if real.abs() < 0.5 {
            worst_near = worst_near.max((found - real).abs());
        } else {
            worst_far = worst_far.max((found - real).abs() / real.abs());
            assert_eq!(found < 0.0, real < 0.0, "{p}");
        }
    }
    println!("worst error {worst_near} cm near the skin, {:.1} % far from it", 100.0 * worst_far);
    // Samples 0.33 cm apart miss a kink of the facets (up to a right angle, at the nose) by half a step at most.
    assert!(worst_near < 0.17, "{worst_near}");
    // The grid's own error, the slack of a twentieth, and a coarse step of 1.3 cm across the skull's middle.
    assert!(worst_far < 0.3, "{worst_far}");
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs the shared reference data beside the project")]
fn an_open_bust_is_solid_inside() {
    let mesh = read("heads/sintel_bust.obj", None, 100.0);
    let head = Head::from_mesh(mesh, None).expect("a head");
    let middle = head.ellipsoid.center;
    assert!(head.contains(middle) && head.distance(middle) < -5.0);
    assert!(head.contains(middle - 18.0 * Vec3::Y), "the neck");
    for away in [40.0 * Vec3::Y, 40.0 * Vec3::Z, -40.0 * Vec3::X, 40.0 * Vec3::X, -60.0 * Vec3::Y] {
        assert!(head.distance(middle + away) > 10.0, "{away}");
    }
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs the shared reference data beside the project")]
fn pores_keep_off_the_faces_and_ears_of_real_heads() {
    for (path, group, cm) in [
        ("heads/lps_head.obj", None, 5.0),
        ("heads/sintel_bust.obj", None, 100.0),
        ("heads/makehuman_base.obj", Some("body"), 10.0),
    ] {
        let mesh = read(path, group, cm);
        let head = Head::from_mesh(mesh, None).expect("a head");
        let pores = nabiki::pores::spread(&head, &Default::default(), 2000, 1).expect("a scalp");
        for pore in pores {
            let q = (pore.position - head.ellipsoid.center) / head.ellipsoid.half_axes;
            assert!(q.length() < 1.35 && q.length() > 0.75, "{path}: {q}");
            assert!(!(q.x > 0.5 && q.y < 0.2 && q.z.abs() < 0.7), "{path}: a pore on the face, {q}");
        }
    }
}
