//! The arrow of a force as a handle in space: where it is drawn, and which force a dragged tip means.

use glam::{Vec2, Vec3};
use nabiki::{Ellipsoid, Pose};
use nabiki_render::View;
use nabiki_render::camera::NEAR;

use super::camera::place_in_plane;

/// Centimetres that an arrow is long for a force of 1.
pub const CM_PER_FORCE: f32 = 0.04;
/// Pixels (logical) about the tip within which it is taken hold of.
pub const REACH: f32 = 14.0;
/// Space between the crown and the foot of the arrow (cm).
const ABOVE_CM: f32 = 2.0;
/// Pixels (logical) that a tip and a foot keep from the edges of the view, and the largest part of a small view that these are.
const TIP_FROM_EDGE: f32 = 24.0;
const FOOT_FROM_EDGE: f32 = 48.0;
const MOST_FROM_EDGE: f32 = 0.25;

/// An arrow (the space of the view it is seen in, cm).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arrow {
    /// Where it begins: above the crown.
    pub foot: Vec3,
    /// Where it points to.
    pub tip: Vec3,
    /// How long it is, as a part of what its force would have: less than 1 where it would leave the view.
    pub part: f32,
}

impl Arrow {
    /// The arrow of a force over a head that is at `pose` in the space of the force.
    pub fn new(head: &Ellipsoid, pose: &Pose, force: Vec3) -> Self {
        let foot = pose.world_from_head().transform_point3(head.center) + Vec3::Y * (head.half_axes.y + ABOVE_CM);
        Self { foot, tip: foot + force * CM_PER_FORCE, part: 1.0 }
    }

    /// The force it stands for.
    pub fn force(&self) -> Vec3 {
        (self.tip - self.foot) / (CM_PER_FORCE * self.part)
    }

    /// Within reach of a hand: an arrow that would leave the view of a display with so many pixels to a point begins within
    /// it, and is as much shorter as it must be.
    pub fn within(self, view: &View, scale: f32) -> Self {
        let size = Vec2::new(view.size[0] as f32, view.size[1] as f32);
        let edge = |points: f32| Vec2::splat(points * scale).min(size * MOST_FROM_EDGE);
        let seen = view.project(self.foot);
        if seen.z < NEAR {
            return self;
        }
        let kept = seen.truncate().clamp(edge(FOOT_FROM_EDGE), size - edge(FOOT_FROM_EDGE));
        let foot = if kept == seen.truncate() { self.foot } else { place_in_plane(view, kept, self.foot) };
        let way = self.tip - self.foot;
        let fits = |part: f32| {
            let tip = view.project(foot + way * part);
            let from = edge(TIP_FROM_EDGE);
            tip.z >= NEAR && tip.truncate().cmpge(from).all() && tip.truncate().cmple(size - from).all()
        };
        // A line in space is one on the screen, too: once out, it stays out.
        let mut part = [0.0, 1.0];
        if fits(1.0) {
            part[0] = 1.0;
        }
        for _ in 0..20 {
            let middle = 0.5 * (part[0] + part[1]);
            part[usize::from(!fits(middle))] = middle;
        }
        let part = if part[0] > 0.0 { part[0] } else { 1.0 };
        Self { foot, tip: foot + way * part, part: self.part * part }
    }

    /// Whether a pixel takes hold of its tip.
    pub fn is_held_by(&self, view: &View, pixel: Vec2, reach: f32) -> bool {
        let tip = view.project(self.tip);
        tip.z > 0.0 && tip.truncate().distance(pixel) <= reach
    }
}

/// A tip in a hand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Held {
    foot: Vec3,
    /// The tip as it was: its plane is the one it stays in.
    tip: Vec3,
    part: f32,
    /// The pixel taken hold of, and from there to the tip.
    pixel: Vec2,
    offset: Vec2,
}

impl Held {
    /// Takes hold of an arrow's tip at a pixel near it.
    pub fn new(arrow: &Arrow, view: &View, pixel: Vec2) -> Self {
        let offset = view.project(arrow.tip).truncate() - pixel;
        Self { foot: arrow.foot, tip: arrow.tip, part: arrow.part, pixel, offset }
    }

    /// Whether the pointer is still where it took hold: a press is no drag.
    pub fn rests(&self, pixel: Vec2) -> bool {
        self.pixel.distance(pixel) < 1.0
    }

    /// The arrow whose tip is under the pointer, in the plane that faces the camera and holds the tip as it was.
    pub fn dragged(&self, view: &View, pixel: Vec2) -> Arrow {
        Arrow { foot: self.foot, tip: place_in_plane(view, pixel + self.offset, self.tip), part: self.part }
    }

    /// The arrow of a force as long as it is while it is held.
    pub fn showing(&self, force: Vec3) -> Arrow {
        Arrow { foot: self.foot, tip: self.foot + force * (CM_PER_FORCE * self.part), part: self.part }
    }
}

/// A force as a scene file should hold it: to the tenth, far below what an eye sees.
pub fn rounded(force: Vec3) -> Vec3 {
    // Adding 0 makes -0 a 0.
    (force * 10.0).round() / 10.0 + 0.0
}

#[cfg(test)]
mod tests {
    use nabiki_render::Bounds;
    use nabiki_render::settings::Camera;

    use super::*;
    use crate::view::camera::Orbit;

    const HEAD: Ellipsoid = Ellipsoid { center: Vec3::new(-1.0, 2.0, 0.0), half_axes: Vec3::new(9.0, 11.0, 8.0) };

    #[test]
    fn a_dragged_tip_is_under_the_pointer() {
        for azimuth in [0.0, 60.0, 200.0] {
            let camera = Camera { azimuth, distance: Some(90.0), target: Some(Vec3::ZERO), ..Camera::default() };
            let view = Orbit::new(&camera, [1280, 720], &Bounds::default()).view([1280, 720], Vec3::ZERO);
            for force in [Vec3::new(-100.0, 0.0, 0.0), Vec3::ZERO, Vec3::new(30.0, -200.0, 70.0)] {
                let arrow = Arrow::new(&HEAD, &Pose::STILL, force);
                let at = view.project(arrow.tip).truncate();
                let hand = at + Vec2::new(5.0, -3.0);
                assert!(arrow.is_held_by(&view, hand, REACH));
                let held = Held::new(&arrow, &view, hand);
                assert!(held.rests(hand) && !held.rests(hand + Vec2::new(2.0, 0.0)));
                assert!((held.dragged(&view, hand).force() - force).length() < 0.01);
                for way in [Vec2::new(120.0, 40.0), Vec2::new(-300.0, 222.5)] {
                    let dragged = held.dragged(&view, hand + way);
                    let tip = view.project(dragged.tip);
                    assert!((tip.truncate() - at - way).length() < 0.01, "{tip}");
                    assert!((tip.z - view.project(arrow.tip).z).abs() < 1e-3);
                    let kept = rounded(dragged.force());
                    assert!(((kept - dragged.force()) * CM_PER_FORCE).length() < 0.006);
                }
            }
        }
    }

    #[test]
    fn an_arrow_that_would_leave_the_view_is_within_reach_and_keeps_its_force() {
        for (size, scale) in [([1280, 720], 1.0), ([1440, 900], 2.0), ([300, 200], 1.0)] {
            for target in [Vec3::ZERO, Vec3::new(0.0, -30.0, 0.0), Vec3::new(80.0, 0.0, 0.0)] {
                let camera = Camera { distance: Some(90.0), target: Some(target), ..Camera::default() };
                let view = Orbit::new(&camera, size, &Bounds::default()).view(size, Vec3::ZERO);
                for force in [Vec3::new(-2000.0, 300.0, 0.0), Vec3::Y * 900.0, Vec3::new(10.0, 30.0, -5.0)] {
                    let whole = Arrow::new(&HEAD, &Pose::STILL, force);
                    let arrow = whole.within(&view, scale);
                    assert!((arrow.force() - force).length() < 1e-3 * force.length());
                    for place in [arrow.foot, arrow.tip] {
                        let at = view.project(place);
                        let [width, height] = size.map(|side| side as f32);
                        assert!(at.x > 0.0 && at.y > 0.0 && at.x < width && at.y < height, "{size:?}: {at}");
                    }
                    // Dragged to where it is, it stays what it is, and shorter it is less.
                    let at = view.project(arrow.tip).truncate();
                    let held = Held::new(&arrow, &view, at);
                    assert!((held.dragged(&view, at).force() - force).length() < 1e-2 * force.length());
                    assert!((held.showing(force).tip - arrow.tip).length() < 1e-2);
                }
                let calm = Arrow::new(&HEAD, &Pose::STILL, Vec3::ZERO).within(&view, scale);
                assert_eq!((calm.part, calm.force()), (1.0, Vec3::ZERO));
            }
        }
    }

    #[test]
    fn the_arrow_is_its_force() {
        let force = Vec3::new(-100.0, 25.0, 3.0);
        let arrow = Arrow::new(&HEAD, &Pose { position_cm: Vec3::X, ..Pose::STILL }, force);
        assert!((arrow.force() - force).length() < 1e-3);
        assert!(HEAD.value(arrow.foot - Vec3::X) > 0.0);
        assert_eq!(
            rounded(Vec3::new(-0.01, 2.34, 100.06)).to_array().map(f32::to_bits),
            [0.0_f32, 2.3, 100.1].map(f32::to_bits)
        );
    }
}
