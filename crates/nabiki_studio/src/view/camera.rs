//! The camera as a hand moves it: on an orbit about a target, as a scene's own is.

use glam::{Vec2, Vec3};
use nabiki_render::settings::{Camera, Projection};
use nabiki_render::{Bounds, View};

use super::Navigation;

/// Degrees that the camera turns for each logical pixel of the hand's way.
const DEGREES_PER_PIXEL: f32 = 0.35;
/// Nearest and farthest that it goes (cm), and heights of an orthographic view.
const REACH_CM: [f32; 2] = [3.0, 2000.0];

/// What moving the pointer does to the camera.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Gesture {
    /// Goes round the target.
    Orbit,
    /// Moves what is seen with the pointer.
    Pan,
    /// Nearer and farther.
    Zoom,
}

/// Buttons and keys that are held.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Held {
    /// The left button.
    pub left: bool,
    /// The middle button.
    pub middle: bool,
    /// The right button.
    pub right: bool,
    /// Alt.
    pub alt: bool,
    /// Shift.
    pub shift: bool,
    /// Ctrl, or Cmd.
    pub ctrl: bool,
}

impl Navigation {
    /// What it has hands do, in words.
    pub const fn hands(self) -> [(&'static str, &'static str); 3] {
        match self {
            Self::Blender => {
                [("Middle, or Alt+left", "Turns."), ("The same with Shift", "Pans."), ("The same with Ctrl", "Zooms.")]
            }
            Self::Maya => [("Alt+left", "Turns."), ("Alt+middle", "Pans."), ("Alt+right", "Zooms.")],
        }
    }

    /// What a drag with this held does, if it is the camera's.
    pub fn gesture(self, held: Held) -> Option<Gesture> {
        match self {
            Self::Blender => match held {
                Held { middle: true, shift: true, .. } => Some(Gesture::Pan),
                Held { middle: true, ctrl: true, .. } => Some(Gesture::Zoom),
                Held { middle: true, .. } => Some(Gesture::Orbit),
                // For hands without a middle button, as Blender offers.
                Held { left: true, alt: true, shift: true, .. } => Some(Gesture::Pan),
                Held { left: true, alt: true, ctrl: true, .. } => Some(Gesture::Zoom),
                Held { left: true, alt: true, .. } => Some(Gesture::Orbit),
                _ => None,
            },
            Self::Maya => match held {
                Held { alt: true, left: true, .. } => Some(Gesture::Orbit),
                Held { alt: true, middle: true, .. } => Some(Gesture::Pan),
                Held { alt: true, right: true, .. } => Some(Gesture::Zoom),
                _ => None,
            },
        }
    }
}

/// A camera whose every setting is given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orbit {
    camera: Camera,
}

impl Orbit {
    /// A camera as it is at one moment; what it leaves open is chosen for a picture of `size` that holds `bounds` (from the
    /// head's origin, along the world's axes).
    pub fn new(camera: &Camera, size: [u32; 2], bounds: &Bounds) -> Self {
        let view = View::new(camera, size, bounds);
        let middle = (bounds.low + bounds.high) / 2.0;
        let target = camera.target.unwrap_or(if bounds.is_empty() { Vec3::ZERO } else { middle });
        let distance = (target - view.eye).dot(view.forward);
        let height = match camera.projection {
            Projection::Orthographic => Some(size[1] as f32 / view.scale),
            Projection::Perspective => camera.height,
        };
        Self { camera: Camera { target: Some(target), distance: Some(distance), height, to: None, ..*camera } }
    }

    /// As `[picture.camera]` has it.
    pub fn settings(&self) -> Camera {
        self.camera
    }

    /// What it sees of a head whose origin is at `head` (world, cm), in a picture of `size` pixels.
    pub fn view(&self, size: [u32; 2], head: Vec3) -> View {
        let view = View::new(&self.camera, size.map(|side| side.max(1)), &Bounds::default());
        View { eye: view.eye + head, ..view }
    }

    /// Does a gesture: the pointer went `way` (logical pixels, right and down) in a view `height` logical pixels high.
    pub fn drag(&mut self, gesture: Gesture, way: Vec2, height: f32) {
        match gesture {
            Gesture::Orbit => self.orbit(way),
            Gesture::Pan => self.pan(way, height),
            Gesture::Zoom => self.zoom((way.y - way.x) * 0.006),
        }
    }

    /// Goes round: what is before the target follows the pointer.
    fn orbit(&mut self, way: Vec2) {
        let azimuth = self.camera.azimuth + DEGREES_PER_PIXEL * way.x;
        self.camera.azimuth = azimuth.rem_euclid(360.0);
        self.camera.elevation = (self.camera.elevation + DEGREES_PER_PIXEL * way.y).clamp(-89.0, 89.0);
    }

    /// Moves the target so that what lies at its depth stays under the pointer.
    fn pan(&mut self, way: Vec2, height: f32) {
        let view = self.view([1, 1], Vec3::ZERO);
        // Logical pixels, for a view of that height.
        let per_cm = view.pixels_per_cm(self.distance()) * height;
        if let Some(target) = &mut self.camera.target {
            *target += (view.up * way.y - view.right * way.x) / per_cm;
        }
    }

    /// Goes nearer (below 0) or farther by a factor of e^`amount`.
    pub fn zoom(&mut self, amount: f32) {
        let [near, far] = REACH_CM;
        let scaled = |length: f32| (length * amount.exp()).clamp(near, far);
        self.camera.height = self.camera.height.map(scaled);
        if self.camera.projection == Projection::Perspective {
            self.camera.distance = self.camera.distance.map(scaled);
        }
    }

    /// Frames a box, seen from where the camera is now.
    pub fn frame(&mut self, bounds: &Bounds, size: [u32; 2]) {
        let open = Camera { target: None, distance: None, height: None, ..self.camera };
        *self = Self::new(&open, size, bounds);
    }

    /// From the eye to the target (cm).
    fn distance(&self) -> f32 {
        self.camera.distance.unwrap_or(1.0)
    }
}

/// The place that a pixel shows in the plane that faces the camera and holds `through`.
pub fn place_in_plane(view: &View, pixel: Vec2, through: Vec3) -> Vec3 {
    let depth = (through - view.eye).dot(view.forward);
    let per_cm = view.pixels_per_cm(depth);
    let middle = Vec2::new(view.size[0] as f32, view.size[1] as f32) / 2.0;
    let across = (pixel - middle) / per_cm;
    view.eye + view.forward * depth + view.right * across.x - view.up * across.y
}

#[cfg(test)]
mod tests {
    use super::*;

    fn somewhere(projection: Projection) -> Camera {
        Camera {
            projection,
            azimuth: 60.0,
            elevation: 4.0,
            target: Some(Vec3::new(-4.5, -3.0, 0.0)),
            distance: Some(86.0),
            height: (projection == Projection::Orthographic).then_some(40.0),
            ..Camera::default()
        }
    }

    #[test]
    fn a_scenes_own_camera_is_where_it_starts() {
        let bounds = Bounds { low: Vec3::new(-9.0, -20.0, -8.0), high: Vec3::new(30.0, 12.0, 11.0) };
        for projection in [Projection::Perspective, Projection::Orthographic] {
            for camera in [somewhere(projection), Camera { projection, ..Camera::default() }] {
                let size = [1280, 720];
                let (own, mine) =
                    (View::new(&camera, size, &bounds), Orbit::new(&camera, size, &bounds).view(size, Vec3::ZERO));
                for p in [bounds.low, bounds.high, Vec3::new(1.0, 2.0, 3.0)] {
                    // Roundings of coordinates up to a thousand pixels.
                    let apart = (own.project(p) - mine.project(p)).truncate().length();
                    assert!(apart < 0.01, "{apart}");
                }
            }
        }
    }

    #[test]
    fn a_pixel_and_its_place_in_a_plane_are_one() {
        for projection in [Projection::Perspective, Projection::Orthographic] {
            let view = Orbit::new(&somewhere(projection), [1280, 720], &Bounds::default()).view([1280, 720], Vec3::X);
            let through = Vec3::new(3.0, 7.0, -5.0);
            for pixel in [Vec2::new(0.0, 0.0), Vec2::new(640.0, 360.0), Vec2::new(1279.5, 3.25)] {
                let place = place_in_plane(&view, pixel, through);
                let back = view.project(place);
                assert!((back.truncate() - pixel).length() < 2e-3, "{back} {pixel}");
                assert!((back.z - view.project(through).z).abs() < 1e-4);
            }
            let same = place_in_plane(&view, view.project(through).truncate(), through);
            assert!((same - through).length() < 1e-4);
        }
    }

    #[test]
    fn panning_keeps_the_target_under_the_pointer() {
        for projection in [Projection::Perspective, Projection::Orthographic] {
            let mut orbit = Orbit::new(&somewhere(projection), [1280, 720], &Bounds::default());
            let before = orbit.settings().target.unwrap();
            let size = [1280, 720];
            let at = orbit.view(size, Vec3::ZERO).project(before).truncate();
            orbit.drag(Gesture::Pan, Vec2::new(37.0, -90.0), 720.0);
            let now = orbit.view(size, Vec3::ZERO).project(before).truncate();
            assert!((now - at - Vec2::new(37.0, -90.0)).length() < 0.01, "{at} {now}");
        }
    }

    #[test]
    fn orbits_keep_target_and_distance_and_stop_below_the_pole() {
        let mut orbit = Orbit::new(&somewhere(Projection::Perspective), [1280, 720], &Bounds::default());
        let target = orbit.settings().target.unwrap();
        for way in [Vec2::new(400.0, 13.0), Vec2::new(-90.0, 2000.0), Vec2::new(0.0, -9000.0)] {
            orbit.drag(Gesture::Orbit, way, 720.0);
            let view = orbit.view([1280, 720], Vec3::ZERO);
            assert!((view.eye.distance(target) - 86.0).abs() < 1e-3);
            assert!(orbit.settings().elevation.abs() <= 89.0);
            assert!((0.0..=360.0).contains(&orbit.settings().azimuth));
        }
    }

    #[test]
    fn what_lies_before_the_target_follows_the_pointer_that_turns() {
        let size = [1280, 720];
        for projection in [Projection::Perspective, Projection::Orthographic] {
            let start = Orbit::new(&somewhere(projection), size, &Bounds::default());
            let view = start.view(size, Vec3::ZERO);
            let place = start.settings().target.unwrap() - 8.0 * view.forward;
            // Through 0 degrees and 360, too.
            for way in [Vec2::X * 40.0, Vec2::X * -40.0, Vec2::X * -200.0, Vec2::Y * 25.0, Vec2::Y * -25.0] {
                let mut orbit = start;
                orbit.drag(Gesture::Orbit, way, 720.0);
                let gone = orbit.view(size, Vec3::ZERO).project(place).truncate() - view.project(place).truncate();
                let (along, across) = (gone.dot(way.normalize()), gone.perp_dot(way.normalize()));
                assert!(along > 0.0 && across.abs() < 0.3 * along, "{way}: {gone}");
                let turned = DEGREES_PER_PIXEL * way.x.abs();
                let now = orbit.settings().azimuth - start.settings().azimuth;
                assert!((now.abs() - turned).abs() < 1e-3 || (360.0 - now.abs() - turned).abs() < 1e-3, "{now}");
            }
        }
    }

    #[test]
    fn up_and_to_the_right_is_nearer_and_there_is_an_end_to_it_either_way() {
        let size = [1280, 720];
        for projection in [Projection::Perspective, Projection::Orthographic] {
            let start = Orbit::new(&somewhere(projection), size, &Bounds::default());
            let target = start.settings().target.unwrap();
            let large = |orbit: &Orbit| {
                let view = orbit.view(size, Vec3::ZERO);
                view.project(target + view.right).x - view.project(target).x
            };
            for (way, nearer) in [(Vec2::X, true), (-Vec2::Y, true), (-Vec2::X, false), (Vec2::Y, false)] {
                let mut orbit = start;
                orbit.drag(Gesture::Zoom, 20.0 * way, 720.0);
                assert_eq!(large(&orbit) > large(&start), nearer, "{projection:?}: {way}");
                (0..500).for_each(|_| orbit.drag(Gesture::Zoom, 20.0 * way, 720.0));
                let camera = orbit.settings();
                let reached =
                    camera.height.filter(|_| projection == Projection::Orthographic).or(camera.distance).unwrap();
                assert_eq!(reached, REACH_CM[usize::from(!nearer)]);
            }
        }
    }

    #[test]
    fn there_and_back_is_where_it_was() {
        let start = Orbit::new(&somewhere(Projection::Perspective), [1280, 720], &Bounds::default());
        let mut orbit = start;
        for gesture in [Gesture::Orbit, Gesture::Pan, Gesture::Zoom] {
            orbit.drag(gesture, Vec2::new(31.0, 17.0), 720.0);
            orbit.drag(gesture, Vec2::new(-31.0, -17.0), 720.0);
        }
        let (a, b) = (start.view([1280, 720], Vec3::ZERO).eye, orbit.view([1280, 720], Vec3::ZERO).eye);
        // Roundings of angles up to 360 degrees at 86 cm.
        assert!(a.distance(b) < 1e-3, "{a} {b}");
    }

    #[test]
    fn framing_holds_the_box() {
        let bounds = Bounds { low: Vec3::new(-9.0, -20.0, -8.0), high: Vec3::new(30.0, 12.0, 11.0) };
        for projection in [Projection::Perspective, Projection::Orthographic] {
            let mut orbit = Orbit::new(&somewhere(projection), [640, 480], &Bounds::default());
            let before = orbit.settings();
            orbit.frame(&bounds, [640, 480]);
            assert_eq!((orbit.settings().azimuth, orbit.settings().elevation), (before.azimuth, before.elevation));
            let view = orbit.view([640, 480], Vec3::ZERO);
            for p in [bounds.low, bounds.high, Vec3::new(30.0, -20.0, 11.0)] {
                let p = view.project(p);
                assert!((0.0..640.0).contains(&p.x) && (0.0..480.0).contains(&p.y), "{p}");
            }
        }
    }

    #[test]
    fn presets_tell_gestures_apart() {
        let held = Held::default();
        let (left, middle, right) =
            (Held { left: true, ..held }, Held { middle: true, ..held }, Held { right: true, ..held });
        let blender = |held| Navigation::Blender.gesture(held);
        assert_eq!(blender(middle), Some(Gesture::Orbit));
        assert_eq!(blender(Held { shift: true, ..middle }), Some(Gesture::Pan));
        assert_eq!(blender(Held { ctrl: true, ..middle }), Some(Gesture::Zoom));
        let maya = |held: Held| Navigation::Maya.gesture(Held { alt: true, ..held });
        assert_eq!([left, middle, right].map(maya), [Some(Gesture::Orbit), Some(Gesture::Pan), Some(Gesture::Zoom)]);
        for held in [left, right] {
            assert_eq!((blender(held), Navigation::Maya.gesture(held)), (None, None));
        }
        assert_eq!(Navigation::Maya.gesture(middle), None);
    }
}
