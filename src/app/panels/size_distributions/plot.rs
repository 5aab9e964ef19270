//! Percent passing over the size.

use egui_plot::{Plot, PlotPoints, Points};

use super::log_axis;
use crate::app::command::Command;
use crate::app::state::State;

/// Draws the plot.
pub(super) fn plot(state: &State, ui: &mut egui::Ui, _commands: &mut Vec<Command>) {
    let Some(computed) = &state.distributions.computed else {
        return;
    };
    Plot::new("size distributions")
        .x_grid_spacer(|input| log_axis::marks(&input))
        .x_axis_formatter(log_axis::label)
        .show(ui, |plot| {
            for curve in &computed.set.curves {
                if state.distributions.hidden.contains(&curve.labels) {
                    continue;
                }
                let points = curve.distribution.points().iter();
                let points: PlotPoints = points.map(|[size, p]| [size.log10(), *p]).collect();
                plot.points(Points::new(curve.labels.to_string(), points).radius(3.0));
            }
        });
}
