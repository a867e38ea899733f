//! What the left button does: it takes hold of hair or of an arrow, drags, and lets go.

use eframe::egui;
use nabiki_render::View as Seen;
use nabiki_scene::pull::{Follower, Freedom, Lock, Pull};

use super::hand::{self, Hand};
use super::{Shown, Touch, View, camera, handle, pick};
use crate::document::Phase;

/// Logical pixels about the pointer within which hair is taken hold of.
const REACH: f32 = 9.0;

impl View {
    /// Takes hold, drags, lets go.
    pub(super) fn use_hand(
        &mut self,
        ui: &egui::Ui,
        response: &egui::Response,
        shown: &Shown<'_>,
        view: &Seen,
        rect: egui::Rect,
        touches: &mut Vec<Touch>,
    ) {
        let scale = ui.pixels_per_point();
        let pixel = ui.input(|input| input.pointer.latest_pos()).map(|at| (at - rect.min) * scale);
        let Some(pixel) = pixel.map(|at| glam::Vec2::new(at.x, at.y)) else { return };
        let (pressed, down, escape, nailing) = ui.input(|input| {
            let primary = egui::PointerButton::Primary;
            let (pressed, down) = (input.pointer.button_pressed(primary), input.pointer.button_down(primary));
            (pressed, down, input.key_pressed(egui::Key::Escape), input.key_down(egui::Key::N))
        });
        if escape && self.hand.is_busy() {
            touches.extend(self.hand.give_up());
            return;
        }
        // Between two pictures a hand may have gone on: it has taken hold, and lets go, where the button says.
        let [pressed_at, released_at] = [true, false].map(|down| button_at(ui, rect, down).unwrap_or(pixel));
        let on_button = ui.input(|input| input.pointer.latest_pos());
        let on_button = on_button.is_some_and(|at| self.buttons.iter().any(|button| button.contains(at)));
        if pressed && response.contains_pointer() && !on_button && matches!(self.hand, Hand::Idle) {
            touches.extend(std::mem::take(&mut self.refused).then_some(Touch::Heard));
            self.let_go = None;
            self.take_hold(ui.ctx(), shown, view, pressed_at, scale, nailing, touches);
            self.left_tip = None;
        }
        if !down && self.hand.is_busy() {
            let (of_forces, _) = hand::of_forces(shown, view);
            touches.extend(self.hand.drag_tip(&of_forces, released_at));
            self.left_tip = self.hand.tip_let_go(shown, view);
            match std::mem::take(&mut self.hand) {
                Hand::Hair(mut held) => {
                    held.drag(&view.in_head(&shown.take.pose(shown.frame)), released_at);
                    // The newest that was found is what stays.
                    touches.extend(held.follow().filter(|touch| matches!(touch, Touch::Refused(_))));
                    let followed = held.followed.clone();
                    touches.extend(followed.map(|pulled| hand::touched(pulled, Phase::Done)));
                    self.let_go = held.let_go(shown, ui.input(|input| input.time));
                }
                mut other => touches.extend(other.release()),
            }
            return;
        }
        let (of_forces, _) = hand::of_forces(shown, view);
        touches.extend(self.hand.drag_tip(&of_forces, pixel));
        if let Hand::Hair(held) = &mut self.hand {
            held.drag(&view.in_head(&shown.take.pose(shown.frame)), pixel);
            touches.extend(held.follow());
        }
    }

    /// The arrow of the chosen interval, with its number: as a hand has left it, or as it is drawn anew.
    pub(super) fn arrow(&self, shown: &Shown<'_>, scale: f32, view: &Seen) -> Option<(usize, handle::Arrow)> {
        let left = self.left_tip.as_ref().and_then(|left| left.arrow(shown, view));
        left.or_else(|| hand::arrow(shown, scale, view))
    }

    /// The left button went down: what is it on?
    #[expect(clippy::too_many_arguments, reason = "what a press knows, used once")]
    fn take_hold(
        &mut self,
        context: &egui::Context,
        shown: &Shown<'_>,
        view: &Seen,
        pixel: glam::Vec2,
        scale: f32,
        nailing: bool,
        touches: &mut Vec<Touch>,
    ) {
        let (of_forces, _) = hand::of_forces(shown, view);
        if let Some((interval, arrow)) = self.arrow(shown, scale, view)
            && arrow.is_held_by(&of_forces, pixel, handle::REACH * scale)
        {
            self.hand = Hand::Tip { interval, held: handle::Held::new(&arrow, &of_forces, pixel), vector: None };
            return;
        }
        let picked = if shown.hands_off { None } else { picked(shown, view, pixel, scale) };
        let Some(picked) = picked else {
            self.hand = Hand::Camera(camera::Gesture::Orbit);
            return;
        };
        let (points, strands) = (shown.take.points(shown.frame), shown.take.strands());
        let at = (picked.strand, picked.node);
        let lock = Lock::about(shown.frame, points, strands, shown.take.at_hand(), at, hand::LOCK_CM);
        if shown.frame == 0 {
            touches.push(Touch::Refused("Frame 0 is the hair at rest: go to a later frame to pull it.".to_owned()));
        } else if nailing {
            self.nail(lock);
        } else if shown.take.built.forces.intervals() != shown.force {
            touches.push(Touch::Refused("The motion is still being computed: pull again in a moment.".to_owned()));
        } else {
            let middle = lock.middle(points, strands);
            let follower = Follower::new(&shown.take.built, &lock, middle, &self.nails, Freedom::default());
            let context = context.clone();
            let pull = Pull::new(follower, move || context.request_repaint());
            let in_head = view.in_head(&shown.take.pose(shown.frame));
            let held = hand::Held::new(lock, &picked, shown.take, &self.nails, &in_head, pixel, pull);
            self.hand = Hand::Hair(Box::new(held));
        }
    }

    /// Drives a nail in, or pulls out the one that is there.
    pub(super) fn nail(&mut self, lock: Lock) {
        let count = self.nails.len();
        let first = lock.nodes.first().copied();
        self.nails.retain(|nail| nail.frame != lock.frame || first.is_none_or(|node| !nail.nodes.contains(&node)));
        if self.nails.len() == count {
            self.nails.push(lock);
        }
    }
}

/// Where the left button went down, or up, since the last picture (px of a view).
fn button_at(ui: &egui::Ui, rect: egui::Rect, down: bool) -> Option<glam::Vec2> {
    let at = ui.input(|input| {
        input.events.iter().rev().find_map(|event| match event {
            egui::Event::PointerButton { pos, button: egui::PointerButton::Primary, pressed, .. } => {
                (*pressed == down).then_some(*pos)
            }
            _ => None,
        })
    });
    let at = (at? - rect.min) * ui.pixels_per_point();
    Some(glam::Vec2::new(at.x, at.y))
}

/// The node under the pointer.
pub fn picked(shown: &Shown<'_>, view: &Seen, pixel: glam::Vec2, scale: f32) -> Option<pick::Picked> {
    let (take, in_head) = (shown.take, view.in_head(&shown.take.pose(shown.frame)));
    let skins = pick::Skins::of(take, shown.frame);
    pick::nearest(&in_head, take.points(shown.frame), take.strands(), take.at_hand(), &skins, pixel, REACH * scale)
}
