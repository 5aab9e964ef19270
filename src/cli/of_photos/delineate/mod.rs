//! `fragscale delineate`: the fragments of photos outlined, measured where they lie, and their size
//! distribution.

mod chosen_engine;
mod each_photo;
mod maker;
mod masks_arguments;
mod mass_arguments;
mod outliners;
mod planned;
mod unfinished;
mod written_outlines;

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use self::chosen_engine::ChosenEngine;
use self::each_photo::{EachPhoto, PhotosDone};
use self::masks_arguments::MasksArguments;
use self::mass_arguments::MassArguments;
pub(in crate::cli) use self::outliners::Outliners;
use self::planned::Planned;
use self::written_outlines::{OtherForm, WrittenOutlines};
use crate::cli::flight_arguments::FlightArguments;
use crate::cli::outputs::Force;
use crate::cli::{Answer, OutputUnit};
use crate::delineation::measures::SieveShape;
use crate::exports::{self, FoundSize, FragmentSizes, FragmentTables, MapPlaces, MassWay};
use crate::fault::{Fault, first_names};
use crate::files::Kind;
use crate::flight::{Limits, Verdict};
use crate::formats::read_bytes;
use crate::jobs::Progress;
use crate::opening::Opened;
use crate::units::LengthUnit;

#[derive(Debug, Args)]
pub(in crate::cli) struct DelineateArguments {
    #[command(flatten)]
    flight: FlightArguments,
    /// A photo, as the flight names it; once for each of several, without it all photos.
    #[arg(long, value_name = "NAME")]
    photo: Vec<String>,
    /// The folder to write to: of each photo its label image, its outlines over the photo and in the world (GeoJSON), then
    /// fragments.csv, distribution.csv, sizes.csv (P20, P50 and P80 with their 95 % intervals) and report.html. What was
    /// stopped goes on with the photos that are not done when it is started again.
    #[arg(long, value_name = "DIR")]
    to: PathBuf,
    /// What finds the borders of fragments: learned (a small network that was trained on simulated piles), classical (edges
    /// and shadows at several scales; no weights), FILE.toml, which describes an ONNX model of yours, or saved: outlines that were
    /// saved in the window alone (fragments/NAME.png beside flight.toml). Without it, these are taken where there are any, and
    /// else the learned engine.
    #[arg(long, value_name = "learned|classical|saved|FILE.toml", value_parser = ChosenEngine::parse)]
    engine: Option<ChosenEngine>,
    #[command(flatten)]
    masks: MasksArguments,
    /// Outlines for other tools, too, beside the label images, all of the undistorted photos; several with commas.
    #[arg(long, value_enum, value_name = "FORMS", value_delimiter = ',')]
    also: Vec<OtherForm>,
    /// How the sieve size of a fragment follows from its outline.
    #[arg(long, value_enum, default_value = "calibrated")]
    shape: Shape,
    /// Sizes are in this unit.
    #[arg(long, value_enum, default_value = "cm")]
    unit: OutputUnit,
    #[command(flatten)]
    mass: MassArguments,
    #[command(flatten)]
    force: Force,
}

impl DelineateArguments {
    /// What stays of it where it is stopped.
    pub(in crate::cli) fn kept(&self) -> String {
        let to = self.to.display();
        format!("the photos that are done are kept in {to}; start it again to go on")
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Shape {
    /// As the fragments of simulated piles pass their sieves.
    Calibrated,
    /// The shorter side of the least rectangle about it.
    Breadth,
    /// The diameter of the circle of its area.
    Circle,
}

impl From<Shape> for SieveShape {
    fn from(shape: Shape) -> Self {
        match shape {
            Shape::Calibrated => Self::Calibrated,
            Shape::Breadth => Self::Breadth,
            Shape::Circle => Self::Circle,
        }
    }
}

pub(in crate::cli) fn delineate(
    arguments: &DelineateArguments,
    progress: &Progress,
) -> Result<Answer, String> {
    let outliners = Outliners::open(arguments)?;
    let opened = arguments.flight.open(progress)?;
    let (answer, _) = delineate_of(arguments, &outliners, &opened, progress)?;
    Ok(answer)
}

/// The same of a flight that is open, with the sizes of all fragments together in the unit that is asked for.
pub(in crate::cli) fn delineate_of(
    arguments: &DelineateArguments,
    outliners: &Outliners,
    opened: &Opened,
    progress: &Progress,
) -> Result<(Answer, Vec<FoundSize>), String> {
    let outputs = outliners.outputs(arguments, opened)?;
    let in_flight = |fault| arguments.flight.wrong(fault);
    let flight = &opened.flight;
    let units @ [world, unit]: [LengthUnit; 2] = [flight.parts().unit, arguments.unit.into()];
    let (tail, of_tail) = arguments.mass.tail(world)?;
    let mut written = WrittenOutlines::new(&arguments.to, &arguments.also);
    let planned = Planned::of(arguments, outliners, opened, &written, &outputs)?;
    let places = MapPlaces::new(opened.crs.as_deref(), world);
    let mut warnings = opened.all_warnings();
    warnings.extend(of_tail);
    warnings.extend(planned.warnings.iter().cloned());
    warnings.extend(places.fault().map(|fault| fault.to_string()));
    warnings.extend(of_doubtful(opened, &planned, progress).map_err(in_flight)?);

    let each = EachPhoto::new(arguments, outliners, opened, &planned, &places, progress);
    let PhotosDone {
        done,
        said,
        mut not_all,
    } = each.make(&mut written, &outputs)?;
    let is_whole = not_all.is_none();
    warnings.extend(said);
    let mut text = String::new();
    let mut of_all = Vec::new();
    if !done.is_empty() {
        let way = MassWay {
            steps: arguments.mass.steps(),
            tail: tail.as_ref(),
        };
        let sizes = FragmentSizes::of(&done, &way, flight, &opened.looked_up, progress);
        let sizes = sizes.map_err(in_flight)?;
        if let (Some(first), None) = (sizes.nothing(), &not_all) {
            let what = "no photo has a size distribution";
            not_all = Some(Fault::new(what, format!("the first: {first}")));
        }
        warnings.extend(sizes.warnings());
        warnings.extend(arguments.mass.not_taken(&done));
        let law = arguments.mass.tail_in_words();
        let of_tables = FragmentTables {
            flight: &flight.parts().name,
            units,
            tail: law.as_deref(),
            warnings: &warnings,
        };
        let picture =
            |name: &str| read_bytes(&arguments.to.join(name)).map_err(|error| error.fault);
        let bytes = exports::fragment_tables(&of_tables, &done, &sizes, picture);
        for (path, bytes) in planned.tables.iter().zip(bytes.map_err(in_flight)?) {
            outputs.write(path, &bytes, Kind::Result)?;
        }
        written.finish(&outputs)?;
        text = sizes.words(world, unit) + &arguments.mass.steps_in_words(&done);
        of_all = sizes.of_all(world.in_units_of(unit));
    }
    warnings.extend(each.finished(is_whole));
    let answer = Answer {
        text,
        warnings,
        failed: not_all.map(in_flight),
    };
    Ok((answer, of_all))
}

/// That some of the photos are not to be trusted. Photos are read for it where all are outlined, which takes longer.
fn of_doubtful(
    opened: &Opened,
    planned: &Planned,
    progress: &Progress,
) -> Result<Option<String>, Fault> {
    // Of a part of a surface nothing is said.
    if opened.flight.parts().surface.is_part() {
        return Ok(None);
    }
    let limits = Limits::default();
    let review = match planned.photos.are_all() {
        true => opened.review(&limits, progress)?,
        false => opened.review_without_colours(&limits, progress)?,
    };
    let doubtful = planned.chosen.iter().filter_map(|&index| {
        let photo = review.photo(index)?;
        let is_doubtful = matches!(photo.settled()?, Verdict::Check | Verdict::NoScale);
        is_doubtful.then(|| photo.name().to_owned())
    });
    let doubtful: Vec<String> = doubtful.collect();
    Ok((!doubtful.is_empty()).then(|| {
        format!(
            "{} of {} photos are not to be trusted ({}), and their sizes are no surer than their scales: `fragscale check` says why",
            doubtful.len(),
            planned.chosen.len(),
            first_names(&doubtful)
        )
    }))
}
