//! Percent passing, or percent error, over the size.

use egui::Color32;
use egui_plot::{
    Corner, FilledArea, HLine, HoverPosition, Legend, LegendGrouping, Line, LineStyle, MarkerShape,
    Plot, PlotPoint, PlotPoints, PlotUi, Points,
};

use super::log_axis;
use crate::app::command::Command;
use crate::app::size_distributions::drawing::{Area, Drawing, MethodDrawing};
use crate::app::size_distributions::{Computed, DistributionCommand, PlotOf};
use crate::app::state::State;
use crate::app::work::Task;
use crate::exports::{Dash, Look, Marker};

/// Draws what is above the plot, and the plot.
pub(super) fn plot(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let mut reset = false;
    ui.horizontal_wrapped(|ui| {
        for (plot, name, hover) in [
            (PlotOf::Passing, "Percent passing", "The curves, their fits and envelopes"),
            (
                PlotOf::PercentError,
                "Percent error",
                "How far each method is off the reference at each size",
            ),
        ] {
            let chosen = state.distributions.plot == plot;
            let button = ui.selectable_label(chosen, name).on_hover_text(hover);
            button.widget_info(|| egui::WidgetInfo::selected(egui::Role::Tab, true, chosen, name));
            if button.clicked() {
                commands.push(Command::Distributions(DistributionCommand::Plot(plot)));
            }
        }
        ui.separator();
        let hover = "Bring everything into sight; so does a double click. Wheel: closer, drag: move, \
                     drag with the right button: this part";
        reset = ui.button("Reset view").on_hover_text(hover).clicked();
        if !state.distributions.is_current() {
            match &state.distributions.problem {
                Some(problem) => {
                    ui.colored_label(ui.visuals().error_fg_color, problem);
                }
                None if !state.work.is_running(Task::Fits) => {
                    ui.weak("Cancelled; what is shown is the result before");
                    let again = ui.button("Compute");
                    if again.on_hover_text("Fit and compare the curves of now").clicked() {
                        let command = DistributionCommand::Compute;
                        commands.push(Command::Distributions(command));
                    }
                }
                None => {
                    ui.spinner();
                    ui.weak("Computing; what is shown is the result before");
                }
            }
        }
    });
    let Some(computed) = &state.distributions.computed else {
        return;
    };
    match state.distributions.plot {
        PlotOf::Passing => passing(state, computed, reset, ui),
        PlotOf::PercentError => errors(computed, reset, ui),
    }
}

/// A plot over the logarithm of the size, with the read-out under the mouse.
fn over_size<'a>(
    name: &str,
    computed: &'a Computed,
    value: &'static str,
    ui: &egui::Ui,
) -> Plot<'a> {
    let unit = computed.set.unit;
    let legend = Legend::default()
        .position(Corner::LeftTop)
        .follow_insertion_order(true)
        .grouping(LegendGrouping::ById)
        .background_alpha(0.85);
    let grid = ui.visuals().text_color().gamma_multiply(0.45);
    Plot::new(name.to_owned())
        .legend(legend)
        .grid_color(grid)
        .x_axis_label(format!("Size [{unit}]"))
        .x_grid_spacer(|input| log_axis::marks(&input))
        .x_axis_formatter(log_axis::label)
        // The wheel comes closer, as it does over the pile.
        .allow_scroll(false)
        .label_formatter(move |position| {
            let (name, at) = match position {
                HoverPosition::NearDataPoint {
                    plot_name,
                    position,
                    ..
                } => (*plot_name, position),
                HoverPosition::Elsewhere { position } => ("", position),
            };
            let size = log_axis::size(at.x);
            let line = if name.is_empty() { "" } else { "\n" };
            Some(format!("{name}{line}{size} {unit}\n{:.1} {value}", at.y))
        })
}

/// Wheel and reset, and what a screen reader says.
fn finish(plot: &mut PlotUi<'_>, reset: bool) {
    if plot.response().hovered() {
        let wheel = plot.ctx().input(|input| input.smooth_scroll_delta().y);
        if wheel != 0.0 {
            let factor = (wheel / 200.0).exp();
            plot.zoom_bounds_around_hovered(egui::vec2(factor, factor));
        }
    }
    if reset {
        plot.set_auto_bounds(true);
    }
}

fn passing(state: &State, computed: &Computed, reset: bool, ui: &mut egui::Ui) {
    let Drawing { methods, envelope } = &computed.drawing;
    let hidden = &state.distributions.hidden;
    let dark = ui.visuals().dark_mode;
    let percent = computed.edit.settings.envelope_percent;
    let fade = if state.distributions.is_current() {
        1.0
    } else {
        0.4
    };
    let response = over_size("percent passing", computed, "% passing", ui)
        .y_axis_label("Percent passing [%]")
        .include_y(0.0)
        .include_y(100.0)
        .show(ui, |plot| {
            let paint = |look: Look, alpha: f32| color(look, dark).gamma_multiply(alpha * fade);
            area(
                plot,
                &format!("Envelope ± {percent} % of the reference's size"),
                envelope,
                paint(Look::REFERENCE, 0.10),
            );
            for method in methods {
                let MethodDrawing { look, .. } = method;
                let name = format!("{}: mean ± standard deviation", method.method);
                area(plot, &name, &method.spread, paint(*look, 0.22));
            }
            for method in methods {
                let MethodDrawing {
                    method,
                    look,
                    curves,
                    fits,
                    marks,
                    ..
                } = method;
                // The legend's entry; the curves of the method share its id, each under its name.
                plot.add(
                    Points::new(method.clone(), Vec::<[f64; 2]>::new())
                        .id(method)
                        .color(paint(*look, 1.0)),
                );
                let shown = |labels: &&(crate::fragmentation::Labels, Vec<PlotPoint>)| {
                    !hidden.contains(&labels.0)
                };
                // Of many curves each is fainter.
                let alpha = if fits.len() > 4 { 0.6 } else { 1.0 };
                for (labels, points) in fits {
                    let of_trial = |other: &crate::fragmentation::Labels| {
                        other.method == labels.method && other.trial == labels.trial
                    };
                    if !curves
                        .iter()
                        .filter(shown)
                        .any(|(other, _)| of_trial(other))
                    {
                        continue;
                    }
                    plot.line(
                        Line::new(format!("{labels}, fitted"), PlotPoints::Borrowed(points))
                            .id(method)
                            .style(style(look.dash))
                            .width(1.6)
                            .color(paint(*look, alpha)),
                    );
                }
                for (labels, points) in curves.iter().filter(shown) {
                    plot.points(
                        Points::new(labels.to_string(), PlotPoints::Borrowed(points))
                            .id(method)
                            .shape(shape(look.marker))
                            .filled(fits.len() <= 4)
                            .radius(if curves.len() > 12 { 2.5 } else { 4.0 })
                            .color(paint(*look, if curves.len() > 12 { 0.6 } else { 1.0 })),
                    );
                }
                if fits.len() <= 4 {
                    for (name, point) in marks {
                        plot.points(
                            Points::new(name.clone(), vec![[point.x, point.y]])
                                .id(method)
                                .filled(false)
                                .radius(7.0)
                                .color(paint(*look, 1.0)),
                        );
                    }
                }
            }
            finish(plot, reset);
        });
    said(&response.response, "Plot of percent passing");
}

fn errors(computed: &Computed, reset: bool, ui: &mut egui::Ui) {
    let dark = ui.visuals().dark_mode;
    let limit = computed.edit.settings.envelope_percent;
    let neutral = ui.visuals().text_color();
    let some = computed
        .drawing
        .methods
        .iter()
        .any(|m| !m.errors.is_empty());
    if !some {
        ui.weak("Percent errors need a reference and another method that share sizes.");
        return;
    }
    let response = over_size("percent error", computed, "% error", ui)
        .y_axis_label("Percent error of the passing [%]")
        .include_y(-limit * 1.2)
        .include_y(limit * 1.2)
        .show(ui, |plot| {
            plot.hline(HLine::new("", 0.0).color(neutral).width(1.0));
            for y in [limit, -limit] {
                let line = HLine::new(format!("± {limit} %"), y).id("limits");
                plot.hline(line.color(neutral).style(LineStyle::dashed_loose()));
            }
            for MethodDrawing {
                method,
                look,
                errors,
                ..
            } in &computed.drawing.methods
            {
                if errors.is_empty() {
                    continue;
                }
                let paint = color(*look, dark);
                plot.line(
                    Line::new(method.clone(), PlotPoints::Borrowed(errors))
                        .id(method)
                        .allow_hover(false)
                        .style(style(look.dash))
                        .color(paint),
                );
                plot.points(
                    Points::new(method.clone(), PlotPoints::Borrowed(errors))
                        .id(method)
                        .shape(shape(look.marker))
                        .radius(4.0)
                        .color(paint),
                );
            }
            finish(plot, reset);
        });
    said(&response.response, "Plot of percent errors");
}

fn said(response: &egui::Response, name: &str) {
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, name));
}

fn area(plot: &mut PlotUi<'_>, name: &str, area: &Area, fill: Color32) {
    if !area.sizes.is_empty() {
        let drawn = FilledArea::new(name, &area.sizes, &area.low, &area.high);
        plot.add(drawn.fill_color(fill));
    }
}

/// The figure's colour; on a dark ground lighter, and the reference's black is the text's colour.
pub(super) fn color(look: Look, dark: bool) -> Color32 {
    let [r, g, b] = look.colour;
    let light = |v: u8| if dark { v + ((255 - v) / 10) * 3 } else { v };
    match dark && look.colour == Look::REFERENCE.colour {
        true => Color32::from_gray(225),
        false => Color32::from_rgb(light(r), light(g), light(b)),
    }
}

fn shape(marker: Marker) -> MarkerShape {
    match marker {
        Marker::Circle => MarkerShape::Circle,
        Marker::Square => MarkerShape::Square,
        Marker::Triangle => MarkerShape::Up,
        Marker::Diamond => MarkerShape::Diamond,
        Marker::TriangleDown => MarkerShape::Down,
        Marker::Cross => MarkerShape::Cross,
    }
}

fn style(dash: Dash) -> LineStyle {
    match dash {
        Dash::Solid => LineStyle::Solid,
        Dash::Long => LineStyle::Dashed { length: 10.0 },
        Dash::Short => LineStyle::Dashed { length: 5.0 },
        Dash::DashDot => LineStyle::Dotted { spacing: 5.0 },
    }
}
