//! How well each known position fits: the residual table of a georeferenced reconstruction.

use egui_extras::{Column as Width, TableBuilder};

use crate::command::Command;
use crate::names;
use crate::opening::{Georeferenced, PositionResidual};

/// The height of a row.
const ROW: f32 = 18.0;

/// Draws the table and the button that copies it.
pub(super) fn residuals(fitted: &Georeferenced, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let id = ui.scope_id().with("longest residual first");
    let mut longest_first: bool = ui.data(|data| data.get_temp(id)).unwrap_or(false);
    let mut rows: Vec<&PositionResidual> = fitted.positions.iter().collect();
    if longest_first {
        let length = |row: &PositionResidual| row.residual.length();
        rows.sort_by(|a, b| length(b).total_cmp(&length(a)));
    }
    let unit = fitted.unit;
    let number = || Width::initial(62.0).at_least(40.0).clip(true);
    TableBuilder::new(ui)
        .id_salt("residuals")
        .striped(true)
        .cell_layout(egui::Layout::left_to_right(egui::Align::Center))
        .column(
            Width::initial(150.0)
                .at_least(60.0)
                .resizable(true)
                .clip(true),
        )
        .columns(number(), 4)
        .column(Width::remainder().clip(true))
        .min_scrolled_height(150.0)
        .max_scroll_height(150.0)
        .header(20.0, |mut header| {
            for (name, hover) in [
                ("Position", "The photo or control point"),
                ("dE", "Known less fitted, to the east"),
                ("dN", "Known less fitted, to the north"),
                ("dU", "Known less fitted, upwards"),
            ] {
                header.col(|ui| {
                    let name = match name {
                        "Position" => name.to_owned(),
                        _ => format!("{name} {unit}"),
                    };
                    ui.strong(name).on_hover_text(hover);
                });
            }
            header.col(|ui| {
                let arrow = if longest_first { " ⏷" } else { "" };
                let text = egui::RichText::new(format!("Length{arrow}")).strong();
                let button = ui.add(egui::Button::new(text).frame(false));
                button.widget_info(|| {
                    egui::WidgetInfo::labeled(egui::Role::Button, true, "Sort by length")
                });
                let hover = "Of the three. Click for the longest first, or for the list's order";
                longest_first ^= button.on_hover_text(hover).clicked();
            });
            header.col(|ui| {
                let hover = "Whether it was used; an outlier does not agree with the others";
                ui.strong("Used").on_hover_text(hover);
            });
        })
        .body(|body| {
            body.rows(ROW, rows.len(), |mut row| {
                let Some(position) = rows.get(row.index()) else {
                    return;
                };
                let [name, numbers @ .., used] = cells(fitted, position);
                row.col(|ui| {
                    names::name(ui, &name);
                });
                for text in numbers {
                    row.col(|ui| {
                        names::whole_number(ui, text, true);
                    });
                }
                row.col(|ui| {
                    if position.used {
                        ui.label(used);
                    } else {
                        ui.colored_label(ui.visuals().warn_fg_color, used);
                    }
                });
                row.response().widget_info(|| {
                    let label = format!("Residual of {}", position.name);
                    egui::WidgetInfo::labeled(egui::Role::Row, true, label)
                });
            });
        });
    ui.data_mut(|data| data.insert_temp(id, longest_first));
    let copy = ui.button("Copy table");
    let hover = "Copy all rows, for a spreadsheet";
    if copy.on_hover_text(hover).clicked() {
        let mut text = format!("position\tdE {unit}\tdN {unit}\tdU {unit}\tlength {unit}\tused\n");
        for position in rows {
            text.push_str(&cells(fitted, position).join("\t"));
            text.push('\n');
        }
        commands.push(Command::Copy(text));
    }
}

/// Name, east, north, up, length, used.
fn cells(fitted: &Georeferenced, position: &PositionResidual) -> [String; 6] {
    let [east, north, up] = position.residual.to_array();
    let number = |number: f64| fitted.residual_in_words(number);
    let used = if position.used { "used" } else { "outlier" };
    let used = match position.marks_px {
        Some(px) => format!("{used}, marks {px:.2} px"),
        None => used.to_owned(),
    };
    [
        position.name.clone(),
        number(east),
        number(north),
        number(up),
        number(position.residual.length()),
        used,
    ]
}
