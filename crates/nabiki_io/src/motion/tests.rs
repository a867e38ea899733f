use std::f64::consts::{FRAC_PI_2, TAU};
use std::fs;
use std::path::PathBuf;

use glam::{DQuat, DVec3, Quat, Vec3};
use nabiki::Pose;
use proptest::prelude::*;

use super::acclaim::tests::{AMC, ASF};
use super::tof::tests::{TOF, TOF_SKELETON};
use super::*;

/// A source whose world is already the scene's.
fn straight(file: PathBuf, unit_cm: Option<f64>) -> MotionSource {
    MotionSource { file, unit_cm, up: Some(Axis::PlusY), facing: Some(Axis::PlusX), ..MotionSource::default() }
}

fn written(name: &str, bytes: &[u8]) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    fs::write(&path, bytes).unwrap();
    (folder, path)
}

fn bvh(channels: &str, row: &str) -> String {
    format!(
        "HIERARCHY\nROOT Hips\n{{\nOFFSET 0 10 0\nCHANNELS 6 Zposition Xposition Yposition Xrotation Yrotation \
         Zrotation\nJOINT Head\n{{\nOFFSET 0 5 0\nCHANNELS 3 {channels}\nEnd Site\n{{\nOFFSET 0 1 0\n}}\n}}\n}}\n\
         MOTION\nFrames: 1\nFrame Time: 0.04\n{row}\n"
    )
}

#[test]
fn channels_count_in_the_order_in_which_they_stand() {
    for (channels, first, second) in
        [("Zrotation Xrotation Yrotation", DVec3::Z, DVec3::X), ("Xrotation Zrotation Yrotation", DVec3::X, DVec3::Z)]
    {
        let track = bvh::track(&bvh(channels, "3 1 2 0 0 90 90 90 0"), "head").unwrap();
        let hips = DQuat::from_rotation_z(FRAC_PI_2);
        let head = DQuat::from_axis_angle(first, FRAC_PI_2) * DQuat::from_axis_angle(second, FRAC_PI_2);
        let sample = track.samples[0];
        assert!((sample.position - (DVec3::new(1.0, 2.0, 3.0) + hips * DVec3::new(0.0, 5.0, 0.0))).length() < 1e-12);
        assert!((sample.rotation.dot(hips * head).abs() - 1.0).abs() < 1e-12, "{channels}: {sample:?}");
    }
}

#[test]
fn words_count_in_any_capitals_and_with_any_spaces_and_line_ends() {
    let text = bvh("Zrotation Xrotation Yrotation", "3 1 2 0 0 90 10 20 30");
    let plain = bvh::track(&text, "Head").unwrap();
    let words = ["HIERARCHY", "ROOT", "OFFSET", "CHANNELS", "JOINT", "End Site", "MOTION", "Frames:", "Frame Time:"];
    let with =
        |change: fn(&str) -> String| words.iter().fold(text.clone(), |text, word| text.replace(word, &change(word)));
    let title = |word: &str| word[..1].to_uppercase() + &word[1..].to_lowercase();
    for other in [
        with(|word| word.to_lowercase()),
        with(|word| word.to_uppercase()),
        with(title),
        text.replace("rotation", "ROTATION").replace("position", "Position"),
        text.replace('\n', "\r\n"),
        text.replace(' ', "\t").replace('\n', "\t\r\n\t"),
    ] {
        assert_eq!(bvh::track(&other, "Head").unwrap(), plain, "{other}");
    }
}

#[test]
fn the_frames_that_are_there_count_and_not_those_that_are_declared() {
    let row = "3 1 2 0 0 90 10 20 30";
    let text = |declared: usize, rows: usize| {
        let text = bvh("Zrotation Xrotation Yrotation", &vec![row; rows].join("\n"));
        text.replace("Frames: 1", &format!("Frames: {declared}"))
    };
    for (declared, rows) in [(3, 3), (5, 3), (2, 3), (1, 2)] {
        let (_folder, path) = written("walk.bvh", text(declared, rows).as_bytes());
        let found = read(&straight(path.clone(), Some(1.0)), 25.0).unwrap();
        assert_eq!(found.poses.len(), rows, "{declared} declared");
        let said = format!("{rows} frames, although {declared} are declared");
        assert_eq!(found.report.contains(&said), declared != rows, "{}", found.report);
        let info = survey(&path).unwrap();
        assert_eq!((info.samples, info.unlike), (rows, (declared != rows).then_some(said)));
    }
    let refused = |text: String| bvh::track(&text, "Head").unwrap_err().to_string();
    assert!(refused(text(4, 3) + "1 2 3\n").contains("frame 3 of 4, Hips.Xrotation: ends before a number"));
    assert_eq!(refused(text(3, 0)), "declares 3 frames but has none: is it complete?");
    assert!(refused(text(1, 1) + "and more\n").contains("frame 1 of 1, Hips.Zposition: \"and\": its value must be"));
}

#[test]
fn a_joints_name_is_the_rest_of_its_line() {
    let text = bvh("Zrotation Xrotation Yrotation", "3 1 2 0 0 90 0 0 0");
    let plain = bvh::track(&text, "Head").unwrap().samples;
    for (joint, name) in
        [("Head Top \n{", "Head Top"), ("Head\t1 {", "Head\t1"), ("Head{", "Head"), ("\nHead\r\n{", "Head")]
    {
        let text = text.replace("Head\n{", joint);
        assert_eq!(bvh::track(&text, name).unwrap().samples, plain, "{joint:?}");
    }
    let refused = bvh::track(&text.replace("JOINT Head", "JOINT"), "Head").unwrap_err();
    assert_eq!((refused.line, &*refused.what), (Some(7), "\"{\": a joint's name expected here"));
}

#[test]
fn position_channels_replace_the_offset_of_any_joint() {
    let text = bvh("Yposition Zrotation Xrotation", "3 1 2 0 0 90 7 0 0");
    let text = text.replace("OFFSET 0 5 0", "OFFSET 4 5 6");
    let sample = bvh::track(&text, "Head").unwrap().samples[0];
    // The hips' OFFSET of 10 along y is gone; of the head's, y is 7, x and z have no channel and stay.
    let expected = DVec3::new(1.0, 2.0, 3.0) + DQuat::from_rotation_z(FRAC_PI_2) * DVec3::new(4.0, 7.0, 6.0);
    assert!(sample.position.distance(expected) < 1e-12, "{sample:?}");
    let hips = bvh::track(&text, "Hips").unwrap().samples[0];
    assert_eq!(hips.position, DVec3::new(1.0, 2.0, 3.0));
}

#[test]
fn joints_of_one_name_are_told_apart_or_refused() {
    let twins = bvh("Zrotation Xrotation Yrotation", "0 0 0 0 0 0 0 0 0").replace("ROOT Hips", "ROOT Head");
    let error = bvh::track(&twins, "Head").unwrap_err().to_string();
    assert_eq!(error, "joint \"Head\": 2 have that name; give node as a path: one of /Head, /Head/Head");
    assert_eq!(bvh::track(&twins, "Head/Head").unwrap().samples[0].position, DVec3::new(0.0, 5.0, 0.0));
    assert_eq!(bvh::track(&twins, "/Head").unwrap().samples[0].position, DVec3::ZERO);

    // In a .tof names are all there is: of the parent of each joint, and of the joint that keys move.
    let skeleton = TOF_SKELETON.replace("\"Head\"", "\"The \\\"Neck\\\"\"");
    assert_ne!(skeleton, TOF_SKELETON);
    let source = MotionSource { skeleton: Some("b.tof".into()), ..straight("a.tof".into(), Some(1.0)) };
    let error = track(&source, TOF, Some(&skeleton)).unwrap_err().to_string();
    assert!(error.starts_with("b.tof: joint The \"Neck\": occurs twice in the skeleton"), "{error}");
    let animation = TOF.replace("\"Head\"", "\"The \\\"Neck\\\"\"");
    let error = track(&source, &animation, Some(TOF_SKELETON)).unwrap_err().to_string();
    assert!(error.starts_with("a.tof: joint The \"Neck\": occurs twice in the animation"), "{error}");
}

#[test]
fn an_error_in_motion_names_file_line_and_channel() {
    let refused = |channels: &str, row: &str| {
        let (_folder, path) = written("walk.bvh", bvh(channels, row).as_bytes());
        let said = read(&straight(path.clone(), Some(1.0)), 24.0).unwrap_err().to_string();
        said.replace(&path.display().to_string(), "walk.bvh")
    };
    let channels = "Zrotation Xrotation Yrotation";
    assert_eq!(
        refused(channels, "0 0 0 0 0 0 0 nan 0"),
        "walk.bvh:19: frame 0 of 1, Head.Xrotation: \"nan\": its value must be a finite number"
    );
    assert_eq!(
        refused(channels, "0 0 0 0 0 0 0 0"),
        "walk.bvh: frame 0 of 1, Head.Yrotation: ends before a number: is it complete?"
    );
    assert_eq!(
        refused("Zrotation Wrotation Yrotation", "0 0 0 0 0 0 0 0 0"),
        "walk.bvh:9: \"Wrotation\": a channel must be Xposition .. Zrotation"
    );
}

/// A track sampled at uneven times from a head that accelerates evenly and turns at a constant rate.
fn thrown() -> Track {
    let times: Vec<f64> = [0.0, 0.03, 0.1, 0.11, 0.2, 0.28, 0.3, 0.41].map(|t| t + 7.0).to_vec();
    let samples = times.iter().map(|&t| Sample { position: flight(t - 7.0), rotation: spin(t - 7.0) }).collect();
    Track { times, samples, unit_cm: Some(1.0), ..Track::default() }
}

#[test]
fn times_of_few_decimals_are_as_long_as_the_exact_ones() {
    for rate in [24.0, 23.976, 25.0, 30.0, 60.0] {
        for frames in [1, 7, 100, 1000] {
            let exact: Vec<f64> = (0..=frames).map(|n| f64::from(n) / rate).collect();
            for digits in [3, 4, 6] {
                // Rounded by a thousandth of a second at most, and read as a file's text has it.
                let times: Vec<f64> = exact.iter().map(|t| format!("{t:.digits$}").parse().unwrap()).collect();
                let samples = exact.iter().map(|&t| Sample { position: flight(t), rotation: spin(t) }).collect();
                let track = Track { times, samples, unit_cm: Some(1.0), ..Track::default() };
                let motion = track.head_motion(&straight("short".into(), None), rate).unwrap();
                assert_eq!(motion.poses.len(), frames as usize + 1, "{frames} frames at {rate}, {digits} digits");
            }
        }
    }
}

fn flight(t: f64) -> DVec3 {
    DVec3::new(3.0, 40.0, -1.0) * t + DVec3::new(0.0, -490.0, 100.0) * t * t
}

fn spin(t: f64) -> DQuat {
    DQuat::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), TAU * t)
}

#[test]
fn uniform_acceleration_and_a_constant_turn_survive_resampling() {
    let motion = thrown().head_motion(&straight("thrown".into(), None), 60.0).unwrap();
    assert_eq!(motion.poses.len(), 25);
    for (n, pose) in motion.poses.iter().enumerate() {
        let t = n as f64 / 60.0;
        // f32 near 70 cm, and the rounding of times near 7 s.
        assert!(pose.position_cm.as_dvec3().distance(flight(t)) < 1e-5, "{n}");
        assert!(1.0 - pose.rotation.as_dquat().dot(spin(t)).abs() < 1e-6, "{n}");
    }
}

#[test]
fn samples_that_are_skipped_are_before_the_first_frame() {
    let skipping = |skip| MotionSource { skip, ..straight("thrown".into(), None) };
    // The third sample is that at 0.1 s of 0.41.
    let motion = thrown().head_motion(&skipping(2), 60.0).unwrap();
    assert_eq!(motion.poses.len(), 19);
    for (n, pose) in motion.poses.iter().enumerate() {
        let t = 0.1 + n as f64 / 60.0;
        assert!(pose.position_cm.as_dvec3().distance(flight(t)) < 1e-5, "{n}");
        assert!(1.0 - pose.rotation.as_dquat().dot(spin(t)).abs() < 1e-6, "{n}");
    }
    let refused = thrown().head_motion(&skipping(8), 60.0).unwrap_err().to_string();
    assert_eq!(refused, "thrown: skip = 8: the file has 8 samples");
}

/// A track of 24 samples a second, read at that rate with a bell of this deviation (frames).
fn smoothed(deviation: f32, sample: impl Fn(f64) -> Sample) -> Vec<Pose> {
    let times = (0..80).map(|n| f64::from(n) / 24.0).collect();
    let samples = (0..80).map(|n| sample(f64::from(n))).collect();
    let source = MotionSource { smoothing: deviation, ..straight("smoothed".into(), Some(1.0)) };
    Track { times, samples, ..Track::default() }.head_motion(&source, 24.0).unwrap().poses
}

/// Frames that a bell of this deviation reaches to either side, and its weight of a neighbour.
fn reach_and_weight(deviation: f32) -> (usize, f64) {
    let rounds = (2.0 * f64::from(deviation).powi(2)).ceil();
    (rounds as usize, f64::from(deviation).powi(2) / rounds / 2.0)
}

#[test]
fn smoothing_leaves_what_is_still_and_what_goes_evenly_but_at_its_ends() {
    let still = |_| Sample { position: flight(1.0), rotation: spin(0.3) };
    let even = |n: f64| Sample { position: DVec3::new(3.0, -1.0, 2.0) * n, rotation: spin(0.03 * n) };
    for deviation in [0.4, 1.5, 3.0] {
        let (reach, _) = reach_and_weight(deviation);
        for pose in smoothed(deviation, still) {
            assert_eq!(pose.position_cm, flight(1.0).as_vec3());
            assert!(1.0 - pose.rotation.as_dquat().dot(spin(0.3)).abs() < 1e-6);
        }
        let (as_it_is, poses) = (smoothed(0.0, even), smoothed(deviation, even));
        for n in reach..80 - reach {
            // f32 near 300 cm.
            assert!(poses[n].position_cm.distance(as_it_is[n].position_cm) < 1e-4, "{deviation}: {n}");
            assert!(1.0 - poses[n].rotation.dot(as_it_is[n].rotation).abs() < 1e-6, "{deviation}: {n}");
        }
        assert!(poses[0].position_cm.distance(as_it_is[0].position_cm) > 0.1, "the ends are averaged with less");
    }
}

#[test]
fn smoothing_weakens_every_tremor_as_its_bell_does() {
    for omega in [0.3, 1.2, 3.0_f64] {
        for deviation in [0.5, 1.0, 2.0] {
            let tremble = |n: f64| Sample {
                position: DVec3::new(0.0, 4.0 * (omega * n).cos(), 0.0),
                // Small, for the mean of two turns is the turn of the mean up to the square of the angle: 1e-4.
                rotation: DQuat::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 0.01 * (omega * n).cos()),
            };
            let (reach, b) = reach_and_weight(deviation);
            let factor = (1.0 - 2.0 * b * (1.0 - omega.cos())).powi(reach as i32);
            let (as_it_is, poses) = (smoothed(0.0, tremble), smoothed(deviation, tremble));
            for n in reach..80 - reach {
                let left = factor * f64::from(as_it_is[n].position_cm.y);
                assert!((f64::from(poses[n].position_cm.y) - left).abs() < 1e-6, "{omega} {deviation}: {n}");
                // Half the angle, along the axis.
                let left = factor * f64::from(as_it_is[n].rotation.z);
                assert!((f64::from(poses[n].rotation.z) - left).abs() < 1e-6, "{omega} {deviation}: {n}");
            }
        }
    }
}

#[test]
fn half_the_speed_has_the_same_poses_and_one_between_each_two() {
    let source = straight("thrown".into(), None);
    let slow = MotionSource { speed: 0.5, ..source.clone() };
    let (a, b) = (thrown().head_motion(&source, 24.0).unwrap(), thrown().head_motion(&slow, 24.0).unwrap());
    // 0.41 s.
    assert_eq!((a.poses.len(), b.poses.len()), (10, 20));
    assert!(b.poses.iter().step_by(2).eq(&a.poses));
    assert!(b.report.contains("at 24 Hz, at 0.5 of its speed (") && b.frame_rate == 24.0, "{}", b.report);
}

#[test]
fn a_start_at_the_origin_faces_x_and_changes_no_motion() {
    let as_it_is = straight("thrown".into(), None);
    let moved = MotionSource { start_at_origin: true, ..as_it_is.clone() };
    let (a, b) = (thrown().head_motion(&as_it_is, 24.0).unwrap(), thrown().head_motion(&moved, 24.0).unwrap());
    assert_eq!(b.poses[0].position_cm, Vec3::ZERO);
    assert!((b.poses[0].rotation * Vec3::X).z.abs() < 1e-6);
    for (wa, wb) in a.poses.windows(2).zip(b.poses.windows(2)) {
        // What the hair feels: the step of the head, seen from the head.
        let step = |w: &[Pose]| w[0].rotation.inverse() * (w[1].position_cm - w[0].position_cm);
        assert!(step(wa).distance(step(wb)) < 1e-4, "f32 near 70 cm, twice");
    }
}

#[test]
fn what_a_file_cannot_say_is_asked_for() {
    let (_folder, path) = written("walk.bvh", bvh("Zrotation Xrotation Yrotation", "0 0 0 0 0 0 0 0 0").as_bytes());
    let bare = MotionSource { file: path.clone(), ..MotionSource::default() };
    let error = |source: &MotionSource| read(source, 24.0).unwrap_err().to_string();
    assert!(error(&bare).contains("unit_cm is not in the file"), "{}", error(&bare));
    let wrong = MotionSource { facing: Some(Axis::MinusY), ..straight(path.clone(), Some(1.0)) };
    assert!(error(&wrong).contains("must be perpendicular"), "{}", error(&wrong));
    let unknown = MotionSource { node: "Haed".into(), ..straight(path, Some(1.0)) };
    assert!(error(&unknown).contains("node can be Hips, Head"), "{}", error(&unknown));
}

#[test]
fn settings_without_effect_are_refused() {
    let refused = |source: MotionSource| read(&source, 24.0).unwrap_err().to_string();
    let of = |file: &str| straight(file.into(), Some(1.0));
    for (source, key, ending) in [
        (MotionSource { skeleton: Some("a.asf".into()), ..of("a.bvh") }, "skeleton", "bvh"),
        (MotionSource { frames_per_second: Some(30.0), ..of("a.tof") }, "frames_per_second", "tof"),
        (MotionSource { clip: "Run".into(), ..of("a.csv") }, "clip", "csv"),
        (MotionSource { node: "Hips".into(), ..of("a.csv") }, "node", "csv"),
        (MotionSource { skip: 1, ..of("a.glb") }, "skip", "glb"),
        (MotionSource { positions: Interpolation::Linear, ..of("a.gltf") }, "positions", "gltf"),
    ] {
        assert_eq!(refused(source), format!("a.{ending}: {key} has no effect on a .{ending} file: remove it"));
    }
}

/// A .glb whose node Head hangs below Body (moved up 1 m) and has one channel: `keys` values over times 0, 1, 2.
fn glb(interpolation: &str, path: &str, values: &[f32]) -> Vec<u8> {
    let width = if path == "rotation" { 4 } else { 3 };
    let numbers = [0.0, 1.0, 2.0].iter().chain(values).flat_map(|x: &f32| x.to_le_bytes());
    let mut binary: Vec<u8> = numbers.collect();
    while !binary.len().is_multiple_of(4) {
        binary.push(0);
    }
    let mut json = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],
        "nodes":[{{"name":"Body","children":[1],"translation":[0,1,0]}},{{"name":"Head"               }}],
        "buffers":[{{"byteLength":{all}}}],
        "bufferViews":[{{"buffer":0,"byteLength":12}},{{"buffer":0,"byteOffset":12,"byteLength":{rest}}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"SCALAR","min":[0],"max":[2]}},
        {{"bufferView":1,"componentType":5126,"count":{count},"type":"VEC{width}"}}],
        "animations":[{{"name":"Nod","samplers":[{{"input":0,"output":1,"interpolation":"{interpolation}"}}],
        "channels":[{{"sampler":0,"target":{{"node":1,"path":"{path}"}}}}]}}]}}"#,
        all = binary.len(),
        rest = binary.len() - 12,
        count = values.len() / width,
    )
    .into_bytes();
    while !json.len().is_multiple_of(4) {
        json.push(b' ');
    }
    let mut file = b"glTF".to_vec();
    for x in [2, (28 + json.len() + binary.len()) as u32, json.len() as u32, 0x4E4F_534A] {
        file.extend(x.to_le_bytes());
    }
    file.extend(&json);
    file.extend((binary.len() as u32).to_le_bytes());
    file.extend(0x004E_4942u32.to_le_bytes());
    file.extend(&binary);
    file
}

fn clip_motion(bytes: &[u8], frame_rate: f64) -> Result<HeadMotion> {
    let (_folder, path) = written("nod.glb", bytes);
    read(
        &MotionSource { facing: Some(Axis::PlusX), ..MotionSource { file: path, ..MotionSource::default() } },
        frame_rate,
    )
}

#[test]
fn step_linear_and_cubicspline_follow_their_definitions() {
    let x = |motion: HeadMotion| motion.poses.iter().map(|p| p.position_cm.x).collect::<Vec<_>>();
    let keys = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    let step = clip_motion(&glb("STEP", "translation", &keys), 2.0).unwrap();
    assert!(step.poses.iter().all(|p| (p.position_cm.y - 100.0).abs() < 1e-4), "the body carries the head");
    assert_eq!(x(step), [0.0, 0.0, 100.0, 100.0, 0.0]);
    assert_eq!(x(clip_motion(&glb("LINEAR", "translation", &keys), 2.0).unwrap()), [0.0, 50.0, 100.0, 50.0, 0.0]);
    // x = t^2 as a spline: value t^2, both tangents 2 t.
    let spline: Vec<f32> =
        [0.0f32, 1.0, 2.0].iter().flat_map(|t| [2.0 * t, 0.0, 0.0, t * t, 0.0, 0.0, 2.0 * t, 0.0, 0.0]).collect();
    for (n, x) in x(clip_motion(&glb("CUBICSPLINE", "translation", &spline), 8.0).unwrap()).iter().enumerate() {
        let t = n as f32 / 8.0;
        assert!((x - 100.0 * t * t).abs() < 1e-3, "{n}: {x}");
    }
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let turn = [0.0, 0.0, 0.0, 1.0, 0.0, half, 0.0, half, 0.0, 1.0, 0.0, 0.0];
    let turned = clip_motion(&glb("LINEAR", "rotation", &turn), 4.0).unwrap();
    for (n, pose) in turned.poses.iter().enumerate() {
        let expected = Quat::from_rotation_y(std::f32::consts::FRAC_PI_2 * n as f32 / 4.0);
        assert!(1.0 - pose.rotation.dot(expected).abs() < 1e-6, "{n}: {pose:?}");
    }
}

#[test]
fn values_of_another_shape_than_what_they_move_are_refused() {
    // Found by fuzzing: read as VEC3, they would come from the wrong places.
    let mut four_wide = glb("STEP", "translation", &[0.0; 12]);
    let at = four_wide.windows(6).position(|w| w == b"\"VEC3\"").unwrap();
    four_wide[at + 4] = b'4';
    let at = four_wide.windows(9).position(|w| w == b"\"count\":4").unwrap();
    four_wide[at + 8] = b'3';
    let error = clip_motion(&four_wide, 24.0).unwrap_err().to_string();
    assert!(error.contains("accessor 1: translations of type F32 Vec4 are not read"), "{error}");
}

/// Reads `bytes` as each kind of motion; only a panic, or never coming back, is wrong.
fn read_whatever(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    let source = straight("fuzz".into(), Some(1.0));
    for track in [bvh::track(&text, "Head"), csv::track(&text)].into_iter().flatten() {
        let _ = track.head_motion(&source, 24.0);
    }
    for (name, skeleton, motion) in [("fuzz.amc", ASF, AMC), ("fuzz.tof", TOF_SKELETON, TOF)] {
        let source = MotionSource { skeleton: Some(name.into()), ..straight(name.into(), Some(1.0)) };
        let source =
            MotionSource { frames_per_second: extension(&source.file).starts_with('a').then_some(60.0), ..source };
        for (skeleton, motion) in [(skeleton, &*text), (&*text, motion)] {
            let _ = track(&source, motion, Some(skeleton)).map(|track| track.head_motion(&source, 24.0));
        }
    }
    let _ = clip_motion(bytes, 24.0);
}

#[test]
fn cases_found_by_fuzzing_stay_errors() {
    let sound = bvh("Zrotation Xrotation Yrotation", "0 0 0 0 0 0 0 0 0");
    let table = "t_s,px_m,py_m,pz_m,qx,qy,qz,qw\n";
    let text = |from: &str, to: &str| {
        assert!(sound.contains(from), "{from}");
        sound.replace(from, to)
    };
    for broken in [
        text("Frames: 1", "Frames: 1.5"),
        text("Frames: 1", "Frames: 0"),
        text("Frames: 1", "Frames: -3"),
        text("Time: 0.04", "Time: 0"),
        text("Time: 0.04", "Time: NaN"),
        text("CHANNELS 3", "CHANNELS 1e18"),
        text("CHANNELS 3 Zrotation Xrotation Yrotation", "CHANNELS 3 Zrotation Wrotation Yrotation"),
        text("OFFSET 0 5 0", "OFFSET 0 inf 0"),
        text("End Site", "End Site End Site"),
        "HIERARCHY MOTION Frames: 99999999999 Frame Time: 1".to_owned(),
        "HIERARCHY ROOT Head { OFFSET 0 0 0 } MOTION Frames: 99999999999 Frame Time: 1".to_owned(),
        "HIERARCHY } MOTION".to_owned(),
        "HIERARCHY ".to_owned() + &"ROOT Head { ".repeat(100_000),
        String::new(),
    ] {
        let (_folder, path) = written("broken.bvh", broken.as_bytes());
        assert!(read(&straight(path, Some(1.0)), 24.0).is_err(), "{broken:.60}");
    }
    for rows in [
        "",
        "0,0,0,0,0,0,0,1\n0,0,0,0,0,0,0,1\n",
        "0,0,0,0,0,0,0,2\n",
        "0,0,nan,0,0,0,0,1\n",
        "0,1,2\n",
        "0,0,0,0,0,0,0,1\n1e300,0,0,0,0,0,0,1\n",
    ] {
        let (_folder, path) = written("broken.csv", (table.to_owned() + rows).as_bytes());
        assert!(read(&straight(path, None), 24.0).is_err(), "{rows}");
    }
    let keys = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    let clip = glb("STEP", "translation", &keys);
    for (from, to) in [
        (r#""count":3,"type":"VEC3""#, r#""count":9,"type":"VEC3""#),
        (r#""byteLength":12}"#, r#""byteLength":99}"#),
        (r#""path":"translation""#, r#""path":"tran lation""#),
        (r#""node":1,"path""#, r#""node":2,"path""#),
        (r#""Head"               }"#, r#""Head","children":[0]}"#),
        (r#""componentType":5126,"count":3,"type":"SCALAR""#, r#""componentType":5125,"count":3,"type":"SCALAR""#),
    ] {
        assert_eq!(from.len(), to.len(), "or the lengths in the file would be what is wrong");
        let at = clip.windows(from.len()).position(|w| w == from.as_bytes()).expect(from);
        let mut broken = clip.clone();
        broken.splice(at..at + from.len(), to.bytes());
        assert!(clip_motion(&broken, 24.0).is_err(), "{to}");
    }
    let mut endless = glb("STEP", "translation", &keys);
    let second_time = endless.len() - 4 * 9 - 4;
    endless[second_time..second_time + 4].copy_from_slice(&f32::MAX.to_le_bytes());
    assert!(clip_motion(&endless, 24.0).is_err(), "a clip of 1e38 s");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn damaged_motion_is_an_error_and_no_panic(
        kind in 0..7usize,
        cut in 0.0..1.0f64,
        hits in prop::collection::vec((0.0..1.0f64, any::<u8>()), 0..6),
    ) {
        let mut bytes = match kind {
            0 => bvh("Zrotation Xrotation Yrotation", "1 2 3 4 5 6 7 8 9").into_bytes(),
            1 => b"t_s,px_m,py_m,pz_m,qx,qy,qz,qw\n0,1,2,3,0,0,0,1\n0.5,1,2,3,0,0,0,1\n".to_vec(),
            2 => glb("CUBICSPLINE", "translation", &[0.5; 27]),
            other => [ASF, AMC, TOF_SKELETON, TOF][other - 3].into(),
        };
        for (place, value) in hits {
            let at = (place * bytes.len() as f64) as usize;
            bytes[at] = value;
        }
        if cut > 0.5 {
            bytes.truncate((2.0 * (cut - 0.5) * bytes.len() as f64) as usize);
        }
        read_whatever(&bytes);
    }
}

#[test]
fn a_number_may_stand_right_behind_its_colon() {
    let loose = "HIERARCHY ROOT Head { OFFSET 0 0 0 CHANNELS 3 Xposition Yposition Zposition End Site { OFFSET 0 1 0 } } \
                 MOTION Frames: 2 Frame Time: 0.5 0 0 0 1 2 3";
    let tight = loose.replace("Frames: ", "FRAMES:").replace("Time: ", "Time:");
    let [loose, tight] = [loose, &tight].map(|text| bvh::track(text, "Head").unwrap());
    assert_eq!((tight.times.clone(), tight.times), (loose.times, vec![0.0, 0.5]));
}
