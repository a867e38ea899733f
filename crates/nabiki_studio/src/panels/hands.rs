//! What a hand does with what a panel has drawn.

use eframe::egui::{Key, Pos2, Response, WidgetText};

/// More that a response can tell.
pub trait Hands {
    /// Says what it is while the pointer rests on it, and nothing while a button is held: words would cover what is dragged.
    fn hint(self, words: impl Into<WidgetText>) -> Self;

    /// Where the hand that drags it is, or has let go of it: what it holds ends there, even where it has gone on since the last picture.
    fn held_at(&self) -> Option<Pos2>;
}

impl Hands for Response {
    fn hint(self, words: impl Into<WidgetText>) -> Self {
        if self.ctx.input(|input| input.pointer.any_down()) {
            return self;
        }
        self.on_hover_text(words)
    }

    fn held_at(&self) -> Option<Pos2> {
        // Escape ends a drag, too, but takes it back.
        let let_go = || self.ctx.input(|input| input.pointer.any_released() && !input.key_pressed(Key::Escape));
        let pos = || self.ctx.input(|input| input.pointer.interact_pos());
        (self.dragged() || (self.drag_stopped() && let_go()))
            .then(|| self.interact_pointer_pos().or_else(pos))
            .flatten()
    }
}
