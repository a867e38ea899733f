//! Settings in units of the world, and wind by its speed: what they come to, and what is refused.

use std::path::Path;

use glam::Vec3;
use nabiki::dynamics::{Form, push};
use nabiki::free_form::FreeForm;
use nabiki::solve::Answer;
use nabiki_scene::{BuiltScene, Scene, Shown};
use proptest::prelude::*;

fn parse(text: &str) -> Scene {
    Scene::parse(text, Path::new("a.toml"), &[]).unwrap_or_else(|refused| panic!("{refused}\n{text}"))
}

/// A scene of the free form with these lines in `[motion]`, `[free]` and `[[force]]`.
fn text(motion: &str, free: &str, force: &str) -> String {
    format!(
        "[hair]\nstrands = 40\n[motion]\nform = \"free\"\nframes = 20\n{motion}\n[free]\n{free}\n[[force]]\nthrough = 20\n{force}\n"
    )
}

fn built(motion: &str, free: &str, force: &str) -> BuiltScene {
    parse(&text(motion, free, force)).build(Shown::All).unwrap()
}

fn form(built: &BuiltScene) -> &FreeForm {
    let Form::Free(free) = &built.dynamics.form else { panic!("the free form") };
    &free.form
}

/// All points of all frames.
fn film(built: &BuiltScene) -> Vec<Vec3> {
    let mut timeline = built.timeline().unwrap();
    let film = timeline.play();
    (0..=film.frames()).flat_map(|n| film.points(n).to_vec()).collect()
}

const CALM: &str = "vector = [0, 0, 0]";

#[test]
fn one_g_is_the_earth_s_and_parts_of_it_are_parts_of_that() {
    let [earth, one, half] = ["\"earth\"", "\"1 g\"", "\"0.5 g\""]
        .map(|gravity| form(&built("", &format!("gravity = {gravity}\nhold = \"0.25 g\""), CALM)).clone());
    assert_eq!(earth.gravity.to_bits(), one.gravity.to_bits());
    // Halves and quarters are exact.
    assert_eq!(half.gravity, 0.5 * one.gravity);
    assert_eq!([half.hold, one.hold].map(|hold| hold.at(0.0)), [f64::from(0.25 * one.gravity); 2]);
}

#[test]
fn seconds_are_as_many_frames_as_pass_in_them() {
    for (rate, slow) in [(24, 1), (25, 1), (120, 4)] {
        let built = built(&format!("frame_rate = {rate}\nslow = {slow}"), "settle = [\"0.5 s\", 30]", CALM);
        assert_eq!(form(&built).settle.values(), [0.5 * rate as f32, 30.0]);
    }
}

/// EI / w is l^3 for a heavy elastica: EI / lambda = 3/8 A L K d^2 and w / lambda = A gravity.
#[test]
fn hair_bends_under_its_weight_within_the_length_that_is_given() {
    for (free, gravity) in [("gravity = \"1 g\"", None), ("gravity = 140", Some(140.0))] {
        let built = built("", &format!("{free}\nstiffness = [\"9 cm\", 2000, \"4.5 cm\"]"), CALM);
        let form = form(&built);
        assert_eq!(gravity.unwrap_or(form.gravity), form.gravity);
        let strands = built.strands();
        let mean = strands.lengths().map(f64::from).sum::<f64>() / strands.len() as f64;
        let d = f64::from(built.dynamics.segment_length);
        let push = push(&built.dynamics, mean);
        let length = |k: f32| {
            let bending = 0.375 * push * mean * f64::from(k) * d * d;
            (bending / (push * f64::from(form.gravity))).cbrt()
        };
        let &[root, middle, tip] = form.stiffness.values() else { panic!("three numbers") };
        assert_eq!(middle, 2000.0);
        // K has 24 bits, and a third of their error is left in the length.
        assert!((length(root) / 9.0 - 1.0).abs() < 1e-7 && (length(tip) / 4.5 - 1.0).abs() < 1e-7, "{root} {tip}");
    }
}

#[test]
fn a_wind_of_some_speed_moves_hair_as_the_strength_that_carries_it_so_fast_does() {
    for (motion, free) in [
        ("", "settle = \"0.6 s\""),
        ("frame_rate = 25\nslow = 3\ninertia_length_floor = 15", "settle = [10, 30, 20]\ngravity = \"1 g\""),
    ] {
        let by_speed = built(motion, free, "vector = [-3, 0, 4]\nspeed = \"18 km/h\"");
        let [key] = by_speed.forces.intervals() else { panic!("one interval") };
        let [x, y, z] = key.vector.to_array();
        let by_strength = built(motion, free, &format!("vector = [{x}, {y}, {z}]"));
        assert_eq!(film(&by_speed), film(&by_strength));
        assert_eq!(by_speed.identity().unwrap(), by_strength.identity().unwrap(), "two spellings of one motion");
        // Speed, u = A F / alpha, in cm a frame of the film that is slowed.
        let strands = by_speed.strands();
        let mean = strands.lengths().map(f64::from).sum::<f64>() / strands.len() as f64;
        let (slow, rate) = (f64::from(by_speed.dynamics.motion.slow), by_speed.dynamics.motion.frame_rate);
        let settle = if slow == 1.0 { 0.6 * rate } else { (10.0 + 30.0 + 30.0 + 20.0) / 4.0 };
        let speed = push(&by_speed.dynamics, mean) * f64::from(key.vector.length()) * settle * slow / 2.0;
        assert!((speed * rate * slow / 500.0 - 1.0).abs() < 1e-6, "{speed} cm a frame");
        assert!(key.vector.normalize().distance(Vec3::new(-0.6, 0.0, 0.8)) < 1e-6);
    }
}

/// Limp hair that nothing holds ends up along the wind; on its way there each node is carried by it, and what the chain pulls it back by is
/// against the wind in the mean. A tip may whip ahead of its strand, the middle of all hair may not.
#[test]
fn hair_that_nothing_holds_goes_no_faster_than_the_wind_that_carries_it() {
    let free = "stiffness = 0\nhold = 0\ngravity = 0\nsettle = \"0.4 s\"";
    let built = built("inertia_length_floor = 30", free, "vector = [0, -1, 0]\nspeed = \"2 m/s\"");
    let (mut timeline, count) = (built.timeline().unwrap(), built.strands().points().len());
    let film = timeline.play();
    let middle = |n: u32| film.points(n).iter().sum::<Vec3>() / count as f32;
    let rate = built.dynamics.motion.frame_rate as f32;
    let speeds: Vec<f32> = (1..=film.frames()).map(|n| (middle(n - 1).y - middle(n).y) * rate).collect();
    let fastest = speeds.iter().copied().fold(0.0, f32::max);
    assert!(fastest > 0.0 && fastest <= 200.0, "{fastest} cm/s");
}

/// The line that a scene is refused with.
fn refused(text: &str) -> String {
    let line = match Scene::parse(text, Path::new("a.toml"), &[]) {
        Err(refused) => refused.to_string(),
        Ok(scene) => scene.build(Shown::All).map(drop).unwrap_err().to_string(),
    };
    assert_eq!(line.lines().count(), 1, "{line}");
    line
}

#[test]
fn what_is_no_quantity_and_what_has_no_meaning_is_refused_where_it_stands() {
    let speed = "vector = [1, 0, 0]\nspeed = ";
    let wind = |value: &str| refused(&text("", "", &format!("{speed}{value}")));
    let speeds = "a speed, \"20 km/h\", \"5 m/s\" or \"300 cm/s\"";
    assert_eq!(wind("\"20 knots\""), format!("a.toml:12: force[0].speed: found \"20 knots\", must be {speeds}"));
    assert_eq!(wind("20"), format!("a.toml:12: force[0].speed: found 20, must be {speeds}"));
    assert_eq!(wind("\"-5 m/s\""), "a.toml:12: force[0].speed = -5 m/s: must not be below 0");
    assert_eq!(
        refused(&text("", "", "vector = [0, 0, 0]\nspeed = \"5 m/s\"")),
        "a.toml:12: force[0].speed = 5 m/s: a wind of this speed needs a direction: set vector"
    );
    assert_eq!(
        refused(&text("", "", &format!("{speed}\"5 m/s\"")).replace("\"free\"", "\"paper\"")),
        "a.toml:12: force[0].speed = 5 m/s: the paper's form has no air to carry hair: set motion.form = \"free\", or give the strength in vector"
    );
    assert_eq!(
        refused(&text("", "settle = \"0 s\"", &format!("{speed}\"5 m/s\""))),
        "a.toml:12: force[0].speed = 5 m/s: with free.settle = 0 there is no air to carry hair: give settle, or give the strength in vector"
    );
    let free = |line: &str| refused(&text("", line, CALM));
    assert_eq!(
        free("stiffness = [\"9 cm\", \"4.5 mm\"]"),
        "a.toml:8: free.stiffness[1]: found \"4.5 mm\", must be a number, or a length, \"4.5 cm\""
    );
    assert_eq!(
        free("settle = \"1 g\""),
        "a.toml:8: free.settle: found \"1 g\", must be a number, or a time, \"0.8 s\""
    );
    assert_eq!(free("stiffness = \"-9 cm\""), "a.toml:8: free.stiffness = -9 cm: must not be below 0");
    assert_eq!(
        free("stiffness = [900, \"4.5 cm\"]\ngravity = 0"),
        "a.toml:8: free.stiffness = 4.5 cm: a bending length needs gravity: give gravity, or a number"
    );
    assert_eq!(
        free("stiffness = true"),
        "a.toml:8: free.stiffness: found true, must be a number, or a list of numbers from root to tip"
    );
}

#[test]
fn a_setting_keeps_what_was_written_and_another_takes_its_place() {
    let given = text(
        "",
        "gravity = \"earth\"   # true timing\nstiffness = [ \"9.0 cm\", 500 ]",
        "vector = [-1, 0, 0]\nspeed = \"5m/s\" # a breeze",
    );
    let scene = parse(&given);
    assert_eq!(scene.to_toml().unwrap(), given);
    let changed = scene.with_setting("free.stiffness[0]", Some("8 cm".into())).unwrap();
    assert_eq!(changed.to_toml().unwrap(), given.replace("\"9.0 cm\"", "\"8 cm\""));
    let changed = scene.with_setting("force[0].speed", None).unwrap();
    let (left, gone) = (changed.to_toml().unwrap(), "speed = \"5m/s\" # a breeze\n");
    assert_eq!(left, given.replace(gone, ""));
}

#[test]
fn what_a_solver_leaves_as_it_was_stays_as_it_was_given() {
    let force =
        "vector = [-1, 0, 0]\nspeed = \"18 km/h\"\n[[force]]\nthrough = 30\nvector = [0, 1, 0]\nspeed = \"2 m/s\"";
    let built = built("", "stiffness = \"4.5 cm\"\nsettle = \"0.6 s\"", force);
    let keyframes = built.forces.intervals().to_vec();
    let (stiffness, settle) = (Some(form(&built).stiffness.clone()), Some(form(&built).settle.clone()));
    let mut answer = Answer { keyframes, gust: None, stiffness, settle };
    let accepted = |answer: &Answer| {
        let mut scene = built.scene.clone();
        scene.accept(answer, &built);
        scene
    };
    assert_eq!(accepted(&answer), built.scene, "nothing was found");
    // Another border keeps the speed on both sides, another vector takes the place of its own.
    answer.keyframes[0].through = 15;
    answer.keyframes[1].vector.y += 1.0;
    let scene = accepted(&answer);
    let [first, second] = scene.field.force[..] else { panic!("two intervals") };
    assert_eq!((first.through, first.vector, first.speed), (15, Vec3::NEG_X, built.scene.field.force[0].speed));
    assert_eq!((second.vector, second.speed), (answer.keyframes[1].vector, None));
    assert_eq!(scene.free, built.scene.free);
    // Hair that settles in another time would be carried as fast by another strength.
    answer.settle = Some(9.0.into());
    let scene = accepted(&answer);
    assert!(scene.field.force.iter().all(|force| force.speed.is_none()));
    assert_eq!((&scene.free.stiffness, scene.free.settle.values()), (&built.scene.free.stiffness, &[9.0.into()][..]));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// What is written is read again to the bit.
    #[test]
    fn quantities_are_written_and_read_as_they_are(numbers in prop::array::uniform5(0.0_f32..1e6), unit in 0_usize..3) {
        let [a, b, c, d, e] = numbers;
        let unit = ["cm/s", "m/s", "km/h"][unit];
        let free = format!("stiffness = [\"{a} cm\", {b}]\nhold = \"{c} g\"\nsettle = \"{d} s\"\ngravity = \"1 g\"");
        let scene = parse(&text("", &free, &format!("vector = [1, 2, 3]\nspeed = \"{e} {unit}\"")));
        let mut moved = parse("[[force]]\nthrough = 1\nvector = [1, 0, 0]\n");
        (moved.free, moved.form) = (scene.free.clone(), scene.form);
        moved.field.force.clone_from(&scene.field.force);
        let again = parse(&moved.to_toml().unwrap());
        prop_assert_eq!((&again.free, &again.field), (&scene.free, &scene.field));
        let of_settings = scene.with_setting("free", scene.setting("free").unwrap()).unwrap();
        prop_assert_eq!(of_settings, scene);
    }
}
