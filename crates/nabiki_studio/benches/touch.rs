//! From a touch to the motion of all frames: what the worker of a window takes for each kind of change.
//!
//!     cargo bench -p nabiki_studio --bench touch

use std::time::{Duration, Instant};

use nabiki_scene::{Scene, Shown};
use nabiki_studio::motion::{Manner, Motion};

/// The gust, whose wind is the same everywhere but for swirls.
const GUST: &str = include_str!("../src/first.toml");
const TOUCHES: usize = 40;

fn main() {
    let mut gust = Scene::parse(GUST, "gust.toml".as_ref(), &[]).unwrap_or_else(|e| panic!("{e}"));
    gust.motion.frames = 100;
    gust.output.sheet = None;
    let mut uniform = gust.clone();
    uniform.field.turbulence = None;
    for (name, scene) in [("without turbulence", uniform), ("as it is", gust)] {
        println!("the gust {name}, 100 frames");
        touch_it(&scene);
    }
}

fn touch_it(scene: &Scene) {
    let mut motion = Motion::start(Manner::Finishes, || ()).unwrap_or_else(|e| panic!("{e}"));
    println!("{:>8}  {:<34}{:>9}{:>9}", "strands", "touch", "median", "worst");
    for strands in [300, 1000] {
        type Touch = fn(&mut Scene, usize);
        let touches: [(&str, Touch); 5] = [
            ("a vector", |scene, n| scene.field.force[1].vector.y = n as f32),
            ("a border", |scene, n| scene.field.force[1].through = 20 + n as u32 % 10),
            ("settling", |scene, n| scene.free.settle = nabiki::Profile::Even((20.0 + n as f32).into())),
            ("the frames", |scene, n| scene.motion.frames = 100 - n as u32 % 2),
            ("the length of the hair", |scene, n| {
                if let nabiki_scene::scene::HairSource::Grown(grown) = &mut scene.hair.source {
                    grown.style.length.top = 17.0 + n as f32 / TOUCHES as f32;
                }
            }),
        ];
        let first = Instant::now();
        moved(&mut motion, scene, strands);
        println!("{strands:>8}  {:<34}{:>9}", "the scene, opened", milliseconds(first.elapsed()));
        let alone = alone(scene, strands);
        println!("{strands:>8}  {:<34}{:>9}", "the motion alone, without a window", milliseconds(alone));
        for (name, touch) in touches {
            let mut times: Vec<Duration> = (0..TOUCHES)
                .map(|n| {
                    let mut changed = scene.clone();
                    touch(&mut changed, n);
                    let start = Instant::now();
                    moved(&mut motion, &changed, strands);
                    start.elapsed()
                })
                .collect();
            times.sort();
            let (median, worst) = (times[TOUCHES / 2], times[TOUCHES - 1]);
            println!("{strands:>8}  {name:<34}{:>9}{:>9}", milliseconds(median), milliseconds(worst));
        }
    }
}

/// What the method itself takes for all frames, in the same run: the median of as many plays.
fn alone(scene: &Scene, strands: usize) -> Duration {
    let built = scene.clone().build(Shown::AtMost(strands)).unwrap_or_else(|e| panic!("{e}"));
    let mut timeline = built.timeline().unwrap_or_else(|e| panic!("{e}"));
    let mut film = vec![glam::Vec3::ZERO; built.strands().points().len() * (built.frames() as usize + 1)];
    let mut times: Vec<Duration> = (0..TOUCHES)
        .map(|_| {
            let start = Instant::now();
            timeline.play_into(&mut film);
            start.elapsed()
        })
        .collect();
    times.sort();
    times[TOUCHES / 2]
}

fn moved(motion: &mut Motion, scene: &Scene, strands: usize) {
    motion.ask(scene.clone(), strands, false);
    motion.wait();
    if let Some(moved) = motion.take()
        && let Err(e) = moved.result
    {
        panic!("{e}");
    }
}

fn milliseconds(time: Duration) -> String {
    format!("{:.2} ms", time.as_secs_f64() * 1000.0)
}
