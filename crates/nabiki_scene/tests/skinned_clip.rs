//! A head out of a .glb that is bound to joints, and the clip of the same file that moves these.

use std::path::Path;

use glam::{DAffine3, DQuat, DVec3};
use nabiki_io::exchange;
use nabiki_scene::exports::ExportOptions;
use nabiki_scene::tasks::{NewOptions, SimulateOptions, Twin, new, simulate};
use nabiki_scene::{Scene, Shown, Unwatched};

/// Frames a second of the scene, and of the keys.
const RATE: f64 = 24.0;

/// The armature as Blender writes what was made in centimetres and stands along z.
fn armature() -> DAffine3 {
    DAffine3::from_scale_rotation_translation(
        DVec3::splat(0.01),
        DQuat::from_rotation_x(-std::f64::consts::FRAC_PI_2),
        DVec3::new(0.5, 0.0, 0.0),
    )
}

/// The neck in frame `n`, below the armature (cm): it turns about its z and goes; `None` where it stands still.
fn neck(n: Option<usize>) -> (DVec3, DQuat) {
    let n = n.map_or(0.0, |n| 1.0 + n as f64);
    (DVec3::new(0.0, 4.0 * n, 150.0), DQuat::from_rotation_z(0.15 * n))
}

/// Takes the skull's joint to the file's world, which is in metres.
fn skull(n: Option<usize>) -> DAffine3 {
    let (place, turn) = neck(n);
    armature()
        * DAffine3::from_rotation_translation(turn, place)
        * DAffine3::from_translation(DVec3::new(0.0, 2.0, 10.0))
}

/// A ball of 10 cm about the skull, bound to it as it stands, below a node that is moved away; frames 0 to 5 of a clip named Nod.
fn glb() -> Vec<u8> {
    const ROWS: usize = 12;
    const COLUMNS: usize = 16;
    let center = skull(None).translation;
    let (mut points, mut indices): (Vec<f32>, Vec<u16>) = (Vec::new(), Vec::new());
    for row in 0..=ROWS {
        let down = std::f64::consts::PI * row as f64 / ROWS as f64;
        for column in 0..COLUMNS {
            let around = std::f64::consts::TAU * column as f64 / COLUMNS as f64;
            let p = center + 0.1 * DVec3::new(down.sin() * around.cos(), down.cos(), down.sin() * around.sin());
            points.extend(p.as_vec3().to_array());
            if row < ROWS {
                let at = |row: usize, column: usize| (row * COLUMNS + column % COLUMNS) as u16;
                let [a, b, c, d] = [at(row, column), at(row, column + 1), at(row + 1, column + 1), at(row + 1, column)];
                indices.extend([a, b, c, a, c, d]);
            }
        }
    }
    let count = points.len() / 3;
    let bytes = |all: &[f32]| all.iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>();
    let bind = glam::DMat4::from(skull(None).inverse()).as_mat4().to_cols_array();
    let keys: Vec<(DVec3, DQuat)> = (0..6).map(|n| neck(Some(n))).collect();
    let places: Vec<f32> = keys.iter().flat_map(|(place, _)| place.as_vec3().to_array()).collect();
    let turns: Vec<f32> = keys.iter().flat_map(|(_, turn)| turn.as_quat().to_array()).collect();
    let times: Vec<f32> = (0..6).map(|n| (n as f64 / RATE) as f32).collect();
    let views = [
        bytes(&points),
        indices.iter().flat_map(|i| i.to_le_bytes()).collect(),
        vec![0; 4 * count],
        bytes(&[1.0, 0.0, 0.0, 0.0].repeat(count)),
        bytes(&bind),
        bytes(&times),
        bytes(&places),
        bytes(&turns),
    ];
    let (mut binary, mut texts): (Vec<u8>, Vec<String>) = (Vec::new(), Vec::new());
    for view in &views {
        texts.push(format!(r#"{{"buffer":0,"byteOffset":{},"byteLength":{}}}"#, binary.len(), view.len()));
        binary.extend(view);
        binary.resize(binary.len().next_multiple_of(4), 0);
    }
    let accessor = |view: usize, kind: u32, count: usize, shape: &str| {
        format!(
            r#"{{"bufferView":{view},"componentType":{kind},"count":{count},"type":"{shape}","min":[0,0,0],"max":[1,1,1]}}"#
        )
    };
    let accessors = [
        accessor(0, 5126, count, "VEC3"),
        accessor(1, 5123, indices.len(), "SCALAR"),
        accessor(2, 5121, count, "VEC4"),
        accessor(3, 5126, count, "VEC4"),
        accessor(4, 5126, 1, "MAT4"),
        accessor(5, 5126, 6, "SCALAR"),
        accessor(6, 5126, 6, "VEC3"),
        accessor(7, 5126, 6, "VEC4"),
    ];
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let json = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[
        {{"name":"Armature","children":[1,2],"scale":[0.01,0.01,0.01],"rotation":[{},0,0,{half}],"translation":[0.5,0,0]}},
        {{"name":"body","mesh":0,"skin":0,"translation":[0,0,70]}},
        {{"name":"neck","children":[3],"translation":[0,0,150]}},{{"name":"skull","translation":[0,2,10]}}],
        "skins":[{{"joints":[3],"inverseBindMatrices":4}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"JOINTS_0":2,"WEIGHTS_0":3}},"indices":1}}]}}],
        "animations":[{{"name":"Nod","samplers":[{{"input":5,"output":6}},{{"input":5,"output":7}}],"channels":[
        {{"sampler":0,"target":{{"node":2,"path":"translation"}}}},{{"sampler":1,"target":{{"node":2,"path":"rotation"}}}}]}}],
        "accessors":[{}],"bufferViews":[{}],"buffers":[{{"byteLength":{}}}]}}"#,
        -half,
        accessors.join(","),
        texts.join(","),
        binary.len()
    );
    let mut text = json.into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let mut glb = b"glTF".to_vec();
    let mut words = |words: &[u32], bytes: &[u8]| {
        glb.extend(words.iter().flat_map(|word| word.to_le_bytes()));
        glb.extend(bytes);
    };
    words(&[2, (28 + text.len() + binary.len()) as u32, text.len() as u32, 0x4E4F_534A], &text);
    words(&[binary.len() as u32, 0x004E_4942], &binary);
    glb
}

/// A hair on top of it, in the same world.
fn root() -> DVec3 {
    skull(None).translation + DVec3::new(0.02, 0.1, 0.01)
}

fn files(folder: &Path) {
    std::fs::write(folder.join("man.glb"), glb()).unwrap();
    let [a, b, c] = [0.0, 0.1, 0.2].map(|up| root() + DVec3::new(0.0, up, 0.0));
    let hair = format!(
        "#usda 1.0\n( metersPerUnit = 1\n upAxis = \"Y\" )\ndef BasisCurves \"hair\" {{ uniform token type = \"linear\"\n\
         int[] curveVertexCounts = [3]\n point3f[] points = [({}, {}, {}), ({}, {}, {}), ({}, {}, {})] }}\n",
        a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z
    );
    std::fs::write(folder.join("hair.usda"), hair).unwrap();
}

#[test]
fn hair_goes_with_the_joint_that_its_head_is_bound_to() {
    let folder = tempfile::tempdir().unwrap();
    files(folder.path());
    let output = folder.path().join("out.usda");
    // Whichever unit the scene takes the file to be in, motion and mesh are in the same.
    for (unit, facing) in [("", "+z"), ("unit = \"m\"", "-x"), ("unit = \"dm\"", "+z")] {
        let cm = if unit.contains("dm") { 10.0 } else { 100.0 };
        let half = 0.1 * cm;
        let scene = format!(
            "[head]\nmesh = \"man.glb\"\n{unit}\nfacing = \"{facing}\"\norigin = [0.5, 1.6, 0]\n\
             motion = {{ file = \"man.glb\", node = \"skull\", bind_at_start = true }}\n\
             ellipsoid = {{ center = [0, 0, 0], half_axes = [{half}, {half}, {half}] }}\n\
             [hair]\nfile = \"hair.usda\"\nunit = {cm}\n[motion]\nform = \"free\"\nframes = 5\nframe_rate = 24\n[free]\ndrag = 0.0\n\
             stiffness = 0.0\nhold = 0.0\ngravity = 0.0\n"
        );
        let scene = Scene::parse(&scene, &folder.path().join("scene.toml"), &[]).unwrap();
        let (output, exports) = (output.clone(), ExportOptions::default());
        simulate(
            scene,
            Shown::All,
            &SimulateOptions { output: output.clone(), exports, twin: Twin::Fast, shard: None },
            &mut Unwatched,
        )
        .unwrap();
        for frame in 0..=5 {
            let found = exchange::hair(&output, frame, None).unwrap().strands.strand(0)[0];
            let there = (skull(Some(frame)) * skull(None).inverse()).transform_point3(root()).as_vec3();
            assert!(found.distance(there) < 1e-5, "{unit} {facing}, frame {frame}: {found} for {there}");
        }
    }
}

#[test]
fn a_new_scene_about_a_head_that_a_joint_carries_has_its_motion() {
    let folder = tempfile::tempdir().unwrap();
    files(folder.path());
    let (scene, head) = (folder.path().join("new.toml"), folder.path().join("man.glb"));
    new(&scene, &NewOptions { head: Some(head), ..NewOptions::default() }, &mut Unwatched).unwrap();
    let text = std::fs::read_to_string(&scene).unwrap();
    let motion = "motion = { file = \"man.glb\", node = \"skull\", facing = \"+z\", bind_at_start = true }\n";
    assert!(text.contains(motion) && text.contains("\nframes = 5\n"), "{text}");
    let built = Scene::load(&scene, &[]).unwrap().build(Shown::AtMost(10)).unwrap();
    assert!(built.head_moves());
    let turned = built.pose(5).rotation.angle_between(built.pose(0).rotation);
    assert!((turned - 0.75).abs() < 1e-3, "0.15 a frame, {turned} in 5");
    assert!(built.advice().iter().all(|advice| !advice.seen.contains("moves it there a second time")));
    let without = text.replace("bind_at_start = true", "bind_at_start = false");
    let built = Scene::parse(&without, &scene, &[]).unwrap().build(Shown::AtMost(20)).unwrap();
    assert!(built.advice().iter().any(|advice| advice.seen.contains("and head.motion moves it there a second time")));
}
