//! What is told of a motion, against hair whose answer is known.

use std::path::Path;

use glam::{Quat, Vec3};
use nabiki::Strands;
use nabiki::dynamics::{gain, period};
use nabiki_scene::motion_summary::{FrameSummary, MotionSummary};
use nabiki_scene::told::{Swing, SwingTable};
use nabiki_scene::{BuiltScene, Scene, Shown};

/// The built-in head and, far to its side, a cube of 8 cm that moves along +x by 1 cm a frame and turns.
fn beside_a_cube(folder: &Path) -> BuiltScene {
    let corners =
        (0..8).map(|i| format!("v {} {} {}\n", 8 * (i & 1), 8 * (i >> 1 & 1), 8 * (i >> 2))).collect::<String>();
    let faces = "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
    std::fs::write(folder.join("cube.obj"), corners + faces).unwrap();
    let row = |n: u32| {
        let turn = Quat::from_rotation_y(0.1 * n as f32);
        format!("{},{n},0,60,{},{},{},{}\n", f64::from(n) / 24.0, turn.x, turn.y, turn.z, turn.w)
    };
    let track = "t_s,px_cm,py_cm,pz_cm,qx,qy,qz,qw\n".to_owned() + &(0..=10).map(row).collect::<String>();
    std::fs::write(folder.join("track.csv"), track).unwrap();
    let text = "[hair]\nstrands = 20\n[motion]\nform = \"free\"\nframes = 10\n[[body]]\nmesh = \"cube.obj\"\nunit = \"cm\"\n\
                motion = { file = \"track.csv\", up = \"+y\", facing = \"+x\" }\n[[force]]\nthrough = 10\nvector = [0, 0, 0]\n";
    Scene::parse(text, &folder.join("scene.toml"), &[]).unwrap().build(Shown::All).unwrap()
}

#[test]
fn a_summary_counts_what_is_in_a_body_where_that_is_in_its_frame() {
    let folder = tempfile::tempdir().unwrap();
    let built = beside_a_cube(folder.path());
    let frame = 6;
    let turn = Quat::from_rotation_y(0.6);
    let in_head = |p: Vec3| turn * p + Vec3::new(6.0, 0.0, 60.0);
    // Along a line through the cube's own space, level with its middle: 1 cm in, 2 cm in, and out again on the far side. The root is
    // in it, and does not count.
    let mut strands = Strands::default();
    strands.push([4.0, 1.0, -3.0, -9.0].map(|x| in_head(Vec3::new(x, 4.0, 4.0))));
    strands.push([-9.0, -4.0, 2.0, 9.0].map(|x| in_head(Vec3::new(x, 4.0, 4.0))));
    let summary = FrameSummary::of(&built, frame, &strands, [&[], &[]]);
    assert_eq!(summary.inside, 2.0 / 6.0);
    // Sampled in steps of a part of a cm; within flat sides that is exact but for rounding.
    assert!((summary.depth - 2.0).abs() < 0.02, "{} cm", summary.depth);
    // In another frame the cube is elsewhere, and no hair of a head stands still 60 cm to its side.
    assert_ne!(FrameSummary::of(&built, 0, &strands, [&[], &[]]).depth, summary.depth);
}

#[test]
fn a_body_is_drawn_where_its_track_has_it_in_each_frame() {
    let folder = tempfile::tempdir().unwrap();
    let built = beside_a_cube(folder.path());
    for frame in 0..=built.frames() {
        let [pose] = built.drawn_poses(frame)[..] else { panic!("one body") };
        // Tracks are read in doubles and kept in f32.
        assert!(pose.position_cm.distance(Vec3::new(frame as f32, 0.0, 60.0)) < 1e-5, "frame {frame}: {pose:?}");
        assert!(
            pose.rotation.angle_between(Quat::from_rotation_y(0.1 * frame as f32)) < 1e-3,
            "frame {frame}: {pose:?}"
        );
    }
}

#[test]
fn each_frame_jumps_from_the_one_before_it() {
    let folder = tempfile::tempdir().unwrap();
    let built = beside_a_cube(folder.path());
    let mut summary = MotionSummary::default();
    let mut hair = built.strands().clone();
    // One point goes 0.5, 2 and 1 cm.
    let mut x = 0.0;
    for (frame, by) in [(0, 0.0), (1, 0.5), (2, 2.0), (3, 1.0)] {
        x += by;
        let mut moved = hair.clone();
        moved.strand_mut(3)[2] = built.strands().strand(3)[2] + Vec3::X * x;
        hair = moved;
        summary.add(&built, frame, &hair);
        assert!((summary.last.jump - by).abs() < 1e-5, "frame {frame}: {} cm", summary.last.jump);
    }
    assert_eq!((summary.farthest_jump.frame, summary.last.frame), (2, 3));
}

/// The table gives what c_i and F do: of the first, the middle and the last of k segments, and the tip, which c_i moves most, is the fastest.
#[test]
fn a_swing_is_slowest_at_the_root_and_fastest_at_the_tip() {
    let text = "[hair]\nstrands = 20\n[motion]\nframes = 100\n[[force]]\nthrough = 50\nvector = [-30, 0, 40]\n";
    let built = Scene::parse(text, Path::new("scene.toml"), &[]).unwrap().build(Shown::All).unwrap();
    let table = SwingTable::of(&built);
    let Swing::Segments([root, middle, tip]) = table.rows[0].swing else { panic!("of the paper's form") };
    assert!(root > middle && middle > tip, "{root} {middle} {tip}");
    let k = f64::from(table.length) / f64::from(built.dynamics.segment_length);
    assert!((tip - period(50.0 * gain(&built.dynamics, k, k))).abs() < 1e-6 * tip, "{tip} frames");
    assert_eq!((table.rows[0].frames, table.rows[0].force), ([1, 50], 50.0));
}

#[test]
fn the_bound_of_all_fields_is_told_only_if_it_exceeds_every_force() {
    let table = |fields: &str| {
        let text = format!(
            "[hair]\nstrands = 20\n[motion]\nform = \"free\"\nframes = 100\n[[force]]\nthrough = 50\nvector = [-30, 0, 40]\n\
             [[force]]\nthrough = 100\nvector = [0, 0, 0]\n{fields}"
        );
        SwingTable::of(&Scene::parse(&text, Path::new("scene.toml"), &[]).unwrap().build(Shown::All).unwrap())
    };
    let eased = table("[wind]\nease = \"smooth\"\n");
    assert!(eased.at_most.is_none() && !eased.to_string().contains("at most"), "{eased}");
    let gusty = table("[gust]\nintensity = 0.3\n");
    assert!(gusty.at_most.is_some_and(|row| row.force > 50.0) && gusty.to_string().contains("|F| at most "), "{gusty}");
}

#[test]
fn a_head_that_leaps_is_said_and_one_that_falls_or_spins_evenly_is_not() {
    let folder = tempfile::tempdir().unwrap();
    let told = |place: &dyn Fn(f32) -> Vec3, turn: &dyn Fn(f32) -> f32| -> Vec<String> {
        let row = |n: u32| {
            let (at, turn) = (place(n as f32), Quat::from_rotation_y(turn(n as f32)));
            format!("{},{},{},{},{},{},{},{}\n", f64::from(n) / 24.0, at.x, at.y, at.z, turn.x, turn.y, turn.z, turn.w)
        };
        let track = "t_s,px_cm,py_cm,pz_cm,qx,qy,qz,qw\n".to_owned() + &(0..=10).map(row).collect::<String>();
        std::fs::write(folder.path().join("track.csv"), track).unwrap();
        let text = "[head]\nmotion = { file = \"track.csv\", up = \"+y\", facing = \"+x\" }\n[hair]\nstrands = 5\n\
                    [motion]\nform = \"free\"\nframes = 10\n[[force]]\nthrough = 10\nvector = [0, 0, 0]\n";
        let built = Scene::parse(text, &folder.path().join("scene.toml"), &[]).unwrap().build(Shown::All).unwrap();
        let advice = built.advice().into_iter().map(|advice| advice.to_string());
        advice.filter(|line| line.contains("the hair feels it")).collect()
    };
    // A train's speed and a free fall; 57 degrees a frame.
    let falls = |n: f32| Vec3::new(200.0 * n, -490.0 * (n / 24.0).powi(2), 0.0);
    let spins = |n: f32| n;
    assert_eq!(told(&falls, &spins), [""; 0]);
    let leaps = |n: f32| falls(n) + if n < 6.5 { Vec3::ZERO } else { Vec3::new(0.0, 0.0, 1000.0) };
    let said = told(&leaps, &|_| 0.0);
    assert!(said.len() == 1 && said[0].contains(" and turns 0 degrees from frame 6 to frame 7,"), "{said:?}");
    let turned = told(&falls, &|n| if n < 3.5 { 0.0 } else { 2.0 });
    assert!(turned.len() == 1 && turned[0].contains("turns 115 degrees from frame 3 to frame 4,"), "{turned:?}");
}
