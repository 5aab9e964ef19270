//! `fragscale psd fit`: a function fitted to every curve of a table.

use std::path::PathBuf;

use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use rayon::prelude::*;

use super::outputs::OutputArguments;
use super::written_beside::{drawn_figures, figure_formats, write_all};
use super::{Answer, OutputUnit, ScalesFormat};
use crate::exports::{self, FitReport, FittedCurve, FittedDistribution};
use crate::fault::Fault;
use crate::files::Kind;
use crate::formats::{DistributionColumns, FileError, read_point_weights, read_size_distributions};
use crate::fragmentation::{self, FitOptions, LabelledDistribution, Model};

#[derive(Debug, Args)]
pub(super) struct FitArguments {
    /// A table of cumulative percent passing by size, as CSV.
    file: PathBuf,
    /// The column of sizes, where its name does not say so.
    #[arg(long, value_name = "COLUMN")]
    size: Option<String>,
    /// The column of cumulative percent passing.
    #[arg(long, value_name = "COLUMN")]
    passing: Option<String>,
    /// The unit of sizes, where the table does not state it.
    #[arg(long = "size-unit", alias = "unit", value_enum)]
    unit: Option<OutputUnit>,
    /// The function to fit.
    #[arg(long, value_parser = models(), default_value = "swebrec")]
    model: Model,
    /// The largest size, where it is known, in the unit of the table; it is not fitted then.
    #[arg(long, value_name = "SIZE")]
    xmax: Option<f64>,
    /// A column with a weight for each size; without it all points count the same.
    #[arg(long, value_name = "COLUMN", requires = "size")]
    weights: Option<String>,
    /// The confidence of bands.
    #[arg(long, value_parser = level, default_value_t = 0.95)]
    level: f64,
    /// Percents passing whose sizes are given, beside every ten from 10 to 90.
    #[arg(
        long,
        value_name = "PERCENT,...",
        value_delimiter = ',',
        value_parser = percent,
        default_value = "10,20,50,80,90"
    )]
    percentiles: Vec<f64>,
    /// How to write it.
    #[arg(long, value_enum, default_value = "table")]
    format: ScalesFormat,
    #[command(flatten)]
    output: OutputArguments,
    /// Draw points, fits and their bands (95 %) into this file, .svg or .png; may be given more than
    /// once.
    #[arg(long, value_name = "FILE")]
    figure: Vec<PathBuf>,
}

/// The models by their keys, each explained by its name.
pub(super) fn models() -> impl TypedValueParser<Value = Model> {
    let keys = Model::ALL.map(|model| PossibleValue::new(model.key()).help(model.name()));
    PossibleValuesParser::new(keys).map(|key| {
        let model = Model::ALL.into_iter().find(|model| model.key() == key);
        model.unwrap_or_default()
    })
}

fn level(text: &str) -> Result<f64, String> {
    let level = text.parse().map_err(|e| format!("{e}"))?;
    if level > 0.0 && level < 1.0 {
        return Ok(level);
    }
    Err("give a confidence between 0 and 1, such as 0.95".to_owned())
}

fn percent(text: &str) -> Result<f64, String> {
    let percent = text.trim().parse().map_err(|e| format!("{e}"))?;
    if percent > 0.0 && percent < 100.0 {
        return Ok(percent);
    }
    Err("give percents between 0 and 100".to_owned())
}

pub(super) fn fit(arguments: &FitArguments) -> Result<Answer, String> {
    let formats = figure_formats(&arguments.figure)?;
    let path = &arguments.file;
    let mut outputs = arguments.output.outputs([path])?;
    for figure in &arguments.figure {
        outputs = outputs.and(figure, Kind::Result)?;
    }
    let columns = DistributionColumns {
        size: arguments.size.clone(),
        passing: arguments.passing.clone(),
        unit: arguments.unit.map(Into::into),
        ..DistributionColumns::default()
    };
    let (set, mut warnings) =
        read_size_distributions(path, &columns).map_err(|error| error.to_string())?;
    let weights = match (&arguments.size, &arguments.weights) {
        (Some(size), Some(column)) => {
            let (weights, mended) =
                read_point_weights(path, size, column).map_err(|error| error.to_string())?;
            warnings.extend(mended);
            Some(weights)
        }
        _ => None,
    };
    let one = |curve: &LabelledDistribution| -> Result<FittedCurve, Fault> {
        let points = curve.distribution.points();
        let weights = weights.as_ref().map(|weights| weights.of(points));
        let options = FitOptions {
            weights: weights.transpose()?,
            xmax: arguments.xmax,
        };
        let fit = fragmentation::fit(&curve.distribution, arguments.model, &options)?;
        Ok(FittedCurve::new(curve, fit, &options))
    };
    let outcomes: Vec<_> = set.curves.par_iter().map(one).collect();
    let mut fitted = Vec::new();
    let mut drawn = Vec::new();
    let mut fault = None;
    for (curve, outcome) in set.curves.iter().zip(outcomes) {
        match outcome {
            Ok(found) => {
                drawn.push((curve.labels.to_string(), curve, found.fit().clone()));
                fitted.push(found);
            }
            Err(trouble) => {
                warnings.push(format!("{}: left out: {trouble}", curve.labels));
                fault.get_or_insert(trouble);
            }
        }
    }
    if let (true, Some(fault)) = (fitted.is_empty(), fault) {
        return Err(FileError::new(path, fault).to_string());
    }
    let title = path.file_stem().unwrap_or_default().to_string_lossy();
    let shown: Vec<FittedDistribution<'_>> = drawn
        .iter()
        .map(|(name, curve, fit)| FittedDistribution {
            name,
            distribution: &curve.distribution,
            fit,
        })
        .collect();
    let figure = exports::figure_of_fits(title, set.unit, &shown);
    let figures = drawn_figures(&figure, formats)?;
    let report = FitReport::new(set.unit, fitted, arguments.level, &arguments.percentiles);
    let text = match arguments.format {
        ScalesFormat::Table => exports::fit_table(&report),
        ScalesFormat::Csv => exports::fit_csv(&report).map_err(|e| e.to_string())?,
        ScalesFormat::Json => exports::fit_json(&report).map_err(|e| e.to_string())?,
    };
    write_all(figures, &outputs)?;
    let text = outputs.deliver(text)?;
    Ok(Answer::new(text, warnings))
}
