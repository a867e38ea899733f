//! A few strands that stand for a lock, among the carriers about them.

use std::sync::Arc;

use glam::Vec3;
use nabiki::Strands;
use nabiki::dynamics::Form;
use nabiki::solve::Problem;

/// So many nodes of a lock are looked at, at the most: what their middle does is nearly what that of all does. As many strands are stepped at once.
const NODES: usize = 16;
/// Carriers that at rest come this near to one of these strands are about them (cm), and so many are taken at the least and at the most.
const ABOUT_CM: f32 = 2.0;
const LEAST: usize = 16;
const MOST: usize = 32;
/// Places along a strand between which it is looked how near two come.
const PLACES: usize = 5;

/// The same problem of a few strands of each wish, among the carriers about them.
pub(super) fn few(problem: &Problem) -> Problem {
    let mut few = problem.clone();
    for wish in &mut few.wishes {
        let all = std::mem::take(&mut wish.nodes);
        let count = all.len().min(NODES);
        wish.nodes = (0..count).map(|i| all[i * all.len() / count]).collect();
    }
    if let Form::Free(free) = &mut few.dynamics.form
        && let Some(neighbours) = &mut free.neighbours
    {
        let strands = few.wishes.iter().flat_map(|wish| wish.nodes.iter().map(|node| node.strand as usize));
        let about = about(&neighbours.carriers, &few.hair, &strands.collect::<Vec<_>>());
        neighbours.carriers = Arc::new(neighbours.carriers.select(&about));
    }
    few
}

/// The carriers about some strands of the hair, ascending.
fn about(carriers: &Strands, hair: &Strands, strands: &[usize]) -> Vec<usize> {
    let places = |strand: &[Vec3]| [0, 1, 2, 3, 4].map(|i| strand[i * (strand.len() - 1) / (PLACES - 1)]);
    let of_lock: Vec<Vec3> = strands.iter().flat_map(|&s| places(hair.strand(s))).collect();
    let away = |carrier: &[Vec3]| {
        let nearest = |p: &Vec3| of_lock.iter().map(|q| p.distance_squared(*q)).fold(f32::INFINITY, f32::min);
        places(carrier).iter().map(nearest).fold(f32::INFINITY, f32::min)
    };
    let mut all: Vec<(f32, usize)> = carriers.iter().enumerate().map(|(i, carrier)| (away(carrier), i)).collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    let near = all.iter().take_while(|(squared, _)| *squared <= ABOUT_CM * ABOUT_CM).count();
    let mut chosen: Vec<usize> = all.into_iter().take(near.clamp(LEAST, MOST)).map(|(_, i)| i).collect();
    chosen.sort_unstable();
    chosen
}
