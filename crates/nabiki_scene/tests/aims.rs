//! Aims of scenes: the curves of their files, in head space, and what is refused.

use std::path::Path;

use nabiki::Strands;
use nabiki::aim::{Aim, AimShape};
use nabiki::dynamics::{Form, FrameInput, Stepper};
use nabiki_scene::exports::ExportOptions;
use nabiki_scene::tasks::{SimulateOptions, Twin, simulate};
use nabiki_scene::{BuiltScene, Scene, Shown, Unwatched};

/// A head that walks and turns, in seconds and centimetres.
const WAY: &str = "t_s,px_cm,py_cm,pz_cm,qx,qy,qz,qw\n0,0,150,0,0,0,0,1\n0.25,20,152,-5,0,0.5,0,0.8660254\n0.5,50,150,-9,0.2,0.6,0,0.7745967\n";

fn aims(built: &BuiltScene) -> &[Aim] {
    match &built.dynamics.form {
        Form::Free(free) => &free.aims,
        Form::Paper => panic!("the scene is in the free form"),
    }
}

fn text(more: &str) -> String {
    format!(
        "[motion]\nform = \"free\"\nframes = 12\n[hair]\nstrands = 40\n[head.motion]\nfile = \"way.csv\"\nup = \"+y\"\nfacing = \"+x\"\n{more}\n[[free.regions]]\n\
         name = \"front\"\nnear = [8, 6, 0]\n[[force]]\nthrough = 12\nvector = [-400, 90, 0]\n"
    )
}

fn scene(folder: &Path, more: &str) -> Result<Scene, String> {
    std::fs::write(folder.join("way.csv"), WAY).unwrap();
    Scene::parse(&text(more), &folder.join("s.toml"), &[]).map_err(|e| e.to_string())
}

fn built(folder: &Path, more: &str) -> Result<BuiltScene, String> {
    scene(folder, more)?.build(Shown::All).map_err(|e| e.to_string())
}

/// The points of the scene in a frame, in head space.
fn points(built: &BuiltScene, frame: u32) -> Strands {
    let mut simulation = built.simulation().unwrap();
    for n in 1..=frame {
        simulation.step_frame(&FrameInput::new(n, &built.way.poses, &*built.forces.field));
    }
    simulation.strands().clone()
}

/// Whatever a simulation writes leads hair to where it was, in head space, though the head has gone and turned.
#[test]
fn a_frame_of_a_simulation_is_read_back_on_the_head_of_that_frame() {
    let folder = tempfile::tempdir().unwrap();
    let plain = built(folder.path(), "").unwrap();
    for file in ["pose.usda", "pose.usdc", "pose.abc", "pose.nabiki"] {
        let path = folder.path().join(file);
        let options =
            SimulateOptions { output: path, exports: ExportOptions::default(), twin: Twin::Fast, shard: None };
        simulate(scene(folder.path(), "").unwrap(), Shown::All, &options, &mut Unwatched).unwrap();
        for frame in [0, 7, 12] {
            let led = built(folder.path(), &format!("[[aim]]\nfile = \"{file}\"\nframe = {frame}\n")).unwrap();
            let AimShape::Curves(curves) = &aims(&led)[0].shape else { panic!("{file} holds curves") };
            assert_eq!(curves.frame(), Some(frame));
            for (a, b) in curves.curves().points().iter().zip(points(&plain, frame).points()) {
                // The file has world coordinates of up to 2 m, which are rounded by 2e-5 cm.
                assert!(a.distance(*b) < 1e-4, "{file}, frame {frame}: {a} {b}");
            }
        }
        let said = built(folder.path(), &format!("[[aim]]\nfile = \"{file}\"\nframe = 13\n")).map(|_| ()).unwrap_err();
        assert!(said.contains(&format!("aim[0].frame = 13: {file} has frames 0 to 12: give one of these")), "{said}");
    }
}

/// The strength is in weights of the hair on earth, and the region is found by its name.
#[test]
fn an_aim_has_its_strength_and_its_region() {
    let folder = tempfile::tempdir().unwrap();
    let led =
        built(folder.path(), "[[aim]]\ngroom = true\nregion = \"front\"\nstrength = \"2 g\"\nfrom = 3\n").unwrap();
    let aim = &aims(&led)[0];
    assert_eq!((aim.region, &aim.shape, aim.lead.from, aim.lead.through), (Some(0), &AimShape::Groom, 3, None));
    let mean: f32 = led.strands().lengths().sum::<f32>() / led.strands().len() as f32;
    let earth = nabiki::dynamics::earth_gravity(&led.dynamics, mean.into());
    // The mean length is that of a sum in another order.
    assert!((aim.lead.strength - 2.0 * earth).abs() < 1e-4 * earth, "{} {earth}", aim.lead.strength);
}

#[test]
fn another_aim_is_another_motion() {
    let folder = tempfile::tempdir().unwrap();
    let identity = |more: &str| built(folder.path(), more).unwrap().identity().unwrap();
    let toward = |point: &str| identity(&format!("[[aim]]\ntoward = {point}\n"));
    let all = [identity(""), toward("[0, 30, 0]"), toward("[0, 31, 0]"), identity("[[aim]]\ngroom = true\n")];
    for (i, a) in all.iter().enumerate() {
        assert!(all[..i].iter().all(|b| a != b), "{i}");
    }
    assert_eq!(toward("[0, 30, 0]"), identity("[[aim]]\nname = \"up\"\ntoward = [0, 30, 0]\n"));
}

/// Curves in the scene lead as the same curves in a file do.
#[test]
fn curves_may_be_in_the_scene_itself() {
    let folder = tempfile::tempdir().unwrap();
    let usda = "#usda 1.0\n(\n    metersPerUnit = 0.01\n    upAxis = \"Y\"\n)\ndef BasisCurves \"c\"\n{\n    uniform token type = \
                \"linear\"\n    int[] curveVertexCounts = [3, 2]\n    point3f[] points = [(8, 6, 0), (12, 6.5, 1), (14, 2, 1), \
                (-9, 5, 2), (-12, 9, 0)]\n}\n";
    std::fs::write(folder.path().join("c.usda"), usda).unwrap();
    let inline = "curves = [[[8, 6, 0], [12, 6.5, 1], [14, 2, 1]], [[-9, 5, 2], [-12, 9, 0]]]";
    let build = |shape: &str| built(folder.path(), &format!("[[aim]]\n{shape}\nregion = \"front\"\n")).unwrap();
    let [of_file, of_scene] = [build("file = \"c.usda\""), build(inline)];
    assert_eq!(aims(&of_file)[0].shape, aims(&of_scene)[0].shape);
    assert_eq!(of_file.identity().unwrap(), of_scene.identity().unwrap());
    let posed = build(&format!("{inline}\nframe = 3"));
    assert!(matches!(&aims(&posed)[0].shape, AimShape::Curves(curves) if curves.frame() == Some(3)));
}

#[test]
fn what_no_aim_can_be_is_refused_by_one_line() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("words.usda"), "hello").unwrap();
    for (aim, line) in [
        ("", "aim[0].file is missing: give file, curves, toward, or groom = true"),
        (
            "groom = true\ntoward = [1, 2, 3]",
            "aim[0].toward = [1, 2, 3]: an aim has one shape: give only one of file, curves, toward and groom",
        ),
        ("groom = true\nframe = 3", "aim[0].frame = 3: is for curves, and this aim has none: remove it"),
        ("groom = true\nregion = \"frnt\"", "aim[0].region = \"frnt\": there is no such region: give one of \"front\""),
        ("groom = true\nfrom = 9\nthrough = 3", "aim[0].through = 3: must not be before `from`, which is 9"),
        ("file = \"none.usda\"", "aim[0].file = \"none.usda\": there is no "),
        ("file = \"words.usda\"", "words.usda:"),
        ("groom = true\nstrength = -1", "aim[0].strength = -1"),
        (
            "file = \"a.usda\"\ncurves = [[[0, 9, 0], [0, 12, 0]]]",
            "aim[0].curves = 1 curves: an aim has one shape: give only one of file, curves, toward and groom",
        ),
        (
            "curves = [[[0, 9, 0], [0, 12, 0]], [[1, 2, 3]]]",
            "aim[0].curves[1] = 1 points: a curve has at least two points",
        ),
        ("curves = [[[0, 9, 0], [0, 9, 0]]]", "aim[0].curves has a curve without a length, number 0: remove it"),
    ] {
        let said = built(folder.path(), &format!("[[aim]]\n{aim}\n")).map(|_| ()).unwrap_err();
        assert!(said.contains(line) && !said.contains('\n'), "{said}");
    }
}

#[test]
fn aims_that_change_nothing_or_are_too_long_are_said() {
    let folder = tempfile::tempdir().unwrap();
    let said = |aim: &str| -> Vec<String> {
        let built = built(folder.path(), &format!("[[aim]]\n{aim}\n")).unwrap();
        built.advice().iter().map(ToString::to_string).filter(|line| line.contains("aim[")).collect()
    };
    assert_eq!(said("groom = true\nfrom = 3"), [""; 0]);
    let late = said("groom = true\nfrom = 40");
    assert_eq!(late, ["aim[0] changes nothing: it begins in frame 28, but the last frame is 12"]);
    let long = "#usda 1.0\n(\n    metersPerUnit = 0.01\n    upAxis = \"Y\"\n)\ndef BasisCurves \"c\"\n{\n    uniform token type = \
                \"linear\"\n    int[] curveVertexCounts = [2]\n    point3f[] points = [(0, 10, 0), (0, 90, 0)]\n}\n";
    std::fs::write(folder.path().join("long.usda"), long).unwrap();
    let said = said("file = \"long.usda\"");
    assert!(said[0].starts_with("the curves of aim[0] are 80 cm long, but the hair that it leads only "), "{said:?}");
}
