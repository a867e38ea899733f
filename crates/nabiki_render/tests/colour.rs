//! The colour of hair as it looks.

mod common;

use glam::Vec3;
use nabiki::{Mesh, Strands};
use nabiki_render::colour::of_mass;
use nabiki_render::settings::{Background, Camera, HairColour, HairLook, Light, Projection, Sky};
use nabiki_render::tone_mapping::srgb_from_linear;
use nabiki_render::{Bounds, FrameToDraw, Picture, Renderer, View};

/// What a thick mass of hair of a look shows in even light and these lamps (linear): the middle of a mat of straight hairs.
fn shown(look: HairLook, lights: Vec<Light>) -> [f32; 3] {
    let look = HairLook { width: 0.1, tip: 1.0, ..look };
    let mut strands = Strands::default();
    for layer in 0..50 {
        for i in 0..140 {
            // Each layer lies between the hairs of the one before.
            let z = 0.1 * (i as f32 + 0.5 * (layer % 2) as f32) - 7.0;
            strands.push((0..=14).map(|k| Vec3::new(-0.1 * layer as f32, 7.0 - k as f32, z)));
        }
    }
    // Far away, where it hides nothing.
    let place = Vec3::new(-500.0, 0.0, 0.0);
    let head = Mesh {
        positions: vec![place, place + Vec3::Y, place + Vec3::Z, place - Vec3::X],
        triangles: vec![[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]],
        ..Mesh::default()
    };
    let camera = Camera {
        projection: Projection::Orthographic,
        height: Some(6.0),
        distance: Some(60.0),
        target: Some(Vec3::ZERO),
        elevation: 0.0,
        ..Camera::default()
    };
    let mut picture = Picture { size: [48, 48], camera, hair: look, lights, ..Picture::default() };
    picture.sky = Sky { strength: 1.0, above: [1.0; 3], below: [1.0; 3], ..Sky::default() };
    picture.background = Background { transparent: true, ..Background::default() };
    let view = View::new(&picture.camera, picture.size, &Bounds { low: Vec3::splat(-7.0), high: Vec3::splat(7.0) });
    let frame = Renderer::new(&picture, &head).unwrap().draw(&FrameToDraw::at_rest(&strands, view)).unwrap();
    let count = frame.rgba.len() as f32;
    assert!(frame.rgba.iter().all(|p| p[3] > 0.98), "the ground shows");
    [0, 1, 2].map(|c| frame.rgba.iter().map(|p| p[c]).sum::<f32>() / count)
}

#[test]
fn hair_of_a_named_colour_is_the_same_when_its_colour_is_given_as_it_looks() {
    for colour in [HairColour::Black, HairColour::Brown, HairColour::Blond, HairColour::Red, HairColour::Grey] {
        let look = HairLook { colour, ..HairLook::default() };
        // In steps as fine as a scene file has.
        let rgb = of_mass(&look).map(|c| (srgb_from_linear(c) * 1e4).round() / 1e4);
        let given = HairLook { colour: HairColour::Rgb(rgb), ..look };
        for lights in [Vec::new(), common::lamps()] {
            let [named, given] = [look, given].map(|look| shown(look, lights.clone()));
            for c in 0..3 {
                // Of black hair nothing but its surface shows, whatever is within.
                assert!((named[c] - given[c]).abs() < 0.01 * named[c] + 1e-4, "{colour:?}: {named:?} {given:?}");
            }
        }
    }
}

#[test]
fn a_lighter_colour_shows_lighter_hair_of_its_hue() {
    let mut before = [0.0; 3];
    for rgb in [[0.2, 0.12, 0.08], [0.4, 0.28, 0.2], [0.6, 0.45, 0.3], [0.8, 0.65, 0.5]] {
        let now = shown(HairLook { colour: HairColour::Rgb(rgb), ..HairLook::default() }, Vec::new());
        assert!(now[0] > now[1] && now[1] > now[2], "{rgb:?}: {now:?}");
        assert!((0..3).all(|c| now[c] > before[c]), "{rgb:?}: {now:?}");
        before = now;
    }
}
