//! How long a frame takes, and on what: `cargo bench -p nabiki_render`.
//!
//! Made-up long hair on a ball: cost against strands, pixels and width, the profile of the standard picture, what each
//! part of the picture costs, and the error against the oversampled reference. `cargo bench -p nabiki_render -- cost` (or
//! `profile`, `parts`, `error`, `movie`) runs one table only. Times are the best of a few frames; "core s" is processor time
//! summed over cores (Linux), which other work on the machine does not inflate as much.

use std::time::Instant;

use glam::vec3;
use nabiki::{Mesh, Strands};
use nabiki_render::camera::direction;
use nabiki_render::settings::{Antialiasing, Shading};
use nabiki_render::timing::Stage;
use nabiki_render::{Bounds, FrameToDraw, Movie, Picture, Renderer, ToneMapping, View};

/// Hair of 20 segments of 1 cm that leaves a ball's upper half and falls past it, in clumps, at a moment of a swing.
fn hair(strands: usize, swing: f32) -> Strands {
    let mut all = Strands::with_capacity(strands, strands * 21);
    let random = |i: usize, k: u32| {
        let mut h = (i as u32).wrapping_mul(0x9E37_79B1) ^ k.wrapping_mul(0x85EB_CA77);
        h = (h ^ h >> 15).wrapping_mul(0x2C1B_3C6D);
        h = (h ^ h >> 13).wrapping_mul(0x297A_2D39);
        (h ^ h >> 16) as f32 / u32::MAX as f32 - 0.5
    };
    for i in 0..strands {
        let up = 1.0 - 1.05 * (i as f32 + 0.5) / strands as f32;
        let normal = direction(i as f32 * 137.507_76, up.asin().to_degrees());
        let clump = (normal * 9.0).floor().to_array().map(|c| c as i32 as usize);
        let clump = clump[0].wrapping_mul(31).wrapping_add(clump[1].wrapping_mul(17)).wrapping_add(clump[2]);
        let sway = vec3(random(clump, 1), 0.0, random(clump, 2)) * 0.5;
        let own = vec3(random(i, 3), random(i, 4), random(i, 5)) * 0.25;
        let mut at = normal * 9.5;
        let mut heading = normal;
        all.push((0..21).map(|k| {
            if k > 0 {
                let pull = vec3(-0.3 * swing, -0.75, 0.3 * swing) + (sway + own) * (0.1 + 0.03 * k as f32);
                heading = (heading + 0.45 * pull).normalize();
                let outward = at.normalize();
                let sinks = 9.5 + 0.12 * k as f32 - (at + heading).length();
                if sinks > 0.0 {
                    heading = (heading + outward * sinks * 1.02).normalize();
                }
                at += heading;
            }
            at
        }));
    }
    all
}

fn ball() -> Mesh {
    let (across, down) = (96, 48);
    let mut mesh = Mesh::default();
    for y in 0..=down {
        for x in 0..across {
            let d = direction(x as f32 * 360.0 / across as f32, 90.0 - y as f32 * 180.0 / down as f32);
            mesh.positions.push(9.3 * d);
        }
    }
    for y in 0..down {
        for x in 0..across {
            let at = |x: u32, y: u32| y * across + x % across;
            mesh.triangles.push([at(x, y), at(x + 1, y), at(x, y + 1)]);
            mesh.triangles.push([at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)]);
        }
    }
    mesh
}

fn view(picture: &Picture) -> View {
    let mut bounds = Bounds::default();
    bounds.include_strands(&hair(2000, 0.0));
    View::new(&picture.camera, picture.size, &bounds)
}

/// Processor time of this process so far (s), where the system tells.
fn core_seconds() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let after_name = stat.rsplit(')').next().unwrap_or_default();
    let field = |n: usize| after_name.split_whitespace().nth(n).and_then(|f| f.parse::<f64>().ok()).unwrap_or(f64::NAN);
    (field(11) + field(12)) / 100.0
}

struct Cost {
    wall: f64,
    cores: f64,
}

/// Best wall time and mean processor time of a few frames after a first one.
fn cost(renderer: &mut Renderer, strands: &Strands, view: &View) -> Cost {
    renderer.draw(&FrameToDraw::at_rest(strands, *view)).expect("draws");
    let frames = 5;
    let before = core_seconds();
    let wall = (0..frames)
        .map(|_| {
            let start = Instant::now();
            renderer.draw(&FrameToDraw::at_rest(strands, *view)).expect("draws");
            start.elapsed().as_secs_f64()
        })
        .fold(f64::INFINITY, f64::min);
    Cost { wall, cores: (core_seconds() - before) / f64::from(frames) }
}

fn measure(name: &str, strands: usize, change: impl Fn(&mut Picture)) {
    let mut picture = Picture { size: [1024, 1024], ..Picture::default() };
    change(&mut picture);
    let view = view(&picture);
    let mut renderer = Renderer::new(&picture, &ball()).expect("settings");
    let cost = cost(&mut renderer, &hair(strands, 0.0), &view);
    let [width, height] = picture.size;
    println!(
        "{name:<34} {strands:>7} {width:>5} x {height:<5} {:>8.4} {:>8.3} {:>8.3}",
        picture.hair.width, cost.wall, cost.cores
    );
}

fn heading(title: &str) {
    println!("\n{title}\n{:<34} {:>7} {:>13} {:>8} {:>8} {:>8}", "", "strands", "pixels", "width cm", "s", "core s");
}

fn cost_tables() {
    heading("Aims");
    measure("standard", 20_000, |_| ());
    measure("fifty thousand, 1/4 pixel", 50_000, |p| {
        p.size = [1024, 783];
        p.hair.width = 0.25 * 44.0 / 783.0;
    });
    heading("Strands");
    for strands in [2_500, 5_000, 10_000, 20_000, 50_000, 100_000] {
        measure("", strands, |_| ());
    }
    heading("Pixels");
    for side in [256, 512, 1024, 2048] {
        measure("", 20_000, |p| p.size = [side, side]);
    }
    heading("Width");
    for width in [0.0005, 0.003, 0.012, 0.05, 0.2] {
        measure("", 20_000, |p| p.hair.width = width);
    }
}

fn parts() {
    heading("Parts");
    measure("all", 20_000, |_| ());
    measure("Kajiya-Kay", 20_000, |p| p.hair.shading = Shading::KajiyaKay);
    measure("one lamp", 20_000, |p| p.lights.truncate(1));
    measure("no shadows", 20_000, |p| p.shadows = false);
    measure("no sky occlusion", 20_000, |p| p.sky.occlusion = false);
    measure("none of these", 20_000, |p| {
        p.hair.shading = Shading::KajiyaKay;
        p.lights.truncate(1);
        p.shadows = false;
        p.sky.occlusion = false;
    });
    measure("oversampled 4 x 4", 20_000, |p| p.antialiasing = Antialiasing::Oversample);
    for f_stop in [8.0, 2.8, 1.0] {
        measure(&format!("through a lens, f/{f_stop}"), 20_000, |p| p.camera.f_stop = Some(f_stop));
    }
}

/// Milliseconds a frame on each stage after the first frame, of hair that swings.
fn profile_of(title: &str, strands: usize, picture: &Picture) {
    let view = view(picture);
    let mut renderer = Renderer::new(picture, &ball()).expect("settings");
    let swing: Vec<Strands> = (0..8).map(|i| hair(strands, (i as f32 * 0.6).sin())).collect();
    renderer.draw(&FrameToDraw::at_rest(&swing[0], view)).expect("draws");
    let first = *renderer.timing();
    for strands in &swing {
        renderer.draw(&FrameToDraw::at_rest(strands, view)).expect("draws");
    }
    let frames = swing.len() as f64;
    println!("\nProfile: {title} (ms a frame, mean of {frames}; the first frame)");
    for stage in Stage::ALL {
        let mean = (renderer.timing().of(stage) - first.of(stage)).as_secs_f64() * 1e3 / frames;
        println!("{:<12} {mean:>8.2} {:>8.1}", format!("{stage:?}"), first.of(stage).as_secs_f64() * 1e3);
    }
}

fn profile() {
    let picture = Picture { size: [1024, 1024], ..Picture::default() };
    profile_of("20,000 x 20 segments, 1024 x 1024", 20_000, &picture);
    profile_of("a preview, 300 x 20 segments, 480 x 270", 300, &preview());
}

/// The picture of a preview: small, its few hairs eight times as thick.
fn preview() -> Picture {
    let mut picture = Picture { size: [480, 270], ..Picture::default() };
    picture.hair.width *= 8.0;
    picture
}

/// Root of the mean square difference in sRGB steps of 255.
fn difference(a: &[u8], b: &[u8]) -> f64 {
    let sum: f64 = a.iter().zip(b).map(|(a, b)| (f64::from(*a) - f64::from(*b)).powi(2)).sum();
    // Alpha agrees where a background is drawn: three of four bytes count.
    (sum / (0.75 * a.len() as f64)).sqrt()
}

fn error() {
    println!("\nError against 32 x 32 oversampling (root mean square, steps of 255 in sRGB)");
    for (strands, width) in [(20_000, 0.003), (20_000, 0.006), (20_000, 0.012), (20_000, 0.025), (20_000, 0.1)] {
        let mut picture = Picture { size: [512, 512], ..Picture::default() };
        picture.hair.width = width;
        let strands = hair(strands, 0.0);
        let view = view(&picture);
        let tone_mapping = ToneMapping::new(&picture);
        let draw = |antialiasing, samples| {
            let picture = Picture { antialiasing, samples, ..picture.clone() };
            let frame = Renderer::new(&picture, &ball())
                .expect("settings")
                .draw(&FrameToDraw::at_rest(&strands, view))
                .expect("draws");
            tone_mapping.rgba8(&frame)
        };
        let reference = draw(Antialiasing::Oversample, 32);
        println!(
            "{width:>6} cm: coverage {:.2}, oversampled 2 x 2 {:.2}, 4 x 4 {:.2}, 8 x 8 {:.2}, 16 x 16 {:.2}",
            difference(&draw(Antialiasing::Coverage, 1), &reference),
            difference(&draw(Antialiasing::Oversample, 2), &reference),
            difference(&draw(Antialiasing::Oversample, 4), &reference),
            difference(&draw(Antialiasing::Oversample, 8), &reference),
            difference(&draw(Antialiasing::Oversample, 16), &reference),
        );
    }
}

fn movie() {
    movie_of(19_330, &Picture { size: [1280, 720], ..Picture::default() });
    movie_of(300, &preview());
}

fn movie_of(strands: usize, picture: &Picture) {
    let view = view(picture);
    let tone_mapping = ToneMapping::new(picture);
    let mut renderer = Renderer::new(picture, &ball()).expect("settings");
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("movie.mp4");
    let mut movie = Movie::create(&path, picture, 24.0).expect("a movie");
    let frames: Vec<Strands> = (0..10).map(|i| hair(strands, (i as f32 * 0.6).sin())).collect();
    let start = Instant::now();
    let mut encoding = 0.0;
    for frame in &frames {
        let frame = renderer.draw(&FrameToDraw::at_rest(frame, view)).expect("draws");
        let start = Instant::now();
        movie.push(&frame, &tone_mapping).expect("encodes");
        encoding += start.elapsed().as_secs_f64();
    }
    movie.finish().expect("finishes");
    let wall = start.elapsed().as_secs_f64() / frames.len() as f64;
    let [width, height] = picture.size;
    let encoding = encoding / frames.len() as f64;
    println!("\nMovie: {strands} strands, {width} x {height}: {wall:.4} s a frame, {encoding:.4} s of it encoding");
}

fn main() {
    let wanted: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with('-')).collect();
    let tables: [(&str, fn()); 5] =
        [("cost", cost_tables), ("parts", parts), ("profile", profile), ("error", error), ("movie", movie)];
    for (name, table) in tables {
        if wanted.is_empty() || wanted.iter().any(|w| w == name) {
            table();
        }
    }
}
