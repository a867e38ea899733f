//! Hair from another tool comes back in that tool's own space, straight from the simulation or out of a cache.

mod common;

use std::fs;
use std::path::Path;

use glam::Vec3;
use nabiki::{Hair, Strands};
use nabiki_io::Axis;
use nabiki_io::Unit;
use nabiki_io::exchange::{self, DeclaredSpace};
use nabiki_io::hair;

use common::{refuse, succeed};

const SAID: DeclaredSpace = DeclaredSpace { unit: Some(Unit { cm: 100.0 }), up: Some(Axis::PlusZ) };

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
        assert_eq!(exchange::declared_space(&path).unwrap(), SAID, "{name}");
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

// Grown hair and hair of a file, on a head that is moved about its own world: one frame stands where the frame of all stands.
#[test]
fn one_frame_of_a_moving_head_stands_where_it_stands_among_all() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    groom(folder);
    fs::write(
        folder.join("grown.toml"),
        "[hair]\nstrands = 20\n\n[motion]\nframes = 3\n\n[[force]]\nthrough = 3\nvector = [-10, 0, 0]\n",
    )
    .unwrap();
    let track = "t_s,px_m,py_m,pz_m,qx,qy,qz,qw\n0,0,1.6,0,0,0,0,1\n0.125,0.5,1.7,-0.2,0,0.6,0,0.8\n";
    fs::write(folder.join("head.csv"), track).unwrap();
    for scene in ["scene.toml", "grown.toml"] {
        for at_origin in [false, true] {
            let motion =
                format!("head.motion={{file=\"head.csv\",up=\"+y\",facing=\"+x\",start_at_origin={at_origin}}}");
            succeed(folder, &format!("simulate {scene} -o m.nabiki --set {motion}"));
            for ending in ["usda", "usdc", "abc"] {
                succeed(folder, &format!("convert m.nabiki all.{ending}"));
                for frame in [0, 2] {
                    succeed(folder, &format!("convert m.nabiki pose.{ending} --frame {frame}"));
                    let among = exchange::hair(&folder.join(format!("all.{ending}")), frame, None).unwrap();
                    let alone = hair::read(&folder.join(format!("pose.{ending}"))).unwrap();
                    assert_eq!(alone.strands.starts(), among.strands.starts());
                    let points = alone.strands.points().iter().zip(among.strands.points());
                    let apart = points.map(|(p, q)| p.distance(*q)).fold(0.0, f32::max);
                    // The points are rounded in the space of the file and again where they stand.
                    let size = among.strands.points().iter().fold(1.0, |size, p| p.abs().max_element().max(size));
                    assert!(apart <= 2.0 * size * f32::EPSILON, "{scene} {ending} {frame}: {apart}");
                    succeed(folder, &format!("convert m.nabiki head.hair --frame {frame}"));
                    let on_head = hair::read(&folder.join("head.hair")).unwrap();
                    let pairs = alone.strands.points().iter().zip(on_head.strands.points());
                    let moved = pairs.map(|(p, q)| p.distance(*q)).fold(0.0, f32::max);
                    // By 0.35 m from the first frame to this one, in either unit.
                    assert!(frame == 0 || moved > 0.1, "{scene} {ending}: the head's place is in the file");
                }
            }
        }
    }
}

/// Two strands below a transform, whose points are in its space.
const BELOW: &str = "#usda 1.0
( metersPerUnit = 0.01
 upAxis = \"Y\" )
def Xform \"root\" {
 double3 xformOp:translate = (3, 150, -40)
 float xformOp:rotateX = 70
 float3 xformOp:scale = (2, 2, 2)
 uniform token[] xformOpOrder = [\"xformOp:translate\", \"xformOp:rotateX\", \"xformOp:scale\"]
 def BasisCurves \"h\" {
  uniform token type = \"linear\"
  int[] curveVertexCounts = [3, 3]
  point3f[] points = [(0, 6, 0), (0, 7.5, 0), (0, 9, 1), (-1.5, 5.5, 0), (-2, 7, 0), (-2.5, 8.5, 1)]
 }
}
";

#[test]
fn over_a_groom_at_rest_a_layer_has_its_own_points_whatever_stands_above_them() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("groom.usda"), BELOW).unwrap();
    let scene = "[hair]\nfile = \"groom.usda\"\norigin = [3, 150, -40]\njoin_within = 0\n\n[motion]\nframes = 2\n\n\
                 [[force]]\nthrough = 2\nvector = [-1, 0, 0]\n";
    fs::write(folder.join("scene.toml"), scene).unwrap();
    succeed(folder, "simulate scene.toml -o m.nabiki --export direct.usda --export-layer /root/h");
    succeed(folder, "convert m.nabiki later.usda --export-layer /root/h");
    let numbers = |text: &str| -> Vec<f32> {
        let (points, _) = text.split_once(']').unwrap();
        points.split(['(', ')', ',', ' ']).filter(|word| !word.is_empty()).map(|word| word.parse().unwrap()).collect()
    };
    let own = numbers(BELOW.split_once("points = [").unwrap().1);
    for name in ["direct.usda", "later.usda"] {
        let layer = fs::read_to_string(folder.join(name)).unwrap();
        let (_, samples) = layer.split_once("points.timeSamples").unwrap();
        let written = numbers(samples.split_once('[').unwrap().1);
        assert_eq!(written.len(), own.len(), "{name}");
        for (a, b) in written.iter().zip(&own) {
            // Through the world and back: a few roundings of 150 cm, of which the scale halves one.
            assert!((a - b).abs() < 4.0 * 150.0 * f32::EPSILON, "{name}: {written:?}");
        }
    }
}

#[test]
fn a_kilometre_away_a_layer_has_the_points_that_it_has_at_home() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let layer = |place: &str, origin: &str, name: &str| {
        fs::write(folder.join("groom.usda"), BELOW.replace("(3, 150, -40)", place)).unwrap();
        let scene = format!(
            "[hair]\nfile = \"groom.usda\"\norigin = {origin}\njoin_within = 0\n\n[motion]\nframes = 2\n\n\
             [[force]]\nthrough = 2\nvector = [-1, 0, 0]\n"
        );
        fs::write(folder.join("scene.toml"), scene).unwrap();
        succeed(folder, &format!("simulate scene.toml -o m.nabiki --export {name}.usda --export-layer /root/h"));
        succeed(folder, "convert m.nabiki later.usda --export-layer /root/h");
        [format!("{name}.usda"), "later.usda".to_owned()].map(|name| {
            let text = fs::read_to_string(folder.join(name)).unwrap();
            let (_, samples) = text.split_once("points.timeSamples = {").unwrap();
            let (samples, _) = samples.split_once('}').unwrap();
            samples
                .split(['(', ')', ',', ' ', '[', ']', '\n'])
                .filter_map(|word| word.parse().ok())
                .collect::<Vec<f32>>()
        })
    };
    // As far from the origin in both: 12 cm aside of it, and 0.789 cm behind it.
    let near = layer("(12, 150, -0.789)", "[0, 150, 0]", "near");
    let far = layer("(100012, 150, -123456.789)", "[100000, 150, -123456]", "far");
    for (near, far) in near.iter().zip(&far) {
        assert_eq!((near.len(), far.len()), (3 * 18, 3 * 18));
        for (a, b) in near.iter().zip(far) {
            // Two roundings in head space, of numbers below 32 cm, and what the motion makes of them.
            assert!((a - b).abs() < 8.0 * 32.0 * f32::EPSILON, "{near:?} {far:?}");
        }
    }
}

/// A shot that begins at time code 1001 goes on there: a layer that began at 0 would show its last frame all the time.
#[test]
fn what_goes_back_stands_on_the_time_line_of_the_shot() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let moving = BELOW.replace(
        "double3 xformOp:translate = (3, 150, -40)",
        "double3 xformOp:translate.timeSamples = {1001: (3, 150, -40), 1004: (6, 150, -40)}",
    );
    fs::write(folder.join("shot.usda"), moving).unwrap();
    let scene = "[hair]\nfile = \"shot.usda\"\norigin = [3, 150, -40]\njoin_within = 0\n\n[head.motion]\nfile = \"shot.usda\"\n\
                 node = \"/root\"\nup = \"+y\"\nfacing = \"+x\"\n\n[motion]\nframes = 3\n\n[[force]]\nthrough = 3\nvector = [-1, 0, 0]\n";
    fs::write(folder.join("scene.toml"), scene).unwrap();
    succeed(folder, "simulate scene.toml -o m.nabiki --export direct.usda --export-layer /root/h --export whole.usdc");
    succeed(folder, "simulate scene.toml -o n.nabiki --export whole.usda --set picture.hair.width=0.02");
    succeed(folder, "convert m.nabiki later.usda --export-layer /root/h");
    succeed(folder, "convert m.nabiki other.usda --first-frame -5");
    succeed(folder, "simulate scene.toml -o n.nabiki --export said.usda --set output.first_frame=40");
    for (name, first) in [("direct.usda", 1001), ("later.usda", 1001), ("other.usda", -5), ("said.usda", 40)] {
        let text = fs::read_to_string(folder.join(name)).unwrap();
        assert!(text.contains(&format!("startTimeCode = {first}\n")), "{name}: {}", &text[..300]);
        for (n, there) in [(first - 1, false), (first, true), (first + 3, true), (first + 4, false)] {
            assert_eq!(text.contains(&format!(" {n}: [")), there, "{name}: frame {n}");
        }
        // What the groom says of how its own points move is not true of these.
        let blocked = ["velocities", "accelerations"].map(|name| text.contains(&format!("vector3f[] {name} = None")));
        assert_eq!(blocked, [["direct.usda", "later.usda"].contains(&name); 2], "{name}");
    }
    // A file of its own takes the hair the node's way, a centimetre a frame: from where it lay, as the head began turned.
    let whole = fs::read_to_string(folder.join("whole.usda")).unwrap();
    let later = fs::read_to_string(folder.join("other.usda")).unwrap();
    for (stage, first) in [(&whole, 1001), (&later, -5)] {
        for n in 0..=3 {
            let there = |line: &str| line.trim().starts_with(&format!("{}: ( (1, 0, 0, 0)", first + n));
            let placed = stage.lines().find(|line| there(line)).unwrap();
            // About the node, at 150 and -40: 150 - (150 cos 70 + 40 sin 70 degrees).
            assert!(placed.contains(&format!(", ({n}, 61.1")), "{placed}");
        }
    }
    assert!(whole.contains("float[] widths = [0.02, 0.02, 0.02, 0.02, 0.02, 0.02]"), "{whole}");
    let refused = refuse(folder, "convert m.nabiki x.usda --first-frame 10000001");
    assert!(refused.contains("--first-frame = 10000001: must lie in -10000000..10000000"), "{refused}");
}

#[test]
fn where_the_head_is_of_no_shot_the_grooms_file_says_when_the_shot_begins() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let scene = |hair: &str| {
        let rest = "[motion]\nframes = 2\nframe_rate = 48\n\n[[force]]\nthrough = 2\nvector = [-1, 0, 0]\n";
        format!("[hair]\nfile = \"{hair}\"\norigin = [3, 150, -40]\njoin_within = 0\n\n{rest}")
    };
    let begins = |metadata: &str, points: &str, more: &str| {
        let groom = BELOW.replace("upAxis = \"Y\"", &format!("upAxis = \"Y\"\n{metadata}"));
        let still = "points = [(0, 6, 0), (0, 7.5, 0), (0, 9, 1), (-1.5, 5.5, 0), (-2, 7, 0), (-2.5, 8.5, 1)]";
        assert!(groom.contains(still));
        let samples = |codes: &str| {
            let all = codes.split(' ').map(|code| format!("{code}: {}, ", still.trim_start_matches("points = ")));
            format!("points.timeSamples = {{ {} }}", all.collect::<String>())
        };
        let groom = if points.is_empty() { groom } else { groom.replace(still, &samples(points)) };
        fs::write(folder.join("groom.usda"), groom).unwrap();
        fs::write(folder.join("scene.toml"), scene("groom.usda")).unwrap();
        fs::write(folder.join("way.csv"), "t_s,px_cm,py_cm,pz_cm,qx,qy,qz,qw\n0,0,0,0,0,0,0,1\n1,20,0,0,0,0,0,1\n")
            .unwrap();
        succeed(folder, &format!("simulate scene.toml -o m.nabiki --export l.usda --export l.abc{more}"));
        succeed(folder, "convert m.nabiki later.usda");
        let start = |name: &str| -> f64 {
            let text = fs::read_to_string(folder.join(name)).unwrap();
            let (_, start) = text.split_once("startTimeCode = ").unwrap();
            start.split_once('\n').unwrap().0.parse().unwrap()
        };
        assert_eq!(start("l.usda"), start("later.usda"));
        start("l.usda")
    };
    // 24 codes a second, 48 frames a second.
    assert_eq!(begins("startTimeCode = 1001", "", ""), 2002.0);
    assert_eq!(begins("startTimeCode = 1001\ntimeCodesPerSecond = 48", "", ""), 1001.0);
    assert_eq!(
        begins("startTimeCode = 1001", "", " --set head.motion={file=\"way.csv\",up=\"+y\",facing=\"+x\"}"),
        2002.0
    );
    assert_eq!(begins("startTimeCode = 1001", "", " --set output.first_frame=0"), 0.0);
    // The hair that is read is that of the first sample of several.
    assert_eq!(begins("startTimeCode = 1001", "990 991 992", ""), 1980.0);
    assert_eq!(begins("", "7", ""), 0.0);
    assert_eq!(begins("startTimeCode = 1e300", "", ""), 0.0);
    // An archive stands in time by its samples.
    begins("startTimeCode = 60", "", "");
    let archive = scene("l.abc").replace("join_within", "unit = \"cm\"\njoin_within");
    fs::write(folder.join("archive.toml"), archive).unwrap();
    succeed(folder, "simulate archive.toml -o n.nabiki --export n.usda");
    assert!(fs::read_to_string(folder.join("n.usda")).unwrap().contains("startTimeCode = 120\n"));
}

#[test]
fn what_a_layer_cannot_hold_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let cubic = BELOW.replace("\"linear\"", "\"cubic\"\n  uniform token basis = \"bspline\"");
    let cubic = cubic.replace("[3, 3]", "[6]");
    fs::write(folder.join("groom.usda"), cubic).unwrap();
    fs::write(folder.join("way.csv"), "t_s,px_cm,py_cm,pz_cm,qx,qy,qz,qw\n0,0,0,0,0,0,0,1\n1,20,0,0,0,0,0,1\n")
        .unwrap();
    let scene = "[hair]\nfile = \"groom.usda\"\norigin = [3, 150, -40]\n\n[head.motion]\nfile = \"way.csv\"\nup = \"+y\"\n\
                 facing = \"+x\"\n\n[motion]\nframes = 2\n\n[[force]]\nthrough = 2\nvector = [-1, 0, 0]\n";
    fs::write(folder.join("scene.toml"), scene).unwrap();
    let direct = succeed(folder, "simulate scene.toml -o m.nabiki --export direct.usda --export-layer /root/h");
    let later = succeed(folder, "convert m.nabiki later.usda --export-layer /root/h");
    // Curves that run as the groom's do go through the points, so that nothing of these is lost.
    let points = |name: &str| {
        let text = fs::read_to_string(folder.join(name)).unwrap();
        // Widths of pictures, which a cache has not, are in the boxes.
        text.split("float3[] extent").next().unwrap().to_owned()
    };
    assert_eq!(points("direct.usda"), points("later.usda"));
    for (said, name) in [(direct, "direct"), (later, "later")] {
        assert_eq!(said.matches("lost").count(), 1, "{said}");
        assert!(said.contains(&format!("{name}.usda cannot hold the motion of the head")), "{said}");
    }
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
    let unit = |file: &str| format!("  lost    {file} cannot hold its unit: set hair.unit = 100 when you read it\n");
    let up = |file: &str| format!("  lost    {file} cannot hold its up axis: set hair.up = \"+z\" when you read it\n");
    let said = succeed(folder, "convert groom.usdc groom.hair");
    let ids = "  lost    groom.hair cannot hold strand ids\n".to_owned();
    let wrote = "  wrote   groom.hair: 20 strands\n";
    assert_eq!(said, ids + &unit("groom.hair") + &up("groom.hair") + wrote);
    let said = succeed(folder, "convert groom.usdc groom.tfx");
    let points = "groom.tfx cannot hold 5 points per strand for TressFX itself, which loads 4, 8, 16, 32 or 64";
    assert!(said.contains(points) && said.contains("strand ids"), "{said}");
    let said = succeed(folder, "convert groom.usdc groom.abc");
    assert_eq!(said, unit("groom.abc") + &up("groom.abc") + "  wrote   groom.abc: 20 strands\n");
    assert_eq!(succeed(folder, "convert groom.usdc again.usda"), "  wrote   again.usda: 20 strands\n");

    succeed(folder, "simulate scene.toml -o m.nabiki --export m.abc");
    let said = succeed(folder, "convert m.abc still.usda --unit m --frame 3");
    assert_eq!(
        said,
        "  lost    still.usda cannot hold motion: only frame 3 of the 4 in m.abc is kept\n  wrote   still.usda: 20 strands\n"
    );
    let said = succeed(folder, "convert m.nabiki m2.abc");
    assert_eq!(said, unit("m2.abc") + &up("m2.abc") + "  wrote   m2.abc: 4 frames of 20 strands\n");
}
