//! The view without a window: draws it into a PNG, says how long a frame takes, and draws the final picture beside it.
//!
//!     cargo run --release -p nabiki_studio --example view_picture -- SCENE FRAME STRANDS VIEW.png FINAL.png [AZIMUTH]

use std::error::Error;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use glam::Vec3;
use nabiki_render::output::png;
use nabiki_render::{Bounds, FrameToDraw, Moment, Renderer, ToneMapping};
use nabiki_scene::{Scene, Shown};
use nabiki_studio::take::Take;
use nabiki_studio::view::camera::Orbit;
use nabiki_view::Gpu;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [scene, frame, strands, view_path, final_path, rest @ ..] = &arguments[..] else {
        return Err("SCENE FRAME STRANDS VIEW.png FINAL.png [AZIMUTH]".into());
    };
    let (frame, strands): (u32, usize) = (frame.parse()?, strands.parse()?);
    let size = [1280, 720];
    let mut scene = Scene::load(Path::new(scene), &[])?;
    if let [azimuth] = rest {
        scene.picture.camera.azimuth = azimuth.parse()?;
    }
    scene.picture.size = size;
    let built = Arc::new(scene.build(Shown::AtMost(strands))?);
    let film: Vec<Vec3> = {
        let mut timeline = built.timeline()?;
        let film = timeline.play();
        (0..=built.frames()).flat_map(|n| film.points(n).to_vec()).collect()
    };
    let take = Take { built, film: film.into(), number: 1 };
    let mut bounds = Bounds::default();
    bounds.include_head(&take.built.model.head.mesh, &take.built.model.head.ellipsoid);
    take.film.iter().for_each(|&p| bounds.include(p));
    let picture = &take.built.scene.picture;
    let orbit = Orbit::new(&picture.camera.at(frame as f32 / take.frames() as f32), size, &bounds);
    let view = orbit.view(size, take.pose(frame).position_cm);

    let mut gpu = Gpu::headless()?;
    let bytes = gpu.picture(&take.drawing(frame, &take.bodies(frame), picture, view))?;
    let rgb: Vec<u8> = bytes.chunks(4).flat_map(|p| &p[..3]).copied().collect();
    png::write_rgb8(Path::new(view_path), size, &rgb)?;
    let (clock, busy) = (Instant::now(), busy_ms());
    let mut sent = 0.0;
    let frames = 10;
    for n in 0..frames {
        let clock = Instant::now();
        let frame = n.min(take.frames());
        gpu.draw(&take.drawing(frame, &take.bodies(frame), picture, view));
        sent += clock.elapsed().as_secs_f64() * 1e3;
        gpu.wait()?;
    }
    let ms = |whole: f64| whole / f64::from(frames);
    println!(
        "{} strands: {:.1} ms a frame, {:.1} of them before the card has it; {:.1} ms of all cores together",
        take.strands().len(),
        ms(clock.elapsed().as_secs_f64() * 1e3),
        ms(sent),
        ms(busy_ms() - busy),
    );

    let whole = take.built.scene.clone().build(Shown::All)?;
    let mut timeline = whole.timeline()?;
    let strands = timeline.seek(frame);
    let clock = Instant::now();
    let mut renderer = Renderer::new(picture, &whole.model.head.mesh)?
        .with_face(&whole.model.head)
        .with_bodies(whole.drawn_bodies())?;
    let bodies = whole.drawn_poses(frame);
    let now = Moment { strands, pose: take.pose(frame), view, bodies: &bodies };
    let drawn = renderer.draw(&FrameToDraw { now, before: None })?;
    println!("the final picture, {} strands: {:.0} ms", strands.len(), clock.elapsed().as_secs_f64() * 1e3);
    png::write(Path::new(final_path), &drawn, &ToneMapping::new(picture), png::Depth::Eight)?;
    Ok(())
}

/// Time that all threads of this process have been at work (ms), where the system tells: on a shared machine it says more than
/// the clock on the wall.
fn busy_ms() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    // In hundredths of a second; the name of the program, in parentheses, may hold anything.
    let after_name = stat.rsplit(')').next().unwrap_or_default();
    after_name.split_whitespace().skip(11).take(2).filter_map(|ticks| ticks.parse::<f64>().ok()).sum::<f64>() * 10.0
}
