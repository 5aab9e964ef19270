//! Sentences under a table.

/// A sentence over the panel's width.
pub(super) fn sentence(text: &str, ui: &mut egui::Ui) {
    ui.add(egui::Label::new(text).wrap());
}

/// Something to know before trusting a number.
pub(super) fn warning(text: &str, ui: &mut egui::Ui) {
    let text = egui::RichText::new(format!("⚠ {text}")).color(ui.visuals().warn_fg_color);
    ui.add(egui::Label::new(text).wrap());
}
