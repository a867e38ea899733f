//! Hair whose file has strands from tip to root: recognised by the skin, turned, and passed on as the file has it.

use std::path::Path;

use glam::Vec3;
use nabiki::{Hair, Strands};
use nabiki_io::{exchange, hair};
use nabiki_scene::exports::ExportOptions;
use nabiki_scene::tasks::{ConvertOptions, SimulateOptions, Twin, convert, simulate};
use nabiki_scene::{BuiltScene, Scene, Shown, Unwatched};

/// Hair of the built-in bust, of every length, with a width for each point.
fn grown(style: &str) -> Hair {
    let text = format!(
        "[hair]\nstrands = 240\nsegments = 12\nsegment_length = 1.5\n[hair.style]\n{style}\n[[force]]\nthrough = 1\nvector = [0, -1, 0]\n"
    );
    let mut hair =
        Scene::parse(&text, Path::new("bust.toml"), &[]).unwrap().build(Shown::All).unwrap().groom.hair.clone();
    hair.attributes.width = Some((0..hair.strands.points().len()).map(|p| 0.001 * (1.0 + p as f32)).collect());
    hair
}

/// Straight and long, and a short cut that stands up.
const STYLES: [&str; 2] = [
    "length = { top = 18.0, sides = 12.0, back = 18.0 }",
    "length = { top = 2.0, sides = 2.0, back = 2.0 }\nlift_degrees = { top = 80.0, sides = 80.0, back = 80.0 }",
];

/// The same as a file has it that stores those strands tip first.
fn stored(hair: &Hair, tip_first: &[bool]) -> Hair {
    hair.clone().from_tip_first(tip_first.to_vec()).into_source()
}

/// What a file holds is nothing but points and what goes with them.
trait Source {
    fn into_source(self) -> Self;
}

impl Source for Hair {
    fn into_source(mut self) -> Self {
        self.attributes.tip_first = None;
        self
    }
}

/// A scene of that hair on the bust, out of a file of this name.
fn scene(folder: &Path, name: &str, source: &Hair, more: &str) -> Scene {
    hair::write(&folder.join(name), source).unwrap();
    let text = format!(
        "[hair]\nfile = \"{name}\"\nunit = \"cm\"\nup = \"+y\"\nfacing = \"+x\"\njoin_within = 0\n{more}\n\
         [motion]\nform = \"free\"\nframes = 3\ninertia_length_floor = 14.0\n\
         [free]\nstiffness = 100.0\n[[force]]\nthrough = 3\nvector = [-60, 0, 0]\n"
    );
    Scene::parse(&text, &folder.join("scene.toml"), &[]).unwrap()
}

fn built(folder: &Path, source: &Hair, more: &str) -> BuiltScene {
    scene(folder, "source.hair", source, more).build(Shown::All).unwrap()
}

fn turned(built: &BuiltScene) -> usize {
    built.groom.imported.as_ref().unwrap().report.tip_first
}

#[test]
fn strands_are_turned_one_by_one_with_what_they_carry() {
    let folder = tempfile::tempdir().unwrap();
    for style in STYLES {
        let hair = grown(style);
        let count = hair.strands.len();
        for nth in [1, 2, 3, 10, 40] {
            let tip_first: Vec<bool> = (0..count).map(|s| s % nth == 0).collect();
            let built = built(folder.path(), &stored(&hair, &tip_first), "");
            assert_eq!(turned(&built), count.div_ceil(nth), "one in {nth}, {style}");
            assert_eq!(*built.strands(), hair.strands, "one in {nth}, {style}");
            assert_eq!(built.groom.hair.attributes.width, hair.attributes.width, "one in {nth}");
        }
        assert_eq!(turned(&built(folder.path(), &hair, "")), 0, "{style}");
        assert_eq!(built(folder.path(), &hair, "").groom.hair.strands, hair.strands);
    }
}

#[test]
fn a_scene_may_say_which_end_is_the_root() {
    let folder = tempfile::tempdir().unwrap();
    let hair = grown(STYLES[0]);
    let all = vec![true; hair.strands.len()];
    let backward = stored(&hair, &all);
    assert_eq!(built(folder.path(), &backward, "root = \"first\"").groom.hair.strands, backward.strands);
    assert_eq!(built(folder.path(), &backward, "root = \"last\"").groom.hair.strands, hair.strands);
    assert_eq!(built(folder.path(), &hair, "root = \"last\"").groom.hair.strands, backward.strands);
    let refused = Scene::parse("[hair]\nfile = \"a.hair\"\nroot = \"tip\"\n", Path::new("a.toml"), &[]);
    assert!(refused.unwrap_err().to_string().contains("hair.root"));
}

#[test]
fn hair_that_lies_on_the_skin_from_end_to_end_stays_as_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let head = nabiki_groom::bust();
    let on_skin = |mut p: Vec3| {
        (0..8).for_each(|_| p -= head.distance(p) * head.outward(p));
        p
    };
    // Brows of 1.5 cm, a tenth of a millimetre above the skin or so, every other one tip first.
    let mut strands = Strands::default();
    for root in grown(STYLES[0]).strands.iter().map(|strand| strand[0]) {
        let along = head.outward(root).cross(Vec3::Y).normalize_or(Vec3::X);
        let mut points: Vec<Vec3> =
            (0..6).map(|i| on_skin(root + 0.3 * i as f32 * along) + 0.004 * i as f32 * head.outward(root)).collect();
        if strands.len() % 2 == 1 {
            points.reverse();
        }
        strands.push(points);
    }
    let brows = Hair::from(strands);
    let built = built(folder.path(), &brows, "");
    assert_eq!((turned(&built), built.strands()), (0, &brows.strands));
}

#[test]
fn what_hair_does_not_lie_on_tells_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let hair = grown(STYLES[0]);
    let all = vec![true; hair.strands.len()];
    for more in ["origin = [0, 60, 0]", "unit = \"m\"", "unit = \"mm\""] {
        let more = more.to_owned();
        let scene = scene(folder.path(), "source.hair", &stored(&hair, &all), "");
        let text = scene.to_toml().unwrap().replace("unit = \"cm\"", &more);
        let built = Scene::parse(&text, &folder.path().join("scene.toml"), &[]).unwrap().build(Shown::All).unwrap();
        assert_eq!(turned(&built), 0, "{more}");
    }
}

#[test]
fn what_goes_out_has_its_points_as_the_file_has_them() {
    let folder = tempfile::tempdir().unwrap();
    let hair = grown(STYLES[0]);
    let tip_first: Vec<bool> = (0..hair.strands.len()).map(|s| s % 2 == 0).collect();
    let source = stored(&hair, &tip_first);
    let file = |name: &str| folder.path().join(name);
    let scene = scene(folder.path(), "source.usda", &source, "");
    let prim = nabiki_io::GroomFile::open(&file("source.usda")).unwrap().curves(Path::new("source.usda")).unwrap();
    let layer = Some(prim.curves[0].path.clone());
    let exported = |layer: &Option<String>, name: &str, cache: &str| {
        let exports = ExportOptions { files: vec![file(name)], layer: layer.clone(), ..ExportOptions::default() };
        let options = SimulateOptions { output: file(cache), exports, twin: Twin::Fast, shard: None };
        simulate(scene.clone(), Shown::All, &options, &mut Unwatched).unwrap();
    };
    exported(&layer, "layer.usda", "m.nabiki");
    exported(&None, "stage.usda", "m.nabiki");
    let convert_to = |name: &str, layer: Option<String>, frame: Option<u32>| {
        let (input, output) = (file("m.nabiki"), file(name));
        convert(&ConvertOptions { input, output, layer, frame, ..ConvertOptions::default() }, &mut Unwatched).unwrap();
    };
    convert_to("layer_of_cache.usda", layer.clone(), None);
    convert_to("stage_of_cache.usda", None, None);
    convert_to("one.hair", None, Some(0));
    let near = |found: &[Vec3], what: &str| {
        assert_eq!(found.len(), source.strands.points().len(), "{what}");
        let far = found.iter().zip(source.strands.points()).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
        assert!(far < 1e-4, "{what}: {far} cm");
    };
    for name in ["stage.usda", "stage_of_cache.usda", "one.hair"] {
        let found = hair::read(&file(name)).unwrap();
        near(found.strands.points(), name);
        let (widths, expected) = (found.attributes.width.unwrap(), source.attributes.width.as_ref().unwrap());
        assert!(widths.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-6), "{name}: widths go along");
    }
    for name in ["layer.usda", "layer_of_cache.usda"] {
        near(&first_points(&std::fs::read_to_string(file(name)).unwrap()), name);
    }
    // In every frame, not in the first alone: roots stay on the skin, and stand where the file has them.
    let frame = exchange::hair(&file("stage.usda"), 3, None).unwrap();
    for (s, strand) in frame.strands.iter().enumerate() {
        let root = if tip_first[s] { strand[strand.len() - 1] } else { strand[0] };
        assert!(root.distance(hair.strands.strand(s)[0]) < 1e-4, "strand {s}");
    }
}

/// The points of the first sample of a layer.
fn first_points(layer: &str) -> Vec<Vec3> {
    let at = layer.find("point3f[] points.timeSamples").unwrap();
    let list = &layer[at + layer[at..].find('[').unwrap() + 2..];
    let list = &list[list.find('[').unwrap() + 1..];
    let list = &list[..list.find(']').unwrap()];
    let numbers: Vec<f32> = list.split(['(', ')', ',', ' ']).filter_map(|word| word.trim().parse().ok()).collect();
    numbers.as_chunks::<3>().0.iter().map(|&p| Vec3::from(p)).collect()
}
