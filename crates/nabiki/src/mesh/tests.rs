use super::*;

/// A sphere about `centre` whose rings and meridians lie at any distances from each other.
fn uneven_sphere(centre: Vec3, radius: f32) -> Mesh {
    let rings: Vec<f32> = vec![0.1, 0.13, 0.4, 0.45, 0.9, 1.6, 1.65, 1.7, 2.3, 2.9, 3.05];
    let turns: Vec<f32> = vec![0.0, 0.05, 0.4, 1.1, 1.15, 1.9, 2.8, 3.0, 3.9, 4.6, 4.65, 5.5, 6.1];
    let mut positions = Vec::new();
    for &ring in &rings {
        for &turn in &turns {
            let way = Vec3::new(ring.sin() * turn.cos(), ring.cos(), ring.sin() * turn.sin());
            positions.push(centre + radius * way);
        }
    }
    let n = turns.len();
    let at = |ring: usize, turn: usize| (ring * n + turn % n) as u32;
    let mut triangles = Vec::new();
    for ring in 0..rings.len() - 1 {
        for turn in 0..n {
            let [a, b, c, d] = [at(ring, turn), at(ring, turn + 1), at(ring + 1, turn + 1), at(ring + 1, turn)];
            triangles.extend(if (ring + turn) % 3 == 0 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] });
        }
    }
    Mesh { positions, triangles, ..Mesh::default() }
}

// Max (1999): where all neighbours of a vertex lie on a sphere with it, the weighted sum points along the radius,
// whatever the triangles. It holds for whole fans: the vertices of the first and the last ring have half of one.
#[test]
fn normals_are_those_of_a_sphere_however_uneven_its_mesh() {
    let centre = Vec3::new(0.5, -1.0, 0.25);
    for radius in [1.0e-3, 1.0, 9.0] {
        let mesh = uneven_sphere(radius * centre, radius);
        let normals = mesh.vertex_normals();
        let n = 13;
        for (&place, &normal) in mesh.positions.iter().zip(&normals).skip(n).take(normals.len() - 2 * n) {
            let outward = (place - radius * centre) / radius;
            // The shortest edge is sin(0.1) 0.05 of the radius; a place is rounded to 1.2e-7 of about 2 radii, and a
            // normal turns by as much as a triangle's corner does against its edge.
            assert!(normal.distance(outward) < 2.0 * 2.4e-7 / 0.005, "{normal} for {outward}");
        }
    }
}

#[test]
fn the_corner_of_a_cube_looks_along_its_diagonal_however_its_sides_are_cut() {
    let positions = (0..8).map(|c| Vec3::new((c & 1) as f32, (c >> 1 & 1) as f32, (c >> 2) as f32)).collect();
    let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = sides
        .iter()
        .enumerate()
        .flat_map(|(i, &[a, b, c, d])| if i % 2 == 0 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] })
        .collect();
    let mesh = Mesh { positions, triangles, ..Mesh::default() };
    for (place, normal) in mesh.positions.iter().zip(mesh.vertex_normals()) {
        assert!(normal.distance((*place - 0.5).normalize()) < 1e-6, "{place}: {normal}");
    }
}

#[test]
fn triangles_without_an_area_have_no_say() {
    let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::ZERO, 2.0 * Vec3::X, Vec3::splat(1.0e30)];
    let triangles = vec![[0, 1, 2], [0, 3, 2], [0, 1, 4]];
    let normals = Mesh { positions, triangles, ..Mesh::default() }.vertex_normals();
    assert_eq!(normals, [Vec3::Z, Vec3::Z, Vec3::Z, Vec3::Y, Vec3::Y, Vec3::Y]);
}
