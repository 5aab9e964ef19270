//! The small window that a table is pasted into.

use crate::command::Command;
use crate::panels::described;
use crate::panels::field::combo_box;
use crate::panels::path_field::takes_the_keys_at_first;
use crate::panels::working::working;
use crate::size_distributions::{DistributionCommand, PasteForm};
use crate::state::State;
use crate::tasks::work::Task;
use crate::units::LengthUnit;

/// In the empty field: where a table comes from, and what it looks like.
const HINT: &str = "Ctrl+V pastes what was copied elsewhere:\n\nsize_mm\tpercent_passing\n16\t12.5\n31.5\t40\n63\t100";

/// Draws the window's contents.
pub(in crate::panels) fn paste(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let before = &state.distributions.paste;
    let mut form = before.clone();
    ui.label(
        "A table from a spreadsheet or a text, its first line the columns' names: sizes and \
         cumulative percent passing, one line a point; or a column of sizes and one column a curve.",
    );
    let most = (ui.ctx().content_rect().height() - 330.0).clamp(60.0, 260.0);
    egui::ScrollArea::vertical()
        .max_height(most)
        .show(ui, |ui| {
            let field = egui::TextEdit::multiline(&mut form.table)
                .hint_text(HINT)
                .font(egui::TextStyle::Monospace)
                .desired_rows(9)
                .desired_width(f32::INFINITY);
            let field = ui.add(field);
            named(&field, "Table", &form.table);
            takes_the_keys_at_first(ui, &field);
            // No hover text: it would lie over the fields below.
            described(&field, || {
                "Ctrl+V pastes what was copied elsewhere".to_owned()
            });
        });
    egui::Grid::new("paste").num_columns(2).show(ui, |ui| {
        ui.label("Unit of the sizes");
        let combo = egui::ComboBox::from_id_salt("unit of the table")
            .selected_text(form.unit.symbol())
            .show_ui(ui, |ui| {
                for unit in LengthUnit::ALL {
                    ui.selectable_value(&mut form.unit, unit, unit.symbol());
                }
            });
        let chosen = form.unit.symbol();
        let list = combo.response;
        let list = list.on_hover_text("Where the table does not say it");
        combo_box(&list, "Unit of the table", chosen);
        ui.end_row();
        for (text, name, hint) in [
            (
                &mut form.method,
                "Method",
                "sieve, point cloud, scale object",
            ),
            (&mut form.trial, "Trial", "where there are several"),
        ] {
            ui.label(name);
            let field = egui::TextEdit::singleline(text)
                .hint_text(hint)
                .desired_width(240.0);
            let field = ui.add(field);
            named(&field, &format!("{name} of the table"), text);
            field.on_hover_text("For curves that the table does not give one");
            ui.end_row();
        }
    });
    if let Some(refused) = &before.refused {
        ui.colored_label(ui.visuals().error_fg_color, refused);
    }
    ui.separator();
    ui.horizontal(|ui| {
        let ready = !form.table.trim().is_empty();
        let add = ui.add_enabled(ready, egui::Button::new("Add table"));
        let add = add.on_disabled_hover_text("Paste a table first");
        let clicked = add.on_hover_text("Add its curves to the page").clicked();
        if changed(&form, before) {
            commands.push(fill(form));
        }
        if clicked {
            commands.push(Command::Distributions(DistributionCommand::Paste));
        }
        if state.work.is_running(Task::READ_DISTRIBUTIONS) {
            working(ui);
        }
    });
}

fn changed(form: &PasteForm, before: &PasteForm) -> bool {
    form != before
}

fn fill(form: PasteForm) -> Command {
    Command::Distributions(DistributionCommand::FillPaste(form))
}

fn named(field: &egui::Response, label: &str, text: &str) {
    field.widget_info(|| {
        let mut info = egui::WidgetInfo::labeled(egui::Role::TextInput, true, label);
        info.current_text_value = Some(text.to_owned());
        info
    });
}
