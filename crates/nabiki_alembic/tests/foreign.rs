//! Archives that `files/make.py` has written with Alembic's own library: what their transforms, curves and parameters mean.

use std::path::Path;

use glam::{DAffine3, DVec3, Vec3};
use nabiki::hair::{Per, Role, Values};
use nabiki_alembic::ArchiveReader;
use nabiki_exchange::{GroomReader, PrimKind};

fn archive(name: &str) -> ArchiveReader {
    ArchiveReader::open(&Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/files")).join(name)).unwrap()
}

#[test]
fn every_operation_of_a_transform_does_what_its_name_says() {
    let mut archive = archive("operations.abc");
    let curves = archive.contents().unwrap().curves;
    let hair = archive.hair(0, None).unwrap();
    // Of a curve from the origin to (1, 2, 3).
    let expected = [
        ("/translate/curve", [11.0, 22.0, 33.0]),
        ("/scale/curve", [2.0, 6.0, -12.0]),
        // A quarter of a turn takes x to y, y to z, and z to x.
        ("/axis/curve", [-2.0, 1.0, 3.0]),
        ("/x/curve", [1.0, -3.0, 2.0]),
        ("/y/curve", [3.0, 2.0, -1.0]),
        ("/z/curve", [-2.0, 1.0, 3.0]),
        // Rows multiplied from the left: x to y, y to z, z to x, then away.
        ("/matrix/curve", [13.0, 21.0, 32.0]),
        // The last one first.
        ("/several/curve", [8.0, 5.0, 3.0]),
        ("/outer/inner/curve", [101.0, 22.0, 3.0]),
        // It does not inherit.
        ("/outer/apart/curve", [1.0, 22.0, 3.0]),
    ];
    assert_eq!(curves, expected.map(|(path, _)| path));
    for (s, (path, tip)) in expected.into_iter().enumerate() {
        let found = hair.strands.strand(s)[1];
        assert!(found.distance(tip.into()) < 1e-5, "{path}: {found}");
    }
    let places = ["inner", "apart"].map(|node| archive.motion(node).unwrap()[0].position);
    assert_eq!(places, [DVec3::new(100.0, 20.0, 0.0), DVec3::new(0.0, 20.0, 0.0)]);
    // By path, or by a name whose capitals do not count.
    for node in ["/outer/inner", "INNER"] {
        assert_eq!(archive.motion(node).unwrap()[0].position, places[0], "{node}");
    }
    assert!(archive.motion("inn").is_err() && archive.motion("/inner").is_err());
}

#[test]
fn cubic_curves_are_of_the_basis_that_is_said() {
    let hair = archive("bases.abc").hair(0, Some(1)).unwrap();
    let p = [Vec3::ZERO, Vec3::new(1.0, 2.0, 0.0), Vec3::new(3.0, 1.0, -1.0), Vec3::new(4.0, 4.0, 2.0)];
    // B-splines begin near their second point, Catmull-Rom curves at it.
    let near = [(p[0] + 4.0 * p[1] + p[2]) / 6.0, (p[1] + 4.0 * p[2] + p[3]) / 6.0];
    for (s, ends) in [[p[0], p[3]], near, [p[1], p[2]]].into_iter().enumerate() {
        for (found, expected) in hair.strands.strand(s).iter().zip(ends) {
            assert!(found.distance(expected) < 1e-6, "curve {s}: {found} {expected}");
        }
    }
}

#[test]
fn parameters_have_their_scope_and_are_looked_up_where_they_are_stored_by_index() {
    let mut archive = archive("parameters.abc");
    let at = archive.hair(0, None).unwrap().attributes;
    assert_eq!(at.colour, Some((0..4).map(|p| [0.125 * p as f32, 0.25, 1.0]).collect()));
    assert_eq!(at.group, Some(vec![8, 3]));
    let own = |name: &str| at.other.iter().find(|other| other.name == name).unwrap();
    // As many values as there are curves, and as these have.
    let both = Values::Floats(vec![0.5, 2.0]);
    assert_eq!((own("range").per, &own("range").values), (Per::Groom, &both));
    assert_eq!((own("each").per, own("each").role, &own("each").values), (Per::Strand, Role::Plain, &both));
}

#[test]
fn a_head_stands_where_the_first_frame_of_the_hair_finds_it() {
    let mut archive = archive("late.abc");
    let contents = archive.contents().unwrap();
    assert_eq!((contents.first_frame(), contents.times.len(), contents.frame_rate), (5, 3, 24.0));
    let moved = DVec3::X * 50.0;
    // The mesh bends by one along z a frame, too.
    assert_eq!(archive.mesh().unwrap().positions[0], Vec3::new(50.0, 0.0, 5.0));
    let world = archive.prims().unwrap().into_iter().find_map(|prim| match prim.kind {
        PrimKind::Curves { world_from_curves, .. } => Some(world_from_curves),
        _ => None,
    });
    assert_eq!(world, Some(DAffine3::from_translation(moved)));
    // The next frame, in which the points go by one along z and the head by ten along x.
    assert_eq!(archive.hair(1, None).unwrap().strands.strand(0)[0], Vec3::new(60.0, 0.0, 1.0));
    let motion = archive.motion("head").unwrap();
    assert_eq!((motion.len(), motion[0].position, motion[10].position), (11, DVec3::ZERO, DVec3::X * 100.0));
}

#[test]
fn closed_curves_are_left_out_beside_hair_and_that_is_said() {
    let mut file = archive("closed.abc");
    let hair = file.hair(0, None).unwrap();
    assert_eq!(hair.strands.len(), 2);
    assert_eq!(hair.attributes.group, None, "the hair is of one object");
    let said = "curves /rein, which are closed: hair is open";
    assert!(hair.attributes.unread.iter().any(|line| line == said), "{:?}", hair.attributes.unread);
    assert_eq!(file.contents().unwrap().curves, ["/mane"]);
    assert_eq!(file.prims().unwrap()[1].kind, PrimKind::Other("curves (closed)".to_owned()));
}

#[test]
fn of_meshes_those_are_read_that_are_wanted_and_that_they_bend_is_said() {
    let mut file = archive("late.abc");
    let path = file.contents().unwrap().meshes.remove(0);
    assert_eq!(file.meshes(&|mesh| mesh == path).unwrap(), file.mesh().unwrap());
    assert_eq!(file.meshes(&|_| false).unwrap_err().to_string(), "has no polygons");
    let said = format!("the motion of the points of {path}: it keeps the shape of the first frame");
    assert_eq!(file.meshes_unread(&|_| true).unwrap(), [said]);
    assert_eq!(file.meshes_unread(&|_| false).unwrap(), [""; 0]);
}

/// It bends by one along z a frame, and its transform goes by ten along x.
#[test]
fn a_mesh_bends_between_its_samples() {
    let mut file = archive("late.abc");
    let times = file.bending_times(&|_| true).unwrap();
    assert_eq!((times.len(), times[0]), (11, 0.0));
    for frame in [0.0, 2.5, 10.0] {
        let found = file.bent_meshes(&|_| true, frame / 24.0).unwrap()[0];
        assert!(found.distance(Vec3::new(10.0 * frame as f32, 0.0, frame as f32)) < 1e-4, "frame {frame}: {found}");
    }
}
