//! Laws of the local fields.

use proptest::prelude::*;

use super::*;
use crate::field::falloff::FalloffLaw;
use crate::field::rows::forces;
use crate::field::{Fan, FanField, Field, Point, PointField, ROW, Vortex, VortexField};

const POSITION: Vec3 = Vec3::new(20.0, 3.0, -7.0);

fn falloffs() -> impl Strategy<Value = Falloff> {
    let laws =
        [FalloffLaw::None, FalloffLaw::Linear, FalloffLaw::Smooth, FalloffLaw::Inverse, FalloffLaw::InverseSquare];
    (prop::sample::select(laws.to_vec()), 1.0_f32..80.0).prop_map(|(law, radius)| Falloff { law, radius })
}

fn vectors(reach: f32) -> impl Strategy<Value = Vec3> {
    [-reach..reach, -reach..reach, -reach..reach].prop_map(Vec3::from)
}

fn envelopes() -> impl Strategy<Value = Vec<EnvelopeKey>> {
    prop::collection::vec(-2.0_f32..2.0, 0..4)
        .prop_map(|factors| (0..).zip(factors).map(|(i, factor)| EnvelopeKey { frame: 10 * i, factor }).collect())
}

fn point(strength: f32, falloff: Falloff, envelope: &[EnvelopeKey]) -> PointField {
    let settings = Point { position: POSITION, strength, falloff, envelope: envelope.to_vec() };
    PointField::new(&settings, "point[0]").unwrap()
}

fn vortex(axis: Vec3, strength: f32, falloff: Falloff, envelope: &[EnvelopeKey]) -> VortexField {
    let settings = Vortex { position: POSITION, axis, strength, falloff, envelope: envelope.to_vec() };
    VortexField::new(&settings, "vortex[0]").unwrap()
}

fn fan(direction: Vec3, spread: f32, strength: f32, falloff: Falloff, envelope: &[EnvelopeKey]) -> FanField {
    let settings = Fan { position: POSITION, direction, spread, strength, falloff, envelope: envelope.to_vec() };
    FanField::new(&settings, "fan[0]").unwrap()
}

proptest! {
    #[test]
    fn none_exceeds_its_bound_and_rows_are_points(
        falloff in falloffs(), envelope in envelopes(), strength in -90.0_f32..90.0,
        axis in vectors(1.0), spread in 1.0_f32..90.0, p in vectors(60.0), frame in 0_u32..50
    ) {
        prop_assume!(axis.length() > 0.01);
        let fields: [&dyn Field; 3] = [
            &point(strength, falloff, &envelope),
            &vortex(axis, strength, falloff, &envelope),
            &fan(axis, spread, strength, falloff, &envelope),
        ];
        for field in fields {
            // Straight toward the place, and into it.
            let way: [Vec3; ROW] = std::array::from_fn(|i| POSITION + p * (1.0 - i as f32 / 15.0));
            for force in forces(field, way, frame) {
                prop_assert!(force.is_finite() && force.length() <= field.strongest());
                if let Some(uniform) = field.uniform(frame) {
                    prop_assert_eq!(force, uniform);
                }
            }
            prop_assert_eq!(field.at(POSITION, frame), Vec3::ZERO);
        }
    }

    #[test]
    fn a_point_blows_along_the_way_from_it_as_its_law_says(falloff in falloffs(), p in vectors(60.0)) {
        let (r, core) = (p.length(), 0.05 * falloff.radius);
        prop_assume!(r > core);
        let force = point(40.0, falloff, &[]).at(POSITION + p, 1);
        let expected = 40.0 * falloff.at(r) * p / r.hypot(core);
        // POSITION + p is rounded to 4e-6 cm, over which the direction turns by that over r and the falloff by that over R.
        let tolerance = 40.0 * (2e-6 + 2.0 * 4e-6 * (1.0 / r + 1.5 / falloff.radius));
        prop_assert!((force - expected).length() < tolerance, "{force} {expected}");
    }

    #[test]
    fn a_vortex_goes_round_its_axis_alike_at_every_height(falloff in falloffs(), axis in vectors(1.0), p in vectors(40.0), height in -30.0_f32..30.0) {
        prop_assume!(axis.length() > 0.1 && axis.cross(p).length() > 0.5);
        let unit = axis.normalize();
        let field = vortex(axis, 40.0, falloff, &[]);
        let force = field.at(POSITION + p, 1);
        let out = p - unit * unit.dot(p);
        // Sizes are at most 40, and places rounded to 8e-6 cm.
        let tolerance = 40.0 * (4e-6 + 4.0 * 8e-6 * (1.0 / out.length() + 1.5 / falloff.radius));
        prop_assert!(force.dot(unit).abs() < tolerance && force.dot(out.normalize()).abs() < tolerance);
        prop_assert!(force.dot(unit.cross(out)) >= -tolerance * out.length());
        let size = 40.0 * falloff.at(out.length()) * out.length() / out.length().hypot(0.05 * falloff.radius);
        prop_assert!((force.length() - size).abs() < tolerance, "{} is not {size}", force.length());
        prop_assert!((field.at(POSITION + p + height * unit, 1) - force).length() < 2.0 * tolerance);
    }

    #[test]
    fn a_fan_blows_within_its_cone_and_not_beyond(falloff in falloffs(), axis in vectors(1.0), spread in 5.0_f32..90.0, p in vectors(40.0)) {
        prop_assume!(axis.length() > 0.1);
        // Beyond the radius, so that the core takes no more than it says below.
        let p = p.normalize_or(Vec3::X) * (p.length() + falloff.radius);
        let field = fan(axis, spread, 40.0, falloff, &[]);
        let angle = axis.angle_between(p).to_degrees();
        let force = field.at(POSITION + p, 1);
        if angle > spread + 0.1 {
            prop_assert_eq!(force, Vec3::ZERO);
        } else {
            let around = point(40.0, falloff, &[]).at(POSITION + p, 1);
            prop_assert!(force.length() <= around.length() * (1.0 + 1e-5));
            prop_assert!(force.angle_between(p) < 1e-3 || force.length() < 1e-5);
            // At half of the cone 1 - c is 1/2, of which the fourth power is 1/16; the core takes 1/800 of the cosine.
            let half = 0.5 * (1.0 + spread.to_radians().cos());
            if angle.to_radians().cos() > half + 0.01 {
                prop_assert!(force.length() >= around.length() * (1.0 - 1.0 / 16.0));
            }
        }
    }
}

#[test]
fn none_pushes_at_its_centre_however_small_its_radius() {
    let laws =
        [FalloffLaw::None, FalloffLaw::Linear, FalloffLaw::Smooth, FalloffLaw::Inverse, FalloffLaw::InverseSquare];
    for (law, radius) in laws.into_iter().flat_map(|law| [1e-30, 1e-20, 1e-3].map(|radius| (law, radius))) {
        let falloff = Falloff { law, radius };
        let fields: [&dyn Field; 3] =
            [&point(40.0, falloff, &[]), &vortex(Vec3::Y, 40.0, falloff, &[]), &fan(Vec3::X, 30.0, 40.0, falloff, &[])];
        for field in fields {
            assert_eq!(field.at(POSITION, 1), Vec3::ZERO, "{field:?}");
            assert_eq!(forces(field, [POSITION; ROW], 1), [Vec3::ZERO; ROW], "{field:?}");
            let force = field.at(POSITION + Vec3::X, 1);
            assert!(force.is_finite() && force.length() <= field.strongest(), "{force} of {field:?}");
        }
    }
}

#[test]
fn settings_out_of_range_are_refused_by_name() {
    let plain = Point { position: POSITION, strength: 1.0, falloff: Falloff::default(), envelope: Vec::new() };
    let thing = |settings: Point| settings.check_at("point[2]").unwrap_err().thing;
    assert_eq!(thing(Point { position: Vec3::NAN, ..plain.clone() }), "point[2].position");
    assert_eq!(thing(Point { position: Vec3::X * 1e7, ..plain.clone() }), "point[2].position");
    assert_eq!(thing(Point { strength: f32::INFINITY, ..plain.clone() }), "point[2].strength");
    let falloff = Falloff { radius: 0.0, ..Falloff::default() };
    assert_eq!(thing(Point { falloff, ..plain.clone() }), "point[2].falloff.radius");
    let envelope = vec![EnvelopeKey { frame: 3, factor: f32::NAN }];
    assert_eq!(thing(Point { envelope, ..plain }), "point[2].envelope[0].factor");
    let vortex = Vortex {
        position: POSITION,
        axis: Vec3::ZERO,
        strength: 1.0,
        falloff: Falloff::default(),
        envelope: Vec::new(),
    };
    assert_eq!(vortex.check_at("vortex[0]").unwrap_err().thing, "vortex[0].axis");
    let fan = Fan {
        position: POSITION,
        direction: Vec3::X,
        strength: 1.0,
        spread: 91.0,
        falloff: Falloff::default(),
        envelope: Vec::new(),
    };
    assert_eq!(fan.check_at("fan[0]").unwrap_err().thing, "fan[0].spread");
    assert_eq!(
        Fan { direction: Vec3::ZERO, spread: 30.0, ..fan }.check_at("fan[0]").unwrap_err().thing,
        "fan[0].direction"
    );
}

#[test]
fn the_one_too_strong_is_named() {
    let field = point(-30.0, Falloff::default(), &[EnvelopeKey { frame: 0, factor: 2.0 }]);
    assert_eq!(field.first_above(50.0), Some(("point[0].strength".to_owned(), "-30".to_owned())));
    assert_eq!(field.first_above(61.0), None);
}
