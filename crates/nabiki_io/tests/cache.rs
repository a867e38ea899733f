//! Motion caches: exact to the bit, whole or absent, refused when damaged.

#[allow(dead_code, reason = "shared by several test programs, each of which uses a part")]
mod samples;

use nabiki_io::cache::{Header, Reader, Writer};

#[test]
fn every_frame_comes_back_to_the_bit_in_any_order_with_its_attributes() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("motion.nabiki");
    let header = samples::write_cache(&path);
    let mut reader = Reader::open(&path).unwrap();
    assert_eq!((reader.header(), reader.frame_count()), (&header, 3));
    let mut strands = header.strands();
    let original = samples::hair(&[3, 2, 4]);
    for frame in [2, 0, 1, 1] {
        assert_eq!(reader.read(frame as u64, &mut strands).unwrap(), samples::pose(frame));
        assert_eq!(strands.points(), samples::frame_points(&original, frame));
    }
    assert_eq!(reader.hair(0).unwrap(), original);
    let error = reader.read(3, &mut strands).unwrap_err().to_string();
    assert_eq!(error, format!("{}: frame 3 is not in the cache: it holds frames 0 to 2", path.display()));
}

#[test]
fn an_unfinished_cache_leaves_no_file() {
    let folder = tempfile::tempdir().unwrap();
    let hair = samples::hair(&[2]);
    let header = Header::new(Default::default(), 24.0, &hair);
    let mut writer = Writer::create(&folder.path().join("motion.nabiki"), &header).unwrap();
    writer.push(&samples::pose(0), hair.strands.points()).unwrap();
    drop(writer);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn what_would_make_a_useless_cache_is_not_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("motion.nabiki");
    let hair = samples::hair(&[2]);
    let header = Header::new(Default::default(), 24.0, &hair);
    let named = |text: &str| format!("{}: {text}", path.display());
    let refused = |header: &Header| Writer::create(&path, header).err().unwrap().to_string();
    assert_eq!(refused(&Header { frame_rate: 0.0, ..header.clone() }), named("frame rate is 0: must be above 0"));
    let mut no_strands = header.clone();
    no_strands.starts = vec![0];
    assert_eq!(refused(&no_strands), named("there are no strands to write"));

    let mut writer = Writer::create(&path, &header).unwrap();
    let mut points = hair.strands.points().to_vec();
    points[1].y = f32::NAN;
    let error = writer.push(&samples::pose(0), &points).unwrap_err().to_string();
    assert!(error.contains("frame 0: point 1 is [0, NaN, 0.25]"), "{error}");
    let error = writer.push(&samples::pose(0), &points[..1]).unwrap_err().to_string();
    assert_eq!(error, named("frame 0: 1 points, the cache is of 2"));
    assert_eq!(writer.finish().unwrap_err().to_string(), named("there are no frames to write"));
    let nowhere = folder.path().join("absent/motion.nabiki");
    assert!(Writer::create(&nowhere, &header).is_err());
}

#[test]
fn a_cache_cut_short_says_how_many_frames_it_holds() {
    let bytes = samples::cache_bytes();
    let error = Reader::from_bytes(&bytes[..bytes.len() - 1]).err().unwrap().to_string();
    assert!(error.contains("3 frames of 136 bytes from offset") && error.contains("(2 frames)"), "{error}");
}
