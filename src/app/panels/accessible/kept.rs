//! The focus while a small window is asked.

/// Who has no mouse is back where she was when the small window is gone.
pub(in crate::panels) fn keep_focus(asks: bool, context: &egui::Context) {
    let kept = egui::Id::unique("focus before a small window");
    let focused = context.memory(|memory| memory.focused());
    let before: Option<Option<egui::Id>> = context.data(|data| data.get_temp(kept));
    match (asks, before) {
        (true, None) => {
            context.data_mut(|data| data.insert_temp(kept, focused));
        }
        (false, Some(before)) => {
            context.data_mut(|data| data.remove::<Option<egui::Id>>(kept));
            // What had it in the small window is gone.
            if let Some(before) = before {
                context.memory_mut(|memory| memory.request_focus(before));
            }
        }
        _ => {}
    }
}
