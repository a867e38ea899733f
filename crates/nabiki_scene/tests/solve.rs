//! Scenes solved for their wishes: the file that comes of it, and wishes that cannot be met or make no sense.

use std::path::{Path, PathBuf};

use glam::Vec3;
use nabiki::field::Keyframe;
use nabiki::solve::Unknown;
use nabiki_scene::solve::{Solved, WishFile};
use nabiki_scene::tasks::{SolveOptions, solve};
use nabiki_scene::{Error, Scene, Shown, Told, Watch};

/// Comments in all places, and numbers spelled as nobody else would.
const SCENE: &str = "\
# A little hair.
[hair]
strands = 60      # not many
segments = 9
segment_length = 2.0

[motion]
form = \"free\"
frames = +60      # two seconds and a half
inertia_length_floor = 18.0

# first it blows
[[force]]
through = 30
vector = [-60, 0.50, 0]   # from the front

[[force]]   # then it does not
through = 60
vector = [0, 0, 0]
";

const WISHES: &str = "\
[unknowns]
vectors = [0]

[[wish]]
frame = 30
strands = [3, 7, 11]
along = [0.5, 1]
mean_moved = [-1, 2, -2]
";

#[derive(Default)]
struct Ear {
    solved: Option<Solved>,
    advice: Vec<String>,
    stops: bool,
}

impl Watch for Ear {
    fn told(&mut self, told: Told) {
        match told {
            Told::Solved(solved) => self.solved = Some(*solved),
            Told::Advice(advice) => self.advice.push(advice.to_string()),
            _ => {}
        }
    }

    fn cancelled(&self) -> bool {
        self.stops
    }
}

struct Place {
    folder: tempfile::TempDir,
}

impl Place {
    fn new(scene: &str, wishes: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("scene.toml"), scene).unwrap();
        std::fs::write(folder.path().join("wish.toml"), wishes).unwrap();
        Self { folder }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn options(&self) -> SolveOptions {
        SolveOptions { wishes: self.path("wish.toml"), output: self.path("solved.toml"), strands: 2000 }
    }

    fn solved(&self, ear: &mut Ear) -> Result<Solved, Error> {
        let scene = Scene::load(&self.path("scene.toml"), &[])?;
        solve(scene, &self.options(), ear)?;
        Ok(ear.solved.take().expect("a search tells what it found"))
    }
}

/// What a search says of these, less the folder.
fn refusal(scene: &str, wishes: &str) -> String {
    let place = Place::new(scene, wishes);
    let error = place.solved(&mut Ear::default()).expect_err("no such wish can be met").to_string();
    assert!(!place.path("solved.toml").exists(), "{error}");
    assert!(!error.contains('\n'), "one line: {error}");
    error.replace(&format!("{}/", place.folder.path().display()), "")
}

#[test]
fn the_solved_scene_moves_as_reported_and_keeps_its_comments_and_layout() {
    let place = Place::new(SCENE, WISHES);
    let solved = place.solved(&mut Ear::default()).unwrap();
    let report = &solved.report;
    assert!(report.after_cm < 0.1 && report.before_cm > 2.9, "{solved}");

    let text = std::fs::read_to_string(place.path("solved.toml")).unwrap();
    let Vec3 { x, y, z } = report.answer.keyframes[0].vector;
    assert_eq!(text, SCENE.replace("[-60, 0.50, 0]", &format!("[{x:?}, {y:?}, {z:?}]")));

    let mean = |file: &str| {
        let scene = Scene::load(&place.path(file), &[]).unwrap();
        let mut timeline = scene.build(Shown::All).unwrap().timeline().unwrap();
        let strands = timeline.seek(30);
        let of = |s: usize| strands.strand(s)[5..].iter().map(|p| p.as_dvec3()).sum::<glam::DVec3>();
        (of(3) + of(7) + of(11)) / 15.0
    };
    let goal = mean("scene.toml") + glam::DVec3::new(-1.0, 2.0, -2.0);
    let left = mean("solved.toml").distance(goal);
    assert!((left - report.wishes[0].after_cm).abs() < 1e-6, "{left} {report:?}");
}

#[test]
fn no_wind_is_found_that_hair_which_is_not_shown_cannot_bear() {
    // Of 1200 strands the shortest have a fifth of the length, and bear less than the first three.
    let scene = "\
[hair]
strands = 1200
segments = 18

[hair.style]
variation = { length = 0.8 }

[motion]
frames = 14

[[force]]
through = 14
vector = [-10, 0, 0]
";
    let wishes = "\
[unknowns]
vectors = [0]

[[wish]]
frame = 6
strands = [0, 1, 2]
along = [0.5, 1]
mean_moved = [-4, 4, 0]
";
    let place = Place::new(scene, wishes);
    let options = SolveOptions { strands: 3, ..place.options() };
    let (shown, whole) = (Shown::AtMost(3), Shown::All);
    let bears = |built: &nabiki_scene::BuiltScene| {
        4.0 / nabiki::dynamics::largest_gain(built.strands(), &built.dynamics).unwrap()
    };
    let load = |name: &str| Scene::load(&place.path(name), &[]).unwrap();
    let [some, all] = [shown, whole].map(|shown| bears(&load("scene.toml").build(shown).unwrap()));
    assert!(some > 1.2 * all, "the shown strands bear more: {some} {all}");
    let mut ear = Ear::default();
    solve(load("scene.toml"), &options, &mut ear).unwrap();
    let solved = load("solved.toml");
    let strength = solved.field.force[0].vector.length();
    solved.build(Shown::All).unwrap().simulation().expect("the scene that was found can be run");
    assert!(f64::from(strength) > 0.5 * all, "and goes as far as it may: {strength} of {all}");
}

#[test]
fn a_new_interval_and_its_border_come_into_the_file_where_they_belong() {
    let wishes = "\
[unknowns]
interval = { from = 31, through = 45 }
borders = [1]

[[wish]]
frame = 50
near = { point = [-9, -12, 0], radius = 5, frame = 0 }
along = [0.6, 1]
moved = [-2, 1, 0]

[[nail]]
frames = [25, 30]
strands = [0, 1]
";
    let place = Place::new(SCENE, wishes);
    let solved = place.solved(&mut Ear::default()).unwrap();
    assert_eq!(solved.unknowns, [Unknown::Vector(1), Unknown::Border(1)]);
    assert_eq!(solved.names, ["wish[0]", "nail[0]", "nail[0]"]);
    assert!(solved.report.after_cm < 0.7 * solved.report.before_cm, "{solved}");
    // What comes before the new interval does not feel it.
    assert!(solved.report.wishes[1..].iter().all(|wish| wish.after_cm < 1e-3), "{solved}");
    let scene = Scene::load(&place.path("solved.toml"), &[]).unwrap();
    let force = &scene.field.force;
    assert_eq!((force.len(), force[0].through, force[2].through), (3, 30, 60));
    assert_eq!(force[0].vector, Vec3::new(-60.0, 0.5, 0.0));
    assert_eq!(scene.field.as_given(), solved.report.answer.keyframes);
    let text = std::fs::read_to_string(place.path("solved.toml")).unwrap();
    for comment in
        ["# A little hair.", "# not many", "+60", "# first it blows", "# from the front", "# then it does not"]
    {
        assert!(text.contains(comment), "{text}");
    }
}

#[test]
fn a_wind_that_no_wish_feels_stays_as_it_is_and_that_is_said() {
    let place = Place::new(SCENE, &WISHES.replace("vectors = [0]", "vectors = [1, 0]"));
    let mut ear = Ear::default();
    let solved = place.solved(&mut ear).unwrap();
    assert_eq!(solved.unknowns, [Unknown::Vector(0)]);
    assert_eq!(solved.report.answer.keyframes[1].vector, Vec3::ZERO);
    let said =
        "unknowns.vectors[0] = 1 does not change: first felt in frame 31, after the last frame of a wish or nail, 30";
    assert_eq!(ear.advice, [said]);
}

#[test]
fn without_unknowns_every_wind_that_a_wish_feels_may_change() {
    let (_, wishes) = WISHES.split_once("\n\n").unwrap();
    let early = format!("{wishes}[search]\niterations = 1\nstarts = 1\n");
    let late = early.replace("frame = 30", "frame = 31");
    for (wishes, free) in [(early, 1), (late, 2)] {
        let mut ear = Ear::default();
        let solved = Place::new(SCENE, &wishes).solved(&mut ear).unwrap();
        assert_eq!(solved.unknowns, (0..free).map(Unknown::Vector).collect::<Vec<_>>());
        assert_eq!(ear.advice, [""; 0]);
    }
    let calm = SCENE.split_once("# first").unwrap().0;
    assert!(refusal(calm, wishes).starts_with("wish.toml: unknowns is empty, so nothing may change"));
}

#[test]
fn what_a_border_or_an_ease_brings_within_reach_may_change() {
    // Frame 30 is half on the way from the middle of interval 0, 15.5, to that of interval 1, 45.5.
    let eased = format!("{SCENE}\n[wind]\nease = \"linear\"\n");
    for (scene, unknowns) in [(eased.as_str(), "vectors = [1]"), (SCENE, "vectors = [1]\nborders = [0]")] {
        let wishes = WISHES.replace("vectors = [0]", unknowns) + "[search]\niterations = 1\nstarts = 1\n";
        let solved = Place::new(scene, &wishes).solved(&mut Ear::default()).unwrap();
        assert!(solved.unknowns.contains(&Unknown::Vector(1)), "{unknowns}");
    }
}

#[test]
fn the_same_fields_surround_a_wind_that_is_solved_for() {
    let fields = "
[gust]
intensity = 0.3
[flow]
[turbulence]
strength = 30
drift = 0.02
[neighbours]
carriers = 30
";
    let wishes = WISHES.replace("vectors = [0]", "vectors = [0]\ngust = true\nstiffness = true\nsettle = true");
    let place = Place::new(&format!("{SCENE}{fields}"), &wishes);
    let solved = place.solved(&mut Ear::default()).unwrap();
    assert!(solved.report.after_cm < 0.1, "{solved}");
    // Before: the problem moves as the scene does.
    let built = Scene::load(&place.path("solved.toml"), &[]).unwrap().build(Shown::All).unwrap();
    assert_eq!(built.scene.field.as_given(), solved.report.answer.keyframes);
    let problem = built.problem(vec![Unknown::Vector(0)], Vec::new());
    let wind = problem.wind.field(built.scene.frame_rate()).unwrap();
    let field = problem.surroundings.field(wind).unwrap();
    for frame in [1, 20, 45] {
        for p in [Vec3::new(-12.0, 3.0, 4.0), Vec3::new(2.0, -9.0, 9.0)] {
            assert_eq!(field.at(p, frame), built.force_at(p, frame), "{p} in frame {frame}");
        }
    }
}

#[test]
fn a_wish_out_of_reach_is_said_with_the_distance_left() {
    let far = WISHES.replace("mean_moved = [-1, 2, -2]", "mean_at = [0, 60, 0]");
    let place = Place::new(SCENE, &far);
    let solved = place.solved(&mut Ear::default()).unwrap();
    assert!(!solved.all_met());
    let left = solved.report.wishes[0].after_cm;
    assert!(left > 10.0, "{left}");
    let said = solved.to_string();
    assert!(said.contains(&format!("wish[0] is not reached: {left:.1} cm are left")), "{said}");
    assert!(place.path("solved.toml").exists());
}

#[test]
fn wind_that_blows_for_good_is_found_and_told() {
    let last = u32::MAX.to_string();
    let wishes = WISHES.replace("vectors = [0]", "vectors = [1]").replace("frame = 30", "frame = 45");
    let place = Place::new(&SCENE.replace("through = 60", &format!("through = {last}")), &wishes);
    let said = place.solved(&mut Ear::default()).unwrap().to_string();
    assert!(said.contains(&format!("force[1], frames 31 to {last}: ")), "{said}");
}

#[test]
fn what_makes_no_sense_is_refused_with_file_line_value_and_way_out() {
    let wish = |from: &str, to: &str| refusal(SCENE, &WISHES.replace(from, to));
    let cases = [
        (wish("[3, 7, 11]", "[3, 700]"), "wish.toml:6: wish[0].strands[1] = 700: the scene's strands are 0 to 59"),
        (wish("frame = 30", "frame = 61"), "wish.toml:5: wish[0].frame = 61: hair moves in frames 1 to 60"),
        (wish("frame = 30", "frame = 0"), "wish.toml:5: wish[0].frame = 0: hair moves in frames 1 to 60"),
        (wish("along = [0.5, 1]", "weight = -1"), "wish.toml:7: wish[0].weight = -1: must be a finite number above 0"),
        (wish("along = [0.5, 1]", "weight = nan"), "wish.toml:7: wish[0].weight = NaN: must be"),
        (wish("along = [0.5, 1]", "along = [1, 0.5]"), "wish.toml:7: wish[0].along = [1, 0.5]: must be two parts"),
        (wish("vectors = [0]", ""), "wish.toml:1: unknowns is empty, so nothing may change"),
        (
            wish("vectors = [0]", "vectors = [2]"),
            "wish.toml:2: unknowns.vectors[0] = 2: the intervals of [[force]] are 0 to 1",
        ),
        (wish("vectors = [0]", "vectors = [0, 0]"), "wish.toml:2: unknowns.vectors[1] = 0: is named twice"),
        (
            wish("vectors = [0]", "borders = [1]"),
            "wish.toml:2: unknowns.borders[0] = 1: the last interval has no border after it",
        ),
        (
            wish("vectors = [0]", "vectors = [1]"),
            "wish.toml:2: unknowns.vectors[0] = 1: first felt in frame 31, after the last frame of a wish or nail, 30: let an earlier wind change, or wish for a later frame",
        ),
        (
            wish("vectors = [0]", "interval = { from = 40, through = 50 }"),
            "wish.toml:2: unknowns.interval.from = 40: first felt in frame 40, after the last",
        ),
        (wish("vectors = [0]", "gust = true"), "wish.toml:2: unknowns.gust = true: the scene has no [gust]"),
        (
            refusal(
                &SCENE.replace("[motion]", "[free]\nsettle = 0\n\n[motion]"),
                &WISHES.replace("vectors = [0]", "settle = true"),
            ),
            "wish.toml:2: unknowns.settle = true: the solver only scales it, but it is 0 everywhere",
        ),
        (
            wish("vectors = [0]", "vektors = [0]"),
            "wish.toml:2: unknowns.vektors: unknown key; did you mean unknowns.vectors?",
        ),
        (
            wish("vectors = [0]", "interval = { from = 40, through = 20 }"),
            "wish.toml:2: unknowns.interval.from = 40: must",
        ),
        (
            wish("vectors = [0]", "interval = { from = 40, through = 99 }"),
            "wish.toml:2: unknowns.interval.through = 99: hair moves",
        ),
        (refusal(SCENE, "[unknowns]\nvectors = [0]\n"), "wish.toml: wish is missing: give a [[wish]]"),
        (wish("strands = [3, 7, 11]", ""), "wish.toml:4: wish[0] names no hair: give"),
        (wish("mean_moved = [-1, 2, -2]", ""), "wish.toml:4: wish[0] has no goal: give one of"),
        (
            wish("mean_moved", "mean_at = [0, 0, 0]\nmean_moved"),
            "wish.toml:8: wish[0].mean_at is given with mean_moved: give",
        ),
        (
            wish("mean_moved = [-1, 2, -2]", "places = [[1, 2, 3]]"),
            "wish.toml:8: wish[0].places = 1 places: the lock has 15",
        ),
        (
            wish("mean_moved = [-1, 2, -2]", "mean_moved = [1, inf, 0]"),
            "wish.toml:8: wish[0].mean_moved is not finite: every",
        ),
        (
            wish("strands = [3, 7, 11]", "near = { point = [90, 0, 0], radius = 2 }"),
            "wish.toml:6: wish[0].near.radius = 2: no hair is that close to (",
        ),
        (
            wish("strands = [3, 7, 11]", "near = [-9, -12, 0]"),
            "wish.toml:6: wish[0].near: found a list, must be a table { point, radius, frame }",
        ),
        (
            refusal(&SCENE.replace("form = \"free\"", ""), &WISHES.replace("vectors = [0]", "settle = true")),
            "wish.toml:2: unknowns.settle = true: the paper's form has none",
        ),
    ];
    for (said, expected) in cases {
        assert!(said.contains(expected), "{said}\n    and not: {expected}");
    }
}

#[test]
fn places_that_cannot_be_written_and_files_that_are_not_there_are_refused_before_anything_is_built() {
    let place = Place::new(SCENE, WISHES);
    let refused = |change: &dyn Fn(&mut SolveOptions)| {
        let mut options = place.options();
        change(&mut options);
        let scene = Scene::load(&place.path("scene.toml"), &[]).unwrap();
        solve(scene, &options, &mut Ear::default()).unwrap_err().to_string()
    };
    let missing = refused(&|o| o.wishes = place.path("none.toml"));
    assert!(missing.contains("none.toml: ") && !missing.contains('\n'), "{missing}");
    assert!(refused(&|o| o.output = place.path("scene.toml")).contains("give the result another name"));
    assert!(refused(&|o| o.output = place.path("wish.toml")).contains("give the result another name"));
    assert!(refused(&|o| o.output = place.path("solved.txt")).contains("a scene ends in .toml"));
    assert!(refused(&|o| o.output = place.path("none/solved.toml")).contains("there is no folder"));
}

#[test]
fn files_that_a_scene_names_are_still_found_from_where_it_is_written() {
    let scene = format!("{SCENE}\n[[body]]\nmesh = \"ball.obj\"\n");
    let place = Place::new(&scene, WISHES);
    std::fs::create_dir(place.path("other")).unwrap();
    let options = SolveOptions { output: place.path("other/solved.toml"), ..place.options() };
    let scene = Scene::load(&place.path("scene.toml"), &[]).unwrap();
    let refused = solve(scene, &options, &mut Ear::default()).unwrap_err().to_string();
    assert!(refused.contains("write the result into that folder"), "{refused}");
}

#[test]
fn a_search_that_is_stopped_leaves_nothing() {
    let place = Place::new(SCENE, WISHES);
    let stopped = place.solved(&mut Ear { stops: true, ..Ear::default() });
    assert!(matches!(stopped, Err(Error::Cancelled)));
    assert!(!place.path("solved.toml").exists());
}

#[test]
fn the_wishes_that_come_with_the_scenes_are_about_their_hair() {
    let scenes = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes"));
    let mut count = 0;
    for entry in std::fs::read_dir(scenes.join("wishes")).unwrap() {
        let wishes = entry.unwrap().path();
        let file = WishFile::load(&wishes).unwrap();
        let scene = Scene::load(&scenes.join(wishes.file_name().unwrap()), &[]).unwrap();
        let (force, _) =
            file.wishes.unknowns(scene.field.force.len()).of(&scene.field.as_given(), scene.motion.frames).unwrap();
        assert!(force.windows(2).all(|pair: &[Keyframe]| pair[0].through < pair[1].through));
        let built = scene.build(Shown::AtMost(400)).unwrap();
        let named = file.about(&built).unwrap();
        assert_eq!(
            named.len(),
            file.wishes.wish.len() + file.wishes.nail.iter().map(|n| n.frames.len()).sum::<usize>()
        );
        count += 1;
        // A lock near a point is of the strands that have a node there besides their root, and of no other.
        if let Some(near) = file.wishes.wish[0].near.filter(|near| near.frame == Some(0)) {
            let is_there = |p: &Vec3| p.as_dvec3().distance(near.point.as_dvec3()) <= f64::from(near.radius);
            let strands = (0..).zip(built.strands().iter());
            let there: Vec<u32> = strands.filter(|(_, s)| s[1..].iter().any(is_there)).map(|(s, _)| s).collect();
            let mut found: Vec<u32> = named[0].wish.nodes.iter().map(|node| node.strand).collect();
            found.dedup();
            assert_eq!(found, there, "{}", wishes.display());
            assert!(!there.is_empty() && there.len() < built.strands().len());
        }
    }
    assert!(count >= 3, "{count}");
}

#[test]
fn the_wish_files_of_the_docs_are_wish_files() {
    let page = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/solve.md"));
    let text = std::fs::read_to_string(page).unwrap();
    let blocks: Vec<&str> =
        text.split("```toml wish\n").skip(1).map(|rest| rest.split("```").next().unwrap()).collect();
    assert!(!blocks.is_empty());
    for block in blocks {
        let file = WishFile::parse(block, page).unwrap();
        // What is said to be the default is.
        assert_eq!((file.wishes.prior, file.wishes.search), Default::default());
    }
}
