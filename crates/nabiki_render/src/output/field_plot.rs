//! A force field over time, drawn as Figure 10 of the paper draws it: its vectors as a polyline, projected on the yz and
//! zx planes.

use std::io::Write;
use std::path::Path;

use glam::Vec3;

use super::canvas::Canvas;
use super::write_whole;
use crate::RenderError;

/// One interval of the field: the last frame at which it holds, and the vector (head space).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Last frame of the interval.
    pub through: u32,
    /// The force.
    pub vector: Vec3,
}

/// Side of each of the two drawings, and the border around it (pixels or SVG units).
const SIDE: f32 = 360.0;
const BORDER: f32 = 44.0;
const WIDTH: f32 = 2.0 * SIDE + 3.0 * BORDER;
/// Height of capitals, and distance of the lines of the legend.
const TEXT: f32 = 9.0;
const LINE: f32 = 18.0;
/// Lines that the legend may have before it says how many intervals it leaves out.
const LINES: usize = 16;

/// A line, arrow or caption of the drawing.
enum Mark {
    Axis([f32; 2], [f32; 2]),
    Path(Vec<[f32; 2]>),
    Arrow([f32; 2], [f32; 2]),
    Dot([f32; 2]),
    Text(String, [f32; 2]),
}

/// Both projections: z to the right and y up; then x to the right and z down, seen from above with the face to the right.
fn marks(field: &[Interval]) -> Vec<Mark> {
    let largest = field.iter().fold(0.0_f32, |m, i| m.max(i.vector.abs().max_element()));
    let scale = if largest > 0.0 { 0.44 * SIDE / largest } else { 1.0 };
    type Plane = (fn(Vec3) -> [f32; 2], &'static str, &'static str, &'static str);
    let planes: [Plane; 2] = [(|v| [v.z, -v.y], "z", "y", "yz plane"), (|v| [v.x, v.z], "x", "z", "zx plane")];
    let mut marks = Vec::new();
    for (p, (project, across, upright, title)) in planes.into_iter().enumerate() {
        let origin = [BORDER + SIDE / 2.0 + p as f32 * (SIDE + BORDER), BORDER + SIDE / 2.0];
        let at = |v: Vec3| {
            let [x, y] = project(v);
            [origin[0] + scale * x, origin[1] + scale * y]
        };
        let half = SIDE / 2.0;
        marks.push(Mark::Axis([origin[0] - half, origin[1]], [origin[0] + half, origin[1]]));
        marks.push(Mark::Axis([origin[0], origin[1] - half], [origin[0], origin[1] + half]));
        marks.push(Mark::Text(across.into(), [origin[0] + half - 12.0, origin[1] - 6.0]));
        // The vertical axis of the second drawing points down: its end is at the bottom.
        let end = if p == 0 { origin[1] - half + 10.0 } else { origin[1] + half };
        marks.push(Mark::Text(upright.into(), [origin[0] + 6.0, end]));
        marks.push(Mark::Text(title.into(), [origin[0] - half, BORDER - 14.0]));
        for interval in field {
            marks.push(Mark::Arrow(origin, at(interval.vector)));
        }
        marks.push(Mark::Path(field.iter().map(|i| at(i.vector)).collect()));
        // Vectors with the same projection share one caption: the numbers of their intervals.
        let mut captions: Vec<([f32; 2], Vec<usize>)> = Vec::new();
        for (i, interval) in field.iter().enumerate() {
            let place = at(interval.vector);
            match captions.iter_mut().find(|(p, _)| (p[0] - place[0]).hypot(p[1] - place[1]) < 14.0) {
                Some((_, numbers)) => numbers.push(i + 1),
                None => captions.push((place, vec![i + 1])),
            }
        }
        for (place, numbers) in captions {
            marks.push(Mark::Dot(place));
            let text = caption(&numbers);
            let x = (place[0] + 7.0).min(WIDTH - width(&text) - 4.0);
            let below = if place[1] > origin[1] { 16.0 } else { -8.0 };
            marks.push(Mark::Text(text, [x, place[1] + below]));
        }
    }
    for (row, text) in legend(field).into_iter().enumerate() {
        marks.push(Mark::Text(text, [BORDER, SIDE + 2.0 * BORDER - 12.0 + row as f32 * LINE]));
    }
    marks
}

/// Width and height of the whole drawing: the legend takes the lines it needs.
fn size(field: &[Interval]) -> [f32; 2] {
    [WIDTH, SIDE + 2.0 * BORDER + (legend(field).len() - 1) as f32 * LINE]
}

/// Width of a text in the PNG, whose letters are wider than those of common fonts in the SVG.
fn width(text: &str) -> f32 {
    Canvas::caption_width(text, TEXT)
}

/// The numbers of intervals, those that follow one another as a range; no wider than half of a drawing.
fn caption(numbers: &[usize]) -> String {
    let ranges: Vec<&[usize]> = numbers.chunk_by(|a, b| a + 1 == *b).collect();
    let told = |shown: usize| {
        let names: Vec<String> = ranges[..shown]
            .iter()
            .map(|range| match range {
                [first, .., last] => format!("{first}-{last}"),
                [only] => only.to_string(),
                [] => String::new(),
            })
            .collect();
        let left: usize = ranges[shown..].iter().map(|range| range.len()).sum();
        let rest = if left > 0 { format!(" and {left} more") } else { String::new() };
        names.join(", ") + &rest
    };
    let shown = (1..=ranges.len()).rev().find(|&shown| width(&told(shown)) <= SIDE / 2.0);
    told(shown.unwrap_or(1))
}

/// Which frames each interval holds, in lines as wide as both drawings.
fn legend(field: &[Interval]) -> Vec<String> {
    let mut from = 1;
    let mut lines = vec!["frames".to_owned()];
    for (i, interval) in field.iter().enumerate() {
        let comma = if i + 1 < field.len() { "," } else { "" };
        let text = format!("({}) {from} to {}{comma}", i + 1, interval.through);
        from = interval.through + 1;
        let line = lines.last().map_or(String::new(), |line| format!("{line} {text}"));
        let rest = format!("and {} more", field.len() - i);
        // The last line keeps room for the rest, unless this is the end of it.
        let room = if lines.len() == LINES && !comma.is_empty() { width(&format!(" {rest}")) } else { 0.0 };
        if width(&line) + room <= WIDTH - 2.0 * BORDER {
            lines.pop();
            lines.push(line);
        } else if lines.len() < LINES {
            lines.push(text);
        } else {
            let line = lines.pop().unwrap_or_default();
            lines.push(format!("{line} {rest}"));
            break;
        }
    }
    lines
}

/// Writes the projections as a PNG file.
pub fn write_png(path: &Path, field: &[Interval]) -> Result<(), RenderError> {
    let mut canvas = Canvas::new(size(field).map(|s| s as usize), [255; 3]);
    for mark in marks(field) {
        match mark {
            Mark::Axis(a, b) => canvas.stroke(&[a, b], 1.0, [170; 3]),
            Mark::Path(line) => canvas.stroke(&line, 1.6, [30, 90, 170]),
            Mark::Arrow(a, b) => canvas.arrow(a, b, 1.3, [205, 110, 30]),
            Mark::Dot(p) => canvas.stroke(&[p], 6.0, [30, 90, 170]),
            Mark::Text(text, at) => canvas.caption(&text, at, TEXT, [40; 3]),
        }
    }
    canvas.write_png(path)
}

/// Writes the projections as an SVG file.
pub fn write_svg(path: &Path, field: &[Interval]) -> Result<(), RenderError> {
    write_whole(path, |file| Ok(file.write_all(svg(field).as_bytes())?))
}

fn svg(field: &[Interval]) -> String {
    let [width, height] = size(field);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\">\n\
         <defs><marker id=\"head\" viewBox=\"0 0 10 10\" refX=\"10\" refY=\"5\" markerWidth=\"7\" markerHeight=\"7\" \
         orient=\"auto\"><path d=\"M0 0L10 5L0 10z\" fill=\"#cd6e1e\"/></marker></defs>\n\
         <rect width=\"{width}\" height=\"{height}\" fill=\"#fff\"/>\n"
    );
    for mark in marks(field) {
        let line = match mark {
            Mark::Axis(a, b) => {
                format!("<path d=\"M{:.1} {:.1}L{:.1} {:.1}\" stroke=\"#aaa\"/>", a[0], a[1], b[0], b[1])
            }
            Mark::Arrow(a, b) => format!(
                "<path d=\"M{:.1} {:.1}L{:.1} {:.1}\" stroke=\"#cd6e1e\" stroke-width=\"1.3\" marker-end=\"url(#head)\"/>",
                a[0], a[1], b[0], b[1]
            ),
            Mark::Path(line) => {
                let points: Vec<String> = line.iter().map(|p| format!("{:.1},{:.1}", p[0], p[1])).collect();
                format!(
                    "<polyline points=\"{}\" fill=\"none\" stroke=\"#1e5aaa\" stroke-width=\"1.6\"/>",
                    points.join(" ")
                )
            }
            Mark::Dot(p) => format!("<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"3\" fill=\"#1e5aaa\"/>", p[0], p[1]),
            Mark::Text(text, at) => format!(
                "<text x=\"{:.1}\" y=\"{:.1}\" font-family=\"sans-serif\" font-size=\"12\" fill=\"#282828\">{text}</text>",
                at[0], at[1]
            ),
        };
        svg.push_str(&line);
        svg.push('\n');
    }
    svg.push_str("</svg>\n");
    svg
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The field of the running scene: 20 frames each.
    fn running() -> Vec<Interval> {
        [[-50, -30, -50], [-50, -100, -25], [-30, -100, 0], [-50, -100, 30], [-50, -100, 50]]
            .iter()
            .enumerate()
            .map(|(i, v)| Interval { through: 20 * (i as u32 + 1), vector: Vec3::from_array(v.map(|c| c as f32)) })
            .collect()
    }

    #[test]
    fn each_vector_is_a_corner_of_both_polylines() {
        let svg = svg(&running());
        let corners: Vec<usize> = svg
            .lines()
            .filter(|l| l.starts_with("<polyline"))
            .map(|l| l.split('"').nth(1).unwrap().split(' ').count())
            .collect();
        assert_eq!(corners, [5, 5]);
        // F_1 = (-50, -30, -50): z and y at 0.44 of the side per 100 from the first origin; x and z from the second.
        let (x, y) = (BORDER + SIDE / 2.0, BORDER + SIDE / 2.0);
        let k = 0.44 * SIDE / 100.0;
        assert!(svg.contains(&format!("{:.1},{:.1}", x - 50.0 * k, y + 30.0 * k)));
        assert!(svg.contains(&format!("{:.1},{:.1}", x + SIDE + BORDER - 50.0 * k, y - 50.0 * k)));
    }

    #[test]
    fn a_field_without_force_is_drawn_as_dots() {
        let still = [Interval { through: 10, vector: Vec3::ZERO }];
        assert!(svg(&still).contains("<circle"));
        assert!(!svg(&[]).contains("NaN"));
        let folder = tempfile::tempdir().unwrap();
        write_png(&folder.path().join("f.png"), &still).unwrap();
        write_svg(&folder.path().join("f.svg"), &running()).unwrap();
    }

    /// `count` intervals whose forces turn about a slanted axis, or stay the same.
    fn many(count: u32, turning: bool) -> Vec<Interval> {
        let force = |i: u32| if turning { 2.399 * i as f32 } else { 0.0 };
        (0..count)
            .map(|i| Interval {
                through: 1000 * (i + 1),
                vector: 80.0 * Vec3::new(1.0, force(i).sin(), force(i).cos()),
            })
            .collect()
    }

    #[test]
    fn text_stays_inside_however_many_intervals_there_are() {
        for field in [0, 1, 5, 12, 40, 130, 2000].into_iter().flat_map(|n| [many(n, true), many(n, false)]) {
            let [across, down] = size(&field);
            for mark in marks(&field) {
                if let Mark::Text(text, [x, y]) = mark {
                    assert!(x >= 0.0 && x + width(&text) <= across, "{} intervals: {text}", field.len());
                    // Letters reach up by their height, and a comma down by a third of it.
                    assert!(y - TEXT >= 0.0 && y + TEXT / 3.0 <= down, "{} intervals: {text}", field.len());
                }
            }
        }
    }

    #[test]
    fn the_legend_names_every_interval_or_says_how_many_it_leaves_out() {
        for count in 0..300 {
            let legend = legend(&many(count, true)).join(" ");
            let named = (1..=count).filter(|i| legend.contains(&format!("({i}) {} to {}", 1000 * i - 999, 1000 * i)));
            let named = named.count() as u32;
            let left: u32 = match legend.strip_suffix(" more").and_then(|told| told.rsplit(' ').next()) {
                Some(left) => left.parse().unwrap(),
                None => 0,
            };
            assert_eq!(named + left, count, "{legend}");
            assert!(left == 0 || count > 60, "{legend}");
        }
        assert_eq!(legend(&running()).len(), 1);
    }

    #[test]
    fn a_caption_of_many_numbers_gives_ranges_and_says_how_many_it_leaves_out() {
        assert_eq!(caption(&[3]), "3");
        assert_eq!(caption(&[1, 2, 3, 5, 7, 8]), "1-3, 5, 7-8");
        let odd: Vec<usize> = (0..40).map(|i| 2 * i + 1).collect();
        let text = caption(&odd);
        let (numbers, left) = text.strip_suffix(" more").unwrap().split_once(" and ").unwrap();
        assert_eq!(numbers.split(", ").count() + left.parse::<usize>().unwrap(), 40);
    }
}
