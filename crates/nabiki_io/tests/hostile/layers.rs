//! Layers, archives and texts of each kind that took gigabytes or minutes, made small.

use super::crate_file::{Layer, Node, Spec, kind};
use super::ogawa::{Archive, CURVES, NONE, XFORM};

/// A name and the bytes of a file.
pub type Made = (&'static str, Vec<u8>);

const CURVES_FIELDS: [&str; 3] = ["points", "curveVertexCounts", "type"];

/// Attributes of curves: their points and counts by what names the values.
fn curves_below(layer: &mut Layer, points: u64, counts: u64) -> Vec<Node> {
    let [name_points, name_counts, name_type] = CURVES_FIELDS.map(|name| layer.token(name));
    let of = |layer: &mut Layer, type_name: &str, value: u64| {
        vec![layer.word_field("typeName", type_name), layer.field("default", value)]
    };
    let linear = u64::from(layer.token("linear"));
    let points = of(layer, "point3f[]", points);
    let counts = of(layer, "int[]", counts);
    let linear = of(layer, "token", kind::INLINED | kind::TOKEN << 48 | linear);
    let attribute = |token, fields| Node { token, spec: Spec::Attribute, fields, below: Vec::new() };
    vec![attribute(name_points, points), attribute(name_counts, counts), attribute(name_type, linear)]
}

/// Binary layers.
pub fn crate_files() -> Vec<Made> {
    let prim = |token, fields: &[u32], below| Node { token, spec: Spec::Prim, fields: fields.to_vec(), below };
    let mut made = Vec::new();

    // Prims that share one name of a megabyte.
    let mut layer = Layer::new();
    let (name, fields) = (layer.token(&"n".repeat(1_000_000)), layer.prim("BasisCurves"));
    made.push(("one_long_name.usdc", layer.finish(vec![prim(name, &fields, Vec::new()); 60_000])));

    // Many below one path that is as long as paths may be.
    let mut layer = Layer::new();
    let (name, fields) = (layer.token(&"n".repeat(1_000)), layer.prim("Xform"));
    let mut below = vec![prim(name, &fields, Vec::new()); 20_000];
    for _ in 0..500 {
        below = vec![prim(name, &fields, below)];
    }
    made.push(("long_path.usdc", layer.finish(below)));

    // Prims in prims, a hundred thousand deep.
    let mut layer = Layer::new();
    let (name, fields) = (layer.token("p"), layer.prim("Xform"));
    let deep = (0..100_000).map(|_| (name as i32, -1, Spec::Prim, fields.clone()));
    let last = (name as i32, -2, Spec::Prim, fields.clone());
    let root = (0, -1, Spec::Layer, Vec::new());
    made.push(("deep.usdc", layer.finish_flat([root].into_iter().chain(deep).chain([last]))));

    // Tables of millions of entries that are all alike.
    let mut layer = Layer::new();
    let (name, fields) = (layer.token("p"), layer.prim("Xform"));
    let many = (0..8_000_000).map(|_| (name as i32, 0, Spec::Prim, fields.clone()));
    let last = (name as i32, -2, Spec::Prim, fields.clone());
    let root = (0, -1, Spec::Layer, Vec::new());
    made.push(("table_of_paths.usdc", layer.finish_flat([root].into_iter().chain(many).chain([last]))));

    // Words without a letter: a hundred million.
    let mut layer = Layer::new();
    layer.words_without_letters(100_000_000);
    made.push(("table_of_tokens.usdc", layer.finish(Vec::new())));

    // Primvars of as many numbers as a file of any size may have, none of which takes room.
    let mut layer = Layer::new();
    let (points, counts) = (layer.points(4), layer.packed(2, 2));
    let counts = counts & !kind::PACKED;
    let mut below = curves_below(&mut layer, points, counts);
    let value = layer.packed(7, 4_000_000);
    let fields = vec![layer.word_field("typeName", "int[]"), layer.field("default", value)];
    for n in 0..80 {
        let token = layer.token(&format!("primvars:p{n}"));
        below.push(Node { token, spec: Spec::Attribute, fields: fields.clone(), below: Vec::new() });
    }
    let (name, fields) = (layer.token("hair"), layer.prim("BasisCurves"));
    made.push(("packed_primvars.usdc", layer.finish(vec![prim(name, &fields, below)])));

    // Meshes of packed faces.
    let mut layer = Layer::new();
    let (points, value) = (layer.points(3), layer.packed(0, 3_000_000));
    let counts = layer.packed(3, 1_000_000);
    let mut below = Vec::new();
    for (name, type_name, value) in
        [("points", "point3f[]", points), ("faceVertexCounts", "int[]", counts), ("faceVertexIndices", "int[]", value)]
    {
        let fields = vec![layer.word_field("typeName", type_name), layer.field("default", value)];
        below.push(Node { token: layer.token(name), spec: Spec::Attribute, fields, below: Vec::new() });
    }
    let (name, fields) = (layer.token("mesh"), layer.prim("Mesh"));
    made.push(("packed_meshes.usdc", layer.finish(vec![prim(name, &fields, below); 20])));

    // Curves that share their points.
    let mut layer = Layer::new();
    let (points, counts) = (layer.points(100_000), layer.packed(2, 50_000));
    let below = curves_below(&mut layer, points, counts);
    let (name, fields) = (layer.token("hair"), layer.prim("BasisCurves"));
    made.push(("shared_points.usdc", layer.finish(vec![prim(name, &fields, below); 2_000])));

    // Attributes that share their time samples.
    let mut layer = Layer::new();
    let count = 20_000u64;
    let times: Vec<u8> =
        [count].into_iter().chain((0..count).map(|n| (n as f64).to_bits())).flat_map(u64::to_le_bytes).collect();
    let times = kind::DOUBLE_VECTOR << 48 | layer.put(&times);
    let value = kind::INLINED | kind::INT << 48 | 1;
    let samples: Vec<u8> =
        [8, times, 8, count].into_iter().chain((0..count).map(|_| value)).flat_map(u64::to_le_bytes).collect();
    let samples = kind::TIME_SAMPLES << 48 | layer.put(&samples);
    let fields = vec![layer.word_field("typeName", "int"), layer.field("timeSamples", samples)];
    let attributes = (0..20_000).map(|n| {
        let token = layer.token(&format!("xformOp:translateX:t{n}"));
        Node { token, spec: Spec::Attribute, fields: fields.clone(), below: Vec::new() }
    });
    let below = attributes.collect();
    let (name, fields) = (layer.token("moved"), layer.prim("Xform"));
    made.push(("shared_samples.usdc", layer.finish(vec![prim(name, &fields, below)])));
    made
}

/// Text layers.
pub fn texts() -> Vec<Made> {
    let mut made = Vec::new();
    let text = |body: String| format!("#usda 1.0\n{body}\n").into_bytes();
    let curves = "def BasisCurves \"h\" { token type = \"linear\"\n int[] curveVertexCounts = [2]\n point3f[] points = [(0,0,0),(1,0,0)] }\n";

    let below = curves.repeat(25_000);
    made.push(("one_long_path.usda", text(format!("def Xform \"{}\" {{\n{below}}}", "n".repeat(1_000_000)))));
    let nested =
        |inside: &str| format!("{}{inside}{}", "def Xform \"nnnnnnnnnnnnnnnnnnnn\" {\n".repeat(500), "}\n".repeat(500));
    made.push(("deep_path.usda", text(nested(&curves.repeat(25_000)))));
    made.push(("smallest_prims.usda", text("def\"a\"{}\n".repeat(700_000))));
    made.push(("smallest_attributes.usda", text("def\"a\"{int a=1}\n".repeat(400_000))));

    // Operations by the hundred thousand, above many curves.
    let operation = |n: usize| format!("double xformOp:translateX:o{n} = 1\n");
    let operations: String = (0..100_000).map(operation).collect();
    let order: Vec<String> = (0..100_000).map(|n| format!("\"xformOp:translateX:o{n}\"")).collect();
    let order = format!("uniform token[] xformOpOrder = [{}]\n", order.join(","));
    let below = curves.repeat(5_000);
    made.push(("operations.usda", text(format!("def Xform \"x\" {{\n{operations}{order}{below}}}"))));
    let some: String = (0..1000).map(operation).collect();
    let order: Vec<String> = (0..1000).map(|n| format!("\"xformOp:translateX:o{n}\"")).collect();
    let order = format!("uniform token[] xformOpOrder = [{}]\n", order.join(","));
    made.push((
        "operations_above_many.usda",
        text(format!("def Xform \"x\" {{\n{some}{order}{}}}", curves.repeat(20_000))),
    ));

    // What all below say again: primvars, relationships, what hides them.
    let primvars: String = (0..20_000).map(|n| format!("int primvars:p{n} = 1\nrel r{n} = </a>\n")).collect();
    made.push(("primvars_above.usda", text(format!("def Xform \"x\" {{\n{primvars}{}}}", curves.repeat(10_000)))));
    let mesh = "def Mesh \"m\" { int[] faceVertexCounts = [3]\n int[] faceVertexIndices = [0,1,2]\n point3f[] points = [(0,0,0),(1,0,0),(0,1,0)] }\n";
    let hidden = "def Xform \"nnnnnnnn\" { token visibility = \"invisible\"\n".repeat(400);
    made.push(("hidden_meshes.usda", text(format!("{hidden}{}{}", mesh.repeat(20_000), "}\n".repeat(400)))));
    let visible: String = (0..100_000).map(|n| format!("{n}: \"inherited\",\n")).collect();
    let above = format!("def Xform \"x\" {{ token visibility.timeSamples = {{\n{visible}}}\n");
    made.push(("visible_at_times.usda", text(format!("{above}{}{}}}", curves.repeat(10_000), mesh.repeat(10_000)))));

    // One prim of very many attributes, and two of the same.
    let attributes: String = (0..30_000).map(|n| format!("int primvars:p{n} = 1\n")).collect();
    let with = |inside: &str| curves.replacen("{ ", &format!("{{ {inside}"), 1);
    made.push(("many_attributes.usda", text(with(&attributes).repeat(2))));
    let word = format!(
        "string[] primvars:w = [\"{}\"] ( interpolation = \"constant\" )\nint[] primvars:w:indices = [{}]\n",
        "w".repeat(100_000),
        "0,".repeat(100_000)
    );
    made.push(("one_word_many_times.usda", text(with(&word))));
    let group = format!(
        "string[] primvars:group_name = [\"{}\"]\nint[] primvars:group = [{}]\n",
        "g".repeat(1_000_000),
        "0,1,2,3,4,5,6,7,8,9,".repeat(1000)
    );
    let many = with(&group)
        .replace("= [2]", &format!("= [{}]", "2,".repeat(10_000)))
        .replace("[(0,0,0),(1,0,0)]", &format!("[{}]", "(0,0,0),(1,0,0),".repeat(10_000)));
    made.push(("one_name_of_many_groups.usda", text(many)));
    made
}

/// Alembic archives.
pub fn archives() -> Vec<Made> {
    let mut made = Vec::new();

    // Each object has the next one twice.
    let mut archive = Archive::new();
    let none = archive.properties(&[]);
    let mut object = archive.object(none, &[]);
    for _ in 0..40 {
        object = archive.object(none, &[("a", XFORM, object), ("b", XFORM, object)]);
    }
    made.push(("shared_objects.abc", archive.finish(object)));

    // Names as long as they may be, one below the other, above many.
    let mut archive = Archive::new();
    let none = archive.properties(&[]);
    let name = "n".repeat(1000);
    let leaves: Vec<(&str, u8, u64)> = (0..50_000).map(|_| ("l", NONE, 0)).collect();
    let mut object = archive.object(none, &leaves);
    for _ in 0..60 {
        object = archive.object(none, &[(&name, XFORM, object)]);
    }
    made.push(("long_names.abc", archive.finish(object)));
    let mut archive = Archive::new();
    let none = archive.properties(&[]);
    let leaves: Vec<(&str, u8, u64)> = (0..3_000).map(|_| ("l", NONE, 0)).collect();
    let object = archive.object(none, &leaves);
    let name = "n".repeat(1_000_000);
    let object = archive.object(none, &[(&name, XFORM, object)]);
    made.push(("one_long_name.abc", archive.finish(object)));

    // Many curves that share all they have, or claim very many samples.
    for (file, points, objects, samples) in
        [("shared_points.abc", 100_000usize, 4_000, 1), ("claimed_samples.abc", 2, 20_000, 250_000)]
    {
        let mut archive = Archive::new();
        let places: Vec<u8> = (0..3 * points).flat_map(|n| (n as f32).to_le_bytes()).collect();
        let counts: Vec<u8> = (0..points / 2).flat_map(|_| 2i32.to_le_bytes()).collect();
        let (places, counts) = (archive.sample(&places), archive.sample(&counts));
        let none = archive.properties(&[]);
        let mut below = Vec::new();
        for _ in 0..objects {
            let curves = archive.curves(places, counts, samples);
            below.push(("hair", CURVES, archive.object(curves, &[])));
        }
        let top = archive.object(none, &below);
        made.push((file, archive.finish(top)));
    }
    made
}
