//! Every reader on small files of the project's own (`files/README.md`): each holds what the others of its kind hold.

use std::path::{Path, PathBuf};

use glam::{Quat, Vec2, Vec3, vec3};
use nabiki::{Hair, Mesh};
use nabiki_io::info::{Info, info};
use nabiki_io::motion::{self, Axis, MotionSource};
use nabiki_io::{Placement, cache, hair, mesh};
use serde_json::Value;

fn file(name: &str) -> PathBuf {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/files")).join(name)
}

/// The points of the groom, as `files/make.py` has them (m).
fn points() -> Vec<Vec3> {
    let strand = |x: f32| (0..4).map(move |p| Vec3::new(x, 1.5 + 0.125 * p as f32, 0.0625 * (p * p) as f32));
    [-0.25, 0.0, 0.5].into_iter().flat_map(strand).collect()
}

fn is_the_groom(hair: &Hair, name: &str) {
    assert_eq!(hair.strands.starts(), [0, 4, 8, 12], "{name}");
    assert_eq!(hair.strands.points(), points(), "{name}");
    hair.check_lengths().unwrap();
}

#[test]
fn every_hair_format_holds_the_groom() {
    for name in ["groom.hair", "groom_3.tfx", "groom_4.tfx", "groom.obj", "groom.usda", "groom.usdc", "groom.abc"] {
        is_the_groom(&hair::read(&file(name)).unwrap(), name);
    }
    let at = |name: &str| hair::read(&file(name)).unwrap().attributes;
    let header = at("groom.hair").constant;
    assert_eq!((header.width, header.transparency, header.colour), (Some(0.0001), Some(0.25), Some([1.0, 0.5, 0.25])));
    let both_ends = Some([0.0, 1.0, 1.0, 0.0].repeat(3));
    assert_eq!((at("groom_3.tfx").inverse_mass, at("groom_4.tfx").inverse_mass), (both_ends.clone(), both_ends));
    assert_eq!(at("groom_3.tfx").width, Some([0.0001, 0.0002, 0.0003].iter().flat_map(|&w| [w; 4]).collect()));
    assert_eq!(at("groom_4.tfx").root_uv, Some(vec![[0.0, 0.5], [0.25, 0.5], [0.5, 0.5]]));
}

#[test]
fn hair_held_at_both_ends_is_said_where_it_is_read() {
    for (name, held) in [("groom_3.tfx", 3), ("groom_4.tfx", 3), ("groom.obj", 0)] {
        let metres = Placement { unit: "m".parse().unwrap(), ..Placement::default() };
        let report = hair::import(&file(name), &metres, &hair::Cleaning::default()).unwrap().1;
        assert_eq!(report.held_at_both_ends, held, "{name}");
        let said = "3 strands are held at both ends in the file; here their tips swing freely";
        assert_eq!(report.warning().as_deref(), (held > 0).then_some(said), "{name}");
        let text = info(&file(name)).unwrap().to_string();
        assert_eq!(text.contains("held: 3 strands at both ends; here their tips swing freely"), held > 0, "{text}");
    }
}

/// The vertices of the solid, as `files/make.py` has them (m).
const CORNERS: [Vec3; 6] = [
    vec3(0.25, 1.5, 0.0),
    vec3(-0.25, 1.5, 0.0),
    vec3(0.0, 1.75, 0.0),
    vec3(0.0, 1.25, 0.0),
    vec3(0.0, 1.5, 0.25),
    vec3(0.0, 1.5, -0.25),
];

/// Volume within the triangles: above 0 where they run counter-clockwise seen from outside.
fn volume(mesh: &Mesh) -> f32 {
    let corners = mesh.triangles.iter().map(|t| t.map(|v| mesh.positions[v as usize] - Vec3::new(0.0, 1.5, 0.0)));
    corners.map(|[a, b, c]| a.dot(b.cross(c)) / 6.0).sum()
}

#[test]
fn every_mesh_format_holds_the_solid_outside_out() {
    for name in [
        "solid.obj",
        "solid_text.ply",
        "solid_little.ply",
        "solid_big.ply",
        "solid.tfxmesh",
        "solid.glb",
        "solid.gltf",
        "solid.fbx",
        "groom.usda",
    ] {
        let read = mesh::read(&file(name), &[]).unwrap();
        assert_eq!((read.positions.len(), read.triangles.len()), (6, 8), "{name}");
        // Vertex i has (i, 8 - i) / 8 of the texture, whatever numbers the format gives its vertices.
        let corner = |place: Vec3| CORNERS.iter().position(|&corner| corner == place).unwrap() as f32;
        let uv = |v: u32| corner(read.positions[v as usize]);
        let uvs = read.triangles.iter().map(|t| t.map(|v| Vec2::new(uv(v), 8.0 - uv(v)) / 8.0)).collect();
        assert_eq!(read.corner_uvs, (name != "solid.tfxmesh").then_some(uvs), "{name}");
        let low = read.positions.iter().copied().reduce(Vec3::min).unwrap();
        let high = read.positions.iter().copied().reduce(Vec3::max).unwrap();
        assert_eq!((low, high), (Vec3::new(-0.25, 1.25, -0.25), Vec3::new(0.25, 1.75, 0.25)), "{name}");
        // An octahedron of radius r has 4/3 r^3; all its numbers are exact in binary but for the division.
        assert!((volume(&read) - 4.0 / 3.0 / 64.0).abs() < 1e-8, "{name}: {}", volume(&read));
        // However it lies in head space, it stays so: a placement is a rotation.
        let placement = Placement { up: Axis::PlusZ, facing: Axis::MinusY, ..Placement::default() };
        let placed = mesh::import(&file(name), &placement, &[]).unwrap().0;
        let far: f32 = placed
            .triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|v| placed.positions[v as usize]);
                a.dot(b.cross(c)) / 6.0
            })
            .sum();
        assert!(far > 0.0, "{name}: {far}");
    }
}

#[test]
fn texture_coordinates_of_a_layer_are_read_by_what_has_them() {
    let whole = std::fs::read_to_string(file("groom.usda")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let (line, indices) = ("(interpolation = \"faceVarying\")", "        int[] primvars:st:indices = [");
    let at = whole.find(indices).unwrap();
    let end = at + whole[at..].find('\n').unwrap() + 1;
    let direct = [&whole[..at], &whole[end..]].concat();
    let uvs = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        mesh::read(&path, &[]).map(|mesh| mesh.corner_uvs).map_err(|e| e.to_string())
    };
    let expected = mesh::read(&file("groom.usda"), &[]).unwrap().corner_uvs;
    assert!(expected.is_some());
    for interpolation in ["vertex", "varying"] {
        let line_of = format!("(interpolation = \"{interpolation}\")");
        assert_eq!(uvs("direct.usda", &direct.replace(line, &line_of)), Ok(expected.clone()), "{interpolation}");
    }
    assert_eq!(uvs("one.usda", &direct.replace(line, "(interpolation = \"uniform\")")), Ok(None));
    // What is none of them costs the coordinates, not the head.
    let past = whole.replacen(&whole[at..at + indices.len() + 1], &format!("{indices}9"), 1);
    for (name, text, why) in
        [("short.usda", &direct, "6 for 24 corners"), ("past.usda", &past, "some of its indices name no value")]
    {
        assert_eq!(uvs(name, text), Ok(None));
        let (_, losses) = mesh::read_with_losses(&folder.path().join(name), &[]).unwrap();
        assert_eq!(losses, [format!("texture coordinates of /groom/skin: {why}")]);
    }
}

#[test]
fn a_mesh_that_many_mirrors_turn_over_is_outside_out() {
    let whole = std::fs::read_to_string(file("solid.gltf")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let from = "\"scale\": [\n    -1,\n    1,\n    1\n   ]";
    assert!(whole.contains(from));
    // Outside out in its own space, the solid is so below any node.
    for scale in ["[1, 1, -1]", "[-1, -1, -1]", "[1, 1, 1]", "[-1, 1, -1]"] {
        let path = folder.path().join("turned.gltf");
        std::fs::write(&path, whole.replace(from, &format!("\"scale\": {scale}"))).unwrap();
        let mesh = mesh::read(&path, &[]).unwrap();
        let middle = mesh.positions.iter().sum::<Vec3>() / 6.0;
        let corners = mesh.triangles.iter().map(|t| t.map(|v| mesh.positions[v as usize] - middle));
        let volume: f32 = corners.map(|[a, b, c]| a.dot(b.cross(c)) / 6.0).sum();
        assert!((volume - 4.0 / 3.0 / 64.0).abs() < 1e-6, "scale {scale}: {volume}");
    }
}

/// A source whose world is the scene's, but for metres.
fn nod(name: &str) -> MotionSource {
    let said = name.ends_with("csv") || name.ends_with("usda");
    let given = name.ends_with("amc");
    let skeleton = match name {
        "nod.amc" => Some(file("nod.asf")),
        "nod.tof" => Some(file("nod_skeleton.tof")),
        _ => None,
    };
    MotionSource {
        file: file(name),
        skeleton,
        unit_cm: (!said).then_some(100.0),
        up: Some(Axis::PlusY),
        facing: Some(Axis::PlusX),
        frames_per_second: given.then_some(48.0),
        ..MotionSource::default()
    }
}

#[test]
fn every_motion_format_holds_the_nod() {
    for name in ["nod.bvh", "nod.amc", "nod.tof", "nod.csv", "solid.glb", "solid.gltf", "solid.fbx", "groom.usda"] {
        let read = motion::read(&nod(name), 48.0).unwrap();
        assert_eq!(read.poses.len(), 25, "{name}");
        for (i, pose) in read.poses.iter().enumerate() {
            let expected = Vec3::new(0.0, 150.0, 6.25 * i as f32);
            // f32 in a .glb, and times in a file that are rounded to 9 digits.
            assert!(pose.position_cm.distance(expected) < 1e-4, "{name}, {i}: {pose:?}");
            let turned = Quat::from_rotation_y((3.75 * i as f32).to_radians());
            assert!(pose.rotation.dot(turned).abs() > 1.0 - 1e-6, "{name}, {i}: {pose:?}");
        }
        assert_eq!(motion::read(&nod(name), 24.0).unwrap().poses.len(), 13, "{name}");
    }
}

#[test]
fn the_cache_is_read_as_its_page_says() {
    let mut reader = cache::Reader::open(&file("motion.nabiki")).unwrap();
    assert_eq!((reader.frame_count(), reader.header().frame_rate), (25, 48.0));
    assert_eq!(reader.header().scene.to_string(), "0f0e0d0c0b0a09080706050403020100");
    let origin = reader.header().origin.clone().unwrap();
    let placement = origin.placement;
    assert_eq!((placement.unit.cm, placement.up, placement.facing), (100.0, Axis::PlusY, Axis::PlusZ));
    assert_eq!((placement.origin, origin.points), (Vec3::new(0.0, 1.5, 0.0), 12));
    let hair = reader.hair(24).unwrap();
    assert_eq!(hair.attributes.id, Some(vec![7, 8, 9]));
    is_the_groom(&hair.transformed(&placement.file_from_head_in_doubles()), "motion.nabiki");
    let mut strands = reader.header().strands();
    let pose = reader.read(24, &mut strands).unwrap();
    assert_eq!(pose.position_cm, Vec3::new(150.0, 150.0, 0.0));
}

#[test]
fn moving_hair_of_layers_and_archives_has_its_frames() {
    for name in ["moving.usdc", "moving.abc"] {
        let Info::Exchange(found) = info(&file(name)).unwrap() else { panic!("{name} is a layer or archive") };
        assert_eq!((found.frames, found.frame_rate), (25, Some(48.0)), "{name}");
        let first = hair_of(name, 0);
        assert_eq!((first.strands.len(), first.attributes.id.clone()), (3, Some(vec![7, 8, 9])), "{name}");
        // The head goes on by 1.5 m, and its hair with it.
        let moved = hair_of(name, 24).strands.strand(1)[0] - first.strands.strand(1)[0];
        assert!(moved.z > 1.0, "{name}: {moved}");
    }
}

fn hair_of(name: &str, frame: usize) -> Hair {
    nabiki_io::exchange::hair(&file(name), frame, None).unwrap()
}

/// What `nabiki info --json` gives.
fn json(name: &str) -> Value {
    serde_json::from_str(&serde_json::to_string(&info(&file(name)).unwrap()).unwrap()).unwrap()
}

#[test]
fn the_json_of_every_kind_has_its_kind_and_its_fields() {
    for name in ["groom.hair", "groom_3.tfx", "groom_4.tfx", "groom.obj"] {
        let hair = json(name);
        assert_eq!(hair["kind"], "hair", "{name}");
        assert_eq!((hair["strands"].as_u64(), hair["points"].as_u64()), (Some(3), Some(12)), "{name}");
        assert_eq!(hair["segments"], serde_json::json!([3, 3]), "{name}");
        assert_eq!(hair["bounds"]["max"][2].as_f64(), Some(0.5625), "{name}");
        assert!(hair["strand_length"]["median"].is_f64() && hair["attributes"].is_array(), "{name}: {hair}");
        assert_eq!(hair["likely_unit"], "m", "{name}");
    }
    for name in ["solid.obj", "solid_text.ply", "solid.tfxmesh", "solid.glb", "solid.gltf", "solid.fbx"] {
        let mesh = json(name);
        assert_eq!(mesh["kind"], "mesh", "{name}");
        assert_eq!((mesh["vertices"].as_u64(), mesh["triangles"].as_u64()), (Some(6), Some(8)), "{name}");
        assert_eq!((mesh["open_edges"].as_u64(), mesh["crowded_edges"].as_u64()), (Some(0), Some(0)), "{name}");
        // The format of a glTF, and an FBX itself, state what the others leave to be guessed.
        let states = name.starts_with("solid.gl") || name == "solid.fbx";
        assert_eq!(mesh.get("likely_unit").and_then(Value::as_str), (!states).then_some("m"), "{name}");
        assert_eq!(mesh["unit_cm"].as_f64(), states.then_some(100.0), "{name}");
        assert_eq!(mesh["up"].as_str(), states.then_some("+y"), "{name}");
        let text = info(&file(name)).unwrap().to_string();
        assert_eq!(text.contains("a guess"), !states, "{text}");
    }
    assert_eq!(json("solid.glb")["clips"][0], serde_json::json!({ "name": "nod", "end": 0.5 }));
    assert_eq!(json("solid.glb")["nodes"], serde_json::json!(["solid", "Hips", "Head"]));
    let fbx = json("solid.fbx");
    assert_eq!((&fbx["clips"], &fbx["nodes"]), (&json("solid.glb")["clips"], &json("solid.glb")["nodes"]));
    assert_eq!((fbx["frame_rate"].as_f64(), json("solid.glb")["facing"].as_str()), (Some(48.0), Some("+z")));
    // Motion without a mesh.
    let folder = tempfile::tempdir().unwrap();
    let alone = folder.path().join("nod.gltf");
    let mut nod: Value = serde_json::from_slice(&std::fs::read(file("solid.gltf")).unwrap()).unwrap();
    nod.as_object_mut().unwrap().remove("meshes");
    nod["nodes"].as_array_mut().unwrap().iter_mut().for_each(|node| drop(node.as_object_mut().unwrap().remove("mesh")));
    std::fs::write(&alone, nod.to_string()).unwrap();
    let text = info(&alone).unwrap().to_string();
    assert!(text.starts_with("mesh: none\nnodes: solid, Hips, Head\nclips: nod"), "{text}");
    for (name, samples, joints) in
        [("nod.bvh", 25, 2), ("nod.amc", 25, 2), ("nod.asf", 0, 3), ("nod.tof", 25, 2), ("nod.csv", 25, 0)]
    {
        let motion = json(name);
        assert_eq!(motion["kind"], "motion", "{name}");
        assert_eq!(motion["samples"].as_u64(), Some(samples), "{name}");
        assert_eq!(motion["joints"].as_array().map(Vec::len), Some(joints), "{name}");
        assert!(motion["asked"].as_array().unwrap().contains(&"facing".into()), "{name}: {motion}");
    }
    assert_eq!(json("nod.csv")["unit_cm"].as_f64(), Some(100.0));
    let cache = json("motion.nabiki");
    assert_eq!((cache["kind"].as_str(), cache["frames"].as_u64()), (Some("cache"), Some(25)));
    assert_eq!((cache["frame_rate"].as_f64(), cache["head_moves"].as_bool()), (Some(48.0), Some(true)));
    assert_eq!(cache["scene"], "0f0e0d0c0b0a09080706050403020100");
    assert_eq!(cache["rest"]["strands"].as_u64(), Some(3));
    assert!(cache["rest"].get("likely_unit").is_none(), "a cache is in centimetres: {cache}");
}

#[test]
fn what_a_layer_states_is_not_guessed_and_the_rest_is_guessed_once() {
    for (name, unit, guess) in
        [("groom.usda", Some(100.0), None), ("groom.usdc", Some(100.0), None), ("groom.abc", None, Some("m"))]
    {
        let found = json(name);
        assert_eq!(found["kind"], "exchange", "{name}");
        assert_eq!(found["unit_cm"].as_f64(), unit, "{name}");
        assert_eq!(found.get("likely_unit").and_then(Value::as_str), guess, "{name}");
        assert_eq!((found["frames"].as_u64(), found["up"].as_str()), (Some(1), Some("+y")), "{name}");
        let curves = found["prims"].as_array().unwrap().iter().filter(|prim| prim["what"] == "3 curves, 12 points");
        assert_eq!(curves.count(), 1, "{name}: {found}");
        assert!(found["hair"]["strands"] == 3 && found["hair"].get("likely_unit").is_none(), "{name}: {found}");
        let text = info(&file(name)).unwrap().to_string();
        assert_eq!(text.matches("guess").count(), usize::from(guess.is_some()), "{text}");
        let said = match unit {
            Some(_) => "the file says: unit m, up +y; facing: unknown",
            None => "the file says no unit and no up axis; by the format's default: up +y; facing: unknown",
        };
        assert!(text.contains(said), "{text}");
    }
    assert!(json("groom.usda")["mesh"].get("likely_unit").is_none());
    assert_eq!(json("groom.usda")["prims"][1]["path"], "/groom/hair");
    assert_eq!(json("groom.usda")["prims"][4]["samples"], 25, "a transform's frames");
}

/// All that a file may be asked for, by whatever kind it is.
fn read_whatever(path: &Path, folder: &Path) -> Vec<nabiki_io::Error> {
    let mut errors = Vec::new();
    errors.extend(info(path).err());
    errors.extend(hair::read(path).err());
    errors.extend(mesh::read(path, &[]).err());
    let skeletons = ["nod.asf", "nod_skeleton.tof"].map(|name| folder.join(name));
    for skeleton in [None].into_iter().chain(skeletons.map(Some)) {
        let source = MotionSource {
            file: path.to_owned(),
            skeleton,
            unit_cm: Some(1.0),
            up: Some(Axis::PlusY),
            facing: Some(Axis::PlusX),
            ..MotionSource::default()
        };
        errors.extend(motion::read(&source, 24.0).err());
    }
    errors
}

#[test]
fn damage_to_any_sample_is_said_in_one_line_that_names_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let samples: Vec<PathBuf> = std::fs::read_dir(file("")).unwrap().map(|entry| entry.unwrap().path()).collect();
    for name in ["nod.asf", "nod_skeleton.tof"] {
        std::fs::copy(file(name), folder.path().join(name)).unwrap();
    }
    let mut refused = 0;
    for sample in samples {
        let bytes = std::fs::read(&sample).unwrap();
        let name = sample.file_name().unwrap().to_str().unwrap();
        let path = folder.path().join(format!("damaged_{name}"));
        for step in 0..50 {
            let at = step * bytes.len() / 50;
            let mut flipped = bytes.clone();
            flipped[at] ^= 0xff;
            let mut larger = bytes.clone();
            larger[at] = b'9';
            for damaged in [&bytes[..at], &flipped, &larger] {
                std::fs::write(&path, damaged).unwrap();
                for error in read_whatever(&path, folder.path()) {
                    let said = error.to_string();
                    let named = said.starts_with(folder.path().to_str().unwrap());
                    assert!(named && !said.contains('\n') && said.len() < 1000, "{name}, {at}: {said}");
                    refused += 1;
                }
            }
        }
    }
    assert!(refused > 1000, "only {refused} errors");
}

#[test]
fn what_a_format_states_is_declared() {
    let space = |name: &str| nabiki_io::declared_space(&file(name)).unwrap();
    let (metres, y) = (Some("m".parse().unwrap()), Some(Axis::PlusY));
    for name in ["solid.glb", "solid.gltf", "solid.fbx", "groom.usda"] {
        assert_eq!((space(name).unit, space(name).up), (metres, y), "{name}");
    }
    assert_eq!((space("groom.abc").unit, space("groom.abc").up), (None, y));
    for name in ["solid.obj", "solid.tfxmesh", "solid_text.ply", "groom.hair", "groom_4.tfx"] {
        assert_eq!((space(name).unit, space(name).up), (None, None), "{name}");
    }
}

#[test]
fn a_unit_or_an_axis_of_a_layer_that_is_none_is_refused_and_a_small_letter_is_not() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("groom.usda");
    let text = std::fs::read_to_string(file("groom.usda")).unwrap();
    let space = |from: &str, to: &str| {
        assert!(text.contains(from), "{from}");
        std::fs::write(&path, text.replacen(from, to, 1)).unwrap();
        nabiki_io::declared_space(&path).map_err(|e| e.to_string())
    };
    for (metres, said) in [("1e-30", "1e-30"), ("1e300", "1e300"), ("1e7", "1e7"), ("nan", "NaN"), ("-1", "-1")] {
        let refused = space("metersPerUnit = 1", &format!("metersPerUnit = {metres}")).unwrap_err();
        assert!(refused.contains(&format!("metersPerUnit = {said}: must ")) && refused.contains("0.01"), "{refused}");
    }
    for (axis, up) in [("y", Axis::PlusY), ("z", Axis::PlusZ), ("Z", Axis::PlusZ)] {
        assert_eq!(space("upAxis = \"Y\"", &format!("upAxis = \"{axis}\"")).unwrap().up, Some(up));
    }
    assert!(space("upAxis = \"Y\"", "upAxis = \"X\"").unwrap_err().contains("must be \"Y\" or \"Z\""));
}

#[test]
fn a_byte_order_mark_before_a_text_is_passed_over_or_named() {
    let folder = tempfile::tempdir().unwrap();
    let marked = |name: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, [b"\xef\xbb\xbf".to_vec(), std::fs::read(file(name)).unwrap()].concat()).unwrap();
        path
    };
    for name in ["solid.obj", "solid_text.ply", "solid.gltf", "solid.tfxmesh"] {
        assert_eq!(mesh::read(&marked(name), &[]).unwrap(), mesh::read(&file(name), &[]).unwrap(), "{name}");
    }
    for name in ["nod.bvh", "nod.amc", "nod.asf", "nod.tof", "nod.csv"] {
        assert_eq!(info(&marked(name)).unwrap(), info(&file(name)).unwrap(), "{name}");
    }
    let refused = hair::read(&marked("groom.usda")).unwrap_err().to_string();
    assert!(refused.contains("begins with a byte order mark, which USD does not read: save it as UTF-8"), "{refused}");
    let kind = nabiki_io::kind::FileKind::of(&marked("nod.tof")).unwrap();
    assert_eq!(kind, Some(nabiki_io::kind::FileKind::ObjectStream));
}

#[test]
fn a_table_whose_times_do_not_grow_is_refused_by_info_as_by_a_scene() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("back.csv");
    let row = |t: u32| format!("{t},0,0,0,0,0,0,1\n");
    let write = |times: &[u32]| {
        let rows: String = times.iter().map(|&t| row(t)).collect();
        std::fs::write(&path, format!("t_s,px_m,py_m,pz_m,qx,qy,qz,qw\n{rows}")).unwrap();
        info(&path).map(|info| info.to_string()).map_err(|e| e.to_string())
    };
    for times in [[1, 0], [1, 1]] {
        assert!(write(&times).unwrap_err().contains("s follows 1 s, but times must increase"));
    }
    assert!(write(&[3]).unwrap().starts_with("motion: 1 samples, too few to move anything\n"));
    assert!(write(&[]).unwrap().starts_with("motion: 0 samples, too few to move anything\n"));
    assert!(write(&[1, 3]).unwrap().starts_with("motion: 2 samples over 2.000 s, 0.50 a second\n"));
}

#[test]
fn the_parts_of_a_mesh_file_are_listed_the_largest_first() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("parts.obj");
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\no one\nf 1 2 3\ng a b\nf 1 2 3\ng a\nf 3 2 1\n";
    std::fs::write(&path, text).unwrap();
    let parts = [("one", 3), ("a", 2), ("b", 1)].map(|(name, faces)| (name.to_owned(), faces));
    assert_eq!(mesh::groups(&path).unwrap(), parts);
    assert_eq!(mesh::groups(&file("solid.glb")).unwrap(), [("solid".to_owned(), 8)]);
    assert_eq!(mesh::groups(&file("solid.fbx")).unwrap(), [("solid".to_owned(), 8)]);
    assert_eq!(mesh::groups(&file("solid_text.ply")).unwrap(), []);
}

#[test]
fn hair_beyond_any_size_is_refused() {
    let huge = Placement { unit: nabiki_io::Unit { cm: 1e30 }, ..Placement::default() };
    let refused = hair::import(&file("groom.hair"), &huge, &hair::Cleaning::default()).unwrap_err().to_string();
    assert!(refused.contains("cm away, more than 1e9: check hair.unit"), "{refused}");
}

#[test]
fn the_endings_that_info_knows_name_scenes_too() {
    let refused = info(Path::new("a.xyz")).unwrap_err().to_string();
    assert!(
        refused.contains("ending \"xyz\" is not one of .hair, ") && refused.ends_with(".nabiki or .toml"),
        "{refused}"
    );
    let folder = tempfile::tempdir().unwrap();
    for (name, said) in [("", "is a folder, not a regular file"), ("nope", "there is no such file or folder")] {
        let path = folder.path().join(name);
        assert!(info(&path).unwrap_err().to_string().contains(said), "{name}");
        assert!(mesh::read(&path, &[]).unwrap_err().to_string().contains(said), "{name}");
    }
}
