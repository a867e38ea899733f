//! Shapes that other programs write, in archives that `files/make.py` has written with Alembic's own library: B-splines with
//! knots, what does not show, subdivision surfaces, and what is left out.

use std::io::Cursor;
use std::path::{Path, PathBuf};

use glam::{DVec3, Vec3};
use nabiki_alembic::ArchiveReader;
use nabiki_exchange::curves::{Basis, Shape};
use nabiki_exchange::{GroomReader, Knots, PrimKind};

fn path(name: &str) -> PathBuf {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/files")).join(name)
}

fn archive(name: &str) -> ArchiveReader {
    ArchiveReader::open(&path(name)).unwrap()
}

/// The control points of every curve of knots.abc begin with these.
const POINTS: [Vec3; 5] = [
    Vec3::ZERO,
    Vec3::new(1.0, 2.0, 0.0),
    Vec3::new(3.0, 1.0, -1.0),
    Vec3::new(4.0, 4.0, 2.0),
    Vec3::new(4.5, 3.0, 2.0),
];

/// One curve of the first `count` points.
fn curve(count: usize, basis: Basis, segments: Option<usize>) -> Vec<Vec3> {
    let shape = Shape { counts: vec![count], basis, pinned: false };
    shape.walk(POINTS[..count].to_vec(), segments).unwrap().strands.points().to_vec()
}

/// The same by knots.
fn by_knots(order: usize, knots: &[f64], count: usize, segments: Option<usize>) -> Vec<Vec3> {
    let shape = Shape { counts: vec![count], basis: Basis::Bspline, pinned: false };
    let knots = vec![Knots::new(order, count, knots).unwrap()];
    shape.walk_by(knots, POINTS[..count].to_vec(), segments).unwrap().strands.points().to_vec()
}

#[test]
fn curves_go_by_their_knots_whichever_of_these_are_there() {
    for segments in [None, Some(11)] {
        let mut file = archive("knots.abc");
        let hair = file.hair(0, segments).unwrap();
        let clamped = by_knots(4, &[0.0, 0.0, 0.0, 0.0, 1.0, 2.0, 2.0, 2.0, 2.0], 5, segments);
        let mut expected = vec![clamped; 6];
        // Evenly spaced knots, then one curve of each order.
        expected.push(curve(5, Basis::Bspline, segments));
        expected.push(curve(4, Basis::Bspline, segments));
        expected.push(curve(3, Basis::Linear, segments));
        expected.push(by_knots(3, &[0.0, 0.0, 0.0, 1.0, 2.0, 2.0, 2.0], 4, segments));
        expected.push(curve(4, Basis::Bezier, segments));
        expected.push(curve(4, Basis::Bezier, segments));
        assert_eq!(hair.strands.len(), expected.len());
        for (s, expected) in expected.iter().enumerate() {
            let strand = hair.strands.strand(s);
            assert_eq!(strand.len(), expected.len(), "curve {s}");
            for (found, expected) in strand.iter().zip(expected) {
                // Weights differ by what rounding leaves in doubles: singles may lie to either side.
                assert!(found.abs_diff_eq(*expected, 8.0 * f32::EPSILON), "curve {s}: {found} {expected}");
            }
        }
        for s in 0..6 {
            let strand = hair.strands.strand(s);
            assert_eq!([strand[0], strand[strand.len() - 1]], [POINTS[0], POINTS[4]], "curve {s}");
        }
        // A Bezier curve has no use for them, and its weights differ.
        assert_eq!(hair.attributes.unread, ["property w", "property .knots"]);
    }
    let cubic = |kind: &PrimKind| matches!(kind, PrimKind::Curves { course, .. } if course.basis != Basis::Linear);
    assert!(archive("knots.abc").prims().unwrap().iter().all(|prim| cubic(&prim.kind)));
}

/// knots.abc with one run of singles in the place of another, wherever that stands.
fn changed(from: &[f32], to: &[f32]) -> ArchiveReader<Cursor<Vec<u8>>> {
    let bytes = |knots: &[f32]| knots.iter().flat_map(|knot| knot.to_le_bytes()).collect::<Vec<u8>>();
    let (mut file, from, to) = (std::fs::read(path("knots.abc")).unwrap(), bytes(from), bytes(to));
    let places: Vec<usize> = (0..file.len()).filter(|&i| file[i..].starts_with(&from)).collect();
    assert!(!places.is_empty());
    for place in places {
        file[place..place + to.len()].copy_from_slice(&to);
    }
    ArchiveReader::new(Cursor::new(file)).unwrap()
}

#[test]
fn knots_that_make_no_curve_are_refused_with_curve_and_way_out() {
    let clamped = [0.0, 0.0, 0.0, 0.0, 1.0, 2.0, 2.0, 2.0, 2.0];
    let with = |i: usize, knot: f32| {
        let mut knots = clamped;
        knots[i] = knot;
        changed(&clamped, &knots).hair(0, None).unwrap_err().to_string()
    };
    let line = |what: &str| format!("curves /clamped: curve 0: {what}: export them as linear curves");
    assert_eq!(with(4, f32::NAN), line("knot 4 is NaN: must be finite"));
    assert_eq!(with(5, f32::INFINITY), line("knot 5 is inf: must be finite"));
    assert_eq!(with(5, 0.5), line("knot 5 is 0.5, less than 1 before it"));
    assert_eq!(with(4, 0.0), line("breaks at knot 0, which occurs more than 3 times"));
}

#[test]
fn knots_and_orders_of_another_number_are_refused() {
    // Sizes stand before the digests of 16 bytes; of the array of even knots, nine and eight, and of three orders.
    let file = std::fs::read(path("knots.abc")).unwrap();
    let even: Vec<u8> = (0..9).chain(3..11).flat_map(|knot| (knot as f32).to_le_bytes()).collect();
    for (values, size, said) in [
        (
            &even[..],
            16 + 4 * 12,
            "curves /even: 12 knots for 2 curves, which need 17 or 13: export them as linear curves",
        ),
        (&[2, 3, 4], 16 + 2, "curves /orders: 2 orders for 3 curves: export them as linear curves"),
    ] {
        let mut file = file.clone();
        let whole = (16 + values.len() as u64).to_le_bytes();
        let starts = |i: &usize| file[*i..].starts_with(&whole) && file[i + 24..].starts_with(values);
        let place = (0..file.len() - 24).find(starts).unwrap();
        file[place..place + 8].copy_from_slice(&u64::to_le_bytes(size));
        let refused = ArchiveReader::new(Cursor::new(file)).unwrap().hair(0, None).unwrap_err();
        assert_eq!(refused.to_string(), said);
    }
}

#[test]
fn damaged_archives_cause_no_panic() {
    for name in ["knots.abc", "hidden.abc", "subd.abc", "others.abc"] {
        let whole = std::fs::read(path(name)).unwrap();
        for place in 0..whole.len() {
            for flipped in [0x01, 0xff] {
                let mut file = whole.clone();
                file[place] ^= flipped;
                let Ok(mut archive) = ArchiveReader::new(Cursor::new(file)) else { continue };
                // Any answer will do.
                let _ = (archive.contents(), archive.prims(), archive.hair(0, None));
                let _ = (archive.mesh(), archive.mesh_unread());
            }
        }
    }
}

#[test]
fn what_does_not_show_is_said_of_curves_and_left_out_of_meshes() {
    let mut file = archive("hidden.abc");
    let hair = file.hair(0, None).unwrap();
    assert_eq!(hair.strands.len(), 6);
    // The nearest object that says either has it for all below.
    let said = [
        "visibility of /off, which is \"hidden\"",
        "visibility of /off/inherits_at_times, which is \"hidden\" at some frames",
        "visibility of /at_times, which is \"hidden\" at some frames",
    ];
    assert_eq!(hair.attributes.unread, said);
    assert_eq!(file.mesh().unwrap().positions[1], Vec3::X);
    assert_eq!(file.mesh().unwrap().positions.len(), 4);
    let said = "mesh /off/ghost, which is hidden: visibility of /off is \"hidden\"";
    assert_eq!(file.mesh_unread().unwrap(), [said]);
    // Alone it is the head.
    let alone = |path: &str| path == "/off/ghost";
    assert_eq!(file.meshes(&alone).unwrap().positions[0], 5.0 * Vec3::X);
    assert_eq!(file.meshes_unread(&alone).unwrap(), ["visibility of /off, which is \"hidden\""]);
}

#[test]
fn a_subdivision_surface_is_the_mesh_of_its_cage() {
    let mut file = archive("subd.abc");
    assert_eq!(file.contents().unwrap().meshes, ["/head/skin", "/head/eye"]);
    let prims = file.prims().unwrap();
    assert!(prims[1..].iter().all(|prim| prim.kind == PrimKind::Mesh { faces: 4, points: 4 }), "{prims:?}");
    // The same cage as the polygons beside it, five to their left; both begin ten to the right.
    let [skin, eye] = ["/head/skin", "/head/eye"].map(|path| file.meshes(&|mesh| mesh == path).unwrap());
    assert_eq!(skin.triangles, eye.triangles);
    assert_eq!(skin.positions[0], 10.0 * Vec3::X);
    assert!(skin.positions.iter().zip(&eye.positions).all(|(a, b)| *a + 5.0 * Vec3::X == *b));
    assert_eq!(file.mesh_unread().unwrap(), ["holeIndices of /head/skin: the 1 faces they remove are kept"]);
    let motion = file.motion("head").unwrap();
    assert_eq!((motion.len(), motion[2].position), (3, 12.0 * DVec3::X));
}

#[test]
fn shapes_that_are_not_read_are_said_beside_those_that_are() {
    let mut file = archive("others.abc");
    let hair = file.hair(0, None).unwrap();
    let read = "only curves and meshes of polygons are read";
    assert_eq!(
        hair.attributes.unread,
        [format!("points /dust, and 1 more: {read}"), format!("NURBS surfaces /scalp: {read}")]
    );
    assert_eq!(file.mesh_unread().unwrap(), [format!("NURBS surfaces /scalp: {read}")]);
    let refused = "has NURBS surfaces, but nabiki reads only meshes of polygons: convert them";
    assert_eq!(file.mesh().unwrap_err().to_string(), refused);
}
