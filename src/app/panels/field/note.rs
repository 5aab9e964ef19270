//! The field of a photo's note: the same in the inspector and in the review.

use crate::command::{Command, ReviewStep};
use crate::open_flight::OpenFlight;

/// What of a note's field differs between its two places.
pub(in crate::panels) struct NoteField<'a> {
    pub(in crate::panels) id: egui::Id,
    pub(in crate::panels) label: &'a str,
    pub(in crate::panels) hint: &'a str,
    /// What Enter does beside leaving the field.
    pub(in crate::panels) enter: Option<Command>,
}

impl NoteField<'_> {
    /// Draws it; returns the note of now. What is typed is kept from the first letter on: keys and clicks can lead to
    /// another photo at any time.
    pub(in crate::panels) fn show(
        self,
        open: &OpenFlight,
        photo: usize,
        ui: &mut egui::Ui,
        commands: &mut Vec<Command>,
    ) -> String {
        let mut note = open.note_of(photo).to_owned();
        let field = egui::TextEdit::singleline(&mut note)
            .id(self.id)
            .hint_text(self.hint)
            .desired_width(f32::INFINITY);
        let field = ui.add(field);
        field.widget_info(|| {
            let mut info = egui::WidgetInfo::labeled(egui::Role::TextInput, true, self.label);
            info.current_text_value = Some(note.clone());
            info
        });
        if field.changed() {
            commands.push(Command::Review(ReviewStep::Note(photo, note.clone())));
        }
        if field.lost_focus() {
            let is_entered = ui.input(|input| input.key_pressed(egui::Key::Enter));
            let entered = self.enter.filter(|_| is_entered);
            let left = Command::Review(ReviewStep::TakeNote(photo));
            commands.push(entered.unwrap_or(left));
        }
        note
    }
}
