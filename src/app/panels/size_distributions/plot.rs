//! Percent passing, or percent error, over the size.

use std::collections::BTreeSet;
use std::ops::RangeInclusive;

use egui::Color32;
use egui_plot::{
    AxisHints, ColorConflictHandling, Corner, FilledArea, HLine, HoverPosition, Legend,
    LegendGrouping, Line, LineStyle, MarkerShape, Plot, PlotPoint, PlotPoints, PlotUi, Points,
};

use super::log_axis;
use crate::command::Command;
use crate::exports::{Dash, FigureStyle, Marker};
use crate::fragmentation::Labels;
use crate::names;
use crate::panels::working::working;
use crate::size_distributions::drawing::{Area, Drawing, MethodDrawing};
use crate::size_distributions::{Computed, DistributionCommand, PlotOf};
use crate::state::State;
use crate::tasks::work::Task;

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
                None if !state.work.is_running(Task::FITS) => {
                    ui.weak("Cancelled; what is shown is the result before");
                    let again = ui.button("Compute");
                    if again.on_hover_text("Fit and compare the curves of now").clicked() {
                        let command = DistributionCommand::Compute;
                        commands.push(Command::Distributions(command));
                    }
                }
                None => {
                    working(ui);
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

/// From where to where labels of sizes appear, points to the next line of the same kind: 1, 2 and 5 are
/// the third of a decade apart.
const LABEL_SPACING: egui::Rangef = egui::Rangef {
    min: 22.0,
    max: 32.0,
};

/// A plot over the logarithm of the size, with the read-out under the mouse: of values that there are.
fn over_size<'a>(
    name: &str,
    title: &str,
    (value, values): (&'static str, RangeInclusive<f64>),
    computed: &'a Computed,
    ui: &egui::Ui,
) -> Plot<'a> {
    let unit = computed.analysis.trials.unit;
    let legend = Legend::default()
        .position(Corner::LeftTop)
        .follow_insertion_order(true)
        .grouping(LegendGrouping::ById)
        .color_conflict_handling(ColorConflictHandling::PickFirst)
        .background_alpha(0.85);
    let grid = ui.visuals().text_color().gamma_multiply(0.45);
    let plot = Plot::new(name.to_owned());
    let plot = match room_of_legend(ui) > LEAST_LEGEND {
        true => plot.legend(legend),
        false => plot,
    };
    plot.grid_color(grid)
        .cursor_color(grid)
        .custom_x_axes(vec![
            AxisHints::new_x()
                .label(format!("Size [{unit}]"))
                .formatter(log_axis::label)
                .label_spacing(LABEL_SPACING)
                .min_thickness(36.0),
        ])
        .custom_y_axes(vec![AxisHints::new_y().label(title).min_thickness(46.0)])
        .x_grid_spacer(|input| log_axis::marks(&input))
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
            if name.is_empty() && !values.contains(&at.y) {
                return None;
            }
            let size = log_axis::size(at.x);
            let line = if name.is_empty() { "" } else { "\n" };
            let at = at.y.clamp(*values.start(), *values.end());
            Some(format!("{name}{line}{size} {unit}\n{at:.1} {value}"))
        })
}

/// A legend narrower than this, points, says nothing.
const LEAST_LEGEND: f32 = 110.0;

/// How wide an entry's name may be: the axis, swatch and margins are beside it.
fn room_of_legend(ui: &egui::Ui) -> f32 {
    ui.available_width() - 130.0
}

/// A method's name as its entry in the legend.
fn entry(ui: &egui::Ui, name: &str) -> String {
    let font = egui::TextStyle::Body.resolve(ui.style());
    names::fitted(ui, name, &font, room_of_legend(ui).max(20.0)).into_owned()
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
    let entries: Vec<[String; 2]> = methods
        .iter()
        .map(|drawing| {
            let method = drawing.method.as_str();
            [method.to_owned(), format!("{method}, mean ± s.d.")].map(|name| entry(ui, &name))
        })
        .collect();
    let response = over_size(
        "percent passing",
        "Percent passing [%]",
        ("% passing", 0.0..=100.0),
        computed,
        ui,
    )
    .include_y(0.0)
    .include_y(100.0)
    .show(ui, |plot| {
        let paint =
            |style: FigureStyle, alpha: f32| color(style, dark).gamma_multiply(alpha * fade);
        let grey = paint(FigureStyle::REFERENCE, 0.12);
        area(plot, &format!("Envelope ± {percent} %"), envelope, grey);
        for (method, [_, name]) in methods.iter().zip(&entries) {
            area(plot, name, &method.spread, paint(method.style, 0.25));
        }
        for (method, [name, _]) in methods.iter().zip(&entries) {
            curves(plot, method, name, hidden, |alpha| {
                paint(method.style, alpha)
            });
        }
        finish(plot, reset);
    });
    said(&response.response, "Plot of percent passing");
}

/// The curves of a method, under one entry of the legend.
fn curves<'a>(
    plot: &mut PlotUi<'a>,
    drawing: &'a MethodDrawing,
    name: &str,
    hidden: &BTreeSet<Labels>,
    paint: impl Fn(f32) -> Color32,
) {
    let MethodDrawing {
        method,
        style,
        curves,
        fits,
        mean,
        marks,
        ..
    } = drawing;
    // The first of the same id names the entry; each curve has its own name for the read-out.
    plot.add(
        Points::new(name.to_owned(), Vec::<[f64; 2]>::new())
            .id(method)
            .color(paint(1.0)),
    );
    let shown: Vec<&(Labels, Vec<PlotPoint>)> = curves
        .iter()
        .filter(|(labels, _)| !hidden.contains(labels))
        .collect();
    // Of several trials each is faint, and their mean stands out.
    let several = !mean.is_empty();
    for (trial, points) in fits {
        let is_of = |labels: &Labels| labels.method == trial.method && labels.trial == trial.trial;
        if shown.iter().any(|(labels, _)| is_of(labels)) {
            let line =
                Line::new(format!("{trial}, fitted"), PlotPoints::Borrowed(points)).id(method);
            plot.line(match several {
                true => line.width(1.0).color(paint(0.45)),
                false => line
                    .width(1.8)
                    .style(line_style(style.dash))
                    .color(paint(1.0)),
            });
        }
    }
    for (labels, points) in &shown {
        let many = curves.len() > 12;
        plot.points(
            Points::new(labels.to_string(), PlotPoints::Borrowed(points))
                .id(method)
                .shape(shape(style.marker))
                .radius(if several { 3.0 } else { 4.0 })
                .color(paint(if many { 0.5 } else { 0.9 })),
        );
    }
    if shown.is_empty() {
        return;
    }
    if several {
        plot.line(
            Line::new(
                format!("{method}, mean, fitted"),
                PlotPoints::Borrowed(mean),
            )
            .id(method)
            .width(2.2)
            .style(line_style(style.dash))
            .color(paint(1.0)),
        );
    }
    if several || fits.len() == 1 {
        for (name, point) in marks {
            plot.points(
                Points::new(name.clone(), vec![[point.x, point.y]])
                    .id(method)
                    .filled(false)
                    .radius(7.0)
                    .color(paint(1.0)),
            );
        }
    }
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
    let title = "Percent error of the passing [%]";
    let methods = &computed.drawing.methods;
    let entries: Vec<String> = methods.iter().map(|m| entry(ui, &m.method)).collect();
    let value = ("% error", f64::NEG_INFINITY..=f64::INFINITY);
    let response = over_size("percent error", title, value, computed, ui)
        .include_y(-limit * 1.2)
        .include_y(limit * 1.2)
        .show(ui, |plot| {
            plot.hline(HLine::new("", 0.0).color(neutral).width(1.0));
            for y in [limit, -limit] {
                let line = HLine::new(format!("± {limit} %"), y).id("limits");
                plot.hline(line.color(neutral).style(LineStyle::dashed_loose()));
            }
            for (drawing, name) in methods.iter().zip(&entries) {
                let MethodDrawing {
                    method,
                    style,
                    errors,
                    ..
                } = drawing;
                if errors.is_empty() {
                    continue;
                }
                let paint = color(*style, dark);
                plot.line(
                    Line::new(name.clone(), PlotPoints::Borrowed(errors))
                        .id(method)
                        .allow_hover(false)
                        .style(line_style(style.dash))
                        .color(paint),
                );
                plot.points(
                    Points::new(method.clone(), PlotPoints::Borrowed(errors))
                        .id(method)
                        .shape(shape(style.marker))
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
        for edge in [&area.low, &area.high] {
            let points = area.sizes.iter().zip(edge).map(|(&x, &y)| [x, y]);
            let line = Line::new(name, points.collect::<PlotPoints<'_>>()).allow_hover(false);
            plot.line(line.width(1.0).color(fill.gamma_multiply(2.5)));
        }
    }
}

/// The figure's colour; on a dark ground lighter, and the reference's black is the text's colour.
pub(super) fn color(style: FigureStyle, dark: bool) -> Color32 {
    let [r, g, b] = style.colour;
    let light = |v: u8| if dark { v + ((255 - v) / 10) * 3 } else { v };
    match dark && style.colour == FigureStyle::REFERENCE.colour {
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

fn line_style(dash: Dash) -> LineStyle {
    match dash {
        Dash::Solid => LineStyle::Solid,
        Dash::Long => LineStyle::Dashed { length: 10.0 },
        Dash::Short => LineStyle::Dashed { length: 5.0 },
        Dash::DashDot => LineStyle::Dotted { spacing: 5.0 },
    }
}
