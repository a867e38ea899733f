//! Where frames lie across the timeline: a stretch of time that can be neared and shifted.

use eframe::egui::{Id, Rect, Ui};

/// The stretch of frames shown, and where.
#[derive(Clone, Copy, Debug)]
pub struct Scale {
    lane: Rect,
    from: f64,
    to: f64,
    whole: f64,
    id: Id,
}

impl Scale {
    /// That of a lane for frames up to `last`, in the scene of this number.
    pub fn of(ui: &Ui, scene: u64, lane: Rect, last: u32) -> Self {
        let id = ui.scope_id().with(("scale", scene));
        // A little more than there is, so that the last border can be taken hold of.
        let whole = 1.02 * f64::from(last) + 1.5;
        let (from, to) = ui.data(|data| data.get_temp(id)).unwrap_or((-0.5, whole));
        // The scene may have become shorter or longer since.
        let (from, to) = if from >= whole || to - from < 4.0 { (-0.5, whole) } else { (from, to) };
        Self { lane, from, to, whole, id }
    }

    /// The first frame shown.
    pub fn from(&self) -> f64 {
        self.from
    }

    /// The last.
    pub fn to(&self) -> f64 {
        self.to
    }

    /// Where a frame is.
    pub fn x(&self, frame: f64) -> f32 {
        let part = (frame - self.from) / (self.to - self.from);
        self.lane.left() + (part * f64::from(self.lane.width())) as f32
    }

    /// The frame at a place, not below 0.
    pub fn frame(&self, x: f32) -> u32 {
        self.time(x).round().max(0.0) as u32
    }

    /// The same with its part.
    pub fn time(&self, x: f32) -> f64 {
        self.from + f64::from((x - self.lane.left()) / self.lane.width()) * (self.to - self.from)
    }

    /// Frames between two numbers of the ruler, so that they do not touch.
    pub fn step(&self) -> u32 {
        let least = (self.to - self.from) * 44.0 / f64::from(self.lane.width().max(1.0));
        let steps = [1, 2, 5, 10, 20, 25, 50, 100, 200, 250, 500, 1000, 2000, 5000, 10_000, 100_000, 1_000_000];
        steps.into_iter().find(|step| f64::from(*step) >= least).unwrap_or(10_000_000)
    }

    /// Nears with the wheel about the pointer, shifts with Shift or a sideways wheel.
    pub fn steer(&self, ui: &Ui, rect: Rect) {
        if !ui.rect_contains_pointer(rect) {
            return;
        }
        let (scroll, pointer, shift) =
            ui.input(|input| (input.smooth_scroll_delta, input.pointer.hover_pos(), input.modifiers.shift));
        let (way, near) = if shift { (scroll.x + scroll.y, 0.0) } else { (scroll.x, scroll.y) };
        let Some(pointer) = pointer.filter(|_| way != 0.0 || near != 0.0) else { return };
        let at = self.time(pointer.x);
        let factor = f64::from(-near * 0.004).exp();
        let least = 8.0 / (self.to - self.from);
        let factor = factor.clamp(least.min(1.0), (2.0 * self.whole / (self.to - self.from)).max(1.0));
        let shift = -f64::from(way / self.lane.width()) * (self.to - self.from);
        let (mut from, mut to) = (at + (self.from - at) * factor + shift, at + (self.to - at) * factor + shift);
        // Not beyond either end, but for as much as the window shows more than there is.
        let length = to - from;
        if from < -0.5 {
            (from, to) = (-0.5, length - 0.5);
        }
        if to > self.whole && length < self.whole {
            (from, to) = (self.whole - length, self.whole);
        }
        ui.data_mut(|data| data.insert_temp(self.id, (from, to)));
    }

    /// Shows everything again.
    pub fn forget(&self, ui: &Ui) {
        ui.data_mut(|data| data.remove::<(f64, f64)>(self.id));
    }
}
