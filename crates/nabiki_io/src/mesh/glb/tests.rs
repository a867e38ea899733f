use glam::{DQuat, DVec3};

use super::*;

/// A .glb of one triangle with texture coordinates of a component type, and, if so wanted, once more without any.
fn glb(component: u32, normalised: bool, uvs: &[u8], without: bool) -> Vec<u8> {
    let bare = if without { r#",{"attributes":{"POSITION":0}}"# } else { "" };
    let (count, bytes, whole) = (3, uvs.len(), 36 + uvs.len());
    let json = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"TEXCOORD_0":1}}}}{bare}]}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}},
        {{"bufferView":1,"componentType":{component},"normalized":{normalised},"count":{count},"type":"VEC2"}}],
        "bufferViews":[{{"buffer":0,"byteLength":36}},{{"buffer":0,"byteOffset":36,"byteLength":{bytes}}}],
        "buffers":[{{"byteLength":{whole}}}]}}"#
    );
    let mut binary = [0.0f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].map(f32::to_le_bytes).concat();
    binary.extend(uvs);
    crate::gltf_file::tests::glb(&json, &binary)
}

/// A .glb of a triangle whose vertices have a colour of a component type and shape, and a number each.
fn coloured((component, shape): (u32, &str), colours: &[u8], parts: &[u8; 12]) -> Vec<u8> {
    let (bytes, whole) = (colours.len(), 48 + colours.len());
    let json = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0,"name":"head"}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"_PART":1,"COLOR_0":2}}}}]}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}},
        {{"bufferView":1,"componentType":5126,"count":3,"type":"SCALAR"}},
        {{"bufferView":2,"componentType":{component},"normalized":{},"count":3,"type":"{shape}"}}],
        "bufferViews":[{{"buffer":0,"byteLength":36}},{{"buffer":0,"byteOffset":36,"byteLength":12}},
        {{"buffer":0,"byteOffset":48,"byteLength":{bytes}}}],"buffers":[{{"byteLength":{whole}}}]}}"#,
        component != 5126
    );
    let mut binary = [0.0f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].map(f32::to_le_bytes).concat();
    binary.extend(parts);
    binary.extend(colours);
    crate::gltf_file::tests::glb(&json, &binary)
}

#[test]
fn colours_of_every_component_type_are_shares_and_numbers_stand_for_themselves() {
    let mut parts = [0; 12];
    for (to, part) in parts.chunks_exact_mut(4).zip([3.0f32, 7.0, 7.0]) {
        to.copy_from_slice(&part.to_le_bytes());
    }
    // Grey, green and white, the last two half transparent.
    let bytes = [51u8, 51, 51, 255, 0, 255, 0, 51, 255, 255, 255, 51];
    let shorts: Vec<u8> = bytes.iter().flat_map(|&b| (u16::from(b) * 257).to_le_bytes()).collect();
    let floats: Vec<u8> = bytes.iter().flat_map(|&b| (f32::from(b) / 255.0).to_le_bytes()).collect();
    for (component, colours) in [(5121, &bytes[..]), (5123, &shorts), (5126, &floats)] {
        let (mesh, unread) = from_bytes(&coloured((component, "VEC4"), colours, &parts), None, &[]).unwrap();
        let of = |name: &str| mesh.weights_named(name).map(|weights| weights.values.clone());
        assert_eq!(of("COLOR_0"), Some(vec![0.2, 0.7152, 1.0]), "{component}");
        assert_eq!(of("COLOR_0.g"), Some(vec![0.2, 1.0, 1.0]), "{component}");
        assert_eq!(of("COLOR_0.a"), Some(vec![1.0, 0.2, 0.2]), "{component}");
        assert_eq!(of("_PART"), Some(vec![3.0, 7.0, 7.0]), "{component}");
        assert!(unread.is_empty(), "{unread:?}");
    }
    let rgb: Vec<u8> = [0.25f32; 9].iter().flat_map(|x| x.to_le_bytes()).collect();
    let mesh = from_bytes(&coloured((5126, "VEC3"), &rgb, &parts), None, &[]).unwrap().0;
    assert_eq!(mesh.weights_named("COLOR_0").map(|of| of.values.clone()), Some(vec![0.25; 3]));
    assert_eq!(mesh.weights_named("COLOR_0.a"), None);
    // What cannot be read costs itself and not the mesh.
    let (mesh, unread) = from_bytes(&coloured((5126, "VEC4"), &rgb, &parts), None, &[]).unwrap();
    assert_eq!((mesh.triangles.len(), mesh.weight_names().collect::<Vec<_>>()), (1, vec!["_PART"]));
    assert_eq!(unread, ["COLOR_0 of head: accessor 2: 3 items reach past their buffer"]);
}

#[test]
fn nodes_are_carried_by_those_above_them_and_vertices_may_be_interleaved() {
    // Three vertices of a place and of texture coordinates each, behind four bytes of something else.
    let vertices = [[1.0f32, 0.0, 0.0, 0.25, 1.0], [0.0, 1.0, 0.0, 0.5, 0.75], [0.0, 0.0, 1.0, 0.75, 0.5]].concat();
    let numbers: Vec<u8> = std::iter::once(&9.0).chain(&vertices).flat_map(|x| x.to_le_bytes()).collect();
    // The arm is turned by a quarter about z and lies at (0, 0, 5), the hand lies at (10, 0, 0) of it.
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let json = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],
        "nodes":[{{"children":[1],"rotation":[0,0,{half},{half}],"translation":[0,0,5]}},
        {{"mesh":0,"translation":[10,0,0]}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"TEXCOORD_0":1}}}}]}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,1]}},
        {{"bufferView":0,"byteOffset":12,"componentType":5126,"count":3,"type":"VEC2"}}],
        "bufferViews":[{{"buffer":0,"byteOffset":4,"byteLength":60,"byteStride":20}}],
        "buffers":[{{"byteLength":64}}]}}"#
    );
    let mesh = from_bytes(&crate::gltf_file::tests::glb(&json, &numbers), None, &[]).unwrap().0;
    let places = [[0.0, 11.0, 5.0], [-1.0, 10.0, 5.0], [0.0, 10.0, 6.0]].map(Vec3::from);
    for (found, place) in mesh.positions.iter().zip(places) {
        assert!(found.distance(place) < 1e-5, "{found} {place}");
    }
    let uvs = [[0.25, 0.0], [0.5, 0.25], [0.75, 0.5]].map(Vec2::from);
    assert_eq!((mesh.triangles, mesh.corner_uvs), (vec![[0, 1, 2]], Some(vec![uvs])));
}

#[test]
fn the_default_scene_is_read_part_by_part_and_a_node_is_chosen_with_what_is_below_it() {
    let triangle = |x: f32| [x, 0.0, 0.0, x + 1.0, 0.0, 0.0, x, 1.0, 0.0];
    let numbers: Vec<u8> = [triangle(0.0), triangle(10.0)].concat().iter().flat_map(|x| x.to_le_bytes()).collect();
    let json = r#"{"asset":{"version":"2.0"},"scene":1,"scenes":[{"nodes":[3]},{"nodes":[0,2]}],
        "nodes":[{"name":"body","children":[1]},{"name":"head","mesh":0},{"name":"floor","mesh":1},{"mesh":1}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0}},{"attributes":{"POSITION":1}}]},
        {"primitives":[{"attributes":{"POSITION":1}}]}],
        "accessors":[
        {"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
        {"bufferView":0,"byteOffset":36,"componentType":5126,"count":3,"type":"VEC3","min":[10,0,0],"max":[11,1,0]}],
        "bufferViews":[{"buffer":0,"byteLength":72}],"buffers":[{"byteLength":72}]}"#;
    let glb = crate::gltf_file::tests::glb(json, &numbers);
    let corners = |groups: &[&str]| {
        let groups: Vec<String> = groups.iter().map(|&group| group.to_owned()).collect();
        let mesh = from_bytes(&glb, None, &groups).unwrap().0;
        mesh.triangles.iter().map(|t| t.map(|v| mesh.positions[v as usize].x)).collect::<Vec<_>>()
    };
    let (near, far) = ([0.0, 1.0, 0.0], [10.0, 11.0, 10.0]);
    assert_eq!(corners(&[]), [near, far, far]);
    assert_eq!(corners(&["body"]), [near, far]);
    assert_eq!(corners(&["floor"]), [far]);
}

#[test]
fn texture_coordinates_of_every_component_type_are_shares_with_v_upward() {
    let bytes = [0u8, 255, 51, 0, 255, 102];
    let shorts: Vec<u8> = bytes.iter().flat_map(|&b| (u16::from(b) * 257).to_le_bytes()).collect();
    let floats: Vec<u8> = bytes.iter().flat_map(|&b| (f32::from(b) / 255.0).to_le_bytes()).collect();
    // 51 / 255 and 102 / 255 are a fifth and two fifths.
    let expected = [Vec2::new(0.0, 0.0), Vec2::new(0.2, 1.0), Vec2::new(1.0, 1.0 - 0.4)];
    for (component, uvs) in [(5121, &bytes[..]), (5123, &shorts), (5126, &floats)] {
        let mesh = from_bytes(&glb(component, component != 5126, uvs, false), None, &[]).unwrap().0;
        assert_eq!(mesh.corner_uvs, Some(vec![expected]), "{component}");
    }
    let (bare, _) = from_bytes(&glb(5121, true, &bytes, true), None, &[]).unwrap();
    assert_eq!((bare.triangles.len(), bare.corner_uvs), (2, None));
}

#[test]
fn wrong_texture_coordinates_cost_these_and_not_the_mesh() {
    let floats = |all: &[f32]| all.iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>();
    let short = (floats(&[0.0; 5]), "accessor 1: 3 items reach past their buffer");
    let nowhere = (floats(&[0.0, 0.0, 0.5, f32::NAN, 0.0, 0.0]), "(0.5, NaN) is not a texture coordinate");
    for (uvs, why) in [short, nowhere] {
        let (mesh, unread) = from_bytes(&glb(5126, false, &uvs, false), None, &[]).unwrap();
        assert_eq!((mesh.triangles.len(), mesh.corner_uvs), (1, None), "{why}");
        assert_eq!(unread, [format!("the texture coordinates of mesh 0: {why}")]);
    }
}

/// A .glb whose one buffer holds these views after one another; `rest` is what it has besides buffers and views.
fn of_views(rest: &str, views: &[Vec<u8>]) -> Vec<u8> {
    let mut binary = Vec::new();
    let mut texts = Vec::new();
    for view in views {
        texts.push(format!(r#"{{"buffer":0,"byteOffset":{},"byteLength":{}}}"#, binary.len(), view.len()));
        binary.extend(view);
        binary.resize(binary.len().next_multiple_of(4), 0);
    }
    let (texts, length) = (texts.join(","), binary.len());
    let json = format!(
        r#"{{"asset":{{"version":"2.0"}},{rest},"bufferViews":[{texts}],"buffers":[{{"byteLength":{length}}}]}}"#
    );
    crate::gltf_file::tests::glb(&json, &binary)
}

fn floats(all: &[f32]) -> Vec<u8> {
    all.iter().flat_map(|x| x.to_le_bytes()).collect()
}

/// The corners of a triangle, bound: the first to joint 0, the second to joint 1, the third to both.
const CORNERS: [Vec3; 3] = [Vec3::ZERO, Vec3::X, Vec3::Y];

/// A .glb of that triangle, which node 0 and whatever else has mesh 0 show, with skin 0 of joints 1 and 2.
fn skinned(nodes: &str, binds: Option<[DAffine3; 2]>, more: &str) -> Vec<u8> {
    let columns = |m: &DAffine3| glam::DMat4::from(*m).as_mat4().to_cols_array();
    let with_binds = if binds.is_some() { r#","inverseBindMatrices":3"# } else { "" };
    let binds = binds.iter().flatten().flat_map(columns).collect::<Vec<f32>>();
    let rest = format!(
        r#""scene":0,"scenes":[{{"nodes":[0,3]}}],"nodes":[{nodes}],"skins":[{{"joints":[1,2]{with_binds}}}],
        "meshes":[{{"name":"head","primitives":[{{"attributes":{{"POSITION":0,"JOINTS_0":1,"WEIGHTS_0":2}}}}]}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}},
        {{"bufferView":1,"componentType":5121,"count":3,"type":"VEC4"}},
        {{"bufferView":2,"componentType":5123,"normalized":true,"count":3,"type":"VEC4"}},
        {{"bufferView":3,"componentType":5126,"count":2,"type":"MAT4"}}]{more}"#
    );
    let rest = if with_binds.is_empty() {
        rest.replace(
            r#",
        {"bufferView":3,"componentType":5126,"count":2,"type":"MAT4"}"#,
            "",
        )
    } else {
        rest
    };
    let joints = vec![0, 7, 7, 7, 1, 0, 0, 0, 0, 1, 0, 0];
    // A quarter of the first joint, three of the second; what is of no weight may name any joint.
    let weights: Vec<u16> = vec![65535, 0, 0, 0, 65535, 0, 0, 0, 16384, 49151, 0, 0];
    let weights = weights.iter().flat_map(|w| w.to_le_bytes()).collect();
    of_views(&rest, &[floats(&CORNERS.map(|p| p.to_array()).concat()), joints, weights, floats(&binds)])
}

/// Where the skin puts the corners, by its definition.
fn bent(scene_from_joints: [DAffine3; 2], binds: [DAffine3; 2]) -> [Vec3; 3] {
    let place = |joint: usize, p: Vec3| (scene_from_joints[joint] * binds[joint]).transform_point3(p.as_dvec3());
    let share = 16384.0 / 65535.0;
    let both = place(0, CORNERS[2]) * share + place(1, CORNERS[2]) * (1.0 - share);
    [place(0, CORNERS[0]), place(1, CORNERS[1]), both].map(|p| p.as_vec3())
}

fn assert_near(found: &[Vec3], expected: &[Vec3], what: &str) {
    assert_eq!(found.len(), expected.len(), "{what}");
    for (found, expected) in found.iter().zip(expected) {
        assert!(found.distance(*expected) < 1e-5 * (1.0 + expected.length()), "{what}: {found}, not {expected}");
    }
}

#[test]
fn a_skin_bends_by_its_joints_wherever_the_mesh_hangs() {
    let moved = DAffine3::from_translation(DVec3::new(0.0, 1.5, 0.25));
    let armature = DAffine3::from_scale_rotation_translation(
        DVec3::splat(0.01),
        DQuat::from_rotation_x(-std::f64::consts::FRAC_PI_2),
        DVec3::new(0.0, 1.0, 0.0),
    );
    let quarter = DAffine3::from_rotation_z(std::f64::consts::FRAC_PI_2);
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let joints =
        format!(r#"{{"name":"neck","translation":[0,1.5,0.25]}},{{"name":"skull","rotation":[0,0,{half},{half}]}}"#);
    // What stands above the joints, and the mesh below it or beside it, itself moved and turned.
    let above = format!(
        r#"{{"children":[1,2],"scale":[0.01,0.01,0.01],"rotation":[{},0,0,{half}],"translation":[0,1,0]}}"#,
        -half
    );
    let mesh = r#"{"name":"body","mesh":0,"skin":0,"translation":[0,10,0],"scale":[3,3,3]}"#;
    let inverse = [(armature * moved).inverse(), (armature * quarter).inverse()];
    let any = [DAffine3::from_translation(DVec3::NEG_X), DAffine3::from_scale(DVec3::splat(100.0))];
    let one = [DAffine3::IDENTITY; 2];
    for (binds, given) in [(inverse, true), (any, true), (one, false)] {
        let glb = skinned(&format!("{mesh},{joints},{above}"), given.then_some(binds), "");
        let (found, unread) = from_bytes(&glb, None, &[]).unwrap();
        assert_near(&found.positions, &bent([armature * moved, armature * quarter], binds), &format!("{given}"));
        assert_eq!(unread, ["the 2 joints that head is bound to: it keeps its shape in the file's still pose"]);
    }
    // Bound where it stands, it stays there.
    let glb = skinned(&format!("{mesh},{joints},{above}"), Some(inverse), "");
    assert_near(&from_bytes(&glb, None, &[]).unwrap().0.positions, &CORNERS, "bound");
}

#[test]
fn a_mesh_of_two_nodes_goes_as_each_has_it_and_one_turned_inside_out_is_turned_back() {
    let nodes = r#"{"mesh":0,"skin":0},{"scale":[1,1,-1]},{"scale":[1,1,-1],"translation":[0,0,5]},
        {"mesh":0,"translation":[0,0,9],"children":[1,2]}"#;
    let (mesh, _) = from_bytes(&skinned(nodes, None, ""), None, &[]).unwrap();
    let above = DAffine3::from_translation(9.0 * DVec3::Z);
    let flipped = DAffine3::from_scale(DVec3::new(1.0, 1.0, -1.0));
    let joints = [above * flipped, above * DAffine3::from_translation(5.0 * DVec3::Z) * flipped];
    let rigid = CORNERS.map(|p| p + 9.0 * Vec3::Z);
    assert_near(&mesh.positions, &[bent(joints, [DAffine3::IDENTITY; 2]), rigid].concat(), "two nodes");
    assert_eq!(mesh.triangles, [[0, 2, 1], [3, 4, 5]]);
}

#[test]
fn skins_that_cannot_be_are_refused() {
    let nodes = r#"{"mesh":0,"skin":0},{},{},{"children":[1,2]}"#;
    let refused = |glb: &[u8]| from_bytes(glb, None, &[]).unwrap_err().to_string();
    let whole = skinned(nodes, Some([DAffine3::IDENTITY; 2]), "");
    let replaced = |from: &str, to: &str| {
        let at = whole.windows(from.len()).position(|w| w == from.as_bytes()).unwrap();
        [&whole[..at], to.as_bytes(), &whole[at + from.len()..]].concat()
    };
    assert!(from_bytes(&whole, None, &[]).is_ok());
    let line = refused(&replaced(r#""count":2,"type":"MAT4""#, r#""count":1,"type":"MAT4""#));
    assert_eq!(line, "skin 0: 1 inverse bind matrices for 2 joints");
    let line = refused(&replaced(r#"{"joints":[1,2]"#, r#"{"joints":[1  ]"#));
    assert_eq!(line, "mesh 0: vertex 1 is bound to joint 1, but its skin has 1");
    let circle = skinned(r#"{"mesh":0,"skin":0},{"children":[2]},{"children":[1]},{}"#, None, "");
    assert!(refused(&circle).contains("is its own ancestor"), "{}", refused(&circle));
}

#[test]
fn sparse_numbers_take_the_place_of_those_that_they_name() {
    let rest = |view: &str| {
        format!(
            r#""scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
            "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],
            "accessors":[{{{view}"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[9,9,9],
            "sparse":{{"count":2,"indices":{{"bufferView":1,"componentType":5123}},"values":{{"bufferView":2}}}}}}]"#
        )
    };
    let views = |second: u16| {
        let indices = [1, second].iter().flat_map(|i: &u16| i.to_le_bytes()).collect();
        let values = floats(&[0.0, 0.0, 9.0, 0.0, 9.0, 0.0]);
        [floats(&CORNERS.map(|p| p.to_array()).concat()), indices, values]
    };
    let read = |view: &str, second| from_bytes(&of_views(&rest(view), &views(second)), None, &[]);
    let positions = |view| read(view, 2).unwrap().0.positions;
    assert_eq!(positions(r#""bufferView":0,"#), [Vec3::ZERO, 9.0 * Vec3::Z, 9.0 * Vec3::Y]);
    assert_eq!(positions(""), [Vec3::ZERO, 9.0 * Vec3::Z, 9.0 * Vec3::Y], "noughts, without a view");
    let line = read(r#""bufferView":0,"#, 3).unwrap_err().to_string();
    assert_eq!(line, "mesh 0: accessor 0: its sparse item 3 is past its 3 items");
    let many = rest("").replace(r#""count":3"#, r#""count":4000000000"#);
    let line = from_bytes(&of_views(&many, &views(2)), None, &[]).unwrap_err().to_string();
    assert!(line.contains("with its vertices, but a file of") && line.starts_with("mesh 0: needs "), "{line}");
}

#[test]
fn morphs_count_with_the_weights_that_the_file_gives_them() {
    let mesh = |weights: &str, of_node: &str| {
        let rest = format!(
            r#""scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0{of_node}}}],
            "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"targets":[{{"POSITION":1}},{{"POSITION":1}}]}}]{weights}}}],
            "accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}},
            {{"bufferView":1,"componentType":5126,"count":3,"type":"VEC3"}}]"#
        );
        let moves = floats(&[0.0, 0.0, 4.0, 0.0, 0.0, 0.0, 0.0, 0.0, 8.0]);
        from_bytes(&of_views(&rest, &[floats(&CORNERS.map(|p| p.to_array()).concat()), moves]), None, &[]).unwrap()
    };
    let z = |(mesh, _): (Mesh, Vec<String>)| mesh.positions.iter().map(|p| p.z).collect::<Vec<_>>();
    assert_eq!(z(mesh("", "")), [0.0, 0.0, 0.0]);
    assert_eq!(z(mesh(r#","weights":[0.5,0.25]"#, "")), [3.0, 0.0, 6.0]);
    assert_eq!(z(mesh(r#","weights":[0.5,0.25]"#, r#","weights":[0,1]"#)), [4.0, 0.0, 8.0]);
    assert_eq!(mesh("", "").1, ["changes of the 2 morphs of mesh 0: it keeps its shape in the file's still pose"]);
}

#[test]
fn quantised_positions_are_read_by_their_type() {
    let read = |component: u32, normalised: bool, bytes: Vec<u8>| {
        let rest = format!(
            r#""extensionsUsed":["KHR_mesh_quantization"],"extensionsRequired":["KHR_mesh_quantization"],
            "scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0,"scale":[2,2,2]}}],
            "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],"accessors":[{{"bufferView":0,
            "componentType":{component},"normalized":{normalised},"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,1]}}]"#
        );
        from_bytes(&of_views(&rest, &[bytes]), None, &[]).unwrap().0.positions
    };
    let places = [-128_i8, 0, 127, 0, 64, -127, 1, 2, 3];
    let bytes = |all: &[i8]| all.iter().map(|&b| b as u8).collect::<Vec<u8>>();
    let twice = |x: [f32; 9]| x.as_chunks::<3>().0.iter().map(|p| 2.0 * Vec3::from(*p)).collect::<Vec<_>>();
    assert_eq!(read(5120, false, bytes(&places)), twice(places.map(f32::from)));
    let shares = twice(places.map(|b| (f32::from(b) / 127.0).max(-1.0)));
    assert_near(&read(5120, true, bytes(&places)), &shares, "shares");
    let shorts: Vec<u8> = [0_u16, 65535, 1, 2, 3, 4, 5, 6, 7].iter().flat_map(|s| s.to_le_bytes()).collect();
    assert_eq!(read(5123, false, shorts)[0], Vec3::new(0.0, 131_070.0, 2.0));
}

#[test]
fn what_a_file_requires_and_is_not_read_is_named_with_the_way_out() {
    let refused = |names: &str| {
        let rest = format!(r#""extensionsRequired":[{names}],"nodes":[]"#);
        from_bytes(&of_views(&rest, &[floats(&[0.0])]), None, &[]).unwrap_err().to_string()
    };
    assert_eq!(
        refused(r#""KHR_draco_mesh_compression""#),
        "requires the glTF extension KHR_draco_mesh_compression, which is not read: export it without compression (in Blender, \
         Data > Compression off)"
    );
    assert_eq!(
        refused(r#""KHR_mesh_quantization","EXT_meshopt_compression","VENDOR_voxels""#),
        "requires the glTF extension EXT_meshopt_compression and VENDOR_voxels, which is not read: pack it without compression \
         (gltfpack without -c and -cc), and export it without that"
    );
    // Looks are no part of a shape.
    assert_eq!(refused(r#""KHR_materials_unlit","KHR_texture_basisu""#), "holds no triangles");
}

#[test]
fn strips_and_fans_are_triangles_and_loose_edges_beside_them_are_left_out() {
    // Five places on a fan about the first.
    let places = [[0.0f32, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [0.0, 2.0, 0.0], [-2.0, 2.0, 0.0]];
    let numbers: Vec<u8> = places.concat().iter().flat_map(|x| x.to_le_bytes()).collect();
    let read = |modes: &[u8]| {
        let primitives: Vec<String> =
            modes.iter().map(|mode| format!(r#"{{"mode":{mode},"attributes":{{"POSITION":0}}}}"#)).collect();
        let json = format!(
            r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0,"name":"head"}}],
            "meshes":[{{"primitives":[{}]}}],"accessors":[{{"bufferView":0,"componentType":5126,"count":5,"type":"VEC3",
            "min":[-2,0,0],"max":[2,2,0]}}],"bufferViews":[{{"buffer":0,"byteLength":60}}],"buffers":[{{"byteLength":60}}]}}"#,
            primitives.join(",")
        );
        from_bytes(&crate::gltf_file::tests::glb(&json, &numbers), None, &[])
    };
    let (fan, said) = read(&[6]).unwrap();
    assert_eq!((fan.triangles, said.len()), (vec![[0, 1, 2], [0, 2, 3], [0, 3, 4]], 0));
    let (strip, _) = read(&[5]).unwrap();
    assert_eq!(strip.triangles, [[0, 1, 2], [2, 1, 3], [2, 3, 4]]);
    for (mode, what) in [(0, "points"), (1, "lines"), (2, "lines"), (3, "lines")] {
        let (beside, said) = read(&[mode, 6]).unwrap();
        assert_eq!((beside.positions.len(), beside.triangles.len()), (5, 3), "{mode}");
        assert_eq!(said, [format!("the {what} of head")]);
        let refused = read(&[mode]).unwrap_err().to_string();
        assert!(refused.contains(&format!("holds {what} and no triangles")), "{refused}");
    }
}

/// Of a triangle the first vertex hangs on a joint that stays, the last on one that rises by 4 in a second, the other on both; a morph
/// moves that one by 2 along z at full weight.
#[test]
fn a_clip_bends_a_mesh_by_joints_and_morphs() {
    let numbers: Vec<f32> = [
        vec![0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0],
        vec![0.0, 0.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0],
        vec![1.0, 0.0, 0.0, 0.0, 0.5, 0.5, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0],
        vec![0.0, 1.0],
        vec![0.0, 0.0, 0.0, 0.0, 4.0, 0.0],
        vec![0.0, 1.0],
    ]
    .concat();
    let mut binary: Vec<u8> = numbers.iter().flat_map(|x| x.to_le_bytes()).collect();
    binary.extend([0, 1, 0, 0].repeat(3));
    let view = |at: usize, length: usize| format!(r#"{{"buffer":0,"byteOffset":{at},"byteLength":{length}}}"#);
    let views = [view(0, 36), view(36, 36), view(72, 48), view(120, 8), view(128, 24), view(152, 8), view(160, 12)];
    let of = |view: usize, kind: u32, count: usize, shape: &str| {
        format!(
            r#"{{"bufferView":{view},"componentType":{kind},"count":{count},"type":"{shape}","min":[0,0,0],"max":[1,1,0]}}"#
        )
    };
    let accessors = [
        of(0, 5126, 3, "VEC3"),
        of(1, 5126, 3, "VEC3"),
        of(2, 5126, 3, "VEC4"),
        of(3, 5126, 2, "SCALAR"),
        of(4, 5126, 2, "VEC3"),
        of(5, 5126, 2, "SCALAR"),
        of(6, 5121, 3, "VEC4"),
    ];
    let face = r#"{"name":"face","mesh":0,"skin":0}"#;
    let rises = r#"{"sampler":0,"target":{"node":1,"path":"translation"}}"#;
    let json = |scene: &str, nodes: &str, joints: &str, channels: &str| {
        format!(
            r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[{scene}]}}],
        "nodes":[{nodes},{face}],
        "skins":[{{"joints":[{joints}]}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"JOINTS_0":6,"WEIGHTS_0":2}},"targets":[{{"POSITION":1}}]}}]}}],
        "animations":[{{"samplers":[{{"input":3,"output":4}},{{"input":3,"output":5}}],"channels":[{channels}]}}],
        "accessors":[{}],"bufferViews":[{}],"buffers":[{{"byteLength":{}}}]}}"#,
            accessors.join(","),
            views.join(","),
            binary.len()
        )
    };
    let file = |scene, nodes, joints, channels: &str| {
        crate::gltf_file::tests::glb(&json(scene, nodes, joints, channels), &binary)
    };
    // What moves may be a node above a joint. Above both joints it takes the mesh along as a whole.
    let bent = |scene, nodes, joints| bends(&file(scene, nodes, joints, rises), None, &[], "").unwrap();
    assert!(bent("0,1,3", r#"{"name":"still"},{"name":"helper","children":[2]},{"name":"joint"}"#, "0,2"));
    assert!(!bent("1,3", r#"{"name":"joint"},{"name":"helper","children":[0,2]},{"name":"joint"}"#, "0,2"));
    let morphs = r#"{"sampler":1,"target":{"node":2,"path":"weights"}}"#;
    let bytes = file("0,1,2", r#"{"name":"still"},{"name":"rising"}"#, "0,1", &format!("{rises},{morphs}"));
    assert!(bends(&bytes, None, &[], "").unwrap());
    let mut frames = Vec::new();
    each_bent(&bytes, None, &[], "", &[0.0, 0.25, 1.0], &mut |n, all| {
        assert_eq!(n, frames.len());
        frames.push(all);
        Ok(())
    })
    .unwrap();
    for (share, frame) in [0.0, 0.25, 1.0].into_iter().zip(frames) {
        let expected = [Vec3::ZERO, Vec3::new(1.0, 2.0 * share, 2.0 * share), Vec3::new(0.0, 1.0 + 4.0 * share, 0.0)];
        frame.iter().zip(expected).for_each(|(p, q)| assert!(p.distance(q) < 1e-6, "{share}: {p} for {q}"));
    }
}
