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
    let original = samples::whole(&[3, 2, 4]);
    for frame in [2, 0, 1, 1] {
        assert_eq!(reader.read(frame as u64, &mut strands).unwrap(), samples::pose(frame));
        assert_eq!(strands.points(), samples::frame_points(&original, frame));
    }
    assert_eq!(reader.hair(0).unwrap(), original);
    let error = reader.read(3, &mut strands).unwrap_err().to_string();
    assert_eq!(error, format!("{}: frame 3 is not in the cache: it holds frames 0 to 2", path.display()));
}

// A later version's tag in its place, the block is passed over: readers that do not know it read the rest.
#[test]
fn a_block_of_an_unknown_tag_is_passed_over() {
    let mut bytes = samples::cache_bytes();
    let mut renamed = 0;
    for at in (0..bytes.len() - 8).step_by(8) {
        if &bytes[at..at + 8] == b"other   " {
            bytes[at..at + 8].copy_from_slice(b"unheard ");
            renamed += 1;
        }
    }
    assert_eq!(renamed, 4);
    assert_eq!(Reader::from_bytes(&bytes).unwrap().hair(0).unwrap(), samples::hair(&[3, 2, 4]));
}

#[test]
fn attributes_under_their_own_names_that_lie_are_refused() {
    let bytes = samples::cache_bytes();
    let named = |name: &[u8]| bytes.windows(name.len()).position(|w| w == name).unwrap();
    let altered = |at: usize, word: u32| {
        let mut bytes = bytes.clone();
        bytes[at..at + 4].copy_from_slice(&word.to_le_bytes());
        Reader::from_bytes(&bytes).err().unwrap().to_string()
    };
    // The six numbers stand before the name.
    let numbers = named(b"clump\0") - 24;
    let refused = |i: usize, word: u32| altered(numbers + 4 * i, word);
    assert!(refused(0, 3).ends_with("attribute other: of neither groom, strands nor points: the file is damaged"));
    assert!(refused(0, 2).ends_with("attribute clump: 3 numbers or words do not fit (1 a value, 3 strands, 9 points)"));
    assert!(refused(1, 6).ends_with("attribute other: a role beyond the sixth: the file is damaged"));
    assert!(refused(2, 4).ends_with("attribute other: values of an unknown kind: the file is damaged"));
    assert!(refused(3, u32::MAX).contains("attribute clump: 3 numbers or words do not fit (4294967295 a value"));
    assert!(refused(4, u32::MAX).ends_with("attribute other: a name longer than its block: the file is damaged"));
    let words = altered(numbers + 32, u32::MAX);
    assert!(words.ends_with("attribute clump: words that do not fill their block: the file is damaged"), "{words}");
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
