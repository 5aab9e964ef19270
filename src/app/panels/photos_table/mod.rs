//! The photos with their scales: one row each, only the rows in sight are drawn.
//!
//! ```text
//! columns   how wide each column is
//! ```

mod columns;

use egui_extras::{Column as Width, TableBuilder};

use super::accessible::{described, scales_in_words};
use super::cloud_alone::cloud_alone;
use super::field::combo_box;
use super::review::row_menu;
use super::rows::text_width;
use super::verdict::{PENDING, verdict_of_now, why_pending};
use crate::command::Command;
use crate::exports::{ColumnKind, PhotoLine};
use crate::flight::{PhotoReview, Verdict};
use crate::names;
use crate::open_flight::OpenFlight;
use crate::open_flight::reviewing::no_scale;
use crate::open_flight::table::SortBy;
use crate::state::State;
use columns::{CHECK, Columns};

/// The height of the headings, which two lines fit into.
const HEADER: f32 = 36.0;

/// The height of a row, which a thumbnail fits into.
const ROW: f32 = 34.0;

/// The width of a thumbnail.
const THUMBNAIL: f32 = ROW * 1.1;

/// Draws the table.
pub fn photos_table(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let Some(open) = &state.open else {
        return;
    };
    if open.review.count() == 0 {
        cloud_alone(ui, commands);
        return;
    }
    filter(open, ui, commands);
    // A bar that is always there says that there are more columns; a shadow would lie on the last number.
    let scroll = ui.spacing().scroll;
    ui.spacing_mut().scroll = egui::style::ScrollStyle::thin();
    ui.spacing_mut().scroll.fade.strength = 0.0;
    egui::ScrollArea::horizontal()
        .auto_shrink(false)
        .show(ui, |ui| {
            ui.spacing_mut().scroll = scroll;
            table(state, open, ui, commands);
        });
    if open.table.shown.is_empty() {
        ui.weak("No photo passes the filter.");
    }
}

fn table(state: &State, open: &OpenFlight, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let mut columns = Columns::of(
        (open.number, state.preferences.unit().symbol()),
        open.history.now().pair,
        ui,
    );
    let gap = ui.spacing().item_spacing.x;
    let widths = columns.widths(ui.available_width(), gap);
    let has_thumbnail = columns.has_thumbnail(THUMBNAIL + gap, &widths);
    let seen = columns.seen();
    let verdict_in_sight = columns.is_in_sight(ColumnKind::Verdict, &widths, ui);
    let selected_row = open
        .selected
        .and_then(|photo| open.table.shown.iter().position(|&shown| shown == photo));
    let id = ui.scope_id().with("selected row");
    let before: Option<Option<usize>> = ui.data(|data| data.get_temp(id));
    let mut table = TableBuilder::new(ui)
        .id_salt("photos")
        .striped(true)
        // Not by Tab: a row has as many cells as columns, and arrows go from row to row.
        .sense(egui::Sense::CLICK)
        .cell_layout(egui::Layout::left_to_right(egui::Align::Center))
        .column(Width::exact(CHECK));
    for width in &widths {
        table = table.column(Width::exact(*width).clip(true));
    }
    // The selected row comes into sight when the selection moves, not while she scrolls.
    if before != Some(selected_row)
        && let Some(row) = selected_row
    {
        table = table.scroll_to_row(row, None);
    }
    let mut hovered = None;
    table
        .header(HEADER, |mut header| {
            header.col(|ui| {
                let hover = "Goes along into the export";
                sort_button(open, SortBy::Export, "⬇", hover, ui, commands);
            });
            for column in &columns.all {
                let by = SortBy::Column(column);
                header.col(|ui| {
                    sort_button(open, by, column.name, column.hover, ui, commands);
                });
            }
        })
        .body(|body| {
            body.rows(ROW, open.table.shown.len(), |mut row| {
                let photo = open.table.shown[row.index()];
                let Some(row_of_photo) = open.row(photo) else {
                    return;
                };
                let (line, chosen) = (row_of_photo.line, row_of_photo.goes_along());
                // What is shown is typed.
                let line = PhotoLine {
                    unit: state.preferences.unit(),
                    to_type: true,
                    ..line
                };
                let name = line.photo.name();
                row.set_selected(open.selected == Some(photo));
                row.col(|ui| {
                    // What went along before it had no scale is still left out by it.
                    let why_not = no_scale(&line.photo).filter(|_| !chosen);
                    if let Some(chosen) = export_box(name, chosen, why_not, ui) {
                        commands.push(Command::Choose(photo, chosen));
                    }
                });
                for (place, column) in columns.all.clone().into_iter().enumerate() {
                    row.col(|ui| {
                        if column.kind == ColumnKind::Name && has_thumbnail {
                            thumbnail(open, photo, ui);
                        }
                        match column.kind {
                            ColumnKind::Verdict => verdict(state, line.photo, false, ui),
                            ColumnKind::Name | ColumnKind::Text => {
                                let text = column.short_value(&line);
                                if column.kind == ColumnKind::Name && !verdict_in_sight {
                                    // In a narrow list the verdict goes last.
                                    let beside = sign_width(state, line.photo, ui) + gap;
                                    columns.note(place, &text, beside, ui);
                                    verdict(state, line.photo, true, ui);
                                } else {
                                    columns.note(place, &text, 0.0, ui);
                                }
                                names::name(ui, &text);
                            }
                            kind => {
                                let text = open.table.number(column, &line);
                                columns.note(place, &text, 0.0, ui);
                                let number = names::whole_number(ui, text, false);
                                if kind == ColumnKind::Scale {
                                    // All digits are under the mouse.
                                    number.on_hover_text(column.table_value(&line));
                                }
                            }
                        }
                    });
                }
                let response = row.response();
                response.widget_info(|| {
                    let label = format!("Photo {name}");
                    let selected = open.selected == Some(photo);
                    egui::WidgetInfo::selected(egui::Role::Row, true, selected, label)
                });
                described(&response, || scales_in_words(state, &line));
                if response.clicked() {
                    commands.push(Command::Select(Some(photo)));
                }
                response.context_menu(|ui| row_menu(state, photo, ui, commands));
                if response.double_clicked() {
                    commands.push(Command::View(crate::command::ViewChange::FitSelected));
                }
                if response.hovered() {
                    hovered = Some(photo);
                }
            });
        });
    columns.keep(&widths, &seen, ui);
    ui.data_mut(|data| data.insert_temp(id, selected_row));
    if hovered != open.table.hovered {
        commands.push(Command::HoverPhoto(hovered));
    }
}

/// The box of a photo that goes along or not, grey where `why_not` says why; returns what it was changed to.
fn export_box(
    name: &str,
    mut chosen: bool,
    why_not: Option<&str>,
    ui: &mut egui::Ui,
) -> Option<bool> {
    let can = why_not.is_none();
    let check = ui.add_enabled(can, egui::Checkbox::new(&mut chosen, ""));
    check.widget_info(|| {
        let label = format!("Export {name}");
        egui::WidgetInfo::selected(egui::Role::CheckBox, can, chosen, label)
    });
    let check = check.on_hover_text("Export this photo");
    let check = check.on_disabled_hover_text(why_not.unwrap_or_default());
    check.changed().then_some(chosen)
}

fn filter(open: &OpenFlight, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    ui.horizontal_wrapped(|ui| {
        let mut text = open.table.order.text.clone();
        let field = egui::TextEdit::singleline(&mut text)
            .hint_text("Filter by name or reason")
            .desired_width(170.0);
        let field = ui.add(field);
        field.widget_info(|| {
            let mut info = egui::WidgetInfo::labeled(egui::Role::TextInput, true, "Filter photos");
            info.current_text_value = Some(open.table.order.text.clone());
            info
        });
        if field.changed() {
            commands.push(Command::Filter(text));
        }
        let wanted = open
            .table
            .order
            .verdict
            .map_or("any verdict", Verdict::as_str);
        let list = egui::ComboBox::from_id_salt("verdict filter")
            .selected_text(wanted)
            .width(90.0)
            .show_ui(ui, |ui| {
                let mut choice = |verdict: Option<Verdict>, name: &str| {
                    if ui
                        .selectable_label(open.table.order.verdict == verdict, name)
                        .clicked()
                    {
                        commands.push(Command::FilterVerdict(verdict));
                    }
                };
                choice(None, "any verdict");
                for verdict in Verdict::ALL {
                    choice(Some(verdict), verdict.as_str());
                }
            })
            .response
            .on_hover_text("Show only photos with this verdict");
        combo_box(&list, "Filter by verdict", wanted);
        let is_on = open.table.order.doubtful;
        let doubtful = ui.selectable_label(is_on, "doubtful");
        doubtful.widget_info(|| {
            let label = "Only doubtful photos";
            egui::WidgetInfo::selected(egui::Role::Button, true, is_on, label)
        });
        let hover = "Show only photos that something speaks against, decided or not";
        if doubtful.on_hover_text(hover).clicked() {
            commands.push(Command::FilterDoubtful(!is_on));
        }
        let shown = format!("{} of {}", open.table.shown.len(), open.review.count());
        ui.add(egui::Label::new(egui::RichText::new(shown).weak()).extend());
        let errors = open.flight().errors_of_all();
        if let (Some(percent), Some(words)) = (errors.world_percent(), errors.world_in_words()) {
            let shared = egui::RichText::new(format!("all scales share ± {percent}")).weak();
            let shared = ui.add(egui::Label::new(shared).extend());
            shared.on_hover_text(format!("Of each photo's 95 % interval, {words}"));
        }
    });
}

fn sort_button(
    open: &OpenFlight,
    by: SortBy,
    name: &str,
    hover: &str,
    ui: &mut egui::Ui,
    commands: &mut Vec<Command>,
) {
    let arrow = match (open.table.order.by == by, open.table.order.descending) {
        (true, false) => " ⏶",
        (true, true) => " ⏷",
        (false, _) => "",
    };
    let text = egui::RichText::new(format!("{name}{arrow}")).strong();
    let button = ui.add(egui::Button::new(text).frame(false).wrap());
    let button = button.on_hover_text(format!("{hover}. Click to sort."));
    button.widget_info(|| {
        egui::WidgetInfo::labeled(
            egui::Role::Button,
            true,
            format!("Sort by {}", hover.to_lowercase()),
        )
    });
    if button.clicked() {
        commands.push(Command::Sort(by));
    }
}

fn thumbnail(open: &OpenFlight, photo: usize, ui: &mut egui::Ui) {
    let size = egui::vec2(THUMBNAIL, ROW - 6.0);
    match open.pictures.thumbnails.get(photo).and_then(Option::as_ref) {
        Some(texture) => {
            let image = egui::Image::new(texture).fit_to_exact_size(size);
            ui.add(
                image
                    .maintain_aspect_ratio(true)
                    .sense(egui::Sense::empty()),
            );
        }
        None => {
            let (place, _) = ui.allocate_exact_size(size, egui::Sense::empty());
            let color = ui.visuals().faint_bg_color;
            ui.painter().rect_filled(place, 2.0, color);
        }
    }
}

/// How wide the sign of its verdict is, points.
fn sign_width(state: &State, photo: PhotoReview<'_>, ui: &egui::Ui) -> f32 {
    let sign = |verdict| verdict_of_now(state, verdict, ui.visuals()).0;
    text_width(ui, photo.settled().map_or(PENDING, sign))
}

/// The verdict, or its sign alone.
fn verdict(state: &State, photo: PhotoReview<'_>, is_sign: bool, ui: &mut egui::Ui) {
    let Some(verdict) = photo.settled() else {
        ui.weak(PENDING).on_hover_text("Not looked at yet");
        return;
    };
    let (sign, color) = verdict_of_now(state, verdict, ui.visuals());
    let words = match is_sign {
        true => sign.to_owned(),
        false => format!("{sign} {verdict}"),
    };
    let words = egui::RichText::new(words).color(color);
    let label = ui.add(egui::Label::new(words).selectable(false).truncate());
    let mut reasons = photo.reasons_and_decision();
    reasons.extend(why_pending(state, verdict));
    if !reasons.is_empty() {
        label.on_hover_text(reasons.join("\n"));
    }
}
