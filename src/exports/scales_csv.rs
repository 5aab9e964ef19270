//! Scales as CSV (contract, section 5): one line a photo, empty where there is no scale. Its columns
//! are those of `photo_columns.rs`.

use super::photo_columns::PHOTO_COLUMNS;
use super::scale_report::ScaleReport;

/// The report as CSV. Numbers read back to the same f64.
///
/// # Errors
/// Where memory runs out.
pub fn scales_csv(report: &ScaleReport<'_>) -> Result<String, csv::Error> {
    let columns = || PHOTO_COLUMNS.iter().filter(|column| column.csv.is_some());
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(columns().filter_map(|column| column.csv_heading(report.unit())))?;
    for line in report.lines() {
        writer.write_record(columns().map(|column| column.csv_value(&line)))?;
    }
    let bytes = writer.into_inner().map_err(|e| e.into_error())?;
    // All that went in was UTF-8.
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}
