//! Real hair and heads, against the counts that their README states.

use nabiki_io::{
    hair,
    info::{Guess, Info, info},
    mesh,
    placement::Placement,
};
use nabiki_reference_tests::shared;

fn read(name: &str) -> nabiki::Hair {
    hair::read(&shared(name)).unwrap()
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs the shared reference data beside the project")]
fn sintel_has_11400_strands_of_16_points_in_both_formats() {
    let (tfx, hair) = (read("hair/sintel_hair_16pts.tfx"), read("hair/sintel_hair_16pts.hair"));
    assert_eq!((tfx.strands.len(), tfx.strands.points().len()), (11_400, 182_400));
    assert!(tfx.strands.iter().all(|s| s.len() == 16));
    assert_eq!(tfx.strands, hair.strands, "positions unchanged");
    assert_eq!(hair.attributes.constant.width, Some(7e-5));
    let freedom = tfx.attributes.inverse_mass.unwrap();
    assert!(freedom.iter().enumerate().all(|(p, &w)| w == if p % 16 == 0 { 0.0 } else { 1.0 }), "roots are held");
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs the shared reference data beside the project")]
fn ratboy_s_short_segments_are_joined_and_counted_as_the_readme_did() {
    let (path, expected) = (shared("hair/ratboy_mohawk.tfx"), read("hair/ratboy_mohawk_varseg.hair"));
    let raw = hair::read(&path).unwrap();
    assert_eq!((raw.strands.len(), raw.strands.points().len()), (2_228, 71_296));
    assert_eq!(raw.attributes.root_uv.as_ref().unwrap().len(), 2_228);
    assert_eq!((expected.strands.len(), expected.strands.points().len()), (2_219, 67_089));
    let segments: Vec<usize> = expected.strands.iter().map(|s| s.len() - 1).collect();
    assert_eq!((segments.iter().min(), segments.iter().max()), (Some(&1), Some(&31)));

    let cleaning = hair::Cleaning { join_within: 1e-3, drop_shorter_than: 0.0 };
    let (cleaned, report) = hair::import(&path, &Placement::default(), &cleaning).unwrap();
    assert_eq!((report.strands_in_file, report.points_in_file), (2_228, 71_296));
    assert_eq!(report.degenerate.dropped_strands, 9);
    assert_eq!(cleaned.strands.len(), 2_219);
    assert_eq!(cleaned.strands.points().len(), 67_089);
    assert_eq!(cleaned.attributes.root_uv.unwrap().len(), 2_219);
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs the shared reference data beside the project")]
fn the_curly_swatch_is_the_same_as_lines_and_as_hair() {
    let (obj, hair) = (read("hair/curly_swatch_frame00.obj"), read("hair/curly_swatch_frame00.hair"));
    assert_eq!((obj.strands.len(), obj.strands.points().len()), (98, 10_589));
    assert_eq!(obj.strands, hair.strands);
    let hanging = read("hair/curly_swatch_frame70.obj");
    assert_eq!(hanging.strands.starts(), obj.strands.starts());
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs the shared reference data beside the project")]
fn every_hair_file_written_back_reads_the_same() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["sintel_hair_16pts.tfx", "sintel_hair_16pts.hair", "ratboy_mohawk.tfx", "ratboy_mohawk_varseg.hair"] {
        let original = read(&format!("hair/{name}"));
        let copy = folder.path().join(name);
        hair::write(&copy, &original).unwrap();
        assert_eq!(hair::read(&copy).unwrap(), original, "{name}");
    }
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs the shared reference data beside the project")]
fn every_head_has_the_counts_and_the_box_of_the_readme() {
    let none: &[String] = &[];
    let body: &[String] = &["body".to_owned()];
    // Vertices and triangles as the file has them, and the upper corner of the box (file units).
    let heads = [
        ("sintel_bust.obj", none, 3_046, 5_952, [0.1974, 1.6552, 0.1188]),
        ("sintel_eyes.obj", none, 708, 1_408, [f32::NAN; 3]),
        ("sintel_collider.obj", none, 341, 678, [0.0822, 1.6520, 0.1254]),
        ("lps_head.obj", none, 9_223, 17_684, [4.276, 3.974, 2.590]),
        ("makehuman_base.obj", body, 13_380, 26_756, [f32::NAN; 3]),
        ("suzanne.glb", none, 8_098, 15_744, [0.930, 0.668, 0.576]),
    ];
    for (name, groups, vertices, triangles, upper) in heads {
        let path = shared(&format!("heads/{name}"));
        let head = mesh::read(&path, groups).unwrap();
        assert_eq!((head.positions.len(), head.triangles.len()), (vertices, triangles), "{name}");
        let max = head.positions.iter().copied().reduce(glam::Vec3::max).unwrap().to_array();
        for (found, stated) in max.into_iter().zip(upper) {
            assert!(stated.is_nan() || (found - stated).abs() <= 0.5e-3 * stated.max(1.0), "{name}: {found} {stated}");
        }
    }
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs the shared reference data beside the project")]
fn seams_of_the_scanned_head_close_when_it_is_imported() {
    let path = shared("heads/lps_head.obj");
    let (head, report) = mesh::import(&path, &Placement::default(), &[]).unwrap();
    assert_eq!((head.positions.len(), report.joined_vertices), (8_839, 9_223 - 8_839));
    // Quantisation left 6 triangles with two corners at one place.
    assert_eq!((head.triangles.len(), report.dropped_triangles), (17_678, 6));
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs the shared reference data beside the project")]
fn info_says_what_the_readme_says_of_sintel() {
    let path = shared("hair/sintel_hair_16pts.tfx");
    let Info::Hair(info) = info(&path).unwrap() else { panic!("a .tfx is hair") };
    assert_eq!((info.strands, info.points, info.segments), (11_400, 182_400, [15, 15]));
    let near = |found: f32, stated: f32| assert!((found / stated - 1.0).abs() < 0.005, "{found} {stated}");
    near(info.strand_length.min, 0.0251);
    near(info.strand_length.median, 0.1015);
    near(info.strand_length.max, 0.248);
    near(info.bounds.max[1], 1.6749);
    assert_eq!(info.guess, Some(Guess { likely_unit: Some("m"), likely_up: Some("+y") }));
    assert_eq!((info.zero_segments, info.empty_strands), (0, 0));
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs the shared reference data beside the project")]
fn info_counts_the_open_edges_of_the_readme() {
    for (name, open, crowded) in [
        ("heads/sintel_bust.obj", 148, 0),
        ("heads/sintel_collider.obj", 0, 0),
        ("heads/suzanne.glb", 168, 0),
        // The README counts 10 crowded edges; 6 of them are of triangles without area, which are dropped.
        ("heads/lps_head.obj", 0, 4),
    ] {
        let path = shared(name);
        let Info::Mesh(mesh) = info(&path).unwrap() else { panic!("{name} is a mesh") };
        assert_eq!((mesh.open_edges, mesh.crowded_edges), (open, crowded), "{name}");
    }
}
