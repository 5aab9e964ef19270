//! Of the small window that makes a new flight from photos, what a NodeODM needs and says.

use std::sync::PoisonError;

use super::named_field;
use crate::from_photos::{Ended, FromNode, FromPhotos, NodeForm, Secret};
use crate::names;
use crate::panels::field::hinted_field;

/// Where the node is, what opens it, and what OpenDroneMap is asked for.
pub(super) fn node_rows(form: &mut NodeForm, ui: &mut egui::Ui) {
    // What the labels leave.
    let width = (ui.available_width() - 60.0).max(160.0);
    let mut is_typed = false;
    egui::Grid::new("node").num_columns(2).show(ui, |ui| {
        let label = "Address";
        ui.label(label);
        let hover = "Of a NodeODM or ClusterODM. The photos go there and nowhere else, with where they were taken and \
                     their gcp_list.txt if there is one";
        let hint = "http://localhost:3000 or https://host";
        // From the first letter on: Start is there before the field is left, and one click does both.
        let field = egui::TextEdit::singleline(&mut form.address).hint_text(hint);
        let field = ui.add(field.desired_width(width));
        is_typed = field.has_focus();
        named_field(field, label, hover, &form.address);
        ui.end_row();
        let label = "Token";
        ui.label(label);
        let Secret(token) = &mut form.token;
        let field = egui::TextEdit::singleline(token)
            .password(true)
            .hint_text("if the node asks for one")
            .desired_width(width);
        let field = ui.add(field);
        // Not what is typed: that is nobody's to read aloud.
        field.widget_info(|| egui::WidgetInfo::labeled(egui::Role::PasswordInput, true, label));
        field.on_hover_text("It is sent to the node, and never written to a file or log");
        ui.end_row();
        let label = "Options";
        ui.label(label);
        let hover =
            "Of OpenDroneMap, name=value, apart by blanks; the node is asked first which it knows";
        let hint = "pc-quality=high feature-quality=high";
        if let Some(typed) = hinted_field(ui, label, hover, &form.options, hint, width) {
            form.options = typed;
        }
        ui.end_row();
    });
    // Half of an address is no error.
    if !is_typed
        && !form.address.trim().is_empty()
        && let Err(fault) = form.typed()
    {
        ui.colored_label(ui.visuals().error_fg_color, fault.to_string());
    }
    if form.is_open_to_all() {
        let box_ = ui.checkbox(&mut form.insecure, "Not encrypted: I trust the network");
        box_.on_hover_text(
            "Photos and token go to this address as they are; https:// would encrypt them",
        );
    }
}

/// So many points high.
const MESSAGES: f32 = 72.0;

/// The node's last messages, the newest in sight.
pub(super) fn messages(held: &FromPhotos, ui: &mut egui::Ui) {
    told(held, |told| {
        if told.messages.is_empty() {
            return;
        }
        let area = egui::ScrollArea::vertical()
            .id_salt("messages of the node")
            .max_height(MESSAGES)
            .auto_shrink([false, true])
            .stick_to_bottom(true);
        area.show(ui, |ui| {
            for message in &told.messages {
                names::name(ui, message);
            }
        });
    });
}

/// What came of a run on a node that made no flight.
pub(super) fn ended_on_node(held: &FromPhotos, ended: &Ended, ui: &mut egui::Ui) {
    match ended {
        Ended::Failed(why) => {
            ui.colored_label(ui.visuals().error_fg_color, why);
            messages(held, ui);
        }
        Ended::Cancelled => told(held, |told| {
            ui.label(match &told.called_off {
                Some(said) => format!("Cancelled: {said}."),
                None => "Cancelled. The node is being told…".to_owned(),
            });
        }),
        Ended::Made(_) => {}
    }
}

fn told(held: &FromPhotos, show: impl FnOnce(&FromNode)) {
    if let Some(told) = &held.node {
        show(&told.lock().unwrap_or_else(PoisonError::into_inner));
    }
}
