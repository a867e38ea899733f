use super::*;
use crate::settings::Camera;

/// A square about a middle, with sides along two vectors; it faces along their cross product.
pub(super) fn square(middle: Vec3, along: Vec3, across: Vec3) -> Mesh {
    let positions =
        [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[u, v]| middle + u * along + v * across).to_vec();
    Mesh { positions, triangles: vec![[0, 1, 2], [0, 2, 3]], ..Mesh::default() }
}

/// Hairs that stand out from a ball of 1 cm, to 5.5 cm from its middle.
fn ball() -> Vec<CurveNode> {
    let mut nodes = vec![];
    for s in 0..4000_u32 {
        let direction =
            crate::camera::direction(s as f32 * 137.508, (1.0 - 2.0 * (s as f32 + 0.5) / 4000.0).asin().to_degrees());
        for k in 0..10 {
            nodes.push(CurveNode { position: direction * (1.0 + 0.5 * k as f32), strand: s, ..CurveNode::default() });
        }
    }
    nodes
}

#[test]
fn hair_is_read_at_its_surface() {
    let nodes = ball();
    let mut sky = SkyMap::default();
    sky.lay_out(crate::curve::bounds(&nodes), 0.0, (&Mesh::default(), &[]), Vec3::Y, rayon::iter::empty());
    sky.fill(&nodes, &vec![0.05; nodes.len()]);
    sky.gather((&nodes, &vec![true; nodes.len()]), &view_from(0.0), &[], |_, _, _| 0.0);
    let open = |places: &arriving::Places<1>| sky.at(places, 0)[..FRONT_GLOW].iter().map(|of| of[0]).sum::<f32>();
    let one = |p: Vec3| p.to_array().map(|c| [c]);
    for (azimuth, elevation) in [(20.0, 10.0), (100.0, 50.0), (200.0, -30.0), (300.0, 80.0)] {
        let outward = crate::camera::direction(azimuth, elevation);
        let from = 5.0 * outward;
        let here = open(&sky.places(&one(from)));
        let farther = open(&sky.places(&one(from + 0.1 * outward)));
        let seen = open(&sky.places_seen(&one(from), &one(Vec3::ZERO)));
        // The cells' lattice bends what is outward by some degrees.
        let part = (seen - here) / (farther - here);
        assert!(farther > here && (0.9..1.2).contains(&part), "{azimuth}, {elevation}: {here} {farther} {seen}");
    }
}

#[test]
fn the_sky_reaches_the_outside_of_a_ball_of_hair_and_not_its_middle() {
    let nodes = ball();
    let radius = vec![0.05; nodes.len()];
    let bounds = crate::curve::bounds(&nodes);
    let filled = |azimuth: f32| {
        let mut sky = SkyMap::default();
        sky.lay_out(bounds, 0.0, (&Mesh::default(), &[]), Vec3::Y, rayon::iter::empty());
        sky.fill(&nodes, &radius);
        let asked = [Vec3::ZERO, Vec3::new(0.0, 5.4, 0.0), Vec3::splat(100.0), Vec3::X * 5.4, Vec3::X * -5.4];
        sky.gather((&asked.map(at), &[true; 5]), &view_from(azimuth), &[lamp(Vec3::X)], |_, _, _| 0.0);
        sky
    };
    let sky = filled(0.0);
    let at = sky.at(&sky.places(&[[0.0, 0.0, 100.0], [0.0, 5.4, 100.0], [0.0, 0.0, 100.0]]), 0);
    let [middle, top, outside]: [[f32; TOWARD_LAMPS]; 3] =
        [0, 1, 2].map(|n| std::array::from_fn(|number| at[number][n]));
    let arrives = |at: [f32; TOWARD_LAMPS]| at[..FRONT_GLOW].iter().sum::<f32>();
    assert!(arrives(middle) < 0.05 && middle[FRONT_BARE] == 1.0 && middle[BEHIND_BARE] == 1.0, "{middle:?}");
    assert!(top[FRONT_ABOVE] > 0.35 && top[FRONT_ABOVE] > 2.0 * top[FRONT_BELOW], "{top:?}");
    assert!(arrives(outside) > 1.3, "{outside:?}");
    // Before the ball it is open toward the eye and closed behind; on its far side the other way round.
    let rims = [[5.4, -5.4], [0.0; 2], [0.0; 2]];
    let numbers = |sky: &SkyMap| -> [[f32; 2]; TOWARD_LAMPS + 1] {
        let places = sky.places(&rims);
        let at = [0, 1].map(|k| sky.at(&places, k)).concat();
        std::array::from_fn(|number| at[number])
    };
    let [near, far] = [0, 1].map(|n| numbers(&sky).map(|number| number[n]));
    let open = |at: [f32; TOWARD_LAMPS + 1]| (at[FRONT_ABOVE] + at[FRONT_BELOW], at[BEHIND_ABOVE] + at[BEHIND_BELOW]);
    assert!(open(near).0 > 0.6 && open(near).1 < 0.1, "{near:?}");
    assert!(open(far).0 < open(near).0 - 0.2 && open(far).1 > open(near).1 + 0.2, "{far:?}");
    // Toward a lamp at one side it is open there, and closed at the other.
    let (lit, shaded) = (near[TOWARD_LAMPS], far[TOWARD_LAMPS]);
    assert!(lit > 0.7 && shaded < 0.05, "{lit} {shaded}");
    // The other eye sees the same of the other side: the ball is the same to some hairs' places.
    let opposite = filled(180.0);
    let opposite = numbers(&opposite);
    for (number, (near, far)) in near.into_iter().zip(far).enumerate().take(TOWARD_LAMPS) {
        assert!((opposite[number][1] - near).abs() < 0.03 && (opposite[number][0] - far).abs() < 0.03);
    }
}

fn at(position: Vec3) -> CurveNode {
    CurveNode { position, ..CurveNode::default() }
}

fn lamp(toward: Vec3) -> Lamp {
    Lamp { toward, strength: [1.0; 3], spread: 0.0 }
}

fn view_from(azimuth: f32) -> View {
    let camera = Camera { azimuth, elevation: 0.0, ..Camera::default() };
    View::new(&camera, [64, 64], &crate::camera::Bounds::default())
}

#[test]
fn what_reaches_a_surface_does_not_depend_on_what_was_asked_before() {
    let nodes: Vec<CurveNode> = (0..300_u32)
        .map(|i| {
            let (strand, k) = (i / 3, (i % 3) as f32);
            let position = crate::camera::direction(strand as f32 * 137.508, strand as f32 - 50.0) * (3.0 + k);
            CurveNode { position, strand, ..CurveNode::default() }
        })
        .collect();
    let mut sky = SkyMap::default();
    sky.lay_out(crate::curve::bounds(&nodes), 0.0, (&Mesh::default(), &[]), Vec3::Y, rayon::iter::empty());
    sky.fill(&nodes, &vec![0.1; nodes.len()]);
    sky.gather((&[], &[]), &view_from(0.0), &[], |_, _, _| 0.0);
    let mut one = OnSkin::new(&sky);
    for node in &nodes {
        let normal = node.position.normalize();
        assert_eq!(one.at(node.position, normal), OnSkin::new(&sky).at(node.position, normal));
    }
}

/// Skin far from the hair has the shade of the hair that is between it and the sky, and no more.
#[test]
fn what_reaches_a_surface_beyond_the_box_is_what_a_larger_box_would_bring_there() {
    let nodes = ball();
    let about_hair = crate::curve::bounds(&nodes);
    let filled = |bounds: [Vec3; 2]| {
        let mut sky = SkyMap::default();
        sky.lay_out(bounds, 0.0, (&Mesh::default(), &[]), Vec3::Y, rayon::iter::empty());
        sky.fill(&nodes, &vec![0.05; nodes.len()]);
        sky
    };
    let (small, large) = (filled(about_hair), filled([Vec3::splat(-22.0), Vec3::splat(22.0)]));
    let (mut small, mut large) = (OnSkin::new(&small), OnSkin::new(&large));
    let (mut shaded, mut off) = (0, 0.0_f32);
    for i in 0..2000 {
        let outward = crate::camera::direction(i as f32 * 137.508, 0.09 * i as f32 - 90.0);
        let place = (8.0 + 0.006 * i as f32) * outward;
        for normal in [-outward, Vec3::Y, Vec3::new(0.6, 0.0, -0.8)] {
            let [near, far] = [&mut small, &mut large].map(|sky| sky.at(place, normal));
            shaded += u32::from(far.iter().any(|open| *open < 0.8));
            off = (0..2).map(|half| (near[half] - far[half]).abs()).fold(off, f32::max);
        }
    }
    // Between the same cells, seen along the way and not about the place: of a ball's edge, four cells wide, up to half a cell.
    assert!(shaded > 200 && off < 0.125, "{off}, {shaded} shaded");
}

#[test]
fn an_open_sky_arrives_whole_wherever_the_eye_is() {
    for zenith in [Vec3::Y, Vec3::new(0.36, -0.48, 0.8)] {
        let mut sky = SkyMap::default();
        let bounds = [Vec3::splat(-3.0), Vec3::splat(3.0)];
        sky.lay_out(bounds, 0.0, (&Mesh::default(), &[]), zenith, rayon::iter::empty());
        sky.fill(&[], &[]);
        // More lamps than have room beside the rest.
        let asked = [at(Vec3::new(0.3, -0.7, 1.1))];
        sky.gather((&asked, &[true]), &view_from(47.0), &[lamp(zenith); 4], |_, _, _| 0.0);
        let place = sky.places(&[[0.3], [-0.7], [1.1]]);
        let at = sky.at(&place, 0).map(|number| number[0]);
        // A dozen roundings of sums of 14 numbers.
        assert!((at[FRONT_ABOVE] + at[FRONT_BELOW] - 1.0).abs() < 1e-5, "{at:?}");
        assert!((at[BEHIND_ABOVE] + at[BEHIND_BELOW] - 1.0).abs() < 1e-5, "{at:?}");
        for number in TOWARD_LAMPS..TOWARD_LAMPS + 4 {
            let open = sky.at(&place, number / AT_ONCE)[number % AT_ONCE][0];
            assert!((open - 1.0).abs() < 1e-5, "{open}");
        }
        let above = OnSkin::new(&sky).at(Vec3::ZERO, Vec3::new(0.6, 0.0, 0.8));
        assert!(above.iter().all(|open| (open - 1.0).abs() < 1e-5), "{above:?}");
    }
}

/// In hair that is the same everywhere, light loses by the length of its way through the cells, wherever it comes from and goes to.
#[test]
fn hair_takes_of_the_sky_by_the_way_through_it() {
    let mut sky = SkyMap::default();
    let bounds = [Vec3::new(-3.0, -1.0, -2.0), Vec3::new(3.0, 4.0, 1.0)];
    sky.lay_out(bounds, 0.0, (&Mesh::default(), &[]), Vec3::Y, rayon::iter::empty());
    sky.fill(&[], &[]);
    let depth = 0.1;
    sky.hair.fill(depth);
    let (step, mut crossed) = (0.002, 0);
    for i in 0..200 {
        let direction = crate::camera::direction(i as f32 * 137.508, 0.9 * i as f32 - 89.0);
        let place = crate::camera::direction(i as f32 * 61.7, 80.0 - 0.8 * i as f32) * (0.05 * i as f32);
        let within = (0..20_000).filter(|k| sky.holds(place + direction * (step * (*k as f32 + 0.5)))).count();
        let expected = (-depth * step * within as f32 / sky.cell).exp();
        // Half a step at either end.
        assert!((sky.through_hair_along(place, direction) - expected).abs() < depth * step / sky.cell + 1e-5, "{i}");
        crossed += usize::from(place.length() > 5.0 && within > 0);
    }
    assert!(crossed > 10, "ways from beyond the box through it: {crossed}");
}

/// The shade that a ball of hair throws on the floor below it has no edge: neither where the cells about the hair end, nor along directions.
#[test]
fn under_an_even_sky_no_line_is_drawn_on_skin() {
    let nodes: Vec<CurveNode> =
        ball().into_iter().map(|node| CurveNode { position: node.position + 7.0 * Vec3::Y, ..node }).collect();
    let floor = square(Vec3::ZERO, 14.0 * Vec3::Z, 14.0 * Vec3::X);
    let places: Vec<Vec3> = (0..240).map(|i| Vec3::new(0.05 * i as f32, 0.0, 0.03 * i as f32)).collect();
    let mut sky = SkyMap::default();
    let seen = places.par_iter().copied();
    sky.lay_out(crate::curve::bounds(&nodes), 0.0, (&floor, &[]), Vec3::Y, seen);
    sky.fill(&nodes, &vec![0.05; nodes.len()]);
    sky.gather((&[], &[]), &view_from(0.0), &[], |_, _, _| 0.0);
    let mut on_skin = OnSkin::new(&sky);
    let shades: Vec<f32> = places.iter().map(|&p| on_skin.seen(p, Vec3::Y).through[0]).collect();
    assert!(shades[0] < 0.6 && shades[239] > 0.8, "{} {}", shades[0], shades[239]);
    // From end to end as much more arrives as if it grew evenly over 12 cm. The edge of one of some 80 directions is a hundredth, over a cell of
    // 0.55 cm; a line is as much from place to place.
    let steepest = shades.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f32::max);
    assert!(steepest < 0.01, "{steepest}");
}

#[test]
fn hair_that_spreads_a_little_more_keeps_its_cells() {
    let cell_of = |spread: f32| {
        let mut sky = SkyMap::default();
        let bounds = [Vec3::ZERO, Vec3::new(120.0, 100.0, 100.0 + spread)];
        sky.lay_out(bounds, 0.0, (&Mesh::default(), &[]), Vec3::Y, rayon::iter::empty());
        assert!(sky.size.as_vec3().element_product() < 1.2 * MOST_CELLS, "{}", sky.size);
        sky.cell
    };
    // As far as a mane swings: what is worked out once for each size of cell would be worked out in each frame.
    let mut swung: Vec<f32> = (0..40).map(|spread| cell_of(spread as f32)).collect();
    swung.dedup();
    assert!(swung.len() <= 2, "{swung:?}");
    assert!(cell_of(500.0) > swung[0]);
}
