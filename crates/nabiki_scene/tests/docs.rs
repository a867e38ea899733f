//! Every scene in the docs runs as it stands, on stand-ins for the files it names. A block marked `toml fragment` is part
//! of a scene: it is given a force.

use std::path::{Path, PathBuf};

use glam::{DAffine3, DVec3, Vec3};
use nabiki::dynamics::Stepper;
use nabiki_io::Axis;
use nabiki_io::exchange;
use nabiki_io::moving::{self, ChainOptions};
use nabiki_io::{Placement, Unit};
use nabiki_scene::scene::{HeadSource, Scene};
use nabiki_scene::{BuiltScene, Shown};

/// A scene in a page of the docs.
struct Block {
    place: String,
    text: String,
}

fn blocks() -> Vec<Block> {
    let root = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."));
    let files = ["docs", "docs/guides"].map(|folder| std::fs::read_dir(root.join(folder)).unwrap());
    let docs = files.into_iter().flatten().map(|entry| entry.unwrap().path());
    let pages: Vec<PathBuf> = docs.filter(|path| path.extension().is_some_and(|e| e == "md")).collect();
    pages.into_iter().chain([root.join("README.md")]).flat_map(|page| blocks_of(&page)).collect()
}

fn blocks_of(page: &Path) -> Vec<Block> {
    let text = std::fs::read_to_string(page).unwrap();
    let name = page.file_name().unwrap().to_string_lossy().into_owned();
    let (mut blocks, mut open): (Vec<Block>, Option<Block>) = (Vec::new(), None);
    for (i, line) in text.lines().enumerate() {
        let place = format!("{name}:{}", i + 1);
        assert!(!line.starts_with("    ["), "{place}: a scene stands between ```toml and ```, so that it is tried");
        match (&mut open, line) {
            (Some(block), "```") => {
                if block.text.starts_with("#fragment") && !block.text.contains("[[force]]") {
                    block.text += "[[force]]\nthrough = 50\nvector = [-60, 0, 0]\n";
                }
                blocks.extend(open.take());
            }
            (Some(block), line) => block.text += &format!("{line}\n"),
            (None, "```toml") => open = Some(Block { place, text: String::new() }),
            (None, "```toml fragment") => open = Some(Block { place, text: "#fragment\n".to_owned() }),
            (None, _) => {}
        }
    }
    assert!(open.is_none(), "{name}: a block that does not end");
    blocks
}

/// The built-in head with a little hair.
fn bust() -> BuiltScene {
    let text = "[hair]\nstrands = 60\n[[force]]\nthrough = 1\nvector = [0, -1, 0]\n";
    Scene::parse(text, Path::new("bust.toml"), &[]).unwrap().build(Shown::All).unwrap()
}

/// Makes the files that `scene` names: the built-in head and hair, lying as the scene says, or the layer itself where it
/// does not (z up, in metres, as Blender has it).
fn stand_ins(scene: &Scene, bust: &BuiltScene) {
    if let HeadSource::Imported(head) = &scene.head.source {
        let is_usd = exchange::is_usd(&head.mesh);
        let facing = head.facing.unwrap();
        let placement = Placement {
            unit: head.unit.unwrap_or(Unit { cm: if is_usd { 100.0 } else { 1.0 } }),
            up: head.up.unwrap_or(if is_usd && facing.is_across(Axis::PlusZ) { Axis::PlusZ } else { Axis::PlusY }),
            facing,
            origin: Vec3::ZERO,
        };
        let moves = scene.head.motion.as_ref().is_some_and(|motion| motion.file == head.mesh);
        let files = [Some(&head.mesh), scene.hair.imported().map(|hair| &hair.file)];
        for file in files.into_iter().flatten() {
            let mut export = exchange::export(&bust.groom.hair, 24.0, Some(&placement));
            export.head = Some(&bust.model.head.mesh);
            let mut sink = moving::sink(&scene.resolve(file), export, None, ChainOptions::default()).unwrap();
            for frame in 0..if moves { 60 } else { 1 } {
                let to_the_side = DAffine3::from_translation(0.01 * f64::from(frame) * DVec3::X);
                sink.frame(bust.strands(), &to_the_side).unwrap();
            }
            sink.finish().unwrap();
        }
    }
    for aim in scene.aims.iter().filter(|aim| !aim.file.as_os_str().is_empty()) {
        let export = exchange::export(&bust.groom.hair, 24.0, None);
        let mut sink = moving::sink(&scene.resolve(&aim.file), export, None, ChainOptions::default()).unwrap();
        for _ in 0..60 {
            sink.frame(bust.strands(), &DAffine3::IDENTITY).unwrap();
        }
        sink.finish().unwrap();
    }
    for body in &scene.bodies {
        if body.capsule.is_none() {
            std::fs::write(scene.resolve(&body.mesh), TETRAHEDRON).unwrap();
        }
        if let Some(motion) = &body.motion {
            std::fs::write(scene.resolve(&motion.file), table()).unwrap();
        }
    }
    if let Some(motion) =
        scene.head.motion.as_ref().filter(|motion| motion.file.extension().is_some_and(|e| e == "csv"))
    {
        std::fs::write(scene.resolve(&motion.file), table()).unwrap();
    }
    if let Some((motion, skeleton)) = scene.head.motion.as_ref().and_then(|m| m.skeleton.as_ref().map(|s| (m, s))) {
        std::fs::write(scene.resolve(skeleton), SKELETON).unwrap();
        let samples = (1..=60).map(|n| format!("{n}\nroot 0 {} 0 0 0 0\nhead 0 {n} 0\n", 17.0 + 0.01 * f64::from(n)));
        let text: String = samples.collect();
        std::fs::write(scene.resolve(&motion.file), format!(":FULLY-SPECIFIED\n:DEGREES\n{text}")).unwrap();
    }
}

/// The way of what stands still, as a table.
fn table() -> String {
    let rows: String = (0..60).map(|second| format!("{second},0,0,0,0,0,0,1\n")).collect();
    format!("t_s,px_cm,py_cm,pz_cm,qx,qy,qz,qw\n{rows}")
}

/// Beside the head.
const TETRAHEDRON: &str = "v 30 0 0\nv 32 0 0\nv 30 2 0\nv 30 0 2\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";

const SKELETON: &str = "\
:version 1.10
:name one
:units
  mass 1.0
  length 0.45
  angle deg
:root
  order TX TY TZ RX RY RZ
  axis XYZ
  position 0 0 0
  orientation 0 0 0
:bonedata
  begin
    id 1
    name head
    direction 0 1 0
    length 2
    axis 0 0 0 XYZ
    dof rx ry rz
  end
:hierarchy
  begin
    root head
  end
";

/// Builds a scene and steps it twice.
fn runs(scene: Scene) -> nabiki_scene::Result<Vec<String>> {
    let built = scene.build(Shown::All)?;
    let mut simulation = built.simulation()?;
    for frame in 1..=2 {
        simulation.step_frame(&built.input(frame));
    }
    assert!(simulation.strands().points().iter().all(|p| p.is_finite()));
    Ok(built.advice().iter().map(ToString::to_string).collect())
}

#[test]
fn every_scene_in_the_docs_runs_as_it_stands() {
    let (blocks, bust) = (blocks(), bust());
    assert!(blocks.len() >= 6, "{} blocks", blocks.len());
    for Block { place, text } in blocks {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.toml");
        let parse = |overrides: &[(&str, &str)]| {
            let overrides: Vec<_> = overrides.iter().map(|&(k, v)| (k.to_owned(), v.to_owned())).collect();
            Scene::parse(&text, &path, &overrides).unwrap_or_else(|e| panic!("{place}: {e}"))
        };
        let whole = parse(&[]);
        stand_ins(&whole, &bust);
        let few = parse(&[("motion.frames", "2"), ("output.sheet", "[0]"), ("hair.strands", "40")]);
        let advice = runs(few).unwrap_or_else(|e| panic!("{place}: {e}"));
        assert!(advice.is_empty(), "{place}: {advice:?}");
    }
}

/// The program of the crate's README is its doc-test, which runs.
#[test]
fn the_program_of_the_readme_is_the_one_that_is_tested() {
    let program =
        include_str!("../README.md").split("```rust\n").nth(1).and_then(|rest| rest.split("```").next()).unwrap();
    let documented = include_str!("../src/lib.rs").lines().filter_map(|line| line.strip_prefix("//!"));
    let tested: String = documented
        .map(|line| line.strip_prefix(' ').unwrap_or(line))
        .skip_while(|line| *line != "```")
        .skip(1)
        .take_while(|line| *line != "```")
        .filter(|line| !line.starts_with("# "))
        .flat_map(|line| [line, "\n"])
        .collect();
    assert_eq!(program, tested);
}

/// Those for engines and games are examples, which are compiled.
#[test]
fn the_programs_for_engines_are_examples() {
    let root = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."));
    let pages: [(&str, &[&str]); 2] = [
        ("docs/engine.md", &["crates/nabiki/examples/ball.rs"]),
        ("docs/guides/game.md", &["crates/nabiki_groom/examples/game.rs", "crates/nabiki_io/examples/read.rs"]),
    ];
    for (page, examples) in pages {
        let text = std::fs::read_to_string(root.join(page)).unwrap();
        let programs: Vec<&str> = text.split("```rust\n").skip(1).filter_map(|rest| rest.split("```").next()).collect();
        assert_eq!(programs.len(), examples.len(), "{page}");
        for (program, example) in programs.into_iter().zip(examples) {
            let tested = std::fs::read_to_string(root.join(example)).unwrap();
            assert!(tested.ends_with(program), "{page}: {example} is\n{tested}");
        }
    }
}
