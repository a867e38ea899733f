//! Reading and writing 100 MB of strands in every format, beside the bare bytes of the same file:
//! `cargo bench -p nabiki_io`; `-- 500` takes 500 MB, `-- usda` only formats of that name.
//!
//! The best of several tries, taken in turns with the bare bytes, from and to the operating system's cache, so that
//! the work is seen and not the disk: where `TMPDIR` is a file system in memory (`/dev/shm`), the disk has no part at
//! all. Memory is the most that was allocated at a time beyond the hair itself.

use std::fs::{self, File};
use std::io::{Read, Write};
use std::path::Path;
use std::time::Instant;

use glam::{DAffine3, Vec3};
use nabiki::Pose;
use nabiki::{Hair, Strands};
use nabiki_alembic::ArchiveReader;
use nabiki_exchange::{Export, FrameSink, GroomReader};
use nabiki_io::moving::{self, ChainOptions};
use nabiki_io::{SceneId, cache, hair};
use nabiki_usd::StageReader;
use peak_alloc::PeakAlloc;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

const STRANDS: usize = 20_000;
const POINTS: usize = 21;
const TRIES: usize = 5;

fn main() {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| word != "--bench").collect();
    let megabytes: usize = words.iter().find_map(|word| word.parse().ok()).unwrap_or(100);
    let frames = (megabytes * 1_000_000).div_ceil(STRANDS * POINTS * 12).max(1);
    let wanted = |name: &&str| words.iter().all(|word| word.parse::<usize>().is_ok() || name.contains(word.as_str()));
    let folder = tempfile::tempdir().expect("a folder for the files");
    println!(
        "{frames} frames of {STRANDS} strands of {POINTS} points: seconds, beside the bare bytes of the same file"
    );
    println!("format         MB  written  (bare)            read  (bare)             memory, writing and reading");
    let moving = motion(frames);
    for name in ["moving.nabiki", "moving.usdc", "moving.abc", "moving.usda"].into_iter().filter(wanted) {
        let path = folder.path().join(name);
        report(&path, &|| write_moving(&path, &moving), &|| read_moving(&path, frames));
    }
    drop(moving);
    let still = Hair::from(still(frames));
    for name in ["still.hair", "still.tfx"].into_iter().filter(wanted) {
        let path = folder.path().join(name);
        let write = || drop(hair::write(&path, &still).expect("written"));
        report(&path, &write, &|| drop(hair::read(&path).expect("read")));
    }
}

/// Hair that differs in every frame.
fn motion(frames: usize) -> Vec<Strands> {
    let strand = |frame: usize, s: usize| {
        let angle = s as f32 * 0.618 + frame as f32 * 1e-3;
        (0..POINTS).map(move |p| Vec3::new(9.0 * angle.cos(), 10.0 - p as f32 * 0.97, 9.0 * (angle + p as f32).sin()))
    };
    let frame = |frame: usize| {
        let mut strands = Strands::with_capacity(STRANDS, STRANDS * POINTS);
        (0..STRANDS).for_each(|s| strands.push(strand(frame, s)));
        strands
    };
    (0..frames).map(frame).collect()
}

/// As many points that stand still.
fn still(frames: usize) -> Strands {
    let mut all = Strands::with_capacity(frames * STRANDS, frames * STRANDS * POINTS);
    motion(frames).iter().for_each(|frame| frame.iter().for_each(|strand| all.push(strand.iter().copied())));
    all
}

fn write_moving(path: &Path, frames: &[Strands]) {
    let hair = Hair::from(frames[0].clone());
    if path.extension().is_some_and(|ending| ending == "nabiki") {
        let header = cache::Header::new(SceneId::default(), 24.0, &hair);
        let mut writer = cache::Writer::create(path, &header, frames.len() as u64).expect("created");
        let head = Pose { position_cm: Vec3::ZERO, rotation: glam::Quat::IDENTITY };
        frames.iter().for_each(|strands| writer.push(&head, strands.points()).expect("pushed"));
        writer.finish().expect("finished");
        return;
    }
    let mut sink: Box<dyn FrameSink> =
        moving::sink(path, Export::new(&hair, 24.0), None, ChainOptions::default()).expect("created");
    frames.iter().for_each(|strands| sink.frame(strands, &DAffine3::IDENTITY).expect("written"));
    sink.finish().expect("finished");
}

fn read_moving(path: &Path, frames: usize) {
    match path.extension().and_then(|ending| ending.to_str()) {
        Some("nabiki") => {
            let mut reader = cache::Reader::open(path).expect("opened");
            let mut strands = reader.header().strands();
            for n in 0..frames as u64 {
                reader.read(n, &mut strands).expect("read");
            }
        }
        Some("abc") => {
            let mut archive = ArchiveReader::open(path).expect("opened");
            (0..frames).for_each(|n| drop(archive.hair(n, None).expect("read")));
        }
        _ => {
            let mut stage = StageReader::open(path).expect("opened");
            (0..frames).for_each(|n| drop(stage.hair(n, None).expect("read")));
        }
    }
}

/// Times writing and reading against the same bytes alone.
fn report(path: &Path, write: &dyn Fn(), read: &dyn Fn()) {
    let bare = path.with_extension("bare");
    let mut block = vec![0; 1 << 20];
    let mut best = [f64::INFINITY; 4];
    let mut most = [0; 2];
    for _ in 0..TRIES {
        for old in [path, &bare] {
            let _ = fs::remove_file(old);
        }
        let (written, writing) = timed(write);
        let (read, reading) = timed(read);
        let (bare_read, _) = timed(|| read_bare(path, &mut block));
        let (bare_written, _) = timed(|| write_bare(path, &bare, &block));
        for (best, time) in best.iter_mut().zip([written, bare_written, read, bare_read]) {
            *best = best.min(time);
        }
        most = [most[0].max(writing), most[1].max(reading)];
    }
    let size = fs::metadata(path).expect("there").len() as f64 * 1e-6;
    let [written, bare_written, read, bare_read] = best;
    println!(
        "{:7} {size:9.0} {written:8.3} ({bare_written:.3}) {:5.1}x {read:8.3} ({bare_read:.3}) {:5.1}x {:7} {:5} MB",
        path.extension().unwrap_or_default().to_string_lossy(),
        written / bare_written,
        read / bare_read,
        most[0] / 1_000_000,
        most[1] / 1_000_000,
    );
    for old in [path, &bare] {
        let _ = fs::remove_file(old);
    }
}

/// Seconds, and the most bytes allocated at a time.
fn timed(work: impl FnOnce()) -> (f64, usize) {
    let before = MEMORY.current_usage();
    MEMORY.reset_peak_usage();
    let started = Instant::now();
    work();
    (started.elapsed().as_secs_f64(), MEMORY.peak_usage() - before)
}

/// A block at a time into the same memory, as `cat` does: readers, which must make room for what they give, do more.
fn read_bare(path: &Path, block: &mut [u8]) {
    let mut file = File::open(path).expect("opened");
    while file.read(block).expect("read") > 0 {}
}

/// Writes as many bytes as the file at `like` has.
fn write_bare(like: &Path, to: &Path, block: &[u8]) {
    let mut left = fs::metadata(like).expect("there").len() as usize;
    let mut file = File::create(to).expect("created");
    while left > 0 {
        let part = left.min(block.len());
        file.write_all(&block[..part]).expect("written");
        left -= part;
    }
}
