use std::path::Path;

use nabiki_render::camera::NEAR;
use nabiki_render::settings::{Camera, Projection};

use super::*;
use crate::frames::Simulated;
use crate::{Scene, Shown};

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
            let head = &built.head;
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
    let mut drawn = |n: u32| film.draw(n, &built.hair.strands).unwrap().0;
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
        film.draw(n, &built.hair.strands).unwrap().0
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
        film.previous = Some(built.hair.strands.clone());
        film.draw(8, &built.hair.strands).unwrap().0
    };
    assert!(apart(&open(&body("")), &open(&staying)) > 30, "it rises by 0.9 cm");
}

#[test]
fn what_cannot_be_drawn_is_said_with_its_frame_and_where_it_comes_from() {
    let built = gust(&[]);
    let mut strands = built.hair.strands.clone();
    strands.points_mut()[3].x = 1e30;
    let refused = film(&built, Camera::default()).draw(5, &strands).err().unwrap().to_string();
    assert!(refused.contains("gust.toml: frame 5: strand 0, point 3 lies at "), "{refused}");
}
