//! `fragscale check`: what a careful engineer looks at before she trusts a flight, with numbers.

use std::fmt::Write as _;

use clap::Args;

use super::Answer;
use super::flight_arguments::{FlightArguments, MemoryArguments};
use super::outputs::{OutputArguments, Outputs};
use crate::exports::{PhotoLine, ScaleReport};
use crate::fault::{Fault, one_line};
use crate::files::CHECK_MARK;
use crate::flight::{Doubt, Evidence, Limits, Review};
use crate::formats::FileError;
use crate::jobs::Progress;
use crate::opening::{self, Colours, Opened};
use crate::picture::Agreement;
use crate::units::LengthUnit;

#[derive(Debug, Args)]
pub(super) struct CheckArguments {
    #[command(flatten)]
    flight: FlightArguments,
    #[command(flatten)]
    memory: MemoryArguments,
    #[command(flatten)]
    pub(super) output: OutputArguments,
}

/// Opens the flight, which looks at coordinate systems, places, sizes and metadata, compares the
/// photos with the colours of the surface and with those beside them, and says which are not to be trusted, and why.
pub(super) fn check(arguments: &CheckArguments, progress: &Progress) -> Result<Answer, String> {
    let mut outputs = arguments.outputs()?;
    let (flight, memory) = (&arguments.flight, &arguments.memory);
    let (_, looked) = memory.with_flight(flight, false, progress, |opened| {
        outputs.read(&opened.read)?;
        look_at(flight, opened, progress)
    })?;
    deliver(&outputs, looked.text, looked.warnings)
}

impl CheckArguments {
    /// What is written.
    pub(super) fn outputs(&self) -> Result<Outputs<'_>, String> {
        self.output.outputs_of_text(self.flight.files())
    }
}

/// The same of a flight that is open, with its whole review where colours were compared.
pub(super) fn check_of(
    arguments: &CheckArguments,
    mut outputs: Outputs<'_>,
    opened: &Opened,
    progress: &Progress,
) -> Result<(Answer, Option<Review>), String> {
    outputs.read(&opened.read)?;
    let looked = look_at(&arguments.flight, opened, progress)?;
    Ok((
        deliver(&outputs, looked.text, looked.warnings)?,
        looked.review,
    ))
}

/// What there is to say of a flight.
struct Looked {
    text: String,
    warnings: Vec<String>,
    /// Where colours were compared.
    review: Option<Review>,
}

fn look_at(
    arguments: &FlightArguments,
    opened: &Opened,
    progress: &Progress,
) -> Result<Looked, String> {
    let mut warnings = opened.all_warnings();
    let mut text = format!("{CHECK_MARK}\n");
    if opened.flight.parts().surface.is_part() {
        text.push_str("not looked at: only a part of the surface was read (--memory)\n");
        return Ok(Looked {
            text,
            warnings,
            review: None,
        });
    }
    let at = |fault: Fault| FileError::new(&arguments.flight, fault).to_string();
    let (flight, looked_up) = (opened.flight.clone(), opened.looked_up.clone());
    let limits = Limits::default();
    let mut review = Review::of_scales(flight, looked_up, &limits, progress).map_err(at)?;
    let compared = opening::compare_pixels(&review, &opened.photo_files, progress).map_err(at)?;
    opening::take_compared(&mut review, &compared);
    review.take_decisions(&opened.settings.decisions);
    review.look(progress).map_err(at)?;
    review.compute_fields(progress).map_err(at)?;
    let has_colours = !opened.flight.parts().surface.colors().is_empty();
    if !has_colours {
        text.push_str("the surface has no colours\n");
    }
    for (index, (photo, (_, colours))) in review.photos().zip(&compared.colours).enumerate() {
        let name = photo.name();
        let said = match colours {
            Colours::Not(why) | Colours::Unreadable(why) => why.clone(),
            Colours::Compared(Agreement {
                points,
                correlation,
                ..
            }) => format!("r = {correlation:.2} at {points} points"),
        };
        let of_pixels = photo
            .doubts
            .iter()
            .filter(|doubt| doubt.is_of_pixels() || matches!(doubt, Doubt::FileUnreadable(_)));
        warnings.extend(of_pixels.map(|doubt| format!("photo '{name}': {doubt}")));
        let together = compared.together.iter().find(|(of, _)| *of == index);
        let together = together.map(|(_, together)| together.in_words());
        // Without colours nothing but those beside it speaks for a photo, and nothing does if none is.
        let evidence = review.looked_up().evidence.get(index);
        let is_alone = evidence.is_some_and(Evidence::is_unconfirmed);
        let alone = is_alone.then(|| {
            "compared with nothing: no photo from beside it shows enough of the same rock"
                .to_owned()
        });
        // A sentence that many photos have does not name them all.
        let reason = PhotoLine::of(photo, index).why_not_trusted();
        let reason = reason.map(|_| "see below".to_owned());
        let said = [has_colours.then_some(said), together, alone, reason];
        let said: Vec<String> = said.into_iter().flatten().collect();
        if !said.is_empty() {
            // Writing into a text does not fail.
            let _ = writeln!(text, "{name}  {}", said.join("; "));
        }
    }
    // Which photos not to trust, and why: as the other commands say it.
    let report = ScaleReport::new(&review, LengthUnit::Centimetre);
    let reasons = report.reasons();
    if reasons.is_empty() {
        text.push_str("nothing was found against a photo\n");
    }
    for noted in &reasons {
        let _ = writeln!(text, "{}: {}", noted.whose, noted.notes);
    }
    if let Some(others) = &opened.without_pose {
        let _ = writeln!(text, "{others}");
    }
    Ok(Looked {
        text,
        warnings,
        review: Some(review),
    })
}

/// Into a file go the warnings, too: they are what one looks for.
fn deliver(
    outputs: &Outputs<'_>,
    mut text: String,
    warnings: Vec<String>,
) -> Result<Answer, String> {
    if outputs.has_file() {
        for warning in &warnings {
            let _ = writeln!(text, "warning: {}", one_line(warning));
        }
    }
    Ok(Answer::new(outputs.deliver(text)?, warnings))
}
