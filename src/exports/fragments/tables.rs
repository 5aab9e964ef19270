//! The tables of photos whose fragments were measured, and the page with all of it.

use super::OUTLINED_ENDINGS;
use super::report::{FragmentsReport, ReportPhoto, ReportSizes, fragments_report, report_pictures};
use super::sizes::{FragmentSizes, MeasuredPhoto};
use super::table::{PhotoOfFragments, curves_csv, fragments_csv, sizes_csv};
use crate::fault::Fault;
use crate::units::LengthUnit;

/// What they are called, in the order of [`fragment_tables`].
pub const FRAGMENT_TABLES: [&str; 4] = [
    "fragments.csv",
    "distribution.csv",
    "sizes.csv",
    "report.html",
];

/// What goes into them besides the numbers.
#[derive(Debug)]
pub struct FragmentTables<'a> {
    /// The flight's name.
    pub flight: &'a str,
    /// Of the world, and of what is written.
    pub units: [LengthUnit; 2],
    /// The law of the fines, in words, where one is taken.
    pub tail: Option<&'a str>,
    /// What is to be said of it, a sentence each.
    pub warnings: &'a [String],
}

/// Their bytes. `picture` reads the file of outlines over a photo, by its name.
///
/// # Errors
/// Where memory runs out, or a picture cannot be read.
pub fn fragment_tables(
    of: &FragmentTables<'_>,
    measured: &[MeasuredPhoto<'_>],
    sizes: &FragmentSizes<'_>,
    picture: impl Fn(&str) -> Result<Vec<u8>, Fault>,
) -> Result<[Vec<u8>; 4], Fault> {
    let [world, unit] = of.units;
    let rows: Vec<PhotoOfFragments<'_>> = measured
        .iter()
        .map(|of| PhotoOfFragments {
            photo: of.photo,
            fragments: &of.fragments.fragments,
        })
        .collect();
    let methods = methods_of(measured);
    Ok([
        csv(fragments_csv(&rows, world, unit))?.into_bytes(),
        distribution_csv(&methods, sizes, of.units)?.into_bytes(),
        csv(sizes_csv(&sizes.rows(), world, unit))?.into_bytes(),
        page(of, &methods, measured, sizes, picture)?.into_bytes(),
    ])
}

/// The second of them: the photos' curves, outlined by `methods`. Units of the world, and of what is written.
///
/// # Errors
/// Where memory runs out.
pub fn distribution_csv(
    methods: &str,
    sizes: &FragmentSizes<'_>,
    [world, unit]: [LengthUnit; 2],
) -> Result<String, Fault> {
    let method = format!("fragscale ({methods})");
    csv(curves_csv(&method, &sizes.curves(), world, unit))
}

fn csv(text: Result<String, csv::Error>) -> Result<String, Fault> {
    text.map_err(|error| Fault::new(error.to_string(), "report this"))
}

/// What outlined them, in a word or two.
fn methods_of(measured: &[MeasuredPhoto<'_>]) -> String {
    let mut methods: Vec<&str> = measured.iter().map(|of| of.outlined.method()).collect();
    // Saved ones first.
    methods.sort_by_key(|method| (*method != "saved", *method));
    methods.dedup();
    methods.join(" and ")
}

fn page(
    of: &FragmentTables<'_>,
    method: &str,
    measured: &[MeasuredPhoto<'_>],
    sizes: &FragmentSizes<'_>,
    picture: impl Fn(&str) -> Result<Vec<u8>, Fault>,
) -> Result<String, Fault> {
    let [world, unit] = of.units;
    let rows = sizes.rows();
    let photos = measured.iter().enumerate().map(|(place, of)| {
        let file = format!("{}{}", of.stem, OUTLINED_ENDINGS[1]);
        let bytes = match place < report_pictures() {
            true => picture(&file)?,
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
        flight: of.flight,
        method,
        unit,
        factor: world.in_units_of(unit),
        photos,
        all: all.map(|(row, sizes)| ReportSizes {
            sizes: *sizes,
            taken: &row.taken,
        }),
        tail: of.tail,
        warnings: of.warnings,
    })
}
