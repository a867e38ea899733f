//! The tools over the view, and how the one at hand is set.

use eframe::egui::{self, Rect, Ui, pos2, vec2};
use nabiki::region::Region;

use super::Shown;
use crate::panels::hands::Hands;
use crate::panels::theme;
use crate::tools::{RADII, Stroke, Tool, Tools};

const TOOLS: [(Tool, &str, &str); 3] = [
    (Tool::Pull, "Pull", "Drag hair: the wind changes to bring it there."),
    (Tool::Paint, "Paint", "Drag over hair: it belongs to a region (B)."),
    (Tool::Comb, "Comb", "Drag hair in this frame: an aim leads it there (H)."),
];

/// Draws them at the upper left of the view. Returns where they lie, and what is set otherwise.
pub fn ui(ui: &mut Ui, rect: Rect, shown: &Shown<'_>) -> (Rect, Option<Tools>) {
    let mut tools = shown.tools.clone();
    let place = Rect::from_min_max(rect.min + vec2(8.0, 8.0), pos2(rect.right() - 8.0, rect.top() + 40.0));
    let mut bar =
        ui.new_child(egui::UiBuilder::new().max_rect(place).layout(egui::Layout::left_to_right(egui::Align::Min)));
    let drawn = egui::Frame::new()
        .fill(theme::PANEL.gamma_multiply(0.85))
        .corner_radius(4.0)
        .inner_margin(egui::Margin::symmetric(6, 3))
        .show(&mut bar, |ui| {
            ui.horizontal(|ui| {
                for (tool, name, help) in TOOLS {
                    if ui.selectable_label(tools.tool == tool, name).hint(help).clicked() {
                        tools.tool = tool;
                    }
                }
                match tools.tool {
                    Tool::Pull => {}
                    Tool::Paint => brush(ui, &mut tools, shown.regions),
                    Tool::Comb => {
                        ui.separator();
                        radius(ui, &mut tools);
                    }
                }
            });
        });
    (drawn.response.rect, (tools != *shown.tools).then_some(tools))
}

fn brush(ui: &mut Ui, tools: &mut Tools, regions: &[Region]) {
    ui.separator();
    let name = |i: usize| match regions.get(i) {
        Some(region) if !region.name.is_empty() => region.name.clone(),
        _ => format!("region {}", i + 1),
    };
    let now = tools.region.filter(|&i| i < regions.len()).map_or_else(|| "new region".to_owned(), name);
    let combo = egui::ComboBox::from_id_salt("painted region").selected_text(now).width(110.0).truncate();
    let response = combo.show_ui(ui, |ui| {
        for i in 0..regions.len() {
            ui.selectable_value(&mut tools.region, Some(i), name(i));
        }
        ui.selectable_value(&mut tools.region, None, "new region");
    });
    response.response.accessible_name("Painted region").hint("The region that the brush paints.");
    for (stroke, name) in Stroke::ALL {
        let help = match stroke {
            Stroke::Add => "Adds hair to the region.",
            Stroke::Erase => "Takes hair out of the region. Ctrl does so with any brush.",
            Stroke::Smooth => "Evens the weights out. Shift does so with any brush.",
            Stroke::Lasso => "Draw around hair to add it, with Ctrl to take it out.",
        };
        if ui.selectable_label(tools.stroke == stroke, name).hint(help).clicked() {
            tools.stroke = stroke;
        }
    }
    if tools.stroke != Stroke::Lasso {
        radius(ui, tools);
    }
    let strength = egui::DragValue::new(&mut tools.strength).range(0.05..=1.0).speed(0.01).prefix("strength ");
    ui.add(strength).accessible_name("Brush strength").hint("How much of its weight a stroke gives.");
    ui.checkbox(&mut tools.mirror, "mirror").hint("Does the same on the other side of the head.");
}

fn radius(ui: &mut Ui, tools: &mut Tools) {
    let radius = egui::DragValue::new(&mut tools.radius).range(RADII).speed(0.5).max_decimals(0).prefix("size ");
    ui.add(radius).accessible_name("Brush size").hint("Radius of the brush. [ and ] change it.");
}
