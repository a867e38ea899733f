use nabiki::Mesh;

use super::super::directions::halves;
use super::super::skin_cells::skin_cells;
use super::super::tests::square;
use super::*;

const CELL: f32 = 0.5;

fn ball(radius: f32) -> Mesh {
    let (rings, around) = (24_u32, 48_u32);
    let at = |i: u32, j: u32| {
        radius * crate::camera::direction(j as f32 * 360.0 / around as f32, i as f32 * 180.0 / rings as f32 - 90.0)
    };
    let positions = (0..=rings).flat_map(|i| (0..around).map(move |j| at(i, j))).collect();
    let v = |i: u32, j: u32| i * around + j % around;
    let squares = (0..rings).flat_map(|i| (0..around).map(move |j| (i, j)));
    let triangles = squares
        .flat_map(|(i, j)| [[v(i, j), v(i + 1, j), v(i, j + 1)], [v(i, j + 1), v(i + 1, j), v(i + 1, j + 1)]])
        .collect();
    outward(Mesh { positions, triangles, ..Mesh::default() })
}

/// The same mesh, with its front where it faces away from the origin.
fn outward(mut mesh: Mesh) -> Mesh {
    for t in &mut mesh.triangles {
        let [a, b, c] = t.map(|v| mesh.positions[v as usize]);
        if (b - a).cross(c - a).dot(a + b + c) < 0.0 {
            t.swap(1, 2);
        }
    }
    mesh
}

fn inside_out(mut mesh: Mesh) -> Mesh {
    mesh.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    mesh
}

/// A level square of this half side at a height, that faces up or down.
fn level(half: f32, height: f32, faces: f32) -> Mesh {
    square(height * Vec3::Y, half * Vec3::Z, faces * half * Vec3::X)
}

/// The share of all that a small surface sees which a square of this half side takes, at a height over it and facing it.
fn view_factor(half: f32, height: f32) -> f32 {
    let x = half / height;
    let root = (1.0 + x * x).sqrt();
    4.0 / std::f32::consts::TAU * 2.0 * x / root * (x / root).atan()
}

fn asked_about(cells: &[SkinCell]) -> Exchange {
    let mut exchange = Exchange::default();
    exchange.lay_out(cells, CELL);
    exchange.ask(cells.par_iter().map(|skin| skin.place));
    exchange
}

/// What arrives at each skin where the light that falls onto it is given.
fn arriving(cells: &[SkinCell], lit: impl Fn(&SkinCell) -> f32) -> Vec<f32> {
    let mut exchange = asked_about(cells);
    exchange.send((0..).zip(cells.iter().map(lit)), |_, _| 1.0);
    exchange.light.into_iter().map(|(_, light)| light.glow).collect()
}

fn mean(values: impl Iterator<Item = f32>) -> f32 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), v| (sum + v, count + 1.0));
    sum / count
}

#[test]
fn a_ball_sees_nothing_of_itself() {
    let found = arriving(&skin_cells(&ball(5.0), CELL, 0), |_| 1.0);
    assert!(found.iter().all(|&light| light == 0.0));
}

/// In a hollow ball whose walls are lit evenly all light comes from walls: as much as is on them. A look may slip through between cells
/// that it grazes, where the wall counts as seen from too much aside.
#[test]
fn in_a_hollow_ball_as_much_arrives_as_is_sent() {
    let found = arriving(&skin_cells(&inside_out(ball(5.0)), CELL, 0), |_| 1.0);
    assert!(found.iter().all(|&light| light <= 1.0 + 1e-5));
    let mean = mean(found.into_iter());
    // Looks with a cosine under FACING at the wall make up FACING^2 of all.
    assert!((1.0 - mean) < 2.0 * FACING * FACING, "{mean}");
}

/// Under a large lit square a small one gets of its light what the view factor says, whether both are the head's, or one is a body's.
#[test]
fn a_square_lights_another_by_its_view_factor() {
    let (half, height) = (6.0_f32, 4.0_f32);
    // The large one is as thick as a cell, and a small one looks in some 80 directions.
    let ray = 2.0 / DIRECTIONS as f32;
    let expected = view_factor(half, height) - ray..view_factor(half, height - CELL) + ray;
    for (below, above) in [(0, 0), (0, 1), (1, 0)] {
        let mut cells = skin_cells(&level(1.5, -2.1, 1.0), CELL, below);
        cells.extend(skin_cells(&level(half, -2.1 + height, -1.0), CELL, above));
        cells.sort_by_key(|skin| skin.solid);
        let found = arriving(&cells, |skin| if skin.normal.y < 0.0 { 1.0 } else { 0.0 });
        let of_middle = cells
            .iter()
            .zip(&found)
            .filter(|(skin, _)| skin.normal.y > 0.0 && skin.place.x.abs().max(skin.place.z.abs()) < 0.75);
        let found = mean(of_middle.map(|(_, &light)| light));
        assert!(expected.contains(&found), "{found} for {expected:?}, {below} {above}");
    }
}

#[test]
fn what_arrives_does_not_depend_on_what_was_asked_before() {
    let cells = skin_cells(&inside_out(ball(3.0)), CELL, 0);
    let lit = |exchange: &mut Exchange| {
        exchange.send((0..).zip(cells.iter().map(|skin| 1.0 + skin.normal.y)), |a, b| 1.0 / (1.0 + a.distance(b)));
        exchange.open_sky(|from| halves(from.y), |place, _| 1.0 / (1.0 + place.length_squared()));
    };
    let mut whole = asked_about(&cells);
    lit(&mut whole);
    let mut later = Exchange::default();
    later.lay_out(&cells, CELL);
    for part in [&cells[..cells.len() / 3], &cells] {
        later.forget_asked();
        later.ask(part.par_iter().map(|skin| skin.place));
        lit(&mut later);
    }
    for skin in &cells {
        assert_eq!(later.at(skin.place, skin.normal), whole.at(skin.place, skin.normal));
    }
}

/// What a frame shows does not depend on where a body was in those before it, nor on whether they were drawn.
#[test]
fn what_arrives_does_not_depend_on_where_a_body_was() {
    // So large that looks go on in long steps through its middle.
    let head = skin_cells(&inside_out(ball(9.0)), CELL, 0);
    let with_body = |height: f32| {
        let mut cells = head.clone();
        cells.extend(skin_cells(&level(1.5, height, 1.0), CELL, 1));
        cells
    };
    let shown = |exchange: &mut Exchange, cells: &[SkinCell]| -> Vec<Option<Arriving>> {
        exchange.lay_out(cells, CELL);
        exchange.ask(cells.par_iter().map(|skin| skin.place));
        exchange.send((0..).zip(cells.iter().map(|skin| 1.0 + skin.normal.y)), |_, _| 1.0);
        exchange.open_sky(|from| halves(from.y), |place, _| 1.0 / (1.0 + place.length_squared()));
        cells.iter().map(|skin| exchange.at(skin.place, skin.normal)).collect()
    };
    let mut exchange = Exchange::default();
    for height in [-2.1, 1.3, 7.4, 40.0] {
        let cells = with_body(height);
        assert_eq!(shown(&mut exchange, &cells), shown(&mut Exchange::default(), &cells), "{height}");
    }
}

/// What arrives of the sky at each skin; hair leaves `through` of it.
fn under_sky(cells: &[SkinCell], zenith: Vec3, through: impl Fn(Vec3, Vec3) -> f32 + Sync) -> Vec<Arriving> {
    let mut exchange = asked_about(cells);
    exchange.send((0..).zip(cells.iter().map(|_| 0.0)), |_, _| 1.0);
    exchange.open_sky(|from| halves(from.dot(zenith)), through);
    exchange.light.into_iter().map(|(_, light)| light).collect()
}

/// The share of the whole sky that arrives on a surface of whose sky a part is `above`.
fn whole(arriving: &Arriving, above: f32) -> f32 {
    above * arriving.open[0] * arriving.through[0] + (1.0 - above) * arriving.open[1] * arriving.through[1]
}

#[test]
fn skin_that_nothing_hides_has_the_whole_sky() {
    for arriving in under_sky(&skin_cells(&ball(5.0), CELL, 0), Vec3::Y, |_, _| 1.0) {
        assert_eq!((arriving.open, arriving.through), ([1.0; 2], [1.0; 2]));
    }
}

/// What a square sees of another is what it does not see of the sky: of both halves together, by how much of each it faces.
#[test]
fn a_square_hides_the_sky_by_its_view_factor() {
    let (half, height) = (6.0_f32, 4.0_f32);
    let ray = 2.0 / DIRECTIONS as f32;
    let expected = 1.0 - view_factor(half, height - CELL) - ray..1.0 - view_factor(half, height) + ray;
    for (below, above) in [(0, 0), (0, 1), (1, 0)] {
        let mut cells = skin_cells(&level(1.5, -2.1, 1.0), CELL, below);
        cells.extend(skin_cells(&level(half, -2.1 + height, -1.0), CELL, above));
        cells.sort_by_key(|skin| skin.solid);
        let found = under_sky(&cells, Vec3::Y, |_, _| 1.0);
        // Integrals of h (1/2 + 3/4 h - 1/4 h^3) over heights h of 0 to 1, twice.
        let above = 2.0 * (0.25 + 0.25 - 0.05);
        let of_middle = cells
            .iter()
            .zip(&found)
            .filter(|(skin, _)| skin.normal.y > 0.0 && skin.place.x.abs().max(skin.place.z.abs()) < 0.75);
        let found = mean(of_middle.map(|(_, arriving)| whole(arriving, above)));
        assert!(expected.contains(&found), "{found} for {expected:?}, {below} {above}");
    }
}

/// Under a layer of hair that light crosses n / cos times, what is left of it is 2 E_3(n) (the exponential integral). Hair that lies within
/// [`ABOVE`] of the skin does not count.
#[test]
fn a_layer_of_hair_leaves_what_its_depth_says() {
    let floor = 0.1;
    let cells = skin_cells(&level(1.5, floor, 1.0), CELL, 0);
    let (per_cm, top) = (0.5, 2.0);
    let found = under_sky(&cells, Vec3::Y, |from, d| (-per_cm * (floor + top - from.y) / d.y).exp());
    let depth: f32 = per_cm * (top - ABOVE);
    let steps = 10_000;
    let expected: f32 = (0..steps)
        .map(|i| (i as f32 + 0.5) / steps as f32)
        .map(|cos| 2.0 * cos * (-depth / cos).exp() / steps as f32)
        .sum();
    for arriving in found {
        // Heights of the 80 directions are the middles of as many bands: the midpoint rule, of second order in 1/80.
        assert!((whole(&arriving, 0.9) - expected).abs() < 1e-3, "{arriving:?} for {expected}");
        assert_eq!(arriving.open, [1.0; 2]);
    }
}

/// Turned with its sky, skin has the same light of it, up to a few of its 80 directions.
#[test]
fn the_sky_turns_with_its_zenith() {
    let mut cells = skin_cells(&level(1.5, -2.1, 1.0), CELL, 0);
    cells.extend(skin_cells(&level(6.0, 1.9, -1.0), CELL, 0));
    let upright = under_sky(&cells, Vec3::Y, |_, _| 1.0);
    let turned: Vec<SkinCell> = cells
        .iter()
        .map(|skin| {
            let turn = |v: Vec3| Vec3::new(-v.y, v.x, v.z);
            let place = turn(skin.place);
            SkinCell { cell: (place / CELL).floor().as_ivec3(), place, normal: turn(skin.normal), ..*skin }
        })
        .collect();
    let turned = under_sky(&turned, Vec3::NEG_X, |_, _| 1.0);
    for ((a, b), _) in upright.iter().zip(&turned).zip(&cells).filter(|(_, skin)| skin.normal.y > 0.0) {
        assert!(whole(a, 0.9) < 0.9);
        assert!((whole(a, 0.9) - whole(b, 0.9)).abs() < 6.0 / DIRECTIONS as f32, "{a:?} {b:?}");
    }
}
