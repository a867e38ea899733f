//! The free form among other hair, against the head, and on a head that speeds up; how it comes back to rest.

mod common;

use std::sync::Arc;

use common::{exact, fast, field, free_motion, hair, mixed_hair, run, run_under, step, way_of_a_head};
use glam::Vec3;
use nabiki::body::{Body, Contact, Surface};
use nabiki::dynamics::{Dynamics, Form, Simulation, Stepper, earth_gravity, push};
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
    let form = FreeForm { stiffness: Profile::RootToTip(vec![900.0, 100.0]), gravity: 60.0, ..Default::default() };
    free(FreeMotion {
        form,
        bodies: vec![Body::head(&bust(), Contact::default())],
        neighbours: Some(Neighbours::new(NeighbourForces::default(), Arc::new(carriers))),
        rest_pose,
        ..Default::default()
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
    let form = FreeForm { stiffness: 600.0.into(), hold: 5.0.into(), gravity: 0.0, ..Default::default() };
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

/// Straight strands of 18 cm, all ways out.
fn straight(strands: usize) -> Strands {
    let mut straight = Strands::default();
    for strand in hair(strands, 18).iter() {
        let out = (strand[1] - strand[0]).normalize();
        straight.push((0..=18).map(|i| strand[0] + i as f32 * out));
    }
    straight
}

#[test]
fn a_head_that_speeds_up_is_felt_as_a_force_the_other_way() {
    let strands = straight(40);
    // By 0.25 cm a frame in every frame: in f32 to the bit.
    let poses: Vec<Pose> = (0..=FRAMES)
        .map(|n| Pose { position_cm: Vec3::new(0.125 * (n * n) as f32, 0.0, 0.0), ..Pose::STILL })
        .collect();
    for drag in [0.5, 1.0, 2.0] {
        let form = FreeForm { settle: 0.0.into(), drag: drag.into(), ..Default::default() };
        let dynamics = free(FreeMotion { form, ..Default::default() });
        let felt = -0.25 * f64::from(drag) / push(&dynamics, 18.0);
        // Before frame 0 the head goes as it goes from there on, evenly: it is felt from frame 2 on.
        let pulls = field(&[(1, [0.0; 3]), (1000, [felt as f32, 0.0, 0.0])]);
        let under_force = run(&mut exact(&strands, &dynamics, &pulls), &pulls, FRAMES);
        let carried = run_under(&mut exact(&strands, &dynamics, &calm()), &calm(), &poses);
        let farthest = |a: &Strands, b: &Strands| {
            a.points().iter().zip(b.points()).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max)
        };
        assert!(farthest(&carried, &strands) > 1.0);
        // The force in f32 is off by 3e-8 of itself, lengths by 1e-7, points of 30 cm by 2e-6.
        assert!(farthest(&carried, &under_force) < 1e-4, "{}", farthest(&carried, &under_force));
    }
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
        gravity: 100.0,
        ..Default::default()
    };
    let mut dynamics = free(FreeMotion { form, bodies: vec![body.clone()], ..Default::default() });
    dynamics.motion.inertia_length_floor = 18.0;
    let kept: Vec<(Surface, f32)> = strands.points().iter().map(|p| body.kept_from(*p, 1.0)).collect();
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

/// The tip (part of the length) of a clamped, straight, level elastica of length 1 under a load w that points down, even along it:
/// EI theta'' = -w (1 - s) cos theta with theta the angle below the level, theta(0) = 0, theta'(1) = 0; `load`: w L^3 / EI.
fn elastica_under_an_even_load(load: f64) -> (f64, f64) {
    let steps = 4000;
    let h = 1.0 / f64::from(steps);
    // From the tip back to the clamp, for the slope there; midpoint rule.
    let shoot = |tip: f64| {
        let (mut theta, mut curvature, mut x, mut y) = (tip, 0.0, 0.0, 0.0);
        for i in 0..steps {
            let beyond = h * (f64::from(i) + 0.25);
            let (t, c) = (theta - 0.5 * h * curvature, curvature + 0.5 * h * load * beyond * theta.cos());
            (x, y) = (x + h * t.cos(), y + h * t.sin());
            (theta, curvature) = (theta - h * c, curvature + h * load * h * (f64::from(i) + 0.5) * t.cos());
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
fn under_an_even_force_a_strand_bends_as_an_elastica_under_its_own_weight() {
    for load in [1.0, 5.0, 15.0] {
        let (x, y) = elastica_under_an_even_load(load);
        let errors = [9, 18, 36].map(|segments: usize| {
            let length = 18.0;
            let mut strand = Strands::default();
            strand.push((0..=segments).map(|i| Vec3::new(length * i as f32 / segments as f32, 0.0, 0.0)));
            // EI = 3/8 A L K, and the load A F.
            let force = 6.0_f32;
            let stiffness = force * length * length / (0.375 * load as f32);
            let form = FreeForm {
                stiffness: stiffness.into(),
                hold: 0.0.into(),
                settle: 100.0.into(),
                gravity: 0.0,
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
        // A joint bends for the half segments beside it: the error is of second order.
        assert!(errors[2] < 1e-3, "{errors:?}");
        for w in errors.windows(2) {
            assert!((3.0..5.0).contains(&(w[0] / w[1])), "{errors:?}");
        }
    }
}

/// Joints and hold are stepped implicitly: the stiffest hair is as calm as any, and keeps still after a push.
#[test]
fn any_stiffness_and_any_hold_can_be_stepped() {
    let strands = hair(20, 18);
    let push = field(&[(3, [0.0, 0.0, 10.0]), (1000, [0.0; 3])]);
    for (stiffness, hold) in [(0.0, 1e9), (1e5, 0.0), (1e7, 100.0), (1e9, 0.0), (1e9, 1e9)] {
        let form = FreeForm { stiffness: stiffness.into(), hold: hold.into(), ..Default::default() };
        let dynamics = free(FreeMotion { form, ..Default::default() });
        let mut stepper = fast(&strands, &dynamics, &push);
        let mut farthest = 0.0_f32;
        for _ in 0..400 {
            step(&mut stepper, &push);
            let moved = stepper.strands().points().iter().zip(strands.points());
            farthest = moved.map(|(a, b)| a.distance(*b)).fold(farthest, f32::max);
        }
        println!("{stiffness} {hold}: {farthest}");
        // So little moves soft hair by centimetres.
        assert!(farthest < 0.2, "{farthest} cm with stiffness {stiffness}, hold {hold}");
    }
}

/// So is cohesion.
#[test]
fn any_cohesion_calms_hair() {
    let strands = hair(24, 18);
    let push = field(&[(3, [0.0, 0.0, 100.0]), (400, [0.0; 3])]);
    for cohesion in [10.0, 1e3, 1e5, 1e7] {
        let form = FreeForm { stiffness: 0.0.into(), hold: 0.0.into(), gravity: 0.0, ..Default::default() };
        let mut dynamics = common::with_neighbours(free(FreeMotion { form, ..Default::default() }));
        if let Form::Free(free) = &mut dynamics.form {
            let neighbours = free.neighbours.as_mut().unwrap();
            (neighbours.forces.cohesion, neighbours.forces.pressure) = (cohesion, 0.0);
        }
        let mut stepper = fast(&strands, &dynamics, &push);
        let mut last = 0.0_f32;
        for _ in 0..400 {
            let before = stepper.strands().points().to_vec();
            step(&mut stepper, &push);
            let moved = stepper.strands().points().iter().zip(&before);
            last = moved.map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
        }
        assert!(last < 0.01, "hair goes {last} cm a frame with a cohesion of {cohesion}");
    }
}

/// By A (|F| + gravity) / L < 4: a force that takes hair farther in a frame than it is long by several times.
#[test]
fn gravity_is_refused_from_the_bound_on() {
    let strands = straight(3);
    let with = |gravity: f64| {
        let form = FreeForm { gravity: gravity as f32, ..Default::default() };
        free(FreeMotion { form, ..Default::default() })
    };
    // Two steps a frame.
    let most = 4.0 * 18.0 / (push(&with(0.0), 18.0) * 0.25);
    assert!(Simulation::new(&strands, &with(0.99 * most), &calm()).is_ok());
    let refused = Simulation::new(&strands, &with(1.01 * most), &calm()).unwrap_err();
    assert_eq!(refused.thing, "free.gravity");
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
    println!("{apart:e}");
    // As of hair alone.
    assert!(apart < 1e-3, "{apart:e} cm");
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
            gravity: 0.0,
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
