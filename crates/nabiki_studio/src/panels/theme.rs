//! How it all looks: dark, neutral, one warm colour for what is chosen.

use eframe::egui::{self, Color32, CornerRadius, FontFamily, FontId, Margin, Stroke, TextStyle, Vec2};

/// What is chosen, and the frame shown.
pub const ACCENT: Color32 = Color32::from_rgb(226, 164, 92);
/// What went wrong.
pub const WRONG: Color32 = Color32::from_rgb(232, 110, 96);
/// What went well.
pub const GOOD: Color32 = Color32::from_rgb(132, 186, 120);
/// Nails.
pub const NAIL: Color32 = Color32::from_rgb(120, 205, 255);
/// Behind everything.
pub const GROUND: Color32 = Color32::from_gray(24);
/// Behind panels.
pub const PANEL: Color32 = Color32::from_gray(32);
/// Thin lines.
pub const LINE: Color32 = Color32::from_gray(50);
/// Type.
pub const TEXT: Color32 = Color32::from_gray(205);
/// Type that stands back.
pub const FAINT: Color32 = Color32::from_gray(135);
/// The three axes.
pub const AXES: [Color32; 3] =
    [Color32::from_rgb(222, 104, 98), Color32::from_rgb(126, 184, 96), Color32::from_rgb(98, 146, 226)];

/// Size of the type (points).
pub const TYPE: f32 = 13.0;
/// Size of type that stands back (points).
pub const SMALL: f32 = 11.5;

/// Gives a window its look.
pub fn apply(ctx: &egui::Context) {
    ctx.set_theme(egui::Theme::Dark);
    ctx.all_styles_mut(|style| {
        style.text_styles = [
            (TextStyle::Small, FontId::new(SMALL, FontFamily::Proportional)),
            (TextStyle::Body, FontId::new(TYPE, FontFamily::Proportional)),
            (TextStyle::Button, FontId::new(TYPE, FontFamily::Proportional)),
            (TextStyle::Heading, FontId::new(16.0, FontFamily::Proportional)),
            (TextStyle::Monospace, FontId::new(12.0, FontFamily::Monospace)),
        ]
        .into();
        let spacing = &mut style.spacing;
        spacing.item_spacing = Vec2::new(6.0, 4.0);
        spacing.button_padding = Vec2::new(8.0, 2.0);
        spacing.interact_size = Vec2::new(36.0, 20.0);
        spacing.window_margin = Margin::same(14);
        spacing.menu_margin = Margin::same(6);
        spacing.indent = 12.0;
        spacing.scroll = egui::style::ScrollStyle::thin();
        style.interaction.tooltip_delay = 0.4;
        style.interaction.selectable_labels = false;
        style.animation_time = 0.08;
        let visuals = &mut style.visuals;
        *visuals = egui::Visuals::dark();
        visuals.panel_fill = PANEL;
        visuals.window_fill = Color32::from_gray(38);
        visuals.window_stroke = Stroke::new(1.0, Color32::from_gray(58));
        visuals.extreme_bg_color = GROUND;
        visuals.faint_bg_color = Color32::from_gray(36);
        visuals.selection.bg_fill = ACCENT.gamma_multiply(0.45);
        visuals.selection.stroke = Stroke::new(1.0, Color32::from_gray(240));
        visuals.hyperlink_color = ACCENT;
        visuals.warn_fg_color = ACCENT;
        visuals.error_fg_color = WRONG;
        visuals.window_shadow.color = Color32::from_black_alpha(110);
        visuals.popup_shadow.color = Color32::from_black_alpha(90);
        visuals.window_corner_radius = CornerRadius::same(6);
        visuals.menu_corner_radius = CornerRadius::same(4);
        visuals.slider_trailing_fill = true;
        // A cursor that blinks has the whole window drawn twice a second.
        visuals.text_cursor.blink = false;
        visuals.collapsing_header_frame = false;
        let widgets = &mut visuals.widgets;
        widgets.noninteractive.bg_stroke = Stroke::new(1.0, LINE);
        widgets.noninteractive.fg_stroke = Stroke::new(1.0, TEXT);
        for (widget, fill, ink) in [
            (&mut widgets.inactive, 48, 205),
            (&mut widgets.hovered, 60, 235),
            (&mut widgets.active, 72, 250),
            (&mut widgets.open, 54, 230),
        ] {
            widget.bg_fill = Color32::from_gray(fill);
            widget.weak_bg_fill = Color32::from_gray(fill);
            widget.fg_stroke = Stroke::new(1.0, Color32::from_gray(ink));
            widget.bg_stroke = Stroke::NONE;
            widget.corner_radius = CornerRadius::same(3);
            widget.expansion = 0.0;
        }
    });
}

/// Type that stands back.
pub fn faint(text: impl Into<String>) -> egui::RichText {
    egui::RichText::new(text).color(FAINT)
}
