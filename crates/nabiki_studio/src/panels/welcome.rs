//! The words of the first start: beside the hair, until something is touched.

use eframe::egui::{self, Align, Rect, vec2};

use super::theme;

/// Width of the words, and of the few where there is less room for them beside the hair (points).
const WIDTH: f32 = 236.0;
const NARROW: f32 = 136.0;
/// Height of the view that the words need (points).
const HEIGHT: f32 = 260.0;
/// Room to the edges of the view (points).
const MARGIN: f32 = 14.0;

const ALL: &[(&str, &str)] = &[
    ("Space", "plays. The intervals below are the wind."),
    ("Drag", "a border between two intervals, or the arrow over the head. All frames follow."),
    ("Pull", "the hair itself, at a later frame. The studio finds the wind for it."),
    ("Pages", "at the right change cut, curl, stiffness and colour."),
    ("Ctrl+Z", "undoes anything. F1 lists the keys."),
];
const FEW: &[(&str, &str)] =
    &[("Space", "plays."), ("Drag", "the arrow, or the wind below."), ("F1", "lists the keys.")];

/// Draws them at a side of the view that has so much room beside the hair (points). Whatever is under them can be touched.
pub fn ui(ctx: &egui::Context, view: Rect, side: Align, room: f32) {
    let is_small = room < WIDTH + 2.0 * MARGIN || view.height() < HEIGHT;
    let (width, lines) = if is_small { (NARROW, FEW) } else { (WIDTH, ALL) };
    let at = match side {
        Align::Min => view.left_top() + vec2(MARGIN, MARGIN),
        _ => view.right_top() + vec2(-MARGIN - width, MARGIN),
    };
    let area = egui::Area::new(egui::Id::unique("welcome")).fixed_pos(at).order(egui::Order::Middle);
    area.interactable(false).constrain(false).show(ctx, |ui| {
        ui.set_clip_rect(view);
        let frame = egui::Frame::new().fill(egui::Color32::from_black_alpha(150)).corner_radius(6.0);
        frame.inner_margin(egui::Margin::same(12)).show(ui, |ui| {
            ui.set_width(width - 24.0);
            if !is_small {
                ui.add(egui::Label::new(egui::RichText::new("First steps").strong()).wrap());
            }
            for (keys, text) in lines {
                let mut job = egui::text::LayoutJob::default();
                let font = egui::FontId::proportional(theme::TYPE);
                let of = |color| egui::TextFormat { font_id: font.clone(), color, ..egui::TextFormat::default() };
                job.append(keys, 0.0, of(theme::ACCENT));
                job.append(text, 6.0, of(theme::TEXT));
                ui.add(egui::Label::new(job).wrap());
            }
        });
    });
}

/// Whether something was touched in this picture of the window.
pub fn is_over(ctx: &egui::Context) -> bool {
    ctx.input(|input| {
        input.pointer.any_pressed()
            || input.events.iter().any(|event| matches!(event, egui::Event::Key { pressed: true, .. }))
    })
}
