//! Shapes that are no rigid mesh are met as meshes are.

mod common;

use std::sync::Arc;

use common::{ball, bits, exact, fast, field, free_motion, hair, run, run_under, way_of_a_head};
use glam::{Mat3, Vec3};
use nabiki::Strands;
use nabiki::body::{Body, BodyWay, Contact, Shape, skin_of};
use nabiki::dynamics::{Dynamics, Stepper};
use nabiki::free_form::FreeMotion;
use nabiki::obstacle::{Capsule, Obstacle, Reading};

fn among(shape: Shape, way: BodyWay) -> Dynamics {
    let contact = Contact { margin: 0.2, friction: 0.2, static_friction: 0.3 };
    let bodies = vec![Body::new("body[0]", shape, way, contact)];
    free_motion(FreeMotion { bodies, rest_pose: way_of_a_head(0)[0], ..Default::default() })
}

fn farthest(a: &Strands, b: &Strands) -> f32 {
    a.points().iter().zip(b.points()).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max)
}

/// The way by the table of functions gives the bits of the one that is compiled for meshes.
#[test]
fn a_mesh_has_the_same_bits_however_it_is_asked() {
    let (hair, gusts) = (hair(40, 18), field(&[(20, [-80.0, 10.0, 40.0]), (60, [60.0, -40.0, -80.0])]));
    let poses = way_of_a_head(60);
    let beside: Vec<_> = (poses.iter())
        .map(|pose| nabiki::Pose { position_cm: pose.position_cm + Vec3::new(12.0, -2.0, 3.0), ..*pose })
        .collect();
    let skin = Arc::new(skin_of(ball(5.0), "body[0].mesh").unwrap());
    let moved = |shape: Shape| {
        let mut dynamics = among(shape, BodyWay::InWorld(beside.clone().into()));
        dynamics.motion.frames = 60;
        bits(&run_under(&mut fast(&hair, &dynamics, &gusts), &gusts, &poses))
    };
    let (mesh, other) = (moved(skin.clone().into()), moved(Shape::Other(skin)));
    assert!(mesh == other);
    let far = Capsule::new([Vec3::splat(900.0); 2], 1.0, "body[0]").unwrap();
    assert!(mesh != moved(Shape::Other(Arc::new(far))), "nothing touches");
}

/// How far roundings part the twins at the most where hair slides on a shape (cm): three times as far as hair that a wind alone moves, since
/// what is pressed is solved three times a step.
const APART_CM: f32 = 3e-2;

#[test]
fn hair_keeps_out_of_a_capsule_in_both_twins() {
    let hair = hair(40, 18);
    let arm = Capsule::new([Vec3::new(14.0, 2.0, -20.0), Vec3::new(14.0, -6.0, 20.0)], 2.5, "body[0]").unwrap();
    let dynamics = among(Shape::Other(Arc::new(arm)), BodyWay::WithHead);
    let blows = field(&[(30, [90.0, 20.0, 0.0]), (80, [-90.0, -60.0, 30.0])]);
    let depth = |strands: &Strands| {
        let inside = |p: &Vec3| arm.read(*p, 0).map_or(f32::NEG_INFINITY, |at| -at.distance);
        strands.iter().flat_map(|strand| &strand[1..]).map(inside).fold(f32::NEG_INFINITY, f32::max)
    };
    // Nodes that rest inside stay as deep as they are.
    let at_rest = depth(&hair).max(0.0);
    let (mut reference, mut simulation) = (exact(&hair, &dynamics, &blows), fast(&hair, &dynamics, &blows));
    let mut deepest = f32::NEG_INFINITY;
    // Later on a strand slips off the capsule, and roundings decide to which side.
    for _ in 0..70 {
        common::step(&mut reference, &blows);
        common::step(&mut simulation, &blows);
        deepest = deepest.max(depth(reference.strands())).max(depth(simulation.strands()));
        let apart = farthest(reference.strands(), simulation.strands());
        assert!(apart < APART_CM, "frame {}: {apart}", simulation.frame());
    }
    assert!(deepest < at_rest + 1e-3, "{deepest}, at rest {at_rest}");
    assert!(deepest > -0.3, "nothing touches: {deepest}");
}

/// A ball that grows by so much a frame (cm).
#[derive(Debug)]
struct Swelling {
    center: Vec3,
    radius: f32,
    by: f32,
}

impl Obstacle for Swelling {
    fn reach(&self) -> [Vec3; 2] {
        [self.center - 30.0, self.center + 30.0]
    }

    fn read(&self, p: Vec3, frame: u32) -> Option<Reading> {
        let [low, high] = self.reach();
        let (out, radius) = (p - self.center, self.radius + self.by * frame as f32);
        let within = (p.cmpge(low) & p.cmple(high)).all();
        let normal = out.normalize_or(Vec3::Y);
        let outer = Mat3::from_cols(normal * normal.x, normal * normal.y, normal * normal.z);
        let hessian = (Mat3::IDENTITY - outer) * (1.0 / out.length().max(1e-3));
        within.then(|| Reading { distance: out.length() - radius, gradient: normal, hessian })
    }

    fn moved(&self, p: Vec3, _: u32) -> Vec3 {
        self.by * (p - self.center).normalize_or_zero()
    }

    fn farthest_moved(&self, _: u32) -> f32 {
        self.by
    }

    fn identify(&self, hand_on: &mut dyn FnMut(&[f32])) {
        hand_on(&[self.radius, self.by]);
    }
}

#[test]
fn a_shape_that_grows_takes_hair_before_it_in_both_twins() {
    let (hair, calm) = (hair(40, 18), field(&[(100, [0.0; 3])]));
    let swelling = Swelling { center: Vec3::new(18.0, -4.0, 0.0), radius: 1.0, by: 0.1 };
    let center = swelling.center;
    let dynamics = among(Shape::Other(Arc::new(swelling)), BodyWay::WithHead);
    let steppers: [Box<dyn Stepper>; 2] =
        [Box::new(exact(&hair, &dynamics, &calm)), Box::new(fast(&hair, &dynamics, &calm))];
    // Later on a strand that the ball meets with its root behind it swerves, and roundings decide to which side.
    let [a, b] = steppers.map(|mut stepper| run(&mut *stepper, &calm, 45));
    // The margin is 0.2 cm, and what lay nearer at rest is kept as near.
    for strands in [&a, &b] {
        let nodes = || strands.iter().zip(hair.iter()).flat_map(|(now, rest)| now[1..].iter().zip(&rest[1..]));
        let met = nodes().filter(|(now, rest)| rest.distance(center) > 1.2 && now.distance(center) < 5.7 - 1e-3);
        assert_eq!(met.count(), 0);
        assert!(nodes().filter(|(_, rest)| rest.distance(center) < 5.5).count() > 10, "nothing touches");
    }
    assert!(farthest(&a, &b) < APART_CM, "{}", farthest(&a, &b));
}
