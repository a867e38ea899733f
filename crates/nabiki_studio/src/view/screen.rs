//! The picture on the window: drawn anew when what it shows has changed, and the final one over it.

use std::sync::Arc;

use eframe::egui::{self, Color32, Painter, Rect, TextureHandle, TextureId, TextureOptions, pos2};
use eframe::egui_wgpu::RenderState;
use eframe::wgpu;
use glam::Affine3A;
use nabiki::dynamics::ForceSpace;
use nabiki_render::{Picture, View as Seen};
use nabiki_scene::BuiltScene;
use nabiki_view::{Drawing, Gpu, Line, MOST_HAIRS};

use super::final_picture::Done;
use super::tooling::Marked;
use super::{Shown, arrows, onion};

/// The card, and what it has drawn.
pub struct Screen {
    state: RenderState,
    gpu: Gpu,
    texture: Option<TextureId>,
    drawn: Option<Drawn>,
    last: Option<TextureHandle>,
    /// Whether the card is a processor: what moves is drawn in half the size then, with half the hairs, and whole when it
    /// stands still.
    is_slow: bool,
    /// Since when the picture has been one of half the size.
    coarse_since: Option<f64>,
}

/// Seconds that what is shown stands still before it is drawn whole.
const SETTLED: f64 = 0.15;

/// All that the picture depends on.
#[derive(Clone, Debug)]
struct Drawn {
    number: u64,
    built: Arc<BuiltScene>,
    frame: u32,
    picture: Picture,
    view: Seen,
    ghosts: bool,
    wind: bool,
    /// The number of what brush and comb have marked.
    marked: u64,
}

impl PartialEq for Drawn {
    fn eq(&self, other: &Self) -> bool {
        self.number == other.number
            && Arc::ptr_eq(&self.built, &other.built)
            && self.frame == other.frame
            && self.view == other.view
            && (self.ghosts, self.wind, self.marked) == (other.ghosts, other.wind, other.marked)
            && self.picture == other.picture
    }
}

impl Screen {
    /// By a window's device.
    ///
    /// # Errors
    /// In words, if it cannot do what the view needs.
    pub fn new(state: &RenderState) -> Result<Self, String> {
        let gpu = Gpu::new(&state.device, &state.queue)?;
        gpu.warm_up();
        let is_slow = state.adapter.get_info().device_type == wgpu::DeviceType::Cpu;
        Ok(Self { state: state.clone(), gpu, texture: None, drawn: None, last: None, is_slow, coarse_since: None })
    }

    /// What went wrong on the card.
    pub fn failure(&self) -> Option<String> {
        self.gpu.failure()
    }

    /// Shows head and hair at a time (s); whether they are other than at the last call.
    pub(super) fn show(
        &mut self,
        painter: &Painter,
        rect: Rect,
        shown: &Shown<'_>,
        view: &Seen,
        marked: &Marked,
        time: f64,
    ) -> bool {
        let now = Drawn {
            number: shown.take.number,
            built: shown.take.built.clone(),
            frame: shown.frame,
            picture: shown.picture.clone(),
            view: *view,
            ghosts: shown.ghosts,
            wind: shows_wind(shown),
            marked: marked.number,
        };
        let is_new = self.drawn.as_ref() != Some(&now);
        if is_new {
            self.draw(shown, view, marked, if self.is_slow { 2 } else { 1 });
            self.coarse_since = self.is_slow.then_some(time);
            self.drawn = Some(now);
        } else if self.coarse_since.is_some_and(|since| time - since >= SETTLED) {
            self.draw(shown, view, marked, 1);
            self.coarse_since = None;
        }
        if self.coarse_since.is_some() {
            painter.ctx().request_repaint_after_secs(SETTLED as f32);
        }
        if let Some(texture) = self.texture {
            painter.image(texture, rect, WHOLE, Color32::WHITE);
        }
        is_new
    }

    /// Draws the picture, each side `part` times smaller, and as many times fewer hairs in a lock.
    fn draw(&mut self, shown: &Shown<'_>, view: &Seen, marked: &Marked, part: u32) {
        let lines = [lines(shown, view), marked.lines.clone()].concat();
        let view = Seen { size: view.size.map(|side| (side / part).max(1)), scale: view.scale / part as f32, ..*view };
        let bodies = shown.take.bodies(shown.frame);
        let drawing = shown.take.drawing(shown.frame, &bodies, shown.picture, view);
        let drawing = Drawing { lines: &lines, most_hairs: MOST_HAIRS / part, ..drawing };
        let Some((texture, is_other)) = self.gpu.draw(&drawing) else { return };
        let mut renderer = self.state.renderer.write();
        let filter = wgpu::FilterMode::Linear;
        match self.texture {
            Some(id) if is_other => {
                renderer.update_egui_texture_from_wgpu_texture(&self.state.device, texture, filter, id);
            }
            Some(_) => {}
            None => self.texture = Some(renderer.register_native_texture(&self.state.device, texture, filter)),
        }
    }

    /// A final picture is there.
    pub fn set_final(&mut self, context: &egui::Context, done: &Done) {
        let size = done.size.map(|side| side as usize);
        let image = egui::ColorImage::from_rgba_unmultiplied(size, &done.rgba);
        match &mut self.last {
            Some(texture) => texture.set(image, TextureOptions::LINEAR),
            None => self.last = Some(context.load_texture("final picture", image, TextureOptions::LINEAR)),
        }
    }

    /// Shows it over the view, as far as it has faded in.
    pub fn show_final(&self, painter: &Painter, rect: Rect, opacity: f32) {
        if let Some(texture) = &self.last {
            painter.image(texture.id(), rect, WHOLE, Color32::WHITE.gamma_multiply(opacity));
        }
    }
}

const WHOLE: Rect = Rect { min: pos2(0.0, 0.0), max: pos2(1.0, 1.0) };

/// Whether the wind is drawn: arrows would only hide hair that moves.
pub fn shows_wind(shown: &Shown<'_>) -> bool {
    shown.wind && !shown.playing
}

/// Paths of tips and arrows of wind, in head space.
fn lines(shown: &Shown<'_>, view: &Seen) -> Vec<Line> {
    let mut lines = if shown.ghosts { onion::paths(shown.take, shown.frame) } else { Vec::new() };
    if shows_wind(shown) {
        let built = &shown.take.built;
        let pose = shown.take.pose(shown.frame);
        let (of_forces, head) = match built.dynamics.motion.force_space {
            ForceSpace::World => (pose, pose.world_from_head().inverse()),
            ForceSpace::Head => (nabiki::Pose::STILL, Affine3A::IDENTITY),
        };
        let forward = view.in_head(&pose).forward;
        for arrow in arrows::arrows(&*built.forces.field, shown.frame, &built.model.head.ellipsoid, &of_forces) {
            lines.extend(arrows::lines(arrow.map(|p| head.transform_point3(p)), forward));
        }
    }
    lines
}
