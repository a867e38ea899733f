//! No command takes what it reads for a place to write, nor drops what it could keep, without a word.

mod common;

use std::fs;

use tempfile::TempDir;

use common::{nabiki, refuse, succeed};

const GUST: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/paper/gust.toml");

/// A folder with the gust as `scene.toml` and 40 of its strands in `hair.hair`.
fn folder() -> TempDir {
    let folder = TempDir::new().unwrap();
    fs::copy(GUST, folder.path().join("scene.toml")).unwrap();
    succeed(&folder, "groom scene.toml --strands 40 -o hair.hair");
    folder
}

fn bytes(folder: &TempDir, name: &str) -> Vec<u8> {
    fs::read(folder.path().join(name)).unwrap()
}

/// A ball of 9 cm as the text of a .obj, of rows of quads.
fn ball() -> String {
    const ROWS: usize = 16;
    const COLUMNS: usize = 24;
    let (mut vertices, mut faces) = (String::new(), String::new());
    for row in 0..=ROWS {
        let down = std::f32::consts::PI * row as f32 / ROWS as f32;
        for column in 0..COLUMNS {
            let around = std::f32::consts::TAU * column as f32 / COLUMNS as f32;
            let [x, y, z] = [down.sin() * around.cos(), down.cos(), down.sin() * around.sin()].map(|x| 9.0 * x);
            vertices += &format!("v {x} {y} {z}\n");
            if row < ROWS {
                let at = |row: usize, column: usize| row * COLUMNS + column % COLUMNS + 1;
                let corners = [at(row, column), at(row, column + 1), at(row + 1, column + 1), at(row + 1, column)];
                faces += &format!("f {} {} {} {}\n", corners[0], corners[1], corners[2], corners[3]);
            }
        }
    }
    vertices + &faces
}

const FEW: &str = "--strands 40 --frames 3 --set output.sheet=[0]";

#[test]
fn a_result_that_is_also_an_input_is_refused() {
    let folder = folder();
    let scene = bytes(&folder, "scene.toml");
    #[cfg(unix)]
    for (link, to) in [("link.nabiki", "scene.toml"), ("link.usdc", "hair.hair")] {
        std::os::unix::fs::symlink(to, folder.path().join(link)).unwrap();
    }
    let imported = "hair.file=\"hair.hair\"";
    fs::write(
        folder.path().join("own.toml"),
        format!("{}\n[[force]]\nthrough = 3\nvector = [0, -1, 0]\n", imported.replace("hair.file", "hair.file ")),
    )
    .unwrap();
    let all = [
        "groom own.toml -o hair.hair".to_owned(),
        "groom own.toml -o ./hair.hair".to_owned(),
        "convert hair.hair hair.hair".to_owned(),
        #[cfg(unix)]
        format!("simulate scene.toml -o link.nabiki {FEW}"),
        #[cfg(unix)]
        "run own.toml --export link.usdc --frames 3".to_owned(),
    ];
    let hair = bytes(&folder, "hair.hair");
    for words in all {
        let line = refuse(&folder, &words);
        assert!(line.contains("this is an input of the result"), "{words}: {line}");
        assert!(bytes(&folder, "scene.toml") == scene && bytes(&folder, "hair.hair") == hair, "{words}");
    }
}

#[test]
fn simulate_writes_what_its_name_says() {
    let folder = folder();
    let said = succeed(&folder, &format!("simulate scene.toml -o moving.usdc {FEW}"));
    assert!(said.contains("moving.usdc"), "{said}");
    assert!(bytes(&folder, "moving.usdc").starts_with(b"PXR-USDC"));
    let info = succeed(&folder, "info moving.usdc");
    assert!(info.contains("frames: 4 at 24"), "{info}");
    let line = refuse(&folder, &format!("simulate scene.toml -o moving.hair {FEW}"));
    assert!(line.contains("a motion cache ends in .nabiki"), "{line}");
}

#[test]
fn names_of_results_are_refused_before_anything_is_built() {
    let folder = folder();
    // A head that is not there would be missed while building.
    let no_head = "--set head.mesh=\"nowhere.obj\"";
    for (words, why) in [
        ("run scene.toml --export moving.fbx", "moving hair is written as"),
        ("run scene.toml --export moving.abc --export-layer /Hair", "Alembic has no layers"),
        ("groom scene.toml -o hair.fbx", "is not a hair format"),
        ("simulate scene.toml -o motion.bin", "a motion cache ends in .nabiki"),
        ("simulate scene.toml -o a.usdc --export ./a.usdc", "given twice"),
        ("simulate scene.toml -o a.exr --export a.exr.glb", "a.exr.glb: given twice"),
        ("simulate scene.toml -o a.exr --export-layer /Hair", ".exr has no layers"),
        ("simulate scene.toml -o a.exr --export-springs", "export a .glb with them"),
    ] {
        let line = refuse(&folder, &format!("{words} {no_head}"));
        assert!(line.contains(why), "{words}: {line}");
    }
}

#[test]
fn segments_beyond_what_a_strand_may_have_are_refused() {
    let folder = folder();
    for (segments, words) in [
        ("1000000000", "convert hair.hair out.hair --segments"),
        ("65536", "convert hair.hair out.usdc --unit cm --segments"),
    ] {
        let line = refuse(&folder, &format!("{words} {segments}"));
        assert!(line.contains("--segments") && line.contains("must lie in 1..65535"), "{line}");
    }
    let line = refuse(&folder, "groom scene.toml -o out.hair --set hair.segments=1000000");
    assert!(line.contains("hair.segments") && line.contains("must lie in 1..65535"), "{line}");
}

#[test]
fn a_frame_that_is_not_there_is_refused() {
    let folder = folder();
    succeed(&folder, &format!("simulate scene.toml -o m.nabiki {FEW} --export m.usdc"));
    for (words, has) in [
        ("convert hair.hair out.tfx --frame 9999", "this file holds one frame, 0"),
        ("convert m.nabiki out.tfx --frame 9999", "the frames 0 to 3"),
        ("convert m.usdc out.tfx --frame 4", "the frames 0 to 3"),
    ] {
        let line = refuse(&folder, words);
        assert!(line.contains(has), "{words}: {line}");
    }
    succeed(&folder, "convert hair.hair out.tfx --frame 0 --segments 8");
}

#[test]
fn the_pose_of_a_moving_head_is_not_dropped_without_a_word() {
    let folder = folder();
    let track = "t_s,px_m,py_m,pz_m,qx,qy,qz,qw\n0,0,1.6,0,0,0,0,1\n9,0.5,1.6,0,0,0,0,1\n";
    fs::write(folder.path().join("head.csv"), track).unwrap();
    let motion = "--set head.motion={file=\"head.csv\",up=\"+y\",facing=\"+x\"}";
    succeed(&folder, &format!("simulate scene.toml -o m.nabiki {FEW} {motion}"));
    let said = succeed(&folder, "convert m.nabiki out.hair --frame 2");
    assert!(said.contains("the head's pose"), "{said}");
    for name in ["out.usda", "out.usdc", "out.abc"] {
        let said = succeed(&folder, &format!("convert m.nabiki {name} --frame 2"));
        assert!(!said.contains("pose"), "{said}");
    }
    let still = succeed(&folder, &format!("simulate scene.toml -o s.nabiki {FEW}"));
    assert!(!still.contains("pose"), "{still}");
}

#[test]
fn moving_hair_goes_on_moving_in_every_format_that_can_hold_it() {
    let folder = folder();
    succeed(&folder, &format!("simulate scene.toml -o a.usdc {FEW}"));
    for words in ["convert a.usdc b.abc", "convert b.abc c.usda --unit cm", "convert c.usda d.usdc"] {
        let said = succeed(&folder, words);
        assert!(said.contains("4 frames of 40 strands") && !said.contains("motion"), "{words}: {said}");
    }
    let still = succeed(&folder, "convert a.usdc e.hair");
    assert!(still.contains("cannot hold motion: only frame 0 of the 4"), "{still}");
    for frame in [0, 3] {
        for name in ["a.usdc", "d.usdc"] {
            succeed(&folder, &format!("convert {name} {name}.hair --frame {frame}"));
        }
        assert!(bytes(&folder, "a.usdc.hair") == bytes(&folder, "d.usdc.hair"), "frame {frame}");
    }
}

#[test]
fn frames_beyond_any_film_are_refused_at_once() {
    let folder = folder();
    for command in ["run scene.toml", "preview scene.toml", "simulate scene.toml -o m.nabiki"] {
        let line = refuse(&folder, &format!("{command} --frames 1000000000"));
        assert!(line.contains("motion.frames = 1000000000: must lie in 1..10000000"), "{command}: {line}");
    }
}

#[test]
fn a_layer_over_what_is_not_the_groom_is_refused_with_the_paths_that_are() {
    let folder = folder();
    succeed(&folder, "groom scene.toml --strands 40 -o groom.usdc");
    let scene = "[hair]\nfile = \"groom.usdc\"\njoin_within = 0.0\n[motion]\nframes = 2\n[[force]]\nthrough = 2\n\
                 vector = [0, -1, 0]\n";
    fs::write(folder.path().join("own.toml"), scene).unwrap();
    let prim = |line: &str| line[line.find("at /").unwrap() + 3..line.find(" (").unwrap()].to_owned();
    let line = refuse(&folder, "simulate own.toml -o m.nabiki --export l.usda --export-layer /nowhere");
    assert!(line.contains("--export-layer /nowhere: its curves are at /"), "{line}");
    succeed(&folder, &format!("simulate own.toml -o m.nabiki --export l.usda --export-layer {}", prim(&line)));
}

#[test]
fn a_layer_out_of_a_cache_is_checked_against_the_groom_that_the_cache_remembers() {
    let folder = folder();
    succeed(&folder, "groom scene.toml --strands 40 -o groom.usdc");
    let scene = "[hair]\nfile = \"groom.usdc\"\njoin_within = 0.0\n[motion]\nframes = 2\n[[force]]\nthrough = 2\n\
                 vector = [0, -1, 0]\n";
    fs::write(folder.path().join("own.toml"), scene).unwrap();
    succeed(&folder, "simulate own.toml -o m.nabiki");
    // The cache alone says where the curves were.
    fs::remove_file(folder.path().join("groom.usdc")).unwrap();
    let line = refuse(&folder, "convert m.nabiki l.usda --export-layer /nowhere");
    assert!(line.contains("groom.usdc: --export-layer /nowhere: its curves are at /head/hair ("), "{line}");
    succeed(&folder, "convert m.nabiki l.usda --export-layer /head/hair");
    succeed(&folder, &format!("simulate scene.toml -o grown.nabiki {FEW}"));
    let line = refuse(&folder, "convert grown.nabiki g.usda --export-layer /head/hair");
    assert!(line.contains("its hair is grown here; leave out --export-layer"), "{line}");
    let line = refuse(&folder, "simulate own.toml -o m.nabiki --export-layer /head/hair");
    assert!(line.contains("--export-layer /head/hair: also give the layer's file"), "{line}");
    let wordless = nabiki(&folder, "simulate own.toml -o i.usdc --export-layer");
    let said = String::from_utf8(wordless.stderr).unwrap();
    assert!(wordless.status.code() == Some(2) && said.contains("--export-layer <PRIM>"), "{said}");
}

#[test]
fn what_is_not_read_of_a_groom_is_said_once_whatever_is_made_of_it() {
    let folder = folder();
    let groom = "#usda 1.0\n( metersPerUnit = 0.01\n upAxis = \"Y\" )\ndef BasisCurves \"h\" { rel material:binding = </m>\n\
                 uniform token type = \"linear\"\n int[] curveVertexCounts = [2]\n point3f[] points = [(9, 1, 0), (12, 1, 0)]\n\
                 int[] primvars:groom_group_id = [4] ( interpolation = \"uniform\" ) }\n\
                 def NurbsCurves \"n\" { int[] curveVertexCounts = [2]\n point3f[] points = [(9, 1, 0), (12, 1, 0)] }\n";
    fs::write(folder.path().join("groom.usda"), groom).unwrap();
    let scene = "[hair]\nfile = \"groom.usda\"\n[motion]\nframes = 2\n[[force]]\nthrough = 2\nvector = [0, -1, 0]\n";
    fs::write(folder.path().join("own.toml"), scene).unwrap();
    for (words, name) in [
        ("groom own.toml -o", "still.abc"),
        ("simulate own.toml -o", "m.nabiki"),
        ("simulate own.toml -o", "moving.usdc"),
        ("simulate own.toml --export again.abc -o", "again.nabiki"),
        ("preview own.toml --set picture.size=[32,32] --out", "out"),
        ("render own.toml --frame 0 --set picture.size=[32,32] --out", "still"),
        ("new --hair groom.usda", "new.toml"),
        ("convert groom.usda", "other.hair"),
        ("convert groom.usda", "other.usdc"),
    ] {
        let said = succeed(&folder, &format!("{words} {name}"));
        for line in ["material:binding of /h", "NurbsCurves /n: only BasisCurves are read"] {
            let line = format!("  ignored in groom.usda: {line}\n");
            assert_eq!(said.matches(&line).count(), 1, "{words} {name}: {said}");
        }
        // A format is to blame for nothing that never came to it.
        assert!(!said.contains("cannot hold material:binding"), "{words} {name}: {said}");
    }
    let line = refuse(&folder, "convert groom.usda c.nabiki");
    assert!(line.contains("name it in a scene as hair.file and run nabiki simulate"), "{line}");
    // A part of a groom has lost nothing but strands.
    let said = succeed(&folder, "groom scene.toml --strands 2 -o few.usdc");
    assert!(!said.contains("lost"), "{said}");
}

#[test]
fn meshes_of_a_bodys_file_that_do_not_show_are_said_as_those_of_a_heads_are() {
    let folder = folder();
    let mesh = |name: &str, more: &str| {
        format!(
            "def Mesh \"{name}\" {{ point3f[] points = [(30, 0, 0), (36, 0, 0), (30, 6, 0), (30, 0, 6)]\n\
             int[] faceVertexCounts = [3, 3, 3, 3]\n int[] faceVertexIndices = [0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3]\n{more} }}\n"
        )
    };
    let hidden = "token visibility = \"invisible\"";
    let text = format!("#usda 1.0\n{}{}", mesh("hand", ""), mesh("low", hidden));
    fs::write(folder.path().join("hand.usda"), text).unwrap();
    let scene = "[motion]\nform = \"free\"\nframes = 2\n[[body]]\nmesh = \"scenes/ball.obj\"\n[[body]]\nmesh = \"hand.usda\"\n\
                 [[force]]\nthrough = 2\nvector = [0, -1, 0]\n";
    let ball = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/motion/ball.obj");
    fs::write(folder.path().join("own.toml"), scene.replace("scenes/ball.obj", ball)).unwrap();
    let said = succeed(&folder, "simulate own.toml -o m.nabiki --strands 9");
    let line = "\n  body[1] ignored in its file: mesh /low, which is hidden: visibility of /low is \"invisible\"\n";
    assert!(said.contains(line) && said.matches("ignored in its file").count() == 1, "{said}");
}

#[test]
fn a_groom_that_stands_still_has_its_points_at_rest() {
    let folder = folder();
    for name in ["groom.usdc", "groom.abc"] {
        succeed(&folder, &format!("groom scene.toml --strands 3 -o {name}"));
        let hair = nabiki_io::hair::read(&folder.path().join(name)).unwrap();
        let rest = hair.attributes.other.iter().find(|other| other.name == "rest").unwrap();
        let points = hair.strands.points().iter().flat_map(|p| p.to_array()).collect();
        assert_eq!(rest.values, nabiki::hair::Values::Floats(points), "{name}");
    }
}

#[test]
fn a_shorter_run_leaves_no_frames_of_a_longer_one() {
    let folder = folder();
    let frames = folder.path().join("out/scene_frames");
    let run = |frames: u32, kind: &str| {
        let sets = "--set picture.size=[32,32] --set output.movie=false --set output.sheet=[0]";
        succeed(&folder, &format!("run scene.toml --strands 5 --frames {frames} {sets} --set output.{kind}=true"))
    };
    run(3, "png_frames");
    run(2, "exr_frames");
    for name in ["4.png", "0004.png.old", "0005.tiff"] {
        fs::write(frames.join(name), "mine").unwrap();
    }
    fs::create_dir(frames.join("0009.png")).unwrap();
    let said = run(1, "png_frames");
    assert!(said.contains("removed 2 files of frames after 1 from out/scene_frames"), "{said}");
    let mut left: Vec<_> = fs::read_dir(&frames).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    left.sort();
    let expected =
        ["0000.exr", "0000.png", "0001.exr", "0001.png", "0002.exr", "0004.png.old", "0005.tiff", "0009.png", "4.png"];
    assert_eq!(left, expected);
}

#[test]
fn any_number_of_strands_is_the_beginning_of_the_whole() {
    let folder = folder();
    let count = |name: &str| nabiki_io::hair::read(&folder.path().join(name)).unwrap().strands;
    for strands in [1, 7] {
        succeed(&folder, &format!("groom scene.toml --strands {strands} -o few.hair"));
        let (few, more) = (count("few.hair"), count("hair.hair"));
        assert_eq!(few.len(), strands);
        assert!(few.iter().eq(more.iter().take(strands)), "the first {strands}, to the bit");
    }
    let line = refuse(&folder, "groom scene.toml --strands 100000 -o few.hair");
    assert!(line.contains("the scene has 19330") && line.contains("hair.strands = 100000"), "{line}");
}

#[test]
fn a_preview_writes_the_motion_that_it_shows() {
    let folder = folder();
    let small = "--frames 3 --set output.sheet=[0] --set picture.size=[96,64]";
    succeed(&folder, &format!("preview scene.toml --strands 20 --cache p.nabiki {small}"));
    succeed(&folder, "simulate scene.toml --strands 20 --frames 3 --set output.sheet=[0] -o s.nabiki");
    assert!(bytes(&folder, "p.nabiki") == bytes(&folder, "s.nabiki"));
}

#[test]
fn a_shorter_motion_has_a_sheet_of_the_frames_it_reaches_however_it_is_asked_for() {
    let folder = folder();
    let sheet = "[output]\nmovie = false\nsheet = [0, 2, 40]\n";
    let scene = String::from_utf8(bytes(&folder, "scene.toml")).unwrap();
    let (before, _) = scene.split_once("[output]").unwrap();
    fs::write(folder.path().join("scene.toml"), format!("{before}{sheet}")).unwrap();
    let small = "--strands 5 --set picture.size=[96,64]";
    for (name, frames) in
        [("a", "--frames 3"), ("b", "--set motion.frames=3"), ("c", "--set motion.frames=3 --set output.sheet=[0,2]")]
    {
        succeed(&folder, &format!("run scene.toml {small} {frames} --out {name}"));
    }
    assert!(bytes(&folder, "a/scene_sheet.png") == bytes(&folder, "b/scene_sheet.png"));
    assert!(bytes(&folder, "a/scene_sheet.png") == bytes(&folder, "c/scene_sheet.png"));
    let line = refuse(&folder, &format!("run scene.toml {small} --set motion.frames=3 --set output.sheet=[9] --out d"));
    assert!(
        line.contains("output.sheet[0] = 9: the last frame is motion.frames = 3; take it out of the sheet"),
        "{line}"
    );
}

#[test]
fn what_nodes_may_be_inside_of_is_what_they_are_held_against() {
    let folder = folder();
    let ball = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/motion/ball.obj");
    let body =
        format!("[[body]]\nmesh = \"{ball}\"\nwith_head = true\n\n[[force]]\nthrough = 2\nvector = [0, -1, 0]\n");
    for (form, said) in [("paper", "inside the head at frame"), ("free", "inside the head or a body at frame")] {
        fs::write(folder.path().join("b.toml"), format!("[motion]\nform = \"{form}\"\nframes = 2\n{body}")).unwrap();
        let told = succeed(&folder, "simulate b.toml -o b.nabiki --strands 9 --set free.stiffness=[1000,100]");
        assert!(told.contains(said), "{told}");
    }
}

#[test]
fn the_head_goes_into_an_archive_that_is_the_result_itself_and_nowhere_unasked() {
    let folder = folder();
    let faces = |name: &str| succeed(&folder, &format!("info {name}")).contains(" faces");
    succeed(&folder, &format!("simulate scene.toml {FEW} -o with.abc --export-head"));
    succeed(&folder, &format!("simulate scene.toml {FEW} -o without.abc"));
    assert!(faces("with.abc") && !faces("without.abc"));
    // The built-in one is everybody's.
    succeed(&folder, &format!("simulate scene.toml {FEW} -o m.nabiki --export with.usdc --export-head"));
    succeed(&folder, &format!("simulate scene.toml {FEW} -o without.usdc"));
    assert!(faces("with.usdc") && !faces("without.usdc"));
    fs::write(folder.path().join("own.obj"), ball()).unwrap();
    let own = "--set head.mesh=own.obj --set head.ellipsoid={center=[0,0,0],half_axes=[9,9,9]}";
    succeed(&folder, &format!("simulate scene.toml {FEW} {own} -o own.usdc"));
    succeed(&folder, &format!("simulate scene.toml {FEW} {own} -o own.abc"));
    assert!(faces("own.usdc") && !faces("own.abc"));
    let line = refuse(&folder, &format!("simulate scene.toml {FEW} -o m.nabiki --export-head"));
    assert!(line.contains("--export-head: adds the head to moving hair, but none is written"), "{line}");
}

#[test]
fn the_summary_says_the_worst_frame() {
    let folder = folder();
    let said = succeed(&folder, "simulate scene.toml --strands 200 -o m.nabiki");
    assert!(said.contains(", at most ") && said.contains("the deepest"), "{said}");
}

#[test]
fn what_no_disk_holds_is_refused_at_once() {
    let folder = folder();
    let line = refuse(&folder, "simulate scene.toml -o m.nabiki --frames 9000000 --set output.sheet=[0]");
    assert!(line.contains("TiB, but the disk has"), "{line}");
    let stills = "--set picture.size=[8192,8192] --set output.movie=false --set output.exr_frames=true";
    let line = refuse(&folder, &format!("run scene.toml --strands 5 --frames 9000000 --set output.sheet=[0] {stills}"));
    assert!(line.contains("scene_frames: needs at least") && line.contains("TiB"), "{line}");
    assert!(!folder.path().join("m.nabiki").exists());
}

#[test]
fn what_a_file_says_of_its_space_is_not_overridden() {
    let folder = folder();
    for unit in ["-1", "nan", "inf", "0", "1e39"] {
        let line = refuse(&folder, &format!("convert hair.hair out.usda --unit={unit}"));
        assert!(line.contains("--unit = ") && line.contains("must be a finite number above 0"), "{line}");
    }
    succeed(&folder, "convert hair.hair y.usda --unit cm");
    succeed(&folder, "convert hair.hair z.usda --unit cm --z-up");
    let line = refuse(&folder, "convert y.usda out.usdc --z-up");
    assert_eq!(line, "nabiki: y.usda: --z-up: the file already has +y; leave out --z-up\n");
    let line = refuse(&folder, "convert y.usda out.usdc --unit m");
    assert_eq!(line, "nabiki: y.usda: --unit m: the file already has cm; leave out --unit\n");
    // Where nothing can be said of it that is said in turn.
    for (output, option) in [("x.hair", "--unit=m"), ("y.hair", "--z-up"), ("x.abc", "--z-up")] {
        let said = succeed(&folder, &format!("convert hair.hair {output} {option}"));
        let option = option.trim_end_matches("=m");
        assert!(said.contains(&format!("  warning {option} changes nothing: {output} names neither")), "{said}");
    }
    // What agrees says nothing new.
    succeed(&folder, "convert z.usda same.usdc --z-up");
    // An archive does not say.
    succeed(&folder, "convert hair.hair still.abc");
    succeed(&folder, "convert still.abc z.usdc --unit cm --z-up");
    succeed(&folder, &format!("simulate scene.toml -o m.nabiki {FEW}"));
    for option in ["--z-up", "--unit=m"] {
        let line = refuse(&folder, &format!("convert m.nabiki out.usdc {option}"));
        assert!(line.contains("a motion cache knows its unit and axes; leave --"), "{line}");
    }
    assert!(!folder.path().join("out.usdc").exists());
}

#[test]
fn pictures_are_written_as_the_scene_asks_or_refused() {
    let folder = folder();
    let small = "--strands 40 --set picture.size=[64,48] --set output.exr_frames=true";
    succeed(&folder, &format!("render scene.toml --frame 2 --out one {small}"));
    assert!(folder.path().join("one/scene_0002.png").exists() && folder.path().join("one/scene_0002.exr").exists());
    let stills = |name: &str| {
        let there = fs::read_dir(folder.path().join(name).join("scene_frames")).unwrap();
        let mut names: Vec<String> = there.map(|file| file.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    };
    succeed(&folder, &format!("render scene.toml --frames 2..2 --out run {small}"));
    assert_eq!(stills("run"), ["0002.exr", "0002.png"]);
    succeed(&folder, &format!("render scene.toml --frames 2..2 --out light {small} --set output.movie=false"));
    assert_eq!(stills("light"), ["0002.exr"]);
    let none = "--set output.movie=false --set output.sheet=[]";
    for command in ["run", "preview", "render"] {
        let line = refuse(&folder, &format!("{command} scene.toml --strands 40 --frames 2 --out none {none}"));
        assert!(line.contains("nothing to write: output.movie, png_frames"), "{line}");
        assert!(!folder.path().join("none").exists());
    }
}

#[test]
fn segments_of_a_whole_motion_are_refused_and_so_is_a_file_for_a_farms_results() {
    let folder = folder();
    succeed(&folder, &format!("simulate scene.toml -o m.nabiki {FEW}"));
    let line = refuse(&folder, "convert m.nabiki m.usda --segments 3");
    assert!(
        line.contains("m.nabiki: --segments 3: all frames of a motion cache") && line.contains("--frame N"),
        "{line}"
    );
    succeed(&folder, "convert m.nabiki m.hair --segments 3 --frame 1");
    let line = refuse(&folder, "farm scene.toml --engine openjd -o job.yaml --out hair.hair");
    assert!(line.contains("hair.hair: this is a file, not a folder"), "{line}");
    assert!(!folder.path().join("job.yaml").exists());
}
