//! Tangents against differences: of every kind of unknown, in both forms of the motion, among all that surrounds the hair.

use std::sync::Arc;

use glam::{DVec3, EulerRot, Quat, Vec3};

use super::gusts::Gusts;
use super::keyed_wind::KeyedWind;
use super::unknowns::{Layout, Unknown};
use crate::body::{Body, Contact};
use crate::disturbance::Disturbance;
use crate::dynamics::{
    Asked, Change, Crowds, Dynamics, ForceSpace, Form, FrameInput, Motion, Moved, Reference, Standing, Stepper,
    Timeline, tangents,
};
use crate::field::{
    Ease, Field, FieldSum, Flow, FlowField, Gust, Keyframe, KeyframedField, Turbulence, TurbulenceField, WIND,
};
use crate::free_form::{FreeForm, FreeMotion, NeighbourForces, Neighbours};
use crate::pseudo_force::PseudoForce;
use crate::region::{FieldShare, Region};
use crate::{Head, Pose, Profile, Strands, bust};

const STRANDS: usize = 24;
const FRAMES: u32 = 60;

/// The first strands of 400 that `nabiki_groom` grows on the bust: 12 segments of 1.5 cm, seed 1, its default style and hairline. Points
/// (cm), root first, a blank line between strands.
fn hair() -> Strands {
    let point = |line: &str| Vec3::from_slice(&line.split(' ').map(|x| x.parse().unwrap()).collect::<Vec<f32>>());
    let mut hair = Strands::default();
    for strand in include_str!("tests/grown.txt").split("\n\n") {
        hair.push(strand.lines().map(point));
    }
    hair
}

fn dynamics(head: &Head, form: Form) -> Dynamics {
    Dynamics {
        motion: Motion { inertia_length_floor: 18.0, ..Motion::default() },
        pseudo_force: PseudoForce::off(),
        form,
        ..Dynamics::new(head.ellipsoid)
    }
}

fn wind(ease: Ease) -> KeyedWind {
    let key = |through, x, y, z| Keyframe { through, vector: Vec3::new(x, y, z) };
    KeyedWind {
        keyframes: vec![key(24, -60.0, 5.0, -30.0), key(46, -10.0, -70.0, 20.0), key(100, 0.0, 0.0, 12.0)],
        ease,
        gust: Some(Gust { intensity: 0.25, ..Gust::default() }),
    }
}

/// A head that nods and turns.
fn nodding() -> Vec<Pose> {
    let pose = |n: u32| {
        let t = 0.05 * n as f32;
        let rotation = Quat::from_euler(EulerRot::YXZ, 0.6 * t.sin(), 0.2 * (2.0 * t).sin(), 0.1 * t);
        Pose { position_cm: Vec3::new(2.0 * t, 1.0, -t), rotation }
    };
    (0..=FRAMES).map(pose).collect()
}

/// What is made of a wind.
type Made<'a> = &'a dyn Fn(Arc<dyn Field>) -> Arc<dyn Field>;

/// The tangents of a strand beside differences.
struct Compared {
    /// The relative error: the root mean square over its nodes, in parts of that of the differences.
    wrong: f64,
    /// The differences: the root of the sum of their squares.
    differences: f64,
    /// The same between the differences of one step and of the next shorter one, where they are most alike.
    spread: f64,
    /// Whether it would be elsewhere without bodies.
    touches: bool,
}

#[derive(Clone)]
struct Case<'a> {
    hair: &'a Strands,
    dynamics: Dynamics,
    poses: Vec<Pose>,
    wind: KeyedWind,
    unknowns: Vec<Unknown>,
    field: Made<'a>,
    of_wind: Made<'a>,
    /// Whether all is smooth: neither contact nor the edge of Gamma.
    smooth: bool,
}

impl Case<'_> {
    fn dynamics(&self, stiffness: f64, settle: f64) -> Dynamics {
        let mut dynamics = self.dynamics.clone();
        if let Form::Free(free) = &mut dynamics.form {
            for (profile, factor) in [(&mut free.form.stiffness, stiffness), (&mut free.form.settle, settle)] {
                *profile =
                    Profile::RootToTip(profile.values().iter().map(|&v| (f64::from(v) * factor) as f32).collect());
            }
        }
        dynamics
    }

    fn without_bodies(&self) -> Self {
        let mut case = self.clone();
        if let Form::Free(free) = &mut case.dynamics.form {
            free.bodies.clear();
        }
        case
    }

    fn layout(&self) -> Layout {
        Layout::new(&self.unknowns, &self.wind, &self.dynamics).unwrap()
    }

    fn gusts(&self) -> Gusts {
        Gusts::new(self.wind.gust.as_ref(), 24.0, FRAMES).unwrap()
    }

    /// Every node in the last frame, by the f64 stepper, where the numbers are these.
    fn run(&self, x: &[f64]) -> Vec<DVec3> {
        let guess = self.layout().guess(&self.wind, x);
        let field = (self.field)(Arc::new(self.gusts().table(&guess)));
        let dynamics = self.dynamics(guess.stiffness, guess.settle);
        let mut reference = Reference::new(self.hair, &dynamics, &*field).unwrap();
        for n in 1..=FRAMES {
            reference.step_frame(&FrameInput::new(n, &self.poses, &*field));
        }
        reference.positions().to_vec()
    }

    /// For each number and strand, its tangents beside differences of the f64 stepper, by Richardson's extrapolation.
    fn errors(&self) -> Vec<Vec<Compared>> {
        let layout = self.layout();
        let x = layout.start(&self.wind);
        let guess = layout.guess(&self.wind, &x);
        let field = (self.field)(Arc::new(self.gusts().table(&guess)));
        let of_wind = [Vec3::X, Vec3::Y, Vec3::Z]
            .map(|vector| (self.of_wind)(Arc::new(KeyframedField::new(&[Keyframe { through: 1, vector }]).unwrap())));
        let unknown = |wanted| layout.unknowns.iter().find(|(u, _)| *u == wanted).map(|&(_, at)| at);
        let change = Change {
            field: &*field,
            of_wind: &of_wind,
            wind: &self.gusts().by_number(&guess, &layout),
            stiffness: unknown(Unknown::Stiffness),
            settle: unknown(Unknown::Settle),
        };
        let ids: Vec<u32> = (0..STRANDS as u32).collect();
        let (poses, dynamics) = (&self.poses[..], &self.dynamics);
        let moved = Moved { strands: self.hair, ids: &ids, dynamics, poses, standing: None, crowds: None };
        let nodes = |s: usize| (0..self.hair.strand(s).len()).map(move |node| Asked { strand: s, frame: FRAMES, node });
        let asked: Vec<Asked> = (0..STRANDS).flat_map(nodes).collect();
        let points = tangents(&moved, &change, &asked).unwrap();
        let now = self.run(&x);
        for (a, b) in now.iter().zip(&points.places) {
            assert!(a.distance(*b) < 1e-6, "the values are those of the specification: {a} {b}");
        }
        let until = layout.first_felt(&self.wind).unwrap() - 1;
        if until > 0 {
            let timeline = || Timeline::new(self.hair, dynamics, field.clone(), self.poses.clone(), FRAMES).unwrap();
            let standing = Standing::at(until, &moved, &*field, timeline()).unwrap();
            let mut there = timeline();
            there.seek(until);
            let crowds = Crowds::of(&mut there, FRAMES);
            let moved = Moved { standing: Some(&standing), crowds: crowds.as_ref(), ..moved };
            let on = tangents(&moved, &change, &asked).unwrap();
            let off = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            // Carriers are those of the fast stepper, which is as near as that is.
            let near = if crowds.is_some() { 1e-2 } else { 1e-9 };
            let off = off(&points.tangents, &on.tangents);
            assert!(off < near, "tangents depend on where they are begun: by {off}");
            assert!(points.places.iter().zip(&on.places).all(|(a, b)| a.distance(*b) < near));
        }
        let untouched = self.without_bodies().run(&x);
        let large = layout.large();
        // Of several steps the best is taken: where the motion has kinks, differences are right only where they stay on one
        // side; where it is smooth, longer ones feel less of the roundings of fields in f32, shorter ones leave less of the series
        // out. Powers of two, so that f32 holds what is asked for.
        let steps: &[i32] = if self.smooth { &[-7, -8] } else { &[-8, -10, -12, -14] };
        let error = |number: usize| {
            let slope = |h: f64| {
                let moved = |by: f64| {
                    let mut x = x.clone();
                    x[number] += by;
                    self.run(&x)
                };
                let (ahead, behind) = (moved(h), moved(-h));
                ahead.iter().zip(behind).map(|(a, b)| (*a - b) / (2.0 * h)).collect::<Vec<_>>()
            };
            let by_step = |&power: &i32| {
                let h = large[number] * 2.0_f64.powi(power);
                let (fine, coarse) = (slope(h), slope(2.0 * h));
                fine.iter().zip(coarse).map(|(fine, coarse)| (4.0 * *fine - coarse) / 3.0).collect::<Vec<_>>()
            };
            let slopes: Vec<Vec<DVec3>> = steps.iter().map(by_step).collect();
            let of_strand = |s: usize| {
                let nodes = self.hair.range(s);
                let tangents: Vec<DVec3> = nodes
                    .clone()
                    .map(|i| [0, 1, 2].map(|axis| points.tangents[(3 * i + axis) * layout.numbers + number]).into())
                    .collect();
                let off = |from: &[DVec3], slope: &[DVec3]| {
                    let wrong: f64 = from.iter().zip(slope).map(|(a, b)| (*a - *b).length_squared()).sum();
                    (wrong / slope.iter().map(|b| b.length_squared()).sum::<f64>()).sqrt()
                };
                let wrong = |slope: &Vec<DVec3>| off(&tangents, &slope[nodes.clone()]);
                let spread = slopes.windows(2).map(|pair| off(&pair[0][nodes.clone()], &pair[1][nodes.clone()]));
                Compared {
                    wrong: slopes.iter().map(wrong).fold(f64::INFINITY, f64::min),
                    spread: spread.fold(f64::INFINITY, f64::min),
                    differences: slopes[0][nodes.clone()].iter().map(|b| b.length_squared()).sum::<f64>().sqrt(),
                    touches: now[nodes.clone()] != untouched[nodes.clone()],
                }
            };
            (0..STRANDS).map(of_strand).collect()
        };
        (0..layout.numbers).map(error).collect()
    }
}

fn plain(wind: Arc<dyn Field>) -> Arc<dyn Field> {
    wind
}

const OF_WIND: [Unknown; 6] =
    [Unknown::Vector(0), Unknown::Border(0), Unknown::Vector(1), Unknown::Border(1), Unknown::Vector(2), Unknown::Gust];

#[test]
fn tangents_are_what_differences_of_the_specification_say() {
    let head = bust::bust();
    let hair = hair();
    let free = |bodies: Vec<Body>, neighbours, poses: &[Pose]| {
        let rest_pose = poses.first().copied().unwrap_or_default();
        Form::Free(FreeMotion { form: FreeForm::default(), bodies, neighbours, rest_pose, ..Default::default() })
    };
    let flow = |wind: Arc<dyn Field>| -> Arc<dyn Field> {
        Arc::new(FlowField::new(&Flow::default(), wind, head.ellipsoid, &[]).unwrap())
    };
    let swirls: Arc<dyn Field> = {
        let settings = Turbulence { strength: 30.0, drift: 0.0, ..Turbulence::default() };
        Arc::new(TurbulenceField::new(&settings, head.ellipsoid, &[], &[]).unwrap())
    };
    let among = |wind: Arc<dyn Field>| -> Arc<dyn Field> { Arc::new(FieldSum::new(vec![flow(wind), swirls.clone()])) };
    // In the world, through which the head goes.
    let flow_past = |wind: Arc<dyn Field>| -> Arc<dyn Field> {
        Arc::new(FlowField::new(&Flow::default(), wind, head.ellipsoid, &nodding()).unwrap())
    };
    let among_past =
        |wind: Arc<dyn Field>| -> Arc<dyn Field> { Arc::new(FieldSum::new(vec![flow_past(wind), swirls.clone()])) };
    let springs = [Unknown::Stiffness, Unknown::Settle];
    let all = [&OF_WIND[..], &springs].concat();
    let case = |name, form, poses, ease, smooth, unknowns: &[Unknown], field, of_wind| {
        let (wind, unknowns) = (wind(ease), unknowns.to_vec());
        (name, Case { hair: &hair, dynamics: dynamics(&head, form), poses, wind, unknowns, field, of_wind, smooth })
    };
    let bodies = || vec![Body::head(&head, Contact::default())];
    let none_of = Vec::<Body>::new;
    let (none, nods) = (Vec::new, nodding());
    let vectors = [Unknown::Vector(0), Unknown::Vector(1)];
    // Hair that feels the wind in part, and heavier hair.
    let mut shared = free(none_of(), None, &[]);
    if let Form::Free(free) = &mut shared {
        let share = |field: &str, share| FieldShare { field: field.to_owned(), share };
        let fields = vec![share(WIND, 0.4), share("turbulence", 0.7)];
        let near = Some(head.ellipsoid.center);
        free.form.regions = vec![Region { near, within: 50.0, gravity: 1.5, fields, ..Region::default() }];
    }
    let in_parts = |wind: Arc<dyn Field>| -> Arc<dyn Field> {
        Arc::new(FieldSum::named(vec![(WIND.to_owned(), flow(wind)), ("turbulence".to_owned(), swirls.clone())]))
    };
    let mut cases = [
        case("paper", Form::Paper, none(), Ease::Stepped, true, &OF_WIND, &plain as Made, &plain as Made),
        case("paper, nodding", Form::Paper, nodding(), Ease::Smooth, true, &OF_WIND, &plain, &plain),
        case("free", free(none_of(), None, &[]), none(), Ease::Stepped, true, &all, &plain, &plain),
        case("free, nodding", free(none_of(), None, &nods), nodding(), Ease::Linear, true, &all, &plain, &plain),
        case("free, swirls, flow", free(none_of(), None, &[]), none(), Ease::Stepped, true, &all, &among, &flow),
        case("paper, flow past", Form::Paper, nodding(), Ease::Stepped, true, &vectors, &among_past, &flow_past),
        case("paper, later", Form::Paper, nodding(), Ease::Smooth, true, &[Unknown::Vector(2)], &plain, &plain),
        case(
            "free, later",
            free(none_of(), None, &[]),
            none(),
            Ease::Stepped,
            true,
            &[Unknown::Vector(1)],
            &plain,
            &plain,
        ),
        case("free, shares, flow", shared, none(), Ease::Stepped, true, &vectors, &in_parts, &flow),
        case("free, head", free(bodies(), None, &[]), none(), Ease::Stepped, false, &all, &plain, &plain),
        case("free, head nodding", free(bodies(), None, &nods), nodding(), Ease::Stepped, false, &all, &plain, &plain),
    ];
    cases[5].1.dynamics.motion.force_space = ForceSpace::World;
    cases[1].1.dynamics.disturbance = Some(Disturbance { over: 3, amplitude: 0.2, ..Disturbance::default() });
    // What the carriers leave is held, so that differences, which move them, too, say something else: but the values are
    // those of the specification.
    let crowd = Neighbours { forces: NeighbourForces::default(), carriers: Arc::new(hair.clone()) };
    let among = free(bodies(), Some(crowd), &[]);
    case("neighbours", among, none(), Ease::Stepped, false, &[Unknown::Vector(1)], &plain, &plain).1.errors();
    for (name, case) in &cases {
        for (number, errors) in case.errors().iter().enumerate() {
            let of = |touches: bool, what: fn(&Compared) -> f64| {
                let mut of: Vec<f64> = errors.iter().filter(|error| error.touches == touches).map(what).collect();
                of.sort_by(f64::total_cmp);
                of
            };
            let (free, touching) = (of(false, |error| error.wrong), of(true, |error| error.wrong));
            let worst = |of: &[f64]| of.last().copied().unwrap_or_default();
            println!(
                "{name}, {number}: worst {:.1e}, {} touch, worst {:.1e}",
                worst(&free),
                touching.len(),
                worst(&touching)
            );
            // What is left of those that do not touch are fields in f32, a few of their roundings over the differences taken, and once more
            // in the world, where places are rounded again: of all strands together, in parts of all their differences. A strand that
            // swirls and flow part from its neighbours multiplies its own; then differences of two steps are no nearer to each other.
            let of_field = name.contains("flow");
            let roundings = if case.dynamics.motion.force_space == ForceSpace::World { 2.0 } else { 1.0 };
            let square = |x: f64| x * x;
            let free_of = || errors.iter().filter(|error| !error.touches);
            let all: f64 = free_of().map(|error| square(error.differences)).sum();
            let together = |what: fn(&Compared) -> f64| {
                (free_of().map(|error| square(what(error) * error.differences)).sum::<f64>() / all).sqrt()
            };
            let (wrong, spread) = (together(|error| error.wrong), together(|error| error.spread));
            println!(
                "    together {wrong:.1e}, differences {spread:.1e}, {:.1e}",
                worst(&of(false, |error| error.spread))
            );
            let (most, most_of_one): (f64, f64) = if of_field { (roundings * 1e-3, 5e-3) } else { (1e-4, 3e-4) };
            let parted = |error: &Compared| error.wrong >= most_of_one && error.wrong > 2.0 * error.spread;
            assert!(
                wrong < most.max(2.0 * spread) && !free_of().any(parted),
                "{name}, number {number}: {wrong} {spread} {}",
                worst(&free)
            );
            // What comes to touch, or leaves, between two differences has no derivative that they could show: then differences of two steps
            // are far from each other, too. Half of the tangents are no farther from differences than those from each other, three in four no
            // more than twice as far, and all ten times, where both steps reach across the same kink. A term left out would
            // be an error of order 1 in those whose differences agree, of which there are some.
            assert_eq!(touching.is_empty(), case.smooth, "{name}");
            if !case.smooth {
                let parts = of(true, |error| error.wrong / (error.spread + 1e-4));
                let count = parts.len();
                let [half, most] = [parts[count / 2 - 1], parts[count * 3 / 4 - 1]];
                println!(
                    "    in parts of what differences differ by: half {half:.2}, most {most:.2}, worst {:.2}",
                    worst(&parts)
                );
                assert!(
                    count >= 4 && half < 1.0 && most < 2.0 && worst(&parts) < 10.0,
                    "{name}, number {number}: {touching:?} {parts:?}"
                );
                let agree = of(true, |error| error.spread)[count / 4 - 1];
                assert!(agree < 0.05, "{name}, number {number}: differences agree nowhere: {agree}");
            }
        }
    }
}
