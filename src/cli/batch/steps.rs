//! A step of a flight that is open: the arguments are those that a person would type, so that the files are the same.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use clap::Parser;

use crate::batch::{AskedStep, FlightTold, OptionKind, Step};
use crate::cli::check::check_of;
use crate::cli::export::export_of;
use crate::cli::flight_arguments::FlightArguments;
use crate::cli::of_photos::delineate::{Outliners, delineate_of};
use crate::cli::of_photos::scale_map::scale_map_of;
use crate::cli::of_tables::psd::PsdCommand;
use crate::cli::of_tables::psd_compare::compare_with;
use crate::cli::scales::{deliver_scales, review_of_scales};
use crate::cli::{Answer, Arguments, Command};
use crate::exports::{FoundSize, SizeShift};
use crate::files;
use crate::flight::Review;
use crate::fragmentation::MethodCurve;
use crate::jobs::Progress;
use crate::opening::Opened;
use crate::units::LengthUnit;

/// What a step found.
#[derive(Default)]
pub(super) struct StepMade {
    /// What it has to say.
    pub(super) warnings: Vec<String>,
    /// Why it failed although it did what it could.
    pub(super) failed: Option<String>,
    /// The flight's review, where it made one.
    pub(super) review: Option<Review>,
    pub(super) sizes: Vec<FoundSize>,
    /// What outlined fragments were held against, and the unit of its sizes.
    pub(super) reference: Option<(MethodCurve, LengthUnit)>,
}

/// How far the sizes of a flight are from those of the reference, where that was measured: of the sizes that stand beside it, whatever
/// else lies in the reference's table.
pub(super) fn shifts(
    sizes: &[FoundSize],
    unit: LengthUnit,
    (reference, of_reference): &(MethodCurve, LengthUnit),
) -> Vec<SizeShift> {
    let factor = of_reference.in_units_of(unit);
    let shift = |found: &FoundSize| {
        let measured = factor * reference.measured_size_at(found.percent)?;
        Some(SizeShift {
            percent: found.percent,
            off_percent: 100.0 * (found.size? / measured - 1.0),
        })
    };
    sizes.iter().filter_map(shift).collect()
}

impl From<Answer> for StepMade {
    fn from(answer: Answer) -> Self {
        Self {
            warnings: answer.warnings,
            failed: answer.failed,
            ..Self::default()
        }
    }
}

/// The folder of the outlined fragments.
const FRAGMENTS: &str = "fragments";
/// The folder for Split-Desktop.
pub(super) const SPLIT_DESKTOP: &str = "split-desktop";

/// What is called so in the folder of a flight, which is a folder or a file in one.
fn beside(flight: &Path, name: &str) -> PathBuf {
    match flight.is_file() {
        true => flight.with_file_name(name),
        false => flight.join(name),
    }
}

/// What a flight's sizes are held against: its own, or the season's.
fn reference_of(asked: &AskedStep, told: &FlightTold) -> Option<PathBuf> {
    let of_season = asked.options.get("reference");
    let of_season = of_season.and_then(|values| values.first());
    let of_flight = told.reference.clone();
    of_flight.or_else(|| of_season.map(PathBuf::from))
}

/// The words of the command that does the step alone, once for each file of a step that writes several.
fn words(asked: &AskedStep, told: &FlightTold) -> Vec<Vec<OsString>> {
    let in_results = |name: &str| told.to.join(name).into_os_string();
    // In one word: a value may begin with a dash.
    let flag = |name: &str, value: OsString| {
        let mut word = OsString::from(format!("{name}="));
        word.push(value);
        [word]
    };
    let mut before: Vec<OsString> = vec![asked.step.as_str().into()];
    let mut after: Vec<OsString> = Vec::new();
    if asked.step == Step::Psd {
        before = vec!["psd".into(), "compare".into()];
    } else {
        for (name, path) in [
            ("--surface", &told.surface),
            ("--photo-folder", &told.photos),
        ] {
            after.extend(path.iter().flat_map(|path| flag(name, path.clone().into())));
        }
    }
    if told.force {
        after.push("--force".into());
    }
    for (key, values) in &asked.options {
        let option = asked.step.options().iter().find(|option| option.key == key);
        match option.map(|option| option.kind) {
            // It is a file to read, not a word.
            _ if asked.step == Step::Psd && key == "reference" => {}
            Some(OptionKind::OfFlight) => {
                let files = values.iter().map(|name| beside(&told.flight, name));
                after.extend(files.flat_map(|file| flag(&format!("--{key}"), file.into())));
            }
            _ => after.extend(flag(&format!("--{key}"), values.join(",").into())),
        }
    }
    let unit = || flag("--unit", told.asked.unit.clone().into());
    match asked.step {
        Step::Scales | Step::ScaleMap | Step::Delineate | Step::Export => after.extend(unit()),
        Step::Check | Step::Psd => {}
    }
    let mut variants: Vec<Vec<OsString>> = Vec::new();
    match asked.step {
        Step::Scales => {
            for file in ["scales.csv", "scales.json"] {
                variants.push(flag("-o", in_results(file)).into());
            }
        }
        Step::Check => variants.push(flag("-o", in_results("check.txt")).into()),
        Step::Export => variants.push(flag("--to", in_results(SPLIT_DESKTOP)).into()),
        Step::ScaleMap => {
            let mut words: Vec<OsString> = vec!["--all".into()];
            words.extend(flag("-o", in_results("scale-maps")));
            variants.push(words);
        }
        Step::Delineate => variants.push(flag("--to", in_results(FRAGMENTS)).into()),
        Step::Psd => {
            let mut words: Vec<OsString> = flag("-o", in_results("psd.csv")).into();
            words.extend(flag("--report", in_results("psd.html")));
            variants.push(words);
        }
    }
    let mut files: Vec<OsString> = vec!["--".into()];
    match asked.step {
        Step::Psd => {
            // The first is the reference, whatever it is called.
            files.extend(reference_of(asked, told).map(OsString::from));
            files.push(in_results(&format!("{FRAGMENTS}/distribution.csv")));
        }
        _ => files.push(told.flight.clone().into()),
    }
    let program = OsString::from("fragscale");
    let whole = variants.into_iter().map(|variant| {
        let parts = [before.clone(), after.clone(), variant, files.clone()];
        let words = parts.into_iter().flatten();
        std::iter::once(program.clone()).chain(words).collect()
    });
    whole.collect()
}

/// The commands that do the step alone.
pub(super) fn commands(asked: &AskedStep, told: &FlightTold) -> Result<Vec<Command>, String> {
    let commands = words(asked, told).into_iter().map(|words| {
        let parsed = Arguments::try_parse_from(words).map_err(|error| error.to_string())?;
        parsed.command.ok_or_else(|| "it is no command".to_owned())
    });
    commands.collect()
}

/// What a step lacks is said before the hours that others may take.
pub(super) fn check(asked: &AskedStep, told: &FlightTold) -> Result<(), String> {
    if asked.step != Step::Psd {
        return Ok(());
    }
    // A quarry sieves one blast in many: the others are held against nothing, which `make` says.
    let Some(reference) = reference_of(asked, told) else {
        return Ok(());
    };
    let opened = files::open_file(&reference);
    opened.map(drop).map_err(|error| error.to_string())
}

/// Does a step.
pub(super) fn make(
    asked: &AskedStep,
    told: &FlightTold,
    flight: &FlightArguments,
    opened: &Opened,
    progress: &Progress,
) -> Result<StepMade, String> {
    let mut made = StepMade::default();
    if asked.step == Step::Psd && reference_of(asked, told).is_none() {
        let said = "psd: no reference is named for it in SEASON.toml ([psd] or [[flight]] reference): its sizes are held against \
                    nothing";
        made.warnings.push(said.to_owned());
        return Ok(made);
    }
    for command in commands(asked, told)? {
        match command {
            Command::Scales(arguments) => {
                if made.review.is_none() {
                    made.review = Some(review_of_scales(flight, opened, progress)?);
                }
                let outputs = arguments.outputs()?;
                if let Some(review) = &made.review {
                    made.warnings = deliver_scales(&arguments, outputs, opened, review)?.warnings;
                }
            }
            Command::Check(arguments) => {
                let (answer, review) =
                    check_of(&arguments, arguments.outputs()?, opened, progress)?;
                made = StepMade {
                    review,
                    ..answer.into()
                };
            }
            Command::Export(arguments) => {
                make_parent(&told.to.join(SPLIT_DESKTOP))?;
                let (answer, review) = export_of(&arguments, opened, progress)?;
                made = StepMade {
                    review: Some(review),
                    ..answer.into()
                };
            }
            Command::ScaleMap(arguments) => {
                let outputs = arguments.outputs();
                made = scale_map_of(&arguments, outputs, opened, progress)?.into();
            }
            Command::Delineate(arguments) => {
                let outliners = Outliners::open(&arguments)?;
                let (answer, sizes) = delineate_of(&arguments, &outliners, opened, progress)?;
                made = StepMade {
                    sizes,
                    ..answer.into()
                };
            }
            Command::Psd(PsdCommand::Compare(arguments)) => {
                let (answer, reference) = compare_with(&arguments, progress)?;
                made = StepMade {
                    reference: Some(reference),
                    ..answer.into()
                };
            }
            // No step is another command.
            _ => {}
        }
    }
    Ok(made)
}

fn make_parent(folder: &Path) -> Result<(), String> {
    let parent = folder.parent().unwrap_or(folder);
    files::make_folder(parent).map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::batch::Asked;

    /// Every option of every step, with every value, is one that its command takes: the two lists do not part.
    #[test]
    fn all_options_are_those_of_the_commands() {
        let mut tried = 0;
        for step in Step::ALL {
            for option in step.options() {
                let free = match option.kind {
                    OptionKind::Share => ["0.4"],
                    _ => ["name"],
                };
                let values = match option.values.is_empty() {
                    true => &free[..],
                    false => option.values,
                };
                for value in values {
                    let mut asked = Asked::of(&Step::ALL);
                    let value = (*value).to_owned();
                    asked.set(step, option.key, vec![value.clone()]).unwrap();
                    let told = FlightTold {
                        flight: PathBuf::from("-flight"),
                        surface: Some(PathBuf::from("cloud.laz")),
                        photos: None,
                        reference: None,
                        to: PathBuf::from("to"),
                        asked: asked.clone(),
                        force: true,
                    };
                    for step in &asked.steps {
                        let commands = commands(step, &told);
                        assert!(commands.is_ok(), "{step:?} {value}: {commands:?}");
                    }
                    tried += 1;
                }
            }
        }
        assert_eq!(tried, 2 + 3 + 5 + 2 + 3 + 5 + 1 + 5 + 1 + 1 + 1 + 4 + 3);
        for unit in Asked::UNITS {
            let mut asked = Asked::default();
            unit.clone_into(&mut asked.unit);
            assert!(asked.length_unit().is_ok());
        }
    }
}
