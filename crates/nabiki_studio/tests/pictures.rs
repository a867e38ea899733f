//! What the window looks like, where there is a graphics adapter, a software one included: against pictures that were looked
//! at, and against the final renderer.
//!
//!     cargo test -p nabiki_studio --test pictures
//!
//! With NABIKI_PICTURES=write the pictures beside this file are written anew, and whole into the temporary folder, to be looked
//! at before they are kept. Those kept are a quarter of the window's size: enough to see that something moved.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use eframe::egui::{Event, Key, Modifiers, PointerButton, Rect, Vec2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use egui_kittest::wgpu::WgpuTestRenderer;
use image::RgbaImage;
use image::imageops::{FilterType, resize};
use nabiki_studio::app::App;
use nabiki_studio::command::Command;
use nabiki_view::Gpu;

#[path = "pictures/patches.rs"]
mod patches;

/// A kept picture is as much smaller than the window.
const SMALLER: u32 = 4;
/// Largest mean difference to a kept picture, of 255: what fonts and gradients may differ by between drivers.
const MEAN: f64 = 1.5;
/// A pixel differs by more than this where something else is drawn, of 255.
const OTHER: i32 = 40;
/// Largest share of such pixels: the numbers of the status line, which say how long things took.
const SHARE: f64 = 0.004;
/// Largest mean difference between the view and the final picture that fades in over it, of 255.
const JUMP: f64 = 6.4;

/// Most stops by which any patch of the view is brighter or darker than in the finished picture, and all in the mean.
/// What is left is where a thousand strands bundle otherwise than all of them, most where a tail fans out in the wind (0.26 in the mean),
/// and shadows finer than a cell of the volume.
const WORST_STOPS: f32 = 2.6;
const MEAN_STOPS: f32 = 0.3;

/// At rest and in the wind.
const PATCHES: [patches::Case; 8] = [
    patches::Case { scene: "gust.toml", frame: 0, strands: 1000, azimuth: None, most: 0.8 },
    patches::Case { scene: "gust.toml", frame: 45, strands: 1000, azimuth: None, most: 1.15 },
    patches::Case { scene: "ponytail.toml", frame: 0, strands: 1000, azimuth: None, most: 1.05 },
    patches::Case { scene: "ponytail.toml", frame: 30, strands: 1000, azimuth: None, most: 1.4 },
    patches::Case { scene: "curls.toml", frame: 0, strands: 1000, azimuth: None, most: 1.1 },
    patches::Case { scene: "curls.toml", frame: 40, strands: 1000, azimuth: None, most: 1.05 },
    patches::Case { scene: "bob.toml", frame: 0, strands: 1000, azimuth: None, most: 0.8 },
    patches::Case { scene: "bob.toml", frame: 24, strands: 1000, azimuth: None, most: 1.1 },
];

type Window = Harness<'static, App>;

/// What a person does, and how large the window is then.
struct Case {
    name: &'static str,
    scene: &'static str,
    size: [f32; 2],
    points_to_pixels: f32,
    act: fn(&mut Window),
}

const CASES: [Case; 10] = [
    Case {
        name: "gust",
        scene: "gust.toml",
        size: [1280.0, 720.0],
        points_to_pixels: 1.0,
        act: |window| {
            go(window, 45);
            click(window, "Interval 1");
        },
    },
    Case {
        name: "compared",
        scene: "gust.toml",
        size: [1280.0, 720.0],
        points_to_pixels: 1.0,
        act: |window| {
            go(window, 45);
            window.key_press(Key::K);
            window.step();
            let session = window.state_mut().session_mut();
            let phase = nabiki_studio::document::Phase::Done;
            session.apply(Command::Vector { interval: 1, vector: [-600.0, 120.0, 80.0].into(), phase });
            let calm = Some(toml::Value::Float(60.0));
            session.apply(Command::Set { key: "free.settle".to_owned(), value: calm, phase });
            settle(window);
            window.key_press(Key::X);
            window.step();
            settle(window);
        },
    },
    Case {
        name: "painted",
        scene: "gust.toml",
        size: [1280.0, 720.0],
        points_to_pixels: 1.0,
        act: |window| {
            window.key_press(Key::B);
            window.step();
            stroke(window, &[vec2(0.46, 0.2), vec2(0.52, 0.24), vec2(0.56, 0.32)]);
            let at = window.get_by_label("View of the hair").rect();
            window.hover_at(at.min + at.size() * vec2(0.6, 0.36));
            settle(window);
        },
    },
    Case {
        name: "combed",
        scene: "gust.toml",
        size: [1280.0, 720.0],
        points_to_pixels: 1.0,
        act: |window| {
            go(window, 45);
            window.key_press(Key::H);
            window.step();
            stroke(window, &[vec2(0.3, 0.52), vec2(0.3, 0.7), vec2(0.36, 0.88)]);
            settle(window);
        },
    },
    Case {
        name: "many_tracks",
        scene: "storm.toml",
        size: [1280.0, 720.0],
        points_to_pixels: 1.0,
        act: |window| {
            for table in ["fan[0]", "vortex[0]", "point[0]"] {
                let key = table.to_owned();
                let groups = nabiki_studio::settings::Page::ALL.into_iter().flat_map(|page| page.groups());
                let fresh = groups.into_iter().find(|group| table.starts_with(group.table)).and_then(|g| g.fresh());
                let phase = nabiki_studio::document::Phase::Done;
                window.state_mut().session_mut().apply(Command::Set { key, value: fresh, phase });
            }
            settle(window);
        },
    },
    Case {
        name: "style",
        scene: "curls.toml",
        size: [1440.0, 900.0],
        points_to_pixels: 1.0,
        act: |window| click(window, "Style"),
    },
    Case {
        name: "double",
        scene: "ponytail.toml",
        size: [720.0, 450.0],
        points_to_pixels: 2.0,
        act: |window| go(window, 30),
    },
    Case {
        name: "palette",
        scene: "paper/gust.toml",
        size: [1280.0, 720.0],
        points_to_pixels: 1.0,
        act: |window| {
            window.key_press_modifiers(Modifiers::COMMAND, Key::P);
            window.step();
            settle(window);
        },
    },
    Case {
        name: "preferences",
        scene: "bob.toml",
        size: [1280.0, 720.0],
        points_to_pixels: 1.0,
        act: |window| {
            window.key_press_modifiers(Modifiers::COMMAND, Key::Comma);
            window.step();
            settle(window);
        },
    },
    Case {
        name: "large",
        scene: "side_wind.toml",
        size: [3840.0, 2160.0],
        points_to_pixels: 1.0,
        act: |window| {
            go(window, 40);
            click(window, "Picture");
        },
    },
];

fn main() {
    let chosen: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with('-')).collect();
    let is_chosen = |name: &str| chosen.is_empty() || chosen.iter().any(|part| name.contains(part.as_str()));
    type Test = Box<dyn Fn() -> Result<(), String>>;
    let as_kept = CASES.iter().map(|case| (format!("looks_as_kept_{}", case.name), Box::new(|| as_kept(case)) as Test));
    let jump: (String, Test) = ("the_final_picture_fades_in_without_a_jump".to_owned(), Box::new(without_a_jump));
    let as_bright: (String, Test) =
        ("every_patch_of_the_view_is_as_bright_as_in_the_finished_picture".to_owned(), Box::new(as_bright_everywhere));
    let tests: Vec<(String, Test)> = as_kept.chain([jump, as_bright]).filter(|(name, _)| is_chosen(name)).collect();
    println!("\nrunning {} tests", tests.len());
    let is_there = has_adapter();
    let (mut passed, mut failed) = (0, 0);
    for (name, test) in &tests {
        match is_there.then(test) {
            None => {
                println!("test {name} ... ignored, no graphics adapter draws the view (Debian: mesa-vulkan-drivers)")
            }
            Some(Ok(())) => {
                println!("test {name} ... ok");
                passed += 1;
            }
            Some(Err(why)) => {
                println!("test {name} ... FAILED\n    {why}");
                failed += 1;
            }
        }
    }
    let word = if failed == 0 { "ok" } else { "FAILED" };
    let ignored = tests.len() - passed - failed;
    println!(
        "\ntest result: {word}. {passed} passed; {failed} failed; {ignored} ignored; 0 measured; 0 filtered out\n"
    );
    std::process::exit(i32::from(failed > 0));
}

/// Whether anything can draw the window and its view here. The harness panics where nothing can.
fn has_adapter() -> bool {
    if Gpu::headless().is_err() {
        return false;
    }
    let hook = std::panic::take_hook();
    std::panic::set_hook(Box::new(|_| ()));
    let found = std::panic::catch_unwind(WgpuTestRenderer::new).is_ok();
    std::panic::set_hook(hook);
    found
}

fn open(scene: &str, size: Vec2, points_to_pixels: f32, preferences: &str) -> (Window, tempfile::TempDir) {
    let config = tempfile::tempdir().unwrap_or_else(|e| panic!("{e}"));
    let text = format!("welcomed = true\n{preferences}");
    std::fs::write(config.path().join("studio.toml"), text).unwrap_or_else(|e| panic!("{e}"));
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes").join(scene);
    let folder = config.path().to_owned();
    let builder = Harness::builder().with_size(size).with_pixels_per_point(points_to_pixels).wgpu();
    let mut window = builder
        .build_eframe(move |cc| App::new(cc, Some(folder), Some(scene)).unwrap_or_else(|e| panic!("no thread: {e}")));
    settle(&mut window);
    assert_eq!(window.state().session().words(), [], "what is remembered is not as this test wrote it");
    (window, config)
}

fn settle(window: &mut Window) {
    for _ in 0..3 {
        window.state_mut().session_mut().wait();
        window.step();
    }
}

fn go(window: &mut Window, frame: u32) {
    window.state_mut().session_mut().apply(Command::Go(frame));
    settle(window);
}

fn click(window: &mut Window, label: &str) {
    if let Some(found) = window.query_all_by_label(label).last() {
        found.click();
    }
    window.step();
    settle(window);
}

/// Drags over the view: places as parts of its size.
fn stroke(window: &mut Window, way: &[Vec2]) {
    let view = window.get_by_label("View of the hair").rect();
    let at = |part: &Vec2| view.min + view.size() * *part;
    let (Some(first), Some(last)) = (way.first(), way.last()) else { return };
    let button = |pos, pressed| Event::PointerButton {
        pos,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    window.hover_at(at(first));
    window.step();
    window.event(button(at(first), true));
    window.step();
    for part in way {
        window.hover_at(at(part));
        window.step();
    }
    window.event(button(at(last), false));
    window.step();
    settle(window);
}

fn as_kept(case: &Case) -> Result<(), String> {
    let (mut window, _config) =
        open(case.scene, Vec2::from(case.size), case.points_to_pixels, "strands = 1000\nfinal_picture = false\n");
    (case.act)(&mut window);
    let picture = window.render()?;
    let small = resize(&picture, picture.width() / SMALLER, picture.height() / SMALLER, FilterType::Triangle);
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/pictures").join(format!("{}.png", case.name));
    if std::env::var_os("NABIKI_PICTURES").is_some_and(|wish| wish == "write") {
        println!("    see {}", beside(&file, &picture)?.display());
        return image::DynamicImage::from(small).to_rgb8().save(&file).map_err(|e| format!("{}: {e}", file.display()));
    }
    let kept = image::open(&file).map_err(|e| format!("{}: {e}", file.display()))?.to_rgba8();
    if kept.dimensions() != small.dimensions() {
        return Err(format!("{:?} pixels, where {:?} are kept", small.dimensions(), kept.dimensions()));
    }
    let (mean, share) = difference(&kept, &small);
    if mean <= MEAN && share <= SHARE {
        return Ok(());
    }
    let seen = beside(&file, &small)?;
    Err(format!(
        "differs from {} by {mean:.2} in the mean, and {:.2} % of it is something else; see {}",
        file.display(),
        100.0 * share,
        seen.display()
    ))
}

/// Mean difference of a channel, and the share of pixels that show something else.
fn difference(a: &RgbaImage, b: &RgbaImage) -> (f64, f64) {
    let (mut sum, mut other) = (0_i64, 0_u64);
    for (a, b) in a.pixels().zip(b.pixels()) {
        let off = [0, 1, 2].map(|c| (i32::from(a.0[c]) - i32::from(b.0[c])).abs());
        sum += i64::from(off.iter().sum::<i32>());
        other += u64::from(off.into_iter().max() > Some(OTHER));
    }
    let pixels = f64::from(a.width()) * f64::from(a.height());
    (sum as f64 / (3.0 * pixels), other as f64 / pixels)
}

/// Where a picture that is not as kept can be looked at.
fn beside(kept: &Path, picture: &RgbaImage) -> Result<PathBuf, String> {
    let file = std::env::temp_dir().join(format!("nabiki_{}", kept.file_name().unwrap_or_default().display()));
    picture.save(&file).map_err(|e| format!("{}: {e}", file.display()))?;
    Ok(file)
}

/// The view is lit as the final renderer lights: where the hand rests and all strands fade in, the picture changes little.
fn without_a_jump() -> Result<(), String> {
    let (mut window, _config) = open("gust.toml", vec2(800.0, 600.0), 1.0, "strands = 20000\narrows = false\n");
    go(&mut window, 40);
    let of_view = window.get_by_label("View of the hair").rect();
    let before = cut(&window.render()?, of_view);
    // The picture is made on a thread and fades in over steps of the harness's clock; the longest that either takes here.
    let clock = Instant::now();
    let mut after = before.clone();
    while clock.elapsed() < Duration::from_secs(60) {
        window.step();
        let now = cut(&window.render()?, of_view);
        let has_come = now != before;
        let stands = has_come && now == after;
        after = now;
        if stands {
            break;
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    if after == before {
        return Err("the final picture never came".to_owned());
    }
    let (mean, _) = difference(&before, &after);
    println!("    the view and the final picture differ by {mean:.2} of 255 in the mean");
    if mean <= JUMP {
        return Ok(());
    }
    let (view, last) = (beside(Path::new("view.png"), &before)?, beside(Path::new("final.png"), &after)?);
    Err(format!("the picture jumps by {mean:.2} of 255 in the mean; see {} and {}", view.display(), last.display()))
}

/// No part of the view is much brighter or darker than it will be.
fn as_bright_everywhere() -> Result<(), String> {
    let mut wrong = Vec::new();
    for case in &PATCHES {
        let found = patches::compare(case)?;
        let Some(worst) = found.first() else { return Err(format!("{case:?}: nothing is seen")) };
        let off = |share: f32| found[(share * found.len() as f32) as usize].stops.abs();
        let mean = found.iter().map(|patch| patch.stops).sum::<f32>() / found.len() as f32;
        println!(
            "    {} {}, {} strands: {:+.2} stops at worst at {:?} (view {:?}, finished {:?}), {:.2} for 95 % of {} patches, {mean:+.2} in the mean",
            case.scene,
            case.frame,
            case.strands,
            worst.stops,
            worst.at,
            patches::shown(worst.view),
            patches::shown(worst.last),
            off(0.05),
            found.len(),
        );
        if mean.abs() > MEAN_STOPS || off(0.05) > case.most || off(0.0) > WORST_STOPS {
            wrong.push(format!("{} {}: {worst:?}", case.scene, case.frame));
        }
    }
    if wrong.is_empty() { Ok(()) } else { Err(wrong.join("; ")) }
}

fn cut(picture: &RgbaImage, rect: Rect) -> RgbaImage {
    let (low, size) = (rect.min.round(), rect.size().round());
    image::imageops::crop_imm(picture, low.x as u32, low.y as u32, size.x as u32, size.y as u32).to_image()
}
