//! What is under the pointer: the strand that a hand means, and the lock about it.

mod surfaces;

use glam::{Affine3A, Vec2, Vec3};
use nabiki::dynamics::Form;
use nabiki::obstacle::Obstacle;
use nabiki::{Mesh, Strands};
use nabiki_render::View;
use nabiki_render::camera::NEAR;

use crate::take::Take;
pub(super) use surfaces::Triangles;

/// How much farther a strand may be for each pixel that it is nearer to the pointer, in pixels of depth.
const DEPTH_PER_PIXEL: f32 = 6.0;
/// What is seen past a skin goes no deeper into it than this (cm): hair lies on the skin, and the skin is read from samples.
const GRAZES_CM: f32 = 0.05;
/// Share by which a distance that is read far from a skin may be too large.
const SLACK: f32 = 0.05;

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

/// What hides hair in a frame: the head, and the bodies that are shown.
#[derive(Clone, Debug)]
pub struct Skins<'a> {
    /// The middle of the head (head space, cm).
    middle: Vec3,
    frame: u32,
    /// Each, and the way from head space into its own.
    each: Vec<(&'a dyn Obstacle, Affine3A)>,
    /// The surface of each body that hair may enter, to which there is no distance, and the way from its own space into head space.
    entered: Vec<(&'a Mesh, Affine3A)>,
}

impl<'a> Skins<'a> {
    /// Those of a frame.
    pub fn of(take: &'a Take, frame: u32) -> Self {
        let (built, pose) = (&take.built, take.pose(frame));
        let bodies = match &built.dynamics.form {
            Form::Free(free) => free.bodies.as_slice(),
            Form::Paper => &[],
        };
        let mut each: Vec<(&dyn Obstacle, Affine3A)> = vec![(&**built.model.head.skin(), Affine3A::IDENTITY)];
        let mut entered = Vec::new();
        for (i, mesh, in_world) in built.shown_bodies(frame) {
            let name = format!("body[{i}]");
            match bodies.iter().find(|body| body.name == name) {
                Some(body) => each.push((body.shape.obstacle(), body.head_from_body(frame, &pose).inverse())),
                None => entered.push((mesh, pose.world_from_head().inverse() * in_world.world_from_head())),
            }
        }
        Self { middle: built.model.head.ellipsoid.center, frame, each, entered }
    }

    /// How far a place (head space, cm) is out of the nearest skin that has a distance (cm), negative inside.
    pub fn clearance(&self, place: Vec3) -> f32 {
        let read = |(skin, from_head): &(&dyn Obstacle, Affine3A)| {
            skin.read(from_head.transform_point3(place), self.frame).map_or(f32::INFINITY, |reading| reading.distance)
        };
        self.each.iter().map(read).fold(f32::INFINITY, f32::min)
    }

    /// The way from a place to so far out of every skin that has a distance (head space, cm).
    pub fn way_out(&self, place: Vec3, clearance: f32) -> Vec3 {
        let mut way = Vec3::ZERO;
        for (skin, from_head) in &self.each {
            let Some(reading) = skin.read(from_head.transform_point3(place + way), self.frame) else { continue };
            let out = from_head.inverse().transform_vector3(reading.gradient).normalize_or_zero();
            way += out * (clearance - reading.distance).max(0.0);
        }
        way
    }

    /// The triangles without a distance that may hide what is seen within so many pixels of one.
    pub(super) fn before(&self, view: &View, pixel: Vec2, within: f32) -> Triangles {
        let mut found = Triangles::default();
        for (mesh, head_from_body) in &self.entered {
            found.add(mesh, *head_from_body, view, pixel, within);
        }
        found
    }

    /// Whether one of them, or of the triangles `before` it, lies between a place (head space, cm) and the eye.
    pub(super) fn hide(&self, view: &View, before: &Triangles, place: Vec3) -> bool {
        let toward = view.toward_eye(place);
        let to_eye = view.project(place).z / -toward.dot(view.forward);
        self.each.iter().any(|(skin, from_head)| {
            hides(*skin, self.frame, from_head.transform_point3(place), from_head.transform_vector3(toward), to_eye)
        }) || before.hide(place, toward, to_eye, GRAZES_CM)
    }
}

/// Whether the way from a place in a unit direction, so many cm long, goes through a skin. All are in the skin's space.
fn hides(skin: &dyn Obstacle, frame: u32, place: Vec3, toward: Vec3, length: f32) -> bool {
    // Beyond its reach skin is far from hair. Rounding stays within, too.
    let [low, high] = skin.reach();
    let (a, b) = ((low + 1e-3 - place) / toward, (high - 1e-3 - place) / toward);
    let mut at = a.min(b).max_element().max(0.0);
    let end = a.max(b).min_element().min(length);
    if at >= end {
        return false;
    }
    // Hair that does not fit its head lies in it: what counts is how much deeper the way goes.
    let read = |at: f32| skin.read(place + toward * at, frame).map_or(f32::INFINITY, |reading| reading.distance);
    let least = read(at).min(0.0) - GRAZES_CM;
    while at < end {
        let left = read(at) - least;
        if left <= 0.0 {
            return true;
        }
        at += (left * (1.0 - SLACK)).max(0.2 * GRAZES_CM);
    }
    false
}

/// The node that is meant by a pixel, of the first `among` strands: of the segments within `reach` pixels of it, and not behind
/// a skin, the one nearest to pointer and eye; of its ends the nearer one. `view` and `points` are in head space.
pub fn nearest(
    view: &View,
    points: &[Vec3],
    strands: &Strands,
    among: usize,
    skins: &Skins<'_>,
    pixel: Vec2,
    reach: f32,
) -> Option<Picked> {
    let mut best: Option<(f32, Picked)> = None;
    // The place on a segment is found on the screen, where it lies a little beside the one in space.
    let before = skins.before(view, pixel, 2.0 * reach);
    let per_cm = view.pixels_per_cm(view.project(skins.middle).z.max(NEAR));
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
            if skins.hide(view, &before, pair[0].lerp(pair[1], t)) {
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

#[cfg(test)]
pub(super) mod tests {
    use std::sync::LazyLock;

    use nabiki::Head;
    use nabiki_groom::bust;
    use nabiki_render::Bounds;
    use nabiki_render::settings::Camera;

    use super::*;
    use crate::view::camera::Orbit;

    static BUST: LazyLock<Head> = LazyLock::new(bust);

    pub fn skins() -> Skins<'static> {
        Skins {
            middle: BUST.ellipsoid.center,
            frame: 0,
            each: vec![(&**BUST.skin(), Affine3A::IDENTITY)],
            entered: Vec::new(),
        }
    }

    /// Strands that hang straight down at these places of the horizontal plane.
    pub fn hanging(at: &[[f32; 2]]) -> Strands {
        let mut strands = Strands::default();
        for [x, z] in at {
            strands.push((0..10).map(|k| Vec3::new(*x, 5.0 - k as f32, *z)));
        }
        strands
    }

    /// From before the face.
    pub fn view() -> View {
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
    fn the_way_out_leads_out_of_the_skin() {
        for (place, clearance) in [(Vec3::new(8.0, 5.0, 1.0), 0.05), (Vec3::new(-9.0, 0.0, 3.0), 0.5)] {
            let out = place + skins().way_out(place, clearance);
            // The distance is read from samples, whose gradient is about of unit length.
            let found = skins().clearance(out);
            assert!((found - clearance).abs() < 0.1 * (out - place).length() + 1e-3, "{place}: {found}");
        }
        let outside = Vec3::new(15.0, 5.0, 0.0);
        assert_eq!(skins().way_out(outside, 0.05), Vec3::ZERO);
    }

    #[test]
    fn the_node_under_the_pointer_is_found_and_nothing_beyond_reach() {
        let strands = hanging(&[[12.0, 0.0], [12.0, 4.0], [12.0, -4.0]]);
        let view = view();
        for (strand, node) in [(0, 3), (1, 9), (2, 1)] {
            let pixel = view.project(strands.strand(strand)[node]).truncate();
            let found =
                nearest(&view, strands.points(), &strands, usize::MAX, &skins(), pixel + Vec2::new(2.0, 1.0), 8.0)
                    .unwrap();
            assert_eq!((found.strand, found.node), (strand, node));
            assert_eq!(found.place, strands.strand(strand)[node]);
        }
        let pixel = view.project(Vec3::new(12.0, 0.0, 2.0)).truncate();
        assert_eq!(nearest(&view, strands.points(), &strands, usize::MAX, &skins(), pixel, 8.0), None);
    }

    #[test]
    fn of_two_strands_on_one_pixel_the_front_one_is_meant_and_roots_never() {
        let strands = hanging(&[[10.0, 0.0], [14.0, 0.0]]);
        let view = view();
        let pixel = view.project(strands.strand(0)[4]).truncate();
        let found = nearest(&view, strands.points(), &strands, usize::MAX, &skins(), pixel, 8.0).unwrap();
        assert_eq!(found.strand, 1);
        let found = nearest(&view, strands.points(), &strands, 1, &skins(), pixel, 8.0).unwrap();
        assert_eq!(found.strand, 0, "what is not at hand is not taken hold of");
        let root = view.project(strands.strand(1)[0]).truncate();
        let found = nearest(&view, strands.points(), &strands, usize::MAX, &skins(), root, 8.0).unwrap();
        assert!(found.node > 0);
    }

    #[test]
    fn what_the_head_hides_is_not_taken_hold_of() {
        let strands = hanging(&[[-12.0, 0.0]]);
        let view = view();
        let pixel = view.project(strands.strand(0)[5]).truncate();
        assert_eq!(nearest(&view, strands.points(), &strands, usize::MAX, &skins(), pixel, 8.0), None);
    }

    #[test]
    fn hair_behind_chin_neck_and_shoulders_is_not_taken_hold_of() {
        let view = view();
        for (y, hidden) in [(-9.0, true), (-12.0, true), (-16.0, true), (-20.0, true), (16.0, false)] {
            let mut strands = Strands::default();
            strands.push((0..4).map(|k| Vec3::new(-20.0, y - 0.5 * k as f32, 0.0)));
            let pixel = view.project(strands.strand(0)[2]).truncate();
            let found = nearest(&view, strands.points(), &strands, usize::MAX, &skins(), pixel, 8.0);
            assert_eq!(found.is_none(), hidden, "at {y}");
        }
    }

    #[test]
    fn a_body_hides_hair_where_it_is_unless_it_is_not_shown() {
        let folder = tempfile::tempdir().unwrap();
        let corners = (0..8).map(|i| [i & 1, i >> 1 & 1, i >> 2].map(|side| 6 * side - 3));
        let corners: String = corners.map(|[x, y, z]| format!("v {x} {y} {z}\n")).collect();
        let sides = "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
        std::fs::write(folder.path().join("box.obj"), corners + sides).unwrap();
        // The origin of its file is the point that stands at the world's.
        let text = "[hair]\nstrands = 1\n[motion]\nform = \"free\"\nframes = 1\n\
                    [[body]]\nmesh = \"box.obj\"\nunit = \"cm\"\nup = \"+y\"\nfacing = \"+x\"\norigin = [-30, 0, 0]\n";
        for (shown, solid) in [(true, true), (false, true), (true, false), (false, false)] {
            let text = format!("{text}shown = {shown}\nsolid = {solid}\n");
            let scene = nabiki_scene::Scene::parse(&text, &folder.path().join("a.toml"), &[]).unwrap();
            let built = std::sync::Arc::new(scene.build(nabiki_scene::Shown::All).unwrap());
            let points = built.strands().points().to_vec();
            let take = Take { built, film: [points.clone(), points].concat().into(), number: 1 };
            let skins = Skins::of(&take, 1);
            let hides = |x: f32, y: f32| {
                let place = Vec3::new(x, y, 0.0);
                let before = skins.before(&view(), view().project(place).truncate(), 2.0);
                skins.hide(&view(), &before, place)
            };
            // Behind it, beside it, before it, within it, and on its front. Hair in what keeps it out does not fit it.
            let hidden = [hides(20.0, 0.0), hides(20.0, 8.0), hides(40.0, 0.0), hides(31.0, 0.0), hides(32.99, 0.0)];
            let within = shown && !solid;
            assert_eq!(hidden, [shown, false, false, within, false], "shown: {shown}, solid: {solid}");
        }
    }

    /// How far along a way the triangles of the bust are crossed (cm), in order.
    fn crossings(from: Vec3, way: Vec3) -> Vec<f32> {
        let crossed = |corners: &[u32; 3]| {
            let [a, b, c] = corners.map(|v| BUST.mesh.positions[v as usize]);
            let (ab, ac, p) = (b - a, c - a, way.cross(c - a));
            let inverse = 1.0 / ab.dot(p);
            let u = (from - a).dot(p) * inverse;
            let q = (from - a).cross(ab);
            let (v, t) = (way.dot(q) * inverse, ac.dot(q) * inverse);
            (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0).then_some(t)
        };
        let mut all: Vec<f32> = BUST.mesh.triangles.iter().filter_map(crossed).collect();
        all.sort_by(f32::total_cmp);
        all
    }

    #[test]
    fn what_is_hidden_is_what_the_mesh_lies_before() {
        let (mut seen, mut hidden) = (0, 0);
        for (azimuth, elevation) in [(0.0, 10.0), (75.0, -15.0), (200.0, 40.0)] {
            let camera =
                Camera { azimuth, elevation, distance: Some(80.0), target: Some(Vec3::ZERO), ..Camera::default() };
            let view = Orbit::new(&camera, [800, 600], &Bounds::default()).view([800, 600], Vec3::ZERO);
            let places = (0..7 * 9 * 7).map(|i| Vec3::new((i % 7) as f32, (i / 7 % 9) as f32, (i / 63) as f32));
            let places = places.map(|at| (at - Vec3::new(3.0, 5.3, 3.0)) * Vec3::new(4.7, 4.3, 4.9));
            for place in places.filter(|&place| BUST.distance(place) > 0.0) {
                let hides = skins().hide(&view, &Triangles::default(), place);
                let way = view.toward_eye(place);
                let crossed = crossings(place, way);
                let deep =
                    crossed.windows(2).any(|pair| BUST.exact_distance(place + way * 0.5 * (pair[0] + pair[1])) < -0.2);
                assert!(!deep || hides, "{place} is seen through the skin");
                assert!(!crossed.is_empty() || !hides, "{place} is hidden by nothing");
                seen += usize::from(!hides);
                hidden += usize::from(hides);
            }
        }
        assert!(seen > 200 && hidden > 100, "{seen} are seen and {hidden} hidden");
    }

    #[test]
    fn hair_that_lies_on_the_skin_is_seen_from_outside_and_not_from_behind() {
        let view = view();
        let mut looked_at = 0;
        for (i, &p) in BUST.mesh.positions.iter().enumerate().step_by(97) {
            let out = BUST.outward(p);
            let facing = out.dot(view.toward_eye(p));
            let (place, way) = (p - out * 0.05, view.toward_eye(p));
            // What only grazes the skin, as along the rim of an ear, does not count.
            let deep = facing > 0.0
                || crossings(place, way).first().is_some_and(|t| BUST.exact_distance(place + way * 0.5 * t) < -0.2);
            if deep && facing.abs() > 0.5 && crossings(p + out * 0.05, way).is_empty() == (facing > 0.0) {
                assert_eq!(skins().hide(&view, &Triangles::default(), place), facing < 0.0, "vertex {i} at {p}");
                looked_at += 1;
            }
        }
        assert!(looked_at > 300, "{looked_at}");
    }
}
