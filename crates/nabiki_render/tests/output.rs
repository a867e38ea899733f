//! What is written, as others would read it; and what bad input gets.

use glam::Vec3;
use nabiki::{Mesh, Pose, Strands};
use nabiki_render::output::field_plot;
use nabiki_render::output::png::{self, Depth};
use nabiki_render::settings::{Antialiasing, Background};
use nabiki_render::{
    Bounds, ContactSheet, ForceArrow, FrameToDraw, Moment, Movie, Picture, Renderer, ToneMapping, View,
};

fn scene() -> (Strands, Mesh) {
    let mut strands = Strands::default();
    for i in 0..200 {
        let angle = i as f32 * 0.1;
        let root = Vec3::new(8.0 * angle.cos(), 4.0, 8.0 * angle.sin());
        strands.push((0..10).map(|j| root + Vec3::new(0.02, -1.0, 0.1 * angle.sin()) * j as f32));
    }
    let corners = [Vec3::X, Vec3::Z, -Vec3::X, -Vec3::Z].map(|c| 7.0 * c);
    let positions = [&[7.0 * Vec3::Y, -7.0 * Vec3::Y][..], &corners].concat();
    let triangles = (0..4).flat_map(|i| [[0, 2 + (i + 1) % 4, 2 + i], [1, 2 + i, 2 + (i + 1) % 4]]).collect();
    (strands, Mesh { positions, triangles, ..Mesh::default() })
}

fn setting(picture: &Picture) -> (Renderer, Strands, View) {
    let (strands, head) = scene();
    let mut bounds = Bounds::default();
    bounds.include_strands(&strands);
    let view = View::new(&picture.camera, picture.size, &bounds);
    (Renderer::new(picture, &head).unwrap(), strands, view)
}

fn small() -> Picture {
    Picture { size: [96, 64], ..Picture::default() }
}

#[test]
fn png_files_hold_the_display_values() {
    let picture = Picture { background: Background { transparent: true, ..Background::default() }, ..small() };
    let (mut renderer, strands, view) = setting(&picture);
    let frame = renderer.draw(&FrameToDraw::at_rest(&strands, view)).unwrap();
    let tone_mapping = ToneMapping::new(&picture);
    let folder = tempfile::tempdir().unwrap();
    for (name, depth) in [("8.png", Depth::Eight), ("16.png", Depth::Sixteen)] {
        let path = folder.path().join(name);
        png::write(&path, &frame, &tone_mapping, depth).unwrap();
        let read = image::open(&path).unwrap();
        match depth {
            Depth::Eight => {
                assert_eq!(read.into_rgba8().into_raw(), tone_mapping.rgba8(&frame));
                assert_eq!(std::fs::read(&path).unwrap(), png::bytes(&frame, &tone_mapping).unwrap());
            }
            Depth::Sixteen => assert_eq!(read.into_rgba16().into_raw(), tone_mapping.rgba16(&frame)),
        }
    }
}

#[test]
fn openexr_files_hold_the_frame_to_the_bit() {
    use exr::prelude::read_first_flat_layer_from_file;
    use nabiki_render::frame::Layer;
    let background = Background { transparent: true, ..Background::default() };
    let picture = Picture { background, shutter: 1.0, ..small() };
    let (renderer, strands, view) = setting(&picture);
    let mut moved = strands.clone();
    moved.points_mut().iter_mut().for_each(|p| *p += Vec3::new(0.5, 0.3, 0.0));
    let moment = |strands| Moment { strands, pose: Pose::STILL, view, bodies: &[] };
    let blurred = FrameToDraw { now: moment(&moved), before: Some(moment(&strands)) };
    let frame = renderer.with_layers().draw(&blurred).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("frame.exr");
    nabiki_render::output::exr::write(&path, &frame).unwrap();
    assert!(nabiki_render::output::exr::bytes(&frame).unwrap() == std::fs::read(&path).unwrap());
    let read = read_first_flat_layer_from_file(&path).unwrap();
    let channel = |name: &str| -> Vec<f32> {
        let found = read.layer_data.channel_data.list.iter().find(|c| c.name.eq(name));
        found.unwrap_or_else(|| panic!("no channel {name}")).sample_data.values_as_f32().collect()
    };
    for (i, name) in ["R", "G", "B", "A"].iter().enumerate() {
        assert!(channel(name).iter().zip(&frame.rgba).all(|(a, p)| a.to_bits() == p[i].to_bits()));
    }
    assert_eq!(channel("Z"), frame.depth);
    let holds = |name: &str, of: &dyn Fn(&Layer) -> f32| {
        let apart = channel(name).iter().zip(&frame.layers).filter(|(a, l)| a.to_bits() != of(l).to_bits()).count();
        assert_eq!(apart, 0, "{name}");
        assert!(frame.layers.iter().any(|l| of(l) != 0.0), "{name}: nothing to be told apart");
    };
    holds("hair.A", &|l| l.hair);
    holds("head.A", &|l| l.head);
    for (i, axis) in ["X", "Y", "Z"].into_iter().enumerate() {
        holds(&format!("direction.{axis}"), &|l| l.direction[i]);
    }
    for (i, axis) in ["X", "Y"].into_iter().enumerate() {
        holds(&format!("motion.{axis}"), &|l| l.motion[i]);
    }
}

#[test]
fn a_movie_decodes_to_the_frames_it_was_given() {
    let mut picture = small();
    picture.video.quality = 1.0;
    let (mut renderer, strands, view) = setting(&picture);
    let tone_mapping = ToneMapping::new(&picture);
    let frame = renderer.draw(&FrameToDraw::at_rest(&strands, view)).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("movie.mp4");
    let mut movie = Movie::create(&path, &picture, 25.0).unwrap();
    for _ in 0..3 {
        movie.push(&frame, &tone_mapping).unwrap();
    }
    assert!(!path.exists(), "nothing stands under the final name before the end");
    movie.finish().unwrap();

    // Back to the stream that decoders take: parameter sets from the index, units after lengths.
    let file = std::fs::read(&path).unwrap();
    let find = |kind: &[u8]| file.windows(4).position(|w| w == kind).unwrap();
    let at = find(b"avcC") + 4;
    let length = |at: usize| usize::from(u16::from_be_bytes([file[at], file[at + 1]]));
    let first = &file[at + 8..at + 8 + length(at + 6)];
    let second_at = at + 8 + first.len() + 1;
    let second = &file[second_at + 2..second_at + 2 + length(second_at)];
    let mut stream = [&[0, 0, 0, 1][..], first, &[0, 0, 0, 1], second].concat();
    let mut rest = &file[find(b"mdat") + 4..];
    while let Some((size, after)) = rest.split_first_chunk::<4>() {
        let (unit, after) = after.split_at(u32::from_be_bytes(*size) as usize);
        stream.extend([0, 0, 0, 1]);
        stream.extend(unit);
        rest = after;
    }
    let mut decoder = openh264::decoder::Decoder::new().unwrap();
    let mut frames = 0;
    let mut worst = 0.0_f64;
    for unit in openh264::nal_units(&stream) {
        if let Some(yuv) = decoder.decode(unit).unwrap() {
            use openh264::formats::YUVSource;
            frames += 1;
            assert_eq!(yuv.dimensions(), (96, 64));
            let shown = tone_mapping.rgba8(&frame);
            let mut sum = 0.0;
            for y in 0..64 {
                for x in 0..96 {
                    let [r, g, b] = [0, 1, 2].map(|c| f64::from(shown[4 * (y * 96 + x) + c]));
                    let luma = 16.0 + 219.0 / 255.0 * (0.2126 * r + 0.7152 * g + 0.0722 * b);
                    sum += (luma - f64::from(yuv.y()[y * yuv.strides().0 + x])).powi(2);
                }
            }
            worst = worst.max((sum / (96.0 * 64.0)).sqrt());
        }
    }
    for yuv in decoder.flush_remaining().unwrap() {
        let _ = yuv;
        frames += 1;
    }
    assert_eq!(frames, 3);
    // Quantiser 12 has a step of 2.5 of 255 and a dead zone of two thirds of it: an error below that in each
    // coefficient, and as much in each pixel, plus rounding.
    assert!(worst < 2.0, "{worst}");
}

#[test]
fn an_odd_side_loses_its_last_row_or_column_in_a_movie_and_nothing_else() {
    let picture = Picture { size: [97, 65], ..Picture::default() };
    let (mut renderer, strands, view) = setting(&picture);
    let tone_mapping = ToneMapping::new(&picture);
    let odd = renderer.draw(&FrameToDraw::at_rest(&strands, view)).unwrap();
    let rgba = odd.rgba.chunks_exact(97).take(64).flat_map(|row| &row[..96]).copied().collect();
    let even = nabiki_render::Frame { size: [96, 64], rgba, depth: Vec::new(), layers: Vec::new() };
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let coded = |frame: &nabiki_render::Frame, as_still: bool| {
        let mut movie =
            Movie::create(&at("movie.mp4"), &Picture { size: frame.size, ..picture.clone() }, 24.0).unwrap();
        if as_still {
            png::write(&at("still.png"), frame, &tone_mapping, Depth::Sixteen).unwrap();
            movie.push_still(&png::read(&at("still.png")).unwrap()).unwrap();
        } else {
            movie.push(frame, &tone_mapping).unwrap();
        }
        movie.finish().unwrap();
        std::fs::read(at("movie.mp4")).unwrap()
    };
    let wanted = coded(&even, false);
    assert!(coded(&odd, false) == wanted);
    assert!(coded(&odd, true) == wanted);
}

#[test]
fn contact_sheets_hold_every_picture_and_its_arrow() {
    let picture = small();
    let (mut renderer, strands, view) = setting(&picture);
    let tone_mapping = ToneMapping::new(&picture);
    let frame = renderer.draw(&FrameToDraw::at_rest(&strands, view)).unwrap();
    let mut sheet = ContactSheet::new(2);
    let mut plain = ContactSheet::new(2);
    let mut many = ContactSheet::new(2);
    let at = |x| ForceArrow { point: Vec3::new(0.0, 0.0, x), force: Vec3::new(0.0, x, 0.0) };
    for number in [0, 30, 60] {
        sheet.add(&frame, &tone_mapping, number, Some(Vec3::new(-100.0, 0.0, 0.0)), &view);
        plain.add(&frame, &tone_mapping, number, None, &view);
        many.add_arrows(&frame, &tone_mapping, number, &[at(-5.0), at(0.0), at(8.0)], &view);
    }
    assert_eq!(sheet.canvas().size(), [2 * (96 + 12) + 12, 2 * (64 + 12) + 12]);
    assert_ne!(sheet.canvas(), plain.canvas());
    assert_eq!(many.canvas().size(), plain.canvas().size());
    assert_ne!(many.canvas(), plain.canvas());
}

#[test]
fn bad_settings_are_refused_by_their_scene_key() {
    let wide = |width| {
        let mut picture = small();
        picture.hair.width = width;
        picture
    };
    for (picture, key) in [
        (Picture { size: [0, 10], ..small() }, "picture.size"),
        (Picture { size: [10, 20_000], ..small() }, "picture.size"),
        (Picture { samples: 0, ..small() }, "picture.samples"),
        (Picture { exposure: f32::NAN, ..small() }, "picture.exposure"),
        (wide(0.0), "picture.hair.width"),
        (wide(f32::NAN), "picture.hair.width"),
        (wide(1e9), "picture.hair.width"),
    ] {
        let text = Renderer::new(&picture, &Mesh::default()).err().unwrap().to_string();
        assert!(text.starts_with(key) && !text.contains('\n'), "{text}");
    }
    let text = Movie::create("x.mp4".as_ref(), &Picture { size: [8, 8], ..small() }, 24.0).err().unwrap().to_string();
    assert!(text.contains("picture.size"), "{text}");
}

#[test]
fn points_that_are_no_numbers_are_refused_by_strand() {
    for antialiasing in [Antialiasing::Coverage, Antialiasing::Oversample] {
        let (mut renderer, mut strands, view) = setting(&Picture { antialiasing, ..small() });
        strands.strand_mut(7)[3].y = f32::NAN;
        let text = renderer.draw(&FrameToDraw::at_rest(&strands, view)).err().unwrap().to_string();
        assert!(text.contains("strand 7, point 3"), "{text}");
    }
}

#[test]
fn an_unwritable_place_is_named_and_left_alone() {
    let picture = small();
    let (mut renderer, strands, view) = setting(&picture);
    let frame = renderer.draw(&FrameToDraw::at_rest(&strands, view)).unwrap();
    let path = std::path::Path::new("/nowhere/at/all/x.png");
    let text = png::write(path, &frame, &ToneMapping::new(&picture), Depth::Eight).err().unwrap().to_string();
    assert!(text.starts_with("cannot write /nowhere/at/all/x.png"), "{text}");
    assert!(Movie::create(path, &picture, 24.0).is_err());
}

/// A new file is for whoever the umask lets read it, and a link stays one.
#[cfg(unix)]
#[test]
fn pictures_and_movies_are_as_readable_as_other_new_files() {
    use std::os::unix::fs::PermissionsExt;
    const INNER: &str = "NABIKI_TEST_UMASK_IS_SET";
    if std::env::var_os(INNER).is_none() {
        // A umask belongs to a whole program: this test runs again in one of its own for each.
        for umask in ["077", "027", "022"] {
            let name = "pictures_and_movies_are_as_readable_as_other_new_files";
            let status = std::process::Command::new("sh")
                .args(["-c", &format!("umask {umask} && exec \"$0\" --exact {name}")])
                .arg(std::env::current_exe().unwrap())
                .env(INNER, "1")
                .stdout(std::process::Stdio::null())
                .status();
            assert!(status.unwrap().success(), "umask {umask}");
        }
        return;
    }
    let picture = small();
    let (mut renderer, strands, view) = setting(&picture);
    let tone_mapping = ToneMapping::new(&picture);
    let frame = renderer.draw(&FrameToDraw::at_rest(&strands, view)).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let mode = |name: &str| std::fs::metadata(at(name)).unwrap().permissions().mode();
    std::fs::write(at("plain"), "").unwrap();
    png::write(&at("frame.png"), &frame, &tone_mapping, Depth::Eight).unwrap();
    nabiki_render::output::exr::write(&at("frame.exr"), &frame).unwrap();
    field_plot::write_svg(&at("field.svg"), &field_plot::FieldPlot::default()).unwrap();
    std::os::unix::fs::symlink(at("elsewhere.mp4"), at("link.mp4")).unwrap();
    let mut movie = Movie::create(&at("link.mp4"), &picture, 24.0).unwrap();
    movie.push(&frame, &tone_mapping).unwrap();
    movie.finish().unwrap();
    assert!(std::fs::symlink_metadata(at("link.mp4")).unwrap().is_symlink());
    for name in ["frame.png", "frame.exr", "field.svg", "elsewhere.mp4"] {
        assert_eq!(mode(name), mode("plain"), "{name}");
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 6, "nothing is left beside them");
}
