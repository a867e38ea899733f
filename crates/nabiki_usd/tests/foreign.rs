//! Layers as other programs write them: what their transforms, skeletons and attributes mean.
//! That usd-core reads the same numbers is `tests/interchange`.

use std::io::Cursor;

use glam::{DAffine3, DQuat, DVec3, Vec3};
use nabiki::Mesh;
use nabiki::hair::{Other, Per, Role, Stored, Values};
use nabiki_exchange::{Export, FrameSink, GroomReader, PrimKind};
use nabiki_usd::{HairStage, LayerKind, StageReader};

fn reader(text: impl Into<String>) -> StageReader {
    StageReader::new(Cursor::new(text.into().into_bytes())).unwrap()
}

/// Six times the volume that a mesh encloses: positive where its faces look outwards.
fn six_volumes(mesh: &Mesh) -> f32 {
    mesh.triangles.iter().map(|t| t.map(|v| mesh.positions[v as usize])).map(|[a, b, c]| a.dot(b.cross(c))).sum()
}

#[test]
fn mirrored_and_left_handed_meshes_come_in_with_their_outside_outside() {
    for mirrored in [false, true] {
        for left_handed in [false, true] {
            let scale = if mirrored { "(-2, 1, 1)" } else { "(2, 1, 1)" };
            // A left-handed mesh is listed the other way round.
            let corners =
                if left_handed { "0, 1, 2, 0, 3, 1, 0, 2, 3, 1, 3, 2" } else { "0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3" };
            let orientation = if left_handed { "leftHanded" } else { "rightHanded" };
            let mut stage = reader(format!(
                "#usda 1.0\ndef Xform \"a\" {{ double3 xformOp:scale = {scale}\n uniform token[] xformOpOrder = [\"xformOp:scale\"]\n\
                 def Mesh \"m\" {{ point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]\n\
                 int[] faceVertexCounts = [3, 3, 3, 3]\n int[] faceVertexIndices = [{corners}]\n\
                 uniform token orientation = \"{orientation}\" }} }}\n"
            ));
            let mesh = stage.mesh().unwrap();
            assert_eq!(six_volumes(&mesh), 2.0, "mirrored {mirrored}, left-handed {left_handed}");
        }
    }
}

#[test]
fn transforms_are_interpolated_each_at_its_own_times() {
    let mut stage = reader(
        "#usda 1.0\n( timeCodesPerSecond = 10 )\ndef Xform \"a\" { double3 xformOp:translate.timeSamples = { 0: (0, 0, 0), 8: (16, 0, 0) }\n\
         uniform token[] xformOpOrder = [\"xformOp:translate\"]\n\
         def Xform \"b\" { float xformOp:rotateZ.timeSamples = { 2: 0, 6: 80 }\n uniform token[] xformOpOrder = [\"xformOp:rotateZ\"]\n\
         def Xform \"c\" { quatf xformOp:orient.timeSamples = { 0: (1, 0, 0, 0), 4: (0, 0, 0, 1) }\n\
         uniform token[] xformOpOrder = [\"xformOp:orient\"]\n\
         def BasisCurves \"h\" { uniform token type = \"linear\"\n int[] curveVertexCounts = [2]\n\
         point3f[] points.timeSamples = { 1: [(0, 0, 0), (1, 0, 0)], 4: [(0, 0, 0), (7, 0, 0)] } } } } }\n",
    );
    // What each says at a time code by itself: a line from 0 to 8, a line from 2 to 6, a turn at a constant rate.
    let known = |t: f64| {
        let turn = (20.0 * (t - 2.0)).clamp(0.0, 80.0) + 45.0 * t.min(4.0);
        (DVec3::new(2.0 * t.min(8.0), 0.0, 0.0), DQuat::from_rotation_z(turn.to_radians()))
    };
    let motion = stage.motion("/a/b/c").unwrap();
    let times: Vec<f64> = motion.iter().map(|p| 10.0 * p.time).collect();
    // At every whole code, since the three go their own ways between their keys.
    assert_eq!(times, [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0]);
    for placed in motion {
        let (position, rotation) = known(10.0 * placed.time);
        assert!(placed.position.distance(position) < 1e-12);
        assert!(1.0 - placed.rotation.dot(rotation).abs() < 1e-12, "at {} s", placed.time);
    }
    // Samples farther apart than frames give way to these: 1, 2, 3, 4.
    let frames = stage.contents().unwrap();
    assert_eq!((frames.times, frames.frame_rate), (vec![0.1, 0.2, 0.3, 0.4], 10.0));
}

#[test]
fn frames_at_uneven_times_are_read_at_whole_codes_between_their_samples() {
    let mut stage = reader(
        "#usda 1.0\ndef BasisCurves \"h\" { uniform token type = \"linear\"\n int[] curveVertexCounts = [2]\n\
         point3f[] points.timeSamples = { 1: [(0, 0, 0), (1, 0, 0)], 4: [(0, 0, 0), (7, 0, 0)], 5: [(0, 0, 0), (8, 0, 0)] } }\n",
    );
    assert_eq!(stage.contents().unwrap().times, [1.0, 2.0, 3.0, 4.0, 5.0].map(|t| t / 24.0));
    for (frame, x) in [1.0f32, 3.0, 5.0, 7.0, 8.0].into_iter().enumerate() {
        let tip = stage.hair(frame, None).unwrap().strands.strand(0)[1];
        // Shares of a third are rounded once, the blend of two numbers twice more.
        assert!((tip.x - x).abs() <= 4.0 * f32::EPSILON * x, "frame {frame}: {tip}");
    }
}

#[test]
fn samples_between_whole_codes_are_said() {
    let mut stage = reader(
        "#usda 1.0\ndef BasisCurves \"h\" { uniform token type = \"linear\"\n int[] curveVertexCounts = [2]\n\
         point3f[] points.timeSamples = { 0.75: [(0, 0, 0), (3, 0, 0)], 1.25: [(0, 0, 0), (5, 0, 0)], \
         2: [(0, 0, 0), (8, 0, 0)] } }\n",
    );
    let frames = stage.contents().unwrap();
    assert_eq!((frames.times, frames.frame_rate), (vec![1.0 / 24.0, 2.0 / 24.0], 24.0));
    let hair = stage.hair(0, None).unwrap();
    assert_eq!(hair.strands.strand(0)[1], Vec3::X * 4.0);
    assert_eq!(hair.attributes.unread, ["2 samples between frames, at 24 frames a second"]);
}

#[test]
fn hair_that_only_its_transform_moves_has_the_frames_of_that() {
    let mut stage = reader(
        "#usda 1.0\ndef Xform \"a\" { double xformOp:translateX.timeSamples = { 0: 0, 1: 5, 2: 7 }\n\
         uniform token[] xformOpOrder = [\"xformOp:translateX\"]\n def BasisCurves \"h\" { uniform token type = \"linear\"\n\
         int[] curveVertexCounts = [2]\n point3f[] points = [(0, 0, 0), (1, 0, 0)] } }\n",
    );
    assert_eq!(stage.contents().unwrap().times, [0.0, 1.0, 2.0].map(|t| t / 24.0));
    for (frame, x) in [0.0, 5.0, 7.0].into_iter().enumerate() {
        let placed = stage.hair_in_place(frame, None, false).unwrap();
        assert_eq!(placed.world_from_hair, DAffine3::from_translation(DVec3::X * f64::from(x)));
        assert_eq!(stage.hair(frame, None).unwrap().strands.strand(0)[0], Vec3::X * x);
    }
}

#[test]
fn units_axes_and_rates_that_are_none_are_refused_in_one_line() {
    for (metadata, line) in [
        ("metersPerUnit = 0", "metersPerUnit = 0: must be a finite number above 0, 0.01 for centimetres"),
        ("metersPerUnit = -1", "metersPerUnit = -1: must be a finite number above 0, 0.01 for centimetres"),
        ("metersPerUnit = nan", "metersPerUnit = NaN: must be a finite number above 0, 0.01 for centimetres"),
        ("upAxis = \"X\"", "upAxis = \"X\": must be \"Y\" or \"Z\""),
        ("timeCodesPerSecond = 0", "timeCodesPerSecond = 0: must be a finite number above 0, 24, say"),
    ] {
        let refused = reader(format!("#usda 1.0\n( {metadata} )\n")).contents().unwrap_err();
        assert_eq!(refused.to_string(), line);
    }
}

#[test]
fn hair_without_a_finite_size_is_refused() {
    for (scale, points) in
        [("1e30", "(0, 0, 0), (1e20, 0, 0)"), ("1", "(0, 0, 0), (1e25, 0, 0)"), ("1e24", "(0, 0, 0), (1, 0, 0)")]
    {
        let mut stage = reader(format!(
            "#usda 1.0\ndef BasisCurves \"h\" {{ uniform token type = \"linear\"\n int[] curveVertexCounts = [2]\n\
             point3f[] points = [{points}]\n double xformOp:scaleX = {scale}\n\
             uniform token[] xformOpOrder = [\"xformOp:scaleX\"] }}\n"
        ));
        assert!(stage.hair(0, None).is_err(), "{points} times {scale}");
    }
}

const CARRIED: &str = "#usda 1.0
def Xform \"head\" {
    rel material:binding = </looks/black>
    def BasisCurves \"h\" (
        prepend apiSchemas = [\"MaterialBindingAPI\"]
    )
    {
        uniform token type = \"linear\"
        int[] curveVertexCounts = [2, 3]
        point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0), (2, 1, 0)]
        color3f[] primvars:displayColor = [(1, 0, 0), (0, 1, 0), (0, 0, 1)] ( interpolation = \"vertex\" )
        bool[] primvars:loose = [1, false] ( interpolation = \"uniform\" )
        uchar[] primvars:byte = [0, 255] ( interpolation = \"uniform\" )
        uint[] primvars:hash = [4294967295, 7] ( interpolation = \"uniform\" )
        uint64[] primvars:long_hash = [18446744073709551615, 9007199254740993] ( interpolation = \"uniform\" )
        int64[] primvars:long = [-9007199254740993, 9007199254740993] ( interpolation = \"uniform\" )
        half[] primvars:age = [0.5, 65504] ( interpolation = \"uniform\" )
        color3h[] primvars:glow = [(0.25, 0.5, 1)] ( interpolation = \"constant\" )
        half2 primvars:pair = (0.25, 0.5)
        token primvars:side = \"left\"
        string primvars:maker = \"somebody else\"
        int64 primvars:far = -1099511627776
        int primvars:near = -3
        bool primvars:combed = true
        double3 primvars:wind = (0.1, 0.2, 0.3)
        int[] primvars:groom_id = [1, 2, 3] ( interpolation = \"uniform\" )
        texCoord2f[] primvars:st = [(0, 0.5), (1, 0.25)] ( interpolation = \"uniform\" )
        float2[] primvars:surface_uv_coordinate = [(0, 0.5), (1, 0.25)] ( interpolation = \"uniform\" )
        texCoord2f[] primvars:UVMap = [(9, 9), (8, 8)] ( interpolation = \"uniform\" )
        float primvars:stiffness = 0.25 ( interpolation = \"constant\" )
        double[] primvars:mass = [0.1, 0.2] ( interpolation = \"uniform\" )
        color3f[] primvars:tint = [(1, 0, 0), (0, 1, 0)] (
            doc = \"says nothing of interpolation\"
            interpolation = \"uniform\"
        )
        int[] primvars:tint:indices = [1, 1]
        normal3f[] primvars:nearby = [(1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 0, 0), (0, 1, 0)] ( interpolation = \"vertex\" )
        string[] primvars:mood = [\"calm\", \"wild\"] ( interpolation = \"uniform\" )
        int2[] primvars:cell = [(1, 2), (3, 4)] ( interpolation = \"uniform\" )
        matrix4d[] primvars:frame = [( (1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (5, 6, 7, 1) )] ( interpolation = \"constant\" )
        asset primvars:picture = @skin.png@
        float3[] accelerations = [(0, 0, 0)]
    }
}
";

#[test]
fn what_a_groom_carries_goes_through_and_what_does_not_is_named() {
    let hair = reader(CARRIED).hair(0, None).unwrap();
    let at = &hair.attributes;
    assert_eq!(at.root_uv, Some(vec![[0.0, 0.5], [1.0, 0.25]]));
    assert_eq!(at.id, None);
    let names: Vec<&str> = at.other.iter().map(|o| o.name.as_str()).collect();
    let plain = ["UVMap", "cell", "frame", "mass", "mood", "nearby", "stiffness", "tint"];
    assert_eq!(names.iter().filter(|name| plain.contains(name)).count(), plain.len(), "{names:?}");
    let of = |name: &str| at.other.iter().find(|o| o.name == name).unwrap();
    assert_eq!((of("tint").per, of("tint").role), (Per::Strand, Role::Colour));
    assert_eq!(of("tint").values, Values::Floats(vec![0.0, 1.0, 0.0, 0.0, 1.0, 0.0]));
    assert_eq!((of("stiffness").per, &of("stiffness").values), (Per::Groom, &Values::Floats(vec![0.25])));
    assert_eq!(of("mass").values, Values::Doubles(vec![0.1, 0.2]));
    assert_eq!((of("cell").extent, &of("cell").values), (2, &Values::Integers(vec![1, 2, 3, 4])));
    assert_eq!((of("nearby").per, of("nearby").role, of("nearby").extent), (Per::Point, Role::Normal, 3));
    for said in [
        "displayColor: 3 values for 5 points of 2 curves",
        "groom_id: 3 values for 5 points of 2 curves",
        "picture, whose type nabiki does not read",
        "material:binding of /head",
        "attribute accelerations",
    ] {
        assert!(at.unread.iter().any(|line| line == said), "{said} is not in {:?}", at.unread);
    }
    // And so through both forms of layers.
    let folder = tempfile::tempdir().unwrap();
    for name in ["again.usda", "again.usdc"] {
        let path = folder.path().join(name);
        let mut sink = Box::new(HairStage::create(&path, Export::new(&hair, 24.0), LayerKind::Stage).unwrap());
        sink.frame(&hair.strands, &DAffine3::IDENTITY).unwrap();
        sink.finish().unwrap();
        let again = StageReader::open(&path).unwrap().hair(0, None).unwrap();
        assert_eq!(again.attributes.other, at.other, "{name}");
        assert_eq!((again.attributes.root_uv, again.attributes.unread), (at.root_uv.clone(), Vec::new()), "{name}");
        assert!(nabiki_usd::changes(&at.other).is_empty());
    }
}

#[test]
fn types_of_more_parts_than_usd_has_are_not_read() {
    for name in ["float0", "float5", "half256", "int300", "matrix5d", "matrix4294967296d", "color99999999999999f"] {
        let indexed = format!("{name}[] primvars:stiffness = [0.25, 0.5]\nint[] primvars:stiffness:indices = [1, 0]");
        let text = CARRIED.replace("float primvars:stiffness = 0.25 ( interpolation = \"constant\" )", &indexed);
        let at = reader(text).hair(0, None).unwrap().attributes;
        assert!(at.other.iter().all(|other| other.name != "stiffness"), "{name}");
        let said = "stiffness, whose type nabiki does not read";
        assert!(at.unread.iter().any(|line| line == said), "{name}: {:?}", at.unread);
    }
}

#[test]
fn types_of_what_is_passed_on_stay() {
    let hair = reader(CARRIED).hair(0, None).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("again.usda");
    let mut sink = Box::new(HairStage::create(&path, Export::new(&hair, 24.0), LayerKind::Stage).unwrap());
    sink.frame(&hair.strands, &DAffine3::IDENTITY).unwrap();
    sink.finish().unwrap();
    let text = std::fs::read_to_string(&path).unwrap();
    for line in [
        "bool[] primvars:loose = [1, 0]",
        "uchar[] primvars:byte = [0, 255]",
        "uint[] primvars:hash = [4294967295, 7]",
        "uint64[] primvars:long_hash = [18446744073709551615, 9007199254740993]",
        "int64[] primvars:long = [-9007199254740993, 9007199254740993]",
        "half[] primvars:age = [0.5, 65504]",
        "color3h[] primvars:glow = [(0.25, 0.5, 1)]",
        "half2 primvars:pair = (0.25, 0.5)",
        "token primvars:side = \"left\"",
        "string primvars:maker = \"somebody else\"",
        "int64 primvars:far = -1099511627776",
        "int primvars:near = -3",
        "bool primvars:combed = 1",
        "double3 primvars:wind = (0.1, 0.2, 0.3)",
        "float primvars:stiffness = 0.25",
        "texCoord2f[] primvars:UVMap = [(9, 9), (8, 8)]",
    ] {
        assert!(text.contains(line), "{line} is not in\n{text}");
    }
    // Whole numbers that no longer fit go into wider ones, and that is said.
    let other =
        Other { stored: Stored::I16, ..Other::new("x", Per::Strand, Role::Plain, 1, Values::Integers(vec![1, 2])) };
    assert_eq!(nabiki_usd::changes(std::slice::from_ref(&other)), ["the type of x: int16 becomes int"]);
    let other =
        Other { stored: Stored::U8, ..Other::new("x", Per::Strand, Role::Plain, 1, Values::Integers(vec![1, 256])) };
    assert_eq!(nabiki_usd::changes(std::slice::from_ref(&other)), ["the type of x: uint8 becomes int"]);
}

#[test]
fn root_uvs_under_a_name_of_their_own_keep_it_and_ids_that_are_none_are_said() {
    let text = CARRIED
        .replace("texCoord2f[] primvars:st", "texCoord2f[] primvars:map")
        .replace("surface_uv_coordinate", "rootuv");
    let text = text.replace("groom_id = [1, 2, 3]", "groom_id = [7, 7]");
    let at = reader(text).hair(0, None).unwrap().attributes;
    assert_eq!(at.root_uv, Some(vec![[0.0, 0.5], [1.0, 0.25]]));
    assert!(at.other.iter().any(|o| o.name == "rootuv"));
    assert_eq!(at.id, Some(vec![7, 7]));
    let said = "unique strand ids: 1 strand has the id of another";
    assert!(at.unread.iter().any(|line| line == said), "{:?}", at.unread);
}

#[test]
fn what_strands_have_one_of_may_be_given_by_point_and_is_said_where_it_changes_along_a_curve() {
    let read = |numbers: &str, words: &str| {
        let by_point = "( interpolation = \"vertex\" )";
        let text = CARRIED.replace(
            "groom_id = [1, 2, 3] ( interpolation = \"uniform\" )",
            &format!("groom_id = [{numbers}] {by_point}"),
        );
        let groups = format!(
            "int[] primvars:groom_guide = [{numbers}] {by_point}\n int[] primvars:hairId = [1, 2, 3, 4, 5] {by_point}\n\
             string[] primvars:groom_group_name = [{words}] {by_point}\n int[] primvars:groom_group_id = [{numbers}] {by_point}"
        );
        reader(text.replace("float3[] accelerations = [(0, 0, 0)]", &groups)).hair(0, None).unwrap().attributes
    };
    let said = |at: &nabiki::hair::Attributes| -> Vec<String> {
        at.unread.iter().filter(|line| line.contains(" from point to point")).cloned().collect()
    };
    let at = read("7, 7, 0, 0, 0", "\"a\", \"a\", \"b\", \"b\", \"b\"");
    assert_eq!((&at.id, &at.group, &at.guide), (&Some(vec![7, 0]), &Some(vec![7, 0]), &Some(vec![true, false])));
    assert_eq!(at.group_names, [(7, "a".to_owned()), (0, "b".to_owned())].into());
    assert_eq!(said(&at), Vec::<String>::new());
    let at = read("7, 7, 0, 0, 1", "\"a\", \"\", \"b\", \"b\", \"c\"");
    assert_eq!((&at.id, &at.group, &at.guide), (&Some(vec![7, 0]), &Some(vec![7, 0]), &Some(vec![true, false])));
    let line = |name: &str, curves: usize| {
        format!(
            "{name} from point to point: it changes along {curves} of 2 curves, but a strand keeps only the value at its root"
        )
    };
    // The ids under another program's name are all there, by point.
    assert!(at.other.iter().any(|other| other.name == "hairId" && other.per == Per::Point));
    let expected =
        [line("groom_id", 1), line("groom_group_id", 1), line("groom_guide", 1), line("groom_group_name", 2)];
    assert_eq!(said(&at), expected);
}

#[test]
fn texture_coordinates_of_points_stay_by_point() {
    let uvs = "[(0, 0), (0, 1), (0.5, 0), (0.5, 1)]";
    let text = format!(
        "#usda 1.0\ndef BasisCurves \"h\" {{ uniform token type = \"linear\"\n int[] curveVertexCounts = [2, 2]\n\
         point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 0, 1), (1, 0, 1)]\n\
         texCoord2f[] primvars:st = {uvs} ( interpolation = \"vertex\" ) }}\n"
    );
    let hair = reader(text).hair(0, None).unwrap();
    assert_eq!(hair.attributes.root_uv, Some(vec![[0.0, 0.0], [0.5, 0.0]]));
    assert_eq!(hair.attributes.unread, Vec::<String>::new());
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("back.usda");
    let mut sink = Box::new(HairStage::create(&path, Export::new(&hair, 24.0), LayerKind::Stage).unwrap());
    sink.frame(&hair.strands, &DAffine3::IDENTITY).unwrap();
    sink.finish().unwrap();
    let written = std::fs::read_to_string(path).unwrap();
    let st = written.split("primvars:st = ").nth(1).unwrap();
    assert!(st.starts_with(uvs) && st[uvs.len()..].trim_start().starts_with("(\n"), "{written}");
    assert!(st[..200].contains("interpolation = \"vertex\""), "{written}");
    assert_eq!(reader(written).hair(0, None).unwrap().attributes, hair.attributes);
}

const SKELETON: &str = "#usda 1.0
( timeCodesPerSecond = 10 )
def SkelRoot \"man\" {
    double3 xformOp:translate.timeSamples = { 0: (0, 0, 0), 4: (0, 0, 4) }
    uniform token[] xformOpOrder = [\"xformOp:translate\"]
    def Skeleton \"rig\" {
        uniform token[] joints = [\"hips\", \"hips/neck\", \"hips/neck/head\"]
        uniform matrix4d[] restTransforms = [
            ( (1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 90, 0, 1) ),
            ( (1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 50, 0, 1) ),
            ( (1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 10, 0, 1) )]
        def SkelAnimation \"walk\" {
            uniform token[] joints = [\"hips/neck\", \"hips\"]
            float3[] translations.timeSamples = { 0: [(0, 50, 0), (0, 90, 0)], 2: [(0, 50, 0), (0, 100, 0)] }
            quatf[] rotations.timeSamples = { 0: [(1, 0, 0, 0), (1, 0, 0, 0)], 2: [(0, 0, 0, 1), (1, 0, 0, 0)] }
            half3[] scales = [(1, 1, 1), (1, 1, 1)]
        }
    }
}
";

#[test]
fn a_joint_of_a_skeleton_drives_the_head() {
    for node in ["head", "hips/neck/head", "/man/rig/hips/neck/head"] {
        let motion = reader(SKELETON).motion(node).unwrap();
        assert_eq!(motion.iter().map(|p| (10.0 * p.time).round() as i32).collect::<Vec<_>>(), [0, 1, 2, 3, 4]);
        for placed in motion {
            let t = 10.0 * placed.time;
            // The neck turns by half a turn about z in two codes; the head, 10 above it, is not animated.
            let turn = DQuat::from_rotation_z(std::f64::consts::FRAC_PI_2 * t.min(2.0));
            let position = DVec3::new(0.0, 140.0 + 5.0 * t.min(2.0), t) + turn * DVec3::new(0.0, 10.0, 0.0);
            assert!(placed.position.distance(position) < 1e-9, "{node}: {} at {t}", placed.position);
            assert!(1.0 - placed.rotation.dot(turn).abs() < 1e-12);
        }
    }
    let unknown = reader(SKELETON).motion("hat").unwrap_err().to_string();
    assert_eq!(
        unknown,
        "has no prim or joint hat: node can be /man, /man/rig/hips, /man/rig/hips/neck, /man/rig/hips/neck/head"
    );
    let prims = reader(SKELETON).prims().unwrap();
    assert!(matches!(&prims[1].kind, PrimKind::Skeleton { joints } if joints.len() == 3));
}

#[test]
fn velocities_take_the_points_of_a_frame_to_those_of_the_next() {
    let hair = reader(CARRIED).hair(0, None).unwrap();
    let folder = tempfile::tempdir().unwrap();
    for name in ["moving.usda", "moving.usdc"] {
        let path = folder.path().join(name);
        let mut export = Export::new(&hair, 8.0);
        (export.velocities, export.rest, export.default_colour) = (true, true, Some([0.25, 0.5, 1.0]));
        let mut sink = Box::new(HairStage::create(&path, export, LayerKind::Stage).unwrap());
        for frame in 0..3 {
            let mut strands = hair.strands.clone();
            strands.points_mut().iter_mut().for_each(|p| *p += Vec3::Y * (frame * frame) as f32);
            sink.frame(&strands, &DAffine3::IDENTITY).unwrap();
        }
        sink.finish().unwrap();
        let again = StageReader::open(&path).unwrap().hair(2, None).unwrap();
        let rest = again.attributes.other.iter().find(|o| o.name == "rest").unwrap();
        assert_eq!((rest.per, rest.role), (Per::Point, Role::Point));
        let points = hair.strands.points().iter().flat_map(|p| p.to_array()).collect();
        assert_eq!(rest.values, Values::Floats(points), "{name}");
        assert_eq!(again.attributes.colour, Some(vec![[0.25, 0.5, 1.0]; 5]));
        if name.ends_with("usda") {
            let text = std::fs::read_to_string(&path).unwrap();
            let (_, velocities) = text.split_once("vector3f[] velocities.timeSamples = {").unwrap();
            // 1 and 3 units a frame, 8 frames a second; the last goes on as it came.
            for line in ["0: [(0, 8, 0), ", "1: [(0, 24, 0), ", "2: [(0, 24, 0), "] {
                assert!(velocities.contains(line), "{line}");
            }
        }
    }
}

#[test]
fn a_whole_turn_between_two_keys_is_a_turn() {
    let mut stage = reader(
        "#usda 1.0\ndef Xform \"a\" { float xformOp:rotateY.timeSamples = { 0: 0, 24: 360 }\n\
         uniform token[] xformOpOrder = [\"xformOp:rotateY\"]\n def Xform \"b\" {} }\n",
    );
    for placed in stage.motion("/a/b").unwrap() {
        let turn = DQuat::from_rotation_y((360.0 * placed.time).to_radians());
        assert!(1.0 - placed.rotation.dot(turn).abs() < 1e-12, "at {} s", placed.time);
    }
}

/// Flattened stages keep what is switched off; values that are absent are stored as index -1.
#[test]
fn classes_and_inactive_prims_are_no_hair_and_absent_values_are_said() {
    let curves =
        "uniform token type = \"linear\"\n int[] curveVertexCounts = [2]\n point3f[] points = [(0, 0, 0), (1, 0, 0)]\n";
    let mut stage = reader(format!(
        "#usda 1.0\nclass \"_c\" {{ def BasisCurves \"h\" {{ {curves} }} }}\n\
         def Xform \"off\" ( active = false ) {{ def BasisCurves \"h\" {{ {curves} }} }}\n\
         def Xform \"on\" ( customData = {{ bool active = false }}\n kind = \"group\"\n active = true ) {{\n\
         float primvars:above = 3\n\
         def BasisCurves \"h\" {{ {curves} token visibility = \"invisible\"\n\
         color3f[] primvars:palette = [(1, 0, 0)] ( interpolation = \"uniform\" )\n int[] primvars:palette:indices = [-1] }} }}\n"
    ));
    assert_eq!(stage.contents().unwrap().curves, ["/on/h"]);
    let hair = stage.hair(0, None).unwrap();
    assert_eq!(hair.strands.len(), 1);
    let said = [
        "palette: some of its indices name no value",
        "primvars:above of /on, which is above it",
        "visibility of /on/h, which is \"invisible\"",
    ];
    assert_eq!(hair.attributes.unread, said);
    let mut hermite = reader("#usda 1.0\ndef HermiteCurves \"h\" {}\n");
    let refused = hermite.hair(0, None).unwrap_err().to_string();
    assert_eq!(refused, "has HermiteCurves, but nabiki reads only BasisCurves: convert them");
}

#[test]
fn widths_as_a_primvar_win_over_the_attribute() {
    for (widths, expected) in [
        ("float[] widths = [0.5, 0.5]", 0.5),
        ("float[] primvars:widths = [0.25, 0.25] ( interpolation = \"vertex\" )", 0.25),
        ("float[] widths = [0.5, 0.5]\n float[] primvars:widths = [0.25, 0.25] ( interpolation = \"vertex\" )", 0.25),
    ] {
        let mut stage = reader(format!(
            "#usda 1.0\ndef BasisCurves \"h\" {{ uniform token type = \"linear\"\n int[] curveVertexCounts = [2]\n\
             point3f[] points = [(0, 0, 0), (1, 0, 0)]\n{widths} }}\n"
        ));
        assert_eq!(stage.hair(0, None).unwrap().attributes.width, Some(vec![expected; 2]), "{widths}");
    }
}
