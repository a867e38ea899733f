//! Locks: which strands are of one, and how they differ.

mod common;

use common::{exact, field, free, hair, twins_apart, wind};
use glam::{DVec3, Vec3};
use nabiki::dynamics::{Dynamics, Form, FrameInput, Stepper};
use nabiki::field::KeyframedField;
use nabiki::free_form::{FreeForm, FreeMotion, Tie};
use nabiki::locks::{LockVariation, Locks, Own};
use nabiki::{Pose, Profile, Strands};

const FRAMES: u32 = 60;

fn form(variation: Option<LockVariation>) -> FreeForm {
    FreeForm { variation, ..FreeForm::default() }
}

/// Alone: what one strand differs by is not what others differ by.
fn alike(variation: LockVariation) -> LockVariation {
    LockVariation { air: 0.0, stiffness: 0.0, flutter: 0.0, flyaways: 0.0, ..variation }
}

fn motion(dynamics: &Dynamics) -> &FreeMotion {
    let Form::Free(free) = &dynamics.form else { unreachable!() };
    free
}

/// Where the tips are in the last frame.
fn tips(strands: &Strands, dynamics: &Dynamics, wind: &KeyframedField) -> Vec<DVec3> {
    let mut stepper = exact(strands, dynamics, wind);
    let poses = [Pose::STILL];
    (1..=FRAMES).for_each(|frame| stepper.step_frame(&FrameInput::new(frame, &poses, wind)));
    let at = stepper.positions();
    let ends = strands.iter().scan(0, |end, strand| {
        *end += strand.len();
        Some(at[*end - 1])
    });
    ends.collect()
}

#[test]
fn hair_whose_locks_are_all_alike_moves_as_hair_without_locks() {
    let hair = hair(20, 12);
    let with = |variation| tips(&hair, &free(form(variation)), &wind());
    assert_eq!(with(None), with(Some(alike(LockVariation::default()))));
}

/// n times the air is n times the push and a settling n times as fast, and nothing else.
#[test]
fn a_strand_that_takes_more_air_moves_as_in_that_much_more_wind_that_settles_it_that_much_faster() {
    let hair = hair(12, 12);
    let variation = LockVariation { air: 0.5, flyaways: 0.3, ..alike(LockVariation::default()) };
    let dynamics = free(form(Some(variation)));
    let together = tips(&hair, &dynamics, &wind());
    for (s, &together) in together.iter().enumerate() {
        let air = motion(&dynamics).own(hair.strand(s)).air as f32;
        let settle = Profile::Even(20.0 / air);
        let vectors = [(50, [-100.0, 0.0, 0.0]), (100, [-15.0, -150.0, 0.0])];
        let stronger = field(&vectors.map(|(through, vector)| (through, vector.map(|along: f32| along * air))));
        let alone = tips(&hair.select(&[s]), &free(FreeForm { settle, ..form(None) }), &stronger)[0];
        // The settings of the second are rounded to f32: a few parts in 10^7 of some 20 cm.
        assert!(together.distance(alone) < 1e-4, "{s}: {}", together.distance(alone));
    }
}

#[test]
fn strands_of_one_lock_differ_by_their_part_and_those_of_others_by_all() {
    let locks = Locks::default();
    let variation = LockVariation { strands: 0.0, flyaways: 0.0, ..LockVariation::default() };
    let own = |variation: LockVariation, root: Vec3| {
        FreeMotion { form: form(Some(variation)), locks, ..Default::default() }.own(&[root, root - Vec3::Y])
    };
    let middles: Vec<Vec3> = (0..400).map(|i| locks.of(Vec3::new(9.0, 0.05 * i as f32, 0.0)).middle).collect();
    for (i, pair) in middles.windows(2).enumerate() {
        let [a, b] = [i, i + 1].map(|i| own(variation, Vec3::new(9.0, 0.05 * i as f32, 0.0)));
        assert_eq!(pair[0] == pair[1], a == b, "{i}");
    }
    let frayed = LockVariation { strands: 0.5, ..variation };
    assert_ne!(own(frayed, Vec3::X), own(frayed, 1.001 * Vec3::X));
    assert_ne!(own(variation, Vec3::X), own(LockVariation { seed: 1, ..variation }, Vec3::X));
}

/// Standard errors are those of so many independent locks, times four.
#[test]
fn spreads_are_those_that_are_asked_for() {
    let n = 4000;
    let variation = LockVariation { air: 0.2, stiffness: 0.3, strands: 0.0, flyaways: 0.0, ..LockVariation::default() };
    let own = |variation: LockVariation| {
        let free = FreeMotion { form: form(Some(variation)), ..Default::default() };
        // A lock each: their roots are many cells apart.
        (0..n).map(|i| free.own(&[Vec3::new(10.0 * i as f32, 0.0, 0.0), Vec3::Y])).collect::<Vec<Own>>()
    };
    let spread = |of: fn(&Own) -> f64| {
        let all: Vec<f64> = own(variation).iter().map(|own| of(own).ln()).collect();
        let mean = all.iter().sum::<f64>() / f64::from(n);
        (mean, (all.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / f64::from(n)).sqrt())
    };
    for (spread, wanted) in [(spread(|own| own.air), 0.2), (spread(|own| own.stiffness), 0.3)] {
        let error = 4.0 * wanted / f64::from(n).sqrt();
        assert!(spread.0.abs() < error && (spread.1 - wanted).abs() < error, "{spread:?}");
    }
    let flying = own(LockVariation { flyaways: 0.1, ..alike(variation) }).iter().filter(|own| own.air == 3.0).count();
    assert!((flying as f64 / f64::from(n) - 0.1).abs() < 4.0 * (0.09 / f64::from(n)).sqrt(), "{flying}");
}

#[test]
fn tied_hair_is_parted_into_locks_where_it_leaves_its_band() {
    let tie = Tie { at: Vec3::new(-12.0, 5.0, 0.0), within: 1.0 };
    let free =
        FreeMotion { form: FreeForm { tie: Some(tie), ..form(Some(LockVariation::default())) }, ..Default::default() };
    let strand = |root: Vec3| [root, tie.at, tie.at - 5.0 * Vec3::Y];
    assert_eq!(free.lock(&strand(8.0 * Vec3::Y)).middle, free.lock(&strand(8.0 * Vec3::Z)).middle);
    assert_ne!(free.lock(&[8.0 * Vec3::Y, Vec3::ZERO]).middle, free.lock(&[8.0 * Vec3::Z, Vec3::ZERO]).middle);
}

/// As without: see `the_twins_agree`.
#[test]
fn the_twins_agree_on_locks() {
    let (strands, wind) = (hair(96, 18), wind());
    let dynamics = free(form(Some(LockVariation::default())));
    let apart = twins_apart(&strands, &dynamics, &wind, FRAMES);
    assert!(apart[apart.len() - 2] < 1e-3 && apart[apart.len() - 1] < 1e-2, "{:e}", apart[apart.len() - 1]);
}
