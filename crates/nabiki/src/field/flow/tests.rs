use glam::{DVec3, Quat, Vec4};
use proptest::prelude::*;

use super::*;
use crate::field::rows::forces;
use crate::field::{Keyframe, KeyframedField, ROW};

const HEAD: Ellipsoid = Ellipsoid { center: Vec3::new(1.0, 2.0, -1.0), half_axes: Vec3::new(9.5, 11.0, 8.0) };

fn wind(vector: Vec3) -> Arc<dyn Field> {
    Arc::new(KeyframedField::new(&[Keyframe { through: 9, vector }]).unwrap())
}

fn flow(ellipsoid: Ellipsoid, vector: Vec3) -> FlowField {
    FlowField::new(&Flow::default(), wind(vector), ellipsoid, &[]).unwrap()
}

fn ellipsoids() -> impl Strategy<Value = Ellipsoid> {
    ([4.0_f32..12.0, 4.0..12.0, 4.0..12.0], [-5.0_f32..5.0, -5.0..5.0, -5.0..5.0])
        .prop_map(|(axes, center)| Ellipsoid { center: center.into(), half_axes: axes.into() })
}

fn directions() -> impl Strategy<Value = Vec3> {
    [-1.0_f32..1.0, -1.0..1.0, -1.0..1.0]
        .prop_map(Vec3::from)
        .prop_filter("a direction", |v| (0.1..1.0).contains(&v.length()))
        .prop_map(|v| v.normalize())
}

/// The velocity's rounding: a few dozen operations on numbers of at most 1.5 |U| max, and lambda's, which is
/// a difference of squares.
const ROUNDING: f32 = 2e-5;

#[test]
fn a_sphere_has_lambs_flow() {
    let sphere = Ellipsoid { center: Vec3::ZERO, half_axes: Vec3::splat(9.0) };
    let field = flow(sphere, Vec3::new(-80.0, 0.0, 0.0));
    let at = |x, y, z| field.at(Vec3::new(x, y, z), 1);
    assert!(at(9.0, 0.0, 0.0).length() < 80.0 * ROUNDING && at(-9.0, 0.0, 0.0).length() < 80.0 * ROUNDING);
    for side in [at(0.0, 9.0, 0.0), at(0.0, 0.0, -9.0)] {
        assert!((side - Vec3::new(-120.0, 0.0, 0.0)).length() < 120.0 * ROUNDING, "{side}");
    }
    // U (1 + a^3 / 2 r^3) - 3 U a^3 x^2 / 2 r^5 before the sphere.
    for r in [9.5_f32, 14.0, 40.0, 1000.0] {
        let expected = -80.0 * (1.0 - (9.0 / r).powi(3));
        assert!((at(r, 0.0, 0.0).x - expected).abs() < 80.0 * ROUNDING, "{r}");
    }
    assert!((field.strongest() - 120.0).abs() < 120.0 * ROUNDING);
}

proptest! {
    #[test]
    fn nothing_flows_through_the_ellipsoid_and_far_away_is_the_wind(
        ellipsoid in ellipsoids(), u in directions(), d in directions()
    ) {
        let field = flow(ellipsoid, 100.0 * u);
        let on = ellipsoid.center + d * ellipsoid.half_axes;
        let normal = ellipsoid.gradient(on).normalize();
        prop_assert!(field.at(on, 1).dot(normal).abs() < 100.0 * ROUNDING * 4.0, "{}", field.at(on, 1).dot(normal));
        // The disturbance falls with the cube of the distance, in the longest half axis, and is at most U at the surface.
        let far = field.at(ellipsoid.center + 2000.0 * d, 1);
        prop_assert!((far - 100.0 * u).length() < 100.0 * (2.0 * (12.0_f32 / 2000.0).powi(3) + ROUNDING));
    }

    #[test]
    fn there_is_no_source_and_no_curl_outside(ellipsoid in ellipsoids(), u in directions(), d in directions(), out in 1.05_f32..3.0) {
        let field = flow(ellipsoid, 100.0 * u);
        let p = ellipsoid.center + out * d * ellipsoid.half_axes;
        // Central differences over 2 h err by h^2 times something smooth, and the extrapolated ones by less than a part of what
        // extrapolation took off; rounding is ROUNDING |U| over h, 4/3 + 1/3 of it for each of three slopes.
        let differences = |h: f32| {
            let slope = |axis: Vec3| (field.at(p + h * axis, 1) - field.at(p - h * axis, 1)) / (2.0 * h);
            let (x, y, z) = (slope(Vec3::X), slope(Vec3::Y), slope(Vec3::Z));
            Vec4::new(y.z - z.y, z.x - x.z, x.y - y.x, x.x + y.y + z.z)
        };
        let h = 0.05 * (out - 1.0) * 4.0;
        let (fine, coarse) = (differences(h), differences(2.0 * h));
        let left = fine + (fine - coarse) / 3.0;
        let tolerance = 0.25 * (fine - coarse).length() + 5.0 * 100.0 * ROUNDING / h;
        prop_assert!(left.length() < tolerance, "curl and divergence {left} +- {tolerance}");
    }

    #[test]
    fn it_is_continuous_and_finite_inside_and_never_above_its_bound(
        ellipsoid in ellipsoids(), u in directions(), d in directions(), out in 0.0_f32..4.0
    ) {
        let field = flow(ellipsoid, 100.0 * u);
        let at = |out: f32| field.at(ellipsoid.center + out * d * ellipsoid.half_axes, 1);
        prop_assert!(at(out).is_finite() && at(out).length() <= field.strongest(), "{} {}", at(out).length(), field.strongest());
        // A velocity of at most 3 |U| turns over no less than the smallest radius, 1 / 9 of the longest half axis.
        prop_assert!((at(1.0 - 1e-4) - at(1.0 + 1e-4)).length() < 300.0 * 2e-4 * 12.0 + 100.0 * ROUNDING * 4.0);
        prop_assert!(at(1e-3).length() < 1e-3 && at(0.0) == Vec3::ZERO);
    }

    #[test]
    fn it_goes_along_with_the_head_and_its_rows_are_its_points(
        ellipsoid in ellipsoids(), u in directions(), axis in directions(), angle in -3.0_f32..3.0, at in directions()
    ) {
        let pose = Pose { position_cm: Vec3::new(30.0, 160.0, -8.0), rotation: Quat::from_axis_angle(axis, angle) };
        let moved = FlowField::new(&Flow::default(), wind(pose.rotation * (100.0 * u)), ellipsoid, &[Pose::STILL, pose]).unwrap();
        let still = flow(ellipsoid, 100.0 * u);
        let places: [Vec3; ROW] = std::array::from_fn(|i| ellipsoid.center + (0.5 + 0.2 * i as f32) * at * ellipsoid.half_axes);
        let there = places.map(|p| pose.world_from_head().transform_point3(p));
        for (p, force) in places.into_iter().zip(forces(&moved, there, 5)) {
            // Points near 200 cm are rounded by 1e-5 cm, over which the force changes by 3 |U| 1e-5.
            let expected = pose.rotation * still.at(p, 1);
            prop_assert!((force - expected).length() < 100.0 * 8.0 * ROUNDING);
        }
    }
}

/// A wind that differs from place to place.
#[derive(Debug)]
struct Sheared;

impl Field for Sheared {
    fn at(&self, p: Vec3, _frame: u32) -> Vec3 {
        Vec3::new(-p.y, 2.0 * p.x, p.z)
    }

    fn strongest(&self) -> f32 {
        1000.0
    }
}

#[test]
fn a_wind_that_is_not_uniform_counts_as_it_is_at_the_centre_of_the_head() {
    let pose = Pose { position_cm: Vec3::new(30.0, 16.0, -8.0), rotation: Quat::from_rotation_y(0.7) };
    let flow = |wind: Arc<dyn Field>| FlowField::new(&Flow::default(), wind, HEAD, &[Pose::STILL, pose]).unwrap();
    let sheared = flow(Arc::new(Sheared));
    for (frame, pose) in [(0, Pose::STILL), (1, pose), (9, pose)] {
        let center = pose.world_from_head().transform_point3(HEAD.center);
        let uniform = flow(wind(Sheared.at(center, frame)));
        for at in [Vec3::new(12.0, 4.0, 3.0), Vec3::new(-40.0, 20.0, 9.0)] {
            // A centre 35 cm off is rounded to 4e-6 cm, over which the wind changes by twice that.
            let left = (sheared.at(center + at, frame) - uniform.at(center + at, frame)).length();
            assert!(left < 100.0 * ROUNDING, "frame {frame}: {left}");
        }
    }
}

#[test]
fn lambda_is_the_root_for_any_point() {
    for axes in [[9.5_f32, 11.0, 8.0], [12.0, 4.0, 6.0], [5.0, 5.0, 15.0]] {
        let field = flow(Ellipsoid { center: Vec3::ZERO, half_axes: axes.into() }, Vec3::X);
        let frame = field.in_frame(1);
        for i in 0..2000 {
            let turn = f64::from(i) * 0.7548776662;
            let y = 1.0 - 2.0 * (f64::from(i) + 0.5) / 2000.0;
            let d = DVec3::new((1.0 - y * y).sqrt() * turn.cos(), y, (1.0 - y * y).sqrt() * turn.sin());
            let p = d * DVec3::from_array(axes.map(f64::from)) * (1.0 + 3.0 * (f64::from(i) * 0.618).fract());
            let lambda = f64::from(frame.lambda(p.as_vec3().to_array().map(|v| v * v)));
            let sum: f64 = (0..3).map(|i| p[i] * p[i] / (f64::from(axes[i]).powi(2) + lambda)).sum();
            assert!((sum - 1.0).abs() < 1e-5, "{p}: {sum}");
        }
    }
}

#[test]
fn thickness_moves_the_surface_out_and_flat_heads_are_refused() {
    let settings = Flow { thickness: 2.0 };
    let thick = FlowField::new(&settings, wind(Vec3::NEG_X), HEAD, &[]).unwrap();
    let bare = flow(Ellipsoid { half_axes: HEAD.half_axes + 2.0, ..HEAD }, Vec3::NEG_X);
    assert_eq!(thick.at(Vec3::new(14.0, 3.0, 2.0), 1), bare.at(Vec3::new(14.0, 3.0, 2.0), 1));
    assert_eq!(Flow { thickness: -1.0 }.check().unwrap_err().thing, "flow.thickness");
    let flat = Ellipsoid { center: Vec3::ZERO, half_axes: Vec3::new(10.0, 0.1, 10.0) };
    let refused = FlowField::new(&Flow::default(), wind(Vec3::X), flat, &[]).unwrap_err();
    assert_eq!(refused.thing, "head.ellipsoid.half_axes");
    let calm = flow(HEAD, Vec3::ZERO);
    assert_eq!((calm.uniform(3), calm.strongest()), (Some(Vec3::ZERO), 0.0));
}
