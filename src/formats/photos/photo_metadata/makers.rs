//! How each maker writes, in XMP, where the camera was and which way it looked. The namespace decides
//! by its URI (`xmp.rs` lists the forms of each), never the prefix:
//!
//! | namespace | fields | convention | source |
//! |---|---|---|---|
//! | `http://www.dji.com/drone-dji/1.0/` (DJI; Autel's newer firmware under the prefix "drone") | GimbalYawDegree, GimbalPitchDegree, GimbalRollDegree | the camera's: aerospace, north-east-down, z-y-x, pitch -90 looks straight down. FlightYawDegree etc. are the aircraft's and are not read. | DJI, "Mavic 3M User Manual", "Data Storage", page 89: "NED coordinate system, the rotation order is ZYX"; "Matrice 4 Series User Manual", page 90 |
//! | `https://www.skydio.com/drone-skydio/1.0/` | the structure CameraOrientationNED: Yaw, Pitch, Roll. VehicleOrientationNED is the aircraft's. | as DJI | Skydio, "Skydio 2/2+ and Skydio X2 camera and metadata overview", photo extrinsics |
//! | `http://www.parrot.com/drone-parrot/1.0/` (Anafi) | CameraYawDegree, CameraPitchDegree, CameraRollDegree. DroneYawDegree etc. are the aircraft's. | as DJI | Parrot, "Embedded Photo Metadata", "Parrot Drone schema": "in NED coordinate system", e.g. pitch -51.99 |
//! | `http://pix4d.com/camera/1.0/` (Anafi, Sequoia, Autel's old firmware, FLIR and others) | Yaw, Pitch, Roll | of a body that the camera looks DOWN from, its top to the front, north-east-down, z-y-x: pitch 0 looks straight down, 90 forward | Pix4D, "Specifications of XMP Camera Tags", "Position and orientation", and "Yaw, Pitch, Roll and Omega, Phi, Kappa angles", "Yaw, Pitch, Roll definition"; Parrot's page, "Camera schema": the same photo as above has pitch 38.01 |
//! | `http://ns.sensefly.com/Camera/1.0/` (senseFly) | Yaw, Pitch, Roll | Pix4D's with the roll's sign turned; so too where a senseFly writes Pix4D's namespace | OpenDroneMap, `opendm/photo.py`, "Normalize YPR conventions" |
//! | `Camera/` | Yaw, Pitch, Roll | a senseFly's (EXIF Make "senseFly"): as in its own namespace. Of all others not known: Parrot's Bebop 2 and Disco write the AIRCRAFT's angles there. | photos of both: `sensefly.jpg` of TinyEXIF's samples (pitch 2, looks down), `Bebop_2.jpg` there (pitch -2, looks to the horizon) and OpenAthena's `parrot-1.jpg` of a Disco (pitch 2, roll -2, looks some 30 degrees below the horizon) |
//! | every other | names that end in yaw or heading, pitch and roll | not known: no orientation, and a warning with the URI. So are MicaSense's DLS (the sun sensor's), Sentera's and Yuneec's own, for which no definition was found. | |
//!
//! A file may hold several; the first of the table counts, and it is said where another differs by
//! more than [`SAME_ORIENTATION`]. DJI's and Autel's longitude is spelt "GpsLongtitude" in many
//! firmwares.
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

/// How far, in degrees, two orientations in one file may differ: their rounding, and what a gimbal
/// moves between two readings.
const SAME_ORIENTATION: f64 = 3.0;

/// Which way the camera looked, where XMP says so in a namespace that is known. What contradicts it in
/// the same file goes to `warnings`.
pub(super) fn orientation(
    xmp: &Xmp,
    make: Option<&str>,
    warnings: &mut Vec<String>,
) -> Option<CameraOrientation> {
    let mut found = stated_orientations(xmp, make).into_iter();
    let (first, vocabulary) = found.next()?;
    for (other, of) in found {
        let degrees = apart(&first, &other);
        if degrees > SAME_ORIENTATION {
            warnings.push(format!(
                "its camera's angles in {} and in {} contradict each other by {degrees:.0} degrees; the first are taken",
                vocabulary.uri(),
                of.uri()
            ));
        }
    }
    Some(first)
}

/// Every orientation that a known namespace states, the most trustworthy first.
fn stated_orientations(xmp: &Xmp, make: Option<&str>) -> Vec<(CameraOrientation, Vocabulary)> {
    let of = |vocabulary, names: [&str; 3], angles, roll_sign: f64| {
        let [yaw, pitch, roll] = names.map(|name| xmp.number(vocabulary, name));
        let degrees = [yaw?, pitch?, roll_sign * roll.unwrap_or(0.0)];
        Some((CameraOrientation { degrees, angles }, vocabulary))
    };
    let gimbal = ["GimbalYawDegree", "GimbalPitchDegree", "GimbalRollDegree"];
    let skydio = [
        "CameraOrientationNED/Yaw",
        "CameraOrientationNED/Pitch",
        "CameraOrientationNED/Roll",
    ];
    let parrot = ["CameraYawDegree", "CameraPitchDegree", "CameraRollDegree"];
    let body = ["Yaw", "Pitch", "Roll"];
    let is_sensefly = is_sensefly(make);
    let pix4d_roll = if is_sensefly { -1.0 } else { 1.0 };
    let nameless = of(
        Vocabulary::NamelessCamera,
        body,
        Angles::BodyLookingDown,
        -1.0,
    );
    [
        of(Vocabulary::Dji, gimbal, Angles::Camera, 1.0),
        of(Vocabulary::Skydio, skydio, Angles::Camera, 1.0),
        of(Vocabulary::Parrot, parrot, Angles::Camera, 1.0),
        of(
            Vocabulary::SenseFlyCamera,
            body,
            Angles::BodyLookingDown,
            -1.0,
        ),
        nameless.filter(|_| is_sensefly),
        of(
            Vocabulary::Pix4dCamera,
            body,
            Angles::BodyLookingDown,
            pix4d_roll,
        ),
    ]
    .into_iter()
    .flatten()
    .collect()
}

fn is_sensefly(make: Option<&str>) -> bool {
    make.is_some_and(|make| make.eq_ignore_ascii_case("sensefly"))
}

/// The angle between two orientations in degrees.
fn apart(a: &CameraOrientation, b: &CameraOrientation) -> f64 {
    let [a, b] = [a, b].map(|orientation| orientation.pose(DVec3::ZERO).rotation);
    let between = a.transpose() * b;
    let trace = between.x_axis.x + between.y_axis.y + between.z_axis.z;
    ((trace - 1.0) / 2.0).clamp(-1.0, 1.0).acos().to_degrees()
}

/// The namespaces of angles that nobody understands.
pub(super) fn unknown_angles(xmp: &Xmp) -> Vec<String> {
    let nameless = Vocabulary::NamelessCamera;
    let has = |name| xmp.number(nameless, name).is_some();
    let nameless = (has("Yaw") && has("Pitch")).then(|| nameless.uri());
    let strange = xmp.strange_angles().chain(nameless);
    strange.map(str::to_owned).collect()
}

/// The height above the take-off in metres.
pub(super) fn relative_altitude(xmp: &Xmp) -> Option<f64> {
    [Vocabulary::Dji, Vocabulary::Skydio]
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
    for vocabulary in [Vocabulary::Dji, Vocabulary::Skydio] {
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
    } else if let Some(height) = absolute(Vocabulary::Dji) {
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
            let vocabularies = [Vocabulary::Pix4dCamera, Vocabulary::NamelessCamera];
            let mut of = vocabularies.into_iter();
            of.find_map(|vocabulary| deviation(vocabulary, names))
        })
        .or_else(|| {
            let names = both("GpsHorizontalAccuracy", "GpsVerticalAccuracy");
            deviation(Vocabulary::Skydio, names)
        });
}
