//! The numbers of the selected photo: the pair of scales that is typed into Split-Desktop, the other
//! pair beside it, how sure they are, and how well a line says what the photo shows.

use egui::RichText;

use crate::actions;
use crate::command::Command;
use crate::flight::{PhotoReview, TogetherFound};
use crate::names::unbroken;
use crate::numbers::{interval_percent, significant_digits, with_interval};
use crate::open_flight::OpenFlight;
use crate::panels::rows::text_width;
use crate::panels::verdict::or_dash;
use crate::scale::{ErrorSource, FittedScale, Interval, ScaleEstimate, ScalePair, Uncertainty};
use crate::state::State;
use crate::units::LengthUnit;

/// Said because some scales stand at the end of their own interval.
const SCALE_WITH_INTERVAL: &str = "Scale at this edge of the image with its 95 % interval. A cloud has more points of \
     the stones' tops than of what lies deeper between them: the interval counts that, the scale does not, and so it \
     may stand near the upper end";

/// What "P80 ± 2 %" means.
pub(in crate::panels) const SIZE_ERROR: &str = "What the scale's 95 % interval does to every size that is measured by it, the P80 among \
     them; outlines, hidden fragments and sampling err besides";

/// A scale and how sure it is, pixels per unit.
#[derive(Clone, Copy)]
struct Sure {
    scale: Option<f64>,
    interval: Option<Interval>,
}

impl Sure {
    /// With the digits that its interval allows; five where there is none.
    fn text(self) -> String {
        unbroken(&match (self.scale, self.interval) {
            (Some(scale), Some(Interval { low, high, .. })) => with_interval(scale, low, high),
            (scale, _) => or_dash(scale, 5),
        })
    }

    /// What the scale's error does to sizes.
    fn size_error(self) -> Option<String> {
        let (value, interval) = (self.scale?, self.interval);
        let error = ScaleEstimate { value, interval }.size_error()?;
        Some(unbroken(&error))
    }

    fn percent(self) -> Option<String> {
        let Interval { low, high, .. } = self.interval?;
        Some(unbroken(&interval_percent(self.scale?, low, high)?))
    }
}

/// A top and a bottom scale with what they are of.
struct Pair {
    name: &'static str,
    hover: &'static str,
    /// Top and bottom.
    ends: [Sure; 2],
    is_computed: bool,
}

/// Draws them.
pub(super) fn scales(
    state: &State,
    open: &OpenFlight,
    photo: PhotoReview<'_>,
    ui: &mut egui::Ui,
    commands: &mut Vec<Command>,
) {
    let unit = state.preferences.unit();
    let (edges, fitted) = (photo.edges(unit), photo.fitted(unit));
    let uncertainty = photo.uncertainty(unit);
    let sure = |scale: Option<f64>, of: fn(&Uncertainty) -> Option<Interval>| Sure {
        scale,
        interval: uncertainty.as_ref().and_then(of),
    };
    let line = Pair {
        name: "Best line",
        hover: "The line from top to bottom that lies best through the scale of all pixels",
        ends: [
            sure(fitted.map(|fitted| fitted.top), |u| u.fitted_top),
            sure(fitted.map(|fitted| fitted.bottom), |u| u.fitted_bottom),
        ],
        is_computed: open.review.has_lines(),
    };
    let corners = Pair {
        name: "Four corners",
        hover: "As in the paper: the distances between the points that the corners' rays meet",
        ends: [sure(edges.top, |u| u.top), sure(edges.bottom, |u| u.bottom)],
        is_computed: true,
    };
    let (to_type, other) = match photo.pair {
        ScalePair::Fitted => (line, corners),
        ScalePair::Corners => (corners, line),
    };
    typed(state, &to_type, unit, ui, commands);
    beside(&other, ui);
    ui.horizontal_wrapped(|ui| {
        let sides = [
            ("Left", sure(edges.left, |u| u.left)),
            ("Right", sure(edges.right, |u| u.right)),
        ];
        for (name, side) in sides {
            ui.label(format!("{name}\u{a0}{}", side.text()))
                .on_hover_text("Scale at this side, from its two corners");
        }
        if let (Some(top), Some(bottom)) = (edges.top, edges.bottom) {
            ui.label(format!(
                "Top/bottom\u{a0}{}",
                significant_digits(top / bottom, 4)
            ))
            .on_hover_text("How many times the corners' top scale is their bottom scale");
        }
    });
    if let Some(fitted) = fitted {
        of_the_line(fitted, ui);
    }
    if let TogetherFound::There { other, off } = photo.together {
        let text = format!(
            "Surface confirmed with\u{a0}{other}, to\u{a0}{:.1}\u{a0}%",
            off * 100.0
        );
        ui.label(text).on_hover_text(
            "Where this photo and the one beside it see the surface together, off its distance from the camera: a surface that lies \
             elsewhere makes a scale wrong by as much",
        );
    }
    if let Some(difference) = photo.difference() {
        ui.add(egui::Label::new(RichText::new(difference.to_string()).weak()).wrap())
            .on_hover_text("The corners' scale is off the line by more than its own interval");
    }
    if let Some(uncertainty) = &uncertainty {
        ui.add(egui::Label::new(RichText::new(unbroken(&sources(uncertainty, photo.pair))).weak()).wrap())
            .on_hover_text(
                "What each source alone would leave in the pair for Split-Desktop, one standard \
                 deviation. Intervals hold the scale 95 times of 100, as far as everything is counted: \
                 state more on the page Flight",
            );
    }
    ui.separator();
}

/// The pair that goes to Split-Desktop, big enough to type from.
fn typed(
    state: &State,
    pair: &Pair,
    unit: LengthUnit,
    ui: &mut egui::Ui,
    commands: &mut Vec<Command>,
) {
    ui.horizontal_wrapped(|ui| {
        ui.strong(pair.name).on_hover_text(pair.hover);
        ui.weak("goes to Split-Desktop")
            .on_hover_text("Chosen on the page Flight");
        let copies = state.scales_to_copy().is_some();
        let copy = ui.add_enabled(copies, egui::Button::new("Copy"));
        copy.widget_info(|| {
            egui::WidgetInfo::labeled(egui::Role::Button, copies, "Copy top and bottom scale")
        });
        if copy
            .on_hover_text(actions::edit::COPY_SCALES.hover)
            .clicked()
        {
            commands.push(Command::CopyScales);
        }
    });
    if !pair.is_computed {
        ui.label(RichText::new("computing…").size(18.0));
        return;
    }
    for (name, end) in ["Top", "Bottom"].into_iter().zip(pair.ends) {
        // In rows that wrap: an inspector that its numbers make wider moves the viewport.
        ui.horizontal_wrapped(|ui| {
            ui.weak(format!("{name}, px/{unit}"));
            let text = RichText::new(end.text()).size(18.0).strong();
            ui.label(text).on_hover_text(match end.interval {
                Some(_) => SCALE_WITH_INTERVAL,
                None => "Scale at this edge of the image",
            });
            if let Some(error) = end.size_error() {
                ui.weak(format!("P80\u{a0}{error}"))
                    .on_hover_text(SIZE_ERROR);
            }
        });
    }
}

/// The other pair.
fn beside(pair: &Pair, ui: &mut egui::Ui) {
    ui.horizontal_wrapped(|ui| {
        ui.weak(format!("{}:", pair.name)).on_hover_text(pair.hover);
        if !pair.is_computed {
            ui.weak("computing…");
            return;
        }
        for (name, end) in ["top", "bottom"].into_iter().zip(pair.ends) {
            let percent = end.percent().map_or_else(String::new, |p| format!(", {p}"));
            let text = format!("{name}\u{a0}{}{percent}", end.text());
            // A percentage alone in the next row says nothing, where there is room for both.
            let whole = text.replace(' ', "\u{a0}");
            let fits = text_width(ui, &whole) <= ui.max_rect().width();
            ui.label(if fits { whole } else { text })
                .on_hover_text(pair.hover);
        }
    });
}

/// How well the best line says what the photo shows.
fn of_the_line(fitted: FittedScale, ui: &mut egui::Ui) {
    let FittedScale {
        rms_percent,
        worst_percent,
        covered,
        left_right_percent,
        ..
    } = fitted;
    ui.horizontal_wrapped(|ui| {
        for (name, value, hover) in [
            (
                "Off the line",
                unbroken(&format!(
                    "{rms_percent:.1} % rms, {worst_percent:.1} % at worst"
                )),
                "How far the scale of all pixels is from the best line",
            ),
            (
                "Covered",
                format!("{:.0}\u{a0}%", covered * 100.0),
                "How much of the photo shows the surface: what the line rests on",
            ),
            (
                "Left to right",
                format!("{left_right_percent:+.1}\u{a0}%"),
                "How much the scale grows from the left edge to the right one, which no line from top \
                 to bottom can say",
            ),
        ] {
            ui.label(format!("{name} {value}")).on_hover_text(hover);
        }
    });
}

/// A standard error; one that rounds to nothing is not nothing.
fn percent(error: f64) -> String {
    match error < 0.005 {
        true => "under 0.01 %".to_owned(),
        false => format!("{error:.2} %"),
    }
}

/// What has a part in the intervals, and what was not counted because nobody states it.
fn sources(uncertainty: &Uncertainty, pair: ScalePair) -> String {
    let parts = ErrorSource::ALL
        .into_iter()
        .zip(uncertainty.parts_percent(pair));
    let counted: Vec<String> = parts
        .filter_map(|(source, part)| Some(format!("{} {}", source.as_str(), percent(part?))))
        .collect();
    let not_counted = uncertainty.not_counted_in_words(pair);
    let mut text = String::new();
    if !counted.is_empty() {
        text = format!("Standard errors: {}", counted.join(", "));
    }
    if !not_counted.is_empty() {
        if !text.is_empty() {
            text.push_str("; ");
        }
        text.push_str(&format!("{} not counted", not_counted.join(", ")));
    }
    text
}
