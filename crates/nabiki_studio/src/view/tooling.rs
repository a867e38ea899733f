//! Strokes of the brush and the comb: from press to release.

use eframe::egui;
use glam::{Vec2, Vec3};
use nabiki::region::Region;
use nabiki_render::View as Camera;
use nabiki_view::Line;

use super::brush::{Seen, Weights};
use super::camera::place_in_plane;
use super::comb::Comb;
use super::hand::Hand;
use super::pick::Skins;
use super::{Shown, Touch, View, camera};
use crate::tools::{Stroke, Tool};

/// Linear colours of painted and of combed hair.
const PAINTED: [f32; 3] = [1.0, 0.35, 0.04];
const COMBED: [f32; 3] = [0.25, 0.9, 1.0];

/// A stroke of the brush under way.
#[derive(Debug)]
pub struct Painting {
    /// The region as it was, and which it is; a new one if it is left out.
    region: Option<(usize, Region)>,
    stroke: Stroke,
    before: Weights,
    now: Weights,
    /// How much of its strength it has given each strand.
    covered: Vec<f32>,
    /// Where it has been (px), all of it for a lasso.
    way: Vec<Vec2>,
}

/// Hair in the comb.
#[derive(Debug)]
pub struct Combing {
    comb: Comb,
    frame: u32,
    /// The number of the take.
    take: u64,
    from: Vec2,
    /// The strands as they lie now.
    strands: Vec<(usize, Vec<Vec3>)>,
}

/// The lines over the hair, and what they are of.
#[derive(Debug, Default)]
pub(super) struct Marked {
    of: Option<Of>,
    /// Whether a hand was changing it.
    by_hand: bool,
    /// The lines.
    pub lines: Vec<Line>,
    /// Counts their changes.
    pub number: u64,
}

/// What the lines are of.
#[derive(Clone, Debug, PartialEq)]
struct Of {
    take: u64,
    frame: u32,
    view: Camera,
    region: Option<Region>,
    /// Curves of the aims that are posed in the frame.
    curves: Vec<Vec<Vec3>>,
}

impl View {
    /// Uses brush or comb.
    pub(super) fn use_tool(
        &mut self,
        ui: &egui::Ui,
        over: bool,
        shown: &Shown<'_>,
        view: &Camera,
        rect: egui::Rect,
    ) -> Vec<Touch> {
        let mut touches = Vec::new();
        let scale = ui.pixels_per_point();
        let Some(at) = ui.input(|input| input.pointer.latest_pos()) else { return touches };
        let pixel = (at - rect.min) * scale;
        let pixel = Vec2::new(pixel.x, pixel.y);
        let (pressed, down, escape, modifiers) = ui.input(|input| {
            let primary = egui::PointerButton::Primary;
            let pointer = &input.pointer;
            (
                pointer.button_pressed(primary),
                pointer.button_down(primary),
                input.key_pressed(egui::Key::Escape),
                input.modifiers,
            )
        });
        let take = shown.take;
        if escape && self.hand.is_busy() {
            self.hand = Hand::Idle;
            return touches;
        }
        let in_head = view.in_head(&take.pose(shown.frame));
        let skins = Skins::of(take, shown.frame);
        let seen = Seen {
            view: &in_head,
            points: take.points(shown.frame),
            strands: take.strands(),
            among: take.at_hand(),
            skins: &skins,
        };
        let radius = shown.tools.radius * scale;
        let on_button = self.buttons.iter().any(|button| button.contains(at));
        if pressed && over && !on_button && matches!(self.hand, Hand::Idle) {
            touches.extend(std::mem::take(&mut self.refused).then_some(Touch::Heard));
            self.let_go = None;
            match self.begin(shown, &seen, pixel, radius, modifiers) {
                Ok(hand) => self.hand = hand,
                Err(why) => touches.push(Touch::Refused(why)),
            }
        }
        match &mut self.hand {
            Hand::Paint(painting) => {
                painting.go(&seen, pixel, radius, shown);
                if !down {
                    touches.extend(painting.ended(&seen, shown));
                    self.hand = Hand::Idle;
                }
            }
            Hand::Comb(combing) => {
                combing.go(&seen, pixel);
                if !down {
                    touches.extend(combing.ended());
                    self.hand = Hand::Idle;
                }
            }
            _ => {}
        }
        touches
    }

    /// Gives up a stroke whose region, strands, frame or tool are no longer those that it began with.
    pub(super) fn leave_other_stroke(&mut self, shown: &Shown<'_>) {
        let is_of = match &self.hand {
            Hand::Paint(painting) => painting.is_of(shown),
            Hand::Comb(combing) => combing.is_of(shown),
            _ => return,
        };
        if !is_of {
            self.hand = Hand::Idle;
        }
    }

    /// What a press begins: a stroke on hair, or a turn of the camera beside it.
    fn begin(
        &self,
        shown: &Shown<'_>,
        seen: &Seen<'_>,
        pixel: Vec2,
        radius: f32,
        modifiers: egui::Modifiers,
    ) -> Result<Hand, String> {
        if shown.playing {
            return Ok(Hand::Camera(camera::Gesture::Orbit));
        }
        if !shown.is_free {
            let table = if shown.tools.tool == Tool::Comb { "Aims need" } else { "Regions need" };
            return Err(format!("{table} the free form: choose it on the Motion page (motion.form)."));
        }
        if shown.tools.tool == Tool::Comb {
            let Some(comb) = Comb::take(seen, pixel, radius) else { return Ok(Hand::Camera(camera::Gesture::Orbit)) };
            if shown.frame == 0 {
                return Err("Frame 0 is the hair at rest: go to a later frame to comb it.".to_owned());
            }
            return Ok(Hand::Comb(Box::new(Combing {
                comb,
                frame: shown.frame,
                take: shown.take.number,
                from: pixel,
                strands: Vec::new(),
            })));
        }
        let lasso = shown.tools.stroke == Stroke::Lasso;
        if !lasso && seen.under([pixel; 2], radius).iter().all(|&amount| amount == 0.0) {
            return Ok(Hand::Camera(camera::Gesture::Orbit));
        }
        let stroke = match shown.tools.stroke {
            _ if modifiers.command || modifiers.ctrl => Stroke::Erase,
            _ if modifiers.shift && !lasso => Stroke::Smooth,
            stroke => stroke,
        };
        let region = shown.tools.region.filter(|&i| i < shown.regions.len());
        let region = region.map(|i| (i, shown.regions[i].clone()));
        let before = Weights::new(seen.strands, seen.among, region.as_ref().map(|(_, region)| region));
        let covered = vec![0.0; before.of().len()];
        Ok(Hand::Paint(Box::new(Painting { region, stroke, now: before.clone(), before, covered, way: vec![pixel] })))
    }

    /// Finds the lines that show what is painted or combed, if they are others than before.
    pub(super) fn mark(&mut self, shown: &Shown<'_>, view: &Camera) {
        let tool = if shown.playing { Tool::Pull } else { shown.tool() };
        let region = shown.tools.region.and_then(|i| shown.regions.get(i)).filter(|_| tool == Tool::Paint);
        let posed = shown.aims.iter().filter(|aim| tool == Tool::Comb && aim.frame == Some(shown.frame));
        let of = (tool != Tool::Pull).then(|| Of {
            take: shown.take.number,
            frame: shown.frame,
            view: *view,
            region: region.cloned(),
            curves: posed.flat_map(|aim| aim.curves.clone()).collect(),
        });
        let is_held = matches!(self.hand, Hand::Paint(_) | Hand::Comb(_));
        if !is_held && of == self.marked.of && !self.marked.by_hand {
            return;
        }
        let (take, strands) = (shown.take, shown.take.strands());
        let points = take.points(shown.frame);
        let in_head = view.in_head(&take.pose(shown.frame));
        let mut lines = Lines { view: &in_head, lines: Vec::new() };
        for curve in of.iter().flat_map(|of| &of.curves) {
            lines.lay(curve, COMBED, 0.45);
        }
        match &self.hand {
            Hand::Comb(combing) => combing.strands.iter().for_each(|(_, strand)| lines.lay(strand, COMBED, 0.9)),
            Hand::Paint(painting) => lines.colour(strands, points, painting.now.of()),
            _ if region.is_some() => {
                let weights = Weights::new(strands, take.at_hand(), region);
                lines.colour(strands, points, weights.of());
            }
            _ => {}
        }
        let lines = lines.lines;
        let number = self.marked.number + 1;
        self.marked = Marked { of, by_hand: is_held, lines, number };
    }

    /// The edge of brush or comb about the pointer, and the line of a lasso.
    pub(super) fn draw_tool(
        &self,
        overlay: &super::overlay::Overlay<'_>,
        pointer: Option<egui::Pos2>,
        shown: &Shown<'_>,
    ) {
        if let Hand::Paint(painting) = &self.hand
            && painting.is_lasso(shown)
        {
            let at = |p: &Vec2| overlay.rect.min + egui::vec2(p.x, p.y) / overlay.scale;
            overlay.lasso(&painting.way.iter().map(at).collect::<Vec<_>>());
        } else if let Some(at) =
            pointer.filter(|_| shown.tools.tool == Tool::Comb || shown.tools.stroke != Stroke::Lasso)
        {
            overlay.brush(at, shown.tools.radius);
        }
    }
}

impl Painting {
    fn is_of(&self, shown: &Shown<'_>) -> bool {
        let is_there = |(i, region): &(usize, Region)| shown.regions.get(*i) == Some(region);
        shown.tool() == Tool::Paint
            && self.region.as_ref().is_none_or(is_there)
            && self.before.is_of(shown.take.strands(), shown.take.at_hand())
    }

    fn is_lasso(&self, shown: &Shown<'_>) -> bool {
        shown.tools.stroke == Stroke::Lasso
    }

    /// The pointer is at this pixel.
    fn go(&mut self, seen: &Seen<'_>, pixel: Vec2, radius: f32, shown: &Shown<'_>) {
        let last = self.way[self.way.len() - 1];
        let is_first = self.way.len() == 1 && self.covered.iter().all(|&of| of == 0.0);
        if pixel == last && !is_first {
            return;
        }
        if self.is_lasso(shown) {
            self.way.push(pixel);
            return;
        }
        let touched = seen.under([last, pixel], radius);
        let touched = if shown.tools.mirror { self.before.mirrored(&touched) } else { touched };
        let strength = shown.tools.strength;
        if self.stroke == Stroke::Smooth {
            // It goes on smoothing where it passes again.
            let covered: Vec<f32> = touched.iter().map(|of| 0.5 * strength * of).collect();
            self.now = self.now.stroked(self.stroke, &covered);
            self.covered = covered;
        } else {
            self.covered.iter_mut().zip(&touched).for_each(|(of, touched)| *of = of.max(strength * touched));
            self.now = self.before.stroked(self.stroke, &self.covered);
        }
        self.way = vec![pixel];
    }

    /// The button is up.
    fn ended(&mut self, seen: &Seen<'_>, shown: &Shown<'_>) -> Option<Touch> {
        if self.is_lasso(shown) {
            let chosen = seen.within(&self.way);
            let chosen = if shown.tools.mirror { self.before.mirrored(&chosen) } else { chosen };
            let covered: Vec<f32> = chosen.iter().map(|of| shown.tools.strength * of).collect();
            self.now = self.before.stroked(self.stroke, &covered);
        }
        (self.now != self.before).then(|| {
            let (region, mut painted) = self.region.clone().map_or((None, Region::default()), |(i, of)| (Some(i), of));
            self.now.paint(&mut painted);
            Touch::Painted { region, painted: Box::new(painted) }
        })
    }
}

impl Combing {
    fn is_of(&self, shown: &Shown<'_>) -> bool {
        (shown.tool(), shown.frame, shown.take.number) == (Tool::Comb, self.frame, self.take)
    }

    fn go(&mut self, seen: &Seen<'_>, pixel: Vec2) {
        let at = |pixel| place_in_plane(seen.view, pixel, self.comb.hand);
        let way = at(pixel) - at(self.from);
        self.strands = if pixel == self.from { Vec::new() } else { self.comb.combed(way, seen.skins) };
    }

    fn ended(&mut self) -> Option<Touch> {
        let strands = std::mem::take(&mut self.strands);
        (!strands.is_empty()).then_some(Touch::Combed { frame: self.frame, strands })
    }
}

/// Lines over hair, as a camera sees it.
struct Lines<'a> {
    /// In head space.
    view: &'a Camera,
    lines: Vec<Line>,
}

impl Lines<'_> {
    /// Along the strands that belong to a region, brighter the more they do.
    fn colour(&mut self, strands: &nabiki::Strands, points: &[Vec3], weights: &[f32]) {
        for (strand, &weight) in weights.iter().enumerate().filter(|(_, weight)| **weight > 0.0) {
            self.lay(&points[strands.range(strand)], PAINTED, 0.15 + 0.8 * weight);
        }
    }

    /// Along a strand, and a little before it, or it would be hidden by its own lock.
    fn lay(&mut self, strand: &[Vec3], [r, g, b]: [f32; 3], alpha: f32) {
        const WIDTH: f32 = 2.2;
        const BEFORE_CM: f32 = 0.3;
        let of = [r, g, b, alpha];
        let place = |p: Vec3| (p + self.view.toward_eye(p) * BEFORE_CM).to_array();
        let line = |ends: &[Vec3]| Line {
            a: place(ends[0]),
            width: WIDTH,
            b: place(ends[1]),
            pad: 0.0,
            a_colour: of,
            b_colour: of,
        };
        self.lines.extend(strand.windows(2).map(line));
    }
}
