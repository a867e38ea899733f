//! Laws of the turbulence.

use glam::{Mat3, Quat};
use proptest::prelude::*;

use super::*;
use crate::field::rows::forces;

const HEAD: Ellipsoid = Ellipsoid { center: Vec3::new(1.0, 2.0, -1.0), half_axes: Vec3::new(9.5, 11.0, 8.0) };

fn field(settings: &Turbulence) -> TurbulenceField {
    TurbulenceField::new(settings, HEAD, &[], &[]).unwrap()
}

fn settings() -> impl Strategy<Value = Turbulence> {
    (1.0_f32..60.0, 2.0_f32..20.0, 0.0_f32..90.0, 0.0_f32..=1.0, 1_u32..4, 0.0_f32..0.1, 0.0_f32..9.0, any::<u64>())
        .prop_map(|(strength, swirl_size, pulse_length, roughness, octaves, drift, near_head, seed)| Turbulence {
            strength,
            swirl_size,
            pulse_length,
            roughness,
            octaves,
            drift,
            near_head,
            seed,
            envelope: Vec::new(),
        })
}

fn points(reach: f32) -> impl Strategy<Value = Vec3> {
    [-reach..reach, -reach..reach, -reach..reach].prop_map(Vec3::from)
}

/// A head that goes about, and a wind that changes.
fn on_the_way(settings: &Turbulence) -> TurbulenceField {
    let pose = |n: u32| Pose {
        position_cm: Vec3::new(3.0 * n as f32, 150.0, -2.0 * n as f32),
        rotation: Quat::from_rotation_y(0.1 * n as f32) * Quat::from_rotation_x(0.05 * n as f32),
    };
    let wind: Vec<Vec3> = (0..30).map(|n| Vec3::new(-60.0, n as f32, 5.0)).collect();
    TurbulenceField::new(settings, HEAD, &(0..20).map(pose).collect::<Vec<_>>(), &wind).unwrap()
}

proptest! {
    #[test]
    fn rows_are_points_and_never_above_the_bound(settings in settings(), frame in 0_u32..9000, at in points(40.0), way in points(3.0)) {
        let field = on_the_way(&settings);
        let n = frame.min(19) as f32;
        let along = std::array::from_fn(|i| at + way * i as f32 + Vec3::new(3.0 * n, 150.0, -2.0 * n));
        for force in forces(&field, along, frame) {
            prop_assert!(force.is_finite() && force.length() <= field.strongest());
        }
    }

    #[test]
    fn there_is_no_source(settings in settings(), frame in 0_u32..200, p in points(20.0)) {
        let field = field(&settings);
        // Far from 1/2, where z goes round, and from the ends of the ramp, each term is a polynomial; over them its second
        // derivative jumps. So central differences err by the length of the step times the largest second derivative, of
        // which for one wave the first derivative is s' |kappa| = 8 |kappa| |e|, the second 32 |kappa|^2 |e|, the ramp's
        // of the order of its own length. The smallest wave is 2^-(octaves - 1) of the largest.
        let h = 1.0 / 256.0;
        let slope = |axis: Vec3| (field.at(p + h * axis, frame) - field.at(p - h * axis, frame)).dot(axis) / (2.0 * h);
        let divergence = slope(Vec3::X) + slope(Vec3::Y) + slope(Vec3::Z);
        let finest = settings.swirl_size / (1 << (settings.octaves - 1)) as f32;
        let kappa = 1.25 / (2.0 * finest);
        let ramp = if settings.near_head > 0.0 { settings.near_head } else { f32::INFINITY };
        let second = field.strongest() * (32.0 * kappa * kappa + 16.0 * kappa / ramp + 8.0 / (ramp * ramp));
        // Points are rounded by 4e-6 cm and the force by some 1e-6 of its size.
        let rounding = field.strongest() * (1e-6 + 4e-6 * 8.0 * (kappa + 1.0 / ramp)) / h;
        prop_assert!(divergence.abs() < 3.0 * h * second + 3.0 * rounding, "{divergence}, {} {}", h * second, rounding);
    }

    #[test]
    fn it_runs_along_the_head(settings in settings(), frame in 0_u32..200, d in points(1.0)) {
        let settings = Turbulence { near_head: settings.near_head.max(0.5), ..settings };
        let field = field(&settings);
        let on = HEAD.center + d.normalize_or(Vec3::X) * HEAD.half_axes;
        // The distance from the surface is rounded to 1e-6 of the half axes; the ramp rises by 1.875 over near_head.
        let left = 2.0 * 1.875 * 11e-6 / settings.near_head + 2e-6;
        prop_assert!(field.at(on, frame).dot(HEAD.gradient(on).normalize()).abs() < left * field.strongest());
    }

    #[test]
    fn it_drifts_with_the_wind_and_comes_again(settings in settings(), frame in 0_u32..50, p in points(20.0)) {
        let free = Turbulence { near_head: 0.0, ..settings };
        let pulse_length = free.pulse_length.round();
        let free = Turbulence { pulse_length, ..free };
        let wind = Vec3::new(40.0, -10.0, 25.0);
        let still = field(&free);
        let drifting = TurbulenceField::new(&free, HEAD, &[], &[wind]).unwrap();
        let way = free.drift * wind * frame as f32;
        let finest = free.swirl_size / (1 << (free.octaves - 1)) as f32;
        // The way of up to 240 cm is rounded to 2e-5 cm, and the phase to 1e-6 turns; a turn of 1.25 / 2 swirls.
        let tolerance = still.strongest() * 8.0 * (0.625 / finest * 6e-5 + 4e-6);
        prop_assert!((drifting.at(p + way, frame) - still.at(p, frame)).length() < tolerance);
        let again = frame + 16 * pulse_length as u32;
        prop_assert!((still.at(p, again) - still.at(p, frame)).length() < tolerance);
    }
}

// The smallest swirls that are allowed, 50 m from the origin, where the head may go: the force is what is said of it.
#[test]
fn the_smallest_swirls_stay_below_the_bound_far_from_the_origin() {
    let settings = Turbulence { swirl_size: 1.28, octaves: 8, roughness: 1.0, ..Turbulence::default() };
    for near_head in [0.0, 4.0] {
        let field = field(&Turbulence { near_head, ..settings.clone() });
        for i in 0..2000 {
            let p = Vec3::new(0.618_034, 0.754_878, 0.569_840) * (i as f32 + 0.5);
            let way = (2.0 * p.fract() - 1.0).normalize_or(Vec3::X);
            let force = field.at(5000.0 * way, i);
            assert!(force.is_finite() && force.length() <= field.strongest(), "{way}: {force}");
        }
    }
    let below = Turbulence { swirl_size: 1.27, ..settings };
    let refused = below.check().unwrap_err().to_string();
    assert!(refused.starts_with("turbulence.swirl_size = 1.27: must be at least 1.28 with 8 octaves"), "{refused}");
}

#[test]
fn its_root_mean_square_is_the_strength_in_every_direction() {
    // Means over points a swirl and more apart of a box of 1000 cm, over seeds.
    for octaves in [1, 2, 4] {
        let (seeds, count) = (60, 400);
        let mut squares = Mat3::ZERO;
        let mut mean = Vec3::ZERO;
        for seed in 0..seeds {
            let settings = Turbulence { octaves, near_head: 0.0, seed, ..Turbulence::default() };
            let field = field(&settings);
            for i in 0..count {
                let p = Vec3::new(0.618_034, 0.754_878, 0.569_840) * (i as f32 + 0.5);
                let force = field.at(1000.0 * p.fract() - 500.0, 7) / settings.strength;
                squares += Mat3::from_cols(force * force.x, force * force.y, force * force.z);
                mean += force;
            }
        }
        let number = (seeds * count) as f32;
        let (squares, mean) = (squares * (1.0 / number), mean / number);
        // A seed's waves keep their strength and lie evenly in direction: what is left to chance is which way each e points
        // across its kappa, about 1/3 / sqrt(8) of the mean square for a seed, and the points.
        let tolerance = 5.0 * (1.0 / 3.0) * (1.0 / (8.0 * seeds as f32) + 1.0 / number).sqrt();
        for (i, j) in [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)] {
            let expected = if i == j { 1.0 / 3.0 } else { 0.0 };
            assert!((squares.col(i)[j] - expected).abs() < tolerance, "{octaves}: {squares} +- {tolerance}");
        }
        assert!(mean.length() < 5.0 / number.sqrt(), "{mean}");
    }
}

/// Of a wave s(kappa . p + rate t) with the parabola s the mean square of s' is 64/3, and of s 8/15: so its slope by place is
/// sqrt(40) |kappa| times its strength, and by time sqrt(40) times its rate. Of octaves the squares add up.
#[test]
fn octaves_are_half_as_large_as_strong_as_roughness_says_and_faster() {
    const STEP: f32 = 0.125;
    const FRAMES: u32 = 8;
    let (seeds, count) = (60, 400);
    for (octaves, roughness) in [(1, 0.5), (2, 0.5), (2, 1.0), (3, 0.6)] {
        let (mut force, mut by_place, mut by_time) = (0.0, 0.0, 0.0);
        let pulse_length = 4800.0;
        for seed in 0..seeds {
            let settings = Turbulence {
                octaves,
                roughness,
                pulse_length,
                near_head: 0.0,
                drift: 0.0,
                seed,
                ..Turbulence::default()
            };
            let field = field(&settings);
            for i in 0..count {
                let p = 100.0 * (Vec3::new(0.618_034, 0.754_878, 0.569_840) * (i as f32 + 0.5)).fract() - 50.0;
                let square = |v: Vec3| f64::from(v.length_squared());
                force += square(field.at(p, FRAMES));
                for axis in Vec3::AXES {
                    by_place +=
                        square((field.at(p + STEP * axis, FRAMES) - field.at(p - STEP * axis, FRAMES)) / (2.0 * STEP));
                }
                by_time += square((field.at(p, 2 * FRAMES) - field.at(p, 0)) / (2 * FRAMES) as f32);
            }
        }
        let parts = |of: fn(f64) -> f64| {
            let power = |i: u32| f64::from(roughness).powi(2 * i as i32);
            let sum: f64 = (0..octaves).map(|i| power(i) * of(f64::from(i))).sum();
            sum / (0..octaves).map(power).sum::<f64>()
        };
        // Wavelengths are evenly spread in their inverse, 3/4 to 5/4 of that of two swirls: mean square 1 + 1/48. Rates are the
        // odd sixteenths from 9 to 23 of a turn a pulse, and i + 1 times that.
        let kappa = (1.0 + 1.0 / 48.0) / (2.0 * f64::from(Turbulence::default().swirl_size)).powi(2);
        let rate =
            (0..8).map(|m| f64::from(9 + 2 * m).powi(2)).sum::<f64>() / (8.0 * 256.0) / f64::from(pulse_length).powi(2);
        // A seed's kappas are of chance, 0.3 of their squares over the root of eight; its points, each with 24 waves and less, of as
        // much again. Five times that over the root of the seeds; differences over a hundredth of a turn take less.
        let tolerance = 5.0 * 2.0_f64.sqrt() * 0.3 / (8.0 * f64::from(seeds as u32)).sqrt();
        for (what, found, expected) in [
            ("place", by_place / force, 40.0 * kappa * parts(|i| 4.0_f64.powf(i))),
            ("time", by_time / force, 40.0 * rate * parts(|i| (i + 1.0).powi(2))),
        ] {
            let ratio = found / expected;
            assert!(
                (ratio - 1.0).abs() < tolerance,
                "{octaves} octaves, {roughness}: by {what} {ratio} +- {tolerance}"
            );
        }
    }
}

#[test]
fn it_drifts_on_by_the_wind_of_each_frame_that_it_comes_to() {
    let wind: Vec<Vec3> = (0..12).map(|n| Vec3::new(-60.0 + 9.0 * n as f32, 5.0 * (n % 3) as f32, 40.0)).collect();
    let settings = Turbulence { pulse_length: 0.0, near_head: 0.0, drift: 0.05, ..Turbulence::default() };
    let (still, p) = (field(&settings), Vec3::new(14.0, 3.0, 2.0));
    let drifting = TurbulenceField::new(&settings, HEAD, &[], &wind).unwrap();
    let mut way = Vec3::ZERO;
    for frame in 1..30 {
        way += settings.drift * wind[11.min(frame)];
        let left = (drifting.at(p + way, frame as u32) - still.at(p, frame as u32)).length();
        // A way of up to 100 cm is rounded to 2e-5 cm in sum, in which a swirl of 5 cm turns by that over 5 of the strength.
        assert!(left < settings.strength * 1e-3, "frame {frame}: {left}");
    }
}

#[test]
fn seeds_differ_and_strength_scales() {
    let one = field(&Turbulence::default());
    let two = field(&Turbulence { seed: 2, ..Turbulence::default() });
    let twice = field(&Turbulence { strength: 60.0, ..Turbulence::default() });
    let p = Vec3::new(14.0, 3.0, 2.0);
    assert!((one.at(p, 3) - two.at(p, 3)).length() > 1.0);
    assert!((twice.at(p, 3) - 2.0 * one.at(p, 3)).length() < 60.0 * 1e-5);
    let calm = field(&Turbulence { strength: 0.0, ..Turbulence::default() });
    assert_eq!((calm.uniform(3), calm.at(p, 3), calm.strongest()), (Some(Vec3::ZERO), Vec3::ZERO, 0.0));
    assert_eq!(one.uniform(3), None);
}

#[test]
fn an_envelope_scales_the_force_of_each_frame() {
    let keys = [(10, 0.0), (20, 2.0), (40, 0.5)].map(|(frame, factor)| EnvelopeKey { frame, factor });
    for near_head in [0.0, 4.0] {
        let even = field(&Turbulence { near_head, ..Turbulence::default() });
        let shaped = field(&Turbulence { near_head, envelope: keys.to_vec(), ..Turbulence::default() });
        let p = Vec3::new(14.0, 3.0, 2.0);
        for (frame, factor) in [(0, 0.0), (10, 0.0), (15, 1.0), (20, 2.0), (30, 1.25), (40, 0.5), (900, 0.5)] {
            assert_eq!(shaped.at(p, frame), factor * even.at(p, frame), "frame {frame}");
            assert_eq!(shaped.uniform(frame), (factor == 0.0).then_some(Vec3::ZERO));
        }
        assert_eq!(shaped.strongest(), 2.0 * even.strongest());
    }
}

#[test]
fn frames_worked_out_beforehand_are_those_worked_out_when_asked() {
    let field = on_the_way(&Turbulence::default());
    let mut bare = field.clone();
    bare.first_phases.clear();
    for frame in [0, 1, 19, 29, 30, 31, 700] {
        let p = Vec3::new(60.0, 155.0, -40.0);
        assert_eq!(field.at(p, frame), bare.at(p, frame));
    }
}

#[test]
fn settings_out_of_range_are_refused_by_name() {
    let thing = |settings: Turbulence| TurbulenceField::new(&settings, HEAD, &[], &[]).unwrap_err().thing;
    let default = Turbulence::default;
    assert_eq!(thing(Turbulence { strength: -1.0, ..default() }), "turbulence.strength");
    assert_eq!(thing(Turbulence { swirl_size: 0.0, ..default() }), "turbulence.swirl_size");
    assert_eq!(thing(Turbulence { pulse_length: f32::NAN, ..default() }), "turbulence.pulse_length");
    assert_eq!(thing(Turbulence { roughness: 1.1, ..default() }), "turbulence.roughness");
    assert_eq!(thing(Turbulence { octaves: 0, ..default() }), "turbulence.octaves");
    assert_eq!(thing(Turbulence { octaves: 9, ..default() }), "turbulence.octaves");
    assert_eq!(thing(Turbulence { drift: -0.1, ..default() }), "turbulence.drift");
    assert_eq!(thing(Turbulence { near_head: 9.6, ..default() }), "turbulence.near_head");
    let envelope = vec![EnvelopeKey { frame: 3, factor: f32::NAN }];
    assert_eq!(thing(Turbulence { envelope, ..default() }), "turbulence.envelope[0].factor");
    let refused = TurbulenceField::new(&default(), HEAD, &[], &[Vec3::NAN]).unwrap_err();
    assert_eq!(refused.thing, "wind of frame 0");
    let blamed = field(&default()).first_above(10.0).unwrap();
    assert_eq!(blamed.0, "turbulence.strength");
    let limit = 2.0 * f64::from(field(&default()).strongest());
    let blamed = field(&Turbulence { near_head: 1e-3, ..default() }).first_above(limit).unwrap();
    assert_eq!(blamed.0, "turbulence.near_head");
}
