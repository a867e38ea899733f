//! Heads and hair out of a file whose motion carries them.

use std::path::Path;

use glam::{Quat, Vec3};
use nabiki_io::exchange;
use nabiki_scene::exports::ExportOptions;
use nabiki_scene::tasks::{NewOptions, SimulateOptions, Twin, new, simulate};
use nabiki_scene::{BuiltScene, Scene, Shown, Unwatched};

/// A ball on a tail that stands at (0, 2, 1) m in its first frame, turned so far about z, and moves on.
fn layer(turned: f32) -> String {
    let ball = ball();
    format!(
        "#usda 1.0\n( metersPerUnit = 1\n upAxis = \"Z\"\n timeCodesPerSecond = 24 )\n\
         def Xform \"tail\" {{ double3 xformOp:translate.timeSamples = {{ 0: (0, 2, 1), 9: (1, 2, 1) }}\n\
         double xformOp:rotateZ = {turned}\n\
         uniform token[] xformOpOrder = [\"xformOp:translate\", \"xformOp:rotateZ\"]\n{ball} }}\n"
    )
}

/// An octahedron of 10 cm about the tail's own origin.
fn ball() -> &'static str {
    "def Mesh \"ball\" { point3f[] points = [(0.1, 0, 0), (-0.1, 0, 0), (0, 0.1, 0), (0, -0.1, 0), (0, 0, 0.1), (0, 0, -0.1)]\n\
     int[] faceVertexCounts = [3, 3, 3, 3, 3, 3, 3, 3]\n\
     int[] faceVertexIndices = [0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5] }"
}

/// A hair on top of it.
const HAIR: &str = "#usda 1.0\n( metersPerUnit = 1\n upAxis = \"Z\" )\n\
    def BasisCurves \"hair\" { uniform token type = \"linear\"\n int[] curveVertexCounts = [3]\n\
    point3f[] points = [(0.05, 2, 1.1), (0.05, 2, 1.2), (0.05, 2, 1.3)] }\n";

/// What is advised of a head and a body that a file carries.
fn advised(folder: &Path, turned: f32, origin: &str) -> Vec<String> {
    std::fs::write(folder.join("tail.usda"), layer(turned)).unwrap();
    std::fs::write(folder.join("hair.usda"), HAIR).unwrap();
    let motion = "{ file = \"tail.usda\", node = \"tail\", facing = \"-y\" }";
    let scene = format!(
        "[head]\nmesh = \"tail.usda\"\nfacing = \"-y\"\n{origin}\nmotion = {motion}\n\
         ellipsoid = {{ center = [0, 0, 0], half_axes = [9, 9, 9] }}\n\
         [hair]\nfile = \"hair.usda\"\n[motion]\nform = \"free\"\nframes = 5\n\
         [[body]]\nmesh = \"tail.usda\"\nfacing = \"-y\"\n{origin}\nmotion = {motion}\n"
    );
    let file = folder.join("scene.toml");
    std::fs::write(&file, scene).unwrap();
    let built = Scene::load(&file, &[]).unwrap().build(Shown::All).unwrap();
    let advice = built.advice().into_iter().map(|advice| advice.to_string());
    advice.filter(|line| line.contains("moves it there a second time")).collect()
}

#[test]
fn a_mesh_that_its_motion_would_carry_twice_is_said_with_the_way_out() {
    let folder = tempfile::tempdir().unwrap();
    let said = |table: &str| {
        format!(
            "{table}.mesh is already placed in tail.usda as tail is in the first frame, and {table}.motion moves it there a second time"
        )
    };
    let give = |table: &str| format!("{}: give {table}.motion.bind_at_start = true", said(table));
    let of_both = [give("head"), give("body[0]")];
    assert_eq!(advised(folder.path(), 0.0, "origin = [0, 0, 0]"), of_both);
    assert_eq!(advised(folder.path(), 0.0, "origin = [0, 2, 1]"), [""; 0], "where the node is, unturned");
    assert_eq!(advised(folder.path(), 30.0, "origin = [0, 2, 1]"), of_both);
    let scene = folder.path().join("scene.toml");
    let text = std::fs::read_to_string(&scene)
        .unwrap()
        .replace("facing = \"-y\" }", "facing = \"-y\", bind_at_start = true }");
    let followed = Scene::parse(&text, &scene, &[]).unwrap().build(Shown::All).unwrap().advice();
    assert!(
        !followed.iter().any(|advice| advice.to_string().contains("moves it there a second time")),
        "what was advised, followed"
    );
}

#[test]
fn a_motion_of_the_mesh_s_own_file_faces_as_the_mesh_does_and_another_facing_is_said() {
    let folder = tempfile::tempdir().unwrap();
    advised(folder.path(), 30.0, "origin = [0, 2, 1]");
    let scene = folder.path().join("scene.toml");
    let text = std::fs::read_to_string(&scene).unwrap();
    let built = |motion: &str| {
        let text = text.replace("facing = \"-y\" }", motion);
        Scene::parse(&text, &scene, &[]).unwrap().build(Shown::All).unwrap()
    };
    let same = built("facing = \"-y\", bind_at_start = true }");
    let none = built("bind_at_start = true }");
    assert!((0..=5).all(|frame| same.pose(frame) == none.pose(frame)));
    let other = built("facing = \"+x\", bind_at_start = true }");
    let said = |built: &BuiltScene| -> Vec<String> {
        let lines = built.advice().into_iter().map(|advice| advice.to_string());
        lines.filter(|line| line.contains("moves and turns in other directions")).collect()
    };
    assert_eq!((said(&same).len(), said(&none).len(), said(&other).len()), (0, 0, 2));
    let line = "head.motion.facing = \"+x\" and head.facing = \"-y\", both for tail.usda";
    assert!(said(&other)[0].starts_with(line), "{:?}", said(&other));
}

#[test]
fn a_scale_that_changes_and_a_shear_are_said_to_be_left_out() {
    let folder = tempfile::tempdir().unwrap();
    advised(folder.path(), 30.0, "origin = [0, 2, 1]");
    let (scene, tail) = (folder.path().join("scene.toml"), folder.path().join("tail.usda"));
    let layer = std::fs::read_to_string(&tail).unwrap();
    for (operation, order, said) in [
        ("double3 xformOp:scale = (2, 3, 4)", "\"xformOp:rotateZ\", \"xformOp:scale\"", None),
        (
            "double3 xformOp:scale.timeSamples = { 0: (1, 1, 1), 9: (1, 1, 1.1) }",
            "\"xformOp:rotateZ\", \"xformOp:scale\"",
            Some("ignored: its scale, which changes"),
        ),
        (
            "double3 xformOp:scale = (1, 1.1, 1)",
            "\"xformOp:scale\", \"xformOp:rotateZ\"",
            Some("ignored: its shear, from uneven scale above a rotation"),
        ),
    ] {
        let scaled = layer.replace("uniform token[]", &format!("{operation}\n uniform token[]"));
        std::fs::write(&tail, scaled.replace("\"xformOp:rotateZ\"", order)).unwrap();
        let report = Scene::load(&scene, &[]).unwrap().build(Shown::All).unwrap().way.report.clone().unwrap();
        assert_eq!(report.split("; ").nth(2), said, "{report}");
    }
}

#[test]
fn hair_that_a_motion_of_its_own_file_carries_is_exported_where_the_file_has_it() {
    let folder = tempfile::tempdir().unwrap();
    let (scene, out) = (folder.path().join("scene.toml"), folder.path().join("out.usda"));
    // Where the first frame is moved to the world's origin, hair goes from where it lies in its file.
    for start in ["false", "true"] {
        advised(folder.path(), 0.0, "origin = [0, 2, 1]");
        let moved = [("head.motion.start_at_origin".to_owned(), start.to_owned())];
        let scene = Scene::load(&scene, &moved).unwrap();
        let (output, exports) = (out.clone(), ExportOptions::default());
        let options = SimulateOptions { output, exports, twin: Twin::Fast, shard: None };
        simulate(scene, Shown::All, &options, &mut Unwatched).unwrap();
        for frame in 0..=5 {
            let root = exchange::hair(&out, frame, None).unwrap().strands.strand(0)[0];
            let there = Vec3::new(0.05 + frame as f32 / 9.0, 2.0, 1.1);
            assert!(root.distance(there) < 1e-5, "start_at_origin = {start}, frame {frame}: {root}");
        }
    }
}

#[test]
fn what_is_bound_at_the_start_goes_with_its_node_however_that_is_turned_and_wherever_the_head_s_origin_is() {
    let folder = tempfile::tempdir().unwrap();
    let (scene, out) = (folder.path().join("scene.toml"), folder.path().join("out.usda"));
    for (turned, origin) in [(0.0, "[0, 2, 1]"), (30.0, "[0, 2, 1]"), (-75.0, "[0.3, 1.5, 2]")] {
        advised(folder.path(), turned, &format!("origin = {origin}"));
        // It goes and turns on about z, by a right angle in nine frames.
        let layer = std::fs::read_to_string(folder.path().join("tail.usda")).unwrap();
        let turning = format!("double xformOp:rotateZ.timeSamples = {{ 0: {turned}, 9: {} }}", turned + 90.0);
        let layer = layer.replace(&format!("double xformOp:rotateZ = {turned}"), &turning);
        std::fs::write(folder.path().join("tail.usda"), layer).unwrap();
        let bound = [("head.motion.bind_at_start", "true"), ("free.drag", "0"), ("body", "[]")];
        let bound = bound.map(|(key, value)| (key.to_owned(), value.to_owned()));
        let stage = Scene::load(&scene, &bound).unwrap();
        let options =
            SimulateOptions { output: out.clone(), exports: ExportOptions::default(), twin: Twin::Fast, shard: None };
        simulate(stage, Shown::All, &options, &mut Unwatched).unwrap();
        for frame in 0..=5 {
            let root = exchange::hair(&out, frame, None).unwrap().strands.strand(0)[0];
            let node = |frame: usize| Vec3::new(frame as f32 / 9.0, 2.0, 1.0);
            let on = Quat::from_rotation_z((10.0 * frame as f32).to_radians());
            let there = node(frame) + on * (Vec3::new(0.05, 2.0, 1.1) - node(0));
            assert!(root.distance(there) < 1e-5, "turned {turned}, frame {frame}: {root} for {there}");
        }
    }
}

#[test]
fn what_is_bound_to_a_joint_goes_with_it_from_where_the_skeleton_binds_it() {
    // Bound at 1.5 m, turned by a right angle about x there; in frame n it is turned about z and 0.1 n + 0.3 m to the side.
    let bind = "( (1, 0, 0, 0), (0, 0, 1, 0), (0, -1, 0, 0), (0, 1.5, 0, 1) )";
    let turn = |frame: usize| 0.2 + 0.1 * frame as f32;
    let joint = |frame: usize| {
        let bound = Quat::from_rotation_x(std::f32::consts::FRAC_PI_2);
        (Vec3::new(0.3 + 0.1 * frame as f32, 1.5, 0.0), Quat::from_rotation_z(turn(frame)) * bound)
    };
    let samples = |value: &dyn Fn((Vec3, Quat)) -> String| -> String {
        (0..6).map(|frame| format!("{frame}: [{}], ", value(joint(frame)))).collect()
    };
    let (places, turns) = (
        samples(&|(at, _)| format!("({}, {}, {})", at.x, at.y, at.z)),
        samples(&|(_, turn)| format!("({}, {}, {}, {})", turn.w, turn.x, turn.y, turn.z)),
    );
    let ball = ball().replace("(0.1, 0, 0)", "(0.1, 1.5, 0)");
    let layer = format!(
        "#usda 1.0\n( metersPerUnit = 1\n upAxis = \"Y\"\n timeCodesPerSecond = 24 )\n\
         def SkelRoot \"man\" {{ def Skeleton \"rig\" {{ uniform token[] joints = [\"head\"]\n\
         uniform matrix4d[] bindTransforms = [{bind}]\n uniform matrix4d[] restTransforms = [{bind}]\n\
         rel skel:animationSource = </man/rig/walk>\n\
         def SkelAnimation \"walk\" {{ uniform token[] joints = [\"head\"]\n\
         float3[] translations.timeSamples = {{ {places} }}\n quatf[] rotations.timeSamples = {{ {turns} }} }} }}\n\
         {ball} }}\n"
    );
    let hair = HAIR.replace("\"Z\"", "\"Y\"").replace("(0.05, 2, 1.1)", "(0.05, 1.6, 0.02)");
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name);
    std::fs::write(file("man.usda"), layer).unwrap();
    std::fs::write(file("hair.usda"), hair).unwrap();
    let scene = "[head]\nmesh = \"man.usda\"\nfacing = \"+z\"\norigin = [0.1, 1.4, 0]\n\
         motion = { file = \"man.usda\", node = \"head\", bind_at_start = true }\n\
         ellipsoid = { center = [0, 0, 0], half_axes = [9, 9, 9] }\n\
         [hair]\nfile = \"hair.usda\"\n[motion]\nform = \"free\"\nframes = 5\n[free]\ndrag = 0.0\n";
    let scene = Scene::parse(scene, &file("scene.toml"), &[]).unwrap();
    let (output, exports) = (file("out.usda"), ExportOptions::default());
    let options = SimulateOptions { output: output.clone(), exports, twin: Twin::Fast, shard: None };
    simulate(scene, Shown::All, &options, &mut Unwatched).unwrap();
    for frame in 0..=5 {
        let root = exchange::hair(&output, frame, None).unwrap().strands.strand(0)[0];
        let there = joint(frame).0 + Quat::from_rotation_z(turn(frame)) * (Vec3::new(0.05, 1.6, 0.02) - Vec3::Y * 1.5);
        assert!(root.distance(there) < 1e-5, "frame {frame}: {root} for {there}");
    }
}

/// As UsdSkel has it: what is bound stands where its joints take it, below the skeleton's transforms, wherever its own prim is.
#[test]
fn a_head_and_hair_that_are_bound_go_with_their_joint_whatever_moves_the_skeleton() {
    let api = "( prepend apiSchemas = [\"SkelBindingAPI\"] )";
    let matrix = |x: f32, y: f32| format!("( (1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), ({x}, {y}, 0, 1) )");
    let bond = format!(
        "rel skel:skeleton = </man/rig>\n uniform matrix4d primvars:skel:geomBindTransform = {}\n\
         int[] primvars:skel:jointIndices = [1] ( elementSize = 1 interpolation = \"constant\" )\n\
         float[] primvars:skel:jointWeights = [1] ( elementSize = 1 interpolation = \"constant\" )\n\
         double3 xformOp:translate = (9, 9, 9)\n uniform token[] xformOpOrder = [\"xformOp:translate\"] }}\n",
        matrix(0.0, 1.5)
    );
    // Turned by a fifth more in each frame, from the first on, and a decimetre to the side.
    let turn = |frame: usize| 0.2 + 0.2 * frame as f32;
    let samples =
        |value: &dyn Fn(usize) -> String| (0..6).map(|n| format!("{n}: [{}], ", value(n))).collect::<String>();
    let places = samples(&|n| format!("({}, 1, 0), (0, 0.5, 0)", 0.1 * n as f32));
    let turns = samples(&|n| {
        let half = Quat::from_rotation_y(turn(n));
        format!("(1, 0, 0, 0), ({}, 0, {}, 0)", half.w, half.y)
    });
    let ball = ball().trim_end_matches('}').replace("\"ball\" {", &format!("\"ball\" {api} {{"));
    let layer = format!(
        "#usda 1.0\n( metersPerUnit = 1\n upAxis = \"Y\"\n timeCodesPerSecond = 24 )\n\
         def SkelRoot \"man\" {{ double3 xformOp:translate = (1, 0, -2)\n float3 xformOp:scale = (2, 2, 2)\n\
         uniform token[] xformOpOrder = [\"xformOp:translate\", \"xformOp:scale\"]\n\
         def Skeleton \"rig\" {api} {{ uniform token[] joints = [\"hips\", \"hips/head\"]\n\
         uniform matrix4d[] bindTransforms = [{}, {}]\n uniform matrix4d[] restTransforms = [{}, {}]\n\
         rel skel:animationSource = </man/rig/walk>\n\
         def SkelAnimation \"walk\" {{ uniform token[] joints = [\"hips\", \"hips/head\"]\n\
         float3[] translations.timeSamples = {{ {places} }}\n quatf[] rotations.timeSamples = {{ {turns} }}\n\
         half3[] scales = [(1, 1, 1), (1, 1, 1)] }} }}\n\
         {ball} {bond}\n\
         def BasisCurves \"hair\" {api} {{ uniform token type = \"linear\"\n int[] curveVertexCounts = [3]\n\
         point3f[] points = [(0.05, 0.08, 0.02), (0.05, 0.13, 0.02), (0.05, 0.18, 0.02)]\n {bond} }}\n",
        matrix(0.0, 1.0),
        matrix(0.0, 1.5),
        matrix(0.0, 1.0),
        matrix(0.0, 0.5),
    );
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name);
    std::fs::write(file("man.usda"), layer).unwrap();
    let motion = "{ file = \"man.usda\", node = \"/man/rig/hips/head\", facing = \"+z\", bind_at_start = true }";
    let scene = format!(
        "[head]\nmesh = \"man.usda\"\nfacing = \"+z\"\norigin = [1, 3, -2]\nmotion = {motion}\n\
         ellipsoid = {{ center = [0, 0, 0], half_axes = [9, 9, 9] }}\n\
         [hair]\nfile = \"man.usda\"\n[motion]\nform = \"free\"\nframes = 5\n[free]\ndrag = 0.0\n"
    );
    let scene = Scene::parse(&scene, &file("scene.toml"), &[]).unwrap();
    let (output, exports) = (file("out.usda"), ExportOptions::default());
    let options = SimulateOptions { output: output.clone(), exports, twin: Twin::Fast, shard: None };
    simulate(scene, Shown::All, &options, &mut Unwatched).unwrap();
    for frame in 0..=5 {
        let root = exchange::hair(&output, frame, None).unwrap().strands.strand(0)[0];
        let joint = Vec3::new(0.1 * frame as f32, 1.5, 0.0);
        let of_skeleton = joint + Quat::from_rotation_y(turn(frame)) * Vec3::new(0.05, 0.08, 0.02);
        let there = Vec3::new(1.0, 0.0, -2.0) + 2.0 * of_skeleton;
        assert!(root.distance(there) < 1e-4, "frame {frame}: {root} for {there}");
    }
    let options = NewOptions { head: Some(file("man.usda")), hair: Some(file("man.usda")), ..NewOptions::default() };
    new(&file("new.toml"), &options, &mut Unwatched).unwrap();
    let text = std::fs::read_to_string(file("new.toml")).unwrap();
    let motion = text.lines().find(|line| line.starts_with("motion = ")).unwrap_or_else(|| panic!("{text}"));
    assert!(motion.contains("node = \"/man/rig/hips/head\"") && motion.contains("bind_at_start = true"), "{motion}");
}
