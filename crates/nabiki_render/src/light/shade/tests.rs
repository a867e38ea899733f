use glam::{Vec3, vec3};
use nabiki::Mesh;

use super::*;
use crate::camera::Bounds;
use crate::settings::{Camera, HairColour, HairLook};

fn hair(eumelanin: f32) -> Model {
    let colour = HairColour::Melanin { eumelanin, pheomelanin: 0.0 };
    Model::Fibre(Box::new(Fibre::new(&HairLook { colour, variation: 0.0, ..HairLook::default() })))
}

/// Seen from +x.
fn view() -> View {
    View::new(&Camera { azimuth: 0.0, elevation: 0.0, ..Camera::default() }, [64; 2], &Bounds::default())
}

/// What the eye sees of hair at the origin that leans so far from across (rad), in green.
fn seen(light: &HairLight, inclination: f32) -> f32 {
    let tangent = vec3(inclination.sin(), 0.0, inclination.cos());
    let mut nodes = [Node::default()];
    light.shade(&[CurveNode { tangent, ..CurveNode::default() }], &[true], &mut nodes);
    nodes[0].light[1]
}

fn under_nothing<'a>(model: &'a Model, sky: &'a Sky, view: &'a View) -> HairLight<'a> {
    HairLight {
        model,
        variation: 0.0,
        lamps: &[],
        crossings: &[],
        solid_shadows: &[],
        sky,
        sky_map: None,
        skin: [0.0; 3],
        view,
    }
}

#[test]
fn hair_seen_from_its_end_shows_the_light_from_behind_it() {
    // Black hair, which lets nothing through, before a wall that the eye looks at; and the same without the wall.
    let corners = [(-6.0, -6.0), (6.0, -6.0), (6.0, 6.0), (-6.0, 6.0)].map(|(y, z)| vec3(-1.0, y, z));
    let wall = Mesh { positions: corners.to_vec(), triangles: vec![[0, 1, 2], [0, 2, 3]], ..Mesh::default() };
    let (model, sky, view) = (hair(40.0), Sky::default(), view());
    let before = |behind: &Mesh, inclination: f32| {
        let mut sky_map = SkyMap::default();
        sky_map.lay_out([Vec3::splat(-6.0), Vec3::splat(6.0)], 0.0, (behind, &[]), Vec3::Y, rayon::iter::empty());
        sky_map.fill(&[], &[]);
        sky_map.gather((&[CurveNode::default()], &[true]), &view, &[], |_, _, _| 0.0);
        seen(&HairLight { sky_map: Some(&sky_map), ..under_nothing(&model, &sky, &view) }, inclination)
    };
    let [across, aslant, on_end] = [0.0, 0.8, 1.5].map(|lean| before(&wall, lean) / before(&Mesh::default(), lean));
    // Of the fourteen directions the wall closes the one away from the eye and four aslant, which have 3/40 each: they count by 1 + cos
    // in front. Behind, by (1 - cos)^4, a twelfth is left, from the sides, and e^-4, which a wall of one cell lets through. A part
    // of the light goes back, mirrored, and the rest forward, so:
    let (front, behind) = (1.0 - 4.0 * 3.0 / 40.0 * (1.0 - 1.0 / 3.0_f32.sqrt()), 1.0 / 12.0 + 0.02);
    let Model::Fibre(fibre) = &model else { unreachable!() };
    let left = |lean: f32| {
        let row = fibre.grades[0].row(lean.sin() * (ROWS - 1) as f32);
        let back = row.back[1] / (row.back[1] + row.forward[1]);
        let mirrored = front + lean.sin().powi(2) * (behind - front);
        back * mirrored + (1.0 - back) * behind
    };
    for (seen, lean) in [(across, 0.0), (aslant, 0.8), (on_end, 1.5)] {
        assert!((seen - left(lean)).abs() < 0.01, "{lean}: {seen} for {}", left(lean));
    }
}

#[test]
fn hair_before_a_place_takes_its_light_however_the_place_is_seen() {
    // From its end hair is a mirror, and hair in the lamp's way is not. In deep blond hair light goes to all inclinations, and ten
    // hairs more take of it what ten take of scattered light.
    let (model, sky, view) = (hair(0.1), Sky { strength: 0.0, ..Sky::default() }, view());
    let lamps = [Lamp { toward: vec3(-0.6, 0.8, 0.0), strength: [1.0; 3], spread: 0.0 }];
    let behind = |count: f32, inclination: f32| {
        let crossings = Crossings::of(&[count]);
        let light = HairLight { lamps: &lamps, crossings: &[&crossings], ..under_nothing(&model, &sky, &view) };
        seen(&light, inclination)
    };
    let through_ten = (-10.0 * model.decay()[1]).exp();
    for inclination in [0.0, 0.3, 0.6, 0.9, 1.2, 1.5] {
        let left = behind(90.0, inclination) / behind(80.0, inclination);
        // Of exponents up to 90 some roundings.
        assert!((left / through_ten - 1.0).abs() < 1e-3, "{inclination}: {left} for {through_ten}");
    }
}

/// A square across an axis, 12 cm wide.
fn wall(middle: Vec3, across: Vec3) -> Mesh {
    let along = across.any_orthonormal_vector();
    let (u, v) = (6.0 * along, 6.0 * along.cross(across));
    let positions = vec![middle - u - v, middle + u - v, middle + u + v, middle - u + v];
    Mesh { positions, triangles: vec![[0, 1, 2], [0, 2, 3]], ..Mesh::default() }
}

#[test]
fn hair_in_the_shadow_of_a_body_is_lit_by_other_lamps_alone() {
    let (model, sky, view) = (hair(0.5), Sky { strength: 0.0, ..Sky::default() }, view());
    let lamp = |toward: Vec3, strength: f32| Lamp { toward, strength: [strength; 3], spread: 0.0 };
    let both = [lamp(Vec3::Y, 1.0), lamp(vec3(0.6, 0.0, 0.8), 1.0)];
    let body = [wall(vec3(0.0, 3.0, 0.0), Vec3::Y)];
    let shadows = both.map(|lamp| SolidShadows::new(&lamp, &Mesh::default(), &body));
    let under = |lamps: &[Lamp], solid_shadows: &[SolidShadows]| {
        seen(&HairLight { lamps, solid_shadows, ..under_nothing(&model, &sky, &view) }, 0.2)
    };
    let (open, hidden, other) = (under(&both, &[]), under(&both, &shadows), under(&both[1..], &[]));
    // What counts as dark, of the lamp above.
    assert!((hidden - other).abs() < 1e-4 * open && open > 1.1 * other, "{open} {hidden} {other}");
}

#[test]
fn hair_over_a_floor_has_the_colour_of_the_sky_above_and_under_a_roof_that_of_the_sky_below() {
    let (model, view) = (hair(0.2), view());
    let sky = Sky { strength: 1.0, above: [1.0, 0.0, 0.0], below: [0.0, 0.0, 1.0], ..Sky::default() };
    for (zenith, height) in [(Vec3::Y, -1.0), (Vec3::Y, 1.0), (Vec3::NEG_Y, 1.0), (Vec3::NEG_Y, -1.0)] {
        let mut sky_map = SkyMap::default();
        let closed = wall(height * Vec3::Y, Vec3::Y);
        sky_map.lay_out([Vec3::splat(-6.0), Vec3::splat(6.0)], 0.0, (&closed, &[]), zenith, rayon::iter::empty());
        sky_map.fill(&[], &[]);
        sky_map.gather((&[CurveNode::default()], &[true]), &view, &[], |_, _, _| 0.0);
        let light = HairLight { sky_map: Some(&sky_map), ..under_nothing(&model, &sky, &view) };
        let mut nodes = [Node::default()];
        light.shade(&[CurveNode { tangent: Vec3::Z, ..CurveNode::default() }], &[true], &mut nodes);
        let [red, _, blue] = nodes[0].light;
        let from_above = height * zenith.y < 0.0;
        // From the sides, whence most of it comes, both arrive alike.
        assert!(if from_above { red > 1.2 * blue } else { blue > 1.2 * red }, "{zenith} {height}: {red} {blue}");
    }
}

#[test]
fn black_hair_shines_brightest_on_the_mirror_cone() {
    let colour = HairColour::Melanin { eumelanin: 40.0, pheomelanin: 0.0 };
    let look = HairLook { colour, variation: 0.0, scale_tilt: 0.0, roughness: 3.0, ..HairLook::default() };
    let model = Model::Fibre(Box::new(Fibre::new(&look)));
    let (sky, view) = (Sky { strength: 0.0, ..Sky::default() }, view());
    for aside in [-1.0_f32, -0.5, 0.4, 0.9] {
        // The eye is along +x, the lamp aside from it in the plane of the hair: halfway between them hair stands across.
        let lamps = [Lamp { toward: vec3(aside.cos(), 0.0, aside.sin()), strength: [1.0; 3], spread: 0.0 }];
        let light = HairLight { lamps: &lamps, ..under_nothing(&model, &sky, &view) };
        let brightest = (-150..=150)
            .map(|lean| lean as f32 * 0.01)
            .max_by(|a, b| seen(&light, *a).total_cmp(&seen(&light, *b)))
            .unwrap();
        // In steps of 0.01; the cosines about the lobe draw it by a part of its square width.
        assert!((brightest + 0.5 * aside).abs() < 0.03, "{aside}: {brightest}");
    }
}

#[test]
fn light_that_has_come_through_hair_goes_on_away_from_the_lamp() {
    let (sky, view) = (Sky { strength: 0.0, ..Sky::default() }, view());
    for eumelanin in [0.05, 0.3, 1.0] {
        let model = hair(eumelanin);
        let from = |side: f32| {
            let lamps = [Lamp { toward: side * Vec3::X, strength: [1.0; 3], spread: 0.0 }];
            let crossings = Crossings::of(&[12.0]);
            seen(&HairLight { lamps: &lamps, crossings: &[&crossings], ..under_nothing(&model, &sky, &view) }, 0.0)
        };
        // A fibre passes on more than it sends back, and more comes than returns from what is behind it.
        assert!(from(-1.0) > from(1.0), "{eumelanin}: {} {}", from(-1.0), from(1.0));
    }
}

#[test]
fn strands_shine_at_places_of_their_own_as_far_as_they_vary() {
    let (sky, view) = (Sky { strength: 0.0, ..Sky::default() }, view());
    let model = hair(40.0);
    let lamps = [Lamp { toward: Vec3::X, strength: [1.0; 3], spread: 0.0 }];
    let brightest = |variation: f32, strand: u32| {
        let light = HairLight { lamps: &lamps, variation, ..under_nothing(&model, &sky, &view) };
        let shine = |lean: i32| {
            let tangent = vec3((0.005 * lean as f32).sin(), 0.0, (0.005 * lean as f32).cos());
            let mut nodes = [Node::default()];
            light.shade(&[CurveNode { tangent, strand, ..CurveNode::default() }], &[true], &mut nodes);
            nodes[0].light[1]
        };
        (-60..=60).max_by(|a, b| shine(*a).total_cmp(&shine(*b))).unwrap()
    };
    let places = |variation| -> Vec<i32> { (0..40).map(|strand| brightest(variation, strand)).collect() };
    let spread = |places: &[i32]| f64::from(places.iter().max().unwrap() - places.iter().min().unwrap());
    let [none, half, whole] = [0.0, 0.5, 1.0].map(|variation| spread(&places(variation)));
    assert!(none == 0.0 && half > 0.0 && (whole / half - 2.0).abs() < 0.5, "{none} {half} {whole}");
}
