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
    let name = "body[0]".to_owned();
    Body { distance: Arc::new(skin_of(mesh, "body[0].mesh").unwrap()), name, filled: None, way, contact }
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

/// Hair that is pressed to a body and held by friction goes where that goes, however far it would lag behind the head's turn.
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
        for lag in [0.0, 1.0, 8.0] {
            let form = FreeForm {
                stiffness: 0.0.into(),
                hold: 0.0.into(),
                settle: 2.0.into(),
                gravity: 0.0,
                lag,
                ..Default::default()
            };
            let dynamics = free(form, body(mesh.clone(), way.clone(), contact), FRAMES);
            let steppers: [Box<dyn Stepper>; 2] =
                [Box::new(exact(&hair, &dynamics, &down)), Box::new(fast(&hair, &dynamics, &down))];
            for mut stepper in steppers {
                let tip = run_under(&mut *stepper, &down, &poses).strand(0)[1];
                let in_world = poses[FRAMES as usize].rotation * tip;
                let azimuth = (-in_world.z).atan2(in_world.x);
                // In the first frame nothing has pressed it yet, and it goes as far as the head and it may turn in one.
                assert!((azimuth - goes).abs() <= 1.5 * turn, "lag {lag}: {} degrees", azimuth.to_degrees());
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
    let steppers: [Box<dyn Stepper>; 2] =
        [Box::new(exact(&hair, &dynamics, &calm)), Box::new(fast(&hair, &dynamics, &calm))];
    for mut stepper in steppers {
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
    let form =
        FreeForm { stiffness: 0.0.into(), hold: 0.0.into(), settle: 0.0.into(), gravity: 0.0, ..Default::default() };
    let dynamics = free(form, board, 1);
    let c = nabiki::dynamics::gain(&dynamics, 5.0 + 0.5, 10.0) as f32;
    let inward = 20.0;
    for (along, left) in [(10.0, 0.0), (15.0, 0.0), (17.0, 7.0), (40.0, 30.0)] {
        let pushes = field(&[(1, [0.0, -inward, along])]);
        let steppers: [Box<dyn Stepper>; 2] =
            [Box::new(exact(&hair, &dynamics, &pushes)), Box::new(fast(&hair, &dynamics, &pushes))];
        for mut stepper in steppers {
            let tip = run_under(&mut *stepper, &pushes, &[Pose::STILL; 2]).strand(0)[1];
            // Of turns of up to 4 thousandths the sine differs by 1e-8, on 10 cm, and roundings are of 1e-6 cm.
            assert!((tip.z - 10.0 * c * left).abs() < 2e-6, "{along}: {} cm, not {}", tip.z, 10.0 * c * left);
            assert!((tip.y - 14.0).abs() < 1e-4, "{along}: {} cm inward", 14.0 - tip.y);
        }
    }
}
