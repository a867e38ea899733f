//! How long a scene's motion takes by itself, for `tests/python/speed.py`: frames SCENE [KEY=VALUE ...] prints seconds a
//! frame.

use std::hint::black_box;
use std::time::Instant;

use nabiki_scene::frames::{FrameSource, Simulated};
use nabiki_scene::{Result, Scene, Shown};

fn main() -> Result<()> {
    let mut words = std::env::args().skip(1);
    let scene = words.next().unwrap_or_else(|| "scenes/gust.toml".to_owned());
    let settings: Vec<(String, String)> =
        words.filter_map(|word| word.split_once('=').map(|(key, value)| (key.to_owned(), value.to_owned()))).collect();
    let built = Scene::load(scene.as_ref(), &settings)?.build(Shown::All)?;
    let mut frames = Simulated::new(&built)?;
    let begun = Instant::now();
    for n in 0..=built.frames() {
        black_box(frames.frame(n)?.points());
    }
    println!("{}", begun.elapsed().as_secs_f64() / f64::from(built.frames() + 1));
    Ok(())
}
