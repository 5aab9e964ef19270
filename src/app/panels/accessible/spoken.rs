//! What changed, for a screen reader to say: the photo that is selected now, and the last line of the log.

use egui::accesskit::Live;

use crate::exports::PhotoLine;
use crate::state::State;

/// Says both when they change.
pub fn spoken(state: &State, ui: &egui::Ui) {
    said("selected photo", || selected(state), ui);
    let last_message = || Some(state.log.last()?.text.clone());
    said("last message", last_message, ui);
}

/// A part without size whose words are said aloud when they change; without a screen reader they are not made.
fn said(name: &str, words: impl FnOnce() -> Option<String>, ui: &egui::Ui) {
    let id = egui::Id::unique(name);
    ui.interact(egui::Rect::ZERO, id, egui::Sense::empty());
    ui.ctx().accesskit_node_builder(id, |node| {
        node.set_role(egui::Role::Status);
        node.set_label(words().unwrap_or_default());
        node.set_live(Live::Polite);
    });
}

/// "IMG_0001.jpg: top 20.6, bottom 21.4 px/cm, trust".
fn selected(state: &State) -> Option<String> {
    let open = state.open.as_ref()?;
    let row = open.row(open.selected?)?;
    let line = PhotoLine {
        unit: state.preferences.unit(),
        to_type: true,
        ..row.line
    };
    Some(format!(
        "{}: {}",
        line.photo.name(),
        scales_in_words(state, &line)
    ))
}

/// "top 20.6, bottom 21.4 px/cm, trust".
pub(in crate::panels) fn scales_in_words(state: &State, line: &PhotoLine<'_>) -> String {
    let verdict = match line.photo.settled() {
        None => "not looked at yet".to_owned(),
        Some(verdict) if state.may_still_be_doubted(verdict) => format!("{verdict} so far"),
        Some(verdict) => verdict.to_string(),
    };
    let estimates = line.estimates(line.photo.pair);
    match estimates.map(|estimate| estimate.map(|scale| scale.text(4))) {
        [None, None] => verdict,
        scales => {
            let [top, bottom] = scales.map(|scale| scale.unwrap_or_else(|| "none".to_owned()));
            format!("top {top}, bottom {bottom} px/{}, {verdict}", line.unit)
        }
    }
}
