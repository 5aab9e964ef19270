//! The files that the flight on the screen was made of.

use std::path::Path;

use crate::flight::PhotoFileState;
use crate::open_flight::OpenFlight;

/// Draws the list, each file by its name with its whole path in the hover text.
pub(super) fn files_of_flight(open: &OpenFlight, ui: &mut egui::Ui) {
    let files = &open.files;
    egui::CollapsingHeader::new("Made of these files")
        .default_open(true)
        .show(ui, |ui| {
            for path in &files.inputs {
                file(path, "", ui);
            }
            // Points of a reconstruction are in its own files.
            match files.origin.photo_folder() {
                Some(folder) => {
                    let all = files.photo_files.len();
                    let there =
                        |state: &PhotoFileState| matches!(state, PhotoFileState::Found { .. });
                    let found = files.photo_files.iter().filter(|file| there(&file.state));
                    file(folder, &format!(" ({} of {all} photos)", found.count()), ui);
                }
                None if open.review.count() > 0 => {
                    ui.weak("no photo files");
                }
                None => {}
            }
        });
}

fn file(path: &Path, more: &str, ui: &mut egui::Ui) {
    let name = path.file_name().unwrap_or(path.as_os_str());
    let text = format!("{}{more}", name.to_string_lossy());
    let label = egui::Label::new(egui::RichText::new(text).weak()).truncate();
    ui.add(label).on_hover_text(path.display().to_string());
}
