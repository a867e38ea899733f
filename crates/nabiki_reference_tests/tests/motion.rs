//! Recorded heads, against tables of poses and rates that other programs made of the same files.

use std::path::{Path, PathBuf};

use glam::Vec3;
use nabiki_io::motion::{Axis, HeadMotion, MotionSource, read, track};

fn shared(name: &str) -> PathBuf {
    nabiki_reference_tests::shared(&format!("motion/{name}"))
}

/// A source whose world is already the scene's.
fn straight(file: PathBuf, unit_cm: Option<f64>) -> MotionSource {
    MotionSource { file, unit_cm, up: Some(Axis::PlusY), facing: Some(Axis::PlusX), ..MotionSource::default() }
}

/// Largest turn between neighbouring frames (degrees a second).
fn fastest_turn(motion: &HeadMotion) -> f64 {
    let turns = motion.poses.windows(2).map(|w| f64::from(w[0].rotation.angle_between(w[1].rotation)));
    turns.fold(0.0, f64::max).to_degrees() * motion.frame_rate
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs the shared reference data beside the project")]
fn the_head_of_a_bvh_is_where_its_table_of_poses_has_it() {
    let (bvh, csv) = (shared("cmu_12_01_walk.bvh"), shared("head_tracks/cmu_12_01_walk.csv"));
    // The skeleton's inch is 0.45 units; the table leaves out the T-pose of frame 0.
    let joint = MotionSource { skip: 1, ..straight(bvh, Some(2.54 / 0.45)) };
    let (joint, table) = (read(&joint, 120.0).unwrap(), read(&straight(csv, None), 120.0).unwrap());
    assert_eq!(table.poses.len(), 523);
    assert_eq!(joint.poses.len(), 523);
    for (a, b) in joint.poses.iter().zip(&table.poses) {
        // Rounding: position 5e-5 cm, time 1e-6 s at 160 cm/s, quaternion components 5e-8, f32 near 200 cm 8e-6 cm.
        assert!(a.position_cm.distance(b.position_cm) < 3e-4, "{a:?} {b:?}");
        assert!(1.0 - a.rotation.dot(b.rotation).abs() < 4.0 * f32::EPSILON, "{a:?} {b:?}");
    }
}

/// A motion that moves a skeleton of another file, in the shared data.
fn recorded(file: &str, skeleton: &str, node: &str) -> MotionSource {
    let (file, skeleton) = (shared(file), shared(skeleton));
    let rate = file.extension().is_some_and(|ending| ending == "amc");
    MotionSource {
        skeleton: Some(skeleton),
        node: node.to_owned(),
        frames_per_second: rate.then_some(120.0),
        ..straight(file, None)
    }
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs the shared reference data beside the project")]
fn recorded_heads_are_where_their_tables_of_poses_have_them() {
    // The tables were computed from these very files by another program. Its unit is the metre, as is Jolt's.
    for (file, skeleton, node, table, rows, metres) in [
        ("cmu_02_03_run.amc", "cmu_02.asf", "head", "cmu_02_03_run", 173, 0.0254 / 0.45),
        ("jolt_walk.tof", "jolt_human.tof", "C_Head_sjnt_0", "jolt_walk", 85, 1.0),
        ("jolt_sprint.tof", "jolt_human.tof", "c_head_SJNT_0", "jolt_sprint", 49, 1.0),
    ] {
        let source = recorded(file, skeleton, node);
        let table = shared(&format!("head_tracks/{table}.csv"));
        let text = |path: &Path| std::fs::read_to_string(path).unwrap();
        let found = track(&source, &text(&source.file), source.skeleton.as_deref().map(text).as_deref()).unwrap();
        let table = track(&straight(table.clone(), None), &text(&table), None).unwrap();
        assert_eq!((found.samples.len(), table.samples.len()), (rows, rows), "{file}");
        assert!(found.unit_cm.is_none_or(|cm| (cm / 100.0 - metres).abs() < 1e-15), "{file}: {:?}", found.unit_cm);
        for (i, (a, b)) in found.samples.iter().zip(&table.samples).enumerate() {
            // Printed with 6 digits behind the point; the rest is for rounding in f64.
            let off = (a.position * metres - b.position).abs().max_element();
            assert!(off < 0.5e-6 + 1e-12, "{file}, row {i}: {off} m");
            assert!((found.times[i] - table.times[i]).abs() < 0.5e-6 + 1e-12, "{file}, row {i}");
            // Printed with 7 digits, 5e-8 for each component; made of length 1 again, at most their sum, 1e-7, more.
            let same_sign = if a.rotation.dot(b.rotation) < 0.0 { -b.rotation } else { b.rotation };
            let off = (a.rotation - same_sign).to_array().into_iter().fold(0.0, |most: f64, x| most.max(x.abs()));
            assert!(off < 1.5e-7, "{file}, row {i}: {off}");
        }
    }
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs the shared reference data beside the project")]
fn recorded_heads_run_upright_and_face_the_way_they_go() {
    for (file, skeleton, node, unit) in [
        ("cmu_02_03_run.amc", "cmu_02.asf", "head", None),
        ("jolt_walk.tof", "jolt_human.tof", "C_Head_sjnt_0", Some(100.0)),
        ("jolt_sprint.tof", "jolt_human.tof", "C_Head_sjnt_0", Some(100.0)),
    ] {
        let source = recorded(file, skeleton, node);
        let source = MotionSource { unit_cm: unit, facing: Some(Axis::PlusZ), start_at_origin: true, ..source };
        let motion = read(&source, 24.0).unwrap();
        let of = format!(" of {}", source.skeleton.unwrap().display());
        assert!(motion.report.contains(&of) && motion.report.contains("24 Hz"), "{}", motion.report);
        let way = motion.poses[motion.poses.len() - 1].position_cm.normalize();
        for (n, pose) in motion.poses.iter().enumerate() {
            // Runners bend and turn their heads, but by less than half of the quarter turn that a wrong axis would give.
            let (up, ahead) = ((pose.rotation * Vec3::Y).y, (pose.rotation * Vec3::X).dot(way));
            assert!(up.min(ahead) > std::f32::consts::FRAC_1_SQRT_2, "{file}, {n}: {pose:?}");
        }
    }
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs the shared reference data beside the project")]
fn every_table_of_poses_converts_to_24_frames_and_says_so() {
    for (name, samples, frames) in
        [("cmu_12_01_walk", 523, 105), ("cmu_02_03_run", 173, 35), ("jolt_walk", 85, 68), ("jolt_sprint", 49, 39)]
    {
        let path = shared(&format!("head_tracks/{name}.csv"));
        let motion = read(&straight(path, None), 24.0).unwrap();
        assert_eq!(motion.poses.len(), frames, "{name}");
        assert!(motion.report.contains(&format!("{samples} samples")), "{}", motion.report);
        assert!(motion.report.contains(&format!("{frames} frames at 24 Hz")), "{}", motion.report);
    }
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs the shared reference data beside the project")]
fn a_z_up_file_stands_upright_and_faces_x() {
    let path = shared("makehuman_walk1.bvh");
    let source =
        MotionSource { unit_cm: Some(10.0), up: Some(Axis::PlusZ), facing: Some(Axis::MinusY), ..straight(path, None) };
    let motion = read(&source, 24.0).unwrap();
    assert_eq!(motion.poses.len(), 14);
    let foot = |node: &str| read(&MotionSource { node: node.to_owned(), ..source.clone() }, 24.0).unwrap();
    let feet = [foot("Foot_L"), foot("Foot_R")];
    for (i, pose) in motion.poses.iter().enumerate() {
        // An adult's head base lies 1.4 to 1.8 m above the feet, and walking turns it little.
        let lower = feet.iter().map(|foot| foot.poses[i].position_cm.y).fold(f32::INFINITY, f32::min);
        assert!((120.0..190.0).contains(&(pose.position_cm.y - lower)), "{pose:?}, foot at {lower}");
        assert!((pose.rotation * Vec3::Y).y > 0.9 && (pose.rotation * Vec3::X).x > 0.9, "{pose:?}");
    }
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs the shared reference data beside the project")]
fn clips_turn_the_head_as_fast_as_is_known_of_them() {
    let path = shared("kaykit_rogue.glb");
    // Largest turn rates of the node "head", measured from the same file with another program (degrees a second).
    for (clip, known) in [("2H_Melee_Attack_Spin", 912.0), ("Jump_Full_Short", 310.0), ("Running_A", 31.0)] {
        let source =
            MotionSource { file: path.clone(), node: "head".into(), clip: clip.into(), ..MotionSource::default() };
        let found = fastest_turn(&read(&source, 30.0).unwrap());
        // The rate of the known figures is not: one frame's turn is averaged over a longer or shorter time.
        assert!((found / known - 1.0).abs() < 0.1, "{clip}: {found} deg/s, known {known}");
    }
    let fox = shared("fox.glb");
    let source = MotionSource { file: fox, node: "b_Head_05".into(), clip: "Run".into(), ..MotionSource::default() };
    let error = read(&MotionSource { clip: String::new(), ..source.clone() }, 24.0).unwrap_err().to_string();
    assert!(error.contains("Survey, Walk, Run"), "{error}");
    assert_eq!(read(&source, 24.0).unwrap().poses.len(), 28, "1.158 s and its first frame");
}
