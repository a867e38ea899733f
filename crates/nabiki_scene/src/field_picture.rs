//! The field of a scene in pictures: arrows on the contact sheet, the plot.

use glam::{Quat, Vec3};
use nabiki::dynamics::ForceSpace;
use nabiki::field::Ease;
use nabiki_render::output::field_plot::{FieldPlot, Interval, Slices};
use nabiki_render::{ForceArrow, View};

use crate::built::BuiltScene;

/// Arrows across a picture and down.
const ARROWS: [i32; 2] = [7, 5];

/// Arrows along the side of a slice, odd.
const ALONG: i32 = 13;

/// Number of frames examined to choose the one whose slices are shown.
const LOOKED_AT: u32 = 16;

/// Most corners of the path of the wind.
const CORNERS: u32 = 1000;

/// The head in the space of the forces in a frame: its centre, and the rotation from its axes to that space.
fn head(built: &BuiltScene, frame: u32) -> (Vec3, Quat) {
    let center = built.model.head.ellipsoid.center;
    match built.dynamics.motion.force_space {
        ForceSpace::World => {
            let pose = built.pose(frame);
            (pose.world_from_head().transform_point3(center), pose.rotation)
        }
        ForceSpace::Head => (center, Quat::IDENTITY),
    }
}

/// Forces in the plane across the view through the centre of the head, outside the head.
pub(crate) fn arrows(built: &BuiltScene, frame: u32, view: &View) -> Vec<ForceArrow> {
    let (center, turn) = head(built, frame);
    let ellipsoid = &built.model.head.ellipsoid;
    let step = 0.75 * ellipsoid.half_axes.element_sum() / 3.0;
    let half = ARROWS.map(|count| count / 2);
    let places = (-half[0]..=half[0]).flat_map(|i| (-half[1]..=half[1]).map(move |j| [i as f32, j as f32]));
    let places = places.map(|[i, j]| step * (i * view.right + j * view.up));
    let outside = places.filter(|&place| ellipsoid.value(ellipsoid.center + turn.inverse() * place) > 0.0);
    let arrow = |place: Vec3| {
        let point = center + place;
        ForceArrow { point, force: built.force_at(point, frame) }
    };
    outside.map(arrow).collect()
}

/// The field over time, and around the head if it varies in space.
pub(crate) fn plot(built: &BuiltScene) -> FieldPlot {
    let field = &built.scene.field;
    let intervals =
        built.forces.intervals().iter().map(|k| Interval { through: k.through, vector: k.vector }).collect();
    let straight = field.wind.ease == Ease::Stepped && field.gust.is_none() && field.body_wind.is_none();
    let path = if straight {
        Vec::new()
    } else {
        let step = built.frames().div_ceil(CORNERS) as usize;
        (1..=built.frames()).step_by(step).map(|n| built.forces.wind.uniform(n).unwrap_or_default()).collect()
    };
    FieldPlot { intervals, path, slices: slices(built) }
}

/// The slices of the frame, among some, in which the force beside the head is largest.
fn slices(built: &BuiltScene) -> Option<Slices> {
    let last = built.frames();
    let looked_at =
        (1..=LOOKED_AT.min(last)).map(|i| (u64::from(last) * u64::from(i) / u64::from(LOOKED_AT.min(last))) as u32);
    let uneven = looked_at.filter(|&n| built.forces.field.uniform(n).is_none());
    let largest =
        |slices: &Slices| slices.yz.iter().chain(&slices.zx).map(|[_, force]| force.length()).fold(0.0, f32::max);
    uneven.map(|n| slices_of(built, n)).max_by(|a, b| largest(a).total_cmp(&largest(b)))
}

fn slices_of(built: &BuiltScene, frame: u32) -> Slices {
    let (center, turn) = head(built, frame);
    let ellipsoid = built.model.head.ellipsoid;
    let reach = 2.2 * ellipsoid.half_axes.max_element();
    let half = ALONG / 2;
    let along = move |i: i32| 0.9 * reach * i as f32 / half as f32;
    let slice = |across: Vec3, upright: Vec3| -> Vec<[Vec3; 2]> {
        let places = (-half..=half).flat_map(|i| (-half..=half).map(move |j| along(i) * across + along(j) * upright));
        let outside = places.filter(|&place| ellipsoid.value(ellipsoid.center + place) > 0.0);
        outside.map(|place| [place, turn.inverse() * built.force_at(center + turn * place, frame)]).collect()
    };
    Slices { frame, reach, half_axes: ellipsoid.half_axes, yz: slice(Vec3::Z, Vec3::Y), zx: slice(Vec3::X, Vec3::Z) }
}
