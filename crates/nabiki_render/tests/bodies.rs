//! What must hold of bodies on a picture.

use glam::{Quat, Vec3, vec3};
use nabiki::{Mesh, Pose, Strands};
use nabiki_render::camera::direction;
use nabiki_render::settings::{Antialiasing, Background, Light, LightSpace, Projection};
use nabiki_render::{Bounds, DrawnBody, Frame, FrameToDraw, Moment, Picture, Renderer, View};

const SIDE: u32 = 96;
/// Centimetres of the picture, from top to bottom.
const HEIGHT: f32 = 48.0;

fn octahedron(radius: f32) -> Mesh {
    let positions = [Vec3::X, Vec3::Y, Vec3::Z, -Vec3::X, -Vec3::Y, -Vec3::Z].map(|p| radius * p).to_vec();
    let triangles = vec![[0, 1, 2], [2, 1, 3], [3, 1, 5], [5, 1, 0], [2, 4, 0], [3, 4, 2], [5, 4, 3], [0, 4, 5]];
    Mesh { positions, triangles, ..Mesh::default() }
}

fn hair() -> Strands {
    let mut all = Strands::default();
    for s in 0..600 {
        let up = (1.0 - 1.6 * (s as f32 + 0.5) / 600.0).asin().to_degrees();
        let normal = direction(s as f32 * 137.508, up);
        all.push((0..=8).map(|k| normal * (6.0 + k as f32) - Vec3::Y * 0.05 * (k * k) as f32));
    }
    all
}

/// From before the face, under one sharp lamp from above and no sky.
fn picture() -> Picture {
    let background = Background { transparent: true, ..Background::default() };
    let lamp = Light { elevation: 90.0, spread: 0.0, space: LightSpace::World, ..Light::default() };
    let mut picture = Picture { size: [SIDE; 2], background, lights: vec![lamp], ..Picture::default() };
    picture.sky.strength = 0.0;
    picture.hair.width = 0.1;
    picture.camera.projection = Projection::Orthographic;
    picture.camera.azimuth = 0.0;
    picture.camera.elevation = 0.0;
    picture.camera.height = Some(HEIGHT);
    picture.camera.target = Some(Vec3::ZERO);
    picture
}

fn view(picture: &Picture) -> View {
    View::new(&picture.camera, picture.size, &Bounds { low: Vec3::splat(-50.0), high: Vec3::splat(50.0) })
}

fn at(position_cm: Vec3) -> Pose {
    Pose { position_cm, ..Pose::STILL }
}

/// The head with hair and these bodies, each with its pose in the frame and in the one before.
fn draw(picture: &Picture, strands: &Strands, bodies: &[(Mesh, Pose, Pose)]) -> Frame {
    let drawn = bodies.iter().map(|(mesh, ..)| DrawnBody { mesh: mesh.clone(), colour: [0.2, 0.3, 0.6] }).collect();
    let mut renderer = Renderer::new(picture, &octahedron(8.0)).unwrap().with_bodies(drawn).unwrap();
    if picture.antialiasing == Antialiasing::Coverage {
        renderer = renderer.with_layers();
    }
    let (now, before): (Vec<Pose>, Vec<Pose>) = bodies.iter().map(|(_, now, before)| (*now, *before)).unzip();
    let moment = |bodies| Moment { strands, pose: Pose::STILL, view: view(picture), bodies };
    renderer.draw(&FrameToDraw { now: moment(now.as_slice()), before: Some(moment(before.as_slice())) }).unwrap()
}

fn still(radius: f32, place: Vec3) -> (Mesh, Pose, Pose) {
    (octahedron(radius), at(place), at(place))
}

/// The pixel that shows the place (0, y, z).
fn pixel(y: f32, z: f32) -> usize {
    let per_cm = SIDE as f32 / HEIGHT;
    // From before the face, her left (-z) is on the right.
    let [column, row] = [-z, -y].map(|c| (0.5 * SIDE as f32 + c * per_cm) as usize);
    row * SIDE as usize + column
}

#[test]
fn a_body_before_the_hair_hides_it_and_one_behind_does_not() {
    for antialiasing in [Antialiasing::Coverage, Antialiasing::Oversample] {
        let picture = Picture { antialiasing, ..picture() };
        let bare = draw(&picture, &hair(), &[]);
        let before = draw(&picture, &hair(), &[still(5.0, vec3(30.0, 0.0, 0.0))]);
        let behind = draw(&picture, &hair(), &[still(5.0, vec3(-30.0, 0.0, 0.0))]);
        // The body's tip is at 35 cm, what is nearest of hair and head within 14 of the origin.
        let middle = pixel(0.0, 0.0);
        assert!(bare.depth[middle] - before.depth[middle] > 20.0);
        assert_eq!(bare.depth[middle].to_bits(), behind.depth[middle].to_bits());
        assert!((before.rgba[middle][3] - 1.0).abs() < 1e-5);
        if antialiasing == Antialiasing::Coverage {
            assert!(bare.layers[middle].hair > 0.0, "there is hair to hide");
            assert_eq!((before.layers[middle].hair, before.layers[middle].head), (0.0, 1.0));
        }
        // Beside the body nothing is hidden, and the lamp above reaches all.
        let beside = pixel(0.0, 10.0);
        assert_eq!(bare.rgba[beside], before.rgba[beside]);
    }
}

#[test]
fn a_body_throws_its_shadow_on_head_and_hair_and_nowhere_else() {
    let picture = picture();
    for strands in [Strands::default(), hair()] {
        let bare = draw(&picture, &strands, &[]);
        // Above the picture, so that nothing but its shadow is seen; twice as wide as the head with its hair.
        let above = draw(&picture, &strands, &[still(40.0, vec3(0.0, 80.0, 0.0))]);
        let light = |frame: &Frame| frame.rgba.iter().map(|p| f64::from(p[0] + p[1] + p[2])).sum::<f64>();
        assert!(light(&bare) > 10.0);
        assert!(light(&above) < 1e-3 * light(&bare), "{} of {}", light(&above), light(&bare));
        assert!(bare.rgba.iter().zip(&above.rgba).all(|(a, b)| a[3] == b[3]));
        // Away from the lamp it takes nothing.
        let below = draw(&picture, &strands, &[still(40.0, vec3(0.0, -80.0, 0.0))]);
        assert!(bare.rgba == below.rgba);
        let unshadowed = Picture { shadows: false, ..picture.clone() };
        let above = still(40.0, vec3(0.0, 80.0, 0.0));
        assert!(draw(&unshadowed, &strands, &[]).rgba == draw(&unshadowed, &strands, &[above]).rgba);
    }
}

#[test]
fn hair_and_head_throw_their_shadow_on_a_body() {
    let picture = picture();
    let body = || still(3.0, vec3(0.0, -19.0, 0.0));
    let alone = pixel(-17.5, 0.5);
    let lit = draw(&Picture { shadows: false, ..picture.clone() }, &hair(), &[body()]).rgba[alone];
    let dark = draw(&picture, &hair(), &[body()]).rgba[alone];
    assert!(lit[2] > 0.05, "{lit:?}");
    assert!(dark[2] < 1e-3 * lit[2], "{dark:?} {lit:?}");
}

#[test]
fn a_body_lies_where_its_pose_puts_it() {
    let picture = picture();
    let pose = Pose { position_cm: vec3(4.0, 3.0, 17.0), rotation: Quat::from_rotation_x(0.7) };
    let mut moved = octahedron(4.0);
    moved.positions.iter_mut().for_each(|p| *p = pose.world_from_head().transform_point3(*p));
    let a = draw(&picture, &hair(), &[(octahedron(4.0), pose, pose)]);
    let b = draw(&picture, &hair(), &[(moved, Pose::STILL, Pose::STILL)]);
    // A rounding may put one cell of an edge of some 60 pixels on its other side.
    let apart = a.rgba.iter().zip(&b.rgba).filter(|(a, b)| (0..4).any(|c| (a[c] - b[c]).abs() > 1e-3)).count();
    assert!(apart <= 1, "{apart} pixels");
    assert!(a.rgba != draw(&picture, &hair(), &[]).rgba);
}

#[test]
fn a_body_that_moves_blurs_and_tells_how_it_moves() {
    let open = Picture { shutter: 0.5, ..picture() };
    let (from, to) = (vec3(0.0, 16.0, 12.0), vec3(0.0, 16.0, 8.0));
    let frame = draw(&open, &Strands::default(), &[(octahedron(5.0), at(to), at(from))]);
    // Four centimetres to the right in a frame, half of which is seen: from 10 to 8, with 2 pixels to the centimetre.
    let layer = frame.layers[pixel(16.0, 9.0)];
    assert_eq!(layer.head, 1.0);
    assert!((layer.motion[0] - 4.0).abs() < 1e-3 && layer.motion[1].abs() < 1e-3, "{:?}", layer.motion);
    // The head stands still.
    assert_eq!(frame.layers[pixel(0.0, 0.0)].motion, [0.0; 2]);
    let edge = |f: &Frame| f.rgba.iter().filter(|p| p[3] > 0.01 && p[3] < 0.99).count();
    let sharp = draw(&picture(), &Strands::default(), &[(octahedron(5.0), at(to), at(from))]);
    assert!(edge(&frame) > edge(&sharp) + 20, "{} {}", edge(&frame), edge(&sharp));
}

#[test]
fn the_bits_do_not_depend_on_threads_or_on_what_was_drawn_before() {
    let picture = Picture { shutter: 0.5, ..picture() };
    let strands = hair();
    let poses = [vec3(20.0, 8.0, 6.0), vec3(20.0, 7.0, 2.0), vec3(20.0, 6.0, -3.0)].map(at);
    let film = |threads: usize| {
        let draw = || {
            let body = DrawnBody { mesh: octahedron(4.0), colour: [0.5; 3] };
            let mut renderer = Renderer::new(&picture, &octahedron(8.0)).unwrap().with_bodies(vec![body]).unwrap();
            let moment =
                |n: usize| Moment { strands: &strands, pose: Pose::STILL, view: view(&picture), bodies: &poses[n..=n] };
            // Through all frames, and back to the second.
            let drawn =
                [1, 2, 1].map(|n| renderer.draw(&FrameToDraw { now: moment(n), before: Some(moment(n - 1)) }).unwrap());
            assert!(drawn[0] == drawn[2] && drawn[0] != drawn[1]);
            drawn
        };
        rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(draw)
    };
    let one = film(1);
    assert!(film(2) == one && film(5) == one);
}

#[test]
fn bodies_that_cannot_be_drawn_are_refused() {
    let renderer = || Renderer::new(&picture(), &octahedron(8.0)).unwrap();
    let with = |mesh: Mesh| renderer().with_bodies(vec![DrawnBody { mesh, colour: [0.5; 3] }]);
    let mut broken = octahedron(1.0);
    broken.positions[2].y = f32::NAN;
    let text = with(broken).err().unwrap().to_string();
    assert!(text.starts_with("vertex 2 of body 0 lies at"), "{text}");
    let mut broken = octahedron(1.0);
    broken.triangles[3][1] = 6;
    assert_eq!(with(broken).err().unwrap().to_string(), "triangle 3 of body 0 names a vertex past its 6");
    let strands = hair();
    let frame = FrameToDraw::at_rest(&strands, view(&picture()));
    let text = with(octahedron(1.0)).unwrap().draw(&frame).unwrap_err().to_string();
    assert_eq!(text, "0 poses for 1 bodies: give one for each");
}
