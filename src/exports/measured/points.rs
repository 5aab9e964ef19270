//! Points that were picked, going out: their coordinates with all digits, in the world.

use glam::DVec3;

use super::{MeasuredUnit, csv_of};

/// Points and the world that they are in.
#[derive(Debug, Clone, Copy)]
pub struct PointsReport<'a> {
    /// Of their coordinates.
    pub unit: MeasuredUnit,
    /// The world's coordinate system, where it is known.
    pub crs: Option<&'a str>,
    /// Names and places, in the world.
    pub points: &'a [(&'a str, DVec3)],
}

impl PointsReport<'_> {
    /// The columns' names, and a line for each point. Numbers read back to the same f64.
    fn lines(&self) -> impl Iterator<Item = Vec<String>> {
        let unit = self.unit.in_names();
        let header = ["x", "y", "z"].map(|axis| format!("{axis}_{unit}"));
        let with_crs = |mut line: Vec<String>, crs: &str| {
            line.extend(self.crs.map(|_| crs.to_owned()));
            line
        };
        let line = move |name: &str, numbers: [String; 3]| -> Vec<String> {
            std::iter::once(name.to_owned()).chain(numbers).collect()
        };
        let points = self.points.iter().map(move |(name, point)| {
            let numbers = point.to_array().map(|number| number.to_string());
            with_crs(line(name, numbers), self.crs.unwrap_or_default())
        });
        std::iter::once(with_crs(line("point", header), "crs")).chain(points)
    }
}

/// A table to paste: columns between tabs.
pub fn points_table(report: &PointsReport<'_>) -> String {
    // A tab or an end of line within a name would be another cell.
    let cell = |text: String| text.replace(['\t', '\n', '\r'], " ");
    let row = |line: Vec<String>| {
        let cells: Vec<String> = line.into_iter().map(cell).collect();
        cells.join("\t") + "\n"
    };
    report.lines().map(row).collect()
}

/// A line for each point: its name, x, y, z, and the coordinate system where it is known.
///
/// # Errors
/// Where memory runs out.
pub fn points_csv(report: &PointsReport<'_>) -> Result<String, csv::Error> {
    csv_of(report.lines())
}

#[cfg(test)]
mod tests {
    use super::*;

    const POINTS: [(&str, DVec3); 2] = [
        ("P1", DVec3::new(500_000.123_456_789, 5_000_000.1, -0.1)),
        ("toe, \"left\"", DVec3::new(0.1 + 0.2, 1e-7, 3.0)),
    ];

    #[test]
    fn numbers_read_back_to_the_same() {
        let report = PointsReport {
            unit: MeasuredUnit { symbol: Some("m") },
            crs: Some("EPSG:32633"),
            points: &POINTS,
        };
        let csv = points_csv(&report).unwrap();
        let mut reader = csv::Reader::from_reader(csv.as_bytes());
        assert_eq!(
            reader.headers().unwrap(),
            vec!["point", "x_m", "y_m", "z_m", "crs"]
        );
        let records: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
        for (record, (name, point)) in records.iter().zip(POINTS) {
            assert_eq!((&record[0], &record[4]), (name, "EPSG:32633"));
            let number = |place: usize| record[place].parse::<f64>().unwrap();
            assert_eq!(DVec3::new(number(1), number(2), number(3)), point);
        }
        assert_eq!(records.len(), 2);
    }

    #[test]
    fn a_table_has_tabs_and_says_where_no_unit_is_known() {
        let report = PointsReport {
            unit: MeasuredUnit { symbol: None },
            crs: None,
            points: &[("a\tb", DVec3::new(1.5, 2.0, -3.25))],
        };
        let expected = "point\tx_file_units\ty_file_units\tz_file_units\na b\t1.5\t2\t-3.25\n";
        assert_eq!(points_table(&report), expected);
    }
}
