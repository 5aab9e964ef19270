//! What was measured on the surface, as text to copy and to save: the functions of the commands
//! `profile` and `volume`.

use glam::DVec3;

use crate::command::MeasuredTable;
use crate::exports::{
    PointsReport, ProfileReport, VolumeReport, points_csv, points_table, profile_csv, volume_csv,
};
use crate::open_flight::OpenFlight;

impl OpenFlight {
    /// The picked points as a table with tabs.
    pub fn picked_table(&self) -> String {
        self.with_points(points_table)
    }

    /// A table as CSV; `None` where nothing is measured now.
    pub fn measured_csv(&self, table: MeasuredTable) -> Option<Result<String, String>> {
        let drawn = self.pointer.drawn.as_ref();
        let flight = &self.flight().parts().name;
        let unit = self.measured_unit();
        let base = drawn.and_then(|drawn| self.base_name(drawn));
        let csv = match table {
            MeasuredTable::Points => {
                let is_some = !self.pointer.picked.list().is_empty();
                is_some.then(|| self.with_points(points_csv))?
            }
            MeasuredTable::Profile => profile_csv(&ProfileReport {
                flight,
                unit,
                profile: drawn?.profile()?,
            }),
            MeasuredTable::Volume => volume_csv(&VolumeReport {
                flight,
                unit,
                volume: drawn?.volume()?,
                base: base.as_deref(),
                other_heights: self.other_heights(drawn?),
            }),
        };
        Some(csv.map_err(|error| error.to_string()))
    }

    fn with_points<T>(&self, write: impl FnOnce(&PointsReport<'_>) -> T) -> T {
        let list = self.pointer.picked.list().iter();
        let points: Vec<(&str, DVec3)> = list
            .map(|picked| (picked.name.as_str(), picked.point))
            .collect();
        write(&PointsReport {
            unit: self.measured_unit(),
            crs: self.files.crs.as_deref(),
            points: &points,
        })
    }
}
