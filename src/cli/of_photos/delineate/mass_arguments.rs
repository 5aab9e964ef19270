//! Which steps lead from outlines to a distribution by mass.

use std::fs;
use std::path::PathBuf;

use clap::{Args, ValueEnum};

use crate::batch::{MOST_SHARE, steps_fit};
use crate::delineation::mass::{LOOSE, Step, WantedSteps};
use crate::delineation::tail::Tail;
use crate::exports::MeasuredPhoto;
use crate::fault::Fault;
use crate::formats::{
    DistributionColumns, FileError, read_bytes, size_distributions, without_options,
};
use crate::units::LengthUnit;

/// `--steps` and what they need.
#[derive(Debug, Clone, Args)]
pub(super) struct MassArguments {
    /// The steps from fragments to a distribution by mass, several with commas; their shares are in the report. Without it,
    /// edges, engine and fines for an engine's outlines, and edges, pores and fines for those of people and other tools.
    #[arg(long, value_enum, value_name = "STEPS", value_delimiter = ',')]
    steps: Option<Vec<StepName>>,
    /// The porosity of the pile, for the step pores; 0.45 without it.
    #[arg(long, value_name = "SHARE", value_parser = share, allow_hyphen_values = true)]
    porosity: Option<f64>,
    /// How the fines are distributed below what the photos show: as the Swebrec function of what they show, or as a table of
    /// the same material sieved. Without it nothing is claimed of them.
    #[arg(long, value_name = "swebrec|FILE.csv")]
    tail: Option<String>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum StepName {
    /// Large fragments are cut by the photo's edge more often, and those that it does not cut count for more. (Cut ones are left
    /// out in any case.)
    Edges,
    /// An engine's sizes are a little too large, as measured on simulated piles, and are taken smaller.
    Engine,
    /// Small fragments are seen deeper down between large ones, and count for less.
    Pores,
    /// What is not outlined is fines (of an engine's outlines a part of it).
    Fines,
    /// None of them: the area that is seen of each fragment.
    None,
}

impl StepName {
    fn step(self) -> Option<Step> {
        match self {
            Self::Edges => Some(Step::Edges),
            Self::Engine => Some(Step::Engine),
            Self::Pores => Some(Step::Pores),
            Self::Fines => Some(Step::Fines),
            Self::None => None,
        }
    }
}

fn share(text: &str) -> Result<f64, String> {
    let share: Option<f64> = text.parse().ok();
    let share = share.filter(|share| (0.0..=MOST_SHARE).contains(share));
    share.ok_or_else(|| format!("a share from 0 to {MOST_SHARE}, {LOOSE} for loose rock"))
}

impl MassArguments {
    /// An error where steps are named that exclude each other.
    pub(super) fn check(&self) -> Result<(), String> {
        let words = self.steps.as_deref().map(|steps| {
            let values = steps.iter().filter_map(ValueEnum::to_possible_value);
            let words: Vec<String> = values.map(|value| value.get_name().to_owned()).collect();
            words
        });
        let words = words.as_ref();
        steps_fit(
            words.map(|words| words.iter().map(String::as_str)),
            self.porosity.is_some(),
            self.tail.is_some(),
        )
        .map_err(|misfit| format!("--{}", misfit.what))
    }

    /// The file that is read for the tail.
    pub(super) fn file(&self) -> Option<PathBuf> {
        let tail = self.tail.as_ref()?;
        (!tail.eq_ignore_ascii_case("swebrec")).then(|| tail.into())
    }

    /// The law of the fines, where one is asked for.
    pub(super) fn tail_in_words(&self) -> Option<String> {
        let tail = self.tail.as_ref()?;
        Some(match self.file() {
            None => "Swebrec".to_owned(),
            Some(_) => format!("as sieved in {tail}"),
        })
    }

    /// The steps that are asked for.
    pub(super) fn steps(&self) -> WantedSteps {
        let named = self.steps.as_ref().map(|steps| {
            let steps = steps.iter();
            steps.filter_map(|step| step.step()).collect()
        });
        WantedSteps {
            named,
            porosity: self.porosity.unwrap_or(LOOSE),
        }
    }

    /// By which steps the sizes by mass of these photos follow from their outlines, a line for each way: without `--steps` they
    /// are others for an engine's outlines than for those of people.
    pub(super) fn steps_in_words(&self, photos: &[MeasuredPhoto<'_>]) -> String {
        let wanted = self.steps();
        let mut lines: Vec<String> = Vec::new();
        for of in photos {
            let steps = wanted.of(of.outlined).in_words();
            let line = format!("steps to the mass ({}): {steps}\n", of.outlined.method());
            if !lines.contains(&line) {
                lines.push(line);
            }
        }
        lines.concat()
    }

    /// That `--porosity` does nothing, where no photo takes the pores.
    pub(super) fn not_taken(&self, photos: &[MeasuredPhoto<'_>]) -> Option<String> {
        let wanted = self.steps();
        let takes = |of: &MeasuredPhoto<'_>| wanted.of(of.outlined).pores.is_some();
        (self.porosity.is_some() && !photos.iter().any(takes)).then(|| {
            "--porosity does nothing: an engine's outlines are not taken by the step pores (--steps edges,pores,fines takes it)".to_owned()
        })
    }

    /// The law of the fines, its sizes in the world's unit, with what was assumed of its table.
    ///
    /// # Errors
    /// Where its table cannot be read, or has several curves.
    pub(super) fn tail(&self, world: LengthUnit) -> Result<(Option<Tail>, Vec<String>), String> {
        if self.tail.is_none() {
            return Ok((None, Vec::new()));
        }
        let Some(path) = self.file() else {
            return Ok((Some(Tail::Swebrec), Vec::new()));
        };
        let at = |fault: Fault| FileError::new(&path, fault).to_string();
        if fs::metadata(&path).is_err() {
            let what = "there is no such file, and no law of that name";
            return Err(at(Fault::new(
                what,
                "say swebrec, or name a table of sizes",
            )));
        }
        let bytes = read_bytes(&path).map_err(|error| error.to_string())?;
        let text = String::from_utf8_lossy(&bytes);
        let (set, said) = size_distributions(&text, &DistributionColumns::default()).map_err(at)?;
        let said = said.iter().map(|said| without_options(said));
        let said = said
            .map(|said| format!("{}: {said}", path.display()))
            .collect();
        let set = set.in_unit(world).map_err(at)?;
        let [curve] = set.curves.as_slice() else {
            let what = format!("it has {} curves", set.curves.len());
            return Err(at(Fault::new(what, "give a table of one sieved curve")));
        };
        Ok((Some(Tail::Sieved(curve.distribution.clone())), said))
    }
}
