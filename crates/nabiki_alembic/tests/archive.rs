//! Archives written and read back, and damaged ones refused. That other programs read them is `tests/interchange`.

use std::io::Cursor;
use std::path::Path;

use glam::{DAffine3, Quat, Vec2, Vec3};
use nabiki::hair::{Attributes, Other, Per, Role, Stored, Values};
use nabiki::{Hair, Mesh, Strands};
use nabiki_alembic::{ArchiveReader, HairArchive};
use nabiki_exchange::{Export, FrameSink, GroomReader, Placed};
use proptest::prelude::*;

const FRAMES: usize = 12;

fn strands(frame: usize) -> Strands {
    let mut strands = Strands::default();
    for s in 0..40 {
        let swing = (0.3 * frame as f32 + s as f32).sin();
        let point = |p: usize| Vec3::new(0.1 * s as f32 + swing * p as f32 * 0.1, -(p as f32), swing);
        strands.push((0..2 + s % 5).map(point));
    }
    strands
}

fn groom() -> Hair {
    let mut hair = Hair::from(strands(0));
    let (n, points) = (hair.strands.len(), hair.strands.points().len());
    hair.attributes = Attributes {
        id: Some((0..n as i64).map(|s| 7 * s).collect()),
        root_uv: Some((0..n).map(|s| [s as f32 / n as f32, 0.25]).collect()),
        group: Some((0..n as i32).map(|s| s % 3).collect()),
        group_names: [(0, "fringe".to_owned()), (2, "back".to_owned())].into(),
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

fn write(path: &Path, export: Export<'_>, poses: impl Fn(usize) -> DAffine3) {
    let mut sink = Box::new(HairArchive::create(path, export).unwrap());
    for frame in 0..FRAMES {
        sink.frame(&strands(frame), &poses(frame)).unwrap();
    }
    sink.finish().unwrap();
}

fn bytes(export: Export<'_>, poses: impl Fn(usize) -> DAffine3) -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("hair.abc");
    write(&path, export, poses);
    std::fs::read(path).unwrap()
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
    for scale in [Vec3::ONE, Vec3::new(-1.0, 1.0, 1.0)] {
        let mut export = Export::new(&hair, 24.0);
        (export.head, export.file_from_head) = (Some(&mesh), DAffine3::from_scale(scale.as_dvec3()));
        let file = bytes(export, |_| DAffine3::IDENTITY);
        let skin = ArchiveReader::new(Cursor::new(&file)).unwrap().mesh().unwrap();
        assert_eq!(corners(&skin), corners(&mesh), "{scale}");
    }
}

#[test]
fn texture_coordinates_that_are_none_cost_themselves_and_not_the_head() {
    let (hair, sound) = (groom(), textured());
    let with = |change: &dyn Fn(&mut Vec<[Vec2; 3]>)| {
        let mut mesh = sound.clone();
        change(mesh.corner_uvs.as_mut().unwrap());
        let mut export = Export::new(&hair, 24.0);
        export.head = Some(&mesh);
        bytes(export, |_| DAffine3::IDENTITY)
    };
    // As they are, for something else than corners.
    let of = |scope: &[u8; 3]| {
        let mut file = with(&|_| ());
        let key = b"geoScope=fvr";
        let found: Vec<usize> =
            file.windows(key.len()).enumerate().filter(|(_, w)| w == key).map(|(at, _)| at).collect();
        assert!(!found.is_empty());
        found.into_iter().for_each(|at| file[at + 9..at + 12].copy_from_slice(scope));
        file
    };
    for (what, file) in [
        ("none at all", with(&|uvs| uvs.clear())),
        ("a face short", with(&|uvs| uvs.truncate(3))),
        ("a face too many", with(&|uvs| uvs.push([Vec2::ZERO; 3]))),
        ("no number", with(&|uvs| uvs[2][1].x = f32::NAN)),
        ("without end", with(&|uvs| uvs[0][0].y = f32::INFINITY)),
        ("of vertices", of(b"vtx")),
        ("of faces", of(b"uni")),
        ("of the whole", of(b"con")),
        ("of nobody knows what", of(b"???")),
    ] {
        let mut archive = ArchiveReader::new(Cursor::new(&file)).unwrap();
        let (skin, lost) = archive.meshes_with_losses(&|_| true).unwrap_or_else(|e| panic!("{what}: {e}"));
        assert_eq!((skin.positions, skin.triangles.len()), (sound.positions.clone(), 4), "{what}");
        assert_eq!(skin.corner_uvs, None, "{what}");
        assert!(lost.len() == 1 && lost[0].starts_with("texture coordinates of /head/skin: "), "{what}: {lost:?}");
    }
    let (skin, lost) = ArchiveReader::new(Cursor::new(&with(&|_| ()))).unwrap().meshes_with_losses(&|_| true).unwrap();
    assert!(skin.corner_uvs.is_some() && lost.is_empty());
}

#[test]
fn every_frame_and_attribute_comes_back_to_the_bit() {
    let hair = groom();
    let file = bytes(Export::new(&hair, 24.0), |_| DAffine3::IDENTITY);
    let mut archive = ArchiveReader::new(Cursor::new(&file)).unwrap();
    let contents = archive.contents().unwrap();
    assert_eq!((contents.times.len(), contents.frame_rate), (FRAMES, 24.0));
    for frame in 0..FRAMES {
        let read = archive.hair(frame, None).unwrap();
        assert_eq!(read.strands, strands(frame), "frame {frame}");
        assert_eq!(read.attributes, hair.attributes);
    }
}

#[test]
fn ids_beyond_32_bits_and_one_width_for_all_survive() {
    let mut hair = Hair::from(strands(0));
    hair.attributes.id = Some((0..40).map(|s| (1i64 << 40) + s).collect());
    hair.attributes.constant.width = Some(0.007);
    let file = bytes(Export::new(&hair, 30.0), |_| DAffine3::IDENTITY);
    let read = ArchiveReader::new(Cursor::new(&file)).unwrap().hair(3, None).unwrap();
    assert_eq!(read.attributes.id, hair.attributes.id);
    assert_eq!(read.attributes.width, Some(vec![0.007; hair.strands.points().len()]));
}

#[test]
fn the_moving_head_carries_hair_and_skin() {
    let (hair, mesh) = (groom(), tetrahedron());
    let mut export = Export::new(&hair, 24.0);
    export.head = Some(&mesh);
    export.first_frame = 10;
    let file = bytes(export, pose);
    let mut archive = ArchiveReader::new(Cursor::new(&file)).unwrap();
    assert!((archive.contents().unwrap().times[0] - 10.0 / 24.0).abs() < 1e-12);
    for frame in 0..FRAMES {
        let read = archive.hair(frame, None).unwrap();
        for (&p, &q) in read.strands.points().iter().zip(strands(frame).points()) {
            assert!(p.as_dvec3().distance(pose(frame).transform_point3(q.as_dvec3())) < 5e-5, "f32 near 150");
        }
    }
    let motion = archive.motion("head").unwrap();
    assert_eq!(motion.len(), FRAMES);
    for (frame, Placed { time, position, rotation, .. }) in motion.into_iter().enumerate() {
        assert!((time - (10 + frame) as f64 / 24.0).abs() < 1e-12);
        assert_eq!(position.as_vec3(), pose(frame).translation.as_vec3());
        let turn = Quat::from_rotation_y(0.1 * frame as f32);
        assert!(1.0 - rotation.as_quat().dot(turn).abs() < 1e-6);
    }
    let skin = archive.mesh().unwrap();
    assert_eq!(skin.triangles.len(), 4);
    assert_eq!(skin.positions[1], pose(0).transform_point3(glam::DVec3::X).as_vec3());
    // Corners may begin anywhere, but which side is outside must stay.
    let [a, b, c] = skin.triangles[3].map(|v| skin.positions[v as usize]);
    assert!((b - a).cross(c - a).dot(Vec3::ONE) > 0.0, "the outside stays outside");
}

#[test]
fn a_mirrored_mesh_keeps_its_outside_outside() {
    let (hair, mesh) = (groom(), tetrahedron());
    for scale in [Vec3::ONE, Vec3::new(-1.0, 1.0, 1.0), Vec3::NEG_ONE] {
        let mut export = Export::new(&hair, 24.0);
        export.head = Some(&mesh);
        let file = bytes(export, |_| DAffine3::from_scale(scale.as_dvec3()));
        let skin = ArchiveReader::new(Cursor::new(&file)).unwrap().mesh().unwrap();
        let corners = skin.triangles.iter().map(|t| t.map(|v| skin.positions[v as usize]));
        // Six times the volume that the faces enclose, above 0 where they look outwards.
        assert_eq!(corners.map(|[a, b, c]| a.dot(b.cross(c))).sum::<f32>(), 1.0, "{scale}");
    }
}

#[test]
fn attributes_of_any_name_go_through() {
    let mut hair = Hair::from(strands(0));
    let (strands, points) = (hair.strands.len(), hair.strands.points().len());
    let other = |name: &str, per, role, extent, values| Other::new(name, per, role, extent, values);
    let numbers = |n: usize| (0..n).map(|i| i as f64 / 3.0);
    let alternating = |n: usize, pair: [i64; 2]| Values::Integers((0..n).map(|i| pair[i % 2]).collect());
    hair.attributes.other = vec![
        other("cell", Per::Strand, Role::Plain, 2, Values::Integers((0..2 * strands as i64).collect())),
        other("far", Per::Strand, Role::Plain, 1, Values::Integers((0..strands as i64).map(|i| i << 40).collect())),
        other("list", Per::Groom, Role::Plain, 1, Values::Floats(vec![1.0, 2.0, 3.0])),
        other("mass", Per::Point, Role::Plain, 1, Values::Doubles(numbers(points).collect())),
        other("mood", Per::Strand, Role::Plain, 1, Values::Words((0..strands).map(|s| format!("m{s}")).collect())),
        other("normals", Per::Point, Role::Normal, 3, Values::Floats(numbers(3 * points).map(|x| x as f32).collect())),
        Other { stored: Stored::Bool, ..other("loose", Per::Strand, Role::Plain, 1, alternating(strands, [0, 1])) },
        Other { stored: Stored::I8, ..other("small", Per::Strand, Role::Plain, 1, alternating(strands, [-128, 127])) },
        Other {
            stored: Stored::U16,
            ..other("word", Per::Strand, Role::Plain, 2, alternating(2 * strands, [0, 65535]))
        },
        Other {
            stored: Stored::U64,
            ..other("hash", Per::Strand, Role::Plain, 1, alternating(strands, [-1, 1 << 53 | 1]))
        },
        Other { stored: Stored::F16, ..other("age", Per::Strand, Role::Plain, 1, Values::Floats(vec![0.5; strands])) },
        Other { single: true, ..other("one", Per::Groom, Role::Plain, 1, Values::Floats(vec![0.1])) },
        other("tint", Per::Strand, Role::Colour, 3, Values::Floats(numbers(3 * strands).map(|x| x as f32).collect())),
    ];
    let file = bytes(Export::new(&hair, 24.0), |_| DAffine3::IDENTITY);
    let read = ArchiveReader::new(Cursor::new(&file)).unwrap().hair(0, None).unwrap();
    hair.attributes.other.sort_by(|a, b| a.name.cmp(&b.name));
    assert_eq!(read.attributes, hair.attributes);
    for other in &hair.attributes.other {
        assert_eq!(nabiki_alembic::changes(std::slice::from_ref(other)), Vec::<String>::new());
    }
    let list = Other { single: false, ..other("one", Per::Groom, Role::Plain, 1, Values::Floats(vec![0.1])) };
    assert_eq!(
        nabiki_alembic::changes(std::slice::from_ref(&list)),
        ["one as a list of one value: it becomes that value"]
    );
    let token = Other {
        stored: Stored::Token,
        ..other("side", Per::Groom, Role::Plain, 1, Values::Words(vec!["l".into(), "r".into()]))
    };
    assert_eq!(nabiki_alembic::changes(std::slice::from_ref(&token)), ["the type of side: token becomes string"]);
}

#[test]
fn numbers_that_are_not_whole_are_no_ids_whatever_their_name() {
    for name in ["id", "group"] {
        for [first, step] in [[7.0, 2.0], [0.25, 1.0], [0.0, 1e300], [f64::NAN, 1.0]] {
            let mut hair = Hair::from(strands(0));
            let values: Vec<f64> = (0..hair.strands.len()).map(|s| first + step * s as f64).collect();
            let of_name = Other::new(name, Per::Strand, Role::Plain, 1, Values::Doubles(values.clone()));
            hair.attributes.other = vec![of_name];
            let file = bytes(Export::new(&hair, 24.0), |_| DAffine3::IDENTITY);
            let read = ArchiveReader::new(Cursor::new(&file)).unwrap().hair(0, None).unwrap().attributes;
            let found = read.id.or(read.group.map(|group| group.into_iter().map(i64::from).collect()));
            let whole = (0..values.len() as i64).map(|s| 7 + 2 * s).collect();
            assert_eq!(found, (step == 2.0).then_some(whole), "{name}, {first}");
            let [other] = &read.other[..] else { panic!("{name}, {first}: {:?}", read.other) };
            let Values::Doubles(kept) = &other.values else { panic!("{name}, {first}") };
            assert!(kept.iter().map(|x| x.to_bits()).eq(values.iter().map(|x| x.to_bits())), "{name}, {first}");
        }
    }
}

#[test]
fn texture_coordinates_of_points_stay_by_point() {
    let mut hair = groom();
    let roots = hair.attributes.root_uv.clone().unwrap();
    let of_strand = |(strand, &[u, v]): (&[Vec3], &[f32; 2])| (0..strand.len()).flat_map(move |p| [u, v + p as f32]);
    let values: Vec<f32> = hair.strands.iter().zip(&roots).flat_map(of_strand).collect();
    let uv = |name: &str| Other::new(name, Per::Point, Role::TextureCoordinate, 2, Values::Floats(values.clone()));
    for name in ["st", "uv"] {
        hair.attributes.other = vec![uv(name)];
        let file = bytes(Export::new(&hair, 24.0), |_| DAffine3::IDENTITY);
        let read = ArchiveReader::new(Cursor::new(&file)).unwrap().hair(0, None).unwrap();
        assert_eq!(read.attributes, hair.attributes);
    }
}

#[test]
fn more_kinds_of_attributes_than_the_table_has_room_for_go_through() {
    let mut hair = Hair::from(strands(0));
    let of = |extent: usize| {
        let values = Values::Floats(vec![0.5; extent * hair.strands.len()]);
        Other::new(format!("a{extent:03}"), Per::Strand, Role::Plain, extent, values)
    };
    hair.attributes.other = (1..256).map(of).collect();
    let file = bytes(Export::new(&hair, 24.0), |_| DAffine3::IDENTITY);
    let read = ArchiveReader::new(Cursor::new(&file)).unwrap().hair(0, None).unwrap();
    assert_eq!(read.attributes.other, hair.attributes.other);
}

#[test]
fn values_of_more_numbers_than_a_property_has_are_left_out_and_that_is_said() {
    let mut hair = Hair::from(strands(0));
    let of = |name: &str, extent: usize| {
        let values = Values::Floats(vec![0.5; extent * hair.strands.len()]);
        Other::new(name, Per::Strand, Role::Plain, extent, values)
    };
    // 256 and 300 are 0 and 44 in a byte.
    hair.attributes.other = vec![of("a", 0), of("b", 255), of("c", 256), of("d", 300)];
    let lost = nabiki_alembic::changes(&hair.attributes.other);
    let line = |name: &str, extent| format!("{name}: {extent} numbers per value, but Alembic allows 1 to 255");
    assert_eq!(lost, [line("a", 0), line("c", 256), line("d", 300)]);
    let file = bytes(Export::new(&hair, 24.0), |_| DAffine3::IDENTITY);
    let read = ArchiveReader::new(Cursor::new(&file)).unwrap().hair(0, None).unwrap();
    assert_eq!(read.attributes.other, hair.attributes.other[1..2]);
}

#[test]
fn hair_that_stands_still_is_stored_once() {
    let hair = Hair::from(strands(0));
    let folder = tempfile::tempdir().unwrap();
    let size = |frames: usize| {
        let path = folder.path().join("still.abc");
        let mut sink = Box::new(HairArchive::create(&path, Export::new(&hair, 24.0)).unwrap());
        for _ in 0..frames {
            sink.frame(&hair.strands, &DAffine3::IDENTITY).unwrap();
        }
        sink.finish().unwrap();
        std::fs::metadata(&path).unwrap().len()
    };
    assert_eq!(size(1), size(200), "200 still fits one byte");
}

#[test]
fn a_pause_in_the_motion_keeps_every_frame_in_its_place() {
    let hair = Hair::from(strands(0));
    let order = [0, 0, 0, 5, 5, 6, 6, 6, 7, 0, 0];
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("pause.abc");
    let mut sink = Box::new(HairArchive::create(&path, Export::new(&hair, 24.0)).unwrap());
    for frame in order {
        sink.frame(&strands(frame), &DAffine3::IDENTITY).unwrap();
    }
    sink.finish().unwrap();
    let mut archive = ArchiveReader::open(&path).unwrap();
    for (n, frame) in order.into_iter().enumerate() {
        assert_eq!(archive.hair(n, None).unwrap().strands, strands(frame), "sample {n}");
    }
}

#[test]
fn frames_that_do_not_fit_the_groom_are_refused_and_leave_no_file() {
    let hair = groom();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("hair.abc");
    let mut sink = HairArchive::create(&path, Export::new(&hair, 24.0)).unwrap();
    let mut other = strands(0);
    other.push([Vec3::ZERO, Vec3::X]);
    assert!(sink.frame(&other, &DAffine3::IDENTITY).unwrap_err().to_string().contains("strands must not change"));
    let mut bad = strands(0);
    bad.points_mut()[3].x = f32::NAN;
    assert!(sink.frame(&bad, &DAffine3::IDENTITY).unwrap_err().to_string().contains("point 3"));
    drop(sink);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    assert!(HairArchive::create(&path, Export::new(&hair, 0.0)).is_err());
}

/// Reads all there is; only a panic, or never coming back, is wrong.
fn read_whatever(bytes: &[u8]) {
    let Ok(mut archive) = ArchiveReader::new(Cursor::new(bytes)) else { return };
    let _ = archive.contents();
    for frame in [0, 1, 7, usize::MAX] {
        let _ = archive.hair(frame, None);
    }
    let _ = archive.hair(2, Some(5));
    let _ = archive.mesh();
    let _ = archive.motion("head");
}

/// A container with the given children at its root, each a group of its own.
fn crafted(parts: &[&[u64]]) -> Vec<u8> {
    let mut file = b"Ogawa\xff\x00\x01".to_vec();
    file.extend(16u64.to_le_bytes());
    for part in parts {
        file.extend((part.len() as u64).to_le_bytes());
        file.extend(part.iter().flat_map(|x| x.to_le_bytes()));
    }
    file
}

#[test]
fn archives_that_lie_or_turn_in_circles_are_errors() {
    const DATA: u64 = 1 << 63;
    for lie in [
        crafted(&[&[16; 6]]),
        crafted(&[&[DATA | 16; 6]]),
        crafted(&[&[u64::MAX; 6]]),
        crafted(&[&[DATA | 72, DATA | 72, 16, DATA, DATA, DATA], &[0]]),
        crafted(&[]),
        b"Ogawa\xff\x00\x01\xff\xff\xff\xff\xff\xff\xff\x7f".to_vec(),
        b"Ogawa\x00\x00\x01\x10\x00\x00\x00\x00\x00\x00\x00".to_vec(),
        b"\x89HDF\r\n\x1a\n00000000".to_vec(),
        b"Ogawa".to_vec(),
        Vec::new(),
    ] {
        let problem = ArchiveReader::new(Cursor::new(lie)).and_then(|mut a| a.hair(0, None));
        assert!(problem.is_err());
    }
}

#[test]
fn a_count_larger_than_the_file_is_named() {
    let mut file = crafted(&[&[0]]);
    file[16..24].copy_from_slice(&u64::MAX.to_le_bytes());
    let problem = ArchiveReader::new(Cursor::new(file)).map(|_| ()).unwrap_err().to_string();
    assert!(problem.contains("more than it has"), "{problem}");
}

#[test]
fn every_truncation_is_an_error() {
    let hair = groom();
    let file = bytes(Export::new(&hair, 24.0), pose);
    for length in (0..file.len()).step_by(37) {
        let cut = ArchiveReader::new(Cursor::new(&file[..length])).and_then(|mut a| a.hair(FRAMES - 1, None));
        assert!(cut.is_err(), "{length} of {} bytes", file.len());
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn damaged_archives_cause_no_panic(
        hits in prop::collection::vec((0.0..1.0f64, any::<u8>()), 1..12),
        near_the_end in any::<bool>(),
    ) {
        thread_local!(static FILE: Vec<u8> = {
            let (hair, mesh) = (groom(), tetrahedron());
            let mut export = Export::new(&hair, 24.0);
            export.head = Some(&mesh);
            bytes(export, pose)
        });
        let mut file = FILE.with(Clone::clone);
        // Headers lie near the end, where damage does most.
        let first = if near_the_end { file.len() - 4000 } else { 0 };
        for (place, value) in hits {
            let at = first + (place * (file.len() - first) as f64) as usize;
            file[at] = value;
        }
        read_whatever(&file);
    }
}
