//! Work divided among machines gives the bits of one machine, whatever the division; and what is no such division is refused.

mod common;

use std::fs;
use std::path::Path;
use std::process::Command;

use tempfile::TempDir;

use common::{nabiki, succeed};

const SCENES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes");

// Roots are spread for all strands of a scene, of however few are moved: `hair.strands` is small so that each command is soon done.

/// The one line of a refusal, after which the folder holds what it held.
fn refuse(folder: &TempDir, words: &str) -> String {
    let before = everything(folder.path());
    let line = common::refuse(folder, words);
    assert!(line.starts_with("nabiki: "), "{words}: {line}");
    assert_eq!(everything(folder.path()), before, "{words} leaves nothing behind");
    line
}

/// All that lies below `folder`.
fn everything(folder: &Path) -> Vec<String> {
    let mut all = Vec::new();
    for there in fs::read_dir(folder).unwrap().map(Result::unwrap) {
        all.push(there.path().display().to_string());
        if there.path().is_dir() {
            all.extend(everything(&there.path()));
        }
    }
    all.sort();
    all
}

fn bytes(folder: &TempDir, name: &str) -> Vec<u8> {
    fs::read(folder.path().join(name)).unwrap()
}

/// Both forms of the motion, the second with carriers and a turning head; the last with hair of a file, cut anew, of which
/// some strands are shown.
fn scenes(folder: &TempDir) -> [(String, &'static str); 5] {
    succeed(folder, &format!("groom {SCENES}/bob.toml --set hair.strands=900 --strands 300 -o hair.usdc"));
    let imported =
        "[hair]\nfile = \"hair.usdc\"\njoin_within = 0\nsegments = 9\n\n[[force]]\nthrough = 5\nvector = [-40, 5, 0]\n";
    fs::write(folder.path().join("imported.toml"), imported).unwrap();
    [
        (format!("{SCENES}/paper/gust.toml"), "--set hair.strands=900 --strands 83"),
        (format!("{SCENES}/paper/running.toml"), "--set hair.strands=900 --strands 83"),
        (format!("{SCENES}/head_turn.toml"), "--set hair.strands=900 --strands 700"),
        (format!("{SCENES}/storm.toml"), "--set hair.strands=900 --strands 83 --set neighbours.carriers=40"),
        ("imported.toml".to_owned(), "--strands 190"),
    ]
}

#[test]
fn shards_of_any_number_join_into_the_file_that_one_machine_writes() {
    let folder = TempDir::new().unwrap();
    for (scene, changes) in scenes(&folder) {
        let all = format!("{scene} {changes} --frames 5 --set output.sheet=[0] --quiet");
        succeed(&folder, &format!("simulate {all} -o whole.nabiki"));
        let whole = bytes(&folder, "whole.nabiki");
        for shards in [1, 2, 3, 7] {
            let mut files = Vec::new();
            // In an order of their own, as a farm ends them.
            for k in (1..=shards).rev() {
                let file = format!("shards/{k}_of_{shards}.nabiki");
                succeed(&folder, &format!("simulate {all} --shard {k}/{shards} --threads {} -o {file}", 1 + k % 2));
                files.push(file);
            }
            succeed(&folder, &format!("join {} -o joined.nabiki", files.join(" ")));
            assert!(bytes(&folder, "joined.nabiki") == whole, "{scene} in {shards}");
        }
        succeed(
            &folder,
            &format!("render {all} --set picture.size=[96,64] --motion joined.nabiki --frame 5 --out out"),
        );
    }
}

#[test]
fn every_strand_may_have_a_shard_of_its_own() {
    let folder = TempDir::new().unwrap();
    let all =
        format!("{SCENES}/storm.toml --set hair.strands=900 --strands 5 --frames 3 --set output.sheet=[0] --quiet");
    succeed(&folder, &format!("simulate {all} -o whole.nabiki"));
    for k in 1..=5 {
        succeed(&folder, &format!("simulate {all} --shard {k}/5 -o {k}.nabiki"));
    }
    succeed(&folder, "join 1.nabiki 2.nabiki 3.nabiki 4.nabiki 5.nabiki -o joined.nabiki");
    assert!(bytes(&folder, "joined.nabiki") == bytes(&folder, "whole.nabiki"));
}

#[test]
fn the_f64_twin_can_be_divided_too_and_not_be_mixed() {
    let folder = TempDir::new().unwrap();
    let all = format!("{SCENES}/gust.toml --set hair.strands=900 --strands 30 --frames 3 --set output.sheet=[0]");
    succeed(&folder, &format!("simulate {all} --stepper f64 -o whole.nabiki"));
    for k in [1, 2] {
        succeed(&folder, &format!("simulate {all} --stepper f64 --shard {k}/2 -o {k}.nabiki"));
    }
    succeed(&folder, "join 1.nabiki 2.nabiki -o joined.nabiki");
    assert!(bytes(&folder, "joined.nabiki") == bytes(&folder, "whole.nabiki"));
    succeed(&folder, &format!("simulate {all} --shard 2/2 -o fast.nabiki"));
    assert!(
        refuse(&folder, "join 1.nabiki fast.nabiki -o other.nabiki").contains("fast.nabiki: was made with the other")
    );
}

#[test]
fn frames_of_any_division_are_those_of_the_film_and_make_its_movie() {
    let folder = TempDir::new().unwrap();
    for (name, changes) in [("gust", "--set picture.shutter=0.5"), ("head_turn", ""), ("hand", "")] {
        let small = "--set hair.strands=900 --strands 60 --set motion.frames=8 --set picture.size=[96,64] \
                     --set output.sheet=[0] --quiet";
        let scene = format!("{SCENES}/{name}.toml {changes} {small}").replace("  ", " ");
        let deep = "--set output.png_bits=16";
        succeed(&folder, &format!("simulate {scene} -o motion.nabiki"));
        succeed(&folder, &format!("run {scene} --set output.png_frames=true {deep} --out whole"));
        let whole = format!("whole/{name}");
        for runs in [&[0..=8][..], &[0..=0, 1..=5, 6..=8]] {
            for motion in ["", "--motion motion.nabiki"] {
                for run in runs.iter().rev() {
                    let frames = format!("{}..{}", run.start(), run.end());
                    succeed(
                        &folder,
                        format!("render {scene} {deep} --frames {frames} --out parts {motion}").trim_end(),
                    );
                }
                for n in 0..=8 {
                    let picture = |of: &str| bytes(&folder, &format!("{of}_frames/{n:04}.png"));
                    assert!(picture(&format!("parts/{name}")) == picture(&whole), "{name} {runs:?} {motion}: {n}");
                }
                let sets = "--set motion.frames=8 --set output.sheet=[0] -o parts.mp4";
                succeed(&folder, &format!("movie parts/{name}_frames --scene {SCENES}/{name}.toml {sets}"));
                assert!(bytes(&folder, "parts.mp4") == bytes(&folder, &format!("{whole}.mp4")), "{name} {runs:?}");
                fs::remove_dir_all(folder.path().join("parts")).unwrap();
            }
        }
    }
}

#[test]
fn a_movie_of_8_bit_frames_differs_from_the_film_by_their_rounding_alone() {
    let folder = TempDir::new().unwrap();
    let scene = format!(
        "{SCENES}/gust.toml --set hair.strands=900 --strands 60 --set motion.frames=2 --set picture.size=[96,64] \
         --set output.sheet=[0]"
    );
    succeed(&folder, &format!("run {scene} --out whole"));
    succeed(&folder, &format!("render {scene} --frames 0..2 --out parts"));
    succeed(
        &folder,
        "movie parts/gust_frames/0000.png parts/gust_frames/0002.png parts/gust_frames/0001.png -o parts.mp4",
    );
    let [a, b] = ["parts.mp4", "whole/gust.mp4"].map(|name| bytes(&folder, name).len() as f64);
    assert!((a / b - 1.0).abs() < 0.1, "{a} and {b} bytes");
}

#[test]
fn numbers_that_name_no_shard_and_no_frames_make_no_sense() {
    let folder = TempDir::new().unwrap();
    let scene = format!("{SCENES}/gust.toml");
    for shard in ["0/3", "4/3", "3/0", "a/b", "3", "1/2/3", "-1/3"] {
        let output = nabiki(&folder, &format!("simulate {scene} --shard={shard} -o m.nabiki"));
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{shard}: {said}");
        assert!(said.contains(&format!("shard {shard}: ")), "{said}");
    }
    for (words, said) in [
        ("render S --frames 3..", "two as in 10..19"),
        ("render S --frames a..b", "two as in 10..19"),
        ("join -o j.nabiki", "<SHARDS>"),
        ("movie -o m.mp4", "<FRAMES>"),
        ("farm S --engine tractor -o job.yaml", "openjd, slurm"),
        ("farm S --engine slurm --shards 0 -o job.sh", "--shards"),
        ("farm S --engine slurm --frames-a-task 0 -o job.sh", "--frames-a-task"),
    ] {
        let output = nabiki(&folder, &words.replace('S', &scene));
        let line = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{words}: {line}");
        assert!(line.contains(said), "{words}: {line}");
    }
    assert!(everything(folder.path()).is_empty());
}

#[test]
fn frames_that_are_not_there_are_refused() {
    let folder = TempDir::new().unwrap();
    let scene = format!("{SCENES}/gust.toml --strands 20");
    for (words, why) in [
        ("--frames 7..3", "write the earlier frame first"),
        ("--frames 100..999", "the last frame is motion.frames = 110"),
        ("--frames 1..2 --frame 1", "give one of them"),
        ("--frames 1..2 --motion none.nabiki", "none.nabiki"),
        ("--frames 1..2 --out /proc/none", "/proc/none"),
    ] {
        let line = refuse(&folder, &format!("render {scene} {words}"));
        assert!(line.contains(why), "{words}: {line}");
    }
}

#[test]
fn shards_that_cannot_be_are_refused() {
    let folder = TempDir::new().unwrap();
    let scene = format!("{SCENES}/gust.toml --set hair.strands=900 --strands 20 --frames 2 --set output.sheet=[0]");
    for (words, why) in [
        ("--shard 3/21 -o m.nabiki", "shard 3/21: more shards than strands; use at most 20"),
        ("--shard 1/2 -o m.usdc", "a shard can only be written to a motion cache (.nabiki)"),
        ("--shard 1/2 -o m.nabiki --export m.usdc", "a shard can only be written to a motion cache (.nabiki)"),
        ("--shard 1/2 -o /proc/none/m.nabiki", "/proc/none"),
        ("--shard 1/2 -o new/m.bin", "a motion cache ends in .nabiki"),
    ] {
        let line = refuse(&folder, &format!("simulate {scene} {words}"));
        assert!(line.contains(why), "{words}: {line}");
    }
}

#[test]
fn what_is_not_all_shards_of_one_motion_is_not_joined() {
    let folder = TempDir::new().unwrap();
    let gust = format!("{SCENES}/gust.toml --set hair.strands=900 --strands 20 --set output.sheet=[0]");
    let simulate = |words: &str| succeed(&folder, &format!("simulate {gust} {words}"));
    for k in 1..=3 {
        simulate(&format!("--frames 2 --shard {k}/3 -o {k}_of_3.nabiki"));
    }
    simulate("--frames 2 -o whole.nabiki");
    simulate("--frames 2 --shard 2/4 -o fourth.nabiki");
    simulate("--frames 3 --shard 2/3 -o longer.nabiki");
    simulate("--frames 2 --shard 2/3 --set motion.time_step=0.1 -o slower.nabiki");
    simulate("--frames 2 --shard 2/3 --set hair.seed=99 -o grown.nabiki");
    simulate("--frames 2 --shard 2/3 --set output.first_frame=1001 -o later.nabiki");
    simulate("--frames 2 --shard 2/3 --set picture.hair.width=0.02 -o thick.nabiki");
    fs::copy(folder.path().join("2_of_3.nabiki"), folder.path().join("again.nabiki")).unwrap();
    fs::write(folder.path().join("noise.nabiki"), [0x5a; 500]).unwrap();
    let cut = bytes(&folder, "2_of_3.nabiki");
    fs::write(folder.path().join("cut.nabiki"), &cut[..cut.len() - 9]).unwrap();
    for (files, why) in [
        ("1_of_3.nabiki fourth.nabiki 3_of_3.nabiki", "fourth.nabiki: is shard 2/4, and 1_of_3.nabiki is shard 1/3"),
        ("1_of_3.nabiki longer.nabiki 3_of_3.nabiki", "longer.nabiki: holds 4 frames at 24 a second and not 3 frames"),
        ("1_of_3.nabiki slower.nabiki 3_of_3.nabiki", "slower.nabiki: was made from another scene"),
        ("1_of_3.nabiki grown.nabiki 3_of_3.nabiki", "grown.nabiki: was made from another scene"),
        (
            "1_of_3.nabiki later.nabiki 3_of_3.nabiki",
            "later.nabiki: begins at frame 1001 of the shot and not 0 (output.first_frame)",
        ),
        ("1_of_3.nabiki thick.nabiki 3_of_3.nabiki", "thick.nabiki: has other attributes"),
        ("1_of_3.nabiki again.nabiki 2_of_3.nabiki 3_of_3.nabiki", "2_of_3.nabiki: is shard 2/3 as again.nabiki is"),
        ("1_of_3.nabiki 1_of_3.nabiki", "give each shard once"),
        ("1_of_3.nabiki whole.nabiki", "whole.nabiki: a full motion, not a shard"),
        ("1_of_3.nabiki noise.nabiki", "noise.nabiki: does not start with NABIKI"),
        ("1_of_3.nabiki cut.nabiki 3_of_3.nabiki", "cut.nabiki: 3 frames of"),
        ("none.nabiki", "none.nabiki: there is no such file"),
        (
            "1_of_3.nabiki 2_of_3.nabiki 3_of_3.nabiki none.nabiki",
            "none.nabiki: there is no such file, and all 3 shards",
        ),
    ] {
        let line = refuse(&folder, &format!("join {files} -o joined.nabiki"));
        assert!(line.contains(why), "{files}: {line}");
    }
    let all = "1_of_3.nabiki 2_of_3.nabiki 3_of_3.nabiki";
    for (output, why) in [
        ("joined.usdc", "a motion cache ends in .nabiki"),
        ("2_of_3.nabiki", "this is an input of the result"),
        ("none/joined.nabiki", "there is no folder none"),
    ] {
        let line = refuse(&folder, &format!("join {all} -o {output}"));
        assert!(line.contains(why), "{output}: {line}");
    }
    let drawn = refuse(&folder, &format!("render {gust} --frames 2 --motion 1_of_3.nabiki"));
    assert!(drawn.contains("1_of_3.nabiki: contains shard 1/3 of a motion; join all shards"), "{drawn}");
    assert!(succeed(&folder, "info 2_of_3.nabiki").contains("shard 2/3 of 20 strands"));
}

#[test]
fn the_command_that_join_names_makes_what_is_missing() {
    let folder = TempDir::new().unwrap();
    let scene = format!("{SCENES}/gust.toml");
    let simulate = |words: &[&str]| {
        let changes = ["simulate", &scene, "--strands", "20", "--frames", "2", "--set", "force.0.vector=[-90, 20, 0]"];
        let output = Command::new(env!("CARGO_BIN_EXE_nabiki"))
            .args([&changes[..], words].concat())
            .current_dir(folder.path())
            .output()
            .unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    };
    simulate(&["-o", "whole.nabiki"]);
    for k in ["1/3", "3/3"] {
        simulate(&["--shard", k, "-o", &format!("shards/{}.nabiki", k.replace('/', "_of_"))]);
    }
    for given in
        ["shards/1_of_3.nabiki shards/3_of_3.nabiki", "shards/1_of_3.nabiki shards/2_of_3.nabiki shards/3_of_3.nabiki"]
    {
        let line = refuse(&folder, &format!("join {given} -o joined.nabiki"));
        let (why, command) = line.split_once(": make it with nabiki ").unwrap();
        assert!(why.ends_with("shard 2/3 is missing"), "{line}");
        assert!(command.trim_end().ends_with("--shard 2/3 -o shards/2_of_3.nabiki"), "{line}");
        let shell = format!("{} {}", env!("CARGO_BIN_EXE_nabiki"), command.trim_end());
        let made = Command::new("sh").args(["-c", &shell]).current_dir(folder.path()).output().unwrap();
        assert!(made.status.success(), "{shell}: {}", String::from_utf8_lossy(&made.stderr));
        succeed(&folder, "join shards/3_of_3.nabiki shards/2_of_3.nabiki shards/1_of_3.nabiki -o joined.nabiki");
        assert!(bytes(&folder, "joined.nabiki") == bytes(&folder, "whole.nabiki"));
        for made in ["joined.nabiki", "shards/2_of_3.nabiki"] {
            fs::remove_file(folder.path().join(made)).unwrap();
        }
    }
}

#[test]
fn the_command_that_a_gap_is_answered_with_fills_it() {
    let folder = TempDir::new().unwrap();
    fs::copy(format!("{SCENES}/gust.toml"), folder.path().join("gust.toml")).unwrap();
    let changes = "--set motion.frames=3 --set hair.strands=900 --strands 20 --set picture.size=[96,64]";
    fs::create_dir(folder.path().join("some")).unwrap();
    succeed(&folder, &format!("simulate gust.toml {changes} -o some/gust.nabiki"));
    let deep = "--set output.png_bits=16";
    succeed(&folder, &format!("render gust.toml {changes} --motion some/gust.nabiki {deep} --frames 0..3 --out some"));
    let movie = format!("movie some/gust_frames --scene gust.toml {changes} -o gap.mp4");
    let gap = folder.path().join("some/gust_frames/0002.png");
    let was = fs::read(&gap).unwrap();
    fs::remove_file(&gap).unwrap();
    let line = refuse(&folder, &movie);
    let (_, command) = line.trim_end().split_once("render with nabiki ").unwrap();
    assert!(command.contains("--motion some/gust.nabiki") && command.contains("--strands 20"), "{command}");
    succeed(&folder, &command.replace('\'', ""));
    assert!(fs::read(&gap).unwrap() == was, "the same picture, to the bit");
    succeed(&folder, &movie);
}

#[test]
fn frames_that_make_no_movie_are_refused() {
    let folder = TempDir::new().unwrap();
    let small = "--set hair.strands=900 --strands 20 --set output.sheet=[0] --set motion.frames=4 --quiet";
    let draw = |words: &str| succeed(&folder, &format!("render {SCENES}/gust.toml {small} {words}"));
    draw("--set picture.size=[96,64] --frames 0..4 --out a");
    draw("--set picture.size=[64,64] --frames 2..2 --out b");
    draw("--set picture.size=[3842,16] --frames 0..0 --out wide");
    draw("--set picture.size=[96,64] --set picture.background.transparent=true --frames 2..2 --out c");
    fs::copy(folder.path().join("b/gust_frames/0002.png"), folder.path().join("small2.png")).unwrap();
    for (from, to) in [("b", "other/f2.png"), ("c", "clear/f2.png")] {
        fs::create_dir_all(folder.path().join(to).parent().unwrap()).unwrap();
        fs::copy(folder.path().join(format!("{from}/gust_frames/0002.png")), folder.path().join(to)).unwrap();
    }
    for n in [0, 1, 3, 4] {
        fs::copy(folder.path().join(format!("a/gust_frames/{n:04}.png")), folder.path().join(format!("f{n}.png")))
            .unwrap();
    }
    fs::write(folder.path().join("f2.png"), [0x5a; 500]).unwrap();
    fs::create_dir(folder.path().join("empty")).unwrap();
    fs::write(folder.path().join("empty.png"), []).unwrap();
    let whole = format!("--scene {SCENES}/gust.toml --set output.sheet=[0]");
    for (words, why) in [
        ("f0.png f1.png f3.png -o m.mp4", "frame 2 is missing; render with nabiki render SCENE --frames 2..2"),
        ("f0.png f4.png -o m.mp4", "frames 1 to 3 are missing; render with nabiki render SCENE --frames 1..3"),
        ("f0.png f1.png other/f2.png f3.png -o m.mp4", "f2.png: 64 x 64 pixels and f0.png has 96 x 64"),
        (
            "f0.png f1.png small2.png f3.png -o m.mp4",
            "f0.png and small2.png: have different names before their numbers",
        ),
        ("f0.png f1.png clear/f2.png f3.png -o m.mp4", "is transparent: only opaque pictures"),
        ("f0.png f1.png f2.png -o m.mp4", "f2.png: "),
        ("f0.png f1.png a/../f1.png -o m.mp4", "is frame 1 as"),
        ("empty -o m.mp4", "no numbered PNG files are in this folder"),
        ("f0.png none.png -o m.mp4", "none.png: there is no such file or folder"),
        ("f0.png empty.png -o m.mp4", "empty.png: no PNG file with a number"),
        ("f0.png none/f1.png -o m.mp4", "f1.png: "),
        (
            "wide/gust_frames -o m.mp4",
            "0000.png: 3842 x 16 pixels; a movie's sides must lie between 16 and 3840 x 2160",
        ),
        ("a/gust_frames -o m.avi", "a movie ends in .mp4"),
        ("a/gust_frames -o none/m.mp4", "there is no folder none"),
        ("a/gust_frames -o m.mp4 WHOLE --set motion.frames=9", "frames 5 to 9 are missing"),
        ("f3.png f4.png -o m.mp4 WHOLE --set motion.frames=4", "frames 0 to 2 are missing; render with nabiki render "),
        ("a/gust_frames -o m.mp4 WHOLE --set motion.frames=2", "the last frame of"),
    ] {
        let line = refuse(&folder, &format!("movie {}", words.replace("WHOLE", &whole)));
        assert!(line.contains(why), "{words}: {line}");
    }
    succeed(&folder, "movie f3.png f4.png -o m.mp4");
}

#[test]
fn jobs_that_would_fail_on_the_farm_are_refused_at_once() {
    let folder = TempDir::new().unwrap();
    let scene = format!("{SCENES}/gust.toml");
    for (words, why) in [
        ("S --engine openjd -o job.sh", "ends in .yaml"),
        ("S --engine slurm -o job.yaml", "ends in .sh"),
        ("S --engine slurm -o none/job.sh", "there is no folder none"),
        (
            "S --engine slurm --strands 20 --shards 21 -o job.sh",
            "--shards 21: more shards than strands; use at most 20",
        ),
        ("S --engine slurm --strands 99999999 -o job.sh", "request fewer"),
        ("S --engine slurm --set picture.size=[5000,3000] -o job.sh", "picture.size = 5000 x 3000"),
        ("S --engine slurm --set picture.background.transparent=true -o job.sh", "a movie cannot have alpha"),
        ("S --engine slurm --set force.0.vector=[-1e9,0,0] -o job.sh", "keep |F| below"),
        ("S --engine openjd --set hair.strands=0 -o job.yaml", "hair.strands = 0"),
        ("none.toml --engine openjd -o job.yaml", "none.toml"),
    ] {
        let line = refuse(&folder, &format!("farm {}", words.replace('S', &scene)));
        assert!(line.contains(why), "{words}: {line}");
    }
}

#[test]
fn a_job_names_its_commands_and_its_scene() {
    let folder = TempDir::new().unwrap();
    fs::copy(format!("{SCENES}/gust.toml"), folder.path().join("the gust.toml")).unwrap();
    let farm = |engine: &str, job: &str| {
        let words = ["farm", "the gust.toml", "--engine", engine, "--frames", "20", "--shards", "3", "-o", job];
        let output =
            Command::new(env!("CARGO_BIN_EXE_nabiki")).args(words).current_dir(folder.path()).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(bytes(&folder, job)).unwrap()
    };
    let template = farm("openjd", "job.yaml");
    for line in ["specificationVersion: jobtemplate-2023-09", "default: \"the gust.toml\"", "range: \"0-10:10,20\""] {
        assert!(template.contains(line), "{line}: {template}");
    }
    let script = farm("slurm", "job.sh");
    let scene = folder.path().canonicalize().unwrap().join("the gust.toml");
    assert!(script.contains(&format!("scene='{}'", scene.display())), "{script}");
    let parsed = Command::new("bash").args(["-n", "job.sh"]).current_dir(folder.path()).output().unwrap();
    assert!(parsed.status.success(), "{}", String::from_utf8_lossy(&parsed.stderr));
}
