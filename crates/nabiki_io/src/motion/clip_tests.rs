use glam::{Quat, Vec3};

use super::*;

/// A .glb of these nodes, of which 0 is the root, and one channel that moves `path` of `node` by `values` at `times`.
fn glb(nodes: &str, (node, path): (usize, &str), interpolation: &str, times: &[f32], values: &[f32]) -> Vec<u8> {
    let width = if path == "rotation" { 4 } else { 3 };
    let binary: Vec<u8> = times.iter().chain(values).flat_map(|x| x.to_le_bytes()).collect();
    let (first, last) = (times[0], times[times.len() - 1]);
    let json = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{nodes}],
        "buffers":[{{"byteLength":{all}}}],
        "bufferViews":[{{"buffer":0,"byteLength":{split}}},{{"buffer":0,"byteOffset":{split},"byteLength":{rest}}}],
        "accessors":[
        {{"bufferView":0,"componentType":5126,"count":{keys},"type":"SCALAR","min":[{first}],"max":[{last}]}},
        {{"bufferView":1,"componentType":5126,"count":{count},"type":"VEC{width}"}}],
        "animations":[{{"samplers":[{{"input":0,"output":1,"interpolation":"{interpolation}"}}],
        "channels":[{{"sampler":0,"target":{{"node":{node},"path":"{path}"}}}}]}}]}}"#,
        all = binary.len(),
        split = 4 * times.len(),
        rest = 4 * values.len(),
        keys = times.len(),
        count = values.len() / width,
    );
    crate::gltf_file::tests::glb(&json, &binary)
}

/// The motion of the node Head, two frames a second, of which nothing is said.
fn motion(bytes: &[u8], facing: Option<Axis>) -> HeadMotion {
    let source = MotionSource { file: "nod.glb".into(), facing, ..MotionSource::default() };
    head_motion(&source, bytes, 2.0).unwrap()
}

#[test]
fn a_clip_turns_its_node_from_the_still_pose_from_the_first_key_on() {
    let still = Quat::from_rotation_x(1.0);
    let [x, y, z, w] = still.to_array();
    let nodes = format!(
        r#"{{"name":"Body","children":[1],"translation":[1,2,3]}},{{"name":"Head","rotation":[{x},{y},{z},{w}]}}"#
    );
    // A quarter of a turn about the file's z in two seconds, of which the first is the clip's second.
    let turned = |angle: f32| (Quat::from_rotation_z(angle) * still).to_array();
    let quarter = std::f32::consts::FRAC_PI_2;
    let values = [turned(0.0), turned(quarter / 2.0), turned(quarter)].concat();
    let found = motion(&glb(&nodes, (1, "rotation"), "LINEAR", &[1.0, 2.0, 3.0], &values), None);
    assert_eq!(found.poses.len(), 5);
    for (n, pose) in found.poses.iter().enumerate() {
        // Metres; +z, which the face looks along, becomes x, and x becomes -z.
        assert!(pose.position_cm.distance(Vec3::new(300.0, 200.0, -100.0)) < 1e-3, "{n}: {pose:?}");
        let expected = Quat::from_rotation_x(quarter * n as f32 / 4.0);
        assert!(1.0 - pose.rotation.dot(expected).abs() < 1e-6, "{n}: {pose:?}");
    }
}

#[test]
fn tangents_of_a_spline_are_by_the_second_however_long_its_keys_are_apart() {
    // x = t^2: both tangents are 2 t.
    let times = [0.0f32, 0.5, 3.0];
    let values: Vec<f32> = times.iter().flat_map(|t| [2.0 * t, 0.0, 0.0, t * t, 0.0, 0.0, 2.0 * t, 0.0, 0.0]).collect();
    let nodes = r#"{"name":"Head"}"#;
    let found = motion(&glb(nodes, (0, "translation"), "CUBICSPLINE", &times, &values), Some(Axis::PlusX));
    assert_eq!(found.poses.len(), 7);
    for (n, pose) in found.poses.iter().enumerate() {
        let t = n as f32 / 2.0;
        assert!((pose.position_cm.x - 100.0 * t * t).abs() < 1e-3, "{n}: {pose:?}");
    }
}

#[test]
fn a_node_that_grows_takes_its_children_along() {
    let nodes = r#"{"name":"Body","children":[1],"translation":[0,1,0]},{"name":"Head","translation":[0,0.5,0.25]}"#;
    let values = [1.0, 1.0, 1.0, 1.0, 3.0, 2.0];
    let found = motion(&glb(nodes, (0, "scale"), "LINEAR", &[0.0, 1.0], &values), Some(Axis::PlusX));
    let places: Vec<Vec3> = found.poses.iter().map(|pose| pose.position_cm).collect();
    // As the head faces +x, +z is its right.
    assert_eq!(places, [[0.0, 150.0, 25.0], [0.0, 200.0, 37.5], [0.0, 250.0, 50.0]].map(Vec3::from));
    assert!(found.poses.iter().all(|pose| pose.rotation.angle_between(Quat::IDENTITY) < 1e-3), "{:?}", found.poses);
}
