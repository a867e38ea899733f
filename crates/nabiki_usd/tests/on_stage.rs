//! What of a layer is on its stage and shows, and what is said of the rest.

use std::io::Cursor;

use nabiki_exchange::{GroomReader, PrimKind};
use nabiki_usd::StageReader;

fn reader(text: &str) -> StageReader {
    StageReader::new(Cursor::new(format!("#usda 1.0\n{text}").into_bytes())).unwrap()
}

/// A closed mesh of four vertices, with something else said of it.
fn mesh(name: &str, more: &str) -> String {
    format!(
        "def Mesh \"{name}\" {{ point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]\n\
         int[] faceVertexCounts = [3, 3, 3, 3]\n int[] faceVertexIndices = [0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3]\n{more} }}\n"
    )
}

/// A curve of two points, with something else said of it.
fn curve(name: &str, more: &str) -> String {
    format!(
        "def BasisCurves \"{name}\" {{ uniform token type = \"linear\"\n int[] curveVertexCounts = [2]\n\
         point3f[] points = [(0, 0, 0), (1, 0, 0)]\n{more} }}\n"
    )
}

/// How many such curves are read, and what is said of them.
fn curves(text: &str) -> (usize, Vec<String>) {
    let hair = reader(text).hair(0, None).unwrap();
    (hair.strands.len(), hair.attributes.unread)
}

/// How many such meshes are read, and what is said of them.
fn meshes(text: &str) -> (usize, Vec<String>) {
    let mut stage = reader(text);
    (stage.mesh().unwrap().positions.len() / 4, stage.mesh_unread().unwrap())
}

#[test]
fn meshes_that_do_not_show_are_left_out_beside_those_that_do_and_that_is_said() {
    let head = mesh("head", "uniform token purpose = \"render\"");
    assert_eq!(meshes(&head), (1, Vec::new()));
    for (mark, value) in
        [("uniform token purpose", "proxy"), ("uniform token purpose", "guide"), ("token visibility", "invisible")]
    {
        let name = mark.rsplit(' ').next().unwrap();
        let own = mesh("other", &format!("{mark} = \"{value}\""));
        let said = format!("mesh /other, which is hidden: {name} of /other is \"{value}\"");
        assert_eq!(meshes(&format!("{head}{own}")), (1, vec![said]));
        let above = format!("def Xform \"a\" {{ {mark} = \"{value}\"\n {} }}\n", mesh("b", ""));
        let said = format!("mesh /a/b, which is hidden: {name} of /a is \"{value}\"");
        assert_eq!(meshes(&format!("{above}{head}")), (1, vec![said]));
        // Alone it is the head.
        assert_eq!(meshes(&own), (1, vec![format!("{name} of /other, which is \"{value}\"")]));
    }
    // The nearest purpose holds; an invisible prim hides whatever is below it.
    let nearest = format!(
        "def Xform \"a\" {{ uniform token purpose = \"guide\"\n {} }}\n",
        mesh("b", "uniform token purpose = \"default\"")
    );
    assert_eq!(meshes(&format!("{nearest}{head}")), (2, Vec::new()));
    let hidden = format!(
        "def Xform \"a\" {{ token visibility = \"invisible\"\n {} }}\n",
        mesh("b", "token visibility = \"inherited\"")
    );
    assert_eq!(meshes(&format!("{hidden}{head}")).0, 1);
    // Neither says anything on a prim without a type.
    let untyped = format!("def \"a\" {{ token visibility = \"invisible\"\n {} }}\n", mesh("b", ""));
    assert_eq!(meshes(&format!("{untyped}{head}")), (2, Vec::new()));
}

#[test]
fn holes_and_meshes_invisible_at_times_are_kept_and_said() {
    let holed = mesh(
        "head",
        "int[] holeIndices = [1, 3]\n token visibility.timeSamples = { 1: \"invisible\", 5: \"inherited\" }",
    );
    let said = [
        "holeIndices of /head: the 2 faces they remove are kept",
        "visibility of /head, which is \"invisible\" at some frames",
    ];
    assert_eq!(meshes(&format!("{holed}{}", mesh("neck", ""))), (2, said.map(str::to_owned).to_vec()));
    let never = mesh("ghost", "token visibility.timeSamples = { 1: \"invisible\", 5: \"invisible\" }");
    assert_eq!(meshes(&format!("{never}{}", mesh("head", ""))).0, 1);
}

#[test]
fn curves_that_do_not_show_are_read_and_that_is_said_once() {
    let below = |mark: &str| format!("def Xform \"a\" {{ {mark}\n {}{} }}\n", curve("h", ""), curve("i", ""));
    for (mark, said) in [
        ("token visibility = \"invisible\"", "visibility of /a, which is \"invisible\""),
        ("uniform token purpose = \"guide\"", "purpose of /a, which is \"guide\""),
        (
            "token visibility.timeSamples = { 1: \"inherited\", 5: \"invisible\" }",
            "visibility of /a, which is \"invisible\" at some frames",
        ),
    ] {
        assert_eq!(curves(&below(mark)), (2, vec![said.to_owned()]));
    }
    let nearest = format!(
        "def Xform \"a\" {{ uniform token purpose = \"guide\"\n {} }}\n",
        curve("h", "uniform token purpose = \"render\"")
    );
    assert_eq!(curves(&nearest), (1, Vec::new()));
}

#[test]
fn shapes_that_are_not_read_are_said_beside_curves_and_refused_alone() {
    let others = "def NurbsCurves \"n\" { }\n def NurbsCurves \"m\" { }\n def Points \"dust\" { }\n";
    let said = ["NurbsCurves /n, and 1 more: only BasisCurves are read", "Points /dust: only BasisCurves are read"];
    assert_eq!(curves(&format!("{}{others}", curve("h", ""))), (1, said.map(str::to_owned).to_vec()));
    let refused = reader(others).hair(0, None).unwrap_err().to_string();
    assert_eq!(refused, "has NurbsCurves, but nabiki reads only BasisCurves: convert them");
}

const FLATTEN: &str = "flatten it first (usdcat --flatten IN -o OUT)";

#[test]
fn what_comes_by_arcs_is_said_in_one_line() {
    let own = curve("own", "");
    for (arc, line) in [
        ("references = @r.usda@", Some("references of /a")),
        ("prepend references = [ @r.usda@</x> ( offset = 10 ), </own> ]", Some("references of /a")),
        ("payload = @p.usda@", Some("payload of /a")),
        ("prepend inherits = </own>", Some("inherits of /a")),
        ("specializes = </own>", Some("specializes of /a")),
        ("prepend variantSets = \"style\"", Some("variantSets of /a")),
        ("clips = { dictionary default = { asset[] assetPaths = [@c.usda@] } }", Some("clips of /a")),
        ("references = None", None),
        ("references = [ ]", None),
        ("delete references = @r.usda@", None),
        ("customData = { string references = \"none\" }", None),
        ("references = @r.usda@\n active = false", None),
    ] {
        let (count, unread) = curves(&format!("{own}def Xform \"a\" ( {arc} ) {{ }}\n"));
        let said: Vec<String> = line.iter().map(|line| format!("what comes by {line}: {FLATTEN}")).collect();
        assert_eq!((count, unread), (1, said), "{arc}");
    }
    let two = "( subLayers = [ @s.usda@ ] )\ndef Xform \"a\" ( references = @r.usda@ ) { }\n";
    let said = format!("what comes by subLayers of the layer, and by 1 more of its arcs: {FLATTEN}");
    assert_eq!(curves(&format!("{two}{own}")), (1, vec![said.clone()]));
    assert_eq!(curves(&format!("( subLayers = [] )\n{own}")), (1, Vec::new()));
    assert_eq!(meshes(&format!("{two}{}", mesh("head", ""))), (1, vec![said]));
    let refused = reader(two).mesh().unwrap_err().to_string();
    assert_eq!(refused, format!("has no meshes: if they come by reference, {FLATTEN}"));
}

/// The second is the first as usd-core exports it. Variants hold curves, which are on no stage by themselves.
#[test]
fn arcs_and_variants_are_alike_in_text_and_in_binary() {
    for name in ["composed.usda", "composed.usdc"] {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/files").join(name);
        let mut stage = StageReader::open(&path).unwrap();
        assert_eq!(stage.contents().unwrap().curves, ["/own"], "{name}");
        let said = format!("what comes by subLayers of the layer, and by 5 more of its arcs: {FLATTEN}");
        assert_eq!(stage.hair(0, None).unwrap().attributes.unread, [said], "{name}");
    }
}

#[test]
fn what_is_empty_is_left_out_beside_what_is_not() {
    let (empty, hair) = ("def BasisCurves \"e\" { }\n", curve("h", ""));
    for text in [format!("{empty}{hair}"), format!("{hair}{empty}")] {
        assert_eq!(curves(&text), (1, vec!["curves /e: no points".to_owned()]));
        assert_eq!(reader(&text).contents().unwrap().curves, ["/h"]);
    }
    assert_eq!(reader(empty).hair(0, None).unwrap_err().to_string(), "curves /e: have no points");
    let (empty, head) = ("def Mesh \"e\" { }\n", mesh("head", ""));
    for text in [format!("{empty}{head}"), format!("{head}{empty}")] {
        assert_eq!(meshes(&text), (1, vec!["mesh /e: no points".to_owned()]));
    }
    assert_eq!(reader(empty).contents().unwrap().meshes, [""; 0]);
    assert_eq!(reader(empty).mesh().unwrap_err().to_string(), "mesh /e: has no points");
}

#[test]
fn an_over_without_a_def_is_not_on_the_stage() {
    let curves_of = |name: &str| curve(name, "").replace("def ", "over ");
    assert_eq!(curves(&format!("{}{}", curve("h", ""), curves_of("o"))), (1, Vec::new()));
    assert_eq!(curves(&format!("{}over \"a\" {{ {} }}\n", curve("h", ""), curve("i", ""))), (1, Vec::new()));
    let head = mesh("head", "");
    assert_eq!(meshes(&format!("{head}{}", mesh("o", "").replace("def ", "over "))), (1, Vec::new()));
    let refused = reader(&curves_of("o")).hair(0, None).unwrap_err().to_string();
    let why = "an over defines nothing by itself: give the layer that defines it";
    assert_eq!(refused, format!("curves /o: {why}, or {FLATTEN}"));
    // What another layer may define comes by its arcs.
    let arc = format!("{}over \"a\" ( references = @r.usda@ ) {{ }}\n", curve("h", ""));
    assert_eq!(curves(&arc), (1, vec![format!("what comes by references of /a: {FLATTEN}")]));
}

#[test]
fn splines_are_refused_as_such_in_transforms_and_said_elsewhere() {
    let spline = "{\n 0: 0; pre (0, 0); post held,\n 10: 90; post held,\n }";
    let turned = |more: &str| {
        let order = "uniform token[] xformOpOrder = [\"xformOp:rotateX\"]";
        format!(
            "def Xform \"a\" {{ float xformOp:rotateX.spline = {spline}\n {more}\n {order}\n {} }}\n",
            curve("h", "")
        )
    };
    let why = "prim /a: xformOp:rotateX is a spline, which is not read: bake it to time samples";
    for more in ["", "float xformOp:rotateX = 3"] {
        assert_eq!(reader(&turned(more)).hair(0, None).unwrap_err().to_string(), why);
    }
    // Samples win over a spline, as USD has it.
    assert_eq!(curves(&turned("float xformOp:rotateX.timeSamples = { 0: 3 }")), (1, Vec::new()));
    let (count, unread) = curves(&curve("h", &format!("float primvars:x = 3\n float primvars:x.spline = {spline}")));
    assert!(count == 1 && unread.contains(&"the spline of primvars:x".to_owned()), "{unread:?}");
}

#[test]
fn closed_curves_are_left_out_beside_hair_and_that_is_said() {
    let rein = curve("rein", "uniform token wrap = \"periodic\"");
    let said = "curves /rein, which are closed: hair is open".to_owned();
    assert_eq!(curves(&format!("{rein}{}", curve("mane", ""))), (1, vec![said]));
    let mut both = reader(&format!("{rein}{}", curve("mane", "")));
    assert_eq!(both.contents().unwrap().curves, ["/mane"]);
    assert_eq!(both.prims().unwrap()[0].kind, PrimKind::Other("BasisCurves (closed)".to_owned()));
    let refused = reader(&rein).hair(0, None).unwrap_err().to_string();
    assert_eq!(refused, "curves /rein: are closed, but hair is open: export them as open (nonperiodic) curves");
}

#[test]
fn of_meshes_those_are_read_that_are_wanted() {
    let text = format!("{}{}", mesh("beast", ""), mesh("ground", "uniform token purpose = \"proxy\""));
    let mut stage = reader(&text);
    let ground = |path: &str| path == "/ground";
    assert_eq!(stage.meshes(&|path| path == "/beast").unwrap().positions.len(), 4);
    assert_eq!(stage.meshes_unread(&|path| path == "/beast").unwrap(), [""; 0]);
    assert_eq!(stage.meshes(&ground).unwrap().positions.len(), 4, "nothing else of what is wanted shows");
    assert_eq!(stage.meshes_unread(&ground).unwrap(), ["purpose of /ground, which is \"proxy\""]);
}

#[test]
fn that_a_mesh_bends_is_said() {
    let points = "point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]";
    let still = mesh("beast", "");
    let moving = still.replace(
        points,
        "point3f[] points.timeSamples = { 1: [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], \
        2: [(0, 0, 0), (2, 0, 0), (0, 1, 0), (0, 0, 1)] }",
    );
    let said = "the motion of the points of /beast: it keeps the shape of the first frame".to_owned();
    assert_eq!(meshes(&moving), (1, vec![said]));
    let bound = mesh("beast", "rel skel:skeleton = </bones>");
    let said = "skel:skeleton of /beast: it keeps the shape of its own points".to_owned();
    assert_eq!(meshes(&bound), (1, vec![said]));
}

#[test]
fn a_head_whose_texture_coordinates_are_none_keeps_its_shape_and_that_is_said() {
    let four = "[(0, 0), (1, 0), (0, 1), (1, 1)]";
    let vertex = "( interpolation = \"vertex\" )";
    for (more, why) in [
        (
            format!("texCoord2f[] primvars:st = {four} {vertex}\n int[] primvars:st:indices = []"),
            "its list of indices is empty",
        ),
        (
            format!("texCoord2f[] primvars:st = {four} {vertex}\n int[] primvars:st:indices = [0, 1, 2, 4]"),
            "some of its indices name no value",
        ),
        (
            format!("texCoord2f[] primvars:st = {four} {vertex}\n int[] primvars:st:indices = [0, 1, -1, 2]"),
            "some of its indices name no value",
        ),
        (
            "texCoord2f[] primvars:st = [(0, 0), (1, 1)] ( interpolation = \"faceVarying\" )".to_owned(),
            "2 for 12 corners",
        ),
        (format!("texCoord2f[] primvars:st = [(0, 0)] {vertex}"), "1 for 4 vertices"),
        (
            format!("texCoord2f[] primvars:st = [(0, 0), (1, 0), (0, nan), (1, 1)] {vertex}"),
            "number 2 is (0, NaN), which is not finite",
        ),
        (
            format!("token[] primvars:st = [\"a\", \"b\", \"c\", \"d\"] {vertex}"),
            "they are not pairs of numbers (token)",
        ),
        (format!("float[] primvars:st = [0, 1, 2, 3] {vertex}"), "they are not pairs of numbers (float)"),
        (format!("texCoord2f[] primvars:st = [] {vertex}"), "they are not pairs of numbers (texCoord2f)"),
        (
            format!("texCoord2f[] primvars:st = {four} ( interpolation = \"uniform\" )"),
            "they belong to faces, not to points",
        ),
    ] {
        let (found, losses) = reader(&mesh("head", &more)).meshes_with_losses(&|_| true).unwrap();
        assert_eq!((found.triangles.len(), found.corner_uvs), (4, None), "{more}");
        assert_eq!(losses, [format!("texture coordinates of /head: {why}")], "{more}");
    }
    let whole = format!("texCoord2f[] primvars:st = {four} {vertex}\n int[] primvars:st:indices = [3, 2, 1, 0]");
    let (found, losses) = reader(&mesh("head", &whole)).meshes_with_losses(&|_| true).unwrap();
    assert!(found.corner_uvs.is_some_and(|uvs| uvs[0][0] == glam::Vec2::ONE) && losses.is_empty());
}

#[test]
fn numbers_and_colours_of_vertices_and_corners_are_weights() {
    let corners = "[1, 0.5, 0.25, 9, 9, 0, 9, 9, 9, 9, 9, 9] ( interpolation = \"faceVarying\" )";
    let more = format!(
        "float[] primvars:fringe = [0, 0.25, 0.5, 1] ( interpolation = \"vertex\" )\n\
         float[] primvars:corners = {corners}\n\
         int[] primvars:part = [3, 7] ( interpolation = \"varying\" )\n int[] primvars:part:indices = [0, 1, 1, 0]\n\
         color3f[] primvars:displayColor = [(1, 1, 1), (0, 1, 0), (0, 0, 0), (1, 1, 1)] ( interpolation = \"vertex\" )\n\
         color4f[] primvars:Cd = [(1, 1, 1, 0.5)] ( interpolation = \"constant\" )\n\
         normal3f[] primvars:normals = [(0, 0, 1), (0, 0, 1), (0, 0, 1), (0, 0, 1)] ( interpolation = \"vertex\" )\n\
         float[] primvars:short = [1, 0] ( interpolation = \"vertex\" )\n\
         string[] primvars:word = [\"a\", \"b\", \"c\", \"d\"] ( interpolation = \"vertex\" )\n"
    );
    let (found, losses) = reader(&mesh("head", &more)).meshes_with_losses(&|_| true).unwrap();
    let of = |name: &str| found.weights_named(name).map(|weights| weights.values.clone());
    assert_eq!(found.weight_names().collect::<Vec<_>>(), ["corners", "displayColor", "fringe", "part"]);
    assert_eq!(of("fringe"), Some(vec![0.0, 0.25, 0.5, 1.0]));
    // The corners name the vertices 0, 2, 1, 0, 1, 3 and so on.
    assert_eq!(of("corners"), Some(vec![1.0, 0.25, 0.5, 0.0]));
    assert_eq!(of("part"), Some(vec![3.0, 7.0, 7.0, 3.0]));
    assert_eq!(of("displayColor"), Some(vec![1.0, 0.7152, 0.0, 1.0]));
    assert_eq!(of("displayColor.g"), Some(vec![1.0, 1.0, 0.0, 1.0]));
    assert_eq!(losses, ["short of /head: 2 for 4 vertices"]);
}

#[test]
fn curves_of_types_that_are_not_read_are_said_beside_those_that_are() {
    for kind in ["NurbsCurves", "HermiteCurves"] {
        let other = curve("n", "").replace("BasisCurves", kind);
        let said = format!("{kind} /n: only BasisCurves are read");
        assert_eq!(curves(&format!("{}{other}", curve("h", ""))), (1, vec![said]));
        let refused = reader(&other).hair(0, None).unwrap_err().to_string();
        assert_eq!(refused, format!("has {kind}, but nabiki reads only BasisCurves: convert them"));
        let off = format!("over \"o\" {{ {other} }}\n");
        assert_eq!(curves(&format!("{}{off}", curve("h", ""))), (1, Vec::new()));
    }
}

#[test]
fn prototypes_of_a_point_instancer_are_left_out_and_that_is_said() {
    let instancer = |below: &str| format!("def PointInstancer \"i\" {{ def Scope \"p\" {{ {below} }} }}\n");
    let said = "the prototypes of PointInstancer /i, drawn only at its instances: turn these into prims first";
    let two = instancer(&format!("{}{}", curve("a", ""), curve("b", "")));
    assert_eq!(curves(&format!("{}{two}", curve("h", ""))), (1, vec![said.to_owned()]));
    assert_eq!(reader(&two).hair(0, None).unwrap_err().to_string(), format!("has no BasisCurves except {said}"));
    let ball = instancer(&mesh("m", ""));
    assert_eq!(meshes(&format!("{}{ball}", mesh("head", ""))), (1, vec![said.to_owned()]));
    assert_eq!(reader(&ball).mesh().unwrap_err().to_string(), format!("has no meshes except {said}"));
    // What is not asked for is not missed.
    let mut both = reader(&format!("{}{ball}", mesh("head", "")));
    assert_eq!(both.meshes_unread(&|path| path == "/head").unwrap(), [""; 0]);
    let kinds: Vec<PrimKind> = reader(&two).prims().unwrap().into_iter().map(|prim| prim.kind).collect();
    let drawn =
        |kind: &PrimKind| matches!(kind, PrimKind::Other(what) if what.contains("where its point instancer has"));
    assert_eq!(kinds.iter().filter(|kind| drawn(kind)).count(), 3, "{kinds:?}");
}

#[test]
fn instances_are_told_how_to_be_flattened() {
    let way_out = "turn off instanceable on its prims, then flatten it (usdcat --flatten IN -o OUT)";
    let instance = |more: &str| format!("def Xform \"a\" ( {more} references = @r.usda@ ) {{ }}\n");
    let said = |way_out: &str| vec![format!("what comes by references of /a: {way_out}")];
    assert_eq!(curves(&format!("{}{}", curve("h", ""), instance("instanceable = true"))), (1, said(way_out)));
    assert_eq!(curves(&format!("{}{}", curve("h", ""), instance("instanceable = false"))), (1, said(FLATTEN)));
    let refused = reader(&instance("instanceable = true")).hair(0, None).unwrap_err().to_string();
    assert_eq!(refused, format!("has no BasisCurves: if they come by reference, {way_out}"));
    // As USD's own flattening writes them.
    let flat = format!("over \"Flattened_Prototype_1\" {{ {} }}\n{}", curve("h", ""), instance("instanceable = true"));
    let refused = reader(&flat).hair(0, None).unwrap_err().to_string();
    assert_eq!(
        refused,
        "curves /Flattened_Prototype_1/h: are a prototype of instances: turn off instanceable on the instances, then flatten the \
         layer (usdcat --flatten IN -o OUT)"
    );
}

#[test]
fn curves_that_are_no_strands_are_left_out_with_what_they_carry_and_counted() {
    for (counts, kind) in [("[1, 3, 0, 2]", "linear"), ("[1, 4, 0, 5]", "cubic")] {
        let points = if kind == "linear" { 6 } else { 10 };
        let places = (0..points).map(|i| format!("({i}, 0, 0)")).collect::<Vec<_>>().join(", ");
        let text = format!(
            "def BasisCurves \"h\" {{ uniform token type = \"{kind}\"\n uniform token basis = \"bspline\"\n\
             int[] curveVertexCounts = {counts}\n point3f[] points = [{places}]\n\
             int[] primvars:groom_id = [4, 5, 6, 7] ( interpolation = \"uniform\" ) }}\n"
        );
        let hair = reader(&text).hair(0, None).unwrap();
        assert_eq!((hair.strands.len(), hair.attributes.id), (2, Some(vec![5, 7])), "{kind}");
        assert_eq!(hair.attributes.unread, ["2 curves with fewer than two points"], "{kind}");
        let root = if kind == "linear" { 1.0 } else { 2.0 };
        assert_eq!(hair.strands.strand(0)[0].x, root, "{kind}");
    }
}

#[test]
fn a_point_that_is_none_is_refused_with_the_prim_that_has_it() {
    let text = curve("h", "").replace("(1, 0, 0)", "(1, nan, 0)");
    let refused = reader(&text).hair(0, None).unwrap_err().to_string();
    assert_eq!(
        refused,
        "curves /h: point 1 is [1, NaN, 0]: must be finite: correct it or remove its curve where the file was made"
    );
}

#[test]
fn widths_that_are_none_are_counted() {
    for (widths, said) in [
        ("-1, nan", Some("2 of 2 widths as diameters: they are below 0 or not finite")),
        ("0.5, -1", Some("1 of 2 widths as diameters: they are below 0 or not finite")),
        ("0, 0", Some("widths as diameters: all are 0")),
        ("0.5, 0", None),
    ] {
        let text = curve("h", &format!("float[] widths = [{widths}] ( interpolation = \"vertex\" )"));
        assert_eq!(curves(&text), (1, said.into_iter().map(str::to_owned).collect()), "{widths}");
    }
}

#[test]
fn a_list_that_fits_nothing_is_said_once() {
    let text = curve("h", "int[] primvars:id = [1, 2, 3] ( interpolation = \"uniform\" )");
    assert_eq!(curves(&text), (1, vec!["id: 3 values for 2 points of 1 curves".to_owned()]));
}
