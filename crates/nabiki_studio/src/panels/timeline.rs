//! The timeline: transport, ruler, the wind's intervals, and the tracks of what else moves.

mod blocks;
mod scale;
mod tracks;

use eframe::egui::{self, Align2, Color32, Rect, Sense, Stroke, Ui, pos2, vec2};
use nabiki::field::Ease;

use super::hands::Hands;
use super::number::Number;
use super::{Commands, interval, theme};
use crate::actions::Action;
use crate::command::Command;
use crate::play::{Ending, Play};
use crate::session::Session;
use crate::view::Marks;

use scale::Scale;

/// Width of the fields beside the tracks (points).
const FIELDS: f32 = 236.0;
/// Width of the names of the tracks (points).
const NAMES: f32 = 74.0;
/// Height of the ruler (points).
const RULER: f32 = 22.0;
/// Height of the intervals (points).
const BLOCKS: f32 = 62.0;

/// Draws the panel. `marks`: where hair is wished to be somewhere.
pub fn ui(ui: &mut Ui, session: &Session, marks: &Marks, commands: &mut Commands) {
    if session.broken().is_some() {
        // The pages say why.
        ui.disable();
    }
    transport(ui, session, commands);
    ui.add_space(2.0);
    let Some(document) = session.document() else { return };
    let room = ui.available_rect_before_wrap();
    let (fields, tracks) = room.split_left_right_at_x(room.left() + FIELDS.min(room.width() * 0.4));
    let mut below = ui.new_child(egui::UiBuilder::new().max_rect(fields.shrink2(vec2(6.0, 2.0))));
    egui::ScrollArea::vertical().id_salt("interval").show(&mut below, |ui| {
        interval::ui(ui, session, fields.height(), commands);
    });
    ui.painter().vline(fields.right(), room.y_range(), Stroke::new(1.0, theme::LINE));

    let area = Rect::from_min_max(pos2(tracks.left() + 6.0, tracks.top()), tracks.right_bottom() - vec2(8.0, 0.0));
    let mut below = ui.new_child(egui::UiBuilder::new().max_rect(area));
    below.set_clip_rect(area.intersect(ui.clip_rect()));
    let ui = &mut below;
    let keys = &document.scene().field.force;
    let last = document.scene().motion.frames.max(1);
    let lane = Rect::from_min_max(pos2(area.left() + NAMES, area.top()), area.right_bottom());
    let scale = Scale::of(ui, session.opened(), lane, last.max(keys.last().map_or(0, |key| key.through)));
    // What lies behind everything else takes the drags that nothing before it wants.
    let behind = Rect::from_min_max(pos2(lane.left(), lane.top() + RULER), lane.right_bottom());
    choose_by_box(ui, behind, &scale, session, commands);
    ruler(ui, Rect::from_min_size(lane.min, vec2(lane.width(), RULER)), &scale, last, commands);
    wishes(ui, Rect::from_min_size(lane.min, vec2(lane.width(), RULER)), &scale, marks);
    let top = lane.top() + RULER + 4.0;
    let row = |top: f32, height: f32| Rect::from_min_size(pos2(area.left(), top), vec2(area.width(), height));
    let wind = row(top, BLOCKS);
    wind_name(ui, wind, document.scene().field.wind.ease, commands);
    blocks::ui(ui, Rect::from_min_max(pos2(lane.left(), wind.top()), wind.right_bottom()), &scale, session, commands);
    scrolled(ui, Rect::from_min_max(pos2(area.left(), wind.bottom() + 4.0), area.max), |ui| {
        let mut y = ui.cursor().top();
        let mut next = |height: f32| {
            let rect = row(y, height);
            y += height + 4.0;
            (rect, Rect::from_min_max(pos2(lane.left(), rect.top()), rect.right_bottom()))
        };
        tracks::ui(ui, &mut next, &scale, session, commands);
        y
    });
    playhead(ui, lane, &scale, session.play.frame());
}

/// Tracks in the room that is left: more of them than fit are scrolled, by the bar or by the wheel over their names, since over
/// the tracks it nears the time. `draw` returns where they end.
fn scrolled(ui: &mut Ui, room: Rect, draw: impl FnOnce(&mut Ui) -> f32) {
    let mut below = ui.new_child(egui::UiBuilder::new().max_rect(room));
    below.spacing_mut().scroll = egui::style::ScrollStyle::solid();
    let over_names = ui.rect_contains_pointer(Rect::from_min_size(room.min, vec2(NAMES, room.height())));
    let source =
        egui::scroll_area::ScrollSource { mouse_wheel: over_names, ..egui::scroll_area::ScrollSource::SCROLL_BAR };
    let area = egui::ScrollArea::vertical().id_salt("tracks").auto_shrink(false).scroll_source(source);
    area.show(&mut below, |ui| {
        let top = ui.cursor().top();
        let bottom = draw(ui);
        ui.allocate_rect(Rect::from_min_max(pos2(room.left(), top), pos2(room.right() - 10.0, bottom)), Sense::hover());
    });
}

/// Where nails are, and where a lock is pulled.
fn wishes(ui: &Ui, ruler: Rect, scale: &Scale, marks: &Marks) {
    let painter = ui.painter().with_clip_rect(ruler.intersect(ui.clip_rect()));
    if let Some(felt) = &marks.felt {
        let x = |frame: f64| scale.x(frame).clamp(ruler.left(), ruler.right());
        let (left, right) = (x(f64::from(*felt.start()) - 0.5), x(f64::from(*felt.end()) + 0.5));
        let bar = Rect::from_x_y_ranges(left..=right, ruler.bottom() - 3.0..=ruler.bottom());
        painter.rect_filled(bar, 1.0, theme::ACCENT.gamma_multiply(0.6));
    }
    for &frame in &marks.nails {
        let at = pos2(scale.x(f64::from(frame)), ruler.bottom() - 4.0);
        for d in [vec2(3.5, 3.5), vec2(3.5, -3.5)] {
            painter.line_segment([at - d, at + d], Stroke::new(2.0, theme::NAIL));
        }
    }
    if let Some(frame) = marks.pulled {
        let at = pos2(scale.x(f64::from(frame)), ruler.bottom() - 4.0);
        painter.circle_stroke(at, 3.5, Stroke::new(2.0, theme::ACCENT));
    }
}

/// Buttons and fields above the tracks; in more than one line where there is no room in one.
fn transport(ui: &mut Ui, session: &Session, commands: &mut Commands) {
    ui.horizontal_wrapped(|ui| {
        ui.set_min_height(26.0);
        ui.add_space(6.0);
        ui.spacing_mut().item_spacing.x = 2.0;
        playing(ui, session, commands);
        let buttons: [_; 4] = [Action::Add, Action::Split, Action::Join, Action::Delete].map(|action| action.entry());
        let font = egui::TextStyle::Button.resolve(ui.style());
        let of_button = |name: &str| {
            let text = ui.painter().layout_no_wrap(name.to_owned(), font.clone(), theme::TEXT);
            (text.size().x + 2.0 * ui.spacing().button_padding.x).max(ui.spacing().interact_size.x)
        };
        let wide: f32 = buttons.iter().map(|entry| of_button(entry.name) + ui.spacing().item_spacing.x).sum();
        let left = ui.available_size_before_wrap().x - wide - 8.0;
        if left > 0.0 {
            ui.add_space(left);
        }
        let (chosen, open) = (session.chosen().len(), session.document().is_some());
        for entry in buttons {
            let enabled = match entry.action {
                Action::Join => chosen > 1,
                Action::Delete => chosen > 0,
                _ => open,
            };
            let key = entry.key.map(|key| format!(" ({})", key.text())).unwrap_or_default();
            let button = ui.add_enabled(enabled, egui::Button::new(entry.name));
            if button.hint(format!("{}{key}", entry.help)).clicked() {
                commands.push(Command::Act(entry.action));
            }
        }
    });
}

/// The frame that is shown, and how frames follow each other.
fn playing(ui: &mut Ui, session: &Session, commands: &mut Commands) {
    for (sign, action) in [
        (Sign::First, Action::First),
        (Sign::Back, Action::Back),
        (if session.play.is_playing() { Sign::Pause } else { Sign::Play }, Action::Play),
        (Sign::Forward, Action::Forward),
        (Sign::Last, Action::Last),
    ] {
        if sign_button(ui, sign, action).clicked() {
            commands.push(Command::Act(action));
        }
    }
    ui.add_space(8.0);
    let frame = session.play.frame();
    let mut wanted = f64::from(frame);
    let range = 0.0..=f64::from(session.play.last());
    let field = Number { range, step: 0.25, decimals: 0, wide: Some(46.0), ..Number::of("Frame") };
    let response = field.ui(ui, &mut wanted, commands).hint("The frame shown.").accessible_name("Frame");
    if response.changed() {
        commands.push(Command::Go(wanted as u32));
    }
    ui.add_space(4.0);
    let rate = session.document().map_or(24.0, |document| document.scene().frame_rate());
    let seconds = f64::from(frame) / rate;
    ui.label(theme::faint(format!("of {}   {seconds:.2} s", session.play.last())));
    ui.add_space(10.0);
    let speed = session.play.speed;
    let text = |speed: f64| format!("{speed} x");
    let box_ = egui::ComboBox::from_id_salt("speed").selected_text(text(speed)).width(56.0);
    let response = box_.show_ui(ui, |ui| {
        for offered in Play::SPEEDS {
            if ui.selectable_label(speed == offered, text(offered)).clicked() {
                commands.push(Command::Speed(offered));
            }
        }
    });
    response
        .response
        .hint(format!("Playback speed, relative to the scene's {rate} frames per second."))
        .accessible_name("Speed");
    ui.add_space(4.0);
    let ending = match session.play.ending {
        Ending::Loop => "Loop",
        Ending::Stop => "Stop",
        Ending::Swing => "Ping-pong",
    };
    if ui.button(ending).hint("What happens after the last frame (L).").clicked() {
        commands.push(Command::Act(Action::Ending));
    }
}

#[derive(Clone, Copy)]
enum Sign {
    First,
    Back,
    Play,
    Pause,
    Forward,
    Last,
}

/// A button with a sign that no font need have.
fn sign_button(ui: &mut Ui, sign: Sign, action: Action) -> egui::Response {
    let entry = action.entry();
    let (rect, response) = ui.allocate_exact_size(vec2(26.0, 22.0), Sense::click());
    let key = entry.key.map(|key| format!(" ({})", key.text())).unwrap_or_default();
    let response = response.hint(format!("{}{key}", entry.name));
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, entry.name));
    let visuals = ui.style().interact(&response);
    ui.painter().rect_filled(rect, 3.0, visuals.bg_fill);
    let ink = visuals.fg_stroke.color;
    let (c, h) = (rect.center(), 5.0);
    let triangle = |from: f32, to: f32| {
        egui::Shape::convex_polygon(
            vec![pos2(c.x + from, c.y - h), pos2(c.x + to, c.y), pos2(c.x + from, c.y + h)],
            ink,
            Stroke::NONE,
        )
    };
    let bar = |x: f32, wide: f32| {
        egui::Shape::rect_filled(Rect::from_center_size(pos2(c.x + x, c.y), vec2(wide, 2.0 * h)), 0.0, ink)
    };
    let shapes = match sign {
        Sign::First => vec![bar(-5.0, 2.0), triangle(5.0, -3.0)],
        Sign::Back => vec![triangle(3.0, -5.0)],
        Sign::Play => vec![triangle(-4.0, 5.0)],
        Sign::Pause => vec![bar(-3.0, 3.0), bar(3.0, 3.0)],
        Sign::Forward => vec![triangle(-3.0, 5.0)],
        Sign::Last => vec![triangle(-5.0, 3.0), bar(5.0, 2.0)],
    };
    ui.painter().extend(shapes);
    response
}

/// Frames in numbers; a drag on it shows them.
fn ruler(ui: &mut Ui, rect: Rect, scale: &Scale, last: u32, commands: &mut Commands) {
    let response = ui.interact(rect, ui.scope_id().with("ruler"), Sense::click_and_drag());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Slider, true, "Ruler"));
    let response = response.on_hover_cursor(egui::CursorIcon::ResizeHorizontal);
    let clicked = response.clicked().then(|| response.interact_pointer_pos()).flatten();
    if let Some(pointer) = response.held_at().or(clicked) {
        commands.push(Command::Go(scale.frame(pointer.x)));
    }
    if response.double_clicked() {
        scale.forget(ui);
    }
    let painter = ui.painter();
    let over = scale.x(f64::from(last) + 0.5);
    if over < rect.right() {
        // After the last frame there is nothing.
        let beyond = Rect::from_min_max(pos2(over, rect.top()), ui.clip_rect().right_bottom());
        painter.rect_filled(beyond, 0.0, Color32::from_black_alpha(60));
    }
    let step = scale.step();
    let from = (scale.from().max(0.0) / f64::from(step)).floor() as u64 * u64::from(step);
    // What is shown may reach a little beyond the last frame that there can be.
    for frame in (from..).step_by(step as usize).take_while(|n| *n as f64 <= scale.to()) {
        let x = scale.x(frame as f64);
        painter.vline(x, rect.bottom() - 4.0..=rect.bottom(), Stroke::new(1.0, Color32::from_gray(70)));
        painter.text(
            pos2(x, rect.top() + 9.0),
            Align2::CENTER_CENTER,
            frame,
            egui::FontId::proportional(10.5),
            theme::FAINT,
        );
    }
}

/// A drag over nothing chooses the intervals of its frames; a click chooses none.
fn choose_by_box(ui: &mut Ui, rect: Rect, scale: &Scale, session: &Session, commands: &mut Commands) {
    let response = ui.interact(rect, ui.scope_id().with("behind"), Sense::click_and_drag());
    if response.clicked() && !session.chosen().is_empty() {
        commands.push(Command::Choose(Vec::new()));
    }
    let Some(document) = session.document() else { return };
    if let (Some(start), Some(now)) = (ui.input(|input| input.pointer.press_origin()), response.held_at()) {
        let (a, b) = (scale.frame(start.x.min(now.x)), scale.frame(start.x.max(now.x)));
        commands.push(Command::Choose(crate::timeline::within(&document.scene().field.force, a..=b)));
        let drawn = Rect::from_two_pos(start, now).intersect(rect);
        ui.painter().rect(
            drawn,
            2.0,
            theme::ACCENT.gamma_multiply(0.12),
            Stroke::new(1.0, theme::ACCENT),
            egui::StrokeKind::Inside,
        );
    }
    scale.steer(ui, rect);
}

/// The name of the wind, and how its vectors lead to one another: that is of all intervals, and so beside their track.
fn wind_name(ui: &mut Ui, row: Rect, ease: Ease, commands: &mut Commands) {
    let name = Rect::from_min_size(row.min, vec2(NAMES, row.height()));
    track_name(ui, Rect::from_min_size(name.min, vec2(NAMES, 18.0)), "Wind", theme::TEXT);
    let below = Rect::from_min_max(name.min + vec2(2.0, 20.0), name.max - vec2(4.0, 0.0));
    let mut below = ui.new_child(egui::UiBuilder::new().max_rect(below));
    below.spacing_mut().item_spacing.y = 1.0;
    below.label(theme::faint("Ease (all)").size(10.5));
    let word = match ease {
        Ease::Stepped => "stepped",
        Ease::Linear => "linear",
        Ease::Smooth => "smooth",
    };
    let help = "How each vector leads to the next, in all intervals (E): stepped, linear or smooth.";
    let button = below.small_button(word).hint(help);
    if button.accessible_name("Ease of all intervals").clicked() {
        commands.push(Command::Act(Action::Ease));
    }
}

fn track_name(ui: &Ui, row: Rect, name: &str, ink: Color32) {
    let at = pos2(row.left() + 2.0, row.center().y);
    ui.painter().text(at, Align2::LEFT_CENTER, name, egui::FontId::proportional(theme::SMALL), ink);
}

fn playhead(ui: &Ui, lane: Rect, scale: &Scale, frame: u32) {
    let x = scale.x(f64::from(frame));
    if !lane.x_range().contains(x) {
        return;
    }
    let painter = ui.painter();
    painter.vline(x, lane.top() + 16.0..=lane.bottom(), Stroke::new(1.0, theme::ACCENT));
    let text = frame.to_string();
    let head = Rect::from_center_size(pos2(x, lane.top() + 9.0), vec2(10.0 + 6.5 * text.len() as f32, 16.0));
    painter.rect_filled(head, 3.0, theme::ACCENT);
    painter.text(head.center(), Align2::CENTER_CENTER, text, egui::FontId::proportional(10.5), Color32::from_gray(20));
}
