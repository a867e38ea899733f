//! The window.

use std::path::PathBuf;
use std::process::ExitCode;

use eframe::egui;
use nabiki_io::screen::OneLine;
use nabiki_studio::app::App;
use nabiki_studio::icon;
use nabiki_studio::preferences::{self, Preferences};

const HELP: &str = "\
The studio of Nabiki: try out hair and wind in a window.

Usage: nabiki-studio [SCENE.toml]

Without SCENE.toml, the studio opens the last scene, or a built-in gust at the first start.

  -h, --help       this text
  -V, --version    the version
";

fn main() -> ExitCode {
    let mut scene = None;
    for argument in std::env::args_os().skip(1) {
        match argument.to_str() {
            Some("-h" | "--help") => {
                print!("{HELP}");
                return ExitCode::SUCCESS;
            }
            Some("-V" | "--version") => {
                println!("nabiki-studio {}", env!("CARGO_PKG_VERSION"));
                return ExitCode::SUCCESS;
            }
            Some(option) if option.starts_with('-') && option.len() > 1 => {
                eprintln!("nabiki-studio: {}: no such option; see --help", OneLine(option));
                return ExitCode::FAILURE;
            }
            _ if scene.is_some() => {
                let second = OneLine(argument.display());
                eprintln!("nabiki-studio: {second}: the studio opens one scene; start it again for another");
                return ExitCode::FAILURE;
            }
            _ => scene = Some(PathBuf::from(argument)),
        }
    }
    // Before anything is drawn: threads that the system does not give would end the window later.
    let fewer = "set RAYON_NUM_THREADS to a lower number";
    if let Err(refused) = nabiki_scene::threads::made(None, fewer, rayon::ThreadPoolBuilder::build_global) {
        eprintln!("nabiki-studio: {refused}");
        return ExitCode::FAILURE;
    }
    match run(scene) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            let what = match error {
                // Their own words are about their source.
                eframe::Error::WinitEventLoop(_) | eframe::Error::Winit(_) => "no window can be opened here".to_owned(),
                eframe::Error::Wgpu(_) => "no graphics driver can draw a window here".to_owned(),
                other => other.to_string(),
            };
            eprintln!(
                "nabiki-studio: {what}; a window needs a display and a graphics driver (Vulkan, Metal, DirectX 12)"
            );
            ExitCode::FAILURE
        }
    }
}

fn run(scene: Option<PathBuf>) -> eframe::Result {
    let folder = preferences::folder();
    let remembered = folder.as_deref().map_or_else(Preferences::default, |folder| Preferences::load(folder).0);
    let viewport = egui::ViewportBuilder::default()
        .with_title("Nabiki")
        .with_app_id("nabiki-studio")
        .with_icon(egui::IconData { rgba: icon::pixels(), width: icon::SIDE, height: icon::SIDE })
        .with_inner_size(remembered.window)
        .with_min_inner_size([640.0, 420.0])
        .with_maximized(remembered.maximised)
        .with_drag_and_drop(true);
    let options = eframe::NativeOptions { viewport, ..eframe::NativeOptions::default() };
    eframe::run_native("Nabiki", options, Box::new(move |cc| Ok(Box::new(App::new(cc, folder, scene)?))))
}
