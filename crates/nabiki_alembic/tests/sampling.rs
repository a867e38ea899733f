//! Archives whose samples stand at other times than evenly spaced ones, or that lack some.

use std::io::{Cursor, Read, Seek};
use std::path::Path;

use glam::{DAffine3, Vec3};
use nabiki::{Hair, Strands};
use nabiki_alembic::{ArchiveReader, HairArchive};
use nabiki_exchange::{Export, FrameSink, GroomReader, PrimKind};

const FRAME: f64 = 1.0 / 24.0;
/// The cycle of times that follow no rule.
const ACYCLIC: f64 = f64::MAX / 32.0;

fn strands(z: f32) -> Strands {
    let mut strands = Strands::default();
    strands.push([Vec3::new(0.0, 0.0, z), Vec3::new(0.0, 1.0, z)]);
    strands
}

/// Hair of one sample at each of `times` (frames), which are those of cycles as long as `period` (s). `hair_moves`:
/// the points' z is the time in frames; otherwise the transform's x is.
fn archive(times: &[f64], period: f64, in_cycle: usize, hair_moves: bool) -> ArchiveReader<Cursor<Vec<u8>>> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("hair.abc");
    let hair = Hair::from(strands(0.0));
    // Its rate is that of frames where no cycle says another.
    let mut sink = Box::new(HairArchive::create(&path, Export::new(&hair, 24.0)).unwrap());
    for &time in times {
        let time = time as f32;
        let (z, x) = if hair_moves { (time, 0.0) } else { (0.0, time) };
        sink.frame(&strands(z), &DAffine3::from_translation((Vec3::X * x).as_dvec3())).unwrap();
    }
    sink.finish().unwrap();
    let mut file = std::fs::read(path).unwrap();
    let mut timing = Vec::new();
    for (period, times) in [(1.0, &[0.0][..]), (period, &times[..in_cycle])] {
        timing.extend(u32::to_le_bytes(64));
        timing.extend(f64::to_le_bytes(period));
        timing.extend((times.len() as u32).to_le_bytes());
        timing.extend(times.iter().flat_map(|time| (time * FRAME).to_le_bytes()));
    }
    // In the place of its own time samplings, the fifth of the root's children.
    let root = u64::from_le_bytes(file[8..16].try_into().unwrap()) as usize;
    let place = (file.len() as u64 | 1 << 63).to_le_bytes();
    file[root + 8 + 4 * 8..][..8].copy_from_slice(&place);
    file.extend((timing.len() as u64).to_le_bytes());
    file.extend(timing);
    ArchiveReader::new(Cursor::new(file)).unwrap()
}

/// An archive that `files/make.py` has written with Alembic's own library.
fn foreign(name: &str) -> ArchiveReader {
    ArchiveReader::open(&Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/files")).join(name)).unwrap()
}

/// Holds frames of an archive against their times in frames.
fn check<R: Read + Seek>(archive: &mut ArchiveReader<R>, wanted: &[f64], rate: f64, hair_moves: bool) {
    let contents = archive.contents().unwrap();
    assert_eq!((contents.times.len(), contents.frame_rate), (wanted.len(), rate));
    for (n, (&frame, time)) in wanted.iter().zip(contents.times).enumerate() {
        assert!((time / FRAME - frame).abs() < 1e-12, "frame {n} at {time} s");
        let root = archive.hair(n, None).unwrap().strands.strand(0)[0];
        let place = if hair_moves { root.z } else { root.x };
        // Rounded once in each sample and once in their blend.
        assert!((f64::from(place) - frame).abs() <= 2.0 * f64::from(f32::EPSILON) * frame, "frame {n}: {root}");
    }
}

#[test]
fn shutter_samples_are_read_at_whole_frames_whatever_they_move() {
    for hair_moves in [true, false] {
        for (times, wanted, between) in [
            (&[0.0, 0.25, 1.0, 1.25, 2.0, 2.25][..], &[0.0, 1.0, 2.0][..], 3),
            // About the frames, evenly spaced or not.
            (&[0.75, 1.25, 1.75, 2.25, 2.75, 3.25], &[1.0, 2.0, 3.0], 6),
            (&[0.9, 1.1, 1.9, 2.1], &[1.0, 2.0], 4),
            // Open for half of each frame: evenly spaced, and on whole frames as well.
            (&[1.0, 1.5, 2.0, 2.5], &[1.0, 2.0], 2),
        ] {
            let mut archive = archive(times, FRAME, 2, hair_moves);
            check(&mut archive, wanted, 24.0, hair_moves);
            let unread = archive.hair(0, None).unwrap().attributes.unread;
            assert_eq!(unread, [format!("{between} samples between frames, at 24 frames a second")]);
            let motion = archive.motion("head").unwrap();
            let sampled: Vec<f64> = motion.iter().map(|placed| placed.time / FRAME).collect();
            assert!(hair_moves || sampled.iter().zip(times).all(|(a, b)| (a - b).abs() < 1e-12), "{sampled:?}");
        }
    }
}

#[test]
fn even_samples_that_meet_the_frames_are_frames_themselves() {
    for (times, in_cycle, period, rate, off) in [
        (&[3.0, 5.0, 7.0][..], 1, 2.0 * FRAME, 12.0, Some("1.500 is written as frame 2")),
        (&[0.25, 1.25, 2.25], 1, FRAME, 24.0, Some("0.250 is written as frame 0")),
        (&[1.0, 2.0, 3.0], 3, ACYCLIC, 24.0, None),
    ] {
        let mut archive = archive(times, period, in_cycle, true);
        check(&mut archive, times, rate, true);
        let said = off.map(|off| format!("the time of its samples between frames: {off}"));
        assert_eq!(archive.hair(0, None).unwrap().attributes.unread, Vec::from_iter(said));
    }
}

#[test]
fn samples_within_a_frame_of_the_archives_own_rate_are_of_its_shutter() {
    for (times, in_cycle, period) in
        [(&[1.0, 1.5, 2.0, 2.5, 3.0][..], 1, 0.5 * FRAME), (&[1.0, 1.25, 1.5, 1.75, 2.0, 3.0], 6, ACYCLIC)]
    {
        let mut archive = archive(times, period, in_cycle, true);
        check(&mut archive, &[1.0, 2.0, 3.0], 24.0, true);
        let between = times.len() - 3;
        let unread = archive.hair(0, None).unwrap().attributes.unread;
        assert_eq!(unread, [format!("{between} samples between frames, at 24 frames a second")]);
    }
}

#[test]
fn uneven_samples_without_a_cycle_are_read_at_whole_frames() {
    for hair_moves in [true, false] {
        let mut archive = archive(&[1.0, 2.0, 2.5, 4.0], ACYCLIC, 4, hair_moves);
        check(&mut archive, &[1.0, 2.0, 3.0, 4.0], 24.0, hair_moves);
    }
    // No whole frame lies among these.
    check(&mut archive(&[1.25, 1.5, 1.625], ACYCLIC, 3, true), &[1.25], 24.0, true);
}

#[test]
fn shutter_samples_of_alembics_own_library_are_read_at_whole_frames() {
    check(&mut foreign("shutter.abc"), &[0.0, 1.0, 2.0], 24.0, true);
    check(&mut foreign("shutter_xf.abc"), &[0.0, 1.0, 2.0], 24.0, false);
    let motion = foreign("shutter_xf.abc").motion("head").unwrap();
    assert_eq!(motion.len(), 6);
    for placed in motion {
        assert!((placed.position.x - placed.time / FRAME).abs() < 1e-12, "{placed:?}");
    }
}

#[test]
fn curves_without_a_sample_are_an_empty_object() {
    let mut archive = foreign("empty_beside.abc");
    assert_eq!(archive.hair(0, None).unwrap().strands.len(), 2);
    let prims = archive.prims().unwrap();
    assert!(matches!(prims[0].kind, PrimKind::Curves { curves: 0, points: 0, .. }), "{:?}", prims[0]);
    assert_eq!(prims.len(), 2);
}
