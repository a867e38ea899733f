//! The free form among other hair, against the head, and on a head that speeds up; how it comes back to rest.

mod common;

use std::sync::Arc;

use common::{exact, fast, field, free_motion, hair, mixed_hair, run, run_under, step, way_of_a_head};
use glam::Vec3;
use nabiki::body::{Body, Contact, Surface};
use nabiki::dynamics::{Dynamics, Form, Simulation, Stepper, earth_gravity, gain};
use nabiki::field::Field;
use nabiki::free_form::{FreeForm, FreeMotion, NeighbourForces, Neighbours};
use nabiki::{Head, Pose, Profile, Strands};
use nabiki_groom::{Growth, Hairline, Style, bust, grow};

const FRAMES: u32 = 30;

fn calm() -> impl Field {
    field(&[(1000, [0.0; 3])])
}

fn free(motion: FreeMotion) -> Dynamics {
    let mut dynamics = free_motion(motion);
    // Strands of a few centimetres would swing too fast.
    dynamics.motion.inertia_length_floor = 14.0;
    dynamics
}

/// Everything at once: a head in the way, other hair, weight, and strengths that differ from root to tip.
fn everything(carriers: Strands, rest_pose: Pose) -> Dynamics {
    let form =
        FreeForm { stiffness: Profile::RootToTip(vec![900.0, 100.0]), gravity: 60.0.into(), ..Default::default() };
    free(FreeMotion {
        form,
        bodies: vec![Body::head(&bust(), Contact::default())],
        neighbours: Some(Neighbours::new(NeighbourForces::default(), Arc::new(carriers))),
        rest_pose,
    })
}

fn wind() -> Arc<dyn Field> {
    Arc::new(field(&[(15, [-100.0, 20.0, 30.0]), (FRAMES, [-15.0, -150.0, 0.0])]))
}

#[test]
fn segments_keep_their_length_among_all_that_moves_them() {
    let (strands, poses, wind) = (mixed_hair(120), way_of_a_head(FRAMES), wind());
    let dynamics = everything(strands.select(&(0..24).collect::<Vec<_>>()), poses[0]);
    let moved = run_under(&mut fast(&strands, &dynamics, &*wind), &*wind, &poses);
    let lengths = |strands: &Strands| -> Vec<f32> {
        strands.iter().flat_map(|s| s.windows(2).map(|w| w[0].distance(w[1])).collect::<Vec<_>>()).collect()
    };
    let change = lengths(&moved).iter().zip(lengths(&strands)).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
    // Three coordinates of up to 32 cm, rounded at both ends, and a direction to some parts in 1e7.
    assert!(change < 1e-5, "{change}");
}

#[test]
fn a_grid_that_would_not_fit_is_refused_with_its_size() {
    let mut strands = Strands::default();
    strands.push((0..=200).map(|i| Vec3::new(i as f32, 0.0, 0.0)));
    let mut dynamics = everything(strands.clone(), Pose::STILL);
    if let Form::Free(motion) = &mut dynamics.form {
        motion.neighbours.as_mut().unwrap().forces.cell = 0.5;
    }
    let refused = Simulation::new(&strands, &dynamics, &calm()).unwrap_err();
    assert_eq!(refused.thing, "neighbours.cell");
}

#[test]
fn finer_cuts_bend_alike() {
    let form = FreeForm { stiffness: 600.0.into(), hold: 5.0.into(), gravity: 0.0.into(), ..Default::default() };
    let dynamics = free(FreeMotion { form, ..Default::default() });
    let blows = field(&[(1000, [-60.0, 0.0, 20.0])]);
    let tips = |segments: usize| -> Vec<glam::DVec3> {
        let mut stepper = exact(&hair(40, segments), &dynamics, &blows);
        run(&mut stepper, &blows, 300);
        stepper.positions().chunks(segments + 1).map(|strand| strand[segments]).collect()
    };
    let [coarse, middle, fine, finest] = [9, 18, 36, 72].map(tips);
    let steps = [(&coarse, &middle), (&middle, &fine), (&fine, &finest)].map(|(a, b)| {
        let mut distances: Vec<f64> = a.iter().zip(b).map(|(a, b)| a.distance(*b)).collect();
        distances.sort_by(f64::total_cmp);
        distances[distances.len() / 2]
    });
    println!("{steps:?}");
    // The root's joint lies half a segment before the middle of the first: the error is of first order.
    for w in steps.windows(2) {
        let ratio = w[0] / w[1];
        assert!((1.6..5.0).contains(&ratio), "{steps:?}");
    }
}

#[test]
fn a_head_that_speeds_up_is_felt_as_a_force_the_other_way() {
    let strands = hair(40, 18);
    // 2 cm, times the square of the rate: in f32 to the bit.
    let (rate, gravity) = (24.0_f64, 100.0);
    let poses: Vec<Pose> =
        (0..=FRAMES).map(|n| Pose { position_cm: Vec3::new((n * n) as f32, 0.0, 0.0), ..Pose::STILL }).collect();
    let form = FreeForm { gravity: gravity.into(), ..Default::default() };
    let dynamics = free(FreeMotion { form, ..Default::default() });
    let felt = -f64::from(gravity) * 2.0 * rate * rate / 981.0;
    // Before frame 0 the head goes as it goes from there on, evenly: it is felt from frame 2 on.
    let pulls = field(&[(1, [0.0; 3]), (1000, [felt as f32, 0.0, 0.0])]);
    let under_force = run(&mut exact(&strands, &dynamics, &pulls), &pulls, FRAMES);
    let carried = run_under(&mut exact(&strands, &dynamics, &calm()), &calm(), &poses);
    let farthest =
        |a: &Strands, b: &Strands| a.points().iter().zip(b.points()).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
    assert!(farthest(&carried, &strands) > 1.0);
    // The force in f32 is off by 3e-8 of itself, points of 30 cm by 2e-6.
    assert!(farthest(&carried, &under_force) < 2e-5, "{}", farthest(&carried, &under_force));
}

#[test]
fn the_earth_s_gravity_depends_on_length_and_frame_rate() {
    let mut dynamics = free(FreeMotion::default());
    dynamics.motion.inertia_length_floor = 0.0;
    dynamics.motion.frame_rate = 120.0;
    // c = 3 k d dt^2 / (2 lambda k^4 d^3) with k = 18, and c F = 3 / (2 18) 981 / 120^2.
    let expected = 1.5 / 18.0 * 981.0 / 14_400.0 / (3.0 * 18.0 * 0.01 / (0.1 * 18.0_f64.powi(4)));
    let found = f64::from(earth_gravity(&dynamics, 18.0));
    assert!((found / expected - 1.0).abs() < 1e-6 && (found - 110.0).abs() < 1.0, "{found}");
    dynamics.motion.frame_rate = 24.0;
    assert!((f64::from(earth_gravity(&dynamics, 18.0)) / (25.0 * expected) - 1.0).abs() < 1e-6);
}

/// Hair of the default style on the built-in head.
fn grown(head: &Head, strands: usize) -> Strands {
    let (hairline, style) = (Hairline::default(), Style::default());
    let growth = Growth { hairline: &hairline, style: &style, strands, segments: 18, segment_length: 1.0, seed: 1 };
    grow(head, &growth, strands).unwrap().strands
}

#[test]
fn hair_stays_out_of_the_head_without_kinks_and_comes_back_to_rest() {
    let head = bust();
    let strands = grown(&head, 400);
    let body = Body::head(&head, Contact::default());
    let form = FreeForm {
        stiffness: Profile::RootToTip(vec![12_000.0, 1000.0]),
        hold: 30.0.into(),
        settle: 20.0.into(),
        gravity: 100.0.into(),
        ..Default::default()
    };
    let mut dynamics = free(FreeMotion { form, bodies: vec![body.clone()], ..Default::default() });
    dynamics.motion.inertia_length_floor = 18.0;
    let kept: Vec<(Surface, f32)> = strands.points().iter().map(|p| body.kept_from(*p)).collect();
    let blows = field(&[(25, [-200.0, 0.0, 0.0]), (50, [60.0, 50.0, 180.0]), (1000, [0.0; 3])]);
    let mut stepper = fast(&strands, &dynamics, &blows);
    let (mut deepest, mut sharpest, mut farthest) = (0.0_f32, 1.0_f32, 0.0_f32);
    let mut moved = 0.0_f32;
    for _ in 0..450 {
        let before = stepper.strands().clone();
        step(&mut stepper, &blows);
        let now = stepper.strands();
        for (p, (surface, clearance)) in now.points().iter().zip(&kept) {
            if let Some(at) = body.surface(*surface).read(*p, 0) {
                deepest = deepest.max(clearance - at.distance);
            }
        }
        for strand in now.iter() {
            for w in strand.windows(3) {
                sharpest = sharpest.min((w[1] - w[0]).normalize().dot((w[2] - w[1]).normalize()));
            }
        }
        let way = |a: &Strands, b: &Strands| {
            a.points().iter().zip(b.points()).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max)
        };
        (moved, farthest) = (way(&before, now), farthest.max(way(&strands, now)));
    }
    let left = stepper.strands().points().iter().zip(strands.points()).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
    println!("deepest {deepest:e} sharpest {sharpest} farthest {farthest} left {left:e} moved {moved:e}");
    assert!(farthest > 6.0, "the wind moved it by {farthest} cm only");
    // Between samples half a centimetre apart the gradient jumps, and a push may go to and fro there until it has no turn
    // left: a tenth of the margin at the most.
    assert!(deepest < 0.01, "{deepest} cm too deep");
    assert!(sharpest > 0.5, "a kink of {} degrees", sharpest.acos().to_degrees());
    assert!(left < 1e-3 && moved < 1e-4, "{left} cm from rest, {moved} cm a frame");
}

/// The tip (part of the length) of a clamped, straight, level elastica of length 1 under a load P at its tip that points down:
/// EI theta'' = P cos theta with theta the angle below the level, theta(0) = 0, theta'(1) = 0; `load`: P L^2 / EI.
fn elastica_under_a_tip_load(load: f64) -> (f64, f64) {
    let steps = 4000;
    let h = 1.0 / f64::from(steps);
    // From the tip back to the clamp, for the slope there; midpoint rule.
    let shoot = |tip: f64| {
        let (mut theta, mut curvature, mut x, mut y) = (tip, 0.0, 0.0, 0.0);
        for _ in 0..steps {
            let (t, c) = (theta - 0.5 * h * curvature, curvature + 0.5 * h * load * theta.cos());
            (x, y) = (x + h * t.cos(), y + h * t.sin());
            (theta, curvature) = (theta - h * c, curvature + h * load * t.cos());
        }
        (theta, x, y)
    };
    let (mut low, mut high) = (0.0, std::f64::consts::FRAC_PI_2);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if shoot(middle).0 < 0.0 { low = middle } else { high = middle }
    }
    let (_, x, y) = shoot(low);
    (x, y)
}

#[test]
fn under_an_even_force_a_strand_bends_as_an_elastica_with_a_load_at_its_tip() {
    for load in [0.5, 2.0, 5.0] {
        let (x, y) = elastica_under_a_tip_load(load);
        let errors = [9, 18, 36].map(|segments: usize| {
            let length = 18.0;
            let mut strand = Strands::default();
            strand.push((0..=segments).map(|i| Vec3::new(length * i as f32 / segments as f32, 0.0, 0.0)));
            let force = 6.0_f32;
            let stiffness = force * length * length / load as f32;
            let form = FreeForm {
                stiffness: stiffness.into(),
                hold: 0.0.into(),
                settle: 100.0.into(),
                gravity: 0.0.into(),
                ..Default::default()
            };
            let dynamics = free(FreeMotion { form, ..Default::default() });
            let pulls = field(&[(1, [0.0, -force, 0.0])]);
            let mut stepper = exact(&strand, &dynamics, &pulls);
            run(&mut stepper, &pulls, 3000);
            let tip = stepper.positions()[segments] / f64::from(length);
            (tip - glam::DVec3::new(x, -y, 0.0)).length()
        });
        println!("load {load}: ({x}, {y}), errors {errors:?}");
        // The root's joint acts half a segment before the middle of the first: the error is of first order.
        assert!(errors[2] < 0.02, "{errors:?}");
        for w in errors.windows(2) {
            assert!((1.7..2.6).contains(&(w[0] / w[1])), "{errors:?}");
        }
    }
}

#[test]
fn strengths_too_great_for_the_step_are_refused_and_those_below_hold() {
    // Straight: a curved strand without friction gathers speed from the turning of its frames.
    let mut strands = Strands::default();
    for strand in hair(20, 18).iter() {
        let out = (strand[1] - strand[0]).normalize();
        strands.push((0..=18).map(|i| strand[0] + i as f32 * out));
    }
    let with = |stiffness: f64| {
        let form = FreeForm {
            stiffness: (stiffness as f32).into(),
            hold: 0.0.into(),
            settle: 0.0.into(),
            gravity: 0.0.into(),
            ..Default::default()
        };
        free(FreeMotion { form, ..Default::default() })
    };
    // The last segment has one joint, c_i 2 K < 4, the one before it two, c_i 4 K < 4.
    let largest = |i: f64| 4.0 / gain(&with(0.0), i, 18.0);
    let strongest = (largest(18.0) / 2.0).min(largest(17.0) / 4.0);
    let refused = Simulation::new(&strands, &with(1.001 * strongest), &calm()).unwrap_err();
    assert_eq!(refused.thing, "free.stiffness");
    let push = field(&[(3, [0.0, 0.0, 1.0]), (2000, [0.0; 3])]);
    let mut stepper = fast(&strands, &with(0.999 * strongest - 1.0), &push);
    let mut farthest = 0.0_f32;
    for _ in 0..2000 {
        step(&mut stepper, &push);
        let moved = stepper.strands().points().iter().zip(strands.points());
        farthest = moved.map(|(a, b)| a.distance(*b)).fold(farthest, f32::max);
    }
    // The push gives the tip 3 c_i d a frame, which the slowest swing keeps for some ten frames.
    assert!((1e-3..0.1).contains(&farthest), "{farthest}");
}

/// What cohesion takes of an increment is that increment times c_i l_i cohesion: more than twice of it would turn it about.
#[test]
fn cohesion_is_refused_from_the_bound_on_and_calms_hair_below_it() {
    let strands = hair(24, 18);
    let with = |cohesion: f64| {
        let form = FreeForm { hold: 0.0.into(), gravity: 0.0.into(), ..Default::default() };
        let mut dynamics = common::with_neighbours(free(FreeMotion { form, ..Default::default() }));
        if let Form::Free(free) = &mut dynamics.form {
            free.form.stiffness = 0.0.into();
            let neighbours = free.neighbours.as_mut().unwrap();
            (neighbours.forces.cohesion, neighbours.forces.pressure) = (cohesion as f32, 0.0);
        }
        dynamics
    };
    // The shortest strand moves most; chords are a little shorter than 1 cm, as below.
    let length = strands.lengths().map(f64::from).fold(f64::INFINITY, f64::min);
    let strongest = 4.0 / gain(&with(0.0), length, length) / (2.0 * length / 18.0);
    let refused = Simulation::new(&strands, &with(1.01 * strongest), &calm()).unwrap_err();
    assert_eq!(refused.thing, "neighbours.cohesion");
    assert!(refused.remedy.contains("keep cohesion below ") && refused.remedy.contains("2 l cohesion"), "{refused}");
    assert!(Simulation::new(&strands, &with(0.99 * strongest), &calm()).is_ok());
    let push = field(&[(3, [0.0, 0.0, 10.0]), (400, [0.0; 3])]);
    let mut stepper = fast(&strands, &with(0.6 * strongest), &push);
    let mut last = 0.0_f32;
    for _ in 0..400 {
        let before = stepper.strands().points().to_vec();
        step(&mut stepper, &push);
        let moved = stepper.strands().points().iter().zip(&before);
        last = moved.map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
    }
    assert!(last < 0.01, "hair goes {last} cm a frame");
}

/// By c_i (|F| + 4 K + H + 2 gravity) < 4 on the segment that moves most, the tip's, where nothing else pulls.
#[test]
fn hold_and_gravity_are_refused_from_the_bound_on() {
    let strands = hair(3, 18);
    let with = |hold: f64, gravity: f64| {
        let form = FreeForm {
            stiffness: 0.0.into(),
            hold: (hold as f32).into(),
            gravity: (gravity as f32).into(),
            ..Default::default()
        };
        free(FreeMotion { form, ..Default::default() })
    };
    let length = f64::from(strands.lengths().next().unwrap());
    // Chords are a little shorter than 1 cm: a tenth of a percent in the length makes less than one in the gain.
    let most = 4.0 / gain(&with(0.0, 0.0), length, length);
    for (hold, gravity, thing) in [(most, 0.0, "free.hold"), (0.0, most / 2.0, "free.gravity")] {
        assert!(Simulation::new(&strands, &with(0.99 * hold, 0.99 * gravity), &calm()).is_ok(), "{thing}");
        let refused = Simulation::new(&strands, &with(1.01 * hold, 1.01 * gravity), &calm()).err();
        assert_eq!(refused.map(|refused| refused.thing.to_string()).as_deref(), Some(thing));
    }
}

/// What the carriers leave is read alike by both, and what it drags is each hair's own motion.
#[test]
fn the_twins_agree_among_other_hair() {
    let (strands, wind) = (hair(48, 18), wind());
    let mut dynamics = everything(strands.select(&(0..24).collect::<Vec<_>>()), Pose::STILL);
    let mut farthest = |with_neighbours: bool| {
        if let Form::Free(motion) = &mut dynamics.form {
            motion.bodies.clear();
            if !with_neighbours {
                motion.neighbours = None;
            }
        }
        let (mut reference, mut simulation) = (exact(&strands, &dynamics, &*wind), fast(&strands, &dynamics, &*wind));
        let mut apart = 0.0_f64;
        for _ in 0..FRAMES {
            step(&mut reference, &*wind);
            step(&mut simulation, &*wind);
            let pairs = reference.positions().iter().zip(simulation.strands().points());
            apart = pairs.map(|(a, b)| a.distance(b.as_dvec3())).fold(apart, f64::max);
        }
        (simulation.strands().clone(), apart)
    };
    let ((among, apart), (alone, _)) = (farthest(true), farthest(false));
    let felt = among.points().iter().zip(alone.points()).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
    assert!(felt > 0.1, "{felt} cm by the neighbours");
    // A direction is rounded to 6e-8 in each frame, and 18 segments of 1 cm may all be off the same way.
    assert!(apart < 18.0 * 30.0 * 6e-8, "{apart:e} cm");
}

/// Curved hair gathers speed from the turning of its frames, which settling has to outdo.
#[test]
fn a_small_push_of_curved_hair_dies_out_where_it_settles_and_is_held() {
    let strands = hair(20, 18);
    let push = field(&[(3, [0.0, 0.0, 1.0]), (2000, [0.0; 3])]);
    for stiffness in [2000.0, 6000.0, 12_000.0] {
        let form = FreeForm {
            stiffness: stiffness.into(),
            hold: 30.0.into(),
            settle: 20.0.into(),
            gravity: 0.0.into(),
            ..Default::default()
        };
        let dynamics = free(FreeMotion { form, ..Default::default() });
        // In f32 increments below the rounding of a direction turn it no more, and leave some 1e-5 cm.
        let moved = run(&mut exact(&strands, &dynamics, &push), &push, 1500);
        let farthest = moved.points().iter().zip(strands.points()).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
        // A rounding of points of 30 cm.
        assert!(farthest < 4e-6, "{farthest} cm left with stiffness {stiffness}");
    }
}

/// The tip comes down on a plane to which the strand stands at 20 degrees from head-on. The nearer way out than the wind's
/// way in is along the plane, farther by 1 / sin of that angle: no throw.
#[test]
fn a_segment_that_points_steeply_into_a_body_is_not_thrown_out() {
    let (sin, cos) = 20.0_f32.to_radians().sin_cos();
    let mut strand = Strands::default();
    // Its tip rests within the margin.
    strand.push((0..=6).map(|i| Vec3::new(i as f32 * sin, (6 - i) as f32 * cos + 0.02, 0.0)));
    let mut cube = nabiki::Mesh::default();
    for i in 0..8 {
        let side = |bit: u32| if i >> bit & 1 == 1 { 10.0 } else { -10.0 };
        cube.positions.push(Vec3::new(side(0), side(1) - 10.0, side(2)));
    }
    for [a, b, c, d] in [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]] {
        cube.triangles.extend([[a, b, c], [a, c, d]]);
    }
    let cube = Arc::new(nabiki::body::skin_of(cube, "body[0].mesh").unwrap());
    let table = Body::new("body[0]", cube, nabiki::body::BodyWay::WithHead, Contact::default());
    let mut dynamics = free(FreeMotion::default());
    let blows = field(&[(40, [-20.0, 0.0, 0.0]), (1000, [0.0; 3])]);
    let way =
        |a: &Strands, b: &Strands| a.points().iter().zip(b.points()).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
    let motions = |dynamics: &Dynamics| {
        let twins: [Box<dyn Stepper>; 2] =
            [Box::new(exact(&strand, dynamics, &blows)), Box::new(fast(&strand, dynamics, &blows))];
        twins.map(|mut stepper| {
            let mut fastest = 0.0_f32;
            for _ in 0..300 {
                let before = stepper.strands().clone();
                step(&mut *stepper, &blows);
                fastest = fastest.max(way(&before, stepper.strands()));
            }
            (fastest, way(&strand, stepper.strands()))
        })
    };
    let unhindered = motions(&dynamics);
    if let Form::Free(motion) = &mut dynamics.form {
        motion.bodies = vec![table];
    }
    for ((fastest, off), (free, _)) in motions(&dynamics).into_iter().zip(unhindered) {
        println!("{fastest} cm a frame, {free} with nothing in the way; {off} cm from rest");
        assert!(fastest < free / sin, "{fastest} cm in a frame, {free} with nothing in the way");
        assert!(off < 0.05, "{off} cm off its rest shape");
    }
}
