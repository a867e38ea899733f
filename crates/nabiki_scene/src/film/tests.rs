use std::path::Path;

use nabiki_render::camera::NEAR;
use nabiki_render::output::png;
use nabiki_render::settings::{Camera, CameraKey, Projection};
use nabiki_render::{Canvas, ContactSheet, ForceArrow};

use super::*;
use crate::field_picture;
use crate::frames::Simulated;
use crate::place::Folders;
use crate::{Scene, Shown, Unwatched};

const FRAMES: u32 = 12;
const SIZE: [u32; 2] = [320, 180];

/// Few strands in the gust, after `changes`.
fn gust(changes: &[(&str, &str)]) -> BuiltScene {
    let scene = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/paper/gust.toml"));
    let few = [("hair.strands", "40"), ("motion.frames", "12"), ("output.sheet", "[0]"), ("picture.size", "[320,180]")];
    let changes: Vec<_> = few.iter().chain(changes).map(|&(key, value)| (key.to_owned(), value.to_owned())).collect();
    Scene::load(scene, &changes).unwrap().build(Shown::All).unwrap()
}

fn film<'a>(built: &'a BuiltScene, camera: Camera) -> Film<'a> {
    let picture = Picture { camera, size: SIZE, ..built.scene.picture.clone() };
    let mut rehearsal = Simulated::new(built).unwrap();
    Film::new(built, &picture, &mut rehearsal, &mut crate::Unwatched).unwrap()
}

/// Pixels between a point and each side of the picture less its margin: left, right, top, bottom.
fn spare(view: &View, margin: f32, p: Vec3) -> [f32; 4] {
    let p = view.project(p);
    assert!(p.z > NEAR, "it lies before the camera: {p}");
    [p.x, SIZE[0] as f32 - p.x, p.y, SIZE[1] as f32 - p.y].map(|spare| spare - margin)
}

fn least(spare: [f32; 4]) -> f32 {
    spare.into_iter().fold(f32::INFINITY, f32::min)
}

/// What the margin may at most be missed by: each face of the box touches a point, whose picture lies within that of
/// the face's corners. So towards each side a point comes as near as the face whose furthest corner is nearest.
fn guaranteed(view: &View, margin: f32, bounds: &Bounds) -> f32 {
    let corner = |bits: usize| {
        let pick = |axis: usize| if bits >> axis & 1 == 0 { bounds.low[axis] } else { bounds.high[axis] };
        spare(view, margin, Vec3::new(pick(0), pick(1), pick(2)))
    };
    let of_face = |axis: usize, end: usize| {
        let corners = (0..8).filter(|bits| bits >> axis & 1 == end).map(corner);
        least(corners.fold([f32::NEG_INFINITY; 4], |m, c| std::array::from_fn(|side| m[side].max(c[side]))))
    };
    (0..6).map(|face| of_face(face / 2, face % 2)).fold(f32::INFINITY, f32::min)
}

/// Rounding of sums of coordinates some hundred pixels large, in single precision.
const ROUNDING: f32 = 1e-2;

/// Every point of every frame is in the picture as `film` shows it; returns how near to the margin the nearest comes.
fn check(built: &BuiltScene, film: &Film) -> f32 {
    let margin = film.picture.camera.margin * SIZE[1] as f32;
    let mut frames = Simulated::new(built).unwrap();
    let mut nearest = f32::INFINITY;
    for n in 0..=FRAMES {
        let (view, turn) = (film.view(n), built.pose(n).rotation);
        for &p in frames.frame(n).unwrap().points() {
            let spare = least(spare(&view, margin, turn * p));
            assert!(spare > -ROUNDING, "frame {n}: {p} is {spare} pixels beyond the margin");
            nearest = nearest.min(spare);
        }
    }
    nearest
}

#[test]
fn automatic_framing_holds_every_point_of_every_frame_and_no_more_than_it_must() {
    let built = gust(&[]);
    for projection in [Projection::Perspective, Projection::Orthographic] {
        for (azimuth, elevation) in [(0.0, 0.0), (40.0, 5.0), (90.0, 0.0), (205.0, -20.0), (300.0, 60.0)] {
            let film = film(&built, Camera { projection, azimuth, elevation, ..Camera::default() });
            // The head is framed as well, and may be what comes nearest.
            let head = &built.model.head;
            let near_head = head.ellipsoid.scaled(1.5);
            let (view, margin) = (film.view(0), film.picture.camera.margin * SIZE[1] as f32);
            let of_head = head.mesh.positions.iter().filter(|&&p| near_head.value(p) <= 0.0);
            let of_head = of_head.map(|&p| least(spare(&view, margin, p))).fold(f32::INFINITY, f32::min);
            let nearest = check(&built, &film).min(of_head);
            let guaranteed = guaranteed(&view, margin, &film.bounds);
            eprintln!("{projection:?} {azimuth} {elevation}: {nearest:.2} px of {guaranteed:.2}");
            assert!(nearest <= guaranteed + ROUNDING, "{projection:?} {azimuth}: {nearest} pixels, {guaranteed}");
        }
    }
}

#[test]
fn a_head_that_turns_stays_framed() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("nod_and_turn.csv");
    let mut table = "t_s,px_cm,py_cm,pz_cm,qx,qy,qz,qw\n".to_owned();
    for n in 0..=FRAMES {
        let angle = n as f32 / FRAMES as f32;
        let turn = Quat::from_rotation_y(2.0 * angle) * Quat::from_rotation_z(angle);
        table += &format!("{},{n},0,0,{},{},{},{}\n", n as f32 / 24.0, turn.x, turn.y, turn.z, turn.w);
    }
    std::fs::write(&file, table).unwrap();
    let motion = format!("{{file=\"{}\",up=\"+y\",facing=\"+x\"}}", file.display());
    let built = gust(&[("head.motion", &motion)]);
    for projection in [Projection::Perspective, Projection::Orthographic] {
        check(&built, &film(&built, Camera { projection, azimuth: 40.0, ..Camera::default() }));
    }
}

#[test]
fn a_camera_goes_along_with_a_head_that_walks() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("walk.csv");
    let rows = (0..=FRAMES).map(|n| format!("{},{},{n},0,0,0,0,1\n", f64::from(n) / 24.0, 16 * n)).collect::<String>();
    std::fs::write(&file, "t_s,px_cm,py_cm,pz_cm,qx,qy,qz,qw\n".to_owned() + &rows).unwrap();
    let motion = format!("{{file=\"{}\",up=\"+y\",facing=\"+x\"}}", file.display());
    let built = gust(&[("head.motion", &motion)]);
    let mut film = film(&built, Camera { azimuth: 40.0, distance: Some(64.0), ..Camera::default() });
    // The same hair, which does not feel the head's way; of whole cm, which f32 keeps.
    let mut drawn = |n: u32| film.draw(n, built.strands()).unwrap().0;
    let (at_first, later) = (drawn(0), drawn(10));
    let apart =
        at_first.rgba.iter().zip(&later.rgba).filter(|(a, b)| (0..4).any(|c| (a[c] - b[c]).abs() > 0.02)).count();
    // What is all or nothing about a place turns out otherwise for one in ten thousand: on a picture of 57,600 pixels.
    assert!(apart < 60, "{apart} pixels differ");
}

#[test]
fn what_a_camera_leaves_open_is_chosen_for_all_frames() {
    let built = gust(&[]);
    let looked_at = Camera { target: Some(Vec3::new(-5.0, 0.0, 0.0)), ..Camera::default() };
    // A height means nothing in perspective, and a distance nothing for the size of an orthographic picture.
    check(&built, &film(&built, Camera { height: Some(30.0), ..looked_at }));
    let orthographic = Camera { projection: Projection::Orthographic, ..looked_at };
    check(&built, &film(&built, Camera { distance: Some(200.0), ..orthographic }));
}

#[test]
fn a_body_is_drawn_where_it_is_and_changes_no_pixel_when_it_is_not_shown() {
    let folder = tempfile::tempdir().unwrap();
    let mesh = folder.path().join("box.obj");
    let corners = (0..8).map(|i| format!("v {} {} {}\n", i & 1, i >> 1 & 1, i >> 2)).collect::<String>();
    let faces = "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
    std::fs::write(&mesh, corners + faces).unwrap();
    let track = folder.path().join("track.csv");
    let rows = (0..=FRAMES).map(|n| format!("{},25,{n},0,0,0,0,1\n", f64::from(n) / 24.0)).collect::<String>();
    std::fs::write(&track, "t_s,px_cm,py_cm,pz_cm,qx,qy,qz,qw\n".to_owned() + &rows).unwrap();
    let motion = format!("motion={{file=\"{}\",up=\"+y\",facing=\"+x\"}}", track.display());
    let body = |more: &str| format!("[{{mesh=\"{}\",unit=8,{motion}{more}}}]", mesh.display());
    let drawn = |bodies: &str, n: u32| {
        let built = gust(&[("motion.form", "\"free\""), ("body", bodies)]);
        let mut film = film(&built, Camera { azimuth: 0.0, distance: Some(90.0), ..Camera::default() });
        // The same hair, whatever the body does to it.
        film.draw(n, built.strands()).unwrap().0
    };
    let bare = drawn("[]", 8);
    assert!(drawn(&body(",shown=false"), 8) == bare);
    let (shown, later, blue) = (drawn(&body(""), 8), drawn(&body(""), 9), drawn(&body(",colour=[0,0,1]"), 8));
    let apart = |a: &Frame, b: &Frame| a.rgba.iter().zip(&b.rgba).filter(|(a, b)| a != b).count();
    // A face of 8 cm at a distance of some 60 on a picture of 180 rows.
    assert!(apart(&shown, &bare) > 300, "{}", apart(&shown, &bare));
    assert!(drawn(&body(",solid=false"), 8) == shown);
    assert!(apart(&shown, &later) > 30, "it rises");
    assert!(apart(&shown, &blue) > 300 && shown.depth == blue.depth);
    // While the shutter is open it goes on its way, and one that stays where it is in this frame does not.
    let stays = folder.path().join("stays.csv");
    let rows = (0..=FRAMES).map(|n| format!("{},25,8,0,0,0,0,1\n", f64::from(n) / 24.0)).collect::<String>();
    std::fs::write(&stays, "t_s,px_cm,py_cm,pz_cm,qx,qy,qz,qw\n".to_owned() + &rows).unwrap();
    let staying = body("").replace("track.csv", "stays.csv");
    assert!(drawn(&staying, 8) == shown);
    let open = |bodies: &str| {
        let built = gust(&[("motion.form", "\"free\""), ("body", bodies), ("picture.shutter", "0.9")]);
        let mut film = film(&built, Camera { azimuth: 0.0, distance: Some(90.0), ..Camera::default() });
        film.previous = Some(built.strands().clone());
        film.draw(8, built.strands()).unwrap().0
    };
    assert!(apart(&open(&body("")), &open(&staying)) > 30, "it rises by 0.9 cm");
}

#[test]
fn what_cannot_be_drawn_is_said_with_its_frame_and_where_it_comes_from() {
    let built = gust(&[]);
    let mut strands = built.strands().clone();
    strands.points_mut()[3].x = 1e30;
    let refused = film(&built, Camera::default()).draw(5, &strands).err().unwrap().to_string();
    assert!(refused.contains("gust.toml: frame 5: strand 0, point 3 lies at "), "{refused}");
}

/// The gust in head or world space about a head that walks along x by 16 cm a frame, and turns by a tenth of `axis`.
fn walking(folder: &Path, axis: Vec3, changes: &[(&str, &str)]) -> BuiltScene {
    let file = folder.join("walk_and_turn.csv");
    let row = |n: u32| {
        let turn = Quat::from_scaled_axis(0.1 * n as f32 * axis);
        format!("{},{},0,0,{},{},{},{}\n", f64::from(n) / 24.0, 16 * n, turn.x, turn.y, turn.z, turn.w)
    };
    let table = "t_s,px_cm,py_cm,pz_cm,qx,qy,qz,qw\n".to_owned() + &(0..=FRAMES).map(row).collect::<String>();
    std::fs::write(&file, table).unwrap();
    let motion = format!("{{file=\"{}\",up=\"+y\",facing=\"+x\"}}", file.display());
    gust(&[&[("head.motion", motion.as_str())], changes].concat())
}

/// Hair that stays as it is.
struct Still(Strands);

impl FrameSource for Still {
    fn frame(&mut self, _: u32) -> Result<&Strands> {
        Ok(&self.0)
    }
}

#[test]
fn a_camera_begins_at_its_first_key_and_arrives_at_its_second_in_the_last_frame() {
    let built = gust(&[]);
    let to = CameraKey { azimuth: Some(100.0), elevation: Some(30.0), ..CameraKey::default() };
    let camera = Camera { azimuth: 10.0, to: Some(to), ..Camera::default() };
    let film = film(&built, camera);
    let view = |azimuth, elevation| View::new(&Camera { azimuth, elevation, ..camera }, SIZE, &film.bounds);
    assert_eq!(film.view(0), view(10.0, camera.elevation));
    assert_eq!(film.view(FRAMES), view(100.0, 30.0));
}

#[test]
fn a_frame_drawn_alone_is_that_of_the_film_while_the_shutter_is_open() {
    let built = gust(&[("picture.shutter", "0.8")]);
    let camera = built.scene.picture.camera;
    let mut whole = film(&built, camera);
    let mut frames = Simulated::new(&built).unwrap();
    let drawn: Vec<Frame> = (0..=6).map(|n| whole.draw(n, frames.frame(n).unwrap()).unwrap().0).collect();
    for n in [0, 1, 6] {
        let alone = film(&built, camera).still(n, &mut Simulated::new(&built).unwrap()).unwrap();
        assert!(alone == drawn[n as usize], "frame {n}");
    }
    assert!(crate::tasks::draw(&built, 6, false, &mut Unwatched).unwrap() == drawn[6]);
    let sharp = gust(&[]);
    assert!(film(&sharp, camera).still(6, &mut Simulated::new(&sharp).unwrap()).unwrap() != drawn[6]);
}

#[test]
fn hair_that_turns_with_its_head_is_blurred() {
    let folder = tempfile::tempdir().unwrap();
    let drawn = |shutter: &str| {
        let built = walking(folder.path(), Vec3::Y, &[("picture.shutter", shutter)]);
        let mut film = film(&built, Camera { distance: Some(80.0), ..Camera::default() });
        film.previous = Some(built.strands().clone());
        film.draw(5, built.strands()).unwrap().0
    };
    let (sharp, open) = (drawn("0"), drawn("0.9"));
    let apart = sharp.rgba.iter().zip(&open.rgba).filter(|(a, b)| (0..3).any(|c| (a[c] - b[c]).abs() > 0.02)).count();
    // Edges of a head of some 90 pixels that move by up to 3.
    assert!(apart > 300, "{apart}");
}

#[test]
fn a_turntable_goes_along_with_its_head_and_holds_all_of_it() {
    let folder = tempfile::tempdir().unwrap();
    let changes = [
        ("picture.camera", "{azimuth=50}"),
        ("picture.background", "{transparent=true}"),
        ("picture.size", "[120,240]"),
        // The bust goes on below what is framed.
        ("picture.head.visible", "false"),
        ("picture.hair.width", "0.3"),
    ];
    let turned = |built: &BuiltScene, n: u32| {
        let mut pictures = Vec::new();
        let mut frames = Still(built.strands().clone());
        let push = |_, frame: &Frame| {
            pictures.push(frame.clone());
            Ok(())
        };
        Film::turntable(built, (n, 3), &mut frames, push, &mut Unwatched).unwrap();
        pictures
    };
    // A head on its side: long hair lies across the picture, which is higher than wide, and never touches its edge.
    let built = walking(folder.path(), Vec3::X * 1.5, &changes);
    for frame in turned(&built, 10) {
        let edge = |i: usize| !(1..119).contains(&(i % 120)) || !(1..239).contains(&(i / 120));
        assert!(frame.rgba.iter().enumerate().all(|(i, p)| p[3] == 0.0 || !edge(i)));
        assert!(frame.rgba.iter().any(|p| p[3] > 0.5));
    }
    // One that only walks is seen in every frame as where it began; of whole cm, which f32 keeps.
    let built = walking(folder.path(), Vec3::ZERO, &changes);
    for (first, later) in turned(&built, 0).iter().zip(turned(&built, 10)) {
        let apart = first.rgba.iter().zip(&later.rgba).filter(|(a, b)| (0..4).any(|c| (a[c] - b[c]).abs() > 0.02));
        // As for a camera that goes along with a head that walks.
        assert!(apart.count() < 60);
    }
}

#[test]
fn a_picture_of_a_turntable_is_that_of_a_camera_so_far_round() {
    let folder = tempfile::tempdir().unwrap();
    let on_its_way = "{azimuth=50,target=[0,0,0],distance=90,to={azimuth=80,elevation=20}}";
    let changes = [("picture.camera", on_its_way), ("picture.exposure", "1.5"), ("picture.shutter", "0.8")];
    let built = walking(folder.path(), Vec3::Y, &changes);
    let n = 5;
    let there = built.scene.picture.camera.at(n as f32 / FRAMES as f32);
    assert!(there.azimuth > 55.0 && there.elevation > 7.0);
    let mut frames = Still(built.strands().clone());
    let push = |k: u32, frame: &Frame| {
        let camera = Camera { azimuth: there.azimuth + 90.0 * k as f32, ..there };
        // The first that a film draws is not blurred.
        let (wanted, _) = film(&built, camera).draw(n, built.strands()).unwrap();
        let apart = frame.rgba.iter().zip(&wanted.rgba).filter(|(a, b)| (0..4).any(|c| (a[c] - b[c]).abs() > 0.02));
        // A place rounded across the edge of a cell.
        let apart = apart.count();
        assert!(apart < 60, "{k}: {apart}");
        Ok(())
    };
    Film::turntable(&built, (n, 4), &mut frames, push, &mut Unwatched).unwrap();
}

#[test]
fn forces_are_shown_where_they_push_in_the_space_that_they_are_given_in() {
    let folder = tempfile::tempdir().unwrap();
    for space in ["\"world\"", "\"head\""] {
        let built = walking(folder.path(), Vec3::new(0.6, 0.8, 0.0), &[("motion.force_space", space)]);
        let mut film = film(&built, Camera::default());
        let n = 7;
        let (_, view) = film.draw(n, built.strands()).unwrap();
        let pose = built.pose(n);
        for p in [Vec3::ZERO, Vec3::new(10.0, 4.0, -3.0), Vec3::new(-5.0, 9.0, 8.0)] {
            let in_world = pose.world_from_head().transform_point3(p);
            let wanted = film.view_in_world(n).project(in_world);
            let given = if space.contains("head") { p } else { in_world };
            assert!(view.project(given).distance(wanted) < ROUNDING, "{space}: {} {wanted}", view.project(given));
        }
    }
}

#[test]
fn a_contact_sheet_shows_the_forces_of_each_of_its_frames() {
    let force = "[{through=5,vector=[0,40,0]},{through=12,vector=[0,0,-30]}]";
    let point = "[{position=[20,5,5],strength=40,envelope=[{frame=1,factor=1},{frame=12,factor=-1}]}]";
    for (key, field) in [("force", force), ("point", point)] {
        let folder = tempfile::tempdir().unwrap();
        let built = gust(&[(key, field), ("output.sheet", "[0,5,6]"), ("output.movie", "false")]);
        let picture = &built.scene.picture;
        let mut film = film(&built, Camera::default());
        let mut outputs =
            PictureOutputs::begin(&built, picture, folder.path(), "gust", &[], &mut Folders::default(), &mut Unwatched)
                .unwrap();
        let (mut wanted, tone_mapping) = (ContactSheet::new(2), ToneMapping::new(picture));
        for n in 0..=FRAMES {
            let (frame, view) = film.draw(n, built.strands()).unwrap();
            outputs.push(n, &frame, &view).unwrap();
            match n {
                // Before the first step there is that which is to come.
                0 | 5 | 6 if key == "force" => {
                    let force = if n <= 5 { Vec3::Y * 40.0 } else { Vec3::Z * -30.0 };
                    wanted.add(&frame, &tone_mapping, n, Some(force), &view);
                }
                0 | 5 | 6 => {
                    let arrows = field_picture::arrows(&built, n.max(1), &view);
                    wanted.add_arrows(&frame, &tone_mapping, n, &arrows, &view);
                }
                _ => {}
            }
        }
        let written = outputs.finish(&mut Unwatched).unwrap();
        let read = png::read(&written[0]).unwrap();
        let wanted: Canvas = wanted.canvas();
        let rgb: Vec<u8> = read.rgb.iter().flatten().map(|value| (value / 257) as u8).collect();
        assert!(rgb == wanted.rgb(), "{key}: {:?}", written[0]);
    }
}

#[test]
fn a_field_that_differs_from_place_to_place_is_shown_about_the_head_of_each_frame() {
    let folder = tempfile::tempdir().unwrap();
    let point = "[{position=[170,20,5],strength=40}]";
    let built = walking(folder.path(), Vec3::new(0.6, 0.8, 0.0), &[("point", point)]);
    let film = film(&built, Camera::default());
    for n in [3, 10] {
        let arrows = field_picture::arrows(&built, n, &film.view_in_world(n));
        let middle = arrows.iter().map(|arrow| arrow.point).sum::<Vec3>() / arrows.len() as f32;
        let world_from_head = built.pose(n).world_from_head();
        let centre = world_from_head.transform_point3(built.model.head.ellipsoid.center);
        // On both sides of the head alike; of some 20 points 200 cm from the origin, rounded.
        assert!(arrows.len() > 10 && middle.distance(centre) < 1e-3, "frame {n}: {middle}, not {centre}");
        let in_head = |arrow: &ForceArrow| world_from_head.inverse().transform_point3(arrow.point);
        assert!(
            arrows.iter().all(|arrow| built.model.head.ellipsoid.value(in_head(arrow)) > -1e-4),
            "frame {n}: within"
        );
    }
    let slices = field_picture::plot(&built).slices.unwrap();
    let pose = built.pose(slices.frame);
    for [place, force] in slices.yz.iter().chain(&slices.zx) {
        let there = pose.world_from_head().transform_point3(built.model.head.ellipsoid.center + *place);
        let in_world = built.force_at(there, slices.frame);
        assert!((pose.rotation * *force).distance(in_world) < 1e-4 * in_world.length().max(1.0), "{place}: {force}");
    }
}
