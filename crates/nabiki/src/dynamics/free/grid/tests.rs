//! Laws of what neighbours do.

use std::sync::Arc;

use super::*;
use crate::strands::Strands;

/// Edge of a cell (cm), and of the lattice that the points of the carriers make.
const CELL: f32 = 2.0;
/// Points of the lattice along each axis.
const ALONG: usize = 12;
const FORCES: NeighbourForces = NeighbourForces { carriers: 1, pressure: 7.0, cohesion: 3.0, cell: CELL };

/// Strands of one segment along y. Their points lie on the nodes of the grid, each stands for as much hair, and so the density at
/// rest is 1 on all of them to the bit.
fn lattice() -> (Crowd, Vec<Vec3>) {
    let mut carriers = Strands::default();
    let place = |i: usize| CELL * i as f32;
    for (i, k) in (0..ALONG * ALONG).map(|n| (n / ALONG, n % ALONG)) {
        for j in (0..ALONG).step_by(2) {
            carriers.push([j, j + 1].map(|j| Vec3::new(place(i), place(j), place(k))));
        }
    }
    let points = carriers.points().to_vec();
    let crowd = Crowd::new(&Neighbours { forces: FORCES, carriers: Arc::new(carriers) }, 1.0, &points).unwrap();
    (crowd, points)
}

/// Half of the hair within the other half: twice as dense as at rest beyond the middle of an axis, and none before that.
fn crowded(points: &[Vec3], axis: usize) -> Vec<Vec3> {
    let middle = CELL * (ALONG / 2) as f32;
    let over = |mut p: Vec3| {
        p[axis] += if p[axis] < middle { middle } else { 0.0 };
        p
    };
    points.iter().map(|&p| over(p)).collect()
}

/// A few roundings of numbers of the size of the forces.
const ROUNDING: f64 = 1e-5;

/// On a point that goes along at a velocity.
fn force(crowd: &Crowd, p: DVec3, velocity: DVec3) -> DVec3 {
    let (force, held) = crowd.at(p);
    force - held * velocity
}

/// On the way into hair that is fuller than at rest by 1, what pushes back adds up, cell by cell, to the pressure: the slope of the
/// density is counted over one cell. Nothing pushes across, and nothing where hair is thinner than at rest.
#[test]
fn the_way_into_hair_twice_as_dense_costs_the_pressure() {
    let (mut crowd, points) = lattice();
    let still = vec![Vec3::ZERO; points.len()];
    for axis in 0..3 {
        crowd.fill(&crowded(&points, axis), &still);
        for off in [0.0, 0.3, 1.7] {
            let mut sum = DVec3::ZERO;
            // From amid the emptied half to amid the crowded one, at any place in the cells.
            for i in 2..ALONG - 2 {
                let mut p = DVec3::splat(11.3);
                p[axis] = f64::from(CELL) * i as f64 + off;
                sum += force(&crowd, p, DVec3::ZERO);
            }
            let mut expected = DVec3::ZERO;
            expected[axis] = -f64::from(FORCES.pressure);
            assert!((sum - expected).length() < ROUNDING * 7.0, "axis {axis}: {sum}, not {expected}");
        }
    }
    crowd.fill(&points, &still);
    assert_eq!(force(&crowd, DVec3::splat(11.3), DVec3::ZERO), DVec3::ZERO);
}

/// Cohesion pulls toward the mean velocity, by as much for each cm a frame wherever hair is at least as dense as at rest, and half of
/// it where it is half as dense; what goes along feels nothing.
#[test]
fn cohesion_pulls_toward_the_mean_velocity() {
    let (mut crowd, points) = lattice();
    let (fast, slow) = (Vec3::new(0.4, -0.1, 0.3), Vec3::new(-0.2, 0.5, 0.1));
    let own = DVec3::new(0.1, 0.2, -0.3);
    let cohesion = f64::from(FORCES.cohesion);
    // Amid the crowded half, where those that were moved there and those that were there before are mixed half and half.
    let p = DVec3::new(17.1, 11.3, 12.9);
    let velocities: Vec<Vec3> = points.iter().map(|p| if p.x < 12.0 { fast } else { slow }).collect();
    crowd.fill(&crowded(&points, 0), &velocities);
    let mean = (0.5 * (fast + slow)).as_dvec3();
    assert!((force(&crowd, p, own) - cohesion * (mean - own)).length() < ROUNDING);
    crowd.fill(&points, &velocities);
    assert!((force(&crowd, p, own) - cohesion * (slow.as_dvec3() - own)).length() < ROUNDING);
    // Every other strand gone far off, and the others midway between nodes: half as dense.
    let thinned = points.iter().map(|&p| if p.x % 4.0 > 0.0 { Vec3::new(0.0, 0.0, p.z) } else { p + Vec3::X });
    crowd.fill(&thinned.collect::<Vec<_>>(), &velocities);
    let force = force(&crowd, p, own);
    assert!((force - 0.5 * cohesion * (slow.as_dvec3() - own)).length() < ROUNDING, "{force}");
}

/// What is taken is what is there, wherever hair was in either before, be it beyond the grid.
#[test]
fn a_crowd_that_takes_another_is_as_it() {
    let (at_rest, points) = lattice();
    let still = vec![Vec3::new(0.1, -0.2, 0.3); points.len()];
    let left = |axes: &[usize], far: bool| {
        let mut crowd = at_rest.clone();
        for &axis in axes {
            let mut there = crowded(&points, axis);
            if far {
                there[7] = Vec3::splat(1e3);
            }
            crowd.fill(&there, &still);
        }
        crowd
    };
    for other in [left(&[], false), left(&[0], false), left(&[1, 2], true)] {
        for mut crowd in [left(&[], false), left(&[2], true), left(&[0, 1, 0], false)] {
            crowd.take(&other);
            assert_eq!(crowd.content, other.content);
            assert_eq!((crowd.excess, crowd.pull), (other.excess.clone(), other.pull.clone()));
        }
    }
}
