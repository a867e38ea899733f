//! Vectors as arrows in a circle, to be dragged.

use eframe::egui::{self, Pos2, Sense, Stroke, Ui, Vec2, pos2, vec2};
use glam::Vec3;

use crate::command::Command;
use crate::panels::hands::Hands;
use crate::panels::{Commands, theme};

/// From where vectors are seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Seen {
    FromHerRight,
    FromAbove,
}

impl Seen {
    /// The part of a vector that is seen, as it lies on the screen.
    pub fn flat(self, vector: Vec3) -> Vec2 {
        match self {
            Self::FromHerRight => vec2(vector.x, -vector.y),
            Self::FromAbove => vec2(vector.x, vector.z),
        }
    }

    /// A vector with that part another.
    pub fn with(self, vector: Vec3, flat: Vec2) -> Vec3 {
        match self {
            Self::FromHerRight => Vec3::new(flat.x, -flat.y, vector.z),
            Self::FromAbove => Vec3::new(flat.x, vector.y, flat.y),
        }
    }

    /// A vector whose arrow, or one of several, is dragged to `way`: alone it ends there, among others it turns there.
    pub fn turned(self, vector: Vec3, way: Vec2, of: &[usize]) -> Vec3 {
        if of.len() == 1 {
            return self.with(vector, way);
        }
        let long = self.flat(vector).length();
        if way.length() > 0.0 { self.with(vector, way.normalized() * long) } else { vector }
    }
}

/// How large a circle is, and for which vectors: it stays so after a drag, or the tip would leap from the hand.
#[derive(Clone, Debug, PartialEq)]
struct Reach {
    of: Vec<usize>,
    vectors: Vec<Vec3>,
    reach: f32,
}

/// Draws a circle with the vectors of the intervals `of`; where the tip is dragged to (in the unit of the force), if it is.
pub fn dial(
    ui: &mut Ui,
    side: f32,
    seen: Seen,
    of: &[usize],
    vectors: &[Vec3],
    commands: &mut Commands,
) -> Option<Vec2> {
    let (rect, response) = ui.allocate_exact_size(vec2(side, side), Sense::click_and_drag());
    let (name, help) = match seen {
        Seen::FromHerRight => {
            ("Dial from the right", "Seen from the character's right; she looks to the right. Drag the arrow.")
        }
        Seen::FromAbove => ("Dial from above", "Seen from above; she looks to the right. Drag the arrow."),
    };
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Slider, true, name));
    let (centre, radius) = (rect.center(), side / 2.0 - 3.0);
    let id = response.id.with("reach");
    let known = ui.data(|data| data.get_temp::<Reach>(id)).filter(|known| known.of == of);
    let reach = reach(known.as_ref(), vectors, response.dragged() || response.drag_stopped());
    let scale = radius / reach;
    let dragged = response.held_at().map(|pointer| (pointer - centre) / scale);
    if response.drag_stopped() {
        commands.push(Command::EndDrag);
    }
    // What is dragged here is what comes next.
    let comes = |vector: &Vec3| dragged.map_or(*vector, |way| super::rounded(seen.turned(*vector, way, of)));
    let vectors_to_come: Vec<Vec3> = vectors.iter().map(comes).collect();
    ui.data_mut(|data| data.insert_temp(id, Reach { of: of.to_vec(), vectors: vectors_to_come, reach }));
    paint(ui, &response, (centre, radius), vectors.iter().map(|vector| seen.flat(*vector) * scale));
    let help = match of.len() {
        1 => help.to_owned(),
        _ => format!("{help} All selected vectors turn there and keep their strengths."),
    };
    response.hint(format!("{help}\nThe radius of the circle is {reach}."));
    dragged
}

/// The circle grows by powers of two, so that arrows fit, and does not change under a hand, nor when that lets go.
fn reach(known: Option<&Reach>, vectors: &[Vec3], held: bool) -> f32 {
    let longest = vectors.iter().map(|vector| vector.length()).fold(25.0, f32::max);
    let fitting = 50.0 * 2.0_f32.powf((longest * 1.2 / 50.0).log2().ceil());
    match known {
        Some(known) if held => known.reach,
        // Let go beyond its edge, an arrow would not show how long it is.
        Some(known) if known.vectors == vectors && longest <= known.reach => known.reach,
        _ => fitting,
    }
}

fn paint(ui: &Ui, response: &egui::Response, (centre, radius): (Pos2, f32), arrows: impl Iterator<Item = Vec2>) {
    let painter = ui.painter();
    painter.circle(centre, radius, theme::GROUND, Stroke::new(1.0, theme::LINE));
    painter.hline(centre.x - radius..=centre.x + radius, centre.y, Stroke::new(1.0, theme::LINE));
    painter.vline(centre.x, centre.y - radius..=centre.y + radius, Stroke::new(1.0, theme::LINE));
    // The head, so that it is seen where she looks.
    painter.circle_filled(centre, 7.0, egui::Color32::from_gray(52));
    painter.circle_filled(pos2(centre.x + 7.5, centre.y), 2.0, egui::Color32::from_gray(52));
    let ink = if response.hovered() || response.dragged() { theme::ACCENT } else { theme::ACCENT.gamma_multiply(0.85) };
    for flat in arrows {
        let flat = if flat.length() > radius { flat.normalized() * radius } else { flat };
        let tip = centre + flat;
        painter.line_segment([centre, tip], Stroke::new(2.0, ink));
        painter.circle_filled(tip, 4.0, ink);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_circle_keeps_its_size_under_a_hand_and_when_that_lets_go_until_the_vector_is_another() {
        let long = Vec3::new(-300.0, 0.0, 0.0);
        let of_long = reach(None, &[long], false);
        assert!((300.0..=800.0).contains(&of_long));
        let known = |vector: Vec3| Reach { of: vec![0], vectors: vec![vector], reach: of_long };
        let short = Vec3::new(-20.0, 0.0, 0.0);
        assert_eq!(reach(Some(&known(long)), &[short], true), of_long);
        assert_eq!(reach(Some(&known(short)), &[short], false), of_long, "let go, the tip stays where it is");
        assert!(reach(Some(&known(short)), &[Vec3::X], false) < of_long);
        let out = Vec3::new(-5000.0, 0.0, 0.0);
        assert!(reach(Some(&known(out)), &[out], false) > 5000.0);
    }
}
