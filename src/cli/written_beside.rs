//! Files that a command writes beside its answer: figures and a report. Their names are looked at
//! before the work begins, and they are written when all of it went well.

use std::path::{Path, PathBuf};

use super::outputs::Outputs;
use crate::exports::{FigureContents, FigureFormat};
use crate::fault::Fault;
use crate::files::Kind;
use crate::formats::FileError;

/// A file whose bytes are not written yet.
pub(super) type Pending<'a> = (&'a Path, Vec<u8>);

/// The files of figures with their formats.
pub(super) fn figure_formats(figures: &[PathBuf]) -> Result<Vec<(&Path, FigureFormat)>, String> {
    let formats = figures.iter().map(|path| match FigureFormat::of(path) {
        Ok(format) => Ok((path.as_path(), format)),
        Err(fault) => Err(FileError::new(path, fault).to_string()),
    });
    formats.collect()
}

/// The figure in every format.
pub(super) fn drawn_figures<'a>(
    figure: &FigureContents,
    formats: Vec<(&'a Path, FigureFormat)>,
) -> Result<Vec<Pending<'a>>, String> {
    let drawn = formats
        .into_iter()
        .map(|(path, format)| match format.bytes(figure) {
            Ok(bytes) => Ok((path, bytes)),
            Err(fault) => Err(FileError::new(path, fault).to_string()),
        });
    drawn.collect()
}

/// Whether a report may be called so.
pub(super) fn check_report_name(path: &Path) -> Result<(), String> {
    let ending = path
        .extension()
        .map(|ending| ending.to_string_lossy().to_lowercase());
    if matches!(ending.as_deref(), Some("html" | "htm")) {
        return Ok(());
    }
    let fault = Fault::new("a report is written as HTML", "let its name end in .html");
    Err(FileError::new(path, fault).to_string())
}

/// Each whole or not at all.
pub(super) fn write_all(pending: Vec<Pending<'_>>, outputs: &Outputs<'_>) -> Result<(), String> {
    pending
        .into_iter()
        .try_for_each(|(path, bytes)| outputs.write(path, &bytes, Kind::Result))
}
