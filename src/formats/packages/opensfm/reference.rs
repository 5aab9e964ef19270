//! Where on the Earth OpenSfM's frame stands, and what the photos' receivers said in it.
//!
//! Written from `opensfm/geo.py` (`TopocentricConverter`), `opensfm/dataset.py`
//! (`invent_reference_from_gps_and_gcp`) and `opensfm/exif.py`. The frame is east, north, up of WGS 84
//! at the reference, through ECEF, without any approximation. A photo's height is its EXIF altitude,
//! or 2 m for all where the option `use_altitude_tag` is off, as it is by default.

use fragscale_core::georeference::{Pair, fit};
use glam::DVec3;
use serde::Deserialize;

use crate::geodesy::{Geographic, ecef_from_geographic, enu_axes, geographic_from_ecef};
use crate::packages::reconstruction::MeasuredPosition;

/// The dilution of precision that stands for a photo without GPS.
const NO_GPS_DOP: f64 = 999_999.0;

/// The height that stands for one that was not used.
const NO_HEIGHT: f64 = 2.0;

/// `reference_lla`.
#[derive(Debug, Clone, Copy, Deserialize)]
pub(super) struct RawReference {
    latitude: Option<f64>,
    longitude: Option<f64>,
    altitude: Option<f64>,
}

/// Where a receiver put a photo.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Measured {
    pub(super) photo: String,
    /// East, north and up at the reference, whatever frame the poses are in.
    pub(super) position: DVec3,
}

impl Measured {
    /// The position of the photo `name`, if it has one.
    pub(super) fn of_shot(
        name: &str,
        gps_position: Option<[f64; 3]>,
        gps_dop: Option<f64>,
    ) -> Option<Self> {
        let position = DVec3::from(gps_position?);
        let measured = gps_dop.is_none_or(|dop| dop < NO_GPS_DOP);
        measured.then(|| Self {
            photo: name.to_owned(),
            position,
        })
    }
}

/// The standard error of all lengths in percent, from how the solved centres agree with the receivers'
/// positions, both in one frame: what `georeference` would find. `None` where it cannot be told, and where
/// they do not fit each other as a reconstruction does that its receivers placed.
pub(super) fn scale_error_of(pairs: &[(DVec3, DVec3)]) -> Option<f64> {
    let pairs = pairs.iter().map(|&(solved, measured)| Pair {
        source: solved,
        target: measured,
        accuracy: None,
    });
    let pairs: Vec<Pair> = pairs.collect();
    let found = fit(&pairs).ok()?;
    let off = (found.similarity.scale - 1.0).abs();
    // Ground control, or a known length, gave it another size.
    (off <= 4.0 * found.scale_error).then_some(100.0 * found.scale_error)
}

/// The origin of the frame; `None` where there was no GPS, or the numbers are no place.
pub(super) fn enu_origin(reference: RawReference) -> Option<Geographic> {
    let (latitude, longitude) = (reference.latitude?, reference.longitude?);
    let height = reference.altitude.unwrap_or(0.0);
    let no_gps = (latitude, longitude) == (0.0, 0.0);
    let on_earth = latitude.abs() <= 90.0 && longitude.abs() <= 360.0 && height.abs() < 1e6;
    (on_earth && !no_gps).then_some(Geographic {
        longitude,
        latitude,
        height,
    })
}

/// The positions on WGS 84, where the frame's origin is known.
pub(super) fn measured_positions(
    measured: &[Measured],
    origin: Option<Geographic>,
    warnings: &mut Vec<String>,
) -> Vec<MeasuredPosition> {
    let Some(origin) = origin else {
        return Vec::new();
    };
    let (center, axes) = (ecef_from_geographic(origin), enu_axes(origin));
    let mut found: Vec<MeasuredPosition> = measured
        .iter()
        .filter_map(|one| {
            Some(MeasuredPosition {
                photo: one.photo.clone(),
                position: geographic_from_ecef(center + axes * one.position)?,
            })
        })
        .collect();
    let all = found.len();
    found.retain(|one| (one.position.height - NO_HEIGHT).abs() >= 1e-3);
    if found.len() < all {
        warnings.push(format!(
            "{} of {all} measured positions are left out: their height is the 2 m that OpenSfM writes where it does not use the altitude",
            all - found.len()
        ));
    }
    found
}

#[cfg(test)]
mod tests {
    use crate::packages::opensfm::OpenSfm;

    fn file(shot: &str, reference: &str) -> OpenSfm {
        let json = format!(
            r#"[{{"cameras": {{"c": {{"focal": 1, "width": 4, "height": 4}}}},
            "shots": {{"a.jpg": {{"camera": "c", "rotation": [0, 0, 0], {shot}}}}}{reference}}}]"#
        );
        OpenSfm::read(json.as_bytes()).unwrap()
    }

    #[test]
    fn a_position_straight_above_the_reference() {
        let shot = r#""gps_position": [0, 0, 38.5], "gps_dop": 5"#;
        let found = file(
            shot,
            r#", "reference_lla": {"latitude": 52.5, "longitude": 13.25, "altitude": 100}"#,
        );
        let [measured] = &found.reconstruction.measured_positions[..] else {
            panic!("one position");
        };
        assert_eq!(measured.photo, "a.jpg");
        let place = measured.position;
        assert!((place.latitude - 52.5).abs() < 1e-12 && (place.longitude - 13.25).abs() < 1e-12);
        assert!((place.height - 138.5).abs() < 1e-8);
        assert_eq!(found.reconstruction.enu_origin.unwrap().height, 100.0);
        // The same from the file beside; what the reconstruction says itself stands.
        let mut later = file(shot, "");
        assert!(later.reconstruction.measured_positions.is_empty());
        let beside = br#"{"latitude": 52.5, "longitude": 13.25, "altitude": 100}"#;
        later.add_reference(beside).unwrap();
        assert_eq!(later.reconstruction, found.reconstruction);
        later
            .add_reference(br#"{"latitude": 1, "longitude": 1}"#)
            .unwrap();
        assert_eq!(later.reconstruction, found.reconstruction);
        assert!(later.add_reference(b"[]").is_err());
    }

    #[test]
    fn what_was_not_measured_is_no_position() {
        let at = r#", "reference_lla": {"latitude": 52.5, "longitude": 13.25, "altitude": 0}"#;
        let without = file(r#""gps_position": [0, 0, 0], "gps_dop": 999999.0"#, at);
        assert!(without.reconstruction.measured_positions.is_empty());
        let shot = r#""gps_position": [0, 0, 2], "gps_dop": 15"#;
        let flat = file(shot, at).reconstruction;
        assert!(flat.measured_positions.is_empty());
        assert!(
            flat.warnings[0].starts_with("1 of 1 measured positions are left out"),
            "{:?}",
            flat.warnings
        );
        for nowhere in [
            "",
            r#", "reference_lla": {"latitude": 0, "longitude": 0, "altitude": 0}"#,
            r#", "reference_lla": {"latitude": 1}"#,
            r#", "reference_lla": {"latitude": 91, "longitude": 0}"#,
            r#", "reference_lla": null"#,
        ] {
            let found = file(shot, nowhere).reconstruction;
            assert_eq!(
                (found.enu_origin, found.measured_positions.len()),
                (None, 0)
            );
        }
    }
}
