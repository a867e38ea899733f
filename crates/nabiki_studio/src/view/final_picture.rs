//! The final renderer's picture of all strands, drawn in the background while the hand rests.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};

use nabiki::Strands;
use nabiki::dynamics::{Simulation, Stepper};
use nabiki_render::{FrameToDraw, Moment, Picture, Renderer, ToneMapping, View};
use nabiki_scene::{BuiltScene, Shown};

use nabiki_view::widened;

/// Seconds without a touch before it is begun.
pub const REST: f64 = 0.4;
/// Seconds in which it fades in.
pub const FADE: f64 = 0.2;

/// What is to be drawn.
#[derive(Clone, Debug)]
pub struct Wanted {
    /// Scene, field and way of moving of the shown motion.
    pub built: Arc<BuiltScene>,
    /// The look.
    pub picture: Picture,
    /// The camera (world), with the view's size.
    pub view: View,
    /// The frame.
    pub frame: u32,
    /// Strands; all of the scene's where it has fewer.
    pub strands: usize,
}

/// A picture that is done: sRGB and alpha, four bytes a pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct Done {
    /// Width and height (px): half of the view's for the first of two.
    pub size: [u32; 2],
    /// Row after row from the top.
    pub rgba: Vec<u8>,
}

/// When to draw it, and how much of it shows: without a clock of its own.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rest {
    touched: f64,
    began: bool,
    came: Option<f64>,
}

impl Rest {
    /// Something was touched: what is shown goes at once.
    pub fn touch(&mut self, now: f64) {
        *self = Self { touched: now, began: false, came: None };
    }

    /// Whether it is time to begin; `true` once for each rest.
    pub fn begins(&mut self, now: f64) -> bool {
        let begins = !self.began && now - self.touched >= REST;
        self.began |= begins;
        begins
    }

    /// Seconds until it begins, if it has not.
    pub fn waits(&self, now: f64) -> Option<f64> {
        (!self.began).then(|| (self.touched + REST - now).max(0.0))
    }

    /// The first picture is there. Others that come after it take its place without a fade.
    pub fn came(&mut self, now: f64) {
        self.came.get_or_insert(now);
    }

    /// Whether there is a picture to be shown.
    pub fn has_come(&self) -> bool {
        self.came.is_some()
    }

    /// How much of it shows, 0..1.
    pub fn opacity(&self, now: f64) -> f32 {
        self.came.map_or(0.0, |came| ((now - came) / FADE).clamp(0.0, 1.0) as f32)
    }
}

/// A thread that draws what was asked for last.
#[derive(Debug)]
pub struct FinalPicture {
    wanted: Sender<(u64, Wanted)>,
    done: Receiver<(u64, Result<Done, String>)>,
    newest: Arc<AtomicU64>,
}

impl FinalPicture {
    /// Starts the thread; `wake` is called whenever something is done.
    ///
    /// # Errors
    /// The system's, if it gives no thread.
    pub fn new(wake: impl Fn() + Send + 'static) -> std::io::Result<Self> {
        let (wanted, orders) = channel();
        let (give, done) = channel();
        let newest = Arc::new(AtomicU64::new(0));
        let current = newest.clone();
        let draw = move || work(&orders, &give, &current, &wake);
        std::thread::Builder::new().name("picture".to_owned()).spawn(draw)?;
        Ok(Self { wanted, done, newest })
    }

    /// Asks for a picture; what was asked for before is given up.
    pub fn ask(&self, wanted: Wanted) {
        let number = self.newest.fetch_add(1, Ordering::Relaxed) + 1;
        // The thread ends with the view only.
        let _ = self.wanted.send((number, wanted));
    }

    /// Gives up what is being drawn.
    pub fn cancel(&self) {
        self.newest.fetch_add(1, Ordering::Relaxed);
    }

    /// The newest picture that is done since it was asked for last, if it is not outdated; or why there is none.
    pub fn take(&self) -> Option<Result<Done, String>> {
        let newest = self.newest.load(Ordering::Relaxed);
        self.done.try_iter().filter(|(number, _)| *number == newest).last().map(|(_, done)| done)
    }
}

fn work(
    orders: &Receiver<(u64, Wanted)>,
    give: &Sender<(u64, Result<Done, String>)>,
    newest: &AtomicU64,
    wake: &dyn Fn(),
) {
    let mut whole = None;
    while let Ok(order) = orders.recv() {
        let (number, wanted) = orders.try_iter().last().unwrap_or(order);
        let outdated = || newest.load(Ordering::Relaxed) != number;
        let sent = |done| {
            let open = give.send((number, done)).is_ok();
            wake();
            open
        };
        if outdated() {
            continue;
        }
        let drawn = Whole::moved(&mut whole, &wanted, &outdated).and_then(|moved| {
            let Some(whole) = moved else { return Ok(()) };
            for part in [2, 1] {
                if outdated() {
                    return Ok(());
                }
                sent(Ok(whole.draw(&wanted, part)?));
            }
            Ok(())
        });
        if let Err(why) = drawn
            && !sent(Err(why))
        {
            return;
        }
    }
}

/// All strands, where they were asked for last. What is the same of the next scene is not built again, nor moved.
struct Whole {
    built: BuiltScene,
    simulation: Simulation,
    /// The frame before, where the shutter is open.
    before: Option<Strands>,
}

impl Whole {
    /// All strands at the wanted frame; none if that was outdated before it was reached.
    fn moved<'a>(
        kept: &'a mut Option<Self>,
        wanted: &Wanted,
        outdated: &dyn Fn() -> bool,
    ) -> Result<Option<&'a mut Self>, String> {
        let says = |error: nabiki_scene::Error| error.to_string();
        // Of the motion that is shown first: its files may hold something else than when they were read for what is kept.
        let known = [Some(&*wanted.built), kept.as_ref().map(|whole| &whole.built)];
        let known: Vec<&BuiltScene> = known.into_iter().flatten().collect();
        let built = wanted.built.scene.clone().build_while(Shown::AtMost(wanted.strands), &known, &|_| true);
        let built = built.map_err(says)?;
        let same_way = |whole: &Self| {
            let was = &whole.built;
            Arc::ptr_eq(&was.way, &built.way)
                && Arc::ptr_eq(&was.forces, &built.forces)
                && was.dynamics == built.dynamics
                && was.strands() == built.strands()
                && was.groom.ids == built.groom.ids
                && whole.simulation.frame() <= wanted.frame
        };
        let mut whole = match kept.take().filter(same_way) {
            Some(whole) => Self { built, ..whole },
            None => Self { simulation: built.simulation().map_err(says)?, built, before: None },
        };
        while whole.simulation.frame() < wanted.frame {
            if outdated() {
                *kept = Some(whole);
                return Ok(None);
            }
            let next = whole.simulation.frame() + 1;
            whole.before =
                (next == wanted.frame && wanted.picture.shutter > 0.0).then(|| whole.simulation.strands().clone());
            whole.simulation.step_frame(&whole.built.input(next));
        }
        Ok(Some(kept.insert(whole)))
    }

    /// The picture, each side `part` times smaller.
    fn draw(&mut self, wanted: &Wanted, part: u32) -> Result<Done, String> {
        let says = |error: nabiki_render::RenderError| error.to_string();
        let strands = self.simulation.strands();
        let mut picture = wanted.picture.clone();
        let size = wanted.view.size.map(|side| (side / part).max(1));
        picture.size = size;
        picture.hair.width *= widened(self.built.groom.of_scene as f32 / strands.len().max(1) as f32);
        let view = View { size, scale: wanted.view.scale / part as f32, ..wanted.view };
        let before_it = wanted.frame.saturating_sub(1);
        let [bodies, bodies_before] = [wanted.frame, before_it].map(|frame| self.built.drawn_poses(frame));
        let moment = |frame: u32, strands, bodies| Moment { strands, pose: self.built.pose(frame), view, bodies };
        let now = moment(wanted.frame, strands, bodies.as_slice());
        let before = self.before.as_ref().filter(|before| before.len() == strands.len());
        let before = before.map(|strands| moment(before_it, strands, &bodies_before));
        let head = &self.built.model.head;
        let renderer = Renderer::new(&picture, &head.mesh).map_err(says)?.with_face(head);
        let mut renderer = renderer.with_bodies(self.built.drawn_bodies()).map_err(says)?;
        renderer.bend(self.built.bent(wanted.frame));
        let frame = renderer.draw(&FrameToDraw { now, before }).map_err(says)?;
        Ok(Done { size, rgba: ToneMapping::new(&picture).rgba8(&frame) })
    }
}

#[cfg(test)]
mod tests {
    use std::time::{Duration, Instant};

    use glam::Vec3;
    use nabiki::field::Keyframe;
    use nabiki_render::Bounds;
    use nabiki_scene::Scene;

    use super::*;
    use crate::view::camera::Orbit;

    #[test]
    fn it_begins_once_a_hand_has_rested_fades_in_and_goes_at_a_touch() {
        let mut rest = Rest::default();
        rest.touch(10.0);
        assert!(!rest.begins(10.3));
        assert!(rest.waits(10.0).is_some_and(|waits| (waits - REST).abs() < 1e-9));
        assert!(rest.begins(10.41) && !rest.begins(10.5) && rest.waits(10.5).is_none());
        assert_eq!(rest.opacity(10.5), 0.0);
        rest.came(11.0);
        assert!((rest.opacity(11.1) - 0.5).abs() < 1e-6);
        rest.came(11.15);
        assert_eq!(rest.opacity(11.0 + FADE), 1.0);
        rest.touch(12.0);
        assert_eq!(rest.opacity(12.0), 0.0);
        assert!(rest.begins(12.5));
    }

    fn wanted(frame: u32, vector: Vec3) -> Wanted {
        let text = "[hair]\nstrands = 60\n[motion]\nframes = 6\n";
        let mut scene =
            Scene::parse(&format!("{text}[[force]]\nthrough = 6\nvector = [1, 0, 0]\n"), "a.toml".as_ref(), &[])
                .unwrap();
        scene.field.force = vec![Keyframe { through: 6, vector }.into()];
        let picture = scene.picture.clone();
        let built = Arc::new(scene.build(Shown::First(20)).unwrap());
        let view = Orbit::new(&picture.camera, [64, 48], &Bounds::default()).view([64, 48], Vec3::ZERO);
        Wanted { built, picture, view, frame, strands: 60 }
    }

    /// The pictures that come, until one has the view's size.
    fn drawn(thread: &FinalPicture) -> Done {
        let clock = Instant::now();
        loop {
            if let Some(done) = thread.take() {
                let done = done.unwrap();
                if done.size == [64, 48] {
                    return done;
                }
            }
            assert!(clock.elapsed() < Duration::from_secs(60), "no picture came");
            std::thread::sleep(Duration::from_millis(5));
        }
    }

    #[test]
    fn it_is_the_renderers_picture_of_all_strands_whatever_was_drawn_before() {
        let thread = FinalPicture::new(|| {}).unwrap();
        let (calm, storm) = (Vec3::X, Vec3::new(-300.0, 50.0, 0.0));
        for (frame, vector) in [(4, calm), (5, calm), (2, calm), (5, storm)] {
            let wanted = wanted(frame, vector);
            thread.ask(wanted.clone());
            let done = drawn(&thread);
            let whole = wanted.built.scene.clone().build(Shown::All).unwrap();
            let mut timeline = whole.timeline().unwrap();
            let picture = Picture { size: [64, 48], ..wanted.picture };
            let now = Moment { strands: timeline.seek(frame), pose: whole.pose(frame), view: wanted.view, bodies: &[] };
            let frame = Renderer::new(&picture, &whole.model.head.mesh)
                .unwrap()
                .with_face(&whole.model.head)
                .draw(&FrameToDraw { now, before: None });
            assert!(done.rgba == ToneMapping::new(&picture).rgba8(&frame.unwrap()));
        }
    }

    #[test]
    fn it_has_the_bodies_and_the_files_of_the_motion_that_is_shown() {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
        let block = |half: i32| {
            let corners = (0..8).map(|i| [i & 1, i >> 1 & 1, i >> 2].map(|side| (2 * side - 1) * half));
            let corners: String = corners.map(|[x, y, z]| format!("v {x} {y} {z}\n")).collect();
            corners + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n"
        };
        let strand = |x: i32| format!("v {x} 9 0\nv {} 8 0\nv {} 6 0\nl 1 2 3\n", x + 1, x + 1);
        let body = |x: i32| {
            format!("[[body]]\nmesh = \"box.obj\"\nunit = \"cm\"\nup = \"+y\"\nfacing = \"+x\"\norigin = [{x}, 0, 0]\n")
        };
        let hair = "[hair]\nfile = \"lock.obj\"\nunit = \"cm\"\nup = \"+y\"\nfacing = \"+x\"\n";
        let thread = FinalPicture::new(|| {}).unwrap();
        let mut seen: Vec<Done> = Vec::new();
        for (x, half, bodies) in
            [(9, 3, String::new()), (9, 3, body(-14)), (9, 3, body(-18)), (12, 3, body(-18)), (12, 2, body(-18))]
        {
            write("box.obj", &block(half));
            write("lock.obj", &strand(x));
            let text = format!("{hair}[motion]\nform = \"free\"\nframes = 2\n[free]\nstiffness = 300\n{bodies}");
            let scene = Scene::parse(&text, &folder.path().join("a.toml"), &[]).unwrap();
            let built = Arc::new(scene.build(Shown::All).unwrap());
            let wanted = Wanted { built, strands: 5, ..wanted(2, Vec3::X) };
            thread.ask(wanted.clone());
            let done = drawn(&thread);
            let anew = FinalPicture::new(|| {}).unwrap();
            anew.ask(wanted);
            assert!(done == drawn(&anew), "hair at {x}, a box of {half}, {bodies}");
            assert!(!seen.contains(&done), "nothing of it is seen");
            seen.push(done);
        }
    }

    #[test]
    fn what_was_given_up_never_comes() {
        let thread = FinalPicture::new(|| {}).unwrap();
        thread.ask(wanted(6, Vec3::X));
        thread.cancel();
        let kept = wanted(1, Vec3::X);
        std::thread::sleep(Duration::from_millis(50));
        assert!(thread.take().is_none());
        thread.ask(kept);
        drawn(&thread);
    }
}
