//! What was measured on a surface, going out: tables for people, CSV, JSON. Lengths are in the world's
//! unit, which is always said.

mod points;
mod profile;
mod volume;

pub use points::{PointsReport, points_csv, points_table};
pub use profile::{
    ProfileReport, profile_csv, profile_json, profile_table, profile_warnings, stone_sides,
};
pub use volume::{VolumeReport, volume_csv, volume_json, volume_table, volume_warnings};

use crate::flight::FlightParts;
use crate::numbers::significant_digits;
use crate::survey::{BRIDGE, LEAST_BRIDGED};

/// What is written beside lengths, areas and volumes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MeasuredUnit {
    /// The world's unit; `None` where nobody states one.
    symbol: Option<&'static str>,
}

impl MeasuredUnit {
    /// That of a flight's world.
    pub fn of(parts: &FlightParts) -> Self {
        Self {
            symbol: parts.unit_known.then(|| parts.unit.symbol()),
        }
    }

    /// "m", or "units of the file".
    pub fn length(self) -> String {
        self.symbol.unwrap_or("units of the file").to_owned()
    }

    /// "m²".
    pub fn area(self) -> String {
        match self.symbol {
            Some(symbol) => format!("{symbol}²"),
            None => "square units of the file".to_owned(),
        }
    }

    /// "m³".
    pub fn volume(self) -> String {
        match self.symbol {
            Some(symbol) => format!("{symbol}³"),
            None => "cubic units of the file".to_owned(),
        }
    }

    /// For names of columns: "m", or "file_units".
    fn in_names(self) -> &'static str {
        self.symbol.unwrap_or("file_units")
    }
}

/// A coordinate or height for people: a thousandth of the unit, as in the window.
fn coordinate(number: f64) -> String {
    format!("{number:.3}")
}

/// A level that is typed again: six decimals, of which those beyond the third are left out where they are 0.
fn level(number: f64) -> String {
    let text = format!("{number:.6}");
    let mut kept = text.as_str();
    for _ in 0..3 {
        kept = kept.strip_suffix('0').unwrap_or(kept);
    }
    kept.to_owned()
}

/// That a cloud has no points in a part of what is measured, and triangles bridge it; `None` of little.
fn bridged(measured: &str, share: f64, of_grids: &str) -> Option<String> {
    (share > LEAST_BRIDGED).then(|| {
        format!(
            "in {} of {measured} the cloud has no points, and triangles more than {BRIDGE:.0} times as long as most of them{of_grids} bridge it: \
             what is there was not measured (a longest edge, max_edge of [surface], makes holes of them)",
            percent(share)
        )
    })
}

/// A share in percent. What is not all of it is not called 100 %.
pub fn percent(share: f64) -> String {
    let percent = 100.0 * share;
    match share < 1.0 && percent > 99.94 {
        true if share < 1.0 - 1e-9 => "almost 100 %".to_owned(),
        true => "100 %".to_owned(),
        false => format!("{} %", significant_digits(percent, 3)),
    }
}

/// Rows of a name and what is said of it, aligned.
pub(crate) fn rows_of_text(rows: &[(&str, String)]) -> String {
    let width = rows.iter().map(|(name, _)| name.chars().count());
    let width = width.max().unwrap_or(0);
    let lines = rows
        .iter()
        .map(|(name, said)| format!("{name:<width$}  {said}\n"));
    lines.collect()
}

/// CSV of a header and records.
pub(crate) fn csv_of(records: impl IntoIterator<Item = Vec<String>>) -> Result<String, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for record in records {
        writer.write_record(record)?;
    }
    let bytes = writer.into_inner().map_err(|e| e.into_error())?;
    // All that went in was UTF-8.
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_level_has_the_digits_that_it_needs() {
        for (number, text) in [
            (-0.002_148, "-0.002148"),
            (301.25, "301.250"),
            (0.1 + 0.2, "0.300"),
            (100.0, "100.000"),
            (7.0001, "7.0001"),
        ] {
            assert_eq!(level(number), text);
        }
    }
}
