//! `fragscale scales`: the scale of every photo.

use clap::Args;

use super::flight_arguments::{FlightArguments, MemoryArguments};
use super::named_photos::NamedPhotos;
use super::outputs::{AnswerArguments, Outputs};
use super::{Answer, OutputUnit};
use crate::exports;
use crate::flight::{Limits, Review};
use crate::jobs::Progress;
use crate::opening::Opened;

#[derive(Debug, Args)]
pub(super) struct ScalesArguments {
    #[command(flatten)]
    flight: FlightArguments,
    #[command(flatten)]
    memory: MemoryArguments,
    /// Scales are in pixels per this unit.
    #[arg(long, value_enum, default_value = "cm")]
    unit: OutputUnit,
    #[command(flatten)]
    named: NamedPhotos,
    #[command(flatten)]
    answer: AnswerArguments,
}

impl ScalesArguments {
    /// Where they go.
    pub(super) fn outputs(&self) -> Result<Outputs<'_>, String> {
        self.answer.outputs(self.flight.files())
    }
}

pub(super) fn scales(arguments: &ScalesArguments, progress: &Progress) -> Result<Answer, String> {
    let mut outputs = arguments.outputs()?;
    let (flight, memory) = (&arguments.flight, &arguments.memory);
    let (opened, (text, notes)) = memory.with_flight(flight, false, progress, |opened| {
        outputs.read(&opened.read)?;
        let review = review_of_scales(flight, opened, progress)?;
        scales_text(arguments, opened, &review)
    })?;
    answer_of_scales(&outputs, text, &opened, notes)
}

/// The review of a flight that is open, for its scales. Colours are compared as `check` does: a scale is trusted by what it finds, too.
/// Of a surface of which only a part is in memory they are not.
pub(super) fn review_of_scales(
    flight: &FlightArguments,
    opened: &Opened,
    progress: &Progress,
) -> Result<Review, String> {
    let review = match opened.flight.parts().surface.is_part() {
        true => opened.review_without_colours(&Limits::default(), progress),
        false => opened.review(&Limits::default(), progress),
    };
    review.map_err(|fault| flight.wrong(fault))
}

/// The scales of a flight that was reviewed.
pub(super) fn deliver_scales(
    arguments: &ScalesArguments,
    mut outputs: Outputs<'_>,
    opened: &Opened,
    review: &Review,
) -> Result<Answer, String> {
    outputs.read(&opened.read)?;
    let (text, notes) = scales_text(arguments, opened, review)?;
    answer_of_scales(&outputs, text, opened, notes)
}

/// The scales of a reviewed flight as they are written, and what fell back or failed.
fn scales_text(
    arguments: &ScalesArguments,
    opened: &Opened,
    review: &Review,
) -> Result<(String, Vec<String>), String> {
    let in_flight = |fault| arguments.flight.wrong(fault);
    let named = arguments.named.of(review.flight()).map_err(in_flight)?;
    let report = exports::ScaleReport::new(review, arguments.unit.into())
        .with_scale_objects(&opened.settings.scale_objects)
        .map_err(in_flight)?
        .of_photos(&named);
    let (csv, json) = (exports::scales_csv, exports::scales_json);
    let text = arguments
        .answer
        .text(&report, exports::scales_table, csv, json)?;
    Ok((text, notes_of(&report).collect()))
}

/// Delivers the text, with all warnings.
fn answer_of_scales(
    outputs: &Outputs<'_>,
    text: String,
    opened: &Opened,
    notes: Vec<String>,
) -> Result<Answer, String> {
    let text = outputs.deliver(text)?;
    let mut warnings = opened.all_warnings();
    warnings.extend(notes);
    Ok(Answer::new(text, warnings))
}

/// What fell back or failed, and what nothing speaks for.
pub(super) fn notes_of(report: &exports::ScaleReport<'_>) -> impl Iterator<Item = String> {
    let noted = report.noted().into_iter().map(|noted| {
        let verdict = if noted.has_scale { "" } else { "no scale: " };
        format!("{}: {verdict}{}", noted.whose, noted.notes)
    });
    noted.chain(report.unconfirmed())
}
