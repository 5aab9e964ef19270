//! How each maker writes, in XMP, where the camera was and which way it looked.
//!
//! | maker | fields | convention |
//! |---|---|---|
//! | DJI | drone-dji:GimbalYawDegree, GimbalPitchDegree, GimbalRollDegree | aerospace, north-east-down, z-y-x: pitch -90 looks straight down (DJI, Mavic 3M User Manual, page 89). FlightYawDegree etc. are the aircraft's. |
//! | Autel, new firmware | the same names under the prefix "drone" | as DJI |
//! | Skydio | drone-skydio:CameraOrientationNED with Yaw, Pitch, Roll | as DJI (support.skydio.com, "camera and metadata overview") |
//! | Parrot Anafi | drone-parrot:CameraYawDegree, CameraPitchDegree, CameraRollDegree | as DJI |
//! | Parrot, Autel's old firmware, Sequoia, others | Camera:Yaw, Pitch, Roll in Pix4D's namespace | Pix4D's: of a body that the camera looks DOWN from, its top to the front: pitch 0 is straight down, 90 forward (support.pix4d.com, "Yaw, Pitch, Roll and Omega, Phi, Kappa angles") |
//! | senseFly | Camera:Yaw, Pitch, Roll in its own namespace or in Pix4D's | Pix4D's with the roll's sign turned (OpenDroneMap's `opendm/photo.py`, OpenSfM's `exif.py`) |
//!
//! Parrot writes two conventions into one file; the Anafi's own fields are read first. Autel's and
//! DJI's longitude is spelt "GpsLongtitude" in many firmwares.
//!
//! Heights: DJI's AbsoluteAltitude is ellipsoidal with RTK (AltitudeType "RtkAlt", or a RtkFlag of 16
//! or more); else it comes from the barometer, set at take-off by GPS, and is off by tens of metres.
//! Skydio's is above the ellipsoid ("X10 RTK/PPK metadata overview"). RelativeAltitude counts from
//! the take-off. Deviations: RtkStdLon, RtkStdLat, RtkStdHgt; Camera:GPSXYAccuracy, GPSZAccuracy;
//! Skydio's GpsHorizontalAccuracy, GpsVerticalAccuracy; all metres.

use glam::DVec3;

use super::xmp::{Vocabulary, Xmp};
use super::{Angles, CameraOrientation, Fix, HeightReference, MeasuredPlace};
use crate::geodesy::Geographic;

/// The vocabularies with DJI's names.
const GIMBALS: [Vocabulary; 2] = [Vocabulary::Dji, Vocabulary::Autel];

/// Which way the camera looked, where XMP says so.
pub(super) fn orientation(xmp: &Xmp, make: Option<&str>) -> Option<CameraOrientation> {
    let angles = |vocabulary, names: [&str; 3]| {
        let [yaw, pitch, roll] = names.map(|name| xmp.number(vocabulary, name));
        Some([yaw?, pitch?, roll.unwrap_or(0.0)])
    };
    let aerospace = |vocabulary, names| {
        Some(CameraOrientation {
            degrees: angles(vocabulary, names)?,
            angles: Angles::Camera,
        })
    };
    let gimbal = ["GimbalYawDegree", "GimbalPitchDegree", "GimbalRollDegree"];
    let skydio = ["Yaw", "Pitch", "Roll"].map(|name| format!("CameraOrientationNED/{name}"));
    let skydio = skydio.each_ref().map(String::as_str);
    let parrot = ["CameraYawDegree", "CameraPitchDegree", "CameraRollDegree"];
    GIMBALS
        .into_iter()
        .find_map(|vocabulary| aerospace(vocabulary, gimbal))
        .or_else(|| aerospace(Vocabulary::Skydio, skydio))
        .or_else(|| aerospace(Vocabulary::Parrot, parrot))
        .or_else(|| {
            let is_sensefly = make.is_some_and(|make| make.eq_ignore_ascii_case("sensefly"));
            let of = |vocabulary| {
                let [yaw, pitch, roll] = angles(vocabulary, ["Yaw", "Pitch", "Roll"])?;
                let turned = is_sensefly || vocabulary == Vocabulary::SenseFlyCamera;
                Some(CameraOrientation {
                    degrees: [yaw, pitch, if turned { -roll } else { roll }],
                    angles: Angles::BodyLookingDown,
                })
            };
            of(Vocabulary::SenseFlyCamera).or_else(|| of(Vocabulary::Pix4dCamera))
        })
}

/// The height above the take-off in metres.
pub(super) fn relative_altitude(xmp: &Xmp) -> Option<f64> {
    [Vocabulary::Dji, Vocabulary::Autel, Vocabulary::Skydio]
        .into_iter()
        .find_map(|vocabulary| xmp.number(vocabulary, "RelativeAltitude"))
}

/// The measured distance to what the middle of the photo shows, in metres.
pub(super) fn laser_range(xmp: &Xmp) -> Option<f64> {
    let status = xmp.text(Vocabulary::Dji, "LRFStatus");
    if status.is_some_and(|status| !status.eq_ignore_ascii_case("normal")) {
        return None;
    }
    let range = xmp.number(Vocabulary::Dji, "LRFTargetDistance")?;
    (range > 0.0).then_some(range)
}

/// The camera's serial number.
pub(super) fn serial(xmp: &Xmp) -> Option<String> {
    let of = |name| xmp.text(Vocabulary::Dji, name).map(str::to_owned);
    of("CameraSerialNumber").or_else(|| of("DroneSerialNumber"))
}

/// Whether the gimbal hangs the wrong way round, or the camera in it.
pub(super) fn is_reversed(xmp: &Xmp) -> bool {
    ["CamReverse", "GimbalReverse"]
        .into_iter()
        .any(|name| xmp.number(Vocabulary::Dji, name).is_some_and(|n| n != 0.0))
}

/// Longitude and latitude of XMP, and how fine they are written, in degrees.
pub(super) fn degrees(xmp: &Xmp) -> Option<(Geographic, f64)> {
    let names = [
        ("GpsLatitude", "GpsLongitude"),
        ("GpsLatitude", "GpsLongtitude"),
        ("Latitude", "Longitude"),
    ];
    let vocabularies = [Vocabulary::Dji, Vocabulary::Autel, Vocabulary::Skydio];
    for vocabulary in vocabularies {
        for (latitude, longitude) in names {
            let found = xmp
                .number(vocabulary, latitude)
                .zip(xmp.number(vocabulary, longitude));
            let Some((north, east)) = found else {
                continue;
            };
            let text = xmp.text(vocabulary, latitude).unwrap_or_default();
            let decimals = text.split_once('.').map_or(0, |(_, d)| d.len());
            let place = Geographic {
                longitude: east,
                latitude: north,
                height: 0.0,
            };
            let step = 0.1_f64.powi(i32::try_from(decimals).unwrap_or(i32::MAX));
            return Some((place, step));
        }
    }
    None
}

/// Fills in what XMP says about a place: its height, how it was fixed, how far it may be off.
pub(super) fn complete(place: &mut MeasuredPlace, xmp: &Xmp, make: Option<&str>) {
    let dji = |name| xmp.number(Vocabulary::Dji, name);
    let flag = dji("RtkFlag").filter(|&flag| (0.0..=1000.0).contains(&flag));
    place.fix = flag.map(|flag| Fix::of_dji(flag as u32));
    let has_rtk = flag.is_some_and(|flag| flag >= 16.0)
        || xmp
            .text(Vocabulary::Dji, "AltitudeType")
            .is_some_and(|kind| kind.eq_ignore_ascii_case("rtkalt"));
    let absolute = |vocabulary| xmp.number(vocabulary, "AbsoluteAltitude");
    if let Some(height) = absolute(Vocabulary::Skydio) {
        place.place.height = height;
        place.height = Some(HeightReference::Ellipsoid);
    } else if let Some(height) = GIMBALS.into_iter().find_map(absolute) {
        place.place.height = height;
        place.height = Some(if has_rtk {
            HeightReference::Ellipsoid
        } else {
            HeightReference::Barometer
        });
    } else if place.height == Some(HeightReference::SeaLevel)
        && make.is_some_and(|make| make.eq_ignore_ascii_case("dji"))
        && !has_rtk
    {
        place.height = Some(HeightReference::Barometer);
    }
    let deviation = |vocabulary, names: [&str; 3]| {
        let [east, north, up] = names.map(|name| xmp.number(vocabulary, name));
        let deviation = DVec3::new(east?, north?, up?);
        (deviation.min_element() > 0.0).then_some(deviation)
    };
    let both = |h, v| [h, h, v];
    place.deviation = deviation(Vocabulary::Dji, ["RtkStdLon", "RtkStdLat", "RtkStdHgt"])
        .or_else(|| {
            let names = both("GPSXYAccuracy", "GPSZAccuracy");
            deviation(Vocabulary::Pix4dCamera, names)
        })
        .or_else(|| {
            let names = both("GpsHorizontalAccuracy", "GpsVerticalAccuracy");
            deviation(Vocabulary::Skydio, names)
        });
}
