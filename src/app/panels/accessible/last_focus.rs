//! Where the keyboard's focus was last: Enter and Escape leave a field, and Tab goes on from there, not from the window's
//! first button.

/// The part of the window that had the focus last, and where keys went then.
#[derive(Debug)]
pub struct LastFocus<K>(Option<(egui::Id, K)>);

impl<K> Default for LastFocus<K> {
    fn default() -> Self {
        Self(None)
    }
}

impl<K: PartialEq> LastFocus<K> {
    /// Before the window is drawn: Tab goes on from there, where keys still go where they went.
    pub fn go_on(&self, keys: &K, context: &egui::Context) {
        let is_tab = context.input(|input| input.key_pressed(egui::Key::Tab));
        let Some((id, before)) = self.0.as_ref().filter(|_| is_tab) else {
            return;
        };
        let is_nowhere = context.memory(|memory| memory.focused().is_none());
        let part = context.read_response(*id);
        if is_nowhere && before == keys && part.is_some_and(|part| part.enabled()) {
            context.memory_mut(|memory| memory.request_focus(*id));
        }
    }

    /// Behind it: the focus of now. Who takes the mouse begins anew.
    pub fn take(&mut self, keys: K, context: &egui::Context) {
        match context.memory(|memory| memory.focused()) {
            Some(id) => self.0 = Some((id, keys)),
            None if context.input(|input| input.pointer.any_pressed()) => self.0 = None,
            None => {}
        }
    }
}
