//! Motion caches: exact to the bit, whole or absent, refused when damaged.

#[allow(dead_code, reason = "shared by several test programs, each of which uses a part")]
mod samples;

use nabiki_io::cache::{Header, Reader, Writer};
use twox_hash::XxHash3_64;

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
    let bytes = samples::summed(bytes);
    assert_eq!(Reader::from_bytes(&bytes).unwrap().hair(0).unwrap(), samples::hair(&[3, 2, 4]));
}

#[test]
fn attributes_under_their_own_names_that_lie_are_refused() {
    let bytes = samples::cache_bytes();
    let named = |name: &[u8]| bytes.windows(name.len()).position(|w| w == name).unwrap();
    let altered = |at: usize, word: u32| {
        let mut bytes = bytes.clone();
        bytes[at..at + 4].copy_from_slice(&word.to_le_bytes());
        Reader::from_bytes(&samples::summed(bytes)).err().unwrap().to_string()
    };
    // The six numbers stand before the name.
    let numbers = named(b"clump\0") - 24;
    let refused = |i: usize, word: u32| altered(numbers + 4 * i, word);
    assert!(refused(0, 3).ends_with("attribute other: is not of groom, strands or points: the file is damaged"));
    let clump = "attribute clump: 3 numbers or words do not fit (1 per value, 3 strands, 9 points)";
    assert!(refused(0, 2).ends_with(clump));
    assert!(refused(1, 6).ends_with("attribute other: unknown role: the file is damaged"));
    assert!(refused(2, 4).ends_with("attribute other: values of an unknown kind: the file is damaged"));
    assert!(refused(3, 0).ends_with("attribute other: values without numbers: the file is damaged"));
    assert!(refused(3, u32::MAX).contains("attribute clump: 3 numbers or words do not fit (4294967295 per value"));
    assert!(refused(4, u32::MAX).ends_with("attribute other: a name longer than its block: the file is damaged"));
    let words = altered(numbers + 32, u32::MAX);
    assert!(words.ends_with("attribute clump: its words do not fill their block: the file is damaged"), "{words}");
}

#[test]
fn an_unfinished_cache_leaves_no_file() {
    let folder = tempfile::tempdir().unwrap();
    let hair = samples::hair(&[2]);
    let header = Header::new(Default::default(), 24.0, &hair);
    let mut writer = Writer::create(&folder.path().join("motion.nabiki"), &header, 2).unwrap();
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
    let refused = |header: &Header| Writer::create(&path, header, 2).err().unwrap().to_string();
    assert_eq!(refused(&Header { frame_rate: 0.0, ..header.clone() }), named("frame rate is 0: must be above 0"));
    let mut no_strands = header.clone();
    no_strands.starts = vec![0];
    assert_eq!(refused(&no_strands), named("there are no strands to write"));

    let mut stub = header.clone();
    stub.starts = vec![0, 1, 2];
    stub.attributes = Default::default();
    let line = "strand 0: starts at point 0 and the next at 1: a strand needs at least 2 points";
    assert_eq!(refused(&stub), named(line));
    let none = Writer::create(&path, &header, 0).err().unwrap().to_string();
    assert_eq!(none, named("there are no frames to write"));

    let mut writer = Writer::create(&path, &header, 2).unwrap();
    let mut points = hair.strands.points().to_vec();
    points[1].y = f32::NAN;
    let error = writer.push(&samples::pose(0), &points).unwrap_err().to_string();
    assert!(error.contains("frame 0: point 1 is [0, NaN, 0.25]"), "{error}");
    let error = writer.push(&samples::pose(0), &points[..1]).unwrap_err().to_string();
    assert_eq!(error, named("frame 0: 1 points, but the cache has 2"));
    assert_eq!(writer.finish().unwrap_err().to_string(), named("0 frames, but the cache has 2"));
    let nowhere = folder.path().join("absent/motion.nabiki");
    assert!(Writer::create(&nowhere, &header, 2).is_err());
}

#[test]
fn a_cache_cut_short_says_how_many_frames_it_holds() {
    let bytes = samples::cache_bytes();
    let error = Reader::from_bytes(&bytes[..bytes.len() - 1]).err().unwrap().to_string();
    assert!(error.contains("3 frames of 136 bytes from offset") && error.contains("(2 frames)"), "{error}");
}

#[test]
fn a_rotation_of_another_length_than_1_is_neither_read_nor_written() {
    let mut bytes = samples::cache_bytes();
    // Of the last frame, of 28 + 12 x 9 bytes, behind the position.
    let rotation = bytes.len() - 136 + 12;
    bytes[rotation..rotation + 16].fill(0);
    let bytes = samples::summed(bytes);
    let mut reader = Reader::from_bytes(&bytes).unwrap();
    let mut strands = reader.header().strands();
    assert!(reader.read(1, &mut strands).is_ok());
    let error = reader.read(2, &mut strands).unwrap_err().to_string();
    assert!(error.contains("frame 2: the head is at") && error.ends_with(": the file is damaged"), "{error}");

    let folder = tempfile::tempdir().unwrap();
    let hair = samples::hair(&[2]);
    let path = folder.path().join("motion.nabiki");
    let mut writer = Writer::create(&path, &Header::new(Default::default(), 24.0, &hair), 1).unwrap();
    let flattened = nabiki::Pose { rotation: samples::pose(0).rotation * 0.5, ..samples::pose(0) };
    let error = writer.push(&flattened, hair.strands.points()).unwrap_err().to_string();
    assert!(error.contains("frame 0: the head is at"), "{error}");
}

// Frames of a turning head, whole and in parts of any size: the same file, which knows the box about all of them.
#[test]
fn frames_in_parts_are_frames_and_all_lie_in_the_bounds() {
    let folder = tempfile::tempdir().unwrap();
    let (whole, parts) = (folder.path().join("whole.nabiki"), folder.path().join("parts.nabiki"));
    let header = samples::write_cache(&whole);
    let hair = samples::whole(&[3, 2, 4]);
    for size in [1, 2, 4, 9, 100] {
        let mut writer = Writer::create(&parts, &header, 3).unwrap();
        for frame in 0..3 {
            writer.begin_frame(&samples::pose(frame)).unwrap();
            samples::frame_points(&hair, frame).chunks(size).for_each(|part| writer.part(part).unwrap());
        }
        assert_eq!(writer.finish().unwrap(), 3);
        assert!(std::fs::read(&parts).unwrap() == std::fs::read(&whole).unwrap(), "{size}");
    }
    let [low, high] = Reader::open(&whole).unwrap().bounds().unwrap();
    let turned = (0..3).flat_map(|frame| {
        let points = samples::frame_points(&hair, frame);
        points.into_iter().map(move |p| samples::pose(frame).rotation * p).collect::<Vec<_>>()
    });
    let (mut lowest, mut highest) = (glam::Vec3::INFINITY, glam::Vec3::NEG_INFINITY);
    turned.for_each(|p| (lowest, highest) = (lowest.min(p), highest.max(p)));
    assert_eq!((low, high), (lowest, highest));
}

#[test]
fn a_frame_that_is_not_whole_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("m.nabiki");
    let header = samples::write_cache(&path);
    std::fs::remove_file(&path).unwrap();
    let points = samples::frame_points(&samples::whole(&[3, 2, 4]), 0);
    let writer = || {
        let mut writer = Writer::create(&path, &header, 2).unwrap();
        writer.begin_frame(&samples::pose(0)).unwrap();
        writer
    };
    let said = |refused: nabiki_io::Result<()>| refused.unwrap_err().to_string();
    let mut short = writer();
    short.part(&points[..8]).unwrap();
    assert!(said(short.begin_frame(&samples::pose(1))).ends_with("frame 0: 8 points, but the cache has 9"));
    assert!(said(short.finish().map(drop)).ends_with("frame 0: 8 points, but the cache has 9"));
    let mut second = writer();
    second.part(&points).unwrap();
    second.begin_frame(&samples::pose(1)).unwrap();
    second.part(&points[..5]).unwrap();
    assert!(said(second.finish().map(drop)).ends_with("frame 1: 5 points, but the cache has 9"));
    let mut long = writer();
    long.part(&points[..8]).unwrap();
    assert!(said(long.part(&points[..2])).ends_with("frame 0: 10 points, but the cache has 9"));
    drop(long);
    let mut one_more = writer();
    for n in 0..2 {
        one_more.part(&points).unwrap();
        assert_eq!(one_more.begin_frame(&samples::pose(n + 1)).is_ok(), n == 0);
    }
    assert!(said(one_more.begin_frame(&samples::pose(2))).ends_with("frame 2: the cache has room for 2 frames"));
    drop(one_more);
    assert!(!path.exists());
}

#[test]
fn the_number_of_the_first_frame_is_kept_where_it_is_not_0() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("motion.nabiki");
    let hair = samples::hair(&[2]);
    for first_frame in [1001, -24, 0] {
        let header = Header { first_frame, ..Header::new(Default::default(), 24.0, &hair) };
        let mut writer = Writer::create(&path, &header, 1).unwrap();
        writer.push(&samples::pose(0), hair.strands.points()).unwrap();
        writer.finish().unwrap();
        assert_eq!(Reader::open(&path).unwrap().header().first_frame, first_frame);
        // As docs/cache.md has it: the tag, the number of bytes, the number, zeros up to eight.
        let bytes = std::fs::read(&path).unwrap();
        let block = [&b"start   "[..], &4u64.to_le_bytes(), &first_frame.to_le_bytes(), &[0; 4]].concat();
        assert_eq!(bytes.windows(block.len()).any(|window| window == block), first_frame != 0, "{first_frame}");
    }
}

#[test]
fn info_tells_how_far_a_point_is_in_the_last_frame_from_where_it_was_in_the_first() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("motion.nabiki");
    samples::write_cache(&path);
    let nabiki_io::info::Info::Cache(found) = nabiki_io::info::info(&path).unwrap() else { panic!("it is a cache") };
    // Every point goes by (0.1, -0.3, 0.7) a frame, of which there are three.
    assert!((found.farthest_move - 2.0 * 0.59f32.sqrt()).abs() < 1e-5, "{}", found.farthest_move);
    assert!(found.head_moves);
}

// Points of a hole in a file, a bit that has turned over, a block that is lost: whatever is no longer what was written is found.
#[test]
fn any_damage_to_a_cache_is_refused_by_the_frame_or_the_header() {
    let bytes = samples::cache_bytes();
    let read = |bytes: &[u8]| {
        let mut reader = Reader::from_bytes(bytes).map_err(|e| e.to_string())?;
        let said = |n: u64, reader: &mut Reader<_>| reader.hair(n).map_err(|e| e.to_string());
        let frames: Vec<_> = (0..3).map(|n| said(n, &mut reader)).collect();
        Ok::<_, String>(frames)
    };
    assert!(read(&bytes).unwrap().iter().all(Result::is_ok));
    let way_out = "the file is damaged, its checksum does not match; copy it again, or make it again";
    let first_frame = bytes.len() - 3 * 136;
    let mut damaged = bytes.clone();
    for at in 0..bytes.len() {
        for bit in 0..8 {
            damaged[at] ^= 1 << bit;
            let found = read(&damaged);
            // In the header nothing is read any longer; of the frames, the one that is damaged.
            if at >= first_frame {
                let frame = (at - first_frame) / 136;
                for (n, of_frame) in found.unwrap().into_iter().enumerate() {
                    let expected = (n == frame).then(|| format!("cache: frame {n}: {way_out}"));
                    assert_eq!(of_frame.err(), expected, "byte {at}, bit {bit}");
                }
            } else {
                assert!(found.is_err() || found.unwrap().iter().any(Result::is_err), "byte {at}, bit {bit}");
            }
            damaged[at] = bytes[at];
        }
    }
    for frame in 0..3 {
        let points = first_frame + frame * 136 + 28..first_frame + (frame + 1) * 136;
        damaged[points.clone()].fill(0);
        let found = read(&damaged).unwrap();
        assert_eq!(found.iter().position(Result::is_err), Some(frame));
        damaged[points.clone()].copy_from_slice(&bytes[points]);
    }
    // Hair that begins elsewhere, of strands that are whole.
    let starts = [0_u32, 3, 5, 9].map(u32::to_le_bytes).concat();
    assert_eq!(bytes[64..80], starts);
    damaged[72..76].copy_from_slice(&6_u32.to_le_bytes());
    assert_eq!(read(&damaged).unwrap_err(), format!("cache: header: {way_out}"));
}

// As docs/cache.md has it, with nothing of the writer's.
#[test]
fn sums_are_those_that_the_document_describes() {
    let bytes = samples::cache_bytes();
    let at = bytes.windows(8).position(|tag| tag == b"sums    ").unwrap() + 16;
    let sums: Vec<u64> = bytes[at..at + 32].chunks(8).map(|n| u64::from_le_bytes(n.try_into().unwrap())).collect();
    let frames = bytes.len() - 3 * 136;
    assert_eq!((at % 8, at + 32), (0, frames));
    assert_eq!(bytes[at - 8..at], 32_u64.to_le_bytes());
    let all = std::iter::once(&bytes[..at]).chain(bytes[frames..].chunks(136));
    assert_eq!(sums, all.map(XxHash3_64::oneshot).collect::<Vec<_>>());
    // The algorithm is the one of that name: its sum of no bytes, as its authors give it.
    assert_eq!(XxHash3_64::oneshot(b""), 0x2d06_8005_38d3_94c2);
}

#[test]
fn a_cache_without_its_sums_or_its_bounds_is_refused() {
    for (block, sealed) in [("sums", false), ("bounds", true)] {
        let mut bytes = samples::cache_bytes();
        let at = bytes.windows(8).position(|tag| tag == format!("{block:8}").as_bytes()).unwrap();
        bytes[at..at + 8].copy_from_slice(b"unheard ");
        let bytes = if sealed { samples::summed(bytes) } else { bytes };
        let said = Reader::from_bytes(&bytes).err().unwrap().to_string();
        assert!(said.starts_with(&format!("cache: has no block {block}: ")) && !said.contains('\n'), "{said}");
    }
}

#[test]
fn strands_of_fewer_than_two_points_are_refused() {
    let bytes = samples::cache_bytes();
    // The starts are 0, 3, 5, 9.
    for (strand, start, line) in [
        (1, 0_u32, "strand 0: starts at point 0 and the next at 0"),
        (1, 1, "strand 0: starts at point 0 and the next at 1"),
        (1, 4, "strand 1: starts at point 4 and the next at 5"),
        (2, 2, "strand 1: starts at point 3 and the next at 2"),
        (2, u32::MAX, "strand 2: starts at point 4294967295 and the next at 9"),
    ] {
        let mut damaged = bytes.clone();
        damaged[64 + 4 * strand..][..4].copy_from_slice(&start.to_le_bytes());
        let said = Reader::from_bytes(&damaged).err().unwrap().to_string();
        assert_eq!(said, format!("cache: {line}: a strand needs at least 2 points: the file is damaged"));
    }
}
