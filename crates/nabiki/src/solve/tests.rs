//! Tangents against differences: of every kind of unknown, in both forms of the motion, among all that surrounds the hair.

use std::sync::Arc;

use glam::{DVec3, EulerRot, Quat, Vec3};

use super::unknowns::{Layout, Unknown};
use super::wind::{Gusts, Wind};
use crate::body::{Body, Contact};
use crate::dynamics::{Asked, Change, Dynamics, Form, FrameInput, Motion, Moved, Reference, Stepper, tangents};
use crate::field::{
    Ease, Field, FieldSum, Flow, FlowField, Gust, Keyframe, KeyframedField, Turbulence, TurbulenceField,
};
use crate::free_form::{FreeForm, FreeMotion, NeighbourForces, Neighbours};
use crate::groom::{Growth, Style, grow};
use crate::pseudo_force::PseudoForce;
use crate::roots::Hairline;
use crate::{Head, Pose, Profile, Strands};

const STRANDS: usize = 24;
const FRAMES: u32 = 60;

fn hair(head: &Head) -> Strands {
    let (hairline, style) = (Hairline::default(), Style::default());
    let growth =
        Growth { hairline: &hairline, style: &style, strands: 400, segments: 12, segment_length: 1.5, seed: 1 };
    grow(head, &growth, STRANDS).unwrap().strands
}

fn dynamics(head: &Head, form: Form) -> Dynamics {
    Dynamics {
        motion: Motion { inertia_length_floor: 18.0, ..Motion::default() },
        segment_length: 1.0,
        pseudo_force: PseudoForce::off(),
        ellipsoid: head.ellipsoid,
        shell: 1.25,
        polar_axis: Vec3::Y,
        disturbance: None,
        form,
    }
}

fn wind(ease: Ease) -> Wind {
    let key = |through, x, y, z| Keyframe { through, vector: Vec3::new(x, y, z) };
    Wind {
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

struct Case<'a> {
    hair: &'a Strands,
    dynamics: Dynamics,
    poses: Vec<Pose>,
    wind: Wind,
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

    /// For each number, the relative error of the tangents of each strand, ascending: the root mean square over its nodes
    /// beside that of differences of the f64 stepper, by Richardson's extrapolation.
    fn errors(&self) -> Vec<Vec<f64>> {
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
        let moved = Moved { strands: self.hair, ids: &ids, dynamics: &self.dynamics, poses: &self.poses };
        let nodes = |s: usize| (0..self.hair.strand(s).len()).map(move |node| Asked { strand: s, frame: FRAMES, node });
        let asked: Vec<Asked> = (0..STRANDS).flat_map(nodes).collect();
        let points = tangents(&moved, &change, &asked).unwrap();
        let now = self.run(&x);
        for (a, b) in now.iter().zip(&points.places) {
            assert!(a.distance(*b) < 1e-6, "the values are those of the specification: {a} {b}");
        }
        let large = layout.large();
        // Where the motion has kinks, differences are right only where they stay on one side: the best of several steps is
        // taken. Powers of two, so that f32 holds what is asked for.
        let steps: &[i32] = if self.smooth { &[-8] } else { &[-8, -10, -12, -14] };
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
                let wrong = |slope: &Vec<DVec3>| {
                    let (mut wrong, mut all) = (0.0, 0.0);
                    for i in self.hair.range(s) {
                        let row = |axis: usize| points.tangents[(3 * i + axis) * layout.numbers + number];
                        wrong += (DVec3::new(row(0), row(1), row(2)) - slope[i]).length_squared();
                        all += slope[i].length_squared();
                    }
                    (wrong / all).sqrt()
                };
                slopes.iter().map(wrong).fold(f64::INFINITY, f64::min)
            };
            let mut errors: Vec<f64> = (0..STRANDS).map(of_strand).collect();
            errors.sort_by(f64::total_cmp);
            errors
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
    let head = Head::builtin();
    let hair = hair(&head);
    let free = |bodies: Vec<Body>, neighbours, poses: &[Pose]| {
        let rest_pose = poses.first().copied().unwrap_or_default();
        Form::Free(FreeMotion { form: FreeForm::default(), bodies, neighbours, rest_pose })
    };
    let flow = |wind: Arc<dyn Field>| -> Arc<dyn Field> {
        Arc::new(FlowField::new(&Flow::default(), wind, head.ellipsoid, &[]).unwrap())
    };
    let swirls: Arc<dyn Field> = {
        let settings = Turbulence { strength: 30.0, drift: 0.0, ..Turbulence::default() };
        Arc::new(TurbulenceField::new(&settings, head.ellipsoid, &[], &[]).unwrap())
    };
    let among = |wind: Arc<dyn Field>| -> Arc<dyn Field> { Arc::new(FieldSum::new(vec![flow(wind), swirls.clone()])) };
    let springs = [Unknown::Stiffness, Unknown::Settle];
    let all = [&OF_WIND[..], &springs].concat();
    let case = |name, form, poses, ease, smooth, unknowns: &[Unknown], field, of_wind| {
        let (wind, unknowns) = (wind(ease), unknowns.to_vec());
        (name, Case { hair: &hair, dynamics: dynamics(&head, form), poses, wind, unknowns, field, of_wind, smooth })
    };
    let bodies = || vec![Body::head(&head, Contact::default())];
    let none_of = Vec::<Body>::new;
    let (none, nods) = (Vec::new, nodding());
    let cases = [
        case("paper", Form::Paper, none(), Ease::Stepped, true, &OF_WIND, &plain as Made, &plain as Made),
        case("paper, nodding", Form::Paper, nodding(), Ease::Smooth, true, &OF_WIND, &plain, &plain),
        case("free", free(none_of(), None, &[]), none(), Ease::Stepped, true, &all, &plain, &plain),
        case("free, nodding", free(none_of(), None, &nods), nodding(), Ease::Linear, true, &all, &plain, &plain),
        case("free, swirls, flow", free(none_of(), None, &[]), none(), Ease::Stepped, true, &all, &among, &flow),
        case("free, head", free(bodies(), None, &[]), none(), Ease::Stepped, false, &all, &plain, &plain),
        case("free, head nodding", free(bodies(), None, &nods), nodding(), Ease::Stepped, false, &all, &plain, &plain),
    ];
    // What the carriers leave is held, so that differences, which move them, too, say something else: but the values are
    // those of the specification.
    let crowd = Neighbours { forces: NeighbourForces::default(), carriers: Arc::new(hair.clone()) };
    let among = free(bodies(), Some(crowd), &[]);
    case("neighbours", among, none(), Ease::Stepped, false, &[Unknown::Vector(1)], &plain, &plain).1.errors();
    for (name, case) in &cases {
        for (number, errors) in case.errors().iter().enumerate() {
            let [many, most, worst] = [STRANDS * 3 / 4 - 1, STRANDS * 9 / 10, STRANDS - 1].map(|i| errors[i]);
            let exact = errors.iter().filter(|&&error| error < 1e-4).count();
            println!(
                "{name}, {number}: three in four {many:.1e}, nine in ten {most:.1e}, worst {worst:.1e}; \
                 {exact} of {STRANDS} strands below 1e-4"
            );
            // What is left where all is smooth are fields in f32: a few of their roundings, over the differences taken. A
            // strand that comes to touch between two differences has no derivative that they could show; a term left out would
            // be an error of order 1 in all that touch.
            let (few, all) = if case.smooth { (1e-4, 3e-4) } else { (0.1, f64::INFINITY) };
            assert!(many < 1e-4 && most < few && worst < all, "{name}, number {number}: {many} {most} {worst}");
        }
    }
}
