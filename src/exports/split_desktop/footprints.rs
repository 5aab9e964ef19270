//! Footprints as GeoJSON (RFC 7946) and KML.
//!
//! RFC 7946 knows longitude and latitude on WGS 84 only. Where the coordinate system of the flight is
//! known and can be projected back, that is what the file holds, without heights. Else the positions
//! are x, y, z of the flight's world, and the foreign member "coordinates" says so: "local, in m".

use serde_json::{Value, json};

use super::ExportRequest;
use super::kml;
use crate::fault::Fault;
use crate::geodesy::{Crs, CrsKind};
use crate::scale::{FootprintPoint, ScaleEstimate};
use crate::units::LengthUnit;
use crate::{PhotoLine, ScaleReport};

/// The footprints of a flight on their way out.
pub(super) struct Footprints<'a> {
    request: &'a ExportRequest<'a>,
    /// The flight's coordinate system, where it leads to longitude and latitude.
    crs: Option<Crs>,
    warning: Option<String>,
}

/// One photo's footprint.
pub(super) struct PhotoFootprint<'a> {
    pub line: PhotoLine<'a>,
    /// One ring, closed, counterclockwise seen from above; empty where there is none. Longitude and
    /// latitude, or x, y, z.
    pub ring: Vec<Vec<f64>>,
    /// Whether every point of the outline has a place.
    pub is_complete: bool,
    /// How many points of the outline are not on the surface.
    pub off_surface: usize,
}

impl<'a> Footprints<'a> {
    pub(super) fn new(request: &'a ExportRequest<'a>) -> Self {
        let unit = request.review.flight().parts().unit;
        let understood = request.from.crs.map(|crs| map_system(crs, unit));
        let (crs, warning) = match understood {
            None => (None, None),
            Some(Ok(system)) => (Some(system), None),
            Some(Err(fault)) => (None, Some(fault.to_string())),
        };
        Self {
            request,
            crs,
            warning,
        }
    }

    /// Whether longitudes and latitudes are known.
    pub(super) fn is_on_maps(&self) -> bool {
        self.crs.is_some()
    }

    /// Why a stated coordinate system is not used.
    pub(super) fn warning(&self) -> Option<&str> {
        self.warning.as_deref()
    }

    fn of_photos<'b>(
        &'b self,
        report: &'b ScaleReport<'_>,
    ) -> impl Iterator<Item = PhotoFootprint<'b>> {
        report.lines().map(|line| {
            let view = line.photo.view;
            let outline = view.map_or(&[][..], |view| &view.footprint.outline);
            let ring: Vec<Vec<f64>> = outline
                .iter()
                .filter_map(|point| self.position(point))
                .collect();
            let off = outline
                .iter()
                .filter(|point| !point.outcome.is_on_surface());
            PhotoFootprint {
                line,
                is_complete: !outline.is_empty() && ring.len() == outline.len(),
                ring: closed_ring(ring),
                off_surface: off.count(),
            }
        })
    }

    fn position(&self, point: &FootprintPoint) -> Option<Vec<f64>> {
        let point = point.point()?;
        match &self.crs {
            Some(crs) => {
                let place = crs.to_geographic(point)?;
                Some(vec![place.longitude, place.latitude])
            }
            None => Some(point.to_array().to_vec()),
        }
    }

    /// A feature a photo.
    pub(super) fn geojson(&self, report: &ScaleReport<'_>) -> String {
        let features: Vec<Value> = self
            .of_photos(report)
            .map(|footprint| feature(&footprint, report))
            .collect();
        let coordinates = match self.is_on_maps() {
            true => "WGS 84 longitude, latitude".to_owned(),
            false => format!("local, in {}", report.world_unit()),
        };
        let value = json!({
            "type": "FeatureCollection",
            "name": report.flight(),
            "coordinates": coordinates,
            "crs_of_flight": self.request.from.crs,
            "features": features,
        });
        format!("{value}\n")
    }

    /// The same for map programs; `None` without longitude and latitude.
    pub(super) fn kml(&self, report: &ScaleReport<'_>) -> Option<String> {
        self.is_on_maps()
            .then(|| kml::document(report, self.of_photos(report)))
    }
}

/// The coordinate system of a flight: a projected one whose unit is the flight's.
fn map_system(crs: &str, unit: LengthUnit) -> Result<Crs, Fault> {
    let refuse = |what: String| {
        Fault::new(
            what,
            "the footprints stay in local coordinates, without KML",
        )
    };
    let crs = Crs::understand(crs).map_err(|fault| refuse(fault.what))?;
    let name = crs.name();
    if crs.kind() != CrsKind::Projected {
        return Err(refuse(format!("{name} is no projected system")));
    }
    // A US survey foot and a foot differ by 2 parts in a million: a metre on a state's northing.
    if (crs.unit_metres() / unit.metres() - 1.0).abs() > 1e-7 {
        let what = format!("{name} is not in {unit}, the unit of the flight");
        return Err(refuse(what));
    }
    Ok(crs)
}

fn feature(footprint: &PhotoFootprint<'_>, report: &ScaleReport<'_>) -> Value {
    let PhotoLine { photo, .. } = footprint.line;
    let (scale, fitted) = (footprint.line.scale(), footprint.line.fitted());
    let [top, bottom] = footprint.line.estimates(photo.pair);
    let ends = |estimate: Option<ScaleEstimate>| {
        let interval = estimate?.interval?;
        Some([interval.low, interval.high])
    };
    let geometry = match footprint.ring.is_empty() {
        true => Value::Null,
        false => json!({ "type": "Polygon", "coordinates": [footprint.ring] }),
    };
    json!({
        "type": "Feature",
        "geometry": geometry,
        "properties": {
            "photo": photo.name(),
            "unit": format!("px/{}", report.unit()),
            "top": scale.top,
            "right": scale.right,
            "bottom": scale.bottom,
            "left": scale.left,
            "fitted_top": fitted.map(|fitted| fitted.top),
            "fitted_bottom": fitted.map(|fitted| fitted.bottom),
            "use": photo.pair.as_str(),
            "off_line_rms_percent": fitted.map(|fitted| fitted.rms_percent),
            "off_line_worst_percent": fitted.map(|fitted| fitted.worst_percent),
            "covered": photo.field.map(|field| field.covered),
            "used_top_95": ends(top),
            "used_bottom_95": ends(bottom),
            "verdict": photo.verdict.as_str(),
            "corners_on_surface": photo.corners_on_surface().unwrap_or(0),
            "outline_complete": footprint.is_complete,
            "outline_points_off_surface": footprint.off_surface,
            "note": photo.notes().join("; "),
        },
    })
}

/// A linear ring of RFC 7946: the first position again at the end, counterclockwise; empty with fewer
/// than three positions.
fn closed_ring(mut ring: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    let [first, _, _, ..] = &ring[..] else {
        return Vec::new();
    };
    let first = first.clone();
    // The shoelace formula, from the first position, which loses no digit to large coordinates.
    let twice_area: f64 = ring
        .windows(2)
        .map(|pair| {
            let [ax, ay] = [pair[0][0] - first[0], pair[0][1] - first[1]];
            let [bx, by] = [pair[1][0] - first[0], pair[1][1] - first[1]];
            ax * by - ay * bx
        })
        .sum();
    ring.push(first);
    if twice_area < 0.0 {
        ring.reverse();
    }
    ring
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_leads_to_no_map_says_why() {
        let why = |crs, unit| map_system(crs, unit).unwrap_err().what;
        assert!(why("EPSG:4326", LengthUnit::Metre).contains("no projected system"));
        assert!(why("ECEF", LengthUnit::Metre).contains("no projected system"));
        assert!(why("EPSG:32633", LengthUnit::Foot).contains("not in ft"));
        assert!(why("EPSG:2285", LengthUnit::Foot).contains("not in ft"));
        assert!(why("EPSG:65000", LengthUnit::Metre).contains("65000"));
        assert!(map_system("EPSG:2285", LengthUnit::UsSurveyFoot).is_ok());
        assert!(map_system("EPSG:32633", LengthUnit::Metre).is_ok());
    }

    #[test]
    fn rings_are_closed_and_counterclockwise() {
        let [a, b, c] = [vec![0.0, 0.0], vec![0.0, 1.0], vec![1.0, 0.0]];
        let clockwise = vec![a.clone(), b.clone(), c.clone()];
        let expected = vec![a.clone(), c.clone(), b.clone(), a.clone()];
        assert_eq!(closed_ring(clockwise), expected);
        assert_eq!(closed_ring(vec![a.clone(), c, b]), expected);
        assert!(closed_ring(vec![a.clone(), a]).is_empty());
    }
}
