//! How long the window takes to show a frame: what its panels take, and what drawing it takes, by whatever adapter there is.
//!
//!     cargo bench -p nabiki_studio --bench playing
//!
//! The gust, every other frame of it in turn, in a window of 1920 x 1080 without a display. Pictures are read back and taken apart,
//! which a window on a screen need not do: the first line is what that takes of an even grey.

use std::path::Path;
use std::time::{Duration, Instant};

use eframe::egui::{Color32, vec2};
use egui_kittest::wgpu::WgpuTestRenderer;
use egui_kittest::{Harness, HarnessBuilder};
use nabiki_studio::app::App;
use nabiki_studio::command::Command;

const FRAMES: u32 = 100;

fn main() {
    let mut grey = builder().build_ui(|ui| _ = ui.painter().rect_filled(ui.ctx().content_rect(), 0.0, Color32::GRAY));
    let mut times = Vec::new();
    for _ in 0..20 {
        grey.step();
        times.push(timed(|| drop(grey.render().unwrap_or_else(|e| panic!("{e}")))));
    }
    println!("{:>8} {:>12} {:>12} {:>12}", "strands", "panels", "drawing", "worst of both");
    println!("{:>8} {:>12} {:>12} {:>12}", "grey", "", milliseconds(median(times)), "");
    for strands in [300, 1000, 10_000, 60_000] {
        let config = tempfile::tempdir().unwrap_or_else(|e| panic!("{e}"));
        let text = format!("welcomed = true\nstrands = {strands}\nfinal_picture = false\n");
        std::fs::write(config.path().join("studio.toml"), text).unwrap_or_else(|e| panic!("{e}"));
        let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/gust.toml");
        let folder = config.path().to_owned();
        let mut window = builder().build_eframe(move |cc| {
            App::new(cc, Some(folder), Some(scene)).unwrap_or_else(|e| panic!("no thread: {e}"))
        });
        for _ in 0..3 {
            window.state_mut().session_mut().wait();
            window.step();
        }
        let (mut panels, mut drawing, mut both) = (Vec::new(), Vec::new(), Vec::new());
        for frame in (0..FRAMES).step_by(2) {
            window.state_mut().session_mut().apply(Command::Go(frame));
            panels.push(timed(|| window.step()));
            drawing.push(timed(|| drop(window.render().unwrap_or_else(|e| panic!("{e}")))));
            both.push(panels[panels.len() - 1] + drawing[drawing.len() - 1]);
        }
        let worst = both.into_iter().max().unwrap_or_default();
        let [panels, drawing, worst] = [median(panels), median(drawing), worst].map(milliseconds);
        println!("{strands:>8} {panels:>12} {drawing:>12} {worst:>12}");
    }
}

fn builder<T>() -> HarnessBuilder<T> {
    Harness::builder().with_size(vec2(1920.0, 1080.0)).renderer(WgpuTestRenderer::new())
}

fn timed(act: impl FnOnce()) -> Duration {
    let start = Instant::now();
    act();
    start.elapsed()
}

fn median(mut times: Vec<Duration>) -> Duration {
    times.sort();
    times[times.len() / 2]
}

fn milliseconds(time: Duration) -> String {
    format!("{:.1} ms", 1e3 * time.as_secs_f64())
}
