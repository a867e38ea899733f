//! Scenes that are wanted no more while they are built.

use std::fmt::Write;
use std::sync::atomic::{AtomicUsize, Ordering};

use nabiki_scene::{BuiltScene, Error, Scene, Shown};

const BOX: &str = "v 30 0 0\nv 33 0 0\nv 30 3 0\nv 30 0 3\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

/// Strands that stand on a circle round the head, as the lines of an .obj.
fn hair() -> String {
    let mut text = String::new();
    for s in 0..60 {
        let turn = s as f32 * std::f32::consts::TAU / 60.0;
        for node in 0..4 {
            let reach = 12.0 + node as f32;
            writeln!(text, "v {} 3 {}", reach * turn.cos(), reach * turn.sin()).unwrap();
        }
        let first = 4 * s + 1;
        writeln!(text, "l {} {} {} {}", first, first + 1, first + 2, first + 3).unwrap();
    }
    text
}

/// Builds it, going on so many times; how often it was asked whether to.
fn built(scene: &Scene, times: usize) -> (Result<BuiltScene, Error>, usize) {
    let asked = AtomicUsize::new(0);
    let goes_on = |part: f32| {
        assert!((0.0..=1.0).contains(&part), "{part}");
        asked.fetch_add(1, Ordering::Relaxed) < times
    };
    (scene.clone().build_while(Shown::AtMost(40), &[], &goes_on), asked.into_inner())
}

#[test]
fn a_scene_is_given_up_wherever_it_is_asked_whether_it_is_wanted() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("hair.obj"), hair()).unwrap();
    std::fs::write(folder.path().join("box.obj"), BOX).unwrap();
    let lies = "unit = \"cm\"\nup = \"+y\"\nfacing = \"+x\"\norigin = [0, 0, 0]\n";
    let rest = format!("[motion]\nform = \"free\"\nframes = 2\n[[body]]\nmesh = \"box.obj\"\n{lies}");
    let imported = format!("[hair]\nfile = \"hair.obj\"\nsegments = 3\nstrands = 50\n{lies}{rest}");
    let grown = format!("[hair]\nstrands = 600\n{rest}");
    // One thread asks alone.
    let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    // The head, then the file and its hair, or the roots and what grows of them, then the body.
    for (text, least) in [(imported, 4), (grown, 4)] {
        let scene = Scene::parse(&text, &folder.path().join("a.toml"), &[]).unwrap();
        alone.install(|| {
            let (whole, times) = built(&scene, usize::MAX);
            assert!(times >= least, "it is asked {times} times: {text}");
            let whole = whole.unwrap().groom.hair.clone();
            assert_eq!(whole, scene.clone().build(Shown::AtMost(40)).unwrap().groom.hair);
            for goes_on in 0..times {
                let (given_up, asked) = built(&scene, goes_on);
                assert!(matches!(given_up, Err(Error::Cancelled)), "{goes_on} of {times}: {text}");
                assert_eq!(asked, goes_on + 1, "{text}");
            }
            assert_eq!(built(&scene, times).0.unwrap().groom.hair, whole);
        });
    }
}
