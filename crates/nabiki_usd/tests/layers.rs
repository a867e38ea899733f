//! Layers written and read back, layers as other programs write them, and damaged ones refused.
//! That other programs read ours is `tests/interchange`.

use std::io::Cursor;
use std::path::Path;

use glam::{DAffine3, Quat, Vec2, Vec3};
use nabiki::hair::Attributes;
use nabiki::{Hair, Mesh, Strands};
use nabiki_exchange::{Export, FrameSink, GroomReader, Placed};
use nabiki_usd::{HairStage, LayerKind, StageReader};
use proptest::prelude::*;

const FRAMES: usize = 9;
const NAMES: [&str; 2] = ["hair.usda", "hair.usdc"];

fn strands(frame: usize) -> Strands {
    let mut strands = Strands::default();
    for s in 0..40 {
        let swing = (0.3 * frame as f32 + s as f32).sin();
        let point = |p: usize| Vec3::new(0.1 * s as f32 + swing * p as f32 * 1e-7, -(p as f32), swing);
        strands.push((0..2 + s % 5).map(point));
    }
    strands
}

fn groom() -> Hair {
    let mut hair = Hair::from(strands(0));
    let (n, points) = (hair.strands.len(), hair.strands.points().len());
    hair.attributes = Attributes {
        id: Some((0..n as i64).map(|s| 7 * s - (1 << 40)).collect()),
        root_uv: Some((0..n).map(|s| [s as f32 / n as f32, 0.25]).collect()),
        group: Some((0..n as i32).map(|s| s % 3).collect()),
        group_names: [(0, "a \"fringe\" \\ of\nsorts".to_owned()), (2, "back".to_owned())].into(),
        guide: Some((0..n).map(|s| s % 7 == 0).collect()),
        width: Some((0..points).map(|p| 0.008 + 1e-5 * p as f32).collect()),
        colour: Some((0..points).map(|p| [0.1, 0.001 * p as f32, 0.02]).collect()),
        point_uv: Some((0..points).map(|p| [0.5, p as f32]).collect()),
        transparency: Some((0..points).map(|p| 1.0 / (1.0 + p as f32)).collect()),
        inverse_mass: Some((0..points).map(|p| f32::from(u8::from(p % 2 == 0))).collect()),
        ..Attributes::default()
    };
    hair
}

fn pose(frame: usize) -> DAffine3 {
    let turn = Quat::from_rotation_y(0.1 * frame as f32);
    DAffine3::from_rotation_translation(turn.as_dquat(), Vec3::new(frame as f32, 150.0, 0.0).as_dvec3())
}

fn bytes(name: &str, export: Export<'_>, form: LayerKind, poses: impl Fn(usize) -> DAffine3) -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    let mut sink = Box::new(HairStage::create(&path, export, form).unwrap());
    for frame in 0..FRAMES {
        sink.frame(&strands(frame), &poses(frame)).unwrap();
    }
    sink.finish().unwrap();
    std::fs::read(path).unwrap()
}

fn reader(file: impl Into<Vec<u8>>) -> StageReader {
    StageReader::new(Cursor::new(file.into())).unwrap()
}

fn tetrahedron() -> Mesh {
    Mesh {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z],
        triangles: vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
        ..Mesh::default()
    }
}

/// A place of the texture for each corner, which differs from face to face as along a seam.
fn textured() -> Mesh {
    let mut mesh = tetrahedron();
    let at = |t: usize, v: u32| Vec2::new(0.125 * t as f32, 0.25 * v as f32);
    mesh.corner_uvs = Some(mesh.triangles.iter().enumerate().map(|(t, vs)| vs.map(|v| at(t, v))).collect());
    mesh
}

/// Of every corner its vertex and its place of the texture, triangle by triangle, however these begin.
fn corners(mesh: &Mesh) -> Vec<Vec<(u32, [u32; 2])>> {
    let uvs = mesh.corner_uvs.as_ref().unwrap().iter();
    let of = |(vs, uvs): (&[u32; 3], &[Vec2; 3])| {
        let mut corners: Vec<_> = vs.iter().zip(uvs).map(|(&v, uv)| (v, uv.to_array().map(f32::to_bits))).collect();
        corners.sort_unstable();
        corners
    };
    mesh.triangles.iter().zip(uvs).map(of).collect()
}

#[test]
fn the_skin_keeps_its_texture_coordinates_also_where_it_is_mirrored() {
    let (hair, mesh) = (groom(), textured());
    for (name, scale) in NAMES.into_iter().flat_map(|name| [Vec3::ONE, Vec3::new(-1.0, 1.0, 1.0)].map(|s| (name, s))) {
        let mut export = Export::new(&hair, 24.0);
        (export.head, export.file_from_head) = (Some(&mesh), DAffine3::from_scale(scale.as_dvec3()));
        let skin = reader(bytes(name, export, LayerKind::Stage, |_| DAffine3::IDENTITY)).mesh().unwrap();
        assert_eq!(corners(&skin), corners(&mesh), "{name}, {scale}");
    }
}

#[test]
fn every_frame_and_attribute_comes_back_to_the_bit() {
    let hair = groom();
    for name in NAMES {
        let mut export = Export::new(&hair, 30.0);
        export.first_frame = -3;
        let mut stage = reader(bytes(name, export, LayerKind::Stage, |_| DAffine3::IDENTITY));
        let contents = stage.contents().unwrap();
        assert_eq!(contents.curves, ["/head/hair"]);
        assert_eq!((contents.meters_per_unit, contents.z_up, contents.frame_rate), (Some(0.01), Some(false), 30.0));
        assert_eq!(contents.times, (-3..6).map(|n| f64::from(n) / 30.0).collect::<Vec<_>>());
        assert_eq!(contents.first_frame(), -3);
        for frame in 0..FRAMES {
            let read = stage.hair(frame, None).unwrap();
            assert_eq!(read.strands, strands(frame), "{name}, frame {frame}");
            assert_eq!(read.attributes, hair.attributes, "{name}");
        }
    }
}

#[test]
fn text_is_the_same_wherever_it_is_cut_into_parts() {
    // Text is read a quarter of a megabyte at a time: a comment of any length moves all that follows it.
    let long: Vec<Vec3> =
        (0..20_000).map(|i| Vec3::new((i as f32).sin(), -1e-7 * i as f32, 1.5e9 / i as f32)).collect();
    let mut hair = Hair::from(Strands::default());
    long[1..].chunks(1000).for_each(|strand| hair.strands.push(strand.iter().copied()));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("long.usda");
    let mut sink = Box::new(HairStage::create(&path, Export::new(&hair, 24.0), LayerKind::Stage).unwrap());
    sink.frame(&hair.strands, &DAffine3::IDENTITY).unwrap();
    sink.finish().unwrap();
    let text = std::fs::read_to_string(path).unwrap();
    assert!(text.len() > 3 << 18);
    for length in 0..70 {
        let moved = text.replacen("\n", &format!("\n#{}\n", "x".repeat(length)), 1);
        assert_eq!(reader(moved).hair(0, None).unwrap().strands, hair.strands, "moved by {length}");
    }
}

#[test]
fn comments_of_any_kind_stand_between_prims_and_values_also_at_the_end_of_a_window() {
    let text = "/* a * block { */ def Xform \"a\" // a line {\n{ /* of\n two ** lines */ def BasisCurves \"h\" /**/ {\n\
                rel x = [</a/b>, /* </c */ </d>]\n uniform token type = \"linear\" // no cubic\n int[] curveVertexCounts = [2]\n\
                point3f[] points = [(0, 0, 0), /* ) ] 7 */ (1, // 8 ]\n 2, 3)] # (\n } // }\n }\n//";
    // The window holds 2^18 bytes: a comment before it moves its end through all that follows.
    for length in (0..8).chain((1 << 18) - text.len() - 40..(1 << 18)) {
        let hair = reader(format!("#usda 1.0\n#{}\n{text}", "x".repeat(length))).hair(0, None).unwrap();
        assert_eq!(hair.strands.points(), [Vec3::ZERO, Vec3::new(1.0, 2.0, 3.0)], "moved by {length}");
    }
    let open = StageReader::new(Cursor::new(b"#usda 1.0\n/* def".to_vec())).map(|_| ()).unwrap_err().to_string();
    assert_eq!(open, "line 2: a comment is never closed");
}

#[test]
fn paths_of_files_may_hold_the_sign_that_encloses_them() {
    for path in ["@a.usd@", "@@@a@b.usd@@@", "@@@a\\@@@b.usd@@@", "@@@a@b@@@@@", "@@@a@@@", "@@"] {
        for value in [format!("{path}</x>"), format!("[{path}, {path}</x>]")] {
            let text = format!(
                "#usda 1.0\ndef Xform \"a\" ( payload = {value} ) {{ asset b = {path} }}\n\
                 def BasisCurves \"h\" {{ uniform token type = \"linear\"\n int[] curveVertexCounts = [2]\n\
                 point3f[] points = [(0, 0, 0), (1, 0, 0)] }}\n"
            );
            assert_eq!(reader(text).hair(0, None).unwrap().strands.len(), 1, "{value}");
        }
    }
}

#[test]
fn the_moving_head_carries_hair_and_skin() {
    let (hair, mesh) = (groom(), tetrahedron());
    for name in NAMES {
        let mut export = Export::new(&hair, 24.0);
        export.head = Some(&mesh);
        let mut stage = reader(bytes(name, export, LayerKind::Stage, pose));
        for frame in 0..FRAMES {
            let read = stage.hair(frame, None).unwrap();
            for (&p, &q) in read.strands.points().iter().zip(strands(frame).points()) {
                assert!(p.as_dvec3().distance(pose(frame).transform_point3(q.as_dvec3())) < 5e-5, "f32 near 150");
            }
        }
        let motion = stage.motion("head").unwrap();
        assert_eq!(motion.len(), FRAMES);
        for (frame, Placed { time, position, rotation, .. }) in motion.into_iter().enumerate() {
            assert!((time - frame as f64 / 24.0).abs() < 1e-12);
            assert_eq!(position.as_vec3(), pose(frame).translation.as_vec3());
            assert!(1.0 - rotation.as_quat().dot(Quat::from_rotation_y(0.1 * frame as f32)).abs() < 1e-6);
        }
        let skin = stage.mesh().unwrap();
        assert_eq!(skin.triangles, mesh.triangles);
        assert_eq!(skin.positions[1], pose(0).transform_point3(glam::DVec3::X).as_vec3());
    }
}

#[test]
fn a_layer_of_samples_holds_nothing_else() {
    let hair = groom();
    let form = || LayerKind::Layer("/character/grp_1/hair".to_owned());
    let text = bytes("layer.usda", Export::new(&hair, 24.0), form(), pose);
    let text = String::from_utf8(text).unwrap();
    for line in ["over \"character\"", "over \"grp_1\"", "over \"hair\"", "point3f[] points.timeSamples = {"] {
        assert!(text.contains(line), "{line}");
    }
    for line in ["widths", "curveVertexCounts", "xformOp", "def ", "points = "] {
        assert!(!text.contains(line), "{line}");
    }
    let binary = bytes("layer.usdc", Export::new(&hair, 24.0), form(), pose);
    assert!(binary.len() < FRAMES * (hair.strands.points().len() * 12 + 200) + 1500, "{}", binary.len());
    for path in ["", "hair", "/a//b", "/1a", "/a b", "/"] {
        let form = LayerKind::Layer(path.to_owned());
        assert!(HairStage::create(Path::new("x.usda"), Export::new(&hair, 24.0), form).is_err(), "{path}");
    }
}

#[test]
fn a_layer_over_a_groom_on_a_skeleton_takes_it_off_and_places_it() {
    let hair = groom();
    let export = Export { bound: true, ..Export::new(&hair, 24.0) };
    let form = || LayerKind::Layer("/character/hair".to_owned());
    let text = String::from_utf8(bytes("layer.usda", export.clone(), form(), pose)).unwrap();
    for line in [
        "prepend apiSchemas = [\"SkelBindingAPI\"]",
        "rel skel:skeleton = None",
        "matrix4d xformOp:transform:moved.timeSamples = {",
        "uniform token[] xformOpOrder = [\"!resetXformStack!\", \"xformOp:transform:moved\"]",
    ] {
        assert_eq!(text.matches(line).count(), 1, "{line}");
    }
    // Text and binary are read alike, as far as an over says anything by itself.
    for name in NAMES {
        let prims = reader(bytes(name, export.clone(), form(), pose)).prims().unwrap();
        let hair = prims.last().unwrap();
        assert_eq!(
            (hair.path.as_str(), hair.samples, &hair.relationships),
            ("/character/hair", FRAMES, &Vec::new()),
            "{name}"
        );
    }
    // A complete stage is on no skeleton.
    let stage = String::from_utf8(bytes("stage.usda", export, LayerKind::Stage, pose)).unwrap();
    assert!(!stage.contains("skel:") && !stage.contains("apiSchemas"));
}

#[test]
fn a_groom_goes_back_into_its_own_space() {
    // A file in metres with z up: what an importer would have applied, and its inverse for the way back.
    let head_from_file = DAffine3::from_scale(glam::DVec3::splat(100.0))
        * DAffine3::from_mat3(glam::DMat3::from_cols(glam::DVec3::X, glam::DVec3::NEG_Z, glam::DVec3::Y));
    let mut hair = Hair::from(strands(0));
    hair.attributes.constant.width = Some(0.01);
    let mut export = Export::new(&hair, 24.0);
    export.file_from_head = head_from_file.inverse();
    export.meters_per_unit = 1.0;
    export.z_up = true;
    for name in NAMES {
        let mut stage = reader(bytes(name, export.clone(), LayerKind::Stage, pose));
        assert_eq!(stage.contents().unwrap().z_up, Some(true));
        let read = stage.hair(4, None).unwrap();
        for (&p, &q) in read.strands.points().iter().zip(strands(4).points()) {
            let expected = (head_from_file.inverse() * pose(4)).transform_point3(q.as_dvec3());
            assert!(p.as_dvec3().distance(expected) < 1e-6, "{p} {expected}");
        }
        assert!((read.attributes.width.unwrap()[0] - 1e-4).abs() < 1e-10);
    }
}

#[test]
fn widths_and_points_at_rest_are_in_the_files_unit_too() {
    let mut hair = Hair::from(strands(0));
    let points = hair.strands.points().len();
    hair.attributes.width = Some((0..points).map(|p| 0.25 + p as f32).collect());
    for name in NAMES {
        let mut export = Export::new(&hair, 24.0);
        (export.file_from_head, export.rest) = (DAffine3::from_scale(glam::DVec3::splat(0.5)), true);
        let read = reader(bytes(name, export, LayerKind::Stage, |_| DAffine3::IDENTITY)).hair(0, None).unwrap();
        assert_eq!(read.attributes.width, Some((0..points).map(|p| 0.125 + 0.5 * p as f32).collect()), "{name}");
        let rest = read.attributes.other.iter().find(|other| other.name == "rest").unwrap();
        let halved = read.strands.points().iter().flat_map(|p| p.to_array()).collect();
        assert_eq!(read.strands.points()[5], 0.5 * hair.strands.points()[5], "{name}");
        assert_eq!(rest.values, nabiki::hair::Values::Floats(halved), "{name}");
    }
}

const CUBIC: &str = r#"#usda 1.0
(
    "A groom as some tool might write it"
    metersPerUnit = 1
    upAxis = "Z"
    customLayerData = { string note = "points = [(" }
)

class "_unused" { }

def Xform "rig" (
    kind = "group"
    prepend apiSchemas = ["X"]
)
{
    double3 xformOp:translate = (1, 2, 3)
    float3 xformOp:rotateXYZ.timeSamples = { 0: (0, 0, 0), 10: (90, 0, 90), }
    float3 xformOp:scale:all = (2, 2, 2)
    uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:rotateXYZ", "xformOp:scale:all"]
    rel proxyPrim = </rig/groom>
    custom bool nothing
    def BasisCurves "groom" # a comment with { brackets (
    {
        uniform token basis = "bspline"
        uniform token type = "cubic"
        uniform token wrap = "pinned"
        int[] curveVertexCounts = [4, 5]
        point3f[] points = [(0, 0, 0), (0, 0, 1), (0, 0, 2), (0, 0, 3), (1, 0, 0), (1, 0, 1), (1, 0, 2), (1, 0, 3), (1, 0, 4)]
        float[] widths = [0.1, 0.2] ( interpolation = "uniform" )
        int[] primvars:groom_id = [8, 9] (interpolation = "uniform")
        texCoord2f[] primvars:st = [(0.5, 0.25)] (interpolation = "uniform")
        int[] primvars:st:indices = [0, 0]
        token visibility.connect = </rig.vis>
    }
}
"#;

#[test]
fn cubic_curves_are_walked_and_keep_what_they_carry() {
    let mut stage = reader(CUBIC);
    let contents = stage.contents().unwrap();
    assert_eq!((contents.meters_per_unit, contents.z_up), (Some(1.0), Some(true)));
    let hair = stage.hair(0, Some(6)).unwrap();
    assert_eq!(hair.strands.starts(), [0, 7, 14]);
    assert_eq!(hair.attributes.id, Some(vec![8, 9]));
    assert_eq!(hair.attributes.root_uv, Some(vec![[0.5, 0.25]; 2]));
    // Widths are doubled by the scale above, as the lengths are.
    assert_eq!(hair.attributes.width.unwrap()[6..8], [0.2, 0.4]);
    // Pinned splines of points on a line reach from the first to the last of them.
    for (s, length) in [(0, 3.0), (1, 4.0)] {
        for (i, p) in hair.strands.strand(s).iter().enumerate() {
            let expected = Vec3::new(1.0 + 2.0 * s as f32, 2.0, 3.0 + 2.0 * length * i as f32 / 6.0);
            assert!(p.distance(expected) < 1e-5, "{p} {expected}");
        }
    }
    let motion = stage.motion("/rig").unwrap();
    let last = motion.last().unwrap();
    let turned = last.rotation * glam::DVec3::X;
    // About x first, then about z: x goes to y.
    assert!((last.time - 10.0 / 24.0).abs() < 1e-12 && turned.distance(glam::DVec3::Y) < 1e-9, "{turned}");
}

#[test]
fn values_stored_by_index_are_looked_up() {
    let stored = "int[] primvars:groom_group_id = [3, 8]\n        int[] primvars:groom_group_id:indices = [1, 0]\n        \
                  string[] primvars:groom_group_name = [\"back\", \"it's a \\\"fringe\\\"\"]\n        \
                  int[] primvars:groom_group_name:indices = [1, 0]\n        token visibility.connect";
    let hair = reader(CUBIC.replace("token visibility.connect", stored)).hair(0, Some(6)).unwrap();
    assert_eq!(hair.attributes.group, Some(vec![8, 3]));
    let names = [(3, "back".to_owned()), (8, "it's a \"fringe\"".to_owned())];
    assert_eq!(hair.attributes.group_names, names.into());
    let past = CUBIC.replace("token visibility.connect", &stored.replace("[1, 0]", "[1, 2]"));
    let unread = reader(past).hair(0, None).unwrap().attributes.unread;
    for name in ["groom_group_id", "groom_group_name"] {
        assert!(unread.contains(&format!("{name}: some of its indices name no value")), "{unread:?}");
    }
}

#[test]
fn what_is_not_said_is_bezier_and_what_is_closed_is_refused() {
    let unsaid = CUBIC.replace("uniform token type = \"cubic\"", "").replace("uniform token basis = \"bspline\"", "");
    let problem = reader(unsaid).hair(0, None).unwrap_err().to_string();
    assert!(problem.contains("5 control points do not make a pinned Bezier curve"), "{problem}");
    let problem = reader(CUBIC.replace("pinned", "periodic")).hair(0, None).unwrap_err().to_string();
    assert!(problem.contains("closed"), "{problem}");
    let problem = reader("#usda 1.0\ndef Xform \"a\" ( references = @b.usda@ ) { }").hair(0, None).unwrap_err();
    assert!(problem.to_string().contains("flatten"), "{problem}");
}

#[test]
fn truncated_and_lying_layers_are_errors() {
    let hair = groom();
    for name in NAMES {
        let file = bytes(name, Export::new(&hair, 24.0), LayerKind::Stage, pose);
        for length in (0..file.len() - 4).step_by(61) {
            let cut = StageReader::new(Cursor::new(file[..length].to_vec())).and_then(|mut s| s.hair(FRAMES - 1, None));
            assert!(cut.is_err(), "{name}: {length} of {} bytes", file.len());
        }
    }
    for (from, to) in [
        ("[4, 5]", "[4, 6]"),
        ("[4, 5]", "[4, -5]"),
        ("[4, 5]", "[4, 99999999999999999999]"),
        ("[4, 5]", "[4, nan]"),
        ("(0, 0, 1)", "(0, 0, inf)"),
        ("(0, 0, 1)", "(0, 0, 1"),
        ("= (1, 2, 3)", "= (1, 2)"),
        ("\"rig\"", "\"rig"),
        ("10:", "x:"),
        ("def Xform", "fed Xform"),
    ] {
        assert!(CUBIC.contains(from), "{from}");
        let broken = CUBIC.replacen(from, to, 1);
        let result = StageReader::new(Cursor::new(broken.into_bytes())).and_then(|mut s| s.hair(0, Some(4)));
        assert!(result.is_err(), "{from} -> {to}");
    }
    let deep = "#usda 1.0\n".to_owned() + &"def \"a\" {".repeat(100_000);
    assert!(StageReader::new(Cursor::new(deep.into_bytes())).is_err());
    let brackets = "#usda 1.0\n(a = ".to_owned() + &"[".repeat(1_000_000);
    assert!(StageReader::new(Cursor::new(brackets.into_bytes())).is_err());
}

#[test]
fn tables_that_claim_more_than_the_file_are_refused() {
    let hair = groom();
    let sound = bytes("hair.usdc", Export::new(&hair, 24.0), LayerKind::Stage, pose);
    let list = u64::from_le_bytes(sound[16..24].try_into().unwrap()) as usize;
    for entry in 0..6 {
        let start = list + 8 + 32 * entry;
        let section = u64::from_le_bytes(sound[start + 16..start + 24].try_into().unwrap()) as usize;
        for (at, value) in [(section, u64::MAX), (section, 1 << 40), (start + 16, u64::MAX), (start + 24, u64::MAX)] {
            let mut lying = sound.clone();
            lying[at..at + 8].copy_from_slice(&value.to_le_bytes());
            assert!(StageReader::new(Cursor::new(lying)).is_err(), "entry {entry}, byte {at}: {value}");
        }
    }
}

/// Reads all there is; only a panic, or never coming back, is wrong.
fn read_whatever(file: Vec<u8>) {
    let Ok(mut stage) = StageReader::new(Cursor::new(file)) else { return };
    let _ = stage.contents();
    for frame in [0, 1, 7, usize::MAX] {
        let _ = stage.hair(frame, None);
    }
    let _ = stage.hair(2, Some(5));
    let _ = stage.mesh();
    let _ = stage.motion("head");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn damaged_layers_cause_no_panic(
        kind in 0..3usize,
        hits in prop::collection::vec((0.0..1.0f64, any::<u8>()), 1..12),
        near_the_end in any::<bool>(),
    ) {
        thread_local!(static FILES: [Vec<u8>; 3] = {
            let (hair, mesh) = (groom(), tetrahedron());
            let mut export = Export::new(&hair, 24.0);
            export.head = Some(&mesh);
            let [text, binary] = NAMES.map(|name| bytes(name, export.clone(), LayerKind::Stage, pose));
            [text, binary, CUBIC.as_bytes().to_vec()]
        });
        let mut file = FILES.with(|files| files[kind].clone());
        // Tables lie near the end of binary layers, where damage does most.
        let first = if near_the_end { file.len().saturating_sub(2500) } else { 0 };
        for (place, value) in hits {
            let at = first + (place * (file.len() - first) as f64) as usize;
            file[at] = value;
        }
        read_whatever(file);
    }
}
