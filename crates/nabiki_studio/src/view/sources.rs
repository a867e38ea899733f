//! Fans, whirls and points where they stand: where they blow, and how far.

use eframe::egui::{Align2, Color32, FontId, Pos2, Rect, Shape, Stroke, Vec2, pos2, vec2};
use glam::Vec3;
use nabiki_render::View;
use nabiki_scene::scene::FieldSettings;

use super::overlay::{OUTLINE, Overlay};

/// Their colour: that of the wind's small arrows, brighter.
const INK: Color32 = Color32::from_rgb(150, 200, 248);
/// Straight pieces of a circle, and of a line that may pass the eye.
const PIECES: usize = 32;
/// Length of an arrow's head, as a part of the reach, and at most (cm).
const HEAD: f32 = 0.12;
const MOST_HEAD_CM: f32 = 3.0;
/// Points that what lies beyond the edge of the view is shown within it.
const EDGE: f32 = 18.0;

/// One of them, as lines in the space of the forces.
#[derive(Clone, Debug, PartialEq)]
pub struct Source {
    /// What it is called.
    pub name: String,
    /// Where it stands.
    pub place: Vec3,
    /// What it is drawn with.
    pub lines: Vec<[Vec3; 2]>,
}

/// All of a field, in the order of its tracks.
pub fn sources(field: &FieldSettings) -> Vec<Source> {
    let mut all = Vec::new();
    for (n, fan) in field.fan.iter().enumerate() {
        let (ahead, reach) = (direction(fan.direction), fan.falloff.radius);
        let [u, v] = across(ahead);
        let spread = fan.spread.to_radians();
        let rim = circle(fan.position + ahead * reach * spread.cos(), u, v, reach * spread.sin());
        let mut lines: Vec<[Vec3; 2]> = rim.iter().step_by(PIECES / 4).map(|&[at, _]| [fan.position, at]).collect();
        lines.extend(rim);
        let ends = [fan.position, fan.position + ahead * reach];
        lines.extend(arrow(if fan.strength < 0.0 { [ends[1], ends[0]] } else { ends }, reach));
        all.push(Source { name: named("Fan", n, fan.strength), place: fan.position, lines });
    }
    for (n, whirl) in field.vortex.iter().enumerate() {
        let (axis, reach) = (direction(whirl.axis), whirl.falloff.radius);
        let [u, v] = across(axis);
        let mut lines = vec![[whirl.position - axis * reach, whirl.position + axis * reach]];
        for part in [0.5, 1.0] {
            let round = circle(whirl.position, u, v, part * reach);
            // Counter-clockwise as seen from the tip of the axis.
            for way in round.iter().step_by(PIECES / 4) {
                let way = if whirl.strength < 0.0 { [way[1], way[0]] } else { *way };
                lines.extend(barbs(way, axis, reach));
            }
            lines.extend(round);
        }
        all.push(Source { name: named("Whirl", n, whirl.strength), place: whirl.position, lines });
    }
    for (n, point) in field.point.iter().enumerate() {
        let reach = point.falloff.radius;
        let mut lines: Vec<[Vec3; 2]> = [[Vec3::X, Vec3::Y], [Vec3::Y, Vec3::Z], [Vec3::Z, Vec3::X]]
            .into_iter()
            .flat_map(|[u, v]| circle(point.position, u, v, reach))
            .collect();
        for ahead in [Vec3::X, Vec3::Y, Vec3::Z].into_iter().flat_map(|axis| [axis, -axis]) {
            let ends = [point.position + ahead * (0.3 * reach), point.position + ahead * (0.7 * reach)];
            lines.extend(arrow(if point.strength < 0.0 { [ends[1], ends[0]] } else { ends }, reach));
        }
        all.push(Source { name: named("Point", n, point.strength), place: point.position, lines });
    }
    all
}

fn named(kind: &str, n: usize, strength: f32) -> String {
    format!("{kind} {}: {strength}", n + 1)
}

fn direction(way: Vec3) -> Vec3 {
    way.try_normalize().unwrap_or(Vec3::Y)
}

/// Two directions across another, so that the three are right-handed with it last.
fn across(ahead: Vec3) -> [Vec3; 2] {
    let u = ahead.any_orthonormal_vector();
    [u, ahead.cross(u)]
}

/// A circle in straight pieces, from `u` toward `v`.
fn circle(middle: Vec3, u: Vec3, v: Vec3, radius: f32) -> Vec<[Vec3; 2]> {
    let at = |n: usize| {
        let (sin, cos) = (std::f32::consts::TAU * n as f32 / PIECES as f32).sin_cos();
        middle + radius * (cos * u + sin * v)
    };
    (0..PIECES).map(|n| [at(n), at((n + 1) % PIECES)]).collect()
}

/// An arrow of something with such a reach.
fn arrow([from, to]: [Vec3; 2], reach: f32) -> Vec<[Vec3; 2]> {
    let [u, v] = across(direction(to - from));
    let mut lines = vec![[from, to]];
    lines.extend(
        [u, v].into_iter().flat_map(|across| barbs([from, to], across.cross(to - from).normalize_or_zero(), reach)),
    );
    lines
}

/// The two barbs of an arrow's head, in the plane across `normal`.
fn barbs([from, to]: [Vec3; 2], normal: Vec3, reach: f32) -> [[Vec3; 2]; 2] {
    let head = (HEAD * reach).min(MOST_HEAD_CM);
    let along = direction(to - from);
    let aside = normal.cross(along) * 0.5;
    [aside, -aside].map(|aside| [to, to - head * (along - aside)])
}

/// Draws them as a view in the space of the forces sees them.
pub fn draw(overlay: &Overlay<'_>, view: &View, all: &[Source]) {
    let faint = Stroke::new(1.2, INK.gamma_multiply(0.8));
    for source in all {
        for &[from, to] in &source.lines {
            // A long line may pass the eye: what lies before it is drawn.
            let at = |n: usize| overlay.at(view, from.lerp(to, n as f32 / 8.0));
            if let (Some(from), Some(to)) = (overlay.at(view, from), overlay.at(view, to)) {
                overlay.painter.line_segment([from, to], faint);
                continue;
            }
            for n in 0..8 {
                if let (Some(from), Some(to)) = (at(n), at(n + 1)) {
                    overlay.painter.line_segment([from, to], faint);
                }
            }
        }
        let (at, beyond) = label_at(overlay.rect, overlay.at(view, source.place), toward(view, source.place));
        if let Some(way) = beyond {
            let tip = at + way * 8.0;
            let side = way.rot90() * 5.0;
            let corners = vec![tip, at + side, at - side];
            overlay.painter.add(Shape::convex_polygon(corners, INK, Stroke::new(1.0, OUTLINE)));
        } else {
            overlay.painter.circle(at, 3.5, INK, Stroke::new(1.0, OUTLINE));
        }
        words(overlay, at, &source.name);
    }
}

/// Which way a place lies from the middle of the view, on the screen; for what lies behind the eye, too.
fn toward(view: &View, place: Vec3) -> Vec2 {
    let way = place - view.eye;
    let way = vec2(way.dot(view.right), -way.dot(view.up));
    if way.length() > 1e-6 { way.normalized() } else { vec2(0.0, 1.0) }
}

/// Where a source's name stands: at its place, or at the edge beyond which that lies, with the way there.
fn label_at(rect: Rect, place: Option<Pos2>, toward: Vec2) -> (Pos2, Option<Vec2>) {
    let room = rect.shrink(EDGE.min(0.25 * rect.size().min_elem()));
    if let Some(place) = place.filter(|place| room.contains(*place)) {
        return (place, None);
    }
    let middle = room.center();
    let way = match place {
        Some(place) if (place - middle).length() > 1.0 => (place - middle).normalized(),
        _ => toward,
    };
    let part = [(way.x, room.width()), (way.y, room.height())]
        .map(|(way, side)| if way.abs() > 1e-6 { 0.5 * side / way.abs() } else { f32::INFINITY });
    (middle + way * part[0].min(part[1]), Some(way))
}

fn words(overlay: &Overlay<'_>, at: Pos2, text: &str) {
    let galley = overlay.painter.layout_no_wrap(text.to_owned(), FontId::proportional(12.0), INK);
    let size = galley.size() + vec2(8.0, 4.0);
    // On the side where there is room.
    let x = if at.x + 12.0 + size.x < overlay.rect.right() { at.x + 10.0 } else { at.x - 10.0 - size.x };
    let y = (at.y - 0.5 * size.y)
        .clamp(overlay.rect.top() + 2.0, (overlay.rect.bottom() - size.y - 2.0).max(overlay.rect.top() + 2.0));
    let ground = Align2::LEFT_TOP.anchor_size(pos2(x, y), size);
    overlay.painter.rect_filled(ground, 3.0, Color32::from_black_alpha(150));
    overlay.painter.galley(ground.min + vec2(4.0, 2.0), galley, INK);
}

#[cfg(test)]
mod tests {
    use nabiki_render::Bounds;
    use nabiki_render::settings::Camera;
    use nabiki_scene::Scene;

    use super::*;
    use crate::view::camera::Orbit;

    fn field(text: &str) -> FieldSettings {
        Scene::parse(text, "a.toml".as_ref(), &[]).unwrap().field
    }

    #[test]
    fn what_is_drawn_of_a_source_lies_within_its_reach_and_points_where_it_blows() {
        let text = "[[fan]]\nposition = [40, 0, 0]\ndirection = [-2, 0, 0]\nspread = 20\nfalloff = { radius = 50 }\n\
                    [[vortex]]\nposition = [0, 5, 0]\naxis = [0, 3, 0]\nstrength = 9\nfalloff = { radius = 10 }\n\
                    [[point]]\nposition = [1, 2, 3]\nstrength = -7\nfalloff = { radius = 8 }\n";
        let all = sources(&field(text));
        let names: Vec<&str> = all.iter().map(|source| source.name.as_str()).collect();
        assert_eq!(names, ["Fan 1: 50", "Whirl 1: 9", "Point 1: -7"]);
        let most = [50.0, 10.0 * 2.0_f32.sqrt(), 8.0];
        for (source, most) in all.iter().zip(most) {
            let farthest = source.lines.iter().flatten().map(|p| p.distance(source.place)).fold(0.0, f32::max);
            assert!(farthest <= most + 1e-3 && farthest >= 0.99 * most.min(10.0), "{}: {farthest}", source.name);
            assert!(source.lines.iter().flatten().all(|p| p.is_finite()));
        }
        // The fan blows backward and no wider than its cone.
        for p in all[0].lines.iter().flatten().filter(|p| p.distance(all[0].place) > 10.0) {
            let way = (*p - all[0].place).normalize();
            assert!(way.dot(Vec3::NEG_X) > 19.9_f32.to_radians().cos() - 0.01 || way.dot(Vec3::NEG_X) > 0.93, "{p}");
        }
    }

    #[test]
    fn a_source_that_the_view_does_not_show_is_named_at_its_edge() {
        let rect = Rect::from_min_size(pos2(10.0, 20.0), vec2(800.0, 500.0));
        let camera = Camera { distance: Some(90.0), target: Some(Vec3::ZERO), ..Camera::default() };
        let view = Orbit::new(&camera, [800, 500], &Bounds::default()).view([800, 500], Vec3::ZERO);
        for place in [Vec3::ZERO, Vec3::X * 3000.0, Vec3::X * -3000.0, Vec3::Y * 3000.0, Vec3::Z * -3000.0] {
            let on_screen = (view.project(place).z >= nabiki_render::camera::NEAR).then(|| {
                let p = view.project(place);
                rect.min + vec2(p.x, p.y)
            });
            let (at, beyond) = label_at(rect, on_screen, toward(&view, place));
            assert!(rect.contains(at), "{place}: {at}");
            assert_eq!(beyond.is_none(), place == Vec3::ZERO, "{place}");
        }
    }
}
