//! `geo.txt`: where photos were taken, for OpenDroneMap, which reads less of what makers write than we do.
//!
//! Written from ODM's `opendm/geo.py` and `opendm/photo.py`: the coordinate system, then a line a photo: name, x, y,
//! z, then yaw, pitch, roll in degrees, then the horizontal and the vertical standard deviation in metres. The
//! angles are of a body that the camera looks down from, north-east-down, z-y-x: pitch 0 looks straight down, pitch
//! 90 to the front; yaw 0 has the image's top to the north. Deviations can only be given with angles, and a line
//! without them takes those away that ODM reads from the photo itself; so a place goes without only where nothing is
//! known of them, or nothing of the angles.

use std::fmt::Write as _;

use glam::{DMat3, DVec3};

use crate::formats::expected_deviation;
use crate::formats::photos::photo_metadata::PhotoMetadata;

/// The text, where a photo says where it was taken.
pub(crate) fn geo_txt<'a>(
    photos: impl IntoIterator<Item = (&'a str, &'a PhotoMetadata)>,
) -> Option<String> {
    let mut text = "EPSG:4326\n".to_owned();
    let empty = text.len();
    for (name, photo) in photos {
        let Some(measured) = photo.place else {
            continue;
        };
        let place = measured.place;
        // A hundred-millionth of a degree is a millimetre. Writing to a String cannot fail.
        let _ = write!(
            text,
            "{name} {:.10} {:.10}",
            place.longitude, place.latitude
        );
        if measured.height.is_some() {
            let _ = write!(text, " {:.4}", place.height);
            let orientation = photo
                .orientation
                .map(|angles| angles.pose(DVec3::ZERO).rotation);
            let deviation = expected_deviation(measured);
            if let (Some(rotation), Some(deviation)) = (orientation, deviation) {
                let [yaw, pitch, roll] = looking_down(rotation);
                let level = deviation.x.max(deviation.y);
                let _ = write!(
                    text,
                    " {yaw:.4} {pitch:.4} {roll:.4} {level:.4} {:.4}",
                    deviation.z
                );
            }
        }
        text.push('\n');
    }
    (text.len() > empty).then_some(text)
}

/// Yaw, pitch and roll in degrees as ODM counts them, of a rotation from camera axes (x right, y down, z forward) to
/// east, north and up.
fn looking_down(rotation: DMat3) -> [f64; 3] {
    // North, east, down from east, north, up.
    let turned = DMat3::from_cols(DVec3::Y, DVec3::X, DVec3::NEG_Z) * rotation;
    // The body's front is the image's top, its right the image's right, its down where the camera looks.
    let body = DMat3::from_cols(-turned.y_axis, turned.x_axis, turned.z_axis);
    let yaw = body.x_axis.y.atan2(body.x_axis.x);
    let pitch = (-body.x_axis.z).clamp(-1.0, 1.0).asin();
    let roll = body.y_axis.z.atan2(body.z_axis.z);
    // No "-0.0000".
    [yaw, pitch, roll].map(|angle| angle.to_degrees() + 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::photos::photo_metadata::{
        Angles, CameraOrientation, Fix, HeightReference, MeasuredPlace,
    };
    use crate::geodesy::Geographic;

    fn photo(place: Option<MeasuredPlace>, degrees: Option<[f64; 3]>) -> PhotoMetadata {
        PhotoMetadata {
            make: None,
            model: None,
            serial: None,
            lens: None,
            time: None,
            size: (4000, 3000),
            shown: 1,
            place,
            relative_altitude: None,
            laser_range: None,
            orientation: degrees.map(|degrees| CameraOrientation {
                degrees,
                angles: Angles::Camera,
            }),
            unknown_angles: Vec::new(),
            focal: Vec::new(),
            warnings: Vec::new(),
        }
    }

    fn place(height: Option<HeightReference>, deviation: Option<DVec3>) -> Option<MeasuredPlace> {
        Some(MeasuredPlace {
            place: Geographic {
                longitude: -91.994_209_611_1,
                latitude: 46.842_521_25,
                height: if height.is_some() { 198.609 } else { 0.0 },
            },
            height,
            fix: Some(Fix::Nothing),
            deviation,
        })
    }

    /// The angles as DJI's gimbals write them; what is expected follows from ODM's description of `geo.txt` (pitch 0
    /// looks down, 90 to the front; yaw from the north) by hand.
    #[test]
    fn angles_are_those_of_a_body_over_the_camera() {
        for (gimbal, expected) in [
            ([0.0, -90.0, 0.0], [0.0, 0.0, 0.0]),
            ([90.0, -90.0, 0.0], [90.0, 0.0, 0.0]),
            ([30.0, -60.0, 0.0], [30.0, 30.0, 0.0]),
            ([-120.0, -45.0, 0.0], [-120.0, 45.0, 0.0]),
            // Upside down on a gimbal that looks down is turned around, and still looks down.
            ([30.0, -90.0, 180.0], [-150.0, 0.0, 0.0]),
        ] {
            let photo = photo(None, Some(gimbal));
            let rotation = photo.orientation.unwrap().pose(DVec3::ZERO).rotation;
            let found = looking_down(rotation);
            for (found, expected) in found.iter().zip(expected) {
                assert!(
                    (found - expected).abs() < 1e-9,
                    "{gimbal:?}: {found} for {expected}"
                );
            }
        }
    }

    #[test]
    fn a_line_says_as_much_as_is_known() {
        let rtk = Some(DVec3::new(0.012, 0.015, 0.03));
        let up = Some(HeightReference::Ellipsoid);
        let photos = [
            ("a.jpg", photo(place(up, rtk), Some([30.0, -60.0, 0.0]))),
            ("b.jpg", photo(place(up, rtk), None)),
            ("c.jpg", photo(place(up, None), Some([30.0, -60.0, 0.0]))),
            ("d.jpg", photo(place(None, rtk), Some([30.0, -60.0, 0.0]))),
            ("e.jpg", photo(None, Some([30.0, -60.0, 0.0]))),
        ];
        let text = geo_txt(photos.iter().map(|(name, photo)| (*name, photo))).unwrap();
        assert_eq!(
            text,
            "EPSG:4326\n\
             a.jpg -91.9942096111 46.8425212500 198.6090 30.0000 30.0000 0.0000 0.0150 0.0300\n\
             b.jpg -91.9942096111 46.8425212500 198.6090\n\
             c.jpg -91.9942096111 46.8425212500 198.6090\n\
             d.jpg -91.9942096111 46.8425212500\n"
        );
        let nothing = photo(None, None);
        assert_eq!(geo_txt([("a.jpg", &nothing)]), None);
    }
}
