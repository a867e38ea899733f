//! What every operation of a transform does to a point, by hand; `foreign.rs` has how they are interpolated.

use std::io::Cursor;
use std::path::Path;

use glam::{DAffine3, DVec3, Vec3};
use nabiki_exchange::{GroomReader, PrimKind};
use nabiki_usd::StageReader;

fn reader(text: &str) -> StageReader {
    StageReader::new(Cursor::new(format!("#usda 1.0\n{text}").into_bytes())).unwrap()
}

/// A curve from the origin to (1, 2, 3).
const CURVE: &str = "def BasisCurves \"h\" { uniform token type = \"linear\"\n int[] curveVertexCounts = [2]\n\
                     point3f[] points = [(0, 0, 0), (1, 2, 3)] }\n";

/// A prim whose operations are these, in this order, with something below it.
fn prim(name: &str, operations: &[&str], order: &[&str], below: &str) -> String {
    let order: Vec<String> = order.iter().map(|word| format!("\"{word}\"")).collect();
    let (operations, order) = (operations.join("\n"), order.join(", "));
    format!("def Xform \"{name}\" {{ {operations}\n uniform token[] xformOpOrder = [{order}]\n {below} }}\n")
}

/// Where (1, 2, 3) comes to.
fn tip(text: &str) -> Vec3 {
    reader(text).hair(0, None).unwrap().strands.strand(0)[1]
}

fn is_near(found: Vec3, expected: [f32; 3], what: &str) {
    assert!(found.distance(expected.into()) < 1e-5, "{what}: {found}, not {expected:?}");
}

#[test]
fn every_operation_does_what_its_name_says() {
    for (operation, expected) in [
        ("double3 xformOp:translate = (10, 20, 30)", [11.0, 22.0, 33.0]),
        ("double xformOp:translateX = 10", [11.0, 2.0, 3.0]),
        ("float xformOp:translateY = 10", [1.0, 12.0, 3.0]),
        ("half xformOp:translateZ = 10", [1.0, 2.0, 13.0]),
        ("float3 xformOp:scale = (2, 3, -4)", [2.0, 6.0, -12.0]),
        ("float xformOp:scaleX = 5", [5.0, 2.0, 3.0]),
        ("float xformOp:scaleY = 5", [1.0, 10.0, 3.0]),
        ("float xformOp:scaleZ = 5", [1.0, 2.0, 15.0]),
        // A quarter of a turn takes y to z, z to x, and x to y.
        ("float xformOp:rotateX = 90", [1.0, -3.0, 2.0]),
        ("float xformOp:rotateY = 90", [3.0, 2.0, -1.0]),
        ("float xformOp:rotateZ = 90", [-2.0, 1.0, 3.0]),
        // About the first letter first; the angles are in the order of the axes all the same.
        ("float3 xformOp:rotateXYZ = (90, 90, 0)", [2.0, -3.0, -1.0]),
        ("float3 xformOp:rotateYXZ = (90, 90, 0)", [3.0, 1.0, 2.0]),
        ("float3 xformOp:rotateXZY = (0, 90, 90)", [3.0, 1.0, 2.0]),
        ("float3 xformOp:rotateYZX = (0, 90, 90)", [-2.0, 3.0, -1.0]),
        ("float3 xformOp:rotateZXY = (90, 0, 90)", [-2.0, -3.0, 1.0]),
        ("float3 xformOp:rotateZYX = (90, 0, 90)", [-2.0, -3.0, 1.0]),
        // The real part first: half a turn about y.
        ("quatf xformOp:orient = (0, 0, 1, 0)", [-1.0, 2.0, -3.0]),
        // Rows multiplied from the left: x to y, y to z, z to x, then away.
        (
            "matrix4d xformOp:transform = ( (0, 1, 0, 0), (0, 0, 1, 0), (1, 0, 0, 0), (10, 20, 30, 1) )",
            [13.0, 21.0, 32.0],
        ),
    ] {
        let (declared, _) = operation.split_once(" = ").unwrap();
        let name = declared.split_once(' ').unwrap().1;
        is_near(tip(&prim("a", &[operation], &[name], CURVE)), expected, operation);
        // What is not in the order does nothing.
        is_near(tip(&prim("a", &[operation], &[], CURVE)), [1.0, 2.0, 3.0], operation);
    }
}

#[test]
fn the_last_operation_of_the_order_comes_first() {
    let operations =
        ["double3 xformOp:translate = (10, 0, 0)", "float xformOp:rotateZ = 90", "float xformOp:scaleX = 5"];
    let [translate, rotate, scale] = ["xformOp:translate", "xformOp:rotateZ", "xformOp:scaleX"];
    is_near(tip(&prim("a", &operations, &[translate, rotate, scale], CURVE)), [8.0, 5.0, 3.0], "scaled first");
    is_near(tip(&prim("a", &operations, &[scale, rotate, translate], CURVE)), [-10.0, 11.0, 3.0], "scaled last");
}

#[test]
fn an_inverted_operation_takes_back_what_it_does() {
    let operations = ["float3 xformOp:translate:pivot = (1, 0, 0)", "float xformOp:rotateZ = 90"];
    let pivot = ["xformOp:translate:pivot", "xformOp:rotateZ", "!invert!xformOp:translate:pivot"];
    // About (1, 0, 0).
    is_near(tip(&prim("a", &operations, &pivot, CURVE)), [-1.0, 0.0, 3.0], "pivot");
    let back = ["!invert!xformOp:rotateZ"];
    is_near(tip(&prim("a", &operations, &back, CURVE)), [2.0, -1.0, 3.0], "back");
    let nothing = ["xformOp:rotateZ", "!invert!xformOp:rotateZ"];
    is_near(tip(&prim("a", &operations, &nothing, CURVE)), [1.0, 2.0, 3.0], "there and back");
}

#[test]
fn a_prim_that_resets_the_stack_leaves_what_is_above_it_and_takes_along_what_is_below() {
    let place = |axis: &str, by: f64| format!("double xformOp:translate{axis} = {by}");
    let [x, y, z] = [place("X", 100.0), place("Y", 20.0), place("Z", 3.0)];
    let below = prim("c", &[&z], &["xformOp:translateZ"], CURVE);
    for order in [&["!resetXformStack!", "xformOp:translateY"][..], &["xformOp:translateY"]] {
        let text = prim("a", &[&x], &["xformOp:translateX"], &prim("b", &[&y], order, &below));
        let from_above = if order.len() == 1 { 100.0 } else { 0.0 };
        is_near(tip(&text), [1.0 + from_above, 22.0, 6.0], &format!("{order:?}"));
    }
    // Without a single operation, too.
    let text = prim("a", &[&x], &["xformOp:translateX"], &prim("b", &[], &["!resetXformStack!"], &below));
    is_near(tip(&text), [1.0, 2.0, 6.0], "nothing but a reset");
}

#[test]
fn a_head_stands_where_the_first_frame_of_the_hair_finds_it() {
    let mesh = "def Mesh \"m\" { point3f[] points.timeSamples = { 0: [(0, 0, 0), (1, 0, 0), (0, 1, 0)], \
                10: [(0, 0, 10), (1, 0, 10), (0, 1, 10)] }\n int[] faceVertexCounts = [3]\n int[] faceVertexIndices = [0, 1, 2] }\n";
    let curve = CURVE.replace(
        "points = [(0, 0, 0), (1, 2, 3)]",
        "points.timeSamples = { 5: [(0, 0, 0), (1, 2, 3)], 6: [(0, 0, 0), (1, 2, 4)], 7: [(0, 0, 0), (1, 2, 5)] }",
    );
    let moving = ["double xformOp:translateX.timeSamples = { 0: 0, 10: 100 }"];
    let mut stage = reader(&prim("a", &moving, &["xformOp:translateX"], &format!("{mesh}{curve}")));
    assert_eq!(stage.mesh().unwrap().positions[0], Vec3::new(50.0, 0.0, 5.0));
    let prims = stage.prims().unwrap();
    let PrimKind::Curves { world_from_curves, .. } = prims[2].kind else { panic!("{:?}", prims[2]) };
    assert_eq!(world_from_curves, DAffine3::from_translation(DVec3::X * 50.0));
    assert_eq!(stage.hair(1, None).unwrap().strands.strand(0)[1], Vec3::new(61.0, 2.0, 4.0));
}

#[test]
fn a_joint_that_is_scaled_takes_its_children_along() {
    let mut stage = reader(
        "def SkelRoot \"man\" { def Skeleton \"rig\" { uniform token[] joints = [\"hips\", \"hips/head\"]\n\
         uniform matrix4d[] restTransforms = [ ( (1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 90, 0, 1) ),\n\
         ( (1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 60, 0, 1) ) ]\n\
         def SkelAnimation \"grow\" { uniform token[] joints = [\"hips\", \"hips/head\"]\n\
         float3[] translations = [(0, 90, 0), (0, 60, 8)]\n quatf[] rotations = [(1, 0, 0, 0), (1, 0, 0, 0)]\n\
         half3[] scales.timeSamples = { 0: [(1, 1, 1), (1, 1, 1)], 24: [(1, 2, 0.5), (1, 1, 1)] } } } }\n",
    );
    let places: Vec<DVec3> = stage.motion("head").unwrap().into_iter().map(|placed| placed.position).collect();
    assert_eq!(places.len(), 25);
    assert_eq!([places[0], places[24]], [DVec3::new(0.0, 150.0, 8.0), DVec3::new(0.0, 210.0, 4.0)]);
}

#[test]
fn a_prim_is_found_by_its_path_or_by_a_name_whose_capitals_do_not_count() {
    let at = |x: f64| format!("double xformOp:translateX = {x}");
    let [one, ten] = [at(1.0), at(10.0)];
    let order = ["xformOp:translateX"];
    let head = prim("Head", &[&ten], &order, "");
    let text = format!("{}{}", prim("body", &[&one], &order, &head), prim("other", &[], &[], &head));
    for (node, x) in [("head", 11.0), ("HEAD", 11.0), ("/other/Head", 10.0), ("/body/Head", 11.0), ("Body", 1.0)] {
        assert_eq!(reader(&text).motion(node).unwrap()[0].position, DVec3::X * x, "{node}");
    }
    assert!(reader(&text).motion("hea").is_err() && reader(&text).motion("/Head").is_err());
}

/// The second is the first as usd-core exports it, which puts small numbers where other values have their place in the file.
#[test]
fn operations_and_values_are_alike_in_text_and_in_binary() {
    let open = |name: &str| StageReader::open(&Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/files").join(name));
    let [mut text, mut binary] = ["operations.usda", "operations.usdc"].map(|name| open(name).unwrap());
    assert_eq!(binary.contents().unwrap(), text.contents().unwrap());
    let [found, expected] = [&mut binary, &mut text].map(|stage| stage.hair(0, Some(3)).unwrap());
    assert_eq!(found.attributes, expected.attributes);
    assert_eq!((found.attributes.other.len(), found.strands.len()), (12, 20));
    for (found, expected) in found.strands.points().iter().zip(expected.strands.points()) {
        assert!(found.distance(*expected) < 1e-4, "{found} {expected}");
    }
    // Quarters of a turn about x, y and z, in half, single and double precision, a matrix of -2, 3 and -4, then (-1, 2, -3).
    let root = Vec3::new(12.0, -6.0, 2.0);
    assert!(found.strands.strand(0)[0].distance(root) < 1e-3, "{}", found.strands.strand(0)[0]);
    for node in ["/half", "/half/single", "/half/single/double"] {
        let [found, expected] = [&mut binary, &mut text].map(|stage| stage.motion(node).unwrap());
        assert!(!found.is_empty() && found.len() == expected.len(), "{node}");
        for (found, expected) in found.into_iter().zip(expected) {
            assert_eq!(found.time, expected.time, "{node}");
            assert!(found.position.distance(expected.position) < 1e-12, "{node}: {found:?} {expected:?}");
            assert!(found.rotation.dot(expected.rotation).abs() > 1.0 - 1e-12, "{node}: {found:?} {expected:?}");
        }
    }
}

/// As usd-core 26.11 has it, which warns.
#[test]
fn an_operation_that_is_named_and_not_there_is_passed_over_and_said() {
    let at = "double3 xformOp:translate = (10, 20, 30)";
    let said = |word: &str| format!("\"{word}\" of /a: its xformOpOrder names it, but it does not exist");
    for (operations, order, expected, missing) in [
        (&[at][..], &["xformOp:translate", "xformOp:scale"][..], [11.0, 22.0, 33.0], &["xformOp:scale"][..]),
        (&[at], &["xformOp:scale:pivot", "xformOp:translate"], [11.0, 22.0, 33.0], &["xformOp:scale:pivot"]),
        (&[at], &["!invert!xformOp:rotateX", "xformOp:translate"], [11.0, 22.0, 33.0], &["!invert!xformOp:rotateX"]),
        (&[], &["xformOp:orient", "xformOp:transform"], [1.0, 2.0, 3.0], &["xformOp:orient", "xformOp:transform"]),
        // Declared without a value it is there, and moves nothing.
        (&[at, "float3 xformOp:scale"], &["xformOp:translate", "xformOp:scale"], [11.0, 22.0, 33.0], &[]),
        (&[at], &["xformOp:translate", ""], [11.0, 22.0, 33.0], &[""]),
    ] {
        let text = prim("a", operations, order, CURVE);
        is_near(tip(&text), expected, &text);
        let unread = reader(&text).hair(0, None).unwrap().attributes.unread;
        assert_eq!(unread, missing.iter().map(|word| said(word)).collect::<Vec<_>>(), "{text}");
    }
    let skin = "def Mesh \"m\" { point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]\n\
                int[] faceVertexCounts = [3]\n int[] faceVertexIndices = [0, 1, 2] }\n";
    let mut stage = reader(&prim("a", &[at], &["xformOp:translate", "xformOp:scale"], skin));
    assert_eq!(stage.mesh().unwrap().positions[1], Vec3::new(11.0, 20.0, 30.0));
    assert_eq!(stage.mesh_unread().unwrap(), [said("xformOp:scale")]);
}

/// usd-core raises an error for these.
#[test]
fn what_is_no_operation_of_usd_is_refused() {
    for (operation, word) in [
        ("double3 xformOp:foo = (1, 2, 3)", "xformOp:foo"),
        ("double3 translate = (1, 2, 3)", "translate"),
        ("float4 xformOp:translate = (1, 2, 3, 4)", "xformOp:translate"),
        ("int3 xformOp:translate = (1, 2, 3)", "xformOp:translate"),
        ("double3[] xformOp:translate = [(1, 2, 3)]", "xformOp:translate"),
        ("float3 xformOp:rotateX = (90, 0, 0)", "xformOp:rotateX"),
        ("double xformOp:scale = 2", "xformOp:scale"),
        ("quatd xformOp:rotateXYZ = (1, 0, 0, 0)", "xformOp:rotateXYZ"),
        ("float3 xformOp:orient = (90, 0, 0)", "xformOp:orient"),
        ("matrix3d xformOp:transform = ( (1, 0, 0), (0, 1, 0), (0, 0, 1) )", "xformOp:transform"),
    ] {
        let refused = reader(&prim("a", &[operation], &[word], CURVE)).hair(0, None).unwrap_err().to_string();
        assert_eq!(refused, format!("prim /a: {word} is not a transform of USD"), "{operation}");
    }
}

/// As usd-core 26.11 has it: before the block the value is held, from it on nothing moves, whatever the default.
#[test]
fn a_blocked_value_of_an_operation_moves_nothing() {
    let text = "def Xform \"a\" { double3 xformOp:translate = (9, 9, 9)\n double3 xformOp:translate.timeSamples = {\n\
                1: (1, 0, 0), 2: None, 3: (3, 0, 0) }\n quatf xformOp:orient = None\n\
                uniform token[] xformOpOrder = [\"xformOp:translate\", \"xformOp:orient\"] }\n";
    let way = reader(text).motion("/a").unwrap();
    let places: Vec<f64> = way.iter().map(|placed| placed.position.x).collect();
    assert_eq!(places, [1.0, 0.0, 3.0]);
}

#[test]
fn an_order_is_read_once_however_many_prims_stand_below_it() {
    // Words for each prim would be some three million of them, and each such note would be there for each.
    let (deep, prims, named) = (40, 2000, 40);
    let order: Vec<String> = (0..named).map(|i| format!("\"xformOp:translate:o{i}\"")).collect();
    let above = |i| format!("def Xform \"d{i}\" {{ uniform token[] xformOpOrder = [{}]\n", order.join(", "));
    let curves =
        "uniform token type = \"linear\"\n int[] curveVertexCounts = [2]\n point3f[] points = [(0, 0, 0), (0, 1, 0)]";
    let mut text: String = (0..deep).map(above).collect();
    text.extend((0..prims).map(|i| format!("def BasisCurves \"c{i}\" {{ {curves} }}\n")));
    text += &"}".repeat(deep);
    let mut stage = StageReader::new(Cursor::new(format!("#usda 1.0\n{text}").into_bytes())).unwrap();
    match stage.hair_in_place(0, None, true) {
        Ok(read) => assert_eq!(read.hair.attributes.unread.len(), deep * named),
        Err(refused) => assert!(refused.0.contains("notes on transforms"), "{refused}"),
    }
}

#[test]
fn what_has_no_type_and_a_scope_have_no_transform() {
    let moved = "double3 xformOp:translate = (5, 0, 0)\n uniform token[] xformOpOrder = [\"xformOp:translate\"]\n";
    for (kind, expected) in [("Xform ", 5.0), ("Scope ", 0.0), ("", 0.0)] {
        let mut stage = reader(&format!("def {kind}\"a\" {{ {moved} {CURVE} }}\n"));
        let hair = stage.hair(0, None).unwrap();
        assert_eq!(hair.strands.strand(0)[0], Vec3::X * expected, "{kind}");
        let said = hair.attributes.unread.iter().any(|line| line.starts_with("the transform of /a: "));
        assert_eq!(said, expected == 0.0, "{kind}: {:?}", hair.attributes.unread);
    }
}
