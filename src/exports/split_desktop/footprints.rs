//! Footprints as GeoJSON (RFC 7946) and KML.
//!
//! Positions are as `map_places` has them.

use serde_json::{Value, json};

use super::ExportRequest;
use super::kml;
use super::photo_footprint::PhotoFootprint;
use crate::fault::Fault;
use crate::map_places::{MapPlaces, closed_ring};
use crate::scale::{FootprintPoint, ScaleEstimate};
use crate::{PhotoLine, ScaleReport};

/// The footprints of a flight on their way out.
pub(super) struct Footprints<'a> {
    request: &'a ExportRequest<'a>,
    places: MapPlaces,
}

impl<'a> Footprints<'a> {
    pub(super) fn new(request: &'a ExportRequest<'a>) -> Self {
        let unit = request.review.flight().parts().unit;
        Self {
            request,
            places: MapPlaces::new(request.from.crs, unit),
        }
    }

    /// Whether longitudes and latitudes are known.
    pub(super) fn is_on_maps(&self) -> bool {
        self.places.are_on_maps()
    }

    /// Why a stated coordinate system is not used.
    pub(super) fn warning(&self) -> Option<String> {
        let fault = self.places.fault()?;
        let remedy = "the footprints stay in local coordinates, without KML";
        Some(Fault::new(fault.what.clone(), remedy).to_string())
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
        self.places.position(point.point()?)
    }

    /// A feature a photo.
    pub(super) fn geojson(&self, report: &ScaleReport<'_>) -> String {
        let features: Vec<Value> = self
            .of_photos(report)
            .map(|footprint| feature(&footprint, report))
            .collect();
        let value = json!({
            "type": "FeatureCollection",
            "name": report.flight(),
            "coordinates": self.places.words(),
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
            "reasons": photo.reasons_and_decision().join("; "),
            "corners_on_surface": photo.corners_on_surface().unwrap_or(0),
            "outline_complete": footprint.is_complete,
            "outline_points_off_surface": footprint.off_surface,
            "note": photo.notes().join("; "),
        },
    })
}
