use super::{Hairline, spread};
use crate::Head;

#[test]
fn pores_lie_on_the_skin() {
    let head = Head::builtin();
    let pores = spread(&head, &Hairline::default(), 500, 1).unwrap();
    assert_eq!(pores.len(), 500);
    assert!(pores.iter().all(|p| head.distance(p.position).abs() < 0.05));
}
