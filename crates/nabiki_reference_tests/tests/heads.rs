//! Real heads: the fitted ellipsoid lies on each scalp, and the distance agrees with a published grid.

use glam::{Vec2, Vec3};
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

/// How often the surface winds about `p`, from the definition: the solid angles of all triangles (Van Oosterom and
/// Strackee, 1983) in f64, with nothing joined, closed or left out.
fn winding(mesh: &Mesh, p: Vec3) -> f64 {
    let solid_angle = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|v| mesh.positions[v as usize].as_dvec3() - p.as_dvec3());
        let (la, lb, lc) = (a.length(), b.length(), c.length());
        let below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
        2.0 * a.dot(b.cross(c)).atan2(below)
    };
    mesh.triangles.iter().map(solid_angle).sum::<f64>() / (4.0 * std::f64::consts::PI)
}

fn turned(mesh: &Mesh, which: impl Fn(usize) -> bool) -> Mesh {
    let mut mesh = mesh.clone();
    for (_, triangle) in mesh.triangles.iter_mut().enumerate().filter(|(t, _)| which(*t)) {
        triangle.swap(1, 2);
    }
    mesh
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs the shared reference data beside the project")]
fn inside_is_right_however_the_triangles_of_a_head_lie() {
    // The scan has 10 edges of more than two triangles, which may part flaps of two triangles from the rest: they are
    // flat, and stay as they come.
    for (path, group, cm, in_flaps) in [
        ("heads/sintel_collider.obj", None, 100.0, 0),
        ("heads/sintel_bust.obj", None, 100.0, 0),
        ("heads/lps_head.obj", None, 5.0, 20),
        ("heads/makehuman_base.obj", Some("body"), 10.0, 0),
    ] {
        let mesh = read(path, group, cm);
        let as_it_is = Head::from_mesh(mesh.clone(), None).expect("a head");
        let Ellipsoid { center, half_axes } = as_it_is.ellipsoid;
        let places: Vec<(Vec3, f64)> = (0..400)
            .map(|i| {
                let share = [0.618_034, 0.754_878, 0.569_84].map(|g: f32| 2.8 * (i as f32 * g).fract() - 1.4);
                let p = center + half_axes * Vec3::from_array(share);
                (p, winding(&mesh, p))
            })
            // Neither at the skin, where samples are interpolated, nor in the mouth of an opening, where the number is
            // about a half and a fan decides.
            .filter(|&(p, winds)| as_it_is.distance(p).abs() > 0.3 && (winds - 0.5).abs() > 0.15)
            .collect();
        let inside = places.iter().filter(|(_, winds)| *winds > 0.5).count();
        assert!(inside > 60 && places.len() - inside > 60, "{path}: {inside} of {} places inside", places.len());
        let count = mesh.triangles.len();
        let ways: [(&str, Mesh, usize); 3] = [
            ("as it is", mesh.clone(), 0),
            ("inside out", turned(&mesh, |_| true), count),
            ("mixed", turned(&mesh, |t| t % 3 == 0), count.div_ceil(3)),
        ];
        for (way, mesh, wrong) in ways {
            let head = Head::from_mesh(mesh, None).expect("a head");
            println!("{path} {way}: {:?}", head.orientation);
            let turned = head.orientation.turned;
            assert!(turned <= wrong && turned + in_flaps >= wrong, "{path} {way}: {turned} of {wrong} turned");
            for &(p, winds) in &places {
                assert_eq!(head.contains(p), winds > 0.5, "{path} {way}: {p} winds {winds}");
            }
        }
    }
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs the shared reference data beside the project")]
fn openings_are_counted() {
    let bust = read("heads/sintel_bust.obj", None, 100.0);
    assert_eq!(Head::from_mesh(bust, None).expect("a head").orientation.open_edges, 148);
    let closed = read("heads/sintel_collider.obj", None, 100.0);
    assert_eq!(Head::from_mesh(closed, None).expect("a head").orientation.open_edges, 0);
}

/// A flat patch encloses nothing, and neither does one bent so that both its sides lie on each other.
#[test]
fn a_sheet_is_refused() {
    let at = |i: u32| Vec3::new((i % 10) as f32, (i / 10) as f32, 0.0);
    let positions = (0..100).map(at).collect();
    let cells = (0..90).filter(|i| i % 10 < 9);
    let triangles = cells.flat_map(|i| [[i, i + 1, i + 11], [i, i + 11, i + 10]]).collect();
    let flat = Mesh { positions, triangles, ..Mesh::default() };
    let mut folded = flat.clone();
    folded.positions.iter_mut().for_each(|p| p.x = (p.x - 4.5).abs());
    let ellipsoid = Ellipsoid { center: Vec3::new(4.5, 4.5, 0.0), half_axes: Vec3::splat(9.0) };
    for mesh in [flat, folded] {
        let refused = Head::from_mesh(mesh, Some(ellipsoid)).expect_err("a sheet").to_string();
        assert!(refused.starts_with("head.mesh = a sheet, 162 triangles, "), "{refused}");
    }
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs the shared reference data beside the project")]
fn roots_keep_off_the_faces_and_ears_of_real_heads() {
    for (path, group, cm) in [
        ("heads/lps_head.obj", None, 5.0),
        ("heads/sintel_bust.obj", None, 100.0),
        ("heads/makehuman_base.obj", Some("body"), 10.0),
    ] {
        let mesh = read(path, group, cm);
        let head = Head::from_mesh(mesh, None).expect("a head");
        let roots = nabiki_groom::roots::spread(&head, &Default::default(), 2000, 1).expect("a scalp");
        for root in roots {
            let q = (root.position - head.ellipsoid.center) / head.ellipsoid.half_axes;
            assert!(q.length() < 1.35 && q.length() > 0.75, "{path}: {q}");
            assert!(!(q.x > 0.5 && q.y < 0.2 && q.z.abs() < 0.7), "{path}: a root on the face, {q}");
        }
    }
}

/// The texture coordinates of the triangles of an .obj file, or of one group of it.
fn texture(path: &str, group: Option<&str>) -> Vec<[Vec2; 3]> {
    let text = std::fs::read_to_string(shared(path)).expect("readable");
    let (mut all, mut corners) = (Vec::new(), Vec::new());
    let mut wanted = group.is_none();
    for line in text.lines() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("vt") => {
                let uv: Vec<f32> = words.map(|w| w.parse().expect("a coordinate")).collect();
                all.push(Vec2::new(uv[0], uv[1]));
            }
            Some("g") => wanted = group.is_none_or(|g| words.next() == Some(g)),
            Some("f") if wanted => {
                let uv = |w: &str| all[w.split('/').nth(1).expect("an index").parse::<usize>().expect("a number") - 1];
                let face: Vec<Vec2> = words.map(uv).collect();
                corners.extend((2..face.len()).map(|i| [face[0], face[i - 1], face[i]]));
            }
            _ => {}
        }
    }
    corners
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs the shared reference data beside the project")]
fn both_sides_of_the_seams_of_real_heads_are_kept() {
    for (path, group) in [("heads/sintel_bust.obj", None), ("heads/makehuman_base.obj", Some("body"))] {
        let groups: Vec<String> = group.map(str::to_owned).into_iter().collect();
        let placement = nabiki_io::Placement::default();
        let (mesh, report) = nabiki_io::mesh::import(&shared(path), &placement, &groups).expect("a mesh");
        assert_eq!(report.dropped_triangles, 0, "{path}");
        assert_eq!(mesh.corner_uvs, Some(texture(path, group)), "{path}");
        let mut at: Vec<Vec<Vec2>> = vec![Vec::new(); mesh.positions.len()];
        for (&v, &uv) in mesh.triangles.iter().flatten().zip(mesh.corner_uvs.iter().flatten().flatten()) {
            if !at[v as usize].contains(&uv) {
                at[v as usize].push(uv);
            }
        }
        let on_seams = at.iter().filter(|uvs| uvs.len() > 1).count();
        println!("{path}: {on_seams} of {} vertices lie on seams", at.len());
        assert!(on_seams > 20, "{path}: {on_seams}");
    }
    let without = nabiki_io::mesh::read(&shared("heads/lps_head.obj"), &[]).expect("a mesh");
    assert_eq!(without.corner_uvs, None);
}
