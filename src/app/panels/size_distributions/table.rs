//! A table of results: its texts can be selected, and it is copied whole for a spreadsheet. Only the
//! rows in sight are drawn.

use std::sync::Arc;

use egui::Galley;
use egui_extras::{Column, TableBuilder};

use crate::command::Command;
use crate::names;
use crate::numbers::significant_digits;

/// The height of a row.
const ROW: f32 = 18.0;

/// The height of the head, at least.
const HEAD: f32 = 20.0;

/// How wide a row of a column's name is, at most, and how many such rows it may fill: a method's name can be long, and its numbers are
/// what counts.
const WIDEST_HEAD: f32 = 100.0;
const HEAD_ROWS: f32 = 3.0;

/// The height of a table that is longer.
const TALLEST: f32 = 330.0;

/// Texts in rows under a head.
#[derive(Debug, Clone, Default)]
pub(super) struct Table {
    /// What it is of.
    name: String,
    /// The columns' names, each with what it means.
    head: Vec<(String, String)>,
    /// As many texts a row as the head has.
    rows: Vec<Vec<String>>,
}

impl Table {
    /// A table without rows.
    pub(super) fn new(name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            ..Self::default()
        }
    }

    /// A column more: its name and what it means.
    pub(super) fn column(&mut self, name: impl Into<String>, hover: impl Into<String>) {
        self.head.push((name.into(), hover.into()));
    }

    /// A row more, with a text for each column.
    pub(super) fn row(&mut self, cells: Vec<String>) {
        self.rows.push(cells);
    }

    /// Its name, the button that copies it, head and rows.
    pub(super) fn show(&self, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
        ui.horizontal(|ui| {
            let font = egui::TextStyle::Body.resolve(ui.style());
            let width = (ui.available_width() - 100.0).max(40.0);
            let name = names::fitted(ui, &self.name, &font, width).into_owned();
            ui.strong(name).on_hover_text(&self.name);
            let copy = ui.small_button("Copy table");
            let label = format!("Copy table: {}", self.name);
            copy.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &label));
            let hover = "Copy all rows, for a spreadsheet";
            if copy.on_hover_text(hover).clicked() {
                commands.push(Command::Copy(self.text()));
            }
        });
        ui.push_id(&self.name, |ui| {
            // A bar that is always there says that there are more columns.
            ui.spacing_mut().scroll = egui::style::ScrollStyle::thin();
            egui::ScrollArea::horizontal().show(ui, |ui| self.grid(ui));
        });
        ui.add_space(8.0);
    }

    fn grid(&self, ui: &mut egui::Ui) {
        // Columns learn their widths while they are drawn: with new texts that is done once more before
        // anybody sees it, for an idle window draws no second frame.
        let id = ui.scope_id().with("texts");
        let texts = ui.scope_id().with((&self.head, &self.rows));
        if ui.data(|data| data.get_temp(id)) != Some(texts) {
            ui.data_mut(|data| data.insert_temp(id, texts));
            ui.ctx().request_discard("a table has new texts");
        }
        let heads = self.head.iter().map(|(name, _)| laid_out(name, ui));
        let heads: Vec<Arc<Galley>> = heads.collect();
        let head_height = heads.iter().map(|name| name.size().y).fold(HEAD, f32::max);
        ui.spacing_mut().item_spacing.x = 12.0;
        TableBuilder::new(ui)
            .striped(true)
            .auto_shrink([true, true])
            .min_scrolled_height(TALLEST)
            .max_scroll_height(TALLEST)
            .cell_layout(egui::Layout::left_to_right(egui::Align::Center))
            .columns(Column::auto().at_least(24.0), self.head.len())
            .header(head_height, |mut header| {
                for ((name, hover), galley) in self.head.iter().zip(heads) {
                    header.col(|ui| {
                        let is_cut = galley.text() != name;
                        let mut label = names::whole(ui, galley, true);
                        if is_cut {
                            label = label.on_hover_text(name);
                        }
                        if !hover.is_empty() {
                            label.on_hover_text(hover);
                        }
                    });
                }
            })
            .body(|body| {
                body.rows(ROW, self.rows.len(), |mut row| {
                    let Some(cells) = self.rows.get(row.index()) else {
                        return;
                    };
                    for text in cells {
                        row.col(|ui| {
                            names::whole_number(ui, text, true);
                        });
                    }
                    row.response().widget_info(|| {
                        let first = cells.first().map_or("", String::as_str);
                        let label = format!("{}: {first}", self.name);
                        egui::WidgetInfo::labeled(egui::Role::Row, true, label)
                    });
                });
            });
    }

    /// The whole table, cells separated by tabs.
    fn text(&self) -> String {
        let head: Vec<&str> = self.head.iter().map(|(name, _)| name.as_str()).collect();
        let mut text = head.join("\t");
        text.push('\n');
        for row in &self.rows {
            // A cell of several lines would be several rows.
            let cells: Vec<String> = row.iter().map(|c| c.replace(['\t', '\n'], " ")).collect();
            text.push_str(&cells.join("\t"));
            text.push('\n');
        }
        text
    }
}

/// A column's name as it stands in the head, in several rows where it is long.
fn laid_out(name: &str, ui: &egui::Ui) -> Arc<Galley> {
    let font = egui::TextStyle::Body.resolve(ui.style());
    let name = names::fitted(ui, name, &font, HEAD_ROWS * WIDEST_HEAD).into_owned();
    let name = egui::WidgetText::from(egui::RichText::new(name).strong());
    let mode = Some(egui::TextWrapMode::Wrap);
    name.into_galley(ui, mode, WIDEST_HEAD, egui::TextStyle::Body)
}

/// A number with this many significant digits; a dash where there is none.
pub(super) fn number(value: impl Into<Option<f64>>, digits: u8) -> String {
    match value.into() {
        Some(0.0) => "0".to_owned(),
        Some(value) if value.is_finite() && !(1e-4..1e9).contains(&value.abs()) => {
            format!("{value:.*e}", usize::from(digits.max(1)) - 1)
        }
        Some(value) if value.is_finite() => significant_digits(value, digits),
        _ => "–".to_owned(),
    }
}

/// A number with a sign and so many decimals.
pub(super) fn signed(value: impl Into<Option<f64>>, decimals: usize) -> String {
    match value.into() {
        Some(value) if value.is_finite() => format!("{value:+.decimals$}"),
        _ => "–".to_owned(),
    }
}

/// A number with so many decimals.
pub(super) fn fixed(value: impl Into<Option<f64>>, decimals: usize) -> String {
    match value.into() {
        Some(value) if value.is_finite() => format!("{value:.decimals$}"),
        _ => "–".to_owned(),
    }
}
