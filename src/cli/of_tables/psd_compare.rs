//! `fragscale psd compare`: methods held against a reference, with the figure and the report.

use std::path::PathBuf;

use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};

use super::distribution_arguments::{DistributionArguments, FittingArguments};
use crate::cli::Answer;
use crate::cli::written_beside::{check_report_name, drawn_figures, figure_formats, write_all};
use crate::exports::{self, ComparisonReport};
use crate::files::Kind;
use crate::fragmentation::{
    Analysis, AnalysisOptions, MethodCurve, SIGNIFICANCE, SieveSeries, Weighting,
};
use crate::jobs::Progress;
use crate::units::LengthUnit;

#[derive(Debug, Args)]
pub(in crate::cli) struct CompareArguments {
    #[command(flatten)]
    table: DistributionArguments,
    /// The method that the others are held against. Without it, the one called sieve, sieving,
    /// reference (also Sieb, tamisage and others) or known fragments, else the first.
    #[arg(long, value_name = "METHOD")]
    reference: Option<String>,
    /// Half the width of the envelope about the reference, percent.
    #[arg(long, value_name = "PERCENT", default_value_t = 30.0)]
    envelope: f64,
    /// Take all curves at the sieves of a standard series first.
    #[arg(long, value_name = "SERIES", value_parser = series())]
    resample: Option<SieveSeries>,
    /// What each photo of a trial counts by where they are merged: all the same, or by the area or mass
    /// in the column of weights.
    #[arg(long, value_parser = weightings(), default_value = "equal")]
    merge: Weighting,
    #[command(flatten)]
    fitting: FittingArguments,
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

/// Reads, analyses, draws; writes when all of it went well.
pub(super) fn compare(arguments: &CompareArguments, progress: &Progress) -> Result<Answer, String> {
    compare_with(arguments, progress).map(|(answer, _)| answer)
}

/// The same, with the reference that all were held against, and the unit of its sizes.
pub(in crate::cli) fn compare_with(
    arguments: &CompareArguments,
    progress: &Progress,
) -> Result<(Answer, (MethodCurve, LengthUnit)), String> {
    let fitting = &arguments.fitting;
    let formats = figure_formats(&fitting.figure)?;
    if let Some(report) = &arguments.report {
        check_report_name(report)?;
    }
    let mut outputs = fitting.answer.outputs(arguments.table.files())?;
    for path in fitting.figure.iter().chain(&arguments.report) {
        outputs = outputs.and(path, Kind::Result)?;
    }
    progress.stage("reading");
    let (read, mut warnings) = arguments.table.read(arguments.merge)?;
    let options = AnalysisOptions {
        model: fitting.model,
        merging: arguments.merge,
        sieves: arguments.resample,
        reference: arguments.reference.clone(),
        envelope_percent: arguments.envelope,
        percentiles: fitting.percentiles.clone(),
        level: SIGNIFICANCE,
    };
    let analysis = Analysis::of(read, &options, progress).map_err(|fault| fault.to_string())?;
    let comparison = analysis
        .comparison
        .as_ref()
        .map_err(|fault| fault.to_string())?;
    progress.stage("drawing");
    let figure = exports::figure_of_comparison(comparison);
    let mut pending = drawn_figures(&figure, formats)?;
    match &arguments.report {
        Some(path) => {
            let names = arguments.table.names();
            let report = ComparisonReport::of(&names, warnings, &analysis)
                .map_err(|fault| fault.to_string())?;
            let page = exports::comparison_report(&report);
            pending.push((path, page.into_bytes()));
            warnings = report.warnings;
        }
        None => warnings.extend(analysis.warnings.iter().cloned()),
    }
    let text = fitting.answer.text(
        comparison,
        exports::comparison_text,
        exports::comparison_csv,
        exports::comparison_json,
    )?;
    write_all(pending, &outputs)?;
    let text = outputs.deliver(text)?;
    let reference = comparison.reference.clone();
    Ok((Answer::new(text, warnings), (reference, comparison.unit)))
}
