//! What `fragscale batch` is asked for.

use std::num::NonZero;
use std::path::PathBuf;

use clap::builder::PossibleValue;
use clap::{Args, ValueEnum};

use crate::batch::{Asked, BatchOptions, Season, Step};
use crate::cli::OutputUnit;
use crate::cli::outputs::Force;
use crate::opening::{half_of_the_machines, memory_size};

#[derive(Debug, Args)]
pub(in crate::cli) struct BatchArguments {
    /// A SEASON.toml (docs/season.md has its keys), or flights and folders above flights: all that are found below.
    #[arg(value_name = "SEASON.toml|FOLDER", required_unless_present = "watch")]
    flights: Vec<PathBuf>,
    /// The folder of the results, with a folder of each flight in it and season.csv, season.html and season.jsonl
    /// beside them; new, or that of an earlier run, which goes on.
    #[arg(long, value_name = "DIR")]
    to: Option<PathBuf>,
    /// What is done with every flight, separated by commas; without it what SEASON.toml says, else scales and check. In the
    /// folder of an earlier run the results of steps that are not among these are taken away.
    #[arg(long, value_enum, value_delimiter = ',', value_name = "STEPS")]
    steps: Vec<StepName>,
    /// Lengths and scales are in this unit; without it what SEASON.toml says, else cm.
    #[arg(long, value_enum)]
    unit: Option<OutputUnit>,
    /// Say more of a step, as its own command takes it: delineate.engine=classical, export.photos=trusted,
    /// psd.reference=sieves.csv, scale-map.layers=scale,depth. May be given more than once.
    #[arg(long, value_name = "STEP.KEY=VALUE", value_parser = said)]
    set: Vec<Said>,
    /// How many flights at once, at most; without it one for two processors.
    #[arg(long, value_name = "COUNT")]
    jobs: Option<NonZero<usize>>,
    /// How much memory they may take together, as 8GB; without it half of the machine's.
    #[arg(long, value_name = "AMOUNT", value_parser = memory_size)]
    memory: Option<u64>,
    /// What goes to standard output: the table of all flights, or a line of JSON for each when it is done.
    #[arg(long, value_enum, default_value = "table")]
    pub(super) format: BatchFormat,
    /// Look for flights below this folder until Ctrl+C, and take each when its files have not changed for a while.
    #[arg(long, value_name = "FOLDER")]
    pub(super) watch: Option<PathBuf>,
    /// For how long, in seconds.
    #[arg(long, value_name = "SECONDS", default_value_t = 10, requires = "watch")]
    pub(super) settle: u64,
    #[command(flatten)]
    force: Force,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum BatchFormat {
    Table,
    Jsonl,
}

/// A step as a word of the command line.
#[derive(Debug, Clone, Copy)]
struct StepName(Step);

impl ValueEnum for StepName {
    fn value_variants<'a>() -> &'a [Self] {
        const ALL: [StepName; 6] = [
            StepName(Step::Scales),
            StepName(Step::Check),
            StepName(Step::Export),
            StepName(Step::ScaleMap),
            StepName(Step::Delineate),
            StepName(Step::Psd),
        ];
        &ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(PossibleValue::new(self.0.as_str()).help(self.0.explained()))
    }
}

/// What is said of a step.
#[derive(Debug, Clone)]
struct Said {
    step: Step,
    key: String,
    values: Vec<String>,
}

fn said(text: &str) -> Result<Said, String> {
    let parts = text.split_once('=');
    let parts = parts.and_then(|(name, value)| Some((name.split_once('.')?, value)));
    let Some(((step, key), value)) = parts else {
        return Err("write it as STEP.KEY=VALUE".to_owned());
    };
    let step: Step = step.trim().parse()?;
    let option = step
        .options()
        .iter()
        .find(|option| option.key == key.trim());
    let values = match option.is_some_and(|option| option.is_list) {
        true => value
            .split(',')
            .map(|value| value.trim().to_owned())
            .collect(),
        false => vec![value.trim().to_owned()],
    };
    let said = Said {
        step,
        key: key.trim().to_owned(),
        values,
    };
    // As if all steps were asked for: whether this one is, is known later.
    Asked::of(&Step::ALL).set(step, &said.key, said.values.clone())?;
    Ok(said)
}

/// Why it cannot be begun.
pub(super) enum Refused {
    /// The command line contradicts itself.
    Usage(String),
    /// The season cannot be used.
    Season(String),
}

impl BatchArguments {
    /// The season, and how it is done.
    pub(super) fn season(&self) -> Result<(Season, BatchOptions), Refused> {
        let file = self.flights.iter().find(|path| Season::is_season(path));
        let mut season = match (file, &self.flights[..]) {
            (Some(file), [_]) => {
                Season::read(file).map_err(|error| Refused::Season(error.to_string()))?
            }
            (Some(file), _) => {
                let file = file.display();
                let what =
                    format!("{file} is a season, and names its flights itself; name it alone");
                return Err(Refused::Usage(what));
            }
            (None, _) => Season::of_folders(&self.flights, Asked::default())
                .map_err(|error| Refused::Season(error.to_string()))?,
        };
        if let Some(folder) = &self.watch {
            if !folder.is_dir() {
                let what = format!(
                    "{}: there is no such folder; make it first",
                    folder.display()
                );
                return Err(Refused::Season(what));
            }
            season.watch(folder);
        }
        if !self.steps.is_empty() {
            let steps: Vec<Step> = self.steps.iter().map(|step| step.0).collect();
            season.asked.set_steps(&steps);
        }
        if let Some(unit) = self.unit {
            let unit: crate::units::LengthUnit = unit.into();
            unit.symbol().clone_into(&mut season.asked.unit);
        }
        for said in &self.set {
            let set = season.asked.set(said.step, &said.key, said.values.clone());
            set.map_err(Refused::Usage)?;
        }
        season.asked.check().map_err(Refused::Usage)?;
        let Some(to) = self.to.clone().or_else(|| season.to.clone()) else {
            let what = "it is not said where the results go; give --to DIR";
            return Err(Refused::Usage(what.to_owned()));
        };
        let program = std::env::current_exe().map_err(|error| {
            Refused::Season(format!(
                "this program is not found ({error}); install it anew"
            ))
        })?;
        let options = BatchOptions {
            program,
            to,
            jobs: self.jobs.unwrap_or_else(BatchOptions::usual_jobs),
            memory: self.memory.unwrap_or_else(half_of_the_machines),
            force: self.force.force,
        };
        Ok((season, options))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_said_of_steps_is_understood() {
        let of = said("scale-map.layers=scale, z").unwrap();
        assert_eq!((of.step, of.values.len()), (Step::ScaleMap, 2));
        let of = said("psd.reference=a=b.csv").unwrap();
        assert_eq!(of.values, ["a=b.csv"]);
        for wrong in [
            "delineate",
            "delineate=classical",
            "outline.engine=classical",
            "delineate.engine=both",
            "delineate.engin=classical",
        ] {
            assert!(said(wrong).is_err(), "{wrong}");
        }
    }
}
