//! A frame around what keys brought the focus to: egui draws it as what the mouse is over, which menus, headings and pictures
//! hardly show.

use egui::{Context, Id, Key, Stroke, StrokeKind};

/// Keys that move the focus.
const MOVE: [Key; 5] = [
    Key::Tab,
    Key::ArrowUp,
    Key::ArrowDown,
    Key::ArrowLeft,
    Key::ArrowRight,
];

/// Draws it, once everything else is drawn; until the mouse is used.
pub fn focus_ring(context: &Context) {
    let kept = Id::unique("focus by keys");
    let (by_keys, by_mouse) = context.input(|input| {
        let moved = MOVE.iter().any(|key| input.key_pressed(*key));
        (moved, input.pointer.any_pressed())
    });
    let is_by_keys = context.data_mut(|data| {
        let shown = data.get_temp_mut_or(kept, false);
        *shown = !by_mouse && (*shown || by_keys);
        *shown
    });
    if !is_by_keys {
        return;
    }
    let focused = context.memory(|memory| memory.focused());
    if let Some(part) = focused.and_then(|id| context.read_response(id)) {
        let color = context.global_style().visuals.selection.stroke.color;
        let frame = part.interact_rect.expand(1.0);
        context.layer_painter(part.layer_id).rect_stroke(
            frame,
            3.0,
            Stroke::new(2.0, color),
            StrokeKind::Outside,
        );
    }
}
