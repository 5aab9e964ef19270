//! Scales as CSV (contract, section 5): one line a photo, empty where there is no scale.

use super::scale_report::ScaleReport;

/// The report as CSV. Numbers read back to the same f64.
///
/// # Errors
/// Where memory runs out.
pub fn scales_csv(report: &ScaleReport) -> Result<String, csv::Error> {
    let unit = report.unit.symbol();
    let column = |edge: &str| format!("{edge}_px_per_{unit}");
    let number = |scale: Option<f64>| scale.map(|s| s.to_string()).unwrap_or_default();
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record([
        "photo",
        "width_px",
        "height_px",
        &column("top"),
        &column("bottom"),
        &column("left"),
        &column("right"),
        "corners_on_surface",
        "note",
    ])?;
    for line in &report.lines {
        writer.write_record([
            &line.photo,
            &line.width.to_string(),
            &line.height.to_string(),
            &number(line.scale.top),
            &number(line.scale.bottom),
            &number(line.scale.left),
            &number(line.scale.right),
            &line.corners_on_surface.to_string(),
            &line.notes.join("; "),
        ])?;
    }
    let bytes = writer.into_inner().map_err(|e| e.into_error())?;
    // All that went in was UTF-8.
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}
