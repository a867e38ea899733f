//! Heads and hair that are bound to a skeleton stand where UsdSkel has them: all places are those of usd-core 26.11.

use std::io::Cursor;
use std::path::Path;

use glam::Vec3;
use nabiki_exchange::GroomReader;
use nabiki_usd::StageReader;

fn reader(text: &str) -> StageReader {
    StageReader::new(Cursor::new(format!("#usda 1.0\n{text}").into_bytes())).unwrap()
}

const API: &str = "( prepend apiSchemas = [\"SkelBindingAPI\"] )";
const BOND: &str = "rel skel:skeleton = </char/rig>";
const INDICES: &str = "int[] primvars:skel:jointIndices = [1] ( elementSize = 1 interpolation = \"constant\" )";
const WEIGHTS: &str = "float[] primvars:skel:jointWeights = [1] ( elementSize = 1 interpolation = \"constant\" )";
const SOURCE: &str = "rel skel:animationSource = </char/rig/walk>";

fn place(x: f32, y: f32, z: f32) -> String {
    format!("( (1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), ({x}, {y}, {z}, 1) )")
}

/// A head whose hips go 10 to the side between time codes 1 and 11, below a root that is moved by 100. Its own prim, and that of its
/// hair, are moved by 7, which counts only where they are not bound.
struct Rig {
    root: &'static str,
    of_root: String,
    of_skeleton: String,
    animation: String,
    rest: String,
    /// What the head and the hair say of themselves, after their names and within.
    api: &'static str,
    own: Vec<String>,
}

impl Default for Rig {
    fn default() -> Self {
        Self {
            root: "SkelRoot",
            of_root: "{".to_owned(),
            of_skeleton: format!("{API} {{ {SOURCE}"),
            animation: "uniform token[] joints = [\"hips\", \"hips/head\"]\n\
                        float3[] translations.timeSamples = { 1: [(0, 90, 0), (0, 65, 0)], 11: [(10, 90, 0), (0, 65, 0)] }\n\
                        quatf[] rotations = [(1, 0, 0, 0), (1, 0, 0, 0)]\n half3[] scales = [(1, 1, 1), (1, 1, 1)]"
                .to_owned(),
            rest: format!("[{}, {}]", place(0.0, 90.0, 0.0), place(0.0, 65.0, 0.0)),
            api: API,
            own: [BOND, INDICES, WEIGHTS].map(str::to_owned).to_vec(),
        }
    }
}

impl Rig {
    /// The same with other words of the head and the hair.
    fn saying(own: &[&str]) -> Self {
        Self { own: own.iter().map(|&word| word.to_owned()).collect(), ..Self::default() }
    }

    fn text(&self, hair: bool) -> String {
        let Self { root, of_root, of_skeleton, animation, rest, api, own } = self;
        let (own, moved) = (own.join("\n"), "uniform token[] xformOpOrder = [\"xformOp:translate\"]");
        let bound = format!("[{}, {}]", place(0.0, 90.0, 0.0), place(0.0, 155.0, 0.0));
        let points = "point3f[] points = [(0, 155, 0), (0, 160, 0), (1, 155, 0)]";
        let curves = "uniform token type = \"linear\"\n int[] curveVertexCounts = [3]";
        let curves = format!(
            "def BasisCurves \"hair\" {api} {{ double3 xformOp:translate = (7, 0, 0)\n {moved}\n {points}\n {curves}\n {own} }}"
        );
        format!(
            "( startTimeCode = 1 )\ndef {root} \"char\" {of_root} double3 xformOp:translate = (100, 0, 0)\n {moved}\n\
             def Skeleton \"rig\" {of_skeleton}\n uniform token[] joints = [\"hips\", \"hips/head\"]\n\
             uniform matrix4d[] bindTransforms = {bound}\n uniform matrix4d[] restTransforms = {rest}\n\
             def SkelAnimation \"walk\" {{ {animation} }} }}\n\
             def Mesh \"head\" {api} {{ double3 xformOp:translate = (7, 0, 0)\n {moved}\n {points}\n\
             int[] faceVertexCounts = [3]\n int[] faceVertexIndices = [0, 1, 2]\n {own} }}\n {} }}\n",
            if hair { &curves } else { "" }
        )
    }
}

fn is_near(found: Vec3, expected: [f32; 3], what: &str) {
    assert!(found.distance(expected.into()) < 1e-3, "{what}: {found}, not {expected:?}");
}

/// Holds the first point of the head in the first frame, and that of the hair in the first and the last.
fn check(what: &str, rig: &Rig, first: [f32; 3], last: [f32; 3]) {
    let mut stage = reader(&rig.text(true));
    is_near(stage.mesh().unwrap().positions[0], first, what);
    for (frame, expected) in [(0, first), (10, last)] {
        is_near(
            stage.hair(frame, None).unwrap().strands.strand(0)[0],
            expected,
            &format!("{what}, hair of frame {frame}"),
        );
    }
}

#[test]
fn what_is_bound_stands_where_its_joints_have_it_and_not_its_own_prim() {
    let (there, gone) = ([100.0, 155.0, 0.0], [110.0, 155.0, 0.0]);
    let rest = |animation: &str| Rig {
        animation: animation.to_owned(),
        rest: format!("[{}, {}]", place(0.0, 90.0, 0.0), place(0.0, 70.0, 5.0)),
        ..Rig::default()
    };
    let of_hips = "uniform token[] joints = [\"hips\"]\n float3[] translations.timeSamples = { 1: [(0, 90, 0)], 11: [(10, 90, 0)] }\n\
                   quatf[] rotations = [(1, 0, 0, 0)]\n half3[] scales = [(1, 1, 1)]";
    let inherited = format!("{API} {{ {BOND}\n{INDICES}\n{WEIGHTS}");
    let geom_bind = format!("matrix4d primvars:skel:geomBindTransform = {}", place(0.0, 0.0, 3.0));
    let elsewhere = format!("matrix4d primvars:skel:geomBindTransform = {}", place(1.0, 2.0, 3.0));
    let only_head = "uniform token[] skel:joints = [\"hips/head\"]";
    let first = INDICES.replace("[1]", "[0]");
    for (what, rig, first, last) in [
        ("plain", Rig::default(), there, gone),
        (
            "geomBindTransform",
            Rig::saying(&[BOND, INDICES, WEIGHTS, &elsewhere]),
            [101.0, 157.0, 3.0],
            [111.0, 157.0, 3.0],
        ),
        (
            "geomBindTransform blocked",
            Rig::saying(&[BOND, INDICES, WEIGHTS, "matrix4d primvars:skel:geomBindTransform = None"]),
            there,
            gone,
        ),
        ("own joints", Rig::saying(&[BOND, only_head, &first, WEIGHTS]), there, gone),
        (
            "joints from above",
            Rig { of_root: format!("{API} {{ {only_head}"), ..Rig::saying(&[BOND, &first, WEIGHTS]) },
            there,
            gone,
        ),
        (
            "unknown joints move nothing",
            Rig::saying(&[BOND, "uniform token[] skel:joints = [\"hat\"]", &first, WEIGHTS]),
            there,
            there,
        ),
        ("all from above", Rig { of_root: inherited.clone(), own: Vec::new(), ..Rig::default() }, there, gone),
        (
            "all from above, without a schema",
            Rig { of_root: inherited, own: Vec::new(), api: "", ..Rig::default() },
            there,
            gone,
        ),
        (
            "the nearest counts",
            Rig { of_root: format!("{API} {{ {elsewhere}"), ..Rig::saying(&[BOND, INDICES, WEIGHTS, &geom_bind]) },
            [100.0, 155.0, 3.0],
            [110.0, 155.0, 3.0],
        ),
        (
            "a list of targets",
            Rig::saying(&["prepend rel skel:skeleton = [</char/rig>]", INDICES, WEIGHTS]),
            there,
            gone,
        ),
        ("a relative target", Rig::saying(&["rel skel:skeleton = <../rig>", INDICES, WEIGHTS]), there, gone),
        (
            "by point",
            Rig::saying(&[
                BOND,
                "int[] primvars:skel:jointIndices = [0, 1, 0, 1, 0, 1] ( elementSize = 2 interpolation = \"vertex\" )",
                "float[] primvars:skel:jointWeights = [0.5, 0.5, 0, 1, 1, 0] ( elementSize = 2 interpolation = \"vertex\" )",
            ]),
            there,
            gone,
        ),
        // Weights are not made to sum up to 1.
        (
            "half",
            Rig::saying(&[BOND, INDICES, &WEIGHTS.replace("[1]", "[0.5]")]),
            [100.0, 77.5, 0.0],
            [105.0, 77.5, 0.0],
        ),
        ("an index that is no joint", Rig::saying(&[BOND, &INDICES.replace("[1]", "[5]"), WEIGHTS]), there, there),
        ("the head at rest", rest(of_hips), [100.0, 160.0, 5.0], [110.0, 160.0, 5.0]),
        ("all at rest", Rig { of_skeleton: "{".to_owned(), ..rest(of_hips) }, [100.0, 160.0, 5.0], [100.0, 160.0, 5.0]),
        ("a source without its schema", Rig { of_skeleton: format!("{{ {SOURCE}"), ..Rig::default() }, there, there),
        (
            "a source from above",
            Rig { of_root: format!("{API} {{ {SOURCE}"), of_skeleton: "{".to_owned(), ..Rig::default() },
            there,
            gone,
        ),
        (
            "too few places",
            Rig { animation: Rig::default().animation.replace(", (0, 65, 0)", ""), ..Rig::default() },
            there,
            there,
        ),
    ] {
        check(what, &rig, first, last);
        let mut stage = reader(&rig.text(true));
        let said = stage.hair(0, None).unwrap().attributes;
        assert!(said.unread.iter().all(|line| !line.contains("skel:skeleton")), "{what}: {:?}", said.unread);
        assert!(said.other.iter().all(|other| !other.name.starts_with("skel:")), "{what}");
    }
}

#[test]
fn what_is_not_wholly_bound_stands_where_its_prim_has_it() {
    for (what, rig) in [
        ("no schema", Rig { api: "", ..Rig::default() }),
        ("no skeleton root", Rig { root: "Xform", ..Rig::default() }),
        ("no indices", Rig::saying(&[BOND, WEIGHTS])),
        ("no weights", Rig::saying(&[BOND, INDICES])),
        ("no skeleton", Rig::saying(&[INDICES, WEIGHTS])),
        (
            "blocked",
            Rig { of_root: format!("{API} {{ {BOND}"), ..Rig::saying(&["rel skel:skeleton = None", INDICES, WEIGHTS]) },
        ),
        ("no such skeleton", Rig::saying(&["rel skel:skeleton = </char/nix>", INDICES, WEIGHTS])),
        (
            "the first of two targets",
            Rig::saying(&["rel skel:skeleton = [</char/nix>, </char/rig>]", INDICES, WEIGHTS]),
        ),
        ("from above without a schema", Rig { of_root: format!("{{ {BOND}"), ..Rig::saying(&[INDICES, WEIGHTS]) }),
        (
            "too few for the points",
            Rig::saying(&[
                BOND,
                "int[] primvars:skel:jointIndices = [1, 0] ( elementSize = 2 interpolation = \"vertex\" )",
                "float[] primvars:skel:jointWeights = [1, 1] ( elementSize = 2 interpolation = \"vertex\" )",
            ]),
        ),
    ] {
        check(what, &rig, [107.0, 155.0, 0.0], [107.0, 155.0, 0.0]);
    }
}

#[test]
fn binary_layers_are_bound_as_text_is() {
    let open =
        |name: &str| StageReader::open(&Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/files").join(name)).unwrap();
    let [mut text, mut binary] = ["rig.usda", "rig.usdc"].map(open);
    for (name, stage) in [("text", &mut text), ("binary", &mut binary)] {
        let head = stage.mesh().unwrap().positions;
        for (found, expected) in head.iter().zip([[100.0, 155.0, 0.0], [96.25, 156.25, 0.0], [100.0, 159.0, 0.0]]) {
            is_near(*found, expected, name);
        }
        for (frame, tip) in [(0, [95.0, 155.0, 0.0]), (5, [101.4645, 158.5355, 0.0]), (10, [110.0, 160.0, 0.0])] {
            let hair = stage.hair(frame, None).unwrap();
            is_near(hair.strands.strand(0)[1], tip, &format!("{name}, frame {frame}"));
        }
        assert_eq!(stage.contents().unwrap().times.len(), 11, "{name}");
        assert_eq!(stage.joint_of_meshes(&|_| true).unwrap().as_deref(), Some("/char/rig/hips/head"), "{name}");
        let said = "how joints bend /char/head: it keeps the shape of the first frame";
        assert_eq!(stage.mesh_unread().unwrap(), [said], "{name}");
    }
    assert_eq!(text.motion("head").unwrap(), binary.motion("head").unwrap());
    assert_eq!(text.hair(3, None).unwrap(), binary.hair(3, None).unwrap());
}

/// Hair that is not bound was groomed on the head of the first frame or on that which was bound, and is not in the layer where it was
/// groomed elsewhere.
#[test]
fn a_head_stands_in_the_pose_on_which_its_hair_was_groomed() {
    let turned = |hair: &str| {
        let rig =
            Rig { animation: Rig::default().animation.replace("1: [(0, 90, 0)", "1: [(30, 90, 0)"), ..Rig::default() };
        rig.text(false).trim_end().trim_end_matches('}').to_owned() + hair + "}\n"
    };
    let hair = |x: f32, more: &str| {
        format!(
            "def BasisCurves \"hair\" {{ uniform token type = \"linear\"\n int[] curveVertexCounts = [2]\n\
             point3f[] points = [({x}, 158, 0), ({x}, 168, 0)]\n {more} }}\n"
        )
    };
    let moving = "point3f[] points.timeSamples = { 1: [(0, 158, 0), (0, 168, 0)], 2: [(1, 158, 0), (1, 168, 0)] }";
    for (hair, at, from_bound) in [
        (hair(0.0, ""), 100.0, true),
        (hair(30.0, ""), 130.0, false),
        // Hair that moves is that of the stage.
        (hair(0.0, "").replace("point3f[] points = [(0, 158, 0), (0, 168, 0)]", moving), 130.0, false),
        (String::new(), 100.0, true),
    ] {
        let mut stage = reader(&turned(&hair));
        is_near(stage.mesh().unwrap().positions[0], [at, 155.0, 0.0], &hair);
        // The joint carries the head on from there.
        let (bound, first) = (stage.bound("head").unwrap().unwrap(), stage.motion("head").unwrap()[0]);
        assert!((bound.position - first.position).length() < if from_bound { 31.0 } else { 1e-9 }, "{hair}");
        is_near(bound.position.as_vec3(), [at, 155.0, 0.0], &hair);
    }
}

#[test]
fn the_joint_that_carries_a_head_is_named_head_or_else_holds_most_of_it() {
    let joint = |joints: &str, indices: &str, weights: &str| {
        let values =
            |what: &str, values: &str| format!("{what} = {values} ( elementSize = 1 interpolation = \"vertex\" )");
        let rig = Rig::saying(&[
            BOND,
            &values("int[] primvars:skel:jointIndices", indices),
            &values("float[] primvars:skel:jointWeights", weights),
        ]);
        reader(&rig.text(true).replace("\"hips\", \"hips/head\"", joints)).joint_of_meshes(&|_| true).unwrap()
    };
    let found = |path: &str| Some(format!("/char/rig/{path}"));
    assert_eq!(joint("\"hips\", \"hips/Head\"", "[0, 0, 1]", "[1, 1, 1]"), found("hips/Head"));
    assert_eq!(joint("\"hips\", \"hips/rig_head\"", "[0, 0, 1]", "[1, 1, 1]"), found("hips/rig_head"));
    assert_eq!(joint("\"hips\", \"hips/skull\"", "[0, 0, 1]", "[1, 1, 1]"), found("hips"));
    assert_eq!(joint("\"hips\", \"hips/skull\"", "[0, 1, 1]", "[1, 1, 1]"), found("hips/skull"));
    // A joint without a part in it is none.
    assert_eq!(joint("\"hips\", \"hips/head\"", "[0, 0, 1]", "[1, 1, 0]"), found("hips"));
    let unbound = Rig { api: "", ..Rig::default() };
    assert_eq!(reader(&unbound.text(true)).joint_of_meshes(&|_| true).unwrap(), None);
}

#[test]
fn joints_are_read_once_however_many_prims_hang_on_them() {
    // A name for each prim would be nine million of them.
    let (prims, joints) = (3000, 3000);
    let names: Vec<String> = (0..joints).map(|i| format!("\"k{i}\"")).collect();
    let places = vec![place(0.0, 0.0, 0.0); joints].join(", ");
    let mut text = format!(
        "def SkelRoot \"char\" {{ def Skeleton \"rig\" {{ uniform token[] joints = [{}]\n\
         uniform matrix4d[] bindTransforms = [{places}]\n uniform matrix4d[] restTransforms = [{places}] }}\n",
        names.join(", ")
    );
    for i in 0..prims {
        let (index, kind) = (INDICES, if i % 2 == 0 { "BasisCurves" } else { "Mesh" });
        let faces = "int[] faceVertexCounts = [3]\n int[] faceVertexIndices = [0, 1, 2]";
        let curves = "uniform token type = \"linear\"\n int[] curveVertexCounts = [3]";
        text += &format!(
            "def {kind} \"p{i}\" {API} {{ point3f[] points = [(0, 155, 0), (0, 160, 0), (1, 155, 0)]\n {} {BOND}\n {index}\n {WEIGHTS} }}\n",
            if i % 2 == 0 { curves } else { faces }
        );
    }
    let mut stage = reader(&(text + "}\n"));
    assert_eq!(stage.hair_in_place(0, None, true).unwrap().hair.strands.len(), prims / 2);
    assert_eq!(stage.meshes_with_losses(&|_| true).unwrap().0.triangles.len(), prims / 2);
    assert_eq!(stage.prims().unwrap().len(), prims + 2);
}

#[test]
fn joints_that_are_to_be_blended_otherwise_are_said() {
    let indices = "int[] primvars:skel:jointIndices = [0, 1] ( elementSize = 2 interpolation = \"constant\" )";
    let weights = "float[] primvars:skel:jointWeights = [0.5, 0.5] ( elementSize = 2 interpolation = \"constant\" )";
    for (method, expected) in [("dualQuaternion", 1), ("classicLinear", 0)] {
        let method = format!("uniform token primvars:skel:skinningMethod = \"{method}\"");
        let mut stage = reader(&Rig::saying(&[BOND, indices, weights, &method]).text(true));
        let said = stage.hair(0, None).unwrap().attributes.unread;
        let count =
            |said: &[String]| said.iter().filter(|line| line.starts_with("skel:skinningMethod of /char/")).count();
        assert_eq!((count(&said), count(&stage.mesh_unread().unwrap())), (expected, expected), "{method}: {said:?}");
    }
}

/// Joints bend a mesh after its blend shapes: as usd-core bakes it.
#[test]
fn a_mesh_bends_by_its_joints_and_blend_shapes() {
    let rig = Rig {
        animation: "uniform token[] joints = [\"hips\", \"hips/head\"]\n uniform token[] blendShapes = [\"smile\", \"frown\"]\n\
                    float3[] translations.timeSamples = { 1: [(0, 90, 0), (0, 65, 0)], 11: [(10, 90, 0), (0, 75, 0)] }\n\
                    float[] blendShapeWeights.timeSamples = { 3: [0, 9], 13: [1, 9] }\n\
                    quatf[] rotations = [(1, 0, 0, 0), (1, 0, 0, 0)]\n half3[] scales = [(1, 1, 1), (1, 1, 1)]"
            .to_owned(),
        own: [
            BOND,
            "int[] primvars:skel:jointIndices = [0, 1, 0, 1, 0, 1] ( elementSize = 2 interpolation = \"vertex\" )",
            "float[] primvars:skel:jointWeights = [1, 0, 0.5, 0.5, 0, 1] ( elementSize = 2 interpolation = \"vertex\" )",
            "uniform token[] skel:blendShapes = [\"smile\"]\n rel skel:blendShapeTargets = </char/head/smile>\n\
             def BlendShape \"smile\" { uniform vector3f[] offsets = [(0, 0, 2)]\n uniform int[] pointIndices = [1] }",
        ]
        .map(str::to_owned)
        .to_vec(),
        ..Rig::default()
    };
    let mut stage = reader(&rig.text(false));
    let codes = [1.0, 3.0, 11.0, 13.0].map(|code: f64| code / 24.0);
    assert_eq!(stage.bending_times(&|_| true).unwrap(), codes);
    assert!(stage.bending_times(&|mesh| mesh == "/none").unwrap().is_empty());
    for (code, expected) in [
        (1.0, [[100.0, 155.0, 0.0], [100.0, 160.0, 0.0], [101.0, 155.0, 0.0]]),
        (11.0, [[110.0, 155.0, 0.0], [110.0, 165.0, 1.6], [111.0, 165.0, 0.0]]),
        (13.0, [[110.0, 155.0, 0.0], [110.0, 165.0, 2.0], [111.0, 165.0, 0.0]]),
    ] {
        let found = stage.bent_meshes(&|_| true, code / 24.0).unwrap();
        found.into_iter().zip(expected).for_each(|(found, expected)| is_near(found, expected, &format!("code {code}")));
    }
    // What moves it lasts as long as its skin bends.
    assert_eq!(stage.motion("/char/head").unwrap().last().unwrap().time, 13.0 / 24.0, "as long as its shapes change");
}

#[test]
fn a_mesh_whose_points_move_bends_between_its_samples() {
    let mesh = "def Mesh \"face\" { int[] faceVertexCounts = [3]\n int[] faceVertexIndices = [0, 1, 2]\n\
                point3f[] points.timeSamples = { 0: [(0, 0, 0), (1, 0, 0), (0, 1, 0)], 4: [(0, 0, 8), (1, 0, 0), (0, 1, 0)] } }";
    let mut stage = reader(mesh);
    assert_eq!(stage.bending_times(&|_| true).unwrap(), [0.0, 4.0 / 24.0]);
    is_near(stage.bent_meshes(&|_| true, 3.0 / 24.0).unwrap()[0], [0.0, 0.0, 6.0], "three quarters of the way");
    assert_eq!(stage.motion("/face").unwrap().len(), 5, "a frame for each code");
}
