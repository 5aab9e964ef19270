//! The curves by method, trial and photo: which are drawn.

use crate::app::command::Command;
use crate::app::size_distributions::{Computed, DistributionCommand};
use crate::app::state::State;
use crate::fragmentation::{LabelledDistribution, Labels};

/// Draws the tree.
pub(super) fn curves(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let Some(computed) = &state.distributions.computed else {
        return;
    };
    for method in &computed.methods {
        let of_method = curves_of(computed, method, None);
        branch(state, method, method, &of_method, ui, commands);
    }
}

fn curves_of<'a>(
    computed: &'a Computed,
    method: &str,
    trial: Option<&str>,
) -> Vec<&'a LabelledDistribution> {
    let wanted = |curve: &&LabelledDistribution| {
        let Labels {
            method: m,
            trial: t,
            ..
        } = &curve.labels;
        m == method && trial.is_none_or(|trial| t == trial)
    };
    computed.set.curves.iter().filter(wanted).collect()
}

fn branch(
    state: &State,
    name: &str,
    text: &str,
    curves: &[&LabelledDistribution],
    ui: &mut egui::Ui,
    commands: &mut Vec<Command>,
) {
    let hidden = &state.distributions.hidden;
    let shown = curves
        .iter()
        .filter(|c| !hidden.contains(&c.labels))
        .count();
    let mut all = shown == curves.len();
    let mixed = shown > 0 && !all;
    let response = ui.add(egui::Checkbox::new(&mut all, text).indeterminate(mixed));
    response.widget_info(|| {
        egui::WidgetInfo::selected(egui::Role::CheckBox, true, all, format!("Show {name}"))
    });
    if response.on_hover_text("Draw its curves, or not").changed() {
        let labels = curves.iter().map(|curve| curve.labels.clone()).collect();
        let command = DistributionCommand::Show(labels, all);
        commands.push(Command::Distributions(command));
    }
}
