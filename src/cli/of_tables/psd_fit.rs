//! `fragscale psd fit`: a function fitted to every curve of a table.

use std::path::PathBuf;

use clap::Args;

use super::distribution_arguments::{ColumnArguments, FittingArguments};
use crate::cli::Answer;
use crate::cli::written_beside::{drawn_figures, figure_formats, write_all};
use crate::exports::{self, FitReport, FittedCurve, FittedDistribution};
use crate::fault::Fault;
use crate::files::Kind;
use crate::formats::{DistributionColumns, FileError, SizesRead, read_point_weights, read_sizes};
use crate::fragmentation::{FitOptions, LabelledDistribution, fit_each};
use crate::jobs::Progress;

#[derive(Debug, Args)]
pub(in crate::cli) struct FitArguments {
    /// A table of cumulative percent passing by size, as CSV.
    file: PathBuf,
    #[command(flatten)]
    columns: ColumnArguments,
    /// The largest size, where it is known, in the unit of the table; it is not fitted then.
    #[arg(long, value_name = "SIZE")]
    xmax: Option<f64>,
    /// A column with a weight for each size, beside the column of sizes (--size); without it all points count the same.
    #[arg(long, value_name = "COLUMN")]
    weights: Option<String>,
    /// The confidence of bands; a figure's have 95 %.
    #[arg(long, value_parser = level, default_value_t = 0.95)]
    level: f64,
    #[command(flatten)]
    fitting: FittingArguments,
}

fn level(text: &str) -> Result<f64, String> {
    let level = text.parse().map_err(|e| format!("{e}"))?;
    if level > 0.0 && level < 1.0 {
        return Ok(level);
    }
    Err("give a confidence between 0 and 1, such as 0.95".to_owned())
}

pub(super) fn fit(arguments: &FitArguments, progress: &Progress) -> Result<Answer, String> {
    let fitting = &arguments.fitting;
    let formats = figure_formats(&fitting.figure)?;
    let path = &arguments.file;
    let mut outputs = fitting.answer.outputs([path])?;
    for figure in &fitting.figure {
        outputs = outputs.and(figure, Kind::Result)?;
    }
    if arguments.weights.is_some() && arguments.columns.size.is_none() {
        return Err(
            "--weights needs the column of sizes that they belong to, too (--size COLUMN)"
                .to_owned(),
        );
    }
    let columns = DistributionColumns {
        point_weight: arguments.weights.clone(),
        ..arguments.columns.columns()
    };
    let SizesRead {
        set,
        factor,
        said: mut warnings,
    } = read_sizes(path, &columns).map_err(|error| error.to_string())?;
    let weights = match (&arguments.columns.size, &arguments.weights) {
        (Some(size), Some(column)) => {
            let (weights, mended) =
                read_point_weights(path, size, column).map_err(|error| error.to_string())?;
            warnings.extend(mended);
            Some(weights)
        }
        _ => None,
    };
    let options_of = |curve: &LabelledDistribution| -> Result<FitOptions, Fault> {
        let points = curve.distribution.points();
        let weights = weights
            .as_ref()
            .map(|weights| weights.of(points, set.unit, factor));
        Ok(FitOptions {
            weights: weights.transpose()?,
            // As the table's sizes: in micrometres where those are.
            xmax: arguments.xmax.map(|xmax| xmax * factor),
        })
    };
    let fits =
        fit_each(&set, fitting.model, options_of, progress).map_err(|fault| fault.to_string())?;
    let title = path.file_stem().unwrap_or_default().to_string_lossy();
    let figure = exports::figure_of_fits(title, set.unit, &FittedDistribution::of(&set, &fits));
    let mut fitted = Vec::new();
    let mut fault = None;
    for (curve, outcome) in set.curves.iter().zip(fits) {
        let found = outcome.and_then(|fit| Ok(FittedCurve::new(curve, fit, &options_of(curve)?)));
        match found {
            Ok(found) => fitted.push(found),
            Err(trouble) => {
                warnings.push(format!("{}: left out: {trouble}", curve.labels));
                fault.get_or_insert(trouble);
            }
        }
    }
    if let (true, Some(fault)) = (fitted.is_empty(), fault) {
        return Err(FileError::new(path, fault).to_string());
    }
    progress.stage("drawing");
    let figures = drawn_figures(&figure, formats)?;
    let report = FitReport::new(set.unit, fitted, arguments.level, &fitting.percentiles);
    if fitting.answer.is_csv() {
        warnings.extend(exports::fit_csv_warnings(&report));
    }
    let text = fitting.answer.text(
        &report,
        exports::fit_table,
        exports::fit_csv,
        exports::fit_json,
    )?;
    write_all(figures, &outputs)?;
    let text = outputs.deliver(text)?;
    Ok(Answer::new(text, warnings))
}
