//! What a reconstruction found, to judge it by: how many points each photo shows and how well they agree,
//! how far cameras lie from where their receivers say, the lenses, and in how many photos the points of
//! the pile were found. One HTML file.

mod coverage;
mod tables;
#[cfg(test)]
mod tests;

use glam::{DVec2, DVec3};

use crate::camera::Camera;
use crate::html_page::{self, heading, notes, paragraph, table};
use crate::units::LengthUnit;

/// What goes into the report. Lengths are in the unit of the world, or of the model where it has none.
#[derive(Debug, Clone)]
pub struct ReconstructionReport<'a> {
    /// The folder of the photos.
    pub name: &'a str,
    /// What found it: name and version.
    pub engine: &'a str,
    /// What came out, a sentence each.
    pub facts: Vec<String>,
    /// What is to be said of it, a sentence each.
    pub warnings: Vec<String>,
    /// The unit of the world; `None` where the model has no place in it.
    pub unit: Option<LengthUnit>,
    /// In the model's order.
    pub cameras: Vec<SolvedCamera<'a>>,
    /// In the model's order.
    pub photos: Vec<SolvedPhoto<'a>>,
    /// Photos that are not in it, and why, as a clause.
    pub left_out: Vec<[&'a str; 2]>,
    /// The sparse cloud.
    pub points: Vec<SeenPoint>,
}

/// A lens as it was found.
#[derive(Debug, Clone)]
pub struct SolvedCamera<'a> {
    /// Its intrinsics.
    pub camera: &'a Camera,
    /// Standard deviation of its focal length, percent, where that was found and is known.
    pub focal_percent: Option<f64>,
    /// The focal length that its photos state, pixels.
    pub stated_focal: Option<f64>,
}

/// A photo of the model.
#[derive(Debug, Clone)]
pub struct SolvedPhoto<'a> {
    /// The file's name.
    pub name: &'a str,
    /// The place of its camera in the report.
    pub camera: usize,
    /// Where it was taken, x and y.
    pub center: DVec2,
    /// How many points of the cloud it shows.
    pub points: usize,
    /// How far they lie from where it shows them, pixels (root mean square).
    pub reprojection_px: Option<f64>,
    /// How far it lies from where its receiver says, to the east, north and up; `None` where it does not say.
    pub off_receiver: Option<OffReceiver>,
    /// Standard deviations of its place, to the east, north and up, and of its angles, degrees.
    pub deviation: Option<(DVec3, f64)>,
}

/// A photo's place against its receiver's.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OffReceiver {
    /// The model's less the receiver's.
    pub off: DVec3,
    /// Whether it counted; else the receiver's is an outlier.
    pub used: bool,
}

/// A point of the cloud.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SeenPoint {
    /// In the world.
    pub point: DVec3,
    /// In how many photos it was found.
    pub photos: usize,
}

/// The report as HTML.
pub fn reconstruction_report(report: &ReconstructionReport<'_>) -> String {
    let title = format!("Reconstruction of {}", report.name);
    let unit = match report.unit {
        Some(unit) => unit.to_string(),
        None => "units of the model".to_owned(),
    };
    let facts = report.facts.iter().map(|fact| paragraph(fact));
    let found_by = format!("Found by {}. Lengths are in {unit}.", report.engine);
    let mut body = vec![paragraph(&found_by), facts.collect()];
    body.push(notes(&report.warnings));
    if let Some(map) = coverage::map(report) {
        let north = report.unit.map_or("", |_| " North is up.");
        body.push(heading(2, "In how many photos the points were found"));
        body.push(paragraph(&format!(
            "Mean number of photos in which the points of a cell were found again; more may show them. Triangles are \
             cameras, numbers at the grid {unit}.{north} Where it is below 3, depths rest mostly on two views, and gross \
             errors are not noticed.",
        )));
        body.push(html_page::figure(&map));
    }
    body.push(heading(2, "Cameras"));
    body.push(tables::cameras(report));
    body.push(heading(2, "Photos"));
    body.push(tables::residuals_in_words(report));
    body.push(tables::photos(report));
    if !report.left_out.is_empty() {
        body.push(heading(2, "Left out"));
        let rows = (report.left_out.iter()).map(|row| row.map(Into::into).into());
        let head = ["Photo", "Why"].map(str::to_owned);
        body.push(table(&head, rows.collect()));
    }
    html_page::page(&title, &title, &body.concat())
}
