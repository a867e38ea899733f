//! What must hold of drafts: few strands in the light of many.

mod common;

use glam::{Quat, Vec3};
use nabiki::{Mesh, Pose, Strands};
use nabiki_render::camera::direction;
use nabiki_render::settings::{Background, Projection};
use nabiki_render::{Bounds, Draft, Frame, FrameToDraw, Moment, Picture, Renderer, View};

fn octahedron() -> Mesh {
    let positions = [Vec3::X, Vec3::Y, Vec3::Z, -Vec3::X, -Vec3::Y, -Vec3::Z].map(|p| 8.5 * p).to_vec();
    let triangles = vec![[0, 1, 2], [2, 1, 3], [3, 1, 5], [5, 1, 0], [2, 4, 0], [3, 4, 2], [5, 4, 3], [0, 4, 5]];
    Mesh { positions, triangles, ..Mesh::default() }
}

/// Hair that stands off the head and falls, `count` strands spread evenly; it is blown aside by `swing`.
fn hair(count: usize, swing: f32) -> Strands {
    let mut all = Strands::default();
    for s in 0..count {
        let up = (1.0 - 1.6 * (s as f32 + 0.5) / count as f32).asin().to_degrees();
        let normal = direction(s as f32 * 137.508, up);
        all.push((0..=10).map(|k| {
            let t = k as f32;
            normal * (7.0 + 0.8 * t) - Vec3::Y * 0.06 * t * t + Vec3::Z * swing * 0.05 * t * t
        }));
    }
    all
}

fn picture(width: f32) -> Picture {
    let background = Background { transparent: true, ..Background::default() };
    let mut picture = Picture { size: [160, 160], background, lights: common::lamps(), ..Picture::default() };
    picture.hair.width = width;
    picture.camera.projection = Projection::Orthographic;
    picture.camera.height = Some(40.0);
    picture.camera.target = Some(Vec3::ZERO);
    picture
}

fn view(picture: &Picture) -> View {
    View::new(&picture.camera, picture.size, &Bounds { low: Vec3::splat(-16.0), high: Vec3::splat(16.0) })
}

fn renderer(picture: &Picture, draft: Option<Draft>) -> Renderer {
    let renderer = Renderer::new(picture, &octahedron()).unwrap();
    match draft {
        Some(draft) => renderer.drafted(draft),
        None => renderer,
    }
}

fn draw(renderer: &mut Renderer, strands: &Strands, pose: Pose) -> Frame {
    let view = view(renderer.picture());
    renderer.draw(&FrameToDraw { now: Moment { strands, pose, view, bodies: &[] }, before: None }).unwrap()
}

/// Mean colour of what shows.
fn colour(frame: &Frame) -> [f64; 3] {
    let sum = |c: usize| frame.rgba.iter().map(|p| f64::from(p[c])).sum::<f64>();
    let alpha = sum(3);
    [0, 1, 2].map(|c| sum(c) / alpha)
}

#[test]
fn hair_that_stands_for_itself_alone_is_drawn_as_in_the_final_to_the_bit() {
    let mut picture = picture(0.05);
    // Skin shares what reaches it between pixels.
    picture.head.visible = false;
    let strands = hair(900, 0.0);
    let wanted = draw(&mut renderer(&picture, None), &strands, Pose::STILL);
    let found = draw(&mut renderer(&picture, Some(Draft::new(1.0, 1.0))), &strands, Pose::STILL);
    assert!(found.rgba == wanted.rgba);
}

/// One strand in sixteen, as thick as four, takes a quarter of the light that the whole takes; drafted, as much.
#[test]
fn few_strands_have_the_colour_of_the_many_that_they_stand_for() {
    let whole = {
        let mut picture = picture(0.02);
        picture.head.visible = false;
        colour(&draw(&mut renderer(&picture, None), &hair(16_000, 0.0), Pose::STILL))
    };
    let mut picture = picture(0.08);
    picture.head.visible = false;
    let few = hair(1_000, 0.0);
    let off = |draft: Option<Draft>| -> f64 {
        let found = colour(&draw(&mut renderer(&picture, draft), &few, Pose::STILL));
        (0..3).map(|c| (found[c] / whole[c] - 1.0).abs()).fold(0.0, f64::max)
    };
    let (drafted, plain) = (off(Some(Draft::new(16.0, 4.0))), off(None));
    // A fifth of a stop, and much nearer than without.
    assert!(drafted < 0.15 && 3.0 * drafted < plain, "{drafted} {plain}");
}

#[test]
fn what_is_lit_once_is_what_each_frame_would_light_and_a_head_that_moves_is_lit_anew() {
    let picture = picture(0.1);
    let draft = Some(Draft::new(64.0, 8.0));
    let mut one_after_another = renderer(&picture, draft);
    let turned = Pose { rotation: Quat::from_rotation_y(0.7), ..Pose::STILL };
    let mut before: Option<Frame> = None;
    for (swing, pose) in [(0.0, Pose::STILL), (0.6, Pose::STILL), (0.6, turned), (0.2, turned), (0.2, Pose::STILL)] {
        let strands = hair(300, swing);
        let frame = draw(&mut one_after_another, &strands, pose);
        let alone = draw(&mut renderer(&picture, draft), &strands, pose);
        assert!(frame.rgba == alone.rgba, "{swing} {pose:?}");
        assert!(before.is_none_or(|before| before.rgba != frame.rgba));
        before = Some(frame);
    }
}

/// Without hair nothing is shared that differs: skin is that of the final.
#[test]
fn bald_skin_is_that_of_the_final_to_the_bit() {
    let mut picture = picture(0.1);
    picture.sky.occlusion = false;
    let bald = Strands::default();
    let wanted = draw(&mut renderer(&picture, None), &bald, Pose::STILL);
    let found = draw(&mut renderer(&picture, Some(Draft::new(64.0, 8.0))), &bald, Pose::STILL);
    assert!(wanted.rgba.iter().filter(|p| p[3] > 0.5).count() > 1_500);
    assert!(found.rgba == wanted.rgba);
}
