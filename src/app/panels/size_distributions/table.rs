//! A table of results: drawn as a grid whose texts can be selected, copied whole for a spreadsheet.

use crate::app::command::Command;

/// Texts in rows under a head.
#[derive(Debug, Clone, Default)]
pub(super) struct Table {
    /// What it is of.
    pub name: String,
    /// The columns' names, each with what it means.
    pub head: Vec<(String, String)>,
    /// As many texts a row as the head has.
    pub rows: Vec<Vec<String>>,
}

impl Table {
    /// A table without rows. The head's entries are (name, what it means).
    pub(super) fn new(name: impl Into<String>, head: &[(&str, &str)]) -> Self {
        let owned = |(name, hover): &(&str, &str)| ((*name).to_owned(), (*hover).to_owned());
        Self {
            name: name.into(),
            head: head.iter().map(owned).collect(),
            rows: Vec::new(),
        }
    }

    /// Its name, the button that copies it, and the grid.
    pub(super) fn show(&self, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
        ui.horizontal(|ui| {
            ui.strong(&self.name);
            let copy = ui.small_button("Copy table");
            let label = format!("Copy table: {}", self.name);
            copy.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &label));
            let hover = "Copy all rows, for a spreadsheet";
            if copy.on_hover_text(hover).clicked() {
                commands.push(Command::Copy(self.text()));
            }
        });
        egui::ScrollArea::horizontal()
            .id_salt(&self.name)
            .show(ui, |ui| {
                egui::Grid::new(&self.name)
                    .striped(true)
                    .spacing([12.0, 3.0])
                    .min_col_width(20.0)
                    .show(ui, |ui| {
                        for (name, hover) in &self.head {
                            let name = egui::Label::new(egui::RichText::new(name).strong());
                            let name = ui.add(name.extend());
                            if !hover.is_empty() {
                                name.on_hover_text(hover);
                            }
                        }
                        ui.end_row();
                        for row in &self.rows {
                            for text in row {
                                ui.add(egui::Label::new(text).extend());
                            }
                            ui.end_row();
                        }
                    });
            });
    }

    /// The whole table, cells separated by tabs.
    pub(super) fn text(&self) -> String {
        let head: Vec<&str> = self.head.iter().map(|(name, _)| name.as_str()).collect();
        let mut text = head.join("\t");
        text.push('\n');
        for row in &self.rows {
            // A cell of several lines would be several rows.
            let cells: Vec<String> = row
                .iter()
                .map(|cell| cell.replace(['\t', '\n'], " "))
                .collect();
            text.push_str(&cells.join("\t"));
            text.push('\n');
        }
        text
    }
}
