//! The review: one photo with what speaks against it and what shows that, to be accepted or left out.

mod row_menu;

use egui::RichText;

pub(super) use row_menu::row_menu;

use crate::actions::{self, Action};
use crate::command::{Command, ReviewStep, Tab};
use crate::flight::{DecisionKind, OnPhoto, PhotoReview};
use crate::names::{self, unbroken};
use crate::open_flight::OpenFlight;
use crate::open_flight::reviewing::ReviewProgress;
use crate::panels::Scrolled;
use crate::panels::field::note::NoteField;
use crate::panels::inspector::{Inspector, Offer, SIZE_ERROR, remedy_button};
use crate::panels::verdict::{verdict_color, verdict_label};
use crate::reviewing::note_field;
use crate::state::State;

/// Draws the page.
pub(super) fn review(
    state: &State,
    inspector: &mut Inspector,
    ui: &mut egui::Ui,
    commands: &mut Vec<Command>,
) {
    let Some(open) = &state.open else {
        return;
    };
    progress(state, open, ui, commands);
    let Some((photo, reviewed)) = open.selected_review() else {
        ui.weak("Select a photo in the table or in the viewport.");
        if !open.table.doubtful.is_empty() {
            button(
                state,
                actions::review::NEXT_DOUBTFUL,
                "Next",
                false,
                ui,
                commands,
            );
        }
        return;
    };
    heading(state, reviewed, ui);
    let sight = open.sight().map(|sight| sight.on_photo);
    // Where nothing speaks against it, what it goes along with.
    let on_photo = sight.unwrap_or(OnPhoto::TopBottom);
    inspector.reason_picture(state, open, (photo, reviewed), &on_photo, ui);
    egui::ScrollArea::vertical().show_focused(ui, |ui| {
        if !reviewed.is_doubtful() && open.review.is_looked_at() && !state.compares_photos() {
            ui.weak("Nothing speaks against the selected photo.");
        }
        reasons(state, open, reviewed, ui, commands);
        size_errors(state, reviewed, ui);
        if let Some(decided) = reviewed.decided() {
            ui.add(egui::Label::new(RichText::new(decided).italics()).wrap());
        }
        decide(state, photo, reviewed, ui, commands);
    });
}

/// How far the review is, and what is done at its end.
fn progress(state: &State, open: &OpenFlight, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let progress = open.review_progress();
    if progress.doubtful == 0 {
        ui.label(
            match open.review.is_looked_at() && !state.compares_photos() {
                true => "No photo is doubtful.",
                false => "Looking for reasons for doubt…",
            },
        );
    } else {
        ui.horizontal_wrapped(|ui| {
            let place = match progress.at {
                Some(at) => format!("{at} of {}", progress.doubtful),
                None => format!("{} doubtful", progress.doubtful),
            };
            ui.strong(place);
            let decided = ui.weak(format!(
                "{} to decide, {} accepted, {} left out",
                progress.waiting, progress.accepted, progress.left_out
            ));
            if let Some(why) = why_more_accepted(progress) {
                decided.on_hover_text(why);
            }
        });
    }
    if progress.waiting > 0 || !open.review.is_looked_at() {
        return;
    }
    ui.horizontal_wrapped(|ui| {
        if progress.doubtful > 0 {
            ui.label("All doubtful photos are decided.");
        }
        let chosen = open.chosen_count();
        let text = RichText::new(format!("Export {chosen}…")).strong();
        let export = ui.add_enabled(chosen > 0, egui::Button::new(text));
        export.widget_info(|| {
            let label = "Export what was reviewed";
            egui::WidgetInfo::labeled(egui::Role::Button, chosen > 0, label)
        });
        if export.on_hover_text(actions::file::EXPORT.hover).clicked() {
            commands.extend((actions::file::EXPORT.command)(state));
        }
    });
}

/// Why more photos are accepted here than in the tool bar; `None` where they are as many.
fn why_more_accepted(progress: ReviewProgress) -> Option<String> {
    let (photos, them) = match progress.accepted_and_trusted {
        0 => return None,
        1 => ("1 of the accepted photos counts".to_owned(), "it"),
        n => (format!("{n} of the accepted photos count"), "them"),
    };
    Some(format!(
        "{photos} as trusted in the tool bar: nothing speaks against {them} any more"
    ))
}

fn heading(state: &State, reviewed: PhotoReview<'_>, ui: &mut egui::Ui) {
    // From the right, so that a long name gives way.
    let right = egui::Layout::right_to_left(egui::Align::Center);
    let row = egui::vec2(ui.available_width(), ui.spacing().interact_size.y);
    ui.allocate_ui_with_layout(row, right, |ui| {
        if let Some(verdict) = reviewed.settled() {
            verdict_label(state, verdict, ui);
        }
        ui.with_layout(egui::Layout::left_to_right(egui::Align::Center), |ui| {
            let body = egui::TextStyle::Body;
            names::styled(ui, reviewed.name(), body, RichText::strong);
        });
    });
}

/// Every reason, the one that is shown marked; a click shows another one.
fn reasons(
    state: &State,
    open: &OpenFlight,
    reviewed: PhotoReview<'_>,
    ui: &mut egui::Ui,
    commands: &mut Vec<Command>,
) {
    let shown = open.reason();
    for (place, doubt) in reviewed.doubts.iter().enumerate() {
        let is_shown = shown.is_some_and(|shown| std::ptr::eq(shown, doubt));
        let said = doubt.to_string();
        let color = verdict_color(reviewed.own_verdict, ui.visuals());
        let text = match is_shown {
            true => RichText::new(unbroken(&said)).color(color).strong(),
            false => RichText::new(unbroken(&said)).weak(),
        };
        let label = egui::Label::new(text).wrap().selectable(false);
        let label = ui.add(label.sense(egui::Sense::click()));
        if is_shown {
            label.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Label, true, &said));
            if let Some(remedy) = Offer::against(state, doubt) {
                remedy_button(remedy, ui, commands);
            }
        } else {
            label.widget_info(|| {
                egui::WidgetInfo::labeled(egui::Role::Button, true, format!("Show: {said}"))
            });
            if label.on_hover_text("Show this reason").clicked() {
                commands.push(Command::Review(ReviewStep::Reason(place)));
            }
        }
    }
}

/// The scales to be trusted or not, and what their error does to sizes.
fn size_errors(state: &State, reviewed: PhotoReview<'_>, ui: &mut egui::Ui) {
    let unit = state.preferences.unit();
    let ends = reviewed.estimates(reviewed.pair, unit);
    for (name, end) in ["top", "bottom"].into_iter().zip(ends) {
        let Some(end) = end.filter(|_| reviewed.unit_known) else {
            continue;
        };
        let error = end.size_error();
        let error = error.map_or_else(String::new, |error| format!(": P80 {error}"));
        let text = format!("{name} {} px/{unit}{error}", end.text(5));
        ui.add(egui::Label::new(unbroken(&text)).wrap())
            .on_hover_text(SIZE_ERROR);
    }
}

/// The note, and what is decided with it.
fn decide(
    state: &State,
    photo: usize,
    reviewed: PhotoReview<'_>,
    ui: &mut egui::Ui,
    commands: &mut Vec<Command>,
) {
    let Some(open) = state.open.as_deref() else {
        return;
    };
    let field = NoteField {
        id: note_field(Tab::Review),
        label: "Note of the review",
        hint: "Note: why (W)",
        enter: (actions::review::ACCEPT.command)(state),
    };
    field.show(open, photo, ui, commands);
    let decided = reviewed.decision.map(|decision| decision.kind);
    let is = |kind| decided == Some(kind) && !reviewed.waits_for_decision();
    let accepted = is(DecisionKind::Accepted);
    let left_out = is(DecisionKind::LeftOut);
    ui.horizontal_wrapped(|ui| {
        let accept = button(
            state,
            actions::review::ACCEPT,
            "Accept (Enter)",
            accepted,
            ui,
            commands,
        );
        let goes_by_itself = match left_out {
            true => "Nothing speaks against it: taken back, it goes along",
            false => "Nothing speaks against it: there is nothing to accept",
        };
        let why_not = open.why_not_accepted(&reviewed);
        accept.on_disabled_hover_text(why_not.unwrap_or(goes_by_itself));
        button(
            state,
            actions::review::LEAVE_OUT,
            "Leave out (Del)",
            left_out,
            ui,
            commands,
        );
        if decided.is_some() {
            let take_back = ui.button("Take back");
            take_back.widget_info(|| {
                let label = "Take the decision back";
                egui::WidgetInfo::labeled(egui::Role::Button, true, label)
            });
            let hover = "Decide nothing: the photo goes along if nothing speaks against it";
            if take_back.on_hover_text(hover).clicked() {
                commands.push(Command::Decide(photo, None));
            }
        }
    });
    ui.horizontal_wrapped(|ui| {
        button(
            state,
            actions::review::DOUBTFUL_BEFORE,
            "Back (Shift+N)",
            false,
            ui,
            commands,
        );
        button(
            state,
            actions::review::NEXT_DOUBTFUL,
            "Next (N)",
            false,
            ui,
            commands,
        );
    });
}

/// A button for an action, grey where it makes no sense.
fn button(
    state: &State,
    action: Action,
    text: &str,
    on: bool,
    ui: &mut egui::Ui,
    commands: &mut Vec<Command>,
) -> egui::Response {
    let command = (action.command)(state);
    let button = ui.add_enabled(command.is_some(), egui::Button::new(text).selected(on));
    button.widget_info(|| {
        egui::WidgetInfo::selected(egui::Role::Button, command.is_some(), on, action.label)
    });
    let button = button.on_hover_text(action.hover);
    if button.clicked() {
        commands.extend(command);
    }
    button
}
