//! The view beside the finished picture, patch by patch, in light: what the view shows is what the picture will be.

use std::path::Path;
use std::sync::Arc;

use glam::Vec3;
use nabiki_render::settings::{Background, ToneCurve};
use nabiki_render::tone_mapping::linear_from_srgb;
use nabiki_render::{Bounds, FrameToDraw, Moment, Picture, Renderer, View, colour};
use nabiki_scene::scene::HairSource;
use nabiki_scene::{BuiltScene, Scene, Shown};
use nabiki_studio::take::Take;
use nabiki_studio::view::camera::Orbit;
use nabiki_view::Gpu;

/// Width and height of the pictures (px), and of a patch.
const SIZE: [u32; 2] = [640, 480];
const PATCH: u32 = 16;
/// What of a patch hair and skin cover at least, in either picture: where hair streams, the view's fewer strands show more of the ground
/// between them.
const COVERED: f32 = 0.97;
/// Darker than this (luminance in light) no eye tells two stops apart.
const DARK: f32 = 0.004;
/// Stops by which the pictures are darker, so that nothing is cut off at white.
const DARKER: f32 = -2.0;

/// What is compared.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    pub scene: &'static str,
    pub frame: u32,
    pub strands: usize,
    /// From another side than the scene's camera (degrees).
    pub azimuth: Option<f32>,
    /// Most stops by which nineteen of twenty patches are brighter or darker than in the finished picture.
    pub most: f32,
}

/// A patch of both pictures (linear light).
#[derive(Clone, Copy, Debug)]
pub struct Patch {
    pub at: [u32; 2],
    pub view: [f32; 3],
    pub last: [f32; 3],
    /// How much brighter the view is.
    pub stops: f32,
}

/// Both pictures by patches, the one that differs most first.
pub fn compare(case: &Case) -> Result<Vec<Patch>, String> {
    let says = |e: nabiki_scene::Error| e.to_string();
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes").join(case.scene);
    let mut scene = Scene::load(&path, &[]).map_err(|e| e.to_string())?;
    let picture = &mut scene.picture;
    if let Some(azimuth) = case.azimuth {
        (picture.camera.azimuth, picture.camera.to) = (azimuth, None);
    }
    (picture.size, picture.tone_mapping, picture.exposure) = (SIZE, ToneCurve::Linear, DARKER);
    picture.background = Background { top: [0.0; 3], bottom: [0.0; 3], transparent: false };
    // A quarter of the hair, four times as wide, has as much to light and is finished in a third of the time.
    if let HairSource::Grown(hair) = &mut scene.hair.source {
        hair.strands /= 4;
        scene.picture.hair.width *= 4.0;
    }
    let picture = scene.picture.clone();
    let whole = scene.clone().build(Shown::All).map_err(says)?;
    let take = take(scene.build_while(Shown::AtMost(case.strands), &[&whole], &|_| true).map_err(says)?, case.frame)?;
    let mut bounds = Bounds::default();
    bounds.include_head(&take.built.model.head.mesh, &take.built.model.head.ellipsoid);
    take.points(case.frame).iter().for_each(|&p| bounds.include(p));
    let orbit = Orbit::new(&picture.camera.at(case.frame as f32 / take.frames() as f32), SIZE, &bounds);
    let view = orbit.view(SIZE, take.pose(case.frame).position_cm);
    let seen = of_view(&take, &picture, case.frame, view)?;
    let white = Background { top: [1.0; 3], bottom: [1.0; 3], transparent: false };
    let on_white = of_view(&take, &Picture { background: white, ..picture.clone() }, case.frame, view)?;
    let last = finished(&whole, &picture, case.frame, view)?;
    let mut patches = Vec::new();
    for y in (0..SIZE[1]).step_by(PATCH as usize) {
        for x in (0..SIZE[0]).step_by(PATCH as usize) {
            let mean = |of: &[[f32; 4]]| {
                let pixels = (0..PATCH * PATCH).map(|n| (x + n % PATCH, y + n / PATCH));
                let sum = pixels.fold([0.0; 4], |sum: [f32; 4], (x, y)| {
                    let pixel = of[(y * SIZE[0] + x) as usize];
                    std::array::from_fn(|c| sum[c] + pixel[c])
                });
                sum.map(|sum| sum / (PATCH * PATCH) as f32)
            };
            let ([vr, vg, vb, _], [r, g, b, alpha]) = (mean(&seen), mean(&last));
            // What shines through of a ground of 1.
            let through = mean(&on_white)[1] - vg;
            let (view, last) = ([vr, vg, vb], [r, g, b]);
            if alpha.min(1.0 - through) >= COVERED && colour::luminance(last) >= DARK {
                let stops = (colour::luminance(view).max(1e-5) / colour::luminance(last)).log2();
                patches.push(Patch { at: [x, y], view, last, stops });
            }
        }
    }
    if std::env::var_os("NABIKI_PICTURES").is_some() {
        write(case, &seen, &last, &patches);
    }
    patches.sort_by(|a, b| b.stops.abs().total_cmp(&a.stops.abs()));
    Ok(patches)
}

/// As a display would show a colour, 0..255.
pub fn shown(light: [f32; 3]) -> [u8; 3] {
    light.map(|c| (255.0 * nabiki_render::tone_mapping::srgb_from_linear(c.clamp(0.0, 1.0))).round() as u8)
}

/// Both pictures beside one another, and the third what is brighter (red) and darker (blue) in the view, whole at one stop; each patch
/// in a line.
fn write(case: &Case, seen: &[[f32; 4]], last: &[[f32; 4]], patches: &[Patch]) {
    let name = case.scene.replace(['/', '.'], "_");
    let file = std::env::temp_dir().join(format!("nabiki_patches_{name}_{}_{}.png", case.frame, case.strands));
    let [width, height] = SIZE;
    let mut picture = image::RgbImage::from_fn(3 * width, height, |x, y| {
        let of = [seen, last].get((x / width) as usize).copied();
        let [r, g, b, _] = of.map_or([0.02; 4], |of| of[(y * width + x % width) as usize]);
        image::Rgb(shown([r, g, b]))
    });
    for patch in patches {
        let [x, y] = patch.at;
        println!("    {} {}: {:+.2} at {x} {y}", case.scene, case.frame, patch.stops);
        let off = |sign: f32| (0.5 + 0.5 * (sign * patch.stops).clamp(-1.0, 1.0)).powi(2);
        let colour = image::Rgb(shown([off(1.0), 0.25, off(-1.0)]));
        for n in 0..PATCH * PATCH {
            picture.put_pixel(2 * width + x + n % PATCH, y + n / PATCH, colour);
        }
    }
    if picture.save(&file).is_ok() {
        println!("    see {}", file.display());
    }
}

fn take(built: BuiltScene, frame: u32) -> Result<Take, String> {
    let mut timeline = built.timeline().map_err(|e| e.to_string())?;
    let points = timeline.seek(frame).points().to_vec();
    // Of the frames before nobody asks.
    let mut film = vec![Vec3::ZERO; points.len() * frame as usize];
    film.extend(points);
    Ok(Take { built: Arc::new(built), film: film.into(), number: 1 })
}

fn of_view(take: &Take, picture: &Picture, frame: u32, view: View) -> Result<Vec<[f32; 4]>, String> {
    let mut gpu = Gpu::headless()?;
    let bodies = take.bodies(frame);
    let bytes = gpu.picture(&take.drawing(frame, &bodies, picture, view))?;
    let light = |b: u8| linear_from_srgb(f32::from(b) / 255.0) / DARKER.exp2();
    Ok(bytes.chunks_exact(4).map(|p| [light(p[0]), light(p[1]), light(p[2]), 1.0]).collect())
}

fn finished(whole: &BuiltScene, picture: &Picture, frame: u32, view: View) -> Result<Vec<[f32; 4]>, String> {
    let says = |e: nabiki_render::RenderError| e.to_string();
    let mut picture = picture.clone();
    picture.background.transparent = true;
    let mut timeline = whole.timeline().map_err(|e| e.to_string())?;
    let bodies = whole.drawn_poses(frame);
    let now = Moment { strands: timeline.seek(frame), pose: whole.pose(frame), view, bodies: &bodies };
    let renderer = Renderer::new(&picture, &whole.model.head.mesh).map_err(says)?.with_face(&whole.model.head);
    let mut renderer = renderer.with_bodies(whole.drawn_bodies()).map_err(says)?;
    Ok(renderer.draw(&FrameToDraw { now, before: None }).map_err(says)?.rgba)
}
