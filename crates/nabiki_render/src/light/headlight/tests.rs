use super::*;

#[test]
fn a_plate_hides_the_lamp_from_what_lies_behind_it_only() {
    let corners = [[-6.0, -6.0], [6.0, -6.0], [6.0, 6.0], [-6.0, 6.0]];
    let plate = Mesh {
        positions: corners.map(|[x, z]| Vec3::new(x, 0.0, z)).to_vec(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Mesh::default()
    };
    let lamp = Lamp { toward: Vec3::Y, strength: [1.0; 3], spread: 0.03 };
    let shadow = SolidShadow::new(&lamp, &plate);
    let visible = |x: f32, y: f32| shadow.visible(&[[x], [y], [0.3]])[0];
    assert_eq!(visible(0.0, 2.0), 1.0);
    assert!(visible(0.0, -2.0) < 1e-5);
    assert_eq!(visible(20.0, -2.0), 1.0);
    // At the edge, half of the blurred plate: within a cell of 1/3 of the blur's slope.
    assert!((visible(6.0, -2.0) - 0.5).abs() < 0.25);
    assert_eq!(SolidShadow::new(&lamp, &Mesh::default()).visible(&[[0.0]; 3]), [1.0]);
    // What counts as dark is.
    let places = (0..40 * 40).map(|i| Vec3::new(0.4 * (i % 40) as f32 - 8.0, 1.0 - 0.1 * (i / 40) as f32, 0.3));
    let dark: Vec<Vec3> = places.filter(|&p| shadow.is_dark(p)).collect();
    assert!(dark.len() > 500 && !shadow.is_dark(Vec3::new(0.0, 2.0, 0.3)));
    assert!(dark.iter().all(|p| visible(p.x, p.y) <= LEFT_IN_THE_DARK));
}

/// A ball in facets of about a sixteenth of its radius.
fn ball(radius: f32) -> Mesh {
    let (rows, columns) = (48_u32, 96_u32);
    let at = |row: u32, column: u32| {
        let up = 180.0 * row as f32 / rows as f32 - 90.0;
        crate::camera::direction(360.0 * column as f32 / columns as f32, up)
    };
    let mut ball = Mesh::default();
    for row in 0..=rows {
        ball.positions.extend((0..columns).map(|column| radius * at(row, column)));
    }
    for row in 0..rows {
        for c in 0..columns {
            let (a, b) = (row * columns + c, row * columns + (c + 1) % columns);
            ball.triangles.extend([[a, b, a + columns], [b, b + columns, a + columns]]);
        }
    }
    ball
}

#[test]
fn skin_that_faces_the_lamp_is_not_in_its_own_shadow() {
    let ball = ball(8.0);
    for toward in [Vec3::Y, Vec3::new(0.6, 0.0, 0.8), Vec3::new(-0.48, 0.64, 0.6)] {
        for spread in [0.0, 0.17] {
            let shadow = SolidShadow::new(&Lamp { toward, strength: [1.0; 3], spread }, &ball);
            for p in &ball.positions {
                let normal = *p / 8.0;
                let visible = shadow.visible_from_skin(*p, normal);
                if normal.dot(toward) > 0.2 {
                    assert!(visible.iter().all(|v| *v > 0.97), "{p} {visible:?}");
                }
                // 8 (1 - sqrt(1 - 0.5^2)) = 1.07 cm within the outline: farther than red light spreads here, 0.73 cm.
                if normal.dot(toward) < -0.5 {
                    assert!(visible.iter().all(|v| *v < 0.03), "{p} {visible:?}");
                }
            }
        }
    }
}

/// A square 12 cm wide that a lamp straight above sees.
fn under_a_plate(spread: f32) -> SolidShadow {
    let positions = [[-6.0, -6.0], [6.0, -6.0], [6.0, 6.0], [-6.0, 6.0]].map(|[x, z]| Vec3::new(x, 0.0, z)).to_vec();
    let plate = Mesh { positions, triangles: vec![[0, 1, 2], [0, 2, 3]], ..Mesh::default() };
    SolidShadow::new(&Lamp { toward: Vec3::Y, strength: [1.0; 3], spread }, &plate)
}

/// The integral of a share and what is left of it across the plate's edge, 2 cm below: in proportion to the width of the edge.
fn width_of_edge(share: impl Fn(Vec3) -> f32) -> f32 {
    let of = |i: i32| share(Vec3::new(6.0 + 0.02 * i as f32, -2.0, 0.3));
    (-250..=250).map(|i| 0.02 * of(i) * (1.0 - of(i))).sum()
}

#[test]
fn the_edge_of_a_shadow_is_as_wide_as_its_lamp() {
    let on_hair = |spread: f32| {
        let shadow = under_a_plate(spread);
        width_of_edge(|p| shadow.visible(&p.to_array().map(|c| [c]))[0])
    };
    let on_skin = |spread: f32| {
        let shadow = under_a_plate(spread);
        [0, 1, 2].map(|c| width_of_edge(|p| shadow.visible_from_skin(p, Vec3::Y)[c]))
    };
    // Twice as wide in the plane at a distance; the map is known to a part of the blur.
    let (wide, wider) = (0.3_f32, (2.0 * 0.3_f32.tan()).atan());
    assert!((on_hair(wider) / on_hair(wide) - 2.0).abs() < 0.2, "{} {}", on_hair(wide), on_hair(wider));
    // On skin with what spreads under it, which is widest in red.
    let ([red, green, blue], wide_on_skin, wider_on_skin) = (on_skin(0.0), on_skin(wide), on_skin(wider));
    assert!(red > 1.1 * green && green > 1.1 * blue, "{red} {green} {blue}");
    for c in 0..3 {
        let [a, b] = [wide, wider].map(|spread| UNDER_SKIN[c].hypot(2.5 * spread.tan()));
        let ratio = wider_on_skin[c] / wide_on_skin[c];
        // As many places are a tenth of the disc apart.
        assert!((ratio / (b / a) - 1.0).abs() < 0.1, "{c}: {ratio} for {}", b / a);
    }
}

#[test]
fn the_edge_of_a_shadow_is_as_straight_as_what_throws_it() {
    // Edges of all slopes across the map's cells, and a place that goes along one, 2 cm below, in and beside the middle of it.
    for turned in [0.1_f32, 0.35, 0.6, 0.785] {
        let turn =
            |[x, z]: [f32; 2]| Vec3::new(x * turned.cos() - z * turned.sin(), 0.0, x * turned.sin() + z * turned.cos());
        let positions = [[-6.0, -6.0], [6.0, -6.0], [6.0, 6.0], [-6.0, 6.0]].map(turn).to_vec();
        let plate = Mesh { positions, triangles: vec![[0, 1, 2], [0, 2, 3]], ..Mesh::default() };
        let shadow = SolidShadow::new(&Lamp { toward: Vec3::Y, strength: [1.0; 3], spread: 0.1 }, &plate);
        // The least and the most that is left along lines so far beside the edge (cm).
        let [within, middle, beyond] = [-0.2_f32, 0.0, 0.2].map(|beside| {
            let along = (0..200).map(|i| {
                let p = turn([6.0 + beside, 0.02 * i as f32 - 2.0]) + 2.0 * Vec3::NEG_Y;
                shadow.visible_from_skin(p, Vec3::Y)
            });
            along.fold([[1.0_f32; 3], [0.0; 3]], |[low, high], v| {
                [[0, 1, 2].map(|c| low[c].min(v[c])), [0, 1, 2].map(|c| high[c].max(v[c]))]
            })
        });
        for c in 0..3 {
            let slope = (beyond[0][c] - within[0][c]) / 0.4;
            for [low, high] in [within, middle, beyond] {
                // A cell is the plate's or not, as its middle is: the edge stands up to half of one aside.
                assert!(high[c] - low[c] < 0.5 * CELL * slope, "{turned}, {c}: {} to {}", low[c], high[c]);
            }
        }
    }
}

#[test]
fn what_lies_in_a_shadow_is_dark_to_its_terminator_and_beyond() {
    // A ball under a plate, and the same ball by itself, all round the terminator.
    let ball = ball(3.0);
    let below = |mut mesh: Mesh| {
        mesh.positions.iter_mut().for_each(|p| p.y -= 8.0);
        mesh
    };
    let mut under = below(ball.clone());
    let first = under.positions.len() as u32;
    under.positions.extend([[-9.0, -9.0], [9.0, -9.0], [9.0, 9.0], [-9.0, 9.0]].map(|[x, z]| Vec3::new(x, 0.0, z)));
    under.triangles.extend([[0, 1, 2], [0, 2, 3]].map(|t: [u32; 3]| t.map(|v| v + first)));
    let lamp = Lamp { toward: Vec3::Y, strength: [1.0; 3], spread: 0.1 };
    let [shaded, alone] = [under, below(ball)].map(|mesh| SolidShadows::new(&lamp, &mesh, &[]));
    for i in 0..400 {
        let up = (-22.0 + 0.11 * i as f32).to_radians();
        let normal = crate::camera::direction(40.0 + 77.0 * i as f32, up.to_degrees());
        let p = 3.0 * normal - 8.0 * Vec3::Y;
        let [dark, lit] = [&shaded, &alone].map(|shadows| shadows.visible_from_skin(0, p, normal));
        assert!(dark.iter().all(|left| *left < 1e-5), "{} degrees: {dark:?}", up.to_degrees());
        // Light creeps past the terminator to a cosine of -0.25 at the most: on a ball that is 0.8 cm clear above the skin.
        assert!(lit[2] > 0.5, "{} degrees: {lit:?}", up.to_degrees());
    }
}

#[test]
fn a_shadow_begins_close_behind_what_throws_it_and_not_on_its_own_skin() {
    let shadow = under_a_plate(0.0);
    // Hair lies on a head; a finger's thickness behind its surface it is in its shadow.
    let on_hair = |depth: f32| shadow.visible(&[[0.5], [-depth], [0.3]])[0];
    assert_eq!((on_hair(0.0), on_hair(0.4)), (1.0, 1.0));
    assert!((0.5..0.9).contains(&on_hair(0.6)) && on_hair(1.0) < 1e-3, "{} {}", on_hair(0.6), on_hair(1.0));
    // Skin that is its own plane is not hidden, and skin under a lid, a nose or an ear is.
    let on_skin = |depth: f32| shadow.visible_from_skin(Vec3::new(0.5, -depth, 0.3), Vec3::Y)[0];
    assert!(on_skin(0.0) > 1.0 - 1e-6 && on_skin(0.5) < 1e-6, "{} {}", on_skin(0.0), on_skin(0.5));
}
