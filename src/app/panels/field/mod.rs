//! A field for a number: what is typed counts when the field is left, so that undo has one step for
//! it and nothing is computed for half a number.

pub(super) mod note;

use fragscale_formats::may_be_thousands;

use super::accessible::described;

/// How wide the field of a number is, points.
const NUMBER: f32 = 90.0;

/// Draws the field; returns the new number once it is settled. `label` names it for screen readers.
pub(super) fn number_field(
    ui: &mut egui::Ui,
    label: &str,
    hover: &str,
    value: f64,
    suffix: &str,
) -> Option<f64> {
    let text = in_field(value);
    // In a row that is wrapped the unit stands beside its number, not at the begin of the next row.
    let unit = super::rows::text_width(ui, suffix) + ui.spacing().item_spacing.x;
    let wide = NUMBER + 2.0 * ui.spacing().button_padding.x + unit;
    let has_room = ui.available_size_before_wrap().x >= wide;
    if ui.layout().main_wrap && !has_room && ui.max_rect().width() >= wide {
        ui.end_row();
    }
    let typed = text_field(ui, label, hover, &text, NUMBER);
    if !suffix.is_empty() {
        ui.label(suffix);
    }
    settled(ui, label, typed).filter(|number| *number != value)
}

/// A number as it stands in a field.
pub(super) fn in_field(value: f64) -> String {
    let text = crate::numbers::significant_digits(value, 10);
    match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    }
}

/// The number that was typed into the field of that label. Why it was not taken stays beside the field until
/// something else is typed there.
pub(super) fn settled(ui: &mut egui::Ui, label: &str, typed: Option<String>) -> Option<f64> {
    let field = id_of(ui, label);
    let id = field.with("not taken");
    let read = typed.map(|typed| number_of(&typed));
    if let Some(Err(why)) = &read {
        ui.data_mut(|data| data.insert_temp(id, why.clone()));
    } else if read.is_some() || ui.memory(|memory| memory.has_focus(field)) {
        ui.data_mut(|data| data.remove::<String>(id));
    }
    if let Some(why) = ui.data(|data| data.get_temp::<String>(id)) {
        let warn = ui.visuals().warn_fg_color;
        let sign = ui.colored_label(warn, "⚠ not taken").on_hover_text(&why);
        sign.widget_info(|| {
            egui::WidgetInfo::labeled(egui::Role::Label, true, format!("{label}: {why}"))
        });
    }
    read?.ok()
}

/// What was typed as a number: a decimal comma is what half of the world types. Or why it is none.
pub(super) fn number_of(typed: &str) -> Result<f64, String> {
    let text = typed.trim();
    if text.contains(',') && may_be_thousands(text) {
        let [whole, point] = ["", "."].map(|sign| text.replace(',', sign));
        return Err(format!(
            "{text} may have a decimal comma or one between thousands: write {whole} or {point}"
        ));
    }
    match text.replace(',', ".").parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        _ => Err(format!("'{text}' is not a number")),
    }
}

/// What stands in the field of that label, while it is typed and does not count yet.
pub(super) fn being_typed(ui: &egui::Ui, label: &str) -> Option<String> {
    let field = id_of(ui, label);
    ui.data(|data| data.get_temp(field))
}

/// By what a field is known from frame to frame, and what is typed in it kept.
fn id_of(ui: &egui::Ui, key: impl std::hash::Hash + std::fmt::Debug) -> egui::Id {
    ui.scope_id().with(key)
}

/// Draws a field for a text; returns what was typed once the field is left.
pub(super) fn text_field(
    ui: &mut egui::Ui,
    label: &str,
    hover: &str,
    text: &str,
    width: f32,
) -> Option<String> {
    hinted_field(ui, label, hover, text, "…", width)
}

/// The same with words that stand in it while it is empty.
pub(super) fn hinted_field(
    ui: &mut egui::Ui,
    label: &str,
    hover: &str,
    text: &str,
    hint: &str,
    width: f32,
) -> Option<String> {
    field_of(ui, label, label, hover, text, hint, width)
}

/// The same that is told by `key` where its label changes with what is typed elsewhere: else a field that is entered would be another
/// one in the next frame, and letters would be tools.
pub(super) fn field_of(
    ui: &mut egui::Ui,
    key: impl std::hash::Hash + std::fmt::Debug,
    label: &str,
    hover: &str,
    text: &str,
    hint: &str,
    width: f32,
) -> Option<String> {
    let id = id_of(ui, key);
    let mut typed: String = ui
        .data(|data| data.get_temp(id))
        .unwrap_or_else(|| text.to_owned());
    let field = ui.add(
        egui::TextEdit::singleline(&mut typed)
            .id(id)
            .hint_text(hint)
            .desired_width(width),
    );
    field.widget_info(|| {
        let mut info = egui::WidgetInfo::labeled(egui::Role::TextInput, true, label);
        info.current_text_value = Some(typed.clone());
        info
    });
    let left = field.lost_focus();
    let editing = field.has_focus();
    field.on_hover_text(hover);
    if editing {
        ui.data_mut(|data| data.insert_temp(id, typed));
        return None;
    }
    ui.data_mut(|data| data.remove::<String>(id));
    (left && typed != text).then_some(typed)
}

/// Says to a screen reader what a list to choose from is called, and what is chosen.
pub(super) fn combo_box(list: &egui::Response, name: &str, chosen: &str) {
    list.widget_info(|| {
        let mut info = egui::WidgetInfo::labeled(egui::Role::ComboBox, true, name);
        info.current_text_value = Some(chosen.to_owned());
        info
    });
    // Under Linux a list's value is not handed on.
    described(list, || chosen.to_owned());
}
