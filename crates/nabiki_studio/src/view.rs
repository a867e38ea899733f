//! The view: head and hair from any side, and what is taken hold of in space.

mod arrows;
pub mod brush;
pub mod camera;
mod comb;
pub mod final_picture;
mod hand;
pub mod handle;
mod holding;
mod let_go;
mod onion;
mod overlay;
pub mod pick;
mod screen;
mod shown;
mod sources;
mod toolbar;
mod tooling;

use eframe::egui;
use eframe::egui_wgpu::RenderState;
use nabiki_render::settings::Camera;
use nabiki_render::{Bounds, View as Seen};
use nabiki_scene::pull::Lock;

use crate::take::Take;
use crate::tools::Tool;

use camera::{Held as Buttons, Orbit};
use final_picture::{FinalPicture, Rest, Wanted};
use hand::Hand;
use holding::picked;
use let_go::LetGo;
use overlay::Overlay;
use screen::Screen;
pub use shown::{Marks, Shown, Touch};

/// Which buttons move the camera.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Navigation {
    /// Middle button orbits, with Shift pans, with Ctrl zooms; the wheel zooms.
    #[default]
    Blender,
    /// Alt with the left button orbits, with the middle pans, with the right zooms; the wheel zooms.
    Maya,
}

/// The view. It holds what a graphics card needs, the camera, and what the hand is doing.
pub struct View {
    screen: Result<Screen, String>,
    orbit: Option<Orbit>,
    /// The camera of the scene that the view began with; another one, or none, begins anew.
    scenes: Option<Camera>,
    /// Whether a hand has moved the camera away from the scene's.
    is_free: bool,
    frames_hair: bool,
    hand: Hand,
    nails: Vec<Lock>,
    /// What was let go last, and the frames that feel it.
    let_go: Option<LetGo>,
    felt: Option<std::ops::RangeInclusive<u32>>,
    /// The arrow whose tip was let go last.
    left_tip: Option<hand::LeftTip>,
    /// The scene that is shown, by its number.
    scene: u64,
    /// What brush and comb have marked.
    marked: tooling::Marked,
    /// Where buttons lie over the picture.
    buttons: Vec<egui::Rect>,
    rest: Rest,
    final_picture: Option<FinalPicture>,
    /// Why something could not be drawn, to be said.
    failed: Option<String>,
    /// Whether something was refused, and nothing else has been done since.
    refused: bool,
}

impl View {
    /// A view that draws by the window's device. Without one it says so in words, and all else works.
    pub fn new(render_state: Option<&RenderState>) -> Self {
        let screen = match render_state {
            Some(state) => Screen::new(state),
            None => Err("There is no graphics adapter, so the view stays empty. Everything else works.".to_owned()),
        };
        Self {
            screen,
            orbit: None,
            scenes: None,
            is_free: false,
            frames_hair: false,
            hand: Hand::Idle,
            nails: Vec::new(),
            let_go: None,
            felt: None,
            left_tip: None,
            scene: 0,
            marked: tooling::Marked::default(),
            buttons: Vec::new(),
            rest: Rest::default(),
            final_picture: None,
            failed: None,
            refused: false,
        }
    }

    /// The camera as `[picture.camera]` would have it.
    pub fn camera(&self) -> Camera {
        self.orbit.map(|orbit| orbit.settings()).unwrap_or_default()
    }

    /// The scene's own camera again, from the next frame of the display on.
    pub fn reset_camera(&mut self) {
        self.scenes = None;
    }

    /// The hair in the middle, as large as it fits, from the next frame of the display on.
    pub fn frame_hair(&mut self) {
        self.frames_hair = true;
    }

    /// The frames in which hair is wished to be somewhere, in order.
    pub fn marks(&self) -> Marks {
        let mut nails: Vec<u32> = self.nails.iter().map(|nail| nail.frame).collect();
        nails.sort_unstable();
        nails.dedup();
        let held = match &self.hand {
            Hand::Hair(held) => Some(held),
            _ => None,
        };
        let felt = match held {
            Some(held) => held.followed.as_ref().map(|pulled| pulled.felt.clone()),
            None => self.felt.clone(),
        };
        Marks { nails, pulled: held.map(|held| held.lock.frame), felt }
    }

    /// Whether a hand holds hair or an arrow.
    pub fn is_held(&self) -> bool {
        self.hand.is_busy()
    }

    /// How far the hair falls short of where it was pulled to, in one line, while it is as it was let go and that frame is shown.
    pub fn fell_short(&self, shown: &Shown<'_>) -> Option<String> {
        self.let_go.as_ref().filter(|_| !shown.playing).and_then(|let_go| let_go.fell_short(shown))
    }

    /// The side on which a view of so many points has more room beside head and hair, and that room (points).
    pub fn free_side(&self, shown: &Shown<'_>, size: egui::Vec2) -> (egui::Align, f32) {
        let Some(orbit) = self.orbit else { return (egui::Align::Max, size.x) };
        let (take, pose) = (shown.take, shown.take.pose(shown.frame));
        let pixels = [size.x, size.y].map(|side| side.max(1.0) as u32);
        let view = orbit.view(pixels, pose.position_cm).in_head(&pose);
        let head = &take.built.model.head.ellipsoid;
        let of_head = [-1.0, 1.0].map(|side| head.center + view.right * head.half_axes.max_element() * side);
        let tips =
            (0..take.at_hand()).filter_map(|strand| take.points(shown.frame)[take.strands().range(strand)].last());
        let across = of_head.into_iter().chain(tips.copied()).map(|place| view.project(place).x);
        let (low, high) = across.fold((size.x, 0.0_f32), |(low, high), x| (low.min(x), high.max(x)));
        let (left, right) = (low.max(0.0), (size.x - high).max(0.0));
        if left > right { (egui::Align::Min, left) } else { (egui::Align::Max, right) }
    }

    /// Draws into all the room that is left, and says what a hand did.
    pub fn ui(&mut self, ui: &mut egui::Ui, shown: &Shown<'_>) -> Vec<Touch> {
        let (rect, response) = ui.allocate_exact_size(ui.available_size(), egui::Sense::click_and_drag());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, "View of the hair"));
        let scale = ui.pixels_per_point();
        let size = (rect.size() * scale).round();
        let size = [size.x.max(1.0) as u32, size.y.max(1.0) as u32];
        let now = ui.input(|input| input.time);
        let mut touches: Vec<Touch> = self.failed.take().map(Touch::Refused).into_iter().collect();

        self.leave_other_scene(shown.scene);
        self.place_camera(shown, size);
        if self.move_camera(ui, &response, shown, rect) {
            touches.push(Touch::CameraMoved);
            self.rest.touch(now);
        }
        let Some(orbit) = self.orbit else { return touches };
        let view = orbit.view(size, shown.take.pose(shown.frame).position_cm);
        if !shown.hands_off {
            self.nails.retain(|nail| nail.fits(shown.take.strands()) && nail.frame <= shown.take.frames());
        }
        let before = touches.len();
        self.leave_other_stroke(shown);
        if shown.tool() == Tool::Pull {
            self.use_hand(ui, &response, shown, &view, rect, &mut touches);
        } else {
            touches.extend(self.use_tool(ui, response.contains_pointer(), shown, &view, rect));
        }
        self.mark(shown, &view);
        if let Some(let_go) = &mut self.let_go {
            touches.extend(let_go.settle(shown, now));
            if let_go.is_looking() {
                // It ends by itself, whatever comes.
                ui.ctx().request_repaint_after_secs(0.2);
            }
        }
        if touches.len() > before || self.hand.is_busy() || shown.playing {
            self.rest.touch(now);
        }

        self.felt = self.let_go.as_ref().and_then(|let_go| let_go.felt(shown.force));
        // Arrows would hide the hair that is looked at.
        let pulls = matches!(self.hand, Hand::Hair(_)) || self.let_go.as_ref().is_some_and(LetGo::is_looking);
        let tool = shown.tool() != Tool::Pull;
        let selected_interval = shown.selected_interval.filter(|_| !tool);
        let shown = &Shown { wind: shown.wind && !pulls && !tool, selected_interval, ..*shown };

        let painter = ui.painter_at(rect);
        let overlay = Overlay { painter: &painter, rect, scale };
        match &mut self.screen {
            Err(words) => overlay.instead(words),
            Ok(screen) => {
                if screen.show(&painter, rect, shown, &view, &self.marked, now) {
                    self.rest.touch(now);
                }
                if let Some(words) = screen.failure() {
                    self.screen = Err(words);
                } else {
                    self.refine(ui, &painter, rect, shown, &view, now);
                }
            }
        }
        let words = self.draw_over(&overlay, &response, shown, &view);
        self.offer(ui, rect, shown, words, now);
        if !shown.hands_off {
            let (place, tools) = toolbar::ui(ui, rect, shown);
            self.buttons.push(place);
            touches.extend(tools.map(|tools| Touch::Use(Box::new(tools))));
        }
        self.refused |= touches.iter().any(|touch| matches!(touch, Touch::Refused(_)));
        touches
    }

    /// What belongs to a scene goes with it: nails, what a hand holds or has let go, where a hand has put the camera, what was refused.
    fn leave_other_scene(&mut self, scene: u64) {
        if std::mem::replace(&mut self.scene, scene) == scene {
            return;
        }
        self.nails.clear();
        self.hand = Hand::Idle;
        (self.let_go, self.left_tip, self.failed, self.refused) = (None, None, None, false);
        (self.orbit, self.scenes, self.is_free, self.frames_hair) = (None, None, false, false);
    }

    /// Goes where the scene's camera is, unless a hand has moved it.
    fn place_camera(&mut self, shown: &Shown<'_>, size: [u32; 2]) {
        let scenes = shown.picture.camera;
        if self.scenes != Some(scenes) || self.orbit.is_none() {
            (self.scenes, self.is_free, self.orbit) = (Some(scenes), false, None);
        }
        let glides = scenes.to.is_some();
        if self.orbit.is_none() || (glides && !self.is_free) {
            let progress = shown.frame as f32 / shown.take.frames().max(1) as f32;
            let bounds =
                if scenes.is_automatic() { bounds(shown.take, 0..=shown.take.frames()) } else { Bounds::default() };
            self.orbit = Some(Orbit::new(&scenes.at(progress), size, &bounds));
        }
        if std::mem::take(&mut self.frames_hair)
            && let Some(orbit) = &mut self.orbit
        {
            orbit.frame(&bounds(shown.take, shown.frame..=shown.frame), size);
            self.is_free = true;
        }
    }

    /// Orbits, pans and zooms; whether it did.
    fn move_camera(&mut self, ui: &egui::Ui, response: &egui::Response, shown: &Shown<'_>, rect: egui::Rect) -> bool {
        let Some(orbit) = &mut self.orbit else { return false };
        let (buttons, pressed, way, wheel) = ui.input(|input| {
            let down = |button| input.pointer.button_down(button);
            let buttons = Buttons {
                left: down(egui::PointerButton::Primary),
                middle: down(egui::PointerButton::Middle),
                right: down(egui::PointerButton::Secondary),
                alt: input.modifiers.alt,
                shift: input.modifiers.shift,
                ctrl: input.modifiers.command || input.modifiers.ctrl,
            };
            let wheel = input.smooth_scroll_delta().y + 200.0 * (input.zoom_delta() - 1.0);
            (buttons, input.pointer.any_pressed(), input.pointer.delta(), wheel)
        });
        let over = response.contains_pointer();
        if over
            && pressed
            && matches!(self.hand, Hand::Idle)
            && let Some(gesture) = shown.navigation.gesture(buttons)
        {
            self.hand = Hand::Camera(gesture);
        }
        let mut moved = false;
        if let Hand::Camera(gesture) = self.hand {
            if buttons.left || buttons.middle || buttons.right {
                if way != egui::Vec2::ZERO {
                    orbit.drag(gesture, glam::Vec2::new(way.x, way.y), rect.height());
                    moved = true;
                }
            } else {
                self.hand = Hand::Idle;
            }
        }
        if over && wheel != 0.0 {
            orbit.zoom(-0.002 * wheel);
            moved = true;
        }
        self.is_free |= moved;
        moved
    }

    /// Lets the final picture fade in while the hand rests.
    fn refine(
        &mut self,
        ui: &egui::Ui,
        painter: &egui::Painter,
        rect: egui::Rect,
        shown: &Shown<'_>,
        view: &Seen,
        now: f64,
    ) {
        let Ok(screen) = &mut self.screen else { return };
        let tool = shown.tool() != Tool::Pull;
        if !shown.final_picture || shown.playing || self.hand.is_busy() || shown.ghosts || tool {
            self.rest.touch(now);
            if let Some(thread) = &self.final_picture {
                thread.cancel();
            }
            return;
        }
        let context = ui.ctx().clone();
        if self.rest.begins(now) {
            let mut picture = shown.picture.clone();
            picture.background.transparent = false;
            let wanted = Wanted {
                built: shown.take.built.clone(),
                picture,
                view: *view,
                frame: shown.frame,
                strands: shown.strands_in_final,
            };
            if self.final_picture.is_none() {
                match FinalPicture::new(move || context.request_repaint()) {
                    Ok(thread) => self.final_picture = Some(thread),
                    Err(none) => {
                        let why = nabiki_scene::threads::none_given(&none);
                        self.failed = Some(format!("The final picture cannot be drawn: {why}"));
                    }
                }
            }
            if let Some(thread) = &self.final_picture {
                thread.ask(wanted);
            }
        }
        if let Some(waits) = self.rest.waits(now) {
            // What is still being drawn is of before the touch.
            self.final_picture.iter().for_each(FinalPicture::cancel);
            ui.ctx().request_repaint_after_secs(waits as f32);
            return;
        }
        match self.final_picture.as_ref().and_then(FinalPicture::take) {
            Some(Ok(done)) => {
                screen.set_final(ui.ctx(), &done);
                self.rest.came(now);
            }
            Some(Err(why)) => self.failed = Some(format!("The final picture cannot be drawn: {why}")),
            None => {}
        }
        let opacity = self.rest.opacity(now);
        if opacity > 0.0 {
            screen.show_final(painter, rect, opacity);
        }
        if opacity > 0.0 && opacity < 1.0 || (opacity == 0.0 && self.rest.has_come()) {
            ui.ctx().request_repaint();
        }
    }

    /// Buttons below the words that say how far hair has fallen short: what would help.
    fn offer(&mut self, ui: &mut egui::Ui, rect: egui::Rect, shown: &Shown<'_>, words: Option<egui::Rect>, now: f64) {
        self.buttons.clear();
        let (Some(words), Some(let_go)) = (words, &mut self.let_go) else { return };
        let offers = let_go.offers(shown.take);
        let font = egui::TextStyle::Button.resolve(ui.style());
        let size = |name: &str| {
            let text = ui.painter().layout_no_wrap(name.to_owned(), font.clone(), egui::Color32::WHITE).size();
            text + 2.0 * ui.spacing().button_padding
        };
        let sizes: Vec<egui::Vec2> = offers.iter().map(|offer| size(offer.name)).collect();
        let wide: f32 = sizes.iter().map(|size| size.x + 4.0).sum();
        let below = words.bottom() + 4.0;
        let y = if below + 30.0 < rect.bottom() { below } else { words.top() - 30.0 };
        let mut x = words.left().min(rect.right() - wide).max(rect.left() + 4.0);
        let mut clicked = None;
        for (offer, size) in offers.into_iter().zip(sizes) {
            let place = egui::Rect::from_min_size(egui::pos2(x, y), size);
            x += size.x + 4.0;
            self.buttons.push(place);
            if ui.put(place, egui::Button::new(offer.name)).on_hover_text(offer.help).clicked() {
                clicked = Some(offer);
            }
        }
        if let Some(offer) = clicked {
            let context = ui.ctx().clone();
            let_go.look_again(offer, shown.take, now, move || context.request_repaint());
        }
    }

    /// Handle, thread, nails. Returns where it says that hair has fallen short.
    fn draw_over(
        &self,
        overlay: &Overlay<'_>,
        response: &egui::Response,
        shown: &Shown<'_>,
        view: &Seen,
    ) -> Option<egui::Rect> {
        let in_head = view.in_head(&shown.take.pose(shown.frame));
        let (points, strands) = (shown.take.points(shown.frame), shown.take.strands());
        for nail in self.nails.iter().filter(|nail| nail.fits(strands)) {
            overlay.nail(&in_head, nail.middle(points, strands), nail.frame == shown.frame);
        }
        let (of_forces, _) = hand::of_forces(shown, view);
        if shown.wind && !shown.playing {
            sources::draw(overlay, &of_forces, &sources::sources(&shown.take.built.scene.field));
        }
        let held = match &self.hand {
            Hand::Tip { interval, held, .. } => shown.force.get(*interval).map(|key| held.showing(key.vector)),
            _ => None,
        };
        // While hair is pulled intervals come and go, and the wind is the hand's.
        let of_chosen = || match &self.hand {
            Hand::Hair(_) => None,
            _ => self.arrow(shown, overlay.scale, view).map(|(_, arrow)| arrow),
        };
        if let Some(arrow) = held.or_else(of_chosen) {
            overlay.handle(&of_forces, &arrow, held.is_some());
        }
        match &self.hand {
            Hand::Hair(held) if held.lock.fits(strands) => {
                let (goal, hair) = (held.goal(), held.lock.middle(points, strands));
                overlay.thread(&in_head, goal, hair, held.says(hair, shown.take).as_deref());
            }
            Hand::Idle
                if let Some(words) = self.fell_short(shown)
                    && let Some(let_go) = &self.let_go =>
            {
                let hair = let_go.lock.middle(points, strands);
                return overlay.thread(&in_head, let_go.goal, hair, Some(&words));
            }
            Hand::Idle | Hand::Paint(_) | Hand::Comb(_) if shown.tool() != Tool::Pull => {
                self.draw_tool(overlay, response.hover_pos(), shown);
            }
            Hand::Idle if !shown.playing && shown.frame > 0 && !shown.hands_off => {
                let pixel = response.hover_pos().map(|at| (at - overlay.rect.min) * overlay.scale);
                let picked = pixel.and_then(|at| picked(shown, view, glam::Vec2::new(at.x, at.y), overlay.scale));
                if let Some(picked) = picked {
                    overlay.hint(&in_head, picked.place);
                }
            }
            _ => {}
        }
        None
    }
}

/// Head and hair of some frames, from the head's origin along the world's axes.
fn bounds(take: &Take, frames: std::ops::RangeInclusive<u32>) -> Bounds {
    let mut bounds = Bounds::default();
    let (head, turns) = (&take.built.model.head, take.built.head_moves());
    bounds.include_head(&head.mesh, &head.ellipsoid);
    let points = take.at_hand().checked_sub(1).map_or(0, |last| take.strands().range(last).end);
    for frame in frames {
        let turn = take.pose(frame).rotation;
        take.points(frame)[..points].iter().for_each(|&p| bounds.include(if turns { turn * p } else { p }));
    }
    bounds
}

#[cfg(test)]
#[path = "view/tests.rs"]
mod tests;
