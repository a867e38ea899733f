//! A force field over time, drawn as Figure 10 of the paper draws it: its vectors as a polyline, projected on the yz and
//! zx planes. Where the force differs from place to place, two slices through the head in one frame stand below.

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

/// A field to draw.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FieldPlot {
    /// The vectors of the uniform part and their intervals.
    pub intervals: Vec<Interval>,
    /// The uniform part in every frame from 1 on, if it is not linear between vectors; otherwise empty.
    pub path: Vec<Vec3>,
    /// The force around the head in one frame, if it varies in space.
    pub slices: Option<Slices>,
}

/// A force in two planes through a point.
#[derive(Clone, Debug, PartialEq)]
pub struct Slices {
    /// The frame.
    pub frame: u32,
    /// Half the side of each slice (cm).
    pub reach: f32,
    /// Half axes of the ellipsoid around the point, which is drawn as an outline (cm).
    pub half_axes: Vec3,
    /// Positions relative to the point (cm) and forces, in the yz plane.
    pub yz: Vec<[Vec3; 2]>,
    /// The same in the zx plane.
    pub zx: Vec<[Vec3; 2]>,
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

/// A drawing: how vectors lie in it, the names of its axes, its title.
type Plane = (fn(Vec3) -> [f32; 2], &'static str, &'static str, &'static str);

/// z to the right and y up; then x to the right and z down, seen from above with the face to the right.
const PLANES: [Plane; 2] = [(|v| [v.z, -v.y], "z", "y", "yz plane"), (|v| [v.x, v.z], "x", "z", "zx plane")];

/// The axes of drawing `p` of a row whose upper edge is at `top`, and its middle.
fn axes(p: usize, top: f32, marks: &mut Vec<Mark>) -> [f32; 2] {
    let (_, across, upright, _) = PLANES[p];
    let origin = [BORDER + SIDE / 2.0 + p as f32 * (SIDE + BORDER), top + SIDE / 2.0];
    let half = SIDE / 2.0;
    marks.push(Mark::Axis([origin[0] - half, origin[1]], [origin[0] + half, origin[1]]));
    marks.push(Mark::Axis([origin[0], origin[1] - half], [origin[0], origin[1] + half]));
    marks.push(Mark::Text(across.into(), [origin[0] + half - 12.0, origin[1] - 6.0]));
    // The vertical axis of the second drawing points down: its end is at the bottom.
    let end = if p == 0 { origin[1] - half + 10.0 } else { origin[1] + half };
    marks.push(Mark::Text(upright.into(), [origin[0] + 6.0, end]));
    origin
}

/// Both projections, the legend, and the slices if there are any.
fn marks(plot: &FieldPlot) -> Vec<Mark> {
    let field = &plot.intervals;
    let vectors = field.iter().map(|i| i.vector).chain(plot.path.iter().copied());
    let largest = vectors.fold(0.0_f32, |m, v| m.max(v.abs().max_element()));
    let scale = if largest > 0.0 { 0.44 * SIDE / largest } else { 1.0 };
    let mut marks = Vec::new();
    for (p, (project, _, _, title)) in PLANES.into_iter().enumerate() {
        let origin = axes(p, BORDER, &mut marks);
        let at = |v: Vec3| {
            let [x, y] = project(v);
            [origin[0] + scale * x, origin[1] + scale * y]
        };
        marks.push(Mark::Text(title.into(), [origin[0] - SIDE / 2.0, BORDER - 14.0]));
        for interval in field {
            marks.push(Mark::Arrow(origin, at(interval.vector)));
        }
        marks.push(Mark::Path(match plot.path.as_slice() {
            [] => field.iter().map(|i| at(i.vector)).collect(),
            path => path.iter().map(|&v| at(v)).collect(),
        }));
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
    if let Some(slices) = &plot.slices {
        slice_marks(slices, above_slices(plot) + BORDER, &mut marks);
    }
    marks
}

/// The slices in a row whose upper edge is at `top`: the largest arrow reaches to the next.
fn slice_marks(slices: &Slices, top: f32, marks: &mut Vec<Mark>) {
    let Slices { frame, reach, half_axes, yz, zx } = slices;
    let per_cm = SIDE / 2.0 / reach;
    let forces = || yz.iter().chain(zx).map(|[_, force]| force.length());
    let largest = forces().fold(0.0, f32::max);
    let step = SIDE / (yz.len().max(1) as f32).sqrt().max(1.0);
    let per_force = if largest > 0.0 { step / largest } else { 0.0 };
    for (p, places) in [yz, zx].into_iter().enumerate() {
        let origin = axes(p, top, marks);
        let (project, _, _, title) = PLANES[p];
        let text = format!("{title}, frame {frame}, largest F = {largest:.1}");
        marks.push(Mark::Text(text, [origin[0] - SIDE / 2.0, top - 14.0]));
        let outline = (0..=64).map(|i| {
            let (sin, cos) = (std::f32::consts::TAU * i as f32 / 64.0).sin_cos();
            let on = if p == 0 { Vec3::new(0.0, sin, cos) } else { Vec3::new(sin, 0.0, cos) };
            let [x, y] = project(on * *half_axes);
            [origin[0] + per_cm * x, origin[1] + per_cm * y]
        });
        marks.push(Mark::Path(outline.collect()));
        for &[place, force] in places {
            let ([x, y], [dx, dy]) = (project(place), project(force));
            let from = [origin[0] + per_cm * x, origin[1] + per_cm * y];
            marks.push(Mark::Arrow(from, [from[0] + per_force * dx, from[1] + per_force * dy]));
        }
    }
}

/// Height of what stands above the slices: the legend takes the lines it needs.
fn above_slices(plot: &FieldPlot) -> f32 {
    SIDE + 2.0 * BORDER + (legend(&plot.intervals).len() - 1) as f32 * LINE
}

/// Width and height of the whole drawing.
fn size(plot: &FieldPlot) -> [f32; 2] {
    let slices = if plot.slices.is_some() { SIDE + 2.0 * BORDER } else { 0.0 };
    [WIDTH, above_slices(plot) + slices]
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
    if field.is_empty() {
        return vec![String::new()];
    }
    let mut from = 1;
    let mut lines = vec!["frames".to_owned()];
    for (i, interval) in field.iter().enumerate() {
        let comma = if i + 1 < field.len() { "," } else { "" };
        let text = format!("({}) {from} to {}{comma}", i + 1, interval.through);
        from = interval.through.saturating_add(1);
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
pub fn write_png(path: &Path, plot: &FieldPlot) -> Result<(), RenderError> {
    let mut canvas = Canvas::new(size(plot).map(|s| s as usize), [255; 3]);
    for mark in marks(plot) {
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
pub fn write_svg(path: &Path, plot: &FieldPlot) -> Result<(), RenderError> {
    write_whole(path, |file| Ok(file.write_all(svg(plot).as_bytes())?))
}

fn svg(plot: &FieldPlot) -> String {
    let [width, height] = size(plot);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\">\n\
         <defs><marker id=\"head\" viewBox=\"0 0 10 10\" refX=\"10\" refY=\"5\" markerWidth=\"7\" markerHeight=\"7\" \
         orient=\"auto\"><path d=\"M0 0L10 5L0 10z\" fill=\"#cd6e1e\"/></marker></defs>\n\
         <rect width=\"{width}\" height=\"{height}\" fill=\"#fff\"/>\n"
    );
    for mark in marks(plot) {
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
    fn running() -> FieldPlot {
        let intervals = [[-50, -30, -50], [-50, -100, -25], [-30, -100, 0], [-50, -100, 30], [-50, -100, 50]]
            .iter()
            .enumerate()
            .map(|(i, v)| Interval { through: 20 * (i as u32 + 1), vector: Vec3::from_array(v.map(|c| c as f32)) })
            .collect();
        FieldPlot { intervals, ..FieldPlot::default() }
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
        let intervals = vec![Interval { through: 10, vector: Vec3::ZERO }];
        let still = FieldPlot { intervals, ..FieldPlot::default() };
        assert!(svg(&still).contains("<circle"));
        assert!(!svg(&FieldPlot::default()).contains("NaN"));
        let folder = tempfile::tempdir().unwrap();
        write_png(&folder.path().join("f.png"), &still).unwrap();
        write_svg(&folder.path().join("f.svg"), &running()).unwrap();
    }

    /// A force away from the middle.
    fn sliced() -> Slices {
        let yz = (0..9).map(|i| [Vec3::new(0.0, (i / 3 - 1) as f32, (i % 3 - 1) as f32); 2]);
        let zx = (0..9).map(|i| [Vec3::new((i / 3 - 1) as f32, 0.0, (i % 3 - 1) as f32); 2]);
        Slices { frame: 7, reach: 20.0, half_axes: Vec3::new(9.0, 11.0, 8.0), yz: yz.collect(), zx: zx.collect() }
    }

    #[test]
    fn slices_stand_below_with_an_arrow_for_each_place_and_the_outline_of_the_head() {
        let bare = running();
        let with = FieldPlot { slices: Some(sliced()), ..running() };
        let count = |plot: &FieldPlot, what: &str| svg(plot).matches(what).count();
        assert_eq!(count(&with, "marker-end") - count(&bare, "marker-end"), 18);
        assert_eq!(count(&with, "<polyline") - count(&bare, "<polyline"), 2);
        assert_eq!(size(&with)[1] - size(&bare)[1], SIDE + 2.0 * BORDER);
        // Half of the outline's width: 8 cm of the 20 cm that half of the side is.
        let right = BORDER + SIDE / 2.0 + 8.0 / 20.0 * SIDE / 2.0;
        assert!(svg(&with).contains(&format!("{right:.1},")), "{right}");
    }

    #[test]
    fn a_path_takes_the_place_of_straight_lines() {
        let eased = FieldPlot { path: vec![Vec3::X, Vec3::Y, Vec3::Z], ..running() };
        let corners = |plot: &FieldPlot| -> Vec<usize> {
            let svg = svg(plot);
            let lines = svg.lines().filter(|line| line.starts_with("<polyline"));
            lines.map(|line| line.split('"').nth(1).unwrap().split(' ').count()).collect()
        };
        assert_eq!((corners(&running()), corners(&eased)), (vec![5, 5], vec![3, 3]));
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
            let slices = field.len().is_multiple_of(2).then(sliced);
            let plot = FieldPlot { intervals: field.clone(), path: vec![Vec3::ONE], slices };
            let [across, down] = size(&plot);
            for mark in marks(&plot) {
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
        assert_eq!(legend(&running().intervals).len(), 1);
        let for_good = [Interval { through: u32::MAX, vector: Vec3::X }];
        assert_eq!(legend(&for_good), ["frames (1) 1 to 4294967295"]);
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
