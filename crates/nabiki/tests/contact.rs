//! The laws of contact: what must be true of hair that meets bodies, for both twins where both step it.

mod common;

use std::sync::Arc;

use common::{ball, bits, exact, fast, field, gust, run_under};
use glam::{Quat, Vec3};
use nabiki::body::{Body, BodyWay, Contact, skin_of};
use nabiki::dynamics::{Dynamics, Form, Stepper};
use nabiki::free_form::{FreeForm, FreeMotion, Tie};
use nabiki::pseudo_force::PseudoForce;
use nabiki::{Mesh, Pose, Profile, Strands};

/// A box about the origin.
fn board(half: Vec3) -> Mesh {
    let corner = |i: u32| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32);
    let squares = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    Mesh {
        positions: (0..8).map(|i| half * (2.0 * corner(i) - 1.0)).collect(),
        triangles: squares.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect(),
        ..Mesh::default()
    }
}

fn body(mesh: Mesh, way: BodyWay, contact: Contact) -> Body {
    Body::new("body[0]", Arc::new(skin_of(mesh, "body[0].mesh").unwrap()), way, contact)
}

fn at(place: Vec3) -> BodyWay {
    BodyWay::InWorld(Arc::new([Pose { position_cm: place, rotation: Quat::IDENTITY }]))
}

fn free(form: FreeForm, body: Body, frames: u32) -> Dynamics {
    let free = FreeMotion { form, bodies: vec![body], ..Default::default() };
    let mut dynamics = Dynamics { pseudo_force: PseudoForce::off(), form: Form::Free(free), ..gust() };
    dynamics.motion.frames = frames;
    dynamics.motion.inertia_length_floor = 12.0;
    dynamics
}

/// Neither stiffness nor anything else but what is in the way.
fn limp() -> FreeForm {
    FreeForm { stiffness: 0.0.into(), hold: 0.0.into(), settle: 0.0.into(), gravity: 0.0, ..Default::default() }
}

fn twins(hair: &Strands, dynamics: &Dynamics, pushes: &nabiki::field::KeyframedField) -> [Box<dyn Stepper>; 2] {
    [Box::new(exact(hair, dynamics, pushes)), Box::new(fast(hair, dynamics, pushes))]
}

/// A head that turns about y by so much in each frame (rad).
fn turning(by: f32, frames: u32) -> Vec<Pose> {
    (0..=frames).map(|n| Pose { position_cm: Vec3::ZERO, rotation: Quat::from_rotation_y(by * n as f32) }).collect()
}

/// When distances are asked for depends on the longest strand that is stepped: what comes of it must not, at any margin and where hair
/// rests in a body, too.
#[test]
fn hair_keeps_its_bits_beside_a_longer_strand() {
    const FRAMES: u32 = 120;
    let mut hair = Strands::default();
    for s in 0..16 {
        hair.push((0..=12).map(|i| Vec3::new(0.97 * i as f32, 10.0, -6.0 + 0.75 * s as f32)));
    }
    let mut with_long = hair.clone();
    with_long.push((0..=70).map(|i| Vec3::new(-(i as f32), 10.0, 0.0)));
    let gusts: Vec<(u32, [f32; 3])> = (1..=12)
        .map(|k| (10 * k, k as f32))
        .map(|(n, k)| (n, [20.0 * k.sin(), -60.0 + 80.0 * (1.7 * k).cos(), 60.0 * (0.9 * k).sin()]))
        .collect();
    let gusts = field(&gusts);
    let mut seed = 12_345_u64;
    let mut random = move || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 40) as f32 / (1_u64 << 24) as f32
    };
    let mut moved = 0;
    for largest in [0.1, 1.0, 5.0].repeat(10) {
        let margin = largest * (0.4 + 0.6 * random());
        let place = Vec3::new(4.0 + 12.0 * random(), -12.0 + 24.0 * random(), 1.0);
        let contact = Contact { margin, friction: 0.3, static_friction: 0.4 };
        let body = body(ball(1.5 + 4.0 * random()), at(place), contact);
        let stiffness = Profile::RootToTip(vec![2000.0, 200.0]);
        let dynamics = free(FreeForm { stiffness, gravity: 0.0, ..Default::default() }, body, FRAMES);
        let poses = turning(0.0001 + 0.002 * random(), FRAMES);
        let alone = run_under(&mut fast(&hair, &dynamics, &gusts), &gusts, &poses);
        let beside = run_under(&mut fast(&with_long, &dynamics, &gusts), &gusts, &poses);
        let beside = beside.select(&(0..hair.len()).collect::<Vec<_>>());
        assert!(bits(&alone) == bits(&beside), "margin {margin}, ball at {place}");
        let mut bodiless = dynamics.clone();
        if let Form::Free(free) = &mut bodiless.form {
            free.bodies.clear();
        }
        moved += u32::from(bits(&alone) != bits(&run_under(&mut fast(&hair, &bodiless, &gusts), &gusts, &poses)));
    }
    assert!(moved > 10, "{moved} of 30 balls are touched");
}

/// Hair that is pressed to a body and held by friction goes where that goes, however far it would stay behind the head's turn.
#[test]
fn friction_holds_hair_on_a_body_while_the_head_turns() {
    const FRAMES: u32 = 40;
    let turn = 0.5_f32.to_radians();
    let mut hair = Strands::default();
    hair.push([Vec3::new(0.0, 14.0, 0.0), Vec3::new(10.0, 14.0, 0.0)]);
    let down = field(&[(FRAMES, [0.0, -200.0, 0.0])]);
    let poses = turning(turn, FRAMES);
    let (mesh, place) = (board(Vec3::new(6.0, 1.0, 12.0)), Vec3::new(10.0, 12.9, 0.0));
    let contact = Contact { margin: 0.05, friction: 5.0, static_friction: 10.0 };
    let worn = {
        let mut worn = mesh.clone();
        worn.positions.iter_mut().for_each(|p| *p += place);
        worn
    };
    for (way, mesh, goes) in [(at(place), &mesh, 0.0), (BodyWay::WithHead, &worn, turn * FRAMES as f32)] {
        for drag in [0.0, 0.6, 1.0, 3.0] {
            let form = FreeForm {
                stiffness: 0.0.into(),
                hold: 0.0.into(),
                settle: 2.0.into(),
                gravity: 0.0,
                drag: drag.into(),
                ..Default::default()
            };
            let dynamics = free(form, body(mesh.clone(), way.clone(), contact), FRAMES);
            for mut stepper in twins(&hair, &dynamics, &down) {
                let tip = run_under(&mut *stepper, &down, &poses).strand(0)[1];
                let in_world = poses[FRAMES as usize].rotation * tip;
                let azimuth = (-in_world.z).atan2(in_world.x);
                // In the first frame nothing has pressed it yet, and it goes as far as the head and it may turn in one.
                assert!((azimuth - goes).abs() <= 1.5 * turn, "drag {drag}: {} degrees", azimuth.to_degrees());
            }
        }
    }
}

/// What is tied goes with the head, whatever passes; what is not is pushed aside.
#[test]
fn no_body_moves_hair_before_its_band() {
    const FRAMES: u32 = 40;
    let mut hair = Strands::default();
    for z in [0.0, 1.0] {
        hair.push((0..=12).map(|i| Vec3::new(-10.0 - i as f32, 3.0, z)));
    }
    let falls = (0..=FRAMES)
        .map(|n| Pose { position_cm: Vec3::new(-13.0, 15.0 - 0.6 * n as f32, 0.3), rotation: Quat::IDENTITY })
        .collect::<Vec<_>>();
    let contact = Contact { margin: 0.1, friction: 0.3, static_friction: 0.4 };
    let tie = Some(Tie { at: hair.strand(0)[6], within: 0.2 });
    let stiffness = Profile::RootToTip(vec![2000.0, 200.0]);
    let dynamics = free(
        FreeForm { tie, stiffness, ..Default::default() },
        body(ball(2.0), BodyWay::InWorld(falls.into()), contact),
        FRAMES,
    );
    let calm = field(&[(FRAMES, [0.0; 3])]);
    for mut stepper in twins(&hair, &dynamics, &calm) {
        let mut farthest = 0.0_f32;
        for frame in 1..=FRAMES {
            stepper.step_frame(&nabiki::dynamics::FrameInput::new(frame, &[], &calm));
            assert_eq!(stepper.strands().strand(0)[..=6], hair.strand(0)[..=6], "frame {frame}");
            farthest = farthest.max(stepper.strands().strand(1)[6].distance(hair.strand(1)[6]));
        }
        assert!(farthest > 1.0, "{farthest} cm: the ball pushes what is not tied");
    }
}

/// Coulomb's law, in the first frame of a tip that rests on a board: pushed inward by N and along by T it stays while T is below
/// `static_friction` N, and else goes as T - `friction` N would take it.
#[test]
fn what_rests_on_a_body_slides_by_what_friction_leaves() {
    let mut hair = Strands::default();
    hair.push([Vec3::new(0.0, 14.0, 0.0), Vec3::new(10.0, 14.0, 0.0)]);
    let contact = Contact { margin: 0.05, friction: 0.5, static_friction: 0.8 };
    let board = body(board(Vec3::new(12.0, 1.0, 12.0)), at(Vec3::new(10.0, 12.95, 0.0)), contact);
    let dynamics = free(limp(), board, 1);
    // Both steps of a frame speed it up as much, and go on with the new speed: half of a half, and half of a whole.
    let moves = 0.75 * nabiki::dynamics::push(&dynamics, 10.0) as f32;
    let inward = 20.0;
    for (along, left) in [(10.0, 0.0), (15.0, 0.0), (17.0, 7.0), (40.0, 30.0)] {
        let pushes = field(&[(1, [0.0, -inward, along])]);
        for mut stepper in twins(&hair, &dynamics, &pushes) {
            let tip = run_under(&mut *stepper, &pushes, &[Pose::STILL; 2]).strand(0)[1];
            // Of turns of up to 4 thousandths the sine differs by 1e-8, on 10 cm, and roundings are of 1e-6 cm.
            assert!((tip.z - moves * left).abs() < 2e-6, "{along}: {} cm, not {}", tip.z, moves * left);
            assert!((tip.y - 14.0).abs() < 1e-4, "{along}: {} cm inward", 14.0 - tip.y);
        }
    }
}

/// What falls on a board lies on it in the frame in which it comes there: it neither stops in the air, by whatever a frame moves it,
/// nor goes through.
#[test]
fn what_falls_on_a_body_goes_on_until_it_touches() {
    const FRAMES: u32 = 20;
    let (length, margin) = (10.0, 0.1);
    let mut hair = Strands::default();
    for i in 0..32 {
        let height = 1.0 + 0.03 * i as f32;
        hair.push([Vec3::new(0.0, height, 0.0), Vec3::new(length, height, 0.0)]);
    }
    let contact = Contact { margin, friction: 0.0, static_friction: 0.0 };
    let board = body(board(Vec3::new(12.0, 4.0, 12.0)), at(Vec3::new(10.0, -4.0, 0.0)), contact);
    let (beside, down) = (free(limp(), board, FRAMES), field(&[(FRAMES, [0.0, -40.0, 0.0])]));
    let mut alone = beside.clone();
    if let Form::Free(free) = &mut alone.form {
        free.bodies.clear();
    }
    let push = nabiki::dynamics::push(&beside, length.into()) as f32;
    let slowed_cm = 0.4 * 0.25 * 40.0 * push;
    for (mut falls, mut flies) in twins(&hair, &beside, &down).into_iter().zip(twins(&hair, &alone, &down)) {
        let mut fastest = 0.0_f32;
        for frame in 1..=FRAMES {
            let before = flies.strands().clone();
            for stepper in [&mut falls, &mut flies] {
                stepper.step_frame(&nabiki::dynamics::FrameInput::new(frame, &[], &down));
            }
            for s in 0..hair.len() {
                let [tip, free, was] = [falls.strands(), flies.strands(), &before].map(|hair| hair.strand(s)[1].y);
                if free >= margin {
                    // What its speed at the end of a step would carry in is slowed in that step, of which it goes on with six tenths.
                    assert!(
                        (tip - free).abs() < 1e-5 + slowed_cm,
                        "strand {s}, frame {frame}: {tip}, {free} with nothing in the way"
                    );
                    continue;
                }
                fastest = fastest.max(was - free);
                // On a circle the end goes aside as well, by the square of a frame's way over the length; the plane is sampled. And of a push
                // along the normal a segment that points down by an angle a goes with cos^2 a of it: of a step's way sin^2 a is left, which
                // the body holds for a press, and answers three times.
                let down = (hair.strand(s)[0].y - margin) / length;
                let in_a_step = 0.5 * (was - free + 40.0 * push);
                let off = (was - free).powi(2) / length + 3.0 * in_a_step * down * down + 1e-3;
                assert!((tip - margin).abs() < off, "strand {s}, frame {frame}: {tip} cm, and {} a frame", was - free);
            }
        }
        assert!(fastest > 0.3, "{fastest} cm a frame: what falls is fast");
    }
}

/// A tip that is turned out as far as seven turns go, and is out by the last of them, goes no farther.
#[test]
fn a_segment_is_turned_out_no_farther_than_it_must() {
    let margin = 0.1;
    let mut hair = Strands::default();
    hair.push([Vec3::new(0.28, 0.0, 0.0), Vec3::new(0.28, 3.0, 0.0), Vec3::new(margin, 3.087_178, 0.0)]);
    let contact = Contact { margin, friction: 0.0, static_friction: 0.0 };
    let wall = body(board(Vec3::new(8.0, 40.0, 40.0)), at(Vec3::new(-8.0, 0.0, 0.0)), contact);
    // In one step: a second one would lift the tip by what the first left it pressed.
    let mut dynamics = free(FreeForm { substeps: Some(1), ..limp() }, wall, 1);
    dynamics.motion.inertia_length_floor = 25.0;
    dynamics.motion.time_step = 0.2;
    let mut farthest = 0.0_f32;
    for push in (3000..=5200).step_by(50) {
        let pushes = field(&[(1, [-push as f32, 0.0, 0.0])]);
        for mut stepper in twins(&hair, &dynamics, &pushes) {
            let moved = run_under(&mut *stepper, &pushes, &[Pose::STILL; 2]);
            let [_, joint, tip] = moved.strand(0) else { panic!("three points") };
            // The plane is sampled; what its speed would carry in is slowed before it is there, by some of a step.
            assert!((-1e-3..0.03).contains(&(tip.x - margin)), "{push}: {} cm before the wall", tip.x);
            farthest = farthest.max((*tip - *joint).angle_between(hair.strand(0)[2] - hair.strand(0)[1]));
        }
    }
    assert!(farthest > 0.65, "{farthest} rad: nearly seven turns of a tenth");
}

/// Pressed into the corner between two bodies, hair enters neither.
#[test]
fn hair_in_a_corner_between_two_bodies_is_in_neither() {
    const FRAMES: u32 = 100;
    let margin = 0.1;
    let mut hair = Strands::default();
    for s in 0..48 {
        let root = Vec3::new(2.0 + 0.1 * (s % 7) as f32, 6.0, 0.5 * s as f32 - 12.0);
        let length = 0.8 + 0.012 * s as f32;
        hair.push((0..=12).map(|i| root + length * i as f32 * Vec3::new(0.9, 0.3, 0.316)));
    }
    let contact = Contact { margin, friction: 0.2, static_friction: 0.3 };
    let wall = body(board(Vec3::new(8.0, 40.0, 40.0)), at(Vec3::new(-8.0, 0.0, 0.0)), contact);
    let floor = body(board(Vec3::new(40.0, 8.0, 40.0)), at(Vec3::new(0.0, -8.0, 0.0)), contact);
    let form = FreeForm { stiffness: Profile::RootToTip(vec![300.0, 30.0]), gravity: 0.0, ..Default::default() };
    let mut dynamics = free(form, wall, FRAMES);
    if let Form::Free(free) = &mut dynamics.form {
        free.bodies.push(floor);
    }
    let pushes = field(&[(50, [-150.0, -300.0, 0.0]), (FRAMES, [-300.0, -150.0, 60.0])]);
    for mut stepper in twins(&hair, &dynamics, &pushes) {
        let mut pressed = 0;
        for frame in 1..=FRAMES {
            stepper.step_frame(&nabiki::dynamics::FrameInput::new(frame, &[], &pushes));
            for p in stepper.strands().points() {
                assert!(p.x.min(p.y) > margin - 0.01, "frame {frame}: {p}");
                pressed += u32::from(p.x.max(p.y) < 2.0 * margin);
            }
        }
        assert!(pressed > 1000, "{pressed} nodes lie in the corner");
    }
}
