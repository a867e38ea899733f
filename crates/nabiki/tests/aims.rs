//! The laws of aims, for both twins.

mod common;

use std::sync::Arc;

use common::{Whirl, bits, exact, fast, field, free_motion, hair, run, way_of_a_head, wind};
use glam::{DVec3, Quat, Vec3};
use nabiki::aim::{Aim, AimCurves, AimShape, Lead};
use nabiki::dynamics::{Dynamics, Form, FrameInput, Simulation, Stepper, Timeline, VectorWidth};
use nabiki::free_form::{FreeForm, FreeMotion};
use nabiki::region::Region;
use nabiki::{Skin, Strands};

const FRAMES: u32 = 60;

fn at_once(strength: f32) -> Lead {
    Lead { strength, from: 0, through: None, ease_in: 0, ease_out: 0 }
}

fn aim(lead: Lead, shape: AimShape) -> Aim {
    Aim { name: "aim[0]".to_owned(), lead, region: None, shape }
}

fn limp(gravity: f32, settle: f32) -> FreeForm {
    FreeForm { stiffness: 0.0.into(), hold: 0.0.into(), settle: settle.into(), gravity, ..FreeForm::default() }
}

fn soft() -> FreeForm {
    FreeForm { stiffness: 900.0.into(), hold: 10.0.into(), settle: 20.0.into(), gravity: 100.0, ..Default::default() }
}

fn led(form: FreeForm, aims: Vec<Aim>) -> Dynamics {
    free_motion(FreeMotion { form, aims, ..FreeMotion::default() })
}

fn calm() -> nabiki::field::KeyframedField {
    field(&[(1000, [0.0; 3])])
}

fn both(strands: &Strands, dynamics: &Dynamics, field: &dyn nabiki::field::Field) -> [Box<dyn Stepper>; 2] {
    [Box::new(exact(strands, dynamics, field)), Box::new(fast(strands, dynamics, field))]
}

fn curves(strands: &Strands) -> AimShape {
    AimShape::Curves(Arc::new(AimCurves::new(strands.clone(), None, "aim[0].file").unwrap()))
}

/// Aims of every kind, one after the other and over each other, of all hair and of a region.
fn all_kinds(strands: &Strands) -> FreeMotion {
    let posed = run(&mut fast(strands, &led(soft(), Vec::new()), &wind()), &wind(), 30);
    let some = posed.select(&[0, 7, 13, 21, 34]);
    let lead = |from, through| Lead { strength: 400.0, from, through: Some(through), ease_in: 8, ease_out: 8 };
    let front = Region { near: Some(Vec3::new(0.0, 6.0, 8.0)), within: 6.0, soft: 6.0, ..Region::default() };
    let aims = vec![
        aim(lead(12, 20), curves(&some)),
        Aim { region: Some(0), ..aim(lead(16, 30), AimShape::Toward(Vec3::new(30.0, 20.0, 10.0))) },
        aim(lead(38, 50), AimShape::Groom),
    ];
    FreeMotion { form: FreeForm { regions: vec![front], ..soft() }, aims, ..FreeMotion::default() }
}

/// A limp strand settles along F + H u.
#[test]
fn limp_hair_settles_between_force_and_aim() {
    let strands = hair(40, 18);
    let (force, strength, point) = (DVec3::new(-90.0, 30.0, 60.0), 140.0, Vec3::new(0.0, 400.0, 900.0));
    let dynamics = led(limp(0.0, 12.0), vec![aim(at_once(strength), AimShape::Toward(point))]);
    let blows = field(&[(1000, force.as_vec3().to_array())]);
    for mut stepper in both(&strands, &dynamics, &blows) {
        let settled = run(&mut *stepper, &blows, 400);
        for strand in settled.iter() {
            let u = (point - strand[0]).as_dvec3().normalize();
            let along = (force + f64::from(strength) * u).normalize();
            for ends in strand.windows(2) {
                // A swing falls to 1/e in 12 frames or less: to 4e-15 in 400. Points are rounded by 2e-6 cm.
                let direction = (ends[1] - ends[0]).as_dvec3().normalize();
                assert!(direction.distance(along) < 1e-5, "{direction} is not {along}");
            }
        }
    }
}

/// Hair led by an aim alone takes the shape of its curves, and does not swing through it.
#[test]
fn hair_takes_the_shape_of_its_curves_without_swinging() {
    let strands = hair(40, 18);
    let pose = run(&mut fast(&strands, &led(soft(), Vec::new()), &wind()), &wind(), 30);
    // Without the air: nothing but the aim settles it.
    let dynamics = led(limp(0.0, 0.0), vec![aim(at_once(100.0), curves(&pose))]);
    for mut stepper in both(&strands, &dynamics, &calm()) {
        let apart = |now: &Strands| -> f32 {
            let tips = now.iter().zip(pose.iter()).map(|(a, b)| a[a.len() - 1].distance(b[b.len() - 1]));
            tips.sum::<f32>() / strands.len() as f32
        };
        let begin = apart(&strands);
        let mut least = begin;
        for _ in 0..160 {
            common::step(&mut *stepper, &calm());
            let now = apart(stepper.strands());
            // A strand is no single rod: its parts swing at different rates, and give a little of the way back.
            assert!(now < least + 0.02 * begin, "{now} cm after {least} cm");
            least = least.min(now);
        }
        assert!(begin > 5.0 && least < 1e-2 * begin, "{least} of {begin} cm");
    }
}

/// Hair at rest is led to itself: nothing moves.
#[test]
fn an_aim_at_the_groom_keeps_hair_at_rest_to_the_bit() {
    let strands = hair(40, 18);
    for shape in [AimShape::Groom, curves(&strands)] {
        let dynamics = led(soft(), vec![aim(at_once(300.0), shape.clone())]);
        for mut stepper in both(&strands, &dynamics, &calm()) {
            let before = stepper.strands().clone();
            let after = run(&mut *stepper, &calm(), FRAMES);
            if matches!(shape, AimShape::Groom) {
                assert_eq!(bits(&before), bits(&after));
            }
            // Curves give chords of points that are rounded by 1e-6 cm, per segment of 1 cm.
            for (a, b) in before.points().iter().zip(after.points()) {
                assert!(a.distance(*b) < 1e-4, "{a} {b}");
            }
        }
    }
}

/// Before and after its frames an aim does nothing, and a region keeps it to its strands.
#[test]
fn an_aim_leads_its_hair_in_its_frames_alone() {
    let strands = hair(40, 18);
    let region = Region { near: Some(strands.strand(0)[0]), within: 5.0, soft: 2.0, ..Region::default() };
    let lead = Lead { strength: 900.0, from: 30, through: Some(32), ease_in: 4, ease_out: 4 };
    let aims = vec![Aim { region: Some(0), ..aim(lead, AimShape::Toward(Vec3::new(0.0, 50.0, 0.0))) }];
    let form = FreeForm { regions: vec![region.clone()], ..soft() };
    let (with, without) = (led(form.clone(), aims), led(form, Vec::new()));
    for (mut with, mut without) in both(&strands, &with, &wind()).into_iter().zip(both(&strands, &without, &wind())) {
        for n in 1..=40 {
            for stepper in [&mut with, &mut without] {
                common::step(&mut **stepper, &wind());
            }
            for s in 0..strands.len() {
                let same = with.strands().strand(s) == without.strands().strand(s);
                let is_led = n > 25 && region.weight(strands.strand(s)[0]) > 0.0;
                assert_eq!(same, !is_led, "strand {s} in frame {n}");
            }
        }
    }
}

#[test]
fn the_strength_of_an_aim_eases_in_and_out() {
    let lead = Lead { strength: 1.0, from: 20, through: Some(30), ease_in: 9, ease_out: 3 };
    let part = |frame| lead.part(frame);
    assert_eq!([10, 20, 25, 30, 34].map(part), [0.0, 1.0, 1.0, 1.0, 0.0]);
    assert_eq!([15, 32].map(part), [0.5, 0.5]);
    for n in 10..20 {
        assert!(part(n + 1) > part(n), "{n}");
        // Symmetric in time.
        assert!((part(n) + part(30 - n) - 1.0).abs() < 1e-15, "{n}");
    }
    assert_eq!(Lead { through: None, ..lead }.part(1_000_000), 1.0);
}

#[test]
fn the_twins_agree() {
    let strands = hair(120, 18);
    let poses = way_of_a_head(FRAMES);
    let dynamics = free_motion(all_kinds(&strands));
    let (mut reference, mut simulation) = (exact(&strands, &dynamics, &Whirl), fast(&strands, &dynamics, &Whirl));
    let mut distances = Vec::new();
    for n in 1..=FRAMES {
        let input = FrameInput::new(n, &poses, &Whirl);
        reference.step_frame(&input);
        simulation.step_frame(&input);
        let pairs = reference.positions().iter().zip(simulation.strands().points());
        distances.extend(pairs.map(|(a, b)| a.distance(b.as_dvec3())));
    }
    distances.sort_by(f64::total_cmp);
    let at = |part: f64| distances[((distances.len() - 1) as f64 * part) as usize];
    println!("{:e} {:e} {:e}", at(0.99), at(0.999), at(1.0));
    // As `the_twins_agree` in free_form.rs.
    assert!(at(0.999) < 1e-3 && at(1.0) < 1e-2, "{:e} and {:e} cm", at(0.999), at(1.0));
}

/// Some of the hair, other vectors and all frames at once: the same bits.
#[test]
fn hair_that_is_led_has_the_same_bits_however_it_is_stepped() {
    let strands = hair(40, 18);
    let dynamics = common::with_neighbours(free_motion(all_kinds(&strands)));
    let whole = run(&mut fast(&strands, &dynamics, &Whirl), &Whirl, FRAMES);
    let ids: Vec<u32> = (5..23).collect();
    let some = strands.select(&(5..23).collect::<Vec<_>>());
    let mut part = Simulation::with_ids(&some, &ids, &dynamics, &Whirl).unwrap();
    let of_some = bits(&whole)[strands.range(5).start..strands.range(22).end].to_vec();
    assert_eq!(of_some, bits(&run(&mut part, &Whirl, FRAMES)));
    let mut baseline = fast(&strands, &dynamics, &Whirl).with_vector_width(VectorWidth::Baseline);
    assert_eq!(bits(&whole), bits(&run(&mut baseline, &Whirl, FRAMES)));
    let mut timeline = Timeline::new(&strands, &dynamics, Arc::new(Whirl), Vec::new(), FRAMES).unwrap();
    timeline.play();
    assert_eq!(bits(&whole), bits(timeline.strands()));
}

/// A scalp that its skin has turned: curves posed on it lead there as the same curves at rest lead on the scalp at rest.
#[test]
fn curves_posed_on_skin_lead_where_the_skin_has_turned_them() {
    let strands = hair(40, 18);
    let turn = Quat::from_axis_angle(Vec3::new(0.6, 0.0, 0.8), 0.8);
    let mut mesh = common::ball(1.0);
    mesh.positions.iter_mut().for_each(|p| *p *= common::HEAD.half_axes);
    let skin = Skin::new(&mesh, "head.mesh").unwrap();
    let turned: Vec<Vec3> = mesh.positions.iter().map(|&p| turn * p).collect();
    let frame = skin.frame(&turned).unwrap();
    let skin = Arc::new(skin.with_frames(vec![frame]));
    let pose = run(&mut fast(&strands, &led(soft(), Vec::new()), &wind()), &wind(), 30);
    let posed = common::map(&pose, |p| turn * p);
    let posed = AimShape::Curves(Arc::new(AimCurves::new(posed, Some(7), "aim[0].file").unwrap()));
    let form = FreeForm { drag: 0.0.into(), ..limp(0.0, 12.0) };
    let on_head = led(form.clone(), vec![aim(at_once(200.0), curves(&pose))]);
    let on_skin = Dynamics { skin: Some(skin), ..led(form, vec![aim(at_once(200.0), posed)]) };
    for (mut on_head, mut on_skin) in
        both(&strands, &on_head, &calm()).into_iter().zip(both(&strands, &on_skin, &calm()))
    {
        let [a, b] = [&mut on_head, &mut on_skin].map(|stepper| run(&mut **stepper, &calm(), FRAMES));
        for (a, b) in a.points().iter().zip(b.points()) {
            // Vertices are rounded by 5e-7 cm, which turns a triangle of 2 cm by as many rad.
            assert!((turn * *a).distance(*b) < 1e-3, "{a} and {b}");
        }
    }
}

/// Twice as many steps a second lead hair along the same way, to first order.
#[test]
fn an_aim_leads_at_any_frame_rate() {
    let strands = hair(40, 18);
    let dynamics = free_motion(all_kinds(&strands));
    let Form::Free(free) = &dynamics.at_frame_rate(48.0).unwrap().form else { unreachable!() };
    for (a, b) in all_kinds(&strands).aims.iter().zip(&free.aims) {
        assert_eq!((2 * a.lead.from, a.lead.through.map(|n| 2 * n)), (b.lead.from, b.lead.through));
        assert_eq!((2 * a.lead.ease_in, 2 * a.lead.ease_out), (b.lead.ease_in, b.lead.ease_out));
    }
}

#[test]
fn what_no_aim_can_be_is_refused_by_one_line() {
    let strands = hair(4, 18);
    let refused = |aim: Aim| led(soft(), vec![aim]).check().unwrap_err().to_string();
    let lead = Lead { from: 20, through: Some(10), ..Lead::default() };
    assert_eq!(refused(aim(lead, AimShape::Groom)), "aim[0].through = 10: must not be before `from`, which is 20");
    let of_no_region = Aim { region: Some(1), ..aim(Lead::default(), AimShape::Groom) };
    assert_eq!(refused(of_no_region), "aim[0].region = 1: there are 0 regions: count from 0");
    let nowhere = aim(Lead::default(), AimShape::Toward(Vec3::NAN));
    assert!(refused(nowhere).starts_with("aim[0].toward = "));
    let line = |curves: Strands| AimCurves::new(curves, None, "pose.usda").unwrap_err().to_string();
    assert_eq!(line(Strands::default()), "pose.usda has no curves: an aim needs at least one");
    let mut doubled = strands;
    doubled.push([Vec3::ONE; 2]);
    assert_eq!(line(doubled), "pose.usda has a curve without a length, number 4: remove it");
}
