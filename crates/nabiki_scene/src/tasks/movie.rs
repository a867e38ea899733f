//! Encodes a movie from existing pictures.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use nabiki_render::output::png;
use nabiki_render::{Movie, Picture};

use crate::error::{Error, Result};
use crate::place;
use crate::scene::Scene;
use crate::told::Told;
use crate::watch::{Watch, each_frame};
use nabiki_io::shell::operand;

/// Options of [`movie`].
#[derive(Clone, Debug, Default)]
pub struct MovieOptions {
    /// Numbered PNG files: `0007.png`, `gust_0007.png`, or folders of them.
    pub frames: Vec<PathBuf>,
    /// The movie (.mp4).
    pub output: PathBuf,
    /// The scene of the pictures. It determines their number, the frame rate and the quality. Without it, they may
    /// start at any number, and play at 24 per second.
    pub scene: Option<Scene>,
    /// Overrides that make the scene file this scene, such as `motion.frames=40`.
    pub sets: Vec<String>,
    /// Number of strands in the pictures, all by default, for the command that draws a missing picture.
    pub strands: Option<usize>,
}

/// Encodes numbered pictures, without gaps, as a movie. From 16-bit PNG files, the movie is the same, bit by bit, as
/// that of [`run`](super::run()) for the same frames.
///
/// # Errors
/// Pictures that are missing, of different sizes, or transparent; a place that cannot be written; or cancelled by
/// `watch`.
pub fn movie(options: &MovieOptions, watch: &mut dyn Watch) -> Result<()> {
    let output = options.output.as_path();
    if !output.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("mp4")) {
        return Err(Error::refused(format!("{}: a movie ends in .mp4; choose another name", output.display())));
    }
    place::file(output)?;
    let frames = numbered(&options.frames)?;
    let files: Vec<PathBuf> = frames.iter().map(|(_, file)| file.clone()).collect();
    place::not_inputs(&[output], &files)?;
    whole(&frames, options)?;
    let size = one_size(&files)?;
    let (picture, frame_rate) = match &options.scene {
        Some(scene) => {
            let rate = scene.picture.video.frame_rate.unwrap_or(scene.frame_rate());
            (Picture { size, ..scene.picture.clone() }, rate)
        }
        None => (Picture { size, ..Picture::default() }, Scene::default().frame_rate()),
    };
    let mut movie = Movie::create(output, &picture, frame_rate)?;
    let last = u32::try_from(files.len() - 1).unwrap_or(u32::MAX);
    each_frame(watch, "coding", 0..=last, |n| Ok(movie.push_still(&png::read(&files[n as usize])?)?))?;
    movie.finish()?;
    let holds = Some(format!("{} frames at {frame_rate} a second", files.len()));
    watch.told(Told::Wrote { file: output.to_owned(), holds });
    Ok(())
}

/// The pictures in the order of their numbers.
fn numbered(given: &[PathBuf]) -> Result<Vec<(u32, PathBuf)>> {
    let mut frames = Vec::new();
    for path in given {
        if path.is_dir() {
            let unreadable = |e: std::io::Error| Error::from(nabiki_io::Error::from(e).in_file(path));
            let before = frames.len();
            for there in std::fs::read_dir(path).map_err(unreadable)? {
                let file = there.map_err(unreadable)?.path();
                frames.extend(number(&file).map(|number| (number, file)));
            }
            if frames.len() == before {
                let line = "no numbered PNG files are in this folder, such as 0007.png; nabiki render --frames A..B writes them";
                return Err(Error::refused(format!("{}: {line}", path.display())));
            }
        } else {
            let Some(number) = number(path) else {
                if !path.exists() {
                    return Err(Error::refused(format!("{}: there is no such file or folder", path.display())));
                }
                let line = "no PNG file with a number at the end of its name, such as 0007.png";
                return Err(Error::refused(format!("{}: {line}", path.display())));
            };
            frames.push((number, path.clone()));
        }
    }
    frames.sort();
    // A picture of --frame has another name than those of --frames, which are in their own folder, and may fill a gap among them.
    let mut of_folder = BTreeMap::new();
    for (_, b) in &frames {
        let a = *of_folder.entry(b.parent()).or_insert(b);
        if film(a) != film(b) {
            let line = "have different names before their numbers, like pictures of two movies; name those of one";
            return Err(Error::refused(format!("{} and {}: {line}", a.display(), b.display())));
        }
    }
    if let Some([a, b]) = frames.windows(2).find(|pair| pair[0].0 == pair[1].0).and_then(|pair| pair.first_chunk()) {
        let (b, a, n) = (b.1.display(), a.1.display(), a.0);
        return Err(Error::refused(format!("{b}: is frame {n} as {a} is; give each frame once")));
    }
    Ok(frames)
}

/// The number at the end of a PNG file's name.
fn number(file: &Path) -> Option<u32> {
    file.extension().filter(|ending| ending.eq_ignore_ascii_case("png"))?;
    let stem = file.file_stem()?.to_str()?;
    stem[film(file)?.len()..].parse().ok()
}

/// The part of a file's name before the number.
fn film(file: &Path) -> Option<&str> {
    Some(file.file_stem()?.to_str()?.trim_end_matches(|c: char| c.is_ascii_digit()))
}

/// Refuses a film with missing frames.
fn whole(frames: &[(u32, PathBuf)], options: &MovieOptions) -> Result<()> {
    let Some((first, _)) = frames.first() else {
        return Err(Error::refused("no frames given: name numbered PNG files, or a folder of them"));
    };
    let mut next = if options.scene.is_some() { 0 } else { *first };
    let missing = |from: u32, through: u32| {
        let which =
            if from == through { format!("frame {from} is") } else { format!("frames {from} to {through} are") };
        let of = frames[0].1.parent().unwrap_or(Path::new("")).display();
        let command = drawing(&frames[0].1, (from, through), options);
        Err(Error::refused(format!("{of}: {which} missing; render with {command}")))
    };
    for &(n, _) in frames {
        if n > next {
            return missing(next, n - 1);
        }
        next = n + 1;
    }
    let Some(scene) = &options.scene else { return Ok(()) };
    let last = scene.motion.frames;
    match frames.iter().find(|(n, _)| *n > last).zip(frames.last()) {
        Some(((_, file), (end, _))) => Err(Error::refused(format!(
            "{}: the last frame of {} is motion.frames = {last}; remove the later frames of an earlier run, or give --set \
             motion.frames={end}",
            file.display(),
            scene.file().display()
        ))),
        None if next <= last => missing(next, last),
        None => Ok(()),
    }
}

/// The command that draws frames of the film of `file`, beside it.
fn drawing(file: &Path, (from, through): (u32, u32), options: &MovieOptions) -> String {
    let mut words = vec!["nabiki".to_owned(), "render".to_owned()];
    let scene = options.scene.as_ref();
    words.push(scene.map_or("SCENE".to_owned(), |scene| operand(&scene.file().to_string_lossy())));
    words.extend(["--frames".to_owned(), format!("{from}..{through}")]);
    let folder = file.parent().unwrap_or(Path::new(""));
    if let Some(scene) = scene.filter(|scene| folder.file_name() == Some(format!("{}_frames", scene.name()).as_ref())) {
        let beside = nabiki_file::folder_of(folder);
        words.extend(["--out".to_owned(), operand(&beside.to_string_lossy())]);
        let motion = beside.join(format!("{}.nabiki", scene.name()));
        if motion.exists() {
            words.extend(["--motion".to_owned(), operand(&motion.to_string_lossy())]);
        }
    }
    words.extend(options.strands.into_iter().flat_map(|count| ["--strands".to_owned(), count.to_string()]));
    words.extend(options.sets.iter().flat_map(|set| ["--set".to_owned(), set.clone()]));
    if png::read_depth(file).is_ok_and(|depth| depth == png::Depth::Sixteen) {
        words.extend(["--set".to_owned(), "output.png_bits=16".to_owned()]);
    }
    nabiki_io::shell::command(&words)
}

/// The size of all pictures, which a movie can have.
fn one_size(files: &[PathBuf]) -> Result<[u32; 2]> {
    let size_of = |file: &Path| -> Result<[u32; 2]> {
        // Refuses special files and links.
        nabiki_io::input::open(file)?;
        Ok(png::read_size(file)?)
    };
    let size = size_of(&files[0])?;
    if !Movie::takes(size) {
        return Err(Error::refused(format!(
            "{}: {} x {} pixels; {}: render with another picture.size",
            files[0].display(),
            size[0],
            size[1],
            Movie::SIZES
        )));
    }
    for file in &files[1..] {
        let other = size_of(file)?;
        if other != size {
            return Err(Error::refused(format!(
                "{}: {} x {} pixels and {} has {} x {}; render all frames at one size",
                file.display(),
                other[0],
                other[1],
                files[0].display(),
                size[0],
                size[1]
            )));
        }
    }
    Ok(size)
}
