//! What must hold of the head on a picture.

use glam::{Vec3, vec3};
use nabiki::{Mesh, Pose, Strands};
use nabiki_render::settings::HairColour;
use nabiki_render::{Bounds, DrawnBody, Frame, FrameToDraw, Moment, Picture, Renderer, View};

/// A wall across the view, 20 cm wide and high.
fn wall() -> Mesh {
    let positions = [[-10.0, -10.0], [10.0, -10.0], [10.0, 10.0], [-10.0, 10.0]].map(|[z, y]| vec3(0.0, y, z)).to_vec();
    Mesh { positions, triangles: vec![[0, 1, 2], [0, 2, 3]], ..Mesh::default() }
}

/// Hair on the wall's upper half that grows away from the viewer, behind the wall, so that only its roots matter.
fn hidden_hair() -> Strands {
    let mut hair = Strands::default();
    for i in -40..=40 {
        for j in 8..=40 {
            let root = vec3(-0.01, 0.2 * j as f32, 0.2 * i as f32);
            hair.push((0..4).map(|k| root - Vec3::X * k as f32));
        }
    }
    hair
}

fn draw(picture: &Picture, hair: &Strands) -> Frame {
    let view = View::new(&picture.camera, picture.size, &Bounds { low: Vec3::splat(-9.0), high: Vec3::splat(9.0) });
    Renderer::new(picture, &wall()).unwrap().draw(&FrameToDraw::at_rest(hair, view)).unwrap()
}

#[test]
fn stubble_tints_the_skin_about_the_roots_and_nowhere_else() {
    let mut picture = Picture { size: [64, 64], ..Picture::default() };
    picture.camera.azimuth = 0.0;
    picture.camera.elevation = 0.0;
    picture.hair.colour = HairColour::Black;
    let with = |stubble: f32| {
        let mut picture = picture.clone();
        picture.head.stubble = stubble;
        draw(&picture, &hidden_hair())
    };
    let (bare, some, more) = (with(0.0), with(1.0), with(1e2));
    let at = |frame: &Frame, y: usize| frame.rgba[y * 64 + 32];
    // Among the roots: 25 of them a square centimetre, each with 0.014 or 1.4 square centimetres of black hair.
    for c in 0..3 {
        let (bare, some, more) = (at(&bare, 16)[c], at(&some, 16)[c], at(&more, 16)[c]);
        let expected = bare * (-25.0_f32 * 0.014).exp();
        // The density of a lattice of 0.2 cm is even to some percent; black hair, and what shows of
        // the roots themselves in the plane of the wall, returns less than a hundredth.
        assert!((some - expected).abs() < 0.03 * bare, "{some} {expected}");
        assert!(more < 1e-2 * bare, "{more} {bare}");
    }
    assert_eq!(at(&bare, 52), at(&more, 52));
}

#[test]
fn roots_tint_no_body_that_they_lie_on() {
    let mut picture = Picture { size: [64, 64], ..Picture::default() };
    (picture.camera.azimuth, picture.camera.elevation) = (0.0, 0.0);
    let mut with = |stubble: f32| {
        picture.head.stubble = stubble;
        let view = View::new(&picture.camera, picture.size, &Bounds { low: Vec3::splat(-9.0), high: Vec3::splat(9.0) });
        let body = DrawnBody { mesh: wall(), colour: [0.5; 3] };
        let mut renderer = Renderer::new(&picture, &Mesh::default()).unwrap().with_bodies(vec![body]).unwrap();
        let now = Moment { strands: &hidden_hair(), pose: Pose::STILL, view, bodies: &[Pose::STILL] };
        renderer.draw(&FrameToDraw { now, before: None }).unwrap()
    };
    let [bare, more] = [0.0, 1e2].map(&mut with);
    assert_eq!(bare.rgba[16 * 64 + 32], more.rgba[16 * 64 + 32]);
}
