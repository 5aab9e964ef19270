//! `fragscale psd compare`: methods held against a reference, with the figure and the report.

use std::path::PathBuf;

use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};

use super::distribution_arguments::DistributionArguments;
use super::outputs::OutputArguments;
use super::psd_fit::models;
use super::written_beside::{check_report_name, drawn_figures, figure_formats, write_all};
use super::{Answer, ScalesFormat};
use crate::exports::{self, ComparisonReport};
use crate::files::Kind;
use crate::formats::FileError;
use crate::fragmentation::{
    self, Comparison, ComparisonOptions, DistributionSet, Model, Repeatability, SieveSeries,
    Weighting, repeatability,
};
use crate::jobs::Progress;

/// The level of significance of the report's analyses of variance.
const LEVEL: f64 = 0.05;

#[derive(Debug, Args)]
pub(super) struct CompareArguments {
    #[command(flatten)]
    table: DistributionArguments,
    /// The method that the others are held against.
    #[arg(long, value_name = "METHOD", default_value = "sieve")]
    reference: String,
    /// The function that is fitted to every method's mean curve.
    #[arg(long, value_parser = models(), default_value = "swebrec")]
    model: Model,
    /// Half the width of the envelope about the reference, percent.
    #[arg(long, value_name = "PERCENT", default_value_t = 30.0)]
    envelope: f64,
    /// Percents passing whose sizes are compared.
    #[arg(
        long,
        value_name = "PERCENT,...",
        value_delimiter = ',',
        default_value = "10,20,50,80,90"
    )]
    percentiles: Vec<f64>,
    /// Take all curves at the sieves of a standard series first.
    #[arg(long, value_name = "SERIES", value_parser = series())]
    resample: Option<SieveSeries>,
    /// What each photo of a trial counts by where they are merged: all the same, or by the area or mass
    /// in the column of weights.
    #[arg(long, value_parser = weightings(), default_value = "equal")]
    merge: Weighting,
    /// How to write it.
    #[arg(long, value_enum, default_value = "table")]
    format: ScalesFormat,
    #[command(flatten)]
    output: OutputArguments,
    /// Draw the distributions into this file, .svg or .png; may be given more than once.
    #[arg(long, value_name = "FILE")]
    figure: Vec<PathBuf>,
    /// Write a report with the figure and all tables into this file, .html.
    #[arg(long, value_name = "FILE")]
    report: Option<PathBuf>,
}

fn weightings() -> impl TypedValueParser<Value = Weighting> {
    let keys = PossibleValuesParser::new(Weighting::ALL.map(Weighting::key));
    let find = |key: String| {
        Weighting::ALL
            .into_iter()
            .find(|weighting| weighting.key() == key)
    };
    keys.map(move |key| find(key).unwrap_or_default())
}

/// Every series by its key, the first of each standard by the standard's name alone ("astm") too.
fn series() -> impl TypedValueParser<Value = SieveSeries> {
    let standard = |key: &'static str| key.split('-').next().unwrap_or(key);
    let mut named: Vec<&str> = Vec::new();
    let values = SieveSeries::ALL.map(|series| {
        let name = standard(series.key());
        let value = PossibleValue::new(series.key());
        if named.contains(&name) {
            return value;
        }
        named.push(name);
        value.alias(name)
    });
    PossibleValuesParser::new(values).try_map(move |text| {
        let mut all = SieveSeries::ALL.into_iter();
        let found =
            all.find(|series| [series.key(), standard(series.key())].contains(&text.as_str()));
        found.ok_or("no such series")
    })
}

/// Reads, merges, resamples, compares, draws; writes when all of it went well.
pub(super) fn compare(arguments: &CompareArguments, progress: &Progress) -> Result<Answer, String> {
    let formats = figure_formats(&arguments.figure)?;
    if let Some(report) = &arguments.report {
        check_report_name(report)?;
    }
    let mut outputs = arguments.output.outputs(arguments.table.files())?;
    for path in arguments.figure.iter().chain(&arguments.report) {
        outputs = outputs.and(path, Kind::Result)?;
    }
    progress.stage("reading");
    let (read, mut warnings) = arguments.table.read()?;
    let prepared = prepare(read, arguments, &mut warnings)?;
    progress.stage("fitting");
    let options = ComparisonOptions {
        model: arguments.model,
        envelope_percent: arguments.envelope,
        percentiles: arguments.percentiles.clone(),
        ..ComparisonOptions::new(arguments.reference.as_str())
    };
    let comparison =
        fragmentation::compare(&prepared.trials, &options).map_err(|e| e.to_string())?;
    progress.stage("drawing");
    let figure = exports::figure_of_comparison(&comparison);
    let mut pending = drawn_figures(&figure, formats)?;
    if let Some(path) = &arguments.report {
        let repeatability = prepared.repeatability(&comparison, &mut warnings);
        let page = exports::comparison_report(&ComparisonReport {
            sources: &arguments.table.names(),
            comparison: &comparison,
            repeatability: &repeatability,
            preparation: &prepared.steps,
            warnings: &warnings,
        });
        let page = page.map_err(|fault| FileError::new(path, fault).to_string())?;
        pending.push((path, page.into_bytes()));
    }
    let text = match arguments.format {
        ScalesFormat::Table => exports::comparison_text(&comparison),
        ScalesFormat::Csv => exports::comparison_csv(&comparison).map_err(|e| e.to_string())?,
        ScalesFormat::Json => exports::comparison_json(&comparison).map_err(|e| e.to_string())?,
    };
    write_all(pending, &outputs)?;
    let text = outputs.deliver(text)?;
    Ok(Answer::new(text, warnings))
}

/// What is compared, and how it came from what was read.
struct Prepared {
    /// A curve a method, trial and photo.
    photos: DistributionSet,
    /// A curve a method and trial.
    trials: DistributionSet,
    /// What was done, a sentence each.
    steps: Vec<String>,
}

fn prepare(
    read: DistributionSet,
    arguments: &CompareArguments,
    warnings: &mut Vec<String>,
) -> Result<Prepared, String> {
    let mut steps = Vec::new();
    let mut photos = read;
    if let Some(series) = arguments.resample {
        let (set, noticed) = photos
            .resampled(series)
            .map_err(|fault| fault.to_string())?;
        photos = set;
        warnings.extend(noticed);
        steps.push(format!(
            "All curves were taken at the sieves of {}.",
            series.name()
        ));
    }
    let (trials, noticed) = photos
        .photos_merged(arguments.merge, None)
        .map_err(|fault| fault.to_string())?;
    warnings.extend(noticed);
    if trials.curves.len() < photos.curves.len() {
        steps.push(format!(
            "The {} curves of photos became {} of trials: {}.",
            photos.curves.len(),
            trials.curves.len(),
            arguments.merge.sentence()
        ));
    }
    Ok(Prepared {
        photos,
        trials,
        steps,
    })
}

impl Prepared {
    /// Of every method with several trials.
    fn repeatability(
        &self,
        comparison: &Comparison,
        warnings: &mut Vec<String>,
    ) -> Vec<Repeatability> {
        let others = comparison.methods.iter().map(|method| &method.curve);
        let curves = std::iter::once(&comparison.reference).chain(others);
        let mut found = Vec::new();
        for curve in curves.filter(|curve| curve.trials.len() > 1) {
            match repeatability(&self.photos, &curve.method, &[], LEVEL) {
                Ok(of_method) => found.push(of_method),
                Err(fault) => warnings.push(format!("no analysis of variance: {fault}")),
            }
        }
        found
    }
}
