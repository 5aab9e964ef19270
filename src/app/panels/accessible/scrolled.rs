//! A panel that scrolls to what gets the keyboard's focus, and one that is read by keys alone: egui's scroll by the
//! mouse.

use egui::scroll_area::ScrollAreaOutput;
use egui::{Id, Key, ScrollArea, Sense, Ui, Vec2, vec2};

/// An area whose content comes into sight when keys bring the focus to it.
pub(crate) trait Scrolled {
    /// As `show`.
    fn show_focused<R>(
        self,
        ui: &mut Ui,
        content: impl FnOnce(&mut Ui) -> R,
    ) -> ScrollAreaOutput<R>;
}

impl Scrolled for ScrollArea {
    fn show_focused<R>(
        self,
        ui: &mut Ui,
        content: impl FnOnce(&mut Ui) -> R,
    ) -> ScrollAreaOutput<R> {
        self.show(ui, |ui| {
            let shown = content(ui);
            bring_focus_into_sight(ui);
            shown
        })
    }
}

/// Once, when the focus moves: afterwards the wheel goes where it likes.
fn bring_focus_into_sight(ui: &Ui) {
    let focused = ui.memory(|memory| memory.focused());
    let kept = ui.unique_id().with("focus in sight");
    let before = ui.data_mut(|data| {
        let before: Option<Option<Id>> = data.get_temp(kept);
        data.insert_temp(kept, focused);
        before.flatten()
    });
    // What is clicked is in sight, and must not move away under the mouse.
    let by_mouse = ui.input(|input| input.pointer.any_down() || input.pointer.any_released());
    if focused == before || by_mouse {
        return;
    }
    let Some(part) = focused.and_then(|id| ui.ctx().read_response(id)) else {
        return;
    };
    if part.layer_id == ui.layer_id() && ui.min_rect().contains(part.rect.center()) {
        ui.scroll_to_rect(part.rect.expand(ui.spacing().item_spacing.y), None);
    }
}

/// Takes the focus when it appears, and lets the arrows, Page up, Page down, Home and End scroll what is read.
pub(in crate::panels) fn scrolled_by_keys(
    name: &str,
    area: ScrollArea,
    ui: &mut Ui,
    content: impl FnOnce(&mut Ui),
) {
    let id = ui.scope_id().with(name);
    let by = by_keys(id, ui);
    let shown = area.show(ui, |ui| {
        content(ui);
        // egui counts downwards, as the content moves.
        ui.scroll_with_delta(-by * ui.clip_rect().height());
    });
    let frame = ui.interact(shown.inner_rect, id, Sense::focusable_noninteractive());
    frame.widget_info(|| egui::WidgetInfo::labeled(egui::Role::ScrollView, true, name));
    let pass = ui.ctx().cumulative_pass_nr();
    let before: Option<u64> = ui.data_mut(|data| {
        let before = data.get_temp(id);
        data.insert_temp(id, pass);
        before
    });
    let is_new = before.is_none_or(|before| before + 1 < pass);
    if is_new || ui.memory(|memory| memory.focused().is_none()) {
        frame.request_focus();
    }
    if frame.has_focus() {
        ui.memory_mut(|memory| {
            let filter = egui::EventFilter {
                vertical_arrows: true,
                ..egui::EventFilter::default()
            };
            memory.set_focus_lock_filter(id, filter);
        });
    }
}

/// How far the keys of this frame scroll, in heights of what is seen.
fn by_keys(id: Id, ui: &Ui) -> Vec2 {
    if ui.memory(|memory| memory.focused() != Some(id)) {
        return Vec2::ZERO;
    }
    let pages = ui.input(|input| {
        let keys = [
            (Key::ArrowDown, 0.1),
            (Key::ArrowUp, -0.1),
            (Key::PageDown, 0.9),
            (Key::PageUp, -0.9),
            (Key::End, 1e3),
            (Key::Home, -1e3),
        ];
        let pressed = keys.into_iter().filter(|(key, _)| input.key_pressed(*key));
        pressed.map(|(_, pages)| pages).sum::<f32>()
    });
    vec2(0.0, pages)
}
