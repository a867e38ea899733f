//! What is said over the view while a take that is kept is seen there: that it is not the scene, and how it differs.

use eframe::egui::{self, Color32, Rect, RichText, Stroke, StrokeKind, vec2};

use super::theme;
use crate::session::Difference;

/// Most differences that are listed.
const MOST: usize = 8;
/// Room to the edges of the view (points).
const MARGIN: f32 = 14.0;
/// Width of the words (points), where the view has so much.
const WIDTH: f32 = 300.0;

/// Draws them. Whatever is under them can be touched.
pub fn ui(ctx: &egui::Context, view: Rect, differences: &[Difference]) {
    let area = egui::Area::new(egui::Id::unique("the take that is kept")).fixed_pos(view.min + vec2(MARGIN, MARGIN));
    area.order(egui::Order::Middle).interactable(false).constrain(false).show(ctx, |ui| {
        ui.set_clip_rect(view);
        let edge = Stroke::new(2.0, theme::ACCENT);
        ui.painter().rect_stroke(view, 0.0, edge, StrokeKind::Inside);
        let frame = egui::Frame::new().fill(Color32::from_black_alpha(170)).corner_radius(6.0);
        frame.inner_margin(egui::Margin::same(10)).show(ui, |ui| {
            ui.set_max_width(WIDTH.min(view.width() - 2.0 * MARGIN - 20.0).max(60.0));
            ui.label(RichText::new("Kept take").color(theme::ACCENT).strong());
            if differences.is_empty() {
                ui.label("It is the same as the scene.");
            }
            for Difference { name, kept, now } in differences.iter().take(MOST) {
                ui.add(egui::Label::new(theme::faint(name)).truncate());
                ui.add(egui::Label::new(format!("{kept}, now {now}")).truncate());
            }
            if differences.len() > MOST {
                ui.label(theme::faint(format!("and {} more", differences.len() - MOST)));
            }
            ui.label(theme::faint("X: back to the scene"));
        });
    });
}
