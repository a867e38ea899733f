//! USD layers and Alembic archives through this crate: heads, motion, units.

use std::path::{Path, PathBuf};

use glam::{DAffine3, DVec3, Quat, Vec3};
use nabiki::{Hair, Mesh, Strands};
use nabiki_exchange::{Course, Export, GroomReader};
use nabiki_io::exchange::{self, DeclaredSpace, MovingHair};
use nabiki_io::info::ExchangeInfo;
use nabiki_io::motion::{self, Axis, MotionSource};
use nabiki_io::moving::{self, ChainOptions};
use nabiki_io::placement::{Placement, Unit};
use nabiki_io::{CurvePrim, GroomFile};
use nabiki_io::{hair, mesh};
use nabiki_usd::StageReader;

const FRAMES: usize = 11;

fn pose(frame: usize) -> DAffine3 {
    let turn = Quat::from_rotation_y(0.05 * frame as f32);
    DAffine3::from_rotation_translation(turn.as_dquat(), Vec3::new(2.0 * frame as f32, 150.0, 0.0).as_dvec3())
}

fn strands() -> Strands {
    let mut strands = Strands::default();
    strands.push([Vec3::ZERO, Vec3::X, 2.0 * Vec3::X]);
    strands.push([Vec3::Y, 2.0 * Vec3::Y]);
    strands
}

fn write(folder: &Path, name: &str) -> PathBuf {
    let hair = Hair::from(strands());
    let skin = Mesh { positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y], triangles: vec![[0, 1, 2]], ..Mesh::default() };
    let mut export = Export::new(&hair, 20.0);
    export.head = Some(&skin);
    let path = folder.join(name);
    let mut sink = moving::sink(&path, export, None, ChainOptions::default()).unwrap();
    for frame in 0..FRAMES {
        sink.frame(&hair.strands, &pose(frame)).unwrap();
    }
    sink.finish().unwrap();
    path
}

#[test]
fn the_transforms_of_layers_and_archives_move_a_head() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["head.usda", "head.usdc", "head.abc"] {
        let file = write(folder.path(), name);
        let source = MotionSource {
            file: file.clone(),
            node: "head".into(),
            // Only Alembic must be told the unit.
            unit_cm: name.ends_with("abc").then_some(1.0),
            facing: Some(Axis::PlusX),
            ..MotionSource::default()
        };
        let motion = motion::read(&source, 10.0).unwrap();
        assert_eq!(motion.poses.len(), 6, "{}", motion.report);
        assert!(motion.report.contains("11 samples at 20 Hz (0.500 s) -> 6 frames at 10 Hz"), "{}", motion.report);
        for (n, found) in motion.poses.iter().enumerate() {
            let expected = pose(2 * n);
            assert!(found.position_cm.distance(expected.translation.as_vec3()) < 1e-4, "{name}, frame {n}");
            assert!(
                (found.rotation * Vec3::X).distance(expected.transform_vector3(DVec3::X).as_vec3()) < 1e-6,
                "{name}, frame {n}"
            );
        }
        let head = mesh::read(&file, &[]).unwrap();
        assert_eq!(head.triangles.len(), 1);
        assert_eq!(head.positions[0], pose(0).translation.as_vec3());
    }
}

#[test]
fn unit_and_up_axis_are_what_the_layer_says() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("metres.usdc");
    let said = DeclaredSpace { unit: Some(Unit { cm: 100.0 }), up: Some(Axis::PlusZ) };
    exchange::write(&path, &Hair::from(strands()), said).unwrap();
    assert_eq!(exchange::declared_space(&path).unwrap(), said);
    assert_eq!(hair::read(&path).unwrap().strands, strands());
    // Most decimals are no single: what a layer says in doubles comes back as it was.
    for metres in [1.0, 0.1, 0.01, 0.001, 0.0254, 0.3048, 0.9144, 1e-9, 1e6] {
        let from = folder.path().join("from.usda");
        let curves = "def BasisCurves \"h\" { uniform token type = \"linear\"\n int[] curveVertexCounts = [2]\n\
                      point3f[] points = [(0, 0, 0), (1, 0, 0)] }";
        std::fs::write(&from, format!("#usda 1.0\n( metersPerUnit = {metres} )\n{curves}\n")).unwrap();
        for name in ["to.usda", "to.usdc"] {
            let to = folder.path().join(name);
            exchange::write(&to, &hair::read(&from).unwrap(), exchange::declared_space(&from).unwrap()).unwrap();
            let said = StageReader::open(&to).unwrap().contents().unwrap().meters_per_unit;
            assert_eq!(said, Some(metres), "{name}");
        }
    }
    let archive = folder.path().join("hair.abc");
    hair::write(&archive, &Hair::from(strands())).unwrap();
    assert_eq!(exchange::declared_space(&archive).unwrap(), DeclaredSpace { unit: None, up: Some(Axis::PlusY) });
}

#[test]
fn opacities_keep_their_digits_and_are_transparencies_where_a_format_has_no_other_name() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let groom = "#usda 1.0\ndef BasisCurves \"h\" { uniform token type = \"linear\"\n int[] curveVertexCounts = [2]\n\
                 point3f[] points = [(0, 0, 0), (1, 0, 0)]\n\
                 float[] primvars:displayOpacity = [OPACITY, OPACITY] ( interpolation = \"vertex\" ) }\n";
    // In singles 1 - (1 - 0.1) is another number than 0.1, and 1 - (1 - 0.25) is 0.25.
    for (opacity, kept) in [(0.1_f32, true), (0.25, false)] {
        std::fs::write(at("groom.usda"), groom.replace("OPACITY", &opacity.to_string())).unwrap();
        let mut from = at("groom.usda");
        for name in ["1.usda", "2.usdc", "3.abc", "4.usda"] {
            let hair = hair::read(&from).unwrap();
            assert_eq!(hair.attributes.transparency, Some(vec![1.0 - opacity; 2]), "{name}");
            assert_eq!(hair.attributes.other.iter().any(|other| other.name == "displayOpacity"), kept, "{name}");
            assert_eq!(hair::write(&at(name), &hair).unwrap(), Vec::<String>::new(), "{name}");
            from = at(name);
        }
        let text = std::fs::read_to_string(&from).unwrap();
        let (_, written) = text.split_once("displayOpacity = [").unwrap();
        assert!(written.starts_with(&opacity.to_string()), "{text}");
        assert_eq!(hair::write(&at("h.hair"), &hair::read(&from).unwrap()).unwrap(), Vec::<String>::new());
    }
}

#[test]
fn moving_hair_goes_from_format_to_format_with_all_its_frames() {
    let folder = tempfile::tempdir().unwrap();
    let hair = Hair::from(strands());
    let frame = |n: usize| {
        let mut strands = strands();
        strands.points_mut().iter_mut().for_each(|p| *p += Vec3::Y * (n as f32).sin());
        strands
    };
    let first = folder.path().join("first.usdc");
    let mut export = Export::new(&hair, 30.0);
    export.first_frame = 5;
    let mut sink = moving::sink(&first, export, None, ChainOptions::default()).unwrap();
    // A kilometre away a single is 0.008 cm from the next.
    let pose = |n: usize| DAffine3::from_translation(DVec3::new(0.0, 0.0, -123_456.789)) * pose(n);
    for n in 0..FRAMES {
        sink.frame(&frame(n), &pose(n)).unwrap();
    }
    sink.finish().unwrap();
    let mut from = first;
    for name in ["second.abc", "third.usda", "fourth.abc", "fifth.usdc"] {
        let to = folder.path().join(name);
        let mut moving = MovingHair::open(&from, None).unwrap();
        assert_eq!((moving.frames(), moving.frame_rate()), (FRAMES, 30.0), "{name}");
        let hair = moving.hair().clone();
        let mut sink = moving::sink(&to, moving.export(&hair), None, ChainOptions::default()).unwrap();
        for n in 0..FRAMES {
            let (found, world_from_hair) = moving.frame(n).unwrap();
            assert_eq!((found.points(), world_from_hair), (frame(n).points(), pose(n)), "{name}, frame {n}");
            sink.frame(&found, &world_from_hair).unwrap();
        }
        sink.finish().unwrap();
        from = to;
    }
}

#[test]
fn a_layer_goes_over_the_prim_of_the_curves_and_over_no_other() {
    let folder = tempfile::tempdir().unwrap();
    let groom = write(folder.path(), "groom.usdc");
    let groom = GroomFile::open(&groom).unwrap().curves(&groom).unwrap();
    assert_eq!(groom.under_layer("/head/hair").unwrap().points, 5);
    for path in ["/head", "/head/skin", "/hair"] {
        let refused = groom.under_layer(path).unwrap_err().to_string();
        let line = format!("--export-layer {path}: its curves are at /head/hair (5 points)");
        assert!(refused.ends_with(&line), "{refused}");
    }
}

/// Seven control points a curve, of two curves.
const CUBIC: &str = "def BasisCurves \"h\" { uniform token type = \"cubic\"\n KIND\n int[] curveVertexCounts = [7, 7]\n\
    point3f[] points = POINTS }\n";

#[test]
fn a_layer_over_cubic_curves_draws_them_from_the_roots_to_the_tips() {
    let folder = tempfile::tempdir().unwrap();
    let (groom, layer) = (folder.path().join("groom.usda"), folder.path().join("layer.usda"));
    let place =
        |i: usize| format!("({}, {}, {})", 140.0 + i as f32, 3.0 * (0.7 * i as f32).sin(), 2.0 + (i * i) as f32);
    let points = (0..14).map(place).collect::<Vec<_>>().join(", ");
    for (basis, wrap) in [
        ("bezier", "nonperiodic"),
        ("bspline", "nonperiodic"),
        ("bspline", "pinned"),
        ("catmullRom", "nonperiodic"),
        ("catmullRom", "pinned"),
    ] {
        let kind = format!("uniform token basis = \"{basis}\"\n uniform token wrap = \"{wrap}\"");
        let text = |points: &str| format!("#usda 1.0\n{}", CUBIC.replace("KIND", &kind).replace("POINTS", points));
        std::fs::write(&groom, text(&format!("[{points}]"))).unwrap();
        let read = hair::read(&groom).unwrap();
        let mut export = Export::new(&read, 24.0);
        let curves = GroomFile::open(&groom).unwrap().curves(&groom).unwrap();
        exchange::under_groom(&mut export, curves.under_layer("/h").unwrap());
        let mut sink = moving::sink(&layer, export, Some("/h"), ChainOptions::default()).unwrap();
        sink.frame(&read.strands, &DAffine3::IDENTITY).unwrap();
        sink.finish().unwrap();
        // As the stage has it on which the layer lies over the groom.
        let over = std::fs::read_to_string(&layer).unwrap();
        let sample = over.split("points.timeSamples = {").nth(1).unwrap().lines().nth(1).unwrap();
        std::fs::write(&groom, text(sample.trim().trim_start_matches("0: ").trim_end_matches(','))).unwrap();
        let drawn = hair::read(&groom).unwrap();
        for (found, strand) in drawn.strands.iter().zip(read.strands.iter()) {
            let ends = [(found[0], strand[0]), (found[6], strand[6])];
            // Control points in steps of singles, below 256 here, blended by weights that add up to 1 and rounded once more.
            for (found, of) in ends {
                assert!((found - of).abs().max_element() <= 256.0 * f32::EPSILON, "{basis} {wrap}: {found} {of}");
            }
        }
    }
}

#[test]
fn a_layer_goes_over_curves_beside_which_others_have_no_points() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("groom.usda");
    let curves = "def BasisCurves \"e\" { }\ndef BasisCurves \"h\" { uniform token type = \"linear\"\n\
                  int[] curveVertexCounts = [2]\n point3f[] points = [(0, 0, 0), (1, 0, 0)] }\n";
    std::fs::write(&path, format!("#usda 1.0\n{curves}")).unwrap();
    let groom = GroomFile::open(&path).unwrap().curves(&path).unwrap();
    assert_eq!(groom.under_layer("/h").unwrap().points, 2);
}

#[test]
fn what_stands_in_a_file_is_listed_with_what_moves() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["list.usda", "list.usdc", "list.abc"] {
        let info = ExchangeInfo::of_file(&write(folder.path(), name)).unwrap();
        let mut found: Vec<_> = info.prims.iter().map(|p| (p.path.as_str(), p.what.as_str(), p.samples)).collect();
        found.sort();
        // Only Alembic sees that the hair's samples are all equal.
        let hair = if name.ends_with("abc") { None } else { Some(FRAMES) };
        let expected = [
            ("/head", "transform", Some(FRAMES)),
            ("/head/hair", "2 curves, 5 points", hair),
            ("/head/skin", "mesh, 1 faces, 3 points", None),
        ];
        assert_eq!(found, expected, "{name}");
        assert_eq!((info.frames, info.frame_rate), (FRAMES, Some(20.0)), "{name}");
    }
}

#[test]
fn a_layer_of_alembic_and_an_unknown_ending_are_refused_by_name() {
    let hair = Hair::from(strands());
    let refused = |name: &str, layer: Option<&str>| {
        let result = moving::sink(Path::new(name), Export::new(&hair, 24.0), layer, ChainOptions::default());
        result.err().unwrap().to_string()
    };
    assert_eq!(refused("hair.abc", Some("/a")), "hair.abc: Alembic has no layers: write .usd, .usda or .usdc");
    assert_eq!(
        refused("hair.fbx", None),
        "hair.fbx: moving hair is written as .usd, .usda, .usdc, .abc, .glb, .exr, .pc2 or .mdd"
    );
}

#[test]
fn what_of_a_layers_meshes_is_left_out_is_reported() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("head.usda");
    let mesh = |name: &str, more: &str| {
        format!(
            "def Mesh \"{name}\" {{ point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]\n int[] faceVertexCounts = [3]\n\
             int[] faceVertexIndices = [0, 1, 2]\n{more} }}\n"
        )
    };
    let text = format!("#usda 1.0\n{}{}", mesh("head", ""), mesh("low", "uniform token purpose = \"proxy\""));
    std::fs::write(&file, text).unwrap();
    let (mesh, report) = mesh::import(&file, &Placement::default(), &[]).unwrap();
    let said = "mesh /low, which is hidden: purpose of /low is \"proxy\"";
    assert_eq!((mesh.triangles.len(), report.unread), (1, vec![said.to_owned()]));
    let info = ExchangeInfo::of_file(&file).unwrap().to_string();
    assert!(info.lines().any(|line| line == format!("not read: {said}")), "{info}");
}

/// A layer in metres with z up, in which a head goes along x and turns to the left, with a curve on it.
const SHOT: &str = "#usda 1.0\n( metersPerUnit = 1\n upAxis = \"Z\"\n timeCodesPerSecond = 24 )\n\
    def Xform \"head\" { double3 xformOp:translate.timeSamples = { 1001: (0, 0, 1.5), 1003: (0.5, 0, 1.5) }\n\
    double xformOp:rotateZ.timeSamples = { 1001: 0, 1003: 90 }\n\
    uniform token[] xformOpOrder = [\"xformOp:translate\", \"xformOp:rotateZ\"]\n\
    def BasisCurves \"hair\" { uniform token type = \"linear\"\n int[] curveVertexCounts = [2]\n\
    point3f[] points.timeSamples = { 1001: [(0, 0, 0), (0, 0, 1)], 1002: [(0, 0, 0), (0, 1, 1)], 1003: [(0, 0, 0), (0, 2, 1)] } } }\n";

#[test]
fn the_motion_of_a_shot_is_in_the_unit_and_axes_of_its_layer_and_begins_at_its_frame() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("shot.usda");
    std::fs::write(&file, SHOT).unwrap();
    let source = MotionSource { file, facing: Some(Axis::PlusX), node: "head".into(), ..MotionSource::default() };
    let motion = motion::read(&source, 24.0).unwrap();
    assert_eq!((motion.poses.len(), motion.first_frame), (3, Some(1001)));
    for (n, pose) in motion.poses.iter().enumerate() {
        assert!(pose.position_cm.distance(Vec3::new(25.0 * n as f32, 150.0, 0.0)) < 1e-4, "{n}: {pose:?}");
        let turned = Quat::from_rotation_y((45.0 * n as f32).to_radians());
        assert!(pose.rotation.dot(turned).abs() > 1.0 - 1e-6, "{n}: {pose:?}");
    }
    assert_eq!(motion::read(&source, 48.0).unwrap().first_frame, Some(2002));
    let slow = MotionSource { speed: 0.5, ..source };
    assert_eq!(motion::read(&slow, 24.0).unwrap().first_frame, None);
}

#[test]
fn a_copy_of_moving_hair_is_told_the_unit_axes_and_frames_of_its_source() {
    let folder = tempfile::tempdir().unwrap();
    let (file, copy) = (folder.path().join("shot.usda"), folder.path().join("copy.usdc"));
    std::fs::write(&file, SHOT).unwrap();
    let mut moving = MovingHair::open(&file, None).unwrap();
    let hair = moving.hair().clone();
    let mut sink = moving::sink(&copy, moving.export(&hair), None, ChainOptions::default()).unwrap();
    for frame in 0..moving.frames() {
        let (points, world_from_hair) = moving.frame(frame).unwrap();
        sink.frame(&points, &world_from_hair).unwrap();
    }
    sink.finish().unwrap();
    let mut copied = StageReader::open(&copy).unwrap();
    let contents = copied.contents().unwrap();
    assert_eq!((contents.first_frame(), contents.times.len(), contents.frame_rate), (1001, 3, 24.0));
    assert_eq!((contents.meters_per_unit, contents.z_up), (Some(1.0), Some(true)));
    let tip = copied.hair(2, None).unwrap().strands.strand(0)[1];
    // Turned to the left, 2 along y is -2 along x.
    assert!(tip.distance(Vec3::new(-1.5, 0.0, 2.5)) < 1e-6, "{tip}");
}

#[test]
fn hair_of_every_kind_of_file_is_cut_into_as_many_segments_as_are_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["cut.hair", "cut.usda", "cut.usdc", "cut.abc"] {
        let path = folder.path().join(name);
        hair::write(&path, &Hair::from(strands())).unwrap();
        let cut = GroomFile::open(&path).unwrap().hair(0, Some(4)).unwrap();
        assert_eq!(cut.strands.starts(), [0, 5, 10], "{name}");
        // Of a strand that was two long, and of one that was one long.
        for (strand, points) in
            [[0.0, 0.5, 1.0, 1.5, 2.0].map(|x| Vec3::X * x), [1.0, 1.25, 1.5, 1.75, 2.0].map(|y| Vec3::Y * y)]
                .into_iter()
                .enumerate()
        {
            assert_eq!(cut.strands.strand(strand), points, "{name}");
        }
    }
}

#[test]
fn a_layer_goes_over_a_groom_of_which_every_point_is_used() {
    assert!(exchange::check_layer(Some(12), 12).is_ok());
    for (in_file, said) in [
        (Some(13), "11 of its 13 points are used"),
        (Some(12), "11 of its 12 points are used"),
        (None, "its hair is grown here"),
    ] {
        let refused = exchange::check_layer(in_file, 11).unwrap_err().to_string();
        assert!(refused.starts_with("a layer would not fit the groom: ") && refused.contains(said), "{refused}");
    }
}

#[test]
fn a_layer_that_says_nothing_is_in_centimetres_with_y_up() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("bare.usda");
    std::fs::write(&file, "#usda 1.0\ndef Xform \"a\" { }\n").unwrap();
    let said = DeclaredSpace { unit: Some(Unit { cm: 1.0 }), up: Some(Axis::PlusY) };
    assert_eq!(exchange::declared_space(&file).unwrap(), said);
}

#[test]
fn imported_hair_goes_back_into_its_file_and_under_the_transform_of_its_curves() {
    let hair = Hair::from(strands());
    let placement =
        Placement { unit: Unit { cm: 100.0 }, up: Axis::PlusZ, facing: Axis::PlusX, origin: Vec3::new(0.0, 0.0, 1.5) };
    let mut export = exchange::export(&hair, 24.0, Some(&placement));
    assert_eq!((export.meters_per_unit, export.z_up), (1.0, true));
    // A metre before the face, half of one above the origin, two to the right.
    let place = DVec3::new(100.0, 50.0, 200.0);
    assert!(export.file_from_head.transform_point3(place).distance(DVec3::new(1.0, -2.0, 2.0)) < 1e-12);
    let world_from_curves = DAffine3::from_translation(DVec3::X) * DAffine3::from_scale(DVec3::splat(0.5));
    let course = Course::LINEAR;
    let groom = CurvePrim { path: "/hair".to_owned(), points: 5, course, world_from_curves, bound: false };
    exchange::under_groom(&mut export, &groom);
    assert!(export.file_from_head.transform_point3(place).distance(DVec3::new(0.0, -4.0, 4.0)) < 1e-12);
    let own = exchange::export(&hair, 24.0, None);
    assert_eq!((own.meters_per_unit, own.z_up, own.file_from_head), (0.01, false, DAffine3::IDENTITY));
}
