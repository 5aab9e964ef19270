//! What a screen reader is told beyond names and values, and what who has no mouse needs.
//!
//! ```text
//! kept       the focus, while a small window is asked
//! last_focus where Tab goes on
//! ring       where the focus is
//! scrolled   a panel that goes along with the keyboard's focus
//! spoken     what changed, said aloud
//! ```

mod kept;
mod last_focus;
mod ring;
mod scrolled;
mod spoken;

pub(super) use kept::keep_focus;
pub use last_focus::LastFocus;
pub use ring::focus_ring;
pub(crate) use scrolled::Scrolled;
pub(super) use scrolled::scrolled_by_keys;
pub(super) use spoken::scales_in_words;
pub use spoken::spoken;

/// Says more of a part of the window to a screen reader than its name; without one the words are not made.
pub(crate) fn described(part: &egui::Response, words: impl FnOnce() -> String) {
    part.ctx
        .accesskit_node_builder(part.id, |node| node.set_description(words()));
}
