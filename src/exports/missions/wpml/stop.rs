//! What both files of WPML say of one stop: its place, where the nose looks, what is done there.

use fragscale_core::plan::{DroneCodes, Stop};

use crate::missions::xml::Xml;
use crate::missions::{angle, decimal, degrees};

/// Drones that have to be told which lens shoots (`payloadLensIndex`, "required" of M30, M3D and M4E in the Cloud API's
/// "Common Elements" of June 2025), and how the lens is called: that of the Matrice 4 by FlightHub's own files.
const ASK_FOR_A_LENS: [(u32, &str); 3] = [(67, "wide"), (91, "wide"), (99, "visable")];

/// A stop with its heights in metres.
pub(super) struct Placed<'a> {
    pub(super) stop: &'a Stop,
    /// From 0.
    pub(super) index: usize,
    /// As the waylines have it: above the take-off or the ellipsoid.
    pub(super) flown: f64,
    /// As the template has it: above the take-off or the geoid.
    pub(super) shown: f64,
}

/// Where it is.
pub(super) fn point(xml: &mut Xml, placed: &Placed<'_>) {
    xml.element("Point", |xml| {
        let stop = placed.stop;
        let place = format!("{},{}", degrees(stop.longitude), degrees(stop.latitude));
        xml.leaf("coordinates", place);
    });
    xml.leaf("wpml:index", placed.index);
}

/// Where the nose looks when the drone arrives; along the way where nobody says it.
pub(super) fn heading(xml: &mut Xml, heading: Option<f64>, is_flown: bool) {
    let mode = heading.map_or("followWayline", |_| "smoothTransition");
    xml.leaf("wpml:waypointHeadingMode", mode);
    // From -180 to 180.
    let degrees = heading.map_or(0.0, |heading| {
        if heading > 180.0 {
            heading - 360.0
        } else {
            heading
        }
    });
    xml.leaf("wpml:waypointHeadingAngle", angle(degrees));
    xml.leaf("wpml:waypointPoiPoint", "0.000000,0.000000,0.000000");
    if is_flown {
        xml.leaf(
            "wpml:waypointHeadingAngleEnable",
            u8::from(heading.is_some()),
        );
    }
    xml.leaf("wpml:waypointHeadingPathMode", "followBadArc");
    xml.leaf("wpml:waypointHeadingPoiIndex", 0);
}

/// What is done at a stop, one after the other: the gimbal, the wait, the photo.
pub(super) fn actions(xml: &mut Xml, placed: &Placed<'_>, codes: DroneCodes) {
    let stop = placed.stop;
    if stop.gimbal_pitch.is_none() && stop.settle <= 0.0 && stop.photo.is_none() {
        return;
    }
    let position = position(codes);
    xml.element("wpml:actionGroup", |xml| {
        xml.leaf("wpml:actionGroupId", placed.index);
        xml.leaf("wpml:actionGroupStartIndex", placed.index);
        xml.leaf("wpml:actionGroupEndIndex", placed.index);
        xml.leaf("wpml:actionGroupMode", "sequence");
        xml.element("wpml:actionTrigger", |xml| {
            xml.leaf("wpml:actionTriggerType", "reachPoint");
        });
        let mut id = 0;
        let mut action = |xml: &mut Xml, function: &str, fill: &dyn Fn(&mut Xml)| {
            xml.element("wpml:action", |xml| {
                xml.leaf("wpml:actionId", id);
                xml.leaf("wpml:actionActuatorFunc", function);
                xml.element("wpml:actionActuatorFuncParam", fill);
            });
            id += 1;
        };
        if let Some(pitch) = stop.gimbal_pitch {
            action(xml, "gimbalRotate", &|xml| gimbal(xml, pitch, position));
        }
        if stop.settle > 0.0 {
            action(xml, "hover", &|xml| {
                xml.leaf("wpml:hoverTime", decimal(stop.settle, 3))
            });
        }
        if let Some(photo) = &stop.photo {
            action(xml, "takePhoto", &|xml| {
                xml.leaf("wpml:payloadPositionIndex", position);
                xml.leaf("wpml:fileSuffix", suffix(photo.name.as_deref()));
                let asks = |(drone, _): &&(u32, &str)| *drone == codes.drone;
                if let Some((_, lens)) = ASK_FOR_A_LENS.iter().find(asks) {
                    xml.leaf("wpml:payloadLensIndex", lens);
                }
                xml.leaf("wpml:useGlobalPayloadLensIndex", 0);
            });
        }
    });
}

fn gimbal(xml: &mut Xml, pitch: f64, position: u32) {
    xml.leaf("wpml:payloadPositionIndex", position);
    xml.leaf("wpml:gimbalHeadingYawBase", "north");
    xml.leaf("wpml:gimbalRotateMode", "absoluteAngle");
    xml.leaf("wpml:gimbalPitchRotateEnable", 1);
    xml.leaf("wpml:gimbalPitchRotateAngle", angle(pitch));
    for turn in ["Roll", "Yaw"] {
        xml.leaf(&format!("wpml:gimbal{turn}RotateEnable"), 0);
        xml.leaf(&format!("wpml:gimbal{turn}RotateAngle"), 0);
    }
    // As fast as it goes, and the next action when it is there.
    xml.leaf("wpml:gimbalRotateTimeEnable", 0);
    xml.leaf("wpml:gimbalRotateTime", 0);
}

/// What is added to the file's name: of a photo's name the letters and digits, and signs that no file
/// system minds.
pub(super) fn suffix(name: Option<&str>) -> String {
    let name = name.unwrap_or_default();
    let is_good = |c: char| c.is_alphanumeric() || matches!(c, '-' | '_' | '.');
    name.chars()
        .map(|c| if is_good(c) { c } else { '_' })
        .collect()
}

pub(super) fn position(codes: DroneCodes) -> u32 {
    codes.payload.map_or(0, |payload| payload.position)
}
