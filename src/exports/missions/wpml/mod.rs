//! DJI's WPML (Cloud API, "DJI WPML"): a .kmz of `wpmz/template.kml`, which Pilot 2 and FlightHub show and
//! edit, and `wpmz/waylines.wpml`, which the drone flies. What both have in common is written by the same
//! lines, so they agree.
//!
//! - Heights above the take-off are `relativeToStartPoint` in both. Absolute ones are above the ellipsoid
//!   in the waylines (`WGS84`) and above the geoid in the template (`EGM96`).
//! - The nose turns on the way (`smoothTransition`). The actions of a stop are one group in a sequence:
//!   each begins when the one before has ended, so the gimbal has arrived when the drone waits and shoots.
//!   The order `rotateYaw` is not given: it would turn a nose that has arrived once around.
//! - Coordinates are longitude, latitude; only `takeOffRefPoint` is latitude, longitude.

mod stop;

use std::io::{Cursor, Write};

use zip::ZipWriter;
use zip::write::SimpleFileOptions;

use fragscale_core::plan::{Above, DroneCodes, Finish, LostSignal, Mission, set_height};

use self::stop::{Placed, actions, heading, point, position, suffix};
use super::format::no_drone;
use super::heights::metres_above;
use super::xml::Xml;
use super::{decimal, degrees, metres};
use crate::fault::Fault;
use crate::files::KMZ_MARK;

/// The namespace with its version, that of Pilot 2 for the Mavic 3 Enterprise and since.
const NAMESPACES: &str =
    "xmlns=\"http://www.opengis.net/kml/2.2\" xmlns:wpml=\"http://www.dji.com/wpmz/1.0.6\"";

/// `takeOffSecurityHeight` of a remote controller, in metres above take-off.
const SAFE_HEIGHTS: (f64, f64) = (1.2, 1500.0);

/// The least of a dock, in metres: those of the Matrice 3D and 3TD (`droneEnumValue` 91), which fly from one alone.
const LEAST_OF_DOCK: f64 = 8.0;
const FROM_DOCK: u32 = 91;

/// `globalTransitionalSpeed`, in m/s.
const FASTEST_TRANSIT: f64 = 15.0;

/// Drones with their cameras (`droneEnumValue`, `droneSubEnumValue`; `payloadEnumValue`s): the Cloud API's "Common
/// Elements" (dji-sdk/Cloud-API-Doc@4ec6b0c7, `40.common-element.md`) and "Product Support" (v1.14, `type`, `sub_type`),
/// but for the P1, which is `DJI_CAMERA_TYPE_P1` of the Payload SDK (`dji_typedef.h`), whose camera types these numbers
/// are.
const DRONES: [(u32, u32, &[u32]); 11] = [
    // M300 RTK and M350 RTK with H20, H20T, P1, H20N, H30, H30T or one made with the Payload SDK.
    (60, 0, &[42, 43, 50, 61, 82, 83, 65_534]),
    (89, 0, &[42, 43, 50, 61, 82, 83, 65_534]),
    // M30, M30T.
    (67, 0, &[52]),
    (67, 1, &[53]),
    // Mavic 3E, 3T, 3M.
    (77, 0, &[66, 65_534]),
    (77, 1, &[67, 65_534]),
    (77, 2, &[68]),
    // Matrice 3D, 3TD.
    (91, 0, &[80]),
    (91, 1, &[81]),
    // Matrice 4E, 4T: "Product Support" since v1.13; of a 4T real files say 99/1 and 89.
    (99, 0, &[88]),
    (99, 1, &[89]),
];

/// What both files say of the whole mission.
struct Common<'a> {
    mission: &'a Mission,
    codes: DroneCodes,
    speed: f64,
    safe_height: f64,
    /// To come home at, where the radio is lost, too.
    return_height: f64,
    lost_signal: LostSignal,
    is_relative: bool,
}

/// The file of a mission.
pub(super) fn bytes(mission: &Mission, notes: &mut Vec<String>) -> Result<Vec<u8>, Fault> {
    let common = common(mission, notes)?;
    let placed = placed(&common)?;
    if mission
        .stops
        .iter()
        .any(|stop| stop.gimbal_pitch.is_none() && stop.photo.is_some())
    {
        notes.push("photos without a gimbal's pitch are shot as the gimbal was left".to_owned());
    }
    let photos = mission.stops.iter().filter_map(|stop| stop.photo.as_ref());
    let mut names = photos.filter_map(|photo| photo.name.as_deref());
    if names.any(|name| suffix(Some(name)) != name) {
        notes.push(
            "signs of photos' names that files' names do not take are written as _".to_owned(),
        );
    }
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    let failed = |error: &dyn std::fmt::Display| {
        let what = format!("it cannot be packed ({error})");
        Fault::new(what, "plan the mission again")
    };
    // The first is not deflated: its beginning says who wrote it.
    for (name, text, method) in [
        (
            "wpmz/template.kml",
            template(&common, &placed),
            zip::CompressionMethod::Stored,
        ),
        (
            "wpmz/waylines.wpml",
            waylines(&common, &placed),
            zip::CompressionMethod::Deflated,
        ),
    ] {
        let options = SimpleFileOptions::default().compression_method(method);
        zip.start_file(name, options)
            .map_err(|error| failed(&error))?;
        zip.write_all(text.as_bytes())
            .map_err(|error| failed(&error))?;
    }
    let bytes = zip.finish().map_err(|error| failed(&error))?;
    Ok(bytes.into_inner())
}

fn common<'a>(mission: &'a Mission, notes: &mut Vec<String>) -> Result<Common<'a>, Fault> {
    let lacks = |what: &str, remedy: &str| Fault::new(format!("DJI's files need {what}"), remedy);
    let codes = mission.drone.ok_or_else(no_drone)?;
    let speed = mission.speed.ok_or_else(|| {
        lacks(
            "a speed, and the mission does not say it",
            "say it: --speed M/S of 'fragscale mission'",
        )
    })?;
    let safe_height = mission.safe_height.ok_or_else(|| {
        let what = "a height to climb to first, and the mission does not say it";
        lacks(
            what,
            "say it: --safe-height METRES above the take-off of 'fragscale mission'",
        )
    })?;
    let (lowest, highest) = SAFE_HEIGHTS;
    if !(lowest..=highest).contains(&safe_height) {
        let what = format!(
            "a height to climb to first from {lowest} to {highest} m, and the mission has {safe_height}"
        );
        return Err(lacks(&what, "give another"));
    }
    let is_low = codes.drone == FROM_DOCK && safe_height < LEAST_OF_DOCK;
    if is_low {
        notes.push(format!(
            "a dock's drone climbs to {LEAST_OF_DOCK} m first at least: the file has that for {} m",
            decimal(safe_height, 2)
        ));
    }
    // Higher is farther from all that stands there.
    let safe_height = if is_low { LEAST_OF_DOCK } else { safe_height };
    let return_height = match mission.return_height {
        // As the pilot's sheet says it: a whole metre, and none below what is climbed to first.
        Some(height) => set_height(height.max(safe_height)),
        None => {
            notes.push(
                "nobody says from which height the drone comes straight home over all that stands there: DJI's file has the height to climb to \
                 first, also for a lost radio; set the return-to-home height at the drone".to_owned(),
            );
            safe_height
        }
    };
    if return_height > highest {
        let what = format!(
            "a height to return home at of up to {highest} m, and the mission has {return_height}"
        );
        return Err(lacks(&what, "take off elsewhere"));
    }
    let lost_signal = mission.lost_signal.unwrap_or_else(|| {
        // It would fly straight over what is fenced off.
        let keeps_out = mission.fences.iter().any(|fence| !fence.keep_in);
        let usual = match keeps_out {
            true => LostSignal::Hover,
            false => LostSignal::ReturnHome,
        };
        notes.push(format!(
            "nobody says what the drone does where the radio is lost: in DJI's file it {}",
            usual.in_words()
        ));
        usual
    });
    let known = DRONES
        .iter()
        .find(|(drone, sub, _)| (*drone, *sub) == (codes.drone, codes.drone_sub));
    let (drone, sub) = (codes.drone, codes.drone_sub);
    match (known, codes.payload) {
        (None, _) => notes.push(format!(
            "drone {drone}/{sub} is not in DJI's tables of those that fly such missions: see whether its app opens the file"
        )),
        (Some((.., cameras)), Some(camera)) if !cameras.contains(&camera.payload) => {
            notes.push(format!(
                "camera {} is not one of drone {drone}/{sub} in DJI's tables: see whether its app opens the file",
                camera.payload
            ));
        }
        (Some(_), None) => notes.push(format!("the camera of drone {drone}/{sub} is not named: see whether its app opens the file")),
        _ => {}
    }
    let has = |above| mission.stops.iter().any(|stop| stop.height.above == above);
    if has(Above::Ground) {
        let what = "heights above the ground are flown by the drone's own terrain data, which DJI takes in mapping only";
        return Err(Fault::new(what, "plan heights above the place of take-off"));
    }
    Ok(Common {
        mission,
        codes,
        speed,
        safe_height,
        return_height,
        lost_signal,
        is_relative: has(Above::TakeOff),
    })
}

fn placed<'a>(common: &Common<'a>) -> Result<Vec<Placed<'a>>, Fault> {
    let mission = common.mission;
    // Mixed ones become relative, which DJI's own apps write.
    let (flown, shown) = match common.is_relative {
        true => (Above::TakeOff, Above::TakeOff),
        false => (Above::Ellipsoid, Above::Geoid),
    };
    (mission.stops.iter())
        .zip(0..)
        .map(|(stop, index)| {
            Ok(Placed {
                stop,
                index,
                flown: metres_above(mission, stop, index + 1, flown)?,
                shown: metres_above(mission, stop, index + 1, shown)?,
            })
        })
        .collect()
}

/// `wpmz/template.kml`.
fn template(common: &Common<'_>, placed: &[Placed<'_>]) -> String {
    let mut xml = Xml::new("kml", NAMESPACES);
    xml.element("Document", |xml| {
        xml.leaf("wpml:author", KMZ_MARK);
        config(xml, common, false);
        xml.element("Folder", |xml| {
            xml.leaf("wpml:templateType", "waypoint");
            xml.leaf("wpml:templateId", 0);
            xml.element("wpml:waylineCoordinateSysParam", |xml| {
                xml.leaf("wpml:coordinateMode", "WGS84");
                let mode = if common.is_relative {
                    "relativeToStartPoint"
                } else {
                    "EGM96"
                };
                xml.leaf("wpml:heightMode", mode);
                xml.leaf("wpml:positioningType", "GPS");
            });
            xml.leaf("wpml:autoFlightSpeed", decimal(common.speed, 3));
            let first = placed.first().map_or(0.0, |placed| placed.shown);
            xml.leaf("wpml:globalHeight", metres(first));
            xml.leaf("wpml:caliFlightEnable", 0);
            xml.leaf("wpml:gimbalPitchMode", "manual");
            xml.element("wpml:globalWaypointHeadingParam", |xml| {
                heading(xml, None, false)
            });
            xml.leaf("wpml:globalWaypointTurnMode", STOP);
            xml.leaf("wpml:globalUseStraightLine", 1);
            for placed in placed {
                xml.element("Placemark", |xml| {
                    point(xml, placed);
                    xml.leaf("wpml:ellipsoidHeight", metres(placed.flown));
                    xml.leaf("wpml:height", metres(placed.shown));
                    xml.leaf("wpml:useGlobalHeight", 0);
                    xml.leaf("wpml:useGlobalSpeed", 1);
                    xml.leaf("wpml:useGlobalHeadingParam", 0);
                    xml.element("wpml:waypointHeadingParam", |xml| {
                        heading(xml, placed.stop.heading, false);
                    });
                    xml.leaf("wpml:useGlobalTurnParam", 1);
                    xml.leaf("wpml:useStraightLine", 1);
                    actions(xml, placed, common.codes);
                });
            }
            xml.element("wpml:payloadParam", |xml| {
                xml.leaf("wpml:payloadPositionIndex", position(common.codes));
            });
        });
    });
    xml.finish()
}

/// `wpmz/waylines.wpml`.
fn waylines(common: &Common<'_>, placed: &[Placed<'_>]) -> String {
    let mut xml = Xml::new("kml", NAMESPACES);
    xml.element("Document", |xml| {
        config(xml, common, true);
        xml.element("Folder", |xml| {
            xml.leaf("wpml:templateId", 0);
            let mode = if common.is_relative {
                "relativeToStartPoint"
            } else {
                "WGS84"
            };
            xml.leaf("wpml:executeHeightMode", mode);
            xml.leaf("wpml:waylineId", 0);
            xml.leaf("wpml:autoFlightSpeed", decimal(common.speed, 3));
            for placed in placed {
                xml.element("Placemark", |xml| {
                    point(xml, placed);
                    xml.leaf("wpml:executeHeight", metres(placed.flown));
                    xml.leaf("wpml:waypointSpeed", decimal(common.speed, 3));
                    xml.element("wpml:waypointHeadingParam", |xml| {
                        heading(xml, placed.stop.heading, true);
                    });
                    xml.element("wpml:waypointTurnParam", |xml| {
                        xml.leaf("wpml:waypointTurnMode", STOP);
                        xml.leaf("wpml:waypointTurnDampingDist", 0);
                    });
                    xml.leaf("wpml:useStraightLine", 1);
                    actions(xml, placed, common.codes);
                });
            }
        });
    });
    xml.finish()
}

/// Straight to the point, and stop there.
const STOP: &str = "toPointAndStopWithDiscontinuityCurvature";

fn config(xml: &mut Xml, common: &Common<'_>, is_flown: bool) {
    xml.element("wpml:missionConfig", |xml| {
        xml.leaf("wpml:flyToWaylineMode", "safely");
        let finish = match common.mission.finish {
            Finish::ReturnHome => "goHome",
            Finish::Hover => "noAction",
            Finish::Land => "autoLand",
            Finish::FirstStop => "gotoFirstWaypoint",
        };
        xml.leaf("wpml:finishAction", finish);
        let (exit, action) = match common.lost_signal {
            LostSignal::ReturnHome => ("executeLostAction", "goBack"),
            LostSignal::Hover => ("executeLostAction", "hover"),
            LostSignal::Land => ("executeLostAction", "landing"),
            // The action is asked for nevertheless.
            LostSignal::GoOn => ("goContinue", "goBack"),
        };
        xml.leaf("wpml:exitOnRCLost", exit);
        xml.leaf("wpml:executeRCLostAction", action);
        xml.leaf("wpml:takeOffSecurityHeight", metres(common.safe_height));
        if let Some(take_off) = common.mission.take_off {
            let (latitude, longitude) = (take_off.latitude, take_off.longitude);
            let ellipsoid = |height| {
                (common.mission).height_above(latitude, longitude, height, Above::Ellipsoid)
            };
            let known = take_off.elevation.and_then(ellipsoid);
            // Without an elevation there is no point: it has three numbers.
            if let (Some(elevation), false) = (known, is_flown) {
                let point = [degrees(latitude), degrees(longitude), metres(elevation)];
                xml.leaf("wpml:takeOffRefPoint", point.join(","));
                xml.leaf("wpml:takeOffRefPointAGLHeight", 0);
            }
        }
        let transit = common.speed.min(FASTEST_TRANSIT);
        xml.leaf("wpml:globalTransitionalSpeed", decimal(transit, 3));
        xml.leaf("wpml:globalRTHHeight", metres(common.return_height));
        xml.element("wpml:droneInfo", |xml| {
            xml.leaf("wpml:droneEnumValue", common.codes.drone);
            xml.leaf("wpml:droneSubEnumValue", common.codes.drone_sub);
        });
        if let Some(payload) = common.codes.payload {
            xml.element("wpml:payloadInfo", |xml| {
                xml.leaf("wpml:payloadEnumValue", payload.payload);
                xml.leaf("wpml:payloadSubEnumValue", payload.payload_sub);
                xml.leaf("wpml:payloadPositionIndex", payload.position);
            });
        }
    });
}
