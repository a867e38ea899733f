//! What must hold of pictures of a head that moves.

mod common;

use glam::{Quat, Vec2, Vec3, vec3};
use nabiki::{Mesh, Pose, Strands};
use nabiki_render::camera::direction;
use nabiki_render::settings::{Background, LightSpace, Projection, SkySpace};
use nabiki_render::{Bounds, DrawnBody, Frame, FrameToDraw, Moment, Picture, Renderer, ToneMapping, View};

const SIZE: [u32; 2] = [160, 120];

/// Every turn by a quarter about an axis brings it onto itself.
fn octahedron() -> Mesh {
    let positions = [Vec3::X, Vec3::Y, Vec3::Z, -Vec3::X, -Vec3::Y, -Vec3::Z].map(|p| 8.5 * p).to_vec();
    let triangles = vec![[0, 1, 2], [2, 1, 3], [3, 1, 5], [5, 1, 0], [2, 4, 0], [3, 4, 2], [5, 4, 3], [0, 4, 5]];
    Mesh { positions, triangles, ..Mesh::default() }
}

/// Hair that stands off the octahedron.
fn hair() -> Strands {
    let mut all = Strands::default();
    for s in 0..400 {
        let up = (1.0 - 1.6 * (s as f32 + 0.5) / 400.0).asin().to_degrees();
        let normal = direction(s as f32 * 137.508, up);
        all.push((0..=8).map(|k| normal * (6.0 + k as f32) - Vec3::Y * 0.05 * (k * k) as f32));
    }
    all
}

fn picture() -> Picture {
    let background = Background { transparent: true, ..Background::default() };
    let mut picture = Picture { size: SIZE, background, lights: common::lamps(), ..Picture::default() };
    picture.camera.projection = Projection::Orthographic;
    picture.camera.height = Some(40.0);
    picture.camera.target = Some(Vec3::ZERO);
    picture
}

fn lit_from(space: LightSpace, sky: SkySpace, picture: Picture) -> Picture {
    let mut picture = picture;
    picture.lights.iter_mut().for_each(|light| light.space = space);
    picture.sky.space = sky;
    picture
}

fn view(picture: &Picture) -> View {
    View::new(&picture.camera, picture.size, &Bounds { low: Vec3::splat(-16.0), high: Vec3::splat(16.0) })
}

/// The camera after all of the world is turned and moved.
fn carried(view: View, by: &Pose) -> View {
    let [right, up, forward] = [view.right, view.up, view.forward].map(|axis| by.rotation * axis);
    View { eye: by.rotation * view.eye + by.position_cm, right, up, forward, ..view }
}

fn turned(rotation: Quat) -> Pose {
    Pose { rotation, ..Pose::STILL }
}

fn moved(position_cm: Vec3) -> Pose {
    Pose { position_cm, ..Pose::STILL }
}

fn draw(picture: &Picture, strands: &Strands, now: (Pose, View), before: Option<(Pose, View)>) -> Frame {
    let moment = |(pose, view)| Moment { strands, pose, view, bodies: &[] };
    let frame = FrameToDraw { now: moment(now), before: before.map(moment) };
    Renderer::new(picture, &octahedron()).unwrap().with_layers().draw(&frame).unwrap()
}

/// Root of the mean square difference of two pictures as displayed, in steps of 255.
fn difference(picture: &Picture, a: &Frame, b: &Frame) -> f64 {
    let tone_mapping = ToneMapping::new(picture);
    let opaque = |frame: &Frame| {
        let mut frame = frame.clone();
        frame.rgba.iter_mut().for_each(|p| *p = std::array::from_fn(|c| p[c] + 0.2 * (1.0 - p[3])));
        frame.rgba.iter_mut().for_each(|p| p[3] = 1.0);
        tone_mapping.rgba8(&frame)
    };
    let (a, b) = (opaque(a), opaque(b));
    (a.iter().zip(&b).map(|(a, b)| (f64::from(*a) - f64::from(*b)).powi(2)).sum::<f64>() / a.len() as f64).sqrt()
}

/// Places are rounded after a turn: to some 1e-6 of 20 cm, which is 1e-4 pixels here. What is all or nothing about them (a cell
/// of the head's edge, an order in depth, a slab of a shadow) then turns out otherwise for one in ten thousand.
const ROUNDING: f64 = 0.3;
/// What the same settings differ by that should differ.
const PLAIN: f64 = 3.0;

#[test]
fn head_camera_and_lights_turned_together_give_the_same_picture() {
    let picture = lit_from(LightSpace::Head, SkySpace::Head, picture());
    let still = draw(&picture, &hair(), (Pose::STILL, view(&picture)), None);
    for axis in [Vec3::X, vec3(0.6, 0.0, 0.8), vec3(0.48, 0.6, 0.64)] {
        let pose = Pose { rotation: Quat::from_axis_angle(axis, 1.1), position_cm: vec3(30.0, -2.0, 5.0) };
        let together = draw(&picture, &hair(), (pose, carried(view(&picture), &pose)), None);
        let apart = difference(&picture, &still, &together);
        assert!(apart < ROUNDING, "{axis}: {apart} of 255");
        // Lamps of the world or the camera, and the sky, stay behind.
        let left_behind = lit_from(LightSpace::World, SkySpace::World, picture.clone());
        let apart = difference(
            &picture,
            &draw(&left_behind, &hair(), (Pose::STILL, view(&picture)), None),
            &draw(&left_behind, &hair(), (pose, carried(view(&picture), &pose)), None),
        );
        assert!(apart > PLAIN, "{axis}: {apart} of 255");
    }
}

#[test]
fn a_head_at_rest_gives_the_same_bits_however_it_is_said() {
    let picture = picture();
    let strands = hair();
    let rest = FrameToDraw::at_rest(&strands, view(&picture));
    let one = Renderer::new(&picture, &octahedron()).unwrap().with_layers().draw(&rest).unwrap();
    assert!(one == draw(&picture, &strands, (turned(Quat::IDENTITY), view(&picture)), None));
    // A shutter of 0 looks at the frame alone.
    let before = (turned(Quat::from_rotation_x(1.0)), view(&picture));
    assert!(one == draw(&picture, &strands, (Pose::STILL, view(&picture)), Some(before)));
}

#[test]
fn light_stays_where_it_is_when_the_head_turns_by_a_quarter() {
    let quarter = std::f32::consts::FRAC_PI_2;
    let turns = [Quat::from_rotation_x(quarter), Quat::from_rotation_y(quarter), Quat::from_rotation_z(quarter)];
    let of = |space, sky, pose| {
        let picture = lit_from(space, sky, picture());
        draw(&picture, &Strands::default(), (pose, view(&picture)), None)
    };
    for turn in turns {
        for (space, sky, stays) in [
            (LightSpace::World, SkySpace::World, true),
            (LightSpace::Camera, SkySpace::World, true),
            (LightSpace::Head, SkySpace::World, false),
        ] {
            let apart = difference(&picture(), &of(space, sky, Pose::STILL), &of(space, sky, turned(turn)));
            assert!(if stays { apart < ROUNDING } else { apart > PLAIN }, "{space:?} {turn}: {apart} of 255");
        }
    }
    // The sky alone: it turns with the head only if the scene says so, and a turn about the vertical leaves it.
    let under = |sky, pose| {
        let picture = Picture { lights: Vec::new(), ..lit_from(LightSpace::World, sky, picture()) };
        draw(&picture, &Strands::default(), (pose, view(&picture)), None)
    };
    let apart = |sky, turn| difference(&picture(), &under(sky, Pose::STILL), &under(sky, turned(turn)));
    assert!(apart(SkySpace::World, turns[0]) < ROUNDING);
    assert!(apart(SkySpace::Head, turns[0]) > 0.5);
    assert!(apart(SkySpace::Head, turns[1]) < ROUNDING);
}

#[test]
fn a_head_that_turns_about_the_view_axis_blurs_and_tells_how_it_moves() {
    const SHUTTER: f32 = 0.9;
    let turn = 20.0_f32.to_radians();
    let mut sharp = picture();
    sharp.hair.width = 0.15;
    let open = Picture { shutter: SHUTTER, ..sharp.clone() };
    let view = view(&sharp);
    // About the axis toward the eye: against the clock on the picture, in which y runs down.
    let before = (turned(Quat::IDENTITY), view);
    let now = (turned(Quat::from_axis_angle(-view.forward, turn)), view);
    let a = draw(&sharp, &hair(), now, Some(before));
    let b = draw(&open, &hair(), now, Some(before));
    assert!(difference(&sharp, &a, &b) > PLAIN);
    assert!(a.layers.iter().all(|l| l.motion == [0.0; 2]));

    let half = 0.5 * SHUTTER * turn;
    let (mut hair_pixels, mut head_pixels) = (0, 0);
    for (i, layer) in b.layers.iter().enumerate() {
        let share = layer.hair + layer.head;
        if share < 0.2 {
            continue;
        }
        let pixel = Vec2::new((i % SIZE[0] as usize) as f32 + 0.5, (i / SIZE[0] as usize) as f32 + 0.5);
        let from_axis = pixel - 0.5 * Vec2::new(SIZE[0] as f32, SIZE[1] as f32);
        // What is here halfway through was turned back by half the angle, and will be turned on by it.
        let expected = Vec2::new(from_axis.y, -from_axis.x) * 2.0 * half.sin();
        let told = Vec2::from_array(layer.motion) / share;
        // What shows in the pixel at other times is elsewhere halfway through: turned by half the angle at most, by a quarter
        // in the mean over one half of the time. A pixel's cells and a hair's width are one pixel wide.
        let elsewhere = if layer.head > 0.98 { 1.0 - half.sin() / half } else { half };
        let tolerance = elsewhere * expected.length() + 2.0 * half.sin();
        assert!(told.distance(expected) < tolerance, "{pixel}: {told}, not {expected}");
        hair_pixels += usize::from(layer.hair > 0.9 * share);
        head_pixels += usize::from(layer.head > 0.98);
    }
    assert!(hair_pixels > 1000 && head_pixels > 30, "{hair_pixels} {head_pixels}");
}

#[test]
fn a_head_that_turns_keeps_its_area_and_loses_its_edge() {
    let sharp = picture();
    let open = Picture { shutter: 1.0, ..picture() };
    let view = view(&sharp);
    let before = (Pose::STILL, view);
    let now = (turned(Quat::from_axis_angle(view.forward, 0.5)), view);
    let [a, b] = [&sharp, &open].map(|picture| draw(picture, &Strands::default(), now, Some(before)));
    let area = |f: &Frame| f.rgba.iter().map(|p| f64::from(p[3])).sum::<f64>();
    let edge = |f: &Frame| f.rgba.iter().filter(|p| p[3] > 0.01 && p[3] < 0.99).count();
    // Edges of some 200 pixels, each pixel known to a cell of 16 at a moment of 16: the error of a lattice of that many points.
    assert!((area(&a) / area(&b) - 1.0).abs() < 2e-3, "{} {}", area(&a), area(&b));
    assert!(edge(&b) > 3 * edge(&a), "{} {}", edge(&a), edge(&b));
}

#[test]
fn it_is_all_the_same_whether_the_head_moves_or_the_camera() {
    let picture = Picture { shutter: 0.8, ..lit_from(LightSpace::World, SkySpace::World, picture()) };
    let view = view(&picture);
    let way = vec3(1.0, 0.5, 2.0);
    let head = draw(&picture, &hair(), (moved(way), view), Some((Pose::STILL, view)));
    let now = (Pose::STILL, carried(view, &moved(-way)));
    let camera = draw(&picture, &hair(), now, Some((Pose::STILL, view)));
    let apart = difference(&picture, &head, &camera);
    assert!(apart < ROUNDING, "{apart} of 255");
    // A camera that goes along sees it at rest.
    let along = draw(&picture, &hair(), (moved(way), carried(view, &moved(way))), Some((Pose::STILL, view)));
    let rest = draw(&picture, &hair(), (Pose::STILL, view), None);
    let apart = difference(&picture, &along, &rest);
    assert!(apart < ROUNDING, "{apart} of 255");
    assert!(difference(&picture, &head, &rest) > PLAIN);
}

/// Alpha's middle on the picture and its mean square about that, right and down (pixels).
fn place_and_width(frame: &Frame) -> [[f64; 2]; 2] {
    let mut sums = [[0.0; 3]; 2];
    for (i, p) in frame.rgba.iter().enumerate() {
        for (sums, at) in sums.iter_mut().zip([i as u32 % SIZE[0], i as u32 / SIZE[0]]) {
            (0..3).for_each(|power| sums[power as usize] += f64::from(p[3]) * (f64::from(at) + 0.5).powi(power));
        }
    }
    sums.map(|[whole, first, second]| [first / whole, second / whole - (first / whole).powi(2)])
}

#[test]
fn what_moves_is_spread_over_its_way_while_the_shutter_is_open_which_ends_at_the_frame() {
    const SHUTTER: f32 = 0.4;
    let sharp = picture();
    let open = Picture { shutter: SHUTTER, ..picture() };
    let view = view(&sharp);
    let way = 6.0 * view.right - 3.0 * view.up;
    let upright = |off: Vec3| {
        let mut hair = Strands::default();
        hair.push((0..9).map(|k| off + vec3(0.0, 4.0 - k as f32, 0.0)));
        hair
    };
    let (start, end) = (upright(Vec3::ZERO), upright(way));
    let (nobody, head) = (Mesh::default(), octahedron());
    let body = |off: Vec3| vec![moved(off)];
    let none = Strands::default();
    // Each from the frame before to the frame: the hair, a head, a body, and hair before a camera that goes the other way.
    type When<'a> = (&'a Strands, Pose, View, Vec<Pose>);
    fn moment<'a>((strands, pose, view, bodies): &'a When) -> Moment<'a> {
        Moment { strands, pose: *pose, view: *view, bodies }
    }
    let movers: [(&Mesh, [When; 2]); 4] = [
        (&nobody, [(&start, Pose::STILL, view, vec![]), (&end, Pose::STILL, view, vec![])]),
        (&head, [(&none, Pose::STILL, view, vec![]), (&none, moved(way), view, vec![])]),
        (&nobody, [(&none, Pose::STILL, view, body(Vec3::ZERO)), (&none, moved(3.0 * way), view, body(way))]),
        (&nobody, [(&start, Pose::STILL, view, vec![]), (&start, Pose::STILL, carried(view, &moved(-way)), vec![])]),
    ];
    for (n, (head, [before, now])) in movers.into_iter().enumerate() {
        let seen = |picture: &Picture, now: &When| {
            let bodies = now.3.iter().map(|_| DrawnBody { mesh: octahedron(), colour: [0.5; 3] }).collect();
            let renderer = Renderer::new(picture, head).unwrap().with_bodies(bodies).unwrap().with_layers();
            { renderer }.draw(&FrameToDraw { now: moment(now), before: Some(moment(&before)) }).unwrap()
        };
        let [first, last] = [&before, &now].map(|moment| place_and_width(&seen(&sharp, moment)));
        let blurred = seen(&open, &now);
        let (mut share, mut told) = (0.0, [0.0; 2]);
        for layer in &blurred.layers {
            share += f64::from(layer.hair + layer.head);
            (0..2).for_each(|c| told[c] += f64::from(layer.motion[c]));
        }
        for (c, [place, width]) in place_and_width(&blurred).into_iter().enumerate() {
            let far = last[c][0] - first[c][0];
            assert!(far.abs() > 5.0, "{n}: {far} pixels");
            let part = f64::from(SHUTTER) * far;
            // An even spread over a way has a twelfth of its square; all is known to a cell, a quarter of a pixel. Hair is spread across
            // itself alone: here from side to side.
            let spread = if c == 1 && !now.0.is_empty() { 0.0 } else { part * part / 12.0 };
            assert!(
                (place - (last[c][0] - 0.5 * part)).abs() < 0.125,
                "{n}: {place} from {} to {}",
                first[c][0],
                last[c][0]
            );
            assert!((width - last[c][1] - spread).abs() < 0.25, "{n}: {width} for {}", last[c][1]);
            assert!((told[c] / share - part).abs() < 0.02 * part.abs(), "{n}: {} of {part}", told[c] / share);
        }
    }
}
