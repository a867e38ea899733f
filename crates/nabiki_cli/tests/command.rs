//! The command `nabiki` as a user meets it: what it writes, what it refuses, and in which words.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use tempfile::TempDir;

const GUST: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/paper/gust.toml");

fn nabiki(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_nabiki")).args(arguments).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

fn succeed(arguments: &[&str]) -> String {
    let output = nabiki(arguments);
    assert!(output.status.success(), "{arguments:?}: {}", text(&output.stderr));
    text(&output.stdout)
}

/// The one line of a refusal, which leaves nothing behind in `folder`.
fn refuse(arguments: &[&str], folder: &Path) -> String {
    let before = names(folder);
    let output = nabiki(arguments);
    let line = text(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{arguments:?}: {line}");
    assert_eq!(line.trim_end().lines().count(), 1, "one line: {line}");
    assert!(line.starts_with("nabiki: "), "{line}");
    assert_eq!(names(folder), before, "{arguments:?} leaves nothing behind");
    line
}

fn names(folder: &Path) -> Vec<PathBuf> {
    let mut names: Vec<PathBuf> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    names.sort();
    names
}

fn path(folder: &TempDir, name: &str) -> String {
    folder.path().join(name).to_str().unwrap().to_owned()
}

/// A scene file of the gust with `change` put after it.
fn scene_with(folder: &TempDir, from: &str, to: &str) -> String {
    let gust = fs::read_to_string(GUST).unwrap();
    assert!(gust.contains(from), "{from}");
    let file = path(folder, "scene.toml");
    fs::write(&file, gust.replacen(from, to, 1)).unwrap();
    file
}

const SMALL: [&str; 6] = ["--strands", "60", "--frames", "4", "--set", "picture.size=[96,64]"];

#[test]
fn run_writes_a_movie_and_a_contact_sheet() {
    let folder = TempDir::new().unwrap();
    let out = path(&folder, "out");
    let said = succeed(&[&["run", GUST, "--out", &out, "--set", "output.sheet=[0,2,4]"][..], &SMALL].concat());
    for (name, magic) in [("gust.mp4", &b"ftyp"[..]), ("gust_sheet.png", b"PNG")] {
        let bytes = fs::read(Path::new(&out).join(name)).unwrap();
        assert!(bytes.windows(magic.len()).take(16).any(|w| w == magic), "{name}");
        assert!(said.contains(name), "{said}");
    }
    assert!(said.contains("% of the nodes are inside the head"), "{said}");
    assert_eq!(names(Path::new(&out)).len(), 2);
}

#[test]
fn preview_says_how_long_a_swing_takes_before_it_steps() {
    let folder = TempDir::new().unwrap();
    let said = succeed(&[
        "preview",
        GUST,
        "--strands",
        "20",
        "--frames",
        "2",
        "--out",
        &path(&folder, "out"),
        "--set",
        "hair.strands=200",
        "--set",
        "output.sheet=[0]",
        "--set",
        "picture.size=[96,64]",
    ]);
    let (swing, wrote) = (said.find("swing").unwrap(), said.find("wrote").unwrap());
    assert!(swing < wrote, "{said}");
    assert!(said.contains("20 strands"), "{said}");
}

#[test]
fn a_cache_draws_the_frames_that_the_simulation_would() {
    let folder = TempDir::new().unwrap();
    let (cache, direct, cached) = (path(&folder, "m.nabiki"), path(&folder, "a"), path(&folder, "b"));
    let changes = ["--frames", "4", "--strands", "60", "--set", "picture.size=[96,64]", "--set", "output.sheet=[0]"];
    succeed(&[&["simulate", GUST, "-o", &cache][..], &changes].concat());
    succeed(&[&["render", GUST, "--frame", "4", "--out", &direct][..], &changes].concat());
    succeed(&[&["render", GUST, "--frame", "4", "--motion", &cache, "--out", &cached][..], &changes].concat());
    let picture = |folder: &str| fs::read(Path::new(folder).join("gust_0004.png")).unwrap();
    assert!(picture(&direct) == picture(&cached));

    // A film of its first frames is framed by these alone: hair that flies later makes room for itself in a longer one only.
    let (longer, whole) = (path(&folder, "longer.nabiki"), path(&folder, "c"));
    let frames = |count: &'static str| [&["--frames", count], &changes[2..]].concat();
    succeed(&[&["simulate", GUST, "-o", &longer][..], &frames("40")].concat());
    let framed = ["--set", "picture.camera={azimuth=50,elevation=4}", "--out"];
    let render = [&["render", GUST, "--motion", &longer][..], &framed].concat();
    succeed(&[&["run", GUST][..], &framed, &[&direct], &changes].concat());
    succeed(&[&render[..], &[&cached], &changes].concat());
    succeed(&[&render[..], &[&whole], &frames("40")].concat());
    let sheet = |folder: &str| fs::read(Path::new(folder).join("gust_sheet.png")).unwrap();
    assert!(sheet(&direct) == sheet(&cached));
    assert!(sheet(&direct) != sheet(&whole));

    let other = refuse(
        &[&["render", GUST, "--motion", &cache, "--out", &cached, "--set", "motion.time_step=0.2"][..], &changes]
            .concat(),
        folder.path(),
    );
    assert!(other.contains("m.nabiki: its motion was not made from"), "{other}");
}

#[test]
fn a_frame_of_a_cache_becomes_a_hair_file() {
    let folder = TempDir::new().unwrap();
    let (cache, hair, back) = (path(&folder, "m.nabiki"), path(&folder, "f.hair"), path(&folder, "f.tfx"));
    succeed(&["simulate", GUST, "-o", &cache, "--strands", "40", "--frames", "3", "--set", "output.sheet=[0]"]);
    succeed(&["convert", &cache, "--frame", "3", &hair]);
    assert!(succeed(&["info", &hair]).contains("40"), "the strands are counted");
    let json = succeed(&["info", "--json", &hair]);
    assert!(json.trim_start().starts_with('{'), "{json}");
    let whole = refuse(&["convert", &cache, &back], folder.path());
    assert!(whole.contains("--frame N"), "{whole}");
    let beyond = refuse(&["convert", &cache, "--frame", "4", &back], folder.path());
    assert!(beyond.contains("m.nabiki"), "{beyond}");
}

#[test]
fn both_twins_simulate() {
    let folder = TempDir::new().unwrap();
    for stepper in ["f64", "fast"] {
        let cache = path(&folder, &format!("{stepper}.nabiki"));
        let scene = ["simulate", GUST, "-o", &cache, "--stepper", stepper, "--strands", "30", "--frames", "4"];
        succeed(&[&scene[..], &["--set", "output.sheet=[0]"]].concat());
    }
    let sizes: Vec<u64> = names(folder.path()).iter().map(|file| fs::metadata(file).unwrap().len()).collect();
    assert_eq!(sizes[0], sizes[1]);
}

#[test]
fn any_number_of_threads_writes_the_same_files() {
    let folder = TempDir::new().unwrap();
    let run = |threads: &str| {
        let out = path(&folder, threads);
        let run = ["run", GUST, "--threads", threads, "--out", &out, "--set", "output.sheet=[0,4]"];
        succeed(&[&run[..], &SMALL].concat());
        ["gust.mp4", "gust_sheet.png"].map(|name| fs::read(Path::new(&out).join(name)).unwrap())
    };
    assert!(run("1") == run("3"));
}

#[test]
fn settings_that_cannot_be_are_refused_with_file_line_and_way_out() {
    let folder = TempDir::new().unwrap();
    let out = path(&folder, "out.nabiki");
    for (from, to, words) in [
        ("time_step = 0.1", "time_step = 0", &["scene.toml:", "motion.time_step", "above 0"][..]),
        ("time_step = 0.1", "time_stpe = 0.1", &["time_stpe", "did you mean", "time_step"]),
        ("linear_density = 0.05", "linear_density = -1", &["motion.linear_density = -1"]),
        ("alpha = -0.75", "alpha = 1.5", &["pseudo_force.alpha = 1.5", "-1..1"]),
        ("[0.01, 0.01,", "[0.01, 1.2,", &["pseudo_force.coefficients[1] = 1.2"]),
        ("through = 100", "through = 40", &["force[1].through = 40", "after frame 50"]),
        ("strands = 19330", "strands = 0", &["hair.strands = 0"]),
        ("segment_length = 1.0", "segment_length = nan", &["hair.segment_length"]),
        ("size = [960, 540]", "size = [0, 540]", &["picture.size"]),
        ("vector = [-100, 0, 0]", "vector = [-1e9, 0, 0]", &["force[0].vector", "keep |F| below"]),
        ("mesh = \"builtin:bust\"", "mesh = \"missing.obj\"", &["missing.obj"]),
        ("frames = 100", "frames = \"many\"", &["motion.frames"]),
    ] {
        let scene = scene_with(&folder, from, to);
        let line = refuse(&["simulate", &scene, "-o", &out], folder.path());
        for word in words {
            assert!(line.contains(word), "{to}: {line}");
        }
    }
}

#[test]
fn files_that_cannot_be_are_refused_by_name() {
    let folder = TempDir::new().unwrap();
    let file = |name: &str, bytes: &[u8]| {
        let file = path(&folder, name);
        fs::write(&file, bytes).unwrap();
        file
    };
    let out = path(&folder, "out.hair");
    let missing = path(&folder, "missing.hair");
    let mut lying = b"HAIR".to_vec();
    lying.extend([u32::MAX, u32::MAX, 2, 15].iter().flat_map(|n| n.to_le_bytes()));
    lying.resize(128, 0);
    for name in [
        missing,
        file("empty.hair", b""),
        file("short.hair", b"HAIR"),
        file("lying.hair", &lying),
        file("noise.tfx", &[0x5a; 500]),
        file("noise.nabiki", &[0x5a; 500]),
        file("noise.xyz", b"?"),
    ] {
        let frame = if name.ends_with("nabiki") { &["--frame", "0"][..] } else { &[] };
        let line = refuse(&[&["convert", &name, &out][..], frame].concat(), folder.path());
        assert!(line.contains(&name), "{line}");
        let info = refuse(&["info", &name], folder.path());
        assert!(info.contains(&name), "{info}");
    }
    let scene = refuse(&["run", "no/such/scene.toml", "--out", &path(&folder, "x")], folder.path());
    assert!(scene.contains("no/such/scene.toml"), "{scene}");
    let unwritable = refuse(&["groom", GUST, "--strands", "5", "-o", "/proc/none/out.hair"], folder.path());
    assert!(unwritable.contains("/proc/none/out.hair"), "{unwritable}");
}

#[test]
fn hair_too_small_to_be_moved_names_its_unit() {
    let folder = TempDir::new().unwrap();
    let (hair, scene) = (path(&folder, "short.hair"), path(&folder, "short.toml"));
    succeed(&["groom", GUST, "--strands", "60", "-o", &hair]);
    fs::write(&scene, format!("[hair]\nfile = \"{hair}\"\nunit = 0.01\n\n[motion]\nform = \"free\"\n")).unwrap();
    let said = refuse(&["simulate", &scene, "-o", &path(&folder, "m.nabiki")], folder.path());
    assert!(said.contains("unstable") && said.contains("give hair.unit = \"cm\""), "{said}");
}

#[test]
fn a_command_line_that_makes_no_sense_exits_with_2() {
    for arguments in [
        &["blow", GUST][..],
        &["run"],
        &["run", GUST, "--strands", "many"],
        &["run", GUST, "--threads", "0"],
        // Hair at rest has no frames.
        &["groom", GUST, "-o", "nowhere/a.hair", "--frames", "3"],
    ] {
        assert_eq!(nabiki(arguments).status.code(), Some(2), "{arguments:?}");
    }
}

#[test]
fn numbers_below_0_are_refused_by_the_option_that_has_them() {
    for (arguments, words) in [
        (&["render", GUST, "--frame", "-1"][..], "'-1' for '--frame <N>': must be a whole number, 0 to 10000000\n"),
        (&["run", GUST, "--frames", "-1"], "'-1' for '--frames <N>': must be a whole number, 1 to 10000000\n"),
        (&["run", GUST, "--frames", "99999999999"], "for '--frames <N>': must be a whole number, 1 to 10000000\n"),
        (&["render", GUST, "--frames", "-1..3"], "write one whole number, or two"),
        (&["preview", GUST, "--strands", "-5"], "must be a whole number of at least 1"),
    ] {
        let output = nabiki(arguments);
        let said = text(&output.stderr);
        assert!(output.status.code() == Some(2) && said.contains(words) && !said.contains("tip:"), "{said}");
    }
    let folder = TempDir::new().unwrap();
    let unit = refuse(&["convert", "a.hair", &path(&folder, "a.usda"), "--unit", "-3"], folder.path());
    assert!(unit.contains("--unit = -3: must be a finite number above 0"), "{unit}");
}

#[test]
fn a_setting_that_is_given_twice_is_not_left_unread() {
    let folder = TempDir::new().unwrap();
    let out = path(&folder, "m.nabiki");
    let line = refuse(&["simulate", GUST, "-o", &out, "--frames", "3", "--set", "motion.frames=-1"], folder.path());
    assert!(line.contains("--frames 3 and --set motion.frames=-1: give one of them"), "{line}");
}

#[test]
fn a_preview_says_that_the_whole_would_be_refused() {
    let folder = TempDir::new().unwrap();
    let hair = |last: f32| {
        // The last root is beside the first and nearer to the others, and so the last to be chosen.
        let roots = (0..8).map(|s| (9.0 + s as f32, 6.0)).chain([(9.01, last)]);
        let points: Vec<String> = roots.map(|(x, length)| format!("({x}, 1, 0), ({x}, {}, 0)", 1.0 + length)).collect();
        format!(
            "#usda 1.0\ndef BasisCurves \"h\" {{ uniform token type = \"linear\"\n int[] curveVertexCounts = [{}]\n\
             point3f[] points = [{}] }}\n",
            ["2"; 9].join(", "),
            points.join(", ")
        )
    };
    let scene = "[hair]\nfile = \"hair.usda\"\n[motion]\nframes = 1\n[output]\nsheet = [0]\n[picture]\nsize = [32, 32]\n[[force]]\n\
                 through = 1\nvector = [0, 0, 100]\n";
    let (file, out) = (path(&folder, "scene.toml"), path(&folder, "out"));
    fs::write(&file, scene).unwrap();
    for (last, said_so) in [(0.25, true), (5.0, false)] {
        fs::write(path(&folder, "hair.usda"), hair(last)).unwrap();
        let said = succeed(&["preview", &file, "--strands", "4", "--out", &out]);
        let line = "simulates 4 of 9 strands; nabiki would refuse all of them: ";
        assert_eq!(said.contains(line), said_so, "{said}");
        if said_so {
            let refused = refuse(&["simulate", &file, "-o", &path(&folder, "m.nabiki")], folder.path());
            let why = refused.trim_start_matches("nabiki: ").trim_end();
            assert!(said.contains(&format!("{line}{why}")), "{said}{refused}");
        }
    }
}

#[test]
fn a_preview_of_more_strands_than_there_are_is_refused_where_their_number_is_given() {
    let folder = TempDir::new().unwrap();
    let out = path(&folder, "out");
    let few =
        ["preview", GUST, "--out", &out, "--frames", "1", "--set", "hair.strands=20", "--set", "output.sheet=[0]"];
    let line = refuse(&[&few[..], &["--strands", "21"]].concat(), folder.path());
    assert!(line.contains("21 strands requested, but the scene has 20"), "{line}");
    let cache = refuse(&[&few[..], &["--cache", &path(&folder, "c.usdc")]].concat(), folder.path());
    assert!(cache.trim_end().ends_with("c.usdc: a motion cache ends in .nabiki; choose another name"), "{cache}");
    assert!(succeed(&few).contains("20 strands"));
}

#[test]
fn a_render_says_what_changes_nothing_as_a_run_does() {
    let folder = TempDir::new().unwrap();
    let (out, cache) = (path(&folder, "out"), path(&folder, "m.nabiki"));
    let free = ["--set", "motion.form=\"free\"", "--set", "pseudo_force.alpha=0.5"];
    let changes = [&SMALL[..], &free, &["--set", "picture.samples=8", "--set", "output.sheet=[0]"]].concat();
    let render = [&["render", GUST, "--frame", "2", "--out", &out][..], &changes].concat();
    let said = succeed(&render);
    for line in ["  warning hair does not feel [pseudo_force]", "  warning picture.samples changes nothing"] {
        assert!(said.contains(line), "{line}: {said}");
    }
    // Motion that is there already is not judged once more.
    succeed(&[&["simulate", GUST, "-o", &cache][..], &changes].concat());
    let said = succeed(&[&render[..], &["--motion", &cache]].concat());
    assert!(said.contains("picture.samples changes nothing") && !said.contains("pseudo_force"), "{said}");
}

#[test]
fn what_no_movie_can_be_is_refused_with_the_setting_before_anything_is_built() {
    let folder = TempDir::new().unwrap();
    let out = path(&folder, "out");
    for (task, set, key) in [
        ("run", "picture.size=[4000,100]", "picture.size = 4000 x 100: "),
        ("preview", "motion.frame_rate=0.1", "motion.frame_rate = 0.1: "),
        ("render", "motion.frame_rate=0.1", "motion.frame_rate = 0.1: "),
    ] {
        // A head that is not there would be refused first if anything were built.
        let none = "head.mesh=missing.obj";
        let line = refuse(&[task, GUST, "--out", &out, "--set", none, "--set", set], folder.path());
        assert!(line.contains(&format!("gust.toml: --set {set}: {key}")), "{line}");
    }
}

#[test]
fn every_scene_shipped_moves() {
    let folder = TempDir::new().unwrap();
    let of_the_paper = Path::new(GUST).parent().unwrap();
    let scenes = [names(of_the_paper), names(of_the_paper.parent().unwrap())].concat();
    let mut count = 0;
    let is_ours = |file: &&PathBuf| file.extension().is_some_and(|e| e == "toml") && !file.ends_with("imported.toml");
    for scene in scenes.iter().filter(is_ours) {
        let cache = path(&folder, "m.nabiki");
        let scene = scene.to_str().unwrap();
        let small = ["--strands", "50", "--frames", "2", "--set", "output.sheet=[0]"];
        let said = succeed(&[&["simulate", scene, "-o", &cache][..], &small].concat());
        assert!(said.contains("50 strands"), "{scene}: {said}");
        count += 1;
    }
    assert!(count >= 16, "{count} scenes");
}

#[test]
fn a_recorded_head_carries_the_hair() {
    let track = concat!(env!("CARGO_MANIFEST_DIR"), "/../nabiki_io/tests/files/nod.csv");
    let folder = TempDir::new().unwrap();
    let running = Path::new(GUST).with_file_name("running.toml");
    let simulate = |name: &str, changes: &[&str]| {
        let cache = path(&folder, name);
        let small = ["simulate", running.to_str().unwrap(), "-o", &cache, "--strands", "60", "--frames", "12"];
        let said = succeed(&[&small[..], changes].concat());
        let hair = path(&folder, &format!("{name}.hair"));
        succeed(&["convert", &cache, "--frame", "12", &hair]);
        (said, fs::read(hair).unwrap())
    };
    let motion = format!("head.motion={{file=\"{track}\",up=\"+y\",facing=\"+z\",start_at_origin=true}}");
    let (said, in_world) = simulate("world.nabiki", &["--set", &motion]);
    assert!(said.contains("48 Hz") && said.contains("24 Hz"), "the conversion of the rate is said: {said}");
    let in_head = simulate("head.nabiki", &["--set", &motion, "--set", "motion.force_space=\"head\""]).1;
    let still = simulate("still.nabiki", &[]).1;
    assert!(in_world != still, "a turning head feels the world's wind from other sides");
    assert!(in_head == still, "a force that turns with the head moves the hair on it as on a still one");
}

#[test]
fn what_a_motion_file_does_not_say_is_asked_for_one_by_one() {
    // Beside the scene's folder, as the scene names it: its own paths count from there.
    let data = "../../crates/nabiki_io/tests/files";
    let running = Path::new(GUST).with_file_name("running.toml");
    let folder = TempDir::new().unwrap();
    let cache = path(&folder, "m.nabiki");
    let arguments = |motion: &str| {
        let small = ["simulate", running.to_str().unwrap(), "-o", &cache, "--strands", "20", "--frames", "12", "--set"];
        [&small[..], &[motion]].concat().iter().map(|&argument| argument.to_owned()).collect::<Vec<_>>()
    };
    for (file, given) in [
        (
            "nod.amc",
            &[
                ("skeleton", format!("\"{data}/nod.asf\"")),
                ("frames_per_second", "48".to_owned()),
                ("up", "\"+y\"".to_owned()),
                ("facing", "\"+z\"".to_owned()),
            ][..],
        ),
        (
            "nod.tof",
            &[
                ("skeleton", format!("\"{data}/nod_skeleton.tof\"")),
                ("unit_cm", "100".to_owned()),
                ("up", "\"+y\"".to_owned()),
                ("facing", "\"+z\"".to_owned()),
            ],
        ),
    ] {
        let mut motion = format!("head.motion={{file=\"{data}/{file}\"");
        for (key, value) in given {
            let complete = arguments(&format!("{motion}}}"));
            let said = refuse(&complete.iter().map(String::as_str).collect::<Vec<_>>(), folder.path());
            let asked = format!("{file}: head.motion.{key} is not in the file: give {key} = ");
            assert!(said.contains(&asked), "{said}");
            motion += &format!(",{key}={value}");
        }
        let complete = arguments(&format!("{motion}}}"));
        let said = succeed(&complete.iter().map(String::as_str).collect::<Vec<_>>());
        assert!(
            said.contains("48 Hz (0.500 s)") && said.contains("24 Hz (positions cubic"),
            "the rates are said: {said}"
        );
        fs::remove_file(&cache).unwrap();
    }
}

#[test]
fn the_schema_is_printed_for_people_and_as_json_schema() {
    let text = succeed(&["schema"]);
    assert!(text.contains("\nmotion.frame_rate (per second; above 0; default 24): Frames per second"), "{text}");
    assert!(text.contains("\nfan.position (cm; -1000000 to 1000000; must be given): "), "{text}");
    let json: serde_json::Value = serde_json::from_str(&succeed(&["schema", "--json"])).unwrap();
    let tables = json["properties"].as_object().unwrap();
    assert!(["head", "motion", "force", "output"].iter().all(|table| tables.contains_key(*table)));
    let cell = &json["$defs"]["NeighbourForces"]["properties"]["cell"];
    assert_eq!(
        (&cell["minimum"], &cell["maximum"], &cell["default"], &cell["x-unit"]),
        (&0.5.into(), &20.0.into(), &2.0.into(), &"cm".into())
    );
    assert_eq!(json["$defs"]["ForceSettings"]["required"], serde_json::json!(["through", "vector"]));
    // Every definition that is named is there.
    let text = json.to_string();
    for name in text.split("#/$defs/").skip(1).filter_map(|rest| rest.split('"').next()) {
        assert!(json["$defs"][name].is_object(), "{name}");
    }
}
