//! How long reading 100 MB of strands takes, against reading the same bytes: `cargo bench -p nabiki_io`.
//!
//! The best of seven, the file in the operating system's cache, so that the work is seen and not the disk.

use std::{fs, path::Path, time::Instant};

use glam::Vec3;
use nabiki::{Hair, Strands};
use nabiki_io::{SceneId, cache, hair, motion::Pose};

const STRANDS: usize = 260_000;
const POINTS: usize = 32;

fn main() {
    let mut strands = Strands::with_capacity(STRANDS, STRANDS * POINTS);
    for s in 0..STRANDS {
        strands.push((0..POINTS).map(|p| Vec3::new(s as f32 * 1e-3, p as f32, (s % 512) as f32)));
    }
    let hair = Hair::from(strands);
    let folder = tempfile::tempdir().expect("a folder for the files");
    for name in ["strands.hair", "strands.tfx"] {
        let path = folder.path().join(name);
        hair::write(&path, &hair).expect("written");
        report(&path, || hair::read(&path).expect("read").strands.points().len());
    }

    let path = folder.path().join("strands.nabiki");
    let head = Pose { position_cm: Vec3::ZERO, rotation: glam::Quat::IDENTITY };
    let header = cache::Header::new(SceneId::default(), 24.0, &hair);
    let started = Instant::now();
    let mut writer = cache::Writer::create(&path, &header).expect("created");
    for _ in 0..4 {
        writer.push(&head, hair.strands.points()).expect("pushed");
    }
    writer.finish().expect("finished");
    let megabytes = fs::metadata(&path).expect("there").len() as f64 * 1e-6;
    println!("{:>16}: written at {:.0} MB/s", "strands.nabiki", megabytes / started.elapsed().as_secs_f64());
    let mut reader = cache::Reader::open(&path).expect("opened");
    let mut frame = reader.header().strands();
    report(&path, || (0..4).map(|n| reader.read(n, &mut frame).map(|_| frame.points().len()).expect("read")).sum());
}

/// Times `read` against the bare reading of the same file.
fn report(path: &Path, mut read: impl FnMut() -> usize) {
    let best = |work: &mut dyn FnMut() -> usize| {
        let times = (0..7).map(|_| {
            let started = Instant::now();
            std::hint::black_box(work());
            started.elapsed().as_secs_f64()
        });
        times.fold(f64::INFINITY, f64::min)
    };
    let bare = best(&mut || fs::read(path).expect("bytes").len());
    let ours = best(&mut read);
    let megabytes = fs::metadata(path).expect("there").len() as f64 * 1e-6;
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    println!(
        "{name:>16}: {megabytes:.0} MB in {:.1} ms, its bytes alone in {:.1} ms: {:.2} times",
        1e3 * ours,
        1e3 * bare,
        ours / bare
    );
}
