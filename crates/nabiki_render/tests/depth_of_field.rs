//! What must hold of every picture that is taken through a lens.

mod common;

use glam::{Vec3, vec3};
use nabiki::{Mesh, Pose, Strands};
use nabiki_render::camera::direction;
use nabiki_render::settings::{Antialiasing, Background, Camera, CameraKey, Projection};
use nabiki_render::{Bounds, Frame, FrameToDraw, Moment, Picture, Renderer, View};

const DISTANCE: f32 = 40.0;

/// A camera on the x axis, so that a place's depth is `DISTANCE` less its x; what is at the origin is sharp.
fn picture(f_stop: Option<f32>) -> Picture {
    let camera = Camera {
        azimuth: 0.0,
        elevation: 0.0,
        target: Some(Vec3::ZERO),
        distance: Some(DISTANCE),
        focus_distance: Some(DISTANCE),
        f_stop,
        ..Camera::default()
    };
    let background = Background { transparent: true, ..Background::default() };
    let mut picture = Picture { size: [160, 160], camera, background, lights: common::lamps(), ..Picture::default() };
    picture.hair.tip = 1.0;
    picture
}

fn view(picture: &Picture) -> View {
    View::new(&picture.camera, picture.size, &Bounds::default())
}

fn draw(picture: &Picture, head: &Mesh, strands: &Strands) -> Frame {
    Renderer::new(picture, head).unwrap().with_layers().draw(&FrameToDraw::at_rest(strands, view(picture))).unwrap()
}

fn line(points: impl IntoIterator<Item = Vec3>) -> Strands {
    let mut strands = Strands::default();
    strands.push(points);
    strands
}

fn upright(x: f32) -> Strands {
    line((0..9).map(|k| vec3(x, k as f32 - 4.0, 0.03)))
}

/// Wisps all around, and far before and behind what is sharp.
fn wisps(count: usize, turn: f32) -> Strands {
    let mut all = Strands::default();
    for s in 0..count {
        let up = (1.0 - 1.6 * (s as f32 + 0.5) / count as f32).asin().to_degrees();
        let normal = direction(s as f32 * 137.508 + turn, up);
        all.push((0..9).map(|k| normal * (3.0 + 0.5 * k as f32) - Vec3::Y * 0.02 * (k * k) as f32));
    }
    all
}

fn octahedron() -> Mesh {
    let positions = [Vec3::X, Vec3::Y, Vec3::Z, -Vec3::X, -Vec3::Y, -Vec3::Z].map(|p| 3.5 * p).to_vec();
    let triangles = vec![[0, 1, 2], [2, 1, 3], [3, 1, 5], [5, 1, 0], [2, 4, 0], [3, 4, 2], [5, 4, 3], [0, 4, 5]];
    Mesh { positions, triangles, ..Mesh::default() }
}

fn sum(frame: &Frame) -> [f64; 4] {
    frame.rgba.iter().fold([0.0; 4], |sum, p| std::array::from_fn(|c| sum[c] + f64::from(p[c])))
}

/// Root of the mean square difference of light and alpha.
fn apart(a: &Frame, b: &Frame) -> f64 {
    let of = |(a, b): (&[f32; 4], &[f32; 4])| (0..4).map(|c| f64::from(a[c] - b[c]).powi(2)).sum::<f64>();
    (a.rgba.iter().zip(&b.rgba).map(of).sum::<f64>() / (4 * a.rgba.len()) as f64).sqrt()
}

/// Mean place and mean square about it of the alpha in the rows about the middle (pixels).
fn across(frame: &Frame) -> (f64, f64) {
    let [width, height] = frame.size.map(|s| s as usize);
    let mut moments = [0.0; 3];
    for y in height / 2 - 10..height / 2 + 10 {
        for x in 0..width {
            let (at, alpha) = (x as f64 + 0.5, f64::from(frame.rgba[y * width + x][3]));
            for (power, moment) in moments.iter_mut().enumerate() {
                *moment += alpha * at.powi(power as i32);
            }
        }
    }
    let mean = moments[1] / moments[0];
    (mean, moments[2] / moments[0] - mean * mean)
}

#[test]
fn a_pinhole_stays_one_whatever_it_is_focused_on() {
    let hair = wisps(200, 0.0);
    let pinhole = picture(None);
    let mut elsewhere = pinhole.clone();
    elsewhere.camera.focus_distance = None;
    assert_eq!(draw(&pinhole, &octahedron(), &hair), draw(&elsewhere, &octahedron(), &hair));
}

#[test]
fn what_lies_in_the_plane_of_focus_is_as_sharp_as_without_a_lens() {
    let mut hair = Strands::default();
    for s in 0..40 {
        let (sin, cos) = (s as f32 * 0.7).sin_cos();
        hair.push((1..9).map(|k| vec3(0.0, 0.5 * k as f32 * sin, 0.5 * k as f32 * cos)));
    }
    let [sharp, seen] = [None, Some(1.0)].map(|f_stop| draw(&picture(f_stop), &Mesh::default(), &hair));
    // Depths are 40 cm, rounded; a point of the lens of 5.2 cm moves what is off by three roundings by 1e-5 pixels, and
    // coordinates of 80 pixels are rounded to as much. A cell takes at most four times that, and is a sixteenth of a pixel.
    for (i, (a, b)) in sharp.rgba.iter().zip(&seen.rgba).enumerate() {
        assert!((a[3] - b[3]).abs() < 2e-3, "pixel {i}: {a:?} {b:?}");
    }
}

#[test]
fn a_thin_hair_is_spread_as_wide_as_the_thin_lens_says() {
    for (x, f_stop) in [(6.0, 1.4), (-8.0, 1.4), (10.0, 4.0), (-20.0, 1.0), (20.0, 1.4)] {
        let seen = draw(&picture(Some(f_stop)), &Mesh::default(), &upright(x));
        let focal_length = 1.2 / 13.0_f32.to_radians().tan();
        let depth = DISTANCE - x;
        let per_cm = 80.0 / 13.0_f32.to_radians().tan();
        let radius = f64::from(0.5 * focal_length / f_stop * per_cm * (1.0 / DISTANCE - 1.0 / depth).abs());
        let (middle, width) = across(&seen);
        // The mean square of a disc of that radius is a quarter of its square, that of a pixel a twelfth. How strips a quarter of
        // the disc wide fall on pixels is a sixteenth of it.
        let wide = 0.25 * radius * radius + 1.0 / 12.0;
        assert!((width / wide - 1.0).abs() < 1.0 / 16.0, "{x} {f_stop}: {width} for {wide}");
        // Their mean is the middle of the lens: what is off is rounding, and what a cell has for its share.
        let place = f64::from(80.0 - 0.03 * per_cm / depth);
        assert!((middle - place).abs() < 0.125, "{x} {f_stop}: {middle} for {place}");
    }
}

#[test]
fn a_lens_neither_makes_nor_takes_light() {
    for x in [-15.0, -3.0, 3.0, 12.0] {
        let hair = line((0..9).map(|k| vec3(x + 0.3 * k as f32, 0.8 * (k as f32 - 4.0), 0.5 * k as f32 - 2.0)));
        let [sharp, seen] = [None, Some(2.0)].map(|f_stop| sum(&draw(&picture(f_stop), &Mesh::default(), &hair)));
        for c in 0..4 {
            // Ends are cut to within an eighth of a pixel of some hundred, and pieces meet within a fiftieth of their width.
            assert!((seen[c] / sharp[c] - 1.0).abs() < 5e-3, "{x}, channel {c}: {} {}", seen[c], sharp[c]);
        }
    }
}

#[test]
fn blurred_hair_lies_over_a_sharp_head_and_none_shows_through_it() {
    let mut picture = picture(Some(1.4));
    // The front corner of the head, and its sides 3.5 cm behind, with 8 cm more to the hair at either side.
    picture.camera.focus_distance = None;
    let hair_in = |x: f32, f_stop| {
        let picture = Picture { camera: Camera { f_stop, ..picture.camera }, ..picture.clone() };
        let frame = draw(&picture, &octahedron(), &line((0..5).map(|k| vec3(x, 0.25 * k as f32 - 0.5, 0.0))));
        frame.layers.iter().map(|layer| f64::from(layer.hair)).sum::<f64>()
    };
    let (sharp, seen) = (hair_in(11.0, None), hair_in(11.0, Some(1.4)));
    // As in the test of all light.
    assert!(sharp > 0.0 && (seen / sharp - 1.0).abs() < 5e-3, "{sharp} {seen}");
    // From no point of a lens of 3.7 cm can a hair be seen 4 cm behind the middle of a head of 3.5 cm.
    assert_eq!(hair_in(-4.0, Some(1.4)), 0.0);
}

#[test]
fn the_shares_of_hair_and_head_make_up_what_is_covered() {
    for f_stop in [None, Some(1.4)] {
        let mut picture = picture(f_stop);
        picture.hair.width = 0.1;
        let seen = draw(&picture, &octahedron(), &wisps(3000, 0.0));
        let (mut full, mut nearly) = (0, 0);
        for (layer, rgba) in seen.layers.iter().zip(&seen.rgba) {
            // Some roundings for each of hundreds of pieces.
            assert!((layer.hair + layer.head - rgba[3]).abs() < 1e-4, "{layer:?} {rgba:?}");
            let [x, y, z] = layer.direction;
            assert!(x.hypot(y).hypot(z) <= layer.hair + 1e-4, "{layer:?}");
            full += u32::from(layer.head == 0.0 && rgba[3] > 0.9999);
            nearly += u32::from((1.0 / 512.0..1.0 / 64.0).contains(&(1.0 - rgba[3])));
        }
        assert!(full > 100, "pixels full of hair, where what it holds stands for the rest: {full}");
        // Before a white wall 1/64 would be 30 steps of 8 bits, where it ends to show.
        assert!(nearly > 100, "pixels that let a little through: {nearly}");
    }
}

#[test]
fn more_points_of_the_lens_change_less() {
    let picture = picture(Some(1.0));
    let (hair, head) = (wisps(600, 0.0), octahedron());
    let through = |count| {
        let renderer = Renderer::new(&picture, &head).unwrap().with_lens_points(count);
        { renderer }.draw(&FrameToDraw::at_rest(&hair, view(&picture))).unwrap()
    };
    let whole = through(256);
    let errors = [4, 16, 64].map(|count| apart(&through(count), &whole));
    // Each point stands for a part of the lens that is half as wide: the error falls by half at the least, and by 1/4 at best.
    assert!(errors.windows(2).all(|e| e[1] < 0.6 * e[0]), "{errors:?}");
    // As many as are chosen unasked are within a step of 255.
    let unasked = Renderer::new(&picture, &head).unwrap().draw(&FrameToDraw::at_rest(&hair, view(&picture))).unwrap();
    assert!(apart(&unasked, &whole) < 1.0 / 255.0, "{}", apart(&unasked, &whole));
}

#[test]
fn what_moves_in_the_plane_of_focus_is_blurred_as_without_a_lens() {
    let hair = |aside: f32| line((0..9).map(|k| vec3(0.0, k as f32 - 4.0 - 0.5 * aside, 0.03 + aside)));
    let (before, now) = (hair(-1.5), hair(1.5));
    let [sharp, seen] = [None, Some(1.4)].map(|f_stop| {
        let picture = Picture { shutter: 0.5, ..picture(f_stop) };
        let moment = |strands| Moment { strands, pose: Pose::STILL, view: view(&picture), bodies: &[] };
        let frame = FrameToDraw { now: moment(&now), before: Some(moment(&before)) };
        Renderer::new(&picture, &Mesh::default()).unwrap().with_layers().draw(&frame).unwrap()
    });
    for (a, b) in sharp.layers.iter().zip(&seen.layers) {
        // As in the plane of focus at rest, of which half of the way of 3 cm is some 15 pixels.
        assert!((a.hair - b.hair).abs() < 2e-3, "{a:?} {b:?}");
        assert!((0..2).all(|c| (a.motion[c] - b.motion[c]).abs() < 15.0 * 2e-3), "{a:?} {b:?}");
    }
    assert!(sharp.layers.iter().map(|l| l.motion[0].abs()).fold(0.0, f32::max) > 0.1, "it moves");
}

#[test]
fn whatever_shows_through_a_lens_has_the_depth_of_what_is_there() {
    let seen = draw(&picture(Some(1.4)), &Mesh::default(), &upright(6.0));
    for (p, depth) in seen.rgba.iter().zip(&seen.depth) {
        assert_eq!(p[3] > 0.0, depth.is_finite(), "{p:?} {depth}");
        assert!(depth.is_infinite() || (depth - (DISTANCE - 6.0)).abs() < 1e-3, "{depth}");
    }
}

#[test]
fn any_number_of_threads_draws_the_same_through_a_lens_while_all_moves() {
    let picture = Picture { shutter: 0.5, ..picture(Some(2.0)) };
    let (before, now) = (wisps(300, 0.0), wisps(300, 7.0));
    let moment = |strands, pose| Moment { strands, pose, view: view(&picture), bodies: &[] };
    let turned = Pose { rotation: glam::Quat::from_rotation_y(0.1), ..Pose::STILL };
    let frame = FrameToDraw { now: moment(&now, turned), before: Some(moment(&before, Pose::STILL)) };
    let [one, two] = [1, 2].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| Renderer::new(&picture, &octahedron()).unwrap().with_layers().draw(&frame).unwrap())
    });
    assert_eq!(one, two);
    // Nothing is black that is there: the light of each pixel is that of its hair and skin.
    assert!(one.rgba.iter().all(|p| p[3] < 0.05 || p[0] > 0.0));
    let shown: f64 = one.layers.iter().map(|layer| f64::from(layer.hair + layer.head)).sum();
    // A full pixel is one of which a 64th may be left.
    assert!((shown / sum(&one)[3] - 1.0).abs() < 1.0 / 64.0);
}

#[test]
fn a_lens_left_to_itself_is_focused_on_the_near_side_of_the_head() {
    let mut auto = picture(Some(1.4));
    auto.camera.focus_distance = None;
    let mut given = auto.clone();
    given.camera.focus_distance = Some(DISTANCE - 3.5);
    let hair = wisps(100, 0.0);
    // The distance is the same but for rounding.
    assert!(apart(&draw(&auto, &octahedron(), &hair), &draw(&given, &octahedron(), &hair)) < 1e-3);
}

#[test]
fn lenses_that_cannot_be_are_refused_in_a_line() {
    let with = |change: &dyn Fn(&mut Picture)| {
        let mut picture = picture(Some(2.0));
        change(&mut picture);
        picture.check().unwrap_err().to_string()
    };
    for f_stop in [0.0, -2.0, 1e3, f32::NAN, f32::INFINITY] {
        assert!(with(&|p| p.camera.f_stop = Some(f_stop)).starts_with("picture.camera.f_stop = "));
    }
    for focus in [0.0, -5.0, 0.9, f32::NAN] {
        assert!(with(&|p| p.camera.focus_distance = Some(focus)).starts_with("picture.camera.focus_distance = "));
        let to = CameraKey { focus_distance: Some(focus), ..CameraKey::default() };
        assert!(with(&|p| p.camera.to = Some(to)).starts_with("picture.camera.to.focus_distance = "));
    }
    let to = CameraKey { focus_distance: Some(30.0), ..CameraKey::default() };
    let from_nowhere = with(&|p| p.camera = Camera { focus_distance: None, to: Some(to), ..p.camera });
    assert!(from_nowhere.contains("give picture.camera.focus_distance"), "{from_nowhere}");
    assert!(with(&|p| p.camera.projection = Projection::Orthographic).contains("perspective"));
    assert!(with(&|p| p.antialiasing = Antialiasing::Oversample).contains("coverage"));

    let mut within = picture(Some(2.0));
    within.camera = Camera { focus_distance: None, distance: Some(2.0), ..within.camera };
    let mut renderer = Renderer::new(&within, &octahedron()).unwrap();
    let error = renderer.draw(&FrameToDraw::at_rest(&upright(0.0), view(&within))).unwrap_err().to_string();
    assert!(error.contains("give a distance") && error.lines().count() == 1, "{error}");

    // A head blurred by 55 picture heights, whose light would take a picture a hundred times as wide.
    let mut lost = picture(Some(0.1));
    lost.camera.focus_distance = Some(1.0);
    let mut renderer = Renderer::new(&lost, &octahedron()).unwrap();
    let error = renderer.draw(&FrameToDraw::at_rest(&upright(0.0), view(&lost))).unwrap_err().to_string();
    assert!(error.starts_with("picture.camera.f_stop = 0.1: with focus at 1 cm"), "{error}");
    assert!(error.contains("set picture.camera.focus_distance") && error.lines().count() == 1, "{error}");
}
