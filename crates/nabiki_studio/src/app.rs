//! The window: panels laid out, keys and files that come in, commands carried out.

use std::path::PathBuf;

use eframe::egui::{self, Key, Modifiers, Ui, ViewportCommand};
use egui_tiles::{SimplificationOptions, TileId, UiResponse};
use nabiki_render::Picture;
use nabiki_scene::scene::FormChoice;

use crate::actions::{ACTIONS, Action};
use crate::command::Command;
use crate::dialog::Dialog;
use crate::document::{Document, Phase};
use crate::layout::{Layout, Pane};
use crate::panels::{Commands, dialogs, kept, mend, menu, page, status, theme, timeline, welcome};
use crate::preferences::{LAYOUT, Preferences};
use crate::session::{Session, Wish};
use crate::view::{Shown, Touch, View};

/// What is refused in the view.
const HAND: &str = "the hand in the view";

/// The window.
pub struct App {
    session: Session,
    view: View,
    layout: Layout,
    /// Pictures of the window in a second, by a running mean.
    fps: f32,
    title: String,
    remembered: Preferences,
    zoom: f32,
    /// Whether the window fits its screen, as far as this has been seen to.
    fits: bool,
    /// Whether a field was typed into when the last picture was drawn: Escape is then the field's.
    was_typing: bool,
    /// What waits for the field that is typed into to be left.
    waiting: Vec<Action>,
}

impl App {
    /// A window on the scene named, or on the one opened last. `folder`: where it remembers things.
    ///
    /// # Errors
    /// The system's, if it gives no thread.
    pub fn new(
        cc: &eframe::CreationContext<'_>,
        folder: Option<PathBuf>,
        scene: Option<PathBuf>,
    ) -> std::io::Result<Self> {
        theme::apply(&cc.egui_ctx);
        let ctx = cc.egui_ctx.clone();
        let mut session = Session::new(folder, move || ctx.request_repaint())?;
        session.begin(scene.as_deref());
        let (layout, said) = session.folder().map(|folder| Layout::load(&folder.join(LAYOUT))).unwrap_or_default();
        said.into_iter().for_each(|said| session.say_of_window(said, true));
        let view = View::new(cc.wgpu_render_state.as_ref());
        let (remembered, zoom) = (session.preferences().clone(), 0.0);
        Ok(Self {
            session,
            view,
            layout,
            fps: 0.0,
            title: String::new(),
            remembered,
            zoom,
            fits: false,
            was_typing: false,
            waiting: Vec::new(),
        })
    }

    /// What the window knows.
    pub fn session(&self) -> &Session {
        &self.session
    }

    /// The same, to be changed by commands from outside.
    pub fn session_mut(&mut self) -> &mut Session {
        &mut self.session
    }

    /// What is seen of it, and what a hand does there.
    pub fn view(&self) -> &View {
        &self.view
    }

    fn passes(&mut self, ctx: &egui::Context) {
        let (passed, seconds) = ctx.input(|input| (f64::from(input.unstable_dt), f64::from(input.stable_dt).min(0.25)));
        self.session.tick(passed, seconds);
        if self.session.play.is_playing() {
            self.fps += 0.1 * (1.0 / seconds.max(1e-4) as f32 - self.fps);
            ctx.request_repaint();
        } else {
            // At rest nothing is drawn: what comes of itself calls.
            let waits = self.session.waits();
            if waits.is_finite() {
                ctx.request_repaint_after(std::time::Duration::from_secs_f64(waits));
            }
        }
        let zoom = self.session.preferences().zoom;
        if (self.zoom - zoom).abs() > 1e-3 {
            ctx.set_zoom_factor(zoom);
            self.zoom = zoom;
        }
        self.fit_screen(ctx);
        self.remember_window(ctx);
        let mark = |changed| if changed { "*" } else { "" };
        let title = match (self.session.broken(), self.session.document()) {
            (Some(broken), _) => format!("{}{} - Nabiki", mark(broken.is_changed()), broken.name()),
            (None, Some(document)) => format!("{}{} - Nabiki", mark(document.is_dirty()), document.name()),
            (None, None) => "Nabiki".to_owned(),
        };
        if title != self.title {
            ctx.send_viewport_cmd(ViewportCommand::Title(title.clone()));
            self.title = title;
        }
    }

    /// A window larger than what a screen has free, at the first start or on a smaller screen than the last, fills that: the desktop
    /// knows what is free. Where none does, it is as large as leaves room for bars.
    fn fit_screen(&mut self, ctx: &egui::Context) {
        if self.fits {
            return;
        }
        let zoom = ctx.zoom_factor();
        let (screen, maximised) = ctx.input(|input| {
            let viewport = input.viewport();
            (viewport.monitor_size, viewport.maximized.unwrap_or_default())
        });
        let Some(screen) = screen else { return };
        self.fits = true;
        let wanted = egui::Vec2::from(self.session.preferences().window) / zoom;
        if let Some(size) = fitting(wanted, screen, zoom).filter(|_| !maximised) {
            ctx.send_viewport_cmd(ViewportCommand::InnerSize(size));
            ctx.send_viewport_cmd(ViewportCommand::Maximized(true));
        }
    }

    fn remember_window(&mut self, ctx: &egui::Context) {
        let (size, maximised) = ctx.input(|input| {
            let viewport = input.viewport();
            (viewport.inner_rect.map(|rect| rect.size()), viewport.maximized.unwrap_or_default())
        });
        let mut preferences = self.session.preferences().clone();
        preferences.maximised = maximised;
        if let (Some(size), false) = (size, maximised) {
            let zoom = ctx.zoom_factor();
            preferences.window = [(size.x * zoom).round(), (size.y * zoom).round()];
        }
        if preferences != *self.session.preferences() {
            self.session.apply(Command::Prefer(Box::new(preferences)));
        }
    }

    fn inputs(&mut self, ctx: &egui::Context, commands: &mut Commands) {
        let dropped: Vec<PathBuf> =
            ctx.input(|input| input.raw.dropped_files.iter().map(|file| file.path().to_owned()).collect());
        commands.extend(dropped.into_iter().map(Command::Open));
        if ctx.input(|input| input.viewport().close_requested()) && !self.session.may_close() {
            ctx.send_viewport_cmd(ViewportCommand::CancelClose);
        }
        if self.session.dialog() == Some(&Dialog::Welcome) {
            if !welcome::is_over(ctx) {
                return;
            }
            // The touch does what it does; the words only go.
            commands.push(Command::CloseDialog);
        } else if self.session.dialog().is_some() {
            return;
        }
        let dragged = self.session.document().is_some_and(Document::is_dragging);
        let held = self.view.is_held() || (dragged && ctx.input(|input| input.pointer.any_down()));
        if ctx.egui_wants_keyboard_input() && !held {
            self.waiting = keys_of_files(ctx);
            if !self.waiting.is_empty() {
                ctx.request_repaint();
            }
            return;
        }
        keys(ctx, held, egui::Popup::is_any_open(ctx) || self.was_typing, commands);
    }

    /// What has waited for the field that was typed into: it is left now, and takes what was typed before any of it is done. A
    /// text being mended goes on being typed.
    fn leave_field(&mut self, ctx: &egui::Context) -> Vec<Action> {
        let waited = std::mem::take(&mut self.waiting);
        if !waited.is_empty() && self.session.broken().is_none() {
            ctx.memory_mut(|memory| memory.focused().into_iter().for_each(|field| memory.surrender_focus(field)));
        }
        waited
    }

    fn carry_out(&mut self, ctx: &egui::Context, commands: Commands) {
        let any = !commands.is_empty();
        commands.into_iter().for_each(|command| self.session.apply(command));
        for wish in self.session.wishes() {
            match wish {
                Wish::Frame => self.view.frame_hair(),
                Wish::SceneCamera => self.view.reset_camera(),
                Wish::UseCamera => self.use_camera(),
                Wish::ResetLayout => self.layout = Layout::default(),
                Wish::Page(page) => self.layout.show(page),
                Wish::Quit => ctx.send_viewport_cmd(ViewportCommand::Close),
            }
        }
        if *self.session.preferences() != self.remembered && !ctx.input(|input| input.pointer.any_down()) {
            self.remembered = self.session.preferences().clone();
            self.session.remember();
        }
        if any {
            ctx.request_repaint();
        }
    }

    /// Writes the view's camera into the scene. What it does not say stays.
    fn use_camera(&mut self) {
        let Some(document) = self.session.document() else { return };
        let mut scene = document.scene().clone();
        scene.picture.camera = self.view.camera();
        let command = Command::Scene { name: "Camera".to_owned(), scene: Box::new(scene), phase: Phase::Done };
        self.session.apply(command);
    }
}

impl eframe::App for App {
    fn ui(&mut self, ui: &mut Ui, _frame: &mut eframe::Frame) {
        let ctx = ui.ctx().clone();
        self.passes(&ctx);
        let mut commands = Commands::new();
        let waited = self.leave_field(&ctx);
        self.inputs(&ctx, &mut commands);
        let bar = |fill| egui::Frame::new().fill(fill).inner_margin(egui::Margin::symmetric(4, 1));
        egui::Panel::top("menu").frame(bar(theme::PANEL)).show(ui, |ui| menu::ui(ui, &self.session, &mut commands));
        egui::Panel::bottom("status").frame(bar(theme::PANEL)).show(ui, |ui| {
            status::line(ui, &self.session, self.fps, &mut commands);
        });
        egui::CentralPanel::default().frame(egui::Frame::new().fill(theme::GROUND)).show(ui, |ui| {
            let (session, view, all) = (&self.session, &mut self.view, ui.max_rect());
            let mut panes = Panes { session, view, place: None, commands: &mut commands };
            self.layout.ui(&mut panes, ui);
            let place = panes.place.unwrap_or(all);
            status::words(ui.ctx(), place, &self.session, &mut commands);
        });
        dialogs::ui(&ctx, &self.session, &mut commands);
        if ctx.input(|input| input.pointer.any_released()) {
            commands.push(Command::EndDrag);
        }
        commands.extend(waited.into_iter().map(Command::Act));
        self.was_typing = ctx.egui_wants_keyboard_input();
        self.carry_out(&ctx, commands);
    }

    fn on_exit(&mut self) {
        self.session.end();
        if let Some(folder) = self.session.folder() {
            self.layout.write(&folder.join(LAYOUT));
        }
    }

    fn clear_color(&self, _visuals: &egui::Visuals) -> [f32; 4] {
        theme::GROUND.to_normalized_gamma_f32()
    }
}

/// What bars and titles of a desktop take of a screen's width and height, at least in most (points).
const BARS: egui::Vec2 = egui::Vec2::new(24.0, 84.0);

/// The size of a window on a screen with less free than is wanted (points of a zoom); none where there is room.
fn fitting(wanted: egui::Vec2, screen: egui::Vec2, zoom: f32) -> Option<egui::Vec2> {
    let free = (screen - BARS / zoom).max(egui::Vec2::splat(100.0));
    (wanted.x > free.x || wanted.y > free.y).then(|| wanted.min(free).floor())
}

/// The keys of all actions, in the order in which they were pressed. `held`: something is being dragged, which Escape gives
/// up before it means anything else. `menu`: one is open, which Escape closes, or a field was typed into, which Escape leaves as it was.
fn keys(ctx: &egui::Context, mut held: bool, menu: bool, commands: &mut Commands) {
    ctx.input_mut(|input| {
        input.events.retain(|event| {
            let (action, is_key) = match event {
                // The system has its own words for these three.
                egui::Event::Copy => (Some(Action::Copy), false),
                egui::Event::Cut => (Some(Action::Cut), false),
                egui::Event::Paste(_) => (Some(Action::Paste), false),
                // The keys held are those of the event: by the end of a slow picture they may have been let go.
                egui::Event::Key { key, modifiers, pressed: true, .. } => (action_of(*key, *modifiers), true),
                _ => (None, false),
            };
            let Some(action) = action else { return true };
            // What is held goes on changing the scene.
            if held && matches!(action, Action::Compare | Action::Exchange) {
                return false;
            }
            if action == Action::SelectNone && std::mem::take(&mut held) {
                // The view is to see it, too.
                commands.push(Command::GiveUpDrag);
                return true;
            }
            if action == Action::SelectNone && menu {
                return true;
            }
            commands.push(Command::Act(action));
            !is_key
        });
    });
}

/// The keys of the file menu, while a field is typed into: they have no meaning there. All others are the field's.
fn keys_of_files(ctx: &egui::Context) -> Vec<Action> {
    let mut found = Vec::new();
    ctx.input_mut(|input| {
        input.events.retain(|event| {
            let egui::Event::Key { key, modifiers, pressed: true, .. } = event else { return true };
            let action = action_of(*key, *modifiers).filter(|action| action.entry().menu == "File");
            found.extend(action);
            action.is_none()
        });
    });
    found
}

/// What a key does. Of two that fit it is the one that holds more, or Ctrl+Z would take Ctrl+Shift+Z.
fn action_of(key: Key, modifiers: Modifiers) -> Option<Action> {
    let held = |command, shift| Modifiers { command, shift, ..Modifiers::NONE };
    let named = ACTIONS.iter().flat_map(|entry| entry.keys().map(|shortcut| (shortcut, entry.action)));
    let named = named.filter(|(shortcut, _)| Key::from_name(shortcut.key) == Some(key));
    let named = named.map(|(shortcut, action)| (held(shortcut.command, shortcut.shift), action));
    let fitting = named.filter(|(wanted, _)| modifiers.matches_logically(*wanted));
    fitting.max_by_key(|(wanted, _)| u8::from(wanted.command) + u8::from(wanted.shift)).map(|(_, action)| action)
}

struct Panes<'a> {
    session: &'a Session,
    view: &'a mut View,
    /// Where the view is, if it is not behind another pane.
    place: Option<egui::Rect>,
    commands: &'a mut Commands,
}

impl Panes<'_> {
    fn view(&mut self, ui: &mut Ui) {
        self.place = Some(ui.max_rect());
        if self.session.broken().is_some() {
            // What is said lies over a picture, but not over a text.
            let mut room = ui.available_rect_before_wrap();
            room.max.y -= status::height_of_words(ui.ctx(), self.session);
            let mut above = ui.new_child(egui::UiBuilder::new().max_rect(room));
            egui::Frame::new().inner_margin(10.0).show(&mut above, |ui| mend::ui(ui, self.session, self.commands));
            return;
        }
        let (Some(document), Some(take)) = (self.session.document(), self.session.take()) else {
            ui.centered_and_justified(|ui| {
                let text = match self.session.trouble() {
                    Some(_) => "This scene does not move yet. The message below gives the reason.",
                    None if self.session.is_moving() => "Growing the hair...",
                    None => "Open a scene (Ctrl+O), or drop one here.",
                };
                ui.label(theme::faint(text));
            });
            return;
        };
        let (scene, preferences) = (document.scene(), self.session.preferences());
        let instead = self.session.seen_instead();
        let (take, scene) = instead.map_or((take, scene), |(take, _)| (take, &take.built.scene));
        // From where the scene is seen, or nothing could be compared.
        let picture = Picture { camera: document.scene().picture.camera, ..scene.picture.clone() };
        let force = take.built.strengths_of(&scene.field.force);
        let shown = Shown {
            scene: self.session.opened(),
            take,
            picture: &picture,
            force: &force,
            frame: self.session.play.frame().min(take.frames()),
            playing: self.session.play.is_playing(),
            selected_interval: match self.session.chosen() {
                [j] if instead.is_none() => Some(*j),
                _ => None,
            },
            hands_off: instead.is_some(),
            ghosts: preferences.ghosts,
            wind: preferences.arrows,
            final_picture: preferences.final_picture && self.session.trouble().is_none(),
            strands_in_final: usize::MAX,
            navigation: preferences.navigation,
            tools: self.session.tools(),
            regions: &scene.free.regions,
            aims: &scene.aims,
            is_free: scene.form == FormChoice::Free,
        };
        let rect = ui.available_rect_before_wrap();
        let touches = self.view.ui(ui, &shown);
        if let Some((_, differences)) = instead {
            kept::ui(ui.ctx(), rect, differences);
        }
        if self.session.dialog() == Some(&Dialog::Welcome) {
            let (side, room) = self.view.free_side(&shown, rect.size());
            welcome::ui(ui.ctx(), rect, side, room);
        }
        for touch in touches {
            let phase = |done| if done { Phase::Done } else { Phase::Dragging };
            self.commands.push(match touch {
                Touch::SetVector { interval, vector, done } => Command::Vector { interval, vector, phase: phase(done) },
                Touch::Pulled { name, answer, interval, phase } => Command::Pulled { name, answer, interval, phase },
                Touch::Use(tools) => Command::Use(tools),
                Touch::Painted { region, painted } => Command::Painted { region, painted },
                Touch::Combed { frame, strands } => Command::Combed { frame, strands },
                Touch::Undone => Command::GiveUpDrag,
                Touch::CameraMoved => continue,
                Touch::Refused(why) => Command::Refuse { about: HAND.to_owned(), why },
                Touch::Heard => Command::Took(HAND.to_owned()),
            });
        }
    }
}

impl egui_tiles::Behavior<Pane> for Panes<'_> {
    fn pane_ui(&mut self, ui: &mut Ui, _: TileId, pane: &mut Pane) -> UiResponse {
        let fill = if *pane == Pane::View { theme::GROUND } else { theme::PANEL };
        ui.painter().rect_filled(ui.max_rect(), 0.0, fill);
        match pane {
            Pane::View => self.view(ui),
            Pane::Timeline => timeline::ui(ui, self.session, &self.view.marks(), self.commands),
            Pane::Page(page) => {
                let margin = egui::Margin { left: 8, right: 2, top: 6, bottom: 0 };
                egui::Frame::new().inner_margin(margin).show(ui, |ui| page::ui(ui, self.session, *page, self.commands));
            }
        }
        UiResponse::None
    }

    fn tab_title_for_pane(&mut self, pane: &Pane) -> egui::WidgetText {
        match pane {
            Pane::View => "View",
            Pane::Timeline => "Timeline",
            Pane::Page(page) => page.title(),
        }
        .into()
    }

    fn simplification_options(&self) -> SimplificationOptions {
        SimplificationOptions { all_panes_must_have_tabs: false, ..SimplificationOptions::default() }
    }

    fn gap_width(&self, _: &egui::Style) -> f32 {
        3.0
    }

    fn tab_bar_height(&self, _: &egui::Style) -> f32 {
        28.0
    }

    fn tab_title_spacing(&self, _: &egui::Visuals) -> f32 {
        10.0
    }

    fn tab_bar_color(&self, _: &egui::Visuals) -> egui::Color32 {
        theme::GROUND
    }
}

#[cfg(test)]
mod tests {
    use eframe::egui::{Event, RawInput};

    use super::*;

    #[test]
    fn a_window_larger_than_the_free_part_of_its_screen_is_as_large_as_that() {
        let first = egui::Vec2::from(Preferences::default().window);
        for screen in [[1280.0, 720.0], [1366.0, 768.0], [1440.0, 900.0], [1024.0, 600.0]].map(egui::Vec2::from) {
            for zoom in [1.0, 1.5] {
                // Both in the points of a zoom.
                let (wanted, screen) = (first / zoom, screen / zoom);
                let size = fitting(wanted, screen, zoom).unwrap();
                assert!(size.x <= screen.x - BARS.x / zoom && size.y <= screen.y - BARS.y / zoom, "{size} on {screen}");
                assert!(size.x <= wanted.x && size.y <= wanted.y && size.y > 300.0);
            }
        }
        for screen in [[1920.0, 1080.0], [3840.0, 2160.0]] {
            assert_eq!(fitting(first, screen.into(), 1.0), None);
        }
        assert!(fitting(egui::vec2(1900.0, 1060.0), egui::vec2(1920.0, 1080.0), 1.0).is_some(), "of a larger screen");
    }

    fn pressed(held: bool, keys: &[(Key, Modifiers)]) -> Vec<Command> {
        let event = |&(key, modifiers): &(Key, Modifiers)| Event::Key {
            key,
            physical_key: None,
            pressed: true,
            repeat: false,
            modifiers,
        };
        let input = RawInput { events: keys.iter().map(event).collect(), ..RawInput::default() };
        let mut commands = Commands::new();
        let _ = egui::Context::default().run_ui(input, |ui| self::keys(ui.ctx(), held, false, &mut commands));
        commands
    }

    fn actions(commands: &[Command]) -> Vec<Action> {
        let action = |command: &Command| match command {
            Command::Act(action) => *action,
            other => panic!("{other:?} is no action"),
        };
        commands.iter().map(action).collect()
    }

    #[test]
    fn keys_of_one_picture_do_what_they_do_in_the_order_in_which_they_were_pressed() {
        let (none, command, both) = (Modifiers::NONE, Modifiers::COMMAND, Modifiers::COMMAND | Modifiers::SHIFT);
        let keys = [(Key::S, none), (Key::Z, command), (Key::End, none), (Key::Z, both), (Key::Y, command)];
        let wanted = [Action::Split, Action::Undo, Action::Last, Action::Redo, Action::Redo];
        assert_eq!(actions(&pressed(false, &keys)), wanted);
        assert_eq!(actions(&pressed(false, &[(Key::End, none), (Key::S, none)])), [Action::Last, Action::Split]);
    }

    #[test]
    fn escape_gives_up_what_is_held_and_chooses_none_otherwise() {
        let escape = (Key::Escape, Modifiers::NONE);
        assert_eq!(actions(&pressed(false, &[escape])), [Action::SelectNone]);
        assert!(matches!(pressed(true, &[escape])[..], [Command::GiveUpDrag]));
        assert!(matches!(
            pressed(true, &[escape, escape])[..],
            [Command::GiveUpDrag, Command::Act(Action::SelectNone)]
        ));
    }
}
