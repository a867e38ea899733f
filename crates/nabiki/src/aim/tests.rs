use super::*;
use crate::strands::Strands;

fn line(root: Vec3, way: Vec3, points: usize) -> Vec<Vec3> {
    (0..points).map(|i| root + i as f32 * way).collect()
}

fn curves(of: &[Vec<Vec3>]) -> AimCurves {
    let mut strands = Strands::default();
    of.iter().for_each(|curve| strands.push(curve.iter().copied()));
    AimCurves::new(strands, None, "pose.usda").unwrap()
}

/// Random places, of which the nearest are searched one by one.
#[test]
fn the_nearest_curves_lead() {
    let place = |i: u32| {
        let chance = crate::chance::Chance::at_cell(7, glam::IVec3::splat(i as i32));
        DVec3::new(chance.unit(0), chance.unit(1), chance.unit(2)).as_vec3() * 10.0
    };
    let roots: Vec<Vec3> = (0..200).map(place).collect();
    let ways: Vec<Vec3> = (500..700).map(|i| (place(i) - 5.0).normalize()).collect();
    let curves = curves(&roots.iter().zip(&ways).map(|(&root, &way)| line(root, way, 9)).collect::<Vec<_>>());
    for i in 1000..1100 {
        let root = place(i);
        let strand = line(root, Vec3::Y, 5);
        let mut all: Vec<(f64, usize)> =
            roots.iter().enumerate().map(|(s, at)| (at.as_dvec3().distance(root.as_dvec3()), s)).collect();
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        let beyond = all[3].0;
        let sum: DVec3 =
            all[..3].iter().map(|&(r, s)| ((beyond - r) / (beyond * r)).powi(2) * ways[s].as_dvec3()).sum();
        for direction in curves.directions(root.as_dvec3(), &strand) {
            assert!(direction.distance(sum.normalize()) < 1e-5, "{direction} {sum}");
        }
    }
}

#[test]
fn a_curve_at_the_root_leads_alone_and_the_way_to_its_neighbour_is_smooth() {
    let of = curves(&[line(Vec3::ZERO, Vec3::Y, 5), line(Vec3::X, Vec3::Z, 5)]);
    let at = |x: f64| of.directions(DVec3::new(x, 0.0, 0.0), &line(Vec3::ZERO, Vec3::Y, 5))[2];
    assert_eq!((at(0.0), at(1.0)), (DVec3::Y, DVec3::Z));
    assert!(at(0.5).distance(DVec3::new(0.0, 1.0, 1.0).normalize()) < 1e-12);
    for i in 1..100 {
        // As 1 / r^2 changes: by two hundredths of itself at most in the middle, and of nothing at the ends.
        assert!(at(0.01 * f64::from(i)).distance(at(0.01 * f64::from(i - 1))) < 0.05, "{i}");
    }
}

#[test]
fn curves_lead_by_length_of_hair_and_their_ends_lead_all_beyond() {
    // 2 cm along y, then 1 cm along x, in other steps than the strand has.
    let of = curves(&[vec![Vec3::ZERO, 0.5 * Vec3::Y, 2.0 * Vec3::Y, Vec3::new(1.0, 2.0, 0.0)]]);
    let directions = of.directions(DVec3::ZERO, &line(Vec3::ZERO, Vec3::Z, 7));
    let [x, y] = [DVec3::X, DVec3::Y];
    assert_eq!(directions, [y, y, x, x, x, x]);
}

#[test]
fn a_point_is_led_to_from_the_root_or_from_where_a_tie_ends() {
    let strand = line(Vec3::ZERO, Vec3::X, 5);
    let toward = |held| {
        let shape = AimShape::Toward(Vec3::new(2.0, 5.0, 0.0));
        let aim = Aim { name: "aim[0]".to_owned(), lead: Lead::default(), region: None, shape };
        aim.directions(&strand, held, None)
    };
    assert!(toward(0)[3].distance(DVec3::new(2.0, 5.0, 0.0).normalize()) < 1e-12);
    assert_eq!(toward(2)[3], DVec3::Y);
}
