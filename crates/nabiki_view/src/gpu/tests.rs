//! Pictures by whatever adapter there is. Without one they are skipped, and say so.

use std::sync::Arc;

use glam::{Vec2, Vec3};
use nabiki_render::Bounds;
use nabiki_render::settings::Camera;
use nabiki_scene::{BuiltScene, Scene, Shown};

use super::*;

const SIZE: [u32; 2] = [320, 240];

/// A head with some hair.
fn built(strands: usize) -> BuiltScene {
    let text = format!("[hair]\nstrands = {strands}\n[motion]\nframes = 1\nform = \"free\"\n");
    let scene = Scene::parse(&text, "a.toml".as_ref(), &[]).unwrap();
    scene.build(Shown::All).unwrap()
}

fn drawing<'a>(built: &'a BuiltScene, picture: &'a Picture, lines: &'a [Line]) -> Drawing<'a> {
    let strands = built.strands();
    Drawing {
        skin: None,
        strands,
        points: strands.points(),
        share: 1.0,
        head: &built.model.head,
        pose: Pose::STILL,
        bodies: &[],
        picture,
        view: view(),
        lines,
        most_hairs: MOST_HAIRS,
    }
}

fn view() -> View {
    let camera =
        Camera { azimuth: 50.0, distance: Some(110.0), target: Some(Vec3::new(0.0, -2.0, 0.0)), ..Camera::default() };
    View::new(&camera, SIZE, &Bounds::default())
}

fn gpu() -> Option<Gpu> {
    let gpu = Gpu::headless();
    if let Err(why) = &gpu {
        println!("SKIPPED: {why}");
    }
    gpu.ok()
}

fn drawn(gpu: &mut Gpu, built: &BuiltScene, picture: &Picture, lines: &[Line]) -> Vec<[u8; 4]> {
    let bytes = gpu.picture(&drawing(built, picture, lines)).unwrap();
    bytes.chunks_exact(4).map(|p| [p[0], p[1], p[2], p[3]]).collect()
}

/// The hair alone, black on a ground that it is not, so many centimetres thick everywhere.
fn bare(width: f32) -> Picture {
    let mut picture = Picture { size: SIZE, ..Picture::default() };
    (picture.hair.width, picture.hair.tip) = (width, 1.0);
    (picture.lights, picture.sky.strength) = (Vec::new(), 0.0);
    picture.tone_mapping = nabiki_render::settings::ToneCurve::Linear;
    picture.head.visible = false;
    (picture.background.top, picture.background.bottom) = ([0.0, 0.0, 1.0], [0.0, 0.0, 1.0]);
    picture
}

#[test]
fn hair_shows_where_strands_are_and_nothing_elsewhere() {
    let Some(mut gpu) = gpu() else { return };
    let built = built(24);
    let picture = bare(0.25);
    let pixels = drawn(&mut gpu, &built, &picture, &[]);
    let ground = pixels[0];
    assert_eq!(ground, [0, 0, 255, 255]);
    let view = view();
    let at = |p: Vec3| view.project(p).truncate();
    let lines: Vec<[Vec2; 2]> =
        built.strands().iter().flat_map(|strand| strand.windows(2).map(|w| [at(w[0]), at(w[1])])).collect();
    // Segments that end within the picture: their middles are covered, by a ribbon a pixel wide.
    let inside = |p: Vec2| p.x >= 1.0 && p.y >= 1.0 && p.x < SIZE[0] as f32 - 1.0 && p.y < SIZE[1] as f32 - 1.0;
    let (mut seen, mut of) = (0, 0);
    for [a, b] in &lines {
        let middle = (*a + *b) / 2.0;
        if inside(*a) && inside(*b) {
            of += 1;
            let (x, y) = (middle.x as i32, middle.y as i32);
            let near = (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (x + dx, y + dy)));
            seen += usize::from(near.into_iter().any(|(x, y)| pixels[(y * SIZE[0] as i32 + x) as usize] != ground));
        }
    }
    assert!(of > 200 && seen == of, "{seen} of {of}");
    for (i, pixel) in pixels.iter().enumerate() {
        let p = Vec2::new((i as u32 % SIZE[0]) as f32 + 0.5, (i as u32 / SIZE[0]) as f32 + 0.5);
        let apart = |[a, b]: &[Vec2; 2]| {
            let t = ((p - *a).dot(*b - *a) / (*b - *a).length_squared().max(1e-6)).clamp(0.0, 1.0);
            a.lerp(*b, t).distance(p)
        };
        let nearest = lines.iter().map(apart).fold(f32::INFINITY, f32::min);
        // Half of the ribbon, a pixel's own half diagonal, and a curve's arc over its chord.
        assert!(nearest < 2.5 || *pixel == ground, "{p}: {pixel:?}, {nearest} px from hair");
    }
}

#[test]
fn the_same_input_gives_the_same_picture_whatever_was_drawn_before() {
    let Some(mut gpu) = gpu() else { return };
    let (few, many) = (built(24), built(200));
    let picture = Picture { size: SIZE, ..Picture::default() };
    let first = drawn(&mut gpu, &many, &picture, &[]);
    drawn(&mut gpu, &few, &bare(0.25), &[]);
    assert!(first == drawn(&mut gpu, &many, &picture, &[]));
    assert!(first != drawn(&mut gpu, &few, &picture, &[]));
}

#[test]
fn the_head_looks_as_in_the_renderers_picture() {
    let Some(mut gpu) = gpu() else { return };
    let mut built = built(24);
    Arc::make_mut(&mut built.groom).hair.strands = Strands::default();
    let mut picture = Picture { size: SIZE, ..Picture::default() };
    // What the view leaves out: the head's own fine shadows, for which it has its ellipsoid.
    picture.shadows = false;
    picture.sky.occlusion = false;
    let pixels = drawn(&mut gpu, &built, &picture, &[]);
    let mut renderer =
        nabiki_render::Renderer::new(&picture, &built.model.head.mesh).unwrap().with_face(&built.model.head);
    let strands = Strands::default();
    let frame = renderer.draw(&nabiki_render::FrameToDraw::at_rest(&strands, view())).unwrap();
    let theirs = nabiki_render::ToneMapping::new(&picture).rgba8(&frame);
    let apart = |(mine, theirs): (&[u8; 4], &[u8])| (0..3).map(|c| mine[c].abs_diff(theirs[c])).max().unwrap_or(0);
    let differ = pixels.iter().zip(theirs.chunks_exact(4)).filter(|pair| apart((pair.0, pair.1)) > 24).count();
    // Edges are smoothed otherwise, and the ellipsoid shades a rim of the neck.
    assert!(differ * 25 < pixels.len(), "{differ} of {} pixels differ by more than 24 of 255", pixels.len());
}

#[test]
fn lines_are_hidden_behind_the_head_and_seen_before_it() {
    let Some(mut gpu) = gpu() else { return };
    let built = built(24);
    let picture = Picture { size: SIZE, ..Picture::default() };
    let view = view();
    let line = |depth: f32| {
        let middle = Vec3::new(0.0, 0.0, 0.0) - view.forward * depth;
        let colour = [0.0, 4.0, 0.0, 1.0];
        let (a, b) = ((middle - 2.0 * view.right).to_array(), (middle + 2.0 * view.right).to_array());
        Line { a, width: 4.0, b, pad: 0.0, a_colour: colour, b_colour: colour }
    };
    let without = drawn(&mut gpu, &built, &picture, &[]);
    assert!(without == drawn(&mut gpu, &built, &picture, &[line(-30.0)]));
    let before = drawn(&mut gpu, &built, &picture, &[line(30.0)]);
    let green = before.iter().zip(&without).filter(|(a, b)| a != b && a[1] > 200 && a[0] < 60).count();
    assert!(green > 50, "{green}");
}

#[test]
fn a_lost_device_is_said_in_words() {
    let Some(mut gpu) = gpu() else { return };
    let built = built(24);
    let picture = bare(0.25);
    drawn(&mut gpu, &built, &picture, &[]);
    assert_eq!(gpu.failure(), None);
    gpu.device.destroy();
    assert!(gpu.picture(&drawing(&built, &picture, &[])).is_err());
    assert!(gpu.failure().is_some());
}

#[test]
fn hair_thinner_than_a_pixel_covers_its_share() {
    let Some(mut gpu) = gpu() else { return };
    let built = built(60);
    // A centimetre is 4.7 pixels.
    let mut covered = |width: f32| {
        let pixels = drawn(&mut gpu, &built, &bare(width), &[]);
        let linear = |blue: u8| nabiki_render::tone_mapping::linear_from_srgb(f32::from(blue) / 255.0);
        pixels.iter().map(|p| 1.0 - linear(p[2])).sum::<f32>()
    };
    let [whole, half, quarter] = [0.1, 0.05, 0.025].map(&mut covered);
    // Each of 60 strands takes a whole number of four samples, rounded up or down by chance: a tenth of the sum, and where hairs
    // lie over hairs less than twice as much is covered by twice as much.
    for ratio in [whole / half, half / quarter] {
        assert!((1.6..2.3).contains(&ratio), "{whole} {half} {quarter}");
    }
}
