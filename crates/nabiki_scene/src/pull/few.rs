//! A few strands that represent a lock, among the carriers around them.

use std::sync::Arc;

use glam::Vec3;
use nabiki::Strands;
use nabiki::dynamics::Form;
use nabiki::solve::Problem;

/// Most nodes of a lock that are observed: the mean of these moves almost like that of all. As many strands are stepped at once.
const NODES: usize = 16;
/// Carriers within this distance of one of these strands at rest are around them (cm), within these limits on their number.
const ABOUT_CM: f32 = 2.0;
const LEAST: usize = 16;
const MOST: usize = 32;
/// Places along a strand at which the distance of two strands is measured.
const PLACES: usize = 5;

/// The same problem for a few strands of each wish, among the carriers around them.
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

/// The carriers around some strands of the hair, ascending.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pull::Lock;
    use crate::{Scene, Shown};
    use nabiki::solve::Goal;

    fn problem(text: &str, strands: usize) -> Problem {
        let scene = Scene::parse(text, "a.toml".as_ref(), &[]).unwrap();
        let built = scene.build(Shown::All).unwrap();
        let nodes = (0..strands).map(|strand| (strand, 3)).collect();
        let lock = Lock { frame: 5, nodes };
        built.problem(Vec::new(), vec![lock.wish(Goal::Stay, 1.0)])
    }

    #[test]
    fn a_lock_of_few_strands_stands_for_itself_and_a_larger_one_for_all_of_its_length() {
        let text = "[hair]\nstrands = 60\n[motion]\nframes = 10\nform = \"free\"\n";
        let small = problem(text, NODES);
        let same = few(&small);
        assert_eq!((same.wishes, same.dynamics), (small.wishes, small.dynamics));
        let large = few(&problem(text, 50));
        let strands: Vec<u32> = large.wishes[0].nodes.iter().map(|node| node.strand).collect();
        assert_eq!(strands.len(), NODES);
        assert!(strands.windows(2).all(|pair| (3..=4).contains(&(pair[1] - pair[0]))), "{strands:?}");
    }

    #[test]
    fn the_carriers_about_a_lock_are_those_that_come_nearest_to_it() {
        let mut carriers = Strands::default();
        for x in 0..100 {
            carriers.push((0..9).map(|k| Vec3::new(0.25 * x as f32, 0.5 * k as f32, 0.0)));
        }
        // For one strand at 10 cm, all within 2 cm: 32 to 48 carriers, 40 in the middle.
        let about_40 = about(&carriers, &carriers, &[40]);
        assert_eq!(about_40, (32..=48).collect::<Vec<_>>());
        let beside = about(&carriers, &carriers, &[0]);
        assert_eq!(beside, (0..LEAST).collect::<Vec<_>>(), "as many as there are at the least");
        let all_over = about(&carriers, &carriers, &(0..100).collect::<Vec<_>>());
        assert_eq!(all_over.len(), MOST);
    }
}
