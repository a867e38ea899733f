use glam::Vec3;

use super::evenly;

#[test]
fn a_smaller_choice_begins_a_larger_one() {
    let roots: Vec<Vec3> = (0..1000).map(|i| Vec3::new((i % 37) as f32, (i % 11) as f32, i as f32 * 0.01)).collect();
    let all = evenly(&roots, 2000);
    assert_eq!(all.len(), 1000);
    assert_eq!(evenly(&roots, 60), all[..60]);
    let mut sorted = all.clone();
    sorted.sort_unstable();
    assert!(sorted.iter().enumerate().all(|(i, &j)| i == j));
}
