//! The view under a hand, without a graphics card.

use std::sync::Arc;
use std::time::{Duration, Instant};

use eframe::egui::{Event, Key, Modifiers, PointerButton, Pos2, RawInput, Rect, pos2, vec2};
use glam::Vec3;
use nabiki::dynamics::Form;
use nabiki_scene::{Scene, Shown as Strands};

use super::*;
use crate::document::Phase;
use crate::tools::Tools;

/// A window with the view alone.
struct Window {
    context: egui::Context,
    view: View,
    take: Take,
    frame: u32,
    selected: Option<usize>,
    navigation: Navigation,
    time: f64,
    modifiers: Modifiers,
    rect: Rect,
}

impl Window {
    fn new() -> Self {
        let text = "[hair]\nstrands = 60\n[motion]\nframes = 20\nform = \"free\"\n[[force]]\nthrough = 20\nvector = [-60, 0, 0]\n";
        let take = moved(Scene::parse(text, "a.toml".as_ref(), &[]).unwrap());
        let (context, view) = (egui::Context::default(), View::new(None));
        let navigation = Navigation::Blender;
        let mut window = Self {
            context,
            view,
            take,
            frame: 15,
            selected: None,
            navigation,
            time: 0.0,
            modifiers: Modifiers::NONE,
            rect: Rect::NOTHING,
        };
        window.run(&[]);
        window
    }

    fn run(&mut self, events: &[Event]) -> Vec<Touch> {
        self.time += 0.05;
        let input = RawInput {
            screen_rect: Some(Rect::from_min_size(Pos2::ZERO, vec2(800.0, 600.0))),
            time: Some(self.time),
            events: [&[Event::ModifiersChanged(self.modifiers)], events].concat(),
            ..RawInput::default()
        };
        let shown =
            Shown { selected_interval: self.selected, navigation: self.navigation, ..shown(&self.take, self.frame) };
        let mut touches = Vec::new();
        let (view, rect) = (&mut self.view, &mut self.rect);
        let _ = self.context.run_ui(input, |ui| {
            *rect = ui.max_rect();
            touches = view.ui(ui, &shown);
        });
        touches
    }

    fn seen(&self) -> Seen {
        let size = [self.rect.width() as u32, self.rect.height() as u32];
        self.view.orbit.unwrap().view(size, self.take.pose(self.frame).position_cm)
    }

    fn on_screen(&self, place: Vec3) -> Pos2 {
        let p = self.seen().project(place);
        self.rect.min + vec2(p.x, p.y)
    }

    /// A node that a hand can take hold of, where it is on the screen.
    fn some_hair(&mut self) -> Pos2 {
        for strand in 0..self.take.strands().len() {
            let tip = self.take.strands().range(strand).end - 2;
            let at = self.on_screen(self.take.points(self.frame)[tip]);
            let pixel = glam::Vec2::new(at.x - self.rect.min.x, at.y - self.rect.min.y);
            let shown = self.take.points(self.frame);
            let skins = pick::Skins::of(&self.take, self.frame);
            if pick::nearest(&self.seen(), shown, self.take.strands(), usize::MAX, &skins, pixel, 2.0).is_some() {
                return at;
            }
        }
        panic!("no hair in sight");
    }

    /// What a session makes of what a hand does: the scene as it is pulled, in motion.
    fn make_true(&mut self, touches: Vec<Touch>) {
        for touch in touches {
            if let Touch::Pulled { answer, .. } = touch {
                let mut scene = self.take.built.scene.clone();
                scene.accept(&answer, &self.take.built);
                self.take = moved(scene);
            }
        }
    }

    /// Until the search is over that goes on after a hand has let go. However slow the machine is, its clock stands still.
    fn let_it_look(&mut self) {
        // Only the picture after that in which the hand let go hears of more.
        let touches = self.run(&[]);
        self.make_true(touches);
        let clock = Instant::now();
        while self.view.let_go.as_ref().is_some_and(LetGo::is_looking) {
            assert!(clock.elapsed() < Duration::from_secs(120), "it never ends");
            std::thread::sleep(Duration::from_millis(5));
            self.time -= 0.05;
            let touches = self.run(&[]);
            self.make_true(touches);
        }
    }
}

/// A scene in motion.
fn moved(scene: Scene) -> Take {
    let built = Arc::new(scene.build(Strands::All).unwrap());
    let mut timeline = built.timeline().unwrap();
    let film = timeline.play();
    let film: Vec<Vec3> = (0..=20).flat_map(|n| film.points(n).to_vec()).collect();
    Take { built, film: film.into(), number: 1 }
}

fn shown(take: &Take, frame: u32) -> Shown<'_> {
    let scene = &take.built.scene;
    Shown {
        scene: 1,
        take,
        picture: &scene.picture,
        force: take.built.forces.intervals(),
        frame,
        playing: false,
        selected_interval: None,
        hands_off: false,
        ghosts: true,
        wind: true,
        final_picture: true,
        strands_in_final: 60,
        navigation: Navigation::Blender,
        tools: &PULLING,
        regions: &scene.free.regions,
        aims: &scene.aims,
        is_free: true,
    }
}

static PULLING: std::sync::LazyLock<Tools> = std::sync::LazyLock::new(Tools::default);

fn press(at: Pos2, pressed: bool) -> Vec<Event> {
    button(at, PointerButton::Primary, pressed, Modifiers::NONE)
}

fn button(pos: Pos2, button: PointerButton, pressed: bool, modifiers: Modifiers) -> Vec<Event> {
    vec![Event::PointerMoved(pos), Event::PointerButton { pos, button, pressed, modifiers }]
}

fn key(key: Key, pressed: bool) -> Event {
    Event::Key { key, physical_key: None, pressed, repeat: false, modifiers: Modifiers::NONE }
}

#[test]
fn a_tip_that_is_dragged_sets_the_vector_and_the_tip_is_under_the_pointer() {
    let mut window = Window::new();
    window.selected = Some(0);
    let head = window.take.built.model.head.ellipsoid;
    let vector = Vec3::new(-60.0, 0.0, 0.0);
    let tip = window.on_screen(handle::Arrow::new(&head, &nabiki::Pose::STILL, vector).tip);
    window.run(&[Event::PointerMoved(tip)]);
    assert!(window.run(&press(tip, true)).is_empty());
    let to = tip + vec2(-40.0, 25.0);
    let touches = window.run(&[Event::PointerMoved(to)]);
    let [Touch::SetVector { interval: 0, vector, done: false }] = touches[..] else { panic!("{touches:?}") };
    // A tenth of a force, to which it is rounded, is 0.004 cm: a tenth of a pixel.
    let now = window.on_screen(handle::Arrow::new(&head, &nabiki::Pose::STILL, vector).tip);
    assert!(now.distance(to) < 0.3, "{now} {to}");
    let touches = window.run(&press(to, false));
    assert_eq!(touches, [Touch::SetVector { interval: 0, vector, done: true }]);
    assert!(window.run(&[Event::PointerMoved(tip)]).is_empty());
}

#[test]
fn escape_gives_a_drag_up_and_a_press_without_a_drag_sets_nothing() {
    let mut window = Window::new();
    window.selected = Some(0);
    let head = window.take.built.model.head.ellipsoid;
    let tip = window.on_screen(handle::Arrow::new(&head, &nabiki::Pose::STILL, Vec3::new(-60.0, 0.0, 0.0)).tip);
    window.run(&press(tip, true));
    window.run(&[Event::PointerMoved(tip + vec2(30.0, 0.0))]);
    assert_eq!(window.run(&[key(Key::Escape, true)]), [Touch::Undone]);
    assert!(window.run(&press(tip, false)).is_empty());
    window.run(&press(tip, true));
    let touches = window.run(&press(tip, false));
    assert!(touches.iter().all(|touch| !matches!(touch, Touch::SetVector { done: true, .. })), "{touches:?}");
}

#[test]
fn the_camera_moves_by_both_presets_and_by_a_drag_on_the_ground() {
    let middle = PointerButton::Middle;
    for (navigation, which, modifiers) in [
        (Navigation::Blender, middle, Modifiers::NONE),
        (Navigation::Maya, PointerButton::Primary, Modifiers::ALT),
        (Navigation::Blender, PointerButton::Primary, Modifiers::NONE),
    ] {
        let mut window = Window { navigation, modifiers, ..Window::new() };
        let corner = pos2(30.0, 570.0);
        let before = window.view.camera();
        window.run(&[Event::PointerMoved(corner)]);
        window.run(&button(corner, which, true, modifiers));
        let touches = window.run(&[Event::PointerMoved(corner + vec2(60.0, 20.0))]);
        assert_eq!(touches, [Touch::CameraMoved], "{navigation:?}");
        assert_ne!(window.view.camera().azimuth, before.azimuth);
        window.run(&button(corner, which, false, modifiers));
        assert!(window.run(&[Event::PointerMoved(corner)]).is_empty());
        window.view.reset_camera();
        window.run(&[]);
        assert_eq!(window.view.camera().azimuth, before.azimuth);
    }
}

#[test]
fn framing_shows_all_of_the_hair() {
    let mut window = Window::new();
    window.run(&[Event::PointerMoved(pos2(400.0, 300.0))]);
    window.run(&[Event::Zoom(0.3)]);
    (0..20).for_each(|_| drop(window.run(&[])));
    window.view.frame_hair();
    window.run(&[]);
    for &p in window.take.points(15) {
        assert!(window.rect.contains(window.on_screen(p)));
    }
    let widest = window.take.points(15).iter().map(|&p| window.on_screen(p).distance(window.rect.center()));
    assert!(widest.fold(0.0, f32::max) > 150.0);
}

#[test]
fn a_pull_makes_wind_that_release_accepts_and_escape_undoes() {
    let mut window = Window::new();
    for ends in [true, false] {
        let at = window.some_hair();
        window.run(&[Event::PointerMoved(at)]);
        window.run(&press(at, true));
        assert!(matches!(window.view.hand, Hand::Hair(_)), "{:?}", window.view.hand);
        let to = at + vec2(-30.0, -20.0);
        let mut touches = window.run(&[Event::PointerMoved(to)]);
        let clock = Instant::now();
        while touches.is_empty() {
            assert!(clock.elapsed() < Duration::from_secs(60), "the wind never followed");
            std::thread::sleep(Duration::from_millis(5));
            touches = window.run(&[]);
        }
        let Some(Touch::Pulled { answer, interval, phase: Phase::Dragging, .. }) = touches.pop() else {
            panic!("{touches:?}")
        };
        assert_ne!(answer.keyframes, window.take.built.forces.intervals());
        let felt = window.view.marks().felt.expect("the timeline shows the frames that follow");
        assert!(felt.contains(&15) && answer.keyframes[interval].through >= 15, "{felt:?} {answer:?}");
        let touches = if ends { window.run(&press(to, false)) } else { window.run(&[key(Key::Escape, true)]) };
        let is_right = match &touches[..] {
            [.., Touch::Pulled { phase, .. }] => ends && *phase == Phase::Done,
            [.., Touch::Undone] => !ends,
            _ => false,
        };
        assert!(is_right, "{touches:?}");
        window.run(&press(to, false));
    }
}

#[test]
fn what_was_let_go_says_how_far_it_falls_short_while_nothing_else_is_done() {
    let mut window = Window::new();
    let at = window.some_hair();
    window.run(&[Event::PointerMoved(at)]);
    window.run(&press(at, true));
    // No wind of twenty frames brings hair of some 20 cm so far.
    let to = at + vec2(-150.0, -390.0);
    let clock = Instant::now();
    while window.run(&[Event::PointerMoved(to)]).is_empty() {
        assert!(clock.elapsed() < Duration::from_secs(60), "the wind never followed");
        std::thread::sleep(Duration::from_millis(5));
    }
    let Hand::Hair(held) = &window.view.hand else { panic!("{:?}", window.view.hand) };
    let (goal, lock) = (held.goal(), held.lock.clone());
    let touches = window.run(&press(to, false));
    let still = window.take.clone();
    assert!(matches!(touches.last(), Some(Touch::Pulled { phase: Phase::Done, .. })), "{touches:?}");
    assert_eq!(window.view.fell_short(&shown(&window.take, 15)), None, "that motion is not there yet");
    window.make_true(touches);
    window.let_it_look();
    let left = goal.distance(lock.middle(window.take.points(15), window.take.strands()));
    assert!(left > 1.0, "{left}");
    let said = window.view.fell_short(&shown(&window.take, 15));
    let words = said.clone().unwrap_or_default();
    assert!(words.starts_with(&format!("{left:.1} cm short")), "{words}");
    assert_eq!(window.view.fell_short(&shown(&window.take, 15)), said);
    assert_eq!(window.view.fell_short(&shown(&window.take, 14)), None);
    assert_eq!(window.view.fell_short(&Shown { playing: true, ..shown(&window.take, 15) }), None);
    assert_eq!(window.view.fell_short(&shown(&still, 15)), None, "undone, nothing was asked");
    window.run(&[Event::PointerMoved(pos2(30.0, 570.0))]);
    assert_eq!(window.view.fell_short(&shown(&window.take, 15)), said);
    let felt = window.view.marks().felt.expect("the timeline still shows the frames that feel it");
    assert!(felt.contains(&15), "{felt:?}");
    window.run(&press(pos2(30.0, 570.0), true));
    assert_eq!(window.view.fell_short(&shown(&window.take, 15)), None);
}

#[test]
fn a_pull_that_is_let_go_at_once_comes_as_near_as_one_that_was_held() {
    let mut window = Window::new();
    let at = window.some_hair();
    window.run(&[Event::PointerMoved(at)]);
    window.run(&press(at, true));
    let to = at + vec2(-30.0, -20.0);
    let clock = Instant::now();
    let mut touches = window.run(&[Event::PointerMoved(to)]);
    while touches.is_empty() {
        assert!(clock.elapsed() < Duration::from_secs(60), "the wind never followed");
        std::thread::sleep(Duration::from_millis(5));
        touches = window.run(&[]);
    }
    window.make_true(touches);
    let Hand::Hair(held) = &window.view.hand else { panic!("{:?}", window.view.hand) };
    let (goal, lock) = (held.goal(), held.lock.clone());
    let left = |window: &Window| goal.distance(lock.middle(window.take.points(15), window.take.strands()));
    let touches = window.run(&press(to, false));
    window.make_true(touches);
    let at_once = left(&window);
    window.let_it_look();
    assert!(left(&window) < at_once.max(0.3), "{} after {at_once}", left(&window));
    assert!(left(&window) < 0.3, "{}", left(&window));
}

#[test]
fn what_would_help_is_a_button_that_looks_again_and_is_a_step_of_its_own() {
    for (name, stiffness) in [("Add an interval here", false), ("Let stiffness change too", true)] {
        let mut window = Window::new();
        let at = window.some_hair();
        window.run(&[Event::PointerMoved(at)]);
        window.run(&press(at, true));
        let to = at + vec2(-30.0, -20.0);
        let clock = Instant::now();
        while window.run(&[Event::PointerMoved(to)]).is_empty() {
            assert!(clock.elapsed() < Duration::from_secs(60), "the wind never followed");
            std::thread::sleep(Duration::from_millis(5));
        }
        let touches = window.run(&press(to, false));
        window.make_true(touches);
        window.let_it_look();
        // As if it had not arrived.
        let let_go = window.view.let_go.as_mut().expect("it was let go");
        let_go.falls_short(Vec3::new(0.5, 0.5, 0.0));
        window.run(&[]);
        window.run(&[]);
        let place = window.view.buttons[usize::from(stiffness)].center();
        window.run(&[Event::PointerMoved(place)]);
        window.run(&press(place, true));
        assert!(window.view.let_go.is_some(), "the button is pressed, not the hair behind it");
        let mut touches = window.run(&press(place, false));
        while touches.is_empty() {
            assert!(clock.elapsed() < Duration::from_secs(120), "nothing was found");
            std::thread::sleep(Duration::from_millis(5));
            window.time -= 0.05;
            touches = window.run(&[]);
        }
        let Some(Touch::Pulled { name: step, answer, phase: Phase::Done, .. }) = touches.first() else {
            panic!("{touches:?}")
        };
        assert_eq!(*step, name);
        let Form::Free(free) = &window.take.built.dynamics.form else { panic!("the free form") };
        assert_eq!(answer.stiffness.as_ref() != Some(&free.form.stiffness), stiffness);
    }
}

#[test]
fn a_click_with_n_held_drives_a_nail_and_another_pulls_it_out() {
    let mut window = Window::new();
    let at = window.some_hair();
    window.run(&[Event::PointerMoved(at), key(Key::N, true)]);
    window.run(&press(at, true));
    window.run(&press(at, false));
    assert_eq!(window.view.nails.len(), 1);
    assert_eq!(window.view.nails[0].frame, 15);
    window.run(&press(at, true));
    window.run(&press(at, false));
    assert!(window.view.nails.is_empty());
    window.frame = 0;
    let at = window.some_hair();
    window.run(&[Event::PointerMoved(at)]);
    let touches = window.run(&press(at, true));
    assert!(matches!(&touches[..], [Touch::Refused(_)]), "{touches:?}");
    window.run(&press(at, false));
    window.frame = 15;
    let touches = window.run(&press(at, true));
    assert!(matches!(&touches[..], [Touch::Heard]), "{touches:?}");
}

/// A scene whose head turns.
fn turning(picture: &str) -> Take {
    let turn = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/motion/turn.csv");
    let text = format!(
        "[hair]\nstrands = 20\n[motion]\nframes = 20\nform = \"free\"\n[[force]]\nthrough = 20\nvector = [-60, 0, 0]\n\
         [head.motion]\nfile = '{turn}'\nup = \"+y\"\nfacing = \"+x\"\n{picture}"
    );
    moved(Scene::parse(&text, "a.toml".as_ref(), &[]).unwrap())
}

#[test]
fn paths_lead_through_where_the_tips_are_in_the_world_and_tell_what_was_from_what_comes() {
    let take = turning("");
    let now = 8;
    let lines = onion::paths(&take, now);
    let world = |frame: u32, place: Vec3| take.pose(frame).world_from_head().transform_point3(place);
    let tip = |frame: u32| world(frame, take.points(frame)[take.strands().range(0).end - 1]);
    let mut frames = Vec::new();
    for frame in 0..20 {
        let at = lines.iter().find(|line| world(now, Vec3::from(line.a)).distance(tip(frame)) < 1e-3);
        let Some(line) = at else { continue };
        assert!(world(now, Vec3::from(line.b)).distance(tip(frame + 1)) < 1e-3, "frame {frame}");
        assert_eq!(line.a_colour[0] > line.a_colour[2], frame < now, "what was is red, what comes blue");
        assert!(frame < now || line.a_colour[3] > line.b_colour[3], "it fades away from now");
        frames.push(frame);
    }
    assert!(frames.contains(&(now - 3)) && frames.contains(&(now + 8)) && !frames.contains(&20), "{frames:?}");
}

#[test]
fn a_camera_that_glides_does_so_until_a_hand_moves_it_and_the_wheel_up_is_nearer() {
    let mut window = Window::new();
    window.take = turning("[picture.camera]\nazimuth = 60\n[picture.camera.to]\nazimuth = 100\n");
    let mut azimuth = |frame: u32, events: &[Event]| {
        window.frame = frame;
        window.run(events);
        window.view.camera().azimuth
    };
    assert!(azimuth(0, &[]) < azimuth(10, &[]) && azimuth(10, &[]) < azimuth(20, &[]));
    assert_eq!((azimuth(0, &[]), azimuth(20, &[])), (60.0, 100.0));
    let before = window.view.camera().distance.unwrap();
    window.run(&[Event::PointerMoved(pos2(400.0, 300.0))]);
    let wheel = Event::MouseWheel {
        unit: egui::MouseWheelUnit::Point,
        delta: vec2(0.0, 60.0),
        phase: egui::TouchPhase::Move,
        modifiers: Modifiers::NONE,
        source: egui::MouseWheelSource::Wheel,
    };
    window.run(&[wheel]);
    (0..20).for_each(|_| drop(window.run(&[])));
    assert!(window.view.camera().distance.unwrap() < before);
    window.frame = 5;
    window.run(&[]);
    assert_eq!(window.view.camera().azimuth, 100.0, "it is the hand's now");
}

#[test]
fn a_nail_of_another_frame_stays_where_one_is_taken_out() {
    let mut window = Window::new();
    window.run(&[key(Key::N, true)]);
    for (frame, nails) in [(15, 1), (16, 2), (16, 1)] {
        window.frame = frame;
        window.run(&[]);
        let lock = Lock { frame, nodes: vec![(3, 5), (4, 5)] };
        window.view.nail(lock);
        assert_eq!(window.view.nails.len(), nails, "frame {frame}");
    }
    assert_eq!(window.view.nails[0].frame, 15);
}

/// The tip of the arrow that is drawn.
fn drawn_tip(window: &Window) -> Option<Pos2> {
    let shown = Shown { selected_interval: window.selected, ..shown(&window.take, window.frame) };
    let arrow = window.view.arrow(&shown, 1.0, &window.seen());
    arrow.map(|(_, arrow)| window.on_screen(arrow.tip))
}

#[test]
fn the_tip_of_an_arrow_stays_under_the_hand_that_lets_go_wherever_that_is() {
    // As long as the view is wide, and short: drawn anew the one becomes longer, the other shorter.
    for force in [-60.0, -700.0] {
        let mut window = Window::new();
        let mut scene = window.take.built.scene.clone();
        scene.field.force[0].vector = Vec3::new(force, 0.0, 0.0);
        window.take = moved(scene);
        window.selected = Some(0);
        window.run(&[]);
        let tip = drawn_tip(&window).unwrap();
        window.run(&[Event::PointerMoved(tip)]);
        window.run(&press(tip, true));
        window.run(&[Event::PointerMoved(tip + vec2(30.0, 20.0))]);
        // Gone on and let go between two pictures, and gone on again.
        let to = tip + vec2(150.0, 60.0);
        let mut events = press(to, false);
        events.push(Event::PointerMoved(to + vec2(50.0, 0.0)));
        let touches = window.run(&events);
        let Some(Touch::SetVector { vector, done: true, .. }) = touches.last() else { panic!("{touches:?}") };
        let mut scene = window.take.built.scene.clone();
        scene.field.force[0].vector = *vector;
        window.take = moved(scene);
        window.run(&[]);
        let now = drawn_tip(&window).unwrap();
        assert!(now.distance(to) < 1.0, "{force}: let go at {to}, the tip is at {now}");
        // From another side it is drawn as any.
        window.view.frame_hair();
        window.run(&[]);
        assert!(window.view.left_tip.as_ref().is_some_and(|left| {
            let shown = Shown { selected_interval: window.selected, ..shown(&window.take, window.frame) };
            left.arrow(&shown, &window.seen()).is_none()
        }));
    }
}

#[test]
fn while_hair_plays_no_arrow_lies_over_it_or_is_taken_hold_of() {
    let window = Window::new();
    let playing = Shown { selected_interval: Some(0), playing: true, ..shown(&window.take, 15) };
    assert!(window.view.arrow(&playing, 1.0, &window.seen()).is_none());
    let still = Shown { playing: false, ..playing };
    assert!(window.view.arrow(&still, 1.0, &window.seen()).is_some());
    assert!(screen::shows_wind(&still) && !screen::shows_wind(&playing));
}

#[test]
fn what_a_hand_has_left_in_the_view_goes_with_the_scene() {
    let mut window = Window::new();
    let at = window.some_hair();
    window.run(&[key(Key::N, true)]);
    window.run(&press(at, true));
    window.run(&press(at, false));
    assert_eq!(window.view.marks().nails, [15]);
    let before = window.view.camera();
    window.view.frame_hair();
    window.run(&[]);
    assert_ne!(window.view.camera(), before);
    let context = window.context.clone();
    let other = Shown { scene: 2, ..shown(&window.take, 15) };
    let view = &mut window.view;
    let _ = context.run_ui(RawInput::default(), |ui| drop(view.ui(ui, &other)));
    assert!(view.marks().nails.is_empty());
    assert_eq!(view.camera().azimuth, before.azimuth);
    assert!(!view.is_free);
}
