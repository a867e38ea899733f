//! A motion cache that is no longer what was written is refused by every command that reads it, by file and frame, in one line.

mod common;

use std::fs;
use std::path::Path;

use common::{refuse, succeed};

const GUST: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/gust.toml");
const FEW: &str = "--set hair.strands=900 --strands 20 --frames 3 --set output.sheet=[0] --set picture.size=[96,64]";

/// Changes the points of frame `n` of the cache `name`, as bytes.
fn change_points(folder: &Path, name: &str, n: usize, change: impl Fn(&mut [u8])) {
    let file = folder.join(name);
    let mut bytes = fs::read(&file).unwrap();
    let number = |at: usize, size: usize| (0..size).map(|i| usize::from(bytes[at + i]) << (8 * i)).sum::<usize>();
    let (points, frames_at) = (number(16, 4), number(32, 8));
    let frame = frames_at + n * (28 + 12 * points);
    change(&mut bytes[frame + 28..frame + 28 + 12 * points]);
    fs::write(file, bytes).unwrap();
}

#[test]
fn a_frame_whose_points_are_no_longer_its_own_is_used_by_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    succeed(folder, &format!("simulate {GUST} {FEW} -o sound.nabiki"));
    for (name, frame) in [("hole.nabiki", 3), ("bit.nabiki", 3), ("middle.nabiki", 2)] {
        fs::copy(folder.join("sound.nabiki"), folder.join(name)).unwrap();
        change_points(folder, name, frame, |points| match name {
            "bit.nabiki" => points[7] ^= 1,
            _ => points.fill(0),
        });
        let why = format!(
            "{name}: frame {frame}: the file is damaged, its checksum does not match; copy it again, or make it again"
        );
        for words in [
            format!("render {GUST} {FEW} --motion {name} --out out"),
            format!("render {GUST} {FEW} --motion {name} --frames {frame}..{frame} --out out"),
            format!("convert {name} out.usdc"),
            format!("convert {name} --frame {frame} out.hair"),
        ] {
            let words = words.replace("--frames 3 ", "--set motion.frames=3 ");
            assert_eq!(refuse(folder, &words).trim_end(), format!("nabiki: {why}"), "{words}");
        }
        assert!(!folder.join("out.usdc").exists() && !folder.join("out.hair").exists());
        succeed(folder, &format!("convert {name} --frame 1 one.hair"));
    }
    assert!(refuse(folder, "info hole.nabiki").contains("hole.nabiki: frame 3: the file is damaged"));
}

#[test]
fn a_damaged_shard_is_not_joined() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for k in 1..=2 {
        succeed(folder, &format!("simulate {GUST} {FEW} --shard {k}/2 -o {k}.nabiki"));
    }
    change_points(folder, "2.nabiki", 1, |points| points[40] ^= 0x10);
    let line = refuse(folder, "join 1.nabiki 2.nabiki -o all.nabiki");
    assert!(line.contains("2.nabiki: frame 1: the file is damaged, its checksum does not match"), "{line}");
    assert!(!folder.join("all.nabiki").exists());
}

#[test]
fn strands_without_points_are_refused_and_not_measured() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    succeed(folder, &format!("simulate {GUST} {FEW} -o m.nabiki"));
    let sound = fs::read(folder.join("m.nabiki")).unwrap();
    // The starts of strands 0 and 1; the first has 19 points or fewer.
    for (start, why) in [
        (0, "strand 0: starts at point 0 and the next at 0: a strand needs at least 2 points"),
        (2, "header: the file is damaged, its checksum does not match"),
    ] {
        let mut bytes = sound.clone();
        bytes[68..72].copy_from_slice(&u32::to_le_bytes(start));
        fs::write(folder.join("m.nabiki"), bytes).unwrap();
        for words in [format!("render {GUST} {FEW} --motion m.nabiki --out out"), "info m.nabiki".to_owned()] {
            let words = words.replace("--frames 3 ", "--set motion.frames=3 ");
            let line = refuse(folder, &words);
            assert!(line.starts_with(&format!("nabiki: m.nabiki: {why}")), "{words}: {line}");
        }
    }
}
