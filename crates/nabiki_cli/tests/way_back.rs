//! Hair from another tool comes back in that tool's own space, straight from the simulation or out of a cache.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use glam::Vec3;
use nabiki::{Hair, Strands};
use nabiki_io::exchange::{self, Coordinates};
use nabiki_io::hair;
use nabiki_io::motion::Axis;
use nabiki_io::placement::Unit;

fn nabiki(folder: &Path, words: &str) -> Output {
    Command::new(env!("CARGO_BIN_EXE_nabiki")).current_dir(folder).args(words.split(' ')).output().unwrap()
}

fn succeed(folder: &Path, words: &str) -> String {
    let output = nabiki(folder, words);
    assert!(output.status.success(), "{words}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

fn refuse(folder: &Path, words: &str) -> String {
    let output = nabiki(folder, words);
    assert_eq!(output.status.code(), Some(1), "{words}");
    String::from_utf8(output.stderr).unwrap()
}

const SAID: Coordinates = Coordinates { unit: Some(Unit { cm: 100.0 }), up: Some(Axis::PlusZ) };

/// A groom in metres, z up, as Blender writes it, beside a scene that moves it for three frames.
fn groom(folder: &Path) -> Hair {
    let mut strands = Strands::default();
    for s in 0..20 {
        let root = Vec3::new(0.09 * (s as f32).cos(), 0.09 * (s as f32).sin(), 1.7 + 0.001 * s as f32);
        strands.push((0..5).map(|p| root + p as f32 * Vec3::new(0.01 * (s as f32).cos(), 0.0, -0.03)));
    }
    let mut hair = Hair::from(strands);
    hair.attributes.width = Some(vec![8e-5; 100]);
    hair.attributes.id = Some((0..20).map(|s| 100 - s).collect());
    exchange::write(&folder.join("groom.usdc"), &hair, SAID).unwrap();
    let scene = "[hair]\nfile = \"groom.usdc\"\nfacing = \"-y\"\norigin = [0.0, 0.0, 1.7]\njoin_within = 0\n\n\
                 [motion]\nframes = 3\n\n[[force]]\nthrough = 3\nvector = [-10, 0, 0]\n";
    fs::write(folder.join("scene.toml"), scene).unwrap();
    hair
}

#[test]
fn a_cache_of_imported_hair_goes_back_into_the_space_of_its_file() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let groom = groom(folder);
    succeed(folder, "simulate scene.toml -o m.nabiki --export direct.usdc --export-layer /head/hair");
    succeed(folder, "convert m.nabiki later.usdc --export-layer /head/hair");
    let [direct, later] = ["direct.usdc", "later.usdc"].map(|name| fs::read(folder.join(name)).unwrap());
    assert!(direct == later, "a layer is the same from the simulation and out of its cache");

    succeed(folder, "convert m.nabiki moving.usdc");
    for (words, name) in [("convert m.nabiki --frame 0", "rest.usda"), ("convert groom.usdc", "same.usda")] {
        succeed(folder, &format!("{words} {name}"));
    }
    for name in ["moving.usdc", "rest.usda", "same.usda"] {
        let path = folder.join(name);
        assert_eq!(exchange::coordinates(&path).unwrap(), SAID, "{name}");
        let back = hair::read(&path).unwrap();
        assert_eq!(back.strands.starts(), groom.strands.starts(), "{name}");
        assert_eq!(back.attributes.id, groom.attributes.id, "{name}");
        // To centimetres and back: a few roundings of numbers below 2, seen from an origin at 1.7.
        for (p, q) in back.strands.points().iter().zip(groom.strands.points()) {
            assert!(p.distance(*q) < 4.0 * 2.0 * f32::EPSILON, "{name}: {p} {q}");
        }
        for (w, v) in back.attributes.width.unwrap().iter().zip(groom.attributes.width.as_ref().unwrap()) {
            assert!((w / v - 1.0).abs() < 4.0 * f32::EPSILON, "{name}: {w} {v}");
        }
    }
    succeed(folder, "convert m.nabiki --frame 3 tips.hair");
    let moved = exchange::hair(&folder.join("moving.usdc"), 3, None).unwrap();
    assert_eq!(hair::read(&folder.join("tips.hair")).unwrap().strands, moved.strands, "also where no unit is said");
}

#[test]
fn a_layer_that_would_not_fit_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    groom(folder);
    succeed(folder, "simulate scene.toml -o m.nabiki --strands 7");
    let refused = refuse(folder, "convert m.nabiki layer.usdc --export-layer /head/hair");
    assert!(
        refused.starts_with("nabiki: layer.usdc: a layer would not fit the groom: 35 of its 100 points"),
        "{refused}"
    );
    let refused =
        refuse(folder, "simulate scene.toml -o n.nabiki --strands 7 --export l.usdc --export-layer /head/hair");
    assert!(refused.starts_with("nabiki: l.usdc: a layer would not fit the groom: 35 of its 100 points"), "{refused}");
    let refused = refuse(folder, "convert groom.usdc layer.usdc --export-layer /head/hair");
    assert!(refused.contains("groom.usdc: --export-layer is for all frames of a motion cache"), "{refused}");
    assert!(!folder.join("layer.usdc").exists() && !folder.join("n.nabiki").exists());
}

#[test]
fn what_a_format_cannot_hold_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    groom(folder);
    let unit = |file: &str| format!("{file} cannot hold its unit: give hair.unit = 100 where it is read\n");
    let up = |file: &str| format!("{file} cannot hold its up axis: give hair.up = \"+z\" where it is read\n");
    let said = succeed(folder, "convert groom.usdc groom.hair");
    let ids = "groom.hair cannot hold strand ids\n".to_owned();
    let wrote = "wrote groom.hair: 20 strands\n";
    assert_eq!(said, ids + &unit("groom.hair") + &up("groom.hair") + wrote);
    let said = succeed(folder, "convert groom.usdc groom.tfx");
    let points = "groom.tfx cannot hold 5 points a strand as TressFX itself wants them: 4, 8, 16, 32 or 64";
    assert!(said.contains(points) && said.contains("strand ids"), "{said}");
    let said = succeed(folder, "convert groom.usdc groom.abc");
    assert_eq!(said, unit("groom.abc") + &up("groom.abc") + "wrote groom.abc: 20 strands\n");
    assert_eq!(succeed(folder, "convert groom.usdc again.usda"), "wrote again.usda: 20 strands\n");

    succeed(folder, "simulate scene.toml -o m.nabiki --export m.abc");
    let said = succeed(folder, "convert m.abc still.usda --unit m --frame 9");
    assert_eq!(said, "still.usda cannot hold motion: it is frame 3 of the 4 in m.abc\nwrote still.usda: 20 strands\n");
    let said = succeed(folder, "convert m.nabiki m2.abc");
    assert_eq!(said, unit("m2.abc") + &up("m2.abc") + "wrote m2.abc: 4 frames of 20 strands\n");
}
