//! Area and volume, going out.

use serde_json::json;

use super::{MeasuredUnit, bridged, coordinate, csv_of, level, percent, rows_of_text};
use crate::numbers::significant_digits;
use crate::survey::{BaseFound, Volume};

/// What lies inside a polygon, and of what.
#[derive(Debug, Clone, Copy)]
pub struct VolumeReport<'a> {
    /// The flight's name.
    pub flight: &'a str,
    /// Of its lengths.
    pub unit: MeasuredUnit,
    /// What was found.
    pub volume: &'a Volume,
    /// How the other surface is called, where it is over one.
    pub base: Option<&'a str>,
    /// What that one's heights count from and the surface's, where it is not the same.
    pub other_heights: Option<&'a [String; 2]>,
}

impl VolumeReport<'_> {
    /// What the volumes are over, in words.
    pub fn base_in_words(&self) -> String {
        let unit = self.unit.length();
        match self.volume.base {
            // To the digits that give the same volume when they are typed.
            BaseFound::Height(height) => format!("the level at {} {unit}", level(height)),
            BaseFound::Rim(plane) => format!(
                "the plane through the polygon's rim: {} {unit} at its middle, {:.1}° steep, the rim {} {unit} \
                 off it (RMS)",
                coordinate(plane.through.z),
                plane.slope(),
                significant_digits(plane.residual, 2)
            ),
            BaseFound::Surface => {
                let base = self.base.unwrap_or("the other surface");
                match self.other_heights {
                    None => base.to_owned(),
                    Some([own, theirs]) => {
                        format!(
                            "{base}, heights above {own}; those of the surface are above {theirs}"
                        )
                    }
                }
            }
        }
    }
}

/// The numbers as text.
pub fn volume_table(report: &VolumeReport<'_>) -> String {
    let VolumeReport { unit, volume, .. } = report;
    let [cubic, square, length] = [unit.volume(), unit.area(), unit.length()];
    let number = |number: f64| significant_digits(number, 6);
    let mut rows = vec![
        ("over", report.base_in_words()),
        ("fill (above)", format!("{} {cubic}", number(volume.fill))),
        ("cut (below)", format!("{} {cubic}", number(volume.cut))),
        ("fill less cut", format!("{} {cubic}", number(volume.net()))),
        (
            "plan area",
            format!("{} {square}", number(volume.plan_area)),
        ),
        (
            "surface area",
            format!("{} {square}", number(volume.surface_area)),
        ),
        ("covered by the surface", percent(volume.covered)),
    ];
    if let Some([lowest, highest]) = volume.heights {
        let [lowest, highest] = [lowest, highest].map(coordinate);
        rows.push(("heights", format!("{lowest} to {highest} {length}")));
    }
    if volume.overhang > 0.0 {
        rows.push(("overhanging", percent(volume.overhang)));
    }
    format!(
        "{}: inside the polygon\n\n{}",
        report.flight,
        rows_of_text(&rows)
    )
}

/// What is to be said where the surface does not cover the polygon, and where it has bodies.
pub fn volume_warnings(volume: &Volume) -> Vec<String> {
    let missing = 1.0 - volume.covered - volume.bodies;
    let both = match volume.base {
        BaseFound::Surface => "one of the two surfaces",
        _ => "the surface",
    };
    // What is rounding is not missing; the share of bodies is counted in pixels.
    let least = if volume.bodies > 0.0 { 1e-2 } else { 1e-9 };
    let hole = (missing > least).then(|| {
        format!(
            "{} of the polygon is a hole of {both} or beside it; nothing is counted there",
            percent(missing)
        )
    });
    let bodies = (volume.bodies > 0.0).then(|| {
        format!(
            "in {:.0} % of the polygon the mesh has as many faces that look down as up, closed bodies or sheets with two \
             sides: what is between these counts there, not what is between them and the base",
            100.0 * volume.bodies
        )
    });
    let doubtful = (volume.doubtful > 0.0).then(|| {
        format!(
            "in {:.1} % of the polygon faces of the mesh lie over others that look up, too, or look down from the top: there \
             the volume counts twice or with the wrong sign",
            100.0 * volume.doubtful
        )
    });
    let bridged = bridged(
        "the polygon",
        volume.bridged,
        " (of a grid, longer than its cells)",
    );
    [hole, bridged, bodies, doubtful]
        .into_iter()
        .flatten()
        .collect()
}

/// One line. Numbers read back to the same f64.
///
/// # Errors
/// Where memory runs out.
pub fn volume_csv(report: &VolumeReport<'_>) -> Result<String, csv::Error> {
    let (volume, unit) = (report.volume, report.unit.in_names());
    let [lowest, highest] = match volume.heights {
        Some(heights) => heights.map(|height| height.to_string()),
        None => [String::new(), String::new()],
    };
    let fields = [
        ("flight".to_owned(), report.flight.to_owned()),
        ("base".to_owned(), report.base_in_words()),
        (format!("fill_{unit}3"), volume.fill.to_string()),
        (format!("cut_{unit}3"), volume.cut.to_string()),
        (format!("net_{unit}3"), volume.net().to_string()),
        (format!("plan_area_{unit}2"), volume.plan_area.to_string()),
        (
            format!("surface_area_{unit}2"),
            volume.surface_area.to_string(),
        ),
        ("covered".to_owned(), volume.covered.to_string()),
        ("overhang".to_owned(), volume.overhang.to_string()),
        (format!("lowest_{unit}"), lowest),
        (format!("highest_{unit}"), highest),
    ];
    let (header, line) = fields.into_iter().unzip();
    csv_of([header, line])
}

/// All of it as JSON.
///
/// # Errors
/// Where memory runs out.
pub fn volume_json(report: &VolumeReport<'_>) -> Result<String, serde_json::Error> {
    let volume = report.volume;
    let base = match volume.base {
        BaseFound::Height(height) => json!({"kind": "height", "height": height}),
        BaseFound::Rim(plane) => json!({
            "kind": "rim",
            "through": plane.through.to_array(),
            "rise": plane.rise.to_array(),
            "slope_degrees": plane.slope(),
            "residual": plane.residual,
        }),
        BaseFound::Surface => json!({
            "kind": "surface",
            "file": report.base,
            "other_heights": report.other_heights
                .map(|[own, theirs]| json!({"base": own, "surface": theirs})),
        }),
    };
    let value = json!({
        "flight": report.flight,
        "unit": report.unit.symbol,
        "base": base,
        "fill": volume.fill,
        "cut": volume.cut,
        "net": volume.net(),
        "plan_area": volume.plan_area,
        "surface_area": volume.surface_area,
        "covered": volume.covered,
        "overhang": volume.overhang,
        "lowest": volume.heights.map(|heights| heights[0]),
        "highest": volume.heights.map(|heights| heights[1]),
    });
    Ok(serde_json::to_string_pretty(&value)? + "\n")
}
