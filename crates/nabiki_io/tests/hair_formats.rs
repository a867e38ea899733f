//! What each hair format holds comes back exactly; what it cannot hold is said; what is wrong is refused by name.

#[allow(dead_code, reason = "shared by several test programs, each of which uses a part")]
mod samples;

use nabiki::Hair;
use nabiki::hair::{Attributes, Constants};
use nabiki_io::{hair, hair_file, tfx};

#[test]
fn a_hair_file_keeps_points_widths_colours_and_transparencies_and_names_the_rest() {
    let original = samples::hair(&[3, 2, 4]);
    let read = hair_file::from_bytes(&samples::hair_bytes()).unwrap();
    assert_eq!(read.strands, original.strands);
    let kept = Attributes {
        width: original.attributes.width.clone(),
        colour: original.attributes.colour.clone(),
        transparency: original.attributes.transparency.clone(),
        constant: original.attributes.constant,
        ..Attributes::default()
    };
    assert_eq!(read.attributes, kept);
    let lost = ["strand ids", "root UVs", "groups", "guide flags", "point UVs", "which points are held"];
    assert_eq!(hair_file::losses(&original), lost);
    assert!(hair_file::losses(&read).is_empty());
}

#[test]
fn a_tfx_file_keeps_uvs_colours_and_held_points() {
    let mut original = samples::hair(&[4, 4, 4]);
    original.attributes.width = Some([0.01, 0.02, 0.03].iter().flat_map(|&w| [w; 4]).collect());
    let mut bytes = Vec::new();
    tfx::to_writer(&original, &mut bytes).unwrap();
    let read = tfx::from_bytes(&bytes).unwrap();
    assert_eq!(read.strands, original.strands);
    let (a, b) = (read.attributes, original.attributes);
    assert_eq!((a.root_uv, a.point_uv, a.width), (b.root_uv, b.point_uv, b.width));
    // The sample's transparencies are multiples of 1/32, which 1 - (1 - t) keeps.
    assert_eq!((a.colour, a.transparency, a.inverse_mass), (b.colour, b.transparency, b.inverse_mass));
    assert_eq!(tfx::losses(&samples::hair(&[4])).len(), 4, "ids, groups, guides and the taper");
}

#[test]
fn every_attribute_is_kept_or_said_to_be_lost() {
    let mut whole = samples::whole(&[4, 4, 4]);
    whole.attributes.unread = vec!["the relationship skel:skeleton".to_owned()];
    let Attributes {
        id: Some(_),
        root_uv: Some(_),
        group: Some(_),
        group_names,
        guide: Some(_),
        width: Some(_),
        colour: Some(_),
        transparency: Some(_),
        point_uv: Some(_),
        inverse_mass: Some(_),
        // Says how the file that was read had its strands; no format has a place for it.
        tip_first: _,
        other,
        unread,
        constant: Constants { width: Some(_), colour: Some(_), transparency: Some(_) },
    } = &whole.attributes
    else {
        panic!("an attribute is missing from the sample")
    };
    assert_eq!((group_names.len(), other.len(), unread.len()), (2, 4, 1));
    // What was never read is no format's loss: it is told when a file is read.
    let further = ["P_rest", "clump", "map", "seed of the groom"];
    let own = ["strand ids", "root UVs", "groups", "guide flags", "point UVs", "which points are held"];
    assert_eq!(hair_file::losses(&whole), [&own[..], &further[..]].concat());
    let own = ["strand ids", "groups", "guide flags", "width along a strand (each strand keeps the width at its root)"];
    assert_eq!(tfx::losses(&whole), [&own[..], &further[..]].concat());
    // Each by itself, too: no loss hides behind another.
    let strands = &whole.strands;
    let alone = |attributes| Hair { strands: strands.clone(), attributes };
    for other in other {
        let hair = alone(Attributes { other: vec![other.clone()], ..Attributes::default() });
        assert_eq!(
            (hair_file::losses(&hair), tfx::losses(&hair)),
            (vec![other.name.clone()], vec![other.name.clone()])
        );
    }
    let group_names = group_names.clone();
    let hair = alone(Attributes { group_names, ..Attributes::default() });
    assert_eq!((hair_file::losses(&hair), tfx::losses(&hair)), (vec!["groups".to_owned()], vec!["groups".to_owned()]));
}

#[test]
fn a_width_of_0_for_all_points_is_said_to_be_lost_where_it_stands_for_none() {
    let mut hair = samples::hair(&[4, 4]);
    hair.attributes =
        Attributes { constant: Constants { width: Some(0.0), ..Constants::default() }, ..Attributes::default() };
    assert_eq!(hair_file::losses(&hair), ["the width 0 of all points (there 0 means no width)"]);
    let (mut to_hair, mut to_tfx) = (Vec::new(), Vec::new());
    hair_file::to_writer(&hair, "", &mut to_hair).unwrap();
    assert_eq!(hair_file::from_bytes(&to_hair).unwrap().attributes.constant.width, None);
    tfx::to_writer(&hair, &mut to_tfx).unwrap();
    assert_eq!((tfx::losses(&hair), tfx::from_bytes(&to_tfx).unwrap().attributes.width), (vec![], Some(vec![0.0; 8])));
}

#[test]
fn version_3_gives_guides_and_holds_both_ends_where_it_says_so() {
    let hair = tfx::from_bytes(&samples::tfx_3_bytes()).unwrap();
    assert_eq!(hair.strands.starts(), [0, 3, 6], "five strands follow each guide and are not in the file");
    assert_eq!(hair.strands.strand(1)[2], glam::Vec3::new(1.0, 2.0, 0.5));
    assert_eq!(hair.attributes.inverse_mass, Some(vec![0.0, 1.0, 0.0, 0.0, 1.0, 0.0]));
    assert_eq!(hair.attributes.width, Some(vec![0.01, 0.01, 0.01, 0.02, 0.02, 0.02]));
    assert_eq!(hair.attributes.root_uv, Some(vec![[0.25, 0.5], [0.75, 1.0]]));
}

#[test]
fn strands_of_different_lengths_are_refused_by_tfx_with_the_way_out() {
    let error = tfx::to_writer(&samples::hair(&[3, 2]), &mut Vec::new()).unwrap_err();
    assert_eq!(
        error.to_string(),
        "strand 0 has 3 points and strand 1 has 2: in a .tfx file all must have the same number; resample them \
         (convert --segments N) or write .hair"
    );
}

/// The sample .hair file with four bytes replaced.
fn altered(at: usize, word: [u8; 4]) -> String {
    let mut bytes = samples::hair_bytes();
    bytes[at..at + 4].copy_from_slice(&word);
    hair_file::from_bytes(&bytes).unwrap_err().to_string()
}

#[test]
fn lying_counts_are_refused_against_the_length_of_the_file() {
    assert_eq!(
        altered(4, u32::MAX.to_le_bytes()),
        "segments: 8589934590 bytes expected at offset 128, 294 found: the file is cut short or its counts are wrong"
    );
    assert_eq!(altered(8, 10u32.to_le_bytes()), "point count is 10, but 3 strands have 9 points in all");
    assert_eq!(altered(4, [0; 4]), "strand count is 0: the file holds no hair");
}

#[test]
fn nan_is_refused_naming_the_strand() {
    // Points start after the header and three u16: point 4 is the second of strand 1.
    let at = 128 + 6 + 4 * 12;
    assert_eq!(
        altered(at, f32::NAN.to_le_bytes()),
        "strand 1, point 1: (NaN, 0.5, 0.25) is not a place: coordinates must be finite"
    );
    assert!(altered(at, f32::INFINITY.to_le_bytes()).starts_with("strand 1, point 1: (inf,"));
}

#[test]
fn a_missing_file_a_folder_and_a_strange_ending_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let missing = folder.path().join("no.hair");
    let error = hair::read(&missing).unwrap_err().to_string();
    assert_eq!(error, format!("{}: there is no such file or folder", missing.display()));
    let named_folder = folder.path().join("folder.hair");
    std::fs::create_dir(&named_folder).unwrap();
    let error = hair::read(&named_folder).unwrap_err().to_string();
    assert_eq!(error, format!("{}: is a folder, not a regular file: give a file", named_folder.display()));
    let error = hair::read("hair.fbx".as_ref()).unwrap_err().to_string();
    assert_eq!(
        error,
        "hair.fbx: ending \"fbx\" is not a hair format: .hair, .tfx, .usd, .usda, .usdc or .abc (.obj only to read); it \
         holds heads and motion: its programs write hair as USD or Alembic"
    );
}

#[test]
fn a_failed_write_leaves_nothing_and_an_old_file_as_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("out.tfx");
    std::fs::write(&path, "old").unwrap();
    hair::write(&path, &samples::hair(&[3, 2])).unwrap_err();
    assert_eq!(std::fs::read(&path).unwrap(), b"old");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1, "no part file is left");
}

#[test]
fn placement_and_cleaning_are_counted() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mixed.obj");
    std::fs::write(&path, "v 0 0 0\nv 0 0 0\nv 0 0.5 0\nv 1 0.5 0\nv 1 0.5 0.01\nl 1 2 3\nl 1 2\nl 4 5\n").unwrap();
    let metres = nabiki_io::Placement { unit: "m".parse().unwrap(), ..Default::default() };
    let cleaning = hair::Cleaning { join_within: 0.0, drop_shorter_than: 2.0 };
    let (hair, report) = hair::import(&path, &metres, &cleaning).unwrap();
    assert_eq!((report.strands_in_file, report.points_in_file), (3, 7));
    assert_eq!((report.degenerate.joined_points, report.degenerate.dropped_strands, report.dropped_short), (1, 1, 1));
    assert_eq!(hair.strands.points(), [glam::Vec3::ZERO, glam::Vec3::new(0.0, 50.0, 0.0)]);
    let all_too_short = hair::Cleaning { drop_shorter_than: 60.0, ..cleaning };
    let error = hair::import(&path, &metres, &all_too_short).unwrap_err().to_string();
    assert!(error.contains("none of 3 strands is left: 1 have no length, 2 are shorter than 60 cm"), "{error}");
}

/// Bytes of a file: words, then singles.
fn file(begin: &[u8], words: &[u32], singles: &[f32]) -> Vec<u8> {
    let words = words.iter().copied().chain(singles.iter().map(|x| x.to_bits()));
    begin.iter().copied().chain(words.flat_map(u32::to_le_bytes)).collect()
}

#[test]
fn the_arrays_of_a_hair_file_stand_as_its_bit_field_lists_them() {
    // Two strands of two points, so that no array of segments is needed.
    let points: Vec<f32> = (0..12).map(|i| i as f32).collect();
    let (thickness, transparency) = ([1.0, 2.0, 3.0, 4.0], [0.1, 0.2, 0.3, 0.4]);
    let colours: Vec<f32> = (0..12).map(|i| 0.01 * i as f32).collect();
    let defaults = [0.5, 0.25, 0.75, 0.5, 0.125].map(f32::to_bits);
    let read = |arrays: u32, more: &[f32]| {
        let header = [&[2, 4, 2 + arrays, 1][..], &defaults, &[0; 22]].concat();
        hair_file::from_bytes(&file(b"HAIR", &header, &[&points, more].concat())).unwrap()
    };
    let whole = read(4 + 8 + 16, &[&thickness[..], &transparency, &colours].concat());
    assert_eq!((whole.strands.starts(), whole.strands.points()[3]), (&[0, 2, 4][..], glam::Vec3::new(9.0, 10.0, 11.0)));
    let by_point = Some(colours.as_chunks::<3>().0.to_vec());
    let expected = Attributes {
        width: Some(thickness.to_vec()),
        transparency: Some(transparency.to_vec()),
        colour: by_point.clone(),
        constant: Constants { width: Some(0.5), transparency: Some(0.25), colour: Some([0.75, 0.5, 0.125]) },
        ..Attributes::default()
    };
    assert_eq!(whole.attributes, expected);
    let (width, transparency) = (read(4, &thickness).attributes, read(8, &transparency).attributes);
    assert_eq!((width.width, width.transparency, width.colour), (expected.width, None, None));
    assert_eq!(
        (transparency.width, transparency.transparency, transparency.colour),
        (None, expected.transparency, None)
    );
    assert_eq!(read(16, &colours).attributes.colour, by_point);
}

#[test]
fn the_arrays_of_a_tfx_file_stand_where_its_offsets_say() {
    let numbers = |first: f32, count: usize| (0..count).map(move |i| first + i as f32).collect::<Vec<f32>>();
    let colours = [[0.1, 0.2, 0.3, 1.0], [0.4, 0.5, 0.6, 0.75]].concat();
    // One strand of two points. In version 4 a point has a fourth number, 0 where it is held.
    let points = [[1.0, 2.0, 3.0, 0.0], [4.0, 5.0, 6.0, 1.0]].concat();
    let (root_uv, point_uv, thickness) = (numbers(10.0, 2), numbers(20.0, 4), [0.5]);
    let at = [160, 160 + 32, 160 + 40, 160 + 56, 160 + 60];
    let header = [&[4.0f32.to_bits(), 1, 2][..], &at, &[0; 32]].concat();
    let all = [&points[..], &root_uv, &point_uv, &thickness, &colours].concat();
    let version_4 = tfx::from_bytes(&file(b"", &header, &all)).unwrap();
    // In version 3 the thickness goes before the UVs, the colours next, the UVs of points behind the numbers of guides.
    let points = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
    let at = [296, 296 + 24, 296 + 28, 296 + 36, 296 + 68, 296 + 72];
    let header = [&[3.0f32.to_bits(), 1, 2, 0, 0][..], &[0; 31], &at, &[0; 32]].concat();
    let guide_numbers = [f32::from_bits(7)];
    let all = [&points[..], &thickness, &root_uv, &colours, &guide_numbers, &point_uv].concat();
    let version_3 = tfx::from_bytes(&file(b"", &header, &all)).unwrap();
    for (hair, version) in [(version_3, 3), (version_4, 4)] {
        assert_eq!(
            hair.strands.points(),
            [glam::Vec3::new(1.0, 2.0, 3.0), glam::Vec3::new(4.0, 5.0, 6.0)],
            "{version}"
        );
        let expected = Attributes {
            root_uv: Some(vec![[10.0, 11.0]]),
            point_uv: Some(vec![[20.0, 21.0], [22.0, 23.0]]),
            width: Some(vec![0.5; 2]),
            colour: Some(vec![[0.1, 0.2, 0.3], [0.4, 0.5, 0.6]]),
            transparency: Some(vec![0.0, 0.25]),
            inverse_mass: Some(vec![0.0, 1.0]),
            ..Attributes::default()
        };
        assert_eq!(hair.attributes, expected, "version {version}");
    }
}

#[test]
fn info_knows_the_polylines_of_an_obj_however_its_lines_are_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("lines.obj");
    let plain = "v 0 0 0\nv 1 0 0\nl 1 2\n";
    for text in
        [plain.to_owned(), plain.replace("l 1", "l\t1"), plain.replace("l 1", "  l 1"), plain.replace('\n', "\r")]
    {
        std::fs::write(&path, &text).unwrap();
        let found = nabiki_io::info::info(&path).unwrap();
        let nabiki_io::info::Info::Hair(hair) = found else { panic!("{text:?} is hair") };
        assert_eq!((hair.strands, hair.points), (1, 2), "{text:?}");
    }
}
