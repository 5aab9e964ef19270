//! report.html of `fragscale delineate`.

use std::path::PathBuf;

use super::sizes::{Done, Sizes};
use crate::exports::{
    FragmentsReport, ReportPhoto, ReportSizes, fragments_report, report_pictures,
};
use crate::fault::Fault;
use crate::formats::read_bytes;
use crate::units::LengthUnit;

/// What the page says besides its numbers.
pub(super) struct Page<'a> {
    pub(super) flight: &'a str,
    pub(super) method: &'a str,
    /// Of the world, and of what is written.
    pub(super) units: [LengthUnit; 2],
    /// The law of the fines.
    pub(super) tail: Option<String>,
    pub(super) warnings: &'a [String],
}

impl Page<'_> {
    /// The page; `picture` is the file with a photo's outlines, which lies beside it.
    pub(super) fn html(
        &self,
        sizes: &Sizes<'_>,
        done: &[Done<'_>],
        picture: impl Fn(&Done<'_>) -> PathBuf,
    ) -> Result<String, Fault> {
        let [world, unit] = self.units;
        let rows = sizes.rows();
        let photos = done.iter().enumerate().map(|(place, of)| {
            let path = picture(of);
            let file = path
                .file_name()
                .unwrap_or_default()
                .to_string_lossy()
                .into_owned();
            let bytes = match place < report_pictures() {
                true => read_bytes(&path).map_err(|error| error.fault)?,
                false => Vec::new(),
            };
            let row = sizes.photos.iter().position(|row| row.of == Some(place));
            let taken = row.and_then(|row| sizes.photos.get(row));
            let own = row.and_then(|row| rows.get(row)).zip(taken);
            Ok(ReportPhoto {
                photo: of.photo,
                file,
                picture: bytes,
                spread: of.spread,
                sizes: own.map(|(sizes, row)| ReportSizes {
                    sizes: *sizes,
                    taken: &row.taken,
                }),
            })
        });
        let photos = photos.collect::<Result<Vec<_>, Fault>>()?;
        let all = sizes.all.as_ref().zip(rows.last());
        fragments_report(&FragmentsReport {
            flight: self.flight,
            method: self.method,
            unit,
            factor: world.in_units_of(unit),
            photos,
            all: all.map(|(row, sizes)| ReportSizes {
                sizes: *sizes,
                taken: &row.taken,
            }),
            tail: self.tail.as_deref(),
            warnings: self.warnings,
        })
    }
}
