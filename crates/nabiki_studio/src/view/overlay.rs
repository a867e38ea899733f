//! What is drawn over the picture: the handle, the thread from hand to hair, nails, words.

use eframe::egui::{Align2, Color32, FontId, Painter, Pos2, Rect, Shape, Stroke, Vec2, vec2};
use glam::Vec3;
use nabiki_render::View;

use super::handle::Arrow;
use crate::panels::theme::NAIL;

/// Of what can be taken hold of.
const ACCENT: Color32 = Color32::from_rgb(255, 176, 64);
/// Of what a hand holds.
const HELD: Color32 = Color32::from_rgb(255, 222, 150);
/// About lines, so that they show on bright hair as on dark.
pub const OUTLINE: Color32 = Color32::from_black_alpha(140);

/// Between words and the ring about the end of their line (points).
const BESIDE: f32 = 12.0;

/// The painter of a view, which knows where places of space are.
pub struct Overlay<'a> {
    /// Clipped to the view.
    pub painter: &'a Painter,
    /// The view on the screen.
    pub rect: Rect,
    /// Pixels to a point.
    pub scale: f32,
}

impl Overlay<'_> {
    /// Where a place is on the screen, if it is before the eye.
    pub fn at(&self, view: &View, place: Vec3) -> Option<Pos2> {
        let p = view.project(place);
        (p.z >= nabiki_render::camera::NEAR).then(|| self.rect.min + vec2(p.x, p.y) / self.scale)
    }

    /// The handle of a force.
    pub fn handle(&self, view: &View, arrow: &Arrow, held: bool) {
        let (Some(foot), Some(tip)) = (self.at(view, arrow.foot), self.at(view, arrow.tip)) else { return };
        let colour = if held { HELD } else { ACCENT };
        let way = tip - foot;
        let along = if way.length() > 1.0 { way.normalized() } else { vec2(0.0, 0.0) };
        let across = vec2(-along.y, along.x);
        let neck = tip - along * 13.0_f32.min(way.length());
        // An arrow that is drawn shorter than its force is long says so: its shaft is broken.
        let whole = if arrow.part < 1.0 { foot + 0.5 * (neck - foot) } else { neck };
        for (width, colour) in [(5.0, OUTLINE), (2.5, colour)] {
            self.painter.line_segment([foot, whole], Stroke::new(width, colour));
            self.painter.extend(Shape::dashed_line(&[whole, neck], Stroke::new(width, colour), 5.0, 6.0));
        }
        if way.length() > 1.0 {
            let corners = vec![tip, neck + across * 6.0, neck - across * 6.0];
            self.painter.add(Shape::convex_polygon(corners, colour, Stroke::new(1.0, OUTLINE)));
        }
        self.painter.circle(foot, 3.0, colour, Stroke::new(1.0, OUTLINE));
        let radius = if held { 8.0 } else { 6.0 };
        self.painter.circle_stroke(tip, radius + 1.0, Stroke::new(3.0, OUTLINE));
        self.painter.circle_stroke(tip, radius + 1.0, Stroke::new(1.5, colour));
        let force = arrow.force();
        let number = format!("{:.0}   ({:.0}, {:.0}, {:.0})", force.length(), force.x, force.y, force.z);
        self.words([foot, tip], &number, colour);
    }

    /// The thread from where the hand holds to where the hair is, with words at the hand. Returns where those are.
    pub fn thread(&self, view: &View, hand: Vec3, hair: Vec3, words: Option<&str>) -> Option<Rect> {
        let (from, to) = (self.at(view, hand)?, self.at(view, hair)?);
        for (width, colour) in [(3.5, OUTLINE), (1.5, HELD)] {
            self.painter.line_segment([from, to], Stroke::new(width, colour));
        }
        self.painter.circle(to, 3.0, HELD, Stroke::new(1.0, OUTLINE));
        self.painter.circle_stroke(from, 8.0, Stroke::new(1.5, HELD));
        words.map(|words| self.words([to, from], words, HELD))
    }

    /// A node that could be taken hold of.
    pub fn hint(&self, view: &View, place: Vec3) {
        if let Some(at) = self.at(view, place) {
            self.painter.circle_stroke(at, 6.0, Stroke::new(3.0, OUTLINE));
            self.painter.circle_stroke(at, 6.0, Stroke::new(1.5, ACCENT));
        }
    }

    /// A nail.
    pub fn nail(&self, view: &View, place: Vec3, is_of_this_frame: bool) {
        let Some(at) = self.at(view, place) else { return };
        let colour = if is_of_this_frame { NAIL } else { NAIL.gamma_multiply(0.4) };
        let arm = |d: Vec2| [at - d, at + d];
        for d in [vec2(4.0, 4.0), vec2(4.0, -4.0)] {
            self.painter.line_segment(arm(d), Stroke::new(4.0, OUTLINE));
            self.painter.line_segment(arm(d), Stroke::new(2.0, colour));
        }
    }

    /// The edge of a brush of this radius (points).
    pub fn brush(&self, at: Pos2, radius: f32) {
        self.painter.circle_stroke(at, radius, Stroke::new(3.0, OUTLINE));
        self.painter.circle_stroke(at, radius, Stroke::new(1.5, HELD));
    }

    /// The line of a lasso, which closes by itself.
    pub fn lasso(&self, line: &[Pos2]) {
        for (width, colour) in [(3.5, OUTLINE), (1.5, HELD)] {
            self.painter.add(Shape::closed_line(line.to_vec(), Stroke::new(width, colour)));
        }
    }

    /// Small words with a dark ground, at the second end of a line.
    fn words(&self, line: [Pos2; 2], words: &str, colour: Color32) -> Rect {
        let galley = self.painter.layout_no_wrap(words.to_owned(), FontId::proportional(13.0), colour);
        let ground = beside(self.rect, line, galley.size() + vec2(8.0, 4.0));
        self.painter.rect_filled(ground, 3.0, Color32::from_black_alpha(150));
        self.painter.galley(ground.min + vec2(4.0, 2.0), galley, colour);
        ground
    }

    /// Words where there is no picture.
    pub fn instead(&self, words: &str) {
        self.painter.rect_filled(self.rect, 0.0, Color32::from_gray(38));
        let galley = self.painter.layout(
            words.to_owned(),
            FontId::proportional(15.0),
            Color32::from_gray(190),
            (self.rect.width() - 40.0).max(80.0),
        );
        let at = Align2::CENTER_CENTER.anchor_size(self.rect.center(), galley.size());
        self.painter.galley(at.min, galley, Color32::from_gray(190));
    }
}

/// The place of words of such a size within a view: as near to the second end of a line as they can be without covering it, on past
/// that end where there is a choice.
fn beside(view: Rect, [from, to]: [Pos2; 2], size: Vec2) -> Rect {
    let way = to - from;
    let along = if way.length() > 1.0 { way.normalized() } else { vec2(1.0, -1.0).normalized() };
    let room = view.shrink(3.0);
    let within = |place: Rect| {
        let spare = (room.size() - size).max(Vec2::ZERO);
        Rect::from_min_size(place.min.clamp(room.min, room.min + spare), size)
    };
    let points = (way.length() / 4.0) as usize + 1;
    let is_clear = |place: &Rect| {
        let about = place.expand(0.7 * BESIDE);
        (0..=points).all(|n| !about.contains(from + way * (n as f32 / points as f32)))
    };
    // Beside it or above and below it, its ends or its middle at that of the line.
    let half = 0.5 * size + Vec2::splat(BESIDE);
    let ways = [-1.0, -0.5, 0.0, 0.5, 1.0];
    let beside = ways.iter().flat_map(|&part| [-1.0, 1.0].map(|side| vec2(side * half.x, part * half.y)));
    let above = ways.iter().flat_map(|&part| [-1.0, 1.0].map(|side| vec2(part * half.x, side * half.y)));
    let places = beside.chain(above).map(|d| within(Rect::from_center_size(to + d, size)));
    let far = |place: &Rect| place.distance_to_pos(to) - 4.0 * (place.center() - to).normalized().dot(along);
    let nearest = |a: &Rect, b: &Rect| far(a).total_cmp(&far(b));
    let before = within(Rect::from_center_size(from - along * (half.length() + BESIDE), size));
    places.filter(is_clear).min_by(nearest).unwrap_or(before)
}

#[cfg(test)]
mod tests {
    use eframe::egui::pos2;

    use super::*;

    #[test]
    fn words_lie_within_the_view_and_not_on_their_line() {
        let view = Rect::from_min_size(pos2(10.0, 20.0), vec2(900.0, 480.0));
        let size = vec2(120.0, 20.0);
        for turn in 0..24 {
            for length in [0.0, 12.0, 60.0, 300.0] {
                for to in
                    [pos2(35.0, 45.0), pos2(450.0, 45.0), pos2(880.0, 45.0), pos2(450.0, 240.0), pos2(885.0, 475.0)]
                {
                    let way = Vec2::angled(turn as f32 * std::f32::consts::TAU / 24.0) * length;
                    let from = to - way;
                    if !view.contains(from) {
                        continue;
                    }
                    let place = beside(view, [from, to], size);
                    assert!(view.contains_rect(place), "{from} {to}: {place}");
                    let least =
                        (0..=50).map(|n| place.distance_to_pos(from + way * (n as f32 / 50.0))).fold(1e9, f32::min);
                    assert!(least >= 7.0, "{from} {to}: {place} is {least} from its line");
                }
            }
        }
    }
}
