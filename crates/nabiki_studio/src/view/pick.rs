//! What is under the pointer: the strand that a hand means, and the lock about it.

use glam::{Vec2, Vec3};
use nabiki::{Ellipsoid, Strands};
use nabiki_render::View;
use nabiki_render::camera::NEAR;

/// How much farther a strand may be for each pixel that it is nearer to the pointer, in pixels of depth.
const DEPTH_PER_PIXEL: f32 = 6.0;
/// What lies deeper in the head than this is hidden by it (cm): hair lies on skin that is not quite the ellipsoid.
const HIDDEN_CM: f32 = 1.5;

/// A node of a strand, and where it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Picked {
    /// Which strand.
    pub strand: usize,
    /// Which of its points; never the root, which nothing moves.
    pub node: usize,
    /// Where that point is (head space, cm).
    pub place: Vec3,
    /// Pixels between it and the pointer.
    pub apart: f32,
}

/// The node that is meant by a pixel, of the first `among` strands: of the segments within `reach` pixels of it, and not behind
/// the head, the one nearest to pointer and eye; of its ends the nearer one. `view` and `points` are in head space.
pub fn nearest(
    view: &View,
    points: &[Vec3],
    strands: &Strands,
    among: usize,
    head: &Ellipsoid,
    pixel: Vec2,
    reach: f32,
) -> Option<Picked> {
    let mut best: Option<(f32, Picked)> = None;
    let per_cm = view.pixels_per_cm(view.project(head.center).z.max(NEAR));
    for strand in 0..strands.len().min(among) {
        let of = &points[strands.range(strand)];
        for (i, pair) in of.windows(2).enumerate() {
            let (a, b) = (view.project(pair[0]), view.project(pair[1]));
            if !(a.z >= NEAR && b.z >= NEAR) {
                continue;
            }
            let (from, way) = (a.truncate(), b.truncate() - a.truncate());
            let t = ((pixel - from).dot(way) / way.length_squared().max(1e-9)).clamp(0.0, 1.0);
            let apart = (from + way * t).distance(pixel);
            if apart > reach {
                continue;
            }
            let depth = a.z + (b.z - a.z) * t;
            let cost = apart * DEPTH_PER_PIXEL + depth * per_cm;
            if best.is_some_and(|(least, _)| cost >= least) {
                continue;
            }
            if behind(view, head, pair[0].lerp(pair[1], t)) {
                continue;
            }
            let node = if t < 0.5 && i > 0 { i } else { i + 1 };
            let place = of[node];
            let apart = view.project(place).truncate().distance(pixel);
            best = Some((cost, Picked { strand, node, place, apart }));
        }
    }
    best.map(|(_, picked)| picked)
}

/// Whether the head hides a place.
fn behind(view: &View, head: &Ellipsoid, place: Vec3) -> bool {
    // Where the way from the place to the eye leaves the head, in the space in which it is a ball.
    let toward = view.toward_eye(place);
    let (q, d) = ((place - head.center) / head.half_axes, toward / head.half_axes);
    let (a, b, c) = (d.length_squared(), q.dot(d), q.length_squared() - 1.0);
    let root = b * b - a * c;
    // What is before the place and long enough inside.
    root > 0.0 && {
        let (enter, leave) = ((-b - root.sqrt()) / a, (-b + root.sqrt()) / a);
        leave - enter.max(0.0) > HIDDEN_CM
    }
}

/// A lock: of each of the first `among` strands that has a node within `radius` (cm) of a place, the node nearest to it, roots left out. The picked
/// strand comes first, the others by their distance.
pub fn lock(points: &[Vec3], strands: &Strands, among: usize, picked: &Picked, radius: f32) -> Vec<(usize, usize)> {
    let mut near: Vec<(f32, usize, usize)> = (0..strands.len().min(among))
        .filter_map(|strand| {
            let of = points[strands.range(strand)].iter().enumerate().skip(1);
            let nearest =
                of.map(|(node, p)| (p.distance_squared(picked.place), node)).min_by(|a, b| a.0.total_cmp(&b.0));
            let (squared, node) = nearest?;
            let mine = strand == picked.strand;
            (mine || squared <= radius * radius).then_some(if mine {
                (-1.0, strand, picked.node)
            } else {
                (squared, strand, node)
            })
        })
        .collect();
    near.sort_by(|a, b| a.0.total_cmp(&b.0));
    near.into_iter().map(|(_, strand, node)| (strand, node)).collect()
}

#[cfg(test)]
mod tests {
    use nabiki_render::Bounds;
    use nabiki_render::settings::Camera;

    use super::*;
    use crate::view::camera::Orbit;

    const HEAD: Ellipsoid = Ellipsoid { center: Vec3::ZERO, half_axes: Vec3::new(9.0, 11.0, 8.0) };

    /// Strands that hang straight down at these places of the horizontal plane.
    fn hanging(at: &[[f32; 2]]) -> Strands {
        let mut strands = Strands::default();
        for [x, z] in at {
            strands.push((0..10).map(|k| Vec3::new(*x, 5.0 - k as f32, *z)));
        }
        strands
    }

    /// From before the face.
    fn view() -> View {
        let camera = Camera {
            azimuth: 0.0,
            elevation: 0.0,
            distance: Some(80.0),
            target: Some(Vec3::ZERO),
            ..Camera::default()
        };
        Orbit::new(&camera, [800, 600], &Bounds::default()).view([800, 600], Vec3::ZERO)
    }

    #[test]
    fn the_node_under_the_pointer_is_found_and_nothing_beyond_reach() {
        let strands = hanging(&[[12.0, 0.0], [12.0, 4.0], [12.0, -4.0]]);
        let view = view();
        for (strand, node) in [(0, 3), (1, 9), (2, 1)] {
            let pixel = view.project(strands.strand(strand)[node]).truncate();
            let found = nearest(&view, strands.points(), &strands, usize::MAX, &HEAD, pixel + Vec2::new(2.0, 1.0), 8.0)
                .unwrap();
            assert_eq!((found.strand, found.node), (strand, node));
            assert_eq!(found.place, strands.strand(strand)[node]);
        }
        let pixel = view.project(Vec3::new(12.0, 0.0, 2.0)).truncate();
        assert_eq!(nearest(&view, strands.points(), &strands, usize::MAX, &HEAD, pixel, 8.0), None);
    }

    #[test]
    fn of_two_strands_on_one_pixel_the_front_one_is_meant_and_roots_never() {
        let strands = hanging(&[[10.0, 0.0], [14.0, 0.0]]);
        let view = view();
        let pixel = view.project(strands.strand(0)[4]).truncate();
        let found = nearest(&view, strands.points(), &strands, usize::MAX, &HEAD, pixel, 8.0).unwrap();
        assert_eq!(found.strand, 1);
        let root = view.project(strands.strand(1)[0]).truncate();
        let found = nearest(&view, strands.points(), &strands, usize::MAX, &HEAD, root, 8.0).unwrap();
        assert!(found.node > 0);
    }

    #[test]
    fn what_the_head_hides_is_not_taken_hold_of() {
        let strands = hanging(&[[-12.0, 0.0]]);
        let view = view();
        let pixel = view.project(strands.strand(0)[5]).truncate();
        assert_eq!(nearest(&view, strands.points(), &strands, usize::MAX, &HEAD, pixel, 8.0), None);
    }

    #[test]
    fn a_lock_is_what_has_a_node_within_its_radius() {
        let strands = hanging(&[[12.0, 0.0], [12.0, 1.0], [12.0, -2.5], [12.0, 6.0]]);
        let picked = Picked { strand: 1, node: 5, place: strands.strand(1)[5], apart: 0.0 };
        let found = lock(strands.points(), &strands, usize::MAX, &picked, 2.0);
        assert_eq!(found, [(1, 5), (0, 5)]);
        assert_eq!(lock(strands.points(), &strands, usize::MAX, &picked, 0.0), [(1, 5)]);
        assert_eq!(lock(strands.points(), &strands, usize::MAX, &picked, 100.0).len(), 4);
    }
}
